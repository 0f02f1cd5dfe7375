//! Names of layers along the layers: on a face that is seen, halfway between the layer's boundaries, on the run where
//! the letters have most room.
//!
//! The middle line of a piece of a layer is sampled along the face, smoothed over a word's height, and tried from end
//! to end: every letter has to lie within the piece (so within the layer and its fault block) and within the part of
//! the face that is seen. A name that fits nowhere in a readable size stands beside the block, with a leader.

use super::room::LabelRoom;
use crate::convex::{holds, meet};
use crate::style::LEAST_TEXT_PT;
use glam::DVec2;
use page::list::{Halo, Text};
use render::vector::SeenSection;

/// Sizes that are tried, points: the first one that fits is taken.
const SIZES_PT: [f64; 4] = [8.5, 8.0, 7.5, LEAST_TEXT_PT];
/// Samples of a middle line.
const SAMPLES: usize = 240;
/// Distance of points of a smoothed line, and of the places that are tried, points.
const STEP_PT: f64 = 1.5;
/// Half the length over which a line is smoothed, points.
const SMOOTH_PT: f64 = 14.0;
/// Letters next to one another turn by no more than this, and all of a word by no more than the second, degrees.
const MOST_TURN_DEG: [f64; 2] = [16.0, 75.0];
/// The share of a line's height above capital letters.
const OVER_CAPITALS: f64 = 0.1;
/// Shares of a rim's width that are tried, so that it stays within the layer, too; letters cannot be read on a pattern
/// with less than the last.
const RIMS: [f64; 4] = [1.0, 0.85, 0.7, 0.5];
/// How far before an edge a leader ends in a layer that reaches it, points.
const BEFORE_PT: [f64; 2] = [2.5, 8.0];
/// What is seen thinner than this is not named, points: a face seen along its plane.
const LEAST_SEEN_PT: f64 = 0.05;
/// Steeper words are hard to read, degrees.
const STEEPEST_DEG: f64 = 70.0;
/// Room before and behind a name in its layer, in sizes of its letters; up to the second a place with more room is better.
const ENDS_EM: [f64; 2] = [0.5, 2.5];

/// A piece of a layer in one fault block on a face, as it lies on the page.
pub(super) struct LayerPiece {
    /// Layer, 0 = deepest.
    pub layer: u16,
    /// Its outline and holes.
    rings: Vec<Vec<DVec2>>,
    /// The parts of the face that are seen.
    seen: Vec<Vec<DVec2>>,
    /// Middle lines from left to right.
    lines: Vec<Vec<LinePlace>>,
}

/// A place of a smoothed middle line.
#[derive(Debug, Clone, Copy)]
struct LinePlace {
    at: DVec2,
    /// How thick the piece is there, points.
    thick: f64,
    is_seen: bool,
}

/// The pieces of layers on the seen upright faces; `px` takes voxels, `page` pixels to the page.
pub(super) fn pieces(
    faces: &[SeenSection],
    page_from_voxel: &dyn Fn(glam::DVec3) -> DVec2,
    page: &dyn Fn(DVec2) -> DVec2,
    air: Option<u16>,
) -> Vec<LayerPiece> {
    let mut all = Vec::new();
    for face in faces.iter().filter(|face| face.axis < 2) {
        let plane = face.section.plane;
        let placed = |st: DVec2| page_from_voxel(plane.voxel(st));
        for polygon in face.section.polygons.iter().filter(|polygon| Some(polygon.region.layer) != air) {
            let rings = polygon.rings.iter().map(|ring| ring.iter().map(|st| placed(*st)).collect()).collect();
            let seen = face.pieces.iter().map(|piece| piece.iter().map(|px| page(*px)).collect()).collect();
            let runs = middle_lines(&polygon.rings, plane.extent[0], &placed);
            all.push(LayerPiece::new(polygon.region.layer, rings, seen, &runs));
        }
    }
    all
}

/// Middle lines of a polygon in (s, t): one for each run of neighbouring samples along s whose thickest parts touch.
fn middle_lines(rings: &[Vec<DVec2>], extent: f64, placed: &dyn Fn(DVec2) -> DVec2) -> Vec<Vec<(DVec2, f64)>> {
    let mut runs: Vec<Vec<(DVec2, f64)>> = Vec::new();
    let mut last: Option<[f64; 2]> = None;
    for n in 0..SAMPLES {
        let s = (n as f64 + 0.5) / SAMPLES as f64 * extent;
        let mut crossings: Vec<f64> = Vec::new();
        for ring in rings {
            for (k, a) in ring.iter().enumerate() {
                let b = ring[(k + 1) % ring.len()];
                if (a.x > s) != (b.x > s) {
                    crossings.push(a.y + (s - a.x) / (b.x - a.x) * (b.y - a.y));
                }
            }
        }
        crossings.sort_by(f64::total_cmp);
        let parts = crossings.chunks_exact(2).map(|pair| [pair[0], pair[1]]);
        let thickest = parts.max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])));
        let Some([top, bottom]) = thickest else {
            last = None;
            continue;
        };
        let [upper, lower] = [top, bottom].map(|t| placed(DVec2::new(s, t)));
        let entry = (upper.midpoint(lower), upper.distance(lower));
        match (last.filter(|[t0, t1]| top < *t1 && bottom > *t0), runs.last_mut()) {
            (Some(_), Some(run)) => run.push(entry),
            _ => runs.push(vec![entry]),
        }
        last = Some([top, bottom]);
    }
    for run in &mut runs {
        if run.len() > 1 && run[0].0.x > run[run.len() - 1].0.x {
            run.reverse();
        }
    }
    runs
}

/// Places `STEP_PT` apart along a line.
fn evenly(line: &[DVec2]) -> Vec<DVec2> {
    let mut even: Vec<DVec2> = Vec::new();
    let mut left = 0.0;
    for pair in line.windows(2) {
        let length = pair[0].distance(pair[1]);
        while left < length {
            even.push(pair[0].lerp(pair[1], left / length));
            left += STEP_PT;
        }
        left -= length;
    }
    even
}

/// A line with places `STEP_PT` apart, smoothed.
fn smooth(run: &[(DVec2, f64)]) -> Vec<DVec2> {
    let mut even = evenly(&run.iter().map(|(at, _)| *at).collect::<Vec<_>>());
    let reach = (SMOOTH_PT / STEP_PT) as usize;
    for _ in 0..2 {
        let mean = |n: usize| {
            // The same on both sides, so that ends stay where they are.
            let reach = reach.min(n).min(even.len() - 1 - n);
            even[n - reach..=n + reach].iter().sum::<DVec2>() / (2 * reach + 1) as f64
        };
        even = (0..even.len()).map(mean).collect();
    }
    // Smoothing shortens bends.
    evenly(&even)
}

impl LayerPiece {
    fn new(layer: u16, rings: Vec<Vec<DVec2>>, seen: Vec<Vec<DVec2>>, runs: &[Vec<(DVec2, f64)>]) -> Self {
        let line = |run: &Vec<(DVec2, f64)>| {
            let place = |at: DVec2| {
                let near = run.iter().min_by(|a, b| a.0.distance_squared(at).total_cmp(&b.0.distance_squared(at)));
                let is_seen = seen.iter().any(|piece| holds(piece, at));
                LinePlace { at, thick: near.map_or(0.0, |(_, thick)| *thick), is_seen }
            };
            smooth(run).into_iter().map(place).collect()
        };
        let lines = runs.iter().map(line).collect();
        Self { layer, rings, seen, lines }
    }

    /// The best place for a name on this piece, and how good it is: larger letters first, then straighter words in
    /// thicker parts.
    pub(super) fn named(&self, name: &Text, room: &LabelRoom) -> Option<(Text, f64)> {
        for (n, size) in SIZES_PT.into_iter().enumerate() {
            let text = name.clone().sized(size);
            let fits = self.lines.iter().flat_map(|line| self.along(line, &text, room));
            if let Some((text, score)) = fits.max_by(|a, b| a.1.total_cmp(&b.1)) {
                return Some((self.rimmed(text), score - 1000.0 * n as f64));
            }
        }
        None
    }

    fn along(&self, line: &[LinePlace], text: &Text, room: &LabelRoom) -> Vec<(Text, f64)> {
        let places: Vec<DVec2> = line.iter().map(|place| place.at).collect();
        let (length, width) = (line.len().saturating_sub(1) as f64 * STEP_PT, text.width());
        let [least, most] = ENDS_EM.map(|em| em * text.size);
        let mut found = Vec::new();
        let mut middle = 0.5 * width + least;
        while middle <= length - 0.5 * width - least {
            let [first, last] = [middle - 0.5 * width, middle + 0.5 * width].map(|at| (at / STEP_PT) as usize);
            let (first, last) = (first.min(line.len() - 1), last.min(line.len() - 1));
            let below = &line[first..=last];
            let thick = below.iter().map(|place| place.thick).fold(f64::INFINITY, f64::min);
            if thick > 0.9 * text.size && below.iter().all(|place| place.is_seen) {
                let seen = |places: usize| places as f64 * STEP_PT;
                let before = seen(line[..first].iter().rev().take_while(|place| place.is_seen).count());
                let behind = seen(line[last + 1..].iter().take_while(|place| place.is_seen).count());
                let bent = text.clone().along(&places, middle);
                if let Some(turn) = readable(&bent).filter(|_| self.holds(&bent, least) && room.is_free(&bent)) {
                    found.push((bent, thick.min(5.0 * text.size) - 0.6 * turn + before.min(behind).min(most)));
                }
            }
            middle += 2.0 * STEP_PT;
        }
        found
    }

    /// Whether all letters lie within the piece, and are seen, with so much room before the first and behind the last.
    fn holds(&self, text: &Text, ends: f64) -> bool {
        let mut areas: Vec<[DVec2; 4]> = text.straight().iter().map(letter_box).collect();
        areas.sort_by(|a, b| a[0].x.total_cmp(&b[0].x));
        // Room for the middle of letters: the layer may bend.
        let beyond = |[a, b, c, d]: [DVec2; 4], by: f64| {
            let step = (b - a).normalize_or_zero() * by;
            let side = if by < 0.0 { [a.lerp(d, 0.3), a.lerp(d, 0.7)] } else { [b.lerp(c, 0.3), b.lerp(c, 0.7)] };
            [side[0], side[0] + step, side[1] + step, side[1]]
        };
        let before = areas.first().map(|first| beyond(*first, -ends));
        let behind = areas.last().map(|last| beyond(*last, ends));
        areas.extend(before.into_iter().chain(behind));
        areas.iter().all(|area| {
            !self.is_crossed(area) && self.is_inside(area[0]) && area.iter().all(|corner| self.is_seen(*corner))
        })
    }

    fn is_crossed(&self, letter: &[DVec2]) -> bool {
        self.rings.iter().any(|ring| {
            (0..ring.len()).any(|n| {
                let side = [ring[n], ring[(n + 1) % ring.len()]];
                is_near(&side, letter) && meet(&side, letter)
            })
        })
    }

    /// The text with the widest rim that covers no boundary, or the narrowest.
    fn rimmed(&self, text: Text) -> Text {
        let Some(halo) = text.halo else { return text };
        let letters: Vec<[DVec2; 4]> = text.straight().iter().map(letter_box).collect();
        let fits = |share: &f64| letters.iter().all(|letter| !self.is_crossed(&grown(letter, share * halo.width)));
        let share = RIMS.into_iter().find(fits).unwrap_or(RIMS[3]);
        Text { halo: Some(Halo { width: share * halo.width, ..halo }), ..text }
    }

    /// Whether a place lies in the piece, by the even-odd rule.
    fn is_inside(&self, place: DVec2) -> bool {
        let mut inside = false;
        for ring in &self.rings {
            for (n, a) in ring.iter().enumerate() {
                let b = ring[(n + 1) % ring.len()];
                if (a.y > place.y) != (b.y > place.y) && place.x < a.x + (place.y - a.y) / (b.y - a.y) * (b.x - a.x) {
                    inside = !inside;
                }
            }
        }
        inside
    }

    fn is_seen(&self, place: DVec2) -> bool {
        self.seen.iter().any(|piece| holds(piece, place))
    }

    /// The place of the piece where it is seen thickest, and that thickness, points.
    pub(super) fn thickest(&self) -> Option<(DVec2, f64)> {
        self.seen_places().max_by(|a, b| a.thick.total_cmp(&b.thick)).map(|place| (place.at, place.thick))
    }

    /// The last place before an edge on the right that the piece reaches, and how thick it is there, points.
    pub(super) fn before(&self, edge: f64) -> Option<(DVec2, f64)> {
        let near = self.seen_places().filter(|place| (BEFORE_PT[0]..BEFORE_PT[1]).contains(&(edge - place.at.x)));
        near.max_by(|a, b| a.at.x.total_cmp(&b.at.x)).map(|place| (place.at, place.thick))
    }

    fn seen_places(&self) -> impl Iterator<Item = &LinePlace> {
        let places = self.lines.iter().flatten();
        places.filter(|place| place.thick >= LEAST_SEEN_PT && place.is_seen && self.is_inside(place.at))
    }
}

/// Where the pieces end on the right, x on the page.
pub(super) fn right_edge(pieces: &[LayerPiece]) -> f64 {
    pieces.iter().flat_map(LayerPiece::seen_places).map(|place| place.at.x).fold(f64::NEG_INFINITY, f64::max)
}

/// The room of a letter from the height of capitals down to its descender.
fn letter_box(letter: &Text) -> [DVec2; 4] {
    let [a, b, c, d] = letter.corners();
    [a.lerp(d, OVER_CAPITALS), b.lerp(c, OVER_CAPITALS), c, d]
}

/// A letter's box and its rim: larger by `rim` on all sides.
fn grown([a, b, c, d]: &[DVec2; 4], rim: f64) -> [DVec2; 4] {
    let (along, down) = ((b - a).normalize_or_zero() * rim, (d - a).normalize_or_zero() * rim);
    [*a - along - down, *b + along - down, *c + along + down, *d - along + down]
}

fn is_near(side: &[DVec2; 2], letter: &[DVec2]) -> bool {
    let low = letter.iter().copied().fold(DVec2::INFINITY, DVec2::min);
    let high = letter.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
    side[0].min(side[1]).cmple(high).all() && side[0].max(side[1]).cmpge(low).all()
}

/// How much a bent text turns from its first letter to its last, degrees; `None` where it is too steep or bent to be read.
fn readable(text: &Text) -> Option<f64> {
    let is_upright = text.straight().iter().all(|letter| letter.turn_deg.abs() < STEEPEST_DEG);
    turning(text).filter(|_| is_upright)
}

/// How much a bent text turns from its first letter to its last, degrees; `None` where it is too bent to be read.
pub(crate) fn turning(text: &Text) -> Option<f64> {
    let turns: Vec<f64> = text.straight().iter().map(|letter| letter.turn_deg).collect();
    let jump = turns.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
    let low = turns.iter().copied().fold(f64::INFINITY, f64::min);
    let high = turns.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    (jump < MOST_TURN_DEG[0] && high - low < MOST_TURN_DEG[1]).then_some(high - low)
}

#[cfg(test)]
mod tests;
