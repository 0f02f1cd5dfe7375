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
pub(crate) const TOUCH: f32 = 1e-3;

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
    pub(crate) fn of_boxes(roaming_box: &VoxelBox, cut_outs: &[VoxelBox]) -> Self {
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
    pub(crate) fn box_interval(&self, ray: &Ray) -> Option<[f32; 2]> {
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
mod tests;
