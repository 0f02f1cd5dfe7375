//! Builders: from data to groups of items on a page.
//!
//! Each takes the room it may fill and answers with a named group. Spaces: points of the page unless said
//! otherwise.

pub mod annotation;
pub mod axes;
pub mod block;
pub(crate) mod colour_bar;
pub mod correlation;
pub mod label_changes;
pub mod legend;
pub mod map;
mod map_faults;
mod map_lines;
pub mod north;
pub mod overlay;
pub mod rock_section;
pub mod scale;
pub mod section;
pub mod section_wells;
pub(crate) mod sight;
pub mod surfaces;
pub mod swatch;
pub(crate) mod throw_profile;
pub(crate) mod vector_block;
pub mod water;
pub mod words;

use ttf::Colour;

/// A name with the colour it is drawn in.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedColour {
    /// The name.
    pub name: String,
    /// The colour.
    pub colour: Colour,
}
