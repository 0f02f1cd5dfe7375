//! What is seen through: volumes in the cut-outs and around them, and how light moves in them (P-illus 5.1, P-horiz 5).
//!
//! A medium turns a scalar volume into extinction and colour. The opacity α₀ of its RGBA function is that of one *unit* of length; over a
//! length Δ it is
//!
//! ```text
//! α = 1 − (1 − α₀)^(Δ/Δ₀) = 1 − exp(−κ·Δ/Δ₀)      κ = −ln(1 − α₀)
//! ```
//!
//! so that no picture depends on the number of samples. The unit Δ₀ is the cube root of a voxel's volume in display space (m, exaggerated):
//! an isotropic medium in the space that is looked at, equal to the voxel on a cubic lattice. Several media at one place add their
//! extinctions and mix their colours by them. Light is linear; the sum is encoded at the end.
//!
//! Where light is shadowed by what lies in front, [`light`] carries occlusion and emission from slice to slice before the
//! picture is drawn, and [`march`] reads them; [`bundle`] does so for many rays at once where one volume is all there is. Space is
//! skipped by [`bricks`].

pub mod bricks;
pub mod bundle;
pub mod field;
pub mod interleaved;
pub mod isosurface;
pub mod light;
pub mod light_grid;
mod lit;
pub mod march;
pub mod medium;
pub mod prepared;
pub mod samples;
mod slices;
pub mod stretches;
pub mod table;
mod wide;
mod windows;

pub use interleaved::Interleaved;
pub use isosurface::{Isosurface, Scalar};

use crate::error::SceneError;
use serde::{Deserialize, Serialize};
use ttf::{Colour, RgbaFunction, RgbaStop};

/// Most media in a scene, cut-outs and surroundings together.
pub const MAX_MEDIA: usize = 4;
/// Most horizons that a scene shows by their leaves.
pub const MAX_HORIZONS: usize = 255;
/// Most isosurfaces in a scene.
pub const MAX_ISOSURFACES: usize = 4;

/// What is seen through, and how it is lit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Media {
    /// Which faces of rock stop a ray. Default all.
    pub faces: Faces,
    /// Samples of a ray per unit of length. Default 2.
    pub samples_per_voxel: f32,
    /// How the media are lit. Default unshaded.
    pub shading: Shading,
    /// Whether rays jump over space that shows nothing; the picture is the same. Default skipped.
    pub empty_space: EmptySpace,
    /// Where the media are shown, by the distance to the horizons below. Default everywhere.
    pub scope: Scope,
    /// Distance that counts as near a horizon for `scope`, voxels, at most 10. Default 5.
    pub reach: f32,
    /// What fills the cut-outs. Default nothing.
    pub cut_outs: Vec<Medium>,
    /// What fills the rest of the roaming box; it shows where no face of rock is in front. Default nothing.
    pub surroundings: Vec<Medium>,
    /// Horizons shown by the leaves of their trees (P-horiz 5.2).
    pub horizons: Vec<PickedHorizon>,
    /// Surfaces of one value, wherever media are.
    pub isosurfaces: Vec<Isosurface>,
}

impl Default for Media {
    fn default() -> Self {
        Self {
            faces: Faces::All,
            samples_per_voxel: 2.0,
            shading: Shading::Unshaded,
            empty_space: EmptySpace::Skipped,
            scope: Scope::Everywhere,
            reach: 5.0,
            cut_outs: Vec::new(),
            surroundings: Vec::new(),
            horizons: Vec::new(),
            isosurfaces: Vec::new(),
        }
    }
}

/// Which faces of rock are drawn and stop a ray.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Faces {
    /// Those of the roaming box and of the cut-outs.
    #[default]
    All,
    /// The back faces of the cut-outs only: the surroundings are seen through (P-illus 5.1).
    CutOuts,
    /// None: the whole box is a medium.
    None,
}

/// What rays do where nothing shows.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum EmptySpace {
    /// They jump over it.
    #[default]
    Skipped,
    /// They sample it all the same: to measure what skipping gains.
    Sampled,
}

/// Where media are shown.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Scope {
    /// Everywhere.
    #[default]
    Everywhere,
    /// Near the horizons shown only.
    NearHorizons,
    /// Everywhere but near the horizons shown.
    AwayFromHorizons,
}

/// A volume seen through an RGBA function.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Medium {
    /// The volume's name.
    pub volume: String,
    /// Value → colour and the opacity of one unit of length.
    pub function: RgbaFunction,
    /// Whether the layers' opacities multiply it. Default not.
    #[serde(default)]
    pub layers: LayerOpacity,
    /// Where its colour comes from. Default the function.
    #[serde(default)]
    pub colour: MediumColour,
}

/// What colours a medium.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum MediumColour {
    /// Its function.
    #[default]
    Function,
    /// The layer at the place: the average of its pattern, as rock that was left standing (P-illus, figure 11).
    Layers,
}

/// Whether the opacity of the layer at a place multiplies that of a medium (P-illus 5.1): layers with one extrude into the cut-out.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LayerOpacity {
    /// No.
    #[default]
    Ignored,
    /// Yes.
    Followed,
}

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

/// A horizon shown where the closest leaf is one of its own and near enough.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PickedHorizon {
    /// The horizon of an interpretation that it is: who brings the candidates puts that horizon's leaves below. Absent: the leaves as they are.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Its leaves' ids; none = every leaf there is.
    #[serde(default)]
    pub leaves: Vec<u32>,
    /// Its colour.
    pub colour: Colour,
    /// Whether its leaves are told apart. Default not.
    #[serde(default)]
    pub colouring: Colouring,
    /// Opacity of one unit of length. Default 1.
    #[serde(default = "one")]
    pub opacity: f32,
    /// Half of its thickness, voxels, at most 9. Default 1.
    #[serde(default = "one")]
    pub thickness: f32,
    /// Light it gives off, in its own colour; 1 is as bright as it is lit. Default 0.
    #[serde(default)]
    pub emission: f32,
    /// An attribute painted on it in place of the colour.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub paint: Option<Paint>,
}

impl PickedHorizon {
    /// An opaque horizon of these leaves in one colour, a voxel thick to either side, that gives off no light.
    pub fn of(leaves: Vec<u32>, colour: Colour) -> Self {
        let colouring = Colouring::Own;
        Self { name: None, leaves, colour, colouring, opacity: 1.0, thickness: 1.0, emission: 0.0, paint: None }
    }
}

/// What colours a horizon.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Colouring {
    /// Its own colour.
    #[default]
    Own,
    /// Each leaf, or each group of leaves, another colour, with dark borders (P-horiz, figure 3).
    ByLeaf,
}

/// A volume whose values colour a horizon.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Paint {
    /// The volume's name.
    pub volume: String,
    /// Value → colour; its opacity is not asked.
    pub function: RgbaFunction,
}

fn one() -> f32 {
    1.0
}

/// The function of P-horiz 6 for a volume clipped at ±`clip`: white throughout, values from low to high transparent to opaque; values below
/// `start` (in shares of the clip) are clear.
///
/// ```
/// let function = render::media::white_ramp(100.0, 0.0);
/// assert_eq!(function.evaluate(-20.0)[3], 0.0);
/// assert_eq!(function.evaluate(50.0), [1.0, 1.0, 1.0, 0.5]);
/// assert_eq!(function.evaluate(100.0)[3], 1.0);
/// ```
pub fn white_ramp(clip: f32, start: f32) -> RgbaFunction {
    let stop = |at: f32, opacity: f32| RgbaStop { at, colour: Colour::WHITE, opacity };
    let clear = 0.5 + 0.5 * start.clamp(-1.0, 0.98);
    let mut stops = vec![stop(0.0, 0.0), stop(clear, 0.0), stop(1.0, 1.0)];
    if clear <= 0.0 {
        stops.remove(0);
    }
    RgbaFunction { domain: [-clip, clip], stops }
}

impl Media {
    /// Whether anything is seen through.
    pub fn is_empty(&self) -> bool {
        self.cut_outs.is_empty()
            && self.surroundings.is_empty()
            && self.horizons.is_empty()
            && self.isosurfaces.is_empty()
    }

    /// All media, those of the surroundings first.
    pub fn all(&self) -> impl Iterator<Item = &Medium> {
        self.surroundings.iter().chain(&self.cut_outs)
    }

    /// Refuses what cannot be drawn.
    ///
    /// # Errors
    /// The first [`SceneError`] found.
    pub fn validate(&self) -> Result<(), SceneError> {
        let number = |what: &'static str, found: f32, low: f64, high: f64| {
            let found = f64::from(found);
            if found >= low && found <= high { Ok(()) } else { Err(SceneError::OutOfRange { what, found, low, high }) }
        };
        number("the samples a voxel", self.samples_per_voxel, 0.05, 32.0)?;
        number("the reach of horizons", self.reach, 0.0, 10.0)?;
        if self.all().count() > MAX_MEDIA {
            return Err(SceneError::TooMany { what: "media", found: self.all().count(), limit: MAX_MEDIA });
        }
        if self.horizons.len() > MAX_HORIZONS {
            return Err(SceneError::TooMany {
                what: "horizons shown by their leaves",
                found: self.horizons.len(),
                limit: MAX_HORIZONS,
            });
        }
        let (phong, occlusion) = match self.shading {
            Shading::Unshaded => (None, None),
            Shading::Phong(phong) => (Some(phong), None),
            Shading::Occlusion(occlusion) => (None, Some(occlusion)),
            Shading::Interleaved(both) => {
                number("the stripes", both.stripes as f32, 1.0, 1024.0)?;
                (Some(both.phong), Some(both.occlusion))
            }
        };
        if let Some(phong) = phong {
            number("the ambient light", phong.ambient, 0.0, 10.0)?;
            number("the diffuse light", phong.diffuse, 0.0, 10.0)?;
            number("the specular light", phong.specular, 0.0, 10.0)?;
            number("the shininess", phong.shininess, 0.0, 1000.0)?;
            phong.light.iter().try_for_each(|&c| number("the light's direction", c, -1e6, 1e6))?;
        }
        if let Some(occlusion) = occlusion {
            number("the spread of occlusion", occlusion.spread, 0.0, 16.0)?;
            number("the strength of occlusion", occlusion.strength, 0.0, 100.0)?;
            number("the slices a voxel", occlusion.slices_per_voxel, 0.05, 16.0)?;
            number("the cells of a slice", occlusion.max_cells as f32, 8.0, 2048.0)?;
        }
        self.validate_isosurfaces()?;
        for horizon in &self.horizons {
            number("a horizon's opacity", horizon.opacity, 0.0, 1.0)?;
            number("a horizon's thickness", horizon.thickness, 0.0, 9.0)?;
            number("a horizon's emission", horizon.emission, 0.0, 100.0)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn toml_is_short_and_round_trips() {
        let text = "faces = 'none'\nshading = { occlusion = { spread = 0.5 } }\n[[surroundings]]\nvolume = 'seismic'\n[surroundings.function]\ndomain = [-1.0, 1.0]\nstops = [{ at = 0.0, colour = '#ffffff', opacity = 0.0 }, { at = 1.0, colour = '#ffffff' }]";
        let media: Media = toml::from_str(text).unwrap();
        assert_eq!(media.surroundings[0].function, {
            let mut ramp = white_ramp(1.0, -1.0);
            ramp.stops[0].at = 0.0;
            ramp
        });
        assert_eq!(media.shading, Shading::Occlusion(Occlusion { spread: 0.5, ..Occlusion::default() }));
        assert_eq!(toml::from_str::<Media>(&toml::to_string(&media).unwrap()).unwrap(), media);
        assert_eq!(toml::from_str::<Media>("").unwrap(), Media::default());
    }

    #[test]
    fn numbers_without_a_picture_are_refused() {
        let refused = |change: fn(&mut Media)| {
            let mut media = Media::default();
            change(&mut media);
            media.validate().is_err()
        };
        assert!(!refused(|_| ()));
        assert!(refused(|media| media.samples_per_voxel = 0.0));
        assert!(refused(|media| media.reach = f32::NAN));
        assert!(refused(|media| {
            media.shading = Shading::Occlusion(Occlusion { slices_per_voxel: 0.0, ..Occlusion::default() });
        }));
        assert!(refused(|media| {
            let medium = Medium {
                volume: "a".into(),
                function: white_ramp(1.0, 0.0),
                layers: LayerOpacity::Ignored,
                colour: MediumColour::Function,
            };
            media.cut_outs = vec![medium; MAX_MEDIA + 1];
        }));
    }
}
