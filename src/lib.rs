//! The commands of the program as functions: for the program itself, and for whoever carries them out from elsewhere
//! (the Python package), with the same words, the same answers and the same sentences about what went wrong.

mod bench;
mod cli;

pub use cli::{CommandWords, OptionWords, Refusal, answer, commands, explain, main};
