//! Counter-based random numbers: the value at a counter depends on seed and counter alone, never on who asks
//! first, so that any number of threads makes the same survey.
//!
//! The mixer is SplitMix64's finaliser (Steele, Lea, Flood 2014, "Fast splittable pseudorandom number
//! generators").

/// Golden-ratio increment of SplitMix64.
const STEP: u64 = 0x9E37_79B9_7F4A_7C15;

/// 64 well-mixed bits for a counter.
fn mix(seed: u64, counter: u64) -> u64 {
    let mut z = seed.wrapping_add(counter.wrapping_add(1).wrapping_mul(STEP));
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

/// A key for one purpose of a seed, so that the draws for one purpose do not shift those for another.
pub(super) fn key(seed: u64, purpose: u64) -> u64 {
    mix(mix(seed, purpose), purpose)
}

/// Zero mean, unit variance, close to normal: the sum of four uniform numbers (16 bits each). Its tails end
/// at ± 3.46, which the filtering of the noise makes up for.
pub(super) fn normal_at(key: u64, counter: u64) -> f32 {
    let bits = mix(key, counter);
    let sum = (bits & 0xFFFF) + ((bits >> 16) & 0xFFFF) + ((bits >> 32) & 0xFFFF) + (bits >> 48);
    // Four uniforms on [0, 1) have mean 2 and variance 4/12.
    (sum as f32 / 65536.0 - 2.0) * 1.732_050_8
}

/// Draws in sequence for the few parameters of the model.
pub(super) struct Draws {
    key: u64,
    counter: u64,
}

impl Draws {
    /// Draws for one purpose of a seed.
    pub(super) fn new(seed: u64, purpose: u64) -> Self {
        Self { key: key(seed, purpose), counter: 0 }
    }

    /// Uniform on [low, high).
    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        let unit = (mix(self.key, self.counter) >> 11) as f64 / (1u64 << 53) as f64;
        self.counter += 1;
        low + (high - low) * unit
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normal_numbers_have_zero_mean_and_unit_variance() {
        let key = key(7, 1);
        let count = 200_000;
        let (mut sum, mut square) = (0.0f64, 0.0f64);
        for counter in 0..count {
            let value = f64::from(normal_at(key, counter));
            sum += value;
            square += value * value;
        }
        let n = count as f64;
        assert!((sum / n).abs() < 0.01, "mean {}", sum / n);
        assert!((square / n - 1.0).abs() < 0.01, "variance {}", square / n);
    }

    #[test]
    fn purposes_of_one_seed_differ() {
        assert_ne!(key(1, 1), key(1, 2));
        assert_ne!(key(1, 1), key(2, 1));
        let (mut a, mut b) = (Draws::new(3, 1), Draws::new(3, 1));
        assert_eq!(a.between(0.0, 1.0), b.between(0.0, 1.0));
        assert_ne!(a.between(0.0, 1.0), b.between(2.0, 3.0));
    }
}
