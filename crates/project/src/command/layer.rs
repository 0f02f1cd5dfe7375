//! How layers look: name, colour, patterns by depth, frequency, opacity (P-illus 4.1).

use super::{Effect, Noun, ProjectError};
use crate::folder::Draft;
use crate::styles;
use param::KDefinition;
use serde::{Deserialize, Serialize};
use ttf::{Colour, DepthInterval, Frequency, LayerStyle, LayerTtf, TtfError};

/// Changes a layer's style; what is `None` stays as it is.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SetLayer {
    /// The layer's present name.
    pub layer: String,
    /// A new name.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Colour under the pattern.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub colour: Option<Colour>,
    /// Colour of the pattern's lines.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ink: Option<Colour>,
    /// One texture from bottom to top; the layer takes its usual colour unless `colour` is given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pattern: Option<String>,
    /// A rock, whose pattern and usual colour the layer takes ([`ttf::rock`]).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rock: Option<String>,
    /// A unit of geological time, whose colour on the international chart the layer takes ([`ttf::age()`]).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub age: Option<String>,
    /// Textures by depth in the layer, which replace the present ones.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub intervals: Vec<DepthInterval>,
    /// Repeats of the tile along i and along k.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub frequency: Option<Frequency>,
    /// Opacity inside a cut-out, 0 to 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub opacity: Option<f32>,
    /// What k means inside the layer.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub k: Option<KDefinition>,
    /// The complete style, applied before the other changes: only in this way can ink and frequency be removed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub style: Option<LayerStyle>,
}

/// Removes a layer's style, so that it has the default one again.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ResetLayer {
    /// The layer's name.
    pub layer: String,
}

impl SetLayer {
    pub(super) fn execute(&self, draft: &mut Draft) -> Result<Effect, ProjectError> {
        let position = draft.document.position(Noun::Layer, &self.layer)?;
        let library = styles::pattern_library(draft.root(), &draft.document)?;
        let document = &mut draft.document;
        if let Some(name) = &self.name {
            document.name_layer(position, name)?;
        }
        let names = document.layers();
        let layer = &names[position];
        if let Some(k) = self.k {
            document.k.insert(layer.clone(), k);
        }
        let untouched = Self { layer: self.layer.clone(), name: self.name.clone(), k: self.k, ..Self::default() };
        if *self != untouched {
            let present = document.style.layers.style(layer).cloned();
            let from_bottom = names.len() - 1 - position;
            let mut style = present.unwrap_or_else(|| LayerTtf::default_style(layer, from_bottom, &library));
            self.change(&mut style, &library)?;
            style.validate(&library)?;
            document.style.layers.set(style);
        }
        Ok(Effect::Changed { summary: format!("style of layer {layer}") })
    }

    fn change(&self, style: &mut LayerStyle, library: &ttf::TextureLibrary) -> Result<(), ProjectError> {
        if let Some(whole) = &self.style {
            *style = LayerStyle { layer: style.layer.clone(), ..whole.clone() };
        }
        let meant = self.rock.as_ref().map(|rock| {
            let patterns: Vec<&str> = library.patterns().map(|pattern| pattern.name.as_str()).collect();
            let found = ttf::rock(rock, &patterns).map(|found| found.pattern);
            found.ok_or_else(|| TtfError::UnknownRock { rock: rock.clone() })
        });
        if let Some(pattern) = meant.transpose()?.as_ref().or(self.pattern.as_ref()) {
            let index = library.index_of(pattern, &format!("layer `{}`", style.layer))?;
            let textured = LayerStyle::textured(&style.layer, library.pattern(index).colour, pattern);
            style.colour = textured.colour;
            style.intervals = textured.intervals;
        }
        if let Some(age) = &self.age {
            style.colour = ttf::age(age).ok_or_else(|| TtfError::UnknownAge { age: age.clone() })?.colour;
        }
        if !self.intervals.is_empty() {
            style.intervals.clone_from(&self.intervals);
        }
        style.colour = self.colour.unwrap_or(style.colour);
        style.ink = self.ink.or(style.ink);
        style.frequency = self.frequency.or(style.frequency);
        style.opacity = self.opacity.unwrap_or(style.opacity);
        Ok(())
    }
}

impl ResetLayer {
    pub(super) fn execute(&self, draft: &mut Draft) -> Result<Effect, ProjectError> {
        draft.document.position(Noun::Layer, &self.layer)?;
        draft.document.style.layers.styles.retain(|style| style.layer != self.layer);
        draft.document.k.remove(&self.layer);
        Ok(Effect::Changed { summary: format!("default style of layer {}", self.layer) })
    }
}
