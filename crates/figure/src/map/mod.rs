//! A horizon, or the thickness between two, as a map: values at the survey's traces and contours of round
//! values.
//!
//! Contours are those of a lightly smoothed surface (`smooth`), colours those of the values themselves.
//! Where a fault cuts the horizon off there is a line, and between the two lines of a normal fault there is nothing.
//! What was not picked, but filled or extrapolated, is hatched; where there is no model yet, holes are.

mod contours;
mod cuts;
mod ends;
mod grid;
mod hatch;
mod smooth;

pub use cuts::FaultCut;

use crate::interpretation::DrawnInterpretation;
use glam::DVec2;
use grid::Grid;
use image::{Rgba, RgbaImage};
use model::StructuralModel;
use survey::SurveyGeometry;
use ttf::{Colour, ColourMap, RgbaFunction};

/// Pixels from trace to trace, so that rims of faults are no stairs: as many as keep the longer side at about this, but no
/// more than the second.
const FINE_SIDE: usize = 1200;
const MOST_FINE: usize = 5;

/// What is mapped, by indices of horizons, youngest first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mapped {
    /// Its depth or time.
    Structure(usize),
    /// Vertical thickness from one down to a deeper one.
    Thickness(usize, usize),
}

impl Mapped {
    /// Whether there is such a thing among so many horizons.
    pub(crate) fn is_among(self, count: usize) -> bool {
        match self {
            Self::Structure(horizon) => horizon < count,
            Self::Thickness(upper, lower) => upper < lower && lower < count,
        }
    }
}

/// What a map is made from.
#[derive(Clone, Copy)]
pub enum MapSource<'a> {
    /// The model.
    Model(&'a StructuralModel),
    /// The horizons as they were picked, without a model.
    Sheets(&'a DrawnInterpretation<'a>),
}

/// A contour.
#[derive(Debug, Clone, PartialEq)]
pub struct Contour {
    /// Its places, voxel x and y; one that goes around ends where it begins.
    pub line: Vec<DVec2>,
    /// Its value, in the survey's unit.
    pub value: f64,
    /// Whether it is an index contour.
    pub is_index: bool,
}

/// A horizon or a thickness as a map.
#[derive(Debug, Clone, PartialEq)]
pub struct HorizonMap {
    /// Of what.
    pub mapped: Mapped,
    /// Inlines to the right, crosslines down, a pixel or several a trace; transparent where there is no value.
    pub image: RgbaImage,
    /// Where faults cut the horizon off, or either of two, by fault.
    pub faults: Vec<FaultCut>,
    /// Contours of the lightly smoothed surface, up to faults, by value.
    pub contours: Vec<Contour>,
    /// Outline and hatching of what was not picked, voxel x and y.
    pub hatching: Vec<[DVec2; 2]>,
    /// Share of its places that was not picked.
    pub unpicked: f64,
    /// Smallest and largest value, in the survey's unit.
    pub range: [f64; 2],
    /// Distance between contours.
    pub interval: f64,
}

impl HorizonMap {
    /// Maps a horizon or a thickness; `None` when there is nothing of it.
    pub fn new(geometry: &SurveyGeometry, source: MapSource, mapped: Mapped) -> Option<Self> {
        let grid = match source {
            MapSource::Model(model) => Grid::of_model(geometry, model, mapped, 1)?,
            MapSource::Sheets(shown) => Grid::of_sheets(geometry, shown, mapped)?,
        };
        let finite = || grid.nodes().iter().map(|node| node.value).filter(|value| value.is_finite());
        let range = [finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max)];
        if range[0] > range[1] {
            return None;
        }
        let spread = (range[1] - range[0]).max(1e-9);
        // High is light, as on relief maps: colours run from the deepest to the shallowest.
        let shade = |value: f64| match mapped {
            Mapped::Structure(_) => 1.0 - (value - range[0]) / spread,
            Mapped::Thickness(..) => (value - range[0]) / spread,
        };
        let colours = RgbaFunction::over(ColourMap::Strata, [0.0, 1.0]);
        let (finer, faults) = match source {
            MapSource::Model(model) => {
                let fine = (FINE_SIDE / grid.size.into_iter().max().unwrap_or(1)).clamp(1, MOST_FINE);
                (Grid::of_model(geometry, model, mapped, fine)?, cuts::cuts(geometry, model, mapped))
            }
            MapSource::Sheets(shown) => (Grid::of_sheets(geometry, shown, mapped)?, Vec::new()),
        };
        let image = RgbaImage::from_fn(finer.size[0] as u32, finer.size[1] as u32, |x, y| {
            let value = finer.at(x as usize, y as usize).value;
            if value.is_nan() {
                return Rgba([0; 4]);
            }
            let [r, g, b] = tone(&colours, shade(value)).rgb;
            Rgba([r, g, b, 255])
        });
        let interval = contours::interval(spread);
        let mut contours = contours::contours(&smooth::smoothed(&grid, interval), range, interval);
        ends::lead_to_faults(&mut contours, &faults);
        let open = grid.nodes().iter().filter(|node| node.is_open && node.value.is_finite()).count();
        let unpicked = open as f64 / finite().count() as f64;
        Some(Self { mapped, image, faults, contours, hatching: hatch::hatching(&grid), unpicked, range, interval })
    }

    /// The values at the light and at the dark end of the colours.
    pub fn ends(&self) -> [f64; 2] {
        match self.mapped {
            Mapped::Structure(_) => self.range,
            Mapped::Thickness(..) => [self.range[1], self.range[0]],
        }
    }
}

/// The colour of a share of the range, 0 = dark.
pub(crate) fn tone(colours: &RgbaFunction, share: f64) -> Colour {
    let [r, g, b, _] = colours.evaluate(share as f32);
    Colour::from_unit([r, g, b])
}
