//! From a horizon's log of picks to its sheets: the last step of every command on picks.

use super::order;
use crate::content;
use crate::derived::FaultBlocks;
use crate::document::Document;
use crate::document::{Assembly, HorizonEntry, Origin, PickEntry, Refinement};
use crate::error::{Noun, ProjectError};
use crate::folder::Draft;
use crate::interpretation::candidates::Candidates;
use crate::interpretation::finish;
use crate::interpretation::scattered;
use crate::interpretation::sheets::HorizonSheets;
use interp::Forest;
use interp::assembly::{
    AssemblyError, Conflict, ConflictSettings, NamedSheets, Overlap, Selection, assemble, conflicts, node_above,
    selected_leaves,
};
use interp::holes::{Filled, Hole, find_holes};
use interp::reassembly::{Reassembled, VoxelSheet, reassemble, to_horizon};
use model::{ContactRules, FaultNetwork};
use serde::Serialize;
use std::collections::BTreeMap;
use std::sync::Arc;
use survey::{Horizon, Progress, SurveyGeometry};

/// The state of a horizon after its picks.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct AssemblyReport {
    /// Its sheets; if a fault block has more than one, they overlap.
    pub sheets: usize,
    /// Nodes with a depth.
    pub nodes: usize,
    /// Share of the survey's traces that have a node.
    pub share: f64,
    /// Where sheets of one fault block overlap.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub overlap: Option<ReportedOverlap>,
    /// Nodes left out because they lie over or under a sheet, no more than noise leaves.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub doubled: Option<ReportedOverlap>,
    /// Number of nodes left out because they were tracked past a fault, where the sheet of the other side runs.
    #[serde(skip_serializing_if = "is_zero")]
    pub past_faults: usize,
    /// Number of nodes that the last line or tracking made.
    #[serde(skip_serializing_if = "is_zero")]
    pub drawn: usize,
    /// The holes in it.
    pub holes: HoleReport,
    /// What was filled.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub filled: Option<Filled>,
    /// The largest change of a node by smoothing, samples.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub smoothed: Option<f32>,
    /// Conflicts with other horizons.
    pub conflicts: Vec<ReportedConflict>,
}

/// An overlap ([`Overlap`]) with its place in line numbers.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ReportedOverlap {
    /// Count of vertices that share trace and fault block with an earlier vertex.
    pub traces: usize,
    /// Count of those that share it with a vertex that was selected before.
    pub beside: usize,
    /// The largest distance between two such vertices, samples.
    pub apart: f32,
    /// Inline number, crossline number and vertical value of the vertex with that distance.
    pub at: [f64; 3],
}

impl ReportedOverlap {
    /// The overlap in line numbers; `None` when nothing overlaps.
    pub fn new(overlap: Overlap, geometry: &SurveyGeometry) -> Option<Self> {
        let Overlap { traces, beside, apart, at_voxel: [x, y, z] } = overlap;
        let lines = geometry.lines_from_voxel(glam::DVec2::new(f64::from(x), f64::from(y)));
        let z = geometry.vertical.value_at(f64::from(z));
        (traces > 0).then_some(Self { traces, beside, apart, at: [lines.x, lines.y, z] })
    }
}

/// A conflict whose place is in line numbers.
pub(crate) type ReportedConflict = Conflict<[i32; 2]>;

/// The conflict in line numbers.
fn in_lines(conflict: Conflict, geometry: &SurveyGeometry) -> ReportedConflict {
    conflict.placed(|[x, y]| {
        let lines = geometry.lines_from_voxel(glam::DVec2::new(x as f64, y as f64));
        [lines.x.round() as i32, lines.y.round() as i32]
    })
}

fn is_zero(count: &usize) -> bool {
    *count == 0
}

/// The holes that the nodes of a horizon enclose.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct HoleReport {
    /// Number of holes.
    pub count: usize,
    /// Number of traces without a node in all of them.
    pub traces: usize,
    /// Number of traces of the largest.
    pub largest: usize,
    /// Inline and crossline of its middle.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at: Option<[f64; 2]>,
}

impl std::fmt::Display for AssemblyReport {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let plural = |count: usize| if count == 1 { "" } else { "s" };
        write!(f, "{} nodes on {:.1} % of the traces", self.nodes, 100.0 * self.share)?;
        write!(f, ", {} sheet{}", self.sheets, plural(self.sheets))?;
        if let Some(overlap) = &self.overlap {
            let [inline, crossline, z] = overlap.at;
            write!(
                f,
                "\n  overlaps itself at {} traces, by up to {:.1} samples at inline {inline:.0}, crossline {crossline:.0}, {z:.1}: \
                 descend a pick, or draw the fault between its two parts",
                overlap.traces, overlap.apart
            )?;
        }
        if let Some(doubled) = &self.doubled {
            let [inline, crossline, z] = doubled.at;
            write!(
                f,
                "\n  {} nodes over or under others left out, by up to {:.1} samples at inline {inline:.0}, crossline \
                 {crossline:.0}, {z:.1}: noise, or a fault that is still to be drawn",
                doubled.traces, doubled.apart
            )?;
        }
        if self.past_faults > 0 {
            write!(f, "\n  {} nodes tracked past faults left out", self.past_faults)?;
        }
        if let Some(filled) = &self.filled {
            write!(f, "\n  filled {} hole{} with {} nodes", filled.holes, plural(filled.holes), filled.nodes)?;
            if filled.along > 0 {
                write!(f, ", {} of them along the reflection", filled.along)?;
            }
            if filled.across_faults > 0 {
                write!(f, "; {} traces across a fault stay empty", filled.across_faults)?;
            }
        }
        if let Some(most) = self.smoothed {
            write!(f, "\n  smoothed, by {most:.2} samples at most")?;
        }
        if let HoleReport { count, traces, largest, at: Some([inline, crossline]) } = self.holes {
            write!(
                f,
                "\n  {count} hole{} with {traces} traces, the largest with {largest} at inline {inline:.0}, crossline {crossline:.0}",
                plural(count)
            )?;
        }
        self.conflicts.iter().try_for_each(|conflict| write!(f, "\n  conflict: {}", sentence(conflict)))
    }
}

/// A conflict in words.
pub fn sentence(conflict: &ReportedConflict) -> String {
    match conflict {
        ReportedConflict::SharedLeaves { horizons: [a, b], leaves, triangles } => {
            format!("\"{a}\" and \"{b}\" share {triangles} triangles of {} leaves", leaves.len())
        }
        ReportedConflict::Crossing { horizons: [a, b], above, below, worst, at } => format!(
            "\"{a}\" lies above \"{b}\" at {above} traces and below it at {below}, by up to {worst:.1} samples at inline {}, crossline {}",
            at[0], at[1]
        ),
        ReportedConflict::Swapped { horizons: [a, b], traces } => {
            format!("\"{a}\" is younger than \"{b}\" but lies below it at {traces} traces")
        }
    }
}

/// The nodes of a log on the present extraction.
///
/// # Errors
/// [`ProjectError::OutdatedPicks`] if some of the picks were made on another extraction.
pub fn selection(name: &str, log: &Assembly, candidates: &Candidates) -> Result<Selection, ProjectError> {
    let outdated: Vec<u32> =
        log.picks.iter().filter(|pick| pick.extraction != candidates.key).map(|pick| pick.id).collect();
    if !outdated.is_empty() {
        return Err(ProjectError::OutdatedPicks { horizon: name.to_owned(), picks: outdated });
    }
    Ok(picked_selection(log, &candidates.forest)?)
}

/// The nodes of a log whose picks were all made on the extraction of the given trees.
///
/// # Errors
/// A pick lies above the root of its tree.
pub(crate) fn picked_selection(log: &Assembly, forest: &Forest) -> Result<Selection, AssemblyError> {
    let mut nodes = Vec::with_capacity(log.picks.len());
    for pick in &log.picks {
        nodes.push((node_above(forest, pick.leaf, pick.up)?, pick.operation));
    }
    Ok(assemble(forest, nodes))
}

/// Ids of the leaves of each horizon that was picked on the extraction of this key alone, by its name.
pub(crate) fn picked_leaves(document: &Document, key: &str, trees: &Forest) -> BTreeMap<String, Vec<u32>> {
    let of_this = |pick: &PickEntry| pick.extraction == key && (1..=trees.leaf_count()).contains(&(pick.leaf as usize));
    let leaves = |entry: &HorizonEntry| {
        let log = entry.assembly.as_ref().filter(|log| log.picks.iter().all(of_this))?;
        let leaves = selected_leaves(trees, &picked_selection(log, trees).ok()?);
        (!leaves.is_empty()).then(|| (entry.name.clone(), leaves))
    };
    document.horizons.iter().filter_map(leaves).collect()
}

/// The candidates that a log needs: none where nothing was picked on them.
///
/// # Errors
/// Something was picked, and there are none.
pub(crate) fn needed(
    draft: &Draft,
    log: &Assembly,
    progress: &Progress,
) -> Result<Option<Arc<Candidates>>, ProjectError> {
    if log.picks.is_empty() {
        return Ok(None);
    }
    Candidates::for_picks(draft.facts(), &[], progress).map(Some)
}

/// Makes the sheets of horizon `name` from `log` and puts both into the draft, with the horizon at its place by depth. A
/// log without picks needs no candidates.
pub(crate) fn rebuild(
    draft: &mut Draft,
    candidates: Option<&Candidates>,
    blocks: &FaultNetwork,
    name: &str,
    log: Assembly,
    progress: &Progress,
) -> Result<AssemblyReport, ProjectError> {
    let geometry = draft.document.frame()?.clone();
    let mut assembled = match candidates {
        _ if log.picks.is_empty() => None,
        Some(candidates) => Some(from_picks(name, &log, candidates, blocks)?),
        None => return Err(ProjectError::NotExtracted),
    }
    .unwrap_or(Reassembled {
        sheets: Vec::new(),
        overlap: Overlap::default(),
        left_out: 0,
        doubled: Overlap::default(),
    });
    let made = finish::add_drawn(draft, &mut assembled.sheets, blocks, &log.drawn)?;
    if assembled.sheets.iter().all(|sheet| sheet.nodes() == 0) {
        return Err(ProjectError::NothingLeft { horizon: name.to_owned() });
    }
    let refined =
        finish::refine(draft, &mut assembled.sheets, blocks, log.fill.as_ref(), log.smooth.as_ref(), progress)?;
    let mut report = report_on(&assembled.sheets, &geometry);
    (report.filled, report.smoothed) = refined;
    report.drawn = made;
    report.past_faults = assembled.left_out;
    report.doubled = ReportedOverlap::new(assembled.doubled, &geometry);
    report.overlap = ReportedOverlap::new(assembled.overlap, &geometry);
    let horizon = to_horizon(name, &assembled.sheets, &geometry);
    put(draft, &horizon, Some(log), None, progress)?;
    report.conflicts = conflicts_with(draft, candidates, name, &assembled.sheets, progress)?;
    Ok(report)
}

/// The sheets of what a log has picked on candidates.
fn from_picks(
    name: &str,
    log: &Assembly,
    candidates: &Candidates,
    blocks: &FaultNetwork,
) -> Result<Reassembled, ProjectError> {
    let forest = &candidates.forest;
    let chosen = selection(name, log, candidates)?;
    let leaves = log.picks.iter().map(|pick| node_above(forest, pick.leaf, 0)).collect::<Result<Vec<_>, _>>()?;
    let seeds: Vec<u32> = leaves.iter().map(|&leaf| forest.nodes[leaf as usize].triangles.start).collect();
    Ok(reassemble(forest, &chosen, &seeds, blocks))
}

/// Counts nodes, traces and holes of sheets.
pub fn report_on(sheets: &[VoxelSheet], geometry: &SurveyGeometry) -> AssemblyReport {
    let [nx, ny, _] = geometry.size();
    let traces = (0..nx * ny).filter(|&n| sheets.iter().any(|sheet| sheet.z[n].is_finite())).count();
    let holes = find_holes(sheets, [nx, ny]);
    let place =
        |hole: &Hole| geometry.lines_from_voxel(glam::DVec2::new(hole.at[0] as f64, hole.at[1] as f64)).to_array();
    AssemblyReport {
        sheets: sheets.len(),
        nodes: sheets.iter().map(VoxelSheet::nodes).sum(),
        share: traces as f64 / (nx * ny) as f64,
        holes: HoleReport {
            count: holes.len(),
            traces: holes.iter().map(|hole| hole.traces).sum(),
            largest: holes.first().map_or(0, |hole| hole.traces),
            at: holes.first().map(place),
        },
        ..AssemblyReport::default()
    }
}

/// Writes a horizon and its entry. An existing horizon keeps its contact; its place follows its depth. `done` is what was
/// done to one without a log.
pub(crate) fn put(
    draft: &mut Draft,
    horizon: &Horizon,
    log: Option<Assembly>,
    done: Option<Refinement>,
    progress: &Progress,
) -> Result<(), ProjectError> {
    let geometry = draft.document.frame()?.clone();
    let name = &horizon.name;
    let old = draft.document.horizons.iter().position(|entry| entry.name == *name);
    let entries = || draft.document.horizons.iter().filter(|entry| entry.name != *name);
    let others = entries().map(|entry| content::read_horizon(draft.root(), entry, progress));
    let others = others.collect::<Result<Vec<_>, _>>()?;
    let contacts = entries().map(|entry| entry.contact).collect::<Vec<_>>();
    let position = order::place_among(horizon, &others, &contacts, &geometry);
    let (file, new) = draft.generation("horizons", name, "zarr")?;
    store::write_horizon(&new, horizon, progress)?;
    let hash = content::hash_horizon(horizon);
    let document = &mut draft.document;
    let before = old.map(|old| document.horizons[old].clone());
    let origin = match (&log, &before) {
        (Some(log), _) if log.picks.is_empty() => Origin::Drawn,
        (Some(_), _) => Origin::Picked,
        (None, Some(before)) => before.origin.clone(),
        (None, None) => return Err(ProjectError::NothingLeft { horizon: name.clone() }),
    };
    let (id, contact, colour, gap_m, mut refined) = before.map_or_else(Default::default, |before| {
        (before.id, before.contact, before.colour, before.gap_m, before.refined)
    });
    if refined.last() != done.as_ref() {
        refined.extend(done);
    }
    let entry =
        HorizonEntry { id, name: name.clone(), contact, file, hash, origin, assembly: log, colour, gap_m, refined };
    match old {
        Some(old) if old == position => document.horizons[old] = entry,
        Some(old) => document.move_horizon(old, position, entry),
        None => document.insert_horizon(position, entry),
    }
    Ok(())
}

/// Conflicts that involve horizon `name`, in line numbers.
fn conflicts_with(
    draft: &Draft,
    candidates: Option<&Candidates>,
    name: &str,
    sheets: &[VoxelSheet],
    progress: &Progress,
) -> Result<Vec<ReportedConflict>, ProjectError> {
    let entries = draft.document.horizons.iter();
    let other = |entry: &HorizonEntry| {
        let is_other = entry.name != name;
        is_other.then(|| draft.facts().get(&HorizonSheets(entry), progress)).transpose()
    };
    let others = entries.map(other).collect::<Result<Vec<_>, _>>()?;
    let all: Vec<&[VoxelSheet]> =
        others.iter().map(|other| other.as_deref().map_or(sheets, |other| other.as_slice())).collect();
    let found = conflicts_of(&draft.document, candidates, &all)?;
    Ok(found.into_iter().filter(|conflict| conflict.horizons().iter().any(|n| n == name)).collect())
}

/// Conflicts between all horizons of a project, given by their sheets, in line numbers.
pub fn conflicts_of(
    document: &Document,
    candidates: Option<&Candidates>,
    sheets: &[&[VoxelSheet]],
) -> Result<Vec<ReportedConflict>, ProjectError> {
    let geometry = document.frame()?;
    let chosen: Vec<Option<Selection>> = document
        .horizons
        .iter()
        .map(|entry| selection(&entry.name, entry.assembly.as_ref()?, candidates?).ok())
        .collect();
    let each = document.horizons.iter().zip(sheets).zip(&chosen);
    let named: Vec<NamedSheets> = each
        .map(|((entry, sheets), chosen)| NamedSheets { name: &entry.name, sheets, selection: chosen.as_ref() })
        .collect();
    let rules = ContactRules::new(&document.stratigraphy());
    let [nx, ny, _] = geometry.size();
    let may_cross = |young: usize, old: usize| rules.may_cross(young, old);
    let forest = candidates.map(|candidates| &candidates.forest);
    let found = conflicts(forest, [nx, ny], &named, may_cross, &ConflictSettings::default());
    Ok(found.into_iter().map(|conflict| in_lines(conflict, geometry)).collect())
}

/// Assembles all horizons with picks again after the faults have changed, and fits those of scattered points again; one
/// sentence for each that is another now. Horizons whose picks were made on another extraction stay as they are, and a
/// warning says so.
pub(crate) fn rebuild_all(draft: &mut Draft, progress: &Progress) -> Result<Vec<String>, ProjectError> {
    let mut told = assemble_all(draft, progress)?;
    told.extend(scattered::refit_all(draft, progress)?);
    Ok(told)
}

/// Assembles all horizons with picks again; one sentence for each that is another now.
fn assemble_all(draft: &mut Draft, progress: &Progress) -> Result<Vec<String>, ProjectError> {
    let logs: Vec<(String, Assembly)> = draft
        .document
        .horizons
        .iter()
        .filter_map(|entry| Some((entry.name.clone(), entry.assembly.clone()?)))
        .collect();
    let mut told = Vec::new();
    if logs.is_empty() {
        return Ok(told);
    }
    let candidates = Candidates::for_picks(draft.facts(), &[], progress).ok();
    if candidates.is_none() && logs.iter().any(|(_, log)| !log.picks.is_empty()) {
        progress.warn("the assembled horizons are as they were: there is no extraction to assemble them from");
    }
    let blocks = draft.facts().get(&FaultBlocks, progress)?;
    for (name, log) in logs.into_iter().filter(|(_, log)| candidates.is_some() || log.picks.is_empty()) {
        let before = entry_of(draft, &name)?.clone();
        match rebuild(draft, candidates.as_deref(), &blocks, &name, log, progress) {
            Ok(report) if entry_of(draft, &name)?.hash != before.hash => {
                told.push(format!("horizon \"{name}\" was assembled again: {}", changes(draft, &before, &report, progress)?));
            }
            Ok(_) => {}
            Err(ProjectError::OutdatedPicks { .. }) => progress.warn(format!(
                "horizon \"{name}\" was left unchanged: its picks were made on another extraction and have to be repeated"
            )),
            Err(error) => return Err(error),
        }
    }
    Ok(told)
}

fn entry_of<'a>(draft: &'a Draft, name: &str) -> Result<&'a HorizonEntry, ProjectError> {
    Ok(&draft.document.horizons[draft.document.position(Noun::Horizon, name)?])
}

/// How a horizon differs from the one before, and what a report on it warns of.
fn changes(
    draft: &Draft,
    before: &HorizonEntry,
    report: &AssemblyReport,
    progress: &Progress,
) -> Result<String, ProjectError> {
    let geometry = draft.document.frame()?;
    let [nx, ny, _] = geometry.size();
    let old = content::read_horizon(draft.root(), before, progress)?;
    let new = content::read_horizon(draft.root(), entry_of(draft, &before.name)?, progress)?;
    let depths = |horizon: &Horizon, trace: usize| -> Vec<u32> {
        let at = |sheet: &survey::Sheet| {
            sheet.depth.get(trace).filter(|depth| depth.is_finite()).map(|depth| depth.to_bits())
        };
        let mut depths: Vec<u32> = horizon.sheets.iter().filter_map(at).collect();
        depths.sort_unstable();
        depths
    };
    let moved = (0..nx * ny).filter(|&trace| depths(&old, trace) != depths(&new, trace));
    let (mut count, mut low, mut high) = (0_usize, [usize::MAX; 2], [0_usize; 2]);
    for trace in moved {
        count += 1;
        for (axis, at) in [trace / ny, trace % ny].into_iter().enumerate() {
            (low[axis], high[axis]) = (low[axis].min(at), high[axis].max(at));
        }
    }
    let sheets = |count: usize| format!("{count} sheet{}", if count == 1 { "" } else { "s" });
    let mut text = match (old.sheets.len(), report.sheets) {
        (old, new) if old == new => sheets(new),
        (old, new) => format!("{} in place of {old}", sheets(new)),
    };
    if count == 0 {
        text += ", the same places";
    } else {
        let line = |[x, y]: [usize; 2]| geometry.lines_from_voxel(glam::DVec2::new(x as f64, y as f64)).round();
        let (a, b) = (line(low), line(high));
        let share = 100.0 * count as f64 / (nx * ny) as f64;
        text += &format!(
            ", other places at {share:.1} % of the traces, inlines {} to {}, crosslines {} to {}",
            a.x, b.x, a.y, b.y
        );
    }
    if let Some(overlap) = &report.overlap {
        text += &format!("; it overlaps itself at {} traces", overlap.traces);
    }
    Ok(text)
}

/// The log of a horizon that was assembled from picks.
///
/// # Errors
/// There is no such horizon, or it was imported.
pub(crate) fn log_of(draft: &Draft, name: &str) -> Result<Assembly, ProjectError> {
    let entry = &draft.document.horizons[draft.document.position(Noun::Horizon, name)?];
    entry.assembly.clone().ok_or_else(|| ProjectError::NotAssembled { horizon: name.to_owned() })
}

/// The log of a horizon, or an empty one for a new horizon.
///
/// # Errors
/// The horizon was imported, or the name cannot be given.
pub(crate) fn log_or_new(draft: &Draft, name: &str) -> Result<Assembly, ProjectError> {
    if draft.document.horizons.iter().any(|entry| entry.name == name) {
        return log_of(draft, name);
    }
    draft.document.check_new_name(Noun::Horizon, name)?;
    let colour = draft.document.next_colour();
    Ok(Assembly { colour, fill: None, smooth: None, picks: Vec::new(), drawn: Vec::new() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use survey::VerticalUnit;

    #[test]
    fn negative_line_numbers_are_kept() {
        let mut geometry = SurveyGeometry::regular([32, 32, 32], 25.0, 10.0, VerticalUnit::Metres);
        (geometry.inlines.first, geometry.inlines.step) = (-40, 2);
        (geometry.crosslines.first, geometry.crosslines.step) = (-7, 1);
        let horizons = ["a".to_owned(), "b".to_owned()];
        let crossing = Conflict::Crossing { horizons, above: 9, below: 4, worst: 2.0, at: [3, 5] };
        let reported = in_lines(crossing, &geometry);
        assert!(matches!(reported, ReportedConflict::Crossing { at: [-34, -2], .. }), "{reported:?}");
        let json = serde_json::to_value(&reported).unwrap();
        assert_eq!((&json["conflict"], &json["at"]), (&"crossing".into(), &serde_json::json!([-34, -2])));
        let overlap = Overlap { traces: 1, beside: 0, apart: 3.0, at_voxel: [3.0, 5.0, 0.0] };
        let at = ReportedOverlap::new(overlap, &geometry).unwrap().at;
        assert_eq!([at[0], at[1]], [-34.0, -2.0]);
    }
}
