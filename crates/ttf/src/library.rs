//! The texture library: the built-in lithology patterns and the user's own tiles.
//!
//! Built-in patterns are SVG tiles of ink on nothing, in `textures/` with `catalogue.toml`, compiled
//! into the program; numbers and names follow section 37 of the FGDC Digital Cartographic Standard
//! (FGDC-STD-013-2006), the drawings are ours. They are rasterised when first used.

use std::path::Path;
use std::sync::{Arc, OnceLock};

use serde::{Deserialize, Serialize};

use crate::builtin::{CATALOGUE, DRAWINGS};
use crate::raster;
use crate::{Colour, Error, Texture};

/// A texture's entry in the catalogue.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pattern {
    /// The name by which transfer functions call it.
    pub name: String,
    /// Number in FGDC section 37, if it stands for one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fgdc: Option<u16>,
    /// Name for people, as in a legend.
    pub title: String,
    /// What is drawn, and for which rock.
    pub description: String,
    /// Group of rocks, for sorting.
    pub family: String,
    /// Width and height of the tile in a printed figure, in millimetres.
    pub tile_mm: [f32; 2],
    /// Whether the drawing has an up: it must follow the layer (bricks, dashes) rather than the page.
    pub directional: bool,
    /// The colour it lies on unless told otherwise.
    pub colour: Colour,
}

/// The textures by name.
#[derive(Debug)]
pub struct TextureLibrary {
    entries: Vec<LibraryEntry>,
}

#[derive(Debug)]
struct LibraryEntry {
    pattern: Pattern,
    svg: Option<String>,
    texture: OnceLock<Arc<Texture>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Catalogue {
    pattern: Vec<Pattern>,
}

impl TextureLibrary {
    /// The patterns that come with the program.
    ///
    /// # Errors
    /// [`Error::BadCatalogue`] if catalogue and drawings do not fit, which a test rules out.
    pub fn builtin() -> Result<Self, Error> {
        let catalogue: Catalogue =
            toml::from_str(CATALOGUE).map_err(|error| Error::BadCatalogue { fact: error.to_string() })?;
        let mut library = Self { entries: Vec::new() };
        for pattern in catalogue.pattern {
            let (_, svg) = DRAWINGS
                .iter()
                .find(|(name, _)| *name == pattern.name)
                .ok_or_else(|| Error::BadCatalogue { fact: format!("`{}` has no drawing", pattern.name) })?;
            library.push(pattern, Some((*svg).to_owned()), OnceLock::new())?;
        }
        Ok(library)
    }

    /// Adds a user's tile from a PNG, JPEG or SVG file under the file's name without extension, and
    /// returns its index.
    ///
    /// An opaque image hides the layer's colour, one with transparency lets it show. The tile is printed 20 mm
    /// wide unless the returned pattern is given another size with [`Self::set_tile_mm`]; height follows the image's shape.
    ///
    /// # Errors
    /// A file that cannot be read, is no image, is empty or absurdly large; a name that is taken.
    pub fn add_user(&mut self, path: &Path) -> Result<usize, Error> {
        let (texture, svg, shape) = raster::read_tile(path)?;
        let name = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
        let mean = texture.average_over([1.0; 3], None);
        let pattern = Pattern {
            title: name.clone(),
            description: format!("read from {}", path.display()),
            name,
            fgdc: None,
            family: "user".to_owned(),
            tile_mm: [USER_TILE_MM, USER_TILE_MM * shape],
            directional: true,
            colour: Colour::from_unit(mean),
        };
        self.push(pattern, svg, OnceLock::from(Arc::new(texture)))
    }

    /// Sets the printed size of a tile in millimetres.
    pub fn set_tile_mm(&mut self, index: usize, tile_mm: [f32; 2]) {
        self.entries[index].pattern.tile_mm = tile_mm;
    }

    fn push(&mut self, pattern: Pattern, svg: Option<String>, texture: OnceLock<Arc<Texture>>) -> Result<usize, Error> {
        if self.find(&pattern.name).is_some() {
            return Err(Error::DuplicateTexture { texture: pattern.name });
        }
        self.entries.push(LibraryEntry { pattern, svg, texture });
        Ok(self.entries.len() - 1)
    }

    /// Number of textures.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Whether there is no texture.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// All entries in the order of the catalogue, the user's last.
    pub fn patterns(&self) -> impl ExactSizeIterator<Item = &Pattern> {
        self.entries.iter().map(|entry| &entry.pattern)
    }

    /// An entry by index (0 … [`Self::len`] − 1).
    pub fn pattern(&self, index: usize) -> &Pattern {
        &self.entries[index].pattern
    }

    /// The drawing behind a texture, for vector figures; a user's raster image has none.
    pub fn svg(&self, index: usize) -> Option<&str> {
        self.entries[index].svg.as_deref()
    }

    /// Index of a name.
    pub fn find(&self, name: &str) -> Option<usize> {
        self.entries.iter().position(|entry| entry.pattern.name == name)
    }

    /// Index of a name that was asked for at `place`.
    ///
    /// # Errors
    /// [`Error::UnknownTexture`] with the nearest name there is.
    pub fn index_of(&self, name: &str, place: &str) -> Result<usize, Error> {
        self.find(name).ok_or_else(|| {
            let nearest = self
                .patterns()
                .map(|pattern| (edit_distance(name, &pattern.name), &pattern.name))
                .min()
                .filter(|(distance, nearest)| *distance <= 1 + nearest.len() / 4)
                .map(|(_, nearest)| nearest.clone());
            Error::UnknownTexture { place: place.to_owned(), texture: name.to_owned(), nearest }
        })
    }

    /// The pixels of a texture; rasterised on first use, then shared.
    ///
    /// # Errors
    /// [`Error::BadSvg`] for a built-in drawing that does not parse, which a test rules out.
    pub fn texture(&self, index: usize) -> Result<Arc<Texture>, Error> {
        let entry = &self.entries[index];
        if let Some(texture) = entry.texture.get() {
            return Ok(Arc::clone(texture));
        }
        let svg = entry.svg.as_deref().unwrap_or_default();
        let (texture, _) = raster::rasterize(&entry.pattern.name, svg.as_bytes())?;
        Ok(Arc::clone(entry.texture.get_or_init(|| Arc::new(texture))))
    }
}

/// Printed width of a user's tile in millimetres.
const USER_TILE_MM: f32 = 20.0;

/// Levenshtein distance of two names, in characters.
fn edit_distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (line, from) in a.chars().enumerate() {
        let mut diagonal = std::mem::replace(&mut row[0], line + 1);
        for (column, to) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(from != *to);
            diagonal = row[column + 1];
            row[column + 1] = replaced.min(diagonal + 1).min(row[column] + 1);
        }
    }
    row[b.len()]
}
