//! Progress on stderr, and Ctrl-C.

use super::option;
use super::plain::plain;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::Write;
use std::sync::{Arc, Mutex, PoisonError};
use survey::progress::ProgressSink;
use survey::{Note, Progress};

/// A progress bar; silent where stderr is not a terminal. Warnings are printed at once and kept for the report.
pub(super) struct Terminal {
    bar: ProgressBar,
    warnings: Mutex<Vec<String>>,
}

impl Terminal {
    /// A progress bar whose work Ctrl-C cancels; a second Ctrl-C ends the process at once.
    pub(super) fn start() -> (Arc<Self>, Progress) {
        let bar = ProgressBar::new(0);
        if let Ok(style) = ProgressStyle::with_template("{msg:28} {wide_bar} {percent:>3} % {eta:>4}") {
            bar.set_style(style);
        }
        let terminal = Arc::new(Self { bar, warnings: Mutex::default() });
        let progress = Progress::new(terminal.clone());
        let cancel = progress.clone();
        let handler = ctrlc::set_handler(move || {
            if cancel.check().is_err() {
                std::process::exit(1);
            }
            cancel.cancel();
        });
        if let Err(error) = handler {
            let _ = writeln!(std::io::stderr(), "warning: Ctrl-C will end the program at once ({error})");
        }
        (terminal, progress)
    }

    /// Removes the bar; returns the warnings.
    pub(super) fn finish(&self) -> Vec<String> {
        self.bar.finish_and_clear();
        std::mem::take(&mut *self.warnings.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

impl ProgressSink for Terminal {
    fn begin(&self, stage: &str, total: u64) {
        self.bar.set_length(total);
        self.bar.set_position(0);
        self.bar.reset_eta();
        self.bar.set_message(plain(stage).into_owned());
    }

    fn advance(&self, done: u64) {
        self.bar.set_position(done);
    }

    fn warn(&self, note: &Note) {
        let mut note = note.clone();
        option::name_in([&mut note]);
        self.bar.suspend(|| {
            let _ = writeln!(std::io::stderr(), "warning: {}", plain(&note.to_string()));
        });
        self.warnings.lock().unwrap_or_else(PoisonError::into_inner).push(note.to_string());
    }
}
