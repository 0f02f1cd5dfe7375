//! The commands of the command line, carried out in this process.

use crate::arrays::wrong;
use crate::work::{long, on};
use numpy::{IntoPyArray, PyArray3, PyArrayMethods};
use pyo3::prelude::*;
use std::ffi::OsString;

/// Carries out a command of which `words` are what would be typed after `petroglyph`; the answer is the JSON of `--json`. It
/// uses `threads` threads, or as many as there are processors.
#[pyfunction]
#[pyo3(signature = (words, progress=None, threads=None))]
pub(crate) fn run(
    py: Python<'_>,
    words: Vec<OsString>,
    progress: Option<Bound<'_, PyAny>>,
    threads: Option<usize>,
) -> PyResult<String> {
    let answer = long(py, progress.as_ref(), |progress| on(threads, || petroglyph::answer(&words, progress)));
    answer.map(|answer| answer.to_string())
}

/// Every command of the program with its options, as JSON.
#[pyfunction]
pub(crate) fn commands() -> PyResult<String> {
    serde_json::to_string(&petroglyph::commands()).map_err(wrong)
}

/// The pixels of a PNG file: `[row][column][red, green, blue, alpha]`.
#[pyfunction]
pub(crate) fn decode_png<'py>(py: Python<'py>, file: &[u8]) -> PyResult<Bound<'py, PyArray3<u8>>> {
    let image = image::load_from_memory_with_format(file, image::ImageFormat::Png).map_err(wrong)?.into_rgba8();
    let (width, height) = (image.width() as usize, image.height() as usize);
    image.into_raw().into_pyarray(py).reshape([height, width, 4])
}
