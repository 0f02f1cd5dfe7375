//! The shading of the media of a scene, as it is written in its file.

use crate::error::SceneError;
use serde::{Deserialize, Serialize};

/// The shading of media.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Shading {
    /// None: emission and absorption only.
    #[default]
    Unshaded,
    /// By the gradient of the volume.
    Phong(Phong),
    /// By what lies in front, without gradients (P-horiz 5.1).
    Occlusion(Occlusion),
    /// Both in stripes, to compare them.
    Interleaved(Interleaved),
}

/// Phong's reflection model on isosurfaces of the volume, two-sided: `ambient + diffuse·|n·l|` multiplies the
/// colour, and `specular·|n·h|^shininess` of white is added.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Phong {
    /// Ambient light. Default 0.2.
    pub ambient: f32,
    /// Diffuse light. Default 0.65.
    pub diffuse: f32,
    /// Strength of highlights. Default 0.15.
    pub specular: f32,
    /// Exponent of highlights. Default 20.
    pub shininess: f32,
    /// Direction to the light: right, up, towards the viewer. Default (−0.7, 0.8, 0.6): from the side, so
    /// that shapes are visible.
    pub light: [f32; 3],
}

impl Default for Phong {
    fn default() -> Self {
        Self { ambient: 0.2, diffuse: 0.65, specular: 0.15, shininess: 20.0, light: [-0.7, 0.8, 0.6] }
    }
}

/// Occlusion and emission propagated from slice to slice (P-horiz 5.1).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Occlusion {
    /// σ₀: standard deviation of the blur over one unit of depth, units. Default 1: an opening angle of about
    /// 45° at one unit, which narrows with distance, as for the incremental blur of the paper.
    pub spread: f32,
    /// Factor on the occlusion. Default 1, as published.
    pub strength: f32,
    /// Slices per unit of depth. Default 1.
    pub slices_per_voxel: f32,
    /// Largest number of cells along a side of a slice; larger scenes have larger cells. Default 256.
    pub max_cells: u32,
}

impl Default for Occlusion {
    fn default() -> Self {
        Self { spread: 1.0, strength: 1.0, slices_per_voxel: 1.0, max_cells: 256 }
    }
}

/// Two shadings in alternating stripes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Interleaved {
    /// The shading of the first stripe from the left, and of every second one.
    pub phong: Phong,
    /// The shading of the stripes between.
    pub occlusion: Occlusion,
    /// Number of vertical stripes across the picture. Default 8.
    pub stripes: u32,
}

impl Default for Interleaved {
    fn default() -> Self {
        Self { phong: Phong::default(), occlusion: Occlusion::default(), stripes: 8 }
    }
}

fn number(what: &'static str, found: f32, low: f64, high: f64) -> Result<(), SceneError> {
    SceneError::check_range(what, f64::from(found), low, high)
}

impl Shading {
    /// Checks that this can be drawn.
    ///
    /// # Errors
    /// [`SceneError::OutOfRange`].
    pub fn validate(&self) -> Result<(), SceneError> {
        match self {
            Self::Unshaded => Ok(()),
            Self::Phong(phong) => phong.validate(),
            Self::Occlusion(occlusion) => occlusion.validate(),
            Self::Interleaved(both) => {
                number("the number of stripes", both.stripes as f32, 1.0, 1024.0)?;
                both.phong.validate()?;
                both.occlusion.validate()
            }
        }
    }
}

impl Phong {
    fn validate(&self) -> Result<(), SceneError> {
        number("the ambient light", self.ambient, 0.0, 10.0)?;
        number("the diffuse light", self.diffuse, 0.0, 10.0)?;
        number("the specular light", self.specular, 0.0, 10.0)?;
        number("the shininess", self.shininess, 0.0, 1000.0)?;
        self.light.iter().try_for_each(|&c| number("the light's direction", c, -1e6, 1e6))
    }
}

impl Occlusion {
    fn validate(&self) -> Result<(), SceneError> {
        number("the spread of occlusion", self.spread, 0.0, 16.0)?;
        number("the strength of occlusion", self.strength, 0.0, 100.0)?;
        number("the number of slices per voxel", self.slices_per_voxel, 0.05, 16.0)?;
        number("the number of cells along a slice", self.max_cells as f32, 8.0, 2048.0)
    }
}
