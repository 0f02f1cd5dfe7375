//! A page as SVG: paths stay paths, text stays text, and groups are layers with names.
//!
//! Groups that stand for something have an `id` and are layers in Inkscape (`inkscape:groupmode`), so that a reader can
//! switch a layer or fault off. Each picture is written once, as PNG inside the file, and used where it is seen. Clips
//! are definitions that groups refer to. The glyphs that the page needs are embedded as fonts ([`ttf::subset`]), with the
//! rules of faces whose letters join, so that browsers show the same letters everywhere; programs that know no fonts in
//! files take installed ones, in the same length. Coordinates are points to a hundredth, relative from step to step.

mod numbers;
mod text;

use crate::error::PageError;
use crate::format::{Content, FileFormat};
use crate::list::{
    Cap, DisplayList, Group, GroupKind, Ink, KnownPictures, PathItem, Picture, Rule, Sampling, Stroke, Text,
    VectorWriter, png, write_vectors,
};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use image::RgbaImage;
use numbers::{decimals, number, steps};
use std::collections::HashMap;
use std::fmt::Write;
use text::{escaped, text};

pub(crate) const SVG: FileFormat =
    FileFormat { name: "SVG", endings: &["svg"], page: Some((Content::Paths, page)), animation: None };

fn page(list: &DisplayList, _: f64, title: &str) -> Result<Vec<u8>, PageError> {
    svg(list, title).map(String::into_bytes)
}

/// Writes a page as an SVG document; `title` is what readers announce.
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
/// let svg = page::svg(&page, "A rule").unwrap();
/// assert!(svg.contains(r#"id="horizon-top-chalk""#) && svg.contains(r#"d="M0 36h72""#));
/// ```
///
/// # Errors
/// A picture that cannot be encoded.
pub fn svg(list: &DisplayList, title: &str) -> Result<String, PageError> {
    list.faces.scope(|| written(list, title))
}

fn written(list: &DisplayList, title: &str) -> Result<String, PageError> {
    let mut writer = Writer::default();
    writer.families = text::faces(&mut writer.definitions, list);
    write_vectors(list, &mut writer)?;
    let [width, height] = [number(list.size.x), number(list.size.y)];
    let Writer { body, definitions, .. } = writer;
    let mut svg = String::with_capacity(body.len() + definitions.len() + 1000);
    svg.push_str("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    let _ = writeln!(
        svg,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" \
         width=\"{width}pt\" height=\"{height}pt\" viewBox=\"0 0 {width} {height}\">\n<title>{}</title>",
        escaped(title)
    );
    if !definitions.is_empty() {
        let _ = writeln!(svg, "<defs>\n{definitions}</defs>");
    }
    svg.push_str(&body);
    svg.push_str("</svg>\n");
    Ok(svg)
}

/// A document being written.
#[derive(Default)]
struct Writer {
    body: String,
    /// The faces, clips and pictures.
    definitions: String,
    /// The faces by name.
    families: String,
    clips: usize,
    /// How often each name of a group was used.
    names: HashMap<String, usize>,
    pictures: KnownPictures,
}

impl VectorWriter for Writer {
    fn begin(&mut self, group: &Group) {
        self.body.push_str("<g");
        if group.kind != GroupKind::Part {
            let id = self.id(group);
            let label = escaped(&group.title());
            let _ = write!(self.body, " id=\"{id}\" inkscape:groupmode=\"layer\" inkscape:label=\"{label}\"");
        }
        if let Some(clip) = &group.clip {
            self.clips += 1;
            let _ = writeln!(
                self.definitions,
                "<clipPath id=\"clip-{}\"><path d=\"{}\"/></clipPath>",
                self.clips,
                steps(clip)
            );
            let _ = write!(self.body, " clip-path=\"url(#clip-{})\"", self.clips);
        }
        self.body.push_str(">\n");
    }

    fn end(&mut self, _: &Group) {
        self.body.push_str("</g>\n");
    }

    fn path(&mut self, item: &PathItem) {
        let _ = write!(self.body, "<path d=\"{}\"", steps(&item.path));
        match item.fill {
            Some(ink) => {
                attribute(&mut self.body, "fill", ink);
                if item.rule == Rule::EvenOdd {
                    self.body.push_str(" fill-rule=\"evenodd\"");
                }
            }
            None => self.body.push_str(" fill=\"none\""),
        }
        if let Some(stroke) = &item.stroke {
            self.stroke(stroke);
        }
        self.body.push_str("/>\n");
    }

    fn text(&mut self, line: &Text) {
        text(&mut self.body, line, &self.families);
    }

    /// A picture: a square of one unit, laid on its parallelogram.
    fn picture(&mut self, picture: &Picture) -> Result<(), PageError> {
        let (known, is_new) = self.pictures.number(picture);
        let number = known + 1;
        if is_new {
            let png = STANDARD.encode(png(&RgbaImage::clone(&picture.pixels).into())?);
            let rendering = match picture.sampling {
                Sampling::Smooth => "",
                Sampling::Nearest => " image-rendering=\"optimizeSpeed\" style=\"image-rendering:pixelated\"",
            };
            let _ = writeln!(
                self.definitions,
                "<image id=\"picture-{number}\" width=\"1\" height=\"1\" preserveAspectRatio=\"none\"{rendering} \
                 href=\"data:image/png;base64,{png}\"/>"
            );
        }
        let matrix = [picture.right.x, picture.right.y, picture.down.x, picture.down.y]
            .into_iter()
            .chain([picture.corner.x, picture.corner.y])
            .map(|part| format!("{part:.4}"));
        let matrix = matrix.collect::<Vec<_>>().join(" ");
        let _ = writeln!(self.body, "<use href=\"#picture-{number}\" transform=\"matrix({matrix})\"/>");
        Ok(())
    }
}

impl Writer {
    /// An identifier from the kind and name of a group, with a number where it was used before.
    fn id(&mut self, group: &Group) -> String {
        let kind = match group.kind {
            GroupKind::Panel => "panel",
            GroupKind::Data => "data",
            GroupKind::Layer => "layer",
            GroupKind::Horizon => "horizon",
            GroupKind::Fault => "fault",
            GroupKind::Well => "well",
            GroupKind::Annotation | GroupKind::Leader | GroupKind::Part => "annotation",
        };
        // Letters of every script may stand in an identifier; what else a name holds becomes a hyphen.
        let letters = group.title().to_lowercase();
        let words: Vec<&str> = letters.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).collect();
        let id = [kind].into_iter().chain(words).collect::<Vec<_>>().join("-");
        let used = self.names.entry(id.clone()).or_default();
        *used += 1;
        if *used == 1 { id } else { format!("{id}-{used}") }
    }

    fn stroke(&mut self, stroke: &Stroke) {
        attribute(&mut self.body, "stroke", stroke.ink);
        let _ = write!(self.body, " stroke-width=\"{}\" stroke-linejoin=\"round\"", number(stroke.width));
        if stroke.cap == Cap::Round {
            self.body.push_str(" stroke-linecap=\"round\"");
        }
        if !stroke.dashes.is_empty() {
            let dashes: Vec<String> = stroke.dashes.iter().map(|dash| number(*dash)).collect();
            let _ = write!(self.body, " stroke-dasharray=\"{}\"", dashes.join(" "));
        }
    }
}

/// A colour, and its opacity where it is not opaque.
fn attribute(into: &mut String, what: &str, ink: Ink) {
    let [r, g, b] = ink.colour.rgb;
    let _ = write!(into, " {what}=\"#{r:02x}{g:02x}{b:02x}\"");
    if ink.opacity < 1.0 {
        let _ = write!(into, " {what}-opacity=\"{}\"", decimals(f64::from(ink.opacity), 3));
    }
}

#[cfg(test)]
mod tests;
