//! A solid model of an interpretation: it answers which layer and which fault block any place in the volume
//! belongs to.
//!
//! [`StructuralModel`] holds one *extended* sheet for each horizon in each fault block (a
//! [`survey::HeightField`] that is defined everywhere) and a [`FaultNetwork`] whose surfaces divide the
//! volume into blocks. [`StructuralModel::region_at`] evaluates these surfaces directly and looks nothing up
//! in a voxel grid, so that its answer is exact at any zoom.
//!
//! # What happens where an interpretation ends
//!
//! - **The outer boundary of the volume.** Sheets continue linearly over a margin of nodes, with the slope of
//!   their last nodes. Beyond the margin they continue the border cell. Data that reaches into the margin is
//!   used.
//! - **A hole** is filled by a thin plate that matches the height and slope of the data at the rim of the
//!   hole. Data nodes are never changed.
//! - **The interpreted part of a fault.** The sheet of each side is continued beyond the fault independently
//!   of the other, so that a horizon may have two depths at one trace.
//! - **A fault's tip.** Beyond the tip the fault's surface is continued, because blocks need a boundary, but
//!   it is virtual: both sides are one surface there, also where there is no data, so the throw dies out
//!   towards the tip and nothing changes beyond it. The tip is the rim of the fault's mesh, or as far outside
//!   of it as the fault is said to grow ([`survey::Fault::grown_m`]). A rim that ends within half the spacing of
//!   the picks towards it, and within four voxels, of the volume's outer boundary reaches it; so does one within
//!   that spacing of the fault it is truncated by.
//! - **A truncated fault** exists only on one side of the fault it ends at. On the other side it divides
//!   nothing.
//! - **A pinch-out.** Conformable horizons may meet, and may cross by up to a tolerance (half a sample): the
//!   younger one ends at the older, and the layer between them has no thickness there. Picks that cross by
//!   more are an error. Continued parts that would cross are pulled together, and the report says so.
//! - **An unconformity** ([`ContactRules`]) cuts other horizons at the exact intersection of two uncut
//!   sheets. Older sheets continue above an erosion surface as if it were not there, so that the texture of
//!   the layers between them is cut off, not squeezed.
//! - **A block in which a horizon has no node, or hardly any.** The horizon is placed by its distance to its
//!   neighbours in another block, or by its share of the interval between them. In a block without any
//!   horizon it is placed as a surface through the nodes of all other blocks.
//! - **A node on the wrong side of a fault,** or closer to the fault than the setback, is left out.
//!
//! # Horizons of any shape
//!
//! A horizon whose surface is no height field ([`survey::Horizon::any_shape`]) is a [`LevelSurface`]: overturned limbs and
//! bodies of triangles, scattered points of a series. [`StructuralModel::sheet`] then is its topmost part, and
//! [`StructuralModel::level`] the surface.
//!
//! [`section`] cuts the model along any plane.
//!
//! Deliberately absent: files, pictures, flat space.
//!
//! # Spaces
//! Positions are voxel coordinates (x, y, z) with z down. Distances to faults are metric (m).

pub mod accuracy;
mod adjacency;
#[cfg(test)]
pub(crate) mod closed_form;
mod contacts;
mod extension;
mod lattice;
mod levels;
mod network;
mod nodes;
mod order;
mod report;
pub mod section;
mod settings;
mod sheets;
mod sides;
mod strays;
mod structural;
mod throws;
mod window;

pub use contacts::ContactRules;
pub use levels::{
    CutLattice, Equations, LevelSurface, NodeBox, bodies_overlap, check_surface, hole_m, is_closed, resampled,
    surface_through,
};
pub use network::{
    BlockSignature, FaultCrossing, FaultNetwork, FaultPart, FaultSurface, MOST_PARTS, Truncation, drawn_crossing,
    ends_of_parts, fit_of, split,
};
pub use report::{InferredPlacement, ModelError, ModelNote, ModelReport, SurfaceProblem};
pub use settings::ModelSettings;
pub use sheets::picked_share;
pub use sides::{Below, MOST_HORIZONS};
pub use structural::{Region, StructuralModel};
pub use throws::{CutOff, FaultSense, FaultThrows, HorizonThrows, Throw};

#[cfg(test)]
mod tests;
