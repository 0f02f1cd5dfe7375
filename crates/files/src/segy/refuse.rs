//! Recognises from trace headers files that are not post-stack 3D volumes.

use super::SegyOptions;
use super::candidate::{Candidate, Verdict};
use super::columns::{Columns, HeaderColumn};
use super::coordinates::varying;
use super::error::SegyProblem;
use super::header::{Field, at};
use super::lines::LineLattice;
use glam::DVec2;
use std::collections::BTreeSet;

/// Several traces a bin: the line numbers of the standard (or the stated ones) repeat, or gathers are
/// numbered.
pub(super) fn pre_stack(columns: &Columns, options: &SegyOptions, candidates: &[Candidate]) -> Result<(), SegyProblem> {
    let repeated = candidates.first().filter(|c| c.verdict == Verdict::Repeated);
    let Some(candidate) = repeated else { return Ok(()) };
    let [inline, crossline] =
        [candidate.inline_byte, candidate.crossline_byte].map(|byte| columns.numbers(byte, candidate.number_type));
    let kept = options.duplicates.unwrap_or_default();
    let Ok(lattice) = LineLattice::build(&inline, &crossline, kept) else { return Ok(()) };
    let Some(example) = lattice.first_duplicate else { return Ok(()) };
    let (offsets, may_repeat) = offsets(columns);
    Err(SegyProblem::PreStack {
        evidence: format!(
            "{} traces stand in {} bins (trace {} repeats inline {}, crossline {}, read at bytes {} and {}) and {offsets}",
            lattice.filled() + lattice.duplicates,
            lattice.filled(),
            example + 1,
            inline.at(example),
            crossline.at(example),
            candidate.inline_byte,
            candidate.crossline_byte
        ),
        may_repeat,
    })
}

/// What the offsets are, and whether the traces may be mere repetitions.
fn offsets(columns: &Columns) -> (String, bool) {
    let offset = columns.get(Field::I32(at::OFFSET));
    match offset.constant() {
        None => (format!("offsets at byte 37 run from {} to {}", offset.range[0], offset.range[1]), false),
        Some(_) => ("their offsets at byte 37 do not differ, as those of mere repetitions".to_owned(), true),
    }
}

/// Evidence that traces at the same X and Y are pre-stack.
pub(super) fn repeated_places(columns: &Columns, lattice: &LineLattice) -> SegyProblem {
    let (offsets, may_repeat) = offsets(columns);
    let evidence = format!(
        "{} traces stand at {} places (trace {} repeats the X and Y of an earlier one) and {offsets}",
        lattice.filled() + lattice.duplicates,
        lattice.filled(),
        lattice.first_duplicate.unwrap_or(0) + 1
    );
    SegyProblem::PreStack { evidence, may_repeat }
}

/// Gathers without line numbers: by shot, or by CDP.
pub(super) fn shot_gathers(columns: &Columns) -> Result<(), SegyProblem> {
    let record = columns.get(Field::I32(at::FIELD_RECORD));
    let in_record = columns.get(Field::I32(at::TRACE_IN_RECORD));
    let cdp = columns.get(Field::I32(at::CDP));
    let offset = columns.get(Field::I32(at::OFFSET));
    if cdp.constant().is_some() && record.constant().is_none() && in_record.constant().is_none() {
        return Err(SegyProblem::PreStack {
            evidence: format!(
                "field records {} to {} (byte 9) hold traces {} to {} (byte 13), and there are no line or CDP \
                 numbers: these are shot gathers",
                record.range[0], record.range[1], in_record.range[0], in_record.range[1]
            ),
            may_repeat: false,
        });
    }
    let pairs = || cdp.iter().zip(offset.iter()).zip(cdp.iter().zip(offset.iter()).skip(1));
    let together = pairs().filter(|((cdp, offset), (next_cdp, next_offset))| cdp == next_cdp && offset != next_offset);
    if cdp.constant().is_none() && together.count() * 2 > pairs().count() {
        return Err(SegyProblem::PreStack {
            evidence: format!(
                "neighbouring traces share a CDP number (byte 21) and differ in offset ({} to {} at byte 37): these are CDP gathers",
                offset.range[0], offset.range[1]
            ),
            may_repeat: false,
        });
    }
    Ok(())
}

/// One line of a pre-stack survey: one number is constant, the other repeats with other offsets.
fn gathers_of_a_line(columns: &Columns, candidate: &Candidate) -> Result<(), SegyProblem> {
    let (kind, byte) = match candidate.verdict {
        Verdict::ConstantInline(_) => ("crossline", candidate.crossline_byte),
        Verdict::ConstantCrossline(_) => ("inline", candidate.inline_byte),
        _ => return Ok(()),
    };
    let numbers = columns.numbers(byte, candidate.number_type);
    let traces = numbers.iter().count();
    let places = numbers.iter().collect::<BTreeSet<i32>>().len();
    // Counters that fold, and fields that are nearly empty, are no lines.
    if places < 2 || traces < 2 * places {
        return Ok(());
    }
    let (offsets, may_repeat) = offsets(columns);
    Err(SegyProblem::PreStack {
        evidence: format!("{traces} traces stand at {places} {kind}s (byte {byte}) of one line and {offsets}"),
        may_repeat,
    })
}

/// One line: an axis that does not vary, both numbers changing from trace to trace, no number but one that counts traces, or
/// places that follow one another.
pub(super) fn two_dimensional(
    columns: &Columns,
    options: &SegyOptions,
    candidates: &[Candidate],
) -> Result<(), SegyProblem> {
    let of = |byte: u16| {
        let [low, high] = columns.get(Field::I32(byte)).range;
        format!("{low} to {high}")
    };
    // An inline that is 0 throughout was left out by the writer; that traces share a crossline tells all the same.
    let has_offsets = columns.get(Field::I32(at::OFFSET)).constant().is_none();
    for candidate in candidates.iter().filter(|c| has_offsets && c.inline_byte != at::TRACE_IN_FILE) {
        gathers_of_a_line(columns, candidate)?;
    }
    for candidate in candidates.iter().filter(|c| c.inline_byte != at::TRACE_IN_FILE) {
        let (inline, crossline) = (candidate.inline_byte, candidate.crossline_byte);
        let evidence = match candidate.verdict {
            Verdict::ConstantInline(number) if number != 0 => format!(
                "the inline number (byte {inline}) is {number} throughout while the crossline number (byte {crossline}) runs from {}",
                of(crossline)
            ),
            Verdict::ConstantCrossline(number) if number != 0 => format!(
                "the crossline number (byte {crossline}) is {number} throughout while the inline number (byte {inline}) runs from {}",
                of(inline)
            ),
            Verdict::Diagonal => format!(
                "each trace has an inline (byte {inline}, {}) and a crossline number (byte {crossline}, {}) of its own",
                of(inline),
                of(crossline)
            ),
            _ => continue,
        };
        gathers_of_a_line(columns, candidate)?;
        return Err(SegyProblem::TwoDimensional { evidence });
    }
    if is_one_way(columns.get(Field::I32(at::CDP))) {
        return Err(SegyProblem::TwoDimensional {
            evidence: format!("there are no inline numbers, and the CDP number (byte 21) counts from {}", of(at::CDP)),
        });
    }
    for candidate in candidates {
        let (missing, kind, byte) = match candidate.verdict {
            Verdict::ConstantInline(0) => ("inline", "crossline", candidate.crossline_byte),
            Verdict::ConstantCrossline(0) => ("crossline", "inline", candidate.inline_byte),
            _ => continue,
        };
        if candidate.inline_byte != at::TRACE_IN_FILE && is_one_way(&columns.numbers(byte, candidate.number_type)) {
            let evidence = format!(
                "there are no {missing} numbers, and each trace has a {kind} number (byte {byte}, {}) of its own",
                of(byte)
            );
            return Err(SegyProblem::TwoDimensional { evidence });
        }
    }
    follow_one_line(columns, options)
}

/// Whether numbers rise from trace to trace, or fall: in a volume they begin anew with each line.
fn is_one_way(numbers: &HeaderColumn) -> bool {
    let pairs = || numbers.iter().zip(numbers.iter().skip(1));
    numbers.constant().is_none() && (pairs().all(|(a, b)| a < b) || pairs().all(|(a, b)| a > b))
}

/// Fewer traces may lie on a line by chance.
const FEWEST_ON_A_LINE: usize = 8;

/// Traces whose X and Y lead from the first to the last without turning back, straight or crooked. Those of a volume turn
/// back with each of its lines.
pub(super) fn follow_one_line(columns: &Columns, options: &SegyOptions) -> Result<(), SegyProblem> {
    let Some(coordinates) = varying(columns, options) else { return Ok(()) };
    let places: Vec<DVec2> = (0..columns.count()).filter_map(|trace| coordinates.of(trace)).collect();
    let (Some(first), Some(last)) = (places.first(), places.last()) else { return Ok(()) };
    let along = *last - *first;
    let goes_on = |pair: &[DVec2]| (pair[1] - pair[0]).dot(along) > 0.0;
    if places.len() < FEWEST_ON_A_LINE.max(columns.count()) || !places.windows(2).all(goes_on) {
        return Ok(());
    }
    let evidence = "there are no line numbers, and X and Y lead along one line without turning back".to_owned();
    Err(SegyProblem::TwoDimensional { evidence })
}
