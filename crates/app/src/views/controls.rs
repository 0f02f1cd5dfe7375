//! The panel on the right: camera, display, block, and named scenes.

use super::names::{NameField, remove};
use super::{cut_shapes, notices};
use crate::state::{Action, Panel, Place, Session, StandardView, State};
use crate::widgets::form::{self, LABELS};
use crate::widgets::obstacle::{needs, unless};
use crate::widgets::percent;
use eframe::egui::{Align, Button, ComboBox, DragValue, Grid, Layout, ScrollArea, Slider, TextEdit, Ui};
use glam::DVec3;
use project::command::{AddScene, Command};
use project::error::Noun;
use render::{Corner, Ground, PatternSize, Projection, Scene, VoxelBox};
use survey::VerticalUnit;
use ttf::Preset;

/// Opening angle that a perspective starts with.
const FOV_DEG: f64 = 35.0;
/// Width that the label and the number beside a slider take, points.
const BESIDE_SLIDER: f32 = 184.0;
/// Width that the buttons beside a scene take, points.
const BESIDE_SCENE: f32 = 164.0;
/// Margins of a field, and room beside it, points.
const BESIDE_FIELD: f32 = 16.0;
/// Shares of the block that a new corner cut takes.
const CUT_SHARE: [f64; 2] = [0.45, 0.45];

/// The panel, with the text being typed in it.
#[derive(Debug, Default)]
pub(crate) struct Controls {
    scene_name: String,
    /// The scene whose name is being changed.
    renaming: NameField,
}

impl Controls {
    /// Shows the panel.
    pub(crate) fn show(&mut self, ui: &mut Ui, state: &State, session: &Session, actions: &mut Vec<Action>) {
        ScrollArea::vertical().show(ui, |ui| {
            // The panel keeps its width whatever rows it has, so that the middle keeps its place.
            ui.spacing_mut().slider_width = (ui.available_width() - BESIDE_SLIDER).max(60.0);
            let scene = &session.view.scene;
            let mut next = scene.clone();
            ui.add_space(8.0);
            ui.heading("View");
            camera(ui, &mut next, actions);
            ui.add_space(10.0);
            ui.heading("Display");
            display(ui, session, &mut next);
            ui.add_space(10.0);
            ui.heading("Block");
            block(ui, session, &mut next, actions);
            if next != *scene {
                actions.push(Action::Show(Box::new(next)));
            }
            ui.add_space(10.0);
            ui.heading("Scenes");
            notices::show(ui, state, Place::Scenes, actions);
            self.scenes(ui, session, actions);
        });
    }

    fn scenes(&mut self, ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
        for entry in &session.document.scenes {
            ui.horizontal(|ui| {
                let width = ui.available_width() - BESIDE_FIELD;
                if self.renaming.show(ui, width, (Noun::Scene, &entry.name), actions).is_some() {
                    return;
                }
                let shown = ui.scope(|ui| {
                    ui.set_max_width((ui.available_width() - BESIDE_SCENE).max(60.0));
                    ui.add(Button::new(&entry.name).truncate())
                });
                if shown.inner.on_hover_text(format!("Show scene {}", entry.name)).clicked() {
                    actions.push(Action::ShowNamed(entry.name.clone()));
                }
                ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                    if ui.button("Remove").on_hover_text(format!("Remove scene {}", entry.name)).clicked() {
                        actions.push(remove(Noun::Scene, &entry.name));
                    }
                    if ui.button("Rename").on_hover_text(format!("Rename scene {}", entry.name)).clicked() {
                        self.renaming.begin(Noun::Scene, &entry.name);
                    }
                });
            });
        }
        ui.horizontal(|ui| {
            let label = form::label(ui, "Scene name");
            let room = (ui.available_width() - BESIDE_FIELD).max(40.0);
            ui.add(TextEdit::singleline(&mut self.scene_name).desired_width(room)).labelled_by(label.id);
        });
        ui.horizontal(|ui| {
            let name = self.scene_name.trim().to_owned();
            if unless(ui, needs(!name.is_empty(), "Give the scene a name"), Button::new("Save scene")).clicked() {
                let command = AddScene { name, scene: session.view.scene.clone() };
                actions.push(Action::Apply(Box::new(Command::AddScene(command))));
                self.scene_name.clear();
            }
            let obstacle = super::present::obstacle(session);
            let present = unless(ui, obstacle, Button::new("Present"));
            if present.on_hover_text("The scenes one after the other over the whole screen (F5)").clicked() {
                actions.push(Action::Present(Some(0)));
            }
        });
    }
}

fn camera(ui: &mut Ui, scene: &mut Scene, actions: &mut Vec<Action>) {
    ui.horizontal_wrapped(|ui| {
        for place in StandardView::ALL {
            if ui.button(place.name()).clicked() {
                actions.push(Action::Stand(place));
            }
        }
    });
    ui.horizontal(|ui| {
        let is_perspective = matches!(scene.camera.projection, Projection::Perspective { .. });
        if ui.selectable_label(!is_perspective, "Parallel").on_hover_text("One scale everywhere").clicked() {
            scene.camera.projection = Projection::Orthographic;
        }
        if ui.selectable_label(is_perspective, "Perspective").clicked() && !is_perspective {
            scene.camera.projection = Projection::Perspective { fov_deg: FOV_DEG };
        }
    });
}

fn display(ui: &mut Ui, session: &Session, scene: &mut Scene) {
    let has_layers = !session.document.horizons.is_empty() && session.view.panel != Panel::Interpret;
    Grid::new("display").num_columns(2).min_col_width(LABELS).show(ui, |ui| {
        form::row(ui, "Exaggeration", |ui| {
            ui.add(Slider::new(&mut scene.exaggeration, 0.25..=20.0).logarithmic(true).max_decimals(2).suffix("×"))
        });
        if has_layers {
            form::row(ui, "Pattern density", |ui| {
                ui.add(
                    Slider::new(&mut scene.global_frequency, 0.1..=10.0).logarithmic(true).max_decimals(2).suffix("×"),
                )
            });
        }
        if has_layers {
            form::row(ui, "Pattern size", |ui| {
                let mut on_paper = scene.pattern_size == PatternSize::Paper;
                let constant = ui.checkbox(&mut on_paper, "kept while zooming");
                if constant.changed() {
                    scene.pattern_size = if on_paper { PatternSize::Paper } else { PatternSize::Rock };
                }
                constant
            });
        }
        if has_layers {
            form::row(ui, "Print in", |ui| {
                let words = |preset: Preset| preset.name().replace('-', " ");
                let shown = ComboBox::from_id_salt("preset").selected_text(words(scene.preset));
                let shown = shown.show_ui(ui, |ui| {
                    for preset in Preset::ALL {
                        ui.selectable_value(&mut scene.preset, preset, words(preset));
                    }
                });
                shown.response
            });
        }
        form::row(ui, "Face tone", |ui| ui.add(percent::slider_to(&mut scene.face_tone, 0.5)));
    });
    if has_layers {
        let mut has_ground = scene.ground.is_some();
        let ground = ui.checkbox(&mut has_ground, "Ground: topmost horizon as relief");
        if ground.changed() {
            scene.ground = has_ground.then(Ground::default);
        }
        if let Some(ground) = &mut scene.ground {
            Grid::new("ground").num_columns(2).min_col_width(LABELS).show(ui, |ui| {
                form::row(ui, "Hill shading", |ui| ui.add(percent::slider(&mut ground.hill_shade)));
                form::row(ui, "Light from", |ui| {
                    ui.add(Slider::new(&mut ground.light_deg, -180.0..=180.0).max_decimals(0).suffix("°"))
                });
            });
        }
    }
}

/// The limits of the box in line numbers and vertical values, and the cut-outs.
fn block(ui: &mut Ui, session: &Session, scene: &mut Scene, actions: &mut Vec<Action>) {
    let Some(geometry) = &session.document.geometry else { return };
    let bounds = scene.box_in(geometry);
    let mut changed = bounds;
    let last = VoxelBox::of_size(geometry.size()).max;
    Grid::new("box").num_columns(3).show(ui, |ui| {
        let vertical = match geometry.vertical.unit {
            VerticalUnit::Milliseconds => "Time, ms",
            VerticalUnit::Metres => "Depth, m",
        };
        for (axis, name) in ["Inlines", "Crosslines", vertical].into_iter().enumerate() {
            form::label(ui, name);
            for (end, word) in ["from", "to"].into_iter().enumerate() {
                let voxel = if end == 0 { bounds.min[axis] } else { bounds.max[axis] };
                let at = |voxel: f64| match axis {
                    0 => geometry.inlines.number_at(voxel),
                    1 => geometry.crosslines.number_at(voxel),
                    _ => geometry.vertical.value_at(voxel),
                };
                let mut number = at(voxel);
                let speed = (at(1.0) - at(0.0)).abs();
                let ends = [at(0.0), at(last[axis])];
                let range = ends[0].min(ends[1])..=ends[0].max(ends[1]);
                let value =
                    DragValue::new(&mut number).speed(speed).range(range).max_decimals(if axis == 2 { 1 } else { 0 });
                let response = ui.name_inputs(format!("{name} {word}"), |ui| ui.add(value));
                if response.changed() {
                    let voxel = match axis {
                        0 => geometry.inlines.index_of(number),
                        1 => geometry.crosslines.index_of(number),
                        _ => geometry.vertical.index_of(number),
                    };
                    let end = if end == 0 { &mut changed.min } else { &mut changed.max };
                    end[axis] = voxel.round().clamp(0.0, last[axis]);
                }
            }
            ui.end_row();
        }
    });
    let is_solid = (DVec3::from_array(changed.max) - DVec3::from_array(changed.min)).min_element() >= 1.0;
    if changed != bounds && is_solid {
        scene.roaming_box = Some(changed);
        scene.cut_outs.retain(|cut| cut.intersection(&changed).is_some());
    }
    ui.horizontal_wrapped(|ui| {
        if ui.button("Cut nearest corner").on_hover_text("Cut out the corner nearest to the viewer (C)").clicked() {
            scene.cut_outs.push(nearest_cut(scene, geometry));
        }
        if ui.button("Stair").on_hover_text("Three steps down towards the viewer").clicked() {
            let block = scene.box_in(geometry);
            let corner: Corner = scene.view(geometry).nearest_corner(&block);
            scene.cut_outs = block.stair(corner, [0.6, 0.6], 0.75, 3);
        }
        if unless(ui, needs(scene.has_cut_outs(), "There are no cut-outs"), Button::new("No cut-outs")).clicked() {
            scene.cut_outs.clear();
            scene.cut_shapes.clear();
        }
        let part = needs(scene.roaming_box.is_some(), "The block is the whole survey");
        if unless(ui, part, Button::new("Whole survey")).clicked() {
            scene.roaming_box = None;
        }
    });
    cut_shapes::show(ui, session, scene);
    let mut handles = session.view.handles;
    if ui.checkbox(&mut handles, "Handles to drag faces (Shift H)").changed() {
        actions.push(Action::Handles(handles));
    }
}

/// The cut-out at the corner that is nearest to the viewer.
pub(crate) fn nearest_cut(scene: &Scene, geometry: &survey::SurveyGeometry) -> VoxelBox {
    let block = scene.box_in(geometry);
    let corner = scene.view(geometry).nearest_corner(&block);
    block.corner_cut(corner, CUT_SHARE)
}
