//! Proposed faults, from the offsets of horizons and from where reflections end, which needs no horizon; stored for as
//! long as a state of the history names them. A fault that both tell of is proposed once, as its horizons tell it.
//!
//! `derived/fault-proposals-KEY.json` holds the proposals of the horizons, faults, volume and settings that the key
//! identifies. Proposals of another state cannot be accepted, unless that state differs only by faults accepted from
//! them. A fault that the project already has is reported but not proposed.

use crate::content;
use crate::derived::{FaultBlocks, Scratch, key_of, revision};
use crate::document::{Document, Origin};
use crate::error::{Noun, ProjectError};
use crate::facts::Facts;
use crate::folder::{history, storage};
use crate::interpretation::candidates::Candidates;
use ::time::{Cut, FoundFault, TimeSettings, find_faults};
use attribute::{DipSettings, SemblanceSettings, dip, semblance};
use interp::faults::{Evidence, Proposal, ProposeSettings, Repeat, propose_faults};
use interp::reassembly::from_horizon;
use model::FaultNetwork;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::path::{Path, PathBuf};
use survey::{Progress, SurveyGeometry};
use system::file::FileAction;
use system::{file, memory};

/// The proposals, and the state that they were made for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Proposals {
    /// Hashes of the horizons.
    pub horizons: Vec<String>,
    /// The proposed faults, the largest first, minor ones last.
    pub proposals: Vec<Proposal>,
    /// Faults of the project that were found again and are therefore not proposed.
    #[serde(default)]
    pub repeats: Vec<Repeat>,
    /// Unit of vertical values.
    pub unit: String,
}

impl Proposals {
    fn new(document: &Document, geometry: &SurveyGeometry, proposals: Vec<Proposal>, repeats: Vec<Repeat>) -> Self {
        Self { horizons: hashes(document), proposals, repeats, unit: geometry.vertical.unit.symbol().to_owned() }
    }

    /// The message if there are none.
    pub fn nothing_new(&self) -> Option<&'static str> {
        match (self.proposals.is_empty(), self.repeats.is_empty()) {
            (true, true) if self.horizons.is_empty() => {
                Some("reflections end nowhere along a surface that the project has no fault for: no fault is proposed")
            }
            (true, true) => Some("the horizons are not offset anywhere: no fault is proposed"),
            (true, false) => {
                Some("the horizons are offset only where the project has faults already: no fault is proposed")
            }
            _ => None,
        }
    }

    fn line(&self, f: &mut fmt::Formatter<'_>, p: &Proposal) -> fmt::Result {
        let unit = &self.unit;
        let kind = if p.reverse { "reverse" } else { "normal" };
        let [a, b] = p.ends;
        write!(
            f,
            "{}: {kind}, strikes {:.0} deg, dips {:.0} deg, throw {:.0} {unit} (up to {:.0}), from inline \
             {:.0}, crossline {:.0} to inline {:.0}, crossline {:.0}, {:.0} to {:.0} {unit}; throw by length {:.0} m2, {}",
            p.id,
            p.strike_deg,
            p.dip_deg,
            p.throw[0],
            p.throw[1],
            a[0],
            a[1],
            b[0],
            b[1],
            p.depth[0],
            p.depth[1],
            p.offset_m2,
            p.evidence()
        )?;
        if let Some([on, beside]) = p.semblance {
            write!(f, "; semblance {on:.2} on it, {beside:.2} beside")?;
        }
        Ok(())
    }
}

impl fmt::Display for Proposals {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut is_minor = false;
        for (n, proposal) in self.proposals.iter().enumerate() {
            if n > 0 {
                writeln!(f)?;
            }
            if proposal.is_minor && !is_minor {
                is_minor = true;
                writeln!(f, "minor ones, small, scattered or without a break in the data:")?;
            }
            self.line(f, proposal)?;
        }
        if let Some(nothing) = self.nothing_new() {
            write!(f, "{nothing}")?;
        }
        self.repeats.iter().try_for_each(|repeat| {
            let Repeat { fault, support, along, off_traces, throw, .. } = repeat;
            write!(
                f,
                "\nnot proposed: \"{fault}\" again, by {support} pairs along {:.0} % of it, {off_traces:.1} \
                 traces off, throw {throw:.0} {}",
                100.0 * along,
                self.unit
            )
        })
    }
}

/// The path in `derived/` of the proposals with this key.
fn file_of(key: &str) -> String {
    format!("fault-proposals-{key}.json")
}

/// The path of the proposals of a state and settings.
pub fn path(root: &Path, document: &Document, settings: &ProposeSettings) -> PathBuf {
    root.join(storage::DERIVED).join(file_of(&whole_key(document, settings)))
}

/// The key with the candidates, where there are any.
fn whole_key(document: &Document, settings: &ProposeSettings) -> String {
    match &document.extraction {
        Some(extraction) => key_of(&(key(document, settings), &extraction.key, revision::FOUND_FAULTS)),
        None => key(document, settings),
    }
}

/// The key of proposals: a hash of everything that they are made from.
fn key(document: &Document, settings: &ProposeSettings) -> String {
    let faults = document.fault_shapes();
    let volume = document.volumes.iter().find(|entry| entry.geometry.is_none()).map(|entry| &entry.hash);
    let revisions = [revision::PROPOSALS, revision::MODEL];
    key_of(&(revisions, &document.geometry, hashes(document), faults, volume, settings))
}

fn hashes(document: &Document) -> Vec<String> {
    document.horizons.iter().map(|entry| entry.hash.clone()).collect()
}

/// Proposes faults from the project's horizons and its candidates, unless that was done, and stores the proposals under
/// their key; [`crate::command::ProposeFaults`] makes the state that names them. Needs no lock.
///
/// # Errors
/// There are neither horizons nor candidates, data cannot be read, or the user cancelled.
pub(crate) fn compute(
    root: &Path,
    document: &Document,
    settings: &ProposeSettings,
    progress: &Progress,
) -> Result<(String, Proposals), ProjectError> {
    let geometry = document.frame()?;
    if document.horizons.is_empty() {
        return from_candidates(root, document, settings, progress);
    }
    let key = whole_key(document, settings);
    let none = FaultNetwork::none();
    let mut sheets = Vec::new();
    for entry in &document.horizons {
        let horizon = content::read_horizon(root, entry, progress)?;
        sheets.push(from_horizon(&horizon, geometry, &none));
    }
    let volume = document.volumes.iter().find(|entry| entry.geometry.is_none());
    // The key relies on the hashes that were recorded; all that it is made of has now been compared with them.
    let blocks = Facts::of(root, document).get(&FaultBlocks, progress)?;
    if let Some(entry) = volume {
        content::open_recorded(root, entry, geometry)?;
    }
    if let Some(known) = read(root, document, &key) {
        return Ok((key, known));
    }
    let horizons: Vec<Evidence> =
        document.horizons.iter().zip(&sheets).map(|(entry, sheets)| Evidence { name: &entry.name, sheets }).collect();
    let likeness = match volume {
        Some(entry) => {
            memory::check("finding faults", &geometry.size(), FINDING_BYTES)?;
            let seismic = content::read_volume(root, entry, geometry, progress)?;
            let dips = dip(&seismic, &DipSettings::default(), progress);
            dips.and_then(|dips| semblance(&seismic, &dips, &SemblanceSettings::default(), progress)).ok()
        }
        None => None,
    };
    let found = propose_faults(&horizons, geometry, &blocks, likeness.as_ref(), settings, progress)?;
    // What comes next needs as much memory.
    drop(likeness);
    let mut all = found.proposals;
    if document.extraction.is_some() {
        join(&mut all, new_faults(root, document, &blocks, progress)?, geometry);
    }
    let proposals = Proposals::new(document, geometry, all, found.repeats);
    write(root, document, &key, proposals.clone())?;
    Ok((key, proposals))
}

/// Proposes faults from where patches of reflections end, before there is any horizon.
fn from_candidates(
    root: &Path,
    document: &Document,
    settings: &ProposeSettings,
    progress: &Progress,
) -> Result<(String, Proposals), ProjectError> {
    let geometry = document.frame()?;
    if document.extraction.is_none() {
        return Err(ProjectError::NoEvidence);
    }
    let key = whole_key(document, settings);
    // The key relies on the hashes that were recorded.
    content::open_recorded(root, document.amplitudes()?, geometry)?;
    let blocks = Facts::of(root, document).get(&FaultBlocks, progress)?;
    if let Some(known) = read(root, document, &key) {
        return Ok((key, known));
    }
    let new = new_faults(root, document, &blocks, progress)?;
    let proposals = Proposals::new(document, geometry, ::time::proposals(&new, geometry), Vec::new());
    write(root, document, &key, proposals.clone())?;
    Ok((key, proposals))
}

/// Memory that finding faults takes for each sample: the volume, its dips and its semblance, all surfaces.
const FINDING_BYTES: usize = 28;

/// The faults along which reflections end, but for drawn ones.
fn new_faults(
    root: &Path,
    document: &Document,
    blocks: &FaultNetwork,
    progress: &Progress,
) -> Result<Vec<FoundFault>, ProjectError> {
    memory::check("finding faults", &document.frame()?.size(), FINDING_BYTES)?;
    let candidates = Candidates::load(Facts::of(root, document), progress)?;
    let seismic = content::read_volume(root, document.amplitudes()?, document.frame()?, progress)?;
    let fewest = TimeSettings::default().fewest_vertices;
    let found = find_faults(&seismic, &candidates.forest.surfaces, fewest, progress)?;
    let drawn = Cut::of_network(blocks, seismic.size());
    Ok(found.into_iter().filter(|fault| !drawn.iter().any(|cut| fault.is_on(cut))).collect())
}

/// Distance of a horizon's proposal from a found fault within which they are the same, traces.
const SAME_FAULT: f32 = 5.0;

/// Adds found faults to the proposals of horizons, but for those that are proposed already; the largest come first again,
/// minor ones last.
fn join(all: &mut Vec<Proposal>, mut found: Vec<FoundFault>, geometry: &SurveyGeometry) {
    let is_on = |proposal: &Proposal, cut: &Cut| {
        let sides = proposal.mesh.vertices.iter().filter_map(|vertex| {
            let voxel = geometry.voxel_from_world(*vertex);
            let [nx, ny, _] = geometry.size();
            let inside = |at: f64, count: usize| at >= -0.5 && at.round() < count as f64;
            (inside(voxel.x, nx) && inside(voxel.y, ny)).then(|| {
                let trace = [voxel.x.round().max(0.0) as usize, voxel.y.round().max(0.0) as usize];
                cut.side(trace, voxel.z as f32)
            })
        });
        let sides: Vec<f32> = sides.collect();
        2 * sides.iter().filter(|side| side.abs() <= SAME_FAULT).count() > sides.len()
    };
    found.retain(|fault| !all.iter().any(|proposal| is_on(proposal, &fault.cut)));
    all.extend(::time::proposals(&found, geometry));
    all.sort_by(|a, b| a.is_minor.cmp(&b.is_minor).then(b.offset_m2.total_cmp(&a.offset_m2)));
    for (n, proposal) in all.iter_mut().enumerate() {
        proposal.id = n as u32 + 1;
        proposal.name = format!("Fault {}", proposal.id);
    }
}

/// Changes what horizons and faults are called in proposals.
fn call(proposals: &mut Proposals, mut call: impl FnMut(Noun, &mut String)) {
    let horizons = proposals.proposals.iter_mut().flat_map(|proposal| &mut proposal.horizons);
    horizons.for_each(|name| call(Noun::Horizon, name));
    proposals.repeats.iter_mut().for_each(|repeat| call(Noun::Fault, &mut repeat.fault));
}

/// Stores proposals, in which ids stand in place of names.
fn write(root: &Path, document: &Document, key: &str, mut proposals: Proposals) -> Result<(), ProjectError> {
    call(&mut proposals, document.ids_of_names());
    let (scratch, file) = (Scratch::begin(root)?, file_of(key));
    let path = scratch.path(&file);
    let text = serde_json::to_string_pretty(&proposals)
        .map_err(|error| ProjectError::Malformed { path: path.clone(), detail: error.to_string() })?;
    store::replace_file(&path, text.as_bytes())?;
    scratch.publish(&file)
}

/// The proposals stored under a key, if there is an intact file.
fn read(root: &Path, document: &Document, key: &str) -> Option<Proposals> {
    let text = file::read_text(&root.join(storage::DERIVED).join(file_of(key)), file::MAX_INTERPRETATION_BYTES).ok()?;
    let mut proposals = serde_json::from_str(&text).ok()?;
    call(&mut proposals, document.names_of_ids());
    Some(proposals)
}

/// Checks that proposals can be read.
///
/// # Errors
/// They cannot.
pub(crate) fn verify(path: &Path) -> Result<(), ProjectError> {
    let text = file::read_text(path, file::MAX_INTERPRETATION_BYTES)
        .map_err(|source| ProjectError::io(FileAction::Read, path, source))?;
    match serde_json::from_str::<Proposals>(&text) {
        Ok(_) => Ok(()),
        Err(error) => Err(ProjectError::Malformed { path: path.to_owned(), detail: error.to_string() }),
    }
}

/// Removes proposals that no state of the history names any more.
pub(crate) fn forget_unnamed(root: &Path) {
    for file in storage::names_in(&root.join(storage::DERIVED)) {
        let key = file.strip_prefix("fault-proposals-").and_then(|rest| rest.strip_suffix(".json"));
        if let Some(key) = key.filter(|key| !history::is_named(root, key)) {
            storage::remove(root, &format!("{}/{}", storage::DERIVED, file_of(key)));
        }
    }
}

/// The proposal with a number, if it was made for these horizons, apart from what accepting other proposals has
/// changed.
///
/// # Errors
/// There is no such proposal, or it was made for another state.
pub fn find(root: &Path, document: &Document, id: u32) -> Result<Proposal, ProjectError> {
    let kept = kept(root, document)?;
    let known = kept.proposals.len() as u32;
    kept.proposals
        .into_iter()
        .find(|proposal| proposal.id == id)
        .ok_or(ProjectError::UnknownProposal { proposal: id, known })
}

/// The proposals that were made for these horizons, apart from what accepting some of them has changed.
///
/// # Errors
/// There are none, or they were made for another state.
pub fn kept(root: &Path, document: &Document) -> Result<Proposals, ProjectError> {
    let entry = document.fault_proposals.as_ref().ok_or(ProjectError::NoProposals)?;
    let kept = read(root, document, &entry.key).ok_or(ProjectError::NoProposals)?;
    // Accepting one proposal makes the sheets again; the other proposals were made from the same picks.
    let accepted = document.faults.iter().any(|fault| matches!(fault.origin, Origin::Proposed { .. }));
    if !accepted && kept.horizons != hashes(document) {
        return Err(ProjectError::OutdatedProposals);
    }
    Ok(kept)
}

/// The proposals for the present horizons without those that were accepted; `None` if there are none, or they were made
/// for another state.
pub fn open(root: &Path, document: &Document) -> Vec<Proposal> {
    let Ok(kept) = kept(root, document) else { return Vec::new() };
    let accepted = |proposal: &Proposal| {
        let hash = content::hash_fault(&proposal.fault(""));
        document.faults.iter().any(|entry| entry.hash == hash)
    };
    kept.proposals.into_iter().filter(|proposal| !accepted(proposal)).collect()
}
