//! Faults that are drawn as sticks, and proposed faults that are accepted.

use super::fault_parts::{self, Parts};
use super::{Effect, Noun, ProjectError};
use crate::content;
use crate::document::{FaultEntry, FaultSticks, Id, Origin};
use crate::error::FaultEditError;
use crate::folder::Draft;
use crate::interpretation::assembly::rebuild_all;
use crate::interpretation::proposals;
use glam::DVec3;
use serde::{Deserialize, Serialize};
use survey::{Fault, Progress, SurveyGeometry};

/// Adds sticks to a fault; from two sticks on it has a surface.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PickFault {
    /// Name of the fault.
    pub name: String,
    /// The sticks, each of at least two points: inline, crossline, vertical value.
    pub sticks: Vec<Vec<[f64; 3]>>,
}

/// Moves a point of a stick that a fault was drawn with.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MoveStickPoint {
    /// Name of the fault.
    pub fault: String,
    /// Which of its sticks, counted from 0.
    pub stick: usize,
    /// Which of the stick's points, counted from 0.
    pub point: usize,
    /// Where it goes: inline, crossline, vertical value.
    pub to: [f64; 3],
}

/// Adds a proposed fault to the project.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct AcceptFault {
    /// Number of the proposal.
    pub id: u32,
    /// Name of the fault.
    pub name: String,
}

impl PickFault {
    pub(super) fn execute(&self, draft: &mut Draft, progress: &Progress) -> Result<Effect, ProjectError> {
        let geometry = draft.document.frame()?.clone();
        if let Some(stick) = self.sticks.iter().position(|stick| stick.len() < 2) {
            return Err(ProjectError::ShortStick { stick: stick + 1 });
        }
        self.sticks.iter().flatten().try_for_each(|place| check_near(&geometry, *place))?;
        let drawn = draft.document.sticks.iter().position(|drawn| drawn.fault == self.name);
        let present = draft.document.faults.iter().position(|entry| entry.name == self.name);
        let drawn = match (drawn, present) {
            (Some(drawn), _) => drawn,
            (None, Some(_)) => return Err(ProjectError::NotDrawn { fault: self.name.clone() }),
            (None, None) => {
                draft.document.check_new_name(Noun::Fault, &self.name)?;
                draft.document.sticks.push(FaultSticks { fault: self.name.clone(), sticks: Vec::new() });
                draft.document.sticks.len() - 1
            }
        };
        draft.document.sticks[drawn].sticks.extend(self.sticks.iter().cloned());
        surface(draft, drawn, progress)
    }
}

impl MoveStickPoint {
    pub(super) fn execute(&self, draft: &mut Draft, progress: &Progress) -> Result<Effect, ProjectError> {
        check_near(draft.document.frame()?, self.to)?;
        let drawn = draft.document.sticks.iter().position(|drawn| drawn.fault == self.fault);
        let drawn = drawn.ok_or_else(|| ProjectError::NotDrawn { fault: self.fault.clone() })?;
        let stick = draft.document.sticks[drawn].sticks.get_mut(self.stick);
        let place = stick.and_then(|stick| stick.get_mut(self.point));
        let missing =
            || FaultEditError::NoStickPoint { fault: self.fault.clone(), stick: self.stick, point: self.point };
        *place.ok_or_else(missing)? = self.to;
        surface(draft, drawn, progress)
    }
}

/// Refuses a point far outside the survey. A stick may end a little outside it; a point farther outside is a mistyped
/// number.
pub(super) fn check_near(geometry: &SurveyGeometry, place: [f64; 3]) -> Result<(), ProjectError> {
    let voxel = geometry.voxel_from_lines(place[0], place[1]).extend(geometry.vertical.index_of(place[2]));
    let size = geometry.size();
    let is_near = (0..3).all(|axis| {
        let n = size[axis] as f64;
        voxel[axis] >= -0.25 * n && voxel[axis] <= 1.25 * n
    });
    if is_near {
        return Ok(());
    }
    Err(ProjectError::outside(place, geometry))
}

/// Makes the surface of the fault whose sticks these are; one stick alone has none.
fn surface(draft: &mut Draft, drawn: usize, progress: &Progress) -> Result<Effect, ProjectError> {
    let FaultSticks { fault: name, sticks } = &draft.document.sticks[drawn];
    let (name, count) = (name.clone(), sticks.len());
    if count < 2 {
        return Ok(Effect::Changed { summary: format!("fault {name}: one stick; a second one makes its surface") });
    }
    let (triangles, told) = of_sticks(draft, drawn, &Origin::Drawn)?;
    let fitted = rebuild_all(draft, progress)?;
    let summary = format!("fault {name}: {count} sticks, {triangles} triangles");
    Ok(Effect::changed(summary, told.into_iter().chain(fitted).collect()))
}

/// A place of a stick in world coordinates.
pub(super) fn world_of(geometry: &SurveyGeometry, place: &[f64; 3]) -> DVec3 {
    let voxel = geometry.voxel_from_lines(place[0], place[1]).extend(geometry.vertical.index_of(place[2]));
    geometry.world_from_voxel(voxel)
}

/// Makes the surface of the fault whose two or more sticks these are, or its parts; returns its triangles and what is to be
/// told of it. What the program proposed remains that.
pub(super) fn of_sticks(
    draft: &mut Draft,
    drawn: usize,
    origin: &Origin,
) -> Result<(usize, Option<String>), ProjectError> {
    let geometry = draft.document.frame()?.clone();
    let FaultSticks { fault: name, sticks } = draft.document.sticks[drawn].clone();
    let lines: Vec<Vec<DVec3>> =
        sticks.iter().map(|stick| stick.iter().map(|place| world_of(&geometry, place)).collect()).collect();
    let (Parts { faults, told }, of_parts) = fault_parts::of_sticks(&draft.document, &geometry, &name, &lines)?;
    let triangles: usize = faults.iter().map(|fault| fault.mesh.triangles.len()).sum();
    for (fault, own) in faults.iter().zip(&of_parts) {
        let before = draft.document.faults.iter().find(|entry| entry.name == fault.name);
        let proposed = before.map(|entry| &entry.origin).filter(|origin| matches!(origin, Origin::Proposed { .. }));
        let origin = proposed.unwrap_or(origin).clone();
        put(draft, fault, origin)?;
        let sticks = own.iter().map(|&n| sticks[n].clone()).collect();
        if fault.name != name {
            draft.document.sticks.push(FaultSticks { fault: fault.name.clone(), sticks });
        } else if of_parts.len() > 1 {
            draft.document.sticks[drawn].sticks = sticks;
        }
    }
    Ok((triangles, told))
}

impl AcceptFault {
    pub(super) fn execute(&self, draft: &mut Draft, progress: &Progress) -> Result<Effect, ProjectError> {
        draft.document.check_new_name(Noun::Fault, &self.name)?;
        let proposal = proposals::find(draft.root(), &draft.document, self.id)?;
        let geometry = draft.document.frame()?.clone();
        let fault = proposal.fault(&self.name);
        let Parts { faults, told } = fault_parts::of_surface(&draft.document, &geometry, &fault)?;
        for fault in &faults {
            put(draft, fault, Origin::Proposed { horizons: proposal.horizons.clone() })?;
        }
        let fitted = rebuild_all(draft, progress)?;
        let summary = format!("fault {}: proposal {} accepted", self.name, self.id);
        Ok(Effect::changed(summary, told.into_iter().chain(fitted).collect()))
    }
}

/// Writes a fault and its entry; an existing fault of that name is replaced.
pub(super) fn put(draft: &mut Draft, fault: &Fault, origin: Origin) -> Result<(), ProjectError> {
    let old = draft.document.faults.iter().position(|entry| entry.name == fault.name);
    let before = old.map(|old| &draft.document.faults[old]);
    let new = || (fault.truncated_by.clone(), fault.grown_m);
    let (truncated_by, grown_m) = before.map_or_else(new, |entry| (entry.truncated_by.clone(), entry.grown_m));
    let colour = before.and_then(|entry| entry.colour);
    let id = before.map_or_else(Id::default, |entry| entry.id.clone());
    let (file, new) = draft.generation("faults", &fault.name, "json")?;
    store::write_fault(&new, fault)?;
    let (name, hash) = (fault.name.clone(), content::hash_fault(fault));
    let entry = FaultEntry { id, name, truncated_by, grown_m, file, hash, origin, colour };
    match old {
        Some(old) => draft.document.faults[old] = entry,
        None => draft.document.faults.push(entry),
    }
    Ok(())
}
