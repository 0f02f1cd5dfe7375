//! Functions of values: the colours of raw data over the volume's histogram, and textures by value (P-illus 4.2, 4.3).
//!
//! The range of the colours is pulled on the histogram; the picture follows at once, and letting go makes it one command.

use crate::app::state::{Action, Session};
use crate::app::theme;
use crate::app::work::{Rocks, Swatches};
use crate::command::{Command, RemoveScalar, SetRaw, SetScalar};
use crate::project::Document;
use crate::style;
use eframe::egui::{
    Color32, ComboBox, DragValue, Painter, Pos2, Rect, Role, Sense, Stroke, Ui, WidgetInfo, pos2, vec2,
};
use std::collections::HashMap;
use ttf::{ColourMap, RawColour, ScalarInterval, ScalarTtf};

/// Columns of the histogram.
const COLUMNS: usize = 96;
/// Samples looked at for it: enough for its shape.
const SAMPLES: usize = 1 << 16;
/// How near the pointer must be to an end of the range, points.
const REACH: f32 = 10.0;

/// How often values occur.
struct Histogram {
    version: u64,
    counts: Vec<f32>,
    range: [f32; 2],
}

/// The panel, and what is being changed in it.
#[derive(Default)]
pub struct Functions {
    histograms: HashMap<String, Histogram>,
    draft: Option<RawColour>,
    sent: bool,
    held: Option<usize>,
    scalar: Option<ScalarTtf>,
}

impl Functions {
    /// The colours under the hand.
    pub fn draft(&self) -> Option<&RawColour> {
        self.draft.as_ref()
    }

    /// The project's state with what is being changed under the hand.
    pub fn draft_of(&self, document: &mut Document) {
        if let Some(raw) = &self.draft {
            document.style.raw = Some(raw.clone());
        }
    }

    /// Shows the colours of raw data and the textures by value.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        session: &Session,
        rocks: Option<(&Rocks, u64)>,
        swatches: &Swatches,
        actions: &mut Vec<Action>,
    ) {
        let document = &session.document;
        if self.sent && (style::of_project(document).raw == self.draft) {
            (self.draft, self.sent) = (None, false);
        }
        let Some(raw) = self.draft.clone().or_else(|| style::of_project(document).raw) else { return };
        ui.heading("Colours of raw data");
        let mut next = raw.clone();
        map(ui, document, &mut next);
        self.count(&raw.volume, rocks);
        self.range(ui, &mut next);
        if next != raw {
            (self.draft, self.sent) = (Some(next), false);
        }
        let is_held = ui.input(|input| input.pointer.any_down()) || ui.ctx().egui_wants_keyboard_input();
        if let Some(raw) = self.draft.clone().filter(|_| !is_held && !self.sent) {
            self.sent = true;
            actions.push(Action::Apply(Box::new(Command::SetRaw(SetRaw { raw }))));
        }
        if !document.horizons.is_empty() {
            ui.add_space(10.0);
            ui.heading("Textures by value");
            self.scalars(ui, document, rocks, swatches, actions);
        }
    }

    /// Counts the values of a volume, once for each state of the data.
    fn count(&mut self, volume: &str, rocks: Option<(&Rocks, u64)>) {
        let Some((rocks, version)) = rocks else { return };
        if self.histograms.get(volume).is_some_and(|known| known.version == version) {
            return;
        }
        let Ok(loaded) = rocks.try_read() else { return };
        let Some(found) = loaded.volumes.iter().find(|loaded| loaded.name == volume) else { return };
        let samples = found.volume.samples();
        let step = (samples.len() / SAMPLES).max(1);
        let values = || samples.iter().step_by(step).copied().filter(|value| value.is_finite());
        let range = [values().fold(f32::INFINITY, f32::min), values().fold(f32::NEG_INFINITY, f32::max)];
        let width = (range[1] - range[0]).max(f32::MIN_POSITIVE);
        let mut counts = vec![0.0f32; COLUMNS];
        for value in values() {
            counts[(((value - range[0]) / width * COLUMNS as f32) as usize).min(COLUMNS - 1)] += 1.0;
        }
        // Amplitudes crowd around zero; the root lets the tails be seen.
        counts.iter_mut().for_each(|count| *count = count.sqrt());
        self.histograms.insert(volume.to_owned(), Histogram { version, counts, range });
    }

    /// The histogram over the colours, with the ends of the range to be pulled, and both as numbers.
    fn range(&mut self, ui: &mut Ui, raw: &mut RawColour) {
        let [low, high] = raw.function.domain;
        if let Some(histogram) = self.histograms.get(&raw.volume) {
            let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), 84.0), Sense::click_and_drag());
            response.widget_info(|| WidgetInfo::labeled(Role::Image, true, "Histogram"));
            let [first, last] = histogram.range;
            let span = (last - first).max(f32::MIN_POSITIVE);
            let x_of = |value: f32| rect.left() + (value - first) / span * rect.width();
            let painter = ui.painter_at(rect);
            histogram.paint(&painter, rect, |value| {
                let [r, g, b, _] = raw.function.evaluate(value).map(|channel| (channel * 255.0 + 0.5) as u8);
                Color32::from_rgb(r, g, b)
            });
            let accent = theme::accent(ui.visuals());
            let ends = [low, high].map(x_of);
            for x in ends {
                let x = x.clamp(rect.left() + 1.0, rect.right() - 1.0);
                painter.vline(x, rect.y_range(), Stroke::new(2.0, accent));
                painter.circle_filled(pos2(x, rect.top() + 6.0), 5.0, accent);
            }
            if response.drag_started()
                && let Some(at) = ui.input(|input| input.pointer.press_origin())
            {
                self.held = nearest(at, ends, rect);
            }
            if let (Some(end), Some(at)) = (self.held, response.interact_pointer_pos()) {
                let value = first + ((at.x - rect.left()) / rect.width()).clamp(0.0, 1.0) * span;
                pull(&mut raw.function.domain, end, value);
            }
            if response.drag_stopped() {
                self.held = None;
            }
        }
        ui.horizontal(|ui| {
            let speed = f64::from((high - low).abs()) * 0.005;
            for (end, name) in ["from", "to"].into_iter().enumerate() {
                let label = ui.label(name);
                let mut value = raw.function.domain[end];
                if ui.add(DragValue::new(&mut value).speed(speed)).labelled_by(label.id).changed() {
                    pull(&mut raw.function.domain, end, value);
                }
            }
        });
    }

    fn scalars(
        &mut self,
        ui: &mut Ui,
        document: &Document,
        rocks: Option<(&Rocks, u64)>,
        swatches: &Swatches,
        actions: &mut Vec<Action>,
    ) {
        for present in &document.style.scalars {
            let mut function = match &self.scalar {
                Some(draft) if draft.volume == present.volume => draft.clone(),
                _ => present.clone(),
            };
            ui.horizontal(|ui| {
                ui.strong(&present.volume);
                if ui.small_button("Remove").on_hover_text(format!("No textures of {}", present.volume)).clicked() {
                    let command = RemoveScalar { volume: present.volume.clone() };
                    actions.push(Action::Apply(Box::new(Command::RemoveScalar(command))));
                }
            });
            self.count(&present.volume, rocks);
            if let Some(histogram) = self.histograms.get(&present.volume) {
                ranges(ui, histogram, &function);
            }
            intervals(ui, &mut function, swatches);
            if function != *present {
                self.scalar = Some(function);
            }
        }
        let is_held = ui.input(|input| input.pointer.any_down()) || ui.ctx().egui_wants_keyboard_input();
        if let Some(function) = self.scalar.take_if(|_| !is_held) {
            actions.push(Action::Apply(Box::new(Command::SetScalar(SetScalar { function }))));
        }
        for entry in &document.volumes {
            let is_new = document.style.scalars.iter().all(|function| function.volume != entry.name);
            if is_new && ui.button(format!("Textures by {}", entry.name)).clicked() {
                let middle = 0.5 * (entry.lowest.max(-entry.clip) + entry.clip);
                let texture = swatches.patterns().first().map(|pattern| pattern.name.clone()).unwrap_or_default();
                let range = [middle, f32::INFINITY];
                let interval =
                    ScalarInterval { range, texture, factor: [1.0; 2], opacity: 1.0, colour: None, ink: None };
                let function = ScalarTtf { volume: entry.name.clone(), intervals: vec![interval] };
                actions.push(Action::Apply(Box::new(Command::SetScalar(SetScalar { function }))));
            }
        }
    }
}

impl Histogram {
    /// Draws its columns, each in the colour of its value.
    fn paint(&self, painter: &Painter, rect: Rect, colour: impl Fn(f32) -> Color32) {
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

/// The histogram of a volume with the values that have a texture marked.
fn ranges(ui: &mut Ui, histogram: &Histogram, function: &ScalarTtf) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), 44.0), Sense::hover());
    let name = format!("Histogram of {}", function.volume);
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, &name));
    let (marked, rest) = (theme::accent(ui.visuals()), ui.visuals().weak_text_color().to_opaque());
    histogram.paint(&ui.painter_at(rect), rect, |value| {
        let is_in = function.intervals.iter().any(|interval| (interval.range[0]..interval.range[1]).contains(&value));
        if is_in { marked } else { rest }
    });
}

/// Ranges of values with their textures; a range can be divided, and taken away as long as there is another.
fn intervals(ui: &mut Ui, function: &mut ScalarTtf, swatches: &Swatches) {
    let (mut split, mut gone) = (None, None);
    let count = function.intervals.len();
    for (index, interval) in function.intervals.iter_mut().enumerate() {
        interval_row(ui, &function.volume, index, interval, swatches);
        ui.horizontal(|ui| {
            let ordinal = index + 1;
            for (axis, name) in ["Repeats along", "Repeats through"].into_iter().enumerate() {
                if axis == 1 {
                    ui.label("×");
                }
                let drag = DragValue::new(&mut interval.factor[axis]).speed(0.02).range(0.05..=50.0).max_decimals(2);
                ui.name_inputs(format!("{name} of {} {ordinal}", function.volume), |ui| ui.add(drag))
                    .on_hover_text(format!("{name}, times the layer's own"));
            }
            let drag = DragValue::new(&mut interval.opacity).speed(0.01).range(0.0..=1.0).max_decimals(2);
            ui.name_inputs(format!("Opacity of {} {ordinal}", function.volume), |ui| ui.add(drag))
                .on_hover_text("Opacity over the layer's pattern");
            if ui.small_button("Split").on_hover_text("Divide this range in two").clicked() {
                split = Some(index);
            }
            if count > 1 && ui.small_button("−").on_hover_text("No texture for this range").clicked() {
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

/// A range of values in two: at its middle, or where it has no end as far from the end it has as that is from zero.
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

/// The colour map, by name.
fn map(ui: &mut Ui, document: &Document, raw: &mut RawColour) {
    ui.horizontal(|ui| {
        let label = ui.label("Colours");
        let present = ColourMap::ALL.into_iter().find(|map| {
            let stops = map.stops();
            let same =
                |((at, colour), stop): (&(f32, ttf::Colour), &ttf::RgbaStop)| *at == stop.at && *colour == stop.colour;
            stops.len() == raw.function.stops.len() && stops.iter().zip(&raw.function.stops).all(same)
        });
        let mut chosen = present;
        ui.label_inputs_by(label.id, |ui| {
            ComboBox::from_id_salt("raw colours").selected_text(present.map_or("own", ColourMap::name)).show_ui(
                ui,
                |ui| {
                    for map in ColourMap::ALL {
                        ui.selectable_value(&mut chosen, Some(map), map.name());
                    }
                },
            );
        });
        if let Some(map) = chosen.filter(|_| chosen != present)
            && let Ok(next) = style::raw_colour(document, Some(&raw.volume), map, Some(raw.function.domain))
        {
            *raw = next;
        }
    });
}

/// The end of the range that a point takes hold of; the nearer one, even where both are out of reach.
fn nearest(at: Pos2, ends: [f32; 2], rect: Rect) -> Option<usize> {
    let off = ends.map(|x| (x.clamp(rect.left(), rect.right()) - at.x).abs());
    let end = usize::from(off[1] < off[0]);
    (off[end] < REACH.max(rect.width() * 0.2)).then_some(end)
}

/// Moves an end of a range; where the range was centred on zero it stays so, for only then are amplitudes coloured fairly.
fn pull(domain: &mut [f32; 2], end: usize, value: f32) {
    let [low, high] = *domain;
    if low == -high {
        let reach = value.abs().max(f32::MIN_POSITIVE * 1e6);
        *domain = [-reach, reach];
        return;
    }
    let other = domain[1 - end];
    let is_proper = if end == 0 { value < other } else { value > other };
    if is_proper && value.is_finite() {
        domain[end] = value;
    }
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

    #[test]
    fn a_centred_range_stays_centred_and_others_keep_their_order() {
        let mut domain = [-2.0, 2.0];
        pull(&mut domain, 1, 3.0);
        assert_eq!(domain, [-3.0, 3.0]);
        let mut domain = [1.0, 2.0];
        pull(&mut domain, 0, 5.0);
        assert_eq!(domain, [1.0, 2.0]);
        pull(&mut domain, 0, 0.5);
        assert_eq!(domain, [0.5, 2.0]);
    }
}
