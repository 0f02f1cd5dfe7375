//! The block at one moment: what is at a place follows from going back through the events.
//!
//! ```text
//! state(n, p)   what is at p after n acts
//!   moves rock      state(n − 1, undo(p))
//!   erosion         air above the surface, else state(n − 1, p)
//!   beds            the bed at p where state(n − 1, p) is air, else that
//!   intrusion       its rock inside the body where state(n − 1, undo(p)) is rock, else that
//! ```

use crate::history::{History, UnitOf};
use crate::kinds::{Act, InVolcano};
use crate::place::{MOST_ACTS, Place, Rock, Sides};
use crate::rock::hardness;
use glam::{DMat3, DVec2, DVec3};

/// The block after some of its events.
///
/// ```
/// use glam::DVec3;
/// use history::{History, Place};
/// let history = History::from_toml(
///     "size = [1000, 1000, 500]
///      [[events]]
///      kind = \"beds\"
///      beds = [{ rock = \"granite\", thickness = 300 }, { rock = \"shale\", thickness = 200, name = \"Shale\" }]
///      [[events]]
///      kind = \"tilt\"
///      dip = 30
///      direction = 90",
/// )?;
/// let stage = history.last_stage();
/// // In the middle the shale is 200 / cos 30° = 231 m thick.
/// let Place::Rock(rock) = stage.place(DVec3::new(500.0, 500.0, 115.5)) else { panic!("no rock") };
/// assert_eq!(history.units()[rock.unit].name, "Shale");
/// assert!((rock.ijk.z - 0.5).abs() < 1e-3);
/// # Ok::<(), history::HistoryError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Stage<'h> {
    history: &'h History,
    acts: Vec<Act>,
}

/// Nodes of carved ground along the block's longer edge.
const GROUND_NODES: usize = 161;

/// What is at a place at some time, without its sides.
#[derive(Debug, Clone, Copy)]
enum State {
    Air,
    Water,
    Rock { unit: usize, altered: Option<usize>, act: usize, ijk: DVec3 },
}

/// Sides of faults on which a place is taken to lie, wherever it is, so that rock is continued past them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Known {
    /// The sides.
    pub sides: Sides,
    /// Of this act and all after it; of those before, the side is the one on which the place lies.
    pub from: usize,
}

impl Default for Known {
    fn default() -> Self {
        Self { sides: Sides::default(), from: usize::MAX }
    }
}

impl<'h> Stage<'h> {
    /// After `progress` events: whole ones, and the share of the next one.
    pub(crate) fn new(history: &'h History, progress: f64) -> Self {
        Self::with_ground(history, progress, GROUND_NODES)
    }

    /// The same with ground that is carved on few nodes: enough to tell which beds are left.
    pub(crate) fn sketch(history: &'h History, progress: f64) -> Self {
        Self::with_ground(history, progress, 13)
    }

    fn with_ground(history: &'h History, progress: f64, nodes: usize) -> Self {
        let mut made = Self { history, acts: Vec::new() };
        for (n, event) in history.events().iter().enumerate() {
            let share = (progress - n as f64).clamp(0.0, 1.0) * event.acts.len() as f64;
            for (m, act) in event.acts.iter().enumerate() {
                let share = (share - m as f64).clamp(0.0, 1.0);
                if share <= 0.0 {
                    return made;
                }
                let act = if share < 1.0 { act.progressed(share) } else { act.clone() };
                let act = match act {
                    Act::Terrain(terrain) => Act::Terrain(terrain.carved(nodes, |p| made.hardness(p))),
                    other => other,
                };
                made.acts.push(act);
            }
        }
        made
    }

    /// The history that it is a stage of.
    pub fn history(&self) -> &'h History {
        self.history
    }

    /// What has happened so far, oldest first.
    pub fn acts(&self) -> &[Act] {
        &self.acts
    }

    /// Hardness of rock at a place, 1 for middling; `None` where there is none.
    fn hardness(&self, p: DVec3) -> Option<f64> {
        let seen = self.place(p).seen()?;
        Some(hardness(&self.history.units()[seen].rock))
    }

    /// What is at a place, m east, north and down from the block's south-west corner at depth 0.
    pub fn place(&self, p: DVec3) -> Place {
        self.place_among(p, &Known::default())
    }

    /// What would be at a place if it lay on the sides of faults that are known.
    pub(crate) fn place_among(&self, p: DVec3, known: &Known) -> Place {
        let mut sides = Sides::default();
        match self.state(self.acts.len(), p, (known, &mut sides)) {
            State::Air => Place::Air,
            State::Water => Place::Water,
            State::Rock { unit, altered, act, ijk } => {
                sides.0[..act.min(MOST_ACTS)].fill(0);
                Place::Rock(Rock { unit, altered, act, ijk, sides })
            }
        }
    }

    /// Whether there would be rock at a place just after act `act`, on the sides of faults that are known.
    pub(crate) fn is_rock_after(&self, act: usize, p: DVec3, known: &Known) -> bool {
        matches!(self.state(act + 1, p, (known, &mut Sides::default())), State::Rock { .. })
    }

    /// What is at a place after `count` acts, and the sides on which it lies.
    fn state(&self, count: usize, p: DVec3, (known, sides): (&Known, &mut Sides)) -> State {
        let Some(act) = count.checked_sub(1) else { return State::Air };
        let unit = |of: UnitOf| self.history.unit_of(act, of);
        let made = |of: UnitOf, ijk: DVec3| State::Rock { unit: unit(of), altered: None, act, ijk };
        match &self.acts[act] {
            Act::Beds(beds) => match (self.state(act, p, (known, sides)), beds.at(p)) {
                (State::Air | State::Water, Some(found)) => {
                    made(UnitOf::Bed { bed: found.bed, is_far: found.is_far }, p.with_z(found.k))
                }
                (older, _) => older,
            },
            Act::Erosion(erosion) if erosion.takes(p) => State::Air,
            Act::Terrain(terrain) if terrain.takes(p) => State::Air,
            Act::Erosion(_) | Act::Terrain(_) => self.state(act, p, (known, sides)),
            Act::Sea(sea) => match self.state(act, p, (known, sides)) {
                State::Air | State::Water if p.z >= sea.level_m => State::Water,
                State::Water => State::Air,
                older => older,
            },
            Act::Metamorphism(change) => match self.state(act, p, (known, sides)) {
                State::Rock { unit: of, act, ijk, .. } if change.changes(p) => {
                    State::Rock { unit: of, altered: Some(unit(UnitOf::Altered)), act, ijk }
                }
                older => older,
            },
            Act::Body(body) => match (self.state(act, p, (known, sides)), body.within(p)) {
                (State::Rock { .. }, Some(k)) => made(UnitOf::Body, p.with_z(k)),
                (State::Rock { unit: of, act, ijk, .. }, None) if body.bakes(p) => {
                    State::Rock { unit: of, altered: Some(unit(UnitOf::Altered)), act, ijk }
                }
                (older, _) => older,
            },
            Act::Volcano(volcano) => {
                let older = self.state(act, p, (known, sides));
                match volcano.within(p, !matches!(older, State::Rock { .. })) {
                    Some(InVolcano::Pipe(below)) => made(UnitOf::Body, p.with_z(-below)),
                    Some(InVolcano::Cone { is_ash: false, k }) => made(UnitOf::Body, p.with_z(k)),
                    Some(InVolcano::Cone { is_ash: true, k }) => made(UnitOf::Ash, p.with_z(k)),
                    None => older,
                }
            }
            moves => {
                let Some(map) = moves.deformation() else { return self.state(act, p, (known, sides)) };
                let side = if act >= known.from { known.sides.0[act] } else { map.side(p) };
                sides.0[act] = side;
                let older = self.state(act, map.undo(p, side), (known, sides));
                match (&older, self.intrudes(moves, p)) {
                    (State::Rock { .. }, Some(k)) => made(UnitOf::Body, p.with_z(k)),
                    _ => older,
                }
            }
        }
    }

    /// Where in the rock that an act brings along a place lies.
    fn intrudes(&self, act: &Act, p: DVec3) -> Option<f64> {
        match act {
            Act::Dyke(dyke) => dyke.within(p),
            Act::Sheet(sheet) => sheet.within(p),
            Act::Salt(salt) => salt.within(p),
            _ => None,
        }
    }

    /// Where the rock at `p` was just after act `act`, as rock of one block: maps are continued past faults.
    pub fn before(&self, act: usize, sides: &Sides, p: DVec3) -> DVec3 {
        let younger = self.acts.iter().enumerate().skip(act + 1).rev();
        younger
            .filter_map(|(n, act)| act.deformation().map(|map| (n, map)))
            .fold(p, |p, (n, map)| map.undo(p, sides.0[n]))
    }

    /// Where rock that was at `q` just after act `act` is now, if it has not gone.
    pub fn after(&self, act: usize, q: DVec3) -> (DVec3, Sides) {
        let mut sides = Sides::default();
        let mut p = q;
        for (n, act) in self.acts.iter().enumerate().skip(act + 1) {
            if let Some(map) = act.deformation() {
                sides.0[n] = map.side_before(p);
                p = map.apply(p, sides.0[n]);
            }
        }
        (p, sides)
    }

    /// (i, j, k) at a place as if the bed of `rock` went on there within its block: the functions whose levels 0 and 1 are
    /// the bed's base and top.
    pub fn coordinates(&self, rock: &Rock, p: DVec3) -> DVec3 {
        let q = self.before(rock.act, &rock.sides, p);
        match (&self.acts[rock.act], self.history.units()[rock.unit].bed) {
            (Act::Beds(beds), Some(bed)) => q.with_z(beds.k_of(bed, q)),
            _ => q.with_z(rock.ijk.z),
        }
    }

    /// Metres from k = 0 to k = 1 where the bed of `rock` is thickest; `None` for rock that is no bed.
    pub fn bed_thickness_m(&self, rock: &Rock) -> Option<f64> {
        match (&self.acts[rock.act], self.history.units()[rock.unit].bed) {
            (Act::Beds(beds), Some(bed)) => Some(beds.beds[bed].thickness_m),
            _ => None,
        }
    }

    /// Derivatives of (i, j, k) by the place, a row for each: central differences over a centimetre.
    pub fn gradient(&self, rock: &Rock, p: DVec3) -> DMat3 {
        const STEP_M: f64 = 0.01;
        let by = |axis: DVec3| {
            let [ahead, behind] = [STEP_M, -STEP_M].map(|step| self.coordinates(rock, p + axis * step));
            (ahead - behind) / (2.0 * STEP_M)
        };
        DMat3::from_cols(by(DVec3::X), by(DVec3::Y), by(DVec3::Z))
    }

    /// Depth of the ground or of the youngest erosion at a place of the map, if there is one.
    pub fn ground(&self, map: DVec2) -> Option<f64> {
        let is_rock = |z: f64| self.place(map.extend(z)).rock().is_some();
        let steps = 256;
        let height = self.history.size().z;
        let found = (0..=steps).map(|n| height * f64::from(n) / f64::from(steps)).find(|&z| is_rock(z))?;
        let step = height / f64::from(steps);
        let (mut air, mut rock) = ((found - step).max(0.0), found);
        for _ in 0..40 {
            let middle = 0.5 * (air + rock);
            if is_rock(middle) { rock = middle } else { air = middle }
        }
        Some(rock)
    }
}
