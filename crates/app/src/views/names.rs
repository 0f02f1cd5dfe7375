//! What the rows of the window do with anything that has a name: rename it in place, remove it, colour it.

use crate::state::Action;
use crate::widgets::keyboard::{Renamed, Renaming};
use eframe::egui::Ui;
use project::command::{Command, Remove, Rename, SetColour};
use project::error::Noun;
use ttf::Colour;

/// Removes something.
pub fn remove(noun: Noun, name: &str) -> Action {
    Action::Apply(Box::new(Command::Remove(Remove { noun, name: name.to_owned() })))
}

/// Gives something a colour.
pub fn colour(noun: Noun, name: &str, colour: Colour) -> Action {
    Action::Apply(Box::new(Command::SetColour(SetColour { noun, name: name.to_owned(), colour })))
}

/// The field in which a name is changed, while it is.
#[derive(Debug, Default)]
pub(crate) struct NameField(Option<(Noun, Renaming)>);

impl NameField {
    /// Begins to change a name.
    pub(crate) fn begin(&mut self, noun: Noun, name: &str) {
        self.0 = Some((noun, Renaming::of(name)));
    }

    /// Shows the field if it is this name's; `None` if it is not.
    pub(crate) fn show(
        &mut self,
        ui: &mut Ui,
        width: f32,
        (noun, name): (Noun, &str),
        actions: &mut Vec<Action>,
    ) -> Option<Renamed> {
        let (_, renaming) = self.0.as_mut().filter(|(of, renaming)| *of == noun && renaming.is_of(name))?;
        let renamed = renaming.show(ui, width);
        if let Renamed::To(to) = &renamed {
            let command = Rename { noun, from: name.to_owned(), to: to.clone() };
            actions.push(Action::Apply(Box::new(Command::Rename(command))));
        }
        if renamed != Renamed::Typing {
            self.0 = None;
        }
        Some(renamed)
    }
}
