//! Everything that changes a project, as one serialisable enum. A command states what is wanted, not how it is done.
//!
//! A command reads files and the present state, writes new data through the `Draft` and leaves the new state in it.
//! It overwrites nothing and can fail at any point: [`crate::Project::apply`] then discards the draft. Undo needs
//! nothing from a command, because every state is kept in the history.

mod array_volume;
mod attribute;
mod contact;
mod draw;
mod extract;
mod fault;
mod fault_edit;
mod fault_parts;
mod fault_pick;
mod horizon;
mod import;
mod layer;
mod link;
mod name;
mod note;
mod outline_bodies;
mod parameterization;
pub(crate) mod pick;
mod pick_by_time;
mod refine;
mod restore;
mod scalar;
mod scene;
mod stack;
mod stored_volume;
mod survey_frame;
mod tell_history;
mod texture;
pub(crate) mod time;
mod time_slabs;
mod well;

pub use attribute::{AttributeComputed, AttributeKind, ComputeAttribute};
pub use contact::SetContact;
pub use draw::{DrawHorizon, HorizonDrawn};
pub use extract::{Extract, ProposeFaults};
pub use fault::{AddFault, FaultAdded, SetFaultExtent, SetTruncation};
pub use fault_edit::{CutAlong, CutFault, GiveSticks, MergeFaults};
pub use fault_pick::{AcceptFault, MoveStickPoint, PickFault};
pub use horizon::{AddHorizon, Age, HorizonAdded};
pub use import::{ImportVolume, VolumeImported};
pub use layer::{ResetLayer, SetLayer};
pub use link::LinkVolume;
pub use name::{Remove, Rename, SetColour};
pub use note::AddNote;
pub use outline_bodies::OutlineBodies;
pub(crate) use outline_bodies::isolated;
pub use parameterization::SetParameterization;
pub use pick::{
    Climb, Move, MovePick, PickNode, PickNodes, Picked, RemovePick, ReplayPicks, Replayed, ReplayedPick, Unfit,
};
pub use pick_by_time::{PickByTime, PickedByTime, TimeLevel};
pub use refine::{FillHorizon, HorizonRefined, SmoothHorizon};
pub use restore::{ProjectRestored, Restore};
pub use scalar::{RemoveScalar, SetRaw, SetScalar};
pub use scene::AddScene;
pub use stack::{Spacing, StackHorizons, Stacked};
pub use survey_frame::SetVelocity;
pub use tell_history::{HistoryTold, TellHistory};
pub use texture::AddTexture;
pub use time::{ComputeTime, TimeComputed};
pub use time_slabs::TimeSlabs;
pub use well::{AddWell, WellAdded};

use crate::document::{Document, Origin};
use crate::error::{Noun, ProjectError};
use crate::folder::Draft;
use crate::interpretation::extraction::Extracted;
use crate::interpretation::proposals::Proposals;
use interp::StageSeconds;
use serde::{Deserialize, Serialize};
use std::path::Path;
use survey::{Note, Progress, SurveyGeometry};
use system::file::FileAction;

/// A change to a project.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[expect(clippy::large_enum_variant, reason = "one at a time, never in bulk")]
pub enum Command {
    /// Create a project, with or without a survey geometry.
    Create {
        /// The lattice in which everything is placed.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        geometry: Option<SurveyGeometry>,
    },
    /// Give something another name.
    Rename(Rename),
    /// Remove something.
    Remove(Remove),
    /// Give something another colour.
    SetColour(SetColour),
    /// Import a volume.
    Import(ImportVolume),
    /// Compute a volume from a volume.
    Attribute(ComputeAttribute),
    /// Extract horizon candidates from a volume.
    Extract(Extract),
    /// Compute geologic time.
    Time(ComputeTime),
    /// Propose faults from the horizons.
    ProposeFaults(ProposeFaults),
    /// Take in a volume that stays in object storage.
    LinkVolume(LinkVolume),
    /// Add a horizon from a file.
    AddHorizon(AddHorizon),
    /// Add a node of a surface tree to a horizon, or remove it.
    Pick(PickNode),
    /// Add a horizon that is a level of geologic time.
    PickByTime(PickByTime),
    /// Add a stack of horizons.
    StackHorizons(StackHorizons),
    /// Add the outlines of isolated bodies.
    OutlineBodies(OutlineBodies),
    /// Make several picks of one horizon.
    PickSeveral(PickNodes),
    /// Draw a line of a horizon, or track it from a place.
    DrawHorizon(DrawHorizon),
    /// Move a pick up or down its tree.
    MovePick(MovePick),
    /// Remove a pick from its horizon's log.
    RemovePick(RemovePick),
    /// Repeat picks on the present extraction.
    ReplayPicks(ReplayPicks),
    /// Fill the holes of a horizon.
    FillHorizon(FillHorizon),
    /// Smooth a horizon.
    SmoothHorizon(SmoothHorizon),
    /// Draw a fault by sticks.
    PickFault(PickFault),
    /// Move a point of a stick.
    MoveStickPoint(MoveStickPoint),
    /// Accept a proposed fault.
    AcceptFault(AcceptFault),
    /// Cut a fault in two.
    CutFault(CutFault),
    /// Make one fault of several.
    MergeFaults(MergeFaults),
    /// Give a fault sticks that can be moved.
    GiveSticks(GiveSticks),
    /// Add a fault from a file.
    AddFault(AddFault),
    /// State at which other fault a fault ends.
    SetTruncation(SetTruncation),
    /// State how far a fault reaches beyond what was drawn.
    SetFaultExtent(SetFaultExtent),
    /// Add a well from its files.
    AddWell(AddWell),
    /// State the velocity that turns two-way time into metres.
    SetVelocity(SetVelocity),
    /// State the contact of a horizon with its neighbours.
    SetContact(SetContact),
    /// Change how a layer looks.
    SetLayer(SetLayer),
    /// Remove a layer's style.
    ResetLayer(ResetLayer),
    /// Lay textures over the layers by the values of a volume.
    SetScalar(SetScalar),
    /// Remove the textures of a volume.
    RemoveScalar(RemoveScalar),
    /// Set the colours of raw data.
    SetRaw(SetRaw),
    /// Add a tile.
    AddTexture(AddTexture),
    /// Take i, j, k from a file.
    SetParameterization(SetParameterization),
    /// Save a scene under a name.
    AddScene(AddScene),
    /// Write a note on a place.
    AddNote(AddNote),
    /// Make a block from its geological history.
    TellHistory(TellHistory),
    /// Restore the interpretation of another project to one of its horizons.
    Restore(Restore),
}

/// What a command did: the facts to report to the user.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "effect", rename_all = "kebab-case")]
pub enum Effect {
    /// The project exists.
    Created,
    /// A volume was imported.
    VolumeImported(VolumeImported),
    /// Volumes were computed.
    AttributeComputed(AttributeComputed),
    /// Geologic time was computed.
    TimeComputed(TimeComputed),
    /// A horizon was picked by geologic time.
    PickedByTime(PickedByTime),
    /// A stack of horizons was added.
    Stacked(Stacked),
    /// Candidates were extracted.
    Extracted(Box<Extracted>),
    /// Faults were proposed.
    FaultsProposed(Box<Proposals>),
    /// A horizon was added or changed.
    HorizonAdded(Box<HorizonAdded>),
    /// A node was added to a horizon or removed, or a pick was moved.
    Picked(Box<Picked>),
    /// A part of a horizon was drawn or tracked.
    HorizonDrawn(Box<HorizonDrawn>),
    /// Picks were repeated.
    Replayed(Box<Replayed>),
    /// Holes of a horizon were filled.
    HorizonRefined(Box<HorizonRefined>),
    /// A fault was added or changed.
    FaultAdded(Box<FaultAdded>),
    /// A well was added.
    WellAdded(Box<WellAdded>),
    /// A block was made from its geological history.
    HistoryTold(Box<HistoryTold>),
    /// The interpretation of another project was restored.
    Restored(Box<ProjectRestored>),
    /// A small change.
    Changed {
        /// The change, in a few words.
        summary: String,
    },
}

impl Command {
    /// Computes what takes long and needs no lock, and stores it where [`Command::execute`] finds it; returns how
    /// long an extraction took that had to be computed.
    pub(crate) fn prepare(
        &self,
        root: &Path,
        document: &Document,
        progress: &Progress,
    ) -> Result<Option<StageSeconds>, ProjectError> {
        match self {
            Self::Extract(change) => change.prepare(root, document, progress),
            Self::ProposeFaults(change) => change.prepare(root, document, progress).map(|()| None),
            _ => Ok(None),
        }
    }

    /// Applies the command to the draft.
    pub(crate) fn execute(&self, draft: &mut Draft, progress: &Progress) -> Result<Effect, ProjectError> {
        match self {
            Self::Create { .. } => Err(ProjectError::Exists { path: draft.root().to_owned() }),
            Self::Rename(change) => change.execute(draft),
            Self::Remove(change) => change.execute(draft, progress),
            Self::SetColour(change) => change.execute(draft),
            Self::Import(change) => change.execute(draft, progress),
            Self::Attribute(change) => change.execute(draft, progress),
            Self::Extract(change) => change.execute(draft, progress),
            Self::Time(change) => change.execute(draft, progress),
            Self::PickByTime(change) => change.execute(draft, progress),
            Self::StackHorizons(change) => change.execute(draft, progress),
            Self::OutlineBodies(change) => change.execute(draft, progress),
            Self::ProposeFaults(change) => change.execute(draft, progress),
            Self::LinkVolume(change) => change.execute(draft, progress),
            Self::AddHorizon(change) => change.execute(draft, progress),
            Self::Pick(change) => change.execute(draft, progress),
            Self::PickSeveral(change) => change.execute(draft, progress),
            Self::DrawHorizon(change) => change.execute(draft, progress),
            Self::MovePick(change) => change.execute(draft, progress),
            Self::RemovePick(change) => change.execute(draft, progress),
            Self::ReplayPicks(change) => change.execute(draft, progress),
            Self::FillHorizon(change) => change.execute(draft, progress),
            Self::SmoothHorizon(change) => change.execute(draft, progress),
            Self::PickFault(change) => change.execute(draft, progress),
            Self::MoveStickPoint(change) => change.execute(draft, progress),
            Self::AcceptFault(change) => change.execute(draft, progress),
            Self::CutFault(change) => change.execute(draft, progress),
            Self::MergeFaults(change) => change.execute(draft, progress),
            Self::GiveSticks(change) => change.execute(draft, progress),
            Self::AddFault(change) => change.execute(draft, progress),
            Self::AddWell(change) => change.execute(draft, progress),
            Self::SetTruncation(change) => change.execute(draft, progress),
            Self::SetFaultExtent(change) => change.execute(draft, progress),
            Self::SetVelocity(change) => change.execute(draft),
            Self::SetContact(change) => change.execute(draft),
            Self::SetLayer(change) => change.execute(draft),
            Self::ResetLayer(change) => change.execute(draft),
            Self::SetScalar(change) => change.execute(draft),
            Self::RemoveScalar(change) => change.execute(draft),
            Self::SetRaw(change) => change.execute(draft),
            Self::AddTexture(change) => change.execute(draft),
            Self::SetParameterization(change) => change.execute(draft, progress),
            Self::AddScene(change) => change.execute(draft),
            Self::AddNote(change) => change.execute(draft),
            Self::TellHistory(change) => change.execute(draft, progress),
            Self::Restore(change) => change.execute(draft, progress),
        }
    }
}

impl Effect {
    /// What was changed, and what changed with it, one sentence each.
    pub(crate) fn changed(summary: String, with_it: Vec<String>) -> Self {
        Self::Changed { summary: std::iter::once(summary).chain(with_it).collect::<Vec<_>>().join("; ") }
    }

    /// Whether the command may find everything as it wants it already; such a command does not become a step of the
    /// history.
    pub(crate) fn is_nothing_new(&self) -> bool {
        matches!(self, Self::Extracted(_) | Self::FaultsProposed(_))
    }

    /// Every note whose remedy a user interface may reword.
    pub fn notes_mut(&mut self) -> Vec<&mut Note> {
        match self {
            Self::VolumeImported(done) => done.evidence.iter_mut().chain(&mut done.assumptions).collect(),
            Self::HorizonAdded(done) => done.report.notes_mut().collect(),
            Self::FaultAdded(done) => done.report.notes_mut().collect(),
            Self::WellAdded(done) => done.report.notes_mut().collect(),
            Self::Created
            | Self::AttributeComputed(_)
            | Self::TimeComputed(_)
            | Self::PickedByTime(_)
            | Self::Stacked(_)
            | Self::Extracted(_)
            | Self::FaultsProposed(_)
            | Self::Picked(_)
            | Self::HorizonDrawn(_)
            | Self::Replayed(_)
            | Self::HorizonRefined(_)
            | Self::HistoryTold(_)
            | Self::Restored(_)
            | Self::Changed { .. } => Vec::new(),
        }
    }

    /// Records in the effect how long an extraction took that was computed before the command was carried out.
    pub(crate) fn after_computing(mut self, took: Option<StageSeconds>) -> Self {
        if let (Self::Extracted(extracted), Some(_)) = (&mut self, took) {
            extracted.computed = true;
            extracted.report.seconds = took;
        }
        self
    }

    /// The effect in a few words, for the history.
    pub fn summary(&self) -> String {
        match self {
            Self::Created => "create".to_owned(),
            Self::VolumeImported(done) => format!("import volume {}", done.volume),
            Self::AttributeComputed(done) => format!("{} of {}", done.attribute, done.of),
            Self::TimeComputed(done) => format!("geologic time of {}", done.of),
            Self::PickedByTime(done) => format!("horizon {} by geologic time", done.horizon),
            Self::Stacked(done) => format!("{} stacked horizons", done.horizons.len()),
            Self::Extracted(done) => format!("candidates of {}", done.volume),
            Self::FaultsProposed(done) => format!("{} faults proposed", done.proposals.len()),
            Self::HorizonAdded(done) => format!("horizon {}", done.report.name),
            Self::Picked(done) => format!("pick {} of {}", done.pick, done.horizon),
            Self::HorizonDrawn(done) => done.summary(),
            Self::Replayed(done) => format!("{} picks repeated", done.picks.len()),
            Self::HorizonRefined(done) if done.result.smoothed.is_some() => {
                format!("horizon {} smoothed", done.horizon)
            }
            Self::HorizonRefined(done) => format!("holes of {} filled", done.horizon),
            Self::FaultAdded(done) => format!("fault {}", done.report.name),
            Self::WellAdded(done) => format!("well {}", done.name),
            Self::HistoryTold(done) => format!("a block of {} events", done.events),
            Self::Restored(done) => format!("restored to {}", done.horizons.first().map_or("", String::as_str)),
            Self::Changed { summary } => summary.clone(),
        }
    }
}

/// The origin of what was read from a file, as `reading` says.
fn imported(path: &Path, reading: String) -> Result<Origin, ProjectError> {
    let facts = std::fs::metadata(path).map_err(|source| ProjectError::io(FileAction::Read, path, source))?;
    Ok(Origin::Imported { path: path.to_owned(), bytes: facts.len(), reading })
}

impl std::fmt::Display for Effect {
    /// The report for the user: what was read and assumed, or what changed.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::VolumeImported(done) => {
                let [inlines, crosslines, samples] = done.size;
                writeln!(
                    f,
                    "volume '{}': {inlines} inlines, {crosslines} crosslines, {samples} samples, stored as {}; \
                     {} traces, {} missing; {} polarity",
                    done.volume, done.sample_type, done.traces, done.missing_traces, done.polarity
                )?;
                done.evidence.iter().try_for_each(|line| writeln!(f, "  {line}"))?;
                done.assumptions.iter().try_for_each(|line| writeln!(f, "  assumed: {line}"))
            }
            Self::AttributeComputed(done) => write!(f, "{done}"),
            Self::TimeComputed(done) => write!(f, "{done}"),
            Self::PickedByTime(done) => write!(f, "{done}"),
            Self::Stacked(done) => write!(f, "{done}"),
            Self::Extracted(done) => write!(f, "{done}"),
            Self::FaultsProposed(done) => write!(f, "{done}"),
            Self::HorizonAdded(done) => write!(f, "{}", done.report),
            Self::Picked(done) => write!(f, "{done}"),
            Self::HorizonDrawn(done) => write!(f, "{done}"),
            Self::Replayed(done) => write!(f, "{done}"),
            Self::HorizonRefined(done) => write!(f, "{done}"),
            Self::FaultAdded(done) => write!(f, "{}", done.report),
            Self::WellAdded(done) => write!(f, "{done}"),
            Self::HistoryTold(done) => write!(f, "{done}"),
            Self::Restored(done) => write!(f, "{done}"),
            Self::Created | Self::Changed { .. } => f.write_str(&self.summary()),
        }
    }
}
