//! `petroglyph view`: the whole workflow in one window.
//!
//! Three parts, the first of them a crate of its own. The state knows of no other, the workers know the state, and the
//! panels know both:
//!
//! - [`state`]: what is open, selected and displayed, as plain values. [`state::State::apply`] turns an
//!   [`state::Action`] into a new state and a list of [`state::Task`]s for the workers. No window, no file, no thread.
//! - [`work`]: everything that takes time, on threads of its own, with progress and cancellation; results come back as
//!   [`work::Event`]s.
//! - [`views`]: one file or folder for each panel. A panel draws the state and returns actions; it changes nothing
//!   itself.
//!
//! Every change to a project goes through [`project::Command`] and the project's history, as on the command line.
//! Pictures come from the same [`project::pictures::Painter`] as those of `petroglyph render`, so the window and the
//! file show the same.
//!
//! Deliberately absent: project state that is not on disk, and any drawing of rock.

pub mod error;
mod hold;
pub mod views;
pub mod widgets;
pub mod window;
pub mod work;

pub use ::state;
pub use error::WindowError;
pub use window::{Window, run};
