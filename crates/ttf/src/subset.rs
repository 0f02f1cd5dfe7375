//! A face as a font file that holds only what some lines need, for files that carry their font along.
//!
//! The file is TrueType (ISO/IEC 14496-22), whatever the face is: outlines without instructions, metrics, names, and a
//! character map of format 12. Outlines are taken as `skrifa` reads them; cubic curves become quadratic ones that stay
//! within 0.3 thousandths of an em of them. Glyphs are numbered anew, 0 is the missing-glyph box. A file for programs that shape
//! text themselves keeps the face's numbers and its rules (`GSUB`, `GPOS`, `GDEF`), with blanks for all other glyphs.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use skrifa::Tag;
use skrifa::raw::TableProvider;

use crate::text::{Face, Faces, OpenFace, TextCurve, set};

/// How far a quadratic curve may lie from the cubic one that it stands for, thousandths of an em.
const TOLERANCE: f32 = 0.3;
/// Most quadratic curves that stand for one cubic.
const MOST_PIECES: usize = 8;

/// A font file with some glyphs of a face.
#[derive(Debug, Clone, PartialEq)]
pub struct FontSubset {
    /// The file.
    pub file: Vec<u8>,
    /// The number in the file of each glyph of the face.
    pub numbers: BTreeMap<u16, u16>,
    /// The advance of each glyph in the file, thousandths of an em.
    pub advances: Vec<f32>,
    /// The rectangle around all letters of the face: left, bottom, right, top, thousandths of an em.
    pub bounds: [f32; 4],
    /// From the baseline up to the top of the tallest letters and, negative, down to the foot of the lowest ones,
    /// thousandths of an em.
    pub heights: [f32; 2],
}

/// What some lines use of a face.
#[derive(Debug, Clone)]
pub struct FaceUse {
    /// The face's number in [`Faces`].
    pub number: usize,
    /// The face.
    pub face: Arc<Face>,
    /// Its glyphs that are drawn.
    pub glyphs: BTreeSet<u16>,
    /// The glyph of each character that it has, before any rule of the face.
    pub characters: BTreeMap<char, u16>,
    /// Whether every character is drawn as that glyph: whoever knows no rules draws the same.
    pub is_plain: bool,
}

impl FaceUse {
    /// The face as a file for programs that get the glyph of each place.
    pub fn file(&self) -> Option<FontSubset> {
        subset(&self.face, &self.glyphs, &self.characters)
    }

    /// The face as a file for programs that set the text themselves.
    pub fn file_to_set_text(&self) -> Option<FontSubset> {
        let nominal = self.characters.values().copied().filter(|glyph| *glyph > 0);
        let glyphs = self.glyphs.iter().copied().chain(nominal).collect();
        match self.is_plain || self.number == 0 {
            true => subset(&self.face, &glyphs, &self.characters),
            false => subset_with_rules(&self.face, &glyphs, &self.characters),
        }
    }
}

/// The faces that lines are set in on this thread, and what they use of each.
pub fn used<'a>(lines: impl IntoIterator<Item = &'a str>) -> Vec<FaceUse> {
    let faces = Faces::current();
    let mut uses: BTreeMap<usize, FaceUse> = BTreeMap::new();
    for text in lines {
        for (number, glyphs) in set(text).by_face() {
            let face = faces.face(number);
            let Some(open) = face.open() else { continue };
            let face_use = uses.entry(number).or_insert_with(|| FaceUse {
                number,
                face: Arc::clone(face),
                glyphs: BTreeSet::new(),
                characters: BTreeMap::new(),
                is_plain: true,
            });
            for glyph in glyphs {
                let mut nominal = None;
                for character in text[glyph.said.clone()].chars() {
                    nominal = match nominal {
                        None => Some(open.glyph(character)),
                        Some(_) => Some(u16::MAX),
                    };
                    face_use.characters.insert(character, open.glyph(character));
                }
                face_use.is_plain &= nominal == Some(glyph.id) && glyph.at[1] == 0.0;
                face_use.glyphs.insert(glyph.id);
            }
        }
    }
    uses.into_values().collect()
}

/// The font file with these glyphs of a face, found by these characters.
///
/// ```
/// use ttf::{subset, text};
/// let line = text::set("A");
/// let face = text::Faces::default().face(0).clone();
/// let subset = subset::subset(&face, &[line.glyphs[0].id].into(), &[('A', line.glyphs[0].id)].into()).unwrap();
/// // The missing-glyph box and the letter.
/// assert_eq!(subset.advances.len(), 2);
/// assert!(subset.file.len() < 5000);
/// ```
pub fn subset(face: &Face, glyphs: &BTreeSet<u16>, characters: &BTreeMap<char, u16>) -> Option<FontSubset> {
    let kept: BTreeSet<u16> = [0].into_iter().chain(glyphs.iter().copied()).collect();
    written_subset(&face.open()?, &kept.into_iter().map(Some).collect::<Vec<_>>(), characters, false)
}

/// The same with the numbers and the rules of the face, for programs that shape text themselves.
pub(crate) fn subset_with_rules(
    face: &Face,
    glyphs: &BTreeSet<u16>,
    characters: &BTreeMap<char, u16>,
) -> Option<FontSubset> {
    let open = face.open()?;
    let places = (0..open.count()).map(|glyph| (glyph == 0 || glyphs.contains(&glyph)).then_some(glyph));
    written_subset(&open, &places.collect::<Vec<_>>(), characters, true)
}

/// Writes the glyphs at these places; a place without one has a blank of no width.
fn written_subset(
    face: &OpenFace,
    places: &[Option<u16>],
    characters: &BTreeMap<char, u16>,
    has_rules: bool,
) -> Option<FontSubset> {
    let units = face.units_per_em;
    let numbers: BTreeMap<u16, u16> =
        places.iter().enumerate().filter_map(|(place, glyph)| Some(((*glyph)?, place as u16))).collect();
    let [mut outlines, mut starts, mut metrics] = [const { Vec::new() }; 3];
    let mut advances = Vec::new();
    let (mut most, mut widest) = ([0u16; 2], 0);
    for glyph in places {
        starts.extend((outlines.len() as u32).to_be_bytes());
        let contours = glyph.map(|glyph| points_of(&face.contours(glyph), units)).unwrap_or_default();
        let advance = glyph.map_or(0.0, |glyph| face.advance(glyph)).round().clamp(0.0, 65535.0);
        let outline = outline_of(&contours);
        let left = outline.get(2..4).map_or([0; 2], |left| [left[0], left[1]]);
        most = [most[0].max(contours.iter().map(Vec::len).sum::<usize>() as u16), most[1].max(contours.len() as u16)];
        outlines.extend(outline);
        outlines.resize(outlines.len().next_multiple_of(4), 0);
        metrics.extend((advance as u16).to_be_bytes());
        metrics.extend(left);
        advances.push(advance * 1000.0 / units);
        widest = widest.max(advance as u16);
    }
    starts.extend((outlines.len() as u32).to_be_bytes());
    let count = places.len() as u16;
    let table = |tag: &[u8; 4]| face.font.table_data(Tag::new(tag)).map(|data| data.as_bytes().to_vec());
    let head = changed(table(b"head")?, &[(8, 0), (10, 0), (50, 1), (52, 0)]);
    let box_of_all = face.font.head().ok()?;
    let bounds = [box_of_all.x_min(), box_of_all.y_min(), box_of_all.x_max(), box_of_all.y_max()];
    let mut post = table(b"post").filter(|post| post.len() >= 32).unwrap_or_else(|| vec![0; 32]);
    post.truncate(32);
    // Version 3: glyphs have no names.
    post[..4].copy_from_slice(&0x0003_0000u32.to_be_bytes());
    let known = characters.iter().filter_map(|(character, glyph)| Some((*character, *numbers.get(glyph)?)));
    // Version 1: points and contours of a glyph; two zones; no instructions, no parts of glyphs.
    let profile = [1, 0, count, most[0], most[1], 0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0].map(u16::to_be_bytes).concat();
    let mut tables = vec![
        (b"OS/2", table(b"OS/2").unwrap_or_default()),
        (b"cmap", character_map(&known.collect())),
        (b"glyf", outlines),
        (b"head", head),
        (b"hhea", changed(table(b"hhea")?, &[(10, widest), (34, count)])),
        (b"hmtx", metrics),
        (b"loca", starts),
        (b"maxp", profile),
        (b"name", table(b"name").unwrap_or_default()),
        (b"post", post),
    ];
    if has_rules {
        let rules = [b"GDEF", b"GPOS", b"GSUB"].into_iter().filter_map(|tag| Some((tag, table(tag)?)));
        tables.extend(rules);
    }
    tables.retain(|(_, data)| !data.is_empty());
    tables.sort_by_key(|(tag, _)| **tag);
    let thousandths = 1000.0 / units;
    Some(FontSubset {
        file: written(&tables),
        numbers,
        advances,
        bounds: bounds.map(|bound| f32::from(bound) * thousandths),
        heights: face.heights.map(|height| f32::from(height) * thousandths),
    })
}

/// A table with other values at these places; places that it does not have are left out.
fn changed(mut table: Vec<u8>, values: &[(usize, u16)]) -> Vec<u8> {
    for (at, value) in values {
        if let Some(place) = table.get_mut(*at..at + 2) {
            place.copy_from_slice(&value.to_be_bytes());
        }
    }
    table
}

/// A point of a contour, units of the face, and whether the curve goes through it.
type ContourPoint = ([i16; 2], bool);

/// The contours of a glyph as points of quadratic curves.
fn points_of(curves: &[TextCurve], units: f32) -> Vec<Vec<ContourPoint>> {
    let rounded = |p: [f32; 2]| p.map(|part| part.round().clamp(-16384.0, 16383.0) as i16);
    let mut contours: Vec<Vec<ContourPoint>> = Vec::new();
    let mut end = None;
    for curve in curves {
        let places = curve.places();
        if end != Some(places[0]) {
            contours.push(vec![(rounded(places[0]), true)]);
        }
        let Some(contour) = contours.last_mut() else { continue };
        match *curve {
            TextCurve::Line([_, to]) => contour.push((rounded(to), true)),
            TextCurve::Quad([_, control, to]) => contour.extend([(rounded(control), false), (rounded(to), true)]),
            TextCurve::Cubic(cubic) => {
                for [_, control, to] in quads_of(cubic, TOLERANCE * units / 1000.0) {
                    contour.extend([(rounded(control), false), (rounded(to), true)]);
                }
            }
        }
        end = places.last().copied();
    }
    for contour in &mut contours {
        // A contour closes by itself.
        if contour.len() > 1 && contour.first() == contour.last() {
            contour.pop();
        }
    }
    contours
}

/// Quadratic curves that follow a cubic one. One of them departs from its part by √3/36 of the third difference.
fn quads_of([a, b, c, d]: [[f32; 2]; 4], tolerance: f32) -> Vec<[[f32; 2]; 3]> {
    let third = [0, 1].map(|n| d[n] - 3.0 * c[n] + 3.0 * b[n] - a[n]);
    let departs = 3f32.sqrt() / 36.0 * third[0].hypot(third[1]);
    let pieces = ((departs / tolerance).cbrt().ceil() as usize).clamp(1, MOST_PIECES);
    let at = |t: f32| {
        let u = 1.0 - t;
        [0, 1].map(|n| u * u * u * a[n] + 3.0 * u * u * t * b[n] + 3.0 * u * t * t * c[n] + t * t * t * d[n])
    };
    let slope = |t: f32| {
        let u = 1.0 - t;
        [0, 1].map(|n| 3.0 * (u * u * (b[n] - a[n]) + 2.0 * u * t * (c[n] - b[n]) + t * t * (d[n] - c[n])))
    };
    let quad = |piece: usize| {
        let [from, to] = [piece, piece + 1].map(|n| n as f32 / pieces as f32);
        let (start, end, step) = (at(from), at(to), 0.25 * (to - from));
        let (leaves, comes) = (slope(from), slope(to));
        // The mean of the control points of the cubic part, as far as its ends ask for.
        let control = [0, 1].map(|n| 0.5 * (start[n] + end[n]) + step * (leaves[n] - comes[n]));
        [start, control, end]
    };
    (0..pieces).map(quad).collect()
}

/// An outline as it is stored: its box, the ends of its contours, and its points with words as steps.
fn outline_of(contours: &[Vec<ContourPoint>]) -> Vec<u8> {
    let points: Vec<ContourPoint> = contours.iter().flatten().copied().collect();
    let bound = |axis: usize, of: fn(i16, i16) -> i16| points.iter().map(|(at, _)| at[axis]).reduce(of);
    let (Some(left), Some(low), Some(right), Some(high)) =
        (bound(0, i16::min), bound(1, i16::min), bound(0, i16::max), bound(1, i16::max))
    else {
        return Vec::new();
    };
    let mut outline = Vec::new();
    [contours.len() as i16, left, low, right, high].iter().for_each(|value| outline.extend(value.to_be_bytes()));
    let mut end = -1;
    for contour in contours {
        end += contour.len() as i16;
        outline.extend(end.to_be_bytes());
    }
    // No instructions.
    outline.extend([0, 0]);
    outline.extend(points.iter().map(|(_, is_on)| u8::from(*is_on)));
    for axis in [0, 1] {
        let mut last = 0;
        for (at, _) in &points {
            outline.extend((at[axis].wrapping_sub(last)).to_be_bytes());
            last = at[axis];
        }
    }
    outline
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::text::embedded_open;
    use skrifa::{FontRef, MetadataProvider};

    fn subset_of(text: &str) -> (FontSubset, BTreeMap<char, u16>) {
        let open = embedded_open();
        let characters: BTreeMap<char, u16> = text.chars().map(|c| (c, open.glyph(c))).collect();
        let glyphs = characters.values().copied().collect();
        (subset(Faces::default().face(0), &glyphs, &characters).unwrap(), characters)
    }

    /// Every character that the face has gives the same outline and advance from a subset as from the whole face.
    #[test]
    fn letters_of_a_subset_are_those_of_the_face() {
        let whole = embedded_open();
        let all: String = ('\u{20}'..='\u{ffff}').filter(|character| whole.glyph(*character) > 0).collect();
        assert!(all.chars().count() > 1000);
        let (subset, characters) = subset_of(&all);
        let face = Face::parse(subset.file.clone(), 0).unwrap();
        let open = face.open().unwrap();
        assert_eq!(open.units_per_em, whole.units_per_em);
        for (character, glyph) in characters {
            let ours = open.glyph(character);
            assert_eq!(ours, subset.numbers[&glyph]);
            assert_eq!(open.advance(ours), whole.advance(glyph));
            assert_eq!(subset.advances[usize::from(ours)], whole.advance(glyph));
            // Parts of accented letters may stand at half a unit, and a line that closes a contour need not be said.
            let places = |curves: Vec<TextCurve>| -> Vec<[f32; 2]> {
                let mut places: Vec<_> = curves
                    .iter()
                    .filter(|c| c.places()[0] != *c.places().last().unwrap())
                    .flat_map(|c| c.places().to_vec())
                    .collect();
                places.dedup();
                places
            };
            let (a, b) = (places(open.contours(ours)), places(whole.contours(glyph)));
            assert_eq!(a.len(), b.len(), "{character}");
            let off = a.iter().zip(&b).map(|(a, b)| (a[0] - b[0]).abs().max((a[1] - b[1]).abs()));
            assert!(off.fold(0.0, f32::max) <= 0.51, "{character}: {a:?} {b:?}");
        }
    }

    #[test]
    fn what_the_face_lacks_is_the_box() {
        let (subset, _) = subset_of("白aط");
        assert_eq!(subset.advances.len(), 2);
        let font = FontRef::new(&subset.file).unwrap();
        assert!(font.charmap().map('白').is_none() && font.charmap().map('a').is_some());
        assert_eq!(subset_of("").0.advances.len(), 1);
    }

    /// A circle of four cubic curves stays one, to a fraction of what a printer shows.
    #[test]
    fn cubic_curves_become_quadratic_ones_that_follow_them() {
        let k = 500.0 * 0.552_285;
        let cubic = [[500.0, 0.0], [500.0, k], [k, 500.0], [0.0, 500.0]];
        let quads = quads_of(cubic, TOLERANCE);
        assert!((2..=MOST_PIECES).contains(&quads.len()));
        for [a, b, c] in quads {
            for n in 0..=10 {
                let (t, u) = (n as f32 / 10.0, 1.0 - n as f32 / 10.0);
                let at = [0, 1].map(|n| u * u * a[n] + 2.0 * u * t * b[n] + t * t * c[n]);
                assert!((at[0].hypot(at[1]) - 500.0).abs() < 0.6, "{at:?}");
            }
        }
    }

    /// Lines are laid out by advances alone.
    #[test]
    fn the_embedded_face_kerns_nothing() {
        for pair in ["AV", "To", "Wa", "Ty", "P.", "fi\u{308}"] {
            let alone: f32 = pair.chars().map(|c| set(&c.to_string()).width).sum();
            assert!((set(pair).width - alone).abs() < 1e-4, "{pair}");
        }
    }

    #[test]
    fn the_sum_over_the_file_is_that_of_the_standard() {
        assert_eq!(sum(&subset_of("abcxyz").0.file), 0xb1b0_afba);
    }
}
