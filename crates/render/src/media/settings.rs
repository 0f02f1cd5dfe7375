//! What a scene says of its media, as it is written in its file.

use super::shading::Shading;
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

/// A surface of one value.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Isosurface {
    /// Of what.
    pub of: IsosurfaceSource,
    /// The value, in the volume's unit; for k' the layer from the bottom, counted from 0, plus k.
    pub value: f32,
    /// Its colour.
    pub colour: Colour,
    /// Opacity of one unit of length inside the shell. Default 1.
    #[serde(default = "one")]
    pub opacity: f32,
    /// Half of its thickness, voxels, at most 9. Default 1.
    #[serde(default = "one")]
    pub thickness: f32,
}

/// What has isosurfaces.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum IsosurfaceSource {
    /// A volume, by its name.
    Volume(String),
    /// k'.
    Depth,
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

    /// The volumes that isosurfaces are of.
    pub fn isosurface_volumes(&self) -> impl Iterator<Item = &String> {
        self.isosurfaces.iter().filter_map(|surface| match &surface.of {
            IsosurfaceSource::Volume(name) => Some(name),
            IsosurfaceSource::Depth => None,
        })
    }

    /// Refuses what cannot be drawn.
    ///
    /// # Errors
    /// The first [`SceneError`] found.
    pub fn validate(&self) -> Result<(), SceneError> {
        let number = |what, found: f32, low, high| SceneError::check_range(what, f64::from(found), low, high);
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
        self.shading.validate()?;
        self.validate_isosurfaces()?;
        for horizon in &self.horizons {
            number("a horizon's opacity", horizon.opacity, 0.0, 1.0)?;
            number("a horizon's thickness", horizon.thickness, 0.0, 9.0)?;
            number("a horizon's emission", horizon.emission, 0.0, 100.0)?;
        }
        Ok(())
    }

    fn validate_isosurfaces(&self) -> Result<(), SceneError> {
        let found = self.isosurfaces.len();
        if found > MAX_ISOSURFACES {
            return Err(SceneError::TooMany { what: "isosurfaces", found, limit: MAX_ISOSURFACES });
        }
        self.isosurfaces.iter().try_for_each(Isosurface::validate)
    }
}

impl Isosurface {
    fn validate(&self) -> Result<(), SceneError> {
        let number = |what, found: f32, low, high| SceneError::check_range(what, f64::from(found), low, high);
        number("an isosurface's value", self.value, -1e30, 1e30)?;
        number("an isosurface's opacity", self.opacity, 0.0, 1.0)?;
        number("an isosurface's thickness", self.thickness, 0.0, 9.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::media::Occlusion;

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
