//! The dialogue that shows how a horizon or fault file would be read: unit, sign, factor, and the values found, before
//! it is added.

use super::layers::contact_name;
use super::notices;
use crate::state::{Action, FileContent, Place, Session, State};
use crate::widgets::dialogue;
use crate::widgets::form;
use crate::widgets::keyboard::is_entered;
use crate::widgets::obstacle::{needs, unless};
use crate::work::Work;
use crate::work::scan::{self, InterpretationScan, Reading};
use eframe::egui::{Button, CollapsingHeader, ComboBox, Context, DragValue, Grid, ScrollArea, Spinner, TextEdit, Ui};
use files::{Column, Format, HorizonShape, ImportOptions, PlaceBy, ValueOrder, ZPositive, ZUnit};
use project::command::{AddFault, AddHorizon, Age, Command};
use std::path::{Path, PathBuf};
use survey::{Contact, Setting};

/// The dialogue.
#[derive(Default)]
pub struct Interpretation {
    path: PathBuf,
    name: String,
    options: ImportOptions,
    /// The text of the columns field.
    columns: String,
    /// The name of the surface to add, if the file holds several.
    chosen: Option<String>,
    contact: Contact,
    /// Where a horizon goes in the column.
    age: Age,
    truncated_by: Option<String>,
    /// Metres by which the fault reaches beyond what was drawn.
    grown_m: f64,
    reading: Reading<ImportOptions, InterpretationScan>,
}

impl Interpretation {
    /// Shows the dialogue.
    #[expect(clippy::too_many_arguments, reason = "a panel is handed the parts of the window it needs, and no others")]
    pub fn show(
        &mut self,
        ctx: &Context,
        state: &State,
        session: &Session,
        work: &Work,
        path: &Path,
        kind: FileContent,
        actions: &mut Vec<Action>,
    ) {
        if self.path != path {
            let name = path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
            *self = Self { path: path.to_owned(), name, ..Self::default() };
        }
        if let Some(geometry) = session.document.geometry.clone() {
            let (file, options) = (self.path.clone(), self.options.clone());
            self.reading.follow(ctx, work, "Reading the file", &self.options, move |_| match kind {
                FileContent::Fault => scan::fault(&file, &geometry, &options),
                FileContent::Horizon => scan::horizon(&file, &geometry, &options),
            });
        }
        let modal = dialogue::show(ctx, "interpretation", |ui| {
            ui.set_width(620.0);
            ui.heading(if kind == FileContent::Fault { "Add a fault" } else { "Add a horizon" });
            ui.weak(path.display().to_string());
            notices::show(ui, state, Place::Dialogue, actions);
            self.form(ui, session, kind);
            ui.separator();
            let height = (ctx.content_rect().height() - 460.0).clamp(90.0, 260.0);
            ScrollArea::vertical()
                .max_height(height)
                .min_scrolled_height(height)
                .auto_shrink(false)
                .show(ui, |ui| self.report(ui));
            ui.separator();
            ui.horizontal(|ui| {
                let can = !self.name.trim().is_empty() && self.reading.is_good(&self.options);
                if unless(
                    ui,
                    needs(can, "Give it a name; the file has to be readable as stated above"),
                    Button::new("Add"),
                )
                .clicked()
                    || can && is_entered(ui)
                {
                    actions.push(Action::Apply(Box::new(self.command(kind))));
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
            self.path = PathBuf::new();
        }
    }

    fn form(&mut self, ui: &mut Ui, session: &Session, kind: FileContent) {
        Grid::new("interpretation").num_columns(2).spacing([12.0, 8.0]).show(ui, |ui| {
            form::row(ui, "Name", |ui| ui.add(TextEdit::singleline(&mut self.name).desired_width(240.0)));
            let units = ZUnit::ALL.map(|unit| (unit, unit.symbol()));
            form::choice(ui, Setting::ZUnit, &mut self.options.z_unit, form::AS_FILE, &units);
            let signs = [(ZPositive::Down, "positive down"), (ZPositive::Up, "positive up")];
            form::choice(ui, Setting::ZPositive, &mut self.options.z_positive, form::AS_FILE, &signs);
            let factor = DragValue::new(&mut self.options.z_factor).speed(0.01);
            form::row(ui, form::name_of(Setting::ZFactor), |ui| ui.add(factor));
            if kind == FileContent::Fault {
                let combo = ComboBox::from_id_salt("ends at");
                let combo = combo.selected_text(self.truncated_by.as_deref().unwrap_or("nothing"));
                let faults = session.document.faults.iter().map(|fault| (Some(fault.name.clone()), &*fault.name));
                let choices = [(None, "nothing")].into_iter().chain(faults);
                form::chosen(ui, "Ends at", combo, &mut self.truncated_by, choices);
                let label = ui.label("Reaches farther by").on_hover_text(
                    "A fault ends where it was drawn. So many metres more on every side where it was drawn too short",
                );
                let metres = DragValue::new(&mut self.grown_m).range(0.0..=100_000.0).speed(5.0).suffix(" m");
                ui.add(metres).labelled_by(label.id);
            } else {
                self.horizon_rows(ui, session);
            }
            ui.end_row();
        });
        // The field that an error asks for must be visible.
        let is_refused = self.reading.with(|found| matches!(found, Some((_, Err(_)))));
        CollapsingHeader::new("More").open(is_refused.then_some(true)).show(ui, |ui| self.more(ui));
    }

    /// What is stated of a horizon alone.
    fn horizon_rows(&mut self, ui: &mut Ui, session: &Session) {
        let combo = ComboBox::from_id_salt("contact").selected_text(contact_name(self.contact));
        let contacts = Contact::ALL.map(|contact| (contact, contact_name(contact)));
        form::chosen(ui, "Contact", combo, &mut self.contact, contacts);
        let combo = ComboBox::from_id_salt("age").selected_text(age_name(&self.age));
        let names = || session.document.horizons.iter().map(|horizon| horizon.name.clone());
        let ages = [Age::ByDepth].into_iter().chain(names().map(Age::Above)).chain(names().map(Age::Below));
        let named = ages.map(|age| {
            let name = age_name(&age);
            (age, name)
        });
        form::chosen(ui, "Place in the column", combo, &mut self.age, named);
        let label = ui.label("Shape").on_hover_text(
            "A map has one depth at a place in each fault block. A surface of any shape may be overturned, or a body",
        );
        ui.label_inputs_by(label.id, |ui| {
            let name = |shape: Option<HorizonShape>| match shape {
                None => "as it is found",
                Some(HorizonShape::Map) => "a map",
                Some(HorizonShape::Any) => "any shape",
            };
            ComboBox::from_id_salt("shape").selected_text(name(self.options.shape)).show_ui(ui, |ui| {
                for shape in [None, Some(HorizonShape::Map), Some(HorizonShape::Any)] {
                    ui.selectable_value(&mut self.options.shape, shape, name(shape));
                }
            });
        });
    }

    /// Settings that seldom need to be stated.
    fn more(&mut self, ui: &mut Ui) {
        let options = &mut self.options;
        Grid::new("more").num_columns(2).spacing([12.0, 8.0]).show(ui, |ui| {
            let formats: Vec<(Format, &str)> = Format::all().map(|format| (format, format.name())).collect();
            form::choice(ui, Setting::Format, &mut options.format, form::AS_FILE, &formats);
            form::text(ui, Setting::Columns, "inline, crossline, x, y, z, name, stick or -", &mut self.columns);
            match Column::parse_list(self.columns.trim()) {
                _ if self.columns.trim().is_empty() => options.columns = None,
                Ok(columns) => options.columns = Some(columns),
                Err(unknown) => {
                    ui.label("");
                    ui.colored_label(ui.visuals().error_fg_color, format!("“{unknown}” is no column"));
                    ui.end_row();
                }
            }
            let lengths = ZUnit::LENGTHS.map(|unit| (unit, unit.symbol()));
            form::choice(ui, Setting::XyUnit, &mut options.xy_unit, form::AS_FILE, &lengths);
            form::number(ui, Setting::Null, &mut options.null);
            let by = [(PlaceBy::Lines, "line numbers"), (PlaceBy::World, "X and Y")];
            form::choice(ui, Setting::PlaceBy, &mut options.place_by, "line numbers, if X and Y agree", &by);
            let orders = [(ValueOrder::Columns, "columns"), (ValueOrder::Rows, "rows")];
            form::choice(ui, Setting::ValueOrder, &mut options.value_order, "whichever is smoother", &orders);
        });
    }

    fn report(&mut self, ui: &mut Ui) {
        let (name, chosen) = (&mut self.name, &mut self.chosen);
        self.reading.with(|found| match found {
            None => {
                ui.add(Spinner::new());
            }
            Some((_, Err(notice))) => {
                ui.colored_label(ui.visuals().error_fg_color, &notice.text);
                if let Some(hint) = &notice.hint {
                    ui.label(hint);
                }
            }
            Some((_, Ok(scan))) => {
                for (surface, report) in &scan.surfaces {
                    let is_chosen = chosen.as_ref() == Some(surface);
                    if scan.surfaces.len() > 1 && ui.selectable_label(is_chosen, surface).clicked() {
                        name.clone_from(surface);
                        *chosen = Some(surface.clone());
                    }
                    ui.label(report.trim_end());
                }
            }
        });
    }

    fn command(&self, kind: FileContent) -> Command {
        let (path, name) = (self.path.clone(), self.name.trim().to_owned());
        let options = ImportOptions { select: self.chosen.clone(), ..self.options.clone() };
        if kind == FileContent::Fault {
            let (truncated_by, grown_m) = (self.truncated_by.clone(), self.grown_m);
            Command::AddFault(AddFault { path, name, truncated_by, grown_m, options })
        } else {
            Command::AddHorizon(AddHorizon { path, name, contact: self.contact, age: self.age.clone(), options })
        }
    }
}

fn age_name(age: &Age) -> String {
    match age {
        Age::ByDepth => "by its depth".to_owned(),
        Age::Above(name) => format!("just above {name}"),
        Age::Below(name) => format!("just below {name}"),
    }
}
