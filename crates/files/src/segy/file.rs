//! An open SEG-Y file with its headers interpreted.

use std::path::{Path, PathBuf};

use glam::DVec2;

use super::bytes::{Bytes, Stamp};
use super::columns::{Columns, HeaderColumn, HeaderLayout};
use super::coordinates::{CoordinatePlace, needs_any_place, scalar_range};
use super::detect::{Detected, detect, fields};
use super::error::{SegyError, SegyProblem};
use super::field_sweep::Sweep;
use super::frame::FileLayout;
use super::header::{Field, Traces, at};
use super::info::{BytePositions, Findings, SegyInfo, corners};
use super::lines::{Flaw, LineLattice, NO_TRACE};
use super::null;
use super::options::{KeptDuplicate, NullAmplitude, SegyOptions, TraceWeight};
use super::text_bytes::NamedBytes;
use super::vertical::{Vertical, coordinate_unit, note_coordinate_unit};
use survey::geometry::{DEFAULT_VELOCITY_M_S, SurveyGeometry};
use survey::progress::Progress;
use survey::remedy::{Note, Setting};

/// Trace weights beyond this are invalid and ignored.
const MAX_WEIGHT: i32 = 50;

/// An open SEG-Y file. Samples are read from the file when they are asked for.
///
/// Where another program shortens the file meanwhile, or its drive is lost, reading ends in an error that names
/// the trace and the byte. [`SegyFile::check_unchanged`] tells whether all that was read belongs together.
#[derive(Debug)]
pub struct SegyFile {
    pub(super) path: PathBuf,
    bytes: Bytes,
    frame: FileLayout,
    info: SegyInfo,
    geometry: SurveyGeometry,
    lattice: LineLattice,
    dead: Vec<bool>,
    shifts: Option<Vec<u32>>,
    /// The amplitude that stands for no data.
    null: Option<f32>,
    /// Trace weighting factors N that apply, by 2^(`factor_2`·N).
    weights: Option<HeaderColumn>,
    factor_2: i32,
}

impl SegyFile {
    /// Opens a file and interprets its headers.
    ///
    /// # Errors
    /// [`SegyError`] when the file is not a post-stack 3D volume.
    pub fn open(path: &Path, options: &SegyOptions, progress: &Progress) -> Result<Self, SegyError> {
        let opened = Bytes::open(path).and_then(|bytes| understand(path, bytes, options, progress));
        opened.map_err(|problem| problem.in_file(path))
    }

    /// Interprets the headers of a file that is held in memory; `path` is named in errors.
    ///
    /// # Errors
    /// As [`SegyFile::open`].
    pub fn from_bytes(
        path: &Path,
        bytes: Vec<u8>,
        options: &SegyOptions,
        progress: &Progress,
    ) -> Result<Self, SegyError> {
        understand(path, Bytes::Held(bytes), options, progress).map_err(|problem| problem.in_file(path))
    }

    /// What the file holds.
    pub fn info(&self) -> &SegyInfo {
        &self.info
    }

    /// Every note whose remedy a user interface may reword.
    pub fn notes_mut(&mut self) -> impl Iterator<Item = &mut Note> {
        let info = &mut self.info;
        info.evidence.iter_mut().chain(&mut info.assumptions).chain(&mut info.warnings)
    }

    /// The survey, in ms or m.
    ///
    /// # Errors
    /// [`SegyProblem::SingleTrace`] for a file of one trace.
    pub fn geometry(&self) -> Result<SurveyGeometry, SegyError> {
        if self.lattice.places() < 2 {
            return Err(SegyProblem::SingleTrace.in_file(&self.path));
        }
        self.geometry.validate().map_err(|e| SegyProblem::Geometry(e).in_file(&self.path))?;
        Ok(self.geometry.clone())
    }

    /// `[inlines, crosslines, samples]`.
    pub fn size(&self) -> [usize; 3] {
        self.geometry.size()
    }

    /// Places of the lattice.
    pub(super) fn places(&self) -> usize {
        self.lattice.places()
    }

    /// Whether a trace that is not flagged dead stands at inline index `x`, crossline index `y`.
    pub fn is_live(&self, x: usize, y: usize) -> bool {
        self.trace_at(x, y).is_some_and(|trace| !self.dead[trace])
    }

    /// Whether the trace of that number in the file, from 0, is flagged dead.
    pub(super) fn is_dead(&self, trace: usize) -> bool {
        self.dead[trace]
    }

    /// Number in the file, from 0, of the trace at inline index `x`, crossline index `y`.
    pub(crate) fn trace_at(&self, x: usize, y: usize) -> Option<usize> {
        let trace = self.lattice.trace_of[x * self.lattice.crosslines.count + y];
        (trace != NO_TRACE).then_some(trace as usize)
    }

    /// Whether samples are multiplied by factors of their traces.
    pub(super) fn is_weighted(&self) -> bool {
        self.weights.is_some()
    }

    /// What the file was like when it was opened; none for a file that is held in memory.
    pub fn stamp(&self) -> Option<Stamp> {
        self.bytes.stamp()
    }

    /// Whether the file still is what it was when it was opened: its length, its time of modification and a
    /// sample of its bytes. Who reads all of it asks afterwards, since samples read before and after a change do
    /// not belong together. Cost: 256 KiB are read.
    ///
    /// # Errors
    /// [`SegyProblem::Changed`].
    pub fn check_unchanged(&self) -> Result<(), SegyError> {
        self.bytes.check_unchanged().map_err(|problem| problem.in_file(&self.path))
    }

    /// Decodes the trace at inline index `x`, crossline index `y` into `out`, whose length must be the count
    /// of samples. Samples that the file does not hold become 0. Null amplitudes are no data and become NaN; so do
    /// infinite values, whose count is returned with that of what is NaN in the file.
    ///
    /// # Errors
    /// [`SegyProblem::Shortened`] and [`SegyProblem::Unreadable`] where the trace cannot be read.
    pub fn read_trace(&self, x: usize, y: usize, out: &mut [f32]) -> Result<usize, SegyError> {
        let Some(trace) = self.trace_at(x, y) else {
            out.fill(0.0);
            return Ok(0);
        };
        let mut non_finite = 0;
        self.read_in_order(&mut [(trace, out)], &mut Vec::new(), |trace, bytes, out| {
            non_finite = self.decode(trace, bytes, out);
        })?;
        Ok(non_finite)
    }

    /// Hands the encoded samples of traces to `take`, with the number of the trace in the file and what belongs
    /// to it. `traces` are in the order of the file; neighbours are read at once, by way of `room`.
    pub(super) fn read_in_order<T>(
        &self,
        traces: &mut [(usize, T)],
        room: &mut Vec<u8>,
        mut take: impl FnMut(usize, &[u8], &mut T),
    ) -> Result<(), SegyError> {
        let all = self.frame.traces(&self.bytes);
        let mut rest = traces;
        while let Some(&(first, _)) = rest.first() {
            let neighbours = rest.iter().zip(first..first + all.together());
            let count = neighbours.take_while(|((trace, _), expected)| trace == expected).count();
            let (run, after) = rest.split_at_mut(count);
            let bytes = all.run(first..first + count, room).map_err(|problem| problem.in_file(&self.path))?;
            for ((trace, own), bytes) in run.iter_mut().zip(bytes.chunks_exact(all.stride)) {
                take(*trace, &bytes[all.header_bytes..], own);
            }
            rest = after;
        }
        Ok(())
    }

    /// Whether a value stands for no data: then samples are floats, of which NaN is none.
    pub(super) fn has_null(&self) -> bool {
        self.null.is_some()
    }

    /// Decodes the samples of a trace, NaN where there are no data; returns how many were NaN or infinite in the file.
    pub(super) fn decode(&self, trace: usize, bytes: &[u8], out: &mut [f32]) -> usize {
        let shift = self.shifts.as_ref().map_or(0, |shifts| shifts[trace] as usize).min(out.len());
        let (before, rest) = out.split_at_mut(shift);
        let recorded = rest.len().min(self.frame.samples);
        let (values, after) = rest.split_at_mut(recorded);
        before.fill(0.0);
        after.fill(0.0);
        self.frame.format.decode(self.frame.sample_order, bytes, values);
        let is_nothing = |value: f32| self.null.is_some_and(|null| null::is_null(value, null));
        let nulls: Vec<usize> = match self.null {
            Some(_) => (0..values.len()).filter(|&n| is_nothing(values[n])).collect(),
            None => Vec::new(),
        };
        if let Some(weights) = &self.weights
            && (1..=MAX_WEIGHT).contains(&weights.at(trace).abs())
        {
            let factor = 2.0_f32.powi(self.factor_2 * weights.at(trace));
            values.iter_mut().for_each(|value| *value *= factor);
        }
        // Without a branch, so that it becomes vector instructions; counting is for the few traces that have
        // any.
        let mut non_finite = 0;
        if values.iter().fold(false, |found, value| found | !value.is_finite()) {
            for value in values.iter_mut().filter(|value| !value.is_finite()) {
                *value = f32::NAN;
                non_finite += 1;
            }
        }
        // A trace that is not live has no data as it is; zeros take no room where it is stored.
        let nothing = if self.is_dead(trace) { 0.0 } else { f32::NAN };
        nulls.into_iter().for_each(|n| values[n] = nothing);
        non_finite
    }
}

fn understand(path: &Path, bytes: Bytes, options: &SegyOptions, progress: &Progress) -> Result<SegyFile, SegyProblem> {
    check_options(options)?;
    let mut findings = Findings::default();
    let frame = FileLayout::read(&bytes, options, &mut findings)?;
    check_bytes(options, frame.header_bytes)?;
    let traces = frame.traces(&bytes);
    let named = NamedBytes::find(frame.text.iter().chain(&frame.extended_text));
    let wanted = wanted_fields(options, HeaderLayout { bytes: frame.header_bytes, named });
    let columns = Columns::read(&traces, &wanted, None, named, progress)?;
    let count = traces.count;

    let mut dead = dead_traces(&columns, count, &mut findings);
    let null = null_amplitude(&frame, &traces, options, &mut dead, &mut findings)?;
    let every_field = |sweep: Sweep| Columns::read(&traces, &wanted, Some(sweep), named, progress);
    let mut detected = if count == 1 {
        single_trace(&columns, options)?
    } else {
        detect(&columns, &every_field, options, &mut findings)?
    };
    let vertical = Vertical::find(&frame, &columns, &dead, options, &mut findings)?;
    let unit = coordinate_unit(&frame, options);
    // Coordinates may number the lines, but line numbers are no coordinates.
    let lines = detected.bytes.unwrap_or_default();
    let columns = match detected.columns.take() {
        Some(swept) => *swept,
        None if needs_any_place(&detected.lattice, lines, &columns, options) => every_field(Sweep::FourBytes)?,
        None => columns,
    };
    let place = CoordinatePlace::find(&detected.lattice, lines, &columns, unit, options, &mut findings)?;
    if place.bytes.is_some() {
        note_coordinate_unit(&frame, options, &mut findings);
    }
    note_lattice(&detected, options, &mut findings);
    let weights = weights(&columns, options, &mut findings);
    let factor_2 = if options.trace_weight == TraceWeight::Inverse { 1 } else { -1 };

    let lattice = detected.lattice;
    let metres = unit.metres();
    let geometry = SurveyGeometry {
        inlines: lattice.inlines,
        crosslines: lattice.crosslines,
        vertical: vertical.axis(),
        origin: DVec2::from(place.summary.origin) * metres,
        inline_vector: DVec2::from(place.summary.inline_vector) * metres,
        crossline_vector: DVec2::from(place.summary.crossline_vector) * metres,
        velocity_m_s: DEFAULT_VELOCITY_M_S,
    };
    let (major, minor) = frame.binary.revision;
    let info = SegyInfo {
        file: path.to_owned(),
        bytes: bytes.len(),
        inlines: lattice.inlines.into(),
        crosslines: lattice.crosslines.into(),
        samples: vertical.samples,
        interval: vertical.interval,
        start: vertical.first,
        vertical_unit: vertical.unit,
        sample_format: frame.format,
        format_code: frame.format.code(),
        traces: count,
        missing_traces: lattice.places() - lattice.filled(),
        dead_traces: dead.iter().filter(|&&dead| dead).count(),
        duplicate_traces: lattice.duplicates,
        sorted_by: if lattice.inline_sorted { "inline" } else { "crossline" },
        byte_positions: BytePositions {
            inline: detected.bytes.map(|bytes| bytes[0]),
            crossline: detected.bytes.map(|bytes| bytes[1]),
            x: place.bytes.map(|bytes| bytes[0]),
            y: place.bytes.map(|bytes| bytes[1]),
        },
        coordinate_unit: unit,
        coordinate_scalar: scalar_range(&columns, options),
        geometry: place.summary,
        corners: corners(&lattice.inlines, &lattice.crosslines, &place.summary),
        revision: format!("{major}.{minor}"),
        byte_order: frame.order,
        polarity_code: frame.binary.polarity,
        text_encoding: frame.encoding,
        text: frame.text.clone(),
        extended_text: frame.extended_text.clone(),
        candidates: detected.candidates,
        evidence: findings.evidence,
        assumptions: findings.assumptions,
        warnings: findings.warnings,
    };
    Ok(SegyFile {
        path: path.to_owned(),
        bytes,
        frame,
        info,
        geometry,
        lattice,
        dead,
        shifts: vertical.shifts,
        null,
        weights,
        factor_2,
    })
}

/// Fields that are read of every file.
fn wanted_fields(options: &SegyOptions, layout: HeaderLayout) -> Vec<Field> {
    let mut wanted = fields(options, layout);
    wanted.extend([Field::I32(at::TRACE_IN_RECORD), Field::I32(at::OFFSET), Field::U16(at::INTERVAL)]);
    let short =
        [at::TRACE_ID, at::COORDINATE_SCALAR, at::COORDINATE_UNIT, at::LAG_A, at::DELAY, at::WEIGHT, at::TIME_SCALAR];
    wanted.extend(short.map(Field::I16));
    wanted
}

/// Whether the stated bytes lie in a trace header of that length.
fn check_bytes(options: &SegyOptions, header_bytes: usize) -> Result<(), SegyProblem> {
    let line = options.line_type.unwrap_or_default().bytes();
    let coordinate = options.coordinate_type.unwrap_or_default().bytes();
    for (setting, byte, length) in [
        (Setting::InlineByte, options.inline_byte, line),
        (Setting::CrosslineByte, options.crossline_byte, line),
        (Setting::XByte, options.x_byte, coordinate),
        (Setting::YByte, options.y_byte, coordinate),
        (Setting::ScalarByte, options.scalar_byte, 2),
    ] {
        let last = header_bytes + 1 - length;
        if let Some(byte) = byte
            && !(1..=last).contains(&usize::from(byte))
        {
            let expected = format!("1 to {last}, the first of {length} bytes in the {header_bytes}-byte trace header");
            return Err(SegyProblem::BadSetting { setting, found: byte.to_string(), expected });
        }
    }
    // X and Y of 2 bytes are read from the 4 bytes that begin there.
    for (setting, byte) in [(Setting::XByte, options.x_byte), (Setting::YByte, options.y_byte)] {
        if let Some(byte) = byte
            && usize::from(byte) + 3 > header_bytes
        {
            let expected = format!("at most {}", header_bytes - 3);
            return Err(SegyProblem::BadSetting { setting, found: byte.to_string(), expected });
        }
    }
    Ok(())
}

fn check_options(options: &SegyOptions) -> Result<(), SegyProblem> {
    match options.bin_m {
        Some(bin) if !(bin > 0.0 && bin.is_finite()) => Err(SegyProblem::BadSetting {
            setting: Setting::Bin,
            found: bin.to_string(),
            expected: "a positive number of metres".to_owned(),
        }),
        _ => Ok(()),
    }
}

fn dead_traces(columns: &Columns, count: usize, findings: &mut Findings) -> Vec<bool> {
    let id = columns.get(Field::I16(at::TRACE_ID));
    if id.constant() == Some(2) {
        findings.warning("every trace is flagged dead (byte 29 is 2); the flag is ignored".to_owned());
        return vec![false; count];
    }
    if id.constant().is_some() {
        return vec![false; count];
    }
    let dead: Vec<bool> = id.iter().map(|id| id == 2).collect();
    let number = dead.iter().filter(|&&dead| dead).count();
    if number > 0 {
        findings.evidence(format!("{number} of {count} traces are flagged dead (byte 29 is 2): they are not live"));
    }
    dead
}

/// The amplitude that stands for no data, stated or found; traces of nothing else become dead.
fn null_amplitude(
    frame: &FileLayout,
    traces: &Traces<'_>,
    options: &SegyOptions,
    dead: &mut [bool],
    findings: &mut Findings,
) -> Result<Option<f32>, SegyProblem> {
    let found = match options.null {
        Some(NullAmplitude::None) => return Ok(None),
        Some(NullAmplitude::At(_)) => None,
        None => null::find(traces, frame.format, frame.sample_order)?,
    };
    let stated = match options.null {
        Some(NullAmplitude::At(value)) => Some(value as f32),
        _ => None,
    };
    let Some(value) = stated.or(found.as_ref().map(|found| found.value)) else { return Ok(None) };
    let empty = null::empty_traces(traces, frame.format, frame.sample_order, value)?;
    let number = empty.iter().filter(|&&empty| empty).count();
    if number < dead.len() {
        dead.iter_mut().zip(&empty).for_each(|(dead, empty)| *dead |= empty);
    }
    let left_out = format!("they are left out, as no data, and {number} traces of nothing else are not live");
    match found {
        None => findings.evidence(format!("amplitudes of {value:e} stand for no data, as stated: {left_out}")),
        Some(found) => findings.assumption(Note::unless(
            format!(
                "amplitudes of {value:e} stand for no data: {} of {} samples that were looked at, in runs of up to {}; \
                 {left_out}",
                found.count, found.samples, found.longest_run
            ),
            Setting::NullAmplitude.stated_as("none"),
        )),
    }
    Ok(Some(value))
}

/// A file of one trace has no lattice; its line numbers are those of the standard, or as stated.
fn single_trace(columns: &Columns, options: &SegyOptions) -> Result<Detected, SegyProblem> {
    let inline_byte = options.inline_byte.unwrap_or(at::INLINE);
    let crossline_byte = options.crossline_byte.unwrap_or(at::CROSSLINE);
    let number_type = options.line_type.unwrap_or_default();
    let [inline, crossline] = [inline_byte, crossline_byte].map(|byte| columns.numbers(byte, number_type));
    let lattice = LineLattice::place(&inline, &crossline, None, KeptDuplicate::First)
        .map_err(|_: Flaw| SegyProblem::NoLineNumbers { tried: Vec::new() })?;
    Ok(Detected { bytes: Some([inline_byte, crossline_byte]), lattice, candidates: Vec::new(), columns: None })
}

fn note_lattice(detected: &Detected, options: &SegyOptions, findings: &mut Findings) {
    let lattice = &detected.lattice;
    let by = if detected.bytes.is_some() { "line numbers" } else { "place" };
    if let Some(example) = lattice.first_duplicate {
        let kept = if options.duplicates == Some(KeptDuplicate::Last) { "last" } else { "first" };
        findings.warning(Note {
            fact: format!(
                "{} traces repeat the {by} of an earlier one (the first is trace {}); the {kept} of each is kept",
                lattice.duplicates,
                example + 1
            ),
            otherwise: options.duplicates.is_none().then(|| Setting::Duplicates.stated_as("last")),
        });
    }
    if lattice.unnumbered > 0 {
        findings.warning(match detected.bytes {
            Some(_) => format!("{} traces have both line numbers 0 and are left out", lattice.unnumbered),
            None => format!("{} traces have no X and Y and are left out", lattice.unnumbered),
        });
    }
    let missing = lattice.places() - lattice.filled();
    if missing > 0 {
        findings.evidence(format!("{missing} of {} places have no trace: they are not live", lattice.places()));
    }
}

fn weights(columns: &Columns, options: &SegyOptions, findings: &mut Findings) -> Option<HeaderColumn> {
    let weights = columns.get(Field::I16(at::WEIGHT));
    let is_used = |weight: i32| (1..=MAX_WEIGHT).contains(&weight.abs());
    if weights.constant().is_some_and(|weight| !is_used(weight)) {
        return None;
    }
    if options.trace_weight == TraceWeight::Ignore || !weights.iter().any(is_used) {
        return None;
    }
    let (sign, others) = match options.trace_weight {
        TraceWeight::Inverse => ("", "apply to divide by 2^N as the standard says, ignore to leave them as stored"),
        _ => ("-", "inverse to multiply by 2^N, ignore to leave them as stored"),
    };
    findings.assumption(Note::unless(
        format!(
            "samples are multiplied by 2^({sign}N), N the trace weight at byte 169, {} to {}",
            weights.range[0], weights.range[1]
        ),
        Setting::TraceWeight.stated_as(others),
    ));
    Some(weights.clone())
}
