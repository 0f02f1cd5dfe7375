//! All that decides how a cut face is coloured, as one serialisable value: the layer function, the stack of
//! scalar functions, the colours of the raw data and the blend between them (P-illus 4, figure 7).

use serde::{Deserialize, Serialize};

use crate::layer::check_unit;
use crate::{Colour, LayerTtf, Preset, RgbaFunction, ScalarTtf, TextureLibrary, TtfError};

/// The transfer functions of a scene.
///
/// ```
/// use ttf::{ColourMap, RawColour, RgbaFunction, TextureLibrary, TransferFunctions};
/// let mut functions = TransferFunctions::default();
/// functions.raw = Some(RawColour::new("amplitude", RgbaFunction::centred(ColourMap::Grey, 1500.0)));
/// functions.settings.blend = 1.5;
/// assert!(functions.validate(&TextureLibrary::builtin().unwrap()).is_err());
/// ```
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct TransferFunctions {
    /// Blend and global frequency.
    pub settings: TtfSettings,
    /// Colours of the raw data. Absent: there is nothing to blend with, and the blend has no effect.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub raw: Option<RawColour>,
    /// Layer styles. A layer without one gets [`LayerTtf::default_style`].
    pub layers: LayerTtf,
    /// Scalar functions, composited over the layers first to last.
    pub scalars: Vec<ScalarTtf>,
    /// Colours of the lines of faults, in the order of the model; absent: that of the scene's outlines. The faults
    /// themselves state them, so that they are not stored here.
    #[serde(skip)]
    pub faults: Vec<Option<Colour>>,
}

/// The settings that hold for all functions.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct TtfSettings {
    /// 0 = illustrative … 1 = raw (P-illus 4.3). Default 0.
    pub blend: f32,
    /// Factor on every frequency (P-illus 4.2), above 0. Default 1.
    pub global_frequency: f32,
    /// How colours are printed. Default as they are.
    #[serde(skip_serializing_if = "Preset::is_colour")]
    pub preset: Preset,
}

impl Default for TtfSettings {
    fn default() -> Self {
        Self { blend: 0.0, global_frequency: 1.0, preset: Preset::Colour }
    }
}

/// How the raw data are coloured.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawColour {
    /// Name of the volume shown.
    pub volume: String,
    /// Colour of a sample without data. Absent: the illustration shows there. Default a light grey, so that
    /// missing data can be recognised.
    #[serde(default = "no_data_grey", skip_serializing_if = "Option::is_none")]
    pub no_data: Option<Colour>,
    /// Value → colour.
    pub function: RgbaFunction,
}

fn no_data_grey() -> Option<Colour> {
    Some(Colour::new(0xdc, 0xdc, 0xda))
}

impl RawColour {
    /// The same in a preset.
    #[must_use]
    pub fn printed(self, preset: Preset) -> Self {
        let function = preset.measured(&self.function);
        Self { function, no_data: self.no_data.map(|colour| preset.area(colour)), ..self }
    }

    /// A volume coloured by a function; missing data in light grey.
    pub fn new(volume: &str, function: RgbaFunction) -> Self {
        Self { volume: volume.to_owned(), no_data: no_data_grey(), function }
    }
}

impl TransferFunctions {
    /// The same in a preset; styles follow when they are compiled.
    #[must_use]
    pub fn printed(mut self, preset: Preset) -> Self {
        self.settings.preset = preset;
        self.raw = self.raw.map(|raw| raw.printed(preset));
        self
    }

    /// Checks that this can be drawn.
    ///
    /// # Errors
    /// Everything that the parts refuse, with the place named.
    pub fn validate(&self, library: &TextureLibrary) -> Result<(), TtfError> {
        check_unit("the settings", "the blend", self.settings.blend)?;
        let factor = self.settings.global_frequency;
        if !(factor.is_finite() && factor > 0.0) {
            return Err(TtfError::BadFrequency {
                place: "the global frequency".to_owned(),
                horizontal: factor,
                vertical: factor,
            });
        }
        if let Some(raw) = &self.raw {
            raw.function.validate(&format!("the colours of `{}`", raw.volume))?;
        }
        self.layers.validate(library)?;
        self.scalars.iter().try_for_each(|function| function.validate(library))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ColourMap, LayerStyle};

    #[test]
    fn toml_round_trips_and_an_empty_file_is_the_default() {
        let mut functions = TransferFunctions::default();
        functions.layers.set(LayerStyle::textured("Chalk", Colour::new(9, 8, 7), "chalk"));
        functions.raw = Some(RawColour::new("amplitude", RgbaFunction::centred(ColourMap::Seismics, 1500.0)));
        functions.scalars =
            vec![toml::from_str("volume = 'z'\nintervals = [{ range = [-inf, 2.0], texture = 'sand' }]").unwrap()];
        functions.settings.blend = 0.25;
        functions.validate(&TextureLibrary::builtin().unwrap()).unwrap();
        let text = toml::to_string(&functions).unwrap();
        assert_eq!(toml::from_str::<TransferFunctions>(&text).unwrap(), functions);
        assert_eq!(toml::from_str::<TransferFunctions>("").unwrap(), TransferFunctions::default());
        assert!(toml::from_str::<TransferFunctions>("blend = 0.5").is_err());
    }
}
