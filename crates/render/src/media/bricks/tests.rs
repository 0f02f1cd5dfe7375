//! Empty bricks.

use super::*;
use model::ModelSettings;
use survey::Progress;
use synth::{SynthSettings, Synthetic};

#[test]
fn distances_are_those_of_a_search() {
    let samples = [81, 57, 97];
    let is_marked = |[x, y, z]: [usize; 3]| (x * 31 + y * 17 + z * 7) % 97 == 5 && x < 6;
    let bricks = Bricks::new(samples, |b| BrickContent { shows: [is_marked(b), false], layer: 3 });
    let [nx, ny, nz] = bricks.size;
    let all: Vec<[usize; 3]> = (0..nx * ny * nz).map(|n| [n / (ny * nz), n / nz % ny, n % nz]).collect();
    for &b in &all {
        let to = |m: &[usize; 3]| (0..3).map(|a| m[a].abs_diff(b[a])).max().unwrap_or(0);
        let nearest = all.iter().filter(|m| is_marked(**m)).map(to).min().unwrap();
        let word = bricks.word(b.map(|n| n as i32));
        assert_eq!((word & 255) as usize, nearest.min(usize::from(FARTHEST)), "{b:?}");
        assert_eq!((word >> 8 & 255, word >> 16), (u32::from(FARTHEST), 3));
    }
}

#[test]
fn a_brick_of_one_layer_is_of_that_layer() {
    let quiet = Progress::silent();
    let s = Synthetic::generate(&SynthSettings { size: [48, 40, 64], ..SynthSettings::default() }, &quiet).unwrap();
    let settings = ModelSettings::default();
    let model =
        StructuralModel::build(&s.geometry, &s.stratigraphy, &s.horizons, &s.faults, &settings, &quiet).unwrap();
    let map = LayerMap::new(&model);
    let (mut uniform, mut bricks) = (0, 0);
    for bx in 0..6 {
        for by in 0..5 {
            for bz in 0..8 {
                bricks += 1;
                let layer = map.layer([bx, by, bz]);
                if layer == MIXED {
                    continue;
                }
                uniform += 1;
                let [low, high] = Bricks::corners([bx, by, bz]);
                for n in 0..125 {
                    let f = Vec3::new((n % 5) as f32, (n / 5 % 5) as f32, (n / 25) as f32) / 4.0;
                    let p = (low + (high - low) * f).min(Vec3::new(47.0, 39.0, 63.0));
                    assert_eq!(model.region_at(p).layer, u16::from(layer), "{p}");
                }
            }
        }
    }
    assert!(uniform * 40 > bricks, "{uniform} of {bricks}");
}
