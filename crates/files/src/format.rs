//! The formats: their names, and what can be read and written in each.

use super::FormatError;
use super::raw::{RawSurface, ReadContext};
use super::text::SourceFile;
use super::write;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::io::Write;
use survey::fault::Fault;
use survey::geometry::SurveyGeometry;
use survey::horizon::Horizon;

/// A file format of horizons or faults.
///
/// ```
/// # use files::Format;
/// assert_eq!(Format::from_name("TSurf"), Some(Format::Tsurf));
/// assert!(Format::all().all(|format| Format::from_name(format.name()) == Some(format)));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Format {
    /// CSV or XYZ, with or without a header line.
    Csv,
    /// Irap classic ASCII grid.
    Irap,
    /// OpendTect ASCII horizons and fault sticks.
    OpendTect,
    /// GOCAD TSurf.
    Tsurf,
    /// Irap binary grid.
    #[serde(rename = "irapbin")]
    IrapBinary,
    /// ZMAP+ grid.
    Zmap,
    /// CPS-3 ASCII grid.
    Cps3,
    /// EarthVision ASCII points.
    EarthVision,
    /// Petrel points with attributes.
    Petrel,
    /// Charisma horizon lines and fault sticks.
    Charisma,
    /// IJXYZ of OpenWorks.
    Ijxyz,
    /// PetroMod binary map.
    PetroMod,
    /// GeoFrame IESX (3d_ci7m).
    Iesx,
    /// DUG Insight points.
    Dug,
    /// ZMAP+ points and polygons.
    ZmapPoints,
    /// DXF drawings.
    Dxf,
    /// Esri ASCII grid.
    Esri,
    /// Surfer grids: ASCII, binary 6 and 7.
    Surfer,
    /// GeoJSON lines and points.
    GeoJson,
    /// Wavefront OBJ meshes.
    Obj,
    /// STL meshes, text and binary.
    Stl,
    /// GeoTIFF grids of one band.
    GeoTiff,
    /// NumPy arrays.
    Npy,
    /// Geosoft's grid exchange format.
    Gxf,
    /// Classic NetCDF grids.
    NetCdf,
    /// Shapefiles of lines and points.
    Shapefile,
    /// GeoPackages of lines and points.
    GeoPackage,
}

/// The kind of surface that a file holds, or that is to be read from it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SurfaceKind {
    /// A horizon.
    Horizon,
    /// A fault.
    Fault,
}

impl fmt::Display for SurfaceKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Horizon => "horizon",
            Self::Fault => "fault",
        })
    }
}

type Reader = fn(&SourceFile, &ReadContext<'_>) -> Result<Vec<RawSurface>, FormatError>;
type WriteHorizon = fn(&mut dyn Write, &Horizon, &SurveyGeometry) -> Result<(), write::WriteFailure>;
type FaultWriter = fn(&mut dyn Write, &Fault, &SurveyGeometry) -> Result<(), write::WriteFailure>;

/// How a format writes horizons.
#[derive(Clone, Copy)]
pub(super) struct HorizonWriter {
    pub write: WriteHorizon,
    /// Whether its grids lie along X and Y: others are resampled.
    pub is_unrotated: bool,
    /// Whether it holds horizons that are no maps, with several depths over one place.
    pub holds_any_shape: bool,
    /// Whether it says which nodes were filled or extrapolated.
    pub tells_quality: bool,
}

impl HorizonWriter {
    /// Of maps on grids of any direction.
    pub(crate) const fn of(write: WriteHorizon) -> Self {
        Self { write, is_unrotated: false, holds_any_shape: false, tells_quality: false }
    }
}

/// The capabilities of a format.
pub(super) struct Codec {
    pub format: Format,
    /// The word of the `--format` option.
    pub name: &'static str,
    /// The usual extension.
    pub extension: &'static str,
    /// The evidence that a file is of this format.
    pub detect: fn(&SourceFile) -> Option<String>,
    pub read_horizon: Option<Reader>,
    pub read_fault: Option<Reader>,
    pub write_horizon: Option<HorizonWriter>,
    pub write_fault: Option<FaultWriter>,
}

impl Codec {
    /// A format that is only recognised.
    pub(crate) const fn of(
        format: Format,
        name: &'static str,
        extension: &'static str,
        detect: fn(&SourceFile) -> Option<String>,
    ) -> Self {
        let (read_horizon, read_fault, write_horizon, write_fault) = (None, None, None, None);
        Self { format, name, extension, detect, read_horizon, read_fault, write_horizon, write_fault }
    }
}

/// Every format, in the order in which signatures are tried: those that cannot be mistaken first.
pub(super) const CODECS: &[Codec] = &[
    super::tsurf::CODEC,
    super::irap_binary::CODEC,
    super::petromod::CODEC,
    super::surfer::CODEC,
    super::npy::CODEC,
    super::netcdf::CODEC,
    super::geotiff::CODEC,
    super::shapefile::CODEC,
    super::geopackage::CODEC,
    super::stl::CODEC,
    super::esri::CODEC,
    super::gxf::CODEC,
    super::obj::CODEC,
    super::geojson::CODEC,
    super::irap::CODEC,
    super::cps3::CODEC,
    super::zmap::CODEC,
    super::zmap_points::CODEC,
    super::petrel::CODEC,
    super::charisma::CODEC,
    super::earthvision::CODEC,
    super::iesx::CODEC,
    super::dug::CODEC,
    super::dxf::CODEC,
    super::ijxyz::CODEC,
    super::opendtect::CODEC,
    super::csv::CODEC,
];

impl Format {
    pub(super) fn codec(self) -> &'static Codec {
        // Every variant has its line in the table, which a test verifies.
        CODECS.iter().find(|c| c.format == self).unwrap_or(&super::csv::CODEC)
    }

    /// Every format.
    pub fn all() -> impl Iterator<Item = Self> {
        CODECS.iter().map(|c| c.format)
    }

    /// The word for the format, as options and reports have it.
    pub fn name(self) -> &'static str {
        self.codec().name
    }

    /// The usual extension of its files, without the dot.
    pub fn extension(self) -> &'static str {
        self.codec().extension
    }

    /// Whether surfaces of that kind can be written in it.
    pub fn writes(self, kind: SurfaceKind) -> bool {
        match kind {
            SurfaceKind::Horizon => self.codec().write_horizon.is_some(),
            SurfaceKind::Fault => self.codec().write_fault.is_some(),
        }
    }

    /// Whether a horizon's file in it says which nodes were filled or extrapolated.
    pub fn tells_quality(self) -> bool {
        self.codec().write_horizon.is_some_and(|writer| writer.tells_quality)
    }

    /// The format of that word.
    pub fn from_name(name: &str) -> Option<Self> {
        CODECS.iter().find(|c| c.name.eq_ignore_ascii_case(name)).map(|c| c.format)
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The names of formats, for sentences.
pub(super) fn names(select: impl Fn(&Codec) -> bool) -> String {
    CODECS.iter().filter(|c| select(c)).map(|c| c.name).collect::<Vec<_>>().join(", ")
}
