//! Whole chains of commands, from a file to a picture, as the command line and the window offer them.
//!
//! | chain | from | to |
//! |---|---|---|
//! | [`demo`] | nothing | a synthetic survey, a project and pictures |
//! | [`illustrate`] | a SEG-Y file | a project and a block diagram that says that nobody interpreted it |
//! | [`stages`] | the geological history of a project | projects of the block after each of its events |
//!
//! A chain changes a project through the same commands as a user would.
//!
//! Deliberately absent: any step of its own that a command does not have.

pub mod demo;
pub mod illustrate;
pub mod stages;
