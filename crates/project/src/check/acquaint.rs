//! The quick look through a project that is not known here, before it is changed: whether what its state names is there.

use super::objects;
use super::states::States;
use super::verify::{self, Finding};
use crate::error::ProjectError;
use crate::folder::acquaintance;
use std::path::Path;

/// Looks through a project that this user has neither created nor checked nor changed before: whether what the present
/// state names is there, and of the right kind. The data themselves are compared when they are read.
///
/// # Errors
/// [`ProjectError::Unsound`] with the first thing that is missing or not what it should be. A check of the whole project
/// tells all of it; after one, the project is known.
pub(crate) fn refuse_unless_sound(root: &Path) -> Result<(), ProjectError> {
    if acquaintance::is_known(root) {
        return Ok(());
    }
    let states = States::read(root)?;
    let mut found: Vec<(String, String)> = Vec::new();
    let mut is_unread = false;
    for object in objects::of(&states).iter().filter(|object| object.is_present) {
        let file = object.entry.file();
        match verify::is_there(root, file, object.is_folder()) {
            Ok(()) => {}
            Err(Finding::Damaged(reason)) => found.push((file.to_owned(), reason)),
            // It is told by what needs it, and looked at again the next time.
            Err(Finding::Unread(_)) => is_unread = true,
        }
    }
    match found.first() {
        None if is_unread => Ok(()),
        None => {
            acquaintance::note(root);
            Ok(())
        }
        Some((file, reason)) => Err(ProjectError::Unsound {
            path: root.to_owned(),
            count: found.len(),
            file: file.clone(),
            reason: reason.clone(),
        }),
    }
}
