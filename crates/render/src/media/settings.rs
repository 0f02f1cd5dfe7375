//! The media of a scene, as they are written in its file.

use super::shading::Shading;
use crate::error::SceneError;
use serde::{Deserialize, Serialize};
use ttf::{Colour, RgbaFunction, RgbaStop};

/// Largest number of media in a scene, cut-outs and surroundings together.
pub(crate) const MAX_MEDIA: usize = 4;
/// Largest number of horizons that a scene shows by their leaves.
pub(crate) const MAX_HORIZONS: usize = 255;
/// Largest number of isosurfaces in a scene.
pub(crate) const MAX_ISOSURFACES: usize = 4;

/// The volume rendering of a scene.
///
/// ```
/// let media: render::Media = toml::from_str("faces = 'none'\nshading = { occlusion = { spread = 0.5 } }").unwrap();
/// assert!(media.is_empty() && media.validate().is_ok());
/// assert_eq!(media.samples_per_voxel, 2.0);
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Media {
    /// Which faces of the block are drawn and stop a ray. Default all.
    pub faces: Faces,
    /// Samples of a ray per unit of length. Default 2.
    pub samples_per_voxel: f32,
    /// How the media are lit. Default unshaded.
    pub shading: Shading,
    /// Whether rays skip empty space. The picture is the same. Default skipped.
    pub empty_space: EmptySpace,
    /// Where the media are visible, depending on the distance to the horizons below. Default everywhere.
    pub scope: Scope,
    /// Distance that counts as near a horizon for `scope`, voxels, at most 10. Default 5.
    pub reach: f32,
    /// Media in the cut-outs. Default none.
    pub cut_outs: Vec<Medium>,
    /// Media in the rest of the roaming box. They are visible where no face of the block is in front. Default
    /// none.
    pub surroundings: Vec<Medium>,
    /// Horizons shown by the leaves of their trees (P-horiz 5.2).
    pub horizons: Vec<PickedHorizon>,
    /// Isosurfaces, in the cut-outs and around them.
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

/// Which faces of the block are drawn and stop a ray.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Faces {
    /// The faces of the roaming box and of the cut-outs.
    #[default]
    All,
    /// Only the back faces of the cut-outs: the surroundings are rendered as a volume (P-illus 5.1).
    CutOuts,
    /// None: the whole box is rendered as a volume.
    None,
}

/// What rays do in empty space.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum EmptySpace {
    /// They skip it.
    #[default]
    Skipped,
    /// They sample it nevertheless, to measure what skipping gains.
    Sampled,
}

/// Where media are visible.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Scope {
    /// Everywhere.
    #[default]
    Everywhere,
    /// Only near the horizons that are shown.
    NearHorizons,
    /// Everywhere except near the horizons that are shown.
    AwayFromHorizons,
}

/// A volume with its RGBA function.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Medium {
    /// The volume's name.
    pub volume: String,
    /// Maps a value to colour and to the opacity of one unit of length.
    pub function: RgbaFunction,
    /// Whether the opacities of the layers multiply its opacity. Default not.
    #[serde(default)]
    pub layers: LayerOpacity,
    /// Where its colour comes from. Default the function.
    #[serde(default)]
    pub colour: MediumColour,
}

/// Where the colour of a medium comes from.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum MediumColour {
    /// Its function.
    #[default]
    Function,
    /// The layer at the point: the average of its pattern, so that the medium looks like the rock of the
    /// layer (P-illus, figure 11).
    Layers,
}

/// Whether the opacity of the layer at a point multiplies that of a medium (P-illus 5.1). Layers with an
/// opacity extrude into the cut-out.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LayerOpacity {
    /// No.
    #[default]
    Ignored,
    /// Yes.
    Followed,
}

/// A horizon, visible where the nearest leaf is one of its own and close enough.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PickedHorizon {
    /// The name of the interpreted horizon that it shows. The caller, who provides the candidates, enters the
    /// leaves of that horizon below. Absent: the leaves are shown as they are.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// The ids of its leaves. Empty: all leaves.
    #[serde(default)]
    pub leaves: Vec<u32>,
    /// Its colour.
    pub colour: Colour,
    /// Whether its leaves differ in colour. Default not.
    #[serde(default)]
    pub colouring: Colouring,
    /// Opacity of one unit of length. Default 1.
    #[serde(default = "one")]
    pub opacity: f32,
    /// Half of its thickness, voxels, at most 9. Default 1.
    #[serde(default = "one")]
    pub thickness: f32,
    /// Light that it emits, in its own colour; 1 is as bright as it is when fully lit. Default 0.
    #[serde(default)]
    pub emission: f32,
    /// An attribute that is painted on it in place of its colour.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub paint: Option<Paint>,
}

impl PickedHorizon {
    /// An opaque horizon of these leaves in one colour, one voxel thick on either side, without emission.
    pub fn of(leaves: Vec<u32>, colour: Colour) -> Self {
        let colouring = Colouring::Own;
        Self { name: None, leaves, colour, colouring, opacity: 1.0, thickness: 1.0, emission: 0.0, paint: None }
    }
}

/// Where the colour of a horizon comes from.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Colouring {
    /// Its own colour.
    #[default]
    Own,
    /// Each leaf or group of leaves has a colour of its own, with dark borders (P-horiz, figure 3).
    ByLeaf,
}

/// An isosurface: the surface on which a scalar has one value.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Isosurface {
    /// The scalar.
    pub of: IsosurfaceSource,
    /// The value, in the unit of the volume. For k' it is the layer number from the bottom, counted from 0,
    /// plus k.
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

/// A scalar that can have isosurfaces.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum IsosurfaceSource {
    /// A volume, by its name.
    Volume(String),
    /// The packed depth k' of P-illus 3.3, here the layer number plus k.
    Depth,
}

/// A volume whose values colour a horizon.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Paint {
    /// The volume's name.
    pub volume: String,
    /// Maps a value to a colour; its opacity is ignored.
    pub function: RgbaFunction,
}

fn one() -> f32 {
    1.0
}

/// The function of P-horiz 6 for a volume clipped at ±`clip`: white, with opacity rising from low to high
/// values. Values below `start` (as a fraction of the clip) are transparent.
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
    /// Whether there is nothing to render as a volume.
    pub fn is_empty(&self) -> bool {
        self.cut_outs.is_empty()
            && self.surroundings.is_empty()
            && self.horizons.is_empty()
            && self.isosurfaces.is_empty()
    }

    /// All media; those of the surroundings first.
    pub fn all(&self) -> impl Iterator<Item = &Medium> {
        self.surroundings.iter().chain(&self.cut_outs)
    }

    /// The names of the volumes that are shown: those of media and isosurfaces, and those painted on horizons.
    pub fn volumes(&self) -> impl Iterator<Item = &str> {
        let painted = self.horizons.iter().filter_map(|horizon| Some(&horizon.paint.as_ref()?.volume));
        self.all().map(|medium| &medium.volume).chain(painted).chain(self.isosurface_volumes()).map(String::as_str)
    }

    /// The names of the volumes that have isosurfaces.
    fn isosurface_volumes(&self) -> impl Iterator<Item = &String> {
        self.isosurfaces.iter().filter_map(|surface| match &surface.of {
            IsosurfaceSource::Volume(name) => Some(name),
            IsosurfaceSource::Depth => None,
        })
    }

    /// Checks that this can be drawn.
    ///
    /// # Errors
    /// The first [`SceneError`] found.
    pub fn validate(&self) -> Result<(), SceneError> {
        let number = |what, found: f32, low, high| SceneError::check_range(what, f64::from(found), low, high);
        number("the number of samples per voxel", self.samples_per_voxel, 0.05, 32.0)?;
        number("the distance that counts as near a horizon", self.reach, 0.0, 10.0)?;
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
        let text = "faces = 'none'\nshading = { occlusion = { spread = 0.5 } }\n[[surroundings]]\
                    \nvolume = 'seismic'\n[surroundings.function]\ndomain = [-1.0, 1.0]\
                    \nstops = [{ at = 0.0, colour = '#ffffff', opacity = 0.0 }, \
                    { at = 1.0, colour = '#ffffff' }]";
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
