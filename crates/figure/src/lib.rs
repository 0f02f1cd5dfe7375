//! Figures for print: sections, fences, maps, blocks and wells side by side, laid out on a page.
//!
//! [`make()`] turns what a figure shows ([`Figure`]) and borrowed data ([`FigureInputs`]) into a page, a
//! [`DisplayList`](page::DisplayList) of paths, text and images in points, which [`page`] draws in pixels or writes as
//! vectors.
//!
//! | module | holds |
//! |---|---|
//! | [`cut`] | sections and fences as data: rasters and lines |
//! | [`map`] | horizons and thicknesses as data: values, contours, hatching |
//! | [`correlation`] | wells as columns of layers, to be joined by lines |
//! | [`interpretation`] | what an interpreter sees, as borrowed data |
//! | [`draw`] | builders: from such data to groups of items |
//! | `spec`, [`make`](mod@make) | what a figure shows, and the one way it is made |
//! | [`style`] | sizes and colours that all figures share |
//!
//! Spaces: voxels; (s, t) of a section, voxels from its first sample; points of the page (1/72 inch, y
//! down). Absent here: formats of files, projects, windows, and any drawing of rock: blocks come from a
//! [`BlockPainter`](draw::block::BlockPainter).

mod annotation;
mod convex;
pub mod correlation;
pub mod cut;
pub mod draw;
pub mod error;
pub mod interpretation;
pub mod make;
pub mod map;
mod spec;
pub mod style;

pub use annotation::Annotation;
pub use cut::SectionKind;
pub use error::FigureError;
pub use make::{FigureInputs, SeriesLegend, SeriesPage, make, panel_letter};
pub use spec::{BlockPart, CorrelationPart, FencePart, Figure, MapPart, PageSize, Part, SectionPart, ThrowPart};
