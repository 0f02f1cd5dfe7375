//! Faults that are changed as a whole: cut in two, merged, given sticks that can be moved.

use super::fault_parts::{self, Parts};
use super::fault_pick::{check_near, of_sticks, put, world_of};
use super::{Effect, Noun, ProjectError};
use crate::content;
use crate::document::{FaultEntry, FaultSticks, Origin};
use crate::error::FaultEditError;
use crate::folder::Draft;
use crate::interpretation::assembly::rebuild_all;
use files::{axis_along, extent_along, planes_along, stick_along_cut, sticks_on_sections, strike};
use glam::{DVec2, DVec3};
use model::FaultNetwork;
use serde::{Deserialize, Serialize};
use survey::{Fault, Progress, SurveyGeometry, TriangleMesh};

/// Cuts a fault in two. The larger part keeps its name, and what ends at it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CutFault {
    /// Name of the fault.
    pub fault: String,
    /// Where: inline, crossline, vertical value.
    pub at: [f64; 3],
    /// Which way the cut runs from there.
    #[serde(default)]
    pub along: CutAlong,
    /// Name of the smaller part; by default one is found.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
}

/// Which way a fault is cut.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CutAlong {
    /// From top to bottom, across the strike.
    #[default]
    Dip,
    /// Along the strike, at one level.
    Strike,
}

/// Makes one fault of several that continue one another, with a surface across the gaps between them.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct MergeFaults {
    /// Their names; what ends at one of them ends at the new one.
    pub faults: Vec<String>,
    /// Name of the new one: that of one of them, or one that is free.
    pub name: String,
}

/// Gives a fault that was proposed or imported sticks, from which its surface is made from now on, so that their points can
/// be moved.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct GiveSticks {
    /// Name of the fault.
    pub fault: String,
}

/// Share of the shorter of two sticks on one section that may lie beside the other one, where faults are merged.
const BESIDE: f64 = 0.25;
/// Decimals of the places of sticks: a thousandth of a line is far finer than anyone can aim.
const DECIMALS: f64 = 1000.0;

/// A stick as it is stored: inline, crossline and vertical value of each point.
fn places(geometry: &SurveyGeometry, stick: &[DVec3]) -> Vec<[f64; 3]> {
    let place = |world: &DVec3| {
        let voxel = geometry.voxel_from_world(*world);
        let lines = geometry.lines_from_voxel(voxel.truncate());
        [lines.x, lines.y, geometry.vertical.value_at(voxel.z)].map(|value| (value * DECIMALS).round() / DECIMALS)
    };
    stick.iter().map(place).collect()
}

fn area_m2(mesh: &TriangleMesh, geometry: &SurveyGeometry) -> f64 {
    let metric = DVec3::new(1.0, 1.0, geometry.metres_per_vertical_unit());
    let area = |n: usize| {
        let [a, b, c] = mesh.corners(n).map(|corner| corner * metric);
        0.5 * (b - a).cross(c - a).length()
    };
    (0..mesh.triangles.len()).map(area).sum()
}

/// A name that is free for a part of a fault.
fn free_part_name(draft: &Draft, fault: &str) -> Result<String, ProjectError> {
    let mut number = 2;
    loop {
        let name = format!("{fault} {number}");
        match draft.document.check_new_name(Noun::Fault, &name) {
            Ok(()) => return Ok(name),
            Err(ProjectError::Duplicate { .. }) => number += 1,
            Err(error) => return Err(error),
        }
    }
}

/// The parts of a stick on both sides of a cut: where `off` is negative, and where it is not.
fn parted(stick: &[DVec3], off: impl Fn(DVec3) -> f64) -> [Vec<DVec3>; 2] {
    let mut parts = [Vec::new(), Vec::new()];
    for (n, &point) in stick.iter().enumerate() {
        let here = off(point);
        if let Some(&last) = n.checked_sub(1).and_then(|n| stick.get(n)) {
            let before = off(last);
            if (before < 0.0) != (here < 0.0) {
                let at = last.lerp(point, before / (before - here));
                parts.iter_mut().for_each(|part| part.push(at));
            }
        }
        parts[usize::from(here >= 0.0)].push(point);
    }
    parts
}

impl CutFault {
    pub(super) fn execute(&self, draft: &mut Draft, progress: &Progress) -> Result<Effect, ProjectError> {
        let geometry = draft.document.frame()?.clone();
        let index = draft.document.position(Noun::Fault, &self.fault)?;
        check_near(&geometry, self.at)?;
        let name = match &self.name {
            Some(name) => draft.document.check_new_name(Noun::Fault, name).map(|()| name.clone())?,
            None => free_part_name(draft, &self.fault)?,
        };
        let entry = draft.document.faults[index].clone();
        let whole = content::read_fault(draft.root(), &entry)?;
        let beside = || FaultEditError::CutBeside { fault: self.fault.clone(), at: self.at };
        let at = world_of(&geometry, &self.at);
        let across = match self.along {
            CutAlong::Dip => strike(&whole.mesh).ok_or_else(beside)?.extend(0.0),
            CutAlong::Strike => DVec3::Z,
        };
        let off = |point: DVec3| (point - at).dot(across);
        let offs: Vec<f64> = whole.mesh.vertices.iter().map(|vertex| off(*vertex)).collect();
        let mut meshes = whole.mesh.parted(&offs);
        let areas = [0, 1].map(|part: usize| area_m2(&meshes[part], &geometry));
        if areas.iter().any(|area| *area <= 0.0) {
            return Err(beside().into());
        }
        let larger = usize::from(areas[1] > areas[0]);
        let mut told = Vec::new();
        let sticks = self.sticks(draft, &geometry, &whole.mesh, &offs, off);
        for (part, name) in [(larger, &self.fault), (1 - larger, &name)] {
            if let Some(sticks) = &sticks {
                draft.document.sticks.retain(|drawn| drawn.fault != *name);
                draft.document.sticks.push(FaultSticks { fault: name.clone(), sticks: sticks[part].clone() });
                told.extend(of_sticks(draft, draft.document.sticks.len() - 1, &entry.origin)?.1);
            } else {
                draft.document.sticks.retain(|drawn| drawn.fault != *name);
                let fault = Fault { name: name.clone(), mesh: std::mem::take(&mut meshes[part]), ..whole.clone() };
                let Parts { faults, told: of_part } = fault_parts::of_surface(&draft.document, &geometry, &fault)?;
                for fault in &faults {
                    put(draft, fault, entry.origin.clone())?;
                }
                told.extend(of_part);
            }
        }
        let FaultEntry { truncated_by, grown_m, colour, .. } = entry;
        let smaller = draft.document.position(Noun::Fault, &name)?;
        let part = &mut draft.document.faults[smaller];
        (part.truncated_by, part.grown_m, part.colour) = (truncated_by, grown_m, colour);
        told.extend(rebuild_all(draft, progress)?);
        let share = 100.0 * areas[1 - larger] / (areas[0] + areas[1]);
        Ok(Effect::changed(format!("fault {} cut: {name} is {share:.0} % of it", self.fault), told))
    }

    /// The sticks of both parts, of a fault that has sticks; both have the line of the cut, where it runs down the dip.
    fn sticks(
        &self,
        draft: &Draft,
        geometry: &SurveyGeometry,
        mesh: &TriangleMesh,
        offs: &[f64],
        off: impl Fn(DVec3) -> f64,
    ) -> Option<[Vec<Vec<[f64; 3]>>; 2]> {
        let drawn = draft.document.sticks.iter().find(|drawn| drawn.fault == self.fault)?;
        let mut parts = [Vec::new(), Vec::new()];
        for stick in &drawn.sticks {
            let world: Vec<DVec3> = stick.iter().map(|place| world_of(geometry, place)).collect();
            let both = parted(&world, &off);
            for (part, own) in parts.iter_mut().zip(both).filter(|(_, own)| own.len() > 1) {
                part.push(places(geometry, &own));
            }
        }
        if self.along == CutAlong::Dip {
            let line = places(geometry, &stick_along_cut(mesh, geometry, offs));
            parts.iter_mut().filter(|_| line.len() > 1).for_each(|part| part.push(line.clone()));
        }
        parts.iter().all(|part| part.len() > 1).then_some(parts)
    }
}

impl MergeFaults {
    pub(super) fn execute(&self, draft: &mut Draft, progress: &Progress) -> Result<Effect, ProjectError> {
        let Self { faults, name } = self;
        let is_known = |n: usize| faults[..n].contains(&faults[n]);
        if faults.len() < 2 || (1..faults.len()).any(is_known) {
            return Err(FaultEditError::FewFaults.into());
        }
        let geometry = draft.document.frame()?.clone();
        let mut entries = Vec::new();
        let mut meshes = Vec::new();
        for fault in faults {
            let entry = draft.document.faults[draft.document.position(Noun::Fault, fault)?].clone();
            meshes.push(content::read_fault(draft.root(), &entry)?.mesh);
            entries.push(entry);
        }
        let kept = faults.iter().find(|fault| *fault == name).unwrap_or(&faults[0]);
        if kept != name {
            draft.document.check_new_name(Noun::Fault, name)?;
        }
        let sticks = self.sticks(draft, &geometry, &meshes)?;
        let document = &mut draft.document;
        // What ends at one of them ends at the one that they become, which ends at none of them.
        for entry in &mut document.faults {
            if let Some(by) = entry.truncated_by.as_mut().filter(|by| faults.contains(by)) {
                by.clone_from(kept);
            }
            if entry.name == *kept && entry.truncated_by.as_ref() == Some(kept) {
                entry.truncated_by = None;
            }
        }
        for gone in faults.iter().filter(|fault| *fault != kept) {
            let index = document.position(Noun::Fault, gone)?;
            document.by_ids(|document| document.faults.remove(index));
        }
        document.sticks.retain(|drawn| drawn.fault != *kept);
        document.sticks.push(FaultSticks { fault: kept.clone(), sticks });
        let mut horizons: Vec<String> = Vec::new();
        let mut is_proposed = false;
        for entry in &entries {
            if let Origin::Proposed { horizons: own } = &entry.origin {
                horizons.extend(own.iter().cloned());
                is_proposed = true;
            }
        }
        horizons.sort();
        horizons.dedup();
        let origin = if is_proposed { Origin::Proposed { horizons } } else { Origin::Drawn };
        let index = document.position(Noun::Fault, kept)?;
        document.faults[index].origin = origin.clone();
        let (_, told) = of_sticks(draft, draft.document.sticks.len() - 1, &origin)?;
        if kept != name {
            draft.document.by_ids(|document| document.name_entry(Noun::Fault, index, name));
        }
        draft.document.check_truncation()?;
        let fitted = rebuild_all(draft, progress)?;
        let summary = format!("faults {} are {name} now", faults.join(", "));
        Ok(Effect::changed(summary, told.into_iter().chain(fitted).collect()))
    }

    /// The sticks of the merged fault: those that were drawn, where the faults lie beside one another along the strike; else
    /// sticks on sections, each through all of the faults.
    fn sticks(
        &self,
        draft: &Draft,
        geometry: &SurveyGeometry,
        meshes: &[TriangleMesh],
    ) -> Result<Vec<Vec<[f64; 3]>>, ProjectError> {
        let mut all = TriangleMesh::default();
        for mesh in meshes {
            let first = all.vertices.len() as u32;
            all.vertices.extend(&mesh.vertices);
            all.triangles.extend(mesh.triangles.iter().map(|triangle| triangle.map(|v| first + v)));
        }
        let axis = axis_along(&all, geometry);
        let ranges: Vec<[f64; 2]> = meshes.iter().map(|mesh| extent_along(mesh, geometry, axis)).collect();
        let overlaps = |a: [f64; 2], b: [f64; 2]| a[1].min(b[1]) - a[0].max(b[0]) > 1.0;
        let are_apart = (0..ranges.len()).all(|n| !ranges[..n].iter().any(|range| overlaps(*range, ranges[n])));
        if are_apart {
            let mut sticks = Vec::new();
            for (fault, mesh) in self.faults.iter().zip(meshes) {
                match draft.document.sticks.iter().find(|drawn| drawn.fault == *fault) {
                    Some(drawn) => sticks.extend(drawn.sticks.iter().cloned()),
                    None => {
                        let cut = sticks_on_sections(mesh, geometry, axis, &planes_along(mesh, geometry, axis));
                        sticks.extend(cut.iter().filter(|stick| stick.len() > 1).map(|stick| places(geometry, stick)));
                    }
                }
            }
            return Ok(sticks);
        }
        let mut planes: Vec<f64> = meshes.iter().flat_map(|mesh| planes_along(mesh, geometry, axis)).collect();
        planes.sort_by(f64::total_cmp);
        planes.dedup_by(|a, b| (*a - *b).abs() < 0.5);
        let cuts: Vec<Vec<Vec<DVec3>>> =
            meshes.iter().map(|mesh| sticks_on_sections(mesh, geometry, axis, &planes)).collect();
        let mut sticks = Vec::new();
        for plane in 0..planes.len() {
            let mut own: Vec<(usize, &Vec<DVec3>)> =
                cuts.iter().map(|cuts| &cuts[plane]).enumerate().filter(|(_, stick)| stick.len() > 1).collect();
            own.sort_by(|a, b| a.1[0].z.total_cmp(&b.1[0].z));
            for pair in own.windows(2) {
                self.check_beside(geometry, [pair[0], pair[1]])?;
            }
            let stick: Vec<DVec3> = own.iter().flat_map(|(_, stick)| stick.iter().copied()).collect();
            if !stick.is_empty() {
                sticks.push(places(geometry, &stick));
            }
        }
        Ok(sticks)
    }

    /// Refuses two faults that run side by side, seen on a section on which both have a stick, the upper one first.
    fn check_beside(
        &self,
        geometry: &SurveyGeometry,
        [(a, upper), (b, lower)]: [(usize, &Vec<DVec3>); 2],
    ) -> Result<(), ProjectError> {
        let depths = |stick: &[DVec3]| {
            let z = || stick.iter().map(|p| p.z);
            [z().fold(f64::INFINITY, f64::min), z().fold(f64::NEG_INFINITY, f64::max)]
        };
        let [above, below] = [depths(upper), depths(lower)];
        let shared = above[1].min(below[1]) - below[0];
        if shared <= BESIDE * (above[1] - above[0]).min(below[1] - below[0]) {
            return Ok(());
        }
        let z = below[0] + 0.5 * shared;
        let at = |stick: &[DVec3]| -> DVec2 {
            let pair = stick.windows(2).find(|pair| (pair[0].z - z) * (pair[1].z - z) <= 0.0);
            let [p, q] = pair.map_or([stick[0]; 2], |pair| [pair[0], pair[1]]);
            let share = if q.z == p.z { 0.0 } else { (z - p.z) / (q.z - p.z) };
            p.lerp(q, share).truncate()
        };
        let [p, q] = [at(upper), at(lower)];
        let lines = geometry.lines_from_voxel(geometry.voxel_from_world(p.extend(z)).truncate());
        let faults = [self.faults[a].clone(), self.faults[b].clone()];
        Err(FaultEditError::SideBySide { faults, at: lines.to_array(), apart_m: p.distance(q) }.into())
    }
}

impl GiveSticks {
    pub(super) fn execute(&self, draft: &mut Draft, progress: &Progress) -> Result<Effect, ProjectError> {
        let Self { fault: name } = self;
        let geometry = draft.document.frame()?.clone();
        let entry = draft.document.faults[draft.document.position(Noun::Fault, name)?].clone();
        if draft.document.sticks.iter().any(|drawn| drawn.fault == *name) {
            return Err(FaultEditError::HasSticks { fault: name.clone() }.into());
        }
        let before = content::read_fault(draft.root(), &entry)?;
        let axis = axis_along(&before.mesh, &geometry);
        let cut = sticks_on_sections(&before.mesh, &geometry, axis, &planes_along(&before.mesh, &geometry, axis));
        let sticks: Vec<Vec<[f64; 3]>> =
            cut.iter().filter(|stick| stick.len() > 1).map(|stick| places(&geometry, stick)).collect();
        if sticks.len() < 2 {
            return Err(FaultEditError::FlatSticks { fault: name.clone() }.into());
        }
        let count = sticks.len();
        draft.document.sticks.push(FaultSticks { fault: name.clone(), sticks });
        let (_, told) = of_sticks(draft, draft.document.sticks.len() - 1, &Origin::Drawn)?;
        let now = &draft.document.faults[draft.document.position(Noun::Fault, name)?];
        let after = Fault { truncated_by: None, ..content::read_fault(draft.root(), now)? };
        let network = FaultNetwork::build(&geometry, &[after], progress)?;
        let mut off: Vec<f32> = before
            .mesh
            .vertices
            .iter()
            .map(|vertex| network.side(0, geometry.voxel_from_world(*vertex).as_vec3()).abs())
            .collect();
        off.sort_by(f32::total_cmp);
        let most = off.get(off.len() * 19 / 20).copied().unwrap_or(0.0);
        let fitted = rebuild_all(draft, progress)?;
        let summary = format!("fault {name}: {count} sticks, 95 % of its surface within {most:.1} m of what it was");
        Ok(Effect::changed(summary, told.into_iter().chain(fitted).collect()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stick_is_cut_where_it_crosses() {
        let stick = [DVec3::ZERO, DVec3::new(0.0, 0.0, 4.0), DVec3::new(2.0, 0.0, 8.0)];
        let [above, below] = parted(&stick, |p| p.z - 6.0);
        assert_eq!(above, [stick[0], stick[1], DVec3::new(1.0, 0.0, 6.0)]);
        assert_eq!(below, [DVec3::new(1.0, 0.0, 6.0), stick[2]]);
        let [none, all] = parted(&stick, |p| p.z + 1.0);
        assert!(none.is_empty() && all == stick);
    }
}
