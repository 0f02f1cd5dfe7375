//! An index of the true reflectors by trace and depth.

use rayon::prelude::*;
use std::ops::Range;
use synth::{Reflector, SynthTruth};

/// A reflector on one trace.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TruthEvent {
    /// Fractional sample index.
    pub z: f32,
    /// Index into `TruthIndex::reflectors`.
    pub reflector: u16,
    /// Fault block in which it lies.
    pub block: u16,
}

/// All true reflectors inside a volume, by trace and depth. Memory: 8 bytes an event, with about 20 events a
/// trace.
#[derive(Debug, Clone, PartialEq)]
pub struct TruthIndex {
    size: [usize; 3],
    reflectors: Vec<Reflector>,
    /// First event of each trace, and the end of the last trace.
    starts: Vec<usize>,
    events: Vec<TruthEvent>,
}

impl TruthIndex {
    /// Evaluates the truth's closed form on every trace.
    pub fn new(truth: &SynthTruth) -> Self {
        let [nx, ny, nz] = truth.size;
        let young = truth.young_column.reflectors_m.len();
        let reflectors: Vec<Reflector> = (0..young + truth.old_column.reflectors_m.len())
            .map(|n| Reflector { old: n >= young, index: if n >= young { n - young } else { n } as u16 })
            .collect();
        let of_trace = |trace: usize| -> Vec<TruthEvent> {
            let events = truth.events((trace / ny) as f64, (trace % ny) as f64).into_iter();
            let mut inside: Vec<TruthEvent> = events
                .filter(|event| event.z >= 0.0 && event.z <= (nz - 1) as f64)
                .map(|event| {
                    let Reflector { old, index } = event.reflector;
                    let reflector = index + if old { young as u16 } else { 0 };
                    TruthEvent { z: event.z as f32, reflector, block: event.block }
                })
                .collect();
            inside.sort_by(|a, b| a.z.total_cmp(&b.z));
            inside
        };
        let traces: Vec<Vec<TruthEvent>> = (0..nx * ny).into_par_iter().map(of_trace).collect();
        let mut starts = Vec::with_capacity(traces.len() + 1);
        starts.push(0);
        for trace in &traces {
            starts.push(starts[starts.len() - 1] + trace.len());
        }
        Self { size: truth.size, reflectors, starts, events: traces.concat() }
    }

    /// `[inlines, crosslines, samples]` of the survey.
    pub fn size(&self) -> [usize; 3] {
        self.size
    }

    /// All reflectors of the model: those above the unconformity, the unconformity, those below.
    pub(crate) fn reflectors(&self) -> &[Reflector] {
        &self.reflectors
    }

    /// Index of a reflector in `TruthIndex::reflectors`; `None` for a reflector of another truth.
    pub fn reflector_index(&self, reflector: Reflector) -> Option<usize> {
        self.reflectors.iter().position(|&other| other == reflector)
    }

    /// All events, trace by trace from the top down.
    pub fn events(&self) -> &[TruthEvent] {
        &self.events
    }

    /// Every trace (x·crosslines + y) with the range of its events.
    pub fn traces(&self) -> impl Iterator<Item = (usize, Range<usize>)> + '_ {
        self.starts.windows(2).enumerate().map(|(trace, ends)| (trace, ends[0]..ends[1]))
    }

    /// Trace (x·crosslines + y) of an event.
    pub(crate) fn trace_of(&self, event: usize) -> usize {
        self.starts.partition_point(|&start| start <= event) - 1
    }

    /// Range of the events of trace (x, y) within `tolerance` samples of `z`; empty outside the survey.
    pub fn range_near(&self, x: usize, y: usize, z: f32, tolerance: f32) -> Range<usize> {
        if x >= self.size[0] || y >= self.size[1] {
            return 0..0;
        }
        let trace = x * self.size[1] + y;
        let (start, end) = (self.starts[trace], self.starts[trace + 1]);
        let events = &self.events[start..end];
        let first = events.partition_point(|event| event.z < z - tolerance);
        let last = first + events[first..].partition_point(|event| event.z <= z + tolerance);
        start + first..start + last
    }

    /// The events of [`TruthIndex::range_near`].
    pub fn near(&self, x: usize, y: usize, z: f32, tolerance: f32) -> &[TruthEvent] {
        &self.events[self.range_near(x, y, z, tolerance)]
    }
}
