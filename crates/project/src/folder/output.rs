//! Files that a user asks to be written: anywhere but inside a project.
//!
//! What lies in a project's folder is written by commands alone. An export to `north.petro/project.toml`
//! would replace the state.

use super::storage;
use crate::error::ProjectError;
use std::path::{Path, PathBuf};

/// Refuses to write a file inside the folder of a project, also by way of links.
///
/// # Errors
/// [`ProjectError::InsideProject`] with the project.
pub fn refuse_inside_project(path: &Path) -> Result<(), ProjectError> {
    let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    // The file itself may be a link, and so may any folder above it; what is not there yet is no link.
    let real = absolute.ancestors().find_map(|part| {
        let rest = absolute.strip_prefix(part).ok()?;
        Some(part.canonicalize().ok()?.join(rest))
    });
    for place in [Some(absolute), real].into_iter().flatten() {
        if let Some(project) = place.ancestors().skip(1).find(|folder| is_project(folder)) {
            return Err(ProjectError::InsideProject { path: path.to_owned(), project: PathBuf::from(project) });
        }
    }
    Ok(())
}

/// Whether a folder is a project's: it has a state and a history.
fn is_project(folder: &Path) -> bool {
    folder.join(storage::STATE).is_file() && folder.join("history").is_dir()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn only_what_is_outside_of_projects_may_be_written() {
        let folder = tempfile::tempdir().unwrap();
        let at = folder.path();
        fs::create_dir_all(at.join("p.petro/history")).unwrap();
        fs::create_dir_all(at.join("p.petro/derived/deep")).unwrap();
        fs::write(at.join("p.petro/project.toml"), "").unwrap();
        for inside in ["project.toml", "new.csv", "derived/deep/a.png", "not/yet/there.png", "derived/../a.png"] {
            let refused = refuse_inside_project(&at.join("p.petro").join(inside));
            assert!(matches!(refused, Err(ProjectError::InsideProject { .. })), "{inside}");
        }
        for outside in ["a.csv", "other/a.png", "p.petro.csv"] {
            refuse_inside_project(&at.join(outside)).unwrap();
        }
        #[cfg(unix)]
        for (link, target) in [("link.toml", "p.petro/project.toml"), ("folder", "p.petro/derived")] {
            std::os::unix::fs::symlink(at.join(target), at.join(link)).unwrap();
            let path = if link == "folder" { at.join("folder/a.png") } else { at.join(link) };
            assert!(refuse_inside_project(&path).is_err(), "{link}");
        }
    }
}
