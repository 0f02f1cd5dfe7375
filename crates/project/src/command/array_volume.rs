//! Importing a volume that is a NumPy array, on the lattice of the project, since an array has no places.

use super::import::{ImportVolume, VolumeImported, cancelled_within};
use super::{Effect, ProjectError};
use crate::content::volume_facts::{self, Facts};
use crate::folder::Draft;
use crate::memory_budget;
use files::NpyVolume;
use store::{StoreError, VolumeInfo, write_blocks};
use survey::source::BlockSource;
use survey::{Cancelled, Progress};

/// Takes the array in.
pub(super) fn execute(
    change: &ImportVolume,
    name: String,
    draft: &mut Draft,
    progress: &Progress,
) -> Result<Effect, ProjectError> {
    let mut array = NpyVolume::open(&change.path)?;
    let frame = draft.document.geometry.clone();
    array.check_lattice(frame.as_ref().map(survey::SurveyGeometry::size))?;
    // The check has refused a project without a lattice.
    let Some(frame) = frame else { return Ok(Effect::Changed { summary: "nothing".to_owned() }) };
    array.find_dead(progress).map_err(|source| match source.downcast::<Cancelled>() {
        Ok(cancelled) => ProjectError::Cancelled(*cancelled),
        Err(source) => StoreError::Source { path: change.path.clone(), source }.into(),
    })?;
    let (stored_as, new) = draft.generation("volumes", &name, "zarr")?;
    let info = VolumeInfo {
        polarity: Some(change.polarity.to_string()),
        source: Some(change.path.display().to_string()),
        ..VolumeInfo::of(frame)
    };
    let memory_bytes = change.memory_bytes.unwrap_or_else(memory_budget::half_of_available);
    write_blocks(&new, &mut array, &info, memory_bytes, progress).map_err(cancelled_within)?;
    if array.non_finite() > 0 {
        let count = array.non_finite();
        progress.warn(format!("{count} samples are not numbers (NaN or infinite): no data"));
    }
    let size = array.size();
    let traces = array.live().map_or(size[0] * size[1], |live| live.iter().filter(|live| **live).count());
    let facts = Facts {
        name: name.clone(),
        file: stored_as,
        polarity: change.polarity,
        origin: super::imported(&change.path, array.reading())?,
        geometry: None,
    };
    let entry = volume_facts::entry(&new, facts, progress)?;
    let clip = entry.clip;
    draft.document.volumes.push(entry);
    Ok(Effect::VolumeImported(VolumeImported {
        volume: name,
        size,
        traces,
        missing_traces: size[0] * size[1] - traces,
        sample_type: array.sample_type().name().to_owned(),
        kept_files: 0,
        polarity: change.polarity,
        clip,
        evidence: Vec::new(),
        assumptions: vec!["the array lies on the project's lattice: it states no places".to_owned().into()],
    }))
}

#[cfg(test)]
mod tests {
    use crate::command::{Command, ImportVolume};
    use crate::{Project, content};
    use survey::{Progress, SurveyGeometry, VerticalUnit};

    #[test]
    fn an_array_is_a_volume_on_the_lattice_of_the_project() {
        let folder = tempfile::tempdir().unwrap();
        let quiet = Progress::silent();
        let size = [3, 4, 5];
        let values: Vec<i16> = (0..60).map(|n| n * 7 % 31 - 15).collect();
        let head = "{'descr': '<i2', 'fortran_order': False, 'shape': (3, 4, 5), }\n";
        let data = values.iter().flat_map(|v| v.to_le_bytes());
        let start = [b"\x93NUMPY\x01\0", &(head.len() as u16).to_le_bytes()[..], head.as_bytes()].concat();
        let path = folder.path().join("a.npy");
        std::fs::write(&path, start.into_iter().chain(data).collect::<Vec<u8>>()).unwrap();
        let import = Command::Import(ImportVolume {
            path,
            name: Some("seismic".to_owned()),
            polarity: crate::document::Polarity::Normal,
            options: files::segy::SegyOptions::default(),
            memory_bytes: None,
            moved: false,
            origin: None,
        });
        let mut bare = Project::create(&folder.path().join("bare.petro"), None).unwrap().publish().unwrap();
        assert!(bare.apply(&import, &quiet).unwrap_err().to_string().contains("no lattice"));
        let geometry = SurveyGeometry::regular(size, 25.0, 4.0, VerticalUnit::Milliseconds);
        let mut project =
            Project::create(&folder.path().join("a.petro"), Some(geometry.clone())).unwrap().publish().unwrap();
        project.apply(&import, &quiet).unwrap();
        let entry = &project.document().volumes[0];
        let stored = content::open_recorded(project.root(), entry, &geometry).unwrap();
        assert_eq!(stored.read::<i16>(0, &quiet).unwrap().samples(), values);
    }
}
