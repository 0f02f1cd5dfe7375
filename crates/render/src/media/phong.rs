//! Phong's reflection model on an isosurface, two-sided: `ambient + diffuse·|n·l|` multiplies the colour, and
//! `specular·|n·h|^shininess` of white is added.

use super::Phong;
use super::samples::BATCH;
use glam::Vec3;

/// The reflection model for the points of one ray.
#[derive(Clone, Copy)]
pub(super) struct Lit {
    phong: Phong,
    light: Vec3,
    half: Vec3,
}

/// Many surface points under the same light, component by component.
pub(super) struct LitSurfaces {
    /// Their normals, of any length, in display space.
    pub normals: [[f32; BATCH]; 3],
    /// The [`half_way`] directions of their rays.
    pub halves: [[f32; BATCH]; 3],
    /// Result: the factor on their colour.
    pub factor: [f32; BATCH],
    /// Result: the white that is added.
    pub white: [f32; BATCH],
}

/// The direction half-way between those to the light and to the viewer.
pub(super) fn half_way(light: Vec3, towards: Vec3) -> Vec3 {
    (light + towards).normalize_or_zero()
}

impl Lit {
    /// The model for these unit directions to the light and to the viewer, in display space.
    pub(super) fn new(phong: Phong, light: Vec3, towards: Vec3) -> Self {
        Self { phong, light, half: half_way(light, towards) }
    }

    /// Shades a colour on a surface with this normal, of any length, in display space.
    pub(super) fn on(&self, normal: Vec3, colour: Vec3) -> Vec3 {
        let [diffuse, specular] = cosines(normal.to_array(), self.light.to_array(), self.half.to_array());
        let mut specular = [specular];
        raise(&mut specular, self.phong.shininess);
        colour * (self.phong.ambient + self.phong.diffuse * diffuse) + Vec3::splat(self.phong.specular * specular[0])
    }
}

impl LitSurfaces {
    /// An empty batch.
    pub(super) fn new() -> Self {
        Self { normals: [[0.0; BATCH]; 3], halves: [[0.0; BATCH]; 3], factor: [0.0; BATCH], white: [0.0; BATCH] }
    }

    /// Shades all of them.
    #[inline(always)]
    pub(super) fn light(&mut self, phong: &Phong, light: Vec3) {
        let light = light.to_array();
        let [x, y, z] = &self.normals;
        let [hx, hy, hz] = &self.halves;
        for n in 0..BATCH {
            let [diffuse, specular] = cosines([x[n], y[n], z[n]], light, [hx[n], hy[n], hz[n]]);
            self.factor[n] = phong.ambient + phong.diffuse * diffuse;
            self.white[n] = specular;
        }
        raise(&mut self.white, phong.shininess);
        for white in &mut self.white {
            *white *= phong.specular;
        }
    }
}

/// |n·l| and |n·h| for the normalised normal; 0 if it has no length.
#[inline(always)]
fn cosines(normal: [f32; 3], light: [f32; 3], half: [f32; 3]) -> [f32; 2] {
    let dot = |a: [f32; 3], b: [f32; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let length_sq = dot(normal, normal);
    let inverse = if length_sq > 1e-24 { 1.0 / length_sq.sqrt() } else { 0.0 };
    [dot(normal, light).abs() * inverse, dot(normal, half).abs() * inverse]
}

/// Raises numbers to a power: by squaring if the exponent is an integer, as it usually is.
#[inline(always)]
fn raise<const N: usize>(numbers: &mut [f32; N], exponent: f32) {
    let mut left = exponent as u32;
    if left as f32 != exponent {
        numbers.iter_mut().for_each(|number| *number = number.powf(exponent));
        return;
    }
    let mut squares = *numbers;
    *numbers = [1.0; N];
    while left > 0 {
        for (number, square) in numbers.iter_mut().zip(&mut squares) {
            *number *= if left & 1 == 1 { *square } else { 1.0 };
            *square *= *square;
        }
        left >>= 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_are_those_of_the_library() {
        for exponent in [0.0f32, 1.0, 2.5, 20.0, 333.0] {
            let numbers = [0.0f32, 0.3, 0.97, 1.0];
            let mut powers = numbers;
            raise(&mut powers, exponent);
            for (x, power) in numbers.into_iter().zip(powers) {
                assert!((power - x.powf(exponent)).abs() < 1e-5, "{x} {exponent}");
            }
        }
    }

    #[test]
    fn many_surfaces_are_lit_as_each_is() {
        let phong = Phong { shininess: 7.0, ..Phong::default() };
        let (light, mut surfaces) = (Vec3::new(0.6, 0.0, 0.8), LitSurfaces::new());
        let vector = |n: usize| Vec3::new((n as f32).sin(), (n as f32 * 1.7).cos(), (n as f32 * 0.3).sin());
        for n in 0..BATCH {
            // The first has no normal.
            let (normal, half) = (vector(n) * n as f32, half_way(light, vector(n + 9).normalize()));
            (0..3).for_each(|axis| surfaces.normals[axis][n] = normal[axis]);
            (0..3).for_each(|axis| surfaces.halves[axis][n] = half[axis]);
        }
        surfaces.light(&phong, light);
        for n in 0..BATCH {
            let one = Lit::new(phong, light, vector(n + 9).normalize()).on(vector(n) * n as f32, Vec3::X);
            assert_eq!([one.x, one.y], [surfaces.factor[n] + surfaces.white[n], surfaces.white[n]], "{n}");
        }
    }

    #[test]
    fn a_surface_is_brightest_facing_the_light_from_either_side() {
        let phong = Phong { ambient: 0.1, diffuse: 0.6, specular: 0.3, shininess: 20.0, ..Phong::default() };
        let lit = Lit::new(phong, Vec3::Z, Vec3::Z);
        for normal in [Vec3::Z * 5.0, Vec3::NEG_Z * 0.01] {
            assert!((lit.on(normal, Vec3::X) - Vec3::new(1.0, 0.3, 0.3)).abs().max_element() < 1e-5);
        }
        assert_eq!(lit.on(Vec3::X, Vec3::Y), Vec3::Y * 0.1);
        assert_eq!(lit.on(Vec3::ZERO, Vec3::Y), Vec3::Y * 0.1);
    }
}
