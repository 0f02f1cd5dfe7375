//! Looking into files before anything is imported: how they would be read, and why.

use crate::app::fields;
use crate::app::state::{Notice, Place};
use image::{Rgba, RgbaImage};
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};
use survey::formats::{self, ImportOptions, ImportReport};
use survey::segy::{SegyFile, SegyInfo, SegyOptions};
use survey::{Progress, SurveyGeometry};
use ttf::{ColourMap, RgbaFunction};

/// Longest side of a preview, pixels.
const PREVIEW_PX: usize = 480;
/// Share of the samples that the preview shows unclipped.
const SHOWN_SHARE: f32 = 0.98;

/// A survey as it would be read.
pub struct SurveyScan {
    /// What the file holds, with the evidence.
    pub info: SegyInfo,
    /// Where its traces are.
    pub geometry: SurveyGeometry,
    /// A pixel for so many traces, inlines to the right, crosslines down: dark where there is a live one.
    pub traces: RgbaImage,
    /// The middle inline, crosslines to the right.
    pub inline: RgbaImage,
}

/// A horizon or fault as it would be read.
pub struct InterpretationScan {
    /// Name and what was found, for each surface of the file.
    pub surfaces: Vec<(String, String)>,
}

/// What the last look into a file found; a newer look replaces it.
pub struct Found<T> {
    slot: Arc<Mutex<Look<T>>>,
}

/// The number of the latest look, and what was found last.
type Look<T> = (u64, Option<Result<T, Notice>>);

impl<T> Clone for Found<T> {
    fn clone(&self) -> Self {
        Self { slot: self.slot.clone() }
    }
}

impl<T> Default for Found<T> {
    fn default() -> Self {
        Self { slot: Arc::new(Mutex::new((0, None))) }
    }
}

impl<T> Found<T> {
    /// Begins another look; what is found is put in under its number.
    pub fn begin(&self) -> u64 {
        let mut slot = self.slot.lock().unwrap_or_else(PoisonError::into_inner);
        slot.0 += 1;
        slot.0
    }

    /// Puts in what was found, unless another look has begun.
    pub fn put(&self, number: u64, found: Result<T, Notice>) {
        let mut slot = self.slot.lock().unwrap_or_else(PoisonError::into_inner);
        if slot.0 == number {
            slot.1 = Some(found);
        }
    }

    /// Looks at what was found last.
    pub fn with<R>(&self, look: impl FnOnce(Option<&Result<T, Notice>>) -> R) -> R {
        look(self.slot.lock().unwrap_or_else(PoisonError::into_inner).1.as_ref())
    }
}

/// Looks into a SEG-Y file.
///
/// # Errors
/// Why it cannot be read as a volume, for the dialogue.
pub fn survey(path: &Path, options: &SegyOptions, progress: &Progress) -> Result<SurveyScan, Notice> {
    let failed = |error: survey::segy::SegyError| Notice::failure(Place::Dialogue, &error);
    let file = SegyFile::open(path, options, progress).map_err(failed)?;
    let geometry = file.geometry().map_err(failed)?;
    Ok(SurveyScan { info: file.info().clone(), geometry, traces: traces(&file), inline: middle_inline(&file) })
}

fn traces(file: &SegyFile) -> RgbaImage {
    let [inlines, crosslines, _] = file.size();
    let [width, height] = [inlines, crosslines].map(|count| count.clamp(1, PREVIEW_PX));
    RgbaImage::from_fn(width as u32, height as u32, |column, row| {
        let x = column as usize * inlines / width;
        let y = row as usize * crosslines / height;
        if file.is_live(x, y) { Rgba([0x5b, 0x67, 0x70, 255]) } else { Rgba([0, 0, 0, 26]) }
    })
}

fn middle_inline(file: &SegyFile) -> RgbaImage {
    let [inlines, crosslines, samples] = file.size();
    let columns = crosslines.clamp(1, PREVIEW_PX);
    let rows = samples.clamp(1, PREVIEW_PX);
    let mut section = vec![0.0f32; columns * samples];
    for (column, trace) in section.chunks_mut(samples.max(1)).enumerate() {
        file.read_trace(inlines / 2, column * crosslines / columns, trace);
    }
    let clip = ttf::symmetric_clip(&section, SHOWN_SHARE).unwrap_or(1.0);
    let colours = RgbaFunction::centred(ColourMap::Grey, clip);
    RgbaImage::from_fn(columns as u32, rows as u32, |column, row| {
        let value = section[column as usize * samples + row as usize * samples / rows];
        let [r, g, b, _] = colours.evaluate(value).map(|channel| (channel * 255.0 + 0.5) as u8);
        Rgba([r, g, b, 255])
    })
}

/// Looks into a horizon or fault file.
///
/// # Errors
/// Why it cannot be read, for the dialogue.
pub fn horizon(path: &Path, geometry: &SurveyGeometry, options: &ImportOptions) -> Result<InterpretationScan, Notice> {
    let found =
        formats::read_horizons(path, geometry, options).map_err(|error| Notice::failure(Place::Dialogue, &error))?;
    Ok(InterpretationScan {
        surfaces: found.into_iter().map(|(horizon, report)| (horizon.name, told(report))).collect(),
    })
}

/// Looks into a fault file.
///
/// # Errors
/// Why it cannot be read, for the dialogue.
pub fn fault(path: &Path, geometry: &SurveyGeometry, options: &ImportOptions) -> Result<InterpretationScan, Notice> {
    let found =
        formats::read_fault(path, geometry, options).map_err(|error| Notice::failure(Place::Dialogue, &error))?;
    Ok(InterpretationScan {
        surfaces: found.into_iter().map(|(fault, report)| (fault.name, told(report))).collect(),
    })
}

/// A report whose warnings name the dialogue's fields.
fn told(mut report: ImportReport) -> String {
    for warning in &mut report.warnings {
        *warning = fields::note(warning).into();
    }
    report.to_string()
}
