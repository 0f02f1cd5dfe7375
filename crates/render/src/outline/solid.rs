//! Faces and edges of the solid block: the roaming box minus its cut-outs.
//!
//! A face is the part of a body's plane that bounds it, with rock on the other side. An edge is a part of a line in which
//! two planes meet, if the four wedges around it are neither all alike nor form a flat face.

use crate::camera::View;
use crate::visible::Solid;
use glam::{DVec2, DVec3, Vec3};
use model::section::SectionPlane;
use survey::block::{Body, BodyPlane, part_behind};

/// A side of the box, or a back face of a cut-out. Parts of it may be cut away or hidden.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Face {
    /// Its plane, with the normal of the body that it bounds.
    pub plane: BodyPlane,
    /// A convex polygon, voxels.
    pub outline: Vec<DVec3>,
    /// Unit direction across it into the rock, voxels.
    pub rock: DVec3,
    /// Whether it faces the camera. Of other faces only the edge of the ground can be visible.
    pub faces_camera: bool,
}

/// A part of an edge of the block.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct EdgeLine {
    /// Ends, voxels.
    pub ends: [DVec3; 2],
    /// Unit directions from the edge into those of its faces that face the camera.
    pub faces: [Option<DVec3>; 4],
}

/// Corners of a face closer than this are one, voxels.
const SAME: f64 = 1e-6;
/// Faces smaller than this are left out, square voxels.
const LEAST_AREA: f64 = 1e-9;

/// All faces.
pub(crate) fn faces(solid: &Solid, view: &View) -> Vec<Face> {
    let bounds = solid.roaming_box.map(|corner| corner.as_dvec3());
    let face = |body: &Body, n: usize, rock: f64| {
        let plane = body.planes[n];
        let outline = without_doubles(body.face(n, bounds));
        let (from, area) = (outline.first()?, normal_of(&outline));
        let rock = plane.normal.as_dvec3() * rock;
        let faces_camera = view.towards_camera(*from).dot(-rock) > 0.0;
        (area.length() > LEAST_AREA).then_some(Face { plane, outline, rock, faces_camera })
    };
    let mut found = Vec::new();
    for n in 0..solid.block.planes.len() {
        found.extend(face(&solid.block, n, -1.0));
        // A face of a cut-out on a side of the roaming box has no rock behind it.
        for cut in &solid.cut_outs {
            let alike = (0..cut.planes.len()).filter(|m| cut.planes[*m].normal == solid.block.planes[n].normal);
            let inside = alike.filter(|m| cut.planes[*m].offset != solid.block.planes[n].offset);
            found.extend(inside.filter(|m| !cut.planes[*m].is_seam).filter_map(|m| face(cut, m, 1.0)));
        }
    }
    for cut in &solid.cut_outs {
        let oblique = (0..cut.planes.len()).filter(|m| cut.planes[*m].axis.is_none() && !cut.planes[*m].is_seam);
        found.extend(oblique.filter_map(|m| face(cut, m, 1.0)));
    }
    found
}

fn without_doubles(mut outline: Vec<DVec3>) -> Vec<DVec3> {
    outline.dedup_by(|a, b| a.distance(*b) < SAME);
    if outline.len() > 1 && outline[0].distance(outline[outline.len() - 1]) < SAME {
        outline.pop();
    }
    outline
}

/// Twice the area of a polygon, along its normal.
fn normal_of(outline: &[DVec3]) -> DVec3 {
    (0..outline.len()).map(|n| (outline[n] - outline[0]).cross(outline[(n + 1) % outline.len()] - outline[0])).sum()
}

impl Face {
    /// The axis nearest to its normal: 2 for a face on which a map is seen.
    pub(crate) fn nearest_axis(&self) -> usize {
        let size = self.plane.normal.abs();
        (0..3).max_by(|a, b| size[*a].total_cmp(&size[*b])).unwrap_or(2)
    }

    /// Smallest and largest x, y, z of its corners.
    pub(crate) fn bounds(&self) -> [DVec3; 2] {
        let start = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let (low, high) = self.outline.iter().fold(start, |(low, high), p| (low.min(*p), high.max(*p)));
        [low, high]
    }

    /// The rectangle around it: t runs down, s level; on a horizontal face along y and x.
    pub(crate) fn section_plane(&self) -> SectionPlane {
        let [low, high] = self.bounds();
        match self.plane.axis {
            Some(0) => return SectionPlane::inline(low.x, low, high),
            Some(1) => return SectionPlane::crossline(low.y, low, high),
            Some(_) => return SectionPlane::slice(low.z, low, high),
            None => {}
        }
        let normal = self.plane.normal.as_dvec3();
        let level = DVec2::new(-normal.y, normal.x).normalize_or(DVec2::X);
        let s_axis = level.extend(0.0);
        let t_axis = normal.cross(s_axis);
        let t_axis = if t_axis.z < 0.0 { -t_axis } else { t_axis };
        let place = |p: &DVec3| DVec2::new(s_axis.dot(*p), t_axis.dot(*p));
        let (least, most) = self
            .outline
            .iter()
            .map(place)
            .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(least, most), st| (least.min(st), most.max(st)));
        let origin = normal * f64::from(self.plane.offset) + s_axis * least.x + t_axis * least.y;
        SectionPlane { origin, s_axis, t_axis, extent: (most - least).to_array() }
    }

    /// Whether it fills the rectangle around it.
    pub(crate) fn is_rectangle(&self) -> bool {
        let plane = self.section_plane();
        let whole = plane.extent[0] * plane.extent[1] * plane.s_axis.cross(plane.t_axis).length();
        (0.5 * normal_of(&self.outline).length() - whole).abs() < 1e-6 * whole.max(1.0)
    }

    /// The part of it in which a body lies, moved by `aside` along the rock's direction; empty if there is none.
    pub(crate) fn part_in(&self, body: &Body, aside: f64) -> Vec<DVec3> {
        let mut part = self.outline.clone();
        for plane in &body.planes {
            let normal = plane.normal.as_dvec3();
            part = part_behind(&part, |p| normal.dot(p + self.rock * aside) - f64::from(plane.offset));
            if part.is_empty() {
                break;
            }
        }
        if normal_of(&part).length() > LEAST_AREA { part } else { Vec::new() }
    }
}

/// All parts of edges with a face towards the camera.
pub(super) fn edge_lines(solid: &Solid, view: &View) -> Vec<EdgeLine> {
    let mut planes: Vec<BodyPlane> = Vec::new();
    for plane in std::iter::once(&solid.block).chain(&solid.cut_outs).flat_map(|body| &body.planes) {
        let same = |other: &BodyPlane| {
            let sign = other.normal.dot(plane.normal);
            sign.abs() > 1.0 - 1e-6 && (other.offset * sign.signum() - plane.offset).abs() < 1e-4
        };
        if !plane.is_seam && !planes.iter().any(same) {
            planes.push(*plane);
        }
    }
    let mut edges = Vec::new();
    for (n, a) in planes.iter().enumerate() {
        for b in &planes[n + 1..] {
            let Some(line) = Line::of(a, b, solid.roaming_box) else { continue };
            let curve = |plane: &BodyPlane| plane.wall.and_then(|wall| wall.curve);
            let is_smooth = curve(a).is_some() && curve(a) == curve(b);
            let cuts = line.cuts(&planes);
            for stretch in cuts.windows(2) {
                let ends = [line.at(stretch[0]), line.at(stretch[1])];
                edges.extend(edge(solid, view, ends, [a, b], is_smooth));
            }
        }
    }
    edges
}

/// The line in which two planes meet, within the roaming box.
struct Line {
    point: DVec3,
    direction: DVec3,
    ends: [f64; 2],
}

impl Line {
    fn of(a: &BodyPlane, b: &BodyPlane, bounds: [Vec3; 2]) -> Option<Self> {
        let (p, q) = (a.normal.as_dvec3(), b.normal.as_dvec3());
        let direction = p.cross(q);
        if direction.length() < 1e-6 {
            return None;
        }
        // The point of both planes nearest to the origin.
        let (at_a, at_b) = (f64::from(a.offset), f64::from(b.offset));
        let point = (q.cross(direction) * at_a + direction.cross(p) * at_b) / direction.length_squared();
        let direction = direction.normalize();
        let (mut first, mut last) = (f64::NEG_INFINITY, f64::INFINITY);
        let [low, high] = bounds.map(|corner| corner.as_dvec3());
        for axis in 0..3 {
            if direction[axis].abs() < 1e-9 {
                if point[axis] < low[axis] - 1e-4 || point[axis] > high[axis] + 1e-4 {
                    return None;
                }
                continue;
            }
            let (s, t) = ((low[axis] - point[axis]) / direction[axis], (high[axis] - point[axis]) / direction[axis]);
            (first, last) = (first.max(s.min(t)), last.min(s.max(t)));
        }
        (last - first > 1e-6).then_some(Self { point, direction, ends: [first, last] })
    }

    fn at(&self, t: f64) -> DVec3 {
        self.point + self.direction * t
    }

    /// Where planes cross the line, and its ends.
    fn cuts(&self, planes: &[BodyPlane]) -> Vec<f64> {
        let [first, last] = self.ends;
        let crossing = |plane: &BodyPlane| {
            let normal = plane.normal.as_dvec3();
            (f64::from(plane.offset) - normal.dot(self.point)) / normal.dot(self.direction)
        };
        let inside = planes.iter().map(crossing).filter(|t| *t > first && *t < last);
        let mut cuts: Vec<f64> = inside.chain(self.ends).collect();
        cuts.sort_by(f64::total_cmp);
        cuts.dedup_by(|a, b| (*a - *b).abs() < 1e-6);
        cuts
    }
}

/// The edge in which two planes meet, if there is one. Between planes of one curve there is one only where the curve turns
/// away from the camera.
fn edge(solid: &Solid, view: &View, ends: [DVec3; 2], planes: [&BodyPlane; 2], is_smooth: bool) -> Option<EdgeLine> {
    let middle = (ends[0] + ends[1]) * 0.5;
    // Far enough for f32, and less than the width of any cell that matters.
    const ASIDE: f64 = 1e-3;
    let [p, q] = planes.map(|plane| plane.normal.as_dvec3());
    let along = p.cross(q).normalize();
    // Unit directions in the planes, across the line.
    let (u, v) = (along.cross(q).normalize(), along.cross(p).normalize());
    let quadrants = [u + v, v - u, -u - v, u - v].map(DVec3::normalize);
    let rock = quadrants.map(|direction| is_rock(solid, (middle + direction * ASIDE).as_vec3()));
    // Between quadrants n and n + 1 lies the half-plane in direction v, −u, −v, u; v lies in the first plane.
    let between = [(v, p), (-u, q), (-v, p), (u, q)];
    let mut faces = [None; 4];
    let (mut count, mut towards, mut away) = (0, 0, 0);
    for n in 0..4 {
        let next = (n + 1) % 4;
        if rock[n] != rock[next] {
            count += 1;
            let (direction, normal) = between[n];
            let into_air = if rock[n] { quadrants[next] - quadrants[n] } else { quadrants[n] - quadrants[next] };
            let normal = if normal.dot(into_air) < 0.0 { -normal } else { normal };
            if view.towards_camera(middle).dot(normal) > 0.0 {
                faces[n] = Some(direction);
                towards += 1;
            } else {
                away += 1;
            }
        }
    }
    let flat = count == 2 && rock[0] != rock[2] && rock[1] != rock[3] && (rock[0] == rock[1] || rock[0] == rock[3]);
    let is_drawn = if is_smooth { towards > 0 && away > 0 } else { towards > 0 };
    // Planes of a curve bound the rock on both sides of the line, which is not flat, but hardly bent.
    (count > 0 && (is_smooth || !flat) && is_drawn).then_some(EdgeLine { ends, faces })
}

/// Whether a point, which must not lie on a plane, is rock.
pub(crate) fn is_rock(solid: &Solid, p: Vec3) -> bool {
    solid.block.holds(p) && !solid.cut_outs.iter().any(|cut| cut.holds(p))
}

#[cfg(test)]
mod tests;
