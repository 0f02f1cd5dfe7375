//! Picking: a place selects a leaf, the climb a node of its tree, and the node becomes part of a horizon. A pick can be
//! moved later.

use super::{Effect, ProjectError};
use crate::derived::FaultBlocks;
use crate::document::{Assembly, PickEntry};
use crate::folder::Draft;
use crate::interpretation::assembly::{self, AssemblyReport, ReportedOverlap, rebuild};
use crate::interpretation::candidates::Candidates;
use interp::assembly::{ClimbSettings, Fingerprint, NodeFit, Operation, Overlap, Selection, highest_valid, node_above};
use model::FaultNetwork;
use serde::{Deserialize, Serialize};
use survey::{Progress, SurveyGeometry};
use ttf::Colour;

/// How far to climb above the leaf.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Climb {
    /// By this many levels.
    Levels(u32),
    /// To the highest node that has no two depths at one trace.
    HighestValid,
}

/// Picks a node of a surface tree and adds it to a horizon, or removes it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PickNode {
    /// Inline, crossline and vertical value.
    pub at: [f64; 3],
    /// The horizon; it is created if it does not exist.
    pub horizon: String,
    /// Whether the node is added or removed.
    #[serde(default)]
    pub operation: Operation,
    /// Colour of the horizon; `None`: its present one, or the next of the palette.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub colour: Option<Colour>,
    /// How far to climb.
    pub climb: Climb,
}

/// Moves a pick up or down its tree.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct MovePick {
    /// Its number.
    pub id: u32,
    /// The movement.
    pub to: Move,
}

/// A movement of a pick.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Move {
    /// Up by this many levels.
    Up(u32),
    /// Down by this many levels.
    Down(u32),
    /// To the highest node without overlap.
    HighestValid,
}

/// Repeats picks on the present extraction.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ReplayPicks {
    /// The horizon; `None`: all that were assembled from picks.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub horizon: Option<String>,
    /// What happens to picks that no longer fit.
    #[serde(default)]
    pub unfit: Unfit,
}

/// What happens to picks that no longer fit.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Unfit {
    /// Nothing is changed, and an error names them.
    #[default]
    Refuse,
    /// They are removed from the log.
    Drop,
}

/// The report of a pick.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Picked {
    /// Number of the pick.
    pub pick: u32,
    /// The horizon.
    pub horizon: String,
    /// Whether the node was added or removed.
    pub operation: Operation,
    /// The leaf at the place.
    pub leaf: u32,
    /// Levels above the leaf.
    pub up: u32,
    /// Levels from the leaf to the root.
    pub levels: u32,
    /// Triangles of the node.
    pub triangles: u32,
    /// Overlap of the next higher node, which ended the climb.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stopped_by: Option<ReportedOverlap>,
    /// The present state of the horizon.
    pub result: AssemblyReport,
}

impl std::fmt::Display for Picked {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let verb = if self.operation == Operation::Add { "added to" } else { "removed from" };
        write!(
            f,
            "pick {}: leaf {}, {} of {} levels up, {} triangles, {verb} \"{}\"",
            self.pick, self.leaf, self.up, self.levels, self.triangles, self.horizon
        )?;
        if let Some(overlap) = &self.stopped_by {
            write!(f, "; one level higher {} traces would have two nodes", overlap.traces)?;
        }
        write!(f, "\n  {}", self.result)
    }
}

/// The report of a replay.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Replayed {
    /// The picks by how well they fit.
    pub picks: Vec<ReplayedPick>,
    /// The present state of the horizons.
    pub horizons: Vec<(String, AssemblyReport)>,
    /// Horizons none of whose picks fits, with the number of their picks; they stay as they were.
    pub left: Vec<(String, usize)>,
}

/// A pick that was repeated.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ReplayedPick {
    /// Its number.
    pub pick: u32,
    /// How its node compares with the former one.
    pub fit: NodeFit,
    /// Number of triangles of the former node and of the present one.
    pub triangles: [u32; 2],
}

impl std::fmt::Display for Replayed {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let count = |fit| self.picks.iter().filter(|pick| pick.fit == fit).count();
        write!(f, "{} picks are unchanged, {} nearly so", count(NodeFit::Same), count(NodeFit::Similar))?;
        let dropped: Vec<String> =
            self.picks.iter().filter(|p| p.fit == NodeFit::Different).map(|p| p.pick.to_string()).collect();
        if !dropped.is_empty() {
            write!(f, "; these no longer fit and were removed: {}", dropped.join(", "))?;
        }
        self.horizons.iter().try_for_each(|(name, report)| write!(f, "\n{name}: {report}"))?;
        self.left.iter().try_for_each(|(name, picks)| {
            write!(f, "\n{name}: none of its {picks} picks fits; it stays as it was. Remove it and pick it again")
        })
    }
}

/// The node, the levels climbed, and the overlap that ended the climb.
fn climbed(
    candidates: &Candidates,
    leaf: u32,
    climb: Climb,
    chosen: &Selection,
    blocks: &FaultNetwork,
) -> Result<(u32, u32, Option<Overlap>), ProjectError> {
    Ok(match climb {
        Climb::Levels(up) => (node_above(&candidates.forest, leaf, up)?, up, None),
        Climb::HighestValid => {
            // A log may name a leaf that the extraction does not have.
            node_above(&candidates.forest, leaf, 0)?;
            let found = highest_valid(&candidates.forest, leaf, chosen, blocks, &ClimbSettings::default());
            (found.node, found.up, found.stopped_by)
        }
    })
}

impl PickNode {
    pub(super) fn execute(&self, draft: &mut Draft, progress: &Progress) -> Result<Effect, ProjectError> {
        let mut log = assembly::log_or_new(draft, &self.horizon)?;
        let candidates = Candidates::for_picks(draft.facts(), &[self.at], progress)?;
        let blocks = draft.facts().get(&FaultBlocks, progress)?;
        let id = draft.document.next_pick_id();
        let geometry = draft.document.frame()?.clone();
        let hit = candidates.leaf_near(&geometry, self.at)?;
        let stopped_by = self.enter(&mut log, id, hit.leaf, &candidates, &blocks)?;
        let stopped_by = stopped_by.and_then(|overlap| ReportedOverlap::new(overlap, &geometry));
        let PickEntry { leaf, up, node, .. } = log.picks[log.picks.len() - 1];
        let result = rebuild(draft, Some(&candidates), &blocks, &self.horizon, log, progress)?;
        Ok(Effect::Picked(Box::new(Picked {
            pick: id,
            horizon: self.horizon.clone(),
            operation: self.operation,
            leaf,
            up,
            levels: candidates.levels(leaf),
            triangles: node.triangles,
            stopped_by,
            result,
        })))
    }

    /// Appends the pick of a leaf to a log; returns the overlap that ended the climb.
    fn enter(
        &self,
        log: &mut Assembly,
        id: u32,
        leaf: u32,
        candidates: &Candidates,
        blocks: &FaultNetwork,
    ) -> Result<Option<Overlap>, ProjectError> {
        let chosen = assembly::selection(&self.horizon, log, candidates)?;
        // A removed node may overlap with what stays.
        let beside = if self.operation == Operation::Add { chosen.clone() } else { Selection::default() };
        let (node, up, stopped_by) = climbed(candidates, leaf, self.climb, &beside, blocks)?;
        let mut own = Selection::default();
        own.insert(candidates.forest.nodes[node as usize].triangles.clone());
        let common = own.intersection(&chosen).len();
        match self.operation {
            Operation::Add if common == own.len() => {
                return Err(ProjectError::AlreadyPicked { horizon: self.horizon.clone(), leaf });
            }
            Operation::Remove if common == 0 => {
                return Err(ProjectError::NotPicked { horizon: self.horizon.clone(), leaf });
            }
            _ => {}
        }
        if let Some(colour) = self.colour {
            log.colour = colour;
        }
        log.picks.push(PickEntry {
            id,
            at: self.at,
            operation: self.operation,
            leaf,
            up,
            extraction: candidates.key.clone(),
            node: Fingerprint::of(&candidates.forest, node),
        });
        Ok(stopped_by)
    }
}

/// Makes several picks of one horizon in one step of the history, as a lasso does.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PickNodes {
    /// The picks in order, all of the same horizon.
    pub picks: Vec<PickNode>,
}

impl PickNodes {
    pub(super) fn execute(&self, draft: &mut Draft, progress: &Progress) -> Result<Effect, ProjectError> {
        let Some(first) = self.picks.first() else {
            return Ok(Effect::Changed { summary: "no picks".to_owned() });
        };
        if let Some(other) = self.picks.iter().find(|pick| pick.horizon != first.horizon) {
            return Err(ProjectError::SeveralHorizons { horizons: [first.horizon.clone(), other.horizon.clone()] });
        }
        let mut log = assembly::log_or_new(draft, &first.horizon)?;
        let places: Vec<[f64; 3]> = self.picks.iter().map(|pick| pick.at).collect();
        let candidates = Candidates::for_picks(draft.facts(), &places, progress)?;
        let blocks = draft.facts().get(&FaultBlocks, progress)?;
        let id = draft.document.next_pick_id();
        for (n, pick) in self.picks.iter().enumerate() {
            let hit = candidates.leaf_near(draft.document.frame()?, pick.at)?;
            pick.enter(&mut log, id + n as u32, hit.leaf, &candidates, &blocks)?;
        }
        rebuild(draft, Some(&candidates), &blocks, &first.horizon, log, progress)?;
        Ok(Effect::Changed { summary: format!("{} picks of {}", self.picks.len(), first.horizon) })
    }
}

/// Removes a pick from its horizon's log, as if it had never been made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct RemovePick {
    /// Its number.
    pub id: u32,
}

impl RemovePick {
    pub(super) fn execute(self, draft: &mut Draft, progress: &Progress) -> Result<Effect, ProjectError> {
        let (name, mut log) = find(draft, self.id)?;
        log.picks.retain(|pick| pick.id != self.id);
        log.drawn.retain(|drawn| drawn.id != self.id);
        let candidates = assembly::needed(draft, &log, progress)?;
        let blocks = draft.facts().get(&FaultBlocks, progress)?;
        rebuild(draft, candidates.as_deref(), &blocks, &name, log, progress)?;
        Ok(Effect::Changed { summary: format!("removed pick {}", self.id) })
    }
}

/// Finds a pick, or what was drawn, by its number: its horizon and that horizon's log.
fn find(draft: &Draft, id: u32) -> Result<(String, Assembly), ProjectError> {
    let logs = || draft.document.horizons.iter().filter_map(|entry| Some((entry, entry.assembly.as_ref()?)));
    let found = logs().find(|(_, log)| log.numbers().any(|known| known == id));
    found.map(|(entry, log)| (entry.name.clone(), log.clone())).ok_or_else(|| ProjectError::UnknownPick {
        pick: id,
        known: logs().flat_map(|(_, log)| log.numbers()).collect(),
    })
}

impl MovePick {
    pub(super) fn execute(&self, draft: &mut Draft, progress: &Progress) -> Result<Effect, ProjectError> {
        let (name, mut log) = find(draft, self.id)?;
        let place = log.picks.iter().position(|pick| pick.id == self.id);
        let place = place.ok_or(ProjectError::NotClimbable { pick: self.id })?;
        let candidates = Candidates::for_picks(draft.facts(), &[], progress)?;
        // Refuses a log of another extraction.
        assembly::selection(&name, &log, &candidates)?;
        let blocks = draft.facts().get(&FaultBlocks, progress)?;
        let PickEntry { leaf, up, operation, .. } = log.picks[place];
        let climb = match self.to {
            Move::Up(by) => Climb::Levels(up.saturating_add(by)),
            Move::Down(by) if by > up => return Err(ProjectError::AtLeaf { pick: self.id, up }),
            Move::Down(by) => Climb::Levels(up - by),
            Move::HighestValid => Climb::HighestValid,
        };
        let mut rest = log.clone();
        rest.picks.remove(place);
        let beside = assembly::selection(&name, &rest, &candidates)?;
        let (node, up, stopped_by) = climbed(&candidates, leaf, climb, &beside, &blocks)?;
        let geometry = draft.document.frame()?;
        let stopped_by = stopped_by.and_then(|overlap| ReportedOverlap::new(overlap, geometry));
        let node = Fingerprint::of(&candidates.forest, node);
        (log.picks[place].up, log.picks[place].node) = (up, node);
        let result = rebuild(draft, Some(&candidates), &blocks, &name, log, progress)?;
        Ok(Effect::Picked(Box::new(Picked {
            pick: self.id,
            horizon: name,
            operation,
            leaf,
            up,
            levels: candidates.levels(leaf),
            triangles: node.triangles,
            stopped_by,
            result,
        })))
    }
}

impl ReplayPicks {
    pub(super) fn execute(&self, draft: &mut Draft, progress: &Progress) -> Result<Effect, ProjectError> {
        let geometry = draft.document.frame()?.clone();
        if let Some(name) = &self.horizon {
            assembly::log_of(draft, name)?;
        }
        let wanted = |name: &str| self.horizon.as_deref().is_none_or(|only| only == name);
        let logs: Vec<(String, Assembly)> = draft
            .document
            .horizons
            .iter()
            .filter(|entry| wanted(&entry.name))
            .filter_map(|entry| Some((entry.name.clone(), entry.assembly.clone()?)))
            .collect();
        let has_picks = logs.iter().any(|(_, log)| !log.picks.is_empty());
        let places: Vec<[f64; 3]> = logs.iter().flat_map(|(_, log)| &log.picks).map(|pick| pick.at).collect();
        let candidates = has_picks.then(|| Candidates::for_picks(draft.facts(), &places, progress)).transpose()?;
        let blocks = draft.facts().get(&FaultBlocks, progress)?;
        let mut done = Replayed { picks: Vec::new(), horizons: Vec::new(), left: Vec::new() };
        for (name, mut log) in logs {
            let mut replayed = Vec::new();
            log.picks.retain_mut(|pick| {
                let before = pick.node.triangles;
                let again = |candidates| again(pick, candidates, &geometry);
                let fit = candidates.as_deref().map_or(NodeFit::Different, again);
                replayed.push(ReplayedPick { pick: pick.id, fit, triangles: [before, pick.node.triangles] });
                fit != NodeFit::Different
            });
            if log.picks.is_empty() && log.drawn.is_empty() {
                done.left.push((name, replayed.len()));
                continue;
            }
            let is_unfit = |pick: &&ReplayedPick| pick.fit == NodeFit::Different;
            let unfit: Vec<u32> = replayed.iter().filter(is_unfit).map(|pick| pick.pick).collect();
            if !unfit.is_empty() && self.unfit == Unfit::Refuse {
                return Err(ProjectError::UnfitPicks { horizon: name, picks: unfit });
            }
            done.picks.extend(replayed);
            let report = rebuild(draft, candidates.as_deref(), &blocks, &name, log, progress)?;
            done.horizons.push((name, report));
        }
        if let Some((horizon, _)) =
            done.left.first().filter(|_| done.horizons.is_empty() || self.unfit == Unfit::Refuse)
        {
            return Err(ProjectError::NoPickFits { horizon: horizon.clone() });
        }
        Ok(Effect::Replayed(Box::new(done)))
    }
}

/// Repeats one pick: at its place, at the level whose node is most like the former one.
fn again(pick: &mut PickEntry, candidates: &Candidates, geometry: &SurveyGeometry) -> NodeFit {
    let Ok(hit) = candidates.leaf_near(geometry, pick.at) else { return NodeFit::Different };
    let rank = |fit: NodeFit| match fit {
        NodeFit::Same => 0,
        NodeFit::Similar => 1,
        NodeFit::Different => 2,
    };
    let mut best: Option<(NodeFit, u32, Fingerprint)> = None;
    for up in 0..=candidates.levels(hit.leaf) {
        let Ok(node) = node_above(&candidates.forest, hit.leaf, up) else { break };
        let now = Fingerprint::of(&candidates.forest, node);
        let fit = pick.node.compare(&now);
        if best.as_ref().is_none_or(|(least, ..)| rank(fit) < rank(*least)) {
            best = Some((fit, up, now));
        }
        if now.triangles > 2 * pick.node.triangles {
            break;
        }
    }
    let Some((fit, up, node)) = best else { return NodeFit::Different };
    if fit != NodeFit::Different {
        (pick.leaf, pick.up, pick.node) = (hit.leaf, up, node);
        pick.extraction.clone_from(&candidates.key);
    }
    fit
}
