//! The age order of horizons, their contacts, and the layers between them.
//!
//! Horizons are listed youngest first. n horizons bound n + 1 layers, which are indexed from the bottom:
//! horizon h is the bottom of layer n − h and the top of layer n − 1 − h. Layer 0 has no bottom and layer n
//! has no top.

use serde::{Deserialize, Serialize};
use std::fmt;

/// How a horizon meets the horizons that would cross it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Contact {
    /// Deposited on the layer below: horizons converge but do not cut one another.
    #[default]
    Conformable,
    /// An erosion surface: cuts off the older horizons that would rise above it.
    Erosional,
    /// A surface that younger horizons end against where they would dip below it.
    Onlap,
    /// The boundary of an intrusion (salt, igneous rock): the rock below it replaces everything, so it cuts
    /// off younger and older horizons.
    Intrusive,
    /// The boundary of an intrusion that is older than the erosion surfaces listed above it: they cut it off, as the
    /// land was worn down over it. It cuts off every other horizon.
    Truncated,
}

impl Contact {
    /// All contacts, in the order in which a user chooses among them.
    pub const ALL: [Self; 5] = [Self::Conformable, Self::Erosional, Self::Onlap, Self::Intrusive, Self::Truncated];

    /// What a user calls it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Conformable => "conformable",
            Self::Erosional => "erosional",
            Self::Onlap => "onlap",
            Self::Intrusive => "intrusive",
            Self::Truncated => "truncated-intrusion",
        }
    }

    /// Whether it bounds an intrusion, whose layer replaces others.
    pub fn is_intrusive(self) -> bool {
        matches!(self, Self::Intrusive | Self::Truncated)
    }
}

/// A horizon in the stratigraphy.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct StratigraphicHorizon {
    /// Name of the horizon.
    pub name: String,
    /// How it meets other horizons.
    #[serde(default)]
    pub contact: Contact,
}

/// What a layer is called after.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum LayerOrigin {
    /// A name that a person gave it.
    Named {
        /// The name.
        name: String,
    },
    /// The boundary of the intrusion that it is.
    Intrusion {
        /// The name of that horizon.
        boundary: String,
    },
    /// The horizons above and below it, as far as there are any.
    Between {
        /// The name of the one above.
        top: Option<String>,
        /// The name of the one below.
        base: Option<String>,
    },
}

impl fmt::Display for LayerOrigin {
    /// The name of the layer.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Named { name } | Self::Intrusion { boundary: name } => f.write_str(name),
            Self::Between { top: None, base: None } => f.write_str("all"),
            Self::Between { top: None, base: Some(base) } => write!(f, "above {base}"),
            Self::Between { top: Some(top), base: None } => write!(f, "below {top}"),
            Self::Between { top: Some(top), base: Some(base) } => write!(f, "{top} - {base}"),
        }
    }
}

/// Horizons in age order, youngest first.
///
/// ```
/// # use survey::{Contact, StratigraphicHorizon, Stratigraphy};
/// let horizon = |name: &str| StratigraphicHorizon { name: name.into(), contact: Contact::Conformable };
/// let stratigraphy = Stratigraphy { horizons: vec![horizon("chalk"), horizon("salt")], layer_names: Vec::new() };
/// assert_eq!(stratigraphy.layer_count(), 3);
/// assert_eq!(stratigraphy.layer_names_bottom_up(), ["below salt", "chalk - salt", "above chalk"]);
/// assert_eq!((stratigraphy.top_of(1), stratigraphy.bottom_of(1)), (Some(0), Some(1)));
/// ```
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Stratigraphy {
    /// Youngest (topmost) first.
    pub horizons: Vec<StratigraphicHorizon>,
    /// Names of the layers, youngest first, one more than horizons. A layer without a name is named after its
    /// horizons.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub layer_names: Vec<String>,
}

impl Stratigraphy {
    /// Count of layers: one more than the count of horizons.
    pub fn layer_count(&self) -> usize {
        self.horizons.len() + 1
    }

    /// Index of the horizon at the top of `layer`; `None` for the topmost layer, which has no top.
    pub fn top_of(&self, layer: usize) -> Option<usize> {
        (self.horizons.len()).checked_sub(layer + 1)
    }

    /// Index of the horizon at the bottom of `layer`; `None` for layer 0, which has no bottom.
    pub fn bottom_of(&self, layer: usize) -> Option<usize> {
        (layer > 0).then(|| self.horizons.len() - layer)
    }

    /// What `layer` (0 = deepest) is called after.
    pub fn layer_origin(&self, layer: usize) -> LayerOrigin {
        let from_top = self.layer_count() - 1 - layer;
        if let Some(name) = self.layer_names.get(from_top).filter(|name| !name.is_empty()) {
            return LayerOrigin::Named { name: name.clone() };
        }
        let name = |h: usize| self.horizons[h].name.clone();
        let is_intrusive = |h: usize| self.horizons[h].contact.is_intrusive();
        // An intrusion cuts its layer out of others, and is the bottom of none.
        let base = self.bottom_of(layer).and_then(|first| (first..self.horizons.len()).find(|&h| !is_intrusive(h)));
        match self.top_of(layer) {
            Some(top) if is_intrusive(top) => LayerOrigin::Intrusion { boundary: name(top) },
            top => LayerOrigin::Between { top: top.map(name), base: base.map(name) },
        }
    }

    /// The name of `layer` (0 = deepest): its own name, or else "above A", "A - B" or "below B" after its
    /// horizons; that of an intrusion is the intrusion's.
    pub fn layer_name(&self, layer: usize) -> String {
        self.layer_origin(layer).to_string()
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
    fn an_intrusion_names_its_layer_and_bounds_no_other() {
        let horizons = [("A", Contact::Erosional), ("B", Contact::Onlap), ("Salt", Contact::Intrusive)]
            .map(|(name, contact)| StratigraphicHorizon { name: name.into(), contact });
        let s = Stratigraphy { horizons: horizons.into(), layer_names: Vec::new() };
        assert_eq!(s.layer_names_bottom_up(), ["Salt", "below B", "A - B", "above A"]);
    }

    #[test]
    fn no_horizon_is_one_open_layer() {
        let s = Stratigraphy::default();
        assert_eq!((s.layer_count(), s.top_of(0), s.bottom_of(0)), (1, None, None));
    }
}
