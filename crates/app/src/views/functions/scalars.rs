//! Textures by value: which ranges of a volume's values have a texture, and which one.

use crate::widgets::histogram::Histogram;
use crate::widgets::percent;
use crate::widgets::theme;
use crate::work::Swatches;
use eframe::egui::{ComboBox, DragValue, Role, Sense, Ui, WidgetInfo, vec2};
use ttf::{ScalarInterval, ScalarTtf};

/// The histogram of a volume, with the ranges that have a texture marked.
pub(super) fn ranges(ui: &mut Ui, histogram: &Histogram, function: &ScalarTtf) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), 44.0), Sense::hover());
    let name = format!("Histogram of {}", function.volume);
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, &name));
    let (marked, rest) = (theme::accent(ui.visuals()), ui.visuals().weak_text_color().to_opaque());
    histogram.paint(&ui.painter_at(rect), rect, |value| {
        let is_in = function.intervals.iter().any(|interval| (interval.range[0]..interval.range[1]).contains(&value));
        if is_in { marked } else { rest }
    });
}

/// The ranges of values with their textures; a range can be split, and removed while there is another.
pub(super) fn intervals(ui: &mut Ui, function: &mut ScalarTtf, swatches: &Swatches) {
    let (mut split, mut gone) = (None, None);
    let count = function.intervals.len();
    for (index, interval) in function.intervals.iter_mut().enumerate() {
        interval_row(ui, &function.volume, index, interval, swatches);
        ui.horizontal_wrapped(|ui| {
            let ordinal = index + 1;
            ui.weak("repeats");
            for (axis, name) in ["Repeats along", "Repeats through"].into_iter().enumerate() {
                if axis == 1 {
                    ui.label("×");
                }
                let drag = DragValue::new(&mut interval.factor[axis]).speed(0.02).range(0.05..=50.0).max_decimals(2);
                ui.name_inputs(format!("{name} of {} {ordinal}", function.volume), |ui| ui.add(drag))
                    .on_hover_text(format!("{name}, times the layer's own"));
            }
            ui.weak("times the layer's, opacity");
            let drag = percent::drag(&mut interval.opacity);
            ui.name_inputs(format!("Opacity of {} {ordinal}", function.volume), |ui| ui.add(drag))
                .on_hover_text("Opacity over the layer's pattern");
            if ui.button("Split").on_hover_text("Split this range in two").clicked() {
                split = Some(index);
            }
            if count > 1 && ui.button("−").on_hover_text("Remove this range").clicked() {
                gone = Some(index);
            }
        });
    }
    if let Some(index) = split {
        let (lower, upper) = halves(function.intervals[index].clone());
        function.intervals.splice(index..=index, [lower, upper]);
    }
    if let Some(index) = gone {
        function.intervals.remove(index);
    }
}

/// Splits a range in two: at its middle, or, where one end is open, as far from the other end as that end is from zero.
fn halves(interval: ScalarInterval) -> (ScalarInterval, ScalarInterval) {
    let [low, high] = interval.range;
    let at = match (low.is_finite(), high.is_finite()) {
        (true, true) => 0.5 * (low + high),
        (true, false) => low + low.abs().max(1.0),
        (false, true) => high - high.abs().max(1.0),
        (false, false) => 0.0,
    };
    (ScalarInterval { range: [low, at], ..interval.clone() }, ScalarInterval { range: [at, high], ..interval })
}

/// A range of values and its texture.
fn interval_row(ui: &mut Ui, volume: &str, index: usize, interval: &mut ScalarInterval, swatches: &Swatches) {
    ui.horizontal_wrapped(|ui| {
        for (end, word) in ["from", "to"].into_iter().enumerate() {
            let value = &mut interval.range[end];
            if value.is_finite() {
                let speed = value.abs() * 0.01 + 1e-3;
                let drag = DragValue::new(value).speed(speed);
                ui.name_inputs(format!("{volume} {word} {}", index + 1), |ui| ui.add(drag));
            } else {
                ui.weak(if end == 0 { "lowest" } else { "highest" });
            }
        }
        let combo = ComboBox::from_id_salt((volume, index)).selected_text(&interval.texture).width(120.0);
        ui.name_inputs(format!("Texture of {volume} {}", index + 1), |ui| {
            combo.show_ui(ui, |ui| {
                for pattern in swatches.patterns().iter() {
                    ui.selectable_value(&mut interval.texture, pattern.name.clone(), &pattern.title);
                }
            });
        });
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_of_a_range_meet_and_cover_it() {
        let inf = f32::INFINITY;
        for range in [[2.0, 6.0], [3.0, inf], [-inf, -4.0], [-inf, inf], [0.0, inf]] {
            let whole =
                ScalarInterval { range, texture: "a".into(), factor: [1.0; 2], opacity: 1.0, colour: None, ink: None };
            let (lower, upper) = halves(whole);
            assert_eq!([lower.range[0], upper.range[1]], range);
            assert!(lower.range[1] == upper.range[0] && lower.range[0] < lower.range[1] && upper.range[0] < range[1]);
        }
    }
}
