//! Whole files: real ones, round trips, and everything that can be wrong.

mod broken;
mod built;
mod detection;
mod doubts;
mod expected;
mod headers;
mod numberless;
mod properties;
mod round_trip;
