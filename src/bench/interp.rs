//! The extraction of horizon candidates: growing, trees, distances with leaf ids, on cubes of the synthetic survey at
//! SNR 3.
//!
//! Memory is the peak of the process beyond the volume, which it held before. With a dump, the amplitudes of the
//! middle cube are written as `amplitude.npy` (float32, `[inline][crossline][sample]`), so that other programs can
//! be timed on them.

use super::{Memory, Sizes, dump};
use interp::{ExtractSettings, extract};
use project::error::ProjectError;
use serde::Serialize;
use std::fmt;
use std::fs;
use std::path::Path;
use survey::Progress;
use synth::{SynthSettings, Synthetic};
use system::file::FileAction;

/// Signal to noise of the volumes.
const SNR: f64 = 3.0;

/// The extraction of one cube.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct ExtractionRow {
    /// Voxels along each axis.
    pub side: usize,
    /// Triangles of all surfaces.
    pub triangles: usize,
    /// Leaves of their trees.
    pub leaves: usize,
    /// Seconds by stage.
    pub seconds: interp::StageSeconds,
    /// Microseconds a voxel for all of it.
    pub us_per_voxel: f64,
    /// Bytes a voxel at the peak, without the volume itself; `None` where the system does not report it.
    pub peak_bytes_per_voxel: Option<f64>,
}

impl fmt::Display for ExtractionRow {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let interp::StageSeconds { growing, trees, distances, total, .. } = self.seconds;
        write!(
            f,
            "{:>4}³  extraction {total:.2} s: growing {growing:.2} s, trees {trees:.2} s, distances \
             {distances:.2} s; {} triangles, {} leaves, {:.3} µs a voxel",
            self.side, self.triangles, self.leaves, self.us_per_voxel
        )?;
        match self.peak_bytes_per_voxel {
            Some(bytes) => writeln!(f, ", {bytes:.1} bytes a voxel at the peak"),
            None => writeln!(f),
        }
    }
}

/// Extracts the candidates of each cube.
///
/// # Errors
/// The user cancelled, or a dump could not be written.
pub(super) fn measure(sizes: Sizes, dump: Option<&Path>, progress: &Progress) -> anyhow::Result<Vec<ExtractionRow>> {
    sizes.sides().iter().map(|&side| row(side, dump.filter(|_| side == sizes.middle()), progress)).collect()
}

fn row(side: usize, dump: Option<&Path>, progress: &Progress) -> anyhow::Result<ExtractionRow> {
    let settings = SynthSettings { size: [side; 3], snr: Some(SNR), ..SynthSettings::default() };
    let volume = Synthetic::generate(&settings, progress)?.seismic;
    if let Some(folder) = dump {
        let samples = std::iter::once(bytemuck::cast_slice(volume.samples()));
        let path = folder.join("amplitude.npy");
        fs::create_dir_all(folder)
            .and_then(|()| dump::write_npy(&path, "<f4", &[side; 3], samples))
            .map_err(|source| ProjectError::io(FileAction::Written, &path, source))?;
    }
    let before = Memory::begin();
    let found = extract(&volume, &ExtractSettings::default(), progress)?;
    let (report, count) = (found.report, (side * side * side) as f64);
    let seconds = report.seconds.unwrap_or_default();
    Ok(ExtractionRow {
        side,
        triangles: report.triangles,
        leaves: report.leaves,
        us_per_voxel: seconds.total * 1e6 / count,
        seconds,
        peak_bytes_per_voxel: before.and_then(|before| before.peak()).map(|bytes| bytes / count),
    })
}
