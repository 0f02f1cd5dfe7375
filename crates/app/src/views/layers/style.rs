//! The style of a layer: colours, repeats, beds, patterns by depth.

use crate::state::{Action, Dialogue};
use crate::widgets::percent;
use eframe::egui::{ComboBox, DragValue, Ui};
use param::KDefinition;
use project::command::{Command, SetLayer};
use project::document::Document;
use ttf::{Colour, DepthInterval, Frequency, LayerStyle};

/// Repeats that a layer starts with when it gets its own.
const FREQUENCY: Frequency = Frequency { horizontal: 40.0, vertical: 3.0 };

/// The colour under the pattern, and that of the pattern's lines.
pub(super) fn colours(ui: &mut Ui, style: &mut LayerStyle) {
    let label = ui.label("Colour");
    ui.horizontal(|ui| {
        ui.color_edit_button_srgb(&mut style.colour.rgb).labelled_by(label.id);
        let mut has_ink = style.ink.is_some();
        let label = ui.checkbox(&mut has_ink, "Ink").on_hover_text("Draw the lines of the pattern in this colour");
        if label.changed() {
            style.ink = has_ink.then_some(Colour::BLACK);
        }
        if let Some(ink) = &mut style.ink {
            ui.color_edit_button_srgb(&mut ink.rgb).labelled_by(label.id);
        }
    });
    ui.end_row();
}

/// Repeats of the tile.
pub(super) fn frequencies(ui: &mut Ui, style: &mut LayerStyle) {
    ui.label("Repeats");
    ui.horizontal(|ui| {
        let mut has_own = style.frequency.is_some();
        let hint =
            "Repeats of the tile along the block and through the layer; otherwise the tile keeps its printed size";
        if ui.checkbox(&mut has_own, "Own").on_hover_text(hint).changed() {
            style.frequency = has_own.then_some(FREQUENCY);
        }
        if let Some(frequency) = &mut style.frequency {
            let drag = |value| DragValue::new(value).speed(0.2).range(0.05..=2000.0).max_decimals(2);
            ui.name_inputs("Repeats along", |ui| ui.add(drag(&mut frequency.horizontal)));
            ui.label("×");
            ui.name_inputs("Repeats through", |ui| ui.add(drag(&mut frequency.vertical)));
            ui.weak("tiles");
        }
    });
    ui.end_row();
}

/// How beds run between the horizons.
pub(super) fn definition(ui: &mut Ui, document: &Document, layer: &str, actions: &mut Vec<Action>) {
    let definitions = [
        (KDefinition::Flow, "flow between both horizons"),
        (KDefinition::Harmonic, "harmonic flow"),
        (KDefinition::DistanceRatio, "by distance from both"),
        (KDefinition::Proportional, "in proportion of height"),
        (KDefinition::ParallelToBottom, "parallel to the base"),
        (KDefinition::ParallelToTop, "parallel to the top"),
    ];
    let index_from_bottom = document.layers().iter().rev().position(|name| name == layer).unwrap_or(0);
    let present = document.k_definitions().get(index_from_bottom).copied().unwrap_or_default();
    let name_of = |wanted: KDefinition| definitions.iter().find(|(k, _)| *k == wanted).map_or("", |(_, name)| *name);
    ui.label("Beds");
    let mut chosen = present;
    ui.name_inputs("Beds", |ui| {
        ComboBox::from_id_salt("beds").selected_text(name_of(present)).width(160.0).truncate().show_ui(ui, |ui| {
            for (k, name) in definitions {
                ui.selectable_value(&mut chosen, k, name);
            }
        });
    });
    ui.end_row();
    if chosen != present {
        let command = SetLayer { layer: layer.to_owned(), k: Some(chosen), ..SetLayer::default() };
        actions.push(Action::Apply(Box::new(Command::SetLayer(command))));
    }
}

/// The patterns by depth, top first, each with its lower limit.
pub(super) fn intervals(ui: &mut Ui, layer: &str, style: &mut LayerStyle, actions: &mut Vec<Action>) {
    let browse =
        |interval: Option<usize>| Action::Ask(Box::new(Dialogue::Patterns { layer: layer.to_owned(), interval }));
    if style.intervals.is_empty() {
        if ui.button("Choose a pattern…").clicked() {
            actions.push(browse(None));
        }
        return;
    }
    let mut split = None;
    let mut join = None;
    for index in (0..style.intervals.len()).rev() {
        let count = style.intervals.len();
        let ordinal = index + 1;
        ui.horizontal_wrapped(|ui| {
            let name = style.intervals[index].texture.clone();
            let button = ui.button(format!("{name}…")).on_hover_text("Choose another pattern");
            if button.clicked() {
                actions.push(browse((count > 1).then_some(index)));
            }
            ui.weak("opacity");
            let opacity = percent::drag(&mut style.intervals[index].opacity);
            ui.name_inputs(format!("Opacity of pattern {ordinal}"), |ui| ui.add(opacity))
                .on_hover_text("Opacity of the pattern");
            if ui.button("Split").on_hover_text("Split this part of the layer in two").clicked() {
                split = Some(index);
            }
            if count > 1 && ui.button("Remove").clicked() {
                join = Some(index);
            }
        });
        if index > 0 {
            let low = style.intervals[index - 1].k[0] + 0.01;
            let high = style.intervals[index].k[1] - 0.01;
            let mut k = style.intervals[index].k[0];
            let slider = percent::slider_within(&mut k, low..=high);
            let is_moved = ui.horizontal(|ui| {
                let slider = ui.name_inputs(format!("Base of pattern {ordinal}"), |ui| ui.add(slider));
                ui.label("from the base");
                slider.changed()
            });
            if is_moved.inner {
                style.intervals[index].k[0] = k;
                style.intervals[index - 1].k[1] = k;
            }
        }
    }
    if let Some(index) = split {
        let DepthInterval { k: [low, high], .. } = style.intervals[index];
        let middle = 0.5 * (low + high);
        let upper = DepthInterval { k: [middle, high], ..style.intervals[index].clone() };
        style.intervals[index].k = [low, middle];
        style.intervals.insert(index + 1, upper);
    }
    if let Some(index) = join {
        let gone = style.intervals.remove(index);
        match index {
            0 => style.intervals[0].k[0] = gone.k[0],
            _ => style.intervals[index - 1].k[1] = gone.k[1],
        }
    }
}
