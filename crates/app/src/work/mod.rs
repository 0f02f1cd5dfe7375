//! Everything that takes time, away from the window's thread.
//!
//! [`Work`] hands tasks to threads and collects their [`Event`]s; [`Running`] lists what is under way, with progress
//! and a way to stop it. Commands on the project run one after the other (`orders`); [`data`] reads data and builds
//! models; pictures ([`picture`]) and sections ([`mod@slice`]) are drawn for the latest request only.
//!
//! Invariant: no call from the window's thread blocks.

pub mod data;
pub mod fence;
pub mod folder;
mod lasso;
pub(crate) mod latest;
mod latest_value;
pub mod map;
mod orders;
pub mod picks;
pub mod picture;
pub(crate) mod running;
pub mod scan;
pub mod share;
pub mod slice;
pub(crate) mod swatches;
mod threads;

pub use data::{Purpose, Rocks, Seen, Wanted};
pub use map::Maps;
pub use picks::{Interpreted, InterpretedHorizon, Picks, ShownFault, ShownPick, sheet};
pub(crate) use picture::Touch;
pub use picture::{Drawing, Drawn, PictureRequest};
pub use running::{Job, Running, RunningLine};
pub use share::SharePreview;
pub(crate) use slice::CutOf;
pub use slice::{SliceRequest, Slices};
pub use swatches::Swatches;

use super::state::{Notice, PickingStep, Place, Snapshot, Task};
use figure::cut::{FenceCut, SectionCut};
use figure::map::HorizonMap;
use image::RgbaImage;
use page::DisplayList;
use project::command::PickNode;
use project::{facts, memory_budget};
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, OnceLock};
use survey::Progress;
use threads::{keep_working, spawn, spawn_quietly};
use ttf::Preset;

/// Share of half of the memory that facts of earlier states may take, so that undo and a change of panel find them.
const KEPT_SHARE: usize = 4;

/// A result.
pub enum Event {
    /// A project was read.
    Opened(Box<Snapshot>),
    /// The open project changed.
    Changed {
        /// Its present state.
        snapshot: Box<Snapshot>,
        /// Where the change was requested.
        place: Place,
    },
    /// The data of this project state are ready to be drawn.
    Ready {
        /// The project.
        root: PathBuf,
        /// The data.
        rocks: Rocks,
    },
    /// A picture of the block.
    Drawn(Drawn),
    /// A section.
    Sliced {
        /// The section.
        cut: SectionCut,
        /// What it shows.
        of: CutOf,
    },
    /// A section along a line.
    Fenced(FenceCut),
    /// A map.
    Mapped(HorizonMap),
    /// The interpretation was read.
    Interpreted(Arc<Interpreted>),
    /// The selected node, ready to be drawn; `None` where nothing is selected.
    Selected(Option<Arc<ShownPick>>),
    /// A result of the interpretation's tasks.
    Picking {
        /// The project it is for.
        root: PathBuf,
        /// The step that follows from it.
        step: PickingStep,
    },
    /// The picks that remove what a lasso encloses.
    Erased {
        /// The project they are for.
        root: PathBuf,
        /// The picks.
        picks: Vec<PickNode>,
    },
    /// The small picture of a scene.
    Thumbnail {
        /// The project it is of.
        root: PathBuf,
        /// The scene's name.
        name: String,
        /// The picture.
        image: RgbaImage,
    },
    /// A picture was written.
    Exported(PathBuf),
    /// The page that a picture will be written from, and the preset it is printed in.
    Previewed(Arc<DisplayList>, Preset),
    /// What is shared, as a reader will see it.
    ShareSeen(Arc<SharePreview>),
    /// A message.
    Told(Notice),
}

/// Wakes the window up, because something has arrived.
pub(crate) type Wake = Arc<dyn Fn() + Send + Sync>;

/// Where workers put their results.
#[derive(Clone)]
pub struct Outbox {
    sender: Sender<Event>,
    wake: Wake,
}

impl Outbox {
    /// Sends a result; once the window is closed it is ignored.
    pub fn send(&self, event: Event) {
        let _ = self.sender.send(event);
        (self.wake)();
    }

    /// Wakes the window without a result.
    pub(crate) fn wake(&self) {
        (self.wake)();
    }
}

/// The workers.
pub struct Work {
    events: Receiver<Event>,
    /// The end of the channel from which results come.
    pub outbox: Outbox,
    /// The list of what is under way.
    pub running: Running,
    orders: Sender<orders::Order>,
    data: data::Loader,
    /// Pictures of the block.
    pub drawing: Drawing,
    /// Sections.
    pub slices: Slices,
    /// Maps.
    pub maps: Maps,
    /// The interpretation.
    pub picks: Picks,
    root: Option<PathBuf>,
}

impl Work {
    /// Starts the workers.
    pub fn start(wake: Wake) -> Self {
        facts::keep_within(memory_budget::half_of_available() as usize / KEPT_SHARE);
        let (sender, events) = channel();
        let outbox = Outbox { sender, wake };
        let running = Running::default();
        Self {
            events,
            orders: orders::start(outbox.clone(), running.clone()),
            data: data::Loader::start(outbox.clone(), running.clone()),
            drawing: Drawing::start(outbox.clone()),
            slices: Slices::start(outbox.clone()),
            maps: Maps::start(outbox.clone()),
            picks: Picks::start(outbox.clone(), running.clone()),
            outbox,
            running,
            root: None,
        }
    }

    /// The next result, if there is one.
    pub(crate) fn next_event(&mut self) -> Option<Event> {
        let event = self.events.try_recv().ok()?;
        if let Event::Opened(snapshot) = &event {
            self.root = Some(snapshot.root.clone());
        }
        Some(event)
    }

    /// Carries out a task; `place` is where a failure is shown.
    pub fn run(&mut self, task: Task, place: Place) {
        let root = || self.root.clone();
        let order = match task {
            Task::Open(root) => orders::Order::Open(root, place),
            Task::Check(root, place) => orders::Order::Check(root, place),
            Task::Demo(folder) => orders::Order::Demo(folder, place),
            Task::Illustrate => match root() {
                Some(root) => orders::Order::Illustrate(root),
                None => return,
            },
            Task::Create { command, root } => orders::Order::Create { command, root },
            Task::Apply(command) => match root() {
                Some(root) => orders::Order::Apply { root, command, place },
                None => return,
            },
            Task::Undo => match root() {
                Some(root) => orders::Order::Undo(root),
                None => return,
            },
            Task::Redo => match root() {
                Some(root) => orders::Order::Redo(root),
                None => return,
            },
            Task::Picking(task) => {
                if let Some(root) = root() {
                    self.picks.run(task, root);
                }
                return;
            }
            Task::Release => {
                self.root = None;
                self.data.forget();
                self.picks.forget();
                spawn_quietly("forgetting a project", facts::drop_kept);
                return;
            }
            // The window handles these itself.
            Task::Remember | Task::Copy | Task::Export(_) | Task::ExportData(_) | Task::Share(_) => return,
        };
        // The thread lives as long as this value.
        let _ = self.orders.send(order);
    }

    /// Reads and computes what pictures of the open project need.
    pub fn load(&mut self, wanted: Wanted) {
        self.data.load(wanted);
    }

    /// Runs a job on a thread of its own; a job that the user stopped has not failed.
    pub fn background(
        &self,
        title: &str,
        place: Place,
        job: impl FnOnce(&Progress, &Outbox) -> Result<(), Notice> + Send + 'static,
    ) {
        let (outbox, running) = (self.outbox.clone(), self.running.clone());
        let title = title.to_owned();
        let theirs = outbox.clone();
        spawn("a background task", &theirs, move || {
            let (line, progress) = running.begin(title, place, outbox.wake.clone());
            match job(&progress, &outbox) {
                Err(notice) if progress.check().is_ok() => outbox.send(Event::Told(notice)),
                _ => {}
            }
            drop(line);
            outbox.wake();
        });
    }
}

/// Computes on all processors, at a lower priority than the window, so that it stays responsive.
///
/// A job must take no lock on the loaded data: the thread that holds the lock may be waiting for these processors. The
/// caller takes locks beforehand.
pub(super) fn compute<T: Send>(job: impl FnOnce() -> T + Send) -> T {
    static POOL: OnceLock<Option<rayon::ThreadPool>> = OnceLock::new();
    on(&POOL, threads::SOON, job)
}

/// The same on separate threads: jobs that take minutes must not delay the drawing of pictures.
fn compute_apart<T: Send>(job: impl FnOnce() -> T + Send) -> T {
    static POOL: OnceLock<Option<rayon::ThreadPool>> = OnceLock::new();
    on(&POOL, threads::LATER, job)
}

fn on<T: Send>(pool: &OnceLock<Option<rayon::ThreadPool>>, nice: i32, job: impl FnOnce() -> T + Send) -> T {
    let pool = pool.get_or_init(|| {
        let spared = usize::from(!threads::HAS_PRIORITIES);
        let threads = std::thread::available_parallelism().map_or(1, |count| count.get().saturating_sub(spared).max(1));
        let builder = rayon::ThreadPoolBuilder::new().num_threads(threads);
        builder.start_handler(move |_| threads::give_way(nice)).build().ok()
    });
    match pool {
        Some(pool) => pool.install(job),
        None => job(),
    }
}
