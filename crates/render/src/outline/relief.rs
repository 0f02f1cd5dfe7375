//! Lines on the ground: fault traces, contacts where horizons and bodies come to the surface, and the crests behind which
//! the ground disappears.
//!
//! All are zero contours on the map of the ground h(x, y) of one block: of the signed distance to the fault or the horizon
//! at (x, y, h), and of (∂h/∂x, ∂h/∂y, −1)·d, where d is the viewing direction. They are found in cells of one voxel
//! (marching squares), those of distances refined on the ground itself.

use super::NOMINAL_SIDE_PX;
use super::hidden::{IN_FRONT, covered_by, seen_parts};
use crate::ground::{air_layer, is_air};
use crate::resolved_scene::{ResolvedInterpretation, ResolvedScene};
use glam::{DVec2, DVec3, I64Vec2, Vec3};
use model::LevelSurface;
use rayon::prelude::*;
use std::collections::HashMap;
use std::sync::Arc;

/// How far from a fault the ground of its block is tested, voxels: far enough to meet the rock below an
/// overhanging scarp.
const INTO_BLOCK: f64 = 0.3;
/// How far beside a line the blocks on its sides are looked up, voxels: farther than a curved fault deviates
/// from its chord over one cell.
const ACROSS: f64 = 0.12;

/// How far before a fault's trace rock hides it, voxels.
const JUST_BEFORE: f64 = 0.1;

/// How far outside a surface rays test its silhouette, voxels: one just inside meets the surface long before.
const BESIDE_SURFACE: f64 = 0.25;
/// Shortest crest that is drawn, in line widths.
const SHORTEST_CREST: f64 = 24.0;
/// Gaps in a fault's trace that are no wider than this are closed, in line widths: ground that hides so little of it looks
/// like a broken line.
const WIDEST_GAP: f64 = 2.0;
/// Ends of lines closer than about this are joined, pixels; each cell computes them once.
const MEETING_PX: f64 = 0.5;

/// Steps by which the end of a segment is refined.
const ROOT_STEPS: usize = 5;

/// A corner of a cell, in nodes, and a function's value there.
type Corner = (DVec2, f64);

/// Visible parts of the lines on the ground, pixels.
#[derive(Debug, Default)]
pub(super) struct ReliefLines {
    /// Index of the fault, and a part of its trace.
    pub faults: Vec<(usize, Vec<DVec2>)>,
    /// Index of the horizon, and a part of the line at which it comes to the surface.
    pub contacts: Vec<(usize, Vec<DVec2>)>,
    pub crests: Vec<Vec<DVec2>>,
}

/// Heights of the ground of one block at the corners of cells.
struct Map<'a> {
    interpretation: ResolvedInterpretation<'a>,
    block: u16,
    low: DVec3,
    counts: [usize; 2],
    step: DVec2,
    /// Heights at the nodes, and one beyond the last along each axis.
    heights: Arc<Vec<f32>>,
}

impl Map<'_> {
    fn xy(&self, node: DVec2) -> DVec2 {
        self.low.truncate() + node * self.step
    }

    fn ground(&self, node: DVec2) -> DVec3 {
        let xy = self.xy(node);
        let z = self.interpretation.model.horizon_z(0, self.block, xy.x as f32, xy.y as f32);
        xy.extend(f64::from(z))
    }

    /// The ground at a node.
    fn node(&self, [x, y]: [usize; 2]) -> DVec3 {
        self.xy(DVec2::new(x as f64, y as f64)).extend(f64::from(self.heights[x * (self.counts[1] + 2) + y]))
    }

    /// Segments on which a function of places is zero on the ground. Their ends are refined on the ground itself, which may
    /// bend within a cell.
    fn zeros_on_ground(&self, f: impl Fn(DVec3) -> f64 + Sync) -> Vec<[DVec3; 2]> {
        let root = |[(mut a, mut at_a), (mut b, mut at_b)]: [Corner; 2]| {
            // Regula falsi; the value of an end that stays is halved (the Illinois rule).
            for _ in 0..ROOT_STEPS {
                let middle = a.lerp(b, at_a / (at_a - at_b));
                let at = f(self.ground(middle));
                if (at >= 0.0) == (at_a >= 0.0) {
                    (a, at_a, at_b) = (middle, at, 0.5 * at_b);
                } else {
                    (b, at_b, at_a) = (middle, at, 0.5 * at_a);
                }
                if at == 0.0 {
                    return middle;
                }
            }
            a.lerp(b, at_a / (at_a - at_b))
        };
        self.zero_lines(|node| f(self.node(node)), root)
    }

    /// Segments on which a function on the map is zero, as points on the ground; `root` finds the zero between two corners.
    fn zero_lines(&self, f: impl Fn([usize; 2]) -> f64 + Sync, root: impl Fn([Corner; 2]) -> DVec2) -> Vec<[DVec3; 2]> {
        let [nx, ny] = self.counts;
        let values: Vec<f64> =
            (0..(nx + 1) * (ny + 1)).into_par_iter().map(|n| f([n / (ny + 1), n % (ny + 1)])).collect();
        let mut segments = Vec::new();
        for x in 0..nx {
            for y in 0..ny {
                let corners = [[0, 0], [1, 0], [1, 1], [0, 1]]
                    .map(|[a, b]| (DVec2::new((x + a) as f64, (y + b) as f64), values[(x + a) * (ny + 1) + y + b]));
                let mut cuts = Vec::new();
                for n in 0..4 {
                    let ends = [corners[n], corners[(n + 1) % 4]];
                    if (ends[0].1 >= 0.0) != (ends[1].1 >= 0.0) {
                        cuts.push(root(ends));
                    }
                }
                for pair in cuts.chunks_exact(2) {
                    segments.push([self.ground(pair[0]), self.ground(pair[1])]);
                }
            }
        }
        segments
    }
}

/// The lines on the ground of a scene.
pub(super) fn relief_lines(resolved: &ResolvedScene) -> ReliefLines {
    let mut lines = ReliefLines::default();
    let (Some(_), Some(interpretation)) = (&resolved.relief, resolved.interpretation) else { return lines };
    let [low, high] = resolved.solid.roaming_box.map(|c| c.as_dvec3());
    let counts = [0, 1].map(|axis: usize| (high[axis] - low[axis]).ceil().max(1.0) as usize);
    let step = (high - low).truncate() / DVec2::new(counts[0] as f64, counts[1] as f64);
    let scale = f64::from(resolved.scene.size_px[0].min(resolved.scene.size_px[1])) / f64::from(NOMINAL_SIDE_PX);
    let shortest = SHORTEST_CREST * f64::from(resolved.scene.outlines.horizons.width_px) * scale;
    let widest = WIDEST_GAP * f64::from(resolved.scene.outlines.faults.width_px) * scale;
    for block in 0..interpretation.model.block_count() as u16 {
        let key = |fault: usize| ([low.x, low.y, low.z, high.x, high.y, high.z].map(f64::to_bits), block, fault);
        let heights = resolved.shapes.heights(key(0), || {
            let nodes = (0..(counts[0] + 2) * (counts[1] + 2)).into_par_iter();
            let height = |n: usize| {
                let node = DVec2::new((n / (counts[1] + 2)) as f64, (n % (counts[1] + 2)) as f64);
                let xy = (low.truncate() + node * step).as_vec2();
                interpretation.model.horizon_z(0, block, xy.x, xy.y)
            };
            nodes.map(height).collect()
        });
        let map = Map { interpretation, block, low, counts, step, heights };
        for fault in 0..interpretation.model.faults().surfaces().len() {
            let side = |p: DVec3| f64::from(interpretation.model.faults().side(fault, p.as_vec3()));
            let segments = resolved.shapes.traces(key(fault), || map.zeros_on_ground(side));
            let traces = seen(resolved, interpretation, &segments, |p| beside_fault(resolved, fault, block, p));
            lines.faults.extend(bridged(traces, widest).into_iter().map(|trace| (fault, trace)));
        }
        let faults = interpretation.model.faults().surfaces().len();
        for horizon in 1..usize::from(air_layer(interpretation.model)) {
            let offset = |p: DVec3| f64::from(interpretation.model.offset(horizon, block, p.as_vec3()));
            let segments = resolved.shapes.traces(key(faults + horizon), || map.zeros_on_ground(offset));
            let lines_of = seen(resolved, interpretation, &segments, |p| {
                interpretation.model.crops_out_at(horizon, p.as_vec3(), block).then_some(p)
            });
            lines.contacts.extend(without_specks(lines_of, shortest).into_iter().map(|line| (horizon, line)));
        }
        let facing = |[x, y]: [usize; 2]| {
            let p = map.node([x, y]);
            let (dx, dy) = (map.node([x + 1, y]) - p, map.node([x, y + 1]) - p);
            dx.cross(dy).dot(resolved.view.towards_camera(p))
        };
        let from_map = interpretation.model.level(0, block).is_none();
        let straight = |[(a, at_a), (b, at_b)]: [Corner; 2]| a.lerp(b, at_a / (at_a - at_b));
        let segments = if from_map { map.zero_lines(facing, straight) } else { Vec::new() };
        lines.crests.extend(seen(resolved, interpretation, &segments, |p| {
            (interpretation.model.block_at(p.as_vec3()) == block).then_some(p)
        }));
        for level in
            (0..usize::from(air_layer(interpretation.model))).filter_map(|n| interpretation.model.level(n, block))
        {
            lines.crests.extend(silhouette(resolved, interpretation, level, block));
        }
    }
    lines.crests = without_specks(lines.crests, shortest);
    lines
}

/// Where a surface of any shape that stands out of the ground, or is the ground, hides what is behind it.
fn silhouette(
    resolved: &ResolvedScene,
    interpretation: ResolvedInterpretation,
    level: &LevelSurface,
    block: u16,
) -> Vec<Vec<DVec2>> {
    let model = interpretation.model;
    let [low, high] = resolved.solid.roaming_box;
    let towards = |p: Vec3| resolved.view.towards_camera(p.as_dvec3()).as_vec3();
    let is_seen = |p: DVec3| {
        let inwards = level.inwards(p.as_vec3()).as_dvec3() * BESIDE_SURFACE;
        let (outside, inside) = ((p - inwards).as_vec3(), (p + inwards).as_vec3());
        p.clamp(low.as_dvec3(), high.as_dvec3()) == p
            && !cut_away(resolved, p)
            && model.block_at(outside) == block
            && is_air(model, outside)
            && !is_air(model, inside)
            && covered_by(resolved, p - inwards) < IN_FRONT
    };
    let segments = level.silhouette(low, high, towards).into_par_iter().map(|ends| ends.map(|end| end.as_dvec3()));
    segments.flat_map_iter(|segment| seen_parts(&resolved.view, &segment, is_seen)).collect()
}

/// The lines, and straight ones across gaps of no more than `widest` pixels between ends that meet no other line.
fn bridged(mut lines: Vec<Vec<DVec2>>, widest: f64) -> Vec<Vec<DVec2>> {
    let mut ends: Vec<DVec2> = lines.iter().flat_map(|line| [line.first(), line.last()]).flatten().copied().collect();
    ends.sort_by(|a, b| a.x.total_cmp(&b.x));
    let is_near = |a: usize, b: usize| ends[a].x - ends[b].x < MEETING_PX && ends[a].distance(ends[b]) < MEETING_PX;
    let meets = |n: &usize| {
        let before = (0..*n).rev().take_while(|m| ends[*n].x - ends[*m].x < MEETING_PX).any(|m| is_near(*n, m));
        before || (*n + 1..ends.len()).take_while(|m| ends[*m].x - ends[*n].x < MEETING_PX).any(|m| is_near(m, *n))
    };
    let mut loose: Vec<DVec2> = (0..ends.len()).filter(|n| !meets(n)).map(|n| ends[n]).collect();
    while let Some(end) = loose.pop() {
        let nearest = (0..loose.len()).min_by(|a, b| end.distance(loose[*a]).total_cmp(&end.distance(loose[*b])));
        if let Some(nearest) = nearest.filter(|n| end.distance(loose[*n]) <= widest) {
            lines.push(vec![end, loose.swap_remove(nearest)]);
        }
    }
    lines
}

/// Removes lines that are, together with all lines that meet them, shorter than `shortest` pixels. If the
/// relief is rough on a scale finer than the line width, its crests look like dirt.
fn without_specks(lines: Vec<Vec<DVec2>>, shortest: f64) -> Vec<Vec<DVec2>> {
    let length = |line: &Vec<DVec2>| line.windows(2).map(|ends| (ends[1] - ends[0]).length()).sum::<f64>();
    let mut group: Vec<usize> = (0..lines.len()).collect();
    let mut ends: HashMap<I64Vec2, usize> = HashMap::new();
    for (index, line) in lines.iter().enumerate() {
        for end in [line.first(), line.last()].into_iter().flatten() {
            let place = (*end / MEETING_PX).round().as_i64vec2();
            for near in (0..9).map(|n| place + I64Vec2::new(n / 3 - 1, n % 3 - 1)) {
                if let Some(&other) = ends.get(&near) {
                    let (one, other) = (first_of(&mut group, index), first_of(&mut group, other));
                    group[one.max(other)] = one.min(other);
                }
            }
            ends.insert(place, index);
        }
    }
    let mut lengths = vec![0.0; lines.len()];
    for (index, line) in lines.iter().enumerate() {
        lengths[first_of(&mut group, index)] += length(line);
    }
    let whole: Vec<bool> = (0..lines.len()).map(|index| lengths[first_of(&mut group, index)] >= shortest).collect();
    lines.into_iter().zip(whole).filter_map(|(line, whole)| whole.then_some(line)).collect()
}

/// The first line of the group of a line; shortens the path to it (union–find).
fn first_of(group: &mut [usize], mut index: usize) -> usize {
    while group[index] != index {
        group[index] = group[group[index]];
        index = group[index];
    }
    index
}

/// A point on the ground of the block right beside the interpreted part of a fault; `None` if the fault does
/// not end that ground, or the other side of the fault stands before it: of a scarp that faces away the upper edge alone
/// is seen, however low the scarp is.
fn beside_fault(resolved: &ResolvedScene, fault: usize, block: u16, p: DVec3) -> Option<DVec3> {
    let interpretation = resolved.interpretation?;
    let faults = interpretation.model.faults();
    if !faults.is_real(fault, p.as_vec3()) || interpretation.model.is_pierced_at(p.as_vec3(), block) {
        return None;
    }
    let surface = &faults.surfaces()[fault];
    let normal = surface.frame_from_voxel.row(2).normalize();
    // The straight piece of a trace lies a little beside a curved fault.
    let gradient = surface.side_gradient(p);
    let p = p - gradient * (surface.side(p) / gradient.length_squared());
    let holds_block = |aside: f64| interpretation.model.block_at((p + normal * aside).as_vec3()) == block;
    let inwards = match (holds_block(ACROSS), holds_block(-ACROSS)) {
        (true, false) => normal,
        (false, true) => -normal,
        _ => return None,
    };
    let foot = p.with_z(interpretation.model.horizon_z(0, block, p.x as f32, p.y as f32).into());
    let before = foot + resolved.view.towards_camera(foot).normalize_or_zero() * JUST_BEFORE;
    if !is_air(interpretation.model, before.as_vec3()) {
        return None;
    }
    let q = p + inwards * INTO_BLOCK;
    Some(q.with_z(interpretation.model.horizon_z(0, block, q.x as f32, q.y as f32).into()))
}

/// The parts of segments that lie on ground that is drawn, with nothing in front. `ground` returns the point
/// on the ground of the block for a point of the line.
fn seen(
    resolved: &ResolvedScene,
    interpretation: ResolvedInterpretation,
    segments: &[[DVec3; 2]],
    ground: impl Fn(DVec3) -> Option<DVec3> + Sync,
) -> Vec<Vec<DVec2>> {
    let [low, high] = resolved.solid.roaming_box.map(|c| c.as_dvec3());
    let is_seen = |p: DVec3| {
        p.z >= low.z
            && p.z <= high.z
            && !cut_away(resolved, p)
            && ground(p).is_some_and(|q| !is_air(interpretation.model, (q + DVec3::Z * 0.1).as_vec3()))
            && covered_by(resolved, p) < IN_FRONT
    };
    segments.par_iter().flat_map_iter(|segment| seen_parts(&resolved.view, segment, is_seen)).collect()
}

fn cut_away(resolved: &ResolvedScene, p: DVec3) -> bool {
    let p = p.as_vec3();
    resolved.solid.cut_outs.iter().any(|cut| cut.holds_or_touches(p))
}

#[cfg(test)]
mod tests;
