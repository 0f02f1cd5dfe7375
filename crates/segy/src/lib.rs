//! SEG-Y, in and out, for post-stack 3D volumes: revisions 0 to 2, both byte orders.
//!
//! The standard (SEG Technical Standards Committee, SEG-Y rev 0 1975, rev 1 2002, rev 2.0 2017) leaves much open and
//! writers leave more, so everything is *found with evidence*: [`SegyInfo`] says what was read, where, why, what had to
//! be assumed, and what does not fit together. [`SegyOptions`] states what the file does not say. What is not a
//! post-stack volume is refused by a [`SegyProblem`] that says what it is.
//!
//! Traces and samples are read here; horizons, faults and wells by the crate `formats`. The two share nothing but the
//! nouns of [`survey`] and what can be stated about a file ([`survey::remedy`]), so they are two crates. A volume that
//! does not fit into memory is handed over block by block ([`SegyFile::blocks`], a [`survey::source::BlockSource`]).
//!
//! Deliberately absent: the store, projects, pre-stack data and single lines.
//!
//! Our own reader, since the crates at hand read neither little-endian files nor several of the formats, and leave
//! detection to the caller.
//!
//! # Units
//! [`SegyInfo`] speaks in the file's units (ms, m or ft); [`SurveyGeometry`](survey::SurveyGeometry) is in ms or m.
//!
//! ```
//! use segy::{SegyOptions, WriteOptions};
//! use survey::{Progress, SurveyGeometry, VerticalUnit, Volume};
//!
//! let path = std::env::temp_dir().join(format!("petroglyph-doc-{}.sgy", std::process::id()));
//! let geometry = SurveyGeometry::regular([3, 4, 5], 25.0, 4.0, VerticalUnit::Milliseconds);
//! let volume = Volume::filled([3, 4, 5], 1.5_f32);
//! segy::write(&path, &geometry, &volume, &WriteOptions::default(), &Progress::silent())?;
//! let back = segy::read(&path, &SegyOptions::default(), &Progress::silent())?;
//! assert_eq!(back.geometry.crosslines, geometry.crosslines);
//! assert_eq!(back.volume, volume);
//! # std::fs::remove_file(path).unwrap();
//! # Ok::<(), segy::SegyError>(())
//! ```

mod bins;
mod block;
mod candidate;
mod columns;
mod coordinates;
mod detect;
mod error;
mod file;
mod frame;
mod header;
mod info;
mod lines;
mod map;
mod neighbours;
mod number_type;
mod options;
mod page;
mod place;
mod read;
mod refuse;
mod sample;
mod statistics;
mod text;
mod vertical;
mod write;

#[cfg(test)]
mod tests;

use std::path::Path;

pub use block::SegyBlocks;
pub use candidate::{Candidate, LineSummary, Verdict};
pub use error::{SegyError, SegyProblem};
pub use file::SegyFile;
pub use info::{BytePositions, Corner, FileUnit, GeometrySummary, LengthUnit, SegyInfo};
pub use number_type::NumberType;
pub use options::{KeptDuplicate, LineSource, SegyOptions, TraceWeight};
pub use read::{Amplitudes, SegyVolume};
pub use sample::{ByteOrder, SampleFormat, f32_from_ibm, ibm_from_f32};
pub use statistics::{Histogram, Statistics};
pub use text::TextEncoding;
pub use write::{WriteFormat, WriteOptions, WriteReport};

use survey::progress::Progress;

/// Reads all headers of a file: what it holds, without its samples.
///
/// # Errors
/// [`SegyError`] when the file is not a post-stack 3D volume. A single trace is described here, and refused by
/// [`read`].
pub fn scan(path: &Path, options: &SegyOptions, progress: &Progress) -> Result<SegyInfo, SegyError> {
    Ok(SegyFile::open(path, options, progress)?.info().clone())
}

/// Reads a whole volume. Memory: 4 bytes a sample, and a few bytes a trace.
///
/// # Errors
/// [`SegyError`] when the file is not a post-stack 3D volume, or on cancel.
pub fn read(path: &Path, options: &SegyOptions, progress: &Progress) -> Result<SegyVolume, SegyError> {
    SegyFile::open(path, options, progress)?.read(progress)
}

pub use write::{SampleSource, write, write_lines};
