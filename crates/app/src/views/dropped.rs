//! Files dropped on the window: a project is opened, a volume read, a tile added; of anything else it is asked what it holds.

use crate::state::{Action, Choice, Dialogue, Interpreted, Notice, Place, State, Target};
use crate::theme;
use crate::views::chooser;
use eframe::egui::{Align2, Color32, Context, FontId, Id, LayerId, Modal, Order};
use std::path::{Path, PathBuf};

/// Takes in the file that was dropped, the first of several; while one is held over the window, says what letting go does.
pub fn receive(ctx: &Context, state: &State, is_busy: bool, actions: &mut Vec<Action>) {
    let (is_held, path) = ctx.input(|input| {
        let dropped = input.raw.dropped_files.first().map(|file| file.path().to_owned());
        (!input.raw.hovered_files.is_empty(), dropped)
    });
    if is_held {
        let painter = ctx.layer_painter(LayerId::new(Order::Foreground, Id::unique("held file")));
        let rect = ctx.content_rect();
        painter.rect_filled(rect, 0.0, Color32::from_black_alpha(150));
        let text = "Let go to open it";
        painter.text(rect.center(), Align2::CENTER_CENTER, text, FontId::proportional(24.0), Color32::WHITE);
    }
    match path {
        // What is being opened comes first.
        Some(path) if state.session.is_some() || !is_busy => actions.push(action(&path, state)),
        _ => {}
    }
}

/// What a file that was dropped is for.
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
                "the file {name} is neither a project (a folder NAME.petro) nor a SEG-Y volume (.sgy, .segy); open a project before its horizons, faults and wells"
            ),
        )),
    }
}

/// The project that a path is or is the description of.
fn project_of(path: &Path) -> Option<PathBuf> {
    if path.join("project.toml").is_file() {
        return Some(path.to_owned());
    }
    let is_description = path.file_name().is_some_and(|name| name == "project.toml");
    path.parent().filter(|_| is_description).map(Path::to_owned)
}

/// Asks what a file holds.
pub fn dialogue(ctx: &Context, path: &Path, actions: &mut Vec<Action>) {
    let modal = Modal::new(Id::unique("dropped")).frame(theme::dialogue(ctx)).show(ctx, |ui| {
        ui.set_width(420.0);
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        ui.heading(format!("What is {name}?"));
        ui.add_space(6.0);
        ui.horizontal(|ui| {
            let path = path.to_owned();
            for (name, dialogue) in [
                ("A horizon", Dialogue::Interpretation { path: path.clone(), kind: Interpreted::Horizon }),
                ("A fault", Dialogue::Interpretation { path: path.clone(), kind: Interpreted::Fault }),
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
    use crate::tests::{Driven, click, document, driven, open, project, state, survey, wait};
    use egui_kittest::kittest::Queryable;
    use std::sync::Arc;

    /// A file that the pointer lets go of.
    #[derive(Debug)]
    struct Held(PathBuf);

    impl eframe::egui::DroppedFile for Held {
        fn path(&self) -> &Path {
            &self.0
        }

        fn bytes(&self) -> Result<Vec<u8>, String> {
            std::fs::read(&self.0).map_err(|error| error.to_string())
        }
    }

    fn drop_on(harness: &mut Driven, path: &Path) {
        harness.input_mut().dropped_files.push(Arc::new(Held(path.to_owned())));
        harness.run_steps(3);
    }

    #[test]
    fn a_project_is_opened_and_a_survey_read() {
        let folder = tempfile::tempdir().unwrap();
        let root = project(folder.path());
        let mut harness = driven(folder.path(), None);
        harness.step();
        drop_on(&mut harness, &folder.path().join("nothing.dat"));
        harness.get_by_label_contains("nothing.dat is neither a project");
        drop_on(&mut harness, &survey(folder.path()));
        harness.get_by_label("Create project");
        click(&mut harness, "Cancel");
        drop_on(&mut harness, &root.join("project.toml"));
        wait(&mut harness, "the project is open", |harness| state(harness).session.is_some());
        assert_eq!(state(&harness).session.as_ref().unwrap().root, root);
    }

    #[test]
    fn it_is_asked_what_a_file_holds() {
        let folder = tempfile::tempdir().unwrap();
        let mut harness = open(folder.path());
        let path = folder.path().join("Middle.csv");
        std::fs::write(&path, "inline,crossline,z\n1,1,50\n24,1,50\n1,20,50\n24,20,50\n12,10,50\n").unwrap();
        drop_on(&mut harness, &path);
        harness.get_by_label("What is Middle.csv?");
        click(&mut harness, "A horizon");
        assert!(matches!(state(&harness).dialogue, Some(Dialogue::Interpretation { kind: Interpreted::Horizon, .. })));
        assert_eq!(document(&harness).horizons.len(), 2, "nothing is added unasked");
    }
}
