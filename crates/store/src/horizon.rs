//! Horizons on disk: `NAME.zarr`, a Zarr v3 group with a subgroup `0`, `1`, … for each sheet. Each subgroup
//! has the arrays `depth` (float32, vertical value, NaN = hole) and `quality` (uint8, the numbers of
//! [`Quality`]). Sheets on the survey's lattice are `[inline][crossline]`; the own grid of every sheet is in
//! the group's attribute `petroglyph`. A horizon of any shape has the arrays `vertices` (float64, world X, Y and vertical
//! value) and `triangles` (uint32, three corners each) instead of sheets; without triangles it is a set of points.
//!
//! Memory: 9 bytes per node of the sheet that is being read or written.

use super::array::{StoredArray, write_array, write_group};
use super::error::StoreError;
use super::header::{read_header, write_header};
use super::layout::ArrayLayout;
use super::replacement::Replacement;
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::path::Path;
use survey::TriangleMesh;
use survey::geometry::MAX_COORDINATE;
use survey::horizon::{Horizon, NodeGrid, Quality, Sheet};
use survey::progress::Progress;

/// Kind of the group.
const KIND: &str = "horizon";

/// Facts of a horizon.
#[derive(Serialize, Deserialize)]
struct HorizonHeader {
    name: String,
    sheets: Vec<SheetHeader>,
    /// Counts of corners and triangles of a horizon of any shape.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    surface: Option<[usize; 2]>,
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
/// let chalk = Horizon::new("chalk", vec![sheet]);
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
    let surface = horizon.surface.as_ref().map(|mesh| [mesh.vertices.len(), mesh.triangles.len()]);
    write_header(group, KIND, &HorizonHeader { name: horizon.name.clone(), sheets, surface })?;
    for (n, sheet) in horizon.sheets.iter().enumerate() {
        write_group(group, &n.to_string(), serde_json::Map::new())?;
        let layout = || ArrayLayout::map(sheet.grid.count, ["inline", "crossline"]);
        write_array(group, &format!("{n}/depth"), layout(), f32::NAN, &sheet.depth, progress)?;
        let quality: Vec<u8> = sheet.quality.iter().map(|&quality| quality as u8).collect();
        write_array(group, &format!("{n}/quality"), layout(), Quality::Hole as u8, &quality, progress)?;
    }
    if let Some(mesh) = &horizon.surface {
        write_surface(path, group, mesh, progress)?;
    }
    replacement.commit()
}

fn write_surface(path: &Path, group: &Path, mesh: &TriangleMesh, progress: &Progress) -> Result<(), StoreError> {
    check_vertices(path, mesh)?;
    let layout = |count: usize, of: &'static str| ArrayLayout::map([count, 3], [of, "axis"]);
    let vertices: Vec<f64> = mesh.vertices.iter().flat_map(|v| v.to_array()).collect();
    write_array(group, "vertices", layout(mesh.vertices.len(), "vertex"), f64::NAN, &vertices, progress)?;
    if mesh.triangles.is_empty() {
        return Ok(());
    }
    let layout = ArrayLayout::map([mesh.triangles.len(), 3], ["triangle", "corner"]);
    write_array(group, "triangles", layout, 0u32, mesh.triangles.as_flattened(), progress)
}

fn read_surface(
    path: &Path,
    [vertices, triangles]: [usize; 2],
    progress: &Progress,
) -> Result<TriangleMesh, StoreError> {
    let damaged = |array: &str, reason: String| StoreError::damaged(path, array, reason);
    let open = |array: &str, count: usize| {
        let found = StoredArray::open(path, array)?;
        if found.shape() == [count, 3] {
            Ok(found)
        } else {
            Err(damaged(array, format!("it has {:?}, the horizon [{count}, 3]", found.shape())))
        }
    };
    let places = open("vertices", vertices)?.read::<f64>(progress)?;
    let vertices: Vec<DVec3> = places.chunks_exact(3).map(DVec3::from_slice).collect();
    let triangles: Vec<[u32; 3]> = if triangles == 0 {
        Vec::new()
    } else {
        let corners = open("triangles", triangles)?.read::<u32>(progress)?;
        corners.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect()
    };
    if triangles.iter().flatten().any(|&corner| corner as usize >= vertices.len()) {
        return Err(damaged("triangles", "a triangle has a corner that is not there".to_owned()));
    }
    let mesh = TriangleMesh { vertices, triangles };
    check_vertices(path, &mesh)?;
    Ok(mesh)
}

/// Refuses corners that are no places, or farther off than any survey may reach.
fn check_vertices(path: &Path, mesh: &TriangleMesh) -> Result<(), StoreError> {
    let is_place = |v: &DVec3| v.is_finite() && v.abs().max_element() <= MAX_COORDINATE;
    let Some(beyond) = mesh.vertices.iter().find(|v| !is_place(v)) else { return Ok(()) };
    let reason = format!("the corner {beyond} lies beyond any survey, which reaches at most {MAX_COORDINATE:e}");
    Err(StoreError::damaged(path, "vertices", reason))
}

/// Reads a horizon back.
///
/// # Errors
/// [`StoreError`] when it is missing, of another kind, newer than this program or damaged.
pub fn read_horizon(path: &Path, progress: &Progress) -> Result<Horizon, StoreError> {
    let header: HorizonHeader = read_header(path, KIND, "a horizon")?;
    let mut sheets = Vec::with_capacity(header.sheets.len());
    for (n, SheetHeader { block, grid }) in header.sheets.into_iter().enumerate() {
        let open = |what: &str| {
            let name = format!("{n}/{what}");
            let array = StoredArray::open(path, &name)?;
            let damaged = |reason| StoreError::damaged(path, &name, reason);
            if array.shape() != grid.count {
                return Err(damaged(format!("it has {:?}, its grid {:?}", array.shape(), grid.count)));
            }
            Ok(array)
        };
        let depth = open("depth")?.read::<f32>(progress)?;
        check_depths(path, n, &depth)?;
        let numbers = open("quality")?.read::<u8>(progress)?;
        let quality = numbers.iter().map(|&number| quality_of(number)).collect::<Option<Vec<Quality>>>();
        let quality = quality
            .ok_or_else(|| StoreError::damaged(path, &format!("{n}/quality"), "a number stands for no quality"))?;
        sheets.push(Sheet { block, grid, depth, quality });
    }
    let surface = header.surface.map(|counts| read_surface(path, counts, progress)).transpose()?;
    Ok(Horizon { name: header.name, sheets, surface })
}

/// Refuses a depth that lies farther off than any survey may reach; what is not finite is a hole.
fn check_depths(path: &Path, sheet: usize, depths: &[f32]) -> Result<(), StoreError> {
    let is_beyond = |depth: &&f32| depth.is_finite() && f64::from(depth.abs()) > MAX_COORDINATE;
    let Some(beyond) = depths.iter().find(is_beyond) else { return Ok(()) };
    let reason = format!("a depth of {beyond:e} lies beyond any survey, which reaches at most {MAX_COORDINATE:e}");
    Err(StoreError::damaged(path, &format!("{sheet}/depth"), reason))
}

/// The quality that a number stands for.
fn quality_of(number: u8) -> Option<Quality> {
    use Quality::{Extrapolated, Filled, Hole, Picked, Snapped, Tracked};
    [Hole, Picked, Tracked, Filled, Extrapolated, Snapped].into_iter().find(|&quality| quality as u8 == number)
}
