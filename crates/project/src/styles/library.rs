//! The patterns that a project can use: the built-in ones and its own tiles.

use crate::content;
use crate::document::Document;
use crate::error::ProjectError;
use std::path::Path;
use ttf::{LayerStyle, LayerTtf, TextureLibrary};

/// The built-in patterns and the tiles of the project in `root`.
///
/// # Errors
/// A tile of the project can no longer be read, or is not the one that was recorded.
pub fn pattern_library(root: &Path, document: &Document) -> Result<TextureLibrary, ProjectError> {
    let mut library = TextureLibrary::builtin()?;
    for entry in &document.textures {
        let index = library.add_user_as(&entry.name, &content::texture_path(root, entry)?)?;
        library.set_tile_mm(index, entry.tile_mm);
    }
    Ok(library)
}

/// The styles of the layers, youngest first: their own, or the default ones.
pub fn layer_styles(document: &Document, library: &TextureLibrary) -> Vec<LayerStyle> {
    let names = document.layers();
    let style = |(index, name): (usize, &String)| match document.style.layers.style(name) {
        Some(style) => style.clone(),
        None => LayerTtf::default_style(name, names.len() - 1 - index, library),
    };
    names.iter().enumerate().map(style).collect()
}
