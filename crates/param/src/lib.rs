//! Layer parameterization: the map from curved rock to flat space.
//!
//! Every point of a volume gets (i, j, k): k is 0 on the bottom of its layer and 1 on its top, i and j are where the
//! curve that is everywhere normal to the surfaces of constant k crosses the middle of the layer (P-illus 3). A texture
//! drawn in (i, j, k) then flows with the layers and breaks at the faults.
//!
//! # The way through
//!
//! 1. [`Parameterization::compute`] asks the model ([`LayerModel`]) which columns and depths each region (layer and fault block)
//!    touches, and lays a stratigraphic grid over each ([`RegionGrid`]).
//! 2. Per region, the exact closest points of both sheets are found on a coarse lattice (kd-tree, then Newton on the bicubic surface) and
//!    followed from there: k = d_bottom / (d_bottom + d_top).
//! 3. From every node the isocurve is traced along ∇k to k = 0.5, which gives i and j. Sheets reach past walls, faults
//!    and holes, so a trace never leaves what is defined, and nothing is clamped.
//! 4. [`Parameterization::lookup`] is exact at the horizons at any zoom: the region comes from the model, the position between the sheets from the sheets.
//!    [`Parameterization::voxel_volumes`] samples it; [`PackedVolume`] is the paper's form of the same, with its lookups.
//! 5. [`accuracy`] measures both.
//!
//! # Spaces and units
//! Positions are voxels (x inline, y crossline, z sample, down); distances and angles are those of the metric space (m).
//!
//! # Degenerate places
//!
//! | place | answer |
//! |---|---|
//! | a wall, a fault, a hole | the extended sheets go on: i and j may leave \[0, 1\] |
//! | a fault's tip | beyond it the blocks are those of the extended fault; both sides then agree up to what the sheets do |
//! | a pinch-out | k keeps its limit up to the edge; beyond it the layer does not exist, its grid holds neighbours' values or 0 |
//! | an open layer | parallel to its one horizon; i, j of the closest point on it |
//! | no horizon | k is the vertical fraction |
//! | a layer under an unconformity | the sheets are those before erosion; the model cuts them |
//! | an intrusion | [`KDefinition::for_contacts`] measures it from its outline |
//! | a crease (the closest point jumps) | k is continuous, its gradient is not; traces cross or follow it, nodes are flagged |

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
