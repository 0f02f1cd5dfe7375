//! Presenting: the scenes of the project one after the other over the whole screen.
//!
//! The block has all the room there is, above a strip with a small picture of each scene. Right, Down, Page down and
//! Space go on; Left, Up and Page up go back; Escape leaves, and the view is as it was before.

use super::block::{BlockView, paper};
use super::overlay::Overlay;
use super::texture;
use crate::state::{Action, Panel, Session};
use crate::widgets::obstacle::{needs, unless};
use crate::widgets::theme;
use crate::work::{Drawing, Rocks};
use eframe::egui::text::{LayoutJob, TextWrapping};
use eframe::egui::{
    Align2, Button, CentralPanel, Color32, Context, FontId, Frame, Key, Modifiers, Rect, Role, ScrollArea, Sense,
    Stroke, StrokeKind, TextureHandle, Ui, WidgetInfo, pos2, vec2,
};
use image::RgbaImage;
use std::collections::HashMap;

/// Size of a scene's small picture, points.
pub(crate) const THUMBNAIL: [u32; 2] = [132, 84];
/// Height of the strip, points.
const STRIP: f32 = 122.0;
/// Behind pictures that have not been drawn yet.
const EMPTY: Color32 = Color32::from_rgb(0x3a, 0x40, 0x46);

/// Keys that go to the next scene, and to the one before.
const KEYS: [(&[Key], isize); 2] = [
    (&[Key::ArrowRight, Key::ArrowDown, Key::PageDown, Key::Space], 1),
    (&[Key::ArrowLeft, Key::ArrowUp, Key::PageUp], -1),
];

/// The small pictures.
#[derive(Default)]
pub(crate) struct Presentation {
    pictures: HashMap<String, TextureHandle>,
    /// The revision of the project that they were asked for.
    asked: Option<u64>,
}

impl Presentation {
    /// Whether the small pictures have to be drawn, of this state of the project; they are asked for once.
    pub(crate) fn asks(&mut self, session: &Session) -> bool {
        let is_new = self.asked != Some(session.revision);
        self.asked = Some(session.revision);
        is_new
    }

    /// Takes over the small picture of a scene.
    pub(crate) fn receive(&mut self, ctx: &Context, name: String, image: &RgbaImage) {
        let mut kept = self.pictures.remove(&name);
        texture::keep(&mut kept, ctx, &format!("scene {name}"), texture::pixels(image));
        self.pictures.extend(kept.map(|kept| (name, kept)));
    }

    /// Shows the scene and the strip, and obeys the keys.
    pub(crate) fn show(
        &self,
        ui: &mut Ui,
        session: &Session,
        at: usize,
        (block, overlay): (&mut BlockView, &Overlay),
        (rocks, drawing): (Option<&Rocks>, &Drawing),
        actions: &mut Vec<Action>,
    ) {
        obey(ui.ctx(), session, at, actions);
        eframe::egui::Panel::bottom("scenes").exact_size(STRIP).show(ui, |ui| self.strip(ui, session, at, actions));
        let frame = Frame::new().fill(paper(ui));
        CentralPanel::no_frame().frame(frame).show(ui, |ui| {
            block.show(ui, session, rocks, drawing, overlay, actions);
        });
    }

    fn strip(&self, ui: &mut Ui, session: &Session, at: usize, actions: &mut Vec<Action>) {
        ui.horizontal_centered(|ui| {
            if ui.button("Leave").on_hover_text("Back to the window (Escape)").clicked() {
                actions.push(Action::Present(None));
            }
            for (step, name, end) in
                [(-1, "Previous", "This is the first scene"), (1, "Next", "This is the last scene")]
            {
                let to = at.checked_add_signed(step).filter(|to| *to < session.document.scenes.len());
                if unless(ui, needs(to.is_some(), end), Button::new(name)).clicked() {
                    actions.push(Action::Present(to));
                }
            }
            ui.separator();
            ScrollArea::horizontal().show(ui, |ui| {
                ui.horizontal_centered(|ui| {
                    for (index, entry) in session.document.scenes.iter().enumerate() {
                        if self.card(ui, &entry.name, index == at) {
                            actions.push(Action::Present(Some(index)));
                        }
                    }
                });
            });
        });
    }

    /// The small picture of a scene over its name; whether it was clicked.
    fn card(&self, ui: &mut Ui, name: &str, is_shown: bool) -> bool {
        let [width, height] = THUMBNAIL.map(|side| side as f32);
        let (rect, response) = ui.allocate_exact_size(vec2(width, height + 22.0), Sense::click());
        response.widget_info(|| WidgetInfo::selected(Role::Button, true, is_shown, format!("Scene {name}")));
        let picture = Rect::from_min_size(rect.min, vec2(width, height));
        let painter = ui.painter_at(rect.expand(2.0));
        match self.pictures.get(name) {
            Some(texture) => {
                painter.rect_filled(picture, 3.0, paper(ui));
                let uv = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
                painter.image(texture.id(), picture, uv, Color32::WHITE);
            }
            None => {
                painter.rect_filled(picture, 3.0, EMPTY);
            }
        }
        if is_shown {
            painter.rect_stroke(picture, 3.0, Stroke::new(2.5, theme::accent(ui.visuals())), StrokeKind::Outside);
        }
        let room = Rect::from_min_max(picture.left_bottom(), rect.max);
        let mut words =
            LayoutJob::simple_singleline(name.to_owned(), FontId::proportional(12.0), ui.visuals().text_color());
        words.wrap = TextWrapping::truncate_at_width(room.width());
        let words = painter.layout_job(words);
        painter.galley(Align2::CENTER_CENTER.align_size_within_rect(words.size(), room).min, words, Color32::WHITE);
        response.on_hover_text(name).clicked()
    }
}

fn obey(ctx: &Context, session: &Session, at: usize, actions: &mut Vec<Action>) {
    let pressed = |key: Key| ctx.input_mut(|input| input.consume_key(Modifiers::NONE, key));
    if pressed(Key::Escape) {
        actions.push(Action::Present(None));
        return;
    }
    for (keys, by) in KEYS {
        if keys.iter().any(|key| pressed(*key)) {
            let last = session.document.scenes.len().saturating_sub(1);
            actions.push(Action::Present(Some(at.saturating_add_signed(by).min(last))));
        }
    }
}

/// Whether the scenes can be presented: there are some, and what they show is not being interpreted.
pub(crate) fn obstacle(session: &Session) -> Option<&'static str> {
    if session.document.scenes.is_empty() {
        Some("Save a scene first")
    } else if session.view.panel == Panel::Interpret {
        Some("Scenes are illustrations: leave Interpret first")
    } else {
        None
    }
}
