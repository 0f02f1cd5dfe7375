//! Long work: it runs on a thread of its own without Python's lock, while the thread that called waits, hands progress to
//! Python and looks for signals. So a callback runs where its author expects it, Ctrl-C cancels, and other threads of
//! Python go on.

use crate::refusal;
use petroglyph::Refusal;
use pyo3::prelude::*;
use std::error::Error;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;
use survey::progress::ProgressSink;
use survey::{Note, Progress};

/// How often signals are looked for, and progress is told.
const INTERVAL: Duration = Duration::from_millis(40);

/// What there is to tell.
#[derive(Default, Clone, PartialEq)]
struct Told {
    stage: String,
    done: u64,
    total: u64,
}

/// Keeps the newest progress until the caller's thread tells it.
#[derive(Default)]
struct Sink {
    newest: Mutex<Told>,
    warnings: Mutex<Vec<String>>,
}

impl ProgressSink for Sink {
    fn begin(&self, stage: &str, total: u64) {
        *self.newest.lock().unwrap_or_else(PoisonError::into_inner) = Told { stage: stage.to_owned(), done: 0, total };
    }

    fn advance(&self, done: u64) {
        self.newest.lock().unwrap_or_else(PoisonError::into_inner).done = done;
    }

    fn warn(&self, note: &Note) {
        self.warnings.lock().unwrap_or_else(PoisonError::into_inner).push(note.to_string());
    }
}

impl Sink {
    /// Tells what is new: `callback(stage, done, total)`, and warnings as Python's own.
    fn tell(&self, py: Python<'_>, callback: Option<&Bound<'_, PyAny>>, last: &mut Told) -> PyResult<()> {
        let warnings = std::mem::take(&mut *self.warnings.lock().unwrap_or_else(PoisonError::into_inner));
        if !warnings.is_empty() {
            let errors = py.import("petroglyph._errors")?;
            let (warn, category) = (py.import("warnings")?.getattr("warn")?, errors.getattr("PetroglyphWarning")?);
            for text in warnings {
                warn.call1((text, &category, 3))?;
            }
        }
        let newest = self.newest.lock().unwrap_or_else(PoisonError::into_inner).clone();
        if let Some(callback) = callback.filter(|_| newest != *last) {
            callback.call1((&newest.stage, newest.done, newest.total))?;
            *last = newest;
        }
        Ok(())
    }
}

/// Does long work, which can be cancelled by Ctrl-C or by an exception in the callback, which then is raised.
pub(crate) fn long<T: Send>(
    py: Python<'_>,
    callback: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(&Progress) -> Result<T, Refusal> + Send,
) -> PyResult<T> {
    let sink = Arc::new(Sink::default());
    let progress = Progress::new(sink.clone());
    let (finished, wait) = channel();
    // Used by this thread alone; without Python's lock only what may be shared is used.
    let wait = Mutex::new(wait);
    let mut last = Told::default();
    let mut raised: Option<PyErr> = None;
    let outcome = std::thread::scope(|scope| {
        let worker = &progress;
        scope.spawn(move || {
            // Nobody hears it only where the caller's thread has panicked.
            let _ = finished.send(work(worker));
        });
        loop {
            let arrived = py.detach(|| wait.lock().unwrap_or_else(PoisonError::into_inner).recv_timeout(INTERVAL));
            match arrived {
                Ok(outcome) => return Some(outcome),
                Err(RecvTimeoutError::Disconnected) => return None,
                Err(RecvTimeoutError::Timeout) if raised.is_some() => {}
                Err(RecvTimeoutError::Timeout) => {
                    let told = py.check_signals().and_then(|()| sink.tell(py, callback, &mut last));
                    if let Err(error) = told {
                        progress.cancel();
                        raised = Some(error);
                    }
                }
            }
        }
    });
    if let Some(error) = raised {
        return Err(error);
    }
    match outcome {
        None => Err(refusal::interrupted()),
        Some(Err(refused)) => Err(refusal::exception(py, &refused)),
        Some(Ok(value)) => {
            sink.tell(py, callback, &mut last)?;
            Ok(value)
        }
    }
}

/// The same for work whose error is that of a library.
pub(crate) fn long_of<T: Send, E: Error + Send + Sync + 'static>(
    py: Python<'_>,
    callback: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(&Progress) -> Result<T, E> + Send,
) -> PyResult<T> {
    long(py, callback, |progress| work(progress).map_err(petroglyph::explain))
}

/// Does work on `threads` threads, or on as many as there are processors.
pub(crate) fn on<T: Send>(
    threads: Option<usize>,
    work: impl FnOnce() -> Result<T, Refusal> + Send,
) -> Result<T, Refusal> {
    match threads {
        None => work(),
        Some(threads) => {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().map_err(petroglyph::explain)?;
            pool.install(work)
        }
    }
}

/// Does the work of a task: on one thread, without Python's lock.
pub(crate) fn task<T: Send, E: Error + Send + Sync + 'static>(
    py: Python<'_>,
    work: impl FnOnce() -> Result<T, E> + Send,
) -> PyResult<T> {
    py.detach(|| {
        let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().map_err(petroglyph::explain)?;
        one.install(work).map_err(petroglyph::explain)
    })
    .map_err(|refused| refusal::exception(py, &refused))
}
