//! Classic NetCDF grids, written by hand from the definition of the format.

use super::cases::{plane_of_cases, survey_of_cases, worst};
use super::*;
use glam::DVec2;

const N: usize = 31;
/// Types of numbers.
const CHAR: u32 = 2;
const SHORT: u32 = 3;
const INT: u32 = 4;
const FLOAT: u32 = 5;
const DOUBLE: u32 = 6;

fn z(i: usize, j: usize) -> f64 {
    plane_of_cases(DVec2::new(456_000.0 + 100.0 * i as f64, 5_999_000.0 + 100.0 * j as f64))
}

fn encoded(kind: u32, values: &[f64]) -> Vec<u8> {
    let one = |v: &f64| match kind {
        SHORT => (*v as i16).to_be_bytes().to_vec(),
        INT => (*v as i32).to_be_bytes().to_vec(),
        FLOAT => (*v as f32).to_be_bytes().to_vec(),
        _ => v.to_be_bytes().to_vec(),
    };
    values.iter().flat_map(one).collect()
}

fn filled(mut bytes: Vec<u8>) -> Vec<u8> {
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    bytes
}

/// A variable: name, dimensions, attributes (name, type, text or numbers), type, values.
struct Variable {
    name: &'static str,
    dimensions: Vec<u32>,
    attributes: Vec<(&'static str, u32, &'static str, Vec<f64>)>,
    kind: u32,
    values: Vec<f64>,
}

impl Variable {
    fn of(name: &'static str, dimensions: &[u32], kind: u32, values: Vec<f64>) -> Self {
        Self { name, dimensions: dimensions.to_vec(), attributes: Vec::new(), kind, values }
    }

    fn text(mut self, name: &'static str, text: &'static str) -> Self {
        self.attributes.push((name, CHAR, text, Vec::new()));
        self
    }

    fn number(mut self, name: &'static str, kind: u32, value: f64) -> Self {
        self.attributes.push((name, kind, "", vec![value]));
        self
    }
}

/// The file of a version: dimensions (name, length), a title, variables.
fn file_of(version: u8, dimensions: &[(&str, u64)], variables: &[Variable]) -> Vec<u8> {
    let count = |n: u64| if version == 5 { n.to_be_bytes().to_vec() } else { (n as u32).to_be_bytes().to_vec() };
    let offset = |n: u64| if version == 1 { (n as u32).to_be_bytes().to_vec() } else { n.to_be_bytes().to_vec() };
    let name = |text: &str| [count(text.len() as u64), filled(text.as_bytes().to_vec())].concat();
    let mark = |mark: u32, n: usize| [mark.to_be_bytes().to_vec(), count(n as u64)].concat();
    let attribute = |(own, kind, text, numbers): &(&str, u32, &str, Vec<f64>)| {
        let (n, bytes) = match *kind {
            CHAR => (text.len(), text.as_bytes().to_vec()),
            kind => (numbers.len(), encoded(kind, numbers)),
        };
        [name(own), kind.to_be_bytes().to_vec(), count(n as u64), filled(bytes)].concat()
    };
    let records = dimensions.iter().position(|(_, length)| *length == 0);
    let rows = |v: &Variable| records.is_some_and(|r| v.dimensions.first() == Some(&(r as u32)));
    let of_records: Vec<&Variable> = variables.iter().filter(|v| rows(v)).collect();
    let n_records = if of_records.is_empty() { 0 } else { N as u64 };
    let header = |begins: &[u64]| {
        let mut out = vec![b'C', b'D', b'F', version];
        out.extend(count(n_records));
        out.extend(mark(0x0a, dimensions.len()));
        dimensions.iter().for_each(|(own, length)| out.extend([name(own), count(*length)].concat()));
        out.extend(mark(0x0c, 1));
        out.extend(attribute(&("title", CHAR, "made by hand", Vec::new())));
        out.extend(mark(0x0b, variables.len()));
        for (v, begin) in variables.iter().zip(begins) {
            out.extend([name(v.name), count(v.dimensions.len() as u64)].concat());
            v.dimensions.iter().for_each(|d| out.extend(count(u64::from(*d))));
            out.extend(if v.attributes.is_empty() { mark(0, 0) } else { mark(0x0c, v.attributes.len()) });
            v.attributes.iter().for_each(|a| out.extend(attribute(a)));
            out.extend(v.kind.to_be_bytes());
            out.extend(count(filled(encoded(v.kind, &v.values)).len() as u64));
            out.extend(offset(*begin));
        }
        out
    };
    let start = header(&vec![0; variables.len()]).len() as u64;
    let (mut begins, mut data) = (vec![0; variables.len()], Vec::new());
    for (n, v) in variables.iter().enumerate().filter(|(_, v)| !rows(v)) {
        begins[n] = start + data.len() as u64;
        data.extend(filled(encoded(v.kind, &v.values)));
    }
    for row in 0..n_records as usize {
        for (n, v) in variables.iter().enumerate().filter(|(_, v)| rows(v)) {
            if row == 0 {
                begins[n] = start + data.len() as u64;
            }
            let each = v.values.len() / N;
            let part = encoded(v.kind, &v.values[row * each..(row + 1) * each]);
            data.extend(if of_records.len() == 1 { part } else { filled(part) });
        }
    }
    [header(&begins), data].concat()
}

fn x() -> Variable {
    Variable::of("x", &[1], DOUBLE, (0..N).map(|i| 456_000.0 + 100.0 * i as f64).collect()).text("units", "m")
}

fn y() -> Variable {
    Variable::of("y", &[0], DOUBLE, (0..N).map(|j| 5_999_000.0 + 100.0 * j as f64).collect())
}

fn from_south() -> Vec<f64> {
    (0..N * N).map(|n| z(n % N, n / N)).collect()
}

fn from_north() -> Vec<f64> {
    (0..N * N).map(|n| z(n % N, N - 1 - n / N)).collect()
}

const SIDES: [(&str, u64); 2] = [("y", N as u64), ("x", N as u64)];

fn is_plane(what: &str, content: &[u8], options: &ImportOptions, holes: usize) -> ImportReport {
    let (_folder, path) = bytes("a.nc", content);
    let found = read_horizons(&path, &survey_of_cases(), options);
    let (horizon, report) = found.unwrap_or_else(|error| panic!("{what}: {error}")).remove(0);
    let (worst, count) = worst(&horizon, plane_of_cases);
    assert!(worst < 0.01 && count == N * N - holes, "{what}: {worst} m off at {count} nodes\n{report}");
    assert_eq!(report.format.value, Format::NetCdf);
    report
}

fn refused(content: &[u8]) -> String {
    let (_folder, path) = bytes("a.nc", content);
    let _ = describe(&path, &ImportOptions::default());
    read_horizons(&path, &survey_of_cases(), &ImportOptions::default()).unwrap_err().to_string()
}

/// A grid of 2 by 3 nodes near the origin.
pub(super) fn small_grid() -> Vec<u8> {
    let axis = |name, dimension: u32, count: usize| {
        Variable::of(name, &[dimension], DOUBLE, (0..count).map(|n| 25.0 * n as f64).collect())
    };
    let z = Variable::of("z", &[0, 1], FLOAT, (0..6).map(|n| 40.0 + f64::from(n)).collect()).number(
        "_FillValue",
        FLOAT,
        45.0,
    );
    file_of(1, &[("y", 2), ("x", 3)], &[axis("x", 1, 3), axis("y", 0, 2), z])
}

#[test]
fn netcdf_grids_as_gmt_gdal_and_xarray_write_them_are_the_plane_of_the_cases() {
    let plain = ImportOptions::default();
    let grid = |kind: u32, values: Vec<f64>| Variable::of("z", &[0, 1], kind, values);
    for version in [1, 2, 5] {
        for kind in [SHORT, INT, FLOAT, DOUBLE] {
            let content = file_of(version, &SIDES, &[x(), y(), grid(kind, from_south())]);
            is_plane(&format!("version {version}, type {kind}"), &content, &plain, 0);
        }
    }
    let north = Variable::of("y", &[0], FLOAT, (0..N).rev().map(|j| 5_999_000.0 + 100.0 * j as f64).collect());
    is_plane("y from the north", &file_of(1, &SIDES, &[x(), north, grid(FLOAT, from_north())]), &plain, 0);
    // GDAL has a variable of one character for the projection, and calls its grid Band1.
    let projection = Variable { kind: CHAR, ..Variable::of("transverse_mercator", &[], CHAR, Vec::new()) };
    let band = Variable::of("Band1", &[0, 1], FLOAT, from_south()).text("grid_mapping", "transverse_mercator");
    assert_eq!(is_plane("GDAL", &file_of(1, &SIDES, &[projection, x(), y(), band]), &plain, 0).name, "a");
    let mut holed = from_south();
    holed[5] = -9999.0;
    let fill =
        grid(FLOAT, holed.clone()).number("_FillValue", FLOAT, -9999.0).text("units", "m").text("positive", "down");
    let report = is_plane("fill", &file_of(1, &SIDES, &[x(), y(), fill]), &plain, 1);
    assert!(report.assumptions.is_empty(), "{report}");
    let missing = grid(SHORT, holed).number("missing_value", SHORT, -9999.0);
    is_plane("missing", &file_of(1, &SIDES, &[x(), y(), missing]), &plain, 1);
    let packed = from_south().iter().map(|v| (v - 1000.0) * 10.0).collect();
    let packed = grid(SHORT, packed).number("scale_factor", DOUBLE, 0.1).number("add_offset", DOUBLE, 1000.0);
    is_plane("scale", &file_of(1, &SIDES, &[x(), y(), packed]), &plain, 0);
    let up = grid(FLOAT, from_south().iter().map(|v| -v).collect()).text("positive", "up").text("units", "metres");
    is_plane("positive up", &file_of(2, &SIDES, &[x(), y(), up]), &plain, 0);
    // xarray: names of its own, and an axis of one time.
    let axes = [("time", 1), ("northing", N as u64), ("easting", N as u64)];
    let own = [
        Variable::of("time", &[0], DOUBLE, vec![0.0]),
        Variable { name: "easting", dimensions: vec![2], ..x() },
        Variable { name: "northing", dimensions: vec![1], ..y() },
        Variable::of("top_chalk", &[0, 1, 2], DOUBLE, from_south()),
        Variable::of("base_chalk", &[1, 2], DOUBLE, from_south().iter().map(|v| v + 100.0).collect()),
    ];
    let content = file_of(2, &axes, &own);
    is_plane("xarray", &content, &ImportOptions { select: Some("top_chalk".into()), ..ImportOptions::default() }, 0);
    let (_folder, path) = bytes("a.nc", &content);
    let names: Vec<String> = read_horizons(&path, &survey_of_cases(), &plain)
        .unwrap()
        .into_iter()
        .map(|(horizon, _)| horizon.name)
        .collect();
    assert_eq!(names, ["top_chalk", "base_chalk"]);
    // Rows that are records, alone and beside another variable of records.
    let records = [("y", 0), ("x", N as u64)];
    is_plane("records", &file_of(1, &records, &[x(), y(), grid(SHORT, from_south())]), &plain, 0);
    let fixed = Variable { kind: FLOAT, ..y() };
    is_plane("records", &file_of(1, &records, &[x(), fixed, grid(SHORT, from_south())]), &plain, 0);
}

#[test]
fn grids_of_the_old_gmt_are_read_with_nodes_and_with_pixels() {
    for (is_pixel, half) in [(0.0, 0.0), (1.0, 50.0)] {
        let pair = |name: &'static str, a: f64, b: f64| Variable::of(name, &[0], DOUBLE, vec![a, b]);
        let content = file_of(
            1,
            &[("side", 2), ("xysize", (N * N) as u64)],
            &[
                pair("x_range", 456_000.0 - half, 459_000.0 + half).text("units", "m"),
                pair("y_range", 5_999_000.0 - half, 6_002_000.0 + half),
                pair("z_range", 1000.0, 1900.0),
                pair("spacing", 100.0, 100.0),
                Variable::of("dimension", &[0], INT, vec![N as f64; 2]),
                Variable::of("z", &[1], FLOAT, from_north())
                    .number("scale_factor", DOUBLE, 1.0)
                    .number("add_offset", DOUBLE, 0.0)
                    .number("node_offset", INT, is_pixel),
            ],
        );
        is_plane("old GMT", &content, &ImportOptions::default(), 0);
    }
}

#[test]
fn netcdf_files_that_are_no_grid_are_refused_and_never_panic() {
    let grid = || Variable::of("z", &[0, 1], FLOAT, from_south());
    let lon = || Variable {
        name: "lon",
        ..Variable::of("lon", &[1], DOUBLE, (0..N).map(|i| 3.0 + i as f64 / 1000.0).collect())
    };
    let lat = Variable::of("lat", &[0], DOUBLE, (0..N).map(|i| 54.0 + i as f64 / 1000.0).collect())
        .text("units", "degrees_north");
    let degrees = file_of(1, &[("lat", N as u64), ("lon", N as u64)], &[lon(), lat, grid()]);
    assert!(refused(&degrees).contains("degrees"));
    let uneven = Variable::of("x", &[1], DOUBLE, (0..N).map(|i| 456_000.0 + (i * i) as f64).collect());
    assert!(refused(&file_of(1, &SIDES, &[uneven, y(), grid()])).contains("x are not evenly spaced"));
    assert!(refused(&file_of(1, &SIDES, &[grid()])).contains("none of its variables"));
    let whole = file_of(1, &SIDES, &[x(), y(), grid()]);
    for cut in (4..whole.len()).step_by(61) {
        assert!(!refused(&whole[..cut]).is_empty());
    }
    let lying = file_of(5, &[("y", u64::MAX / 2), ("x", N as u64)], &[x(), y(), grid()]);
    assert!(refused(&lying).contains("bytes of its variables"));
    // Many variables that share their bytes would take more memory than the file has.
    let mut shared = file_of(1, &SIDES, &[x(), y(), grid(), grid()]);
    shared.truncate(shared.len() - N * N * 4);
    assert!(refused(&shared).contains("bytes of its variables"));
}
