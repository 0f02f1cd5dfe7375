//! Faults that a horizon was tracked across.
//!
//! Where the throw is small or the reflection smeared, a tracked horizon does not end at a fault: it bends down or up over a few traces and goes on.
//! There the planes of the two sides, fitted without the bend, do not meet. Of the ways across, the one with the largest offset is taken, and along it
//! only the place where it is largest: the ridge of an edge map of the horizon (dip and edge maps: Rijks and Jauffred, 1991). A fold offers
//! an offset too, but no bend: between the sides it falls no faster than beside. A jump from one trace to the next is left to the rims.

use super::ProposeSettings;
use super::edges::{JUMP, pieces_of};
use super::pairs::Pair;
use crate::reassembly::VoxelSheet;
use glam::Vec2;
use rayon::prelude::*;

/// Radius of the half discs that the planes are fitted to, traces.
const RADIUS: f32 = 7.0;
/// Nodes nearer to the edge than this are the bend's, traces.
const BEND: f32 = 2.0;
/// Ways across that are tried over half a turn.
const WAYS: usize = 8;
/// Fewest nodes of a half disc, of about fifty.
const FEWEST: usize = 28;
/// The offset in units of the RMS residual of the two planes.
const CLEAR: f32 = 3.0;
/// Share of the offset that the bend itself must hold; a slope that goes on evenly holds 2 BEND / RADIUS of it or less.
const IN_BEND: f32 = 0.7;
/// No other sheet lies over a bend nearer than this, traces.
const ALONE: usize = 4;
/// Places along the way across that an edge must exceed, traces.
const RIDGE: i32 = 3;

/// The bends of a horizon's sheets as pairs of horizon `horizon`. Where sheets lie over one another the offset is between them, and the rims tell it.
///
/// Cost: for each node that bends at all, [`WAYS`] pairs of plane fits of about fifty nodes each.
pub(super) fn of(sheets: &[VoxelSheet], size: [usize; 2], horizon: usize, settings: &ProposeSettings) -> Vec<Pair> {
    let disc = Disc::new();
    let doubled: Vec<bool> =
        (0..size[0] * size[1]).map(|n| sheets.iter().filter(|sheet| sheet.z[n].is_finite()).count() > 1).collect();
    let in_sheet = |sheet: &VoxelSheet| {
        let z = &sheet.z;
        let piece = pieces_of(z, size).0;
        let edge = |n: usize| {
            let candidate = bends(z, size, n, settings.min_throw) && !around(size, n, ALONE).any(|m| doubled[m]);
            candidate.then(|| disc.edge(z, &piece, size, n, settings.min_throw))?
        };
        let edges: Vec<Option<Edge>> = (0..z.len()).into_par_iter().map(edge).collect();
        let pair = |n: usize| {
            let edge = edges[n].filter(|edge| is_crest(&edges, size, n, *edge))?;
            let at = [(n / size[1]) as f32, (n % size[1]) as f32, edge.z];
            // A bend is as wide as what was tracked made it: it says nothing of the fault's dip.
            Some(Pair { horizon, at, across: edge.across, throw: edge.offset, heave: 0.0, bend: true })
        };
        (0..z.len()).filter_map(pair).collect::<Vec<_>>()
    };
    sheets.iter().flat_map(in_sheet).collect()
}

/// The nodes within `reach` traces of node `n` both ways.
fn around([nx, ny]: [usize; 2], n: usize, reach: usize) -> impl Iterator<Item = usize> {
    let [x, y] = [n / ny, n % ny];
    let columns = y.saturating_sub(reach)..=(y + reach).min(ny - 1);
    (x.saturating_sub(reach)..=(x + reach).min(nx - 1)).flat_map(move |i| columns.clone().map(move |j| i * ny + j))
}

/// Whether the sheet falls by half the smallest throw or more between the neighbours of `n`: a cheap look before the dear one.
fn bends(z: &[f32], size: [usize; 2], n: usize, min_throw: f32) -> bool {
    let range = |(low, high): (f32, f32), m: usize| (low.min(z[m]), high.max(z[m]));
    let (low, high) = around(size, n, BEND as usize).fold((f32::INFINITY, f32::NEG_INFINITY), range);
    z[n].is_finite() && high - low >= 0.5 * min_throw
}

/// An offset between the two sides of a node.
#[derive(Debug, Clone, Copy)]
struct Edge {
    across: Vec2,
    offset: f32,
    /// Midway between the planes.
    z: f32,
}

/// The nodes around a node, and on which side of it they are for each way across.
struct Disc {
    nodes: Vec<[i32; 2]>,
    ways: [Vec2; WAYS],
    /// `[way][node]`: 1 beyond, -1 before, 0 in the bend.
    side: Vec<Vec<i8>>,
}

impl Disc {
    fn new() -> Self {
        let reach = RADIUS as i32;
        let square = (-reach..=reach).flat_map(|i| (-reach..=reach).map(move |j| [i, j]));
        let nodes: Vec<[i32; 2]> = square.filter(|&[i, j]| (i * i + j * j) as f32 <= RADIUS * RADIUS).collect();
        let ways: [Vec2; WAYS] =
            std::array::from_fn(|way| Vec2::from_angle(std::f32::consts::PI * way as f32 / WAYS as f32));
        let side_of = |way: &Vec2, &[i, j]: &[i32; 2]| {
            let off = way.dot(Vec2::new(i as f32, j as f32));
            if off >= BEND { 1 } else { -i8::from(off <= -BEND) }
        };
        let side = ways.iter().map(|way| nodes.iter().map(|node| side_of(way, node)).collect()).collect();
        Self { nodes, ways, side }
    }

    /// The largest clear offset of node `n`'s piece there, of all ways across.
    fn edge(&self, z: &[f32], piece: &[u32], [nx, ny]: [usize; 2], n: usize, min_throw: f32) -> Option<Edge> {
        let [x, y] = [(n / ny) as i32, (n % ny) as i32];
        let heights: Vec<f32> = self
            .nodes
            .iter()
            .map(|&[i, j]| {
                let (i, j) = (x + i, y + j);
                let inside = i >= 0 && j >= 0 && i < nx as i32 && j < ny as i32;
                let m = if inside { i as usize * ny + j as usize } else { return f32::NAN };
                if piece[m] == piece[n] { z[m] } else { f32::NAN }
            })
            .collect();
        let mut best: Option<Edge> = None;
        for (way, side) in self.ways.iter().zip(&self.side) {
            let fit = |of: i8| self.plane(&heights, side, of);
            let (Some(before), Some(beyond)) = (fit(-1), fit(1)) else { continue };
            let offset = beyond.z - before.z;
            let noise = (0.5 * (before.variance + beyond.variance)).sqrt();
            let clear = offset.abs() >= min_throw.max(CLEAR * noise);
            if !clear || best.is_some_and(|best| best.offset.abs() >= offset.abs()) {
                continue;
            }
            let place = |by: f32| at(z, [nx, ny], Vec2::new(x as f32, y as f32) + *way * by);
            let bend = [-BEND, -0.5 * BEND, 0.0, 0.5 * BEND, BEND].map(place);
            let whole = bend.windows(2).all(|pair| (pair[1] - pair[0]).abs() <= JUMP);
            // What falls inside the bend, less what both sides fall over that width.
            let even = (before.slope + beyond.slope).dot(*way) * BEND;
            if whole && (bend[4] - bend[0] - even) / offset >= IN_BEND {
                best = Some(Edge { across: *way, offset, z: 0.5 * (before.z + beyond.z) });
            }
        }
        best
    }

    /// Least squares plane of the nodes on one side.
    fn plane(&self, heights: &[f32], side: &[i8], of: i8) -> Option<Plane> {
        let mut m = [0.0f64; 9];
        let mut count = 0;
        for ((&[i, j], &z), _) in
            self.nodes.iter().zip(heights).zip(side).filter(|((_, z), s)| **s == of && z.is_finite())
        {
            let [i, j, z] = [f64::from(i), f64::from(j), f64::from(z)];
            count += 1;
            let terms = [i, j, z, i * i, i * j, j * j, i * z, j * z, z * z];
            m.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term);
        }
        if count < FEWEST {
            return None;
        }
        let c = f64::from(count as u32);
        let [i, j, z] = [m[0] / c, m[1] / c, m[2] / c];
        let [ii, ij, jj] = [m[3] / c - i * i, m[4] / c - i * j, m[5] / c - j * j];
        let [iz, jz, zz] = [m[6] / c - i * z, m[7] / c - j * z, m[8] / c - z * z];
        let determinant = ii * jj - ij * ij;
        if determinant < 0.02 * ii * jj {
            return None;
        }
        let slope = [(iz * jj - jz * ij) / determinant, (jz * ii - iz * ij) / determinant];
        Some(Plane {
            z: (z - slope[0] * i - slope[1] * j) as f32,
            slope: Vec2::new(slope[0] as f32, slope[1] as f32),
            variance: (zz - slope[0] * iz - slope[1] * jz).max(0.0) as f32,
        })
    }
}

/// A plane through the middle of a disc.
struct Plane {
    z: f32,
    slope: Vec2,
    variance: f32,
}

/// The node nearest to a place; NaN outside.
fn at(z: &[f32], [nx, ny]: [usize; 2], place: Vec2) -> f32 {
    let place = place.round();
    let inside = place.x >= 0.0 && place.y >= 0.0 && place.x < nx as f32 && place.y < ny as f32;
    if inside { z[place.x as usize * ny + place.y as usize] } else { f32::NAN }
}

/// Whether no place along the way across has a larger offset; of equal ones the first.
fn is_crest(edges: &[Option<Edge>], [nx, ny]: [usize; 2], n: usize, edge: Edge) -> bool {
    let place = Vec2::new((n / ny) as f32, (n % ny) as f32);
    (-RIDGE..=RIDGE).filter(|&by| by != 0).all(|by| {
        let q = (place + edge.across * by as f32).round();
        let inside = q.x >= 0.0 && q.y >= 0.0 && q.x < nx as f32 && q.y < ny as f32;
        let m = if inside { q.x as usize * ny + q.y as usize } else { return true };
        let other = edges[m].map_or(0.0, |other| other.offset.abs());
        m == n || other < edge.offset.abs() || (other == edge.offset.abs() && n < m)
    })
}
