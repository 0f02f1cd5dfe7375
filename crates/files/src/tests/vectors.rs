//! The smallest files of the grid formats, with their values where the formats put them.

use super::*;
use glam::DVec2;
use survey::geometry::VerticalUnit;

fn survey() -> SurveyGeometry {
    SurveyGeometry::regular([9, 9, 101], 5.0, 1.0, VerticalUnit::Metres)
}

fn assert_values(text: &str, values: &[(f64, f64, f32)]) -> ImportReport {
    let (horizon, report) = horizon(text, &survey(), &ImportOptions::default());
    let sheet = &horizon.sheets[0];
    for &(x, y, z) in values {
        let found = sheet.depth_at_node(sheet.grid.node_at(DVec2::new(x, y)));
        assert!(found == z || (found.is_nan() && z.is_nan()), "{z} at {x}, {y}, found {found}: {text}");
    }
    report
}

#[test]
fn zmap_runs_down_the_columns() {
    let values = [(0.0, 10.0, 1.0), (0.0, 0.0, 2.0), (10.0, 10.0, 3.0), (10.0, 0.0, f32::NAN), (20.0, 0.0, 6.0)];
    let header = "! a comment\n@ A, GRID, 5\n15, -99999.0, , 4, 1,\n2, 3, 0.0, 20.0, 0.0, 10.0,\n0.0, 0.0, 0.0\n@\n";
    for data in ["1 2\n3 -99999\n5 6\n", "+ data starts\n1.0\n2.0\n3\n-99999.0 5\n6"] {
        let report = assert_values(&format!("{header}{data}"), &values);
        assert_eq!(report.nulls, 1);
    }
    // Fields that touch are cut by their width.
    let touching = "@ A, GRID, 5\n6, -99999, , 2, 1\n2, 3, 0.0, 20.0, 0.0, 10.0\n0, 0, 0\n@\n1.00002.0000\n3.0000-99999\n5.00006.0000\n";
    assert_values(touching, &values);
}

#[test]
fn cps3_runs_down_the_columns_unless_the_rows_are_far_smoother() {
    let header =
        "FSASCI 0 1 \"COMPUTED\" 0 1E+030 0\nFSATTR 0 0\nFSLIMI 0 20 0 10 0 99\nFSNROW 2 3\nFSXINC 10 10\n->A\n";
    assert_values(
        &format!("{header}1 2\n3 4\n5 1E+030"),
        &[(0.0, 10.0, 1.0), (0.0, 0.0, 2.0), (20.0, 10.0, 5.0), (20.0, 0.0, f32::NAN)],
    );
    let header = "FSASCI 0 1 COMPUTED 0 1E30\nFSLIMI 0 40 0 20 0 99\nFSNROW 3 5\n->A\n";
    let rows: String =
        (0..3).map(|v| (0..5).map(|u| format!("{} ", 10 + u + 20 * v)).collect::<String>() + "\n").collect();
    let report = assert_values(&format!("{header}{rows}"), &[(0.0, 0.0, 10.0), (40.0, 0.0, 14.0), (0.0, 20.0, 50.0)]);
    assert!(report.notes.iter().any(|n| n.contains("columns") || n.contains("rows")), "{report}");
}

#[test]
fn irap_rotation_turns_about_the_origin() {
    // 90° anticlockwise: i runs north, j west.
    let text = "-996 2 10 10\n30 40 5 15\n2 90 30 5\n0 0 0 0 0 0 0\n1 2 3 4";
    assert_values(text, &[(30.0, 5.0, 1.0), (30.0, 15.0, 2.0), (20.0, 5.0, 3.0), (20.0, 15.0, 4.0)]);
    // A negative YINC mirrors: j runs east.
    let text = text.replace("2 10 10\n", "2 10 -10\n").replace("2 90 30", "2 90 20");
    assert_values(&text, &[(20.0, 5.0, 1.0), (20.0, 15.0, 2.0), (30.0, 5.0, 3.0), (30.0, 15.0, 4.0)]);
}

#[test]
fn opendtect_multi_line_header() {
    let text =
        "# 1: X\n# 2: Y\n# 3: Z\n# - - - - - - - - - -\n5.00\t10.00\t8.421\n10.00\t10.00\t9\n5.00\t15.00\t1e30\n";
    let report = assert_values(text, &[(5.0, 10.0, 8.421), (10.0, 10.0, 9.0)]);
    assert_eq!((report.values, report.nulls, report.format.value), (3, 1, Format::OpendTect));
}

#[test]
fn earthvision_and_petrel_say_their_unit() {
    let survey = SurveyGeometry::regular([9, 9, 101], 5.0, 1.0, VerticalUnit::Milliseconds);
    for (text, words) in [
        (
            "# Type: scattered data\n# Field: 1 x\n# Field: 2 y\n# Field: 3 z seconds\n# Null_value: -999\
             \n# End:\n0 0 0.05\n5 0 0.06\n5 5 -999\n",
            "Field: 3 z seconds",
        ),
        (
            "# Petrel Points with attributes\r\n# Unit in X and Y direction: m\r\n# Unit in depth: s\r\
             \nVERSION 1\r\nBEGIN HEADER\r\nX\r\nY\r\nZ\r\nEND HEADER\r\n0 0 0.05 \r\n5 0 0.06\r\n",
            "'Unit in depth: s'",
        ),
    ] {
        let (horizon, report) = horizon(text, &survey, &ImportOptions::default());
        assert_eq!(report.z_unit, Settled { value: ZUnit::Seconds, source: Provenance::File(words.into()) });
        assert!((horizon.sheets[0].depth[0] - 50.0).abs() < 1e-4, "{report}");
    }
}

#[test]
fn tsurf_horizon_of_an_overthrust_keeps_both_depths() {
    // Two sheets that overlap for 10 m ≤ x ≤ 25 m, written as one TSurf by this program.
    let sheet = |from: usize, to: usize, z: f32| {
        let mut depth = vec![f32::NAN; 81];
        for x in from..=to {
            (0..9).for_each(|y| depth[x * 9 + y] = z + x as f32);
        }
        Sheet::new(survey::NodeGrid::of_survey(&survey()), depth, survey::Quality::Picked)
    };
    let written = Horizon::new("Over", vec![sheet(0, 5, 20.0), sheet(2, 8, 60.0)]);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("over.ts");
    write_horizon(&path, &written, &survey(), Format::Tsurf).unwrap();
    let (read, report) = read_horizons(&path, &survey(), &ImportOptions::default()).unwrap().remove(0);
    assert_eq!((read.name.as_str(), read.sheets.len(), report.multivalued), ("Over", 2, 36));
    for sheet in &read.sheets {
        let upper = sheet.depth[3 * 9 + 4] < 40.0;
        let original = &written.sheets[usize::from(!upper)];
        assert!(
            sheet.depth.iter().zip(&original.depth).all(|(a, b)| (a - b).abs() < 1e-4 || (a.is_nan() && b.is_nan()))
        );
    }
}
