//! What the user may choose when a structural model is built.

use serde::{Deserialize, Serialize};

/// Settings of [`crate::StructuralModel::build`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ModelSettings {
    /// Nodes added on every side of the survey lattice, so that traces which leave the volume stay on defined sheets.
    /// `None` (default): the larger of 16 and 12 % of the longer side.
    pub margin: Option<usize>,
    /// Horizon nodes nearer than this to a real fault are dropped (horizontal distance, voxels): so close, the fault's own
    /// accuracy decides on which side a node lies, and a node on the wrong side would stand out as a spike. Gridded horizons that smear
    /// across faults want 2 or 3. Only sheets whose block is not given are treated. Default 0.5.
    pub fault_setback: f32,
    /// With fewer nodes than this in a block a horizon counts as absent there, and is placed by its thickness elsewhere. Default 24.
    pub fewest_nodes: usize,
    /// Radius of the neighbourhood whose slope continues a sheet beyond its data, nodes. Larger is steadier under picking
    /// noise, smaller follows curvature better. Default 10.
    pub slope_radius: f32,
    /// A fault whose rim ends nearer than this to a wall of the volume, or to the fault it is truncated by, reaches it, m.
    /// `None` (default): the fault's median triangle edge, about one stick spacing.
    pub rim_tolerance_m: Option<f64>,
    /// Nodes picked on two conformable horizons may cross by this much before it is an error, samples. Default 0.5.
    pub crossing_tolerance: f32,
    /// So many nodes may cross by more than the tolerance before it is an error. Default 8.
    pub crossing_nodes: usize,
}

impl Default for ModelSettings {
    fn default() -> Self {
        Self {
            margin: None,
            fault_setback: 0.5,
            fewest_nodes: 24,
            slope_radius: 10.0,
            rim_tolerance_m: None,
            crossing_tolerance: 0.5,
            crossing_nodes: 8,
        }
    }
}

impl ModelSettings {
    /// The margin for a survey of `size` voxels, nodes.
    pub fn margin_for(&self, size: [usize; 3]) -> usize {
        self.margin.unwrap_or_else(|| (size[0].max(size[1]) * 12).div_ceil(100).max(16))
    }
}
