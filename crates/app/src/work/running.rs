//! What is under way: titles, progress, a way to stop.

use super::Wake;
use crate::state::Place;
use state::fields;
use std::fmt;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};
use survey::progress::ProgressSink;
use survey::{Note, Progress};

/// Smallest interval at which progress wakes the window.
const WAKE_EVERY: Duration = Duration::from_millis(100);

/// What is done.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Job {
    /// Horizon candidates are extracted.
    Extraction,
    /// Faults are proposed.
    FaultProposals,
    /// Anything else, in words.
    Other(String),
}

impl fmt::Display for Job {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Extraction => "Extracting",
            Self::FaultProposals => "Proposing faults",
            Self::Other(title) => title,
        })
    }
}

impl<T: Into<String>> From<T> for Job {
    fn from(title: T) -> Self {
        Self::Other(title.into())
    }
}

/// A job under way.
#[derive(Clone)]
pub struct RunningLine {
    /// A number that no other job has.
    pub id: u64,
    /// What it does.
    pub job: Job,
    /// Where its failure would be shown.
    pub place: Place,
    /// Its present stage.
    pub stage: String,
    /// Steps done and steps in all; 0 in all means unknown.
    pub steps: [u64; 2],
    /// Its warnings.
    pub warnings: Vec<String>,
    /// A handle to cancel it.
    pub progress: Progress,
}

impl RunningLine {
    /// The share of the present stage that is done.
    pub fn share(&self) -> Option<f32> {
        let [done, total] = self.steps;
        (total > 0).then(|| (done as f32 / total as f32).clamp(0.0, 1.0))
    }
}

/// The list of jobs under way. Cheap to clone.
#[derive(Clone, Default)]
pub struct Running {
    lines: Arc<Mutex<Vec<RunningLine>>>,
    next: Arc<AtomicU64>,
}

impl Running {
    /// Adds a job; it is listed for as long as the guard lives.
    pub fn begin(&self, job: impl Into<Job>, place: Place, wake: Wake) -> (RunningGuard, Progress) {
        let id = self.next.fetch_add(1, Ordering::Relaxed);
        let sink = Sink { id, running: self.clone(), wake, woke: Mutex::new(Instant::now()) };
        let progress = Progress::new(Arc::new(sink));
        let line = RunningLine {
            id,
            job: job.into(),
            place,
            stage: String::new(),
            steps: [0; 2],
            warnings: Vec::new(),
            progress: progress.clone(),
        };
        self.with(|lines| lines.push(line));
        (RunningGuard { id, running: self.clone() }, progress)
    }

    /// The jobs that are under way now.
    pub fn lines(&self) -> Vec<RunningLine> {
        self.with(|lines| lines.clone())
    }

    /// Whether no job is under way.
    pub fn is_idle(&self) -> bool {
        self.with(|lines| lines.is_empty())
    }

    fn with<T>(&self, change: impl FnOnce(&mut Vec<RunningLine>) -> T) -> T {
        change(&mut self.lines.lock().unwrap_or_else(PoisonError::into_inner))
    }

    fn of(&self, id: u64, change: impl FnOnce(&mut RunningLine)) {
        self.with(|lines| lines.iter_mut().find(|line| line.id == id).map(change));
    }
}

/// Keeps a job on the list while it lives.
pub struct RunningGuard {
    id: u64,
    running: Running,
}

impl RunningGuard {
    /// The warnings of the job.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        self.running.of(self.id, |line| warnings.clone_from(&line.warnings));
        warnings
    }
}

impl Drop for RunningGuard {
    fn drop(&mut self) {
        self.running.with(|lines| lines.retain(|line| line.id != self.id));
    }
}

struct Sink {
    id: u64,
    running: Running,
    wake: Wake,
    woke: Mutex<Instant>,
}

impl ProgressSink for Sink {
    fn begin(&self, stage: &str, total: u64) {
        self.running.of(self.id, |line| {
            stage.clone_into(&mut line.stage);
            line.steps = [0, total];
        });
        (self.wake)();
    }

    fn advance(&self, done: u64) {
        // Steps come by the thousand, so the list is locked and the window woken only from time to time.
        let Ok(mut woke) = self.woke.try_lock() else { return };
        if woke.elapsed() < WAKE_EVERY {
            return;
        }
        *woke = Instant::now();
        self.running.of(self.id, |line| line.steps[0] = done);
        (self.wake)();
    }

    fn warn(&self, note: &Note) {
        self.running.of(self.id, |line| line.warnings.push(fields::note(note)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_job_is_listed_while_it_lives_and_can_be_stopped() {
        let running = Running::default();
        let (guard, progress) = running.begin("count", Place::Data, Arc::new(|| {}));
        progress.begin("ones", 10);
        progress.warn("slowly");
        let line = running.lines().remove(0);
        assert_eq!((line.job.to_string(), line.stage.as_str(), line.share()), ("count".to_owned(), "ones", Some(0.0)));
        line.progress.cancel();
        assert!(progress.check().is_err());
        assert_eq!(guard.warnings(), ["slowly"]);
        drop(guard);
        assert!(running.is_idle());
    }
}
