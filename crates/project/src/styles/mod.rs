//! How a project's layers and volumes look: the patterns it can use, and colours of raw data that fit its
//! volumes.

mod library;
mod raw_colour;

pub use library::{layer_styles, pattern_library};
pub use raw_colour::{raw_colour, transfer_functions};
