//! A map of the live traces in characters, north up, which shows the outline of a survey and its gaps.
//!
//! A character is twice as tall as it is wide. Points spread over each character are looked up in the
//! lattice.

use glam::{DMat2, DVec2};

use super::file::SegyFile;
use super::info::{SegyInfo, in_figures};

/// Characters across and down, at most.
const SIZE: [f64; 2] = [64.0, 24.0];

/// Points sampled in a character, across and down.
const POINTS: [usize; 2] = [6, 12];

/// What is at a point of the map.
#[derive(Clone, Copy, PartialEq)]
enum Found {
    Nothing,
    Missing,
    Dead,
    Live,
}

/// What the characters mean.
pub(super) const LEGEND: &str = "█ live  ▓▒░ partly live  × dead  · no trace";

impl SegyFile {
    /// Lines of the map; none for a file without an area.
    pub(super) fn live_map(&self) -> Vec<String> {
        let info = self.info();
        let g = &info.geometry;
        let origin = DVec2::from(g.origin);
        let linear = DMat2::from_cols(g.inline_vector.into(), g.crossline_vector.into());
        let size = [info.inlines.count, info.crosslines.count];
        let area = linear.determinant().abs();
        if self.places() < 2 || area.is_nan() || area == 0.0 {
            return Vec::new();
        }
        // Corners of the outermost bins, not of the outermost traces.
        let [nx, ny] = size.map(|count| count as f64 - 0.5);
        let outline =
            [[-0.5, -0.5], [-0.5, ny], [nx, ny], [nx, -0.5]].map(|index| origin + linear * DVec2::from(index));
        let low = outline.into_iter().fold(DVec2::INFINITY, DVec2::min);
        let high = outline.into_iter().fold(DVec2::NEG_INFINITY, DVec2::max);
        let extent = high - low;
        let width = (extent.x / SIZE[0]).max(extent.y / (2.0 * SIZE[1]));
        let cell = DVec2::new(width, 2.0 * width);
        let [columns, rows] = [extent.x / cell.x, extent.y / cell.y].map(|n| (n - 1e-6).ceil().max(1.0) as usize);
        if width.is_nan() || width <= 0.0 || columns > 200 || rows > 100 {
            return Vec::new();
        }
        let index_from_world = linear.inverse();
        let found_at = |world: DVec2| {
            let index = (index_from_world * (world - origin)).round();
            let is_inside = |at: f64, count: usize| at >= 0.0 && at < count as f64;
            if !is_inside(index.x, size[0]) || !is_inside(index.y, size[1]) {
                return Found::Nothing;
            }
            let (x, y) = (index.x as usize, index.y as usize);
            match self.trace_at(x, y) {
                None => Found::Missing,
                Some(_) if self.is_live(x, y) => Found::Live,
                Some(_) => Found::Dead,
            }
        };
        let mut lines: Vec<Vec<char>> = (0..rows)
            .map(|row| {
                let character = |column: usize| {
                    let corner = DVec2::new(low.x + column as f64 * cell.x, high.y - row as f64 * cell.y);
                    let points = (0..POINTS[0] * POINTS[1]).map(|k| {
                        let at = [k % POINTS[0], k / POINTS[0]];
                        let share = |axis: usize| (at[axis] as f64 + 0.5) / POINTS[axis] as f64;
                        found_at(corner + cell * DVec2::new(share(0), -share(1)))
                    });
                    character_of(&points.collect::<Vec<_>>())
                };
                (0..columns).map(character).collect()
            })
            .collect();
        for (letter, corner) in ('A'..).zip(&info.corners) {
            let at = (DVec2::new(corner.x, corner.y) - DVec2::new(low.x, high.y)) / (cell * DVec2::new(1.0, -1.0));
            let (column, row) = ((at.x as usize).min(columns - 1), (at.y as usize).min(rows - 1));
            lines[row][column] = letter;
        }
        lines.into_iter().map(|line| line.into_iter().collect::<String>().trim_end().to_owned()).collect()
    }
}

fn character_of(points: &[Found]) -> char {
    let count = |wanted: Found| points.iter().filter(|&&found| found == wanted).count();
    let (live, dead, missing) = (count(Found::Live), count(Found::Dead), count(Found::Missing));
    let inside = live + dead + missing;
    match live {
        _ if inside == 0 => ' ',
        0 if dead > missing => '×',
        0 => '·',
        _ if live == inside => '█',
        _ if live * 3 > inside * 2 => '▓',
        _ if live * 3 > inside => '▒',
        _ => '░',
    }
}

/// Length of a bin's sides, area, and where lines run to: clauses about the place of a survey.
pub(super) fn place_in_words(info: &SegyInfo) -> Vec<String> {
    let unit = info.coordinate_unit;
    let [a, b] = [info.geometry.inline_vector, info.geometry.crossline_vector].map(DVec2::from);
    let azimuth = |v: DVec2| (v.x.atan2(v.y).to_degrees() + 360.0) % 360.0;
    let bins = (info.inlines.count * info.crosslines.count - info.missing_traces) as f64;
    let area_km2 = a.perp_dot(b).abs() * unit.metres() * unit.metres() * bins / 1e6;
    let mut words = vec![format!(
        "bins of {} by {} {} (between inlines, between crosslines), {} km² with traces",
        in_figures(a.length()),
        in_figures(b.length()),
        unit.symbol(),
        in_figures(area_km2)
    )];
    words.push(format!(
        "crosslines count up towards {:.1}°, inlines towards {:.1}° (from north, clockwise): {} on the map",
        azimuth(b * f64::from(info.crosslines.step.signum())),
        azimuth(a * f64::from(info.inlines.step.signum())),
        if a.perp_dot(b) > 0.0 { "anticlockwise" } else { "clockwise" }
    ));
    words
}
