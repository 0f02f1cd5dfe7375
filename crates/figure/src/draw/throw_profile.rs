//! Throw, or heave, of a fault against the distance along it: the displacement–distance diagram of structural geology.
//!
//! Each horizon has its points, a symbol and a colour; points on parts of the horizon that were only continued are hollow,
//! and the line to them is dashed. The line ends on the axis at the tip of the fault, where that is known; where the fault
//! runs out of the survey it ends in the open. Throws in the grey band are not told from noise. Positive values are in
//! the sense of the fault.

use super::NamedColour;
use super::axes::{Axis, Tick};
use crate::style::{FRAME_PT, INK, NUMBER_PT, QUIET_INK, RULE_INK, TEXT_PT, TICK_PT, TITLE_PT, horizon_colour};
use glam::{DVec2, DVec3};
use model::{FaultSense, FaultThrows, HorizonThrows, StructuralModel, Throw};
use page::Rect;
use page::list::{Across, Group, GroupKind, Ink, Path, PathItem, Stroke, Text, Upright, width_of};
use survey::SurveyGeometry;
use ttf::Colour;

/// Lines down the dip along a fault.
const LINES: usize = 33;
/// Half the size of a symbol, points.
const SYMBOL_PT: f64 = 2.0;
/// Width of a horizon's line, points, and dashes of what was only continued.
const LINE_PT: f64 = 0.9;
const DASHES_PT: [f64; 2] = [3.2, 2.2];
/// Least distance between numbers along the two axes, points.
const EVERY_PT: [f64; 2] = [44.0, 24.0];
/// From one row of the key to the next, and the length of its lines, points.
const ROW_PT: f64 = 12.5;
const KEY_LINE_PT: f64 = 17.0;
/// Size of the letters of the key, points.
const KEY_PT: f64 = TEXT_PT - 0.5;
/// Symbols of so many horizons at most take turns along the fault.
const MOST_TURNS: usize = 3;
/// The key takes no more than this share of the width.
const KEY_SHARE: f64 = 0.36;
/// Least width and height of a diagram, points.
const LEAST_PT: [f64; 2] = [70.0, 45.0];
/// Room above the largest value, of the range.
const HEADROOM: f64 = 0.1;
/// Room beside the ends of a fault, of its length.
const BESIDE: f64 = 0.02;
/// A line is broken where no line down the dip has a point for more than so many steps.
const BROKEN: f64 = 1.6;
/// Misfits larger than this, in samples, have an error bar.
const BAR_SAMPLES: f64 = 0.25;

/// What is measured along a fault.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct FaultProfile {
    /// Its name.
    pub name: String,
    /// Which way it moved, if that is known.
    pub sense: Option<FaultSense>,
    /// The direction in which its lower side lies, in words.
    down_to: Option<&'static str>,
    /// The directions in which the left and the right end of the diagram lie.
    ends: [&'static str; 2],
    /// Throws of each horizon, youngest first; their places are metres from the left end.
    horizons: Vec<HorizonThrows>,
    length_m: f64,
    /// Samples to the unit of throws, the unit's sign, metres a voxel on the map.
    interval: f64,
    unit: &'static str,
    metric: glam::DMat3,
}

/// The direction of a vector on the map, in words.
fn compass(east_north: DVec2) -> [&'static str; 2] {
    const NAMES: [[&str; 2]; 8] = [
        ["E", "east"],
        ["NE", "north-east"],
        ["N", "north"],
        ["NW", "north-west"],
        ["W", "west"],
        ["SW", "south-west"],
        ["S", "south"],
        ["SE", "south-east"],
    ];
    let eighth = (east_north.to_angle() / std::f64::consts::FRAC_PI_4).round() as i64;
    NAMES[eighth.rem_euclid(8) as usize]
}

impl FaultProfile {
    /// Measures a fault of a model; `None` where no horizon meets it from both sides.
    pub(crate) fn new(model: &StructuralModel, geometry: &SurveyGeometry, fault: usize, name: String) -> Option<Self> {
        let throws = FaultThrows::new(model, fault);
        let [first, last] = throws.extent_m()?;
        let mut horizons = throws.profile(LINES);
        if horizons.is_empty() {
            return None;
        }
        let world =
            |voxel: DVec3| (geometry.world_from_voxel(voxel) - geometry.world_from_voxel(DVec3::ZERO)).truncate();
        let strike = world(throws.strike());
        // From west to east, or from south to north.
        let is_turned = strike.x < 0.0 && strike.x.abs() > 0.1 * strike.length()
            || strike.y < 0.0 && strike.x.abs() <= 0.1 * strike.length();
        let place = |along_m: f64| if is_turned { last - along_m } else { along_m - first };
        for horizon in &mut horizons {
            horizon.throws.iter_mut().for_each(|throw| throw.along_m = place(throw.along_m));
            horizon.tips_m.iter_mut().for_each(|tip| *tip = place(*tip));
            horizon.throws.sort_by(|a, b| a.along_m.total_cmp(&b.along_m));
        }
        let sense = throws.sense();
        let positive = world(throws.positive_side().extend(0.0));
        let lower = sense.map(|sense| if sense.is_positive_down { positive } else { -positive });
        let right = if is_turned { -strike } else { strike };
        Some(Self {
            name,
            sense,
            down_to: lower.map(|lower| compass(lower)[1]),
            ends: [-right, right].map(|end| compass(end)[0]),
            horizons,
            length_m: last - first,
            interval: geometry.vertical.interval.abs(),
            unit: geometry.vertical.unit.symbol(),
            metric: model.metric(),
        })
    }

    /// "normal, down to the east".
    fn said(&self) -> String {
        let Some(sense) = self.sense else {
            let mut throws = self.horizons.iter().flat_map(|own| &own.throws);
            let is_told = throws.any(Throw::is_told);
            return if is_told { "of both senses" } else { "no throw is told from noise" }.to_owned();
        };
        let kind = match sense.is_normal {
            Some(true) => "normal, ",
            Some(false) => "reverse, ",
            None => "",
        };
        let query = if sense.is_inferred { " (?)" } else { "" };
        format!("{kind}down to the {}{query}", self.down_to.unwrap_or_default())
    }

    fn throw(&self, throw: &Throw) -> f64 {
        let is_positive_down = self.sense.is_none_or(|sense| sense.is_positive_down);
        self.interval * if is_positive_down { throw.samples() } else { -throw.samples() }
    }

    fn value(&self, throw: &Throw, measure: Measure) -> f64 {
        match measure {
            Measure::Throw => self.throw(throw),
            Measure::Heave => throw.heave_m(self.metric).copysign(self.throw(throw)),
        }
    }
}

/// What a diagram shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Measure {
    Throw,
    Heave,
}

/// The diagrams of a fault.
pub(crate) struct ThrowPanel<'a> {
    pub profile: &'a FaultProfile,
    /// Colours of horizons, youngest first.
    pub horizons: &'a [NamedColour],
    /// Whether the heave stands below the throw.
    pub has_heave: bool,
}

/// A diagram in its room.
struct Diagram {
    body: Rect,
    across: Axis,
    up: Axis,
}

impl Diagram {
    fn at(&self, along_m: f64, value: f64) -> DVec2 {
        let place = |axis: &Axis, value: f64| {
            axis.at[0] + (value - axis.ends[0]) / (axis.ends[1] - axis.ends[0]) * (axis.at[1] - axis.at[0])
        };
        DVec2::new(place(&self.across, along_m), place(&self.up, value))
    }
}

impl ThrowPanel<'_> {
    /// The panel in its room; without items where there is too little of it.
    pub(crate) fn drawn(&self, room: Rect) -> Group {
        let mut group = Group::new(GroupKind::Panel, format!("throw of {}", self.profile.name));
        let widths = self.rows().into_iter().map(|row| width_of(&self.words(row), KEY_PT));
        let key = (widths.fold(0.0, f64::max) + KEY_LINE_PT + 16.0).min(KEY_SHARE * room.width());
        let title = TITLE_PT + 6.0;
        let below = room.inside([0.0, title, key, 0.0]);
        let rooms = match self.has_heave {
            true => below.split_down(0.55).to_vec(),
            false => vec![below],
        };
        let margins = [self.left_margin(), 4.0, 4.0, 2.0 * NUMBER_PT + TICK_PT + 8.0];
        let bodies: Vec<Rect> = rooms.iter().map(|room| room.inside(margins)).collect();
        if bodies.iter().any(|body| body.width() < LEAST_PT[0] || body.height() < LEAST_PT[1]) {
            return group;
        }
        let said = Text::new(DVec2::new(bodies[0].min.x, room.min.y + 0.5 * TITLE_PT), &self.profile.name);
        let said = said.sized(TITLE_PT).anchored(Across::Start, Upright::Middle);
        let beside = DVec2::new(bodies[0].min.x + said.width() + 8.0, said.at.y);
        let sense = Text::new(beside, self.profile.said()).sized(TEXT_PT - 0.5).inked(QUIET_INK);
        let sense = sense.anchored(Across::Start, Upright::Middle);
        let wide = (room.max.x - beside.x).max(1.0);
        group.push(Group::new(GroupKind::Annotation, "title").with([said.into(), sense.fitted(wide).into()]));
        for (body, measure) in bodies.iter().zip([Measure::Throw, Measure::Heave]) {
            group.push(self.diagram(*body, measure));
        }
        group.push(self.key(Rect::new(DVec2::new(room.max.x - key, bodies[0].min.y), room.max)));
        group
    }

    fn name(&self, horizon: usize) -> String {
        self.horizons.get(horizon).map_or_else(|| format!("horizon {}", horizon + 1), |known| known.name.clone())
    }

    fn colour(&self, horizon: usize) -> Colour {
        horizon_colour(self.horizons.get(horizon).map(|known| known.colour), horizon)
    }

    fn diagram(&self, body: Rect, measure: Measure) -> Group {
        let profile = self.profile;
        let all = || profile.horizons.iter().flat_map(|own| &own.throws);
        let values = || all().map(|throw| profile.value(throw, measure));
        let (low, high) = (values().fold(0.0, f64::min), values().fold(0.0, f64::max));
        let least = all().map(Throw::least_samples).fold(f64::INFINITY, f64::min) * profile.interval;
        let span = (high - low).max(if measure == Measure::Throw { 2.0 * least } else { 1.0 });
        let low = if low < 0.0 { low - HEADROOM * span } else { 0.0 };
        let name = match measure {
            Measure::Throw => format!("Throw ({})", profile.unit),
            Measure::Heave => "Heave (m)".to_owned(),
        };
        let up = Axis {
            name,
            ends: [low, (high + HEADROOM * span).max(low + span)],
            at: [body.max.y, body.min.y],
            least_step: 0.0,
        };
        let across = Axis {
            name: "Distance along strike (m)".into(),
            ends: [-BESIDE, 1.0 + BESIDE].map(|share| share * profile.length_m.max(1e-6)),
            at: [body.min.x, body.max.x],
            least_step: 0.0,
        };
        let diagram = Diagram { body, across, up };
        let mut group = Group::new(GroupKind::Data, if measure == Measure::Throw { "throw" } else { "heave" });
        let mut inside = Group::new(GroupKind::Part, "profiles").clipped(Path::rect(body.grown(SYMBOL_PT + 1.0)));
        if measure == Measure::Throw {
            let band =
                [-least, least].map(|value| diagram.at(0.0, value.clamp(diagram.up.ends[0], diagram.up.ends[1])).y);
            let band = Rect::new(DVec2::new(body.min.x, band[1]), DVec2::new(body.max.x, band[0]));
            inside.push(PathItem::filled(Path::rect(band), Ink::glass(RULE_INK, 0.16)));
        }
        inside.push(grid(&diagram));
        for (n, own) in profile.horizons.iter().enumerate() {
            inside.push(self.horizon(&diagram, own, n, measure));
        }
        group.push(inside);
        group.push(axes(&diagram, profile.ends));
        group
    }

    /// The line and the points of a horizon.
    fn horizon(&self, diagram: &Diagram, own: &HorizonThrows, number: usize, measure: Measure) -> Group {
        let (profile, colour) = (self.profile, self.colour(own.horizon));
        let mut group = Group::new(GroupKind::Horizon, self.name(own.horizon));
        let step = profile.length_m / (LINES - 1) as f64;
        // Points and tips from left to right: place, value, whether it is only continued.
        let mut points: Vec<(f64, f64, bool)> = own
            .throws
            .iter()
            .map(|throw| (throw.along_m, profile.value(throw, measure), throw.is_inferred()))
            .chain(own.tips_m.iter().map(|tip| (*tip, 0.0, false)))
            .collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (mut solid, mut dashed) = (Path::default(), Path::default());
        for pair in points.windows(2).filter(|pair| pair[1].0 - pair[0].0 <= BROKEN * step) {
            let path = if pair[0].2 || pair[1].2 { &mut dashed } else { &mut solid };
            path.add_line(&[diagram.at(pair[0].0, pair[0].1), diagram.at(pair[1].0, pair[1].1)]);
        }
        let stroke = || Stroke::new(LINE_PT, colour).round();
        for (path, stroke) in [(solid, stroke()), (dashed, stroke().dashed(DASHES_PT[0], DASHES_PT[1]))] {
            if !path.segments.is_empty() {
                group.push(PathItem::stroked(path, stroke));
            }
        }
        for throw in &own.throws {
            let value = profile.value(throw, measure);
            let misfit = throw.cut_offs[0].misfit.hypot(throw.cut_offs[1].misfit);
            if measure == Measure::Throw && misfit > BAR_SAMPLES {
                let reach = misfit * profile.interval;
                let ends = [value - reach, value + reach].map(|value| diagram.at(throw.along_m, value));
                group.push(PathItem::stroked(Path::line(&ends), Stroke::new(0.45, Ink::glass(colour, 0.6))));
            }
        }
        // In turn, so that horizons of one throw are all seen.
        let turns = profile.horizons.len().clamp(1, MOST_TURNS);
        let is_own = |throw: &&Throw| (throw.along_m / step).round() as usize % turns == number % turns;
        for throw in own.throws.iter().filter(is_own) {
            let at = diagram.at(throw.along_m, profile.value(throw, measure));
            group.push(symbol(at, number, colour, throw.is_inferred()));
        }
        let tips = own.tips_m.iter().map(|tip| cross(diagram.at(*tip, 0.0), colour));
        tips.for_each(|tip| group.push(tip));
        group
    }

    /// Room for the numbers and the name left of a diagram.
    fn left_margin(&self) -> f64 {
        let values = self.profile.horizons.iter().flat_map(|own| &own.throws).map(|throw| self.profile.throw(throw));
        let longest = values.map(|value| width_of(&format!("{value:.0}"), NUMBER_PT)).fold(0.0, f64::max);
        longest.max(width_of("000", NUMBER_PT)) + TICK_PT + NUMBER_PT + 7.0
    }

    /// The rows of the key.
    fn rows(&self) -> Vec<KeyRow> {
        let horizons = &self.profile.horizons;
        let mut rows: Vec<KeyRow> = (0..horizons.len()).map(KeyRow::Horizon).collect();
        let is_inferred = horizons.iter().flat_map(|own| &own.throws).any(Throw::is_inferred);
        rows.extend(is_inferred.then_some(KeyRow::Continued));
        rows.extend(horizons.iter().any(|own| !own.tips_m.is_empty()).then_some(KeyRow::Tip));
        rows.push(KeyRow::Noise);
        rows
    }

    fn words(&self, row: KeyRow) -> String {
        match row {
            KeyRow::Horizon(n) => self.name(self.profile.horizons[n].horizon),
            KeyRow::Continued => "horizon continued".to_owned(),
            KeyRow::Tip => "tip of the fault".to_owned(),
            KeyRow::Noise => "not told from noise".to_owned(),
        }
    }

    /// Which line is which horizon, and what symbols mean.
    fn key(&self, room: Rect) -> Group {
        let mut group = Group::new(GroupKind::Annotation, "key");
        let left = room.min.x + 8.0;
        for (n, row) in self.rows().into_iter().enumerate() {
            let y = room.min.y + 6.0 + ROW_PT * n as f64;
            if y + 0.5 * ROW_PT > room.max.y {
                break;
            }
            let ends = [DVec2::new(left, y), DVec2::new(left + KEY_LINE_PT, y)];
            let middle = 0.5 * (ends[0] + ends[1]);
            match row {
                KeyRow::Horizon(n) => {
                    let colour = self.colour(self.profile.horizons[n].horizon);
                    group.push(PathItem::stroked(Path::line(&ends), Stroke::new(LINE_PT, colour)));
                    group.push(symbol(middle, n, colour, false));
                }
                KeyRow::Continued => {
                    let stroke = Stroke::new(LINE_PT, QUIET_INK).dashed(DASHES_PT[0], DASHES_PT[1]);
                    group.push(PathItem::stroked(Path::line(&ends), stroke));
                    group.push(symbol(middle, 0, QUIET_INK, true));
                }
                KeyRow::Tip => group.push(cross(middle, QUIET_INK)),
                KeyRow::Noise => {
                    let half = DVec2::new(0.0, 3.2);
                    let area = Path::rect(Rect::new(ends[0] - half, ends[1] + half));
                    group.push(PathItem::filled(area, Ink::glass(RULE_INK, 0.28)));
                }
            }
            let at = DVec2::new(left + KEY_LINE_PT + 5.0, y);
            let text = Text::new(at, self.words(row)).sized(KEY_PT).anchored(Across::Start, Upright::Middle);
            group.push(text.fitted((room.max.x - at.x).max(1.0)));
        }
        group
    }
}

/// A row of the key.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum KeyRow {
    /// A horizon, by its place among those of the profile.
    Horizon(usize),
    Continued,
    Tip,
    Noise,
}

/// The cross at a tip.
fn cross(at: DVec2, colour: Colour) -> PathItem {
    let [a, b] = [DVec2::splat(SYMBOL_PT), DVec2::new(SYMBOL_PT, -SYMBOL_PT)];
    let mut cross = Path::line(&[at - a, at + a]);
    cross.add_line(&[at - b, at + b]);
    PathItem::stroked(cross, Stroke::new(LINE_PT, colour))
}

/// The symbol of a horizon: circle, square, triangle, diamond and so on in turn.
fn symbol(at: DVec2, number: usize, colour: Colour, is_hollow: bool) -> PathItem {
    let corners = |turned: &[[f64; 2]]| {
        Path::polygon(&turned.iter().map(|[x, y]| at + DVec2::new(*x, *y) * SYMBOL_PT).collect::<Vec<_>>())
    };
    let path = match number % 5 {
        0 => Path::circle(at, SYMBOL_PT),
        1 => corners(&[[-0.9, -0.9], [0.9, -0.9], [0.9, 0.9], [-0.9, 0.9]]),
        2 => corners(&[[0.0, -1.2], [1.1, 0.9], [-1.1, 0.9]]),
        3 => corners(&[[0.0, -1.3], [1.3, 0.0], [0.0, 1.3], [-1.3, 0.0]]),
        _ => corners(&[[0.0, 1.2], [1.1, -0.9], [-1.1, -0.9]]),
    };
    let fill = if is_hollow { Colour::WHITE } else { colour };
    PathItem::filled(path, fill).outlined(Stroke::new(0.6, if is_hollow { colour } else { Colour::WHITE }))
}

/// Fine lines at the numbers of the upright axis, and one at no throw.
fn grid(diagram: &Diagram) -> PathItem {
    let mut lines = Path::default();
    for Tick { at, .. } in diagram.up.ticks([diagram.body.max.y, diagram.body.min.y], EVERY_PT[1]) {
        lines.add_line(&[DVec2::new(diagram.body.min.x, at), DVec2::new(diagram.body.max.x, at)]);
    }
    PathItem::stroked(lines, Stroke::new(0.25, Ink::glass(RULE_INK, 0.7)))
}

/// The frame, numbers on the left and below, the names of both axes, and where the ends of the fault lie.
fn axes(diagram: &Diagram, ends: [&str; 2]) -> Group {
    let body = diagram.body;
    let mut group = Group::new(GroupKind::Annotation, "axes");
    let number = |at: DVec2, text: String| Text::new(at, text).sized(NUMBER_PT).inked(QUIET_INK);
    let mut marks = Path::default();
    for tick in diagram.across.ticks([body.min.x, body.max.x], EVERY_PT[0]) {
        let foot = DVec2::new(tick.at, body.max.y);
        marks.add_line(&[foot, foot + DVec2::new(0.0, TICK_PT)]);
        let at = foot + DVec2::new(0.0, TICK_PT + 1.8);
        group.push(number(at, tick.text).anchored(Across::Middle, Upright::Top));
    }
    for tick in diagram.up.ticks([body.max.y, body.min.y], EVERY_PT[1]) {
        let foot = DVec2::new(body.min.x, tick.at);
        marks.add_line(&[foot, foot - DVec2::new(TICK_PT, 0.0)]);
        group.push(number(foot - DVec2::new(TICK_PT + 1.8, 0.0), tick.text).anchored(Across::End, Upright::Middle));
    }
    let below = DVec2::new(body.centre().x, body.max.y + TICK_PT + NUMBER_PT + 5.0);
    group.push(number(below, diagram.across.name.clone()).anchored(Across::Middle, Upright::Top).fitted(body.width()));
    let ticks = diagram.up.ticks([body.max.y, body.min.y], EVERY_PT[1]);
    let longest = ticks.iter().map(|tick| width_of(&tick.text, NUMBER_PT)).fold(0.0, f64::max);
    let left = DVec2::new(body.min.x - TICK_PT - longest - 0.5 * NUMBER_PT - 4.5, body.centre().y);
    let name = number(left, diagram.up.name.clone()).anchored(Across::Middle, Upright::Middle).turned(-90.0);
    group.push(name.fitted(body.height()));
    let is_crossed = diagram.up.ends[0] < 0.0;
    if is_crossed {
        let zero = diagram.at(0.0, 0.0).y;
        let line = Path::line(&[DVec2::new(body.min.x, zero), DVec2::new(body.max.x, zero)]);
        group.push(PathItem::stroked(line, Stroke::new(FRAME_PT, QUIET_INK)));
    }
    group.push(PathItem::stroked(marks, Stroke::new(FRAME_PT, QUIET_INK)));
    group.push(PathItem::stroked(Path::rect(body), Stroke::new(FRAME_PT, RULE_INK)));
    for (end, at, across) in [
        (ends[0], DVec2::new(body.min.x, below.y - 0.5), Across::Start),
        (ends[1], DVec2::new(body.max.x, below.y - 0.5), Across::End),
    ] {
        group.push(Text::new(at, end).sized(KEY_PT).inked(INK).anchored(across, Upright::Top));
    }
    group
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_have_the_names_of_the_compass() {
        let of = |degrees: f64| compass(DVec2::from_angle(degrees.to_radians()))[0];
        assert_eq!([0.0, 44.0, 90.0, 181.0, -46.0, -90.0, 268.0].map(of), ["E", "NE", "N", "W", "SE", "S", "S"]);
    }
}
