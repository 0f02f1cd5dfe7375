//! Lines and points with properties: shapefiles, written by hand from the definition of the format, and what all
//! features share.

use super::cases::survey_of_cases;
use super::*;
use glam::DVec3;

/// A shape: its kind, its parts, each with X, Y and perhaps Z.
struct Shape {
    kind: u32,
    parts: Vec<Vec<[f64; 3]>>,
}

fn line(x: f64) -> Vec<Vec<[f64; 3]>> {
    vec![vec![[x, 5_999_200.0, 0.0], [x + 100.0, 6_000_500.0, 0.0]]]
}

impl Shape {
    fn bytes(&self) -> Vec<u8> {
        let corners: Vec<[f64; 3]> = self.parts.concat();
        let xy = || corners.iter().flat_map(|[x, y, _]| [*x, *y]).flat_map(f64::to_le_bytes);
        let heights = || corners.iter().flat_map(|[.., z]| z.to_le_bytes());
        let mut out = self.kind.to_le_bytes().to_vec();
        match self.kind {
            0 => return out,
            1 | 11 | 21 => out.extend(xy()),
            _ => {
                out.extend([0; 32]);
                if self.kind % 10 != 8 {
                    out.extend((self.parts.len() as u32).to_le_bytes());
                }
                out.extend((corners.len() as u32).to_le_bytes());
                let mut first = 0_u32;
                for part in self.parts.iter().filter(|_| self.kind % 10 != 8) {
                    out.extend(first.to_le_bytes());
                    first += part.len() as u32;
                }
                out.extend(xy());
            }
        }
        if self.kind / 10 == 1 {
            out.extend(vec![0; if self.kind == 11 { 0 } else { 16 }]);
            out.extend(heights());
        }
        out
    }
}

fn shp(shapes: &[Shape]) -> Vec<u8> {
    let mut out = vec![0; 100];
    out[..4].copy_from_slice(&9994_u32.to_be_bytes());
    out[28..32].copy_from_slice(&1000_u32.to_le_bytes());
    for (n, shape) in shapes.iter().enumerate() {
        let content = shape.bytes();
        out.extend((n as u32 + 1).to_be_bytes());
        out.extend((content.len() as u32 / 2).to_be_bytes());
        out.extend(content);
    }
    let words = (out.len() as u32 / 2).to_be_bytes();
    out[24..28].copy_from_slice(&words);
    out
}

/// Columns (name, type, width) and rows of a dBase table.
fn dbf(columns: &[(&str, u8, usize)], rows: &[&[&str]]) -> Vec<u8> {
    let width = 1 + columns.iter().map(|(.., width)| width).sum::<usize>();
    let mut out = vec![3, 126, 11, 29];
    out.extend((rows.len() as u32).to_le_bytes());
    out.extend(((32 + 32 * columns.len() + 1) as u16).to_le_bytes());
    out.extend((width as u16).to_le_bytes());
    out.resize(32, 0);
    for (name, kind, width) in columns {
        let mut field = name.as_bytes().to_vec();
        field.resize(32, 0);
        field[11] = *kind;
        field[16] = *width as u8;
        out.extend(field);
    }
    out.push(0x0d);
    for row in rows {
        out.push(b' ');
        for (cell, (_, kind, width)) in row.iter().zip(columns) {
            let cell = if *kind == b'C' { format!("{cell:<width$}") } else { format!("{cell:>width$}") };
            out.extend(cell.into_bytes());
        }
    }
    out.push(0x1a);
    out
}

const UTM: &str = "PROJCS[\"WGS_1984_UTM_Zone_31N\",GEOGCS[\"GCS_WGS_1984\",DATUM[\"D_WGS_1984\",SPHEROID[\"WGS_1984\",6378137.0,\
                   298.257223563]],PRIMEM[\"Greenwich\",0.0],UNIT[\"Degree\",0.0174532925199433]],PROJECTION[\"Transverse_Mercator\"],\
                   PARAMETER[\"False_Easting\",500000.0],UNIT[\"Meter\",1.0]]";

/// A folder with the files that are given; the path is that of the shapefile.
fn written(shp: &[u8], dbf: Option<&[u8]>, prj: Option<&str>) -> (tempfile::TempDir, PathBuf) {
    let (folder, path) = bytes("faults.shp", shp);
    if let Some(dbf) = dbf {
        std::fs::write(folder.path().join("faults.dbf"), dbf).unwrap();
    }
    if let Some(prj) = prj {
        std::fs::write(folder.path().join("faults.prj"), prj).unwrap();
    }
    (folder, path)
}

/// Two sticks of a fault.
pub(super) fn small_shapefile() -> Vec<u8> {
    let stick = |y: f64| vec![[0.0, y, 40.0], [500.0, y, 80.0]];
    shp(&[Shape { kind: 13, parts: vec![stick(0.0), stick(100.0)] }])
}

#[test]
fn traces_of_a_shapefile_dip_as_its_table_says() {
    let shapes = [
        Shape { kind: 3, parts: line(456_500.0) },
        Shape { kind: 3, parts: line(457_500.0) },
        Shape { kind: 0, parts: vec![] },
    ];
    for (columns, rows) in [
        (
            vec![("NAME", b'C', 20), ("DIP", b'N', 6), ("DIP_DIR", b'N', 6)],
            vec![["F0", "65", "90"], ["F1", "80.5", "270"], ["nothing", "1", "1"]],
        ),
        (
            vec![("Fault", b'C', 8), ("dip", b'F', 12), ("strike", b'F', 12)],
            vec![["F0", "65.0", "0.0"], ["F1", "80.5", "180"], ["", "", ""]],
        ),
        (
            vec![("fault_name", b'C', 8), ("dip", b'C', 8), ("azimuth", b'C', 8)],
            vec![["F0", "65", "90"], ["F1", "80.5", "270"], ["", "", ""]],
        ),
    ] {
        let rows: Vec<&[&str]> = rows.iter().map(|row| &row[..]).collect();
        let (_folder, path) = written(&shp(&shapes), Some(&dbf(&columns, &rows)), Some(UTM));
        let faults = read_fault(&path, &survey_of_cases(), &ImportOptions::default()).unwrap();
        assert_eq!(faults.iter().map(|(fault, _)| fault.name.as_str()).collect::<Vec<_>>(), ["F0", "F1"]);
        for ((fault, report), (dip, east, x)) in
            faults.iter().zip([(65.0_f64, 1.0, 456_500.0), (80.5, -1.0, 457_500.0)])
        {
            assert_eq!(report.format.value, Format::Shapefile);
            let [top, bottom] = [fault.mesh.vertices[0], fault.mesh.vertices[1]];
            let at = top.lerp(bottom, 1000.0 / (bottom.z - top.z));
            let wanted = DVec3::new(x + east * 1000.0 / dip.to_radians().tan(), 5_999_200.0, 1000.0);
            assert!((at - wanted).length() < 1e-6, "{at} {wanted}\n{report}");
        }
    }
    let (_folder, path) = written(&shp(&shapes), None, None);
    let faults = read_fault(&path, &survey_of_cases(), &ImportOptions::default()).unwrap();
    let told = &faults[0].1.notes.join("; ");
    assert!(faults.len() == 1 && told.contains("taken as vertical") && told.contains("no .dbf"), "{told}");
}

#[test]
fn sticks_areas_and_points_with_heights_are_read() {
    let stick = |y: f64| vec![[456_500.0, y, 500.0], [456_600.0, y, 900.0]];
    for kind in [13, 15] {
        let shapes = [Shape { kind, parts: vec![stick(5_999_200.0), stick(6_000_200.0)] }];
        let (_folder, path) = written(&shp(&shapes), Some(&dbf(&[("name", b'C', 4)], &[&["F"]])), Some(UTM));
        let (fault, report) = read_fault(&path, &survey_of_cases(), &ImportOptions::default()).unwrap().remove(0);
        assert_eq!((fault.name.as_str(), fault.mesh.triangles.len()), ("F", 2), "{report}");
    }
    // Points of two formations: with Z, as a cloud, or with a column of heights.
    let place = |n: usize| (456_100.0 + 700.0 * (n % 4) as f64, 5_999_100.0 + 700.0 * (n / 4) as f64);
    let at = |n: usize, z: f64| [place(n).0, place(n).1, z];
    let points = |kind: u32| {
        (0..32)
            .map(|n| Shape { kind, parts: vec![vec![at(n % 16, 800.0 + 400.0 * (n / 16) as f64)]] })
            .collect::<Vec<_>>()
    };
    let names: Vec<&str> = (0..32).map(|n| if n < 16 { "Chalk" } else { "Marl" }).collect();
    let named: Vec<[&str; 1]> = names.iter().map(|name| [*name]).collect();
    let named: Vec<&[&str]> = named.iter().map(|row| &row[..]).collect();
    let with_heights: Vec<[&str; 2]> =
        names.iter().map(|name| [*name, if *name == "Chalk" { "-800" } else { "-1200" }]).collect();
    let with_heights: Vec<&[&str]> = with_heights.iter().map(|row| &row[..]).collect();
    let cloud = |k: usize| Shape { kind: 18, parts: vec![(0..16).map(|n| at(n, 800.0 + 400.0 * k as f64)).collect()] };
    for (what, shapes, table) in [
        ("with Z", points(11), dbf(&[("formation", b'C', 8)], &named)),
        ("as clouds", vec![cloud(0), cloud(1)], dbf(&[("formation", b'C', 8)], &[&["Chalk"], &["Marl"]])),
        ("with a column", points(1), dbf(&[("formation", b'C', 8), ("elev_m", b'N', 8)], &with_heights)),
        ("measured", points(21), dbf(&[("formation", b'C', 8), ("Elevation", b'N', 8)], &with_heights)),
    ] {
        let (_folder, path) = written(&shp(&shapes), Some(&table), Some(UTM));
        let found = read_horizons(&path, &survey_of_cases(), &ImportOptions::default())
            .unwrap_or_else(|e| panic!("{what}: {e}"));
        assert_eq!(
            found.iter().map(|(horizon, _)| horizon.name.as_str()).collect::<Vec<_>>(),
            ["Chalk", "Marl"],
            "{what}"
        );
        assert_eq!((found[0].1.range, found[1].1.range), ([800.0; 2], [1200.0; 2]), "{what}: {}", found[0].1);
    }
    // Measurements of a dip are normals, where a surface of any shape is wanted.
    let dips: Vec<[&str; 3]> = (0..16).map(|_| ["Chalk", "0", "90"]).collect();
    let dips: Vec<&[&str]> = dips.iter().map(|row| &row[..]).collect();
    let table = dbf(&[("formation", b'C', 8), ("dip", b'N', 4), ("azimuth", b'N', 4)], &dips);
    let (_folder, path) = written(&shp(&points(11)[..16]), Some(&table), Some(UTM));
    let any = ImportOptions { shape: Some(HorizonShape::Any), ..ImportOptions::default() };
    let (_, report) = read_horizons(&path, &survey_of_cases(), &any).unwrap().remove(0);
    assert!(report.notes.iter().any(|note| note.contains("points and normals")), "{report}");
}

#[test]
fn coordinate_systems_of_a_shapefile_are_followed_or_refused() {
    let shapes = |scale: f64| {
        let parts =
            line(456_500.0).into_iter().map(|part| part.into_iter().map(|p| p.map(|v| v / scale)).collect()).collect();
        shp(&[Shape { kind: 3, parts }])
    };
    let geographic = UTM
        .split_once("GEOGCS")
        .map(|(_, rest)| format!("GEOGCS{}", rest.split(",PROJECTION").next().unwrap()))
        .unwrap();
    let (_folder, path) = written(&shapes(1.0), None, Some(&geographic));
    let error = read_fault(&path, &survey_of_cases(), &ImportOptions::default()).unwrap_err().to_string();
    assert!(error.contains("degrees") && error.contains("GCS_WGS_1984"), "{error}");
    let (_folder, path) = written(&shapes(1e5), None, None);
    assert!(
        read_fault(&path, &survey_of_cases(), &ImportOptions::default()).unwrap_err().to_string().contains("degrees")
    );
    let feet = UTM.replace("UNIT[\"Meter\",1.0]", "UNIT[\"Foot_US\",0.3048006096012192]");
    let (_folder, path) = written(&shapes(1200.0 / 3937.0), None, Some(&feet));
    let (fault, report) = read_fault(&path, &survey_of_cases(), &ImportOptions::default()).unwrap().remove(0);
    assert!((fault.mesh.vertices[0].x - 456_500.0).abs() < 1e-6, "{report}");
}

#[test]
fn shapefiles_that_are_broken_are_refused_and_never_panic() {
    let survey = survey_of_cases();
    let table = dbf(&[("name", b'C', 4)], &[&["F"]]);
    let whole = shp(&[Shape { kind: 13, parts: vec![line(456_500.0)[0].clone(), line(457_500.0)[0].clone()] }]);
    let refused = |shp: &[u8], dbf: &[u8]| {
        let (_folder, path) = written(shp, Some(dbf), None);
        let _ = describe(&path, &ImportOptions::default());
        read_fault(&path, &survey, &ImportOptions::default()).map(|_| ()).map_err(|error| error.to_string())
    };
    for cut in 100..whole.len() {
        assert!(refused(&whole[..cut], &table).is_err(), "{cut}");
    }
    for cut in 0..table.len() - 1 {
        assert!(refused(&whole, &table[..cut]).is_err(), "{cut}");
    }
    // Counts of parts and of corners, and the start of the second part.
    for at in [144, 148, 156] {
        let mut lying = whole.clone();
        lying[at..at + 4].copy_from_slice(&u32::MAX.to_le_bytes());
        let _ = refused(&lying, &table);
    }
    let mut backward = whole.clone();
    backward[152..156].copy_from_slice(&3_u32.to_le_bytes());
    assert!(refused(&backward, &table).unwrap_err().contains("do not follow"));
    let mut other = whole;
    other[108..112].copy_from_slice(&77_u32.to_le_bytes());
    assert!(refused(&other, &table).unwrap_err().contains("kind 77"));
    let nan = shp(&[Shape { kind: 3, parts: vec![vec![[f64::NAN; 3]; 2]] }]);
    assert!(refused(&nan, &table).unwrap_err().contains("no lines and no points"));
}

#[test]
fn features_take_numbers_that_are_texts_and_zeros_that_are_no_heights() {
    let survey = survey_of_cases();
    let text = "{\"type\":\"FeatureCollection\",\"features\":[{\"type\":\"Feature\",\"properties\":{\"name\":\"A\",\"dip\":\"60\",\
                \"dip_dir\":\"90\"},\"geometry\":{\"type\":\"LineString\",\"coordinates\":[[456500,5999200,0],[456600,6000500,0]]}}]}";
    let (_folder, path) = file("a.geojson", text);
    let (_, report) = read_fault(&path, &survey, &ImportOptions::default()).unwrap().remove(0);
    assert!(report.notes.join(" ").contains("dips by 60 degrees towards 90"), "{report}");
}
