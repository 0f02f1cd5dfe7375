//! What is being interpreted: the horizon that picks go to, the node that is selected but not accepted yet, sticks being drawn.
//!
//! A click selects a leaf (a [`Pick`] in the making), keys climb and descend, Enter makes it part of the horizon through the same command that
//! `petroglyph pick` gives. What is not accepted yet belongs to the view, so it is written down with it and outlives a crash. Places are line numbers
//! and vertical values, as commands take them; (s, t) and voxels are converted here.

use super::{Place, SliceKind, State, Task};
use crate::command::{Climb, Command, PickFault, PickNode, assembly::next_colour};
use crate::error::Noun;
use crate::project::Document;
use glam::{DVec2, DVec3};
use interp::ExtractSettings;
use interp::assembly::Operation;
use render::{FaceData, Scene};
use serde::{Deserialize, Serialize};
use survey::SurveyGeometry;
use ttf::Colour;

/// Decimals that places are rounded to: a thousandth of a line is far less than a hand can aim at, and can be typed again.
const DECIMALS: f64 = 1000.0;

/// What the pointer does on sections and on the block.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Tool {
    /// Selects candidates.
    #[default]
    Pick,
    /// Erases what it draws around.
    Lasso,
    /// Draws fault sticks.
    Sticks,
}

/// How the block is shown.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Look {
    /// Its faces, with the horizons in front of them as through glass.
    Faces,
    /// Seen through, in the occlusion slicer with a white function (P-horiz 6).
    #[default]
    SeeThrough,
}

/// A node that is selected and not accepted yet.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Pick {
    /// Inline, crossline and vertical value of the place clicked.
    pub at: [f64; 3],
    /// The leaf there.
    pub leaf: u32,
    /// Levels above it.
    pub up: u32,
    /// Levels from the leaf to the root.
    pub levels: u32,
}

/// What is being interpreted.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Picking {
    /// The horizon that picks go to; it may not exist yet.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub horizon: Option<String>,
    /// Colour of a horizon that does not exist yet, if one was chosen.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub colour: Option<Colour>,
    /// The selected node.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pick: Option<Pick>,
    /// The node just accepted, until the project has it.
    #[serde(skip)]
    pub accepted: Option<Pick>,
    /// What the pointer does.
    pub tool: Tool,
    /// How the block is shown.
    pub look: Look,
    /// What faces and sections show.
    pub show: FaceData,
    /// The stick being drawn.
    pub stick: Vec<[f64; 3]>,
    /// Sticks drawn for a fault that was not made yet.
    pub sticks: Vec<Vec<[f64; 3]>>,
    /// Name of that fault.
    pub fault: String,
    /// Proposals that are not to be shown, by number.
    pub dismissed: Vec<u32>,
}

/// How a click changes the selection.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum How {
    /// It becomes the selection; what was selected and not accepted is let go.
    Replace,
    /// What is selected is accepted first.
    Extend,
    /// The leaf is taken out of the horizon.
    Remove,
}

/// A line drawn around what is to be erased.
#[derive(Debug, Clone, PartialEq)]
pub struct Lasso {
    /// What it was drawn on.
    pub on: LassoOn,
    /// Its corners: (s, t) of the section, or points of the picture.
    pub corners: Vec<DVec2>,
}

/// What a lasso was drawn on.
#[derive(Debug, Clone, PartialEq)]
pub enum LassoOn {
    /// A section at a voxel position.
    Section(SliceKind, f64),
    /// A picture of the block, of this size in points.
    Block(Box<Scene>, DVec2),
}

/// Something done while interpreting.
#[derive(Debug, Clone, PartialEq)]
pub enum PickingStep {
    /// A click on rock, voxel.
    At(DVec3, How),
    /// A leaf was found.
    Found(Pick),
    /// Climb so many levels; negative descends.
    Climb(i32),
    /// Climb to the highest node without overlap.
    HighestValid,
    /// Make the selection part of the horizon.
    Accept,
    /// Let go of the selection, or of the stick being drawn.
    GiveUp,
    /// Begin another horizon, under a name of its own.
    Begin,
    /// Picks go to this horizon from now on.
    Choose(String),
    /// The horizon that does not exist yet gets this name.
    Name(String),
    /// The horizon that does not exist yet gets this colour.
    Tint(Colour),
    /// Use another tool.
    Use(Tool),
    /// Show the block otherwise.
    Look(Look),
    /// Show something else on faces and sections.
    Show(FaceData),
    /// Erase what was drawn around.
    Erase(Lasso),
    /// The next place of a stick, voxel.
    Stick(DVec3),
    /// The stick is complete.
    EndStick,
    /// Take the last place of the sticks back.
    Backspace,
    /// Name of the fault being drawn.
    NameFault(String),
    /// Make a fault of the sticks.
    MakeFault,
    /// Do not show a proposal any more.
    Dismiss(u32),
}

/// What the workers are asked while interpreting.
#[derive(Debug, Clone)]
pub enum PickingTask {
    /// The leaf at a place.
    Find([f64; 3]),
    /// The highest node above a pick without overlap, for a horizon.
    HighestValid(Pick, Option<String>),
    /// Take out of a horizon what a lasso holds.
    Erase(Lasso, String),
    /// Extract candidates of a volume.
    Extract(Option<String>, Box<ExtractSettings>),
    /// Look for faults.
    ProposeFaults,
}

/// Line numbers and vertical value of a voxel position.
pub fn place_of(geometry: &SurveyGeometry, voxel: DVec3) -> [f64; 3] {
    let lines = geometry.lines_from_voxel(voxel.truncate());
    let z = geometry.vertical.value_at(voxel.z);
    [lines.x, lines.y, z].map(|value| (value * DECIMALS).round() / DECIMALS)
}

/// Voxel position of line numbers and vertical value.
pub fn voxel_of(geometry: &SurveyGeometry, place: [f64; 3]) -> DVec3 {
    geometry.voxel_from_lines(place[0], place[1]).extend(geometry.vertical.index_of(place[2]))
}

/// A name that nothing of a kind has: "Horizon 1", "Horizon 2", …
pub fn free_name(document: &Document, noun: Noun, word: &str) -> String {
    let names = document.names(noun);
    let mut number = 1;
    loop {
        let name = format!("{word} {number}");
        if !names.iter().any(|known| known.eq_ignore_ascii_case(&name)) {
            return name;
        }
        number += 1;
    }
}

impl Picking {
    /// Lets go of what the project no longer has: a horizon that was renamed or removed.
    pub fn fit(&mut self, before: &Document, now: &Document) {
        let Some(name) = &self.horizon else { return };
        let had = before.horizons.iter().any(|entry| entry.name == *name);
        let has = now.horizons.iter().any(|entry| entry.name == *name);
        if had && !has {
            let place = before.horizons.iter().position(|entry| entry.name == *name);
            let renamed = (before.horizons.len() == now.horizons.len())
                .then(|| now.horizons.get(place?).map(|entry| entry.name.clone()))
                .flatten();
            self.horizon = renamed;
        }
        if has {
            self.colour = None;
        }
    }

    /// The command that accepts the selection.
    pub fn command(&self) -> Option<PickNode> {
        let pick = self.pick.as_ref()?;
        Some(PickNode {
            at: pick.at,
            horizon: self.horizon.clone()?,
            operation: Operation::Add,
            colour: self.colour,
            climb: Climb::Levels(pick.up),
        })
    }

    /// Colour of the horizon that picks go to.
    pub fn colour_in(&self, document: &Document) -> Colour {
        let entry = document.horizons.iter().find(|entry| Some(&entry.name) == self.horizon.as_ref());
        let known = entry.and_then(|entry| entry.assembly.as_ref()).map(|log| log.colour);
        known.or(self.colour).unwrap_or_else(|| next_colour(document))
    }

    fn accept(&mut self) -> Option<Task> {
        let command = self.command()?;
        self.accepted = self.pick.take();
        Some(Task::Apply(Box::new(Command::Pick(command))))
    }

    fn end_stick(&mut self) {
        if self.stick.len() > 1 {
            self.sticks.push(std::mem::take(&mut self.stick));
        }
    }
}

impl State {
    /// Takes a step of the interpretation.
    pub(super) fn pick(&mut self, step: PickingStep) -> Vec<Task> {
        let Some(session) = &mut self.session else { return Vec::new() };
        let Some(geometry) = session.document.geometry.clone() else { return Vec::new() };
        let document = &session.document;
        let picking = &mut session.view.picking;
        let ask = |task| vec![Task::Picking(task)];
        if matches!(step, PickingStep::At(..) | PickingStep::Accept | PickingStep::Erase(_)) {
            self.notices.retain(|notice| notice.place != Place::Interpret);
        }
        match step {
            PickingStep::At(voxel, how) => {
                let at = place_of(&geometry, voxel);
                let mut tasks = Vec::new();
                if how == How::Remove {
                    let Some(horizon) = picking.horizon.clone() else { return tasks };
                    let operation = Operation::Remove;
                    let command = PickNode { at, horizon, operation, colour: None, climb: Climb::Levels(0) };
                    tasks.extend(picking.accept());
                    tasks.push(Task::Apply(Box::new(Command::Pick(command))));
                    return tasks;
                }
                if how == How::Extend {
                    tasks.extend(picking.accept());
                }
                tasks.push(Task::Picking(PickingTask::Find(at)));
                return tasks;
            }
            PickingStep::Found(pick) => {
                if picking.horizon.is_none() {
                    picking.horizon = Some(free_name(document, Noun::Horizon, "Horizon"));
                }
                picking.pick = Some(pick);
            }
            PickingStep::Climb(by) => {
                if let Some(pick) = &mut picking.pick {
                    pick.up = pick.up.saturating_add_signed(by).min(pick.levels);
                }
            }
            PickingStep::HighestValid => {
                if let Some(pick) = &picking.pick {
                    return ask(PickingTask::HighestValid(pick.clone(), picking.horizon.clone()));
                }
            }
            PickingStep::Accept => {
                if picking.tool == Tool::Sticks {
                    picking.end_stick();
                    return Vec::new();
                }
                return picking.accept().into_iter().collect();
            }
            PickingStep::GiveUp => {
                if picking.stick.is_empty() && picking.pick.is_none() {
                    picking.tool = Tool::Pick;
                }
                picking.stick.clear();
                picking.pick = None;
            }
            PickingStep::Begin | PickingStep::Choose(_) => {
                // What is selected belongs to the horizon it was selected for.
                let tasks: Vec<Task> = picking.accept().into_iter().collect();
                let taken = picking.horizon.clone().filter(|_| !tasks.is_empty());
                picking.horizon = Some(match step {
                    PickingStep::Choose(name) => name,
                    _ => {
                        let mut name = free_name(document, Noun::Horizon, "Horizon");
                        if taken.as_ref() == Some(&name) {
                            let number = name.rsplit(' ').next().and_then(|n| n.parse::<u32>().ok()).unwrap_or(0);
                            name = format!("Horizon {}", number + 1);
                        }
                        name
                    }
                });
                picking.colour = None;
                picking.tool = Tool::Pick;
                return tasks;
            }
            PickingStep::Name(name) => picking.horizon = Some(name),
            PickingStep::Tint(colour) => picking.colour = Some(colour),
            PickingStep::Use(tool) => {
                picking.end_stick();
                picking.tool = tool;
                if tool == Tool::Sticks && picking.fault.is_empty() {
                    picking.fault = free_name(document, Noun::Fault, "Fault");
                }
            }
            PickingStep::Look(look) => picking.look = look,
            PickingStep::Show(show) => picking.show = show,
            PickingStep::Erase(lasso) => {
                if let Some(horizon) = picking.horizon.clone() {
                    let mut tasks: Vec<Task> = picking.accept().into_iter().collect();
                    tasks.push(Task::Picking(PickingTask::Erase(lasso, horizon)));
                    return tasks;
                }
            }
            PickingStep::Stick(voxel) => picking.stick.push(place_of(&geometry, voxel)),
            PickingStep::EndStick => picking.end_stick(),
            PickingStep::Backspace => {
                if picking.stick.is_empty() {
                    picking.stick = picking.sticks.pop().unwrap_or_default();
                }
                picking.stick.pop();
            }
            PickingStep::NameFault(name) => picking.fault = name,
            PickingStep::MakeFault => {
                picking.end_stick();
                let sticks = std::mem::take(&mut picking.sticks);
                if sticks.is_empty() {
                    return Vec::new();
                }
                let name = std::mem::take(&mut picking.fault);
                picking.tool = Tool::Pick;
                return vec![Task::Apply(Box::new(Command::PickFault(PickFault { name, sticks })))];
            }
            PickingStep::Dismiss(id) => picking.dismissed.push(id),
        }
        Vec::new()
    }

    /// A command of the interpretation failed: what it was to accept is selected again.
    pub(super) fn reselect(&mut self) {
        let Some(session) = &mut self.session else { return };
        let picking = &mut session.view.picking;
        if let Some(pick) = picking.accepted.take()
            && picking.pick.is_none()
        {
            picking.pick = Some(pick);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::state::tests::open;
    use crate::app::state::{Action, Notice};

    fn picking(state: &State) -> &Picking {
        &state.session.as_ref().unwrap().view.picking
    }

    fn found(state: &mut State) {
        let pick = Pick { at: [3.0, 4.0, 8.0], leaf: 7, up: 0, levels: 3 };
        state.apply(Action::Picking(PickingStep::Found(pick)));
    }

    #[test]
    fn a_click_asks_for_the_leaf_at_its_line_numbers() {
        let mut state = open();
        let tasks = state.apply(Action::Picking(PickingStep::At(DVec3::new(2.0, 3.25, 5.0), How::Replace)));
        let geometry = state.session.as_ref().unwrap().document.geometry.clone().unwrap();
        let Some(Task::Picking(PickingTask::Find(at))) = tasks.first() else { panic!("{tasks:?}") };
        assert!((voxel_of(&geometry, *at) - DVec3::new(2.0, 3.25, 5.0)).length() < 1e-3);
    }

    #[test]
    fn a_selection_climbs_within_its_tree_and_is_accepted_as_a_command() {
        let mut state = open();
        found(&mut state);
        for by in [1, 1, 1, 1, -1] {
            state.apply(Action::Picking(PickingStep::Climb(by)));
        }
        assert_eq!(picking(&state).pick.as_ref().unwrap().up, 2);
        let tasks = state.apply(Action::Picking(PickingStep::Accept));
        let Some(Task::Apply(command)) = tasks.first() else { panic!("{tasks:?}") };
        let Command::Pick(node) = command.as_ref() else { panic!("{command:?}") };
        assert_eq!((node.horizon.as_str(), node.climb, node.at), ("Horizon 1", Climb::Levels(2), [3.0, 4.0, 8.0]));
        assert!(picking(&state).pick.is_none());
    }

    #[test]
    fn what_a_failed_command_was_to_accept_is_selected_again() {
        let mut state = open();
        found(&mut state);
        state.apply(Action::Picking(PickingStep::Accept));
        let failure = Notice { failed: true, ..Notice::note(Place::Interpret, "the disk is full") };
        state.apply(Action::Tell(failure));
        assert_eq!(picking(&state).pick.as_ref().unwrap().leaf, 7);
    }

    #[test]
    fn another_horizon_accepts_what_is_selected_and_has_a_name_of_its_own() {
        let mut state = open();
        found(&mut state);
        let tasks = state.apply(Action::Picking(PickingStep::Begin));
        assert!(matches!(&tasks[..], [Task::Apply(_)]), "{tasks:?}");
        assert_eq!(picking(&state).horizon.as_deref(), Some("Horizon 2"));
    }

    #[test]
    fn sticks_are_drawn_taken_back_and_made_a_fault() {
        let mut state = open();
        let mut step = |step| state.apply(Action::Picking(step));
        step(PickingStep::Use(Tool::Sticks));
        for (x, z) in [(3.0, 2.0), (4.0, 9.0), (5.0, 15.0)] {
            step(PickingStep::Stick(DVec3::new(x, 3.0, z)));
        }
        step(PickingStep::Backspace);
        step(PickingStep::Accept);
        for (x, z) in [(3.5, 2.0), (4.5, 9.0)] {
            step(PickingStep::Stick(DVec3::new(x, 20.0, z)));
        }
        let tasks = step(PickingStep::MakeFault);
        let Some(Task::Apply(command)) = tasks.first() else { panic!("{tasks:?}") };
        let Command::PickFault(fault) = command.as_ref() else { panic!("{command:?}") };
        assert_eq!((fault.name.as_str(), fault.sticks.len(), fault.sticks[0].len()), ("Fault 1", 2, 2));
        assert_eq!(picking(&state).tool, Tool::Pick);
    }

    #[test]
    fn backspace_reaches_into_the_stick_before() {
        let mut state = open();
        let mut step = |step| state.apply(Action::Picking(step));
        for z in [2.0, 9.0] {
            step(PickingStep::Stick(DVec3::new(1.0, 1.0, z)));
        }
        step(PickingStep::EndStick);
        step(PickingStep::Backspace);
        assert_eq!((picking(&state).stick.len(), picking(&state).sticks.len()), (1, 0));
    }
}
