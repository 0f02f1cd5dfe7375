//! Faults as surfaces that reach through the whole volume, and the blocks they cut it into.

use crate::height_field::HeightField;
use glam::{DMat3, DVec3, Vec3};

/// One fault as a height field w = g(u, v) over its best-fit plane, continued through the whole volume.
///
/// `frame_from_voxel · p + frame_offset` is (u, v, w) of voxel position p: u and v in cells of the grid, w in metres along the
/// plane's normal.
#[derive(Debug, Clone, PartialEq)]
pub struct FaultSurface {
    /// Name of the fault.
    pub name: String,
    /// Linear part of voxel → (u cells, v cells, w m).
    pub frame_from_voxel: DMat3,
    /// Constant part of voxel → (u cells, v cells, w m).
    pub frame_offset: DVec3,
    /// Metres between grid nodes.
    pub spacing_m: f64,
    /// g at the grid nodes, m.
    pub surface: HeightField,
    /// Signed distance to the rim of the interpreted extent at the same nodes, m; positive inside (real), negative beyond the tip.
    pub extent: HeightField,
}

/// The sides of the faults a block lies on: it holds every place whose side bits agree with `bits` where `care` is set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BlockSignature {
    /// Bit f set: on the positive side of fault f.
    pub bits: u64,
    /// Bit f set: fault f exists there, so that its bit matters.
    pub care: u64,
}

/// All faults of a model and the blocks between them.
#[derive(Debug, Clone, PartialEq)]
pub struct FaultNetwork {
    surfaces: Vec<FaultSurface>,
    signatures: Vec<BlockSignature>,
}

impl FaultNetwork {
    /// No faults: one block.
    pub fn none() -> Self {
        Self { surfaces: Vec::new(), signatures: vec![BlockSignature { bits: 0, care: 0 }] }
    }

    /// Count of blocks.
    pub fn block_count(&self) -> usize {
        self.signatures.len()
    }

    /// The fault surfaces, in the order the faults were given.
    pub fn surfaces(&self) -> &[FaultSurface] {
        &self.surfaces
    }

    /// The signature of each block; index = block id.
    pub fn signatures(&self) -> &[BlockSignature] {
        &self.signatures
    }

    /// Signed metric offset of voxel position `p` from the extended surface of `fault`, along the normal of its plane, m.
    pub fn side(&self, fault: usize, p: Vec3) -> f32 {
        self.surfaces[fault].side(p.as_dvec3()) as f32
    }

    /// Whether the point of `fault` nearest to voxel position `p` (along the normal of its plane) was interpreted, and is drawn.
    pub fn is_real(&self, fault: usize, p: Vec3) -> bool {
        self.surfaces[fault].extent_at(p.as_dvec3()) >= 0.0
    }

    /// The block that voxel position `p` lies in.
    pub fn block_at(&self, p: Vec3) -> u16 {
        let bits = (0..self.surfaces.len()).map(|f| u64::from(self.side(f, p) >= 0.0) << f).sum();
        self.block_of(bits)
    }

    /// The block of a set of side bits; of an unknown set, the first block with the fewest differing bits.
    pub fn block_of(&self, bits: u64) -> u16 {
        let difference = |s: &BlockSignature| ((s.bits ^ bits) & s.care).count_ones();
        (0..self.signatures.len()).min_by_key(|&b| difference(&self.signatures[b])).unwrap_or(0) as u16
    }
}

impl FaultSurface {
    /// (u cells, v cells, w m) of a voxel position.
    pub fn frame(&self, p: DVec3) -> DVec3 {
        self.frame_from_voxel * p + self.frame_offset
    }

    /// Signed offset from the extended surface, m.
    pub fn side(&self, p: DVec3) -> f64 {
        let q = self.frame(p);
        q.z - f64::from(self.surface.z_at(q.x as f32, q.y as f32))
    }

    /// Signed distance to the rim of the interpreted extent, m, positive inside.
    pub fn extent_at(&self, p: DVec3) -> f64 {
        let q = self.frame(p);
        f64::from(self.extent.z_at(q.x as f32, q.y as f32))
    }
}
