//! A fault that folds, laid smoothly through its folds.
//!
//! Where triangles pass over a place of the plane more than once their mean is taken. Robust quadratics through these means
//! ([`crate::extension`]), in a neighbourhood as wide as the fold is high, leave out what lies far off; they are made at
//! nodes of a coarse grid, between which the surface is bicubic. A fault drawn by crossing sticks, or with a small lip, is
//! fitted so; of a surface that doubles back over a large part of itself the fit is far off, and says so.

use super::build::{OverPlane, Soup};
use crate::extension::{Extension, LocalFits};
use survey::height_field::HeightField;

/// Smallest radius of a neighbourhood, cells.
const LEAST_RADIUS: f64 = 8.0;
/// Largest, as a share of the longer side of what was drawn.
const MOST_RADIUS: f64 = 0.3;
/// Nodes of the coarse grid within the radius.
const NODES_A_RADIUS: f64 = 4.0;
/// The share of what was drawn that lies within the stated distance of the fit.
const WITHIN: f64 = 0.9;
/// Farthest distance of a fit, cells, and as a share of the side of a square as large as the fault.
const OFF_CELLS: f64 = 3.0;
const OFF_SHARE: f64 = 0.04;

/// A smooth surface.
pub(super) struct Smooth {
    /// Height at each node that was drawn, m; NaN elsewhere.
    pub w: Vec<f32>,
    /// The distance within which [`WITHIN`] of what was drawn lies, m.
    pub off_m: f64,
}

/// How far a smooth surface may lie off what was drawn, m.
pub(super) fn tolerance_m(over: &OverPlane, soup: &Soup) -> f64 {
    (OFF_CELLS * over.spacing_m).max(OFF_SHARE * soup.area().sqrt())
}

/// Lays a smooth surface through the passes over a plane.
pub(super) fn smoothed(over: &OverPlane, soup: &Soup) -> Smooth {
    let [_, nv] = over.size;
    let is_drawn: Vec<bool> = over.sums.iter().map(|sum| sum.1 > 0).collect();
    let means: Vec<f32> = over.sums.iter().map(|&(w, n)| if n > 0 { (w / f64::from(n)) as f32 } else { 0.0 }).collect();
    let span = |place: &dyn Fn(usize) -> usize| {
        let drawn = || (0..is_drawn.len()).filter(|&n| is_drawn[n]).map(place);
        drawn().max().zip(drawn().min()).map_or(0, |(last, first)| last - first)
    };
    let longer = span(&|n| n / nv).max(span(&|n| n % nv)) as f64;
    let wanted = over.offset_m().min(soup.area().sqrt()) / over.spacing_m;
    let radius = wanted.clamp(LEAST_RADIUS, LEAST_RADIUS.max(MOST_RADIUS * longer));
    let step = ((radius / NODES_A_RADIUS).round() as usize).max(1);
    let fits = LocalFits::new(over.size, &means, &is_drawn, radius as f32, 0.25 * over.spacing_m as f32);
    let coarse_size = over.size.map(|n| n.div_ceil(step) + 1);
    let mut coarse =
        HeightField { origin: [0; 2], size: coarse_size, z: vec![f32::NAN; coarse_size[0] * coarse_size[1]] };
    // A coarse node beside a drawn one takes the value there, so that no drawn node lies beside the coarse ones.
    for n in (0..is_drawn.len()).filter(|&n| is_drawn[n]) {
        let (i, j) = (n / nv, n % nv);
        let at = ((i + step / 2) / step) * coarse_size[1] + (j + step / 2) / step;
        let is_on_node = i % step == 0 && j % step == 0;
        if is_on_node || coarse.z[at].is_nan() {
            let fit = fits.at(n);
            let [du, dv] =
                [((i + step / 2) / step * step) as f32 - i as f32, ((j + step / 2) / step * step) as f32 - j as f32];
            coarse.z[at] = fit.straight(du, dv);
        }
    }
    let whole = Extension { radius: NODES_A_RADIUS as f32, noise: 0.25 * over.spacing_m as f32, slope: [0.0; 2] };
    if whole.extend(coarse_size, &mut coarse.z).is_none() {
        return Smooth { w: vec![f32::NAN; means.len()], off_m: f64::INFINITY };
    }
    let at = |n: usize| coarse.z_at((n / nv) as f32 / step as f32, (n % nv) as f32 / step as f32);
    let w: Vec<f32> = (0..means.len()).map(|n| if is_drawn[n] { at(n) } else { f32::NAN }).collect();
    let mut off: Vec<f64> = Vec::new();
    over.each_pass(|n, pass| off.push((pass - f64::from(w[n])).abs()));
    let rank = ((off.len() as f64 * WITHIN) as usize).min(off.len().saturating_sub(1));
    let off_m = if off.is_empty() { f64::INFINITY } else { *off.select_nth_unstable_by(rank, f64::total_cmp).1 };
    Smooth { w, off_m }
}
