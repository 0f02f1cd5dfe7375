//! A line of text as glyphs: in the order in which they are seen, joined and placed as their scripts ask.
//!
//! Characters that the embedded face has, one beside the other, are most lines, and are set by advances alone. Any
//! other line is taken apart by the Unicode bidirectional algorithm (UAX 9; `unicode-bidi`) into runs of one direction,
//! and these into words of one face, which are shaped by rules of the face (`harfrust`). Shaping word by word loses
//! nothing: no script joins letters across a blank. The embedded face is set without kerning and ligatures, as its
//! simple lines are.

use std::ops::Range;

use harfrust::{BufferClusterLevel, Direction, Feature, ShapeOptions, Tag, UnicodeBuffer};
use unicode_bidi::ParagraphBidiInfo;

use super::face::{Faces, OpenFace, embedded_open};

/// A line of text as glyphs; lengths are shares of the font size.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// The glyphs from left to right.
    pub glyphs: Vec<Glyph>,
    /// From its left end to its right end.
    pub width: f32,
    /// Above the baseline, and below it.
    pub heights: [f32; 2],
    /// Whether each character has a glyph of its own, in the order in which they are written.
    pub is_plain: bool,
    /// Whether it is read from right to left.
    pub is_right_to_left: bool,
}

/// A glyph of a line.
#[derive(Debug, Clone, PartialEq)]
pub struct Glyph {
    /// Its face, by number ([`Faces::face`]).
    pub face: usize,
    /// Its number in the face; 0 is the missing-glyph box.
    pub id: u16,
    /// Where it stands: x right from the left end of the line, y up from the baseline.
    pub at: [f32; 2],
    /// Its advance in its face, which is not always the way to the next glyph.
    pub advance: f32,
    /// The bytes of the text that it stands for; empty where another glyph already stands for them.
    pub said: Range<usize>,
}

/// Sets a line in the faces of this thread.
///
/// ```
/// let line = ttf::text::set("Marl");
/// assert_eq!((line.glyphs.len(), line.is_plain, line.is_right_to_left), (4, true, false));
/// // Hebrew is seen from its last letter to its first; the embedded face has boxes for it.
/// let line = ttf::text::set("אב");
/// assert_eq!([&line.glyphs[0].said, &line.glyphs[1].said], [&(2..4), &(0..2)]);
/// ```
pub fn set(text: &str) -> Line {
    let embedded = embedded_open();
    let heights = heights_of(embedded);
    let mut line = Line { glyphs: Vec::new(), width: 0.0, heights, is_plain: true, is_right_to_left: false };
    if text.chars().all(|character| is_simple(character) && embedded.glyph(character) != 0) {
        for (at, character) in text.char_indices() {
            let id = embedded.glyph(character);
            let advance = embedded.advance(id) / embedded.units_per_em;
            let said = at..at + character.len_utf8();
            line.glyphs.push(Glyph { face: 0, id, at: [line.width, 0.0], advance, said });
            line.width += advance;
        }
        return line;
    }
    let faces = Faces::current();
    let order = ParagraphBidiInfo::new(text, None);
    line.is_right_to_left = order.paragraph_level.is_rtl();
    let (levels, runs) = order.visual_runs(0..text.len());
    for run in runs {
        let is_reversed = levels.get(run.start).is_some_and(|level| level.is_rtl());
        let mut words = words_of(text, run, &faces);
        if is_reversed {
            words.reverse();
        }
        for (face, word) in words {
            line.push(text, word, &faces, face, is_reversed);
        }
    }
    let in_order = text.char_indices().map(|(at, character)| at..at + character.len_utf8());
    let has_nominal = |glyph: &Glyph| glyph.at[1] == 0.0;
    line.is_plain = line.glyphs.iter().map(|glyph| glyph.said.clone()).eq(in_order)
        && line.glyphs.iter().all(has_nominal)
        && line.glyphs.windows(2).all(|pair| (pair[0].at[0] + pair[0].advance - pair[1].at[0]).abs() < 1e-4);
    line
}

/// A name with what was measured of it, "F1, 45 m": a mark that is not seen (U+200E) keeps figures and unit in their order
/// behind a name that is read from right to left.
///
/// ```
/// use ttf::text::{measured, set};
/// assert_eq!(measured("F1", "45 m"), "F1, 45 m");
/// let name = measured("אב", "45 m");
/// let seen: String = set(&name).glyphs.iter().map(|glyph| &name[glyph.said.clone()]).collect();
/// assert!(seen.trim_start_matches('\u{200e}').starts_with("45 m"));
/// ```
pub fn measured(name: &str, figure: &str) -> String {
    let mark = if name.chars().any(is_right_to_left) { "\u{200e}" } else { "" };
    format!("{name}, {mark}{figure}")
}

/// Whether a character is of a script that is read from right to left.
fn is_right_to_left(character: char) -> bool {
    matches!(character, '\u{590}'..='\u{8ff}' | '\u{fb1d}'..='\u{fdff}' | '\u{fe70}'..='\u{fefe}'
        | '\u{10800}'..='\u{10fff}' | '\u{1e800}'..='\u{1efff}')
}

/// Whether a character has no ink: marks of direction, joiners.
pub(super) fn is_invisible(character: char) -> bool {
    matches!(character, '\u{200b}'..='\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2060}'..='\u{206f}')
}

/// Whether a character stands by itself, from left to right, wherever it stands.
fn is_simple(character: char) -> bool {
    let is_joined = matches!(character, '\u{300}'..='\u{36f}' | '\u{483}'..='\u{489}' | '\u{590}'..='\u{1dff}');
    !is_joined && !is_invisible(character)
}

/// Whether a character goes with the one before: marks, joiners, variation selectors.
fn goes_with_the_last(character: char) -> bool {
    matches!(character, '\u{300}'..='\u{36f}' | '\u{483}'..='\u{489}' | '\u{591}'..='\u{5c7}' | '\u{610}'..='\u{61a}'
        | '\u{64b}'..='\u{65f}' | '\u{670}' | '\u{6d6}'..='\u{6ed}' | '\u{8d3}'..='\u{8ff}' | '\u{1ab0}'..='\u{1aff}'
        | '\u{1dc0}'..='\u{1dff}' | '\u{200b}'..='\u{200f}' | '\u{20d0}'..='\u{20ff}' | '\u{302a}'..='\u{302f}'
        | '\u{fe00}'..='\u{fe0f}' | '\u{fe20}'..='\u{fe2f}' | '\u{e0100}'..='\u{e01ef}')
}

/// The words and blanks of a run as they are written, each in one face.
fn words_of(text: &str, run: Range<usize>, faces: &Faces) -> Vec<(usize, Range<usize>)> {
    let mut words: Vec<(usize, Range<usize>)> = Vec::new();
    let mut was_blank = false;
    for (at, character) in text[run.clone()].char_indices().map(|(at, character)| (run.start + at, character)) {
        let end = at + character.len_utf8();
        let last = words.last_mut().filter(|_| was_blank == character.is_whitespace());
        was_blank = character.is_whitespace();
        let holder = faces.holder(character);
        match last {
            Some((face, word)) if goes_with_the_last(character) || holder.unwrap_or(0) == *face => {
                // A mark that the letter's face lacks is drawn as that face draws what it lacks.
                debug_assert!(*face < faces.count());
                word.end = end;
            }
            _ => words.push((holder.unwrap_or(0), at..end)),
        }
    }
    words
}

impl Line {
    /// The glyphs by their faces, as they follow one another.
    pub(crate) fn by_face(&self) -> impl Iterator<Item = (usize, &[Glyph])> {
        self.glyphs.chunk_by(|a, b| a.face == b.face).map(|glyphs| (glyphs[0].face, glyphs))
    }

    /// Shapes a word of one face and direction, and sets it at the right end.
    fn push(&mut self, text: &str, word: Range<usize>, faces: &Faces, number: usize, is_reversed: bool) {
        let face = faces.face(number);
        let Some(open) = face.open() else { return };
        let em = open.units_per_em;
        let [above, below] = heights_of(&open);
        self.heights = [self.heights[0].max(above), self.heights[1].max(below)];
        let mut buffer = UnicodeBuffer::new();
        buffer.set_cluster_level(BufferClusterLevel::MonotoneCharacters);
        for (at, character) in text[word.clone()].char_indices() {
            // A line has no breaks in it.
            let shown = if character.is_control() { ' ' } else { character };
            buffer.add(shown, (word.start + at) as u32);
        }
        buffer.set_direction(if is_reversed { Direction::RightToLeft } else { Direction::LeftToRight });
        buffer.guess_segment_properties();
        let plain = [b"kern", b"liga", b"clig"].map(|tag| Feature::new(Tag::new(tag), 0, ..));
        let features = if number == 0 { &plain[..] } else { &[] };
        let shaped = face.shaper.shaper(&open.font).build().shape(buffer, ShapeOptions::default().features(features));
        let clusters: Vec<usize> = shaped.glyph_infos().iter().map(|info| info.cluster as usize).collect();
        let mut said = None;
        for (info, place) in shaped.glyph_infos().iter().zip(shaped.glyph_positions()) {
            let cluster = info.cluster as usize;
            let end = clusters.iter().copied().filter(|other| *other > cluster).min().unwrap_or(word.end);
            let id = u16::try_from(info.glyph_id).unwrap_or(0);
            self.glyphs.push(Glyph {
                face: number,
                id,
                at: [self.width + place.x_offset as f32 / em, place.y_offset as f32 / em],
                advance: open.advance(id) / em,
                said: if said == Some(cluster) { cluster..cluster } else { cluster..end },
            });
            said = Some(cluster);
            self.width += place.x_advance as f32 / em;
        }
    }
}

/// The heights of a face above and below its baseline, shares of the font size.
fn heights_of(face: &OpenFace) -> [f32; 2] {
    let [above, below] = face.heights.map(|height| f32::from(height) / face.units_per_em);
    [above, -below]
}
