//! The first point of a solid on a ray, in closed form and beside small steps.

use super::*;
use crate::CutShape;

fn block() -> Solid {
    Solid::new([Vec3::ZERO, Vec3::splat(10.0)], Vec::new())
}

fn along_x(y: f32, z: f32) -> Ray {
    Ray { origin: Vec3::new(-5.0, y, z), direction: Vec3::X }
}

#[test]
fn the_front_face_without_cut_outs() {
    let span = block().next_span(&along_x(4.0, 6.0), f32::MIN).unwrap();
    assert_eq!(
        (span.entry.t, span.entry.point, span.entry.plane.axis, span.end),
        (5.0, Vec3::new(0.0, 4.0, 6.0), Some(0), 15.0)
    );
    assert_eq!(block().next_span(&along_x(10.5, 6.0), f32::MIN), None);
    assert_eq!(block().next_span(&along_x(4.0, 6.0), 15.0), None);
}

#[test]
fn a_cut_out_shows_its_back_face() {
    let mut solid = block();
    solid.cut_outs.push(Body::of_box([Vec3::ZERO, Vec3::new(3.0, 10.0, 10.0)]));
    let span = solid.next_span(&along_x(4.0, 6.0), f32::MIN).unwrap();
    assert_eq!((span.entry.point, span.entry.plane.axis), (Vec3::new(3.0, 4.0, 6.0), Some(0)));
    let backwards = Ray { origin: Vec3::new(15.0, 4.0, 6.0), direction: -Vec3::X };
    let span = solid.next_span(&backwards, f32::MIN).unwrap();
    assert_eq!((span.entry.t, span.end), (5.0, 12.0));
    assert_eq!(solid.next_span(&backwards, 12.0), None);
}

#[test]
fn touching_and_overlapping_cut_outs_are_passed_in_any_order() {
    for order in [[0, 1, 2], [2, 1, 0], [1, 2, 0]] {
        let cuts = [[0.0, 2.0], [2.0, 4.0], [3.5, 6.0]];
        let mut solid = block();
        solid.cut_outs =
            order.map(|n| Body::of_box([Vec3::new(cuts[n][0], 0.0, 0.0), Vec3::new(cuts[n][1], 10.0, 10.0)])).to_vec();
        assert_eq!(solid.next_span(&along_x(4.0, 6.0), f32::MIN).unwrap().entry.point.x, 6.0);
    }
}

/// Compares with small steps along rays that test each point.
#[test]
fn it_agrees_with_walking() {
    let mut solid = block();
    solid.cut_outs = vec![
        Body::of_box([Vec3::new(5.0, 0.0, 0.0), Vec3::new(10.0, 5.0, 10.0)]),
        Body::of_box([Vec3::new(2.0, 4.0, 0.0), Vec3::new(7.0, 8.0, 5.0)]),
        Body::of_box([Vec3::new(3.0, 3.0, 3.0), Vec3::new(6.0, 6.0, 9.0)]),
    ];
    let block = VoxelBox::of_size([11; 3]);
    let bay = vec![[1.0, 8.0], [6.0, 9.5], [9.0, 5.5], [9.5, 9.8], [1.0, 9.9]];
    let shapes = [
        CutShape::Plane { through: [8.0, 2.0, 8.0], normal: [1.0, 0.3, 0.8] },
        CutShape::Outline { outline: bay, smooth: false, depth: Some([2.0, 7.0]) },
    ];
    solid.cut_outs.extend(shapes.iter().flat_map(|shape| shape.bodies(&block, [1.0; 2], 0).unwrap()));
    for n in 0..500 {
        let turn = n as f32 * 0.61;
        let direction = Vec3::new(turn.cos(), turn.sin(), 0.4 * (turn * 1.7).sin() + 0.05).normalize();
        let through = Vec3::new(3.0 + (n % 7) as f32 * 0.7, 2.0 + (n % 5) as f32 * 1.3, 1.0 + (n % 11) as f32 * 0.7);
        let ray = Ray { origin: through - direction * 30.0, direction };
        // Rock shorter than the tolerance does not count, as at an edge that the ray grazes.
        let rock = |t: f32| (0..5).all(|step| solid.contains(ray.at(t + step as f32 * 1e-3)));
        let walked = (0..60_000).map(|s| s as f32 * 1e-3).find(|t| rock(*t));
        let found = solid.next_span(&ray, f32::MIN).map(|span| span.entry.t);
        match (walked, found) {
            (Some(walked), Some(found)) => assert!((walked - found).abs() < 5e-3, "ray {n}: {walked} or {found}"),
            (walked, found) => assert_eq!(walked.is_some(), found.is_some(), "ray {n}: {walked:?} or {found:?}"),
        }
    }
}
