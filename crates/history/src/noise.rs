//! Smooth waves out of a seed: the same for the same seed, on every machine.

use glam::DVec2;

/// A well-mixed number for a key (splitmix64).
pub(crate) fn mixed(key: u64) -> u64 {
    let mut z = key.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// A number in [0, 1) for a key.
pub(crate) fn unit(key: u64) -> f64 {
    (mixed(key) >> 11) as f64 / (1u64 << 53) as f64
}

/// A surface of waves of many directions.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Waves {
    /// Wave number, 1/m as a vector, phase and share of the height of each.
    waves: Vec<(DVec2, f64, f64)>,
}

impl Waves {
    /// Of a typical wavelength, from whole to an eighth of it; higher waves are the longer ones.
    pub(crate) fn new(seed: u64, wavelength: f64) -> Self {
        const OCTAVES: usize = 4;
        const DIRECTIONS: usize = 5;
        let wave = |n: usize| {
            let (octave, way) = (n / DIRECTIONS, n % DIRECTIONS);
            let draw = |k: u64| unit(mixed(seed).wrapping_add(mixed((n as u64) << 8 | k)));
            let angle = std::f64::consts::TAU * (way as f64 + draw(0)) / DIRECTIONS as f64;
            let number = std::f64::consts::TAU / wavelength * 2f64.powi(octave as i32) * (0.75 + 0.5 * draw(1));
            (DVec2::from_angle(angle) * number, std::f64::consts::TAU * draw(2), 0.5f64.powi(octave as i32))
        };
        let waves: Vec<_> = (0..OCTAVES * DIRECTIONS).map(wave).collect();
        // So that the root of the mean square is about a half, and hardly anything is beyond 1.
        let square: f64 = waves.iter().map(|(.., share)| 0.5 * share * share).sum();
        let scale = 0.45 / square.sqrt();
        Self { waves: waves.into_iter().map(|(number, phase, share)| (number, phase, share * scale)).collect() }
    }

    /// The height at a place, hardly ever outside [-1, 1].
    pub(crate) fn at(&self, p: DVec2) -> f64 {
        self.waves.iter().map(|(number, phase, share)| share * (number.dot(p) + phase).sin()).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_seed_gives_one_surface_and_another_seed_another() {
        let [one, same, other] = [3, 3, 4].map(|seed| Waves::new(seed, 500.0));
        let places = (0..400).map(|n| DVec2::new(37.0 * n as f64, 91.0 * (n % 17) as f64));
        let heights: Vec<f64> = places.clone().map(|p| one.at(p)).collect();
        assert!(heights.iter().zip(places.clone()).all(|(height, p)| *height == same.at(p)));
        assert!(heights.iter().zip(places).any(|(height, p)| (height - other.at(p)).abs() > 0.5));
        assert!(heights.iter().all(|height| height.abs() < 1.8));
        let mean = heights.iter().sum::<f64>() / 400.0;
        assert!(mean.abs() < 0.2, "{mean}");
    }
}
