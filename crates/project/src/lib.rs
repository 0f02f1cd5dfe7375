//! A project: what was imported and interpreted, how it is drawn, and the commands that change it.
//!
//! The command line, the window and scripts share this crate. A [`Project`] is a folder on disk; every change to it is
//! a [`Command`], which can be undone, even by another process later. Results that are computed from a project are
//! stored beside it under a key, which is a hash of their input.
//!
//! The modules build on one another in this order:
//!
//! | module | holds |
//! |---|---|
//! | [`error`], `placement` | what can go wrong; where a volume of another size lies |
//! | [`document`] | the state: what `project.toml` says |
//! | [`folder`] | how a state, its history and its data lie on disk, and the one place that deletes |
//! | [`content`], [`styles`] | volumes, horizons, faults, wells and patterns read by the names of a project |
//! | [`facts`] | what follows from a state, asked for in one way: found in memory, on disk, or computed |
//! | [`derived`] | what was computed, kept by key |
//! | [`interpretation`] | from a volume to candidates, from picks to a horizon, from horizons to proposed faults |
//! | [`check`] | a project verified and repaired |
//! | [`command`] | every change, as data |
//! | [`Project`] | applies commands; undo and redo |
//!
//! Deliberately absent: the words of a command line or a window. An error says what is wrong; what helps is said here
//! only where it is the same everywhere. The names of options and fields are known only to the program that shows the
//! error.

pub mod chains;
pub mod check;
pub mod command;
pub mod content;
pub mod derived;
pub mod document;
pub mod error;
pub mod exports;
pub mod facts;
#[cfg(test)]
mod fixture;
pub mod folder;
pub mod interpretation;
pub mod memory_budget;
pub mod pictures;
mod placement;
mod project;
pub mod styles;

pub use command::{Command, Effect};
pub use error::ProjectError;
pub use facts::{Facts, Query};
pub use project::{HistoryLine, NewProject, Project};
