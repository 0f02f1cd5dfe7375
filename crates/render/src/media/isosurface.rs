//! Surfaces of one value: of a volume, or of k', the layer's number from the bottom plus k (P-illus 5).
//!
//! A surface v = c is shown as a shell of half thickness h about it, like a horizon by its leaves. The distance of a point is, to first order,
//!
//! ```text
//! d ≈ |v − c| / |∇v|
//! ```
//!
//! which is exact where v is linear. k' is continuous across horizons inside a fault block, so its surfaces end at faults and nowhere else; its gradient is the
//! Jacobian's. Gradients are per voxel, distances in voxels.

use super::bricks::MIXED;
use super::medium::{FieldMedium, SOFT};
use super::table::{NO_DATA_BELOW, extinction};
use super::{MAX_ISOSURFACES, Media};
use crate::error::SceneError;
use glam::Vec3;
use model::StructuralModel;
use param::Parameterization;
use serde::{Deserialize, Serialize};
use ttf::{Colour, linear_from_srgb};

/// A surface of one value.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Isosurface {
    /// Of what.
    pub of: Scalar,
    /// The value, in the volume's unit; for k' the layer from the bottom, counted from 0, plus k.
    pub value: f32,
    /// Its colour.
    pub colour: Colour,
    /// Opacity of one unit of length inside the shell. Default 1.
    #[serde(default = "super::one")]
    pub opacity: f32,
    /// Half of its thickness, voxels, at most 9. Default 1.
    #[serde(default = "super::one")]
    pub thickness: f32,
}

/// What has isosurfaces.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Scalar {
    /// A volume, by its name.
    Volume(String),
    /// k'.
    Depth,
}

/// An isosurface, resolved.
pub struct FieldIsosurface<'a> {
    /// Its volume; absent for k'.
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

/// The interpretation that k' is of.
#[derive(Clone, Copy)]
pub struct Depths<'a> {
    /// Where regions are.
    pub model: &'a StructuralModel,
    /// k in them.
    pub param: &'a Parameterization,
}

impl Isosurface {
    pub(super) fn validate(&self) -> Result<(), SceneError> {
        let number = |what: &'static str, found: f32, low: f64, high: f64| {
            let found = f64::from(found);
            if found >= low && found <= high { Ok(()) } else { Err(SceneError::OutOfRange { what, found, low, high }) }
        };
        number("an isosurface's value", self.value, -1e30, 1e30)?;
        number("an isosurface's opacity", self.opacity, 0.0, 1.0)?;
        number("an isosurface's thickness", self.thickness, 0.0, 9.0)
    }
}

impl Media {
    /// The volumes that isosurfaces are of.
    pub fn isosurface_volumes(&self) -> impl Iterator<Item = &String> {
        self.isosurfaces.iter().filter_map(|surface| match &surface.of {
            Scalar::Volume(name) => Some(name),
            Scalar::Depth => None,
        })
    }

    pub(super) fn validate_isosurfaces(&self) -> Result<(), SceneError> {
        let found = self.isosurfaces.len();
        if found > MAX_ISOSURFACES {
            return Err(SceneError::TooMany { what: "isosurfaces", found, limit: MAX_ISOSURFACES });
        }
        self.isosurfaces.iter().try_for_each(Isosurface::validate)
    }
}

impl<'a> FieldIsosurface<'a> {
    /// A surface of a volume made ready, or of k'.
    pub fn new(surface: &Isosurface, medium: Option<FieldMedium<'a>>) -> Self {
        Self {
            medium,
            value: surface.value,
            colour: Vec3::from_array(surface.colour.to_unit().map(linear_from_srgb)),
            extinction: extinction(surface.opacity),
            thickness: surface.thickness,
        }
    }

    /// The share of a place that it takes, and the gradient there.
    pub fn at(&self, p: Vec3, depths: Option<Depths>) -> (f32, Vec3) {
        let (value, gradient) = match (&self.medium, depths) {
            (Some(medium), _) => {
                let value = medium.sample(p);
                if value < NO_DATA_BELOW {
                    return (0.0, Vec3::ZERO);
                }
                (value, medium.gradient(p))
            }
            (None, Some(Depths { model, param })) => {
                let region = model.region_at(p);
                let (flat, jacobian) = param.lookup_in(model, p, region);
                (f32::from(region.layer) + flat.k, Vec3::from_array(jacobian[2]))
            }
            (None, None) => return (0.0, Vec3::ZERO),
        };
        let distance = (value - self.value).abs() / gradient.length().max(1e-12);
        (((self.thickness - distance) / (2.0 * SOFT) + 0.5).clamp(0.0, 1.0), gradient)
    }

    /// Whether a brick can show it.
    pub fn shows(&self, low: Vec3, high: Vec3, layer: u8) -> bool {
        let reach = Vec3::splat(self.thickness + SOFT);
        match &self.medium {
            Some(medium) => {
                // The shell follows the first-order distance, whose gradient reaches a sample to either side.
                let range = medium.range(low - reach - 1.0, high + reach + 1.0);
                range.is_some_and(|[a, b]| a <= self.value && self.value <= b)
            }
            None => layer == MIXED || (f32::from(layer) + 0.5 - self.value).abs() <= 0.75,
        }
    }
}
