//! The window: draws the state, hands actions to it and tasks to the workers.

use super::error::WindowError;
use super::hold::{Hold, Taken};
use super::state::picking::Pick;
use super::state::{
    Action, Appearance, Dialogue, Layout, Look, Notice, Panel as Side, Picking, Place, Remembered, SliceKind, State,
    Task,
};
use super::theme;
use super::views::{
    bar, block::BlockView, chooser::Chooser, controls::Controls, data::Data, export, fence::FenceView,
    functions::Functions, import::Import, interpretation::Interpretation, layers::Layers, map::MapView, notices,
    overlay::Overlay, patterns::Patterns, picking::PickingPanel, pointed::Pointed, sections::Sections, shortcuts,
    start, status, tiles::Tiles, well::WellDialogue,
};
use super::work::{Event, Purpose, Rocks, Swatches, Wake, Wanted, Work};
use crate::command::Command;
use eframe::egui::{self, CentralPanel, Context, Frame, Panel, ThemePreference, Ui};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// How often it is written down how the project is looked at.
const MARK_EVERY: Duration = Duration::from_secs(5);
/// Size of a first window, points.
const SIZE: [f32; 2] = [1280.0, 800.0];
/// Smallest window, points.
const LEAST: [f32; 2] = [860.0, 560.0];

/// Opens the window and returns when it is closed.
///
/// # Errors
/// There is no display or no graphics driver.
pub fn run(project: Option<PathBuf>) -> Result<(), WindowError> {
    // Winit's own words for it are an error chain of its backends.
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
    let options = eframe::NativeOptions { viewport, ..eframe::NativeOptions::default() };
    eframe::run_native(
        "Petroglyph",
        options,
        Box::new(|created| Ok(Box::new(Window::new(&created.egui_ctx, Remembered::path(), project)))),
    )?;
    Ok(())
}

/// A selection, the horizon it is for, and the interpretation it is to be seen in.
type Wished = (Option<(Pick, Option<String>)>, u64);

/// The window's content.
pub struct Window {
    ctx: Context,
    state: State,
    work: Work,
    settings: Option<PathBuf>,
    /// Keeps the open project from being offered for recovery by another window.
    hold: Option<Hold>,
    block: BlockView,
    sections: Sections,
    fence: FenceView,
    map: MapView,
    layers: Layers,
    data: Data,
    functions: Functions,
    patterns: Patterns,
    import: Import,
    interpretation: Interpretation,
    well: WellDialogue,
    picking: PickingPanel,
    overlay: Overlay,
    /// State of the project that its interpretation was last asked for.
    followed: Option<(PathBuf, u32)>,
    /// Selection that was last asked for, and the interpretation it was asked of.
    selected: Option<Wished>,
    tiles: Tiles,
    swatches: Swatches,
    chooser: Chooser,
    controls: Controls,
    pointed: Option<Pointed>,
    rocks: Option<(Rocks, u64)>,
    wanted: Option<Wanted>,
    marked: Instant,
    /// What was selected or drawn when the view was last written down.
    unsaved: Option<(Option<Pick>, usize, usize)>,
}

impl Window {
    /// Begins with the start page, or with a project; `settings` is the file that outlives the window.
    pub fn new(ctx: &Context, settings: Option<PathBuf>, project: Option<PathBuf>) -> Self {
        theme::install(ctx);
        let mut remembered = settings.as_deref().map(Remembered::read).unwrap_or_default();
        // What another window has open was not left.
        remembered.left = remembered.left.filter(|left| !Hold::is_elsewhere(&left.root));
        let waking = ctx.clone();
        let wake: Wake = Arc::new(move || waking.request_repaint());
        let mut window = Self {
            ctx: ctx.clone(),
            state: State::new(remembered),
            work: Work::start(wake.clone()),
            settings,
            hold: None,
            block: BlockView::default(),
            sections: Sections::default(),
            fence: FenceView::default(),
            map: MapView::default(),
            layers: Layers::default(),
            data: Data::default(),
            functions: Functions::default(),
            patterns: Patterns::default(),
            import: Import::default(),
            interpretation: Interpretation::default(),
            well: WellDialogue::default(),
            picking: PickingPanel::default(),
            overlay: Overlay::default(),
            followed: None,
            selected: None,
            tiles: Tiles::default(),
            swatches: Swatches::start(wake),
            chooser: Chooser::default(),
            controls: Controls::default(),
            pointed: None,
            rocks: None,
            wanted: None,
            marked: Instant::now(),
            unsaved: None,
        };
        window.appear(ctx);
        if let Some(project) = project {
            window.act(Action::Open(std::path::absolute(&project).unwrap_or(project)));
        }
        window
    }

    /// What it shows.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Whether nothing is under way and the picture is the last word.
    pub fn is_settled(&self) -> bool {
        let drawable = self.state.session.as_ref().is_some_and(super::state::Session::is_drawable);
        self.work.running.is_idle() && (!drawable || self.block.is_settled())
    }

    /// Takes an action and has its tasks done.
    pub fn act(&mut self, action: Action) {
        for task in self.state.apply(action) {
            let place = self.place_of(&task);
            if matches!(task, Task::Remember) {
                self.remember();
            }
            if matches!(task, Task::Copy) {
                self.block.copy(&self.ctx);
            }
            if matches!(task, Task::Release) {
                self.forget();
            }
            self.work.run(task, place);
        }
    }

    /// Lets go of what was made of a project.
    fn forget(&mut self) {
        (self.rocks, self.wanted, self.pointed) = (None, None, None);
        (self.followed, self.selected, self.hold) = (None, None, None);
        self.block = BlockView::default();
        self.overlay = Overlay::default();
        self.picking = PickingPanel::default();
    }

    /// Where a failure of the task is shown.
    fn place_of(&self, task: &Task) -> Place {
        let Task::Apply(command) = task else { return Place::Block };
        match command.as_ref() {
            _ if self.state.dialogue.is_some() => Place::Dialogue,
            Command::SetLayer(_) | Command::ResetLayer(_) | Command::SetContact(_) => Place::Layers,
            Command::AddScene(_) | Command::RemoveScene(_) => Place::Scenes,
            Command::Pick(_)
            | Command::PickSeveral(_)
            | Command::MovePick(_)
            | Command::RemovePick(_)
            | Command::ReplayPicks(_)
            | Command::FillHorizon(_)
            | Command::SetHorizonColour(_)
            | Command::PickFault(_)
            | Command::AcceptFault(_) => Place::Interpret,
            _ if self.is_interpreting() => Place::Interpret,
            _ => Place::Data,
        }
    }

    fn remember(&mut self) {
        let Some(path) = &self.settings else { return };
        let mut remembered = self.state.remembered.clone();
        if remembered.left.is_none() {
            // Another window's project stays on record, should that one crash.
            remembered.left = Remembered::read(path).left.filter(|left| Hold::is_elsewhere(&left.root));
        }
        if let Err(error) = remembered.write(path) {
            let text = format!("recent projects cannot be remembered: {}: {error}", path.display());
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

    fn receive(&mut self, ctx: &Context) {
        while let Some(event) = self.work.next_event() {
            match event {
                Event::Opened(snapshot) => {
                    self.forget();
                    let taken = Hold::take(&snapshot.root);
                    self.act(Action::Opened(snapshot));
                    match taken {
                        Taken::Here(hold) => self.hold = hold,
                        Taken::Elsewhere(process) => {
                            let process = process.map_or_else(String::new, |id| format!(" (process {id})"));
                            let text = format!(
                                "this project is open in another window too{process}; what is changed there shows here after the next change here"
                            );
                            self.act(Action::Tell(Notice::note(Place::Block, text)));
                        }
                    }
                }
                Event::Changed(snapshot) => {
                    self.act(Action::Changed(snapshot));
                    let has_waited = matches!(
                        self.state.dialogue,
                        Some(
                            Dialogue::Survey { .. }
                                | Dialogue::Interpretation { .. }
                                | Dialogue::Well { .. }
                                | Dialogue::Choose(_)
                        )
                    );
                    if has_waited {
                        self.act(Action::Answered);
                    }
                }
                Event::Ready { root, rocks } => {
                    if self.state.session.as_ref().is_some_and(|session| session.root == root) {
                        let number = self.rocks.as_ref().map_or(1, |(_, number)| number + 1);
                        self.rocks = Some((rocks, number));
                    }
                }
                Event::Drawn(drawn) => self.block.receive(ctx, drawn),
                Event::Sliced(picture) => self.sections.receive(ctx, picture),
                Event::Fenced(picture) => self.fence.receive(ctx, picture),
                Event::Mapped(picture) => self.map.receive(ctx, picture),
                Event::Interpreted(shown) => {
                    if let Some(session) = self.state.session.as_ref().filter(|session| session.root == shown.root) {
                        self.overlay.receive(session, shown);
                    }
                }
                Event::Selected(shown) => {
                    if let Some(session) = &self.state.session {
                        self.overlay.select(session, shown);
                    }
                }
                Event::Picking(step) => self.act(Action::Picking(step)),
                Event::Erased(picks) => {
                    self.act(Action::Apply(Box::new(Command::PickSeveral(crate::command::PickNodes { picks }))));
                }
                Event::Exported(path) => {
                    self.act(Action::Answered);
                    self.act(Action::Tell(Notice::note(Place::Scenes, format!("written: {}", path.display()))));
                }
                Event::Told(notice) => self.act(Action::Tell(notice)),
            }
        }
    }

    /// Loads what the open project needs when it has changed.
    fn keep_loaded(&mut self) {
        let Some(session) = self.state.session.as_ref().filter(|session| session.is_drawable()) else { return };
        self.swatches.follow(&session.root, &session.document);
        // Neither named views nor the history change what is drawn from.
        let mut document = crate::project::Document { scenes: Vec::new(), step: 0, ..session.document.clone() };
        self.layers.draft_of(&mut document);
        self.functions.draft_of(&mut document);
        let exaggeration = session.view.scene.exaggeration;
        let root = session.root.clone();
        let wanted = if session.view.panel == Side::Interpret {
            // Picks change horizons and faults; what they are made on stays.
            document.horizons.clear();
            document.faults.clear();
            document.sticks.clear();
            document.layer_names.clear();
            let picking = &session.view.picking;
            let shows = picking.look == Look::SeeThrough || picking.show != render::FaceData::Rock;
            let extraction = self.overlay.interpreted().and_then(|shown| shown.key.clone()).filter(|_| shows);
            Wanted { root, document, exaggeration: 1.0, purpose: Purpose::Interpret { extraction } }
        } else {
            Wanted { root, document, exaggeration, purpose: Purpose::Illustrate }
        };
        if self.wanted.as_ref() != Some(&wanted) {
            self.work.load(wanted.clone());
            self.wanted = Some(wanted);
        }
    }

    fn is_interpreting(&self) -> bool {
        self.state.session.as_ref().is_some_and(|session| session.view.panel == Side::Interpret)
    }

    /// Has the interpretation read and the selection drawn when they have changed.
    fn keep_interpreted(&mut self) {
        let Some(session) = self.state.session.as_ref().filter(|session| session.view.panel == Side::Interpret) else {
            return;
        };
        if session.document.geometry.is_none() {
            return;
        }
        let now = (session.root.clone(), session.document.step);
        if self.followed.as_ref() != Some(&now) {
            self.work.picks.follow(session.root.clone(), session.document.clone());
            self.followed = Some(now);
        }
        let Picking { pick, horizon, accepted, .. } = &session.view.picking;
        // What was just accepted is shown until the project has it.
        let wished = pick.clone().or_else(|| accepted.clone()).map(|pick| (pick, horizon.clone()));
        let number = self.overlay.interpreted().map_or(0, |shown| shown.number);
        let selected = Some((wished, number));
        if self.selected != selected && number > 0 {
            if let Some((wished, _)) = &selected {
                self.work.picks.draw(wished.clone());
            }
            self.selected = selected;
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
        shortcuts::obey(&ctx, &self.state, &mut actions);
        let running = self.work.running.lines();
        Panel::bottom("status").exact_size(32.0).show(ui, |ui| {
            status::show(ui, self.state.session.as_ref(), self.pointed.as_ref(), &running, self.block.device());
        });
        if self.state.session.is_some() {
            self.work_page(ui, &running, &mut actions);
        } else {
            CentralPanel::default().show(ui, |ui| start::show(ui, &self.state, !running.is_empty(), &mut actions));
        }
        self.dialogues(&ctx, &mut actions);
        for action in actions {
            self.act(action);
        }
        // What is selected or drawn and not yet part of the project is work: it is written down at once.
        let unsaved = self.state.session.as_ref().map(|session| {
            let picking = &session.view.picking;
            (picking.pick.clone(), picking.stick.len(), picking.sticks.len())
        });
        let is_work = unsaved != self.unsaved;
        self.unsaved = unsaved;
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

    fn work_page(&mut self, ui: &mut Ui, running: &[super::work::RunningLine], actions: &mut Vec<Action>) {
        let Some(session) = &self.state.session else { return };
        Panel::top("bar").exact_size(44.0).show(ui, |ui| {
            ui.add_space(7.0);
            bar::show(ui, &self.state, session, actions);
        });
        Panel::left("side").default_size(300.0).min_size(240.0).show(ui, |ui| {
            ui.add_space(6.0);
            ui.horizontal(|ui| {
                for (side, name, hint) in [
                    (Side::Layers, "Layers", "The stratigraphic column (L)"),
                    (Side::Data, "Data", "Volumes, horizons, faults and wells (D)"),
                    (Side::Values, "Values", "Colours and textures by value (V)"),
                    (Side::Interpret, "Interpret", "Candidates, picks and faults (P)"),
                ] {
                    if ui.selectable_label(session.view.panel == side, name).on_hover_text(hint).clicked() {
                        actions.push(Action::Panel(side));
                    }
                }
            });
            ui.separator();
            match session.view.panel {
                Side::Layers => {
                    self.layers.show(ui, &self.state, session, &self.swatches, &mut self.tiles, actions);
                }
                Side::Data => self.data.show(ui, &self.state, session, actions),
                Side::Interpret => {
                    self.picking.show(ui, &self.state, session, &self.overlay, running, actions);
                }
                Side::Values => {
                    notices::show(ui, &self.state, Place::Data, actions);
                    let rocks = self.rocks.as_ref().map(|(rocks, number)| (rocks, *number));
                    egui::ScrollArea::vertical().show(ui, |ui| {
                        self.functions.show(ui, session, rocks, &self.swatches, actions);
                    });
                }
            }
        });
        Panel::right("controls").default_size(300.0).min_size(240.0).show(ui, |ui| {
            self.controls.show(ui, &self.state, session, actions);
        });
        let frame = Frame::new().fill(ui.visuals().panel_fill);
        CentralPanel::no_frame().frame(frame).show(ui, |ui| {
            notices::show(ui, &self.state, Place::Block, actions);
            if !session.is_drawable() {
                Frame::new().inner_margin(40.0).show(ui, |ui| {
                    ui.heading("Nothing to draw yet");
                    ui.label("Add a volume or horizons: Project, at the top left.");
                });
                return;
            }
            let rocks = self.rocks.as_ref().map(|(rocks, number)| (rocks, *number));
            match session.view.layout {
                Layout::Block => {
                    self.pointed = self.block.show(ui, session, rocks, &self.work.drawing, &self.overlay, actions);
                }
                Layout::Map => {
                    let (left, right) = ui.available_rect_before_wrap().split_left_right_at_fraction(0.5);
                    ui.scope_builder(egui::UiBuilder::new().max_rect(left), |ui| {
                        self.pointed = self.block.show(ui, session, rocks, &self.work.drawing, &self.overlay, actions);
                    });
                    ui.scope_builder(egui::UiBuilder::new().max_rect(right.shrink(6.0)), |ui| {
                        self.map.show(ui, session, rocks, &self.work.maps, actions);
                    });
                    ui.advance_cursor_after_rect(left.union(right));
                }
                Layout::Fence => {
                    let (left, right) = ui.available_rect_before_wrap().split_left_right_at_fraction(0.4);
                    let mut pointed = None;
                    ui.scope_builder(egui::UiBuilder::new().max_rect(left.shrink(3.0)), |ui| {
                        let (slices, overlay) = (&self.work.slices, &mut self.overlay);
                        pointed = self.sections.show(ui, session, SliceKind::Slice, rocks, slices, overlay, actions);
                    });
                    ui.scope_builder(egui::UiBuilder::new().max_rect(right.shrink(3.0)), |ui| {
                        let found = self.fence.show(ui, session, rocks, &self.work.slices, &self.overlay, actions);
                        pointed = pointed.take().or(found);
                    });
                    ui.advance_cursor_after_rect(left.union(right));
                    self.pointed = pointed;
                }
                Layout::Sections => {
                    let mut pointed = None;
                    let mut quarter = |ui: &mut Ui, kind: Option<SliceKind>| {
                        let found = match kind {
                            None => self.block.show(ui, session, rocks, &self.work.drawing, &self.overlay, actions),
                            Some(kind) => self.sections.show(
                                ui,
                                session,
                                kind,
                                rocks,
                                &self.work.slices,
                                &mut self.overlay,
                                actions,
                            ),
                        };
                        pointed = pointed.take().or(found);
                    };
                    let rows = [[None, Some(SliceKind::Inline)], [Some(SliceKind::Slice), Some(SliceKind::Crossline)]];
                    quarters(ui, rows, &mut quarter);
                    self.pointed = pointed;
                }
            }
        });
    }

    fn dialogues(&mut self, ctx: &Context, actions: &mut Vec<Action>) {
        match &self.state.dialogue {
            Some(Dialogue::Choose(choice)) => self.chooser.show(ctx, &self.state, *choice, actions),
            Some(Dialogue::Shortcuts) => shortcuts::dialogue(ctx, actions),
            Some(Dialogue::Survey { path, target }) => {
                self.import.show(ctx, &self.state, &self.work, path, *target, actions);
            }
            Some(Dialogue::Interpretation { path, kind }) => {
                if let Some(session) = &self.state.session {
                    self.interpretation.show(ctx, &self.state, session, &self.work, path, *kind, actions);
                }
            }
            Some(Dialogue::Well { path }) => self.well.show(ctx, &self.state, &self.work, path, actions),
            Some(Dialogue::Patterns { layer, interval }) => {
                if let Some(session) = &self.state.session {
                    let (swatches, tiles) = (&self.swatches, &mut self.tiles);
                    self.patterns.show(ctx, &self.state, session, layer, *interval, swatches, tiles, actions);
                }
            }
            Some(Dialogue::Export(form)) => {
                if let Some(session) = &self.state.session {
                    let is_drawing = self.work.running.lines().iter().any(|line| line.place == Place::Dialogue);
                    export::show(ctx, &self.state, session, form, is_drawing, actions);
                }
            }
            None => {}
        }
    }
}

/// Divides all the room there is into two rows of two.
fn quarters<T: Copy>(ui: &mut Ui, rows: [[T; 2]; 2], show: &mut impl FnMut(&mut Ui, T)) {
    let whole = ui.available_rect_before_wrap();
    let (top, bottom) = whole.split_top_bottom_at_fraction(0.5);
    for (row, half) in rows.into_iter().zip([top, bottom]) {
        let (left, right) = half.split_left_right_at_fraction(0.5);
        for (what, quarter) in row.into_iter().zip([left, right]) {
            ui.scope_builder(egui::UiBuilder::new().max_rect(quarter.shrink(3.0)), |ui| show(ui, what));
        }
    }
    ui.advance_cursor_after_rect(whole);
}

impl eframe::App for Window {
    fn ui(&mut self, ui: &mut Ui, _frame: &mut eframe::Frame) {
        self.show(ui);
    }

    fn on_exit(&mut self) {
        // Closed properly: there is nothing to recover.
        self.state.remembered.left = None;
        self.hold = None;
        self.remember();
    }
}
