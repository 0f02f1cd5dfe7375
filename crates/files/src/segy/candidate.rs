//! A pair of header fields that may hold the line numbers, and what was found there.

use super::number_type::NumberType;
use serde::Serialize;
use std::fmt;
use survey::geometry::LineAxis;
use survey::remedy::{Remedy, Setting};

/// The verdict on a pair of fields.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// A lattice of lines.
    Fits,
    /// A lattice, but X and Y are not affine in it.
    ContradictsCoordinates,
    /// Both are 0 throughout.
    AllZero,
    /// The inline number is constant.
    ConstantInline(i32),
    /// The crossline number is constant.
    ConstantCrossline(i32),
    /// The numbers are too large for lines.
    TooLarge,
    /// Too many places are empty.
    Scattered,
    /// Many traces repeat the numbers of another one.
    Repeated,
    /// Every trace has an inline and a crossline number of its own.
    Diagonal,
    /// One of the numbers is different in every trace: it counts traces.
    Counter,
}

/// A pair of trace header bytes that was looked at, and what was found there.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Candidate {
    /// Byte of the inline number.
    pub inline_byte: u16,
    /// Byte of the crossline number.
    pub crossline_byte: u16,
    /// How both are stored.
    pub number_type: NumberType,
    /// The programs that follow this convention; empty if no known convention has these bytes.
    pub convention: &'static str,
    /// The verdict.
    pub verdict: Verdict,
    /// The inlines that it would give.
    pub inlines: Option<LineSummary>,
    /// The crosslines that it would give.
    pub crosslines: Option<LineSummary>,
    /// Share of the lattice's places that hold a trace.
    pub filled: f64,
    /// Share of the traces that repeat a place.
    pub repeated: f64,
    /// Root mean square distance of X and Y from an affine map of the numbers, in bins.
    pub residual_bins: Option<f64>,
    /// 0 to 1: filled × not repeated × agreement with X and Y.
    pub score: f64,
}

impl Candidate {
    /// One clause for a list: `bytes 9 and 21: all zero`.
    pub fn as_sentence(&self) -> String {
        let found = match (self.verdict, &self.inlines, &self.crosslines) {
            (Verdict::AllZero, ..) => "all zero".to_owned(),
            (Verdict::ConstantInline(number), ..) => format!("the inline number is {number} throughout"),
            (Verdict::ConstantCrossline(number), ..) => format!("the crossline number is {number} throughout"),
            (Verdict::TooLarge, ..) => "numbers too large for lines".to_owned(),
            (Verdict::Scattered, ..) => "numbers too scattered for lines".to_owned(),
            (Verdict::Diagonal, ..) => "both numbers are different in every trace".to_owned(),
            (Verdict::Counter, ..) => "one number is different in every trace, and counts traces".to_owned(),
            (Verdict::Repeated, ..) => format!("{:.0} % of the traces repeat a place", 100.0 * self.repeated),
            (verdict, Some(inlines), Some(crosslines)) => {
                let contradiction =
                    if verdict == Verdict::Fits { "" } else { ", but X and Y do not lie on such a lattice" };
                format!(
                    "{} inlines {inlines} by {} crosslines {crosslines}, {:.1} % filled{contradiction}",
                    inlines.count,
                    crosslines.count,
                    100.0 * self.filled
                )
            }
            _ => "nothing".to_owned(),
        };
        format!("bytes {} and {}{}: {found}", self.inline_byte, self.crossline_byte, self.in_type(" as "))
    }

    /// The type of the numbers behind `words`; nothing for the standard's.
    fn in_type(&self, words: &str) -> String {
        if self.number_type == NumberType::I32 { String::new() } else { format!("{words}{}", self.number_type.name()) }
    }

    /// What it gives, in a few words.
    pub(crate) fn as_choice(&self) -> String {
        let size = |lines: &Option<LineSummary>| lines.map_or_else(String::new, |l| format!("{} ({l})", l.count));
        format!(
            "bytes {} and {}{} for {} inlines and {} crosslines",
            self.inline_byte,
            self.crossline_byte,
            self.in_type(" as "),
            size(&self.inlines),
            size(&self.crosslines)
        )
    }

    /// What chooses it.
    pub fn remedy(&self) -> Remedy {
        let bytes =
            [Setting::InlineByte.stated_as(self.inline_byte), Setting::CrosslineByte.stated_as(self.crossline_byte)];
        let own_type =
            (self.number_type != NumberType::I32).then(|| Setting::LineType.stated_as(self.number_type.name()));
        Remedy::all(bytes.into_iter().chain(own_type))
    }

    pub(super) fn fits(&self) -> bool {
        self.verdict == Verdict::Fits
    }

    pub(super) fn swapped(&self) -> Self {
        Self {
            inline_byte: self.crossline_byte,
            crossline_byte: self.inline_byte,
            convention: "",
            inlines: self.crosslines,
            crosslines: self.inlines,
            ..self.clone()
        }
    }
}

/// Numbered lines, as shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct LineSummary {
    /// Number of the first line.
    pub first: i32,
    /// Number of the last line.
    pub last: i32,
    /// Difference between neighbours; negative if the file counts down.
    pub step: i32,
    /// Count of lines, missing ones among them.
    pub count: usize,
}

impl From<LineAxis> for LineSummary {
    fn from(axis: LineAxis) -> Self {
        Self { first: axis.first, last: axis.last(), step: axis.step, count: axis.count }
    }
}

impl fmt::Display for LineSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}..{}", self.first, self.last)?;
        if self.step != 1 && self.count > 1 {
            write!(f, " step {}", self.step)?;
        }
        Ok(())
    }
}
