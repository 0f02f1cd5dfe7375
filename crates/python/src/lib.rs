//! The Python package's native part: `petroglyph._native`. The Python sources beside it (`python/petroglyph`) give it names,
//! types and documentation.
//!
//! | module | holds |
//! |---|---|
//! | `project` | a project: commands in and effects out as JSON, its data as arrays |
//! | `program` | the commands of the command line, carried out in this process |
//! | `bricks` | pure functions on a brick with its halo, on one thread each |
//! | `extraction` | an extraction of horizon candidates whose tasks other processes do |
//! | `volumes` | stored volumes, read by box, written from Python, or written file by file by many processes |
//! | `schema` | names of commands and of their fields, so that tests compare them with their Python twins |
//! | `arrays` | vectors become arrays without a copy |
//! | `work` | long work: Python's lock is released, signals and progress reach whoever called |
//! | `refusal` | errors with the sentence and the hint of the command line |
//!
//! Deliberately absent: any computation, and any word about an error that the command line does not say.

#![allow(clippy::needless_pass_by_value, reason = "functions of Python take their arguments by value")]

mod arrays;
mod bricks;
mod extraction;
mod program;
mod project;
mod refusal;
mod schema;
mod slabs;
mod volumes;
mod work;

use pyo3::prelude::*;

/// The module that Python imports.
#[pymodule]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("STORE_VERSION", store::VERSION)?;
    module.add_class::<project::Project>()?;
    module.add_class::<volumes::VolumeParts>()?;
    module.add_class::<extraction::Extraction>()?;
    module.add_class::<extraction::ExtractionTasks>()?;
    module.add_function(wrap_pyfunction!(program::run, module)?)?;
    module.add_function(wrap_pyfunction!(program::commands, module)?)?;
    module.add_function(wrap_pyfunction!(program::decode_png, module)?)?;
    module.add_function(wrap_pyfunction!(schema::command_fields, module)?)?;
    module.add_function(wrap_pyfunction!(extraction::extraction_stages, module)?)?;
    module.add_function(wrap_pyfunction!(volumes::volume_info, module)?)?;
    module.add_function(wrap_pyfunction!(volumes::read_box, module)?)?;
    module.add_function(wrap_pyfunction!(volumes::read_live, module)?)?;
    module.add_function(wrap_pyfunction!(project::finish_parameterization, module)?)?;
    module.add_function(wrap_pyfunction!(slabs::time_slabs, module)?)?;
    module.add_function(wrap_pyfunction!(slabs::time_slab, module)?)?;
    module.add_function(wrap_pyfunction!(slabs::join_times, module)?)?;
    module.add_function(wrap_pyfunction!(volumes::write_volume, module)?)?;
    module.add_function(wrap_pyfunction!(arrays::handed_over, module)?)?;
    module.add_function(wrap_pyfunction!(arrays::seen_at, module)?)?;
    module.add_function(wrap_pyfunction!(bricks::reach, module)?)?;
    module.add_function(wrap_pyfunction!(bricks::envelope, module)?)?;
    module.add_function(wrap_pyfunction!(bricks::semblance, module)?)?;
    module.add_function(wrap_pyfunction!(bricks::fault_likelihood, module)?)?;
    module.add_function(wrap_pyfunction!(bricks::throw, module)?)?;
    module.add_function(wrap_pyfunction!(bricks::dip, module)?)?;
    module.add_function(wrap_pyfunction!(bricks::dip_angle, module)?)?;
    module.add_function(wrap_pyfunction!(bricks::extrema, module)?)?;
    Ok(())
}
