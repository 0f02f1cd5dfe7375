//! Which part of a face is seen: its rock, less what other faces hide.
//!
//! The planes of all boxes divide a face into rectangles. One is rock if there is rock behind it and none in front.
//! What hides a face lies on the camera's side of its plane, and every ray enters rock through a face that looks at the
//! camera, so the projected rectangles of those faces are cut off. All are convex, and so are the pieces left.
//!
//! Over a relief a rectangle may be partly air; there nothing is cut off, and what is nearer is drawn later
//! ([`back_to_front`]).

use crate::camera::View;
use crate::outline::solid::{FaceRect, face_rects, is_rock};
use crate::visible::Solid;
use glam::{DVec2, DVec3};

/// How far beside a plane it is asked whether there is rock, voxels.
const BESIDE: f64 = 1e-3;
/// Pieces smaller than this are left out, square pixels.
const LEAST_AREA: f64 = 1e-4;

/// A face that looks at the camera, with its rectangles of rock.
pub(crate) struct SeenFace {
    pub rect: FaceRect,
    /// Smallest and largest corners of the rectangles of rock, voxels.
    cells: Vec<[DVec3; 2]>,
}

impl SeenFace {
    /// Whether all of its rectangle is rock.
    fn is_whole(&self) -> bool {
        self.cells.len() == 1 && self.cells[0] == [self.rect.low, self.rect.high]
    }

    /// Its rectangles of rock in pixels.
    pub(super) fn quads(&self, view: &View) -> Vec<Vec<DVec2>> {
        self.cells.iter().map(|cell| quad(view, self.rect.axis, *cell)).collect()
    }
}

/// The faces that look at the camera and have rock, back to front.
pub(crate) fn seen_faces(solid: &Solid, view: &View) -> Vec<SeenFace> {
    let rects = face_rects(solid, view).into_iter().filter(|rect| rect.faces_camera);
    let faces = rects.map(|rect| SeenFace { cells: cells(solid, &rect), rect });
    back_to_front(faces.filter(|face| !face.cells.is_empty()).collect())
}

/// The rectangles of a face that are rock, along the planes of all boxes; one where nothing divides them.
fn cells(solid: &Solid, rect: &FaceRect) -> Vec<[DVec3; 2]> {
    let (u, v) = ((rect.axis + 1) % 3, (rect.axis + 2) % 3);
    let cuts = |axis: usize| {
        let corners = solid.cut_outs.iter().flatten().map(|corner| f64::from(corner[axis]));
        let inside = corners.filter(|at| *at > rect.low[axis] && *at < rect.high[axis]);
        let mut cuts: Vec<f64> = inside.chain([rect.low[axis], rect.high[axis]]).collect();
        cuts.sort_by(f64::total_cmp);
        cuts.dedup();
        cuts
    };
    let (across, along) = (cuts(u), cuts(v));
    let mut cells = Vec::new();
    for a in across.windows(2) {
        for b in along.windows(2) {
            let (mut low, mut high) = (rect.low, rect.high);
            (low[u], high[u], low[v], high[v]) = (a[0], a[1], b[0], b[1]);
            let inwards = DVec3::AXES[rect.axis] * rect.rock * BESIDE;
            let middle = 0.5 * (low + high);
            if is_rock(solid, (middle + inwards).as_vec3()) && !is_rock(solid, (middle - inwards).as_vec3()) {
                cells.push([low, high]);
            }
        }
    }
    let whole = (across.len() - 1) * (along.len() - 1);
    if cells.len() == whole { vec![[rect.low, rect.high]] } else { cells }
}

fn quad(view: &View, axis: usize, [low, high]: [DVec3; 2]) -> Vec<DVec2> {
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let corner = |at_u: f64, at_v: f64| {
        let mut p = low;
        (p[u], p[v]) = (at_u, at_v);
        view.project(p)
    };
    vec![corner(low[u], low[v]), corner(high[u], low[v]), corner(high[u], high[v]), corner(low[u], high[v])]
}

/// Whether a part of a cell lies on the camera's side of the plane of a face.
fn is_in_front(face: &FaceRect, cell: &[DVec3; 2]) -> bool {
    let outwards = |p: DVec3| (p - face.low)[face.axis] * -face.rock;
    outwards(cell[0]).max(outwards(cell[1])) > BESIDE
}

/// The faces so that none is hidden by an earlier one. Faces that hide one another in turn keep their order.
fn back_to_front(mut faces: Vec<SeenFace>) -> Vec<SeenFace> {
    let hides = |one: &SeenFace, other: &SeenFace| one.cells.iter().any(|cell| is_in_front(&other.rect, cell));
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
            for cell in other.cells.iter().filter(|cell| is_in_front(&face.rect, cell)) {
                let before = pieces.iter().map(|piece| area(piece).abs()).sum::<f64>();
                let hiding = quad(view, other.rect.axis, *cell);
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
mod tests {
    use super::*;
    use crate::{Camera, Corner, VoxelBox};
    use survey::{SurveyGeometry, VerticalUnit};

    fn inside(pieces: &[Vec<DVec2>], p: DVec2) -> usize {
        let holds = |piece: &&Vec<DVec2>| {
            let turn = area(piece).signum();
            (0..piece.len()).all(|n| turn * (piece[(n + 1) % piece.len()] - piece[n]).perp_dot(p - piece[n]) > 0.0)
        };
        pieces.iter().filter(holds).count()
    }

    #[test]
    fn a_square_less_its_corner_is_an_l() {
        let square = |low: f64, high: f64| {
            vec![DVec2::splat(low), DVec2::new(high, low), DVec2::splat(high), DVec2::new(low, high)]
        };
        let pieces = without(&square(0.0, 4.0), &square(2.0, 6.0));
        let whole: f64 = pieces.iter().map(|piece| 0.5 * area(piece).abs()).sum();
        assert!((whole - 12.0).abs() < 1e-9);
        assert_eq!(inside(&pieces, DVec2::new(3.0, 3.0)), 0);
        assert_eq!(inside(&pieces, DVec2::new(1.0, 3.0)), 1);
        assert_eq!(without(&square(0.0, 4.0), &square(5.0, 6.0)).len(), 1);
        assert!(without(&square(1.0, 2.0), &square(0.0, 4.0)).is_empty());
    }

    /// Every pixel belongs to the face that the first hit of its ray lies on, and to no other one.
    #[test]
    fn pieces_agree_with_rays() {
        use crate::visible::Ray;
        let geometry = SurveyGeometry::regular([21, 21, 21], 10.0, 10.0, VerticalUnit::Metres);
        let block = VoxelBox::of_size([21; 3]);
        let stair = block.stair(Corner::MinMin, [0.7, 0.6], 0.8, 3);
        let inner = VoxelBox { min: [8.0, 0.0, 3.0], max: [20.0, 9.0, 12.0] };
        for (azimuth, projection) in [
            (35.0, crate::Projection::Orthographic),
            (35.0, crate::Projection::Perspective { fov_deg: 60.0 }),
            (200.0, crate::Projection::Perspective { fov_deg: 40.0 }),
        ] {
            let camera = Camera { azimuth_deg: Some(azimuth), projection, ..Camera::default() };
            let view = View::new(&camera, &geometry, &block, 1.0, [160, 140]);
            for cuts in [vec![], stair.clone(), vec![inner], [stair.clone(), vec![inner]].concat()] {
                let solid = Solid::new(&block, &cuts);
                let faces = seen_faces(&solid, &view);
                let pieces: Vec<Vec<Vec<DVec2>>> = (0..faces.len())
                    .map(|n| seen_pieces(&faces, n, &view, false).unwrap_or_else(|| faces[n].quads(&view)))
                    .collect();
                let (mut tested, mut wrong) = (0, 0);
                for n in 0..160 * 140 {
                    let pixel = DVec2::new(f64::from(n % 160) + 0.5, f64::from(n / 160) + 0.5);
                    let hit = solid.next_span(&Ray::from(view.ray(pixel)), f32::MIN).map(|span| span.entry);
                    let counts: Vec<usize> = pieces.iter().map(|pieces| inside(pieces, pixel)).collect();
                    let expected = hit.map(|hit| (hit.axis, hit.point[hit.axis]));
                    let found: Vec<(usize, f32)> = (0..faces.len())
                        .filter(|n| counts[*n] > 0)
                        .map(|n| (faces[n].rect.axis, faces[n].rect.low[faces[n].rect.axis] as f32))
                        .collect();
                    tested += 1;
                    wrong += usize::from(found != Vec::from_iter(expected) || counts.iter().any(|count| *count > 1));
                }
                // A ray through a pixel that an edge passes may fall on either side.
                assert!(wrong * 2000 < tested, "{wrong} of {tested} with {} cuts from {azimuth}", cuts.len());
            }
        }
    }
}
