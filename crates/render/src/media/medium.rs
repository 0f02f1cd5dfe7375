//! A volume with its function, made ready to be asked at any point.
//!
//! Voxel space.

use super::bricks::{LayerLooks, MIXED};
use super::prepared::Prepared;
use super::samples::Samples;
use super::table::Table;
use crate::inputs::NamedVolume;
use glam::Vec3;
use std::sync::Arc;

/// Half of the border over which a horizon fades, voxels.
pub const SOFT: f32 = 0.25;

/// Where a medium fills space.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// The roaming box outside the cut-outs.
    Surroundings,
    /// The cut-outs.
    CutOut,
}

/// A volume with its function.
pub struct FieldMedium<'a> {
    /// The volume.
    pub volume: NamedVolume<'a>,
    prepared: Arc<Prepared>,
    /// Its baked function.
    pub table: Table,
    /// Where it shows.
    pub place: Place,
    /// What layers do to it; absent where they do nothing.
    pub layers: Option<LayerLooks>,
    scale: Vec3,
    offset: Vec3,
}

impl<'a> FieldMedium<'a> {
    /// A volume made ready.
    pub fn new(volume: NamedVolume<'a>, prepared: Arc<Prepared>, table: Table, place: Place) -> Self {
        let (scale, offset) = volume.index_from_voxel();
        Self { volume, prepared, table, place, layers: None, scale, offset }
    }

    /// Trilinear value at a voxel position; below [`NO_DATA_BELOW`](super::table::NO_DATA_BELOW) where there is none.
    #[inline(always)]
    pub fn sample(&self, p: Vec3) -> f32 {
        self.samples().value(p * self.scale + self.offset)
    }

    /// Central differences over one sample to either side, per voxel of the survey; zero where a neighbour is missing.
    #[inline]
    pub fn gradient(&self, p: Vec3) -> Vec3 {
        self.samples().differences(p * self.scale + self.offset) * 0.5 * self.scale
    }

    /// Scale and offset from voxel positions to sample numbers.
    pub(super) fn index_from_voxel(&self) -> (Vec3, Vec3) {
        (self.scale, self.offset)
    }

    /// Its samples.
    #[inline(always)]
    pub(super) fn samples(&self) -> Samples<'_> {
        Samples::new(self.prepared.samples(&self.volume), self.volume.volume.size())
    }

    /// Smallest and largest sample between two voxel positions; `None` where there is none.
    pub fn range(&self, low: Vec3, high: Vec3) -> Option<[f32; 2]> {
        self.prepared.range(&self.volume, low, high)
    }

    /// Whether a brick can show it.
    pub(super) fn shows(&self, low: Vec3, high: Vec3, layer: u8) -> bool {
        let Some([a, b]) = self.prepared.range(&self.volume, low, high) else { return false };
        let lets_through = match &self.layers {
            None => true,
            Some(looks) if layer == MIXED => looks.entries.iter().any(|entry| entry[3] > 0.0),
            Some(looks) => looks.entries.get(usize::from(layer)).is_some_and(|entry| entry[3] > 0.0),
        };
        lets_through && self.table.shows(a, b)
    }
}
