//! What each action does to the state.

use super::{
    Action, Compare, Notice, Panel, PickingTask, Place, Session, Snapshot, State, Task, Tool, ViewState, camera,
};
use project::document::Document;
use project::pictures::scene;

impl State {
    /// Applies an action; returns the tasks for the workers.
    pub fn apply(&mut self, action: Action) -> Vec<Task> {
        match action {
            Action::Open(path) => {
                self.quieten(Place::Start);
                self.quieten(Place::Dialogue);
                return vec![Task::Open(path)];
            }
            Action::Check(path, place) => {
                self.quieten(place);
                return vec![Task::Check(path, place)];
            }
            Action::Recover => {
                self.quieten(Place::Start);
                return self.remembered.left.iter().map(|left| Task::Open(left.root.clone())).collect();
            }
            Action::Abandon => {
                self.remembered.left = None;
                return vec![Task::Remember];
            }
            Action::Forget(path) => {
                self.remembered.forget(&path);
                return vec![Task::Remember];
            }
            Action::Demo(folder) => {
                self.dialogue = None;
                self.quieten(Place::Start);
                return vec![Task::Demo(folder)];
            }
            Action::Illustrate => return self.task_at(Place::Interpret, Task::Illustrate),
            Action::Close => return self.close(),
            Action::Opened(snapshot) => return self.opened(*snapshot),
            Action::Changed(snapshot) => self.changed(*snapshot),
            Action::Tell(notice) => self.tell(notice),
            Action::Dismiss(index) => self.dismiss(index),
            Action::Ask(dialogue) => {
                self.quieten(Place::Dialogue);
                self.dialogue = Some(*dialogue);
            }
            Action::Answered => {
                self.quieten(Place::Dialogue);
                self.dialogue = None;
            }
            Action::Apply(command) => return self.task(Task::Apply(command)),
            Action::Undo => return self.task(Task::Undo),
            Action::Redo => return self.task(Task::Redo),
            Action::Import { command, into } => {
                self.quieten(Place::Dialogue);
                return vec![match into {
                    Some(root) => Task::Create { command, root },
                    None => Task::Apply(Box::new(project::Command::Import(*command))),
                }];
            }
            Action::Export(form) => return self.task_at(Place::Foot, Task::Export(form)),
            Action::ExportData(form) => return self.writing(Task::ExportData(form)),
            Action::Share(form) => return self.writing(Task::Share(form)),
            Action::Copy => return self.task(Task::Copy),
            Action::Picking(step) => return self.pick(step),
            Action::Extract(volume, settings) => {
                return self.task_at(Place::Interpret, Task::Picking(PickingTask::Extract(volume, settings)));
            }
            Action::ProposeFaults => return self.propose_faults(),
            Action::Appear(appearance) => {
                self.remembered.appearance = appearance;
                return vec![Task::Remember];
            }
            Action::Scale(scale) => {
                self.remembered.scale = Some(scale.clamp(0.6, 3.0));
                return vec![Task::Remember];
            }
            Action::Present(at) => self.present(at),
            Action::Show(scene) => self.look(|view, document| view.show(*scene, document)),
            Action::ShowNamed(name) => self.show_named(&name),
            Action::Stand(place) => self.look(|view, _| camera::stand(&mut view.scene, place)),
            Action::Volumes(volumes) => self.look(|view, _| view.volumes = volumes),
            Action::Proportions(factor) => self.look(|view, _| view.proportions = factor),
            Action::Arrange(layout) => self.look(|view, _| view.layout = layout),
            Action::Compare(compare) => self.look(|view, _| view.compare = compare),
            Action::Wipe(at) => self.look(|view, _| view.wipe = at.clamp(0.02, 0.98)),
            Action::Slices(at) => self.look(|view, document| {
                view.slices = at;
                view.fit(document);
            }),
            Action::Fence(corners) => self.look(|view, document| {
                view.fence = corners;
                view.fit(document);
            }),
            Action::Panel(panel) => self.look(|view, _| view.panel = panel),
            Action::Layer(layer) => self.look(|view, _| view.layer = layer),
            Action::Horizon(horizon) => self.look(|view, _| view.horizon = horizon),
            Action::Hide { kind, name, hidden } => self.look(|view, _| view.hidden.set(kind, name, hidden)),
            Action::Handles(shown) => self.look(|view, _| view.handles = shown),
        }
        Vec::new()
    }

    /// Takes over a change of the open project; one of a project that was closed meanwhile is nobody's.
    fn changed(&mut self, snapshot: Snapshot) {
        if let Some(session) = self.session.as_mut().filter(|session| session.root == snapshot.root) {
            session.renew(snapshot);
        }
    }

    /// The numbers of former proposals mean nothing in the new list; the pointer chooses from it.
    fn propose_faults(&mut self) -> Vec<Task> {
        self.look(|view, _| {
            view.picking.dismissed.clear();
            view.picking.faults.clear();
            view.picking.tool = Tool::Faults;
        });
        self.task_at(Place::Interpret, Task::Picking(PickingTask::ProposeFaults))
    }

    /// Shows a notice, once.
    fn tell(&mut self, notice: Notice) {
        if notice.failed && notice.place == Place::Interpret {
            self.reselect();
        }
        self.notices.retain(|known| *known != notice);
        self.notices.push(notice);
    }

    fn dismiss(&mut self, index: usize) {
        if index < self.notices.len() {
            self.notices.remove(index);
        }
    }

    /// Changes the view of the open project; nothing while none is open.
    fn look(&mut self, change: impl FnOnce(&mut ViewState, &Document)) {
        if let Some(session) = &mut self.session {
            change(&mut session.view, &session.document);
        }
    }

    fn show_named(&mut self, name: &str) {
        let Some(session) = &mut self.session else { return };
        match scene::choose(&session.document, Some(name)) {
            Ok(scene) => session.view.scene = scene,
            Err(error) => self.notices.push(Notice::failure(Place::Scenes, &error)),
        }
    }

    /// Shows the scene at a place of the list over the whole screen, or leaves.
    fn present(&mut self, at: Option<usize>) {
        let Some(session) = &mut self.session else { return };
        let view = &mut session.view;
        let before = self.presented.take().map(|(_, before)| before);
        match at.and_then(|at| Some((at, session.document.scenes.get(at)?))) {
            Some((at, entry)) => {
                self.presented = Some((at, before.unwrap_or_else(|| Box::new((view.scene.clone(), view.handles)))));
                (view.scene, view.handles) = (entry.scene.clone(), false);
            }
            None => {
                if let Some(before) = before {
                    (view.scene, view.handles) = *before;
                }
            }
        }
    }

    fn close(&mut self) -> Vec<Task> {
        self.put_by();
        self.session = None;
        self.presented = None;
        self.dialogue = None;
        self.notices.clear();
        self.remembered.left = None;
        vec![Task::Release, Task::Remember]
    }

    fn opened(&mut self, snapshot: Snapshot) -> Vec<Task> {
        let left = self.remembered.left.take().filter(|left| left.root == snapshot.root);
        self.put_by();
        let closed = || self.remembered.closed.iter().find(|left| left.root == snapshot.root).cloned();
        let left = left.or_else(closed);
        self.remembered.add(&snapshot.root);
        self.notices.clear();
        self.dialogue = None;
        self.presented = None;
        self.session = Some(Session::new(snapshot, left.map(|left| left.view)));
        self.mark();
        vec![Task::Remember]
    }

    /// Keeps the view of the open project for when it is opened again.
    pub fn put_by(&mut self) {
        let Some(session) = &self.session else { return };
        self.remembered.put_by(&session.root, &session.view);
    }

    /// Records the present view, so that work can be continued from it.
    pub fn mark(&mut self) {
        self.remembered.left = self
            .session
            .as_ref()
            .map(|session| super::last_session::Left { root: session.root.clone(), view: session.view.clone() });
    }

    /// A task that needs an open project.
    fn task(&self, task: Task) -> Vec<Task> {
        if self.session.is_some() { vec![task] } else { Vec::new() }
    }

    /// The same; what was said at a place of earlier ones is removed.
    fn task_at(&mut self, place: Place, task: Task) -> Vec<Task> {
        self.quieten(place);
        self.task(task)
    }

    /// A task that writes a file from a dialogue.
    fn writing(&mut self, task: Task) -> Vec<Task> {
        self.quieten(Place::Dialogue);
        self.task_at(Place::Foot, task)
    }

    /// Removes the messages of one place, because something new begins there.
    fn quieten(&mut self, place: Place) {
        self.notices.retain(|notice| notice.place != place);
    }

    /// The scenes that the block view draws, side by side or over one another: their blends, in order.
    pub fn blends(view: &ViewState) -> Vec<f32> {
        match view.compare {
            _ if view.panel == Panel::Interpret => vec![1.0],
            Compare::Blend => vec![view.scene.blend],
            Compare::SideBySide | Compare::Wipe => vec![0.0, 1.0],
        }
    }
}
