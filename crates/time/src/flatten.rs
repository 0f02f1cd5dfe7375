//! A volume with its beds laid flat (a Wheeler diagram): down a trace runs geologic time instead of depth.

use rayon::prelude::*;
use std::cmp::Ordering;
use survey::Volume;

/// Levels a sample above which beds are missing: they were eroded, or never laid down.
const MISSING: usize = 2;
/// Samples to both sides of a step over which that is counted: between reflections τ is less even than it looks.
const AROUND: usize = 1;
/// Samples of τ from which the levels are taken, at most.
const ENOUGH: usize = 1 << 20;

/// Lays the beds of a volume flat. Sample n of the result holds the values along one level of τ. The levels divide the
/// volume into equal shares of rock, so a bed lies at about its mean depth, and a trace through even beds stays as it
/// is. Values are interpolated linearly; NaN where τ is not known, where a level does not reach, and where τ passes more
/// than four levels between two samples, as at an unconformity: beds are missing there.
///
/// `tau` and `volume` have one size. The result takes 4 bytes a voxel.
///
/// ```
/// use survey::Volume;
/// use time::flattened;
///
/// // Layers that dip by a sample a trace: τ = z − x. The amplitude is that of the bed.
/// let of = |f: fn(f32, f32) -> f32| (0..4 * 16).map(|n| f((n / 16) as f32, (n % 16) as f32)).collect();
/// let tau = Volume::from_samples([4, 1, 16], of(|x, z| z - x)).unwrap();
/// let amplitude = Volume::from_samples([4, 1, 16], of(|x, z| (z - x).sin())).unwrap();
/// let flat = flattened(&tau, &amplitude);
/// for n in 4..11 {
///     let along: Vec<f32> = (0..4).map(|x| flat.trace(x, 0)[n]).collect();
///     assert!(along.windows(2).all(|pair| (pair[0] - pair[1]).abs() < 1e-5), "one bed: {along:?}");
/// }
/// ```
pub fn flattened(tau: &Volume<f32>, volume: &Volume<f32>) -> Volume<f32> {
    let [_, ny, nz] = tau.size();
    let levels = even_levels(tau, nz);
    let mut flat = Volume::filled(tau.size(), f32::NAN);
    flat.samples_mut().par_chunks_mut(nz.max(1)).enumerate().for_each(|(n, out)| {
        let (x, y) = (n / ny, n % ny);
        along_levels(tau.trace(x, y), volume.trace(x, y), &levels, out);
    });
    flat
}

/// Values of τ, ascending, that divide the known samples into equal shares.
fn even_levels(tau: &Volume<f32>, count: usize) -> Vec<f32> {
    let every = tau.samples().len().div_ceil(ENOUGH).max(1);
    let mut known: Vec<f32> = tau.samples().iter().step_by(every).copied().filter(|time| time.is_finite()).collect();
    known.par_sort_unstable_by(f32::total_cmp);
    if known.is_empty() {
        return Vec::new();
    }
    let share = |n: usize| (n as f64 + 0.5) / count as f64 * known.len() as f64 - 0.5;
    let level = |n: usize| {
        let at = share(n).clamp(0.0, (known.len() - 1) as f64);
        let (low, part) = (known[at as usize], at.fract() as f32);
        low + (known[(at as usize + 1).min(known.len() - 1)] - low) * part
    };
    (0..count).map(level).collect()
}

/// Fills one flattened trace. Where τ decreases, at a reverse fault, the upper place of a level counts.
fn along_levels(tau: &[f32], values: &[f32], levels: &[f32], out: &mut [f32]) {
    for z in 1..tau.len() {
        let [above, below] = [tau[z - 1], tau[z]];
        if above.partial_cmp(&below) != Some(Ordering::Less) {
            continue;
        }
        let between = |above: f32, below: f32| {
            levels.partition_point(|level| *level < above)..levels.partition_point(|level| *level <= below)
        };
        let around = [(z - 1).saturating_sub(AROUND), (z + AROUND).min(tau.len() - 1)];
        if between(tau[around[0]], tau[around[1]]).len() > MISSING * (around[1] - around[0]) {
            continue;
        }
        let passed = between(above, below);
        for (level, out) in levels[passed.clone()].iter().zip(&mut out[passed]).filter(|(_, out)| out.is_nan()) {
            let part = (level - above) / (below - above);
            *out = values[z - 1] + (values[z] - values[z - 1]) * part;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn volume(size: [usize; 3], f: impl Fn(usize, usize) -> f32) -> Volume<f32> {
        let [nx, ny, nz] = size;
        Volume::from_samples(size, (0..nx * ny * nz).map(|n| f(n / nz / ny, n % nz)).collect()).unwrap()
    }

    #[test]
    fn even_beds_stay_where_they_are() {
        let tau = volume([5, 3, 40], |_, z| 7.0 + 3.0 * z as f32);
        let amplitude = volume([5, 3, 40], |x, z| (x * 100 + z) as f32);
        let flat = flattened(&tau, &amplitude);
        for (found, expected) in flat.samples().iter().zip(amplitude.samples()) {
            assert!((found - expected).abs() < 0.51, "{found} {expected}");
        }
    }

    #[test]
    fn beds_that_are_missing_stay_empty_and_so_does_what_is_not_known() {
        // Below sample 20 the traces from 6 on lack 12 levels of time.
        let time = |x: usize, z: usize| z as f32 + if x >= 6 && z >= 20 { 12.0 } else { 0.0 };
        let tau = volume([12, 1, 60], |x, z| if x == 3 && z > 50 { f32::NAN } else { time(x, z) });
        let flat = flattened(&tau, &volume([12, 1, 60], time));
        let is_missing = |n: &usize| (20.0..31.0).contains(&flat.trace(0, 0)[*n]);
        let missing: Vec<usize> = (0..60).filter(is_missing).collect();
        assert!(missing.len() > 4, "{missing:?}");
        assert!(missing.iter().all(|n| flat.trace(8, 0)[*n].is_nan()));
        let unknown = |x: usize| flat.trace(x, 0).iter().filter(|value| value.is_nan()).count();
        assert!(unknown(3) > unknown(0));
        // What is there lies at one level on all traces.
        for n in 0..60 {
            let along: Vec<f32> = (0..12).map(|x| flat.trace(x, 0)[n]).filter(|value| value.is_finite()).collect();
            assert!(along.windows(2).all(|pair| (pair[0] - pair[1]).abs() < 1e-3), "level {n}: {along:?}");
        }
    }

    #[test]
    fn an_unknown_time_and_a_constant_one_are_no_beds() {
        for time in [f32::NAN, 4.0] {
            let flat = flattened(&volume([2, 2, 9], |_, _| time), &volume([2, 2, 9], |_, z| z as f32));
            assert!(flat.samples().iter().all(|value| value.is_nan()), "{time}");
        }
    }
}
