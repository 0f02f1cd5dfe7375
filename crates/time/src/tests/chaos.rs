//! Chaotic volumes: time is known where reflections continue, and nowhere else.

use super::{beds, time_of, time_with};
use crate::{Interpretation, Jump, KnownHorizon, Place};
use survey::Volume;

/// Noise that is as smooth along traces as reflections are, and `lateral` traces wide.
fn chaos(size: [usize; 3], lateral: usize) -> Volume<f32> {
    let mut state = 0x9E37_79B9_7F4A_7C15u64;
    let mut volume = Volume::filled(size, 0.0f32);
    for sample in volume.samples_mut() {
        state = state.wrapping_mul(0x5851_F42D_4C95_7F2D).wrapping_add(0x1405_7B7E_F767_814F);
        *sample = (state >> 40) as f32 / (1 << 23) as f32 - 1.0;
    }
    let [nx, ny, nz] = size;
    let rough = volume.clone();
    for (n, sample) in volume.samples_mut().iter_mut().enumerate() {
        let (x, y, z) = (n / nz / ny, n / nz % ny, n % nz);
        let around = |c: usize, reach: usize, size: usize| c.saturating_sub(reach)..(c + reach + 1).min(size);
        *sample = 0.0;
        for (x, y) in around(x, lateral, nx).flat_map(|x| around(y, lateral, ny).map(move |y| (x, y))) {
            *sample += around(z, 2, nz).map(|z| rough.at(x, y, z)).sum::<f32>();
        }
    }
    volume
}

#[test]
fn noise_has_no_time() {
    for lateral in [0, 1] {
        let found = time_of(&chaos([64, 64, 96], lateral), &[]);
        assert!(found.known < 0.05, "{} of noise that is {lateral} traces wide", found.known);
    }
}

#[test]
fn beds_beside_noise_keep_their_time() {
    let size = [72, 48, 96];
    let mut volume = chaos(size, 0);
    for (x, y) in (0..36).flat_map(|x| (0..48).map(move |y| (x, y))) {
        for (z, sample) in volume.trace_mut(x, y).iter_mut().enumerate() {
            *sample = beds(z as f32 - 0.3 * x as f32) + 0.3 * *sample;
        }
    }
    let tau = time_of(&volume, &[]).tau;
    let share = |inlines: std::ops::Range<usize>| {
        let (mut known, mut all) = (0, 0);
        for (x, y) in inlines.flat_map(|x| (0..48).map(move |y| (x, y))) {
            known += tau.trace(x, y).iter().filter(|time| time.is_finite()).count();
            all += 96;
        }
        known as f32 / all as f32
    };
    let [beds, noise] = [share(0..34), share(48..72)];
    assert!(beds > 0.95 && noise < 0.05, "{beds} of the beds, {noise} of the noise");
}

#[test]
fn a_picked_horizon_has_its_time_in_chaos_too() {
    let traces = (0..40).flat_map(|x| (0..40).map(move |y| [x, y]));
    let nodes = traces.map(|trace| Place { trace, z: 48.0 }).collect();
    let horizons = vec![KnownHorizon { nodes, jump: Jump::None }];
    let told = Interpretation { horizons, ..Interpretation::default() };
    let tau = time_with(&chaos([40, 40, 96], 0), &told).tau;
    assert!(tau.at(20, 20, 48).is_finite() && tau.at(20, 20, 40).is_finite());
    assert!(tau.at(20, 20, 80).is_nan());
}
