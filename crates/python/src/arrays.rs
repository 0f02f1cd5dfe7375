//! Vectors become NumPy arrays by handing their memory over; arrays that come in are read where they are.

use numpy::{
    Element, IntoPyArray, PyArray3, PyArrayMethods, PyReadonlyArray2, PyReadonlyArray3, PyUntypedArrayMethods,
};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use survey::Volume;

/// A volume as an array `[inline][crossline][sample]`, in the same memory.
pub(crate) fn array<T: Element + Copy + Send + Sync>(
    py: Python<'_>,
    volume: Volume<T>,
) -> PyResult<Bound<'_, PyArray3<T>>> {
    let size = volume.size();
    volume.into_samples().into_pyarray(py).reshape(size)
}

/// A volume from an array. It is copied, since a volume owns its samples.
pub(crate) fn volume(array: &PyReadonlyArray3<'_, f32>, live: Option<Vec<bool>>) -> PyResult<Volume<f32>> {
    let shape = array.shape();
    let size = [shape[0], shape[1], shape[2]];
    let mut volume = Volume::from_samples(size, slice(array)?.to_vec()).map_err(wrong)?;
    volume.set_live(live).map_err(wrong)?;
    Ok(volume)
}

/// The samples of an array, where they are.
pub(crate) fn slice<'a, T: Element>(array: &'a PyReadonlyArray3<'_, T>) -> PyResult<&'a [T]> {
    let values = array.as_slice().ok().filter(|_| array.is_c_contiguous());
    values.ok_or_else(|| wrong("the array is not contiguous in C order; numpy.ascontiguousarray makes it so"))
}

/// One value for each trace, `[inline][crossline]`, from an array of any layout.
pub(crate) fn mask(live: Option<PyReadonlyArray2<'_, bool>>) -> Option<Vec<bool>> {
    live.map(|live| live.as_array().iter().copied().collect())
}

/// An error about an argument.
pub(crate) fn wrong(error: impl ToString) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// An array of `count` floats that Rust has made, and the address at which Rust had them: the two are the same.
#[pyfunction]
pub(crate) fn handed_over(py: Python<'_>, count: usize) -> PyResult<(Bound<'_, PyArray3<f32>>, usize)> {
    let samples = vec![1.0f32; count];
    let address = samples.as_ptr() as usize;
    let made = Volume::from_samples([1, 1, count], samples).map_err(wrong)?;
    Ok((array(py, made)?, address))
}

/// The address at which Rust reads an array of floats.
#[pyfunction]
pub(crate) fn seen_at(array: PyReadonlyArray3<'_, f32>) -> PyResult<usize> {
    Ok(slice(&array)?.as_ptr() as usize)
}
