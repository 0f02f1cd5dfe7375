//! Errors as Python exceptions, with the sentence and the hint that the command line gives.

use petroglyph::Refusal;
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use std::error::Error;

/// The exception of a refusal: `petroglyph.PetroglyphError`, which has `reason` and `hint`.
pub(crate) fn exception(py: Python<'_>, refusal: &Refusal) -> PyErr {
    let made = py
        .import("petroglyph._errors")
        .and_then(|module| module.getattr("PetroglyphError"))
        .and_then(|class| class.call1((&refusal.reason, &refusal.hint)));
    match made {
        Ok(value) => PyErr::from_value(value),
        Err(error) => error,
    }
}

/// The same for an error of a library.
pub(crate) fn of(py: Python<'_>, error: impl Error + Send + Sync + 'static) -> PyErr {
    exception(py, &petroglyph::explain(error))
}

/// What is raised where the work was cancelled by Ctrl-C and nobody kept the signal's own exception.
pub(crate) fn interrupted() -> PyErr {
    PyKeyboardInterrupt::new_err(())
}
