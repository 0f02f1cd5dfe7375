//! Histograms of the values of a volume.

use eframe::egui::{Color32, Painter, Rect, pos2};

/// Columns of the histogram.
const COLUMNS: usize = 96;
/// Number of samples that are counted: enough for the shape of the histogram.
const SAMPLES: usize = 1 << 16;

/// The histogram of a volume.
pub(crate) struct Histogram {
    /// Hash of the data that were counted.
    pub data_key: u64,
    counts: Vec<f32>,
    /// Lowest and highest value.
    pub range: [f32; 2],
}

impl Histogram {
    /// Counts samples.
    pub(crate) fn of(samples: &[f32], data_key: u64) -> Self {
        let step = (samples.len() / SAMPLES).max(1);
        let values = || samples.iter().step_by(step).copied().filter(|value| value.is_finite());
        let range = [values().fold(f32::INFINITY, f32::min), values().fold(f32::NEG_INFINITY, f32::max)];
        let width = (range[1] - range[0]).max(f32::MIN_POSITIVE);
        let mut counts = vec![0.0f32; COLUMNS];
        for value in values() {
            counts[(((value - range[0]) / width * COLUMNS as f32) as usize).min(COLUMNS - 1)] += 1.0;
        }
        // Amplitudes cluster around zero; the square root makes the tails visible.
        counts.iter_mut().for_each(|count| *count = count.sqrt());
        Self { data_key, counts, range }
    }

    /// Draws the columns, each in the colour of its value.
    pub(crate) fn paint(&self, painter: &Painter, rect: Rect, colour: impl Fn(f32) -> Color32) {
        let [first, last] = self.range;
        let tallest = self.counts.iter().copied().fold(1e-6, f32::max);
        let column = rect.width() / COLUMNS as f32;
        for (index, count) in self.counts.iter().enumerate() {
            let value = first + (index as f32 + 0.5) / COLUMNS as f32 * (last - first);
            let corner = pos2(rect.left() + index as f32 * column, rect.bottom() - count / tallest * rect.height());
            let bar = Rect::from_min_max(corner, pos2(corner.x + column + 0.4, rect.bottom()));
            painter.rect_filled(bar, 0.0, colour(value));
        }
    }
}
