//! GeoPackages, laid out page by page from the definition of the format of SQLite.

use super::cases::survey_of_cases;
use super::*;
use glam::DVec3;

/// A value of a row.
#[derive(Clone)]
enum Put {
    Nothing,
    Whole(i64),
    Real(f64),
    Text(String),
    Bytes(Vec<u8>),
}

fn text(text: &str) -> Put {
    Put::Text(text.to_owned())
}

/// A table: its name, its `CREATE`, its rows.
struct Rows {
    name: &'static str,
    sql: String,
    rows: Vec<Vec<Put>>,
}

#[derive(Clone, Copy, PartialEq)]
enum Letters {
    Utf8,
    Utf16Little,
    Utf16Big,
}

fn varint(number: u64) -> Vec<u8> {
    let mut groups = vec![(number & 0x7f) as u8];
    let mut rest = number >> 7;
    while rest > 0 {
        groups.push(0x80 | (rest & 0x7f) as u8);
        rest >>= 7;
    }
    groups.reverse();
    groups
}

fn record(row: &[Put], letters: Letters) -> Vec<u8> {
    let (mut kinds, mut body) = (Vec::new(), Vec::new());
    for value in row {
        let (kind, bytes) = match value {
            Put::Nothing => (0, Vec::new()),
            Put::Whole(0) => (8, Vec::new()),
            Put::Whole(1) => (9, Vec::new()),
            Put::Whole(number) if i8::try_from(*number).is_ok() => (1, vec![*number as u8]),
            Put::Whole(number) if number.abs() < 1 << 22 => (3, number.to_be_bytes()[5..].to_vec()),
            Put::Whole(number) if number.abs() < 1 << 46 => (5, number.to_be_bytes()[2..].to_vec()),
            Put::Whole(number) => (6, number.to_be_bytes().to_vec()),
            Put::Real(number) => (7, number.to_be_bytes().to_vec()),
            Put::Text(text) => {
                let bytes: Vec<u8> = match letters {
                    Letters::Utf8 => text.clone().into_bytes(),
                    Letters::Utf16Little => text.encode_utf16().flat_map(u16::to_le_bytes).collect(),
                    Letters::Utf16Big => text.encode_utf16().flat_map(u16::to_be_bytes).collect(),
                };
                (13 + 2 * bytes.len() as u64, bytes)
            }
            Put::Bytes(bytes) => (12 + 2 * bytes.len() as u64, bytes.clone()),
        };
        kinds.extend(varint(kind));
        body.extend(bytes);
    }
    // The length of the header counts its own bytes.
    let own = if kinds.len() + 1 < 128 { 1 } else { 2 };
    [varint((kinds.len() + own) as u64), kinds, body].concat()
}

/// The pages of a file.
struct Pages {
    size: usize,
    pages: Vec<Vec<u8>>,
}

impl Pages {
    fn add(&mut self, page: Vec<u8>) -> u32 {
        assert!(page.len() <= self.size);
        self.pages.push(page);
        self.pages.len() as u32
    }

    /// The cell of a row, what is too long for it in pages of their own.
    fn leaf_cell(&mut self, number: u64, record: &[u8]) -> Vec<u8> {
        let head = [varint(record.len() as u64), varint(number)].concat();
        let (most, least) = (self.size - 35, (self.size - 12) * 32 / 255 - 23);
        if record.len() <= most {
            return [head, record.to_vec()].concat();
        }
        let filling = least + (record.len() - least) % (self.size - 4);
        let (inside, beyond) = record.split_at(if filling <= most { filling } else { least });
        let mut next = 0_u32;
        for part in beyond.chunks(self.size - 4).collect::<Vec<_>>().into_iter().rev() {
            next = self.add([&next.to_be_bytes()[..], part].concat());
        }
        [head, inside.to_vec(), next.to_be_bytes().to_vec()].concat()
    }

    /// A page of a tree: cells grow from its end, their places from its start.
    fn node(&self, kind: u8, offset: usize, cells: &[Vec<u8>], last: Option<u32>) -> Vec<u8> {
        let mut page = vec![0; self.size];
        page[offset] = kind;
        page[offset + 3..offset + 5].copy_from_slice(&(cells.len() as u16).to_be_bytes());
        let mut places = offset + 8;
        if let Some(last) = last {
            page[places..places + 4].copy_from_slice(&last.to_be_bytes());
            places += 4;
        }
        let (mut end, cells_from) = (self.size, places + 2 * cells.len());
        for cell in cells {
            end -= cell.len();
            assert!(end >= cells_from, "the cells do not fit");
            page[end..end + cell.len()].copy_from_slice(cell);
            page[places..places + 2].copy_from_slice(&(end as u16).to_be_bytes());
            places += 2;
        }
        page[offset + 5..offset + 7].copy_from_slice(&(end as u16).to_be_bytes());
        page
    }

    /// A tree of rows; its root, and how many levels it has.
    fn tree(&mut self, rows: &[Vec<u8>]) -> (u32, usize) {
        let cells: Vec<(u64, Vec<u8>)> = rows.iter().zip(1..).map(|(row, n)| (n, self.leaf_cell(n, row))).collect();
        let mut level: Vec<(u64, u32)> = Vec::new();
        for part in self.filled(cells) {
            let bytes: Vec<Vec<u8>> = part.iter().map(|(_, cell)| cell.clone()).collect();
            let node = self.node(13, 0, &bytes, None);
            level.push((part.last().map_or(0, |(n, _)| *n), self.add(node)));
        }
        let mut levels = 1;
        while level.len() > 1 {
            // Two or three children each, so that few pages make several levels.
            let (mut above, mut rest) = (Vec::new(), level.as_slice());
            while !rest.is_empty() {
                let (part, others) = rest.split_at(if rest.len() == 4 { 2 } else { rest.len().min(3) });
                rest = others;
                let (last, others) = part.split_last().unwrap();
                let cell = |(n, page): &(u64, u32)| [page.to_be_bytes().to_vec(), varint(*n)].concat();
                let node = self.node(5, 0, &others.iter().map(cell).collect::<Vec<_>>(), Some(last.1));
                above.push((last.0, self.add(node)));
            }
            level = above;
            levels += 1;
        }
        (level[0].1, levels)
    }

    /// Cells by the pages that they fill.
    fn filled(&self, cells: Vec<(u64, Vec<u8>)>) -> Vec<Vec<(u64, Vec<u8>)>> {
        let (mut parts, mut used) = (vec![Vec::new()], 8);
        for cell in cells {
            let bytes = cell.1.len() + 2;
            if used + bytes > self.size {
                parts.push(Vec::new());
                used = 8;
            }
            used += bytes;
            parts.last_mut().unwrap().push(cell);
        }
        parts
    }
}

/// A file of tables, and the most levels that one of them has.
fn database(size: usize, letters: Letters, tables: &[Rows]) -> (Vec<u8>, usize) {
    let mut pages = Pages { size, pages: vec![Vec::new()] };
    let (mut schema, mut most) = (Vec::new(), 0);
    for table in tables {
        let rows: Vec<Vec<u8>> = table.rows.iter().map(|row| record(row, letters)).collect();
        let (root, levels) = pages.tree(&rows);
        most = most.max(levels);
        let row = [text("table"), text(table.name), text(table.name), Put::Whole(i64::from(root)), text(&table.sql)];
        schema.push(record(&row, letters));
    }
    // The schema is a tree, too, whose root is page 1.
    let (root, _) = pages.tree(&schema);
    let first = pages.node(5, 100, &[], Some(root));
    pages.pages[0] = first;
    let mut bytes =
        pages.pages.iter().flat_map(|page| [&page[..], &vec![0; size - page.len()]].concat()).collect::<Vec<u8>>();
    bytes[..16].copy_from_slice(b"SQLite format 3\0");
    bytes[16..18].copy_from_slice(&if size == 65_536 { 1_u16 } else { size as u16 }.to_be_bytes());
    bytes[18..24].copy_from_slice(&[1, 1, 0, 64, 32, 32]);
    let (count, code) = (pages.pages.len() as u32, letters as u32 + 1);
    for (at, value) in [(24, 7), (28, count), (44, 4), (56, code), (92, 7), (96, 3_040_000)] {
        bytes[at..at + 4].copy_from_slice(&u32::to_be_bytes(value));
    }
    bytes[68..72].copy_from_slice(b"GPKG");
    (bytes, most)
}

/// A layer: its name, its columns besides the number and the geometry, its coordinate system, and its rows.
struct Layer<'a> {
    name: &'static str,
    columns: &'a str,
    system: i64,
    rows: Vec<(Vec<u8>, Vec<Put>)>,
}

const UTM: &str =
    "PROJCS[\"UTM 31\",GEOGCS[\"WGS 84\",DATUM[\"D\"],UNIT[\"degree\",0.0174]],PROJECTION[\"TM\"],UNIT[\"metre\",1]]";

fn tables(layers: &[Layer<'_>]) -> Vec<Rows> {
    let mut all = vec![
        Rows {
            name: "gpkg_spatial_ref_sys",
            sql: "CREATE TABLE gpkg_spatial_ref_sys (srs_name TEXT NOT NULL,srs_id INTEGER NOT NULL PRIMARY KEY,definition TEXT)"
                .to_owned(),
            rows: Vec::new(),
        },
        Rows {
            name: "gpkg_contents",
            sql: "CREATE TABLE gpkg_contents (table_name TEXT NOT NULL PRIMARY KEY,data_type TEXT NOT NULL)".to_owned(),
            rows: layers.iter().map(|layer| vec![text(layer.name), text("features")]).collect(),
        },
        Rows {
            name: "gpkg_geometry_columns",
            sql: "CREATE TABLE gpkg_geometry_columns (table_name TEXT NOT NULL, column_name TEXT, srs_id INTEGER, \
                  CONSTRAINT pk PRIMARY KEY (table_name, column_name))"
                .to_owned(),
            rows: layers.iter().map(|layer| vec![text(layer.name), text("geom"), Put::Whole(layer.system)]).collect(),
        },
    ];
    // The number of a system is the number of its row: rows are numbered from 1.
    all[0].rows = [
        UTM,
        "GEOGCS[\"WGS 84\",UNIT[\"degree\",0.0174]]",
        &UTM.replace("\"metre\",1]", "\"Foot_US\",0.3048006096012192]"),
    ]
    .iter()
    .map(|wkt| vec![text("a"), Put::Nothing, text(wkt)])
    .collect();
    for layer in layers {
        let comma = if layer.columns.is_empty() { "" } else { ", " };
        let row = |(geometry, row): &(Vec<u8>, Vec<Put>)| {
            [vec![Put::Nothing, Put::Bytes(geometry.clone())], row.clone()].concat()
        };
        all.push(Rows {
            name: layer.name,
            sql: format!(
                "CREATE TABLE \"{}\" ( \"fid\" INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL, \"geom\" LINESTRING{comma}{})",
                layer.name, layer.columns
            ),
            rows: layer.rows.iter().map(row).collect(),
        });
    }
    all
}

fn geopackage(layers: &[Layer<'_>]) -> Vec<u8> {
    database(512, Letters::Utf8, &tables(layers)).0
}

/// How a geometry is written.
#[derive(Clone, Copy)]
struct Style {
    is_big: bool,
    envelope: u8,
    has_z: bool,
    has_m: bool,
    is_extended: bool,
}

const PLAIN: Style = Style { is_big: false, envelope: 1, has_z: false, has_m: false, is_extended: false };

impl Style {
    fn word(self, number: u32) -> [u8; 4] {
        if self.is_big { number.to_be_bytes() } else { number.to_le_bytes() }
    }

    fn head(self, kind: u32) -> Vec<u8> {
        let code = match self.is_extended {
            true => kind | if self.has_z { 0x8000_0000 } else { 0 } | if self.has_m { 0x4000_0000 } else { 0 },
            false => kind + if self.has_z { 1000 } else { 0 } + if self.has_m { 2000 } else { 0 },
        };
        [vec![u8::from(!self.is_big)], self.word(code).to_vec()].concat()
    }

    fn corners(self, corners: &[[f64; 3]]) -> Vec<u8> {
        let number = |value: f64| if self.is_big { value.to_be_bytes() } else { value.to_le_bytes() };
        let corner = |[x, y, z]: &[f64; 3]| {
            let mut values = vec![*x, *y];
            values.extend(self.has_z.then_some(*z));
            values.extend(self.has_m.then_some(-7.0));
            values
        };
        corners.iter().flat_map(corner).flat_map(number).collect()
    }

    fn counted(self, corners: &[[f64; 3]]) -> Vec<u8> {
        [self.word(corners.len() as u32).to_vec(), self.corners(corners)].concat()
    }

    fn line(self, corners: &[[f64; 3]]) -> Vec<u8> {
        [self.head(2), self.counted(corners)].concat()
    }

    fn point(self, corner: [f64; 3]) -> Vec<u8> {
        [self.head(1), self.corners(&[corner])].concat()
    }

    fn parts(self, kind: u32, parts: &[Vec<u8>]) -> Vec<u8> {
        [self.head(kind), self.word(parts.len() as u32).to_vec(), parts.concat()].concat()
    }

    fn blob(self, wkb: &[u8]) -> Vec<u8> {
        let envelope = [0, 32, 48, 48, 64][usize::from(self.envelope)];
        let head = [b'G', b'P', 0, u8::from(!self.is_big) | self.envelope << 1];
        [&head[..], &self.word(32631), &vec![0x55; envelope], wkb].concat()
    }
}

fn trace(x: f64) -> [[f64; 3]; 2] {
    [[x, 5_999_200.0, 0.0], [x + 100.0, 6_000_500.0, 0.0]]
}

fn traces(system: i64, scale: f64) -> Layer<'static> {
    let row = |name: &str, x: f64, dip: f64, azimuth: i64| {
        let blob = PLAIN.blob(&PLAIN.line(&trace(x).map(|corner| corner.map(|value| value / scale))));
        (blob, vec![text(name), Put::Real(dip), Put::Whole(azimuth)])
    };
    let rows = vec![row("F0", 456_500.0, 65.0, 90), row("F1", 457_500.0, 80.5, 270)];
    Layer { name: "faults", columns: "\"name\" TEXT(20), dip DOUBLE, dip_dir MEDIUMINT", system, rows }
}

/// Two sticks of a fault over the survey of the other small files.
pub(super) fn small_geopackage() -> Vec<u8> {
    let style = Style { has_z: true, ..PLAIN };
    let stick = |y: f64| (style.blob(&style.line(&[[0.0, y, 40.0], [500.0, y, 80.0]])), Vec::new());
    geopackage(&[Layer { name: "F", columns: "", system: 1, rows: vec![stick(0.0), stick(100.0)] }])
}

fn faults(content: &[u8]) -> Result<Vec<(Fault, ImportReport)>, FormatError> {
    let (_folder, path) = bytes("a.gpkg", content);
    read_fault(&path, &survey_of_cases(), &ImportOptions::default())
}

#[test]
fn geopackage_traces_dip_as_their_columns_say_whatever_the_pages_and_letters() {
    for size in [512, 1024, 65_536] {
        for letters in [Letters::Utf8, Letters::Utf16Little, Letters::Utf16Big] {
            let (content, _) = database(size, letters, &tables(&[traces(1, 1.0)]));
            let found = faults(&content).unwrap_or_else(|error| panic!("{size}: {error}"));
            assert_eq!(found.iter().map(|(fault, _)| fault.name.as_str()).collect::<Vec<_>>(), ["F0", "F1"]);
            for ((fault, report), (dip, east, x)) in
                found.iter().zip([(65.0_f64, 1.0, 456_500.0), (80.5, -1.0, 457_500.0)])
            {
                assert_eq!(report.format.value, Format::GeoPackage);
                let [top, bottom] = [fault.mesh.vertices[0], fault.mesh.vertices[1]];
                let at = top.lerp(bottom, 1000.0 / (bottom.z - top.z));
                let wanted = DVec3::new(x + east * 1000.0 / dip.to_radians().tan(), 5_999_200.0, 1000.0);
                assert!((at - wanted).length() < 1e-6, "{at} {wanted}\n{report}");
            }
        }
    }
}

#[test]
fn geopackage_tables_of_several_levels_and_rows_of_several_pages_are_read() {
    // 400 points in a tree of pages, and a line of 600 corners, which is longer than 18 pages.
    let place = |n: usize| [456_050.0 + 150.0 * (n % 20) as f64, 5_999_050.0 + 150.0 * (n / 20) as f64, 800.0];
    let style = Style { has_z: true, envelope: 2, ..PLAIN };
    let points = (0..400).map(|n| (style.blob(&style.point(place(n))), vec![text("Chalk")])).collect();
    let long: Vec<[f64; 3]> = (0..600)
        .map(|n| [456_100.0 + 4.0 * f64::from(n), 5_999_500.0 + 0.5 * f64::from(n), 1200.0 + f64::from(n % 7)])
        .collect();
    let second: Vec<[f64; 3]> = long.iter().map(|[x, y, z]| [*x, y + 1000.0, *z]).collect();
    let lines = vec![
        (style.blob(&style.line(&long)), vec![text("Marl")]),
        (style.blob(&style.line(&second)), vec![text("Marl")]),
    ];
    let layers = [
        Layer { name: "points", columns: "formation TEXT", system: 1, rows: points },
        Layer { name: "lines", columns: "formation TEXT", system: 1, rows: lines },
    ];
    let (content, levels) = database(512, Letters::Utf8, &tables(&layers));
    assert!(levels >= 4, "{levels}");
    let (_folder, path) = bytes("a.gpkg", &content);
    let source = SourceFile::open(&path).unwrap();
    let (_, surfaces) = read_source(&source, None, &ImportOptions::default(), SurfaceKind::Horizon).unwrap();
    let names: Vec<_> = surfaces.iter().map(|surface| surface.name.as_deref()).collect();
    assert_eq!(names, [Some("Chalk"), Some("Marl")]);
    let corners = |n: usize| match &surfaces[n].shape {
        raw::RawShape::Points(points) => {
            points.iter().map(|p| [p.xy.unwrap().x, p.xy.unwrap().y, p.z]).collect::<Vec<_>>()
        }
        other => panic!("{other:?}"),
    };
    assert_eq!(corners(0), (0..400).map(place).collect::<Vec<_>>());
    assert_eq!(corners(1), [long, second].concat());
}

#[test]
fn geopackage_geometries_of_every_kind_and_style_are_lines_and_points() {
    let a = [[456_500.0, 5_999_200.0, 500.0], [456_600.0, 5_999_200.0, 900.0]];
    let b = [[456_500.0, 6_000_200.0, 500.0], [456_600.0, 6_000_200.0, 900.0]];
    for is_big in [false, true] {
        for envelope in 0..=4 {
            for (has_m, is_extended) in [(false, false), (true, false), (false, true), (true, true)] {
                let style = Style { is_big, envelope, has_z: true, has_m, is_extended };
                let [first, second] = [style.line(&a), style.line(&b)];
                let lines = style.parts(5, &[first.clone(), second.clone()]);
                let rings = style.parts(3, &[style.counted(&a), style.counted(&b)]);
                let points = style.parts(4, &[style.point(a[0]), style.point([f64::NAN; 3])]);
                for (what, wkb) in [
                    ("lines", lines.clone()),
                    ("area", rings.clone()),
                    ("areas", style.parts(6, &[rings])),
                    ("collection", style.parts(7, &[lines])),
                    ("curves", style.parts(11, &[first, style.parts(9, &[second])])),
                ] {
                    let layer = Layer { name: "F", columns: "", system: 1, rows: vec![(style.blob(&wkb), Vec::new())] };
                    let (fault, report) =
                        faults(&geopackage(&[layer])).unwrap_or_else(|e| panic!("{what}: {e}")).remove(0);
                    assert_eq!((fault.name.as_str(), fault.mesh.triangles.len()), ("F", 2), "{what}: {report}");
                }
                let rows = vec![(style.blob(&points), Vec::new())];
                let (_folder, path) =
                    bytes("a.gpkg", &geopackage(&[Layer { name: "P", columns: "", system: 1, rows }]));
                let source = SourceFile::open(&path).unwrap();
                let (_, read) = read_source(&source, None, &ImportOptions::default(), SurfaceKind::Horizon).unwrap();
                assert_eq!(read[0].shape.values().collect::<Vec<_>>(), [500.0], "a point without a place is none");
            }
        }
    }
    // With the number of a coordinate system, as PostGIS writes it.
    let mut wkb = PLAIN.line(&a);
    wkb[4] |= 0x20;
    wkb.splice(5..5, 32631_u32.to_le_bytes());
    let rows = vec![(PLAIN.blob(&wkb), Vec::new())];
    assert_eq!(faults(&geopackage(&[Layer { name: "F", columns: "", system: 1, rows }])).unwrap().len(), 1);
    // An arc, a kind that is not known, one that is nested without end.
    let nested = (0..20).fold(PLAIN.line(&a), |inner, _| PLAIN.parts(7, &[inner]));
    for (wkb, words) in [
        (PLAIN.parts(8, &[]), "arcs"),
        (PLAIN.parts(77, &[]), "kind 77"),
        (nested, "deep in others"),
        (PLAIN.line(&a)[..30].to_vec(), "truncated"),
    ] {
        let rows = vec![(PLAIN.blob(&wkb), Vec::new())];
        let error = faults(&geopackage(&[Layer { name: "F", columns: "", system: 1, rows }])).unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    }
}

#[test]
fn geopackage_layers_of_several_kinds_do_not_stand_in_one_anothers_way() {
    let style = Style { has_z: true, ..PLAIN };
    let place = |n: usize| [456_100.0 + 700.0 * (n % 4) as f64, 5_999_100.0 + 700.0 * (n / 4) as f64, 800.0];
    let points = |name| Layer {
        name,
        columns: "name TEXT",
        system: 1,
        rows: (0..16).map(|n| (style.blob(&style.point(place(n))), vec![Put::Nothing])).collect(),
    };
    let content = geopackage(&[traces(1, 1.0), points("Chalk")]);
    let (folder, path) = bytes("a.gpkg", &content);
    let read = |options: &ImportOptions| read_horizons(&path, &survey_of_cases(), options);
    let (horizon, report) = read(&ImportOptions::default()).unwrap().remove(0);
    assert_eq!((horizon.name.as_str(), report.range), ("Chalk", [800.0; 2]), "the name of the layer: {report}");
    assert!(report.notes.iter().any(|note| note.contains("'F0' is left out")), "{report}");
    let asked = ImportOptions { select: Some("F0".to_owned()), ..ImportOptions::default() };
    assert!(read(&asked).unwrap_err().to_string().contains("no heights"));
    // A layer in degrees is left out, or refused where there is no other, or where it is asked for.
    let content = geopackage(&[traces(2, 1e5), points("Chalk")]);
    std::fs::write(&path, content).unwrap();
    let (_, report) = read(&ImportOptions::default()).unwrap().remove(0);
    assert!(report.notes.iter().any(|note| note.contains("degrees") && note.contains("WGS 84")), "{report}");
    assert!(read(&asked).unwrap_err().to_string().contains("degrees"));
    // Changes that are not in the file yet are said.
    std::fs::write(folder.path().join("a.gpkg-wal"), b"").unwrap();
    assert!(!read(&ImportOptions::default()).unwrap()[0].1.to_string().contains("-wal"));
    std::fs::write(folder.path().join("a.gpkg-wal"), b"7\x7f\x06\x82").unwrap();
    assert!(read(&ImportOptions::default()).unwrap()[0].1.to_string().contains("-wal"));
    std::fs::write(&path, geopackage(&[traces(1, 1.0)])).unwrap();
    assert!(read(&ImportOptions::default()).unwrap_err().to_string().contains("-wal"));
}

#[test]
fn coordinate_systems_of_a_geopackage_are_followed_or_refused() {
    let feet = 1200.0 / 3937.0;
    for (system, scale, words) in [(2, 1.0, "degrees"), (0, 1e5, "degrees"), (9, 1e5, "degrees")] {
        let error = faults(&geopackage(&[traces(system, scale)])).unwrap_err().to_string();
        assert!(error.contains(words), "{system}: {error}");
    }
    for (system, scale) in [(1, 1.0), (3, feet), (-1, 1.0), (0, 1.0), (9, 1.0)] {
        let (fault, report) = faults(&geopackage(&[traces(system, scale)])).unwrap().remove(0);
        assert!((fault.mesh.vertices[0].x - 456_500.0).abs() < 1e-6, "{system}: {report}");
        assert_eq!(report.notes.iter().any(|note| note.contains("undefined")), system == 0, "{report}");
    }
}

#[test]
fn geopackages_that_are_broken_are_refused_and_never_panic() {
    let whole = geopackage(&[traces(1, 1.0)]);
    let told = |content: &[u8]| faults(content).map(|_| ()).map_err(|error| error.to_string());
    for cut in (16..whole.len()).step_by(7) {
        assert!(told(&whole[..cut]).is_err(), "{cut}");
    }
    let lying = |at: usize, bytes: &[u8]| {
        let mut lying = whole.clone();
        lying[at..at + bytes.len()].copy_from_slice(bytes);
        told(&lying).unwrap_err()
    };
    assert!(lying(16, &[0, 3]).contains("pages of 3 bytes"));
    assert!(lying(20, &[99]).contains("can be used"));
    assert!(lying(28, &[0, 1, 0, 0]).contains("pages: expected 65536"));
    assert!(lying(100, &[2]).contains("kind 2"));
    assert!(lying(108, &[0, 0, 0, 1]).contains("lead to page 1"), "a page that is its own child");
    assert!(lying(108, &[0, 1, 0, 0]).contains("page 65536 is needed"));
    assert!(lying(103, &[0xff, 0xff]).contains("cut short"));
    assert!(lying(0, b"encrypt!").contains("format is not recognised"));
    let no_tables = database(512, Letters::Utf8, &tables(&[])[..1]).0;
    assert!(told(&no_tables).unwrap_err().contains("gpkg_contents"));
    assert!(told(&geopackage(&[])).unwrap_err().contains("none is of lines"));
    let mut mask = 0x2545_f491_4f6c_dd1d_u64;
    for _ in 0..1500 {
        let mut mutant = whole.clone();
        for _ in 0..4 {
            mask ^= mask << 13;
            mask ^= mask >> 7;
            mask ^= mask << 17;
            let at = 16 + (mask >> 8) as usize % (mutant.len() - 16);
            mutant[at] = mask as u8;
        }
        let source = SourceFile { path: "a.gpkg".into(), bytes: mutant };
        let options = ImportOptions { format: Some(Format::GeoPackage), ..ImportOptions::default() };
        let _ = read_source(&source, Some(&survey_of_cases()), &options, SurfaceKind::Fault);
        let _ = read_source(&source, None, &options, SurfaceKind::Horizon);
    }
}
