//! Values on index contours, after cartographers' habits (Imhof, 1975): in the line, which is broken for them, along it, upright, where it is straightest; none
//! over another, none where there is no room. Space: points on the screen.

use crate::work::map::Contour;
use eframe::egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Shape, Stroke, Vec2, epaint::TextShape, vec2};
use std::f32::consts::PI;

/// Room before and behind a label, and between labels.
const GAP: f32 = 5.0;
/// Least length of the chord under a label, as a share of the line it takes the place of.
const STRAIGHT: f32 = 0.96;
/// Distance between places that are tried, and between labels on one line.
const STEP: f32 = 8.0;
const AGAIN: f32 = 420.0;
/// Index contours and the others.
const WIDTH: [f32; 2] = [1.6, 0.7];

/// A place for a label on a line.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Label {
    /// Distances along the line at which it breaks and goes on.
    part: [f32; 2],
    /// Middle and half of the text's own width along it.
    middle: Pos2,
    half: Vec2,
    angle: f32,
}

/// A line with the distance of each of its places from the first.
struct Measured {
    places: Vec<Pos2>,
    along: Vec<f32>,
}

impl Measured {
    fn of(places: Vec<Pos2>) -> Self {
        let mut along = vec![0.0; places.len()];
        for n in 1..places.len() {
            along[n] = along[n - 1] + places[n].distance(places[n - 1]);
        }
        Self { places, along }
    }

    fn length(&self) -> f32 {
        self.along.last().copied().unwrap_or(0.0)
    }

    fn at(&self, s: f32) -> Pos2 {
        let n = self.along.partition_point(|&along| along < s).clamp(1, self.places.len() - 1);
        let step = (self.along[n] - self.along[n - 1]).max(1e-6);
        self.places[n - 1].lerp(self.places[n], ((s - self.along[n - 1]) / step).clamp(0.0, 1.0))
    }

    /// The places from one distance to another.
    fn part(&self, [from, to]: [f32; 2]) -> Vec<Pos2> {
        let inner = self.places.iter().zip(&self.along).filter(|(_, along)| (from..to).contains(*along));
        std::iter::once(self.at(from)).chain(inner.map(|(place, _)| *place)).chain([self.at(to)]).collect()
    }

    /// Where labels of a size go: the straightest free place first, then others at a distance from it.
    fn labels(&self, size: Vec2, room: Rect, taken: &mut Vec<Label>) -> Vec<Label> {
        let need = size.x + 2.0 * GAP;
        let mut tried: Vec<(f32, Label)> = Vec::new();
        let steps = ((self.length() - need) / STEP).floor();
        for n in 0..=steps.max(-1.0) as i32 {
            let from = n as f32 * STEP;
            let (a, b) = (self.at(from), self.at(from + need));
            let straight = a.distance(b) / need;
            let way = (b - a).normalized();
            let way = if way.x < 0.0 { -way } else { way };
            let label = Label {
                part: [from, from + need],
                middle: a.lerp(b, 0.5),
                half: way * (0.5 * size.x),
                angle: way.angle(),
            };
            let inside = room.shrink(0.5 * size.x).contains(label.middle);
            // A line that bends away under the text would strike it through.
            let near = label.middle.distance(self.at(from + 0.5 * need)) <= 0.3 * size.y;
            if straight >= STRAIGHT && inside && near {
                tried.push((straight, label));
            }
        }
        tried.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut own: Vec<Label> = Vec::new();
        for (_, label) in tried {
            let apart = |other: &Label| (other.part[0] - label.part[0]).abs();
            let around = |other: &Label| self.length() - apart(other);
            let closed = self.places.first() == self.places.last();
            let far = own.iter().all(|other| apart(other) >= AGAIN && (!closed || around(other) >= AGAIN));
            if far && taken.iter().all(|other| label.clears(other, size.y + GAP)) {
                own.push(label);
                taken.push(label);
            }
        }
        own.sort_by(|a, b| a.part[0].total_cmp(&b.part[0]));
        own
    }
}

impl Label {
    fn ends(&self) -> [Pos2; 2] {
        [self.middle - self.half, self.middle + self.half]
    }

    /// Whether the middle lines of two labels are farther apart than `distance`.
    fn clears(&self, other: &Self, distance: f32) -> bool {
        let ([a, b], [c, d]) = (self.ends(), other.ends());
        let side = |p: Pos2, q: Pos2, r: Pos2| (q - p).x * (r - p).y - (q - p).y * (r - p).x;
        let crosses = side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0;
        !crosses
            && [(a, [c, d]), (b, [c, d]), (c, [a, b]), (d, [a, b])].iter().all(|&(p, line)| off(p, line) >= distance)
    }
}

/// Distance of a place from a straight line between two.
fn off(p: Pos2, [a, b]: [Pos2; 2]) -> f32 {
    let way = b - a;
    let share = ((p - a).dot(way) / way.length_sq().max(1e-6)).clamp(0.0, 1.0);
    p.distance(a + way * share)
}

/// Paints contours, and the values of index contours where `room` has room.
pub(super) fn paint(painter: &Painter, contours: &[Contour], screen: impl Fn(glam::DVec2) -> Pos2, room: Rect) {
    let font = FontId::proportional(12.5);
    let ink = Color32::BLACK;
    let mut taken = Vec::new();
    let mut texts = Vec::new();
    for contour in contours {
        let stroke = Stroke::new(
            WIDTH[usize::from(!contour.is_index)],
            Color32::from_black_alpha(if contour.is_index { 220 } else { 150 }),
        );
        let line = Measured::of(contour.line.iter().map(|place| screen(*place)).collect());
        if !contour.is_index {
            painter.add(Shape::line(line.places, stroke));
            continue;
        }
        let galley = painter.layout_no_wrap(format!("{}", contour.value), font.clone(), ink);
        let labels = line.labels(galley.size(), room, &mut taken);
        let mut from = 0.0;
        for label in &labels {
            painter.add(Shape::line(line.part([from, label.part[0]]), stroke));
            from = label.part[1];
        }
        painter.add(Shape::line(line.part([from, line.length()]), stroke));
        texts.extend(labels.into_iter().map(|label| (label, galley.clone())));
    }
    // Over all lines, on a light rim, so that they are read on any colour.
    for (label, galley) in texts {
        let at = label.middle - 0.5 * galley.size();
        let text = |off: Vec2, colour: Color32| {
            TextShape::new(at + off, galley.clone(), colour)
                .with_override_text_color(colour)
                .with_angle_and_anchor(label.angle, Align2::CENTER_CENTER)
        };
        for n in 0..8 {
            let (y, x) = (n as f32 * PI / 4.0).sin_cos();
            painter.add(text(vec2(x, y) * 1.4, Color32::from_white_alpha(220)));
        }
        painter.add(text(Vec2::ZERO, ink));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::pos2;

    const SIZE: Vec2 = Vec2::new(30.0, 12.0);

    fn line(length: usize, at: impl Fn(f32) -> Pos2) -> Measured {
        Measured::of((0..=length).map(|n| at(n as f32)).collect())
    }

    fn room() -> Rect {
        Rect::from_min_max(pos2(0.0, 0.0), pos2(400.0, 300.0))
    }

    #[test]
    fn a_label_lies_along_its_line_and_upright_whichever_way_it_goes() {
        for sign in [1.0, -1.0] {
            let slanted = line(200, |s| pos2(200.0 + sign * 0.8 * (s - 100.0), 150.0 + sign * 0.6 * (s - 100.0)));
            let labels = slanted.labels(SIZE, room(), &mut Vec::new());
            assert_eq!(labels.len(), 1);
            assert!((labels[0].angle - 0.6f32.atan2(0.8)).abs() < 1e-4, "{}", labels[0].angle);
            assert!((labels[0].part[1] - labels[0].part[0] - 40.0).abs() < 1e-4);
        }
    }

    #[test]
    fn labels_keep_off_bends_rims_and_one_another() {
        // A right angle: straight on both sides of its corner at 100.
        let bent = line(200, |s| if s < 100.0 { pos2(100.0 + s, 100.0) } else { pos2(200.0, s) });
        for label in bent.labels(SIZE, room(), &mut Vec::new()) {
            assert!(label.part[1] <= 107.0 || label.part[0] >= 93.0, "{label:?}");
        }
        let ring = line(60, |s| pos2(200.0, 150.0) + 9.0 * Vec2::angled(s * PI / 30.0));
        assert!(ring.labels(SIZE, room(), &mut Vec::new()).is_empty(), "no room on a ring of 9 points");
        let outside = line(200, |s| pos2(s, 3.0));
        assert!(outside.labels(SIZE, room(), &mut Vec::new()).is_empty());
        // Lines every 4 points: a label and its gap need 17.
        let mut taken = Vec::new();
        for n in 0..12 {
            line(200, |s| pos2(100.0 + s, 100.0 + 4.0 * n as f32)).labels(SIZE, room(), &mut taken);
        }
        assert!(taken.len() >= 3);
        for (n, label) in taken.iter().enumerate() {
            assert!(taken[..n].iter().all(|other| label.clears(other, SIZE.y + GAP)));
        }
    }

    #[test]
    fn a_line_broken_for_its_label_is_otherwise_whole() {
        let straight = line(200, |s| pos2(100.0 + s, 100.0));
        let length = |part: [f32; 2]| Measured::of(straight.part(part)).length();
        assert!((length([0.0, 70.5]) - 70.5).abs() < 1e-3 && (length([106.5, 200.0]) - 93.5).abs() < 1e-3);
    }
}
