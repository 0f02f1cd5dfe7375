//! The user's own tiles for patterns.

use super::{Effect, Noun, ProjectError};
use crate::content;
use crate::document::{Id, TextureEntry};
use crate::folder::Draft;
use crate::styles;
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::{Path, PathBuf};
use system::file::FileAction;

/// Copies a picture into the project for use as a tile.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AddTexture {
    /// PNG, JPEG or SVG file.
    pub path: PathBuf,
    /// Printed width, mm; `None`: the library's default for user tiles.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub width_mm: Option<f32>,
}

impl AddTexture {
    pub(super) fn execute(&self, draft: &mut Draft) -> Result<Effect, ProjectError> {
        // Reading it through the library checks the picture and its name before anything is copied.
        let mut library = styles::pattern_library(draft.root(), &draft.document)?;
        let index = library.add_user(&self.path)?;
        let pattern = library.pattern(index);
        let [width, height] = pattern.tile_mm;
        let width_mm = self.width_mm.unwrap_or(width);
        if !(width_mm > 0.0 && width_mm.is_finite()) {
            let fact = "its printed width must be a positive number of millimetres";
            return Err(ProjectError::BadName { noun: Noun::Texture, name: pattern.name.clone(), fact });
        }
        let extension = self.path.extension().map_or_else(String::new, |e| e.to_string_lossy().to_lowercase());
        let (file, new) = draft.generation("textures", &pattern.name, &extension)?;
        // The library names a tile after its file, so the name is that of the copy.
        let name = Path::new(&file).file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
        draft.document.check_new_name(Noun::Texture, &name)?;
        fs::copy(&self.path, &new).map_err(|source| ProjectError::io(FileAction::Written, &new, source))?;
        draft.document.textures.push(TextureEntry {
            id: Id::default(),
            name: name.clone(),
            file,
            tile_mm: [width_mm, height * width_mm / width],
            hash: content::hash_file(&new)?,
            origin: super::imported(&self.path, extension)?,
        });
        Ok(Effect::Changed { summary: format!("texture {name}") })
    }
}
