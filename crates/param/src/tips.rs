//! Blocks that meet beyond the tip of a fault, joined: rock is not broken there, and neither are patterns.
//!
//! What is computed of each block alone parts beyond the tip, because it also follows the sheets beside the fault, which
//! differ. So each block takes the mean with its neighbours, in which another block counts by
//!
//! ```text
//! w = ∏ f(d / L) · f(e / L) · ∏ (1 − f(h / 2t))         f(x) = 1 for x ≤ 0, 0 for x ≥ 1, 1 − x²(3 − 2x) between
//! ```
//!
//! d is the distance from a fault between the two, e how far inside its tip line a place lies (negative beyond), L the
//! length of [`LENGTH`] columns; h is the vertical distance from a horizon of the layer and t the horizon's throw there.
//! On the continuation of a fault both have the same mean, and a pattern goes on. The mean of k bends, so i and j are followed
//! along it once more ([`crate::retrace`]): averaged beside it they were up to three degrees off. Along the fault it begins to break within
//! L of the tip line. On a horizon that the fault breaks nothing changes.

use crate::columns::RegionColumns;
use crate::flow::calm::mean_around;
use crate::metric::Metric;
use crate::plan::{Method, horizons};
use crate::{LayerModel, RegionGrid, retrace};
use glam::Vec3;
use model::{FaultNetwork, FaultSurface};
use rayon::prelude::*;
use survey::{Cancelled, HeightField, Progress};

/// Columns by which the grid of a block reaches beyond it, so that its neighbours can take the mean with it. Over these
/// its weight dies out.
pub(crate) const GROWN: usize = 6;
/// L in columns: a block is computed for three columns beyond it in any case.
const LENGTH: usize = GROWN + 3;
/// Columns and samples between the places at which blocks are looked for that meet.
const MEETS_EVERY: usize = 3;
/// Levels between those at which the distance from faults is measured; between them it is interpolated.
const WEIGHED_EVERY: usize = 4;
/// A throw that does not count, voxels.
const UNBROKEN: f32 = 0.1;

/// Sheets this near are the same surface, voxels.
const SAME: f32 = 0.25;

/// How much of another block's sheet counts where both are so many voxels apart.
fn share(throw: f32) -> f32 {
    (1.0 - throw * throw).max(0.0).powi(2)
}

/// 1 up to x = 0, 0 from x = 1 on.
fn falling(x: f32) -> f32 {
    let x = x.clamp(0.0, 1.0);
    1.0 - x * x * (3.0 - 2.0 * x)
}

/// The mean of the calm sheets of one horizon, `[block]`, over the blocks whose `drawn` sheets are one surface. Another counts
/// by (1 − t²)² where they are t < 1 voxels apart, averaged over waves of `wave` voxels along x and y: rough sheets are nearer
/// and farther apart from column to column, and the mean is to be as calm as they. Where they are the same it counts in full.
pub(crate) fn mean_of_sheets(drawn: &[&HeightField], calm: Vec<HeightField>, wave: [f64; 2]) -> Vec<HeightField> {
    if calm.len() < 2 {
        return calm;
    }
    let mean = |(a, own): (usize, &HeightField)| {
        let mut sums = vec![0.0; own.z.len()];
        let mut weights = vec![1.0; own.z.len()];
        for (b, other) in calm.iter().enumerate().filter(|(b, _)| *b != a) {
            let throws: Vec<f32> = drawn[b].z.iter().zip(&drawn[a].z).map(|(there, here)| there - here).collect();
            if throws.iter().all(|throw| throw.abs() >= 1.0) {
                continue;
            }
            let shares = HeightField { z: throws.iter().map(|throw| share(*throw)).collect(), ..own.clone() };
            let around = mean_around(&shares, wave);
            for (n, around) in around.z.iter().enumerate() {
                let around = around.clamp(0.0, 1.0);
                let weight = around + (1.0 - around) * share(largest_around(&throws, own.size, n) / SAME);
                sums[n] += weight * (other.z[n] - own.z[n]);
                weights[n] += weight;
            }
        }
        let z = own.z.iter().zip(sums.iter().zip(&weights)).map(|(own, (sum, weight))| own + sum / weight).collect();
        HeightField { z, ..own.clone() }
    };
    calm.par_iter().enumerate().map(mean).collect()
}

/// The largest throw in a column and those beside it.
fn largest_around(throws: &[f32], [nx, ny]: [usize; 2], n: usize) -> f32 {
    let near = |at: usize, count: usize| at.saturating_sub(1)..(at + 2).min(count);
    near(n / ny, nx).flat_map(|x| near(n % ny, ny).map(move |y| throws[x * ny + y].abs())).fold(0.0, f32::max)
}

/// L, the length of [`LENGTH`] columns, m.
pub(crate) fn length_m<M: LayerModel + ?Sized>(model: &M) -> f64 {
    let steps = model.metric();
    LENGTH as f64 * steps.x_axis.length().min(steps.y_axis.length())
}

/// The faults of a model, and how far blocks reach beyond their tips.
pub(crate) struct Tips<'a> {
    faults: Option<&'a FaultNetwork>,
    /// L, m.
    length_m: f64,
}

impl<'a> Tips<'a> {
    /// Of a model.
    pub(crate) fn of<M: LayerModel + ?Sized>(model: &'a M) -> Self {
        Self { faults: model.faults(), length_m: length_m(model) }
    }

    /// The faults between two blocks.
    fn between(&self, [a, b]: [u16; 2]) -> Vec<&FaultSurface> {
        let Some(faults) = self.faults else { return Vec::new() };
        let [a, b] = [a, b].map(|block| faults.signatures()[usize::from(block)]);
        let bits = (a.bits ^ b.bits) & a.care & b.care;
        (0..64).filter(|n| bits >> n & 1 == 1).map(|n: usize| &faults.surfaces()[n]).collect()
    }

    /// How much a block on the other side of `faults` counts at voxel p.
    fn weight(&self, faults: &[&FaultSurface], p: Vec3) -> f32 {
        let of = |length: f64| falling((length / self.length_m) as f32);
        let p = p.as_dvec3();
        faults.iter().fold(1.0, |weight, fault| {
            if weight == 0.0 { 0.0 } else { weight * of(fault.side(p).abs()) * of(fault.extent_at(p)) }
        })
    }

    /// For each block of a layer, itself and those that it meets beyond a tip, directly or through others.
    pub(crate) fn companions(&self, touched: &[&RegionColumns]) -> Vec<Vec<u16>> {
        let blocks = touched.len();
        let meets = |a: usize, b: usize| {
            let faults = self.between([a as u16, b as u16]);
            let columns = touched[a]
                .columns()
                .filter(|(_, [x, y], _)| [x, y].iter().all(|at| at.rem_euclid(MEETS_EVERY as i32) == 0));
            !faults.is_empty()
                && columns.into_iter().any(|(_, [x, y], own)| {
                    touched[b].depths_at([x, y]).is_some_and(|other| {
                        let (low, high) = (own[0].max(other[0]), own[1].min(other[1]));
                        let count = ((high - low) / MEETS_EVERY as f32).max(0.0) as usize;
                        let place = |n: usize| Vec3::new(x as f32, y as f32, low + (n * MEETS_EVERY) as f32);
                        low <= high && (0..=count).any(|n| self.weight(&faults, place(n)) > 0.5)
                    })
                })
        };
        let mut group: Vec<usize> = (0..blocks).collect();
        for (a, b) in (0..blocks).flat_map(|a| (0..a).map(move |b| (a, b))) {
            if group[a] != group[b] && meets(a, b) {
                let (kept, gone) = (group[a].min(group[b]), group[a].max(group[b]));
                group.iter_mut().filter(|g| **g == gone).for_each(|g| *g = kept);
            }
        }
        let of = |a: usize| (0..blocks).filter(|&b| group[b] == group[a]).map(|b| b as u16).collect();
        (0..blocks).map(of).collect()
    }
}

/// Gives the grids of one layer, by block, the mean with the blocks that they meet beyond tips. `columns` are those that the
/// grids are filled in, and how; where there are none, a grid stays alone. i and j are followed along the mean k, which leaves
/// hundredths of a voxel between the blocks. Of definitions parallel to a horizon it leaves more, so that they take the mean
/// of i and j once more.
///
/// # Errors
/// [`Cancelled`].
pub(crate) fn join<M: LayerModel + ?Sized>(
    model: &M,
    metric: &Metric,
    grids: &mut [&mut RegionGrid],
    columns: &[Option<(&RegionColumns, Method)>],
    progress: &Progress,
) -> Result<(), Cancelled> {
    let filled: Vec<Option<&RegionColumns>> = columns.iter().map(|of| of.map(|(columns, _)| columns)).collect();
    let changed = take_means(model, grids, &filled, None, progress)?;
    if changed.iter().all(Vec::is_empty) {
        return Ok(());
    }
    for ((grid, of), changed) in grids.iter_mut().zip(columns).zip(&changed) {
        if let &Some((columns, method)) = of {
            retrace::retrace(model, metric, grid, method, columns, changed, progress)?;
        }
    }
    let by_distance = |of: &(&RegionColumns, Method)| matches!(of.1, Method::Closest(_));
    let parallel: Vec<_> = columns.iter().map(|of| of.filter(by_distance).map(|(columns, _)| columns)).collect();
    take_means(model, grids, &parallel, Some(&changed), progress).map(drop)
}

/// Gives grids the mean of i, j and k, or of i and j alone in the columns that have that of k, `changed`. Returns the columns
/// (`[x][y]`) of each grid that have taken it.
fn take_means<M: LayerModel + ?Sized>(
    model: &M,
    grids: &mut [&mut RegionGrid],
    columns: &[Option<&RegionColumns>],
    changed: Option<&[Vec<usize>]>,
    progress: &Progress,
) -> Result<Vec<Vec<usize>>, Cancelled> {
    let tips = Tips::of(model);
    let filled = |n: usize| columns[n].filter(|_| !grids[n].offsets.is_empty()).map(|columns| (n, columns));
    let filled: Vec<(usize, &RegionColumns)> = (0..grids.len()).filter_map(filled).collect();
    let mut joined = Vec::with_capacity(filled.len());
    for &(a, columns) in &filled {
        let grid = &*grids[a];
        let others = filled.iter().filter_map(|&(b, columns)| {
            let faults = tips.between([grid.region.block, grids[b].region.block]);
            (!faults.is_empty()).then_some(Other { grid: &*grids[b], columns, faults })
        });
        let others: Vec<Other> = others.collect();
        let column = Joined { model, tips: &tips, grid, others: &others, keeps_k: changed.is_some() };
        let ny = grid.size[1];
        let at = |n: usize| [grid.origin[0] + (n / ny) as i32, grid.origin[1] + (n % ny) as i32];
        let wanted = match changed {
            Some(changed) => changed[a].clone(),
            None => (0..grid.size[0] * ny).filter(|&n| columns.depths_at(at(n)).is_some()).collect(),
        };
        let mean = |n: usize| {
            progress.check()?;
            Ok(column.mean(at(n)).map(|mean| (n, mean)))
        };
        let means: Result<Vec<_>, Cancelled> = wanted.into_par_iter().map(mean).collect();
        joined.push(means?.into_iter().flatten().collect::<Vec<_>>());
    }
    let mut taken = vec![Vec::new(); grids.len()];
    for ((a, _), means) in filled.into_iter().zip(joined) {
        for (n, mean) in means {
            let start = n * mean.len();
            grids[a].offsets[start..start + mean.len()].copy_from_slice(&mean);
            taken[a].push(n);
        }
    }
    Ok(taken)
}

/// The grid of another block, the columns that it is filled in, and the faults between.
struct Other<'a> {
    grid: &'a RegionGrid,
    columns: &'a RegionColumns,
    faults: Vec<&'a FaultSurface>,
}

impl Other<'_> {
    /// 1 in the columns of the block, less beyond.
    fn reach(&self, column: [i32; 2]) -> f32 {
        self.columns.steps_beyond(column).map_or(0.0, |steps| falling(steps as f32 / GROWN as f32))
    }

    /// How near the continuations of the faults each [`WEIGHED_EVERY`]th of so many levels is, and one more.
    fn near(&self, tips: &Tips, levels: usize, place: impl Fn(usize) -> Vec3) -> Vec<f32> {
        let count = (levels - 1) / WEIGHED_EVERY + 2;
        (0..count).map(|n| tips.weight(&self.faults, place(n * WEIGHED_EVERY))).collect()
    }
}

/// A grid and those that it takes the mean with.
struct Joined<'a, M: ?Sized> {
    model: &'a M,
    tips: &'a Tips<'a>,
    grid: &'a RegionGrid,
    others: &'a [Other<'a>],
    /// k is not to change.
    keeps_k: bool,
}

impl<M: LayerModel + ?Sized> Joined<'_, M> {
    /// The mean in a voxel column; `None` where nothing else counts.
    fn mean(&self, column @ [x, y]: [i32; 2]) -> Option<Vec<[f32; 3]>> {
        let (grid, last) = (self.grid, self.grid.levels - 1);
        let start = grid.node((x - grid.origin[0]) as usize, (y - grid.origin[1]) as usize, 0);
        let own = &grid.offsets[start..=start + last];
        let bottom = grid.bottom.node(self.model, grid.region.block, x, y);
        let thickness = bottom - grid.top.node(self.model, grid.region.block, x, y);
        let (below, above) = horizons(self.model, usize::from(grid.region.layer));
        // k is 0 and 1 on the sheets.
        let is_fixed = [(below, &grid.bottom), (above, &grid.top)].map(|(h, sheet)| h.is_some() && sheet.shift == 0.0);
        let mut sums: Vec<(Vec3, f32)> = own.iter().map(|own| (Vec3::from(*own), 1.0)).collect();
        for (other, reach) in self.others.iter().map(|other| (other, other.reach(column))).filter(|of| of.1 > 0.0) {
            let place = |level: usize| {
                let v = level as f32 / last as f32;
                Vec3::new(x as f32, y as f32, bottom - v * thickness)
            };
            let near = other.near(self.tips, grid.levels, place);
            if near.iter().all(|near| *near == 0.0) {
                continue;
            }
            let broken = self.broken(column, [below, above], other.grid.region.block);
            let other = other.grid.column(self.model, column);
            for (level, (sum, weights)) in sums.iter_mut().enumerate() {
                let z = place(level).z;
                let clear = broken.iter().flatten().map(|&(horizon, throw)| clear_of((z - horizon).abs(), throw));
                let (cell, fraction) = (level / WEIGHED_EVERY, (level % WEIGHED_EVERY) as f32 / WEIGHED_EVERY as f32);
                let near = near[cell] + fraction * (near[cell + 1] - near[cell]);
                let weight = reach * near * clear.product::<f32>();
                if weight > 0.0 {
                    let found = other.offsets(z, level as f32 / last as f32);
                    let is_fixed = self.keeps_k || (level == 0 && is_fixed[0]) || (level == last && is_fixed[1]);
                    *sum += weight * if is_fixed { found.with_z(own[level][2]) } else { found };
                    *weights += weight;
                }
            }
        }
        let is_alone = sums.iter().all(|(_, weights)| *weights == 1.0);
        (!is_alone).then(|| sums.iter().map(|(sum, weights)| (*sum / *weights).to_array()).collect())
    }

    /// Depth and throw (voxels) of the layer's horizons between this and another block.
    fn broken(&self, [x, y]: [i32; 2], horizons: [Option<usize>; 2], other: u16) -> [Option<(f32, f32)>; 2] {
        let z = |h: usize, block: u16| self.model.sheet(h, block).node(x, y);
        horizons.map(|h| h.map(|h| (z(h, self.grid.region.block), h)).map(|(own, h)| (own, (z(h, other) - own).abs())))
    }
}

/// 0 on a horizon that is broken by a throw, 1 from twice the throw away on.
fn clear_of(distance: f32, throw: f32) -> f32 {
    1.0 - falling((distance + UNBROKEN) / (2.0 * throw + UNBROKEN))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: [usize; 2] = [60, 12];

    fn field(z: impl Fn(usize) -> f32) -> HeightField {
        HeightField { origin: [0; 2], size: SIZE, z: (0..SIZE[0] * SIZE[1]).map(|n| z(n / SIZE[1])).collect() }
    }

    /// Sheets that are the same up to column 20, and from there on a little nearer and farther than a voxel by turns.
    #[test]
    fn the_mean_of_rough_sheets_is_calm_and_one_where_they_are_the_same() {
        let drawn = [field(|_| 0.0), field(|x| if x < 20 { 0.0 } else { [0.3, 1.2, 0.1, 1.6][x % 4] })];
        let calm = vec![field(|_| 0.0), field(|_| 4.0)];
        let means = mean_of_sheets(&drawn.each_ref(), calm, [12.0; 2]);
        let at = |block: usize, x: usize| means[block].z[x * SIZE[1] + 6];
        for x in 0..12 {
            assert!((at(0, x) - 2.0).abs() < 1e-3 && (at(1, x) - 2.0).abs() < 1e-3, "column {x}: {}", at(0, x));
        }
        for x in 0..19 {
            assert!((at(0, x) - at(1, x)).abs() < 1e-3, "column {x}: {} and {}", at(0, x), at(1, x));
        }
        // By the distance in each column alone it went from 0 to 2 and back.
        let steps = (26..59).map(|x| (at(0, x + 1) - at(0, x)).abs());
        assert!(steps.fold(0.0, f32::max) < 0.8, "{:?}", (24..60).map(|x| at(0, x)).collect::<Vec<_>>());
    }
}
