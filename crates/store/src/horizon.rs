//! Horizons on disk: `NAME.zarr`, a Zarr v3 group with a subgroup `0`, `1`, … for each sheet. Each subgroup
//! has the arrays `depth` (float32, vertical value, NaN = hole) and `quality` (uint8, the numbers of
//! [`Quality`]). Sheets on the survey's lattice are `[inline][crossline]`; the own grid of every sheet is in
//! the group's attribute `petroglyph`.
//!
//! Memory: 9 bytes per node of the sheet that is being read or written.

use super::array::{StoredArray, write_array, write_group};
use super::error::StoreError;
use super::header::{read_header, write_header};
use super::layout::ArrayLayout;
use super::replacement::Replacement;
use serde::{Deserialize, Serialize};
use std::path::Path;
use survey::geometry::MAX_COORDINATE;
use survey::horizon::{Horizon, NodeGrid, Quality, Sheet};
use survey::progress::Progress;

/// Kind of the group.
const KIND: &str = "horizon";

/// Facts of a horizon.
#[derive(Serialize, Deserialize)]
struct Header {
    name: String,
    sheets: Vec<SheetHeader>,
}

/// Facts of a sheet.
#[derive(Serialize, Deserialize)]
struct SheetHeader {
    block: Option<u16>,
    grid: NodeGrid,
}

/// Stores a horizon.
///
/// ```
/// # use survey::{Horizon, NodeGrid, Progress, Quality, Sheet, SurveyGeometry, VerticalUnit};
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("chalk.zarr");
/// let geometry = SurveyGeometry::regular([2, 2, 50], 25.0, 4.0, VerticalUnit::Milliseconds);
/// let sheet = Sheet::new(NodeGrid::of_survey(&geometry), vec![80.0, 84.0, 88.0, 92.0], Quality::Picked);
/// let chalk = Horizon { name: "chalk".into(), sheets: vec![sheet] };
/// store::write_horizon(&path, &chalk, &Progress::silent())?;
/// assert_eq!(store::read_horizon(&path, &Progress::silent())?, chalk);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`StoreError`]; `path` then remains as it was. A depth beyond any survey is refused.
pub fn write_horizon(path: &Path, horizon: &Horizon, progress: &Progress) -> Result<(), StoreError> {
    let sheets = horizon.sheets.iter().map(|sheet| SheetHeader { block: sheet.block, grid: sheet.grid }).collect();
    for (n, sheet) in horizon.sheets.iter().enumerate() {
        check_depths(path, n, &sheet.depth)?;
    }
    let replacement = Replacement::of(path)?;
    let group = replacement.path();
    write_header(group, KIND, &Header { name: horizon.name.clone(), sheets })?;
    for (n, sheet) in horizon.sheets.iter().enumerate() {
        write_group(group, &n.to_string(), serde_json::Map::new())?;
        let layout = || ArrayLayout::map(sheet.grid.count, ["inline", "crossline"]);
        write_array(group, &format!("{n}/depth"), layout(), f32::NAN, &sheet.depth, progress)?;
        let quality: Vec<u8> = sheet.quality.iter().map(|&quality| quality as u8).collect();
        write_array(group, &format!("{n}/quality"), layout(), Quality::Hole as u8, &quality, progress)?;
    }
    replacement.commit()
}

/// Reads a horizon back.
///
/// # Errors
/// [`StoreError`] when it is missing, of another kind, newer than this program or damaged.
pub fn read_horizon(path: &Path, progress: &Progress) -> Result<Horizon, StoreError> {
    let header: Header = read_header(path, KIND, "a horizon")?;
    let mut sheets = Vec::with_capacity(header.sheets.len());
    for (n, SheetHeader { block, grid }) in header.sheets.into_iter().enumerate() {
        let open = |what: &str| {
            let name = format!("{n}/{what}");
            let array = StoredArray::open(path, &name)?;
            let damaged = |reason| StoreError::Damaged { path: path.to_owned(), array: name.clone(), reason };
            if array.shape() != grid.count {
                return Err(damaged(format!("it has {:?}, its grid {:?}", array.shape(), grid.count)));
            }
            Ok(array)
        };
        let depth = open("depth")?.read::<f32>(progress)?;
        check_depths(path, n, &depth)?;
        let numbers = open("quality")?.read::<u8>(progress)?;
        let quality = numbers.iter().map(|&number| quality_of(number)).collect::<Option<Vec<Quality>>>();
        let quality = quality.ok_or_else(|| StoreError::Damaged {
            path: path.to_owned(),
            array: format!("{n}/quality"),
            reason: "a number stands for no quality".to_owned(),
        })?;
        sheets.push(Sheet { block, grid, depth, quality });
    }
    Ok(Horizon { name: header.name, sheets })
}

/// Refuses a depth that lies farther off than any survey may reach; what is not finite is a hole.
fn check_depths(path: &Path, sheet: usize, depths: &[f32]) -> Result<(), StoreError> {
    let is_beyond = |depth: &&f32| depth.is_finite() && f64::from(depth.abs()) > MAX_COORDINATE;
    let Some(beyond) = depths.iter().find(is_beyond) else { return Ok(()) };
    let reason = format!("a depth of {beyond:e} lies beyond any survey, which reaches at most {MAX_COORDINATE:e}");
    Err(StoreError::Damaged { path: path.to_owned(), array: format!("{sheet}/depth"), reason })
}

/// The quality that a number stands for.
fn quality_of(number: u8) -> Option<Quality> {
    [Quality::Hole, Quality::Picked, Quality::Tracked, Quality::Filled, Quality::Extrapolated]
        .into_iter()
        .find(|&quality| quality as u8 == number)
}
