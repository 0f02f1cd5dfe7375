//! The dialogue that shows how a survey would be read: geometry, evidence, a map of the traces, a section. Header bytes
//! can be changed, and the effect shows at once.

use super::{notices, texture};
use crate::state::{Action, Place, State, Target};
use crate::widgets::dialogue;
use crate::widgets::form;
use crate::widgets::keyboard::is_entered;
use crate::widgets::obstacle::{needs, unless};
use crate::widgets::theme;
use crate::work::Work;
use crate::work::scan::{self, Reading, SurveyScan};
use eframe::egui::{
    Align, Button, CollapsingHeader, Color32, ComboBox, Context, DragValue, Grid, Layout, Mesh, Pos2, Rect, Role,
    ScrollArea, Sense, Shape, Spinner, TextEdit, TextureHandle, TextureOptions, Ui, WidgetInfo, pos2, vec2,
};
use files::ZUnit;
use files::segy::{KeptDuplicate, LengthUnit, LineSource, SegyInfo, SegyOptions, TraceWeight};
use glam::DVec2;
use image::RgbaImage;
use project::command::ImportVolume;
use project::document::Polarity;
use state::fields;
use std::path::{Path, PathBuf};
use survey::{Setting, SurveyGeometry};

/// The text of a field whose value is detected in the file.
const AS_FOUND: &str = "as found";

/// Left-aligned lines: justified columns would stretch the words over their width.
fn from_left() -> Layout {
    Layout::top_down(Align::Min)
}

/// Width of the buttons beside the path of a new project, points.
const BUTTONS: f32 = 190.0;

/// Room between the form and its scroll bar, points.
const BESIDE_BAR: f32 = 12.0;

/// Width of the labels in front of the fields, points: one column for all of them.
const LABELS: f32 = 118.0;

/// The dialogue.
#[derive(Default)]
pub struct Import {
    path: PathBuf,
    options: SegyOptions,
    /// What is typed for the amplitude that stands for no data.
    null: String,
    name: String,
    polarity: Polarity,
    root: String,
    reading: Reading<SegyOptions, SurveyScan>,
    /// Number of the scan that the textures were made from.
    textures: Option<(u64, TextureHandle, TextureHandle)>,
}

impl Import {
    /// Shows the dialogue.
    pub fn show(
        &mut self,
        ctx: &Context,
        state: &State,
        work: &Work,
        path: &Path,
        target: Target,
        actions: &mut Vec<Action>,
    ) {
        if self.path != path {
            let root = path.with_extension("petro").display().to_string();
            *self = Self { path: path.to_owned(), root, ..Self::default() };
        }
        let (path_read, options) = (self.path.clone(), self.options.clone());
        self.reading.follow(ctx, work, "Reading the headers", &self.options, move |progress| {
            scan::survey(&path_read, &options, progress)
        });
        let room = ctx.content_rect().size();
        let modal = dialogue::show(ctx, "import", |ui| {
            ui.set_width((room.x - 120.0).clamp(560.0, 1040.0));
            let file = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
            ui.heading(format!("Read {file}"));
            notices::show(ui, state, Place::Dialogue, actions);
            let height = (room.y - 290.0).max(240.0);
            ui.columns_const(|[left, right]: &mut [Ui; 2]| {
                ScrollArea::vertical()
                    .id_salt("reading")
                    // The dialogue keeps its size whatever is read, so that no field moves from under the pointer.
                    .auto_shrink([true, false])
                    .max_height(height)
                    .min_scrolled_height(height)
                    .show(left, |ui| {
                        ui.set_max_width(ui.available_width() - BESIDE_BAR);
                        ui.with_layout(from_left(), |ui| self.form(ui))
                    });
                ScrollArea::vertical()
                    .id_salt("evidence")
                    .auto_shrink([true, false])
                    .max_height(height)
                    .min_scrolled_height(height)
                    .show(right, |ui| ui.with_layout(from_left(), |ui| self.evidence(ui)));
            });
            ui.separator();
            self.target(ui, state, target, actions);
        });
        if modal.should_close() {
            actions.push(Action::Answered);
        }
        if actions.iter().any(|action| matches!(action, Action::Answered)) {
            self.path = PathBuf::new();
        }
    }

    /// The settings that can be stated about the file, beside the values that were detected.
    fn form(&mut self, ui: &mut Ui) {
        let options = &mut self.options;
        let name = &mut self.name;
        let null = &mut self.null;
        let polarity = &mut self.polarity;
        self.reading.with(|found| {
            let found = found.map(|(_, found)| found);
            let info = found.and_then(|found| found.as_ref().ok()).map(|scan| &scan.info);
            // The field that an error asks for must be visible.
            let is_refused = matches!(found, Some(Err(_)));
            ui.strong("Header bytes");
            Grid::new("bytes").num_columns(3).spacing([12.0, 7.0]).show(ui, |ui| {
                let bytes = info.map(|info| info.byte_positions);
                byte(ui, Setting::InlineByte, &mut options.inline_byte, bytes.and_then(|bytes| bytes.inline));
                byte(ui, Setting::CrosslineByte, &mut options.crossline_byte, bytes.and_then(|bytes| bytes.crossline));
                byte(ui, Setting::XByte, &mut options.x_byte, bytes.and_then(|bytes| bytes.x));
                byte(ui, Setting::YByte, &mut options.y_byte, bytes.and_then(|bytes| bytes.y));
            });
            ui.add_space(6.0);
            Grid::new("units").num_columns(2).min_col_width(LABELS).spacing([12.0, 7.0]).show(ui, |ui| {
                let found = info.map_or(AS_FOUND.to_owned(), |info| format!("{} (found)", info.vertical_unit.symbol()));
                let units = [ZUnit::Milliseconds, ZUnit::Metres, ZUnit::Feet, ZUnit::SurveyFeet]
                    .map(|unit| (unit, unit.symbol()));
                form::choice(ui, Setting::VerticalUnit, &mut options.vertical_unit, &found, &units);
                let combo = ComboBox::from_id_salt("polarity").selected_text(polarity.to_string());
                let both = [Polarity::Normal, Polarity::Reverse].map(|choice| (choice, choice.to_string()));
                form::chosen(ui, "Polarity", combo, polarity, both);
                let field = TextEdit::singleline(name).hint_text("seismic").desired_width(160.0);
                form::row(ui, "Name", |ui| ui.add(field));
            });
            CollapsingHeader::new("More").open(is_refused.then_some(true)).show(ui, |ui| more(ui, options, null));
            if *options != SegyOptions::default()
                && ui.button("Detect again").on_hover_text("Forget what was typed").clicked()
            {
                *options = SegyOptions::default();
                null.clear();
            }
            if let Some(info) = info {
                ui.add_space(10.0);
                candidates(ui, info, options);
                summary(ui, info);
            }
        });
    }

    fn evidence(&mut self, ui: &mut Ui) {
        let textures = &mut self.textures;
        self.reading.with(|found| match found {
            None => {
                ui.add(Spinner::new());
                ui.label("Reading the headers…");
            }
            Some((_, Err(notice))) => {
                ui.colored_label(ui.visuals().error_fg_color, &notice.text);
                if let Some(hint) = &notice.hint {
                    ui.label(hint);
                }
            }
            Some((number, Ok(scan))) => {
                let is_new = textures.as_ref().is_none_or(|(of, ..)| *of != number);
                if is_new {
                    *textures = Some((number, load(ui, "traces", &scan.traces), load(ui, "inline", &scan.inline)));
                }
                if let Some((_, traces, inline)) = textures {
                    ui.strong("Where the traces are, north up");
                    map(ui, traces, &scan.geometry);
                    let middle = scan.geometry.inlines.number_at((scan.geometry.inlines.count / 2) as f64);
                    ui.strong(format!("Inline {middle:.0}"));
                    picture(ui, inline, "Middle inline");
                }
                for warning in &scan.info.warnings {
                    ui.colored_label(ui.visuals().warn_fg_color, fields::note(warning));
                }
                for assumption in &scan.info.assumptions {
                    ui.label(format!("Assumed: {}", fields::note(assumption)));
                }
                for line in &scan.info.evidence {
                    ui.weak(fields::note(line));
                }
            }
        });
    }

    fn target(&mut self, ui: &mut Ui, state: &State, target: Target, actions: &mut Vec<Action>) {
        let can = self.reading.is_good(&self.options);
        ui.horizontal(|ui| {
            if target == Target::NewProject {
                let label = ui.label("Project");
                let room = (ui.available_width() - BUTTONS).max(200.0);
                ui.add(TextEdit::singleline(&mut self.root).desired_width(room)).labelled_by(label.id);
            } else if let Some(session) = &state.session {
                ui.label(format!("Into {}", session.name()));
            }
            let verb = if target == Target::NewProject { "Create project" } else { "Import" };
            if unless(ui, needs(can, "The file has to be readable as stated above"), Button::new(verb)).clicked()
                || can && is_entered(ui)
            {
                let name = self.name.trim();
                let command = Box::new(ImportVolume {
                    path: self.path.clone(),
                    name: (!name.is_empty()).then(|| name.to_owned()),
                    polarity: self.polarity,
                    options: self.options.clone(),
                    memory_bytes: None,
                    moved: false,
                    origin: None,
                });
                let into = (target == Target::NewProject).then(|| PathBuf::from(self.root.trim()));
                actions.push(Action::Import { command, into });
            }
            if ui.button("Cancel").clicked() {
                actions.push(Action::Answered);
            }
        });
    }
}

/// A byte position: the detected one, until another is typed.
fn byte(ui: &mut Ui, setting: Setting, option: &mut Option<u16>, found: Option<u16>) {
    let named = ui.horizontal(|ui| {
        ui.set_min_width(LABELS);
        ui.label(form::name_of(setting))
    });
    let label = named.inner;
    let mut value = option.or(found).unwrap_or(0);
    let drag = DragValue::new(&mut value).speed(0.3).range(0..=237);
    if ui.add(drag).labelled_by(label.id).on_hover_text("First byte in the trace header, 1 to 237").changed()
        && value > 0
    {
        *option = Some(value);
    }
    match (option.is_some(), found) {
        (true, _) => ui.label("stated"),
        (false, Some(_)) => ui.weak("found"),
        (false, None) => ui.weak("none"),
    };
    ui.end_row();
}

/// Settings that seldom need to be stated.
fn more(ui: &mut Ui, options: &mut SegyOptions, null: &mut String) {
    Grid::new("more").num_columns(2).min_col_width(LABELS - ui.spacing().indent).spacing([12.0, 7.0]).show(ui, |ui| {
        form::number(ui, Setting::Interval, &mut options.interval);
        form::number(ui, Setting::Start, &mut options.start);
        let units = LengthUnit::ALL.map(|unit| (unit, unit.symbol()));
        form::choice(ui, Setting::CoordinateUnit, &mut options.coordinate_unit, AS_FOUND, &units);
        let mut scalar = options.coordinate_scalar.map(f64::from);
        form::number(ui, Setting::CoordinateScalar, &mut scalar);
        options.coordinate_scalar = scalar.map(|scalar| scalar.round() as i16);
        form::number(ui, Setting::Bin, &mut options.bin_m);
        let sources = [
            (LineSource::Headers, "in the headers"),
            (LineSource::Coordinates, "along X and Y"),
            (LineSource::CoordinatesSwapped, "along X and Y, exchanged"),
        ];
        form::one_of(ui, Setting::LineNumbers, &mut options.line_source, &sources);
        let kept = [(KeptDuplicate::First, "the first is kept"), (KeptDuplicate::Last, "the last is kept")];
        form::choice(ui, Setting::Duplicates, &mut options.duplicates, "the first, if they are few", &kept);
        let weights = [
            (TraceWeight::Apply, "divide by 2^N"),
            (TraceWeight::Inverse, "multiply by 2^N"),
            (TraceWeight::Ignore, "ignore it"),
        ];
        form::one_of(ui, Setting::TraceWeight, &mut options.trace_weight, &weights);
        let field = TextEdit::singleline(null).hint_text(AS_FOUND).desired_width(110.0);
        let typed = form::row(ui, form::name_of(Setting::NullAmplitude), |ui| {
            ui.add(field).on_hover_text("The amplitude that stands for no data, or none")
        });
        if typed.changed() {
            // What is no number yet states nothing.
            options.null = null.parse().ok();
        }
    });
}

/// Other readings of the line numbers that were considered; each can be chosen.
fn candidates(ui: &mut Ui, info: &SegyInfo, options: &mut SegyOptions) {
    ui.strong("Other readings");
    for candidate in &info.candidates {
        let bytes = [candidate.inline_byte, candidate.crossline_byte];
        let is_taken = bytes.map(Some) == [info.byte_positions.inline, info.byte_positions.crossline];
        ui.horizontal_wrapped(|ui| {
            if is_taken {
                ui.strong("In use:");
            } else if ui.button("Use").on_hover_text(format!("Read bytes {} and {}", bytes[0], bytes[1])).clicked() {
                (options.inline_byte, options.crossline_byte) = (Some(bytes[0]), Some(bytes[1]));
            }
            ui.label(candidate.as_sentence());
        });
    }
}

fn summary(ui: &mut Ui, info: &SegyInfo) {
    ui.add_space(8.0);
    ui.strong("The volume");
    let unit = info.vertical_unit.symbol();
    let last = info.start + info.interval * info.samples.saturating_sub(1) as f64;
    for line in [
        format!("inlines {}, crosslines {}", info.inlines, info.crosslines),
        format!("{} samples of {} {unit}, {} to {last} {unit}", info.samples, info.interval, info.start),
        format!(
            "{} traces, {} missing, {} dead, {} repeated",
            info.traces, info.missing_traces, info.dead_traces, info.duplicate_traces
        ),
        format!("format code {}, revision {}", info.format_code, info.revision),
    ] {
        ui.label(line);
    }
}

fn load(ui: &Ui, name: &str, image: &RgbaImage) -> TextureHandle {
    ui.ctx().load_texture(name, texture::pixels(image), TextureOptions::LINEAR)
}

fn picture(ui: &mut Ui, texture: &TextureHandle, name: &str) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), 170.0), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, name));
    let uv = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
    ui.painter().image(texture.id(), rect, uv, Color32::WHITE);
}

/// The lattice at its place in the world, with one scale for both axes.
fn map(ui: &mut Ui, texture: &TextureHandle, geometry: &SurveyGeometry) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), 190.0), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, "Map of the traces"));
    let [inlines, crosslines, _] = geometry.size().map(|count| count.saturating_sub(1) as f64);
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let world =
        corners.map(|[u, v]| geometry.inline_vector * (u * inlines) + geometry.crossline_vector * (v * crosslines));
    let low = world.into_iter().fold(DVec2::INFINITY, DVec2::min);
    let high = world.into_iter().fold(DVec2::NEG_INFINITY, DVec2::max);
    let extent = (high - low).max(DVec2::splat(1e-6));
    let room = rect.shrink(16.0);
    let scale = (f64::from(room.width()) / extent.x).min(f64::from(room.height()) / extent.y);
    let place = |at: DVec2| -> Pos2 {
        let off = (at - (low + high) * 0.5) * scale;
        room.center() + vec2(off.x as f32, -off.y as f32)
    };
    let mut mesh = Mesh::with_texture(texture.id());
    for ([u, v], at) in corners.into_iter().zip(world) {
        mesh.vertices.push(eframe::egui::epaint::Vertex {
            pos: place(at),
            uv: pos2(u as f32, v as f32),
            color: Color32::WHITE,
        });
    }
    mesh.indices = vec![0, 1, 2, 0, 2, 3];
    ui.painter().add(Shape::mesh(mesh));
    let first = geometry.origin;
    let text = format!(
        "inline {}, crossline {}: X {:.0} m, Y {:.0} m",
        geometry.inlines.first, geometry.crosslines.first, first.x, first.y
    );
    ui.painter().circle_filled(place(world[0]), 4.0, theme::accent(ui.visuals()));
    ui.weak(format!("dot: {text}"));
}
