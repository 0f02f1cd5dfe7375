//! Which part of a face is seen, against rays.

use super::*;
use crate::{Camera, Corner, CutShape, Side, VoxelBox};
use glam::Vec3;
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
    let square =
        |low: f64, high: f64| vec![DVec2::splat(low), DVec2::new(high, low), DVec2::splat(high), DVec2::new(low, high)];
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
        let shapes = [
            CutShape::Plane { through: [7.0, 8.0, 9.0], normal: [-1.0, -0.6, -0.8] },
            CutShape::Fence {
                fence: vec![[2.0, 17.0], [9.0, 9.0], [12.0, 12.0], [18.0, 3.0]],
                side: Side::Right,
                smooth: false,
                depth: Some([0.0, 11.0]),
            },
        ];
        let shaped = |n: usize| shapes[n].bodies(&block, [10.0; 2], n).unwrap();
        for (cuts, bodies) in [
            (vec![], vec![]),
            (stair.clone(), vec![]),
            (vec![inner], vec![]),
            ([stair.clone(), vec![inner]].concat(), vec![]),
            (vec![], shaped(0)),
            (vec![], shaped(1)),
            (vec![inner], [shaped(0), shaped(1)].concat()),
        ] {
            let mut solid = Solid::of_boxes(&block, &cuts);
            solid.cut_outs.extend(bodies.clone());
            let faces = seen_faces(&solid, &view);
            let pieces: Vec<Vec<Vec<DVec2>>> = (0..faces.len())
                .map(|n| seen_pieces(&faces, n, &view, false).unwrap_or_else(|| faces[n].quads(&view)))
                .collect();
            let (mut tested, mut wrong) = (0, 0);
            for n in 0..160 * 140 {
                let pixel = DVec2::new(f64::from(n % 160) + 0.5, f64::from(n / 160) + 0.5);
                let hit = solid.next_span(&Ray::from(view.ray(pixel)), f32::MIN).map(|span| span.entry);
                let counts: Vec<usize> = pieces.iter().map(|pieces| inside(pieces, pixel)).collect();
                let expected = hit.map(|hit| (hit.plane.normal, hit.plane.offset));
                let found: Vec<(Vec3, f32)> = (0..faces.len())
                    .filter(|n| counts[*n] > 0)
                    .map(|n| (faces[n].face.plane.normal, faces[n].face.plane.offset))
                    .collect();
                // A plane may bound the block on one side and a cut-out on the other.
                let same = |(a, at): &(Vec3, f32), (b, other): &(Vec3, f32)| {
                    (*a - *b).length() < 1e-6 && at == other || (*a + *b).length() < 1e-6 && *at == -other
                };
                let agrees = match (expected, found.as_slice()) {
                    (None, []) => true,
                    (Some(expected), [found]) => same(&expected, found),
                    _ => false,
                };
                tested += 1;
                wrong += usize::from(!agrees || counts.iter().any(|count| *count > 1));
            }
            // A ray through a pixel that an edge passes may fall on either side.
            assert!(wrong * 2000 < tested, "{wrong} of {tested} with {} cuts from {azimuth}", cuts.len());
        }
    }
}
