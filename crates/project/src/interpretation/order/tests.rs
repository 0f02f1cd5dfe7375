//! The order in which horizons lie.

use super::*;
use survey::{Quality, Sheet, VerticalUnit};

fn is_above(a: &Horizon, b: &Horizon, geometry: &SurveyGeometry) -> bool {
    lean(a, b, geometry) > 0.0
}

fn geometry() -> SurveyGeometry {
    SurveyGeometry::regular([20, 20, 50], 25.0, 4.0, VerticalUnit::Milliseconds)
}

fn horizon(name: &str, sheets: &[fn(f32, f32) -> f32]) -> Horizon {
    let grid = NodeGrid::of_survey(&geometry());
    let sheet = |depth: &fn(f32, f32) -> f32| {
        let depths = (0..400).map(|n| depth((n / 20) as f32, (n % 20) as f32)).collect();
        Sheet::new(grid, depths, Quality::Picked)
    };
    Horizon::new(name, sheets.iter().map(sheet).collect())
}

#[test]
fn a_horizon_below_another_is_in_order_and_the_reverse_crosses_everywhere() {
    let (a, b) = (horizon("a", &[|x, _| 50.0 + x]), horizon("b", &[|x, _| 70.0 + x]));
    assert!(is_above(&a, &b, &geometry()) && !is_above(&b, &a, &geometry()));
    check(&a, &b, &geometry()).unwrap();
    let Err(ProjectError::Crossing { share, worst, .. }) = check(&b, &a, &geometry()) else {
        panic!("not refused");
    };
    assert_eq!((share, worst), (1.0, 20.0));
}

#[test]
fn a_dipping_horizon_through_a_flat_one_crosses_where_it_is_deepest() {
    let (flat, dipping) = (horizon("flat", &[|_, _| 80.0]), horizon("dipping", &[|x, _| 40.0 + 4.0 * x]));
    let Err(ProjectError::Crossing { lines, worst, .. }) = check(&dipping, &flat, &geometry()) else {
        panic!("not refused");
    };
    assert_eq!((lines[0], worst), (20.0, 36.0));
}

/// Two depths across a reverse fault: the lower sheet of the younger lies below the upper one of the
/// older.
#[test]
fn a_reverse_fault_is_no_crossing() {
    let young: [fn(f32, f32) -> f32; 2] =
        [|x, _| if x < 12.0 { 100.0 } else { f32::NAN }, |x, _| if x >= 8.0 { 40.0 } else { f32::NAN }];
    let old: [fn(f32, f32) -> f32; 2] =
        [|x, _| if x < 14.0 { 130.0 } else { f32::NAN }, |x, _| if x >= 10.0 { 70.0 } else { f32::NAN }];
    check(&horizon("young", &young), &horizon("old", &old), &geometry()).unwrap();
}

#[test]
fn a_horizon_is_placed_where_most_others_lie_on_their_side_of_it() {
    let flat: [fn(f32, f32) -> f32; 5] = [|_, _| 20.0, |_, _| 60.0, |_, _| 100.0, |_, _| 140.0, |x, _| 70.0 + x];
    let [a, b, c, d, between] = flat.map(|depth| horizon("h", &[depth]));
    let others = [a, b, c, d];
    let conformable = [Contact::Conformable; 5];
    let place = |horizon: &Horizon, others: &[Horizon]| place_among(horizon, others, &conformable, &geometry());
    assert_eq!(place(&between, &others), 2);
    assert_eq!(place(&between, &[]), 0);
    let place_of = |depth| place(&horizon("h", &[depth]), &others);
    assert_eq!((place_of(|_, _| 5.0), place_of(|_, _| 190.0)), (0, 4));
    // It crosses the second one, and lies above it at most traces.
    assert_eq!(place_of(|x, _| 45.0 + x), 1);
    // A body says nothing, wherever it lies in the list and in depth.
    let triangles = synth::shapes::Diapir::fitting(&geometry()).mesh(&geometry(), 20);
    let [a, b, c, d] = others;
    let with_body = [a, Horizon::of_surface("body", triangles), b, c, d];
    let contacts = [0, 1, 2, 3, 4].map(|n| if n == 1 { Contact::Intrusive } else { Contact::Conformable });
    assert_eq!(place_among(&between, &with_body, &contacts, &geometry()), 3);
}

/// Points scattered over two beds of a recumbent fold, by a low-discrepancy sequence in y and z.
#[test]
fn few_scattered_points_of_overturned_beds_are_ordered_by_age() {
    let geometry = SurveyGeometry::regular([61, 51, 56], 10.0, 10.0, VerticalUnit::Metres);
    let fold = synth::shapes::RecumbentFold::fitting(&geometry);
    let bed = |age: f64, count: usize, shift: f64| {
        let points = (0..4 * count).map(|n| {
            let (y, z) = ((shift + n as f64 * 0.754_877).fract() * 500.0, (n as f64 * 0.569_84).fract() * 550.0);
            DVec3::new(fold.x_of(age, z), y, z)
        });
        let vertices = points.filter(|p| (0.0..=600.0).contains(&p.x)).take(count).collect();
        Horizon::of_surface("bed", survey::TriangleMesh { vertices, triangles: Vec::new() })
    };
    for shift in [0.0, 0.3, 0.6] {
        for (young, old) in [(-200.0, -130.0), (-130.0, 60.0), (-200.0, 60.0), (-40.0, 10.0)] {
            let (above, below) = (bed(young, 30, shift), bed(old, 24, 1.7 * shift));
            assert!(is_above(&above, &below, &geometry), "{young} {old} {shift}");
            assert!(!is_above(&below, &above, &geometry), "{young} {old} {shift}");
        }
    }
}
