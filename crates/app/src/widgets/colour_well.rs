//! A button that shows and changes a colour.

use eframe::egui::Ui;

/// A button that shows and changes a colour. It is given a name for screen readers, because egui gives it none.
pub(crate) fn colour_well(ui: &mut Ui, name: &str, rgb: &mut [u8; 3]) {
    let id = ui.color_edit_button_srgb(rgb).on_hover_text(name).id;
    ui.ctx().accesskit_node_builder(id, |node| node.set_label(name));
}
