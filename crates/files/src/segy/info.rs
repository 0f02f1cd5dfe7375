//! The description of a SEG-Y file, for the printed page and for `--json`.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::candidate::{Candidate, LineSummary};
use super::sample::{ByteOrder, SampleFormat};
use super::text::TextEncoding;
use crate::unit::ZUnit;
use survey::geometry::LineAxis;
use survey::remedy::Note;

/// A length or an area in words: two decimals, or three figures where it is less than a tenth.
pub(super) fn in_figures(value: f64) -> String {
    if value >= 0.1 || value <= 0.0 || !value.is_finite() {
        return format!("{value:.2}");
    }
    let decimals = (2.0 - value.log10().floor()).min(12.0) as usize;
    format!("{value:.decimals$}").trim_end_matches('0').to_owned()
}

/// The vertical axis in a unit, in words.
pub(super) fn axis_in(unit: ZUnit) -> &'static str {
    match unit {
        ZUnit::Metres => "depth in metres",
        ZUnit::Feet => "depth in feet",
        ZUnit::SurveyFeet => "depth in US survey feet",
        ZUnit::Kilometres => "depth in kilometres",
        ZUnit::Centimetres => "depth in centimetres",
        ZUnit::Inches => "depth in inches",
        ZUnit::Seconds => "two-way time in s",
        ZUnit::Microseconds => "two-way time in us",
        ZUnit::Milliseconds => "two-way time in ms",
    }
}

/// Unit of X and Y in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum LengthUnit {
    /// Metres.
    #[serde(rename = "m")]
    Metres,
    /// International feet (0.3048 m).
    #[serde(rename = "ft")]
    Feet,
    /// US survey feet (1200/3937 m).
    #[serde(rename = "usft")]
    SurveyFeet,
}

impl LengthUnit {
    /// Every unit.
    pub const ALL: [Self; 3] = [Self::Metres, Self::Feet, Self::SurveyFeet];

    /// That unit, if it is one of X and Y.
    pub(super) fn of(unit: ZUnit) -> Option<Self> {
        Self::ALL.into_iter().find(|length| length.unit() == unit)
    }

    fn unit(self) -> ZUnit {
        match self {
            Self::Metres => ZUnit::Metres,
            Self::Feet => ZUnit::Feet,
            Self::SurveyFeet => ZUnit::SurveyFeet,
        }
    }

    /// `m`, `ft` or `usft`.
    pub fn symbol(self) -> &'static str {
        self.unit().symbol()
    }

    /// Length of the unit in metres.
    pub fn metres(self) -> f64 {
        self.unit().in_survey()
    }
}

/// Where the trace header fields are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct BytePositions {
    /// Inline number; none if X and Y number the lines.
    pub inline: Option<u16>,
    /// Crossline number; none if X and Y number the lines.
    pub crossline: Option<u16>,
    /// X; none if the file has no coordinates.
    pub x: Option<u16>,
    /// Y; none if the file has no coordinates.
    pub y: Option<u16>,
}

/// The place of the lattice in the world, in the file's own length unit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct GeometrySummary {
    /// X and Y of the first inline and crossline.
    pub origin: [f64; 2],
    /// Step from one inline to the next.
    pub inline_vector: [f64; 2],
    /// Step from one crossline to the next.
    pub crossline_vector: [f64; 2],
    /// Root mean square distance of the traces from their place, in bins; none if the place is assumed.
    pub residual_rms_bins: Option<f64>,
    /// Largest such distance.
    pub residual_max_bins: Option<f64>,
}

/// A corner of the lattice.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SurveyCorner {
    /// Inline number.
    pub inline: i32,
    /// Crossline number.
    pub crossline: i32,
    /// X in the file's own length unit.
    pub x: f64,
    /// Y in the file's own length unit.
    pub y: f64,
}

/// The corners in order around the lattice, from the first inline and crossline along the first inline.
pub(super) fn corners(inlines: &LineAxis, crosslines: &LineAxis, place: &GeometrySummary) -> [SurveyCorner; 4] {
    let [last_inline, last_crossline] = [inlines.count.max(1) - 1, crosslines.count.max(1) - 1];
    [(0, 0), (0, last_crossline), (last_inline, last_crossline), (last_inline, 0)].map(|(i, x)| {
        let along = |axis: usize| {
            place.origin[axis] + i as f64 * place.inline_vector[axis] + x as f64 * place.crossline_vector[axis]
        };
        SurveyCorner {
            inline: if i == 0 { inlines.first } else { inlines.last() },
            crossline: if x == 0 { crosslines.first } else { crosslines.last() },
            x: along(0),
            y: along(1),
        }
    })
}

/// The description of a SEG-Y file: what it holds, how that was detected, and what had to be assumed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SegyInfo {
    /// The file.
    pub file: PathBuf,
    /// Its length.
    pub bytes: u64,
    /// Inline numbers.
    pub inlines: LineSummary,
    /// Crossline numbers.
    pub crosslines: LineSummary,
    /// Samples along the vertical axis.
    pub samples: usize,
    /// Sample interval in `vertical_unit`.
    pub interval: f64,
    /// Value of the first sample in `vertical_unit`.
    pub start: f64,
    /// Unit of the vertical axis in the file.
    pub vertical_unit: ZUnit,
    /// Format of the samples.
    pub sample_format: SampleFormat,
    /// Code of the format at byte 3225.
    pub format_code: u16,
    /// Traces in the file.
    pub traces: usize,
    /// Places of the lattice without a trace.
    pub missing_traces: usize,
    /// Traces flagged dead (byte 29 is 2).
    pub dead_traces: usize,
    /// Traces that repeat the place of an earlier one; the first is kept.
    pub duplicate_traces: usize,
    /// Order of the traces: `inline` if crosslines count fastest.
    pub sorted_by: &'static str,
    /// Where the line numbers and coordinates are.
    pub byte_positions: BytePositions,
    /// Unit of X and Y in the file.
    pub coordinate_unit: LengthUnit,
    /// Smallest and largest coordinate scalar at byte 71.
    pub coordinate_scalar: [i32; 2],
    /// The lattice in the world, in `coordinate_unit`.
    pub geometry: GeometrySummary,
    /// Its corners, in order around it.
    pub corners: [SurveyCorner; 4],
    /// `0`, `1.0`, `2.0` or `2.1`.
    pub revision: String,
    /// Byte order of the numbers.
    pub byte_order: ByteOrder,
    /// Impulse polarity code at byte 3257 (0 if the writer left it out); shown, not interpreted.
    pub polarity_code: u16,
    /// Encoding of the textual header.
    pub text_encoding: TextEncoding,
    /// Lines of the textual header.
    pub text: Vec<String>,
    /// Lines of the extended textual headers.
    pub extended_text: Vec<String>,
    /// Readings of the line numbers that were examined, the best first.
    pub candidates: Vec<Candidate>,
    /// The evidence for each detected property.
    pub evidence: Vec<Note>,
    /// Usual values assumed for what the file does not say, each with the option that states another value.
    pub assumptions: Vec<Note>,
    /// Inconsistencies of the file.
    pub warnings: Vec<Note>,
}

/// Notes taken while a file is read.
#[derive(Debug, Clone, Default)]
pub(super) struct Findings {
    pub evidence: Vec<Note>,
    pub assumptions: Vec<Note>,
    pub warnings: Vec<Note>,
}

impl Findings {
    pub(super) fn evidence(&mut self, note: impl Into<Note>) {
        self.evidence.push(note.into());
    }

    pub(super) fn assumption(&mut self, note: impl Into<Note>) {
        self.assumptions.push(note.into());
    }

    pub(super) fn warning(&mut self, note: impl Into<Note>) {
        self.warnings.push(note.into());
    }
}
