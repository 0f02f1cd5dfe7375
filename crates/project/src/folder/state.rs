//! The state of a project's folder, read without changing anything.

use super::storage;
use crate::document::Document;
use crate::error::ProjectError;
use std::path::Path;

/// The text of `project.toml` in the folder `root`, and what it says.
///
/// # Errors
/// The project is missing, is not a project, contains a link, was written by a newer version, or cannot be read.
pub(crate) fn read(root: &Path) -> Result<(String, Document), ProjectError> {
    let not_a_project = |fact| Err(ProjectError::NotAProject { path: root.to_owned(), fact });
    if !root.exists() {
        return Err(ProjectError::NotFound { path: root.to_owned() });
    }
    if !root.is_dir() {
        return not_a_project("it is a file, a project is a folder");
    }
    let path = root.join(storage::STATE);
    if !path.exists() {
        return not_a_project("it has no project.toml");
    }
    storage::refuse_links(root)?;
    let text = storage::read_text(&path)?;
    let document = Document::from_text(&text, &path)?;
    Ok((text, document))
}
