//! The published method on layered and on degenerate volumes.

use super::*;
use candidates::grow::grow_slabs_by;
use candidates::{Forest, ForestSettings};
use survey::Volume;

/// Reflectors of alternating polarity every `spacing` samples, at depth(x, y) + n·spacing.
fn layered(size: [usize; 3], spacing: f32, depth: impl Fn(usize, usize) -> f32) -> Volume<f32> {
    let mut volume = Volume::filled(size, 0.0f32);
    for (x, y) in (0..size[0]).flat_map(|x| (0..size[1]).map(move |y| (x, y))) {
        for (z, value) in volume.trace_mut(x, y).iter_mut().enumerate() {
            *value = 1000.0 * (std::f32::consts::PI * (z as f32 - depth(x, y)) / spacing).cos();
        }
    }
    volume
}

/// The surfaces of a volume, of which trees can be built: their arrays agree.
fn grown(volume: &Volume<f32>) -> Surfaces {
    let settings = GrowSettings { method: Method::Paper, ..GrowSettings::default() };
    let surfaces = grow_slabs_by(method(settings.method), volume, &settings, &Progress::silent()).unwrap();
    Forest::build(surfaces.clone(), &ForestSettings::default(), &Progress::silent()).unwrap();
    surfaces
}

#[test]
fn gently_dipping_layers_make_surfaces_of_every_trace() {
    let depth = |x: usize, y: usize| 15.0 + 0.4 * x as f32 - 0.2 * y as f32;
    let surfaces = grown(&layered([24, 20, 64], 10.0, depth));
    let whole: Vec<_> = surfaces.surfaces.iter().filter(|s| s.vertices.len() == 24 * 20).collect();
    assert!(whole.len() >= 3, "{}", whole.len());
    assert!(whole.iter().all(|s| s.triangles.len() == 2 * 23 * 19));
    for v in &surfaces.vertices {
        let layers = (v.z - depth(v.x.into(), v.y.into())) / 10.0;
        assert!((layers - layers.round()).abs() < 2e-3);
    }
}

#[test]
fn steep_layers_fall_apart() {
    // 2.5 samples a trace are more than two extrema that touch may differ by.
    let surfaces = grown(&layered([24, 20, 96], 10.0, |x, _| 15.0 + 2.5 * x as f32));
    assert!(surfaces.surfaces.iter().all(|s| s.vertices.len() < 24 * 20));
}

#[test]
fn bad_volumes_have_defined_results() {
    let mut dead = layered([12, 12, 30], 8.0, |_, _| 12.0);
    dead.set_live(Some(vec![false; 144])).unwrap();
    let nothing = [Volume::filled([12, 12, 30], f32::NAN), Volume::filled([0, 0, 0], 1.0), dead];
    assert!(nothing.iter().all(|volume| grown(volume).surfaces.is_empty()));
    grown(&layered([1, 40, 64], 8.0, |_, _| 12.0));
    grown(&layered([3, 40, 64], 8.0, |_, _| 12.0));
}
