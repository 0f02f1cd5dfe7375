//! Messages, shown in the part of the window that they belong to.

use crate::state::{Action, Place, State};
use eframe::egui::{Frame, Margin, RichText, Stroke, Ui};

/// Shows the messages of one place, each with advice on what to do next and a button to dismiss it.
pub fn show(ui: &mut Ui, state: &State, place: Place, actions: &mut Vec<Action>) {
    for (index, notice) in state.notices_at(place) {
        let visuals = ui.visuals();
        let colour = if notice.failed { visuals.error_fg_color } else { visuals.warn_fg_color };
        let frame = Frame::new()
            .fill(colour.gamma_multiply(0.09))
            .stroke(Stroke::new(1.0, colour.gamma_multiply(0.5)))
            .corner_radius(6.0)
            .inner_margin(Margin::symmetric(10, 8));
        frame.show(ui, |ui| {
            ui.set_width(ui.available_width());
            ui.label(RichText::new(sentence(&notice.text)).color(colour));
            if let Some(hint) = &notice.hint {
                ui.label(sentence(hint));
            }
            ui.horizontal(|ui| {
                if let Some(root) = &notice.suspect {
                    let check = ui.button("Check project");
                    if check.on_hover_text("Reads all of it and says what is damaged; nothing is changed").clicked() {
                        actions.push(Action::Check(root.clone(), notice.place));
                    }
                }
                if ui.button("Dismiss").clicked() {
                    actions.push(Action::Dismiss(index));
                }
            });
        });
    }
}

/// Capitalises the first letter and ends the text with a full stop.
fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    let capital = letters.next().map(|first| first.to_uppercase().chain(letters).collect::<String>());
    let text = capital.unwrap_or_default();
    if text.ends_with(['.', '!', '?']) { text } else { format!("{text}.") }
}

#[cfg(test)]
mod tests {
    use super::sentence;

    #[test]
    fn messages_are_sentences() {
        assert_eq!(sentence("the disk is full"), "The disk is full.");
        assert_eq!(sentence("Éclat!"), "Éclat!");
        assert_eq!(sentence(""), ".");
    }
}
