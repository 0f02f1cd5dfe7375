//! Whole faults while interpreting: chosen, taken into the project, merged, cut, and edited by their sticks.

use super::Task;
use super::picking::{ChosenFault, FaultStep, Picking, Tool, place_of};
use project::command::{AcceptFault, Command, CutFault, GiveSticks, MergeFaults, Remove};
use project::document::Document;
use project::error::Noun;
use survey::SurveyGeometry;

impl Picking {
    /// Takes a step with whole faults.
    pub(super) fn fault_step(&mut self, step: FaultStep, document: &Document, geometry: &SurveyGeometry) -> Vec<Task> {
        match step {
            FaultStep::Choose(chosen, with_others) => self.choose_fault(chosen, with_others),
            FaultStep::Accept => return self.accept_faults(document),
            FaultStep::Drop => return self.drop_faults(),
            FaultStep::Merge => return self.merge_faults(document),
            FaultStep::Cut(chosen, voxel, along) => {
                let mut tasks = Vec::new();
                let fault = self.taken_in(&chosen, document, &mut tasks);
                self.faults = vec![ChosenFault::Present(fault.clone())];
                let command = CutFault { fault, at: place_of(geometry, voxel), along, name: None };
                tasks.push(Task::Apply(Box::new(Command::CutFault(command))));
                return tasks;
            }
            FaultStep::Edit(fault) => {
                (self.tool, self.fault) = (Tool::Sticks, fault.clone());
                self.faults.clear();
                if !document.sticks.iter().any(|drawn| drawn.fault == fault) {
                    return vec![Task::Apply(Box::new(Command::GiveSticks(GiveSticks { fault })))];
                }
            }
        }
        Vec::new()
    }

    fn choose_fault(&mut self, chosen: ChosenFault, with_others: bool) {
        let known = self.faults.iter().position(|other| *other == chosen);
        match (with_others, known) {
            (true, Some(known)) => drop(self.faults.remove(known)),
            (true, None) => self.faults.push(chosen),
            (false, _) => self.faults = vec![chosen],
        }
    }

    /// The name of a fault in the project; a proposed one is accepted first, under a name that is free.
    fn taken_in(&self, chosen: &ChosenFault, document: &Document, tasks: &mut Vec<Task>) -> String {
        let (id, wanted) = match chosen {
            ChosenFault::Present(name) => return name.clone(),
            ChosenFault::Proposed(id, name) => (*id, name.trim()),
        };
        let accepted = tasks.iter().filter_map(|task| match task {
            Task::Apply(command) => match command.as_ref() {
                Command::AcceptFault(accept) => Some(accept.name.clone()),
                _ => None,
            },
            _ => None,
        });
        let mut taken: Vec<String> = accepted.chain(document.faults.iter().map(|entry| entry.name.clone())).collect();
        taken.iter_mut().for_each(|name| *name = name.to_lowercase());
        let mut name = wanted.to_owned();
        let mut number = id;
        while taken.contains(&name.to_lowercase()) {
            name = format!("Fault {number}");
            number += 1;
        }
        tasks.push(Task::Apply(Box::new(Command::AcceptFault(AcceptFault { id, name: name.clone() }))));
        name
    }

    pub(super) fn accept_faults(&mut self, document: &Document) -> Vec<Task> {
        let mut tasks = Vec::new();
        let names = self.faults.iter().map(|chosen| self.taken_in(chosen, document, &mut tasks)).collect::<Vec<_>>();
        self.faults = names.into_iter().map(ChosenFault::Present).collect();
        tasks
    }

    fn drop_faults(&mut self) -> Vec<Task> {
        let mut tasks = Vec::new();
        for chosen in std::mem::take(&mut self.faults) {
            match chosen {
                ChosenFault::Proposed(id, _) => self.dismissed.push(id),
                ChosenFault::Present(name) => {
                    tasks.push(Task::Apply(Box::new(Command::Remove(Remove { noun: Noun::Fault, name }))));
                }
            }
        }
        tasks
    }

    fn merge_faults(&mut self, document: &Document) -> Vec<Task> {
        let mut tasks = self.accept_faults(document);
        let names = self.faults.iter().filter_map(|chosen| match chosen {
            ChosenFault::Present(name) => Some(name.clone()),
            ChosenFault::Proposed(..) => None,
        });
        let faults: Vec<String> = names.collect();
        let Some(name) = faults.first().cloned() else { return tasks };
        self.faults.truncate(1);
        tasks.push(Task::Apply(Box::new(Command::MergeFaults(MergeFaults { faults, name }))));
        tasks
    }
}
