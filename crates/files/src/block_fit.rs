//! Fits scattered points of a horizon fault block by fault block, with the throw kept along the faults.
//!
//! A few points a block are enough. Each point counts for the block in which it lies; the blocks share one shape, from
//! which each departs by an offset and a gentle deformation of its own ([`spline`]), so that a block with few points takes
//! its shape from the others and its level from its own. A block whose points hold a plane everywhere in it has a dip of
//! its own. Beyond the tip of a fault both sides are one surface: there the fit ties them to each other.
//!
//! A point within a few voxels of a fault whose depth says that it was read on the other side counts there. Of more points
//! than a dense system takes, evenly chosen ones give the trend, and the rest is interpolated between the points of the
//! block by inverse distances (Franke & Nielson, "Smooth interpolation of large sets of scattered data", 1980).
//!
//! Nodes are made between the points, as without faults, and within a few nodes of each; a node belongs to a block where
//! the surface of the block lies in it, so that both sides reach the fault. A block without points has no nodes.
//! Spaces: world points come in; metres on the map over twice the diagonal of the survey inside; depths in the vertical unit.

mod rest;
mod spline;

use super::placement::{voxel_xy, world_xy};
use super::raster;
use super::scatter::{self, circumradius, delaunay, median_side, outliers_of};
use glam::{DVec2, DVec3, Vec3};
use model::FaultNetwork;
use rayon::prelude::*;
use rest::Rest;
use spline::{BlockSpline, Observation};
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};
use survey::geometry::SurveyGeometry;
use survey::horizon::{NodeGrid, Quality, Sheet};
use survey::progress::{Cancelled, Progress};
use survey::remedy::Note;

/// Points that the spline goes through at most; it is solved densely.
const MOST_POINTS: usize = 800;
/// Of each block so many points at least count among these.
const FEWEST_OF_BLOCK: usize = 6;
/// Lattice places along the longer side at which blocks and tips are looked for.
const COARSE: usize = 64;
/// Places beyond a tip at which two blocks are tied, at most for each pair of blocks.
const MOST_TIES: usize = 40;
/// Of blocks with no more points than the second number, nodes are made so far from each point, also outside of the points'
/// outline, nodes.
const AROUND_POINT: usize = 4;
const FEW_POINTS: usize = 100;
/// An error of one point must grow to no more than twice anywhere in a block for the block to have a dip of its own:
/// the largest variance of a plane through its points, of that of one point.
const STEADY: f64 = 4.0;
/// A point is doubtful so close to a fault, voxels; it was read on the other side if it is farther than the second number
/// from the surface of its own side, in samples, and misses that of another by less than this share.
const DOUBTFUL_VOXELS: f64 = 4.0;
const STRAY_SAMPLES: f64 = 1.5;
const STRAY_SHARE: f64 = 0.25;

/// A horizon that was fitted block by block.
#[derive(Debug, Clone, PartialEq)]
pub struct BlockFit {
    /// The sheets on the survey's traces, one for each block with points, or that meets one of these beyond a tip.
    pub sheets: Vec<Sheet>,
    /// The number of points of each fault block that has any.
    pub points: BTreeMap<u16, usize>,
    /// Points that count on the other side of the fault beside them, by their depth.
    pub moved: usize,
    /// Inline and crossline in the middle of each fault block that the horizon must reach, but has no point in.
    pub empty: Vec<[i32; 2]>,
    /// Gaps into which a circle of this radius fits without containing a point stay holes, m.
    pub gap_m: f64,
    /// How many points lie far off their neighbours in their block, and the warning that says so.
    pub off_map: Option<(usize, Note)>,
}

/// A point of a block.
#[derive(Debug, Clone, Copy)]
struct BlockPoint {
    /// Fractional trace.
    voxel: DVec2,
    /// Metres on the map over [`Fitter::reach_m`].
    place: DVec2,
    z: f64,
    block: u16,
    is_doubtful: bool,
}

/// Fits points (world X, Y, vertical value) on both sides of faults.
///
/// ```
/// use glam::{DVec2, DVec3};
/// use model::FaultNetwork;
/// use survey::{Fault, Progress, SurveyGeometry, TriangleMesh, VerticalUnit};
///
/// // An upright fault at x = 100 m and four points on either side of it, those beyond 60 m lower.
/// let geometry = SurveyGeometry::regular([21, 21, 101], 10.0, 5.0, VerticalUnit::Metres);
/// let corner = |y: f64, z: f64| DVec3::new(100.0, y, z);
/// let vertices = vec![corner(-50.0, -50.0), corner(250.0, -50.0), corner(250.0, 550.0), corner(-50.0, 550.0)];
/// let fault = Fault::new("F", TriangleMesh { vertices, triangles: vec![[0, 1, 2], [0, 2, 3]] });
/// let faults = FaultNetwork::build(&geometry, &[fault], &Progress::silent())?;
/// let z = |x: f64, y: f64| 200.0 + 0.1 * x - 0.2 * y + if x > 100.0 { 60.0 } else { 0.0 };
/// let places = [12.0, 71.0, 133.0, 188.0].map(|x| [(x, 0.2 * x), (x, 200.0 - 0.3 * x)]).concat();
/// let points: Vec<DVec3> = places.iter().map(|&(x, y)| DVec3::new(x, y, z(x, y))).collect();
///
/// let fit = files::fit_blocks(&points, &geometry, &faults, None, &Progress::silent())?;
/// assert_eq!(fit.sheets.len(), 2);
/// for sheet in &fit.sheets {
///     for (n, depth) in sheet.depth.iter().enumerate().filter(|(_, depth)| depth.is_finite()) {
///         let [x, y] = [10.0 * (n / 21) as f64, 10.0 * (n % 21) as f64];
///         // At the fault itself both sides are right.
///         assert!(x == 100.0 || (f64::from(*depth) - z(x, y)).abs() < 0.01);
///     }
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Cancelled`].
pub fn fit_blocks(
    points: &[DVec3],
    geometry: &SurveyGeometry,
    faults: &FaultNetwork,
    gap_m: Option<f64>,
    progress: &Progress,
) -> Result<BlockFit, Cancelled> {
    let fitter = Fitter::new(geometry, faults);
    let mut points = fitter.placed(points);
    let moved = fitter.settle(&mut points, progress)?;
    let (spline, rest) = fitter.fit(&points, progress)?;
    let outline = Outline::of(&points, geometry, gap_m);
    let (sheets, empty) = fitter.nodes(&points, &spline, &rest, &outline, progress)?;
    let mut counts = BTreeMap::new();
    points.iter().for_each(|point| *counts.entry(point.block).or_insert(0) += 1);
    let off_map = off_map(&points, geometry);
    Ok(BlockFit { sheets, points: counts, moved, empty, gap_m: outline.gap_m, off_map })
}

/// The points that stand out from their neighbours in their own blocks, and the warning that names the worst.
fn off_map(points: &[BlockPoint], geometry: &SurveyGeometry) -> Option<(usize, Note)> {
    let mut of_block: BTreeMap<u16, Vec<(DVec2, f32)>> = BTreeMap::new();
    points.iter().for_each(|p| of_block.entry(p.block).or_default().push((p.voxel, p.z as f32)));
    let found = of_block.values().filter_map(|points| outliers_of(points, geometry)).collect::<Vec<_>>();
    let count = found.iter().map(|outliers| outliers.count).sum();
    let worst = found.into_iter().max_by(|a, b| a.worst[3].abs().total_cmp(&b.worst[3].abs()))?;
    Some((count, Note::from(scatter::Outliers { count, ..worst }.sentence(geometry.vertical.unit))))
}

/// What a fit is made in.
struct Fitter<'a> {
    geometry: &'a SurveyGeometry,
    faults: &'a FaultNetwork,
    /// World X, Y of the first trace.
    origin: DVec2,
    /// Twice the diagonal of the survey: no two points that count are farther apart, m.
    reach_m: f64,
    /// Traces from one place to the next at which blocks and tips are looked for.
    step: usize,
}

impl<'a> Fitter<'a> {
    fn new(geometry: &'a SurveyGeometry, faults: &'a FaultNetwork) -> Self {
        let [nx, ny, _] = geometry.size();
        let corner = |x: usize, y: usize| world_xy(geometry, DVec2::new(x as f64, y as f64));
        let (a, b) = (corner(0, 0).distance(corner(nx, ny)), corner(nx, 0).distance(corner(0, ny)));
        let step = (nx.max(ny) / COARSE).max(1);
        Self { geometry, faults, origin: corner(0, 0), reach_m: 2.0 * a.max(b).max(1e-9), step }
    }

    /// A place on the map for the spline.
    fn place(&self, voxel: DVec2) -> DVec2 {
        (world_xy(self.geometry, voxel) - self.origin) / self.reach_m
    }

    /// The voxel position over a trace.
    fn voxel(&self, trace: DVec2, z: f64) -> Vec3 {
        trace.extend(self.geometry.vertical.index_of(z)).as_vec3()
    }

    /// The points inside the survey, each with the block in which it lies; those at one place of a block as their mean.
    fn placed(&self, points: &[DVec3]) -> Vec<BlockPoint> {
        let [nx, ny, _] = self.geometry.size();
        let mut merged: Vec<(BlockPoint, f64)> = Vec::new();
        let mut known = HashMap::new();
        for world in points {
            let voxel = voxel_xy(self.geometry, world.truncate());
            let beside = 0.5 * DVec2::new(nx as f64, ny as f64);
            if !world.is_finite() || voxel.cmplt(-beside).any() || voxel.cmpgt(3.0 * beside).any() {
                continue;
            }
            let block = self.faults.block_at(self.voxel(voxel, world.z));
            let key = (block, (voxel.x * 100.0).round() as i64, (voxel.y * 100.0).round() as i64);
            let at = *known.entry(key).or_insert_with(|| {
                let point = BlockPoint { voxel, place: self.place(voxel), z: 0.0, block, is_doubtful: false };
                merged.push((point, 0.0));
                merged.len() - 1
            });
            merged[at].0.z += world.z;
            merged[at].1 += 1.0;
        }
        let mean = |(mut point, count): (BlockPoint, f64)| {
            point.z /= count;
            point.is_doubtful = self.is_doubtful(self.voxel(point.voxel, point.z));
            point
        };
        merged.into_iter().map(mean).collect()
    }

    /// Whether a place is so close to what was drawn of a fault that a point there may have been read on its other side.
    fn is_doubtful(&self, p: Vec3) -> bool {
        let existing = self.faults.existing(self.faults.bits_at(p));
        let at = p.as_dvec3();
        self.faults.surfaces().iter().enumerate().any(|(f, surface)| {
            // Horizontal distance, to first order.
            let steep = surface.side_gradient(at).truncate().length();
            existing >> f & 1 == 1
                && surface.extent_at(at) >= 0.0
                && surface.side(at).abs() < DOUBTFUL_VOXELS * steep.max(1e-9)
        })
    }

    /// Gives doubtful points to the block whose surface, fitted to the others, they lie on; returns how many changed sides.
    fn settle(&self, points: &mut [BlockPoint], progress: &Progress) -> Result<usize, Cancelled> {
        let sure: Vec<BlockPoint> = points.iter().filter(|point| !point.is_doubtful).copied().collect();
        if sure.len() == points.len() || sure.is_empty() {
            return Ok(0);
        }
        let (spline, rest) = self.fit(&sure, progress)?;
        let blocks: BTreeSet<u16> = sure.iter().map(|point| point.block).collect();
        let interval = self.geometry.vertical.interval.abs();
        let mut moved = 0;
        for point in points.iter_mut().filter(|point| point.is_doubtful && blocks.contains(&point.block)) {
            let off = |block: u16| (spline.at(point.place, block) + rest.at(point.place, block) - point.z).abs();
            let own = off(point.block);
            let other = blocks.iter().filter(|block| **block != point.block).map(|block| (off(*block), *block));
            let best = other.min_by(|a, b| a.0.total_cmp(&b.0));
            if let Some((off, block)) = best.filter(|(off, _)| *off < STRAY_SHARE * own)
                && own > STRAY_SAMPLES * interval
                && off < own
            {
                point.block = block;
                moved += 1;
            }
        }
        Ok(moved)
    }

    /// The spline through the points, or evenly chosen ones, and what it leaves between the others.
    fn fit(&self, points: &[BlockPoint], progress: &Progress) -> Result<(BlockSpline, Rest), Cancelled> {
        let chosen = self.chosen(points);
        let through: Vec<Observation> =
            chosen.iter().map(|&n| Observation::point(points[n].place, points[n].block, points[n].z)).collect();
        let mut spline = BlockSpline::through(&through, &BTreeSet::new());
        // Where the blocks lie follows from the fit, what follows from that changes the fit: two rounds settle it.
        for _ in 0..2 {
            progress.check()?;
            let area = self.area(&spline);
            let own_dip = through.iter().map(|o| o.terms[0].1).collect::<BTreeSet<u16>>();
            let own_dip = own_dip.into_iter().filter(|block| holds_a_plane(*block, points, &area)).collect();
            let all: Vec<Observation> = through.iter().cloned().chain(self.ties(&area)).collect();
            spline = BlockSpline::through(&all, &own_dip);
        }
        let left = |point: &BlockPoint| (point.place, point.block, point.z - spline.at(point.place, point.block));
        let rest = match chosen.len() == points.len() {
            true => Rest::none(),
            false => Rest::of(&points.iter().map(left).collect::<Vec<_>>()),
        };
        Ok((spline, rest))
    }

    /// Indices of evenly distributed points, of each block some.
    fn chosen(&self, points: &[BlockPoint]) -> Vec<usize> {
        if points.len() <= MOST_POINTS {
            return (0..points.len()).collect();
        }
        let mut cells = (MOST_POINTS as f64).sqrt();
        loop {
            let mut nearest: BTreeMap<(u16, i64, i64), (f64, usize)> = BTreeMap::new();
            let mut of_block: BTreeMap<u16, Vec<usize>> = BTreeMap::new();
            for (n, point) in points.iter().enumerate() {
                let cell = (point.place * cells).floor();
                let off = (point.place * cells - cell - DVec2::splat(0.5)).length_squared();
                let best = nearest.entry((point.block, cell.x as i64, cell.y as i64)).or_insert((f64::INFINITY, n));
                if off < best.0 {
                    *best = (off, n);
                }
                let first = of_block.entry(point.block).or_default();
                if first.len() < FEWEST_OF_BLOCK {
                    first.push(n);
                }
            }
            let few = of_block.values().filter(|first| first.len() < FEWEST_OF_BLOCK).flatten().copied();
            let chosen: BTreeSet<usize> = nearest.values().map(|(_, n)| *n).chain(few).collect();
            if chosen.len() <= MOST_POINTS || cells < 1.5 {
                return chosen.into_iter().take(MOST_POINTS).collect();
            }
            cells *= 0.9;
        }
    }

    /// The traces of a coarse lattice, and which blocks hold their surface there.
    fn area(&self, spline: &BlockSpline) -> CoarseArea {
        let [nx, ny, _] = self.geometry.size();
        let size = [(nx - 1) / self.step + 1, (ny - 1) / self.step + 1];
        let nodes = (0..size[0] * size[1])
            .into_par_iter()
            .map(|n| {
                let trace = DVec2::new((n / size[1] * self.step) as f64, (n % size[1] * self.step) as f64);
                let place = self.place(trace);
                let held = |(block, z): (u16, f64)| {
                    let p = self.voxel(trace, z);
                    CoarseNode { block, z, is_held: self.faults.holds(block, p) }
                };
                (trace, place, spline.all_at(place).into_iter().map(held).collect())
            })
            .collect();
        CoarseArea { size, nodes }
    }

    /// Where two blocks meet beyond the tips of all faults between them they are one surface.
    fn ties(&self, area: &CoarseArea) -> Vec<Observation> {
        let signatures = self.faults.signatures();
        let mut found: BTreeMap<[u16; 2], Vec<[DVec2; 2]>> = BTreeMap::new();
        let [nu, nv] = area.size;
        for n in 0..nu * nv {
            let (u, v) = (n / nv, n % nv);
            for m in [(u + 1 < nu).then(|| n + nv), (v + 1 < nv).then(|| n + 1)].into_iter().flatten() {
                let ((from, place, own), (to, place_to, _)) = (&area.nodes[n], &area.nodes[m]);
                for node in own.iter().filter(|node| node.is_held) {
                    let beyond = area.nodes[m].2.iter().find(|other| other.block == node.block);
                    let Some(beyond) = beyond.filter(|other| !other.is_held) else { continue };
                    let other = self.faults.block_at(self.voxel(*to, beyond.z));
                    let [a, b] = [node.block, other].map(|block| signatures[usize::from(block)]);
                    let between = (a.bits ^ b.bits) & a.care & b.care;
                    let middle = self.voxel(0.5 * (*from + *to), 0.5 * (node.z + beyond.z)).as_dvec3();
                    let surfaces = self.faults.surfaces().iter().enumerate();
                    let is_virtual = surfaces
                        .filter(|(f, _)| between >> f & 1 == 1)
                        .all(|(_, surface)| surface.extent_at(middle) < 0.0);
                    if between != 0 && is_virtual {
                        let pair = [node.block.min(other), node.block.max(other)];
                        found.entry(pair).or_default().push([*place, *place_to]);
                    }
                }
            }
        }
        let some = |(pair, places): ([u16; 2], Vec<[DVec2; 2]>)| {
            let every = places.len().div_ceil(MOST_TIES / 2).max(1);
            let chosen: Vec<DVec2> = places.into_iter().step_by(every).flatten().collect();
            chosen.into_iter().map(move |place| Observation::tie(place, pair))
        };
        let mut ties: Vec<Observation> = found.into_iter().flat_map(some).collect();
        ties.dedup();
        ties
    }

    /// The sheets, and the middle of each block that has none though the horizon runs into it.
    fn nodes(
        &self,
        points: &[BlockPoint],
        spline: &BlockSpline,
        rest: &Rest,
        outline: &Outline,
        progress: &Progress,
    ) -> Result<(Vec<Sheet>, Vec<[i32; 2]>), Cancelled> {
        let grid = NodeGrid::of_survey(self.geometry);
        let [nu, nv] = grid.count;
        let blocks: Vec<u16> = spline.blocks().collect();
        let around = self.around(points);
        progress.begin("fitting fault blocks", nu as u64);
        // Of each inline: the depths of each block, and traces of blocks without points.
        type Line = (Vec<Vec<(f32, Quality)>>, Vec<(u16, usize)>);
        let line = |u: usize| -> Result<Line, Cancelled> {
            let mut made = vec![vec![(f32::NAN, Quality::Hole); nv]; blocks.len()];
            let mut missed = Vec::new();
            let traces = (0..nv).map(|v| DVec2::new(u as f64, v as f64));
            for (v, trace) in traces.enumerate() {
                let n = u * nv + v;
                let is_inside = outline.inside[n];
                if !is_inside && !blocks.iter().any(|block| around.contains(&(*block, n as u32))) {
                    continue;
                }
                let place = self.place(trace);
                let mut is_held = false;
                let mut lacking = None;
                for (block, z) in spline.all_at(place) {
                    let Some(at) = blocks.iter().position(|other| *other == block) else { continue };
                    let z = z + rest.at(place, block);
                    let p = self.voxel(trace, z);
                    if self.faults.holds(block, p) {
                        is_held = true;
                        let is_near = around.contains(&(block, n as u32));
                        if is_inside || is_near {
                            let quality = if is_inside { Quality::Filled } else { Quality::Extrapolated };
                            made[at][v] = (z as f32, quality);
                        }
                    } else {
                        let other = self.faults.block_at(p);
                        lacking = lacking.or_else(|| (!blocks.contains(&other)).then_some(other));
                    }
                }
                missed.extend(lacking.filter(|_| !is_held && is_inside).map(|block| (block, n)));
            }
            progress.step(1)?;
            Ok((made, missed))
        };
        let lines: Vec<Line> = (0..nu).into_par_iter().map(line).collect::<Result<_, _>>()?;
        let mut sheets: Vec<Sheet> = Vec::new();
        for at in 0..blocks.len() {
            let nodes = || lines.iter().flat_map(|(made, _)| &made[at]);
            sheets.push(Sheet {
                block: None,
                grid,
                depth: nodes().map(|(z, _)| *z).collect(),
                quality: nodes().map(|(_, quality)| *quality).collect(),
            });
        }
        for point in points {
            let near = point.voxel.round();
            let is_inside = near.x >= 0.0 && near.y >= 0.0 && near.x < nu as f64 && near.y < nv as f64;
            let at = blocks.iter().position(|block| *block == point.block);
            if let (true, Some(at)) = (is_inside, at) {
                let n = near.x as usize * nv + near.y as usize;
                if sheets[at].depth[n].is_finite() {
                    sheets[at].quality[n] = Quality::Picked;
                }
            }
        }
        sheets.retain(|sheet| sheet.node_count() > 0);
        let mut missed: BTreeMap<u16, Vec<usize>> = BTreeMap::new();
        for (block, n) in lines.iter().flat_map(|(_, missed)| missed) {
            missed.entry(*block).or_default().push(*n);
        }
        let empty = missed.into_values().map(|traces| {
            let n = traces[traces.len() / 2];
            let lines = self.geometry.lines_from_voxel(DVec2::new((n / nv) as f64, (n % nv) as f64));
            [lines.x.round() as i32, lines.y.round() as i32]
        });
        Ok((sheets, empty.collect()))
    }

    /// The nodes within a few nodes of each block's points.
    fn around(&self, points: &[BlockPoint]) -> HashSet<(u16, u32)> {
        let [nu, nv, _] = self.geometry.size();
        let mut around = HashSet::new();
        let reach = AROUND_POINT as f64;
        let mut counts: HashMap<u16, usize> = HashMap::new();
        points.iter().for_each(|point| *counts.entry(point.block).or_default() += 1);
        for point in points.iter().filter(|point| counts[&point.block] <= FEW_POINTS) {
            let range = |at: f64, count: usize| {
                let (low, high) = ((at - reach).ceil().max(0.0), (at + reach).floor().min(count as f64 - 1.0));
                if high < low { 0..0 } else { low as usize..high as usize + 1 }
            };
            for u in range(point.voxel.x, nu) {
                around.extend(range(point.voxel.y, nv).map(|v| (point.block, (u * nv + v) as u32)));
            }
        }
        around
    }
}

/// The surface of a block at a trace.
struct CoarseNode {
    block: u16,
    z: f64,
    /// Whether it lies in its block there.
    is_held: bool,
}

/// Traces of a coarse lattice, their places, and the surfaces of all blocks there.
struct CoarseArea {
    size: [usize; 2],
    nodes: Vec<(DVec2, DVec2, Vec<CoarseNode>)>,
}

/// Whether a plane through the points of a block is steady everywhere in it: the leverage of its farthest place.
fn holds_a_plane(block: u16, points: &[BlockPoint], area: &CoarseArea) -> bool {
    let own: Vec<DVec2> = points.iter().filter(|point| point.block == block).map(|point| point.place).collect();
    if own.len() < 3 {
        return false;
    }
    let middle = own.iter().sum::<DVec2>() / own.len() as f64;
    let [mut xx, mut xy, mut yy] = [0.0; 3];
    for p in own.iter().map(|p| *p - middle) {
        xx += p.x * p.x;
        xy += p.x * p.y;
        yy += p.y * p.y;
    }
    let determinant = xx * yy - xy * xy;
    if determinant <= 1e-9 * (xx + yy).powi(2) {
        return false;
    }
    let variance = |place: DVec2| {
        let d = place - middle;
        (own.len() as f64).recip() + (d.x * d.x * yy - 2.0 * d.x * d.y * xy + d.y * d.y * xx) / determinant
    };
    let is_held = |nodes: &[CoarseNode]| nodes.iter().any(|node| node.block == block && node.is_held);
    area.nodes.iter().filter(|(.., nodes)| is_held(nodes)).all(|(_, place, _)| variance(*place) <= STEADY)
}

/// The traces between the points: inside triangles of all of them, or of those of one block, with no large circle around.
struct Outline {
    inside: Vec<bool>,
    gap_m: f64,
}

impl Outline {
    fn of(points: &[BlockPoint], geometry: &SurveyGeometry, gap_m: Option<f64>) -> Self {
        let [nu, nv, _] = geometry.size();
        let mut inside = vec![false; nu * nv];
        let mut cover = |voxels: &[DVec2]| {
            let world: Vec<DVec2> = voxels.iter().map(|voxel| world_xy(geometry, *voxel)).collect();
            let triangles = delaunay(&world);
            let gap = gap_m.unwrap_or_else(|| 2.0 * median_side(&world, &triangles));
            for t in triangles.into_iter().filter(|t| circumradius(t.map(|n| world[n])) <= gap) {
                let corners = t.map(|n| voxels[n].extend(0.0));
                raster::triangle(corners, [nu, nv], &mut |u, v, _| inside[u * nv + v] = true);
            }
            gap
        };
        let all: Vec<DVec2> = points.iter().map(|point| point.voxel).collect();
        let gap_m = cover(&all);
        let blocks: BTreeSet<u16> = points.iter().map(|point| point.block).collect();
        for block in blocks {
            let own = points.iter().filter(|point| point.block == block);
            cover(&own.map(|point| point.voxel).collect::<Vec<_>>());
        }
        Self { inside, gap_m }
    }
}

#[cfg(test)]
mod tests;
