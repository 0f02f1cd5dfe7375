//! Faults as cuts: for every line along strike and every sample, the place across at which the fault runs.
//!
//! A steep fault is a function of (line along it, sample): across inlines `x = X(y, z)`, across crosslines
//! `y = Y(x, z)`, and no place where there is no fault, so that a fault may end inside the volume. Two points are
//! separated when both lie where the fault exists and on different sides of it. Space: voxels.

use faults::Sheet;
use glam::{DVec3, Vec3};
use model::FaultNetwork;
use rayon::prelude::*;

/// Share of a trace by which what can be stepped over is cut short: sides are rounded.
const ROUNDED: f32 = 0.05;
/// Rounds in which the place of a found surface on a line settles.
const SETTLED: usize = 8;

/// The axis across which a fault runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Across {
    /// A fault `x = X(y, z)`: it is crossed from inline to inline.
    Inlines,
    /// A fault `y = Y(x, z)`: it is crossed from crossline to crossline.
    Crosslines,
}

/// A fault that cuts the volume.
///
/// ```
/// use time::{Across, Cut};
///
/// // A plane that leans by half a trace a sample, on 4 lines and 10 samples.
/// let cut = Cut::new(Across::Inlines, 4, 10, |_, z| 5.0 + 0.5 * z as f32);
/// assert_eq!(cut.side([7, 1], 2.0), 1.0);
/// assert!(cut.separates([6, 1], 1.0, [5, 1], 1.0));
/// assert!(!cut.separates([6, 1], 5.0, [5, 1], 5.0));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Cut {
    /// The axis across.
    pub across: Across,
    /// Count of lines along it, and of samples.
    pub size: [usize; 2],
    /// Place across, `[line along][sample]`; NaN where there is no fault.
    pub place: Vec<f32>,
}

impl Cut {
    /// The cut whose place is `place(line along, sample)`.
    pub fn new(across: Across, lines: usize, samples: usize, place: impl Fn(usize, usize) -> f32) -> Self {
        let all = (0..lines).flat_map(|line| (0..samples).map(move |z| (line, z)));
        Self { across, size: [lines, samples], place: all.map(|(line, z)| place(line, z)).collect() }
    }

    /// Place across on a line along the fault at a fractional sample; NaN where there is no fault.
    #[inline]
    pub fn at(&self, line: usize, z: f32) -> f32 {
        let last = self.size[1] - 1;
        let z = z.clamp(0.0, last as f32);
        let low = (z as usize).min(last.saturating_sub(1));
        let row = line * self.size[1];
        let (a, b) = (self.place[row + low], self.place[row + (low + 1).min(last)]);
        a + (z - low as f32) * (b - a)
    }

    /// Place across and line along the fault of a trace.
    #[inline]
    pub fn split(&self, [x, y]: [usize; 2]) -> [usize; 2] {
        match self.across {
            Across::Inlines => [x, y],
            Across::Crosslines => [y, x],
        }
    }

    /// The trace at a place across and on a line along the fault.
    #[inline]
    pub fn trace(&self, across: usize, line: usize) -> [usize; 2] {
        self.split([across, line])
    }

    /// Signed distance across of a point of trace `[x, y]`, traces; NaN where there is no fault.
    #[inline]
    pub fn side(&self, trace: [usize; 2], z: f32) -> f32 {
        let [across, line] = self.split(trace);
        across as f32 - self.at(line, z)
    }

    /// Least and greatest place across on each line along the fault; none lies between them where there is no fault.
    pub(crate) fn extents(&self) -> Vec<[f32; 2]> {
        let none = [f32::INFINITY, f32::NEG_INFINITY];
        let both = |[least, most]: [f32; 2], place: &f32| [least.min(*place), most.max(*place)];
        self.place.chunks(self.size[1].max(1)).map(|row| row.iter().fold(none, both)).collect()
    }

    /// Whether the fault lies between two points that it both has a side for.
    #[inline]
    pub fn separates(&self, a: [usize; 2], za: f32, b: [usize; 2], zb: f32) -> bool {
        let (a, b) = (self.side(a, za), self.side(b, zb));
        // A comparison with NaN is false.
        (a > 0.0 && b <= 0.0) || (a <= 0.0 && b > 0.0)
    }

    /// The cut of a surface that was found in a volume of a size.
    pub fn of_sheet(sheet: &Sheet, [nx, ny, nz]: [usize; 3]) -> Self {
        let frame = sheet.frame;
        let across = if frame.across[0].abs() >= frame.across[1].abs() { Across::Inlines } else { Across::Crosslines };
        let (axis, lines) = if across == Across::Inlines { (1, ny) } else { (0, nx) };
        let place = |line: usize, z: usize| {
            let z = z as f32;
            let on_line =
                |height: f32| (line as f32 - frame.origin[axis] - height * frame.across[axis]) / frame.along[axis];
            let u = (0..SETTLED).fold(on_line(0.0), |u, _| on_line(sheet.height_at(u, z)));
            if sheet.is_there(u, z) { frame.lines(u, sheet.height_at(u, z))[1 - axis] } else { f32::NAN }
        };
        Self::new(across, lines, nz, place)
    }

    /// The cuts of the faults of a network, where these were interpreted. A fault runs across the axis that
    /// its normal is closer to; one that is crossed twice on a line is cut at the first crossing.
    pub fn of_network(faults: &FaultNetwork, [nx, ny, nz]: [usize; 3]) -> Vec<Self> {
        (0..faults.surfaces().len())
            .map(|f| {
                let middle = DVec3::new(nx as f64, ny as f64, nz as f64) / 2.0;
                let normal = faults.surfaces()[f].side_gradient(middle);
                let across = if normal.x.abs() >= normal.y.abs() { Across::Inlines } else { Across::Crosslines };
                let (count, lines) = if across == Across::Inlines { (nx, ny) } else { (ny, nx) };
                let point = |at: f32, line: usize, z: usize| match across {
                    Across::Inlines => Vec3::new(at, line as f32, z as f32),
                    Across::Crosslines => Vec3::new(line as f32, at, z as f32),
                };
                let most = faults.most_change(f, point(1.0, 0, 0));
                let place = |line: usize, z: usize| {
                    let side = |at: usize| faults.side(f, point(at as f32, line, z));
                    let (mut at, mut before) = (0, side(0));
                    while at + 1 < count {
                        // So many traces on it cannot have changed its sign.
                        let far = ((before.abs() / most - ROUNDED) as usize).min(count - 1 - at);
                        at += far.max(1);
                        let after = side(at);
                        if far > 0 {
                            before = after;
                            continue;
                        }
                        if (before > 0.0) != (after > 0.0) {
                            let place = at as f32 - after / (after - before);
                            let p = point(place, line, z);
                            let exists = faults.existing(faults.bits_at(p)) >> f & 1 == 1;
                            return if exists && faults.is_real(f, p) { place } else { f32::NAN };
                        }
                        before = after;
                    }
                    f32::NAN
                };
                let all = (0..lines * nz).into_par_iter().map(|n| place(n / nz, n % nz)).collect();
                Self { across, size: [lines, nz], place: all }
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use survey::{Fault, Progress, SurveyGeometry, TriangleMesh, VerticalUnit};

    #[test]
    fn a_fault_of_a_network_is_cut_at_its_first_crossing_of_every_line() {
        let size = [40, 36, 50];
        let geometry = SurveyGeometry::regular(size, 25.0, 10.0, VerticalUnit::Metres);
        // One that waves by ten traces and is crossed several times on some lines, and a plain one that dips the other way.
        let fault = |name: &str, x: &dyn Fn(f64, f64) -> f64| {
            let at = |n: usize| {
                let (y, z) = ((n / 13) as f64 * 3.0, (n % 13) as f64 * 4.0);
                geometry.world_from_voxel(DVec3::new(x(y, z), y, z))
            };
            let cell = |n: usize| [[n, n + 13, n + 14], [n, n + 14, n + 1]].map(|t| t.map(|corner| corner as u32));
            let triangles = (0..12 * 13).filter(|n| n % 13 < 12).flat_map(cell).collect();
            Fault::new(name, TriangleMesh { vertices: (0..13 * 13).map(at).collect(), triangles })
        };
        let waving = fault("waving", &|y, z| 14.0 + 10.0 * (0.3 * y + 0.05 * z).sin() + 0.1 * z);
        let plain = fault("plain", &|y, z| 30.0 - 0.15 * y - 0.2 * (z - 25.0));
        let network = FaultNetwork::build(&geometry, &[waving, plain], &Progress::silent()).unwrap();
        let cuts = Cut::of_network(&network, size);
        let mut crossed = 0;
        for (f, cut) in cuts.iter().enumerate() {
            let count = if cut.across == Across::Inlines { size[0] } else { size[1] };
            for (line, z) in (0..cut.size[0]).flat_map(|line| (0..50).map(move |z| (line, z))) {
                let side = |at: usize| {
                    let [x, y] = cut.trace(at, line).map(|at| at as f32);
                    network.side(f, Vec3::new(x, y, z as f32))
                };
                let first = (1..count).find(|&at| (side(at - 1) > 0.0) != (side(at) > 0.0));
                let place = cut.place[line * 50 + z];
                let is_there = first.is_some_and(|at| (place - at as f32 + 0.5).abs() <= 0.5);
                assert!(place.is_nan() || is_there, "{f} {line} {z}: {place}, not {first:?}");
                crossed += usize::from(place.is_finite());
            }
        }
        assert!(crossed > 1500, "{crossed}");
    }

    #[test]
    fn a_fault_that_ends_separates_nothing_beyond_its_tip() {
        let cut = Cut::new(Across::Crosslines, 6, 4, |x, _| if x < 3 { 2.5 } else { f32::NAN });
        assert!(cut.separates([2, 2], 1.0, [2, 3], 1.0));
        assert!(!cut.separates([3, 2], 1.0, [3, 3], 1.0), "beyond the tip");
        assert!(!cut.separates([2, 3], 0.0, [2, 5], 3.0), "the same side");
    }
}
