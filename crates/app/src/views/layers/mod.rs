//! The stratigraphic column, youngest layer on top, and the style of the chosen layer.
//!
//! A change in progress is a draft: the picture follows it at once, and when the user releases the pointer it becomes
//! one command, so that dragging a slider is one step of the history.

mod legibility;
mod style;

use super::notices;
use super::sections::entry_colour;
use super::tiles::Tiles;
use crate::state::{Action, Choice, Dialogue, Panel, Place, Session, State};
use crate::widgets::form::{self, LABELS};
use crate::widgets::obstacle::{needs, unless};
use crate::widgets::percent;
use crate::work::{Rocks, Swatches};
use eframe::egui::{
    Align, Button, ComboBox, Frame, Grid, Key, Label, Layout, Response, RichText, Role, ScrollArea, Sense, Stroke,
    TextEdit, Ui, WidgetInfo, vec2,
};
use legibility::Legibility;
use project::command::{Command, ResetLayer, SetContact, SetLayer};
use project::document::Document;
use project::document::HorizonEntry;
use project::pictures::PickedShare;
use render::Unpicked;
use style::{colours, definition, frequencies, intervals};
use survey::Contact;
use ttf::{Colour, LayerStyle, LayerTtf, TextureLibrary};

/// Size of a layer's swatch in the column, points.
const SWATCH: [f32; 2] = [64.0, 40.0];

/// The panel, with the change in progress.
#[derive(Default)]
pub struct Layers {
    draft: Option<(String, LayerStyle)>,
    sent: Option<LayerStyle>,
    name: Option<(String, String)>,
    library: Option<TextureLibrary>,
    /// The layer whose style was shown last.
    editing: Option<String>,
    legibility: Legibility,
    /// How much of each horizon was picked, as far as it is known.
    picked: Vec<PickedShare>,
}

impl Layers {
    /// The draft of a style.
    pub(crate) fn draft(&self) -> Option<&LayerStyle> {
        self.draft.as_ref().map(|(_, style)| style)
    }

    /// Applies the draft to a copy of the project's state.
    pub(crate) fn draft_of(&self, document: &mut Document) {
        if let Some((layer, style)) = &self.draft
            && document.layers().contains(layer)
        {
            document.style.layers.set(style.clone());
        }
    }

    /// Shows the panel.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        state: &State,
        session: &Session,
        (swatches, rocks): (&Swatches, Option<&Rocks>),
        tiles: &mut Tiles,
        actions: &mut Vec<Action>,
    ) {
        notices::show(ui, state, Place::Layers, actions);
        if self.sent.is_some() && state.notices_at(Place::Layers).any(|(_, notice)| notice.failed) {
            (self.draft, self.sent) = (None, None);
        }
        let document = &session.document;
        if document.horizons.is_empty() {
            ui.label("Layers lie between horizons. Pick some in the volume, or add them from files.");
            ui.horizontal_wrapped(|ui| {
                let volume = needs(!document.volumes.is_empty(), "Horizons are picked in a volume: add one first");
                if unless(ui, volume, Button::new("Pick horizons")).clicked() {
                    actions.push(Action::Panel(Panel::Interpret));
                }
                let survey = needs(document.geometry.is_some(), crate::views::data::NO_SURVEY);
                if unless(ui, survey, Button::new("Add a horizon…")).clicked() {
                    actions.push(Action::Ask(Box::new(Dialogue::Choose(Choice::Horizon))));
                }
            });
            return;
        }
        if let Some(loaded) = rocks {
            self.picked.clone_from(&loaded.picked);
        }
        ScrollArea::vertical().show(ui, |ui| {
            let layers = document.layers();
            for (index, name) in layers.iter().enumerate() {
                let style = self.style_of(document, index, name);
                row(ui, session, name, &style, swatches, tiles, actions);
                if let Some(horizon) = document.horizons.get(index) {
                    let picked = self.picked.iter().find(|known| known.name == horizon.name);
                    boundary(ui, (index, picked), horizon, actions);
                }
            }
            unpicked(ui, session, actions);
            self.legibility.show(ui, session, rocks, actions);
            let chosen = session.view.layer.as_ref().and_then(|name| layers.iter().position(|layer| layer == name));
            if let Some(index) = chosen {
                ui.add_space(8.0);
                ui.separator();
                let editor = ui.scope(|ui| self.editor(ui, session, index, &layers[index], actions)).response;
                // Scroll so that the style of a layer that was just chosen is visible.
                if self.editing != session.view.layer {
                    ui.scroll_to_rect(editor.rect, None);
                }
            }
            self.editing.clone_from(&session.view.layer);
        });
    }

    /// The style shown: the draft, the project's, or the default.
    fn style_of(&mut self, document: &Document, index: usize, name: &str) -> LayerStyle {
        if let Some((layer, draft)) = &self.draft
            && layer == name
        {
            return draft.clone();
        }
        if let Some(style) = document.style.layers.style(name) {
            return style.clone();
        }
        if self.library.is_none() {
            self.library = TextureLibrary::builtin().ok();
        }
        let from_bottom = document.horizons.len() - index;
        match &self.library {
            Some(library) => LayerTtf::default_style(name, from_bottom, library),
            None => LayerStyle::plain(name, Colour::WHITE),
        }
    }

    fn editor(&mut self, ui: &mut Ui, session: &Session, index: usize, layer: &str, actions: &mut Vec<Action>) {
        let document = &session.document;
        let present = self.style_of(document, index, layer);
        let mut style = present.clone();
        self.rename(ui, layer, actions);
        Grid::new("style").num_columns(2).min_col_width(LABELS).show(ui, |ui| {
            colours(ui, &mut style);
            frequencies(ui, &mut style);
            let label = ui.label("In cut-outs").on_hover_text(
                "Opacity where the block is cut away: 0 % removes the layer, 100 % leaves it standing in the cut-out",
            );
            ui.add(percent::slider(&mut style.opacity)).labelled_by(label.id);
            ui.end_row();
            definition(ui, document, layer, actions);
        });
        ui.add_space(4.0);
        intervals(ui, layer, &mut style, actions);
        ui.horizontal(|ui| {
            let is_own = document.style.layers.style(layer).is_some() || document.k.contains_key(layer);
            if unless(ui, needs(is_own, "The layer has its default style"), Button::new("Default style")).clicked() {
                self.draft = None;
                let command = ResetLayer { layer: layer.to_owned() };
                actions.push(Action::Apply(Box::new(Command::ResetLayer(command))));
            }
        });
        if style != present {
            self.draft = Some((layer.to_owned(), style));
        }
        self.settle(ui, document, actions);
    }

    /// Makes the draft a command once the user has released the pointer; drops it when the project contains it.
    fn settle(&mut self, ui: &Ui, document: &Document, actions: &mut Vec<Action>) {
        let Some((layer, draft)) = &self.draft else { return };
        if document.style.layers.style(layer) == Some(draft) || !document.layers().contains(layer) {
            (self.draft, self.sent) = (None, None);
            return;
        }
        let is_held = ui.input(|input| input.pointer.any_down()) || ui.ctx().egui_wants_keyboard_input();
        let is_picking = eframe::egui::Popup::is_any_open(ui.ctx());
        if is_held || is_picking {
            return;
        }
        if self.sent.as_ref() == Some(draft) {
            // The draft is shown until the project contains it, and the command is sent once.
            return;
        }
        let command = SetLayer { layer: layer.clone(), style: Some(draft.clone()), ..SetLayer::default() };
        actions.push(Action::Apply(Box::new(Command::SetLayer(command))));
        self.sent = Some(draft.clone());
    }

    fn rename(&mut self, ui: &mut Ui, layer: &str, actions: &mut Vec<Action>) {
        let (_, mut text) =
            self.name.take().filter(|(of, _)| of == layer).unwrap_or((layer.to_owned(), layer.to_owned()));
        ui.horizontal(|ui| {
            let label = form::label(ui, "Name");
            let edit = ui.add(TextEdit::singleline(&mut text).desired_width(170.0)).labelled_by(label.id);
            let name = text.trim().to_owned();
            let is_meant = edit.lost_focus() && !ui.input(|input| input.key_pressed(Key::Escape));
            if is_meant && !name.is_empty() && name != layer {
                let command = SetLayer { layer: layer.to_owned(), name: Some(name.clone()), ..SetLayer::default() };
                actions.push(Action::Apply(Box::new(Command::SetLayer(command))));
                actions.push(Action::Layer(Some(name)));
            } else if edit.has_focus() {
                self.name = Some((layer.to_owned(), text));
            }
        });
    }
}

/// Whether horizons are dashed on the block where they were not picked.
fn unpicked(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    let mut scene = session.view.scene.clone();
    let mut is_dashed = scene.outlines.unpicked == Unpicked::Dashed;
    let hint = "Horizons are dashed on the block where they were filled or extrapolated";
    if ui.checkbox(&mut is_dashed, "Dashed where not picked").on_hover_text(hint).changed() {
        scene.outlines.unpicked = if is_dashed { Unpicked::Dashed } else { Unpicked::Solid };
        actions.push(Action::Show(Box::new(scene)));
    }
}

fn row(
    ui: &mut Ui,
    session: &Session,
    name: &str,
    style: &LayerStyle,
    swatches: &Swatches,
    tiles: &mut Tiles,
    actions: &mut Vec<Action>,
) {
    let is_chosen = session.view.layer.as_deref() == Some(name);
    let fill = if is_chosen { ui.visuals().selection.bg_fill } else { ui.visuals().panel_fill };
    let response: Response = Frame::new()
        .fill(fill)
        .corner_radius(6.0)
        .inner_margin(4.0)
        .show(ui, |ui| {
            ui.horizontal(|ui| {
                ui.set_width(ui.available_width());
                let (rect, _) = ui.allocate_exact_size(vec2(SWATCH[0], SWATCH[1]), Sense::hover());
                tiles.paint(ui, swatches, style, rect);
                ui.vertical(|ui| {
                    ui.add(Label::new(RichText::new(name).strong()).truncate().selectable(false));
                    let patterns: Vec<&str> =
                        style.intervals.iter().map(|interval| interval.texture.as_str()).collect();
                    ui.weak(if patterns.is_empty() { "plain".to_owned() } else { patterns.join(", ") });
                });
            });
        })
        .response;
    let response = ui.interact(response.rect, ui.scope_id().with(("layer", name)), Sense::click());
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, is_chosen, format!("Layer {name}")));
    // A name too long for the panel is read whole here.
    if response.on_hover_text(name).clicked() {
        actions.push(Action::Layer((!is_chosen).then(|| name.to_owned())));
    }
}

/// Share from which a horizon counts as picked everywhere.
const WHOLE: f64 = 0.995;

/// The horizon between two layers, how much of it was picked where that is not all, and its contact.
fn boundary(
    ui: &mut Ui,
    (index, picked): (usize, Option<&PickedShare>),
    horizon: &HorizonEntry,
    actions: &mut Vec<Action>,
) {
    let (name, contact) = (horizon.name.as_str(), horizon.contact);
    ui.horizontal(|ui| {
        let (rect, _) = ui.allocate_exact_size(vec2(SWATCH[0] + 8.0, 16.0), Sense::hover());
        ui.painter().hline(rect.x_range(), rect.center().y, Stroke::new(2.5, entry_colour(horizon, index)));
        let mut chosen = contact;
        // From the right, so that contacts stand in a column whatever the names are.
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let combo = ComboBox::from_id_salt(("contact", name)).selected_text(contact_name(contact)).width(96.0);
            ui.name_inputs(format!("Contact of {name}"), |ui| {
                combo.truncate().show_ui(ui, |ui| {
                    for contact in Contact::ALL {
                        ui.selectable_value(&mut chosen, contact, contact_name(contact));
                    }
                });
            });
            ui.with_layout(Layout::top_down(Align::Min), |ui| {
                ui.spacing_mut().item_spacing.y = 1.0;
                let partly = picked.filter(|picked| picked.share < WHOLE);
                if partly.is_none() {
                    // In the middle of its row.
                    ui.add_space(5.0);
                }
                ui.add(Label::new(RichText::new(name).small()).truncate());
                if let Some(picked) = partly {
                    let said = RichText::new(format!("{} picked", picked.percent())).small().weak();
                    ui.label(said).on_hover_text(picked.sentence());
                }
            });
        });
        if chosen != contact {
            let command = SetContact { horizon: name.to_owned(), contact: chosen };
            actions.push(Action::Apply(Box::new(Command::SetContact(command))));
        }
    });
}

/// A contact's name.
pub(crate) fn contact_name(contact: Contact) -> &'static str {
    if contact == Contact::Truncated { "intrusive, cut by erosion" } else { contact.word() }
}
