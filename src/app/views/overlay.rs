//! The interpretation over the pictures: horizons, the selected node, faults, sticks and proposals on sections and on the block.
//!
//! Horizons have their own colours, the selection is broader and the brighter part of a line is what is selected. Proposed faults are dark red.
//! Spaces: (s, t) of a section; voxels; points of the window.

use super::sections::horizon_colour;
use super::surfaces::{self, Cells};
use super::traces::{self, Line};
use crate::app::state::picking::voxel_of;
use crate::app::state::{Panel, Session, SliceKind, camera};
use crate::app::work::{Interpreted, ShownPick};
use eframe::egui::{Color32, Painter, Pos2, Rect, Shape, Stroke, Ui, vec2};
use glam::{DVec2, DVec3};
use std::collections::HashMap;
use std::sync::Arc;
use ttf::Colour;

/// How far from a section sticks are drawn on it, traces or samples.
const NEAR: f64 = 2.5;
/// Opacity of horizons before the block, and of the selection.
const OPACITY: [f32; 2] = [0.55, 0.85];

/// What lines on a section were made of.
type Made = (u64, usize, u64);

/// What is drawn over the pictures while interpreting.
#[derive(Default)]
pub struct Overlay {
    interpreted: Option<Arc<Interpreted>>,
    selected: Option<Arc<ShownPick>>,
    /// Grows with each selection.
    selection: usize,
    cells: Vec<(Color32, Vec<Cells>)>,
    selected_cells: Vec<Cells>,
    lines: HashMap<SliceKind, (Made, Lines)>,
}

/// Lines on one section.
#[derive(Default)]
struct Lines {
    horizons: Vec<(Color32, Vec<Line>)>,
    faults: Vec<Line>,
    proposals: Vec<Line>,
    selected: Vec<Line>,
}

impl Overlay {
    /// The interpretation as last read.
    pub fn interpreted(&self) -> Option<&Interpreted> {
        self.interpreted.as_deref()
    }

    /// The selection as last drawn.
    pub fn selected(&self) -> Option<&ShownPick> {
        self.selected.as_deref()
    }

    /// The horizons and the selection by colour and leaves, the selection last.
    pub fn leaves(&self, session: &Session) -> Vec<(Colour, Vec<u32>)> {
        let shown = self.interpreted.iter().flat_map(|shown| &shown.horizons);
        let horizons = shown.filter_map(|horizon| Some((horizon.colour?, horizon.leaves.clone())));
        let own = session.view.picking.colour_in(&session.document);
        horizons.chain(self.selected.iter().map(|shown| (own, shown.leaves.clone()))).collect()
    }

    /// Takes the interpretation in.
    pub fn receive(&mut self, session: &Session, interpreted: Arc<Interpreted>) {
        let Some(geometry) = &session.document.geometry else { return };
        let [nx, ny, _] = geometry.size();
        let horizons = interpreted.horizons.iter().enumerate();
        self.cells = horizons
            .map(|(index, horizon)| {
                let cells = horizon.sheets.iter().map(|sheet| Cells::of(sheet, [nx, ny])).collect();
                (horizon_colour(horizon.colour, index), cells)
            })
            .collect();
        self.interpreted = Some(interpreted);
        if session.view.picking.pick.is_none() {
            self.select(session, None);
        }
    }

    /// Takes the selection in.
    pub fn select(&mut self, session: &Session, selected: Option<Arc<ShownPick>>) {
        let Some(geometry) = &session.document.geometry else { return };
        let [nx, ny, _] = geometry.size();
        self.selected_cells =
            selected.iter().flat_map(|shown| &shown.sheets).map(|sheet| Cells::of(sheet, [nx, ny])).collect();
        self.selected = selected;
        self.selection += 1;
    }

    /// Draws on a section.
    pub fn on_section(
        &mut self,
        painter: &Painter,
        session: &Session,
        kind: SliceKind,
        to_screen: &impl Fn(DVec2) -> Pos2,
    ) {
        if session.view.panel != Panel::Interpret {
            return;
        }
        let Some(geometry) = &session.document.geometry else { return };
        let at = session.view.slices[kind.axis()];
        let made = (self.interpreted.as_ref().map_or(0, |shown| shown.number), self.selection, at.to_bits());
        if self.lines.get(&kind).is_none_or(|(known, _)| *known != made) {
            let lines = self.lines_on(session, kind, at);
            self.lines.insert(kind, (made, lines));
        }
        let Some((_, lines)) = self.lines.get(&kind) else { return };
        let screen = |line: &Line| -> Vec<Pos2> { line.iter().map(|st| to_screen(*st)).collect() };
        let halo = Stroke::new(4.0, Color32::from_white_alpha(150));
        for (colour, lines) in &lines.horizons {
            for points in lines.iter().map(screen) {
                painter.add(Shape::line(points.clone(), halo));
                painter.add(Shape::line(points, Stroke::new(2.0, *colour)));
            }
        }
        for points in lines.faults.iter().map(screen) {
            painter.add(Shape::line(points.clone(), halo));
            painter.add(Shape::line(points, Stroke::new(2.2, Color32::BLACK)));
        }
        for points in lines.proposals.iter().map(screen) {
            painter.add(Shape::line(points, Stroke::new(1.6, Color32::from_rgb(0xb0, 0x1e, 0x1e))));
        }
        let [r, g, b] = session.view.picking.colour_in(&session.document).rgb;
        for points in lines.selected.iter().map(screen) {
            painter.add(Shape::line(points.clone(), Stroke::new(7.0, Color32::from_white_alpha(210))));
            painter.add(Shape::line(points, Stroke::new(4.0, Color32::from_rgb(r, g, b))));
        }
        let flat = |p: DVec3| match kind {
            SliceKind::Inline => DVec2::new(p.y, p.z),
            SliceKind::Crossline => DVec2::new(p.x, p.z),
            SliceKind::Slice => DVec2::new(p.x, p.y),
        };
        for (stick, colour) in sticks(session) {
            let voxels: Vec<DVec3> = stick.iter().map(|place| voxel_of(geometry, *place)).collect();
            if voxels.iter().all(|p| (p[kind.axis()] - at).abs() <= NEAR) {
                draw_stick(painter, voxels.iter().map(|p| to_screen(flat(*p))).collect(), colour);
            }
        }
    }

    /// Draws on a fence: its corners in voxels.
    pub fn on_fence(
        &self,
        painter: &Painter,
        session: &Session,
        corners: &[DVec2],
        to_screen: &impl Fn(DVec2) -> Pos2,
    ) {
        let (Some(shown), Some(geometry)) = (&self.interpreted, &session.document.geometry) else { return };
        let [nx, ny, _] = geometry.size();
        let [r, g, b] = session.view.picking.colour_in(&session.document).rgb;
        let horizons = shown.horizons.iter().enumerate().flat_map(|(index, horizon)| {
            let colour = horizon_colour(horizon.colour, index);
            horizon.sheets.iter().map(move |sheet| (sheet, colour, 2.0))
        });
        let selected = self.selected.iter().flat_map(|shown| &shown.sheets);
        let selected = selected.map(|sheet| (sheet, Color32::from_rgb(r, g, b), 4.0));
        for (sheet, colour, width) in horizons.chain(selected) {
            for line in traces::along(sheet, [nx, ny], corners) {
                let points: Vec<Pos2> = line.iter().map(|st| to_screen(*st)).collect();
                painter.add(Shape::line(points.clone(), Stroke::new(width + 2.0, Color32::from_white_alpha(150))));
                painter.add(Shape::line(points, Stroke::new(width, colour)));
            }
        }
    }

    fn lines_on(&self, session: &Session, kind: SliceKind, at: f64) -> Lines {
        let (Some(shown), Some(geometry)) = (&self.interpreted, &session.document.geometry) else {
            return Lines::default();
        };
        let [nx, ny, _] = geometry.size();
        let dismissed = &session.view.picking.dismissed;
        let horizons = shown.horizons.iter().enumerate();
        Lines {
            horizons: horizons
                .map(|(index, horizon)| {
                    let lines = horizon.sheets.iter().flat_map(|sheet| traces::of_sheet(sheet, [nx, ny], kind, at));
                    (horizon_colour(horizon.colour, index), lines.collect())
                })
                .collect(),
            faults: shown.faults.iter().flat_map(|fault| traces::of_mesh(&fault.triangles, kind, at)).collect(),
            proposals: shown
                .proposals
                .iter()
                .filter(|(proposal, _)| !dismissed.contains(&proposal.id))
                .flat_map(|(_, fault)| traces::of_mesh(&fault.triangles, kind, at))
                .collect(),
            selected: self
                .selected
                .iter()
                .flat_map(|shown| &shown.sheets)
                .flat_map(|sheet| traces::of_sheet(sheet, [nx, ny], kind, at))
                .collect(),
        }
    }

    /// Draws horizons and the selection before the block.
    pub fn surfaces_on_block(&self, ui: &Ui, session: &Session, pane: Rect) {
        if session.view.panel != Panel::Interpret {
            return;
        }
        let Some(geometry) = &session.document.geometry else { return };
        let scene = &session.view.scene;
        let [r, g, b] = session.view.picking.colour_in(&session.document).rgb;
        let selected = Color32::from_rgb(r, g, b).gamma_multiply(OPACITY[1]);
        let horizons =
            self.cells.iter().flat_map(|(colour, cells)| cells.iter().map(|c| (c, colour.gamma_multiply(OPACITY[0]))));
        let picked = self.selected_cells.iter().map(|cells| (cells, selected));
        surfaces::paint(ui, pane, scene, geometry, horizons.chain(picked));
    }

    /// Draws sticks before the block.
    pub fn sticks_on_block(&self, ui: &Ui, session: &Session, pane: Rect) {
        let Some(geometry) = &session.document.geometry else { return };
        if session.view.panel != Panel::Interpret {
            return;
        }
        let scene = &session.view.scene;
        let view = camera::view(scene, geometry, DVec2::new(f64::from(pane.width()), f64::from(pane.height())));
        let painter = ui.painter_at(pane);
        for (stick, colour) in sticks(session) {
            let points = stick.iter().map(|place| {
                let at = view.project(voxel_of(geometry, *place));
                pane.min + vec2(at.x as f32, at.y as f32)
            });
            draw_stick(&painter, points.collect(), colour);
        }
    }
}

/// All sticks there are, with their colours: those of faults, those drawn, the one being drawn.
fn sticks(session: &Session) -> impl Iterator<Item = (&[[f64; 3]], Color32)> {
    let picking = &session.view.picking;
    let made = session.document.sticks.iter().flat_map(|fault| &fault.sticks);
    let made = made.map(|stick| (stick.as_slice(), Color32::BLACK));
    let drawn = picking.sticks.iter().map(|stick| (stick.as_slice(), Color32::from_rgb(0x9c, 0x27, 0x6f)));
    made.chain(drawn).chain(std::iter::once((picking.stick.as_slice(), Color32::from_rgb(0xe0, 0x20, 0x60))))
}

fn draw_stick(painter: &Painter, points: Vec<Pos2>, colour: Color32) {
    for point in &points {
        painter.circle(*point, 3.5, Color32::WHITE, Stroke::new(1.8, colour));
    }
    painter.add(Shape::line(points, Stroke::new(2.0, colour)));
}
