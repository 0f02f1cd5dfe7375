//! The form of a folded level line: its height over the map, with slope and curvature in closed form.
//!
//! | shape | f(φ), φ = 2π c / λ |
//! |---|---|
//! | sine | cos φ |
//! | chevron | asin(k cos φ) / asin k, k < 1 rounds the hinges |
//! | box | tanh(b cos φ) / tanh b |
//! | monocline | −(1 + tanh(6 c / λ)) / 2: 0 on the left and −1 on the right |

use std::f64::consts::TAU;

/// A form, 1 on crests and −1 in troughs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Profile {
    /// Round crests and troughs.
    Sine,
    /// Straight limbs; k.
    Chevron(f64),
    /// Flat crests and steep limbs; b.
    Box(f64),
    /// One step down.
    Monocline,
}

/// Value and the first two derivatives by c.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Jet {
    pub value: f64,
    pub slope: f64,
    pub bend: f64,
}

impl Profile {
    /// How sharp the hinges of chevron and box folds are where nothing limits them.
    pub(crate) const CHEVRON: Self = Self::Chevron(0.995);
    pub(crate) const BOX: Self = Self::Box(3.0);

    /// The same form with rounder hinges, the sharpest first.
    pub(crate) fn rounder(self) -> Vec<Self> {
        match self {
            Self::Chevron(most) => [0.99, 0.98, 0.96, 0.93, 0.9, 0.85, 0.8, 0.7, 0.5, 0.3]
                .into_iter()
                .filter(|k| *k < most)
                .map(Self::Chevron)
                .collect(),
            Self::Box(most) => {
                [2.6, 2.2, 1.9, 1.6, 1.3, 1.0, 0.7, 0.4].into_iter().filter(|b| *b < most).map(Self::Box).collect()
            }
            Self::Sine | Self::Monocline => Vec::new(),
        }
    }

    /// Whether it comes back after a wavelength.
    pub(crate) fn is_periodic(self) -> bool {
        !matches!(self, Self::Monocline)
    }

    /// At a distance from the crest, for a wavelength.
    pub(crate) fn at(self, c: f64, wavelength: f64) -> Jet {
        let number = TAU / wavelength;
        let (sin, cos) = (number * c).sin_cos();
        let by_phase =
            |value: f64, slope: f64, bend: f64| Jet { value, slope: slope * number, bend: bend * number * number };
        match self {
            Self::Sine => by_phase(cos, -sin, -cos),
            Self::Chevron(k) => {
                let (scale, d) = (1.0 / k.asin(), 1.0 - (k * cos).powi(2));
                let root = d.sqrt();
                let bend = -k * cos / root + k.powi(3) * sin * sin * cos / (d * root);
                by_phase(scale * (k * cos).asin(), -scale * k * sin / root, scale * bend)
            }
            Self::Box(b) => {
                let (scale, t) = (1.0 / b.tanh(), (b * cos).tanh());
                let s = 1.0 - t * t;
                let bend = -2.0 * t * s * (b * sin).powi(2) - s * b * cos;
                by_phase(scale * t, -scale * s * b * sin, scale * bend)
            }
            Self::Monocline => {
                let rate = 6.0 / wavelength;
                let t = (rate * c).tanh();
                let s = 1.0 - t * t;
                Jet { value: -0.5 * (1.0 + t), slope: -0.5 * rate * s, bend: rate * rate * t * s }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_and_bends_are_those_of_the_values() {
        let shapes = [Profile::Sine, Profile::CHEVRON, Profile::BOX, Profile::Monocline, Profile::Chevron(0.7)];
        for shape in shapes {
            for n in -20..20 {
                let (c, h) = (37.0 * f64::from(n) + 3.0, 1e-3);
                let at = |c: f64| shape.at(c, 900.0);
                let slope = (at(c + h).value - at(c - h).value) / (2.0 * h);
                let bend = (at(c + h).slope - at(c - h).slope) / (2.0 * h);
                assert!((slope - at(c).slope).abs() < 1e-8, "{shape:?} at {c}: {slope}");
                assert!((bend - at(c).bend).abs() < 1e-7, "{shape:?} at {c}: {bend} {:?}", at(c));
            }
            if shape.is_periodic() {
                let [crest, trough] = [0.0, 450.0].map(|c| shape.at(c, 900.0).value);
                assert!((crest - 1.0).abs() < 1e-12 && (trough + 1.0).abs() < 1e-12, "{shape:?}");
            }
        }
    }
}
