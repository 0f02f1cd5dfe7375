//! What outlives the window: recent projects, appearance, and how the last project was left.
//!
//! Commands are saved as they are given, so a crash loses nothing of a project. What it could lose is the view; that is written here
//! now and then, with a mark that is taken away when the window is closed properly. A mark that is still there at the next start means
//! that the last run ended badly, and the start page offers to go on from where it was.

use super::view::View;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use survey::file;

/// Recent projects kept.
const RECENT: usize = 8;

/// Light or dark.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Appearance {
    /// As the desktop is.
    #[default]
    System,
    /// Dark on light.
    Light,
    /// Light on dark.
    Dark,
}

impl Appearance {
    /// The next one round.
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

/// A project left open.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Left {
    /// Its folder.
    pub root: PathBuf,
    /// How it was looked at.
    pub view: View,
}

/// What outlives the window.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Remembered {
    /// Light or dark.
    pub appearance: Appearance,
    /// Scale of everything on top of the desktop's.
    pub scale: Option<f32>,
    /// Recent projects, newest first.
    pub recent: Vec<PathBuf>,
    /// What was open when the window was last heard of; taken away when it is closed properly.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub left: Option<Left>,
}

impl Remembered {
    /// Puts a project first.
    pub fn add(&mut self, root: &Path) {
        self.recent.retain(|known| known != root);
        self.recent.insert(0, root.to_owned());
        self.recent.truncate(RECENT);
    }

    /// Forgets a project.
    pub fn forget(&mut self, root: &Path) {
        self.recent.retain(|known| known != root);
    }

    /// The file it is kept in: `petroglyph/window.toml` where the system keeps settings.
    pub fn path() -> Option<PathBuf> {
        let folder = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
        let settings = folder("XDG_CONFIG_HOME")
            .or_else(|| folder("APPDATA"))
            .or_else(|| folder("HOME").map(|home| home.join(".config")))?;
        Some(settings.join("petroglyph").join("window.toml"))
    }

    /// What is kept at `path`; nothing where there is no such file or it cannot be understood, for it holds nothing that matters.
    pub fn read(path: &Path) -> Self {
        let text = file::read_text(path, file::MAX_DOCUMENT_BYTES);
        text.ok().and_then(|text| toml::from_str(&text).ok()).unwrap_or_default()
    }

    /// Keeps it at `path`, complete or not at all.
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
        let view = View::of(&Document::empty(Some(geometry)));
        let mut remembered = Remembered { appearance: Appearance::Dark, ..Remembered::default() };
        remembered.left = Some(Left { root: "a.petro".into(), view });
        remembered.write(&path).unwrap();
        assert_eq!(Remembered::read(&path), remembered);
        std::fs::write(&path, "recent = 3").unwrap();
        assert_eq!(Remembered::read(&path), Remembered::default());
    }
}
