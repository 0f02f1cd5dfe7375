//! The face of all lettering as a font file that holds only what a text needs, for files that carry their font along.
//!
//! The file is TrueType (ISO/IEC 14496-22): outlines without instructions, metrics, names, and a character map of
//! format 12. Glyphs are numbered anew, 0 is the missing-glyph box, and the parts of accented letters come last. The
//! face has no pairs of kerned letters in a `kern` table, so advances alone give the same lines as [`crate::text`].

use std::collections::{BTreeMap, BTreeSet};

use ab_glyph::Font;

/// A font file with the glyphs of some characters.
#[derive(Debug, Clone, PartialEq)]
pub struct FontSubset {
    /// The file.
    pub file: Vec<u8>,
    /// The glyph of each character; 0, the missing-glyph box, of a character that the face lacks.
    pub glyphs: BTreeMap<char, u16>,
    /// The advance of each glyph, thousandths of an em.
    pub advances: Vec<u16>,
    /// The rectangle around all letters of the face: left, bottom, right, top, thousandths of an em.
    pub bounds: [i16; 4],
    /// From the baseline up to the top of the tallest letters and, negative, down to the foot of the lowest ones,
    /// thousandths of an em.
    pub heights: [i16; 2],
}

/// The font file for these characters.
///
/// ```
/// let subset = ttf::subset::font_of(&['A', 'Ä'].into());
/// // The missing-glyph box, both letters, and the two dots of the second.
/// assert_eq!(subset.advances.len(), 4);
/// assert!(subset.file.len() < 5000);
/// ```
pub fn font_of(characters: &BTreeSet<char>) -> FontSubset {
    let font = Tables { file: epaint_default_fonts::UBUNTU_LIGHT };
    let face = crate::text::face();
    let mut numbers = Numbers { old: vec![0] };
    let glyphs: BTreeMap<char, u16> =
        characters.iter().map(|character| (*character, numbers.of(face.glyph_id(*character).0))).collect();
    let [mut outlines, mut places, mut metrics] = [const { Vec::new() }; 3];
    let mut advances = Vec::new();
    let all_metrics = font.table(b"hmtx");
    // The list grows while parts of accented letters are found.
    let mut next = 0;
    while let Some(old) = numbers.old.get(next).copied() {
        places.extend((outlines.len() as u32).to_be_bytes());
        outlines.extend(without_instructions(font.outline(old), &mut numbers));
        outlines.resize(outlines.len().next_multiple_of(4), 0);
        let metric = &all_metrics[4 * usize::from(old)..][..4];
        metrics.extend(metric);
        advances.push(u16_at(metric, 0));
        next += 1;
    }
    places.extend((outlines.len() as u32).to_be_bytes());
    let count = numbers.old.len() as u16;
    let head = font.changed(b"head", &[(8, 0), (10, 0), (50, 1)]);
    let bounds = [36, 38, 40, 42].map(|at| u16_at(&head, at) as i16);
    let hhea = font.changed(b"hhea", &[(34, count)]);
    let heights = [4, 6].map(|at| u16_at(&hhea, at) as i16);
    let mut post = font.table(b"post")[..32].to_vec();
    // Version 3: glyphs have no names.
    post[..4].copy_from_slice(&0x0003_0000u32.to_be_bytes());
    let tables = [
        (b"OS/2", font.table(b"OS/2").to_vec()),
        (b"cmap", character_map(&glyphs)),
        (b"glyf", outlines),
        (b"head", head),
        (b"hhea", hhea),
        (b"hmtx", metrics),
        (b"loca", places),
        // Glyphs, and no instructions, function definitions or storage for them.
        (b"maxp", font.changed(b"maxp", &[(4, count), (18, 0), (20, 0), (22, 0), (24, 0), (26, 0)])),
        (b"name", font.table(b"name").to_vec()),
        (b"post", post),
    ];
    FontSubset { file: written(&tables), glyphs, advances, bounds, heights }
}

/// The glyphs that are kept, by their number in the whole face.
struct Numbers {
    old: Vec<u16>,
}

impl Numbers {
    /// The new number of a glyph, which is kept from now on.
    fn of(&mut self, glyph: u16) -> u16 {
        let known = self.old.iter().position(|old| *old == glyph);
        known.unwrap_or_else(|| {
            self.old.push(glyph);
            self.old.len() - 1
        }) as u16
    }
}

/// A font file by its tables.
struct Tables {
    file: &'static [u8],
}

impl Tables {
    /// A table by its tag; empty where there is none.
    fn table(&self, tag: &[u8; 4]) -> &'static [u8] {
        let records = self.file[12..].chunks_exact(16).take(usize::from(u16_at(self.file, 4)));
        let mut found = records.filter(|record| record[..4] == tag[..]);
        found.next().map_or(&[], |record| &self.file[u32_at(record, 8)..][..u32_at(record, 12)])
    }

    /// A table with other values at these places.
    fn changed(&self, tag: &[u8; 4], values: &[(usize, u16)]) -> Vec<u8> {
        let mut table = self.table(tag).to_vec();
        for (at, value) in values {
            table[*at..at + 2].copy_from_slice(&value.to_be_bytes());
        }
        table
    }

    /// The outline of a glyph, as it is stored; empty of a blank.
    fn outline(&self, glyph: u16) -> &'static [u8] {
        let places = self.table(b"loca");
        let place = |glyph: usize| match u16_at(self.table(b"head"), 50) {
            0 => 2 * usize::from(u16_at(places, 2 * glyph)),
            _ => u32_at(places, 4 * glyph),
        };
        &self.table(b"glyf")[place(usize::from(glyph))..place(usize::from(glyph) + 1)]
    }
}

/// An outline whose instructions for small screens are left out and whose parts are numbered anew.
fn without_instructions(outline: &[u8], numbers: &mut Numbers) -> Vec<u8> {
    if outline.is_empty() {
        return Vec::new();
    }
    // Contours, or -1 of a glyph made of others.
    let contours = u16_at(outline, 0) as i16;
    if contours >= 0 {
        let length_at = 10 + 2 * contours as usize;
        let after = length_at + 2 + usize::from(u16_at(outline, length_at));
        return [&outline[..length_at], &[0, 0], &outline[after..]].concat();
    }
    let (mut made, mut at) = (outline[..10].to_vec(), 10);
    loop {
        let (flags, part) = (u16_at(outline, at), u16_at(outline, at + 2));
        let has = |flag: u16| flags & flag != 0;
        // Offsets in words or bytes; one scale, two, or a matrix.
        let offsets = if has(0x1) { 4 } else { 2 };
        let scales = [(0x8, 2), (0x40, 4), (0x80, 8)].into_iter().find(|(flag, _)| has(*flag)).map_or(0, |(_, n)| n);
        made.extend((flags & !0x100).to_be_bytes());
        made.extend(numbers.of(part).to_be_bytes());
        made.extend(&outline[at + 4..][..offsets + scales]);
        at += 4 + offsets + scales;
        if !has(0x20) {
            return made;
        }
    }
}

/// A character map of format 12 for Unicode; characters that the face lacks are left out.
fn character_map(glyphs: &BTreeMap<char, u16>) -> Vec<u8> {
    let known: Vec<(u32, u32)> =
        glyphs.iter().filter(|(_, glyph)| **glyph > 0).map(|(c, glyph)| (u32::from(*c), u32::from(*glyph))).collect();
    let mut map = Vec::new();
    // Version 0 with one map: platform 3, encoding 10, twelve bytes from here.
    [0u16, 1, 3, 10, 0, 12, 12, 0].iter().for_each(|value| map.extend(value.to_be_bytes()));
    let count = known.len() as u32;
    let groups = known.into_iter().flat_map(|(character, glyph)| [character, character, glyph]);
    [16 + 12 * count, 0, count].into_iter().chain(groups).for_each(|value| map.extend(value.to_be_bytes()));
    map
}

/// A font file of tables in the order of their tags.
fn written(tables: &[(&[u8; 4], Vec<u8>)]) -> Vec<u8> {
    let count = tables.len() as u16;
    let (power, shift) = (1 << count.ilog2(), count.ilog2() as u16);
    let mut file = vec![0, 1, 0, 0];
    [count, 16 * power, shift, 16 * (count - power)].iter().for_each(|value| file.extend(value.to_be_bytes()));
    let mut place = 12 + 16 * tables.len();
    let mut head_at = 0;
    for (tag, table) in tables {
        if *tag == b"head" {
            head_at = place;
        }
        file.extend(*tag);
        [sum(table), place as u32, table.len() as u32].iter().for_each(|value| file.extend(value.to_be_bytes()));
        place += table.len().next_multiple_of(4);
    }
    for (_, table) in tables {
        file.extend(table);
        file.resize(file.len().next_multiple_of(4), 0);
    }
    // The sum over the whole file is this constant.
    let balance = 0xb1b0_afba_u32.wrapping_sub(sum(&file));
    file[head_at + 8..][..4].copy_from_slice(&balance.to_be_bytes());
    file
}

/// The sum of the words of a table.
fn sum(bytes: &[u8]) -> u32 {
    let word = |four: &[u8]| (0..4).fold(0, |word, n| word << 8 | u32::from(four.get(n).copied().unwrap_or(0)));
    bytes.chunks(4).fold(0, |sum, four| sum.wrapping_add(word(four)))
}

fn u16_at(bytes: &[u8], at: usize) -> u16 {
    u16::from_be_bytes([bytes[at], bytes[at + 1]])
}

fn u32_at(bytes: &[u8], at: usize) -> usize {
    usize::from(u16_at(bytes, at)) << 16 | usize::from(u16_at(bytes, at + 2))
}

#[cfg(test)]
mod tests {
    use super::*;
    use ab_glyph::{FontRef, ScaleFont};

    /// Every character that the face has gives the same outline and advance from a subset as from the whole face.
    #[test]
    fn letters_of_a_subset_are_those_of_the_face() {
        let face = crate::text::face();
        let characters: BTreeSet<char> =
            ('\u{20}'..='\u{ffff}').filter(|character| face.glyph_id(*character).0 > 0).collect();
        assert!(characters.len() > 1000);
        let subset = font_of(&characters);
        let font = FontRef::try_from_slice(&subset.file).unwrap();
        assert_eq!(font.units_per_em(), face.units_per_em());
        for character in characters {
            let (ours, whole) = (font.glyph_id(character), face.glyph_id(character));
            assert_eq!(ours.0, subset.glyphs[&character]);
            let curves = |outline: Option<ab_glyph::Outline>| outline.map(|outline| format!("{:?}", outline.curves));
            assert_eq!(curves(font.outline(ours)), curves(face.outline(whole)), "{character}");
            assert_eq!(font.h_advance_unscaled(ours), face.h_advance_unscaled(whole));
            assert_eq!(f32::from(subset.advances[usize::from(ours.0)]), face.h_advance_unscaled(whole));
        }
    }

    #[test]
    fn what_the_face_lacks_is_the_box() {
        let subset = font_of(&['白', 'a', 'ط'].into());
        assert_eq!([subset.glyphs[&'白'], subset.glyphs[&'ط']], [0, 0]);
        assert_eq!(subset.advances.len(), 2);
        let font = FontRef::try_from_slice(&subset.file).unwrap();
        assert!(font.outline(font.glyph_id('白')).is_some());
        assert_eq!(font_of(&BTreeSet::new()).advances.len(), 1);
    }

    /// Lines are laid out by advances alone.
    #[test]
    fn the_face_kerns_nothing() {
        let face = crate::text::face().as_scaled(100.0);
        for pair in ["AV", "To", "Wa", "Ty", "P."] {
            let [a, b] = [0, 1].map(|n| face.glyph_id(pair.chars().nth(n).unwrap()));
            assert_eq!(face.kern(a, b), 0.0, "{pair}");
        }
    }

    #[test]
    fn the_sum_over_the_file_is_that_of_the_standard() {
        assert_eq!(sum(&font_of(&('a'..='z').collect()).file), 0xb1b0_afba);
    }
}
