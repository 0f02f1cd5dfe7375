//! How long it takes to write a volume to the store and to read from it. A SEG-Y file of n³ IEEE floats (reflections
//! with noise) is read to memory, imported with its pyramid, and read back by inline, crossline and time slice; dip
//! and semblance are computed on it. With a folder given, the file stays there as `survey.sgy`, so that other programs
//! can be timed on it (`bench/peers.py --store`).

use attribute::{DipSettings, SemblanceSettings, dip, semblance};
use files::segy::{SegyFile, SegyOptions, WriteOptions};
use project::error::ProjectError;
use serde::Serialize;
use std::fmt;
use std::fs;
use std::path::Path;
use std::time::Instant;
use store::{MEMORY_BYTES, StoredVolume, VolumeInfo, resume_blocks};
use survey::{Progress, SurveyGeometry, VerticalUnit, Volume};
use system::file::FileAction;

/// How often each section is read; the shortest time counts, as in `bench/peers.py`.
const REPEATS: usize = 7;

/// What was measured.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct StoreMeasured {
    /// Samples along each axis.
    pub side: usize,
    /// Size of the samples, MB.
    pub megabytes: f64,
    /// SEG-Y to memory.
    pub read_seconds: f64,
    /// SEG-Y to the store with its pyramid.
    pub store_seconds: f64,
    /// One inline from the store.
    pub inline_ms: f64,
    /// One crossline.
    pub crossline_ms: f64,
    /// One time slice.
    pub slice_ms: f64,
    /// Samples along each axis of the volume that attributes were computed of.
    pub attribute_side: usize,
    /// Both dips.
    pub dip_seconds: f64,
    /// Semblance along them.
    pub semblance_seconds: f64,
}

impl fmt::Display for StoreMeasured {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rate = |seconds: f64| self.megabytes / seconds;
        writeln!(
            f,
            "store, {}³ ({:.0} MB): SEG-Y to memory {:.2} s ({:.0} MB/s), to the store with its pyramid {:.2} s ({:.0} MB/s)",
            self.side,
            self.megabytes,
            self.read_seconds,
            rate(self.read_seconds),
            self.store_seconds,
            rate(self.store_seconds)
        )?;
        writeln!(
            f,
            "  from the store: inline {:.2} ms, crossline {:.2} ms, time slice {:.2} ms",
            self.inline_ms, self.crossline_ms, self.slice_ms
        )?;
        write!(
            f,
            "attributes, {}³: dips {:.2} s, semblance {:.2} s",
            self.attribute_side, self.dip_seconds, self.semblance_seconds
        )
    }
}

/// Measures a cube of `side`³; its file is written to `folder`.
pub(super) fn run(side: usize, folder: Option<&Path>, progress: &Progress) -> Result<StoreMeasured, ProjectError> {
    let own = std::env::temp_dir().join(format!("petroglyph-bench-{}", std::process::id()));
    let measured = measure(side, folder.unwrap_or(&own), &own, progress);
    // What cannot be removed stays in the folder for temporary files.
    let _ = fs::remove_dir_all(&own);
    measured
}

fn measure(side: usize, kept: &Path, own: &Path, progress: &Progress) -> Result<StoreMeasured, ProjectError> {
    for folder in [kept, own] {
        fs::create_dir_all(folder).map_err(|source| ProjectError::io(FileAction::Written, folder, source))?;
    }
    let (file, zarr) = (kept.join("survey.sgy"), own.join("survey.zarr"));
    write_survey(side, &file, progress)?;

    let start = Instant::now();
    let read = files::segy::read(&file, &SegyOptions::default(), progress)?;
    let read_seconds = start.elapsed().as_secs_f64();
    let attribute_side = side.min(256);
    let part = corner(&read.volume, attribute_side);
    drop(read);

    let start = Instant::now();
    ingest(&file, &zarr, progress)?;
    let store_seconds = start.elapsed().as_secs_f64();

    let stored = StoredVolume::open(&zarr)?;
    let middle = side / 2;
    let section = |start: [usize; 3], size: [usize; 3]| -> Result<f64, ProjectError> {
        let mut best = f64::INFINITY;
        for _ in 0..REPEATS {
            let begun = Instant::now();
            stored.read_box_f32(0, start, size)?;
            best = best.min(begun.elapsed().as_secs_f64() * 1e3);
        }
        Ok(best)
    };
    let inline_ms = section([middle, 0, 0], [1, side, side])?;
    let crossline_ms = section([0, middle, 0], [side, 1, side])?;
    let slice_ms = section([0, 0, middle], [side, side, 1])?;

    let start = Instant::now();
    let dips = dip(&part, &DipSettings::default(), progress)?;
    let dip_seconds = start.elapsed().as_secs_f64();
    let start = Instant::now();
    semblance(&part, &dips, &SemblanceSettings::default(), progress)?;
    let semblance_seconds = start.elapsed().as_secs_f64();
    Ok(StoreMeasured {
        side,
        megabytes: (side * side * side * size_of::<f32>()) as f64 / 1e6,
        read_seconds,
        store_seconds,
        inline_ms,
        crossline_ms,
        slice_ms,
        attribute_side,
        dip_seconds,
        semblance_seconds,
    })
}

/// Imports the file to the store as `import` does, without a project.
fn ingest(file: &Path, zarr: &Path, progress: &Progress) -> Result<(), ProjectError> {
    let opened = SegyFile::open(file, &SegyOptions::default(), progress)?;
    let info = VolumeInfo::of(opened.geometry()?);
    resume_blocks(zarr, "bench", &mut opened.blocks(), &info, MEMORY_BYTES, progress)?;
    Ok(())
}

/// Folded reflections with noise, so that the samples are no easier to handle than those of a real survey.
fn write_survey(side: usize, path: &Path, progress: &Progress) -> Result<(), ProjectError> {
    let geometry = SurveyGeometry::regular([side; 3], 25.0, 4.0, VerticalUnit::Milliseconds);
    let mut source = |lines: std::ops::Range<usize>| {
        let mut samples = Vec::with_capacity(lines.len() * side * side);
        for x in lines {
            for y in 0..side {
                let shift = 20.0 * (x as f32 / 60.0).sin() + 15.0 * (y as f32 / 45.0).cos();
                let mut state = (x * side + y) as u32 ^ 0x9e37_79b9;
                samples.extend((0..side).map(|z| {
                    state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                    let t = z as f32 + shift;
                    let noise = (state >> 8) as f32 / (1u32 << 24) as f32 - 0.5;
                    1000.0 * ((t * 0.52).sin() * (t * 0.071).sin() + 0.4 * noise)
                }));
            }
        }
        Ok(samples.into())
    };
    files::segy::write_lines(path, &geometry, None, &WriteOptions::default(), 16, &mut source, progress)?;
    Ok(())
}

/// The first `side`³ samples.
fn corner(volume: &Volume<f32>, side: usize) -> Volume<f32> {
    let mut part = Volume::filled([side; 3], 0.0f32);
    for x in 0..side {
        for y in 0..side {
            part.trace_mut(x, y).copy_from_slice(&volume.trace(x, y)[..side]);
        }
    }
    part
}
