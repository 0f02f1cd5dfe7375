//! A draft: the new state of a project while a command works on it.

use super::{history, storage};
use crate::document::Document;
use crate::error::ProjectError;
use crate::facts::Facts;
use std::path::{Path, PathBuf};

/// A copy of the state to change, and a place to write new data to. If it is dropped without being kept, it removes
/// what was written.
#[derive(Debug)]
pub(crate) struct Draft {
    root: PathBuf,
    /// The state that the command leaves behind.
    pub document: Document,
    written: Vec<String>,
    kept: bool,
}

impl Draft {
    pub(crate) fn new(root: &Path, document: Document) -> Self {
        Self { root: root.to_owned(), document, written: Vec::new(), kept: false }
    }

    /// The project's folder.
    pub(crate) fn root(&self) -> &Path {
        &self.root
    }

    /// What follows from the new state.
    pub(crate) fn facts(&self) -> Facts<'_> {
        Facts::of(&self.root, &self.document)
    }

    /// A new place for data of a kind (`volumes`, `horizons` …): the file name to enter in the document, and the path
    /// to write to now.
    ///
    /// The file is named after `name` as far as file systems allow, with a number where an older generation of that
    /// name is still in the history.
    ///
    /// # Errors
    /// The folder to write to cannot be made.
    pub(crate) fn generation(
        &mut self,
        kind: &'static str,
        name: &str,
        extension: &str,
    ) -> Result<(String, PathBuf), ProjectError> {
        let slug: String =
            name.chars().map(|c| if c.is_ascii_alphanumeric() || "-_.".contains(c) { c } else { '_' }).collect();
        let slug = slug.trim_start_matches('.');
        let slug = if slug.is_empty() { "_" } else { slug };
        let taken = |file: &String| self.root.join(file).exists() || self.written.contains(file);
        let numbered = (2..).map(|number| format!("{kind}/{slug}-{number}.{extension}"));
        let mut files = std::iter::once(format!("{kind}/{slug}.{extension}")).chain(numbered);
        let file = files.find(|file| !taken(file)).expect("there are more numbers than files");
        let path = storage::begin(&self.root, &file)?;
        self.written.push(file.clone());
        Ok((file, path))
    }

    /// Flushes the data and moves it to its place.
    pub(crate) fn publish(&self) -> Result<(), ProjectError> {
        self.written.iter().try_for_each(|file| storage::publish(&self.root, file))
    }

    /// The state was saved, so the data stays.
    pub(crate) fn keep(mut self) {
        self.kept = true;
    }
}

impl Drop for Draft {
    fn drop(&mut self) {
        if !self.kept {
            // Removes what was published before saving failed; if the state was saved after all, its data stays.
            let _ = history::release(&self.root, self.written.iter().cloned().collect());
        } else if history::is_incomplete(&self.root) {
            // The state was saved and its step could not be: the next writer needs what is there for that.
            return;
        }
        storage::remove(&self.root, storage::UNFINISHED);
    }
}
