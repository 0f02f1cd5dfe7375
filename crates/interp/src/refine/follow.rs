//! Holes filled along the reflection: from the rim inwards, always on where neighbouring traces are most alike, as long
//! as they are. The surface of least curvature is the guide: it says what dip to expect, and how far is too far.

use crate::holes::{FillSettings, Filled, Hole, fill_holes, find_holes};
use crate::reassembly::VoxelSheet;
use crate::refine::reflection::{MOST_SEAM, MOST_STEP, TraceBox, TraceStep, WINDOW, neighbours};
use glam::Vec3;
use model::FaultNetwork;
use std::collections::BinaryHeap;
use survey::{Cancelled, Progress, Quality, Volume};

/// Samples by which it may leave the guide: beyond, it is another reflection.
const REACH: f32 = 12.0;
/// Correlation from which two traces show the same reflection. Lower follows noise, higher stops where amplitudes change.
const ALIKE: f32 = 0.75;

/// Fills the holes of all sheets along the reflection where neighbouring traces show one (nodes of
/// [`Quality::Tracked`]), and with the surface of least curvature elsewhere, as [`fill_holes`]. `read` gives the samples
/// of a box of voxels by its first corner and its size.
///
/// # Errors
/// Those of `read`, or cancelled.
pub fn fill_along<E: From<Cancelled>>(
    sheets: &mut [VoxelSheet],
    size: [usize; 3],
    blocks: &FaultNetwork,
    settings: &FillSettings,
    mut read: impl FnMut([usize; 3], [usize; 3]) -> Result<Volume<f32>, E>,
    progress: &Progress,
) -> Result<Filled, E> {
    let plane = [size[0], size[1]];
    let mut guides = sheets.to_vec();
    let guided = fill_holes(&mut guides, plane, blocks, settings, progress)?;
    let (mut holes, mut along) = (0, 0);
    for (index, guide) in guides.iter().enumerate() {
        // Only the first sheet of a block has holes; another one finds none of its own here.
        let is_first = sheets.iter().position(|other| other.block == guide.block) == Some(index);
        for hole in find_holes(&sheets[index..=index], plane).into_iter().filter(|_| is_first) {
            if settings.max_traces.is_some_and(|most| hole.traces > most) {
                continue;
            }
            holes += 1;
            let sheet = &mut sheets[index];
            let Some((first, extent)) = box_around(&hole, guide, size) else { continue };
            let samples = TraceBox { samples: read(first, extent)?, first, crosslines: size[1] };
            let front = Front { samples, guide, blocks, size };
            along += front.advance(sheet, &hole);
        }
    }
    let rest = fill_holes(sheets, plane, blocks, settings, progress)?;
    Ok(Filled { holes, nodes: rest.nodes + along, along, across_faults: rest.across_faults, left: guided.left })
}

/// The voxels that following through a hole may read: first corner and size.
fn box_around(hole: &Hole, guide: &VoxelSheet, [nx, ny, nz]: [usize; 3]) -> Option<([usize; 3], [usize; 3])> {
    let (mut low, mut high) = ([usize::MAX; 2], [0; 2]);
    let mut depths = [f32::INFINITY, f32::NEG_INFINITY];
    for &n in hole.nodes() {
        for trace in [n as usize].into_iter().chain(neighbours(n as usize, [nx, ny])) {
            for (axis, at) in [trace / ny, trace % ny].into_iter().enumerate() {
                (low[axis], high[axis]) = (low[axis].min(at), high[axis].max(at));
            }
            let z = guide.z[trace];
            if z.is_finite() {
                depths = [depths[0].min(z), depths[1].max(z)];
            }
        }
    }
    let margin = REACH + (WINDOW + MOST_STEP + 2) as f32;
    let top = (depths[0] - margin).max(0.0) as usize;
    let bottom = ((depths[1] + margin).max(0.0) as usize).min(nz - 1);
    (depths[0].is_finite() && top < bottom)
        .then(|| ([low[0], low[1], top], [high[0] + 1 - low[0], high[1] + 1 - low[1], bottom + 1 - top]))
}

/// What following through one hole needs.
struct Front<'a> {
    samples: TraceBox,
    guide: &'a VoxelSheet,
    blocks: &'a FaultNetwork,
    size: [usize; 3],
}

impl Front<'_> {
    /// Follows the reflection from the rim of a hole; returns the number of nodes made.
    fn advance(&self, sheet: &mut VoxelSheet, hole: &Hole) -> usize {
        let plane = [self.size[0], self.size[1]];
        let is_inside = |n: usize| hole.nodes().binary_search(&(n as u32)).is_ok();
        let mut front = BinaryHeap::new();
        let rim = hole.nodes().iter().flat_map(|&n| neighbours(n as usize, plane).map(move |from| (from, n as usize)));
        for (from, to) in rim.filter(|(from, _)| sheet.z[*from].is_finite()) {
            front.extend(self.step(from, sheet.z[from], to));
        }
        let mut made = Vec::new();
        while let Some(TraceStep { to, z, .. }) = front.pop() {
            if sheet.z[to].is_finite() {
                continue;
            }
            sheet.z[to] = z;
            made.push(to);
            for next in neighbours(to, plane).filter(|next| is_inside(*next) && sheet.z[*next].is_nan()) {
                front.extend(self.step(to, z, next));
            }
        }
        let off = |n: usize| sheet.z[n] - self.guide.z[n];
        let torn = |n: usize| neighbours(n, plane).any(|other| (off(other) - off(n)).abs() > MOST_SEAM);
        let torn: Vec<usize> = made.iter().copied().filter(|&n| torn(n)).collect();
        torn.iter().for_each(|&n| sheet.z[n] = f32::NAN);
        made.iter().filter(|&&n| sheet.z[n].is_finite()).for_each(|&n| sheet.quality[n] = Quality::Tracked);
        made.len() - torn.len()
    }

    /// The reflection that is at `z` on one trace, on a neighbouring trace.
    fn step(&self, from: usize, z: f32, to: usize) -> Option<TraceStep> {
        let expected = z + self.guide.z[to] - self.guide.z[from];
        if !expected.is_finite() {
            return None;
        }
        let TraceStep { alike, z, .. } = self.samples.step((from, z), to, expected, ALIKE)?;
        let place = Vec3::new((to / self.size[1]) as f32, (to % self.size[1]) as f32, z);
        let is_near = (z - self.guide.z[to]).abs() <= REACH;
        (is_near && self.blocks.holds(self.guide.block, place)).then_some(TraceStep { alike, to, z })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: [usize; 3] = [40, 36, 80];

    /// A dome that no smooth surface from its foot up would guess.
    fn dome(x: usize, y: usize) -> f32 {
        let square = (x as f32 - 20.0).powi(2) + (y as f32 - 18.0).powi(2);
        44.0 - 7.0 * (-square / 40.0).exp()
    }

    fn is_missing(x: usize, y: usize) -> bool {
        x.abs_diff(20).pow(2) + y.abs_diff(18).pow(2) <= 100
    }

    fn volume(amplitude: impl Fn(usize, usize) -> f32) -> Volume<f32> {
        let mut volume = Volume::filled(SIZE, 0.0);
        for (x, y) in (0..SIZE[0]).flat_map(|x| (0..SIZE[1]).map(move |y| (x, y))) {
            for (k, sample) in volume.trace_mut(x, y).iter_mut().enumerate() {
                let off = (k as f32 - dome(x, y)) / 3.0;
                *sample = amplitude(x, y) * (1.0 - 2.0 * off * off) * (-off * off).exp();
            }
        }
        volume
    }

    fn holed() -> VoxelSheet {
        let mut sheet = VoxelSheet::empty(0, SIZE[0] * SIZE[1]);
        for n in 0..sheet.z.len() {
            let (x, y) = (n / SIZE[1], n % SIZE[1]);
            if !is_missing(x, y) {
                (sheet.z[n], sheet.quality[n]) = (dome(x, y), Quality::Picked);
            }
        }
        sheet
    }

    fn filled(volume: &Volume<f32>, settings: &FillSettings) -> (Filled, VoxelSheet) {
        let mut sheets = [holed()];
        let read = |first: [usize; 3], extent: [usize; 3]| -> Result<Volume<f32>, Cancelled> {
            let mut part = Volume::filled(extent, 0.0);
            for (x, y) in (0..extent[0]).flat_map(|x| (0..extent[1]).map(move |y| (x, y))) {
                let trace = volume.trace(first[0] + x, first[1] + y);
                part.trace_mut(x, y).copy_from_slice(&trace[first[2]..first[2] + extent[2]]);
            }
            Ok(part)
        };
        let none = FaultNetwork::none();
        let done = fill_along(&mut sheets, SIZE, &none, settings, read, &Progress::silent()).unwrap();
        let [sheet] = sheets;
        (done, sheet)
    }

    fn worst(sheet: &VoxelSheet) -> f32 {
        let off = sheet.z.iter().enumerate().map(|(n, z)| (z - dome(n / SIZE[1], n % SIZE[1])).abs());
        off.fold(0.0, f32::max)
    }

    #[test]
    fn the_reflection_is_followed_where_a_smooth_surface_would_miss_it() {
        let volume = volume(|x, _| 1.0 + 0.02 * x as f32);
        let (done, sheet) = filled(&volume, &FillSettings::default());
        assert_eq!((done.holes, done.left), (1, 0));
        assert_eq!(done.nodes, done.along, "a reflection is there throughout");
        assert!(worst(&sheet) < 0.5, "off by {}", worst(&sheet));
        let mut plain = [holed()];
        let settings = FillSettings::default();
        fill_holes(&mut plain, [SIZE[0], SIZE[1]], &FaultNetwork::none(), &settings, &Progress::silent()).unwrap();
        assert!(worst(&plain[0]) > 2.0, "the smooth surface is off by {}", worst(&plain[0]));
    }

    #[test]
    fn where_nothing_reflects_the_smooth_surface_fills() {
        let (done, sheet) = filled(&volume(|x, _| if x < 20 { 1.0 } else { 0.0 }), &FillSettings::default());
        assert!(done.along > 50 && done.along < done.nodes, "{done:?}");
        for (n, quality) in sheet.quality.iter().enumerate().filter(|(n, _)| is_missing(n / SIZE[1], n % SIZE[1])) {
            let wanted = if n / SIZE[1] < 20 { Quality::Tracked } else { Quality::Filled };
            assert_eq!(*quality, wanted, "inline {}", n / SIZE[1]);
        }
        let large = FillSettings { max_traces: Some(100), ..FillSettings::default() };
        let (done, sheet) = filled(&volume(|_, _| 1.0), &large);
        assert_eq!((done.left, done.nodes), (1, 0));
        assert_eq!(sheet.nodes(), holed().nodes());
    }
}
