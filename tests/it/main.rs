//! Drives the real program in temporary folders: what a user types, what comes out, what is left on disk.

mod animation;
mod app;
mod assembly;
mod bad_input;
mod batch;
mod bombs;
mod bricks;
mod chain;
mod check;
#[cfg(unix)]
mod command_lines;
mod correlation;
mod create;
mod cuts;
mod demo;
mod drawing;
mod extraction;
mod fault_edits;
mod fault_extent;
mod figure;
mod foreign;
mod help;
mod history;
mod hostile;
mod imported_parameterization;
mod kill;
mod legibility;
#[cfg(target_os = "linux")]
mod memory;
mod names;
mod program;
mod proposed_faults;
#[cfg(feature = "remote")]
mod remote;
mod restore;
mod review;
mod safety;
mod shapes;
#[cfg(target_os = "linux")]
mod sources;
#[cfg(target_os = "linux")]
mod steps;
mod store;
mod throws;
mod time;
mod time_unknown;
mod time_uses;
mod unpicked;
mod volume_rendering;
mod well;
