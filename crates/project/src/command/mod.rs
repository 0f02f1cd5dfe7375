//! Everything that changes a project, as one serialisable enum. A command states what is asked for, not how
//! it is done.
//!
//! A command reads files and the present state, writes new data through the [`Draft`] and leaves the new
//! state in it. It overwrites nothing and can fail at any point: [`crate::Project::apply`] discards the draft
//! then. Undo needs nothing from a command, because every state is remembered.

mod attribute;
mod contact;
mod extract;
mod fault;
mod fault_pick;
mod fill;
mod horizon;
mod import;
mod layer;
pub(crate) mod pick;
mod scalar;
mod scene;
mod survey_frame;
mod texture;
mod well;

pub use attribute::{AttributeComputed, AttributeKind, ComputeAttribute};
pub use contact::SetContact;
pub use extract::{Extract, ProposeFaults};
pub use fault::{AddFault, FaultAdded, RemoveFault, SetTruncation};
pub use fault_pick::{AcceptFault, PickFault};
pub use fill::{FillHorizon, HorizonFilled};
pub use horizon::{AddHorizon, Age, HorizonAdded, RemoveHorizon, RenameHorizon};
pub use import::{ImportVolume, RemoveVolume, VolumeImported};
pub use layer::{ResetLayer, SetLayer};
pub use pick::{
    Climb, Move, MovePick, PickNode, PickNodes, Picked, RemovePick, ReplayPicks, Replayed, ReplayedPick,
    SetHorizonColour, Unfit,
};
pub use scalar::{RemoveScalar, SetRaw, SetScalar};
pub use scene::{AddScene, RemoveScene};
pub use survey_frame::SetVelocity;
pub use texture::AddTexture;
pub use well::{AddWell, RemoveWell, RenameWell, WellAdded};

use crate::document::{Document, Source};
use crate::error::{Noun, ProjectError};
use crate::folder::Draft;
use crate::interpretation::extraction::Extracted;
use crate::interpretation::proposals::Proposals;
use serde::{Deserialize, Serialize};
use std::path::Path;
use survey::{Note, Progress, SurveyGeometry};

/// A change to a project.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[expect(clippy::large_enum_variant, reason = "one at a time, never in bulk")]
pub enum Command {
    /// Begin a project, with a survey frame or without.
    Create {
        /// The lattice that everything is placed in.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        geometry: Option<SurveyGeometry>,
    },
    /// Read a volume.
    Import(ImportVolume),
    /// Compute a volume from a volume.
    Attribute(ComputeAttribute),
    /// Extract horizon candidates from a volume.
    Extract(Extract),
    /// Look for faults in the horizons.
    ProposeFaults(ProposeFaults),
    /// Take a volume away.
    RemoveVolume(RemoveVolume),
    /// Read a horizon.
    AddHorizon(AddHorizon),
    /// Give a horizon another name.
    RenameHorizon(RenameHorizon),
    /// Take a horizon away.
    RemoveHorizon(RemoveHorizon),
    /// Add a node of a surface tree to a horizon, or take it out.
    Pick(PickNode),
    /// Make several picks of one horizon.
    PickSeveral(PickNodes),
    /// Move a pick up or down its tree.
    MovePick(MovePick),
    /// Take a pick out of its horizon's log.
    RemovePick(RemovePick),
    /// Give an assembled horizon another colour.
    SetHorizonColour(SetHorizonColour),
    /// Make picks again on the present extraction.
    ReplayPicks(ReplayPicks),
    /// Fill the holes of a horizon.
    FillHorizon(FillHorizon),
    /// Draw a fault by sticks.
    PickFault(PickFault),
    /// Accept a proposed fault.
    AcceptFault(AcceptFault),
    /// Read a fault.
    AddFault(AddFault),
    /// Say where a fault ends.
    SetTruncation(SetTruncation),
    /// Take a fault away.
    RemoveFault(RemoveFault),
    /// Read a well.
    AddWell(AddWell),
    /// Give a well another name.
    RenameWell(RenameWell),
    /// Take a well away.
    RemoveWell(RemoveWell),
    /// State the velocity that turns two-way time into metres.
    SetVelocity(SetVelocity),
    /// Say what a horizon does to its neighbours.
    SetContact(SetContact),
    /// Change how a layer looks.
    SetLayer(SetLayer),
    /// Take a layer's style away.
    ResetLayer(ResetLayer),
    /// Lay textures of a volume's values over the layers.
    SetScalar(SetScalar),
    /// Take a volume's textures away.
    RemoveScalar(RemoveScalar),
    /// Say how raw data is coloured.
    SetRaw(SetRaw),
    /// Bring a tile of one's own.
    AddTexture(AddTexture),
    /// Keep a view under a name.
    AddScene(AddScene),
    /// Take a view away.
    RemoveScene(RemoveScene),
}

/// What a command did: the facts to tell the user.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "effect", rename_all = "kebab-case")]
pub enum Effect {
    /// The project exists.
    Created,
    /// A volume is in the project.
    VolumeImported(VolumeImported),
    /// Volumes were computed.
    AttributeComputed(AttributeComputed),
    /// There are candidates to pick from.
    Extracted(Box<Extracted>),
    /// Faults were looked for.
    FaultsProposed(Box<Proposals>),
    /// A horizon is in the project.
    HorizonAdded(Box<HorizonAdded>),
    /// A node was added to a horizon or taken out, or a pick was moved.
    Picked(Box<Picked>),
    /// Picks were made again.
    Replayed(Box<Replayed>),
    /// Holes of a horizon were filled.
    HorizonFilled(Box<HorizonFilled>),
    /// A fault is in the project.
    FaultAdded(Box<FaultAdded>),
    /// A well is in the project.
    WellAdded(Box<WellAdded>),
    /// Something small changed.
    Changed {
        /// What, in a few words.
        summary: String,
    },
}

impl Command {
    /// Computes what takes long and needs no lock, and keeps it where [`Command::execute`] finds it; answers
    /// whether there was anything to compute.
    pub(crate) fn prepare(&self, root: &Path, document: &Document, progress: &Progress) -> Result<bool, ProjectError> {
        match self {
            Self::Extract(change) => change.prepare(root, document, progress),
            Self::ProposeFaults(change) => change.prepare(root, document, progress),
            _ => Ok(false),
        }
    }

    /// Does what it says to the draft.
    pub(crate) fn execute(&self, draft: &mut Draft, progress: &Progress) -> Result<Effect, ProjectError> {
        match self {
            Self::Create { .. } => Err(ProjectError::Exists { path: draft.root().to_owned() }),
            Self::Import(change) => change.execute(draft, progress),
            Self::Attribute(change) => change.execute(draft, progress),
            Self::Extract(change) => change.execute(draft, progress),
            Self::ProposeFaults(change) => change.execute(draft, progress),
            Self::RemoveVolume(change) => change.execute(draft),
            Self::AddHorizon(change) => change.execute(draft, progress),
            Self::RenameHorizon(change) => change.execute(draft),
            Self::RemoveHorizon(change) => change.execute(draft),
            Self::Pick(change) => change.execute(draft, progress),
            Self::PickSeveral(change) => change.execute(draft, progress),
            Self::MovePick(change) => change.execute(draft, progress),
            Self::RemovePick(change) => change.execute(draft, progress),
            Self::SetHorizonColour(change) => change.execute(draft),
            Self::ReplayPicks(change) => change.execute(draft, progress),
            Self::FillHorizon(change) => change.execute(draft, progress),
            Self::PickFault(change) => change.execute(draft, progress),
            Self::AcceptFault(change) => change.execute(draft, progress),
            Self::AddFault(change) => change.execute(draft, progress),
            Self::AddWell(change) => change.execute(draft, progress),
            Self::RenameWell(change) => change.execute(draft),
            Self::RemoveWell(change) => change.execute(draft),
            Self::SetTruncation(change) => change.execute(draft, progress),
            Self::RemoveFault(change) => change.execute(draft, progress),
            Self::SetVelocity(change) => change.execute(draft),
            Self::SetContact(change) => change.execute(draft),
            Self::SetLayer(change) => change.execute(draft),
            Self::ResetLayer(change) => change.execute(draft),
            Self::SetScalar(change) => change.execute(draft),
            Self::RemoveScalar(change) => change.execute(draft),
            Self::SetRaw(change) => change.execute(draft),
            Self::AddTexture(change) => change.execute(draft),
            Self::AddScene(change) => change.execute(draft),
            Self::RemoveScene(change) => change.execute(draft),
        }
    }
}

impl Effect {
    /// Whether the command may have found everything as it wants it; such a command is no step of the
    /// history.
    pub(crate) fn is_nothing_new(&self) -> bool {
        matches!(self, Self::Extracted(_) | Self::FaultsProposed(_))
    }

    /// Every note whose remedy a user interface may reword.
    pub fn notes_mut(&mut self) -> Vec<&mut Note> {
        match self {
            Self::VolumeImported(done) => done.evidence.iter_mut().chain(&mut done.assumptions).collect(),
            Self::HorizonAdded(done) => done.report.warnings.iter_mut().collect(),
            Self::FaultAdded(done) => done.report.warnings.iter_mut().collect(),
            Self::WellAdded(done) => done.report.notes.iter_mut().chain(&mut done.report.warnings).collect(),
            Self::Created
            | Self::AttributeComputed(_)
            | Self::Extracted(_)
            | Self::FaultsProposed(_)
            | Self::Picked(_)
            | Self::Replayed(_)
            | Self::HorizonFilled(_)
            | Self::Changed { .. } => Vec::new(),
        }
    }

    /// Tells that something was computed before the command was carried out.
    pub(crate) fn after_computing(mut self, computed: bool) -> Self {
        if let Self::Extracted(extracted) = &mut self {
            extracted.computed |= computed;
        }
        self
    }

    /// What happened, in a few words for the history.
    pub fn summary(&self) -> String {
        match self {
            Self::Created => "create".to_owned(),
            Self::VolumeImported(done) => format!("import volume {}", done.volume),
            Self::AttributeComputed(done) => format!("{} of {}", done.attribute, done.of),
            Self::Extracted(done) => format!("candidates of {}", done.volume),
            Self::FaultsProposed(done) => format!("{} faults proposed", done.proposals.len()),
            Self::HorizonAdded(done) => format!("horizon {}", done.report.name),
            Self::Picked(done) => format!("pick {} of {}", done.pick, done.horizon),
            Self::Replayed(done) => format!("{} picks made again", done.picks.len()),
            Self::HorizonFilled(done) => format!("holes of {} filled", done.horizon),
            Self::FaultAdded(done) => format!("fault {}", done.report.name),
            Self::WellAdded(done) => format!("well {}", done.name),
            Self::Changed { summary } => summary.clone(),
        }
    }
}

/// Facts of a file that was read as `reading`.
fn source_of(path: &Path, reading: String) -> Result<Source, ProjectError> {
    let facts = std::fs::metadata(path).map_err(|source| ProjectError::io("read", path, source))?;
    Ok(Source { path: path.to_owned(), bytes: facts.len(), reading })
}

impl std::fmt::Display for Effect {
    /// For the user: what was read and assumed, or what changed.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::VolumeImported(done) => {
                let [inlines, crosslines, samples] = done.size;
                writeln!(
                    f,
                    "volume '{}': {inlines} inlines, {crosslines} crosslines, {samples} samples, stored as {}; {} traces, {} missing; {} polarity",
                    done.volume, done.sample_type, done.traces, done.missing_traces, done.polarity
                )?;
                done.evidence.iter().try_for_each(|line| writeln!(f, "  {line}"))?;
                done.assumptions.iter().try_for_each(|line| writeln!(f, "  assumed: {line}"))
            }
            Self::AttributeComputed(done) => write!(f, "{done}"),
            Self::Extracted(done) => write!(f, "{done}"),
            Self::FaultsProposed(done) => write!(f, "{done}"),
            Self::HorizonAdded(done) => write!(f, "{}", done.report),
            Self::Picked(done) => write!(f, "{done}"),
            Self::Replayed(done) => write!(f, "{done}"),
            Self::HorizonFilled(done) => write!(f, "{done}"),
            Self::FaultAdded(done) => write!(f, "{}", done.report),
            Self::WellAdded(done) => write!(f, "{done}"),
            Self::Created | Self::Changed { .. } => f.write_str(&self.summary()),
        }
    }
}
