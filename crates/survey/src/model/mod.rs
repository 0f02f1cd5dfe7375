//! The interpretation made solid: which layer and which fault block is at any place of the volume.
//!
//! [`StructuralModel`] holds, for each horizon and fault block, an *extended* sheet (a [`crate::HeightField`] defined everywhere), and a
//! [`FaultNetwork`] whose surfaces cut the volume into blocks. From them [`StructuralModel::region_at`] is exact at any zoom: nothing
//! is looked up in a voxel grid.
//!
//! # Spaces
//! Positions are voxel (x, y, z), z down. Distances to faults are metric (m).

#[cfg(test)]
pub(crate) mod closed_form;
mod contacts;
mod extension;
mod network;
mod nodes;
mod order;
mod report;
mod settings;
mod sheets;
mod structural;

pub use contacts::ContactRules;
pub use network::{BlockSignature, FaultNetwork, FaultSurface, Truncation};
pub use report::{ModelError, ModelNote, ModelReport, Placement};
pub use settings::ModelSettings;
pub use structural::{Region, StructuralModel};

#[cfg(test)]
mod tests;
