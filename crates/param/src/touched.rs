//! Which voxel columns each region touches, and how much of the volume it fills there.

use crate::{LayerModel, Region};
use glam::Vec3;
use rayon::prelude::*;
use survey::{Cancelled, Progress};

/// Samples between two looks along a column, voxels: what is thinner than this may be overlooked in one column but
/// not in all those around it, and the mask is widened by [`MARGIN`].
const STRIDE: usize = 4;
/// Columns by which a touched mask is widened, so that every interpolation inside the region has its neighbours.
const MARGIN: usize = 3;

/// The columns of one region.
#[derive(Debug, Clone)]
pub struct Touched {
    /// First column of the bounding box.
    pub origin: [i32; 2],
    /// Columns of the bounding box, 0 when none is touched.
    pub size: [usize; 2],
    /// Per column of the box, whether it is touched or next to one that is.
    pub wanted: Vec<bool>,
}

/// The touched columns of all regions, index `block · layers + layer`.
///
/// # Errors
/// [`Cancelled`].
pub fn touched_columns<M: LayerModel + ?Sized>(model: &M, progress: &Progress) -> Result<Vec<Touched>, Cancelled> {
    let [nx, ny, nz] = model.size();
    let layers = model.layer_count();
    let regions = layers * model.block_count();
    let words = regions.div_ceil(64);
    let mut seen = vec![0u64; nx * ny * words];
    progress.begin("finding the regions", nx as u64);
    seen.par_chunks_mut(ny * words).enumerate().try_for_each(|(x, row)| {
        for (y, bits) in row.chunks_mut(words).enumerate() {
            for z in (0..nz).step_by(STRIDE).chain([nz - 1]) {
                let Region { layer, block } = model.region_at(Vec3::new(x as f32, y as f32, z as f32));
                let region = usize::from(block) * layers + usize::from(layer);
                if region < regions {
                    bits[region / 64] |= 1 << (region % 64);
                }
            }
        }
        progress.step(1)
    })?;
    Ok((0..regions)
        .into_par_iter()
        .map(|region| widen([nx, ny], |x, y| seen[(x * ny + y) * words + region / 64] >> (region % 64) & 1 == 1))
        .collect())
}

fn widen(size: [usize; 2], seen: impl Fn(usize, usize) -> bool) -> Touched {
    let mut low = [usize::MAX; 2];
    let mut high = [0usize; 2];
    for x in 0..size[0] {
        for y in (0..size[1]).filter(|&y| seen(x, y)) {
            low = [low[0].min(x), low[1].min(y)];
            high = [high[0].max(x), high[1].max(y)];
        }
    }
    if low[0] == usize::MAX {
        return Touched { origin: [0; 2], size: [0; 2], wanted: Vec::new() };
    }
    let margin = MARGIN as i32;
    let origin = low.map(|n| n as i32 - margin);
    let grown: [usize; 2] = std::array::from_fn(|axis| high[axis] - low[axis] + 1 + 2 * MARGIN);
    let mut wanted = vec![false; grown[0] * grown[1]];
    for x in low[0]..=high[0] {
        for y in (low[1]..=high[1]).filter(|&y| seen(x, y)) {
            // The square of 2·MARGIN + 1 columns around (x, y), whose first column in the box is (x, y) − low.
            for a in x - low[0]..=x - low[0] + 2 * MARGIN {
                let start = a * grown[1] + (y - low[1]);
                wanted[start..=start + 2 * MARGIN].fill(true);
            }
        }
    }
    Touched { origin, size: grown, wanted }
}
