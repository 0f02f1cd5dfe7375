//! Names of faults beside their lines, the throw at their horizons there, and half-arrows that say which side went down.
//!
//! The throw is that of a horizon whose cut-offs lie on the fault's line on the face, taken down the dip of the fault where
//! they do ([`model::FaultThrows`]); so a face at an angle to the fault tells the same throw as one across it. Where beds
//! run nearly along the fault their cut-offs lie far apart, however little it moved. So it is taken from the horizons
//! that meet the fault at large angles, at the one whose cut-offs lie nearest to the middle of what is seen of the fault.
//! A throw that is not told from noise is not stated, and neither is one against the sense of the fault, which is the same
//! on every face.

use super::room::{LabelRoom, outlines};
use crate::convex::{holds, meet};
use crate::style::{INK, NUMBER_PT};
use glam::{DVec2, DVec3};
use model::section::LineKind;
use model::{FaultSense, FaultThrows, StructuralModel};
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

/// What is known of a fault at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FaceThrow {
    /// Difference of depth or time between the sides, in the survey's unit.
    pub size: f64,
    /// Distance of the cut-offs on the map, m.
    pub heave_m: f64,
    /// Where along the run, as a share of its places.
    share: f64,
    /// Whether the side to which the face's first axis points went down.
    is_ahead_down: bool,
    /// Whether the horizon was only continued to the fault, on either side.
    is_inferred: bool,
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
    /// The throw of the horizon whose cut-offs are nearest to the middle, of those that are known on both sides if there
    /// are any, and cross the fault clearly; `None` where none is told from noise, or it runs against the fault's sense.
    pub(super) fn throw(
        &self,
        (model, geometry): (&StructuralModel, &SurveyGeometry),
        sense: FaultSense,
    ) -> Option<FaceThrow> {
        if self.steepness < FLAT {
            return None;
        }
        let throws = FaultThrows::new(model, self.fault);
        let last = (self.places.len() - 1).max(1) as f64;
        let horizons = (0..model.stratigraphy().horizons.len()).filter(|&horizon| !model.is_body(horizon));
        let found = horizons.flat_map(|horizon| {
            let [behind, ahead] = self.cut_offs(model, horizon);
            // One side alone may lie on what is seen.
            let nearest = |from: f64, others: &[f64]| {
                others.iter().copied().min_by(|a, b| (a - from).abs().total_cmp(&(b - from).abs())).unwrap_or(from)
            };
            let middles: Vec<f64> = match behind.is_empty() {
                false => behind.iter().map(|from| 0.5 * (from + nearest(*from, &ahead))).collect(),
                true => ahead,
            };
            let at = |at: f64| {
                let place = self.places[(at.round() as usize).min(self.places.len() - 1)].0;
                let own = throws.near(place).into_iter().filter(move |throw| throw.horizon == horizon);
                let z = place.z;
                let off = move |throw: &model::Throw| {
                    (0.5 * (throw.cut_offs[0].place.z + throw.cut_offs[1].place.z) - z).abs()
                };
                own.min_by(|a, b| off(a).total_cmp(&off(b))).map(|throw| (at / last, throw))
            };
            middles.into_iter().filter_map(at).collect::<Vec<_>>()
        });
        let mut found: Vec<(f64, model::Throw)> = found.filter(|(_, throw)| throw.is_told()).collect();
        if found.iter().any(|(_, throw)| !throw.is_inferred()) {
            found.retain(|(_, throw)| !throw.is_inferred());
        }
        let clearest = found.iter().map(|(_, throw)| throw.crossing()).fold(0.0, f64::max);
        found.retain(|(_, throw)| throw.crossing() >= CROSSING * clearest);
        let aside = |(share, _): &(f64, model::Throw)| (share - 0.5).abs();
        let (share, throw) = found.into_iter().min_by(|a, b| aside(a).total_cmp(&aside(b)))?;
        if (throw.samples() > 0.0) != sense.is_positive_down {
            return None;
        }
        let middle = self.places[self.places.len() / 2].0;
        let is_ahead_positive = self.side_gradient(model, middle).dot(self.face.section.plane.s_axis) > 0.0;
        Some(FaceThrow {
            size: throw.samples().abs() * geometry.vertical.interval.abs(),
            heave_m: throw.heave_m(model.metric()),
            share,
            is_ahead_down: is_ahead_positive == sense.is_positive_down,
            is_inferred: throw.is_inferred(),
        })
    }

    fn side_gradient(&self, model: &StructuralModel, place: DVec3) -> DVec3 {
        model.faults().surfaces()[self.fault].side_gradient(place)
    }

    /// Where along the run, in places, a horizon meets it from the side that lies behind along the face's first axis, and
    /// from the one ahead.
    fn cut_offs(&self, model: &StructuralModel, horizon: usize) -> [Vec<f64>; 2] {
        let s_axis = self.face.section.plane.s_axis;
        [-1.0, 1.0].map(|side| {
            let known = |place: &DVec3| {
                // At right angles to the fault, for the face may run along it.
                let gradient = self.side_gradient(model, *place);
                let ahead = gradient.normalize_or_zero() * if gradient.dot(s_axis) >= 0.0 { BESIDE } else { -BESIDE };
                let block = model.block_at((*place + side * ahead).as_vec3());
                (block, model.offset(horizon, block, place.as_vec3()))
            };
            let all: Vec<(u16, f32)> = self.places.iter().map(|(place, _)| known(place)).collect();
            let crossing = |(n, pair): (usize, &[(u16, f32)])| {
                let [(block, a), (other, b)] = [pair[0], pair[1]];
                let is_crossed = block == other && (a < 0.0) != (b < 0.0);
                is_crossed.then(|| n as f64 + f64::from(a / (a - b)))
            };
            all.windows(2).enumerate().filter_map(crossing).collect()
        })
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
        throw: FaceThrow,
        page_from_voxel: &dyn Fn(DVec3) -> DVec2,
        room: &mut LabelRoom,
    ) -> Option<Group> {
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

/// "F1, 45 m": a name with the throw, queried where it was measured on a horizon that is only continued; with the heave on
/// request ("F1, 45 m, heave 26 m").
pub(super) fn said(name: &str, throw: Option<FaceThrow>, geometry: &SurveyGeometry, has_heave: bool) -> String {
    let unit = geometry.vertical.unit.symbol();
    let Some(throw) = throw else { return name.to_owned() };
    let query = if throw.is_inferred { " (?)" } else { "" };
    let rounded = |size: f64| if size < 10.0 { format!("{size:.1}") } else { format!("{size:.0}") };
    let heave = if has_heave { format!(", heave {} m", rounded(throw.heave_m)) } else { String::new() };
    measured(name, &format!("{} {unit}{heave}{query}", rounded(throw.size)))
}
