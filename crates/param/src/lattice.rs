//! The global closest points of a sheet: which of the local ones is nearest.
//!
//! Finding a global minimum costs a kd-tree query and a Newton search from its answer. Doing that at every
//! node would be slow, and is not needed, because neighbouring points mostly share the branch of the surface
//! that is closest to them. So it is done on a coarse lattice (every [`COLUMNS`]th column and every
//! [`LEVELS`]th level of a region). Each lattice node then also tries the feet of its neighbours, which
//! corrects the rare start that led into the wrong fold. Everything finer (grid nodes, steps of traces)
//! follows its own foot and compares it with those of the lattice: where a lattice foot is nearer, or where
//! the lattice nodes around disagree about the branch, the search is repeated from there and the best foot is
//! kept.
//!
//! The result does not depend on the order of the work: each pass over the lattice reads only the previous
//! pass.

use crate::closest::Foot;
use crate::metric::Metric;
use crate::nearest::NodeFinder;
use crate::surface::{BicubicSheet, ColumnFrame};
use glam::{Vec2, Vec3};
use rayon::prelude::*;
use survey::{Cancelled, Progress};

/// Columns between lattice nodes.
pub(crate) const COLUMNS: usize = 4;
/// Levels between lattice nodes.
pub(crate) const LEVELS: usize = 4;
/// Whether a lattice node queries the kd-tree: every second one along each axis. The others start from the
/// level below.
fn is_queried(x: usize, y: usize, level: usize) -> bool {
    x % 2 + y % 2 + level % 2 == 0
}

/// Passes in which lattice nodes try the feet of their neighbours.
const PASSES: usize = 3;
/// A neighbour's foot farther away than this (voxels) is tried.
const FOREIGN: f32 = 2.0;
/// The corners of a lattice cell may lie on different branches where their feet spread over more than this
/// along x or y (voxels), even if no edge of the cell is torn. Of 15 000 points around a sheet with dips to
/// 66°, with [`SLACK`] 3, none was off the brute-force minimum at 12; two were when only torn edges counted,
/// three at 12 with a slack of 1.
const BRANCH: f32 = 12.0;
/// The foot of a cell's corner is tried when it is farther than the point's own foot by less than this
/// (scaled metric).
const SLACK: f32 = 3.0;

/// Where the nodes of a region's lattice are.
#[derive(Debug, Clone)]
pub(crate) struct LatticeShape {
    /// Column of lattice node (0, 0).
    pub origin: [i32; 2],
    /// Counts of lattice nodes along x, y and the levels.
    pub size: [usize; 3],
    /// Per lattice column `[x][y]`, whether it is computed.
    pub wanted: Vec<bool>,
}

/// The global closest points of one sheet at the nodes of a lattice.
pub(crate) struct FootLattice {
    shape: LatticeShape,
    /// Voxel position of the foot of each node `[x][y][level]`, absolute; NaN in columns that are not
    /// computed.
    feet: Vec<Vec3>,
    /// Per cell, whether its corners may lie on different branches.
    mixed: Vec<bool>,
}

/// The closest points of one sheet, found from given starting points.
struct Search<'a, P> {
    shape: &'a LatticeShape,
    surface: &'a BicubicSheet,
    metric: &'a Metric,
    /// Frame of a column, and position of a lattice level in it.
    place: P,
}

impl<P: Fn([i32; 2], usize) -> (ColumnFrame, Vec3) + Sync> Search<'_, P> {
    /// Voxel column of lattice column `index`.
    fn column(&self, index: usize) -> [i32; 2] {
        let ny = self.shape.size[1];
        let at = [index / ny, index % ny].map(|n| (n * COLUMNS) as i32);
        [self.shape.origin[0] + at[0], self.shape.origin[1] + at[1]]
    }

    /// The local closest point to a lattice node, searched from voxel (x, y) `from`, and its distance.
    fn walk(&self, column: [i32; 2], level: usize, from: Vec2) -> (Vec3, f32) {
        let (frame, p) = (self.place)(column, level);
        let origin = Vec2::new(column[0] as f32, column[1] as f32);
        let mut foot = Foot::start(self.surface, frame, from - origin);
        foot.follow(self.surface, self.metric, frame, p);
        (foot.position() + origin.extend(frame.z), foot.distance)
    }

    /// Fills one lattice column from the bottom to the top: some nodes query the kd-tree, the others start
    /// from the level below.
    fn fill_column(&self, finder: &NodeFinder, index: usize, feet: &mut [Vec3], distances: &mut [f32]) {
        let ny = self.shape.size[1];
        let column = self.column(index);
        let here = Vec2::new(column[0] as f32, column[1] as f32);
        for level in 0..feet.len() {
            if !is_queried(index / ny, index % ny, level) {
                let from = if level > 0 { feet[level - 1].truncate() } else { here };
                (feet[level], distances[level]) = self.walk(column, level, from);
                continue;
            }
            let (frame, p) = (self.place)(column, level);
            let in_voxels = (p + Vec3::new(column[0] as f32, column[1] as f32, frame.z)).as_dvec3();
            let [x, y] = finder.near(in_voxels);
            (feet[level], distances[level]) = self.walk(column, level, Vec2::new(x as f32, y as f32));
            if level > 0 && (feet[level] - feet[level - 1]).truncate().length_squared() > 1.0 {
                let (foot, distance) = self.walk(column, level, feet[level - 1].truncate());
                if distance < distances[level] {
                    (feet[level], distances[level]) = (foot, distance);
                }
            }
        }
    }

    /// The foot and distance of a node after trying the feet of its neighbours.
    fn improved(&self, lattice: &FootLattice, distances: &[f32], node: usize) -> (Vec3, f32) {
        let [_, ny, nl] = self.shape.size;
        let mut best = (lattice.feet[node], distances[node]);
        let (index, level) = (node / nl, node % nl);
        if !self.shape.wanted[index] {
            return best;
        }
        for candidate in lattice.neighbours(index / ny, index % ny, level) {
            if (candidate - best.0).truncate().length_squared() > FOREIGN * FOREIGN {
                let (foot, distance) = self.walk(self.column(index), level, candidate.truncate());
                if distance < best.1 * (1.0 - 1e-5) {
                    best = (foot, distance);
                }
            }
        }
        best
    }

    /// Whether the edges of a node to the next one along x, y and the levels are torn: their feet are apart,
    /// and a search at one end from the other end's foot does not arrive at its own foot.
    fn torn_edges(&self, feet: &[Vec3], node: usize) -> [bool; 3] {
        let [_, ny, nl] = self.shape.size;
        [ny * nl, nl, 1].map(|step| {
            let ends = [node, (node + step).min(feet.len() - 1)];
            let both = ends.map(|end| feet[end]);
            let apart = (both[1] - both[0]).truncate().length_squared() > 1.0;
            // Comparisons with the NaN of columns that are not computed are false.
            apart
                && [(0, 1), (1, 0)].into_iter().any(|(here, there)| {
                    let column = self.column(ends[here] / nl);
                    let (foot, _) = self.walk(column, ends[here] % nl, both[there].truncate());
                    (foot - both[here]).truncate().length_squared() > 0.25
                })
        })
    }
}

impl FootLattice {
    /// Computes the lattice. `place(column, level)` gives the frame of a voxel column and the position of a
    /// lattice level in it, relative to that frame.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub(crate) fn new(
        shape: &LatticeShape,
        surface: &BicubicSheet,
        metric: &Metric,
        place: impl Fn([i32; 2], usize) -> (ColumnFrame, Vec3) + Sync,
        progress: &Progress,
    ) -> Result<Self, Cancelled> {
        let finder = NodeFinder::new(surface, metric);
        let search = Search { shape, surface, metric, place };
        let levels = shape.size[2];
        let nodes = shape.size.iter().product();
        let mut feet = vec![Vec3::NAN; nodes];
        let mut distances = vec![f32::INFINITY; nodes];
        feet.par_chunks_mut(levels).zip(distances.par_chunks_mut(levels)).enumerate().try_for_each(
            |(index, (feet, distances))| {
                progress.check()?;
                if shape.wanted[index] {
                    search.fill_column(&finder, index, feet, distances);
                }
                Ok(())
            },
        )?;
        let mut lattice = Self { shape: shape.clone(), feet, mixed: Vec::new() };
        for _ in 0..PASSES {
            progress.check()?;
            let improved: Vec<(Vec3, f32)> =
                (0..nodes).into_par_iter().map(|node| search.improved(&lattice, &distances, node)).collect();
            for (node, (foot, distance)) in improved.into_iter().enumerate() {
                (lattice.feet[node], distances[node]) = (foot, distance);
            }
        }
        progress.check()?;
        let torn: Vec<[bool; 3]> =
            (0..nodes).into_par_iter().map(|node| search.torn_edges(&lattice.feet, node)).collect();
        lattice.mixed = lattice.find_mixed(&torn);
        Ok(lattice)
    }

    /// The feet of the (up to six) neighbours of a lattice node.
    fn neighbours(&self, x: usize, y: usize, level: usize) -> impl Iterator<Item = Vec3> {
        let [nx, ny, nl] = self.shape.size;
        let at = |x: usize, y: usize, level: usize| {
            if x < nx && y < ny && level < nl { self.feet[(x * ny + y) * nl + level] } else { Vec3::NAN }
        };
        [
            at(x.wrapping_sub(1), y, level),
            at(x + 1, y, level),
            at(x, y.wrapping_sub(1), level),
            at(x, y + 1, level),
            at(x, y, level.wrapping_sub(1)),
            at(x, y, level + 1),
        ]
        .into_iter()
        .filter(|foot| !foot.is_nan())
    }

    /// Cells with a torn edge, along which the closest point jumps, or with corners whose feet are far apart.
    fn find_mixed(&self, torn: &[[bool; 3]]) -> Vec<bool> {
        let [nx, ny, nl] = self.shape.size;
        (0..self.feet.len())
            .into_par_iter()
            .map(|node| {
                let cell = [node / nl / ny, node / nl % ny, node % nl];
                let mut known = self.corners(cell).into_iter().filter(|foot| !foot.is_nan());
                let Some(first) = known.next() else { return false };
                let (low, high) = known.fold((first, first), |(low, high), foot| (low.min(foot), high.max(foot)));
                if (high - low).truncate().max_element() > BRANCH {
                    return true;
                }
                // Edges along `axis` start at the four corners that lie low along it.
                (0..3).any(|axis| {
                    (0..8).filter(|corner| corner >> axis & 1 == 0).any(|corner| {
                        let n: [usize; 3] = std::array::from_fn(|axis| cell[axis] + (corner >> axis & 1));
                        let inside = n[0] < nx && n[1] < ny && n[2] < nl && n[axis] + 1 < self.shape.size[axis];
                        inside && torn[(n[0] * ny + n[1]) * nl + n[2]][axis]
                    })
                })
            })
            .collect()
    }

    /// The eight feet around a cell, the last ones repeated at the upper borders.
    fn corners(&self, cell: [usize; 3]) -> [Vec3; 8] {
        let [_, ny, nl] = self.shape.size;
        std::array::from_fn(|corner| {
            let n: [usize; 3] =
                std::array::from_fn(|axis| (cell[axis] + (corner >> axis & 1)).min(self.shape.size[axis] - 1));
            self.feet[(n[0] * ny + n[1]) * nl + n[2]]
        })
    }

    /// A start for a search at voxel (x, y) and a (fractional) level of the region's grid: the foot of the
    /// nearest lattice node. `None` where that foot is not finite.
    pub(crate) fn start(&self, x: f32, y: f32, level: f32) -> Option<Vec2> {
        let (_, nearest) = self.cell(x, y, level);
        let foot = self.feet[nearest];
        (!foot.is_nan()).then_some(foot.truncate())
    }

    /// The cell that contains a position, and the lattice node nearest to it.
    #[inline]
    fn cell(&self, x: f32, y: f32, level: f32) -> ([usize; 3], usize) {
        let [_, ny, nl] = self.shape.size;
        let at = [
            (x - self.shape.origin[0] as f32) * (1.0 / COLUMNS as f32),
            (y - self.shape.origin[1] as f32) * (1.0 / COLUMNS as f32),
            level * (1.0 / LEVELS as f32),
        ];
        // `as usize` saturates at 0, and sends NaN there.
        let clamp = |value: f32, axis: usize| (value as usize).min(self.shape.size[axis] - 1);
        let cell = [clamp(at[0], 0), clamp(at[1], 1), clamp(at[2], 2)];
        let near = [clamp(at[0] + 0.5, 0), clamp(at[1] + 0.5, 1), clamp(at[2] + 0.5, 2)];
        (cell, (near[0] * ny + near[1]) * nl + near[2])
    }

    /// Compares `foot`, which was followed to `p`, with the feet of the lattice around, and replaces it by a
    /// closer one. Returns whether the foot moved to another branch.
    #[inline]
    pub(crate) fn try_lattice(
        &self,
        foot: &mut Foot,
        surface: &BicubicSheet,
        metric: &Metric,
        frame: ColumnFrame,
        p: Vec3,
        level: f32,
    ) -> bool {
        let column = Vec3::new(frame.column[0] as f32, frame.column[1] as f32, frame.z);
        let (cell, nearest) = self.cell(p.x + column.x, p.y + column.y, level);
        let [_, ny, nl] = self.shape.size;
        if self.mixed[(cell[0] * ny + cell[1]) * nl + cell[2]] {
            let mut changed = false;
            let corners = self.corners(cell);
            for (n, &corner) in corners.iter().enumerate() {
                // Corners on one branch lead to the same foot.
                if corners[..n].iter().all(|other| (corner - *other).truncate().length_squared() > 1.0) {
                    changed |= try_branch(foot, surface, metric, frame, p, corner - column, SLACK);
                }
            }
            return changed;
        }
        try_branch(foot, surface, metric, frame, p, self.feet[nearest] - column, 0.0)
    }
}

/// Searches from `start`, a point of the surface, if that point is nearer to `p` than the foot plus `slack`
/// (scaled metric), and replaces the foot by a closer one. Returns whether the foot moved to another branch.
#[inline]
fn try_branch(
    foot: &mut Foot,
    surface: &BicubicSheet,
    metric: &Metric,
    frame: ColumnFrame,
    p: Vec3,
    start: Vec3,
    slack: f32,
) -> bool {
    // False for the NaN of a lattice node that was not computed.
    let limit = foot.distance + slack;
    if metric.length_squared(p - start) < limit * limit {
        let away = start.truncate() - foot.at;
        if away.length_squared() > 0.25 {
            let mut other = Foot::start(surface, frame, start.truncate());
            other.follow(surface, metric, frame, p);
            if other.distance < foot.distance * (1.0 - 1e-5) {
                let moved = (other.at - foot.at).length_squared() > 0.25;
                *foot = other;
                return moved;
            }
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DMat3, DVec3};
    use survey::HeightField;

    /// Ridges and a bowl with dips to 66°. The radii of the folds are smaller than the distances of the
    /// points.
    fn strongly_folded() -> HeightField {
        HeightField::from_fn([-20, -20], [88, 88], |x, y| {
            let (x, y) = (f64::from(x), f64::from(y));
            let ridges = 9.0 * (0.19 * x + 0.06 * y).sin() + 5.0 * (0.23 * y - 0.05 * x).cos();
            (60.0 + ridges + 0.012 * ((x - 24.0).powi(2) + (y - 24.0).powi(2))) as f32
        })
    }

    fn sheared() -> DMat3 {
        DMat3::from_cols(DVec3::new(12.0, 5.0, 0.0), DVec3::new(-4.0, 14.0, 0.0), DVec3::new(0.0, 0.0, 10.0))
    }

    /// The smallest distance to a dense sampling, refined by finer samplings around the best point.
    fn brute_force(surface: &BicubicSheet, metric: &Metric, frame: ColumnFrame, p: Vec3) -> f32 {
        let distance = |at: Vec2| metric.length_squared(p - at.extend(surface.jet(frame, at).h)).sqrt();
        let grid = |centre: Vec2, half: i32, step: f32| {
            let mut best = (f32::INFINITY, centre);
            for a in -half..=half {
                for b in -half..=half {
                    let at = centre + Vec2::new(a as f32, b as f32) * step;
                    let d = distance(at);
                    if d < best.0 {
                        best = (d, at);
                    }
                }
            }
            best
        };
        let (_, coarse) = grid(Vec2::ZERO, 90, 0.5);
        let (_, fine) = grid(coarse, 12, 0.06);
        grid(fine, 12, 0.006).0
    }

    #[test]
    fn the_closest_point_is_the_global_one() {
        for (name, metric) in [("cubic voxels", DMat3::IDENTITY), ("sheared", sheared())] {
            let metric = Metric::new(metric, 1.0).unwrap();
            let surface = BicubicSheet::new(&strongly_folded(), 0.0);
            let (columns, levels) = (48usize, 29usize);
            let lattice_levels = (levels - 1).div_ceil(LEVELS) + 1;
            let lattice_columns = (columns - 1).div_ceil(COLUMNS) + 1;
            let shape = LatticeShape {
                origin: [0, 0],
                size: [lattice_columns, lattice_columns, lattice_levels],
                wanted: vec![true; lattice_columns * lattice_columns],
            };
            // Columns run from 30 voxels above the surface's mean to 26 below: both sides of it.
            let place = |column: [i32; 2], level: f32| {
                (ColumnFrame { column, z: 65.0 }, Vec3::new(0.0, 0.0, 26.0 - 2.0 * level))
            };
            let lattice = FootLattice::new(
                &shape,
                &surface,
                &metric,
                |column, level| place(column, (level * LEVELS) as f32),
                &Progress::silent(),
            )
            .unwrap();
            let mut worst = 0.0f32;
            for (x, y) in [(0, 0), (3, 41), (11, 7), (18, 30), (23, 23), (31, 14), (37, 46), (47, 5), (29, 38), (8, 20)]
            {
                let start = lattice.start(x as f32, y as f32, 0.0).unwrap() - Vec2::new(x as f32, y as f32);
                let (frame, _) = place([x, y], 0.0);
                let mut foot = Foot::start(&surface, frame, start);
                for level in 0..levels {
                    let (_, p) = place([x, y], level as f32);
                    foot.follow(&surface, &metric, frame, p);
                    lattice.try_lattice(&mut foot, &surface, &metric, frame, p, level as f32);
                    let brute = brute_force(&surface, &metric, frame, p);
                    let excess = foot.distance - brute;
                    worst = worst.max(excess);
                    assert!(excess < 1e-3, "{name}: at {x}, {y}, level {level}: {} for {brute}", foot.distance);
                    let on_surface = surface.jet(frame, foot.at);
                    assert!((on_surface.h - foot.jet.h).abs() < 1e-3, "{name}: the remembered height drifts");
                }
            }
            assert!(worst > -1e-2);
        }
    }
}
