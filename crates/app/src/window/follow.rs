//! The window's requests to the workers, and what it does with their results.

use super::project_views::ProjectViews;
use super::{Window, lettering};
use crate::hold::{Hold, Taken};
use crate::state::{Action, Dialogue, Look, Notice, Panel, Picking, Place, Session};
use crate::work::{Event, Purpose, Seen, Wanted};
use eframe::egui::Context;
use project::command::Command;
use std::path::Path;
use ttf::{LayerStyle, Preset, RawColour};

/// What the loaded data depend on.
#[derive(PartialEq)]
pub(super) struct Needs {
    /// Revision of the open project.
    revision: u64,
    /// The draft of a style.
    layer: Option<LayerStyle>,
    /// The draft of the raw colours.
    raw: Option<RawColour>,
    preset: Preset,
    /// The volumes and horizons of the volume rendering.
    seen: Seen,
    /// While interpreting: the extraction whose candidates are shown, if any are.
    interpreting: Option<Option<String>>,
}

impl Window {
    /// Takes over the workers' results.
    pub(super) fn receive(&mut self, ctx: &Context) {
        while let Some(event) = self.work.next_event() {
            match event {
                Event::Opened(snapshot) => {
                    self.views = ProjectViews::default();
                    ctx.set_fonts(lettering::fonts(&snapshot));
                    let taken = Hold::take(&snapshot.root);
                    self.act(Action::Opened(snapshot));
                    match taken {
                        Taken::Here(hold) => self.views.hold = hold,
                        Taken::Elsewhere(process) => {
                            let process = process.map_or_else(String::new, |id| format!(" (process {id})"));
                            let text = format!(
                                "this project is also open in another window{process}; \
                                 changes made there show here after the next change made here"
                            );
                            self.act(Action::Tell(Notice::note(Place::Block, text)));
                        }
                    }
                }
                Event::Changed { snapshot, place } => {
                    self.act(Action::Changed(snapshot));
                    let waits = matches!(
                        self.state.dialogue,
                        Some(
                            Dialogue::Survey { .. }
                                | Dialogue::Interpretation { .. }
                                | Dialogue::Well { .. }
                                | Dialogue::Choose(_)
                        )
                    );
                    // A dialogue that was opened after a change was requested elsewhere stays open.
                    if waits && place == Place::Dialogue {
                        self.act(Action::Answered);
                    }
                }
                Event::Ready { root, rocks } => {
                    if self.has_open(&root) {
                        self.views.rocks = Some(rocks);
                    }
                }
                Event::Drawn(drawn) => self.views.block.receive(ctx, drawn),
                Event::Sliced { cut, of } => self.views.sections.receive(ctx, cut, of),
                Event::Fenced(picture) => self.views.fence.receive(ctx, picture),
                Event::Mapped(picture) => self.views.map.receive(ctx, picture),
                Event::Interpreted(shown) => {
                    if let Some(session) = self.state.session.as_ref().filter(|session| session.root == shown.root) {
                        self.views.overlay.receive(session, shown);
                    }
                }
                Event::Selected(shown) => {
                    if let Some(session) = &self.state.session {
                        self.views.overlay.select(session, shown);
                    }
                }
                Event::Picking { root, step } if self.has_open(&root) => self.act(Action::Picking(step)),
                Event::Erased { root, picks } if self.has_open(&root) => {
                    self.act(Action::Apply(Box::new(Command::PickSeveral(project::command::PickNodes { picks }))));
                }
                // The project was closed meanwhile.
                Event::Picking { .. } | Event::Erased { .. } => {}
                Event::Exported(path) => {
                    // A dialogue that was opened meanwhile stays open.
                    if self.state.dialogue.as_ref().is_some_and(|dialogue| dialogue.writes(&path)) {
                        self.act(Action::Answered);
                    }
                    self.act(Action::Tell(Notice::note(Place::Foot, format!("Written: {}", path.display()))));
                }
                Event::Thumbnail { root, name, image } => {
                    if self.has_open(&root) {
                        self.views.presentation.receive(ctx, name, &image);
                    }
                }
                Event::Previewed(page, preset) => self.views.preview.set(page, preset),
                Event::ShareSeen(seen) => self.views.share.receive(seen),
                Event::Told(notice) => self.act(Action::Tell(notice)),
            }
        }
    }

    fn has_open(&self, root: &Path) -> bool {
        self.state.session.as_ref().is_some_and(|session| session.root == root)
    }

    /// Loads what the open project needs when that has changed.
    pub(super) fn keep_loaded(&mut self) {
        let Some(session) = self.state.session.as_ref().filter(|session| session.is_drawable()) else { return };
        let needs = self.needs_of(session);
        if self.views.needs.as_ref() == Some(&needs) {
            return;
        }
        self.swatches.follow(&session.root, &session.document);
        // Neither named scenes nor notes nor the history change what is drawn.
        let mut document = session.document.clone();
        (document.scenes, document.notes, document.step) = (Vec::new(), Vec::new(), 0);
        self.views.layers.draft_of(&mut document);
        self.views.functions.draft_of(&mut document);
        let root = session.root.clone();
        let wanted = if let Some(extraction) = needs.interpreting.clone() {
            // Picks change horizons and faults, but not the volume that they are made on.
            document.horizons.clear();
            document.faults.clear();
            document.sticks.clear();
            document.layer_names.clear();
            let purpose = Purpose::Interpret { extraction };
            Wanted { root, document, preset: Preset::Colour, purpose }
        } else {
            Wanted { root, document, preset: needs.preset, purpose: Purpose::Illustrate(needs.seen.clone()) }
        };
        self.views.needs = Some(needs);
        if self.views.wanted.as_ref() != Some(&wanted) {
            self.work.load(wanted.clone());
            self.views.wanted = Some(wanted);
        }
    }

    /// What the loaded data depend on. It is computed in every frame, so it copies no document.
    fn needs_of(&self, session: &Session) -> Needs {
        let picking = &session.view.picking;
        let shows = picking.look == Look::VolumeRendering || picking.show != render::FaceData::Rock;
        let extraction = || self.views.overlay.interpreted().and_then(|shown| shown.key.clone()).filter(|_| shows);
        Needs {
            revision: session.revision,
            layer: self.views.layers.draft().cloned(),
            raw: self.views.functions.draft().cloned(),
            preset: session.view.scene.preset,
            seen: Seen::of(&session.view.scene),
            interpreting: (session.view.panel == Panel::Interpret).then(extraction),
        }
    }

    pub(super) fn is_interpreting(&self) -> bool {
        self.state.session.as_ref().is_some_and(|session| session.view.panel == Panel::Interpret)
    }

    /// Has the interpretation read and the selection drawn when they have changed.
    pub(super) fn keep_interpreted(&mut self) {
        let Some(session) = self.state.session.as_ref().filter(|session| session.view.panel == Panel::Interpret) else {
            return;
        };
        if session.document.geometry.is_none() {
            return;
        }
        if self.views.followed != Some(session.revision) {
            self.work.picks.follow(session.root.clone(), session.document.clone());
            self.views.followed = Some(session.revision);
        }
        let Picking { pick, horizon, accepted, .. } = &session.view.picking;
        // The node accepted last is shown until the project contains it.
        let requested = pick.clone().or_else(|| accepted.clone()).map(|pick| (pick, horizon.clone()));
        let number = self.views.overlay.interpreted().map_or(0, |shown| shown.number);
        let selected = Some((requested, number));
        if self.views.selected != selected && number > 0 {
            if let Some((requested, _)) = &selected {
                self.work.picks.draw(requested.clone());
            }
            self.views.selected = selected;
        }
    }
}
