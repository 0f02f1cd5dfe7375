//! Pages, which know nothing of the file they end in, and the files that they end in.
//!
//! A page is a [`DisplayList`] of paths, text and images in points, in named groups. [`raster()`] draws it in pixels,
//! which [`png()`] and [`tiff()`] write; [`svg()`] and [`pdf()`] write it as vectors; a window paints the same list.
//!
//! | module | holds |
//! |---|---|
//! | [`list`] | the page as data |
//! | [`mod@raster`] | a page as pixels |
//! | [`svg()`] | a page as an SVG document |
//! | [`pdf()`] | a page as a PDF document |
//! | [`animation`] | pictures that follow one another, as one file |
//! | [`FileFormat`] | the kinds of files that these end in, one table |
//! | [`style`] | size and ink of letters |
//!
//! Space: points of the page (1/72 inch, y down). Absent here: what is on a page, and files on disk: back ends return
//! bytes.

pub mod animation;
mod compress;
pub mod error;
mod format;
mod formats;
pub mod list;
mod pdf;
pub mod raster;
mod rect;
pub mod style;
mod svg;

pub use error::PageError;
pub use format::FileFormat;
pub use formats::{endings, endings_of_pages};
pub use list::DisplayList;
pub use pdf::pdf;
pub use raster::{png, raster, tiff};
pub use rect::Rect;
pub use svg::svg;
