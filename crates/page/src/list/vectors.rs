//! The one way through a page for back ends that write vectors, and what they all leave out.

use super::{DisplayList, Group, Item, Path, PathItem, Picture, Sampling, Segment, Stroke, Text};
use crate::error::PageError;
use image::DynamicImage;
use std::collections::HashMap;
use std::sync::Arc;

/// A file of vectors being written; items come back to front.
pub(crate) trait VectorWriter {
    /// A path with a fill, a stroke or both.
    fn path(&mut self, item: &PathItem);

    /// A line of text that is not blank.
    fn text(&mut self, line: &Text);

    /// A picture.
    ///
    /// # Errors
    /// A picture that cannot be encoded.
    fn picture(&mut self, picture: &Picture) -> Result<(), PageError>;

    /// What follows lies in this group, until it ends.
    fn begin(&mut self, group: &Group);

    /// The group that began last ends.
    fn end(&mut self, group: &Group);
}

/// Takes a page through a writer: its paper, then its items. Left out are groups that show nothing, paths without ink
/// or with places that are not finite, and blank text.
///
/// # Errors
/// What the writer says.
pub(crate) fn write_vectors(list: &DisplayList, writer: &mut impl VectorWriter) -> Result<(), PageError> {
    if let Some(paper) = list.paper {
        writer.path(&PathItem::filled(Path::rect(list.bounds()), paper));
    }
    write_items(&list.items, writer)
}

fn write_items(items: &[Item], writer: &mut impl VectorWriter) -> Result<(), PageError> {
    for item in items {
        match item {
            Item::Group(group) if group.hides_all() => {}
            Item::Group(group) => {
                writer.begin(group);
                write_items(&group.items, writer)?;
                writer.end(group);
            }
            Item::Path(path) => {
                let has_ink = path.fill.is_some() || path.stroke.as_ref().is_some_and(Stroke::is_seen);
                if has_ink && path.path.is_drawable() {
                    writer.path(path);
                }
            }
            Item::Text(line) if line.text.trim().is_empty() => {}
            Item::Text(line) => writer.text(line),
            Item::Picture(picture) => writer.picture(picture)?,
        }
    }
    Ok(())
}

impl Group {
    /// Whether nothing of it can be seen: it is empty, or its clip is.
    fn hides_all(&self) -> bool {
        self.items.is_empty() || self.clip.as_ref().is_some_and(|clip| !clip.is_drawable())
    }
}

impl Path {
    /// Whether it has places, and all of them are finite.
    fn is_drawable(&self) -> bool {
        let is_finite = |segment: &Segment| match segment {
            Segment::Move(p) | Segment::Line(p) => p.is_finite(),
            Segment::Cubic(a, b, c) => a.is_finite() && b.is_finite() && c.is_finite(),
            Segment::Close => true,
        };
        !self.segments.is_empty() && self.segments.iter().all(is_finite)
    }
}

impl Stroke {
    /// Whether it has a width.
    pub(crate) fn is_seen(&self) -> bool {
        self.width > 0.0 && self.width.is_finite()
    }
}

/// Pictures that a file already holds, so that each is written once.
#[derive(Default)]
pub(crate) struct KnownPictures {
    /// Numbers from 0, by address.
    numbers: HashMap<(usize, Sampling), usize>,
}

impl KnownPictures {
    /// The number of a picture's pixels, and whether they are new to the file.
    pub(crate) fn number(&mut self, picture: &Picture) -> (usize, bool) {
        let next = self.numbers.len();
        let key = (Arc::as_ptr(&picture.pixels) as usize, picture.sampling);
        let number = *self.numbers.entry(key).or_insert(next);
        (number, number == next)
    }
}

/// An image as a PNG file.
///
/// # Errors
/// An image of no size.
pub(crate) fn png(image: &DynamicImage) -> Result<Vec<u8>, PageError> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.write_to(&mut bytes, image::ImageFormat::Png).map_err(PageError::Encode)?;
    Ok(bytes.into_inner())
}
