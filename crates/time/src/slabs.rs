//! Geologic time in slabs of inlines, for surveys that do not fit into memory.
//!
//! A slab is solved with lines beside its own. Its τ and that of the slab before it are then two clocks of the same beds,
//! each known up to one increasing function; over the lines that both have, the mean of the one for every value of the
//! other, made monotone, sets the later clock by the earlier. Across those lines the two are blended. The result depends on
//! the width of the slabs, by a part of a sample where reflections are good.

use crate::compute::BYTES_A_VOXEL;
use crate::isotonic::{Pools, regress};
use interp::{Surface, Surfaces};
use std::ops::Range;
use survey::Volume;

/// Inlines that neighbouring slabs have in common.
const COMMON: usize = 32;
/// Least inlines of a slab.
const LEAST: usize = 3 * COMMON;
/// Bytes a voxel of a slab: what solving takes, the amplitudes, τ, and what is compared.
const BYTES: usize = BYTES_A_VOXEL + 12;
/// Width of a bin of τ, samples.
const BIN: f32 = 0.5;
/// Least voxels in a bin.
const ENOUGH: f64 = 8.0;

/// How a survey is divided.
///
/// ```
/// use time::Slabs;
///
/// // All of it fits.
/// assert_eq!(Slabs::within([200, 100, 50], 1 << 30).ranges(), [0..200]);
/// // Slabs overlap by 32 inlines.
/// let slabs = Slabs::within([200, 100, 50], 30 << 20);
/// assert_eq!(slabs.ranges(), [0..116, 84..200]);
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Slabs {
    ranges: Vec<Range<usize>>,
}

impl Slabs {
    /// As few slabs as the memory allows, of about one width; each has at least 96 inlines, whatever the memory.
    pub fn within([nx, ny, nz]: [usize; 3], memory_bytes: u64) -> Self {
        let line = (ny * nz * BYTES).max(1) as u64;
        let most = ((memory_bytes / line) as usize).max(LEAST);
        if nx <= most {
            return Self { ranges: std::iter::once(0..nx).collect() };
        }
        let count = (nx - COMMON).div_ceil(most - COMMON);
        let start = |n: usize| (nx - COMMON) * n / count;
        Self { ranges: (0..count).map(|n| start(n)..start(n + 1) + COMMON).collect() }
    }

    /// Bytes that solving a slab of the least width takes.
    pub fn least_bytes([nx, ny, nz]: [usize; 3]) -> u64 {
        (nx.min(LEAST) * ny * nz * BYTES) as u64
    }

    /// The inlines of each slab.
    pub fn ranges(&self) -> &[Range<usize>] {
        &self.ranges
    }
}

/// The parts of surfaces within a range of inlines, counted from its start.
pub fn surfaces_within(surfaces: &Surfaces, inlines: &Range<usize>) -> Surfaces {
    const OUTSIDE: u32 = u32::MAX;
    let mut part = Surfaces { size: [inlines.len(), surfaces.size[1], surfaces.size[2]], ..Surfaces::default() };
    let mut new = Vec::new();
    for surface in &surfaces.surfaces {
        let (vertices, triangles) = (part.vertices.len() as u32, part.triangles.len() as u32);
        let own = &surfaces.vertices[surface.vertices.start as usize..surface.vertices.end as usize];
        new.clear();
        for vertex in own {
            if inlines.contains(&usize::from(vertex.x)) {
                new.push(part.vertices.len() as u32);
                part.vertices.push(interp::Vertex { x: vertex.x - inlines.start as u16, ..*vertex });
            } else {
                new.push(OUTSIDE);
            }
        }
        if part.vertices.len() as u32 == vertices {
            continue;
        }
        for triangle in &surfaces.triangles[surface.triangles.start as usize..surface.triangles.end as usize] {
            let corners = triangle.map(|v| new[(v - surface.vertices.start) as usize]);
            if !corners.contains(&OUTSIDE) {
                part.triangles.push(corners);
            }
        }
        part.surfaces.push(Surface {
            extremum: surface.extremum,
            vertices: vertices..part.vertices.len() as u32,
            triangles: triangles..part.triangles.len() as u32,
        });
    }
    part
}

/// Joins the τ of slabs, from the first inline to the last.
#[derive(Debug, Clone, Default)]
pub struct JoinedSlabs {
    /// τ of the last lines of the slab before, set by the first slab's clock.
    common: Vec<f32>,
}

impl JoinedSlabs {
    /// Goes on where another one was, whose [`JoinedSlabs::common`] these are.
    pub fn after(common: Vec<f32>) -> Self {
        Self { common }
    }

    /// τ of the last lines of the slab that was taken last, which the next one has too.
    pub fn common(&self) -> &[f32] {
        &self.common
    }

    /// Takes τ of the next slab; returns τ of the lines that are done: all but those that the slab after it has too,
    /// or all of them if it is the last.
    pub fn add(&mut self, tau: &Volume<f32>, is_last: bool) -> Vec<f32> {
        let [nx, ny, nz] = tau.size();
        let line = ny * nz;
        let mut lines = tau.samples().to_vec();
        if !self.common.is_empty() {
            let width = self.common.len();
            if let Some(clock) = ClockMap::new(&self.common, &lines[..width]) {
                lines.iter_mut().for_each(|time| *time = clock.set(*time));
            }
            let count = (width / line).max(1);
            for (n, (new, old)) in lines.iter_mut().zip(&self.common).enumerate() {
                let share = ((n / line) as f32 + 0.5) / count as f32;
                *new = match (old.is_nan(), new.is_nan()) {
                    (true, _) => *new,
                    (_, true) => *old,
                    _ => *old + share * (*new - *old),
                };
            }
        }
        if is_last {
            self.common.clear();
            return lines;
        }
        let done = nx.saturating_sub(COMMON) * line;
        self.common = lines.split_off(done);
        lines
    }
}

/// An increasing function that sets one clock by another.
struct ClockMap {
    /// (own time, the other's), ascending.
    knots: Vec<[f32; 2]>,
}

impl ClockMap {
    /// From the times of the same voxels; `None` where none has both.
    fn new(old: &[f32], new: &[f32]) -> Option<Self> {
        let known = || old.iter().zip(new).filter(|(old, new)| old.is_finite() && new.is_finite());
        let [first, last] = known().fold([f32::INFINITY, f32::NEG_INFINITY], |[a, b], (_, t)| [a.min(*t), b.max(*t)]);
        if first > last {
            return None;
        }
        let mut bins = vec![[0.0f64; 3]; ((last - first) / BIN) as usize + 1];
        for (old, new) in known() {
            let bin = &mut bins[((new - first) / BIN) as usize];
            *bin = [bin[0] + f64::from(*new), bin[1] + f64::from(*old), bin[2] + 1.0];
        }
        let least = ENOUGH.min(bins.iter().map(|bin| bin[2]).fold(0.0, f64::max));
        bins.retain(|bin| bin[2] >= least);
        let mut times: Vec<f32> = bins.iter().map(|bin| (bin[1] / bin[2]) as f32).collect();
        regress(&mut times, |n| bins[n][2] as f32, &mut Pools::default());
        let own = bins.iter().map(|bin| (bin[0] / bin[2]) as f32);
        Some(Self { knots: own.zip(times).map(|(own, other)| [own, other]).collect() })
    }

    /// The other clock's time; beyond the first and the last knot it runs as fast as this one.
    fn set(&self, time: f32) -> f32 {
        if time.is_nan() {
            return time;
        }
        let below = self.knots.partition_point(|knot| knot[0] < time);
        match (below.checked_sub(1).map(|n| self.knots[n]), self.knots.get(below)) {
            (Some(a), Some(b)) => a[1] + (time - a[0]) / (b[0] - a[0]).max(1e-6) * (b[1] - a[1]),
            (Some(only), None) => only[1] + time - only[0],
            (None, Some(only)) => only[1] + time - only[0],
            (None, None) => time,
        }
    }
}
