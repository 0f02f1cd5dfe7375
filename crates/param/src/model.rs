//! What the parameterization needs to know of an interpretation.

use glam::{DMat3, Vec3};
use survey::HeightField;

/// One layer in one fault block.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize)]
pub struct Region {
    /// Layer, 0 = deepest.
    pub layer: u16,
    /// Fault block.
    pub block: u16,
}

/// An interpretation made solid: sheets that are defined everywhere, and the region of every point.
///
/// With n horizons (0 = youngest) there are n + 1 layers: horizon h is the bottom of layer n − h and the top of layer
/// n − 1 − h.
pub trait LayerModel: Sync {
    /// Counts of voxels `[inlines, crosslines, samples]`.
    fn size(&self) -> [usize; 3];
    /// Voxel → metres, the linear part.
    fn metric(&self) -> DMat3;
    /// Count of layers, at least 1.
    fn layer_count(&self) -> usize;
    /// Count of fault blocks, at least 1.
    fn block_count(&self) -> usize;
    /// The sheet of a horizon in a block, extended past walls, faults and holes and not cut by other horizons.
    fn sheet(&self, horizon: usize, block: u16) -> &HeightField;
    /// The region at a voxel position.
    fn region_at(&self, p: Vec3) -> Region;
}
