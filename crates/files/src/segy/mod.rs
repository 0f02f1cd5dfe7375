//! Reads and writes SEG-Y files of post-stack 3D volumes: revisions 0 to 2, both byte orders.
//!
//! The standard (SEG Technical Standards Committee, SEG-Y rev 0 1975, rev 1 2002, rev 2.0 2017) leaves much
//! open, and many files do not follow it. Everything is therefore *detected with evidence*: [`SegyInfo`]
//! reports what was read, from which bytes and why, what had to be assumed, and what is inconsistent. The
//! user states in [`SegyOptions`] what the file does not say. A file that is not a post-stack volume is
//! refused with a [`SegyProblem`] that names what it is.
//!
//! A volume that does not fit into memory is handed over block by block ([`SegyFile::blocks`], a
//! [`survey::source::BlockSource`]). Horizons, faults and wells are read by the crate `formats`; the two
//! crates share only the types of [`survey`].
//!
//! Deliberately absent: the store, projects, pre-stack data and single lines.
//!
//! This is an independent reader because the existing crates read neither little-endian files nor several of
//! the sample formats, and leave detection to the caller.
//!
//! # Units
//! [`SegyInfo`] is in the units of the file (ms, m or ft); [`SurveyGeometry`](survey::SurveyGeometry) is in
//! ms or m.
//!
//! ```
//! use files::segy::{SegyOptions, WriteOptions};
//! use survey::{Progress, SurveyGeometry, VerticalUnit, Volume};
//!
//! let path = std::env::temp_dir().join(format!("petroglyph-doc-{}.sgy", std::process::id()));
//! let geometry = SurveyGeometry::regular([3, 4, 5], 25.0, 4.0, VerticalUnit::Milliseconds);
//! let volume = Volume::filled([3, 4, 5], 1.5_f32);
//! files::segy::write(&path, &geometry, &volume, &WriteOptions::default(), &Progress::silent())?;
//! let back = files::segy::read(&path, &SegyOptions::default(), &Progress::silent())?;
//! assert_eq!(back.geometry.crosslines, geometry.crosslines);
//! assert_eq!(back.volume, volume);
//! # std::fs::remove_file(path).unwrap();
//! # Ok::<(), files::segy::SegyError>(())
//! ```

/// Endings of the names of SEG-Y files, without the dot, the usual one first.
pub const ENDINGS: [&str; 4] = ["sgy", "segy", "seg", "sgy3"];

mod angles;
mod bins;
mod block;
mod bytes;
mod candidate;
mod columns;
mod coordinates;
mod detect;
mod error;
mod evidence;
mod field_sweep;
mod file;
mod frame;
mod header;
mod info;
mod lines;
mod map;
mod null;
mod number_type;
mod options;
mod page;
mod place;
mod read;
mod refuse;
mod sample;
mod statistics;
mod text;
mod text_bytes;
mod vertical;
mod vertical_words;
mod write;

#[cfg(test)]
mod tests;

use std::path::Path;

pub use block::SegyBlocks;
pub use bytes::Stamp;
pub use candidate::{Candidate, LineSummary, Verdict};
pub use error::{SegyError, SegyProblem};
pub use file::SegyFile;
pub use info::{BytePositions, GeometrySummary, LengthUnit, SegyInfo, SurveyCorner};
pub use number_type::NumberType;
pub use options::{KeptDuplicate, LineSource, NullAmplitude, SegyOptions, TraceWeight};
pub use read::{Amplitudes, SegyVolume};
pub use sample::{ByteOrder, SampleFormat, f32_from_ibm, ibm_from_f32};
pub use statistics::{AmplitudeHistogram, Statistics};
pub use text::TextEncoding;
pub use write::{WriteFormat, WriteOptions, WriteReport};

use survey::progress::Progress;

/// Reads all headers of a file, without its samples, and reports what it holds.
///
/// ```
/// use files::segy::{SegyOptions, WriteOptions};
/// use survey::{Progress, SurveyGeometry, VerticalUnit, Volume};
///
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("volume.sgy");
/// let geometry = SurveyGeometry::regular([3, 4, 5], 25.0, 4.0, VerticalUnit::Milliseconds);
/// let volume = Volume::filled([3, 4, 5], 1.5_f32);
/// files::segy::write(&path, &geometry, &volume, &WriteOptions::default(), &Progress::silent())?;
/// let info = files::segy::scan(&path, &SegyOptions::default(), &Progress::silent())?;
/// assert_eq!(info.traces, 12);
/// assert_eq!(info.interval, 4.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`SegyError`] when the file is not a post-stack 3D volume. A single trace is described here, and refused
/// by [`read`].
pub fn scan(path: &Path, options: &SegyOptions, progress: &Progress) -> Result<SegyInfo, SegyError> {
    Ok(SegyFile::open(path, options, progress)?.info().clone())
}

/// Reads a whole volume. Memory: 4 bytes per sample, and a few bytes per trace.
///
/// # Errors
/// [`SegyError`] when the file is not a post-stack 3D volume, or when the user cancels.
pub fn read(path: &Path, options: &SegyOptions, progress: &Progress) -> Result<SegyVolume, SegyError> {
    SegyFile::open(path, options, progress)?.read(progress)
}

pub use write::{check_room, write, write_lines};
