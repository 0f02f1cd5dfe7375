//! What the user states about a file because the file does not say it, or says it wrongly.

use serde::{Deserialize, Serialize};

use super::info::LengthUnit;
use super::number_type::NumberType;
use super::sample::{ByteOrder, SampleFormat};
use crate::unit::ZUnit;

/// What the trace weighting factor N at byte 169 does. The standard (revisions 1 and 2) calls it 2^−N volts
/// for the least significant bit; some programs multiply by 2^N. Factors beyond ±50 are no weights and are
/// ignored.
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

/// The amplitude that stands for no data.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum NullAmplitude {
    /// None does.
    None,
    /// This one.
    At(f64),
}

impl std::str::FromStr for NullAmplitude {
    type Err = ();

    /// A number, or `none`.
    fn from_str(text: &str) -> Result<Self, ()> {
        let text = text.trim();
        if text.eq_ignore_ascii_case("none") {
            return Ok(Self::None);
        }
        text.parse().ok().filter(|number: &f64| number.is_finite()).map(Self::At).ok_or(())
    }
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

/// What the user states about a file. Everything left out is detected in the file.
///
/// ```
/// # use files::segy::SegyOptions;
/// let stated = SegyOptions { inline_byte: Some(9), crossline_byte: Some(21), ..SegyOptions::default() };
/// assert_eq!(stated.x_byte, None);
/// ```
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SegyOptions {
    /// Trace header byte (from 1) of the inline number.
    pub inline_byte: Option<u16>,
    /// Trace header byte of the crossline number.
    pub crossline_byte: Option<u16>,
    /// Number type of line numbers. Default: 4-byte integers, or the type detected where these are not line
    /// numbers.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub line_type: Option<NumberType>,
    /// Where the line numbers come from.
    #[serde(skip_serializing_if = "is_default")]
    pub line_source: LineSource,
    /// Trace header byte of X.
    pub x_byte: Option<u16>,
    /// Trace header byte of Y.
    pub y_byte: Option<u16>,
    /// Number type of X and Y. Default: 4-byte integers, or floats where integers give no position on Earth.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub coordinate_type: Option<NumberType>,
    /// Trace header byte of the coordinate scalar, a 2-byte integer. Default: 71.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scalar_byte: Option<u16>,
    /// Coordinate scalar in place of the file's: it multiplies if positive and divides if negative.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub coordinate_scalar: Option<i16>,
    /// Byte order of all numbers.
    pub byte_order: Option<ByteOrder>,
    /// Sample format in place of the code at byte 3225.
    pub format: Option<SampleFormat>,
    /// Amplitude that stands for no data. Default: found by evidence.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub null: Option<NullAmplitude>,
    /// Sample interval in the vertical unit.
    pub interval: Option<f64>,
    /// Value of the first sample in the vertical unit.
    pub start: Option<f64>,
    /// Unit of the vertical axis.
    pub vertical_unit: Option<ZUnit>,
    /// Unit of X and Y.
    pub coordinate_unit: Option<LengthUnit>,
    /// Size of square bins in metres. When it is stated, X and Y are ignored and the lattice begins at the
    /// origin.
    pub bin_m: Option<f64>,
    /// How the trace weighting factor at byte 169 is applied.
    pub trace_weight: TraceWeight,
    /// Which of several traces at one place is kept. Stated, it also lets more than a tenth of the traces
    /// repeat.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub duplicates: Option<KeptDuplicate>,
}

fn is_default(source: &LineSource) -> bool {
    *source == LineSource::default()
}
