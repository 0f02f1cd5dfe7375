//! The interpretation drawn over the pictures: horizons, the selected node, faults, sticks and proposals, on sections
//! and on the block.
//!
//! Lines on sections are those that figures print ([`figure::draw::overlay`]); they are cut again when something has
//! changed.

use super::surfaces;
use crate::state::picking::voxel_of;
use crate::state::{ChosenFault, Hidden, Look, Panel, Session, StickPoint, Tool, camera};
use crate::widgets::canvas;
use crate::work::{Interpreted, ShownPick, sheet};
use eframe::egui::{Painter, Pos2, Rect, Ui};
use figure::SectionKind;
use figure::draw::overlay::{NamedLines, OverlayLines, SeenOn, stick, suggested};
use figure::draw::surfaces::{Cells, OPACITY, fault_opacity, of_fault};
use figure::interpretation::{DrawnInterpretation, DrawnSelection, Stick};
use figure::style::PROPOSAL;
use files::SurfaceKind;
use glam::DVec2;
use interp::faults::Proposal;
use project::document::FaultEntry;
use project::pictures::figures::InterpreterView;
use render::Faces;
use std::collections::HashMap;
use std::sync::Arc;
use ttf::Colour;

/// The sticks of a fault being drawn, and the stick being drawn.
const STICKS: [Colour; 2] = [Colour::new(0x9c, 0x27, 0x6f), Colour::new(0xe0, 0x20, 0x60)];

/// What the lines on a section depend on: the interpretation, the selection, the number of dismissed proposals, whether
/// minor ones are shown, what is hidden, and the position of the section.
type Made<P> = (u64, usize, (usize, bool, Hidden), P);

/// What is drawn over the pictures while interpreting. Cheap to clone.
#[derive(Clone, Default)]
pub struct Overlay {
    interpreted: Option<Arc<Interpreted>>,
    selected: Option<Arc<ShownPick>>,
    /// Increases with each selection.
    selection: usize,
    cells: Arc<Vec<(Colour, Vec<Cells>)>>,
    fault_cells: Arc<Vec<(Cells, Colour)>>,
    proposal_cells: Arc<Vec<Cells>>,
    selected_cells: Arc<Vec<Cells>>,
    lines: HashMap<SectionKind, (Made<u64>, OverlayLines)>,
    fence: Option<(Made<Vec<DVec2>>, OverlayLines)>,
}

/// How opaque proposed faults are on the block, shares of those of the project.
const PROPOSED: f32 = 0.7;
/// Points of sticks within so many lines of a section can be dragged on it.
const ON_SECTION: f64 = 2.5;
/// Distance within which the pointer catches a point of a stick, points.
const CATCH: f32 = 9.0;

/// The part of an interpretation that only this view knows, for figures, which read the rest from the project.
pub(crate) fn interpreter_view(session: &Session, selected: Option<&ShownPick>) -> InterpreterView {
    let picking = &session.view.picking;
    InterpreterView {
        picked: picking.horizon.clone(),
        minor: picking.minor,
        dismissed: picking.dismissed.clone(),
        sticks: own_sticks(session).map(|(stick, colour)| (stick.clone(), colour)).collect(),
        selection: selected.map(|shown| (shown.sheets.clone(), picking.colour_in(&session.document))),
    }
}

/// Sticks that are not part of the project yet.
fn own_sticks(session: &Session) -> impl Iterator<Item = (&Vec<[f64; 3]>, Colour)> {
    let picking = &session.view.picking;
    let drawn = picking.sticks.iter().map(|stick| (stick, STICKS[0]));
    drawn.chain(std::iter::once((&picking.stick, STICKS[1]))).filter(|(stick, _)| !stick.is_empty())
}

/// The point of a stick that is within reach of a place of a section: `page` leads from (s, t) to the window.
pub(crate) fn stick_point(
    session: &Session,
    kind: SectionKind,
    at: Pos2,
    page: impl Fn(DVec2) -> Pos2,
) -> Option<StickPoint> {
    let geometry = session.document.geometry.as_ref()?;
    let picking = &session.view.picking;
    let section = session.view.slices[kind.axis()];
    let own = picking.sticks.iter().chain(std::iter::once(&picking.stick)).enumerate();
    let made = session.document.sticks.iter().flat_map(|fault| {
        fault.sticks.iter().enumerate().map(move |(index, stick)| (Some(fault.fault.clone()), index, stick))
    });
    let all = own.map(|(index, stick)| (None, index, stick)).chain(made);
    let points = all.flat_map(|(fault, stick, places)| {
        places.iter().enumerate().map(move |(point, place)| (fault.clone(), stick, point, *place))
    });
    let off = |place: [f64; 3]| {
        let voxel = voxel_of(geometry, place);
        let is_near = (voxel[kind.axis()] - section).abs() <= ON_SECTION;
        is_near.then(|| page(kind.flat(voxel)).distance(at)).filter(|off| *off <= CATCH)
    };
    let near =
        points.filter_map(|(fault, stick, point, place)| Some((off(place)?, StickPoint { fault, stick, point })));
    near.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, point)| point)
}

/// All sticks with their colours: those of faults, those drawn, and the one being drawn.
fn sticks(session: &Session) -> Vec<Stick> {
    let Some(geometry) = &session.document.geometry else { return Vec::new() };
    let made = session.document.sticks.iter().flat_map(|fault| {
        let entry = session.document.faults.iter().find(|entry| entry.name == fault.fault);
        let colour = entry.map_or(Colour::BLACK, FaultEntry::ink);
        fault.sticks.iter().map(move |stick| (stick, colour))
    });
    let places = |stick: &Vec<[f64; 3]>| stick.iter().map(|place| voxel_of(geometry, *place)).collect();
    let line = &session.view.picking.line;
    let line = (!line.is_empty()).then(|| (line, session.view.picking.colour_in(&session.document)));
    made.chain(own_sticks(session)).chain(line).map(|(stick, colour)| Stick { places: places(stick), colour }).collect()
}

impl Overlay {
    /// The interpretation as last read.
    pub fn interpreted(&self) -> Option<&Arc<Interpreted>> {
        self.interpreted.as_ref()
    }

    /// The selection as drawn last.
    pub(crate) fn selected(&self) -> Option<&ShownPick> {
        self.selected.as_deref()
    }

    /// The horizons and the selection as colours and leaves, the selection last.
    pub fn leaves(&self, session: &Session) -> Vec<(Colour, Vec<u32>)> {
        let shown = self.interpreted.iter().flat_map(|shown| &shown.horizons);
        let horizons = shown.filter_map(|horizon| Some((horizon.colour?, horizon.leaves.clone())));
        let own = session.view.picking.colour_in(&session.document);
        horizons.chain(self.selected.iter().map(|shown| (own, shown.leaves.clone()))).collect()
    }

    /// Takes over an interpretation that was read.
    pub fn receive(&mut self, session: &Session, interpreted: Arc<Interpreted>) {
        let Some(geometry) = &session.document.geometry else { return };
        let [nx, ny, _] = geometry.size();
        let horizons = interpreted.horizons.iter().enumerate();
        let cells = horizons.map(|(index, horizon)| {
            let cells = horizon.sheets.iter().map(|own| Cells::of(&sheet(own), [nx, ny])).collect();
            (figure::style::horizon_colour(horizon.colour, index), cells)
        });
        self.cells = Arc::new(cells.collect());
        let faults = interpreted.faults.iter().map(|fault| of_fault(&fault.mesh(), geometry.size()));
        self.fault_cells = Arc::new(faults.collect());
        let proposals = interpreted.proposals.iter();
        let proposals = proposals.map(|(_, fault)| of_fault(&fault.mesh(), geometry.size()).0);
        self.proposal_cells = Arc::new(proposals.collect());
        self.interpreted = Some(interpreted);
        if session.view.picking.pick.is_none() {
            self.select(session, None);
        }
    }

    /// Takes over a selection.
    pub fn select(&mut self, session: &Session, selected: Option<Arc<ShownPick>>) {
        let Some(geometry) = &session.document.geometry else { return };
        let [nx, ny, _] = geometry.size();
        let sheets = selected.iter().flat_map(|shown| &shown.sheets);
        self.selected_cells = Arc::new(sheets.map(|own| Cells::of(&sheet(own), [nx, ny])).collect());
        self.selected = selected;
        self.selection += 1;
    }

    /// Draws on a section; `page` converts (s, t) to the page.
    pub(crate) fn on_section(
        &mut self,
        painter: &Painter,
        session: &Session,
        kind: SectionKind,
        page: impl Fn(DVec2) -> DVec2,
    ) {
        let at = session.view.slices[kind.axis()];
        let made = self.made(session, at.to_bits());
        let on = SeenOn::Section(kind, at);
        if self.lines.get(&kind).is_none_or(|(known, _)| *known != made) {
            let Some(lines) = self.cut(session, on) else { return };
            self.lines.insert(kind, (made, lines));
        }
        let Some((_, lines)) = self.lines.get(&kind) else { return };
        draw(painter, session, lines, on, &page);
        for chosen in &session.view.picking.faults {
            if let Some(lines) = self.lines_of(kind, chosen) {
                canvas::paint(painter, &lines.chosen(&page), None);
            }
        }
    }

    /// The lines of a fault on a section as drawn last.
    fn lines_of(&self, kind: SectionKind, chosen: &ChosenFault) -> Option<&NamedLines> {
        let (_, lines) = self.lines.get(&kind)?;
        match chosen {
            ChosenFault::Present(name) => lines.faults.iter().find(|fault| fault.name == *name),
            ChosenFault::Proposed(id, _) => {
                let proposals = &self.interpreted.as_ref()?.proposals;
                let (proposal, _) = proposals.iter().find(|(proposal, _)| proposal.id == *id)?;
                lines.proposals.iter().find(|fault| fault.name == proposal.name)
            }
        }
    }

    /// The fault within reach of a place of a section, and what is known of a proposed one.
    pub(crate) fn fault_at(
        &self,
        kind: SectionKind,
        at: Pos2,
        page: impl Fn(DVec2) -> DVec2,
    ) -> Option<(ChosenFault, Option<&Proposal>)> {
        let (_, lines) = self.lines.get(&kind)?;
        let place = canvas::page(at);
        let off = |lines: &NamedLines| Some(lines.distance(place, &page)).filter(|off| *off <= f64::from(CATCH));
        let present =
            lines.faults.iter().filter_map(|fault| Some((off(fault)?, ChosenFault::Present(fault.name.clone()), None)));
        let known = &self.interpreted.as_ref()?.proposals;
        let proposed = lines.proposals.iter().filter_map(|fault| {
            let (proposal, _) = known.iter().find(|(proposal, _)| proposal.name == fault.name)?;
            Some((off(fault)?, ChosenFault::Proposed(proposal.id, proposal.name.clone()), Some(proposal)))
        });
        let nearest = present.chain(proposed).min_by(|a, b| a.0.total_cmp(&b.0))?;
        Some((nearest.1, nearest.2))
    }

    /// The line of a fault on a section, as something that is chosen.
    pub(crate) fn mark(
        &self,
        painter: &Painter,
        kind: SectionKind,
        fault: &ChosenFault,
        page: impl Fn(DVec2) -> DVec2,
    ) {
        if let Some(lines) = self.lines_of(kind, fault) {
            canvas::paint(painter, &lines.chosen(page), None);
        }
    }

    /// Draws on a fence with these corners, voxels.
    pub(crate) fn on_fence(
        &mut self,
        painter: &Painter,
        session: &Session,
        corners: &[DVec2],
        page: impl Fn(DVec2) -> DVec2,
    ) {
        let made = self.made(session, corners.to_vec());
        let on = SeenOn::Fence(corners);
        if self.fence.as_ref().is_none_or(|(known, _)| *known != made) {
            let Some(lines) = self.cut(session, on) else { return };
            self.fence = Some((made, lines));
        }
        let Some((_, lines)) = &self.fence else { return };
        draw(painter, session, lines, on, &page);
    }

    fn made<P>(&self, session: &Session, place: P) -> Made<P> {
        let number = self.interpreted.as_ref().map_or(0, |shown| shown.number);
        let picking = &session.view.picking;
        (number, self.selection, (picking.dismissed.len(), picking.minor, session.view.hidden.clone()), place)
    }

    /// The lines in which everything intersects a section.
    fn cut(&self, session: &Session, on: SeenOn) -> Option<OverlayLines> {
        let [nx, ny, _] = session.document.geometry.as_ref()?.size();
        let shown = self.interpreted.as_ref()?;
        let picking = &session.view.picking;
        let selection = self.selected.as_ref().map(|shown| DrawnSelection {
            sheets: shown.sheets.iter().map(sheet).collect(),
            colour: picking.colour_in(&session.document),
        });
        let mut seen = shown.seen(|proposal| picking.shows(proposal));
        let hidden = &session.view.hidden;
        seen.horizons.retain(|horizon| !hidden.has(SurfaceKind::Horizon, horizon.name));
        seen.faults.retain(|fault| !hidden.has(SurfaceKind::Fault, fault.name));
        Some(OverlayLines::new(&DrawnInterpretation { selection, ..seen }, [nx, ny], on))
    }

    /// Draws the faults in front of the block, with the horizons and the selection where the picture has none.
    pub(crate) fn surfaces_on_block(&self, ui: &Ui, session: &Session, pane: Rect, has_horizons: bool) {
        if session.view.panel != Panel::Interpret {
            return;
        }
        let Some(geometry) = &session.document.geometry else { return };
        let picking = &session.view.picking;
        let names = self.interpreted.iter().flat_map(|shown| &shown.horizons).map(|horizon| &horizon.name);
        let shown = |name: &&String| !session.view.hidden.has(SurfaceKind::Horizon, name);
        let horizons = self.cells.iter().zip(names).filter(|(_, name)| shown(name));
        let horizons = horizons.flat_map(|((colour, cells), name)| {
            let opacity = OPACITY[usize::from(picking.horizon.as_ref() == Some(name))];
            cells.iter().map(move |cells| (cells, *colour, opacity))
        });
        let names = self.interpreted.iter().flat_map(|shown| &shown.faults).map(|fault| &fault.name);
        let faults = self.fault_cells.iter().zip(names);
        let faults = faults.filter(|(_, name)| !session.view.hidden.has(SurfaceKind::Fault, name));
        let is_clear = picking.look == Look::VolumeRendering;
        let opacity = fault_opacity(if is_clear { Faces::None } else { Faces::All });
        let faults = faults.map(|((cells, colour), _)| (cells, *colour, opacity));
        let proposals = self.interpreted.iter().flat_map(|shown| &shown.proposals);
        let proposals = self.proposal_cells.iter().zip(proposals).filter(|(_, (proposal, _))| picking.shows(proposal));
        let faults = faults.chain(proposals.map(|(cells, _)| (cells, PROPOSAL, PROPOSED * opacity)));
        let own = picking.colour_in(&session.document);
        let picked = self.selected_cells.iter().map(|cells| (cells, own, OPACITY[2]));
        let missing = horizons.chain(picked).filter(|_| !has_horizons);
        surfaces::paint(ui, pane, &session.view.scene, geometry, faults.chain(missing));
    }

    /// Draws the sticks in front of the block.
    pub(crate) fn sticks_on_block(&self, ui: &Ui, session: &Session, pane: Rect) {
        let Some(geometry) = &session.document.geometry else { return };
        if session.view.panel != Panel::Interpret {
            return;
        }
        let size = DVec2::new(f64::from(pane.width()), f64::from(pane.height()));
        let view = camera::view(&session.view.scene, geometry, size);
        let painter = ui.painter_at(pane);
        for Stick { places, colour } in sticks(session) {
            let places = places.iter().map(|voxel| canvas::page(pane.min) + view.project(*voxel) / canvas::SCALE);
            canvas::paint(&painter, &stick(places.collect(), colour), None);
        }
    }
}

/// The lines and sticks on a section.
fn draw(painter: &Painter, session: &Session, lines: &OverlayLines, on: SeenOn, page: &impl Fn(DVec2) -> DVec2) {
    lines.drawn(page).iter().for_each(|group| canvas::paint(painter, group, None));
    let own = DrawnInterpretation { sticks: sticks(session), ..DrawnInterpretation::default() };
    let near = figure::draw::overlay::sticks(&own, on, page);
    near.iter().for_each(|group| canvas::paint(painter, group, None));
    if session.view.picking.tool == Tool::Sticks {
        let beside = figure::draw::overlay::ghosts(&own, on, page);
        beside.iter().for_each(|group| canvas::paint(painter, group, None));
        let suggestion = session.view.picking.suggestion(&session.document, session.view.slices);
        if let (Some(suggestion), SeenOn::Section(kind, _)) = (suggestion, on)
            && kind.axis() == suggestion.axis
        {
            let places = suggestion.points.iter().map(|voxel| page(kind.flat(*voxel)));
            canvas::paint(painter, &suggested(places.collect(), STICKS[1]), None);
        }
    }
}
