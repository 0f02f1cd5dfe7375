//! Files of wells: deviation (with head and datum), tops, checkshots and logs become a
//! [`Well`](survey::Well).
//!
//! Lengths in feet are converted when they are read, with the international foot. What a file does not say is
//! stated by the user in [`WellOptions`], or assumed and reported.

mod checkshot;
mod collar;
mod columns;
mod describe;
mod deviation;
mod error;
mod las;
mod las_tops;
mod options;
mod read;
mod report;
mod rms;
mod table;
#[cfg(test)]
mod tests;
mod tops;

pub use checkshot::parse_checkshot;
pub use columns::WellColumn;
pub use describe::{WellColumnDescription, WellFileDescription, WellFileKind, describe};
pub use deviation::{Deviation, parse_deviation};
pub use error::WellFileError;
pub use las::{Las, LasItem, parse_las};
pub use options::WellOptions;
pub use read::{WellFiles, read_well};
pub use report::WellReport;
pub use rms::parse_rms;
pub use tops::{TopRow, parse_tops};
