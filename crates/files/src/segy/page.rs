//! A page of text about a SEG-Y file.

use std::fmt::{Result, Write as _};

use super::file::SegyFile;
use super::info::SegyInfo;
use super::map::{LEGEND, place_in_words};
use super::statistics::{AmplitudeHistogram, Statistics};

/// Candidates shown.
const MAX_CANDIDATES: usize = 8;

/// Rows of the histogram.
const ROWS: usize = 6;

impl SegyInfo {
    /// The page from the headers alone: what the file holds, how that was detected, and its textual header.
    pub fn page(&self) -> String {
        let mut page = String::new();
        // Writing to a string cannot fail.
        let _ = self.write_page(&mut page, &[], None);
        page
    }

    fn write_page(&self, page: &mut String, map: &[String], statistics: Option<&Statistics>) -> Result {
        self.write_file(page)?;
        self.write_axes(page)?;
        self.write_place(page, map)?;
        if let Some(statistics) = statistics {
            write_statistics(page, statistics)?;
        }
        for (title, notes) in [("Evidence", &self.evidence), ("Assumed", &self.assumptions), ("Beware", &self.warnings)]
        {
            if !notes.is_empty() {
                writeln!(page, "\n{title}")?;
                notes.iter().try_for_each(|note| writeln!(page, "- {note}"))?;
            }
        }
        self.write_candidates(page)?;
        writeln!(page, "\nText header")?;
        let lines = self.text.iter().chain(&self.extended_text);
        lines.filter(|line| line.len() > 3).try_for_each(|line| writeln!(page, "{line}"))
    }

    fn write_file(&self, page: &mut String) -> Result {
        writeln!(page, "{}", self.file.display())?;
        writeln!(
            page,
            "SEG-Y revision {}, {}, {} samples (code {}), {} text, {} bytes\n",
            self.revision,
            self.byte_order.name(),
            self.sample_format.name(),
            self.format_code,
            self.text_encoding.name(),
            self.bytes
        )
    }

    fn write_axes(&self, page: &mut String) -> Result {
        let byte = |byte: Option<u16>| byte.map_or("numbered by X and Y".to_owned(), |byte| format!("byte {byte}"));
        for (name, lines, at) in [
            ("inlines", self.inlines, self.byte_positions.inline),
            ("crosslines", self.crosslines, self.byte_positions.crossline),
        ] {
            writeln!(page, "{name:<11} {:>6}   {lines}   {}", lines.count, byte(at))?;
        }
        let unit = self.vertical_unit.symbol();
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
        )
    }

    fn write_place(&self, page: &mut String, map: &[String]) -> Result {
        let at = match (self.byte_positions.x, self.byte_positions.y) {
            (Some(x), Some(y)) => format!("X at byte {x}, Y at byte {y}"),
            _ => "assumed, no X and Y".to_owned(),
        };
        writeln!(page, "\nPlace ({at}), {}", self.coordinate_unit.symbol())?;
        for (letter, corner) in ('A'..).zip(&self.corners) {
            writeln!(
                page,
                "{letter}  inline {:>6}  crossline {:>6}   X {:>13.2}   Y {:>13.2}",
                corner.inline, corner.crossline, corner.x, corner.y
            )?;
        }
        place_in_words(self).iter().try_for_each(|words| writeln!(page, "{words}"))?;
        if let (Some(rms), Some(max)) = (self.geometry.residual_rms_bins, self.geometry.residual_max_bins) {
            writeln!(page, "X and Y lie off the lattice by {rms:.4} bin (root mean square), {max:.4} at most")?;
        }
        if !map.is_empty() {
            writeln!(page, "\nLive traces, north up   {LEGEND}")?;
            map.iter().try_for_each(|line| writeln!(page, "  {line}"))?;
        }
        Ok(())
    }

    fn write_candidates(&self, page: &mut String) -> Result {
        if self.candidates.is_empty() {
            return Ok(());
        }
        writeln!(page, "\nWhere line numbers were looked for\nscore  filled  off bin  bytes")?;
        for candidate in self.candidates.iter().take(MAX_CANDIDATES) {
            let residual = candidate.residual_bins.map_or("-".to_owned(), |bins| format!("{bins:.3}"));
            writeln!(
                page,
                "{:>5.2}  {:>5.0}%  {residual:>7}  {}{}",
                candidate.score,
                100.0 * candidate.filled,
                candidate.as_sentence(),
                if candidate.convention.is_empty() { String::new() } else { format!(" ({})", candidate.convention) }
            )?;
        }
        Ok(())
    }
}

impl SegyFile {
    /// The whole page: that of [`SegyInfo::page`], with a map of the live traces and a histogram of the
    /// amplitudes.
    pub fn page(&self, statistics: &Statistics) -> String {
        let mut page = String::new();
        // Writing to a string cannot fail.
        let _ = self.info().write_page(&mut page, &self.live_map(), Some(statistics));
        page
    }
}

fn write_statistics(page: &mut String, statistics: &Statistics) -> Result {
    let s = statistics;
    let share = |count: u64| 100.0 * count as f64 / s.samples.max(1) as f64;
    writeln!(page, "\nAmplitudes of {} of {} live traces", s.traces, s.live_traces)?;
    writeln!(
        page,
        "{} to {}, mean {}, root mean square {}",
        figure(f64::from(s.min)),
        figure(f64::from(s.max)),
        figure(s.mean),
        figure(s.rms)
    )?;
    let percentiles = s.percentiles.iter().map(|[percent, value]| format!("{percent} %: {}", figure(*value)));
    writeln!(page, "{}", percentiles.collect::<Vec<_>>().join("   "))?;
    writeln!(
        page,
        "{:.2} % zero, {} traces zero throughout, {} samples no numbers (no data), {} at the smallest or largest value ({:.4} %{})",
        share(s.zero),
        s.zero_traces,
        s.non_finite,
        s.at_limits,
        share(s.at_limits),
        if s.clipped > 20 && share(s.clipped) > 0.01 { ": the data are clipped" } else { "" }
    )?;
    write_histogram(page, &s.histogram)
}

/// Columns of eighths of a character.
fn write_histogram(page: &mut String, histogram: &AmplitudeHistogram) -> Result {
    const EIGHTHS: [char; 9] = [' ', '▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];
    let highest = histogram.counts.iter().copied().max().unwrap_or(0).max(1);
    let height = |count: u64| (count * 8 * ROWS as u64).div_ceil(highest) as usize;
    for row in (0..ROWS).rev() {
        let columns = histogram.counts.iter().map(|&count| EIGHTHS[height(count).saturating_sub(8 * row).min(8)]);
        writeln!(page, "  {}", columns.collect::<String>().trim_end())?;
    }
    let columns = histogram.counts.len();
    let (low, high) = (figure(histogram.low), figure(histogram.high));
    let middle = figure((histogram.low + histogram.high) / 2.0);
    let before = (columns / 2).saturating_sub(low.len() + middle.len() / 2);
    let after = columns.saturating_sub(low.len() + before + middle.len() + high.len());
    writeln!(page, "  {low}{:before$}{middle}{:after$}{high}", "", "")
}

/// Five digits, whatever the size.
fn figure(value: f64) -> String {
    match value.abs() {
        0.0 => "0".to_owned(),
        1e-3..1e6 => {
            let decimals = (4 - value.abs().log10().floor() as i32).clamp(0, 6) as usize;
            let text = format!("{value:.decimals$}");
            if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
        }
        _ => format!("{value:.3e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_keep_five_digits() {
        for (value, text) in [
            (0.0, "0"),
            (12.5, "12.5"),
            (-32000.0, "-32000"),
            (0.012_345_678, "0.012346"),
            (1.5e-7, "1.500e-7"),
            (-2e9, "-2.000e9"),
        ] {
            assert_eq!(figure(value), text);
        }
    }

    #[test]
    fn the_histogram_is_as_high_as_its_highest_column() {
        let mut page = String::new();
        write_histogram(&mut page, &AmplitudeHistogram { low: -1.0, high: 1.0, counts: vec![0, 1, 96, 48, 0] })
            .unwrap();
        let rows: Vec<Vec<char>> = page.lines().map(|line| line.chars().skip(2).collect()).collect();
        assert_eq!(rows.len(), ROWS + 1);
        assert!((0..ROWS).all(|row| rows[row][2] == '█'), "{page}");
        assert_eq!((rows[2].get(3), rows[3].get(3)), (None, Some(&'█')), "{page}");
        assert_eq!(rows[ROWS - 1][1], '▁', "{page}");
    }
}
