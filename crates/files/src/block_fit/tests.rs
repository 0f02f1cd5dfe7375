//! Tests of the fit of scattered points by fault block, on surfaces of closed form.

use super::*;
use survey::geometry::VerticalUnit;
use survey::{Fault, TriangleMesh};

/// 101 × 81 traces 50 m apart, 101 samples 20 m apart.
fn geometry() -> SurveyGeometry {
    SurveyGeometry::regular([101, 81, 101], 50.0, 20.0, VerticalUnit::Metres)
}

/// A fault that dips by 60° towards larger x, at x = 2500 m in 1000 m depth, from one Y to another.
fn fault(from: f64, to: f64) -> Fault {
    let corner = |y: f64, z: f64| DVec3::new(at_fault(z), y, z);
    let vertices = vec![corner(from, -200.0), corner(to, -200.0), corner(to, 2300.0), corner(from, 2300.0)];
    Fault::new("F", TriangleMesh { vertices, triangles: vec![[0, 1, 2], [0, 2, 3]] })
}

fn at_fault(z: f64) -> f64 {
    2500.0 + (z - 1000.0) / 60f64.to_radians().tan()
}

fn network(faults: &[Fault]) -> FaultNetwork {
    FaultNetwork::build(&geometry(), faults, &Progress::silent()).unwrap()
}

fn fit(points: &[DVec3], faults: &FaultNetwork) -> BlockFit {
    fit_blocks(points, &geometry(), faults, None, &Progress::silent()).unwrap()
}

/// Four places on either side of the fault.
const LEFT: [[f64; 2]; 4] = [[400.0, 530.0], [1900.0, 700.0], [570.0, 3400.0], [1700.0, 3310.0]];
const RIGHT: [[f64; 2]; 4] = [[3110.0, 600.0], [4500.0, 940.0], [3300.0, 3500.0], [4610.0, 3200.0]];

/// Points of a surface, of which the side right of the fault lies elsewhere.
fn sides(
    left: &[[f64; 2]],
    right: &[[f64; 2]],
    foot: impl Fn(f64, f64) -> f64,
    hanging: impl Fn(f64, f64) -> f64,
) -> Vec<DVec3> {
    let of = |places: &[[f64; 2]], z: &dyn Fn(f64, f64) -> f64| {
        places.iter().map(|[x, y]| DVec3::new(*x, *y, z(*x, *y))).collect::<Vec<_>>()
    };
    [of(left, &foot), of(right, &hanging)].concat()
}

/// The largest error of all nodes, and how many lie within three traces of the fault.
fn errors(fit: &BlockFit, foot: impl Fn(f64, f64) -> f64, hanging: impl Fn(f64, f64) -> f64) -> (f64, usize) {
    let (mut worst, mut beside) = (0.0f64, 0);
    for sheet in &fit.sheets {
        for (n, z) in sheet.depth.iter().enumerate().filter(|(_, z)| z.is_finite()) {
            let ([x, y], z) = ([50.0 * (n / 81) as f64, 50.0 * (n % 81) as f64], f64::from(*z));
            let off = x - at_fault(z);
            if off.abs() < 2.0 {
                // On the fault itself either side is right.
                continue;
            }
            let truth = if off > 0.0 { hanging(x, y) } else { foot(x, y) };
            beside += usize::from(off.abs() < 150.0);
            worst = worst.max((z - truth).abs());
        }
    }
    (worst, beside)
}

fn plane(x: f64, y: f64) -> f64 {
    1000.0 + 0.02 * (x - 2500.0) + 0.03 * (y - 2000.0)
}

#[test]
fn four_points_a_block_give_a_planar_horizon_its_throw() {
    for throw in [150.0, -150.0, 30.0] {
        let down = move |x: f64, y: f64| plane(x, y) + throw;
        let fit = fit(&sides(&LEFT, &RIGHT, plane, down), &network(&[fault(-300.0, 4300.0)]));
        let (worst, beside) = errors(&fit, plane, down);
        assert!(worst < 0.05, "{throw}: {worst}");
        assert!(beside > 200, "{throw}: {beside}");
        assert_eq!(fit.points.values().copied().collect::<Vec<_>>(), [4, 4]);
        assert!(fit.empty.is_empty() && fit.moved == 0);
    }
}

#[test]
fn blocks_that_turned_against_each_other_keep_their_own_dips() {
    let turned = |x: f64, y: f64| plane(x, y) + 100.0 + 0.05 * (y - 2000.0) + 0.06 * (x - 2500.0);
    let fit = fit(&sides(&LEFT, &RIGHT, plane, turned), &network(&[fault(-300.0, 4300.0)]));
    let (worst, _) = errors(&fit, plane, turned);
    assert!(worst < 0.1, "{worst}");
}

#[test]
fn a_block_with_one_point_takes_its_shape_from_the_other() {
    let down = |x: f64, y: f64| plane(x, y) + 150.0;
    let fit = fit(&sides(&LEFT, &RIGHT[..1], plane, down), &network(&[fault(-300.0, 4300.0)]));
    let (worst, beside) = errors(&fit, plane, down);
    assert!(worst < 0.05 && beside > 100, "{worst} {beside}");
    assert_eq!(fit.points.values().sum::<usize>(), 5);
}

#[test]
fn a_throw_is_kept_along_a_fault_where_one_side_has_few_points() {
    // A ridge across the fault, known well on the left; on the right three points at one end.
    let ridge = |x: f64, y: f64| plane(x, y) - 120.0 * (-((y - 2000.0) / 700.0).powi(2)).exp();
    let down = |x: f64, y: f64| ridge(x, y) + 150.0;
    let left: Vec<[f64; 2]> =
        (0..60).map(|n| [30.0 + 40.0 * f64::from(n), 20.0 + f64::from(n * 37 % 60) * 66.0]).collect();
    let few = [[3000.0, 300.0], [4300.0, 450.0], [3500.0, 900.0]];
    let points = sides(&left, &few, ridge, down);
    let fit = fit(&points, &network(&[fault(-300.0, 4300.0)]));
    // Beside the fault, far from the three points.
    let mut worst = 0.0f64;
    for sheet in &fit.sheets {
        for (n, z) in sheet.depth.iter().enumerate().filter(|(_, z)| z.is_finite()) {
            let ([x, y], z) = ([50.0 * (n / 81) as f64, 50.0 * (n % 81) as f64], f64::from(*z));
            let off = x - at_fault(z);
            if (0.0..200.0).contains(&off) && (500.0..3000.0).contains(&y) {
                worst = worst.max((z - down(x, y)).abs());
            }
        }
    }
    assert!(worst > 0.0 && worst < 30.0, "{worst}");
}

#[test]
fn a_block_without_points_is_named() {
    let fit = fit(&sides(&LEFT, &[], plane, plane), &network(&[fault(-300.0, 4300.0)]));
    assert_eq!(fit.points.len(), 1);
    // The points of the left end before the fault: nothing is known to lie beyond it.
    assert!(fit.empty.is_empty());
    // Points on both ends of a graben whose middle has none.
    let other = |x: f64| {
        let mut other = fault(-300.0, 4300.0);
        other.name = "G".into();
        other.mesh.vertices.iter_mut().for_each(|v| v.x += x);
        other
    };
    let faults = network(&[fault(-300.0, 4300.0), other(900.0)]);
    let beyond = [[4200.0, 600.0], [4900.0, 940.0], [4300.0, 3500.0], [4610.0, 3200.0]];
    let fit = self::fit(&sides(&LEFT, &beyond, plane, plane), &faults);
    assert_eq!((fit.points.len(), fit.empty.len()), (2, 1));
    let [inline, _] = fit.empty[0];
    assert!((50..=75).contains(&inline), "{:?}", fit.empty);
}

#[test]
fn beyond_its_tip_a_fault_moves_nothing() {
    // The fault ends at Y = 2000 m; the throw grows from there to 160 m at Y = 0.
    let throw = |y: f64| 0.08 * (2000.0 - y).max(0.0);
    let down = |x: f64, y: f64| plane(x, y) + throw(y);
    let grid = |from: f64| {
        let place = move |n: usize| [from + 317.0 * (n % 7) as f64, 90.0 + 560.0 * (n / 7) as f64];
        (0..49).map(place).collect::<Vec<_>>()
    };
    let faults = network(&[fault(-300.0, 2000.0)]);
    // No point lies within 600 m of the fault beyond its tip.
    let is_known = |[x, y]: &[f64; 2]| *y < 2000.0 || (*x - 2500.0).abs() > 600.0;
    let (left, right): (Vec<_>, Vec<_>) =
        (grid(40.0).into_iter().filter(is_known).collect(), grid(2950.0).into_iter().filter(is_known).collect());
    let fit = fit(&sides(&left, &right, plane, down), &faults);
    let z = |x: usize, y: usize| {
        let known = fit.sheets.iter().map(|sheet| sheet.depth[x * 81 + y]).filter(|z| z.is_finite());
        known.fold(f32::NAN, f32::max)
    };
    for y in 46..75 {
        let across: Vec<f32> = (40..61).map(|x| z(x, y)).collect();
        let step = across.windows(3).map(|w| (w[0] - 2.0 * w[1] + w[2]).abs()).fold(0.0, f32::max);
        assert!(step < 1.5, "{y}: {step} {across:?}");
    }
    let (worst, _) = errors(&fit, plane, down);
    // No point tells where the hinge is.
    assert!(worst < 20.0, "{worst}");
}

#[test]
fn a_point_that_was_read_beside_the_wrong_side_counts_on_the_other() {
    let down = |x: f64, y: f64| plane(x, y) + 150.0;
    let mut points = sides(&LEFT, &RIGHT, plane, down);
    // Two traces beyond the fault, with the depth of the footwall.
    points.push(DVec3::new(at_fault(1000.0) + 100.0, 2000.0, plane(2600.0, 2000.0)));
    let fit = fit(&points, &network(&[fault(-300.0, 4300.0)]));
    assert_eq!(fit.moved, 1);
    assert!(errors(&fit, plane, down).0 < 0.1);
}

#[test]
fn thousands_of_points_are_met_on_both_sides() {
    let fold = |x: f64, y: f64| plane(x, y) + 40.0 * (x / 400.0).sin() * (y / 500.0).cos();
    let down = |x: f64, y: f64| fold(x, y) + 150.0;
    let place = |n: usize| [(n * 7919 % 100_003) as f64 / 20.0, (n * 104_729 % 80_021) as f64 / 20.0];
    let (left, right): (Vec<_>, Vec<_>) = (0..6000).map(place).partition(|[x, _]| *x < 2500.0);
    let points = sides(
        &left.into_iter().filter(|[x, y]| *x < at_fault(fold(*x, *y))).collect::<Vec<_>>(),
        &right.into_iter().filter(|[x, y]| *x > at_fault(down(*x, *y))).collect::<Vec<_>>(),
        fold,
        down,
    );
    let fit = fit(&points, &network(&[fault(-300.0, 4300.0)]));
    let (worst, beside) = errors(&fit, fold, down);
    // The worst of it is continued beyond the last points.
    assert!(worst < 6.0 && beside > 300, "{worst} {beside}");
}

#[test]
fn points_in_one_row_or_at_one_place_are_no_error() {
    let faults = network(&[fault(-300.0, 4300.0)]);
    let row: Vec<DVec3> = (0..9).map(|n| DVec3::new(500.0 * f64::from(n) + 100.0, 2000.0, 900.0)).collect();
    let made = fit(&row, &faults);
    assert_eq!(made.sheets.len(), 2);
    assert!(made.sheets.iter().all(|sheet| sheet.node_count() >= 25));
    assert!(made.sheets.iter().flat_map(|s| &s.depth).filter(|z| z.is_finite()).all(|z| (*z - 900.0).abs() < 0.1));
    assert_eq!(fit(&[DVec3::new(100.0, 100.0, 500.0); 3], &faults).sheets.len(), 1);
    assert!(fit(&[], &faults).sheets.is_empty());
}
