//! k as a flow against closed forms, and what the flow follows.

mod closed_form;

use closed_form::ClosedForm;
use glam::{DMat3, DVec3, Vec3};
use param::accuracy;
use param::{KDefinition, ParamSettings, Parameterization, Region};
use std::f64::consts::TAU;
use survey::Progress;

fn parameterize(model: &ClosedForm, definition: KDefinition) -> Parameterization {
    smoothed(model, definition, 0.0)
}

fn smoothed(model: &ClosedForm, definition: KDefinition, flow_wave_m: f64) -> Parameterization {
    let layers = param::LayerModel::layer_count(model);
    let settings = ParamSettings { definitions: vec![definition; layers], flow_wave_m, ..Default::default() };
    Parameterization::compute(model, &settings, &Progress::silent()).unwrap()
}

const FLOWS: [KDefinition; 3] = [KDefinition::Flow, KDefinition::Harmonic, KDefinition::Proportional];

#[test]
fn k_is_linear_between_flat_and_between_dipping_planes() {
    // A sheared survey: x and y are neither perpendicular nor of one length.
    let shear = DMat3::from_cols(DVec3::new(12.0, 3.0, 0.0), DVec3::new(-4.0, 15.0, 0.0), DVec3::new(0.0, 0.0, 8.0));
    for (dip, metric) in [(0.0, DMat3::IDENTITY), (0.6, DMat3::IDENTITY), (0.5, shear)] {
        let model = ClosedForm::new([40, 36, 60], 2, |h, x, y| 14.0 + 22.0 * h as f64 + dip * (0.6 * x - 0.3 * y))
            .with_metric(metric);
        for definition in FLOWS {
            let param = parameterize(&model, definition);
            for (x, y, z) in [(3.0, 2.0, 25.0), (20.5, 18.25, 31.0), (38.0, 1.0, 38.0), (0.0, 35.0, 20.0)] {
                let p = Vec3::new(x, y, z);
                let found = param.lookup(&model, p);
                if found.region.layer == 1 {
                    let top = 14.0 + dip as f32 * (0.6 * x - 0.3 * y);
                    let k = (top + 22.0 - z) / 22.0;
                    assert!((found.k - k).abs() < 2e-4, "{definition:?} {dip}: {} for {k}", found.k);
                }
            }
            // Curves along ∇k are normals of the planes.
            let angles = accuracy::angles(&model, &param, |p| param.lookup(&model, p), 2000).unwrap();
            assert!(angles.k_to_i.max < 0.2 && angles.k_to_j.max < 0.2, "{definition:?} {dip}: {angles:?}");
        }
    }
}

#[test]
fn in_a_wedge_k_is_the_angle() {
    // Both planes pass through x = −30 at z = 30.
    let (upper, lower) = (-0.1f64, 0.5f64);
    let model = ClosedForm::new([60, 12, 90], 2, |h, x, _| 30.0 + [upper, lower][h] * (x + 30.0));
    let param = parameterize(&model, KDefinition::Flow);
    let (mut worst, mut places) = (0.0f64, 0);
    for x in (0..60).step_by(3) {
        for z in (20..85).step_by(3) {
            let p = Vec3::new(x as f32, 5.5, z as f32);
            let found = param.lookup(&model, p);
            // At the sides k continues as the sheets do, which in a wedge it would not.
            if found.region.layer != 1 || !(12..48).contains(&x) {
                continue;
            }
            let angle = ((f64::from(p.z) - 30.0) / (f64::from(p.x) + 30.0)).atan();
            let expected = (lower.atan() - angle) / (lower.atan() - upper.atan());
            worst = worst.max((f64::from(found.k) - expected).abs());
            places += 1;
        }
    }
    assert!(places > 100 && worst < 4e-3, "{worst} at {places} places");
}

#[test]
fn between_concentric_arcs_k_is_the_logarithm_of_the_radius() {
    // A cylinder around y; radii 80 and 100 voxels, centre below the volume.
    let (centre, radii) = (110.0f64, [100.0f64, 80.0]);
    let arc = move |h: usize, x: f64| {
        let a = (x - 50.0).clamp(-72.0, 72.0);
        centre - (radii[h] * radii[h] - a * a).sqrt()
    };
    let model = ClosedForm::new([101, 10, 90], 2, move |h, x, _| arc(h, x));
    let param = parameterize(&model, KDefinition::Flow);
    let mut worst = 0.0f64;
    for x in (24..=76).step_by(4) {
        for n in 1..8 {
            let (top, bottom) = (arc(0, f64::from(x)), arc(1, f64::from(x)));
            let p = Vec3::new(x as f32, 4.5, (top + (bottom - top) * f64::from(n) / 8.0) as f32);
            let radius = (f64::from(x) - 50.0).hypot(centre - f64::from(p.z));
            let expected = (radius / radii[1]).ln() / (radii[0] / radii[1]).ln();
            worst = worst.max((f64::from(param.lookup(&model, p).k) - expected).abs());
        }
    }
    assert!(worst < 3e-3, "{worst}");
}

/// How far the bed through a crest lies above the one through a trough at the same depth, over the height of the waves,
/// at a distance from the mean horizon.
fn relief(definition: KDefinition, wave: f64, distance: f32) -> f64 {
    let height = 0.4;
    let model = ClosedForm::new([128, 10, 120], 1, move |_, x, _| 100.0 - height * (TAU * (x - 64.0) / wave).cos());
    let settings = ParamSettings { definitions: vec![definition; 2], level_spacing: 1.5, ..Default::default() };
    let param = Parameterization::compute(&model, &settings, &Progress::silent()).unwrap();
    let above = Region { layer: 1, block: 0 };
    let k = |x: f64| f64::from(param.lookup_in(&model, Vec3::new(x as f32, 4.5, 100.0 - distance), above).0.k);
    let reference = param.grid(above).thickness_m.unwrap();
    // A crest in the middle, a trough half a wave on.
    let trough_less_crest = k(64.0 + 0.5 * wave) - k(64.0);
    trough_less_crest * reference / (2.0 * height)
}

#[test]
fn roughness_dies_out_with_the_distance_from_the_one_horizon() {
    // Waves with crests where the computed columns end (5 voxels past the volume): so they go on, mirrored.
    for wave in [34.5, 69.0] {
        let kappa = TAU / wave;
        for share in [0.1, 0.25, 0.5] {
            let distance = share * wave;
            let harmonic = (-kappa * distance).exp();
            let even = (1.0 + 0.5 * kappa * distance) * harmonic;
            let found = relief(KDefinition::Harmonic, wave, distance as f32);
            assert!((found - harmonic).abs() < 0.03, "harmonic, {wave} at {distance}: {found} for {harmonic}");
            let found = relief(KDefinition::Flow, wave, distance as f32);
            assert!((found - even).abs() < 0.06, "flow, {wave} at {distance}: {found} for {even}");
            let found = relief(KDefinition::Proportional, wave, distance as f32);
            assert!((found - 1.0).abs() < 0.02, "copies, {wave} at {distance}: {found}");
        }
    }
}

#[test]
fn copies_of_a_horizon_that_leaves_the_volume_reach_its_other_side() {
    // The horizon stands above the volume on one side (over an open layer below it), or lies below on the other.
    let model = ClosedForm::new([60, 12, 50], 1, |_, x, _| 60.0 - 1.5 * x);
    for definition in [KDefinition::Proportional, KDefinition::ParallelToTop, KDefinition::ParallelToBottom] {
        let param = parameterize(&model, definition);
        for (layer, x, z) in [(0, 58.0, 48.0), (0, 50.0, 44.0), (1, 1.0, 1.0)] {
            let region = Region { layer, block: 0 };
            let k = |z: f32| param.lookup_in(&model, Vec3::new(x, 6.0, z), region).0.k;
            let change = (k(z) - k(z + 1.0)) * param.grid(region).thickness_m.unwrap() as f32;
            // A voxel down is a voxel, or its distance to the plane.
            let expected = if definition == KDefinition::Proportional { 1.0 } else { 1.0 / 1.5f32.hypot(1.0) };
            assert!((change - expected).abs() < 0.02, "{definition:?}, layer {layer} at {x}, {z}: {change}");
        }
    }
}

#[test]
fn every_definition_is_accurate_on_folds() {
    let model = ClosedForm::folded();
    use KDefinition::{DistanceRatio, Flow, Harmonic, ParallelToBottom, ParallelToTop, Proportional};
    for definition in [Flow, Harmonic, DistanceRatio, Proportional, ParallelToBottom, ParallelToTop] {
        let param = parameterize(&model, definition);
        let angles = accuracy::angles(&model, &param, |p| param.lookup(&model, p), 8000).unwrap();
        for spread in [angles.k_to_i, angles.k_to_j] {
            assert!(spread.count > 5000 && spread.median <= 0.2 && spread.p95 <= 1.0, "{definition:?}: {angles:?}");
        }
        if matches!(definition, ParallelToBottom | ParallelToTop) {
            continue; // k is 0 or 1 on one of the two horizons only
        }
        let points =
            accuracy::horizon_points(&model, |h, b, x, y| param::LayerModel::sheet(&model, h, b).z_at(x, y), 1000);
        let k = accuracy::k_on_horizons(&model, &param, |p| param.lookup(&model, p), &points);
        assert!(k.count > 2000 && k.max <= 2e-3, "{definition:?}: {k:?}");
        if matches!(definition, Flow | Harmonic | Proportional) {
            assert_eq!(angles.at_creases, 0, "{definition:?} has no creases");
        }
    }
}

#[test]
fn a_calm_flow_keeps_folds_and_leaves_out_roughness() {
    let pick = |x: f64, y: f64| 1.5 * ((x * 12.9898 + y * 78.233).sin() * 43758.5453).fract();
    let fold = |h: usize, x: f64, y: f64| 30.0 + 30.0 * h as f64 + 6.0 * (TAU * (x + 0.3 * y) / 80.0).sin();
    let rough = ClosedForm::new([80, 40, 90], 2, move |h, x, y| fold(h, x, y) + pick(x, y + 100.0 * h as f64));
    let smooth = ClosedForm::new([80, 40, 90], 2, fold);
    let wave = 16.0;
    let (exact, calm) = (parameterize(&smooth, KDefinition::Flow), smoothed(&rough, KDefinition::Flow, wave));
    let between = Region { layer: 1, block: 0 };
    let mut worst = 0.0f32;
    for (x, y, z) in [(20.0, 20.0, 44.0), (41.0, 13.5, 47.0), (60.0, 30.0, 40.0), (33.3, 8.0, 50.0)] {
        let p = Vec3::new(x, y, z);
        let (a, b) = (exact.lookup_in(&smooth, p, between).0, calm.lookup_in(&rough, p, between).0);
        worst = worst.max(30.0 * (a.k - b.k).abs());
    }
    assert!(worst < 0.5, "the flow is off by {worst} voxels");
    // The drawn boundary is the rough one, to the voxel's thousandth.
    for (x, y) in [(20.0f32, 20.0f32), (41.0, 13.0), (60.0, 30.0)] {
        let z = (fold(0, x.into(), y.into()) + pick(x.into(), y.into())) as f32;
        let below = calm.lookup(&rough, Vec3::new(x, y, z + 2e-3)).region;
        let above = calm.lookup(&rough, Vec3::new(x, y, z - 2e-3)).region;
        assert_eq!((below.layer, above.layer), (1, 2), "{x}, {y}");
    }
    // Patterns go on to the drawn boundary; sampled k ends at 0 and 1.
    let voxels = calm.voxel_volumes(&rough, calm.size, &Progress::silent()).unwrap();
    let in_layer = voxels.k.samples().iter().zip(voxels.layer.samples()).filter(|(_, layer)| **layer == 1);
    assert!(in_layer.map(|(k, _)| *k).all(|k| (0.0..=1.0).contains(&k)));
    // Where the horizons are exact by definition, nothing is smoothed.
    let settings = |flow_wave_m| ParamSettings {
        definitions: vec![KDefinition::DistanceRatio; 3],
        flow_wave_m,
        ..Default::default()
    };
    let [with, without] =
        [wave, 0.0].map(|wave| Parameterization::compute(&rough, &settings(wave), &Progress::silent()).unwrap());
    assert_eq!(with.grids, without.grids);
}

#[test]
fn a_flow_has_the_same_bytes_on_any_number_of_threads() {
    let model = ClosedForm::folded();
    let computed = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| smoothed(&model, KDefinition::Flow, 12.0).grids)
    };
    assert!(computed(1) == computed(3));
}
