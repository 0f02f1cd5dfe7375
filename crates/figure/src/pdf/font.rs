//! The lettering's face in the file: the glyphs that are used, how wide they are, and what they stand for.
//!
//! Every character of the page has a number of its own (a CID) from 1. Characters that the face lacks share the glyph
//! of the missing-glyph box and are still found as what they are.

use super::Refs;
use crate::compress::deflated;
use crate::list::DisplayList;
use pdf_writer::types::{CidFontType, FontFlags, SystemInfo, UnicodeCmap};
use pdf_writer::{Filter, Finish, Name, Pdf, Rect, Ref, Str};
use std::collections::BTreeSet;
use ttf::subset::{FontSubset, font_of};

/// Codes are two bytes that are the number of a character.
const ENCODING: Name = Name(b"Identity-H");
const IDENTITY: SystemInfo = SystemInfo { registry: Str(b"Adobe"), ordering: Str(b"Identity"), supplement: 0 };
/// Height of capital letters and thickness of stems, thousandths of an em.
const CAPITALS: f32 = 693.0;
const STEM: f32 = 64.0;

/// The face of a page.
pub(super) struct PageFont {
    /// The characters of the page; their numbers are their places here, from 1.
    characters: Vec<char>,
    subset: FontSubset,
    /// The name of the face behind six letters that mark the subset.
    name: String,
}

impl PageFont {
    /// The face with all that a page says.
    pub(super) fn of(list: &DisplayList) -> Self {
        let characters: BTreeSet<char> = list.characters();
        let subset = font_of(&characters);
        // Another subset has other letters, so that joined documents keep both.
        let mut mark = subset.file.iter().fold(0u32, |mark, byte| mark.wrapping_mul(31).wrapping_add(u32::from(*byte)));
        let mut name = String::new();
        for _ in 0..6 {
            name.push(char::from(b'A' + (mark % 26) as u8));
            mark /= 26;
        }
        name.push_str("+Ubuntu-Light");
        Self { characters: characters.into_iter().collect(), subset, name }
    }

    /// Whether there is no text.
    pub(super) fn is_empty(&self) -> bool {
        self.characters.is_empty()
    }

    /// A line as codes, in the order in which it is seen.
    pub(super) fn encoded(&self, text: &str) -> Vec<u8> {
        let number = |character| self.characters.binary_search(&character).map_or(0, |place| place as u16 + 1);
        as_seen(text).into_iter().flat_map(|character| number(character).to_be_bytes()).collect()
    }

    /// Writes the face as object `id`.
    pub(super) fn write(&self, pdf: &mut Pdf, id: Ref, refs: &mut Refs) {
        let name = Name(self.name.as_bytes());
        let [descendant, descriptor, file, meanings, places] = [(); 5].map(|()| refs.next());
        pdf.type0_font(id)
            .base_font(name)
            .encoding_predefined(ENCODING)
            .descendant_font(descendant)
            .to_unicode(meanings);
        let glyphs: Vec<u16> = [0].into_iter().chain(self.characters.iter().map(|c| self.subset.glyphs[c])).collect();
        let advance = |glyph: &u16| f32::from(self.subset.advances[usize::from(*glyph)]);
        let mut face = pdf.cid_font(descendant);
        face.subtype(CidFontType::Type2).base_font(name).system_info(IDENTITY).font_descriptor(descriptor);
        face.default_width(0.0).cid_to_gid_map_stream(places).widths().consecutive(0, glyphs.iter().map(advance));
        face.finish();
        let bounds = self.subset.bounds.map(f32::from);
        let [ascent, descent] = self.subset.heights.map(f32::from);
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
        for (place, character) in self.characters.iter().enumerate().filter(|(_, c)| !c.is_control()) {
            map.pair(place as u16 + 1, *character);
        }
        pdf.stream(meanings, &deflated(&map.finish())).filter(Filter::FlateDecode);
    }
}

/// A line from left to right: words of scripts that run from right to left are turned round, since readers of text turn
/// them again. The face has none of these letters, and their boxes look the same in either order.
fn as_seen(text: &str) -> Vec<char> {
    let mut characters: Vec<char> = text.chars().collect();
    let mut begin = 0;
    while let Some(first) = characters[begin..].iter().position(|c| is_right_to_left(*c)).map(|at| begin + at) {
        // As far as the last such word that only blanks part from the one before.
        let length = characters[first..].iter().take_while(|c| is_right_to_left(**c) || c.is_whitespace()).count();
        let word = characters[first..first + length].iter().rposition(|c| is_right_to_left(*c)).map_or(1, |at| at + 1);
        characters[first..first + word].reverse();
        begin = first + word;
    }
    characters
}

/// Whether a character belongs to a script that is written from right to left: Hebrew, Arabic and their neighbours.
fn is_right_to_left(character: char) -> bool {
    matches!(character, '\u{590}'..='\u{8ff}' | '\u{fb1d}'..='\u{fdff}' | '\u{fe70}'..='\u{feff}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_that_run_from_right_to_left_are_turned_round_where_they_stand() {
        let seen = |text: &str| as_seen(text).into_iter().collect::<String>();
        assert_eq!(seen("Top Chalk, 2 m"), "Top Chalk, 2 m");
        assert_eq!(seen("a \u{5d0}\u{5d1} \u{5d2} b \u{5d3}\u{5d4}"), "a \u{5d2} \u{5d1}\u{5d0} b \u{5d4}\u{5d3}");
        assert_eq!(seen(""), "");
    }
}
