//! Faults of the synthetic survey: curved surfaces with a vertical displacement that is known in closed form.
//!
//! The surface is a height over the (v, depth) plane, with ζ = depth − middle depth and η = v − middle v:
//!
//! `u = X(v, depth) = position + strike·η + bow·η² + run·ζ + listric·ζ²`
//!
//! It dips towards +u; the hanging wall is where u > X. The hanging wall is moved straight down (a reverse
//! fault: up) by
//!
//! `throw(u, v) = throw_m · taper(v) · exp(−((u − X(v, middle depth))/reach)²)`
//!
//! which dies away from the fault and along its dip, as measured faults do, and to exactly 0 at a tip. Since
//! throw does not depend on depth, a faulted bed stays a height field and undoing the fault is one
//! subtraction. Spaces: metric (u along inline index, v along crossline index, depth down), m.

use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};
use survey::fault::Fault;
use survey::geometry::SurveyGeometry;
use survey::mesh::TriangleMesh;

/// Where a fault ends along strike.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Tip {
    /// v up to which the full throw is kept, m.
    pub full_until_m: f64,
    /// v of the tip line, beyond which there is no fault, m; greater than `full_until_m`.
    pub end_m: f64,
}

/// One fault with its displacement.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TruthFault {
    /// Unique name.
    pub name: String,
    /// u at the middle v and middle depth, m.
    pub position_m: f64,
    /// Middle v and middle depth, m.
    pub middle_m: DVec2,
    /// ∂u/∂v at the middle.
    pub strike: f64,
    /// Half of ∂²u/∂v², 1/m.
    pub bow: f64,
    /// ∂u/∂depth at the middle depth: cotangent of the dip.
    pub run: f64,
    /// Half of ∂²u/∂depth², 1/m; positive: flattens downwards.
    pub listric: f64,
    /// Largest throw, m; positive: hanging wall down (normal), negative: up (reverse).
    pub throw_m: f64,
    /// Distance from the fault over which the displacement dies to 1/e, m.
    pub reach_m: f64,
    /// Where it dies out, if inside the volume.
    pub tip: Option<Tip>,
}

impl TruthFault {
    /// u at middle depth, m.
    fn trace_u(&self, v: f64) -> f64 {
        let eta = v - self.middle_m.x;
        self.position_m + self.strike * eta + self.bow * eta * eta
    }

    /// u of the (extended) surface, m.
    pub fn surface_u(&self, v: f64, depth_m: f64) -> f64 {
        let zeta = depth_m - self.middle_m.y;
        self.trace_u(v) + (self.run + self.listric * zeta) * zeta
    }

    /// Offset of a point from the extended surface, m, positive in the hanging wall: exact sign, distance to
    /// first order.
    pub fn side_m(&self, p: DVec3) -> f64 {
        let slope_v = self.strike + 2.0 * self.bow * (p.y - self.middle_m.x);
        let slope_depth = self.run + 2.0 * self.listric * (p.z - self.middle_m.y);
        (p.x - self.surface_u(p.y, p.z)) / (1.0 + slope_v * slope_v + slope_depth * slope_depth).sqrt()
    }

    /// Depth at which a vertical line crosses the extended surface, m: above it is the hanging wall. −∞ where
    /// the line passes beside the surface, all of it in the footwall.
    pub(crate) fn crossing_m(&self, place: DVec2) -> f64 {
        let q = place.x - self.trace_u(place.y);
        let root = self.run * self.run + 4.0 * self.listric * q;
        if root < 0.0 { f64::NEG_INFINITY } else { self.middle_m.y + 2.0 * q / (self.run + root.sqrt()) }
    }

    /// Fraction of the throw left along strike: 1, then a cubic down to exactly 0 at the tip.
    fn taper(&self, v: f64) -> [f64; 2] {
        let Some(tip) = self.tip else { return [1.0, 0.0] };
        let length = tip.end_m - tip.full_until_m;
        let t = ((v - tip.full_until_m) / length).clamp(0.0, 1.0);
        [1.0 - t * t * (3.0 - 2.0 * t), -6.0 * t * (1.0 - t) / length]
    }

    /// Downward displacement of the hanging wall at (u, v), m.
    pub fn throw_at(&self, place: DVec2) -> f64 {
        let away = (place.x - self.trace_u(place.y)) / self.reach_m;
        self.throw_m * self.taper(place.y)[0] * (-away * away).exp()
    }

    /// (∂throw/∂u, ∂throw/∂v), metres a metre.
    pub(crate) fn throw_slope(&self, place: DVec2) -> DVec2 {
        let away = (place.x - self.trace_u(place.y)) / self.reach_m;
        let [taper, taper_slope] = self.taper(place.y);
        let bell = self.throw_m * (-away * away).exp();
        let along_u = -2.0 * away / self.reach_m * bell * taper;
        let trace_slope = self.strike + 2.0 * self.bow * (place.y - self.middle_m.x);
        DVec2::new(along_u, bell * taper_slope - along_u * trace_slope)
    }

    /// Whether there is a fault at this v: before the tip.
    pub fn is_real(&self, v: f64) -> bool {
        self.tip.is_none_or(|tip| v <= tip.end_m)
    }

    /// The interpreted fault: triangles over a grid of v and depth, which reach the side faces of the volume
    /// or the tip.
    pub(super) fn interpreted(&self, geometry: &SurveyGeometry, cells: [usize; 2]) -> Fault {
        let step = geometry.metric_from_voxel();
        let [_, ny, nz] = geometry.size();
        let wall_m = (ny - 1) as f64 * step.y_axis.y;
        let end_m = self.tip.map_or(wall_m, |tip| tip.end_m.min(wall_m));
        let bottom_m = (nz - 1) as f64 * step.z_axis.z;
        let mut mesh = TriangleMesh::default();
        for a in 0..=cells[0] {
            for b in 0..=cells[1] {
                let v = end_m * a as f64 / cells[0] as f64;
                let depth_m = bottom_m * b as f64 / cells[1] as f64;
                let p = DVec3::new(self.surface_u(v, depth_m), v, depth_m);
                mesh.vertices.push(geometry.world_from_voxel(step.inverse() * p));
            }
        }
        let row = cells[1] as u32 + 1;
        for a in 0..cells[0] as u32 {
            for b in 0..cells[1] as u32 {
                let corner = a * row + b;
                mesh.triangles.push([corner, corner + row, corner + 1]);
                mesh.triangles.push([corner + 1, corner + row, corner + row + 1]);
            }
        }
        Fault::new(self.name.clone(), mesh)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fault() -> TruthFault {
        TruthFault {
            name: "f".into(),
            position_m: 800.0,
            middle_m: DVec2::new(1500.0, 600.0),
            strike: 0.1,
            bow: 2e-5,
            run: 0.5,
            listric: 1e-4,
            throw_m: 90.0,
            reach_m: 700.0,
            tip: Some(Tip { full_until_m: 1000.0, end_m: 2000.0 }),
        }
    }

    #[test]
    fn the_crossing_lies_on_the_surface_and_sides_are_as_named() {
        let f = fault();
        for place in [DVec2::new(700.0, 300.0), DVec2::new(900.0, 2500.0)] {
            let depth = f.crossing_m(place);
            assert!((f.surface_u(place.y, depth) - place.x).abs() < 1e-9);
            assert!(f.side_m(place.extend(depth - 1.0)) > 0.0, "above is the hanging wall");
            assert!(f.side_m(place.extend(depth + 1.0)) < 0.0);
        }
        assert_eq!(f.crossing_m(DVec2::new(-5000.0, 0.0)), f64::NEG_INFINITY);
    }

    #[test]
    fn the_throw_is_full_at_the_fault_and_exactly_zero_beyond_the_tip() {
        let f = fault();
        assert!((f.throw_at(DVec2::new(f.surface_u(500.0, 600.0), 500.0)) - 90.0).abs() < 1e-9);
        assert_eq!(f.throw_at(DVec2::new(900.0, 2000.0)), 0.0);
        assert_eq!(f.throw_at(DVec2::new(900.0, 2700.0)), 0.0);
        assert!(f.is_real(1999.0) && !f.is_real(2001.0));
    }

    #[test]
    fn the_throw_slope_is_the_derivative() {
        let (f, step) = (fault(), 1e-3);
        for place in [DVec2::new(1000.0, 1400.0), DVec2::new(650.0, 300.0)] {
            let numeric = |d: DVec2| (f.throw_at(place + d * step) - f.throw_at(place - d * step)) / (2.0 * step);
            assert!((f.throw_slope(place) - DVec2::new(numeric(DVec2::X), numeric(DVec2::Y))).length() < 1e-6);
        }
    }
}
