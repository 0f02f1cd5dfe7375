//! A synthetic survey whose truth is known exactly. It has folds, an angular unconformity, a normal, a
//! reverse and a dying-out fault, seismic with noise, and an acoustic impedance volume of another size and a
//! smaller extent (P-illus 5.1).
//!
//! | part | where |
//! |---|---|
//! | closed form of beds, faults, blocks | [`SynthTruth`], [`FoldedBeds`], [`TruthFault`] |
//! | parameters for a size and a seed | `design` |
//! | convolutional seismic, noise, impedance | `seismic` |
//! | horizons and faults an exact interpreter would pick | `interpretation` |
//! | small models with exact k for tests | [`closed_form`] |
//!
//! The result depends on the settings alone: it is the same, byte for byte, on any number of threads.
//!
//! [`SynthDesign`] makes a survey of any size a few inlines at a time, [`Synthetic`] one in memory.
//!
//! Deliberately absent: files.

pub mod closed_form;
mod column;
mod design;
pub mod elliptic;
mod events;
mod faulting;
mod fold;
mod interpretation;
mod outcrop;
mod random;
mod seismic;
pub mod shapes;
#[cfg(test)]
mod tests;
mod truth;

pub use column::BedSequence;
pub use events::{Reflector, ReflectorEvent};
pub use faulting::{Tip, TruthFault};
pub use fold::{FoldedBeds, Undulation, Wave};
pub use outcrop::{OutcropFault, OutcropTruth, Overturned};
pub use seismic::SeismicLines;
pub use truth::{Sequence, SynthTruth, TruthHorizon};

use glam::{DVec2, DVec3};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::ops::Range;
use survey::fault::Fault;
use survey::geometry::{DEFAULT_VELOCITY_M_S, GeometryError, LineAxis, SurveyGeometry, VerticalUnit};
use survey::horizon::Horizon;
use survey::progress::{Cancelled, Progress};
use survey::stratigraphy::Stratigraphy;
use survey::volume::Volume;

/// The settings of a synthetic survey.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct SynthSettings {
    /// `[inlines, crosslines, samples]`; default 128 × 128 × 128, at least 24 × 24 × 48.
    pub size: [usize; 3],
    /// Seed of the random numbers that choose directions, phases, beds and noise; default 1.
    pub seed: u64,
    /// RMS signal / RMS noise; `None` for no noise. Default 4.
    pub snr: Option<f64>,
    /// Distance between lines, m; default 25.
    pub bin_m: f64,
    /// Unit of the vertical axis; default metres, because a block diagram then needs no velocity.
    pub vertical: VerticalUnit,
    /// Distance between samples in that unit; default 10, for a volume 2.5 times as wide as deep.
    pub interval: f64,
    /// Wavelength of the wavelet, 1/f of its peak frequency, samples; default 8. It is shortened where the
    /// volume's depth holds fewer than twelve wavelengths.
    pub wavelength_samples: f64,
    /// Whether a dome of salt with an overhang pierces the beds; default not.
    pub salt: bool,
}

impl Default for SynthSettings {
    fn default() -> Self {
        Self {
            size: [128; 3],
            seed: 1,
            snr: Some(4.0),
            bin_m: 25.0,
            vertical: VerticalUnit::Metres,
            interval: 10.0,
            wavelength_samples: 8.0,
            salt: false,
        }
    }
}

impl SynthSettings {
    /// Metres between samples.
    fn sample_m(&self) -> f64 {
        match self.vertical {
            VerticalUnit::Metres => self.interval,
            VerticalUnit::Milliseconds => self.interval * DEFAULT_VELOCITY_M_S / 2000.0,
        }
    }
}

/// Memory that is needed for each voxel of a survey in memory: the volume and the attribute.
const BYTES_A_VOXEL: usize = 5;

/// Why a synthetic survey could not be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SynthError {
    /// Too few lines or samples.
    #[error("a synthetic survey of {size:?} is too small for its folds and faults; ask for at least {least:?}")]
    TooSmall {
        /// The size that was asked for.
        size: [usize; 3],
        /// The smallest possible size.
        least: [usize; 3],
    },
    /// The volumes do not fit into memory.
    #[error(transparent)]
    Memory(#[from] system::memory::NotEnough),
    /// A setting is not a positive number.
    #[error("{what} must be a positive number, found {found}")]
    NotPositive {
        /// Which setting.
        what: &'static str,
        /// Its value.
        found: f64,
    },
    /// The lattice cannot be used.
    #[error(transparent)]
    Geometry(#[from] GeometryError),
    /// Stopped by the user.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// An attribute volume on a lattice of its own inside the survey.
#[derive(Debug, Clone, PartialEq)]
pub struct Attribute {
    /// Acoustic impedance, kg/(m²·s).
    pub volume: Volume<f32>,
    /// Its lattice in the world.
    pub geometry: SurveyGeometry,
    /// Seismic voxel of its first sample.
    pub origin: DVec3,
    /// Seismic voxels from its first to its last sample along each axis.
    pub extent: DVec3,
}

/// A synthetic survey in memory: 4 bytes per voxel of the seismic and 4 per voxel of the attribute.
///
/// # Examples
/// ```
/// use survey::progress::Progress;
/// use synth::{SynthSettings, Synthetic};
///
/// let settings = SynthSettings { size: [24, 24, 48], snr: None, ..SynthSettings::default() };
/// let made = Synthetic::generate(&settings, &Progress::silent())?;
/// assert_eq!(made.seismic.size(), [24, 24, 48]);
/// // A normal, a reverse and a dying-out fault; the horizons are those of the stratigraphy.
/// assert_eq!(made.faults.len(), 3);
/// assert_eq!(made.horizons.len(), made.stratigraphy.horizons.len());
/// // The same settings give the same samples.
/// assert_eq!(made.seismic, Synthetic::generate(&settings, &Progress::silent())?.seismic);
/// # Ok::<(), synth::SynthError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Synthetic {
    /// The lattice of the seismic.
    pub geometry: SurveyGeometry,
    /// Seismic amplitudes; SEG normal polarity: more impedance below is a positive peak.
    pub seismic: Volume<f32>,
    /// Acoustic impedance of a part of the survey, on every second line.
    pub attribute: Attribute,
    /// Age order and contacts of the horizons.
    pub stratigraphy: Stratigraphy,
    /// Horizons, youngest first, with one sheet for each block in which the horizon exists.
    pub horizons: Vec<Horizon>,
    /// The faults, up to their tips.
    pub faults: Vec<Fault>,
    /// The closed form that everything was made from.
    pub truth: SynthTruth,
}

impl Synthetic {
    /// Makes the survey.
    ///
    /// # Errors
    /// [`SynthError`] when the size is too small, a setting makes no sense or the user cancelled.
    pub fn generate(settings: &SynthSettings, progress: &Progress) -> Result<Self, SynthError> {
        let design = SynthDesign::new(settings)?;
        system::memory::check("the synthetic survey", &settings.size, BYTES_A_VOXEL)?;
        let size = settings.size;
        let mut seismic = Volume::filled(size, 0.0f32);
        let mut lines = design.seismic(progress)?;
        progress.begin("synthetic seismic", size[0] as u64);
        for range in seismic::blocks(size[0], lines.together()) {
            progress.step(range.len() as u64)?;
            let line = size[1] * size[2];
            let made = lines.lines(range.clone());
            seismic.samples_mut()[range.start * line..range.end * line].copy_from_slice(&made);
        }
        drop(lines);
        let inlines = design.attribute.geometry.size()[0];
        progress.begin("acoustic impedance", inlines as u64);
        let impedance = (0..inlines).map(|x| progress.step(1).map(|()| design.impedance(x..x + 1)));
        let samples = impedance.collect::<Result<Vec<_>, Cancelled>>()?.concat();
        let AttributePlace { geometry, origin, extent } = design.attribute.clone();
        let volume = Volume::from_samples(geometry.size(), samples).unwrap_or_else(|_| unreachable!("all its lines"));
        Ok(Self {
            attribute: Attribute { volume, geometry, origin, extent },
            stratigraphy: design.stratigraphy(),
            horizons: design.horizons().collect(),
            faults: design.faults(),
            geometry: design.geometry,
            seismic,
            truth: design.truth,
        })
    }
}

/// Where the attribute volume lies.
#[derive(Debug, Clone, PartialEq)]
pub struct AttributePlace {
    /// Its lattice in the world.
    pub geometry: SurveyGeometry,
    /// Seismic voxel of its first sample.
    pub origin: DVec3,
    /// Seismic voxels from its first to its last sample along each axis.
    pub extent: DVec3,
}

/// A synthetic survey of any size: all that is known of it, and its samples a few inlines at a time.
///
/// ```
/// use survey::progress::Progress;
/// use synth::{SynthDesign, SynthSettings, Synthetic};
///
/// let settings = SynthSettings { size: [24, 24, 48], ..SynthSettings::default() };
/// let design = SynthDesign::new(&settings)?;
/// let lines = design.seismic(&Progress::silent())?.lines(7..9);
/// let whole = Synthetic::generate(&settings, &Progress::silent())?;
/// assert_eq!(lines[..], whole.seismic.samples()[7 * 24 * 48..9 * 24 * 48]);
/// # Ok::<(), synth::SynthError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct SynthDesign {
    /// The lattice of the seismic.
    pub geometry: SurveyGeometry,
    /// Where the acoustic impedance lies.
    pub attribute: AttributePlace,
    /// The closed form that everything is made from.
    pub truth: SynthTruth,
    snr: Option<f64>,
    seed: u64,
}

impl SynthDesign {
    /// Designs the survey.
    ///
    /// # Errors
    /// [`SynthError`] when the size is too small or a setting makes no sense.
    pub fn new(settings: &SynthSettings) -> Result<Self, SynthError> {
        let positive = [
            ("the distance between lines", settings.bin_m),
            ("the sample interval", settings.interval),
            ("the wavelength in samples", settings.wavelength_samples),
            ("the signal-to-noise ratio", settings.snr.unwrap_or(1.0)),
        ];
        for (what, found) in positive {
            if !(found > 0.0 && found.is_finite()) {
                return Err(SynthError::NotPositive { what, found });
            }
        }
        let geometry = lattice(settings);
        geometry.validate()?;
        let truth = design::design(settings)?;
        let attribute = attribute_place(&truth, &geometry);
        Ok(Self { geometry, attribute, truth, snr: settings.snr, seed: settings.seed })
    }

    /// Seismic amplitudes; SEG normal polarity: more impedance below is a positive peak.
    ///
    /// # Errors
    /// [`Cancelled`], while the level of the noise is measured.
    pub fn seismic(&self, progress: &Progress) -> Result<SeismicLines<'_>, Cancelled> {
        SeismicLines::new(&self.truth, self.snr, self.seed, progress)
    }

    /// Acoustic impedance, kg/(m²·s), of some inlines of its lattice.
    pub fn impedance(&self, inlines: Range<usize>) -> Vec<f32> {
        let [_, crosslines, samples] = self.attribute.geometry.size();
        let voxel_at = |p: DVec3| self.attribute.origin + p * ATTRIBUTE_STEP;
        let line = |x: usize| seismic::impedance(&self.truth, [crosslines, samples], ATTRIBUTE_STEP.z, voxel_at, x);
        inlines.into_par_iter().map(line).collect::<Vec<_>>().concat()
    }

    /// Age order and contacts of the horizons.
    pub fn stratigraphy(&self) -> Stratigraphy {
        interpretation::stratigraphy(&self.truth)
    }

    /// Horizons, youngest first, each made when it is asked for.
    pub fn horizons(&self) -> impl Iterator<Item = Horizon> + '_ {
        let layered = 0..self.truth.horizons.len();
        let layered = layered.map(|h| interpretation::horizon(&self.truth, &self.geometry, h));
        layered.chain(interpretation::salt(&self.truth, &self.geometry))
    }

    /// The faults, up to their tips.
    pub fn faults(&self) -> Vec<Fault> {
        interpretation::faults(&self.truth, &self.geometry)
    }
}

/// The survey's lattice: unrotated, away from the world's origin, lines numbered from 101 and 501.
fn lattice(settings: &SynthSettings) -> SurveyGeometry {
    let mut geometry = SurveyGeometry::regular(settings.size, settings.bin_m, settings.interval, settings.vertical);
    geometry.origin = DVec2::new(430_000.0, 6_780_000.0);
    geometry.inlines.first = 101;
    geometry.crosslines.first = 501;
    geometry
}

/// Seismic voxels between neighbouring samples of the attribute.
const ATTRIBUTE_STEP: DVec3 = DVec3::new(2.0, 2.0, 0.75);

/// Every second line, three quarters of the sample interval, over the middle of the survey.
fn attribute_place(truth: &SynthTruth, survey: &SurveyGeometry) -> AttributePlace {
    let origin = DVec3::from_array([0, 1, 2].map(|axis| ([0.2, 0.15, 0.1][axis] * truth.size[axis] as f64).floor()));
    let step = ATTRIBUTE_STEP;
    let size = [0, 1, 2].map(|axis| {
        let span = [0.65, 0.6, 0.7][axis] * truth.size[axis] as f64;
        (span / step[axis]).floor() as usize
    });
    let extent = DVec3::from_array(size.map(|count| count as f64 - 1.0)) * step;
    let first = survey.world_from_voxel(origin);
    let lines = |axis: LineAxis, at: f64, every: f64, count: usize| LineAxis {
        first: axis.number_at(at).round() as i32,
        step: axis.step * every as i32,
        count,
    };
    let mut geometry = survey.clone();
    geometry.inlines = lines(survey.inlines, origin.x, step.x, size[0]);
    geometry.crosslines = lines(survey.crosslines, origin.y, step.y, size[1]);
    geometry.origin = first.truncate();
    geometry.inline_vector *= step.x;
    geometry.crossline_vector *= step.y;
    geometry.vertical.first = first.z;
    geometry.vertical.interval *= step.z;
    geometry.vertical.count = size[2];
    AttributePlace { geometry, origin, extent }
}
