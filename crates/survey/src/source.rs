//! Volumes that do not fit into memory: sources that are read in parts, and sources that are handed over in
//! parts.
//!
//! | trait | used by | implemented by |
//! |---|---|---|
//! | [`SlabSource`] | code that reads a volume once, trace by trace | a volume in memory or on disk |
//! | [`BoxSource`] | code that computes a volume from parts of another | a volume in memory or on disk |
//! | [`BlockSource`] | code that writes a volume | a file, or a computation |

use crate::progress::Progress;
use crate::sample::{SampleType, SamplesMut};
use crate::volume::Volume;
use std::borrow::Cow;
use std::convert::Infallible;
use std::error::Error;
use std::ops::Range;

/// A failure of a source or a sink of samples.
pub type SourceError = Box<dyn Error + Send + Sync>;

/// A source of traces: a volume in memory, or a store that is read slab by slab.
pub trait SlabSource: Sync {
    /// Why a slab could not be read.
    type Error: Send;

    /// `[inlines, crosslines, samples]`.
    fn size(&self) -> [usize; 3];

    /// Calls `visit(x, y, trace)` for every live trace with x in `inlines`, in the order (x, y).
    ///
    /// # Errors
    /// An error of the source.
    fn read(&self, inlines: Range<usize>, visit: &mut dyn FnMut(usize, usize, &[f32])) -> Result<(), Self::Error>;
}

impl SlabSource for Volume<f32> {
    type Error = Infallible;

    fn size(&self) -> [usize; 3] {
        Self::size(self)
    }

    fn read(&self, inlines: Range<usize>, visit: &mut dyn FnMut(usize, usize, &[f32])) -> Result<(), Self::Error> {
        for x in inlines {
            for y in 0..self.size()[1] {
                if self.is_live(x, y) {
                    visit(x, y, self.trace(x, y));
                }
            }
        }
        Ok(())
    }
}

/// A volume of which any box can be read.
///
/// ```
/// # use survey::{Volume, source::BoxSource};
/// let volume = Volume::from_samples([1, 2, 3], vec![0.0, 1.0, 2.0, 10.0, 11.0, 12.0])?;
/// let part = volume.read_box([0, 1, 1], [1, 1, 2])?;
/// assert_eq!(part.samples(), [11.0, 12.0]);
/// # Ok::<(), survey::source::SourceError>(())
/// ```
pub trait BoxSource: Sync {
    /// `[inlines, crosslines, samples]`.
    fn size(&self) -> [usize; 3];

    /// The live-trace mask, `[inline][crossline]`; `None` means that every trace is live.
    fn live(&self) -> Option<&[bool]>;

    /// The samples and the mask of a box that begins at the voxel `start`.
    ///
    /// # Errors
    /// An error of the source.
    fn read_box(&self, start: [usize; 3], size: [usize; 3]) -> Result<Volume<f32>, SourceError>;
}

impl BoxSource for Volume<f32> {
    fn size(&self) -> [usize; 3] {
        Self::size(self)
    }

    fn live(&self) -> Option<&[bool]> {
        Self::live(self)
    }

    fn read_box(&self, start: [usize; 3], size: [usize; 3]) -> Result<Volume<f32>, SourceError> {
        let places = (start[0]..start[0] + size[0]).flat_map(|x| (start[1]..start[1] + size[1]).map(move |y| (x, y)));
        let samples = places.clone().flat_map(|(x, y)| &self.trace(x, y)[start[2]..start[2] + size[2]]).copied();
        let mut part = Self::from_samples(size, samples.collect())?;
        if Self::live(self).is_some() {
            part.set_live(Some(places.map(|(x, y)| self.is_live(x, y)).collect()))?;
        }
        Ok(part)
    }
}

/// The lines that a source stores contiguously. Blocks span as many of them as memory allows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LineOrder {
    /// One inline after the other.
    #[default]
    Inlines,
    /// One crossline after the other.
    Crosslines,
}

/// A part of the lattice, with all its samples.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Block {
    /// Indices of its inlines.
    pub inlines: Range<usize>,
    /// Indices of its crosslines.
    pub crosslines: Range<usize>,
}

/// A volume that is handed over block by block, in the numeric type in which it will be stored.
pub trait BlockSource {
    /// `[inlines, crosslines, samples]`.
    fn size(&self) -> [usize; 3];

    /// The live-trace mask, `[inline][crossline]`; `None` means that every trace is live.
    fn live(&self) -> Option<Cow<'_, [bool]>>;

    /// The lines that are read fastest together.
    fn order(&self) -> LineOrder {
        LineOrder::Inlines
    }

    /// The type of the samples.
    fn sample_type(&self) -> SampleType;

    /// Fills `out` with the samples of a block, `[inline][crossline][sample]`. The previous content of `out`
    /// is undefined; its type is [`BlockSource::sample_type`].
    ///
    /// # Errors
    /// An error of the source, or [`Cancelled`](crate::Cancelled).
    fn read_block(&mut self, block: &Block, out: SamplesMut<'_>, progress: &Progress) -> Result<(), SourceError>;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_of_a_volume_has_its_samples_and_its_part_of_the_mask() {
        let mut volume = Volume::from_samples([2, 3, 4], (0..24u8).map(f32::from).collect()).unwrap();
        volume.set_live(Some(vec![true, true, false, true, true, true])).unwrap();
        let part = volume.read_box([0, 1, 2], [2, 2, 2]).unwrap();
        assert_eq!(part.samples(), [6.0, 7.0, 10.0, 11.0, 18.0, 19.0, 22.0, 23.0]);
        assert_eq!(part.live(), Some(&[true, false, true, true][..]));
    }
}
