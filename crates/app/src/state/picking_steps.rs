//! What each step does to the state, and what others are to do.

use super::picking::{How, PickingStep, PickingTask, Tool, free_name, place_of};
use super::{Place, State, Task};
use interp::assembly::Operation;
use project::command::{Climb, Command, PickFault, PickNode};
use project::error::Noun;

impl State {
    /// Takes a step of the interpretation.
    pub(super) fn pick(&mut self, step: PickingStep) -> Vec<Task> {
        let Some(session) = &mut self.session else { return Vec::new() };
        let Some(geometry) = session.document.geometry.clone() else { return Vec::new() };
        let document = &session.document;
        let picking = &mut session.view.picking;
        let ask = |task| vec![Task::Picking(task)];
        if matches!(step, PickingStep::At(..) | PickingStep::Accept | PickingStep::Erase(_)) {
            self.notices.retain(|notice| notice.place != Place::Interpret);
        }
        match step {
            PickingStep::At(voxel, how) => {
                let at = place_of(&geometry, voxel);
                let mut tasks = Vec::new();
                if how == How::Remove {
                    let Some(horizon) = picking.horizon.clone() else { return tasks };
                    let operation = Operation::Remove;
                    let command = PickNode { at, horizon, operation, colour: None, climb: Climb::Levels(0) };
                    tasks.extend(picking.accept());
                    tasks.push(Task::Apply(Box::new(Command::Pick(command))));
                    return tasks;
                }
                if how == How::Extend {
                    tasks.extend(picking.accept());
                }
                tasks.push(Task::Picking(PickingTask::Find(at)));
                return tasks;
            }
            PickingStep::Found(pick) => {
                if picking.horizon.is_none() {
                    picking.horizon = Some(free_name(document, Noun::Horizon, "Horizon"));
                }
                picking.pick = Some(pick);
            }
            PickingStep::Climb(by) => {
                if let Some(pick) = &mut picking.pick {
                    pick.up = pick.up.saturating_add_signed(by).min(pick.levels);
                }
            }
            PickingStep::HighestValid => {
                if let Some(pick) = &picking.pick {
                    return ask(PickingTask::HighestValid(pick.clone(), picking.horizon.clone()));
                }
            }
            PickingStep::Accept => {
                if picking.tool == Tool::Sticks {
                    picking.end_stick();
                    return Vec::new();
                }
                return picking.accept().into_iter().collect();
            }
            PickingStep::GiveUp => {
                if picking.stick.is_empty() && picking.pick.is_none() {
                    picking.tool = Tool::Pick;
                }
                picking.stick.clear();
                picking.pick = None;
            }
            PickingStep::Begin | PickingStep::Choose(_) => {
                // What is selected belongs to the horizon it was selected for.
                let tasks: Vec<Task> = picking.accept().into_iter().collect();
                let taken = picking.horizon.clone().filter(|_| !tasks.is_empty());
                picking.horizon = Some(match step {
                    PickingStep::Choose(name) => name,
                    _ => {
                        let mut name = free_name(document, Noun::Horizon, "Horizon");
                        if taken.as_ref() == Some(&name) {
                            let number = name.rsplit(' ').next().and_then(|n| n.parse::<u32>().ok()).unwrap_or(0);
                            name = format!("Horizon {}", number + 1);
                        }
                        name
                    }
                });
                picking.colour = None;
                picking.tool = Tool::Pick;
                return tasks;
            }
            PickingStep::Name(name) => picking.horizon = Some(name),
            PickingStep::Tint(colour) => picking.colour = Some(colour),
            PickingStep::Use(tool) => {
                picking.end_stick();
                picking.tool = tool;
                if tool == Tool::Sticks && picking.fault.is_empty() {
                    picking.fault = free_name(document, Noun::Fault, "Fault");
                }
            }
            PickingStep::Look(look) => picking.look = look,
            PickingStep::Show(show) => picking.show = show,
            PickingStep::Erase(lasso) => {
                if let Some(horizon) = picking.horizon.clone() {
                    let mut tasks: Vec<Task> = picking.accept().into_iter().collect();
                    tasks.push(Task::Picking(PickingTask::Erase(lasso, horizon)));
                    return tasks;
                }
            }
            PickingStep::Stick(voxel) => picking.stick.push(place_of(&geometry, voxel)),
            PickingStep::EndStick => picking.end_stick(),
            PickingStep::Backspace => {
                if picking.stick.is_empty() {
                    picking.stick = picking.sticks.pop().unwrap_or_default();
                }
                picking.stick.pop();
            }
            PickingStep::NameFault(name) => picking.fault = name,
            PickingStep::MakeFault => {
                picking.end_stick();
                let sticks = std::mem::take(&mut picking.sticks);
                if sticks.is_empty() {
                    return Vec::new();
                }
                let name = std::mem::take(&mut picking.fault);
                picking.tool = Tool::Pick;
                return vec![Task::Apply(Box::new(Command::PickFault(PickFault { name, sticks })))];
            }
            PickingStep::Dismiss(id) => picking.dismissed.push(id),
            PickingStep::Minor(minor) => picking.minor = minor,
        }
        Vec::new()
    }

    /// A command of the interpretation failed: what it was to accept is selected again.
    pub(super) fn reselect(&mut self) {
        let Some(session) = &mut self.session else { return };
        let picking = &mut session.view.picking;
        if let Some(pick) = picking.accepted.take()
            && picking.pick.is_none()
        {
            picking.pick = Some(pick);
        }
    }
}
