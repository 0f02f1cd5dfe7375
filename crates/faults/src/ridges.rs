//! Ridges of the likelihood: where it is greatest across its own strike.

use attribute::Likelihood;
use attribute::likelihood::{Plane, ROW};
use rayon::prelude::*;

/// Least likelihood of a ridge.
const LEAST: f32 = 0.3;

/// A place on a ridge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Ridge {
    /// Fractional lines and the sample.
    pub(crate) at: [f32; 3],
    /// The plane of greatest likelihood.
    pub(crate) plane: Plane,
    /// The likelihood.
    pub(crate) likelihood: f32,
}

/// All ridges, in memory order.
pub(crate) fn ridges(found: &Likelihood) -> Vec<Ridge> {
    let [nx, ny, rows] = found.size;
    (0..nx)
        .into_par_iter()
        .flat_map_iter(|x| {
            let mut line = Vec::new();
            for y in 0..ny {
                for row in 0..rows {
                    let n = (x * ny + y) * rows + row;
                    let here = found.value[n];
                    if here < LEAST {
                        continue;
                    }
                    let plane = found.plane(n);
                    let beside = |by: f32| {
                        let [i, j] = plane.across;
                        found.beside(x as f32 + by * i, y as f32 + by * j, row)
                    };
                    let (Some(before), Some(after)) = (beside(-1.0), beside(1.0)) else { continue };
                    if here <= before || here < after {
                        continue;
                    }
                    let bend = before - 2.0 * here + after;
                    let off = if bend < 0.0 { (0.5 * (before - after) / bend).clamp(-0.5, 0.5) } else { 0.0 };
                    let at = [x as f32 + off * plane.across[0], y as f32 + off * plane.across[1], (row * ROW) as f32];
                    line.push(Ridge { at, plane, likelihood: here });
                }
            }
            line
        })
        .collect()
}
