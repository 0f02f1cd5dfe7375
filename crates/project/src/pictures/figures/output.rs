//! Files that pages are written to.

use crate::Project;
use crate::error::ProjectError;
use crate::folder;
use crate::pictures::write_png;
use page::list::DisplayList;
use std::path::Path;

/// The format of a figure's file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FigureFormat {
    /// Pixels.
    Png,
    /// Pixels, to print.
    Tiff,
    /// Paths and text, to edit and for the web.
    Svg,
    /// Paths and text, to print.
    Pdf,
}

impl FigureFormat {
    /// The format that the ending of a file's name says; `None` of an ending that figures have no format for.
    ///
    /// ```
    /// use project::pictures::figures::FigureFormat;
    /// assert_eq!(FigureFormat::of("north.SVG".as_ref()), Some(FigureFormat::Svg));
    /// assert_eq!(FigureFormat::of("north.gif".as_ref()), None);
    /// ```
    pub fn of(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?.to_ascii_lowercase();
        match ending.as_str() {
            "png" => Some(Self::Png),
            "tif" | "tiff" => Some(Self::Tiff),
            "svg" => Some(Self::Svg),
            "pdf" => Some(Self::Pdf),
            _ => None,
        }
    }
}

/// What readers of a vector figure announce: the project's name.
pub fn title(project: &Project) -> String {
    let stem = project.root().file_stem().map(|stem| stem.to_string_lossy().into_owned());
    stem.unwrap_or_else(|| "Petroglyph".to_owned())
}

/// Writes a page, completely or not at all. `dpi` is the resolution of pixels; `title` is what readers of vector
/// formats announce.
///
/// # Errors
/// The page is too large, the file lies inside a project, or it could not be written; an earlier file is then still
/// there.
pub fn write(page: &DisplayList, format: FigureFormat, path: &Path, dpi: f64, title: &str) -> Result<(), ProjectError> {
    match format {
        FigureFormat::Png => write_png(path, &page::raster(page, dpi)?, dpi),
        FigureFormat::Tiff => write_bytes(path, &page::tiff(&page::raster(page, dpi)?, dpi)?),
        FigureFormat::Svg => write_bytes(path, page::svg(page, title)?.as_bytes()),
        FigureFormat::Pdf => write_bytes(path, &page::pdf(page, title)?),
    }
}

fn write_bytes(path: &Path, bytes: &[u8]) -> Result<(), ProjectError> {
    folder::refuse_inside_project(path)?;
    Ok(store::replace_file(path, bytes)?)
}
