//! Paths in closed form, wells in surveys.

use super::*;
use crate::geometry::{SurveyGeometry, VerticalUnit};
use glam::{DVec2, DVec3};

fn survey(md_m: f64, inclination_deg: f64, azimuth_deg: f64) -> Survey {
    Survey { md_m, inclination_deg, azimuth_deg }
}

/// Vertical to 500 m, then a quarter circle of radius 300 m towards azimuth 60°, surveyed at few depths.
fn quarter_circle() -> WellPath {
    let end = 500.0 + 300.0 * std::f64::consts::FRAC_PI_2;
    let bend = |share: f64| survey(500.0 + share * (end - 500.0), 90.0 * share, 60.0);
    let surveys = [survey(0.0, 0.0, 0.0), survey(500.0, 0.0, 60.0), bend(0.3), bend(0.45), bend(1.0)];
    WellPath::minimum_curvature(DVec2::new(1000.0, 2000.0), 25.0, &surveys).unwrap()
}

#[test]
fn a_circular_build_section_is_exact_everywhere() {
    let path = quarter_circle();
    let [_, end] = path.md_range_m();
    for n in 0..=400 {
        let md = end * f64::from(n) / 400.0;
        let angle = ((md - 500.0) / 300.0).max(0.0);
        let out = 300.0 * (1.0 - angle.cos());
        let (sin, cos) = 60f64.to_radians().sin_cos();
        let depth = if md <= 500.0 { md } else { 500.0 + 300.0 * angle.sin() };
        let wanted = DVec3::new(1000.0 + out * sin, 2000.0 + out * cos, depth - 25.0);
        let found = path.position_at_md(md).unwrap();
        assert!(found.distance(wanted) < 1e-7, "{md}: {found} {wanted}");
        let direction = path.direction_at_md(md).unwrap();
        let wanted = DVec3::new(angle.sin() * sin, angle.sin() * cos, angle.cos());
        assert!(direction.distance(wanted) < 1e-7, "{md}: {direction} {wanted}");
    }
    let severity = path.dogleg_severity();
    assert!((severity - (30.0f64 / 300.0).to_degrees()).abs() < 1e-6, "{severity}");
}

#[test]
fn vertical_and_slanted_wells_are_straight() {
    let vertical =
        WellPath::minimum_curvature(DVec2::ZERO, 10.0, &[survey(0.0, 0.0, 77.0), survey(3000.0, 0.0, 12.0)]).unwrap();
    assert!(vertical.position_at_md(1234.5).unwrap().distance(DVec3::new(0.0, 0.0, 1224.5)) < 1e-9);
    // 30° towards the south-east from the head on.
    let slanted =
        WellPath::minimum_curvature(DVec2::ZERO, 0.0, &[survey(0.0, 30.0, 135.0), survey(2000.0, 30.0, 135.0)])
            .unwrap();
    let wanted = 800.0 * DVec3::new(0.5 * 0.5f64.sqrt(), -0.5 * 0.5f64.sqrt(), 0.75f64.sqrt());
    assert!(slanted.position_at_md(800.0).unwrap().distance(wanted) < 1e-9);
    assert_eq!(slanted.position_at_md(-0.1), None);
}

#[test]
fn arcs_and_parabolas_meet_where_one_replaces_the_other() {
    // Just above and just below the angle at which the arc is computed as a parabola.
    let at = |degrees: f64| {
        let surveys = [survey(0.0, 10.0, 40.0), survey(30.0, 10.0 + degrees, 40.0)];
        WellPath::minimum_curvature(DVec2::ZERO, 0.0, &surveys).unwrap().position_at_md(17.0).unwrap()
    };
    let (below, above) = (at(0.00572), at(0.00574));
    assert!(below.distance(above) < 2e-5, "{below} {above}");
}

#[test]
fn depths_are_found_along_arcs_and_where_the_hole_comes_up_again() {
    let path = quarter_circle();
    for tvdss in [100.0, 474.9, 480.0, 600.0, 770.0] {
        let [md] = path.mds_at_tvdss(tvdss)[..] else { panic!("{tvdss}") };
        assert!((path.position_at_md(md).unwrap().z - tvdss).abs() < 1e-9);
    }
    assert!(path.mds_at_tvdss(775.1).is_empty());
    // Down at 80°, then up at 100°.
    let surveys =
        [survey(0.0, 0.0, 0.0), survey(500.0, 80.0, 0.0), survey(900.0, 100.0, 0.0), survey(1400.0, 100.0, 0.0)];
    let wave = WellPath::minimum_curvature(DVec2::ZERO, 0.0, &surveys).unwrap();
    let deepest = (0..1400).map(|n| wave.position_at_md(f64::from(n)).unwrap().z).fold(0.0, f64::max);
    let found = wave.mds_at_tvdss(deepest - 5.0);
    assert_eq!(found.len(), 2, "{found:?}");
    assert!(found.iter().all(|md| (wave.position_at_md(*md).unwrap().z - deepest + 5.0).abs() < 1e-9));
}

#[test]
fn a_well_in_depth_and_in_time_surveys() {
    let mut well = Well::new("A", quarter_circle());
    let mut depth = SurveyGeometry::regular([201, 201, 301], 10.0, 4.0, VerticalUnit::Metres);
    depth.origin = DVec2::new(500.0, 1500.0);
    let voxel = well.voxel_at_md(300.0, &depth).unwrap();
    assert!(voxel.distance(DVec3::new(50.0, 50.0, 275.0 / 4.0)) < 1e-9);
    let line = well.path_in_voxels(&depth);
    assert!(line.len() > 90 && line.windows(2).all(|w| w[0].distance(w[1]) < 4.0));
    let placement = well.placement(&depth);
    assert_eq!(placement.time_depth, TimeDepth::Depth);
    // The head is 25 m above sample 0; inside from there on.
    assert!((placement.inside_md_m.unwrap()[0] - 25.0).abs() < 10.1, "{placement:?}");
    assert!(placement.total_depth.inside && !placement.head.inside);

    let time = SurveyGeometry {
        vertical: crate::VerticalAxis { unit: VerticalUnit::Milliseconds, ..depth.vertical },
        ..depth
    };
    assert_eq!(well.place_at_md(425.0, &time).unwrap().z, 400.0);
    assert_eq!(well.time_depth(&time), TimeDepth::ConstantVelocity(2000.0));
    well.checkshot = Some(Checkshot::new(vec![[0.0, 0.0], [1000.0, 800.0]]).unwrap());
    assert_eq!(well.place_at_md(425.0, &time).unwrap().z, 320.0);
    assert_eq!(well.time_depth(&time), TimeDepth::Checkshot);
    let beside =
        SurveyGeometry { origin: DVec2::ZERO, ..SurveyGeometry::regular([5, 5, 5], 10.0, 4.0, VerticalUnit::Metres) };
    assert_eq!(well.placement(&beside).inside_md_m, None);
}
