//! Samples along a ray.

use super::*;
use crate::{NamedVolume, VoxelBox};
use survey::Volume;

/// Numbers in [0, 1) without a pattern.
fn noise(n: usize) -> f32 {
    let mut hash = n as u32 ^ 0x9e37_79b9;
    for _ in 0..2 {
        hash = (hash ^ hash >> 16).wrapping_mul(0x045d_9f3b);
    }
    (hash >> 8) as f32 / (1 << 24) as f32
}

#[test]
fn numbers_are_rounded_down() {
    for n in 0..4000 {
        let number = if n % 3 == 0 { n as f32 } else { noise(n) * 4e6 };
        assert_eq!(whole(number), (number.floor(), number as u32), "{number}");
    }
}

/// Compared with the volume's own interpolation, inside and outside, with some samples missing.
#[test]
fn values_are_those_of_the_volume() {
    for size in [[9, 7, 12], [2, 2, 2], [1, 5, 3], [4, 1, 6], [5, 4, 1], [1, 1, 1]] {
        let count: usize = size.iter().product();
        let all: Vec<f32> = (0..count).map(|n| noise(n) * 4.0 - 2.0).collect();
        let mut volume = Volume::from_samples(size, all).unwrap();
        if count > 100 {
            volume.samples_mut()[37] = f32::NAN;
            volume.samples_mut()[91] = f32::INFINITY;
        }
        let covers = VoxelBox { min: [0.0; 3], max: size.map(|n| n.max(2) as f64 - 1.0) };
        let named = NamedVolume { name: "v", volume: crate::Samples::Whole(&volume), covers };
        let patched: Vec<f32> = volume.samples().iter().map(|v| if v.is_finite() { *v } else { NO_DATA }).collect();
        let samples = VolumeSamples::new(&patched, size);
        let (mut missing, mut places, mut expected) = (0, IndexPositions::default(), [0.0; BATCH]);
        for n in 0..40 * BATCH {
            let place = |axis: usize| (size[axis] as f32 + 1.0) * noise(3 * n + axis) - 1.0;
            let (p, lane) = (Vec3::new(place(0), place(1), place(2)), n % BATCH);
            // An axis with one sample has one position.
            let p = Vec3::from_array([0, 1, 2].map(|a| if size[a] == 1 { 0.0 } else { p[a] }));
            let (value, by_volume) = (samples.value(p), named.sample(p));
            missing += usize::from(by_volume.is_nan());
            match by_volume.is_nan() {
                true => assert!(value < NO_DATA_BELOW, "{size:?} {p} {value}"),
                false => assert!((value - by_volume).abs() < 1e-4, "{size:?} {p} {value} {by_volume}"),
            }
            (0..3).for_each(|axis| places.axes[axis][lane] = p[axis]);
            expected[lane] = value;
            if lane + 1 == BATCH {
                let mut values = [0.0; BATCH];
                samples.values(&places, BATCH, &mut values);
                assert!(values == expected, "{size:?}");
            }
        }
        assert!(missing > 0 || count == 1);
    }
}

#[test]
fn differences_are_those_of_values_ahead_and_behind() {
    let size = [8, 9, 10];
    let mut all: Vec<f32> = (0..720).map(noise).collect();
    all[345] = NO_DATA;
    let samples = VolumeSamples::new(&all, size);
    for n in 0..3000 {
        let place = |axis: usize| (size[axis] as f32 - 1.0) * noise(7 * n + axis);
        let p = Vec3::new(place(0), place(1), place(2));
        let along = |axis: Vec3| difference(samples.value(p + axis), samples.value(p - axis));
        let expected = Vec3::new(along(Vec3::X), along(Vec3::Y), along(Vec3::Z));
        assert!((samples.differences(p) - expected).abs().max_element() < 1e-5, "{p}");
    }
}
