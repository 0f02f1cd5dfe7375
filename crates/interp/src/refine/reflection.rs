//! A reflection from one trace to the next: the shift at which the samples around it are most alike.

use std::cmp::Ordering;
use survey::Volume;

/// Samples above and below the reflection that are compared between traces: some half a period each, so that the event
/// itself decides and not its neighbours.
pub(crate) const WINDOW: i32 = 7;
/// Samples by which the reflection may leave what is expected from one trace to the next.
pub(crate) const MOST_STEP: i32 = 2;
/// Samples by which neighbours that were reached from different sides may disagree; those that do are a cycle apart.
pub(crate) const MOST_SEAM: f32 = 1.5;

/// The samples around a place of a trace.
pub(crate) type Window = [f32; 2 * WINDOW as usize + 1];

/// A box of samples, of traces that are counted over the whole survey.
pub(crate) struct TraceBox {
    pub(crate) samples: Volume<f32>,
    /// The voxel of the first sample.
    pub(crate) first: [usize; 3],
    /// Number of crosslines of the survey.
    pub(crate) crosslines: usize,
}

/// A trace that the reflection may go on to.
pub(crate) struct TraceStep {
    pub(crate) alike: f32,
    pub(crate) to: usize,
    pub(crate) z: f32,
}

impl PartialEq for TraceStep {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for TraceStep {}

impl PartialOrd for TraceStep {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for TraceStep {
    /// The most alike is the greatest; of two alike the one with the lesser number.
    fn cmp(&self, other: &Self) -> Ordering {
        self.alike.total_cmp(&other.alike).then_with(|| other.to.cmp(&self.to)).then_with(|| self.z.total_cmp(&other.z))
    }
}

impl TraceBox {
    /// The reflection that is at `z` on trace `from`, on trace `to`, near the depth that is expected there; `None` where
    /// nothing is at least so much alike.
    pub(crate) fn step(&self, (from, z): (usize, f32), to: usize, expected: f32, least: f32) -> Option<TraceStep> {
        let here = self.window(from, z)?;
        let alike =
            |shift: i32| self.window(to, expected + shift as f32).map_or(-1.0, |there| correlation(&here, &there));
        let scores: Vec<f32> = (-MOST_STEP - 1..=MOST_STEP + 1).map(alike).collect();
        let best = (1..scores.len() - 1).max_by(|&a, &b| scores[a].total_cmp(&scores[b]))?;
        let [before, at, after] = [scores[best - 1], scores[best], scores[best + 1]];
        if at < least || before > at || after > at {
            return None;
        }
        let z = expected + (best as i32 - MOST_STEP - 1) as f32 + summit([before, at, after]);
        Some(TraceStep { alike: at, to, z })
    }

    /// The samples around a depth on a trace; none where they are not all there.
    pub(crate) fn window(&self, n: usize, z: f32) -> Option<Window> {
        let [x, y] =
            [(n / self.crosslines).checked_sub(self.first[0])?, (n % self.crosslines).checked_sub(self.first[1])?];
        let [nx, ny, _] = self.samples.size();
        if x >= nx || y >= ny {
            return None;
        }
        let trace = self.samples.trace(x, y);
        let top = z - self.first[2] as f32 - WINDOW as f32;
        let whole = top.floor();
        if whole < 0.0 || whole as usize + 2 * WINDOW as usize + 1 >= trace.len() {
            return None;
        }
        let (whole, share) = (whole as usize, top - whole);
        let window = std::array::from_fn(|k| trace[whole + k] * (1.0 - share) + trace[whole + k + 1] * share);
        window.iter().all(|value: &f32| value.is_finite()).then_some(window)
    }
}

/// Where between three neighbours the parabola through them has its extremum, from −0.5 to 0.5 of their distance beside
/// the middle one.
pub(crate) fn summit([before, at, after]: [f32; 3]) -> f32 {
    let bend = before - 2.0 * at + after;
    if bend.abs() > 1e-6 * (before.abs() + at.abs() + after.abs()) {
        (0.5 * (before - after) / bend).clamp(-0.5, 0.5)
    } else {
        0.0
    }
}

/// The traces beside a trace.
pub(crate) fn neighbours(n: usize, [nx, ny]: [usize; 2]) -> impl Iterator<Item = usize> {
    let (x, y) = (n / ny, n % ny);
    let beside = [
        (x > 0).then(|| n - ny),
        (x + 1 < nx).then_some(n + ny),
        (y > 0).then(|| n - 1),
        (y + 1 < ny).then_some(n + 1),
    ];
    beside.into_iter().flatten()
}

/// The correlation of two windows, from −1 to 1; −1 where one of them is silent.
pub(crate) fn correlation<const N: usize>(a: &[f32; N], b: &[f32; N]) -> f32 {
    let (mut both, mut first, mut second) = (0.0_f64, 0.0_f64, 0.0_f64);
    for (a, b) in a.iter().zip(b) {
        let (a, b) = (f64::from(*a), f64::from(*b));
        (both, first, second) = (both + a * b, first + a * a, second + b * b);
    }
    let power = (first * second).sqrt();
    if power > 0.0 { (both / power) as f32 } else { -1.0 }
}
