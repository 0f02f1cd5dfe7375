//! Petroglyph: from a 3D seismic survey and its interpretation to a geological illustration.
//!
//! This crate joins the others into a program. A [`Project`] is a folder on disk; every change to it is a [`Command`],
//! whoever asks for it (command line, window, script), so that each can be undone, also by another process later.
//! What is computed from a project is cached beside it, keyed by what it was computed from.

pub mod app;
pub mod bench;
pub mod candidates;
pub mod cli;
pub mod command;
pub mod data;
pub mod demo;
pub mod derived;
pub mod error;
pub mod extraction;
mod held;
pub mod horizon_distance;
pub mod library;
mod memory;
pub mod picture;
pub mod pipeline;
pub mod project;
pub mod proposals;
pub mod scene;
pub mod shown_candidates;
pub mod style;
pub mod synth;
pub mod volume_file;

pub use command::{Command, Effect};
pub use error::ProjectError;
pub use project::Project;
