//! Controls that say why they do nothing.

use eframe::egui::{Response, Ui, Widget};

/// A control that is enabled unless there is an obstacle, which is then told under the pointer and to screen readers.
pub(crate) fn unless(ui: &mut Ui, obstacle: Option<&str>, control: impl Widget) -> Response {
    let response = ui.add_enabled(obstacle.is_none(), control);
    let Some(obstacle) = obstacle else { return response };
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_description(obstacle));
    response.on_disabled_hover_text(obstacle)
}

/// The obstacle if something is not so.
pub(crate) fn needs(is_so: bool, obstacle: &str) -> Option<&str> {
    (!is_so).then_some(obstacle)
}
