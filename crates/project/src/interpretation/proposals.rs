//! Proposed faults, found in the volume and from the offsets of horizons; stored for as long as a state of the history names
//! them. Both kinds are measured on both sides of their surface. A fault that both tell of is proposed once, as it was
//! found in the volume, which knows where it ends.
//!
//! `derived/fault-proposals-KEY.json` holds the proposals of the horizons, faults, volume and settings that the key
//! identifies. Proposals of another state cannot be accepted, unless that state differs only by faults accepted from
//! them. A fault that the project already has is reported but not proposed.

use crate::content;
use crate::derived::{FINDING_BYTES, FaultBlocks, Scratch, key_of, revision};
use crate::document::{Document, Origin};
use crate::error::{Noun, ProjectError};
use crate::facts::Facts;
use crate::folder::{history, storage};
use ::faults::Sheet;
use ::time::Cut;
use attribute::{DipSettings, SemblanceSettings, dip, semblance};
use glam::Vec3;
use interp::faults::{Evidence, FoundFaults, Proposal, ProposeSettings, Repeat, propose_faults};
use interp::reassembly::from_horizon;
use model::FaultNetwork;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::path::{Path, PathBuf};
use survey::{Progress, SurveyGeometry, TriangleMesh, Volume};
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
                Some("no surface was found on whose two sides the beds match after a throw: no fault is proposed")
            }
            (true, true) => Some("neither the volume nor the horizons are offset anywhere: no fault is proposed"),
            (true, false) => Some("there are offsets only where the project has faults already: no fault is proposed"),
            _ => None,
        }
    }

    fn line(&self, f: &mut fmt::Formatter<'_>, p: &Proposal) -> fmt::Result {
        let unit = &self.unit;
        let [a, b] = p.ends;
        write!(
            f,
            "{}: {}, strikes {:.0} deg, dips {:.0} deg, from inline {:.0}, crossline {:.0} to inline {:.0}, crossline \
             {:.0}, {:.0} to {:.0} {unit}; area {:.0} m2, {}",
            p.id,
            p.throw_in_words(unit),
            p.strike_deg,
            p.dip_deg,
            a[0],
            a[1],
            b[0],
            b[1],
            p.depth[0],
            p.depth[1],
            p.area_m2,
            p.rests_on()
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
                writeln!(f, "minor ones, small, scattered, without a break in the data or without a throw:")?;
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
    root.join(storage::DERIVED).join(file_of(&key(document, settings)))
}

/// The key of proposals: a hash of everything that they are made from.
fn key(document: &Document, settings: &ProposeSettings) -> String {
    let faults = document.fault_shapes();
    let volume = document.amplitudes().ok().map(|entry| &entry.hash);
    let revisions = [revision::PROPOSALS, revision::FOUND_FAULTS, revision::MODEL];
    key_of(&(revisions, &document.geometry, hashes(document), faults, volume, settings))
}

fn hashes(document: &Document) -> Vec<String> {
    document.horizons.iter().map(|entry| entry.hash.clone()).collect()
}

/// Proposes faults from the project's volume and its horizons, unless that was done, and stores the proposals under their
/// key; [`crate::command::ProposeFaults`] makes the state that names them. Needs no lock.
///
/// # Errors
/// There are neither horizons nor a volume, data cannot be read, or the user cancelled.
pub(crate) fn compute(
    root: &Path,
    document: &Document,
    settings: &ProposeSettings,
    progress: &Progress,
) -> Result<(String, Proposals), ProjectError> {
    let geometry = document.frame()?;
    let volume = document.amplitudes().ok();
    if document.horizons.is_empty() && volume.is_none() {
        return Err(ProjectError::NoEvidence);
    }
    let key = key(document, settings);
    let none = FaultNetwork::none();
    let mut sheets = Vec::new();
    for entry in &document.horizons {
        let horizon = content::read_horizon(root, entry, progress)?;
        sheets.push(from_horizon(&horizon, geometry, &none));
    }
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
    let mut found = FoundFaults::default();
    let mut all = Vec::new();
    match volume {
        Some(entry) => {
            memory::check("finding faults", &geometry.size(), FINDING_BYTES)?;
            let seismic = content::read_volume(root, entry, geometry, progress)?;
            if !horizons.is_empty() {
                let dips = dip(&seismic, &DipSettings::default(), progress)?;
                let likeness = semblance(&seismic, &dips, &SemblanceSettings::default(), progress)?;
                drop(dips);
                found = propose_faults(&horizons, geometry, &blocks, Some(&likeness), settings, progress)?;
            }
            all = in_volume(&seismic, geometry, &blocks, progress)?;
            let told = measured(&seismic, geometry, found.proposals, progress)?;
            join(&mut all, told, geometry);
        }
        None => {
            found = propose_faults(&horizons, geometry, &blocks, None, settings, progress)?;
            all.append(&mut found.proposals);
        }
    }
    number(&mut all);
    let proposals = Proposals::new(document, geometry, all, found.repeats);
    write(root, document, &key, proposals.clone())?;
    Ok((key, proposals))
}

/// Distance of a surface from another within which they are the same fault, traces.
const SAME_FAULT: f32 = 5.0;

/// The faults that are found in the volume, but for those that the project has.
fn in_volume(
    seismic: &Volume<f32>,
    geometry: &SurveyGeometry,
    blocks: &FaultNetwork,
    progress: &Progress,
) -> Result<Vec<Proposal>, ProjectError> {
    let [found, cuts] = faults::find_with_cuts(seismic, geometry, progress)?;
    let mut new = faults::proposals(&found, &cuts, geometry);
    new.retain(|proposal| !is_known(proposal, blocks, geometry));
    Ok(new)
}

/// What horizons propose, with the evidence of both sides of each; what has none in the volume is minor.
fn measured(
    seismic: &Volume<f32>,
    geometry: &SurveyGeometry,
    mut told: Vec<Proposal>,
    progress: &Progress,
) -> Result<Vec<Proposal>, ProjectError> {
    if told.is_empty() {
        return Ok(told);
    }
    let slopes = attribute::slopes(seismic, progress)?;
    let meshes: Vec<&TriangleMesh> = told.iter().map(|proposal| &proposal.mesh).collect();
    let surfaces = faults::measure(seismic, &slopes, geometry, &meshes, progress)?;
    for (proposal, surface) in told.iter_mut().zip(surfaces) {
        proposal.evidence = Some(surface.as_ref().map_or(0.0, |surface| surface.evidence));
        proposal.is_minor |= !surface.is_some_and(|surface| surface.is_possible());
    }
    Ok(told)
}

/// Most vertices of a proposal that are compared with the faults of the project.
const COMPARED: usize = 500;

/// Whether most of a proposal lies within a few traces of what was interpreted of one of the project's faults.
fn is_known(proposal: &Proposal, blocks: &FaultNetwork, geometry: &SurveyGeometry) -> bool {
    let trace_m = geometry.inline_vector.length().min(geometry.crossline_vector.length()) as f32;
    let vertices = &proposal.mesh.vertices;
    let every = vertices.len().div_ceil(COMPARED).max(1);
    let places: Vec<Vec3> =
        vertices.iter().step_by(every).map(|vertex| geometry.voxel_from_world(*vertex).as_vec3()).collect();
    let is_near = |fault: usize, place: Vec3| {
        blocks.side(fault, place).abs() <= SAME_FAULT * trace_m && blocks.is_real(fault, place)
    };
    (0..blocks.surfaces().len())
        .any(|fault| 2 * places.iter().filter(|&&place| is_near(fault, place)).count() > places.len())
}

/// Whether most of a proposal lies within a few traces of a cut.
fn is_on(proposal: &Proposal, cut: &Cut, geometry: &SurveyGeometry) -> bool {
    let [nx, ny, _] = geometry.size();
    let sides = proposal.mesh.vertices.iter().filter_map(|vertex| {
        let voxel = geometry.voxel_from_world(*vertex);
        let inside = |at: f64, count: usize| at >= -0.5 && at.round() < count as f64;
        (inside(voxel.x, nx) && inside(voxel.y, ny)).then(|| {
            let trace = [voxel.x.round().max(0.0) as usize, voxel.y.round().max(0.0) as usize];
            cut.side(trace, voxel.z as f32)
        })
    });
    let sides: Vec<f32> = sides.collect();
    2 * sides.iter().filter(|side| side.abs() <= SAME_FAULT).count() > sides.len()
}

/// Adds what horizons tell to what was found in the volume; where both tell of a fault, the found one takes the names of
/// the horizons that it offsets.
fn join(all: &mut Vec<Proposal>, told: Vec<Proposal>, geometry: &SurveyGeometry) {
    let size = geometry.size();
    let cut = |found: &Proposal| Sheet::of_mesh(&found.mesh, geometry).map(|sheet| Cut::of_sheet(&sheet, size));
    let cuts: Vec<Option<Cut>> = all.iter().map(cut).collect();
    for proposal in told {
        let same = cuts.iter().position(|cut| cut.as_ref().is_some_and(|cut| is_on(&proposal, cut, geometry)));
        match same {
            Some(n) => {
                let found = &mut all[n];
                found.horizons.extend(proposal.horizons);
                found.horizons.sort();
                found.horizons.dedup();
                found.is_minor &= proposal.is_minor;
            }
            None => all.push(proposal),
        }
    }
}

/// Numbers and names proposals, the largest first and minor ones last.
fn number(all: &mut [Proposal]) {
    all.sort_by(|a, b| a.is_minor.cmp(&b.is_minor).then(b.area_m2.total_cmp(&a.area_m2)));
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

/// The proposals for the present horizons without those that the project has as faults, accepted or changed since; none
/// if they were made for another state.
pub fn open(root: &Path, document: &Document) -> Vec<Proposal> {
    let Ok(kept) = kept(root, document) else { return Vec::new() };
    let Ok(geometry) = document.frame() else { return Vec::new() };
    let hashes: Vec<String> = document.faults.iter().map(|entry| entry.hash.clone()).collect();
    let is_same = |proposal: &Proposal| hashes.contains(&content::hash_fault(&proposal.fault("")));
    let mut open: Vec<Proposal> = kept.proposals.into_iter().filter(|proposal| !is_same(proposal)).collect();
    if !open.is_empty()
        && !hashes.is_empty()
        && let Ok(blocks) = Facts::of(root, document).get(&FaultBlocks, &Progress::silent())
    {
        open.retain(|proposal| !is_known(proposal, &blocks, geometry));
    }
    open
}
