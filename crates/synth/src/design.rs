//! Chooses the parameters of the model: folds, faults, beds and named horizons that fit a volume of any
//! shape.
//!
//! Depths are fractions of the volume's depth D; wavelengths of folds are fractions of L = min(width, 2·D),
//! and amplitudes follow from slopes, so that dips in metric space are the same at any size. The seed turns
//! directions and phases, shifts faults a little and draws beds.

use super::column::BedSequence;
use super::faulting::{Tip, TruthFault};
use super::fold::{FoldedBeds, Undulation, Wave};
use super::random::Draws;
use super::shapes::Diapir;
use super::truth::{Sequence, SynthTruth, TruthHorizon};
use super::{SynthError, SynthSettings};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// Named horizons above the unconformity, youngest first, and their depths as fractions of D.
const YOUNG_HORIZONS: [(&str, f64); 3] = [("Alpha", 0.20), ("Bravo", 0.31), ("Unconformity", UNCONFORMITY)];

/// Depth of the unconformity as a fraction of D.
const UNCONFORMITY: f64 = 0.43;

/// Depth of the first named horizon below the unconformity, in largest reliefs of the old beds: the crests of
/// its folds are eroded, its troughs are whole.
const CHARLIE_BELOW: f64 = 0.6;

/// From there to the last named horizon, a fraction of D.
const DELTA_BELOW: f64 = 0.17;

/// Reflectors need this many samples in a wavelength to be seen.
const MIN_WAVELENGTH_SAMPLES: f64 = 4.0;

/// Wavelengths that the depth must hold for all named horizons to be distinct reflectors.
const WAVELENGTHS_IN_DEPTH: f64 = 12.0;

/// Fewest inlines and crosslines: folds and heaves must span a few traces.
const MIN_LINES: usize = 24;

/// A wave of `slope` (relief) or `amplitude` (thickening) in a direction, with a random phase and a little
/// turned.
struct WaveDesign {
    /// Fraction of L.
    wavelength: f64,
    /// Angle of the wave vector from u, degrees.
    direction_deg: f64,
    /// Largest slope (relief) or fraction (thickening).
    strength: f64,
}

/// The waves of the old beds' relief: the first one alone dips 37.6°.
const OLD_RELIEF: [WaveDesign; 3] = [
    WaveDesign { wavelength: 0.54, direction_deg: 18.0, strength: 0.77 },
    WaveDesign { wavelength: 0.80, direction_deg: -62.0, strength: 0.16 },
    WaveDesign { wavelength: 0.31, direction_deg: 74.0, strength: 0.07 },
];

/// The waves of the young beds' relief.
const YOUNG_RELIEF: [WaveDesign; 2] = [
    WaveDesign { wavelength: 0.90, direction_deg: 40.0, strength: 0.10 },
    WaveDesign { wavelength: 0.55, direction_deg: -35.0, strength: 0.07 },
];

/// Thickening of the old beds.
const OLD_THICKENING: [WaveDesign; 2] = [
    WaveDesign { wavelength: 1.10, direction_deg: 10.0, strength: 0.15 },
    WaveDesign { wavelength: 0.75, direction_deg: 100.0, strength: 0.09 },
];

/// Thickening of the young beds.
const YOUNG_THICKENING: [WaveDesign; 1] = [WaveDesign { wavelength: 1.00, direction_deg: 65.0, strength: 0.20 }];

/// Parameters of the model for given settings.
pub(super) fn design(settings: &SynthSettings) -> Result<SynthTruth, SynthError> {
    let [nx, ny, nz] = settings.size;
    let least = (WAVELENGTHS_IN_DEPTH * MIN_WAVELENGTH_SAMPLES) as usize;
    if nx < MIN_LINES || ny < MIN_LINES || nz < least {
        return Err(SynthError::TooSmall { size: settings.size, least: [MIN_LINES, MIN_LINES, least] });
    }
    let step_m = DVec3::new(settings.bin_m, settings.bin_m, settings.sample_m());
    let extent = DVec3::new((nx - 1) as f64, (ny - 1) as f64, (nz - 1) as f64) * step_m;
    let scale = extent.x.min(extent.y).min(2.0 * extent.z);
    let wavelength_m = (settings.wavelength_samples * step_m.z).min(extent.z / WAVELENGTHS_IN_DEPTH);

    let mut draws = Draws::new(settings.seed, 1);
    let mut waves = |designs: &[WaveDesign], relief: UndulationMeasure| Undulation {
        waves: designs.iter().map(|design| wave(design, relief, scale, &mut draws)).collect(),
    };
    let at = |fraction: f64| fraction * extent.z;
    let base_m = at(UNCONFORMITY);
    let young_beds = FoldedBeds {
        pivot_m: base_m,
        relief: waves(&YOUNG_RELIEF, UndulationMeasure::Metres),
        thickening: waves(&YOUNG_THICKENING, UndulationMeasure::Fraction),
    };
    let old_beds = FoldedBeds {
        pivot_m: at(0.62),
        relief: waves(&OLD_RELIEF, UndulationMeasure::Metres),
        thickening: waves(&OLD_THICKENING, UndulationMeasure::Fraction),
    };

    let mut beds = Draws::new(settings.seed, 2);
    let young_trend = |s: f64| 5.0e6 + 1.0e6 * s / extent.z;
    let old_trend = |s: f64| 6.3e6 + 1.3e6 * s / extent.z;
    let young_column = BedSequence::laid(base_m, at(-0.6), wavelength_m, young_trend, &mut beds);
    let old_column = BedSequence::laid(at(-0.3), at(1.9), wavelength_m, old_trend, &mut beds);
    let charlie_m = base_m + CHARLIE_BELOW * old_beds.relief.bound();
    let named = |name: &str, sequence, column: &BedSequence, strat_m: f64| TruthHorizon {
        name: name.to_owned(),
        sequence,
        strat_m: column.reflectors_m[column.nearest(strat_m)],
    };
    let young = YOUNG_HORIZONS.iter().map(|&(name, depth)| named(name, Sequence::Young, &young_column, at(depth)));
    let old = [("Charlie", charlie_m), ("Delta", charlie_m + at(DELTA_BELOW))];
    let old = old.iter().map(|&(name, strat_m)| named(name, Sequence::Old, &old_column, strat_m));
    let horizons = young.chain(old).collect();
    Ok(SynthTruth {
        size: settings.size,
        step_m,
        wavelength_m,
        young_beds,
        old_beds,
        young_column,
        old_column,
        faults: faults(extent, &mut Draws::new(settings.seed, 3)),
        horizons,
        unconformity: YOUNG_HORIZONS.len() - 1,
        salt: settings.salt.then(|| Diapir::of_extent(extent)),
    })
}

/// What an undulation measures.
#[derive(Clone, Copy)]
enum UndulationMeasure {
    /// Metres; the strength is a slope.
    Metres,
    /// A fraction of the thickness; the strength is the amplitude.
    Fraction,
}

/// One wave, its direction turned by up to 8° and its phase drawn.
fn wave(design: &WaveDesign, relief: UndulationMeasure, scale: f64, draws: &mut Draws) -> Wave {
    let angle = (design.direction_deg + draws.between(-8.0, 8.0)).to_radians();
    let number = TAU / (design.wavelength * scale);
    let amplitude = match relief {
        UndulationMeasure::Metres => design.strength / number,
        UndulationMeasure::Fraction => design.strength,
    };
    Wave { amplitude, wave_vector: DVec2::from_angle(angle) * number, phase: draws.between(0.0, TAU) }
}

/// A normal fault, one that dies out and a reverse fault, from low to high u; they do not meet inside the
/// volume.
fn faults(extent: DVec3, draws: &mut Draws) -> Vec<TruthFault> {
    struct FaultDesign {
        name: &'static str,
        position: f64,
        strike: f64,
        bow: f64,
        dip_deg: f64,
        most_run: f64,
        throw: f64,
        tip: Option<[f64; 2]>,
    }
    let designs = [
        FaultDesign {
            name: "Normal fault",
            position: 0.21,
            strike: 0.10,
            bow: 0.05,
            dip_deg: 62.0,
            most_run: 0.20,
            throw: 0.075,
            tip: None,
        },
        FaultDesign {
            name: "Dying fault",
            position: 0.46,
            strike: 0.06,
            bow: -0.03,
            dip_deg: 65.0,
            most_run: 0.18,
            throw: 0.06,
            tip: Some([0.25, 0.68]),
        },
        FaultDesign {
            name: "Reverse fault",
            position: 0.75,
            strike: -0.05,
            bow: 0.04,
            dip_deg: 45.0,
            most_run: 0.29,
            throw: -0.07,
            tip: None,
        },
    ];
    let reach_m = 0.28 * extent.x.min(2.5 * extent.z);
    let mut built = Vec::with_capacity(designs.len());
    for design in designs {
        // A volume that is deep for its width gets steeper faults, so that they leave through the bottom.
        let run = (1.0 / design.dip_deg.to_radians().tan()).min(design.most_run * extent.x / extent.z);
        built.push(TruthFault {
            name: design.name.to_owned(),
            position_m: (design.position + draws.between(-0.015, 0.015)) * extent.x,
            middle_m: DVec2::new(0.5 * extent.y, 0.5 * extent.z),
            strike: design.strike * extent.x / extent.y,
            bow: design.bow * 4.0 * extent.x / extent.y.powi(2),
            run,
            listric: 0.2 * run / extent.z,
            throw_m: design.throw * extent.z,
            reach_m,
            tip: design.tip.map(|[full, end]| Tip { full_until_m: full * extent.y, end_m: end * extent.y }),
        });
    }
    built
}
