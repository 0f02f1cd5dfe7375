//! Scanning files before anything is imported: how they would be read, and why.

use super::Work;
use super::latest::Latest;
use crate::state::{Notice, Place};
use eframe::egui::Context;
use files::segy::{SegyFile, SegyInfo, SegyOptions};
use files::{ImportOptions, ImportReport};
use image::{Rgba, RgbaImage};
use state::fields;
use std::path::Path;
use std::time::{Duration, Instant};
use survey::{Progress, SurveyGeometry};
use ttf::{ColourMap, RgbaFunction};

/// Longest side of a preview, pixels.
const PREVIEW_PX: usize = 480;
/// Share of the samples that lie within the range of colours of the preview.
const SHOWN_SHARE: f32 = 0.98;

/// A survey as it would be read.
pub struct SurveyScan {
    /// What the file holds, with the evidence.
    pub info: SegyInfo,
    /// Where its traces are.
    pub geometry: SurveyGeometry,
    /// A map of the traces, several lines to a pixel, inlines to the right, crosslines down: dark where there is a live
    /// trace.
    pub traces: RgbaImage,
    /// The middle inline, crosslines to the right.
    pub inline: RgbaImage,
}

/// A horizon or fault as it would be read.
pub struct InterpretationScan {
    /// For each surface of the file its name and a report.
    pub surfaces: Vec<(String, String)>,
}

/// A file is read again when nothing has been changed in the dialogue for this long.
const PATIENCE: Duration = Duration::from_millis(250);

/// The result of reading a file with what is stated about it.
pub(crate) struct Reading<O, T> {
    /// The statements with which it was read last.
    read: Option<O>,
    /// The present statements, and since when they have been unchanged.
    stated: Option<(O, Instant)>,
    found: Latest<Result<T, Notice>>,
}

impl<O, T> Default for Reading<O, T> {
    fn default() -> Self {
        Self { read: None, stated: None, found: Latest::default() }
    }
}

impl<O: Clone + PartialEq, T: Send + 'static> Reading<O, T> {
    /// Reads the file on a thread: at once the first time, and again when the statements have stopped changing.
    pub(crate) fn follow(
        &mut self,
        ctx: &Context,
        work: &Work,
        title: &str,
        stated: &O,
        read: impl FnOnce(&Progress) -> Result<T, Notice> + Send + 'static,
    ) {
        if self.read.as_ref() == Some(stated) {
            self.stated = None;
            return;
        }
        let since = match &self.stated {
            Some((known, since)) if known == stated => *since,
            _ => {
                let now = Instant::now();
                self.stated = Some((stated.clone(), now));
                now
            }
        };
        if self.read.is_some() && since.elapsed() < PATIENCE {
            ctx.request_repaint_after(PATIENCE);
            return;
        }
        self.read = Some(stated.clone());
        let (found, number) = (self.found.clone(), self.found.begin());
        work.background(title, Place::Dialogue, move |progress, _| {
            found.stop_by(number, progress);
            found.put(number, read(progress));
            Ok(())
        });
    }

    /// Whether the file can be read with the present statements.
    pub(crate) fn is_good(&self, stated: &O) -> bool {
        let is_read = self.read.as_ref() == Some(stated) && self.found.is_current();
        is_read && self.with(|found| matches!(found, Some((_, Ok(_)))))
    }

    /// Reads the latest result and the number of its attempt.
    pub(crate) fn with<R>(&self, look: impl FnOnce(Option<(u64, &Result<T, Notice>)>) -> R) -> R {
        self.found.with(look)
    }
}

/// Scans a SEG-Y file.
///
/// # Errors
/// Why it cannot be read as a volume, for the dialogue.
pub fn survey(path: &Path, options: &SegyOptions, progress: &Progress) -> Result<SurveyScan, Notice> {
    let failed = |error: files::segy::SegyError| Notice::failure(Place::Dialogue, &error);
    let file = SegyFile::open(path, options, progress).map_err(failed)?;
    let geometry = file.geometry().map_err(failed)?;
    let inline = middle_inline(&file).map_err(failed)?;
    Ok(SurveyScan { info: file.info().clone(), geometry, traces: traces(&file), inline })
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

fn middle_inline(file: &SegyFile) -> Result<RgbaImage, files::segy::SegyError> {
    let [inlines, crosslines, samples] = file.size();
    let columns = crosslines.clamp(1, PREVIEW_PX);
    let rows = samples.clamp(1, PREVIEW_PX);
    let mut section = vec![0.0f32; columns * samples];
    for (column, trace) in section.chunks_mut(samples.max(1)).enumerate() {
        file.read_trace(inlines / 2, column * crosslines / columns, trace)?;
    }
    let clip = ttf::symmetric_clip(&section, SHOWN_SHARE).unwrap_or(1.0);
    let colours = RgbaFunction::centred(ColourMap::Grey, clip);
    Ok(RgbaImage::from_fn(columns as u32, rows as u32, |column, row| {
        let value = section[column as usize * samples + row as usize * samples / rows];
        let [r, g, b, opacity] = colours.evaluate(value).map(|channel| (channel * 255.0 + 0.5) as u8);
        // Where there are no data there is no colour.
        Rgba([r, g, b, opacity])
    }))
}

/// Scans a horizon or fault file.
///
/// # Errors
/// Why it cannot be read, for the dialogue.
pub fn horizon(path: &Path, geometry: &SurveyGeometry, options: &ImportOptions) -> Result<InterpretationScan, Notice> {
    let found =
        files::read_horizons(path, geometry, options).map_err(|error| Notice::failure(Place::Dialogue, &error))?;
    Ok(InterpretationScan {
        surfaces: found.into_iter().map(|(horizon, report)| (horizon.name, told(report))).collect(),
    })
}

/// Scans a fault file.
///
/// # Errors
/// Why it cannot be read, for the dialogue.
pub fn fault(path: &Path, geometry: &SurveyGeometry, options: &ImportOptions) -> Result<InterpretationScan, Notice> {
    let found = files::read_fault(path, geometry, options).map_err(|error| Notice::failure(Place::Dialogue, &error))?;
    Ok(InterpretationScan { surfaces: found.into_iter().map(|(fault, report)| (fault.name, told(report))).collect() })
}

/// A report whose warnings name the dialogue's fields.
fn told(mut report: ImportReport) -> String {
    for warning in &mut report.warnings {
        *warning = fields::note(warning).into();
    }
    report.to_string()
}
