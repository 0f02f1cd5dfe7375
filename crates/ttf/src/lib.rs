//! Texture transfer functions, colour maps and the pattern library.
//!
//! A cut face is coloured by a stack of functions (P-illus 4, figure 7). The texture of a layer depends on
//! the layer and the depth in it ([`LayerTtf`]). Textures of scalar volumes lie over it ([`ScalarTtf`]). The
//! result is blended with the raw data in the colours of an [`RgbaFunction`]. [`TransferFunctions`] holds all
//! of these as they are written in a project file, [`TtfTables`] holds them as the CPU and the GPU read them,
//! and [`shade()`] is the reference evaluation. Textures come from the [`TextureLibrary`]. [`FaceFrame`] says
//! how they lie on a face.
//!
//! # Spaces
//! (i, j, k) are flat coordinates with k local to a layer. Normals and gradients are metric with voxel axes
//! (z down). Colours are sRGB-encoded throughout.
//!
//! # The paper
//! P-illus is Patel, Giertsen, Thurmond and Gröller, "Illustrative Rendering of Seismic Data" (Vision,
//! Modeling and Visualization 2007).

mod age;
mod builtin;
mod colour;
mod colour_map;
pub mod coordinates;
pub mod drawing;
mod error;
mod frequency;
mod function;
mod layer;
mod library;
mod palette;
mod preset;
mod raster;
mod rgba;
mod rock;
mod scalar;
mod shade;
mod sheet;
mod similar;
pub mod stretch;
pub mod subset;
mod svg;
pub mod tables;
pub mod text;
pub mod texture;
mod vision;

pub use age::{Age, age, ages};
pub use colour::{Colour, linear_from_srgb, srgb_from_linear};
pub use colour_map::ColourMap;
pub use coordinates::{FaceFrame, Mapping, MappingWeights};
pub use drawing::{TileDrawing, TilePaint, TileSegment, TileShape};
pub use error::TtfError;
pub use frequency::Frequency;
pub use function::{RawColour, TransferFunctions, TtfSettings};
pub use layer::{DepthInterval, LayerStyle, LayerTtf};
pub use library::{Pattern, TextureLibrary};
pub use preset::Preset;
pub use raster::{TILE_ENDINGS, read_svg};
pub use rgba::{RgbaFunction, RgbaStop, symmetric_clip};
pub use rock::{RockPattern, rock, rocks_like};
pub use scalar::{ScalarInterval, ScalarTtf};
pub use shade::{FlatFootprint, LayerPoint, ShadePoint, blend_raw, shade};
pub use sheet::{TileBeside, contact_sheet, contact_sheet_beside};
pub use stretch::Stretch;
pub use svg::MOST_REACH;
pub use tables::{BlockExtent, FINER, LayerExtent, TtfGlobals, TtfTables};
pub use texture::Texture;
pub use vision::{Confusion, Restyling, Vision, confusions};
