//! The page of an open project: the toolbar, the panels at the sides, and the views in the middle.

use super::Window;
use crate::state::{Action, Panel as Side, Place, Session};
use crate::views::parts::{LayoutPane, parts};
use crate::views::{bar, notices, overlay::Overlay};
use crate::work::map::MapData;
use crate::work::{Rocks, RunningLine};
use eframe::egui::{self, CentralPanel, Frame, Panel, Ui};

impl Window {
    pub(super) fn work_page(&mut self, ui: &mut Ui, running: &[RunningLine], actions: &mut Vec<Action>) {
        let Some(session) = &self.state.session else { return };
        Panel::top("bar").exact_size(44.0).show(ui, |ui| {
            ui.add_space(7.0);
            bar::show(ui, &self.state, session, actions);
        });
        Panel::left("side")
            .default_size(316.0)
            .min_size(240.0)
            .show(ui, |ui| within(ui, |ui| self.side(ui, running, actions)));
        let Some(session) = &self.state.session else { return };
        Panel::right("controls").default_size(300.0).min_size(240.0).show(ui, |ui| {
            within(ui, |ui| self.views.controls.show(ui, &self.state, session, actions));
        });
        let frame = Frame::new().fill(ui.visuals().panel_fill);
        CentralPanel::no_frame().frame(frame).show(ui, |ui| {
            notices::show(ui, &self.state, Place::Block, actions);
            if !session.is_drawable() {
                Frame::new().inner_margin(40.0).show(ui, |ui| {
                    ui.heading("Nothing to draw yet");
                    ui.label("Add a volume or horizons: Project, at the top left.");
                });
                return;
            }
            let rocks = self.views.rocks.as_ref();
            let whole = ui.available_rect_before_wrap();
            self.views.pointed = None;
            for (part, rect) in parts(session.view.layout, whole) {
                let found = ui.scope_builder(egui::UiBuilder::new().max_rect(rect), |ui| match part {
                    LayoutPane::Block => {
                        self.views.block.show(ui, session, rocks, &self.work.drawing, &self.views.overlay, actions)
                    }
                    LayoutPane::Section(kind) => {
                        let (slices, overlay) = (&self.work.slices, &mut self.views.overlay);
                        self.views.sections.show(ui, session, kind, rocks, slices, overlay, actions)
                    }
                    LayoutPane::Map => {
                        let source = map_source(session, rocks, &self.views.overlay);
                        self.views.map.show(ui, session, source, &self.work.maps, actions);
                        None
                    }
                    LayoutPane::Fence => {
                        self.views.fence.show(ui, session, rocks, &self.work.slices, &mut self.views.overlay, actions)
                    }
                });
                self.views.pointed = self.views.pointed.take().or(found.inner);
            }
            ui.advance_cursor_after_rect(whole);
        });
    }

    /// The left side: tabs, and the panel that is chosen.
    fn side(&mut self, ui: &mut Ui, running: &[RunningLine], actions: &mut Vec<Action>) {
        let Some(session) = &self.state.session else { return };
        ui.add_space(6.0);
        ui.horizontal(|ui| {
            // All tabs in one row: one that reached beyond the panel would push what lies at its right edge out of sight.
            (ui.spacing_mut().item_spacing.x, ui.spacing_mut().button_padding.x) = (4.0, 6.0);
            for (side, name, hint) in [
                (Side::Layers, "Layers", "The stratigraphic column (L)"),
                (Side::Data, "Data", "Volumes, horizons, faults and wells (D)"),
                (Side::Values, "Volume display", "Colours of raw data, textures by value, volume rendering (V)"),
                (Side::Interpret, "Interpret", "Candidates, picks and faults (P)"),
            ] {
                if ui.selectable_label(session.view.panel == side, name).on_hover_text(hint).clicked() {
                    actions.push(Action::Panel(side));
                }
            }
        });
        ui.separator();
        match session.view.panel {
            Side::Layers => {
                let rocks = self.views.rocks.as_ref();
                self.views.layers.show(
                    ui,
                    &self.state,
                    session,
                    (&self.swatches, rocks),
                    &mut self.views.tiles,
                    actions,
                );
            }
            Side::Data => self.views.data.show(ui, &self.state, session, actions),
            Side::Interpret => {
                self.views.picking.show(ui, &self.state, session, &self.views.overlay, running, actions);
            }
            Side::Values => {
                notices::show(ui, &self.state, Place::Data, actions);
                let rocks = self.views.rocks.as_ref();
                egui::ScrollArea::vertical().show(ui, |ui| {
                    self.views.functions.show(ui, session, rocks, &self.swatches, actions);
                });
            }
        }
    }
}

/// Shows a panel in the room there is. A panel whose content asked for more would widen, and the views in the middle
/// would be drawn again.
fn within(ui: &mut Ui, add: impl FnOnce(&mut Ui)) {
    let rect = ui.available_rect_before_wrap();
    add(&mut ui.new_child(egui::UiBuilder::new().max_rect(rect)));
    ui.advance_cursor_after_rect(rect);
}

/// What the map is made from: while interpreting there is no model.
fn map_source(session: &Session, rocks: Option<&Rocks>, overlay: &Overlay) -> Option<(MapData, u64)> {
    if session.view.panel != Side::Interpret {
        return rocks.map(|rocks| (MapData::Rocks(rocks.clone()), rocks.key));
    }
    let (shown, geometry) = (overlay.interpreted()?, session.document.geometry.as_ref()?);
    Some((MapData::Interpreted(shown.clone(), Box::new(geometry.clone())), shown.number))
}
