//! Steps of the interpretation without a window.

use super::picking::*;
use super::tests::open;
use super::{Action, Notice, Place, State, Task};
use glam::DVec3;
use project::command::{Climb, Command, DrawHorizon};
use project::document::Drawn;

fn picking(state: &State) -> &Picking {
    &state.session.as_ref().unwrap().view.picking
}

fn found(state: &mut State) {
    let pick = Pick { at: [3.0, 4.0, 8.0], leaf: 7, up: 0, levels: 3 };
    state.apply(Action::Picking(PickingStep::Found(pick)));
}

#[test]
fn a_click_asks_for_the_leaf_at_its_line_numbers() {
    let mut state = open();
    let tasks = state.apply(Action::Picking(PickingStep::At(DVec3::new(2.0, 3.25, 5.0), How::Replace)));
    let geometry = state.session.as_ref().unwrap().document.geometry.clone().unwrap();
    let Some(Task::Picking(PickingTask::Find(at))) = tasks.first() else { panic!("{tasks:?}") };
    assert!((voxel_of(&geometry, *at) - DVec3::new(2.0, 3.25, 5.0)).length() < 1e-3);
}

#[test]
fn a_selection_climbs_within_its_tree_and_is_accepted_as_a_command() {
    let mut state = open();
    found(&mut state);
    for by in [1, 1, 1, 1, -1] {
        state.apply(Action::Picking(PickingStep::Climb(by)));
    }
    assert_eq!(picking(&state).pick.as_ref().unwrap().up, 2);
    let tasks = state.apply(Action::Picking(PickingStep::Accept));
    let Some(Task::Apply(command)) = tasks.first() else { panic!("{tasks:?}") };
    let Command::Pick(node) = command.as_ref() else { panic!("{command:?}") };
    assert_eq!((node.horizon.as_str(), node.climb, node.at), ("Horizon 1", Climb::Levels(2), [3.0, 4.0, 8.0]));
    assert!(picking(&state).pick.is_none());
}

/// Keys that come before the worker's answer count after it, in their order.
#[test]
fn what_is_done_before_a_node_is_found_counts_when_it_is() {
    let mut state = open();
    let at = |x: f64| PickingStep::At(DVec3::new(x, 3.25, 5.0), How::Replace);
    for step in [at(2.0), PickingStep::HighestValid, PickingStep::Accept, PickingStep::Begin, at(9.0)] {
        let is_first = step == at(2.0);
        assert_eq!(state.apply(Action::Picking(step)).len(), usize::from(is_first));
    }
    let leaf =
        |leaf: u32, up: u32| Action::Picking(PickingStep::Found(Pick { at: [3.0, 4.0, 8.0], leaf, up, levels: 3 }));
    let tasks = state.apply(leaf(7, 0));
    assert!(matches!(&tasks[..], [Task::Picking(PickingTask::HighestValid(..))]), "{tasks:?}");
    let tasks = state.apply(leaf(7, 2));
    let [Task::Apply(command), Task::Picking(PickingTask::Find(_))] = &tasks[..] else { panic!("{tasks:?}") };
    let Command::Pick(node) = command.as_ref() else { panic!("{command:?}") };
    assert_eq!((node.horizon.as_str(), node.climb), ("Horizon 1", Climb::Levels(2)));
    assert_eq!(picking(&state).horizon.as_deref(), Some("Horizon 2"));
    // Where nothing is found, nothing of it counts.
    state.apply(Action::Picking(PickingStep::Accept));
    state.apply(Action::Tell(Notice { failed: true, ..Notice::note(Place::Interpret, "no leaf is near") }));
    assert!(picking(&state).hasty.is_empty() && !picking(&state).awaits);
}

#[test]
fn what_a_failed_command_was_to_accept_is_selected_again() {
    let mut state = open();
    found(&mut state);
    state.apply(Action::Picking(PickingStep::Accept));
    let failure = Notice { failed: true, ..Notice::note(Place::Interpret, "the disk is full") };
    state.apply(Action::Tell(failure));
    assert_eq!(picking(&state).pick.as_ref().unwrap().leaf, 7);
}

#[test]
fn another_horizon_accepts_what_is_selected_and_has_a_name_of_its_own() {
    let mut state = open();
    found(&mut state);
    let tasks = state.apply(Action::Picking(PickingStep::Begin));
    assert!(matches!(&tasks[..], [Task::Apply(_)]), "{tasks:?}");
    assert_eq!(picking(&state).horizon.as_deref(), Some("Horizon 2"));
}

#[test]
fn sticks_are_drawn_taken_back_and_made_a_fault() {
    let mut state = open();
    let mut step = |step| state.apply(Action::Picking(step));
    step(PickingStep::Use(Tool::Sticks));
    for (x, z) in [(3.0, 2.0), (4.0, 9.0), (5.0, 15.0)] {
        step(PickingStep::Stick(DVec3::new(x, 3.0, z)));
    }
    step(PickingStep::Backspace);
    step(PickingStep::Accept);
    for (x, z) in [(3.5, 2.0), (4.5, 9.0)] {
        step(PickingStep::Stick(DVec3::new(x, 20.0, z)));
    }
    let tasks = step(PickingStep::MakeFault);
    let Some(Task::Apply(command)) = tasks.first() else { panic!("{tasks:?}") };
    let Command::PickFault(fault) = command.as_ref() else { panic!("{command:?}") };
    assert_eq!((fault.name.as_str(), fault.sticks.len(), fault.sticks[0].len()), ("Fault 1", 2, 2));
    assert_eq!(picking(&state).tool, Tool::Pick);
}

#[test]
fn backspace_reaches_into_the_stick_before() {
    let mut state = open();
    let mut step = |step| state.apply(Action::Picking(step));
    for z in [2.0, 9.0] {
        step(PickingStep::Stick(DVec3::new(1.0, 1.0, z)));
    }
    step(PickingStep::EndStick);
    step(PickingStep::Backspace);
    assert_eq!((picking(&state).stick.len(), picking(&state).sticks.len()), (1, 0));
}

#[test]
fn a_line_is_drawn_taken_back_and_added_and_comes_back_where_that_fails() {
    let mut state = open();
    state.apply(Action::Picking(PickingStep::Use(Tool::Draw)));
    let at = |y: f64| DVec3::new(3.0, y, 6.0);
    state.apply(Action::Picking(PickingStep::Line(vec![at(1.0), at(2.0), at(4.0)])));
    state.apply(Action::Picking(PickingStep::Backspace));
    state.apply(Action::Picking(PickingStep::Snap(true)));
    let tasks = state.apply(Action::Picking(PickingStep::Accept));
    let Some(Task::Apply(command)) = tasks.first() else { panic!("{tasks:?}") };
    let Command::DrawHorizon(DrawHorizon { horizon, part, .. }) = command.as_ref() else { panic!("{command:?}") };
    let Drawn::Line { points, snap: true } = part else { panic!("{part:?}") };
    assert_eq!((horizon.as_str(), points.len()), ("Horizon 1", 2));
    assert!(picking(&state).line.is_empty());
    state.apply(Action::Tell(Notice { failed: true, ..Notice::note(Place::Interpret, "the disk is full") }));
    assert_eq!(picking(&state).line.len(), 2);
    let tasks = state.apply(Action::Picking(PickingStep::Use(Tool::Track)));
    assert!(matches!(&tasks[..], [Task::Apply(_)]), "a line is not lost with its tool: {tasks:?}");
    let tasks = state.apply(Action::Picking(PickingStep::At(at(2.0), How::Replace)));
    let Some(Task::Apply(command)) = tasks.first() else { panic!("{tasks:?}") };
    let Command::DrawHorizon(DrawHorizon { part: Drawn::Tracked { .. }, .. }) = command.as_ref() else {
        panic!("{command:?}")
    };
}
