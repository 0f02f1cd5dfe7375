//! Which way a section runs: its axes, their numbers, and the numbers along its edges.

use crate::state::SliceKind;
use eframe::egui::{Align2, FontId, Rect, Stroke, Ui, pos2};
use glam::{DVec2, DVec3};
use survey::SurveyGeometry;

/// Least distance between numbers along an axis, points.
const TICK_EVERY: f32 = 74.0;

/// What a section is called.
pub fn name(kind: SliceKind) -> &'static str {
    match kind {
        SliceKind::Inline => "Inline",
        SliceKind::Crossline => "Crossline",
        SliceKind::Slice => "Slice",
    }
}

/// The voxel axes that run to the right and down.
pub(super) fn axes(kind: SliceKind) -> [usize; 2] {
    match kind {
        SliceKind::Inline => [1, 2],
        SliceKind::Crossline => [0, 2],
        SliceKind::Slice => [0, 1],
    }
}

/// Largest s and t; never 0, so that shares exist.
pub(super) fn extent(kind: SliceKind, size: [usize; 3]) -> DVec2 {
    let [s, t] = axes(kind).map(|axis| size[axis].saturating_sub(1).max(1) as f64);
    DVec2::new(s, t)
}

/// Voxel position of (s, t).
pub(super) fn voxel(kind: SliceKind, at: f64, st: DVec2) -> DVec3 {
    match kind {
        SliceKind::Inline => DVec3::new(at, st.x, st.y),
        SliceKind::Crossline => DVec3::new(st.x, at, st.y),
        SliceKind::Slice => DVec3::new(st.x, st.y, at),
    }
}

/// The value that people know a place on a voxel axis by.
pub(super) fn value_at(geometry: &SurveyGeometry, axis: usize, index: f64) -> f64 {
    match axis {
        0 => geometry.inlines.number_at(index),
        1 => geometry.crosslines.number_at(index),
        _ => geometry.vertical.value_at(index),
    }
}

/// The least of 1, 2, 5 × 10ⁿ that is not less.
pub(in crate::views) fn round_step(least: f64) -> f64 {
    let decade = 10f64.powf(least.max(1e-9).log10().floor());
    [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .map(|factor| factor * decade)
        .find(|step| *step >= least * 0.999)
        .unwrap_or(decade)
}

/// Numbers along the upper and the left edge.
pub(super) fn ticks(ui: &Ui, whole: Rect, body: Rect, image: Rect, kind: SliceKind, geometry: &SurveyGeometry) {
    let font = FontId::proportional(11.5);
    let colour = ui.visuals().weak_text_color();
    let painter = ui.painter_at(whole);
    let extent = extent(kind, geometry.size());
    for (direction, axis) in axes(kind).into_iter().enumerate() {
        let is_across = direction == 0;
        let length = if is_across { image.width() } else { image.height() };
        let last = if is_across { extent.x } else { extent.y };
        let ends = [value_at(geometry, axis, 0.0), value_at(geometry, axis, last)];
        let per_point = (ends[1] - ends[0]) / f64::from(length);
        if per_point == 0.0 {
            continue;
        }
        let step = round_step(per_point.abs() * f64::from(TICK_EVERY)).max(if axis < 2 { 1.0 } else { 0.0 });
        let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
        let mut value = (low / step).ceil() * step;
        while value <= high {
            let along = ((value - ends[0]) / per_point) as f32;
            let text = if step < 1.0 { format!("{value:.1}") } else { format!("{value:.0}") };
            if is_across {
                let x = image.left() + along;
                if body.x_range().contains(x) {
                    painter.vline(x, body.top() - 4.0..=body.top(), Stroke::new(1.0, colour));
                    painter.text(pos2(x, body.top() - 5.0), Align2::CENTER_BOTTOM, text, font.clone(), colour);
                }
            } else {
                let y = image.top() + along;
                if body.y_range().contains(y) {
                    painter.hline(body.left() - 4.0..=body.left(), y, Stroke::new(1.0, colour));
                    painter.text(pos2(body.left() - 6.0, y), Align2::RIGHT_CENTER, text, font.clone(), colour);
                }
            }
            value += step;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_between_numbers_are_round() {
        for (least, said) in [(0.3, 0.5), (1.0, 1.0), (1.1, 2.0), (4.9, 5.0), (70.0, 100.0)] {
            assert!((round_step(least) - said).abs() < 1e-9, "{least}");
        }
    }

    #[test]
    fn every_section_runs_through_its_point() {
        for kind in SliceKind::ALL {
            let at = DVec3::new(3.0, 5.0, 7.0).to_array();
            let [s, t] = axes(kind).map(|axis| at[axis]);
            assert_eq!(voxel(kind, at[kind.axis()], DVec2::new(s, t)).to_array(), at);
        }
    }
}
