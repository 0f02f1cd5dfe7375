//! Columns of wells side by side.

use super::*;
use survey::well::{Curve, LogSet, Survey, Top, WellPath};

fn well(name: &str, x: f64, tops: &[(&str, f64)]) -> Well {
    let vertical = [0.0, 1000.0].map(|md_m| Survey { md_m, inclination_deg: 0.0, azimuth_deg: 0.0 });
    let mut well = Well::new(name, WellPath::minimum_curvature(DVec2::new(x, 100.0), 0.0, &vertical).unwrap());
    well.tops = tops.iter().map(|(name, md_m)| Top { name: (*name).into(), md_m: *md_m }).collect();
    well
}

fn horizons(contacts: [Contact; 3]) -> Vec<StratigraphicHorizon> {
    ["A", "B", "C"]
        .into_iter()
        .zip(contacts)
        .map(|(name, contact)| StratigraphicHorizon { name: name.into(), contact })
        .collect()
}

fn made(part: &CorrelationPart, wells: &[Well], contacts: [Contact; 3]) -> Result<Vec<Column>, FigureError> {
    let geometry = SurveyGeometry::regular([21, 21, 101], 25.0, 10.0, VerticalUnit::Metres);
    columns(part, &ColumnSource { wells, geometry: &geometry, horizons: &horizons(contacts), model: None })
}

const CONFORMABLE: [Contact; 3] = [Contact::Conformable; 3];

fn layers(column: &Column) -> Vec<(usize, [f64; 2])> {
    column.intervals.iter().map(|interval| (interval.layer, interval.z)).collect()
}

#[test]
fn layers_follow_from_tops_whatever_their_case() {
    let column = &made(
        &CorrelationPart::default(),
        &[well("1", 0.0, &[("a", 100.0), ("B", 300.0), ("X", 350.0), ("C", 600.0)])],
        CONFORMABLE,
    )
    .unwrap()[0];
    assert_eq!(layers(column), [(0, [0.0, 100.0]), (1, [100.0, 300.0]), (2, [300.0, 600.0]), (3, [600.0, 1000.0])]);
    assert_eq!(column.markers[2], Marker { name: "X".into(), horizon: None, z: 350.0 });
    assert_eq!(column.markers[0].name, "A", "as the horizon is called");
}

#[test]
fn a_missing_layer_was_eroded_below_an_unconformity_and_wedges_out_elsewhere() {
    let wells =
        [well("1", 0.0, &[("A", 100.0), ("B", 200.0), ("C", 300.0)]), well("2", 50.0, &[("A", 150.0), ("C", 250.0)])];
    let conformable = made(&CorrelationPart::default(), &wells, CONFORMABLE).unwrap();
    assert_eq!(layers(&conformable[1])[1], (1, [150.0, 250.0]));
    assert_eq!(place_of_layer(&conformable[1], 2), Some([250.0; 2]));
    let eroded =
        made(&CorrelationPart::default(), &wells, [Contact::Erosional, Contact::Conformable, Contact::Conformable])
            .unwrap();
    assert_eq!(layers(&eroded[1])[1], (2, [150.0, 250.0]));
    assert_eq!(place_of_layer(&eroded[1], 1), Some([150.0; 2]));
    let b = &wells[0].tops[1];
    let surface = Marker { name: b.name.clone(), horizon: Some(1), z: 0.0 };
    assert_eq!(place_of_surface(&conformable[1], &surface), Some((250.0, false)));
    assert_eq!(place_of_surface(&eroded[1], &surface), Some((150.0, false)));
}

#[test]
fn the_datum_is_level_and_a_well_without_it_is_refused() {
    let wells = [well("1", 0.0, &[("A", 100.0), ("B", 200.0)]), well("2", 50.0, &[("A", 150.0)])];
    let part = CorrelationPart { datum: Some("a".into()), ..CorrelationPart::default() };
    let level = made(&part, &wells, CONFORMABLE).unwrap();
    let surface = level[0].markers[0].clone();
    for column in &level {
        assert_eq!(place_of_surface(column, &surface), Some((0.0, true)));
    }
    let part = CorrelationPart { datum: Some("B".into()), ..part };
    let refused = made(&part, &wells, CONFORMABLE).unwrap_err().to_string();
    assert!(refused.contains("well \"2\" does not meet B") && refused.contains("its tops: A"), "{refused}");
    let part = CorrelationPart { wells: vec!["3".into()], ..CorrelationPart::default() };
    assert!(made(&part, &wells, CONFORMABLE).unwrap_err().to_string().contains("the wells are 1, 2"));
    assert!(matches!(made(&part, &[], CONFORMABLE), Err(FigureError::NoWells)));
}

#[test]
fn the_curve_that_most_wells_have_is_drawn_and_others_by_name() {
    let mut wells = [well("1", 0.0, &[]), well("2", 50.0, &[])];
    let set = |names: &[&str]| LogSet {
        source: String::new(),
        md_m: vec![0.0, 500.0],
        curves: names
            .iter()
            .map(|name| Curve {
                name: (*name).into(),
                unit: "u".into(),
                description: String::new(),
                values: vec![1.0, 2.0],
            })
            .collect(),
    };
    wells[0].logs = vec![set(&["RHOB", "GR"])];
    wells[1].logs = vec![set(&["gr"])];
    let made_of =
        |logs: Option<Vec<String>>| made(&CorrelationPart { logs, ..CorrelationPart::default() }, &wells, CONFORMABLE);
    let columns = made_of(None).unwrap();
    assert_eq!(columns[1].logs[0].as_ref().unwrap().samples, [(0.0, 1.0), (500.0, 2.0)]);
    assert!(made_of(Some(vec!["rhob".into()])).unwrap()[1].logs == [None]);
    assert!(made_of(Some(Vec::new())).unwrap()[0].logs.is_empty());
    assert!(made_of(Some(vec!["DT".into()])).unwrap_err().to_string().contains("there are RHOB, GR"));
}
