//! The small volumes that once failed, and others of their kinds.

use super::super::{LengthUnit, SegyFile, SegyOptions};
use super::builder::Built;
use crate::unit::ZUnit;
use std::path::PathBuf;
use survey::progress::Progress;

/// A file of a case; without `PETROGLYPH_DATA`, `None` and a message.
fn case(path: &str) -> Option<PathBuf> {
    let file = testdata::folder()?.join("cases").join(path);
    if !file.is_file() {
        eprintln!("skipped: {} is not there", file.display());
        return None;
    }
    Some(file)
}

fn opened(path: &str, options: &SegyOptions) -> Option<SegyFile> {
    let path = case(path)?;
    Some(SegyFile::open(&path, options, &Progress::silent()).unwrap_or_else(|e| panic!("{e}")))
}

#[test]
fn a_depth_in_us_survey_feet_is_no_time_in_microseconds() {
    for name in ["41-feet-depth/p1.sgy", "41-feet-depth/a1.sgy"] {
        let Some(file) = opened(name, &SegyOptions::default()) else { return };
        assert_eq!((file.info().vertical_unit, file.info().interval), (ZUnit::SurveyFeet, 10.0));
        let step = file.geometry().unwrap().vertical.interval;
        assert!((step - 12_000.0 / 3937.0).abs() < 1e-12, "{step}");
    }
}

#[test]
fn sentences_about_depth_in_many_words_give_the_unit() {
    let said = |line: &str| {
        let mut built = Built::grid(&[1, 2, 3], &[1, 2, 3]);
        built.binary(3217, 10_000);
        let mut built = built.each(|_, trace| trace.i16(117, 10_000));
        built.say(1, line);
        built.info()
    };
    for (line, unit) in [
        ("DEPTH VOLUME IN FEET", ZUnit::Feet),
        ("TVDSS (FEET)", ZUnit::Feet),
        ("Trace unit: ft", ZUnit::Feet),
        ("Z AXIS: DEPTH, UNITS: USFT", ZUnit::SurveyFeet),
        ("DEPTH DOMAIN, UNIT ftUS", ZUnit::SurveyFeet),
        ("PROFUNDIDAD EN METROS", ZUnit::Metres),
        ("PROFONDEUR (M)", ZUnit::Metres),
        ("US SURVEY, ACQUIRED IN THE US; TWT (MS)", ZUnit::Milliseconds),
        ("TIME IN US", ZUnit::Milliseconds),
    ] {
        assert_eq!(said(line).vertical_unit, unit, "{line}");
    }
    let mut built = Built::grid(&[1, 2, 3], &[1, 2, 3]);
    built.say(1, "DEPTH IN FEET");
    built.say(2, "DEPTHS (METRES)");
    let info = built.info();
    let warning = info.warnings.iter().map(ToString::to_string).find(|w| w.contains("twice")).unwrap();
    assert!(warning.contains("DEPTH IN FEET") && warning.contains("DEPTHS (METRES)"), "{warning}");
}

#[test]
fn the_feet_of_x_and_y_are_those_of_the_text_header() {
    let said = |byte: u16, line: &str| {
        let mut built = Built::grid(&[1, 2, 3], &[1, 2, 3]);
        built.binary(3255, byte);
        built.say(2, line);
        built.info()
    };
    assert_eq!(said(2, "XY UNITS: US SURVEY FEET").coordinate_unit, LengthUnit::SurveyFeet);
    assert_eq!(said(2, "").coordinate_unit, LengthUnit::Feet);
    assert_eq!(said(0, "COORDINATES IN FEET").coordinate_unit, LengthUnit::Feet);
    let info = said(1, "COORDINATES IN FEET");
    assert_eq!(info.coordinate_unit, LengthUnit::Metres);
    assert!(info.warnings.iter().any(|w| w.fact.contains("COORDINATES IN FEET")), "{:?}", info.warnings);
}
