//! Which trace header bytes hold the inline and crossline numbers.
//!
//! A pair of fields is a reading when its numbers make a lattice: both vary, (nearly) no place is held twice,
//! and not too many places are empty; X and Y, where there are any, must then be affine in them. The
//! standard's pair wins when it is a reading. Another known convention is taken when it is the only one, or
//! when X and Y settle it. What is left is an error that lists the readings. Which of two axes is called
//! inline cannot be seen in a file: the convention of the pair decides, and the swapped reading is shown
//! beside it.

use std::borrow::Cow;

use rayon::prelude::*;

use super::SegyOptions;
use super::bins::{self, TraceBins};
use super::candidate::{Candidate, Verdict};
use super::columns::{Columns, HeaderColumn, HeaderLayout};
use super::coordinates::{HOMES, confirm, coordinate_fields, locate, varying as varying_coordinates};
use super::error::SegyProblem;
use super::field_sweep::{MAX_LINE_NUMBER, Sweep};
use super::header::{Field, NO_INTEGER, at};
use super::info::Findings;
use super::lines::{Flaw, LineLattice};
use super::number_type::NumberType;
use super::options::LineSource;
use super::refuse;
use survey::remedy::{Note, Remedy, Setting};

/// Known positions of inline and crossline numbers in the trace header.
const CONVENTIONS: [(u16, u16, &str); 5] = [
    (at::INLINE, at::CROSSLINE, "SEG-Y revision 1"),
    (at::FIELD_RECORD, at::CDP, "OpendTect, Seisworks"),
    (at::TRACE_IN_FILE, at::CDP, "Petrel"),
    (17, at::TRACE_IN_CDP, "Kingdom"),
    (221, 225, "header extension"),
];

/// The name of a pair of bytes that the user stated.
const STATED: &str = "stated";
/// The name of a pair of bytes that the textual header names.
const NAMED: &str = "named by the text header";

/// Fields that may hold line numbers outside the conventions. Not among them: trace counters (1, 5, 13),
/// which make a lattice of any regular file, and coordinates.
const OTHER_LINE_FIELDS: [u16; 15] = [9, 17, 21, 25, 189, 193, 197, 205, 209, 213, 217, 221, 225, 229, 233];

/// Fields that usually count traces along a line: they make a lattice of any regular file.
const COUNTERS: [u16; 2] = [1, 13];

/// Other types of number that writers use, and pairs of 2-byte fields.
const OTHER_TYPES: [NumberType; 4] = [NumberType::I16, NumberType::U16, NumberType::F32, NumberType::Ibm32];
const NARROW_PAIRS: [(u16, u16); 2] = [(189, 191), (181, 183)];

/// Repeated places beyond this share mean that the file is no post-stack volume, or the bytes no line
/// numbers.
const MAX_DUPLICATES: f64 = 0.1;
/// Least share of filled places for a known convention, and for a pair that no convention knows.
const MIN_FILL: f64 = 0.05;
const MIN_FILL_UNKNOWN: f64 = 0.25;
/// The same for a pair that no convention knows in a file without X and Y, which would confirm it.
const MIN_FILL_UNCONFIRMED: f64 = 0.95;

/// So few lines that X and Y contradict may be the traces of one shot point.
const FEW_LINES: usize = 3;

/// The reading that was chosen.
#[derive(Debug)]
pub(super) struct Detected {
    /// Bytes of the line numbers; none if X and Y number the lines.
    pub bytes: Option<[u16; 2]>,
    pub lattice: LineLattice,
    pub candidates: Vec<Candidate>,
    /// Every field, where that had to be read.
    pub columns: Option<Box<Columns>>,
}

/// Fields that detection looks at.
pub(super) fn fields(options: &SegyOptions, layout: HeaderLayout) -> Vec<Field> {
    let conventions = CONVENTIONS.iter().flat_map(|&(inline, crossline, _)| [inline, crossline]);
    let narrow = NARROW_PAIRS.into_iter().flat_map(|(inline, crossline)| [inline, crossline]);
    let mut bytes: Vec<u16> = conventions.chain(narrow).chain(OTHER_LINE_FIELDS).collect();
    bytes.extend(layout.named.lines.into_iter().flatten());
    let stated = [options.inline_byte, options.crossline_byte].into_iter().flatten();
    let mut fields = coordinate_fields(options, layout);
    match options.line_type {
        Some(NumberType::F64) => fields.extend(stated.map(Field::F64)),
        Some(NumberType::I16) => fields.extend(stated.map(Field::I16)),
        Some(NumberType::U16) => fields.extend(stated.map(Field::U16)),
        _ => bytes.extend(stated),
    }
    bytes.sort_unstable();
    bytes.dedup();
    fields.extend(bytes.into_iter().map(Field::I32));
    let mut once: Vec<Field> = Vec::with_capacity(fields.len());
    for field in fields {
        if !once.contains(&field) {
            once.push(field);
        }
    }
    once
}

/// Reads every field of a sweep.
type EveryField<'a> = dyn Fn(Sweep) -> Result<Columns, SegyProblem> + Sync + 'a;

/// Finds the line numbers. `every_field` reads the fields of a sweep; that is done for the few files whose line numbers
/// are at none of the usual places.
pub(super) fn detect(
    columns: &Columns,
    every_field: &EveryField<'_>,
    options: &SegyOptions,
    findings: &mut Findings,
) -> Result<Detected, SegyProblem> {
    let search = FieldSearch { columns, every_field, swept: None, options };
    if options.line_source != LineSource::Headers {
        return match bins::find(columns, options, bins::MIN_FILL_STATED) {
            Ok(bins) => search.by_coordinates(&bins, Vec::new(), findings),
            Err(reason) => Err(SegyProblem::NoLattice { reason, tried: Vec::new() }),
        };
    }
    if let (Some(inline), Some(crossline)) = (options.inline_byte, options.crossline_byte) {
        return search.stated(inline, crossline, findings);
    }
    let is_open = |stated: Option<u16>, byte: u16| stated.is_none_or(|stated| stated == byte);
    let number_type = options.line_type.unwrap_or_default();
    if let Some(named) = search.named(findings) {
        let others = CONVENTIONS.iter().filter(|(i, x, _)| [*i, *x] != [named.inline_byte, named.crossline_byte]);
        let others = others.map(|&(i, x, convention)| search.evaluate([i, x], NumberType::I32, convention, MIN_FILL));
        let candidates = std::iter::once(named.clone()).chain(others).collect();
        return search.choose(&named, candidates, findings);
    }
    let candidates: Vec<Candidate> = CONVENTIONS
        .par_iter()
        .filter(|(i, x, _)| is_open(options.inline_byte, *i) && is_open(options.crossline_byte, *x))
        .map(|&(inline, crossline, convention)| search.evaluate([inline, crossline], number_type, convention, MIN_FILL))
        .collect();
    refuse::pre_stack(columns, options, &candidates)?;
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

struct FieldSearch<'a> {
    columns: &'a Columns,
    every_field: &'a EveryField<'a>,
    /// The sweep that `columns` are of.
    swept: Option<Sweep>,
    options: &'a SegyOptions,
}

impl FieldSearch<'_> {
    fn column(&self, byte: u16) -> &HeaderColumn {
        self.columns.get(Field::I32(byte))
    }

    /// Inline and crossline numbers of a candidate.
    fn numbers(&self, candidate: &Candidate) -> [Cow<'_, HeaderColumn>; 2] {
        [candidate.inline_byte, candidate.crossline_byte].map(|byte| self.columns.numbers(byte, candidate.number_type))
    }

    fn are_same(&self, a: &Candidate, b: &Candidate) -> bool {
        let ([a_inline, a_crossline], [b_inline, b_crossline]) = (self.numbers(a), self.numbers(b));
        a_inline.same_as(&b_inline) && a_crossline.same_as(&b_crossline)
    }

    fn evaluate(
        &self,
        [inline_byte, crossline_byte]: [u16; 2],
        number_type: NumberType,
        convention: &'static str,
        min_fill: f64,
    ) -> Candidate {
        let mut candidate = Candidate {
            inline_byte,
            crossline_byte,
            number_type,
            convention,
            verdict: Verdict::Scattered,
            inlines: None,
            crosslines: None,
            filled: 0.0,
            repeated: 0.0,
            residual_bins: None,
            score: 0.0,
        };
        let [inline, crossline] = self.numbers(&candidate);
        let lattice = match LineLattice::build(&inline, &crossline, self.options.duplicates.unwrap_or_default()) {
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
        let is_large =
            |column: &HeaderColumn| column.range.iter().all(|number| number.unsigned_abs() > MAX_LINE_NUMBER);
        candidate.verdict = if convention != STATED && (is_large(&inline) || is_large(&crossline)) {
            Verdict::TooLarge
        } else if candidate.repeated > MAX_DUPLICATES && self.options.duplicates.is_none() {
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

    /// The reading of the bytes that the textual header names, where it is one and the user states nothing else.
    fn named(&self, findings: &mut Findings) -> Option<Candidate> {
        let bytes = self.columns.layout().named.lines?;
        let options = self.options;
        if options.inline_byte.is_some() || options.crossline_byte.is_some() || options.line_type.is_some() {
            return None;
        }
        let candidate = self.evaluate(bytes, NumberType::I32, NAMED, MIN_FILL);
        if !candidate.fits() {
            // What holds several traces, or none, at a place follows from what is found elsewhere.
            findings.warning(Note::unless(
                format!("the text header names bytes that are not taken: {}", candidate.as_sentence()),
                candidate.remedy(),
            ));
        }
        candidate.fits().then_some(candidate)
    }

    fn stated(&self, inline: u16, crossline: u16, findings: &mut Findings) -> Result<Detected, SegyProblem> {
        let number_type = self.options.line_type.unwrap_or_default();
        let chosen = self.evaluate([inline, crossline], number_type, STATED, 0.0);
        let others = || {
            CONVENTIONS
                .iter()
                .filter(|(i, x, _)| (*i, *x) != (inline, crossline))
                .map(|&(i, x, convention)| self.evaluate([i, x], NumberType::I32, convention, MIN_FILL))
        };
        refuse::pre_stack(self.columns, self.options, std::slice::from_ref(&chosen))?;
        match chosen.verdict {
            Verdict::Fits | Verdict::ContradictsCoordinates => {
                let candidates = std::iter::once(chosen.clone()).chain(others()).collect();
                self.choose(&chosen, candidates, findings)
            }
            _ => {
                let others: Vec<Candidate> = others().collect();
                refuse::two_dimensional(self.columns, self.options, std::slice::from_ref(&chosen))?;
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
        let [inline, crossline] = self.numbers(chosen);
        let lattice = LineLattice::build(&inline, &crossline, self.options.duplicates.unwrap_or_default())
            .map_err(|_| SegyProblem::NoLineNumbers { tried: candidates.clone() })?;
        let known = if chosen.convention.is_empty() { "no convention" } else { chosen.convention };
        findings.evidence(format!("line numbers: {} ({known})", chosen.as_sentence()));
        let swapped = chosen.swapped();
        if chosen.convention.is_empty() && self.options.inline_byte.or(self.options.crossline_byte).is_none() {
            findings.assumption(Note::unless(
                format!(
                    "bytes {} and {} hold the line numbers, where no convention has them: X and Y confirm the lattice; \
                     the lower byte is taken as the inline, as in every convention",
                    chosen.inline_byte, chosen.crossline_byte
                ),
                swapped.remedy(),
            ));
        }
        findings.evidence(Note::unless(
            format!(
                "the file counts {} first; {}: the swapped reading is {}",
                if lattice.inline_sorted { "crosslines" } else { "inlines" },
                match chosen.convention {
                    NAMED => "its text header says which axis is the inline",
                    _ => "no file says which axis is called inline",
                },
                swapped.as_choice()
            ),
            swapped.remedy(),
        ));
        for other in candidates.iter().filter(|c| c.fits() && *c != chosen) {
            findings.evidence(if self.are_same(other, chosen) {
                Note::from(format!("bytes {} and {} hold the same numbers", other.inline_byte, other.crossline_byte))
            } else {
                Note::unless(format!("another reading fits too: {}", other.as_choice()), other.remedy())
            });
        }
        candidates.sort_by(|a, b| b.score.total_cmp(&a.score));
        Ok(Detected { bytes: Some([chosen.inline_byte, chosen.crossline_byte]), lattice, candidates, columns: None })
    }

    /// The lattice of X and Y, where no header numbers lines or the user wants it.
    fn by_coordinates(
        &self,
        bins: &TraceBins,
        mut candidates: Vec<Candidate>,
        findings: &mut Findings,
    ) -> Result<Detected, SegyProblem> {
        let [inline, crossline] = match self.options.line_source {
            LineSource::CoordinatesSwapped => [&bins.along_crossline, &bins.along_inline],
            _ => [&bins.along_inline, &bins.along_crossline],
        };
        let kept = self.options.duplicates.unwrap_or_default();
        let lattice = LineLattice::place(inline, crossline, Some((NO_INTEGER, NO_INTEGER)), kept)
            .map_err(|_| SegyProblem::NoLineNumbers { tried: candidates.clone() })?;
        let repeated = lattice.duplicates as f64 / (lattice.duplicates + lattice.filled()) as f64;
        if repeated > MAX_DUPLICATES && self.options.duplicates.is_none() {
            return Err(refuse::repeated_places(self.columns, &lattice));
        }
        let why = match self.options.line_source {
            LineSource::Headers => "no trace header bytes hold line numbers: ",
            _ => "as stated, ",
        };
        let fact = format!(
            "{why}lines are numbered from 1 along the lattice of X and Y (bytes {} and {}), which {}; {}",
            bins.bytes[0],
            bins.bytes[1],
            bins.fit,
            if bins.is_in_order {
                "traces follow one another along inlines"
            } else {
                "the order of the traces does not tell which axis is the inline"
            },
        );
        let bytes = Remedy::all([Setting::InlineByte.stated(), Setting::CrosslineByte.stated()]);
        let note = Note::unless(fact, Remedy::any([Setting::LineNumbers.stated_as("coordinates-swapped"), bytes]));
        if self.options.line_source == LineSource::Headers {
            findings.assumption(note);
        } else {
            findings.evidence(note);
        }
        candidates.sort_by(|a, b| b.score.total_cmp(&a.score));
        Ok(Detected { bytes: None, lattice, candidates, columns: None })
    }

    /// One of each set of candidates that hold the same numbers.
    fn distinct<'c>(&self, candidates: impl Iterator<Item = &'c Candidate>) -> Vec<Candidate> {
        let mut distinct: Vec<Candidate> = Vec::new();
        for candidate in candidates {
            if !distinct.iter().any(|known| self.are_same(known, candidate)) {
                distinct.push(candidate.clone());
            }
        }
        distinct
    }

    /// No convention fits: other fields, or the reason why the file is no volume.
    fn elsewhere(&self, candidates: Vec<Candidate>, findings: &mut Findings) -> Result<Detected, SegyProblem> {
        if let Err(gathers) = refuse::shot_gathers(self.columns) {
            return self.records_as_lines(candidates, findings).unwrap_or(Err(gathers));
        }
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
            .map(|(inline, crossline)| {
                self.evaluate([inline, crossline], self.options.line_type.unwrap_or_default(), "", MIN_FILL_UNKNOWN)
            })
            .filter(Candidate::fits)
            .collect();
        let fitting = if fitting.is_empty() { self.in_other_types() } else { fitting };
        let fitting = match self.swept {
            Some(sweep) if fitting.is_empty() => self.anywhere(sweep),
            _ => fitting,
        };
        let fitting = if fitting.is_empty() { self.in_place_of_coordinates() } else { fitting };
        let is_contradicted = |candidate: &Candidate| candidate.verdict == Verdict::ContradictsCoordinates;
        if self.swept.is_some() && candidates.iter().any(is_contradicted) {
            // X and Y that no convention has may agree with them.
            let again =
                |c: &Candidate| self.evaluate([c.inline_byte, c.crossline_byte], c.number_type, c.convention, MIN_FILL);
            let again: Vec<Candidate> = candidates.iter().map(again).collect();
            let agreeing = self.distinct(again.iter().filter(|c| c.fits()));
            if let [only] = agreeing.as_slice() {
                return self.choose(&only.clone(), again, findings);
            }
        }
        let next = Sweep::after(self.swept).filter(|_| self.swept.is_none() || !candidates.iter().any(is_contradicted));
        if fitting.is_empty()
            && let Some(sweep) = next
        {
            let columns = (self.every_field)(sweep)?;
            let search = FieldSearch { columns: &columns, swept: Some(sweep), ..*self };
            let mut detected = search.elsewhere(candidates, findings)?;
            detected.columns = detected.columns.or_else(|| Some(Box::new(columns)));
            return Ok(detected);
        }
        let mut readings = self.distinct(fitting.iter());
        // Which of both is the inline cannot be seen. Where that alone is open, the order of the bytes tells, as in every
        // convention; where more is, both are shown.
        let is_confirmed = |reading: &Candidate| reading.residual_bins.is_some();
        let is_open = inline.is_none() && crossline.is_none();
        if is_open && !(readings.len() == 1 && readings.iter().all(is_confirmed)) {
            let both = |reading: &Candidate| match reading.convention {
                "" => vec![reading.clone(), reading.swapped()],
                _ => vec![reading.clone()],
            };
            readings = readings.iter().flat_map(both).collect();
        }
        // Lines that X and Y contradict are still lines, if nothing else is there: coordinates may be wrong.
        let contradicted = candidates.iter().find(|c| is_contradicted(c)).cloned();
        if let Some(reading) = contradicted.as_ref().filter(|_| readings.is_empty())
            && [reading.inlines, reading.crosslines].into_iter().flatten().any(|lines| lines.count <= FEW_LINES)
        {
            refuse::follow_one_line(self.columns, self.options)?;
        }
        readings.splice(0..0, contradicted);
        match readings.as_slice() {
            [] => match bins::find(self.columns, self.options, MIN_FILL_UNKNOWN) {
                Ok(bins) => self.by_coordinates(&bins, candidates, findings),
                Err(reason) => {
                    refuse::two_dimensional(self.columns, self.options, &candidates)?;
                    Err(if reason.is_empty() {
                        SegyProblem::NoLineNumbers { tried: candidates }
                    } else {
                        SegyProblem::NoLattice { reason, tried: candidates }
                    })
                }
            },
            [only] => {
                let chosen = only.clone();
                let is_usual = !chosen.convention.is_empty() && chosen.number_type == NumberType::I32;
                let candidates = if is_usual { candidates } else { readings };
                self.choose(&chosen, candidates, findings)
            }
            _ => Err(SegyProblem::AmbiguousLines { readings }),
        }
    }

    /// Line numbers where X and Y are by convention, whose lattice other fields confirm without a doubt: some writers
    /// exchange the two.
    fn in_place_of_coordinates(&self) -> Vec<Candidate> {
        let options = self.options;
        let is_open = options.inline_byte.or(options.crossline_byte).is_none() && options.line_type.is_none();
        let pairs = HOMES.into_iter().filter(|_| is_open && self.swept == Some(Sweep::FourBytes));
        pairs.filter_map(|pair| self.confirmed(pair, MIN_FILL_UNKNOWN)).collect()
    }

    /// Field records and their traces as lines, where X and Y leave no doubt that they are: those of shots are no lattice.
    fn records_as_lines(
        &self,
        candidates: Vec<Candidate>,
        findings: &mut Findings,
    ) -> Option<Result<Detected, SegyProblem>> {
        let columns = (self.every_field)(Sweep::FourBytes).ok()?;
        let search = FieldSearch { columns: &columns, swept: Some(Sweep::FourBytes), ..*self };
        let chosen = search.confirmed([at::FIELD_RECORD, at::TRACE_IN_RECORD], MIN_FILL_UNCONFIRMED)?;
        let mut detected = search.choose(&chosen, candidates, findings);
        if let Ok(detected) = &mut detected {
            detected.columns = Some(Box::new(columns));
        }
        Some(detected)
    }

    /// A pair of bytes as line numbers, where X and Y leave no doubt that they are.
    fn confirmed(&self, pair: [u16; 2], min_fill: f64) -> Option<Candidate> {
        let candidate = Some(self.evaluate(pair, NumberType::I32, "", min_fill)).filter(Candidate::fits)?;
        let [inline, crossline] = self.numbers(&candidate);
        let lattice = LineLattice::build(&inline, &crossline, self.options.duplicates.unwrap_or_default()).ok()?;
        confirm(&lattice, pair, self.columns, self.options).then_some(candidate)
    }

    /// Any two fields whose lattice X and Y confirm; those that count traces only where nothing else is found. Without X
    /// and Y, lattices that are nearly full.
    fn anywhere(&self, sweep: Sweep) -> Vec<Candidate> {
        if self.options.line_type.is_some() {
            return Vec::new();
        }
        let fitting = sweep.types().iter().map(|number_type| self.of_type(sweep, *number_type));
        fitting.into_iter().find(|fitting| !fitting.is_empty()).unwrap_or_default()
    }

    /// The same among fields of one type.
    fn of_type(&self, sweep: Sweep, number_type: NumberType) -> Vec<Candidate> {
        let varying = sweep.line_fields(self.columns, number_type);
        let pairs: Vec<[u16; 2]> = match (self.options.inline_byte, self.options.crossline_byte) {
            (Some(inline), _) => {
                varying.iter().filter(|&&other| other != inline).map(|&other| [inline, other]).collect()
            }
            (None, Some(crossline)) => {
                varying.iter().filter(|&&other| other != crossline).map(|&other| [other, crossline]).collect()
            }
            (None, None) => {
                varying.iter().enumerate().flat_map(|(n, &a)| varying[n + 1..].iter().map(move |&b| [a, b])).collect()
            }
        };
        let evaluated = pairs.into_par_iter().map(|pair| self.evaluate(pair, number_type, "", MIN_FILL_UNKNOWN));
        let fitting: Vec<Candidate> = evaluated.filter(Candidate::fits).collect();
        let counters = |candidate: &Candidate| {
            [candidate.inline_byte, candidate.crossline_byte].iter().filter(|byte| COUNTERS.contains(byte)).count()
        };
        let confirmed = || fitting.iter().filter(|candidate| candidate.residual_bins.is_some());
        let fewest = confirmed().map(counters).min();
        match fewest {
            Some(fewest) => confirmed().filter(|candidate| counters(candidate) == fewest).cloned().collect(),
            None if varying_coordinates(self.columns, self.options).is_some() => Vec::new(),
            None => {
                let is_full =
                    |candidate: &Candidate| candidate.filled >= MIN_FILL_UNCONFIRMED && counters(candidate) == 0;
                fitting.into_iter().filter(is_full).collect()
            }
        }
    }

    /// The conventions' fields read as 2-byte integers and floats.
    fn in_other_types(&self) -> Vec<Candidate> {
        if self.options.line_type.is_some() {
            return Vec::new();
        }
        let is_open = |stated: Option<u16>, byte: u16| stated.is_none_or(|stated| stated == byte);
        let pairs = CONVENTIONS.iter().copied().chain(NARROW_PAIRS.map(|(i, x)| (i, x, "2-byte fields")));
        let open: Vec<(u16, u16, &'static str)> = pairs
            .filter(|(i, x, _)| is_open(self.options.inline_byte, *i) && is_open(self.options.crossline_byte, *x))
            .collect();
        let candidates = OTHER_TYPES.into_iter().flat_map(|number_type| {
            open.iter().map(move |&(inline, crossline, convention)| (inline, crossline, number_type, convention))
        });
        candidates
            .map(|(inline, crossline, number_type, convention)| {
                self.evaluate([inline, crossline], number_type, convention, MIN_FILL)
            })
            .filter(Candidate::fits)
            .collect()
    }
}
