//! Interpolation of a volume: trilinear values and central differences.
//!
//! ```text
//! v(i) = Σ w·s    over the 8 samples of the cell around i    Δₓ(i) = v(i + x) − v(i − x)
//! ```
//!
//! The two neighbours of a sample in depth are adjacent in memory. A cell is therefore four pairs, eight
//! numbers in two registers, which are interpolated first along x, then y, then depth; each step halves them.
//! Differences use the 4 × 4 × 4 neighbourhood of the cell, of which 32 samples in twelve short rows are
//! needed. Three interpolated values ahead and three behind are computed from them.
//!
//! Index space: the sample indices of the volume. A value that needs a missing sample ([`NO_DATA`]) lies far
//! below `NO_DATA_BELOW`. Positions outside the volume are missing, and a difference with a missing end
//! counts as zero.

use crate::inputs::SLACK;
use glam::{Vec2, Vec3, Vec4};

/// Values below this stand for missing data (NaN and dead traces).
pub(crate) const NO_DATA_BELOW: f32 = -1.0e30;
/// Value of missing samples.
pub const NO_DATA: f32 = -3.0e38;
/// Number of positions that are read at once.
pub(crate) const BATCH: usize = 64;

/// The samples of a volume, z fastest, with [`NO_DATA`] where they are missing.
#[derive(Clone, Copy)]
pub(crate) struct VolumeSamples<'s> {
    values: &'s [f32],
    size: [usize; 3],
    /// Offset from a sample to the next along each axis; 0 along an axis with a single sample.
    steps: [usize; 3],
    last: Vec3,
}

/// Positions in index space, coordinate by coordinate.
pub(crate) struct IndexPositions {
    /// x, y and z.
    pub axes: [[f32; BATCH]; 3],
}

impl Default for IndexPositions {
    fn default() -> Self {
        Self { axes: [[0.0; BATCH]; 3] }
    }
}

impl<'s> VolumeSamples<'s> {
    /// Samples of a volume of this size.
    pub(crate) fn new(values: &'s [f32], size: [usize; 3]) -> Self {
        let step = |axis: usize, stride: usize| if size[axis] > 1 { stride } else { 0 };
        Self {
            values,
            size,
            steps: [step(0, size[1] * size[2]), step(1, size[2]), step(2, 1)],
            last: Vec3::from_array(size.map(|n| n.saturating_sub(1) as f32)),
        }
    }

    /// The value at a position; below [`NO_DATA_BELOW`] if there is none.
    #[inline(always)]
    pub(crate) fn value(&self, index: Vec3) -> f32 {
        if !self.contains(index) {
            return NO_DATA;
        }
        let clamped = index.clamp(Vec3::ZERO, self.last);
        // Truncated, since the numbers are not negative and `floor` would be a library call.
        let cell = |axis: usize| (clamped[axis] as i32).min(self.size[axis].saturating_sub(2) as i32);
        let [x, y, z] = [cell(0), cell(1), cell(2)];
        let f = clamped - Vec3::new(x as f32, y as f32, z as f32);
        self.mix_of((x as usize * self.size[1] + y as usize) * self.size[2] + z as usize, f)
    }

    /// The values at the first `count` positions.
    #[inline(always)]
    pub(crate) fn values(&self, places: &IndexPositions, count: usize, values: &mut [f32; BATCH]) {
        let mut starts = [0u32; BATCH];
        let mut fractions = [[0.0f32; BATCH]; 3];
        // Upper limit of each value: none inside the volume, [`NO_DATA`] outside.
        let mut most = [f32::MAX; BATCH];
        for (axis, (places, fractions)) in places.axes.iter().zip(&mut fractions).enumerate() {
            let (last, rows) = (self.last[axis], self.size[axis] as u32);
            let deepest = (last - 1.0).max(0.0);
            for n in 0..BATCH {
                let place = places[n];
                let outside = (place < -SLACK) | (place > last + SLACK);
                most[n] = if outside { NO_DATA } else { most[n] };
                let place = if place > 0.0 { place } else { 0.0 };
                let place = if place < last { place } else { last };
                let (whole, cell) = whole(if place < deepest { place } else { deepest });
                fractions[n] = place - whole;
                starts[n] = starts[n].wrapping_mul(rows).wrapping_add(cell);
            }
        }
        let values = &mut values[..count.min(BATCH)];
        // Two calls, so that in the first the neighbours in depth are known to be adjacent and take one load.
        match self.steps {
            [dx, dy, 1] => self.mix([dx, dy, 1], &starts, &fractions, values),
            steps => self.mix(steps, &starts, &fractions, values),
        }
        for (value, most) in values.iter_mut().zip(&most) {
            *value = if most < value { *most } else { *value };
        }
    }

    /// Interpolates between the corners of many cells.
    #[inline(always)]
    fn mix(&self, [dx, dy, dz]: [usize; 3], starts: &[u32; BATCH], f: &[[f32; BATCH]; 3], values: &mut [f32]) {
        // The samples at each corner, indexed by the first sample of the cell. All slices have the same
        // length, so one bounds check serves all.
        let cells = self.values.len() - (dx + dy + dz);
        let corner = |offset: usize| &self.values[offset..offset + cells];
        let [a, b] = [corner(0), corner(dz)];
        let [c, d] = [corner(dy), corner(dy + dz)];
        let [e, g] = [corner(dx), corner(dx + dz)];
        let [h, i] = [corner(dx + dy), corner(dx + dy + dz)];
        for (n, value) in values.iter_mut().enumerate() {
            let at = starts[n] as usize;
            let (near, far) = (Vec4::new(a[at], b[at], c[at], d[at]), Vec4::new(e[at], g[at], h[at], i[at]));
            *value = mixed(near, far, Vec3::new(f[0][n], f[1][n], f[2][n]));
        }
    }

    /// Interpolates between the corners of a cell.
    #[inline(always)]
    fn mix_of(&self, start: usize, f: Vec3) -> f32 {
        let [dx, dy, dz] = self.steps;
        let square = |at: usize| {
            let (near, far) = (at, at + dy);
            Vec4::new(self.values[near], self.values[near + dz], self.values[far], self.values[far + dz])
        };
        mixed(square(start), square(start + dx), f)
    }

    /// Central differences: the value one sample ahead minus the value one sample behind, along each axis.
    #[inline(always)]
    pub(crate) fn differences(&self, index: Vec3) -> Vec3 {
        let cell = |axis: usize| index[axis] as i32;
        let [x, y, z] = [cell(0), cell(1), cell(2)];
        let inside = |cell: i32, axis: usize| cell >= 1 && cell as usize + 2 < self.size[axis];
        if !(inside(x, 0) && inside(y, 1) && inside(z, 2)) {
            let along = |axis: Vec3| difference(self.value(index + axis), self.value(index - axis));
            return Vec3::new(along(Vec3::X), along(Vec3::Y), along(Vec3::Z));
        }
        let f = index - Vec3::new(x as f32, y as f32, z as f32);
        let start = (x as usize * self.size[1] + y as usize) * self.size[2] + z as usize;
        let [dx, dy, _] = self.steps;
        // The samples of a column from one above the cell to one below it.
        let row = |at: usize| Vec4::from_slice(&self.values[at - 1..at + 3]);
        let mix = |a: Vec4, b: Vec4, t: f32| a + (b - a) * t;
        let [a, b, c, d] = [row(start), row(start + dy), row(start + dx), row(start + dx + dy)];
        let (near, far) = (mix(a, b, f.y), mix(c, d, f.y));
        let middle = mix(near, far, f.x);
        let before = mix(row(start - dx), row(start - dx + dy), f.y);
        let after = mix(row(start + 2 * dx), row(start + 2 * dx + dy), f.y);
        let left = mix(row(start - dy), row(start + dx - dy), f.x);
        let right = mix(row(start + 2 * dy), row(start + dx + 2 * dy), f.x);
        let (front, back) = (mix(a, c, f.x), mix(b, d, f.x));
        let at_depth = |row: Vec4| row.y + (row.z - row.y) * f.z;
        Vec3::new(
            difference(at_depth(mix(far, after, f.x)), at_depth(mix(before, near, f.x))),
            difference(at_depth(mix(back, right, f.y)), at_depth(mix(left, front, f.y))),
            difference(middle.z + (middle.w - middle.z) * f.z, middle.x + (middle.y - middle.x) * f.z),
        )
    }

    /// Whether a position is in the volume.
    #[inline(always)]
    fn contains(&self, index: Vec3) -> bool {
        index.cmpge(Vec3::splat(-SLACK)).all() && index.cmple(self.last + SLACK).all()
    }
}

/// A number from 0 to 2²² rounded down, as a float and as an integer. Avoids the conversion instruction,
/// which has no vector form that is defined for every number.
#[inline(always)]
pub fn whole(number: f32) -> (f32, u32) {
    // From 2²³ on, floats are integers: adding 2²³ rounds, and the result is in the last bits.
    const INTEGERS: f32 = 8_388_608.0;
    let nearest = (number + INTEGERS) - INTEGERS;
    let below = if nearest > number { nearest - 1.0 } else { nearest };
    (below, (below + INTEGERS).to_bits() & 0x7f_ffff)
}

/// Interpolates between eight numbers: the four of the near side, those of one row side by side, and the four
/// of the far side.
#[inline(always)]
fn mixed(near: Vec4, far: Vec4, f: Vec3) -> f32 {
    let square = near + (far - near) * f.x;
    let (first, second) = (Vec2::new(square.x, square.y), Vec2::new(square.z, square.w));
    let pair = first + (second - first) * f.y;
    pair.x + (pair.y - pair.x) * f.z
}

#[inline(always)]
fn difference(ahead: f32, behind: f32) -> f32 {
    if ahead < NO_DATA_BELOW || behind < NO_DATA_BELOW { 0.0 } else { ahead - behind }
}

#[cfg(test)]
mod tests;
