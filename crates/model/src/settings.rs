//! The settings of a structural model.

use serde::{Deserialize, Serialize};

/// Settings of [`crate::StructuralModel::build`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ModelSettings {
    /// Nodes added on every side of the survey lattice, so that traces which leave the volume stay on defined
    /// sheets. `None` (default): the larger of 16 and 12 % of the longer side.
    pub margin: Option<usize>,
    /// Horizon nodes closer than this to the interpreted part of a fault are dropped (horizontal distance,
    /// voxels). So close to a fault, its own accuracy decides on which side a node lies, and a node on the
    /// wrong side would stand out as a spike. Use 2 or 3 for gridded horizons that are smeared across faults.
    /// This applies only to sheets whose block is not given. Default 0.5.
    pub fault_setback: f32,
    /// A horizon with fewer nodes than this in a block counts as absent there and is placed by its thickness
    /// in another block. Default 24.
    pub fewest_nodes: usize,
    /// Radius of the neighbourhood whose slope continues a sheet beyond its data, nodes. A larger radius is
    /// steadier under picking noise, a smaller one follows curvature better. Default 10.
    pub slope_radius: f32,
    /// Nodes picked on two conformable horizons may cross by this much before it is an error, samples.
    /// Default 0.5.
    pub crossing_tolerance: f32,
    /// Number of nodes that may cross by more than the tolerance before it is an error. Default 8.
    pub crossing_nodes: usize,
}

impl Default for ModelSettings {
    fn default() -> Self {
        Self {
            margin: None,
            fault_setback: 0.5,
            fewest_nodes: 24,
            slope_radius: 10.0,
            crossing_tolerance: 0.5,
            crossing_nodes: 8,
        }
    }
}

impl ModelSettings {
    /// The margin for a survey of `size` voxels, nodes.
    ///
    /// # Examples
    /// ```
    /// let settings = model::ModelSettings::default();
    /// assert_eq!(settings.margin_for([100, 200, 50]), 24);
    /// assert_eq!(settings.margin_for([20, 20, 50]), 16);
    /// ```
    pub fn margin_for(&self, size: [usize; 3]) -> usize {
        self.margin.unwrap_or_else(|| (size[0].max(size[1]) * 12).div_ceil(100).max(16))
    }
}
