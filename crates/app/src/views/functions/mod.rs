//! Functions of values: the colours of raw data over the volume's histogram, and textures by value (P-illus 4.2, 4.3).
//!
//! The colour range is dragged on the histogram. The picture follows at once; releasing the pointer makes the change
//! one command.

mod scalars;
mod volume_rendering;

use crate::state::{Action, Session};
use crate::widgets::form;
use crate::widgets::histogram::Histogram;
use crate::widgets::opacity_curve::OpacityCurve;
use crate::widgets::theme;
use crate::work::{Rocks, Swatches};
use eframe::egui::{Button, Color32, ComboBox, DragValue, Pos2, Rect, Role, Sense, Stroke, Ui, WidgetInfo, pos2, vec2};
use project::command::{Command, RemoveScalar, SetRaw, SetScalar};
use project::document::Document;
use project::styles;
use scalars::{intervals, ranges};
use std::collections::HashMap;
use ttf::{ColourMap, RawColour, ScalarInterval, ScalarTtf};

/// Distance within which the pointer catches an end of the range, points.
const REACH: f32 = 10.0;

/// The panel, and the changes being made in it.
#[derive(Default)]
pub(crate) struct Functions {
    histograms: HashMap<String, Histogram>,
    draft: Option<RawColour>,
    sent: bool,
    held: Option<usize>,
    scalar: Option<ScalarTtf>,
    curve: OpacityCurve,
}

impl Functions {
    /// The colours being changed, until they become a command.
    pub(crate) fn draft(&self) -> Option<&RawColour> {
        self.draft.as_ref()
    }

    /// Applies the changes being made to a copy of the project's state.
    pub(crate) fn draft_of(&self, document: &mut Document) {
        if let Some(raw) = &self.draft {
            document.style.raw = Some(raw.clone());
        }
    }

    /// Shows the colours of raw data and the textures by value.
    pub(crate) fn show(
        &mut self,
        ui: &mut Ui,
        session: &Session,
        rocks: Option<&Rocks>,
        swatches: &Swatches,
        actions: &mut Vec<Action>,
    ) {
        let document = &session.document;
        if self.sent && (styles::transfer_functions(document).raw == self.draft) {
            (self.draft, self.sent) = (None, false);
        }
        if let Some(raw) = self.draft.clone().or_else(|| styles::transfer_functions(document).raw) {
            self.raw(ui, document, &raw, rocks, actions);
        }
        if !document.horizons.is_empty() {
            ui.add_space(10.0);
            ui.heading("Textures by value");
            self.scalars(ui, document, rocks, swatches, actions);
        }
        ui.add_space(10.0);
        let volume = volume_rendering::volume(session);
        if let Some(volume) = &volume {
            self.count(volume, rocks);
        }
        let histogram = volume.as_ref().and_then(|volume| self.histograms.get(volume));
        volume_rendering::show(ui, session, histogram, &mut self.curve, actions);
    }

    /// The colours of raw data.
    fn raw(
        &mut self,
        ui: &mut Ui,
        document: &Document,
        raw: &RawColour,
        rocks: Option<&Rocks>,
        actions: &mut Vec<Action>,
    ) {
        ui.heading("Colours of raw data");
        let mut next = raw.clone();
        map(ui, document, &mut next);
        self.count(&raw.volume, rocks);
        self.range(ui, &mut next);
        if next != *raw {
            (self.draft, self.sent) = (Some(next), false);
        }
        let is_held = ui.input(|input| input.pointer.any_down()) || ui.ctx().egui_wants_keyboard_input();
        if let Some(raw) = self.draft.clone().filter(|_| !is_held && !self.sent) {
            self.sent = true;
            actions.push(Action::Apply(Box::new(Command::SetRaw(SetRaw { raw }))));
        }
    }

    /// Counts the values of a volume, once for each state of the data.
    fn count(&mut self, volume: &str, rocks: Option<&Rocks>) {
        let Some(loaded) = rocks else { return };
        if self.histograms.get(volume).is_some_and(|known| known.data_key == loaded.data_key) {
            return;
        }
        let Some(found) = loaded.volumes.iter().find(|loaded| loaded.name == volume) else { return };
        let Some(whole) = found.whole() else { return };
        let histogram = Histogram::of(whole.samples(), loaded.data_key);
        self.histograms.insert(volume.to_owned(), histogram);
    }

    /// The histogram over the colours; the ends of the range can be dragged and are shown as numbers.
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
            for end in 0..2 {
                let label = if end == 0 { form::label(ui, "Values from") } else { ui.label("to") };
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
        rocks: Option<&Rocks>,
        swatches: &Swatches,
        actions: &mut Vec<Action>,
    ) {
        for present in &document.style.scalars {
            let mut function = match &self.scalar {
                Some(draft) if draft.volume == present.volume => draft.clone(),
                _ => present.clone(),
            };
            ui.horizontal(|ui| {
                let hint = format!("No textures of {}", present.volume);
                let row = crate::views::data::named(ui, &present.volume, None, &hint);
                if row.is_removed {
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
            let textures = || Button::new(format!("Textures by {}", entry.name)).truncate();
            if is_new && ui.add(textures()).on_hover_text(&entry.name).clicked() {
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

/// The choice of a colour map, by name.
fn map(ui: &mut Ui, document: &Document, raw: &mut RawColour) {
    ui.horizontal(|ui| {
        let label = form::label(ui, "Colours");
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
            && let Ok(next) = styles::raw_colour(document, Some(&raw.volume), map, Some(raw.function.domain))
        {
            *raw = next;
        }
    });
}

/// The end of the range that a drag from this point moves: the nearer one, even where both are out of reach.
fn nearest(at: Pos2, ends: [f32; 2], rect: Rect) -> Option<usize> {
    let off = ends.map(|x| (x.clamp(rect.left(), rect.right()) - at.x).abs());
    let end = usize::from(off[1] < off[0]);
    (off[end] < REACH.max(rect.width() * 0.2)).then_some(end)
}

/// Moves an end of a range. A range that was centred on zero stays centred, because otherwise positive and negative
/// amplitudes are coloured unequally.
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
