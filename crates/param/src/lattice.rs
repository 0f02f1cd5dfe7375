//! Which of the local closest points is the global one.
//!
//! Finding the global minimum costs a kd-tree query and a walk from where it says; doing that at every node would be slow
//! and is not needed, since neighbouring places share the branch of the surface that they are closest to. So it is done
//! on a coarse lattice (every [`COLUMNS`]th column, every [`LEVELS`]th level of a region). Each lattice node then tries
//! the feet of its neighbours, which mends the rare start that led into the wrong fold, and everything finer (nodes,
//! steps of traces) follows its own foot and is *challenged* by those of the lattice: where a foot of the lattice is
//! nearer, or where the lattice around disagrees about the branch, the walk is made from there too and the best is kept.
//!
//! Nothing depends on the order of the work: the lattice is computed in passes that read the previous pass only.

use crate::closest::Foot;
use crate::metric::Metric;
use crate::nearest::NodeFinder;
use crate::surface::{Frame, Surface};
use glam::{Vec2, Vec3};
use rayon::prelude::*;
use survey::{Cancelled, Progress};

/// Columns from one lattice node to the next.
pub const COLUMNS: usize = 4;
/// Levels from one lattice node to the next.
pub const LEVELS: usize = 4;
/// Whether a lattice node asks the kd-tree: every second one along each axis. The others start from the level below.
fn is_queried(x: usize, y: usize, level: usize) -> bool {
    x % 2 + y % 2 + level % 2 == 0
}

/// Passes in which lattice nodes try their neighbours' feet.
const PASSES: usize = 3;
/// A neighbour's foot farther away than this (voxels) is tried.
const FOREIGN: f32 = 2.0;
/// Feet of a lattice cell's corners spread over more than this along x or y (voxels) may belong to different branches even if every
/// edge of the cell is whole. With [`SLACK`] 3, of 15 000 points around a sheet with dips to 66° none was off the
/// brute-force minimum at 12; two were when only torn edges counted, three at 12 with a slack of 1.
const BRANCH: f32 = 12.0;
/// A corner's foot is worth a walk when it is farther than the point's own by less than this (scaled metric).
const SLACK: f32 = 3.0;

/// Where the nodes of a region's lattice are.
#[derive(Debug, Clone)]
pub struct LatticeShape {
    /// Column of lattice node (0, 0).
    pub origin: [i32; 2],
    /// Counts of lattice nodes along x, y and the levels.
    pub size: [usize; 3],
    /// Per lattice column `[x][y]`, whether it is wanted.
    pub wanted: Vec<bool>,
}

/// The global closest points of one sheet at the nodes of a lattice.
pub struct FootLattice {
    shape: LatticeShape,
    /// Voxel position of the foot, absolute; NaN where it is not wanted.
    feet: Vec<Vec3>,
    /// Per cell, whether its corners lie on different branches.
    mixed: Vec<bool>,
}

impl FootLattice {
    /// Computes the lattice. `place(x, y)` gives the frame of a column and the height of a lattice level in it.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn new(
        shape: &LatticeShape,
        surface: &Surface,
        metric: &Metric,
        place: impl Fn([i32; 2], usize) -> (Frame, Vec3) + Sync,
        progress: &Progress,
    ) -> Result<Self, Cancelled> {
        let finder = NodeFinder::new(surface, metric);
        let [_, ny, nl] = shape.size;
        let nodes = shape.size.iter().product();
        let mut feet = vec![Vec3::NAN; nodes];
        let column_of = |column: usize| {
            let at = [column / ny, column % ny].map(|n| (n * COLUMNS) as i32);
            [shape.origin[0] + at[0], shape.origin[1] + at[1]]
        };
        let walk = |column: [i32; 2], level: usize, from: Vec2| {
            let (frame, p) = place(column, level);
            let origin = Vec2::new(column[0] as f32, column[1] as f32);
            let mut foot = Foot::start(surface, frame, from - origin);
            foot.follow(surface, metric, frame, p);
            (foot.position() + origin.extend(frame.z), foot.distance)
        };
        let mut distances = vec![f32::INFINITY; nodes];
        feet.par_chunks_mut(nl).zip(distances.par_chunks_mut(nl)).enumerate().try_for_each(
            |(index, (feet, distances))| {
                progress.check()?;
                if !shape.wanted[index] {
                    return Ok(());
                }
                let column = column_of(index);
                let here = Vec2::new(column[0] as f32, column[1] as f32);
                for level in 0..nl {
                    let (frame, p) = place(column, level);
                    if is_queried(index / ny, index % ny, level) {
                        let in_voxels = (p + Vec3::new(column[0] as f32, column[1] as f32, frame.z)).as_dvec3();
                        let [x, y] = finder.near(in_voxels);
                        (feet[level], distances[level]) = walk(column, level, Vec2::new(x as f32, y as f32));
                    } else {
                        let from = if level > 0 { feet[level - 1].truncate() } else { here };
                        (feet[level], distances[level]) = walk(column, level, from);
                        continue;
                    }
                    if level > 0 && (feet[level] - feet[level - 1]).truncate().length_squared() > 1.0 {
                        let (foot, distance) = walk(column, level, feet[level - 1].truncate());
                        if distance < distances[level] {
                            (feet[level], distances[level]) = (foot, distance);
                        }
                    }
                }
                Ok(())
            },
        )?;
        let mut lattice = Self { shape: shape.clone(), feet, mixed: Vec::new() };
        for _ in 0..PASSES {
            progress.check()?;
            let improved: Vec<(Vec3, f32)> = (0..nodes)
                .into_par_iter()
                .map(|node| {
                    let mut best = (lattice.feet[node], distances[node]);
                    let (index, level) = (node / nl, node % nl);
                    if !shape.wanted[index] {
                        return best;
                    }
                    for candidate in lattice.neighbours(index / ny, index % ny, level) {
                        let foreign = (candidate - best.0).truncate().length_squared() > FOREIGN * FOREIGN;
                        if foreign {
                            let (foot, distance) = walk(column_of(index), level, candidate.truncate());
                            if distance < best.1 * (1.0 - 1e-5) {
                                best = (foot, distance);
                            }
                        }
                    }
                    best
                })
                .collect();
            for (node, (foot, distance)) in improved.into_iter().enumerate() {
                (lattice.feet[node], distances[node]) = (foot, distance);
            }
        }
        progress.check()?;
        let torn: Vec<[bool; 3]> = (0..nodes)
            .into_par_iter()
            .map(|node| {
                [ny * nl, nl, 1].map(|step| {
                    let ends = [node, (node + step).min(nodes - 1)];
                    let feet = ends.map(|end| lattice.feet[end]);
                    let apart = (feet[1] - feet[0]).truncate().length_squared() > 1.0;
                    // Comparisons with the NaN of unwanted nodes are false.
                    apart
                        && [(0, 1), (1, 0)].into_iter().any(|(here, there)| {
                            let column = column_of(ends[here] / nl);
                            let (foot, _) = walk(column, ends[here] % nl, feet[there].truncate());
                            (foot - feet[here]).truncate().length_squared() > 0.25
                        })
                })
            })
            .collect();
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

    /// A start near voxel (x, y) and a (fractional) level of the region's grid: the nearest lattice node's foot.
    pub fn start(&self, x: f32, y: f32, level: f32) -> Option<Vec2> {
        let (_, nearest) = self.cell(x, y, level);
        let foot = self.feet[nearest];
        (!foot.is_nan()).then_some(foot.truncate())
    }

    /// The cell that holds a place, and the lattice node nearest to it.
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

    /// Lets the lattice challenge a foot that was followed to `p`; returns whether another branch turned out nearer.
    #[inline]
    pub fn challenge(
        &self,
        foot: &mut Foot,
        surface: &Surface,
        metric: &Metric,
        frame: Frame,
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
                // Corners on one branch lead to one place.
                if corners[..n].iter().all(|other| (corner - *other).truncate().length_squared() > 1.0) {
                    changed |= try_branch(foot, surface, metric, frame, p, corner - column, SLACK);
                }
            }
            return changed;
        }
        try_branch(foot, surface, metric, frame, p, self.feet[nearest] - column, 0.0)
    }
}

/// Walks from `start` (a point of the surface) where that point of the surface is nearer than the foot, give or take `slack` (scaled metric).
#[inline]
fn try_branch(
    foot: &mut Foot,
    surface: &Surface,
    metric: &Metric,
    frame: Frame,
    p: Vec3,
    start: Vec3,
    slack: f32,
) -> bool {
    // False for the NaN of a lattice node that was not wanted.
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

    /// Ridges and a bowl: dips to 66°, folds tighter than the points are far away.
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

    /// The smallest distance to a dense sampling, and then of a finer one around the best.
    fn brute_force(surface: &Surface, metric: &Metric, frame: Frame, p: Vec3) -> f32 {
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
            let surface = Surface::new(&strongly_folded(), 0.0);
            let (columns, levels) = (48usize, 29usize);
            let lattice_levels = (levels - 1).div_ceil(LEVELS) + 1;
            let lattice_columns = (columns - 1).div_ceil(COLUMNS) + 1;
            let shape = LatticeShape {
                origin: [0, 0],
                size: [lattice_columns, lattice_columns, lattice_levels],
                wanted: vec![true; lattice_columns * lattice_columns],
            };
            // Columns run from 30 voxels above the surface's mean to 26 below: both sides of it.
            let place =
                |column: [i32; 2], level: f32| (Frame { column, z: 65.0 }, Vec3::new(0.0, 0.0, 26.0 - 2.0 * level));
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
                    lattice.challenge(&mut foot, &surface, &metric, frame, p, level as f32);
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
