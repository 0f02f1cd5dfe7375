//! Folds: a stack of beds bent by a sum of plane waves, invertible in closed form.
//!
//! A bed that was laid down at stratigraphic depth s lies, before faulting, at
//!
//! `depth(s, u, v) = s + A(u, v) + (s − s₀)·B(u, v)`
//!
//! with the relief A (metres) and the thickening B (a fraction, |B| < 1), both sums of sines of different
//! wavelength and direction. It is linear in s, hence `s = (depth − A + s₀·B)/(1 + B)`; the thickness of a
//! bed varies by 1 + B. u, v and all depths are metric.

use glam::DVec2;
use serde::{Deserialize, Serialize};

/// One plane wave, `amplitude · sin(wave_vector · (u, v) + phase)`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Wave {
    /// Half the crest-to-trough height, m for relief, a fraction for thickening.
    pub amplitude: f64,
    /// 2π/wavelength along the direction of the wave, 1/m.
    pub wave_vector: DVec2,
    /// Phase at (u, v) = 0, radians.
    pub phase: f64,
}

/// A sum of plane waves.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Undulation {
    /// The waves that add up.
    pub waves: Vec<Wave>,
}

impl Undulation {
    /// Value at metric (u, v).
    pub fn at(&self, place: DVec2) -> f64 {
        self.waves.iter().map(|w| w.amplitude * (w.wave_vector.dot(place) + w.phase).sin()).sum()
    }

    /// (∂/∂u, ∂/∂v) at metric (u, v).
    pub(crate) fn gradient_at(&self, place: DVec2) -> DVec2 {
        self.waves.iter().map(|w| w.wave_vector * (w.amplitude * (w.wave_vector.dot(place) + w.phase).cos())).sum()
    }

    /// The largest magnitude it can have.
    pub fn bound(&self) -> f64 {
        self.waves.iter().map(|w| w.amplitude.abs()).sum()
    }
}

/// Beds folded together: everything on one side of the unconformity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FoldedBeds {
    /// s₀: the stratigraphic depth at which thickening moves nothing, m.
    pub pivot_m: f64,
    /// A, m.
    pub relief: Undulation,
    /// B, a fraction of the thickness.
    pub thickening: Undulation,
}

impl FoldedBeds {
    /// Depth before faulting of the bed at stratigraphic depth `strat_m`, m.
    pub fn depth_m(&self, strat_m: f64, place: DVec2) -> f64 {
        strat_m + self.relief.at(place) + (strat_m - self.pivot_m) * self.thickening.at(place)
    }

    /// Stratigraphic depth of what lies at `depth_m` before faulting, m: the inverse of
    /// [`FoldedBeds::depth_m`].
    pub(crate) fn strat_m(&self, depth_m: f64, place: DVec2) -> f64 {
        let thickening = self.thickening.at(place);
        (depth_m - self.relief.at(place) + self.pivot_m * thickening) / (1.0 + thickening)
    }

    /// Slope (∂depth/∂u, ∂depth/∂v) of the bed at `strat_m`, metres a metre.
    pub fn slope(&self, strat_m: f64, place: DVec2) -> DVec2 {
        self.relief.gradient_at(place) + self.thickening.gradient_at(place) * (strat_m - self.pivot_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn beds() -> FoldedBeds {
        let wave = |amplitude, u, v, phase| Wave { amplitude, wave_vector: DVec2::new(u, v), phase };
        FoldedBeds {
            pivot_m: 700.0,
            relief: Undulation { waves: vec![wave(100.0, 0.004, 0.001, 0.3), wave(20.0, -0.002, 0.006, 1.0)] },
            thickening: Undulation { waves: vec![wave(0.3, 0.002, 0.002, 2.0)] },
        }
    }

    #[test]
    fn depth_and_stratigraphic_depth_invert() {
        let beds = beds();
        for (s, place) in [(400.0, DVec2::new(10.0, 900.0)), (1200.0, DVec2::new(1500.0, 2.0))] {
            assert!((beds.strat_m(beds.depth_m(s, place), place) - s).abs() < 1e-9);
        }
    }

    #[test]
    fn the_slope_is_the_derivative() {
        let beds = beds();
        let (s, place, step) = (900.0, DVec2::new(321.0, 654.0), 1e-3);
        let numeric = |d: DVec2| (beds.depth_m(s, place + d * step) - beds.depth_m(s, place - d * step)) / (2.0 * step);
        assert!((beds.slope(s, place) - DVec2::new(numeric(DVec2::X), numeric(DVec2::Y))).length() < 1e-6);
    }
}
