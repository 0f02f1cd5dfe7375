//! A page as PDF (1.7): paths stay paths, text stays text, and groups are layers that a viewer switches.
//!
//! Groups that stand for something are optional content groups, nested as they are on the page, in the order of drawing
//! from the top; groups of one name side by side are one. Lettering is text in the embedded glyphs that it needs
//! ([`ttf::subset`]), each with the character that it stands for; a rim around letters is a path, so that no word is
//! found twice. A picture is written once, its transparency as a soft mask. The file holds no time and no random
//! number: one page gives one file.

mod content;
mod font;
mod pictures;

use crate::compress::deflated;
use crate::error::PageError;
use crate::format::{Content, FileFormat};
use crate::list::{DisplayList, write_vectors};
use content::{Layer, PageContent};
use font::PageFonts;
use pdf_writer::types::PageMode;
use pdf_writer::writers::Resources;
use pdf_writer::{Array, Filter, Finish, Name, Pdf, Rect, Ref, TextStr};

pub(crate) const PDF: FileFormat =
    FileFormat { name: "PDF", endings: &["pdf"], page: Some((Content::Paths, page)), animation: None };

fn page(list: &DisplayList, _: f64, title: &str) -> Result<Vec<u8>, PageError> {
    pdf(list, title)
}

/// What made the file.
const CREATOR: &str = concat!("Petroglyph ", env!("CARGO_PKG_VERSION"));

/// Writes a page as a PDF document; `title` is what readers announce.
///
/// ```
/// use page::list::{DisplayList, Group, GroupKind, Ink, Path, PathItem, Stroke};
/// use glam::DVec2;
///
/// let mut page = DisplayList::new(DVec2::splat(72.0));
/// let line = Path::line(&[DVec2::new(0.0, 36.0), DVec2::new(72.0, 36.0)]);
/// let group = Group::new(GroupKind::Horizon, "Top Chalk");
/// page.items.push(group.with([PathItem::stroked(line, Stroke::new(2.0, Ink::BLACK)).into()]).into());
///
/// let pdf = page::pdf(&page, "A rule").unwrap();
/// assert!(pdf.starts_with(b"%PDF-1.7"));
/// assert!(pdf.windows(17).any(|bytes| bytes == b"/Name (Top Chalk)"));
/// ```
///
/// # Errors
/// A picture that cannot be encoded.
pub fn pdf(list: &DisplayList, title: &str) -> Result<Vec<u8>, PageError> {
    list.faces.scope(|| written(list, title))
}

fn written(list: &DisplayList, title: &str) -> Result<Vec<u8>, PageError> {
    let mut refs = Refs::default();
    let [catalogue, pages, page, drawn, information] = [(); 5].map(|()| refs.next());
    let mut pdf = Pdf::new();
    let fonts = PageFonts::of(list);
    let mut content = PageContent::new(&fonts, list.size.y, &mut pdf, &mut refs);
    write_vectors(list, &mut content)?;
    let PageContent { content, layers, roots, opacities, pictures, .. } = content;
    describe(&mut pdf, catalogue, pages, &layers, &roots);
    pdf.document_info(information).title(TextStr(title)).creator(TextStr(CREATOR)).producer(TextStr(CREATOR));
    pdf.pages(pages).kids([page]).count(1);
    let mut described = pdf.page(page);
    described.parent(pages).contents(drawn);
    described.media_box(Rect::new(0.0, 0.0, list.size.x as f32, list.size.y as f32));
    // Colours are mixed as they are encoded.
    described.group().transparency().color_space().device_rgb();
    let faces: Vec<Ref> = (0..fonts.count()).map(|_| refs.next()).collect();
    resources(&mut described.resources(), &layers, &opacities, &pictures, &faces);
    described.finish();
    fonts.write(&mut pdf, &faces, &mut refs);
    pdf.stream(drawn, &deflated(&content.finish())).filter(Filter::FlateDecode);
    Ok(pdf.finish())
}

/// Writes the catalogue, and what a viewer switches.
fn describe(pdf: &mut Pdf, catalogue: Ref, pages: Ref, layers: &[Layer], roots: &[usize]) {
    let mut described = pdf.catalog(catalogue);
    described.pages(pages).viewer_preferences().display_doc_title(true);
    if !layers.is_empty() {
        described.page_mode(PageMode::UseOC);
        let mut optional = described.insert(Name(b"OCProperties")).dict();
        optional.insert(Name(b"OCGs")).array().items(layers.iter().map(|layer| layer.id));
        let mut shown = optional.insert(Name(b"D")).dict();
        shown.pair(Name(b"Name"), TextStr("Layers"));
        order(&mut shown.insert(Name(b"Order")).array(), roots, layers);
    }
    described.finish();
    for (number, layer) in layers.iter().enumerate() {
        let mut group = pdf.indirect(layer.id).dict();
        group.pair(Name(b"Type"), Name(b"OCG")).pair(Name(b"Name"), TextStr(&layer.name));
        // MuPDF takes groups that say the same for one: a layer and its entry in the legend have the same name.
        let mut usage = group.insert(Name(b"Usage")).dict();
        let mut creator = usage.insert(Name(b"CreatorInfo")).dict();
        let kind = content::name('L', number);
        creator.pair(Name(b"Creator"), TextStr(CREATOR)).pair(Name(b"Subtype"), Name(kind.as_bytes()));
    }
}

/// Lists what the page's operators name.
fn resources(into: &mut Resources, layers: &[Layer], opacities: &[u16], pictures: &[Ref], faces: &[Ref]) {
    if !layers.is_empty() {
        let mut named = into.insert(Name(b"Properties")).dict();
        for (number, layer) in layers.iter().enumerate() {
            named.pair(Name(content::name('L', number).as_bytes()), layer.id);
        }
    }
    if !opacities.is_empty() {
        let mut states = into.ext_g_states();
        for (number, opacity) in opacities.iter().enumerate() {
            let mut state = states.insert(Name(content::name('G', number).as_bytes())).dict();
            let share = f32::from(*opacity) / 1000.0;
            state.pair(Name(b"ca"), share).pair(Name(b"CA"), share);
        }
    }
    if !pictures.is_empty() {
        let mut named = into.x_objects();
        for (number, picture) in pictures.iter().enumerate() {
            named.pair(Name(content::name('P', number).as_bytes()), *picture);
        }
    }
    if !faces.is_empty() {
        let mut named = into.fonts();
        for (number, face) in faces.iter().enumerate() {
            named.pair(Name(content::name('F', number).as_bytes()), *face);
        }
    }
}

/// The layers as a viewer lists them: what lies on top first, with what is in it below.
fn order(list: &mut Array, which: &[usize], layers: &[Layer]) {
    for index in which.iter().rev() {
        let layer = &layers[*index];
        list.item(layer.id);
        if !layer.inner.is_empty() {
            order(&mut list.push().array(), &layer.inner, layers);
        }
    }
}

/// Numbers of objects, from 1.
#[derive(Default)]
struct Refs {
    last: i32,
}

impl Refs {
    fn next(&mut self) -> Ref {
        self.last += 1;
        Ref::new(self.last)
    }
}

#[cfg(test)]
mod tests;
