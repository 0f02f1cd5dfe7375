//! Paths, and how they are filled and stroked.

use crate::Rect;
use glam::DVec2;
use serde::{Deserialize, Serialize};
use ttf::Colour;

/// A colour with an opacity.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Ink {
    /// The colour.
    pub colour: Colour,
    /// 0 = clear … 1 = opaque.
    pub opacity: f32,
}

impl Ink {
    /// Opaque black.
    pub const BLACK: Self = Self::solid(Colour::BLACK);
    /// Opaque white.
    pub const WHITE: Self = Self::solid(Colour::WHITE);

    /// An opaque colour.
    pub const fn solid(colour: Colour) -> Self {
        Self { colour, opacity: 1.0 }
    }

    /// A colour as through glass.
    pub const fn glass(colour: Colour, opacity: f32) -> Self {
        Self { colour, opacity }
    }
}

impl From<Colour> for Ink {
    fn from(colour: Colour) -> Self {
        Self::solid(colour)
    }
}

/// A step of a path.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Segment {
    /// Begins a new piece.
    Move(DVec2),
    /// A straight line.
    Line(DVec2),
    /// A cubic Bézier curve: two control points and the end.
    Cubic(DVec2, DVec2, DVec2),
    /// Back to where the piece began.
    Close,
}

/// Pieces of straight lines and curves.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Path {
    /// The steps; every piece begins with a [`Segment::Move`].
    pub segments: Vec<Segment>,
}

impl Path {
    /// A straight line from place to place.
    pub fn line(places: &[DVec2]) -> Self {
        let mut path = Self::default();
        path.add_line(places);
        path
    }

    /// A straight-edged area.
    pub fn polygon(places: &[DVec2]) -> Self {
        let mut path = Self::line(places);
        path.segments.push(Segment::Close);
        path
    }

    /// A rectangle.
    pub fn rect(rect: Rect) -> Self {
        Self::polygon(&[rect.min, DVec2::new(rect.max.x, rect.min.y), rect.max, DVec2::new(rect.min.x, rect.max.y)])
    }

    /// The rectangle that it is, if it is one as [`Self::rect`] makes them.
    pub(crate) fn as_rect(&self) -> Option<Rect> {
        let [Segment::Move(min), Segment::Line(_), Segment::Line(max), ..] = self.segments[..] else { return None };
        let rect = Rect::new(min, max);
        (*self == Self::rect(rect)).then_some(rect)
    }

    /// A circle of four cubic curves, off by less than 3 parts in 10 000 of its radius.
    pub fn circle(middle: DVec2, radius: f64) -> Self {
        // The usual constant: the curve meets the circle halfway, 4/3·(√2 − 1).
        const K: f64 = 0.552_284_749_830_793_6;
        let at = |x: f64, y: f64| middle + radius * DVec2::new(x, y);
        let quarter = |a: DVec2, b: DVec2| {
            Segment::Cubic(at(a.x + K * b.x, a.y + K * b.y), at(b.x + K * a.x, b.y + K * a.y), at(b.x, b.y))
        };
        let ends = [DVec2::X, DVec2::Y, -DVec2::X, -DVec2::Y];
        let mut segments = vec![Segment::Move(at(1.0, 0.0))];
        segments.extend((0..4).map(|n| quarter(ends[n], ends[(n + 1) % 4])));
        segments.push(Segment::Close);
        Self { segments }
    }

    /// Adds a piece.
    pub fn add_line(&mut self, places: &[DVec2]) {
        let mut places = places.iter().copied();
        self.segments.extend(places.next().map(Segment::Move));
        self.segments.extend(places.map(Segment::Line));
    }

    /// Moves it.
    pub fn shift(&mut self, by: DVec2) {
        for segment in &mut self.segments {
            match segment {
                Segment::Move(p) | Segment::Line(p) => *p += by,
                Segment::Cubic(a, b, c) => [a, b, c].into_iter().for_each(|p| *p += by),
                Segment::Close => {}
            }
        }
    }

    /// The smallest rectangle around all places and control points; `None` of an empty path.
    pub fn bounds(&self) -> Option<Rect> {
        let mut found: Option<Rect> = None;
        let mut add = |p: DVec2| found = Some(found.map_or(Rect::new(p, p), |rect| rect.around(p)));
        for segment in &self.segments {
            match *segment {
                Segment::Move(p) | Segment::Line(p) => add(p),
                Segment::Cubic(a, b, c) => [a, b, c].into_iter().for_each(&mut add),
                Segment::Close => {}
            }
        }
        found
    }
}

/// What counts as inside a path that crosses itself.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Rule {
    /// Places that the path goes around.
    #[default]
    NonZero,
    /// Places from which a ray crosses the path an odd number of times: holes need no direction.
    EvenOdd,
}

/// How the ends of a line look.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Cap {
    /// Cut off at the end.
    #[default]
    Butt,
    /// Half a disc beyond it.
    Round,
}

/// How a path is drawn along; corners are rounded.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Stroke {
    /// Width, points.
    pub width: f64,
    /// Colour.
    pub ink: Ink,
    /// Lengths of dashes and gaps in turn, points; none: a solid line.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub dashes: Vec<f64>,
    /// Ends of lines and dashes.
    #[serde(default)]
    pub cap: Cap,
}

impl Stroke {
    /// A solid line.
    pub fn new(width: f64, ink: impl Into<Ink>) -> Self {
        Self { width, ink: ink.into(), dashes: Vec::new(), cap: Cap::Butt }
    }

    /// The same in dashes: lengths of a dash and of a gap, points.
    #[must_use]
    pub fn dashed(mut self, dash: f64, gap: f64) -> Self {
        self.dashes = vec![dash, gap];
        self
    }

    /// Round dots of the line's own width, this far from one to the next, points.
    #[must_use]
    pub fn dotted(mut self, pitch: f64) -> Self {
        // A dash of no length with round caps is a disc.
        self.dashes = vec![0.0, pitch];
        self.cap = Cap::Round;
        self
    }

    /// The same with round ends.
    #[must_use]
    pub fn round(mut self) -> Self {
        self.cap = Cap::Round;
        self
    }
}

/// A path with its fill and its stroke; the stroke lies over the fill.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PathItem {
    /// Where.
    pub path: Path,
    /// Colour of the inside.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fill: Option<Ink>,
    /// What is inside.
    #[serde(default)]
    pub rule: Rule,
    /// The line along it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stroke: Option<Stroke>,
}

impl PathItem {
    /// A filled area.
    pub fn filled(path: Path, ink: impl Into<Ink>) -> Self {
        Self { path, fill: Some(ink.into()), rule: Rule::NonZero, stroke: None }
    }

    /// A line.
    pub fn stroked(path: Path, stroke: Stroke) -> Self {
        Self { path, fill: None, rule: Rule::NonZero, stroke: Some(stroke) }
    }

    /// The same with a line around it.
    #[must_use]
    pub fn outlined(mut self, stroke: Stroke) -> Self {
        self.stroke = Some(stroke);
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_circle_stays_within_its_radius() {
        let circle = Path::circle(DVec2::new(3.0, 4.0), 2.0);
        let bounds = circle.bounds().unwrap();
        assert!((bounds.min - DVec2::new(1.0, 2.0)).length() < 1e-12);
        assert!((bounds.max - DVec2::new(5.0, 6.0)).length() < 1e-12);
        let mut from = DVec2::ZERO;
        for segment in circle.segments {
            match segment {
                Segment::Move(p) | Segment::Line(p) => from = p,
                Segment::Cubic(a, b, c) => {
                    for n in 0..=20 {
                        let t = f64::from(n) / 20.0;
                        let u = 1.0 - t;
                        let p = u * u * u * from + 3.0 * u * u * t * a + 3.0 * u * t * t * b + t * t * t * c;
                        let off = p.distance(DVec2::new(3.0, 4.0)) / 2.0 - 1.0;
                        assert!(off.abs() < 3e-4, "{off}");
                    }
                    from = c;
                }
                Segment::Close => {}
            }
        }
    }
}
