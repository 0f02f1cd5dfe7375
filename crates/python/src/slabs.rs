//! Geologic time in slabs: each is solved on its own, on one thread, and joined to the one before it.

use crate::arrays::{array, slice, volume, wrong};
use crate::project::Project;
use crate::work::task;
use numpy::{IntoPyArray, PyArray3, PyArrayMethods, PyReadonlyArray3, PyUntypedArrayMethods};
use project::ProjectError;
use project::command::TimeSlabs;
use pyo3::prelude::*;
use survey::Progress;
use time::JoinedSlabs;

type Array3<'py> = Bound<'py, PyArray3<f32>>;
/// A volume, facts as JSON, and ranges of inlines.
type Told = (String, String, Vec<(usize, usize)>);

fn open(project: &Project, memory: u64, settings: &str) -> Result<TimeSlabs, ProjectError> {
    let settings = serde_json::from_str(settings).unwrap_or_default();
    let project = project.lock();
    TimeSlabs::open(project.root(), project.document(), &settings, memory, &Progress::silent())
}

/// The volume that geologic time is solved from, what its own volume says of itself, as JSON, and the first inline of each
/// slab and the one after its last.
#[pyfunction]
pub(crate) fn time_slabs(py: Python<'_>, project: &Project, memory: u64, settings: &str) -> PyResult<Told> {
    serde_json::from_str::<time::TimeSettings>(settings).map_err(wrong)?;
    let slabs = task(py, || open(project, memory, settings))?;
    let info = serde_json::to_string(&slabs.info()).map_err(wrong)?;
    let ranges = slabs.ranges().iter().map(|range| (range.start, range.end));
    Ok((slabs.from.name.clone(), info, ranges.collect()))
}

/// τ of a slab by its own clock, and the number of faults that were found in it.
#[pyfunction]
pub(crate) fn time_slab<'py>(
    py: Python<'py>,
    project: &Project,
    memory: u64,
    settings: &str,
    slab: usize,
) -> PyResult<(Array3<'py>, usize)> {
    let (tau, found) = task(py, || open(project, memory, settings)?.solve(slab, &Progress::silent()))?;
    Ok((array(py, tau)?, found))
}

/// Joins τ of a slab to the one before it, of which `common` are the last lines as they were joined: the lines that are
/// done, and those that the next slab has too.
#[pyfunction]
#[pyo3(signature = (common, tau, is_last))]
pub(crate) fn join_times<'py>(
    py: Python<'py>,
    common: Option<PyReadonlyArray3<'py, f32>>,
    tau: PyReadonlyArray3<'py, f32>,
    is_last: bool,
) -> PyResult<[Array3<'py>; 2]> {
    let [_, ny, nz] = [tau.shape()[0], tau.shape()[1], tau.shape()[2]];
    let mut joined = match &common {
        Some(common) => JoinedSlabs::after(slice(common)?.to_vec()),
        None => JoinedSlabs::default(),
    };
    let tau = volume(&tau, None)?;
    let lines = py.detach(|| joined.add(&tau, is_last));
    let shaped = |values: Vec<f32>| {
        let count = values.len() / (ny * nz).max(1);
        values.into_pyarray(py).reshape([count, ny, nz])
    };
    Ok([shaped(lines)?, shaped(joined.common().to_vec())?])
}
