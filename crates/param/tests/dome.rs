//! Concentric cylinders: k follows from the radii and traces are radial; in open layers k is the distance
//! from the horizon.

mod closed_form;

use closed_form::ClosedForm;
use param::{KDefinition, ParamSettings, Parameterization, Region};
use survey::Progress;

const AXIS_X: f64 = 30.0;
const AXIS_Z: f64 = 80.0;
const RADII: [f64; 2] = [60.0, 40.0];

/// A circle about the axis, continued by its tangent where it is steeper than 58°.
fn arch(radius: f64, x: f64) -> f64 {
    let limit = 0.85 * radius;
    let u = x - AXIS_X;
    let inside = u.clamp(-limit, limit);
    let height = (radius * radius - inside * inside).sqrt();
    AXIS_Z - height + (u - inside) * inside / height
}

#[test]
fn a_dome_is_radial() {
    let size = [61, 9, 60];
    let model = ClosedForm::new(size, 2, |h, x, _| arch(RADII[h], x));
    let settings = ParamSettings { definitions: vec![KDefinition::DistanceRatio; 3], ..Default::default() };
    let param = Parameterization::compute(&model, &settings, &Progress::silent()).unwrap();
    let volumes = param.voxel_volumes(&model, size, &Progress::silent()).unwrap();
    let mut counts = [0; 3];
    let mut worst = [0.0f64; 3];
    for x in 0..size[0] {
        for z in 0..size[2] {
            let layer = volumes.layer.at(x, 4, z);
            let (u, up) = (x as f64 - AXIS_X, AXIS_Z - z as f64);
            let radius = u.hypot(up);
            let thickness_m = param.grid(Region { layer, block: 0 }).thickness_m;
            let (k, reference) = match layer {
                2 => ((radius - RADII[0]) / thickness_m.unwrap(), RADII[0]),
                1 => ((radius - RADII[1]) / (RADII[0] - RADII[1]), 0.5 * (RADII[0] + RADII[1])),
                _ => (1.0 - (RADII[1] - radius) / thickness_m.unwrap(), RADII[1]),
            };
            if layer == 0 && radius < 15.0 {
                continue; // Near the axis all points of the arch are equally far.
            }
            let crossing = AXIS_X + u * reference / radius;
            counts[usize::from(layer)] += 1;
            let error_k = (f64::from(volumes.k.at(x, 4, z)) - k).abs();
            let error_x = (f64::from(volumes.i.at(x, 4, z)) * 60.0 - crossing).abs();
            let error_y = (f64::from(volumes.j.at(x, 4, z)) * 8.0 - 4.0).abs();
            worst[usize::from(layer)] = worst[usize::from(layer)].max(error_x).max(20.0 * error_k);
            assert!(error_k < 2e-4, "k in layer {layer} at {x}, {z}: off by {error_k}");
            assert!(error_x < 0.01 && error_y < 1e-3, "layer {layer} at {x}, {z}: off by {error_x}, {error_y}");
        }
    }
    eprintln!("worst, voxels: {worst:?}");
    assert!(counts.iter().all(|&count| count > 200), "{counts:?}");
}
