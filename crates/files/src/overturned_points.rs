//! Tells few scattered points of an overturned fold from those of a map, by looking at them from every side.
//!
//! Seen along a direction d, points are a height field over the plane across d. How well it fits is how far each point
//! lies off the plane through its neighbours in that view, itself left out:
//!
//! ```text
//! misfit(d) = mean over p of  min(|h(p) − plane(p)| · max(|n·d|, EDGE_ON), spacing)
//! ```
//!
//! Points of a map fit about as well from above as from anywhere. Points of an overturned fold do not: its limbs lie over
//! one another. From aside they do, and there the planes' normals n tell which limbs are upside down. Steep beds, throws
//! and folds may look better from aside too, but none of their limbs is upside down.

use glam::{DMat3, DVec2, DVec3};
use rayon::prelude::*;
use std::cmp::Ordering;

/// Directions, evenly over the upper half of the sphere.
const DIRECTIONS: usize = 120;
/// Neighbours of a point that a plane is laid through.
const NEIGHBOURS: usize = 8;
/// Least |n·d| in a misfit: a surface seen edge on is a line, which fits for no reason.
const EDGE_ON: f64 = 0.4;
/// Largest misfit of a view, as a share of that from above, at which it says more than that, and at which it may.
const BETTER: f64 = 0.35;
const DOUBTED: f64 = 0.4;
/// Least |n_z| of what is upright or upside down.
const CLEAR: f64 = 0.15;
/// Largest misfit of a plane that tells so, in spacings: in the best view, and in any other.
const TELLS: f64 = 0.25;
const TELLS_WELL: f64 = 0.1;
/// Share of the points that must be upside down; more of them, by this factor, the larger the misfit.
const SHARE: f64 = 0.05;
const SHARE_A_MISFIT: f64 = 0.5;

/// A point in a view: how far it lies off the plane through its neighbours, m, and the vertical part of its normal.
#[derive(Clone, Copy)]
struct ViewedPoint {
    off: f64,
    normal_z: f64,
}

/// What points say.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum SeenSideways {
    /// They are those of a map.
    Map,
    /// Some of them seem to lie upside down, too few or too loosely to be sure.
    Unclear,
    /// They are several limbs of a fold over one place of the map.
    Overturned,
}

/// What points (metric, z vertical) say. They are compared in pairs, in each of [`DIRECTIONS`] views.
pub(super) fn told(points: &[DVec3]) -> SeenSideways {
    if points.len() <= NEIGHBOURS {
        return SeenSideways::Map;
    }
    let spacing = spacing(points);
    let misfit = |seen: &[ViewedPoint]| seen.iter().map(|s| s.off.min(spacing)).sum::<f64>() / seen.len() as f64;
    let turned = |seen: &[ViewedPoint], tells: f64| {
        let share = |up: f64| {
            let tells = seen.iter().filter(|s| s.off < tells * spacing && s.normal_z * up > CLEAR);
            tells.count() as f64 / seen.len() as f64
        };
        share(1.0).min(share(-1.0))
    };
    let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    let direction = |n: usize| {
        let z = 1.0 - (n as f64 + 0.5) / DIRECTIONS as f64;
        (DVec2::from_angle(n as f64 * golden) * (1.0 - z * z).sqrt()).extend(z)
    };
    let from_above = misfit(&view(points, DVec3::Z));
    let from_aside: Vec<(f64, f64, f64)> = (0..DIRECTIONS)
        .into_par_iter()
        .map(|n| {
            let seen = view(points, direction(n));
            (misfit(&seen) / from_above, turned(&seen, TELLS), turned(&seen, TELLS_WELL))
        })
        .collect();
    let best = from_aside.iter().min_by(|a, b| a.0.total_cmp(&b.0));
    let Some(&(misfit, turned, _)) = best else { return SeenSideways::Map };
    if misfit < BETTER && turned > SHARE.max(SHARE_A_MISFIT * misfit) {
        SeenSideways::Overturned
    } else if misfit < DOUBTED && turned > SHARE || from_aside.iter().any(|v| v.0 < DOUBTED && v.2 > SHARE) {
        SeenSideways::Unclear
    } else {
        SeenSideways::Map
    }
}

/// The usual distance of a point from those around it, m.
fn spacing(points: &[DVec3]) -> f64 {
    let sixth = |p: &DVec3| {
        let mut all: Vec<f64> = points.iter().map(|q| q.distance(*p)).collect();
        *all.select_nth_unstable_by(6, f64::total_cmp).1
    };
    let mut all: Vec<f64> = points.par_iter().map(sixth).collect();
    let middle = all.len() / 2;
    *all.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// The points as seen along a direction.
fn view(points: &[DVec3], direction: DVec3) -> Vec<ViewedPoint> {
    let (right, up) = direction.any_orthonormal_pair();
    let places: Vec<(DVec2, f64)> =
        points.iter().map(|p| (DVec2::new(p.dot(right), p.dot(up)), p.dot(direction))).collect();
    let seen = |n: usize| {
        let (at, height) = places[n];
        let others = places.iter().enumerate().filter(|&(m, _)| m != n);
        let mut near: Vec<(f64, usize)> = others.map(|(m, (place, _))| (place.distance_squared(at), m)).collect();
        let order = |a: &(f64, usize), b: &(f64, usize)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
        near.select_nth_unstable_by(NEIGHBOURS - 1, order);
        let around = near[..NEIGHBOURS].iter().map(|&(square, m)| (places[m].0 - at, places[m].1 - height, square));
        let [off, east, north] = plane(around);
        let normal = direction - right * east - up * north;
        let facing = normal.length().recip();
        ViewedPoint { off: off.abs() * facing.max(EDGE_ON), normal_z: normal.z * facing }
    };
    (0..points.len()).map(seen).collect()
}

/// The plane a + b·x + c·y through heights at places relative to a point, each weighted by the inverse of its squared
/// distance. Places in a row have no slope across it.
fn plane(around: impl Iterator<Item = (DVec2, f64, f64)>) -> [f64; 3] {
    let (mut normal, mut right, mut total) = (DMat3::ZERO, DVec3::ZERO, 0.0);
    for (place, height, square) in around {
        let weight = square.max(1e-12).recip();
        let row = DVec3::new(1.0, place.x, place.y);
        normal += DMat3::from_cols(row * row.x, row * row.y, row * row.z) * weight;
        right += row * (height * weight);
        total += weight;
    }
    // The slopes' part of the matrix is about the number of places: a little of it decides where they lie in a row.
    let little = 1e-6 * NEIGHBOURS as f64;
    let steadied = normal + DMat3::from_diagonal(DVec3::new(0.0, little, little));
    match steadied.determinant().abs().partial_cmp(&(f64::EPSILON * total)) {
        Some(Ordering::Greater) => (steadied.inverse() * right).to_array(),
        _ => [0.0; 3],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use synth::Overturned;

    /// Points (metric) of a map over 600 by 500 m, with 3 m of noise.
    fn scattered(count: usize, seed: u64, map: &dyn Fn(f64, f64) -> f64) -> Vec<DVec3> {
        let mut state = 7 + 1000 * seed + count as u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as f64 / f64::from(u32::MAX / 2)
        };
        let mut point = || {
            let (x, y) = (600.0 * random(), 500.0 * random());
            DVec3::new(x, y, map(x, y) + 3.0 * random())
        };
        (0..count + 10).map(|_| point()).skip(10).collect()
    }

    #[test]
    fn fifty_points_of_an_outcrop_tell_that_it_is_overturned() {
        let (mut overturned, mut missed, mut silent) = (0, 0, 0);
        for (size, seeds) in [([40, 36, 32], 1..=6), ([61, 51, 56], 11..=16)] {
            for seed in seeds {
                let made = Overturned::generate(size, seed).unwrap();
                let metric = made.geometry.metric_from_voxel();
                for horizon in &made.horizons {
                    let places = horizon.surface.iter().flat_map(|surface| &surface.vertices);
                    let points: Vec<DVec3> = places.map(|&p| metric * made.geometry.voxel_from_world(p)).collect();
                    let turned = points.iter().filter(|p| made.truth.is_overturned(**p)).count() as f64;
                    let told = told(&points);
                    assert!(turned > 0.0 || told == SeenSideways::Map, "seed {seed}, {}: {told:?}", horizon.name);
                    if turned > 0.1 * points.len() as f64 {
                        overturned += 1;
                        missed += usize::from(told != SeenSideways::Overturned);
                        silent += usize::from(told == SeenSideways::Map);
                    }
                }
            }
        }
        assert!(overturned > 60 && missed <= overturned / 20 && silent == 0, "{missed}, {silent} of {overturned}");
    }

    #[test]
    fn points_of_a_map_are_never_taken_for_an_overturned_fold() {
        for wavelength in [30.0, 60.0, 90.0, 150.0] {
            for height in [50.0, 150.0, 300.0] {
                let step = move |c: f64| (c / wavelength).floor();
                let far = |x: f64, y: f64, radius: f64| ((x - 300.0).powi(2) + (y - 250.0).powi(2)) / radius.powi(2);
                let maps: [&dyn Fn(f64, f64) -> f64; 6] = [
                    &|x, _| height * (x / wavelength).sin(),
                    &|x, y| height * (x / wavelength).sin() * (y / 1.3 / wavelength + 0.7).cos(),
                    &|x, y| 0.2 * y + height * (step(x) % 2.0),
                    &|x, y| 0.3 * y + 0.5 * height * step(x + 0.2 * y),
                    &|x, y| 0.02 * height * x + 0.3 * wavelength * (y / 60.0).sin(),
                    &|x, y| x - 2.0 * height * (-0.5 * far(x, y, wavelength)).exp(),
                ];
                for (kind, map) in maps.iter().enumerate() {
                    for (count, seed) in [(50, 1), (50, 2), (50, 3), (100, 1), (150, 1)] {
                        let points = scattered(count, seed, map);
                        assert!(
                            told(&points) != SeenSideways::Overturned,
                            "{kind}: {count} points, {wavelength} m, {height} m"
                        );
                    }
                }
            }
        }
        // Gentle ones are not even doubted.
        for (count, seed) in [(50, 3), (100, 4), (150, 5), (400, 6)] {
            let gentle = scattered(count, seed, &|x, y| 40.0 * (x / 90.0).sin() + if x > 0.3 * y { 30.0 } else { 0.0 });
            assert_eq!(told(&gentle), SeenSideways::Map, "{count}");
        }
    }
}
