//! Commands on projects, carried out one after the other, so that changes to a project keep their order. They wait for
//! another program that is changing the project as long as the command line does.

use super::running::{Running, RunningGuard};
use super::{Event, Outbox, keep_working};
use crate::state::{Notice, Place, Snapshot};
use project::Project;
use project::chains::{demo, illustrate};
use project::check::check;
use project::command::{Command, ImportVolume};
use project::error::ProjectError;
use project::folder::DEFAULT_WAIT;
use project::interpretation::times::Times;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Sender, channel};
use survey::Progress;

/// A command, or another order on a project.
pub(super) enum Order {
    Open(PathBuf, Place),
    Check(PathBuf, Place),
    Demo(PathBuf, Place),
    /// Give a project layers by computed geologic time.
    Illustrate(PathBuf),
    Create {
        command: Box<ImportVolume>,
        root: PathBuf,
    },
    Apply {
        root: PathBuf,
        command: Box<Command>,
        place: Place,
    },
    Undo(PathBuf),
    Redo(PathBuf),
}

/// Starts the thread; it ends when the sender is dropped.
pub(super) fn start(outbox: Outbox, running: Running) -> Sender<Order> {
    let (sender, orders) = channel::<Order>();
    let told = outbox.clone();
    keep_working("the project", &told, move || {
        let mut times: Option<Arc<Times>> = None;
        while let Ok(order) = orders.recv() {
            let (place, root) = (order.place(), order.root());
            let (guard, progress) = running.begin(order.title(), place, outbox.wake.clone());
            if let Some(needed) = times_for(&order, &progress) {
                times.replace(needed);
            }
            match super::compute(|| order.carry_out(&progress)) {
                Ok(event) => {
                    tell_warnings(&guard, place, &outbox);
                    if let Event::Changed { snapshot, .. } | Event::Opened(snapshot) = &event
                        && snapshot.document.geologic_time().is_none()
                    {
                        times.take();
                    }
                    outbox.send(event);
                }
                Err(error) => outbox.send(Event::Told(match root {
                    Some(root) => Notice::failure_with(place, &error, &root),
                    None => Notice::failure(place, &error),
                })),
            }
            drop(guard);
            outbox.wake();
        }
    });
    sender
}

/// What picks by geologic time read, held for as long as the user picks by it, so that a further click has its answer at
/// once. What cannot be read is left to the command, which says why.
fn times_for(order: &Order, progress: &Progress) -> Option<Arc<Times>> {
    let Order::Apply { root, command, .. } = order else { return None };
    if !matches!(**command, Command::PickByTime(_)) {
        return None;
    }
    let project = Project::open(root).ok()?;
    Times::load(project.facts(), progress).ok()
}

fn tell_warnings(guard: &RunningGuard, place: Place, outbox: &Outbox) {
    for warning in guard.warnings() {
        outbox.send(Event::Told(Notice::note(place, warning)));
    }
}

impl Order {
    fn title(&self) -> String {
        match self {
            Self::Open(..) => "Opening the project".to_owned(),
            Self::Check(..) => "Checking the project".to_owned(),
            Self::Demo(..) => "Making the demonstration".to_owned(),
            Self::Illustrate(_) => "Illustrating".to_owned(),
            Self::Create { command, .. } => format!("Reading {}", file_name(&command.path)),
            Self::Apply { command, .. } => match command.as_ref() {
                Command::Import(import) => format!("Reading {}", file_name(&import.path)),
                Command::AddHorizon(add) => format!("Reading {}", file_name(&add.path)),
                Command::AddFault(add) => format!("Reading {}", file_name(&add.path)),
                Command::Time(_) => "Computing geologic time".to_owned(),
                _ => "Saving".to_owned(),
            },
            Self::Undo(_) => "Undo".to_owned(),
            Self::Redo(_) => "Redo".to_owned(),
        }
    }

    fn place(&self) -> Place {
        match self {
            Self::Open(_, place) | Self::Check(_, place) | Self::Demo(_, place) => *place,
            Self::Create { .. } => Place::Dialogue,
            Self::Illustrate(_) => Place::Interpret,
            Self::Apply { place, .. } => *place,
            Self::Undo(_) | Self::Redo(_) => Place::Block,
        }
    }

    /// The project that is there already.
    fn root(&self) -> Option<PathBuf> {
        match self {
            Self::Open(root, _)
            | Self::Illustrate(root)
            | Self::Apply { root, .. }
            | Self::Undo(root)
            | Self::Redo(root) => Some(root.clone()),
            Self::Check(..) | Self::Demo(..) | Self::Create { .. } => None,
        }
    }

    fn carry_out(self, progress: &Progress) -> Result<Event, ProjectError> {
        Ok(match self {
            Self::Open(root, _) => Event::Opened(Box::new(snapshot(&Project::open(&absolute(&root))?)?)),
            Self::Check(root, place) => Event::Told(Notice::checked(place, &check(&absolute(&root), progress)?)),
            Self::Demo(folder, _) => {
                let done = demo::run(&folder, progress)?;
                Event::Opened(Box::new(snapshot(&Project::open(&absolute(&done.project))?)?))
            }
            Self::Illustrate(root) => {
                let mut project = Project::open(&root)?.waiting(DEFAULT_WAIT);
                illustrate::layers_by_time(&mut project, illustrate::LAYERS, progress)?;
                Event::Changed { snapshot: Box::new(snapshot(&project)?), place: Place::Interpret }
            }
            Self::Create { command, root } => {
                let mut new = Project::create(&absolute(&root), None)?;
                new.project().apply(&Command::Import(*command), progress)?;
                Event::Opened(Box::new(snapshot(&new.publish()?)?))
            }
            Self::Apply { root, command, place } => {
                let mut project = Project::open(&root)?.waiting(DEFAULT_WAIT);
                project.apply(&command, progress)?;
                Event::Changed { snapshot: Box::new(snapshot(&project)?), place }
            }
            Self::Undo(root) => {
                let mut project = Project::open(&root)?.waiting(DEFAULT_WAIT);
                project.undo()?;
                Event::Changed { snapshot: Box::new(snapshot(&project)?), place: Place::Block }
            }
            Self::Redo(root) => {
                let mut project = Project::open(&root)?.waiting(DEFAULT_WAIT);
                project.redo()?;
                Event::Changed { snapshot: Box::new(snapshot(&project)?), place: Place::Block }
            }
        })
    }
}

/// The project in the form that the window keeps.
pub(super) fn snapshot(project: &Project) -> Result<Snapshot, ProjectError> {
    Ok(Snapshot { root: project.root().to_owned(), document: project.document().clone(), history: project.history() })
}

fn file_name(path: &Path) -> String {
    path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned())
}

/// An absolute path, since recent projects must be found from any working folder.
fn absolute(path: &Path) -> PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use project::command::SetVelocity;
    use std::fs::File;
    use std::thread;
    use std::time::{Duration, Instant};
    use survey::{SurveyGeometry, VerticalUnit};

    #[test]
    fn what_does_not_open_is_offered_a_check_that_says_what_is_damaged() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path().join("a.petro");
        Project::create(&root, None).unwrap().publish().unwrap();
        let open = || {
            let order = Order::Open(root.clone(), Place::Start);
            let (place, root) = (order.place(), order.root().unwrap());
            order.carry_out(&Progress::silent()).map_err(|error| Notice::failure_with(place, &error, &root))
        };
        let checked = || match Order::Check(root.clone(), Place::Start).carry_out(&Progress::silent()) {
            Ok(Event::Told(notice)) => notice,
            _ => panic!("a check only tells"),
        };
        assert!(open().is_ok() && !checked().failed);
        std::fs::write(root.join("project.toml"), "= damaged").unwrap();
        let Err(notice) = open() else { panic!("it is damaged") };
        assert_eq!(notice.suspect.as_ref(), Some(&root));
        let found = checked();
        assert!(found.failed && found.text.contains("the present state"), "{}", found.text);
        // Where nothing is, there is nothing to check.
        std::fs::remove_dir_all(&root).unwrap();
        assert_eq!(open().err().and_then(|notice| notice.suspect), None);
    }

    #[test]
    fn a_change_waits_for_another_program_that_holds_the_project() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path().join("a.petro");
        let geometry = SurveyGeometry::regular([4, 5, 6], 25.0, 4.0, VerticalUnit::Milliseconds);
        Project::create(&root, Some(geometry)).unwrap().publish().unwrap();
        let change = || Command::SetVelocity(SetVelocity { velocity_m_s: 2500.0 });
        let orders = [
            Order::Apply { root: root.clone(), command: Box::new(change()), place: Place::Block },
            Order::Undo(root.clone()),
            Order::Redo(root.clone()),
        ];
        for order in orders {
            let lock = File::options().create(true).truncate(false).write(true).open(root.join("lock")).unwrap();
            lock.try_lock().unwrap();
            let held = Duration::from_millis(300);
            let begun = Instant::now();
            let holder = thread::spawn(move || {
                thread::sleep(held);
                drop(lock);
            });
            assert!(matches!(order.carry_out(&Progress::silent()), Ok(Event::Changed { .. })));
            assert!(begun.elapsed() >= held, "the other program still held it");
            holder.join().unwrap();
        }
    }
}
