//! A horizon, or the thickness between two, as a map: values at the survey's traces and contours of round values.
//!
//! Each trace takes the shallowest place where the horizon lies in the block it belongs to; where no block has it, there is no value. Contours are
//! found cell by cell (marching squares): along each side a value between the ends is placed by linear interpolation, and a cell's
//! two or four places are joined. A cell with corners in different fault blocks has none: contours end at faults.

use super::{Event, Outbox, Rocks, spawn};
use crate::pipeline::Loaded;
use glam::{DVec2, Vec3};
use image::{Rgba, RgbaImage};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use ttf::{ColourMap, RgbaFunction};

/// Contours that a map aims at.
const CONTOURS: f64 = 14.0;
/// Every so manyeth contour is an index contour: heavier, with its value.
const INDEX_EVERY: i64 = 5;

/// What is to be mapped, by indices of horizons, youngest first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mapped {
    /// Its depth or time.
    Structure(usize),
    /// Vertical thickness from one down to the next.
    Thickness(usize, usize),
}

/// A map to be seen.
#[derive(Clone)]
pub struct MapWish {
    /// Of what.
    pub mapped: Mapped,
    /// What it is made from.
    pub rocks: Rocks,
}

/// A contour's piece.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContourPiece {
    /// Ends, voxel x and y.
    pub ends: [DVec2; 2],
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
    /// Contours in pieces.
    pub contours: Vec<ContourPiece>,
    /// Smallest and largest value, in the survey's unit.
    pub range: [f64; 2],
    /// Distance between contours.
    pub interval: f64,
}

#[derive(Default)]
struct Slot {
    wish: Option<MapWish>,
    ended: bool,
}

/// The thread that maps, and the wish it works on next.
pub struct Maps {
    shared: Arc<(Mutex<Slot>, Condvar)>,
}

impl Maps {
    /// Starts the thread.
    pub fn start(outbox: Outbox) -> Self {
        let shared = Arc::new((Mutex::new(Slot::default()), Condvar::new()));
        let mine = shared.clone();
        spawn("map", move || work(&mine, &outbox));
        Self { shared }
    }

    /// Maps this next.
    pub fn map(&self, wish: MapWish) {
        self.change(|slot| slot.wish = Some(wish));
    }

    fn change(&self, change: impl FnOnce(&mut Slot)) {
        change(&mut self.shared.0.lock().unwrap_or_else(PoisonError::into_inner));
        self.shared.1.notify_one();
    }
}

impl Drop for Maps {
    fn drop(&mut self) {
        self.change(|slot| slot.ended = true);
    }
}

fn work(shared: &(Mutex<Slot>, Condvar), outbox: &Outbox) {
    loop {
        let wish = {
            let mut slot = shared.0.lock().unwrap_or_else(PoisonError::into_inner);
            loop {
                if slot.ended {
                    return;
                }
                if let Some(wish) = slot.wish.take() {
                    break wish;
                }
                slot = shared.1.wait(slot).unwrap_or_else(PoisonError::into_inner);
            }
        };
        let loaded = wish.rocks.read().unwrap_or_else(PoisonError::into_inner);
        let picture = draw(&loaded, wish.mapped);
        drop(loaded);
        if let Some(picture) = picture {
            outbox.send(Event::Mapped(picture));
        }
    }
}

/// Value and fault block at each trace, `[inline][crossline]`; NaN where there is none.
struct Grid {
    size: [usize; 2],
    values: Vec<(f64, u16)>,
}

impl Grid {
    fn at(&self, x: usize, y: usize) -> (f64, u16) {
        self.values[x * self.size[1] + y]
    }
}

/// The shallowest place of a horizon in its own block, voxel z.
fn horizon_at(loaded: &Loaded, horizon: usize, x: usize, y: usize) -> Option<(f32, u16)> {
    let model = &loaded.rock.as_ref()?.model;
    let last = loaded.geometry.vertical.count.saturating_sub(1) as f32;
    let (x, y) = (x as f32, y as f32);
    let places = (0..model.block_count() as u16).filter_map(|block| {
        let z = model.horizon_z(horizon, block, x, y);
        let is_there = z.is_finite() && (0.0..=last).contains(&z) && model.block_at(Vec3::new(x, y, z)) == block;
        is_there.then_some((z, block))
    });
    places.min_by(|a, b| a.0.total_cmp(&b.0))
}

fn grid(loaded: &Loaded, mapped: Mapped) -> Grid {
    let [nx, ny, _] = loaded.geometry.size();
    let vertical = &loaded.geometry.vertical;
    let value = |x: usize, y: usize| match mapped {
        Mapped::Structure(horizon) => horizon_at(loaded, horizon, x, y)
            .map_or((f64::NAN, 0), |(z, block)| (vertical.value_at(f64::from(z)), block)),
        Mapped::Thickness(upper, lower) => match (horizon_at(loaded, upper, x, y), horizon_at(loaded, lower, x, y)) {
            (Some((top, block)), Some((base, _))) => (f64::from((base - top).max(0.0)) * vertical.interval, block),
            _ => (f64::NAN, 0),
        },
    };
    let values = (0..nx * ny).map(|n| value(n / ny, n % ny)).collect();
    Grid { size: [nx, ny], values }
}

/// Maps what is loaded; `None` when there is nothing of it.
pub fn draw(loaded: &Loaded, mapped: Mapped) -> Option<MapPicture> {
    let model = &loaded.rock.as_ref()?.model;
    let count = model.stratigraphy().horizons.len();
    let is_known = match mapped {
        Mapped::Structure(horizon) => horizon < count,
        Mapped::Thickness(upper, lower) => upper < lower && lower < count,
    };
    if !is_known {
        return None;
    }
    let grid = grid(loaded, mapped);
    let finite = || grid.values.iter().map(|(value, _)| *value).filter(|value| value.is_finite());
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
        let (value, _) = grid.at(x as usize, y as usize);
        if value.is_nan() {
            return Rgba([0; 4]);
        }
        let [r, g, b, _] = colours.evaluate(shade(value) as f32).map(|channel| (channel * 255.0 + 0.5) as u8);
        Rgba([r, g, b, 255])
    });
    let interval = interval(spread);
    Some(MapPicture { mapped, image, contours: contours(&grid, range, interval), range, interval })
}

/// A round distance between contours.
fn interval(spread: f64) -> f64 {
    let wanted = spread / CONTOURS;
    let decade = 10f64.powf(wanted.log10().floor());
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|factor| factor * decade).find(|step| *step >= wanted).unwrap_or(decade)
}

fn contours(grid: &Grid, range: [f64; 2], interval: f64) -> Vec<ContourPiece> {
    let mut pieces = Vec::new();
    let [nx, ny] = grid.size;
    for x in 0..nx.saturating_sub(1) {
        for y in 0..ny.saturating_sub(1) {
            let corners = [(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)];
            let found = corners.map(|(x, y)| grid.at(x, y));
            let is_whole = found.iter().all(|(value, block)| value.is_finite() && *block == found[0].1);
            if !is_whole {
                continue;
            }
            let values = found.map(|(value, _)| value);
            let low = values.into_iter().fold(f64::INFINITY, f64::min);
            let high = values.into_iter().fold(f64::NEG_INFINITY, f64::max);
            let mut level = (low.max(range[0]) / interval).ceil() as i64;
            while level as f64 * interval <= high {
                let value = level as f64 * interval;
                let mut places = Vec::with_capacity(4);
                for side in 0..4 {
                    let (a, b) = (values[side], values[(side + 1) % 4]);
                    if (a < value) != (b < value) {
                        let share = (value - a) / (b - a);
                        let place = |(x, y): (usize, usize)| DVec2::new(x as f64, y as f64);
                        places.push(place(corners[side]).lerp(place(corners[(side + 1) % 4]), share));
                    }
                }
                for pair in places.chunks_exact(2) {
                    pieces.push(ContourPiece { ends: [pair[0], pair[1]], value, is_index: level % INDEX_EVERY == 0 });
                }
                level += 1;
            }
        }
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid_of(size: [usize; 2], value: impl Fn(f64, f64) -> f64) -> Grid {
        let values = (0..size[0] * size[1]).map(|n| (value((n / size[1]) as f64, (n % size[1]) as f64), 0)).collect();
        Grid { size, values }
    }

    #[test]
    fn contours_of_a_dipping_plane_lie_on_it() {
        let plane = |x: f64, y: f64| 100.0 + 3.0 * x - 2.0 * y;
        let pieces = contours(&grid_of([20, 15], plane), [72.0, 157.0], 10.0);
        assert!(!pieces.is_empty());
        for piece in pieces {
            for end in piece.ends {
                assert!((plane(end.x, end.y) - piece.value).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn a_flat_horizon_has_no_contour_and_a_hole_has_none_around_it() {
        assert!(contours(&grid_of([9, 9], |_, _| 55.0), [55.0, 55.0], 10.0).is_empty());
        let holed = grid_of([9, 9], |x, y| if (x, y) == (4.0, 4.0) { f64::NAN } else { 10.0 * x });
        let near =
            |piece: &ContourPiece| piece.ends.iter().all(|end| (*end - DVec2::splat(4.0)).abs().max_element() < 1.0);
        assert!(!contours(&holed, [0.0, 80.0], 5.0).iter().any(near));
    }

    #[test]
    fn intervals_are_round() {
        for (spread, said) in [(140.0, 10.0), (100.0, 10.0), (15.0, 2.0), (3000.0, 500.0)] {
            assert_eq!(interval(spread), said);
        }
    }
}
