//! Errors of this crate.

use survey::Cancelled;

/// Why a parameterization cannot be computed or packed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ParamError {
    /// The user cancelled. No result was kept.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The model covers no voxel.
    #[error("the model covers {size:?} voxels; a parameterization needs at least one along each axis")]
    Empty {
        /// `[inlines, crosslines, samples]`.
        size: [usize; 3],
    },
    /// The voxel-to-metre matrix cannot be inverted.
    #[error(
        "the voxel to metre matrix has determinant {determinant}; check the line vectors, the sample interval and the velocity"
    )]
    DegenerateMetric {
        /// Determinant of the matrix, m³ per voxel.
        determinant: f64,
    },
    /// A setting is out of its range.
    #[error("{setting} is {found}; it must be {expected}")]
    Setting {
        /// Name of the setting.
        setting: &'static str,
        /// Value of the setting.
        found: f64,
        /// Range of the setting.
        expected: &'static str,
    },
    /// k is defined for a layer that the model does not have.
    #[error("k is defined for layer {layer}, but the model has {layers} layers; remove that definition of k")]
    NoSuchLayer {
        /// Index of the layer, 0 = deepest.
        layer: usize,
        /// Count of layers of the model.
        layers: usize,
    },
    /// A parameterization from elsewhere is that of other layers.
    #[error(
        "{:.0} % of its samples lie in another layer than in the project, which has {layers}: it is of other horizons. \
         Layers are counted from the deepest, 0; add the horizons that it was computed from, or compute i, j, k here",
        100.0 * share
    )]
    OtherLayers {
        /// The share of its samples, 0 to 1.
        share: f64,
        /// Count of layers of the model.
        layers: usize,
    },
    /// A parameterization from elsewhere has no values in a layer.
    #[error(
        "it has no values in layer {layer} (0 = deepest) of one fault block; have it computed there too, or compute i, j, k here"
    )]
    NoValues {
        /// Index of the layer, 0 = deepest.
        layer: usize,
    },
    /// The requested volume has no samples.
    #[error("a voxel parameterization of {size:?} has no voxels; every side must be at least 1")]
    VolumeSize {
        /// The requested size, `[inlines, crosslines, samples]`.
        size: [usize; 3],
    },
    /// The stated memory is too small for a single file.
    #[error("{stated} bytes of memory are too few to sample i, j, k; state at least {}", size(*least))]
    TooLittleMemory {
        /// Bytes stated.
        stated: u64,
        /// Bytes needed.
        least: u64,
    },
}

/// Bytes as `--memory` takes them, rounded up.
fn size(bytes: u64) -> String {
    if bytes < 1 << 20 { format!("{}K", bytes.div_ceil(1 << 10)) } else { format!("{}M", bytes.div_ceil(1 << 20)) }
}
