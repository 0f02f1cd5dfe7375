//! The faces of a scene's block, cut to the ground, and the lines on them.

use crate::ground::{Ground, mesh_of};
use crate::model::{Block, Face, LineKind};
use crate::polygon::{borders, within};
use glam::{DVec2, DVec3};
use model::StructuralModel;
use model::section::{self, LineQuality, Section, SectionPlane};
use render::Scene;
use render::cover::{RockFace, rock_faces};
use survey::SurveyGeometry;
use survey::block::BodyPlane;

/// Pieces into which an edge is cut where it may run above the ground.
const EDGE_PIECES: usize = 256;
/// How far a line may be from its points, voxels.
const STRAIGHT: f64 = 0.02;
/// How far above the ground a line still lies on it, voxels.
const ON_GROUND: f64 = 0.05;
/// Steps in which a line is asked where it leaves the rock, voxels, and halvings that find the place.
const RUN_STEP: f64 = 0.5;
const HALVINGS: usize = 8;

/// A face whose picture is still to be made.
pub(crate) struct Wanted {
    /// Its plane; absent for the ground.
    pub plane: Option<BodyPlane>,
    /// The rectangle that the picture shows.
    pub rectangle: SectionPlane,
    /// How bright the bare plane of a fault is beside the ground; absent of all else.
    pub shade: Option<f32>,
}

/// The block of a scene without its ground, and the pictures that it needs; faces count them from 0.
pub(crate) fn block_of(
    scene: &Scene,
    geometry: &SurveyGeometry,
    model: Option<&StructuralModel>,
    ground: Option<&Ground>,
) -> (Block, Vec<Wanted>) {
    let (mut block, mut wanted) = (Block::default(), Vec::new());
    let mut walls: Vec<(usize, [DVec3; 2])> = Vec::new();
    for face in rock_faces(scene, geometry) {
        if is_left_out(&face, scene, ground) {
            continue;
        }
        let normal = face.plane.normal.as_dvec3();
        let (mut pieces, mut rims) = (Vec::new(), Vec::new());
        for cell in &face.cells {
            match ground {
                Some(ground) => {
                    let (below, rim) = ground.clip(cell, normal);
                    pieces.extend(below);
                    rims.extend(rim);
                }
                None => pieces.push(cell.clone()),
            }
        }
        if pieces.is_empty() {
            continue;
        }
        let curve = face.plane.wall.and_then(|wall| wall.curve);
        for edge in borders(&face.cells) {
            let is_upright = (edge[0] - edge[1]).truncate().length() < 1e-6;
            match curve.filter(|_| is_upright) {
                Some(curve) => walls.push((curve, edge)),
                None => add_edge(&mut block, edge, ground),
            }
        }
        block.lines.extend(rims.into_iter().map(|rim| (LineKind::Edge, rim)));
        if let Some(model) = model {
            add_lines(&mut block, model, &face, ground);
        }
        let name = name_of(&face, scene, geometry, block.faces.len());
        block.faces.push(Face { cover: wanted.len(), name, mesh: mesh_of(&pieces) });
        wanted.push(Wanted { plane: Some(face.plane), rectangle: face.rectangle, shade: None });
    }
    add_curved(&mut block, &walls, ground);
    (block, wanted)
}

/// The pictures that parts of the ground need: the relief's, and those of bare faults.
pub(crate) fn wanted_ground(
    scene: &Scene,
    geometry: &SurveyGeometry,
    ground: &Ground,
    fault: Option<usize>,
) -> (&'static str, Wanted) {
    let block = scene.box_in(geometry);
    let rectangle = SectionPlane::slice(block.low().z, block.low(), block.high());
    let towards = scene.view(geometry).towards_camera(block.centre());
    match fault {
        None => ("ground", Wanted { plane: None, rectangle, shade: None }),
        Some(fault) => {
            let shade = Some(ground.shade(fault, towards));
            ("bare fault", Wanted { plane: None, rectangle, shade })
        }
    }
}

/// The top where the ground takes its place, and the underside unless the camera looks up at it.
fn is_left_out(face: &RockFace, scene: &Scene, ground: Option<&Ground>) -> bool {
    if face.plane.axis != Some(2) {
        return false;
    }
    let is_box = |at: f64| (face.rectangle.origin.z - at).abs() < 1e-6;
    let is_underside = face.rock.z < 0.0 && scene.camera.elevation_deg >= 0.0;
    let is_top =
        face.rock.z > 0.0 && scene.roaming_box.map_or(0.0, |block| block.min[2]) + 1e-6 > face.rectangle.origin.z;
    is_underside || (is_top && is_box(face.rectangle.origin.z) && ground.is_some())
}

/// What a face is called, by its line numbers where it has them.
fn name_of(face: &RockFace, scene: &Scene, geometry: &SurveyGeometry, index: usize) -> String {
    let block = scene.box_in(geometry);
    let at = face.rectangle.origin;
    let kind = |axis: usize| {
        let is_side = (at[axis] - block.min[axis]).abs() < 1e-6 || (at[axis] - block.max[axis]).abs() < 1e-6;
        if is_side { "side" } else { "wall of a cut-out" }
    };
    match face.plane.axis {
        Some(0) => format!("{}, inline {:.0}", kind(0), geometry.inlines.number_at(at.x)),
        Some(1) => format!("{}, crossline {:.0}", kind(1), geometry.crosslines.number_at(at.y)),
        Some(_) => {
            let vertical = &geometry.vertical;
            format!("slice at {:.0} {}", vertical.value_at(at.z), vertical.unit.symbol())
        }
        None => format!("wall {}", index + 1),
    }
}

/// Adds the parts of an edge that are not in the air.
fn add_edge(block: &mut Block, [a, b]: [DVec3; 2], ground: Option<&Ground>) {
    let Some(ground) = ground else {
        block.lines.push((LineKind::Edge, [a, b]));
        return;
    };
    let mut from = None;
    for n in 0..=EDGE_PIECES {
        let p = a.lerp(b, n as f64 / EDGE_PIECES as f64);
        let is_rock = ground.is_rock(p + DVec3::Z * ON_GROUND);
        match (from, is_rock) {
            (None, true) => from = Some(p),
            (Some(start), false) => {
                block.lines.push((LineKind::Edge, [start, p]));
                from = None;
            }
            _ => {}
        }
    }
    if let Some(start) = from {
        block.lines.push((LineKind::Edge, [start, b]));
    }
}

/// Upright edges of walls of a curve are drawn where the curve begins and ends, not between its planes.
fn add_curved(block: &mut Block, walls: &[(usize, [DVec3; 2])], ground: Option<&Ground>) {
    let foot = |edge: &[DVec3; 2]| edge[0].truncate();
    for (n, (curve, edge)) in walls.iter().enumerate() {
        let twin = |(m, (other, its)): (usize, &(usize, [DVec3; 2]))| {
            m != n && other == curve && foot(its).distance(foot(edge)) < 1e-4
        };
        if !walls.iter().enumerate().any(twin) {
            add_edge(block, *edge, ground);
        }
    }
}

/// Adds the horizons and faults on a face.
fn add_lines(block: &mut Block, model: &StructuralModel, face: &RockFace, ground: Option<&Ground>) {
    let normal = face.plane.normal.as_dvec3();
    for (kind, ends) in lines_on(model, &face.rectangle) {
        for part in face.cells.iter().filter_map(|cell| within(ends, cell, normal)) {
            match ground {
                None => block.lines.push((kind, part)),
                Some(ground) => {
                    let runs = runs(part, |p| ground.is_rock(p + DVec3::Z * ON_GROUND));
                    block.lines.extend(runs.into_iter().map(|run| (kind, run)));
                }
            }
        }
    }
}

/// The runs of a straight line on which something holds, found at steps of [`RUN_STEP`] and then by halving.
fn runs([from, to]: [DVec3; 2], holds: impl Fn(DVec3) -> bool) -> Vec<[DVec3; 2]> {
    let steps = ((to - from).length() / RUN_STEP).ceil().max(1.0) as usize;
    let at = |n: usize| from.lerp(to, n as f64 / steps as f64);
    let held: Vec<bool> = (0..=steps).map(|n| holds(at(n))).collect();
    let end = |mut inside: DVec3, mut outside: DVec3| {
        for _ in 0..HALVINGS {
            let middle = (inside + outside) * 0.5;
            if holds(middle) { inside = middle } else { outside = middle }
        }
        inside
    };
    let mut runs = Vec::new();
    let mut start = held[0].then_some(from);
    for n in 1..=steps {
        match (held[n - 1], held[n]) {
            (false, true) => start = Some(end(at(n), at(n - 1))),
            (true, false) => runs.extend(start.take().map(|start| [start, end(at(n - 1), at(n))])),
            _ => {}
        }
    }
    runs.extend(start.map(|start| [start, to]));
    runs
}

/// The horizons and faults on a rectangle.
pub(crate) fn lines_on(model: &StructuralModel, rectangle: &SectionPlane) -> Vec<(LineKind, [DVec3; 2])> {
    let mut lines = Vec::new();
    for line in &Section::new(model, rectangle).lines {
        let kind = match line.kind {
            section::LineKind::Fault { real: true, .. } => LineKind::Fault,
            section::LineKind::Fault { .. } => LineKind::Horizon { is_picked: true },
            section::LineKind::Horizon { .. } => LineKind::Horizon { is_picked: line.quality == LineQuality::Certain },
            section::LineKind::Frame => continue,
        };
        let points: Vec<DVec3> = straightened(&line.points).into_iter().map(|st| rectangle.voxel(st)).collect();
        lines.extend(points.windows(2).map(|ends| (kind, [ends[0], ends[1]])));
    }
    lines
}

/// A polyline without the points that lie on the way between others, but for [`STRAIGHT`].
fn straightened(points: &[DVec2]) -> Vec<DVec2> {
    let mut kept: Vec<DVec2> = points.first().copied().into_iter().collect();
    let mut from = 0;
    for to in 2..points.len() {
        let along = (points[to] - points[from]).normalize_or_zero();
        let off = |p: &DVec2| along.perp_dot(*p - points[from]).abs();
        if points[from + 1..to].iter().any(|p| off(p) > STRAIGHT) || along == DVec2::ZERO {
            from = to - 1;
            kept.push(points[from]);
        }
    }
    kept.extend(points.last().filter(|_| points.len() > 1));
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_has_the_runs_that_lie_in_rock() {
        let whole = [DVec3::ZERO, DVec3::X * 10.0];
        let found = runs(whole, |p| (2.3..4.1).contains(&p.x) || p.x > 7.7);
        let ends: Vec<f64> = found.iter().flatten().map(|p| p.x).collect();
        let expected = [2.3, 4.1, 7.7, 10.0];
        assert_eq!(ends.len(), 4, "{ends:?}");
        assert!(ends.iter().zip(expected).all(|(a, b)| (a - b).abs() < 0.01), "{ends:?}");
        assert_eq!(runs(whole, |_| true), [whole]);
        assert!(runs(whole, |_| false).is_empty());
    }
}
