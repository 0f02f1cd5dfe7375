//! Outlines of blocks with cut-outs.

use super::*;
use crate::{Camera, Corner, CutShape, VoxelBox};
use survey::{SurveyGeometry, VerticalUnit};

fn view(block: &VoxelBox) -> View {
    let geometry = SurveyGeometry::regular([11, 11, 11], 10.0, 10.0, VerticalUnit::Metres);
    View::new(&Camera { azimuth_deg: Some(35.0), ..Camera::default() }, &geometry, block, 1.0, [100, 100])
}

fn facing(solid: &Solid, block: &VoxelBox) -> usize {
    faces(solid, &view(block)).iter().filter(|face| face.faces_camera).count()
}

fn length(edges: &[EdgeLine]) -> f64 {
    edges.iter().map(|e| (e.ends[1] - e.ends[0]).length()).sum()
}

#[test]
fn a_box_shows_nine_edges_and_three_faces() {
    let block = VoxelBox::of_size([11, 11, 11]);
    let solid = Solid::of_boxes(&block, &[]);
    assert_eq!(facing(&solid, &block), 3);
    assert!((length(&edge_lines(&solid, &view(&block))) - 90.0).abs() < 1e-3);
}

#[test]
fn a_corner_cut_adds_two_faces_and_no_edge_in_a_flat_face() {
    let block = VoxelBox::of_size([11, 11, 11]);
    let corner = view(&block).nearest_corner(&block);
    assert_eq!(corner, Corner::MinMin);
    let solid = Solid::of_boxes(&block, &[block.corner_cut(corner, [0.4, 0.3])]);
    assert_eq!(facing(&solid, &block), 5);
    // The edges at the back of the top and the left and right side edges, shortened by the cut, plus
    // those of the cut: the outline of an L on top (40), the same at the bottom without its two hidden
    // sides (40 − 20), and five vertical edges: 3 of the cut, 2 outer ones.
    assert!((length(&edge_lines(&solid, &view(&block))) - (40.0 + 20.0 + 50.0)).abs() < 1e-3);
}

#[test]
fn a_stair_has_an_edge_where_a_face_meets_the_next_floor() {
    let block = VoxelBox::of_size([11, 11, 11]);
    let solid = Solid::of_boxes(&block, &block.stair(Corner::MinMin, [0.6, 0.6], 0.8, 2));
    let edges = edge_lines(&solid, &view(&block));
    // The back face x = 3 of the lower step begins at the floor z = 4 of the upper step.
    let meets = |e: &EdgeLine| e.ends.iter().all(|p| (p.x - 3.0).abs() < 1e-5 && (p.z - 4.0).abs() < 1e-5);
    assert!(edges.iter().any(meets));
}

#[test]
fn a_sloping_plane_across_a_block_has_four_edges_and_one_face() {
    let block = VoxelBox::of_size([11, 11, 11]);
    // Takes the upper part at smaller x and y, from the corner nearest to the camera.
    let shape = CutShape::Plane { through: [5.0, 5.0, 5.0], normal: [-1.0, -1.0, -1.5] };
    let solid = Solid::new(Solid::of_boxes(&block, &[]).roaming_box, shape.bodies(&block, [10.0; 2], 0).unwrap());
    let faces = faces(&solid, &view(&block));
    let sloping = faces.iter().find(|face| face.plane.axis.is_none()).unwrap();
    assert!(sloping.faces_camera && sloping.outline.len() >= 4, "{sloping:?}");
    let plane = sloping.section_plane();
    assert!(plane.s_axis.z.abs() < 1e-9 && plane.t_axis.z > 0.0);
    for corner in &sloping.outline {
        assert!((DVec3::new(1.0, 1.0, 1.5).dot(*corner - DVec3::splat(5.0))).abs() < 1e-4);
        assert!((0..3).any(|axis| (corner[axis] - 5.0).abs() > 5.0 - 1e-6), "{corner}");
    }
    let on_plane = |p: &DVec3| (DVec3::new(1.0, 1.0, 1.5).dot(*p - DVec3::splat(5.0))).abs() < 1e-3;
    let edges = edge_lines(&solid, &view(&block));
    let around: f64 = edges.iter().filter(|e| e.ends.iter().all(on_plane)).map(|e| e.ends[0].distance(e.ends[1])).sum();
    let outline = &sloping.outline;
    let length: f64 = (0..outline.len()).map(|n| outline[n].distance(outline[(n + 1) % outline.len()])).sum();
    assert!((around - length).abs() < 1e-3, "{around} {length}");
}

#[test]
fn a_curved_wall_has_no_edges_between_its_planes_but_above_and_below() {
    let block = VoxelBox::of_size([11, 11, 11]);
    let outline = (0..8).map(|n| (DVec2::from_angle(f64::from(n)) * 4.0 + 5.0).to_array()).take(6).collect();
    let shape = CutShape::Outline { outline, smooth: true, depth: Some([-1.0, 6.0]) };
    let bodies = shape.bodies(&block, [10.0; 2], 0).unwrap();
    let walls = bodies.iter().flat_map(|body| &body.planes).filter(|plane| plane.wall.is_some()).count();
    let solid = Solid::new(Solid::of_boxes(&block, &[]).roaming_box, bodies);
    let edges = edge_lines(&solid, &view(&block));
    let upright = |e: &&EdgeLine| (e.ends[0].z - e.ends[1].z).abs() > 1e-3;
    let inside = |e: &&EdgeLine| e.ends[0].truncate().min_element() > 0.1 && e.ends[0].truncate().max_element() < 9.9;
    assert!(walls > 20 && edges.iter().filter(upright).filter(inside).count() <= 2, "{walls}");
    // The rim of the floor is there.
    assert!(edges.iter().any(|e| e.ends.iter().all(|p| (p.z - 6.0).abs() < 1e-5) && inside(&e)));
}
