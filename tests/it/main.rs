//! Drives the real program in temporary folders: what a user types, what comes out, what is left on disk.

mod app;
mod assembly;
mod bad_input;
mod bombs;
mod chain;
mod create;
mod demo;
mod extraction;
mod figure;
mod help;
mod hostile;
mod kill;
mod program;
mod proposed_faults;
mod safety;
mod see_through;
mod store;
mod well;
