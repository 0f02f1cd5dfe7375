//! What an interpreter sees over sections, fences and blocks.
//!
//! Horizons have their own colours, dotted across their holes; the selection is broader, and the brighter
//! part of a line is what is selected. Proposed faults are dark red. Spaces: (s, t) of a section; points of
//! the page.

use crate::cut::traces::{self, Line};
use crate::cut::{SectionKind, station_of};
use crate::interpretation::{DrawnInterpretation, PickedSheets, SheetHole, TraceSheet};
use crate::style::{FAULT_PT, HORIZON_PT, PROPOSAL, RIM_OPACITY, RIM_PT};
use glam::{DVec2, DVec3};
use page::list::{Group, GroupKind, Ink, Path, PathItem, Stroke};
use survey::Quality;
use ttf::Colour;

/// How far from a section sticks are drawn on it, traces or samples.
const NEAR: f64 = 2.5;
/// Sticks within so many lines are those of neighbouring sections.
const GHOSTS: f64 = 25.0;
/// How dark their ink is.
const GHOST_OPACITY: f32 = 0.35;
/// Diameter of the dots across holes, and from one to the next, points.
const DOT_PT: [f64; 2] = [1.5, 3.6];
/// Width of the selection and of the rim around it, points.
const SELECTED_PT: [f64; 2] = [2.4, 4.2];
/// Radius of the places of a stick, points.
const PLACE_PT: f64 = 2.0;

/// Length of the dashes where a horizon was filled, and of the gaps between them, points.
const FILLED_PT: [f64; 2] = [4.0, 2.6];

/// A part of a sheet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum SheetPart {
    /// What was picked or tracked.
    Picked,
    /// What was filled, up to the picked traces around it.
    Filled,
}

impl SheetPart {
    /// The values of this part, NaN at other traces; `[inlines, crosslines]` is the survey's size.
    fn of(self, sheet: &TraceSheet, [nx, ny]: [usize; 2]) -> Vec<f32> {
        let is_filled = |x: usize, y: usize| sheet.quality[x * ny + y] == Quality::Filled;
        let is_beside = |x: usize, y: usize| {
            let (xs, ys) = (x.saturating_sub(1)..nx.min(x + 2), y.saturating_sub(1)..ny.min(y + 2));
            xs.into_iter().any(|x| ys.clone().any(|y| is_filled(x, y)))
        };
        let mut z = sheet.z.to_vec();
        if self == Self::Picked && !sheet.quality.contains(&Quality::Filled) {
            return z;
        }
        for (n, z) in z.iter_mut().enumerate() {
            let is_own = match self {
                Self::Picked => !is_filled(n / ny, n % ny),
                Self::Filled => is_beside(n / ny, n % ny),
            };
            if !is_own {
                *z = f32::NAN;
            }
        }
        z
    }
}

/// Lines of one colour under a name.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedLines {
    /// Of what.
    pub name: String,
    /// In which colour.
    pub colour: Colour,
    /// (s, t).
    pub lines: Vec<Line>,
}

/// All that is seen over one section.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct OverlayLines {
    /// Horizons.
    pub horizons: Vec<NamedLines>,
    /// Where horizons were filled, not picked.
    pub filled: Vec<NamedLines>,
    /// Across the holes of horizons.
    pub bridges: Vec<NamedLines>,
    /// Faults.
    pub faults: Vec<NamedLines>,
    /// Proposed faults.
    pub proposals: Vec<NamedLines>,
    /// The selection.
    pub selected: Option<NamedLines>,
}

/// Where an interpretation is seen.
#[derive(Debug, Clone, Copy)]
pub enum SeenOn<'a> {
    /// On a section at a voxel position.
    Section(SectionKind, f64),
    /// On a fence with these corners, voxel x and y.
    Fence(&'a [DVec2]),
}

impl SeenOn<'_> {
    fn sheet(&self, sheet: &TraceSheet, size: [usize; 2]) -> Vec<Line> {
        match *self {
            Self::Section(kind, at) => traces::of_sheet(sheet, size, kind, at),
            Self::Fence(corners) => traces::along(sheet, size, corners),
        }
    }

    fn bridges(&self, sheet: &TraceSheet, holes: &[SheetHole], size: [usize; 2]) -> Vec<Line> {
        match *self {
            Self::Section(kind, at) => traces::bridges(sheet, holes, size, kind, at),
            Self::Fence(corners) => traces::bridges_along(sheet, holes, size, corners),
        }
    }

    fn mesh(&self, triangles: &[[DVec3; 3]]) -> Vec<Line> {
        match *self {
            Self::Section(kind, at) => traces::of_mesh(triangles, kind, at),
            Self::Fence(corners) => traces::mesh_along(triangles, corners),
        }
    }

    /// (s, t) of a stick that lies near; none of another.
    fn stick(&self, places: &[DVec3], reach: f64) -> Option<Line> {
        let place = |p: &DVec3| match *self {
            Self::Section(kind, at) => ((p[kind.axis()] - at).abs() <= reach).then(|| kind.flat(*p)),
            Self::Fence(corners) => {
                let (s, off) = station_of(corners, p.truncate())?;
                (off <= reach).then_some(DVec2::new(s, p.z))
            }
        };
        places.iter().map(place).collect()
    }
}

impl OverlayLines {
    /// Cuts an interpretation; `[inlines, crosslines]` is the survey's size.
    pub fn new(shown: &DrawnInterpretation, size: [usize; 2], on: SeenOn) -> Self {
        let named = |horizon: &PickedSheets, lines: Vec<Line>| NamedLines {
            name: horizon.name.to_owned(),
            colour: horizon.colour,
            lines,
        };
        let sheets = |horizon: &PickedSheets, part: SheetPart| {
            let lines = |sheet: &TraceSheet| on.sheet(&TraceSheet { z: &part.of(sheet, size), ..*sheet }, size);
            horizon.sheets.iter().flat_map(lines).collect()
        };
        let bridges = |horizon: &PickedSheets| {
            horizon.sheets.iter().flat_map(|sheet| on.bridges(sheet, &horizon.holes, size)).collect()
        };
        let selected = shown.selection.as_ref().map(|selection| NamedLines {
            name: "selection".to_owned(),
            colour: selection.colour,
            lines: selection.sheets.iter().flat_map(|sheet| on.sheet(sheet, size)).collect(),
        });
        let fault = |fault: &crate::interpretation::FaultMesh| NamedLines {
            name: fault.name.to_owned(),
            colour: fault.colour,
            lines: on.mesh(fault.triangles),
        };
        Self {
            horizons: shown.horizons.iter().map(|h| named(h, sheets(h, SheetPart::Picked))).collect(),
            filled: shown.horizons.iter().map(|h| named(h, sheets(h, SheetPart::Filled))).collect(),
            bridges: shown.horizons.iter().map(|horizon| named(horizon, bridges(horizon))).collect(),
            faults: shown.faults.iter().map(fault).collect(),
            proposals: shown
                .proposals
                .iter()
                .map(|proposal| NamedLines { colour: PROPOSAL, ..fault(proposal) })
                .collect(),
            selected,
        }
    }

    /// The names of the horizons that have lines here.
    pub(crate) fn seen_horizons(&self) -> impl Iterator<Item = &str> {
        let all = [&self.horizons, &self.filled, &self.bridges].into_iter().flatten();
        all.filter(|horizon| !horizon.lines.is_empty()).map(|horizon| horizon.name.as_str())
    }

    /// The lines on a page, rims under all of them.
    pub fn drawn(&self, page: impl Fn(DVec2) -> DVec2) -> Vec<Group> {
        let path = |lines: &[Line]| {
            let mut path = Path::default();
            for line in lines {
                path.add_line(&line.iter().map(|st| page(*st)).collect::<Vec<_>>());
            }
            path
        };
        let rim = |path: Path, width: f64| {
            let ink = Ink::glass(Colour::WHITE, RIM_OPACITY);
            PathItem::stroked(path, Stroke::new(width + RIM_PT, ink).round())
        };
        let line = |kind: GroupKind, name: &str, path: Path, stroke: Stroke| {
            Group::new(kind, name).with([PathItem::stroked(path, stroke).into()])
        };
        let mut rims = Group::new(GroupKind::Annotation, "rims");
        let mut groups = Vec::new();
        for ((horizon, filled), bridges) in self.horizons.iter().zip(&self.filled).zip(&self.bridges) {
            rims.push(rim(path(&horizon.lines), HORIZON_PT));
            let [on, off] = FILLED_PT;
            let dashes = Stroke::new(HORIZON_PT, horizon.colour).dashed(on, off);
            let dots = Stroke::new(DOT_PT[0], horizon.colour).dotted(DOT_PT[1]);
            let light = Stroke::new(DOT_PT[0] + 0.6, Ink::glass(Colour::WHITE, 0.8)).dotted(DOT_PT[1]);
            let mut group = line(
                GroupKind::Horizon,
                &horizon.name,
                path(&horizon.lines),
                Stroke::new(HORIZON_PT, horizon.colour).round(),
            );
            group.push(PathItem::stroked(path(&filled.lines), dashes));
            group.push(PathItem::stroked(path(&bridges.lines), light));
            group.push(PathItem::stroked(path(&bridges.lines), dots));
            groups.push(group);
        }
        for fault in &self.faults {
            rims.push(rim(path(&fault.lines), FAULT_PT));
            let stroke = Stroke::new(FAULT_PT, fault.colour).round();
            groups.push(line(GroupKind::Fault, &fault.name, path(&fault.lines), stroke));
        }
        let stroke = Stroke::new(0.8 * FAULT_PT, PROPOSAL).round();
        let proposals: Vec<Line> = self.proposals.iter().flat_map(|proposal| proposal.lines.iter().cloned()).collect();
        groups.push(line(GroupKind::Fault, "proposals", path(&proposals), stroke));
        if let Some(selected) = &self.selected {
            let light = Stroke::new(SELECTED_PT[1], Ink::glass(Colour::WHITE, 0.82)).round();
            let bright = Stroke::new(SELECTED_PT[0], selected.colour).round();
            let lines = [light, bright].map(|stroke| PathItem::stroked(path(&selected.lines), stroke).into());
            groups.push(Group::new(GroupKind::Horizon, &selected.name).with(lines));
        }
        groups.insert(0, rims);
        groups.retain(|group| !group.items.iter().all(is_empty));
        groups
    }
}

fn is_empty(item: &page::list::Item) -> bool {
    matches!(item, page::list::Item::Path(path) if path.path.segments.is_empty())
}

impl NamedLines {
    /// The lines on a page as something that is chosen: broad, with a light rim.
    pub fn chosen(&self, page: impl Fn(DVec2) -> DVec2) -> Group {
        let mut path = Path::default();
        self.lines.iter().for_each(|line| path.add_line(&line.iter().map(|st| page(*st)).collect::<Vec<_>>()));
        let rim = Stroke::new(SELECTED_PT[1], Ink::glass(Colour::WHITE, 0.82)).round();
        let bright = Stroke::new(SELECTED_PT[0], self.colour).round();
        Group::new(GroupKind::Fault, &self.name)
            .with([rim, bright].map(|stroke| PathItem::stroked(path.clone(), stroke).into()))
    }

    /// How far the lines pass from a place of the page, points.
    pub fn distance(&self, place: DVec2, page: impl Fn(DVec2) -> DVec2) -> f64 {
        let pieces = self.lines.iter().flat_map(|line| line.windows(2)).map(|pair| [page(pair[0]), page(pair[1])]);
        let off = |[a, b]: [DVec2; 2]| {
            let along = b - a;
            let share = ((place - a).dot(along) / along.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
            (a + along * share).distance(place)
        };
        pieces.map(off).fold(f64::INFINITY, f64::min)
    }
}

/// A stick that is suggested, dashed, with open points.
pub fn suggested(places: Vec<DVec2>, colour: Colour) -> Group {
    let mut group = Group::new(GroupKind::Fault, "suggested stick");
    let light = Stroke::new(HORIZON_PT + RIM_PT, Ink::glass(Colour::WHITE, RIM_OPACITY)).round();
    group.push(PathItem::stroked(Path::line(&places), light));
    let [on, off] = FILLED_PT;
    group.push(PathItem::stroked(Path::line(&places), Stroke::new(HORIZON_PT, colour).dashed(on, off)));
    for place in places {
        let dot = PathItem::filled(Path::circle(place, 0.8 * PLACE_PT), Ink::glass(Colour::WHITE, 0.85));
        group.push(dot.outlined(Stroke::new(0.7 * HORIZON_PT, colour)));
    }
    group
}

/// The sticks that lie near a section or a fence.
pub fn sticks(shown: &DrawnInterpretation, on: SeenOn, page: impl Fn(DVec2) -> DVec2) -> Vec<Group> {
    let near = shown.sticks.iter().filter_map(|stick| Some((on.stick(&stick.places, NEAR)?, stick.colour)));
    near.map(|(places, colour)| stick(places.into_iter().map(&page).collect(), colour)).collect()
}

/// The sticks of neighbouring sections, in light ink: where the fault was on them.
pub fn ghosts(shown: &DrawnInterpretation, on: SeenOn, page: impl Fn(DVec2) -> DVec2) -> Vec<Group> {
    let others = shown.sticks.iter().filter(|stick| on.stick(&stick.places, NEAR).is_none());
    let ghost = |stick: &crate::interpretation::Stick| {
        let places: Vec<DVec2> = on.stick(&stick.places, GHOSTS)?.into_iter().map(&page).collect();
        let ink = Ink::glass(stick.colour, GHOST_OPACITY);
        let line = PathItem::stroked(Path::line(&places), Stroke::new(HORIZON_PT, ink).round());
        Some(Group::new(GroupKind::Fault, "neighbouring stick").with([line.into()]))
    };
    others.filter_map(ghost).collect()
}

/// A stick on a page.
pub fn stick(places: Vec<DVec2>, colour: Colour) -> Group {
    let mut group = Group::new(GroupKind::Fault, "stick");
    group.push(PathItem::stroked(Path::line(&places), Stroke::new(HORIZON_PT, colour).round()));
    for place in places {
        let dot = PathItem::filled(Path::circle(place, PLACE_PT), Colour::WHITE);
        group.push(dot.outlined(Stroke::new(0.9 * HORIZON_PT, colour)));
    }
    group
}

#[cfg(test)]
mod tests;
