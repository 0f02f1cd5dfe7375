//! Isotonic regression: the non-decreasing sequence that is closest to given values.
//!
//! `minimise Σ wᵢ (yᵢ − xᵢ)²  subject to  y₀ ≤ y₁ ≤ …`
//!
//! by pooling adjacent violators (M. Ayer and others, "An empirical distribution function for sampling with incomplete
//! information", Annals of Mathematical Statistics 26, 1955): neighbouring means that decrease are pooled until none do.
//! Linear in the count of values.

/// Reusable memory of [`regress`].
#[derive(Debug, Default)]
pub struct Pools {
    /// Mean, weight and count of values of each pool.
    pools: Vec<(f64, f64, usize)>,
}

/// Replaces `values` by their isotonic regression with positive `weights`; returns how many values changed by more
/// than 1e-4.
///
/// ```
/// use time::isotonic::{Pools, regress};
///
/// let mut values = [1.0, 4.0, 2.0, 5.0];
/// assert_eq!(regress(&mut values, |_| 1.0, &mut Pools::default()), 2);
/// assert_eq!(values, [1.0, 3.0, 3.0, 5.0]);
/// ```
pub fn regress(values: &mut [f32], weights: impl Fn(usize) -> f32, scratch: &mut Pools) -> usize {
    let pools = &mut scratch.pools;
    pools.clear();
    for (n, &value) in values.iter().enumerate() {
        let mut pool = (f64::from(value), f64::from(weights(n)), 1);
        while let Some(&(mean, weight, count)) = pools.last() {
            if mean <= pool.0 {
                break;
            }
            let sum = weight + pool.1;
            pool = ((mean * weight + pool.0 * pool.1) / sum, sum, count + pool.2);
            pools.pop();
        }
        pools.push(pool);
    }
    let (mut at, mut changed) = (0, 0);
    for &(mean, _, count) in pools.iter() {
        for value in &mut values[at..at + count] {
            changed += usize::from((*value - mean as f32).abs() > 1e-4);
            *value = mean as f32;
        }
        at += count;
    }
    changed
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The regression by its min–max formula: yᵢ = max over a ≤ i of min over b ≥ i of mean(x[a..=b]).
    fn brute_force(values: &[f32], weights: &[f32]) -> Vec<f64> {
        let mean = |a: usize, b: usize| {
            let sum: f64 = (a..=b).map(|n| f64::from(values[n]) * f64::from(weights[n])).sum();
            sum / (a..=b).map(|n| f64::from(weights[n])).sum::<f64>()
        };
        let least = |a: usize, i: usize| (i..values.len()).map(|b| mean(a, b)).fold(f64::INFINITY, f64::min);
        (0..values.len()).map(|i| (0..=i).map(|a| least(a, i)).fold(f64::NEG_INFINITY, f64::max)).collect()
    }

    #[test]
    fn it_is_the_min_max_formula() {
        let mut state = 1u32;
        let mut draw = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as f32 / (1 << 24) as f32
        };
        for length in [1, 2, 7, 40] {
            let values: Vec<f32> = (0..length).map(|n| 0.1 * n as f32 + 2.0 * draw()).collect();
            let weights: Vec<f32> = (0..length).map(|_| 0.2 + draw()).collect();
            let mut found = values.clone();
            regress(&mut found, |n| weights[n], &mut Pools::default());
            for (a, b) in found.iter().zip(brute_force(&values, &weights)) {
                assert!((f64::from(*a) - b).abs() < 1e-5, "{a} {b}");
            }
            assert!(found.windows(2).all(|pair| pair[0] <= pair[1]));
        }
    }
}
