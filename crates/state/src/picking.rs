//! The interpretation under way: the horizon that picks go to, the node that is selected but not accepted yet, the sticks
//! being drawn, and the faults that are chosen.
//!
//! A click selects a leaf (a [`Pick`] in the making), keys climb and descend its tree, and Enter adds it to the horizon
//! through the same command as `petroglyph pick`. What is not accepted yet belongs to the view; it is saved with the
//! view and so survives a crash. Places are line numbers and vertical values, as commands take them; (s, t) of sections
//! and voxels are converted here.

use super::{SectionKind, Task};
use crate::suggested;
use glam::{DVec2, DVec3};
use interp::ExtractSettings;
use interp::assembly::Operation;
use interp::faults::Proposal;
use interp::refine::TrackSettings;
use project::command::{Climb, Command, CutAlong, DrawHorizon, PickNode};
use project::document::{Document, Drawn, HorizonEntry};
use project::error::Noun;
use render::{FaceData, Scene};
use serde::{Deserialize, Serialize};
use survey::SurveyGeometry;
use ttf::Colour;

/// Decimals that places are rounded to: a thousandth of a line is far finer than anyone can aim, and can still be
/// typed.
const DECIMALS: f64 = 1000.0;

/// What the pointer does on sections and on the block.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Tool {
    /// Selects candidates.
    #[default]
    Pick,
    /// Erases the leaves that a lasso encloses.
    Lasso,
    /// Draws fault sticks.
    Sticks,
    /// Makes a horizon of the level of geologic time through a place, or corrects one that was made so.
    Time,
    /// Draws a line of a horizon, point by point or freehand.
    Draw,
    /// Tracks the reflection from a place.
    Track,
    /// Chooses faults, proposed ones and those of the project.
    Faults,
}

/// How the block is shown.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Look {
    /// Its faces, with the horizons in front of them, semi-transparent.
    Faces,
    /// Volume rendering with occlusion and a white RGBA function (P-horiz 6).
    #[default]
    #[serde(alias = "see-through")]
    VolumeRendering,
}

/// A node that is selected and not accepted yet.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Pick {
    /// Inline, crossline and vertical value of the place that was clicked.
    pub at: [f64; 3],
    /// The leaf there.
    pub leaf: u32,
    /// Levels above the leaf.
    pub up: u32,
    /// Levels from the leaf to the root.
    pub levels: u32,
}

/// A step with whole faults.
#[derive(Debug, Clone, PartialEq)]
pub enum FaultStep {
    /// Choose one: alone, or with those that are chosen; one that is chosen with others is left out.
    Choose(ChosenFault, bool),
    /// Take the proposed ones that are chosen into the project.
    Accept,
    /// Dismiss the proposed ones that are chosen, and remove those of the project.
    Drop,
    /// Make one of those that are chosen.
    Merge,
    /// Cut one at a place, voxel.
    Cut(ChosenFault, DVec3, CutAlong),
    /// Draw more sticks of one of the project, or move their points; one without sticks gets some.
    Edit(String),
}

/// A fault that is chosen.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ChosenFault {
    /// A proposed one: its number, and the name under which it is accepted.
    Proposed(u32, String),
    /// One of the project, by its name.
    Present(String),
}

/// The interpretation under way.
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
    /// The node accepted last, until the project contains it.
    #[serde(skip)]
    pub accepted: Option<Pick>,
    /// Whether a worker is looking for the node to select.
    #[serde(skip)]
    pub awaits: bool,
    /// What was done meanwhile, and counts as soon as the node is known.
    #[serde(skip)]
    pub hasty: Vec<PickingStep>,
    /// What the pointer does.
    pub tool: Tool,
    /// How the block is shown.
    pub look: Look,
    /// What faces and sections show.
    pub show: FaceData,
    /// The stick being drawn.
    pub stick: Vec<[f64; 3]>,
    /// The complete sticks of a fault that does not exist yet.
    pub sticks: Vec<Vec<[f64; 3]>>,
    /// Name of that fault.
    pub fault: String,
    /// The line of the horizon being drawn.
    pub line: Vec<[f64; 3]>,
    /// The line that was added last, until the project contains it.
    #[serde(skip)]
    pub added: Vec<[f64; 3]>,
    /// Whether lines are laid on the nearest peak or trough.
    pub snap: bool,
    /// How far reflections are tracked.
    pub window: TrackSettings,
    /// The faults that are chosen.
    #[serde(skip)]
    pub faults: Vec<ChosenFault>,
    /// The numbers of the proposals that were dismissed.
    pub dismissed: Vec<u32>,
    /// Whether minor proposals are shown too.
    pub minor: bool,
}

impl Picking {
    /// Whether a proposal is to be shown.
    pub fn shows(&self, proposal: &Proposal) -> bool {
        (self.minor || !proposal.is_minor) && !self.dismissed.contains(&proposal.id)
    }
}

/// How a click changes the selection.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum How {
    /// The leaf becomes the selection; an earlier selection that was not accepted is dropped.
    Replace,
    /// The present selection is accepted first.
    Extend,
    /// The leaf is taken out of the horizon.
    Remove,
}

/// A closed line around what is to be erased.
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
    Section(SectionKind, f64),
    /// A picture of the block, of this size in points.
    Block(Box<Scene>, DVec2),
}

/// A point of a stick.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StickPoint {
    /// The fault; `None` of one that does not exist yet.
    pub fault: Option<String>,
    /// Which of its sticks; of a fault that does not exist yet, the one being drawn is the last.
    pub stick: usize,
    /// Which of the stick's points.
    pub point: usize,
}

/// A step of the interpretation.
#[derive(Debug, Clone, PartialEq)]
pub enum PickingStep {
    /// A click on rock, voxel.
    At(DVec3, How),
    /// The workers found a leaf.
    Found(Pick),
    /// Climb this many levels; a negative number descends.
    Climb(i32),
    /// Climb to the highest node without overlap.
    HighestValid,
    /// Add the selection to the horizon.
    Accept,
    /// Drop the selection or the stick being drawn.
    GiveUp,
    /// Start another horizon, under a name of its own.
    Begin,
    /// Send picks to this horizon from now on.
    Choose(String),
    /// Name the horizon that does not exist yet.
    Name(String),
    /// Choose the colour of the horizon that does not exist yet.
    Tint(Colour),
    /// Use another tool.
    Use(Tool),
    /// Choose how the block is shown.
    Look(Look),
    /// Choose what faces and sections show.
    Show(FaceData),
    /// Erase what a lasso encloses.
    Erase(Lasso),
    /// Add a point to the stick, voxel.
    Stick(DVec3),
    /// Add points to the line of the horizon, voxels.
    Line(Vec<DVec3>),
    /// Lay lines on the nearest peak or trough, or leave them as they are drawn.
    Snap(bool),
    /// Track so far.
    Window(TrackSettings),
    /// Move a point of a stick, voxel.
    MovePoint(StickPoint, DVec3),
    /// End the stick.
    EndStick,
    /// Remove the last point of the sticks.
    Backspace,
    /// Name of the fault being drawn.
    NameFault(String),
    /// Make a fault from the sticks.
    MakeFault,
    /// Do something with whole faults.
    Fault(FaultStep),
    /// Dismiss a proposal.
    Dismiss(u32),
    /// Show or hide minor proposals.
    Minor(bool),
}

/// Work for the workers while interpreting.
#[derive(Debug, Clone)]
pub enum PickingTask {
    /// Find the leaf at a place.
    Find([f64; 3]),
    /// Find the highest node above a pick that does not overlap itself or the horizon.
    HighestValid(Pick, Option<String>),
    /// Remove from a horizon what a lasso encloses.
    Erase(Lasso, String),
    /// Extract candidates of a volume.
    Extract(Option<String>, Box<ExtractSettings>),
    /// Propose faults.
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

/// A name that is still free: "Horizon 1", "Horizon 2", …
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
    /// Drops references to what the project no longer has, such as a horizon that was renamed or removed.
    pub fn fit(&mut self, before: &Document, now: &Document) {
        let renamed = before.renamed_in(now);
        self.faults.iter_mut().for_each(|chosen| {
            if let ChosenFault::Present(name) = chosen {
                renamed.follow(Noun::Fault, name);
            }
        });
        // One that is being taken in is not there yet.
        let was = |name: &String| before.faults.iter().any(|entry| entry.name == *name);
        let is = |name: &String| now.faults.iter().any(|entry| entry.name == *name);
        self.faults.retain(|chosen| !matches!(chosen, ChosenFault::Present(name) if was(name) && !is(name)));
        let has = |document: &Document, name: &String| document.horizons.iter().any(|entry| entry.name == *name);
        let Some(name) = &mut self.horizon else { return };
        let had = has(before, name);
        before.renamed_in(now).follow(Noun::Horizon, name);
        if has(now, name) {
            self.colour = None;
        } else if had {
            self.horizon = None;
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
        let known = entry.and_then(HorizonEntry::own_colour);
        known.or(self.colour).unwrap_or_else(|| document.next_colour())
    }

    pub(super) fn accept(&mut self) -> Option<Task> {
        let command = self.command()?;
        self.accepted = self.pick.take();
        Some(Task::Apply(Box::new(Command::Pick(command))))
    }

    /// The command that adds a part to the present horizon, or to a new one.
    pub(super) fn draw(&mut self, part: Drawn, document: &Document) -> Task {
        let free = || free_name(document, Noun::Horizon, "Horizon");
        let horizon = self.horizon.get_or_insert_with(free).clone();
        Task::Apply(Box::new(Command::DrawHorizon(DrawHorizon { horizon, colour: self.colour, part })))
    }

    /// The command that adds the line being drawn; a single point is dropped.
    pub(super) fn end_line(&mut self, document: &Document) -> Option<Task> {
        let points = std::mem::take(&mut self.line);
        if points.len() < 2 {
            return None;
        }
        self.added.clone_from(&points);
        Some(self.draw(Drawn::Line { points, snap: self.snap }, document))
    }

    /// The stick that those drawn suggest for the section in view, `slices` being the voxel positions of the sections: none
    /// while a stick is begun, or where one was drawn.
    pub fn suggestion(&self, document: &Document, slices: [f64; 3]) -> Option<suggested::Stick> {
        let geometry = document.geometry.as_ref()?;
        if self.tool != Tool::Sticks || !self.stick.is_empty() {
            return None;
        }
        let made = document.sticks.iter().filter(|drawn| drawn.fault == self.fault).flat_map(|drawn| &drawn.sticks);
        let voxels = |stick: &Vec<[f64; 3]>| stick.iter().map(|place| voxel_of(geometry, *place)).collect();
        let known: Vec<Vec<DVec3>> = made.chain(&self.sticks).map(voxels).collect();
        suggested::stick(&known, slices, geometry.size())
    }

    pub(super) fn end_stick(&mut self) {
        if self.stick.len() > 1 {
            self.sticks.push(std::mem::take(&mut self.stick));
        }
    }
}
