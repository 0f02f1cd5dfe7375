//! What is seen through: volumes in the cut-outs and around them, and how light moves in them (P-illus 5.1, P-horiz 5).
//!
//! A medium turns a scalar volume into extinction and colour. The opacity α₀ of its RGBA function is that of one *unit* of length; over a
//! length Δ it is
//!
//! ```text
//! α = 1 − (1 − α₀)^(Δ/Δ₀) = 1 − exp(−κ·Δ/Δ₀)      κ = −ln(1 − α₀)
//! ```
//!
//! so that no picture depends on the number of samples. The unit Δ₀ is the cube root of a voxel's volume in display space (m, exaggerated):
//! an isotropic medium in the space that is looked at, equal to the voxel on a cubic lattice. Several media at one place add their
//! extinctions and mix their colours by them. Light is linear; the sum is encoded at the end.
//!
//! Where light is shadowed by what lies in front, [`light`] carries occlusion and emission from slice to slice before the
//! picture is drawn, and [`march`] reads them; [`bundle`] does so for many rays at once where one volume is all there is. Space is
//! skipped by [`bricks`].

pub mod bricks;
pub mod bundle;
pub mod field;
mod horizons;
pub mod interleaved;
pub mod isosurface;
pub mod light;
pub mod light_grid;
mod lit;
pub mod march;
pub mod medium;
pub mod prepared;
pub mod samples;
mod settings;
mod shading;
pub mod shell;
mod slices;
mod stretches;
pub mod table;
mod wide;
mod windows;

pub use settings::{
    Colouring, EmptySpace, Faces, Isosurface, IsosurfaceSource, LayerOpacity, MAX_HORIZONS, MAX_ISOSURFACES, MAX_MEDIA,
    Media, Medium, MediumColour, Paint, PickedHorizon, Scope, white_ramp,
};
pub use shading::{Interleaved, Occlusion, Phong, Shading};
