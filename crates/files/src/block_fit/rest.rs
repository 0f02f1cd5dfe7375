//! What a spline through some of the points leaves at the others, interpolated within each fault block.
//!
//! Weights ((R − d)₊ / (R d))² of the points within R, beside one that pulls to nothing: exact at the points, and nothing
//! far from them. R follows from how densely the points of the block lie.

use glam::DVec2;
use std::collections::HashMap;

/// The radius, of the mean distance between points of the block.
const RADIUS: f64 = 3.0;
/// Weight of nothing, of that of a point at a quarter of the radius.
const NOTHING: f64 = 0.02;

/// Differences from a spline, by block.
#[derive(Debug, Default)]
pub(super) struct Rest {
    blocks: HashMap<u16, BlockRest>,
}

#[derive(Debug)]
struct BlockRest {
    radius: f64,
    cells: HashMap<[i64; 2], Vec<(DVec2, f64)>>,
}

impl Rest {
    /// Nothing is left.
    pub(super) fn none() -> Self {
        Self::default()
    }

    /// Of place, block and difference of each point.
    pub(super) fn of(left: &[(DVec2, u16, f64)]) -> Self {
        let mut points: HashMap<u16, Vec<(DVec2, f64)>> = HashMap::new();
        left.iter().for_each(|(place, block, z)| points.entry(*block).or_default().push((*place, *z)));
        let of_block = |(block, points): (u16, Vec<(DVec2, f64)>)| {
            let all = || points.iter().map(|(place, _)| *place);
            let (low, high) = (all().reduce(DVec2::min)?, all().reduce(DVec2::max)?);
            let extent = (high - low).max(DVec2::splat(1e-6));
            let radius = RADIUS * (extent.x * extent.y / points.len() as f64).sqrt();
            let mut cells: HashMap<[i64; 2], Vec<(DVec2, f64)>> = HashMap::new();
            for (place, z) in points {
                cells.entry(cell(place, radius)).or_default().push((place, z));
            }
            Some((block, BlockRest { radius, cells }))
        };
        Self { blocks: points.into_iter().filter_map(of_block).collect() }
    }

    /// What is left of a block at a place.
    pub(super) fn at(&self, place: DVec2, block: u16) -> f64 {
        let Some(BlockRest { radius, cells }) = self.blocks.get(&block) else { return 0.0 };
        let [u, v] = cell(place, *radius);
        let (mut sum, mut weights) = (0.0, NOTHING * 9.0 / (radius * radius));
        for near in [-1, 0, 1].into_iter().flat_map(|i| [-1, 0, 1].map(|j| [u + i, v + j])) {
            for (at, z) in cells.get(&near).into_iter().flatten() {
                let distance = at.distance(place).max(1e-9);
                let weight = ((radius - distance).max(0.0) / (radius * distance)).powi(2);
                sum += weight * z;
                weights += weight;
            }
        }
        sum / weights
    }
}

fn cell(place: DVec2, radius: f64) -> [i64; 2] {
    (place / radius).floor().to_array().map(|at| at as i64)
}
