//! Units in the words of many programs, and what only looks like one.

use super::*;

#[test]
fn a_unit_is_a_whole_word_in_any_spelling() {
    for (text, unit) in [
        ("ft", ZUnit::Feet),
        ("Feet", ZUnit::Feet),
        ("FT.", ZUnit::Feet),
        ("[ft]", ZUnit::Feet),
        ("F", ZUnit::Feet),
        ("ft-UNITS", ZUnit::Feet),
        ("international feet", ZUnit::Feet),
        ("Fuß", ZUnit::Feet),
        ("pieds", ZUnit::Feet),
        ("US survey feet", ZUnit::SurveyFeet),
        ("U.S. Survey Foot", ZUnit::SurveyFeet),
        ("US_survey_foot", ZUnit::SurveyFeet),
        ("survey feet", ZUnit::SurveyFeet),
        ("usft", ZUnit::SurveyFeet),
        ("ftUS", ZUnit::SurveyFeet),
        ("us-ft", ZUnit::SurveyFeet),
        ("feet (US survey)", ZUnit::SurveyFeet),
        ("METERS", ZUnit::Metres),
        ("mètres", ZUnit::Metres),
        ("Metern", ZUnit::Metres),
        ("km", ZUnit::Kilometres),
        ("µs", ZUnit::Microseconds),
        ("μs", ZUnit::Microseconds),
        ("US", ZUnit::Microseconds),
        ("msec", ZUnit::Milliseconds),
        ("Millisekunden", ZUnit::Milliseconds),
        ("milisegundos", ZUnit::Milliseconds),
        ("s", ZUnit::Seconds),
        ("inches", ZUnit::Inches),
        ("IN", ZUnit::Inches),
    ] {
        assert_eq!(unit_of(text), Some(unit), "{text}");
    }
    for text in ["", "furlong", "m/s", "us/ft", "feetish", "USA", "survey", "GAPI", "m3", "g/cm3", "5"] {
        assert_eq!(unit_of(text), None, "{text}");
    }
    assert_eq!(multiple_of(".1IN"), Some((0.1, ZUnit::Inches)));
    assert_eq!(multiple_of("0.1in"), Some((0.1, ZUnit::Inches)));
    assert_eq!(multiple_of("CM"), Some((1.0, ZUnit::Centimetres)));
}

#[test]
fn what_a_unit_belongs_to_is_seen_from_what_introduces_it() {
    use Quantity::{Depth, Horizontal, Time, Vertical};
    for (line, quantity, unit) in [
        ("DEPTH IN US SURVEY FEET", Depth, ZUnit::SurveyFeet),
        ("DEPTH UNITS: US SURVEY FEET, DATUM MSL", Depth, ZUnit::SurveyFeet),
        ("DEPTH VOLUME IN FEET", Depth, ZUnit::Feet),
        ("TVDSS (FEET)", Depth, ZUnit::Feet),
        ("Trace unit: ft", Vertical, ZUnit::Feet),
        ("VERTICAL AXIS: DEPTH, US-FT", Depth, ZUnit::SurveyFeet),
        ("Unit in depth: ft", Depth, ZUnit::Feet),
        ("Unit in X and Y direction: m", Horizontal, ZUnit::Metres),
        ("DEPTH (Z, tvd_z) GIVEN IN ft-UNITS", Vertical, ZUnit::Feet),
        ("Z UNITS: FEET", Vertical, ZUnit::Feet),
        ("VERTICAL UNIT = METER", Vertical, ZUnit::Metres),
        ("XY UNITS: M", Horizontal, ZUnit::Metres),
        ("TWT (ms)", Time, ZUnit::Milliseconds),
        ("Tiefe in Metern", Depth, ZUnit::Metres),
        ("PROFONDEUR EN PIEDS", Depth, ZUnit::Feet),
        ("PROFUNDIDAD (m)", Depth, ZUnit::Metres),
        ("TIMES IN MICROSECONDS", Time, ZUnit::Microseconds),
        ("X,Y in US survey feet", Horizontal, ZUnit::SurveyFeet),
    ] {
        let found = statements(line);
        assert_eq!(found.len(), 1, "{line}: {found:?}");
        assert_eq!((found[0].quantity, found[0].unit, found[0].number), (Some(quantity), unit, None), "{line}");
    }
    for line in [
        "ACQUIRED OFFSHORE US SURVEY 1998",
        "PROCESSED IN THE US",
        "VELOCITY IN M/S",
        "VELOCITIES IN FEET PER SECOND",
        "DT (US/FT)",
        "SURVEY M 12 AREA S",
        "FINAL MIGRATION",
    ] {
        assert!(statements(line).is_empty(), "{line}: {:?}", statements(line));
    }
    for (line, number, unit) in [
        ("SAMPLE INTERVAL: 4MS", 4.0, ZUnit::Milliseconds),
        ("SAMPLE RATE 0,004 S", 0.004, ZUnit::Seconds),
        ("DATUM 82.02 (ft)", 82.02, ZUnit::Feet),
        ("KB 1.234,5 m", 1234.5, ZUnit::Metres),
    ] {
        let found = statements(line);
        assert_eq!((found[0].number, found[0].unit), (Some(number), unit), "{line}");
    }
}

#[test]
fn names_of_columns_are_taken_apart() {
    for (name, word, unit) in [
        ("Depth_ft", "depth", Some(ZUnit::Feet)),
        ("Z [usft]", "z", Some(ZUnit::SurveyFeet)),
        ("twt_ms", "twt", Some(ZUnit::Milliseconds)),
        ("MD ft", "md", Some(ZUnit::Feet)),
        ("depth in feet", "depth", Some(ZUnit::Feet)),
        ("TVDSS (ft MSL)", "tvdss", Some(ZUnit::Feet)),
        ("z_us_survey_feet", "z", Some(ZUnit::SurveyFeet)),
        ("z_us_ft", "z", Some(ZUnit::SurveyFeet)),
        ("INT,Inline", "inline", None),
        ("Y (NORTHING)", "y", None),
        ("stick#", "stick", None),
        ("Vint (m/s)", "vint", None),
        ("twt_us", "twt", Some(ZUnit::Microseconds)),
        ("Tiefe [m]", "tiefe", Some(ZUnit::Metres)),
        ("inline3d", "inline3d", None),
        ("ms", "ms", None),
    ] {
        assert_eq!(of_column(name), ColumnName { word: word.into(), unit }, "{name}");
    }
}

#[test]
fn two_lines_that_contradict_one_another_are_both_found() {
    let units = HeaderUnits::of(["# DEPTH IN FEET", "# TVDSS (M)", "# X, Y IN METRES"]);
    let (first, other) = units.find(&[Quantity::Depth]).unwrap();
    assert_eq!((first.unit, other.unwrap().quote.as_str()), (ZUnit::Feet, "TVDSS (M)"));
    assert_eq!(units.find(&[Quantity::Horizontal]).unwrap().0.unit, ZUnit::Metres);
    assert!(HeaderUnits::of(["# 12 ft"]).find(&[Quantity::Depth]).is_none());
}
