//! The lattice that a model is built on, and an interpreted node on it.

use glam::Vec3;
use survey::horizon::Quality;

/// The survey lattice and its margin: node n is voxel (origin + (n / size[1], n % size[1])).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct MarginLattice {
    pub origin: [i32; 2],
    pub size: [usize; 2],
}

impl MarginLattice {
    pub(crate) fn with_margin(size: [usize; 3], margin: usize) -> Self {
        Self { origin: [-(margin as i32); 2], size: [size[0] + 2 * margin, size[1] + 2 * margin] }
    }

    pub(crate) fn len(&self) -> usize {
        self.size[0] * self.size[1]
    }

    /// Voxel (x, y) of node `n`.
    pub(crate) fn voxel(&self, n: usize) -> [i32; 2] {
        [self.origin[0] + (n / self.size[1]) as i32, self.origin[1] + (n % self.size[1]) as i32]
    }

    /// Whether node `n` lies over the volume rather than in the margin.
    pub(crate) fn is_inside(&self, n: usize) -> bool {
        self.voxel(n).iter().zip(self.size).zip(self.origin).all(|((&c, n), o)| c >= 0 && c < n as i32 + 2 * o)
    }

    /// Position at height `z` over node `n`.
    pub(crate) fn place(&self, n: usize, z: f32) -> Vec3 {
        let [x, y] = self.voxel(n);
        Vec3::new(x as f32, y as f32, z)
    }
}

/// One interpreted node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct InterpretedNode {
    /// Lattice node.
    pub at: u32,
    /// Height, voxel z.
    pub z: f32,
    pub quality: Quality,
    pub block: u16,
    /// On which side of every fault it lies.
    pub bits: u64,
    /// Faults that are virtual beside it: it lies beyond their tip.
    pub beyond: u64,
    /// Whether it lies so close to the interpreted part of a fault that it may have been picked for the other
    /// side.
    pub doubtful: bool,
}
