//! How far a pattern on a face is from its nominal size and shape.
//!
//! Each tile has a nominal size: the block's length over the horizontal frequency, and the layer's mean thickness over
//! the vertical one. Counted in nominal metres, an undistorted pattern is a rotation of the rock. The two singular values
//! σ₁ ≥ σ₂ of the map's derivative are how many nominal metres of pattern lie on a metre of rock:
//!
//! ```text
//! aspect ratio = σ₁/σ₂        area factor = σ₁·σ₂        (both 1 where the pattern has its printed size)
//! ```

/// The largest aspect ratio that counts as calm.
pub const CALM_ASPECT: f32 = 2.0;
/// The area factor above which, or below whose inverse, a pattern counts as distorted.
pub const CALM_AREA: f32 = 2.0;

/// The singular values of the map from rock to pattern, in nominal metres of pattern for a metre of rock.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretch {
    /// Along the direction in which the pattern is densest.
    pub densest: f32,
    /// Across it.
    pub sparsest: f32,
}

impl Stretch {
    /// From the derivative `[[∂u/∂x, ∂u/∂y], [∂v/∂x, ∂v/∂y]]`, (x, y) Cartesian on the face.
    ///
    /// ```
    /// // Twice as dense along v, sheared by nothing.
    /// let stretch = ttf::Stretch::of([[1.0, 0.0], [0.0, 2.0]]);
    /// assert_eq!((stretch.aspect(), stretch.area()), (2.0, 2.0));
    /// ```
    pub fn of([[a, b], [c, d]]: [[f32; 2]; 2]) -> Self {
        let sum = 0.5 * (a + d).hypot(c - b);
        let difference = 0.5 * (a - d).hypot(c + b);
        Self { densest: sum + difference, sparsest: (sum - difference).abs() }
    }

    /// Length of an element of the pattern over its width, at least 1; infinite where it is smeared to a line.
    pub fn aspect(self) -> f32 {
        self.densest / self.sparsest
    }

    /// Elements on an area of rock over those of the nominal size.
    pub fn area(self) -> f32 {
        self.densest * self.sparsest
    }

    /// Whether the aspect ratio is at most 2 and the area factor in [½, 2].
    pub fn is_calm(self) -> bool {
        self.aspect() <= CALM_ASPECT && (1.0 / CALM_AREA..=CALM_AREA).contains(&self.area())
    }

    /// 1 for a pattern of its nominal size, ½ at the limit of what is calm, 0 where it is smeared to a line: the inverse of
    /// the aspect ratio, the area factor or its inverse, whichever is the least.
    ///
    /// ```
    /// // A layer of its nominal thickness, seen at an angle of 30°.
    /// assert_eq!(ttf::Stretch::of([[1.0, 0.0], [0.0, 0.5]]).calmness(), 0.5);
    /// assert_eq!(ttf::Stretch::of([[0.0, 0.0], [0.0, 1.0]]).calmness(), 0.0);
    /// ```
    pub fn calmness(self) -> f32 {
        let area = self.area();
        if self.densest > 0.0 && area > 0.0 && area.is_finite() {
            (self.sparsest / self.densest).min(area).min(1.0 / area)
        } else {
            0.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn singular_values_are_those_of_known_maps() {
        let (sin, cos) = 0.7f32.sin_cos();
        // A rotation after a stretch by 3 and ½.
        let stretch = Stretch::of([[3.0 * cos, -0.5 * sin], [3.0 * sin, 0.5 * cos]]);
        assert!((stretch.densest - 3.0).abs() < 1e-5 && (stretch.sparsest - 0.5).abs() < 1e-5, "{stretch:?}");
        // A shear by γ keeps areas; σ₁ = (γ + √(γ² + 4))/2.
        let stretch = Stretch::of([[1.0, 0.8], [0.0, 1.0]]);
        assert!((stretch.densest - 0.5 * (0.8 + 4.64f32.sqrt())).abs() < 1e-5);
        assert!((stretch.area() - 1.0).abs() < 1e-5);
        // A mirrored map is as calm as its image.
        assert_eq!(Stretch::of([[-1.0, 0.0], [0.0, 1.0]]), Stretch { densest: 1.0, sparsest: 1.0 });
        assert!(!Stretch::of([[1.0, 1.0], [1.0, 1.0]]).is_calm(), "smeared to lines");
    }

    #[test]
    fn half_the_calmness_is_the_limit_of_what_is_calm() {
        for [densest, sparsest] in [[1.0, 0.5], [1.0, 1.0], [2.0, 1.0], [0.8, 0.7], [3.0, 2.0], [0.6, 0.5], [1.2, 0.7]]
        {
            let stretch = Stretch { densest, sparsest };
            assert_eq!(stretch.is_calm(), stretch.calmness() >= 0.5, "{stretch:?}");
            let inverse = Stretch { densest: 1.0 / sparsest, sparsest: 1.0 / densest };
            assert!((stretch.calmness() - inverse.calmness()).abs() < 1e-6, "{stretch:?}");
        }
        for bad in [0.0, f32::NAN, f32::INFINITY] {
            assert_eq!(Stretch { densest: bad, sparsest: bad }.calmness(), 0.0);
        }
    }
}
