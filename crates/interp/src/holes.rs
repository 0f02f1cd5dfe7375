//! Holes of assembled sheets: finding them, and filling them on request with the surface of least curvature.
//!
//! A **hole** is a connected set of traces without a node that the nodes of its sheet enclose. A gap that
//! reaches the outer boundary, or the side on which a fault ends the sheet, is no hole. Only the first sheet
//! of each fault block is examined. Space: voxels.

mod fill;
#[cfg(test)]
mod tests;

use crate::reassembly::VoxelSheet;
use fill::Plate;
use glam::Vec3;
use model::FaultNetwork;
use serde::{Deserialize, Serialize};
use survey::{Cancelled, Progress, Quality};

/// A hole in a sheet.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Hole {
    /// Fault block of the sheet.
    pub block: u16,
    /// Count of traces without a node.
    pub traces: usize,
    /// Inline and crossline index of the trace that is closest to the middle of the hole.
    pub at: [usize; 2],
    #[serde(skip)]
    sheet: usize,
    #[serde(skip)]
    nodes: Vec<u32>,
}

impl Hole {
    /// The traces of the hole, as inline index · crosslines + crossline index, ascending.
    pub fn nodes(&self) -> &[u32] {
        &self.nodes
    }
}

/// Settings of filling.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct FillSettings {
    /// Holes with more traces are not filled; `None` (default) fills all.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_traces: Option<usize>,
    /// Whether the reflection is followed through holes, where there is one ([`Filled::along`]); the surface of least
    /// curvature fills the rest.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub along_reflection: bool,
}

/// The result of filling.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct Filled {
    /// Count of holes filled.
    pub holes: usize,
    /// Count of nodes made.
    pub nodes: usize,
    /// Count of those that follow the reflection.
    pub along: usize,
    /// Count of traces left empty because the surface would have left its fault block there.
    pub across_faults: usize,
    /// Count of holes left because they are larger than [`FillSettings::max_traces`].
    pub left: usize,
}

/// The holes of all sheets, largest first. `size` is `[inlines, crosslines]`.
///
/// ```
/// use interp::holes::find_holes;
/// use interp::reassembly::VoxelSheet;
///
/// // A flat sheet of 5 × 5 traces without its middle node and without a node at the outer boundary.
/// let mut sheet = VoxelSheet::empty(0, 25);
/// sheet.z.fill(7.0);
/// (sheet.z[12], sheet.z[0]) = (f32::NAN, f32::NAN);
/// let holes = find_holes(&[sheet], [5, 5]);
/// assert_eq!(holes.len(), 1);
/// assert_eq!((holes[0].traces, holes[0].at), (1, [2, 2]));
/// ```
pub fn find_holes(sheets: &[VoxelSheet], size: [usize; 2]) -> Vec<Hole> {
    let mut holes = Vec::new();
    for (index, sheet) in sheets.iter().enumerate() {
        let first = sheets.iter().position(|other| other.block == sheet.block) == Some(index);
        if first {
            enclosed(index, sheet, size, &mut holes);
        }
    }
    holes.sort_by_key(|hole| (std::cmp::Reverse(hole.traces), hole.block, hole.at));
    holes
}

/// The holes of one sheet.
fn enclosed(index: usize, sheet: &VoxelSheet, [nx, ny]: [usize; 2], holes: &mut Vec<Hole>) {
    let mut seen: Vec<bool> = sheet.z.iter().map(|z| z.is_finite()).collect();
    let mut stack = Vec::new();
    for start in 0..seen.len() {
        if seen[start] {
            continue;
        }
        seen[start] = true;
        stack.push(start);
        let (mut nodes, mut open) = (Vec::new(), false);
        while let Some(n) = stack.pop() {
            nodes.push(n as u32);
            let (x, y) = (n / ny, n % ny);
            open |= x == 0 || y == 0 || x + 1 == nx || y + 1 == ny;
            let neighbours = [
                (x > 0).then(|| n - ny),
                (x + 1 < nx).then(|| n + ny),
                (y > 0).then(|| n - 1),
                (y + 1 < ny).then(|| n + 1),
            ];
            for m in neighbours.into_iter().flatten() {
                if !seen[m] {
                    seen[m] = true;
                    stack.push(m);
                }
            }
        }
        if open {
            continue;
        }
        nodes.sort_unstable();
        let place = |n: u32| [n as usize / ny, n as usize % ny];
        let count = nodes.len() as f64;
        let mean = [0, 1].map(|axis| nodes.iter().map(|&n| place(n)[axis] as f64).sum::<f64>() / count);
        let off = |n: u32| (0..2).map(|axis| (place(n)[axis] as f64 - mean[axis]).powi(2)).sum::<f64>();
        let middle = nodes.iter().copied().min_by(|&a, &b| off(a).total_cmp(&off(b)));
        let middle = middle.expect("a hole has at least the trace that its search started at");
        holes.push(Hole { block: sheet.block, traces: nodes.len(), at: place(middle), sheet: index, nodes });
    }
}

/// Fills the holes of all sheets. New nodes get [`Quality::Filled`]. A node that would lie in another fault
/// block is not made: the surface ends at the fault, on each side separately. `size` is `[inlines,
/// crosslines]`.
///
/// # Errors
/// [`Cancelled`].
pub fn fill_holes(
    sheets: &mut [VoxelSheet],
    size: [usize; 2],
    blocks: &FaultNetwork,
    settings: &FillSettings,
    progress: &Progress,
) -> Result<Filled, Cancelled> {
    let holes = find_holes(sheets, size);
    progress.begin("filling holes", holes.len() as u64);
    let mut filled = Filled::default();
    for hole in holes {
        progress.step(1)?;
        if settings.max_traces.is_some_and(|most| hole.traces > most) {
            filled.left += 1;
            continue;
        }
        let sheet = &mut sheets[hole.sheet];
        let heights = Plate::over(&sheet.z, size, &hole.nodes).solve(progress)?;
        filled.holes += 1;
        for (&n, z) in hole.nodes.iter().zip(heights) {
            let n = n as usize;
            let at = Vec3::new((n / size[1]) as f32, (n % size[1]) as f32, z);
            if blocks.block_at(at) == sheet.block {
                sheet.z[n] = z;
                sheet.quality[n] = Quality::Filled;
                filled.nodes += 1;
            } else {
                filled.across_faults += 1;
            }
        }
    }
    Ok(filled)
}
