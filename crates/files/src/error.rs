//! Errors of horizon and fault files, with the facts that a user needs to correct them.

use super::{Format, SurfaceKind};
use std::path::PathBuf;
use survey::remedy::{Note, Remedy, Setting};

/// Ranges of X or inline, and of Y or crossline.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HorizontalExtent {
    /// Lowest and highest X (or inline).
    pub first: [f64; 2],
    /// Lowest and highest Y (or crossline).
    pub second: [f64; 2],
}

impl HorizontalExtent {
    /// The smallest extent that contains `points`; infinite and inverted if there are none.
    pub fn of(points: impl IntoIterator<Item = glam::DVec2>) -> Self {
        let none = [f64::INFINITY, f64::NEG_INFINITY];
        points.into_iter().fold(Self { first: none, second: none }, |e, p| Self {
            first: [e.first[0].min(p.x), e.first[1].max(p.x)],
            second: [e.second[0].min(p.y), e.second[1].max(p.y)],
        })
    }
}

/// Why a horizon or fault file was not read or written. No partly written file remains.
#[derive(Debug, thiserror::Error)]
pub enum FormatError {
    /// The file cannot be opened, read or written.
    #[error("cannot {action} {file}: {source}")]
    Io {
        /// "read" or "write".
        action: &'static str,
        /// The file.
        file: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// No format's signature was found.
    #[error("{file}: the format is not recognised ({found})")]
    UnknownFormat {
        /// The file.
        file: PathBuf,
        /// What the file begins with.
        found: String,
        /// Whether it is known what it is.
        is_named: bool,
        /// The formats that can be named.
        known: String,
    },
    /// The format cannot hold this kind of surface, or reading or writing it is not supported.
    #[error("{format} files cannot be {action} as a {kind}; formats that can: {instead}")]
    Unsupported {
        /// The format.
        format: Format,
        /// "read" or "written".
        action: &'static str,
        /// What was wanted.
        kind: SurfaceKind,
        /// The formats that can.
        instead: String,
    },
    /// A line does not have the content that its format requires.
    #[error("{file}, line {line}: expected {expected}, found {found}")]
    Syntax {
        /// The file.
        file: PathBuf,
        /// Line number, from 1; 0 for a binary file.
        line: usize,
        /// What should be there.
        expected: String,
        /// What is there.
        found: String,
    },
    /// The file ends too early or holds too many values.
    #[error("{file}: {what}: expected {expected}, found {found}; the file is truncated or its header is wrong")]
    Length {
        /// The file.
        file: PathBuf,
        /// What was counted.
        what: &'static str,
        /// How many there should be.
        expected: usize,
        /// How many there are.
        found: usize,
    },
    /// Nothing to read.
    #[error("{file} holds no {kind}: {why}")]
    Empty {
        /// The file.
        file: PathBuf,
        /// What was looked for.
        kind: SurfaceKind,
        /// What was found instead.
        why: String,
    },
    /// The columns cannot be identified.
    #[error("{file}: {why}")]
    Columns {
        /// The file.
        file: PathBuf,
        /// What is unclear.
        why: String,
        /// A list of columns that would resolve it.
        example: String,
    },
    /// A surface of that name is not in the file.
    #[error("{file} has no {kind} named '{wanted}'; it has: {available}")]
    NoSuchName {
        /// The file.
        file: PathBuf,
        /// What was looked for.
        kind: SurfaceKind,
        /// The name.
        wanted: String,
        /// The names there are.
        available: String,
    },
    /// The file's vertical unit cannot be converted to the survey's.
    #[error(
        "{file}: the vertical unit is {found} ({evidence}) but the survey is in {survey}; time and depth are not converted into each other"
    )]
    UnitMismatch {
        /// The file.
        file: PathBuf,
        /// Unit of the file.
        found: &'static str,
        /// Where that unit comes from.
        evidence: String,
        /// Unit of the survey.
        survey: &'static str,
    },
    /// No point of the surface lies over the survey.
    #[error(
        "{file}: '{name}' lies outside the survey: its {axes} are {} to {}, {} to {}; the survey's are {} to {}, {} to {}. {hint}",
        found.first[0], found.first[1], found.second[0], found.second[1],
        survey.first[0], survey.first[1], survey.second[0], survey.second[1]
    )]
    OutsideSurvey {
        /// The file.
        file: PathBuf,
        /// The surface.
        name: String,
        /// "X and Y" or "inlines and crosslines".
        axes: &'static str,
        /// Extent of the surface.
        found: Box<HorizontalExtent>,
        /// Extent of the survey.
        survey: Box<HorizontalExtent>,
        /// What may be wrong.
        hint: String,
        /// Whether it would lie over the survey with its first two columns exchanged.
        exchanged: bool,
    },
    /// Most of the surface lies above or below the survey.
    #[error(
        "{file}: '{name}' lies outside the survey's vertical range: it spans {} to {} {unit} after conversion \
         ({outside} of {total} values outside), the survey {} to {} {unit}. {}",
        found[0], found[1], survey[0], survey[1], hint.fact
    )]
    OutsideRange {
        /// The file.
        file: PathBuf,
        /// The surface.
        name: String,
        /// Range after conversion.
        found: Box<[f64; 2]>,
        /// Range of the survey.
        survey: Box<[f64; 2]>,
        /// The survey's unit.
        unit: &'static str,
        /// Number of values outside.
        outside: usize,
        /// Number of values in all.
        total: usize,
        /// The statement that would make it fit.
        hint: Box<Note>,
    },
    /// A value outside the survey's range occurs repeatedly.
    #[error(
        "{file}: '{name}' has the value {value} {count} times, outside the survey's vertical range; it may mark nodes without data"
    )]
    LooksLikeNull {
        /// The file.
        file: PathBuf,
        /// The surface.
        name: String,
        /// The value as it is in the file.
        value: f64,
        /// How often.
        count: usize,
    },
    /// Line numbers and coordinates point to different places of the survey.
    #[error("{file}: '{name}' is {metres:.0} m away when placed by X, Y instead of by inline, crossline (median)")]
    LinesDisagree {
        /// The file.
        file: PathBuf,
        /// The surface.
        name: String,
        /// Median distance.
        metres: f64,
    },
    /// The header of a grid is invalid.
    #[error("{file}: the grid header is unusable: {why}")]
    BadGrid {
        /// The file.
        file: PathBuf,
        /// What is wrong.
        why: String,
    },
    /// The file contradicts itself, or has what its format does not allow.
    #[error("{file} is damaged, or not of its format: {why}")]
    Damaged {
        /// The file.
        file: PathBuf,
        /// What is wrong.
        why: String,
    },
    /// More depths at one place than a horizon has: triangles or points without order.
    #[error(
        "{file}: '{name}' has more than {limit} depths at one place; it is not the surface of a horizon, so add it as a fault or write one surface to a file"
    )]
    Crowded {
        /// The file.
        file: PathBuf,
        /// The horizon.
        name: String,
        /// Most depths at one place.
        limit: usize,
    },
    /// An array has no places, and not the size of the lattice that would give it some.
    #[error(
        "{file}: an array of {} x {} x {} inlines, crosslines and samples has no places, and {}",
        found[0], found[1], found[2], of_lattice(*lattice)
    )]
    OtherLattice {
        /// The file.
        file: PathBuf,
        /// Its inlines, crosslines and samples.
        found: [usize; 3],
        /// Those of the project, if it has a lattice.
        lattice: Option<[usize; 3]>,
    },
    /// What would be made of the file does not fit into memory.
    #[error("{file} cannot be put on the survey: {source}")]
    Memory {
        /// The file.
        file: PathBuf,
        /// How much it would take.
        source: system::memory::NotEnough,
    },
    /// Points and their normals make no surface.
    #[error("{file}: {why}")]
    Normals {
        /// The file.
        file: PathBuf,
        /// What is wrong with them.
        why: String,
    },
    /// There is too little to make a fault.
    #[error("{file}: fault '{name}': {why}")]
    NoSurface {
        /// The file.
        file: PathBuf,
        /// The fault.
        name: String,
        /// What is missing.
        why: String,
    },
    /// The format holds unrotated grids only.
    #[error(
        "'{name}' cannot be written as {format}: its grid is rotated by {degrees:.3} degrees, which irap, csv, \
         opendtect and tsurf can hold"
    )]
    Rotated {
        /// The surface.
        name: String,
        /// The format.
        format: Format,
        /// Angle of the grid's first direction from +X, counterclockwise.
        degrees: f64,
    },
    /// The format cannot represent the surface.
    #[error("'{name}' cannot be written as {format}: {why}; {instead}")]
    NotRepresentable {
        /// The surface.
        name: String,
        /// The format.
        format: Format,
        /// What does not fit.
        why: String,
        /// What to do.
        instead: &'static str,
    },
}

/// What the lattice of a project lacks for an array.
fn of_lattice(lattice: Option<[usize; 3]>) -> String {
    match lattice {
        Some([a, b, c]) => format!("the project has {a} x {b} x {c}: transpose it, or save that part of it"),
        None => "the project has no lattice: create it with one (`create --bounds`, `--size`), or import SEG-Y first"
            .to_owned(),
    }
}

impl FormatError {
    /// What to state so that the file can be read, where that may help.
    pub fn remedy(&self) -> Option<Remedy> {
        Some(match self {
            Self::UnknownFormat { known, .. } => Setting::Format.stated_as(format_args!("({known})")),
            Self::Columns { example, .. } => Setting::Columns.stated_as(example),
            Self::Rotated { .. } => Setting::RotatedGrids.stated_as("resample"),
            Self::UnitMismatch { .. } => Setting::ZUnit.stated(),
            Self::OutsideSurvey { exchanged: true, .. } => Setting::Columns.stated(),
            Self::OutsideRange { hint, .. } => hint.otherwise.clone()?,
            Self::LooksLikeNull { value, .. } => Setting::Null.stated_as(value),
            Self::LinesDisagree { .. } => Setting::PlaceBy.stated_as("lines or xy"),
            _ => return None,
        })
    }
}
