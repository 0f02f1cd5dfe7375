//! Stored volumes: read by box, written from Python block by block, or written file by file by many processes.

use crate::arrays::{array, mask, slice, wrong};
use crate::refusal;
use crate::work::{long_of, task};
use numpy::{IntoPyArray, PyArray2, PyArrayMethods, PyReadonlyArray2, PyReadonlyArray3};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use std::borrow::Cow;
use std::path::{Path, PathBuf};
use store::{IndexedRanges, StoreError, StoredSample, StoredVolume, VolumeInfo};
use survey::Progress;
use survey::sample::{Sample, SampleType, SamplesMut};
use survey::source::{Block, BlockSource, SourceError};

/// The type of that name.
fn type_named(name: &str) -> PyResult<SampleType> {
    SampleType::named(name).ok_or_else(|| {
        PyTypeError::new_err(format!(
            "samples of {name} cannot be stored; expected {}",
            SampleType::ALL.map(SampleType::name).join(", ")
        ))
    })
}

/// What a stored volume says of itself, as JSON: geometry, quantity, unit, polarity, source, the samples' type, the sizes of
/// its levels.
#[pyfunction]
pub(crate) fn volume_info(py: Python<'_>, path: PathBuf) -> PyResult<String> {
    let stored = StoredVolume::open(&path).map_err(|error| refusal::of(py, error))?;
    info_of(&stored)
}

/// The same of an open one.
pub(crate) fn info_of(stored: &StoredVolume) -> PyResult<String> {
    let sizes: Vec<[usize; 3]> = (0..stored.level_count()).map(|level| stored.size(level)).collect();
    let object = serde_json::json!({
        "info": stored.info(),
        "dtype": stored.type_name(),
        "levels": sizes,
        "live_traces": stored.live().iter().filter(|live| **live).count(),
    });
    Ok(object.to_string())
}

/// A box of a level of a stored volume.
#[pyfunction]
#[pyo3(signature = (path, level, start, size, progress=None))]
pub(crate) fn read_box<'py>(
    py: Python<'py>,
    path: PathBuf,
    level: usize,
    start: [usize; 3],
    size: [usize; 3],
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let stored = StoredVolume::open(&path).map_err(|error| refusal::of(py, error))?;
    box_of(py, &stored, level, (start, size), progress)
}

/// The same of an open one.
pub(crate) fn box_of<'py>(
    py: Python<'py>,
    stored: &StoredVolume,
    level: usize,
    (start, size): ([usize; 3], [usize; 3]),
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    macro_rules! of {
        ($type:ty) => {{
            let read = long_of(py, progress.as_ref(), |_| stored.read_box::<$type>(level, start, size))?;
            array(py, read)?.into_any()
        }};
    }
    Ok(match stored.type_name().as_str() {
        "int8" => of!(i8),
        "uint8" => of!(u8),
        "int16" => of!(i16),
        "uint16" => of!(u16),
        "int32" => of!(i32),
        "uint32" => of!(u32),
        _ => of!(f32),
    })
}

/// The live-trace mask, one value a trace, `[inline][crossline]`.
#[pyfunction]
pub(crate) fn read_live(py: Python<'_>, path: PathBuf) -> PyResult<Bound<'_, PyArray2<bool>>> {
    live_of(py, &StoredVolume::open(&path).map_err(|error| refusal::of(py, error))?)
}

/// The same of an open one.
pub(crate) fn live_of<'py>(py: Python<'py>, stored: &StoredVolume) -> PyResult<Bound<'py, PyArray2<bool>>> {
    let [nx, ny, _] = stored.size(0);
    stored.live().to_vec().into_pyarray(py).reshape([nx, ny])
}

/// A volume whose blocks Python supplies.
struct Supplied {
    size: [usize; 3],
    live: Option<Vec<bool>>,
    sample_type: SampleType,
    /// `read(inline range, crossline range)` gives an array of the block.
    read: Py<PyAny>,
}

impl Supplied {
    fn fill<T: StoredSample + Sample + numpy::Element>(&self, block: &Block, out: &mut [T]) -> Result<(), SourceError> {
        Python::attach(|py| {
            let (x, y) = (&block.inlines, &block.crosslines);
            let given = self.read.bind(py).call1((x.start, x.end, y.start, y.end))?;
            let given: PyReadonlyArray3<'_, T> =
                given.extract().map_err(|_| wrong(format!("a block is no array of {} with three axes", T::NAME)))?;
            let values = slice(&given)?;
            if values.len() != out.len() {
                return Err(wrong(format!("a block has {} samples where {} are needed", values.len(), out.len())));
            }
            out.copy_from_slice(values);
            Ok(())
        })
        .map_err(|error: PyErr| -> SourceError { Box::new(error) })
    }
}

impl BlockSource for Supplied {
    fn size(&self) -> [usize; 3] {
        self.size
    }

    fn live(&self) -> Option<Cow<'_, [bool]>> {
        self.live.as_deref().map(Cow::Borrowed)
    }

    fn sample_type(&self) -> SampleType {
        self.sample_type
    }

    fn read_block(&mut self, block: &Block, out: SamplesMut<'_>, progress: &Progress) -> Result<(), SourceError> {
        progress.check()?;
        survey::of_any_type!(out, |samples| self.fill(block, samples))
    }
}

/// Writes a volume of which `read(x0, x1, y0, y1)` gives the samples of a block of traces. Nothing is at `path` unless all
/// is.
#[pyfunction]
#[pyo3(signature = (path, info, dtype, read, live=None, memory=None, progress=None))]
#[expect(clippy::too_many_arguments, reason = "named by Python's caller")]
pub(crate) fn write_volume(
    py: Python<'_>,
    path: PathBuf,
    info: &str,
    dtype: &str,
    read: Py<PyAny>,
    live: Option<PyReadonlyArray2<'_, bool>>,
    memory: Option<u64>,
    progress: Option<Bound<'_, PyAny>>,
) -> PyResult<()> {
    let info: VolumeInfo = serde_json::from_str(info).map_err(wrong)?;
    info.geometry.validate().map_err(|error| refusal::of(py, error))?;
    let size = info.geometry.size();
    let mut source = Supplied { size, live: mask(live), sample_type: type_named(dtype)?, read };
    let memory = memory.unwrap_or(store::MEMORY_BYTES);
    let mut raised = None;
    let written = long_of(py, progress.as_ref(), |progress| {
        store::write_blocks(&path, &mut source, &info, memory, progress).map(|_| ()).map_err(|error| match error {
            StoreError::Source { path, source } => match source.downcast::<PyErr>() {
                Ok(own) => {
                    raised = Some(*own);
                    StoreError::Cancelled(survey::Cancelled)
                }
                Err(source) => StoreError::Source { path, source },
            },
            other => other,
        })
    });
    // What Python's own function raised is raised again.
    raised.map_or(written, Err)
}

/// A volume that is written file by file by many processes.
#[pyclass(frozen)]
pub struct VolumeParts {
    parts: store::VolumeParts,
}

#[pymethods]
impl VolumeParts {
    /// Begins a volume in a new folder.
    #[staticmethod]
    #[pyo3(signature = (path, info, dtype, live=None))]
    fn create(
        py: Python<'_>,
        path: PathBuf,
        info: &str,
        dtype: &str,
        live: Option<PyReadonlyArray2<'_, bool>>,
    ) -> PyResult<Self> {
        let info: VolumeInfo = serde_json::from_str(info).map_err(wrong)?;
        let (live, sample_type) = (mask(live), type_named(dtype)?);
        let made = store::VolumeParts::create(&path, &info, live.as_deref(), sample_type);
        made.map(|parts| Self { parts }).map_err(|error| refusal::of(py, error))
    }

    /// Opens a volume that another process has begun.
    #[staticmethod]
    fn open(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        open(py, &path)
    }

    /// Levels, the full volume included.
    fn level_count(&self) -> usize {
        self.parts.level_count()
    }

    /// Every file of a level: its place, its first voxel, its voxels.
    fn files(&self, level: usize) -> Vec<([usize; 3], [usize; 3], [usize; 3])> {
        self.parts.files(level)
    }

    /// Writes a file of level 0; returns the ranges of its bricks.
    fn write(&self, py: Python<'_>, place: [usize; 3], samples: Bound<'_, PyAny>) -> PyResult<IndexedRanges> {
        macro_rules! of {
            ($type:ty) => {{
                let given: PyReadonlyArray3<'_, $type> = samples.extract().map_err(|_| self.other_type())?;
                let values = slice(&given)?;
                task(py, || self.parts.write::<$type>(place, values))
            }};
        }
        match self.parts.sample_type() {
            SampleType::Int8 => of!(i8),
            SampleType::Uint8 => of!(u8),
            SampleType::Int16 => of!(i16),
            SampleType::Uint16 => of!(u16),
            SampleType::Int32 => of!(i32),
            SampleType::Uint32 => of!(u32),
            SampleType::Float32 => of!(f32),
        }
    }

    /// Makes a file of a further level; returns the ranges of its bricks.
    fn halve(&self, py: Python<'_>, level: usize, place: [usize; 3]) -> PyResult<IndexedRanges> {
        task(py, || self.parts.halve(level, place))
    }

    /// Completes the volume, whose bricks have these ranges, level by level.
    fn finish(&self, py: Python<'_>, ranges: Vec<IndexedRanges>) -> PyResult<()> {
        let path = self.parts.path().to_owned();
        task(py, move || store::VolumeParts::open(&path)?.finish(ranges))
    }
}

impl VolumeParts {
    fn other_type(&self) -> PyErr {
        PyTypeError::new_err(format!("expected an array of {} with three axes", self.parts.sample_type().name()))
    }
}

fn open(py: Python<'_>, path: &Path) -> PyResult<VolumeParts> {
    store::VolumeParts::open(path).map(|parts| VolumeParts { parts }).map_err(|error| refusal::of(py, error))
}
