//! Growing on two real surveys: F3's salt dome (its samples clipped, reflectors of very different strength)
//! and Penobscot's faulted Horizon B.

use super::{GrowSettings, grow_surfaces};
use crate::surfaces::{Surface, Surfaces};
use files::segy::SegyOptions;
use std::collections::HashMap;
use std::path::Path;
use survey::{Progress, Volume};

fn grown(file: &Path) -> (Volume<f32>, Surfaces) {
    let volume = files::segy::read(file, &SegyOptions::default(), &Progress::silent()).unwrap().volume;
    let surfaces = grow_surfaces(&volume, &GrowSettings::default(), &Progress::silent()).unwrap();
    (volume, surfaces)
}

/// Vertices per trace of a surface.
fn layers(surfaces: &Surfaces, surface: &Surface) -> f64 {
    let vertices = &surfaces.vertices[surface.vertices.start as usize..surface.vertices.end as usize];
    let mut traces: Vec<_> = vertices.iter().map(|v| (v.x, v.y)).collect();
    traces.dedup();
    vertices.len() as f64 / traces.len() as f64
}

#[test]
fn surfaces_around_a_salt_dome_follow_strong_reflectors_and_not_one_another() {
    let Some(data) = testdata::folder() else { return };
    let (volume, surfaces) = grown(&data.join("volumes/f3_depth_il300-427_xl720-975_int16.sgy"));
    let (mut layered, mut strong) = (0, 0);
    for surface in &surfaces.surfaces {
        let single = layers(&surfaces, surface) < 1.1;
        for v in &surfaces.vertices[surface.vertices.start as usize..surface.vertices.end as usize] {
            layered += usize::from(!single);
            let amplitude = volume.trace(v.x.into(), v.y.into())[v.z.round() as usize];
            strong += usize::from(single && surface.vertices.len() >= 500 && amplitude.abs() >= 20_000.0);
        }
    }
    let share = layered as f64 / surfaces.vertices.len() as f64;
    assert!(share < 0.12, "{share:.3} of the nodes in surfaces that lie over themselves");
    // 270 864 extrema are that strong.
    assert!(strong > 150_000, "{strong} strong extrema on large surfaces");
}

#[test]
fn four_surfaces_are_worth_nearly_half_of_a_faulted_horizon() {
    let Some(data) = testdata::folder() else { return };
    let (_, surfaces) = grown(&data.join("volumes/penobscot_il1207-1456_xl1253-1402_t876-1032_int16.sgy"));
    let truth =
        std::fs::read_to_string(data.join("interpretation/penobscot_horizon_B/truth_il_xl_x_y_twt.csv")).unwrap();
    let truth: HashMap<[u16; 2], f32> = truth
        .lines()
        .skip(1)
        .map(|line| {
            let fields: Vec<f64> = line.split(',').map(|field| field.parse().unwrap()).collect();
            ([(fields[0] - 1207.0) as u16, (fields[1] - 1253.0) as u16], ((fields[4] - 876.0) / 4.0) as f32)
        })
        .filter(|(_, z)| *z < 38.0)
        .collect();
    // Traces on which a surface lies on the horizon, weighted by the share of the surface that does.
    let mut worth: Vec<f64> = surfaces
        .surfaces
        .iter()
        .map(|surface| {
            let vertices = &surfaces.vertices[surface.vertices.start as usize..surface.vertices.end as usize];
            let on = vertices.iter().filter(|v| truth.get(&[v.x, v.y]).is_some_and(|z| (z - v.z).abs() < 1.0)).count();
            on as f64 * on as f64 / vertices.len() as f64
        })
        .collect();
    worth.sort_unstable_by(|a, b| b.total_cmp(a));
    let covered = worth.iter().take(4).sum::<f64>() / truth.len() as f64;
    assert!(covered > 0.45, "the best four surfaces are worth {covered:.3} of the horizon");
}
