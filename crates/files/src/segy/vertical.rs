//! The vertical axis: sample interval, start, and whether it is time or depth.
//!
//! SEG-Y stores the interval in µs, and by usage in mm (or thousandths of a foot) for depth; it has no field
//! that says which. The textual header usually does.

use super::SegyOptions;
use super::columns::{Columns, HeaderColumn};
use super::error::SegyProblem;
use super::frame::FileLayout;
use super::header::{Field, at};
use super::info::{Findings, LengthUnit, axis_in};
use super::vertical_words::{self, Said, Words};
use crate::unit::ZUnit;
use crate::unit::words::{HeaderUnits, Quantity};
use survey::geometry::{VerticalAxis, VerticalUnit};
use survey::remedy::{Note, Remedy, Setting};

/// Traces that start later than the earliest one may lengthen the volume to this many times their own length.
const MAX_LENGTHENING: usize = 4;

/// The vertical axis in the file's unit.
#[derive(Debug, Clone)]
pub(super) struct Vertical {
    pub first: f64,
    pub interval: f64,
    pub unit: ZUnit,
    /// Samples of the volume: those of a trace, and what later starts add.
    pub samples: usize,
    /// Samples by which each trace starts later than `first`; none if all start together.
    pub shifts: Option<Vec<u32>>,
}

impl Vertical {
    pub(super) fn find(
        frame: &FileLayout,
        columns: &Columns,
        dead: &[bool],
        options: &SegyOptions,
        findings: &mut Findings,
    ) -> Result<Self, SegyProblem> {
        let micro = match options.interval {
            Some(interval) if interval.is_finite() && interval > 0.0 => interval * 1000.0,
            Some(interval) => {
                return Err(SegyProblem::BadSetting {
                    setting: Setting::Interval,
                    found: interval.to_string(),
                    expected: "a positive number".to_owned(),
                });
            }
            None => interval_field(frame, columns, findings)?,
        };
        let delay = columns.get(Field::I16(at::DELAY));
        let start = scaled(delay.constant().unwrap_or(0), columns.get(Field::I16(at::TIME_SCALAR)).at(0));
        let unit = unit(frame, [micro, start], options, findings);
        let mut interval = micro / 1000.0;
        if options.interval.is_none() && !unit.is_time() && micro < FEWEST_THOUSANDTHS {
            interval = micro;
            findings.assumption(Note::unless(
                format!(
                    "the interval field holds {micro}, too little for thousandths of a {0}: taken as {micro} {0}",
                    unit.symbol()
                ),
                Setting::Interval.stated(),
            ));
        }
        let (first, shifts) = starts(columns, dead, interval, unit, options, findings)?;
        let longest = shifts.iter().flatten().max().copied().unwrap_or(0) as usize;
        if longest > frame.samples.saturating_mul(MAX_LENGTHENING - 1) {
            let trace = shifts.iter().flatten().position(|&s| s as usize == longest).unwrap_or(0);
            return Err(SegyProblem::UnevenStart {
                trace: trace as u64 + 1,
                start: first + longest as f64 * interval,
                base: first,
            });
        }
        Ok(Self { first, interval, unit, samples: frame.samples + longest, shifts })
    }

    /// The same axis in ms or m.
    pub(super) fn axis(&self) -> VerticalAxis {
        let factor = self.unit.in_survey();
        let unit = if self.unit.is_time() { VerticalUnit::Milliseconds } else { VerticalUnit::Metres };
        VerticalAxis { first: self.first * factor, interval: self.interval * factor, count: self.samples, unit }
    }
}

/// The interval in µs, mm or thousandths of a foot.
fn interval_field(frame: &FileLayout, columns: &Columns, findings: &mut Findings) -> Result<f64, SegyProblem> {
    let binary = &frame.binary;
    if binary.has_revision_2() && binary.extended_interval.is_finite() && binary.extended_interval > 0.0 {
        findings.evidence(format!("sample interval: {} at byte 3273 (revision 2)", binary.extended_interval));
        return Ok(binary.extended_interval);
    }
    let in_file = binary.interval;
    let column = columns.get(Field::U16(at::INTERVAL));
    let in_trace = column.at(0) as u16;
    if column.constant().is_none() {
        findings.warning(format!(
            "trace headers hold sample intervals from {} to {} (byte 117); all traces are taken to have the same",
            column.range[0], column.range[1]
        ));
    }
    // A negative i16 reads as more than 32767, which a large depth interval also does.
    let is_doubtful = |value: u16| value > i16::MAX.unsigned_abs();
    let (chosen, source) = match (in_file, in_trace) {
        (0, 0) => return Err(SegyProblem::NoInterval),
        (0, trace) => (trace, "byte 117"),
        (file, 0) => (file, "byte 3217"),
        (file, trace) if file == trace => (file, "bytes 3217 and 117"),
        (file, trace) if is_doubtful(file) && !is_doubtful(trace) => (trace, "byte 117"),
        (file, _) => (file, "byte 3217"),
    };
    findings.evidence(format!("sample interval: {chosen} at {source}"));
    if in_file != in_trace && in_trace != 0 && in_file != 0 {
        findings.warning(Note::unless(
            format!(
                "the binary header gives a sample interval of {in_file} (byte 3217), the first trace \
                 {in_trace} (byte 117); {chosen} is used"
            ),
            Setting::Interval.stated(),
        ));
    } else if is_doubtful(chosen) {
        findings.warning(Note::unless(
            format!(
                "the sample interval field holds {chosen}, or {} if it is meant to be signed; {chosen} is used",
                chosen.cast_signed()
            ),
            Setting::Interval.stated(),
        ));
    }
    Ok(f64::from(chosen))
}

/// What the length of a trace makes of the axis: two-way times and depths of surveys lie in different, overlapping
/// ranges.
struct Plausibility {
    time: bool,
    depth: bool,
    /// The interval as two-way time and as depth.
    steps: [f64; 2],
    samples: usize,
}

impl Plausibility {
    /// `micro` is the interval as the file holds it.
    fn of(micro: f64, samples: usize) -> Self {
        let as_depth = if micro < FEWEST_THOUSANDTHS { micro } else { micro / 1000.0 };
        let steps = [micro / 1000.0, as_depth];
        let is_within = |step: f64, [least, most]: [f64; 2], longest: f64| {
            step >= least && step <= most && step * samples.saturating_sub(1) as f64 <= longest
        };
        Self {
            time: is_within(steps[0], TIME_STEPS_MS, LONGEST_TIME_MS),
            depth: is_within(steps[1], DEPTH_STEPS_M, GREATEST_DEPTH_M),
            steps,
            samples,
        }
    }

    /// Whether one of both kinds is plausible and the other not: the unit for it, where depths are in `in_depth`.
    fn only(&self, in_depth: ZUnit) -> Option<ZUnit> {
        match (self.time, self.depth) {
            (true, false) => Some(ZUnit::Milliseconds),
            (false, true) => Some(in_depth),
            _ => None,
        }
    }

    /// Samples, interval and length in words.
    fn length(&self, unit: ZUnit) -> String {
        let step = self.steps[usize::from(!unit.is_time())];
        let long = step * self.samples.saturating_sub(1) as f64;
        format!("{} samples every {step} {1} span {long} {1}", self.samples, unit.symbol())
    }

    fn tell(&self, unit: ZUnit, findings: &mut Findings) {
        let words = |is_plausible: bool| if is_plausible { "plausible" } else { "not plausible" };
        findings.evidence(format!(
            "length of a trace: {} ({}), or as a depth {} ({})",
            self.length(ZUnit::Milliseconds),
            words(self.time),
            self.length(ZUnit::Metres),
            words(self.depth)
        ));
        let is_plausible = if unit.is_time() { self.time } else { self.depth };
        if !is_plausible {
            findings.warning(Note::unless(
                format!("{}, which is unlikely", self.length(unit)),
                Setting::VerticalUnit.stated_as(others(unit)),
            ));
        }
    }
}

/// The units to state where the axis is not in this one.
fn others(unit: ZUnit) -> &'static str {
    if unit.is_time() { "m, ft or usft" } else { "ms" }
}

/// Sample intervals of two-way time, from profilers of the sea floor to refraction data.
const TIME_STEPS_MS: [f64; 2] = [0.02, 16.0];
/// The deepest crustal sections record half a minute.
const LONGEST_TIME_MS: f64 = 30_000.0;
/// Sample intervals in depth.
const DEPTH_STEPS_M: [f64; 2] = [0.05, 200.0];
/// No survey in depth reaches the Earth's mantle below thick crust.
const GREATEST_DEPTH_M: f64 = 60_000.0;
/// An interval field of depth with less than this holds whole metres or feet.
const FEWEST_THOUSANDTHS: f64 = 100.0;

/// What the length of a trace weighs where it is plausible for one kind of axis alone: as much as the name of a method.
const LENGTH: u8 = 2;

/// The unit by what the sentences of the text header weigh, for either kind, together with the length of a trace.
fn weighed(
    words: &Words,
    likely: Option<ZUnit>,
    in_depth: ZUnit,
    plausibility: &Plausibility,
    findings: &mut Findings,
) -> ZUnit {
    let time = ZUnit::Milliseconds;
    let weight = |said: &Option<Said>, unit: ZUnit| {
        said.as_ref().map_or(0, |said| said.weight as u8) + if likely == Some(unit) { LENGTH } else { 0 }
    };
    let unit = if weight(&words.depth, in_depth) > weight(&words.time, time) { in_depth } else { time };
    let (followed, other) = if unit == time { (&words.time, &words.depth) } else { (&words.depth, &words.time) };
    let alone = if likely == Some(unit) { ", for which alone the length of a trace is plausible" } else { "" };
    match (followed, other) {
        (Some(Said { quote, .. }), None) => {
            let axis = if unit == time { "two-way time" } else { "depth" };
            findings.evidence(format!("vertical axis: {axis}, text header: \"{quote}\""));
        }
        (_, Some(Said { quote: against, .. })) => {
            let word = |is_time: bool| if is_time { "time" } else { "depth" };
            let here = followed
                .as_ref()
                .map_or_else(String::new, |said| format!("of {} (\"{}\") and ", word(unit == time), said.quote));
            findings.warning(Note::unless(
                format!(
                    "the text header speaks {here}of {} (\"{against}\"); the axis is taken as {}{alone}",
                    word(unit != time),
                    axis_in(unit),
                ),
                Setting::VerticalUnit.stated_as(others(unit)),
            ));
        }
        (None, None) => {
            let why = match unit {
                ZUnit::Milliseconds => String::new(),
                _ => format!(", and {} would be unlikely", plausibility.length(ZUnit::Milliseconds)),
            };
            findings.assumption(Note::unless(
                format!("the vertical axis is {}: the file does not say{why}", axis_in(unit)),
                Setting::VerticalUnit.stated_as(others(unit)),
            ));
        }
    }
    unit
}

/// The unit of the axis: stated; or written in the text next to the interval; or by what the sentences of the text and
/// the length of a trace weigh.
fn unit(frame: &FileLayout, [micro, start]: [f64; 2], options: &SegyOptions, findings: &mut Findings) -> ZUnit {
    if let Some(unit) = options.vertical_unit {
        findings.evidence(format!("vertical axis: {}, as stated", axis_in(unit)));
        return unit;
    }
    let in_depth = match frame.binary.measurement {
        2 => ZUnit::Feet,
        _ => ZUnit::Metres,
    };
    let lines = || frame.text.iter().chain(&frame.extended_text);
    let mut words = Words::find(lines(), micro / 1000.0);
    words.time = words.time.or_else(|| vertical_words::in_seconds(lines(), micro / 1000.0, start));
    if let Some([(unit, quote), (other, against)]) = &words.contradiction {
        findings.warning(Note::unless(
            format!(
                "the text header gives the unit of the vertical axis twice: {} (\"{quote}\") and {} (\"{against}\")",
                unit.symbol(),
                other.symbol()
            ),
            Setting::VerticalUnit.stated_as(format_args!("{} or {}", unit.symbol(), other.symbol())),
        ));
    }
    let plausibility = Plausibility::of(micro, frame.samples);
    let likely = plausibility.only(in_depth);
    let unit = match &words.unit {
        Some((unit, quote)) => {
            findings.evidence(format!("vertical axis: {}, text header: \"{quote}\"", axis_in(*unit)));
            *unit
        }
        None => match weighed(&words, likely, in_depth, &plausibility, findings) {
            depth if depth.is_time() || words.contradiction.is_some() => depth,
            depth => length_of_depths(depth, &words, frame.binary.measurement, findings),
        },
    };
    if let Some((number, other, quote)) = &words.other_interval {
        findings.warning(Note::unless(
            format!(
                "the text header gives a sample interval of {number} {} (\"{quote}\"), the file {}; the file's is taken",
                other.symbol(),
                micro / 1000.0
            ),
            Remedy::any([Setting::Interval.stated_as(number), Setting::VerticalUnit.stated_as(other.symbol())]),
        ));
    }
    plausibility.tell(unit, findings);
    if !unit.is_time() && unit != in_depth && frame.binary.measurement != 0 {
        findings.warning(Note::unless(
            format!(
                "the text header gives the vertical axis in {} and byte 3255 says {}; the text is followed",
                unit.symbol(),
                in_depth.symbol()
            ),
            Setting::VerticalUnit.stated(),
        ));
    }
    unit
}

/// The unit of depths whose unit no sentence gives: one that is said without saying of what, or that of X and Y.
fn length_of_depths(depth: ZUnit, words: &Words, measurement: u16, findings: &mut Findings) -> ZUnit {
    if let Some((unit, quote)) = &words.unowned {
        let axis = axis_in(*unit);
        findings.evidence(format!("vertical axis: {axis}, text header: \"{quote}\", which does not say of what"));
        return *unit;
    }
    match measurement {
        1 | 2 => findings.evidence(format!("{}, as byte 3255 says of lengths", axis_in(depth))),
        _ => findings.assumption(Note::unless(
            format!("the vertical axis is {}: neither the text header nor byte 3255 says", axis_in(depth)),
            Setting::VerticalUnit.stated_as("ft or usft"),
        )),
    }
    depth
}

/// The earliest start, and by how many samples each trace starts later.
fn starts(
    columns: &Columns,
    dead: &[bool],
    interval: f64,
    unit: ZUnit,
    options: &SegyOptions,
    findings: &mut Findings,
) -> Result<(f64, Option<Vec<u32>>), SegyProblem> {
    let scalar = columns.get(Field::I16(at::TIME_SCALAR));
    let delay = columns.get(Field::I16(at::DELAY));
    let lag = columns.get(Field::I16(at::LAG_A));
    let from_lag = delay.constant() == Some(0) && lag.constant().is_some_and(|lag| lag != 0);
    if from_lag && options.start.is_none() {
        findings.assumption(Note::unless(
            format!(
                "the start comes from lag time A (byte 105 holds {}, negated), as the delay at byte 109 is 0",
                lag.at(0)
            ),
            Setting::Start.stated(),
        ));
    }
    let start_of = |trace: usize| {
        let field = if from_lag { -lag.at(trace) } else { delay.at(trace) };
        scaled(field, scalar.at(trace))
    };
    let first_live = dead.iter().position(|dead| !dead).unwrap_or(0);
    let constant = |column: &HeaderColumn| column.constant().is_some();
    let (base, shifts) = if constant(delay) && constant(scalar) && constant(lag) {
        (start_of(first_live), None)
    } else {
        let live = || (0..dead.len()).filter(|&trace| !dead[trace]);
        let base = live().map(start_of).fold(f64::INFINITY, f64::min);
        let mut shifts = vec![0; dead.len()];
        for trace in live() {
            let samples = (start_of(trace) - base) / interval;
            if (samples - samples.round()).abs() > 0.01 {
                return Err(SegyProblem::UnevenStart { trace: trace as u64 + 1, start: start_of(trace), base });
            }
            shifts[trace] = samples.round() as u32;
        }
        let shifts = shifts.iter().any(|&s| s > 0).then_some(shifts);
        (if base.is_finite() { base } else { 0.0 }, shifts)
    };
    if shifts.is_some() {
        findings.warning(format!(
            "traces start at different {}: the volume begins at the earliest, {base} {}, and later traces are padded with zeros",
            if unit.is_time() { "times" } else { "depths" },
            unit.symbol()
        ));
    }
    if scalar.range != [0, 0] && scalar.range != [1, 1] {
        findings.evidence(format!(
            "start: {base} {}, from {} at byte 109 with scalar {} at byte 215",
            unit.symbol(),
            delay.at(first_live),
            scalar.at(first_live)
        ));
    }
    Ok((options.start.unwrap_or(base), shifts))
}

/// A field multiplied by its scalar, or divided if the scalar is negative; 0 stands for 1.
pub(super) fn scaled(field: i32, scalar: i32) -> f64 {
    match scalar {
        0 => f64::from(field),
        1.. => f64::from(field) * f64::from(scalar),
        _ => f64::from(field) / -f64::from(scalar),
    }
}

/// The unit of X and Y: stated, or byte 3255, or where that is neither, or a kind of foot, the text header.
pub(super) fn coordinate_unit(frame: &FileLayout, options: &SegyOptions) -> LengthUnit {
    let said = said_of_coordinates(frame).map(|(unit, _)| unit);
    match (options.coordinate_unit, frame.binary.measurement, said) {
        (Some(unit), _, _) => unit,
        (None, 2, Some(said)) if said != LengthUnit::Metres => said,
        (None, 2, _) => LengthUnit::Feet,
        (None, 1, _) => LengthUnit::Metres,
        (None, _, said) => said.unwrap_or(LengthUnit::Metres),
    }
}

/// The unit of X and Y in the text header, and the line that says it.
fn said_of_coordinates(frame: &FileLayout) -> Option<(LengthUnit, String)> {
    let header = HeaderUnits::of(frame.text.iter().chain(&frame.extended_text).map(String::as_str));
    let (said, _) = header.find(&[Quantity::Horizontal])?;
    Some((LengthUnit::of(said.unit)?, said.quote.clone()))
}

/// Says why X and Y are in that unit.
pub(super) fn note_coordinate_unit(frame: &FileLayout, options: &SegyOptions, findings: &mut Findings) {
    let unit = coordinate_unit(frame, options);
    let said = said_of_coordinates(frame);
    if let Some((said, quote)) = said.as_ref().filter(|(said, _)| *said != unit && options.coordinate_unit.is_none()) {
        findings.warning(Note::unless(
            format!(
                "the text header gives X and Y in {} (\"{quote}\") and byte 3255 says {}; {} is taken",
                said.symbol(),
                unit.symbol(),
                unit.symbol()
            ),
            Setting::CoordinateUnit.stated_as(said.symbol()),
        ));
        return;
    }
    match (options.coordinate_unit, frame.binary.measurement, said) {
        (Some(unit), _, _) => findings.evidence(format!("X and Y in {}, as stated", unit.symbol())),
        (None, 1, _) => {}
        (None, _, Some((_, quote))) => {
            findings.evidence(format!("X and Y in {}, text header: \"{quote}\"", unit.symbol()));
        }
        (None, 2, None) => findings.assumption(Note::unless(
            "X and Y are in feet, as byte 3255 is 2; the project converts them to metres",
            Setting::CoordinateUnit.stated_as("m or usft"),
        )),
        (None, other, None) => findings.assumption(Note::unless(
            format!("X and Y are in metres: byte 3255 holds {other}, neither 1 (metres) nor 2 (feet)"),
            Setting::CoordinateUnit.stated(),
        )),
    }
}
