//! A block from its geological history: horizons, faults, layers and their rocks, out of a text of events.
//!
//! The text is kept in the project as it was given (`geological_history`). What is written beside it is an ordinary
//! interpretation, which every other command takes like one that was imported.

use super::fault_parts::{self, Parts};
use super::{Effect, ProjectError, SetLayer};
use crate::content;
use crate::document::{FaultEntry, HorizonEntry, Id, Origin};
use crate::folder::Draft;
use crate::styles;
use glam::DVec3;
use history::{Bedding, FaultBlocks, History};
use model::FaultNetwork;
use param::KDefinition;
use serde::{Deserialize, Serialize};
use std::fmt;
use survey::Progress;
use ttf::Colour;

/// Makes the block that a history tells of, in a project that has none.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct TellHistory {
    /// The text of the history (docs/history.md).
    pub text: String,
}

/// What was made.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct HistoryTold {
    /// What the block is called.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
    /// Count of events.
    pub events: usize,
    /// The horizons, youngest first.
    pub horizons: Vec<String>,
    /// The faults.
    pub faults: Vec<String>,
    /// The layers, youngest first.
    pub layers: Vec<String>,
    /// What is not as one may expect, a sentence each, with the line of the text where there is one.
    pub notes: Vec<String>,
}

impl fmt::Display for HistoryTold {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let title = self.title.as_deref().unwrap_or("a block");
        writeln!(f, "{title}: {} events", self.events)?;
        writeln!(f, "  horizons: {}", self.horizons.join(", "))?;
        if !self.faults.is_empty() {
            writeln!(f, "  faults: {}", self.faults.join(", "))?;
        }
        writeln!(f, "  layers: {}", self.layers.join(", "))?;
        self.notes.iter().try_for_each(|note| writeln!(f, "  note: {note}"))
    }
}

/// Reads a history whose rocks are those of the vocabulary.
fn read(text: &str, patterns: &[&str]) -> Result<History, ProjectError> {
    let is_rock = |name: &str| match ttf::rock(name, patterns) {
        Some(_) => Ok(()),
        None => Err(ttf::rocks_like(name).into_iter().map(str::to_owned).collect()),
    };
    History::with_rocks(text, &is_rock).map_err(|source| ProjectError::History { source })
}

impl TellHistory {
    pub(super) fn execute(&self, draft: &mut Draft, progress: &Progress) -> Result<Effect, ProjectError> {
        if !(draft.document.horizons.is_empty()
            && draft.document.faults.is_empty()
            && draft.document.volumes.is_empty())
        {
            return Err(ProjectError::OverBlock { made: "the block of a history" });
        }
        let library = styles::pattern_library(draft.root(), &draft.document)?;
        let patterns: Vec<&str> = library.patterns().map(|pattern| pattern.name.as_str()).collect();
        let history = read(&self.text, &patterns)?;
        progress.begin("block", 3);
        let stage = history.last_stage();
        let geometry = stage.geometry();
        let mut notes: Vec<String> = history.notes().iter().map(ToString::to_string).collect();
        draft.document.geometry = Some(geometry.clone());
        draft.document.geological_history = Some(self.text.clone());
        let mut all = Vec::new();
        for fault in &stage.faults() {
            let Parts { faults, told } = fault_parts::of_surface(&draft.document, &geometry, fault)?;
            notes.extend(told.map(|told| format!("fault {}: {told}", fault.name)));
            for fault in faults {
                all.push(fault.clone());
                let hash = content::hash_fault(&fault);
                let (file, new) = draft.generation("faults", &fault.name, "json")?;
                store::write_fault(&new, &fault)?;
                draft.document.faults.push(FaultEntry {
                    id: Id::default(),
                    name: fault.name,
                    truncated_by: fault.truncated_by,
                    grown_m: 0.0,
                    file,
                    hash,
                    origin: Origin::History,
                    colour: None,
                });
            }
        }
        // The sheets of horizons are those of the blocks between the faults as the model sees them.
        let network = FaultNetwork::build(&geometry, &all, &Progress::silent())?;
        let at = |p: DVec3| network.block_at(geometry.voxel_from_world(p).as_vec3());
        progress.step(1)?;
        let made = stage.interpretation(&FaultBlocks { count: network.block_count(), at: &at });
        notes.extend(made.notes);
        progress.step(1)?;
        for (position, (horizon, of)) in made.horizons.iter().zip(&made.stratigraphy.horizons).enumerate() {
            let hash = content::hash_horizon(horizon);
            let (file, new) = draft.generation("horizons", &horizon.name, "zarr")?;
            store::write_horizon(&new, horizon, progress)?;
            let entry = HorizonEntry {
                id: Id::default(),
                name: horizon.name.clone(),
                contact: of.contact,
                file,
                hash,
                origin: Origin::History,
                assembly: None,
                colour: None,
                gap_m: None,
                refined: Vec::new(),
            };
            draft.document.insert_horizon(position, entry);
        }
        progress.step(1)?;
        for (position, name) in made.stratigraphy.layer_names.iter().enumerate() {
            draft.document.name_layer(position, name)?;
        }
        for ((layer, rock), bedding) in made.stratigraphy.layer_names.iter().zip(&made.rocks).zip(&made.bedding) {
            let mut style = SetLayer { layer: layer.clone(), rock: rock.clone(), ..SetLayer::default() };
            style.k = bedding.map(|bedding| match bedding {
                Bedding::Level => KDefinition::ParallelToTop,
                Bedding::Copied => KDefinition::Proportional,
            });
            if rock.is_none() {
                style.pattern = Some("plain".to_owned());
                style.colour = Some(Colour::WHITE);
            }
            style.execute(draft)?;
        }
        let named = |names: Vec<&str>| names.into_iter().map(str::to_owned).collect();
        Ok(Effect::HistoryTold(Box::new(HistoryTold {
            title: history.title().map(str::to_owned),
            events: history.events().len(),
            horizons: named(draft.document.horizons.iter().map(|entry| entry.name.as_str()).collect()),
            faults: named(draft.document.faults.iter().map(|entry| entry.name.as_str()).collect()),
            layers: made.stratigraphy.layer_names,
            notes,
        })))
    }
}
