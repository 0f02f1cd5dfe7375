//! Which extrema are side lobes of those above and below them.
//!
//! A reflector makes not one extremum but three or more: the side lobes of the wavelet accompany it
//! everywhere, with heights and at distances as constant as its own. A fault puts them against other
//! reflectors, and a surface that crosses there continues along a lobe without a visible step. What
//! identifies a lobe is not on the surface but above and below it: its height is explained by the
//! neighbouring extrema of its trace. So the heights a of the extrema of a trace are resolved into each
//! extremum's own height r:
//!
//! `a_i = r_i ± c(z_i − z_{i−1})·r_{i−1} ± c(z_{i+1} − z_i)·r_{i+1}`, + between a peak and a trough, −
//! between two of a kind,
//!
//! with c the relative height of a lobe at a distance: the negative part of the Ricker wavelet, negated (0
//! elsewhere), scaled to the distance and relative height at which the survey's strong extrema have their
//! neighbours (medians). The system is tridiagonal, and well-posed because c < ½. Over the extremum and those
//! linked to it, Σr/Σa is near 1 on reflectors and near 0 on lobes; noise between reflectors is no lobe, but
//! low. An extremum that is neither a lobe nor low belongs to a reflector. A link between such an extremum
//! and another one has the greatest evidence for a break.
//!
//! The method needs lobes that can be recognised. Where strong extrema have neighbours of any height, because
//! reflectors lie closer than the wavelet is long, or neighbours as high as themselves, because everything
//! rings, nothing is concluded.

use super::evidence::{MOST, rank};
use super::links::{Links, NEXT_X, NEXT_Y, NONE};
use super::smoothing::{self, Four, Passable, SmoothingScratch};
use crate::extrema::Extrema;
use crate::surfaces::Extremum;
use rayon::prelude::*;
use survey::{Cancelled, Progress};

/// Greatest c; above it a trace could not be resolved. The Ricker wavelet has 0.446.
const MOST_COUPLING: f32 = 0.45;

/// Relative height (median) of the neighbours of strong extrema from which on they are ringing rather than
/// lobes.
const RINGING: f32 = 0.55;

/// Largest interquartile range of those relative heights at which they are taken for lobes. One wavelet in
/// noise as strong as two thirds of the signal has 0.22; real surveys with reflectors closer than their
/// wavelet have 0.5 and 0.6.
const MOST_SPAN: f32 = 0.25;

/// Share of the extrema that count as strong.
const STRONG: f32 = 0.05;

/// Least own height of a reflector, in standard deviations of the effect of noise on a height from one trace
/// to the next. Noise between reflectors also has its height of its own, and would connect one reflector to
/// the other.
const LEAST_OVER_NOISE: f32 = 3.0;

/// The side lobes of a reflector.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Lobes {
    /// Distance from the reflector, samples.
    pub(crate) distance: f32,
    /// Height relative to that of the reflector.
    pub(crate) height: f32,
}

impl Lobes {
    /// Height of the lobe that a reflector makes at a distance, relative to its own.
    #[inline]
    fn coupling(self, distance: f32) -> f32 {
        let square = (distance / self.distance).powi(2);
        (self.height * 0.5 * (3.0 * square - 1.0) * (1.5 * (1.0 - square)).exp()).max(0.0)
    }

    /// Measures the lobes beside the strong extrema of `pair`; `None` where they cannot be recognised.
    fn measure(pair: [&Extrema; 2]) -> Option<Self> {
        let [nx, ny, _] = pair[0].size;
        let mut heights: Vec<f32> = pair.iter().flat_map(|e| e.amplitude.iter().step_by(SPARSE).copied()).collect();
        let at = strong_rank(heights.len());
        let strong = *heights.get_mut(..).filter(|h| at < h.len())?.select_nth_unstable_by(at, f32::total_cmp).1;
        let mut beside: Vec<[f32; 2]> = (0..nx)
            .into_par_iter()
            .flat_map_iter(|x| {
                let (mut found, mut trace) = (Vec::new(), Vec::new());
                for y in (0..ny).filter(|&y| is_measured(x, y)) {
                    merged(pair, x, y, &mut trace);
                    each_beside(&trace, strong, |pair| found.push(pair));
                }
                found
            })
            .collect();
        let count = beside.len();
        Self::of_quantiles(|which, share| {
            let at = rank(share, count);
            let order = |a: &[f32; 2], b: &[f32; 2]| a[which].total_cmp(&b[which]);
            (at < count).then(|| beside.select_nth_unstable_by(at, order).1[which])
        })
    }

    /// The lobes from quantiles of the distances (0) and relative heights (1) of what lies beside strong extrema.
    pub(crate) fn of_quantiles(mut quantile: impl FnMut(usize, f32) -> Option<f32>) -> Option<Self> {
        let (distance, height) = (quantile(0, 0.5)?, quantile(1, 0.5)?);
        let span = quantile(1, 0.75)? - quantile(1, 0.25)?;
        (height < RINGING && span < MOST_SPAN).then(|| Self { distance, height: height.min(MOST_COUPLING) })
    }
}

/// One in this many extrema is used to find what is strong.
pub(crate) const SPARSE: usize = 17;

/// The place, among `count` ascending heights, of the least that counts as strong.
pub(crate) fn strong_rank(count: usize) -> usize {
    rank(1.0 - STRONG, count)
}

/// Whether lobes are measured on a trace.
pub(crate) fn is_measured(x: usize, y: usize) -> bool {
    y % 5 == x % 5
}

/// Calls `found([distance, relative height])` for each pair of neighbours on a trace one of which is strong.
pub(crate) fn each_beside(trace: &[OnTrace], strong: f32, mut found: impl FnMut([f32; 2])) {
    for [a, b] in trace.array_windows() {
        let (low, high) = (a.height.min(b.height), a.height.max(b.height));
        if a.kind != b.kind && high >= strong {
            found([b.z - a.z, low / high]);
        }
    }
}

/// An extremum on a trace.
#[derive(Debug, Clone, Copy)]
pub(crate) struct OnTrace {
    z: f32,
    height: f32,
    kind: usize,
    index: usize,
}

/// The extrema of both kinds on a trace, from the top down.
pub(crate) fn merged(pair: [&Extrema; 2], x: usize, y: usize, trace: &mut Vec<OnTrace>) {
    trace.clear();
    let [mut a, mut b] = pair.map(|e| e.on_trace(x, y));
    let of = |kind: usize, index: usize| OnTrace {
        z: pair[kind].z[index],
        height: pair[kind].amplitude[index],
        kind,
        index,
    };
    while !a.is_empty() || !b.is_empty() {
        let first = b.is_empty() || !a.is_empty() && pair[0].z[a.start] <= pair[1].z[b.start];
        let next = if first { a.next().map(|v| of(0, v)) } else { b.next().map(|v| of(1, v)) };
        trace.extend(next);
    }
}

/// The own height r of each extremum of each kind. Empty where lobes cannot be recognised: for zero
/// crossings, for peaks without troughs or troughs without peaks, and where [`Lobes::measure`] finds none.
pub(crate) fn own_heights(extrema: &[Extrema]) -> Vec<Vec<f32>> {
    let none = || extrema.iter().map(|_| Vec::new()).collect();
    let kinds: Vec<Extremum> = extrema.iter().map(|e| e.kind).collect();
    let Some(pair) = pair_of(&kinds) else { return none() };
    match Lobes::measure(pair.map(|kind| &extrema[kind])) {
        Some(lobes) => resolved_heights(extrema, pair, lobes),
        None => none(),
    }
}

/// Where peaks and troughs are among the kinds, if both are.
pub(crate) fn pair_of(kinds: &[Extremum]) -> Option<[usize; 2]> {
    let place = |kind: Extremum| kinds.iter().position(|&other| other == kind);
    Some([place(Extremum::Peak)?, place(Extremum::Trough)?])
}

/// The own height of each extremum of the peaks and troughs, beside known lobes; empty for other kinds.
pub(crate) fn resolved_heights(extrema: &[Extrema], [peaks, troughs]: [usize; 2], lobes: Lobes) -> Vec<Vec<f32>> {
    let mut own: Vec<Vec<f32>> = extrema.iter().map(|_| Vec::new()).collect();
    let pair = [&extrema[peaks], &extrema[troughs]];
    let mut found = pair.map(|e| vec![0.0f32; e.len()]);
    let [first, second] = &mut found;
    let lines = pair[0].split_inlines(first).into_iter().zip(pair[1].split_inlines(second));
    lines.collect::<Vec<_>>().into_par_iter().enumerate().for_each_init(
        || (Vec::new(), Vec::new()),
        |(trace, upper), (x, (a, b))| {
            let starts = pair.map(|e| e.on_inline(x).start);
            let lines = [a, b];
            for y in 0..pair[0].size[1] {
                merged(pair, x, y, trace);
                resolve(trace, lobes, upper);
                for at in &*trace {
                    lines[at.kind][at.index - starts[at.kind]] = at.height;
                }
            }
        },
    );
    let [first, second] = found;
    (own[peaks], own[troughs]) = (first, second);
    own
}

/// Replaces the heights on a trace by own heights (Thomas algorithm). `upper` is scratch memory.
fn resolve(trace: &mut [OnTrace], lobes: Lobes, upper: &mut Vec<f32>) {
    upper.clear();
    for n in 0..trace.len() {
        let coupling = |a: OnTrace, b: OnTrace| {
            let coupling = lobes.coupling(b.z - a.z);
            if a.kind == b.kind { -coupling } else { coupling }
        };
        let (mut pivot, mut height) = (1.0, trace[n].height);
        if n > 0 {
            let before = coupling(trace[n - 1], trace[n]);
            pivot -= before * upper[n - 1];
            height -= before * trace[n - 1].height;
        }
        upper.push(trace.get(n + 1).map_or(0.0, |&next| coupling(trace[n], next)) / pivot);
        trace[n].height = height / pivot;
    }
    for n in (1..trace.len()).rev() {
        trace[n - 1].height -= upper[n - 1] * trace[n].height;
    }
}

/// The least own height of a reflector.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Least {
    /// Share of its height.
    pub(crate) share: f32,
    /// Effect of noise on a height from one trace to the next; the least own height is [`LEAST_OVER_NOISE`]
    /// times that.
    pub(crate) noise: f32,
}

/// Gives the links between reflectors and other extrema the greatest evidence for a break. `own` are the own
/// heights ([`own_heights`]).
///
/// # Errors
/// [`Cancelled`] by the user.
pub(crate) fn part(
    extrema: &Extrema,
    links: &Links,
    own: &[f32],
    least: Least,
    evidence: &mut [[u8; 2]],
    scratch: &mut SmoothingScratch,
    progress: &Progress,
) -> Result<(), Cancelled> {
    if own.is_empty() {
        return Ok(());
    }
    scratch.resize(extrema.len());
    scratch.values.par_iter_mut().with_min_len(GRAIN).enumerate().for_each(|(v, value)| {
        *value = [own[v], extrema.amplitude[v], 0.0, 0.0];
    });
    smoothing::across(extrema, links, Passable::All, scratch);
    let of_its_own = |[own, all, ..]: Four| own >= least.share * all && own >= LEAST_OVER_NOISE * least.noise;
    let reflects: Vec<bool> = scratch.values.par_iter().with_min_len(GRAIN).map(|&value| of_its_own(value)).collect();
    progress.check()?;
    evidence.par_iter_mut().with_min_len(GRAIN).enumerate().for_each(|(v, evidence)| {
        for (evidence, direction) in evidence.iter_mut().zip([NEXT_X, NEXT_Y]) {
            let next = links.to[direction][v];
            if next != NONE && reflects[v] != reflects[next as usize] {
                *evidence = MOST;
            }
        }
    });
    Ok(())
}

/// Count of extrema that one thread handles at a time.
const GRAIN: usize = 1 << 14;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::extrema::find_extrema;
    use survey::Volume;

    /// A Ricker wavelet whose lobes are 3.1 samples away.
    fn ricker(samples: f32) -> f32 {
        let square = (std::f32::consts::PI * samples / 8.0).powi(2);
        (1.0 - 2.0 * square) * (-square).exp()
    }

    #[test]
    fn reflectors_have_their_height_to_themselves_and_lobes_have_nothing() {
        // A reflector every 9 or 13 samples, of alternating polarity and uneven strength, so that lobes of
        // two reflectors lie beside one another.
        let reflectors: Vec<(f32, f32)> =
            (0..8).map(|n| (20.3 + 11.0 * n as f32 - 2.0 * (n % 2) as f32, [1.0, -0.8, 0.6, -0.9][n % 4])).collect();
        let mut volume = Volume::filled([6, 6, 128], 0.0f32);
        for (z, value) in volume.samples_mut().iter_mut().enumerate() {
            *value = reflectors.iter().map(|(at, strength)| strength * ricker((z % 128) as f32 - at)).sum();
        }
        let extrema = find_extrema(&volume, &[Extremum::Peak, Extremum::Trough], 16, &Progress::silent()).unwrap();
        let own = own_heights(&extrema);
        let (mut reflecting, mut lobes) = (0, 0);
        for (extrema, own) in extrema.iter().zip(&own) {
            for v in extrema.on_trace(3, 3) {
                let nearest = reflectors.iter().map(|(at, _)| (at - extrema.z[v]).abs()).fold(f32::INFINITY, f32::min);
                let share = own[v] / extrema.amplitude[v];
                if nearest < 0.5 {
                    assert!((0.8..1.2).contains(&share), "reflector at {}: {share}", extrema.z[v]);
                    reflecting += 1;
                } else if (2.4..3.6).contains(&nearest) {
                    assert!(share < 0.2, "lobe at {}: {share}", extrema.z[v]);
                    lobes += 1;
                }
            }
        }
        assert!(reflecting == 8 && lobes >= 12, "{reflecting} {lobes}");
    }

    #[test]
    fn what_rings_or_is_of_one_kind_has_no_lobes_to_be_told() {
        let mut volume = Volume::filled([6, 6, 128], 0.0f32);
        for (z, value) in volume.samples_mut().iter_mut().enumerate() {
            *value = ((z % 128) as f32 * 0.8).sin();
        }
        let extrema = find_extrema(&volume, &[Extremum::Peak, Extremum::Trough], 16, &Progress::silent()).unwrap();
        assert!(own_heights(&extrema).iter().all(Vec::is_empty));
        assert!(own_heights(&extrema[..1])[0].is_empty());
    }
}
