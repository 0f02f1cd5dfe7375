//! Rendering of illustrated and raw seismic blocks.
//!
//! One declarative [`Scene`] says what a picture shows, [`Inputs`] bring the data. [`reference::render`] draws it on the CPU.

pub mod accuracy;
pub mod camera;
pub mod compare;
pub mod error;
pub mod faces;
mod frame;
mod gpu;
pub mod ground;
pub mod inputs;
pub mod outline;
pub mod reference;
pub mod scene;
mod shade;
pub mod visible;
pub mod voxel_box;

pub use camera::{Camera, Projection, View};
pub use error::{RenderError, SceneError};
pub use faces::Renderer;
pub use inputs::{Inputs, NamedVolume};
pub use outline::{Outlines, Stroke};
pub use scene::{Background, Ground, Lookup, Scene};
pub use voxel_box::{Corner, VoxelBox};
