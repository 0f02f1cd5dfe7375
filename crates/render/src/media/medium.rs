//! A volume with its transfer function, prepared for a scene. Voxel space; extinction per unit of length,
//! linear colours.

use super::bricks::{LayerAppearance, MIXED};
use super::preparation::Prepared;
use super::samples::VolumeSamples;
use super::table::FunctionTable;
use crate::inputs::NamedVolume;
use glam::Vec3;
use std::sync::Arc;

/// A part of the roaming box.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Zone {
    /// The roaming box outside the cut-outs.
    Surroundings,
    /// The cut-outs.
    CutOut,
}

/// A volume with its transfer function.
pub struct FieldMedium<'a> {
    /// The volume.
    pub volume: NamedVolume<'a>,
    prepared: Arc<Prepared>,
    /// The tabulated transfer function.
    pub table: FunctionTable,
    /// The zone in which it is visible.
    pub zone: Zone,
    /// How layers change it. Absent if they do not.
    pub layers: Option<LayerAppearance>,
    scale: Vec3,
    offset: Vec3,
}

impl<'a> FieldMedium<'a> {
    /// A prepared volume.
    pub fn new(volume: NamedVolume<'a>, prepared: Arc<Prepared>, table: FunctionTable, zone: Zone) -> Self {
        let (scale, offset) = volume.index_from_voxel();
        Self { volume, prepared, table, zone, layers: None, scale, offset }
    }

    /// Value at a voxel position, interpolated trilinearly; below `NO_DATA_BELOW` if there
    /// is none.
    #[inline(always)]
    pub fn sample(&self, p: Vec3) -> f32 {
        self.samples().value(p * self.scale + self.offset)
    }

    /// Gradient per voxel of the survey, by central differences over one sample on either side; 0 along an
    /// axis if a neighbour is missing.
    #[inline]
    pub fn gradient(&self, p: Vec3) -> Vec3 {
        self.samples().differences(p * self.scale + self.offset) * 0.5 * self.scale
    }

    /// Scale and offset from voxel positions to sample indices.
    pub(super) fn index_from_voxel(&self) -> (Vec3, Vec3) {
        (self.scale, self.offset)
    }

    /// The samples.
    #[inline(always)]
    pub(super) fn samples(&self) -> VolumeSamples<'_> {
        VolumeSamples::new(self.prepared.samples(&self.volume), self.volume.volume.size())
    }

    /// Smallest and largest sample between two voxel positions; `None` if there is none.
    pub fn range(&self, low: Vec3, high: Vec3) -> Option<[f32; 2]> {
        self.prepared.range(&self.volume, low, high)
    }

    /// Whether the medium may be visible in a brick.
    pub(super) fn shows(&self, low: Vec3, high: Vec3, layer: u8) -> bool {
        let Some([a, b]) = self.prepared.range(&self.volume, low, high) else { return false };
        let lets_through = match &self.layers {
            None => true,
            Some(appearance) if layer == MIXED => appearance.entries.iter().any(|entry| entry[3] > 0.0),
            Some(appearance) => appearance.entries.get(usize::from(layer)).is_some_and(|entry| entry[3] > 0.0),
        };
        lets_through && self.table.shows(a, b)
    }
}
