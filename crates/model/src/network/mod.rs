//! The faults, continued as surfaces through the whole volume, and the blocks into which they divide it.
//!
//! A fault exists everywhere unless it is truncated by another one. Then it exists only on the side of the
//! other fault on which most of its vertices lie, and only where that other fault exists. A block is a
//! combination of sides that occurs in the volume; faults that do not exist at a place do not count there. A
//! combination that no voxel has (it can occur in a sliver between voxels) is given to the known block with
//! the fewest differing sides.
//!
//! Up to 64 faults may cross (X), end at one another (Y) or both. A circle of truncations is an error. Where that makes many
//! blocks, a fault exists only in those parts of the volume in which some of it was interpreted ([`tree`]).

mod blocks;
mod build;
mod crossing;
mod facing;
mod outline;
mod smoothing;
mod split;
mod surface;
mod tree;

pub use crossing::{FaultCrossing, drawn_crossing};
pub use split::{FaultPart, MOST_PARTS, ends_of_parts, fit_of, split};
pub use surface::FaultSurface;

use crate::report::ModelError;
use blocks::Existence;
use build::Built;
use glam::{DVec3, Vec3};
use outline::{Course, Reach};
use rayon::prelude::*;
use survey::fault::Fault;
use survey::geometry::SurveyGeometry;
use survey::height_field::{FAR, HeightField};
use survey::progress::Progress;
use tree::FaultTree;

/// Largest number of faults: each takes one bit of a mask.
const MOST_FAULTS: usize = 64;
/// Largest number of blocks: each needs sheets of its own.
const MOST_BLOCKS: usize = 4096;
/// With more blocks than these a fault divides no more of the volume than it must: each block costs as much as a survey
/// without faults.
const MANY_BLOCKS: usize = 32;
/// Up to this many faults, the block is read from a table of all combinations of sides, 2 bytes each.
const TABLE_FAULTS: usize = 14;

/// The end of one fault at another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Truncation {
    /// Index of the fault it ends at.
    pub by: usize,
    /// Whether the truncated fault lies on the positive side of that one.
    pub positive: bool,
}

/// The sides of the faults on which a block lies. The block holds every place whose side bits agree with
/// `bits` wherever `care` is set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BlockSignature {
    /// Bit f set: on the positive side of fault f.
    pub bits: u64,
    /// Bit f set: fault f exists there, so that its bit matters.
    pub care: u64,
}

/// All faults of a model, and the blocks between them.
#[derive(Debug, Clone, PartialEq)]
pub struct FaultNetwork {
    surfaces: Vec<FaultSurface>,
    truncation: Vec<Option<Truncation>>,
    /// Fault indices such that a fault comes after the one it ends at.
    order: Vec<usize>,
    signatures: Vec<BlockSignature>,
    /// Whether faults exist in some blocks alone, as the blocks say, and not wherever nothing cuts them off.
    in_parts: bool,
    /// Block of every combination of side bits, when there are few faults.
    table: Vec<u16>,
}

impl FaultNetwork {
    /// A network without faults: the whole volume is block 0.
    ///
    /// # Examples
    /// ```
    /// use glam::Vec3;
    /// use model::FaultNetwork;
    ///
    /// let faults = FaultNetwork::none();
    /// assert_eq!(faults.block_count(), 1);
    /// assert_eq!(faults.block_at(Vec3::new(3.0, 4.0, 5.0)), 0);
    /// ```
    pub fn none() -> Self {
        Self {
            surfaces: Vec::new(),
            truncation: Vec::new(),
            order: Vec::new(),
            signatures: vec![BlockSignature { bits: 0, care: 0 }],
            in_parts: false,
            table: vec![0],
        }
    }

    /// Continues `faults` through the volume of `geometry` and finds the blocks.
    ///
    /// # Errors
    /// [`ModelError`] for a fault without area, one that folds over itself, bad truncations, too many faults
    /// or blocks.
    pub fn build(geometry: &SurveyGeometry, faults: &[Fault], progress: &Progress) -> Result<Self, ModelError> {
        if faults.is_empty() {
            return Ok(Self::none());
        }
        if faults.len() > MOST_FAULTS {
            return Err(ModelError::TooMany { what: "faults", found: faults.len(), limit: MOST_FAULTS });
        }
        for (i, fault) in faults.iter().enumerate() {
            if faults[..i].iter().any(|f| f.name == fault.name) {
                return Err(ModelError::DuplicateName { what: "faults", name: fault.name.clone() });
            }
        }
        let order = truncation_order(faults)?;
        progress.begin("faults", faults.len() as u64);
        let one = |fault: &Fault| -> Result<Built, ModelError> {
            let built = build::build(geometry, fault)?;
            progress.step(1)?;
            Ok(built)
        };
        let made: Vec<Result<Built, ModelError>> = faults.par_iter().map(one).collect();
        let mut built = made.into_iter().collect::<Result<Vec<Built>, ModelError>>()?;
        let truncation: Vec<Option<Truncation>> = faults
            .iter()
            .zip(&built)
            .map(|(fault, own)| {
                let by = faults.iter().position(|f| Some(&f.name) == fault.truncated_by.as_ref())?;
                let positive = own.vertices.iter().filter(|&&v| built[by].surface.side(v) >= 0.0).count();
                Some(Truncation { by, positive: 2 * positive >= own.vertices.len() })
            })
            .collect();
        let extent_of = |f: usize| extent(geometry, &built, f, truncation[f], faults[f].grown_m);
        let extents: Vec<Vec<f32>> = (0..built.len()).into_par_iter().map(extent_of).collect();
        built.iter_mut().zip(extents).for_each(|(built, z)| built.surface.extent.z = z);
        let (size, metric) = (geometry.size(), geometry.metric_from_voxel());
        let surfaces: Vec<FaultSurface> = built.iter().map(|b| b.surface.clone()).collect();
        let everywhere = Existence::Everywhere(&truncation, &order);
        let mut signatures = blocks::occurring(&surfaces, &everywhere, MANY_BLOCKS, size, metric, progress)?;
        if signatures.len() > MANY_BLOCKS {
            progress.check()?;
            let tree = FaultTree::of(&built, &truncation, size);
            signatures = blocks::occurring(&surfaces, &Existence::Parts(&tree), MOST_BLOCKS, size, metric, progress)?;
        }
        if signatures.len() > MOST_BLOCKS {
            return Err(ModelError::TooMany { what: "fault blocks", found: signatures.len(), limit: MOST_BLOCKS });
        }
        Ok(Self { surfaces, truncation, order, signatures, in_parts: false, table: Vec::new() }.completed())
    }

    /// The same with its faults called by these names.
    #[must_use]
    pub fn named(mut self, names: impl IntoIterator<Item = String>) -> Self {
        self.surfaces.iter_mut().zip(names).for_each(|(surface, name)| surface.name = name);
        self
    }

    /// The network that [`Self::surfaces`], [`Self::truncation`] and [`Self::signatures`] are of; `None`
    /// where they do not go together.
    pub fn of_parts(
        surfaces: Vec<FaultSurface>,
        truncation: Vec<Option<Truncation>>,
        signatures: Vec<BlockSignature>,
    ) -> Option<Self> {
        let whole = |field: &HeightField| {
            let is_near = field.origin.iter().all(|&at| at.unsigned_abs() <= FAR.unsigned_abs());
            let is_sized = field.size.iter().all(|&n| (2..=FAR as usize).contains(&n));
            is_near && is_sized && field.size[0].checked_mul(field.size[1]) == Some(field.z.len())
        };
        let placed = |fault: &FaultSurface| {
            fault.frame_from_voxel.is_finite() && fault.frame_offset.is_finite() && fault.spacing_m.is_finite()
        };
        let fields = surfaces.iter().all(|fault| whole(&fault.surface) && whole(&fault.extent) && placed(fault));
        let faults = surfaces.len();
        if !fields || faults > MOST_FAULTS || truncation.len() != faults || signatures.is_empty() {
            return None;
        }
        let by: Vec<Option<usize>> = truncation.iter().map(|truncation| truncation.map(|t| t.by)).collect();
        if by.iter().flatten().any(|&by| by >= faults) {
            return None;
        }
        let order = ordered(&by).ok()?;
        Some(Self { surfaces, truncation, order, signatures, in_parts: false, table: Vec::new() }.completed())
    }

    /// With what follows from its parts: where faults exist, and the table of combinations, where there are few faults.
    fn completed(mut self) -> Self {
        let own = |block: &BlockSignature| blocks::existing(&self.truncation, &self.order, block.bits) == block.care;
        self.in_parts = !self.signatures.iter().all(own);
        let faults = self.surfaces.len();
        if faults <= TABLE_FAULTS {
            self.table = (0..1u64 << faults).map(|bits| self.nearest_block(bits)).collect();
        }
        self
    }

    /// Number of blocks, at least 1.
    pub fn block_count(&self) -> usize {
        self.signatures.len()
    }

    /// The fault surfaces, in the order in which the faults were given.
    pub fn surfaces(&self) -> &[FaultSurface] {
        &self.surfaces
    }

    /// For each fault, the fault it ends at, if any.
    pub fn truncation(&self) -> &[Option<Truncation>] {
        &self.truncation
    }

    /// The signature of each block; index = block id. A place is in the block with the fewest bits set in
    /// `(bits ^ signature.bits) & signature.care`, the first of them; for voxels of the volume that count is
    /// 0 for exactly one block.
    pub fn signatures(&self) -> &[BlockSignature] {
        &self.signatures
    }

    /// The block of every combination of side bits, 2^faults entries; `None` when there are too many faults
    /// for a table.
    pub fn table(&self) -> Option<&[u16]> {
        (!self.table.is_empty()).then_some(&self.table)
    }

    /// Signed metric offset of voxel position `p` from the extended surface of `fault`, along the normal of
    /// its plane, m.
    pub fn side(&self, fault: usize, p: Vec3) -> f32 {
        self.surfaces[fault].side(p.as_dvec3()) as f32
    }

    /// An upper bound of what [`Self::side`] of a fault changes by over a step of so many voxels, m.
    pub fn most_change(&self, fault: usize, step: Vec3) -> f32 {
        let surface = &self.surfaces[fault];
        let [u, v, w] = (surface.frame_from_voxel * step.as_dvec3()).to_array();
        (w.abs() + surface.steepest() * surface.spacing_m * u.hypot(v)) as f32
    }

    /// Side bits at voxel position `p`: bit f set on the positive side of fault f (or on it).
    pub fn bits_at(&self, p: Vec3) -> u64 {
        let p = p.as_dvec3();
        self.surfaces.iter().enumerate().map(|(f, s)| u64::from(s.side(p) >= 0.0) << f).sum()
    }

    /// The faults that exist where the side bits are `bits`, one bit each.
    pub fn existing(&self, bits: u64) -> u64 {
        if self.in_parts {
            return self.signatures[usize::from(self.block_of(bits))].care;
        }
        blocks::existing(&self.truncation, &self.order, bits)
    }

    /// Whether there are so many blocks that what no block sees is not worked out.
    pub(crate) fn has_many_blocks(&self) -> bool {
        self.signatures.len() > MANY_BLOCKS
    }

    /// Whether the place of `fault` nearest to voxel position `p` (along the normal of its plane) was
    /// interpreted, and is drawn.
    pub fn is_real(&self, fault: usize, p: Vec3) -> bool {
        self.surfaces[fault].extent_at(p.as_dvec3()) >= 0.0
            && (!self.in_parts && self.truncation[fault].is_none() || self.existing(self.bits_at(p)) >> fault & 1 == 1)
    }

    /// Whether a fault that was interpreted there runs between two neighbouring voxel positions, and not its continuation
    /// alone.
    pub fn divides(&self, a: Vec3, b: Vec3) -> bool {
        let between = self.bits_at(a) ^ self.bits_at(b);
        let middle = 0.5 * (a + b);
        between != 0 && (0..self.surfaces.len()).any(|f| between >> f & 1 == 1 && self.is_real(f, middle))
    }

    /// The block that voxel position `p` lies in.
    pub fn block_at(&self, p: Vec3) -> u16 {
        self.block_of(self.bits_at(p))
    }

    /// Whether voxel position `p` is on the sides of all faults that bound `block`; stops at the first one
    /// that says no.
    pub fn holds(&self, block: u16, p: Vec3) -> bool {
        let (p, BlockSignature { bits, care }) = (p.as_dvec3(), self.signatures[usize::from(block)]);
        self.surfaces.iter().enumerate().all(|(f, s)| care >> f & 1 == 0 || (s.side(p) >= 0.0) == (bits >> f & 1 == 1))
    }

    /// The block of a set of side bits.
    pub fn block_of(&self, bits: u64) -> u16 {
        match self.table.get(bits as usize) {
            Some(&block) => block,
            None => self.nearest_block(bits),
        }
    }

    fn nearest_block(&self, bits: u64) -> u16 {
        let difference = |s: &BlockSignature| ((s.bits ^ bits) & s.care).count_ones();
        (0..self.signatures.len()).min_by_key(|&b| difference(&self.signatures[b])).unwrap_or(0) as u16
    }
}

/// Fault indices such that each comes after the one it is truncated by.
fn truncation_order(faults: &[Fault]) -> Result<Vec<usize>, ModelError> {
    let mut by = Vec::with_capacity(faults.len());
    for fault in faults {
        by.push(match &fault.truncated_by {
            None => None,
            Some(name) => Some(
                faults
                    .iter()
                    .position(|f| &f.name == name)
                    .ok_or_else(|| ModelError::UnknownTruncation { name: fault.name.clone(), by: name.clone() })?,
            ),
        });
    }
    ordered(&by).map_err(|circle| ModelError::CyclicTruncation {
        names: circle.into_iter().map(|f| faults[f].name.clone()).collect(),
    })
}

/// Indices such that each comes after the one it ends at, or else a circle.
fn ordered(by: &[Option<usize>]) -> Result<Vec<usize>, Vec<usize>> {
    let mut order = Vec::with_capacity(by.len());
    for start in 0..by.len() {
        let mut path: Vec<usize> = Vec::new();
        let mut next = Some(start);
        while let Some(f) = next.filter(|f| !order.contains(f)) {
            if let Some(at) = path.iter().position(|&g| g == f) {
                return Err(path[at..].iter().copied().chain([f]).collect());
            }
            path.push(f);
            next = by[f];
        }
        order.extend(path.into_iter().rev());
    }
    Ok(order)
}

/// A fault that ends within this many voxels of the volume's outer boundary reaches it, if it was picked so coarsely
/// that half the spacing of its picks bridges the gap.
const REACHED_VOXELS: f64 = 4.0;
/// The share of the spacing of picks by which a fault is continued to the outer boundary at most.
const REACHED_SHARE: f64 = 0.5;
/// A fault that ends within this many voxels of the outer boundary reaches it in any case: the border of the data.
const BORDER_VOXELS: f64 = 1.5;

/// Cells by which the extent of a fault goes on past the one that it ends at. It does not exist there; but its end at that
/// one is no tip, near which patterns on its two sides would be joined.
const PAST_CELLS: f64 = 32.0;

/// Signed distance of fault `f` to the rim of its extent at its grid nodes, m, after its rim was extended to
/// what it nearly reaches, and grown as stated.
fn extent(
    geometry: &SurveyGeometry,
    built: &[Built],
    f: usize,
    truncation: Option<Truncation>,
    grown_m: f64,
) -> Vec<f32> {
    let Built { surface, patch, .. } = &built[f];
    let spacing_m = surface.spacing_m;
    let voxel_from_frame = surface.frame_from_voxel.inverse();
    let voxel = move |q: DVec3| voxel_from_frame * (q - surface.frame_offset);
    // In-plane direction (cells) along which `value`, 0 on the target and positive before it, falls, and the
    // cells to go.
    let towards = move |value: f64, gradient_voxel: DVec3| {
        let gradient = (voxel_from_frame.transpose() * gradient_voxel).truncate();
        let steep = gradient.length();
        (steep > 1e-9).then(|| (-gradient / steep, value / steep))
    };
    let to_border = move |voxels: f64, inwards: DVec3, spacing: f64| {
        let bridges = move |&(_, cells): &(_, f64)| {
            voxels <= BORDER_VOXELS || voxels <= REACHED_VOXELS && cells <= REACHED_SHARE * spacing
        };
        towards(voxels, inwards).filter(bridges)
    };
    let mut boundary: Vec<Box<dyn Fn(DVec3, f64) -> Course>> = Vec::new();
    for axis in 0..3 {
        let last = geometry.size()[axis] as f64 - 1.0;
        boundary.push(Box::new(move |q, spacing| to_border(voxel(q)[axis], DVec3::AXES[axis], spacing)));
        boundary.push(Box::new(move |q, spacing| to_border(last - voxel(q)[axis], -DVec3::AXES[axis], spacing)));
    }
    // Past the outer boundary of the volume the strip continues to the end of the grid, past a fault by some cells.
    let [nu, nv] = surface.surface.size;
    let mut reaches: Vec<(Reach, f64)> = boundary.iter().map(|face| (&**face as Reach, (nu + nv) as f64)).collect();
    let by = truncation.map(|t| (&built[t.by].surface, if t.positive { 1.0 } else { -1.0 }));
    let to_fault = by.map(|(other, sign)| {
        move |q: DVec3, spacing: f64| {
            let p = voxel(q);
            // That it ends there is stated, so the whole spacing of its picks is bridged.
            towards(sign * other.side(p), sign * other.side_gradient(p))
                .filter(|&(_, cells)| cells <= spacing.max(REACHED_VOXELS))
        }
    });
    if let Some(to_fault) = &to_fault {
        reaches.push((to_fault, PAST_CELLS));
    }
    let mut reached = patch.clone();
    reached.reach(&reaches);
    let cells = reached.signed_distance(surface.surface.origin, surface.surface.size);
    cells.into_iter().map(|d| (f64::from(d) * spacing_m + grown_m) as f32).collect()
}

#[cfg(test)]
mod tests;
