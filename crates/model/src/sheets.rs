//! The extended sheets: one height field for each horizon and fault block, defined everywhere.
//!
//! The data of a block are its own nodes and, where the fault between them is virtual (beyond its tip), the
//! nodes of its neighbours: both sheets are the same surface there, so that no step is visible. Beside the
//! interpreted part of a fault the nodes of the other side are ignored. The rest of the sheet is continued
//! ([`super::extension`]). Blocks that meet beyond a tip are also continued as one surface where neither has data
//! ([`join`]): the throw between them dies out towards the tip, and nothing is seen beyond it. A horizon without data in
//! a block is placed by the thickness or proportion it has elsewhere.

use super::extension::{Extension, NodePlane};
use super::lattice::{InterpretedNode, MarginLattice};
use super::network::{FaultNetwork, FaultSurface};
use super::nodes::HorizonNodes;
use super::report::{InferredPlacement, ModelNote};
use super::settings::ModelSettings;
use super::window::Window;
use glam::Vec3;
use rayon::prelude::*;
use survey::height_field::HeightField;
use survey::horizon::Quality;
use survey::progress::{Cancelled, Progress};

/// A deviation from the local fit below this is never an outlier, voxels.
const NOISE: f32 = 0.25;
/// Largest radius of the neighbourhood that a slope is taken from among many blocks, which are small, nodes.
const SMALL_RADIUS: f32 = 6.0;
/// Up to this many nodes beyond its data, where it meets faults, a sheet is as good as the data beside it.
const SOLID_NODES: usize = 4;

/// One extended sheet, and which of its nodes come from data.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ExtendedSheet {
    pub field: HeightField,
    /// Quality per node.
    pub quality: Vec<Quality>,
    /// Which nodes are data, its own or shared.
    pub known: Vec<bool>,
    /// Which of these may not be moved, since they were not extrapolated before they were given.
    pub fixed: Vec<bool>,
    /// Number of its own nodes.
    pub own: usize,
}

impl ExtendedSheet {
    /// The topmost part of a surface of any shape.
    pub(crate) fn of_level(lattice: MarginLattice, field: HeightField, own: usize) -> Self {
        let count = lattice.len();
        Self { field, quality: vec![Quality::Picked; count], known: vec![true; count], fixed: vec![true; count], own }
    }

    /// Which nodes are data or within a few nodes of it.
    pub(crate) fn near_data(&self, lattice: MarginLattice) -> Vec<bool> {
        near(lattice.size, self.known.clone())
    }
}

/// The share of the nodes of a grid that are data or within four nodes of it, which counts as picked everywhere.
///
/// ```
/// // One trace of a line of nine, in its middle.
/// let is_data = (0..9).map(|n| n == 4).collect();
/// assert_eq!(model::picked_share([9, 1], is_data), 1.0);
/// assert_eq!(model::picked_share([1, 9], vec![false; 9]), 0.0);
/// assert_eq!(model::picked_share([1, 10], (0..10).map(|n| n == 0).collect()), 0.5);
/// ```
pub fn picked_share(size: [usize; 2], is_data: Vec<bool>) -> f64 {
    let near = near(size, is_data);
    near.iter().filter(|near| **near).count() as f64 / near.len().max(1) as f64
}

/// These nodes of a grid and those within [`SOLID_NODES`] nodes of them.
fn near(size: [usize; 2], mut near: Vec<bool>) -> Vec<bool> {
    for _ in 0..SOLID_NODES {
        let before = near.clone();
        for n in (0..near.len()).filter(|&n| !before[n]) {
            near[n] = beside(size, n).any(|m| before[m]);
        }
    }
    near
}

/// The four neighbours of node `n`.
fn beside(size: [usize; 2], n: usize) -> impl Iterator<Item = usize> {
    let [nx, ny] = size;
    let (x, y) = (n / ny, n % ny);
    [(x > 0, n.wrapping_sub(ny)), (x + 1 < nx, n + ny), (y > 0, n.wrapping_sub(1)), (y + 1 < ny, n + 1)]
        .into_iter()
        .filter_map(|(inside, m)| inside.then_some(m))
}

/// The sheets of all horizons, `[horizon][block]`.
pub(super) fn extend_all(
    lattice: MarginLattice,
    names: &[&str],
    nodes: &[HorizonNodes],
    faults: &FaultNetwork,
    samples: usize,
    settings: &ModelSettings,
    progress: &Progress,
) -> Result<(Vec<Vec<ExtendedSheet>>, Vec<ModelNote>), Cancelled> {
    let blocks = faults.block_count();
    progress.begin("sheets", (nodes.len() * blocks) as u64);
    // The horizon as if there were no faults: it gives the mean slope, and it is the last resort for a block
    // without any data.
    let most = if faults.has_many_blocks() { SMALL_RADIUS } else { f32::INFINITY };
    let radius = settings.slope_radius.min(most);
    let wholes: Vec<(Vec<f32>, Extension)> = nodes
        .iter()
        .map(|n| {
            let whole = average(lattice, &n.nodes);
            let slope = NodePlane::through(lattice.size, &whole, [0.0; 2]).map_or([0.0; 2], |p| p.slope());
            (whole, Extension { radius, noise: NOISE, slope })
        })
        .collect();
    let windows = Window::of_blocks(lattice, faults, samples);
    let jobs: Vec<(usize, usize)> = (0..nodes.len()).flat_map(|h| (0..blocks).map(move |b| (h, b))).collect();
    let made: Vec<Option<ExtendedSheet>> = jobs
        .par_iter()
        .map(|&(h, b)| {
            let fewest = BlockPicks::fewest(faults, settings);
            let sheet = extend_one(lattice, &nodes[h].nodes, faults, b, (&wholes[h].1, windows[b]), fewest);
            progress.step(1).map(|()| sheet)
        })
        .collect::<Result<_, _>>()?;
    let mut sheets: Vec<Vec<Option<ExtendedSheet>>> =
        made.chunks(blocks.max(1)).map(<[Option<ExtendedSheet>]>::to_vec).collect();
    sheets.par_iter_mut().zip(&wholes).try_for_each(|(of_horizon, whole)| {
        progress.check()?;
        join(lattice, of_horizon, faults, &whole.1, &windows);
        Ok(())
    })?;
    let mut notes = Vec::new();
    for b in 0..blocks {
        let present: Vec<bool> = sheets.iter().map(|of_block| of_block[b].is_some()).collect();
        for h in (0..sheets.len()).filter(|&h| !present[h]) {
            progress.check()?;
            let (field, by) = place(lattice, &sheets, &present, h, b, &wholes[h]);
            let quality = vec![Quality::Extrapolated; lattice.len()];
            sheets[h][b] = Some(ExtendedSheet {
                field,
                quality,
                known: vec![false; lattice.len()],
                fixed: vec![false; lattice.len()],
                own: 0,
            });
            notes.push(ModelNote::Placed { horizon: names[h].to_owned(), block: b as u16, by });
        }
    }
    Ok((sheets.into_iter().map(|s| s.into_iter().flatten().collect()).collect(), notes))
}

/// The mean height of all blocks' nodes, NaN without any.
fn average(lattice: MarginLattice, nodes: &[InterpretedNode]) -> Vec<f32> {
    let mut sum = vec![(0.0f32, 0.0f32); lattice.len()];
    for node in nodes {
        let (z, n) = &mut sum[node.at as usize];
        *z += node.z;
        *n += 1.0;
    }
    sum.into_iter().map(|(z, n)| if n > 0.0 { z / n } else { f32::NAN }).collect()
}

/// The nodes that count for a horizon in one block: its own, and those of others that are the same surface there.
pub(super) struct BlockPicks {
    /// Heights, NaN without a node.
    pub z: Vec<f32>,
    quality: Vec<Quality>,
    pub known: Vec<bool>,
    /// Which nodes were picked, or computed between picks, rather than stated past the end of them.
    pub fixed: Vec<bool>,
    own: usize,
}

impl BlockPicks {
    /// Of `nodes`; `None` with fewer than `fewest`.
    pub(super) fn of(
        lattice: MarginLattice,
        nodes: &[InterpretedNode],
        faults: &FaultNetwork,
        block: usize,
        fewest: usize,
    ) -> Option<Self> {
        let mut z = vec![f32::NAN; lattice.len()];
        let mut quality = vec![Quality::Hole; lattice.len()];
        let signature = faults.signatures()[block];
        let mut own = 0;
        for node in nodes.iter().filter(|n| usize::from(n.block) == block) {
            z[node.at as usize] = node.z;
            quality[node.at as usize] = node.quality;
            own += 1;
        }
        for node in nodes.iter().filter(|n| usize::from(n.block) != block) {
            let between = (node.bits ^ signature.bits) & signature.care;
            if between != 0 && between & !node.beyond == 0 && z[node.at as usize].is_nan() {
                z[node.at as usize] = node.z;
                quality[node.at as usize] = node.quality;
            }
        }
        let known: Vec<bool> = z.iter().map(|z| z.is_finite()).collect();
        let is_fixed = |(known, quality): (&bool, &Quality)| *known && *quality != Quality::Extrapolated;
        let fixed = known.iter().zip(&quality).map(is_fixed).collect();
        (known.iter().filter(|&&k| k).count() >= fewest).then_some(Self { z, quality, known, fixed, own })
    }

    /// How many nodes a block needs at least.
    pub(super) fn fewest(faults: &FaultNetwork, settings: &ModelSettings) -> usize {
        if faults.block_count() == 1 { 1 } else { settings.fewest_nodes.max(1) }
    }
}

/// The sheet of `block` from the nodes that count for it; `None` with fewer than `fewest`.
fn extend_one(
    lattice: MarginLattice,
    nodes: &[InterpretedNode],
    faults: &FaultNetwork,
    block: usize,
    (extension, window): (&Extension, Window),
    fewest: usize,
) -> Option<ExtendedSheet> {
    let picks = BlockPicks::of(lattice, nodes, faults, block, fewest)?;
    let BlockPicks { mut z, mut quality, known, fixed, own } = picks;
    // Among many blocks it is continued once, when it is joined with the others.
    if !faults.has_many_blocks() {
        window.extend(extension, lattice.size, &mut z)?;
    }
    grade(lattice.size, &mut quality);
    Some(ExtendedSheet {
        field: HeightField { origin: lattice.origin, size: lattice.size, z },
        quality,
        known,
        fixed,
        own,
    })
}

/// Continues the sheets of one horizon as one surface wherever their blocks meet beyond the tips of all faults between
/// them. Independently continued, they would part there and jump where nothing breaks.
///
/// Block by block, the one with the most data first: what the blocks before it hold beyond the tips counts as data, so
/// that it continues them with their slope; in the end each block takes over what those after it hold.
fn join(
    lattice: MarginLattice,
    sheets: &mut [Option<ExtendedSheet>],
    faults: &FaultNetwork,
    extension: &Extension,
    windows: &[Window],
) {
    let mut order: Vec<usize> = (0..sheets.len()).filter(|&b| sheets[b].is_some()).collect();
    let is_continued = !faults.has_many_blocks();
    if order.len() < 2 && is_continued {
        return;
    }
    order.sort_by_key(|&b| (std::cmp::Reverse(sheets[b].as_ref().map_or(0, |sheet| sheet.own)), b));
    let mut shared: Vec<LentNodes> = Vec::with_capacity(order.len());
    for (done, &b) in order.iter().enumerate() {
        let lent = borrow(sheets, faults, b, &order[..done], &shared);
        if let Some(sheet) = sheets[b].as_mut().filter(|_| !lent.is_empty() || !is_continued) {
            let field = &mut sheet.field.z;
            (0..field.len()).filter(|&n| !sheet.known[n]).for_each(|n| field[n] = f32::NAN);
            lent.iter().for_each(|&(n, z)| field[n] = z);
            // There is data, so it can be continued.
            let _ = windows[b].extend(extension, lattice.size, field);
        }
        shared.push(LentNodes::of(lattice, sheets[b].as_ref(), faults, b));
    }
    for (done, &b) in order.iter().enumerate() {
        let lent = borrow(sheets, faults, b, &order[done + 1..], &shared[done + 1..]);
        if let Some(sheet) = &mut sheets[b] {
            lent.iter().for_each(|&(n, z)| sheet.field.z[n] = z);
        }
    }
}

/// What a sheet lends to other blocks: its nodes inside its own block that lie beyond the tip of some fault.
struct LentNodes {
    nodes: Vec<u32>,
    /// The faults that are virtual beside each.
    beyond: Vec<u64>,
}

impl LentNodes {
    fn of(lattice: MarginLattice, sheet: Option<&ExtendedSheet>, faults: &FaultNetwork, block: usize) -> Self {
        let mut shared = Self { nodes: Vec::new(), beyond: Vec::new() };
        // Among many blocks, places beyond the volume in none of them are not looked for.
        let is_inside = |p: Vec3| match faults.has_many_blocks() {
            true => faults.holds(block as u16, p),
            false => usize::from(faults.block_at(p)) == block,
        };
        for (n, &z) in sheet.iter().flat_map(|sheet| sheet.field.z.iter().enumerate()) {
            let p = lattice.place(n, z);
            if !is_inside(p) {
                continue;
            }
            let is_beyond = |fault: &FaultSurface| fault.extent_at(p.as_dvec3()) < 0.0;
            let beyond = faults.surfaces().iter().enumerate().map(|(f, s)| u64::from(is_beyond(s)) << f).sum();
            if beyond != 0 {
                shared.nodes.push(n as u32);
                shared.beyond.push(beyond);
            }
        }
        shared
    }
}

/// The nodes at which block `b` has no data and one of `lenders` holds the same surface, with its heights there; the
/// first of them decides.
fn borrow(
    sheets: &[Option<ExtendedSheet>],
    faults: &FaultNetwork,
    b: usize,
    lenders: &[usize],
    shared: &[LentNodes],
) -> Vec<(usize, f32)> {
    let (Some(sheet), signature) = (&sheets[b], faults.signatures()[b]) else { return Vec::new() };
    let mut is_free: Vec<bool> = sheet.known.iter().map(|known| !known).collect();
    let mut lent = Vec::new();
    for (&c, shared) in lenders.iter().zip(shared) {
        let Some(lender) = &sheets[c] else { continue };
        let other = faults.signatures()[c];
        let between = (signature.bits ^ other.bits) & signature.care & other.care;
        for (&n, beyond) in shared.nodes.iter().zip(&shared.beyond) {
            let n = n as usize;
            if between != 0 && between & !beyond == 0 && is_free[n] {
                is_free[n] = false;
                lent.push((n, lender.field.z[n]));
            }
        }
    }
    lent
}

/// Gives the nodes without data a quality: as their neighbours close to data, filled in enclosed holes,
/// extrapolated elsewhere. Nodes filled between close picks count as picked.
fn grade(size: [usize; 2], quality: &mut [Quality]) {
    let [nx, ny] = size;
    let rank = |q: Quality| match q {
        Quality::Picked => 0,
        Quality::Tracked => 1,
        Quality::Snapped => 2,
        Quality::Filled => 3,
        Quality::Extrapolated => 4,
        Quality::Hole => 5,
    };
    for _ in 0..SOLID_NODES {
        let before = quality.to_vec();
        for n in 0..quality.len() {
            if !before[n].is_on_data() {
                let best = beside(size, n).map(|m| before[m]).chain([before[n]]).min_by_key(|&q| rank(q));
                quality[n] = best.unwrap_or(Quality::Hole);
            }
        }
    }
    let mut stack: Vec<usize> = (0..quality.len())
        .filter(|&n| n / ny == 0 || n / ny == nx - 1 || n % ny == 0 || n % ny == ny - 1)
        .filter(|&n| quality[n] == Quality::Hole)
        .collect();
    stack.iter().for_each(|&n| quality[n] = Quality::Extrapolated);
    while let Some(n) = stack.pop() {
        for m in beside(size, n) {
            if quality[m] == Quality::Hole {
                quality[m] = Quality::Extrapolated;
                stack.push(m);
            }
        }
    }
    for q in quality.iter_mut().filter(|q| **q == Quality::Hole) {
        *q = Quality::Filled;
    }
}

/// A sheet for horizon `h` in block `b`, where it has no data.
fn place(
    lattice: MarginLattice,
    sheets: &[Vec<Option<ExtendedSheet>>],
    present: &[bool],
    h: usize,
    b: usize,
    whole: &(Vec<f32>, Extension),
) -> (HeightField, InferredPlacement) {
    let z_of = |h: usize, b: usize| sheets[h][b].as_ref().map(|s| &s.field.z);
    let own = |h: usize, b: usize| sheets[h][b].as_ref().map_or(0, |s| s.own);
    let above = (0..h).rev().find(|&a| present[a]);
    let below = (h + 1..sheets.len()).find(|&c| present[c]);
    // The other block that knows this horizon best, among those that know its neighbours too.
    let donor = (0..sheets[h].len())
        .filter(|&d| d != b && own(h, d) > 0)
        .filter(|&d| above.is_none_or(|a| own(a, d) > 0) && below.is_none_or(|c| own(c, d) > 0))
        .max_by_key(|&d| (own(h, d), usize::MAX - d));
    let field = |z: Vec<f32>| HeightField { origin: lattice.origin, size: lattice.size, z };
    if let (Some(d), true) = (donor, above.is_some() || below.is_some()) {
        let at_donor = z_of(h, d);
        let pair = |k: Option<usize>| k.and_then(|k| Some((z_of(k, b)?, z_of(k, d)?)));
        let (over, under) = (pair(above), pair(below));
        let z = (0..lattice.len())
            .map(|n| {
                let own = at_donor.map_or(0.0, |z| z[n]);
                match (over, under) {
                    (Some((top, top_d)), Some((base, base_d))) => {
                        let thick = base_d[n] - top_d[n];
                        let share = if thick > 1e-3 { ((own - top_d[n]) / thick).clamp(0.0, 1.0) } else { 0.5 };
                        top[n] + share * (base[n] - top[n])
                    }
                    (Some((top, top_d)), None) => top[n] + (own - top_d[n]).max(0.0),
                    (None, Some((base, base_d))) => base[n] - (base_d[n] - own).max(0.0),
                    (None, None) => own,
                }
            })
            .collect();
        return (field(z), InferredPlacement::Thickness { donor: d as u16 });
    }
    let mut z = whole.0.clone();
    whole.1.extend(lattice.size, &mut z);
    (field(z), InferredPlacement::OtherBlocks)
}
