//! What can be stated about a file that is silent, unclear or wrong about itself, as values: the way out that an error or a note points to.
//!
//! Whoever shows an error has words of its own for what can be stated: an option on the command line, a field in a window. `Display` gives the options.

use serde::{Serialize, Serializer};
use std::fmt;

/// Something that can be stated about a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Setting {
    /// Format of a SEG-Y file's samples.
    SampleFormat,
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
    /// Size of square bins that take the place of X and Y.
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
    /// Which of several traces at one place is kept.
    Duplicates,
    /// What the trace weight does.
    TraceWeight,
    /// Format of a horizon or fault file.
    Format,
    /// What a table's columns hold.
    Columns,
    /// Vertical unit of a horizon or fault.
    ZUnit,
    /// Which way its vertical values grow.
    ZPositive,
    /// Factor on them.
    ZFactor,
    /// Value that marks nodes without data.
    Null,
    /// What places points that have line numbers and X, Y.
    PlaceBy,
    /// Order of a grid's values.
    ValueOrder,
    /// Unit of lengths along a well.
    MdUnit,
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
    /// The option that states it.
    pub fn option(self) -> &'static str {
        match self {
            Self::SampleFormat => "--sample-format",
            Self::Interval => "--interval",
            Self::Start => "--start",
            Self::VerticalUnit => "--vertical-unit",
            Self::CoordinateUnit => "--coordinate-unit",
            Self::CoordinateType => "--coordinate-type",
            Self::Bin => "--bin",
            Self::InlineByte => "--inline-byte",
            Self::CrosslineByte => "--crossline-byte",
            Self::LineType => "--line-type",
            Self::LineNumbers => "--line-numbers",
            Self::XByte => "--x-byte",
            Self::YByte => "--y-byte",
            Self::ScalarByte => "--scalar-byte",
            Self::Duplicates => "--duplicates",
            Self::TraceWeight => "--trace-weight",
            Self::Format => "--format",
            Self::Columns => "--columns",
            Self::ZUnit => "--z-unit",
            Self::ZPositive => "--z-positive",
            Self::ZFactor => "--z-factor",
            Self::Null => "--null",
            Self::PlaceBy => "--place-by",
            Self::ValueOrder => "--value-order",
            Self::MdUnit => "--md-unit",
            Self::Datum => "--kb",
            Self::Head => "--head",
            Self::WellInFile => "--well-in-file",
            Self::Checkshot => "--checkshot",
        }
    }

    /// What follows the option on the command line, where that does not say it.
    fn value_name(self) -> &'static str {
        match self {
            Self::Datum => " M",
            Self::Head => " X,Y",
            Self::WellInFile => " NAME",
            Self::Checkshot => " FILE",
            _ => "",
        }
    }

    /// Stated, whatever the value.
    pub fn stated(self) -> Remedy {
        Remedy { ways: vec![vec![Statement { setting: self, value: None }]] }
    }

    /// Stated with a value, or with one of those that the words name.
    pub fn stated_as(self, value: impl fmt::Display) -> Remedy {
        Remedy { ways: vec![vec![Statement { setting: self, value: Some(value.to_string()) }]] }
    }
}

/// A setting and the value that would do, where it is known.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Statement {
    /// What is stated.
    pub setting: Setting,
    /// The value, in words that name the choice where there is one.
    pub value: Option<String>,
}

/// What to state: any one of these ways will do, and each takes all of its statements.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Remedy {
    /// The ways; none where nothing that can be stated helps.
    pub ways: Vec<Vec<Statement>>,
}

impl Remedy {
    /// All of these together.
    pub fn all(parts: impl IntoIterator<Item = Self>) -> Self {
        Self { ways: vec![parts.into_iter().flat_map(|part| part.ways.into_iter().flatten()).collect()] }
    }

    /// Any of these.
    pub fn any(parts: impl IntoIterator<Item = Self>) -> Self {
        Self { ways: parts.into_iter().flat_map(|part| part.ways).collect() }
    }
}

impl fmt::Display for Statement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.setting.option())?;
        match &self.value {
            Some(value) => write!(f, " {value}"),
            None => f.write_str(self.setting.value_name()),
        }
    }
}

impl fmt::Display for Remedy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (number, way) in self.ways.iter().enumerate() {
            f.write_str(if number == 0 { "" } else { " or " })?;
            for (number, statement) in way.iter().enumerate() {
                f.write_str(if number == 0 { "" } else { " " })?;
                write!(f, "{statement}")?;
            }
        }
        Ok(())
    }
}

/// Something found or assumed, and what states otherwise.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Note {
    /// What was found, in one sentence.
    pub fact: String,
    /// What to state if it is not so.
    pub otherwise: Option<Remedy>,
}

impl Note {
    /// Something that can be stated otherwise.
    pub fn unless(fact: impl Into<String>, otherwise: Remedy) -> Self {
        Self { fact: fact.into(), otherwise: Some(otherwise) }
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
        self.otherwise.iter().try_for_each(|remedy| write!(f, " (if not: {remedy})"))
    }
}

impl Serialize for Note {
    /// The sentence, with the options.
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
        assert_eq!(either.to_string(), "--inline-byte 9 --crossline-byte 21 or --line-numbers");
        assert_eq!(Setting::Head.stated().to_string(), "--head X,Y");
        assert_eq!(Note::unless("so", Setting::MdUnit.stated_as("ft")).to_string(), "so (if not: --md-unit ft)");
        assert_eq!(serde_json::to_string(&Note::from("so")).unwrap(), "\"so\"");
    }
}
