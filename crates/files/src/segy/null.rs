//! Amplitudes that stand for no data, found by evidence: one value in runs of neighbouring samples, which no signal makes,
//! and that programs write for nothing, or that lies far outside the distribution of all others.

use super::error::SegyProblem;
use super::evidence::traces_of;
use super::header::Traces;
use super::sample::{ByteOrder, SampleFormat};
use rayon::prelude::*;
use std::collections::HashMap;

/// Traces that are looked at.
const TRACES: usize = 96;
/// Equal neighbours that make a run.
const RUN: usize = 4;
/// The longest run of a value that programs write for nothing, at least.
const LONG_RUN: usize = 8;
/// A value so many times as large as the others is far outside.
const FAR: f64 = 100.0;

/// What programs write for nothing.
const USUAL: [f32; 15] = [
    1e30,
    1.701_41e38,
    3.402_823e38,
    9.969_21e36,
    1e35,
    1e20,
    999.25,
    999.0,
    9999.0,
    9999.25,
    99_999.0,
    999_999.0,
    -32_768.0,
    -2_147_483_648.0,
    -128.0,
];

/// Whether a sample is a null amplitude, to the precision of an IBM float.
#[inline]
pub(super) fn is_null(value: f32, null: f32) -> bool {
    (value - null).abs() <= 1e-6 * null.abs() || value == null
}

/// A null amplitude, and the evidence for it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct FoundNull {
    pub value: f32,
    /// Samples that are it, of those looked at.
    pub count: usize,
    pub samples: usize,
    pub longest_run: usize,
}

/// Looks for a null amplitude.
pub(super) fn find(
    traces: &Traces<'_>,
    format: SampleFormat,
    order: ByteOrder,
) -> Result<Option<FoundNull>, SegyProblem> {
    let decoded: Vec<Vec<f32>> = traces_of(traces, TRACES)?
        .iter()
        .map(|bytes| {
            let mut values = vec![0.0; bytes.len() / format.bytes()];
            format.decode(order, bytes, &mut values);
            values
        })
        .collect();
    Ok(among(&decoded))
}

/// The null amplitude among decoded traces.
fn among(traces: &[Vec<f32>]) -> Option<FoundNull> {
    // [samples in runs, longest run] of each value.
    let mut runs: HashMap<u32, [usize; 2]> = HashMap::new();
    for run in traces.iter().flat_map(|trace| trace.chunk_by(|a, b| a == b)) {
        if run.len() >= RUN && run[0] != 0.0 && run[0].is_finite() {
            let found = runs.entry(run[0].to_bits()).or_default();
            *found = [found[0] + run.len(), found[1].max(run.len())];
        }
    }
    if runs.is_empty() {
        return None;
    }
    let samples: usize = traces.iter().map(Vec::len).sum();
    let mut magnitudes: Vec<f32> =
        traces.iter().flatten().map(|v| v.abs()).filter(|v| v.is_finite() && *v > 0.0).collect();
    magnitudes.sort_unstable_by(f32::total_cmp);
    let mut found: Option<FoundNull> = None;
    for (bits, [in_runs, longest_run]) in runs {
        let value = f32::from_bits(bits);
        let others: Vec<f32> = magnitudes.iter().copied().filter(|m| !is_null(*m, value.abs())).collect();
        if in_runs < (samples / 2000).max(32) || others.len() < 100 {
            continue;
        }
        let most = f64::from(others[others.len() * 199 / 200]);
        let is_far = f64::from(value.abs()) > FAR * most;
        let is_clip = USUAL[12..].contains(&value)
            && traces.iter().flatten().any(|other| *other == -value - 1.0 || *other == -value);
        let is_usual = !is_clip
            && longest_run >= LONG_RUN
            && USUAL.iter().any(|usual| if *usual < 0.0 { value == *usual } else { is_null(value.abs(), *usual) });
        let is_more = found.as_ref().is_none_or(|best| in_runs > best.count);
        if (is_far || is_usual) && is_more {
            let count = traces.iter().flatten().filter(|v| is_null(**v, value)).count();
            found = Some(FoundNull { value, count, samples, longest_run });
        }
    }
    found
}

/// Which traces are nothing but nulls: three samples of each are read, and all of those where the three are null.
pub(super) fn empty_traces(
    traces: &Traces<'_>,
    format: SampleFormat,
    order: ByteOrder,
    null: f32,
) -> Result<Vec<bool>, SegyProblem> {
    let samples = (traces.stride - traces.header_bytes) / format.bytes();
    let is_empty = |trace: usize| {
        let start = traces.start + trace as u64 * traces.stride as u64 + traces.header_bytes as u64;
        let mut room = [0_u8; 8];
        let mut one = [0.0_f32];
        for sample in [0, samples / 2, samples - 1] {
            let bytes = &mut room[..format.bytes()];
            traces.bytes.copy(start + (sample * format.bytes()) as u64, bytes, Some(trace))?;
            format.decode(order, bytes, &mut one);
            if !is_null(one[0], null) && one[0].is_finite() {
                return Ok(false);
            }
        }
        let mut all = Vec::new();
        let bytes = &traces.run(trace..trace + 1, &mut all)?[traces.header_bytes..];
        let mut values = vec![0.0; samples];
        format.decode(order, bytes, &mut values);
        Ok(values.iter().all(|value| is_null(*value, null) || !value.is_finite()))
    };
    (0..traces.count).into_par_iter().map(is_empty).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Noise of a few thousand, a null in the middle of each trace.
    fn traces(null: f32, run: usize) -> Vec<Vec<f32>> {
        let noise = |n: usize| ((n * 7919 % 6007) as f32 - 3000.0) * 1.01;
        let trace = |t: usize| {
            (0..200)
                .map(|n| if (50..50 + run).contains(&n) && t.is_multiple_of(3) { null } else { noise(t * 200 + n) })
                .collect()
        };
        (0..30).map(trace).collect()
    }

    #[test]
    fn a_value_in_runs_that_programs_write_or_that_is_far_outside_is_a_null() {
        for null in [1e30, -999.25, -9999.0, 1.70141e38, -3.402_823e38, 4.2e9, -1e20, 999.0] {
            let found = among(&traces(null, 40)).unwrap_or_else(|| panic!("{null}"));
            assert_eq!((found.value, found.longest_run, found.count), (null, 40, 400), "{null}");
        }
        for (not_null, run) in [(123.5, 40), (0.0, 40), (-999.25, 3), (3000.0, 20), (f32::NAN, 40)] {
            assert_eq!(among(&traces(not_null, run)), None, "{not_null} in runs of {run}");
        }
        // Clipped data have both limits.
        let clipped = |v: f32| v.clamp(-32_768.0, 32_767.0);
        let loud: Vec<Vec<f32>> =
            (0..30).map(|t| (0..200).map(|n| clipped(((n / 20 + t) as f32 - 20.0) * 20_000.0)).collect()).collect();
        assert_eq!(among(&loud), None);
        assert_eq!(among(&[vec![1e30; 100]]), None);
    }
}
