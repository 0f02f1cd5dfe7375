//! The room that labels share: who comes first keeps its place.

use crate::convex::meet;
use glam::DVec2;
use page::Rect;
use page::list::Text;

/// Free around every label, points.
const APART_PT: f64 = 0.8;

/// A convex polygon on the page.
type Convex = Vec<DVec2>;

/// What is taken of a page.
#[derive(Debug, Clone)]
pub(crate) struct LabelRoom {
    within: Rect,
    taken: Vec<Convex>,
    /// Lines that letters do not stand on, and that leaders cross unwillingly.
    lines: Vec<[DVec2; 2]>,
}

impl LabelRoom {
    /// All of a rectangle.
    pub(crate) fn new(within: Rect) -> Self {
        Self { within, taken: Vec::new(), lines: Vec::new() }
    }

    /// Whether a text lies within the room and on nothing that is taken.
    pub(crate) fn is_free(&self, text: &Text) -> bool {
        outlines(text).all(|outline| self.is_area_free(&outline))
    }

    /// Whether nothing that is taken lies on a straight line.
    pub(crate) fn is_clear(&self, from: DVec2, to: DVec2) -> bool {
        !self.taken.iter().any(|other| meet(&[from, to], other))
    }

    /// The upper and the lower end of the room.
    pub(crate) fn heights(&self) -> [f64; 2] {
        [self.within.min.y, self.within.max.y]
    }

    /// How many lines a straight line crosses.
    pub(crate) fn crossings(&self, from: DVec2, to: DVec2) -> usize {
        self.lines.iter().filter(|line| meet(&[from, to], *line)).count()
    }

    /// Takes the place of a line.
    pub(crate) fn take_line(&mut self, from: DVec2, to: DVec2) {
        self.lines.push([from, to]);
    }

    /// Takes the place of a text.
    pub(crate) fn take(&mut self, text: &Text) {
        self.taken.extend(outlines(text));
    }

    /// Whether a convex polygon lies within the room and on nothing that is taken.
    pub(crate) fn is_area_free(&self, area: &[DVec2]) -> bool {
        area.iter().all(|corner| self.within.contains(*corner))
            && !self.taken.iter().any(|other| meet(area, other))
            && !self.lines.iter().any(|line| meet(area, line))
    }

    /// Takes the place of a convex polygon.
    pub(crate) fn take_area(&mut self, area: &[DVec2]) {
        self.taken.push(area.to_vec());
    }

    /// Takes the place of a text if it is free, and says whether it was.
    pub(crate) fn try_take(&mut self, text: &Text) -> bool {
        let is_free = self.is_free(text);
        if is_free {
            self.take(text);
        }
        is_free
    }
}

/// The rectangles of a text's straight lines with what is free around them.
pub(crate) fn outlines(text: &Text) -> impl Iterator<Item = Convex> + use<> {
    text.straight().into_iter().map(|line| {
        let [a, b, c, d] = line.corners();
        let (right, down) = ((b - a).normalize_or_zero() * APART_PT, (d - a).normalize_or_zero() * APART_PT);
        vec![a - right - down, b + right - down, c + right + down, d - right + down]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turned_labels_side_by_side_do_not_meet_though_their_upright_bounds_do() {
        let text = |at: DVec2| Text::new(at, "Top Chalk").turned(-45.0);
        let mut room = LabelRoom::new(Rect::sized(DVec2::ZERO, DVec2::splat(200.0)));
        let (one, beside, over) = (DVec2::new(50.0, 100.0), DVec2::new(62.0, 112.0), DVec2::new(52.0, 102.0));
        assert!(text(one).bounds().meets(&text(beside).bounds()));
        assert!(room.try_take(&text(one)));
        assert!(!room.is_free(&text(over)) && room.try_take(&text(beside)));
        assert!(!room.is_free(&text(DVec2::new(190.0, 100.0))), "it leaves the room");
        assert!(!room.is_clear(DVec2::new(40.0, 80.0), DVec2::new(90.0, 90.0)));
        assert!(room.is_clear(DVec2::new(5.0, 5.0), DVec2::new(190.0, 5.0)));
    }
}
