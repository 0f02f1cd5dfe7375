//! Whether a data file is what was written: present, no link, with the recorded hash, and in the survey.
//!
//! What cannot be read now is not damaged: without a permission, without handles or memory, on a disk that fails, in a
//! folder whose path the store cannot write down. So damage is believed only where every file of it can be opened, and where
//! a second look, on one thread and so with few handles, finds it again.

use super::objects::{Entry, Object};
use crate::content;
use crate::document::Origin;
use crate::error::ProjectError;
use crate::placement;
use glam::DVec2;
use rayon::ThreadPoolBuilder;
use std::fs::{self, File};
use std::io;
use std::io::ErrorKind;
use std::path::Path;
use store::StoreError;
use survey::{Horizon, Progress, SurveyGeometry};
use system::file::{self, FileAction};
use ttf::TextureLibrary;

/// What a look at a file found, if it is not what was written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Finding {
    /// It is not what was written; why.
    Damaged(String),
    /// It cannot be read now; why.
    Unread(String),
}

impl Finding {
    /// A failure of the file system.
    pub(super) fn of(error: &io::Error) -> Self {
        let text = format!("it cannot be read: {error}");
        if file::says_nothing(error) { Self::Unread(text) } else { Self::Damaged(text) }
    }
}

/// What is wrong with an object; `Ok(Ok(()))` if nothing is.
///
/// # Errors
/// The user cancelled.
pub(super) fn verify(root: &Path, object: &Object, progress: &Progress) -> Result<Result<(), Finding>, ProjectError> {
    let file = object.entry.file();
    confirmed(&root.join(file), || {
        if let Err(finding) = is_there(root, file, object.is_folder()) {
            return Ok(Err(finding));
        }
        outcome(content_of(root, object, progress).and_then(|()| Ok(progress.step(1)?)))
    })
}

/// What a look at `path` finds, where damage is believed only when it is found twice.
///
/// # Errors
/// The user cancelled.
pub(super) fn confirmed(
    path: &Path,
    look: impl Fn() -> Result<Result<(), Finding>, ProjectError> + Send + Sync,
) -> Result<Result<(), Finding>, ProjectError> {
    let found = look()?;
    if !matches!(found, Err(Finding::Damaged(_))) {
        return Ok(found);
    }
    if let Err(error) = open_all(path)
        && file::says_nothing(&error)
    {
        return Ok(Err(Finding::of(&error)));
    }
    match ThreadPoolBuilder::new().num_threads(1).build() {
        Ok(pool) => pool.install(look),
        Err(_) => Ok(found),
    }
}

/// Opens every file at a path, one after the other.
fn open_all(path: &Path) -> io::Result<()> {
    let facts = fs::symlink_metadata(path)?;
    if facts.is_file() {
        return File::open(path).map(drop);
    }
    if !facts.is_dir() {
        return Ok(());
    }
    fs::read_dir(path)?.try_for_each(|entry| open_all(&entry?.path()))
}

/// Tells what was found from a check that was cancelled.
pub(super) fn outcome<T>(result: Result<T, ProjectError>) -> Result<Result<T, Finding>, ProjectError> {
    let in_full = |error: &ProjectError| {
        let cause = std::error::Error::source(error).map(|cause| format!(": {cause}")).unwrap_or_default();
        format!("{error}{cause}")
    };
    match result {
        Ok(value) => Ok(Ok(value)),
        Err(ProjectError::Cancelled(cancelled) | ProjectError::Store(StoreError::Cancelled(cancelled))) => {
            Err(cancelled.into())
        }
        Err(error) if error.says_nothing() => Ok(Err(Finding::Unread(in_full(&error)))),
        Err(ProjectError::Store(StoreError::Damaged { array, reason, .. })) => {
            Ok(Err(Finding::Damaged(format!("array \"{array}\": {reason}"))))
        }
        Err(ProjectError::Malformed { detail, .. }) => Ok(Err(Finding::Damaged(detail))),
        Err(error) => Ok(Err(Finding::Damaged(in_full(&error)))),
    }
}

/// Checks that `file` is there with nothing but real files and folders in it, and is of the right kind.
pub(super) fn is_there(root: &Path, file: &str, is_folder: bool) -> Result<(), Finding> {
    let damaged = |fact: &str| Err(Finding::Damaged(fact.to_owned()));
    let mut path = root.to_owned();
    for part in file.split('/') {
        path.push(part);
        match fs::symlink_metadata(&path) {
            Ok(facts) if facts.is_symlink() => return Err(link(root, &path)),
            Ok(_) => {}
            Err(error) if error.kind() == ErrorKind::NotFound => return damaged("it is missing"),
            Err(error) => return Err(Finding::of(&error)),
        }
    }
    if path.is_dir() != is_folder {
        return damaged(if is_folder { "it is no folder" } else { "it is no file" });
    }
    all_real(root, &path)
}

fn link(root: &Path, path: &Path) -> Finding {
    Finding::Damaged(format!("{} is a link", path.strip_prefix(root).unwrap_or(path).display()))
}

/// Checks that nothing in a folder is a link, a pipe or a device.
fn all_real(root: &Path, path: &Path) -> Result<(), Finding> {
    let unread = |error: io::Error| Finding::of(&error);
    let facts = fs::symlink_metadata(path).map_err(unread)?;
    if facts.is_symlink() {
        return Err(link(root, path));
    }
    if facts.is_dir() {
        for entry in fs::read_dir(path).map_err(unread)? {
            all_real(root, &entry.map_err(unread)?.path())?;
        }
    } else if !facts.is_file() {
        let name = path.strip_prefix(root).unwrap_or(path).display();
        return Err(Finding::Damaged(format!("{name} is a pipe or a device")));
    }
    Ok(())
}

fn content_of(root: &Path, object: &Object, progress: &Progress) -> Result<(), ProjectError> {
    let damaged = |detail: String| ProjectError::Malformed { path: root.join(object.entry.file()), detail };
    // Whatever is read through `content` is compared with its recorded hash.
    match object.entry {
        Entry::Volume(entry) => {
            let frame = object.document.frame()?;
            content::open_volume(root, entry, frame)?.verify(progress)?;
            content::open_recorded(root, entry, frame).map(drop)
        }
        Entry::Horizon(entry) => {
            let horizon = content::read_horizon(root, entry, &progress.muted())?;
            if lies_in(object.document.frame()?, nodes(&horizon)) { Ok(()) } else { Err(damaged(elsewhere())) }
        }
        Entry::Fault(entry) => {
            let fault = content::read_fault(root, entry)?;
            if placement::reaches(object.document.frame()?, &fault.mesh) { Ok(()) } else { Err(damaged(elsewhere())) }
        }
        Entry::Well(entry) => content::read_well(root, entry).map(drop),
        Entry::Parameterization(entry) => content::read_parameterization(root, entry, &progress.muted()).map(drop),
        Entry::Texture(entry) => {
            let path = root.join(&entry.file);
            TextureLibrary::builtin()?.add_user(&path)?;
            content::texture_path(root, entry)?;
            let bytes = fs::metadata(&path).map_err(|source| ProjectError::io(FileAction::Read, &path, source))?.len();
            match entry.origin {
                Origin::Imported { bytes: recorded, .. } if bytes != recorded => {
                    Err(damaged(format!("it has {bytes} bytes, and {recorded} were recorded")))
                }
                _ => Ok(()),
            }
        }
    }
}

fn elsewhere() -> String {
    "no part of it lies in the survey".to_owned()
}

/// World positions of a horizon's nodes that have a depth.
fn nodes(horizon: &Horizon) -> impl Iterator<Item = DVec2> {
    horizon.sheets.iter().flat_map(|sheet| {
        let [_, columns] = sheet.grid.count;
        let known = sheet.depth.iter().enumerate().filter(|(_, depth)| depth.is_finite());
        known.map(move |(n, _)| {
            let (u, v) = (n / columns.max(1), n % columns.max(1));
            sheet.grid.origin + sheet.grid.u_step * u as f64 + sheet.grid.v_step * v as f64
        })
    })
}

/// Whether one of the places lies over the survey or a trace beside it; also where there are no places at all.
fn lies_in(frame: &SurveyGeometry, mut places: impl Iterator<Item = DVec2>) -> bool {
    let [inlines, crosslines, _] = frame.size().map(|count| count as f64);
    let is_inside = |place: DVec2| {
        let voxel = frame.voxel_from_world(place.extend(0.0));
        (-1.0..=inlines).contains(&voxel.x) && (-1.0..=crosslines).contains(&voxel.y)
    };
    match places.next() {
        None => true,
        Some(first) => is_inside(first) || places.any(is_inside),
    }
}
