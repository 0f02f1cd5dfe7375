//! What each step of the interpretation does to the state, and which tasks follow.

use super::picking::{How, Picking, PickingStep, PickingTask, StickPoint, Tool, free_name, place_of};
use super::{Place, State, Task};
use interp::assembly::Operation;
use project::command::{Climb, Command, MoveStickPoint, PickByTime, PickFault, PickNode, TimeLevel};
use project::document::{Document, Drawn};
use project::error::Noun;

impl State {
    /// Takes a step of the interpretation.
    pub(super) fn pick(&mut self, step: PickingStep) -> Vec<Task> {
        let Some(session) = &mut self.session else { return Vec::new() };
        let Some(geometry) = session.document.geometry.clone() else { return Vec::new() };
        let document = &session.document;
        let picking = &mut session.view.picking;
        if picking.awaits && is_of_selection(&step) {
            picking.hasty.push(step);
            return Vec::new();
        }
        if matches!(step, PickingStep::At(..) | PickingStep::Accept | PickingStep::Erase(_)) {
            self.notices.retain(|notice| notice.place != Place::Interpret);
        }
        match step {
            PickingStep::At(voxel, _) if picking.tool == Tool::Time => {
                return picking.by_time(place_of(&geometry, voxel), document);
            }
            PickingStep::At(voxel, _) if picking.tool == Tool::Track => {
                let part = Drawn::Tracked { at: place_of(&geometry, voxel), window: picking.window };
                return vec![picking.draw(part, document)];
            }
            PickingStep::At(voxel, how) => return picking.click(place_of(&geometry, voxel), how),
            PickingStep::Found(pick) => {
                if picking.horizon.is_none() {
                    picking.horizon = Some(free_name(document, Noun::Horizon, "Horizon"));
                }
                picking.pick = Some(pick);
                picking.awaits = false;
                let hasty = std::mem::take(&mut picking.hasty);
                return hasty.into_iter().flat_map(|step| self.pick(step)).collect();
            }
            PickingStep::Climb(by) => {
                if let Some(pick) = &mut picking.pick {
                    pick.up = pick.up.saturating_add_signed(by).min(pick.levels);
                }
            }
            PickingStep::HighestValid => {
                if let Some(pick) = &picking.pick {
                    picking.awaits = true;
                    return vec![Task::Picking(PickingTask::HighestValid(pick.clone(), picking.horizon.clone()))];
                }
            }
            PickingStep::Accept => {
                return match picking.tool {
                    Tool::Sticks => picking.take_stick(document, session.view.slices),
                    Tool::Faults => picking.accept_faults(document),
                    Tool::Draw => picking.end_line(document).into_iter().collect(),
                    Tool::Pick | Tool::Lasso | Tool::Time | Tool::Track => picking.accept().into_iter().collect(),
                };
            }
            PickingStep::GiveUp => picking.give_up(),
            PickingStep::Begin => return picking.turn_to(None, document),
            PickingStep::Choose(name) => return picking.turn_to(Some(name), document),
            PickingStep::Name(name) => picking.horizon = Some(name),
            PickingStep::Tint(colour) => picking.colour = Some(colour),
            PickingStep::Use(tool) => {
                picking.end_stick();
                let line = picking.end_line(document);
                picking.tool = tool;
                if tool == Tool::Sticks && picking.fault.is_empty() {
                    picking.fault = free_name(document, Noun::Fault, "Fault");
                }
                return line.into_iter().collect();
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
            PickingStep::Line(voxels) => {
                picking.line.extend(voxels.into_iter().map(|voxel| place_of(&geometry, voxel)));
            }
            PickingStep::Snap(snap) => picking.snap = snap,
            PickingStep::Window(window) => picking.window = window,
            PickingStep::MovePoint(StickPoint { fault: Some(fault), stick, point }, to) => {
                let command = MoveStickPoint { fault, stick, point, to: place_of(&geometry, to) };
                return vec![Task::Apply(Box::new(Command::MoveStickPoint(command)))];
            }
            PickingStep::MovePoint(StickPoint { fault: None, stick, point }, to) => {
                let drawn = picking.sticks.iter_mut().chain(std::iter::once(&mut picking.stick)).nth(stick);
                if let Some(place) = drawn.and_then(|stick| stick.get_mut(point)) {
                    *place = place_of(&geometry, to);
                }
            }
            PickingStep::EndStick => picking.end_stick(),
            PickingStep::Backspace => picking.take_last_point(),
            PickingStep::NameFault(name) => picking.fault = name,
            PickingStep::MakeFault => return picking.make_fault().into_iter().collect(),
            PickingStep::Fault(step) => return picking.fault_step(step, document, &geometry),
            PickingStep::Dismiss(id) => picking.dismissed.push(id),
            PickingStep::Minor(minor) => picking.minor = minor,
        }
        Vec::new()
    }

    /// A command of the interpretation failed: the selection that it was to accept is selected again.
    pub(super) fn reselect(&mut self) {
        let Some(session) = &mut self.session else { return };
        let picking = &mut session.view.picking;
        // Nothing was found.
        (picking.awaits, picking.hasty) = (false, Vec::new());
        if let Some(pick) = picking.accepted.take()
            && picking.pick.is_none()
        {
            picking.pick = Some(pick);
        }
        let added = std::mem::take(&mut picking.added);
        if picking.line.is_empty() {
            picking.line = added;
        }
    }
}

/// Whether a step does something with the node that is selected, or selects another.
fn is_of_selection(step: &PickingStep) -> bool {
    use PickingStep::{Accept, At, Begin, Choose, Climb, Erase, HighestValid};
    matches!(step, At(..) | Climb(_) | HighestValid | Accept | Begin | Choose(_) | Erase(_))
}

impl Picking {
    /// What was begun is given up; where nothing was, the tool is.
    fn give_up(&mut self) {
        if self.stick.is_empty() && self.pick.is_none() && self.line.is_empty() && self.faults.is_empty() {
            self.tool = Tool::Pick;
        }
        self.faults.clear();
        self.stick.clear();
        self.line.clear();
        self.pick = None;
        self.hasty.clear();
    }

    /// The last point of the line or stick that is being drawn is taken back; then that of the stick before.
    fn take_last_point(&mut self) {
        if self.tool == Tool::Draw {
            self.line.pop();
            return;
        }
        if self.stick.is_empty() {
            self.stick = self.sticks.pop().unwrap_or_default();
        }
        self.stick.pop();
    }

    /// A click at a place in line numbers: selects the leaf there, accepts the previous selection first, or removes the
    /// leaf, as `how` says.
    fn click(&mut self, at: [f64; 3], how: How) -> Vec<Task> {
        let mut tasks = Vec::new();
        if how == How::Remove {
            let Some(horizon) = self.horizon.clone() else { return tasks };
            let operation = Operation::Remove;
            let command = PickNode { at, horizon, operation, colour: None, climb: Climb::Levels(0) };
            tasks.extend(self.accept());
            tasks.push(Task::Apply(Box::new(Command::Pick(command))));
            return tasks;
        }
        if how == How::Extend {
            tasks.extend(self.accept());
        }
        self.awaits = true;
        tasks.push(Task::Picking(PickingTask::Find(at)));
        tasks
    }

    /// A click with geologic time: corrects the present horizon if it was picked by time, otherwise makes one, of the
    /// present name if that is free.
    fn by_time(&mut self, at: [f64; 3], document: &Document) -> Vec<Task> {
        let known = self.horizon.as_ref().and_then(|name| document.horizons.iter().find(|entry| entry.name == *name));
        let name = match (&self.horizon, known) {
            (Some(name), None) => name.clone(),
            (Some(name), Some(entry)) if !entry.origin.seeds().is_empty() => name.clone(),
            _ => free_name(document, Noun::Horizon, "Horizon"),
        };
        self.horizon = Some(name.clone());
        let command = PickByTime { level: TimeLevel::Through(at), horizon: name };
        vec![Task::Apply(Box::new(Command::PickByTime(command)))]
    }

    /// Sends the next picks to another horizon: the one given, or else a new one.
    fn turn_to(&mut self, chosen: Option<String>, document: &Document) -> Vec<Task> {
        // The selection belongs to the horizon that it was made for.
        let tasks: Vec<Task> = self.accept().into_iter().chain(self.end_line(document)).collect();
        // The project does not have the horizon yet whose first pick or line was just added.
        let is_added = !tasks.is_empty() || self.accepted.is_some() || !self.added.is_empty();
        let taken = self.horizon.clone().filter(|_| is_added);
        self.horizon = Some(chosen.unwrap_or_else(|| {
            let name = free_name(document, Noun::Horizon, "Horizon");
            if taken.as_ref() != Some(&name) {
                return name;
            }
            let number = name.rsplit(' ').next().and_then(|n| n.parse::<u32>().ok()).unwrap_or(0);
            format!("Horizon {}", number + 1)
        }));
        self.colour = None;
        if !matches!(self.tool, Tool::Time | Tool::Draw | Tool::Track) {
            self.tool = Tool::Pick;
        }
        tasks
    }

    /// Ends the stick; where none is begun, the one that is suggested is taken.
    fn take_stick(&mut self, document: &Document, slices: [f64; 3]) -> Vec<Task> {
        if let (Some(suggested), Some(geometry)) = (self.suggestion(document, slices), &document.geometry) {
            self.stick = suggested.points.iter().map(|voxel| place_of(geometry, *voxel)).collect();
        }
        self.end_stick();
        Vec::new()
    }

    /// The command that makes a fault of the sticks; nothing while there are none.
    fn make_fault(&mut self) -> Option<Task> {
        self.end_stick();
        let sticks = std::mem::take(&mut self.sticks);
        if sticks.is_empty() {
            return None;
        }
        let name = std::mem::take(&mut self.fault);
        self.tool = Tool::Pick;
        Some(Task::Apply(Box::new(Command::PickFault(PickFault { name, sticks }))))
    }
}
