//! Problems of SEG-Y files, each described in one sentence that also says what the user can do.

use std::io;
use std::path::{Path, PathBuf};

use super::candidate::Candidate;
use survey::geometry::GeometryError;
use survey::progress::Cancelled;
use survey::remedy::{Remedy, Setting};

/// A SEG-Y file could not be read or written.
#[derive(Debug, thiserror::Error)]
#[error("{}: {problem}", path.display())]
pub struct SegyError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong with it.
    #[source]
    pub problem: SegyProblem,
}

/// What is wrong with a SEG-Y file.
#[derive(Debug, thiserror::Error)]
pub enum SegyProblem {
    /// The operating system refused to open, read or write the file.
    #[error("cannot {doing} ({source}); {hint}")]
    Io {
        /// What was tried.
        doing: &'static str,
        /// What the user can do.
        hint: &'static str,
        /// The system's answer.
        source: io::Error,
    },
    /// The file lost its end while it was read.
    #[error(
        "the file was cut off while it was read: {} is beyond its end ({before} bytes when it was opened, {now} now); import it again when it is whole",
        place(*trace, *byte)
    )]
    Shortened {
        /// Number of the trace that was read, from 1; none for the file headers.
        trace: Option<u64>,
        /// Byte that was read, from 1.
        byte: u64,
        /// Bytes of the file when it was opened.
        before: u64,
        /// Bytes of it that are left.
        now: u64,
    },
    /// A part of the file that the system cannot read, although it is there.
    #[error(
        "{} cannot be read ({source}); check the disk or the network connection, then import the file again",
        place(*trace, *byte)
    )]
    Unreadable {
        /// Number of the trace that was read, from 1; none for the file headers.
        trace: Option<u64>,
        /// Byte that was read, from 1.
        byte: u64,
        /// The system's answer.
        source: io::Error,
    },
    /// Another program wrote to the file, or replaced it, while it was read.
    #[error(
        "the file changed while it was read ({what}), so nothing of it is kept; import it again when no other program writes to it"
    )]
    Changed {
        /// What is different.
        what: String,
    },
    /// The source of the samples failed.
    #[error("the samples to write could not be supplied: {source}")]
    Source {
        /// The supplier's reason.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// Too few bytes for the two file headers and a trace.
    #[error(
        "{bytes} bytes are too few for SEG-Y, whose headers alone take 3600; the file is empty, cut off or something else"
    )]
    TooShort {
        /// Length of the file.
        bytes: u64,
    },
    /// Readable text throughout.
    #[error(
        "this is a text file, not SEG-Y (it begins {beginning:?}); give the binary volume, or load it as a horizon or fault file"
    )]
    IsText {
        /// Its first characters.
        beginning: String,
    },
    /// Traces without a file header.
    #[error(
        "this is a Seismic Unix file ({traces} traces of {samples} samples, without a SEG-Y file header); write it as \
         SEG-Y first (in Seismic Unix: `segyhdrs < in.su | segywrite tape=out.sgy`)"
    )]
    SeismicUnix {
        /// Traces.
        traces: u64,
        /// Samples of each.
        samples: u16,
    },
    /// No valid format code in either byte order.
    #[error(
        "bytes 3225-3226 hold {big} (or {little} in little-endian order), which is no SEG-Y sample format; \
         this is not SEG-Y, or its header is damaged"
    )]
    NotSegy {
        /// The code read big-endian.
        big: u16,
        /// The code read little-endian.
        little: u16,
    },
    /// A format code that exists but is not read here.
    #[error("sample format code {code} ({name}) is not supported; convert the file to IBM or IEEE float (code 1 or 5)")]
    UnsupportedFormat {
        /// The code at byte 3225.
        code: u16,
        /// Its name in the standard.
        name: &'static str,
    },
    /// The integer constant at byte 3297 shows pairwise swapped bytes.
    #[error(
        "the constant at byte 3297 shows that the bytes are swapped in pairs; rewrite the file in big- or little-endian order"
    )]
    PairwiseSwapped,
    /// No sample count in either header.
    #[error("neither byte 3221 nor byte 115 of the first trace gives a sample count; the headers are damaged")]
    NoSampleCount,
    /// Headers without traces.
    #[error("the file ends after its headers, at byte {bytes}; it holds no trace: copy it again from its source")]
    NoTraces {
        /// Length of the file.
        bytes: u64,
    },
    /// The last trace is incomplete.
    #[error(
        "the file is cut off inside trace {trace}: {present} of its {trace_bytes} bytes are there ({samples} \
         samples a trace); copy it again from its source"
    )]
    Truncated {
        /// Number of the incomplete trace, from 1.
        trace: u64,
        /// Bytes of it that are there.
        present: u64,
        /// Bytes a whole trace takes, header included.
        trace_bytes: u64,
        /// Samples per trace.
        samples: usize,
    },
    /// The file announces more traces than it holds.
    #[error(
        "the header announces {announced} traces and the file holds {found}: it is cut off; copy it again from its source"
    )]
    TracesMissing {
        /// The count at byte 3513 (revision 2).
        announced: u64,
        /// Whole traces in the file.
        found: u64,
    },
    /// Trace lengths differ.
    #[error(
        "traces differ in length (trace 1 has {first} samples, trace {trace} has {other}); rewrite the file with a fixed trace length"
    )]
    VariableLength {
        /// Samples of the first trace.
        first: usize,
        /// Number of the first trace that differs, from 1.
        trace: u64,
        /// Its samples.
        other: usize,
    },
    /// No sample interval.
    #[error("neither byte 3217 nor byte 117 gives a sample interval")]
    NoInterval,
    /// A stated value that cannot be used.
    #[error("the value stated is {found}; it must be {expected}")]
    BadSetting {
        /// What was stated.
        setting: Setting,
        /// What was given.
        found: String,
        /// What would do.
        expected: String,
    },
    /// Coordinates are angles.
    #[error(
        "X and Y are in {unit} (byte 89 is {code}), not in a length; project them to metres or feet first, \
         or state a bin size to place the survey without them, or their unit if they are lengths after all"
    )]
    AngularCoordinates {
        /// Byte 89.
        code: i16,
        /// What the code means.
        unit: &'static str,
    },
    /// One trace.
    #[error("the file holds a single trace, not a 3D volume; give the whole volume")]
    SingleTrace,
    /// Traces along one line.
    #[error(
        "this is a 2D line, not a 3D volume: {evidence}; give a 3D volume, or state other header bytes if the lines are numbered elsewhere"
    )]
    TwoDimensional {
        /// Why it was taken for a line.
        evidence: String,
    },
    /// Several traces a bin, or gathers by shot.
    #[error("this is pre-stack data, not a post-stack volume: {evidence}; stack it first")]
    PreStack {
        /// Why it was taken for pre-stack.
        evidence: String,
        /// Whether its traces may be mere repetitions, of which one is to be kept.
        may_repeat: bool,
    },
    /// No header bytes hold line numbers.
    #[error("no trace header bytes hold usable inline and crossline numbers: {}", list(tried))]
    NoLineNumbers {
        /// The pairs that were examined.
        tried: Vec<Candidate>,
    },
    /// No header bytes hold line numbers, and X and Y make no lattice either.
    #[error(
        "no trace header bytes hold usable inline and crossline numbers{}, and X and Y make no lattice that could be numbered: {reason}",
        if tried.is_empty() { String::new() } else { format!(" ({})", list(tried)) }
    )]
    NoLattice {
        /// What is wrong with the lattice.
        reason: String,
        /// The pairs that were examined.
        tried: Vec<Candidate>,
    },
    /// Several readings fit, and nothing decides between them.
    #[error(
        "inline and crossline numbers can be read in {} ways: {}",
        readings.len(),
        readings.iter().map(Candidate::as_choice).collect::<Vec<_>>().join("; or ")
    )]
    AmbiguousLines {
        /// The readings that fit.
        readings: Vec<Candidate>,
    },
    /// The stated bytes hold no lattice.
    #[error("the stated bytes do not hold line numbers: {}; other places: {}", .stated.as_sentence(), list(others))]
    StatedBytes {
        /// What the stated bytes hold.
        stated: Box<Candidate>,
        /// The other pairs that were examined.
        others: Vec<Candidate>,
    },
    /// Start times differ by a fraction of a sample.
    #[error(
        "traces start at times that differ by a fraction of a sample (trace {trace}: {start} against {base}); \
         resample the file to a common start"
    )]
    UnevenStart {
        /// Number of a trace that does not fit, from 1.
        trace: u64,
        /// Its start.
        start: f64,
        /// The earliest start.
        base: f64,
    },
    /// The geometry cannot be used.
    #[error(transparent)]
    Geometry(#[from] GeometryError),
    /// The volume and the geometry differ in size.
    #[error(
        "the volume has {volume:?} samples and the geometry {geometry:?} along inlines, crosslines and depth; they must agree"
    )]
    SizeMismatch {
        /// Size of the volume.
        volume: [usize; 3],
        /// Size of the geometry.
        geometry: [usize; 3],
    },
    /// Something SEG-Y revision 1 cannot hold.
    #[error("SEG-Y revision 1 cannot hold {what} of {value}; {hint}")]
    NotRepresentable {
        /// Which quantity.
        what: &'static str,
        /// Its value.
        value: f64,
        /// What the user can do.
        hint: &'static str,
    },
    /// No live trace to write.
    #[error("the volume has no live trace; there is nothing to write")]
    NothingLive,
    /// Cancelled by the user.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl SegyError {
    /// What to state so that the file is read.
    pub fn remedy(&self) -> Option<Remedy> {
        self.problem.remedy()
    }
}

impl SegyProblem {
    /// What to state so that the file is read, where that may help.
    pub fn remedy(&self) -> Option<Remedy> {
        let bytes = || Remedy::all([Setting::InlineByte.stated(), Setting::CrosslineByte.stated()]);
        Some(match self {
            Self::NotSegy { .. } => Setting::SampleFormat.stated(),
            Self::NoInterval => Setting::Interval.stated(),
            Self::BadSetting { setting, .. } => setting.stated(),
            Self::AngularCoordinates { .. } => {
                Remedy::any([Setting::Bin.stated(), Setting::CoordinateUnit.stated_as("m or ft")])
            }
            Self::TwoDimensional { .. } | Self::NoLineNumbers { .. } | Self::StatedBytes { .. } => bytes(),
            Self::PreStack { may_repeat: true, .. } => Setting::Duplicates.stated_as("first or last"),
            Self::NoLattice { .. } => Remedy::any([bytes(), Setting::LineType.stated()]),
            Self::AmbiguousLines { readings } => Remedy::any(readings.iter().map(Candidate::remedy)),
            _ => return None,
        })
    }

    /// Names the file.
    pub(super) fn in_file(self, path: &Path) -> SegyError {
        SegyError { path: path.to_owned(), problem: self }
    }
}

/// A place in a file: a trace and a byte, both counted from 1.
fn place(trace: Option<u64>, byte: u64) -> String {
    match trace {
        Some(trace) => format!("trace {trace} (from byte {byte})"),
        None => format!("the file header (from byte {byte})"),
    }
}

fn list(candidates: &[Candidate]) -> String {
    if candidates.is_empty() {
        return "nothing varies like line numbers".to_owned();
    }
    candidates.iter().map(Candidate::as_sentence).collect::<Vec<_>>().join("; ")
}
