//! Geologic time for every voxel: τ(x, y, z) from horizon candidates, their dips and faults.
//!
//! Candidates are patches of reflections that were followed from trace to trace. Within a patch time is constant, and
//! between patches the layering runs along their dips. So τ = z + s, and s is the minimum of
//!
//! ```text
//! Σ w [s(x+1, z+p/2) − s(x, z−p/2) + p]²     links of neighbouring traces along the dip p, in both directions
//!   + Σ W [τ(v) − c_k]²                      vertices v of patch k (a hub), which all have the time c_k
//!   + e₁ (∂z s)² + e₂ (∂zz s)²               little, where nothing else decides
//! ```
//!
//! without links across faults. Each fault's throw is found by comparing both of its sides; then what matches is linked
//! across it, and patches of the same event become one hub. At the end τ is made monotone on every trace, which is
//! isotonic regression.
//!
//! τ is measured in samples. It has no zero of its own: only its level surfaces (isochrons) mean something.
//!
//! | step | where |
//! |---|---|
//! | what the user interpreted | [`Interpretation`] |
//! | faults as cuts, drawn or found in the volume | [`Cut`] |
//! | patches cut at faults: hubs | `hubs` |
//! | links and dips | `links` |
//! | where it starts | `start` |
//! | the minimum | `solve` |
//! | monotone traces, and what is not known | [`isotonic`], `known`, `coherence` |
//! | throws, then what matches across faults | `throws`, `logs`, `matches` |
//! | patches of one event become one | `merge` |
//! | one level of τ, and the event that it is with the reflections along it | [`isochron()`], [`Reflections`] |
//! | the pieces of an event, and what is only assumed | `pieces`, [`Event::examine`] |
//! | beds laid flat, and where beds are missing | [`flattened`], [`rates`] |
//! | slabs of a survey that does not fit into memory | [`Slabs`], [`JoinedSlabs`] |
//! | levels that stand out | [`strongest_levels`], [`characters`] |
//! | what no level draws: a flat spot, a build-up | [`Reflections::bodies`] |
//!
//! Space: voxels, x = inline index, y = crossline index, z = sample index, z down.
//!
//! Deliberately absent: files, projects, pictures, and the growing of candidates.

mod bodies;
mod bridges;
mod claims;
mod coherence;
mod compute;
mod cuts;
mod error;
mod event;
mod finish;
mod flatten;
mod hubs;
mod interpretation;
mod isochron;
pub mod isotonic;
mod levels;
mod links;
mod logs;
mod matches;
mod merge;
mod pieces;
mod rate;
mod reflections;
mod slabs;
mod solve;
mod start;
mod stencil;
mod throws;
mod vectors;

#[cfg(test)]
mod tests;

pub use bodies::{Body, Column};
pub use bridges::bridge;
pub use compute::{GeologicTime, TimeSettings, geologic_time};
pub use cuts::{Across, Cut};
pub use error::TimeError;
pub use event::{Event, Node, Seed, Support};
pub use flatten::flattened;
pub use interpretation::{Interpretation, Jump, KnownHorizon, Place};
pub use isochron::{Crossing, Isochron, isochron};
pub use levels::{Character, Level, characters, strongest_levels};
pub use pieces::Doubt;
pub use rate::rates;
pub use reflections::{Reflection, Reflections};
pub use slabs::{JoinedSlabs, Slabs, surfaces_within};
pub use throws::Throw;
