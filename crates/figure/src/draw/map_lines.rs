//! Contours with their values on a map, after cartographers' habits (Imhof, 1975), and the faults over them.
//!
//! A value stands in its line, which is broken for it, along it, upright, where the line is straightest;
//! none over another, none where there is no room. Space: points of the page.

use super::map_faults::faults_drawn;
use crate::map::HorizonMap;
use crate::style::{INK, NUMBER_PT};
use glam::DVec2;
use page::Rect;
use page::list::{Across, Group, GroupKind, Ink, Item, Path, PathItem, Stroke, Text, Upright, width_of};
use ttf::Colour;

/// Room before and behind a label, and between labels, points.
const GAP: f64 = 2.6;
/// Least length of the chord under a label, as a share of the line it takes the place of.
const STRAIGHT: f64 = 0.96;
/// Distance between places that are tried, points.
const STEP: f64 = 4.0;
/// Least length of a line with a label, in lengths of the label: otherwise hardly anything of the line would be left.
const LEFT: f64 = 1.5;
/// Distance between labels on one line, points.
const AGAIN: f64 = 230.0;
/// Width of index contours and of the others, points.
const WIDTH: [f64; 2] = [0.9, 0.4];
/// Their opacity.
const OPACITY: [f32; 2] = [0.9, 0.6];
/// Height of a line of figures, font sizes.
const LINE: f64 = 1.1;

/// A place for a label on a line.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Label {
    /// Distances along the line at which it breaks and goes on.
    part: [f64; 2],
    /// Middle and half of the text's own width along it.
    middle: DVec2,
    half: DVec2,
}

/// A line with the distance of each of its places from the first.
pub(super) struct Measured {
    places: Vec<DVec2>,
    along: Vec<f64>,
}

impl Measured {
    pub(super) fn of(places: Vec<DVec2>) -> Self {
        let mut along = vec![0.0; places.len()];
        for n in 1..places.len() {
            along[n] = along[n - 1] + places[n].distance(places[n - 1]);
        }
        Self { places, along }
    }

    pub(super) fn length(&self) -> f64 {
        self.along.last().copied().unwrap_or(0.0)
    }

    pub(super) fn at(&self, s: f64) -> DVec2 {
        let n = self.along.partition_point(|&along| along < s).clamp(1, self.places.len() - 1);
        let step = (self.along[n] - self.along[n - 1]).max(1e-9);
        self.places[n - 1].lerp(self.places[n], ((s - self.along[n - 1]) / step).clamp(0.0, 1.0))
    }

    /// The places from one distance to another.
    pub(super) fn part(&self, [from, to]: [f64; 2]) -> Vec<DVec2> {
        let inner = self.places.iter().zip(&self.along).filter(|(_, along)| (from..to).contains(*along));
        std::iter::once(self.at(from)).chain(inner.map(|(place, _)| *place)).chain([self.at(to)]).collect()
    }

    /// A label of a size that begins at a distance along the line, and how straight the line is there.
    fn label(&self, from: f64, size: DVec2) -> Option<(f64, Label)> {
        let need = size.x + 2.0 * GAP;
        let (a, b) = (self.at(from), self.at(from + need));
        let straight = a.distance(b) / need;
        let way = (b - a).normalize_or_zero();
        let way = if way.x < 0.0 { -way } else { way };
        let label = Label { part: [from, from + need], middle: a.lerp(b, 0.5), half: way * (0.5 * size.x) };
        // A line that bends away under the text would strike it through.
        let near = label.middle.distance(self.at(from + 0.5 * need)) <= 0.3 * size.y;
        (straight >= STRAIGHT && near).then_some((straight, label))
    }

    /// Where labels of a size go, off lines of `faults`: the straightest free place first, then others at a distance from
    /// it.
    fn labels(&self, size: DVec2, within: Rect, faults: &[Label], taken: &mut Vec<Label>) -> Vec<Label> {
        if self.places.len() < 2 || self.length() < LEFT * (size.x + 2.0 * GAP) {
            return Vec::new();
        }
        let steps = ((self.length() - size.x - 2.0 * GAP) / STEP).floor().max(-1.0) as i64;
        let inner = within.grown(-0.5 * size.x);
        let tried = (0..=steps).filter_map(|n| self.label(n as f64 * STEP, size));
        let mut tried: Vec<(f64, Label)> = tried.filter(|(_, label)| inner.contains(label.middle)).collect();
        tried.sort_by(|a, b| b.0.total_cmp(&a.0));
        let closed = self.places.first() == self.places.last();
        let mut own: Vec<Label> = Vec::new();
        for (_, label) in tried {
            let apart = |other: &Label| (other.part[0] - label.part[0]).abs();
            let around = |other: &Label| self.length() - apart(other);
            let far = own.iter().all(|other| apart(other) >= AGAIN && (!closed || around(other) >= AGAIN));
            let is_free = || taken.iter().all(|other| label.clears(other, size.y + GAP));
            if far && is_free() && faults.iter().all(|line| label.clears(line, 0.5 * size.y)) {
                own.push(label);
                taken.push(label);
            }
        }
        own.sort_by(|a, b| a.part[0].total_cmp(&b.part[0]));
        own
    }
}

impl Label {
    /// A straight piece of another line.
    fn of_line(from: DVec2, to: DVec2) -> Self {
        Self { part: [0.0; 2], middle: from.lerp(to, 0.5), half: 0.5 * (to - from) }
    }

    /// A text that stands elsewhere, letter by letter.
    fn of_text(text: &Text) -> Vec<Self> {
        let of_line = |line: Text| {
            let [a, b, c, d] = line.corners();
            Self::of_line(0.5 * (a + d), 0.5 * (b + c))
        };
        text.straight().into_iter().map(of_line).collect()
    }

    fn ends(&self) -> [DVec2; 2] {
        [self.middle - self.half, self.middle + self.half]
    }

    /// Whether the middle lines of two labels are farther apart than `distance`.
    fn clears(&self, other: &Self, distance: f64) -> bool {
        let ([a, b], [c, d]) = (self.ends(), other.ends());
        let side = |p: DVec2, q: DVec2, r: DVec2| (q - p).perp_dot(r - p);
        let crosses = side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0;
        !crosses
            && [(a, [c, d]), (b, [c, d]), (c, [a, b]), (d, [a, b])].iter().all(|&(p, line)| off(p, line) >= distance)
    }
}

/// Distance of a place from a straight line between two.
fn off(p: DVec2, [a, b]: [DVec2; 2]) -> f64 {
    let way = b - a;
    let share = ((p - a).dot(way) / way.length_squared().max(1e-9)).clamp(0.0, 1.0);
    p.distance(a + way * share)
}

/// A text in a line.
fn in_line(label: &Label, text: String) -> Text {
    let text = Text::new(label.middle, text).sized(NUMBER_PT).inked(INK);
    let text = text.anchored(Across::Middle, Upright::Middle).turned(label.half.to_angle().to_degrees());
    text.haloed(0.9, Ink::glass(Colour::WHITE, 0.75))
}

/// The faults and contours, and over all of them the names of faults and the values of index contours where there is room
/// within a rectangle; `outline` is that of the map.
pub(super) fn drawn(shown: &HorizonMap, page: impl Fn(DVec2) -> DVec2, within: Rect, outline: &[DVec2]) -> [Group; 2] {
    let stroke = |is_index: bool| {
        let n = usize::from(!is_index);
        Stroke::new(WIDTH[n], Ink::glass(Colour::BLACK, OPACITY[n]))
    };
    let (faults, names) = faults_drawn(&shown.faults, &page, within, outline);
    let mut taken: Vec<Label> = names.iter().flat_map(Label::of_text).collect();
    let of_fault = |line: &[DVec2]| -> Vec<Label> {
        line.windows(2).map(|pair| Label::of_line(page(pair[0]), page(pair[1]))).collect()
    };
    let walls: Vec<Label> = shown.faults.iter().flat_map(|cut| of_fault(&cut.line)).collect();
    let (mut plain, mut index) = (Path::default(), Path::default());
    let mut texts: Vec<Item> = Vec::new();
    for contour in &shown.contours {
        let line = Measured::of(contour.line.iter().map(|place| page(*place)).collect());
        if !contour.is_index {
            plain.add_line(&line.places);
            continue;
        }
        let text = format!("{}", contour.value);
        let size = DVec2::new(width_of(&text, NUMBER_PT), LINE * NUMBER_PT);
        let labels = line.labels(size, within, &walls, &mut taken);
        let mut from = 0.0;
        for label in &labels {
            index.add_line(&line.part([from, label.part[0]]));
            from = label.part[1];
        }
        if line.places.len() > 1 {
            index.add_line(&line.part([from, line.length()]));
        }
        texts.extend(labels.iter().map(|label| Item::from(in_line(label, text.clone()))));
    }
    let lines =
        [(plain, false), (index, true)].map(|(path, is_index)| PathItem::stroked(path, stroke(is_index)).into());
    // Values over all lines, on a light rim, so that they are read on any colour.
    [
        Group::new(GroupKind::Annotation, "faults").with(faults),
        Group::new(GroupKind::Annotation, "contours").with(lines).with(texts),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    const SIZE: DVec2 = DVec2::new(30.0, 12.0);

    fn line(length: usize, at: impl Fn(f64) -> DVec2) -> Measured {
        Measured::of((0..=length).map(|n| at(n as f64)).collect())
    }

    fn room() -> Rect {
        Rect::new(DVec2::ZERO, DVec2::new(400.0, 300.0))
    }

    #[test]
    fn a_label_lies_along_its_line_and_upright_whichever_way_it_goes() {
        for sign in [1.0, -1.0] {
            let slanted = line(200, |s| DVec2::new(200.0 + sign * 0.8 * (s - 100.0), 150.0 + sign * 0.6 * (s - 100.0)));
            let labels = slanted.labels(SIZE, room(), &[], &mut Vec::new());
            assert_eq!(labels.len(), 1);
            assert!((labels[0].half.to_angle() - 0.6f64.atan2(0.8)).abs() < 1e-9);
            assert!((labels[0].part[1] - labels[0].part[0] - 30.0 - 2.0 * GAP).abs() < 1e-9);
        }
    }

    #[test]
    fn labels_keep_off_bends_rims_taken_places_and_one_another() {
        // A right angle: straight on both sides of its corner at 100.
        let bent = line(200, |s| if s < 100.0 { DVec2::new(100.0 + s, 100.0) } else { DVec2::new(200.0, s) });
        for label in bent.labels(SIZE, room(), &[], &mut Vec::new()) {
            assert!(label.part[1] <= 107.0 || label.part[0] >= 93.0, "{label:?}");
        }
        let ring = line(60, |s| DVec2::new(200.0, 150.0) + 9.0 * DVec2::from_angle(s * PI / 30.0));
        assert!(ring.labels(SIZE, room(), &[], &mut Vec::new()).is_empty(), "no room on a ring of 9 points");
        let outside = line(200, |s| DVec2::new(s, 3.0));
        assert!(outside.labels(SIZE, room(), &[], &mut Vec::new()).is_empty());
        // A name of a fault beside the line.
        let name =
            Text::new(DVec2::new(90.0, 106.0), "A fault with a name as long as the line beside it").sized(NUMBER_PT);
        let under = line(60, |s| DVec2::new(100.0 + s, 100.0));
        assert!(!under.labels(SIZE, room(), &[], &mut Vec::new()).is_empty());
        assert!(under.labels(SIZE, room(), &[], &mut Label::of_text(&name)).is_empty());
        // A fault beside the line, and a line hardly longer than its label.
        let fault = |y: f64| [Label::of_line(DVec2::new(90.0, y), DVec2::new(170.0, y))];
        assert!(under.labels(SIZE, room(), &fault(105.0), &mut Vec::new()).is_empty());
        assert!(!under.labels(SIZE, room(), &fault(107.0), &mut Vec::new()).is_empty());
        let short = line(45, |s| DVec2::new(100.0 + s, 100.0));
        assert!(short.labels(SIZE, room(), &[], &mut Vec::new()).is_empty());
        // Lines every 4 points: a label and its gap need more.
        let mut taken = Vec::new();
        for n in 0..12 {
            line(200, |s| DVec2::new(100.0 + s, 100.0 + 4.0 * f64::from(n))).labels(SIZE, room(), &[], &mut taken);
        }
        assert!(taken.len() >= 3);
        for (n, label) in taken.iter().enumerate() {
            assert!(taken[..n].iter().all(|other| label.clears(other, SIZE.y + GAP)));
        }
    }

    #[test]
    fn a_line_broken_for_its_label_is_otherwise_whole() {
        let straight = line(200, |s| DVec2::new(100.0 + s, 100.0));
        let length = |part: [f64; 2]| Measured::of(straight.part(part)).length();
        assert!((length([0.0, 70.5]) - 70.5).abs() < 1e-9 && (length([106.5, 200.0]) - 93.5).abs() < 1e-9);
    }
}
