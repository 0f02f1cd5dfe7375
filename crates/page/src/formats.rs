//! The kinds of files that pages and animations are written to, in one table: whoever lists endings, reads one from a name
//! or writes a file asks it.
//!
//! To add a kind: a file that writes it and describes it as a [`FileFormat`], and its place in the table.

use crate::animation::GIF;
use crate::format::FileFormat;
use crate::pdf::PDF;
use crate::raster::{APNG, PNG, TIFF};
use crate::svg::SVG;
use std::path::Path;

/// Every kind of file, in the order in which they are listed.
static FORMATS: [FileFormat; 6] = [PNG, TIFF, SVG, PDF, APNG, GIF];

impl FileFormat {
    /// The kind that a name's ending says, among those that hold a page.
    pub fn of_page(path: &Path) -> Option<&'static Self> {
        Self::pages().find(|format| format.is_of(path))
    }

    /// The kind that a name's ending says, among those that hold an animation.
    pub fn of_animation(path: &Path) -> Option<&'static Self> {
        Self::animations().find(|format| format.is_of(path))
    }

    /// Every kind that holds a page; the first one is the usual one.
    pub fn pages() -> impl Iterator<Item = &'static Self> {
        FORMATS.iter().filter(|format| format.page.is_some())
    }

    /// Every kind that holds an animation.
    pub fn animations() -> impl Iterator<Item = &'static Self> {
        FORMATS.iter().filter(|format| format.animation.is_some())
    }

    /// The kind of a page where no other was asked for.
    pub fn usual() -> &'static Self {
        &FORMATS[0]
    }

    fn is_of(&self, path: &Path) -> bool {
        let ending = path.extension().and_then(|ending| ending.to_str());
        ending.is_some_and(|ending| self.endings.iter().any(|known| known.eq_ignore_ascii_case(ending)))
    }
}

/// The endings of kinds of files, as a sentence has them.
///
/// ```
/// let paths = page::FileFormat::pages().filter(|format| !format.has_pixels());
/// assert_eq!(page::endings(paths), ".svg or .pdf");
/// ```
pub fn endings<'a>(formats: impl IntoIterator<Item = &'a FileFormat>) -> String {
    let dotted: Vec<String> = formats.into_iter().map(|format| format!(".{}", format.ending())).collect();
    match dotted.split_last() {
        Some((last, others @ [_, ..])) => format!("{} or {last}", others.join(", ")),
        _ => dotted.concat(),
    }
}

/// What each ending of a page's file gives, as help has it.
///
/// ```
/// assert_eq!(page::endings_of_pages(), ".png or .tif for pixels, .svg or .pdf for paths and text");
/// ```
pub fn endings_of_pages() -> String {
    let of = |has_pixels| endings(FileFormat::pages().filter(|format| format.has_pixels() == has_pixels));
    format!("{} for pixels, {} for paths and text", of(true), of(false))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::list::DisplayList;
    use glam::DVec2;

    #[test]
    fn each_ending_says_one_kind_of_page_and_of_animation() {
        for format in &FORMATS {
            assert!(format.page.is_some() || format.animation.is_some(), "{}", format.name);
            for ending in format.endings {
                let holds = |found: &FileFormat| found.endings.contains(ending);
                assert!(FileFormat::pages().filter(|found| holds(found)).count() <= 1, "{ending}");
                assert!(FileFormat::animations().filter(|found| holds(found)).count() <= 1, "{ending}");
            }
        }
    }

    #[test]
    fn every_kind_of_page_is_written() {
        let page = DisplayList::new(DVec2::splat(10.0));
        for format in &FORMATS {
            assert_eq!(format.page(&page, 72.0, "A page").is_ok(), format.page.is_some(), "{}", format.name);
        }
    }
}
