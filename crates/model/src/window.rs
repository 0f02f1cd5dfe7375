//! The part of the lattice in which a block's sheets are worked out.
//!
//! With few blocks it is the whole lattice. With many of them most are small, and what their sheets are far outside of them
//! nobody sees: a sheet is then continued over the columns that its block touches and [`BEYOND`] nodes more, and is as high
//! as the border of these farther out.

use super::extension::Extension;
use super::lattice::MarginLattice;
use super::network::FaultNetwork;
use rayon::prelude::*;

/// Nodes by which a window reaches beyond its block: what is computed of a layer reaches a few columns beyond it, and a
/// block may be wider between the places that are looked at.
const BEYOND: usize = 14;
/// Columns and samples between the places that are looked at, and most such places along an axis.
const EVERY: usize = 4;
const MOST_PLACES: usize = 96;

/// Columns of a lattice, the first and the one after the last along each axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Window {
    first: [usize; 2],
    end: [usize; 2],
}

impl Window {
    /// The window of each block of a volume of so many samples.
    pub(super) fn of_blocks(lattice: MarginLattice, faults: &FaultNetwork, samples: usize) -> Vec<Self> {
        let whole = Self { first: [0; 2], end: lattice.size };
        if !faults.has_many_blocks() {
            return vec![whole; faults.block_count()];
        }
        let [nx, ny] = lattice.size;
        let step = |count: usize| EVERY.max(count.div_ceil(MOST_PLACES));
        let (across, along, down) = (step(nx), step(ny), step(samples));
        let nothing = || vec![None; faults.block_count()];
        let of_line = |x: usize| {
            let mut found: Vec<Option<Self>> = nothing();
            for y in (0..ny).step_by(along) {
                for z in (0..samples).step_by(down) {
                    let block = faults.block_at(lattice.place(x * ny + y, z as f32));
                    let own = Self { first: [x, y], end: [x + 1, y + 1] };
                    let seen = &mut found[usize::from(block)];
                    *seen = Some(seen.map_or(own, |seen| seen.with(own)));
                }
            }
            found
        };
        let lines: Vec<usize> = (0..nx).step_by(across).collect();
        let found = lines.into_par_iter().map(of_line).reduce(nothing, |a, b| {
            let both = |(a, b): (Option<Self>, Option<Self>)| match (a, b) {
                (Some(a), Some(b)) => Some(a.with(b)),
                (a, b) => a.or(b),
            };
            a.into_iter().zip(b).map(both).collect()
        });
        let reach = BEYOND.max(across).max(along);
        // A block between the places is small, but nobody knows where it lies.
        found.into_iter().map(|own| own.map_or(whole, |own| own.grown(reach, lattice.size))).collect()
    }

    /// What holds both.
    fn with(self, other: Self) -> Self {
        let first = [0, 1].map(|axis| self.first[axis].min(other.first[axis]));
        Self { first, end: [0, 1].map(|axis| self.end[axis].max(other.end[axis])) }
    }

    fn grown(self, by: usize, size: [usize; 2]) -> Self {
        let first = self.first.map(|first| first.saturating_sub(by));
        Self { first, end: [0, 1].map(|axis| (self.end[axis] + by).min(size[axis])) }
    }

    /// Replaces the NaN nodes of `values`, `[x][y]` of `size`; `None` when all are NaN.
    pub(super) fn extend(self, extension: &Extension, size: [usize; 2], values: &mut [f32]) -> Option<()> {
        let ny = size[1];
        let own = [0, 1].map(|axis| self.end[axis] - self.first[axis]);
        let at = |n: usize| (self.first[0] + n / own[1]) * ny + self.first[1] + n % own[1];
        let mut inside: Vec<f32> = (0..own[0] * own[1]).map(|n| values[at(n)]).collect();
        if own == size || inside.iter().all(|z| z.is_nan()) {
            return extension.extend(size, values);
        }
        extension.extend(own, &mut inside)?;
        for (n, z) in values.iter_mut().enumerate().filter(|(_, z)| z.is_nan()) {
            let near = |at: usize, axis: usize| at.clamp(self.first[axis], self.end[axis] - 1) - self.first[axis];
            *z = inside[near(n / ny, 0) * own[1] + near(n % ny, 1)];
        }
        Some(())
    }
}
