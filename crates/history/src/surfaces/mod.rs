//! A stage as an interpreter would deliver it: horizons, faults and the names and rocks of layers, in the nouns of `survey`.
//!
//! Nodes of horizons lie where vertical lines of a lattice meet them, to a tenth of a millimetre:
//!
//! | surface | nodes | contact |
//! |---|---|---|
//! | `Top X` | where the top of bed X is left, under younger beds or air | conformable; onlap if it was moved before they came |
//! | `Base X`, or the erosion's name | where beds of a later event lie on older rock; also the base of a channel | erosional |
//! | `Ground` | where rock lies under air | erosional |
//! | a body's name | all of its outline, closed | intrusive |
//! | a baked rock's name | the outline of the body and what it baked, closed | intrusive |
//!
//! A surface that has one depth at each place of each fault block is a sheet for each block ([`sheets`]); others are
//! triangles. A surface that is everywhere the top of a bed is that top and nothing else.

mod faults;
mod layers;
mod mesh;
mod outlines;
mod sheets;

use crate::history::Unit;
use crate::kinds::{Act, Beds};
use crate::place::{Place, Rock, Sides};
use crate::stage::Stage;
use glam::{DVec2, DVec3};
use layers::Layers;
use rayon::prelude::*;
use std::collections::BTreeSet;
use survey::{Contact, Horizon, NodeGrid, StratigraphicHorizon, Stratigraphy, SurveyGeometry, VerticalUnit};

/// Cells of the lattice along the block's longer edge, and down.
const CELLS: f64 = 128.0;
const CELLS_DOWN: f64 = 128.0;
/// Within so many metres of the top of a bed a boundary is this top.
const AT_TOP_M: f64 = 0.01;
/// So near a fault a boundary is the fault, m.
const ON_FAULT_M: f64 = 0.005;

/// The fault blocks of a model of the stage's faults.
pub struct FaultBlocks<'a> {
    /// How many there are.
    pub count: usize,
    /// In which of them a place lies, m.
    pub at: &'a (dyn Fn(DVec3) -> u16 + Sync),
}

impl FaultBlocks<'_> {
    /// One block: a model without faults.
    pub fn whole() -> Self {
        Self { count: 1, at: &|_| 0 }
    }
}

/// Horizons and layers of a stage.
#[derive(Debug, Clone, PartialEq)]
pub struct Interpretation {
    /// The lattice: from corner to corner of the block, in m.
    pub geometry: SurveyGeometry,
    /// Names, contacts and names of layers, youngest first.
    pub stratigraphy: Stratigraphy,
    /// The horizons in that order.
    pub horizons: Vec<Horizon>,
    /// The rock of each layer, youngest first; `None` for air.
    pub rocks: Vec<Option<String>>,
    /// What is not in it, a sentence each.
    pub notes: Vec<String>,
}

/// What a surface is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Surface {
    /// Rock under air.
    Ground,
    /// The top of a unit.
    Top(usize),
    /// The base of a bed that is cut into others.
    CutBase(usize),
    /// The base of the beds of an act.
    Base(usize),
    /// The outline of a body.
    Body(usize),
    /// The outline of a body and of what it has baked.
    Baked(usize),
}

/// A place of a surface.
#[derive(Debug, Clone, Copy)]
struct Node {
    surface: Surface,
    sides: Sides,
    depth: f64,
    /// The block of the model in which it lies.
    block: usize,
}

/// The lattice of a block.
fn lattice(size: DVec3) -> SurveyGeometry {
    let cells = |edge: f64| ((CELLS * edge / size.x.max(size.y)).round() as usize).clamp(16, 400);
    let counts = [cells(size.x), cells(size.y), CELLS_DOWN as usize];
    let interval = size.z / counts[2] as f64;
    let mut geometry = SurveyGeometry::regular(counts.map(|cells| cells + 1), 1.0, interval, VerticalUnit::Metres);
    geometry.inline_vector = DVec2::new(size.x / counts[0] as f64, 0.0);
    geometry.crossline_vector = DVec2::new(0.0, size.y / counts[1] as f64);
    geometry
}

impl Stage<'_> {
    /// The lattice of the block, from corner to corner.
    pub fn geometry(&self) -> SurveyGeometry {
        lattice(self.history().size())
    }

    /// The stage as horizons and layers among the blocks of its faults ([`Stage::faults`]). Takes a second or some.
    pub fn interpretation(&self, blocks: &FaultBlocks<'_>) -> Interpretation {
        let geometry = self.geometry();
        let grid = NodeGrid::of_survey(&geometry);
        let columns: Vec<Vec<Node>> = (0..grid.count[0] * grid.count[1])
            .into_par_iter()
            .map(|n| {
                let node = DVec2::new((n / grid.count[1]) as f64, (n % grid.count[1]) as f64);
                let map = grid.world_at(node);
                let mut found = self.nodes(map);
                for node in &mut found {
                    node.block = usize::from((blocks.at)(map.extend(node.depth)));
                }
                found
            })
            .collect();
        let surfaces = self.surfaces(&columns);
        let Layers { names: layer_names, rocks } = self.layers(&surfaces, &columns);
        let mut notes = Vec::new();
        let flat: Vec<Surface> = surfaces.iter().copied().filter(|surface| self.is_map(*surface, &columns)).collect();
        let mut sheets = self.sheets(&flat, &grid, &columns, blocks).into_iter();
        let mut horizon = |surface: &Surface| match (surface, flat.contains(surface)) {
            (Surface::Body(unit), _) => Horizon::of_surface(self.name(*surface), self.body_mesh(*unit)),
            (Surface::Baked(unit), _) => Horizon::of_surface(self.name(*surface), self.baked_mesh(*unit)),
            (Surface::Top(unit), false) => Horizon::of_surface(self.name(*surface), self.top_mesh(*unit)),
            _ => Horizon::new(self.name(*surface), sheets.next().unwrap_or_default()),
        };
        let horizons: Vec<Horizon> = surfaces.iter().map(&mut horizon).collect();
        let named = |(surface, horizon): (&Surface, &Horizon)| StratigraphicHorizon {
            name: horizon.name.clone(),
            contact: match surface {
                Surface::Top(unit) if self.is_lapped_on(*unit, &columns) => Contact::Onlap,
                Surface::Top(_) => Contact::Conformable,
                Surface::Ground | Surface::Base(_) | Surface::CutBase(_) => Contact::Erosional,
                Surface::Body(unit) if self.is_laid(*unit) => Contact::Truncated,
                Surface::Body(_) | Surface::Baked(_) => Contact::Intrusive,
            },
        };
        let stratigraphy = Stratigraphy { horizons: surfaces.iter().zip(&horizons).map(named).collect(), layer_names };
        if self.acts().iter().any(|act| matches!(act, Act::Metamorphism(_))) {
            notes.push("metamorphic rock is drawn as the rock that it was: it has no horizon".to_owned());
        }
        Interpretation { geometry, stratigraphy, horizons, rocks, notes }
    }

    /// Whether beds of a later event lie on the top of a bed that was moved or worn down before.
    fn is_lapped_on(&self, unit: usize, columns: &[Vec<Node>]) -> bool {
        let made = self.history().units()[unit].act;
        let is_still = |act: &Act| matches!(act, Act::Beds(_) | Act::Sea(_));
        columns.iter().any(|column| {
            let tops = column.iter().filter(|node| node.surface == Surface::Top(unit));
            tops.into_iter().any(|top| {
                column.iter().filter(|node| node.depth == top.depth).any(|node| match node.surface {
                    Surface::Base(act) => act > made && !self.acts()[made..act].iter().all(is_still),
                    _ => false,
                })
            })
        })
    }

    fn unit(&self, rock: &Rock) -> &Unit {
        &self.history().units()[rock.unit]
    }

    fn beds_of(&self, rock: &Rock) -> Option<(&Beds, usize)> {
        match (&self.acts()[rock.act], self.unit(rock).bed) {
            (Act::Beds(beds), Some(bed)) => Some((beds, bed)),
            _ => None,
        }
    }

    /// The unit of a bed of an act, on the near side of a change of facies.
    fn bed_unit(&self, act: usize, bed: usize) -> Option<usize> {
        self.history().units().iter().position(|unit| unit.act == act && unit.bed == Some(bed))
    }

    /// The surfaces that a vertical line meets.
    fn nodes(&self, map: DVec2) -> Vec<Node> {
        let column = self.column(map);
        let mut found = Vec::new();
        if let Some(first) = column.first()
            && let Place::Rock(rock) = first.place
        {
            self.tops(&mut found, map.extend(first.depths[0]), &rock, None);
        }
        for pair in column.windows(2) {
            let depth = pair[1].depths[0];
            let Place::Rock(below) = pair[1].place else { continue };
            let p = map.extend(depth);
            match pair[0].place {
                Place::Air | Place::Water if self.is_scarp(p) => {}
                Place::Air | Place::Water => {
                    found.push(Node { surface: Surface::Ground, sides: Sides::default(), depth, block: 0 });
                    self.tops(&mut found, p, &below, None);
                }
                Place::Rock(above) if above.act == below.act => {
                    let is_same_side = above.sides == below.sides;
                    if let (true, Some((_, bed))) = (is_same_side, self.beds_of(&above)) {
                        self.tops(&mut found, p, &below, Some(bed));
                    }
                }
                Place::Rock(above) if above.act > below.act && self.is_laid_on(&above, p) => {
                    found.push(Node { surface: Surface::Base(above.act), sides: above.sides, depth, block: 0 });
                    self.tops(&mut found, p, &below, None);
                }
                Place::Rock(_) => {}
            }
        }
        found
    }

    /// Whether beds at `p` lie on what is below, and not against the scarp of a fault.
    fn is_laid_on(&self, above: &Rock, p: DVec3) -> bool {
        self.beds_of(above).is_some() && !self.is_scarp(p)
    }

    /// Whether a vertical line passes through a fault at `p`, so that it is the fault that bounds rock there.
    fn is_scarp(&self, p: DVec3) -> bool {
        let [above, below] = [-ON_FAULT_M, ON_FAULT_M].map(|off| self.sides_since(0, p + DVec3::Z * off));
        above != below
    }

    /// The tops that lie at the top of the bed at `p`: its own, and those of beds that have no thickness there. `above` is
    /// the bed that lies on it, if it is of the same event.
    fn tops(&self, found: &mut Vec<Node>, p: DVec3, below: &Rock, above: Option<usize>) {
        let Some((beds, bed)) = self.beds_of(below) else { return };
        let map = self.before(below.act, &below.sides, p).truncate();
        let above = above.unwrap_or(beds.beds.len());
        let mut add = |surface: Surface| found.push(Node { surface, sides: below.sides, depth: p.z, block: 0 });
        let off_m = (1.0 - self.coordinates(below, p).z).abs() * beds.beds[bed].thickness_m;
        let is_at_top = off_m < AT_TOP_M;
        let of = |bed: usize| self.bed_unit(below.act, bed);
        if let Some(unit) = of(bed).filter(|_| is_at_top) {
            add(Surface::Top(unit));
        }
        for thin in bed + 1..above {
            let is_thin = is_at_top && (beds.top_of(thin, map) - beds.top_of(bed, map)).abs() < AT_TOP_M;
            let is_empty = beds.beds[thin].thickness_at(map) < AT_TOP_M;
            if let Some(unit) = of(thin).filter(|_| is_thin && is_empty) {
                add(Surface::Top(unit));
                if beds.beds[thin].is_cut() {
                    add(Surface::CutBase(unit));
                }
            }
        }
        if let Some(unit) = beds.beds.get(above).filter(|bed| bed.is_cut()).and_then(|_| of(above)) {
            add(Surface::CutBase(unit));
        }
    }

    /// The surfaces that there are, youngest first, bodies last.
    fn surfaces(&self, columns: &[Vec<Node>]) -> Vec<Surface> {
        let mut seen = BTreeSet::new();
        // Surfaces under air or later beds that are something else than the top of a bed somewhere.
        let mut own = BTreeSet::new();
        for column in columns {
            for node in column {
                let is_top = column.iter().any(|n| matches!(n.surface, Surface::Top(_)) && n.depth == node.depth);
                if !is_top && matches!(node.surface, Surface::Ground | Surface::Base(_)) {
                    own.insert(node.surface);
                }
                seen.insert(node.surface);
            }
        }
        let mut order = vec![Surface::Ground];
        for act in (0..self.acts().len()).rev() {
            let units = self.history().units().iter().enumerate().filter(|(_, unit)| unit.act == act);
            let units: Vec<usize> = units.filter(|(_, unit)| unit.bed.is_some()).map(|(n, _)| n).collect();
            order.extend(units.iter().rev().flat_map(|&unit| [Surface::Top(unit), Surface::CutBase(unit)]));
            order.push(Surface::Base(act));
        }
        let is_flat = |surface: &Surface| matches!(surface, Surface::Ground | Surface::Base(_));
        order.retain(|surface| seen.contains(surface) && (!is_flat(surface) || own.contains(surface)));
        // Where the ground is the top of a bed throughout, this comes before what lies below it.
        let is_ground_a_top = seen.contains(&Surface::Ground) && !own.contains(&Surface::Ground);
        // What intrudes last is the youngest. A body whose outline is not cut by the ground stands below the erosion that cut
        // it, others last.
        let acts = self.acts().iter().enumerate().rev();
        let bodies = acts.filter(|(_, act)| {
            matches!(act, Act::Dyke(_) | Act::Sheet(_) | Act::Salt(_) | Act::Body(_) | Act::Volcano(_))
        });
        let units = bodies.flat_map(|(n, _)| {
            let units = self.history().units().iter().enumerate();
            units.filter(move |(_, unit)| unit.act == n && unit.bed.is_none()).map(|(unit, _)| unit)
        });
        let mut baked = Vec::new();
        for unit in units.collect::<Vec<_>>() {
            if self.is_laid(unit) {
                let made = self.history().units()[unit].act;
                let is_younger = |surface: &Surface| match *surface {
                    Surface::Ground => true,
                    Surface::Base(act) => act > made,
                    Surface::CutBase(unit) | Surface::Body(unit) | Surface::Baked(unit) => {
                        self.history().units()[unit].act > made
                    }
                    Surface::Top(_) => false,
                };
                let under_air = usize::from(is_ground_a_top && matches!(order.first(), Some(Surface::Top(_))));
                let at = order.iter().rposition(is_younger).map_or(under_air, |n| n + 1);
                order.insert(at, Surface::Body(unit));
            } else if self.has_body(unit) {
                order.push(Surface::Body(unit));
            } else if self.is_baked(unit) {
                // Older than the body in it, so that this comes first.
                baked.push(Surface::Baked(unit));
            }
        }
        order.extend(baked);
        order
    }

    /// Whether a unit's outline is laid out as it formed.
    fn is_laid(&self, unit: usize) -> bool {
        self.is_laid_out(self.history().units()[unit].act)
    }

    /// Name of a surface.
    fn name(&self, surface: Surface) -> String {
        let units = self.history().units();
        match surface {
            Surface::Ground => {
                let last = self.acts().iter().rev().find(|act| matches!(act, Act::Erosion(_) | Act::Terrain(_)));
                last.and_then(Act::name).unwrap_or("Ground").to_owned()
            }
            Surface::Top(unit) => format!("Top {}", units[unit].name),
            Surface::CutBase(unit) => format!("Base {}", units[unit].name),
            Surface::Base(act) => {
                let eroded = self.acts()[..act].iter().rev().take_while(|act| !matches!(act, Act::Beds(_)));
                let named = eroded.filter(|act| matches!(act, Act::Erosion(_))).find_map(Act::name);
                let oldest = self.bed_unit(act, 0).map_or("", |unit| &units[unit].name);
                named.map_or_else(|| format!("Base {oldest}"), str::to_owned)
            }
            Surface::Body(unit) | Surface::Baked(unit) => units[unit].name.clone(),
        }
    }

    /// Whether a surface has one depth at each place of a block.
    fn is_map(&self, surface: Surface, columns: &[Vec<Node>]) -> bool {
        let of = |column: &Vec<Node>| -> Vec<Node> {
            column.iter().filter(|node| node.surface == surface).copied().collect()
        };
        let is_single = |column: &Vec<Node>| {
            let nodes = of(column);
            nodes.iter().enumerate().all(|(n, node)| {
                nodes[..n].iter().all(|other| other.sides != node.sides || (other.depth - node.depth).abs() < AT_TOP_M)
            })
        };
        match surface {
            Surface::Body(_) | Surface::Baked(_) => false,
            Surface::Top(_) => columns.iter().all(is_single),
            _ => true,
        }
    }
}
