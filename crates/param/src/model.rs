//! What the parameterization needs of an interpretation.

use glam::{DMat3, Vec3};
pub use model::Region;
use model::{FaultNetwork, LevelSurface, StructuralModel};
use survey::HeightField;

/// An interpretation as a solid model: sheets that are defined everywhere, and the region of every point.
///
/// [`StructuralModel`] implements it; so can models in closed form (see the example of the [crate]). With n
/// horizons (0 = youngest) there are n + 1 layers: horizon h is the bottom of layer n − h and the top of
/// layer n − 1 − h. Positions are voxels.
pub trait LayerModel: Sync {
    /// Counts of voxels `[inlines, crosslines, samples]`.
    fn size(&self) -> [usize; 3];
    /// The linear part of the map from voxels to metres.
    fn metric(&self) -> DMat3;
    /// Count of layers, at least 1.
    fn layer_count(&self) -> usize;
    /// Count of fault blocks, at least 1.
    fn block_count(&self) -> usize;
    /// The sheet of a horizon in a fault block. It continues past the outer boundary, past faults and across
    /// holes, and is not cut by other horizons.
    fn sheet(&self, horizon: usize, block: u16) -> &HeightField;
    /// The surface of a horizon in a fault block where it is no height field. Default: all are height fields.
    fn level(&self, _horizon: usize, _block: u16) -> Option<&LevelSurface> {
        None
    }
    /// Whether a horizon is the outline of a body that cuts through all others. Default: none is.
    fn is_body(&self, _horizon: usize) -> bool {
        false
    }
    /// The faults between the blocks. Default: none.
    fn faults(&self) -> Option<&FaultNetwork> {
        None
    }
    /// The region at a voxel position. Its layer is below [`LayerModel::layer_count`] and its block below
    /// [`LayerModel::block_count`].
    fn region_at(&self, p: Vec3) -> Region;
    /// The regions at all depths (voxel z) of the trace at (x, y): calls `found(n, region)` for each
    /// `depths[n]`, in order. The default asks [`LayerModel::region_at`] at each depth; a model that can
    /// share work along a trace overrides it.
    fn regions_down(&self, x: f32, y: f32, depths: &[f32], found: &mut dyn FnMut(usize, Region)) {
        for (n, &z) in depths.iter().enumerate() {
            found(n, self.region_at(Vec3::new(x, y, z)));
        }
    }
}

impl LayerModel for StructuralModel {
    fn size(&self) -> [usize; 3] {
        self.size()
    }

    fn metric(&self) -> DMat3 {
        self.metric()
    }

    fn layer_count(&self) -> usize {
        self.layer_count()
    }

    fn block_count(&self) -> usize {
        self.block_count()
    }

    fn sheet(&self, horizon: usize, block: u16) -> &HeightField {
        self.sheet(horizon, block)
    }

    fn level(&self, horizon: usize, block: u16) -> Option<&LevelSurface> {
        self.level(horizon, block)
    }

    fn is_body(&self, horizon: usize) -> bool {
        self.is_body(horizon)
    }

    fn faults(&self) -> Option<&FaultNetwork> {
        Some(self.faults())
    }

    fn region_at(&self, p: Vec3) -> Region {
        self.region_at(p)
    }

    fn regions_down(&self, x: f32, y: f32, depths: &[f32], found: &mut dyn FnMut(usize, Region)) {
        self.regions_down(x, y, depths, found);
    }
}
