//! A figure's page as it will be printed, on which labels are dragged, restyled and left out.
//!
//! The page is kept as it was laid out; what a scene changes about its labels is done to a copy of it, by what does it
//! when the figure is made. So the place at which a label is dropped is the place at which it is printed.

use crate::widgets::colour_well;
use eframe::egui::{
    Button, Color32, ColorImage, CursorIcon, DragValue, PointerButton, Pos2, Rect, Response, Role, Sense, Stroke,
    StrokeKind, TextureHandle, TextureOptions, Ui, Vec2, WidgetInfo,
};
use figure::draw::label_changes::{LabelChange, Movable, changed, movable};
use glam::DVec2;
use page::DisplayList;
use page::list::POINTS_PER_MM;
use std::sync::Arc;
use ttf::{Colour, Preset};

/// Pixels an inch of the page at which it is drawn here.
pub(crate) const PREVIEW_DPI: f64 = 110.0;
/// How far beside a label it may be taken, points of the page.
const REACH_PT: f64 = 2.0;
/// Sizes that letters may be given, points.
const SIZES_PT: std::ops::RangeInclusive<f64> = 5.0..=36.0;
/// The frame of a label that is chosen, pointed at or dragged.
const FRAME: Color32 = Color32::from_rgb(0xa4, 0x4a, 0x1c);

/// A page on the screen.
#[derive(Default)]
pub struct PagePreview {
    page: Option<(Arc<DisplayList>, Preset)>,
    /// What is drawn: with which changes, its picture and its labels.
    drawn: Option<(Vec<LabelChange>, TextureHandle, Vec<Movable>)>,
    /// The label that is dragged, and where it was taken.
    dragged: Option<(Movable, Pos2)>,
    /// The label whose letters are changed.
    chosen: Option<String>,
}

impl PagePreview {
    /// Shows another page, laid out without changes to its labels.
    pub fn set(&mut self, page: Arc<DisplayList>, preset: Preset) {
        *self = Self { page: Some((page, preset)), ..Self::default() };
    }

    /// Whether there is a page to show.
    pub(crate) fn has_page(&self) -> bool {
        self.page.is_some()
    }

    /// Draws the page within a width and a height; the changes after one of its labels was dropped or left out.
    pub fn show(&mut self, ui: &mut Ui, room: Vec2, changes: &[LabelChange]) -> Option<Vec<LabelChange>> {
        let (page, preset) = self.page.as_ref()?;
        if self.drawn.as_ref().is_none_or(|(known, ..)| known != changes) {
            let list = changed(page, changes, *preset);
            let image = page::raster(&list, PREVIEW_DPI).ok()?;
            let pixels = ColorImage::from_rgba_unmultiplied([image.width() as usize, image.height() as usize], &image);
            let texture = ui.ctx().load_texture("page", pixels, TextureOptions::LINEAR);
            self.drawn = Some((changes.to_vec(), texture, movable(&list)));
        }
        let (_, texture, labels) = self.drawn.as_ref()?;
        let size = Vec2::new(page.size.x as f32, page.size.y as f32);
        let scale = (room / size).min_elem();
        let (rect, response) = ui.allocate_exact_size(size * scale, Sense::click_and_drag());
        let whole = Rect::from_min_max(Pos2::ZERO, Pos2::new(1.0, 1.0));
        ui.painter().image(texture.id(), rect, whole, Color32::WHITE);
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, "Page as it will be printed"));
        let on_page = |at: Pos2| {
            let at = (at - response.rect.min) / scale;
            DVec2::new(f64::from(at.x), f64::from(at.y))
        };
        let taken = response.interact_pointer_pos().or(response.hover_pos());
        let pointed = taken.and_then(|at| label_at(labels, on_page(at)));
        if response.drag_started_by(PointerButton::Primary) {
            let begin = ui.input(|input| input.pointer.press_origin());
            let label = begin.and_then(|at| Some((label_at(labels, on_page(at))?.clone(), at)));
            self.dragged = label;
        }
        if response.clicked() {
            self.chosen = pointed.map(|label| label.label.clone());
        }
        let by = |from: Pos2| taken.map_or(Vec2::ZERO, |at| at - from);
        if let Some((label, by)) = match &self.dragged {
            Some((label, from)) => Some((label, by(*from))),
            None => pointed.map(|label| (label, Vec2::ZERO)),
        } {
            frame(ui, &response, label, scale, by);
            ui.ctx().set_cursor_icon(CursorIcon::Grab);
        }
        if let Some(label) =
            labels.iter().find(|label| self.dragged.is_none() && Some(&label.label) == self.chosen.as_ref())
        {
            frame(ui, &response, label, scale, Vec2::ZERO);
        }
        if response.drag_stopped() {
            let (label, from) = self.dragged.take()?;
            let moved = DVec2::new(f64::from(by(from).x), f64::from(by(from).y)) / f64::from(scale) / POINTS_PER_MM;
            return Some(with(changes, &label.label, |change| {
                // A tenth of a millimetre is finer than a hand.
                let place = (DVec2::from_array(change.moved_mm) + moved) * 10.0;
                change.moved_mm = (place.round() / 10.0).to_array();
            }));
        }
        let hidden = pointed.filter(|_| response.secondary_clicked())?;
        Some(with(changes, &hidden.label, |change| change.is_hidden = true))
    }

    /// The letters of the label that was clicked, and the labels that are left out; the changes after one of them was made.
    pub fn show_chosen(&mut self, ui: &mut Ui, changes: &[LabelChange]) -> Option<Vec<LabelChange>> {
        let mut made = None;
        let (_, _, labels) = self.drawn.as_ref()?;
        let chosen = labels.iter().find(|label| Some(&label.label) == self.chosen.as_ref());
        ui.horizontal(|ui| match chosen {
            None => {
                ui.weak("Click a label to change its letters, drag it elsewhere; a right click leaves it out.");
            }
            Some(Movable { label, letters, .. }) => {
                ui.label(label);
                if let Some((size, colour)) = letters {
                    let mut size_pt = *size;
                    let drag = DragValue::new(&mut size_pt).speed(0.1).range(SIZES_PT).max_decimals(1);
                    let is_sized = ui.name_inputs("Size of the letters", |ui| ui.add(drag)).changed();
                    ui.weak("pt");
                    let mut rgb = colour.rgb;
                    colour_well(ui, "Colour of the letters", &mut rgb);
                    if is_sized {
                        made = Some(with(changes, label, |change| change.size_pt = Some(size_pt)));
                    }
                    if rgb != colour.rgb {
                        made = Some(with(changes, label, |change| change.colour = Some(Colour { rgb })));
                    }
                }
                if ui.button("Leave out").clicked() {
                    made = Some(with(changes, label, |change| change.is_hidden = true));
                }
                let is_changed = changes.iter().any(|change| change.label == *label);
                let back = ui.add_enabled(is_changed, Button::new("As it was"));
                if back.on_hover_text("Where it was placed, with the letters it had").clicked() {
                    made = Some(changes.iter().filter(|change| change.label != *label).cloned().collect());
                }
            }
        });
        let hidden: Vec<&str> =
            changes.iter().filter(|change| change.is_hidden).map(|change| change.label.as_str()).collect();
        if !hidden.is_empty() {
            ui.horizontal_wrapped(|ui| {
                ui.weak("Left out:");
                for label in hidden {
                    if ui.button(label).on_hover_text("Put it back").clicked() {
                        made = Some(with(changes, label, |change| change.is_hidden = false));
                    }
                }
            });
        }
        made
    }
}

/// The smallest label at a place of the page.
fn label_at(labels: &[Movable], at: DVec2) -> Option<&Movable> {
    let near = labels.iter().filter(|label| label.bounds.grown(REACH_PT).contains(at));
    let area = |label: &&Movable| label.bounds.size().element_product();
    near.min_by(|a, b| area(a).total_cmp(&area(b)))
}

fn frame(ui: &Ui, response: &Response, label: &Movable, scale: f32, by: Vec2) {
    let corner = |at: DVec2| response.rect.min + Vec2::new(at.x as f32, at.y as f32) * scale + by;
    let rect = Rect::from_min_max(corner(label.bounds.min), corner(label.bounds.max)).expand(2.0);
    ui.painter().rect_stroke(rect, 2.0, Stroke::new(1.0, FRAME), StrokeKind::Outside);
}

/// The changes with one of them made.
fn with(changes: &[LabelChange], label: &str, change: impl FnOnce(&mut LabelChange)) -> Vec<LabelChange> {
    let mut changes = changes.to_vec();
    let place = changes.iter().position(|known| known.label == label).unwrap_or_else(|| {
        changes.push(LabelChange { label: label.to_owned(), ..LabelChange::default() });
        changes.len() - 1
    });
    change(&mut changes[place]);
    changes
}
