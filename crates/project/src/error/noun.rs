//! What a project has several of, each with a name.

use serde::Serialize;

/// Kinds of named things in a project.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
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
        })
    }
}
