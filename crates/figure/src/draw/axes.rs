//! Numbers along the upper and the left edge of a section: round values, none over another, none beyond the
//! room.

use crate::style::{FRAME_PT, NUMBER_PT, QUIET_INK, RULE_INK, TICK_PT};
use glam::DVec2;
use page::Rect;
use page::list::{Across, Group, GroupKind, Path, PathItem, Stroke, Text, Upright, width_of};
use survey::{SurveyGeometry, VerticalUnit};

/// Least distance between numbers along the upper and the left edge, points.
const EVERY_PT: [f64; 2] = [44.0, 26.0];
/// The same where there would be fewer numbers than this many, as a share of it: one number alone is no scale.
const FEW: (usize, f64) = (3, 0.6);
/// Room between a tick and its number, points.
const GAP_PT: f64 = 1.8;

/// An axis: what its ends stand for, and where they lie.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// What is counted: "Crossline", "Two-way time (ms)".
    pub name: String,
    /// Values at the two ends of the whole section.
    pub ends: [f64; 2],
    /// Where these ends lie on the page: x or y.
    pub at: [f64; 2],
    /// Numbers stand no closer than this: 1 for line numbers.
    pub least_step: f64,
}

/// The title of an axis of a survey: 0 counts inlines, 1 crosslines, 2 depth or time.
pub fn axis_title(geometry: &SurveyGeometry, axis: usize) -> &'static str {
    match (axis, geometry.vertical.unit) {
        (0, _) => "Inline",
        (1, _) => "Crossline",
        (_, VerticalUnit::Milliseconds) => "Two-way time (ms)",
        (_, VerticalUnit::Metres) => "Depth (m)",
    }
}

/// A number along an axis.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Tick {
    /// Where: x or y.
    pub at: f64,
    /// The number.
    pub text: String,
}

/// The least of 1, 2, 5 × 10ⁿ that is not less.
///
/// ```
/// use figure::draw::axes::round_step;
/// assert_eq!([1.1, 4.9, 70.0].map(round_step), [2.0, 5.0, 100.0]);
/// ```
pub fn round_step(least: f64) -> f64 {
    let decade = 10f64.powf(least.max(1e-9).log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * decade);
    steps.into_iter().find(|step| *step >= least * 0.999).unwrap_or(decade)
}

impl Axis {
    /// Round values between two places on the page, `every` points apart or more.
    pub(crate) fn ticks(&self, [from, to]: [f64; 2], every: f64) -> Vec<Tick> {
        let per_point = (self.ends[1] - self.ends[0]) / (self.at[1] - self.at[0]);
        if !(per_point.is_finite() && per_point != 0.0) {
            return Vec::new();
        }
        let value_of = |at: f64| self.ends[0] + (at - self.at[0]) * per_point;
        let seen = [value_of(from), value_of(to)];
        let within = [self.ends[0].min(self.ends[1]), self.ends[0].max(self.ends[1])];
        let (low, high) = (seen[0].min(seen[1]).max(within[0]), seen[0].max(seen[1]).min(within[1]));
        let step = round_step(per_point.abs() * every).max(self.least_step);
        let slack = step * 1e-6;
        let first = ((low - slack) / step).ceil() as i64;
        let last = ((high + slack) / step).floor() as i64;
        let tick = |n: i64| {
            let value = n as f64 * step;
            let text = if step < 1.0 { format!("{value:.1}") } else { format!("{value:.0}") };
            Tick { at: self.at[0] + (value - self.ends[0]) / per_point, text }
        };
        (first..=last).map(tick).collect()
    }
}

/// Round values along an edge, closer together where there is little room.
fn edge_ticks(axis: &Axis, seen: [f64; 2], every: f64) -> Vec<Tick> {
    let ticks = axis.ticks(seen, every);
    if ticks.len() < FEW.0 { axis.ticks(seen, every * FEW.1) } else { ticks }
}

/// Room that the numbers and the name of an axis take left of a section.
pub(crate) fn left_margin(axis: &Axis) -> f64 {
    let longest = axis.ends.iter().map(|value| width_of(&format!("{value:.0}"), NUMBER_PT)).fold(0.0, f64::max);
    longest + TICK_PT + GAP_PT + NUMBER_PT + 5.0
}

/// Room that numbers take above a section.
pub(crate) fn top_margin() -> f64 {
    NUMBER_PT + TICK_PT + GAP_PT
}

/// The frame around a section, and the numbers along its upper and left edge. `whole` is all the room there is.
pub fn drawn(whole: Rect, body: Rect, [across, down]: [&Axis; 2]) -> Group {
    let mut group = Group::new(GroupKind::Annotation, "axes");
    let hair = || Stroke::new(FRAME_PT, QUIET_INK);
    let mut marks = Path::default();
    let number = |at: DVec2, text: String| Text::new(at, text).sized(NUMBER_PT).inked(QUIET_INK);
    for tick in edge_ticks(across, [body.min.x, body.max.x], EVERY_PT[0]) {
        let foot = DVec2::new(tick.at, body.min.y);
        marks.add_line(&[foot, foot - DVec2::new(0.0, TICK_PT)]);
        let half = 0.5 * width_of(&tick.text, NUMBER_PT);
        let x = tick.at.clamp(whole.min.x + half, (whole.max.x - half).max(whole.min.x + half));
        let at = DVec2::new(x, body.min.y - TICK_PT - GAP_PT);
        group.push(number(at, tick.text).anchored(Across::Middle, Upright::Baseline));
    }
    for tick in edge_ticks(down, [body.min.y, body.max.y], EVERY_PT[1]) {
        let foot = DVec2::new(body.min.x, tick.at);
        marks.add_line(&[foot, foot - DVec2::new(TICK_PT, 0.0)]);
        let at = foot - DVec2::new(TICK_PT + GAP_PT, 0.0);
        group.push(number(at, tick.text).anchored(Across::End, Upright::Middle));
    }
    // Ascenders reach beyond capital letters.
    let name = DVec2::new(whole.min.x + 0.3 * NUMBER_PT, body.centre().y);
    let name = number(name, down.name.clone()).anchored(Across::Middle, Upright::Top).turned(-90.0);
    group.push(name.fitted(body.height()));
    group.push(PathItem::stroked(marks, hair()));
    group.push(PathItem::stroked(Path::rect(body), Stroke::new(FRAME_PT, RULE_INK)));
    group
}

#[cfg(test)]
mod tests;
