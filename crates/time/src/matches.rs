//! What matches across faults once τ is nearly right: ties from the logs of both sides.
//!
//! Near the fault both sides are stacked in τ over stretches of it, and the warp between the two logs says by how much
//! their times still differ. Ties then join, on every line, the points of one time.

use crate::cuts::Cut;
use crate::logs::{Log, Warp};
use crate::solve::{Tie, interpolate};
use crate::throws::{FIRST, Side, beside};
use rayon::prelude::*;
use survey::Volume;

/// Distance of the last trace of a log from the fault, traces.
const LAST: f32 = 9.0;
/// Least count of amplitudes in a bin of a log.
const LEAST: f32 = 3.0;
/// Quality of a warp below which nothing is tied.
const LEAST_QUALITY: f32 = 0.15;

/// τ and amplitudes.
pub(crate) struct Timed<'a> {
    /// Amplitudes.
    pub volume: &'a Volume<f32>,
    /// s = τ − z.
    pub s: &'a [f32],
}

impl Timed<'_> {
    fn s_on(&self, [x, y]: [usize; 2]) -> &[f32] {
        let [_, ny, nz] = self.volume.size();
        let at = (x * ny + y) * nz;
        &self.s[at..at + nz]
    }

    /// Least and greatest τ.
    pub(crate) fn range(&self) -> [f32; 2] {
        let nz = self.volume.size()[2];
        let of = |trace: &[f32]| {
            trace
                .iter()
                .enumerate()
                .fold([f32::INFINITY, f32::NEG_INFINITY], |[a, b], (z, s)| [a.min(s + z as f32), b.max(s + z as f32)])
        };
        let both = |a: [f32; 2], b: [f32; 2]| [a[0].min(b[0]), a[1].max(b[1])];
        self.s.par_chunks(nz).map(of).reduce(|| [f32::INFINITY, f32::NEG_INFINITY], both)
    }

    /// The log of one side of a stretch of a fault.
    fn log(&self, cut: &Cut, lines: std::ops::Range<usize>, side: Side, range: [f32; 2]) -> Log {
        let size = self.volume.size();
        let mut log = Log::new(range[0], range[1]);
        for line in lines {
            for z in 0..size[2] {
                let mut distance = FIRST;
                while distance <= LAST {
                    if let Some([x, y]) = beside(cut, size, line, z, side, distance) {
                        log.add(self.s_on([x, y])[z] + z as f32, self.volume.at(x, y, z));
                    }
                    distance += 1.0;
                }
            }
        }
        log
    }

    /// The point beside a fault on a line whose time is `time`, closest to sample `near`.
    fn point_of(&self, cut: &Cut, line: usize, side: Side, time: f32, near: f32) -> Option<([usize; 2], f32)> {
        let size = self.volume.size();
        let mut best: Option<([usize; 2], f32)> = None;
        for z in 0..size[2] - 1 {
            let Some(trace) = beside(cut, size, line, z, side, FIRST) else { continue };
            let s = self.s_on(trace);
            let (a, b) = (s[z] + z as f32 - time, s[z + 1] + z as f32 + 1.0 - time);
            if a <= 0.0 && b > 0.0 {
                let at = z as f32 - a / (b - a);
                if best.is_none_or(|(_, z)| (at - near).abs() < (z - near).abs()) {
                    best = Some((trace, at));
                }
            }
        }
        best
    }

    /// Ties across a fault: its lines are compared in `stretches` that overlap by half, with shifts up to `most` samples.
    pub(crate) fn ties(&self, cut: &Cut, stretches: usize, most: f32, step: [usize; 2], weight: f32) -> Vec<Tie> {
        let [lines, nz] = cut.size;
        let ny = self.volume.size()[1];
        let range = self.range();
        let pieces = 2 * stretches - 1;
        let width = lines as f32 / stretches as f32;
        let centre = |n: usize| width * 0.5 * (n + 1) as f32;
        let warps: Vec<Warp> = (0..pieces)
            .into_par_iter()
            .map(|n| {
                let from = (centre(n) - 0.5 * width).round() as usize;
                let to = ((centre(n) + 0.5 * width).round() as usize).min(lines);
                let [lower, upper] = [Side::Lower, Side::Upper].map(|side| self.log(cut, from..to, side, range));
                lower.fit(&upper, most, LEAST)
            })
            .collect();
        // Between the centres of two stretches both count.
        let read = |line: usize, of: &dyn Fn(&Warp) -> f32| {
            let at = (line as f32 / (0.5 * width) - 1.0).clamp(0.0, (pieces - 1) as f32);
            let low = (at as usize).min(pieces.saturating_sub(2));
            let share = at - low as f32;
            (1.0 - share) * of(&warps[low]) + share * of(&warps[(low + 1).min(pieces - 1)])
        };
        let chosen: Vec<usize> = (0..lines).step_by(step[0]).collect();
        chosen
            .into_par_iter()
            .flat_map_iter(|line| {
                (0..nz).step_by(step[1]).filter_map(move |z| {
                    let trace = beside(cut, self.volume.size(), line, z, Side::Lower, FIRST)?;
                    let time = interpolate(self.s_on(trace), z as f32) + z as f32;
                    let quality = read(line, &|warp| warp.quality(time));
                    if quality < LEAST_QUALITY {
                        return None;
                    }
                    let shift = read(line, &|warp| warp.shift(time));
                    let (other, at) = self.point_of(cut, line, Side::Upper, time + shift, z as f32)?;
                    Some(Tie {
                        trace: [trace, other].map(|[x, y]| (x * ny + y) as u32),
                        z: [z as f32, at],
                        weight: weight * quality.min(1.0),
                    })
                })
            })
            .collect()
    }
}
