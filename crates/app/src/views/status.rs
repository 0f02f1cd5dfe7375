//! The status bar: what is under the cursor, and what is under way.

use super::pointer::{self, Pointed};
use crate::state::{Action, Place, State, Tool};
use crate::work::{Interpreted, RunningLine};
use eframe::egui::{Align, Label, Layout, ProgressBar, Ui};

/// Shows the status bar.
pub fn show(
    ui: &mut Ui,
    state: &State,
    (pointed, interpreted): (Option<&Pointed>, Option<&Interpreted>),
    running: &[RunningLine],
    (is_drawing, device): (bool, &str),
    actions: &mut Vec<Action>,
) {
    ui.horizontal(|ui| {
        let session = state.session.as_ref();
        if let (Some(session), Some(pointed)) = (session, pointed) {
            ui.label(pointer::sentence(pointed, &session.document));
            if let Some(shown) =
                interpreted.filter(|shown| shown.key.is_some() && session.view.picking.tool == Tool::Pick)
            {
                let has = |leaf: u32| {
                    let holds = shown.horizons.iter().find(|horizon| horizon.leaves.contains(&leaf));
                    holds.map(|horizon| horizon.name.clone())
                };
                ui.separator();
                ui.add(Label::new(pointer::picked(pointed, has)).truncate());
            }
        } else if let Some(session) = session {
            ui.weak(session.root.display().to_string());
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            for line in running {
                if ui.button("Stop").on_hover_text(format!("Stop: {}", line.job)).clicked() {
                    line.progress.cancel();
                }
                let bar = match line.share() {
                    Some(share) => ProgressBar::new(share).show_percentage(),
                    None => ProgressBar::new(0.0),
                };
                ui.add(bar.desired_width(110.0));
                let text =
                    if line.stage.is_empty() { line.job.to_string() } else { format!("{}: {}", line.job, line.stage) };
                ui.label(text);
            }
            if let Some((index, notice)) = state.notices_at(Place::Foot).last() {
                if ui.button("Dismiss").clicked() {
                    actions.push(Action::Dismiss(index));
                }
                ui.add(Label::new(&notice.text).truncate());
            } else if running.is_empty() && is_drawing {
                // No spinner: on a processor that draws both, each of its frames would take time from the picture.
                ui.label("Drawing…");
            } else if running.is_empty() && !device.is_empty() {
                ui.weak(format!("drawn by {device}"));
            }
        });
    });
}
