//! Errors of picks.

use glam::Vec3;

/// Why a pick selects no node.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum AssemblyError {
    /// The extraction has no surfaces.
    #[error("the extraction found no surface at all; extract with other settings")]
    Empty,
    /// The point is outside the volume.
    #[error("{at} lies outside the volume of {size:?} voxels; pick inside it")]
    Outside {
        /// The point, voxels.
        at: Vec3,
        /// Size of the volume, `[inlines, crosslines, samples]`.
        size: [usize; 3],
    },
    /// No surface is near enough.
    #[error(
        "no candidate lies within {max_distance} voxels of {at}: the nearest is leaf {leaf}, {distance:.1} \
         voxels away at {nearest}; pick there"
    )]
    NothingNear {
        /// The point, voxels.
        at: Vec3,
        /// The greatest distance, voxels.
        max_distance: f32,
        /// Id of the nearest leaf.
        leaf: u32,
        /// Its distance, voxels.
        distance: f32,
        /// Its closest point, voxels.
        nearest: Vec3,
    },
    /// The extraction has no such leaf.
    #[error("the extraction has no leaf {leaf}, it has leaves 1 to {leaves}; pick again")]
    NoLeaf {
        /// The id asked for.
        leaf: u32,
        /// Count of leaves.
        leaves: usize,
    },
    /// The tree is not high enough.
    #[error("the tree of leaf {leaf} has {levels} levels above it, {up} were asked for; climb by at most {levels}")]
    BeyondRoot {
        /// Id of the leaf.
        leaf: u32,
        /// Count of levels above it.
        levels: u32,
        /// Requested level.
        up: u32,
    },
}
