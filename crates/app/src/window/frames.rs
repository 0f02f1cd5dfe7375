//! The duration of frames, as a CSV table with one line for each frame.

use crate::error::WindowError;
use crate::work::RunningLine;
use std::fs::File;
use std::io::{LineWriter, Write};
use std::path::Path;
use std::time::Instant;

/// The table being written.
pub(super) struct FrameTimes {
    out: LineWriter<File>,
    begun: Instant,
    last: Option<Instant>,
}

impl FrameTimes {
    pub(super) fn create(path: &Path) -> Result<Self, WindowError> {
        let failed = |source| WindowError::FrameTimes { path: path.to_owned(), source };
        let mut out = LineWriter::new(File::create(path).map_err(failed)?);
        writeln!(out, "at_s,since_last_ms,laid_out_in_ms,under_way").map_err(failed)?;
        Ok(Self { out, begun: Instant::now(), last: None })
    }

    /// Records a frame that was begun at `start` and has just been laid out.
    pub(super) fn record(&mut self, start: Instant, under_way: &[RunningLine]) {
        let since_last = self.last.replace(start).map(|last| start - last);
        let Some(since_last) = since_last else { return };
        let ms = |seconds: f64| 1000.0 * seconds;
        let titles: Vec<String> = under_way.iter().map(|line| line.job.to_string()).collect();
        // A full disk ends the table, but not the work.
        let _ = writeln!(
            self.out,
            "{:.3},{:.2},{:.2},{}",
            (start - self.begun).as_secs_f64(),
            ms(since_last.as_secs_f64()),
            ms(start.elapsed().as_secs_f64()),
            titles.join(" + ")
        );
    }
}
