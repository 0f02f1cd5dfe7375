//! Which projects this user has created, checked or changed before, on this machine.
//!
//! A project from elsewhere is looked through once before anything in it is written
//! ([`crate::check::refuse_unless_sound`]). That this was done is noted outside of the project, where nobody who makes
//! a project can write it: in `petroglyph/known-projects` in the system's folder for the state of programs. A project
//! is known by its path and by what the system knows of its folder, so that another one in the same place, and a copy,
//! are not it. Where nothing can be noted, a project is looked through by each program that changes it.

use std::fs;
use std::path::{Path, PathBuf};
use system::file;

/// Number of projects that are noted; those noted longest ago are looked through again.
const NOTED: usize = 1000;

/// Whether the project in `root` was noted.
pub(crate) fn is_known(root: &Path) -> bool {
    match (list(), mark(root)) {
        (Some(list), Some(mark)) => noted(&list).contains(&mark),
        _ => false,
    }
}

/// Notes the project in `root`. It is no failure if that is impossible.
pub(crate) fn note(root: &Path) {
    let (Some(list), Some(mark)) = (list(), mark(root)) else { return };
    let mut marks = noted(&list);
    if marks.contains(&mark) {
        return;
    }
    marks.push(mark);
    let text = marks[marks.len().saturating_sub(NOTED)..].join("\n");
    let Some(folder) = list.parent() else { return };
    let new = folder.join(format!("known-projects.{}", std::process::id()));
    let written =
        fs::create_dir_all(folder).and_then(|()| fs::write(&new, text)).and_then(|()| fs::rename(&new, &list));
    if written.is_err() {
        let _ = fs::remove_file(new);
    }
}

/// The file of the notes, in the folder that the system names for the state of programs.
fn list() -> Option<PathBuf> {
    let folder = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    let state = folder("XDG_STATE_HOME")
        .or_else(|| folder("LOCALAPPDATA"))
        .or_else(|| folder("HOME").map(|home| home.join(".local").join("state")))?;
    Some(state.join("petroglyph").join("known-projects"))
}

fn noted(list: &Path) -> Vec<String> {
    let text = file::read_text(list, file::MAX_DOCUMENT_BYTES).unwrap_or_default();
    text.lines().map(str::to_owned).collect()
}

/// What a project is known by.
fn mark(root: &Path) -> Option<String> {
    let path = root.canonicalize().ok()?;
    let facts = fs::metadata(&path).ok()?;
    let mut hash = blake3::Hasher::new();
    hash.update(path.as_os_str().as_encoded_bytes());
    hash.update(format!("{:?}", facts.created().ok()).as_bytes());
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        hash.update(format!("{} {} {}", facts.dev(), facts.ino(), facts.uid()).as_bytes());
    }
    Some(hash.finalize().to_hex()[..32].to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn another_folder_in_the_same_place_has_another_mark() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path().join("a.petro");
        fs::create_dir(&root).unwrap();
        let first = mark(&root).unwrap();
        assert_eq!(mark(&folder.path().join(".").join("a.petro")).unwrap(), first);
        fs::rename(&root, folder.path().join("b.petro")).unwrap();
        fs::create_dir(&root).unwrap();
        assert_ne!(mark(&root).unwrap(), first);
        assert_eq!(mark(&folder.path().join("none")), None);
    }
}
