//! Cut-outs of other shapes than boxes: fences along lines of the map, outlines on the map, oblique planes.
//!
//! What is cut is a prism over a polygon of the map, or half of space. A polygon is divided into convex ones: triangles
//! by cutting off ears, joined again while they stay convex (S. Hertel and K. Mehlhorn, "Fast triangulation of simple
//! polygons", 1983).

use super::body::{Body, BodyPlane, Wall};
use super::polygon::{area, convex_parts, crosses_itself};
use super::voxel_box::VoxelBox;
use crate::geometry::SurveyGeometry;
use glam::{DMat2, DVec2, DVec3};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Largest number of planes of all shapes of a scene.
pub const MAX_PLANES: usize = 400;
/// Largest number of convex bodies of all shapes of a scene.
pub const MAX_BODIES: usize = 96;
/// Largest number of points of a line.
pub(crate) const MAX_POINTS: usize = 200;

/// A cut-out that is no box. Positions are voxels: x = inline index, y = crossline index, z = sample index downwards.
///
/// ```
/// use glam::DVec3;
/// use survey::block::{CutShape, VoxelBox};
/// let plane = CutShape::Plane { through: [10.0, 10.0, 0.0], normal: [1.0, 0.0, -1.0] };
/// let bodies = plane.bodies(&VoxelBox::of_size([41, 31, 21]), [25.0; 2], 0).unwrap();
/// assert!(bodies[0].holds(DVec3::new(30.0, 3.0, 5.0).as_vec3()));
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged, deny_unknown_fields)]
pub enum CutShape {
    /// All on one side of a wall that stands on a line of the map. Its ends go on straight.
    Fence {
        /// The line's points, at least two.
        fence: Vec<[f64; 2]>,
        /// The side that is cut away, seen along the line on a map with x to the right and y up.
        side: Side,
        /// Whether a curve is led through the points.
        #[serde(default)]
        smooth: bool,
        /// Smallest and largest z of what is cut; absent: all of it.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        depth: Option<[f64; 2]>,
    },
    /// All within a closed line of the map.
    Outline {
        /// The line's points, at least three; the first one is not repeated.
        outline: Vec<[f64; 2]>,
        /// Whether a curve is led through the points.
        #[serde(default)]
        smooth: bool,
        /// Smallest and largest z of what is cut; absent: all of it.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        depth: Option<[f64; 2]>,
    },
    /// All on one side of a plane.
    Plane {
        /// A point of the plane.
        through: [f64; 3],
        /// Its normal into what is cut away: n·(p − through) > 0 there.
        normal: [f64; 3],
    },
}

/// Why a cut-out cannot be drawn, and what to change.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct CutShapeError(pub String);

/// A side of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Side {
    /// Left, towards larger y if the line runs towards larger x.
    Left,
    /// Right.
    Right,
}

impl Side {
    /// The side of a line, voxel x and y, from which a direction comes.
    pub fn facing(line: &[[f64; 2]], towards: DVec2) -> Self {
        let (Some(first), Some(last)) = (line.first(), line.last()) else { return Self::Left };
        let along = DVec2::from(*last) - DVec2::from(*first);
        if along.perp_dot(towards) >= 0.0 { Self::Left } else { Self::Right }
    }

    /// The other one.
    pub fn other(self) -> Self {
        if self == Self::Left { Self::Right } else { Self::Left }
    }
}

/// Largest turn between two planes of a curve, radians.
const TURN: f64 = 0.12;
/// Most planes between two points of a curve.
const MOST_PARTS: usize = 24;
/// Planes with which a fence is closed far outside the block.
const FAR_POINTS: usize = 8;
/// Points closer than this are one, voxels.
const SAME: f64 = 1e-6;
/// Points of a round shaft, through which a curve is led.
const ROUND_POINTS: usize = 12;

/// A polygon of the map.
struct Outline {
    points: Vec<DVec2>,
    /// The first `walls` sides, from point n to the next, are walls.
    walls: usize,
    smooth: bool,
    depth: Option<[f64; 2]>,
}

/// What a cut leaves of a block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Leaves {
    /// It lies beside the block.
    Everything,
    /// It runs through the block.
    Part,
    /// The block lies in it as a whole.
    Nothing,
}

impl CutShape {
    /// A round shaft around a voxel x and y, between two z or over the whole height.
    pub fn round(centre: DVec2, radius_m: f64, depth: Option<[f64; 2]>, geometry: &SurveyGeometry) -> Self {
        let from_metres = DMat2::from_cols(geometry.inline_vector, geometry.crossline_vector).inverse();
        let point = |n: usize| {
            let direction = DVec2::from_angle(TAU * n as f64 / ROUND_POINTS as f64);
            (centre + from_metres * (direction * radius_m)).to_array()
        };
        Self::Outline { outline: (0..ROUND_POINTS).map(point).collect(), smooth: true, depth }
    }

    /// All above a plane through a voxel that dips towards a bearing (degrees clockwise from north) by `dip_deg`.
    pub fn dipping(through: DVec3, bearing_deg: f64, dip_deg: f64, geometry: &SurveyGeometry) -> Self {
        let ((east, north), (sin, cos)) = (bearing_deg.to_radians().sin_cos(), dip_deg.to_radians().sin_cos());
        let up = DVec3::new(east * sin, north * sin, cos);
        // As a covector of voxels.
        let normal = [
            up.dot(geometry.inline_vector.extend(0.0)),
            up.dot(geometry.crossline_vector.extend(0.0)),
            -up.z * geometry.sample_m(),
        ];
        Self::Plane { through: through.to_array(), normal }
    }

    /// Bearing and angle of a plane's dip, degrees; `None` for other shapes and for planes that cut what lies below.
    pub fn bearing_and_dip(&self, geometry: &SurveyGeometry) -> Option<[f64; 2]> {
        let Self::Plane { normal, .. } = self else { return None };
        let steps = DMat2::from_cols(geometry.inline_vector, geometry.crossline_vector).transpose();
        let level = steps.inverse() * DVec2::new(normal[0], normal[1]);
        let up = -normal[2] / geometry.sample_m();
        let bearing_deg = level.x.atan2(level.y).to_degrees().rem_euclid(360.0);
        (up >= -1e-9 * level.length()).then(|| [bearing_deg, level.length().atan2(up.max(0.0)).to_degrees()])
    }

    /// Checks the shape by itself.
    ///
    /// # Errors
    /// What is wrong with it, and what to change.
    pub fn validate(&self, block: &VoxelBox) -> Result<(), CutShapeError> {
        let refused = |reason: String| Err(CutShapeError(reason));
        match self {
            Self::Plane { through, normal } => {
                let length = DVec3::from_array(*normal).length();
                if !(DVec3::from_array(*through).is_finite() && length > 1e-9 && length.is_finite()) {
                    return refused("a plane needs a point of numbers and a normal that is not zero".into());
                }
            }
            Self::Fence { fence: points, depth, .. } | Self::Outline { outline: points, depth, .. } => {
                let least = if matches!(self, Self::Fence { .. }) { 2 } else { 3 };
                let all = points.iter().flatten().chain(depth.iter().flatten());
                if points.len() < least || points.len() > MAX_POINTS {
                    let found = points.len();
                    return refused(format!("its line has {found} points; it needs {least} to {MAX_POINTS}"));
                }
                if all.into_iter().any(|number| !number.is_finite() || number.abs() > 1e7) {
                    return refused("a coordinate is no number, or far outside the survey".into());
                }
                if depth.is_some_and(|[top, bottom]| top >= bottom) {
                    return refused("its depths must run from the shallower to the deeper one".into());
                }
                let same = |a: &[f64; 2], b: &[f64; 2]| DVec2::from(*a).distance(DVec2::from(*b)) < SAME;
                let closes = least == 3 && same(&points[0], &points[points.len() - 1]);
                if let Some(n) = points.windows(2).position(|pair| same(&pair[0], &pair[1])) {
                    return refused(format!("points {} and {} of its line are the same; leave one out", n + 1, n + 2));
                }
                if closes {
                    return refused("the first point of an outline is not repeated as its last".into());
                }
            }
        }
        if self.bodies(block, [1.0; 2], 0).is_none() {
            return refused("its line crosses itself, or would when its ends go on straight; move its points".into());
        }
        Ok(())
    }

    /// What the shape leaves of a block. A shape that [`CutShape::validate`] refuses cuts nothing.
    pub fn leaves(&self, block: &VoxelBox) -> Leaves {
        let bodies = self.bodies(block, [1.0; 2], 0).unwrap_or_default();
        let runs_through =
            |body: &Body| (0..body.planes.len()).any(|n| !body.face(n, [block.low(), block.high()]).is_empty());
        match bodies {
            bodies if bodies.iter().any(runs_through) => Leaves::Part,
            bodies if bodies.iter().any(|body| body.holds(block.centre().as_vec3())) => Leaves::Nothing,
            _ => Leaves::Everything,
        }
    }

    /// The convex bodies of the shape; `None` if its line crosses itself. `voxel_m`: metres between voxels along x and
    /// y; `number` is that of its curve.
    pub fn bodies(&self, block: &VoxelBox, voxel_m: [f64; 2], number: usize) -> Option<Vec<Body>> {
        let outline = match self {
            Self::Plane { through, normal } => {
                let normal = -DVec3::from_array(*normal);
                return Some(vec![Body { planes: vec![BodyPlane::through(DVec3::from_array(*through), normal)] }]);
            }
            Self::Fence { fence, side, smooth, depth } => {
                Outline { depth: *depth, ..Outline::of_fence(fence, *side, *smooth, block) }
            }
            Self::Outline { outline, smooth, depth } => {
                let points: Vec<DVec2> = outline.iter().map(|p| DVec2::from(*p)).collect();
                let points = if *smooth { curve(&points, true) } else { points };
                Outline { walls: points.len(), points, smooth: *smooth, depth: *depth }
            }
        };
        outline.bodies(DVec2::from(voxel_m), number)
    }
}

impl Outline {
    /// The polygon on one side of a line whose ends go on straight.
    fn of_fence(fence: &[[f64; 2]], side: Side, smooth: bool, block: &VoxelBox) -> Self {
        let line: Vec<DVec2> = fence.iter().map(|p| DVec2::from(*p)).collect();
        let mut line = if smooth { curve(&line, false) } else { line };
        if side == Side::Right {
            line.reverse();
        }
        // What is cut lies to the left now. The far circle holds the block and the line.
        let centre = block.centre().truncate();
        let reach = block.extent().truncate().length();
        let radius = 3.0 * line.iter().map(|p| p.distance(centre)).fold(reach, f64::max);
        let far = |from: DVec2, towards: DVec2| {
            let d = (towards - from).normalize();
            let along = d.dot(from - centre);
            let t = -along + (along * along - (from - centre).length_squared() + radius * radius).max(0.0).sqrt();
            from + d * t
        };
        let count = line.len();
        let (first, last) = (far(line[1], line[0]), far(line[count - 2], line[count - 1]));
        let angle = |p: DVec2| (p - centre).to_angle();
        let turn = (angle(first) - angle(last)).rem_euclid(TAU);
        let around = (1..FAR_POINTS)
            .map(|n| centre + DVec2::from_angle(angle(last) + turn * n as f64 / FAR_POINTS as f64) * radius);
        let points: Vec<DVec2> = std::iter::once(first).chain(line).chain([last]).chain(around).collect();
        Self { points, walls: count + 1, smooth, depth: None }
    }

    fn bodies(mut self, voxel_m: DVec2, number: usize) -> Option<Vec<Body>> {
        if crosses_itself(&self.points) {
            return None;
        }
        // Counter-clockwise. A fence is so already.
        if area(&self.points) < 0.0 {
            self.points.reverse();
        }
        self.remove_straight_corners();
        let walls = self.walls(voxel_m, number);
        let depth = self
            .depth
            .map(|[top, bottom]| [BodyPlane::of_axis(2, top as f32, -1.0), BodyPlane::of_axis(2, bottom as f32, 1.0)]);
        let body = |corners: &Vec<usize>| {
            let side = |n: usize| {
                let (a, b) = (corners[n], corners[(n + 1) % corners.len()]);
                let (p, q) = (self.points[a], self.points[b]);
                let normal = -(q - p).perp();
                let plane = BodyPlane::through(p.extend(0.0), normal.extend(0.0));
                let is_side = b == (a + 1) % self.points.len();
                BodyPlane { is_seam: !is_side, wall: walls.get(a).copied().filter(|_| is_side), ..plane }
            };
            Body { planes: (0..corners.len()).map(side).chain(depth.into_iter().flatten()).collect() }
        };
        Some(convex_parts(&self.points).iter().map(body).collect())
    }

    /// Leaves out corners at which the line goes straight on: their walls are one plane.
    fn remove_straight_corners(&mut self) {
        let count = self.points.len();
        let is_straight = |n: usize| {
            let [a, b, c] = [n + count - 1, n, n + 1].map(|n| self.points[n % count]);
            (b - a).perp_dot(c - b).abs() < 1e-9 * (b - a).length() * (c - b).length()
        };
        let kept: Vec<usize> = (0..count).filter(|n| !is_straight(*n)).collect();
        self.walls = kept.iter().filter(|n| **n < self.walls).count();
        self.points = kept.into_iter().map(|n| self.points[n]).collect();
    }

    /// How the walls go on from one to the next, by the point at which they begin.
    fn walls(&self, voxel_m: DVec2, number: usize) -> Vec<Wall> {
        let side = |n: usize| {
            let (a, b) = (self.points[n], self.points[(n + 1) % self.points.len()]);
            (a * voxel_m, ((b - a) * voxel_m).normalize_or(DVec2::X))
        };
        // As on a single wall, the larger part of the first direction is positive.
        let (_, first) = side(0);
        let sign = if first.abs().max_element() == first.max_element() { 1.0 } else { -1.0 };
        let mut shift = 0.0;
        (0..self.walls)
            .map(|n| {
                let (at, along) = side(n);
                if n > 0 {
                    let (_, before) = side(n - 1);
                    shift += sign * (before - along).dot(at);
                }
                let [x, y] = (sign * along / voxel_m).to_array();
                let curve = self.smooth.then_some(number);
                Wall { along: [x as f32, y as f32], shift_m: shift as f32, curve }
            })
            .collect()
    }
}

/// A curve through points (Catmull–Rom with knots at the root of the chord), as a line with turns of at most [`TURN`].
fn curve(points: &[DVec2], closed: bool) -> Vec<DVec2> {
    let count = points.len();
    if count < 3 {
        return points.to_vec();
    }
    let spans = if closed { count } else { count - 1 };
    let mut line = vec![points[0]];
    for span in 0..spans {
        let slopes = slopes(points, closed, span);
        let (b, c) = (points[span], points[(span + 1) % count]);
        let at = |t: f64| {
            let (t2, t3) = (t * t, t * t * t);
            b * (2.0 * t3 - 3.0 * t2 + 1.0)
                + slopes[0] * (t3 - 2.0 * t2 + t)
                + c * (3.0 * t2 - 2.0 * t3)
                + slopes[1] * (t3 - t2)
        };
        const TRIED: usize = 32;
        let tried: Vec<DVec2> = (0..=TRIED).map(|n| at(n as f64 / TRIED as f64)).collect();
        let turn: f64 = tried.windows(3).map(|p| (p[1] - p[0]).angle_to(p[2] - p[1]).abs()).sum();
        let parts = ((1.5 * turn / TURN).ceil() as usize).clamp(1, MOST_PARTS);
        line.extend((1..=parts).map(|n| at(n as f64 / parts as f64)));
    }
    if closed {
        line.pop();
    }
    line
}

/// Slopes at the ends of a span of a curve, per unit of the span. At its own ends an open curve is not bent.
fn slopes(points: &[DVec2], closed: bool, span: usize) -> [DVec2; 2] {
    let count = points.len();
    let (b, c) = (points[span], points[(span + 1) % count]);
    let knot = |p: DVec2, q: DVec2| p.distance(q).sqrt().max(1e-6);
    let own = knot(b, c);
    let slope = |n: usize| {
        let [p, q, r] = [n + count - 1, n, n + 1].map(|n| points[n % count]);
        let (before, after) = (knot(p, q), knot(q, r));
        ((q - p) / before - (r - p) / (before + after) + (r - q) / after) * own
    };
    let (first, last) = (!closed && span == 0, !closed && span + 2 == count);
    match (first, last) {
        (false, false) => [slope(span), slope((span + 1) % count)],
        (true, false) => [1.5 * (c - b) - 0.5 * slope(span + 1), slope(span + 1)],
        (false, true) => [slope(span), 1.5 * (c - b) - 0.5 * slope(span)],
        (true, true) => [c - b; 2],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BLOCK: VoxelBox = VoxelBox { min: [0.0; 3], max: [40.0, 30.0, 20.0] };

    fn cut(shape: &CutShape, p: DVec3) -> bool {
        shape.bodies(&BLOCK, [25.0; 2], 0).unwrap().iter().any(|body| body.holds(p.as_vec3()))
    }

    fn places() -> impl Iterator<Item = DVec3> {
        let part = |n: usize, k: f64| (n as f64 * k).fract();
        (0..4000).map(move |n| DVec3::new(part(n, 0.618_034), part(n, 0.414_214), part(n, 0.732_051)) * BLOCK.extent())
    }

    #[test]
    fn a_shape_beside_the_block_leaves_everything_and_one_around_it_nothing() {
        let plane = |z: f64, up: f64| CutShape::Plane { through: [20.0, 15.0, z], normal: [0.0, 0.0, up] };
        let square = |low: f64, high: f64| CutShape::Outline {
            outline: vec![[low, low], [high, low], [high, high], [low, high]],
            smooth: false,
            depth: None,
        };
        let left = |shape: &CutShape| (shape.leaves(&BLOCK), places().filter(|p| !cut(shape, *p)).count());
        for (shape, expected) in [
            (plane(7.0, -1.0), Leaves::Part),
            (plane(-3.0, -1.0), Leaves::Everything),
            (plane(23.0, -1.0), Leaves::Nothing),
            (square(10.0, 20.0), Leaves::Part),
            (square(-20.0, -10.0), Leaves::Everything),
            (square(-10.0, 60.0), Leaves::Nothing),
        ] {
            let (leaves, places_left) = left(&shape);
            let by_places = match places_left {
                0 => Leaves::Nothing,
                4000 => Leaves::Everything,
                _ => Leaves::Part,
            };
            assert_eq!((leaves, by_places), (expected, expected), "{shape:?}");
        }
    }

    #[test]
    fn a_straight_fence_in_any_direction_crosses_nothing() {
        for n in 0..4000 {
            let at = |k: usize| 60.0 * ((n * 4 + k) as f64 * 0.618_034).fract() - 5.0;
            let [a, b] = [[at(0), at(1)], [at(2), at(3)]];
            let middle = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
            for points in [vec![a, b], vec![a, middle, b]] {
                let fence = CutShape::Fence { fence: points, side: Side::Left, smooth: false, depth: None };
                assert_eq!(fence.validate(&BLOCK), Ok(()), "{fence:?}");
            }
        }
    }

    #[test]
    fn a_plane_cuts_one_side() {
        let plane = CutShape::Plane { through: [10.0, 5.0, 8.0], normal: [1.0, 2.0, -3.0] };
        for p in places() {
            let side = (p - DVec3::new(10.0, 5.0, 8.0)).dot(DVec3::new(1.0, 2.0, -3.0));
            assert!(side.abs() < 1e-3 || cut(&plane, p) == (side > 0.0), "{p}");
        }
    }

    #[test]
    fn dips_and_radii_are_those_of_the_ground() {
        let geometry = SurveyGeometry::regular([41, 31, 21], 25.0, 10.0, crate::VerticalUnit::Metres);
        let world = |p: DVec3| geometry.world_from_voxel(p);
        let at = DVec3::new(20.0, 15.0, 10.0);
        // Dips to the south-east by 30°: 100 m in that direction it lies 57.7 m deeper.
        let plane = CutShape::dipping(at, 135.0, 30.0, &geometry);
        let ahead = world(at) + DVec3::new(70.711, -70.711, 0.0);
        let inside = |depth_m: f64| cut(&plane, geometry.voxel_from_world(ahead + DVec3::Z * depth_m));
        assert!(inside(57.2) && !inside(58.2));
        let [bearing_deg, dip_deg] = plane.bearing_and_dip(&geometry).unwrap();
        assert!((bearing_deg - 135.0).abs() < 1e-6 && (dip_deg - 30.0).abs() < 1e-6);
        let CutShape::Outline { outline, .. } = CutShape::round(at.truncate(), 120.0, None, &geometry) else {
            panic!()
        };
        for p in outline {
            let off = (world(DVec2::from(p).extend(10.0)) - world(at)).length();
            assert!((off - 120.0).abs() < 1e-6, "{off}");
        }
    }

    /// The even-odd rule is the oracle of the division into convex bodies.
    #[test]
    fn an_outline_with_bays_is_cut_exactly() {
        let star: Vec<[f64; 2]> = (0..14)
            .map(|n| {
                let radius = if n % 2 == 0 { 14.0 } else { 6.0 + 0.3 * f64::from(n) };
                (DVec2::from_angle(f64::from(n) * TAU / 14.0) * radius + DVec2::new(20.0, 15.0)).to_array()
            })
            .collect();
        for points in [star.clone(), star.into_iter().rev().collect()] {
            let inside = |p: DVec2| {
                let crossed = (0..points.len()).filter(|&n| {
                    let (a, b) = (DVec2::from(points[n]), DVec2::from(points[(n + 1) % points.len()]));
                    (a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y)
                });
                crossed.count() % 2 == 1
            };
            let shape = CutShape::Outline { outline: points.clone(), smooth: false, depth: Some([3.0, 12.0]) };
            let expected = |p: DVec3| inside(p.truncate()) && p.z > 3.0 && p.z < 12.0;
            let wrong = places().filter(|p| cut(&shape, *p) != expected(*p)).count();
            // Places on a seam belong to no open body.
            assert!(wrong <= 2, "{wrong}");
            let bodies = shape.bodies(&BLOCK, [25.0; 2], 0).unwrap();
            assert!(bodies.len() < points.len() - 2, "joined where they stay convex: {}", bodies.len());
        }
    }

    #[test]
    fn a_fence_cuts_the_side_it_names() {
        let fence = |side, smooth| CutShape::Fence {
            fence: vec![[5.0, 10.0], [20.0, 12.0], [30.0, 22.0]],
            side,
            smooth,
            depth: None,
        };
        // Far below and above the line, beyond its ends as well.
        for (p, is_left) in [([8.0, 28.0], true), ([1.0, 12.0], true), ([38.0, 5.0], false), ([39.0, 28.0], false)] {
            let p = DVec2::from(p).extend(9.0);
            for smooth in [false, true] {
                assert_eq!(cut(&fence(Side::Left, smooth), p), is_left, "{p}");
                assert_eq!(cut(&fence(Side::Right, smooth), p), !is_left, "{p}");
            }
        }
    }

    #[test]
    fn metres_along_a_wall_go_on_around_its_corners() {
        let fence = CutShape::Fence {
            fence: vec![[5.0, 10.0], [20.0, 12.0], [30.0, 22.0]],
            side: Side::Left,
            smooth: true,
            depth: None,
        };
        let bodies = fence.bodies(&BLOCK, [25.0, 12.5], 3).unwrap();
        let walls: Vec<&BodyPlane> =
            bodies.iter().flat_map(|body| &body.planes).filter(|plane| plane.wall.is_some()).collect();
        assert!(walls.len() > 6 && walls.iter().all(|plane| plane.wall.is_some_and(|wall| wall.curve == Some(3))));
        let metres = |plane: &BodyPlane, p: DVec2| {
            let wall = plane.wall.unwrap();
            let along = DVec2::from(wall.along.map(f64::from)) * DVec2::new(25.0, 12.5);
            assert!((along.length() - 1.0).abs() < 1e-5);
            along.dot(p * DVec2::new(25.0, 12.5)) + f64::from(wall.shift_m)
        };
        let mut edges = 0;
        for (n, one) in walls.iter().enumerate() {
            for other in &walls[n + 1..] {
                let (a, b) = (one.normal.truncate().as_dvec2(), other.normal.truncate().as_dvec2());
                let det = a.perp_dot(b);
                let meets = DVec2::new(
                    f64::from(one.offset) * b.y - f64::from(other.offset) * a.y,
                    f64::from(other.offset) * a.x - f64::from(one.offset) * b.x,
                ) / det;
                // Neighbours meet on the line.
                let on = |plane: &BodyPlane| plane.distance(meets.extend(0.0).as_vec3()).abs() < 1e-3;
                if a.dot(b) > (1.3 * TURN).cos()
                    && det.abs() > 1e-6
                    && on(one)
                    && on(other)
                    && meets.x > 5.0
                    && meets.x < 30.0
                {
                    let step = (metres(one, meets) - metres(other, meets)).abs();
                    edges += usize::from(step < 1e-2);
                }
            }
        }
        assert!(edges >= walls.len() - 3, "{edges} of {}", walls.len());
    }

    #[test]
    fn what_is_no_shape_is_refused_with_a_sentence() {
        let refused = |shape: CutShape| shape.validate(&BLOCK).unwrap_err().to_string();
        let outline = |points: &[[f64; 2]]| CutShape::Outline { outline: points.to_vec(), smooth: false, depth: None };
        assert!(refused(outline(&[[1.0, 1.0], [2.0, 2.0]])).contains("2 points"));
        assert!(refused(outline(&[[0.0, 0.0], [9.0, 9.0], [9.0, 0.0], [0.0, 9.0]])).contains("crosses itself"));
        assert!(refused(outline(&[[0.0, 0.0], [9.0, 9.0], [9.0, f64::NAN]])).contains("no number"));
        assert!(refused(outline(&[[0.0, 0.0], [9.0, 9.0], [9.0, 9.0]])).contains("points 2 and 3"));
        assert!(refused(CutShape::Plane { through: [0.0; 3], normal: [0.0; 3] }).contains("normal"));
        let deep = CutShape::Outline {
            outline: vec![[1.0, 1.0], [9.0, 1.0], [9.0, 9.0]],
            smooth: false,
            depth: Some([5.0, 5.0]),
        };
        assert!(refused(deep).contains("depths"));
        let spiral = CutShape::Fence {
            fence: vec![[10.0, 10.0], [20.0, 10.0], [20.0, 20.0], [10.0, 20.0], [10.0, 12.0]],
            side: Side::Left,
            smooth: false,
            depth: None,
        };
        assert!(refused(spiral).contains("ends go on straight"));
    }
}
