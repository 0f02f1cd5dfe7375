//! What lies in a folder, in memory: taken down between two calls of the program, compared, and written out again.

use super::empty_folder;
use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsStr;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, SystemTime};
use tempfile::TempDir;

/// The bytes of a file; the same bytes are kept once.
pub(super) type Content = Arc<Vec<u8>>;

/// Files by their paths below a folder.
pub(super) type Files = BTreeMap<PathBuf, Content>;

/// Every file and every folder below a folder; folders have no content.
#[derive(Debug, Clone, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Tree(BTreeMap<PathBuf, Option<Content>>);

impl Tree {
    /// What lies in a folder now. Files that are as in `known` share their content with it.
    pub(super) fn of(folder: &Path, known: &Self) -> Self {
        let mut found = Self::default();
        found.add(folder, Path::new(""), known);
        found
    }

    fn add(&mut self, folder: &Path, below: &Path, known: &Self) {
        for entry in fs::read_dir(folder.join(below)).expect("a folder") {
            let entry = entry.expect("an entry");
            let path = below.join(entry.file_name());
            if entry.file_type().expect("a kind").is_dir() {
                self.0.insert(path.clone(), None);
                self.add(folder, &path, known);
                continue;
            }
            let content = fs::read(entry.path()).expect("a file");
            let same = known.0.get(&path).and_then(Option::as_ref).filter(|known| ***known == content);
            self.0.insert(path, Some(same.cloned().unwrap_or_else(|| Arc::new(content))));
        }
    }

    /// Puts a file or folder at a path.
    pub(super) fn insert(&mut self, path: PathBuf, content: Option<Content>) {
        self.0.insert(path, content);
    }

    /// The same in a folder of its own. Every file has the same time, so that a source is the same one in each copy.
    pub(super) fn written(&self) -> TempDir {
        let folder = empty_folder();
        let time = SystemTime::UNIX_EPOCH + Duration::from_secs(1_000_000_000);
        // A folder comes before what lies in it.
        for (path, content) in &self.0 {
            let path = folder.path().join(path);
            match content {
                None => fs::create_dir(path).expect("a folder"),
                Some(content) => {
                    fs::write(&path, content.as_slice()).expect("a file");
                    File::options().write(true).open(&path).and_then(|file| file.set_modified(time)).expect("a time");
                }
            }
        }
        folder
    }

    /// What lies below a path; nothing where it does not exist.
    pub(super) fn below(&self, folder: &str) -> Option<Self> {
        let inside = |(path, content): (&PathBuf, &Option<Content>)| {
            let below = path.strip_prefix(folder).ok().filter(|below| *below != Path::new(""))?;
            Some((below.to_owned(), content.clone()))
        };
        self.0.contains_key(Path::new(folder)).then(|| Self(self.0.iter().filter_map(inside).collect()))
    }

    /// The same without locks, which tell nothing of what was lost.
    pub(super) fn without_locks(&self) -> Self {
        let is_lock = |path: &PathBuf| path.file_name() == Some(OsStr::new("lock"));
        let rest = self.0.iter().filter(|(path, _)| !is_lock(path));
        Self(rest.map(|(path, content)| (path.clone(), content.clone())).collect())
    }

    /// The files that are not left out.
    pub(super) fn files(&self, is_left_out: impl Fn(&Path) -> bool) -> Files {
        let file = |(path, content): (&PathBuf, &Option<Content>)| {
            let content = content.clone().filter(|_| path.file_name() != Some(OsStr::new("lock")))?;
            (!is_left_out(path)).then(|| (path.clone(), content))
        };
        self.0.iter().filter_map(file).collect()
    }
}

/// What a killed writer left: beside its target as `.NAME.partial-PROCESS-COUNT` or `NAME.PROCESS.part`, and in
/// `derived/unfinished`, which the next writer there removes.
pub(super) fn is_beside(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let is_derived = path.ancestors().any(|folder| folder.ends_with("derived/unfinished"));
    is_derived || name.ends_with(".part") || name.starts_with('.') && name.contains(".partial-")
}

/// Where two folders differ, for the message of a failed test.
pub(super) fn difference(found: &Files, wanted: &Files) -> Vec<String> {
    let names = found.keys().chain(wanted.keys()).collect::<BTreeSet<_>>();
    let word = |path: &PathBuf| match (found.get(path), wanted.get(path)) {
        (Some(a), Some(b)) if a == b => None,
        (Some(a), Some(b)) => Some(format!("{} has {} bytes, not {}", path.display(), a.len(), b.len())),
        (Some(_), None) => Some(format!("{} is new", path.display())),
        _ => Some(format!("{} is missing", path.display())),
    };
    names.into_iter().filter_map(word).collect()
}
