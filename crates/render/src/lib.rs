//! Rendering of illustrated and raw seismic blocks.
//!
//! A declarative [`Scene`] says what a picture shows; [`Inputs`] hold the data. Two renderers draw it by the
//! same algorithm: [`reference::render`] on the CPU, written for clarity, and [`Renderer`] on the GPU,
//! without a window. Tests compare their pictures, off edges.
//!
//! Each sample of a pixel casts one ray, which finds the first face of the block ([`visible`]) or the ground
//! ([`ground`]). That point is looked up in flat space, textured, and blended with the raw data. [`media`]
//! integrates the volumes in front of it (volume rendering). [`outline`] strokes lines over the finished
//! picture.
//!
//! # Spaces
//! All positions are in voxel space (x = inline index, y = crossline index, z = sample index downwards),
//! except in the camera's display space (X east, Y north, Z up, in metres, with exaggeration) and in pixels
//! (x right, y down, pixel centres at halves).
//!
//! # The papers
//! - P-illus: Patel, Giertsen, Thurmond and Gröller, "Illustrative Rendering of Seismic Data" (Vision,
//!   Modeling and Visualization 2007).
//! - P-horiz: Patel, Bruckner, Viola and Gröller, "Seismic Volume Visualization for Horizon Extraction" (IEEE
//!   Pacific Visualization 2010).

mod cache;
pub mod camera;
pub mod cover;
pub mod distortion;
pub mod error;
mod face_map;
pub mod faces;
mod gpu;
pub mod ground;
pub mod inputs;
mod kept_points;
pub mod leaves;
pub mod media;
pub mod outline;
mod pattern_size;
pub mod pick;
pub mod places;
mod points;
pub mod reference;
mod resolved_scene;
pub mod scene;
mod shade;
pub mod vector;
pub mod visible;
pub mod wells;

pub use camera::{Camera, Projection, View};
pub use error::{RenderError, SceneError};
pub use faces::Renderer;
pub use inputs::{CandidateVolume, Inputs, NamedVolume, Samples};
pub use leaves::FaceData;
pub use media::{
    Faces, Interleaved, Isosurface, IsosurfaceSource, Media, Medium, Occlusion, Phong, PickedHorizon, Scope, Shading,
};
pub use outline::{NOMINAL_SIDE_PX, Outlines, Stroke, Unpicked};
pub use pick::{PickedObject, PickedPoint, pick};
pub use scene::{Background, Ground, LabelChange, Lookup, PatternSize, Scene, Water};
pub use survey::block::{Corner, CutShape, Side, VoxelBox};
pub use wells::{DrawnWell, WellStyle};
