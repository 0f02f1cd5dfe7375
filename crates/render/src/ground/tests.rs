//! Bundles of rays that pass the air together, beside short steps along each ray.

use super::*;
use crate::Ground;
use model::ModelSettings;
use survey::Progress;
use synth::{SynthSettings, Synthetic};

#[test]
fn no_ray_of_a_bundle_meets_rock_while_the_way_is_clear() {
    let (settings, quiet) = (SynthSettings { size: [40, 36, 48], ..SynthSettings::default() }, Progress::silent());
    let s = Synthetic::generate(&settings, &quiet).unwrap();
    let model =
        StructuralModel::build(&s.geometry, &s.stratigraphy, &s.horizons, &s.faults, &ModelSettings::default(), &quiet)
            .unwrap();
    let relief = Relief::new(&Ground::default(), &Scene::default(), &s.geometry, &model);
    let high = Vec3::new(39.0, 35.0, 47.0);
    let inside = |p: Vec3| p.cmpge(Vec3::ZERO).all() && p.cmple(high).all();
    let (mut cleared, mut free) = (0.0, 0.0);
    for n in 0..300 {
        let turn = n as f32 * 0.7;
        let direction = Vec3::new(turn.cos(), turn.sin(), 0.15 + 0.9 * (n % 7) as f32 / 7.0).normalize();
        let middle = Vec3::new(high.x * (n % 23) as f32 / 23.0, high.y * (n % 19) as f32 / 19.0, 0.0);
        let width = [0.05, 0.4, 1.2][n % 3];
        let rays: Vec<Ray> = (0..9)
            .map(|r| Vec3::new((r % 3) as f32 - 1.0, (r / 3) as f32 - 1.0, 0.0) * width)
            .map(|offset| Ray { origin: middle + offset, direction: (direction + offset * 0.01).normalize() })
            .collect();
        let is_rock = |ray: &Ray, t: f32| inside(ray.at(t)) && !relief.is_air(&model, ray.at(t));
        if rays.iter().any(|ray| is_rock(ray, 0.0)) {
            continue;
        }
        let exit = (0..).map(|s| s as f32 * 0.02).find(|&t| !inside(rays[4].at(t))).unwrap();
        let clear = relief.clear_until(&model, &rays, [0.0, exit]);
        let met = |ray: &Ray| (0..).map(|s| s as f32 * 0.02).find(|&t| t > exit || is_rock(ray, t)).unwrap();
        let first = rays.iter().map(met).fold(exit, f32::min);
        assert!(first >= clear, "bundle {n} of width {width}: rock at {first}, clear until {clear}");
        cleared += clear;
        free += first;
    }
    assert!(cleared > 0.5 * free, "{cleared} of {free} voxels of air");
}
