//! The pattern browser: every tile, grouped by rock, with a search.

use super::notices;
use super::tiles::Tiles;
use crate::state::{Action, Choice, Dialogue, Place, Session, State};
use crate::widgets::dialogue;
use crate::widgets::theme;
use crate::work::Swatches;
use eframe::egui::{Context, Role, ScrollArea, Sense, Stroke, TextEdit, Ui, WidgetInfo, vec2};
use project::command::{Command, SetLayer};
use ttf::{LayerStyle, Pattern};

/// Size of a swatch, points.
const SWATCH: [f32; 2] = [104.0, 66.0];

/// The browser, and the search text.
#[derive(Default)]
pub struct Patterns {
    search: String,
}

impl Patterns {
    /// Shows the browser for a layer or one of its depth intervals.
    #[expect(clippy::too_many_arguments, reason = "a panel is handed the parts of the window it needs, and no others")]
    pub fn show(
        &mut self,
        ctx: &Context,
        state: &State,
        session: &Session,
        layer: &str,
        interval: Option<usize>,
        swatches: &Swatches,
        tiles: &mut Tiles,
        actions: &mut Vec<Action>,
    ) {
        let room = ctx.content_rect().size();
        let modal = dialogue::show(ctx, "patterns", |ui| {
            ui.set_width((room.x - 120.0).clamp(400.0, 940.0));
            ui.heading(format!("Pattern of {layer}"));
            notices::show(ui, state, Place::Dialogue, actions);
            ui.horizontal(|ui| {
                let label = ui.label("Search");
                let edit = ui.add(
                    TextEdit::singleline(&mut self.search).hint_text("limestone, 627, sand…").desired_width(260.0),
                );
                let edit = edit.labelled_by(label.id);
                if ui.memory(|memory| memory.focused().is_none()) {
                    edit.request_focus();
                }
                if ui.button("Add a tile of your own…").clicked() {
                    actions.push(Action::Ask(Box::new(Dialogue::Choose(Choice::Texture))));
                }
            });
            let height = (room.y - 260.0).max(200.0);
            ScrollArea::vertical().max_height(height).min_scrolled_height(height).auto_shrink(false).show(ui, |ui| {
                let patterns = swatches.patterns();
                let found: Vec<&Pattern> = patterns.iter().filter(|pattern| fits(pattern, &self.search)).collect();
                if found.is_empty() {
                    ui.weak("No pattern matches. Try a rock's name or an FGDC number.");
                }
                for family in families(&found) {
                    ui.add_space(6.0);
                    ui.strong(capital(family));
                    ui.horizontal_wrapped(|ui| {
                        for pattern in found.iter().filter(|pattern| pattern.family == family) {
                            if tile(ui, pattern, swatches, tiles) {
                                actions.push(Action::Apply(Box::new(chosen(session, layer, interval, pattern))));
                                actions.push(Action::Answered);
                            }
                        }
                    });
                }
            });
            if ui.button("Cancel").clicked() {
                actions.push(Action::Answered);
            }
        });
        if modal.should_close() {
            actions.push(Action::Answered);
        }
    }
}

/// The families of patterns, each once, in the order in which they first occur.
fn families<'a>(patterns: &[&'a Pattern]) -> Vec<&'a str> {
    let mut families: Vec<&str> = Vec::new();
    for pattern in patterns {
        if !families.contains(&pattern.family.as_str()) {
            families.push(&pattern.family);
        }
    }
    families
}

/// A tile with its name beneath; returns whether it was clicked.
fn tile(ui: &mut Ui, pattern: &Pattern, swatches: &Swatches, tiles: &mut Tiles) -> bool {
    let size = vec2(SWATCH[0], SWATCH[1] + 32.0);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    let title = match pattern.fgdc {
        Some(number) => format!("{} {number}", pattern.title),
        None => pattern.title.clone(),
    };
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, format!("Pattern {}", pattern.name)));
    if ui.is_rect_visible(rect) {
        let (picture, caption) = rect.split_top_bottom_at_y(rect.top() + SWATCH[1]);
        let style = LayerStyle::textured("", pattern.colour, &pattern.name);
        tiles.paint(ui, swatches, &style, picture);
        if response.hovered() || response.has_focus() {
            let stroke = Stroke::new(2.0, theme::accent(ui.visuals()));
            ui.painter().rect_stroke(picture.expand(2.0), 4.0, stroke, eframe::egui::StrokeKind::Inside);
        }
        let font = eframe::egui::FontId::proportional(11.5);
        let colour = ui.visuals().text_color();
        let text = ui.painter().layout(title, font, colour, caption.width() - 2.0);
        ui.painter_at(caption).galley(caption.left_top() + vec2(1.0, 3.0), text, colour);
    }
    response.on_hover_text(&pattern.description).clicked()
}

/// The command that gives the layer, or one of its intervals, a pattern.
fn chosen(session: &Session, layer: &str, interval: Option<usize>, pattern: &Pattern) -> Command {
    let style = session.document.style.layers.style(layer);
    let divided = interval.zip(style).filter(|(index, style)| *index < style.intervals.len());
    let command = match divided {
        Some((index, style)) => {
            let mut intervals = style.intervals.clone();
            intervals[index].texture.clone_from(&pattern.name);
            intervals[index].colour = Some(pattern.colour);
            SetLayer { layer: layer.to_owned(), intervals, ..SetLayer::default() }
        }
        None => SetLayer { layer: layer.to_owned(), pattern: Some(pattern.name.clone()), ..SetLayer::default() },
    };
    Command::SetLayer(command)
}

/// Whether every word of the search occurs in the pattern's names, number or description.
fn fits(pattern: &Pattern, search: &str) -> bool {
    let number = pattern.fgdc.map_or_else(String::new, |number| number.to_string());
    let text = [&pattern.name, &pattern.title, &pattern.family, &pattern.description, &number]
        .map(|part| part.to_lowercase())
        .join(" ");
    search.to_lowercase().split_whitespace().all(|word| text.contains(word))
}

fn capital(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().map(|first| first.to_uppercase().chain(letters).collect()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use ttf::TextureLibrary;

    #[test]
    fn a_family_is_shown_once() {
        let library = TextureLibrary::builtin().unwrap();
        let patterns: Vec<&Pattern> = library.patterns().collect();
        let families = families(&patterns);
        assert!(patterns.iter().all(|pattern| families.contains(&pattern.family.as_str())));
        assert!(families.iter().enumerate().all(|(n, family)| !families[..n].contains(family)));
    }

    #[test]
    fn patterns_are_found_by_rock_and_by_number() {
        let library = TextureLibrary::builtin().unwrap();
        let names = |search: &str| -> Vec<String> {
            library.patterns().filter(|pattern| fits(pattern, search)).map(|pattern| pattern.name.clone()).collect()
        };
        assert!(names("627").contains(&"limestone".to_owned()));
        assert!(names("  LIMESTONE ").len() > 1);
        assert!(names("limestone basalt").is_empty());
        assert_eq!(names("").len(), library.len());
    }
}
