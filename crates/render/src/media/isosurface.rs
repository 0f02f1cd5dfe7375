//! Isosurfaces of a volume, or of k', the layer number from the bottom plus k (P-illus 5).
//!
//! An isosurface v = c is drawn as a shell of half thickness h around it, as horizons are. The distance of a
//! point from it is, to first order,
//!
//! ```text
//! d ≈ |v − c| / |∇v|
//! ```
//!
//! which is exact where v is linear. k' is continuous across horizons inside a fault block, so its
//! isosurfaces end at faults and nowhere else; its gradient comes from the Jacobian. Gradients are per voxel,
//! distances in voxels.

use super::Isosurface;
use super::bricks::MIXED;
use super::medium::FieldMedium;
use super::samples::NO_DATA_BELOW;
use super::shell::{SOFT, shell_cover};
use super::table::extinction;
use glam::Vec3;
use model::StructuralModel;
use param::Parameterization;
use ttf::linear_from_srgb;

/// An isosurface, with its volume resolved.
pub struct FieldIsosurface<'a> {
    /// Its volume. Absent for k'.
    pub medium: Option<FieldMedium<'a>>,
    /// The value.
    pub value: f32,
    /// Linear colour.
    pub colour: Vec3,
    /// Extinction inside.
    pub extinction: f32,
    /// Half of its thickness, voxels.
    pub thickness: f32,
}

/// The interpretation, from which k' is computed.
#[derive(Clone, Copy)]
pub struct StratigraphicDepth<'a> {
    /// The structural model, which has the regions.
    pub model: &'a StructuralModel,
    /// The parameterization, which has k.
    pub param: &'a Parameterization,
}

impl<'a> FieldIsosurface<'a> {
    /// An isosurface of a prepared volume, or of k'.
    pub fn new(surface: &Isosurface, medium: Option<FieldMedium<'a>>) -> Self {
        Self {
            medium,
            value: surface.value,
            colour: Vec3::from_array(surface.colour.to_unit().map(linear_from_srgb)),
            extinction: extinction(surface.opacity),
            thickness: surface.thickness,
        }
    }

    /// The fraction of a point that it covers, and the gradient there.
    pub fn at(&self, p: Vec3, depths: Option<StratigraphicDepth>) -> (f32, Vec3) {
        let (value, gradient) = match (&self.medium, depths) {
            (Some(medium), _) => {
                let value = medium.sample(p);
                if value < NO_DATA_BELOW {
                    return (0.0, Vec3::ZERO);
                }
                (value, medium.gradient(p))
            }
            (None, Some(StratigraphicDepth { model, param })) => {
                let region = model.region_at(p);
                let (flat, jacobian) = param.lookup_in(model, p, region);
                (f32::from(region.layer) + flat.k, Vec3::from_array(jacobian[2]))
            }
            (None, None) => unreachable!("without an interpretation, a field with surfaces of k' is refused"),
        };
        let distance = (value - self.value).abs() / gradient.length().max(1e-12);
        (shell_cover(self.thickness, distance), gradient)
    }

    /// Whether the isosurface may be visible in a brick.
    pub fn shows(&self, low: Vec3, high: Vec3, layer: u8) -> bool {
        let reach = Vec3::splat(self.thickness + SOFT);
        match &self.medium {
            Some(medium) => {
                // The shell uses the first-order distance, whose gradient takes one sample on either side.
                let range = medium.range(low - reach - 1.0, high + reach + 1.0);
                range.is_some_and(|[a, b]| a <= self.value && self.value <= b)
            }
            None => layer == MIXED || (f32::from(layer) + 0.5 - self.value).abs() <= 0.75,
        }
    }
}
