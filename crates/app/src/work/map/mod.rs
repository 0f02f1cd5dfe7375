//! A horizon, or the thickness between two, as a map: values at the survey's traces and contours of round values.
//!
//! Contours are those of a lightly smoothed surface (`smooth`), colours those of the values themselves. What was not picked, but filled or extrapolated, is hatched; while interpreting, when there is no model, holes are.

mod contours;
mod grid;
mod hatch;
mod smooth;

use super::wishes::{Wished, Wishes};
use super::{Event, Interpreted, Outbox, Rocks};
use glam::DVec2;
use grid::Grid;
use image::{Rgba, RgbaImage};
use std::sync::{Arc, PoisonError};
use survey::SurveyGeometry;
use ttf::{ColourMap, RgbaFunction};

/// What is to be mapped, by indices of horizons, youngest first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mapped {
    /// Its depth or time.
    Structure(usize),
    /// Vertical thickness from one down to the next.
    Thickness(usize, usize),
}

impl Mapped {
    /// Whether there is such a thing among so many horizons.
    fn is_among(self, count: usize) -> bool {
        match self {
            Self::Structure(horizon) => horizon < count,
            Self::Thickness(upper, lower) => upper < lower && lower < count,
        }
    }
}

/// What a map is made from.
#[derive(Clone)]
pub enum MapSource {
    /// The model.
    Rocks(Rocks),
    /// The horizons as they were picked, without a model.
    Interpreted(Arc<Interpreted>, Box<SurveyGeometry>),
}

/// A map to be seen.
#[derive(Clone)]
pub struct MapWish {
    /// Of what.
    pub mapped: Mapped,
    /// What it is made from.
    pub source: MapSource,
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

/// A map.
pub struct MapPicture {
    /// Of what.
    pub mapped: Mapped,
    /// A pixel a trace, inlines to the right, crosslines down; transparent where there is no value.
    pub image: RgbaImage,
    /// Contours of the lightly smoothed surface, by value.
    pub contours: Vec<Contour>,
    /// Outline and hatching of what was not picked, voxel x and y.
    pub hatching: Vec<[DVec2; 2]>,
    /// Smallest and largest value, in the survey's unit.
    pub range: [f64; 2],
    /// Distance between contours.
    pub interval: f64,
}

/// The thread that maps, and the wish it works on next.
pub struct Maps {
    wishes: Wishes<Option<MapWish>>,
}

impl Maps {
    /// Starts the thread.
    pub fn start(outbox: Outbox) -> Self {
        Self {
            wishes: Wishes::start("map", move |wished: &Wished<Option<MapWish>>| {
                while let Some(wish) = wished.next(Option::take) {
                    if let Some(picture) = draw(&wish) {
                        outbox.send(Event::Mapped(picture));
                    }
                }
            }),
        }
    }

    /// Maps this next.
    pub fn map(&self, wish: MapWish) {
        self.wishes.change(|next| *next = Some(wish));
    }
}

/// Maps what is wished; `None` when there is nothing of it.
pub fn draw(wish: &MapWish) -> Option<MapPicture> {
    let mapped = wish.mapped;
    let grid = match &wish.source {
        MapSource::Rocks(rocks) => Grid::of_model(&rocks.read().unwrap_or_else(PoisonError::into_inner), mapped)?,
        MapSource::Interpreted(shown, geometry) => Grid::of_sheets(shown, geometry, mapped)?,
    };
    let finite = || grid.nodes().iter().map(|node| node.value).filter(|value| value.is_finite());
    let range = [finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max)];
    if range[0] > range[1] {
        return None;
    }
    // High is light, as on relief maps: colours run from the deepest to the shallowest.
    let colours = RgbaFunction::over(ColourMap::Strata, [0.0, 1.0]);
    let spread = (range[1] - range[0]).max(1e-9);
    let shade = |value: f64| match mapped {
        Mapped::Structure(_) => 1.0 - (value - range[0]) / spread,
        Mapped::Thickness(..) => (value - range[0]) / spread,
    };
    let image = RgbaImage::from_fn(grid.size[0] as u32, grid.size[1] as u32, |x, y| {
        let value = grid.at(x as usize, y as usize).value;
        if value.is_nan() {
            return Rgba([0; 4]);
        }
        let [r, g, b, _] = colours.evaluate(shade(value) as f32).map(|channel| (channel * 255.0 + 0.5) as u8);
        Rgba([r, g, b, 255])
    });
    let interval = contours::interval(spread);
    let contours = contours::contours(&smooth::smoothed(&grid, interval), range, interval);
    Some(MapPicture { mapped, image, contours, hatching: hatch::hatching(&grid), range, interval })
}
