//! Edges to lines: tagged edges between different regions, chained.

use super::clip::{Edge, Tag};
use super::plane::SectionPlane;
use super::{LineKind, LineQuality, SectionLine};
use crate::horizon::Quality;
use crate::model::StructuralModel;
use glam::{DVec2, DVec3};
use std::collections::{BTreeMap, HashMap};

/// The tip of a fault is found on its line to this fraction of an edge.
const TIP_STEPS: usize = 30;

/// Whether `edge` is part of a fault where it was interpreted.
pub(super) fn is_real_fault(model: &StructuralModel, plane: &SectionPlane, positions: &[DVec2], edge: &Edge) -> bool {
    let Tag::Fault { fault, .. } = edge.tag else { return false };
    model.faults().surfaces()[usize::from(fault)].extent_at(middle(plane, positions, edge)) >= 0.0
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
    let mut groups: BTreeMap<(LineKind, LineQuality), Vec<[u32; 2]>> = BTreeMap::new();
    for edge in edges {
        // Each boundary once, from the side that comes first.
        let Some(other) = on_left.get(&(edge.to, edge.from)) else { continue };
        if edge.region > other.region {
            continue;
        }
        match edge.tag {
            Tag::Inner | Tag::Frame => {}
            Tag::Horizon { horizon } => {
                let horizon = usize::from(horizon);
                let p = middle(plane, &positions, edge).as_vec3();
                let quality = match model.quality_at(horizon, edge.region.block, p.x, p.y) {
                    Quality::Picked | Quality::Tracked => LineQuality::Certain,
                    Quality::Filled => LineQuality::Approximate,
                    Quality::Extrapolated | Quality::Hole => LineQuality::Inferred,
                };
                groups.entry((LineKind::Horizon { horizon }, quality)).or_default().push([edge.from, edge.to]);
            }
            Tag::Fault { fault, .. } => {
                let fault = usize::from(fault);
                let mut add = |real: bool, ends: [u32; 2]| {
                    if real || edge.region.layer != other.region.layer {
                        let kind = LineKind::Fault { fault, real };
                        groups.entry((kind, LineQuality::Certain)).or_default().push(ends);
                    }
                };
                let surface = &model.faults().surfaces()[fault];
                let extent = |p: DVec2| surface.extent_at(plane.voxel(p));
                let [a, b] = [edge.from, edge.to].map(|v| positions[v as usize]);
                let real = [extent(a) >= 0.0, extent(b) >= 0.0];
                if real[0] == real[1] {
                    add(real[0], [edge.from, edge.to]);
                } else {
                    let (mut low, mut high) = (0.0, 1.0);
                    for _ in 0..TIP_STEPS {
                        let t = 0.5 * (low + high);
                        if (extent(a.lerp(b, t)) >= 0.0) == real[0] { low = t } else { high = t }
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
    for ((kind, quality), edges) in groups {
        out.extend(chains(&edges, &positions).into_iter().map(|points| SectionLine { kind, quality, points }));
    }
    out.push(SectionLine { kind: LineKind::Frame, quality: LineQuality::Certain, points: frame.into() });
    out
}

/// Joins edges end to end into the longest chains that do not branch.
fn chains(edges: &[[u32; 2]], positions: &[DVec2]) -> Vec<Vec<DVec2>> {
    let mut at: HashMap<u32, Vec<usize>> = HashMap::new();
    for (i, ends) in edges.iter().enumerate() {
        for v in ends {
            at.entry(*v).or_default().push(i);
        }
    }
    let mut used = vec![false; edges.len()];
    let mut out = Vec::new();
    let mut walk = |first: usize, from: u32| {
        let mut points = vec![positions[from as usize]];
        let (mut current, mut v) = (first, from);
        while !used[current] {
            used[current] = true;
            v = if edges[current][0] == v { edges[current][1] } else { edges[current][0] };
            if points.last() != Some(&positions[v as usize]) {
                points.push(positions[v as usize]);
            }
            match at[&v].as_slice() {
                [a, b] => current = if *a == current { *b } else { *a },
                _ => break,
            }
        }
        if points.len() > 1 {
            out.push(points);
        }
    };
    // Open chains from their ends and branches first, then what is left: closed ones.
    for (i, ends) in edges.iter().enumerate() {
        for &v in ends {
            if at[&v].len() != 2 {
                walk(i, v);
            }
        }
    }
    for (i, ends) in edges.iter().enumerate() {
        walk(i, ends[0]);
    }
    out
}
