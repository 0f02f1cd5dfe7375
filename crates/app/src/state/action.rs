//! What can happen, and what follows from it for others.

use super::Appearance;
use super::dialogue::{Dialogue, ExportForm};
use super::notice::Notice;
use super::picking::{PickingStep, PickingTask};
use super::session::Snapshot;
use super::view::{Compare, Layout, Panel, StandardView};
use project::command::Command;
use render::Scene;
use std::path::PathBuf;

/// Something the user did, or an answer of the workers.
#[derive(Debug, Clone)]
pub enum Action {
    /// Open a project.
    Open(PathBuf),
    /// Go on from how a project was left.
    Recover,
    /// Do not.
    Abandon,
    /// Take a project off the list of recent ones.
    Forget(PathBuf),
    /// Make the demonstration in a folder and open it.
    Demo(PathBuf),
    /// Close the project; everything is saved already.
    Close,
    /// A project was opened.
    Opened(Box<Snapshot>),
    /// The open project changed.
    Changed(Box<Snapshot>),
    /// Something went wrong or is worth knowing.
    Tell(Notice),
    /// A notice has been read.
    Dismiss(usize),
    /// Ask for something.
    Ask(Box<Dialogue>),
    /// Ask no more.
    Answered,
    /// Change the project.
    Apply(Box<Command>),
    /// Take the last change back.
    Undo,
    /// Bring it back.
    Redo,
    /// Read a survey into the open project, or into a new one at this place.
    Import {
        /// What to read, and how.
        command: Box<project::command::ImportVolume>,
        /// Where a new project goes; absent: into the open one.
        into: Option<PathBuf>,
    },
    /// Draw to a file.
    Export(Box<ExportForm>),
    /// Put the picture on the clipboard.
    Copy,
    /// Show another picture: camera, box, cut-outs, blend.
    Show(Box<Scene>),
    /// Show a named scene.
    ShowNamed(String),
    /// Put the camera somewhere known.
    Stand(StandardView),
    /// Fill the middle otherwise.
    Arrange(Layout),
    /// Compare raw and illustrated otherwise.
    Compare(Compare),
    /// Move the wipe's line, share of the width.
    Wipe(f32),
    /// Move the sections to a point, voxel.
    Slices([f64; 3]),
    /// Lay the fence through these corners, voxel x and y.
    Fence(Vec<[f64; 2]>),
    /// Interpret.
    Picking(PickingStep),
    /// Extract candidates of a volume; of the first where none is named.
    Extract(Option<String>, Box<interp::ExtractSettings>),
    /// Look for faults in the horizons.
    ProposeFaults,
    /// Show another panel on the left.
    Panel(Panel),
    /// Show a layer's style.
    Layer(Option<String>),
    /// Show a horizon on the map.
    Horizon(Option<String>),
    /// Show or hide the handles of box and cut-outs.
    Handles(bool),
    /// Light or dark.
    Appear(Appearance),
    /// Scale everything.
    Scale(f32),
}

/// Something for the workers to do.
#[derive(Debug, Clone)]
pub enum Task {
    /// Open a project.
    Open(PathBuf),
    /// Make the demonstration in this folder, then open it.
    Demo(PathBuf),
    /// Change the open project.
    Apply(Box<Command>),
    /// Undo in the open project.
    Undo,
    /// Redo in the open project.
    Redo,
    /// Make a project of a survey, then open it.
    Create {
        /// What to read, and how.
        command: Box<project::command::ImportVolume>,
        /// The project's folder.
        root: PathBuf,
    },
    /// Something the interpretation needs.
    Picking(PickingTask),
    /// Draw to a file.
    Export(Box<ExportForm>),
    /// Put the picture on the clipboard.
    Copy,
    /// Let go of the open project.
    Release,
    /// Write down what outlives the window.
    Remember,
}
