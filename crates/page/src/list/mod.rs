//! A page as data: paths, text and images in points, in named groups.
//!
//! A [`DisplayList`] knows nothing of the file it ends in. Pixels ([`crate::raster()`]), vectors and the
//! window's preview are back ends that draw the same list, item after item, later ones over earlier ones.
//!
//! Space: points of 1/72 inch from the page's upper left corner, x right, y down. Colours are sRGB and are
//! composited as they are encoded, as PNG, SVG and PDF viewers do.

mod ink_colours;
mod path;
mod picture;
mod text;
mod vectors;

pub use path::{Cap, Ink, Path, PathItem, Rule, Segment, Stroke};
pub use picture::{Picture, Sampling};
pub use text::{Across, Anchor, Halo, Letter, Text, Upright, width_of};
pub(crate) use vectors::{KnownPictures, VectorWriter, png, write_vectors};

use crate::Rect;
use glam::DVec2;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use ttf::text::Faces;

/// Points in an inch.
pub const POINTS_PER_INCH: f64 = 72.0;
/// Points in a millimetre.
pub const POINTS_PER_MM: f64 = POINTS_PER_INCH / 25.4;

/// A page: its size and what is on it, back to front.
///
/// ```
/// use page::list::{DisplayList, Ink, Item, Path, PathItem, Stroke};
/// use glam::DVec2;
///
/// // A rule of two points across a page of one square inch.
/// let mut page = DisplayList::new(DVec2::splat(72.0));
/// let rule = Path::line(&[DVec2::new(0.0, 36.0), DVec2::new(72.0, 36.0)]);
/// page.items.push(PathItem::stroked(rule, Stroke::new(2.0, Ink::BLACK)).into());
///
/// // At 72 dpi that is 72 pixels by 2.
/// let pixels = page::raster(&page, 72.0).unwrap();
/// assert_eq!(pixels.pixels().filter(|pixel| pixel.0 == [0, 0, 0, 255]).count(), 144);
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DisplayList {
    /// Width and height.
    pub size: DVec2,
    /// What the page is made of; absent: nothing, so that a picture of it is transparent.
    pub paper: Option<Ink>,
    /// What is on it, back to front.
    pub items: Vec<Item>,
    /// The faces that its text was laid out in, and is drawn in; a page that was read has the embedded one.
    #[serde(skip)]
    pub faces: Faces,
}

impl DisplayList {
    /// An empty page on white paper, with the faces of this thread.
    pub fn new(size: DVec2) -> Self {
        Self { size, paper: Some(Ink::WHITE), items: Vec::new(), faces: Faces::current() }
    }

    /// The whole page.
    pub fn bounds(&self) -> Rect {
        Rect::new(DVec2::ZERO, self.size)
    }

    /// Every item that is not a group, in the order of drawing.
    pub fn leaves(&self) -> Vec<&Item> {
        fn gather<'a>(items: &'a [Item], into: &mut Vec<&'a Item>) {
            for item in items {
                match item {
                    Item::Group(group) => gather(&group.items, into),
                    leaf => into.push(leaf),
                }
            }
        }
        let mut leaves = Vec::new();
        gather(&self.items, &mut leaves);
        leaves
    }

    /// Every text on the page, in the order of drawing.
    pub fn texts(&self) -> Vec<&Text> {
        let texts = self.leaves().into_iter().filter_map(|item| match item {
            Item::Text(text) => Some(text),
            _ => None,
        });
        texts.collect()
    }

    /// The lines of text that are not blank, as they are set: letter by letter where a line is bent.
    pub(crate) fn lines(&self) -> Vec<String> {
        let said = self.texts().into_iter().filter(|text| !text.text.trim().is_empty());
        said.flat_map(|text| text.straight().into_iter().map(|line| line.text)).collect()
    }
}

/// Something on a page.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Item {
    /// A filled or stroked path.
    Path(PathItem),
    /// A line of text.
    Text(Text),
    /// An image.
    Picture(Picture),
    /// Items that belong together.
    Group(Group),
}

impl From<PathItem> for Item {
    fn from(path: PathItem) -> Self {
        Self::Path(path)
    }
}

impl From<Text> for Item {
    fn from(text: Text) -> Self {
        Self::Text(text)
    }
}

impl From<Picture> for Item {
    fn from(picture: Picture) -> Self {
        Self::Picture(picture)
    }
}

impl From<Group> for Item {
    fn from(group: Group) -> Self {
        Self::Group(group)
    }
}

/// Items that belong together under a name, which vector formats keep: what a reader can switch off or move
/// at once.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Group {
    /// What it stands for.
    pub kind: GroupKind,
    /// Its name, as a person gave it ("Top Chalk") or as a person would call it ("scale bar").
    pub name: String,
    /// Nothing outside is drawn; absent: all is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub clip: Option<Path>,
    /// What is in it, back to front.
    pub items: Vec<Item>,
}

impl Group {
    /// An empty group.
    pub fn new(kind: GroupKind, name: impl Into<String>) -> Self {
        Self { kind, name: name.into(), clip: None, items: Vec::new() }
    }

    /// The same with a clip.
    #[must_use]
    pub fn clipped(mut self, clip: Path) -> Self {
        self.clip = Some(clip);
        self
    }

    /// The same with these items.
    #[must_use]
    pub fn with(mut self, items: impl IntoIterator<Item = Item>) -> Self {
        self.items.extend(items);
        self
    }

    /// Adds an item on top.
    pub fn push(&mut self, item: impl Into<Item>) {
        self.items.push(item.into());
    }

    /// What a reader of the file sees as its name.
    pub(crate) fn title(&self) -> Cow<'_, str> {
        match self.kind {
            GroupKind::Leader => format!("leader to {}", self.name).into(),
            _ => self.name.as_str().into(),
        }
    }
}

/// What a group stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum GroupKind {
    /// One of the figure's parts: a block, a section, a map.
    Panel,
    /// Measured data: amplitudes, candidates.
    Data,
    /// A layer.
    Layer,
    /// A horizon.
    Horizon,
    /// A fault.
    Fault,
    /// A well.
    Well,
    /// What explains the rest: axes, legend, scale bar, title.
    Annotation,
    /// A name that stands beside what it names, with a line to it; the group is called as that is.
    Leader,
    /// A part of what the group around it stands for; nobody asks for it by name.
    Part,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_list_survives_being_written_and_read() {
        let mut page = DisplayList::new(DVec2::new(100.0, 50.0));
        let picture = image::RgbaImage::from_fn(2, 3, |x, y| image::Rgba([x as u8, y as u8, 7, 255]));
        let inner = Group::new(GroupKind::Horizon, "Top <Chalk> & \"co\"")
            .clipped(Path::rect(page.bounds()))
            .with([Text::new(DVec2::ONE, "Grès").into(), Picture::in_rect(picture, page.bounds()).into()]);
        page.items.push(inner.into());
        let read: DisplayList = serde_json::from_str(&serde_json::to_string(&page).unwrap()).unwrap();
        assert_eq!(read, page);
        assert_eq!(read.texts().len(), 1);
        assert_eq!(read.leaves().len(), 2);
    }
}
