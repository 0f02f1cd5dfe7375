//! A line of text in pieces that may be turned one by one: letters, or letters that are joined.
//!
//! A piece is the shortest run of characters that is shaped alone as it is shaped within the line: a letter of Latin,
//! Greek, Cyrillic, Han or Hebrew; of Arabic, the letters from one that joins nothing before it to one that joins
//! nothing after it; of Indic scripts a syllable or a word.

use std::ops::Range;

use super::line::{Line, set};

/// A piece of a line.
#[derive(Debug, Clone, PartialEq)]
pub struct Piece {
    /// Its bytes of the text.
    pub said: Range<usize>,
    /// Its left end from that of the line, and its width, shares of the font size.
    pub left: f32,
    /// Its width, a share of the font size.
    pub width: f32,
}

/// The pieces of a line in the order in which they are written; one piece where the line cannot be parted.
///
/// ```
/// use ttf::text::pieces;
/// let pieces = pieces("Marl");
/// assert_eq!(pieces.len(), 4);
/// assert!((pieces[1].left - pieces[0].width).abs() < 1e-6);
/// ```
pub fn pieces(text: &str) -> Vec<Piece> {
    let line = set(text);
    if line.is_plain {
        let right = |n: usize| line.glyphs.get(n).map_or(line.width, |glyph| glyph.at[0]);
        let piece = |(n, glyph): (usize, &super::Glyph)| {
            let left = glyph.at[0];
            Piece { said: glyph.said.clone(), left, width: right(n + 1) - left }
        };
        return line.glyphs.iter().enumerate().map(piece).collect();
    }
    let mut starts: Vec<usize> = line.glyphs.iter().map(|glyph| glyph.said.start).collect();
    starts.sort_unstable();
    starts.dedup();
    let ends: Vec<usize> = starts.iter().copied().skip(1).chain([text.len()]).collect();
    let mut pieces = Vec::new();
    let mut first = 0;
    while first < starts.len() {
        let begin = starts[first];
        let alone = (first..starts.len()).find_map(|last| {
            let piece = alone(text, begin..ends[last], &line)?;
            Some((last, piece))
        });
        let Some((last, piece)) = alone else {
            return vec![Piece { said: 0..text.len(), left: 0.0, width: line.width }];
        };
        pieces.push(piece);
        first = last + 1;
    }
    pieces
}

/// A run of characters as a piece, if it looks alone as it looks in its line.
fn alone(text: &str, said: Range<usize>, line: &Line) -> Option<Piece> {
    let own = set(text.get(said.clone())?);
    let first = line.glyphs.iter().position(|glyph| said.contains(&glyph.said.start))?;
    let within = line.glyphs.get(first..first + own.glyphs.len())?;
    let has_all = line.glyphs.iter().filter(|glyph| said.contains(&glyph.said.start)).count() == own.glyphs.len();
    let left = within.first()?.at[0] - own.glyphs.first()?.at[0];
    let is_same = has_all
        && within.iter().zip(&own.glyphs).all(|(there, here)| {
            let is_there = (there.at[0] - left - here.at[0]).abs() < 1e-3 && (there.at[1] - here.at[1]).abs() < 1e-3;
            (there.face, there.id) == (here.face, here.id) && is_there
        });
    is_same.then_some(Piece { said, left, width: own.width })
}
