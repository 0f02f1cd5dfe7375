//! Surfaces that are no height fields, in closed form: a recumbent fold, a diapir with an overhang, a laccolith.
//!
//! Each answers which side of it a place lies on, and gives its triangles. Positions are metres: x along the inlines'
//! index, y along the crosslines', z down.

use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;
use survey::{SurveyGeometry, TriangleMesh};

/// Dipping beds that were sheared horizontally, so that their limbs are overturned and their axial planes level:
///
/// ```text
/// t(x, z) = z − s·x + s·A·sin(2πz/L)
/// ```
///
/// Bed t = c is overturned where 1 + s·A·2π/L·cos(2πz/L) < 0. Beds are given by x as a function of z, so a vertical line
/// meets one up to three times in a wavelength L.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RecumbentFold {
    /// Slope s of the beds before the shear.
    pub slope: f64,
    /// Amplitude A of the shear, m.
    pub amplitude_m: f64,
    /// Wavelength L of the shear along z, m.
    pub wavelength_m: f64,
}

impl RecumbentFold {
    /// A fold that fits a survey: the overturned limb lies in its middle.
    pub fn fitting(geometry: &SurveyGeometry) -> Self {
        let extent = extent_m(geometry);
        let (slope, wavelength_m) = (0.8, extent.z);
        // s·A·2π/L = 1.5: the limb between the hinges dips against the beds.
        Self { slope, amplitude_m: 1.5 * wavelength_m / (slope * TAU), wavelength_m }
    }

    /// t at a place, m; larger is older.
    pub fn age(&self, p: DVec3) -> f64 {
        p.z - self.slope * (p.x - self.amplitude_m * (TAU * p.z / self.wavelength_m).sin())
    }

    /// ∇t.
    pub fn gradient(&self, p: DVec3) -> DVec3 {
        let k = TAU / self.wavelength_m;
        DVec3::new(-self.slope, 0.0, 1.0 + self.slope * self.amplitude_m * k * (k * p.z).cos())
    }

    /// x of bed t = `age` at depth z.
    pub fn x_of(&self, age: f64, z: f64) -> f64 {
        (z - age) / self.slope + self.amplitude_m * (TAU * z / self.wavelength_m).sin()
    }

    /// Triangles of bed t = `age` from `low` to `high` in y and z (metres), `cells` along each, in world coordinates.
    pub fn mesh(
        &self,
        geometry: &SurveyGeometry,
        age: f64,
        [low, high]: [DVec2; 2],
        cells: [usize; 2],
    ) -> TriangleMesh {
        grid_mesh(cells, |u, v| {
            let at = low + (high - low) * DVec2::new(u, v);
            world(geometry, DVec3::new(self.x_of(age, at.y), at.x, at.y))
        })
    }
}

/// A body of revolution about a vertical axis: a bulb on a stem, as of a salt dome with an overhang. It is inside where
///
/// ```text
/// ρ < R(z),   R = (bulb⁶ + stem⁶)^⅙,   bulb = r_b·√(1 − ((z − z_b)/h)²),   stem = r_s for z > z_b, widening from 0 above
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Diapir {
    /// The axis, x and y in m.
    pub axis: DVec2,
    /// Depth of the middle of the bulb, m.
    pub bulb_z: f64,
    /// Radius of the bulb, m.
    pub bulb_radius: f64,
    /// Half the height of the bulb, m.
    pub bulb_height: f64,
    /// Radius of the stem, m.
    pub stem_radius: f64,
    /// Depth at which the stem ends, m.
    pub base_z: f64,
}

impl Diapir {
    /// A diapir in a survey: its bulb in the upper half, its stem through the bottom.
    pub fn fitting(geometry: &SurveyGeometry) -> Self {
        Self::of_extent(extent_m(geometry))
    }

    /// The same in a volume of an extent, m.
    pub(crate) fn of_extent(extent: DVec3) -> Self {
        let width = extent.x.min(extent.y);
        Self {
            axis: DVec2::new(0.42 * extent.x, 0.4 * extent.y),
            bulb_z: 0.45 * extent.z,
            bulb_radius: 0.24 * width,
            bulb_height: 0.22 * extent.z,
            stem_radius: 0.1 * width,
            base_z: 1.1 * extent.z,
        }
    }

    /// Depth of its top, m.
    pub fn top_z(&self) -> f64 {
        self.bulb_z - self.bulb_height
    }

    /// Radius at a depth, m; 0 above the top and below the base.
    pub fn radius(&self, z: f64) -> f64 {
        if z < self.top_z() || z > self.base_z {
            return 0.0;
        }
        let up = (z - self.bulb_z) / self.bulb_height;
        let bulb = self.bulb_radius * (1.0 - up * up).max(0.0).sqrt();
        let stem = self.stem_radius * up.clamp(0.0, 1.0);
        (bulb.powi(6) + stem.powi(6)).powf(1.0 / 6.0)
    }

    /// Whether a place lies inside.
    pub fn holds(&self, p: DVec3) -> bool {
        p.truncate().distance(self.axis) < self.radius(p.z)
    }

    /// Where a vertical line at a distance from the axis crosses the outline: depths in m, found at steps of `step_m`
    /// and then exactly, and whether the line enters the body there.
    pub fn crossings(&self, rho: f64, step_m: f64) -> impl Iterator<Item = (f64, bool)> + use<> {
        let body = *self;
        let (top, steps) = (self.top_z() - step_m, ((self.base_z - self.top_z()) / step_m) as usize + 2);
        let inside = move |z: f64| rho < body.radius(z);
        (0..steps).map(move |n| [n, n + 1].map(|n| top + n as f64 * step_m)).filter_map(
            move |[mut above, mut below]| {
                let enters = inside(below);
                if inside(above) == enters {
                    return None;
                }
                for _ in 0..30 {
                    let middle = 0.5 * (above + below);
                    if inside(middle) == enters { below = middle } else { above = middle }
                }
                Some((0.5 * (above + below), enters))
            },
        )
    }

    /// The closed outline, `rings` from top to base, in world coordinates.
    pub fn mesh(&self, geometry: &SurveyGeometry, rings: usize) -> TriangleMesh {
        // Rings stand closer where the outline turns: at the top of the bulb.
        let depth = |t: f64| self.top_z() + (self.base_z - self.top_z()) * t * t * (1.5 - 0.5 * t);
        revolved(geometry, self.axis, rings, |t| (self.radius(depth(t).min(self.base_z)), depth(t)))
    }
}

/// A laccolith: a level base, and a roof that was lifted: inside where z_r(ρ) < z < base with
///
/// ```text
/// z_r = base − H·(1 − (ρ/R)²)²
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Laccolith {
    /// The axis, x and y in m.
    pub axis: DVec2,
    /// Depth of the base, m.
    pub base_z: f64,
    /// Radius R, m.
    pub radius: f64,
    /// Height H, m.
    pub height: f64,
}

impl Laccolith {
    /// Whether a place lies inside.
    pub fn holds(&self, p: DVec3) -> bool {
        let share = 1.0 - (p.truncate().distance(self.axis) / self.radius).powi(2);
        share > 0.0 && p.z < self.base_z && p.z > self.base_z - self.height * share * share
    }

    /// The closed outline, `rings` along the roof and as many along the base, in world coordinates.
    pub fn mesh(&self, geometry: &SurveyGeometry, rings: usize) -> TriangleMesh {
        revolved(geometry, self.axis, 2 * rings, |t| {
            let rho = self.radius * (1.0 - (2.0 * t - 1.0).abs());
            let share = 1.0 - (rho / self.radius).powi(2);
            (rho, if t < 0.5 { self.base_z - self.height * share * share } else { self.base_z })
        })
    }
}

/// The survey's extent along x, y, z, m.
pub(super) fn extent_m(geometry: &SurveyGeometry) -> DVec3 {
    let metric = geometry.metric_from_voxel();
    let counts = geometry.size().map(|n| n as f64 - 1.0);
    DVec3::from_array([0, 1, 2].map(|axis: usize| metric.col(axis).length() * counts[axis]))
}

/// World coordinates of a place in metres along the survey's own axes.
pub fn world(geometry: &SurveyGeometry, p: DVec3) -> DVec3 {
    let metric = geometry.metric_from_voxel();
    let steps = DVec3::from_array([0, 1, 2].map(|axis: usize| metric.col(axis).length()));
    geometry.world_from_voxel(p / steps)
}

/// The triangles of a grid of places, given for u and v from 0 to 1.
pub(super) fn grid_mesh([nu, nv]: [usize; 2], place: impl Fn(f64, f64) -> DVec3) -> TriangleMesh {
    let at = |u: usize, v: usize| (u * (nv + 1) + v) as u32;
    let vertices = (0..=nu).flat_map(|u| (0..=nv).map(move |v| (u, v)));
    let vertices = vertices.map(|(u, v)| place(u as f64 / nu as f64, v as f64 / nv as f64)).collect();
    let cell =
        |u: usize, v: usize| [[at(u, v), at(u + 1, v), at(u + 1, v + 1)], [at(u, v), at(u + 1, v + 1), at(u, v + 1)]];
    let triangles = (0..nu).flat_map(|u| (0..nv).flat_map(move |v| cell(u, v))).collect();
    TriangleMesh { vertices, triangles }
}

/// The triangles of an outline (radius, depth) from t = 0 to 1 turned about an axis; it begins and ends on the axis.
fn revolved(geometry: &SurveyGeometry, axis: DVec2, rings: usize, outline: impl Fn(f64) -> (f64, f64)) -> TriangleMesh {
    let columns = (2 * rings).max(12);
    let mut mesh = TriangleMesh::default();
    for ring in 1..rings {
        let (radius, z) = outline(ring as f64 / rings as f64);
        for column in 0..columns {
            let turn = column as f64 / columns as f64 * TAU;
            mesh.vertices.push(world(geometry, (axis + radius * DVec2::from_angle(turn)).extend(z)));
        }
    }
    let at = |ring: usize, column: usize| (ring * columns + column % columns) as u32;
    for ring in 0..rings - 2 {
        for c in 0..columns {
            mesh.triangles.push([at(ring, c), at(ring + 1, c), at(ring + 1, c + 1)]);
            mesh.triangles.push([at(ring, c), at(ring + 1, c + 1), at(ring, c + 1)]);
        }
    }
    for (ring, t) in [(0, 0.0), (rings - 2, 1.0)] {
        let pole = mesh.vertices.len() as u32;
        mesh.vertices.push(world(geometry, axis.extend(outline(t).1)));
        (0..columns).for_each(|c| mesh.triangles.push([pole, at(ring, c), at(ring, c + 1)]));
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;
    use survey::VerticalUnit;
    use survey::topology::OrientedMesh;

    fn geometry() -> SurveyGeometry {
        SurveyGeometry::regular([61, 51, 81], 25.0, 10.0, VerticalUnit::Metres)
    }

    #[test]
    fn bodies_are_closed_and_hold_their_volume() {
        let geometry = geometry();
        let diapir = Diapir::fitting(&geometry);
        let mesh = OrientedMesh::of(&diapir.mesh(&geometry, 120), 1e-6).unwrap();
        assert!(mesh.is_closed());
        let step = 1.0;
        let discs = (0..((diapir.base_z - diapir.top_z()) / step) as usize)
            .map(|n| std::f64::consts::PI * diapir.radius(diapir.top_z() + (n as f64 + 0.5) * step).powi(2) * step);
        let exact: f64 = discs.sum();
        assert!((mesh.volume() / exact - 1.0).abs() < 0.01, "{} {exact}", mesh.volume());
        // It overhangs: wider at the bulb than at the stem below.
        assert!(diapir.radius(diapir.bulb_z) > 1.5 * diapir.radius(diapir.bulb_z + 1.2 * diapir.bulb_height));
        let laccolith = Laccolith { axis: DVec2::new(700.0, 600.0), base_z: 600.0, radius: 400.0, height: 150.0 };
        let mesh = OrientedMesh::of(&laccolith.mesh(&geometry, 60), 1e-6).unwrap();
        // ∫ H (1 − q²)² 2π R² q dq = π H R² / 3.
        let exact = std::f64::consts::PI * 150.0 * 400.0f64.powi(2) / 3.0;
        assert!(mesh.is_closed() && (mesh.volume() / exact - 1.0).abs() < 0.01, "{} {exact}", mesh.volume());
    }

    #[test]
    fn a_bed_of_the_fold_lies_at_its_age_and_is_overturned() {
        let geometry = geometry();
        let fold = RecumbentFold::fitting(&geometry);
        let range = [DVec2::ZERO, DVec2::new(1250.0, 800.0)];
        let mesh = fold.mesh(&geometry, -100.0, range, [4, 60]);
        let metres = |p: DVec3| geometry.metric_from_voxel() * geometry.voxel_from_world(p);
        let worst = mesh.vertices.iter().map(|&p| (fold.age(metres(p)) + 100.0).abs()).fold(0.0, f64::max);
        assert!(worst < 1e-6, "{worst}");
        let share = OrientedMesh::of(&mesh, 1e-6).unwrap().overturned_share();
        assert!(share > 0.05, "{share}");
    }
}
