//! Layer parameterization: the map from curved rock to flat space.

pub mod accuracy;
mod closest;
mod compute;
mod error;
mod grid;
mod lattice;
mod layer;
mod metric;
mod model;
mod nearest;
mod packed;
mod parameterization;
mod settings;
mod surface;
mod touched;
mod trace;
mod voxels;

pub use compute::ComputeCost;
pub use error::ParamError;
pub use grid::{FlatPoint, RegionGrid, SheetRef};
pub use model::{LayerModel, Region};
pub use packed::PackedVolume;
pub use parameterization::Parameterization;
pub use settings::{KDefinition, ParamSettings};
pub use voxels::{NO_REGION, VoxelParameterization, corner_aligned};
