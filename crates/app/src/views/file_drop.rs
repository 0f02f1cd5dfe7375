//! Files dropped on the window: a project is opened, a volume is read, a tile is added; for any other file a dialogue
//! asks what it holds.

use crate::state::{Action, Choice, Dialogue, FileContent, Notice, Place, State, Target};
use crate::views::chooser;
use crate::widgets::dialogue;
use eframe::egui::{Align2, Color32, Context, FontId, Id, LayerId, Order};
use std::path::{Path, PathBuf};

/// The file that was dropped last, until the window can take it in.
#[derive(Default)]
pub(crate) struct Dropped {
    waiting: Option<PathBuf>,
}

impl Dropped {
    /// Handles the first of the files that were dropped; while a file is held over the window, says what dropping it
    /// will do.
    ///
    /// Without an open project the file waits while the window is busy: a project may be opening, or a volume be
    /// scanned.
    pub(crate) fn receive(&mut self, ctx: &Context, state: &State, is_busy: bool, actions: &mut Vec<Action>) {
        let (is_held, path) = ctx.input(|input| {
            let dropped = input.raw.dropped_files.first().map(|file| file.path().to_owned());
            (!input.raw.hovered_files.is_empty(), dropped)
        });
        if is_held {
            say_what_dropping_does(ctx);
        }
        if path.is_some() {
            self.waiting = path;
        }
        if state.session.is_some() || !is_busy {
            actions.extend(self.waiting.take().map(|path| action(&path, state)));
        }
    }
}

fn say_what_dropping_does(ctx: &Context) {
    let painter = ctx.layer_painter(LayerId::new(Order::Foreground, Id::unique("held file")));
    let rect = ctx.content_rect();
    painter.rect_filled(rect, 0.0, Color32::from_black_alpha(150));
    painter.text(rect.center(), Align2::CENTER_CENTER, "Drop to open", FontId::proportional(24.0), Color32::WHITE);
}

/// What a dropped file can be used for.
fn action(path: &Path, state: &State) -> Action {
    let document = state.session.as_ref().map(|session| &session.document);
    let ask = |dialogue: Dialogue| Action::Ask(Box::new(dialogue));
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    if let Some(root) = project_of(path) {
        return Action::Open(root);
    }
    if chooser::fits(Choice::NewSurvey, &name) {
        let target = if document.is_some() { Target::OpenProject } else { Target::NewProject };
        return ask(Dialogue::Survey { path: path.to_owned(), target });
    }
    match document {
        Some(_) if chooser::fits(Choice::Texture, &name) => {
            let command = project::command::AddTexture { path: path.to_owned(), width_mm: None };
            Action::Apply(Box::new(project::Command::AddTexture(command)))
        }
        Some(document) if document.geometry.is_some() && path.is_file() => {
            ask(Dialogue::Dropped { path: path.to_owned() })
        }
        Some(_) => Action::Tell(Notice::note(
            Place::Block,
            format!(
                "the file {name} is neither a project nor a SEG-Y volume; add a volume first, then horizons, faults and wells"
            ),
        )),
        None => Action::Tell(Notice::note(
            Place::Start,
            format!(
                "the file {name} is neither a project (a folder NAME.petro) nor a SEG-Y volume (.{}); \
             open a project before its horizons, faults and wells",
                files::segy::ENDINGS.join(", .")
            ),
        )),
    }
}

/// The project folder, if the path is one or is the `project.toml` in one.
fn project_of(path: &Path) -> Option<PathBuf> {
    if path.join("project.toml").is_file() {
        return Some(path.to_owned());
    }
    let is_description = path.file_name().is_some_and(|name| name == "project.toml");
    path.parent().filter(|_| is_description).map(Path::to_owned)
}

/// Asks what a file holds.
pub fn dialogue(ctx: &Context, path: &Path, actions: &mut Vec<Action>) {
    let modal = dialogue::show(ctx, "dropped", |ui| {
        ui.set_width(420.0);
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        ui.heading(format!("What is {name}?"));
        ui.add_space(6.0);
        ui.horizontal(|ui| {
            let path = path.to_owned();
            for (name, dialogue) in [
                ("A horizon", Dialogue::Interpretation { path: path.clone(), kind: FileContent::Horizon }),
                ("A fault", Dialogue::Interpretation { path: path.clone(), kind: FileContent::Fault }),
                ("A well's deviation", Dialogue::Well { path }),
            ] {
                if ui.button(name).clicked() {
                    actions.push(Action::Ask(Box::new(dialogue)));
                }
            }
            if ui.button("Cancel").clicked() {
                actions.push(Action::Answered);
            }
        });
    });
    if modal.should_close() {
        actions.push(Action::Answered);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::state::Remembered;
    use std::sync::Arc;

    #[derive(Debug)]
    struct Held(PathBuf);

    impl eframe::egui::DroppedFile for Held {
        fn path(&self) -> &Path {
            &self.0
        }

        fn bytes(&self) -> Result<Vec<u8>, String> {
            Err("only where it lies matters here".to_owned())
        }
    }

    #[test]
    fn a_file_dropped_while_something_is_opened_is_taken_in_afterwards() {
        let (ctx, state, mut dropped) = (Context::default(), State::new(Remembered::default()), Dropped::default());
        let mut received = |files: Vec<Arc<dyn eframe::egui::DroppedFile + Send + Sync>>, is_busy| {
            let mut actions = Vec::new();
            let input = eframe::egui::RawInput { dropped_files: files, ..Default::default() };
            let mut drawn = ctx.run_ui(input, |ui| dropped.receive(ui.ctx(), &state, is_busy, &mut actions));
            drawn.textures_delta.clear();
            actions
        };
        let path = PathBuf::from("north.petro/project.toml");
        assert!(received(vec![Arc::new(Held(path))], true).is_empty());
        assert!(received(Vec::new(), true).is_empty());
        let opened = received(Vec::new(), false);
        assert!(matches!(&opened[..], [Action::Open(root)] if root == Path::new("north.petro")));
        assert!(received(Vec::new(), false).is_empty(), "it is opened once");
    }
}
