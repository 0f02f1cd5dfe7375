//! A sheet of a horizon on the survey's lattice, in voxels: what assembly, holes and faults work on.

use survey::Quality;

/// A sheet on the survey's lattice.
#[derive(Debug, Clone, PartialEq)]
pub struct VoxelSheet {
    /// The fault block in which it lies.
    pub block: u16,
    /// Fractional sample of each trace `[inline][crossline]`; NaN in a hole.
    pub z: Vec<f32>,
    /// Quality of each node, in the same order.
    pub quality: Vec<Quality>,
}

impl VoxelSheet {
    /// A sheet without nodes.
    pub fn empty(block: u16, traces: usize) -> Self {
        Self { block, z: vec![f32::NAN; traces], quality: vec![Quality::Hole; traces] }
    }

    /// Count of nodes.
    pub fn nodes(&self) -> usize {
        self.z.iter().filter(|z| z.is_finite()).count()
    }
}
