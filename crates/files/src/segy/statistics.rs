//! Statistics of the amplitudes of a file, from traces spread evenly over the survey: range, percentiles and
//! histogram, and counts that reveal problems (clipped samples, zeros, NaN).

use rayon::prelude::*;
use serde::Serialize;

use super::error::{SegyError, SegyProblem};
use super::file::SegyFile;
use survey::progress::Progress;

/// Count of samples examined: enough for percentiles to three digits, in a fraction of a second.
const SAMPLES: usize = 1 << 22;

/// Columns of the histogram; odd, so that one of them holds zero.
const COLUMNS: usize = 61;

/// Percentages of [`Statistics::percentiles`].
const PERCENT: [f64; 9] = [0.1, 1.0, 5.0, 25.0, 50.0, 75.0, 95.0, 99.0, 99.9];

/// Counts of samples over equal intervals.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AmplitudeHistogram {
    /// Where the first column begins; samples below are counted in it.
    pub low: f64,
    /// Where the last column ends; samples above are counted in it.
    pub high: f64,
    /// Samples by column.
    pub counts: Vec<u64>,
}

/// Amplitudes of the live traces that were examined.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Statistics {
    /// Live traces that were examined.
    pub traces: usize,
    /// Live traces in the file.
    pub live_traces: usize,
    /// Samples that were examined.
    pub samples: u64,
    /// Smallest.
    pub min: f32,
    /// Largest.
    pub max: f32,
    /// Mean.
    pub mean: f64,
    /// Root mean square.
    pub rms: f64,
    /// Percentage, and the amplitude that so many samples do not exceed.
    pub percentiles: Vec<[f64; 2]>,
    /// Samples that are exactly 0.
    pub zero: u64,
    /// Traces that are 0 throughout, though they are not flagged dead.
    pub zero_traces: usize,
    /// Samples that are NaN or infinite in the file: no data.
    pub non_finite: u64,
    /// Samples that equal the smallest or largest one.
    pub at_limits: u64,
    /// Those of them at a limit at which samples pile up: the data are clipped there.
    pub clipped: u64,
    /// Histogram between the outer percentiles, symmetric about 0 if there are both signs.
    pub histogram: AmplitudeHistogram,
}

impl SegyFile {
    /// Looks at the amplitudes of up to four million samples.
    ///
    /// # Errors
    /// [`SegyProblem::Cancelled`], and those of [`SegyFile::read_trace`].
    pub fn statistics(&self, progress: &Progress) -> Result<Statistics, SegyError> {
        let [_, crosslines, samples] = self.size();
        let live: Vec<usize> =
            (0..self.places()).filter(|&place| self.is_live(place / crosslines, place % crosslines)).collect();
        let wanted = (SAMPLES / samples.max(1)).clamp(1, live.len().max(1));
        let step = live.len().div_ceil(wanted).max(1);
        let chosen: Vec<usize> = live.iter().copied().step_by(step).collect();
        progress.begin("reading amplitudes", chosen.len() as u64);
        let mut values = vec![0.0_f32; chosen.len() * samples];
        let faults: Vec<(usize, bool)> = values
            .par_chunks_mut(samples.max(1))
            .zip(&chosen)
            .map(|(trace, &place)| {
                let non_finite = self.read_trace(place / crosslines, place % crosslines, trace)?;
                progress.step(1).map_err(|cancelled| SegyProblem::from(cancelled).in_file(&self.path))?;
                Ok((non_finite, trace.iter().all(|&value| value == 0.0 || value.is_nan())))
            })
            .collect::<Result<_, SegyError>>()?;
        let mut statistics = describe(values);
        statistics.traces = chosen.len();
        statistics.live_traces = live.len();
        statistics.non_finite = faults.iter().map(|fault| fault.0 as u64).sum();
        statistics.zero_traces = faults.iter().filter(|fault| fault.1).count();
        Ok(statistics)
    }
}

/// Fewer values than these are classes, which pile up anywhere.
const FEWEST_VALUES: usize = 16;
/// How many times more samples a limit has than the value beside it where data are clipped there.
const TIMES_MORE: usize = 3;

/// Samples at limits at which they pile up: where data were clipped. 0 is none, since it also stands for no data, and
/// attributes begin there.
fn clipped(values: &[f32]) -> u64 {
    if !has_many_values(values) {
        return 0;
    }
    let piled = [1.0, -1.0].map(|side| {
        let next = |beyond: f32| values.iter().map(|v| v * side).filter(|v| *v > beyond).fold(f32::INFINITY, f32::min);
        let samples_at = |at: f32| values.iter().filter(|v| **v * side == at).count();
        let limit = next(f32::NEG_INFINITY);
        let samples = samples_at(limit);
        let is_piled = limit != 0.0 && samples > TIMES_MORE * samples_at(next(limit));
        if is_piled { samples as u64 } else { 0 }
    });
    piled.into_iter().sum()
}

/// Whether samples have so many different values that they are no classes.
fn has_many_values(values: &[f32]) -> bool {
    let mut different: Vec<f32> = Vec::with_capacity(FEWEST_VALUES);
    values.iter().any(|value| {
        if !different.contains(value) {
            different.push(*value);
        }
        different.len() >= FEWEST_VALUES
    })
}

/// The values at ascending places of the sorted sequence, of which `values` is the part from `first` on; it is reordered
/// as far as it takes.
fn at_places(values: &mut [f32], first: usize, places: &[usize]) -> Vec<f32> {
    let Some(&middle) = places.get(places.len() / 2) else { return Vec::new() };
    let (below, &mut value, above) = values.select_nth_unstable_by(middle - first, f32::total_cmp);
    let [before, after] = [places.partition_point(|place| *place < middle), places.partition_point(|p| *p <= middle)];
    let mut found = at_places(below, first, &places[..before]);
    found.resize(after, value);
    found.extend(at_places(above, middle + 1, &places[after..]));
    found
}

fn describe(mut values: Vec<f32>) -> Statistics {
    // Null amplitudes are NaN here.
    values.retain(|value| !value.is_nan());
    let count = values.len();
    let sum = |of: fn(f64) -> f64| values.iter().map(|&v| of(f64::from(v))).sum::<f64>() / count.max(1) as f64;
    let (mean, rms) = (sum(|v| v), sum(|v| v * v).sqrt());
    let zero = values.iter().filter(|&&v| v == 0.0).count() as u64;
    let last = count.saturating_sub(1);
    let ranks = PERCENT.map(|percent| ((percent / 100.0 * count as f64) as usize).min(last));
    let places: Vec<usize> = [0].into_iter().chain(ranks).chain([last]).collect();
    let found = if count == 0 { vec![0.0; places.len()] } else { at_places(&mut values, 0, &places) };
    let (min, max, percentiles) = (found[0], found[found.len() - 1], &found[1..=PERCENT.len()]);
    let at = |limit: f32| values.iter().filter(|&&v| v == limit).count();
    // One value is no limit that data are clipped at.
    let at_limits = if min == max { 0 } else { at(min) + at(max) };
    let clipped = clipped(&values);
    let (low, high) = match [percentiles[0], percentiles[PERCENT.len() - 1]].map(f64::from) {
        [low, high] if low < 0.0 && high > 0.0 => (-high.max(-low), high.max(-low)),
        [low, high] if low < high => (low, high),
        [low, _] => (low - 0.5, low + 0.5),
    };
    let mut counts = vec![0; COLUMNS];
    let scale = COLUMNS as f64 / (high - low);
    for &value in &values {
        let column = ((f64::from(value) - low) * scale).clamp(0.0, COLUMNS as f64 - 1.0) as usize;
        counts[column] += 1;
    }
    Statistics {
        traces: 0,
        live_traces: 0,
        samples: count as u64,
        min,
        max,
        mean,
        rms,
        percentiles: PERCENT.into_iter().zip(percentiles).map(|(percent, at)| [percent, f64::from(*at)]).collect(),
        zero,
        zero_traces: 0,
        non_finite: 0,
        at_limits: at_limits as u64,
        clipped,
        histogram: AmplitudeHistogram { low, high, counts },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ramp_has_its_closed_form() {
        let found = describe((0..=1000).rev().map(|k| k as f32 - 500.0).collect());
        assert_eq!((found.min, found.max, found.mean, found.zero, found.at_limits), (-500.0, 500.0, 0.0, 1, 2));
        assert!((found.rms - (500.0_f64 * 501.0 / 3.0).sqrt()).abs() < 1e-9);
        assert_eq!(found.percentiles[4], [50.0, 0.0]);
        assert_eq!(found.percentiles[7], [99.0, 490.0]);
        assert_eq!((found.histogram.low, found.histogram.high), (-499.0, 499.0));
        assert_eq!(found.histogram.counts.iter().sum::<u64>(), 1001);
        let inner = &found.histogram.counts[1..COLUMNS - 1];
        assert!(inner.iter().all(|&c| (16..=17).contains(&c)), "{inner:?}");
    }

    #[test]
    fn values_at_places_are_those_of_the_sorted_sequence() {
        let mut state = 1u32;
        for count in [1, 2, 3, 10, 57, 1000] {
            let mut values: Vec<f32> = (0..count)
                .map(|_| {
                    state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                    ((state >> 24) as f32 - 128.0) / 8.0
                })
                .collect();
            let mut sorted = values.clone();
            sorted.sort_by(f32::total_cmp);
            let places: Vec<usize> = [0, 0, count / 7, count / 3, count / 2, count / 2, count - 1].into();
            let expected: Vec<f32> = places.iter().map(|place| sorted[*place]).collect();
            assert_eq!(at_places(&mut values, 0, &places), expected);
        }
        assert_eq!(describe(Vec::new()).percentiles[4], [50.0, 0.0]);
    }

    #[test]
    fn limits_at_which_samples_pile_up_are_clipped_and_classes_are_not() {
        let wave = |n: u32| (n as f32 * 0.37).sin() * 900.0;
        let clipped_wave = describe((0..4000).map(|n| wave(n).clamp(-500.0, 800.0)).collect());
        assert!(clipped_wave.clipped > 1000 && clipped_wave.clipped == clipped_wave.at_limits, "{clipped_wave:?}");
        // 8 bits, clipped on one side.
        assert!(describe((0..4000).map(|n| (wave(n) / 7.0).round().min(90.0)).collect()).clipped > 500);
        // A mask, codes of rocks, an attribute that begins at 0, a wave with two equal crests, steps of one size.
        let others: [Vec<f32>; 5] = [
            (0..4000).map(|n| (n % 2) as f32).collect(),
            (0..4000).map(|n| (n % 7) as f32).collect(),
            (0..4000).map(|n| wave(n).max(0.0)).collect(),
            (0..4000).map(wave).chain([900.0, 900.0]).collect(),
            (0..4000).map(|n| (n % 200) as f32).collect(),
        ];
        for (n, values) in others.into_iter().enumerate() {
            let found = describe(values);
            assert!(found.clipped <= 2, "{n}: {found:?}");
        }
    }

    #[test]
    fn one_value_and_no_value_are_described_too() {
        let one = describe(vec![7.0; 9]);
        assert_eq!((one.at_limits, one.histogram.counts[COLUMNS / 2]), (0, 9));
        assert_eq!(describe(Vec::new()).samples, 0);
    }
}
