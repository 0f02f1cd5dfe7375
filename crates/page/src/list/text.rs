//! Lines of text: where they stand, and the room they take.

use super::{Ink, Path, Segment, Stroke};
use crate::Rect;
use crate::style::INK;
use glam::DVec2;
use serde::{Deserialize, Serialize};
use ttf::text::{TextCurve, measure_text, outline_text, pieces};

/// Share of the font size that capital letters are high: what is centred upright is centred on them.
const CAPITALS: f64 = 0.69;

/// Widths that differ by less are the same, points.
const ROUNDING: f64 = 1e-3;

/// A line of text in the faces that [`ttf::text`] has.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Text {
    /// What it says.
    pub text: String,
    /// Where its anchor stands.
    pub at: DVec2,
    /// Font size, points per em.
    pub size: f64,
    /// Which place of the text stands at `at`.
    pub anchor: Anchor,
    /// Turn about `at`, degrees clockwise as seen on the page.
    pub turn_deg: f64,
    /// Colour.
    pub ink: Ink,
    /// A rim, so that it is read on any ground.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub halo: Option<Halo>,
    /// Where each of its letters stands, as they are written; empty: side by side on a straight line.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub letters: Vec<Letter>,
}

/// Where a letter of a bent line stands, or letters that are joined.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Letter {
    /// The left end of its baseline.
    pub at: DVec2,
    /// Its turn about that place, degrees clockwise as seen on the page.
    pub turn_deg: f64,
    /// How many bytes of the text it says.
    pub bytes: usize,
}

/// Which place of a text stands at its position.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Anchor {
    /// Along the line.
    pub across: Across,
    /// Across it.
    pub upright: Upright,
}

/// A place along a line of text.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Across {
    /// Its beginning.
    #[default]
    Start,
    /// Its middle.
    Middle,
    /// Its end.
    End,
}

/// A height of a line of text.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Upright {
    /// The line that letters stand on.
    #[default]
    Baseline,
    /// Half the height of capital letters and figures.
    Middle,
    /// The upper end of capital letters and figures.
    Top,
}

/// A rim around letters.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Halo {
    /// How far it reaches beyond the letters, points.
    pub width: f64,
    /// Its colour.
    pub ink: Ink,
}

impl Text {
    /// A line of small text that begins at a place.
    pub fn new(at: DVec2, text: impl Into<String>) -> Self {
        Self {
            text: text.into(),
            at,
            size: crate::style::TEXT_PT,
            anchor: Anchor::default(),
            turn_deg: 0.0,
            ink: Ink::solid(INK),
            halo: None,
            letters: Vec::new(),
        }
    }

    /// The same in another size, points.
    #[must_use]
    pub fn sized(mut self, size: f64) -> Self {
        self.size = size;
        self
    }

    /// The same anchored elsewhere.
    #[must_use]
    pub fn anchored(mut self, across: Across, upright: Upright) -> Self {
        self.anchor = Anchor { across, upright };
        self
    }

    /// The same turned clockwise, degrees.
    #[must_use]
    pub fn turned(mut self, turn_deg: f64) -> Self {
        self.turn_deg = turn_deg;
        self
    }

    /// The same in another colour.
    #[must_use]
    pub fn inked(mut self, ink: impl Into<Ink>) -> Self {
        self.ink = ink.into();
        self
    }

    /// The same with a rim.
    #[must_use]
    pub fn haloed(mut self, width: f64, ink: impl Into<Ink>) -> Self {
        self.halo = Some(Halo { width, ink: ink.into() });
        self
    }

    /// Moves it.
    pub fn shift(&mut self, by: DVec2) {
        self.at += by;
        self.letters.iter_mut().for_each(|letter| letter.at += by);
    }

    /// Gives it another size; a bent line grows about its middle.
    pub fn resize(&mut self, size: f64) {
        let (share, bounds) = (size / self.size, self.bounds());
        for letter in &mut self.letters {
            letter.at = bounds.centre() + (letter.at - bounds.centre()) * share;
        }
        self.size = size;
    }

    /// The same bent along a curve from left to right: half of the capitals' height lies on it, and the text's middle
    /// this far along it. Before and after the curve it goes on straight. Letters that are joined stay on one line.
    #[must_use]
    pub fn along(mut self, curve: &[DVec2], middle: f64) -> Self {
        let begin = middle - 0.5 * self.width();
        let pieces = pieces(&self.text);
        if pieces.len() < 2 {
            let (at, along) = on_curve(curve, middle);
            (self.at, self.turn_deg) = (at, along.to_angle().to_degrees());
            return self.anchored(Across::Middle, Upright::Middle);
        }
        for piece in pieces {
            let [left, width] = [piece.left, piece.width].map(|share| f64::from(share) * self.size);
            let (place, along) = on_curve(curve, begin + left + 0.5 * width);
            let at = place - 0.5 * width * along + 0.5 * CAPITALS * self.size * along.perp();
            self.letters.push(Letter { at, turn_deg: along.to_angle().to_degrees(), bytes: piece.said.len() });
        }
        self
    }

    /// The straight lines of text that it is made of: itself, or one for each letter of a bent line.
    pub fn straight(&self) -> Vec<Self> {
        if self.letters.is_empty() {
            return vec![self.clone()];
        }
        let mut begin = 0;
        let letter = |letter: &Letter| {
            let said = begin..begin + letter.bytes;
            begin = said.end;
            Self {
                text: self.text.get(said).unwrap_or_default().to_owned(),
                at: letter.at,
                anchor: Anchor::default(),
                turn_deg: letter.turn_deg,
                letters: Vec::new(),
                ..self.clone()
            }
        };
        self.letters.iter().map(letter).collect()
    }

    /// The same no wider than `room`, in a smaller size where that is enough and shortened to end in "…"
    /// where it would be smaller than [`crate::style::LEAST_TEXT_PT`]; empty without room for a letter.
    #[must_use]
    pub fn fitted(mut self, room: f64) -> Self {
        let width = self.width();
        // Rooms are often made for the widest of some texts.
        let room = room + ROUNDING;
        if width <= room {
            return self;
        }
        let least = crate::style::LEAST_TEXT_PT.min(self.size);
        self.size = (self.size * room / width).max(least);
        if self.width() > room + ROUNDING {
            let whole: Vec<char> = self.text.trim_end().chars().collect();
            let short = |count: usize| whole[..count].iter().collect::<String>().trim_end().to_owned() + "…";
            let fits = |count: &usize| width_of(&short(*count), self.size) <= room;
            self.text = (1..whole.len()).rev().find(fits).map_or_else(String::new, short);
        }
        self
    }

    /// Its length along the line, points.
    ///
    /// ```
    /// use page::list::Text;
    /// let text = Text::new(glam::DVec2::ZERO, "Top Chalk");
    /// let twice = text.clone().sized(2.0 * text.size);
    /// assert!((twice.width() - 2.0 * text.width()).abs() < 1e-3);
    /// ```
    pub fn width(&self) -> f64 {
        width_of(&self.text, self.size)
    }

    /// The left end of its baseline, before it is turned about [`Text::at`].
    pub(crate) fn baseline_start(&self) -> DVec2 {
        let left = match self.anchor.across {
            Across::Start => 0.0,
            Across::Middle => -0.5 * self.width(),
            Across::End => -self.width(),
        };
        let down = match self.anchor.upright {
            Upright::Baseline => 0.0,
            Upright::Middle => 0.5 * CAPITALS * self.size,
            Upright::Top => CAPITALS * self.size,
        };
        self.at + DVec2::new(left, down)
    }

    /// The left end of its baseline on the page, and the direction in which it is read.
    pub fn baseline(&self) -> (DVec2, DVec2) {
        let turn = DVec2::from_angle(self.turn_deg.to_radians());
        (self.at + turn.rotate(self.baseline_start() - self.at), turn)
    }

    /// The contours of its letters, to be filled by the non-zero rule.
    pub fn outline(&self) -> Path {
        let segments = self.straight().iter().flat_map(|line| line.straight_outline().segments).collect();
        Path { segments }
    }

    fn straight_outline(&self) -> Path {
        let (start, turn) = self.baseline();
        let place = |p: [f32; 2]| start + turn.rotate(DVec2::new(f64::from(p[0]), f64::from(p[1])));
        let mut path = Path::default();
        let mut end = None;
        for curve in outline_text(self.size as f32, &self.text) {
            let (first, segment) = match curve {
                TextCurve::Line([a, b]) => (a, Segment::Line(place(b))),
                TextCurve::Quad([a, b, c]) => {
                    // The same curve as a cubic one.
                    let (from, control, to) = (place(a), place(b), place(c));
                    (a, Segment::Cubic(from.lerp(control, 2.0 / 3.0), to.lerp(control, 2.0 / 3.0), to))
                }
                TextCurve::Cubic([a, b, c, d]) => (a, Segment::Cubic(place(b), place(c), place(d))),
            };
            let last = match curve {
                TextCurve::Line([.., last]) | TextCurve::Quad([.., last]) | TextCurve::Cubic([.., last]) => last,
            };
            if end != Some(first) {
                path.segments.push(Segment::Move(place(first)));
            }
            path.segments.push(segment);
            end = Some(last);
        }
        path
    }

    /// Its halo as a stroke of its contours; absent without one.
    pub(crate) fn rim(&self) -> Option<(Path, Stroke)> {
        let halo = self.halo?;
        Some((self.outline(), Stroke::new(2.0 * halo.width, halo.ink).round()))
    }

    /// The corners of its room from ascenders to descenders, turned: upper left, upper right, lower right,
    /// lower left. Of a straight line.
    pub fn corners(&self) -> [DVec2; 4] {
        let extent = measure_text(self.size as f32, &self.text);
        let (start, turn) = self.baseline();
        let (top, bottom) = (-f64::from(extent.ascent_px), f64::from(extent.descent_px));
        let right = f64::from(extent.width_px);
        [[0.0, top], [right, top], [right, bottom], [0.0, bottom]].map(|p| start + turn.rotate(DVec2::from_array(p)))
    }

    /// The smallest upright rectangle around it and its halo.
    pub fn bounds(&self) -> Rect {
        let mut corners = self.straight().into_iter().flat_map(|line| line.corners());
        let first = corners.next().unwrap_or(self.at);
        let bounds = corners.fold(Rect::new(first, first), |rect, corner| rect.around(corner));
        bounds.grown(self.halo.map_or(0.0, |halo| halo.width))
    }
}

/// The place this far along a curve, and the direction there; straight on beyond its ends.
fn on_curve(curve: &[DVec2], length: f64) -> (DVec2, DVec2) {
    let mut left = length;
    for (n, pair) in curve.windows(2).enumerate() {
        let step = pair[1] - pair[0];
        if left <= step.length() || n + 2 == curve.len() {
            let along = step.normalize_or(DVec2::X);
            return (pair[0] + along * left, along);
        }
        left -= step.length();
    }
    (curve.first().copied().unwrap_or_default(), DVec2::X)
}

/// Length of a line of text at a font size, points.
pub fn width_of(text: &str, size: f64) -> f64 {
    f64::from(measure_text(size as f32, text).width_px)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn anchors_stand_where_they_say() {
        let text = |across, upright| Text::new(DVec2::new(50.0, 20.0), "Hagel").sized(10.0).anchored(across, upright);
        let width = text(Across::Start, Upright::Baseline).width();
        let start = |across, upright| text(across, upright).baseline_start();
        assert_eq!(start(Across::Start, Upright::Baseline), DVec2::new(50.0, 20.0));
        assert!((start(Across::End, Upright::Baseline).x - (50.0 - width)).abs() < 1e-9);
        assert!((start(Across::Middle, Upright::Top) - DVec2::new(50.0 - 0.5 * width, 26.9)).length() < 1e-9);
    }

    #[test]
    fn a_turn_by_a_quarter_stands_text_on_its_side() {
        let flat = Text::new(DVec2::new(50.0, 20.0), "depth").sized(8.0).anchored(Across::Middle, Upright::Middle);
        let upright = flat.clone().turned(-90.0);
        let (a, b) = (flat.bounds(), upright.bounds());
        assert!((a.width() - b.height()).abs() < 1e-6 && (a.height() - b.width()).abs() < 1e-6);
    }

    #[test]
    fn a_bent_text_follows_its_curve_and_a_straight_curve_bends_nothing() {
        let line = [DVec2::new(0.0, 30.0), DVec2::new(60.0, 30.0), DVec2::new(200.0, 30.0)];
        let flat = Text::new(DVec2::ZERO, "Marl").sized(10.0).along(&line, 80.0);
        let straight = Text::new(DVec2::new(80.0, 30.0), "Marl").sized(10.0).anchored(Across::Middle, Upright::Middle);
        let (bent, plain) = (flat.outline().bounds().unwrap(), straight.outline().bounds().unwrap());
        assert!((bent.min - plain.min).length() < 0.3 && (bent.max - plain.max).length() < 0.3, "{bent:?} {plain:?}");
        // Half a circle of 50 points around (0, 0), clockwise as seen: letters stand around it, their feet inwards.
        let arc: Vec<DVec2> =
            (0..=180).map(|deg| 50.0 * DVec2::from_angle(f64::from(deg - 180).to_radians())).collect();
        let text = Text::new(DVec2::ZERO, "Limestone").sized(8.0).along(&arc, 25.0 * std::f64::consts::PI);
        for letter in text.straight() {
            let middle = letter.corners().iter().sum::<DVec2>() / 4.0;
            assert!((middle.length() - 50.0).abs() < 3.0, "{} at {middle}", letter.text);
            assert!((letter.turn_deg - (middle.to_angle().to_degrees() + 90.0)).abs() < 3.0);
        }
    }

    #[test]
    fn long_names_shrink_and_then_end_in_dots() {
        let name = Text::new(DVec2::ZERO, "Upper Jurassic mudstones of the northern basin margin").sized(8.0);
        assert_eq!(name.clone().fitted(1000.0), name);
        let little = name.clone().fitted(0.95 * name.width());
        assert!(little.text == name.text && little.size < 8.0);
        let short = name.clone().fitted(60.0);
        assert!(short.text.ends_with('…') && short.width() <= 60.0 && short.size >= crate::style::LEAST_TEXT_PT);
        // Dots alone would say nothing.
        assert_eq!(name.fitted(8.0).text, "");
    }
}
