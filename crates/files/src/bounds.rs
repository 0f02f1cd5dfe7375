//! A survey around an interpretation without seismic data: the bounds of files, rounded outwards, on a
//! lattice of a given size.

use super::options::ImportOptions;
use super::raw::{RawShape, RawSurface};
use super::text::SourceFile;
use super::vertical::VerticalRule;
use super::{FormatError, SurfaceKind, read_raw};
use glam::{DVec2, DVec3};
use std::path::PathBuf;
use survey::geometry::{DEFAULT_VELOCITY_M_S, LineAxis, SurveyGeometry, VerticalAxis, VerticalUnit};

/// A file of an interpretation, and how it is to be read.
#[derive(Debug, Clone, PartialEq)]
pub struct InterpretationFile {
    /// The file.
    pub path: PathBuf,
    /// Horizon or fault.
    pub kind: SurfaceKind,
    /// What the user states about it.
    pub options: ImportOptions,
}

/// A box in the world: X and Y in m, vertical value positive down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Lowest X, Y and vertical value.
    pub low: DVec3,
    /// Highest X, Y and vertical value.
    pub high: DVec3,
}

impl Bounds {
    /// The bounds rounded outwards to round numbers of about a fortieth of each side, after the vertical range has been
    /// extended by 15 % at both ends (never above 0 if all values are below it), so that the outer layers have a
    /// thickness.
    ///
    /// ```
    /// # use files::Bounds;
    /// # use glam::DVec3;
    /// let bounds = Bounds { low: DVec3::new(1003.0, -7.0, 100.0), high: DVec3::new(1998.0, 996.0, 900.0) };
    /// let rounded = bounds.rounded();
    /// assert_eq!((rounded.low.x, rounded.high.x), (1000.0, 2000.0));
    /// assert_eq!((rounded.low.z, rounded.high.z), (0.0, 1020.0));
    /// ```
    pub fn rounded(&self) -> Self {
        let margin = 0.15 * (self.high.z - self.low.z);
        let mut low = self.low - DVec3::Z * margin;
        let high = self.high + DVec3::Z * margin;
        if self.low.z >= 0.0 {
            low.z = low.z.max(0.0);
        }
        let step = (high - low).max(DVec3::splat(1e-3)) / 40.0;
        let round = |value: f64, step: f64, to: fn(f64) -> f64| {
            let power = 10f64.powf(step.log10().floor());
            let nice = [5.0, 2.0, 1.0].into_iter().map(|f| f * power).find(|n| *n <= step).unwrap_or(power);
            to(value / nice) * nice
        };
        Self {
            low: DVec3::from_array([0, 1, 2].map(|n| round(low[n], step[n], f64::floor))),
            high: DVec3::from_array([0, 1, 2].map(|n| round(high[n], step[n], f64::ceil))),
        }
    }

    /// An unrotated survey that fills the bounds: inlines count along X and crosslines along Y, both from 1.
    pub fn survey(&self, size: [usize; 3], unit: VerticalUnit) -> SurveyGeometry {
        let steps = size.map(|n| (n.max(2) - 1) as f64);
        let bin = (self.high - self.low) / DVec3::from_array(steps);
        SurveyGeometry {
            inlines: LineAxis { first: 1, step: 1, count: size[0].max(2) },
            crosslines: LineAxis { first: 1, step: 1, count: size[1].max(2) },
            vertical: VerticalAxis { first: self.low.z, interval: bin.z, count: size[2].max(2), unit },
            origin: self.low.truncate(),
            inline_vector: DVec2::new(bin.x, 0.0),
            crossline_vector: DVec2::new(0.0, bin.y),
            velocity_m_s: DEFAULT_VELOCITY_M_S,
        }
    }
}

/// The bounds of files in X, Y and the vertical unit of the new survey, after conversion.
///
/// # Errors
/// [`FormatError`] when a file cannot be read or has no X, Y: line numbers alone place nothing without a survey.
pub fn bounds_of(files: &[InterpretationFile], unit: VerticalUnit) -> Result<Bounds, FormatError> {
    let mut bounds = Bounds { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY };
    for file in files {
        let (source, _, surfaces) = read_raw(&file.path, None, &file.options, file.kind)?;
        for mut raw in surfaces {
            VerticalRule::settle(&file.path, &raw.vertical, &file.options, unit)?.apply(&mut raw.shape);
            widen(&mut bounds, &raw, &source, file.kind)?;
        }
    }
    if !bounds.low.is_finite() || !bounds.high.is_finite() {
        return Err(FormatError::Empty {
            file: files.first().map(|f| f.path.clone()).unwrap_or_default(),
            kind: SurfaceKind::Horizon,
            why: "there is no point with a vertical value".into(),
        });
    }
    Ok(bounds)
}

fn widen(bounds: &mut Bounds, raw: &RawSurface, source: &SourceFile, kind: SurfaceKind) -> Result<(), FormatError> {
    let mut add = |p: DVec3| {
        if p.is_finite() {
            bounds.low = bounds.low.min(p);
            bounds.high = bounds.high.max(p);
        }
    };
    match &raw.shape {
        RawShape::Mesh(mesh) => mesh.vertices.iter().for_each(|v| add(*v)),
        RawShape::Grid { grid, z } => {
            let nv = grid.count[1];
            let node = |n: usize| grid.world_at(DVec2::new((n / nv) as f64, (n % nv) as f64));
            z.iter().enumerate().for_each(|(n, z)| add(node(n).extend(*z)));
        }
        RawShape::Points(points) => {
            if points.iter().all(|p| p.xy.is_none()) {
                return Err(
                    source.empty(kind, "it places points by line numbers alone; without a survey X and Y are needed")
                );
            }
            points.iter().filter_map(|p| Some(p.xy?.extend(p.z))).for_each(add);
        }
    }
    Ok(())
}

/// A survey of `size` around the files: their bounds, rounded outwards.
///
/// # Errors
/// As [`bounds_of`].
pub fn survey_from_points(
    files: &[InterpretationFile],
    unit: VerticalUnit,
    size: [usize; 3],
) -> Result<SurveyGeometry, FormatError> {
    Ok(bounds_of(files, unit)?.rounded().survey(size, unit))
}
