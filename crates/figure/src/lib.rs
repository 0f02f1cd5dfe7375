//! Figures for print.
//!
//! A page is data: a [`DisplayList`](list::DisplayList) of paths, text and images in points, which knows nothing of the file it ends in.

pub mod error;
pub mod list;
pub mod raster;
mod rect;
pub mod style;

pub use error::FigureError;
pub use raster::raster;
pub use rect::Rect;
