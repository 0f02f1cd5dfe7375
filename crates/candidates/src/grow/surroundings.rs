//! The mean evidence for breaks around a place.
//!
//! With one noise for a whole survey, every link in a chaotic part, in salt or below gas would look like a
//! fault. What counts is how much more evidence a link has than those around it: evidence is divided by its
//! mean over the neighbourhood where that mean is above the 1 that noise makes. A fault is a few traces wide
//! and hardly changes a mean over 48 × 48 traces. Space: traces and samples.

use crate::extrema::Extrema;
use rayon::prelude::*;

/// Size of a brick: inlines, crosslines, samples. A neighbourhood is 3 × 3 × 3 bricks.
pub(crate) const BRICK: [usize; 3] = [16, 16, 24];

/// Mean evidence around each place, in the units of the values given.
pub(crate) struct Surroundings {
    count: [usize; 3],
    means: Vec<f32>,
}

impl Surroundings {
    /// Takes the mean of `value(v)` over all extrema for which there is a value.
    pub(crate) fn new(extrema: &Extrema, value: impl Fn(usize) -> Option<u8> + Sync) -> Self {
        let size = extrema.size;
        let count = counts(size);
        let slab = count[1] * count[2];
        // Sum and count.
        let mut bricks = vec![[0u32; 2]; count[0] * slab];
        bricks.par_chunks_mut(slab).enumerate().for_each(|(bx, slab)| {
            for x in bx * BRICK[0]..((bx + 1) * BRICK[0]).min(size[0]) {
                for y in 0..size[1] {
                    for v in extrema.on_trace(x, y) {
                        if let Some(value) = value(v) {
                            let brick = &mut slab[y / BRICK[1] * count[2] + down(extrema.z[v], count[2])];
                            *brick = [brick[0] + u32::from(value), brick[1] + 1];
                        }
                    }
                }
            }
        });
        Self::of_sums(size, &bricks)
    }

    /// The means from the sum and the count of each brick, `[x][y][z]`, in a volume of `size`.
    pub(crate) fn of_sums(size: [usize; 3], bricks: &[[u32; 2]]) -> Self {
        let count = counts(size);
        let slab = count[1] * count[2];
        let means = (0..bricks.len())
            .into_par_iter()
            .map(|at| {
                let centre = [at / slab, at / count[2] % count[1], at % count[2]];
                let range = |axis: usize| centre[axis].saturating_sub(1)..(centre[axis] + 2).min(count[axis]);
                let around = range(0).flat_map(|x| range(1).flat_map(move |y| range(2).map(move |z| [x, y, z])));
                let [sum, of] = around.fold([0u64; 2], |total, [x, y, z]| {
                    let [sum, of] = bricks[(x * count[1] + y) * count[2] + z];
                    [total[0] + u64::from(sum), total[1] + u64::from(of)]
                });
                sum as f32 / of.max(1) as f32
            })
            .collect();
        Self { count, means }
    }

    /// The mean around (x, y, z).
    pub(crate) fn at(&self, x: usize, y: usize, z: f32) -> f32 {
        let [_, ny, nz] = self.count;
        self.means[(x / BRICK[0] * ny + y / BRICK[1]) * nz + down(z, nz)]
    }
}

/// Counts of bricks of a volume of `size`.
pub(crate) fn counts(size: [usize; 3]) -> [usize; 3] {
    [0, 1, 2].map(|axis| size[axis].div_ceil(BRICK[axis]).max(1))
}

/// Brick that contains a depth.
pub(crate) fn down(z: f32, count: usize) -> usize {
    (z.max(0.0) as usize / BRICK[2]).min(count - 1)
}
