//! Which trace header bytes hold the inline and crossline numbers.
//!
//! A pair of fields is a reading when its numbers make a lattice: both vary, (nearly) no place is held twice, and not
//! too many places are empty; X and Y, where there are any, must then be affine in them. The standard's pair wins when
//! it is a reading. Another known convention is taken when it is the only one, or when X and Y settle it. What is left
//! is an error that lists the readings. Which of two axes is called inline cannot be seen in a file: the convention of
//! the pair decides, and the swapped reading is shown beside it.

use serde::Serialize;

use super::SegyOptions;
use super::columns::{Column, Columns};
use super::coordinates::{HOMES, locate};
use super::error::SegyProblem;
use super::header::{Field, at};
use super::info::{Findings, LineSummary};
use super::lines::{Flaw, Lattice};
use super::refuse;

/// Known homes of inline and crossline numbers.
const CONVENTIONS: [(u16, u16, &str); 5] = [
    (at::INLINE, at::CROSSLINE, "SEG-Y revision 1"),
    (at::FIELD_RECORD, at::CDP, "OpendTect, Seisworks"),
    (at::TRACE_IN_FILE, at::CDP, "Petrel"),
    (17, at::TRACE_IN_CDP, "Kingdom"),
    (221, 225, "header extension"),
];

/// Fields that may hold line numbers outside the conventions. Not among them: trace counters (1, 5, 13), which make a
/// lattice of any regular file, and coordinates.
const OTHER_LINE_FIELDS: [u16; 15] = [9, 17, 21, 25, 189, 193, 197, 205, 209, 213, 217, 221, 225, 229, 233];

/// Repeated places beyond this share mean that the file is no post-stack volume, or the bytes no line numbers.
const MAX_DUPLICATES: f64 = 0.1;
/// Least share of filled places for a known convention, and for a pair that no convention knows.
const MIN_FILL: f64 = 0.05;
const MIN_FILL_UNKNOWN: f64 = 0.25;

/// What a pair of fields turned out to be.
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
    /// Who writes it so; empty if no convention known here does.
    pub convention: &'static str,
    /// What it is.
    pub verdict: Verdict,
    /// The inlines it would make.
    pub inlines: Option<LineSummary>,
    /// The crosslines it would make.
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
        format!("bytes {} and {}: {found}", self.inline_byte, self.crossline_byte)
    }

    /// The options that choose it, and what it gives.
    pub fn as_choice(&self) -> String {
        let size = |lines: &Option<LineSummary>| lines.map_or_else(String::new, |l| format!("{} ({l})", l.count));
        format!(
            "--inline-byte {} --crossline-byte {} for {} inlines and {} crosslines",
            self.inline_byte,
            self.crossline_byte,
            size(&self.inlines),
            size(&self.crosslines)
        )
    }

    fn fits(&self) -> bool {
        self.verdict == Verdict::Fits
    }

    fn swapped(&self) -> Self {
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

/// The reading that was chosen.
#[derive(Debug)]
pub(super) struct Detected {
    pub inline_byte: u16,
    pub crossline_byte: u16,
    pub lattice: Lattice,
    pub candidates: Vec<Candidate>,
}

/// 4-byte fields that detection looks at.
pub(super) fn fields(options: &SegyOptions) -> Vec<Field> {
    let conventions = CONVENTIONS.iter().flat_map(|&(inline, crossline, _)| [inline, crossline]);
    let coordinates = HOMES.into_iter().flatten();
    let stated = [options.inline_byte, options.crossline_byte, options.x_byte, options.y_byte];
    let mut bytes: Vec<u16> =
        conventions.chain(OTHER_LINE_FIELDS).chain(coordinates).chain(stated.into_iter().flatten()).collect();
    bytes.sort_unstable();
    bytes.dedup();
    bytes.into_iter().map(Field::I32).collect()
}

/// Finds the line numbers.
pub(super) fn detect(
    columns: &Columns,
    options: &SegyOptions,
    findings: &mut Findings,
) -> Result<Detected, SegyProblem> {
    let search = Search { columns, options };
    if let (Some(inline), Some(crossline)) = (options.inline_byte, options.crossline_byte) {
        return search.stated(inline, crossline, findings);
    }
    let is_open = |stated: Option<u16>, byte: u16| stated.is_none_or(|stated| stated == byte);
    let candidates: Vec<Candidate> = CONVENTIONS
        .iter()
        .filter(|(i, x, _)| is_open(options.inline_byte, *i) && is_open(options.crossline_byte, *x))
        .map(|&(inline, crossline, convention)| search.evaluate(inline, crossline, convention, MIN_FILL))
        .collect();
    refuse::pre_stack(columns, &candidates)?;
    let standard = candidates.iter().find(|c| c.inline_byte == at::INLINE && c.crossline_byte == at::CROSSLINE);
    if let Some(standard) = standard.filter(|c| c.fits()) {
        let chosen = standard.clone();
        return search.choose(&chosen, candidates, findings);
    }
    let readings = search.distinct(candidates.iter().filter(|c| c.fits()));
    match readings.as_slice() {
        [only] => {
            let chosen = only.clone();
            if candidates.iter().any(|c| c.verdict == Verdict::ContradictsCoordinates) {
                findings.evidence(format!(
                    "X and Y settle the line numbers: they lie on the lattice of bytes {} and {} alone",
                    chosen.inline_byte, chosen.crossline_byte
                ));
            }
            search.choose(&chosen, candidates, findings)
        }
        [] => search.elsewhere(candidates, findings),
        _ => Err(SegyProblem::AmbiguousLines { readings }),
    }
}

struct Search<'a> {
    columns: &'a Columns,
    options: &'a SegyOptions,
}

impl Search<'_> {
    fn column(&self, byte: u16) -> &Column {
        self.columns.get(Field::I32(byte))
    }

    fn evaluate(&self, inline_byte: u16, crossline_byte: u16, convention: &'static str, min_fill: f64) -> Candidate {
        let (inline, crossline) = (self.column(inline_byte), self.column(crossline_byte));
        let mut candidate = Candidate {
            inline_byte,
            crossline_byte,
            convention,
            verdict: Verdict::Scattered,
            inlines: None,
            crosslines: None,
            filled: 0.0,
            repeated: 0.0,
            residual_bins: None,
            score: 0.0,
        };
        let lattice = match Lattice::build(inline, crossline) {
            Ok(lattice) => lattice,
            Err(flaw) => {
                candidate.verdict = match flaw {
                    Flaw::AllZero => Verdict::AllZero,
                    Flaw::OneInline(number) => Verdict::ConstantInline(number),
                    Flaw::OneCrossline(number) => Verdict::ConstantCrossline(number),
                    Flaw::Scattered(_) => Verdict::Scattered,
                };
                return candidate;
            }
        };
        let filled = lattice.filled();
        let traces = filled + lattice.duplicates + lattice.unnumbered;
        candidate.inlines = Some(lattice.inlines.into());
        candidate.crosslines = Some(lattice.crosslines.into());
        candidate.filled = filled as f64 / lattice.places() as f64;
        candidate.repeated = lattice.duplicates as f64 / traces as f64;
        let placement = locate(&lattice, [inline_byte, crossline_byte], self.columns, self.options);
        candidate.residual_bins = placement.map(|(_, placement)| placement.rms_bins);
        let agreement = match placement {
            Some((_, placement)) if placement.agrees() => 1.0,
            Some(_) => 0.25,
            None => 0.9,
        };
        candidate.score = candidate.filled * (1.0 - candidate.repeated) * agreement;
        let [inlines, crosslines] = lattice.occupied_lines();
        candidate.verdict = if candidate.repeated > MAX_DUPLICATES {
            Verdict::Repeated
        } else if inlines.min(crosslines) == filled {
            Verdict::Diagonal
        } else if inlines.max(crosslines) == filled {
            Verdict::Counter
        } else if candidate.filled < min_fill {
            Verdict::Scattered
        } else if agreement < 0.5 {
            Verdict::ContradictsCoordinates
        } else {
            Verdict::Fits
        };
        candidate
    }

    fn stated(&self, inline: u16, crossline: u16, findings: &mut Findings) -> Result<Detected, SegyProblem> {
        let chosen = self.evaluate(inline, crossline, "stated", 0.0);
        let others = || {
            CONVENTIONS
                .iter()
                .filter(|(i, x, _)| (*i, *x) != (inline, crossline))
                .map(|&(i, x, convention)| self.evaluate(i, x, convention, MIN_FILL))
        };
        refuse::pre_stack(self.columns, std::slice::from_ref(&chosen))?;
        match chosen.verdict {
            Verdict::Fits | Verdict::ContradictsCoordinates => {
                let candidates = std::iter::once(chosen.clone()).chain(others()).collect();
                self.choose(&chosen, candidates, findings)
            }
            _ => {
                let others: Vec<Candidate> = others().collect();
                refuse::two_dimensional(self.columns, std::slice::from_ref(&chosen))?;
                Err(SegyProblem::StatedBytes { stated: Box::new(chosen), others })
            }
        }
    }

    fn choose(
        &self,
        chosen: &Candidate,
        mut candidates: Vec<Candidate>,
        findings: &mut Findings,
    ) -> Result<Detected, SegyProblem> {
        let lattice = Lattice::build(self.column(chosen.inline_byte), self.column(chosen.crossline_byte))
            .map_err(|_| SegyProblem::NoLineNumbers { tried: candidates.clone() })?;
        findings.evidence(format!("line numbers: {} ({})", chosen.as_sentence(), chosen.convention));
        findings.evidence(format!(
            "the file counts {} first; no file says which axis is called inline: the swapped reading is {}",
            if lattice.inline_sorted { "crosslines" } else { "inlines" },
            chosen.swapped().as_choice()
        ));
        for other in candidates.iter().filter(|c| c.fits() && *c != chosen) {
            let is_same = self.column(other.inline_byte).same_as(self.column(chosen.inline_byte))
                && self.column(other.crossline_byte).same_as(self.column(chosen.crossline_byte));
            findings.evidence(if is_same {
                format!("bytes {} and {} hold the same numbers", other.inline_byte, other.crossline_byte)
            } else {
                format!("another reading fits too: {}", other.as_choice())
            });
        }
        candidates.sort_by(|a, b| b.score.total_cmp(&a.score));
        Ok(Detected { inline_byte: chosen.inline_byte, crossline_byte: chosen.crossline_byte, lattice, candidates })
    }

    /// One of each set of candidates that hold the same numbers.
    fn distinct<'c>(&self, candidates: impl Iterator<Item = &'c Candidate>) -> Vec<Candidate> {
        let mut distinct: Vec<Candidate> = Vec::new();
        for candidate in candidates {
            let is_known = distinct.iter().any(|known| {
                self.column(known.inline_byte).same_as(self.column(candidate.inline_byte))
                    && self.column(known.crossline_byte).same_as(self.column(candidate.crossline_byte))
            });
            if !is_known {
                distinct.push(candidate.clone());
            }
        }
        distinct
    }

    /// No convention fits: other fields, or the reason why the file is no volume.
    fn elsewhere(&self, candidates: Vec<Candidate>, findings: &mut Findings) -> Result<Detected, SegyProblem> {
        refuse::shot_gathers(self.columns)?;
        let varying: Vec<u16> =
            OTHER_LINE_FIELDS.into_iter().filter(|&byte| self.column(byte).constant().is_none()).collect();
        let inline = self.options.inline_byte;
        let crossline = self.options.crossline_byte;
        let others = |byte: u16| varying.iter().copied().filter(move |&other| other != byte);
        let pairs: Vec<(u16, u16)> = match (inline, crossline) {
            (Some(inline), _) => others(inline).map(|other| (inline, other)).collect(),
            (None, Some(crossline)) => others(crossline).map(|other| (other, crossline)).collect(),
            (None, None) => {
                varying.iter().flat_map(|&a| others(a).filter(move |&b| a < b).map(move |b| (a, b))).collect()
            }
        };
        let fitting: Vec<Candidate> = pairs
            .into_iter()
            .map(|(inline, crossline)| self.evaluate(inline, crossline, "", MIN_FILL_UNKNOWN))
            .filter(Candidate::fits)
            .collect();
        let mut readings = self.distinct(fitting.iter());
        if inline.is_none() && crossline.is_none() {
            readings = readings.iter().flat_map(|reading| [reading.clone(), reading.swapped()]).collect();
        }
        // Lines that X and Y contradict are still lines, if nothing else is there: coordinates may be wrong.
        let contradicted = candidates.iter().find(|c| c.verdict == Verdict::ContradictsCoordinates).cloned();
        readings.splice(0..0, contradicted);
        match readings.as_slice() {
            [] => {
                refuse::two_dimensional(self.columns, &candidates)?;
                Err(SegyProblem::NoLineNumbers { tried: candidates })
            }
            [only] => {
                let chosen = only.clone();
                let candidates = if chosen.convention.is_empty() { readings } else { candidates };
                self.choose(&chosen, candidates, findings)
            }
            _ => Err(SegyProblem::AmbiguousLines { readings }),
        }
    }
}
