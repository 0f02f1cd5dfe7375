//! All stages of an extraction in bricks, one after the other, in stated memory; a killed run goes on where it was.

use super::Bricks;
use super::stage::Stage;
use crate::error::InterpError;
use crate::extraction::{ExtractReport, StageSeconds};
use rayon::ThreadPoolBuilder;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;
use survey::Progress;
use survey::candidates::ForestRows;

/// Bytes that the work on a brick takes at most for each sample of it and of its halo (measured).
const BYTES_A_SAMPLE: u64 = 10;

/// Bytes that trees take for each triangle of the surfaces in work.
pub(super) const BYTES_A_TRIANGLE: u64 = 130;

/// Traces that the widest halo adds on both sides of a brick.
const WIDEST_HALO: u64 = 2 * 24;

/// Least edge of a brick, traces.
const LEAST_EDGE: u64 = 24;

/// Rows of a table that are read at a time.
const ROWS: usize = 1 << 16;

/// How an extraction is cut.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BrickSettings {
    /// Traces of a brick along x and y.
    pub edge: [usize; 2],
    /// Triangles of the surfaces whose trees one task builds, unless one surface has more.
    pub triangles_together: u64,
    /// Tasks that are done at a time, each on one thread.
    pub workers: usize,
}

impl BrickSettings {
    /// The bricks for a volume of `size` whose extraction is to take at most so many bytes.
    ///
    /// # Errors
    /// [`InterpError::TooLittleMemory`] when not even the smallest brick fits.
    pub fn within(memory_bytes: u64, size: [usize; 3], workers: usize) -> Result<Self, InterpError> {
        let samples = size[2].max(1) as u64;
        // Numbers of a trace that every task keeps, for two kinds of extrema.
        let fixed = 8 * (size[0] * size[1]) as u64;
        let traces_of = |workers: u64| memory_bytes.saturating_sub(fixed) / workers / BYTES_A_SAMPLE / samples;
        let edge_of = |workers: u64| (traces_of(workers) as f64).sqrt() as u64;
        // Fewer tasks at a time rather than bricks that are mostly halo.
        let mut workers = workers.max(1) as u64;
        while workers > 1 && edge_of(workers) < 2 * WIDEST_HALO {
            workers -= 1;
        }
        let edge = edge_of(workers);
        if edge < LEAST_EDGE + WIDEST_HALO {
            let side = LEAST_EDGE + WIDEST_HALO;
            let least = fixed + side * side * BYTES_A_SAMPLE * samples;
            return Err(InterpError::TooLittleMemory { stated: memory_bytes, samples: size[2], least });
        }
        let inside = (edge - WIDEST_HALO) as usize;
        let triangles_together = (memory_bytes / workers / BYTES_A_TRIANGLE).max(1);
        Ok(Self {
            edge: [size[0], size[1]].map(|lines| even(lines, inside)),
            triangles_together,
            workers: workers as usize,
        })
    }

    /// The same with bricks of at most `edge` traces along x and y of a volume of `size`: more tasks, for more workers.
    #[must_use]
    pub fn with_edge(self, edge: usize, size: [usize; 3]) -> Self {
        let edge = [0, 1].map(|axis| even(size[axis], self.edge[axis].min(edge.max(1))));
        Self { edge, ..self }
    }
}

/// The edge of bricks of equal size, at most `most`, rather than with a narrow rest.
fn even(lines: usize, most: usize) -> usize {
    lines.div_ceil(lines.div_ceil(most).max(1)).max(1)
}

/// Name of the array that notes which tasks of a stage are done.
fn done(stage: Stage) -> String {
    format!("done-{}", stage.name())
}

impl Bricks<'_> {
    /// Does all tasks of all stages, `workers` at a time, but for those that an earlier run has done with the same
    /// source, settings and bricks. Afterwards the tables and columns can be read.
    ///
    /// # Errors
    /// [`InterpError`]; what is done by then need not be done again.
    pub fn run(&self, workers: usize, progress: &Progress) -> Result<ExtractReport, InterpError> {
        let start = Instant::now();
        let mut seconds = StageSeconds::default();
        for stage in self.stages() {
            let begun = Instant::now();
            self.run_stage(stage, workers, progress)?;
            let taken = begun.elapsed().as_secs_f64();
            match stage {
                _ if stage.is_growing() => seconds.growing += taken,
                _ if stage.is_trees() => seconds.trees += taken,
                _ => seconds.distances += taken,
            }
        }
        seconds.total = start.elapsed().as_secs_f64();
        let mut report = self.report()?;
        report.seconds = Some(seconds);
        Ok(report)
    }

    /// Count of stages that an earlier run has done.
    pub fn done_stages(&self) -> usize {
        let is_done = |stage: &Stage| self.arrays.is_whole(&done(*stage), usize::MAX);
        self.stages().iter().take_while(|stage| is_done(stage)).count()
    }

    /// Does a task unless it is noted as done, and notes it. So a task may be asked for again at any time, even when what
    /// it read has been removed: a cluster repeats tasks whose answer was lost with a machine.
    ///
    /// # Errors
    /// As `Bricks::run_task`.
    pub fn do_task(&self, stage: Stage, task: usize, progress: &Progress) -> Result<(), InterpError> {
        let done = done(stage);
        if self.arrays.is_whole(&done, usize::MAX) || self.arrays.is_whole(&done, task) {
            return Ok(());
        }
        self.run_task(stage, task, progress)?;
        self.write::<u8>(&done, task, &[])
    }

    /// Notes that all tasks of a stage are done, and removes the arrays that no later stage reads.
    ///
    /// # Errors
    /// The note cannot be written.
    pub fn close_stage(&self, stage: Stage) -> Result<(), InterpError> {
        self.write::<u8>(&done(stage), usize::MAX, &[])?;
        for array in stage.last_to_read() {
            self.arrays.remove(array);
            (0..self.kinds.len()).for_each(|kind| self.arrays.remove(&self.name(array, kind)));
        }
        Ok(())
    }

    /// Does all tasks of a stage that are not done yet.
    fn run_stage(&self, stage: Stage, workers: usize, progress: &Progress) -> Result<(), InterpError> {
        let done = done(stage);
        if self.arrays.is_whole(&done, usize::MAX) {
            return Ok(());
        }
        let tasks: Vec<usize> = (0..self.tasks(stage)?).filter(|&task| !self.arrays.is_whole(&done, task)).collect();
        progress.begin(stage.doing(), tasks.len() as u64);
        let (next, failure) = (AtomicUsize::new(0), Mutex::new(None));
        let work = || {
            while let Some(&task) = tasks.get(next.fetch_add(1, Ordering::Relaxed)) {
                if let Err(error) = self.do_task(stage, task, progress).and_then(|()| Ok(progress.step(1)?)) {
                    // Others stop at their next task.
                    next.store(tasks.len(), Ordering::Relaxed);
                    failure.lock().unwrap_or_else(std::sync::PoisonError::into_inner).get_or_insert(error);
                }
            }
        };
        if stage.is_merging() {
            work();
        } else {
            std::thread::scope(|scope| {
                for _ in 0..workers.clamp(1, tasks.len().max(1)) {
                    // A pool of one thread: what a task does in parallel elsewhere stays on its thread.
                    scope.spawn(|| match ThreadPoolBuilder::new().num_threads(1).build() {
                        Ok(pool) => pool.install(work),
                        Err(_) => work(),
                    });
                }
            });
        }
        if let Some(error) = failure.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner) {
            return Err(error);
        }
        self.close_stage(stage)
    }

    /// The summary of an extraction whose stages are done, without times.
    ///
    /// # Errors
    /// An array cannot be read.
    pub fn report(&self) -> Result<ExtractReport, InterpError> {
        let forest = self.forest()?;
        let counts = forest.counts();
        let (mut undersized, mut largest) = (0, 0);
        for first in (0..counts.surfaces).step_by(ROWS) {
            let rows = forest.surfaces(first..(first + ROWS).min(counts.surfaces)).map_err(InterpError::Arrays)?;
            for [.., start, end] in rows {
                largest = largest.max((end - start) as usize);
                undersized += usize::from(end - start < self.settings.forest.min_leaf_triangles);
            }
        }
        let mut reached = 0u64;
        for column in 0..self.column_count() {
            reached += u64::from(self.read::<u32>("reached", column)?[0]);
        }
        let leaves = forest.leaf_count();
        Ok(ExtractReport {
            settings: self.settings.clone(),
            surfaces: counts.surfaces,
            leaves,
            undersized,
            triangles: counts.triangles,
            vertices: counts.vertices,
            largest,
            within_reach: reached as f64 / self.size.iter().product::<usize>().max(1) as f64,
            leaf_id_bytes: if leaves > usize::from(u16::MAX) { 4 } else { 2 },
            seconds: None,
        })
    }
}
