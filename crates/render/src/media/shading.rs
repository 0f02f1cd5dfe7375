//! How the media of a scene are lit, as it is written in its file.

use crate::error::SceneError;
use serde::{Deserialize, Serialize};

/// How media are lit.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Shading {
    /// Not: emission and absorption.
    #[default]
    Unshaded,
    /// By the gradient of the first medium's volume.
    Phong(Phong),
    /// Without gradients: by what lies in front (P-horiz 5.1).
    Occlusion(Occlusion),
    /// Both in stripes, to compare them.
    Interleaved(Interleaved),
}

/// Light reflected by surfaces of equal value, two-sided: `ambient + diffuse·|n·l|` on the colour, and `specular·|n·h|^shininess` of white.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Phong {
    /// Light without direction. Default 0.2.
    pub ambient: f32,
    /// Light by the angle to the surface. Default 0.65.
    pub diffuse: f32,
    /// Strength of highlights. Default 0.15.
    pub specular: f32,
    /// Exponent of highlights. Default 20.
    pub shininess: f32,
    /// Direction to the light: right, up, towards the viewer. Default (−0.7, 0.8, 0.6): from the side, so that shapes show.
    pub light: [f32; 3],
}

impl Default for Phong {
    fn default() -> Self {
        Self { ambient: 0.2, diffuse: 0.65, specular: 0.15, shininess: 20.0, light: [-0.7, 0.8, 0.6] }
    }
}

/// Occlusion and emission carried from slice to slice (P-horiz 5.1).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Occlusion {
    /// σ₀: standard deviation of the blur over one unit of depth, units. Default 1: an opening angle of about 45° at one unit that narrows with
    /// distance, as the incremental blur of the paper has it.
    pub spread: f32,
    /// Factor on the occlusion. Default 1, as published.
    pub strength: f32,
    /// Slices per unit of depth. Default 1.
    pub slices_per_voxel: f32,
    /// Most cells of a slice along a side; larger scenes have larger cells. Default 256.
    pub max_cells: u32,
}

impl Default for Occlusion {
    fn default() -> Self {
        Self { spread: 1.0, strength: 1.0, slices_per_voxel: 1.0, max_cells: 256 }
    }
}

/// Stripes by gradients and by occlusion in turn.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Interleaved {
    /// The light of the first stripe from the left, and of every other.
    pub phong: Phong,
    /// The light of those between.
    pub occlusion: Occlusion,
    /// Upright stripes over the width of the picture. Default 8.
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
    /// Refuses what cannot be drawn.
    ///
    /// # Errors
    /// [`SceneError::OutOfRange`].
    pub fn validate(&self) -> Result<(), SceneError> {
        match self {
            Self::Unshaded => Ok(()),
            Self::Phong(phong) => phong.validate(),
            Self::Occlusion(occlusion) => occlusion.validate(),
            Self::Interleaved(both) => {
                number("the stripes", both.stripes as f32, 1.0, 1024.0)?;
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
        number("the slices a voxel", self.slices_per_voxel, 0.05, 16.0)?;
        number("the cells of a slice", self.max_cells as f32, 8.0, 2048.0)
    }
}
