//! Names of faults beside their lines, the throw measured there, and half-arrows that say which side went down.
//!
//! On a face, a horizon meets a fault from each side at a place of its own, its cut-offs. They are found on the fault's
//! line from the horizon in the two blocks beside it; the throw is the difference of their depths or times. Where beds
//! run nearly along the fault their cut-offs lie far apart, however little it moved. So it is taken from the horizons
//! that meet the fault at large angles, at the one whose cut-offs lie nearest to the middle of what is seen of the fault.

use super::room::{LabelRoom, outlines};
use crate::convex::{holds, meet};
use crate::cut::value_at;
use crate::style::{INK, NUMBER_PT};
use glam::{DVec2, DVec3};
use model::StructuralModel;
use model::section::{LineKind, LineQuality};
use page::list::{Across, Group, GroupKind, Ink, Path, PathItem, Segment, Stroke, Text, Upright};
use render::vector::SeenSection;
use survey::SurveyGeometry;
use ttf::Colour;
use ttf::text::measured;

/// Half the length of an arrow, its distance from the fault, and its barb along and across, points.
const ARROW_PT: [f64; 4] = [7.0, 3.0, 3.6, 2.2];
/// Distance of a name's middle from the fault, points.
const NAME_OFF_PT: f64 = 8.0;
/// The light rim under arrows and names, points, and its opacity.
const RIM_PT: f64 = 1.3;
const RIM_OPACITY: f32 = 0.85;
/// Lines that are seen shorter than this carry neither arrows nor a name, points.
const SHORTEST_PT: f64 = 16.0;
/// A leader ends at least so far from other faults where it can, points.
const APART_PT: f64 = 6.0;
/// How far beside a fault its blocks are looked up, voxels.
const BESIDE: f64 = 0.75;
/// A line this flat on its face shows no up and down, as that of a steep fault does on a face along its strike: cosine of
/// 83° from upright, in metres. Half-arrows there would tell of a movement along strike.
const FLAT: f64 = 0.12;
/// The flattest line counts this share of its length against steep ones.
const FLAT_SHARE: f64 = 0.3;
/// A throw is taken from horizons that cross the fault at this share, or more, of the largest sine of an angle.
const CROSSING: f64 = 0.7;
/// How far from a horizon's end at a fault its line is looked up, voxels.
const NEAR_END: f64 = 3.0;
/// Throws below this are not stated, samples.
const LEAST_THROW: f64 = 0.25;
/// Where along its line a name or an arrow may stand, in shares on both sides of the middle.
const PLACES: [f64; 9] = [0.0, 0.08, -0.08, 0.16, -0.16, 0.24, -0.24, 0.34, -0.34];

/// The seen part of a fault's line on a face.
pub(super) struct FaultRun<'a> {
    /// The fault, by its number in the model.
    pub fault: usize,
    /// Places from one end to the other: voxels and the page.
    places: Vec<(DVec3, DVec2)>,
    /// How much of its length runs up and down, in metres: 1 if it is upright, 0 if it is level.
    steepness: f64,
    /// Its length on the page, points, less where it is flat.
    worth: f64,
    face: &'a SeenSection,
    /// The parts of its face that are seen, on the page.
    seen: Vec<Vec<DVec2>>,
}

/// Where a horizon ends at a fault.
struct CutOff {
    /// Where along the run, in places.
    at: f64,
    /// Its place, voxels.
    place: DVec3,
    /// Its z.
    z: f64,
    /// Whether the older rock lies below.
    is_upright: bool,
    /// Sine of the angle between the horizon and the fault on the face.
    crossing: f64,
}

/// What is known of a fault at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Throw {
    /// Difference of depth or time between the sides, in the survey's unit.
    pub size: f64,
    /// Where along the run, as a share of its places.
    share: f64,
    /// Whether the side to which the face's first axis points went down.
    is_ahead_down: bool,
    /// Whether the horizon was only continued to the fault, on either side.
    is_inferred: bool,
    /// Sine of the angle at which the horizon meets the fault, the less of both sides.
    crossing: f64,
}

/// The longest seen run of each fault on upright faces, by fault; a flat one counts less.
pub(super) fn runs<'a>(
    (model, geometry): (&StructuralModel, &SurveyGeometry),
    faces: &'a [SeenSection],
    page_from_voxel: &dyn Fn(DVec3) -> DVec2,
    page: &dyn Fn(DVec2) -> DVec2,
    air: Option<u16>,
) -> Vec<FaultRun<'a>> {
    let mut longest: Vec<FaultRun> = Vec::new();
    for face in faces.iter().filter(|face| face.axis < 2) {
        let plane = face.section.plane;
        let aside = plane.s_axis * BESIDE;
        let seen: Vec<Vec<DVec2>> =
            face.pieces.iter().map(|piece| piece.iter().map(|px| page(*px)).collect()).collect();
        for line in &face.section.lines {
            let LineKind::Fault { fault, real: true } = line.kind else { continue };
            let is_rock =
                |p: DVec3| [p - aside, p + aside].iter().any(|q| Some(model.region_at(q.as_vec3()).layer) != air);
            let place = |st: &DVec2| {
                let voxel = plane.voxel(*st);
                let at = page_from_voxel(voxel);
                let is_seen = seen.iter().any(|piece| holds(piece, at)) && is_rock(voxel);
                is_seen.then_some((voxel, at))
            };
            let places: Vec<Option<(DVec3, DVec2)>> = line.points.iter().map(place).collect();
            for part in places.split(Option::is_none) {
                let places: Vec<(DVec3, DVec2)> = part.iter().flatten().copied().collect();
                let length: f64 = places.windows(2).map(|pair| pair[0].1.distance(pair[1].1)).sum();
                let known = longest.iter().position(|run| run.fault == fault);
                let steepness = steepness(&places, geometry);
                let worth = length * (FLAT_SHARE + (1.0 - FLAT_SHARE) * steepness);
                if length < SHORTEST_PT || known.is_some_and(|n| longest[n].worth >= worth) {
                    continue;
                }
                let run = FaultRun { fault, places, steepness, worth, face, seen: seen.clone() };
                match known {
                    Some(n) => longest[n] = run,
                    None => longest.push(run),
                }
            }
        }
    }
    longest.sort_by_key(|run| run.fault);
    longest
}

/// How much of the way from one end to the other runs up and down, in metres.
fn steepness(places: &[(DVec3, DVec2)], geometry: &SurveyGeometry) -> f64 {
    let (Some(first), Some(last)) = (places.first(), places.last()) else { return 0.0 };
    (geometry.metric_from_voxel() * (last.0 - first.0)).normalize_or_zero().z.abs()
}

impl FaultRun<'_> {
    /// The throw from the cut-offs of the horizon that is nearest to the middle, of those that are known on both sides if
    /// there are any, and cross the fault clearly; `None` where no horizon has both.
    pub(super) fn throw(&self, model: &StructuralModel, geometry: &SurveyGeometry) -> Option<Throw> {
        let middle = self.places[self.places.len() / 2].0;
        let aside = self.face.section.plane.s_axis * BESIDE;
        let blocks = [middle - aside, middle + aside].map(|p| model.block_at(p.as_vec3()));
        if blocks[0] == blocks[1] {
            return None;
        }
        let last = (self.places.len() - 1).max(1) as f64;
        let throws = |horizon: usize| {
            let [behind, ahead] = blocks.map(|block| self.cut_offs(model, geometry, horizon, block));
            // A limb that is upside down is paired with one that is.
            let pair = |from: &CutOff| {
                let same = ahead.iter().filter(|to| to.is_upright == from.is_upright);
                let to = same.min_by(|a, b| (a.at - from.at).abs().total_cmp(&(b.at - from.at).abs()))?;
                let [above, below] = [from.z, to.z].map(|z| value_at(geometry, 2, z));
                let is_seen = (to.z - from.z).abs() >= LEAST_THROW;
                let share = 0.5 * (from.at + to.at) / last;
                let is_inferred = [from, to].into_iter().any(|end| self.is_inferred(horizon, end.place));
                let (size, is_ahead_down) = ((below - above).abs(), to.z > from.z);
                let crossing = from.crossing.min(to.crossing);
                is_seen.then_some(Throw { size, share, is_ahead_down, is_inferred, crossing })
            };
            behind.iter().filter_map(pair).collect::<Vec<_>>()
        };
        let horizons = (0..model.stratigraphy().horizons.len()).filter(|&horizon| !model.is_body(horizon));
        let mut throws: Vec<Throw> = horizons.flat_map(throws).collect();
        if throws.iter().any(|throw| !throw.is_inferred) {
            throws.retain(|throw| !throw.is_inferred);
        }
        let clearest = throws.iter().map(|throw| throw.crossing).fold(0.0, f64::max);
        throws.retain(|throw| throw.crossing >= CROSSING * clearest);
        let aside = |throw: &Throw| (throw.share - 0.5).abs();
        throws.into_iter().min_by(|a, b| aside(a).total_cmp(&aside(b)))
    }

    /// Whether the line of a horizon that ends at a place is only continued there.
    fn is_inferred(&self, horizon: usize, place: DVec3) -> bool {
        let own = self.face.section.lines.iter().filter(|line| line.kind == LineKind::Horizon { horizon });
        let plane = self.face.section.plane;
        let near = own.flat_map(|line| {
            let of = move |st: &DVec2| (plane.voxel(*st).distance(place), line.quality == LineQuality::Inferred);
            line.points.iter().map(of).filter(|(distance, _)| *distance < NEAR_END)
        });
        near.min_by(|a, b| a.0.total_cmp(&b.0)).is_some_and(|(_, is_inferred)| is_inferred)
    }

    /// Where a horizon ends at the fault within a block, limb by limb.
    fn cut_offs(&self, model: &StructuralModel, geometry: &SurveyGeometry, horizon: usize, block: u16) -> Vec<CutOff> {
        let off = |p: DVec3| f64::from(model.offset(horizon, block, p.as_vec3()));
        // A voxel's length along the two axes of the face, m.
        let axes = [self.face.section.plane.s_axis, self.face.section.plane.t_axis];
        let metres = axes.map(|axis| geometry.metric_from_voxel() * axis);
        let crossing = |(n, pair): (usize, &[(DVec3, DVec2)])| {
            let [a, b] = [pair[0].0, pair[1].0];
            let (off_a, off_b) = (off(a), off(b));
            if (off_a < 0.0) == (off_b < 0.0) {
                return None;
            }
            let share = off_a / (off_a - off_b);
            let p = a.lerp(b, share);
            // Elsewhere something younger has cut it off.
            let below = model.below_at(p.as_vec3(), block);
            let [without, with] = [false, true].map(|below_it| model.rules().layer(&below.with(horizon, below_it)));
            let is_there = with != without;
            let is_upright = (off_b > off_a) == (b.z > a.z);
            let slope = DVec2::from_array([0, 1].map(|n| (off(p + axes[n]) - off(p - axes[n])) / metres[n].length()));
            let along = geometry.metric_from_voxel() * (b - a);
            let along = DVec2::from_array(metres.map(|axis| along.dot(axis.normalize_or_zero())));
            let crossing = slope.normalize_or_zero().dot(along.normalize_or_zero()).abs();
            is_there.then_some(CutOff { at: n as f64 + share, place: p, z: p.z, is_upright, crossing })
        };
        self.places.windows(2).enumerate().filter_map(crossing).collect()
    }

    /// The place on the page at a share of the run, and the direction of growing depth there.
    fn at(&self, share: f64) -> (DVec2, DVec2) {
        let count = self.places.len();
        let n = (share.clamp(0.0, 1.0) * (count - 1) as f64).round() as usize;
        let reach = (count / 12).max(1);
        let (before, after) = (self.places[n.saturating_sub(reach)], self.places[(n + reach).min(count - 1)]);
        let along = (after.1 - before.1).normalize_or(DVec2::Y);
        (self.places[n].1, if after.0.z >= before.0.z { along } else { -along })
    }

    /// The direction on the page, across the fault, of the side to which the face's first axis points.
    fn ahead(&self, along: DVec2, page_from_voxel: &dyn Fn(DVec3) -> DVec2) -> DVec2 {
        let middle = self.places[self.places.len() / 2].0;
        let off = page_from_voxel(middle + self.face.section.plane.s_axis) - page_from_voxel(middle);
        let across = along.perp();
        if across.dot(off) >= 0.0 { across } else { -across }
    }

    fn is_seen(&self, outline: &[DVec2]) -> bool {
        outline.iter().all(|corner| self.seen.iter().any(|piece| holds(piece, *corner)))
    }

    /// Half-arrows on both sides, near where the throw was measured; `None` where there is no room.
    pub(super) fn arrows(
        &self,
        throw: Throw,
        page_from_voxel: &dyn Fn(DVec3) -> DVec2,
        room: &mut LabelRoom,
    ) -> Option<Group> {
        if self.steepness < FLAT {
            return None;
        }
        let [half, off, ..] = ARROW_PT;
        let place = |step: &f64| {
            let (middle, along) = self.at(throw.share + step);
            let ahead = self.ahead(along, page_from_voxel);
            let reach = ahead * (off + ARROW_PT[3] + 1.0);
            let corner = |along_by: f64, by: f64| middle + along * along_by * (half + 1.0) + reach * by;
            let area = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
            (self.is_seen(&area) && room.is_area_free(&area)).then_some((middle, along, ahead, area))
        };
        let (middle, along, ahead, area) = PLACES.iter().find_map(place)?;
        room.take_area(&area);
        let down = if throw.is_ahead_down { along } else { -along };
        let arrow = |side: DVec2, towards: DVec2| {
            let tip = middle + side * off + towards * half;
            let tail = middle + side * off - towards * half;
            let barb = tip - towards * ARROW_PT[2] + side * ARROW_PT[3];
            Path { segments: vec![Segment::Move(tail), Segment::Line(tip), Segment::Line(barb)] }
        };
        let arrows = [arrow(ahead, down), arrow(-ahead, -down)];
        let mut group = Group::new(GroupKind::Part, "half-arrows");
        let stroke = |width: f64, ink: Ink| Stroke::new(width, ink).round();
        let rims = arrows.iter().cloned();
        let rim = Ink::glass(Colour::WHITE, RIM_OPACITY);
        rims.for_each(|path| group.push(PathItem::stroked(path, stroke(0.8 + RIM_PT, rim))));
        arrows.into_iter().for_each(|path| group.push(PathItem::stroked(path, stroke(0.8, INK.into()))));
        Some(group)
    }

    /// The name beside the line, on either side; `None` where there is no room. `lines` are all faults that are seen.
    pub(super) fn named(&self, name: &str, lines: &[Vec<DVec2>], room: &LabelRoom) -> Option<Text> {
        let text = Text::new(DVec2::ZERO, name).sized(NUMBER_PT + 0.5).anchored(Across::Middle, Upright::Middle);
        let text = text.haloed(RIM_PT, Ink::glass(Colour::WHITE, RIM_OPACITY));
        let text = &text;
        let placed = PLACES.iter().flat_map(|step| {
            let (middle, along) = self.at(0.5 + step);
            let read = if along.x < -1e-6 || (along.x.abs() <= 1e-6 && along.y > 0.0) { -along } else { along };
            [1.0, -1.0].map(|side| {
                let at = middle + along.perp() * side * NAME_OFF_PT;
                Text { at, ..text.clone() }.turned(read.to_angle().to_degrees())
            })
        });
        let fits = |text: &Text| {
            outlines(text).all(|outline| {
                let crossed = |line: &Vec<DVec2>| line.windows(2).any(|pair| meet(pair, &outline));
                self.is_seen(&outline) && !lines.iter().any(crossed)
            }) && room.is_free(text)
        };
        placed.into_iter().find(fits)
    }

    /// Its places on the page.
    pub(super) fn line(&self) -> Vec<DVec2> {
        self.places.iter().map(|(_, at)| *at).collect()
    }

    /// Places on the page where a leader may end, the best one first; those near another fault's line come last. `lines` are
    /// all faults that are seen.
    pub(super) fn anchors(&self, lines: &[Vec<DVec2>]) -> Vec<DVec2> {
        let own = self.line();
        let others = || lines.iter().filter(|line| **line != own).flatten();
        let mut anchors = [0.93, 0.07, 0.8, 0.2, 0.65, 0.35, 0.5].map(|share| self.at(share).0).to_vec();
        anchors.sort_by_key(|anchor| others().any(|place| place.distance(*anchor) < APART_PT));
        anchors
    }
}

/// "F1, 45 m": a name with the throw, queried where it was measured on a horizon that is only continued.
pub(super) fn said(name: &str, throw: Option<Throw>, geometry: &SurveyGeometry) -> String {
    let unit = geometry.vertical.unit.symbol();
    let Some(throw) = throw else { return name.to_owned() };
    let query = if throw.is_inferred { " (?)" } else { "" };
    let decimals = usize::from(throw.size < 10.0);
    measured(name, &format!("{:.decimals$} {unit}{query}", throw.size))
}
