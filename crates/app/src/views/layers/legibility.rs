//! Which neighbouring layers cannot be told apart, with a button for what helps.
//!
//! They are compared on a thread of their own, whenever the project, its data or what is shown has changed.

use crate::state::{Action, Session};
use crate::work::Rocks;
use eframe::egui::{Button, Ui};
use project::command::{Command, SetLayer};
use project::pictures::figures::{NamedConfusion, confusions};
use project::styles;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use ttf::Preset;

/// Pairs that are listed; others are counted.
const LISTED: usize = 5;

/// Room between sentences and the right end of the panel, points.
const MARGIN: f32 = 8.0;
/// Least width of a sentence, points.
const LEAST: f32 = 80.0;

/// What a comparison depends on.
#[derive(PartialEq)]
struct Key {
    /// The project, its step and the revision of the window's copy: opened again, it may have another step.
    project: (PathBuf, u32, u64),
    /// The key of the loaded data.
    loaded: u64,
    preset: Preset,
    has_ground: bool,
    is_illustrated: bool,
}

/// The pairs that were found last.
#[derive(Default)]
pub(super) struct Legibility {
    key: Option<Key>,
    coming: Option<Receiver<Vec<NamedConfusion>>>,
    found: Vec<NamedConfusion>,
}

impl Legibility {
    /// Lists the pairs, and compares again when something has changed.
    pub(super) fn show(&mut self, ui: &mut Ui, session: &Session, rocks: Option<&Rocks>, actions: &mut Vec<Action>) {
        match self.coming.as_ref().map(Receiver::try_recv) {
            Some(Ok(found)) => (self.found, self.coming) = (found, None),
            Some(Err(TryRecvError::Disconnected)) => self.coming = None,
            Some(Err(TryRecvError::Empty)) | None => {}
        }
        self.follow(ui, session, rocks);
        if self.found.is_empty() {
            return;
        }
        ui.add_space(8.0);
        ui.separator();
        ui.scope(|ui| {
            // Rows above may reach beyond what is seen of the panel; a sentence must not.
            let seen = ui.clip_rect().right() - ui.cursor().left();
            ui.set_max_width((seen - MARGIN).clamp(LEAST, ui.available_width().max(LEAST)));
            self.list(ui, actions);
        });
    }

    fn list(&self, ui: &mut Ui, actions: &mut Vec<Action>) {
        ui.strong("Hard to tell apart");
        for pair in self.found.iter().take(LISTED) {
            ui.colored_label(ui.visuals().warn_fg_color, format!("{pair}."));
            if let Some(fix) = fix(pair)
                && ui.add(Button::new(words(&fix)).wrap()).clicked()
            {
                actions.push(Action::Apply(Box::new(Command::SetLayer(fix))));
            }
        }
        let more = self.found.len().saturating_sub(LISTED);
        if more > 0 {
            ui.weak(format!("and {more} more pairs of layers"));
        }
    }

    /// Compares the layers if what they depend on has changed and no comparison is under way.
    fn follow(&mut self, ui: &Ui, session: &Session, rocks: Option<&Rocks>) {
        let Some(rocks) = rocks else { return };
        let scene = &session.view.scene;
        let key = Key {
            project: (session.root.clone(), session.document.step, session.revision),
            loaded: rocks.key,
            preset: scene.preset,
            has_ground: scene.ground.is_some(),
            is_illustrated: scene.blend < 1.0,
        };
        if self.coming.is_some() || self.key.as_ref() == Some(&key) {
            return;
        }
        self.key = Some(key);
        let (sender, receiver) = channel();
        self.coming = Some(receiver);
        let (rocks, root, document) = (rocks.clone(), session.root.clone(), session.document.clone());
        let (scene, context) = (scene.clone(), ui.ctx().clone());
        std::thread::spawn(move || {
            // What cannot be read here is told where the picture is drawn.
            let found = styles::pattern_library(&root, &document).and_then(|library| {
                confusions(rocks.rock.as_deref(), &styles::layer_styles(&document, &library), &library, &scene)
            });
            let found = found.unwrap_or_default();
            if sender.send(found).is_ok() {
                context.request_repaint();
            }
        });
    }
}

/// The command that tells a pair apart.
fn fix(pair: &NamedConfusion) -> Option<SetLayer> {
    let (layer, remedy) = (pair.change.clone()?, pair.confusion.remedy.as_ref()?);
    let pattern = remedy.pattern.clone();
    Some(SetLayer { layer, colour: Some(remedy.colour), pattern, ..SetLayer::default() })
}

/// What the button says.
fn words(fix: &SetLayer) -> String {
    match (&fix.pattern, fix.colour) {
        (Some(pattern), _) => format!("Give {} the pattern {pattern}", fix.layer),
        (None, Some(colour)) => format!("Give {} the colour {colour}", fix.layer),
        (None, None) => format!("Change {}", fix.layer),
    }
}
