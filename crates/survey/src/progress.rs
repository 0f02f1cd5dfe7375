//! Progress and cancellation of long computations. Every long call takes a [`Progress`] and checks it
//! regularly.

use crate::remedy::Note;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// The user cancelled the work. Nothing was written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("cancelled")]
pub struct Cancelled;

/// Receives progress: a bar in a terminal, a window, or nothing.
pub trait ProgressSink: Send + Sync {
    /// A stage of `total` steps begins.
    fn begin(&self, stage: &str, total: u64);
    /// `done` steps of the current stage are finished.
    fn advance(&self, done: u64);
    /// Something the user should know, which does not stop the work.
    fn warn(&self, note: &Note);
}

/// A sink that ignores everything.
struct Silent;

impl ProgressSink for Silent {
    fn begin(&self, _stage: &str, _total: u64) {}
    fn advance(&self, _done: u64) {}
    fn warn(&self, _note: &Note) {}
}

/// A handle shared by the worker and its observer. It is cheap to clone.
///
/// ```
/// # use survey::{Cancelled, Progress};
/// let progress = Progress::silent();
/// let inner = progress.muted();
/// progress.begin("read traces", 100);
/// assert_eq!(progress.step(10), Ok(()));
/// progress.cancel();
/// assert_eq!(progress.step(10), Err(Cancelled));
/// assert_eq!(inner.check(), Err(Cancelled));
/// ```
#[derive(Clone)]
pub struct Progress {
    sink: Arc<dyn ProgressSink>,
    cancelled: Arc<AtomicBool>,
    done: Arc<AtomicU64>,
}

impl Progress {
    /// A handle that reports to `sink`.
    pub fn new(sink: Arc<dyn ProgressSink>) -> Self {
        Self { sink, cancelled: Arc::default(), done: Arc::default() }
    }

    /// A handle that reports to nobody. It can still be cancelled.
    pub fn silent() -> Self {
        Self::new(Arc::new(Silent))
    }

    /// A handle for work that is a part of one step: it reports to nobody and is cancelled together with this
    /// one.
    pub fn muted(&self) -> Self {
        Self { sink: Arc::new(Silent), cancelled: self.cancelled.clone(), done: Arc::default() }
    }

    /// Begins a stage of `total` steps.
    pub fn begin(&self, stage: &str, total: u64) {
        self.done.store(0, Ordering::Relaxed);
        self.sink.begin(stage, total);
    }

    /// Adds `steps` finished steps. It may be called from any thread.
    ///
    /// # Errors
    /// [`Cancelled`] once [`Progress::cancel`] was called.
    pub fn step(&self, steps: u64) -> Result<(), Cancelled> {
        let done = self.done.fetch_add(steps, Ordering::Relaxed) + steps;
        self.sink.advance(done);
        self.check()
    }

    /// Checks whether the work may go on.
    ///
    /// # Errors
    /// [`Cancelled`] once [`Progress::cancel`] was called.
    pub fn check(&self) -> Result<(), Cancelled> {
        if self.cancelled.load(Ordering::Relaxed) { Err(Cancelled) } else { Ok(()) }
    }

    /// Tells the user something that does not stop the work.
    pub fn warn(&self, note: impl Into<Note>) {
        self.sink.warn(&note.into());
    }

    /// Asks the work to stop at its next check.
    pub fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cancel_reaches_a_clone() {
        let progress = Progress::silent();
        let worker = progress.clone();
        assert_eq!(worker.step(1), Ok(()));
        progress.cancel();
        assert_eq!(worker.step(1), Err(Cancelled));
    }
}
