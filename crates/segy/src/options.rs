//! What the user states about a file that the file itself does not say, or says wrongly.

use serde::{Deserialize, Serialize};

use super::info::{FileUnit, LengthUnit};
use super::number_type::NumberType;
use super::sample::{ByteOrder, SampleFormat};

/// What the trace weighting factor N at byte 169 does. The standard (revisions 1 and 2) calls it 2^−N volts for the
/// least significant bit; some programs multiply by 2^N. Factors beyond ±50 are no weights and are ignored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum TraceWeight {
    /// Samples are multiplied by 2^−N, as the standard says.
    #[default]
    Apply,
    /// Samples are multiplied by 2^N.
    Inverse,
    /// It is ignored.
    Ignore,
}

/// Where the line numbers come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LineSource {
    /// The trace headers; X and Y only where no header holds line numbers.
    #[default]
    Headers,
    /// The lattice that X and Y make, numbered from 1; traces follow one another along inlines.
    Coordinates,
    /// The same with inlines and crosslines exchanged.
    CoordinatesSwapped,
}

/// Which of several traces at one place is kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum KeptDuplicate {
    /// The first in the file.
    #[default]
    First,
    /// The last in the file.
    Last,
}

/// What the user states about a file. Everything left out is found in the file.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SegyOptions {
    /// Trace header byte (from 1) of the inline number.
    pub inline_byte: Option<u16>,
    /// Trace header byte of the crossline number.
    pub crossline_byte: Option<u16>,
    /// How line numbers are stored; 4-byte integers, or what is found where they are none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub line_type: Option<NumberType>,
    /// Where the line numbers come from.
    #[serde(skip_serializing_if = "is_default")]
    pub line_source: LineSource,
    /// Trace header byte of X.
    pub x_byte: Option<u16>,
    /// Trace header byte of Y.
    pub y_byte: Option<u16>,
    /// How X and Y are stored; 4-byte integers, or floats where those are no places on Earth.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub coordinate_type: Option<NumberType>,
    /// Trace header byte of the coordinate scalar, a 2-byte integer; 71.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scalar_byte: Option<u16>,
    /// Coordinate scalar, whatever the file holds: multiplies if positive, divides if negative.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub coordinate_scalar: Option<i16>,
    /// Byte order of all numbers.
    pub byte_order: Option<ByteOrder>,
    /// Sample format, whatever byte 3225 holds.
    pub format: Option<SampleFormat>,
    /// Sample interval in the vertical unit.
    pub interval: Option<f64>,
    /// Value of the first sample in the vertical unit.
    pub start: Option<f64>,
    /// Unit of the vertical axis.
    pub vertical_unit: Option<FileUnit>,
    /// Unit of X and Y.
    pub coordinate_unit: Option<LengthUnit>,
    /// Ignore X and Y, and place the lattice at the origin with square bins of this size in metres.
    pub bin_m: Option<f64>,
    /// What byte 169 does.
    pub trace_weight: TraceWeight,
    /// Which of several traces at one place is kept. Stated, it also lets more than a tenth of the traces repeat.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub duplicates: Option<KeptDuplicate>,
}

fn is_default(source: &LineSource) -> bool {
    *source == LineSource::default()
}
