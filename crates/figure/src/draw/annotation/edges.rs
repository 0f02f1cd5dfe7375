//! Axes on the block's edges: inline, crossline and depth or time along the edges of its silhouette, with round
//! numbers and titles outside it.
//!
//! An edge of a convex block belongs to the silhouette if one of its two faces looks at the camera and the other does
//! not. Of those along inlines and crosslines the lowest on the page is chosen, of the upright ones the leftmost.

use super::room::LabelRoom;
use crate::cut::value_at;
use crate::draw::axes::{axis_title, round_step};
use crate::style::{FRAME_PT, NUMBER_PT, QUIET_INK, TEXT_PT, TICK_PT};
use glam::{DVec2, DVec3};
use page::Rect;
use page::list::{Across, Group, GroupKind, Path, PathItem, Stroke, Text, Upright, width_of};
use render::{View, VoxelBox};
use survey::SurveyGeometry;

/// Edges that are seen shorter than this carry no axis, points.
const SHORTEST_PT: f64 = 18.0;
/// Between a tick and its number, and between numbers and the title, points.
const GAP_PT: f64 = 2.0;
/// Least distance of numbers along an edge, points; the second one where there would be fewer than so many otherwise, if need
/// be at quarters of a round value.
const EVERY_PT: [f64; 2] = [24.0, 17.0];
const FEW: usize = 4;
/// Height of a number's letters as they stand on a line, as a share of their size.
const HEIGHT: f64 = 1.15;
/// Distance of the places at which a line is asked whether an edge of the block lies on it, points.
const STEP_PT: f64 = 0.25;
/// How far within the block an edge is asked for, as a share of the way to the block's middle.
const WITHIN: f64 = 1e-3;
/// Where along its edge a title may stand, the best place first.
const PLACES: [f64; 9] = [0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8, 0.1, 0.9];
/// How much farther out than close to the numbers a title may stand, points.
const FARTHER_PT: [f64; 3] = [0.0, 5.0, 10.0];

/// An edge of the silhouette with its numbers.
struct OuterEdge {
    axis: usize,
    /// Ends, voxels: the lower index first.
    ends: [DVec3; 2],
    /// Away from the block, of length 1 on the page.
    outward: DVec2,
}

/// The three edges that carry axes, as far as they are seen; `page` takes voxels to the page.
fn outer_edges(view: &View, block: &VoxelBox, page: &dyn Fn(DVec3) -> DVec2) -> Vec<OuterEdge> {
    let corners = [block.low(), block.high()];
    let middle = page(block.centre());
    let edge = |axis: usize| {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let along = |n: usize| {
            let (at_u, at_v) = (n & 1, n >> 1);
            let end = |at: usize| {
                let mut p = corners[at];
                (p[u], p[v]) = (corners[at_u][u], corners[at_v][v]);
                p
            };
            let ends = [end(0), end(1)];
            let faces_camera = |axis: usize, at: usize| {
                let normal = DVec3::AXES[axis] * if at == 0 { -1.0 } else { 1.0 };
                view.towards_camera(ends[0].midpoint(ends[1])).dot(normal) > 1e-9
            };
            (faces_camera(u, at_u) != faces_camera(v, at_v)).then_some(ends)
        };
        let place = |ends: &[DVec3; 2]| {
            let middle = page(ends[0]).midpoint(page(ends[1]));
            if axis == 2 { -middle.x } else { middle.y }
        };
        let ends = (0..4).filter_map(along).max_by(|a, b| place(a).total_cmp(&place(b)))?;
        let [from, to] = ends.map(page);
        let across = (to - from).try_normalize()?.perp();
        let is_inwards = across.dot(middle - from.midpoint(to)) > 0.0;
        let is_long = from.distance(to) >= SHORTEST_PT;
        is_long.then_some(OuterEdge { axis, ends, outward: if is_inwards { -across } else { across } })
    };
    (0..3).filter_map(edge).collect()
}

/// The axes of a block in `room`; labels that find no place are left out. Where the block has an edge of its own, which is
/// where `is_rock` (voxels) holds just within, it carries the axis, and no second line lies over it.
pub(super) fn drawn(
    geometry: &SurveyGeometry,
    view: &View,
    block: &VoxelBox,
    pane: Rect,
    page: &dyn Fn(DVec3) -> DVec2,
    is_rock: &dyn Fn(DVec3) -> bool,
    room: &mut LabelRoom,
) -> Group {
    let mut group = Group::new(GroupKind::Annotation, "axes");
    let mut marks = Path::default();
    let edges = outer_edges(view, block, page);
    let mut titles = Vec::new();
    for edge in &edges {
        let [from, to] = edge.ends.map(page);
        for part in edge.bare((block.centre(), pane), page, is_rock) {
            marks.add_line(&part);
        }
        room.take_line(from, to);
        let mut reach = 0.0f64;
        for (value, voxel) in edge.ticks(geometry, page) {
            let foot = page(voxel);
            if !pane.contains(foot) {
                continue;
            }
            let number = beside(foot + edge.outward * (TICK_PT + GAP_PT), edge.outward, value);
            // Side by side with one of another axis it would be read as one number.
            let spaced = Text { text: format!("  {}  ", number.text), ..number.clone() };
            if room.is_free(&spaced) {
                room.take(&number);
                marks.add_line(&[foot, foot + edge.outward * TICK_PT]);
                reach = reach.max(2.0 * support(&number, edge.outward));
                group.push(number);
            }
        }
        titles.push((edge, reach));
    }
    // Titles yield to the numbers of all axes.
    for (edge, reach) in titles {
        let seen = || PLACES.into_iter().filter(|share| pane.contains(page(edge.ends[0].lerp(edge.ends[1], *share))));
        let places = FARTHER_PT.into_iter().flat_map(|farther| seen().map(move |share| (share, reach + farther)));
        let mut titles = places.map(|(share, reach)| edge.title(share, reach, geometry, page));
        let title = titles.find(|title| room.is_free(title)).or_else(|| edge.title_above(geometry, pane, page, room));
        if let Some(title) = title {
            room.take(&title);
            group.push(title);
        }
    }
    group.items.insert(0, PathItem::stroked(marks, Stroke::new(FRAME_PT, QUIET_INK)).into());
    group
}

/// A number whose nearest side lies at a place, in a direction from it.
fn beside(place: DVec2, outward: DVec2, value: String) -> Text {
    let number = Text::new(place, value).sized(NUMBER_PT).inked(QUIET_INK).anchored(Across::Middle, Upright::Middle);
    let at = place + outward * support(&number, outward);
    Text { at, ..number }
}

/// How far an upright text reaches from its middle in a direction.
fn support(text: &Text, towards: DVec2) -> f64 {
    0.5 * (text.width() * towards.x.abs() + HEIGHT * text.size * towards.y.abs())
}

/// The least round value, or quarter of a hundred or more, that is not less.
fn close_step(least: f64) -> f64 {
    let (round, quarter) = (round_step(least), 2.5 * 10f64.powf((0.4 * least).log10().ceil()));
    if quarter >= 25.0 { round.min(quarter) } else { round }
}

impl OuterEdge {
    /// The parts of its line on which the block has no edge.
    fn bare(
        &self,
        (middle, pane): (DVec3, Rect),
        page: &dyn Fn(DVec3) -> DVec2,
        is_rock: &dyn Fn(DVec3) -> bool,
    ) -> Vec<[DVec2; 2]> {
        let [from, to] = self.ends;
        let count = (page(from).distance(page(to)) / STEP_PT).ceil().max(1.0) as usize;
        let at = |n: usize| from.lerp(to, n as f64 / count as f64);
        let is_bare = |n: &usize| {
            let p = at(*n).midpoint(at(n + 1));
            pane.contains(page(p)) && !is_rock(p.lerp(middle, WITHIN))
        };
        let steps: Vec<usize> = (0..count).filter(is_bare).collect();
        let runs = steps.chunk_by(|one, next| one + 1 == *next);
        runs.map(|run| [page(at(run[0])), page(at(run[run.len() - 1] + 1))]).collect()
    }

    fn values(&self, geometry: &SurveyGeometry) -> [f64; 2] {
        self.ends.map(|end| value_at(geometry, self.axis, end[self.axis]))
    }

    /// Round values along the edge, and where they are.
    fn ticks(&self, geometry: &SurveyGeometry, page: &dyn Fn(DVec3) -> DVec2) -> Vec<(String, DVec3)> {
        let [from, to] = self.values(geometry);
        let [start, end] = self.ends.map(page);
        let along = (end - start).normalize_or_zero().abs();
        let width = [from, to].map(|value| width_of(&format!("{value:.0}"), NUMBER_PT)).into_iter().fold(0.0, f64::max);
        let clear = ((width + 6.0) / along.x.max(1e-6)).min((HEIGHT * NUMBER_PT + 4.0) / along.y.max(1e-6));
        let least = if self.axis < 2 { 1.0 } else { 0.0 };
        let per_point = (to - from).abs() / start.distance(end);
        let step = round_step(per_point * clear.max(EVERY_PT[0])).max(least);
        if !(step.is_finite() && step > 0.0 && from != to) {
            return Vec::new();
        }
        let ticks = self.multiples(step, [from, to]);
        if ticks.len() >= FEW {
            ticks
        } else {
            self.multiples(close_step(per_point * clear.max(EVERY_PT[1])).max(least), [from, to])
        }
    }

    /// The multiples of a step between the values of the two ends, and where they are.
    fn multiples(&self, step: f64, [from, to]: [f64; 2]) -> Vec<(String, DVec3)> {
        let slack = 1e-6 * step;
        let (first, last) = ((from.min(to) - slack) / step, (from.max(to) + slack) / step);
        let tick = |n: i64| {
            let value = n as f64 * step;
            let text = if step < 1.0 { format!("{value:.1}") } else { format!("{value:.0}") };
            (text, self.ends[0].lerp(self.ends[1], (value - from) / (to - from)))
        };
        (first.ceil() as i64..=last.floor() as i64).map(tick).collect()
    }

    /// The title of a vertical axis, upright over the axis' upper end, where there is no room along it.
    fn title_above(
        &self,
        geometry: &SurveyGeometry,
        pane: Rect,
        page: &dyn Fn(DVec3) -> DVec2,
        room: &LabelRoom,
    ) -> Option<Text> {
        let [start, end] = self.ends.map(page);
        let top = if start.y < end.y { start } else { end };
        let at = top - DVec2::new(TICK_PT, 0.5 * HEIGHT * NUMBER_PT + 2.0 * GAP_PT);
        let text = |across: Across| {
            let text = Text::new(at, axis_title(geometry, self.axis)).sized(TEXT_PT).inked(QUIET_INK);
            text.anchored(across, Upright::Baseline)
        };
        let mut texts = [Across::Middle, Across::End].map(text).into_iter();
        texts.find(|text| self.axis == 2 && pane.contains(top) && room.is_free(text))
    }

    /// The title beyond numbers that reach so far, at a share of the edge.
    fn title(&self, share: f64, reach: f64, geometry: &SurveyGeometry, page: &dyn Fn(DVec3) -> DVec2) -> Text {
        let name = axis_title(geometry, self.axis);
        let [start, end] = self.ends.map(page);
        let along = (end - start).normalize_or(DVec2::X);
        // Read from left to right, or upwards.
        let along = if along.x < -1e-6 || (along.x.abs() <= 1e-6 && along.y > 0.0) { -along } else { along };
        let off = TICK_PT + 2.0 * GAP_PT + reach + 0.5 * HEIGHT * TEXT_PT;
        let at = start.lerp(end, share) + self.outward * off;
        Text::new(at, name)
            .inked(QUIET_INK)
            .anchored(Across::Middle, Upright::Middle)
            .turned(along.to_angle().to_degrees())
    }
}
