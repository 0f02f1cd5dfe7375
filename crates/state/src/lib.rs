//! What is open, selected and displayed, without a window.
//!
//! [`State::apply`] is the only way in which a state changes: it takes an [`Action`] (something the user did, or a
//! result from the workers) and returns [`Task`]s (something for the workers to do). Positions are voxels, sizes on the
//! screen points.

mod action;
mod apply;
pub mod camera;
mod dialogue;
pub mod faces;
pub mod fields;
mod hint;
pub mod last_session;
mod notice;
pub mod picking;
mod picking_faults;
mod picking_steps;
#[cfg(test)]
mod picking_tests;
mod session;
pub mod showing;
pub mod suggested;
mod view;
pub mod volume_rendering;

#[cfg(test)]
mod tests;

use render::Scene;

pub use action::{Action, Task};
pub use dialogue::{
    Choice, DataForm, Dialogue, ExportForm, FileContent, SectionFill, ShareForm, Shown, Target, Written,
};
pub use last_session::{Appearance, Remembered};
pub use notice::{Notice, Place};
pub use picking::{
    ChosenFault, FaultStep, How, Lasso, LassoOn, Look, Picking, PickingStep, PickingTask, StickPoint, Tool,
};
pub use review::ShareKind;
pub use session::{Session, Snapshot};
pub use view::{Blended, Compare, Hidden, Layout, Panel, SectionKind, SectionVolumes, StandardView, ViewState};

/// Everything that the window shows.
///
/// ```
/// use state::{Action, Remembered, Snapshot, State, Task};
/// use project::document::Document;
/// use survey::{SurveyGeometry, VerticalUnit};
///
/// let mut state = State::new(Remembered::default());
/// let tasks = state.apply(Action::Open("north.petro".into()));
/// assert!(matches!(&tasks[..], [Task::Open(_)]));
/// assert!(state.session.is_none(), "the workers have not read the project yet");
///
/// let geometry = SurveyGeometry::regular([40, 30, 20], 25.0, 4.0, VerticalUnit::Milliseconds);
/// let document = Document::empty(Some(geometry));
/// let snapshot = Snapshot { root: "north.petro".into(), document, history: Vec::new() };
/// state.apply(Action::Opened(Box::new(snapshot)));
/// assert_eq!(state.session.map(|session| session.name()), Some("north".to_owned()));
/// ```
#[derive(Debug, Clone, Default)]
pub struct State {
    /// What outlives the window: recent projects, appearance, the view of the last project.
    pub remembered: Remembered,
    /// The open project; `None` while the start page is shown.
    pub session: Option<Session>,
    /// The dialogue in front, if any.
    pub dialogue: Option<Dialogue>,
    /// The scene that is presented, and what was shown before, with its handles.
    pub presented: Option<(usize, Box<(Scene, bool)>)>,
    /// Messages, each with the place where it is shown; newest last.
    pub notices: Vec<Notice>,
}

impl State {
    /// The start page, with the settings of earlier runs.
    pub fn new(remembered: Remembered) -> Self {
        Self { remembered, ..Self::default() }
    }

    /// The messages of one place.
    pub fn notices_at(&self, place: Place) -> impl Iterator<Item = (usize, &Notice)> {
        self.notices.iter().enumerate().filter(move |(_, notice)| notice.place == place)
    }
}
