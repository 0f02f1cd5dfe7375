//! How a well's files would be read; what was found is shown before the well is added.

use super::notices;
use crate::app::state::{Action, Notice, Place, State};
use crate::app::theme;
use crate::app::work::Work;
use crate::app::work::scan::Found;
use crate::command::{AddWell, Command};
use eframe::egui::{Button, ComboBox, Context, Grid, Id, Modal, ScrollArea, Spinner, TextEdit, Ui};
use std::path::{Path, PathBuf};
use survey::formats::ZUnit;
use survey::well::{WellFiles, WellOptions, read_well};

/// Endings of tables.
const TABLES: [&str; 3] = ["csv", "txt", "dat"];
/// Files offered at most.
const OFFERED: usize = 40;

/// The dialogue: paths and numbers as they are typed.
#[derive(Default)]
pub struct WellDialogue {
    deviation: PathBuf,
    name: String,
    tops: String,
    las: String,
    checkshot: String,
    kb: String,
    md_unit: Option<ZUnit>,
    scanned: Option<(WellFiles, WellOptions)>,
    found: Found<Vec<String>>,
}

impl WellDialogue {
    /// Shows the dialogue.
    pub fn show(&mut self, ctx: &Context, state: &State, work: &Work, path: &Path, actions: &mut Vec<Action>) {
        if self.deviation != path {
            let name = path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
            *self = Self { deviation: path.to_owned(), name, ..Self::default() };
        }
        let (files, options) = (self.files(), self.options());
        let asked = (files.clone(), options.clone());
        if self.scanned.as_ref() != Some(&asked) {
            self.scanned = Some(asked);
            let (found, files, options) = (self.found.clone(), files.clone(), options.clone());
            let number = found.begin();
            work.background("Reading the well", Place::Dialogue, move |_, _| {
                let read = read_well(&files, &options).map_err(|error| Notice::failure(Place::Dialogue, &error));
                found.put(number, read.map(|(_, report)| [report.notes, report.warnings].concat()));
                Ok(())
            });
        }
        let modal = Modal::new(Id::unique("well")).frame(theme::dialogue(ctx)).show(ctx, |ui| {
            ui.set_width(620.0_f32.min(ctx.content_rect().width() - 60.0));
            ui.heading("Add a well");
            ui.weak(path.display().to_string());
            notices::show(ui, state, Place::Dialogue, actions);
            self.form(ui);
            ui.separator();
            ScrollArea::vertical().max_height(150.0).auto_shrink(false).show(ui, |ui| self.report(ui));
            ui.separator();
            ui.horizontal(|ui| {
                let can = !self.name.trim().is_empty() && self.found.with(|found| matches!(found, Some(Ok(_))));
                if ui.add_enabled(can, Button::new("Add")).clicked() {
                    let command = AddWell { name: self.name.trim().to_owned(), files, options };
                    actions.push(Action::Apply(Box::new(Command::AddWell(command))));
                }
                if ui.button("Cancel").clicked() {
                    actions.push(Action::Answered);
                }
            });
        });
        if modal.should_close() {
            actions.push(Action::Answered);
        }
        if actions.iter().any(|action| matches!(action, Action::Answered)) {
            self.deviation = PathBuf::new();
        }
    }

    fn form(&mut self, ui: &mut Ui) {
        Grid::new("well").num_columns(2).spacing([12.0, 8.0]).show(ui, |ui| {
            let folder = self.deviation.parent().unwrap_or(Path::new("."));
            for (name, hint, endings, text) in [
                ("Name", "", &[][..], &mut self.name),
                ("Tops", "CSV of measured depth and name; may stay empty", &TABLES[..], &mut self.tops),
                ("Logs", "LAS files, parted by semicolons; may stay empty", &["las"][..], &mut self.las),
                ("Checkshots", "CSV of time and depth, where the survey is in time", &TABLES[..], &mut self.checkshot),
                ("Datum above sea level, m", "as the file says", &[][..], &mut self.kb),
            ] {
                let label = ui.label(name);
                ui.horizontal(|ui| {
                    ui.add(TextEdit::singleline(text).hint_text(hint).desired_width(370.0)).labelled_by(label.id);
                    if !endings.is_empty() {
                        nearby(ui, folder, endings, text);
                    }
                });
                ui.end_row();
            }
            let label = ui.label("Lengths along the well");
            let shown = self.md_unit.map_or("as the file says, or metres", ZUnit::symbol);
            ui.label_inputs_by(label.id, |ui| {
                ComboBox::from_id_salt("md unit").selected_text(shown).show_ui(ui, |ui| {
                    ui.selectable_value(&mut self.md_unit, None, "as the file says, or metres");
                    for unit in [ZUnit::Metres, ZUnit::Feet] {
                        ui.selectable_value(&mut self.md_unit, Some(unit), unit.symbol());
                    }
                });
            });
            ui.end_row();
        });
    }

    fn report(&self, ui: &mut Ui) {
        self.found.with(|found| match found {
            None => drop(ui.add(Spinner::new())),
            Some(Err(notice)) => drop(ui.colored_label(ui.visuals().error_fg_color, &notice.text)),
            Some(Ok(lines)) => lines.iter().for_each(|line| drop(ui.label(line))),
        });
    }

    fn files(&self) -> WellFiles {
        let path = |text: &str| (!text.trim().is_empty()).then(|| PathBuf::from(text.trim()));
        WellFiles {
            deviation: self.deviation.clone(),
            tops: path(&self.tops),
            las: self.las.split(';').filter_map(path).collect(),
            checkshot: path(&self.checkshot),
        }
    }

    fn options(&self) -> WellOptions {
        WellOptions {
            name: Some(self.name.trim().to_owned()),
            datum_m: self.kb.trim().parse().ok().filter(|kb: &f64| kb.is_finite()),
            md_unit: self.md_unit,
            ..WellOptions::default()
        }
    }
}

/// Offers the files beside the deviation; where several may be named, another is added to those that are.
fn nearby(ui: &mut Ui, folder: &Path, endings: &[&str], text: &mut String) {
    ui.menu_button("…", |ui| {
        let mut names: Vec<String> = std::fs::read_dir(folder)
            .into_iter()
            .flatten()
            .filter_map(|entry| Some(entry.ok()?.file_name().to_string_lossy().into_owned()))
            .filter(|name| endings.iter().any(|ending| name.to_lowercase().ends_with(&format!(".{ending}"))))
            .collect();
        names.sort();
        if names.is_empty() {
            ui.weak(format!("{} has no such files", folder.display()));
        }
        for name in names.iter().take(OFFERED) {
            if ui.button(name).clicked() {
                let path = folder.join(name).display().to_string();
                let has_more = endings == ["las"] && !text.trim().is_empty();
                *text = if has_more { format!("{}; {path}", text.trim()) } else { path };
                ui.close();
            }
        }
    })
    .response
    .on_hover_text("Files beside the deviation");
}
