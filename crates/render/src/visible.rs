//! Finds the first point of the solid block on a ray (P-illus 5.1): inside the roaming box and outside every
//! cut-out.
//!
//! A ray crosses each body over an interval of t. The solid part is the interval of the roaming box minus
//! those of the cut-outs: from a start t, while the point is inside a cut-out, t moves to the exit of that
//! cut-out. Only the ends of intervals are compared, so any number of overlapping or touching cut-outs works,
//! and the plane of the hit is known exactly.
//!
//! Voxel space, f32. Rays have unit direction, so t is in voxels. The shader `visible.wgsl` computes the
//! same.

use crate::camera::ViewRay;
use glam::Vec3;
pub use survey::block::Ray;
use survey::block::VoxelBox;
use survey::block::{Body, BodyPlane};

/// Boxes closer than this along a ray count as touching, voxels.
pub const TOUCH: f32 = 1e-3;

impl From<ViewRay> for Ray {
    fn from(ray: ViewRay) -> Self {
        Self { origin: ray.origin.as_vec3(), direction: ray.direction.as_vec3() }
    }
}

/// A plane that a ray meets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FaceHit {
    /// Distance along the ray, voxels.
    pub t: f32,
    /// The hit point; on a plane of constant x, y or z that coordinate is exact.
    pub point: Vec3,
    /// The plane.
    pub plane: BodyPlane,
}

/// A stretch of solid rock along a ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SolidSpan {
    /// The face at which it begins.
    pub entry: FaceHit,
    /// Distance at which it ends, voxels.
    pub end: f32,
}

/// The solid block: the roaming box minus its cut-outs.
///
/// ```
/// use glam::Vec3;
/// use survey::block::Body;
/// use render::visible::{Ray, Solid};
/// let cut_out = Body::of_box([Vec3::ZERO, Vec3::new(3.0, 10.0, 10.0)]);
/// let solid = Solid::new([Vec3::ZERO, Vec3::splat(10.0)], vec![cut_out]);
/// let ray = Ray { origin: Vec3::new(-5.0, 4.0, 6.0), direction: Vec3::X };
/// let span = solid.next_span(&ray, f32::MIN).unwrap();
/// assert_eq!((span.entry.t, span.entry.point, span.end), (8.0, Vec3::new(3.0, 4.0, 6.0), 15.0));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Solid {
    /// Smallest and largest corner of the roaming box.
    pub roaming_box: [Vec3; 2],
    /// The roaming box as planes.
    pub block: Body,
    /// What is cut out. A cut-out may be several bodies.
    pub cut_outs: Vec<Body>,
}

impl Solid {
    /// The block with these bodies cut out.
    pub fn new(roaming_box: [Vec3; 2], cut_outs: Vec<Body>) -> Self {
        Self { roaming_box, block: Body::of_box(roaming_box), cut_outs }
    }

    /// A box with boxes cut out, clipped to it.
    pub fn of_boxes(roaming_box: &VoxelBox, cut_outs: &[VoxelBox]) -> Self {
        let corners = |b: &VoxelBox| [b.low().as_vec3(), b.high().as_vec3()];
        Self::new(corners(roaming_box), cut_outs.iter().map(|cut| Body::of_box(corners(cut))).collect())
    }

    /// Whether a point is in the box and in no cut-out. The boundary of the box counts as inside, that of a
    /// cut-out as outside it.
    pub fn contains(&self, p: Vec3) -> bool {
        let [low, high] = self.roaming_box;
        p.cmpge(low).all() && p.cmple(high).all() && !self.cut_outs.iter().any(|cut| cut.holds(p))
    }

    /// The interval of a ray in the roaming box, regardless of cut-outs.
    pub fn box_interval(&self, ray: &Ray) -> Option<[f32; 2]> {
        let outer = self.block.cross(ray);
        (outer.exit > outer.enter).then_some([outer.enter, outer.exit])
    }

    /// The first stretch of rock that begins at or after distance `from`.
    pub fn next_span(&self, ray: &Ray, from: f32) -> Option<SolidSpan> {
        let outer = self.block.cross(ray);
        let (mut t, mut plane) = (outer.enter, outer.enter_plane);
        if from > t {
            t = from;
        }
        // Every round leaves one cut-out for good, so there are at most as many rounds as cut-outs.
        for _ in 0..=self.cut_outs.len() {
            let mut moved = false;
            for cut in &self.cut_outs {
                let crossing = cut.cross(ray);
                if crossing.enter <= t + TOUCH && t + TOUCH < crossing.exit {
                    (t, plane) = (crossing.exit, crossing.exit_plane.or(plane));
                    moved = true;
                }
            }
            if !moved {
                break;
            }
        }
        if t + TOUCH >= outer.exit {
            return None;
        }
        let mut end = outer.exit;
        for cut in &self.cut_outs {
            let crossing = cut.cross(ray);
            if crossing.enter > t + TOUCH && crossing.enter < crossing.exit {
                end = end.min(crossing.enter);
            }
        }
        let plane = *plane?;
        let point = if t == from { ray.at(t) } else { plane.settle(ray.at(t)) };
        Some(SolidSpan { entry: FaceHit { t, point, plane }, end })
    }
}

#[cfg(test)]
mod tests {
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
            solid.cut_outs = order
                .map(|n| Body::of_box([Vec3::new(cuts[n][0], 0.0, 0.0), Vec3::new(cuts[n][1], 10.0, 10.0)]))
                .to_vec();
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
            let through =
                Vec3::new(3.0 + (n % 7) as f32 * 0.7, 2.0 + (n % 5) as f32 * 1.3, 1.0 + (n % 11) as f32 * 0.7);
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
}
