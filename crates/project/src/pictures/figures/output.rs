//! Files that pages are written to.

use crate::error::ProjectError;
use crate::folder;
use page::FileFormat;
use page::list::DisplayList;
use std::path::Path;

/// Writes a page, completely or not at all. `dpi` is the resolution of pixels; `title` is what readers of vector
/// formats announce.
///
/// # Errors
/// The page is too large, the file lies inside a project, or it could not be written; an earlier file is then still
/// there.
pub fn write(page: &DisplayList, format: &FileFormat, path: &Path, dpi: f64, title: &str) -> Result<(), ProjectError> {
    folder::refuse_inside_project(path)?;
    Ok(store::replace_file(path, &format.page(page, dpi, title)?)?)
}
