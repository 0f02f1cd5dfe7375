//! What is open, selected and looked at, without a window.
//!
//! [`State::apply`] is the only way a state changes: an [`Action`] (something the user did, or an answer of the workers) in,
//! [`Task`]s (something the workers are to do) out. Positions are voxel, sizes on the screen points.

mod action;
mod apply;
pub mod camera;
mod dialogue;
pub mod faces;
mod notice;
pub mod picking;
mod picking_steps;
#[cfg(test)]
mod picking_tests;
pub mod remembered;
mod session;
pub mod showing;
pub mod through;
mod view;

#[cfg(test)]
mod tests;

pub use action::{Action, Task};
pub use dialogue::{Choice, Dialogue, ExportForm, Interpreted, Shown, Target};
pub use notice::{Notice, Place};
pub use picking::{How, Lasso, LassoOn, Look, Picking, PickingStep, PickingTask, Tool};
pub use remembered::{Appearance, Remembered};
pub use session::{Session, Snapshot};
pub use view::{Compare, Layout, Panel, SectionKind, StandardView, View};

/// Everything the window shows.
#[derive(Debug, Clone, Default)]
pub struct State {
    /// What outlives the window: recent projects, appearance, how the last one was left.
    pub remembered: Remembered,
    /// The open project; without one the start page is shown.
    pub session: Option<Session>,
    /// What is asked for at present.
    pub dialogue: Option<Dialogue>,
    /// What went wrong or is worth knowing, where it happened; newest last.
    pub notices: Vec<Notice>,
}

impl State {
    /// A start page that knows what was open before.
    pub fn new(remembered: Remembered) -> Self {
        Self { remembered, ..Self::default() }
    }

    /// Notices of one place.
    pub fn notices_at(&self, place: Place) -> impl Iterator<Item = (usize, &Notice)> {
        self.notices.iter().enumerate().filter(move |(_, notice)| notice.place == place)
    }
}
