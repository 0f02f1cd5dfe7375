//! What the interpretation needs: candidates in memory, the horizons' sheets, the leaf under a click, the selected node
//! as sheets.
//!
//! One thread holds the present extraction and what was made of it, so that a click takes milliseconds: of the next state
//! it asks for the same facts, and what has not changed is found in memory. Orders are carried out in turn, except that
//! of several states to follow, or selections to draw, only the last counts. Extracting and proposing faults take long
//! and run on threads and processors of their own. Places are voxels unless stated otherwise.

mod subject;

use super::orders::snapshot;
use super::running::{Job, Running};
use super::{Event, Outbox, compute_apart, keep_working, spawn};
use crate::state::picking::Pick;
use crate::state::{Notice, PickingStep, PickingTask, Place, Snapshot};
use figure::interpretation::{DrawnInterpretation, FaultMesh, PickedSheets, SheetHole, TraceSheet};
use glam::DVec3;
use interp::ExtractReport;
use interp::assembly::{ClimbSettings, highest_valid, selected_leaves};
use interp::faults::Proposal;
use interp::holes::{Hole, find_holes};
use interp::reassembly::{VoxelSheet, reassemble};
use model::picked_share;
use project::Project;
use project::command::{Command, Effect, Extract, ProposeFaults};
use project::content;
use project::document::Assembly;
use project::document::Document;
use project::error::ProjectError;
use project::folder::DEFAULT_WAIT;
use project::interpretation::assembly::{self, AssemblyReport, ReportedOverlap, conflicts_of, report_on, sentence};
use project::interpretation::candidates::Candidates;
use project::interpretation::proposals;
use project::pictures::PickedShare;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use subject::Followed;
use survey::{Fault, Progress, SurveyGeometry};
use ttf::Colour;

/// A horizon of the project, with what is drawn and reported of it.
pub struct InterpretedHorizon {
    /// Its name.
    pub name: String,
    /// The colour chosen for it, if it was assembled from picks.
    pub colour: Option<Colour>,
    /// Its sheets.
    pub sheets: Arc<Vec<VoxelSheet>>,
    /// Its leaves.
    pub leaves: Vec<u32>,
    /// Coverage and overlap; places in line numbers.
    pub report: AssemblyReport,
    /// Share of the traces on which it was picked, or near them.
    pub picked: PickedShare,
    /// Number of its nodes that were filled, not picked.
    pub filled: usize,
    /// Its holes, largest first.
    pub holes: Vec<Hole>,
    /// Its conflicts with other horizons, in words.
    pub conflicts: Vec<String>,
    /// Whether its picks were made on another extraction than the present one.
    pub outdated: bool,
}

/// A fault, with what is drawn of it.
pub struct ShownFault {
    /// Its name.
    pub name: String,
    /// Its colour.
    pub colour: Colour,
    /// Its triangles.
    pub triangles: Vec<[DVec3; 3]>,
}

/// The present interpretation.
pub struct Interpreted {
    /// The project.
    pub root: PathBuf,
    /// The step of its history.
    pub step: u32,
    /// A number that no other interpretation has.
    pub number: u64,
    /// The horizons, youngest first.
    pub horizons: Vec<InterpretedHorizon>,
    /// The faults, in the project's order.
    pub faults: Vec<ShownFault>,
    /// The report of the present extraction, if there is one.
    pub extraction: Option<ExtractReport>,
    /// Key of that extraction.
    pub key: Option<String>,
    /// The faults proposed for the present horizons.
    pub proposals: Vec<(Proposal, ShownFault)>,
    /// Unit of their throws.
    pub unit: String,
}

/// A sheet in the form that figures take.
pub fn sheet(sheet: &VoxelSheet) -> TraceSheet<'_> {
    project::pictures::figures::borrowed(sheet)
}

impl Interpreted {
    /// The interpretation in the form that figures take, with the proposals that are to be shown; sticks and the
    /// selection belong to the view.
    pub fn seen(&self, shows: impl Fn(&Proposal) -> bool) -> DrawnInterpretation<'_> {
        let horizons = self.horizons.iter().enumerate().map(|(index, horizon)| PickedSheets {
            name: &horizon.name,
            colour: figure::style::horizon_colour(horizon.colour, index),
            sheets: horizon.sheets.iter().map(sheet).collect(),
            holes: horizon.holes.iter().map(|hole| SheetHole { block: hole.block, traces: hole.nodes() }).collect(),
        });
        let proposals = self.proposals.iter().filter(|(proposal, _)| shows(proposal));
        DrawnInterpretation {
            horizons: horizons.collect(),
            faults: self.faults.iter().map(ShownFault::mesh).collect(),
            proposals: proposals.map(|(_, fault)| fault.mesh()).collect(),
            ..DrawnInterpretation::default()
        }
    }

    /// The horizons alone.
    pub(crate) fn horizons_seen(&self) -> DrawnInterpretation<'_> {
        self.seen(|_| false)
    }
}

impl ShownFault {
    /// In the form that figures take.
    pub fn mesh(&self) -> FaultMesh<'_> {
        FaultMesh { name: &self.name, colour: self.colour, triangles: &self.triangles }
    }
}

/// The selected node, with what is drawn and reported of it.
pub struct ShownPick {
    /// The selection.
    pub pick: Pick,
    /// Its sheets.
    pub sheets: Vec<VoxelSheet>,
    /// Number of triangles of the node.
    pub triangles: usize,
    /// Its leaves.
    pub leaves: Vec<u32>,
    /// Where it would overlap the horizon or itself, in line numbers.
    pub overlap: Option<ReportedOverlap>,
    /// Whether the overlap exceeds what noise causes.
    pub is_wrong: bool,
}

enum Order {
    Follow(PathBuf, Box<Document>),
    Renew,
    Draw(Option<(Pick, Option<String>)>),
    Do(PickingTask, PathBuf),
    Forget,
}

/// The thread.
pub struct Picks {
    orders: Sender<Order>,
    outbox: Outbox,
    running: Running,
}

impl Picks {
    pub(super) fn start(outbox: Outbox, running: Running) -> Self {
        let (orders, received) = channel();
        let mut keeper = Keeper::new(outbox.clone(), running.clone());
        keep_working("the interpretation", &outbox, move || keeper.work(&received));
        Self { orders, outbox, running }
    }

    /// Reads what this state of a project needs and has not been read yet.
    pub(crate) fn follow(&self, root: PathBuf, document: Document) {
        let _ = self.orders.send(Order::Follow(root, Box::new(document)));
    }

    /// Makes the sheets of a selection for a horizon; with `None`, no selection is shown.
    pub fn draw(&self, selection: Option<(Pick, Option<String>)>) {
        let _ = self.orders.send(Order::Draw(selection));
    }

    /// Drops everything that was read.
    pub fn forget(&self) {
        let _ = self.orders.send(Order::Forget);
    }

    /// Carries out a task.
    pub(super) fn run(&self, task: PickingTask, root: PathBuf) {
        let (outbox, running, orders) = (self.outbox.clone(), self.running.clone(), self.orders.clone());
        let told = outbox.clone();
        match task {
            PickingTask::Extract(volume, settings) => spawn("the extraction", &told, move || {
                let (guard, progress) = running.begin(Job::Extraction, Place::Interpret, outbox.wake.clone());
                let done = compute_apart(|| {
                    let mut project = Project::open(&root)?.waiting(DEFAULT_WAIT);
                    project.apply(
                        &Command::Extract(Extract {
                            volume,
                            settings: *settings,
                            memory_bytes: None,
                            just_stored: false,
                        }),
                        &progress,
                    )?;
                    snapshot(&project)
                });
                let warnings = guard.warnings();
                drop(guard);
                for warning in warnings {
                    outbox.send(Event::Told(Notice::note(Place::Interpret, warning)));
                }
                tell_change(done, &progress, &outbox);
                let _ = orders.send(Order::Renew);
            }),
            PickingTask::ProposeFaults => spawn("fault proposals", &told, move || {
                let (guard, progress) = running.begin(Job::FaultProposals, Place::Interpret, outbox.wake.clone());
                let done = compute_apart(|| {
                    let mut project = Project::open(&root)?.waiting(DEFAULT_WAIT);
                    let effect = project.apply(&Command::ProposeFaults(ProposeFaults::default()), &progress)?;
                    Ok((snapshot(&project)?, effect))
                });
                drop(guard);
                if let Ok((_, Effect::FaultsProposed(found))) = &done
                    && let Some(text) = found.nothing_new()
                {
                    outbox.send(Event::Told(Notice::note(Place::Interpret, text)));
                }
                tell_change(done.map(|(snapshot, _)| snapshot), &progress, &outbox);
                let _ = orders.send(Order::Renew);
            }),
            task => drop(orders.send(Order::Do(task, root))),
        }
    }
}

/// Reports the new state of the project, or why it has not changed.
fn tell_change(done: Result<Snapshot, ProjectError>, progress: &Progress, outbox: &Outbox) {
    let done = done.map(|snapshot| {
        outbox.send(Event::Changed { snapshot: Box::new(snapshot), place: Place::Interpret });
    });
    tell(done, Some(progress), outbox);
}

/// Reports a failure; a job that the user stopped has not failed.
fn tell(done: Result<(), ProjectError>, progress: Option<&Progress>, outbox: &Outbox) {
    match done {
        Ok(()) => outbox.wake(),
        Err(_) if progress.is_some_and(|progress| progress.check().is_err()) => outbox.wake(),
        Err(error) => outbox.send(Event::Told(Notice::failure(Place::Interpret, &error))),
    }
}

struct Keeper {
    outbox: Outbox,
    running: Running,
    followed: Option<Followed>,
    number: u64,
}

impl Keeper {
    fn new(outbox: Outbox, running: Running) -> Self {
        Self { outbox, running, followed: None, number: 0 }
    }

    fn work(&mut self, orders: &Receiver<Order>) {
        while let Ok(first) = orders.recv() {
            let mut queue: Vec<Order> = std::iter::once(first).chain(orders.try_iter()).collect();
            // Of several orders of a kind only the last counts.
            for is_kind in [
                (|order| matches!(order, Order::Draw(_))) as fn(&Order) -> bool,
                |order| matches!(order, Order::Follow(..)),
                |order| matches!(order, Order::Renew),
            ] {
                if let Some(last) = queue.iter().rposition(is_kind) {
                    let mut index = 0;
                    queue.retain(|order| {
                        index += 1;
                        index - 1 == last || !is_kind(order)
                    });
                }
            }
            for order in queue {
                if let Err(error) = self.carry_out(order) {
                    tell(Err(error), None, &self.outbox);
                }
            }
        }
    }

    fn carry_out(&mut self, order: Order) -> Result<(), ProjectError> {
        match order {
            Order::Forget => self.followed = None,
            Order::Follow(root, document) => self.follow(root, *document)?,
            Order::Renew => {
                let known = self.followed.as_ref().map(|known| (known.root.clone(), known.document.clone()));
                if let Some((root, document)) = known {
                    self.follow(root, document)?;
                }
            }
            Order::Draw(None) => self.outbox.send(Event::Selected(None)),
            Order::Draw(Some((pick, horizon))) => {
                let followed = self.followed.as_ref().ok_or(ProjectError::NotExtracted)?;
                if let Some(shown) = followed.show(pick, horizon.as_deref())? {
                    self.outbox.send(Event::Selected(Some(Arc::new(shown))));
                }
            }
            Order::Do(task, root) => self.answer(task, root)?,
        }
        Ok(())
    }

    /// Carries out a task for the project that it was requested for.
    fn answer(&self, task: PickingTask, root: PathBuf) -> Result<(), ProjectError> {
        let followed = self.followed.as_ref().filter(|followed| followed.root == root);
        let followed = followed.ok_or(ProjectError::NotExtracted)?;
        let candidates = followed.candidates()?;
        let found = match task {
            PickingTask::Find(at) => {
                let hit = candidates.leaf_near(&followed.geometry, at)?;
                Pick { at, leaf: hit.leaf, up: 0, levels: candidates.levels(hit.leaf) }
            }
            PickingTask::HighestValid(pick, horizon) => {
                let chosen = followed.chosen(horizon.as_deref());
                let (forest, blocks) = (&candidates.forest, &followed.blocks);
                let up = highest_valid(forest, pick.leaf, &chosen, blocks, &ClimbSettings::default()).up;
                Pick { up, ..pick }
            }
            PickingTask::Erase(lasso, horizon) => {
                let chosen = followed.chosen(Some(&horizon));
                let geometry = &followed.geometry;
                let (picks, left) = super::lasso::nodes_inside(&lasso, &candidates.forest, &chosen, geometry, &horizon);
                if left > 0 && !picks.is_empty() {
                    let (leaves, verb) = if left == 1 { ("leaf", "reaches") } else { ("leaves", "reach") };
                    let text = format!(
                        "{left} {leaves} of {horizon} {verb} farther than the lasso and stayed; Alt and a click takes a leaf out"
                    );
                    self.outbox.send(Event::Told(Notice::note(Place::Interpret, text)));
                }
                self.outbox.send(if picks.is_empty() {
                    let text =
                        format!("nothing of {horizon} lies mostly inside the lasso; draw it around whole leaves");
                    Event::Told(Notice::note(Place::Interpret, text))
                } else {
                    Event::Erased { root, picks }
                });
                return Ok(());
            }
            // These tasks have threads of their own.
            PickingTask::Extract(..) | PickingTask::ProposeFaults => return Ok(()),
        };
        self.outbox.send(Event::Picking { root, step: PickingStep::Found(found) });
        Ok(())
    }

    /// Reads what a state needs. If that fails, the state before is still the one that is interpreted.
    fn follow(&mut self, root: PathBuf, document: Document) -> Result<(), ProjectError> {
        let (guard, progress) =
            self.running.begin("Reading the interpretation", Place::Interpret, self.outbox.wake.clone());
        let followed = Followed::read(root, document, &progress)?;
        self.number += 1;
        let shown = interpreted(&followed, self.number)?;
        drop(guard);
        self.followed = Some(followed);
        self.outbox.send(Event::Interpreted(Arc::new(shown)));
        Ok(())
    }
}

/// What is drawn and reported of a state.
fn interpreted(followed: &Followed, number: u64) -> Result<Interpreted, ProjectError> {
    let Followed { root, document, geometry, candidates, blocks, sheets: all, .. } = followed;
    let candidates = candidates.as_deref();
    let slices: Vec<&[VoxelSheet]> = all.iter().map(|sheets| sheets.as_slice()).collect();
    let conflicts = conflicts_of(document, candidates, &slices)?;
    let [nx, ny, _] = geometry.size();
    let horizons = document.horizons.iter().zip(all).map(|(entry, sheets)| {
        let log = entry.assembly.as_ref();
        let chosen = log.zip(candidates).and_then(|(log, c)| assembly::selection(&entry.name, log, c).ok());
        let overlap = chosen.as_ref().zip(candidates).and_then(|(chosen, candidates)| {
            let found = reassemble(&candidates.forest, chosen, &seeds(log, candidates), blocks).overlap;
            ReportedOverlap::new(found, geometry)
        });
        let mine = conflicts.iter().filter(|conflict| conflict.horizons().contains(&entry.name));
        InterpretedHorizon {
            name: entry.name.clone(),
            colour: entry.own_colour(),
            sheets: sheets.clone(),
            leaves: chosen
                .as_ref()
                .zip(candidates)
                .map_or_else(Vec::new, |(chosen, candidates)| selected_leaves(&candidates.forest, chosen)),
            report: AssemblyReport { overlap, ..report_on(sheets, geometry) },
            picked: PickedShare { name: entry.name.clone(), share: picked_share([nx, ny], on_data(sheets, nx * ny)) },
            filled: filled(sheets),
            holes: find_holes(sheets, [nx, ny]),
            conflicts: mine.map(sentence).collect(),
            outdated: log.is_some_and(|log| !log.picks.is_empty()) && chosen.is_none(),
        }
    });
    let horizons = horizons.collect();
    let faults = document
        .faults
        .iter()
        .map(|entry| Ok(ShownFault { colour: entry.ink(), ..shown(&content::read_fault(root, entry)?, geometry) }));
    let faults = faults.collect::<Result<_, ProjectError>>()?;
    let (proposals, unit) = proposed(root, document, geometry);
    let (root, step) = (root.clone(), document.step);
    let (extraction, key) = (followed.extraction.clone(), candidates.map(|candidates| candidates.key.clone()));
    Ok(Interpreted { root, step, number, horizons, faults, extraction, key, proposals, unit })
}

/// The traces at which one of these sheets lies on data.
fn on_data(sheets: &[VoxelSheet], traces: usize) -> Vec<bool> {
    let is_on = |sheet: &VoxelSheet, n: usize| sheet.z[n].is_finite() && sheet.quality[n].is_on_data();
    (0..traces).map(|n| sheets.iter().any(|sheet| is_on(sheet, n))).collect()
}

/// The number of nodes of these sheets that do not lie on data.
fn filled(sheets: &[VoxelSheet]) -> usize {
    let nodes = sheets.iter().flat_map(|sheet| sheet.z.iter().zip(&sheet.quality));
    nodes.filter(|(z, quality)| z.is_finite() && !quality.is_on_data()).count()
}

/// The triangles that reassembly starts from.
fn seeds(log: Option<&Assembly>, candidates: &Candidates) -> Vec<u32> {
    let forest = &candidates.forest;
    let picks = log.into_iter().flat_map(|log| &log.picks);
    let leaf = |leaf: u32| forest.leaves.get((leaf as usize).wrapping_sub(1));
    picks.filter_map(|pick| Some(forest.nodes[*leaf(pick.leaf)? as usize].triangles.start)).collect()
}

fn shown(fault: &Fault, geometry: &SurveyGeometry) -> ShownFault {
    ShownFault { name: fault.name.clone(), colour: Colour::BLACK, triangles: content::fault_triangles(fault, geometry) }
}

/// The proposals for the present horizons without those that were accepted, and the unit of their throws.
fn proposed(root: &Path, document: &Document, geometry: &SurveyGeometry) -> (Vec<(Proposal, ShownFault)>, String) {
    let open = proposals::open(root, document).into_iter().map(|proposal| {
        let fault = shown(&proposal.fault(&proposal.name), geometry);
        (proposal, fault)
    });
    (open.collect(), geometry.vertical.unit.symbol().to_owned())
}

#[cfg(test)]
mod tests;
