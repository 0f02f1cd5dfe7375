//! Whether a state can be drawn: whether its faults and horizons make a model.
//!
//! What the model would refuse is refused by the command that brings it ([`crate::Project::apply`]), and told by a check.
//! Horizons that are height fields are compared at their picks, which costs a small share of the model; with surfaces of
//! any shape the model itself is built.

use super::solid::SolidModel;
use crate::content;
use crate::derived::{self, FaultBlocks, load_blocks};
use crate::error::ProjectError;
use crate::facts::{Facts, Query};
use model::{FaultNetwork, ModelError, ModelNote, ModelSettings, StructuralModel, SurfaceProblem};
use survey::{Fault, Horizon, Progress};

/// Checks that the faults and horizons of a state make a model; nothing is written. Returns what contradicts itself in them
/// and is resolved.
///
/// # Errors
/// What a picture of the state would say, data are damaged, or the user cancelled.
pub(crate) fn check(facts: Facts<'_>, progress: &Progress) -> Result<Vec<ModelNote>, ProjectError> {
    let Facts { root, document } = facts;
    let Some(geometry) = &document.geometry else { return Ok(Vec::new()) };
    let blocks = match load_blocks(root, &derived::blocks_key(document)) {
        Some(blocks) => blocks,
        None => {
            let faults = document.faults.iter().map(|entry| content::read_fault(root, entry));
            FaultNetwork::build(geometry, &faults.collect::<Result<Vec<Fault>, _>>()?, progress)?
        }
    };
    check_among(facts, &blocks, progress)
}

/// The same where the fault blocks are known.
fn check_among(facts: Facts<'_>, blocks: &FaultNetwork, progress: &Progress) -> Result<Vec<ModelNote>, ProjectError> {
    let Facts { root, document } = facts;
    let Some(geometry) = &document.geometry else { return Ok(Vec::new()) };
    if document.horizons.is_empty() {
        return Ok(Vec::new());
    }
    let horizons = document.horizons.iter().map(|entry| content::read_horizon(root, entry, progress));
    let horizons = horizons.collect::<Result<Vec<Horizon>, _>>()?;
    progress.check()?;
    if horizons.iter().any(|horizon| horizon.any_shape().is_some()) {
        let notes = SolidModel.compute(facts, progress)?.report().notes.clone();
        return Ok(notes.into_iter().filter(ModelNote::is_contradiction).collect());
    }
    let (strata, settings) = (document.stratigraphy(), ModelSettings::default());
    Ok(StructuralModel::check_picks(geometry, &strata, &horizons, blocks, &settings)?)
}

/// Refuses a state that cannot be drawn where the one before it could, and warns of what is resolved in it and was not
/// before.
///
/// # Errors
/// What a picture of the state would say, or the user cancelled.
pub(crate) fn refuse_undrawable(before: Facts<'_>, after: Facts<'_>, progress: &Progress) -> Result<(), ProjectError> {
    let settings = ModelSettings::default();
    if derived::model_key(before.document, &settings) == derived::model_key(after.document, &settings) {
        return Ok(());
    }
    let quiet = progress.muted();
    // The blocks are kept: a picture needs them next.
    let blocks = after.document.geometry.as_ref().map(|_| after.get(&FaultBlocks, progress)).transpose();
    let notes = blocks.and_then(|blocks| blocks.map_or(Ok(Vec::new()), |blocks| check_among(after, &blocks, &quiet)));
    let error = match notes {
        Ok(notes) => {
            tell(&notes, before, progress);
            return Ok(());
        }
        Err(ProjectError::Model(error)) => error,
        Err(error @ ProjectError::Cancelled(_)) => return Err(error),
        // Whether there is memory for a picture is its own matter.
        Err(_) => return Ok(()),
    };
    let is_incomplete = matches!(&error, ModelError::Surface { problem: SurfaceProblem::PointsAlone, .. });
    if is_incomplete || matches!(check(before, &quiet), Err(ProjectError::Model(_))) {
        progress.warn(format!("the project cannot be drawn yet: {error}"));
        return Ok(());
    }
    Err(error.into())
}

/// Warns of horizons that cross a little and did not before.
fn tell(notes: &[ModelNote], before: Facts<'_>, progress: &Progress) {
    let pair = |note: &ModelNote| match note {
        ModelNote::Crossed { younger, older, .. } => Some([younger.clone(), older.clone()]),
        _ => None,
    };
    if notes.iter().all(|note| pair(note).is_none()) {
        return;
    }
    let known = check(before, &progress.muted()).unwrap_or_default();
    let is_new = |note: &&ModelNote| pair(note).is_some() && known.iter().all(|known| pair(known) != pair(note));
    notes.iter().filter(is_new).for_each(|note| progress.warn(note.to_string()));
}
