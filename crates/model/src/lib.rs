//! The interpretation made solid: which layer and which fault block is at any place of the volume.
//!
//! [`StructuralModel`] holds, for each horizon and fault block, an *extended* sheet (a [`survey::HeightField`] defined everywhere), and a
//! [`FaultNetwork`] whose surfaces cut the volume into blocks. From them [`StructuralModel::region_at`] is exact at any zoom: nothing
//! is looked up in a voxel grid.
//!
//! # What happens where an interpretation ends
//!
//! - **A wall of the volume.** Sheets go on linearly for a margin of nodes, with the slope of their last nodes; beyond the margin they
//!   continue the border cell. Data that reaches into the margin is used.
//! - **A hole** is filled by a thin plate that takes up height and slope at its rim. Data nodes are never changed.
//! - **A fault, real part.** Each side is continued under the other by itself: the two sheets of a horizon do not know of one another, and two
//!   depths at one trace are normal.
//! - **A fault's tip.** Beyond the tip the fault's surface is continued, because blocks need a boundary, but it is virtual: nodes of one side are data
//!   for the other, both sheets are the same surface there, and nothing is drawn. The tip is the rim of the fault's mesh; a rim that ends
//!   within a tolerance of a wall, or of the fault it is truncated by, reaches it.
//! - **A truncated fault** exists on one side of the fault it ends at; behind that one it divides nothing.
//! - **A pinch-out.** Conformable horizons may meet, and cross within a tolerance (half a sample); the younger ends at the older, the layer between them has no
//!   thickness there. Picks that cross by more are an error; continued parts that would cross are pulled together, and the report says so.
//! - **An unconformity** ([`ContactRules`]) cuts what it cuts at the exact intersection of two uncut sheets: older sheets go on above an erosion
//!   surface as if nothing had happened, so that what is textured between them is cut off and not squeezed.
//! - **A block in which a horizon has no, or hardly any, node:** it is placed there by the thickness it has in another block (or by its share of the interval
//!   between its neighbours), and where the block has no horizon at all, as a surface through all other blocks' nodes.
//! - **A node on the wrong side of a fault,** or closer to it than the setback, is left out.
//!
//! [`section`] cuts the model on any plane.
//!
//! Deliberately absent: files, pictures, flat space.
//!
//! # Spaces
//! Positions are voxel (x, y, z), z down. Distances to faults are metric (m).

#[cfg(test)]
pub(crate) mod closed_form;
mod contacts;
mod extension;
mod lattice;
mod network;
mod nodes;
mod order;
mod report;
pub mod section;
mod settings;
mod sheets;
mod strays;
mod structural;

pub use contacts::ContactRules;
pub use network::{BlockSignature, FaultNetwork, FaultSurface, Truncation};
pub use report::{ModelError, ModelNote, ModelReport, Placement};
pub use settings::ModelSettings;
pub use structural::{Region, StructuralModel};

#[cfg(test)]
mod tests;
