//! Volumes prepared for ray marching: no sample is NaN, and the range of every brick is known.
//!
//! The ranges serve empty-space skipping. They depend on the data alone and are kept while the data stay the
//! same.

use super::samples::{NO_DATA, NO_DATA_BELOW};
use crate::inputs::NamedVolume;
use glam::Vec3;
use rayon::prelude::*;
use std::collections::HashMap;
use std::sync::Arc;

/// Side of a brick, voxels. A brick has 9 samples along each axis, since neighbours share their border.
pub const BRICK: usize = 8;

/// The preparation of one volume.
#[derive(Debug)]
pub struct Prepared {
    /// A copy of the samples with [`NO_DATA`] where they are missing. Absent if none is.
    patched: Option<Vec<f32>>,
    /// Number of bricks along each axis.
    bricks: [usize; 3],
    /// Smallest and largest sample of each brick, `[x][y][z]`; in reverse order if it has none.
    ranges: Vec<[f32; 2]>,
}

/// A cache of prepared volumes by name, for one version of the data; 0 stands for none.
#[derive(Debug, Default)]
pub struct Preparations {
    version: Option<u64>,
    volumes: HashMap<String, Arc<Prepared>>,
}

impl Preparations {
    /// The preparation of a volume of these inputs; it is computed if it is not in the cache.
    pub fn of(&mut self, version: u64, volume: &NamedVolume) -> Arc<Prepared> {
        if version == 0 || self.version != Some(version) {
            self.volumes.clear();
            self.version = Some(version);
        }
        let make = || Arc::new(Prepared::new(volume));
        Arc::clone(self.volumes.entry(volume.name.to_owned()).or_insert_with(make))
    }
}

impl Prepared {
    fn new(volume: &NamedVolume) -> Self {
        let samples = volume.volume.all();
        let whole = volume.volume.whole().is_none_or(|volume| volume.live().is_none())
            && samples.par_chunks(1 << 16).all(|chunk| chunk.iter().all(|value| value.is_finite()));
        let size = volume.volume.size();
        let patched = (!whole).then(|| {
            let mut patched = samples.to_vec();
            patched.par_chunks_mut(size[2].max(1)).enumerate().for_each(|(trace, values)| {
                let live = volume.volume.is_live(trace / size[1], trace % size[1]);
                for value in values {
                    if !live || !value.is_finite() {
                        *value = NO_DATA;
                    }
                }
            });
            patched
        });
        let bricks = size.map(|n| n.saturating_sub(1).div_ceil(BRICK).max(1));
        let values = patched.as_deref().unwrap_or(samples);
        let ranges = (0..bricks[0] * bricks[1])
            .into_par_iter()
            .flat_map_iter(|column| column_ranges(values, size, bricks[2], [column / bricks[1], column % bricks[1]]))
            .collect();
        Self { patched, bricks, ranges }
    }

    /// The samples, without NaN.
    pub fn samples<'s>(&'s self, volume: &NamedVolume<'s>) -> &'s [f32] {
        self.patched.as_deref().unwrap_or(volume.volume.all())
    }

    /// Smallest and largest value that interpolation can give between two voxel positions; `None` if there is
    /// none.
    pub fn range(&self, volume: &NamedVolume, low: Vec3, high: Vec3) -> Option<[f32; 2]> {
        let (scale, offset) = volume.index_from_voxel();
        let (low, high) = (low * scale + offset, high * scale + offset);
        let brick = |axis: usize, index: f32, up: bool| {
            let place = index / BRICK as f32;
            let n = if up { (place - 1e-4).ceil() - 1.0 } else { (place + 1e-4).floor() };
            (n.max(0.0) as usize).min(self.bricks[axis] - 1)
        };
        for axis in 0..3 {
            let last = volume.volume.size()[axis].saturating_sub(1) as f32;
            if high[axis] < -0.01 || low[axis] > last + 0.01 {
                return None;
            }
        }
        let mut range = [f32::MAX, f32::MIN];
        for x in brick(0, low.x, false)..=brick(0, high.x, true) {
            for y in brick(1, low.y, false)..=brick(1, high.y, true) {
                for z in brick(2, low.z, false)..=brick(2, high.z, true) {
                    let [a, b] = self.ranges[(x * self.bricks[1] + y) * self.bricks[2] + z];
                    range = [range[0].min(a), range[1].max(b)];
                }
            }
        }
        (range[0] <= range[1]).then_some(range)
    }
}

/// The ranges of a column of bricks, top first.
fn column_ranges(values: &[f32], size: [usize; 3], count: usize, [bx, by]: [usize; 2]) -> Vec<[f32; 2]> {
    let mut ranges = vec![[f32::MAX, f32::MIN]; count];
    for x in bx * BRICK..=((bx + 1) * BRICK).min(size[0] - 1) {
        for y in by * BRICK..=((by + 1) * BRICK).min(size[1] - 1) {
            let trace = &values[(x * size[1] + y) * size[2]..][..size[2]];
            for (bz, range) in ranges.iter_mut().enumerate() {
                for &value in &trace[bz * BRICK..=((bz + 1) * BRICK).min(size[2] - 1)] {
                    if value > NO_DATA_BELOW {
                        *range = [range[0].min(value), range[1].max(value)];
                    }
                }
            }
        }
    }
    ranges
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::VoxelBox;
    use survey::Volume;

    #[test]
    fn ranges_cover_what_interpolation_can_show() {
        let size = [20, 9, 31];
        let values: Vec<f32> = (0..20 * 9 * 31).map(|n| ((n * 7919) % 1000) as f32).collect();
        let mut volume = Volume::from_samples(size, values).unwrap();
        volume.samples_mut()[100] = f32::NAN;
        let covers = VoxelBox { min: [10.0, 20.0, 30.0], max: [29.0, 28.0, 45.0] };
        let named = NamedVolume { name: "a", volume: crate::Samples::Whole(&volume), covers };
        let prepared = Preparations::default().of(1, &named);
        assert!(prepared.samples(&named)[100] < NO_DATA_BELOW);
        let (low, high) = (Vec3::new(12.0, 21.0, 31.0), Vec3::new(16.0, 24.5, 38.0));
        let range = prepared.range(&named, low, high).unwrap();
        for n in 0..2000 {
            let f = Vec3::new((n % 10) as f32 / 9.0, (n / 10 % 10) as f32 / 9.0, (n / 100) as f32 / 19.0);
            let value = named.sample(low + (high - low) * f);
            assert!(value.is_nan() || (range[0]..=range[1]).contains(&value), "{value} {range:?}");
        }
        assert_eq!(prepared.range(&named, Vec3::ZERO, Vec3::splat(9.0)), None);
    }

    #[test]
    fn an_aligned_brick_asks_itself_alone() {
        let volume = Volume::from_samples([17, 17, 17], (0..17 * 17 * 17).map(|n| n as f32).collect()).unwrap();
        let named = NamedVolume::whole("a", &volume);
        let prepared = Preparations::default().of(1, &named);
        let range = prepared.range(&named, Vec3::splat(8.0), Vec3::splat(16.0)).unwrap();
        assert_eq!(range, [volume.at(8, 8, 8), volume.at(16, 16, 16)]);
    }
}
