//! A box of samples, trace-major: z fastest, then y, then x, i.e. `[inline][crossline][sample]`.
//!
//! A trace that was never recorded differs from one of zero amplitude: the optional live-trace mask tells
//! them apart.

/// Samples on the survey lattice. Memory: `size_of::<T>()` bytes per voxel, and one byte per trace for the
/// mask.
///
/// ```
/// # use survey::Volume;
/// let mut volume = Volume::from_samples([1, 2, 3], vec![0, 1, 2, 10, 11, 12])?;
/// assert_eq!(volume.trace(0, 1), [10, 11, 12]);
/// assert_eq!(volume.at(0, 1, 2), 12);
/// volume.set_live(Some(vec![true, false]))?;
/// assert!(volume.is_live(0, 0) && !volume.is_live(0, 1));
/// assert!(Volume::from_samples([1, 2, 3], vec![0; 5]).is_err());
/// # Ok::<(), survey::volume::SizeMismatch>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Volume<T> {
    size: [usize; 3],
    samples: Vec<T>,
    live: Option<Vec<bool>>,
}

/// The count of samples does not match the size of the volume.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("a volume of {size:?} needs {expected} values, found {found}")]
pub struct SizeMismatch {
    /// `[inlines, crosslines, samples]`.
    pub size: [usize; 3],
    /// Count of values that the volume needs.
    pub expected: usize,
    /// Count of values given.
    pub found: usize,
}

impl<T: Copy> Volume<T> {
    /// A volume in which every sample is `value` and every trace is live.
    pub fn filled(size: [usize; 3], value: T) -> Self {
        Self { size, samples: vec![value; size.iter().product()], live: None }
    }

    /// A volume of the given samples, in memory order; every trace is live.
    ///
    /// # Errors
    /// [`SizeMismatch`] when their count is not the product of `size`.
    pub fn from_samples(size: [usize; 3], samples: Vec<T>) -> Result<Self, SizeMismatch> {
        let expected = size.iter().product();
        if samples.len() != expected {
            return Err(SizeMismatch { size, expected, found: samples.len() });
        }
        Ok(Self { size, samples, live: None })
    }

    /// Sets the live-trace mask, `[inline][crossline]`; `None` means that every trace is live.
    ///
    /// # Errors
    /// [`SizeMismatch`] when the mask does not have one entry per trace.
    pub fn set_live(&mut self, live: Option<Vec<bool>>) -> Result<(), SizeMismatch> {
        let expected = self.size[0] * self.size[1];
        if let Some(mask) = &live
            && mask.len() != expected
        {
            return Err(SizeMismatch { size: [self.size[0], self.size[1], 1], expected, found: mask.len() });
        }
        self.live = live;
        Ok(())
    }

    /// `[inlines, crosslines, samples]`.
    pub fn size(&self) -> [usize; 3] {
        self.size
    }

    /// All samples in memory order.
    pub fn samples(&self) -> &[T] {
        &self.samples
    }

    /// Turns the volume into its samples, in memory order.
    pub fn into_samples(self) -> Vec<T> {
        self.samples
    }

    /// All samples in memory order, for writing.
    pub fn samples_mut(&mut self) -> &mut [T] {
        &mut self.samples
    }

    /// The live-trace mask, if one is set.
    pub fn live(&self) -> Option<&[bool]> {
        self.live.as_deref()
    }

    /// Whether the trace at (x, y) was recorded.
    pub fn is_live(&self, x: usize, y: usize) -> bool {
        self.live.as_ref().is_none_or(|mask| mask[x * self.size[1] + y])
    }

    /// The trace at (x, y), top first.
    pub fn trace(&self, x: usize, y: usize) -> &[T] {
        let start = (x * self.size[1] + y) * self.size[2];
        &self.samples[start..start + self.size[2]]
    }

    /// The trace at (x, y), for writing.
    pub fn trace_mut(&mut self, x: usize, y: usize) -> &mut [T] {
        let start = (x * self.size[1] + y) * self.size[2];
        &mut self.samples[start..start + self.size[2]]
    }

    /// The sample at (x, y, z).
    pub fn at(&self, x: usize, y: usize, z: usize) -> T {
        self.samples[(x * self.size[1] + y) * self.size[2] + z]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn z_is_fastest_then_y_then_x() {
        let volume = Volume::from_samples([2, 3, 4], (0..24).collect()).unwrap();
        assert_eq!(volume.at(1, 2, 3), 23);
        assert_eq!(volume.trace(0, 1), &[4, 5, 6, 7]);
    }

    #[test]
    fn a_missing_sample_is_noticed() {
        assert_eq!(Volume::from_samples([2, 2, 2], vec![0u8; 7]).unwrap_err().expected, 8);
    }

    #[test]
    fn the_mask_speaks_for_its_trace_only() {
        let mut volume = Volume::filled([2, 2, 1], 0.0f32);
        volume.set_live(Some(vec![true, false, true, true])).unwrap();
        assert!(!volume.is_live(0, 1) && volume.is_live(1, 0));
        assert!(volume.set_live(Some(vec![true])).is_err());
    }
}
