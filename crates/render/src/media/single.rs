//! A ray through one volume and nothing else: the case that has to be quick.
//!
//! What [`super::field::Field::at`] finds at a sample, with all that is the same along a ray done once. In the volume's own indices a ray is
//! i(n) = a + n·d; over a stretch inside one brick, a few samples, i is carried in fixed point with 16 binary places (off by less than 10⁻³ of a voxel at its
//! end), whose upper bits are the cell and whose lower bits are the weights: no rounding calls, no conversions of each coordinate. Where a
//! neighbour of a sample could be missing, at the volume's borders, the general way is taken.
//!
//! Gradients are central differences over one sample, interpolated: along each axis the difference of the two outer planes of the 4 × 4 × 4 neighbourhood, taken
//! from the same cell.

use super::field::{Field, FieldMedium, Place};
use super::table::NO_DATA_BELOW;
use super::{Phong, Shading};
use crate::visible::Ray;
use glam::{Mat3, Vec3};

/// Binary places of a position.
const PLACES: u32 = 16;
/// One voxel.
const ONE: f32 = (1 << PLACES) as f32;

/// What is the same along a ray.
pub struct Single<'f> {
    medium: &'f FieldMedium<'f>,
    values: &'f [f32],
    /// Samples to the next along x and along y.
    strides: [usize; 2],
    last: Vec3,
    /// Index at t = 0, and per voxel of t.
    index: Vec3,
    per_t: Vec3,
    lit: Option<Lit>,
}

/// Phong's light on a ray.
struct Lit {
    phong: Phong,
    /// Gradient in samples → normal in display space.
    normal: Mat3,
    light: Vec3,
    half: Vec3,
}

/// A visible sample.
pub struct Seen {
    /// Extinction per unit of length.
    pub extinction: f32,
    /// Linear colour, lit.
    pub colour: Vec3,
}

/// A place in fixed point.
#[derive(Clone, Copy)]
pub struct Position([i32; 3]);

impl<'f> Single<'f> {
    /// The one medium of a place; `None` where there is more to ask than a volume.
    pub fn of(field: &'f Field, place: Place, ray: &Ray, towards: Vec3) -> Option<Self> {
        let medium = field.plain(place)?;
        let size = medium.volume.volume.size();
        if size.iter().any(|&n| !(4..1 << (31 - PLACES)).contains(&n)) {
            return None;
        }
        let (scale, offset) = medium.volume.index_from_voxel();
        let lit = match field.shading {
            Shading::Phong(phong) => Some(Lit {
                phong,
                normal: field.display_normal_from_voxel * Mat3::from_diagonal(scale * 0.5),
                light: field.light,
                half: (field.light + towards).normalize_or_zero(),
            }),
            _ => None,
        };
        Some(Self {
            medium,
            values: medium.samples(),
            strides: [size[1] * size[2], size[2]],
            last: Vec3::from_array(size.map(|n| (n - 1) as f32)),
            index: ray.origin * scale + offset,
            per_t: ray.direction * scale,
            lit,
        })
    }

    /// The positions of samples from `t` on, `step` apart; `None` where one of `count` may lack a neighbour.
    #[inline(always)]
    pub fn positions(&self, t: f32, step: f32, count: u32) -> Option<(Position, Position)> {
        let start = self.index + self.per_t * t;
        let stride = self.per_t * step;
        let end = start + stride * count as f32;
        // Gradients reach one sample further.
        let free = if self.lit.is_some() { 1.01 } else { 0.01 };
        let inside = start.min(end).cmpge(Vec3::splat(free)).all() && start.max(end).cmple(self.last - free).all();
        let fixed = |v: Vec3| Position([(v.x * ONE) as i32, (v.y * ONE) as i32, (v.z * ONE) as i32]);
        inside.then(|| (fixed(start), fixed(stride)))
    }

    /// What shows at a place; `None` for nothing.
    #[inline(always)]
    pub fn at(&self, position: Position) -> Option<Seen> {
        const FRACTION: i32 = (1 << PLACES) - 1;
        let Position([x, y, z]) = position;
        let weight = |v: i32| (v & FRACTION) as f32 * (1.0 / ONE);
        let f = [weight(x), weight(y), weight(z)];
        let [dx, dy] = self.strides;
        let cell = (x >> PLACES) as usize * dx + (y >> PLACES) as usize * dy + (z >> PLACES) as usize;
        let value = self.trilinear(cell, f);
        if value < NO_DATA_BELOW {
            return None;
        }
        let table = &self.medium.table;
        let entry = table.index(value);
        let extinction = table.extinctions[entry];
        if extinction <= 0.0 {
            return None;
        }
        let mut colour = match table.uniform {
            Some(colour) => Vec3::from_array(colour),
            None => Vec3::from_slice(&table.entries[entry]),
        };
        if let Some(lit) = &self.lit {
            colour = lit.on(self.differences(cell, f), colour);
        }
        Some(Seen { extinction, colour })
    }

    #[inline(always)]
    fn pair(&self, at: usize) -> [f32; 2] {
        let pair = &self.values[at..at + 2];
        [pair[0], pair[1]]
    }

    #[inline(always)]
    fn trilinear(&self, cell: usize, [fx, fy, fz]: [f32; 3]) -> f32 {
        let [dx, dy] = self.strides;
        let along_z = |at: usize| {
            let [low, high] = self.pair(at);
            low + (high - low) * fz
        };
        let (a, b) = (along_z(cell), along_z(cell + dy));
        let (c, d) = (along_z(cell + dx), along_z(cell + dx + dy));
        let (near, far) = (a + (b - a) * fy, c + (d - c) * fy);
        near + (far - near) * fx
    }

    /// Twice the gradient per sample; zero along an axis where a neighbour is missing.
    #[inline(always)]
    fn differences(&self, cell: usize, f: [f32; 3]) -> Vec3 {
        let [dx, dy] = self.strides;
        let along = |step: usize| {
            let (ahead, behind) = (self.trilinear(cell + step, f), self.trilinear(cell - step, f));
            if ahead < NO_DATA_BELOW || behind < NO_DATA_BELOW { 0.0 } else { ahead - behind }
        };
        Vec3::new(along(dx), along(dy), along(1))
    }
}

impl Lit {
    #[inline(always)]
    fn on(&self, differences: Vec3, colour: Vec3) -> Vec3 {
        let normal = self.normal * differences;
        let length_sq = normal.length_squared();
        let normal = if length_sq > 1e-24 { normal * length_sq.sqrt().recip() } else { Vec3::ZERO };
        let diffuse = self.phong.diffuse * normal.dot(self.light).abs();
        let specular = self.phong.specular * power(normal.dot(self.half).abs(), self.phong.shininess);
        colour * (self.phong.ambient + diffuse) + Vec3::splat(specular)
    }
}

/// x to a power: by squaring where the exponent is a whole number, as it mostly is.
#[inline(always)]
fn power(x: f32, exponent: f32) -> f32 {
    let mut left = exponent as u32;
    if left as f32 != exponent {
        return x.powf(exponent);
    }
    let (mut product, mut square) = (1.0, x);
    while left > 0 {
        if left & 1 == 1 {
            product *= square;
        }
        square *= square;
        left >>= 1;
    }
    product
}

impl Position {
    /// The next place.
    #[inline(always)]
    pub fn plus(self, Self(stride): Self) -> Self {
        let Self([x, y, z]) = self;
        Self([x + stride[0], y + stride[1], z + stride[2]])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_are_those_of_the_library() {
        for exponent in [0.0f32, 1.0, 2.5, 20.0, 333.0] {
            for x in [0.0f32, 0.3, 0.97, 1.0] {
                assert!((power(x, exponent) - x.powf(exponent)).abs() < 1e-5, "{x} {exponent}");
            }
        }
    }
}
