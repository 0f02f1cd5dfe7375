//! The description of a horizon or fault file before its import.

use super::options::ImportOptions;
use super::raw::{RawShape, RawSurface};
use super::report::Settled;
use super::text::SourceFile;
use super::unit::ZPositive;
use super::{Format, FormatError, SurfaceKind, read_source};
use glam::DVec2;
use serde::Serialize;
use std::path::{Path, PathBuf};
use survey::remedy::{Note, Setting};

/// Columns and rows of the map of characters.
const MAP: [usize; 2] = [56, 20];
/// Bars of the histogram.
const BARS: usize = 12;
/// Characters from shallow to deep.
const SHADES: [char; 8] = ['.', ':', '-', '=', '+', '*', '%', '#'];

/// The content of a file.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FileDescription {
    /// The file.
    pub file: PathBuf,
    /// Its length in bytes.
    pub bytes: usize,
    /// Its format, with the evidence.
    pub format: Settled<Format>,
    /// The kind of surface that it was read as.
    pub kind: SurfaceKind,
    /// Its surfaces.
    pub surfaces: Vec<SurfaceDescription>,
}

/// A surface of a file, with its numbers as in the file.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SurfaceDescription {
    /// Its name there.
    pub name: Option<String>,
    /// "grid of 75 x 125 nodes, …", "9375 points", "625 vertices, 1152 triangles".
    pub shape: String,
    /// Values, holes included.
    pub values: usize,
    /// Holes.
    pub nulls: usize,
    /// Lowest and highest X, if there are any.
    pub x: Option<[f64; 2]>,
    /// Lowest and highest Y.
    pub y: Option<[f64; 2]>,
    /// Lowest and highest inline.
    pub inlines: Option<[f64; 2]>,
    /// Lowest and highest crossline.
    pub crosslines: Option<[f64; 2]>,
    /// Lowest and highest value.
    pub range: Option<[f64; 2]>,
    /// The vertical unit and its source.
    pub unit: Note,
    /// The sign and its source.
    pub positive: Note,
    /// Counts of values in equal parts of the range.
    pub histogram: Vec<usize>,
    /// A map, north up (inlines upward without X, Y): shallow to deep `. : - = + * % #`.
    pub map: Vec<String>,
    /// Further facts.
    pub notes: Vec<String>,
    /// What should be checked.
    pub warnings: Vec<Note>,
}

impl SurfaceDescription {
    /// Every note whose remedy a user interface may reword.
    pub fn notes_mut(&mut self) -> impl Iterator<Item = &mut Note> {
        [&mut self.unit, &mut self.positive].into_iter().chain(&mut self.warnings)
    }
}

/// Describes a file as a horizon, or as a fault when it holds no horizon.
///
/// # Errors
/// [`FormatError`] when the format is not recognised or the file is broken.
pub fn describe(path: &Path, options: &ImportOptions) -> Result<FileDescription, FormatError> {
    let source = SourceFile::open(path)?;
    let bytes = source.bytes.len();
    let as_kind = |kind| read_source(&source, None, options, kind);
    let (kind, (format, surfaces)) = match as_kind(SurfaceKind::Horizon) {
        Ok(found) => (SurfaceKind::Horizon, found),
        Err(error) => match as_kind(SurfaceKind::Fault) {
            Ok(found) => (SurfaceKind::Fault, found),
            Err(_) => return Err(error),
        },
    };
    let surfaces = surfaces.iter().map(surface).collect();
    Ok(FileDescription { file: path.to_owned(), bytes, format, kind, surfaces })
}

/// The positions and values: (X, Y or inline, crossline), value.
fn places(shape: &RawShape) -> (Vec<(DVec2, f64)>, &'static str) {
    match shape {
        RawShape::Grid { grid, z } => {
            let nv = grid.count[1];
            let place = |n: usize| grid.world_at(DVec2::new((n / nv) as f64, (n % nv) as f64));
            (z.iter().enumerate().map(|(n, z)| (place(n), *z)).collect(), "xy")
        }
        RawShape::Mesh(mesh) => (mesh.vertices.iter().map(|v| (v.truncate(), v.z)).collect(), "xy"),
        RawShape::Points(points) if points.iter().all(|p| p.xy.is_some()) => {
            (points.iter().filter_map(|p| Some((p.xy?, p.z))).collect(), "xy")
        }
        RawShape::Points(points) => {
            // Inlines upward, crosslines to the right.
            (points.iter().filter_map(|p| p.lines.map(|l| (DVec2::new(l.y, l.x), p.z))).collect(), "lines")
        }
    }
}

fn range(values: impl Iterator<Item = f64>) -> Option<[f64; 2]> {
    let none = [f64::INFINITY, f64::NEG_INFINITY];
    let found = values.filter(|v| v.is_finite()).fold(none, |r, v| [r[0].min(v), r[1].max(v)]);
    (found[0] <= found[1]).then_some(found)
}

fn surface(raw: &RawSurface) -> SurfaceDescription {
    let (places, by) = places(&raw.shape);
    let shape = match &raw.shape {
        RawShape::Grid { grid, .. } => {
            let (u, v) = (grid.u_step, grid.v_step);
            let mirrored = if u.perp_dot(v) < 0.0 { ", mirrored" } else { "" };
            format!(
                "grid of {} x {} nodes, {:.4} x {:.4} m, rotated {:.4} degrees{mirrored}",
                grid.count[0],
                grid.count[1],
                u.length(),
                v.length(),
                u.to_angle().to_degrees()
            )
        }
        RawShape::Points(points) => {
            let mut sticks: Vec<u64> = points.iter().filter_map(|p| p.stick).map(f64::to_bits).collect();
            sticks.sort_unstable();
            sticks.dedup();
            match sticks.len() {
                0 => format!("{} points", points.len()),
                n => format!("{} points in {n} parts", points.len()),
            }
        }
        RawShape::Mesh(mesh) => format!("{} vertices, {} triangles", mesh.vertices.len(), mesh.triangles.len()),
    };
    let values: Vec<f64> = raw.shape.values().collect();
    let nulls = values.iter().filter(|v| !v.is_finite()).count();
    let found = range(values.iter().copied());
    let lines = |of: fn(&DVec2) -> f64| match &raw.shape {
        RawShape::Points(points) => range(points.iter().filter_map(|p| p.lines).map(|l| of(&l))),
        RawShape::Grid { .. } | RawShape::Mesh(_) => None,
    };
    let xy = |of: fn(&DVec2) -> f64| if by == "xy" { range(places.iter().map(|(p, _)| of(p))) } else { None };
    let says = |words: Option<&String>| words.map_or_else(String::new, |w| format!(" (the file says {w})"));
    let facts = &raw.vertical;
    let unit = match (&facts.unit, &facts.domain) {
        (Some((unit, words)), _) => Note::from(format!("{}{}", unit.symbol(), says(Some(words)))),
        (None, Some((domain, words))) => format!("{domain:?}{}; which unit is not said", says(Some(words))).into(),
        (None, None) => Note::unless("not said; the survey's is assumed on import", Setting::ZUnit.stated()),
    };
    let positive = match &facts.positive {
        Some((positive, words)) => Note::from(format!("{}{}", positive.word(), says(Some(words)))),
        None => match found {
            Some([_, high]) if high <= 0.0 => {
                let fact = "not said; all values are negative, so probably up, but down is assumed on import";
                Note::unless(fact, Setting::ZPositive.stated_as(ZPositive::Up.word()))
            }
            _ => Note::unless("not said; down is assumed on import", Setting::ZPositive.stated()),
        },
    };
    SurfaceDescription {
        name: raw.name.clone(),
        shape,
        values: values.len(),
        nulls,
        x: xy(|p| p.x),
        y: xy(|p| p.y),
        inlines: lines(|l| l.x),
        crosslines: lines(|l| l.y),
        range: found,
        unit,
        positive,
        histogram: found.map_or_else(Vec::new, |r| histogram(&values, r)),
        map: map(&places, found),
        notes: raw.notes.clone(),
        warnings: raw.warnings.clone(),
    }
}

fn histogram(values: &[f64], [low, high]: [f64; 2]) -> Vec<usize> {
    let mut bars = vec![0; BARS];
    for v in values.iter().filter(|v| v.is_finite()) {
        let share = if high > low { (v - low) / (high - low) } else { 0.0 };
        bars[((share * BARS as f64) as usize).min(BARS - 1)] += 1;
    }
    bars
}

/// The mean value of each character cell as a shade; a character is about twice as high as it is wide.
fn map(places: &[(DVec2, f64)], range: Option<[f64; 2]>) -> Vec<String> {
    let Some([shallow, deep]) = range else { return Vec::new() };
    let known: Vec<(DVec2, f64)> = places.iter().copied().filter(|(p, z)| p.is_finite() && z.is_finite()).collect();
    let low = known.iter().map(|(p, _)| *p).fold(DVec2::INFINITY, DVec2::min);
    let size = known.iter().map(|(p, _)| *p).fold(DVec2::NEG_INFINITY, DVec2::max) - low;
    if !(size.is_finite() && size.max_element() > 0.0) {
        return Vec::new();
    }
    let wide = (size.x / MAP[0] as f64).max(size.y / (2.0 * MAP[1] as f64)).max(f64::MIN_POSITIVE);
    let cell = DVec2::new(wide, 2.0 * wide);
    let count = [(size.x / cell.x) as usize + 1, (size.y / cell.y) as usize + 1];
    let mut sums = vec![(0.0, 0usize); count[0] * count[1]];
    for (p, z) in &known {
        let at = (*p - low) / cell;
        let slot = &mut sums[(at.y as usize).min(count[1] - 1) * count[0] + (at.x as usize).min(count[0] - 1)];
        *slot = (slot.0 + z, slot.1 + 1);
    }
    let shade = |(sum, count): &(f64, usize)| {
        if *count == 0 {
            return ' ';
        }
        let share = if deep > shallow { (sum / *count as f64 - shallow) / (deep - shallow) } else { 0.0 };
        SHADES[((share * SHADES.len() as f64) as usize).min(SHADES.len() - 1)]
    };
    let row = |cells: &[(f64, usize)]| cells.iter().map(shade).collect::<String>().trim_end().to_string();
    sums.chunks(count[0]).rev().map(row).collect()
}
