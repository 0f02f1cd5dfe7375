//! What Enter and Escape do in every dialogue and field.
//!
//! Enter in a dialogue presses its main button, wherever the typing was, unless another button has the focus or a list
//! is open. Escape gives up the innermost of what is open: a list, then what was typed into a field, then the dialogue;
//! `Listener` tells the shortcuts which keys are theirs.

use eframe::egui::{Context, Event, Id, Key, Popup, TextEdit, Ui};

/// Whether Enter was pressed in a dialogue and means its main button. Ask after the fields were drawn: the field in
/// which Enter was pressed has let go of the focus by then.
pub(crate) fn is_entered(ui: &Ui) -> bool {
    let pressed = |event: &Event| matches!(event, Event::Key { key: Key::Enter, pressed: true, repeat: false, .. });
    ui.input(|input| input.events.iter().any(pressed))
        && ui.memory(|memory| memory.focused().is_none())
        && !Popup::is_any_open(ui.ctx())
}

/// Tells which keys belong to a field or an open list and which to the shortcuts.
#[derive(Debug, Default)]
pub(crate) struct Listener {
    /// Whether a field or a list took the keys in the last frame: egui lets go of the focus at Escape before the frame
    /// begins, so the key that ends the typing would be taken for a shortcut.
    was_typing: bool,
}

impl Listener {
    /// Whether the keys of this frame belong to a field or an open list.
    pub(crate) fn is_typing(&self, ctx: &Context) -> bool {
        self.was_typing || takes_keys(ctx)
    }

    /// Ends a frame.
    pub(crate) fn end_frame(&mut self, ctx: &Context) {
        self.was_typing = takes_keys(ctx);
    }
}

fn takes_keys(ctx: &Context) -> bool {
    ctx.egui_wants_keyboard_input() || Popup::is_any_open(ctx)
}

/// A name that is being changed in place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Renaming {
    of: String,
    text: String,
    is_open: bool,
}

/// What became of the name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Renamed {
    /// It is still being typed.
    Typing,
    /// It stays as it was.
    Kept,
    /// This is the new name.
    To(String),
}

impl Renaming {
    /// Begins to change this name.
    pub(crate) fn of(name: &str) -> Self {
        Self { of: name.to_owned(), text: name.to_owned(), is_open: false }
    }

    /// Whether this name is the one being changed.
    pub(crate) fn is_of(&self, name: &str) -> bool {
        self.of == name
    }

    /// Shows the field, which takes the focus when it opens. Enter and a click elsewhere take the new name, Escape keeps
    /// the old one.
    pub(crate) fn show(&mut self, ui: &mut Ui, width: f32) -> Renamed {
        let id = Id::unique(("renaming", &self.of));
        let field = TextEdit::singleline(&mut self.text).id(id).desired_width(width);
        let field = ui.name_inputs("New name", |ui| ui.add(field));
        if !self.is_open {
            self.is_open = true;
            field.request_focus();
        } else if !field.has_focus() {
            let name = self.text.trim();
            let is_given_up = ui.input(|input| input.key_pressed(Key::Escape)) || name.is_empty() || name == self.of;
            return if is_given_up { Renamed::Kept } else { Renamed::To(name.to_owned()) };
        }
        Renamed::Typing
    }
}
