//! Adding faults, and stating at which other fault each ends.

use super::{Effect, Noun, ProjectError};
use crate::content;
use crate::document::{FaultEntry, Id, is_zero};
use crate::folder::Draft;
use crate::interpretation::assembly::rebuild_all;
use files::{ImportOptions, ImportReport};
use model::FaultNetwork;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;
use survey::fault::Fault;
use survey::{Note, Progress, SurveyGeometry};

/// Reads a fault into the project.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AddFault {
    /// The file.
    pub path: PathBuf,
    /// Name of the fault.
    pub name: String,
    /// The fault it ends at.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub truncated_by: Option<String>,
    /// By how much it reaches beyond what was drawn, m; 0: it ends where it was drawn.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub grown_m: f64,
    /// What the user states about the file.
    #[serde(default)]
    pub options: ImportOptions,
}

/// States at which other fault a fault ends.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct SetTruncation {
    /// Name of the fault.
    pub fault: String,
    /// The fault it ends at; `None`: it ends at no other fault.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub by: Option<String>,
}

/// States how far a fault reaches beyond what was drawn of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SetFaultExtent {
    /// Name of the fault.
    pub fault: String,
    /// On every side along its surface, m; 0: it ends where it was drawn.
    #[serde(default)]
    pub grown_m: f64,
}

impl AddFault {
    pub(super) fn execute(&self, draft: &mut Draft, progress: &Progress) -> Result<Effect, ProjectError> {
        draft.document.check_new_name(Noun::Fault, &self.name)?;
        if let Some(by) = &self.truncated_by {
            draft.document.position(Noun::Fault, by)?;
        }
        let geometry = draft.document.frame()?.clone();
        let name = self.options.name.clone().or_else(|| Some(self.name.clone()));
        let options = ImportOptions { name, ..self.options.clone() };
        let mut found = files::read_fault(&self.path, &geometry, &options)?;
        let (mut fault, mut report) = match found.len() {
            1 => found.remove(0),
            _ => {
                let names = found.iter().map(|(fault, _)| fault.name.clone()).collect();
                return Err(ProjectError::SeveralInFile { path: self.path.clone(), names });
            }
        };
        progress.check()?;
        fault.name.clone_from(&self.name);
        fault.truncated_by.clone_from(&self.truncated_by);
        fault.grown_m = self.grown_m;
        check_new(&fault, draft, &geometry, &mut report, progress)?;
        let hash = content::hash_fault(&fault);
        let (file, new) = draft.generation("faults", &self.name, "json")?;
        store::write_fault(&new, &fault)?;
        draft.document.faults.push(FaultEntry {
            id: Id::default(),
            name: self.name.clone(),
            truncated_by: self.truncated_by.clone(),
            grown_m: self.grown_m,
            file,
            hash,
            origin: super::imported(&self.path, super::horizon::reading(&report))?,
            colour: None,
        });
        draft.document.check_growth()?;
        report.notes.extend(rebuild_all(draft, progress)?);
        Ok(Effect::FaultAdded(Box::new(FaultAdded { triangles: fault.mesh.triangles.len(), report })))
    }
}

/// Refuses a surface that no model can hold as a fault, and says where the project has the same already.
fn check_new(
    fault: &Fault,
    draft: &Draft,
    geometry: &SurveyGeometry,
    report: &mut ImportReport,
    progress: &Progress,
) -> Result<(), ProjectError> {
    let alone = Fault { truncated_by: None, ..fault.clone() };
    FaultNetwork::build(geometry, std::slice::from_ref(&alone), progress)?;
    let mut others = Vec::new();
    for entry in &draft.document.faults {
        let other = content::read_fault(draft.root(), entry)?;
        if other.mesh == fault.mesh {
            let text = format!("it is the same surface as fault \"{}\": remove one of them", entry.name);
            report.warnings.push(Note::from(text));
        } else if fault.truncated_by.as_ref() != Some(&other.name) {
            others.push(other);
        }
    }
    let crossing = model::drawn_crossing(geometry, &alone, &others)?;
    report.warnings.extend(crossing.map(|note| Note::from(note.to_string())));
    Ok(())
}

/// The report of an added fault.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FaultAdded {
    /// Triangles of its surface.
    pub triangles: usize,
    /// What was read, assumed and left out.
    #[serde(flatten)]
    pub report: ImportReport,
}

impl SetTruncation {
    pub(super) fn execute(&self, draft: &mut Draft, progress: &Progress) -> Result<Effect, ProjectError> {
        let index = draft.document.position(Noun::Fault, &self.fault)?;
        if let Some(by) = &self.by {
            draft.document.position(Noun::Fault, by)?;
        }
        draft.document.faults[index].truncated_by.clone_from(&self.by);
        draft.document.check_truncation()?;
        let fitted = rebuild_all(draft, progress)?;
        let summary = match &self.by {
            Some(by) => format!("fault {} ends at {by}", self.fault),
            None => format!("fault {} ends at no other fault", self.fault),
        };
        Ok(Effect::changed(summary, fitted))
    }
}

impl SetFaultExtent {
    pub(super) fn execute(&self, draft: &mut Draft, progress: &Progress) -> Result<Effect, ProjectError> {
        let index = draft.document.position(Noun::Fault, &self.fault)?;
        draft.document.faults[index].grown_m = self.grown_m;
        draft.document.check_growth()?;
        let fitted = rebuild_all(draft, progress)?;
        let summary = match self.grown_m {
            0.0 => format!("fault {} ends where it was drawn", self.fault),
            grown_m => format!("fault {} reaches {grown_m} m beyond what was drawn", self.fault),
        };
        Ok(Effect::changed(summary, fitted))
    }
}
