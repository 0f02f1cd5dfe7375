//! What outlives the window: recent projects, appearance, and the view of the last project.
//!
//! Commands are saved as they are given, so a crash loses nothing of a project. Only the view could be lost; it is
//! written here from time to time, together with a mark that is removed when the window is closed properly. A mark that
//! is still there at the next start means that the last run ended badly, and the start page offers to continue from
//! that view.

use super::view::ViewState;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use system::file;

/// Number of recent projects that are kept.
const RECENT: usize = 8;

/// Light or dark.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Appearance {
    /// As the desktop says.
    #[default]
    System,
    /// Dark on light.
    Light,
    /// Light on dark.
    Dark,
}

impl Appearance {
    /// The next choice in turn.
    pub fn next(self) -> Self {
        match self {
            Self::System => Self::Light,
            Self::Light => Self::Dark,
            Self::Dark => Self::System,
        }
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::System => "System",
            Self::Light => "Light",
            Self::Dark => "Dark",
        }
    }
}

/// A project that was open when the program ended.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Left {
    /// Its folder.
    pub root: PathBuf,
    /// Its view.
    pub view: ViewState,
}

/// What outlives the window.
///
/// ```
/// use state::Remembered;
/// use std::path::Path;
///
/// let mut remembered = Remembered::default();
/// for name in ["a.petro", "b.petro", "a.petro"] {
///     remembered.add(Path::new(name));
/// }
/// assert_eq!(remembered.recent, [Path::new("a.petro"), Path::new("b.petro")]);
/// ```
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Remembered {
    /// Light or dark.
    pub appearance: Appearance,
    /// Scale of the interface on top of the desktop's.
    pub scale: Option<f32>,
    /// Recent projects, newest first.
    pub recent: Vec<PathBuf>,
    /// The last views of projects that were closed, newest first.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub closed: Vec<Left>,
    /// The project that was open when the window last wrote this file; removed when the window is closed properly.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub left: Option<Left>,
}

impl Remembered {
    /// Puts a project first in the list.
    pub fn add(&mut self, root: &Path) {
        self.recent.retain(|known| known != root);
        self.recent.insert(0, root.to_owned());
        self.recent.truncate(RECENT);
    }

    /// Keeps the view of a project that is closed.
    pub fn put_by(&mut self, root: &Path, view: &ViewState) {
        self.closed.retain(|known| known.root != root);
        self.closed.insert(0, Left { root: root.to_owned(), view: view.clone() });
        self.closed.truncate(RECENT);
    }

    /// Removes a project from the list.
    pub fn forget(&mut self, root: &Path) {
        self.recent.retain(|known| known != root);
        self.closed.retain(|known| known.root != root);
    }

    /// The file of the settings: `petroglyph/window.toml` in the system's folder for settings.
    pub fn path() -> Option<PathBuf> {
        let folder = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
        let settings = folder("XDG_CONFIG_HOME")
            .or_else(|| folder("APPDATA"))
            .or_else(|| folder("HOME").map(|home| home.join(".config")))?;
        Some(settings.join("petroglyph").join("window.toml"))
    }

    /// The settings in `path`; the defaults where the file does not exist or cannot be parsed, since it holds nothing
    /// that matters.
    pub fn read(path: &Path) -> Self {
        let text = file::read_text(path, file::MAX_DOCUMENT_BYTES);
        text.ok().and_then(|text| toml::from_str(&text).ok()).unwrap_or_default()
    }

    /// Writes the settings to `path`, completely or not at all.
    ///
    /// # Errors
    /// The file could not be written.
    pub fn write(&self, path: &Path) -> std::io::Result<()> {
        let text = toml::to_string_pretty(self).map_err(std::io::Error::other)?;
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder)?;
        }
        let new = path.with_extension("toml.new");
        std::fs::write(&new, text)?;
        std::fs::rename(&new, path)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use project::document::Document;

    #[test]
    fn the_newest_is_first_and_known_once() {
        let mut remembered = Remembered::default();
        for name in ["a", "b", "a", "c"] {
            remembered.add(Path::new(name));
        }
        assert_eq!(remembered.recent, [Path::new("c"), Path::new("a"), Path::new("b")]);
        (0..20).for_each(|n| remembered.add(Path::new(&format!("{n}"))));
        assert_eq!(remembered.recent.len(), RECENT);
    }

    #[test]
    fn what_is_kept_comes_back_and_a_damaged_file_is_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("deep/window.toml");
        let geometry = survey::SurveyGeometry::regular([9, 8, 7], 25.0, 4.0, survey::VerticalUnit::Milliseconds);
        let view = ViewState::of(&Document::empty(Some(geometry)));
        let mut remembered = Remembered { appearance: Appearance::Dark, ..Remembered::default() };
        remembered.left = Some(Left { root: "a.petro".into(), view });
        remembered.write(&path).unwrap();
        assert_eq!(Remembered::read(&path), remembered);
        std::fs::write(&path, "recent = 3").unwrap();
        assert_eq!(Remembered::read(&path), Remembered::default());
    }
}
