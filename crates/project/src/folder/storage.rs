//! Files of a project on disk: where each may lie, how it is replaced, and the one place that deletes.
//!
//! A file of a project is named by its path relative to the project's folder, with `/` between the parts.
//! Data that a state refers to is exactly `KIND/NAME` ([`crate::document::data_file`]), a real file or folder
//! and not a link.
//!
//! Nothing that a saved state refers to is ever overwritten. What is being written lies in the folder `unfinished/`
//! under the same relative path, and is renamed to its place when it is complete ([`publish`], [`replace`]). What a
//! killed program leaves there was never part of a project; the next writer removes the folder. So the name of a file
//! never decides whether it is a leftover.
//!
//! [`remove`] deletes single files that the project itself made and works through a handle on the folder, which no link
//! can lead outside. Data files go through [`super::history::release`] instead, which first checks every state of the
//! history.

use crate::error::ProjectError;
use crate::folder::handle;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use system::file::FileAction;
use system::file::{create_folders, sync_folder};

/// The file of the state.
pub(crate) const STATE: &str = "project.toml";

/// Folder of incomplete data; only the holder of the project's lock writes here.
pub(crate) const UNFINISHED: &str = "unfinished";

/// Folder of computed data; it may be deleted.
pub(crate) const DERIVED: &str = "derived";

/// Folder of an incomplete import. An import that was killed leaves it, and the next one continues from it.
pub(crate) const IMPORTING: &str = "importing";

/// Refuses a project in which a link could lead outside: everything in its folder, whatever its name, must be a real folder
/// or file. Nothing but `project.toml` is read before this check has passed, and nothing is written.
///
/// # Errors
/// [`ProjectError::Link`] with a link, or a folder cannot be read.
pub(crate) fn refuse_links(root: &Path) -> Result<(), ProjectError> {
    // The folder itself may be reached through a link: whoever names it means what it points to.
    refuse_links_below(root)
}

fn refuse_links_in(path: PathBuf) -> Result<(), ProjectError> {
    let facts = match fs::symlink_metadata(&path) {
        Ok(facts) => facts,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        Err(source) => return Err(ProjectError::io(FileAction::Read, &path, source)),
    };
    if facts.is_symlink() {
        return Err(ProjectError::Link { path });
    }
    if facts.is_dir() { refuse_links_below(&path) } else { Ok(()) }
}

fn refuse_links_below(folder: &Path) -> Result<(), ProjectError> {
    let fail = |source| ProjectError::io(FileAction::Read, folder, source);
    let entries = match fs::read_dir(folder) {
        Ok(entries) => entries,
        // Another process has just removed its unfinished work.
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        Err(source) => return Err(fail(source)),
    };
    // Gathered first: a folder that is open while those below it are looked through takes a handle for each level.
    let paths: io::Result<Vec<PathBuf>> = entries.map(|entry| Ok(entry?.path())).collect();
    paths.map_err(fail)?.into_iter().try_for_each(refuse_links_in)
}

/// The path at which `file` is written until it is complete.
pub(crate) fn unfinished(root: &Path, file: &str) -> PathBuf {
    root.join(UNFINISHED).join(file)
}

/// The same path, after its folder was made.
///
/// # Errors
/// The folder cannot be made.
pub(crate) fn begin(root: &Path, file: &str) -> Result<PathBuf, ProjectError> {
    let path = unfinished(root, file);
    let folder = path.parent().unwrap_or(root);
    fs::create_dir_all(folder).map_err(|source| ProjectError::io(FileAction::Written, folder, source))?;
    Ok(path)
}

/// The path at which `file` can be read now: what the present command has written and not yet published lies in
/// `unfinished/`.
pub(crate) fn at_hand(root: &Path, file: &str) -> PathBuf {
    let (path, unfinished) = (root.join(file), unfinished(root, file));
    if !path.exists() && unfinished.exists() { unfinished } else { path }
}

/// Flushes what was written for `file` and moves it to its place.
pub(crate) fn publish(root: &Path, file: &str) -> Result<(), ProjectError> {
    let from = unfinished(root, file);
    sync_tree(&from)?;
    rename(&from, &root.join(file))
}

/// Writes `bytes` to the path where `file` waits to be published.
fn write_unfinished(root: &Path, file: &str, bytes: &[u8]) -> Result<(), ProjectError> {
    let path = begin(root, file)?;
    write_durably(&path, bytes)
}

/// The same, and what was written is there under its name after a power cut.
pub(crate) fn leave_unfinished(root: &Path, file: &str, bytes: &[u8]) -> Result<(), ProjectError> {
    write_unfinished(root, file, bytes)?;
    let path = unfinished(root, file);
    path.ancestors().skip(1).take_while(|folder| folder.starts_with(root)).try_for_each(flush_names)
}

/// Replaces `file` by `bytes`: at any moment either the old or the new content is there.
///
/// # Errors
/// It still has the old content; or, as [`ProjectError::NotFlushed`], the new one that the disk may not have yet.
pub(crate) fn replace(root: &Path, file: &str, bytes: &[u8]) -> Result<(), ProjectError> {
    write_unfinished(root, file, bytes)?;
    rename(&unfinished(root, file), &root.join(file))
}

/// Writes `bytes` to `path` and flushes them to the disk.
fn write_durably(path: &Path, bytes: &[u8]) -> Result<(), ProjectError> {
    let fail = |source| ProjectError::io(FileAction::Written, path, source);
    let mut file = File::create(path).map_err(fail)?;
    file.write_all(bytes).and_then(|()| file.sync_all()).map_err(fail)
}

/// Renames and flushes the entries of both folders.
///
/// # Errors
/// It could not be renamed; or, as [`ProjectError::NotFlushed`], it was, but may not be so after a power cut.
pub(crate) fn rename(from: &Path, to: &Path) -> Result<(), ProjectError> {
    let fail = |source| ProjectError::io(FileAction::Written, to, source);
    if let Some(parent) = to.parent() {
        create_folders(parent).map_err(fail)?;
    }
    fs::rename(from, to).map_err(fail)?;
    let folders = [to.parent(), from.parent().filter(|folder| Some(*folder) != to.parent())];
    folders.into_iter().flatten().try_for_each(flush_names)
}

/// Flushes the entries of a folder.
fn flush_names(folder: &Path) -> Result<(), ProjectError> {
    sync_folder(folder).map_err(|source| ProjectError::NotFlushed { path: folder.to_owned(), source })
}

/// Flushes a file or everything in a folder to the disk.
fn sync_tree(path: &Path) -> Result<(), ProjectError> {
    let fail = |source| ProjectError::io(FileAction::Written, path, source);
    if path.is_dir() {
        for entry in fs::read_dir(path).map_err(fail)? {
            sync_tree(&entry.map_err(fail)?.path())?;
        }
        flush_names(path)
    } else {
        File::open(path).and_then(|file| file.sync_all()).map_err(fail)
    }
}

/// Removes a file or folder of the project, if it exists: the only place where something in a project is deleted.
///
/// `file` must lie inside the project. Of a link, the link itself is removed, never its target. What cannot be removed
/// stays behind as something that no state refers to.
pub(crate) fn remove(root: &Path, file: &str) {
    let plain =
        !file.is_empty() && Path::new(file).components().all(|part| matches!(part, std::path::Component::Normal(_)));
    assert!(plain, "\"{file}\" names nothing inside a project");
    let _ = handle::remove(root, file);
}

/// Opens a file at the top of the project for reading and writing, and creates it if necessary; a link is not followed.
///
/// # Errors
/// It is a link, or cannot be opened.
pub fn open_own(root: &Path, name: &str) -> io::Result<File> {
    handle::open(root, name)
}

/// Reads a text file of the project: an ordinary file of at most [`system::file::MAX_DOCUMENT_BYTES`].
pub(crate) fn read_text(path: &Path) -> Result<String, ProjectError> {
    system::file::read_text(path, system::file::MAX_DOCUMENT_BYTES)
        .map_err(|source| ProjectError::io(FileAction::Read, path, source))
}

/// The names of a folder's entries, sorted; none if the folder does not exist.
///
/// # Errors
/// The folder cannot be read: what is in it is not known.
pub(crate) fn list(folder: &Path) -> io::Result<Vec<String>> {
    let entries = match fs::read_dir(folder) {
        Ok(entries) => entries,
        Err(error) if file_is_missing(&error) => return Ok(Vec::new()),
        Err(error) => return Err(error),
    };
    let mut found = Vec::new();
    for entry in entries {
        found.extend(entry?.file_name().into_string().ok());
    }
    found.sort();
    Ok(found)
}

fn file_is_missing(error: &io::Error) -> bool {
    matches!(error.kind(), io::ErrorKind::NotFound | io::ErrorKind::NotADirectory)
}

/// The same where nothing follows from a name that is not seen: none if the folder cannot be read.
pub(crate) fn names_in(folder: &Path) -> Vec<String> {
    list(folder).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn replacing_leaves_no_second_file() {
        let folder = tempfile::tempdir().unwrap();
        replace(folder.path(), "a.toml", b"one").unwrap();
        replace(folder.path(), "a.toml", b"two").unwrap();
        assert_eq!(read_text(&folder.path().join("a.toml")).unwrap(), "two");
        remove(folder.path(), UNFINISHED);
        assert_eq!(names_in(folder.path()), ["a.toml"]);
    }

    #[test]
    #[cfg(unix)]
    fn a_link_of_any_name_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let (root, outside) = (folder.path().join("p"), folder.path().join("outside"));
        fs::create_dir_all(root.join("fonts/of/mine")).unwrap();
        fs::create_dir_all(&outside).unwrap();
        refuse_links(&root).unwrap();
        for name in ["damaged", "project.toml.damaged", "fonts/han.otf", "fonts/of/mine/a", ".hidden", "lock"] {
            let link = root.join(name);
            std::os::unix::fs::symlink(&outside, &link).unwrap();
            assert!(matches!(refuse_links(&root), Err(ProjectError::Link { path }) if path == link), "{name}");
            fs::remove_file(&link).unwrap();
        }
        // The project itself may be named through a link.
        std::os::unix::fs::symlink(&root, folder.path().join("q")).unwrap();
        refuse_links(&folder.path().join("q")).unwrap();
    }

    #[test]
    #[cfg(unix)]
    fn removing_does_not_leave_the_project_by_a_link() {
        let folder = tempfile::tempdir().unwrap();
        let (root, outside) = (folder.path().join("p"), folder.path().join("outside"));
        fs::create_dir_all(root.join("volumes")).unwrap();
        fs::create_dir_all(outside.join("kept")).unwrap();
        fs::write(outside.join("kept/a"), "a").unwrap();
        std::os::unix::fs::symlink(&outside, root.join("textures")).unwrap();
        std::os::unix::fs::symlink(&outside, root.join("volumes/v")).unwrap();
        remove(&root, "textures/kept");
        remove(&root, "volumes/v");
        assert!(outside.join("kept/a").exists());
        assert!(fs::symlink_metadata(root.join("volumes/v")).is_err());
    }
}
