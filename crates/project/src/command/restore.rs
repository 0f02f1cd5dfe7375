//! Back in time: a project in which what is younger than a horizon of another project is taken away, and the throws and folds of
//! that horizon are undone.
//!
//! What is restored, and how, is `restore`'s ([the document](../../../../docs/restore.md)). Here the other project is read, and what
//! came of it becomes an ordinary interpretation with the same names, rocks, tiles and scenes. Volumes, wells, notes and figures
//! stay behind: they were measured, or written, in the rock as it lies today.

use super::{Effect, Noun, ProjectError, SetLayer};
use crate::content;
use crate::document::{Chooser, Document, FaultEntry, HorizonEntry, Origin, RestoredEntry};
use crate::facts::Facts;
use crate::folder::{Draft, state};
use crate::interpretation::solid::SolidModel;
use render::Ground;
use restore::{Balance, FaultMove, RestoreNote, RestoreSettings, Restored, Span};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::fmt;
use std::fs;
use std::path::PathBuf;
use survey::{Progress, VerticalUnit};
use system::file::FileAction;
use ttf::Colour;

/// Makes a restored interpretation out of that of another project, in a project that has none.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Restore {
    /// The folder of the other project, which is not changed.
    pub source: PathBuf,
    /// The horizon that is restored.
    pub to: String,
    /// How it lies afterwards.
    #[serde(default)]
    pub settings: RestoreSettings,
}

/// What was restored.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ProjectRestored {
    /// What is said with every figure of it.
    pub words: String,
    /// The horizons, the restored one first.
    pub horizons: Vec<String>,
    /// What became of the faults that are left.
    pub faults: Vec<FaultMove>,
    /// What became of lengths and areas.
    pub balance: Balance,
    /// What is not as one may expect.
    pub notes: Vec<RestoreNote>,
    /// The same, a sentence each.
    pub said: Vec<String>,
}

impl fmt::Display for ProjectRestored {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.words)?;
        writeln!(f, "  horizons: {}", self.horizons.join(", "))?;
        for fault in &self.faults {
            let FaultMove { fault, heave_m, left_m, misfit_m: [mean, most] } = fault;
            writeln!(
                f,
                "  {fault}: mean heave {heave_m:.0} m closed to {left_m:.1} m; the hanging wall had to be fitted to the fault by \
                 {mean:.0} m in the mean, {most:.0} m at most"
            )?;
        }
        let Balance { along, line, horizons, layers } = &self.balance;
        writeln!(f, "  on {along} {line:.0}, today and restored:")?;
        for horizon in horizons {
            writeln!(f, "    length of {}: {}", horizon.horizon, told(&horizon.length_m, 1.0, "m"))?;
        }
        for layer in layers {
            writeln!(f, "    area of {}: {}", layer.layer, told(&layer.section_m2, 1e6, "km²"))?;
        }
        writeln!(f, "  on the map, and of the surface itself:")?;
        for horizon in horizons {
            let (map, surface) = (told(&horizon.map_m2, 1e6, "km²"), told(&horizon.surface_m2, 1e6, "km²"));
            writeln!(f, "    area of {}: {map}; {surface}", horizon.horizon)?;
        }
        self.said.iter().try_for_each(|said| writeln!(f, "  note: {said}"))
    }
}

/// A quantity today and restored, in so many of its units.
fn told(span: &Span, of: f64, unit: &str) -> String {
    let change = span.percent.map_or_else(String::new, |percent| format!(" ({percent:+.1} %)"));
    let places = if of > 1.0 { 3 } else { 0 };
    format!("{:.places$} → {:.places$} {unit}{change}", span.present / of, span.restored / of)
}

impl Restore {
    pub(super) fn execute(&self, draft: &mut Draft, progress: &Progress) -> Result<Effect, ProjectError> {
        let is_empty = |document: &Document| {
            document.horizons.is_empty() && document.faults.is_empty() && document.volumes.is_empty()
        };
        if !is_empty(&draft.document) {
            return Err(ProjectError::OverBlock { made: "a restored interpretation" });
        }
        let (_, source) = state::read(&self.source)?;
        if source.horizons.is_empty() {
            return Err(ProjectError::NoLayers);
        }
        let target = source.position(Noun::Horizon, &self.to)?;
        let facts = Facts::of(&self.source, &source);
        let model = facts.get(&SolidModel, progress)?;
        let horizons = source.horizons.iter().map(|entry| content::read_horizon(&self.source, entry, progress));
        let horizons = horizons.collect::<Result<Vec<_>, _>>()?;
        let geometry = source.frame()?;
        let restored = restore::restore(geometry, &model, &horizons, target, &self.settings, progress)?;
        let entry = RestoredEntry {
            from: self.source.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default(),
            to: self.to.clone(),
            datum: self.settings.datum,
            depth: geometry.vertical.value_at(restored.plane.z_at(middle(geometry.size()))),
        };
        let words = entry.words(geometry.vertical.unit);
        let step = draft.document.step;
        draft.document = taken_over(&source, &self.source, draft, &restored, entry)?;
        draft.document.step = step;
        write(draft, &source, &restored, progress)?;
        style_above(draft)?;
        let mut said: Vec<String> = restored.notes.iter().map(ToString::to_string).collect();
        if geometry.vertical.unit == VerticalUnit::Milliseconds {
            said.push(format!(
                "depths are two-way time: dips, lengths and areas hold for {} m/s, and throws were undone in time",
                geometry.velocity_m_s
            ));
        }
        Ok(Effect::Restored(Box::new(ProjectRestored {
            words,
            horizons: draft.document.names(Noun::Horizon),
            faults: restored.fault_moves,
            balance: restored.balance,
            notes: restored.notes,
            said,
        })))
    }
}

/// The middle of the survey, voxels.
fn middle([nx, ny, _]: [usize; 3]) -> glam::DVec2 {
    0.5 * glam::DVec2::new(nx as f64 - 1.0, ny as f64 - 1.0)
}

/// The state of the source with what stays of it: names, contacts, rocks, tiles and scenes of what is left.
fn taken_over(
    source: &Document,
    root: &std::path::Path,
    draft: &mut Draft,
    restored: &Restored,
    entry: RestoredEntry,
) -> Result<Document, ProjectError> {
    let mut document = source.clone();
    for texture in &mut document.textures {
        let from = content::texture_path(root, texture)?;
        let extension = from.extension().map(|extension| extension.to_string_lossy().into_owned()).unwrap_or_default();
        let (file, new) = draft.generation("textures", &texture.name, &extension)?;
        fs::copy(&from, &new).map_err(|source| ProjectError::io(FileAction::Written, &new, source))?;
        texture.file = file;
    }
    let horizons: BTreeSet<&str> = restored.horizons.iter().map(|horizon| horizon.name.as_str()).collect();
    let faults: BTreeSet<&str> = restored.faults.iter().map(|fault| fault.name.as_str()).collect();
    document.by_ids(|document| {
        for index in (0..document.horizons.len()).rev() {
            if !horizons.contains(document.horizons[index].name.as_str()) {
                document.take_out(index);
            }
        }
        document.faults.retain(|fault| faults.contains(fault.name.as_str()));
        document.volumes.clear();
        document.wells.clear();
    });
    document.geological_history = None;
    document.fonts.clear();
    document.extraction = None;
    document.fault_proposals = None;
    document.sticks.clear();
    document.parameterization = None;
    document.notes.clear();
    document.figures.clear();
    for scene in &mut document.scenes {
        scene.scene.ground.get_or_insert_with(Ground::default);
        scene.scene.blend = 0.0;
    }
    document.restored = Some(entry);
    Ok(document)
}

/// Writes horizons and faults.
fn write(draft: &mut Draft, source: &Document, restored: &Restored, progress: &Progress) -> Result<(), ProjectError> {
    let chosen_by = if source.uninterpreted().is_some() { Chooser::Program } else { Chooser::Person };
    let origin = Origin::Restored { chosen_by };
    for (index, horizon) in restored.horizons.iter().enumerate() {
        let (file, new) = draft.generation("horizons", &horizon.name, "zarr")?;
        store::write_horizon(&new, horizon, progress)?;
        let before = draft.document.horizons[index].clone();
        let colour = before.own_colour();
        let hash = content::hash_horizon(horizon);
        draft.document.horizons[index] = HorizonEntry {
            file,
            hash,
            colour,
            origin: origin.clone(),
            assembly: None,
            gap_m: None,
            refined: Vec::new(),
            ..before
        };
    }
    for (index, fault) in restored.faults.iter().enumerate() {
        let (file, new) = draft.generation("faults", &fault.name, "json")?;
        store::write_fault(&new, fault)?;
        let before = draft.document.faults[index].clone();
        let truncated_by = fault.truncated_by.clone();
        let hash = content::hash_fault(fault);
        draft.document.faults[index] =
            FaultEntry { file, hash, truncated_by, grown_m: 0.0, origin: origin.clone(), ..before };
    }
    Ok(())
}

/// Makes what lies above the restored horizon air, or water: white, without a pattern.
fn style_above(draft: &mut Draft) -> Result<(), ProjectError> {
    let names = draft.document.layers();
    let free = ["Air", "Air above", "Above the restored horizon"]
        .into_iter()
        .find(|name| !names[1..].iter().any(|present| present.to_lowercase() == name.to_lowercase()));
    if let Some(free) = free {
        draft.document.name_layer(0, free)?;
    }
    let layer = draft.document.layers().swap_remove(0);
    draft.document.k.remove(&layer);
    draft.document.style.layers.styles.retain(|style| style.layer != layer && style.layer != names[0]);
    let style =
        SetLayer { layer, pattern: Some("plain".to_owned()), colour: Some(Colour::WHITE), ..SetLayer::default() };
    style.execute(draft).map(drop)
}
