//! The start page: continue, open a project, create one.

use super::{notices, texture};
use crate::state::{Action, Choice, Dialogue, Place, State};
use crate::widgets::obstacle::{needs, unless};
use crate::widgets::theme;
use crate::work::folder::Presence;
use eframe::egui::{
    Align, Button, Color32, Context, Label, Layout, Rect, RichText, Role, ScrollArea, Sense, Stroke, TextureHandle,
    TextureOptions, Ui, UiBuilder, Vec2, WidgetInfo, pos2, vec2,
};
use std::path::Path;

/// Width of the column in the middle.
const WIDTH: f32 = 660.0;
/// Height of the buttons that create or open a project.
const TALL: f32 = 42.0;
/// Height of the row of a recent project.
const ROW: f32 = 26.0;
/// Position of the dividing line until the pointer moves it, share of the width.
const PARTED: f32 = 0.42;

/// The demonstration's block, raw and illustrated: it shows what the program is for.
const BLOCK: [&[u8]; 2] = [include_bytes!("start/raw.png"), include_bytes!("start/illustrated.png")];
/// Size of a pixel of these pictures in points: they are drawn for high-density displays.
const PICTURE_SCALE: f32 = 0.6;

/// The page, and what it keeps.
#[derive(Default)]
pub(crate) struct StartPage {
    block: Option<[TextureHandle; 2]>,
    present: Presence,
}

impl StartPage {
    /// Shows the page.
    pub(crate) fn show(&mut self, ui: &mut Ui, state: &State, is_busy: bool, actions: &mut Vec<Action>) {
        ScrollArea::vertical().show(ui, |ui| {
            ui.vertical_centered(|ui| {
                ui.set_max_width(WIDTH.min(ui.available_width()));
                ui.with_layout(Layout::top_down(Align::Min), |ui| self.page(ui, state, is_busy, actions));
            });
        });
    }

    fn page(&mut self, ui: &mut Ui, state: &State, is_busy: bool, actions: &mut Vec<Action>) {
        ui.add_space((ui.ctx().content_rect().height() * 0.03).min(40.0));
        ui.label(RichText::new("Petroglyph").size(40.0).color(theme::accent(ui.visuals())));
        ui.label("From a seismic volume to a geological illustration");
        ui.add_space(8.0);
        self.picture(ui);
        ui.add_space(8.0);
        begin(ui, state, is_busy, actions);
        ui.add_space(20.0);
        self.recent(ui, state, is_busy, actions);
    }

    /// The block, raw on one side of a line and illustrated on the other; the line follows the pointer.
    fn picture(&mut self, ui: &mut Ui) {
        let block = self.block.get_or_insert_with(|| BLOCK.map(|png| decoded(ui.ctx(), png)));
        let shape = block[0].size_vec2() * PICTURE_SCALE;
        let size = shape * (ui.available_width() / shape.x).min(1.0);
        let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, "A block, raw and illustrated"));
        let share = response.hover_pos().map_or(PARTED, |at| (at.x - rect.left()) / rect.width());
        let share = ui.ctx().animate_value_with_time(response.id, share, 0.15);
        let x = rect.left() + share * rect.width();
        let uv = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        let (left, right) = rect.split_left_right_at_x(x);
        for (texture, part) in block.iter().zip([left, right]) {
            ui.painter_at(part).image(texture.id(), rect, uv, Color32::WHITE);
        }
        ui.painter().vline(x, rect.y_range(), Stroke::new(1.5, theme::accent(ui.visuals())));
    }

    fn recent(&mut self, ui: &mut Ui, state: &State, is_busy: bool, actions: &mut Vec<Action>) {
        let projects = &state.remembered.recent;
        let present = self.present.of(ui.ctx(), projects);
        ui.heading("Recent projects");
        if projects.is_empty() {
            ui.weak("Projects you open will be listed here.");
        }
        for (root, there) in projects.iter().zip(present) {
            let can = there && !is_busy;
            // The row is below what is in it: a click beside its name opens the project too.
            let row = UiBuilder::new().sense(if can { Sense::click() } else { Sense::hover() });
            let row = ui.scope_builder(row, |ui| {
                ui.horizontal(|ui| {
                    if can && ui.response().contains_pointer() {
                        let back = Rect::from_min_size(ui.cursor().min, vec2(ui.available_width(), ROW));
                        ui.painter().rect_filled(back, 4.0, ui.visuals().widgets.hovered.weak_bg_fill);
                    }
                    ui.set_min_height(ROW);
                    let title = RichText::new(name(root)).size(16.0);
                    let open = ui.add_enabled(can, Button::new(title).frame(false));
                    let open =
                        open.on_hover_text("Open this project").on_disabled_hover_text("This folder no longer exists");
                    ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                        let forget = ui.button("Forget").on_hover_text(format!("Take {} off this list", name(root)));
                        if forget.clicked() {
                            actions.push(Action::Forget(root.clone()));
                        }
                        let folder = root.parent().map_or_else(String::new, |parent| parent.display().to_string());
                        ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                            ui.add(Label::new(RichText::new(folder).weak()).selectable(false).truncate());
                        });
                    });
                    open.clicked()
                })
                .inner
            });
            if row.inner || row.response.clicked() {
                actions.push(Action::Open(root.clone()));
            }
        }
    }
}

/// A picture of ours, for the screen.
fn decoded(ctx: &Context, png: &[u8]) -> TextureHandle {
    let image = image::load_from_memory_with_format(png, image::ImageFormat::Png).unwrap_or_default().to_rgba8();
    ctx.load_texture("start", texture::pixels(&image), TextureOptions::LINEAR)
}

fn begin(ui: &mut Ui, state: &State, is_busy: bool, actions: &mut Vec<Action>) {
    notices::show(ui, state, Place::Start, actions);
    if let Some(left) = &state.remembered.left {
        recovery(ui, &left.root, is_busy, actions);
    }
    ui.add_enabled_ui(!is_busy, |ui| {
        let width = (ui.available_width() - 2.0 * ui.spacing().item_spacing.x) / 3.0;
        let begin = |ui: &mut Ui, name: &str, hint: &str, choice: Choice, actions: &mut Vec<Action>| {
            let button = Button::new(RichText::new(name).size(16.0)).min_size(Vec2::new(width, TALL));
            if ui.add(button).on_hover_text(hint).clicked() {
                actions.push(Action::Ask(Box::new(Dialogue::Choose(choice))));
            }
        };
        ui.horizontal(|ui| {
            begin(ui, "New from SEG-Y…", "Read a seismic volume into a new project", Choice::NewSurvey, actions);
            begin(ui, "Open project…", "Open a folder NAME.petro", Choice::Project, actions);
            let hint = "Makes a synthetic survey with its interpretation, to try everything on";
            begin(ui, "Try the demonstration…", hint, Choice::Demo, actions);
        });
    });
}

fn recovery(ui: &mut Ui, root: &Path, is_busy: bool, actions: &mut Vec<Action>) {
    ui.group(|ui| {
        ui.set_width(ui.available_width());
        ui.strong(format!("{} was still open when Petroglyph ended", name(root)));
        ui.label("Every change to it had been saved. Continue with the same view?");
        ui.horizontal(|ui| {
            if unless(ui, needs(!is_busy, "Wait until the present work is done"), Button::new("Continue")).clicked() {
                actions.push(Action::Recover);
            }
            if ui.button("Not now").clicked() {
                actions.push(Action::Abandon);
            }
        });
    });
    ui.add_space(10.0);
}

/// The name of a project.
fn name(root: &Path) -> String {
    root.file_stem().map_or_else(|| root.display().to_string(), |stem| stem.to_string_lossy().into_owned())
}
