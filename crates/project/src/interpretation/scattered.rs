//! Horizons of scattered points: fitted fault block by fault block, and made again from their points when the faults change.

use crate::content;
use crate::derived::FaultBlocks;
use crate::document::HorizonEntry;
use crate::error::ProjectError;
use crate::folder::Draft;
use crate::interpretation::order;
use files::{BlockFit, fit_blocks, grid_points};
use glam::{DVec2, DVec3};
use model::{ContactRules, FaultNetwork};
use survey::{Horizon, Progress, Quality, SurveyGeometry, TriangleMesh};

/// A grid whose nodes lie at least so many traces apart, and that has no more nodes than this, is a few typed points.
const FEW_STEP: f64 = 4.0;
const FEW_NODES: usize = 400;

/// The points that the sheets of a horizon were made between, world X, Y and vertical value; of a few points on a coarse
/// grid these. None of a horizon of any other kind.
pub(crate) fn points_of(horizon: &Horizon, geometry: &SurveyGeometry) -> Option<Vec<DVec3>> {
    if horizon.sheets.is_empty() {
        return None;
    }
    if let Some(surface) = &horizon.surface {
        return surface.triangles.is_empty().then(|| surface.vertices.clone());
    }
    let trace_m =
        [geometry.inline_vector, geometry.crossline_vector].map(DVec2::length).into_iter().fold(0.0, f64::max);
    let is_coarse = |step: DVec2| step.length() >= FEW_STEP * trace_m;
    let count: usize = horizon.sheets.iter().map(|sheet| sheet.node_count()).sum();
    let are_few = horizon.sheets.iter().all(|sheet| is_coarse(sheet.grid.u_step) && is_coarse(sheet.grid.v_step));
    if !are_few || count > FEW_NODES {
        return None;
    }
    let places = horizon.sheets.iter().flat_map(|sheet| {
        let nv = sheet.grid.count[1];
        let known = sheet.depth.iter().enumerate().filter(|(_, depth)| depth.is_finite());
        known.map(move |(n, depth)| {
            sheet.grid.world_at(DVec2::new((n / nv) as f64, (n % nv) as f64)).extend(f64::from(*depth))
        })
    });
    Some(places.collect())
}

/// Fits the sheets of a horizon again to its points, with the faults there are; `None` for a horizon without points of its
/// own, or where there is nothing to fit.
///
/// # Errors
/// The user cancelled.
pub(crate) fn fit(
    horizon: &mut Horizon,
    geometry: &SurveyGeometry,
    blocks: &FaultNetwork,
    gap_m: Option<f64>,
    progress: &Progress,
) -> Result<Option<BlockFit>, ProjectError> {
    let Some(points) = points_of(horizon, geometry) else { return Ok(None) };
    let mut found = fit_blocks(&points, geometry, blocks, gap_m, progress)?;
    if found.sheets.is_empty() {
        return Ok(None);
    }
    horizon.sheets = std::mem::take(&mut found.sheets);
    horizon.surface = Some(TriangleMesh { vertices: points, triangles: Vec::new() });
    Ok(Some(found))
}

/// What the user should know of a fit, one sentence each.
pub(crate) fn warnings(found: &BlockFit) -> Vec<String> {
    let mut said = Vec::new();
    if let [[inline, crossline], rest @ ..] = &found.empty[..] {
        let more = if rest.is_empty() { String::new() } else { format!(" and {} more", rest.len()) };
        said.push(format!(
            "it has no point in the fault block around inline {inline}, crossline {crossline}{more}: there it is placed by its \
             distance to other horizons, and the throw is not known; one point there settles it"
        ));
    }
    said
}

/// What a fit found besides, one sentence each.
pub(crate) fn notes(found: &BlockFit) -> Vec<String> {
    let moved = match found.moved {
        0 => None,
        1 => Some("1 point beside a fault has the depth of the other side and counts there".to_owned()),
        n => Some(format!("{n} points beside a fault have the depth of the other side and count there")),
    };
    moved.into_iter().collect()
}

/// Nodes of the sheets at points, and between them.
pub(crate) fn counts(horizon: &Horizon) -> [usize; 2] {
    let nodes = || horizon.sheets.iter().flat_map(|sheet| &sheet.quality);
    let picked = nodes().filter(|quality| **quality == Quality::Picked).count();
    [picked, nodes().filter(|quality| **quality != Quality::Hole).count() - picked]
}

/// Makes all horizons of scattered points again from their points after the faults have changed; says which.
pub(crate) fn refit_all(draft: &mut Draft, progress: &Progress) -> Result<Vec<String>, ProjectError> {
    let geometry = draft.document.frame()?.clone();
    let blocks = draft.facts().get(&FaultBlocks, progress)?;
    let mut said = Vec::new();
    for index in 0..draft.document.horizons.len() {
        let entry = draft.document.horizons[index].clone();
        if entry.assembly.is_some() {
            continue;
        }
        let before = content::read_horizon(draft.root(), &entry, progress)?;
        let mut horizon = before.clone();
        let count = match draft.document.faults.is_empty() {
            false => {
                let Some(found) = fit(&mut horizon, &geometry, &blocks, entry.gap_m, progress)? else { continue };
                for warning in warnings(&found) {
                    progress.warn(format!("horizon \"{}\": {warning}", entry.name));
                }
                said.extend(notes(&found).into_iter().map(|note| format!("horizon \"{}\": {note}", entry.name)));
                found.points.values().sum::<usize>()
            }
            true => {
                let Some(points) = points_of(&horizon, &geometry).filter(|_| horizon.surface.is_some()) else {
                    continue;
                };
                let sheets = grid_points(&points, &geometry, entry.gap_m);
                if sheets.is_empty() {
                    continue;
                }
                horizon.sheets = sheets;
                points.len()
            }
        };
        if horizon == before {
            continue;
        }
        let is_in_order = |horizon: &Horizon| crossing(draft, index, horizon, &geometry, progress);
        if let (None, Some(crossing)) = (is_in_order(&before)?, is_in_order(&horizon)?) {
            progress.warn(format!("horizon \"{}\", fitted again to its points: {crossing}", entry.name));
        }
        if !entry.refined.is_empty() {
            progress.warn(format!(
                "horizon \"{}\" was made again from its points: fill or smooth it again where you want that",
                entry.name
            ));
        }
        said.push(format!("horizon \"{}\" was fitted again to its {count} points", entry.name));
        let (file, new) = draft.generation("horizons", &entry.name, "zarr")?;
        store::write_horizon(&new, &horizon, progress)?;
        let hash = content::hash_horizon(&horizon);
        draft.document.horizons[index] = HorizonEntry { file, hash, refined: Vec::new(), ..entry };
    }
    Ok(said)
}

/// How a horizon crosses another of the project, where neither ends the other.
fn crossing(
    draft: &Draft,
    index: usize,
    horizon: &Horizon,
    geometry: &SurveyGeometry,
    progress: &Progress,
) -> Result<Option<ProjectError>, ProjectError> {
    let rules = ContactRules::new(&draft.document.stratigraphy());
    for (other_index, entry) in draft.document.horizons.iter().enumerate() {
        let (young, old) = (index.min(other_index), index.max(other_index));
        if other_index == index || rules.may_cross(young, old) {
            continue;
        }
        let other = content::read_horizon(draft.root(), entry, progress)?;
        let (younger, older) = if index < other_index { (horizon, &other) } else { (&other, horizon) };
        if other.any_shape().is_none()
            && let Err(crossing) = order::check(younger, older, geometry)
        {
            return Ok(Some(crossing));
        }
    }
    Ok(None)
}
