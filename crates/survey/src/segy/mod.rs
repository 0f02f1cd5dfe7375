//! SEG-Y, in and out, for post-stack 3D volumes: revisions 0 to 2, both byte orders.
//!
//! The standard (SEG Technical Standards Committee, SEG-Y rev 0 1975, rev 1 2002, rev 2.0 2017) leaves much open and
//! writers leave more, so everything is *found with evidence*: [`SegyInfo`] says what was read, where, why, what had to
//! be assumed, and what does not fit together. [`SegyOptions`] states what the file does not say. What is not a
//! post-stack volume is refused by a [`SegyProblem`] that says what it is.
//!
//! Our own reader, since the crates at hand read neither little-endian files nor several of the formats, and leave
//! detection to the caller.
//!
//! # Units
//! [`SegyInfo`] speaks in the file's units (ms, m or ft); [`SurveyGeometry`](crate::SurveyGeometry) is in ms or m.
//!
//! ```
//! use survey::segy::{self, SegyOptions, WriteOptions};
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

mod columns;
mod coordinates;
mod detect;
mod error;
mod file;
mod frame;
mod header;
mod info;
mod lines;
mod page;
mod place;
mod read;
mod refuse;
mod sample;
mod text;
mod vertical;
mod write;

#[cfg(test)]
mod tests;

use std::path::Path;

use serde::{Deserialize, Serialize};

pub use detect::{Candidate, Verdict};
pub use error::{SegyError, SegyProblem};
pub use file::SegyFile;
pub use info::{BytePositions, FileUnit, GeometrySummary, LengthUnit, LineSummary, SegyInfo};
pub use read::{Amplitudes, SegyVolume};
pub use sample::{ByteOrder, SampleFormat, f32_from_ibm, ibm_from_f32};
pub use text::TextEncoding;
pub use write::{WriteFormat, WriteOptions, WriteReport};

use crate::progress::Progress;

/// What the trace weighting factor at byte 169 does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum TraceWeight {
    /// A factor N of 1 to 50, or −50 to −1, multiplies the trace by 2^N; others are ignored.
    #[default]
    Apply,
    /// It is ignored.
    Ignore,
}

/// What the user states about a file. Everything left out is found in the file.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SegyOptions {
    /// Trace header byte (1 to 237) of the inline number, a 4-byte integer.
    pub inline_byte: Option<u16>,
    /// Trace header byte of the crossline number.
    pub crossline_byte: Option<u16>,
    /// Trace header byte of X.
    pub x_byte: Option<u16>,
    /// Trace header byte of Y.
    pub y_byte: Option<u16>,
    /// Byte order of all numbers.
    pub byte_order: Option<ByteOrder>,
    /// Sample format, whatever byte 3225 holds.
    pub format: Option<SampleFormat>,
    /// Sample interval in the vertical unit.
    pub interval: Option<f64>,
    /// Value of the first sample in the vertical unit.
    pub start: Option<f64>,
    /// Unit of the vertical axis.
    pub vertical_unit: Option<FileUnit>,
    /// Unit of X and Y.
    pub coordinate_unit: Option<LengthUnit>,
    /// Ignore X and Y, and place the lattice at the origin with square bins of this size in metres.
    pub bin_m: Option<f64>,
    /// What byte 169 does.
    pub trace_weight: TraceWeight,
}

/// Reads all headers of a file: what it holds, without its samples.
///
/// # Errors
/// [`SegyError`] when the file is not a post-stack 3D volume. A single trace is described here, and refused by [`read`].
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

pub use write::write;
