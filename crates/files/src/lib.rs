//! Reads and writes files of horizons and faults, and reads files of wells ([`well`]).
//!
//! SEG-Y is read by the crate `segy`; the two crates share only the types of [`survey`].
//!
//! Deliberately absent: volumes, the store, projects.
//!
//! Files of every format go through the same steps:
//!
//! 1. The signature of the file determines its [`Format`]; the report has the evidence.
//! 2. The reader of the format returns the numbers as they are in the file.
//! 3. The numbers are converted, in the order that [`ImportOptions`] states.
//! 4. They are placed on nodes and split into single-valued sheets.
//! 5. The result is checked against the survey.
//!
//! The [`ImportReport`] says what was read, assumed and left out. A surface beside, above or below the
//! survey, or one with an implausible unit or sign, is an error, and nothing is imported.
//!
//! ```
//! use files::{Format, ImportOptions};
//! use survey::{Horizon, NodeGrid, Quality, Sheet, SurveyGeometry, VerticalUnit};
//!
//! let folder = tempfile::tempdir()?;
//! let path = folder.path().join("chalk.csv");
//! let geometry = SurveyGeometry::regular([3, 3, 101], 25.0, 4.0, VerticalUnit::Metres);
//! let depths = vec![100.0, 110.0, 120.0, 105.0, 115.0, 125.0, 110.0, 120.0, 130.0];
//! let sheet = Sheet::new(NodeGrid::of_survey(&geometry), depths, Quality::Picked);
//! let chalk = Horizon::new("chalk", vec![sheet]);
//! let written = files::write_horizon(&path, &chalk, &geometry, Format::Csv)?;
//! assert_eq!(written.nodes, 9);
//!
//! let read = files::read_horizons(&path, &geometry, &ImportOptions::default())?;
//! let (horizon, report) = &read[0];
//! assert_eq!(horizon.sheets[0].depth, chalk.sheets[0].depth);
//! assert_eq!(report.format.value, Format::Csv);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! | format | horizon in | fault in | horizon out | fault out |
//! |---|---|---|---|---|
//! | CSV / XYZ with or without a header | ✓ | points, sticks | ✓ | |
//! | Irap classic ASCII | ✓ | | ✓ | |
//! | OpendTect ASCII | ✓ | sticks | ✓ | sticks |
//! | GOCAD TSurf | ✓ | ✓ | ✓ | ✓ |
//! | GOCAD VSet, PLine | ✓ | points, sticks | | |
//! | DXF (3DFACE, polylines) | ✓ | ✓, sticks | | |
//! | ZMAP+, CPS-3 (unrotated: others are resampled) | ✓ | | ✓ | |
//! | Irap binary, PetroMod binary, IJXYZ, IESX, DUG | ✓ | | | |
//! | EarthVision, Petrel points and well tops | ✓ | points | | |
//! | Charisma | ✓ | sticks | | |
//! | Esri ASCII, Surfer (DSAA, DSBB, DSRB) | ✓ | | | |
//! | GeoTIFF, GXF, NetCDF (classic), NumPy arrays | ✓ | | | |
//! | OBJ, STL | ✓ | ✓ | | |
//! | GeoJSON, shapefile, GeoPackage | points | traces with a dip, sticks | | |
//! | ZMAP+ points, RMS points (CSV/XYZ with 999 separators or attributes), polygons with ids | ✓ | outlines, sticks | | |
//!
//! To add a format: one file with a `CODEC`; in `format.rs` one variant of [`Format`] and one line in `CODECS`.

mod binary;
mod block_fit;
mod charisma;
mod column;
mod columns;
mod cps3;
mod crs;
mod csv;
mod describe;
mod dug;
mod dxf;
mod earthvision;
mod error;
mod esri;
mod export;
mod fault;
mod format;
mod geojson;
mod geopackage;
mod geotiff;
mod grid;
mod gxf;
mod horizon;
mod iesx;
mod ijxyz;
mod irap;
mod irap_binary;
mod known;
mod lattice;
mod mesh_sticks;
mod neighbours;
mod netcdf;
mod npy;
mod npy_volume;
mod number;
mod obj;
mod opendtect;
mod options;
mod orientations;
mod outline;
mod overturned_points;
mod petrel;
mod petromod;
mod placement;
mod plane_fit;
mod raster;
mod raw;
mod report;
mod resampling;
mod scatter;
pub mod segy;
mod shapefile;
mod sheets;
mod sqlite;
mod sticks;
mod stl;
mod surface_kind;
mod surfer;
mod table;
mod text;
mod traces;
mod tsurf;
mod unit;
mod vertical;
mod welded_mesh;
pub mod well;
mod write;
mod zmap;
mod zmap_points;

pub use block_fit::{BlockFit, fit_blocks};
pub use column::Column;
pub use describe::{FileDescription, SurfaceDescription, describe};
pub use error::{FormatError, HorizontalExtent};
pub use export::{ExportOptions, ExportReport, WhenRotated};
pub use format::{Format, SurfaceKind};
pub use mesh_sticks::{axis_along, extent_along, planes_along, stick_along_cut, sticks_on_sections, strike};
pub use npy_volume::NpyVolume;
pub use options::{HorizonShape, ImportOptions, PlaceBy, ValueOrder};
pub use report::{Gridding, ImportReport, Provenance, Settled};
pub use scatter::grid_points;
pub use unit::{ZPositive, ZUnit};

use format::{CODECS, Codec, HorizonWriter, names};
use glam::DVec3;
use raw::{RawSurface, ReadContext};
use std::borrow::Cow;
use std::path::Path;
use survey::fault::Fault;
use survey::geometry::SurveyGeometry;
use survey::horizon::{Horizon, Sheet};
use text::SourceFile;
use unit::Domain;
use unit::words::HeaderUnits;

#[cfg(test)]
mod tests;

/// Determines the format of a file in memory and reads the selected surfaces without conversion.
fn read_source(
    source: &SourceFile,
    geometry: Option<&SurveyGeometry>,
    options: &ImportOptions,
    kind: SurfaceKind,
) -> Result<(Settled<Format>, Vec<RawSurface>), FormatError> {
    let path = source.path.as_path();
    let format = match options.format {
        Some(format) => Settled { value: format, source: Provenance::Option },
        None => {
            // What is known by its first bytes is no table, even where its rows look like one.
            let known = known::by_name(path, &source.bytes);
            let mut open = CODECS.iter().filter(|c| known.is_none() || c.format != Format::Csv);
            let found = open.find_map(|c| Some((c.format, (c.detect)(source)?)));
            let (value, evidence) = found.ok_or_else(|| unknown(path, &source.bytes))?;
            Settled { value, source: Provenance::File(evidence) }
        }
    };
    let reader_of = |c: &Codec| if kind == SurfaceKind::Horizon { c.read_horizon } else { c.read_fault };
    let Some(reader) = reader_of(format.value.codec()) else {
        let instead = names(|c| reader_of(c).is_some());
        return Err(FormatError::Unsupported { format: format.value, action: "read", kind, instead });
    };
    let mut surfaces = reader(source, &ReadContext { geometry, options, kind })?;
    if kind == SurfaceKind::Fault {
        surfaces = surfaces.into_iter().flat_map(outline::split).collect();
    }
    let mut surfaces = selected(source, surfaces, options, kind)?;
    let header = HeaderUnits::of(header_lines(source).iter().map(String::as_str));
    let survey = geometry.map(|geometry| Domain::of(geometry.vertical.unit));
    surfaces.iter_mut().for_each(|surface| surface.take_units(&header, survey));
    Ok((format, surfaces))
}

/// The error of a file of which no reader knows the format.
fn unknown(path: &Path, bytes: &[u8]) -> FormatError {
    let known = known::by_name(path, bytes);
    let start = String::from_utf8_lossy(&bytes[..bytes.len().min(80)]);
    let begins = || {
        let first = text::lines(&start).next();
        first.map_or_else(|| "it is empty".into(), |l| format!("it begins with {}", text::excerpt(l.text)))
    };
    let found = known.map_or_else(begins, str::to_owned);
    FormatError::UnknownFormat { file: path.to_path_buf(), found, is_named: known.is_some(), known: names(|_| true) }
}

/// The error of a file that is known by name but not read, such as an archive, from its bytes or the first of them: what it
/// is, and what to export instead.
///
/// ```
/// let error = files::known_but_not_read("a.gz".as_ref(), b"\x1f\x8b\x08").unwrap();
/// assert!(error.to_string().contains("unpack it"));
/// assert!(files::known_but_not_read("a.csv".as_ref(), b"x,y,z").is_none());
/// ```
pub fn known_but_not_read(path: &Path, start: &[u8]) -> Option<FormatError> {
    // Of GOCAD's objects some are read.
    let known = known::by_name(path, start).filter(|_| !start.starts_with(b"GOCAD "));
    known.map(|_| unknown(path, start))
}

/// The comments at the beginning of a text file, which may state units.
fn header_lines(source: &SourceFile) -> Vec<String> {
    let start = &source.bytes[..source.bytes.len().min(HEADER_BYTES)];
    if start.contains(&0) {
        return Vec::new();
    }
    let start = String::from_utf8_lossy(start);
    text::lines(&start).filter(|line| table::is_comment(line.text)).map(|line| line.text.to_owned()).collect()
}

/// Bytes in which the comments of a header are looked for.
const HEADER_BYTES: usize = 1 << 16;

/// The surfaces to import: those of the selected name; of several, the one of the given name; otherwise all.
fn selected(
    source: &SourceFile,
    surfaces: Vec<RawSurface>,
    options: &ImportOptions,
    kind: SurfaceKind,
) -> Result<Vec<RawSurface>, FormatError> {
    // Those without a name are listed by their number, and selected by it; a name that is a number is a name first.
    let unnamed = |surface: &RawSurface| surface.name.as_deref().is_none_or(|name| name.trim().is_empty());
    if let Some(wanted) = &options.select
        && let Ok(number @ 1..) = wanted.parse::<usize>()
        && surfaces.len() > 1
        && surfaces.get(number - 1).is_some_and(unnamed)
        && surfaces.iter().all(|surface| surface.name.as_ref() != Some(wanted))
    {
        return Ok(surfaces.into_iter().skip(number - 1).take(1).collect());
    }
    let wanted = match (&options.select, &options.name) {
        (Some(name), _) => name,
        (None, Some(name)) if surfaces.len() > 1 => name,
        _ => return Ok(surfaces),
    };
    let name = |(n, surface): (usize, &RawSurface)| {
        let own = surface.name.clone().filter(|_| !unnamed(surface));
        own.unwrap_or_else(|| format!("{}", n + 1))
    };
    let available = surfaces.iter().enumerate().map(name).collect::<Vec<_>>();
    let found: Vec<_> = surfaces.into_iter().filter(|s| s.name.as_ref() == Some(wanted)).collect();
    if found.is_empty() {
        return Err(FormatError::NoSuchName {
            file: source.path.clone(),
            kind,
            wanted: wanted.clone(),
            available: available.join(", "),
        });
    }
    Ok(found)
}

/// The name of a surface: the one given, or else its own, or else the file name without its extension.
fn name_of(raw: &RawSurface, source: &SourceFile, options: &ImportOptions) -> String {
    let own = raw.name.as_deref().map(str::trim).filter(|n| !n.is_empty());
    options.name.clone().or_else(|| own.map(String::from)).unwrap_or_else(|| source.stem())
}

/// Reads the horizons of a file and places them on nodes over the survey.
///
/// ```
/// # use files::{ImportOptions, read_horizons};
/// # use survey::{SurveyGeometry, VerticalUnit};
/// let geometry = SurveyGeometry::regular([2, 2, 101], 25.0, 4.0, VerticalUnit::Metres);
/// let folder = tempfile::tempdir()?;
/// let file = folder.path().join("top.csv");
/// std::fs::write(&file, "inline,crossline,z\n1,1,100\n1,2,110\n2,1,120\n2,2,130\n")?;
/// let read = read_horizons(&file, &geometry, &ImportOptions::default())?;
/// assert_eq!(read[0].0.name, "top");
/// assert_eq!(read[0].0.sheets[0].depth, [100.0, 110.0, 120.0, 130.0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`FormatError`] when the file cannot be read, does not fit the survey, or is ambiguous. Its text says what
/// to do.
///
/// # Cost
/// O(n log n) in the count of points or nodes. The file is held in memory.
pub fn read_horizons(
    path: &Path,
    geometry: &SurveyGeometry,
    options: &ImportOptions,
) -> Result<Vec<(Horizon, ImportReport)>, FormatError> {
    built(&SourceFile::open(path)?, geometry, options, SurfaceKind::Horizon, horizon::build)
}

/// Makes a horizon or a fault of a surface as read.
type Build<T> = fn(
    &Path,
    String,
    Settled<Format>,
    RawSurface,
    &SurveyGeometry,
    &ImportOptions,
) -> Result<(T, ImportReport), FormatError>;

/// The selected surfaces of a file, made and placed.
fn built<T>(
    source: &SourceFile,
    geometry: &SurveyGeometry,
    options: &ImportOptions,
    kind: SurfaceKind,
    build: Build<T>,
) -> Result<Vec<(T, ImportReport)>, FormatError> {
    let (format, mut surfaces) = read_source(source, Some(geometry), options, kind)?;
    let name = |raw: &RawSurface| name_of(raw, source, options);
    surfaces.iter_mut().for_each(|raw| raw.convert_places(options.xy_unit));
    if kind == SurfaceKind::Horizon {
        orientations::attach(&mut surfaces, name, geometry, options)?;
    }
    surfaces.into_iter().map(|raw| build(&source.path, name(&raw), format.clone(), raw, geometry, options)).collect()
}

/// Writes a horizon under a temporary name, then renames the file. A rotated grid is resampled for formats
/// that cannot represent it.
///
/// # Errors
/// [`FormatError::Unsupported`] and [`FormatError::NotRepresentable`] when the format cannot hold the
/// surface; [`FormatError::Io`] when the file cannot be written.
pub fn write_horizon(
    path: &Path,
    horizon: &Horizon,
    geometry: &SurveyGeometry,
    format: Format,
) -> Result<ExportReport, FormatError> {
    write_horizon_as(path, horizon, geometry, format, &ExportOptions::default())
}

/// As [`write_horizon`], with options.
///
/// # Errors
/// As [`write_horizon`].
pub fn write_horizon_as(
    path: &Path,
    horizon: &Horizon,
    geometry: &SurveyGeometry,
    format: Format,
    options: &ExportOptions,
) -> Result<ExportReport, FormatError> {
    let Some(writer) = format.codec().write_horizon else {
        let instead = names(|c| c.write_horizon.is_some());
        return Err(FormatError::Unsupported { format, action: "written", kind: SurfaceKind::Horizon, instead });
    };
    let (horizon, mut notes) = match writer.is_unrotated {
        true => resampling::of(horizon, format, options)?,
        false => (Cow::Borrowed(horizon), Vec::new()),
    };
    let is_map_alone = horizon.any_shape().is_some() && !writer.holds_any_shape;
    write::beside(path, &horizon.name, format, |out| {
        if is_map_alone {
            let why = "it is no map: it has several depths over one place".to_owned();
            return Err(write::WriteFailure::NotRepresentable(why, "write tsurf (triangles) or csv (points)"));
        }
        (writer.write)(out, &horizon, geometry)
    })?;
    notes.extend(write::unpicked(&horizon).map(|share| match writer.tells_quality {
        true => format!("{share}: the column quality says which"),
        false => format!("{share}: the format does not say which nodes; csv does"),
    }));
    let corners = horizon.any_shape().map_or(0, |surface| surface.vertices.len());
    Ok(ExportReport { nodes: horizon.sheets.iter().map(Sheet::node_count).sum::<usize>() + corners, notes })
}

/// Reads the faults of a file as triangulated surfaces: triangles of a TSurf file are kept, sticks are joined
/// by triangles, and a surface is fitted to points.
///
/// # Errors
/// As [`read_horizons`].
pub fn read_fault(
    path: &Path,
    geometry: &SurveyGeometry,
    options: &ImportOptions,
) -> Result<Vec<(Fault, ImportReport)>, FormatError> {
    built(&SourceFile::open(path)?, geometry, options, SurfaceKind::Fault, fault::build)
}

/// The fault surface through sticks (world X, Y and vertical value). It needs two sticks of at least two
/// nodes each; `None` when there are fewer, or when they span no area.
///
/// ```
/// # use glam::DVec3;
/// # use survey::{SurveyGeometry, VerticalUnit};
/// let geometry = SurveyGeometry::regular([11, 11, 101], 25.0, 4.0, VerticalUnit::Metres);
/// let stick = |y: f64| vec![DVec3::new(50.0, y, 100.0), DVec3::new(60.0, y, 300.0)];
/// let fault = files::fault_of_sticks("F1", &[stick(0.0), stick(200.0)], &geometry).unwrap();
/// assert_eq!((fault.mesh.vertices.len(), fault.mesh.triangles.len()), (4, 2));
/// assert!(files::fault_of_sticks("F2", &[stick(0.0)], &geometry).is_none());
/// ```
pub fn fault_of_sticks(name: &str, sticks: &[Vec<DVec3>], geometry: &SurveyGeometry) -> Option<Fault> {
    if sticks.len() < 2 || sticks.iter().any(|stick| stick.len() < 2) {
        return None;
    }
    let mesh = sticks::join(sticks, geometry.metres_per_vertical_unit());
    let has_area = |t: usize| {
        let [a, b, c] = mesh.corners(t);
        (b - a).cross(c - a).length() > 0.0
    };
    let any = (0..mesh.triangles.len()).any(has_area);
    any.then(|| Fault::new(name, mesh))
}

/// The order along strike in which sticks (world, vertical value), of at least one point each, are joined.
pub fn sticks_along_strike(sticks: &[Vec<DVec3>], geometry: &SurveyGeometry) -> Vec<usize> {
    sticks::order(&sticks::metric(sticks, geometry.metres_per_vertical_unit()))
}

/// Writes a fault under a temporary name, then renames the file.
///
/// # Errors
/// As [`write_horizon`].
pub fn write_fault(path: &Path, fault: &Fault, geometry: &SurveyGeometry, format: Format) -> Result<(), FormatError> {
    let Some(writer) = format.codec().write_fault else {
        let instead = names(|c| c.write_fault.is_some());
        return Err(FormatError::Unsupported { format, action: "written", kind: SurfaceKind::Fault, instead });
    };
    write::beside(path, &fault.name, format, |out| writer(out, fault, geometry))
}
