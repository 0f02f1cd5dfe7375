//! A project: commands in and effects out as JSON, its data as arrays.

use crate::arrays::{array, wrong};
use crate::refusal;
use crate::volumes::{box_of, info_of, live_of};
use crate::work::{long, long_of, on, task};
use numpy::{IntoPyArray, PyArray2, PyArray3, PyArrayMethods};
use project::command::Command;
use project::document::VolumeEntry;
use project::error::Noun;
use project::pictures::load::{self, Rock};
use project::{ProjectError, content};
use pyo3::prelude::*;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;
use store::{ParameterizationWriter, StoredVolume};
use survey::{Progress, SurveyGeometry, TriangleMesh};

/// An open project.
#[pyclass(frozen)]
pub struct Project {
    project: Mutex<project::Project>,
}

/// Memory for i, j, k, layer and block of a voxel.
const VOXEL_BYTES: usize = 16;

/// Vertices in world coordinates and corners of triangles.
type Mesh<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<u32>>);
/// A sheet: fault block, grid as JSON, depths, quality.
type SheetArrays<'py> = (Option<u16>, String, Bound<'py, PyArray2<f32>>, Bound<'py, PyArray2<u8>>);
/// i, j, k, layer and block.
type Parameters<'py> = ([Bound<'py, PyArray3<f32>>; 3], [Bound<'py, PyArray3<u16>>; 2]);

fn mesh<'py>(py: Python<'py>, mesh: &TriangleMesh) -> PyResult<Mesh<'py>> {
    let places: Vec<f64> = mesh.vertices.iter().flat_map(|vertex| vertex.to_array()).collect();
    let corners: Vec<u32> = mesh.triangles.iter().flatten().copied().collect();
    Ok((
        places.into_pyarray(py).reshape([mesh.vertices.len(), 3])?,
        corners.into_pyarray(py).reshape([mesh.triangles.len(), 3])?,
    ))
}

impl Project {
    pub fn lock(&self) -> MutexGuard<'_, project::Project> {
        self.project.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn opened(&self, py: Python<'_>, name: &str) -> PyResult<StoredVolume> {
        let open = || -> Result<StoredVolume, ProjectError> {
            let project = self.lock();
            let document = project.document();
            let entry = &document.volumes[document.position(Noun::Volume, name)?];
            content::open_recorded(project.root(), entry, document.frame()?)
        };
        py.detach(open).map_err(|error| refusal::of(py, error))
    }

    fn rock(project: &project::Project, progress: &Progress) -> Result<Arc<Rock>, ProjectError> {
        load::rock(project.facts(), progress)?.ok_or(ProjectError::NoLayers)
    }
}

#[pymethods]
impl Project {
    /// Opens a project; changes wait for `wait` seconds while another process is changing it.
    #[staticmethod]
    #[pyo3(signature = (path, wait=10.0))]
    fn open(py: Python<'_>, path: PathBuf, wait: f64) -> PyResult<Self> {
        let wait = Duration::try_from_secs_f64(wait).map_err(wrong)?;
        let opened = py.detach(|| project::Project::open(&path));
        let project = opened.map_err(|error| refusal::of(py, error))?.waiting(wait);
        Ok(Self { project: Mutex::new(project) })
    }

    /// Creates a project, with a survey geometry as JSON or without, and applies commands to it before it appears.
    #[staticmethod]
    #[pyo3(signature = (path, geometry=None, commands=Vec::new(), memory=None, moved=false, progress=None))]
    fn create(
        py: Python<'_>,
        path: PathBuf,
        geometry: Option<&str>,
        commands: Vec<String>,
        memory: Option<u64>,
        moved: bool,
        progress: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let geometry: Option<SurveyGeometry> = geometry.map(serde_json::from_str).transpose().map_err(wrong)?;
        if let Some(geometry) = &geometry {
            geometry.validate().map_err(|error| refusal::of(py, error))?;
        }
        let commands: Vec<Command> =
            commands.iter().map(|json| command(json, memory, moved)).collect::<PyResult<_>>()?;
        let project = long_of(py, progress.as_ref(), |progress| -> Result<_, ProjectError> {
            let mut new = project::Project::create(&path, geometry)?;
            for command in &commands {
                new.project().apply(command, progress)?;
            }
            new.publish()
        })?;
        Ok(Self { project: Mutex::new(project) })
    }

    /// The folder.
    #[getter]
    fn root(&self) -> PathBuf {
        self.lock().root().to_owned()
    }

    /// The state, as JSON: what `project.toml` says.
    fn document(&self) -> PyResult<String> {
        serde_json::to_string(self.lock().document()).map_err(wrong)
    }

    /// Where everything came from, by kind and name, as JSON.
    fn origins(&self) -> String {
        self.lock().document().origins().to_string()
    }

    /// The survey geometry, as JSON.
    fn geometry(&self, py: Python<'_>) -> PyResult<String> {
        let geometry = self.lock().document().frame().cloned().map_err(|error| refusal::of(py, error))?;
        serde_json::to_string(&geometry).map_err(wrong)
    }

    /// Layers between the horizons, from the top down.
    fn layers(&self) -> Vec<String> {
        self.lock().document().layers()
    }

    /// Carries out a command, given as JSON, and saves the project; what it did, as JSON and in words.
    #[pyo3(signature = (change, memory=None, moved=false, progress=None))]
    fn apply(
        &self,
        py: Python<'_>,
        change: &str,
        memory: Option<u64>,
        moved: bool,
        progress: Option<Bound<'_, PyAny>>,
    ) -> PyResult<(String, String)> {
        let change = command(change, memory, moved)?;
        let effect = long_of(py, progress.as_ref(), |progress| self.lock().apply(&change, progress))?;
        Ok((serde_json::to_string(&effect).map_err(wrong)?, effect.to_string()))
    }

    /// Reads the state again, which another process or a command of the command line may have changed.
    fn reload(&self, py: Python<'_>) -> PyResult<()> {
        py.detach(|| {
            let mut project = self.lock();
            *project = project::Project::open(project.root())?;
            Ok(())
        })
        .map_err(|error: ProjectError| refusal::of(py, error))
    }

    /// Undoes the last command; returns what was undone.
    fn undo(&self, py: Python<'_>) -> PyResult<String> {
        py.detach(|| self.lock().undo()).map_err(|error| refusal::of(py, error))
    }

    /// Redoes the command that was undone last; returns what was redone.
    fn redo(&self, py: Python<'_>) -> PyResult<String> {
        py.detach(|| self.lock().redo()).map_err(|error| refusal::of(py, error))
    }

    /// The history, as JSON, oldest first.
    fn history(&self) -> PyResult<String> {
        serde_json::to_string(&self.lock().history()).map_err(wrong)
    }

    /// The folder of a volume.
    fn volume_path(&self, py: Python<'_>, name: &str) -> PyResult<PathBuf> {
        let project = self.lock();
        let document = project.document();
        let position = document.position(Noun::Volume, name).map_err(|error| refusal::of(py, error))?;
        let entry: &VolumeEntry = &document.volumes[position];
        Ok(project.root().join(&entry.file))
    }

    /// What a volume says of itself, as JSON.
    fn volume_info(&self, py: Python<'_>, name: &str) -> PyResult<String> {
        info_of(&self.opened(py, name)?)
    }

    /// A box of a level of a volume.
    #[pyo3(signature = (name, level, start, size, progress=None))]
    fn read_box<'py>(
        &self,
        py: Python<'py>,
        name: &str,
        level: usize,
        start: [usize; 3],
        size: [usize; 3],
        progress: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        box_of(py, &self.opened(py, name)?, level, (start, size), progress)
    }

    /// The live-trace mask of a volume.
    fn read_live<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyArray2<bool>>> {
        live_of(py, &self.opened(py, name)?)
    }

    /// A horizon: its sheets, and its surface where it has any shape.
    fn horizon<'py>(&self, py: Python<'py>, name: &str) -> PyResult<(Vec<SheetArrays<'py>>, Option<Mesh<'py>>)> {
        let read = || {
            let project = self.lock();
            let document = project.document();
            let entry = &document.horizons[document.position(Noun::Horizon, name)?];
            content::read_horizon(project.root(), entry, &Progress::silent())
        };
        let horizon = py.detach(read).map_err(|error| refusal::of(py, error))?;
        let sheet = |sheet: survey::Sheet| -> PyResult<SheetArrays<'py>> {
            let grid = serde_json::to_string(&sheet.grid).map_err(wrong)?;
            let quality: Vec<u8> = sheet.quality.iter().map(|quality| *quality as u8).collect();
            let count = sheet.grid.count;
            let depth = sheet.depth.into_pyarray(py).reshape(count)?;
            Ok((sheet.block, grid, depth, quality.into_pyarray(py).reshape(count)?))
        };
        let surface = horizon.surface.as_ref().map(|surface| mesh(py, surface)).transpose()?;
        Ok((horizon.sheets.into_iter().map(sheet).collect::<PyResult<_>>()?, surface))
    }

    /// A fault: vertices in world coordinates and triangles.
    fn fault<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Mesh<'py>> {
        let read = || {
            let project = self.lock();
            let document = project.document();
            let entry = &document.faults[document.position(Noun::Fault, name)?];
            content::read_fault(project.root(), entry)
        };
        let fault = py.detach(read).map_err(|error| refusal::of(py, error))?;
        mesh(py, &fault.mesh)
    }

    /// i, j, k, layer and block, sampled on a lattice of `size` that spans the survey; of it the part from `start`, or all.
    #[pyo3(signature = (size, start, part, progress=None, threads=None))]
    fn parameterization<'py>(
        &self,
        py: Python<'py>,
        size: [usize; 3],
        start: [usize; 3],
        part: [usize; 3],
        progress: Option<Bound<'py, PyAny>>,
        threads: Option<usize>,
    ) -> PyResult<Parameters<'py>> {
        let sample = |progress: &Progress| -> Result<_, ProjectError> {
            let project = self.lock();
            let rock = Self::rock(&project, progress)?;
            system::memory::check("i, j and k for each voxel", &part, VOXEL_BYTES)?;
            Ok(rock.parameterization.voxel_box(&*rock.model, size, start, part, progress)?)
        };
        let sampled =
            long(py, progress.as_ref(), |progress| on(threads, || sample(progress).map_err(petroglyph::explain)))?;
        let (i, j, k) = (array(py, sampled.i)?, array(py, sampled.j)?, array(py, sampled.k)?);
        Ok(([i, j, k], [array(py, sampled.layer)?, array(py, sampled.block)?]))
    }

    /// Begins i, j, k, layer and block on a lattice of `size`, in the new folder `out`; the grids from which they are
    /// sampled are kept in the project, so that others find them. Returns the counts of files along each axis.
    #[pyo3(signature = (out, size, progress=None))]
    fn begin_parameterization(
        &self,
        py: Python<'_>,
        out: PathBuf,
        size: [usize; 3],
        progress: Option<Bound<'_, PyAny>>,
    ) -> PyResult<[usize; 3]> {
        let begin = |progress: &Progress| -> Result<_, ProjectError> {
            Ok(Self::rock(&self.lock(), progress)?.begin_voxels(&out, size)?.file_counts())
        };
        long(py, progress.as_ref(), |progress| begin(progress).map_err(petroglyph::explain))
    }

    /// Samples and writes a column of files of what was begun, one file after the other, on one thread.
    fn write_parameterization(&self, py: Python<'_>, out: PathBuf, column: [usize; 2]) -> PyResult<()> {
        task(py, || -> Result<_, ProjectError> {
            let progress = Progress::silent();
            let (rock, writer) = (Self::rock(&self.lock(), &progress)?, ParameterizationWriter::open(&out)?);
            let [x, y] = column;
            (0..writer.file_counts()[2]).try_for_each(|z| rock.write_voxels(&writer, [x, y, z], [1; 3], &progress))
        })
    }
}

/// Makes sure that every file of a sampled parameterization was written.
#[pyfunction]
pub(crate) fn finish_parameterization(py: Python<'_>, out: PathBuf) -> PyResult<()> {
    py.detach(|| Ok(ParameterizationWriter::open(&out)?.finish()?))
        .map_err(|error: ProjectError| refusal::of(py, error))
}

/// A command from JSON, with what is not recorded of it.
fn command(json: &str, memory: Option<u64>, moved: bool) -> PyResult<Command> {
    let mut command: Command = serde_json::from_str(json).map_err(wrong)?;
    match &mut command {
        Command::Import(change) => (change.memory_bytes, change.moved) = (memory, moved),
        Command::Attribute(change) => change.memory_bytes = memory,
        Command::Extract(change) => (change.memory_bytes, change.just_stored) = (memory, moved),
        _ => {}
    }
    Ok(command)
}
