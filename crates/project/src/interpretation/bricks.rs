//! The extraction of candidates in bricks: spilled to `derived/unfinished/bricks-KEY`, gone on with after a kill, and
//! stored as an extraction in one piece is.

use crate::derived::{RESUMABLE, Scratch, abandoned};
use crate::error::ProjectError;
use interp::bricks::{BrickSettings, Bricks};
use interp::{CandidateColumns, ExtractReport, ExtractSettings, InterpError, StageSeconds};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use std::time::Instant;
use store::{CandidateWriter, FolderArrays, StoredVolume};
use survey::Progress;
use survey::candidates::CandidateInfo;

/// Bytes that the program takes beside the work on bricks.
const PROGRAM_BYTES: u64 = 24 << 20;

/// Bytes of the disk that what is spilled and the result take at most for each sample (measured), and where spilled arrays
/// are packed.
const BYTES_ON_DISK: [u64; 2] = [11, 9];

/// An extraction that is done in bricks.
pub(super) struct BrickedExtraction<'a> {
    pub(super) root: &'a Path,
    pub(super) key: &'a str,
    /// Name of the result in `derived/`.
    pub(super) file: &'a str,
    pub(super) source: &'a StoredVolume,
    pub(super) settings: &'a ExtractSettings,
}

impl BrickedExtraction<'_> {
    /// Extracts in at most so many bytes.
    pub(super) fn run(&self, memory_bytes: u64, progress: &Progress) -> Result<ExtractReport, ProjectError> {
        let size = self.source.info().geometry.size();
        let stated = memory_bytes.saturating_sub(PROGRAM_BYTES);
        let cut = BrickSettings::within(stated, size, rayon::current_num_threads())?;
        system::memory::share_freed_memory(cut.workers, stated / 2);
        let scratch = self.scratch(&cut)?;
        let done = self.extract(&scratch, &cut, progress);
        match &done {
            Ok(_) => scratch.publish(self.file)?,
            // What is there is gone on with; after any other failure, as of a full disk, it is removed.
            Err(ProjectError::Cancelled(_)) => scratch.leave(),
            Err(_) => {}
        }
        done
    }

    /// The arrays of the work, packed where the disk has no room for them otherwise.
    fn arrays(&self, scratch: &Scratch, progress: &Progress) -> Result<FolderArrays, ProjectError> {
        let folder = scratch.path("arrays");
        let samples = self.source.info().geometry.size().iter().map(|&n| n as u64).product::<u64>();
        let [plain, packed] = BYTES_ON_DISK.map(|bytes| bytes.saturating_mul(samples));
        let is_short_of = |bytes: u64| system::file::room(&folder).is_some_and(|room| room < bytes);
        if !folder.exists() && is_short_of(packed) {
            let amount =
                if packed < 10 << 30 { format!("{} MB", packed >> 20) } else { format!("{} GB", packed >> 30) };
            progress.warn(format!(
                "what is written on the way may take {amount}, and the disk has room for less; if it becomes full, make \
                 room and extract again"
            ));
        }
        // What is gone on with stays as it is.
        Ok(FolderArrays::open(&folder, is_short_of(plain))?)
    }

    /// The folder of the work.
    fn scratch(&self, cut: &BrickSettings) -> Result<Scratch, ProjectError> {
        // Arrays of other bricks are no use, so the bricks are part of the name.
        let [x, y] = cut.edge;
        let name = format!("{RESUMABLE}{}-{x}x{y}-{}", self.key, cut.triangles_together);
        Scratch::resume(self.root, &name)?.ok_or_else(|| InterpError::DoneElsewhere.into())
    }

    /// The bricks of an interrupted extraction that took as much memory.
    fn interrupted(&self, cut: &BrickSettings) -> Option<[usize; 2]> {
        let (start, end) = (format!("{RESUMABLE}{}-", self.key), format!("-{}", cut.triangles_together));
        abandoned(self.root).iter().find_map(|file| {
            let name = file.rsplit('/').next()?.strip_prefix(&start)?.strip_suffix(&end)?;
            let (x, y) = name.split_once('x')?;
            Some([x.parse().ok()?, y.parse().ok()?])
        })
    }

    /// Begins, for other processes to do the tasks; an interrupted extraction goes on with its own bricks.
    pub(super) fn share(
        &self,
        volume: &Path,
        memory_bytes: u64,
        edge: usize,
    ) -> Result<SharedExtraction, ProjectError> {
        let size = self.source.info().geometry.size();
        let mut cut = BrickSettings::within(memory_bytes, size, 1)?.with_edge(edge, size);
        cut.edge = self.interrupted(&cut).unwrap_or(cut.edge);
        let scratch = self.scratch(&cut)?;
        self.arrays(&scratch, &Progress::silent())?;
        let arrays = scratch.path("arrays");
        let plan = ExtractionPlan {
            volume: volume.to_owned(),
            arrays,
            out: scratch.path(self.file),
            key: self.key.to_owned(),
            settings: self.settings.clone(),
            edge: cut.edge,
            triangles_together: cut.triangles_together,
            memory_bytes,
        };
        Ok(SharedExtraction { scratch, plan, file: self.file.to_owned() })
    }

    fn extract(
        &self,
        scratch: &Scratch,
        cut: &BrickSettings,
        progress: &Progress,
    ) -> Result<ExtractReport, ProjectError> {
        let arrays = self.arrays(scratch, progress)?;
        let bricks = Bricks::new(self.source, &arrays, self.settings, cut)?;
        let done = bricks.done_stages();
        if done > 0 {
            let all = bricks.stages().len();
            progress.warn(format!("continued an interrupted extraction: {done} of {all} stages were complete already"));
        }
        let mut report = bricks.run(cut.workers, progress)?;
        let storing = Instant::now();
        let forest = bricks.forest()?;
        let size = self.source.info().geometry.size();
        let writer = CandidateWriter::create(&scratch.path(self.file), size, forest.leaf_count())?;
        let count = bricks.column_count();
        progress.begin("storing candidates", count as u64);
        (0..count).into_par_iter().with_max_len(1).try_for_each(|column| {
            let CandidateColumns { x, y, distance, leaf } = bricks.column(column)?;
            writer.write_column([x, y], &distance, &leaf, progress)?;
            Ok::<(), ProjectError>(progress.step(1)?)
        })?;
        let info = CandidateInfo {
            key: self.key.to_owned(),
            size,
            max_distance: self.settings.distance.max_distance,
            leaves: report.leaves,
            report: ExtractReport { seconds: None, ..report.clone() },
        };
        writer.finish_columns(&info, &forest, progress)?;
        if let Some(StageSeconds { storing: stored, total, .. }) = &mut report.seconds {
            *stored = storing.elapsed().as_secs_f64();
            *total += *stored;
        }
        Ok(report)
    }
}

/// An extraction whose tasks other processes do. While it lives, nobody else does the same or removes what they write;
/// what is neither published nor left is removed when it is dropped.
pub struct SharedExtraction {
    scratch: Scratch,
    plan: ExtractionPlan,
    file: String,
}

/// What each process knows of an extraction whose tasks it does.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct ExtractionPlan {
    /// Folder of the volume.
    pub volume: PathBuf,
    /// Folder of the arrays that stages exchange.
    pub arrays: PathBuf,
    /// Folder of the candidates.
    pub out: PathBuf,
    /// Identifies volume, settings and method.
    pub key: String,
    /// The settings.
    pub settings: ExtractSettings,
    /// Traces of a brick along x and y.
    pub edge: [usize; 2],
    /// Triangles of the surfaces whose trees one task builds.
    pub triangles_together: u64,
    /// Memory that a task takes at most.
    pub memory_bytes: u64,
}

impl SharedExtraction {
    /// What each process needs to know.
    pub fn plan(&self) -> &ExtractionPlan {
        &self.plan
    }

    /// Stores the candidates, which are complete, under their key, where the command `extract` finds them.
    ///
    /// # Errors
    /// They cannot be renamed.
    pub fn publish(self) -> Result<(), ProjectError> {
        self.scratch.publish(&self.file)
    }

    /// Leaves what was written, so that the same extraction goes on where this one was stopped.
    pub fn leave(self) {
        self.scratch.leave();
    }
}
