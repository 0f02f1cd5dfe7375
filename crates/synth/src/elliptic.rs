//! A fault that ends inside the block, in closed form: it dips evenly, its tip line is an ellipse, and the throw dies out
//! towards the tip line and away from the fault.

use glam::{DVec2, DVec3};
use survey::{Fault, SurveyGeometry, TriangleMesh};

/// The fault and what it does to level horizons. Lengths are voxels; x is across the fault, y along its strike, z down.
///
/// ```text
/// r(y, z) = |((y − y₀)/a, (z − z₀)/b)|,   throw = T·(1 − r²)²,   decay = exp(−((x − x_f(z))/w)²)
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EllipticFault {
    /// Middle of the ellipse.
    pub centre: DVec3,
    /// Half axes a along strike and b down.
    pub axes: DVec2,
    /// x that the fault gains with every voxel down.
    pub lean: f64,
    /// Largest throw T, samples.
    pub throw: f64,
    /// Distance w from the fault over which the throw dies out.
    pub width: f64,
}

impl EllipticFault {
    /// One in the middle of 80 × 90 × 70 voxels of 25 × 25 × 10 m; it dips by some 60 degrees and ends on all sides within.
    pub const EXAMPLE: Self = Self {
        centre: DVec3::new(40.0, 45.0, 35.0),
        axes: DVec2::new(26.0, 22.0),
        lean: 0.24,
        throw: 8.0,
        width: 22.0,
    };

    /// x of the fault at a depth.
    pub fn x_at(&self, z: f64) -> f64 {
        self.centre.x + self.lean * (z - self.centre.z)
    }

    /// Distance r from the middle of the ellipse; 1 on the tip line.
    pub fn radius(&self, y: f64, z: f64) -> f64 {
        (DVec2::new(y - self.centre.y, z - self.centre.z) / self.axes).length()
    }

    /// Depth of a horizon that lay level at `level` before, on one side of the fault: half the throw up or down. The throw
    /// is taken at that level, so that the form is explicit.
    pub fn height(&self, level: f64, is_hanging: bool, x: f64, y: f64) -> f64 {
        let throw = self.throw * (1.0 - self.radius(y, level).powi(2)).max(0.0).powi(2);
        let decay = (-((x - self.x_at(level)) / self.width).powi(2)).exp();
        level + if is_hanging { 0.5 } else { -0.5 } * throw * decay
    }

    /// The surface through sticks at the given y, each with so many picks from tip to tip.
    pub fn drawn(&self, geometry: &SurveyGeometry, sticks: &[f64], picks: usize) -> Fault {
        let mut mesh = TriangleMesh::default();
        for &y in sticks {
            let half = self.axes.y * (1.0 - ((y - self.centre.y) / self.axes.x).powi(2)).max(0.0).sqrt();
            for n in 0..picks {
                let z = self.centre.z + half * (2.0 * n as f64 / (picks - 1) as f64 - 1.0);
                mesh.vertices.push(geometry.world_from_voxel(DVec3::new(self.x_at(z), y, z)));
            }
        }
        for s in 0..sticks.len() as u32 - 1 {
            for n in 0..picks as u32 - 1 {
                let a = s * picks as u32 + n;
                let b = a + picks as u32;
                mesh.triangles.extend([[a, a + 1, b], [a + 1, b + 1, b]]);
            }
        }
        Fault::new("elliptic", mesh)
    }
}
