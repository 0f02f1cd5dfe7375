//! A state of a project in the making: what a command works on.

use super::document::Document;
use super::storage;
use crate::error::ProjectError;
use std::path::{Path, PathBuf};

/// A copy of the state to change, and a place to write new data to. Dropped without being kept, it removes what was written.
#[derive(Debug)]
pub struct Draft {
    root: PathBuf,
    /// The state the command is to leave behind.
    pub document: Document,
    written: Vec<PathBuf>,
    kept: bool,
}

impl Draft {
    pub(super) fn new(root: &Path, document: Document) -> Self {
        Self { root: root.to_owned(), document, written: Vec::new(), kept: false }
    }

    /// The project's folder.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// A new place for data in `folder`: the name to put into the document, and the path to write to now.
    ///
    /// The file is named after `name` as far as file systems allow, with a number where an older generation of that name is still remembered.
    pub fn generation(&mut self, folder: &str, name: &str, extension: &str) -> (String, PathBuf) {
        let slug: String =
            name.chars().map(|c| if c.is_ascii_alphanumeric() || "-_.".contains(c) { c } else { '_' }).collect();
        let slug = slug.trim_start_matches('.');
        let slug = if slug.is_empty() { "_" } else { slug };
        let taken = |file: &str| {
            let path = self.root.join(file);
            path.exists() || self.written.contains(&path)
        };
        let mut file = format!("{folder}/{slug}.{extension}");
        let mut number = 2;
        while taken(&file) {
            file = format!("{folder}/{slug}-{number}.{extension}");
            number += 1;
        }
        let path = self.root.join(&file);
        let new = storage::new_beside(&path);
        self.written.push(path);
        (file, new)
    }

    /// Flushes the data and gives it its names.
    pub(super) fn publish(&self) -> Result<(), ProjectError> {
        for path in &self.written {
            let new = storage::new_beside(path);
            storage::sync_tree(&new)?;
            storage::rename(&new, path)?;
        }
        Ok(())
    }

    /// The state was saved: the data stays.
    pub(super) fn keep(mut self) {
        self.kept = true;
    }
}

impl Drop for Draft {
    fn drop(&mut self) {
        if !self.kept {
            for path in &self.written {
                storage::remove(&storage::new_beside(path));
                storage::remove(path);
            }
        }
    }
}
