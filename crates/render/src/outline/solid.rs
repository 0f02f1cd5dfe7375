//! Faces and edges of the solid block: the roaming box minus its cut-outs.
//!
//! The planes of all boxes divide space into cells, each of which is rock or not. A face rectangle is a side
//! of a box with rock behind it. An edge is a part of a line in which two planes meet, if the four cells
//! around it are neither all alike nor form a flat face.

use crate::camera::View;
use crate::visible::Solid;
use glam::{DVec3, Vec3};

/// A side of the box, or a back face of a cut-out. Parts of it may be cut away or hidden.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FaceRect {
    /// Axis of its normal.
    pub axis: usize,
    /// Smallest corner, voxels.
    pub low: DVec3,
    /// Largest corner; equal to `low` along `axis`.
    pub high: DVec3,
    /// Direction to the rock along `axis`: +1 or −1.
    pub rock: f64,
    /// Whether it faces the camera. Of other faces only the edge of the ground can be visible.
    pub faces_camera: bool,
}

/// A part of an edge of the block.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct EdgeLine {
    /// Ends, voxels.
    pub ends: [DVec3; 2],
    /// Unit directions along an axis from the edge into those of its faces that face the camera.
    pub faces: [Option<DVec3>; 4],
}

/// All face rectangles.
pub(crate) fn face_rects(solid: &Solid, view: &View) -> Vec<FaceRect> {
    let outer = solid.roaming_box;
    let mut rects = Vec::new();
    for axis in 0..3 {
        for end in 0..2 {
            let normal = unit(axis) * if end == 0 { -1.0 } else { 1.0 };
            rects.push(face_rect(view, axis, outer, end, normal));
            for cut in &solid.cut_outs {
                // A face of the cut-out on the side of the roaming box has no rock behind it. The normal of
                // the others points into the cut-out.
                if cut[end][axis] != outer[end][axis] {
                    rects.push(face_rect(view, axis, *cut, end, -normal));
                }
            }
        }
    }
    rects
}

fn face_rect(view: &View, axis: usize, corners: [Vec3; 2], end: usize, normal: DVec3) -> FaceRect {
    let [mut low, mut high] = corners.map(|c| c.as_dvec3());
    low[axis] = f64::from(corners[end][axis]);
    high[axis] = low[axis];
    FaceRect { axis, low, high, rock: -normal[axis], faces_camera: view.towards_camera(low).dot(normal) > 0.0 }
}

fn unit(axis: usize) -> DVec3 {
    DVec3::AXES[axis]
}

/// All parts of edges with a face towards the camera.
pub(super) fn edge_lines(solid: &Solid, view: &View) -> Vec<EdgeLine> {
    let planes: [Vec<f64>; 3] = std::array::from_fn(|axis| {
        let boxes = std::iter::once(&solid.roaming_box).chain(&solid.cut_outs);
        let mut planes: Vec<f64> = boxes.flatten().map(|corner| f64::from(corner[axis])).collect();
        planes.sort_by(f64::total_cmp);
        planes.dedup();
        planes
    });
    let mut edges = Vec::new();
    for along in 0..3 {
        let (u, v) = ((along + 1) % 3, (along + 2) % 3);
        for &at_u in &planes[u] {
            for &at_v in &planes[v] {
                for stretch in planes[along].windows(2) {
                    let end = |w: f64| unit(along) * w + unit(u) * at_u + unit(v) * at_v;
                    let ends = [end(stretch[0]), end(stretch[1])];
                    edges.extend(edge(solid, view, ends, unit(u), unit(v)));
                }
            }
        }
    }
    edges
}

/// The edge in which planes of constant `u` and `v` meet, if there is one.
fn edge(solid: &Solid, view: &View, ends: [DVec3; 2], u: DVec3, v: DVec3) -> Option<EdgeLine> {
    let middle = (ends[0] + ends[1]) * 0.5;
    // Far enough for f32, and less than the width of any cell that matters.
    const ASIDE: f64 = 1e-3;
    let quadrants = [u + v, v - u, -u - v, u - v];
    let rock = quadrants.map(|q| is_rock(solid, (middle + q * ASIDE).as_vec3()));
    // Between quadrants n and n + 1 lies the half-plane in direction v, −u, −v, u.
    let between = [v, -u, -v, u];
    let mut faces = [None; 4];
    let mut count = 0;
    for n in 0..4 {
        let (here, next) = (rock[n], rock[(n + 1) % 4]);
        if here != next {
            count += 1;
            let normal = (quadrants[(n + 1) % 4] - quadrants[n]) * if here { 1.0 } else { -1.0 };
            if view.towards_camera(middle).dot(normal) > 0.0 {
                faces[n] = Some(between[n]);
            }
        }
    }
    let flat = count == 2 && rock[0] != rock[2] && rock[1] != rock[3] && (rock[0] == rock[1] || rock[0] == rock[3]);
    (count > 0 && !flat && faces.iter().any(Option::is_some)).then_some(EdgeLine { ends, faces })
}

/// Whether a point, which must not lie on a plane, is rock.
pub(crate) fn is_rock(solid: &Solid, p: Vec3) -> bool {
    let inside = |[low, high]: &[Vec3; 2]| p.cmpgt(*low).all() && p.cmplt(*high).all();
    inside(&solid.roaming_box) && !solid.cut_outs.iter().any(inside)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Camera, Corner, VoxelBox};
    use survey::{SurveyGeometry, VerticalUnit};

    fn view(block: &VoxelBox) -> View {
        let geometry = SurveyGeometry::regular([11, 11, 11], 10.0, 10.0, VerticalUnit::Metres);
        View::new(&Camera { azimuth_deg: Some(35.0), ..Camera::default() }, &geometry, block, 1.0, [100, 100])
    }

    fn facing(solid: &Solid, block: &VoxelBox) -> usize {
        face_rects(solid, &view(block)).iter().filter(|rect| rect.faces_camera).count()
    }

    fn length(edges: &[EdgeLine]) -> f64 {
        edges.iter().map(|e| (e.ends[1] - e.ends[0]).length()).sum()
    }

    #[test]
    fn a_box_shows_nine_edges_and_three_faces() {
        let block = VoxelBox::of_size([11, 11, 11]);
        let solid = Solid::new(&block, &[]);
        assert_eq!(facing(&solid, &block), 3);
        assert!((length(&edge_lines(&solid, &view(&block))) - 90.0).abs() < 1e-3);
    }

    #[test]
    fn a_corner_cut_adds_two_faces_and_no_edge_in_a_flat_face() {
        let block = VoxelBox::of_size([11, 11, 11]);
        let corner = view(&block).nearest_corner(&block);
        assert_eq!(corner, Corner::MinMin);
        let solid = Solid::new(&block, &[block.corner_cut(corner, [0.4, 0.3])]);
        assert_eq!(facing(&solid, &block), 5);
        // The edges at the back of the top and the left and right side edges, shortened by the cut, plus
        // those of the cut: the outline of an L on top (40), the same at the bottom without its two hidden
        // sides (40 − 20), and five vertical edges: 3 of the cut, 2 outer ones.
        assert!((length(&edge_lines(&solid, &view(&block))) - (40.0 + 20.0 + 50.0)).abs() < 1e-3);
    }

    #[test]
    fn a_stair_has_an_edge_where_a_face_meets_the_next_floor() {
        let block = VoxelBox::of_size([11, 11, 11]);
        let solid = Solid::new(&block, &block.stair(Corner::MinMin, [0.6, 0.6], 0.8, 2));
        let edges = edge_lines(&solid, &view(&block));
        // The back face x = 3 of the lower step begins at the floor z = 4 of the upper step.
        let meets = |e: &EdgeLine| e.ends.iter().all(|p| (p.x - 3.0).abs() < 1e-5 && (p.z - 4.0).abs() < 1e-5);
        assert!(edges.iter().any(meets));
    }
}
