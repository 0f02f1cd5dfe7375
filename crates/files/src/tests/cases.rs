//! The small inputs that once failed: each is right, or refused with the sentence that helps.

use super::*;
use crate::well::{WellFiles, WellOptions, WellReport, read_well};
use glam::{DVec2, DVec3};
use survey::geometry::{LineAxis, VerticalAxis, VerticalUnit};
use survey::well::Well;

/// A file of a case; without `PETROGLYPH_DATA`, `None` and a message.
pub(super) fn case(path: &str) -> Option<PathBuf> {
    let file = testdata::folder()?.join("cases").join(path);
    if !file.is_file() {
        eprintln!("skipped: {} is not there", file.display());
        return None;
    }
    Some(file)
}

/// 31 by 31 traces of 100 m at 456000, 5999000; depths to 3000 m.
pub(super) fn survey_of_cases() -> SurveyGeometry {
    SurveyGeometry {
        inlines: LineAxis { first: 1, step: 1, count: 31 },
        crosslines: LineAxis { first: 1, step: 1, count: 31 },
        vertical: VerticalAxis { first: 0.0, interval: 10.0, count: 301, unit: VerticalUnit::Metres },
        origin: DVec2::new(456_000.0, 5_999_000.0),
        inline_vector: DVec2::new(100.0, 0.0),
        crossline_vector: DVec2::new(0.0, 100.0),
        velocity_m_s: 2500.0,
    }
}

/// Depth of the plane of the cases.
pub(super) fn plane_of_cases(xy: DVec2) -> f64 {
    1000.0 + 0.1 * (xy.x - 456_000.0) + 0.2 * (xy.y - 5_999_000.0)
}

/// The largest distance of a horizon from a depth in places, over the nodes that it has.
pub(super) fn worst(horizon: &Horizon, truth: impl Fn(DVec2) -> f64) -> (f64, usize) {
    let sheet = &horizon.sheets[0];
    let nv = sheet.grid.count[1];
    let known = sheet.depth.iter().enumerate().filter(|(_, z)| z.is_finite());
    known.fold((0.0, 0), |(worst, count), (n, z)| {
        let xy = sheet.grid.world_at(DVec2::new((n / nv) as f64, (n % nv) as f64));
        (f64::max(worst, (f64::from(*z) - truth(xy)).abs()), count + 1)
    })
}

pub(super) fn well(path: &Path, options: &WellOptions) -> (Well, WellReport) {
    let files = WellFiles { deviation: path.to_owned(), ..WellFiles::default() };
    read_well(&files, options).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

#[test]
fn us_survey_feet_of_a_column_are_us_survey_feet() {
    for (name, unit) in
        [("43-units-stated/z_usft.csv", ZUnit::SurveyFeet), ("43-units-stated/depth_ft.csv", ZUnit::Feet)]
    {
        let Some(path) = case(name) else { return };
        let (horizon, report) = read_horizons(&path, &survey_of_cases(), &ImportOptions::default()).unwrap().remove(0);
        assert_eq!(report.z_unit.value, unit, "{report}");
        let scale = unit.in_survey() / 0.3048;
        let (worst, count) = worst(&horizon, |xy| plane_of_cases(xy) * scale);
        assert!(worst < 0.01 && count == 961, "{name}: {worst} m off at {count} nodes");
    }
}

#[test]
fn the_datum_is_the_difference_of_two_columns() {
    for name in ["01-openworks-survey/tor9.txt", "01-openworks-survey/tor9-positions.txt"] {
        let Some(path) = case(name) else { return };
        let (well, report) = well(&path, &WellOptions { name: Some("Tor 9".into()), ..WellOptions::default() });
        assert_eq!(well.path.datum_m(), 25.0, "{report:?}");
        let end = well.path.position_at_md(2600.0).unwrap();
        assert!(end.distance(DVec3::new(458_051.10, 6_000_606.85, 2105.14)) < 0.02, "{name}: {end}");
        assert!(report.warnings.is_empty(), "{report:?}");
    }
}

#[test]
fn a_name_alone_before_rows_of_places_is_a_well() {
    let Some(path) = case("03-name-then-rows/p1h.txt") else { return };
    let stated =
        WellOptions { columns: Some(well::WellColumn::parse_list("x,y,tvdss,md").unwrap()), ..WellOptions::default() };
    for options in [WellOptions::default(), stated] {
        let (well, report) = well(&path, &options);
        assert_eq!((well.path.datum_m(), well.name.as_str()), (25.0, "P-1H"), "{report:?}");
        let end = well.path.position_at_md(2600.0).unwrap();
        assert!(end.distance(DVec3::new(458_051.10, 6_000_606.85, 2105.14)) < 0.02, "{end}");
        assert_eq!(
            report.assumptions.iter().any(|note| note.fact.contains("X, Y, TVDSS, MD")),
            options.columns.is_none()
        );
    }
}

#[test]
fn a_sidetrack_begins_where_its_places_do() {
    for (name, first) in [("09-petrel-sidetrack/tor9-t2.txt", 1400.0), ("09-petrel-sidetrack/tor9-feet.txt", 0.0)] {
        let Some(path) = case(name) else { return };
        let (well, report) = well(&path, &WellOptions::default());
        assert!(
            (well.path.md_range_m()[0] - first).abs() < 1e-6 && (well.path.datum_m() - 25.0).abs() < 1e-6,
            "{report:?}"
        );
        let end = well.path.position_at_md(well.path.md_range_m()[1]).unwrap();
        assert!(end.distance(DVec3::new(458_051.10, 6_000_606.85, 2105.14)) < 0.02, "{name}: {end}; {report:?}");
        assert!(report.warnings.is_empty(), "{report:?}");
    }
}

#[test]
fn tops_in_the_feet_of_their_header_lie_where_they_were_picked() {
    let (Some(tops), Some(path)) = (case("10-petrel-tops-feet/tops.txt"), case("01-openworks-survey/tor9.txt")) else {
        return;
    };
    let files = WellFiles { deviation: path, tops: Some(tops), ..WellFiles::default() };
    let (well, report) =
        read_well(&files, &WellOptions { name: Some("Tor_9".into()), ..WellOptions::default() }).unwrap();
    let top = well.tops.iter().find(|top| top.name == "Top A").unwrap();
    assert!((top.md_m - 1050.7).abs() < 0.05, "{top:?} {report:?}");
}
