//! Real files against the table of what an independent reader finds in them.

use crate::unit::ZUnit;
use std::path::Path;

use super::super::{SegyFile, SegyOptions, SegyProblem, read, scan};
use survey::progress::Progress;

/// A row of `segy-expected.tsv`.
struct Row {
    cells: Vec<String>,
    names: Vec<String>,
}

impl Row {
    fn text(&self, name: &str) -> &str {
        let index = self.names.iter().position(|n| n == name).unwrap_or_else(|| panic!("no column {name}"));
        self.cells.get(index).map_or("", String::as_str)
    }

    fn number(&self, name: &str) -> f64 {
        self.text(name).parse().unwrap_or_else(|_| panic!("{}: {name} is {:?}", self.text("file"), self.text(name)))
    }

    /// `300..427 (128)` as first, last, count.
    fn lines(&self, name: &str) -> [i64; 3] {
        let parts: Vec<i64> =
            self.text(name).split(['.', ' ', '(', ')']).filter(|s| !s.is_empty()).map(|s| s.parse().unwrap()).collect();
        parts.try_into().unwrap()
    }

    /// `(trace, sample, value)` of the probes.
    fn probes(&self) -> Vec<(usize, usize, f64)> {
        self.text("probe")
            .split(';')
            .map(|probe| {
                let words: Vec<&str> = probe.split_whitespace().collect();
                (words[1].parse().unwrap(), words[3].parse().unwrap(), words[5].parse().unwrap())
            })
            .collect()
    }
}

fn rows(dir: &Path) -> Vec<Row> {
    let table = std::fs::read_to_string(dir.join("segy-expected.tsv")).unwrap();
    let mut lines = table.lines().map(|line| line.split('\t').map(str::to_owned).collect::<Vec<_>>());
    let names = lines.next().unwrap();
    lines.map(|cells| Row { cells, names: names.clone() }).collect()
}

/// Files that are refused, and words of the sentence.
const REFUSED: [(&str, &str); 3] =
    [("small-ps.sgy", "pre-stack"), ("shot-gather.sgy", "shot gathers"), ("broken.sgy", "cut off inside trace 4")];

#[test]
fn every_file_reads_as_expected_or_is_refused_with_its_sentence() {
    let Some(dir) = testdata::folder() else { return };
    let rows = rows(&dir);
    assert!(rows.len() > 30);
    for row in &rows {
        let name = row.text("file");
        let path = dir.join(name);
        let opened = SegyFile::open(&path, &SegyOptions::default(), &Progress::silent());
        if let Some((_, words)) = REFUSED.iter().find(|(file, _)| name.ends_with(file)) {
            let sentence = opened.expect_err(name).to_string();
            assert!(sentence.contains(words) && sentence.contains(name), "{sentence}");
            continue;
        }
        let file = opened.unwrap_or_else(|e| panic!("{e}"));
        let info = file.info();
        assert_eq!(info.bytes as f64, row.number("bytes"), "{name}");
        assert_eq!(info.byte_order.name().split('-').next(), Some(row.text("byte_order")), "{name}");
        assert_eq!(info.revision, row.text("rev"), "{name}");
        assert_eq!(f64::from(info.format_code), row.number("format"), "{name}");
        assert_eq!(info.traces as f64, row.number("traces"), "{name}");
        assert_eq!(info.samples as f64, row.number("samples"), "{name}");
        assert!((info.interval - row.number("dt_us_or_mm") / 1000.0).abs() < 1e-12, "{name}");
        // The table has the field at byte 109 as it stands; one file scales it by 1/10 at byte 215.
        let scale = if name.ends_with("delay-scalar.sgy") { 0.1 } else { 1.0 };
        assert!((info.start - row.number("t0_first_trace") * scale).abs() < 1e-9, "{name}");
        assert_eq!(f64::from(info.byte_positions.inline.unwrap()), row.number("il_byte"), "{name}");
        assert_eq!(f64::from(info.byte_positions.crossline.unwrap()), row.number("xl_byte"), "{name}");
        for (lines, column) in [(info.inlines, "inlines"), (info.crosslines, "crosslines")] {
            let found = [i64::from(lines.first), i64::from(lines.last), lines.count as i64];
            assert_eq!(found, row.lines(column), "{name}");
        }
        let places = info.inlines.count * info.crosslines.count;
        assert_eq!((places - info.missing_traces) as f64, row.number("distinct_il_xl"), "{name}");
        check_samples(&file, row);
    }
}

fn check_samples(file: &SegyFile, row: &Row) {
    let name = row.text("file");
    let [inlines, crosslines, samples] = file.size();
    let mut traces = vec![vec![f32::NAN; samples]; file.info().traces];
    let mut non_finite = 0;
    for x in 0..inlines {
        for y in 0..crosslines {
            if let Some(trace) = file.trace_at(x, y) {
                non_finite += file.read_trace(x, y, &mut traces[trace]).unwrap();
                // The reference reads what is no number as 0.
                traces[trace].iter_mut().filter(|value| value.is_nan()).for_each(|value| *value = 0.0);
            }
        }
    }
    assert_eq!(non_finite as f64, row.number("nonfinite"), "{name}");
    for (trace, sample, value) in row.probes() {
        let found = f64::from(traces[trace][sample]);
        assert!((found - value).abs() <= 1e-6 * value.abs(), "{name}: {found} {value}");
    }
    let values = || traces.iter().flatten().map(|&v| f64::from(v));
    let count = values().count() as f64;
    let near = |found: f64, column: &str| {
        let expected = row.number(column);
        assert!((found - expected).abs() <= 1e-6 * expected.abs().max(1e-3), "{name}: {column} {found} {expected}");
    };
    near(values().fold(f64::INFINITY, f64::min), "min");
    near(values().fold(f64::NEG_INFINITY, f64::max), "max");
    near(values().sum::<f64>() / count, "mean");
    near((values().map(|v| v * v).sum::<f64>() / count).sqrt(), "rms");
}

#[test]
fn the_variants_of_one_window_hold_the_same_volume() {
    let Some(dir) = testdata::folder() else { return };
    let read = |name: &str| {
        read(&dir.join("segy/penobscot_variants").join(name), &SegyOptions::default(), &Progress::silent()).unwrap()
    };
    let truth = read("ieee.sgy");
    for name in ["ibm.sgy", "int32.sgy", "il9_xl21.sgy", "crossline_sorted.sgy", "ascii_header.sgy"] {
        let found = read(name);
        assert_eq!(found.geometry, truth.geometry, "{name}");
        assert!(found.volume == truth.volume, "{name}");
    }
    let missing = read("missing15pct.sgy");
    assert_eq!(missing.info.missing_traces, 180);
    assert_eq!(missing.volume.live().unwrap().iter().filter(|&&live| !live).count(), 180);
    for x in 0..40 {
        for y in (0..30).filter(|&y| missing.volume.is_live(x, y)) {
            assert_eq!(missing.volume.trace(x, y), truth.volume.trace(x, y));
        }
    }
    assert!((missing.amplitudes.mean - 54.95855).abs() < 1e-5);
}

#[test]
fn domains_units_and_places_of_real_files() {
    let Some(dir) = testdata::folder() else { return };
    let open = |name: &str| SegyFile::open(&dir.join(name), &SegyOptions::default(), &Progress::silent()).unwrap();

    let depth = open("volumes/f3_depth_il300-427_xl720-975_int16.sgy");
    assert_eq!(depth.info().vertical_unit, ZUnit::Metres);
    assert!((depth.geometry().unwrap().inline_vector.length() - 25.0).abs() < 0.05);
    assert!(depth.info().geometry.residual_max_bins.unwrap() < 0.05);

    let feet = open("segy/penobscot_variants/feet_depth.sgy");
    assert_eq!((feet.info().vertical_unit, feet.info().interval), (ZUnit::Feet, 10.0));
    let geometry = feet.geometry().unwrap();
    assert!((geometry.vertical.interval - 3.048).abs() < 1e-12);
    assert!((geometry.vertical.first - 2870.0 * 0.3048).abs() < 1e-9);
    assert!((feet.info().geometry.origin[0] - 736_734.0).abs() < 1.0);
    assert!((geometry.origin.x - 736_734.0 * 0.3048).abs() < 1.0);

    let time = open("volumes/penobscot_il1207-1456_xl1253-1402_t876-1032_int16.sgy");
    assert_eq!(time.info().vertical_unit, ZUnit::Milliseconds);
    let geometry = time.geometry().unwrap();
    assert!((geometry.inline_vector.length() - 12.5).abs() < 0.01, "{geometry:?}");
    assert!((geometry.crossline_vector.length() - 25.0).abs() < 0.01);

    let dead = open("segy/xtgeo/cube_w_deadtraces.segy");
    assert_eq!((dead.info().dead_traces, dead.info().missing_traces), (656, 0));
    assert_eq!(dead.live().unwrap().iter().filter(|&&live| live).count(), 574);

    let rotated = open("segy/segyio/acute-small.sgy").geometry().unwrap();
    assert!((rotated.inline_vector - glam::DVec2::new(0.1, -0.1)).length() < 1e-9);
    assert!((rotated.crossline_vector - glam::DVec2::new(0.1, 0.1)).length() < 1e-9);

    let lsb = open("segy/segyio/Format1lsb.sgy");
    assert!(lsb.info().warnings.iter().any(|w| w.fact.contains("462 samples")), "{:?}", lsb.info().warnings);

    assert_eq!(open("segy/segyio/multi-text.sgy").info().extended_text.len(), 160);
    let bare = open("segy/segyio/small.sgy");
    assert!(bare.info().assumptions.iter().any(|a| a.fact.contains("25 m")), "{:?}", bare.info().assumptions);
}

#[test]
fn a_single_trace_is_described_and_not_read() {
    let Some(dir) = testdata::folder() else { return };
    for name in ["delay-scalar.sgy", "multi-text.sgy"] {
        let path = dir.join("segy/segyio").join(name);
        let info = scan(&path, &SegyOptions::default(), &Progress::silent()).unwrap();
        assert_eq!(info.traces, 1);
        assert!(info.page().contains(name));
        let error = read(&path, &SegyOptions::default(), &Progress::silent()).unwrap_err();
        assert!(matches!(error.problem, SegyProblem::SingleTrace), "{error}");
    }
}

#[test]
fn the_json_has_the_keys_that_scripts_rely_on() {
    let Some(dir) = testdata::folder() else { return };
    let path = dir.join("segy/penobscot_variants/il9_xl21.sgy");
    let info = scan(&path, &SegyOptions::default(), &Progress::silent()).unwrap();
    let json = serde_json::to_value(&info).unwrap();
    assert_eq!(json["inlines"], serde_json::json!({"first": 1300, "last": 1339, "step": 1, "count": 40}));
    assert_eq!(json["crosslines"]["count"], 30);
    assert_eq!(json["samples"], 40);
    assert_eq!(json["interval"], 4.0);
    assert_eq!(json["vertical_unit"], "ms");
    assert_eq!(json["sample_format"], "ieee32");
    assert_eq!((&json["traces"], &json["missing_traces"]), (&1200.into(), &0.into()));
    assert_eq!(json["bytes"], 483_600);
    assert_eq!(json["byte_positions"]["inline"], 9);
    for key in ["origin", "inline_vector", "crossline_vector"] {
        assert_eq!(json["geometry"][key].as_array().unwrap().len(), 2);
    }
}
