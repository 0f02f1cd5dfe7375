//! Layers between planes, where k, i and j are known in closed form: flat, dipping, wedges, pinch-outs, fault
//! blocks.

mod closed_form;

use closed_form::ClosedForm;
use glam::{DMat3, DVec3, Vec3};
use param::{KDefinition, ParamSettings, Parameterization, Region};
use survey::Progress;

/// By the published definition of k, in all layers.
fn compute(model: &ClosedForm) -> Parameterization {
    let definitions = vec![KDefinition::DistanceRatio; param::LayerModel::layer_count(model)];
    let settings = ParamSettings { definitions, ..Default::default() };
    Parameterization::compute(model, &settings, &Progress::silent()).unwrap()
}

/// A plane z = z0 + a·x + b·y.
#[derive(Clone, Copy)]
struct Plane {
    z0: f64,
    a: f64,
    b: f64,
}

impl Plane {
    fn z(&self, x: f64, y: f64) -> f64 {
        self.z0 + self.a * x + self.b * y
    }
}

/// Voxel where the line through `p` along the metric normal of `plane` meets `plane`.
fn along_normal(p: DVec3, plane: Plane, metric: DMat3) -> DVec3 {
    let normal = (metric.transpose() * metric).inverse() * DVec3::new(plane.a, plane.b, -1.0);
    let s = (plane.z(p.x, p.y) - p.z) / (normal.z - plane.a * normal.x - plane.b * normal.y);
    p + normal * s
}

#[test]
fn flat_layers_are_linear() {
    let depths = [10.0, 24.0, 40.0];
    let model = ClosedForm::new([20, 30, 50], 3, |h, _, _| depths[h]);
    let param = compute(&model);
    for (x, y, z) in [(0.0, 0.0, 12.0), (19.0, 29.0, 23.9), (7.3, 11.8, 10.0), (3.0, 4.0, 39.0), (10.5, 0.25, 30.0)] {
        let found = param.lookup(&model, Vec3::new(x, y, z));
        let (layer, bottom, top) = if z < 24.0 { (2, 24.0, 10.0) } else { (1, 40.0, 24.0) };
        assert_eq!(found.region, Region { layer, block: 0 });
        assert!((found.k - (bottom - z) / (bottom - top)).abs() < 1e-5, "k at {x}, {y}, {z}: {}", found.k);
        assert!((found.i - x / 19.0).abs() < 1e-6 && (found.j - y / 29.0).abs() < 1e-6);
    }
    // Open layers: k is the distance over the thickness up to the edge of the volume.
    let top = param.lookup(&model, Vec3::new(5.0, 5.0, 4.0));
    assert!((top.k - 0.6).abs() < 1e-5, "{}", top.k);
    let bottom = param.lookup(&model, Vec3::new(5.0, 5.0, 49.0));
    assert!(bottom.k.abs() < 1e-5, "{}", bottom.k);
}

#[test]
fn without_horizons_k_is_the_vertical_fraction() {
    let model = ClosedForm::new([9, 7, 33], 0, |_, _, _| 0.0);
    let param = compute(&model);
    let found = param.lookup(&model, Vec3::new(3.25, 6.0, 8.0));
    assert_eq!((found.i, found.j, found.k), (3.25 / 8.0, 1.0, 0.75));
}

#[test]
fn a_volume_of_one_voxel_has_an_answer() {
    let model = ClosedForm::new([1, 1, 1], 1, |_, _, _| 0.4);
    let found = compute(&model).lookup(&model, Vec3::ZERO);
    assert!(found.i.is_finite() && found.j.is_finite() && found.k.is_finite());
}

#[test]
fn parallel_dipping_layers_follow_the_normals_in_metres() {
    // 35° in a rotated survey with bins of 12.5 × 25 m and samples of 5 m.
    let (sin, cos) = 0.4_f64.sin_cos();
    let metric = DMat3::from_cols(
        DVec3::new(12.5 * cos, 12.5 * sin, 0.0),
        DVec3::new(-25.0 * sin, 25.0 * cos, 0.0),
        DVec3::new(0.0, 0.0, 5.0),
    );
    let dip = 35.0_f64.to_radians().tan() / 5.0;
    let (a, b) = (dip * 12.5 * 0.8, dip * 25.0 * 0.6);
    let plane = |z0: f64| Plane { z0, a, b };
    let depths = [-10.0, 24.0, 50.0];
    let size = [40, 24, 160];
    let model = ClosedForm::new(size, 3, |h, x, y| plane(depths[h]).z(x, y)).with_metric(metric);
    let param = compute(&model);
    let volumes = param.voxel_volumes(&model, size, &Progress::silent()).unwrap();
    let (mut closed, mut open) = (0, 0);
    for x in 0..size[0] {
        for y in 0..size[1] {
            for z in 0..size[2] {
                let p = DVec3::new(x as f64, y as f64, z as f64);
                let layer = volumes.layer.at(x, y, z);
                let (i, j, k) = (volumes.i.at(x, y, z), volumes.j.at(x, y, z), volumes.k.at(x, y, z));
                let below = p.z - plane(0.0).z(p.x, p.y);
                let (reference, expected_k) = match layer {
                    3 => (plane(depths[0]), None),
                    2 => (plane(0.5 * (depths[0] + depths[1])), Some((depths[1] - below) / (depths[1] - depths[0]))),
                    1 => (plane(0.5 * (depths[1] + depths[2])), Some((depths[2] - below) / (depths[2] - depths[1]))),
                    _ => (plane(depths[2]), None),
                };
                let crossing = along_normal(p, reference, metric);
                let (found_x, found_y) = (f64::from(i) * 39.0, f64::from(j) * 23.0);
                assert!(
                    (found_x - crossing.x).abs() < 3e-3 && (found_y - crossing.y).abs() < 3e-3,
                    "layer {layer} at {p}: ({found_x}, {found_y}) instead of {crossing}"
                );
                match expected_k {
                    Some(expected) => {
                        closed += 1;
                        assert!((f64::from(k) - expected).abs() < 2e-5, "layer {layer} at {p}: k {k}, not {expected}");
                    }
                    None => {
                        // Distance in metres over the reference thickness, from the one horizon.
                        open += 1;
                        let grid = param.grid(Region { layer, block: 0 });
                        let k_m = (metric * (p - crossing)).length() / grid.thickness_m.unwrap();
                        let expected = if layer == 3 { k_m } else { 1.0 - k_m };
                        assert!((f64::from(k) - expected).abs() < 2e-5, "layer {layer} at {p}: k {k}, not {expected}");
                        assert!((-1e-5..=1.00001).contains(&k), "the thickness covers the volume: {k} at {p}");
                    }
                }
            }
        }
    }
    assert!(closed > 10_000 && open > 10_000, "{closed} and {open} voxels");
}

/// Two planes that meet in the line (apex_x, apex_z): k depends only on the angle around it.
struct Wedge {
    apex_x: f64,
    apex_z: f64,
    slope: f64,
}

impl Wedge {
    /// The flat bottom and the rising top (z down).
    fn depth(&self, horizon: usize, x: f64) -> f64 {
        if horizon == 0 { self.apex_z - self.slope * (x - self.apex_x) } else { self.apex_z }
    }

    /// k and the voxel x at which the circle around the apex meets the bisector.
    fn truth(&self, x: f64, z: f64) -> (f64, f64) {
        let (u, up) = (x - self.apex_x, self.apex_z - z);
        let opening = self.slope.atan();
        let angle = up.atan2(u);
        let (bottom, top) = (angle.sin(), (opening - angle).sin());
        (bottom / (bottom + top), self.apex_x + u.hypot(up) * (0.5 * opening).cos())
    }
}

#[test]
fn a_wedge_keeps_its_k_up_to_the_pinch_out() {
    for apex_x in [-8.0, 20.3] {
        let wedge = Wedge { apex_x, apex_z: 60.0, slope: 30.0_f64.to_radians().tan() };
        let model = ClosedForm::new([64, 12, 72], 2, |h, x, _| wedge.depth(h, x));
        let param = compute(&model);
        let mut inside = 0;
        for n in 0..4000 {
            let p = Vec3::new((n as f32 * 0.618_034).fract() * 63.0, (n as f32 * 0.754_877).fract() * 11.0, 0.0);
            let thickness = wedge.slope * (f64::from(p.x) - apex_x);
            if thickness < 1.5 {
                continue;
            }
            let p = p.with_z((60.0 - thickness * f64::from((n as f32 * 0.569_84).fract())) as f32);
            let found = param.lookup_in(&model, p, Region { layer: 1, block: 0 }).0;
            let (k, x) = wedge.truth(f64::from(p.x), f64::from(p.z));
            inside += 1;
            let error_x = (f64::from(found.i) * 63.0 - x).abs();
            assert!((f64::from(found.k) - k).abs() < 2e-3, "k at {p}: {} instead of {k}", found.k);
            assert!(error_x < 0.02, "x at {p}: off by {error_x}");
        }
        assert!(inside > 1000);
        // Beyond the edge there is no such layer, and nothing is undefined.
        for grid in &param.grids {
            assert!(grid.offsets.iter().flatten().all(|value| value.is_finite()));
        }
    }
}

#[test]
fn blocks_beside_a_vertical_and_a_dipping_fault_are_exact_up_to_faults_and_the_outer_boundary() {
    // Block 0 | vertical fault at x = 17.4 | block 1 | fault dipping 60° | block 2; dips of 20° to 35° in x
    // and y.
    let planes = |h: usize, block: u16| {
        let (a, b) = [(0.36, 0.0), (-0.3, 0.62), (0.0, -0.7)][usize::from(block)];
        Plane { z0: 24.0 + 22.0 * h as f64 + 5.0 * f64::from(block) - 28.0 * (a + b), a, b }
    };
    let block_at = |p: Vec3| u16::from(p.x > 17.4) + u16::from(p.x - 0.577 * (p.z - 30.0) > 38.0);
    let size = [64, 56, 76];
    let model = ClosedForm::faulted(size, 2, 3, move |h, block, x, y| planes(h, block).z(x, y), block_at);
    let param = compute(&model);
    let volumes = param.voxel_volumes(&model, size, &Progress::silent()).unwrap();
    let mut seen = [0; 3];
    let mut outside = 0;
    for x in 0..size[0] {
        for y in 0..size[1] {
            for z in 0..size[2] {
                if volumes.layer.at(x, y, z) != 1 {
                    continue;
                }
                let block = volumes.block.at(x, y, z);
                let p = DVec3::new(x as f64, y as f64, z as f64);
                let (top, bottom) = (planes(0, block), planes(1, block));
                let crossing = along_normal(p, Plane { z0: 0.5 * (top.z0 + bottom.z0), ..top }, DMat3::IDENTITY);
                let k = (bottom.z(p.x, p.y) - p.z) / 22.0;
                let found = DVec3::new(
                    f64::from(volumes.i.at(x, y, z)) * 63.0,
                    f64::from(volumes.j.at(x, y, z)) * 55.0,
                    f64::from(volumes.k.at(x, y, z)),
                );
                assert!(
                    (found - crossing.truncate().extend(k)).abs().max_element() < 3e-3,
                    "block {block} at {p}: {found}"
                );
                seen[usize::from(block)] += 1;
                outside += usize::from(!(0.0..=63.0).contains(&crossing.x) || !(0.0..=55.0).contains(&crossing.y));
            }
        }
    }
    assert!(seen.iter().all(|&count| count > 1000), "{seen:?}");
    assert!(outside > 500, "near the outer boundary i, j leave [0, 1] instead of being clamped: {outside}");
}

#[test]
fn beds_parallel_to_the_bottom_are_cut_by_an_unconformity() {
    // Beds dip 30°, the layer's top cuts them flat.
    let bed = Plane { z0: 70.0, a: -0.577, b: 0.0 };
    let model = ClosedForm::new([60, 10, 80], 2, |h, x, y| if h == 0 { 30.0 } else { bed.z(x, y) });
    let definitions = vec![KDefinition::DistanceRatio, KDefinition::ParallelToBottom];
    let settings = ParamSettings { definitions, ..Default::default() };
    let param = Parameterization::compute(&model, &settings, &Progress::silent()).unwrap();
    let thickness_m = param.grid(Region { layer: 1, block: 0 }).thickness_m.unwrap();
    for (x, z) in [(5.0, 31.0), (20.0, 45.0), (40.0, 32.5), (33.0, 50.9), (50.0, 40.0)] {
        let p = DVec3::new(x, 4.3, z);
        let foot = along_normal(p, bed, DMat3::IDENTITY);
        let found = param.lookup(&model, p.as_vec3());
        assert_eq!(found.region.layer, 1);
        assert!((f64::from(found.k) - (p - foot).length() / thickness_m).abs() < 1e-4);
        assert!((f64::from(found.i) * 59.0 - foot.x).abs() < 1e-2);
    }
}

#[test]
fn volumes_of_another_size_are_evaluated_where_their_samples_lie() {
    let model = ClosedForm::new([24, 18, 40], 2, |h, x, y| 12.0 + 15.0 * h as f64 + 0.4 * x - 0.2 * y);
    let param = compute(&model);
    let size = [9, 35, 14];
    let volumes = param.voxel_volumes(&model, size, &Progress::silent()).unwrap();
    for (a, b, c) in [(0, 0, 0), (8, 34, 13), (3, 11, 6), (5, 30, 9), (7, 2, 12)] {
        let scaled = |n: usize, samples: usize, voxels: usize| n as f32 * (voxels - 1) as f32 / (samples - 1) as f32;
        let p = Vec3::new(scaled(a, 9, 24), scaled(b, 35, 18), scaled(c, 14, 40));
        let found = param.lookup(&model, p);
        assert_eq!(volumes.layer.at(a, b, c), found.region.layer);
        let volumes = [&volumes.i, &volumes.j, &volumes.k].map(|volume| volume.at(a, b, c));
        for (sampled, looked_up) in volumes.into_iter().zip([found.i, found.j, found.k]) {
            assert!((sampled - looked_up).abs() < 1e-5, "{volumes:?} and {found:?} at {p}");
        }
    }
    assert!(param.voxel_volumes(&model, [4, 0, 4], &Progress::silent()).is_err());
}

#[test]
fn the_jacobian_is_that_of_differences() {
    let model = ClosedForm::new([40, 40, 60], 2, |h, x, y| {
        18.0 + 22.0 * h as f64 + 3.0 * (0.2 * x + 0.1 * h as f64).sin() + 0.2 * y
    });
    let param = compute(&model);
    let region = Region { layer: 1, block: 0 };
    for p in [Vec3::new(12.4, 20.6, 33.3), Vec3::new(30.7, 5.45, 27.1), Vec3::new(3.35, 35.3, 40.2)] {
        let (_, jacobian) = param.lookup_in(&model, p, region);
        for (axis, unit) in [Vec3::X, Vec3::Y, Vec3::Z].into_iter().enumerate() {
            let at = |step: f32| param.lookup_in(&model, p + unit * step, region).0;
            let (high, low) = (at(0.05), at(-0.05));
            let difference = [high.i - low.i, high.j - low.j, high.k - low.k].map(|d| d / 0.1);
            for n in 0..3 {
                let scale = [39.0, 39.0, 22.0][n];
                let error = (jacobian[n][axis] - difference[n]).abs() * scale;
                assert!(error < 0.01, "∂{n}/∂{axis} at {p}: {} and {}", jacobian[n][axis], difference[n]);
            }
        }
    }
}
