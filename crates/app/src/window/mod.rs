//! The window: draws the state, hands actions to it and tasks to the workers.

mod follow;
mod frames;
mod lettering;
mod page;
mod present;
mod project_views;
mod share;

use super::error::WindowError;
use super::hold::Hold;
use super::views::file_drop::{self, Dropped};
use super::views::{
    chooser::Chooser, data_file, export, import::Import, print::Page, shortcuts, start::StartPage, status,
};
use super::work::{Event, Swatches, Wake, Work};
use crate::widgets::event_order::EventOrder;
use crate::widgets::keyboard::Listener;
use crate::widgets::theme;
use eframe::egui::{self, CentralPanel, Context, Panel, ThemePreference, Ui};
use frames::FrameTimes;
use project::Project;
use project::command::{Command, Remove, Rename, SetColour};
use project::error::Noun;
use project_views::ProjectViews;
use state::{Action, Appearance, DataForm, Dialogue, ExportForm, Notice, Place, Remembered, State, Task, Written};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Interval at which the view is saved.
const MARK_EVERY: Duration = Duration::from_secs(5);
/// Size of the window at its first start, points.
const SIZE: [f32; 2] = [1280.0, 800.0];
/// Smallest window, points.
const LEAST: [f32; 2] = [860.0, 560.0];

/// Opens the window and returns when it is closed. With `frame_times`, frames follow one another without pause, and the
/// duration of each is written to that file.
///
/// # Errors
/// There is no display, there is no graphics driver, or the file cannot be written.
pub fn run(project: Option<PathBuf>, frame_times: Option<&Path>) -> Result<(), WindowError> {
    let frames = frame_times.map(FrameTimes::create).transpose()?;
    // Winit's own message for this is an error chain of its back ends.
    #[cfg(all(unix, not(target_os = "macos")))]
    if ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"]
        .iter()
        .all(|name| std::env::var_os(name).is_none_or(|v| v.is_empty()))
    {
        return Err(WindowError::NoDisplay { reason: "neither DISPLAY nor WAYLAND_DISPLAY is set".to_owned() });
    }
    let viewport = egui::ViewportBuilder::default()
        .with_title("Petroglyph")
        .with_app_id("petroglyph")
        .with_inner_size(SIZE)
        .with_min_inner_size(LEAST);
    // Dithering serves gradients, of which there are none here, and it costs a software driver time at every pixel.
    let options = eframe::NativeOptions { viewport, dithering: false, ..eframe::NativeOptions::default() };
    eframe::run_native(
        "Petroglyph",
        options,
        Box::new(|created| {
            let window = Window::new(&created.egui_ctx, Remembered::path(), project);
            Ok(Box::new(Window { frames, ..window }))
        }),
    )?;
    Ok(())
}

/// The window's content.
pub struct Window {
    ctx: Context,
    state: State,
    work: Work,
    settings: Option<PathBuf>,
    /// The views of the open project.
    views: ProjectViews,
    start: StartPage,
    import: Import,
    swatches: Swatches,
    chooser: Chooser,
    dropped: Dropped,
    listener: Listener,
    /// The project that the window's title names.
    titled: Option<String>,
    /// Whether the window was asked to fill the screen.
    is_full: bool,
    marked: Instant,
    /// The table of frame times, if it is wanted.
    frames: Option<FrameTimes>,
}

impl Window {
    /// Opens with the start page, or with a project; `settings` is the file of what outlives the window.
    pub fn new(ctx: &Context, settings: Option<PathBuf>, project: Option<PathBuf>) -> Self {
        theme::install(ctx);
        EventOrder::install(ctx);
        let mut remembered = settings.as_deref().map(Remembered::read).unwrap_or_default();
        // A project that another window has open was not left by a crash.
        remembered.left = remembered.left.filter(|left| !Hold::is_elsewhere(&left.root));
        let waking = ctx.clone();
        let wake: Wake = Arc::new(move || waking.request_repaint());
        let mut window = Self {
            ctx: ctx.clone(),
            state: State::new(remembered),
            work: Work::start(wake.clone()),
            settings,
            views: ProjectViews::default(),
            start: StartPage::default(),
            import: Import::default(),
            swatches: Swatches::start(wake),
            chooser: Chooser::default(),
            dropped: Dropped::default(),
            listener: Listener::default(),
            titled: None,
            is_full: false,
            marked: Instant::now(),
            frames: None,
        };
        window.appear(ctx);
        if let Some(project) = project {
            window.act(Action::Open(std::path::absolute(&project).unwrap_or(project)));
        }
        window
    }

    /// The present state.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Whether nothing is under way and the picture is final.
    pub fn is_settled(&self) -> bool {
        let drawable = self.state.session.as_ref().is_some_and(state::Session::is_drawable);
        self.work.running.is_idle() && (!drawable || self.views.block.is_settled())
    }

    /// The number of the picture of the block that is on the screen: later pictures have larger ones.
    pub fn picture_number(&self) -> u64 {
        self.views.block.picture_number()
    }

    /// Applies an action and has its tasks carried out.
    pub fn act(&mut self, action: Action) {
        for task in self.state.apply(action) {
            let place = self.place_of(&task);
            if matches!(task, Task::Remember) {
                self.remember();
            }
            if matches!(task, Task::Copy) {
                self.views.block.copy(&self.ctx);
            }
            if matches!(task, Task::Release) {
                self.views = ProjectViews::default();
            }
            if let Task::Export(form) = &task {
                self.export(form.as_ref().clone());
            }
            if let Task::Share(form) = &task {
                self.share(form.as_ref().clone());
            }
            if let Task::ExportData(form) = &task {
                self.export_data(form.as_ref().clone());
            }
            self.work.run(task, place);
        }
    }

    /// Writes a volume, a horizon or a fault for other programs.
    fn export_data(&self, form: DataForm) {
        let Some(root) = self.state.session.as_ref().map(|session| session.root.clone()) else { return };
        self.work.background("Writing the file", Place::Dialogue, move |progress, outbox| {
            let DataForm { what, name, path } = form;
            let path = PathBuf::from(path.trim());
            let write = |project: Project| match what {
                Written::Surface(kind, format) => {
                    let options = files::ExportOptions::default();
                    let surface = (kind, name.as_str());
                    Ok(project::exports::surface::write(&project, &path, surface, (format, &options), progress)?.notes)
                }
                Written::Volume(format) => {
                    let written = project::exports::volume::write(&project, &path, &name, format, progress)?;
                    let clipped = format!("{} samples do not fit the format and were clipped", written.clipped);
                    Ok((written.clipped > 0).then_some(clipped).into_iter().collect())
                }
            };
            let written = Project::open(&root).and_then(write);
            let notes: Vec<String> = written.map_err(|error| Notice::failure(Place::Dialogue, &error))?;
            outbox.send(Event::Exported(path));
            let notes = notes.into_iter().map(|note| Event::Told(Notice::note(Place::Data, note)));
            notes.for_each(|note| outbox.send(note));
            Ok(())
        });
    }

    /// Draws the page to a file.
    fn export(&self, form: ExportForm) {
        let Some(page) = self.page(&form) else { return };
        self.work.background("Drawing the picture", Place::Dialogue, move |progress, outbox| {
            let path = form.path.clone().into();
            page.write(progress).map_err(|error| Notice::failure(Place::Dialogue, &error))?;
            outbox.send(Event::Exported(path));
            Ok(())
        });
    }

    /// Lays the page out to be looked at.
    fn look_at(&mut self, form: ExportForm) {
        let Some(page) = self.page(&form) else { return };
        self.views.previewed = Some(form);
        self.work.background("Laying out the page", Place::Dialogue, move |progress, outbox| {
            let (page, preset) = page.preview(progress).map_err(|error| Notice::failure(Place::Dialogue, &error))?;
            outbox.send(Event::Previewed(Arc::new(page), preset));
            Ok(())
        });
    }

    /// What is on the screen as a page.
    fn page(&self, form: &ExportForm) -> Option<Page> {
        let session = self.state.session.as_ref()?;
        Page::of(session, &self.views.overlay, &self.views.sections, self.views.map.mapped(session), form)
    }

    /// Where a failure of the task is shown.
    fn place_of(&self, task: &Task) -> Place {
        let command = match task {
            Task::Apply(command) => command,
            Task::Open(_) if self.state.dialogue.is_some() => return Place::Dialogue,
            Task::Open(_) | Task::Demo(_) if self.state.session.is_none() => return Place::Start,
            _ => return Place::Block,
        };
        match command.as_ref() {
            _ if self.state.dialogue.is_some() => Place::Dialogue,
            Command::SetLayer(_) | Command::ResetLayer(_) | Command::SetContact(_) => Place::Layers,
            Command::AddScene(_)
            | Command::AddNote(_)
            | Command::Rename(Rename { noun: Noun::Scene, .. })
            | Command::Remove(Remove { noun: Noun::Scene | Noun::Note, .. }) => Place::Scenes,
            Command::Pick(_)
            | Command::PickSeveral(_)
            | Command::DrawHorizon(_)
            | Command::MovePick(_)
            | Command::RemovePick(_)
            | Command::ReplayPicks(_)
            | Command::FillHorizon(_)
            | Command::SmoothHorizon(_)
            | Command::SetColour(SetColour { noun: Noun::Horizon, .. })
            | Command::PickFault(_)
            | Command::MoveStickPoint(_)
            | Command::CutFault(_)
            | Command::MergeFaults(_)
            | Command::GiveSticks(_)
            | Command::AcceptFault(_) => Place::Interpret,
            _ if self.is_interpreting() => Place::Interpret,
            _ => Place::Data,
        }
    }

    fn remember(&mut self) {
        let Some(path) = &self.settings else { return };
        let mut remembered = self.state.remembered.clone();
        if remembered.left.is_none() {
            // The project of another window stays on record, in case that window crashes.
            remembered.left = Remembered::read(path).left.filter(|left| Hold::is_elsewhere(&left.root));
        }
        if let Err(error) = remembered.write(path) {
            let text = format!("the list of recent projects could not be saved: {}: {error}", path.display());
            self.state.apply(Action::Tell(Notice::note(Place::Start, text)));
        }
    }

    fn appear(&self, ctx: &Context) {
        ctx.set_theme(match self.state.remembered.appearance {
            Appearance::System => ThemePreference::System,
            Appearance::Light => ThemePreference::Light,
            Appearance::Dark => ThemePreference::Dark,
        });
        ctx.set_zoom_factor(self.state.remembered.scale.unwrap_or(1.0));
    }

    /// Names the open project in the title of the window.
    fn entitle(&mut self, ctx: &Context) {
        let name = self.state.session.as_ref().map(state::Session::name);
        if self.titled != name {
            let title = name.as_ref().map_or_else(|| "Petroglyph".to_owned(), |name| format!("{name} – Petroglyph"));
            ctx.send_viewport_cmd(egui::ViewportCommand::Title(title));
            self.titled = name;
        }
    }

    /// Draws everything.
    pub fn show(&mut self, ui: &mut Ui) {
        let ctx = ui.ctx().clone();
        self.receive(&ctx);
        self.appear(&ctx);
        self.keep_loaded();
        self.keep_interpreted();
        let mut actions = Vec::new();
        shortcuts::obey(&ctx, &self.state, &self.listener, &mut actions);
        let running = self.work.running.lines();
        if self.presented(ui, &mut actions) {
            self.listener.end_frame(&ctx);
            actions.into_iter().for_each(|action| self.act(action));
            return;
        }
        self.dropped.receive(&ctx, &self.state, !running.is_empty(), &mut actions);
        Panel::bottom("status").exact_size(32.0).show(ui, |ui| {
            let drawable = self.state.session.as_ref().is_some_and(state::Session::is_drawable);
            let device = (drawable && !self.views.block.is_settled(), self.views.block.device());
            let interpreted = self.views.overlay.interpreted().filter(|_| self.is_interpreting()).map(AsRef::as_ref);
            let pointed = (self.views.pointed.as_ref(), interpreted);
            status::show(ui, &self.state, pointed, &running, device, &mut actions);
        });
        if self.state.session.is_some() {
            self.work_page(ui, &running, &mut actions);
        } else {
            CentralPanel::default().show(ui, |ui| self.start.show(ui, &self.state, !running.is_empty(), &mut actions));
        }
        self.dialogues(&ctx, &mut actions);
        self.entitle(&ctx);
        self.listener.end_frame(&ctx);
        for action in actions {
            self.act(action);
        }
        // The selection and the sticks that are not yet part of the project are work, so they are saved at once.
        let unsaved = self.state.session.as_ref().map(|session| {
            let picking = &session.view.picking;
            (picking.pick.clone(), picking.stick.len(), picking.sticks.len())
        });
        let is_work = unsaved != self.views.unsaved;
        self.views.unsaved = unsaved;
        if self.state.session.is_some() && (is_work || self.marked.elapsed() > MARK_EVERY) {
            self.marked = Instant::now();
            let before = self.state.remembered.left.clone();
            self.state.mark();
            if self.state.remembered.left != before {
                self.remember();
            }
            ctx.request_repaint_after(MARK_EVERY);
        }
    }

    fn dialogues(&mut self, ctx: &Context, actions: &mut Vec<Action>) {
        if !matches!(self.state.dialogue, Some(Dialogue::Choose(_))) {
            self.chooser.forget();
        }
        match &self.state.dialogue {
            Some(Dialogue::Choose(choice)) => self.chooser.show(ctx, &self.state, *choice, actions),
            Some(Dialogue::Shortcuts) => shortcuts::dialogue(ctx, actions),
            Some(Dialogue::Survey { path, target }) => {
                self.import.show(ctx, &self.state, &self.work, path, *target, actions);
            }
            Some(Dialogue::Interpretation { path, kind }) => {
                if let Some(session) = &self.state.session {
                    self.views.interpretation.show(ctx, &self.state, session, &self.work, path, *kind, actions);
                }
            }
            Some(Dialogue::Dropped { path }) => file_drop::dialogue(ctx, path, actions),
            Some(Dialogue::Well { path }) => self.views.well.show(ctx, &self.state, &self.work, path, actions),
            Some(Dialogue::Patterns { layer, interval }) => {
                if let Some(session) = &self.state.session {
                    let (swatches, tiles) = (&self.swatches, &mut self.views.tiles);
                    self.views.patterns.show(ctx, &self.state, session, layer, *interval, swatches, tiles, actions);
                }
            }
            Some(Dialogue::Export(form)) => {
                if let Some(session) = &self.state.session {
                    let is_drawing = self.work.running.lines().iter().any(|line| line.place == Place::Dialogue);
                    let sparse = self.views.rocks.as_ref().map_or_else(Vec::new, |loaded| loaded.sparse());
                    let shows = export::Shows { form, is_drawing, sparse: &sparse };
                    let asks = export::show(ctx, &self.state, session, shows, &mut self.views.preview, actions);
                    // Where the file lies changes nothing on the page.
                    let form = ExportForm { path: String::new(), ..form.clone() };
                    let is_outdated =
                        self.views.preview.has_page() && !is_drawing && self.views.previewed.as_ref() != Some(&form);
                    if asks || is_outdated {
                        self.look_at(form);
                    }
                }
            }
            Some(Dialogue::Share(_)) => self.share_dialogue(ctx, actions),
            Some(Dialogue::Data(form)) => data_file::dialogue(ctx, &self.state, form, actions),
            None => {
                (self.views.preview, self.views.share) = Default::default();
            }
        }
    }
}

impl eframe::App for Window {
    fn ui(&mut self, ui: &mut Ui, _frame: &mut eframe::Frame) {
        let start = Instant::now();
        self.show(ui);
        if let Some(frames) = &mut self.frames {
            frames.record(start, &self.work.running.lines());
            ui.ctx().request_repaint();
        }
    }

    fn on_exit(&mut self) {
        self.state.put_by();
        // The window is closed properly, so there is nothing to recover.
        self.state.remembered.left = None;
        self.views.hold = None;
        self.remember();
    }
}
