//! The distances of samples of one column to one triangle of a surface.
//!
//! A triangle lies within one cell, with its corners on three of the cell's four traces. Seen from the corner
//! R between the other two, its edges are u = (1, 0, u_z) and v = (0, 1, v_z), after flipping x and y where
//! they point the other way. With w = p − R, the foot of p on the plane is s·u + t·v,
//!
//! ```text
//! s = (v·v · u·w − u·v · v·w) / D,   t = (u·u · v·w − u·v · u·w) / D,   D = 1 + u_z² + v_z²,
//! d² = (w_z − u_z w_x − v_z w_y)² / D    where s, t ≥ 0 and s + t ≤ 1,
//! ```
//!
//! and elsewhere the least distance to the three edges. The code has no branches, so that the compiler
//! vectorizes it over several samples.

/// The lesser of two numbers. Unlike `f32::min` it does not handle NaN, which does not occur here, and is one
/// instruction.
#[inline(always)]
pub(crate) fn lesser(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// The greater of two numbers; see [`lesser`].
#[inline(always)]
pub(crate) fn greater(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// A number clamped to 0 … 1.
#[inline(always)]
fn share(a: f32) -> f32 {
    lesser(greater(a, 0.0), 1.0)
}

/// Count of samples computed at once.
pub(crate) const LANES: usize = 8;

/// A triangle as stored in the index: 16 bytes.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct CellTriangle {
    /// z of the corner between the two others, of its neighbour along x, and of its neighbour along y.
    pub(crate) z: [f32; 3],
    /// Leaf id · 4 + which corner of the cell that corner is: bit 1 = far in x, bit 0 = far in y.
    pub(crate) code: u32,
}

impl CellTriangle {
    #[inline(always)]
    pub(crate) fn leaf(&self) -> u32 {
        self.code >> 2
    }

    #[inline(always)]
    pub(crate) fn z_range(&self) -> [f32; 2] {
        let [a, b, c] = self.z;
        [lesser(lesser(a, b), c), greater(greater(a, b), c)]
    }

    /// z of the corner at `far` (x, y: 0 near, 1 far), if the triangle has one there.
    #[inline(always)]
    pub(crate) fn z_at(&self, far: [u32; 2]) -> Option<f32> {
        let [x, y] = [(self.code >> 1) & 1, self.code & 1];
        match [far[0] ^ x, far[1] ^ y] {
            [0, 0] => Some(self.z[0]),
            [1, 0] => Some(self.z[1]),
            [0, 1] => Some(self.z[2]),
            _ => None,
        }
    }
}

/// A triangle seen from one column.
pub(crate) struct FromColumn {
    w: [f32; 2],
    z: f32,
    u: f32,
    v: f32,
    inverse: f32,
    inverse_u: f32,
    inverse_v: f32,
    inverse_h: f32,
}

impl FromColumn {
    /// `apart` is the column minus the near corner of the cell.
    #[inline(always)]
    pub(crate) fn new(triangle: &CellTriangle, [dx, dy]: [f32; 2]) -> Self {
        let x = if triangle.code & 2 == 0 { dx } else { 1.0 - dx };
        let y = if triangle.code & 1 == 0 { dy } else { 1.0 - dy };
        let [z, a, b] = triangle.z;
        let (u, v) = (a - z, b - z);
        // Contiguous in memory, so that the four divisions are one instruction.
        let mut inverses = [1.0 + u * u + v * v, 1.0 + u * u, 1.0 + v * v, 2.0 + (v - u) * (v - u)];
        for inverse in &mut inverses {
            *inverse = 1.0 / *inverse;
        }
        let [inverse, inverse_u, inverse_v, inverse_h] = inverses;
        Self { w: [x, y], z, u, v, inverse, inverse_u, inverse_v, inverse_h }
    }

    /// Squared distances of the samples `first`, `first` + 1, …
    #[inline(always)]
    pub(crate) fn distances_sq(&self, first: f32) -> [f32; LANES] {
        let Self { w: [x, y], u, v, inverse, inverse_u, inverse_v, inverse_h, .. } = *self;
        let h = v - u;
        let mut out = [0.0; LANES];
        for (lane, out) in out.iter_mut().enumerate() {
            let z = (first + lane as f32) - self.z;
            let (uw, vw) = (x + u * z, y + v * z);
            let s = ((1.0 + v * v) * uw - u * v * vw) * inverse;
            let t = ((1.0 + u * u) * vw - u * v * uw) * inverse;
            let off = z - u * x - v * y;
            let plane = off * off * inverse;
            let along_u = share(uw * inverse_u);
            let to_u = [x - along_u, y, z - along_u * u];
            let along_v = share(vw * inverse_v);
            let to_v = [x, y - along_v, z - along_v * v];
            let along_h = share((y - x + 1.0 + h * (z - u)) * inverse_h);
            let to_h = [x - 1.0 + along_h, y - along_h, z - u - along_h * h];
            let sq = |d: [f32; 3]| d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
            let edge = lesser(lesser(sq(to_u), sq(to_v)), sq(to_h));
            let inside = lesser(lesser(s, t), 1.0 - s - t) >= 0.0;
            *out = if inside { plane } else { edge };
        }
        out
    }
}
