//! Importing a volume that is stored already, in the form in which projects store volumes: from another project, or
//! written by another process (the Python package, workers of a cluster).
//!
//! Its samples are read and written anew, brick by brick, and so are verified; only what was written for this project
//! alone is moved as it is. Its lattice is that of its header.

use super::import::{ImportVolume, VolumeImported, cancelled_within, own_lattice};
use super::{Effect, ProjectError};
use crate::content::volume_facts::{self, Facts};
use crate::document::Origin;
use crate::folder::Draft;
use crate::memory_budget;
use crate::placement;
use std::borrow::Cow;
use std::fs;
use std::path::PathBuf;
use store::{StoreError, StoredSample, StoredVolume, write_blocks};
use survey::Progress;
use survey::sample::{Sample, SampleType, SamplesMut};
use survey::source::{Block, BlockSource, SourceError};
use system::file::FileAction;

/// Takes the volume of the folder in.
pub(super) fn execute(
    change: &ImportVolume,
    name: String,
    draft: &mut Draft,
    progress: &Progress,
) -> Result<Effect, ProjectError> {
    let stored = StoredVolume::open(&change.path)?;
    let geometry = stored.info().geometry.clone();
    if let Some(frame) = &draft.document.geometry {
        placement::covers(frame, &geometry).map_err(|source| ProjectError::Placement { name: name.clone(), source })?;
    }
    let (size, type_name) = (stored.size(0), stored.type_name());
    let sample_type = sample_type(&stored)?;
    let traces = stored.live().iter().filter(|live| **live).count();
    let missing_traces = stored.live().len() - traces;
    let info = stored.info().clone();
    let (stored_as, new) = draft.generation("volumes", &name, "zarr")?;
    if change.moved {
        fs::rename(&change.path, &new).map_err(|source| ProjectError::io(FileAction::Written, &new, source))?;
    } else {
        let memory_bytes = change.memory_bytes.unwrap_or_else(memory_budget::half_of_available);
        let mut blocks = StoredBlocks { stored, sample_type };
        write_blocks(&new, &mut blocks, &info, memory_bytes, progress).map_err(cancelled_within)?;
    }
    let facts = Facts {
        name: name.clone(),
        file: stored_as,
        polarity: change.polarity,
        origin: change.origin.clone().unwrap_or_else(|| Origin::Imported {
            path: info.source.map_or_else(|| change.path.clone(), PathBuf::from),
            bytes: (size.iter().product::<usize>() * sample_type.bytes()) as u64,
            reading: format!("stored volume of {type_name}"),
        }),
        geometry: own_lattice(draft, geometry),
    };
    let entry = volume_facts::entry(&new, facts, progress)?;
    let clip = entry.clip;
    draft.document.volumes.push(entry);
    Ok(Effect::VolumeImported(VolumeImported {
        volume: name,
        size,
        traces,
        missing_traces,
        sample_type: type_name,
        kept_files: 0,
        polarity: change.polarity,
        clip,
        evidence: Vec::new(),
        assumptions: Vec::new(),
    }))
}

fn sample_type(stored: &StoredVolume) -> Result<SampleType, StoreError> {
    let found = stored.type_name();
    SampleType::named(&found).ok_or_else(|| StoreError::WrongType {
        path: stored.path().to_owned(),
        array: "0".to_owned(),
        expected: "numbers of up to four bytes",
        found,
    })
}

/// The blocks of a stored volume.
struct StoredBlocks {
    stored: StoredVolume,
    sample_type: SampleType,
}

impl StoredBlocks {
    fn fill<T: StoredSample + Sample>(&self, block: &Block, out: &mut [T]) -> Result<(), SourceError> {
        let start = [block.inlines.start, block.crosslines.start, 0];
        let size = [block.inlines.len(), block.crosslines.len(), self.stored.size(0)[2]];
        out.copy_from_slice(self.stored.read_box::<T>(0, start, size)?.samples());
        Ok(())
    }
}

impl BlockSource for StoredBlocks {
    fn size(&self) -> [usize; 3] {
        self.stored.size(0)
    }

    fn live(&self) -> Option<Cow<'_, [bool]>> {
        Some(Cow::Borrowed(self.stored.live()))
    }

    fn sample_type(&self) -> SampleType {
        self.sample_type
    }

    fn read_block(&mut self, block: &Block, out: SamplesMut<'_>, progress: &Progress) -> Result<(), SourceError> {
        progress.check()?;
        survey::of_any_type!(out, |samples| self.fill(block, samples))
    }
}

#[cfg(test)]
mod tests {
    use crate::command::{Command, ImportVolume};
    use crate::{Project, content};
    use store::VolumeInfo;
    use survey::{Progress, SurveyGeometry, VerticalUnit, Volume};

    #[test]
    fn a_stored_volume_is_taken_in_by_copy_and_by_move_and_gives_the_same_bytes() {
        let folder = tempfile::tempdir().unwrap();
        let quiet = Progress::silent();
        let size = [9, 70, 12];
        let mut volume = Volume::from_samples(size, (0..9 * 70 * 12).map(|n| (n % 97) as i16 - 40).collect()).unwrap();
        volume.set_live(Some((0..9 * 70).map(|n| n % 11 != 3).collect())).unwrap();
        let geometry = SurveyGeometry::regular(size, 25.0, 4.0, VerticalUnit::Milliseconds);
        let source = folder.path().join("source.zarr");
        let info = VolumeInfo { source: Some("somewhere".to_owned()), ..VolumeInfo::of(geometry.clone()) };
        store::write_volume(&source, &volume, &info, &quiet).unwrap();
        let mut project = Project::create(&folder.path().join("a.petro"), None).unwrap().publish().unwrap();
        let import = |name: &str, moved: bool| {
            Command::Import(ImportVolume {
                path: source.clone(),
                name: Some(name.to_owned()),
                polarity: crate::document::Polarity::Normal,
                options: files::segy::SegyOptions::default(),
                memory_bytes: None,
                moved,
                origin: None,
            })
        };
        project.apply(&import("copied", false), &quiet).unwrap();
        assert!(source.exists());
        project.apply(&import("moved", true), &quiet).unwrap();
        assert!(!source.exists());
        let document = project.document();
        assert_eq!(document.geometry.as_ref(), Some(&geometry));
        let [copied, moved] = [&document.volumes[0], &document.volumes[1]];
        assert_eq!((&copied.hash, copied.clip), (&moved.hash, moved.clip));
        assert_eq!(copied.origin.file(), Some(std::path::Path::new("somewhere")));
        let read = |entry| content::open_recorded(project.root(), entry, &geometry).unwrap();
        assert_eq!(read(copied).read::<i16>(0, &quiet).unwrap(), volume);
        assert_eq!(read(moved).read::<i16>(0, &quiet).unwrap(), volume);
        let error = project.apply(&import("gone", false), &quiet).unwrap_err();
        assert!(error.to_string().contains("source.zarr"), "{error}");
    }
}
