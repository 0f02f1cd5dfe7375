//! The palette of horizon colours.

use eframe::egui::containers::menu::MenuButton;
use eframe::egui::{Button, Color32, Grid, Role, Stroke, Ui, WidgetInfo, vec2};
use figure::style::HORIZON_COLOURS;
use ttf::Colour;

/// Colours offered besides those that horizons are given by default.
const MORE_COLOURS: [[u8; 3]; 4] = [[0xb8, 0xa8, 0x00], [0xc0, 0x18, 0x2c], [0x1b, 0x78, 0x37], [0x30, 0x30, 0x30]];

/// A button in the present colour that opens a palette of others.
pub(in crate::views) fn palette(ui: &mut Ui, colour: Colour, name: &str) -> Option<Colour> {
    let paint = |rgb: [u8; 3]| Color32::from_rgb(rgb[0], rgb[1], rgb[2]);
    let mut chosen = None;
    let button = Button::new("").fill(paint(colour.rgb)).min_size(vec2(16.0, 16.0));
    let named = ui.name_inputs(name, |ui| {
        MenuButton::from_button(button)
            .ui(ui, |ui| {
                Grid::new("colours").num_columns(4).spacing([4.0, 4.0]).show(ui, |ui| {
                    let offered = HORIZON_COLOURS.map(|colour| colour.rgb).into_iter().chain(MORE_COLOURS);
                    for (n, rgb) in offered.enumerate() {
                        let button = Button::new("").fill(paint(rgb)).stroke(Stroke::NONE).min_size(vec2(26.0, 20.0));
                        let offered = ui.add(button);
                        let (is_own, ordinal) = (rgb == colour.rgb, n + 1);
                        offered.widget_info(|| {
                            WidgetInfo::selected(Role::Button, true, is_own, format!("Colour {ordinal}"))
                        });
                        if offered.clicked() {
                            chosen = Some(Colour::new(rgb[0], rgb[1], rgb[2]));
                            ui.close();
                        }
                        if ordinal % 4 == 0 {
                            ui.end_row();
                        }
                    }
                });
            })
            .0
    });
    named.on_hover_text(name);
    chosen
}
