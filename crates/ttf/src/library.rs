//! The texture library: the built-in lithology patterns and the user's own tiles.
//!
//! Built-in patterns are SVG tiles of ink on a transparent ground. They lie in `textures/` with
//! `catalogue.toml` and are compiled into the program. Numbers and names follow section 37 of the FGDC
//! Digital Cartographic Standard (FGDC-STD-013-2006); the drawings are ours. A tile is rasterised when it is
//! first used.

use std::path::Path;
use std::sync::{Arc, OnceLock};

use serde::{Deserialize, Serialize};

use crate::builtin::{CATALOGUE, DRAWINGS};
use crate::drawing::{TileDrawing, drawing_of};
use crate::raster;
use crate::{Colour, Texture, TtfError};

/// A texture's entry in the catalogue.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pattern {
    /// The name by which transfer functions refer to it.
    pub name: String,
    /// Its number in FGDC section 37, if it has one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fgdc: Option<u16>,
    /// Its name in legends.
    pub title: String,
    /// What is drawn, and for which rock.
    pub description: String,
    /// Group of rocks, for sorting.
    pub family: String,
    /// Width and height of the tile in a printed figure, in millimetres.
    pub tile_mm: [f32; 2],
    /// Whether the drawing has an up direction, so that it must follow the layer (bricks, dashes) rather than
    /// the page.
    pub directional: bool,
    /// The colour below it, unless a style states another.
    pub colour: Colour,
}

/// The textures by name.
///
/// ```
/// let library = ttf::TextureLibrary::builtin().unwrap();
/// let limestone = library.find("limestone").unwrap();
/// assert_eq!(library.pattern(limestone).fgdc, Some(627));
/// let error = library.index_of("limstone", "layer `Chalk`").unwrap_err();
/// assert!(error.to_string().contains("did you mean `limestone`?"));
/// ```
#[derive(Debug)]
pub struct TextureLibrary {
    entries: Vec<LibraryEntry>,
}

#[derive(Debug, Clone)]
struct LibraryEntry {
    pattern: Pattern,
    svg: Option<Arc<str>>,
    /// Shared by all libraries of the program, so that a pattern is rasterised once, and its drawing read once.
    texture: Arc<OnceLock<Arc<Texture>>>,
    drawing: Arc<OnceLock<Option<Arc<TileDrawing>>>>,
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
    /// [`TtfError::BadCatalogue`] if catalogue and drawings do not match. A test rules this out.
    pub fn builtin() -> Result<Self, TtfError> {
        static READ: OnceLock<Vec<LibraryEntry>> = OnceLock::new();
        if let Some(entries) = READ.get() {
            return Ok(Self { entries: entries.clone() });
        }
        let library = Self::read()?;
        Ok(Self { entries: READ.get_or_init(|| library.entries).clone() })
    }

    fn read() -> Result<Self, TtfError> {
        let catalogue: Catalogue =
            toml::from_str(CATALOGUE).map_err(|error| TtfError::BadCatalogue { fact: error.to_string() })?;
        let mut library = Self { entries: Vec::new() };
        for pattern in catalogue.pattern {
            let (_, svg) = DRAWINGS
                .iter()
                .find(|(name, _)| *name == pattern.name)
                .ok_or_else(|| TtfError::BadCatalogue { fact: format!("`{}` has no drawing", pattern.name) })?;
            library.push(pattern, Some((*svg).into()), OnceLock::new())?;
        }
        Ok(library)
    }

    /// Adds a user's tile from a PNG, JPEG or SVG file and returns its index. Its name is the file's name
    /// without extension.
    ///
    /// An opaque image hides the layer's colour; a transparent one lets it show. The tile is printed 20 mm
    /// wide unless [`Self::set_tile_mm`] changes that; its height follows from the aspect ratio of the image.
    ///
    /// # Errors
    /// A file that cannot be read, is not an image, has no pixels or is too large; a name that is in use
    /// already.
    pub fn add_user(&mut self, path: &Path) -> Result<usize, TtfError> {
        let name = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
        self.add_user_as(&name, path)
    }

    /// The same under another name than that of its file.
    ///
    /// # Errors
    /// As [`Self::add_user`].
    pub fn add_user_as(&mut self, name: &str, path: &Path) -> Result<usize, TtfError> {
        let (texture, svg, shape) = raster::read_tile(path)?;
        let name = name.to_owned();
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
        self.push(pattern, svg.map(Arc::from), OnceLock::from(Arc::new(texture)))
    }

    /// Sets the printed size of a tile in millimetres.
    pub fn set_tile_mm(&mut self, index: usize, tile_mm: [f32; 2]) {
        self.entries[index].pattern.tile_mm = tile_mm;
    }

    fn push(
        &mut self,
        pattern: Pattern,
        svg: Option<Arc<str>>,
        texture: OnceLock<Arc<Texture>>,
    ) -> Result<usize, TtfError> {
        if self.find(&pattern.name).is_some() {
            return Err(TtfError::DuplicateTexture { texture: pattern.name });
        }
        let drawing = Arc::default();
        self.entries.push(LibraryEntry { pattern, svg, texture: Arc::new(texture), drawing });
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

    /// All entries: the catalogue in its order, then the user's.
    pub fn patterns(&self) -> impl ExactSizeIterator<Item = &Pattern> {
        self.entries.iter().map(|entry| &entry.pattern)
    }

    /// The entry at an index (0 … [`Self::len`] − 1).
    pub fn pattern(&self, index: usize) -> &Pattern {
        &self.entries[index].pattern
    }

    /// The drawing behind a texture, for vector figures; a user's raster image has none.
    pub fn svg(&self, index: usize) -> Option<&str> {
        self.entries[index].svg.as_deref()
    }

    /// The drawing behind a texture as paths, which is read on first use and then shared; `None` of a raster image, and of what [`crate::drawing`] leaves out.
    ///
    /// # Errors
    /// A drawing that cannot be read.
    pub fn drawing(&self, index: usize) -> Result<Option<Arc<TileDrawing>>, TtfError> {
        let entry = &self.entries[index];
        if let Some(drawing) = entry.drawing.get() {
            return Ok(drawing.clone());
        }
        let read = entry.svg.as_ref().map_or(Ok(None), |svg| drawing_of(&entry.pattern.name, svg))?;
        Ok(entry.drawing.get_or_init(|| read.map(Arc::new)).clone())
    }

    /// Index of a name.
    pub fn find(&self, name: &str) -> Option<usize> {
        self.entries.iter().position(|entry| entry.pattern.name == name)
    }

    /// Index of a name, which an error text says was used at `place`.
    ///
    /// # Errors
    /// [`TtfError::UnknownTexture`], with the most similar name there is.
    pub fn index_of(&self, name: &str, place: &str) -> Result<usize, TtfError> {
        self.find(name).ok_or_else(|| {
            let similar = self
                .patterns()
                .map(|pattern| (strsim::levenshtein(name, &pattern.name), &pattern.name))
                .min()
                .filter(|(distance, nearest)| *distance <= 1 + nearest.len() / 4);
            // A kind of what was asked for says more than a name of like letters.
            let is_kind = |known: &&String| known.strip_prefix(name).is_some_and(|rest| rest.starts_with('-'));
            let kind = self.patterns().map(|pattern| &pattern.name).find(is_kind);
            let nearest = kind.or(similar.map(|(_, nearest)| nearest)).cloned();
            TtfError::UnknownTexture { place: place.to_owned(), texture: name.to_owned(), nearest }
        })
    }

    /// The pixels of a texture. It is rasterised on first use and then shared.
    ///
    /// # Errors
    /// [`TtfError::BadSvg`] for a built-in drawing that cannot be parsed. A test rules this out.
    pub fn texture(&self, index: usize) -> Result<Arc<Texture>, TtfError> {
        let entry = &self.entries[index];
        if let Some(texture) = entry.texture.get() {
            return Ok(Arc::clone(texture));
        }
        let svg = entry.svg.as_deref().expect("an entry without texels has a drawing");
        let (texture, _) = raster::rasterize(&entry.pattern.name, svg.as_bytes())?;
        Ok(Arc::clone(entry.texture.get_or_init(|| Arc::new(texture))))
    }
}

/// Printed width of a user's tile in millimetres.
const USER_TILE_MM: f32 = 20.0;
