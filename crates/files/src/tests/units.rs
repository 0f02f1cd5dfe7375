//! Units as other programs write them, in every kind of file; what contradicts; and what is assumed.

use super::cases::{plane_of_cases, survey_of_cases, worst};
use super::*;
use crate::well::{WellOptions, WellReport, parse_checkshot, parse_deviation, parse_tops};
use glam::DVec2;

/// The plane at every trace; `row(x, y, z)` writes a row, z in metres.
fn rows(row: impl Fn(f64, f64, f64) -> String) -> String {
    let places =
        (0..961).map(|n| DVec2::new(456_000.0 + 100.0 * f64::from(n / 31), 5_999_000.0 + 100.0 * f64::from(n % 31)));
    places.map(|xy| row(xy.x, xy.y, plane_of_cases(xy)) + "\n").collect()
}

#[test]
fn the_unit_of_a_table_is_read_wherever_it_is_stated() {
    const FT: f64 = 0.3048;
    const USFT: f64 = 1200.0 / 3937.0;
    let plain = |head: &str, metres: f64| head.to_owned() + &rows(|x, y, z| format!("{x},{y},{}", z / metres));
    let german = |head: &str, metres: f64| {
        let number = |v: f64| format!("{v:.4}").replace('.', ",");
        head.to_owned() + &rows(|x, y, z| format!("{};{};{}", number(x), number(y), number(z / metres)))
    };
    let grouped = |head: &str| {
        let number = |v: f64| {
            let (whole, rest) = (v.trunc() as i64, ((v.fract() * 10.0).round() as i64).min(9));
            let thousands =
                if whole >= 1000 { format!("{}.{:03}", whole / 1000, whole % 1000) } else { whole.to_string() };
            let thousands = if whole >= 1_000_000 {
                format!("{}.{:03}.{:03}", whole / 1_000_000, whole / 1000 % 1000, whole % 1000)
            } else {
                thousands
            };
            format!("{thousands},{rest}")
        };
        head.to_owned() + &rows(|x, y, z| format!("{};{};{}", number(x), number(y), number(z)))
    };
    let places = |head: &str, metres: f64, z_metres: f64| {
        head.to_owned() + &rows(|x, y, z| format!("{},{},{}", x / metres, y / metres, z / z_metres))
    };
    for (text, unit) in [
        (plain("X,Y,Depth (ft)\n", FT), ZUnit::Feet),
        (plain("X,Y,z_us_survey_feet\n", USFT), ZUnit::SurveyFeet),
        (plain("X,Y,Z [ftUS]\n", USFT), ZUnit::SurveyFeet),
        (plain("# Depths in US survey feet\nX,Y,Z\n", USFT), ZUnit::SurveyFeet),
        (plain("# Z units: feet, datum MSL\n# x y z\n", FT), ZUnit::Feet),
        (plain("! TVDSS (FEET)\nX,Y,Z\n", FT), ZUnit::Feet),
        (plain("X,Y,TVDSS (ft MSL)\n", FT), ZUnit::Feet),
        (plain("X,Y,depth km\n", 1000.0), ZUnit::Kilometres),
        (plain("# Profondeur en pieds\nX,Y,profondeur\n", FT), ZUnit::Feet),
        (german("Rechtswert;Hochwert;Tiefe [m]\n", 1.0), ZUnit::Metres),
        (german("X;Y;Tiefe in Fuß\n", FT), ZUnit::Feet),
        (grouped("X;Y;Profundidad (m)\n"), ZUnit::Metres),
        (places("X [usft],Y [usft],Z [usft]\n", USFT, USFT), ZUnit::SurveyFeet),
        (places("# X and Y in feet, depth in metres\nX,Y,Z\n", FT, 1.0), ZUnit::Metres),
    ] {
        let head = text.lines().next().unwrap_or_default();
        let (horizon, report) = horizon(&text, &survey_of_cases(), &ImportOptions::default());
        assert_eq!(report.z_unit.value, unit, "{head}: {report}");
        assert!(matches!(report.z_unit.source, Provenance::File(_)), "{head}: {report}");
        let (worst, count) = worst(&horizon, plane_of_cases);
        assert!(worst < 0.11 && count == 961, "{head}: {worst} m off at {count} nodes\n{report}");
    }
}

#[test]
fn what_is_not_stated_is_assumed_with_its_option_and_what_contradicts_is_shown() {
    let table = |head: &str| head.to_owned() + &rows(|x, y, z| format!("{x},{y},{z}"));
    let (_, report) = horizon(&table("X,Y,Z\n"), &survey_of_cases(), &ImportOptions::default());
    assert!(report.assumptions[0].to_string().contains("vertical unit ft"), "{report}");
    assert!(report.to_string().contains("assumed     the vertical unit is m"), "{report}");
    let (_, report) = horizon(&table("# Depth in feet\nX,Y,Depth_m\n"), &survey_of_cases(), &ImportOptions::default());
    let warning = report.warnings[0].to_string();
    assert!(warning.contains("column 'Depth_m'") && warning.contains("'Depth in feet'"), "{warning}");
    assert_eq!(report.z_unit.value, ZUnit::Metres);
    // "US" is part of a name here, and a rate is no unit of depths.
    let (_, report) = horizon(
        &table("# US SURVEY OF 1998, VELOCITY IN FT/S\nX,Y,Z\n"),
        &survey_of_cases(),
        &ImportOptions::default(),
    );
    assert_eq!(report.z_unit.source, Provenance::Assumed, "{report}");
    let stated =
        ImportOptions { z_unit: Some(ZUnit::SurveyFeet), xy_unit: Some(ZUnit::Metres), ..ImportOptions::default() };
    let (horizon, report) = horizon(&table("# X, Y in feet\nX,Y,Z\n"), &survey_of_cases(), &stated);
    assert!(
        report.assumptions.len() == 1 && worst(&horizon, |xy| plane_of_cases(xy) * 1200.0 / 3937.0).0 < 0.01,
        "{report}"
    );
}

#[test]
fn wells_tops_and_checkshots_take_the_units_of_their_headers() {
    let file = Path::new("w");
    let options = WellOptions { head: Some([0.0, 0.0]), datum_m: Some(0.0), ..WellOptions::default() };
    for (text, end_m) in [
        ("# Unit in depth: ft\nMD INCL AZIM\n0 0 0\n1000 0 0\n", 304.8),
        ("# DEPTHS IN ft-UNITS\nMD,INCL,AZIM\n0,0,0\n1000,0,0\n", 304.8),
        ("MD (usft) INCL AZIM\n0 0 0\n3937 0 0\n", 1200.0),
        ("# All depths in US survey feet\nMD INCL AZIM\n0 0 0\n3937 0 0\n", 1200.0),
        ("MD [ft];INCL;AZIM\n0,0;0,0;0,0\n1.000,5;0,0;0,0\n", 1000.5 * 0.3048),
        ("Tiefe [m];INCL;AZIM\n0;0;0\n1 000,5;0;0\n", 1000.5),
        ("MD,INCL,AZIM\n0,0,0\n1000,0,0\n", 1000.0),
    ] {
        let read = parse_deviation(file, text, &options).unwrap_or_else(|e| panic!("{text}: {e}"));
        assert!((read.path.md_range_m()[1] - end_m).abs() < 1e-6, "{text}: {:?}", read.path.md_range_m());
    }
    let path = parse_deviation(file, "MD,INCL,AZIM\n0,0,0\n3000,0,0\n", &options).unwrap().path;
    for (text, md_m) in [
        ("# Unit in depth: ft\nMD Surface\n1000 Chalk\n", 304.8),
        ("# MD in US survey feet\nsurface,md\nChalk,3937\n", 1200.0),
        ("Surface;Tiefe (m)\nChalk;1.234,5\n", 1234.5),
        ("hole,from,to,lithology\nA,100,200,Chalk\nA,200,250,Chalk\n", 100.0),
        ("surface,md_ft\nChalk,1000\nMarl,********\n", 304.8),
    ] {
        let mut report = WellReport::default();
        let tops = parse_tops(file, text, &path, &options, &mut report).unwrap_or_else(|e| panic!("{text}: {e}"));
        assert_eq!(tops.len(), 1, "{text}");
        assert!((tops[0].md_m.unwrap() - md_m).abs() < 1e-6, "{text}: {tops:?}");
    }
    for text in [
        "# times in microseconds\ntvdss_m,twt\n0,0\n1000,1000000\n",
        "# TWT unit: s\ntvdss_m,twt\n0,0\n500,1.#QNAN\n1000,1.0\n",
        "tvdss_m;twt [ms]\n0,0;0,0\n1.000,0;1.000,0\n",
    ] {
        let mut report = WellReport::default();
        let found = parse_checkshot(file, text, &path, &options, &mut report).unwrap_or_else(|e| panic!("{text}: {e}"));
        assert!((found.twt_at_tvdss(500.0) - 500.0).abs() < 1e-6, "{text}");
    }
    let mut report = WellReport::default();
    let twice = "# Depth in feet\nsurface,md_m\nChalk,100\n";
    parse_tops(file, twice, &path, &options, &mut report).unwrap();
    assert!(report.warnings[0].fact.contains("given twice"), "{report:?}");
}

#[test]
fn places_win_and_the_datum_is_what_the_columns_say() {
    let file = Path::new("w");
    let plain = WellOptions::default();
    let read = |text: &str, options: &WellOptions| {
        parse_deviation(file, text, options).unwrap_or_else(|e| panic!("{text}: {e}"))
    };
    // TVD and Z, elevation; TVDSS with KB in a comment that contradicts; only MD 0.
    let found = read("MD X Y Z TVD\n0 10 20 30 0\n100 10 20 -70 100\n", &plain);
    assert_eq!((found.path.datum_m(), found.path.head()), (30.0, DVec2::new(10.0, 20.0)));
    let found = read("# KB: 25 m\nMD X Y TVDSS TVD\n0 10 20 -30 0\n100 10 20 70 100\n", &plain);
    assert_eq!(found.path.datum_m(), 30.0);
    assert!(found.report.warnings[0].fact.contains("25 m"), "{:?}", found.report);
    let found = read("MD X Y TVDSS\n0 10 20 -30\n100 10 20 70\n", &plain);
    assert_eq!(found.path.datum_m(), 30.0);
    // Angles that do not lead to the places are told, and not followed.
    let astray =
        "MD X Y TVDSS INCL AZIM\n0 10 20 0 0 0\n100 10 20 100 45 90\n200 10 20 200 45 90\n300 10 20 300 45 90\n";
    let found = read(astray, &plain);
    assert!(
        found.path.position_at_md(300.0).unwrap().x == 10.0 && found.report.warnings.len() == 1,
        "{:?}",
        found.report
    );
    // A stated head: by the angles from there.
    let told = WellOptions { head: Some([0.0, 0.0]), ..plain.clone() };
    assert!(read(astray, &told).path.position_at_md(300.0).unwrap().x > 100.0);
    // One station without a number.
    let found =
        read("MD,INCL,AZIM\n0,0,0\n50,********,0\n100,0,0\n", &WellOptions { head: Some([0.0; 2]), ..plain.clone() });
    assert!(found.report.warnings.iter().any(|w| w.fact.contains("1 of 3 stations")), "{:?}", found.report);
    // Rows that nothing names are asked about, with their columns.
    let error = parse_deviation(file, "0 0 0\n100 5 90\n", &plain).unwrap_err();
    assert_eq!(error.remedy().unwrap().to_string(), "columns md,inc,azi");
}
