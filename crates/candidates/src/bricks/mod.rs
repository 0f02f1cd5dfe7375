//! Candidates of a volume of any size, brick by brick, in memory that is stated; the same bytes as in one piece.
//!
//! A *stage* is a function of bricks. Its tasks, one for each brick (or one for the whole survey, where only summaries
//! are handled), read named arrays that earlier stages wrote ([`NamedArrays`]), and write named arrays of their own.
//! Tasks of a stage know nothing of one another, each runs on one thread, and may be done in any order, in any process
//! and more than once. [`Bricks::run`] does all of them in order; a cluster calls `Bricks::run_task` for each of
//! [`Bricks::stages`] and waits between stages.
//!
//! Growing is defined as a set ([`crate::grow`]), so that a brick with a large enough halo decides what it owns as the
//! whole survey would. What needs the whole becomes a summary of each brick that is merged by a stage with one task:
//!
//! | stages | halo, traces | summary that is merged |
//! |---|---|---|
//! | `extrema`, `offsets` | 0 | count of extrema on each trace |
//! | `jumps`, `field` | 9 behind | histograms of jumps per 8 × 8 × 16 voxels; quantiles of heights |
//! | `beside`, `lobes` | 0 | quantiles of what lies beside strong extrema |
//! | `dips`, `noise` | 11 | medians of misfits and changes, by class |
//! | `breaks`, `variances` | 10 across | medians of smoothed breaks |
//! | `evidence`, `surroundings` | 2 | sums of evidence per 16 × 16 × 24 voxels |
//! | `parted`, `cuts` | 2, 22 | none: planes of faults are summed within their reach |
//! | `windows`, `components`, `labels` | width | windows of each part of a surface, and where parts meet at faces |
//! | `basins`, `divides`, `flooded`, `layers`, `trimmed` | 1, 1, 10 | the tree of least breaks between faces; how often a surface lies over itself |
//! | `pieces`, `joined` | 1 | boundary of each two pieces, traces of each piece |
//! | `triangles`, `order` | 1 | vertices and triangles of each surface |
//! | `trees` | | none: whole surfaces, some at a time |
//! | `distances` | the greatest distance | |
//!
//! Quantiles are exact (`samples`): bricks store their samples in order, with marks by which few of them are read.
//! Floating-point sums are made within one task, in the order of the whole survey, or are sums of integers. So the result
//! depends neither on the bricks' shape nor on threads, tasks or retries. Surfaces are numbered by their first vertex,
//! leaves by their surface and their place in its tree; neither depends on the bricks.
//!
//! The paper's method depends on the order of its seeds and is not available in bricks.

mod breaks;
mod components;
mod dips;
mod distances;
mod flood;
mod patch;
mod pieces;
mod row_code;
mod run;
mod samples;
mod stage;
#[cfg(test)]
mod tests;
mod tiles;
mod trees;
mod triangles;

pub use run::BrickSettings;
pub use stage::Stage;
pub use trees::BrickForest;

use crate::error::InterpError;
use crate::extraction::ExtractSettings;
use crate::grow::{GrowError, Method};
use crate::surfaces::Extremum;
use bytemuck::Pod;
use rayon::prelude::*;
use std::convert::Infallible;
use survey::arrays::NamedArrays;
use survey::source::BoxSource;
use tiles::Tiling;

/// An extraction in bricks: a volume, the arrays that stages exchange, and settings.
pub struct Bricks<'a> {
    source: &'a dyn BoxSource,
    arrays: &'a dyn NamedArrays,
    settings: ExtractSettings,
    kinds: Vec<Extremum>,
    size: [usize; 3],
    tiles: Tiling,
    /// Triangles of the surfaces whose trees one task builds, unless one surface has more.
    together: u64,
}

impl<'a> Bricks<'a> {
    /// Prepares an extraction of `source` that exchanges arrays through `arrays`, in bricks of `edge` traces along x and
    /// y. All processes that take part state the same.
    ///
    /// # Errors
    /// [`InterpError`] when a setting is out of range.
    pub fn new(
        source: &'a dyn BoxSource,
        arrays: &'a dyn NamedArrays,
        settings: &ExtractSettings,
        bricks: &BrickSettings,
    ) -> Result<Self, InterpError> {
        if settings.grow.method != Method::Ours {
            return Err(InterpError::WholeOnly);
        }
        let size = source.size();
        let kinds =
            settings.grow.kinds_in::<Infallible>(size).map_err(|error| InterpError::Growing(Box::new(error)))?;
        if size[2] > 2 * usize::from(u16::MAX) {
            let error = GrowError::<Infallible>::TooManyLines { lines: size[2] };
            return Err(InterpError::Growing(Box::new(error)));
        }
        crate::forest::check_settings(&settings.forest)?;
        settings.distance.check()?;
        let tiles = Tiling { size: [size[0], size[1]], edge: bricks.edge.map(|edge| edge.max(1)) };
        let (settings, together) = (settings.clone(), bricks.triangles_together.max(1));
        Ok(Self { source, arrays, settings, kinds, size, tiles, together })
    }

    /// Does the same for each kind of extremum, at a time where there are threads for it.
    fn each_kind(&self, work: impl Fn(usize) -> Result<(), InterpError> + Sync + Send) -> Result<(), InterpError> {
        (0..self.kinds.len()).into_par_iter().try_for_each(work)
    }

    /// Name of an array that each kind of extremum has.
    fn name(&self, array: &str, kind: usize) -> String {
        format!("{array}-{kind}")
    }

    fn write<T: Pod>(&self, array: &str, part: usize, values: &[T]) -> Result<(), InterpError> {
        self.arrays.write(array, part, bytemuck::cast_slice(values)).map_err(InterpError::Arrays)
    }

    /// Count of values in a part.
    fn count<T: Pod>(&self, array: &str, part: usize) -> Result<usize, InterpError> {
        Ok(self.arrays.length(array, part).map_err(InterpError::Arrays)? as usize / size_of::<T>())
    }

    /// All values of a part.
    fn read<T: Pod>(&self, array: &str, part: usize) -> Result<Vec<T>, InterpError> {
        let mut values = vec![T::zeroed(); self.count::<T>(array, part)?];
        self.read_at(array, part, 0, &mut values)?;
        Ok(values)
    }

    /// Values of a part from number `first` on.
    fn read_at<T: Pod>(&self, array: &str, part: usize, first: usize, out: &mut [T]) -> Result<(), InterpError> {
        let offset = (first * size_of::<T>()) as u64;
        self.arrays.read(array, part, offset, bytemuck::cast_slice_mut(out)).map_err(InterpError::Arrays)
    }
}
