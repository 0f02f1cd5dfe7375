//! Bad horizon files: each is refused with its reason, line and remedy, and nothing is left behind.

use super::*;
use survey::geometry::VerticalUnit;

fn survey() -> SurveyGeometry {
    SurveyGeometry::regular([20, 20, 101], 25.0, 4.0, VerticalUnit::Milliseconds)
}

fn refused(text: &str) -> FormatError {
    refused_with(text, &ImportOptions::default())
}

fn refused_with(text: &str, options: &ImportOptions) -> FormatError {
    let (_folder, path) = file("A.dat", text);
    match read_horizons(&path, &survey(), options) {
        Err(error) => error,
        Ok(read) => panic!("{}", read[0].1),
    }
}

fn rows(header: &str, row: impl Fn(f64, f64) -> String) -> String {
    let mut text = header.to_string();
    for x in 0..10 {
        for y in 0..10 {
            text += &(row(25.0 * f64::from(x), 25.0 * f64::from(y)) + "\n");
        }
    }
    text
}

#[test]
fn a_bad_number_is_named_with_its_line() {
    let text = "x,y,z\n0,0,100\n25,0,1o0\n";
    let error = refused(text).to_string();
    assert!(error.contains("line 3: expected a number for Z, found '1o0'"), "{error}");
    let error = refused("x,y,z\n0,0,100\n25,0\n").to_string();
    assert!(error.contains("line 3: expected at least 3 fields"), "{error}");
    assert!(matches!(refused("x,y,z\n0,far,100\n0,0,1\n"), FormatError::Syntax { line: 2, .. }));
}

#[test]
fn a_horizon_beside_the_survey_shows_both_extents_and_a_hint() {
    for (text, hint) in [
        (rows("x,y,z\n", |x, y| format!("{},{},100", x + 6e5, y + 6e6)), "coordinate system"),
        (rows("x,y,z\n", |x, y| format!("{},{},100", (x + 100.0) / 0.3048 + 1500.0, y)), "X and Y are"),
        (
            rows("inline,crossline,z\n", |x, y| format!("{},{},100", x / 25.0 + 1200.0, y / 25.0 + 1.0)),
            "line numbering",
        ),
    ] {
        let error = refused(&text);
        assert!(matches!(error, FormatError::OutsideSurvey { .. }), "{error}");
        assert!(error.to_string().contains(hint), "{error}");
    }
    let far = SurveyGeometry { origin: glam::DVec2::new(6e5, 6e6), ..survey() };
    let (_folder, path) = file("A.dat", &rows("x,y,z\n", |x, y| format!("{},{},100", y + 6e6, x + 6e5)));
    let error = read_horizons(&path, &far, &ImportOptions::default()).unwrap_err().to_string();
    assert!(error.contains("exchanged"), "{error}");
    let (_folder, path) =
        file("A.dat", &rows("x,y,z\n", |x, y| format!("{},{},100", (x + 6e5) / 1000.0, (y + 6e6) / 1000.0)));
    let error = read_horizons(&path, &far, &ImportOptions::default()).unwrap_err().to_string();
    assert!(error.contains("kilometres"), "{error}");
}

#[test]
fn ambiguous_columns_are_asked_for() {
    // Small whole numbers may be X, Y or line numbers in this survey.
    let text = "1 1 100\n1 2 101\n2 1 102\n2 2 103\n";
    let error = refused(text);
    assert!(matches!(error, FormatError::Columns { .. }), "{error}");
    let told = ImportOptions { columns: Column::parse_list("inline,crossline,z").ok(), ..ImportOptions::default() };
    assert_eq!(horizon(text, &survey(), &told).1.gridding, Gridding::SurveyTraces { step: [1, 1] });
    assert!(matches!(refused("a,b,c\n1,2,3\n"), FormatError::Columns { .. }));
}

#[test]
fn lines_and_coordinates_that_disagree_are_asked_for() {
    let text = rows("inline,crossline,x,y,z\n", |x, y| {
        format!("{},{},{},{},100", x / 25.0 + 1.0, y / 25.0 + 1.0, x + 125.0, y)
    });
    match refused(&text) {
        FormatError::LinesDisagree { metres, .. } => assert!((metres - 125.0).abs() < 1e-6),
        error => panic!("{error}"),
    }
    for (place_by, first) in [(PlaceBy::Lines, 0), (PlaceBy::World, 5)] {
        let told = ImportOptions { place_by: Some(place_by), ..ImportOptions::default() };
        let (horizon, _) = horizon(&text, &survey(), &told);
        let sheet = &horizon.sheets[0];
        assert_eq!(sheet.depth.iter().position(|z| z.is_finite()), Some(first * 20));
    }
    let far = rows("inline,crossline,x,y,z\n", |x, y| {
        format!("{},{},{},{},100", x / 25.0 + 1.0, y / 25.0 + 1.0, x + 6e5, y + 6e6)
    });
    let (_, report) = horizon(&far, &survey(), &ImportOptions::default());
    assert!(report.notes.iter().any(|n| n.contains("coordinate system")), "{report}");
}

#[test]
fn truncated_grids_and_wrong_counts_are_refused() {
    let error = refused("-996 2 10 10\n0 10 0 10\n2 0 0 0\n0 0 0 0 0 0 0\n100 200 300\n");
    assert!(matches!(error, FormatError::Length { expected: 4, found: 3, .. }), "{error}");
    assert!(matches!(refused("-996 2 10 10\n0 10\n"), FormatError::Length { .. }));
    let huge = "-996 2000000000 10 10\n0 10 0 10\n2000000000 0 0 0\n0 0 0 0 0 0 0\n100\n";
    assert!(matches!(refused(huge), FormatError::BadGrid { .. }));
    let flat = "-996 2 0 10\n0 10 0 10\n2 0 0 0\n0 0 0 0 0 0 0\n1 2 3 4\n";
    assert!(matches!(refused(flat), FormatError::BadGrid { .. }));
}

#[test]
fn empty_all_null_and_unknown_files() {
    for text in ["", "\n\n", "hello\nworld\n", "x,y,z\n"] {
        assert!(matches!(refused(text), FormatError::UnknownFormat { .. }), "{text}");
    }
    let all_null = rows("x,y,z\n", |x, y| format!("{x},{y},1e30"));
    assert!(matches!(refused(&all_null), FormatError::Empty { .. }));
    let csv = ImportOptions { format: Some(Format::Csv), ..ImportOptions::default() };
    assert!(matches!(refused_with("x,y,z\n", &csv), FormatError::Empty { .. }));
    let missing = read_horizons(Path::new("no/such/file"), &survey(), &csv);
    assert!(matches!(missing, Err(FormatError::Io { action: "read", .. })));
}

#[test]
fn a_path_that_cannot_be_written_leaves_nothing_behind() {
    let (horizon, _) = horizon(&rows("x,y,z\n", |x, y| format!("{x},{y},100")), &survey(), &ImportOptions::default());
    let folder = tempfile::tempdir().unwrap();
    // A folder in the target's place cannot be replaced by a file, whoever runs the test.
    let path = folder.path().join("taken");
    std::fs::create_dir(&path).unwrap();
    let error = write_horizon(&path, &horizon, &survey(), Format::Csv).unwrap_err();
    assert!(matches!(error, FormatError::Io { action: "write", .. }), "{error}");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    assert!(write_horizon(&folder.path().join("no/such/A.csv"), &horizon, &survey(), Format::Csv).is_err());
}

#[test]
fn rows_that_are_no_rows_of_iesx_are_named() {
    let text = "PROFILE Top TYPE 1  4 3d_ci7m.ifdf     m ms\nSNAPPING PARAMETERS 5 0 1\n448863.0 6781234.0 1000 2000 612.5\nEOD\n";
    let error = refused(text).to_string();
    assert!(error.contains("line 3: expected X, Y, two counts, Z"), "{error}");
}

#[test]
fn a_hint_that_names_columns_uses_those_of_the_file() {
    for (header, columns, example) in [
        ("inline,crossline,top_twt_ms", "inline, crossline, top_twt_ms", "inline,crossline,z"),
        ("inline,crossline,top_twt_ms,amplitude", "top_twt_ms, amplitude", "inline,crossline,z,-"),
        ("Easting;Northing;Base Depth 2;remark", "Base Depth 2", "x,y,z,-"),
        ("x\ty\tpick", "x, y, pick", "x,y,z"),
    ] {
        let cut = header.chars().find(|c| ",;\t".contains(*c)).unwrap().to_string();
        let row = |n: i32| (0..header.split(&cut as &str).count()).map(move |at| (n * 7 + at as i32).to_string());
        let rows: String = (1..9).map(|n| row(n).collect::<Vec<_>>().join(&cut) + "\n").collect();
        match refused(&format!("{header}\n{rows}")) {
            FormatError::Columns { why, example: found, .. } => {
                assert!(why.contains(columns), "{header}: {why}");
                assert_eq!(found, example, "{header}");
            }
            error => panic!("{header}: {error}"),
        }
    }
}
