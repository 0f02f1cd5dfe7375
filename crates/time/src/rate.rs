//! How fast τ runs down the traces: about 1 through beds that are complete, more where beds are missing. A surface along
//! which it runs fast is an unconformity, or a condensed bed.

use crate::cuts::Cut;
use rayon::prelude::*;
use survey::Volume;

/// Samples to either side over which the rate is taken.
const AROUND: usize = 1;
/// Samples beside a fault in which there is no rate: its two sides are of different ages.
const BESIDE: f32 = 2.0;

/// The rate ∂τ/∂z at every sample, relative to its median over the volume; NaN where τ is not known and beside faults.
///
/// ```
/// use survey::Volume;
/// use time::rates;
///
/// // Ten beds are missing below sample 4.
/// let tau = Volume::from_samples([1, 1, 10], (0..10).map(|z| (z + if z > 4 { 10 } else { 0 }) as f32).collect()).unwrap();
/// let rate = rates(&tau, &[]);
/// assert_eq!(rate.samples()[2], 1.0);
/// assert_eq!(rate.samples()[4], 6.0);
/// ```
pub fn rates(tau: &Volume<f32>, cuts: &[Cut]) -> Volume<f32> {
    let [_, ny, nz] = tau.size();
    let mut rates = Volume::filled(tau.size(), f32::NAN);
    if nz < 2 {
        return rates;
    }
    rates.samples_mut().par_chunks_mut(nz).enumerate().for_each(|(n, out)| {
        let place = [n / ny, n % ny];
        let trace = tau.trace(place[0], place[1]);
        for (z, out) in out.iter_mut().enumerate() {
            let (above, below) = (z.saturating_sub(AROUND), (z + AROUND).min(nz - 1));
            let near = |cut: &Cut| {
                let [a, b] = [z as f32 - BESIDE, z as f32 + BESIDE];
                cut.side(place, z as f32).abs() < 1.0 || cut.separates(place, a, place, b)
            };
            if !cuts.iter().any(near) {
                *out = (trace[below] - trace[above]) / (below - above) as f32;
            }
        }
    });
    let every = (rates.samples().len() >> 20).max(1);
    let mut known: Vec<f32> = rates.samples().iter().step_by(every).copied().filter(|rate| rate.is_finite()).collect();
    known.sort_by(f32::total_cmp);
    let median = known.get(known.len() / 2).copied().filter(|median| *median > 0.0).unwrap_or(1.0);
    rates.samples_mut().par_iter_mut().for_each(|rate| *rate /= median);
    rates
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Across;

    #[test]
    fn a_fault_is_no_unconformity_and_unknown_time_has_no_rate() {
        let samples = (0..4 * 20).map(|n| (n % 20) as f32 + if n % 20 > 9 { 8.0 } else { 0.0 }).collect();
        let mut tau = Volume::from_samples([2, 2, 20], samples).unwrap();
        tau.trace_mut(1, 1).fill(f32::NAN);
        let fast = |rates: &Volume<f32>| rates.samples().iter().filter(|rate| **rate > 2.0).count();
        let all = rates(&tau, &[]);
        assert_eq!(fast(&all), 3 * 2);
        assert!(all.trace(1, 1).iter().all(|rate| rate.is_nan()));
        // A fault that crosses the traces between samples 9 and 10.
        let cut = Cut::new(Across::Inlines, 2, 20, |_, z| if z < 10 { -5.0 } else { 5.0 });
        assert_eq!(fast(&rates(&tau, &[cut])), 0);
    }
}
