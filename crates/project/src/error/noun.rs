//! What a project has several of, each with a name.

use serde::{Deserialize, Serialize};

/// Kinds of named things in a project.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Noun {
    /// A seismic or attribute volume.
    Volume,
    /// An interpreted horizon.
    Horizon,
    /// An interpreted fault.
    Fault,
    /// A well.
    Well,
    /// A layer between two horizons.
    Layer,
    /// A picture to tile a layer with.
    Texture,
    /// i, j, k from another program.
    Parameterization,
    /// A named view.
    Scene,
    /// A note on a place, called by its number.
    Note,
    /// A figure that is made with the others, called by its file.
    Figure,
}

impl Noun {
    /// All of them.
    pub const ALL: [Self; 10] = [
        Self::Volume,
        Self::Horizon,
        Self::Fault,
        Self::Well,
        Self::Layer,
        Self::Texture,
        Self::Parameterization,
        Self::Scene,
        Self::Note,
        Self::Figure,
    ];
}

impl std::fmt::Display for Noun {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Volume => "volume",
            Self::Horizon => "horizon",
            Self::Fault => "fault",
            Self::Well => "well",
            Self::Layer => "layer",
            Self::Texture => "texture",
            Self::Parameterization => "parameterization",
            Self::Scene => "scene",
            Self::Note => "note",
            Self::Figure => "figure",
        })
    }
}
