//! Faults that a horizon was tracked across.
//!
//! Where the throw is small or the reflection smeared, a tracked horizon does not end at a fault: it bends
//! over a few traces and continues. There the planes of the two sides, fitted without the bend, do not meet.
//! Of all directions across, the one with the largest offset is taken, and along it only the place where the
//! offset is largest: the ridge of an edge map of the horizon (dip and edge maps: E. J. H. Rijks and J. C. E.
//! M. Jauffred, "Attribute extraction: an important application in any detailed 3-D interpretation study",
//! The Leading Bend 10, 1991). A fold also has an offset, but no bend: between the sides it falls no faster
//! than beside. A jump from one trace to the next is left to the rims.

use super::ProposeSettings;
use super::edges::{JUMP, pieces_of};
use super::pairs::Pair;
use crate::reassembly::VoxelSheet;
use glam::Vec2;
use rayon::prelude::*;

/// Radius of the half discs to which the planes are fitted, traces.
const RADIUS: f32 = 7.0;
/// Half the width of the bend, whose nodes are in neither plane, traces.
const BEND: f32 = 2.0;
/// Count of directions across that are tried over half a turn.
const WAYS: usize = 8;
/// Fewest nodes of a half disc, of about fifty.
const FEWEST: usize = 28;
/// Least offset in units of the RMS residual of the two planes.
const CLEAR: f32 = 3.0;
/// Least share of the offset that lies inside the bend; an even slope has at most 2 BEND / RADIUS of it
/// there.
const IN_BEND: f32 = 0.7;
/// Distance from a bend within which no sheet may lie over another, traces.
const ALONE: usize = 4;
/// Distance along the direction across within which a bend must have the largest offset, traces.
/// Places along the way across that an edge must exceed, traces.
const RIDGE: i32 = 3;

/// The bends of a horizon's sheets as pairs of horizon `horizon`. Where sheets lie over one another the
/// offset is between them and is found at their rims.
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
        let edges: Vec<Option<Bend>> = (0..z.len()).into_par_iter().map(edge).collect();
        let pair = |n: usize| {
            let edge = edges[n].filter(|edge| is_crest(&edges, size, n, *edge))?;
            let at = [(n / size[1]) as f32, (n % size[1]) as f32, edge.z];
            // The width of a bend comes from tracking and says nothing about the fault's dip.
            Some(Pair { horizon, at, across: edge.across, throw: edge.offset, heave: 0.0, bend: true })
        };
        (0..z.len()).filter_map(pair).collect::<Vec<_>>()
    };
    sheets.iter().flat_map(in_sheet).collect()
}

/// The nodes within `reach` traces of node `n` along both axes.
fn around([nx, ny]: [usize; 2], n: usize, reach: usize) -> impl Iterator<Item = usize> {
    let [x, y] = [n / ny, n % ny];
    let columns = y.saturating_sub(reach)..=(y + reach).min(ny - 1);
    (x.saturating_sub(reach)..=(x + reach).min(nx - 1)).flat_map(move |i| columns.clone().map(move |j| i * ny + j))
}

/// Whether the sheet falls by half the smallest throw or more among the neighbours of `n`: a cheap test
/// before the expensive one.
fn bends(z: &[f32], size: [usize; 2], n: usize, min_throw: f32) -> bool {
    let range = |(low, high): (f32, f32), m: usize| (low.min(z[m]), high.max(z[m]));
    let (low, high) = around(size, n, BEND as usize).fold((f32::INFINITY, f32::NEG_INFINITY), range);
    z[n].is_finite() && high - low >= 0.5 * min_throw
}

/// The offset between the two sides of a node.
#[derive(Debug, Clone, Copy)]
struct Bend {
    across: Vec2,
    offset: f32,
    /// Sample index midway between the planes.
    z: f32,
}

/// The nodes around a node, and the side on which each lies for each direction across.
struct Disc {
    nodes: Vec<[i32; 2]>,
    ways: [Vec2; WAYS],
    /// `[direction][node]`: 1 beyond, -1 before, 0 in the bend.
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

    /// The largest clear offset of the piece of node `n` there, over all directions across.
    fn edge(&self, z: &[f32], piece: &[u32], [nx, ny]: [usize; 2], n: usize, min_throw: f32) -> Option<Bend> {
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
        let mut best: Option<Bend> = None;
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
            // The fall inside the bend, less the fall of both planes over that width.
            let even = (before.slope + beyond.slope).dot(*way) * BEND;
            if whole && (bend[4] - bend[0] - even) / offset >= IN_BEND {
                best = Some(Bend { across: *way, offset, z: 0.5 * (before.z + beyond.z) });
            }
        }
        best
    }

    /// The least-squares plane of the nodes on one side; `None` where they do not determine one.
    fn plane(&self, heights: &[f32], side: &[i8], of: i8) -> Option<SidePlane> {
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
        Some(SidePlane {
            z: (z - slope[0] * i - slope[1] * j) as f32,
            slope: Vec2::new(slope[0] as f32, slope[1] as f32),
            variance: (zz - slope[0] * iz - slope[1] * jz).max(0.0) as f32,
        })
    }
}

/// A plane through the middle of a disc.
struct SidePlane {
    z: f32,
    slope: Vec2,
    variance: f32,
}

/// z of the node nearest to a position; NaN outside.
fn at(z: &[f32], [nx, ny]: [usize; 2], place: Vec2) -> f32 {
    let place = place.round();
    let inside = place.x >= 0.0 && place.y >= 0.0 && place.x < nx as f32 && place.y < ny as f32;
    if inside { z[place.x as usize * ny + place.y as usize] } else { f32::NAN }
}

/// Whether no node along the direction across has a larger offset; of equal ones the first counts.
fn is_crest(edges: &[Option<Bend>], [nx, ny]: [usize; 2], n: usize, edge: Bend) -> bool {
    let place = Vec2::new((n / ny) as f32, (n % ny) as f32);
    (-RIDGE..=RIDGE).filter(|&by| by != 0).all(|by| {
        let q = (place + edge.across * by as f32).round();
        let inside = q.x >= 0.0 && q.y >= 0.0 && q.x < nx as f32 && q.y < ny as f32;
        let m = if inside { q.x as usize * ny + q.y as usize } else { return true };
        let other = edges[m].map_or(0.0, |other| other.offset.abs());
        m == n || other < edge.offset.abs() || (other == edge.offset.abs() && n < m)
    })
}
