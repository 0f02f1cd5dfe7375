//! The paper's packed volume (P-illus 3.3) and its two lookups (3.4), the baseline for our own lookup.
//!
//! One 3-component volume stores coordinates and ids:
//!
//! ```text
//! k' = (k + L) / NumLayers          L = 0 … NumLayers − 1 from the bottom
//! j' = (ĵ + B) / NumFaultBlocks     B = 0 … NumFaultBlocks − 1
//! i' = î                            î, ĵ: i, j normalised over their range in the volume, widened by 2⁻¹²
//! layer = ⌊k'·NumLayers⌋            block = ⌊j'·NumFaultBlocks⌋, both clamped
//! ```
//!
//! The paper counts L from 1 in one sentence and from 0 in its example; we count from 0, which is consistent
//! with its formulas. Its text shifts k for blocks, its formula j; we shift j. The widening keeps ĵ inside
//! (0, 1), so that the block id of a stored value is certain. k is kept inside [0, 1) for the same reason; k
//! = 1 on a top may still read as the layer above, which is a property of the paper's packing.
//!
//! # Lookup
//! Plain trilinear interpolation is wrong in every cell that straddles a boundary.
//! [`PackedVolume::lookup_extrapolated`] follows 3.4. The paper does not define the id of the lookup position, where
//! interpolation is what fails; ours is the id of the nearest corner. Corners with another id are invalid. Each of them gets a value extrapolated linearly from its two neighbours in +x
//! if both have the id of the position, else from those in −x, +y, −y, +z, −z. Where none works the stored
//! value is used (the paper's "erroneous interpolation").
//!
//! Positions are voxels of the model; the volume is corner-aligned with it. Memory: 12 bytes a sample.

use crate::{FlatPoint, NO_REGION, Region, VoxelParameterization};
use glam::Vec3;

/// Fraction by which the ranges of i and j are widened on each side.
const PADDING: f32 = 1.0 / 4096.0;
/// Largest packed k; a larger one would read as the next layer.
const BELOW_ONE: f32 = 1.0 - 1.0 / 16384.0;
/// Order in which neighbours are tried (P-illus 3.4).
const DIRECTIONS: [[i32; 3]; 6] = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]];

/// The paper's 3-component volume.
///
/// ```
/// use glam::Vec3;
/// use param::{PackedVolume, Region, VoxelParameterization};
/// use survey::Volume;
///
/// // One layer in one block, k = 1 − z / 4 over 2 × 2 × 5 samples.
/// let size = [2, 2, 5];
/// let samples = |value: fn(usize) -> f32| Volume::from_samples(size, (0..20).map(value).collect()).unwrap();
/// let volumes = VoxelParameterization {
///     size,
///     i: samples(|n| (n / 10) as f32),
///     j: samples(|n| (n / 5 % 2) as f32),
///     k: samples(|n| 1.0 - (n % 5) as f32 / 4.0),
///     layer: Volume::filled(size, 0u16),
///     block: Volume::filled(size, 0u16),
/// };
/// let packed = PackedVolume::from_voxels(&volumes, size, 1, 1);
/// let flat = packed.lookup_extrapolated(Vec3::new(0.25, 0.5, 2.5));
/// assert_eq!(flat.region, Region { layer: 0, block: 0 });
/// assert!((flat.i - 0.25).abs() < 1e-5 && (flat.j - 0.5).abs() < 1e-5 && (flat.k - 0.375).abs() < 1e-5);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct PackedVolume {
    /// Counts of samples `[inlines, crosslines, samples]`.
    pub size: [usize; 3],
    /// Counts of voxels of the model that the volume spans, corner-aligned.
    pub voxels: [usize; 3],
    /// NumLayers.
    pub layers: usize,
    /// NumFaultBlocks.
    pub blocks: usize,
    /// i where î is 0 and where î is 1.
    pub i_range: [f32; 2],
    /// j where ĵ is 0 and where ĵ is 1.
    pub j_range: [f32; 2],
    /// `[i', j', k']` per sample `[inline][crossline][sample]`; NaN in samples of no region.
    pub values: Vec<[f32; 3]>,
}

impl PackedVolume {
    /// Packs the sampled parameterization of a model of `voxels` voxels, with its counts of layers and fault
    /// blocks.
    pub fn from_voxels(volumes: &VoxelParameterization, voxels: [usize; 3], layers: usize, blocks: usize) -> Self {
        let range = |samples: &[f32]| {
            let known = samples.iter().copied().filter(|value| value.is_finite());
            let (low, high) =
                known.fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
            let (low, high) = if low <= high { (low, high) } else { (0.0, 1.0) };
            let margin = (high - low).max(1e-6) * PADDING;
            [low - margin, high + margin]
        };
        let (i_range, j_range) = (range(volumes.i.samples()), range(volumes.j.samples()));
        let unit = |value: f32, range: [f32; 2]| (value - range[0]) / (range[1] - range[0]);
        let values = (0..volumes.i.samples().len())
            .map(|n| {
                let (layer, block) = (volumes.layer.samples()[n], volumes.block.samples()[n]);
                if layer == NO_REGION || block == NO_REGION {
                    return [f32::NAN; 3];
                }
                let k = volumes.k.samples()[n].clamp(0.0, BELOW_ONE);
                [
                    unit(volumes.i.samples()[n], i_range),
                    (unit(volumes.j.samples()[n], j_range) + f32::from(block)) / blocks as f32,
                    (k + f32::from(layer)) / layers as f32,
                ]
            })
            .collect();
        Self { size: volumes.size, voxels, layers, blocks, i_range, j_range, values }
    }

    /// The stored value of a sample; indices are clamped to the volume.
    #[inline]
    fn at(&self, p: [i32; 3]) -> [f32; 3] {
        let c: [usize; 3] = std::array::from_fn(|axis| p[axis].clamp(0, self.size[axis] as i32 - 1) as usize);
        self.values[(c[0] * self.size[1] + c[1]) * self.size[2] + c[2]]
    }

    fn contains(&self, p: [i32; 3]) -> bool {
        (0..3).all(|axis| p[axis] >= 0 && p[axis] < self.size[axis] as i32)
    }

    /// The ids that a packed value carries: floors on half-open intervals, clamped. [`NO_REGION`] for NaN.
    #[inline]
    pub(crate) fn region_of(&self, value: [f32; 3]) -> Region {
        if value[2].is_nan() {
            return Region { layer: NO_REGION, block: NO_REGION };
        }
        let id = |packed: f32, count: usize| ((packed * count as f32).floor().max(0.0) as usize).min(count - 1) as u16;
        Region { layer: id(value[2], self.layers), block: id(value[1], self.blocks) }
    }

    /// The cell that contains a voxel position, and the fractions in it.
    fn cell(&self, p: Vec3) -> ([i32; 3], [f32; 3]) {
        let mut cell = [0; 3];
        let mut fraction = [0.0; 3];
        for axis in 0..3 {
            let scale = (self.size[axis] - 1) as f32 / self.voxels[axis].saturating_sub(1).max(1) as f32;
            let at = (p[axis] * scale).clamp(0.0, (self.size[axis] - 1) as f32);
            cell[axis] = (at.floor() as i32).min(self.size[axis] as i32 - 2).max(0);
            fraction[axis] = at - cell[axis] as f32;
        }
        (cell, fraction)
    }

    /// Unpacks a value with given ids.
    fn unpack(&self, value: [f32; 3], region: Region) -> FlatPoint {
        let spread = |unit: f32, range: [f32; 2]| range[0] + unit * (range[1] - range[0]);
        FlatPoint {
            i: spread(value[0], self.i_range),
            j: spread(value[1] * self.blocks as f32 - f32::from(region.block), self.j_range),
            k: value[2] * self.layers as f32 - f32::from(region.layer),
            region,
        }
    }

    /// The lookup of P-illus 3.4 at voxel `p`: corners of another region are extrapolated from neighbours of
    /// this one before interpolating.
    pub fn lookup_extrapolated(&self, p: Vec3) -> FlatPoint {
        let (corners, fraction, region) = self.extrapolated_cell(p);
        self.unpack(trilinear(&corners, fraction), region)
    }

    /// [`PackedVolume::lookup_extrapolated`] with the Jacobian ∂(i, j, k)/∂(x, y, z) per voxel of the
    /// interpolation inside the cell.
    pub fn lookup_extrapolated_jacobian(&self, p: Vec3) -> (FlatPoint, [[f32; 3]; 3]) {
        let (corners, fraction, region) = self.extrapolated_cell(p);
        let spread = |range: [f32; 2]| range[1] - range[0];
        let unpacked = [spread(self.i_range), spread(self.j_range) * self.blocks as f32, self.layers as f32];
        let slopes: [[f32; 3]; 3] = std::array::from_fn(|axis| {
            let scale = (self.size[axis] - 1) as f32 / self.voxels[axis].saturating_sub(1).max(1) as f32;
            let end = |at: f32| {
                let mut fraction = fraction;
                fraction[axis] = at;
                trilinear(&corners, fraction)
            };
            let (low, high) = (end(0.0), end(1.0));
            std::array::from_fn(|n| (high[n] - low[n]) * scale * unpacked[n])
        });
        let jacobian = std::array::from_fn(|n| std::array::from_fn(|axis| slopes[axis][n]));
        (self.unpack(trilinear(&corners, fraction), region), jacobian)
    }

    /// The corners of the cell around a position, those of another region extrapolated; the fractions in the
    /// cell; the region.
    fn extrapolated_cell(&self, p: Vec3) -> ([[f32; 3]; 8], [f32; 3], Region) {
        let (cell, fraction) = self.cell(p);
        let nearest: [i32; 3] = std::array::from_fn(|axis| cell[axis] + i32::from(fraction[axis] >= 0.5));
        let region = self.region_of(self.at(nearest));
        (std::array::from_fn(|c| self.valid_corner(corner(cell, c), region)), fraction, region)
    }

    /// The value of a sample, extrapolated when it belongs to another region.
    fn valid_corner(&self, p: [i32; 3], region: Region) -> [f32; 3] {
        let own = self.at(p);
        if self.region_of(own) == region {
            return own;
        }
        for direction in DIRECTIONS {
            let near: [i32; 3] = std::array::from_fn(|axis| p[axis] + direction[axis]);
            let far: [i32; 3] = std::array::from_fn(|axis| p[axis] + 2 * direction[axis]);
            if !self.contains(far) {
                continue;
            }
            let (near, far) = (self.at(near), self.at(far));
            if self.region_of(near) == region && self.region_of(far) == region {
                return std::array::from_fn(|n| 2.0 * near[n] - far[n]);
            }
        }
        own
    }
}

/// Corner c of a cell: bit 0 is x, bit 1 y, bit 2 z.
fn corner(cell: [i32; 3], c: usize) -> [i32; 3] {
    std::array::from_fn(|axis| cell[axis] + (c >> axis & 1) as i32)
}

fn trilinear(corners: &[[f32; 3]; 8], fraction: [f32; 3]) -> [f32; 3] {
    std::array::from_fn(|n| {
        let mix = |low: f32, high: f32, t: f32| low + (high - low) * t;
        let along_x = |c: usize| mix(corners[c][n], corners[c + 1][n], fraction[0]);
        mix(mix(along_x(0), along_x(2), fraction[1]), mix(along_x(4), along_x(6), fraction[1]), fraction[2])
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use survey::Volume;

    /// i, j, k linear in voxels; layer 1 above z = 3.5, block 1 from x = 4.
    fn volumes(size: [usize; 3]) -> VoxelParameterization {
        let fill = |value: fn([f32; 3]) -> f32| {
            let samples = (0..size.iter().product::<usize>())
                .map(|n| value([n / size[2] / size[1], n / size[2] % size[1], n % size[2]].map(|at| at as f32)));
            Volume::from_samples(size, samples.collect()).unwrap()
        };
        let id = |value: fn([f32; 3]) -> bool| {
            let samples = (0..size.iter().product::<usize>()).map(|n| {
                u16::from(value([n / size[2] / size[1], n / size[2] % size[1], n % size[2]].map(|at| at as f32)))
            });
            Volume::from_samples(size, samples.collect()).unwrap()
        };
        VoxelParameterization {
            size,
            i: fill(|p| 0.1 * p[0] + if p[0] < 4.0 { 0.0 } else { 0.3 }),
            j: fill(|p| 0.1 * p[1] - 0.02 * p[0]),
            k: fill(|p| if p[2] <= 3.0 { 1.0 - 0.25 * (p[2] + 0.25) } else { 1.0 - 0.2 * (p[2] - 3.5) }),
            layer: id(|p| p[2] <= 3.0),
            block: id(|p| p[0] >= 4.0),
        }
    }

    #[test]
    fn packing_keeps_values_and_ids() {
        let volumes = volumes([8, 8, 8]);
        let packed = PackedVolume::from_voxels(&volumes, [8, 8, 8], 2, 2);
        for (x, y, z) in [(0, 0, 0), (7, 7, 7), (3, 5, 4), (4, 2, 3)] {
            let found = packed.lookup_extrapolated(Vec3::new(x as f32, y as f32, z as f32));
            assert_eq!(
                (found.region.layer, found.region.block),
                (volumes.layer.at(x, y, z), volumes.block.at(x, y, z))
            );
            assert!((found.i - volumes.i.at(x, y, z)).abs() < 1e-5);
            assert!((found.j - volumes.j.at(x, y, z)).abs() < 1e-5);
            assert!((found.k - volumes.k.at(x, y, z)).abs() < 1e-5);
        }
    }

    #[test]
    fn extrapolation_continues_a_linear_field_up_to_the_fault() {
        let packed = PackedVolume::from_voxels(&volumes([8, 8, 8]), [8, 8, 8], 2, 2);
        // In cells that straddle the fault or the horizon, on either side.
        for (x, z) in [(3.2f32, 1.3), (3.7, 6.1), (1.3, 3.8), (6.9, 3.3), (3.9, 5.6)] {
            let found = packed.lookup_extrapolated(Vec3::new(x, 4.4, z));
            let block = u16::from(x >= 3.5);
            let k = if z < 3.5 { 1.0 - 0.25 * (z + 0.25) } else { 1.0 - 0.2 * (z - 3.5) };
            assert_eq!(found.region, Region { layer: u16::from(z < 3.5), block });
            assert!((found.i - 0.1 * x - 0.3 * f32::from(block)).abs() < 1e-4, "i at {x}, {z}: {}", found.i);
            assert!((found.j - 0.44 + 0.02 * x).abs() < 1e-4, "j at {x}, {z}: {}", found.j);
            assert!((found.k - k).abs() < 1e-4, "k at {x}, {z}: {} and not {k}", found.k);
            // Plain interpolation mixes in the other side.
            let plain = {
                let (cell, fraction) = packed.cell(Vec3::new(x, 4.4, z));
                let value = trilinear(&std::array::from_fn(|c| packed.at(corner(cell, c))), fraction);
                packed.unpack(value, packed.region_of(value))
            };
            assert!((plain.i - found.i).abs() > 0.01 || (plain.k - found.k).abs() > 0.01, "{plain:?} at {x}, {z}");
        }
        // Where the fault meets the horizon the corner across both has no neighbour of the own region: 3.4's
        // failure.
        let junction = packed.lookup_extrapolated(Vec3::new(3.2, 4.4, 3.3));
        assert!((junction.i - 0.32).abs() > 0.01);
    }

    #[test]
    fn where_nothing_can_be_extrapolated_the_wrong_value_stays() {
        // Block 1 is the last column alone: it has no two neighbours along x, but those along y are its own.
        let mut volumes = volumes([5, 1, 2]);
        volumes.layer.samples_mut().fill(0);
        let packed = PackedVolume::from_voxels(&volumes, [5, 1, 2], 1, 2);
        let found = packed.lookup_extrapolated(Vec3::new(3.6, 0.0, 0.0));
        let expected = 0.4 * volumes.i.at(3, 0, 0) + 0.6 * volumes.i.at(4, 0, 0);
        assert_eq!(found.region.block, 1);
        assert!((found.i - expected).abs() < 1e-5, "{} and not {expected}", found.i);
    }

    #[test]
    fn another_size_is_corner_aligned() {
        let packed = PackedVolume::from_voxels(&volumes([8, 8, 8]), [15, 15, 15], 2, 2);
        let found = packed.lookup_extrapolated(Vec3::new(4.0, 4.0, 2.0));
        assert!((found.i - 0.2).abs() < 1e-5 && (found.k - (1.0 - 0.25 * 1.25)).abs() < 1e-5);
    }
}
