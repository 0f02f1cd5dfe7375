//! What can stand against a pick.

use glam::Vec3;

/// Why a pick has no node.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum AssemblyError {
    /// There is nothing to pick.
    #[error("the extraction found no surface at all; extract with other settings")]
    Empty,
    /// The place is not in the volume.
    #[error("{at} lies outside the volume of {size:?} voxels; pick inside it")]
    Outside {
        /// Where, voxels.
        at: Vec3,
        /// `[inlines, crosslines, samples]`.
        size: [usize; 3],
    },
    /// No surface is near enough.
    #[error(
        "no candidate lies within {max_distance} voxels of {at}: the nearest is leaf {leaf}, {distance:.1} voxels away at {nearest}; pick there"
    )]
    NothingNear {
        /// Where, voxels.
        at: Vec3,
        /// The limit.
        max_distance: f32,
        /// The nearest leaf.
        leaf: u32,
        /// Its distance, voxels.
        distance: f32,
        /// Its closest point, voxels.
        nearest: Vec3,
    },
    /// The tree is not as high.
    #[error("the tree of leaf {leaf} has {levels} levels above it, {up} were asked for; climb by at most {levels}")]
    BeyondRoot {
        /// The leaf.
        leaf: u32,
        /// Levels above it.
        levels: u32,
        /// Levels asked for.
        up: u32,
    },
}
