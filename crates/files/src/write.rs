//! Writes to a temporary file beside the target, then renames it, so that a full disk or a crash leaves the
//! old file unchanged.

use super::{Format, FormatError};
use glam::DVec2;
use std::fs;
use std::io::{BufWriter, Write};
use std::path::Path;
use survey::geometry::SurveyGeometry;
use survey::horizon::{Horizon, Quality};

/// Why a surface was not written.
pub(super) enum WriteFailure {
    Io(std::io::Error),
    /// What does not fit, and what to do instead.
    NotRepresentable(String, &'static str),
}

impl From<std::io::Error> for WriteFailure {
    fn from(error: std::io::Error) -> Self {
        Self::Io(error)
    }
}

/// Writes through `fill` to a file beside `path` and renames it when everything is on disk.
pub(super) fn beside(
    path: &Path,
    name: &str,
    format: Format,
    fill: impl FnOnce(&mut dyn Write) -> Result<(), WriteFailure>,
) -> Result<(), FormatError> {
    let io = |source| FormatError::Io { action: "write", file: path.to_path_buf(), source };
    let mut part = path.as_os_str().to_owned();
    part.push(format!(".{}.part", std::process::id()));
    let part = std::path::PathBuf::from(part);
    let written = fs::File::create(&part).map_err(WriteFailure::Io).and_then(|file| {
        let mut out = BufWriter::new(file);
        fill(&mut out)?;
        let file = out.into_inner().map_err(std::io::IntoInnerError::into_error)?;
        file.sync_all()?;
        fs::rename(&part, path)?;
        Ok(system::file::sync_folder(path.parent().unwrap_or(path))?)
    });
    written.map_err(|failure| {
        // No partial file may remain. A failure to remove it is not reported: the user sees the first error.
        let _ = fs::remove_file(&part);
        match failure {
            WriteFailure::Io(source) => io(source),
            WriteFailure::NotRepresentable(why, instead) => {
                FormatError::NotRepresentable { name: name.into(), format, why, instead }
            }
        }
    })
}

/// How many of the nodes were not picked, in words; none if all were.
pub(super) fn unpicked(horizon: &Horizon) -> Option<String> {
    let nodes = || horizon.sheets.iter().flat_map(|sheet| &sheet.quality).filter(|quality| **quality != Quality::Hole);
    let made = nodes().filter(|quality| matches!(quality, Quality::Filled | Quality::Extrapolated)).count();
    let share = 100.0 * made as f64 / nodes().count().max(1) as f64;
    // A share that is rounded away is there all the same.
    let percent = if share < 1.0 { "less than 1".to_owned() } else { format!("{share:.0}") };
    (made > 0).then(|| format!("{percent} % of the nodes were not picked but filled or extrapolated"))
}

/// A node of a horizon, with everything that a table may state about it.
pub(super) struct TableNode {
    pub lines: DVec2,
    pub xy: DVec2,
    pub z: f32,
    pub sheet: usize,
    pub quality: Quality,
}

/// Every node with a depth, sheet by sheet; or every corner of a surface of any shape.
pub(super) fn nodes<'a>(horizon: &'a Horizon, geometry: &'a SurveyGeometry) -> impl Iterator<Item = TableNode> + 'a {
    let sheets = horizon.sheets.iter().enumerate().flat_map(move |(sheet, s)| {
        let nv = s.grid.count[1];
        s.depth.iter().enumerate().filter(|(_, z)| z.is_finite()).map(move |(n, &z)| {
            let xy = s.grid.world_at(DVec2::new((n / nv) as f64, (n % nv) as f64));
            let voxel = super::placement::voxel_xy(geometry, xy);
            TableNode { lines: geometry.lines_from_voxel(voxel), xy, z, sheet, quality: s.quality[n] }
        })
    });
    let corners = horizon.any_shape().into_iter().flat_map(|surface| &surface.vertices).map(|corner| {
        let (xy, z) = (corner.truncate(), corner.z as f32);
        let lines = geometry.lines_from_voxel(super::placement::voxel_xy(geometry, xy));
        TableNode { lines, xy, z, sheet: 0, quality: Quality::Picked }
    });
    sheets.chain(corners)
}

/// A line number, written as an integer if it is one.
pub(super) fn line_number(number: f64) -> String {
    let whole = number.round();
    if (number - whole).abs() < 1e-4 { format!("{whole:.0}") } else { format!("{number:.4}") }
}
