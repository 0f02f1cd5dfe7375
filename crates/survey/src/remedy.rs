//! What a user can state about a file that is silent, ambiguous or wrong about itself. An error or a note
//! carries these values as its suggested remedy.
//!
//! Each user interface has its own words for a setting: an option on the command line, a field in a window.
//! It puts them in with [`Note::reword`]; `Display` here names the settings in plain English.

use serde::{Serialize, Serializer};
use std::fmt;

/// A property of a file that the user can state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Setting {
    /// Format of a SEG-Y file's samples.
    SampleFormat,
    /// Amplitude that stands for no data.
    NullAmplitude,
    /// Sample interval.
    Interval,
    /// Value of the first sample.
    Start,
    /// Unit of a volume's vertical axis.
    VerticalUnit,
    /// Unit of X and Y.
    CoordinateUnit,
    /// How X and Y are stored.
    CoordinateType,
    /// Size of the square bins that replace X and Y.
    Bin,
    /// Header byte of the inline number.
    InlineByte,
    /// Header byte of the crossline number.
    CrosslineByte,
    /// How line numbers are stored.
    LineType,
    /// Where line numbers come from.
    LineNumbers,
    /// Header byte of X.
    XByte,
    /// Header byte of Y.
    YByte,
    /// Header byte of the coordinate scalar.
    ScalarByte,
    /// The coordinate scalar itself.
    CoordinateScalar,
    /// Which of several traces at one place is kept.
    Duplicates,
    /// How the trace weight is applied.
    TraceWeight,
    /// Format of a horizon or fault file.
    Format,
    /// Content of a table's columns.
    Columns,
    /// Vertical unit of a horizon or fault.
    ZUnit,
    /// Direction in which its vertical values grow.
    ZPositive,
    /// Factor on its vertical values.
    ZFactor,
    /// Value that marks nodes without data.
    Null,
    /// Whether line numbers or X, Y place points that have both.
    PlaceBy,
    /// Whether a horizon is a map or of any shape.
    Shape,
    /// Order of a grid's values.
    ValueOrder,
    /// Unit of lengths along a well.
    MdUnit,
    /// Unit of X and Y of a horizon, a fault or a well.
    XyUnit,
    /// What is done with a rotated grid that a format cannot hold.
    RotatedGrids,
    /// Height of a well's datum.
    Datum,
    /// X and Y of a well's head.
    Head,
    /// A well's name in a file of several.
    WellInFile,
    /// A well's time–depth table.
    Checkshot,
}

impl Setting {
    /// What it is called, in a few words.
    pub fn name(self) -> &'static str {
        match self {
            Self::SampleFormat => "sample format",
            Self::NullAmplitude => "null amplitude",
            Self::Interval => "sample interval",
            Self::Start => "first sample",
            Self::VerticalUnit => "vertical unit",
            Self::CoordinateUnit => "unit of X and Y",
            Self::CoordinateType => "type of X and Y",
            Self::Bin => "size of square bins",
            Self::InlineByte => "inline byte",
            Self::CrosslineByte => "crossline byte",
            Self::LineType => "type of line numbers",
            Self::LineNumbers => "source of line numbers",
            Self::XByte => "X byte",
            Self::YByte => "Y byte",
            Self::ScalarByte => "coordinate scalar byte",
            Self::CoordinateScalar => "coordinate scalar",
            Self::Duplicates => "repeated traces",
            Self::TraceWeight => "trace weight",
            Self::Format => "format",
            Self::Columns => "columns",
            Self::ZUnit => "vertical unit",
            Self::ZPositive => "sign of depths",
            Self::ZFactor => "factor on depths",
            Self::Null => "value of holes",
            Self::PlaceBy => "placement",
            Self::Shape => "shape",
            Self::ValueOrder => "order of values",
            Self::MdUnit => "unit along the well",
            Self::XyUnit => "unit of X and Y",
            Self::RotatedGrids => "rotated grids",
            Self::Datum => "datum above sea level",
            Self::Head => "X and Y of the head",
            Self::WellInFile => "name in the file",
            Self::Checkshot => "checkshots",
        }
    }

    /// The remedy of stating this setting, with a value that the user knows.
    pub fn stated(self) -> Remedy {
        Remedy { ways: vec![vec![Statement { setting: self, value: None }]] }
    }

    /// The remedy of stating this setting with `value`, which may name several choices in words (`m or ft`).
    pub fn stated_as(self, value: impl fmt::Display) -> Remedy {
        Remedy { ways: vec![vec![Statement { setting: self, value: Some(value.to_string()) }]] }
    }
}

/// A setting, and a suitable value where one is known.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Statement {
    /// What is stated.
    pub setting: Setting,
    /// The value; words that name the choices where there are several.
    pub value: Option<String>,
}

/// What the user can state: any one of these ways is enough, and each way needs all of its statements.
///
/// ```
/// # use survey::{Remedy, Setting};
/// let coordinates = Remedy::all([Setting::XByte.stated_as(73), Setting::YByte.stated_as(77)]);
/// let either = Remedy::any([coordinates, Setting::Bin.stated()]);
/// assert_eq!(either.ways.len(), 2);
/// assert_eq!(either.to_string(), "X byte 73 and Y byte 77, or size of square bins");
/// ```
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Remedy {
    /// The ways; empty where no statement helps.
    pub ways: Vec<Vec<Statement>>,
}

impl Remedy {
    /// A remedy that needs all of these statements.
    pub fn all(parts: impl IntoIterator<Item = Self>) -> Self {
        Self { ways: vec![parts.into_iter().flat_map(|part| part.ways.into_iter().flatten()).collect()] }
    }

    /// A remedy that needs any one of these.
    pub fn any(parts: impl IntoIterator<Item = Self>) -> Self {
        Self { ways: parts.into_iter().flat_map(|part| part.ways).collect() }
    }
}

impl fmt::Display for Statement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.setting.name())?;
        self.value.iter().try_for_each(|value| write!(f, " {value}"))
    }
}

impl fmt::Display for Remedy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (number, way) in self.ways.iter().enumerate() {
            f.write_str(if number == 0 { "" } else { ", or " })?;
            for (number, statement) in way.iter().enumerate() {
                f.write_str(if number == 0 { "" } else { " and " })?;
                write!(f, "{statement}")?;
            }
        }
        Ok(())
    }
}

/// Something found or assumed, and what to state if it is wrong.
///
/// ```
/// # use survey::{Note, Setting};
/// let note = Note::unless("the interval is 4 ms", Setting::Interval.stated());
/// assert_eq!(note.to_string(), "the interval is 4 ms (if not, state: sample interval)");
/// assert_eq!(Note::from("3 traces are dead").to_string(), "3 traces are dead");
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Note {
    /// What was found, in one sentence.
    pub fact: String,
    /// What to state if the fact is wrong.
    pub otherwise: Option<Remedy>,
}

impl Note {
    /// A fact that the user can correct.
    pub fn unless(fact: impl Into<String>, otherwise: Remedy) -> Self {
        Self { fact: fact.into(), otherwise: Some(otherwise) }
    }

    /// Says its remedy in the words of a user interface; with no words for it, the fact alone remains.
    pub fn reword(&mut self, words: impl Fn(&Remedy) -> Option<String>) {
        if let Some(words) = self.otherwise.take().and_then(|remedy| words(&remedy)) {
            self.fact += &format!(" (if not: {words})");
        }
    }
}

impl<S: Into<String>> From<S> for Note {
    fn from(fact: S) -> Self {
        Self { fact: fact.into(), otherwise: None }
    }
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.fact)?;
        self.otherwise.iter().try_for_each(|remedy| write!(f, " (if not, state: {remedy})"))
    }
}

impl Serialize for Note {
    /// Serializes the sentence that `Display` gives.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ways_and_their_statements_are_told_apart() {
        let bytes = Remedy::all([Setting::InlineByte.stated_as(9), Setting::CrosslineByte.stated_as(21)]);
        let either = Remedy::any([bytes, Setting::LineNumbers.stated()]);
        assert_eq!(either.to_string(), "inline byte 9 and crossline byte 21, or source of line numbers");
        assert_eq!(Setting::Head.stated().to_string(), "X and Y of the head");
        let mut note = Note::unless("so", Setting::MdUnit.stated_as("ft"));
        assert_eq!(note.to_string(), "so (if not, state: unit along the well ft)");
        note.reword(|remedy| Some(format!("in {} way", remedy.ways.len())));
        assert_eq!(note.to_string(), "so (if not: in 1 way)");
        let mut speechless = Note::unless("so", Setting::Null.stated());
        speechless.reword(|_| None);
        assert_eq!(speechless.to_string(), "so");
        assert_eq!(serde_json::to_string(&Note::from("so")).unwrap(), "\"so\"");
    }
}
