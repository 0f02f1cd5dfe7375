//! All keyboard shortcuts: one table that is both obeyed and shown.

use super::lasso;
use crate::state::faces::{self, Face, Owner};
use crate::state::{
    Action, Choice, Compare, Dialogue, ExportForm, FaultStep, Layout, Look, Panel, PickingStep, Session, StandardView,
    State, Tool, camera,
};
use crate::widgets::dialogue;
use crate::widgets::keyboard::{Listener, is_entered};
use eframe::egui::{Context, Grid, Key, Modifiers, ScrollArea};
use glam::DVec2;
use interp::holes::FillSettings;
use page::FileFormat;
use project::command::{Command, FillHorizon};
use render::{FaceData, Scene};

/// What a key does to an open project.
type Deed = fn(&Session) -> Option<Action>;

/// A key and its action.
pub(crate) struct Shortcut {
    /// The key.
    pub key: Key,
    /// The modifier keys.
    pub modifiers: Modifiers,
    /// How the key is written in the list.
    pub shown: &'static str,
    /// What it does.
    pub name: &'static str,
    deed: Deed,
}

const fn plain(key: Key, shown: &'static str, name: &'static str, deed: Deed) -> Shortcut {
    Shortcut { key, modifiers: Modifiers::NONE, shown, name, deed }
}

const fn shifted(key: Key, shown: &'static str, name: &'static str, deed: Deed) -> Shortcut {
    Shortcut { key, modifiers: Modifiers::SHIFT, shown, name, deed }
}

const fn command(key: Key, shown: &'static str, name: &'static str, deed: Deed) -> Shortcut {
    Shortcut { key, modifiers: Modifiers::COMMAND, shown, name, deed }
}

/// Degrees that an arrow key turns the block.
const TURN_POINTS: f64 = 30.0;
/// Factor that a key zooms by.
const ZOOM: f64 = 1.2;
/// Samples that a key moves a face of the block.
const SIDE: f64 = 4.0;
/// A picture size for use where only the aspect ratio matters.
const ANY_SIZE: DVec2 = DVec2::new(900.0, 650.0);

/// The shortcuts that work everywhere.
pub(crate) const SHORTCUTS: &[Shortcut] = &[
    Shortcut {
        key: Key::Z,
        modifiers: Modifiers::COMMAND.plus(Modifiers::SHIFT),
        shown: "Ctrl Shift Z",
        name: "Redo",
        deed: |_| Some(Action::Redo),
    },
    Shortcut {
        key: Key::C,
        modifiers: Modifiers::COMMAND.plus(Modifiers::SHIFT),
        shown: "Ctrl Shift C",
        name: "Copy the picture",
        deed: |_| Some(Action::Copy),
    },
    command(Key::Z, "Ctrl Z", "Undo", |_| Some(Action::Undo)),
    command(Key::O, "Ctrl O", "Open a project", |_| ask(Dialogue::Choose(Choice::Project))),
    command(Key::N, "Ctrl N", "New project from SEG-Y", |_| ask(Dialogue::Choose(Choice::NewSurvey))),
    command(Key::I, "Ctrl I", "Add a horizon", |_| ask(Dialogue::Choose(Choice::Horizon))),
    command(Key::E, "Ctrl E", "Export the picture", |session| {
        ask(Dialogue::Export(ExportForm::new(
            session.root.with_extension(FileFormat::usual().ending()).display().to_string(),
        )))
    }),
    command(Key::W, "Ctrl W", "Close the project", |_| Some(Action::Close)),
    plain(Key::F5, "F5", "Present the scenes", |session| {
        super::present::obstacle(session).is_none().then_some(Action::Present(Some(0)))
    }),
    plain(Key::Num1, "1", "Block alone", |_| Some(Action::Arrange(Layout::Block))),
    plain(Key::Num2, "2", "Block and sections", |_| Some(Action::Arrange(Layout::Sections))),
    plain(Key::Num3, "3", "Map", |_| Some(Action::Arrange(Layout::Map))),
    plain(Key::Num4, "4", "Fence", |_| Some(Action::Arrange(Layout::Fence))),
    plain(Key::L, "L", "Layers", |_| Some(Action::Panel(Panel::Layers))),
    plain(Key::D, "D", "Data", |_| Some(Action::Panel(Panel::Data))),
    plain(Key::P, "P", "Interpret, or back to the layers", |session| {
        let is_interpreting = session.view.panel == Panel::Interpret;
        Some(Action::Panel(if is_interpreting { Panel::Layers } else { Panel::Interpret }))
    }),
    plain(Key::V, "V", "Volume display", |_| Some(Action::Panel(Panel::Values))),
    plain(Key::B, "B", "Blend", |_| Some(Action::Compare(Compare::Blend))),
    plain(Key::S, "S", "Side by side", |_| Some(Action::Compare(Compare::SideBySide))),
    plain(Key::W, "W", "Wipe", |_| Some(Action::Compare(Compare::Wipe))),
    plain(Key::R, "R", "Raw or illustrated", |session| {
        let blend = if session.view.scene.blend < 0.5 { 1.0 } else { 0.0 };
        show(Scene { blend, ..session.view.scene.clone() })
    }),
    plain(Key::Home, "Home", "Block view", |_| Some(Action::Stand(StandardView::Block))),
    plain(Key::T, "T", "From above", |_| Some(Action::Stand(StandardView::Top))),
    plain(Key::ArrowLeft, "Left", "Turn left", |session| turn(session, DVec2::new(-TURN_POINTS, 0.0))),
    plain(Key::ArrowRight, "Right", "Turn right", |session| turn(session, DVec2::new(TURN_POINTS, 0.0))),
    plain(Key::PageUp, "Page up", "Look from higher", |session| turn(session, DVec2::new(0.0, TURN_POINTS))),
    plain(Key::PageDown, "Page down", "Look from lower", |session| turn(session, DVec2::new(0.0, -TURN_POINTS))),
    plain(Key::Plus, "+", "Zoom in", |session| zoom(session, ZOOM)),
    plain(Key::Equals, "=", "Zoom in", |session| zoom(session, ZOOM)),
    plain(Key::Minus, "-", "Zoom out", |session| zoom(session, 1.0 / ZOOM)),
    plain(Key::C, "C", "Cut the nearest corner, or remove the cut-outs", |session| {
        let geometry = session.document.geometry.as_ref()?;
        let mut scene = session.view.scene.clone();
        if scene.has_cut_outs() {
            scene.cut_outs.clear();
            scene.cut_shapes.clear();
        } else {
            scene.cut_outs = vec![super::controls::nearest_cut(&scene, geometry)];
        }
        show(scene)
    }),
    shifted(Key::I, "Shift I", "Inline face outwards", |session| side(session, 0, -SIDE)),
    plain(Key::I, "I", "Inline face inwards", |session| side(session, 0, SIDE)),
    shifted(Key::X, "Shift X", "Crossline face outwards", |session| side(session, 1, -SIDE)),
    plain(Key::X, "X", "Crossline face inwards", |session| side(session, 1, SIDE)),
    shifted(Key::Z, "Shift Z", "Top up", |session| side(session, 2, -SIDE)),
    plain(Key::Z, "Z", "Top down", |session| side(session, 2, SIDE)),
    shifted(Key::H, "Shift H", "Handles", |session| Some(Action::Handles(!session.view.handles))),
    plain(Key::J, "J", "Previous inline", |session| step(session, 0, -1.0)),
    plain(Key::K, "K", "Next inline", |session| step(session, 0, 1.0)),
    shifted(Key::J, "Shift J", "Previous crossline", |session| step(session, 1, -1.0)),
    shifted(Key::K, "Shift K", "Next crossline", |session| step(session, 1, 1.0)),
    plain(Key::Comma, ",", "Slice above", |session| step(session, 2, -1.0)),
    plain(Key::Period, ".", "Slice below", |session| step(session, 2, 1.0)),
];

/// The shortcuts that work only while interpreting.
pub(crate) const INTERPRETING: &[Shortcut] = &[
    plain(Key::ArrowUp, "Up", "Climb", |_| picking(PickingStep::Climb(1))),
    plain(Key::ArrowDown, "Down", "Descend", |_| picking(PickingStep::Climb(-1))),
    plain(Key::H, "H", "Highest valid", |_| picking(PickingStep::HighestValid)),
    plain(
        Key::Enter,
        "Enter",
        "Add to the horizon; end a stick or a line, or take the dashed stick; accept faults",
        |_| picking(PickingStep::Accept),
    ),
    plain(Key::Escape, "Escape", "Deselect, or drop the stick or the line", |_| picking(PickingStep::GiveUp)),
    plain(Key::Backspace, "Backspace", "Remove the last point of a stick or a line", |session| {
        matches!(session.view.picking.tool, Tool::Sticks | Tool::Draw)
            .then_some(Action::Picking(PickingStep::Backspace))
    }),
    plain(Key::N, "N", "New horizon", |_| picking(PickingStep::Begin)),
    plain(Key::F, "F", "Draw fault sticks, or pick again", |session| turn_to(session, Tool::Sticks)),
    shifted(Key::F, "Shift F", "Choose faults, or pick again", |session| turn_to(session, Tool::Faults)),
    plain(Key::Delete, "Delete", "Dismiss or remove the faults that are chosen", |session| {
        (session.view.picking.tool == Tool::Faults).then_some(Action::Picking(PickingStep::Fault(FaultStep::Drop)))
    }),
    shifted(Key::M, "Shift M", "Merge the faults that are chosen", |session| {
        (session.view.picking.faults.len() > 1).then_some(Action::Picking(PickingStep::Fault(FaultStep::Merge)))
    }),
    plain(Key::M, "M", "Draw lines of a horizon by hand, or pick again", |session| turn_to(session, Tool::Draw)),
    plain(Key::U, "U", "Track reflections from a click, or pick again", |session| turn_to(session, Tool::Track)),
    plain(Key::O, "O", "Volume rendering, or the faces of the block", |session| {
        let is_clear = session.view.picking.look == Look::VolumeRendering;
        picking(PickingStep::Look(if is_clear { Look::Faces } else { Look::VolumeRendering }))
    }),
    plain(Key::G, "G", "Amplitudes, candidate pieces, distances in turn", |session| {
        picking(PickingStep::Show(match session.view.picking.show {
            FaceData::Rock => FaceData::Leaves,
            FaceData::Leaves => FaceData::Distance,
            FaceData::Distance | FaceData::Distortion => FaceData::Rock,
        }))
    }),
    plain(Key::E, "E", "Extract candidates", |session| {
        let can = session.document.volumes.iter().any(|entry| entry.geometry.is_none());
        can.then(|| Action::Extract(None, Box::default()))
    }),
    plain(Key::Y, "Y", "Fill the holes of the horizon", |session| {
        let name = session.view.picking.horizon.clone()?;
        session.document.horizons.iter().find(|entry| entry.name == name)?;
        let command = FillHorizon { name, settings: FillSettings::default() };
        Some(Action::Apply(Box::new(Command::FillHorizon(command))))
    }),
    plain(Key::Q, "Q", "Propose faults", |_| Some(Action::ProposeFaults)),
    // The key is held while dragging; pressing it does nothing by itself.
    plain(lasso::HELD, "A and drag", "Erase with the lasso", |_| None),
];

/// Takes a tool, or puts it away where it is in hand.
fn turn_to(session: &Session, tool: Tool) -> Option<Action> {
    picking(PickingStep::Use(if session.view.picking.tool == tool { Tool::Pick } else { tool }))
}

fn picking(step: PickingStep) -> Option<Action> {
    Some(Action::Picking(step))
}

fn ask(dialogue: Dialogue) -> Option<Action> {
    Some(Action::Ask(Box::new(dialogue)))
}

fn show(scene: Scene) -> Option<Action> {
    Some(Action::Show(Box::new(scene)))
}

fn turn(session: &Session, delta: DVec2) -> Option<Action> {
    let mut scene = session.view.scene.clone();
    camera::orbit(&mut scene, session.document.geometry.as_ref()?, ANY_SIZE, delta);
    show(scene)
}

fn zoom(session: &Session, factor: f64) -> Option<Action> {
    let mut scene = session.view.scene.clone();
    camera::zoom_at(&mut scene, ANY_SIZE, ANY_SIZE * 0.5, factor);
    show(scene)
}

fn step(session: &Session, axis: usize, by: f64) -> Option<Action> {
    let mut slices = session.view.slices;
    slices[axis] += by;
    Some(Action::Slices(slices))
}

/// Moves the face of the block that faces the viewer inwards by this many samples.
fn side(session: &Session, axis: usize, inwards: f64) -> Option<Action> {
    let geometry = session.document.geometry.as_ref()?;
    let scene = &session.view.scene;
    let block = scene.box_in(geometry);
    let towards = camera::view(scene, geometry, ANY_SIZE).towards_camera(block.centre())[axis];
    // Seen from below, the base faces the viewer.
    let at_max = towards > 0.0;
    let face = Face { owner: Owner::Block, axis, at_max };
    show(faces::move_face(scene, geometry, ANY_SIZE, face, if at_max { -inwards } else { inwards }))
}

/// Obeys the keys that were pressed, unless a text field, an open list or a dialogue takes them.
pub(crate) fn obey(ctx: &Context, state: &State, listener: &Listener, actions: &mut Vec<Action>) {
    if state.dialogue.is_some() || state.presented.is_some() || listener.is_typing(ctx) {
        return;
    }
    let asked = ctx.input_mut(|input| {
        input.events.iter().any(|event| matches!(event, eframe::egui::Event::Text(text) if text == "?"))
    });
    if asked {
        actions.push(Action::Ask(Box::new(Dialogue::Shortcuts)));
    }
    let Some(session) = &state.session else { return };
    let first = if session.view.panel == Panel::Interpret { INTERPRETING } else { &[] };
    // Those with Shift come first, because a key alone is taken with Shift, too.
    let all = || first.iter().chain(SHORTCUTS);
    let (with, without) = (all().filter(|shortcut| shortcut.modifiers.any()), all().filter(|s| s.modifiers.is_none()));
    for shortcut in with.chain(without) {
        if ctx.input_mut(|input| input.consume_key(shortcut.modifiers, shortcut.key)) {
            actions.extend((shortcut.deed)(session));
        }
    }
}

/// Shows the table: two columns for everywhere, one for interpreting.
pub(crate) fn dialogue(ctx: &Context, actions: &mut Vec<Action>) {
    let room = ctx.content_rect().size();
    let modal = dialogue::show(ctx, "shortcuts", |ui| {
        ui.set_width((room.x - 100.0).min(1060.0));
        ui.heading("Shortcuts");
        ui.add_space(4.0);
        // These rows are not clicked, so they are only as high as their text.
        ui.spacing_mut().interact_size.y = 0.0;
        ScrollArea::vertical().max_height(room.y - 190.0).show(ui, |ui| {
            ui.columns_const(|columns: &mut [eframe::egui::Ui; 3]| {
                let (first, second) = SHORTCUTS.split_at(SHORTCUTS.len().div_ceil(2));
                let parts = [("Everywhere", first), ("", second), ("While interpreting (P)", INTERPRETING)];
                for (column, (title, part)) in columns.iter_mut().zip(parts) {
                    column.strong(title);
                    Grid::new(("shortcuts", part[0].shown)).num_columns(2).spacing([16.0, 5.0]).show(column, |ui| {
                        for shortcut in part {
                            ui.strong(shortcut.shown);
                            ui.label(shortcut.name);
                            ui.end_row();
                        }
                    });
                }
            });
        });
        ui.add_space(6.0);
        ui.weak("In the block: drag turns it, Shift drag moves it, the wheel zooms, a click moves the sections there.");
        if ui.button("Close").clicked() || is_entered(ui) {
            actions.push(Action::Answered);
        }
    });
    if modal.should_close() {
        actions.push(Action::Answered);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_key_has_one_meaning() {
        let all: Vec<&Shortcut> = SHORTCUTS.iter().chain(INTERPRETING).collect();
        for (index, shortcut) in all.iter().enumerate() {
            for other in &all[..index] {
                let is_other = shortcut.key != other.key || shortcut.modifiers != other.modifiers;
                assert!(is_other, "{} and {}", shortcut.name, other.name);
            }
        }
    }
}
