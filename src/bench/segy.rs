//! How fast a SEG-Y cube is read into memory: IEEE and IBM floats, headers interpreted, every trace decoded and
//! measured.
//!
//! The file was just written, so the system holds it in memory: the times are those of our work and not of the disk.
//! `bench/peers.py` times segyio on the same files. A third file goes into the store and out of it.

use super::StoreMeasured;
use files::segy::{SegyOptions, WriteFormat, WriteOptions};
use project::error::ProjectError;
use serde::Serialize;
use std::fmt;
use std::path::Path;
use std::time::Instant;
use survey::{Progress, SurveyGeometry, VerticalUnit, Volume};

/// How often each file is read; the quickest reading counts, since other programs can only slow one down.
const ROUNDS: usize = 5;

/// One file.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct SegyRead {
    /// Sample format.
    pub format: &'static str,
    /// Samples along each axis.
    pub side: usize,
    /// Seconds from opening the file to the volume in memory, each round.
    pub seconds: Vec<f64>,
    /// GB (1e9 bytes) of samples a second, in the quickest round.
    pub gb_per_second: f64,
}

/// What was measured.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct SegyReads {
    /// Threads used.
    pub threads: usize,
    /// The files.
    pub reads: Vec<SegyRead>,
    /// Times for writing to the store and reading from it.
    pub store: StoreMeasured,
}

impl fmt::Display for SegyReads {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for read in &self.reads {
            writeln!(
                f,
                "SEG-Y to memory, {}³ {}: {:.2} GB/s ({} threads)",
                read.side, read.format, read.gb_per_second, self.threads
            )?;
        }
        write!(f, "{}", self.store)
    }
}

/// Writes a cube of `side`³ samples to `folder` in each format, and reads it. The files stay.
///
/// # Errors
/// The user cancelled, or files could not be written.
pub(crate) fn run(side: usize, folder: &Path, progress: &Progress) -> Result<SegyReads, ProjectError> {
    let geometry = SurveyGeometry::regular([side; 3], 25.0, 4.0, VerticalUnit::Milliseconds);
    let mut volume = Volume::filled([side; 3], 0.0_f32);
    let mut state = 1_u32;
    for sample in volume.samples_mut() {
        // Noise in [-1, 1): every exponent occurs.
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        *sample = f32::from((state >> 16) as u16) / 32_768.0 - 1.0;
    }
    let mut reads = Vec::new();
    for (format, name) in [(WriteFormat::Ieee32, "ieee"), (WriteFormat::Ibm32, "ibm")] {
        let path = folder.join(format!("{name}.sgy"));
        files::segy::write(&path, &geometry, &volume, &WriteOptions { format, ..WriteOptions::default() }, progress)?;
        let mut seconds = Vec::new();
        for _ in 0..ROUNDS {
            let start = Instant::now();
            let read = files::segy::read(&path, &SegyOptions::default(), progress)?;
            seconds.push(start.elapsed().as_secs_f64());
            drop(read);
        }
        let quickest = seconds.iter().copied().fold(f64::INFINITY, f64::min);
        let gb_per_second = (side * side * side * size_of::<f32>()) as f64 / 1e9 / quickest;
        reads.push(SegyRead { format: name, side, seconds, gb_per_second });
    }
    let store = super::store::run(side, Some(folder), progress)?;
    Ok(SegyReads { threads: rayon::current_num_threads(), reads, store })
}
