//! How accurate a parameterization is: k on the horizons, and the angles between the gradients.
//!
//! Both measures take a lookup as a function of a voxel position, so that the exact lookup and the paper's
//! packed lookup are measured at the same points in the same way.
//!
//! - *k on the horizons*: K = layer + k is continuous across horizons; horizon h of n lies at K = n − h. The
//!   error is |K − (n − h)| over |∂K/∂z|, in voxels of depth.
//! - *angle*: between the metric gradients of k and of i, and of k and of j, by central differences; degrees
//!   off 90°.
//!
//! Positions come from a Halton sequence: they are the same on every machine and never lie on the lattice.

use crate::metric::Metric;
use crate::{FlatPoint, LayerModel, PackedVolume, ParamError, Parameterization, Region};
use glam::Vec3;
use rayon::prelude::*;
use serde::Serialize;

/// Half the distance over which gradients are measured, voxels.
const STEP: f32 = 0.5;

/// Median, 95 % quantile and maximum of a set of errors.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Spread {
    /// Count of errors.
    pub count: usize,
    /// Half of them are no larger.
    pub median: f64,
    /// 95 % of them are no larger.
    pub p95: f64,
    /// The largest.
    pub max: f64,
}

impl Spread {
    /// Sorts absolute errors and takes their quantiles.
    ///
    /// ```
    /// use param::accuracy::Spread;
    ///
    /// let spread = Spread::of((1..=100).map(|n| n as f32).collect());
    /// assert_eq!((spread.count, spread.median, spread.p95, spread.max), (100, 50.0, 95.0, 100.0));
    /// ```
    pub fn of(mut errors: Vec<f32>) -> Self {
        errors.sort_unstable_by(f32::total_cmp);
        let at = |fraction: f64| {
            let index = (fraction * errors.len() as f64).ceil() as usize;
            errors.get(index.saturating_sub(1)).copied().map_or(0.0, f64::from)
        };
        Self { count: errors.len(), median: at(0.5), p95: at(0.95), max: at(1.0) }
    }
}

/// Angle errors of one lookup.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct AngleAccuracy {
    /// Between ∇k and ∇i, degrees off 90.
    pub k_to_i: Spread,
    /// Between ∇k and ∇j, degrees off 90.
    pub k_to_j: Spread,
    /// Count of positions next to a crease; they are left out of the angles.
    pub at_creases: usize,
}

/// All errors of one lookup.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct PathAccuracy {
    /// |k − {0, 1}| on the horizons, voxels of depth.
    pub k_on_horizons: Spread,
    /// Angles between the gradients, degrees off 90.
    pub angles: AngleAccuracy,
}

/// The errors of the exact lookup and of the paper's packed one, measured at the same positions.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct LookupComparison {
    /// [`Parameterization::lookup`].
    pub exact: PathAccuracy,
    /// [`PackedVolume::lookup_extrapolated`] (P-illus 3.4).
    pub packed: PathAccuracy,
}

/// Measures both lookups at up to `count` points per horizon and block, and at up to ten times as many inside
/// the volume.
///
/// # Errors
/// [`ParamError::DegenerateMetric`].
pub fn compare<M: LayerModel + ?Sized>(
    model: &M,
    param: &Parameterization,
    packed: &PackedVolume,
    count: usize,
) -> Result<LookupComparison, ParamError> {
    let points = horizon_points(model, |horizon, block, x, y| model.sheet(horizon, block).z_at(x, y), count);
    let exact = |p| param.lookup(model, p);
    let paper = |p| packed.lookup_extrapolated(p);
    Ok(LookupComparison {
        exact: PathAccuracy {
            k_on_horizons: k_on_horizons(model, param, exact, &points),
            angles: angles(model, param, exact, 10 * count)?,
        },
        packed: PathAccuracy {
            k_on_horizons: k_on_horizons(model, param, paper, &points),
            angles: angles(model, param, paper, 10 * count)?,
        },
    })
}

/// The radical inverse of `n` in a base: a coordinate of the Halton sequence, in [0, 1).
fn halton(mut n: usize, base: usize) -> f64 {
    let (mut value, mut unit) = (0.0, 1.0);
    while n > 0 {
        unit /= base as f64;
        value += unit * (n % base) as f64;
        n /= base;
    }
    value
}

/// A point of a horizon where the horizon bounds its two layers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HorizonPoint {
    /// Horizon, 0 = youngest.
    pub horizon: usize,
    /// Fault block.
    pub block: u16,
    /// Voxel position.
    pub p: Vec3,
}

/// Up to `count` points per horizon and block at the heights `depth(horizon, block, x, y)`. Every 16th lies
/// on the outer boundary. Only points count where the horizon bounds its two layers, i.e. where it is not cut
/// off, is in its own block and is inside the volume.
pub fn horizon_points<M: LayerModel + ?Sized>(
    model: &M,
    depth: impl Fn(usize, u16, f32, f32) -> f32 + Sync,
    count: usize,
) -> Vec<HorizonPoint> {
    let [nx, ny, nz] = model.size().map(|n| n.saturating_sub(1) as f32);
    let horizons = model.layer_count() - 1;
    let blocks = model.block_count();
    let point = |case: usize, n: usize| {
        let (horizon, block) = (case / blocks, (case % blocks) as u16);
        let (mut x, mut y) = (halton(n, 2) as f32 * nx, halton(n, 3) as f32 * ny);
        match n % 64 {
            0 => x = 0.0,
            16 => x = nx,
            32 => y = 0.0,
            48 => y = ny,
            _ => {}
        }
        let p = Vec3::new(x, y, depth(horizon, block, x, y));
        let layer_above = (horizons - horizon) as u16;
        // Wide enough for a true depth that the sheet of the model misses by a little.
        let near = Vec3::new(0.0, 0.0, 0.5);
        let bounds = model.region_at(p - near) == Region { layer: layer_above, block }
            && model.region_at(p + near) == Region { layer: layer_above - 1, block };
        (bounds && p.z >= 0.0 && p.z <= nz).then_some(HorizonPoint { horizon, block, p })
    };
    (0..horizons * blocks)
        .into_par_iter()
        .flat_map_iter(|case| (1..=count).filter_map(move |n| point(case, n)))
        .collect()
}

/// |k − {0, 1}| at points of horizons, voxels of depth.
pub fn k_on_horizons<M: LayerModel + ?Sized>(
    model: &M,
    param: &Parameterization,
    lookup: impl Fn(Vec3) -> FlatPoint + Sync,
    points: &[HorizonPoint],
) -> Spread {
    let horizons = model.layer_count() - 1;
    let errors = points
        .par_iter()
        .map(|&HorizonPoint { horizon, block, p }| {
            let above = Region { layer: (horizons - horizon) as u16, block };
            let below = Region { layer: above.layer - 1, block };
            let found = lookup(p);
            let error = f32::from(found.region.layer) + found.k - f32::from(above.layer);
            let (_, jacobian) = param.lookup_in(model, p, if error >= 0.0 { above } else { below });
            error.abs() / jacobian[2][2].abs()
        })
        .collect();
    Spread::of(errors)
}

/// Angles between the metric gradients at up to `count` points whose surroundings lie in one region.
///
/// # Errors
/// [`ParamError::DegenerateMetric`].
pub fn angles<M: LayerModel + ?Sized>(
    model: &M,
    param: &Parameterization,
    lookup: impl Fn(Vec3) -> FlatPoint + Sync,
    count: usize,
) -> Result<AngleAccuracy, ParamError> {
    let metric = Metric::new(model.metric(), 1.0)?;
    let [nx, ny, nz] = model.size().map(|n| n.saturating_sub(1) as f32);
    let found: Vec<Option<[f32; 2]>> = (1..=count)
        .into_par_iter()
        .filter_map(|n| {
            let unit = [2, 3, 5].map(|base| halton(n, base) as f32);
            let inside = |unit: f32, last: f32| STEP + unit * (last - 2.0 * STEP);
            let p = Vec3::new(inside(unit[0], nx), inside(unit[1], ny), inside(unit[2], nz));
            let region = model.region_at(p);
            let mut rows = [Vec3::ZERO; 3];
            for (axis, step) in [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| axis * STEP).into_iter().enumerate() {
                if model.region_at(p + step) != region || model.region_at(p - step) != region {
                    return None;
                }
                let (high, low) = (lookup(p + step), lookup(p - step));
                for (row, difference) in rows.iter_mut().zip([high.i - low.i, high.j - low.j, high.k - low.k]) {
                    row[axis] = difference;
                }
            }
            if param.is_near_crease(model, p, region) {
                return Some(None);
            }
            let raised = metric.raise(rows[2]);
            let off = |row: Vec3| {
                let cosine = row.dot(raised) / (row.dot(metric.raise(row)) * rows[2].dot(raised)).sqrt();
                cosine.abs().min(1.0).asin().to_degrees()
            };
            Some(Some([off(rows[0]), off(rows[1])]))
        })
        .collect();
    let known = |n: usize| Spread::of(found.iter().flatten().map(|pair| pair[n]).collect());
    Ok(AngleAccuracy {
        k_to_i: known(0),
        k_to_j: known(1),
        at_creases: found.iter().filter(|place| place.is_none()).count(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_spread_of_a_hundred_numbers() {
        let spread = Spread::of((1..=100).rev().map(|n| n as f32).collect());
        assert_eq!((spread.count, spread.median, spread.p95, spread.max), (100, 50.0, 95.0, 100.0));
        assert_eq!(Spread::of(Vec::new()), Spread::default());
    }

    #[test]
    fn halton_fills_the_unit_interval() {
        assert_eq!([1, 2, 3, 4].map(|n| halton(n, 2)), [0.5, 0.25, 0.75, 0.125]);
    }
}
