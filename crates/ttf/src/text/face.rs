//! Faces: files of outlines (TrueType, OpenType with either kind of curves, one of a collection), read by `skrifa`.
//!
//! Lettering is set in the embedded face, and in those that a person gave for the characters that it lacks. What was
//! given is known to the thread that lays out or draws a page ([`Faces::scope`]): a page remembers its faces, so that
//! every back end takes those that it was laid out with.

use std::borrow::Cow;
use std::cell::RefCell;
use std::sync::{Arc, OnceLock};

use harfrust::ShaperData;
use skrifa::instance::{LocationRef, Size};
use skrifa::metrics::GlyphMetrics;
use skrifa::outline::{DrawSettings, OutlineGlyphCollection, OutlinePen};
use skrifa::raw::TableProvider;
use skrifa::string::StringId;
use skrifa::{FontRef, GlyphId, MetadataProvider};

use super::TextCurve;
use crate::TtfError;

/// A face.
pub struct Face {
    data: Cow<'static, [u8]>,
    index: u32,
    family: String,
    /// What shaping looks up again and again.
    pub(super) shaper: ShaperData,
}

/// A face with its tables at hand.
pub(crate) struct OpenFace<'a> {
    pub(crate) font: FontRef<'a>,
    characters: skrifa::charmap::Charmap<'a>,
    metrics: GlyphMetrics<'a>,
    outlines: OutlineGlyphCollection<'a>,
    pub(crate) units_per_em: f32,
    /// Above and, negative, below the baseline, units of the face.
    pub(crate) heights: [i16; 2],
}

impl std::fmt::Debug for Face {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Face({})", self.family)
    }
}

impl Face {
    /// Reads a face from a file: the `index`-th of a collection, from 0.
    ///
    /// # Errors
    /// No face that can be read, or none with outlines.
    pub fn parse(data: Vec<u8>, index: u32) -> Result<Self, TtfError> {
        Self::of(Cow::Owned(data), index)
    }

    fn of(data: Cow<'static, [u8]>, index: u32) -> Result<Self, TtfError> {
        let unusable = |reason: String| TtfError::UnusableFace { reason };
        let (shaper, family) = {
            let font = FontRef::from_index(&data, index).map_err(|error| unusable(error.to_string()))?;
            let Some(open) = OpenFace::of(font.clone()) else {
                return Err(unusable("a table that every face has is missing".into()));
            };
            if open.outlines.format().is_none() {
                return Err(unusable("it has no outlines of letters, only pictures of them".into()));
            }
            let named = |id| font.localized_strings(id).english_or_first().map(|name| name.chars().collect::<String>());
            let family = named(StringId::TYPOGRAPHIC_FAMILY_NAME).or_else(|| named(StringId::FAMILY_NAME));
            (ShaperData::new(&font), family)
        };
        // The name stands between quotes in other files.
        let family: String = family.unwrap_or_default().chars().filter(|c| c.is_alphanumeric() || *c == ' ').collect();
        let family = if family.trim().is_empty() { "Given".to_owned() } else { family.trim().to_owned() };
        Ok(Self { data, index, family, shaper })
    }

    /// The family that it belongs to: letters, figures and blanks.
    pub fn family(&self) -> &str {
        &self.family
    }

    /// Its tables; `None` never, of a face that was parsed.
    pub(crate) fn open(&self) -> Option<OpenFace<'_>> {
        OpenFace::of(FontRef::from_index(&self.data, self.index).ok()?)
    }

    /// Whether it has a glyph for a character.
    pub fn has(&self, character: char) -> bool {
        self.open().is_some_and(|open| open.glyph(character) != 0)
    }
}

impl PartialEq for Face {
    fn eq(&self, other: &Self) -> bool {
        self.index == other.index && self.data == other.data
    }
}

impl<'a> OpenFace<'a> {
    fn of(font: FontRef<'a>) -> Option<Self> {
        let units_per_em = f32::from(font.head().ok()?.units_per_em());
        let hhea = font.hhea().ok()?;
        let heights = [hhea.ascender().to_i16(), hhea.descender().to_i16()];
        font.hmtx().ok()?;
        if units_per_em < 16.0 {
            return None;
        }
        Some(Self {
            characters: font.charmap(),
            metrics: font.glyph_metrics(Size::unscaled(), LocationRef::default()),
            outlines: font.outline_glyphs(),
            units_per_em,
            heights,
            font,
        })
    }

    /// The glyph of a character; 0, the missing-glyph box, where it has none.
    pub(crate) fn glyph(&self, character: char) -> u16 {
        self.characters.map(character).and_then(|glyph| u16::try_from(glyph.to_u32()).ok()).unwrap_or(0)
    }

    /// The advance of a glyph, units of the face.
    pub(crate) fn advance(&self, glyph: u16) -> f32 {
        self.metrics.advance_width(GlyphId::from(glyph)).unwrap_or(0.0)
    }

    /// How many glyphs it has.
    pub(crate) fn count(&self) -> u16 {
        u16::try_from(self.metrics.glyph_count()).unwrap_or(u16::MAX)
    }

    /// The contours of a glyph, units of the face, y up; empty of a blank.
    pub(crate) fn contours(&self, glyph: u16) -> Vec<TextCurve> {
        let mut pen = Curves::default();
        if let Some(outline) = self.outlines.get(GlyphId::from(glyph)) {
            // What can be read of a damaged outline is drawn.
            let _ = outline.draw(DrawSettings::unhinted(Size::unscaled(), LocationRef::default()), &mut pen);
        }
        pen.curves
    }
}

/// Takes the contours of a glyph down.
#[derive(Default)]
struct Curves {
    curves: Vec<TextCurve>,
    start: [f32; 2],
    at: [f32; 2],
}

impl OutlinePen for Curves {
    fn move_to(&mut self, x: f32, y: f32) {
        (self.start, self.at) = ([x, y], [x, y]);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.curves.push(TextCurve::Line([self.at, [x, y]]));
        self.at = [x, y];
    }

    fn quad_to(&mut self, cx: f32, cy: f32, x: f32, y: f32) {
        self.curves.push(TextCurve::Quad([self.at, [cx, cy], [x, y]]));
        self.at = [x, y];
    }

    fn curve_to(&mut self, ax: f32, ay: f32, bx: f32, by: f32, x: f32, y: f32) {
        self.curves.push(TextCurve::Cubic([self.at, [ax, ay], [bx, by], [x, y]]));
        self.at = [x, y];
    }

    fn close(&mut self) {
        if self.at != self.start {
            self.line_to(self.start[0], self.start[1]);
        }
    }
}

/// The embedded face.
pub(crate) fn embedded() -> &'static Arc<Face> {
    static FACE: OnceLock<Arc<Face>> = OnceLock::new();
    FACE.get_or_init(|| {
        let face = Face::of(Cow::Borrowed(epaint_default_fonts::UBUNTU_LIGHT), 0);
        Arc::new(face.expect("the embedded face is a constant of the program, and a test parses it"))
    })
}

/// The embedded face with its tables at hand.
pub(crate) fn embedded_open() -> &'static OpenFace<'static> {
    static OPEN: OnceLock<OpenFace<'static>> = OnceLock::new();
    OPEN.get_or_init(|| embedded().open().expect("the embedded face was parsed"))
}

/// The faces that lettering is set in: the embedded one, and others in turn for characters that it lacks.
///
/// ```
/// use ttf::text::{Face, Faces, is_known};
/// assert!(Face::parse(b"no face".to_vec(), 0).is_err());
/// Faces::default().scope(|| assert!(is_known('A') && !is_known('石')));
/// ```
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Faces {
    given: Arc<[Arc<Face>]>,
}

thread_local! {
    static CURRENT: RefCell<Faces> = RefCell::default();
}

impl Faces {
    /// The embedded face, and these.
    pub fn new(given: Vec<Face>) -> Self {
        Self { given: given.into_iter().map(Arc::new).collect() }
    }

    /// The faces that this thread sets lettering in.
    pub fn current() -> Self {
        CURRENT.with_borrow(Self::clone)
    }

    /// Does something whose lettering is set in these faces.
    pub fn scope<T>(&self, work: impl FnOnce() -> T) -> T {
        let _back = Back(self.enter());
        work()
    }

    /// Sets the lettering of this thread in these faces from now on, and returns those until now.
    pub fn enter(&self) -> Self {
        CURRENT.with_borrow_mut(|current| std::mem::replace(current, self.clone()))
    }

    /// A face by its number: 0 is the embedded one.
    pub fn face(&self, number: usize) -> &Arc<Face> {
        number.checked_sub(1).and_then(|given| self.given.get(given)).unwrap_or_else(|| embedded())
    }

    /// How many there are, the embedded one counted.
    pub fn count(&self) -> usize {
        1 + self.given.len()
    }

    /// The number of the first face that has a character; absent where none has.
    pub(super) fn holder(&self, character: char) -> Option<usize> {
        if embedded_open().glyph(character) != 0 {
            return Some(0);
        }
        self.given.iter().position(|face| face.has(character)).map(|given| given + 1)
    }
}

/// Puts a thread's faces back, also when what it did panics.
struct Back(Faces);

impl Drop for Back {
    fn drop(&mut self) {
        self.0.enter();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_face_is_refused_with_the_reason() {
        for bytes in [&b""[..], b"OTTO", &epaint_default_fonts::UBUNTU_LIGHT[..300]] {
            let error = Face::parse(bytes.to_vec(), 0).unwrap_err().to_string();
            assert!(error.contains("TrueType or OpenType"), "{error}");
        }
        assert_eq!(embedded().family(), "Ubuntu");
        assert!(Face::parse(epaint_default_fonts::UBUNTU_LIGHT.to_vec(), 3).is_err());
    }

    #[test]
    fn a_scope_ends_where_it_ends() {
        let given = Faces::new(vec![Face::parse(epaint_default_fonts::UBUNTU_LIGHT.to_vec(), 0).unwrap()]);
        assert_eq!(given.scope(|| Faces::current().count()), 2);
        assert_eq!(Faces::current().count(), 1);
        let _ = std::panic::catch_unwind(|| given.scope(|| panic!("within")));
        assert_eq!(Faces::current().count(), 1);
    }
}
