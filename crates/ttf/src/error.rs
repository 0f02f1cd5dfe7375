//! The errors of this crate. Each has its facts as fields, and its text says what to do.

use crate::age::ages_like;
use crate::rock::rocks_like;
use crate::similar::offered;
use std::path::PathBuf;

/// What is wrong with a transfer function or a texture.
#[derive(Debug, thiserror::Error)]
pub enum TtfError {
    /// A colour that is not `#rrggbb`.
    #[error("`{text}` is not a colour; write it as #rrggbb, for example #e8c98a")]
    BadColour {
        /// The text found.
        text: String,
    },
    /// A file that holds no face that lettering could be set in.
    #[error("this is no face that text can be set in ({reason}); give a TrueType or OpenType file (.ttf, .otf, .ttc)")]
    UnusableFace {
        /// What is wrong with it.
        reason: String,
    },
    /// A frequency that is not a positive finite number.
    #[error(
        "{place}: the frequency {horizontal} x {vertical} is not usable; both numbers must be finite and greater than 0"
    )]
    BadFrequency {
        /// Where it was found.
        place: String,
        /// Repeats along i.
        horizontal: f32,
        /// Repeats along k.
        vertical: f32,
    },
    /// An opacity, blend or stop position outside [0, 1].
    #[error("{place}: {quantity} is {value}, but must lie between 0 and 1")]
    OutsideUnit {
        /// Where it was found.
        place: String,
        /// Which quantity.
        quantity: &'static str,
        /// The value found.
        value: f32,
    },
    /// A depth interval outside [0, 1], empty, reversed or not a number.
    #[error(
        "layer `{layer}`: the depth interval [{low}, {high}) is not usable; k runs from 0 (bottom) to 1 (top) \
         and the first number must be the smaller one"
    )]
    BadDepthInterval {
        /// The layer's name.
        layer: String,
        /// Lower end found.
        low: f32,
        /// Upper end found.
        high: f32,
    },
    /// A value interval that is empty, reversed or not a number.
    #[error(
        "scalar function on `{volume}`: the interval [{low}, {high}) is not usable; the first number must be \
         the smaller one (-inf and inf are allowed)"
    )]
    BadValueInterval {
        /// The volume's name.
        volume: String,
        /// Lower end found.
        low: f32,
        /// Upper end found.
        high: f32,
    },
    /// Two intervals of one function share values.
    #[error(
        "{place}: the intervals [{first_low}, {first_high}) and [{second_low}, {second_high}) overlap; let one end where the other begins"
    )]
    Overlap {
        /// Where it was found.
        place: String,
        /// First interval, lower end.
        first_low: f32,
        /// First interval, upper end.
        first_high: f32,
        /// Second interval, lower end.
        second_low: f32,
        /// Second interval, upper end.
        second_high: f32,
    },
    /// Two styles for one layer.
    #[error("layer `{layer}` has two styles; keep one of them")]
    DuplicateLayer {
        /// The layer's name.
        layer: String,
    },
    /// A layer name that is not in the stratigraphy.
    #[error("there is no layer `{layer}`; the layers are {known}")]
    UnknownLayer {
        /// The name asked for.
        layer: String,
        /// The names there are, bottom to top.
        known: String,
    },
    /// A texture name that is not in the library.
    #[error(
        "{place}: there is no texture `{texture}`{}; use a name from the pattern library, or add the texture to it",
        match nearest { Some(name) => format!(", did you mean `{name}`?"), None => String::new() }
    )]
    UnknownTexture {
        /// Where it was asked for.
        place: String,
        /// The name asked for.
        texture: String,
        /// The most similar name there is, if one is close.
        nearest: Option<String>,
    },
    /// A rock that the vocabulary does not have.
    #[error("there is no rock `{rock}`; {}", offered(
        &rocks_like(rock),
        "name it in English as the CGI simple lithology vocabulary does (sandstone, wacke, marble, diorite), or choose a \
         pattern: `petroglyph patterns OUT.png` draws all",
    ))]
    UnknownRock {
        /// The name asked for.
        rock: String,
    },
    /// A unit that the chronostratigraphic chart does not have.
    #[error("there is no unit `{age}` in the International Chronostratigraphic Chart; {}", offered(
        &ages_like(age),
        "use its English name (Campanian, Upper Cretaceous, Neogene), or state a colour",
    ))]
    UnknownAge {
        /// The name asked for.
        age: String,
    },
    /// A texture name that is in use already.
    #[error("the texture name `{texture}` is in use already; rename the file or choose another name")]
    DuplicateTexture {
        /// The name.
        texture: String,
    },
    /// A function without enough stops or with stops out of order.
    #[error("{place}: {fact}; a colour function needs at least two stops at rising positions from 0 to 1")]
    BadStops {
        /// Where it was found.
        place: String,
        /// What is wrong.
        fact: String,
    },
    /// A domain that is empty or not finite.
    #[error(
        "{place}: the domain [{low}, {high}] is not usable; both ends must be finite and the first the smaller one"
    )]
    BadDomain {
        /// Where it was found.
        place: String,
        /// Lower end.
        low: f32,
        /// Upper end.
        high: f32,
    },
    /// An extent of the block that patterns cannot be sized by.
    #[error("{quantity} is {value}; it must be finite and greater than 0, since patterns are sized by it")]
    BadExtent {
        /// Which length.
        quantity: &'static str,
        /// The value found.
        value: f32,
    },
    /// A texture file that cannot be read.
    #[error("cannot read the texture {path}: {source}")]
    ReadTexture {
        /// The file.
        path: PathBuf,
        /// The cause.
        source: std::io::Error,
    },
    /// A texture file whose extension is none of the formats that can be read.
    #[error("{path} is not in a texture format that can be read; use .{}", crate::raster::TILE_ENDINGS.join(", ."))]
    UnknownFormat {
        /// The file.
        path: PathBuf,
    },
    /// A raster image that cannot be decoded.
    #[error("the texture {path} cannot be decoded ({source}); open it in an image editor and save it as PNG")]
    BadImage {
        /// The file.
        path: PathBuf,
        /// The cause.
        source: image::ImageError,
    },
    /// An SVG that cannot be parsed.
    #[error("the texture {name} is not a usable SVG ({source}); open it in a drawing program and save it as plain SVG")]
    BadSvg {
        /// The file or pattern.
        name: String,
        /// The cause.
        source: resvg::usvg::Error,
    },
    /// An SVG with something that a tile may not hold, because it reads other files or its cost has no bound.
    #[error(
        "the texture {name} cannot be used: {fact}; a tile may hold shapes, gradients and simple clip paths, so save it as plain SVG with the rest turned into paths, or as PNG"
    )]
    RefusedSvg {
        /// The file or pattern.
        name: String,
        /// What it holds.
        fact: String,
    },
    /// A tile that is a device, a pipe or a folder.
    #[error("the texture {path} is not an ordinary file; name a PNG, JPEG or SVG file")]
    NotAFile {
        /// What was named.
        path: PathBuf,
    },
    /// An image without pixels, or one too large to be a tile.
    #[error("the texture {name} is {width} x {height} pixels; resize it to between 1 and {limit} pixels a side")]
    BadSize {
        /// The file or pattern.
        name: String,
        /// Width found.
        width: u32,
        /// Height found.
        height: u32,
        /// Largest side accepted.
        limit: u32,
    },
    /// A file larger than a tile may be.
    #[error("the texture {path} has {bytes} bytes, more than the limit of {limit}; reduce its size")]
    TooManyBytes {
        /// The file.
        path: PathBuf,
        /// Bytes found.
        bytes: u64,
        /// Bytes accepted.
        limit: u64,
    },
    /// The pattern catalogue cannot be parsed, or does not match the drawings.
    #[error("the built-in pattern catalogue is damaged: {fact}; this is a defect of the program")]
    BadCatalogue {
        /// What is wrong.
        fact: String,
    },
}
