//! Which part of a face is seen: its rock, less what other faces hide.
//!
//! A face is rock where there is rock behind it and none in front: where no other cut-out lies behind it. What hides a
//! face lies on the camera's side of its plane, and every ray enters rock through a face that looks at the camera, so the
//! projected pieces of those faces are cut off. All are convex, and so are the pieces left.
//!
//! Over a relief a piece may be partly air; there nothing is cut off, and what the rock of nearer faces hides is said in
//! outlines ([`hidden_parts`]).

use super::outline::clipped;
use crate::camera::View;
use crate::outline::solid::{Face, faces, is_rock};
use crate::visible::Solid;
use glam::{DVec2, DVec3};
use survey::block::part_behind;

/// How far beside a plane it is asked whether there is rock, voxels.
const BESIDE: f64 = 1e-3;
/// Pieces smaller than this are left out, square pixels.
const LEAST_AREA: f64 = 1e-4;
/// A strip of a face that is thinner is not hidden, pixels.
const LEAST_HIDDEN: f64 = 1e-3;
/// What is hidden is known so far beyond a face: what is drawn on it has bleed, pixels.
const AROUND_PX: f64 = 4.0;
/// Pieces of a face smaller than this are left out, square voxels.
const LEAST_ROCK: f64 = 1e-6;

/// A face that looks at the camera, with its pieces of rock.
pub(crate) struct SeenFace {
    pub face: Face,
    /// Its convex pieces of rock, voxels.
    cells: Vec<Vec<DVec3>>,
}

impl SeenFace {
    /// Whether all of the rectangle around it is rock.
    fn is_whole(&self) -> bool {
        self.cells.len() == 1 && self.cells[0] == self.face.outline && self.face.is_rectangle()
    }

    /// Its pieces of rock in pixels.
    pub(super) fn quads(&self, view: &View) -> Vec<Vec<DVec2>> {
        self.cells.iter().map(|cell| projected(view, cell)).collect()
    }
}

/// The faces that look at the camera and have rock, back to front.
pub(crate) fn seen_faces(solid: &Solid, view: &View) -> Vec<SeenFace> {
    let facing = faces(solid, view).into_iter().filter(|face| face.faces_camera);
    let seen = facing.map(|face| SeenFace { cells: rock_cells(solid, &face), face });
    back_to_front(seen.filter(|face| !face.cells.is_empty()).collect())
}

/// The pieces of a face that are rock.
pub(crate) fn rock_cells(solid: &Solid, face: &Face) -> Vec<Vec<DVec3>> {
    let mut cells = vec![face.outline.clone()];
    for body in &solid.cut_outs {
        // Behind the face, so that the cut-out which it bounds does not count.
        let hole = face.part_in(body, BESIDE);
        if hole.len() > 2 {
            cells = cells.iter().flat_map(|cell| outside(cell, &hole, face.plane.normal.as_dvec3())).collect();
        }
    }
    // Of two cut-outs that end at the same plane one alone has a face there.
    let open = |cell: &Vec<DVec3>| {
        let middle = cell.iter().sum::<DVec3>() / cell.len() as f64;
        let beside = |aside: f64| is_rock(solid, (middle + face.rock * aside).as_vec3());
        beside(BESIDE) && !beside(-BESIDE)
    };
    cells.retain(open);
    cells
}

/// A convex polygon less another one in the same plane, in convex pieces.
fn outside(polygon: &[DVec3], hole: &[DVec3], normal: DVec3) -> Vec<Vec<DVec3>> {
    let turn = (0..hole.len()).map(|n| (hole[n] - hole[0]).cross(hole[(n + 1) % hole.len()] - hole[0])).sum::<DVec3>();
    let normal = if turn.dot(normal) < 0.0 { -normal } else { normal };
    let area = |part: &[DVec3]| {
        let corner = |n: usize| (part[n] - part[0]).cross(part[(n + 1) % part.len()] - part[0]);
        (0..part.len()).map(corner).sum::<DVec3>().length()
    };
    let (mut pieces, mut rest) = (Vec::new(), polygon.to_vec());
    for n in 0..hole.len() {
        let (a, b) = (hole[n], hole[(n + 1) % hole.len()]);
        // Positive on the hole's own side of this border.
        let inwards = normal.cross(b - a).normalize_or_zero();
        let beyond = part_behind(&rest, |p| inwards.dot(p - a));
        rest = part_behind(&rest, |p| -inwards.dot(p - a));
        if area(&beyond) > LEAST_ROCK {
            pieces.push(beyond);
        }
        if area(&rest) <= LEAST_ROCK {
            break;
        }
    }
    pieces
}

fn projected(view: &View, cell: &[DVec3]) -> Vec<DVec2> {
    cell.iter().map(|p| view.project(*p)).collect()
}

/// The part of a piece that lies on the camera's side of the plane of a face.
fn in_front(face: &Face, cell: &[DVec3]) -> Vec<DVec3> {
    let depth = |p: DVec3| face.rock.dot(p - face.outline[0]);
    if cell.iter().any(|p| depth(*p) < -BESIDE) { part_behind(cell, depth) } else { Vec::new() }
}

/// The faces so that none is hidden by an earlier one. Faces that hide one another in turn keep their order.
fn back_to_front(mut faces: Vec<SeenFace>) -> Vec<SeenFace> {
    let hides = |one: &SeenFace, other: &SeenFace| one.cells.iter().any(|cell| !in_front(&other.face, cell).is_empty());
    let mut sorted = Vec::new();
    while !faces.is_empty() {
        // The next one hides none of the rest, or less of them than others do.
        let hidden =
            |n: usize| (0..faces.len()).filter(|other| *other != n && hides(&faces[n], &faces[*other])).count();
        let next = (0..faces.len()).min_by_key(|n| hidden(*n)).unwrap_or(0);
        sorted.push(faces.remove(next));
    }
    sorted
}

/// The part of a face that is seen, in convex pieces, pixels; `None`: its whole rectangle. With `is_relief` what
/// other faces hide is not cut off.
pub(crate) fn seen_pieces(faces: &[SeenFace], index: usize, view: &View, is_relief: bool) -> Option<Vec<Vec<DVec2>>> {
    let face = &faces[index];
    let mut pieces = face.quads(view);
    let mut is_cut = !face.is_whole();
    if !is_relief {
        for other in faces.iter().enumerate().filter(|(n, _)| *n != index).map(|(_, other)| other) {
            for cell in other.cells.iter().map(|cell| in_front(&face.face, cell)).filter(|cell| cell.len() > 2) {
                let before = pieces.iter().map(|piece| area(piece).abs()).sum::<f64>();
                let hiding = projected(view, &cell);
                let left: Vec<Vec<DVec2>> = pieces.iter().flat_map(|piece| without(piece, &hiding)).collect();
                if before - left.iter().map(|piece| area(piece).abs()).sum::<f64>() > LEAST_AREA {
                    pieces = left;
                    is_cut = true;
                }
            }
        }
    }
    is_cut.then_some(pieces)
}

/// For each of several nearer faces the outlines of what its rock hides of a face, pixels, by the non-zero rule.
pub(super) type HiddenParts = Vec<Vec<Vec<DVec2>>>;

/// What the rock of other faces hides of a face, up to a little beyond the rectangle around its pieces. `rock` holds the
/// outlines of the rock on each face, which turn alike, holes against them.
pub(super) fn hidden_parts(faces: &[SeenFace], index: usize, view: &View, rock: &[Vec<Vec<DVec2>>]) -> HiddenParts {
    let face = &faces[index];
    let to_left =
        |polygon: Vec<DVec2>| if area(&polygon) < 0.0 { polygon.into_iter().rev().collect() } else { polygon };
    let quads: Vec<Vec<DVec2>> = face.quads(view).into_iter().map(to_left).collect();
    let corners = || quads.iter().flatten().copied();
    let low = corners().fold(DVec2::INFINITY, DVec2::min) - AROUND_PX;
    let high = corners().fold(DVec2::NEG_INFINITY, DVec2::max) + AROUND_PX;
    let around = [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)];
    let others = faces.iter().zip(rock).enumerate().filter(|(n, _)| *n != index).map(|(_, other)| other);
    let hidden = others.map(|(other, rock)| {
        let cells = other.cells.iter().map(|cell| in_front(&face.face, cell)).filter(|cell| cell.len() > 2);
        let cells: Vec<Vec<DVec2>> = cells.map(|cell| clipped(&to_left(projected(view, &cell)), &around)).collect();
        let cells = cells.iter().filter(|cell| cell.len() > 2);
        let rings = cells.flat_map(|cell| rock.iter().map(|ring| clipped(ring, cell)));
        rings.filter(|ring| ring.len() > 2).collect::<Vec<_>>()
    });
    let overlap = |ring: &Vec<DVec2>| quads.iter().map(|quad| area(&clipped(ring, quad))).sum::<f64>();
    // Neighbours on a curved wall overlap by rounding: cut off there, the bleed that closes their seam would be lost.
    let least = 2.0 * LEAST_HIDDEN * low.distance(high);
    hidden.filter(|rings| rings.iter().map(overlap).sum::<f64>().abs() > least).collect()
}

/// Twice the area of a polygon, with the sign of its turn.
fn area(polygon: &[DVec2]) -> f64 {
    (0..polygon.len()).map(|n| polygon[n].perp_dot(polygon[(n + 1) % polygon.len()])).sum()
}

/// A convex polygon less another one, in convex pieces.
fn without(polygon: &[DVec2], hole: &[DVec2]) -> Vec<Vec<DVec2>> {
    let turn = area(hole).signum();
    let mut pieces = Vec::new();
    let mut rest = polygon.to_vec();
    for n in 0..hole.len() {
        let (a, b) = (hole[n], hole[(n + 1) % hole.len()]);
        let outside = half(&rest, |p| -turn * (b - a).perp_dot(p - a));
        rest = half(&rest, |p| turn * (b - a).perp_dot(p - a));
        if area(&outside).abs() > LEAST_AREA {
            pieces.push(outside);
        }
        if area(&rest).abs() <= LEAST_AREA {
            break;
        }
    }
    pieces
}

/// The part of a convex polygon on which a linear function is positive.
fn half(polygon: &[DVec2], side: impl Fn(DVec2) -> f64) -> Vec<DVec2> {
    let mut part = Vec::new();
    for n in 0..polygon.len() {
        let (a, b) = (polygon[n], polygon[(n + 1) % polygon.len()]);
        let (at_a, at_b) = (side(a), side(b));
        if at_a >= 0.0 {
            part.push(a);
        }
        if (at_a > 0.0 && at_b < 0.0) || (at_a < 0.0 && at_b > 0.0) {
            part.push(a.lerp(b, at_a / (at_a - at_b)));
        }
    }
    part
}

#[cfg(test)]
mod tests;
