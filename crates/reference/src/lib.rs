//! What our methods are measured against.
//!
//! - [`growing`] is the published method of growing surfaces, a baseline that `petroglyph extract --method paper` still
//!   offers.
//! - [`evaluation`] measures surfaces and picks against the truth of a synthetic survey.
//!
//! Space: voxels, as in [`candidates`].
//!
//! Deliberately absent: anything that another library needs to do its work.

pub mod evaluation;
pub mod growing;

pub use evaluation::{EvaluateSettings, Evaluation, evaluate};
