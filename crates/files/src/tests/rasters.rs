//! Grids in binary files of other programs: GeoTIFF, NumPy arrays, classic NetCDF; and GXF. Each is written here by
//! hand, from the definition of its format.

use super::cases::{plane_of_cases, survey_of_cases, worst};
use super::*;
use glam::DVec2;

const N: usize = 31;

/// Depth at column i from the west and row j from the south.
fn z(i: usize, j: usize) -> f64 {
    plane_of_cases(DVec2::new(456_000.0 + 100.0 * i as f64, 5_999_000.0 + 100.0 * j as f64))
}

/// Row by row from the north.
fn from_north() -> Vec<f64> {
    (0..N * N).map(|n| z(n % N, N - 1 - n / N)).collect()
}

/// Row by row from the south.
fn from_south() -> Vec<f64> {
    (0..N * N).map(|n| z(n % N, n / N)).collect()
}

/// The plane of the cases is at every node but `holes`, to `off` metres.
fn is_plane(name: &str, content: &[u8], format: Format, holes: usize, off: f64) -> ImportReport {
    let (_folder, path) = bytes(name, content);
    let found = read_horizons(&path, &survey_of_cases(), &ImportOptions::default());
    let (horizon, report) = found.unwrap_or_else(|error| panic!("{name}: {error}")).remove(0);
    let (worst, count) = worst(&horizon, plane_of_cases);
    assert!(worst <= off && count == N * N - holes, "{name}: {worst} m off at {count} nodes\n{report}");
    assert_eq!(report.format.value, format, "{name}");
    report
}

fn refused(name: &str, content: &[u8]) -> String {
    let (_folder, path) = bytes(name, content);
    let error = read_horizons(&path, &survey_of_cases(), &ImportOptions::default()).unwrap_err();
    let _ = describe(&path, &ImportOptions::default());
    error.to_string()
}

/// The values of a tag.
#[derive(Clone)]
enum Tag {
    Short(Vec<u16>),
    Long(Vec<u32>),
    Double(Vec<f64>),
    Text(&'static str),
}

/// How a TIFF is written.
#[derive(Clone, Copy)]
struct Layout {
    big_endian: bool,
    /// BigTIFF.
    is_64: bool,
}

const LITTLE: Layout = Layout { big_endian: false, is_64: false };

impl Layout {
    fn put(self, value: u64, bytes: usize) -> Vec<u8> {
        let all = if self.big_endian { value.to_be_bytes() } else { value.to_le_bytes() };
        if self.big_endian { all[8 - bytes..].to_vec() } else { all[..bytes].to_vec() }
    }

    /// Type, count and bytes of a tag.
    fn encode(self, tag: &Tag) -> (u64, usize, Vec<u8>) {
        match tag {
            Tag::Short(values) => (3, values.len(), values.iter().flat_map(|v| self.put(u64::from(*v), 2)).collect()),
            Tag::Long(values) => (4, values.len(), values.iter().flat_map(|v| self.put(u64::from(*v), 4)).collect()),
            Tag::Double(values) => (12, values.len(), values.iter().flat_map(|v| self.put(v.to_bits(), 8)).collect()),
            Tag::Text(text) => (2, text.len() + 1, [text.as_bytes(), b"\0"].concat()),
        }
    }

    /// The file: header, chunks of pixels, what does not fit into entries, the directory.
    fn file(self, mut tags: Vec<(u16, Tag)>, chunks: &[Vec<u8>], is_tiled: bool) -> Vec<u8> {
        let word = if self.is_64 { 8 } else { 4 };
        let mut out = if self.big_endian { b"MM".to_vec() } else { b"II".to_vec() };
        out.extend(if self.is_64 {
            [self.put(43, 2), self.put(8, 2), self.put(0, 2)].concat()
        } else {
            self.put(42, 2)
        });
        let directory_at = out.len();
        out.extend(self.put(0, word));
        let mut starts = Vec::new();
        for chunk in chunks {
            starts.push(if chunk.is_empty() { 0 } else { out.len() as u32 });
            out.extend(chunk);
        }
        let (offsets, sizes) = if is_tiled { (324, 325) } else { (273, 279) };
        tags.push((offsets, Tag::Long(starts)));
        tags.push((sizes, Tag::Long(chunks.iter().map(|chunk| chunk.len() as u32).collect())));
        tags.sort_by_key(|(number, _)| *number);
        let mut entries = self.put(tags.len() as u64, if self.is_64 { 8 } else { 2 });
        for (number, tag) in &tags {
            let (kind, count, mut value) = self.encode(tag);
            entries.extend([self.put(u64::from(*number), 2), self.put(kind, 2), self.put(count as u64, word)].concat());
            if value.len() > word {
                let at = out.len() as u64;
                out.extend(&value);
                value = self.put(at, word);
            }
            value.resize(word, 0);
            entries.extend(value);
        }
        let at = self.put(out.len() as u64, word);
        out[directory_at..directory_at + word].copy_from_slice(&at);
        out.extend(entries);
        out.extend(self.put(0, word));
        out
    }
}

/// Tags of a grid of one band whose first pixel is the north-western one, with its outer corner at the tie point.
fn tags(bits: u16, kind: u16, compression: u16) -> Vec<(u16, Tag)> {
    vec![
        (256, Tag::Short(vec![N as u16])),
        (257, Tag::Short(vec![N as u16])),
        (258, Tag::Short(vec![bits])),
        (259, Tag::Short(vec![compression])),
        (262, Tag::Short(vec![1])),
        (277, Tag::Short(vec![1])),
        (278, Tag::Short(vec![N as u16])),
        (339, Tag::Short(vec![kind])),
        (33550, Tag::Double(vec![100.0, 100.0, 0.0])),
        (33922, Tag::Double(vec![0.0, 0.0, 0.0, 455_950.0, 6_002_050.0, 0.0])),
        (34735, Tag::Short(vec![1, 1, 0, 2, 1024, 0, 1, 1, 1025, 0, 1, 1])),
    ]
}

fn with(mut tags: Vec<(u16, Tag)>, others: &[(u16, Tag)]) -> Vec<(u16, Tag)> {
    tags.retain(|(number, _)| others.iter().all(|(other, _)| other != number));
    tags.extend(others.iter().cloned());
    tags
}

fn floats(values: &[f64]) -> Vec<u8> {
    values.iter().flat_map(|v| (*v as f32).to_le_bytes()).collect()
}

/// A zlib stream whose blocks are stored as they are.
fn stored(data: &[u8]) -> Vec<u8> {
    let mut out = vec![0x78, 0x01, 0x01];
    out.extend((data.len() as u16).to_le_bytes());
    out.extend((!(data.len() as u16)).to_le_bytes());
    out.extend(data);
    let (a, b) = data.iter().fold((1_u32, 0_u32), |(a, b), byte| {
        let a = (a + u32::from(*byte)) % 65_521;
        (a, (b + a) % 65_521)
    });
    out.extend((b << 16 | a).to_be_bytes());
    out
}

/// LZW whose codes are bytes, with the table cleared before codes get longer than nine bits.
fn lzw(data: &[u8]) -> Vec<u8> {
    let codes = data.chunks(250).flat_map(|part| std::iter::once(256_u16).chain(part.iter().map(|b| u16::from(*b))));
    let bits: Vec<bool> =
        codes.chain([257]).flat_map(|code| (0..9).rev().map(move |bit| code >> bit & 1 == 1)).collect();
    bits.chunks(8)
        .map(|byte| byte.iter().enumerate().fold(0, |sum, (n, bit)| sum | u8::from(*bit) << (7 - n)))
        .collect()
}

/// A strip of deflate over the first traces of a survey.
pub(super) fn small_geotiff() -> Vec<u8> {
    let place = [
        (256, Tag::Short(vec![3])),
        (257, Tag::Short(vec![2])),
        (278, Tag::Short(vec![2])),
        (33550, Tag::Double(vec![25.0, 25.0, 0.0])),
        (33922, Tag::Double(vec![0.0, 0.0, 0.0, 0.0, 50.0, 0.0])),
        (42113, Tag::Text("-9999")),
    ];
    let pixels = stored(&floats(&[40.0, 41.0, 42.0, 43.0, -9999.0, 45.0]));
    LITTLE.file(with(tags(32, 3, 8), &place), &[pixels], false)
}

#[test]
fn geotiffs_as_gdal_qgis_and_arcgis_write_them_are_the_plane_of_the_cases() {
    let values = from_north();
    let f4 = floats(&values);
    let i2: Vec<u8> = values.iter().flat_map(|v| (*v as i16).to_le_bytes()).collect();
    let u2: Vec<u8> = values.iter().flat_map(|v| (*v as u16).to_le_bytes()).collect();
    let f8: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
    let f8_big: Vec<u8> = values.iter().flat_map(|v| v.to_be_bytes()).collect();
    let i4: Vec<u8> = values.iter().flat_map(|v| (*v as i32).to_le_bytes()).collect();
    let point = [
        (33922, Tag::Double(vec![0.0, 0.0, 0.0, 456_000.0, 6_002_000.0, 0.0])),
        (34735, Tag::Short(vec![1, 1, 0, 2, 1024, 0, 1, 1, 1025, 0, 1, 2])),
    ];
    let matrix = [
        (33550, Tag::Double(vec![])),
        (33922, Tag::Double(vec![])),
        (
            34264,
            Tag::Double(
                [[100.0, 0.0, 0.0, 455_950.0], [0.0, -100.0, 0.0, 6_002_050.0], [0.0; 4], [0.0, 0.0, 0.0, 1.0]]
                    .concat(),
            ),
        ),
    ];
    // The tie point may be that of another pixel.
    let middle = [(33922, Tag::Double(vec![10.0, 20.0, 0.0, 456_950.0, 6_000_050.0, 0.0]))];
    let big = Layout { big_endian: true, is_64: false };
    let big_tiff = Layout { big_endian: false, is_64: true };
    for (name, layout, tags, pixels) in [
        ("float", LITTLE, tags(32, 3, 1), f4.clone()),
        ("int16", LITTLE, tags(16, 2, 1), i2),
        ("uint16, LZW", LITTLE, tags(16, 1, 5), lzw(&u2)),
        ("int32", LITTLE, tags(32, 2, 1), i4),
        ("double", LITTLE, tags(64, 3, 1), f8),
        ("big-endian double", big, tags(64, 3, 1), f8_big),
        ("deflate", LITTLE, tags(32, 3, 8), stored(&f4)),
        ("old deflate", LITTLE, tags(32, 3, 32946), stored(&f4)),
        ("BigTIFF", big_tiff, tags(32, 3, 1), f4.clone()),
        ("pixel is point", LITTLE, with(tags(32, 3, 1), &point), f4.clone()),
        ("matrix", LITTLE, with(tags(32, 3, 1), &matrix), f4.clone()),
        ("other tie point", LITTLE, with(tags(32, 3, 1), &middle), f4.clone()),
    ] {
        let report = is_plane(&format!("{name}.tif"), &layout.file(tags, &[pixels], false), Format::GeoTiff, 0, 0.01);
        assert!(report.assumptions.iter().any(|note| note.to_string().contains("grow downwards")), "{report}");
    }
    // Rows from the south, in strips of ten.
    let south = [
        (278, Tag::Short(vec![10])),
        (
            34264,
            Tag::Double(
                [[100.0, 0.0, 0.0, 455_950.0], [0.0, 100.0, 0.0, 5_998_950.0], [0.0; 4], [0.0, 0.0, 0.0, 1.0]].concat(),
            ),
        ),
    ];
    let strips: Vec<Vec<u8>> = floats(&from_south()).chunks(10 * N * 4).map(<[u8]>::to_vec).collect();
    is_plane("south.tif", &LITTLE.file(with(tags(32, 3, 1), &south), &strips, false), Format::GeoTiff, 0, 0.01);
}

#[test]
fn tiles_holes_and_what_gdal_says_of_a_band_are_read() {
    // 2 by 2 tiles of 16 by 16; pixels beyond the grid are anything.
    let tile = |x: usize, y: usize| {
        let at = |n: usize| (x * 16 + n % 16, y * 16 + n / 16);
        floats(&(0..256).map(at).map(|(i, j)| if i < N && j < N { z(i, N - 1 - j) } else { 7.0 }).collect::<Vec<_>>())
    };
    let sides = [(322, Tag::Short(vec![16])), (323, Tag::Short(vec![16]))];
    let tiled = with(tags(32, 3, 1), &sides);
    let tiled: Vec<(u16, Tag)> = tiled.into_iter().filter(|(number, _)| *number != 278).collect();
    let mut tiles = vec![tile(0, 0), tile(1, 0), tile(0, 1), tile(1, 1)];
    is_plane("tiles.tif", &LITTLE.file(tiled.clone(), &tiles, true), Format::GeoTiff, 0, 0.01);
    tiles[3].clear();
    is_plane("sparse.tif", &LITTLE.file(tiled, &tiles, true), Format::GeoTiff, 15 * 15, 0.01);

    let holed = |null: f64| {
        let mut values = from_north();
        values[40] = null;
        floats(&values)
    };
    for (text, null) in
        [("-9999", -9999.0), ("nan", f64::NAN), ("-3.4028234663852886e+38 ", f64::from(f32::MIN)), ("0", 0.0)]
    {
        let told = with(tags(32, 3, 1), &[(42113, Tag::Text(text))]);
        is_plane("null.tif", &LITTLE.file(told, &[holed(null)], false), Format::GeoTiff, 1, 0.01);
    }
    // Hundredths from 500 m on, with a name and a unit.
    let packed: Vec<u8> = from_north().iter().flat_map(|v| ((v - 500.0) * 100.0).round().to_le_bytes()).collect();
    let facts = Tag::Text(
        "<GDALMetadata>\n  <Item name=\"DESCRIPTION\" sample=\"0\" role=\"description\">Top Chalk</Item>\n  <Item name=\"OFFSET\" \
         sample=\"0\" role=\"offset\">500</Item>\n  <Item name=\"SCALE\" sample=\"0\" role=\"scale\">0.01</Item>\n  <Item \
         name=\"UNITTYPE\" sample=\"0\" role=\"unittype\">m</Item>\n</GDALMetadata>",
    );
    let report = is_plane(
        "scaled.tif",
        &LITTLE.file(with(tags(64, 3, 1), &[(42112, facts)]), &[packed], false),
        Format::GeoTiff,
        0,
        0.01,
    );
    assert_eq!((report.name.as_str(), report.z_unit.value), ("Top Chalk", ZUnit::Metres));
    assert!(matches!(report.z_unit.source, Provenance::File(_)), "{report}");
    // X and Y in US survey feet, by a code and by a size.
    let foot = 1200.0 / 3937.0;
    for keys in [[3076, 0, 1, 9003], [3077, 34736, 1, 0]] {
        let feet = [
            (33550, Tag::Double(vec![100.0 / foot, 100.0 / foot, 0.0])),
            (33922, Tag::Double(vec![0.0, 0.0, 0.0, 455_950.0 / foot, 6_002_050.0 / foot, 0.0])),
            (34735, Tag::Short([&[1, 1, 0, 2, 1024, 0, 1, 1][..], &keys].concat())),
            (34736, Tag::Double(vec![foot])),
        ];
        let report = is_plane(
            "feet.tif",
            &LITTLE.file(with(tags(32, 3, 1), &feet), &[floats(&from_north())], false),
            Format::GeoTiff,
            0,
            0.01,
        );
        assert!(report.notes.iter().any(|note| note.contains("X and Y are in usft")), "{report}");
    }
}

#[test]
fn geotiffs_that_are_no_grid_of_heights_are_refused_with_the_sentence_that_helps() {
    let f4 = floats(&from_north());
    let degrees = [(34735, Tag::Short(vec![1, 1, 0, 1, 1024, 0, 1, 2]))];
    let rgb = [
        (258, Tag::Short(vec![8; 3])),
        (262, Tag::Short(vec![2])),
        (277, Tag::Short(vec![3])),
        (339, Tag::Short(vec![1; 3])),
    ];
    let nowhere = [(33550, Tag::Double(vec![])), (33922, Tag::Double(vec![]))];
    let huge = [(256, Tag::Long(vec![4_000_000_000]))];
    let wide = [(322, Tag::Long(vec![0x7fff_fff0])), (323, Tag::Long(vec![0x7fff_fff0]))];
    for (others, words) in [
        (&degrees[..], "degrees"),
        (&rgb, "gdal_translate -b 1"),
        (&nowhere, "no place"),
        (&huge, "truncated or its header is wrong"),
        (&[(259, Tag::Short(vec![50_000]))], "COMPRESS=DEFLATE"),
        (&[(262, Tag::Short(vec![0]))], "a picture"),
        (&wide, ""),
        (&[(278, Tag::Short(vec![1]))], "copied in full"),
    ] {
        let error =
            refused("a.tif", &LITTLE.file(with(tags(32, 3, 1), others), std::slice::from_ref(&f4), words.is_empty()));
        assert!(error.contains(words), "{words}: {error}");
    }
    let whole = LITTLE.file(tags(32, 3, 8), &[stored(&f4)], false);
    for cut in (0..whole.len()).step_by(97) {
        refused("a.tif", &whole[..cut]);
    }
}

fn npy(version: u8, header: &str, data: &[u8]) -> Vec<u8> {
    let length = header.len() as u32;
    let length = if version == 1 { length.to_le_bytes()[..2].to_vec() } else { length.to_le_bytes().to_vec() };
    [b"\x93NUMPY", &[version, 0][..], &length, header.as_bytes(), data].concat()
}

/// The plane `[inline][crossline]`: inlines count along X.
fn by_lines() -> Vec<f64> {
    (0..N * N).map(|n| z(n / N, n % N)).collect()
}

#[test]
fn arrays_of_numpy_are_horizons_over_the_survey_or_points() {
    let values = by_lines();
    let head = |kind: &str, fortran: &str, shape: &str| {
        format!("{{'descr': '{kind}', 'fortran_order': {fortran}, 'shape': {shape}, }}\n")
    };
    let of = |encode: fn(f64) -> Vec<u8>| values.iter().flat_map(|v| encode(*v)).collect::<Vec<u8>>();
    let (f8, f4) = (of(|v| v.to_le_bytes().to_vec()), of(|v| (v as f32).to_le_bytes().to_vec()));
    let columns: Vec<u8> = (0..N * N).flat_map(|n| z(n % N, n / N).to_le_bytes()).collect();
    for (name, content) in [
        ("f8", npy(1, &head("<f8", "False", "(31, 31)"), &f8)),
        ("f4, version 2", npy(2, &head("<f4", "False", "(31, 31)"), &f4)),
        ("big-endian, version 3", npy(3, &head(">f8", "False", "(31, 31)"), &of(|v| v.to_be_bytes().to_vec()))),
        ("Fortran order", npy(1, &head("<f8", "True", "(31, 31)"), &columns)),
        ("i4", npy(1, &head("<i4", "False", "(31, 31)"), &of(|v| (v as i32).to_le_bytes().to_vec()))),
        ("u2", npy(1, &head("|u2", "False", "(31, 31)"), &of(|v| (v as u16).to_le_bytes().to_vec()))),
        ("one more axis", npy(1, &head("<f8", "False", "(1, 31, 31)"), &f8)),
        ("Python 2", npy(1, &head("<f8", "False", "(31L, 31L)"), &f8)),
        ("another order of keys", npy(1, "{\"shape\":(31,31),\"fortran_order\":False,\"descr\":\"<f8\"}", &f8)),
    ] {
        let report = is_plane(&format!("{name}.npy"), &content, Format::Npy, 0, 0.01);
        assert!(report.notes.iter().any(|note| note.contains("each inline and crossline")), "{report}");
    }
    let mut holed = f8.clone();
    holed[80..88].copy_from_slice(&f64::NAN.to_le_bytes());
    is_plane("nan.npy", &npy(1, &head("<f8", "False", "(31, 31)"), &holed), Format::Npy, 1, 0.01);
    let points: Vec<u8> = (0..N * N)
        .flat_map(|n| [456_000.0 + 100.0 * (n % N) as f64, 5_999_000.0 + 100.0 * (n / N) as f64, z(n % N, n / N)])
        .flat_map(f64::to_le_bytes)
        .collect();
    is_plane("points.npy", &npy(1, &head("<f8", "False", "(961, 3)"), &points), Format::Npy, 0, 0.01);

    for (content, words) in [
        (
            npy(1, &head("<f8", "False", "(31, 30)"), &f8[..31 * 30 * 8]),
            "31 by 30 values, where the survey has 31 inlines",
        ),
        (npy(1, &head("<f8", "False", "(31, 31, 2)"), &[&f8[..], &f8].concat()), "which is a volume"),
        (npy(1, &head("<f8", "False", "(31, 31)"), &f8[..100]), "expected 7688, found 100"),
        (npy(1, &head("<f8", "False", "(99999999999, 99999999999)"), &f8), "a shape of"),
        (npy(1, &head("<c8", "False", "(31, 31)"), &f8), "astype"),
        (npy(1, "{'descr': [('x', '<f4')], 'fortran_order': False, 'shape': (3,), }", &f8), "astype"),
        (npy(1, &head("|O", "False", "(31, 31)"), &f8), "astype"),
        (npy(1, &head("<€€€€€€", "False", "(31, 31)"), &f8), "astype"),
        (npy(1, "{'descr': '<f8', 'fortran_order': False, }", &f8), "shape"),
        (npy(9, &head("<f8", "False", "(31, 31)"), &f8), "version 9"),
        (npy(2, "", &[0xff; 40])[..9].to_vec(), "cut off"),
        (npy(1, &head("<f8", "False", "(7,)"), &f8[..56]), "two axes"),
    ] {
        let error = refused("a.npy", &content);
        assert!(error.contains(words), "{words}: {error}");
    }
    let narrow =
        SurveyGeometry { crosslines: survey::geometry::LineAxis { first: 1, step: 1, count: 20 }, ..survey_of_cases() };
    let (_folder, path) = bytes("a.npy", &npy(1, &head("<f8", "False", "(20, 31)"), &f8[..20 * 31 * 8]));
    let error = read_horizons(&path, &narrow, &ImportOptions::default()).unwrap_err().to_string();
    assert!(error.contains("transpose it"), "{error}");
    let told = describe(&path, &ImportOptions::default()).unwrap();
    assert!(told.surfaces[0].shape.contains("20 x 31") && told.surfaces[0].notes[0].contains("no places"), "{told:?}");
}

#[test]
fn gxf_grids_of_every_sense_and_packing_are_the_plane_of_the_cases() {
    let head = |others: &str| {
        format!(
            "Made by hand, 2026\n#TITLE\n\"A, B\"\n#POINTS\n31\n#ROWS\n31\n#PTSEPARATION\n100\n#RWSEPARATION\n100\n#XORIGIN\n456000\n\
             #YORIGIN\n5999000\n#ROTATION\n0\n{others}#GRID\n"
        )
    };
    let text = |at: &dyn Fn(usize, usize) -> (usize, usize)| {
        let row =
            |r: usize| (0..N).map(|p| at(p, r)).map(|(i, j)| format!("{:.2} ", z(i, j))).collect::<String>() + "\n";
        (0..N).map(row).collect::<String>()
    };
    let m = N - 1;
    for (sense, at) in [
        ("", &(|p, r| (p, r)) as &dyn Fn(usize, usize) -> (usize, usize)),
        ("#SENSE\n1\n", &|p, r| (p, r)),
        ("#SENSE\n-1\n", &|p, r| (r, p)),
        ("#SENSE\n2\n", &|p, r| (r, m - p)),
        ("#SENSE\n-2\n", &|p, r| (p, m - r)),
        ("#SENSE\n3\n", &|p, r| (m - p, m - r)),
        ("#SENSE\n-3\n", &|p, r| (m - r, m - p)),
        ("#SENSE\n4\n", &|p, r| (m - r, p)),
        ("#SENSE\n-4\n", &|p, r| (m - p, r)),
    ] {
        let report = is_plane("a.gxf", (head(sense) + &text(at)).as_bytes(), Format::Gxf, 0, 0.01);
        assert_eq!(report.name, "A, B", "{sense}");
    }
    let plain = text(&|p, r| (p, r));
    is_plane(
        "a.gxf",
        (head("#DUMMY\n-1e12\n") + &plain.replacen("1000.00", "-1e12", 1)).as_bytes(),
        Format::Gxf,
        1,
        0.01,
    );
    is_plane(
        "a.gxf",
        (head("#DUMMY\n*\n") + &plain.replacen("1000.00", "*", 1)).replace('\n', "\r\n").as_bytes(),
        Format::Gxf,
        1,
        0.01,
    );
    let doubled = plain
        .split_whitespace()
        .map(|v| format!("{}\n", (v.parse::<f64>().unwrap() - 500.0) * 2.0))
        .collect::<String>();
    is_plane("a.gxf", (head("#TRANSFORM\n0.5, 500\n") + &doubled).as_bytes(), Format::Gxf, 0, 0.01);

    // Three characters of base 90: hundredths of a metre up to 7290.
    let packed = |value: f64| {
        let n = (value * 100.0).round() as u32;
        [n / 8100, n / 90 % 90, n % 90].map(|digit| char::from(37 + digit as u8)).iter().collect::<String>()
    };
    let row = |r: usize| {
        let first = if r == 0 { "!!!".to_owned() } else { packed(z(0, r)) };
        first + &(1..N).map(|p| packed(z(p, r))).collect::<String>() + "\n"
    };
    let content = head("#GTYPE\n3\n#TRANSFORM\n0.01,0\n") + &(0..N).map(row).collect::<String>();
    is_plane("a.gxf", content.as_bytes(), Format::Gxf, 1, 0.01);
    // A row of one value and a row of none, each repeated.
    let flat = "#POINTS\n40\n#ROWS\n2\n#PTSEPARATION\n50\n#RWSEPARATION\n100\n#XORIGIN\n456000\n#YORIGIN\n5999000\n#GTYPE\n3\n#TRANSFORM\n0.01,0\n#GRID\n";
    let repeated = format!("{flat}\"\"\"%%M{}\n\"\"\"%%M!!!\n", packed(1234.5));
    let (_folder, path) = bytes("a.gxf", repeated.as_bytes());
    let told = &describe(&path, &ImportOptions::default()).unwrap().surfaces[0];
    assert_eq!((told.values, told.nulls, told.range), (80, 40, Some([1234.5; 2])));

    for (content, words) in [
        (head("") + "1 2 3\n", "expected 961, found 3"),
        (head("").replace("#GRID\n", ""), "no #GRID"),
        (head("#SENSE\n7\n") + &plain, "#SENSE 7"),
        (head("").replace("#ROWS\n31", "#ROWS\nmany") + &plain, "#ROWS"),
        (flat.replace("40", "60000").replace("#ROWS\n2", "#ROWS\n60000") + "\"\"\"~~~%%%", "truncated"),
        (flat.to_owned() + "\"\"\"~~~%%%", "expected 80, found"),
        (flat.to_owned() + "abc", "expected 80, found 1"),
        (flat.to_owned() + "\u{1}bc", "base 90"),
        (head("") + &plain.replacen("1000.00", "ten", 1), "a grid value"),
    ] {
        let error = refused("a.gxf", content.as_bytes());
        assert!(error.contains(words), "{words}: {error}");
    }
}
