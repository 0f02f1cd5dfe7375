//! The order of horizons in age, their contacts, and the layers between them.
//!
//! Horizons are listed youngest first. With n of them there are n + 1 layers, indexed from the bottom: horizon h is
//! the bottom of layer n − h and the top of layer n − 1 − h. Layers 0 and n are open.

use serde::{Deserialize, Serialize};

/// What a horizon does to its neighbours where they would cross it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Contact {
    /// Deposited on the layer below; horizons thin towards one another but do not cut.
    #[default]
    Conformable,
    /// An erosion surface: cuts off the older horizons that would rise above it.
    Erosional,
    /// A surface that younger horizons end against where they would dip below it.
    Onlap,
    /// The outline of an intrusion (salt, igneous): what is below it replaces everything, younger and older horizons are cut off.
    Intrusive,
}

/// A horizon's place in the stratigraphy.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct StratigraphicHorizon {
    /// Name of the horizon.
    pub name: String,
    /// What it does to its neighbours.
    #[serde(default)]
    pub contact: Contact,
}

/// Horizons in age order, youngest first.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Stratigraphy {
    /// Youngest (topmost) first.
    pub horizons: Vec<StratigraphicHorizon>,
    /// Names of the layers, youngest first (one more than horizons); layers without a name get one from their horizons.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub layer_names: Vec<String>,
}

impl Stratigraphy {
    /// Count of layers: one more than horizons.
    pub fn layer_count(&self) -> usize {
        self.horizons.len() + 1
    }

    /// Index of the horizon at the top of `layer`; `None` for the topmost, open layer.
    pub fn top_of(&self, layer: usize) -> Option<usize> {
        (self.horizons.len()).checked_sub(layer + 1)
    }

    /// Index of the horizon at the bottom of `layer`; `None` for layer 0, open below.
    pub fn bottom_of(&self, layer: usize) -> Option<usize> {
        (layer > 0).then(|| self.horizons.len() - layer)
    }

    /// The name of `layer` (0 = deepest): the one given, or "above A", "A - B", "below B" after its horizons.
    pub fn layer_name(&self, layer: usize) -> String {
        let from_top = self.layer_count() - 1 - layer;
        if let Some(name) = self.layer_names.get(from_top).filter(|name| !name.is_empty()) {
            return name.clone();
        }
        let name = |h: usize| self.horizons[h].name.as_str();
        match (self.top_of(layer), self.bottom_of(layer)) {
            (None, None) => "all".to_owned(),
            (None, Some(bottom)) => format!("above {}", name(bottom)),
            (Some(top), None) => format!("below {}", name(top)),
            (Some(top), Some(bottom)) => format!("{} - {}", name(top), name(bottom)),
        }
    }

    /// All layer names, bottom to top (index = layer).
    pub fn layer_names_bottom_up(&self) -> Vec<String> {
        (0..self.layer_count()).map(|layer| self.layer_name(layer)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layers_know_their_horizons() {
        let horizons =
            ["A", "B", "C"].map(|name| StratigraphicHorizon { name: name.into(), contact: Contact::default() });
        let s = Stratigraphy { horizons: horizons.into(), layer_names: Vec::new() };
        assert_eq!(s.layer_count(), 4);
        assert_eq!((s.top_of(3), s.bottom_of(3)), (None, Some(0)));
        assert_eq!((s.top_of(2), s.bottom_of(2)), (Some(0), Some(1)));
        assert_eq!((s.top_of(0), s.bottom_of(0)), (Some(2), None));
        assert_eq!(s.layer_names_bottom_up(), ["below C", "B - C", "A - B", "above A"]);
    }

    #[test]
    fn no_horizon_is_one_open_layer() {
        let s = Stratigraphy::default();
        assert_eq!((s.layer_count(), s.top_of(0), s.bottom_of(0)), (1, None, None));
    }
}
