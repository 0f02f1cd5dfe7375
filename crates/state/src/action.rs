//! Actions, and the tasks for the workers that follow from them.

use super::Appearance;
use super::dialogue::{DataForm, Dialogue, ExportForm, ShareForm};
use super::notice::{Notice, Place};
use super::picking::{PickingStep, PickingTask};
use super::session::Snapshot;
use super::view::{Compare, Layout, Panel, SectionVolumes, StandardView};
use files::SurfaceKind;
use project::command::Command;
use render::Scene;
use std::path::PathBuf;

/// Something the user did, or a result from the workers.
#[derive(Debug, Clone)]
pub enum Action {
    /// Open a project.
    Open(PathBuf),
    /// Check a project that may be damaged, and say what was found there.
    Check(PathBuf, Place),
    /// Continue from the recorded view of the project that was open when the last run ended.
    Recover,
    /// Discard that record.
    Abandon,
    /// Remove a project from the list of recent ones.
    Forget(PathBuf),
    /// Make the demonstration in a folder and open it.
    Demo(PathBuf),
    /// Give the open project layers by computed geologic time.
    Illustrate,
    /// Close the project; everything is saved already.
    Close,
    /// A project was opened.
    Opened(Box<Snapshot>),
    /// The open project changed.
    Changed(Box<Snapshot>),
    /// Show a message.
    Tell(Notice),
    /// Put a message away.
    Dismiss(usize),
    /// Open a dialogue.
    Ask(Box<Dialogue>),
    /// Close the dialogue.
    Answered,
    /// Apply a command to the project.
    Apply(Box<Command>),
    /// Undo the last change.
    Undo,
    /// Redo the change that was undone last.
    Redo,
    /// Read a survey into the open project or into a new one.
    Import {
        /// What to read, and how.
        command: Box<project::command::ImportVolume>,
        /// Folder of the new project; `None`: import into the open one.
        into: Option<PathBuf>,
    },
    /// Draw the page to a file.
    Export(Box<ExportForm>),
    /// Write a volume, a horizon or a fault for other programs.
    ExportData(Box<DataForm>),
    /// Write the page or the model of the block.
    Share(Box<ShareForm>),
    /// Copy the picture to the clipboard.
    Copy,
    /// Show another scene: camera, box, cut-outs, blend.
    Show(Box<Scene>),
    /// Show a named scene.
    ShowNamed(String),
    /// Present the scenes over the whole screen, beginning with this one; `None`: leave, and show what was shown before.
    Present(Option<usize>),
    /// Draw sections at this vertical exaggeration; `None`: as large as their views.
    Proportions(Option<f64>),
    /// Show these volumes on sections.
    Volumes(SectionVolumes),
    /// Move the camera to a standard position.
    Stand(StandardView),
    /// Choose which views fill the middle.
    Arrange(Layout),
    /// Choose how raw and illustrated pictures are compared.
    Compare(Compare),
    /// Move the dividing line of the wipe to this share of the width.
    Wipe(f32),
    /// Move the sections to a point, voxel.
    Slices([f64; 3]),
    /// Set the corners of the fence, voxel x and y.
    Fence(Vec<[f64; 2]>),
    /// Take a step of the interpretation.
    Picking(PickingStep),
    /// Extract candidates of a volume; `None`: of the first one.
    Extract(Option<String>, Box<interp::ExtractSettings>),
    /// Propose faults from the offsets of the horizons.
    ProposeFaults,
    /// Show another panel on the left.
    Panel(Panel),
    /// Show a layer's style.
    Layer(Option<String>),
    /// Show a horizon on the map.
    Horizon(Option<String>),
    /// Show or hide the lines and surfaces of a horizon or fault.
    Hide {
        /// Whether it is a horizon or a fault.
        kind: SurfaceKind,
        /// Its name.
        name: String,
        /// Whether it is hidden from now on.
        hidden: bool,
    },
    /// Show or hide the handles of the box and the cut-outs.
    Handles(bool),
    /// Choose the light or the dark theme.
    Appear(Appearance),
    /// Scale the whole interface.
    Scale(f32),
}

/// Something for the workers to do.
#[derive(Debug, Clone)]
pub enum Task {
    /// Open a project.
    Open(PathBuf),
    /// Check a project.
    Check(PathBuf, Place),
    /// Make the demonstration in this folder, then open it.
    Demo(PathBuf),
    /// Give the open project layers by computed geologic time.
    Illustrate,
    /// Change the open project.
    Apply(Box<Command>),
    /// Undo in the open project.
    Undo,
    /// Redo in the open project.
    Redo,
    /// Create a project from a survey, then open it.
    Create {
        /// What to read, and how.
        command: Box<project::command::ImportVolume>,
        /// The project's folder.
        root: PathBuf,
    },
    /// Work that the interpretation needs.
    Picking(PickingTask),
    /// Draw the page to a file.
    Export(Box<ExportForm>),
    /// Write a volume, a horizon or a fault for other programs.
    ExportData(Box<DataForm>),
    /// Write the page or the model of the block.
    Share(Box<ShareForm>),
    /// Copy the picture to the clipboard.
    Copy,
    /// Release everything that was loaded for the open project.
    Release,
    /// Write the settings that outlive the window.
    Remember,
}
