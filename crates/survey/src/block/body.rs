//! Convex bodies of planes, of which a block and what is cut out of it are made.
//!
//! A box is six planes. A cut-out of any other shape ([`super::CutShape`]) is one convex body or several that touch; the
//! planes in which they touch are seams, where there is no face. Voxel space, f32.

use glam::{DVec3, Vec3};

/// Components of a direction across a plane smaller than this count as none.
const PARALLEL: f32 = 1e-12;
/// Points as near to a seam as this lie in the bodies on both of its sides, voxels.
const ON_SEAM: f32 = 1e-4;

/// A ray in voxel space, single precision.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ray {
    /// A point in front of the block.
    pub origin: Vec3,
    /// Unit direction.
    pub direction: Vec3,
}

impl Ray {
    /// The point at distance `t`, voxels.
    pub fn at(&self, t: f32) -> Vec3 {
        self.origin + self.direction * t
    }
}

/// A plane that bounds a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyPlane {
    /// Unit normal, out of the body.
    pub normal: Vec3,
    /// n·p of its points p.
    pub offset: f32,
    /// Axis of the normal of a plane of constant x, y or z.
    pub axis: Option<usize>,
    /// What the plane is of a wall that turns.
    pub wall: Option<Wall>,
    /// Whether another body of the same cut-out lies behind it.
    pub is_seam: bool,
}

/// A plane of a wall that stands on a line of the map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wall {
    /// Direction along the line, voxels, of any length.
    pub along: [f32; 2],
    /// Added to the metres along that direction, so that they go on from plane to plane.
    pub shift_m: f32,
    /// Planes of one curve have the same number: between them there is no edge.
    pub curve: Option<usize>,
}

/// The part of space that lies behind all of its planes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Body {
    /// Its planes. A body may be unbounded: only what lies in the roaming box counts.
    pub planes: Vec<BodyPlane>,
}

/// The interval of t over which a ray is inside a body, and the planes at its ends.
#[derive(Debug, Clone, Copy)]
pub struct Crossing<'b> {
    /// Where it begins.
    pub enter: f32,
    /// Where it ends.
    pub exit: f32,
    /// The plane at its beginning.
    pub enter_plane: Option<&'b BodyPlane>,
    /// The plane at its end.
    pub exit_plane: Option<&'b BodyPlane>,
}

impl BodyPlane {
    /// A plane of constant x, y or z; `outwards` is +1 if the body lies at smaller coordinates, else −1.
    pub fn of_axis(axis: usize, at: f32, outwards: f32) -> Self {
        let normal = Vec3::AXES[axis] * outwards;
        Self { normal, offset: at * outwards, axis: Some(axis), wall: None, is_seam: false }
    }

    /// The plane through a point with a normal of any length out of the body.
    pub fn through(point: DVec3, normal: DVec3) -> Self {
        let unit = normal.normalize();
        for axis in 0..3 {
            if (unit[axis].abs() - 1.0).abs() < 1e-9 {
                return Self::of_axis(axis, point[axis] as f32, unit[axis].signum() as f32);
            }
        }
        Self { normal: unit.as_vec3(), offset: unit.dot(point) as f32, axis: None, wall: None, is_seam: false }
    }

    /// Distance of a point from the plane, voxels, positive outside the body.
    pub fn distance(&self, p: Vec3) -> f32 {
        self.normal.dot(p) - self.offset
    }

    /// A point of a ray on the plane, with what is exact about it.
    pub fn settle(&self, p: Vec3) -> Vec3 {
        match self.axis {
            Some(axis) => {
                let mut exact = p;
                exact[axis] = self.offset * self.normal[axis];
                exact
            }
            None => p - self.normal * self.distance(p),
        }
    }
}

impl Body {
    /// A box.
    pub fn of_box([low, high]: [Vec3; 2]) -> Self {
        let sides =
            |axis: usize| [BodyPlane::of_axis(axis, low[axis], -1.0), BodyPlane::of_axis(axis, high[axis], 1.0)];
        Self { planes: (0..3).flat_map(sides).collect() }
    }

    /// Whether a point lies inside, not on a plane but for a seam.
    pub fn holds(&self, p: Vec3) -> bool {
        self.planes.iter().all(|plane| plane.distance(p) < if plane.is_seam { ON_SEAM } else { 0.0 })
    }

    /// Whether a point lies inside or on a plane.
    pub fn holds_or_touches(&self, p: Vec3) -> bool {
        self.planes.iter().all(|plane| plane.distance(p) <= if plane.is_seam { ON_SEAM } else { 0.0 })
    }

    /// Where a ray crosses the body; the exit lies before the entry if it does not.
    pub fn cross(&self, ray: &Ray) -> Crossing<'_> {
        let mut crossing = Crossing { enter: f32::MIN, exit: f32::MAX, enter_plane: None, exit_plane: None };
        for plane in &self.planes {
            let outside = plane.distance(ray.origin);
            let speed = plane.normal.dot(ray.direction);
            if speed.abs() < PARALLEL {
                if outside > 0.0 {
                    return Crossing { enter: f32::MAX, exit: f32::MIN, ..crossing };
                }
                continue;
            }
            let t = -outside / speed;
            if speed < 0.0 && t > crossing.enter {
                (crossing.enter, crossing.enter_plane) = (t, Some(plane));
            }
            if speed > 0.0 && t < crossing.exit {
                (crossing.exit, crossing.exit_plane) = (t, Some(plane));
            }
        }
        crossing
    }

    /// The part of plane `n` that bounds the body within a box, as a convex polygon; empty if there is none.
    pub fn face(&self, n: usize, [low, high]: [DVec3; 2]) -> Vec<DVec3> {
        let plane = &self.planes[n];
        let normal = plane.normal.as_dvec3();
        let mut polygon = match plane.axis {
            Some(axis) => {
                let at = f64::from(plane.offset * plane.normal[axis]);
                if at < low[axis] || at > high[axis] {
                    return Vec::new();
                }
                let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
                let corner = |at_u: f64, at_v: f64| {
                    let mut p = low;
                    (p[axis], p[u], p[v]) = (at, at_u, at_v);
                    p
                };
                vec![corner(low[u], low[v]), corner(high[u], low[v]), corner(high[u], high[v]), corner(low[u], high[v])]
            }
            None => {
                let centre = 0.5 * (low + high);
                let middle = centre - normal * (normal.dot(centre) - f64::from(plane.offset));
                let (s, t) = normal.any_orthonormal_pair();
                let far = 2.0 * (high - low).length();
                let mut polygon = [s + t, t - s, -s - t, s - t].map(|q| middle + q * far).to_vec();
                for axis in 0..3 {
                    polygon = part_behind(&polygon, |p| low[axis] - p[axis]);
                    polygon = part_behind(&polygon, |p| p[axis] - high[axis]);
                }
                polygon
            }
        };
        for (m, other) in self.planes.iter().enumerate() {
            if m != n && !polygon.is_empty() {
                let side = |p: DVec3| other.normal.as_dvec3().dot(p) - f64::from(other.offset);
                polygon = part_behind(&polygon, side);
            }
        }
        if polygon.len() < 3 { Vec::new() } else { polygon }
    }
}

/// The part of a convex polygon on which a linear function is not positive.
pub fn part_behind(polygon: &[DVec3], side: impl Fn(DVec3) -> f64) -> Vec<DVec3> {
    let mut part = Vec::new();
    for n in 0..polygon.len() {
        let (a, b) = (polygon[n], polygon[(n + 1) % polygon.len()]);
        let (at_a, at_b) = (side(a), side(b));
        if at_a <= 0.0 {
            part.push(a);
        }
        if (at_a < 0.0 && at_b > 0.0) || (at_a > 0.0 && at_b < 0.0) {
            part.push(a.lerp(b, at_a / (at_a - at_b)));
        }
    }
    part
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A pyramid without its base plane: four sloping sides that meet at (0, 0, 0), open downwards.
    fn pyramid() -> Body {
        let sides =
            [DVec3::X, -DVec3::X, DVec3::Y, -DVec3::Y].map(|side| BodyPlane::through(DVec3::ZERO, side - DVec3::Z));
        Body { planes: sides.to_vec() }
    }

    #[test]
    fn a_ray_crosses_a_pyramid_where_it_should() {
        let body = pyramid();
        assert!(body.holds(Vec3::new(0.5, -0.5, 1.0)) && !body.holds(Vec3::new(1.5, 0.0, 1.0)));
        let ray = Ray { origin: Vec3::new(-10.0, 0.5, 4.0), direction: Vec3::X };
        let crossing = body.cross(&ray);
        assert!((crossing.enter - 6.0).abs() < 1e-5 && (crossing.exit - 14.0).abs() < 1e-5, "{crossing:?}");
        let beside = body.cross(&Ray { origin: Vec3::new(-10.0, 5.0, 4.0), direction: Vec3::X });
        assert!(beside.exit <= beside.enter, "{beside:?}");
        // A point on a sloping plane is settled onto it.
        let plane = crossing.enter_plane.unwrap();
        assert!(plane.distance(plane.settle(Vec3::new(-3.99, 0.5, 4.0))).abs() < 1e-5);
    }

    #[test]
    fn a_face_is_cut_by_the_other_planes_and_the_box() {
        let body = pyramid();
        let face = body.face(0, [DVec3::splat(-3.0), DVec3::splat(3.0)]);
        // The triangle from the tip down to z = 3.
        let area: f64 =
            (1..face.len() - 1).map(|n| 0.5 * (face[n] - face[0]).cross(face[n + 1] - face[0]).length()).sum();
        assert!((area - 9.0 * 2f64.sqrt()).abs() < 1e-4, "{area} {face:?}");
        let block = Body::of_box([Vec3::ZERO, Vec3::splat(2.0)]);
        assert_eq!(block.face(0, [DVec3::ZERO, DVec3::splat(9.0)]).len(), 4);
        assert!(block.face(1, [DVec3::ZERO, DVec3::splat(1.0)]).is_empty(), "outside the box");
    }
}
