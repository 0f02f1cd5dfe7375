//! Boxes in voxel space: the roaming box, the cut-outs, and the usual ways to cut a block diagram.
//!
//! P-illus 5.1 has one roaming box and one cut-out. We allow any number of cut-outs, so that a corner cut is
//! a box of full height and a stair is a few boxes. Coordinates are in voxels (x = inline index, y =
//! crossline index, z = sample index downwards) and fractional; both ends belong to the box.

use glam::DVec3;
use serde::{Deserialize, Serialize};

/// An axis-aligned box in voxel space.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VoxelBox {
    /// Smallest x, y, z.
    pub min: [f64; 3],
    /// Largest x, y, z.
    pub max: [f64; 3],
}

/// A vertical edge of a box, named by the ends of x and y at which it lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Corner {
    /// Smallest x, smallest y.
    MinMin,
    /// Smallest x, largest y.
    MinMax,
    /// Largest x, smallest y.
    MaxMin,
    /// Largest x, largest y.
    MaxMax,
}

impl Corner {
    /// All four corners.
    pub const ALL: [Self; 4] = [Self::MinMin, Self::MinMax, Self::MaxMin, Self::MaxMax];

    /// Whether the corner lies at the largest x, and whether at the largest y.
    pub fn at_max(self) -> [bool; 2] {
        match self {
            Self::MinMin => [false, false],
            Self::MinMax => [false, true],
            Self::MaxMin => [true, false],
            Self::MaxMax => [true, true],
        }
    }
}

impl VoxelBox {
    /// All samples of a volume of this size.
    ///
    /// ```
    /// assert_eq!(survey::block::VoxelBox::of_size([3, 4, 5]).max, [2.0, 3.0, 4.0]);
    /// ```
    pub fn of_size(size: [usize; 3]) -> Self {
        Self { min: [0.0; 3], max: size.map(|n| n.saturating_sub(1) as f64) }
    }

    /// Smallest corner.
    pub fn low(&self) -> DVec3 {
        DVec3::from_array(self.min)
    }

    /// Largest corner.
    pub fn high(&self) -> DVec3 {
        DVec3::from_array(self.max)
    }

    /// The middle.
    pub fn centre(&self) -> DVec3 {
        (self.low() + self.high()) * 0.5
    }

    /// Edge lengths.
    pub fn extent(&self) -> DVec3 {
        self.high() - self.low()
    }

    /// The eight corners.
    pub fn corners(&self) -> [DVec3; 8] {
        std::array::from_fn(|n| {
            let pick = |axis: usize| if n >> axis & 1 == 0 { self.min[axis] } else { self.max[axis] };
            DVec3::new(pick(0), pick(1), pick(2))
        })
    }

    /// The part that both boxes cover; `None` if they share no volume.
    pub fn intersection(&self, other: &Self) -> Option<Self> {
        let min = self.low().max(other.low());
        let max = self.high().min(other.high());
        (max - min).min_element().gt(&0.0).then(|| Self { min: min.to_array(), max: max.to_array() })
    }

    /// Whether every coordinate is a number and every edge has a length.
    pub fn is_solid(&self) -> bool {
        self.min.iter().chain(&self.max).all(|v| v.is_finite()) && self.extent().min_element() > 0.0
    }

    /// The cut-out of full height at `corner` that takes the fractions `share` of the length along x and
    /// along y.
    ///
    /// ```
    /// use survey::block::{Corner, VoxelBox};
    /// let block = VoxelBox { min: [0.0; 3], max: [100.0, 80.0, 60.0] };
    /// let cut = block.corner_cut(Corner::MaxMin, [0.4, 0.5]);
    /// assert_eq!((cut.min, cut.max), ([60.0, 0.0, 0.0], [100.0, 40.0, 60.0]));
    /// ```
    pub fn corner_cut(&self, corner: Corner, share: [f64; 2]) -> Self {
        let mut cut = *self;
        for (axis, at_max) in corner.at_max().into_iter().enumerate() {
            let length = share[axis] * (self.max[axis] - self.min[axis]);
            if at_max {
                cut.min[axis] = self.max[axis] - length;
            } else {
                cut.max[axis] = self.min[axis] + length;
            }
        }
        cut
    }

    /// A stair of `count` steps down towards `corner`. The lowest step reaches the fraction `depth_share` of
    /// the height and takes `share` / `count` of the length. Each step above it has the same height less and
    /// the same length more.
    pub fn stair(&self, corner: Corner, share: [f64; 2], depth_share: f64, count: usize) -> Vec<Self> {
        (1..=count)
            .map(|step| {
                let part = step as f64 / count as f64;
                let mut cut = self.corner_cut(corner, share.map(|s| s * part));
                let depth = depth_share * (count + 1 - step) as f64 / count as f64;
                cut.max[2] = self.min[2] + depth * (self.max[2] - self.min[2]);
                cut
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stair_narrows_downwards() {
        let block = VoxelBox { min: [0.0; 3], max: [100.0, 100.0, 90.0] };
        let steps = block.stair(Corner::MinMin, [0.6, 0.6], 1.0, 3);
        assert_eq!(steps.iter().map(|s| s.max[2].round()).collect::<Vec<_>>(), [90.0, 60.0, 30.0]);
        assert_eq!(steps.iter().map(|s| s.max[0].round()).collect::<Vec<_>>(), [20.0, 40.0, 60.0]);
    }

    #[test]
    fn boxes_that_only_touch_share_nothing() {
        let a = VoxelBox { min: [0.0; 3], max: [2.0; 3] };
        let b = VoxelBox { min: [2.0, 0.0, 0.0], max: [4.0; 3] };
        assert_eq!(a.intersection(&b), None);
        let c = VoxelBox { min: [1.0; 3], max: [4.0; 3] };
        assert_eq!(a.intersection(&c), Some(VoxelBox { min: [1.0; 3], max: [2.0; 3] }));
    }
}
