//! Volume rendering: volumes in the cut-outs and around them, and how they are lit (P-illus 5.1, P-horiz 5).
//!
//! A medium maps a scalar volume to extinction and colour. The opacity α₀ of its RGBA function is that of one
//! *unit* of length. Over a length Δ it is
//!
//! ```text
//! α = 1 − (1 − α₀)^(Δ/Δ₀) = 1 − exp(−κ·Δ/Δ₀)      κ = −ln(1 − α₀)
//! ```
//!
//! so that no picture depends on the number of samples. The unit Δ₀ is the cube root of the volume of a voxel
//! in display space (m, exaggerated): the medium is isotropic in display space, and the unit equals the voxel
//! on a cubic lattice. Where several media overlap, their extinctions add, and their colours are averaged
//! with the extinctions as weights. Light is linear; the sum is sRGB-encoded at the end.
//!
//! With occlusion shading, [`light`] propagates occlusion and emission from slice to slice before the picture
//! is drawn, and [`march`] reads the result. `bundle` marches many rays at once if there is only one
//! volume. [`bricks`] is for empty-space skipping.

pub mod bricks;
pub(crate) mod bundle;
pub mod field;
mod horizons;
pub mod isosurface;
pub mod light;
pub(crate) mod light_grid;
pub mod march;
pub mod medium;
mod phong;
pub mod preparation;
pub mod samples;
mod settings;
mod shading;
pub mod shell;
mod slices;
mod stretches;
pub(crate) mod stripes;
pub mod table;
mod windows;

pub(crate) use settings::MAX_MEDIA;
pub use settings::{
    Colouring, EmptySpace, Faces, Isosurface, IsosurfaceSource, LayerOpacity, Media, Medium, MediumColour, Paint,
    PickedHorizon, Scope, white_ramp,
};
pub use shading::{Interleaved, Occlusion, Phong, Shading};
