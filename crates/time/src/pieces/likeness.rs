//! How alike both sides of a seam are, as they are and shifted.

use super::grid::Grid;
use crate::event::Event;
use crate::solve::interpolate;
use survey::Volume;

/// Pairs of neighbouring nodes on both sides of a seam.
pub(super) type Pairs = Vec<[u32; 2]>;

/// Traces next to a seam that are left out, since beds are dragged there and patches end, and those that are stacked then.
const SKIPPED: usize = 1;
const STACKED: usize = 4;
/// Half the window of a comparison, samples.
const HALF_WINDOW: usize = 24;
/// Greatest shift of a rival, samples, and the least that is another reflection.
const MOST_SHIFT: usize = 20;
const SAME: usize = 3;
/// Lines of a seam that are compared at most, spread over it.
const MOST_LINES: usize = 64;
/// Least share of a window that must lie inside the volume.
const LEAST_OVERLAP: f32 = 0.5;
/// Half the period of the reflections around an event: the shift under which its traces, flattened on it, are least alike.
pub(super) fn half_period(event: &Event, volume: &Volume<f32>) -> f32 {
    const AROUND: isize = HALF_WINDOW as isize;
    let step = (event.nodes.len() / 2000).max(1);
    let mut sums = [0.0f64; MOST_SHIFT + 1];
    for node in event.nodes.iter().step_by(step) {
        let trace = volume.trace(usize::from(node.x), usize::from(node.y));
        let last = (trace.len() - 1) as f32;
        let at = |d: isize| {
            let z = node.z + d as f32;
            if z >= 0.0 && z <= last { interpolate(trace, z) } else { 0.0 }
        };
        let window: Vec<f32> = (-AROUND..=AROUND).map(at).collect();
        let energy: f32 = window.iter().map(|a| a * a).sum();
        if energy > 0.0 && energy.is_finite() {
            for (lag, sum) in sums.iter_mut().enumerate() {
                let product: f32 = window.iter().zip(&window[lag..]).map(|(a, b)| a * b).sum();
                *sum += f64::from(product / energy);
            }
        }
    }
    let least = (2..MOST_SHIFT).find(|&lag| sums[lag] <= sums[lag - 1] && sums[lag] < sums[lag + 1]);
    least.unwrap_or(SAME).max(SAME) as f32
}

/// The correlation of both sides of a seam as they are, and under the best other shift.
pub(super) fn correlations(grid: &Grid<'_>, of: &[u32], pairs: &[[u32; 2]], volume: &Volume<f32>) -> [f32; 2] {
    const REACH: usize = HALF_WINDOW + MOST_SHIFT / 2;
    let step = pairs.len().div_ceil(MOST_LINES).max(1);
    // For each shift Σ ab, Σ a², Σ b², and how many samples there are, in half samples of depth.
    let mut sums = vec![[0.0f32; 4]; 2 * MOST_SHIFT + 1];
    for &[a, b] in pairs.iter().step_by(step) {
        let axis = usize::from(grid.trace(a as usize)[0] == grid.trace(b as usize)[0]);
        let sign: isize = if grid.trace(a as usize)[axis] < grid.trace(b as usize)[axis] { -1 } else { 1 };
        let (Some(a), Some(b)) =
            (stack(grid, of, a as usize, axis, sign, volume), stack(grid, of, b as usize, axis, -sign, volume))
        else {
            continue;
        };
        for (n, sums) in sums.iter_mut().enumerate() {
            let shift = n as isize - MOST_SHIFT as isize;
            // Half shifts fall between samples every second time.
            let (low, high) = (shift.div_euclid(2), shift - shift.div_euclid(2));
            for d in -(HALF_WINDOW as isize)..=HALF_WINDOW as isize {
                let at = |side: &[f32], d: isize| side[(d + REACH as isize + 1) as usize];
                let (a, b) = (at(&a, d - low), at(&b, d + high));
                if a.is_finite() && b.is_finite() {
                    *sums = [sums[0] + a * b, sums[1] + a * a, sums[2] + b * b, sums[3] + 1.0];
                }
            }
        }
    }
    let most = sums[MOST_SHIFT][3];
    let correlation = |[product, a, b, count]: [f32; 4]| {
        if count > 0.0 && count >= LEAST_OVERLAP * most { product / (a * b).sqrt().max(1e-9) } else { 0.0 }
    };
    let at = |n: usize| correlation(sums[n]);
    let own = (MOST_SHIFT - 1..=MOST_SHIFT + 1).map(at).fold(0.0, f32::max);
    let rival = (0..sums.len()).filter(|n| n.abs_diff(MOST_SHIFT) >= SAME).map(at).fold(0.0, f32::max);
    [own, rival]
}

/// Amplitudes around an event on one side of a seam, stacked on it and brought to one level; NaN outside the volume.
fn stack(grid: &Grid<'_>, of: &[u32], from: usize, axis: usize, sign: isize, volume: &Volume<f32>) -> Option<Vec<f32>> {
    const REACH: isize = (HALF_WINDOW + MOST_SHIFT / 2 + 1) as isize;
    let mut all = vec![0.0f32; 2 * REACH as usize + 1];
    let (mut node, mut count) = (from, 0);
    for n in 0..SKIPPED + STACKED {
        if n >= SKIPPED {
            let [x, y] = grid.trace(node);
            let (trace, z) = (volume.trace(x, y), grid.nodes[node].z);
            let last = (trace.len() - 1) as f32;
            for (sum, d) in all.iter_mut().zip(-REACH..=REACH) {
                let z = z + d as f32;
                *sum += if z >= 0.0 && z <= last { interpolate(trace, z) } else { f32::NAN };
            }
            count += 1;
        }
        match grid.beside(node, axis, sign, grid.nodes[node].z).filter(|next| of[*next] == of[from]) {
            Some(next) => node = next,
            None => break,
        }
    }
    let energy: f32 = all.iter().filter(|a| a.is_finite()).map(|a| a * a).sum();
    if count == 0 || energy <= 0.0 {
        return None;
    }
    all.iter_mut().for_each(|a| *a /= energy.sqrt());
    Some(all)
}
