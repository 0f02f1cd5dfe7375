//! States without a window.

use super::*;
use project::HistoryLine;
use project::document::Document;
use survey::{SurveyGeometry, VerticalUnit};

fn snapshot(root: &str) -> Box<Snapshot> {
    let geometry = SurveyGeometry::regular([40, 30, 20], 25.0, 4.0, VerticalUnit::Milliseconds);
    let mut document = Document::empty(Some(geometry));
    document.step = 1;
    let line = |step, summary: &str| HistoryLine { step, summary: summary.into(), in_effect: step <= 1 };
    let history = vec![line(0, "create"), line(1, "velocity 2500"), line(2, "scene a")];
    Box::new(Snapshot { root: root.into(), document, history })
}

pub(super) fn open() -> State {
    let mut state = State::default();
    state.apply(Action::Opened(snapshot("a.petro")));
    state
}

#[test]
fn opening_remembers_the_project_and_marks_it_as_open() {
    let mut state = State::default();
    assert!(matches!(state.apply(Action::Open("a.petro".into()))[..], [Task::Open(_)]));
    assert!(state.session.is_none(), "it is open when it has been read, not when it is asked for");
    assert!(matches!(state.apply(Action::Opened(snapshot("a.petro")))[..], [Task::Remember]));
    assert_eq!(state.remembered.recent, [std::path::Path::new("a.petro")]);
    assert!(state.remembered.left.is_some());
    state.apply(Action::Close);
    assert!(state.session.is_none() && state.remembered.left.is_none());
}

#[test]
fn recovery_opens_the_project_as_it_was_looked_at() {
    let mut state = open();
    state.apply(Action::Slices([3.0, 4.0, 5.0]));
    state.apply(Action::Arrange(Layout::Sections));
    state.mark();
    let mut next = State::new(state.remembered.clone());
    assert!(matches!(&next.apply(Action::Recover)[..], [Task::Open(root)] if root.ends_with("a.petro")));
    next.apply(Action::Opened(snapshot("a.petro")));
    let view = &next.session.as_ref().unwrap().view;
    assert_eq!((view.slices, view.layout), ([3.0, 4.0, 5.0], Layout::Sections));
}

#[test]
fn undo_and_redo_say_what_they_would_do() {
    let state = open();
    let session = state.session.as_ref().unwrap();
    assert_eq!((session.undoable(), session.redoable()), (Some("velocity 2500"), Some("scene a")));
}

#[test]
fn without_a_project_undo_and_camera_ask_for_nothing() {
    let mut state = State::default();
    assert!(state.apply(Action::Undo).is_empty());
    assert!(state.apply(Action::Stand(StandardView::Top)).is_empty());
}

#[test]
fn a_scene_without_a_picture_is_not_shown() {
    let mut state = open();
    let before = state.session.as_ref().unwrap().view.scene.clone();
    let bad = Scene { exaggeration: -1.0, ..before.clone() };
    state.apply(Action::Show(Box::new(bad)));
    assert_eq!(state.session.as_ref().unwrap().view.scene, before);
}

#[test]
fn sections_stay_in_the_survey_and_on_samples() {
    let mut state = open();
    state.apply(Action::Slices([99.0, -3.0, 7.4]));
    assert_eq!(state.session.as_ref().unwrap().view.slices, [39.0, 0.0, 7.0]);
}

#[test]
fn a_notice_is_told_once_and_goes_when_it_is_read() {
    let mut state = open();
    for _ in 0..2 {
        state.apply(Action::Tell(Notice::note(Place::Layers, "so")));
    }
    assert_eq!(state.notices_at(Place::Layers).count(), 1);
    state.apply(Action::Dismiss(0));
    assert!(state.notices.is_empty());
}

#[test]
fn another_projects_change_does_not_touch_this_one() {
    let mut state = open();
    let mut other = snapshot("b.petro");
    other.document.step = 9;
    state.apply(Action::Changed(other));
    assert_eq!(state.session.as_ref().unwrap().document.step, 1);
}
