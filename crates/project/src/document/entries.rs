//! The named entries of a project as `project.toml` lists them. Files are relative to the project's folder; a hash
//! identifies data by its content.

use super::ids::Id;
use super::origin::Origin;
use super::picks::Assembly;
use figure::Figure;
use render::Scene;
use serde::{Deserialize, Serialize};
use survey::{Contact, Quantity, SurveyGeometry};
use ttf::{Colour, LayerTtf, RawColour, ScalarTtf, TransferFunctions, TtfSettings};

/// What a positive amplitude means.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Polarity {
    /// SEG normal: an increase of impedance is a positive number.
    #[default]
    Normal,
    /// An increase of impedance is a negative number.
    Reverse,
}

impl std::fmt::Display for Polarity {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Normal => "normal",
            Self::Reverse => "reverse",
        })
    }
}

/// A volume of the project.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VolumeEntry {
    /// By which `project.toml` refers to it.
    #[serde(default, skip_serializing_if = "Id::is_none")]
    pub id: Id,
    /// Unique name.
    pub name: String,
    /// Data, relative to the project's folder.
    pub file: String,
    /// BLAKE3 of the samples and the live-trace mask.
    pub hash: String,
    /// What a positive amplitude means.
    #[serde(default)]
    pub polarity: Polarity,
    /// What its samples measure, if whoever stored it said so.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub quantity: Option<Quantity>,
    /// The value that 99 % of the samples do not exceed in magnitude; colours are clipped there.
    pub clip: f32,
    /// The smallest sample; if it is not negative, the volume is an attribute without a natural zero.
    pub lowest: f32,
    /// Where it came from.
    pub origin: Origin,
    /// Its own lattice, if it differs from the project's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub geometry: Option<SurveyGeometry>,
}

/// An extraction of horizon candidates; the candidates are stored in `derived/` under its key.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExtractionEntry {
    /// Key: identifies volume, settings and method.
    pub key: String,
    /// The name of the volume at the time.
    pub volume: String,
}

/// Proposed faults; they are stored in `derived/` under their key.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ProposalsEntry {
    /// Key: identifies horizons, faults, settings and method.
    pub key: String,
}

/// A horizon of the project.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HorizonEntry {
    /// By which `project.toml` refers to it.
    #[serde(default, skip_serializing_if = "Id::is_none")]
    pub id: Id,
    /// Unique name.
    pub name: String,
    /// Its contact with its neighbours.
    #[serde(default)]
    pub contact: Contact,
    /// Data, relative to the project's folder.
    pub file: String,
    /// BLAKE3 of its sheets.
    pub hash: String,
    /// Where it came from.
    pub origin: Origin,
    /// How it was assembled from picks; `None` if it was imported.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub assembly: Option<Assembly>,
    /// Scattered points: the gap that was stated at import; a circle of this radius without a point stays a hole, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gap_m: Option<f64>,
    /// What was done to its sheets since, unless its log says so.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub refined: Vec<Refinement>,
    /// Its colour if it has no picks, which keep one of their own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub colour: Option<Colour>,
}

/// What can be done to the sheets of a horizon that has no log.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Refinement {
    /// Its holes were filled.
    Filled,
    /// It was smoothed.
    Smoothed,
}

impl HorizonEntry {
    /// Where it came from and what was done to it since, in words.
    pub fn history(&self) -> String {
        let counted = |count: usize, noun: &str| format!("{count} {noun}{}", if count == 1 { "" } else { "s" });
        let made = match self.assembly.as_ref().map(|log| (log.picks.len(), log.drawn.len())) {
            None | Some((0, 0)) => self.origin.to_string(),
            Some((picks, 0)) => format!("assembled by {}", counted(picks, "pick")),
            Some((0, parts)) => format!("{} drawn or tracked", counted(parts, "part")),
            Some((picks, parts)) => {
                format!("assembled by {}, {} drawn or tracked", counted(picks, "pick"), counted(parts, "part"))
            }
        };
        let done = self.refined.iter().map(|done| match done {
            Refinement::Filled => "; holes filled",
            Refinement::Smoothed => "; smoothed",
        });
        std::iter::once(made.as_str()).chain(done).collect()
    }

    /// The colour that it was given; `None` in projects of old: it is drawn in the one of its place in the list.
    pub fn own_colour(&self) -> Option<Colour> {
        self.assembly.as_ref().map(|log| log.colour).or(self.colour)
    }

    /// Gives it a colour, where it keeps its own.
    pub(crate) fn set_colour(&mut self, colour: Colour) {
        match &mut self.assembly {
            Some(log) => log.colour = colour,
            None => self.colour = Some(colour),
        }
    }
}

/// A fault of the project.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FaultEntry {
    /// By which `project.toml` refers to it.
    #[serde(default, skip_serializing_if = "Id::is_none")]
    pub id: Id,
    /// Unique name.
    pub name: String,
    /// The fault it ends at.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub truncated_by: Option<String>,
    /// By how much it reaches beyond what was drawn, m; 0: it ends where it was drawn.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub grown_m: f64,
    /// Data, relative to the project's folder.
    pub file: String,
    /// BLAKE3 of its triangles.
    pub hash: String,
    /// Where it came from.
    pub origin: Origin,
    /// Its colour, if it was given one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub colour: Option<Colour>,
}

impl FaultEntry {
    /// The colour in which its lines and sticks are drawn: black, unless it was given one.
    pub fn ink(&self) -> Colour {
        self.colour.unwrap_or(Colour::BLACK)
    }
}

/// Whether a fault ends where it was drawn.
#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks for a reference")]
pub(crate) fn is_zero(metres: &f64) -> bool {
    *metres == 0.0
}

/// A well of the project.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WellEntry {
    /// By which `project.toml` refers to it.
    #[serde(default, skip_serializing_if = "Id::is_none")]
    pub id: Id,
    /// Unique name.
    pub name: String,
    /// Data, relative to the project's folder.
    pub file: String,
    /// BLAKE3 of its path, tops, logs and checkshots.
    pub hash: String,
    /// The colour of its path. Absent: that of the scene's wells.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub colour: Option<Colour>,
    /// Where it came from.
    pub origin: Origin,
}

/// A tile of the user's own.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TextureEntry {
    /// By which `project.toml` refers to it.
    #[serde(default, skip_serializing_if = "Id::is_none")]
    pub id: Id,
    /// Unique name, by which layers refer to it: the file's name without its extension.
    pub name: String,
    /// The picture, relative to the project's folder.
    pub file: String,
    /// Printed width and height, mm.
    pub tile_mm: [f32; 2],
    /// BLAKE3 of the file's bytes; empty in projects that recorded none.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub hash: String,
    /// Where it came from.
    pub origin: Origin,
}

/// A parameterization that another program computed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ParameterizationEntry {
    /// The name of the file that it was read from.
    pub name: String,
    /// Data, relative to the project's folder.
    pub file: String,
    /// BLAKE3 of its values.
    pub hash: String,
    /// Where it came from.
    pub origin: Origin,
}

/// How everything is coloured and textured; what is not set gets a default when it is drawn. Blend and frequency belong
/// to the scenes.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Style {
    /// The volume shown as raw data and its colours.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub raw: Option<RawColour>,
    /// Styles of layers.
    pub layers: LayerTtf,
    /// Textures by the values of volumes, composited first to last.
    pub scalars: Vec<ScalarTtf>,
}

impl Style {
    /// The style as transfer functions.
    pub fn functions(&self) -> TransferFunctions {
        TransferFunctions {
            settings: TtfSettings::default(),
            raw: self.raw.clone(),
            layers: self.layers.clone(),
            scalars: self.scalars.clone(),
            faults: Vec::new(),
        }
    }
}

/// A named scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneEntry {
    /// By which `project.toml` refers to it.
    #[serde(default, skip_serializing_if = "Id::is_none")]
    pub id: Id,
    /// Unique name.
    pub name: String,
    /// The scene.
    pub scene: Scene,
}

/// A note on a place, which reviews show with an arrow.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NoteEntry {
    /// Its text.
    pub text: String,
    /// Inline, crossline and vertical value of the place.
    pub at: [f64; 3],
    /// The scene that shows it. Absent: every scene.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scene: Option<String>,
}

/// A figure that is made with the others of the project. Beside its file and its scene it has the words of a figure's
/// own file ([`Figure`]).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FigureEntry {
    /// The name of the file, whose ending states the format. Unique, whatever the case of its letters.
    pub file: String,
    /// The scene of the project that its blocks show. Absent: its blocks show their own, and a figure without parts
    /// shows the project's first.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scene: Option<String>,
    /// What is on the page; without parts, one block.
    #[serde(flatten)]
    pub figure: Figure,
}
