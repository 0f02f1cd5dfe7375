//! What a kind of file is that pages and animations are written to. The table of all is in `formats`.

use crate::error::PageError;
use crate::list::DisplayList;
use image::RgbaImage;
use std::io::{self, Write};

/// What a file of a page holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Content {
    /// Its pixels.
    Pixels,
    /// Its paths and text.
    Paths,
}

/// Writes a page: with pixels of a resolution, dots an inch, or with a title that readers announce.
pub(crate) type PageWriter = fn(&DisplayList, f64, &str) -> Result<Vec<u8>, PageError>;

/// Of what an animation consists.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AnimationShape {
    /// Width and height of every frame, pixels.
    pub size_px: [u32; 2],
    /// Number of frames.
    pub frames: u32,
    /// Frames a second.
    pub rate: f64,
}

impl AnimationShape {
    /// How long a frame is shown, in thousandths of a second.
    pub(crate) fn delay_ms(&self) -> u16 {
        (1000.0 / self.rate).round().clamp(1.0, f64::from(u16::MAX)) as u16
    }
}

/// Frames of one size, being written to a file.
pub(crate) trait Frames {
    /// Adds a frame.
    fn add(&mut self, frame: &RgbaImage) -> io::Result<()>;

    /// Ends the file.
    fn finish(self: Box<Self>) -> io::Result<()>;
}

/// Begins an animation.
pub(crate) type Begin = for<'a> fn(&'a mut dyn Write, AnimationShape) -> io::Result<Box<dyn Frames + 'a>>;

/// A kind of file.
///
/// ```
/// use page::FileFormat;
/// let format = FileFormat::of_page("north.SVG".as_ref()).unwrap();
/// assert_eq!((format.name(), format.has_pixels()), ("SVG", false));
/// assert!(FileFormat::of_page("north.gif".as_ref()).is_none());
/// assert!(FileFormat::of_animation("north.gif".as_ref()).is_some());
/// ```
#[derive(Debug)]
pub struct FileFormat {
    pub(crate) name: &'static str,
    /// Endings of names, without the dot, the usual one first.
    pub(crate) endings: &'static [&'static str],
    /// What it holds of a page, and its writer; `None` where it holds no page.
    pub(crate) page: Option<(Content, PageWriter)>,
    /// How an animation begins; `None` where it holds none.
    pub(crate) animation: Option<Begin>,
}

impl PartialEq for FileFormat {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl FileFormat {
    /// What it is called.
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// The usual ending of its names, without the dot.
    pub fn ending(&self) -> &'static str {
        self.endings[0]
    }

    /// Whether it holds a page's pixels, and not its paths.
    pub fn has_pixels(&self) -> bool {
        matches!(self.page, Some((Content::Pixels, _)))
    }

    /// A page as such a file: pixels at `dpi`, or paths with a `title` that readers announce.
    ///
    /// # Errors
    /// The page is too large, or has a picture that cannot be encoded; [`PageError::NoPage`] where it holds no page.
    pub fn page(&self, page: &DisplayList, dpi: f64, title: &str) -> Result<Vec<u8>, PageError> {
        let (_, write) = self.page.ok_or(PageError::NoPage { format: self.name })?;
        write(page, dpi, title)
    }
}
