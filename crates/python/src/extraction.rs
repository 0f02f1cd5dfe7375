//! Extraction of horizon candidates whose tasks other processes do: stages of `candidates::bricks`, then those that store
//! the result, file by file. All data are in the project's folder; a task is a name and a number.

use crate::arrays::wrong;
use crate::project::Project;
use crate::refusal;
use crate::work::{long_of, task};
use interp::bricks::{BrickSettings, Bricks, Stage};
use interp::{CandidateColumns, ExtractReport, ExtractSettings, InterpError};
use project::ProjectError;
use project::interpretation::extraction::{self, ExtractionPlan, SharedExtraction};
use pyo3::prelude::*;
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};
use store::{CandidateParts, FolderArrays, StoreError, StoredVolume};
use survey::Progress;
use survey::arrays::NamedArrays;
use survey::candidates::{CandidateInfo, ForestRows};

/// Stages after those of bricks.
const CREATE: &str = "store";
const COLUMNS: &str = "store-columns";
const LEVEL: &str = "store-level-";
const TABLES: &str = "store-tables";
const FINISH: &str = "store-end";

/// An extraction that a client has begun. While it lives, nobody else does the same.
#[pyclass(frozen)]
pub struct Extraction {
    shared: Mutex<Option<SharedExtraction>>,
}

impl Extraction {
    fn take(&self) -> PyResult<SharedExtraction> {
        let taken = self.shared.lock().unwrap_or_else(PoisonError::into_inner).take();
        taken.ok_or_else(|| wrong("the extraction has ended already"))
    }
}

#[pymethods]
impl Extraction {
    /// Begins an extraction from a volume of a project; `None` where its candidates are stored already. A process takes
    /// `memory` bytes, bricks have at most `edge` traces along both axes.
    #[staticmethod]
    #[pyo3(signature = (project, volume, settings, memory, edge, progress=None))]
    fn begin(
        py: Python<'_>,
        project: &Project,
        volume: Option<&str>,
        settings: Option<&str>,
        memory: u64,
        edge: usize,
        progress: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Option<Self>> {
        let settings: ExtractSettings =
            settings.map_or_else(|| Ok(<_>::default()), serde_json::from_str).map_err(wrong)?;
        let shared = long_of(py, progress.as_ref(), |progress| {
            let project = project.lock();
            extraction::share((project.root(), project.document()), (volume, &settings), (memory, edge), progress)
        })?;
        Ok(shared.map(|shared| Self { shared: Mutex::new(Some(shared)) }))
    }

    /// What each process needs to know, as JSON.
    fn plan(&self) -> PyResult<String> {
        let shared = self.shared.lock().unwrap_or_else(PoisonError::into_inner);
        let shared = shared.as_ref().ok_or_else(|| wrong("the extraction has ended already"))?;
        serde_json::to_string(shared.plan()).map_err(wrong)
    }

    /// Gives the complete candidates their place.
    fn publish(&self, py: Python<'_>) -> PyResult<()> {
        self.take()?.publish().map_err(|error| refusal::of(py, error))
    }

    /// Ends; what was written is left for the same extraction to go on with, or removed.
    fn end(&self, leave: bool) -> PyResult<()> {
        let shared = self.take()?;
        if leave {
            shared.leave();
        }
        Ok(())
    }
}

/// Name of each stage in the order in which they are done, and how many tasks it has where that is known beforehand.
type Stages = Vec<(String, Option<usize>)>;

/// Edge of the bricks, traces along x and y, and the stages of an extraction from the volume in the folder `path`; see
/// [`ExtractionTasks::stages`]. Nothing is begun.
#[pyfunction]
#[pyo3(signature = (path, settings, memory, edge))]
pub(crate) fn extraction_stages(
    py: Python<'_>,
    path: PathBuf,
    settings: Option<&str>,
    memory: u64,
    edge: usize,
) -> PyResult<([usize; 2], Stages)> {
    let settings: ExtractSettings = settings.map_or_else(|| Ok(<_>::default()), serde_json::from_str).map_err(wrong)?;
    let volume = StoredVolume::open(&path).map_err(|error| refusal::of(py, error))?;
    // No array is read while tasks are counted.
    let arrays = FolderArrays::shared(&path).map_err(|error| refusal::of(py, error))?;
    let size = volume.info().geometry.size();
    let cut = BrickSettings::within(memory, size, 1).map_err(|error| refusal::of(py, error))?.with_edge(edge, size);
    let plan = ExtractionPlan {
        volume: path.clone(),
        arrays: path.clone(),
        out: path,
        key: String::new(),
        settings,
        edge: cut.edge,
        triangles_together: cut.triangles_together,
        memory_bytes: memory,
    };
    let tasks = ExtractionTasks { plan, volume, arrays };
    Ok((cut.edge, tasks.stages(py)?))
}

/// The tasks of an extraction, as a process that does some of them sees them.
#[pyclass(frozen)]
pub struct ExtractionTasks {
    plan: ExtractionPlan,
    volume: StoredVolume,
    arrays: FolderArrays,
}

impl ExtractionTasks {
    fn bricks(&self) -> Result<Bricks<'_>, InterpError> {
        let ExtractionPlan { edge, triangles_together, .. } = self.plan;
        let cut = BrickSettings { edge, triangles_together, workers: 1 };
        Bricks::new(&self.volume, &self.arrays, &self.plan.settings, &cut)
    }

    /// The candidates as they are written, once surfaces and trees are there.
    fn parts(&self, forest: &impl ForestRows, leaves: usize) -> CandidateParts {
        let size = self.volume.info().geometry.size();
        CandidateParts { path: self.plan.out.clone(), size, leaves, counts: forest.counts() }
    }

    fn finish(&self, bricks: &Bricks<'_>, parts: &CandidateParts) -> Result<(), ProjectError> {
        let report = bricks.report()?;
        let info = CandidateInfo {
            key: self.plan.key.clone(),
            size: parts.size,
            max_distance: self.plan.settings.distance.max_distance,
            leaves: report.leaves,
            report: ExtractReport { seconds: None, ..report },
        };
        Ok(parts.finish(&info)?)
    }

    /// Does a task of a stage that stores the result, unless it is noted as done.
    fn store(&self, bricks: &Bricks<'_>, stage: &str, number: usize) -> Result<(), ProjectError> {
        let done = format!("done-{stage}");
        if self.arrays.is_whole(&done, number) {
            return Ok(());
        }
        let forest = bricks.forest()?;
        let parts = self.parts(&forest, forest.leaf_count());
        match stage {
            CREATE => parts.create()?,
            COLUMNS => {
                let CandidateColumns { x, y, distance, leaf } = bricks.column(number)?;
                parts.write_column([x, y], &distance, &leaf)?;
            }
            TABLES => parts.write_rows(number, &forest)?,
            FINISH => self.finish(bricks, &parts)?,
            _ => parts.halve(level_of(stage).unwrap_or_default(), number)?,
        }
        self.arrays.write(&done, number, &[]).map_err(|source| InterpError::Arrays(source).into())
    }
}

/// The level that a stage makes.
fn level_of(stage: &str) -> Option<usize> {
    stage.strip_prefix(LEVEL)?.parse().ok()
}

fn named(bricks: &Bricks<'_>, stage: &str) -> Option<Stage> {
    bricks.stages().into_iter().find(|known| known.name() == stage)
}

#[pymethods]
impl ExtractionTasks {
    /// Opens what the client has begun.
    #[new]
    fn new(py: Python<'_>, plan: &str) -> PyResult<Self> {
        let plan: ExtractionPlan = serde_json::from_str(plan).map_err(wrong)?;
        let open = || -> Result<_, StoreError> {
            Ok((StoredVolume::open(&plan.volume)?, FolderArrays::shared(&plan.arrays)?))
        };
        let (volume, arrays) = py.detach(open).map_err(|error| refusal::of(py, error))?;
        Ok(Self { plan, volume, arrays })
    }

    /// All stages in their order, and the count of their tasks; `None` where it is known only once those before are done.
    fn stages(&self, py: Python<'_>) -> PyResult<Stages> {
        let bricks = self.bricks().map_err(|error| refusal::of(py, error))?;
        let mut stages = Vec::new();
        for stage in bricks.stages() {
            let count = if stage.is_counted() { bricks.tasks(stage).map(Some) } else { Ok(None) };
            stages.push((stage.name().to_owned(), count.map_err(|error| refusal::of(py, error))?));
        }
        let size = self.volume.info().geometry.size();
        let parts = CandidateParts { path: self.plan.out.clone(), size, leaves: 0, counts: <_>::default() };
        stages.push((CREATE.to_owned(), Some(1)));
        stages.push((COLUMNS.to_owned(), Some(bricks.column_count())));
        stages.extend((1..parts.level_count()).map(|level| (format!("{LEVEL}{level}"), Some(parts.file_count(level)))));
        stages.push((TABLES.to_owned(), None));
        stages.push((FINISH.to_owned(), Some(1)));
        Ok(stages)
    }

    /// Count of tasks of a stage, once those before are done.
    fn count(&self, py: Python<'_>, stage: &str) -> PyResult<usize> {
        let count = || -> Result<usize, ProjectError> {
            let bricks = self.bricks()?;
            if let Some(stage) = named(&bricks, stage) {
                return Ok(bricks.tasks(stage)?);
            }
            let forest = bricks.forest()?;
            let parts = self.parts(&forest, forest.leaf_count());
            Ok(match stage {
                CREATE | FINISH => 1,
                COLUMNS => bricks.column_count(),
                TABLES => parts.table_files(),
                _ => level_of(stage).map_or(0, |level| parts.file_count(level)),
            })
        };
        py.detach(count).map_err(|error| refusal::of(py, error))
    }

    /// Does a task of a stage, unless it is done.
    fn run(&self, py: Python<'_>, stage: &str, number: usize) -> PyResult<()> {
        task(py, || -> Result<(), ProjectError> {
            system::memory::share_freed_memory(rayon::current_num_threads(), self.plan.memory_bytes / 2);
            let bricks = self.bricks()?;
            match named(&bricks, stage) {
                Some(stage) => Ok(bricks.do_task(stage, number, &Progress::silent())?),
                None => self.store(&bricks, stage, number),
            }
        })
    }

    /// Notes that a stage is done, and removes what no later one reads.
    fn close(&self, py: Python<'_>, stage: &str) -> PyResult<()> {
        task(py, || {
            let bricks = self.bricks()?;
            named(&bricks, stage).map_or(Ok(()), |stage| bricks.close_stage(stage))
        })
    }
}
