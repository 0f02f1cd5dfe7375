//! `petroglyph view`: the whole work in one window (DESIGN 3.6).
//!
//! Three parts that know of one another in one direction only:
//!
//! - [`state`]: what is open, selected and looked at, as plain values. [`state::State::apply`] turns an [`state::Action`] into a new state
//!   and [`state::Task`]s for others. No window, no file, no thread.
//! - [`work`]: everything that takes time, on threads of its own, with progress and cancel; answers come back as
//!   [`work::Event`]s.
//! - [`views`]: a file for each panel. A panel draws the state and answers with actions; it changes nothing itself.
//!
//! What changes a project goes through [`project::Command`] and the project's history, as on the command line; pictures come from the
//! same [`project::picture::Painter`] as `petroglyph render`, so that window and file show the same.
//!
//! Deliberately absent: no state of a project lives here that is not on disk, and no drawing of rock.

pub mod error;
pub mod fields;
mod hint;
mod hold;
pub mod raster;
pub mod state;
pub mod theme;
pub mod views;
pub mod window;
pub mod work;

pub use error::WindowError;
pub use window::{Window, run};
