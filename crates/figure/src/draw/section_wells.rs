//! Wells on a section: the parts of their paths that lie near it, with their names and tops. A slice shows where they
//! pass through it.

use super::annotation::room::LabelRoom;
use crate::cut::{SectionKind, station_of};
use crate::style::{HORIZON_PT, INK, NUMBER_PT, RIM_OPACITY, RIM_PT, TEXT_PT};
use glam::{DVec2, DVec3};
use page::Rect;
use page::list::{Across, Group, GroupKind, Ink, Item, Path, PathItem, Stroke, Text, Upright};
use survey::{SurveyGeometry, Well};
use ttf::Colour;

/// Parts of a path within so many lines of a section are drawn on it; a slice has a sign where it is passed through.
const NEAR: f64 = 6.0;
const THROUGH: f64 = 1.0;
/// Parts that a straight piece of a path is divided into.
const PARTS: u32 = 8;
/// Half the length of the mark of a top, points.
pub(crate) const TOP_PT: f64 = 2.6;
/// From there to its name, points.
const GAP_PT: f64 = 1.6;
/// How many heights of its letters a well's name may stand lower.
const STEPS: u32 = 4;
/// From a well to its name, points.
const HEAD_PT: f64 = 2.0;
/// Radius of the place where a well passes through a slice, points.
const SIGN_PT: f64 = 1.8;

/// Where a voxel position is drawn on a section, (s, t), if it lies near it.
pub fn near(voxel: DVec3, kind: SectionKind, at: f64) -> Option<DVec2> {
    let reach = if kind == SectionKind::Slice { THROUGH } else { NEAR };
    ((voxel[kind.axis()] - at).abs() <= reach).then(|| kind.flat(voxel))
}

/// Consecutive points without gaps.
///
/// ```
/// use figure::draw::section_wells::runs;
/// assert_eq!(runs([Some(1), Some(2), None, None, Some(3)].into_iter()), [vec![1, 2], vec![3]]);
/// assert!(runs([None::<i32>].into_iter()).is_empty());
/// ```
pub fn runs<P>(points: impl Iterator<Item = Option<P>>) -> Vec<Vec<P>> {
    let mut runs = vec![Vec::new()];
    for point in points {
        match (point, runs.last_mut()) {
            (Some(point), Some(run)) => run.push(point),
            _ => runs.push(Vec::new()),
        }
    }
    runs.retain(|run| !run.is_empty());
    runs
}

/// What of a well lies near a section, (s, t).
#[derive(Debug, Clone, PartialEq)]
pub struct WellOnSection {
    /// The well.
    pub name: String,
    /// The colour of its path.
    pub colour: Colour,
    /// Parts of its path; of a slice, the place where it passes through.
    pub parts: Vec<Vec<DVec2>>,
    /// Its tops.
    pub tops: Vec<(String, DVec2)>,
}

impl WellOnSection {
    /// What lies near a section along the lattice; `None` where nothing does.
    pub fn of(well: &Well, geometry: &SurveyGeometry, kind: SectionKind, at: f64) -> Option<Self> {
        Self::where_near(well, geometry, kind != SectionKind::Slice, |voxel| near(voxel, kind, at))
    }

    /// What lies near a fence with these corners, voxel x and y; `None` where nothing does.
    pub fn on_fence(well: &Well, geometry: &SurveyGeometry, corners: &[DVec2]) -> Option<Self> {
        Self::where_near(well, geometry, true, |voxel| {
            let (station, off) = station_of(corners, voxel.truncate())?;
            (off <= NEAR).then(|| DVec2::new(station, voxel.z))
        })
    }

    /// The well where `near` says that it is, (s, t).
    fn where_near(
        well: &Well,
        geometry: &SurveyGeometry,
        has_tops: bool,
        near: impl Fn(DVec3) -> Option<DVec2>,
    ) -> Option<Self> {
        let path = well.path_in_voxels(geometry);
        let pieces = path.windows(2).flat_map(|pair| {
            let last = pair[1];
            (0..PARTS).map(move |n| pair[0].lerp(last, f64::from(n) / f64::from(PARTS)))
        });
        let parts = runs(pieces.chain(path.last().copied()).map(&near));
        let tops = well.tops.iter().filter(|_| has_tops);
        let tops = tops.filter_map(|top| Some((top.name.clone(), near(well.voxel_at_md(top.md_m, geometry)?)?)));
        let tops = tops.collect();
        (!parts.is_empty()).then(|| Self { name: well.name.clone(), colour: INK, parts, tops })
    }

    /// The well within `body`, its names where `room` has room for them; `page` takes (s, t) to the page.
    pub(super) fn drawn(
        &self,
        body: Rect,
        is_plan: bool,
        page: &dyn Fn(DVec2) -> DVec2,
        room: &mut LabelRoom,
    ) -> Option<Group> {
        let head = self.parts.iter().flatten().map(|st| page(*st)).find(|at| body.contains(*at))?;
        let mut group = Group::new(GroupKind::Well, &self.name).clipped(Path::rect(body));
        let rim = Ink::glass(Colour::WHITE, RIM_OPACITY);
        if is_plan {
            let ring = PathItem::filled(Path::circle(head, SIGN_PT), Colour::WHITE);
            group.push(ring.outlined(Stroke::new(0.9, self.colour)));
        } else {
            let lines = || self.parts.iter().filter(|part| part.len() > 1);
            let line = |part: &Vec<DVec2>| Path::line(&part.iter().map(|st| page(*st)).collect::<Vec<_>>());
            lines().for_each(|part| group.push(PathItem::stroked(line(part), Stroke::new(HORIZON_PT + RIM_PT, rim))));
            lines().for_each(|part| group.push(PathItem::stroked(line(part), Stroke::new(HORIZON_PT, self.colour))));
        }
        for (name, st) in &self.tops {
            let at = page(*st);
            let off = DVec2::new(TOP_PT, 0.0);
            group.push(PathItem::stroked(Path::line(&[at - off, at + off]), Stroke::new(HORIZON_PT, INK)));
            // To the side with more room, or else to the other.
            let side = |is_left: bool| {
                let side = if is_left { -TOP_PT - GAP_PT } else { TOP_PT + GAP_PT };
                let across = if is_left { Across::End } else { Across::Start };
                let text = Text::new(at + DVec2::new(side, 0.0), name).sized(NUMBER_PT).inked(INK);
                text.haloed(RIM_PT, rim).anchored(across, Upright::Middle)
            };
            let is_left = at.x > body.centre().x;
            group
                .items
                .extend([side(is_left), side(!is_left)].into_iter().find(|text| room.try_take(text)).map(Item::from));
        }
        let name = Text::new(head, &self.name).sized(TEXT_PT).inked(INK).haloed(RIM_PT, rim);
        // Above the head, or else beside the path, which would strike it through.
        let half = 0.5 * name.width() + RIM_PT;
        let above = Text { at: DVec2::new(head.x, head.y - HEAD_PT), ..name };
        let above = above.anchored(Across::Middle, Upright::Baseline);
        let beside = (0..STEPS).flat_map(|step| {
            let y = (head.y - HEAD_PT).max(body.min.y + TEXT_PT + HEAD_PT) + 1.2 * TEXT_PT * f64::from(step);
            [half, -half].map(|off| Text { at: DVec2::new(head.x + off + off.signum() * HEAD_PT, y), ..above.clone() })
        });
        let mut placed = std::iter::once(above.clone())
            .chain(beside)
            .filter(|text| body.around(text.bounds().min).around(text.bounds().max) == body);
        group.items.extend(placed.find(|text| room.try_take(text)).map(Item::from));
        Some(group)
    }
}
