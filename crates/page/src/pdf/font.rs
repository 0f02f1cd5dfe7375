//! The lettering's faces in the file: the glyphs that are used, how wide they are, and what they stand for.
//!
//! Each glyph has a number of its own (a CID) from 1 for each text that it stands for: characters that all faces lack
//! share the missing-glyph box and are still found as what they are, and a letter is found as the same letter whatever
//! form its neighbours give it. Glyphs are written in the order in which they are seen; readers of text turn words of
//! scripts that run from right to left round.

use super::Refs;
use crate::compress::deflated;
use crate::list::{DisplayList, Text};
use glam::DVec2;
use pdf_writer::types::{CidFontType, FontFlags, SystemInfo, UnicodeCmap};
use pdf_writer::{Filter, Finish, Name, Pdf, Rect, Ref, Str};
use std::collections::BTreeMap;
use ttf::subset::{FontSubset, used};
use ttf::text::{Glyph, set};

/// Codes are two bytes that are the number of a glyph.
const ENCODING: Name = Name(b"Identity-H");
const IDENTITY: SystemInfo = SystemInfo { registry: Str(b"Adobe"), ordering: Str(b"Identity"), supplement: 0 };
/// Height of capital letters and thickness of stems, thousandths of an em.
const CAPITALS: f32 = 693.0;
const STEM: f32 = 64.0;

/// The faces of a page.
pub(super) struct PageFonts {
    faces: Vec<PageFace>,
}

/// A face of a page.
pub(super) struct PageFace {
    /// Its number among the faces of lettering.
    number: usize,
    /// The number of each glyph that stands for a text; in order, from 1.
    codes: BTreeMap<(String, u16), u16>,
    subset: FontSubset,
    /// The name of the face behind six letters that mark the subset.
    name: String,
}

/// Glyphs of one face that follow one another as wide as they are.
pub(super) struct Shown {
    /// The face, by its place in the file.
    pub(super) face: usize,
    /// The left end of the first glyph's baseline, from that of the line, which runs to the right; y down.
    pub(super) at: DVec2,
    /// Their codes.
    pub(super) codes: Vec<u8>,
}

impl PageFonts {
    /// The faces with all that a page says.
    pub(super) fn of(list: &DisplayList) -> Self {
        let lines = list.lines();
        let mut faces = Vec::new();
        for used in used(lines.iter().map(String::as_str)) {
            let Some(subset) = used.file() else { continue };
            let family: String = used.face.family().chars().filter(char::is_ascii_alphanumeric).collect();
            let family = if used.number == 0 { "Ubuntu-Light" } else { &family };
            let name = format!("{}+{family}", mark(&subset.file));
            faces.push(PageFace { number: used.number, codes: BTreeMap::new(), subset, name });
        }
        for text in &lines {
            for glyph in set(text).glyphs {
                if let Some(face) = faces.iter_mut().find(|face| face.number == glyph.face) {
                    face.codes.insert((text[glyph.said].to_owned(), glyph.id), 0);
                }
            }
        }
        for face in &mut faces {
            face.codes.values_mut().zip(1..).for_each(|(code, place)| *code = place);
        }
        Self { faces }
    }

    /// How many there are.
    pub(super) fn count(&self) -> usize {
        self.faces.len()
    }

    /// A straight line as codes, in the order in which it is seen.
    pub(super) fn shown(&self, line: &Text) -> Vec<Shown> {
        let mut shown: Vec<Shown> = Vec::new();
        let mut end = DVec2::ZERO;
        for glyph in set(&line.text).glyphs {
            let Some(face) = self.faces.iter().position(|face| face.number == glyph.face) else { continue };
            let at = DVec2::new(f64::from(glyph.at[0]), -f64::from(glyph.at[1])) * line.size;
            let code = self.faces[face].code(&line.text, &glyph).to_be_bytes();
            match shown.last_mut() {
                // To a hundredth of a point, as places are written.
                Some(last) if last.face == face && (at - end).length() < 0.005 => last.codes.extend(code),
                _ => shown.push(Shown { face, at, codes: code.to_vec() }),
            }
            end = at + DVec2::new(f64::from(glyph.advance) * line.size, 0.0);
        }
        shown
    }

    /// Writes the faces as these objects.
    pub(super) fn write(&self, pdf: &mut Pdf, ids: &[Ref], refs: &mut Refs) {
        self.faces.iter().zip(ids).for_each(|(face, id)| face.write(pdf, *id, refs));
    }
}

/// Six letters that mark a subset: another one has other letters, so that joined documents keep both.
fn mark(file: &[u8]) -> String {
    let mut mark = file.iter().fold(0u32, |mark, byte| mark.wrapping_mul(31).wrapping_add(u32::from(*byte)));
    let mut letters = String::new();
    for _ in 0..6 {
        letters.push(char::from(b'A' + (mark % 26) as u8));
        mark /= 26;
    }
    letters
}

impl PageFace {
    fn code(&self, text: &str, glyph: &Glyph) -> u16 {
        self.codes.get(&(text[glyph.said.clone()].to_owned(), glyph.id)).copied().unwrap_or(0)
    }

    /// Writes the face as object `id`.
    fn write(&self, pdf: &mut Pdf, id: Ref, refs: &mut Refs) {
        let name = Name(self.name.as_bytes());
        let [descendant, descriptor, file, meanings, places] = [(); 5].map(|()| refs.next());
        pdf.type0_font(id)
            .base_font(name)
            .encoding_predefined(ENCODING)
            .descendant_font(descendant)
            .to_unicode(meanings);
        let number = |glyph: &u16| self.subset.numbers.get(glyph).copied().unwrap_or(0);
        let glyphs: Vec<u16> = [0].into_iter().chain(self.codes.keys().map(|(_, glyph)| number(glyph))).collect();
        let advance = |glyph: &u16| self.subset.advances.get(usize::from(*glyph)).copied().unwrap_or(0.0);
        let mut face = pdf.cid_font(descendant);
        face.subtype(CidFontType::Type2).base_font(name).system_info(IDENTITY).font_descriptor(descriptor);
        face.default_width(0.0).cid_to_gid_map_stream(places).widths().consecutive(0, glyphs.iter().map(advance));
        face.finish();
        let bounds = self.subset.bounds;
        let [ascent, descent] = self.subset.heights;
        pdf.font_descriptor(descriptor)
            .name(name)
            .flags(FontFlags::SYMBOLIC)
            .bbox(Rect::new(bounds[0], bounds[1], bounds[2], bounds[3]))
            .italic_angle(0.0)
            .ascent(ascent)
            .descent(descent)
            .cap_height(CAPITALS)
            .stem_v(STEM)
            .font_file2(file);
        let bytes = deflated(&self.subset.file);
        let mut stream = pdf.stream(file, &bytes);
        stream.filter(Filter::FlateDecode).pair(Name(b"Length1"), self.subset.file.len() as i32);
        stream.finish();
        let places_of_glyphs: Vec<u8> = glyphs.iter().flat_map(|glyph| glyph.to_be_bytes()).collect();
        pdf.stream(places, &deflated(&places_of_glyphs)).filter(Filter::FlateDecode);
        let mut map = UnicodeCmap::new(Name(b"Petroglyph"), IDENTITY);
        for ((said, _), code) in self.codes.iter().filter(|((said, _), _)| !said.chars().any(char::is_control)) {
            map.pair_with_multiple(*code, said.chars());
        }
        pdf.stream(meanings, &deflated(&map.finish())).filter(Filter::FlateDecode);
    }
}
