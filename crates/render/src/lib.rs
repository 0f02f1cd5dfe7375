//! Rendering of illustrated and raw seismic blocks.
//!
//! One declarative [`Scene`] says what a picture shows, [`Inputs`] bring the data. Two renderers draw it by the same algorithm:
//! [`reference::render`] on the CPU, written for clarity, and [`Renderer`] on the GPU, without a window. [`compare`] tells whether they
//! agree.
//!
//! One ray per sample finds the first face of the block ([`visible`]) or the ground ([`ground`]); the point is looked up in flat
//! space, textured, blended to the raw data; what is in front of it is integrated by [`media`]; outlines ([`outline`]) are stroked over the finished picture.
//!
//! # Spaces
//! Everything is voxel space (x = inline index, y = crossline index, z = sample index downwards), but for the camera's
//! display space (X east, Y north, Z up, m, exaggerated) and pixels (x right, y down, centres at halves).

pub mod accuracy;
pub mod camera;
pub mod compare;
pub mod error;
pub mod faces;
mod gpu;
pub mod ground;
pub mod inputs;
pub mod leaves;
pub mod media;
pub mod outline;
pub mod pick;
pub mod reference;
mod resolved;
pub mod scene;
mod shade;
pub mod visible;
pub mod voxel_box;
pub mod wells;

pub use camera::{Camera, Projection, View};
pub use error::{RenderError, SceneError};
pub use faces::Renderer;
pub use inputs::{CandidateVolume, Inputs, NamedVolume};
pub use leaves::FaceData;
pub use media::{
    Faces, Interleaved, Isosurface, IsosurfaceSource, Media, Medium, Occlusion, Phong, PickedHorizon, Scope, Shading,
};
pub use outline::{Outlines, Stroke};
pub use pick::{PickedObject, PickedPoint, pick};
pub use scene::{Background, Ground, Lookup, Scene};
pub use voxel_box::{Corner, VoxelBox};
pub use wells::{DrawnWell, WellStyle};
