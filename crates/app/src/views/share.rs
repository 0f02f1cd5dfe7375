//! The dialogue for sharing: what a reader will see of the block, the file's size, and notes on places.
//!
//! The preview is the made thing itself, with coarser faces: its triangles turn under the hand, and a press on them
//! points the arrow of a new note.

use super::{export, names, notices, texture};
use crate::state::picking::place_of;
use crate::state::{Action, Dialogue, Place, Session, ShareForm, ShareKind, State};
use crate::widgets::dialogue;
use crate::widgets::form;
use crate::widgets::keyboard::is_entered;
use crate::widgets::obstacle::{needs, unless};
use crate::work::{RunningLine, SharePreview};
use eframe::egui::{
    Align2, Button, Color32, ComboBox, Context, DragValue, FontId, Grid, Pos2, ProgressBar, Rect, Role, ScrollArea,
    Sense, Stroke, StrokeKind, TextEdit, TextureHandle, Ui, Vec2, WidgetInfo, pos2, vec2,
};
use glam::DVec2;
use project::command::{AddNote, Command};
use project::document::NoteEntry;
use project::error::Noun;
use project::pictures::PickedShare;
use review::preview::{Preview, Shown, draw};
use review::{DENSITIES, MOST_SECTIONS, glb, html};
use std::sync::Arc;
use survey::VerticalUnit;
use survey::block::VoxelBox;

/// Width of the labels in front of the fields, points: one column for all of them.
const LABELS: f32 = 134.0;

/// Room of the preview beside the form, points.
const ROOM: Vec2 = vec2(470.0, 352.0);
/// Degrees that the block turns for each point the hand moves.
const TURN_DEG: f64 = 0.35;
/// Where a note stands beside the place that it points at, points.
const BESIDE: Vec2 = vec2(40.0, -52.0);
/// Widest line of a note, points.
const NOTE_WIDTH: f32 = 150.0;
/// Height of the list of notes, points.
const NOTES_HEIGHT: f32 = 84.0;

/// What the dialogue keeps while it is open.
#[derive(Default)]
pub(crate) struct ShareView {
    seen: Option<Arc<SharePreview>>,
    /// What the preview was asked for.
    asked: Option<ShareForm>,
    drawn: Option<(Pose, Preview, TextureHandle)>,
    pose: Pose,
    note: NoteDraft,
    /// The note that was added last, until the project has it.
    sent: Option<NoteEntry>,
}

/// What of the preview is on the screen.
#[derive(Clone, Copy, PartialEq)]
struct Pose {
    scene: usize,
    /// Bearing and elevation of the camera, degrees; absent: the scene's.
    turned: Option<[f64; 2]>,
    shown: Shown,
    px: [u32; 2],
}

impl Default for Pose {
    fn default() -> Self {
        Self { scene: 0, turned: None, shown: Shown::Block, px: [0; 2] }
    }
}

/// A note that is being written.
#[derive(Default)]
struct NoteDraft {
    text: String,
    /// Inline, crossline and vertical value; absent: where the sections meet.
    at: Option<[f64; 3]>,
    scene: Option<String>,
}

impl ShareView {
    /// A preview is being made.
    pub(crate) fn ask(&mut self, form: &ShareForm) {
        self.asked = Some(form.previewed());
    }

    /// Takes over a preview.
    pub(crate) fn receive(&mut self, seen: Arc<SharePreview>) {
        let scenes = seen.model.scenes.len();
        self.pose.scene = self.pose.scene.min(scenes.saturating_sub(1));
        (self.seen, self.drawn) = (Some(seen), None);
    }

    /// Whether the preview shows something else than what is shared now.
    pub(crate) fn is_outdated(&self, form: &ShareForm) -> bool {
        self.seen.is_some() && self.asked.as_ref() != Some(&form.previewed())
    }

    /// Shows the dialogue; whether a preview is to be made.
    pub(crate) fn show(
        &mut self,
        ctx: &Context,
        state: &State,
        session: &Session,
        (form, sparse): (&ShareForm, &[PickedShare]),
        running: Option<&RunningLine>,
        actions: &mut Vec<Action>,
    ) -> bool {
        if self.sent.as_ref().is_some_and(|sent| session.document.notes.contains(sent)) {
            (self.sent, self.note.text) = (None, String::new());
        }
        let mut asks = false;
        let modal = dialogue::show(ctx, "share", |ui| {
            ui.heading("Share the block");
            ui.horizontal_top(|ui| {
                ui.vertical(|ui| {
                    ui.set_width(430.0);
                    asks = self.form(ui, state, session, (form, sparse), running, actions);
                });
                if self.seen.is_some() {
                    ui.vertical(|ui| self.preview(ui, session));
                }
            });
        });
        if modal.should_close() && running.is_none() {
            actions.push(Action::Answered);
        }
        asks
    }

    fn form(
        &mut self,
        ui: &mut Ui,
        state: &State,
        session: &Session,
        (form, sparse): (&ShareForm, &[PickedShare]),
        running: Option<&RunningLine>,
        actions: &mut Vec<Action>,
    ) -> bool {
        notices::show(ui, state, Place::Dialogue, actions);
        let mut next = form.clone();
        ui.horizontal(|ui| {
            for (kind, name, hint) in [
                (ShareKind::Page, "Page for browsers", "One file: turn, blend, read, present; no network"),
                (ShareKind::Model, "Model for slides", "glTF 2.0: PowerPoint, Blender, viewers of 3D models"),
            ] {
                ui.selectable_value(&mut next.kind, kind, name).on_hover_text(hint);
            }
        });
        Grid::new("share")
            .num_columns(2)
            .min_col_width(LABELS)
            .spacing([14.0, 8.0])
            .show(ui, |ui| rows(ui, session, &mut next));
        ui.separator();
        match next.kind {
            ShareKind::Page => self.notes(ui, session, actions),
            ShareKind::Model => {
                ui.weak("Notes are in the page: programs that show models have none.");
            }
        }
        ui.separator();
        let is_chosen = next.kind == ShareKind::Model
            || session.document.scenes.is_empty()
            || session.document.scenes.iter().any(|entry| !next.left_out.contains(&entry.name));
        let wrong = match next.kind {
            _ if next.has_ending() && is_chosen => None,
            _ if !is_chosen => Some("Tick at least one scene".to_owned()),
            kind => Some(format!("The file's name must end in .{}", kind.ending())),
        };
        wrong.iter().for_each(|wrong| {
            ui.colored_label(ui.visuals().error_fg_color, wrong.as_str());
        });
        if let Some(seen) = self.seen.as_ref().filter(|seen| seen.form == next.previewed()) {
            ui.label(facts(seen, &next));
        }
        let is_accepted = export::accept(ui, sparse, "Share it all the same", &mut next.accepts_sparse);
        let mut asks = false;
        ui.horizontal(|ui| {
            let obstacle = wrong.as_deref().or(running.map(|_| "Something is under way: wait, or stop it"));
            let unwanted = obstacle.or(needs(is_accepted, export::NOT_ACCEPTED));
            let button = unless(ui, unwanted, Button::new("Write the file"));
            if button.on_hover_text("Enter").clicked() || unwanted.is_none() && is_entered(ui) && !self.is_writing() {
                actions.push(Action::Share(Box::new(next.clone())));
            }
            let preview = unless(ui, obstacle, Button::new("Preview"));
            asks = preview.on_hover_text("Show what a reader will see, and how large the file will be").clicked();
            if unless(ui, running.map(|_| "Stop it first"), Button::new("Cancel")).clicked() {
                actions.push(Action::Answered);
            }
        });
        if let Some(line) = running {
            ui.horizontal(|ui| {
                if ui.button("Stop").on_hover_text(format!("Stop: {}", line.job)).clicked() {
                    line.progress.cancel();
                }
                ui.add(ProgressBar::new(line.share().unwrap_or(0.0)).desired_width(110.0));
                ui.label(if line.stage.is_empty() {
                    format!("{}…", line.job)
                } else {
                    format!("{}: {}", line.job, line.stage)
                });
            });
        }
        if next != *form {
            actions.push(Action::Ask(Box::new(Dialogue::Share(next))));
        }
        asks
    }

    /// Whether a note is being written: Enter adds it then.
    fn is_writing(&self) -> bool {
        !self.note.text.trim().is_empty()
    }

    /// The notes of the project, and a new one.
    fn notes(&mut self, ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
        let Some(geometry) = &session.document.geometry else { return };
        ui.strong("Notes on places");
        let unit = match geometry.vertical.unit {
            VerticalUnit::Milliseconds => "Time, ms",
            VerticalUnit::Metres => "Depth, m",
        };
        if !session.document.notes.is_empty() {
            ScrollArea::vertical().max_height(NOTES_HEIGHT).id_salt("notes").show(ui, |ui| {
                for (index, note) in session.document.notes.iter().enumerate() {
                    ui.horizontal(|ui| {
                        let remove = ui.button("×");
                        let name = format!("Remove note {}", index + 1);
                        remove.widget_info(|| WidgetInfo::labeled(Role::Button, true, &name));
                        if remove.on_hover_text(&name).clicked() {
                            let number = index + 1;
                            actions.push(names::remove(Noun::Note, &number.to_string()));
                        }
                        let [inline, crossline, z] = note.at;
                        let place = format!("inline {inline:.0}, crossline {crossline:.0}, {z:.0}");
                        let scene = note.scene.as_ref().map_or_else(String::new, |scene| format!("; scene {scene}"));
                        let label = eframe::egui::Label::new(format!("{}. {}", index + 1, note.text)).truncate();
                        ui.add(label).on_hover_text(format!("{} ({place}{scene})", note.text));
                    });
                }
            });
        }
        let place = self.note.at.unwrap_or_else(|| place_of(geometry, session.view.slices.into()));
        let mut at = place;
        Grid::new("note").num_columns(2).min_col_width(LABELS).spacing([14.0, 8.0]).show(ui, |ui| {
            let text = TextEdit::singleline(&mut self.note.text).char_limit(500).desired_width(300.0);
            form::row(ui, "New note", |ui| ui.add(text));
            ui.label("Points at");
            ui.horizontal(|ui| {
                let last = VoxelBox::of_size(geometry.size()).max;
                let ends = [[0.0; 3].into(), last.into()].map(|voxel| place_of(geometry, voxel));
                for (axis, name) in ["Inline", "Crossline", unit].into_iter().enumerate() {
                    let range = ends[0][axis].min(ends[1][axis])..=ends[0][axis].max(ends[1][axis]);
                    let value = DragValue::new(&mut at[axis]).range(range).max_decimals(if axis == 2 { 1 } else { 0 });
                    ui.name_inputs(format!("Note's {}", name.to_lowercase()), |ui| ui.add(value))
                        .on_hover_text(format!("{name}: or press a place of the preview"));
                }
            });
            ui.end_row();
            if !session.document.scenes.is_empty() {
                let combo = ComboBox::from_id_salt("note's scene");
                let combo = combo.selected_text(self.note.scene.as_deref().unwrap_or("every scene"));
                let scenes = session.document.scenes.iter().map(|entry| (Some(entry.name.clone()), &*entry.name));
                let choices = [(None, "every scene")].into_iter().chain(scenes);
                form::chosen(ui, "In", combo, &mut self.note.scene, choices);
            }
        });
        if at != place {
            self.note.at = Some(at);
        }
        let add = unless(ui, needs(self.is_writing(), "Write what it says"), Button::new("Add note"));
        if add.clicked() || self.is_writing() && is_entered(ui) {
            let note = NoteEntry { text: self.note.text.trim().to_owned(), at, scene: self.note.scene.clone() };
            self.sent = Some(note.clone());
            actions.push(Action::Apply(Box::new(Command::AddNote(AddNote { note }))));
        }
    }

    /// The block as a reader will see it, with its notes.
    fn preview(&mut self, ui: &mut Ui, session: &Session) {
        let Some(seen) = self.seen.clone() else { return };
        let scenes = &seen.model.scenes;
        ui.horizontal_wrapped(|ui| {
            for (index, scene) in scenes.iter().enumerate().filter(|_| scenes.len() > 1) {
                if ui.selectable_label(self.pose.scene == index, &scene.name).clicked() {
                    (self.pose.scene, self.pose.turned) = (index, None);
                }
            }
        });
        let scale = ui.ctx().pixels_per_point();
        self.pose.px = [ROOM.x, ROOM.y].map(|side| (side * scale).round() as u32);
        if self.drawn.as_ref().is_none_or(|(pose, ..)| *pose != self.pose) {
            let Pose { scene, turned, shown, px } = self.pose;
            let made = draw(&seen.model, scene, turned, px, shown);
            let mut kept = self.drawn.take().map(|(.., texture)| texture);
            let image = image::DynamicImage::from(made.image.clone()).to_rgba8();
            texture::keep(&mut kept, ui.ctx(), "shared block", texture::pixels(&image));
            self.drawn = kept.map(|texture| (self.pose, made, texture));
        }
        let (rect, response) = ui.allocate_exact_size(ROOM, Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, "What a reader will see"));
        let Some((_, made, texture)) = &self.drawn else { return };
        let painter = ui.painter_at(rect);
        painter.image(texture.id(), rect, Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0)), Color32::WHITE);
        painter.rect_stroke(rect, 0.0, Stroke::new(1.0, Color32::from_gray(0xd0)), StrokeKind::Inside);
        let Some(geometry) = &session.document.geometry else { return };
        let scene = scenes.get(self.pose.scene);
        let voxel = |[inline, crossline, z]: [f64; 3]| {
            geometry.voxel_from_lines(inline, crossline).extend(geometry.vertical.index_of(z))
        };
        let on_screen = |at: [f64; 3]| {
            let place = made.project(voxel(at));
            rect.min + vec2(place.x as f32, place.y as f32) / scale
        };
        let mut taken = Vec::new();
        let has_notes = seen.form.kind == ShareKind::Page;
        for note in session.document.notes.iter().filter(|_| has_notes) {
            if note.scene.as_ref().is_none_or(|name| scene.is_some_and(|scene| scene.name == *name)) {
                arrow(&painter, rect, on_screen(note.at), &note.text, &mut taken);
            }
        }
        if has_notes && (self.note.at.is_some() || self.is_writing()) {
            let at = self.note.at.unwrap_or_else(|| place_of(geometry, session.view.slices.into()));
            let text = if self.is_writing() { self.note.text.as_str() } else { "…" };
            arrow(&painter, rect, on_screen(at), text, &mut taken);
        }
        let pressed = response.clicked().then(|| response.interact_pointer_pos()).flatten().and_then(|at| {
            let pixel = (at - rect.min) * scale;
            made.place(DVec2::new(f64::from(pixel.x), f64::from(pixel.y)))
        });
        if let Some(place) = pressed {
            let [inline, crossline, z] = place_of(geometry, place);
            self.note.at = Some([inline.round(), crossline.round(), (z * 10.0).round() / 10.0]);
        }
        if let (true, Some(scene)) = (response.dragged(), scene) {
            let block = scene.scene.box_in(geometry);
            let camera = &scene.scene.camera;
            let [azimuth, elevation] =
                self.pose.turned.unwrap_or_else(|| [camera.azimuth_for(geometry, &block), camera.elevation_deg]);
            let by = response.drag_delta();
            let turned = (azimuth + f64::from(by.x) * TURN_DEG).rem_euclid(360.0);
            self.pose.turned = Some([turned, (elevation + f64::from(by.y) * TURN_DEG).clamp(0.0, 90.0)]);
        }
        ui.horizontal(|ui| {
            for (shown, name) in [(Shown::Block, "Faces"), (Shown::Surfaces, "Horizons and faults")] {
                ui.selectable_value(&mut self.pose.shown, shown, name);
            }
            if unless(ui, needs(self.pose.turned.is_some(), "It is as in the scene"), Button::new("As in the scene"))
                .clicked()
            {
                self.pose.turned = None;
            }
        });
        ui.weak(match has_notes {
            true => "Drag to turn it. Press a place to point a note at it. Faces are coarser here than in the file.",
            false => "Drag to turn it. Faces are coarser here than in the file.",
        });
    }
}

/// The fields of the file.
fn rows(ui: &mut Ui, session: &Session, next: &mut ShareForm) {
    let is_page = next.kind == ShareKind::Page;
    let path = if is_page { &mut next.page } else { &mut next.model };
    form::row(ui, "File", |ui| ui.add(TextEdit::singleline(path).desired_width(300.0)));
    let scenes = &session.document.scenes;
    if is_page && !scenes.is_empty() {
        ui.label("Scenes");
        ui.horizontal_wrapped(|ui| {
            for entry in scenes {
                let mut is_shown = !next.left_out.contains(&entry.name);
                if ui.checkbox(&mut is_shown, &entry.name).changed() {
                    next.left_out.retain(|known| *known != entry.name);
                    next.left_out.extend((!is_shown).then(|| entry.name.clone()));
                }
            }
        });
        ui.end_row();
    } else if !scenes.is_empty() {
        let combo = ComboBox::from_id_salt("scene");
        let combo = combo.selected_text(next.scene.as_ref().unwrap_or(&scenes[0].name));
        let choices = scenes.iter().map(|entry| (Some(entry.name.clone()), &entry.name));
        form::chosen(ui, "Scene", combo, &mut next.scene, choices);
    }
    let number = |ui: &mut Ui, name: &str, unit: &str, value: &mut f64, [least, most]: [f64; 2], decimals: usize| {
        let speed = ((most - least) / 2000.0).clamp(0.1, 20.0);
        let drag = DragValue::new(value).range(least..=most).speed(speed).max_decimals(decimals).suffix(unit);
        form::row(ui, name, |ui| ui.add(drag));
    };
    number(ui, "Detail of faces", " texels along the block", &mut next.density, DENSITIES, 0);
    if is_page {
        let mut sections = next.sections as f64;
        number(ui, "Sections of each kind", " to step through", &mut sections, [0.0, MOST_SECTIONS as f64], 0);
        next.sections = sections as usize;
        number(ui, "Largest size", " MB", &mut next.limit_mb, html::SIZES_MB, 1);
    } else {
        let mut triangles = next.triangles as f64;
        number(ui, "Most triangles", "", &mut triangles, glb::TRIANGLES.map(|count| count as f64), 0);
        next.triangles = triangles as usize;
    }
}

/// What the file will be.
fn facts(seen: &SharePreview, form: &ShareForm) -> String {
    let megabytes = seen.bytes(form.density) as f64 / 1e6;
    let size = match form.kind {
        ShareKind::Page if megabytes > form.limit_mb => {
            format!("About {megabytes:.0} MB, so faces will be coarser: at most {} MB", form.limit_mb)
        }
        _ => format!("About {megabytes:.1} MB"),
    };
    let [usual, most] = seen.deviations_m;
    format!(
        "{size}; {} triangles; 99 % of every surface within {usual:.1} m of the interpretation, all within {most:.1} m",
        grouped(seen.triangles)
    )
}

/// A number with its thousands apart.
fn grouped(number: usize) -> String {
    let digits = number.to_string();
    let apart = |(n, digit): (usize, char)| {
        let gap = (n > 0 && (digits.len() - n).is_multiple_of(3)).then_some('\u{a0}');
        gap.into_iter().chain([digit])
    };
    digits.chars().enumerate().flat_map(apart).collect()
}

/// A note and its arrow.
fn arrow(painter: &eframe::egui::Painter, within: Rect, at: Pos2, text: &str, taken: &mut Vec<Rect>) {
    let ink = Color32::from_rgb(0x2a, 0x26, 0x22);
    let galley = painter.layout(text.to_owned(), FontId::proportional(12.5), ink, NOTE_WIDTH);
    let size = galley.size() + vec2(12.0, 8.0);
    let side = if at.x > within.left() + 0.62 * within.width() { -BESIDE.x - size.x } else { BESIDE.x };
    let mut room = Rect::from_min_size(at + vec2(side, BESIDE.y - 0.5 * size.y), size);
    for _ in 0..8 {
        if let Some(hit) = taken.iter().find(|known| known.intersects(room)) {
            room = room.translate(vec2(0.0, hit.bottom() + 6.0 - room.top()));
        }
    }
    let shift = |low: f32, high: f32, first: f32, last: f32| (first - low).max(0.0) - (high - last).max(0.0);
    let inside = within.shrink(6.0);
    room = room.translate(vec2(
        shift(room.left(), room.right(), inside.left(), inside.right()),
        shift(room.top(), room.bottom(), inside.top(), inside.bottom()),
    ));
    let from = room.clamp(at);
    painter.arrow(from, at - from, Stroke::new(1.6, ink));
    painter.rect(room, 4.0, Color32::from_rgb(0xff, 0xfb, 0xef), Stroke::new(1.0, ink), StrokeKind::Inside);
    painter.galley(Align2::CENTER_CENTER.align_size_within_rect(galley.size(), room).min, galley, ink);
    taken.push(room);
}

#[cfg(test)]
mod tests {
    use super::grouped;

    #[test]
    fn thousands_stand_apart() {
        assert_eq!([7, 1234, 100_000].map(grouped), ["7", "1\u{a0}234", "100\u{a0}000"]);
    }
}
