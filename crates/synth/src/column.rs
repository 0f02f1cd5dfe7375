//! The stratigraphic column: where the reflectors are and what the beds between them are made of.
//!
//! Reflectivity is that of acoustic impedance Z at normal incidence, `r = (Z_below − Z_above)/(Z_below +
//! Z_above)`; beds alternate between soft and hard, so polarity alternates. A wavelength is 1/f of the Ricker
//! wavelet's peak frequency f.

use super::random::Draws;
use serde::{Deserialize, Serialize};

/// Spacing of reflectors in wavelengths where beds have their mean thickness. With beds between 1/4 thinner
/// and 1/4 thicker than that, neighbours are one to two wavelengths apart.
const SPACING: [f64; 2] = [1.36, 1.58];

/// Half the relative difference in impedance between a soft and a hard bed.
const CONTRAST: [f64; 2] = [0.05, 0.10];

/// Beds of one sequence, top to bottom.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BedSequence {
    /// Stratigraphic depths of the reflectors, m, increasing.
    pub reflectors_m: Vec<f64>,
    /// Acoustic impedance of the beds, kg/(m²·s): bed i lies above reflector i, the last below all.
    pub impedance: Vec<f64>,
}

impl BedSequence {
    /// Lays beds from `first_m` on, downwards to beyond `last_m` or, when that is smaller, upwards; the bed
    /// before the first reflector is soft. `trend` gives the mean impedance at a stratigraphic depth.
    pub(super) fn laid(
        first_m: f64,
        last_m: f64,
        wavelength_m: f64,
        trend: impl Fn(f64) -> f64,
        draws: &mut Draws,
    ) -> Self {
        let downwards = last_m > first_m;
        let mut reflectors_m = vec![first_m];
        let mut reached = first_m;
        while (downwards && reached < last_m) || (!downwards && reached > last_m) {
            let step = wavelength_m * draws.between(SPACING[0], SPACING[1]);
            reached += if downwards { step } else { -step };
            reflectors_m.push(reached);
        }
        // Bed 0 touches the first reflector on the side where laying began; the others follow in the
        // direction of laying.
        let mut impedance = Vec::with_capacity(reflectors_m.len() + 1);
        for bed in 0..=reflectors_m.len() {
            let strat_m = reflectors_m[bed.saturating_sub(1)];
            let contrast = draws.between(CONTRAST[0], CONTRAST[1]);
            let sign = if bed % 2 == usize::from(downwards) { 1.0 } else { -1.0 };
            impedance.push(trend(strat_m) * (1.0 + sign * contrast));
        }
        if !downwards {
            reflectors_m.reverse();
            impedance.reverse();
        }
        Self { reflectors_m, impedance }
    }

    /// Index of the reflector closest to a stratigraphic depth.
    pub(super) fn nearest(&self, strat_m: f64) -> usize {
        let distance = |i: &usize| (self.reflectors_m[*i] - strat_m).abs();
        (0..self.reflectors_m.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0)
    }

    /// Impedance of the bed at a stratigraphic depth.
    pub(super) fn impedance_at(&self, strat_m: f64) -> f64 {
        self.impedance[self.reflectors_m.partition_point(|&r| r <= strat_m)]
    }

    /// Reflectivity of reflector `index`.
    pub(super) fn reflectivity(&self, index: usize) -> f64 {
        reflectivity(self.impedance[index], self.impedance[index + 1])
    }
}

/// Normal-incidence reflectivity from the impedance above to that below.
pub(super) fn reflectivity(above: f64, below: f64) -> f64 {
    (below - above) / (below + above)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polarity_alternates_and_spacing_holds_in_both_directions() {
        for (first, last) in [(500.0, 1400.0), (500.0, -300.0)] {
            let column = BedSequence::laid(first, last, 80.0, |s| 5e6 + 1e3 * s, &mut Draws::new(1, 2));
            assert_eq!(column.impedance.len(), column.reflectors_m.len() + 1);
            assert!(column.reflectors_m.contains(&first));
            for i in 1..column.reflectors_m.len() {
                let spacing = (column.reflectors_m[i] - column.reflectors_m[i - 1]) / 80.0;
                assert!((SPACING[0]..SPACING[1]).contains(&spacing), "{spacing}");
                assert!(column.reflectivity(i - 1) * column.reflectivity(i) < 0.0);
            }
        }
    }

    #[test]
    fn beds_lie_above_their_reflector() {
        let column = BedSequence { reflectors_m: vec![10.0, 20.0], impedance: vec![1.0, 2.0, 3.0] };
        assert_eq!([5.0, 10.0, 19.0, 21.0].map(|s| column.impedance_at(s)), [1.0, 2.0, 2.0, 3.0]);
        assert_eq!(column.nearest(17.0), 1);
        assert!((column.reflectivity(0) - 1.0 / 3.0).abs() < 1e-12);
    }
}
