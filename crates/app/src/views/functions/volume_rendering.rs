//! Volume rendering: a volume in the cut-outs or in the whole block with its RGBA function and shading, and horizons in
//! it that may give off light (P-illus 5.1, P-horiz 5).

use crate::state::volume_rendering::{self, Extent, Light};
use crate::state::{Action, Notice, Place, Session};
use crate::views::controls;
use crate::views::sections::entry_colour;
use crate::widgets::colour_well;
use crate::widgets::form::{self, LABELS};
use crate::widgets::histogram::Histogram;
use crate::widgets::opacity_curve::OpacityCurve;
use crate::widgets::percent;
use eframe::egui::{ComboBox, DragValue, Grid, Slider, TextWrapMode, Ui};
use render::media::{LayerOpacity, MediumColour};
use render::{PickedHorizon, Scene, Scope, Shading};
use ttf::Colour;

/// The volume that is rendered, or that would be.
pub(super) fn volume(session: &Session) -> Option<String> {
    let media = &session.view.scene.media;
    let first = || session.document.volumes.first().map(|entry| entry.name.clone());
    media.all().next().map(|medium| medium.volume.clone()).or_else(first)
}

/// Shows where and how the scene renders a volume.
pub(super) fn show(
    ui: &mut Ui,
    session: &Session,
    histogram: Option<&Histogram>,
    curve: &mut OpacityCurve,
    actions: &mut Vec<Action>,
) {
    let mut next = session.view.scene.clone();
    ui.heading("Volume rendering");
    if let Some(volume) = volume(session) {
        place(ui, session, &volume, &mut next, actions);
        if let Some(medium) = volume_rendering::medium(&mut next) {
            curve.show(ui, histogram, &mut medium.function);
            let mut follows = medium.layers == LayerOpacity::Followed;
            let hint = "A layer is left standing where its opacity is above 0 (Layers, In cut-outs); the others stay transparent";
            if ui.checkbox(&mut follows, "Only in layers left standing").on_hover_text(hint).changed() {
                medium.layers = if follows { LayerOpacity::Followed } else { LayerOpacity::Ignored };
            }
            let mut is_rock = medium.colour == MediumColour::Layers;
            if ui.checkbox(&mut is_rock, "In the layers' colours").changed() {
                medium.colour = if is_rock { MediumColour::Layers } else { MediumColour::Function };
            }
        }
    }
    horizons(ui, session, &mut next);
    if !next.media.is_empty() {
        light(ui, &mut next);
    }
    if next != session.view.scene {
        actions.push(Action::Show(Box::new(next)));
    }
}

/// Where a volume is rendered, and which one.
fn place(ui: &mut Ui, session: &Session, volume: &str, next: &mut Scene, actions: &mut Vec<Action>) {
    let present = volume_rendering::extent(next);
    let (mut extent, mut name) = (present, volume.to_owned());
    ui.horizontal_wrapped(|ui| {
        for (choice, label, hint) in [
            (Extent::Nowhere, "Nothing", "No volume rendering: rock everywhere"),
            (Extent::CutOuts, "Cut-outs", "A volume in the cut-outs, in front of the rock behind them"),
            (Extent::Block, "Whole block", "A volume in place of the rock"),
        ] {
            ui.selectable_value(&mut extent, choice, label).on_hover_text(hint);
        }
    });
    if present != Extent::Nowhere {
        ui.horizontal(|ui| {
            let label = form::label(ui, "Rendered");
            ui.label_inputs_by(label.id, |ui| {
                ComboBox::from_id_salt("medium").selected_text(&name).truncate().show_ui(ui, |ui| {
                    for entry in &session.document.volumes {
                        ui.selectable_value(&mut name, entry.name.clone(), &entry.name);
                    }
                });
            });
        });
    }
    if (extent, name.as_str()) == (present, volume) {
        return;
    }
    if let Err(error) = volume_rendering::set_volume(next, &session.document, extent, &name) {
        actions.push(Action::Tell(Notice::failure(Place::Data, &error)));
    }
    if let (Extent::CutOuts, false, Some(geometry)) = (extent, next.has_cut_outs(), &session.document.geometry) {
        next.cut_outs.push(controls::nearest_cut(next, geometry));
    }
}

/// The horizons in the volume, each with its colour and light.
fn horizons(ui: &mut Ui, session: &Session, next: &mut Scene) {
    let entries = &session.document.horizons;
    if entries.is_empty() {
        return;
    }
    ui.label("Horizons in the volume");
    for (index, entry) in entries.iter().enumerate() {
        let is_this = |horizon: &PickedHorizon| horizon.name.as_deref() == Some(entry.name.as_str());
        let mut is_shown = next.media.horizons.iter().any(is_this);
        let shown = ui.scope(|ui| {
            ui.style_mut().wrap_mode = Some(TextWrapMode::Truncate);
            ui.checkbox(&mut is_shown, &entry.name).on_hover_text(&entry.name)
        });
        if shown.inner.changed() {
            let [r, g, b, _] = entry_colour(entry, index).to_array();
            volume_rendering::show_horizon(next, &entry.name, Colour::new(r, g, b), is_shown);
        }
        if let Some(horizon) = next.media.horizons.iter_mut().find(|horizon| is_this(horizon)) {
            ui.indent(&entry.name, |ui| numbers(ui, &entry.name, horizon));
        }
    }
    if !next.media.horizons.is_empty() {
        ui.horizontal_wrapped(|ui| {
            ui.label("Show the volume");
            for (scope, name) in [
                (Scope::Everywhere, "everywhere"),
                (Scope::NearHorizons, "near horizons"),
                (Scope::AwayFromHorizons, "away from horizons"),
            ] {
                ui.selectable_value(&mut next.media.scope, scope, name);
            }
            if next.media.scope != Scope::Everywhere {
                let drag = DragValue::new(&mut next.media.reach).range(0.5..=10.0).speed(0.1).suffix(" voxels");
                ui.name_inputs("Reach of horizons", |ui| ui.add(drag));
            }
        });
    }
}

fn numbers(ui: &mut Ui, name: &str, horizon: &mut PickedHorizon) {
    ui.horizontal_wrapped(|ui| {
        colour_well(ui, &format!("Light of {name}"), &mut horizon.colour.rgb);
        ui.weak("opacity");
        let opacity = percent::drag(&mut horizon.opacity);
        ui.name_inputs(format!("{name}: opacity"), |ui| ui.add(opacity))
            .on_hover_text("For each voxel of its thickness");
        for (word, value, range, hint) in [
            ("thickness", &mut horizon.thickness, 0.2..=9.0, "Voxels on either side"),
            (
                "glow",
                &mut horizon.emission,
                0.0..=20.0,
                "Light that it gives off and that falls on its surroundings; at 1 it is as bright as when it is lit",
            ),
        ] {
            ui.weak(word);
            let drag = DragValue::new(value).range(range).speed(0.02).max_decimals(2);
            ui.name_inputs(format!("{name}: {word}"), |ui| ui.add(drag)).on_hover_text(hint);
        }
    });
}

fn light(ui: &mut Ui, next: &mut Scene) {
    let present = Light::of(next);
    let mut chosen = present;
    ui.horizontal(|ui| {
        let label = form::label(ui, "Light");
        ui.label_inputs_by(label.id, |ui| {
            let names = [
                (Light::None, "none"),
                (Light::Gradients, "gradients"),
                (Light::Occlusion, "occlusion"),
                (Light::Stripes, "both, in stripes"),
            ];
            let shown = names.iter().find(|(light, _)| *light == present).map_or("", |(_, name)| name);
            ComboBox::from_id_salt("light").selected_text(shown).show_ui(ui, |ui| {
                for (light, name) in names {
                    ui.selectable_value(&mut chosen, light, name);
                }
            });
        });
    });
    if chosen != present {
        next.media.shading = chosen.shading();
    }
    Grid::new("light terms").num_columns(2).min_col_width(LABELS).show(ui, |ui| {
        let mut row = |name: &str, value: &mut f32, range| {
            form::row(ui, name, |ui| ui.add(Slider::new(value, range).max_decimals(2)));
        };
        match &mut next.media.shading {
            Shading::Unshaded | Shading::Interleaved(_) => {}
            Shading::Phong(phong) => {
                row("Ambient", &mut phong.ambient, 0.0..=1.0);
                row("Diffuse", &mut phong.diffuse, 0.0..=1.5);
                row("Highlights", &mut phong.specular, 0.0..=1.0);
            }
            Shading::Occlusion(occlusion) => {
                row("Shadows", &mut occlusion.strength, 0.0..=4.0);
                row("Spread", &mut occlusion.spread, 0.1..=4.0);
            }
        }
    });
}
