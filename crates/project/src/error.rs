//! What can go wrong with a project, with the facts as fields and a hint for what to do next.

mod advice;
mod causes;
mod fault_edit;
mod noun;
mod stage;

pub use advice::remedy_of;
pub use fault_edit::FaultEditError;
pub use noun::Noun;
pub use stage::StageError;

use crate::placement::PlacementError;
use files::FormatError;
use files::segy::SegyError;
use files::well::WellFileError;
use std::io;
use std::path::PathBuf;
use store::StoreError;
use system::file::FileAction;

/// Why something could not be done with a project. The project is as it was before.
#[derive(Debug, thiserror::Error)]
pub enum ProjectError {
    /// There is no project at the path.
    #[error("there is no project at {}", path.display())]
    NotFound {
        /// The path.
        path: PathBuf,
    },
    /// There is something else at the path.
    #[error("{} is not a Petroglyph project: {fact}", path.display())]
    NotAProject {
        /// The path.
        path: PathBuf,
        /// What it is or lacks.
        fact: &'static str,
    },
    /// Something exists already at the path.
    #[error("{} exists already", path.display())]
    Exists {
        /// Where the project was to be created.
        path: PathBuf,
    },
    /// Written by a later version of the program.
    #[error(
        "{} was written by a newer Petroglyph (project version {found}; this program knows up to {supported})", path.display()
    )]
    Newer {
        /// The project's file.
        path: PathBuf,
        /// Its version.
        found: u32,
        /// The latest version known here.
        supported: u32,
    },
    /// `project.toml` or a history step cannot be understood.
    #[error("{} cannot be understood: {detail}", path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// Where and why.
        detail: String,
    },
    /// Another process is changing the project.
    #[error("{} is being changed by {}", path.display(), holder.as_deref().unwrap_or("another Petroglyph process"))]
    Locked {
        /// The project.
        path: PathBuf,
        /// Which process, where that is known.
        holder: Option<String>,
    },
    /// A file that was to be written into the folder of a project.
    #[error("{} lies inside the project {}, whose files only commands write", path.display(), project.display())]
    InsideProject {
        /// What was to be written.
        path: PathBuf,
        /// The project.
        project: PathBuf,
    },
    /// What is asked for does not fit into memory.
    #[error(transparent)]
    Memory(#[from] system::memory::NotEnough),
    /// Stored data of another size than the project says.
    #[error("the data of \"{name}\" have {found:?} inlines, crosslines and samples, but the project says {expected:?}")]
    OtherSize {
        /// Name of the volume, or what else it is.
        name: String,
        /// What the project says.
        expected: [usize; 3],
        /// What the data say.
        found: [usize; 3],
    },
    /// Data that are not those that the project recorded.
    #[error(
        "{} is not what the project recorded of {noun} \"{name}\": its content has the hash {}…, and {}… was recorded",
        path.display(), short(found), short(expected)
    )]
    OtherContent {
        /// The file or folder.
        path: PathBuf,
        /// What it holds.
        noun: Noun,
        /// The name of that.
        name: String,
        /// BLAKE3 that the project recorded.
        expected: String,
        /// BLAKE3 of what is there.
        found: String,
    },
    /// A link where a project keeps a file or folder of its own.
    #[error("{} is a link, and a project holds none: what it points to could be changed or deleted", path.display())]
    Link {
        /// The link.
        path: PathBuf,
    },
    /// The folder cannot be written.
    #[error("{} cannot be written: it is read-only or belongs to someone else", path.display())]
    ReadOnly {
        /// The file or folder.
        path: PathBuf,
    },
    /// The disk is full.
    #[error("the disk is full: {} could not be written", path.display())]
    DiskFull {
        /// The file or folder.
        path: PathBuf,
    },
    /// Any other failure of the file system.
    #[error("{} could not be {action}", path.display())]
    Io {
        /// What was being done with it.
        action: FileAction,
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// Something is in its place, but the disk failed to confirm it.
    #[error("{} could not be flushed to the disk: what was changed in it may be gone after a power cut", path.display())]
    NotFlushed {
        /// The folder.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// A project that was never used here, and lacks something.
    #[error(
        "{} comes from elsewhere and is not whole: {count} of its files or folders are missing or not what they should be, \
         first {file}: {reason}", path.display()
    )]
    Unsound {
        /// The project.
        path: PathBuf,
        /// How many there are.
        count: usize,
        /// The first of them, relative to the project.
        file: String,
        /// What is wrong with it.
        reason: String,
    },
    /// A name is taken.
    #[error("the project already has a {noun} named \"{name}\"")]
    Duplicate {
        /// What it is.
        noun: Noun,
        /// The name wanted.
        name: String,
    },
    /// A name does not exist.
    #[error("the project has no {noun} named \"{name}\" ({})", listed(.known))]
    Unknown {
        /// What was looked for.
        noun: Noun,
        /// The name given.
        name: String,
        /// The names there are.
        known: Vec<String>,
    },
    /// What cannot be done with a thing of this kind.
    #[error("the {noun} \"{name}\" {fact}")]
    Refused {
        /// What it is.
        noun: Noun,
        /// Its name.
        name: String,
        /// Why it cannot be done.
        fact: &'static str,
    },
    /// A name that cannot be used.
    #[error("\"{name}\" cannot be the name of a {noun}: {fact}")]
    BadName {
        /// The kind of thing that was to be named.
        noun: Noun,
        /// The name given.
        name: String,
        /// What is wrong with it.
        fact: &'static str,
    },
    /// A note that cannot be written or removed, and what is wrong with it.
    #[error("the note cannot be used: {0}")]
    BadNote(String),
    /// A review or model that cannot be as small as was asked for.
    #[error("{what} has {found}, more than the {limit} that it may have")]
    OverBudget {
        /// The file.
        what: &'static str,
        /// Its size at its smallest.
        found: String,
        /// The limit.
        limit: String,
    },
    /// A survey geometry that conversions cannot work with.
    #[error("the survey geometry cannot be used: {0}")]
    Geometry(#[from] survey::geometry::GeometryError),
    /// A volume that does not lie in the project's survey.
    #[error("volume \"{name}\" does not fit the project: {source}")]
    Placement {
        /// Name of the volume.
        name: String,
        /// What does not fit.
        source: PlacementError,
    },
    /// A file that holds more than was asked for.
    #[error("{} holds several: {}", path.display(), names.join(", "))]
    SeveralInFile {
        /// The file.
        path: PathBuf,
        /// What it holds.
        names: Vec<String>,
    },
    /// Horizons in the wrong order.
    #[error(
        "horizon \"{younger}\" runs below \"{older}\" at {:.0} % of their common traces, by up to {worst:.1} \
         {unit} at inline {:.0}, crossline {:.0}",
        share * 100.0, lines[0], lines[1]
    )]
    Crossing {
        /// The horizon that should be above.
        younger: String,
        /// The horizon that should be below.
        older: String,
        /// Share of the common traces at which they cross, 0 to 1.
        share: f64,
        /// Largest crossing.
        worst: f32,
        /// Its unit.
        unit: &'static str,
        /// Inline and crossline of the worst place.
        lines: [f64; 2],
    },
    /// Faults that end at one another.
    #[error("faults end at one another in a circle: {}", path.join(" ends at "))]
    CircularTruncation {
        /// The faults along the circle.
        path: Vec<String>,
    },
    /// A fault that would reach less than nothing, or beyond any survey, past what was drawn.
    #[error("fault \"{fault}\" cannot reach {grown_m} m beyond what was drawn")]
    BadGrowth {
        /// The fault.
        fault: String,
        /// What was stated, m.
        grown_m: f64,
    },
    /// A SEG-Y file that could not be read.
    #[error(transparent)]
    Segy(#[from] SegyError),
    /// A horizon or fault file that could not be read or written.
    #[error(transparent)]
    Format(#[from] FormatError),
    /// A well's file that could not be read.
    #[error(transparent)]
    Well(#[from] WellFileError),
    /// Data of the project that could not be read or written.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// An attribute could not be computed.
    #[error(transparent)]
    Attribute(#[from] attribute::AttributeError),
    /// The interpretation does not make a solid model.
    #[error(transparent)]
    Model(#[from] model::ModelError),
    /// The text tells no geological history.
    #[error("the history cannot be read: {source}")]
    History {
        /// What is wrong, and its line.
        source: history::HistoryError,
    },
    /// The project has something already, which a whole block would replace.
    #[error(
        "{made} is a whole block, and this project has horizons, faults or volumes already; create a new project for it"
    )]
    OverBlock {
        /// What was to be made.
        made: &'static str,
    },
    /// There is no block at a stage of a geological history.
    #[error(transparent)]
    Stage(#[from] StageError),
    /// The interpretation cannot be restored to a horizon.
    #[error(transparent)]
    Restore(restore::RestoreError),
    /// The layers could not be parameterized.
    #[error(transparent)]
    Param(#[from] param::ParamError),
    /// A transfer function or texture that cannot be drawn.
    #[error(transparent)]
    Style(#[from] ttf::TtfError),
    /// A font file that cannot be used.
    #[error("{}: {fact}", path.display())]
    Font {
        /// The file.
        path: PathBuf,
        /// Why not, and what to do.
        fact: String,
    },
    /// A view that shows nothing.
    #[error(transparent)]
    Scene(#[from] render::SceneError),
    /// No picture could be made.
    #[error(transparent)]
    Render(#[from] render::RenderError),
    /// A figure that shows nothing, or has no room.
    #[error(transparent)]
    Figure(figure::FigureError),
    /// A figure of the project's list that cannot be made.
    #[error("the figure \"{file}\" of the project cannot be made: {fact}")]
    BadFigure {
        /// Its file.
        file: String,
        /// Why not.
        fact: String,
    },
    /// A project that lists no figures.
    #[error("the project lists no figures")]
    NoFigures,
    /// A synthetic survey could not be made.
    #[error(transparent)]
    Synth(#[from] synth::SynthError),
    /// A folder without the truth of a synthetic survey.
    #[error("{} is not the truth of a synthetic survey ({fact})", path.display())]
    NotATruth {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        fact: String,
    },
    /// Horizon candidates could not be extracted or read.
    #[error(transparent)]
    Interp(interp::InterpError),
    /// There are no candidates yet.
    #[error("the project has no horizon candidates yet")]
    NotExtracted,
    /// There is no volume to compute from.
    #[error("the project has no volume on its own lattice")]
    NoVolume,
    /// A volume whose lattice is not the project's.
    #[error("volume \"{volume}\" lies on another lattice than the project")]
    OtherLattice {
        /// Its name.
        volume: String,
    },
    /// A place outside the survey.
    #[error(
        "inline {}, crossline {}, {} lies outside the survey: inlines {} to {}, crosslines {} to {}, {} to {} down",
        at[0], at[1], at[2], inlines[0], inlines[1], crosslines[0], crosslines[1], vertical[0], vertical[1]
    )]
    PickOutside {
        /// Inline, crossline, vertical value.
        at: [f64; 3],
        /// First and last inline.
        inlines: [i32; 2],
        /// First and last crossline.
        crosslines: [i32; 2],
        /// First and last vertical value.
        vertical: [f64; 2],
    },
    /// The project has no geologic time.
    #[error("the project has no geologic time")]
    NoTime,
    /// Geologic time is not known at a place.
    #[error("geologic time is not known at inline {}, crossline {}, {}: no candidate lies near it", at[0], at[1], at[2])]
    TimeUnknown {
        /// Inline, crossline, vertical value.
        at: [f64; 3],
    },
    /// A stack of that many horizons is none, or has no room.
    #[error("a stack of {count} horizons: from 1 to {most} can be added to this project")]
    StackCount {
        /// Number that was asked for.
        count: usize,
        /// Largest number that can be added.
        most: usize,
    },
    /// Shares of a thickness need two horizons.
    #[error("shares of a thickness lie between two horizons, and none were named")]
    StackBetween,
    /// The two horizons of a stack have nothing between them.
    #[error("{}", match between {
        Some([top, base]) => format!("nothing lies below \"{top}\" and above \"{base}\" in one fault block"),
        None => "geologic time is known nowhere".to_owned(),
    })]
    StackOrder {
        /// The horizons, the upper one first.
        between: Option<[String; 2]>,
    },
    /// Nothing in geologic time can bound layers.
    #[error("no level of geologic time crosses half of the traces, so there are no layers to draw")]
    NoLevels,
    /// No trace has a value of geologic time.
    #[error("geologic time is {time} nowhere")]
    NoIsochron {
        /// The value.
        time: f32,
    },
    /// Geologic time could not be computed.
    #[error(transparent)]
    Time(::time::TimeError),
    /// There is no candidate near a place.
    #[error(
        "no candidate lies within {max_distance} voxels of inline {}, crossline {}, {}: the nearest is \
         {distance:.1} voxels away, at inline {:.1}, crossline {:.1}, {:.1}",
        at[0], at[1], at[2], nearest[0], nearest[1], nearest[2]
    )]
    NoCandidate {
        /// Inline, crossline, vertical value.
        at: [f64; 3],
        /// The nearest candidate, likewise.
        nearest: [f64; 3],
        /// Its distance, voxels.
        distance: f32,
        /// Largest distance of the extraction, voxels.
        max_distance: f32,
    },
    /// A node could not be found.
    #[error(transparent)]
    Assembly(#[from] interp::assembly::AssemblyError),
    /// A horizon that was imported.
    #[error("horizon \"{horizon}\" was imported, not assembled by picks")]
    NotAssembled {
        /// Its name.
        horizon: String,
    },
    /// What was drawn has no tree.
    #[error("{pick} was drawn or tracked, not picked: it has no tree to climb")]
    NotClimbable {
        /// Its number.
        pick: u32,
    },
    /// A line without enough points.
    #[error("a line of a horizon has at least two points")]
    ShortLine,
    /// No reflection goes on from a place.
    #[error("no reflection goes on from inline {}, crossline {}, {}", at[0], at[1], at[2])]
    NothingTracked {
        /// Inline, crossline and vertical value.
        at: [f64; 3],
    },
    /// Nothing would be left of a horizon.
    #[error("nothing would be left of horizon \"{horizon}\"")]
    NothingLeft {
        /// Its name.
        horizon: String,
    },
    /// The node is already part of the horizon.
    #[error("horizon \"{horizon}\" already contains all of the node at leaf {leaf}")]
    AlreadyPicked {
        /// The horizon.
        horizon: String,
        /// The leaf.
        leaf: u32,
    },
    /// The node is not part of the horizon.
    #[error("horizon \"{horizon}\" contains nothing of the node at leaf {leaf}")]
    NotPicked {
        /// The horizon.
        horizon: String,
        /// The leaf.
        leaf: u32,
    },
    /// Picks of several horizons at once.
    #[error("picks of \"{}\" and \"{}\" cannot be made in one step", horizons[0], horizons[1])]
    SeveralHorizons {
        /// Two of them.
        horizons: [String; 2],
    },
    /// There is no pick of this number.
    #[error(
        "there is no pick {pick}; {}",
        if known.is_empty() { "there are no picks yet".to_owned() } else { format!("the picks are {known:?}") }
    )]
    UnknownPick {
        /// Its number.
        pick: u32,
        /// The numbers that exist.
        known: Vec<u32>,
    },
    /// A pick that cannot descend that far.
    #[error("pick {pick} is {up} levels above its leaf and cannot descend further than that")]
    AtLeaf {
        /// Its number.
        pick: u32,
        /// Levels above its leaf.
        up: u32,
    },
    /// Picks made on another extraction.
    #[error("the extraction has changed since picks {picks:?} of horizon \"{horizon}\" were made")]
    OutdatedPicks {
        /// The horizon.
        horizon: String,
        /// Their numbers.
        picks: Vec<u32>,
    },
    /// Picks whose nodes have changed.
    #[error("picks {picks:?} of horizon \"{horizon}\" no longer fit: their nodes have changed or no longer exist")]
    UnfitPicks {
        /// The horizon.
        horizon: String,
        /// Their numbers.
        picks: Vec<u32>,
    },
    /// A horizon whose picks were all made on another extraction, and none of which fits the present one.
    #[error("no pick of horizon \"{horizon}\" fits the present extraction: their nodes no longer exist")]
    NoPickFits {
        /// The horizon.
        horizon: String,
    },
    /// A stick of one point.
    #[error("stick {stick} has one point; a stick is a line of at least two")]
    ShortStick {
        /// Which one, from 1.
        stick: usize,
    },
    /// A fault that was not drawn as sticks.
    #[error("fault \"{fault}\" was not drawn as sticks")]
    NotDrawn {
        /// Its name.
        fault: String,
    },
    /// A fault that cannot be made of its sticks, or changed as a whole.
    #[error(transparent)]
    FaultEdit(#[from] FaultEditError),
    /// There are no horizons, so there are no layers.
    #[error("the project has no horizons, so there are no layers to parameterize")]
    NoLayers,
    /// There is nothing from which to propose faults.
    #[error(
        "the project has neither a volume in which faults could be found, nor horizons whose offsets could tell them"
    )]
    NoEvidence,
    /// No faults were proposed.
    #[error("no faults have been proposed yet")]
    NoProposals,
    /// Proposals for another state.
    #[error("the horizons have changed since faults were proposed")]
    OutdatedProposals,
    /// There is no proposal of this number.
    #[error("there is no proposal {proposal}; they are numbered from 1 to {known}")]
    UnknownProposal {
        /// Its number.
        proposal: u32,
        /// Number of proposals.
        known: u32,
    },
    /// The user cancelled.
    #[error("cancelled")]
    Cancelled(#[from] survey::Cancelled),
    /// There is no survey geometry yet.
    #[error("the project has no survey geometry yet")]
    NoGeometry,
    /// The history is at its first step.
    #[error("there is nothing to undo")]
    NothingToUndo,
    /// The history is at its last step.
    #[error("there is nothing to redo")]
    NothingToRedo,
}

/// The beginning of a hash: enough to tell two apart.
fn short(hash: &str) -> &str {
    hash.get(..12).unwrap_or(hash)
}

fn listed(names: &[String]) -> String {
    if names.is_empty() { "it has none".to_owned() } else { format!("it has: {}", names.join(", ")) }
}
