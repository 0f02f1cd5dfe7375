//! The dialogue that shows how the files of a well would be read, before the well is added.

use super::notices;
use crate::state::{Action, Notice, Place, State};
use crate::widgets::dialogue;
use crate::widgets::form;
use crate::widgets::keyboard::is_entered;
use crate::widgets::obstacle::{needs, unless};
use crate::work::Work;
use crate::work::folder::{Folder, FolderListing};
use crate::work::scan::Reading;
use eframe::egui::{Button, Context, Grid, ScrollArea, Spinner, TextEdit, Ui};
use files::ZUnit;
use files::well::{WellColumn, WellFiles, WellOptions, read_well};
use project::command::{AddWell, Command};
use state::fields;
use std::path::{Path, PathBuf};
use survey::Setting;

/// File extensions of tables.
const TABLES: [&str; 3] = ["csv", "txt", "dat"];
/// Largest number of files that are offered.
const OFFERED: usize = 40;

/// The dialogue, with the paths and numbers as they are typed.
#[derive(Default)]
pub(crate) struct WellDialogue {
    deviation: PathBuf,
    name: String,
    tops: String,
    las: String,
    checkshot: String,
    kb: String,
    head: String,
    in_file: String,
    md_unit: Option<ZUnit>,
    xy_unit: Option<ZUnit>,
    collar: String,
    /// Columns of the deviation as they are typed.
    columns: String,
    beside: Folder,
    reading: Reading<(WellFiles, WellOptions), Vec<String>>,
}

impl WellDialogue {
    /// Shows the dialogue.
    pub(crate) fn show(&mut self, ctx: &Context, state: &State, work: &Work, path: &Path, actions: &mut Vec<Action>) {
        if self.deviation != path {
            let name = path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
            *self = Self { deviation: path.to_owned(), name, ..Self::default() };
        }
        let (files, options) = (self.files(), self.options());
        let asked = (files.clone(), options.clone());
        let (files_read, options_read) = asked.clone();
        self.reading.follow(ctx, work, "Reading the well", &asked, move |_| {
            let (_, report) =
                read_well(&files_read, &options_read).map_err(|error| Notice::failure(Place::Dialogue, &error))?;
            Ok(report.notes.iter().chain(&report.assumptions).chain(&report.warnings).map(fields::note).collect())
        });
        let modal = dialogue::show(ctx, "well", |ui| {
            ui.set_width(620.0_f32.min(ctx.content_rect().width() - 60.0));
            ui.heading("Add a well");
            ui.weak(path.display().to_string());
            notices::show(ui, state, Place::Dialogue, actions);
            self.form(ui);
            if let Some(unclear) = self.unclear() {
                ui.colored_label(ui.visuals().error_fg_color, unclear);
            }
            ui.separator();
            ScrollArea::vertical().max_height(150.0).auto_shrink(false).show(ui, |ui| self.report(ui));
            ui.separator();
            ui.horizontal(|ui| {
                let can = !self.name.trim().is_empty() && self.unclear().is_none() && self.reading.is_good(&asked);
                if unless(ui, needs(can, "Name the well, and state what is missing above"), Button::new("Add"))
                    .clicked()
                    || can && is_entered(ui)
                {
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
            let beside = self.beside.listing(ui.ctx(), folder);
            for (name, hint, endings, text) in [
                ("Name", "", &[][..], &mut self.name),
                ("Collars", "CSV of holes, X, Y, elevation, for surveys of drill holes", &TABLES[..], &mut self.collar),
                (
                    form::name_of(Setting::Columns),
                    "as the file says, or md, inc, azi, x, y, tvdss, -",
                    &[][..],
                    &mut self.columns,
                ),
                ("Tops", "CSV of measured depth and name; may stay empty", &TABLES[..], &mut self.tops),
                ("Logs", "LAS files, separated by semicolons; may stay empty", &["las"][..], &mut self.las),
                (
                    form::name_of(Setting::Checkshot),
                    "CSV of time and depth, where the survey is in time",
                    &TABLES[..],
                    &mut self.checkshot,
                ),
                (form::name_of(Setting::Datum), form::AS_FILE, &[][..], &mut self.kb),
                (form::name_of(Setting::Head), "as the file says, or of the first row", &[][..], &mut self.head),
                (form::name_of(Setting::WellInFile), "as above", &[][..], &mut self.in_file),
            ] {
                let label = ui.label(name);
                ui.horizontal(|ui| {
                    ui.add(TextEdit::singleline(text).hint_text(hint).desired_width(370.0)).labelled_by(label.id);
                    if !endings.is_empty() {
                        nearby(ui, &beside, endings, text);
                    }
                });
                ui.end_row();
            }
            let units = ZUnit::LENGTHS.map(|unit| (unit, unit.symbol()));
            form::choice(ui, Setting::MdUnit, &mut self.md_unit, "as the file says, or metres", &units);
            form::choice(ui, Setting::XyUnit, &mut self.xy_unit, "as the file says, or metres", &units);
        });
    }

    fn report(&self, ui: &mut Ui) {
        self.reading.with(|found| match found {
            None => drop(ui.add(Spinner::new())),
            Some((_, Err(notice))) => {
                ui.colored_label(ui.visuals().error_fg_color, &notice.text);
                notice.hint.iter().for_each(|hint| drop(ui.label(hint)));
            }
            Some((_, Ok(lines))) => lines.iter().for_each(|line| drop(ui.label(line))),
        });
    }

    /// The columns that are typed, or the word that is none.
    fn stated_columns(&self) -> Option<Result<Vec<WellColumn>, String>> {
        (!self.columns.trim().is_empty()).then(|| WellColumn::parse_list(self.columns.trim()))
    }

    /// The first entry that cannot be understood.
    fn unclear(&self) -> Option<String> {
        let options = self.options();
        if let Some(Err(unknown)) = self.stated_columns() {
            return Some(format!("“{unknown}” is no column of a well"));
        }
        let is_unclear = |text: &str, is_known: bool| !text.trim().is_empty() && !is_known;
        if is_unclear(&self.kb, options.datum_m.is_some()) {
            return Some(format!("“{}” is no height in metres", self.kb.trim()));
        }
        let head = is_unclear(&self.head, options.head.is_some());
        head.then(|| format!("“{}” is no X, Y in metres", self.head.trim()))
    }

    fn files(&self) -> WellFiles {
        let path = |text: &str| (!text.trim().is_empty()).then(|| PathBuf::from(text.trim()));
        WellFiles {
            deviation: self.deviation.clone(),
            collar: path(&self.collar),
            tops: path(&self.tops),
            las: self.las.split(';').filter_map(path).collect(),
            checkshot: path(&self.checkshot),
        }
    }

    fn options(&self) -> WellOptions {
        WellOptions {
            name: Some(self.name.trim().to_owned()),
            well_in_file: (!self.in_file.trim().is_empty()).then(|| self.in_file.trim().to_owned()),
            head: numbers(&self.head),
            datum_m: numbers(&self.kb).map(|[kb]: [f64; 1]| kb),
            md_unit: self.md_unit,
            xy_unit: self.xy_unit,
            columns: self.stated_columns().and_then(Result::ok),
        }
    }
}

/// This many finite numbers, separated by commas; `None` for any other text.
fn numbers<const N: usize>(text: &str) -> Option<[f64; N]> {
    let parsed: Option<Vec<f64>> =
        text.split(',').map(|part| part.trim().parse().ok().filter(|number: &f64| number.is_finite())).collect();
    parsed?.try_into().ok()
}

/// Offers the files beside the deviation; where several may be named, the chosen file is added to the list.
fn nearby(ui: &mut Ui, listing: &FolderListing, endings: &[&str], text: &mut String) {
    ui.menu_button("…", |ui| {
        let is_one = |name: &&String| endings.iter().any(|ending| name.to_lowercase().ends_with(&format!(".{ending}")));
        let names: Vec<&String> = listing.files.iter().filter(is_one).collect();
        if names.is_empty() {
            ui.weak(format!("{} has no such files", listing.folder.display()));
        }
        for name in names.into_iter().take(OFFERED) {
            if ui.button(name).clicked() {
                let path = listing.folder.join(name).display().to_string();
                let has_more = endings == ["las"] && !text.trim().is_empty();
                *text = if has_more { format!("{}; {path}", text.trim()) } else { path };
                ui.close();
            }
        }
    })
    .response
    .on_hover_text("Files beside the deviation");
}
