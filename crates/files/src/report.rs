//! The report that the user sees after every import: what was read, what was assumed and what was left out.

use super::unit::{ZPositive, ZUnit};
use super::{Format, SurfaceKind};
use serde::Serialize;
use std::fmt;
use std::path::PathBuf;
use survey::geometry::VerticalUnit;
use survey::remedy::Note;

/// The source of a setting.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Provenance {
    /// The user stated it.
    Option,
    /// The file states it, in these words.
    File(String),
    /// It was assumed.
    Assumed,
}

/// A setting with its source.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Settled<T> {
    /// The setting.
    pub value: T,
    /// Its source.
    pub source: Provenance,
}

impl<T> Settled<T> {
    /// The option, otherwise what the file states, otherwise the assumption.
    pub(super) fn of(option: Option<T>, file: Option<(T, String)>, assumed: T) -> Self {
        match (option, file) {
            (Some(value), _) => Self { value, source: Provenance::Option },
            (None, Some((value, evidence))) => Self { value, source: Provenance::File(evidence) },
            (None, None) => Self { value: assumed, source: Provenance::Assumed },
        }
    }
}

impl Provenance {
    fn phrase(&self) -> String {
        match self {
            Self::Option => "as told".into(),
            Self::File(evidence) => format!("the file says {evidence}"),
            Self::Assumed => "assumed".into(),
        }
    }
}

/// How values were placed on nodes.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Gridding {
    /// The file's own regular grid.
    NativeGrid {
        /// Node counts.
        count: [usize; 2],
    },
    /// Every point is a trace of the survey, at this step.
    SurveyTraces {
        /// Traces from node to node along the inline index and the crossline index.
        step: [usize; 2],
    },
    /// The points lie on a lattice of their own.
    InferredLattice {
        /// Node counts.
        count: [usize; 2],
        /// Distance of nodes, m.
        step_m: [f64; 2],
        /// Direction of the first axis, degrees anticlockwise from east.
        rotation_deg: f64,
    },
    /// Scattered points, interpolated onto the survey's traces.
    Interpolated {
        /// Gaps into which a circle of this radius fits without containing a point stay holes, m.
        gap_m: f64,
        /// Number of nodes at a point.
        picked: usize,
        /// Number of nodes between points.
        filled: usize,
    },
    /// Scattered points, fitted fault block by fault block.
    FaultBlocks {
        /// Number of points of each fault block that has any.
        points: Vec<usize>,
        /// Gaps into which a circle of this radius fits without containing a point stay holes, m.
        gap_m: f64,
        /// Number of nodes at a point.
        picked: usize,
        /// Number of nodes between points.
        filled: usize,
    },
    /// Triangles, sampled at the survey's traces.
    Rasterised {
        /// Count of triangles.
        triangles: usize,
    },
    /// Fault sticks, joined by triangles.
    Sticks {
        /// Count of sticks.
        sticks: usize,
    },
    /// Fault points, fitted with a smooth surface over their best plane.
    PlaneFit {
        /// Root mean square distance of the points from the surface, m.
        rms_m: f64,
    },
    /// The file's own triangles.
    NativeMesh,
    /// A horizon that is no height field, as it was given.
    AnyShape {
        /// Count of corners or points.
        corners: usize,
        /// Count of triangles; 0 for points.
        triangles: usize,
    },
}

/// What was read, what was assumed and what was left out.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ImportReport {
    /// The file.
    pub file: PathBuf,
    /// The name of the surface.
    pub kind: SurfaceKind,
    /// Name of the surface.
    pub name: String,
    /// The format.
    pub format: Settled<Format>,
    /// Values read, holes included.
    pub values: usize,
    /// Values that mark a hole: null, NaN or infinite.
    pub nulls: usize,
    /// Number of points beside the survey.
    pub outside_survey: usize,
    /// Number of values above or below the survey.
    pub outside_range: usize,
    /// Lowest and highest value in the file.
    pub range_in_file: [f64; 2],
    /// Lowest and highest value after conversion.
    pub range: [f64; 2],
    /// Unit after conversion.
    pub unit: VerticalUnit,
    /// Unit of the file.
    pub z_unit: Settled<ZUnit>,
    /// Sign of the file.
    pub z_positive: Settled<ZPositive>,
    /// Factor applied before sign and unit.
    pub z_factor: f64,
    /// How values were placed on nodes.
    pub gridding: Gridding,
    /// Number of sheets of the horizon; 1 for a fault.
    pub sheets: usize,
    /// Number of nodes with more than one depth.
    pub multivalued: usize,
    /// What was assumed, each with what to state otherwise.
    pub assumptions: Vec<Note>,
    /// Further facts for the user, one sentence each.
    pub notes: Vec<String>,
    /// What the user should check, one sentence each.
    pub warnings: Vec<Note>,
    /// How many scattered points lie far off a map through their neighbours, and the warning that says so.
    #[serde(skip)]
    pub off_map: Option<(usize, Note)>,
    /// Of the notes and warnings, those about a map through scattered points: they are untrue where the points themselves
    /// become the horizon.
    #[serde(skip)]
    pub of_map: Vec<String>,
}

impl ImportReport {
    /// Every note whose remedy a user interface may reword.
    pub fn notes_mut(&mut self) -> impl Iterator<Item = &mut Note> {
        self.assumptions.iter_mut().chain(&mut self.warnings)
    }
}

impl fmt::Display for ImportReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{} '{}' from {}", self.kind, self.name, self.file.display())?;
        let evidence = match &self.format.source {
            Provenance::File(evidence) => evidence,
            Provenance::Option | Provenance::Assumed => "as told",
        };
        writeln!(f, "  format      {} ({evidence})", self.format.value)?;
        writeln!(f, "  values      {} read, {} null", self.values, self.nulls)?;
        let (file, range) = (self.range_in_file, self.range);
        writeln!(f, "  vertical    {} to {} in the file", file[0], file[1])?;
        writeln!(f, "              {} to {} {} after conversion", range[0], range[1], self.unit.symbol())?;
        writeln!(f, "  unit        {} ({})", self.z_unit.value.symbol(), self.z_unit.source.phrase())?;
        writeln!(f, "  positive    {} ({})", self.z_positive.value.word(), self.z_positive.source.phrase())?;
        if self.z_factor != 1.0 {
            writeln!(f, "  factor      {}", self.z_factor)?;
        }
        writeln!(f, "  nodes       {}", self.gridding)?;
        if self.multivalued > 0 {
            writeln!(f, "  sheets      {}; {} traces have more than one depth", self.sheets, self.multivalued)?;
        }
        if self.outside_survey + self.outside_range > 0 {
            writeln!(
                f,
                "  outside     {} beside the survey, {} above or below it",
                self.outside_survey, self.outside_range
            )?;
        }
        self.assumptions.iter().try_for_each(|note| writeln!(f, "  assumed     {note}"))?;
        self.notes.iter().try_for_each(|note| writeln!(f, "  note        {note}"))?;
        self.warnings.iter().try_for_each(|warning| writeln!(f, "  warning     {warning}"))
    }
}

impl fmt::Display for Gridding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NativeGrid { count } => write!(f, "the file's own grid, {} x {}", count[0], count[1]),
            Self::SurveyTraces { step: [1, 1] } => write!(f, "the survey's traces"),
            Self::SurveyTraces { step } => write!(f, "every {} x {} trace of the survey", step[0], step[1]),
            Self::InferredLattice { count, step_m, rotation_deg } => write!(
                f,
                "a lattice found in the points, {} x {}, {:.3} x {:.3} m, rotated {:.3} degrees",
                count[0], count[1], step_m[0], step_m[1], rotation_deg
            ),
            Self::Interpolated { gap_m, picked, filled } => write!(
                f,
                "scattered points interpolated onto the survey's traces: {picked} at points, {filled} between; \
                 gaps wider than {:.1} m stay holes",
                2.0 * gap_m
            ),
            Self::FaultBlocks { points, gap_m, picked, filled } => {
                let each: Vec<String> = points.iter().map(usize::to_string).collect();
                let blocks = if points.len() == 1 { "" } else { "s" };
                write!(
                    f,
                    "scattered points fitted in {} fault block{blocks} ({} points), with the throw kept along the faults: \
                     {picked} at points, {filled} between; gaps wider than {:.1} m stay holes",
                    points.len(),
                    each.join(", "),
                    2.0 * gap_m
                )
            }
            Self::Rasterised { triangles } => write!(f, "{triangles} triangles sampled at the survey's traces"),
            Self::Sticks { sticks } => write!(f, "{sticks} sticks joined by triangles"),
            Self::PlaneFit { rms_m } => {
                write!(f, "a smooth surface over the best plane, {rms_m:.2} m from the points (RMS)")
            }
            Self::NativeMesh => write!(f, "the file's own triangles"),
            Self::AnyShape { corners, triangles: 0 } => write!(f, "{corners} points of a surface of any shape"),
            Self::AnyShape { triangles, .. } => write!(f, "{triangles} triangles of a surface of any shape"),
        }
    }
}
