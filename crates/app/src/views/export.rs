//! The dialogue for export: file, size and resolution.

use super::notices;
use crate::state::{
    Action, Dialogue, ExportForm, Layout, Panel, Place, SectionFill, SectionVolumes, Session, Shown, State,
};
use crate::widgets::dialogue;
use crate::widgets::form;
use crate::widgets::keyboard::is_entered;
use crate::widgets::obstacle::{needs, unless};
use crate::widgets::page::PagePreview;
use eframe::egui::{
    Align, Button, Checkbox, Context, DragValue, Grid, Layout as Alignment, ScrollArea, Spinner, TextEdit, Ui, Vec2,
    vec2,
};
use figure::Annotation;
use page::FileFormat;
use project::pictures::PickedShare;
use render::{LabelChange, Scene, Unpicked};
use std::path::Path;

/// Largest side of a picture, pixels.
const LARGEST: u32 = 16_000;

/// What is written on blocks, and what it is called.
const WRITTEN: [(Annotation, &str); 8] = [
    (Annotation::Axes, "Axes along the block's edges"),
    (Annotation::Layers, "Names along the layers"),
    (Annotation::Faults, "Names and throws of faults"),
    (Annotation::Heave, "Heave beside the throw"),
    (Annotation::Wells, "Names of wells and tops"),
    (Annotation::Quality, "Dashes and ? where not picked"),
    (Annotation::Colours, "Colour bar of raw data"),
    (Annotation::Provenance, "Program, project and data credit"),
];

/// What sections may show, and what it is called.
const FILLS: [(SectionFill, &str); 3] =
    [(SectionFill::Measured, "Measured data"), (SectionFill::Half, "Half"), (SectionFill::Rock, "Rock with patterns")];

/// The room of the page beside the form, points of the screen.
const PREVIEW: Vec2 = Vec2::new(470.0, 430.0);
/// Width of its column, the same whatever stands below the page.
const PAGE_WIDTH: f32 = 500.0;

/// Width of a column of what may be written, points.
const CHOICE: f32 = 214.0;
/// Height of what is said of horizons that were hardly picked, points; there may be many.
const SENTENCES: f32 = 72.0;

/// What the dialogue shows.
#[derive(Clone, Copy)]
pub struct Shows<'a> {
    /// What was entered.
    pub form: &'a ExportForm,
    /// Whether a page is being drawn.
    pub is_drawing: bool,
    /// Horizons that were hardly picked.
    pub sparse: &'a [PickedShare],
}

/// Shows the dialogue; whether its page is to be laid out.
pub fn show(
    ctx: &Context,
    state: &State,
    session: &Session,
    shows: Shows,
    preview: &mut PagePreview,
    actions: &mut Vec<Action>,
) -> bool {
    let mut asks = false;
    let modal = dialogue::show(ctx, "export", |ui| {
        ui.heading("Export the picture");
        ui.horizontal_top(|ui| {
            ui.vertical(|ui| {
                ui.set_width(440.0);
                asks = fields(ui, state, session, shows, actions);
            });
            if preview.has_page() {
                ui.vertical(|ui| {
                    ui.set_width(PAGE_WIDTH);
                    page(ui, session, preview, actions);
                });
            }
        });
    });
    if modal.should_close() {
        actions.push(Action::Answered);
    }
    asks
}

/// The page as it will be printed, and what can be done to its labels.
fn page(ui: &mut Ui, session: &Session, preview: &mut PagePreview, actions: &mut Vec<Action>) {
    let labels = &session.view.scene.labels;
    let show = |labels: Vec<LabelChange>| Action::Show(Box::new(Scene { labels, ..session.view.scene.clone() }));
    if let Some(labels) = preview.show(ui, PREVIEW, labels) {
        actions.push(show(labels));
    }
    if let Some(labels) = preview.show_chosen(ui, labels) {
        actions.push(show(labels));
    }
    ui.horizontal(|ui| {
        let back = ui.add_enabled(!labels.is_empty(), Button::new("Reset labels"));
        if back.on_hover_text("All labels where they were placed, as they were").clicked() {
            actions.push(show(Vec::new()));
        }
        ui.weak("Save scene keeps what is changed here.");
    });
}

/// The fields and buttons; whether the page is to be laid out.
fn fields(
    ui: &mut Ui,
    state: &State,
    session: &Session,
    Shows { form, is_drawing, sparse }: Shows,
    actions: &mut Vec<Action>,
) -> bool {
    let mut asks = false;
    notices::show(ui, state, Place::Dialogue, actions);
    let mut next = form.clone();
    Grid::new("export").num_columns(2).spacing([14.0, 10.0]).show(ui, |ui| {
        form::row(ui, "File", |ui| ui.add(TextEdit::singleline(&mut next.path).desired_width(300.0)))
            .on_hover_text(format!("The ending of the name says what is written: {}", page::endings_of_pages()));
        ui.label("Size");
        ui.horizontal(|ui| {
            for (index, name) in ["Width", "Height"].into_iter().enumerate() {
                let drag = DragValue::new(&mut next.size_cm[index]).speed(0.1).range(1.0..=120.0).max_decimals(2);
                ui.name_inputs(name, |ui| ui.add(drag));
                ui.label(if index == 0 { "×" } else { "cm" });
            }
        });
        ui.end_row();
        let drag = DragValue::new(&mut next.dpi).speed(5.0).range(36.0..=1200.0).max_decimals(0).suffix(" dpi");
        form::row(ui, "Resolution", |ui| ui.add(drag));
        let words = [("Title", &mut next.title), ("Caption", &mut next.caption), ("Data credit", &mut next.credit)];
        for (name, words) in words {
            form::row(ui, name, |ui| ui.add(TextEdit::singleline(words).desired_width(300.0)));
        }
        if shows_rock(session) {
            ui.label("Sections show");
            ui.horizontal(|ui| {
                for (fill, name) in FILLS {
                    ui.radio_value(&mut next.section_fill, fill, name);
                }
            });
            ui.end_row();
        }
        choices(ui, session, &mut next);
    });
    let [width, height] = next.size_px();
    let is_too_large = width.max(height) > LARGEST;
    let text = format!("{width} × {height} pixels");
    if is_too_large {
        ui.colored_label(ui.visuals().error_fg_color, format!("{text}: too large, lower the size or the resolution"));
    } else {
        ui.weak(text);
    }
    let has_format = FileFormat::of_page(Path::new(next.path.trim())).is_some();
    if !has_format {
        ui.colored_label(
            ui.visuals().error_fg_color,
            format!("The file's name must end in {}", page::endings(FileFormat::pages())),
        );
    }
    let has_measured = next.section_fill != SectionFill::Rock;
    if session.view.layout == Layout::Sections && has_measured && session.view.volumes != SectionVolumes::default() {
        ui.weak("Sections on the page show the raw data alone, without a second volume.");
    }
    let is_accepted = accept(ui, sparse, "Draw it all the same", &mut next.accepts_sparse);
    ui.horizontal(|ui| {
        let can = !is_drawing && !is_too_large && has_format && is_accepted;
        let button = unless(ui, needs(can, obstacle(is_accepted)), Button::new("Export"));
        if button.on_hover_text("Enter").clicked() || can && is_entered(ui) {
            actions.push(Action::Export(Box::new(next.clone())));
        }
        if ui
            .add_enabled(!is_drawing, Button::new("Preview"))
            .on_hover_text("Show the page as it will be printed")
            .clicked()
        {
            asks = true;
        }
        if ui.button("Cancel").clicked() {
            actions.push(Action::Answered);
        }
        if is_drawing {
            ui.add(Spinner::new());
            ui.label("Drawing…");
        }
    });
    if next != *form {
        actions.push(Action::Ask(Box::new(Dialogue::Export(next))));
    }
    asks
}

/// Whether sections on the page may show the rock: there are some, and layers.
fn shows_rock(session: &Session) -> bool {
    matches!(session.view.layout, Layout::Sections | Layout::Fence)
        && session.view.panel != Panel::Interpret
        && !session.document.horizons.is_empty()
}

/// What is written on the picture and beside it, in rows of two: a dialogue is no higher than a small screen.
fn choices(ui: &mut Ui, session: &Session, next: &mut ExportForm) {
    let count = 3 + WRITTEN.len();
    let half = count.div_ceil(2);
    for row in 0..half {
        ui.label(if row == 0 { "With" } else { "" });
        ui.horizontal(|ui| {
            for index in [row, row + half].into_iter().filter(|index| *index < count) {
                let size = vec2(CHOICE, ui.spacing().interact_size.y);
                ui.allocate_ui_with_layout(size, Alignment::left_to_right(Align::Center), |ui| {
                    ui.set_min_width(CHOICE);
                    choice(ui, index, session, next);
                });
            }
        });
        ui.end_row();
    }
}

fn choice(ui: &mut Ui, index: usize, session: &Session, next: &mut ExportForm) {
    let (shown, name, can) = match index {
        0 => (&mut next.legend, "Legend", !session.document.horizons.is_empty()),
        1 => (&mut next.scale_bar, "Scale bar and exaggeration", true),
        2 => (&mut next.north_arrow, "North arrow", true),
        _ => {
            let (annotation, name) = WRITTEN[index - 3];
            let is_dashed = annotation == Annotation::Quality && is_dashed(session);
            let mut is_shown = is_dashed || next.annotate.contains(&annotation);
            if unless(ui, needs(!is_dashed, DASHED), Checkbox::new(&mut is_shown, name)).changed() {
                next.annotate.retain(|known| *known != annotation);
                next.annotate.extend(is_shown.then_some(annotation));
            }
            return;
        }
    };
    let mut is_shown = *shown == Shown::Yes;
    let layers = needs(can, "There are no layers: add or pick horizons");
    if unless(ui, layers, Checkbox::new(&mut is_shown, name)).changed() {
        *shown = if is_shown { Shown::Yes } else { Shown::No };
    }
}

/// Why lines are dashed although nobody asks for it here.
const DASHED: &str = "The block is dashed in this view: switch it under Layers, Dashed where not picked";

/// Whether the page shows nothing but a block whose horizons are dashed where they were not picked.
fn is_dashed(session: &Session) -> bool {
    session.view.layout == Layout::Block && session.view.scene.outlines.unpicked == Unpicked::Dashed
}

/// Says which horizons were hardly picked; returns whether there are none, or a picture is wanted all the same.
pub(super) fn accept(ui: &mut Ui, sparse: &[PickedShare], wanted: &str, accepts: &mut bool) -> bool {
    if sparse.is_empty() {
        return true;
    }
    ScrollArea::vertical().max_height(SENTENCES).id_salt("sparse").show(ui, |ui| {
        for sentence in project::pictures::sparse_sentences(sparse) {
            ui.colored_label(ui.visuals().warn_fg_color, capital(&sentence));
        }
    });
    ui.checkbox(accepts, wanted);
    *accepts
}

/// What is to be done where a horizon was hardly picked.
pub(super) const NOT_ACCEPTED: &str = "Tick the line above first";

/// Why nothing can be written yet.
fn obstacle(is_accepted: bool) -> &'static str {
    if is_accepted { "It is being drawn, or what is written in red has to be mended first" } else { NOT_ACCEPTED }
}

/// A sentence from a clause.
fn capital(clause: &str) -> String {
    let mut letters = clause.chars();
    letters.next().into_iter().flat_map(char::to_uppercase).chain(letters).chain(['.']).collect()
}
