//! An RGBA function drawn over the histogram of its volume: stops are dragged to change value and opacity, a double
//! click adds one, and the stop chosen last is shown as numbers below.

use crate::widgets::histogram::Histogram;
use crate::widgets::percent;
use crate::widgets::{colour_well, theme};
use eframe::egui::{
    Button, Color32, DragValue, Pos2, Rect, Role, Sense, Stroke, StrokeKind, Ui, WidgetInfo, pos2, vec2,
};
use ttf::{Colour, RgbaFunction, RgbaStop};

/// Height of the drawing, points.
const HEIGHT: f32 = 110.0;
/// Margin above opacity 1 and below opacity 0, points.
const MARGIN: f32 = 8.0;
/// Distance within which the pointer catches a stop, points.
const REACH: f32 = 11.0;
/// Smallest distance between two stops, as a share of the domain.
const APART: f32 = 1e-3;
/// Smallest number of stops of a function.
const FEWEST: usize = 2;

/// A stop, identified by its value.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Stop {
    value: f32,
    colour: Colour,
    opacity: f32,
}

/// The stop being dragged, and the stop chosen last.
#[derive(Debug, Default)]
pub(crate) struct OpacityCurve {
    held: Option<usize>,
    chosen: usize,
}

impl OpacityCurve {
    /// Shows a function and applies the user's changes to it.
    pub(crate) fn show(&mut self, ui: &mut Ui, histogram: Option<&Histogram>, function: &mut RgbaFunction) {
        let mut stops = stops_of(function);
        self.chosen = self.chosen.min(stops.len().saturating_sub(1));
        let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), HEIGHT), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, "Opacity over the histogram"));
        let range = histogram.map_or(function.domain, |histogram| histogram.range);
        let plot = Plot { rect, range };
        plot.paint(ui, histogram, function, &stops, self.chosen);
        let pointer = response.interact_pointer_pos();
        if let Some(at) = ui.input(|input| input.pointer.press_origin()).filter(|at| rect.contains(*at))
            && response.is_pointer_button_down_on()
            && self.held.is_none()
        {
            self.held = plot.nearest(&stops, at);
            self.chosen = self.held.unwrap_or(self.chosen);
        }
        if let (Some(held), Some(at), true) = (self.held, pointer, response.dragged()) {
            let (value, opacity) = plot.at(at);
            stops[held].opacity = opacity;
            place(&mut stops, held, value);
        }
        if !response.is_pointer_button_down_on() {
            self.held = None;
        }
        if let Some(at) = pointer.filter(|_| response.double_clicked())
            && plot.nearest(&stops, at).is_none()
        {
            let (value, opacity) = plot.at(at);
            self.chosen = add(&mut stops, function, value, opacity);
        }
        self.numbers(ui, &mut stops);
        let changed = function_of(&stops);
        if stops != stops_of(function) {
            *function = changed;
        }
    }

    /// The chosen stop as numbers.
    fn numbers(&mut self, ui: &mut Ui, stops: &mut Vec<Stop>) {
        let Some(&stop) = stops.get(self.chosen) else { return };
        let span = stops[stops.len() - 1].value - stops[0].value;
        let (mut value, mut opacity, mut rgb) = (stop.value, stop.opacity, stop.colour.rgb);
        ui.horizontal_wrapped(|ui| {
            colour_well(ui, "Colour of the stop", &mut rgb);
            let drag = DragValue::new(&mut value).speed(f64::from(span) * 0.005);
            ui.name_inputs("Value of the stop", |ui| ui.add(drag));
            let label = ui.weak("opacity");
            let drag = percent::drag(&mut opacity);
            ui.add(drag).labelled_by(label.id);
            let can = stops.len() > FEWEST;
            let remove = ui.add_enabled(can, Button::new("Remove stop"));
            if remove.on_disabled_hover_text("A function has at least two stops").clicked() {
                stops.remove(self.chosen);
                self.chosen = self.chosen.saturating_sub(1);
            } else {
                stops[self.chosen] = Stop { colour: Colour { rgb }, opacity, ..stop };
                if value != stop.value {
                    place(stops, self.chosen, value);
                }
            }
        });
        ui.weak("Drag a stop to move it; double-click to add one.");
    }
}

/// The mapping from values and opacities to the screen.
struct Plot {
    rect: Rect,
    range: [f32; 2],
}

impl Plot {
    fn span(&self) -> f32 {
        (self.range[1] - self.range[0]).max(f32::MIN_POSITIVE)
    }

    fn place(&self, value: f32, opacity: f32) -> Pos2 {
        let x = self.rect.left() + ((value - self.range[0]) / self.span()).clamp(0.0, 1.0) * self.rect.width();
        pos2(x, self.rect.bottom() - MARGIN - opacity * (self.rect.height() - 2.0 * MARGIN))
    }

    /// The value and opacity at a point of the screen.
    fn at(&self, at: Pos2) -> (f32, f32) {
        let share = ((at.x - self.rect.left()) / self.rect.width()).clamp(0.0, 1.0);
        let opacity = (self.rect.bottom() - MARGIN - at.y) / (self.rect.height() - 2.0 * MARGIN);
        (self.range[0] + share * self.span(), opacity.clamp(0.0, 1.0))
    }

    fn nearest(&self, stops: &[Stop], at: Pos2) -> Option<usize> {
        let distance = |stop: &Stop| (self.place(stop.value, stop.opacity) - at).length();
        let near = stops.iter().enumerate().filter(|(_, stop)| distance(stop) < REACH);
        near.min_by(|a, b| distance(a.1).total_cmp(&distance(b.1))).map(|(index, _)| index)
    }

    fn paint(&self, ui: &Ui, histogram: Option<&Histogram>, function: &RgbaFunction, stops: &[Stop], chosen: usize) {
        let painter = ui.painter_at(self.rect);
        let visuals = ui.visuals();
        // A colour that stands out from white as well as from black.
        painter.rect_filled(self.rect, 4.0, Color32::from_gray(if visuals.dark_mode { 0x4a } else { 0xbc }));
        if let Some(histogram) = histogram {
            histogram.paint(&painter, self.rect, |value| {
                let [r, g, b, _] = function.evaluate(value).map(|channel| (channel * 255.0 + 0.5) as u8);
                Color32::from_rgb(r, g, b)
            });
        }
        painter.rect_stroke(self.rect, 4.0, visuals.widgets.noninteractive.bg_stroke, StrokeKind::Inside);
        let places: Vec<Pos2> = stops.iter().map(|stop| self.place(stop.value, stop.opacity)).collect();
        let (Some(first), Some(last)) = (places.first(), places.last()) else { return };
        let ends = [pos2(self.rect.left(), first.y), pos2(self.rect.right(), last.y)];
        let line: Vec<Pos2> = [ends[0]].into_iter().chain(places.iter().copied()).chain([ends[1]]).collect();
        painter.line(line.clone(), Stroke::new(3.5, visuals.extreme_bg_color));
        painter.line(line, Stroke::new(1.5, visuals.strong_text_color()));
        for (index, (at, stop)) in places.iter().zip(stops).enumerate() {
            let [r, g, b] = stop.colour.rgb;
            let radius = if index == chosen { 7.0 } else { 5.0 };
            let rim = if index == chosen { theme::accent(visuals) } else { visuals.strong_text_color() };
            painter.circle(*at, radius, Color32::from_rgb(r, g, b), Stroke::new(2.0, rim));
        }
    }
}

fn stops_of(function: &RgbaFunction) -> Vec<Stop> {
    let [low, high] = function.domain;
    let stop =
        |stop: &RgbaStop| Stop { value: low + stop.at * (high - low), colour: stop.colour, opacity: stop.opacity };
    function.stops.iter().map(stop).collect()
}

/// The first and the last value become the domain.
fn function_of(stops: &[Stop]) -> RgbaFunction {
    let ends = [stops.first(), stops.last()].map(|stop| stop.map_or(0.0, |stop| stop.value));
    let span = (ends[1] - ends[0]).max(f32::MIN_POSITIVE);
    let at = |stop: &Stop| RgbaStop { at: (stop.value - ends[0]) / span, colour: stop.colour, opacity: stop.opacity };
    RgbaFunction { domain: ends, stops: stops.iter().map(at).collect() }
}

/// Moves a stop to a value between those of its neighbours.
fn place(stops: &mut [Stop], index: usize, value: f32) {
    let apart = APART * (stops[stops.len() - 1].value - stops[0].value).abs().max(f32::MIN_POSITIVE);
    let low = if index > 0 { stops[index - 1].value + apart } else { f32::NEG_INFINITY };
    let high = stops.get(index + 1).map_or(f32::INFINITY, |next| next.value - apart);
    stops[index].value = value.min(high).max(low);
}

/// Adds a stop with the colour that the function has there; returns its index.
fn add(stops: &mut Vec<Stop>, function: &RgbaFunction, value: f32, opacity: f32) -> usize {
    let index = stops.partition_point(|stop| stop.value <= value);
    let [r, g, b, _] = function.evaluate(value).map(|channel| (channel * 255.0 + 0.5) as u8);
    stops.insert(index, Stop { value, colour: Colour::new(r, g, b), opacity });
    place(stops, index, value);
    index
}

#[cfg(test)]
mod tests {
    use super::*;
    use ttf::ColourMap;

    fn function() -> RgbaFunction {
        RgbaFunction::centred(ColourMap::CoolWarm, 100.0)
    }

    #[test]
    fn a_function_survives_being_taken_apart() {
        let back = function_of(&stops_of(&function()));
        assert_eq!(back.domain, function().domain);
        for value in [-100.0, -42.0, 0.0, 77.0, 100.0] {
            for (one, other) in back.evaluate(value).into_iter().zip(function().evaluate(value)) {
                assert!((one - other).abs() < 1e-5, "{value}");
            }
        }
    }

    #[test]
    fn an_end_takes_the_domain_along_and_leaves_the_other_stops_where_they_are() {
        let mut stops = stops_of(&function());
        place(&mut stops, 0, -400.0);
        let wider = function_of(&stops);
        assert_eq!(wider.domain, [-400.0, 100.0]);
        assert!((wider.evaluate(50.0)[0] - function().evaluate(50.0)[0]).abs() < 1e-4);
    }

    #[test]
    fn stops_do_not_pass_one_another() {
        let mut stops = stops_of(&function());
        place(&mut stops, 1, 1e9);
        assert!(stops[1].value < stops[2].value && stops[1].value > stops[0].value);
        let added = add(&mut stops, &function(), 3.0, 0.5);
        assert!(stops.is_sorted_by(|a, b| a.value < b.value));
        assert_eq!(stops[added].opacity, 0.5);
    }

    #[test]
    fn a_place_and_its_value_answer_each_other() {
        let rect = Rect::from_min_size(pos2(10.0, 20.0), vec2(300.0, HEIGHT));
        let plot = Plot { rect, range: [-5.0, 15.0] };
        let (value, opacity) = plot.at(plot.place(7.5, 0.25));
        assert!((value - 7.5).abs() < 1e-4 && (opacity - 0.25).abs() < 1e-5);
    }
}
