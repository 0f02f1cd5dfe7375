//! Which faults divide which part of the volume, where there are too many for each to divide all of it.
//!
//! Beyond its tip a fault is continued, because blocks need a boundary. With few faults the continuations run through the
//! whole volume. With n of them that makes up to n³/6 blocks, most of which no interpreted part of any fault bounds. So
//! with many the volume is divided as a tree: the largest fault first, and every other one only in those parts in which
//! some of it was interpreted. The continuation of a fault then ends at the larger faults around it.
//!
//! A part of a fault that goes on beyond a larger one by less than [`POKES_CELLS`] ends at it. Where there are still more
//! parts than a volume of its size can have, the smallest parts of faults are left out, until there are no more: faults
//! that cross one another so often leave blocks of a few voxels. In the end each fault divides one part alone.

use super::Truncation;
use super::build::Built;
use glam::DVec3;

/// Places that stand for the interpreted part of a fault, about.
const PLACES: usize = 4000;
/// A fault that goes on beyond another one by less than this ends at it, cells.
const POKES_CELLS: f64 = 1.5;
/// Voxels of a part on average, and the fewest and most parts into which a volume may be divided: some more than there can
/// be faults, and so many that each can have sheets.
const PART_VOXELS: usize = 4096;
const LEAVES: [usize; 2] = [72, 256];
/// Shares of a fault that are left out of a part when there are too many, one after the other. What is more than half of
/// a fault lies in one part.
const LEFT_OUT: [f64; 9] = [0.0, 0.005, 0.01, 0.02, 0.04, 0.08, 0.16, 0.32, 0.51];

/// A fault that divides a part of the volume, and what divides its two sides.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Division {
    fault: usize,
    /// The division of the negative and of the positive side.
    sides: [Option<usize>; 2],
}

/// The divisions of a volume.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct FaultTree {
    divisions: Vec<Division>,
    root: Option<usize>,
}

impl FaultTree {
    /// The tree of faults whose extents are known, in a volume of `size` voxels.
    pub(super) fn of(built: &[Built], truncation: &[Option<Truncation>], size: [usize; 3]) -> Self {
        let places: Vec<Vec<DVec3>> = built.iter().map(|built| interpreted(built, size)).collect();
        let places: Vec<Vec<DVec3>> = (0..built.len()).map(|f| existing(built, truncation, f, &places[f])).collect();
        let order = by_size(built, truncation, &places);
        let voxels = size.iter().product::<usize>();
        let most = (voxels / PART_VOXELS).clamp(LEAVES[0], LEAVES[1]);
        let mut tree = Self { divisions: Vec::new(), root: None };
        for share in LEFT_OUT {
            let least: Vec<usize> = places.iter().map(|places| (share * places.len() as f64) as usize + 1).collect();
            tree.divisions.clear();
            tree.root = tree.divide(built, &order, places.clone(), (&least, most));
            if tree.divisions.len() < most {
                break;
            }
        }
        tree
    }

    /// Divides a part in which these places of each fault lie.
    fn divide(
        &mut self,
        built: &[Built],
        order: &[usize],
        places: Vec<Vec<DVec3>>,
        (least, most): (&[usize], usize),
    ) -> Option<usize> {
        let at = order.iter().position(|&f| places[f].len() >= least[f])?;
        if self.divisions.len() >= most {
            return None;
        }
        let (fault, rest) = (order[at], &order[at + 1..]);
        let own = self.divisions.len();
        self.divisions.push(Division { fault, sides: [None; 2] });
        let mut sides = [vec![Vec::new(); built.len()], vec![Vec::new(); built.len()]];
        for &f in rest {
            let [below, above] = divided(&built[fault], &places[f]);
            (sides[0][f], sides[1][f]) = (below, above);
        }
        drop(places);
        let sides = sides.map(|places| self.divide(built, rest, places, (least, most)));
        self.divisions[own].sides = sides;
        Some(own)
    }

    /// The faults that divide the part in which the side bits are `bits`; `None` where a bit among them is not `sure`.
    pub(super) fn existing(&self, bits: u64, sure: u64) -> Option<u64> {
        let (mut at, mut care) = (self.root, 0);
        while let Some(Division { fault, sides }) = at.map(|at| self.divisions[at]) {
            if sure >> fault & 1 == 0 {
                return None;
            }
            care |= 1 << fault;
            at = sides[(bits >> fault & 1) as usize];
        }
        Some(care)
    }
}

/// Places of the interpreted part of a fault inside the volume, voxels.
fn interpreted(built: &Built, size: [usize; 3]) -> Vec<DVec3> {
    let surface = &built.surface;
    let nv = surface.surface.size[1];
    let voxel_from_frame = surface.frame_from_voxel.inverse();
    let last = DVec3::from_array(size.map(|n| n as f64 - 1.0));
    let is_inside = |p: &DVec3| p.cmpge(DVec3::ZERO).all() && p.cmple(last).all();
    let nodes: Vec<usize> = (0..surface.extent.z.len()).filter(|&n| surface.extent.z[n] >= 0.0).collect();
    let place = |n: usize| {
        let [u, v] = [(n / nv) as i32 + surface.surface.origin[0], (n % nv) as i32 + surface.surface.origin[1]];
        let on_it = DVec3::new(f64::from(u), f64::from(v), f64::from(surface.surface.z[n]));
        voxel_from_frame * (on_it - surface.frame_offset)
    };
    let step = nodes.len().div_ceil(PLACES).max(1);
    let nodes = nodes.into_iter().step_by(step).map(place);
    nodes.chain(built.vertices.iter().copied()).filter(is_inside).collect()
}

/// The places at which a fault is not cut off by those at which it is said to end.
fn existing(built: &[Built], truncation: &[Option<Truncation>], fault: usize, places: &[DVec3]) -> Vec<DVec3> {
    let exists = |p: &DVec3| {
        let mut at = fault;
        while let Some(Truncation { by, positive }) = truncation[at] {
            if (built[by].surface.side(*p) >= 0.0) != positive {
                return false;
            }
            at = by;
        }
        true
    };
    places.iter().copied().filter(exists).collect()
}

/// The faults by the area that was interpreted, the largest first, each after the one at which it is said to end.
fn by_size(built: &[Built], truncation: &[Option<Truncation>], places: &[Vec<DVec3>]) -> Vec<usize> {
    let area = |f: usize| {
        let surface = &built[f].surface;
        let nodes = surface.extent.z.iter().filter(|distance| **distance >= 0.0).count();
        if places[f].is_empty() { 0.0 } else { nodes as f64 * surface.spacing_m.powi(2) }
    };
    let mut left: Vec<usize> = (0..built.len()).collect();
    left.sort_by(|&a, &b| area(b).total_cmp(&area(a)).then(a.cmp(&b)));
    let mut order: Vec<usize> = Vec::with_capacity(left.len());
    while let Some(next) = left.iter().position(|&f| truncation[f].is_none_or(|t| order.contains(&t.by))) {
        order.push(left.remove(next));
    }
    order
}

/// The places on the negative and on the positive side of a fault; those close to it are on the side of most.
fn divided(fault: &Built, places: &[DVec3]) -> [Vec<DVec3>; 2] {
    let surface = &fault.surface;
    let close = POKES_CELLS * surface.spacing_m;
    let sided: Vec<(f64, DVec3)> = places.iter().map(|p| (surface.side(*p), *p)).collect();
    let clear = |above: bool| {
        let is_clear = |side: f64| if above { side > close } else { side < -close };
        sided.iter().filter(|(side, _)| is_clear(*side)).count()
    };
    let [below, above] = [clear(false), clear(true)];
    let is_mostly_above =
        if below == above { sided.iter().map(|(side, _)| side).sum::<f64>() >= 0.0 } else { above > below };
    let mut sides = [Vec::new(), Vec::new()];
    for (side, p) in sided {
        let is_above = if side.abs() <= close { is_mostly_above } else { side > 0.0 };
        sides[usize::from(is_above)].push(p);
    }
    sides
}
