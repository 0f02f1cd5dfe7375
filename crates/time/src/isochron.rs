//! Isochrons: the places at which τ has one value.
//!
//! On a trace τ does not decrease but at faults, where older rock may lie on younger (a reverse fault), so an isochron
//! crosses a trace at most once between two faults. Space: voxels.

use rayon::prelude::*;
use survey::Volume;

/// One place at which an isochron crosses a trace.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// Inline index.
    pub x: u16,
    /// Crossline index.
    pub y: u16,
    /// Fractional sample.
    pub z: f32,
}

/// A level of τ: its crossings ordered by (x, y, z).
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Isochron {
    /// The value of τ.
    pub time: f32,
    /// Where it is.
    pub crossings: Vec<Crossing>,
}

/// Finds where τ, a volume that is NaN where it is not known, has the value `time`.
///
/// ```
/// use survey::Volume;
/// use time::isochron;
///
/// // Layers that dip by half a sample a trace: τ = z − x/2.
/// let samples = (0..3 * 8).map(|n| (n % 8) as f32 - 0.5 * (n / 8) as f32).collect();
/// let volume = Volume::from_samples([3, 1, 8], samples).unwrap();
/// let depths: Vec<f32> = isochron(&volume, 2.25).crossings.iter().map(|at| at.z).collect();
/// assert_eq!(depths, [2.25, 2.75, 3.25]);
/// ```
pub fn isochron(tau: &Volume<f32>, time: f32) -> Isochron {
    let [nx, ny, _] = tau.size();
    let crossings = (0..nx)
        .into_par_iter()
        .flat_map_iter(|x| (0..ny).flat_map(move |y| crossings(tau.trace(x, y), time).map(move |z| (x, y, z))))
        .map(|(x, y, z)| Crossing { x: x as u16, y: y as u16, z })
        .collect();
    Isochron { time, crossings }
}

/// The depths at which a trace of τ rises through `time`.
pub(crate) fn crossings(trace: &[f32], time: f32) -> impl Iterator<Item = f32> + '_ {
    // NaN compares as false.
    let crossed = trace.windows(2).enumerate().filter(move |(_, pair)| pair[0] <= time && pair[1] > time);
    crossed.map(move |(z, pair)| z as f32 + (time - pair[0]) / (pair[1] - pair[0]))
}
