//! Collects the lines of a picture from sections and edges, and strokes them.

use super::dash::{APPROXIMATE, INFERRED, dashed};
use super::hidden::{ASIDE, IN_FRONT, covered_by, is_seen, seen_parts};
use super::relief::relief_lines;
use super::solid::{EdgeLine, Face, edge_lines, faces};
use super::stroke::stroke_lines;
use super::underlay::underlay;
use super::{NOMINAL_SIDE_PX, Unpicked};
use crate::ground::{air_layer, is_air};
use crate::media::Faces;
use crate::resolved_scene::{ResolvedInterpretation, ResolvedScene};
use glam::{DVec2, DVec3};
use image::RgbaImage;
use model::section::{LineKind, LineQuality, SectionPlane};
use rayon::prelude::*;

/// Visible lines by kind, pixels.
#[derive(Debug, Default)]
pub(crate) struct OutlineLines {
    pub edges: Vec<Vec<DVec2>>,
    pub horizons: Vec<OutlineLine>,
    pub faults: Vec<OutlineLine>,
}

/// A line of a horizon or fault.
#[derive(Debug)]
pub(crate) struct OutlineLine {
    /// The horizon or fault; `None` of a line that belongs to none.
    pub of: Option<usize>,
    pub points: Vec<DVec2>,
}

impl OutlineLines {
    /// All lines of a picture.
    pub(crate) fn of(resolved: &ResolvedScene) -> Self {
        let wanted = resolved.scene.outlines;
        let mut lines = Self::default();
        if wanted.edges.width_px > 0.0 {
            let edges = edge_lines(&resolved.solid, &resolved.view);
            lines.edges = edges.par_iter().flat_map_iter(|edge| seen_edge(resolved, edge)).collect();
        }
        if let (Some(interpretation), Faces::All) = (resolved.interpretation, resolved.scene.media.faces) {
            for face in faces(&resolved.solid, &resolved.view) {
                lines.add_face(resolved, interpretation, &face);
            }
            let relief = relief_lines(resolved);
            lines
                .faults
                .extend(relief.faults.into_iter().map(|(fault, points)| OutlineLine { of: Some(fault), points }));
            lines
                .horizons
                .extend(relief.contacts.into_iter().map(|(horizon, points)| OutlineLine { of: Some(horizon), points }));
            lines.horizons.extend(relief.crests.into_iter().map(|points| OutlineLine { of: None, points }));
        }
        lines
    }

    /// Adds the lines of the section on one face.
    fn add_face(&mut self, resolved: &ResolvedScene, interpretation: ResolvedInterpretation, face: &Face) {
        if !face.faces_camera && (resolved.relief.is_none() || face.plane.axis == Some(2)) {
            return;
        }
        let plane = face.section_plane();
        let section = resolved.shapes.section(interpretation.model, &plane);
        let beside = (beside(face, &plane), face.bounds());
        let seen = |points: &[DVec2]| {
            let points: Vec<DVec3> = points.iter().map(|&st| plane.voxel(st)).collect();
            seen_parts(&resolved.view, &points, |p| match face.faces_camera {
                true => seen_on_face(resolved, &beside, p),
                false => seen_over_rim(resolved, interpretation, face, p),
            })
        };
        for line in section.lines.iter().filter(|_| face.faces_camera) {
            match line.kind {
                LineKind::Fault { real: true, fault } => self.faults.extend(parts_of(Some(fault), seen(&line.points))),
                // Beyond its tip a fault is not interpreted, but different layers meet there.
                LineKind::Fault { .. } => self.horizons.extend(parts_of(None, seen(&line.points))),
                LineKind::Horizon { horizon } => {
                    let parts = inked(resolved, line.quality, seen(&line.points));
                    self.horizons.extend(parts_of(Some(horizon), parts));
                }
                LineKind::Frame => {}
            }
        }
        if resolved.relief.is_some() {
            let air = section.layers.iter().filter(|area| area.layer == air_layer(interpretation.model));
            for ring in air.flat_map(|area| &area.rings) {
                for rim in rim_parts(ring, plane.extent) {
                    self.edges.extend(seen(&rim));
                }
            }
        }
    }
}

/// The visible parts of a horizon's line, in dashes where the horizon was not picked and the scene says so.
fn inked(resolved: &ResolvedScene, quality: LineQuality, parts: Vec<Vec<DVec2>>) -> Vec<Vec<DVec2>> {
    let lengths = match (resolved.scene.outlines.unpicked, quality) {
        (Unpicked::Solid, _) | (_, LineQuality::Certain) => return parts,
        (Unpicked::Dashed, LineQuality::Approximate) => APPROXIMATE,
        (Unpicked::Dashed, LineQuality::Inferred) => INFERRED,
    };
    let [width, height] = resolved.scene.size_px;
    let scale = f64::from(width.min(height)) / f64::from(NOMINAL_SIDE_PX);
    parts.iter().flat_map(|part| dashed(part, lengths.map(|length| length * scale))).collect()
}

fn parts_of(of: Option<usize>, parts: Vec<Vec<DVec2>>) -> impl Iterator<Item = OutlineLine> {
    parts.into_iter().map(move |points| OutlineLine { of, points })
}

/// The parts of a ring that do not lie on the border of its rectangle: where air meets rock.
fn rim_parts(ring: &[DVec2], extent: [f64; 2]) -> Vec<Vec<DVec2>> {
    const ON: f64 = 1e-6;
    let on_border = |a: DVec2, b: DVec2| {
        (0..2).any(|axis| [0.0, extent[axis]].iter().any(|e| (a[axis] - e).abs() < ON && (b[axis] - e).abs() < ON))
    };
    let mut parts: Vec<Vec<DVec2>> = Vec::new();
    let mut open = false;
    for n in 0..ring.len() {
        let (a, b) = (ring[n], ring[(n + 1) % ring.len()]);
        if on_border(a, b) {
            open = false;
            continue;
        }
        match parts.last_mut().filter(|_| open) {
            Some(part) => part.push(b),
            None => parts.push(vec![a, b]),
        }
        open = true;
    }
    parts
}

/// Unit steps beside a line on a face, in the face. Downwards first, since rock lies there if the ground is shown.
fn beside(face: &Face, plane: &SectionPlane) -> [DVec3; 4] {
    if face.plane.axis == Some(2) {
        return [DVec3::X, -DVec3::X, DVec3::Y, -DVec3::Y];
    }
    let (down, level) = (plane.t_axis, plane.s_axis);
    [down, -down, level, -level]
}

/// Whether a point of a line on a face is visible: the face itself is, on at least one side of the line.
fn seen_on_face(resolved: &ResolvedScene, (beside, [low, high]): &([DVec3; 4], [DVec3; 2]), p: DVec3) -> bool {
    beside.iter().any(|aside| {
        let q = (p + aside * ASIDE).clamp(*low, *high);
        // A line on an oblique plane goes on beyond the block.
        q.distance(p) < 3.0 * ASIDE && is_seen(resolved, q)
    })
}

/// Whether a point of the ground's edge is visible on a face that looks away from the camera: nothing is in
/// front of it, and there is rock beside it (not so for a fault between air and air).
fn seen_over_rim(resolved: &ResolvedScene, interpretation: ResolvedInterpretation, face: &Face, p: DVec3) -> bool {
    let along = face.section_plane().s_axis;
    let is_rock = |aside: DVec3| {
        let q = (p + (aside + face.rock) * ASIDE).as_vec3();
        resolved.solid.contains(q) && !is_air(interpretation.model, q)
    };
    [DVec3::Z, along, -along].into_iter().any(is_rock) && covered_by(resolved, p) < IN_FRONT
}

/// The visible parts of an edge: where one of its faces is visible right beside it.
fn seen_edge(resolved: &ResolvedScene, edge: &EdgeLine) -> Vec<Vec<DVec2>> {
    // Not at the very ends, where the ray could miss the block.
    let inset = (edge.ends[1] - edge.ends[0]).normalize_or_zero() * ASIDE;
    let along = |p: DVec3| {
        let length = (edge.ends[1] - edge.ends[0]).length();
        let t = (p - edge.ends[0]).length().clamp(ASIDE.min(0.5 * length), (length - ASIDE).max(0.5 * length));
        edge.ends[0] + inset * (t / ASIDE)
    };
    let seen = |p: DVec3| edge.faces.iter().flatten().any(|into| is_seen(resolved, along(p) + *into * ASIDE));
    seen_parts(&resolved.view, &edge.ends, seen)
}

/// Strokes the outlines of a picture over it, anti-aliased, on sRGB-encoded values.
pub(crate) fn draw(resolved: &ResolvedScene, image: &mut RgbaImage) {
    draw_lines(resolved, &OutlineLines::of(resolved), image);
}

/// Strokes these lines over a picture.
pub(crate) fn draw_lines(resolved: &ResolvedScene, lines: &OutlineLines, image: &mut RgbaImage) {
    let outlines = resolved.scene.outlines;
    if resolved.scene.has_back_edges() {
        underlay(resolved, image);
    }
    let points = |lines: &[&OutlineLine]| lines.iter().map(|line| line.points.clone()).collect::<Vec<_>>();
    for is_unconformity in [false, true] {
        let own = lines.horizons.iter().filter(|line| resolved.is_unconformity(line.of) == is_unconformity);
        stroke_lines(image, &outlines.of_horizon(is_unconformity), &points(&own.collect::<Vec<_>>()));
    }
    // Lines of one colour are stroked as one, so that they join without seams.
    let mut faults: Vec<&OutlineLine> = lines.faults.iter().collect();
    let colour = |line: &OutlineLine| resolved.tables.fault_colour(line.of).map(|colour| colour.rgb);
    faults.sort_by_key(|line| colour(line));
    for own in faults.chunk_by(|a, b| colour(a) == colour(b)) {
        stroke_lines(image, &outlines.of_fault(resolved.tables.fault_colour(own[0].of)), &points(own));
    }
    stroke_lines(image, &outlines.edges, &lines.edges);
}
