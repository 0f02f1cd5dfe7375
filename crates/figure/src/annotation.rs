//! What may be written on a figure besides its title and caption.

use serde::{Deserialize, Serialize};

/// Something that is written on a figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Annotation {
    /// Inlines, crosslines and depth or time along the edges of a block.
    Axes,
    /// Names of layers along the layers, or beside the block with a leader.
    Layers,
    /// Names of faults, the throw of their horizons there, and half-arrows that say which side went down.
    Faults,
    /// The heave beside the throw, and the heave below a profile of throws.
    Heave,
    /// Names of wells at their heads, and of their tops, where they are seen.
    Wells,
    /// Lines of horizons dashed where they were filled, in short dashes and queried where they were only continued.
    Quality,
    /// A bar that says which values the colours of measured data stand for.
    Colours,
    /// A line that says which program and which project a figure comes from, and whose data it shows.
    Provenance,
}

impl Annotation {
    /// All of them but those that are written on request alone ([`Self::ON_REQUEST`]).
    pub const ALL: [Self; 7] =
        [Self::Axes, Self::Layers, Self::Faults, Self::Wells, Self::Quality, Self::Colours, Self::Provenance];

    /// Those that "all" leaves out.
    pub const ON_REQUEST: [Self; 1] = [Self::Heave];

    /// What people call it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Axes => "axes",
            Self::Layers => "layers",
            Self::Faults => "faults",
            Self::Heave => "heave",
            Self::Wells => "wells",
            Self::Quality => "quality",
            Self::Colours => "colours",
            Self::Provenance => "provenance",
        }
    }
}
