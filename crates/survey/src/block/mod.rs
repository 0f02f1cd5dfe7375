//! A block of rock: a box of the volume, and what is cut out of it, as convex bodies of planes. Voxel space.

pub mod body;
pub(crate) mod cut_shape;
mod polygon;
pub mod voxel_box;

pub use body::{Body, BodyPlane, Crossing, Ray, Wall, part_behind};
pub use cut_shape::{CutShape, CutShapeError, Leaves, MAX_BODIES, MAX_PLANES, Side};
pub use polygon::convex_parts;
pub use voxel_box::{Corner, VoxelBox};
