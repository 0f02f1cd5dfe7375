//! Adding, renaming and removing horizons.
//!
//! A horizon takes its place in the stratigraphy by its depth, or where the user puts it. A horizon that crosses
//! another is refused unless a contact rule lets one cut the other, because the layer between them would be inside out.

use super::{Effect, Noun, ProjectError};
use crate::content;
use crate::derived::FaultBlocks;
use crate::document::{HorizonEntry, Id, Origin};
use crate::folder::Draft;
use crate::interpretation::{order, scattered};
use files::{BlockFit, Gridding, ImportOptions, ImportReport};
use model::ContactRules;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;
use survey::{Contact, Horizon, Note, Progress, SurveyGeometry};

/// So many scattered points far off a map through their neighbours, and more than this share of them, are no mis-picks.
const FEWEST_OFF: usize = 4;
const SHARE_OFF: f64 = 0.04;

/// Where a horizon goes in the stratigraphy.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Age {
    /// By its depth.
    #[default]
    ByDepth,
    /// Just above (younger than) the horizon of that name.
    Above(String),
    /// Just below (older than) the horizon of that name.
    Below(String),
}

/// Reads a horizon into the project.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AddHorizon {
    /// The file.
    pub path: PathBuf,
    /// Name of the horizon.
    pub name: String,
    /// Its contact with its neighbours.
    #[serde(default)]
    pub contact: Contact,
    /// Where it goes.
    #[serde(default)]
    pub age: Age,
    /// What the user states about the file.
    #[serde(default)]
    pub options: ImportOptions,
}

impl AddHorizon {
    pub(super) fn execute(&self, draft: &mut Draft, progress: &Progress) -> Result<Effect, ProjectError> {
        draft.document.check_new_name(Noun::Horizon, &self.name)?;
        let geometry = draft.document.frame()?.clone();
        let mut found = files::read_horizons(&self.path, &geometry, &self.named())?;
        let (mut horizon, mut report) = match found.len() {
            1 => found.remove(0),
            _ => {
                let names = found.iter().map(|(horizon, _)| horizon.name.clone()).collect();
                return Err(ProjectError::SeveralInFile { path: self.path.clone(), names });
            }
        };
        horizon.name.clone_from(&self.name);
        progress.check()?;
        let mut contact = self.contact;
        if model::is_closed(&horizon, &geometry) && contact == Contact::Conformable {
            contact = Contact::Intrusive;
            report.notes.push("it is closed, so it cuts the other horizons as an intrusive contact".to_owned());
        }
        model::check_surface(&horizon, contact, &geometry)?;
        if !contact.is_intrusive()
            && let Some(border_m) = model::hole_m(&horizon, &geometry)
        {
            // Said at once: the surface may be refused, for that very hole.
            progress.warn(format!(
                "its triangles enclose a body but for a hole with an edge of {border_m:.0} m; it is taken as an open surface. If \
                 it is a body, close it, or give --contact intrusive to be told where it is open"
            ));
        }
        if !draft.document.faults.is_empty() {
            let blocks = draft.facts().get(&FaultBlocks, progress)?;
            if let Some(found) = scattered::fit(&mut horizon, &geometry, &blocks, self.options.gap_m, progress)? {
                say_fitted(&mut report, &horizon, found);
            }
        }
        let others = load_all(draft, progress)?;
        self.as_limbs(&mut horizon, &others, &mut report);
        let position = position(&self.age, draft, &horizon, contact, &others)?;
        let contacts = draft.document.stratigraphy().horizons.iter().map(|h| h.contact).collect::<Vec<_>>();
        if contact.is_intrusive() {
            let bodies: Vec<(usize, &Horizon)> =
                others.iter().enumerate().filter(|(n, _)| contacts[*n].is_intrusive()).collect();
            note_overlaps(&horizon, position, &bodies, &geometry, &mut report, progress)?;
        }
        let contacts = [&contacts[..position], &[contact], &contacts[position..]].concat();
        self.check_order(&mut horizon, &others, position, &ContactRules::of(contacts), &geometry, &mut report)?;
        let hash = content::hash_horizon(&horizon);
        let (file, new) = draft.generation("horizons", &self.name, "zarr")?;
        store::write_horizon(&new, &horizon, progress)?;
        let entry = HorizonEntry {
            id: Id::default(),
            name: self.name.clone(),
            contact,
            file,
            hash,
            origin: super::imported(&self.path, reading(&report))?,
            assembly: None,
            colour: None,
            gap_m: self.options.gap_m,
            refined: Vec::new(),
        };
        draft.document.insert_horizon(position, entry);
        Ok(Effect::HorizonAdded(Box::new(HorizonAdded { position, report })))
    }

    /// Takes scattered points as a surface of any shape where too many of them for mis-picks lie far off a map through
    /// their neighbours, as the limbs of an overturned fold do, and other scattered points can tell the shape with them.
    fn as_limbs(&self, horizon: &mut Horizon, others: &[Horizon], report: &mut ImportReport) {
        let is_scattered = |other: &Horizon| other.surface.as_ref().is_some_and(|mesh| mesh.triangles.is_empty());
        let Some((points, _)) = report.off_map.clone() else { return };
        let count = horizon.surface.as_ref().map_or(0, |surface| surface.vertices.len());
        let are_limbs = points >= FEWEST_OFF && points as f64 > SHARE_OFF * count as f64;
        if self.options.shape.is_none() && are_limbs && is_scattered(horizon) && others.iter().any(is_scattered) {
            take_as_points(horizon, report);
            report.notes.push(format!(
                "{points} of its points lie far off a map through their neighbours: they are taken as a surface of any \
                 shape, several limbs over one place (--shape map: as a map)"
            ));
        }
    }

    /// Refuses a horizon that crosses another where neither ends the other. Scattered points whose maps cross though they
    /// lie in order are no maps: then the points themselves are the horizon.
    fn check_order(
        &self,
        horizon: &mut Horizon,
        others: &[Horizon],
        position: usize,
        rules: &ContactRules,
        geometry: &SurveyGeometry,
        report: &mut ImportReport,
    ) -> Result<(), ProjectError> {
        for (index, other) in others.iter().enumerate() {
            let index = if index < position { index } else { index + 1 };
            let (young, old) = (index.min(position), index.max(position));
            if rules.may_cross(young, old) || other.any_shape().is_some() || horizon.any_shape().is_some() {
                continue;
            }
            let (younger, older) = if index < position { (other, &*horizon) } else { (&*horizon, other) };
            let Err(crossing) = order::check(younger, older, geometry) else { continue };
            let are_points = self.options.shape.is_none() && horizon.surface.is_some() && other.surface.is_some();
            if !(are_points && order::is_topmost(younger, older, geometry)) {
                return Err(crossing);
            }
            take_as_points(horizon, report);
            report.warnings.push(Note::from(format!(
                "as a map, {crossing}. Its points are taken as a surface of any shape, in order of age"
            )));
        }
        Ok(())
    }

    /// The name chooses among several horizons of a file, unless the user selects one by its name in the file.
    fn named(&self) -> ImportOptions {
        let name = self.options.name.clone().or_else(|| Some(self.name.clone()));
        ImportOptions { name, ..self.options.clone() }
    }
}

/// Says in the report how scattered points were fitted on the sides of faults, instead of what was said of a map through
/// all of them.
fn say_fitted(report: &mut ImportReport, horizon: &Horizon, found: BlockFit) {
    if let Some((_, warning)) = report.off_map.take() {
        report.warnings.retain(|other| *other != warning);
    }
    let [picked, filled] = scattered::counts(horizon);
    let points = found.points.values().copied().collect();
    report.gridding = Gridding::FaultBlocks { points, gap_m: found.gap_m, picked, filled };
    (report.sheets, report.multivalued) = (horizon.sheets.len(), 0);
    report.notes.extend(scattered::notes(&found));
    report.warnings.extend(scattered::warnings(&found).into_iter().map(Note::from));
    report.warnings.extend(found.off_map.iter().map(|(_, warning)| warning.clone()));
    report.off_map = found.off_map;
}

/// Notes with which of the project's bodies, each with its place in the list, a new one shares room.
fn note_overlaps(
    body: &Horizon,
    position: usize,
    bodies: &[(usize, &Horizon)],
    geometry: &SurveyGeometry,
    report: &mut ImportReport,
    progress: &Progress,
) -> Result<(), ProjectError> {
    for &(n, other) in bodies {
        let pair = if n < position { [other, body] } else { [body, other] };
        let note = model::bodies_overlap(pair, geometry, progress)?;
        report.warnings.extend(note.map(|note| Note::from(note.to_string())));
    }
    Ok(())
}

/// Leaves a horizon nothing but its scattered points, and the report without what was said of the map between them.
fn take_as_points(horizon: &mut Horizon, report: &mut ImportReport) {
    horizon.sheets.clear();
    report.sheets = 0;
    report.multivalued = 0;
    let corners = horizon.surface.as_ref().map_or(0, |surface| surface.vertices.len());
    report.gridding = Gridding::AnyShape { corners, triangles: 0 };
    if let Some((_, warning)) = report.off_map.take() {
        report.warnings.retain(|other| *other != warning);
    }
    let of_map = std::mem::take(&mut report.of_map);
    report.notes.retain(|note| !of_map.contains(note));
    report.warnings.retain(|warning| !of_map.contains(&warning.fact));
}

/// The position in the list, 0 = youngest.
fn position(
    age: &Age,
    draft: &Draft,
    horizon: &Horizon,
    contact: Contact,
    others: &[Horizon],
) -> Result<usize, ProjectError> {
    match age {
        Age::Above(name) => draft.document.position(Noun::Horizon, name),
        Age::Below(name) => Ok(draft.document.position(Noun::Horizon, name)? + 1),
        // A body is drawn over whatever it cuts; its layer is its own at the end of the list.
        Age::ByDepth if horizon.any_shape().is_some() && contact.is_intrusive() => Ok(others.len()),
        Age::ByDepth => {
            let contacts = draft.document.stratigraphy().horizons.iter().map(|h| h.contact).collect::<Vec<_>>();
            Ok(order::place_among(horizon, others, &contacts, draft.document.frame()?))
        }
    }
}

/// Adds a horizon that was made here, conformable with its neighbours; returns its position, 0 = youngest.
///
/// # Errors
/// It crosses another horizon where neither ends the other, data are damaged, or the user cancelled.
pub(super) fn insert_made(
    draft: &mut Draft,
    horizon: &Horizon,
    age: &Age,
    origin: Origin,
    progress: &Progress,
) -> Result<usize, ProjectError> {
    let mut others = load_all(draft, progress)?;
    insert_among(draft, &mut others, horizon, age, origin, progress)
}

/// The same where the horizons of the project, youngest first, have been read; the new one is added to them.
///
/// # Errors
/// As [`insert_made`].
pub(super) fn insert_among(
    draft: &mut Draft,
    others: &mut Vec<Horizon>,
    horizon: &Horizon,
    age: &Age,
    origin: Origin,
    progress: &Progress,
) -> Result<usize, ProjectError> {
    let contact = Contact::Conformable;
    let position = position(age, draft, horizon, contact, others)?;
    let contacts = draft.document.stratigraphy().horizons.iter().map(|h| h.contact).collect::<Vec<_>>();
    let rules = ContactRules::of([&contacts[..position], &[contact], &contacts[position..]].concat());
    let geometry = draft.document.frame()?.clone();
    for (index, other) in others.iter().enumerate() {
        let index = if index < position { index } else { index + 1 };
        let (young, old) = (index.min(position), index.max(position));
        if !rules.may_cross(young, old) && other.any_shape().is_none() {
            let (younger, older) = if index < position { (other, horizon) } else { (horizon, other) };
            order::check(younger, older, &geometry)?;
        }
    }
    let (file, new) = draft.generation("horizons", &horizon.name, "zarr")?;
    store::write_horizon(&new, horizon, progress)?;
    let hash = content::hash_horizon(horizon);
    let entry = HorizonEntry {
        id: Id::default(),
        name: horizon.name.clone(),
        contact,
        file,
        hash,
        origin,
        assembly: None,
        colour: None,
        gap_m: None,
        refined: Vec::new(),
    };
    draft.document.insert_horizon(position, entry);
    others.insert(position, horizon.clone());
    Ok(position)
}

/// The report of an added horizon.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct HorizonAdded {
    /// Position in the stratigraphy, 0 = youngest.
    pub position: usize,
    /// What was read, assumed and left out.
    #[serde(flatten)]
    pub report: ImportReport,
}

/// How the file was read, in one line, for the record of the source.
pub(super) fn reading(report: &ImportReport) -> String {
    let mut line = format!(
        "{}, vertical in {}, positive {}",
        report.format.value,
        report.z_unit.value.symbol(),
        report.z_positive.value.word()
    );
    if report.z_factor != 1.0 {
        line += &format!(", factor {}", report.z_factor);
    }
    line
}

pub(super) fn load_all(draft: &Draft, progress: &Progress) -> Result<Vec<Horizon>, ProjectError> {
    let load = |entry: &HorizonEntry| content::read_horizon(draft.root(), entry, progress);
    draft.document.horizons.par_iter().map(load).collect()
}
