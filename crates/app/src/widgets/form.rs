//! Rows of the dialogues' forms: the name of a setting, and its stated value or that of the file.

use eframe::egui::{Align, ComboBox, DragValue, Layout, Response, TextEdit, Ui, WidgetText, vec2};
use state::fields::field;
use survey::Setting;

/// Width of the column of labels that fields of a panel stand beside, points.
pub(crate) const LABELS: f32 = 100.0;

/// A label in the column of labels, outside a grid.
pub fn label(ui: &mut Ui, name: &str) -> Response {
    let spacing = ui.spacing().interact_size.y;
    ui.allocate_ui_with_layout(vec2(LABELS, spacing), Layout::left_to_right(Align::Center), |ui| {
        ui.set_min_width(LABELS);
        ui.label(name)
    })
    .inner
}

/// A row of a grid: its name, and the field that it labels.
pub fn row(ui: &mut Ui, name: &str, field: impl FnOnce(&mut Ui) -> Response) -> Response {
    let label = ui.label(name);
    let response = field(ui).labelled_by(label.id);
    ui.end_row();
    response
}

/// A row of a grid in which one of these values is chosen.
pub fn chosen<T: PartialEq, N: Into<WidgetText>>(
    ui: &mut Ui,
    name: &str,
    combo: ComboBox,
    value: &mut T,
    choices: impl IntoIterator<Item = (T, N)>,
) {
    let label = ui.label(name);
    ui.label_inputs_by(label.id, |ui| {
        combo.show_ui(ui, |ui| {
            for (choice, name) in choices {
                ui.selectable_value(value, choice, name.into());
            }
        });
    });
    ui.end_row();
}

/// The text of a field whose value is taken from the file.
pub(crate) const AS_FILE: &str = "as the file says";

/// The name of a setting's field.
pub(crate) fn name_of(setting: Setting) -> &'static str {
    field(setting).unwrap_or_else(|| setting.name())
}

/// A choice that may be left to the file, which is then shown as `unstated`.
pub fn choice<T: Copy + PartialEq>(
    ui: &mut Ui,
    setting: Setting,
    value: &mut Option<T>,
    unstated: &str,
    choices: &[(T, &str)],
) {
    let name = name_of(setting);
    let shown = choices.iter().find(|(choice, _)| Some(*choice) == *value).map_or(unstated, |(_, name)| name);
    let stated = choices.iter().map(|(choice, name)| (Some(*choice), *name));
    let combo = ComboBox::from_id_salt(name).selected_text(shown);
    chosen(ui, name, combo, value, [(None, unstated)].into_iter().chain(stated));
}

/// A choice that always has a value.
pub(crate) fn one_of<T: Copy + PartialEq>(ui: &mut Ui, setting: Setting, value: &mut T, choices: &[(T, &str)]) {
    let name = name_of(setting);
    let shown = choices.iter().find(|(choice, _)| choice == value).map_or("", |(_, name)| name);
    chosen(ui, name, ComboBox::from_id_salt(name).selected_text(shown), value, choices.iter().copied());
}

/// A number that may be left to the file.
pub fn number(ui: &mut Ui, setting: Setting, value: &mut Option<f64>) {
    let label = ui.label(name_of(setting));
    ui.horizontal(|ui| {
        let mut typed = value.unwrap_or(0.0);
        let is_stated = value.is_some();
        let drag = DragValue::new(&mut typed).speed(0.1).custom_formatter(|number, decimals| {
            if is_stated {
                eframe::egui::emath::format_with_decimals_in_range(number, decimals)
            } else {
                AS_FILE.to_owned()
            }
        });
        if ui.add(drag).labelled_by(label.id).changed() {
            *value = Some(typed);
        }
        if is_stated && ui.button("×").on_hover_text(format!("{}: {AS_FILE}", name_of(setting))).clicked() {
            *value = None;
        }
    });
    ui.end_row();
}

/// A line of text.
pub fn text(ui: &mut Ui, setting: Setting, hint: &str, text: &mut String) {
    row(ui, name_of(setting), |ui| ui.add(TextEdit::singleline(text).hint_text(hint).desired_width(240.0)));
}
