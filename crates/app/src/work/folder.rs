//! The content of folders, read on threads of their own: a folder on a network may take long.

use super::latest::Latest;
use super::spawn_quietly;
use eframe::egui::Context;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The content of a folder.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct FolderListing {
    /// The folder.
    pub folder: PathBuf,
    /// Folders in it, sorted by name, as files and projects are.
    pub folders: Vec<String>,
    /// Files in it.
    pub files: Vec<String>,
    /// Projects in it.
    pub projects: Vec<String>,
    /// Why it could not be read.
    pub error: Option<String>,
}

/// The folder that was listed last.
#[derive(Default)]
pub struct Folder {
    asked: Option<PathBuf>,
    found: Latest<Arc<FolderListing>>,
}

impl Folder {
    /// Its content, as far as it is known; another folder is listed when it is asked for.
    pub fn listing(&mut self, ctx: &Context, folder: &Path) -> Arc<FolderListing> {
        if self.asked.as_deref() != Some(folder) {
            self.asked = Some(folder.to_owned());
            let (number, found, ctx, folder) = (self.found.begin(), self.found.clone(), ctx.clone(), folder.to_owned());
            spawn_quietly("folder", move || {
                found.put(number, Arc::new(read(&folder)));
                ctx.request_repaint();
            });
        }
        self.found.with(|found| found.map(|(_, listing)| listing.clone())).unwrap_or_default()
    }

    /// Lists the folder again when it is next asked for.
    pub fn forget(&mut self) {
        self.asked = None;
    }
}

/// Which of the recent projects still exist.
#[derive(Default)]
pub(crate) struct Presence {
    asked: Vec<PathBuf>,
    found: Latest<Vec<bool>>,
}

impl Presence {
    /// Whether each of the projects exists; until that is known, they are taken to exist.
    pub(crate) fn of(&mut self, ctx: &Context, projects: &[PathBuf]) -> Vec<bool> {
        if self.asked != projects {
            self.asked = projects.to_vec();
            let (number, found, ctx) = (self.found.begin(), self.found.clone(), ctx.clone());
            let projects = self.asked.clone();
            spawn_quietly("recent projects", move || {
                found.put(number, projects.iter().map(|root| root.join("project.toml").exists()).collect());
                ctx.request_repaint();
            });
        }
        let known = self.found.with(|found| found.map(|(_, there)| there.clone()));
        known.filter(|_| self.found.is_current()).unwrap_or_else(|| vec![true; projects.len()])
    }
}

/// Lists a folder; a failure is recorded in the listing.
fn read(folder: &Path) -> FolderListing {
    let mut listing = FolderListing { folder: folder.to_owned(), ..FolderListing::default() };
    let entries = match std::fs::read_dir(if folder.as_os_str().is_empty() { Path::new(".") } else { folder }) {
        Ok(entries) => entries,
        Err(error) => {
            listing.error = Some(format!("{} cannot be listed: {error}", folder.display()));
            return listing;
        }
    };
    for entry in entries.flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        if name.starts_with('.') {
            continue;
        }
        let path = entry.path();
        match path.is_dir() {
            true if path.join("project.toml").exists() => listing.projects.push(name),
            true => listing.folders.push(name),
            false => listing.files.push(name),
        }
    }
    [&mut listing.folders, &mut listing.files, &mut listing.projects].into_iter().for_each(|names| names.sort());
    listing
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_projects_and_files_are_told_apart() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir_all(folder.path().join("a.petro")).unwrap();
        std::fs::write(folder.path().join("a.petro/project.toml"), "").unwrap();
        std::fs::create_dir(folder.path().join("deeper")).unwrap();
        for name in ["s.SGY", "h.dat", ".hidden"] {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        let listing = read(folder.path());
        assert_eq!((listing.projects, listing.folders), (vec!["a.petro".to_owned()], vec!["deeper".to_owned()]));
        assert_eq!(listing.files, ["h.dat", "s.SGY"]);
        assert!(read(Path::new("/no/such/folder")).error.is_some());
    }
}
