//! The layer texture transfer function (P-illus 4.1): maps a layer and the depth in it to a texture, its
//! frequencies and its opacity.
//!
//! The paper maps one packed k' to texture and frequencies. We store styles by the *name* of the layer and
//! local k in [0, 1] (0 = bottom horizon), so that adding or removing a horizon does not change how the
//! layers above it look. Packed values are derived where they are needed.
//!
//! Intervals are half-open, `[low, high)`; the one that ends at 1 includes the top horizon itself. Where no
//! interval covers k, the layer shows its plain colour.

use serde::{Deserialize, Serialize};

use crate::{Colour, Frequency, TextureLibrary, TtfError};

/// The styles of the layers that have one, in any order.
///
/// ```
/// use ttf::{Colour, LayerStyle, LayerTtf};
/// let mut layers = LayerTtf::default();
/// layers.set(LayerStyle::plain("Salt", Colour::WHITE));
/// layers.set(LayerStyle::plain("Salt", Colour::BLACK));
/// assert_eq!(layers.styles.len(), 1);
/// assert_eq!(layers.style("Salt").unwrap().colour, Colour::BLACK);
/// ```
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct LayerTtf {
    /// One style per layer name.
    pub styles: Vec<LayerStyle>,
}

/// How one layer is drawn.
///
/// ```
/// let style: ttf::LayerStyle = toml::from_str(r##"
///     layer = "Chalk"
///     colour = "#d9e2d2"
///     intervals = [{ k = [0.0, 0.5], texture = "chalk" }, { k = [0.5, 1.0], texture = "marl" }]
/// "##).unwrap();
/// assert_eq!(style.texture_at(0.5), Some("marl"));
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LayerStyle {
    /// The layer's name in the stratigraphy.
    pub layer: String,
    /// The colour under the pattern, sRGB.
    pub colour: Colour,
    /// Replaces the colour of the patterns' ink. Absent: the texture keeps its own colours.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ink: Option<Colour>,
    /// Opacity of the layer inside a cut-out, in [0, 1] (P-illus 5: extruding layers). Default 0: the layer
    /// is cut away.
    #[serde(default)]
    pub opacity: f32,
    /// Frequency of the intervals that state none. Absent: it follows from the tile's printed size.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frequency: Option<Frequency>,
    /// Textures by depth in the layer. Empty: the layer has a plain colour.
    #[serde(default)]
    pub intervals: Vec<DepthInterval>,
}

/// A texture over a part of a layer's depth.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DepthInterval {
    /// Half-open range of local k, `[low, high)`, within [0, 1].
    pub k: [f32; 2],
    /// Name of the texture in the library.
    pub texture: String,
    /// Repeats of the tile. Absent: those of the layer.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frequency: Option<Frequency>,
    /// Opacity of the texture over the colour, in [0, 1]. Default 1.
    #[serde(default = "opaque")]
    pub opacity: f32,
    /// Background of this interval. Absent: the layer's colour.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub colour: Option<Colour>,
}

pub(crate) fn opaque() -> f32 {
    1.0
}

impl LayerStyle {
    /// A layer in one colour without a pattern.
    pub fn plain(layer: &str, colour: Colour) -> Self {
        Self { layer: layer.to_owned(), colour, ink: None, opacity: 0.0, frequency: None, intervals: Vec::new() }
    }

    /// A layer filled with one texture from bottom to top.
    pub fn textured(layer: &str, colour: Colour, texture: &str) -> Self {
        let interval =
            DepthInterval { k: [0.0, 1.0], texture: texture.to_owned(), frequency: None, opacity: 1.0, colour: None };
        Self { intervals: vec![interval], ..Self::plain(layer, colour) }
    }

    /// The texture at local `k` (clamped to [0, 1]), if an interval covers it.
    pub fn texture_at(&self, k: f32) -> Option<&str> {
        self.interval_at(k).map(|interval| interval.texture.as_str())
    }

    /// The interval that covers local `k` (clamped to [0, 1]).
    pub fn interval_at(&self, k: f32) -> Option<&DepthInterval> {
        let k = k.clamp(0.0, 1.0);
        self.intervals.iter().find(|interval| {
            let [low, high] = interval.k;
            k >= low && (k < high || high >= 1.0)
        })
    }

    /// Checks that this can be drawn.
    ///
    /// # Errors
    /// Intervals that are empty, overlap or reach outside [0, 1]; opacities outside [0, 1]; frequencies that
    /// are not finite and positive; textures that the library does not have.
    pub fn validate(&self, library: &TextureLibrary) -> Result<(), TtfError> {
        let place = format!("layer `{}`", self.layer);
        check_unit(&place, "the cut-out opacity", self.opacity)?;
        if let Some(frequency) = self.frequency {
            frequency.validate(&place)?;
        }
        for interval in &self.intervals {
            let [low, high] = interval.k;
            if !(low >= 0.0 && high <= 1.0 && low < high) {
                return Err(TtfError::BadDepthInterval { layer: self.layer.clone(), low, high });
            }
            check_unit(&place, "the texture's opacity", interval.opacity)?;
            if let Some(frequency) = interval.frequency {
                frequency.validate(&place)?;
            }
            library.index_of(&interval.texture, &place)?;
        }
        check_overlap(&place, self.intervals.iter().map(|interval| interval.k))
    }
}

impl LayerTtf {
    /// The style of a layer.
    pub fn style(&self, layer: &str) -> Option<&LayerStyle> {
        self.styles.iter().find(|style| style.layer == layer)
    }

    /// Replaces the layer's style, or adds it.
    pub fn set(&mut self, style: LayerStyle) {
        match self.styles.iter_mut().find(|present| present.layer == style.layer) {
            Some(present) => *present = style,
            None => self.styles.push(style),
        }
    }

    /// Checks that this can be drawn.
    ///
    /// # Errors
    /// Two styles for one layer, and everything that [`LayerStyle::validate`] refuses.
    pub fn validate(&self, library: &TextureLibrary) -> Result<(), TtfError> {
        for (index, style) in self.styles.iter().enumerate() {
            if self.styles[..index].iter().any(|earlier| earlier.layer == style.layer) {
                return Err(TtfError::DuplicateLayer { layer: style.layer.clone() });
            }
            style.validate(library)?;
        }
        Ok(())
    }
}

/// Returns an error for a value outside [0, 1], NaN included.
pub(crate) fn check_unit(place: &str, quantity: &'static str, value: f32) -> Result<(), TtfError> {
    if (0.0..=1.0).contains(&value) {
        return Ok(());
    }
    Err(TtfError::OutsideUnit { place: place.to_owned(), quantity, value })
}

/// Returns an error for half-open intervals that share values. Each interval must be valid by itself.
pub(crate) fn check_overlap(place: &str, intervals: impl Iterator<Item = [f32; 2]>) -> Result<(), TtfError> {
    let mut sorted: Vec<[f32; 2]> = intervals.collect();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]));
    match sorted.windows(2).find(|pair| pair[1][0] < pair[0][1]) {
        None => Ok(()),
        Some(pair) => Err(TtfError::Overlap {
            place: place.to_owned(),
            first_low: pair[0][0],
            first_high: pair[0][1],
            second_low: pair[1][0],
            second_high: pair[1][1],
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn library() -> TextureLibrary {
        TextureLibrary::builtin().unwrap()
    }

    fn two_halves() -> LayerStyle {
        let mut style = LayerStyle::textured("Chalk", Colour::WHITE, "chalk");
        style.intervals[0].k = [0.0, 0.5];
        style.intervals.push(DepthInterval {
            k: [0.5, 1.0],
            texture: "marl".to_owned(),
            frequency: Some(Frequency { horizontal: 30.0, vertical: 4.0 }),
            opacity: 0.5,
            colour: Some(Colour::BLACK),
        });
        style
    }

    #[test]
    fn intervals_are_half_open_and_the_last_includes_the_horizon() {
        let style = two_halves();
        style.validate(&library()).unwrap();
        for (k, texture) in
            [(0.0, "chalk"), (0.499_99, "chalk"), (0.5, "marl"), (1.0, "marl"), (-0.2, "chalk"), (1.3, "marl")]
        {
            assert_eq!(style.texture_at(k), Some(texture), "{k}");
        }
        let mut open = style;
        open.intervals[1].k = [0.5, 0.9];
        assert_eq!(open.texture_at(0.9), None);
    }

    #[test]
    fn toml_round_trips_and_is_short_for_the_usual_case() {
        let functions = LayerTtf { styles: vec![two_halves(), LayerStyle::plain("Salt", Colour::new(1, 2, 3))] };
        #[derive(Serialize, Deserialize)]
        struct File {
            layers: LayerTtf,
        }
        let text = toml::to_string(&File { layers: functions.clone() }).unwrap();
        assert_eq!(toml::from_str::<File>(&text).unwrap().layers, functions);
        let short: LayerStyle = toml::from_str("layer = 'Salt'\ncolour = '#010203'").unwrap();
        assert_eq!(short, functions.styles[1]);
    }

    #[test]
    fn what_cannot_be_drawn_is_refused_by_its_own_error() {
        let library = library();
        let error = |change: fn(&mut LayerStyle)| {
            let mut style = two_halves();
            change(&mut style);
            style.validate(&library).unwrap_err()
        };
        for bad in [
            (|style: &mut LayerStyle| style.intervals[0].k = [-0.1, 0.5]) as fn(&mut LayerStyle),
            |style| style.intervals[1].k = [0.5, 1.1],
            |style| style.intervals[0].k = [f32::NAN, 0.5],
            |style| style.intervals[0].k = [0.4, 0.4],
            |style| style.intervals[0].k = [0.5, 0.2],
        ] {
            assert!(matches!(error(bad), TtfError::BadDepthInterval { .. }));
        }
        assert!(matches!(error(|style| style.intervals[0].k = [0.0, 0.6]), TtfError::Overlap { .. }));
        assert!(matches!(error(|style| style.opacity = 1.5), TtfError::OutsideUnit { .. }));
        assert!(matches!(error(|style| style.intervals[0].opacity = f32::NAN), TtfError::OutsideUnit { .. }));
        assert!(matches!(
            error(|style| style.frequency = Some(Frequency { horizontal: 0.0, vertical: 1.0 })),
            TtfError::BadFrequency { .. }
        ));
        let unknown = error(|style| style.intervals[0].texture = "limstone".to_owned());
        assert!(unknown.to_string().contains("did you mean `limestone`?"), "{unknown}");
        // Not siltstone.
        let unknown = error(|style| style.intervals[0].texture = "sandstone".to_owned());
        assert!(unknown.to_string().contains("did you mean `sandstone-"), "{unknown}");
        let twice = LayerTtf { styles: vec![two_halves(), two_halves()] };
        assert!(matches!(twice.validate(&library), Err(TtfError::DuplicateLayer { .. })));
    }

    #[test]
    fn setting_a_style_replaces_the_layers_own() {
        let mut functions = LayerTtf::default();
        functions.set(two_halves());
        functions.set(LayerStyle::plain("Salt", Colour::BLACK));
        functions.set(LayerStyle::plain("Chalk", Colour::BLACK));
        assert_eq!(functions.styles.len(), 2);
        assert_eq!(functions.style("Chalk"), Some(&LayerStyle::plain("Chalk", Colour::BLACK)));
    }
}
