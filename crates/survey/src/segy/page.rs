//! The page that `info` prints.

use std::fmt::Write as _;

use super::info::SegyInfo;

/// Candidates shown.
const MAX_CANDIDATES: usize = 5;

impl SegyInfo {
    /// A page for people: what the file holds, how that was found, its textual header.
    pub fn page(&self) -> String {
        let mut page = String::new();
        // Writing to a string cannot fail.
        let _ = self.write_page(&mut page);
        page
    }

    fn write_page(&self, page: &mut String) -> std::fmt::Result {
        let unit = self.vertical_unit.symbol();
        writeln!(page, "{}", self.file.display())?;
        writeln!(
            page,
            "SEG-Y revision {}, {}, {} samples (code {}), {} text, {} bytes",
            self.revision,
            self.byte_order.name(),
            self.sample_format.name(),
            self.format_code,
            self.text_encoding.name(),
            self.bytes
        )?;
        writeln!(page)?;
        writeln!(
            page,
            "inlines     {:>6}   {}   byte {}",
            self.inlines.count, self.inlines, self.byte_positions.inline
        )?;
        writeln!(
            page,
            "crosslines  {:>6}   {}   byte {}",
            self.crosslines.count, self.crosslines, self.byte_positions.crossline
        )?;
        let last = self.start + self.interval * (self.samples as f64 - 1.0);
        writeln!(
            page,
            "samples     {:>6}   {} to {last} {unit}, every {} {unit}",
            self.samples, self.start, self.interval
        )?;
        writeln!(
            page,
            "traces      {:>6}   {} missing, {} dead, {} duplicate; sorted by {}",
            self.traces, self.missing_traces, self.dead_traces, self.duplicate_traces, self.sorted_by
        )?;
        let length = self.coordinate_unit.symbol();
        let g = &self.geometry;
        // Without this, rounding shows -0.
        let [a, b] = [g.inline_vector, g.crossline_vector].map(|v| v.map(|c| (c * 1000.0).round() / 1000.0 + 0.0));
        writeln!(page, "origin      {:.2}, {:.2} {length}", g.origin[0], g.origin[1])?;
        writeln!(page, "inline +1   {:+.3}, {:+.3} {length}", a[0], a[1])?;
        writeln!(page, "crossl. +1  {:+.3}, {:+.3} {length}", b[0], b[1])?;
        for (title, notes) in [("Evidence", &self.evidence), ("Assumed", &self.assumptions), ("Beware", &self.warnings)]
        {
            if !notes.is_empty() {
                writeln!(page, "\n{title}")?;
                notes.iter().try_for_each(|note| writeln!(page, "- {note}"))?;
            }
        }
        if !self.candidates.is_empty() {
            writeln!(page, "\nLine numbers that were looked for (score)")?;
            for candidate in self.candidates.iter().take(MAX_CANDIDATES) {
                writeln!(page, "- {:.2}  {}", candidate.score, candidate.as_sentence())?;
            }
        }
        writeln!(page, "\nText header")?;
        let lines = self.text.iter().chain(&self.extended_text);
        lines.filter(|line| line.len() > 3).try_for_each(|line| writeln!(page, "{line}"))
    }
}
