//! What a figure shows, as one declarative value: written to and read from files, made by window and
//! command line alike.
//!
//! Places are line numbers and vertical values, as people type them; sizes are centimetres on paper or pixels.

use crate::annotation::Annotation;
use crate::cut::SectionKind;
use crate::draw::block::Comparison;
use crate::draw::section::Zoom;
use glam::DVec2;
use render::{FaceData, LabelChange, Scene};
use serde::{Deserialize, Serialize};
use ttf::Preset;

/// Centimetres in an inch.
const INCH_CM: f64 = 2.54;

/// A figure.
///
/// ```
/// use figure::{Figure, Part};
///
/// let text = r#"{ "size": { "cm": [16.0, 9.0] }, "dpi": 300.0, "parts": [{ "section": { "kind": "inline", "at": 1250.0 } }] }"#;
/// let figure: Figure = serde_json::from_str(text).unwrap();
/// assert_eq!(figure.size_px(), [1890, 1063]);
/// assert!(matches!(&figure.parts[0], Part::Section(section) if section.at == 1250.0));
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Figure {
    /// Its size. Default 16 × 11 cm: a third of a page.
    pub size: PageSize,
    /// Dots an inch that pictures are drawn at. Default 300.
    pub dpi: f64,
    /// What it shows: one part fills the page, two share it at 0.42, three or four have a quarter each.
    pub parts: Vec<Part>,
    /// Whether layers or horizons are listed beside it. Default no.
    pub legend: bool,
    /// Whether scale bars and captions stand below blocks, sections and maps. Default no.
    pub scale_bar: bool,
    /// Whether an arrow below each block points to north as it lies in the block's middle. Default no.
    pub north_arrow: bool,
    /// What is written on and around its blocks, besides. Default nothing.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub annotate: Vec<Annotation>,
    /// Who the data belong to, for the line of provenance.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub credit: Option<String>,
    /// A line above everything else.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
    /// A sentence or two below everything else.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub caption: Option<String>,
    /// Whether it shows what an interpreter sees, sheets as they were picked, instead of the model. Default no.
    pub interpretation: bool,
    /// Horizons and faults, by name, whose lines sections leave out, and surfaces in front of blocks. Default none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub hidden: Vec<String>,
    /// What is changed about labels of the page and of its maps, sections and wells, besides what the scene of a block says:
    /// a label on one of these is called by the panel's name, a colon, and its own. Default nothing.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub labels: Vec<LabelChange>,
    /// How its colours are printed. Default as its first block's scene says.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub preset: Option<Preset>,
}

impl Default for Figure {
    fn default() -> Self {
        Self {
            size: PageSize::Cm([16.0, 11.0]),
            dpi: 300.0,
            parts: Vec::new(),
            legend: false,
            scale_bar: false,
            north_arrow: false,
            annotate: Vec::new(),
            credit: None,
            title: None,
            caption: None,
            interpretation: false,
            hidden: Vec::new(),
            labels: Vec::new(),
            preset: None,
        }
    }
}

impl Figure {
    /// A figure of one part.
    pub fn of(part: Part) -> Self {
        Self { parts: vec![part], ..Self::default() }
    }

    /// Whether a horizon or fault of this name is left out.
    pub fn hides(&self, name: &str) -> bool {
        self.hidden.iter().any(|hidden| hidden == name)
    }

    /// Whether a section or fence shows rock, if only in part.
    pub fn has_rock_sections(&self) -> bool {
        self.parts.iter().any(|part| match part {
            Part::Section(SectionPart { blend, .. }) | Part::Fence(FencePart { blend, .. }) => {
                blend.is_some_and(|b| b < 1.0)
            }
            _ => false,
        })
    }

    /// Whether it is one block of so many pixels, and nothing else is on its page.
    pub fn is_block_alone(&self) -> bool {
        let is_block = matches!(&self.parts[..], [Part::Block(block)] if block.comparison == Comparison::None);
        let has_words = self.title.is_some() || self.caption.is_some() || !self.annotate.is_empty();
        let has_more = self.interpretation || self.legend || self.scale_bar || self.north_arrow || has_words;
        is_block && !has_more && matches!(self.size, PageSize::Px(_))
    }

    /// What is changed about labels: by the scene of its first block, and by itself.
    pub(crate) fn all_labels(&self) -> Vec<LabelChange> {
        let blocks = self.parts.iter().find_map(|part| match part {
            Part::Block(block) => Some(block.scene.labels.clone()),
            _ => None,
        });
        blocks.into_iter().flatten().chain(self.labels.iter().cloned()).collect()
    }

    /// How its colours are printed.
    pub fn printed_in(&self) -> Preset {
        let block = self.parts.iter().find_map(|part| match part {
            Part::Block(block) => Some(block.scene.preset),
            _ => None,
        });
        self.preset.or(block).unwrap_or_default()
    }

    /// Its size in pixels.
    pub fn size_px(&self) -> [u32; 2] {
        match self.size {
            PageSize::Cm(size) => {
                size.map(|cm| (cm / INCH_CM * self.dpi).round().clamp(0.0, f64::from(u32::MAX)) as u32)
            }
            PageSize::Px(size) => size,
        }
    }

    /// Its size in points: whole pixels at its resolution.
    pub fn size_pt(&self) -> DVec2 {
        let [width, height] = self.size_px().map(f64::from);
        DVec2::new(width, height) * page::list::POINTS_PER_INCH / self.dpi
    }
}

/// How large a page is.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PageSize {
    /// Width and height on paper, cm.
    Cm([f64; 2]),
    /// Width and height in pixels at the figure's resolution.
    Px([u32; 2]),
}

/// A part of a figure.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Part {
    /// A block, or two compared.
    Block(Box<BlockPart>),
    /// A section along the lattice.
    Section(SectionPart),
    /// A section along a line.
    Fence(FencePart),
    /// A map.
    Map(MapPart),
    /// Wells side by side.
    Correlation(CorrelationPart),
    /// Throw against the distance along a fault.
    Throw(ThrowPart),
}

impl From<BlockPart> for Part {
    fn from(part: BlockPart) -> Self {
        Self::Block(Box::new(part))
    }
}

/// A block.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct BlockPart {
    /// What it shows; its size follows from the page.
    pub scene: Scene,
    /// One picture, or two compared.
    pub comparison: Comparison,
}

/// A section along the lattice.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SectionPart {
    /// Along what.
    pub kind: SectionKind,
    /// Its inline, crossline or vertical value.
    pub at: f64,
    /// What of the candidates lies over the amplitudes.
    #[serde(default)]
    pub show: FaceData,
    /// From 0, the rock with its patterns, to 1, the measured data. Absent: measured data where there are some.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub blend: Option<f32>,
    /// Which part of it is seen.
    #[serde(default)]
    pub zoom: Zoom,
    /// How many times longer a metre down is than one across; absent: the section fills its room.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub proportions: Option<f64>,
}

/// A section along a line.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FencePart {
    /// Its corners: inline and crossline each.
    pub corners: Vec<[f64; 2]>,
    /// What of the candidates lies over the amplitudes.
    #[serde(default)]
    pub show: FaceData,
    /// As [`SectionPart::blend`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub blend: Option<f32>,
}

/// A map.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MapPart {
    /// The horizon whose depth or time it shows, or at which a thickness begins.
    pub horizon: String,
    /// The deeper horizon that the thickness below ends at; absent: the map shows the structure.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub thickness_to: Option<String>,
}

/// Wells side by side, their tops joined by lines.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct CorrelationPart {
    /// The wells from left to right; empty: all of the project, in its order.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub wells: Vec<String>,
    /// The surface that is drawn as a level line; absent: depths or times are as they are.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub datum: Option<String>,
    /// The curves beside each well; absent: the one that most wells have.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub logs: Option<Vec<String>>,
    /// First and last value of the axis, in the survey's unit, below the datum if there is one; absent: whole wells.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub range: Option<[f64; 2]>,
}

/// Throw against the distance along a fault, horizon by horizon; with [`Annotation::Heave`] the heave below.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ThrowPart {
    /// The fault.
    pub fault: String,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_figure_survives_being_written_and_read() {
        let figure = Figure {
            size: PageSize::Px([800, 600]),
            parts: vec![
                BlockPart { comparison: Comparison::Wipe([0.0, 1.0], 0.4), ..BlockPart::default() }.into(),
                Part::Fence(FencePart {
                    corners: vec![[1.0, 2.0], [3.0, 4.0]],
                    show: FaceData::Leaves,
                    blend: Some(0.5),
                }),
                Part::Map(MapPart { horizon: "Top".into(), thickness_to: Some("Base".into()) }),
                Part::Throw(ThrowPart { fault: "F1".into() }),
                Part::Correlation(CorrelationPart { datum: Some("Top".into()), ..CorrelationPart::default() }),
            ],
            legend: true,
            annotate: Annotation::ALL.to_vec(),
            ..Figure::default()
        };
        let read: Figure = serde_json::from_str(&serde_json::to_string(&figure).unwrap()).unwrap();
        assert_eq!(read, figure);
        assert!(serde_json::from_str::<Figure>(r#"{ "legends": true }"#).is_err());
    }

    #[test]
    fn a_page_is_whole_pixels_at_its_resolution() {
        let figure = Figure { size: PageSize::Cm([2.54, 5.08]), dpi: 300.0, ..Figure::default() };
        assert_eq!(figure.size_px(), [300, 600]);
        assert!((figure.size_pt() - DVec2::new(72.0, 144.0)).length() < 1e-9);
    }
}
