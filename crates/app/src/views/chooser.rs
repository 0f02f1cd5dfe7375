//! Choosing a file or folder: a list to browse and a line to type into.
//!
//! It is our own rather than the desktop's, so that it is the same everywhere, needs no desktop service, and can be
//! driven by keys and tests.

use super::notices;
use crate::state::{Action, Choice, Dialogue, FileContent, Place, State, Target};
use crate::widgets::dialogue;
use crate::widgets::keyboard::is_entered;
use crate::work::folder::Folder;
use eframe::egui::{Context, RichText, ScrollArea, TextEdit, Ui};
use std::path::{Path, PathBuf};

/// The chooser.
pub(crate) struct Chooser {
    choice: Option<Choice>,
    text: String,
    listing: Folder,
    /// The folder that was chosen from last.
    home: PathBuf,
}

impl Default for Chooser {
    fn default() -> Self {
        let home = std::env::current_dir().unwrap_or_default();
        Self { choice: None, text: String::new(), listing: Folder::default(), home }
    }
}

impl Chooser {
    /// Shows the chooser in front of everything.
    pub(crate) fn show(&mut self, ctx: &Context, state: &State, choice: Choice, actions: &mut Vec<Action>) {
        if self.choice != Some(choice) {
            self.choice = Some(choice);
            self.text = self.home.join("").display().to_string();
            self.listing.forget();
        }
        let modal = dialogue::show(ctx, "chooser", |ui| {
            ui.set_width(640.0_f32.min(ctx.content_rect().width() - 60.0));
            ui.heading(title(choice));
            ui.label(explanation(choice));
            notices::show(ui, state, Place::Dialogue, actions);
            let line = ui.label("Path");
            let edit = ui.add(TextEdit::singleline(&mut self.text).desired_width(f32::INFINITY)).labelled_by(line.id);
            let is_entered = is_entered(ui);
            if ui.memory(|memory| memory.focused().is_none()) {
                edit.request_focus();
            }
            let is_taken = self.list(ui, choice) || is_entered;
            ui.horizontal(|ui| {
                let path = PathBuf::from(self.text.trim());
                if ui.button(verb(choice)).clicked() || is_taken {
                    self.choose(choice, path, actions);
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

    /// Begins anew when it is next shown.
    pub(crate) fn forget(&mut self) {
        self.choice = None;
    }

    /// The folder that the typed path names or lies in.
    fn folder(&self) -> PathBuf {
        let path = Path::new(self.text.trim());
        if self.text.ends_with(['/', '\\']) || self.text.is_empty() {
            path.to_owned()
        } else {
            path.parent().map(Path::to_owned).unwrap_or_default()
        }
    }

    /// Lists the content of the folder; returns whether something in it was chosen by a double click.
    fn list(&mut self, ui: &mut Ui, choice: Choice) -> bool {
        let mut is_taken = false;
        let listing = self.listing.listing(ui.ctx(), &self.folder());
        let height = (ui.ctx().content_rect().height() - 320.0).clamp(120.0, 380.0);
        ScrollArea::vertical().max_height(height).min_scrolled_height(height).auto_shrink(false).show(ui, |ui| {
            if let Some(error) = &listing.error {
                ui.weak(error);
            }
            if let Some(parent) = listing.folder.parent()
                && ui.selectable_label(false, "..  (up)").clicked()
            {
                self.text = parent.join("").display().to_string();
            }
            for name in &listing.projects {
                let label = ui.selectable_label(false, RichText::new(name).strong());
                if label.clicked() {
                    self.text = listing.folder.join(name).display().to_string();
                }
                is_taken |= label.double_clicked();
            }
            for name in &listing.folders {
                if ui.selectable_label(false, format!("{name}/")).clicked() {
                    self.text = listing.folder.join(name).join("").display().to_string();
                }
            }
            if choice != Choice::Project && choice != Choice::Demo {
                for name in listing.files.iter().filter(|name| fits(choice, name)) {
                    let path = listing.folder.join(name);
                    let is_chosen = Path::new(&self.text) == path;
                    let label = ui.selectable_label(is_chosen, name);
                    if label.clicked() {
                        self.text = path.display().to_string();
                    }
                    is_taken |= label.double_clicked();
                }
            }
        });
        is_taken
    }

    fn choose(&mut self, choice: Choice, path: PathBuf, actions: &mut Vec<Action>) {
        self.home = self.folder();
        let dialogue = match choice {
            Choice::Project => {
                actions.push(Action::Open(path));
                return;
            }
            Choice::Demo => {
                actions.push(Action::Demo(path));
                return;
            }
            Choice::Texture => {
                let command = project::command::AddTexture { path, width_mm: None };
                actions.push(Action::Apply(Box::new(project::Command::AddTexture(command))));
                return;
            }
            Choice::NewSurvey => Dialogue::Survey { path, target: Target::NewProject },
            Choice::MoreSurvey => Dialogue::Survey { path, target: Target::OpenProject },
            Choice::Horizon => Dialogue::Interpretation { path, kind: FileContent::Horizon },
            Choice::Fault => Dialogue::Interpretation { path, kind: FileContent::Fault },
            Choice::Well => Dialogue::Well { path },
        };
        actions.push(Action::Ask(Box::new(dialogue)));
    }
}

/// Whether a file's extension fits what is looked for. Interpretations may have any extension.
pub(super) fn fits(choice: Choice, name: &str) -> bool {
    let ending = name.rsplit_once('.').map(|(_, ending)| ending.to_lowercase()).unwrap_or_default();
    match choice {
        Choice::NewSurvey | Choice::MoreSurvey => files::segy::ENDINGS.contains(&ending.as_str()),
        Choice::Texture => ttf::TILE_ENDINGS.contains(&ending.as_str()),
        _ => true,
    }
}

fn title(choice: Choice) -> &'static str {
    match choice {
        Choice::Project => "Open a project",
        Choice::NewSurvey => "New project from a SEG-Y volume",
        Choice::MoreSurvey => "Add a volume",
        Choice::Horizon => "Add a horizon",
        Choice::Fault => "Add a fault",
        Choice::Well => "Add a well",
        Choice::Texture => "Add a tile of your own",
        Choice::Demo => "Make the demonstration",
    }
}

fn explanation(choice: Choice) -> &'static str {
    match choice {
        Choice::Project => "Projects are shown in bold; they are folders that end in .petro.",
        Choice::NewSurvey | Choice::MoreSurvey => {
            "Choose the file. How it will be read is shown before anything is imported."
        }
        Choice::Horizon => {
            "Irap, ZMAP+, CPS-3, EarthVision, Petrel, Charisma, OpendTect, TSurf, CSV and plain columns."
        }
        Choice::Well => "The deviation as CSV; the next dialogue asks for tops, logs and checkshots.",
        Choice::Fault => "Sticks (OpendTect, Charisma), TSurf, or points.",
        Choice::Texture => "A PNG, JPEG or SVG that repeats without seams.",
        Choice::Demo => "A folder for it. It takes about a minute and 60 MB.",
    }
}

fn verb(choice: Choice) -> &'static str {
    match choice {
        Choice::Project => "Open",
        Choice::Demo => "Make it",
        Choice::Texture => "Add",
        _ => "Next",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn surveys_and_tiles_are_told_by_their_endings() {
        assert!(fits(Choice::NewSurvey, "s.SGY") && !fits(Choice::NewSurvey, "h.dat"));
        assert!(fits(Choice::Texture, "dots.png") && !fits(Choice::Texture, "s.sgy"));
        assert!(fits(Choice::Horizon, "h.anything"));
    }
}
