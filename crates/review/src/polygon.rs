//! Convex polygons: what lies outside of a body, meshes of them, and the edges that only one of them has.

use crate::model::Mesh;
use glam::DVec3;
use std::collections::HashMap;
use survey::block::{Body, part_behind};

/// Corners closer than this are one, voxels.
const SAME: f64 = 1e-5;

/// The triangles of a convex polygon of so many corners.
pub(crate) fn fan(corners: usize) -> impl Iterator<Item = [usize; 3]> {
    (2..corners).map(|n| [0, n - 1, n])
}

/// A convex polygon less a convex body, in convex pieces, and its part within the body. Whatever the body does not touch
/// stays one piece.
pub(crate) fn split(polygon: Vec<DVec3>, body: &Body) -> (Vec<Vec<DVec3>>, Option<Vec<DVec3>>) {
    let (mut pieces, mut rest) = (Vec::new(), polygon.clone());
    for plane in &body.planes {
        let side = |p: DVec3| plane.normal.as_dvec3().dot(p) - f64::from(plane.offset);
        let beyond = part_behind(&rest, |p| -side(p));
        rest = part_behind(&rest, side);
        if area(&beyond) > 1e-9 {
            pieces.push(beyond);
        }
        if area(&rest) <= 1e-9 {
            return (vec![polygon], None);
        }
    }
    (pieces, Some(rest))
}

fn area(polygon: &[DVec3]) -> f64 {
    let turn = |[a, b, c]: [usize; 3]| (polygon[b] - polygon[a]).cross(polygon[c] - polygon[a]);
    0.5 * fan(polygon.len()).map(turn).sum::<DVec3>().length()
}

/// Makes one mesh of polygons, with shared corners.
#[derive(Default)]
pub(crate) struct Welder {
    pub mesh: Mesh,
    known: HashMap<[i64; 3], u32>,
}

impl Welder {
    /// Adds a convex polygon.
    pub(crate) fn add(&mut self, polygon: &[DVec3]) {
        let corners: Vec<u32> = polygon.iter().map(|p| self.corner(*p)).collect();
        for [a, b, c] in fan(corners.len()) {
            let triangle = [corners[a], corners[b], corners[c]];
            if triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0] {
                self.mesh.triangles.push(triangle);
            }
        }
    }

    fn corner(&mut self, p: DVec3) -> u32 {
        let points = &mut self.mesh.points;
        *self.known.entry(key(p)).or_insert_with(|| {
            points.push(p);
            (points.len() - 1) as u32
        })
    }
}

fn key(p: DVec3) -> [i64; 3] {
    (p / SAME).round().to_array().map(|n| n as i64)
}

/// The borders of convex polygons in one plane, less what two of them share.
pub(crate) fn borders(cells: &[Vec<DVec3>]) -> Vec<[DVec3; 2]> {
    let sides = |cell: &Vec<DVec3>| (0..cell.len()).map(|n| [cell[n], cell[(n + 1) % cell.len()]]).collect::<Vec<_>>();
    let all: Vec<Vec<[DVec3; 2]>> = cells.iter().map(sides).collect();
    let mut open = Vec::new();
    for (n, own) in all.iter().enumerate() {
        for side in own {
            let mut left = vec![[0.0, 1.0]];
            for other in all.iter().enumerate().filter(|(m, _)| *m != n).flat_map(|(_, other)| other) {
                if let Some([from, to]) = shared(*side, *other) {
                    left = left
                        .into_iter()
                        .flat_map(|[a, b]: [f64; 2]| [[a, b.min(from)], [a.max(to), b]])
                        .filter(|[a, b]| b - a > 1e-9)
                        .collect();
                }
            }
            open.extend(left.into_iter().map(|ends| ends.map(|share| side[0].lerp(side[1], share))));
        }
    }
    open
}

/// The part of a side that another one covers, as shares of its length.
fn shared(side: [DVec3; 2], other: [DVec3; 2]) -> Option<[f64; 2]> {
    let along = side[1] - side[0];
    let length_sq = along.length_squared();
    let place = |p: DVec3| along.dot(p - side[0]) / length_sq;
    let off = |p: DVec3| (p - side[0] - along * place(p)).length();
    if length_sq < 1e-12 || other.iter().any(|p| off(*p) > 1e-4) {
        return None;
    }
    let [a, b] = other.map(place);
    let (from, to) = (a.min(b).max(0.0), a.max(b).min(1.0));
    (to - from > 1e-9).then_some([from, to])
}

/// The part of a straight piece inside a convex polygon of the same plane.
pub(crate) fn within([a, b]: [DVec3; 2], cell: &[DVec3], normal: DVec3) -> Option<[DVec3; 2]> {
    let turn: DVec3 = fan(cell.len()).map(|[p, q, r]| (cell[q] - cell[p]).cross(cell[r] - cell[p])).sum();
    let normal = if turn.dot(normal) < 0.0 { -normal } else { normal };
    let (mut from, mut to) = (0.0f64, 1.0f64);
    for n in 0..cell.len() {
        let (p, q) = (cell[n], cell[(n + 1) % cell.len()]);
        let inwards = normal.cross(q - p).normalize_or_zero();
        let (at_a, at_b) = (inwards.dot(a - p) + 1e-6, inwards.dot(b - p) + 1e-6);
        if at_a < 0.0 && at_b < 0.0 {
            return None;
        }
        if at_a < 0.0 {
            from = from.max(at_a / (at_a - at_b));
        } else if at_b < 0.0 {
            to = to.min(at_a / (at_a - at_b));
        }
    }
    (to - from > 1e-9).then(|| [a.lerp(b, from), a.lerp(b, to)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    fn square(low: f64, high: f64) -> Vec<DVec3> {
        [[low, low], [high, low], [high, high], [low, high]].map(|[x, y]| DVec3::new(x, y, 0.0)).to_vec()
    }

    #[test]
    fn a_square_less_a_box_has_the_area_that_is_left() {
        let body = Body::of_box([Vec3::new(1.0, 1.0, -1.0), Vec3::new(2.0, 3.0, 1.0)]);
        let left: f64 = split(square(0.0, 4.0), &body).0.iter().map(|piece| area(piece)).sum();
        assert!((left - 14.0).abs() < 1e-9, "{left}");
        let far = Body::of_box([Vec3::splat(7.0), Vec3::splat(8.0)]);
        assert_eq!(split(square(0.0, 4.0), &far), (vec![square(0.0, 4.0)], None));
        let inside = split(square(0.0, 4.0), &body).1.unwrap();
        assert!((area(&inside) - 2.0).abs() < 1e-9);
    }

    #[test]
    fn pieces_that_touch_have_one_border() {
        let body = Body::of_box([Vec3::new(1.0, -1.0, -1.0), Vec3::new(2.0, 5.0, 1.0)]);
        let (pieces, _) = split(square(0.0, 4.0), &body);
        let around: f64 = borders(&pieces).iter().map(|[a, b]| a.distance(*b)).sum();
        // Two strips of 1 × 4 and 2 × 4.
        assert!((around - 22.0).abs() < 1e-6, "{around}");
        let whole: f64 =
            borders(&split(square(0.0, 4.0), &Body::of_box([Vec3::new(3.0, 3.0, -1.0), Vec3::splat(9.0)])).0)
                .iter()
                .map(|[a, b]| a.distance(*b))
                .sum();
        assert!((whole - 16.0).abs() < 1e-6, "{whole}");
    }

    #[test]
    fn a_line_is_cut_at_a_polygon() {
        let ends =
            within([DVec3::new(-2.0, 1.0, 0.0), DVec3::new(6.0, 1.0, 0.0)], &square(0.0, 4.0), DVec3::Z).unwrap();
        assert!(
            ends[0].distance(DVec3::new(0.0, 1.0, 0.0)) < 1e-5 && ends[1].distance(DVec3::new(4.0, 1.0, 0.0)) < 1e-5
        );
        assert!(within([DVec3::new(-2.0, 5.0, 0.0), DVec3::new(6.0, 5.0, 0.0)], &square(0.0, 4.0), DVec3::Z).is_none());
    }

    #[test]
    fn corners_are_shared() {
        let mut welder = Welder::default();
        welder.add(&square(0.0, 4.0));
        welder.add(&[DVec3::new(4.0, 0.0, 0.0), DVec3::new(8.0, 0.0, 0.0), DVec3::new(4.0, 4.0, 0.0)]);
        assert_eq!((welder.mesh.points.len(), welder.mesh.triangles.len()), (5, 3));
    }
}
