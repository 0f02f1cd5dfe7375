//! What is drawn on a page, as operators: the page's points with y down, turned over once at the beginning.

use super::font::PageFonts;
use super::{Refs, pictures};
use crate::error::PageError;
use crate::list::{
    Cap, Group, GroupKind, Ink, KnownPictures, Path, PathItem, Picture, Rule, Segment, Stroke, Text, VectorWriter,
};
use glam::DVec2;
use pdf_writer::types::{LineCapStyle, LineJoinStyle};
use pdf_writer::{Content, Name, Pdf, Ref, Str, TextStr};

/// A letter from left to right without ink (the left-to-right mark).
const END_OF_STRETCH: char = '\u{200e}';

/// What a viewer switches: the groups of one kind and name within one other group. Where faces of a block hide one
/// another, a layer is drawn in several groups.
pub(super) struct Layer {
    pub(super) id: Ref,
    kind: GroupKind,
    pub(super) name: String,
    /// Groups in it, by index.
    pub(super) inner: Vec<usize>,
}

/// A page being written.
pub(super) struct PageContent<'a> {
    pub(super) content: Content,
    /// All groups that a viewer switches, as they begin.
    pub(super) layers: Vec<Layer>,
    /// Those that lie in no other one.
    pub(super) roots: Vec<usize>,
    /// Opacities below 1 in thousandths; a graphics state each.
    pub(super) opacities: Vec<u16>,
    /// The pictures' objects.
    pub(super) pictures: Vec<Ref>,
    known: KnownPictures,
    /// Layers that began and have not ended.
    open: Vec<usize>,
    fonts: &'a PageFonts,
    pdf: &'a mut Pdf,
    refs: &'a mut Refs,
}

/// The name of a resource: what it is and its number.
pub(super) fn name(kind: char, number: usize) -> String {
    format!("{kind}{number}")
}

impl<'a> PageContent<'a> {
    pub(super) fn new(fonts: &'a PageFonts, height: f64, pdf: &'a mut Pdf, refs: &'a mut Refs) -> Self {
        let mut content = Content::new();
        content.transform([1.0, 0.0, 0.0, -1.0, 0.0, height as f32]).set_line_join(LineJoinStyle::RoundJoin);
        Self {
            content,
            layers: Vec::new(),
            roots: Vec::new(),
            opacities: Vec::new(),
            pictures: Vec::new(),
            known: KnownPictures::default(),
            open: Vec::new(),
            fonts,
            pdf,
            refs,
        }
    }

    /// The layer of a group that begins here.
    fn layer(&mut self, group: &Group) -> usize {
        let outer = self.open.last().copied();
        let beside = outer.map_or(&self.roots, |outer| &self.layers[outer].inner);
        let is_same = |index: &usize| {
            let layer = &self.layers[*index];
            layer.kind == group.kind && layer.name == group.title()
        };
        if let Some(known) = beside.iter().copied().find(is_same) {
            return known;
        }
        let index = self.layers.len();
        self.layers.push(Layer {
            id: self.refs.next(),
            kind: group.kind,
            name: group.title().into_owned(),
            inner: Vec::new(),
        });
        match outer {
            Some(outer) => self.layers[outer].inner.push(index),
            None => self.roots.push(index),
        }
        index
    }

    fn trace(&mut self, path: &Path) {
        for segment in &path.segments {
            match segment {
                Segment::Move(p) => self.content.move_to(number(p.x), number(p.y)),
                Segment::Line(p) => self.content.line_to(number(p.x), number(p.y)),
                Segment::Cubic(a, b, c) => {
                    self.content.cubic_to(number(a.x), number(a.y), number(b.x), number(b.y), number(c.x), number(c.y))
                }
                Segment::Close => self.content.close_path(),
            };
        }
    }

    /// Sets the opacity of what follows, in a graphics state of its own that the caller leaves.
    fn opacity(&mut self, opacity: f32) {
        let thousandths = (opacity.clamp(0.0, 1.0) * 1000.0).round() as u16;
        if thousandths < 1000 {
            let known = self.opacities.iter().position(|known| *known == thousandths);
            let number = known.unwrap_or_else(|| {
                self.opacities.push(thousandths);
                self.opacities.len() - 1
            });
            self.content.set_parameters(Name(name('G', number).as_bytes()));
        }
    }

    fn stroke(&mut self, path: &Path, stroke: &Stroke) {
        self.content.save_state();
        self.opacity(stroke.ink.opacity);
        let [r, g, b] = channels(stroke.ink);
        self.content.set_stroke_rgb(r, g, b).set_line_width(thousandths(stroke.width));
        if stroke.cap == Cap::Round {
            self.content.set_line_cap(LineCapStyle::RoundCap);
        }
        if stroke.dashes.iter().sum::<f64>() > 0.0 {
            self.content.set_dash_pattern(stroke.dashes.iter().map(|dash| thousandths(*dash)), 0.0);
        }
        self.trace(path);
        self.content.stroke().restore_state();
    }
}

impl VectorWriter for PageContent<'_> {
    fn begin(&mut self, group: &Group) {
        if group.kind != GroupKind::Part {
            let index = self.layer(group);
            self.open.push(index);
            let named = name('L', index);
            self.content.begin_marked_content_with_properties(Name(b"OC")).properties_named(Name(named.as_bytes()));
        }
        if let Some(clip) = &group.clip {
            self.content.save_state();
            self.trace(clip);
            self.content.clip_nonzero().end_path();
        }
    }

    fn end(&mut self, group: &Group) {
        if group.clip.is_some() {
            self.content.restore_state();
        }
        if group.kind != GroupKind::Part {
            self.open.pop();
            self.content.end_marked_content();
        }
    }

    fn path(&mut self, item: &PathItem) {
        if let Some(ink) = item.fill {
            let is_glass = ink.opacity < 1.0;
            if is_glass {
                self.content.save_state();
                self.opacity(ink.opacity);
            }
            let [r, g, b] = channels(ink);
            self.content.set_fill_rgb(r, g, b);
            self.trace(&item.path);
            match item.rule {
                Rule::NonZero => self.content.fill_nonzero(),
                Rule::EvenOdd => self.content.fill_even_odd(),
            };
            if is_glass {
                self.content.restore_state();
            }
        }
        if let Some(stroke) = item.stroke.as_ref().filter(|stroke| stroke.is_seen()) {
            self.stroke(&item.path, stroke);
        }
    }

    fn text(&mut self, line: &Text) {
        if let Some((path, stroke)) = line.rim() {
            self.stroke(&path, &stroke);
        }
        let [r, g, b] = channels(line.ink);
        self.content.save_state();
        self.opacity(line.ink.opacity);
        let is_skew = !line.letters.is_empty() || line.turn_deg.rem_euclid(90.0) != 0.0;
        let runs_left = line.text.chars().any(is_right_to_left);
        // Letters one by one, or on a slope, are still one word to readers, and so are joined letters. The standard asks
        // for a word as it is written; poppler and PDFium take the inner span, and turn what runs from right to left round.
        let inner = runs_left.then(|| turned_round(&line.text));
        let outer = (is_skew || runs_left).then_some(&line.text);
        let spans: Vec<&String> = outer.into_iter().chain(&inner).collect();
        for said in &spans {
            let mut span = self.content.begin_marked_content_with_properties(Name(b"Span"));
            span.properties().actual_text(TextStr(said));
        }
        self.content.set_fill_rgb(r, g, b).begin_text();
        let mut pieces = line.straight();
        if runs_left {
            // Readers place a span from its first letter in the file to its last.
            pieces.sort_by(|a, b| a.at.x.total_cmp(&b.at.x));
        }
        let mut face = None;
        for straight in pieces {
            let (start, along) = straight.baseline();
            // Letters stand upright where y points down.
            let [x, y] = along.to_array().map(|part| (part * 1e6).round() as f32 / 1e6);
            for shown in self.fonts.shown(&straight) {
                if face.replace(shown.face) != Some(shown.face) {
                    let named = name('F', shown.face);
                    self.content.set_font(Name(named.as_bytes()), thousandths(line.size));
                }
                let at = start + along.rotate(shown.at);
                self.content.set_text_matrix([x, y, y, -x, number(at.x), number(at.y)]);
                self.content.show(Str(&shown.codes));
            }
        }
        self.content.end_text();
        for _ in spans {
            self.content.end_marked_content();
        }
        self.content.restore_state();
    }

    /// A picture: a square of one unit, laid on its parallelogram.
    fn picture(&mut self, picture: &Picture) -> Result<(), PageError> {
        let (number, is_new) = self.known.number(picture);
        if is_new {
            self.pictures.push(pictures::write(picture, self.pdf, self.refs)?);
        }
        // The unit square has its first row of pixels at the upper edge.
        let DVec2 { x, y } = picture.corner + picture.down;
        let (right, up) = (picture.right, -picture.down);
        let matrix = [right.x, right.y, up.x, up.y, x, y].map(|part| (part * 1e4).round() as f32 / 1e4);
        let named = name('P', number);
        self.content.save_state().transform(matrix).x_object(Name(named.as_bytes())).restore_state();
        Ok(())
    }
}

/// Whether a character is of a script that runs from right to left (Unicode blocks of such scripts).
fn is_right_to_left(character: char) -> bool {
    matches!(character, '\u{590}'..='\u{8ff}' | '\u{fb1d}'..='\u{fdff}' | '\u{fe70}'..='\u{fefc}' | '\u{10800}'..='\u{10fff}' | '\u{1e800}'..='\u{1efff}')
}

/// A line as it is written, but each stretch from a letter that runs from right to left to the last one before others
/// turned round. A mark that is not seen (U+200E) ends such a stretch: blanks behind it do not belong to it.
pub(super) fn turned_round(text: &str) -> String {
    let is_other = |c: char| (c.is_alphabetic() || c.is_numeric()) && !is_right_to_left(c);
    let mut turned = String::with_capacity(text.len());
    let mut left = text;
    while let Some(begin) = left.find(is_right_to_left) {
        let run = &left[begin..];
        let run = &run[..run.find(is_other).unwrap_or(run.len())];
        let end = begin + run.trim_end_matches(|c| !is_right_to_left(c)).len();
        turned.push_str(&left[..begin]);
        turned.extend(left[begin..end].chars().rev());
        left = &left[end..];
        if !left.is_empty() && !left.starts_with(END_OF_STRETCH) {
            turned.push(END_OF_STRETCH);
        }
    }
    turned + left
}

/// A coordinate to a hundredth of a point, as in SVG.
fn number(value: f64) -> f32 {
    ((value * 100.0).round() / 100.0) as f32
}

/// A length to a thousandth of a point.
fn thousandths(value: f64) -> f32 {
    ((value * 1000.0).round() / 1000.0) as f32
}

/// A colour as shares of its channels, to a ten-thousandth.
fn channels(ink: Ink) -> [f32; 3] {
    ink.colour.rgb.map(|channel| (f32::from(channel) / 255.0 * 1e4).round() / 1e4)
}
