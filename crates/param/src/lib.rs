//! Layer parameterization: the map from curved rock to flat space.
//!
//! Every point of a volume gets flat coordinates (i, j, k). k is 0 on the bottom of its layer and 1 on its
//! top. i and j say where the isocurve of the point, the curve along ∇k, crosses the middle of the layer. A
//! texture drawn in (i, j, k) follows the layers and breaks at the faults.
//!
//! The method is that of D. Patel, C. Giertsen, J. Thurmond and M. E. Gröller, "Illustrative rendering of
//! seismic data", Technical Report TR-186-2-07-08, TU Wien, 2007, section 3. It is cited as P-illus below.
//!
//! # How it is computed
//!
//! 1. [`Parameterization::compute`] asks the model ([`LayerModel`]) which columns and depths each region (a
//!    layer in a fault block) occupies, and makes a stratigraphic grid for each region ([`RegionGrid`]).
//! 2. In each region, the closest points of both bounding sheets are found on a coarse lattice (kd-tree, then
//!    Newton's method on the bicubic surface). All other closest points are followed from there. k = d_bottom
//!    / (d_bottom + d_top).
//! 3. From every node the isocurve is traced along ∇k to k = 0.5, which gives i and j. Sheets continue past
//!    the volume's outer boundary, past faults and across holes, so every trace stays where k is defined and
//!    nothing is clamped.
//! 4. [`Parameterization::lookup`] evaluates the grid. It is exact on the horizons at any zoom, because the
//!    region comes from the model and the fraction between the sheets from the sheets.
//!    [`Parameterization::voxel_volumes`] samples it at voxels; [`PackedVolume`] is the paper's 3-component
//!    volume with the paper's lookups.
//! 5. [`Parameterization::of_volumes`] takes i, j, k from elsewhere instead, [`Parameterization::of_known`] from what is
//!    known in closed form.
//! 6. [`accuracy`] measures both lookups.
//!
//! # Spaces and units
//! Positions are voxels (x = inline index, y = crossline index, z = sample index, down). Distances and angles
//! are measured in metres.
//!
//! # Degenerate places
//!
//! | place | answer |
//! |---|---|
//! | outer boundary, fault, hole | the extended sheets continue: i and j may leave \[0, 1\] |
//! | beyond a fault's tip | the blocks are those of the extended fault; flows take the mean of both where their sheets are one surface |
//! | pinch-out | k keeps its limit up to the edge; beyond it the layer does not exist, and its grid holds the values of neighbours or 0 |
//! | open layer (one horizon) | k is parallel to its horizon; i, j are those of the closest point on it |
//! | no horizon at all | k is the vertical fraction of the volume |
//! | layer under an unconformity | the sheets are those before erosion; the model cuts them, and [`KDefinition::for_contacts`] keeps beds parallel to the base |
//! | intrusion | [`KDefinition::for_contacts`] measures k from its outline |
//! | crease (the closest point jumps) | k is continuous, its gradient is not; traces cross or follow the crease, and nodes are flagged |
//!
//! # Example
//! A model is anything that implements [`LayerModel`]. Between two flat horizons k is the vertical fraction:
//!
//! ```
//! use glam::{DMat3, Vec3};
//! use param::{LayerModel, ParamSettings, Parameterization, Region};
//! use survey::{HeightField, Progress};
//!
//! /// Horizons at z = 4 and z = 12 in a volume of 8 × 8 × 16 voxels of 1 m.
//! struct Flat([HeightField; 2]);
//!
//! impl LayerModel for Flat {
//!     fn size(&self) -> [usize; 3] {
//!         [8, 8, 16]
//!     }
//!     fn metric(&self) -> DMat3 {
//!         DMat3::IDENTITY
//!     }
//!     fn layer_count(&self) -> usize {
//!         3
//!     }
//!     fn block_count(&self) -> usize {
//!         1
//!     }
//!     fn sheet(&self, horizon: usize, _block: u16) -> &HeightField {
//!         &self.0[horizon]
//!     }
//!     fn region_at(&self, p: Vec3) -> Region {
//!         Region { layer: u16::from(p.z < 4.0) + u16::from(p.z < 12.0), block: 0 }
//!     }
//! }
//!
//! // Nodes of the sheets reach 4 voxels past the volume.
//! let model = Flat([4.0, 12.0].map(|z| HeightField::from_fn([-4, -4], [16, 16], |_, _| z)));
//! let param = Parameterization::compute(&model, &ParamSettings::default(), &Progress::silent())?;
//! let flat = param.lookup(&model, Vec3::new(3.5, 7.0, 6.0));
//! assert_eq!(flat.region, Region { layer: 1, block: 0 });
//! assert!((flat.k - 0.75).abs() < 1e-5);
//! assert!((flat.i - 0.5).abs() < 1e-5 && (flat.j - 1.0).abs() < 1e-5);
//! # Ok::<(), param::ParamError>(())
//! ```

pub mod accuracy;
mod closest;
mod columns;
mod compute;
mod error;
mod flow;
mod foreign;
mod grid;
mod known;
mod lattice;
mod layer;
mod metric;
mod model;
mod nearest;
mod packed_volume;
mod parameterization;
mod plan;
mod retrace;
mod settings;
mod surface;
mod tips;
mod trace;
mod transport;
mod tricubic;
mod unfold;
mod voxels;
mod weight;

pub use compute::ComputeCost;
pub use error::ParamError;
pub use foreign::Taken;
pub use grid::{FlatPoint, RegionGrid, SheetRef, SheetSource};
pub use known::KnownPlaces;
pub use model::{LayerModel, Region};
pub use packed_volume::PackedVolume;
pub use parameterization::Parameterization;
pub use settings::{KDefinition, ParamSettings};
pub use unfold::{Unfolded, Unfolding};
pub use voxels::{NO_REGION, VoxelParameterization, corner_aligned};
