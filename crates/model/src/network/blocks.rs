//! Which combinations of fault sides occur in the volume: the fault blocks.
//!
//! The volume is halved again and again; a box farther from a fault than its own half diagonal lies on one
//! side of it (|w − g| changes by at most √(1 + |∂g|²) per metre), so only boxes that a fault passes through
//! are divided, down to single voxels. Blocks are numbered by their first voxel in memory order, which no
//! thread count or tiling can change.

use super::surface::FaultSurface;
use super::tree::FaultTree;
use super::{BlockSignature, Truncation};
use glam::{DMat3, DVec3};
use std::collections::BTreeMap;
use survey::progress::{Cancelled, Progress};

/// The faults that exist where the side bits are `bits`.
///
/// A truncated fault exists where the one it ends at exists and its own side of that one is.
pub(super) fn existing(truncation: &[Option<Truncation>], order: &[usize], bits: u64) -> u64 {
    order.iter().fold(0, |care, &f| {
        let exists = truncation[f].is_none_or(|t| care >> t.by & 1 == 1 && (bits >> t.by & 1 == 1) == t.positive);
        care | u64::from(exists) << f
    })
}

/// Which faults exist where.
pub(super) enum Existence<'a> {
    /// Everywhere, but for those that end at another: these, in order.
    Everywhere(&'a [Option<Truncation>], &'a [usize]),
    /// Each only in parts of the volume.
    Parts(&'a FaultTree),
}

/// The signatures that occur among the voxels of a volume, by first voxel; of more than `most`, some more than these.
pub(super) fn occurring(
    surfaces: &[FaultSurface],
    existence: &Existence,
    most: usize,
    size: [usize; 3],
    metric: DMat3,
    progress: &Progress,
) -> Result<Vec<BlockSignature>, Cancelled> {
    let change = surfaces.iter().map(|s| s.steepest().hypot(1.0)).collect();
    let search = BlockSearch { surfaces, change, existence, most, size, metric };
    let mut found = BTreeMap::new();
    search.visit([0; 3], size, (0, 0), &mut found, progress)?;
    let mut by_voxel: Vec<(usize, BlockSignature)> =
        found.into_iter().map(|((bits, care), first)| (first, BlockSignature { bits, care })).collect();
    by_voxel.sort_unstable_by_key(|&(first, _)| first);
    Ok(by_voxel.into_iter().map(|(_, s)| s).collect())
}

struct BlockSearch<'a> {
    surfaces: &'a [FaultSurface],
    /// Largest change of w − g per metre, per fault.
    change: Vec<f64>,
    existence: &'a Existence<'a>,
    most: usize,
    size: [usize; 3],
    metric: DMat3,
}

impl BlockSearch<'_> {
    /// Visits the voxels `low .. low + size`, where the sides of the faults in `known.0` are `known.1`.
    fn visit(
        &self,
        low: [usize; 3],
        size: [usize; 3],
        known: (u64, u64),
        found: &mut BTreeMap<(u64, u64), usize>,
        progress: &Progress,
    ) -> Result<(), Cancelled> {
        if found.len() > self.most {
            return Ok(());
        }
        let half = DVec3::from_array(size.map(|n| 0.5 * (n as f64 - 1.0)));
        let centre = DVec3::from_array(low.map(|n| n as f64)) + half;
        // The longest of the box's four diagonals, since lines need not be perpendicular.
        let reach = [DVec3::ONE, DVec3::new(-1.0, 1.0, 1.0), DVec3::new(1.0, -1.0, 1.0), DVec3::new(1.0, 1.0, -1.0)]
            .map(|s| (self.metric * (half * s)).length())
            .into_iter()
            .fold(0.0, f64::max);
        let (mut sure, mut bits) = known;
        for (f, surface) in self.surfaces.iter().enumerate() {
            if sure >> f & 1 == 0 {
                let side = surface.side(centre);
                if side.abs() > reach * self.change[f] || size == [1; 3] {
                    sure |= 1 << f;
                    bits |= u64::from(side >= 0.0) << f;
                }
            }
        }
        let all = if self.surfaces.len() == 64 { u64::MAX } else { (1 << self.surfaces.len()) - 1 };
        let care = match self.existence {
            Existence::Everywhere(truncation, order) => (sure == all).then(|| existing(truncation, order, bits)),
            Existence::Parts(tree) => tree.existing(bits, sure),
        };
        if let Some(care) = care {
            let first = (low[0] * self.size[1] + low[1]) * self.size[2] + low[2];
            let entry = found.entry((bits & care, care)).or_insert(first);
            *entry = first.min(*entry);
            return Ok(());
        }
        if size.iter().product::<usize>() > 4096 {
            progress.check()?;
        }
        let axis = (0..3).max_by_key(|&a| size[a]).unwrap_or(0);
        let (mut first, mut second, mut next) = (size, size, low);
        first[axis] = size[axis] / 2;
        second[axis] = size[axis] - first[axis];
        next[axis] += first[axis];
        self.visit(low, first, (sure, bits), found, progress)?;
        self.visit(next, second, (sure, bits), found, progress)
    }
}
