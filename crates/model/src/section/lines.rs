//! From edges to lines: the tagged edges between different regions are chained.

use super::clip::{Edge, Tag};
use super::plane::SectionPlane;
use super::{LineKind, LineQuality, SectionLine};
use crate::StructuralModel;
use glam::{DVec2, DVec3};
use std::collections::{BTreeMap, HashMap};
use survey::horizon::Quality;

/// Halvings that find the tip of a fault on an edge of its line.
const TIP_STEPS: usize = 30;
/// A change of quality over less than this along a line is not shown, voxels: gridded picks change at every
/// node.
const SHORTEST_RUN: f64 = 8.0;

/// Whether `edge` is part of a fault where it was interpreted.
pub(super) fn is_real_fault(model: &StructuralModel, plane: &SectionPlane, positions: &[DVec2], edge: &Edge) -> bool {
    let Tag::Fault { fault, .. } = edge.tag else { return false };
    if is_in_body(model, edge) {
        return false;
    }
    model.faults().surfaces()[usize::from(fault)].is_interpreted_at(middle(plane, positions, edge))
}

/// Whether an edge lies in a body, which cuts the faults, too.
fn is_in_body(model: &StructuralModel, edge: &Edge) -> bool {
    let top = model.stratigraphy().top_of(usize::from(edge.region.layer));
    top.is_some_and(|top| model.is_body(top))
}

fn middle(plane: &SectionPlane, positions: &[DVec2], edge: &Edge) -> DVec3 {
    plane.voxel(positions[edge.from as usize].midpoint(positions[edge.to as usize]))
}

/// All lines of a section from the edges between its regions.
pub(super) fn lines(
    model: &StructuralModel,
    plane: &SectionPlane,
    edges: &[Edge],
    positions: &[DVec2],
) -> Vec<SectionLine> {
    let on_left: HashMap<(u32, u32), &Edge> = edges.iter().map(|e| ((e.from, e.to), e)).collect();
    let mut positions = positions.to_vec();
    let mut groups: BTreeMap<LineKind, Vec<([u32; 2], LineQuality)>> = BTreeMap::new();
    for edge in edges {
        // Each boundary once, from the side that comes first.
        let Some(other) = on_left.get(&(edge.to, edge.from)) else { continue };
        if edge.region > other.region {
            continue;
        }
        match edge.tag {
            Tag::Inner | Tag::Frame => {}
            Tag::Fault { .. } if is_in_body(model, edge) && is_in_body(model, other) => {}
            Tag::Horizon { horizon } => {
                let horizon = usize::from(horizon);
                let p = middle(plane, &positions, edge).as_vec3();
                let quality = match model.quality_at(horizon, edge.region.block, p.x, p.y) {
                    Quality::Picked | Quality::Tracked | Quality::Snapped => LineQuality::Certain,
                    Quality::Filled => LineQuality::Approximate,
                    Quality::Extrapolated | Quality::Hole => LineQuality::Inferred,
                };
                groups.entry(LineKind::Horizon { horizon }).or_default().push(([edge.from, edge.to], quality));
            }
            Tag::Fault { fault, .. } => {
                let fault = usize::from(fault);
                let mut add = |real: bool, ends: [u32; 2]| {
                    if real || edge.region.layer != other.region.layer {
                        let kind = LineKind::Fault { fault, real };
                        groups.entry(kind).or_default().push((ends, LineQuality::Certain));
                    }
                };
                let surface = &model.faults().surfaces()[fault];
                let is_real = |p: DVec2| surface.is_interpreted_at(plane.voxel(p));
                let [a, b] = [edge.from, edge.to].map(|v| positions[v as usize]);
                let real = [is_real(a), is_real(b)];
                if real[0] == real[1] {
                    add(real[0], [edge.from, edge.to]);
                } else {
                    let (mut low, mut high) = (0.0, 1.0);
                    for _ in 0..TIP_STEPS {
                        let t = 0.5 * (low + high);
                        if is_real(a.lerp(b, t)) == real[0] { low = t } else { high = t }
                    }
                    let tip = positions.len() as u32;
                    positions.push(a.lerp(b, low));
                    add(real[0], [edge.from, tip]);
                    add(real[1], [tip, edge.to]);
                }
            }
        }
    }
    let [s, t] = plane.extent;
    let frame = [DVec2::ZERO, DVec2::new(s, 0.0), DVec2::new(s, t), DVec2::new(0.0, t), DVec2::ZERO];
    let mut out = Vec::new();
    let voxel = plane.s_axis.length().max(plane.t_axis.length());
    for (kind, edges) in groups {
        for chain in chains(&edges) {
            out.extend(runs(&chain, &positions, voxel).into_iter().map(|(quality, points)| SectionLine {
                kind,
                quality,
                points,
            }));
        }
    }
    out.push(SectionLine { kind: LineKind::Frame, quality: LineQuality::Certain, points: frame.into() });
    out
}

/// Vertices in order, each with the quality of the edge that leads to it (the first one's is not used).
type Chain = Vec<(u32, LineQuality)>;

/// Joins edges end to end into the longest chains that do not branch.
fn chains(edges: &[([u32; 2], LineQuality)]) -> Vec<Chain> {
    let mut at: HashMap<u32, Vec<usize>> = HashMap::new();
    for (i, (ends, _)) in edges.iter().enumerate() {
        for v in ends {
            at.entry(*v).or_default().push(i);
        }
    }
    let mut used = vec![false; edges.len()];
    let mut out = Vec::new();
    let mut walk = |first: usize, from: u32| {
        let mut chain = vec![(from, edges[first].1)];
        let (mut current, mut v) = (first, from);
        while !used[current] {
            used[current] = true;
            let (ends, quality) = edges[current];
            v = if ends[0] == v { ends[1] } else { ends[0] };
            chain.push((v, quality));
            match at[&v].as_slice() {
                [a, b] => current = if *a == current { *b } else { *a },
                _ => break,
            }
        }
        if chain.len() > 1 {
            out.push(chain);
        }
    };
    // Open chains from their ends and branches first, then what is left: closed ones.
    for (i, (ends, _)) in edges.iter().enumerate() {
        for &v in ends {
            if at[&v].len() != 2 {
                walk(i, v);
            }
        }
    }
    for (i, (ends, _)) in edges.iter().enumerate() {
        walk(i, ends[0]);
    }
    out
}

/// Divides a chain where its quality changes, short changes apart.
fn runs(chain: &Chain, positions: &[DVec2], voxel: f64) -> Vec<(LineQuality, Vec<DVec2>)> {
    let at = |i: usize| positions[chain[i].0 as usize];
    // (quality, first edge, length); edge i leads from vertex i to i + 1.
    let mut runs: Vec<(LineQuality, usize, f64)> = Vec::new();
    for i in 0..chain.len() - 1 {
        let (quality, length) = (chain[i + 1].1, voxel * at(i).distance(at(i + 1)));
        match runs.last_mut() {
            Some(run) if run.0 == quality => run.2 += length,
            _ => runs.push((quality, i, length)),
        }
    }
    // The shortest run takes the quality of its longer neighbour, until none is too short.
    while runs.len() > 1 {
        let shortest = (0..runs.len()).min_by(|&i, &j| runs[i].2.total_cmp(&runs[j].2)).unwrap_or(0);
        if runs[shortest].2 >= SHORTEST_RUN {
            break;
        }
        let before = shortest.checked_sub(1).map(|i| runs[i]);
        let after = runs.get(shortest + 1).copied();
        let longer = [before, after].into_iter().flatten().max_by(|a, b| a.2.total_cmp(&b.2));
        runs[shortest].0 = longer.map_or(runs[shortest].0, |r| r.0);
        let mut merged: Vec<(LineQuality, usize, f64)> = Vec::with_capacity(runs.len());
        for run in runs {
            match merged.last_mut() {
                Some(last) if last.0 == run.0 => last.2 += run.2,
                _ => merged.push(run),
            }
        }
        runs = merged;
    }
    let ends = runs.iter().skip(1).map(|r| r.1).chain([chain.len() - 1]);
    let mut out = Vec::with_capacity(runs.len());
    for (run, end) in runs.iter().zip(ends) {
        let mut points: Vec<DVec2> = (run.1..=end).map(at).collect();
        points.dedup();
        if points.len() > 1 {
            out.push((run.0, points));
        }
    }
    out
}
