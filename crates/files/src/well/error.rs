//! Errors of a well's files, with the facts that a user needs to correct them.

use std::path::PathBuf;
use survey::remedy::{Remedy, Setting};
use survey::well::WellError;

/// Why a well was not read.
#[derive(Debug, thiserror::Error)]
pub enum WellFileError {
    /// A file cannot be read.
    #[error("cannot read {file}: {source}")]
    Io {
        /// The file.
        file: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// A line does not have the required content.
    #[error("{file}, line {line}: expected {expected}, found {found}")]
    Syntax {
        /// The file.
        file: PathBuf,
        /// Line number, from 1.
        line: usize,
        /// What should be there.
        expected: String,
        /// What is there.
        found: String,
    },
    /// The columns do not state where the well is.
    #[error("{file}: {why}; name the columns in a header line, for example {example}")]
    Columns {
        /// The file.
        file: PathBuf,
        /// What is missing.
        why: String,
        /// An example of a header that suffices.
        example: &'static str,
    },
    /// Nothing names the columns, and the numbers do not tell.
    #[error("{file}: no line names the columns, of which each row has {width}")]
    UnnamedColumns {
        /// The file.
        file: PathBuf,
        /// Columns.
        width: usize,
        /// A list of columns as an option gives it.
        example: &'static str,
    },
    /// There are no rows.
    #[error("{file} holds no {what}; check that it is the file meant")]
    Empty {
        /// The file.
        file: PathBuf,
        /// What was looked for.
        what: &'static str,
    },
    /// The well head is not known.
    #[error("{file} gives no X, Y of the well head, in metres")]
    NoHead {
        /// The file.
        file: PathBuf,
    },
    /// A file of several wells contains none of this name.
    #[error("{file} has no well named '{wanted}'; it has: {available}")]
    NoSuchWell {
        /// The file.
        file: PathBuf,
        /// The name.
        wanted: String,
        /// The names there are.
        available: String,
    },
    /// The numbers are not a valid path or time–depth table.
    #[error(transparent)]
    Well(#[from] WellError),
    /// The unit cannot be determined.
    #[error("{file}: {what} could be in {candidates}; say which in its header, for example {header}")]
    UnclearUnit {
        /// The file.
        file: PathBuf,
        /// What has no unit.
        what: String,
        /// Units that would fit.
        candidates: &'static str,
        /// An example of a header that settles it.
        header: &'static str,
    },
    /// A LAS file of a version that is not read.
    #[error("{file} is LAS {version}; LAS 1.2, 2.0 and 3.0 are read: export it as LAS 2.0")]
    LasVersion {
        /// The file.
        file: PathBuf,
        /// Its version.
        version: String,
    },
    /// A LAS file that is incomplete or wrong.
    #[error("{file}: {why}; check that it is a LAS 2.0 file that was copied in full")]
    Las {
        /// The file.
        file: PathBuf,
        /// What is missing or wrong.
        why: String,
    },
    /// The index of a LAS file cannot be placed along the well.
    #[error("{file}: the index {mnemonic} is in '{unit}'; {instead}")]
    LasIndex {
        /// The file.
        file: PathBuf,
        /// The index curve.
        mnemonic: String,
        /// Its unit.
        unit: String,
        /// What to do.
        instead: &'static str,
        /// Whether the well's checkshots would suffice.
        needs_checkshot: bool,
    },
}

impl WellFileError {
    /// What to state so that the well can be read, where that may help.
    pub fn remedy(&self) -> Option<Remedy> {
        Some(match self {
            Self::NoHead { .. } => Setting::Head.stated(),
            Self::UnnamedColumns { example, .. } => Setting::Columns.stated_as(example),
            Self::NoSuchWell { .. } => Setting::WellInFile.stated(),
            Self::Well(error) => return error.remedy(),
            Self::LasIndex { needs_checkshot: true, .. } => Setting::Checkshot.stated(),
            _ => return None,
        })
    }
}
