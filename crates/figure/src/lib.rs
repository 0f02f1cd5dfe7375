//! Figures for print: sections, fences, maps and blocks, as pages that know nothing of the file they end in.
//!
//! [`make()`] turns what a figure shows ([`Figure`]) and borrowed data ([`FigureInputs`]) into a page, a
//! [`DisplayList`] of paths, text and images in points. [`raster()`] draws a page in pixels, which [`tiff()`] writes
//! for printers, [`svg()`] and [`pdf()`] write it as vectors; the window's preview draws the same list.
//!
//! | module | holds |
//! |---|---|
//! | [`list`] | the page as data |
//! | [`mod@raster`] | a page as pixels |
//! | [`animation`] | pictures that follow one another, as one file |
//! | [`svg()`] | a page as an SVG document |
//! | [`pdf()`] | a page as a PDF document |
//! | [`cut`] | sections and fences as data: rasters and lines |
//! | [`map`] | horizons and thicknesses as data: values, contours, hatching |
//! | [`correlation`] | wells as columns of layers, to be joined by lines |
//! | [`interpretation`] | what an interpreter sees, as borrowed data |
//! | [`draw`] | builders: from such data to groups of items |
//! | [`spec`], [`make`](mod@make) | what a figure shows, and the one way it is made |
//! | [`style`] | sizes and colours that all figures share |
//!
//! Spaces: voxels; (s, t) of a section, voxels from its first sample; points of the page (1/72 inch, y
//! down). Absent here: files, projects, windows, and any drawing of rock: blocks come from a
//! [`BlockPainter`](draw::block::BlockPainter).

pub mod animation;
mod annotation;
mod compress;
mod convex;
pub mod correlation;
pub mod cut;
pub mod draw;
pub mod error;
pub mod interpretation;
pub mod list;
pub mod make;
pub mod map;
mod pdf;
pub mod raster;
mod rect;
pub mod spec;
pub mod style;
mod svg;

pub use annotation::Annotation;
pub use cut::SectionKind;
pub use error::FigureError;
pub use list::DisplayList;
pub use make::{FigureInputs, make};
pub use pdf::pdf;
pub use raster::{raster, tiff};
pub use rect::Rect;
pub use spec::{BlockPart, CorrelationPart, FencePart, Figure, MapPart, PageSize, Part, SectionPart};
pub use svg::svg;
