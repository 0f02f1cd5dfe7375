//! Why a parameterization cannot be computed.

use survey::Cancelled;

/// Why a parameterization cannot be computed or packed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ParamError {
    /// The user cancelled; nothing was kept.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The model covers no voxel.
    #[error("the model covers {size:?} voxels; a parameterization needs at least one along each axis")]
    Empty {
        /// `[inlines, crosslines, samples]`.
        size: [usize; 3],
    },
    /// The voxel → metre matrix cannot be inverted.
    #[error(
        "the voxel to metre matrix has determinant {determinant}; check the line vectors, the sample interval and the velocity"
    )]
    DegenerateMetric {
        /// Its determinant, m³ per voxel.
        determinant: f64,
    },
    /// A setting is outside what it can be.
    #[error("{setting} is {found}; it must be {expected}")]
    Setting {
        /// Name of the setting.
        setting: &'static str,
        /// Its value.
        found: f64,
        /// What it can be.
        expected: &'static str,
    },
    /// A definition of k was given for a layer that the model does not have.
    #[error("k is defined for layer {layer}, but the model has {layers} layers; remove the definition")]
    NoSuchLayer {
        /// The layer named.
        layer: usize,
        /// Count of layers.
        layers: usize,
    },
    /// A volume of this size was asked for.
    #[error("a voxel parameterization of {size:?} has no voxels; every side must be at least 1")]
    VolumeSize {
        /// The size asked for.
        size: [usize; 3],
    },
}
