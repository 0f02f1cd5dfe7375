//! Phong's light on a surface of equal value, two-sided: `ambient + diffuse·|n·l|` on the colour, and `specular·|n·h|^shininess` of white.

use super::Phong;
use glam::Vec3;

/// The light on what one ray meets.
#[derive(Clone, Copy)]
pub struct Lit {
    phong: Phong,
    light: Vec3,
    half: Vec3,
}

impl Lit {
    /// Directions to the light and to the viewer, unit, in display space.
    pub fn new(phong: Phong, light: Vec3, towards: Vec3) -> Self {
        Self { phong, light, half: (light + towards).normalize_or_zero() }
    }

    /// A colour under it, on a surface with this normal of any length, in display space.
    #[inline(always)]
    pub fn on(&self, normal: Vec3, colour: Vec3) -> Vec3 {
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
