//! The open project as the window knows it: a copy of its document, its history, and its view.

use super::picking::Tool;
use super::view::{Panel, ViewState};
use project::HistoryLine;
use project::document::Document;
use project::error::Noun;
use std::path::PathBuf;

/// A project as read from disk.
#[derive(Debug, Clone)]
pub struct Snapshot {
    /// Its folder.
    pub root: PathBuf,
    /// Its state.
    pub document: Document,
    /// Its history, oldest first.
    pub history: Vec<HistoryLine>,
}

/// The open project.
#[derive(Debug, Clone)]
pub struct Session {
    /// Its folder.
    pub root: PathBuf,
    /// Its state as last read.
    pub document: Document,
    /// Grows with each state that is read. The step number alone does not identify a state: it repeats after undo.
    pub revision: u64,
    /// Its history, oldest first.
    pub history: Vec<HistoryLine>,
    /// The view.
    pub view: ViewState,
}

impl Session {
    /// A project that was just opened, with the given view or else its own first scene.
    pub fn new(snapshot: Snapshot, view: Option<ViewState>) -> Self {
        let Snapshot { root, document, history } = snapshot;
        let mut view = view.unwrap_or_else(|| {
            let mut usual = ViewState::of(&document);
            // With geologic time one click makes a horizon.
            usual.picking.tool = if document.geologic_time().is_some() { Tool::Time } else { usual.picking.tool };
            usual
        });
        view.fit(&document);
        Self { root, document, revision: 0, history, view }
    }

    /// Takes over a new state of the same project; the view stays as far as it still applies.
    pub(crate) fn renew(&mut self, snapshot: Snapshot) {
        let had_frame = self.document.geometry.is_some();
        let was_bare = self.document.horizons.is_empty();
        let times = [&self.document, &snapshot.document].map(|document| document.geologic_time().is_some());
        let picking = &mut self.view.picking;
        picking.tool = match (times, picking.tool) {
            ([false, true], Tool::Pick) => Tool::Time,
            ([true, false], Tool::Time) => Tool::Pick,
            (_, tool) => tool,
        };
        picking.fit(&self.document, &snapshot.document);
        self.view.picking.accepted = None;
        self.view.picking.added.clear();
        self.follow_names(&snapshot.document);
        self.document = snapshot.document;
        self.revision += 1;
        self.history = snapshot.history;
        let illustrates_now = was_bare && !self.document.horizons.is_empty();
        if !had_frame || illustrates_now {
            let usual = ViewState::of(&self.document).scene;
            if self.view.panel == Panel::Interpret {
                // Whoever is picking keeps camera, box and cut-outs; the scene of the illustration takes over when it
                // is first shown.
                self.view.scene.blend = usual.blend;
                self.view.scene.ground = usual.ground;
            } else {
                self.view.scene = usual;
            }
        }
        self.view.fit(&self.document);
    }

    /// Lets the view follow what has another name in the next state.
    fn follow_names(&mut self, next: &Document) {
        let renamed = self.document.renamed_in(next);
        renamed.follow_in(&mut self.view.scene);
        self.view.hidden.follow(&renamed);
        let over = self.view.volumes.over.iter_mut().map(|over| (Noun::Volume, &mut over.volume));
        let layer = self.view.layer.iter_mut().map(|name| (Noun::Layer, name));
        let horizon = self.view.horizon.iter_mut().map(|name| (Noun::Horizon, name));
        over.chain(layer).chain(horizon).for_each(|(noun, name)| renamed.follow(noun, name));
    }

    /// The project's name: its folder's name without the extension.
    pub fn name(&self) -> String {
        self.root
            .file_stem()
            .map_or_else(|| self.root.display().to_string(), |stem| stem.to_string_lossy().into_owned())
    }

    /// The change that undo would revert.
    pub fn undoable(&self) -> Option<&str> {
        let step = self.document.step;
        self.history.iter().find(|line| line.step == step && step > 0).map(|line| line.summary.as_str())
    }

    /// The change that redo would restore.
    pub fn redoable(&self) -> Option<&str> {
        let step = self.document.step + 1;
        self.history.iter().find(|line| line.step == step).map(|line| line.summary.as_str())
    }

    /// Whether there is something to draw.
    pub fn is_drawable(&self) -> bool {
        self.document.geometry.is_some() && !(self.document.volumes.is_empty() && self.document.horizons.is_empty())
    }
}
