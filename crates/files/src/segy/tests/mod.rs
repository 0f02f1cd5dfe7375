//! Whole files: real ones, round trips, and everything that can be wrong.

mod broken;
mod builder;
mod cases;
mod detection;
mod doubts;
mod headers;
mod numberless;
mod properties;
mod reference_reader;
mod round_trip;
mod two_d;
