//! Throw and heave of a fault from the cut-offs of horizons on it.
//!
//! Where a horizon meets a fault from each side are its cut-offs. They are found on lines down the dip of the fault's
//! surface, at a place along its strike, from the sheets of the two blocks beside the fault there; the throw is their
//! difference in depth, the heave their distance on the map. So it is the same on every section, whatever its angle with
//! the fault.
//!
//! A throw is told from noise where it exceeds a sample, and twice the misfit of both sheets: the standard deviation of
//! white noise on their nodes near the cut-offs, from third differences, which see no curvature. A fault has one sense: of
//! its throws that can be told from noise, by their sum; none where they contradict one another.
//!
//! Spaces: voxels; metres along strike and on the map; throws in samples, positive where the positive side of the fault
//! ([`crate::FaultNetwork::side`]) went down.

use crate::StructuralModel;
use crate::network::FaultSurface;
use glam::{DMat3, DVec2, DVec3};
use rayon::prelude::*;
use survey::horizon::Quality;

/// How far beside a fault its blocks are looked up, voxels.
const BESIDE: f64 = 0.75;
/// How far beyond the sides of the volume the cut-offs of a place on one of them may lie, voxels: the dip of a fault that
/// runs at an angle to the side leads out of it.
const BEYOND: f64 = 6.0;
/// Places on a line down the dip at which horizons are looked for, at most.
const MOST_PLACES: f64 = 192.0;
/// Halvings that find a cut-off between two of them, and a tip between two lines.
const HALVINGS: usize = 24;
/// Lines down the dip from which a fault's sense is taken.
const SENSE_LINES: usize = 17;
/// Throws below this are not told from noise, samples.
const LEAST_SAMPLES: f64 = 1.0;
/// Throws below this many misfits of the sheets are not either.
const LEAST_MISFITS: f64 = 2.0;
/// A fault whose throws add up to less than this share of their sizes has no sense.
const AGREEMENT: f64 = 1.0 / 3.0;
/// Nodes on every side of a cut-off from which the misfit is taken.
const MISFIT_NODES: i32 = 8;

/// Where a horizon meets a fault from one side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CutOff {
    /// The place, voxels.
    pub place: DVec3,
    /// The block whose horizon ends there.
    pub block: u16,
    /// Whether the horizon was only continued there.
    pub is_inferred: bool,
    /// The standard deviation of the sheet's nodes beside it, samples.
    pub misfit: f64,
    /// Whether the older rock lies below.
    is_upright: bool,
    /// Sine of the angle between horizon and fault, in the direction of dip.
    crossing: f64,
}

/// The cut-offs of a horizon from both sides at a place along a fault.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Throw {
    /// The horizon, 0 = youngest.
    pub horizon: usize,
    /// Where along the strike of the fault's plane, m.
    pub along_m: f64,
    /// The cut-off of the negative side, and of the positive one.
    pub cut_offs: [CutOff; 2],
    /// Whether the fault was interpreted there; beyond its tip the horizon is one surface.
    pub is_real: bool,
}

impl Throw {
    /// Difference in depth, samples: positive where the positive side went down.
    pub fn samples(&self) -> f64 {
        self.cut_offs[1].place.z - self.cut_offs[0].place.z
    }

    /// Distance of the cut-offs on the map, m; `metric` is [`StructuralModel::metric`].
    pub fn heave_m(&self, metric: DMat3) -> f64 {
        (metric * (self.cut_offs[1].place - self.cut_offs[0].place)).truncate().length()
    }

    /// What a throw must exceed to be told from noise, samples.
    pub fn least_samples(&self) -> f64 {
        let misfit = self.cut_offs[0].misfit.hypot(self.cut_offs[1].misfit);
        LEAST_SAMPLES.max(LEAST_MISFITS * misfit)
    }

    /// Whether the throw is told from noise.
    pub fn is_told(&self) -> bool {
        self.is_real && self.samples().abs() >= self.least_samples()
    }

    /// Whether the horizon was only continued to the fault, on either side.
    pub fn is_inferred(&self) -> bool {
        self.cut_offs.iter().any(|cut_off| cut_off.is_inferred)
    }

    /// Sine of the angle at which the horizon meets the fault, the less of both sides.
    pub fn crossing(&self) -> f64 {
        self.cut_offs[0].crossing.min(self.cut_offs[1].crossing)
    }
}

/// Which way a fault moved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FaultSense {
    /// Whether the positive side went down.
    pub is_positive_down: bool,
    /// Whether the side above the fault went down; `None` of an upright fault.
    pub is_normal: Option<bool>,
    /// Whether every horizon that tells so was only continued to the fault.
    pub is_inferred: bool,
}

/// The throws of a horizon along a fault.
#[derive(Debug, Clone, PartialEq)]
pub struct HorizonThrows {
    /// The horizon, 0 = youngest.
    pub horizon: usize,
    /// Its throws where the fault was interpreted, along strike.
    pub throws: Vec<Throw>,
    /// Where along strike its throw ends inside the volume, at the tip of the fault, m.
    pub tips_m: Vec<f64>,
}

/// Throws of a fault of a model.
pub struct FaultThrows<'a> {
    model: &'a StructuralModel,
    surface: &'a FaultSurface,
    fault: usize,
    voxel_from_frame: DMat3,
    clipping: Clipping,
}

/// Which cut-offs count.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Clipping {
    /// Those of horizons as they are drawn.
    ByContacts,
    /// Also those that something younger has cut off, or that lie up to half a volume above or below it.
    Unclipped,
}

/// A place on a line down the dip: the two blocks beside it, if the fault parts them there.
struct DipPlace {
    v: f64,
    place: DVec3,
    blocks: Option<[u16; 2]>,
}

/// A dip this flat, or this steep, has no side above it: share of the normal that points up or aside.
const UPRIGHT: f64 = 0.02;

impl<'a> FaultThrows<'a> {
    /// Of a fault, by its number.
    pub fn new(model: &'a StructuralModel, fault: usize) -> Self {
        let surface = &model.faults().surfaces()[fault];
        let voxel_from_frame = surface.frame_from_voxel.inverse();
        Self { model, surface, fault, voxel_from_frame, clipping: Clipping::ByContacts }
    }

    /// The same, of sheets as if nothing younger had cut them off: throws that a horizon had before it was eroded, or pierced.
    pub fn unclipped(model: &'a StructuralModel, fault: usize) -> Self {
        Self { clipping: Clipping::Unclipped, ..Self::new(model, fault) }
    }

    /// Where along the strike of the fault's plane a voxel position lies, m.
    pub fn along_m(&self, p: DVec3) -> f64 {
        self.surface.frame(p).x * self.surface.spacing_m
    }

    /// The direction of strike along which [`Self::along_m`] grows, voxels for a metre.
    pub fn strike(&self) -> DVec3 {
        self.voxel_from_frame.x_axis / self.surface.spacing_m
    }

    /// The direction on the map, in voxels, from the fault to its positive side.
    pub fn positive_side(&self) -> DVec2 {
        (self.voxel_from_frame.z_axis).truncate()
    }

    /// A place on the fault, voxels.
    fn place(&self, u: f64, v: f64) -> DVec3 {
        let w = f64::from(self.surface.surface.z_at(u as f32, v as f32));
        self.voxel_from_frame * (DVec3::new(u, v, w) - self.surface.frame_offset)
    }

    /// Whether a place lies in the volume, or no more than `beyond` voxels beside its sides.
    fn is_in_volume(&self, p: DVec3, beyond: f64) -> bool {
        let size = self.model.size();
        let by = match self.clipping {
            Clipping::ByContacts => [beyond, beyond, 0.0],
            Clipping::Unclipped => [beyond, beyond, 0.5 * size[2] as f64],
        };
        let by = by.map(|by| by + 1e-6);
        (0..3).all(|axis| p[axis] >= -by[axis] && p[axis] <= size[axis] as f64 - 1.0 + by[axis])
    }

    /// The place in the volume that is closest to one beside its sides.
    fn inside(&self, p: DVec3) -> DVec3 {
        let [nx, ny, _] = self.model.size().map(|count| count as f64 - 1.0);
        DVec3::new(p.x.clamp(0.0, nx), p.y.clamp(0.0, ny), p.z)
    }

    /// The blocks beside a place on the fault, where it exists and parts two.
    fn blocks(&self, p: DVec3) -> Option<[u16; 2]> {
        let faults = self.model.faults();
        let aside = self.surface.side_gradient(p).normalize_or_zero() * BESIDE;
        let blocks = [p - aside, p + aside].map(|q| faults.block_at(q.as_vec3()));
        let exists = faults.existing(faults.bits_at(p.as_vec3())) >> self.fault & 1 == 1;
        (exists && blocks[0] != blocks[1]).then_some(blocks)
    }

    /// The line down the dip at a place along strike, inside the volume and up to `beyond` voxels beside its sides.
    fn line(&self, u: f64, beyond: f64) -> Vec<DipPlace> {
        let (first, count) = (self.surface.surface.origin[1], self.surface.surface.size[1]);
        let step = ((count - 1) as f64 / MOST_PLACES).max(1.0);
        let places = (0..).map(|n| f64::from(first) + step * f64::from(n));
        let places = places.take_while(|v| *v <= f64::from(first) + (count - 1) as f64);
        let known = places.map(|v| DipPlace { v, place: self.place(u, v), blocks: None });
        let inside = known.filter(|known| self.is_in_volume(known.place, beyond));
        inside.map(|known| DipPlace { blocks: self.blocks(known.place), ..known }).collect()
    }

    /// The throws of all horizons that meet the fault from both sides at a place along its strike, m.
    pub fn at(&self, along_m: f64) -> Vec<Throw> {
        self.on_line(along_m, 0.0)
    }

    /// The same at a place on the fault, voxels, which may lie on a side of the volume: its cut-offs may lie a little beyond.
    pub fn near(&self, p: DVec3) -> Vec<Throw> {
        self.on_line(self.along_m(p), BEYOND)
    }

    fn on_line(&self, along_m: f64, beyond: f64) -> Vec<Throw> {
        let u = along_m / self.surface.spacing_m;
        let line = self.line(u, beyond);
        let horizons = (0..self.model.stratigraphy().horizons.len()).filter(|&horizon| !self.model.is_body(horizon));
        let throws = horizons.flat_map(|horizon| {
            let [negative, positive] = [0, 1].map(|side| self.cut_offs(&line, u, horizon, side));
            // A limb that is upside down is paired with one that is.
            let pair = |from: CutOff| {
                let same = positive.iter().filter(|to| to.is_upright == from.is_upright);
                let apart = |to: &&CutOff| (to.place.z - from.place.z).abs();
                let to = *same.min_by(|a, b| apart(a).total_cmp(&apart(b)))?;
                let middle = self.inside(0.5 * (from.place + to.place));
                let is_real = self.surface.is_interpreted_at(middle);
                Some(Throw { horizon, along_m, cut_offs: [from, to], is_real })
            };
            negative.into_iter().filter_map(pair).collect::<Vec<_>>()
        });
        throws.collect()
    }

    /// Where a horizon meets a line from a side, limb by limb.
    fn cut_offs(&self, line: &[DipPlace], u: f64, horizon: usize, side: usize) -> Vec<CutOff> {
        let off = |p: DVec3, block: u16| f64::from(self.model.offset(horizon, block, p.as_vec3()));
        let mut found = Vec::new();
        let mut before: Option<(f64, u16, f64)> = None;
        for known in line {
            let Some(block) = known.blocks.map(|blocks| blocks[side]) else {
                before = None;
                continue;
            };
            let here = off(known.place, block);
            if let Some((v, _, there)) =
                before.filter(|(_, own, there)| *own == block && (*there < 0.0) != (here < 0.0))
            {
                let (mut low, mut high) = (v, known.v);
                for _ in 0..HALVINGS {
                    let middle = 0.5 * (low + high);
                    let is_before = (off(self.place(u, middle), block) < 0.0) == (there < 0.0);
                    if is_before { low = middle } else { high = middle }
                }
                found.extend(self.cut_off(self.place(u, 0.5 * (low + high)), horizon, block, here > there));
            }
            before = Some((known.v, block, here));
        }
        found
    }

    /// A cut-off, unless something younger has cut the horizon off there.
    fn cut_off(&self, place: DVec3, horizon: usize, block: u16, is_upright: bool) -> Option<CutOff> {
        let model = self.model;
        let below = model.below_at(place.as_vec3(), block);
        let [without, with] = [false, true].map(|is_below| model.rules().layer(&below.with(horizon, is_below)));
        if self.clipping == Clipping::ByContacts && without == with {
            return None;
        }
        let off = |p: DVec3| f64::from(model.offset(horizon, block, p.as_vec3()));
        let slope = DVec3::from_array(DVec3::AXES.map(|axis| 0.5 * (off(place + axis) - off(place - axis))));
        // Along the dip of the fault, and along its normal, per metre.
        let down = slope.dot(self.voxel_from_frame.y_axis / self.surface.spacing_m);
        let across = slope.dot(self.voxel_from_frame.z_axis);
        let crossing = down.abs() / down.hypot(across).max(1e-12);
        let is_level = model.level(horizon, block).is_some();
        let known = self.inside(place);
        let quality = model.quality_at(horizon, block, known.x as f32, known.y as f32);
        let is_inferred = !is_level && matches!(quality, Quality::Extrapolated | Quality::Hole);
        let misfit = if is_level { 0.0 } else { self.misfit(place, horizon, block) };
        Some(CutOff { place, block, is_inferred, misfit, is_upright, crossing })
    }

    /// The standard deviation of white noise on the nodes of a sheet near a place, on its own side of the fault.
    fn misfit(&self, place: DVec3, horizon: usize, block: u16) -> f64 {
        let (model, sheet) = (self.model, self.model.sheet(horizon, block));
        let [x, y] = [place.x.round() as i32, place.y.round() as i32];
        let width = 2 * MISFIT_NODES + 1;
        let node = |n: i32| {
            let (i, j) = (x - MISFIT_NODES + n / width, y - MISFIT_NODES + n % width);
            let [nx, ny, _] = model.size();
            let is_inside = i >= 0 && j >= 0 && i < nx as i32 && j < ny as i32;
            if !is_inside || !model.quality_at(horizon, block, i as f32, j as f32).is_on_data() {
                return f64::NAN;
            }
            let z = sheet.node(i, j);
            let p = glam::Vec3::new(i as f32, j as f32, z);
            if model.faults().holds(block, p) { f64::from(z) } else { f64::NAN }
        };
        let z: Vec<f64> = (0..width * width).map(node).collect();
        let mut differences: Vec<f64> = Vec::new();
        for n in 0..z.len() {
            for (fits, step) in [
                (n / width as usize + 3 < width as usize, width as usize),
                (n % width as usize + 3 < width as usize, 1),
            ] {
                if fits {
                    let third = z[n + 3 * step] - z[n] + 3.0 * (z[n + step] - z[n + 2 * step]);
                    differences.extend(third.is_finite().then_some(third.abs()));
                }
            }
        }
        if differences.is_empty() {
            return 0.0;
        }
        let half = differences.len() / 2;
        // A third difference of white noise has 20 times its variance; its median modulus is 0.6745 of its deviation.
        *differences.select_nth_unstable_by(half, f64::total_cmp).1 / (0.6745 * 20.0f64.sqrt())
    }

    /// First and last place along strike at which the fault was interpreted inside the volume, m; `None` where it was not.
    pub fn extent_m(&self) -> Option<[f64; 2]> {
        let (first, count) = (self.surface.surface.origin[0], self.surface.surface.size[0]);
        let step = (count / 256).max(1);
        let is_there = |u: f64| {
            let line = self.line(u, 0.0);
            line.iter().any(|known| known.blocks.is_some() && self.surface.is_interpreted_at(known.place))
        };
        let there: Vec<f64> = (0..count)
            .step_by(step)
            .collect::<Vec<_>>()
            .into_par_iter()
            .map(|n| f64::from(first) + n as f64)
            .filter(|u| is_there(*u))
            .collect();
        let (low, high) = (*there.first()?, *there.last()?);
        // To a fraction of a cell.
        let end = |inside: f64, outside: f64| {
            let (mut inside, mut outside) = (inside, outside);
            for _ in 0..HALVINGS / 2 {
                let middle = 0.5 * (inside + outside);
                if is_there(middle) { inside = middle } else { outside = middle }
            }
            inside * self.surface.spacing_m
        };
        Some([end(low, low - step as f64), end(high, high + step as f64)])
    }

    /// The throws of each horizon at `count` places along the fault, those of horizons that do not meet it left out.
    pub fn profile(&self, count: usize) -> Vec<HorizonThrows> {
        let Some([first, last]) = self.extent_m() else { return Vec::new() };
        // Beyond both ends, so that tips are found.
        let step = (last - first) / count.saturating_sub(1).max(1) as f64;
        let places: Vec<f64> = (0..count + 2).map(|n| first + step * (n as f64 - 1.0)).collect();
        let all: Vec<Vec<Throw>> = places.par_iter().map(|along_m| self.at(*along_m)).collect();
        let horizons = self.model.stratigraphy().horizons.len();
        let one = |horizon: usize| {
            let own = |throws: &Vec<Throw>| throws.iter().find(|throw| throw.horizon == horizon).copied();
            let along: Vec<Option<Throw>> = all.iter().map(own).collect();
            let mut tips_m = Vec::new();
            for (n, pair) in along.windows(2).enumerate() {
                if let [Some(a), Some(b)] = pair
                    && a.is_real != b.is_real
                {
                    tips_m.push(self.tip(horizon, [places[n], places[n + 1]], a.is_real));
                }
            }
            let throws = along.into_iter().flatten().filter(|throw| throw.is_real).collect();
            HorizonThrows { horizon, throws, tips_m }
        };
        (0..horizons).map(one).filter(|found| !found.throws.is_empty()).collect()
    }

    /// Where between two places along strike a horizon leaves what was interpreted of the fault.
    fn tip(&self, horizon: usize, [mut low, mut high]: [f64; 2], is_low_real: bool) -> f64 {
        for _ in 0..HALVINGS / 2 {
            let middle = 0.5 * (low + high);
            let throw = self.at(middle).into_iter().find(|throw| throw.horizon == horizon);
            if throw.is_some_and(|throw| throw.is_real == is_low_real) { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    }

    /// Which way the fault moved; `None` where no throw is told from noise, or they contradict one another.
    pub fn sense(&self) -> Option<FaultSense> {
        let [first, last] = self.extent_m()?;
        let place = |n: usize| first + (last - first) * (n as f64 + 0.5) / SENSE_LINES as f64;
        let lines = (0..SENSE_LINES).into_par_iter().map(|n| self.at(place(n)));
        let mut told: Vec<Throw> = lines.flatten_iter().filter(Throw::is_told).collect();
        let is_inferred = told.iter().all(Throw::is_inferred);
        told.retain(|throw| throw.is_inferred() == is_inferred);
        let sum: f64 = told.iter().map(Throw::samples).sum();
        let sizes: f64 = told.iter().map(|throw| throw.samples().abs()).sum();
        if told.is_empty() || sum.abs() < AGREEMENT * sizes {
            return None;
        }
        let is_positive_down = sum > 0.0;
        // The positive side lies above where the normal points up.
        let normal = (self.model.metric() * self.voxel_from_frame.z_axis).normalize_or_zero();
        let is_dipping = normal.z.abs() > UPRIGHT;
        let is_normal = is_dipping.then_some((normal.z < 0.0) == is_positive_down);
        Some(FaultSense { is_positive_down, is_normal, is_inferred })
    }
}

#[cfg(test)]
mod tests;
