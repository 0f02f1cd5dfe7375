//! The interpretation over the pictures: horizons, the selected node, faults, sticks and proposals on sections and on the block.
//!
//! Horizons have their own colours, dotted across their holes; the selection is broader and the brighter part of a line is what is selected. Proposed
//! faults are dark red.
//! Spaces: (s, t) of a section; voxels; points of the window.

use super::sections::horizon_colour;
use super::surfaces::{self, Cells};
use super::traces::{self, Line};
use crate::state::picking::voxel_of;
use crate::state::{Panel, Session, SliceKind, camera};
use crate::work::{Interpreted, ShownHorizon, ShownPick};
use eframe::egui::{Color32, Painter, Pos2, Rect, Shape, Stroke, Ui, vec2};
use glam::{DVec2, DVec3};
use interp::holes::Hole;
use interp::reassembly::VoxelSheet;
use std::collections::HashMap;
use std::sync::Arc;
use ttf::Colour;

/// How far from a section sticks are drawn on it, traces or samples.
const NEAR: f64 = 2.5;
/// Opacity before the block: of horizons, of the one that is picked, and of the selection.
const OPACITY: [f32; 3] = [0.22, 0.6, 0.85];

/// What lines on a section were made of: the interpretation, the selection, how many proposals are dismissed and whether minor ones show, and where.
type Made<P> = (u64, usize, (usize, bool), P);

/// What is drawn over the pictures while interpreting. Cheap to clone.
#[derive(Clone, Default)]
pub struct Overlay {
    interpreted: Option<Arc<Interpreted>>,
    selected: Option<Arc<ShownPick>>,
    /// Grows with each selection.
    selection: usize,
    cells: Arc<Vec<(Color32, Vec<Cells>)>>,
    selected_cells: Arc<Vec<Cells>>,
    lines: HashMap<SliceKind, (Made<u64>, Lines)>,
    fence: Option<(Made<Vec<DVec2>>, Lines)>,
}

/// Lines on one section.
#[derive(Clone, Default)]
struct Lines {
    horizons: Vec<(Color32, Vec<Line>)>,
    /// Across the holes of horizons.
    bridges: Vec<(Color32, Vec<Line>)>,
    faults: Vec<Line>,
    proposals: Vec<Line>,
    selected: Vec<Line>,
}

/// How sheets, their holes and meshes meet a section.
struct Cut<'a> {
    sheet: &'a dyn Fn(&VoxelSheet) -> Vec<Line>,
    bridge: &'a dyn Fn(&VoxelSheet, &[Hole]) -> Vec<Line>,
    mesh: &'a dyn Fn(&[[DVec3; 3]]) -> Vec<Line>,
}

impl Lines {
    fn paint(&self, painter: &Painter, session: &Session, to_screen: &impl Fn(DVec2) -> Pos2) {
        let screen = |line: &Line| -> Vec<Pos2> { line.iter().map(|st| to_screen(*st)).collect() };
        let halo = Stroke::new(4.0, Color32::from_white_alpha(150));
        for (colour, lines) in &self.horizons {
            for points in lines.iter().map(screen) {
                painter.add(Shape::line(points.clone(), halo));
                painter.add(Shape::line(points, Stroke::new(2.0, *colour)));
            }
        }
        for (colour, lines) in &self.bridges {
            for points in lines.iter().map(screen) {
                painter.extend(Shape::dotted_line(&points, Color32::from_white_alpha(200), 6.0, 2.6));
                painter.extend(Shape::dotted_line(&points, *colour, 6.0, 1.7));
            }
        }
        for points in self.faults.iter().map(screen) {
            painter.add(Shape::line(points.clone(), halo));
            painter.add(Shape::line(points, Stroke::new(2.2, Color32::BLACK)));
        }
        for points in self.proposals.iter().map(screen) {
            painter.add(Shape::line(points, Stroke::new(1.6, Color32::from_rgb(0xb0, 0x1e, 0x1e))));
        }
        let [r, g, b] = session.view.picking.colour_in(&session.document).rgb;
        for points in self.selected.iter().map(screen) {
            painter.add(Shape::line(points.clone(), Stroke::new(7.0, Color32::from_white_alpha(210))));
            painter.add(Shape::line(points, Stroke::new(4.0, Color32::from_rgb(r, g, b))));
        }
    }
}

impl Overlay {
    /// The interpretation as last read.
    pub fn interpreted(&self) -> Option<&Arc<Interpreted>> {
        self.interpreted.as_ref()
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
        let cells = horizons.map(|(index, horizon)| {
            let cells = horizon.sheets.iter().map(|sheet| Cells::of(sheet, [nx, ny])).collect();
            (horizon_colour(horizon.colour, index), cells)
        });
        self.cells = Arc::new(cells.collect());
        self.interpreted = Some(interpreted);
        if session.view.picking.pick.is_none() {
            self.select(session, None);
        }
    }

    /// Takes the selection in.
    pub fn select(&mut self, session: &Session, selected: Option<Arc<ShownPick>>) {
        let Some(geometry) = &session.document.geometry else { return };
        let [nx, ny, _] = geometry.size();
        let sheets = selected.iter().flat_map(|shown| &shown.sheets);
        self.selected_cells = Arc::new(sheets.map(|sheet| Cells::of(sheet, [nx, ny])).collect());
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
        let made = self.made(session, at.to_bits());
        if self.lines.get(&kind).is_none_or(|(known, _)| *known != made) {
            let size = [geometry.size()[0], geometry.size()[1]];
            let lines = self.lines_on(
                session,
                &Cut {
                    sheet: &|sheet| traces::of_sheet(sheet, size, kind, at),
                    bridge: &|sheet, holes| traces::bridges(sheet, holes, size, kind, at),
                    mesh: &|triangles| traces::of_mesh(triangles, kind, at),
                },
            );
            self.lines.insert(kind, (made, lines));
        }
        let Some((_, lines)) = self.lines.get(&kind) else { return };
        lines.paint(painter, session, to_screen);
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
        &mut self,
        painter: &Painter,
        session: &Session,
        corners: &[DVec2],
        to_screen: &impl Fn(DVec2) -> Pos2,
    ) {
        let Some(geometry) = &session.document.geometry else { return };
        let made = self.made(session, corners.to_vec());
        if self.fence.as_ref().is_none_or(|(known, _)| *known != made) {
            let size = [geometry.size()[0], geometry.size()[1]];
            let lines = self.lines_on(
                session,
                &Cut {
                    sheet: &|sheet| traces::along(sheet, size, corners),
                    bridge: &|sheet, holes| traces::bridges_along(sheet, holes, size, corners),
                    mesh: &|triangles| traces::mesh_along(triangles, corners),
                },
            );
            self.fence = Some((made, lines));
        }
        let Some((_, lines)) = &self.fence else { return };
        lines.paint(painter, session, to_screen);
        for (stick, colour) in sticks(session) {
            let places: Option<Vec<DVec2>> = stick
                .iter()
                .map(|place| {
                    let voxel = voxel_of(geometry, *place);
                    let (s, off) = traces::station_of(corners, voxel.truncate())?;
                    (off <= NEAR).then_some(DVec2::new(s, voxel.z))
                })
                .collect();
            if let Some(places) = places {
                draw_stick(painter, places.into_iter().map(to_screen).collect(), colour);
            }
        }
    }

    fn made<P>(&self, session: &Session, place: P) -> Made<P> {
        let number = self.interpreted.as_ref().map_or(0, |shown| shown.number);
        let picking = &session.view.picking;
        (number, self.selection, (picking.dismissed.len(), picking.minor), place)
    }

    fn lines_on(&self, session: &Session, cut: &Cut) -> Lines {
        let Some(shown) = &self.interpreted else { return Lines::default() };
        let picking = &session.view.picking;
        let coloured = |made: &dyn Fn(&ShownHorizon) -> Vec<Line>| {
            let horizons = shown.horizons.iter().enumerate();
            horizons.map(|(index, horizon)| (horizon_colour(horizon.colour, index), made(horizon))).collect()
        };
        let open = shown.proposals.iter().filter(|(proposal, _)| picking.shows(proposal));
        let selected = self.selected.iter().flat_map(|shown| &shown.sheets);
        Lines {
            horizons: coloured(&|horizon| horizon.sheets.iter().flat_map(cut.sheet).collect()),
            bridges: coloured(&|horizon| {
                horizon.sheets.iter().flat_map(|sheet| (cut.bridge)(sheet, &horizon.holes)).collect()
            }),
            faults: shown.faults.iter().flat_map(|fault| (cut.mesh)(&fault.triangles)).collect(),
            proposals: open.flat_map(|(_, fault)| (cut.mesh)(&fault.triangles)).collect(),
            selected: selected.flat_map(cut.sheet).collect(),
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
        let selected = Color32::from_rgb(r, g, b).gamma_multiply(OPACITY[2]);
        let names = self.interpreted.iter().flat_map(|shown| &shown.horizons).map(|horizon| &horizon.name);
        let horizons = self.cells.iter().zip(names).flat_map(|((colour, cells), name)| {
            let is_picked = session.view.picking.horizon.as_ref() == Some(name);
            let colour = colour.gamma_multiply(OPACITY[usize::from(is_picked)]);
            cells.iter().map(move |cells| (cells, colour))
        });
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
