//! A volume of which only some cells are in memory: those that a picture of faces or sections needs.

use crate::volume::Volume;
use std::sync::atomic::{AtomicBool, Ordering};

/// Samples of a cell along each axis.
pub const CELL: usize = 8;

/// Samples of a cell.
const CELL_SAMPLES: usize = CELL * CELL * CELL;

/// Number of a cell that is not there.
const NONE: u32 = u32::MAX;

/// Samples on a lattice, some 8³ cells of them. Memory: 4 bytes for each sample of these cells, 4 for each cell of all, and
/// one for each trace.
///
/// ```
/// use survey::{SparseVolume, Volume};
///
/// let whole = Volume::from_samples([9, 2, 3], (0..54u8).map(f32::from).collect())?;
/// // Two cells along x, of which the second one is wanted.
/// let mut part = SparseVolume::new([9, 2, 3], &[false, true], None);
/// part.fill([0; 3], &whole);
/// assert_eq!((part.at(8, 1, 2), part.has_missed()), (whole.at(8, 1, 2), false));
/// // Whoever asks for a sample that is not there can be told.
/// assert!(part.at(0, 0, 0).is_nan() && part.has_missed());
/// # Ok::<(), survey::volume::SizeMismatch>(())
/// ```
#[derive(Debug)]
pub struct SparseVolume {
    size: [usize; 3],
    cells: [usize; 3],
    /// Number of each cell among those that are there.
    slots: Vec<u32>,
    samples: Vec<f32>,
    live: Option<Vec<bool>>,
    missed: AtomicBool,
}

impl SparseVolume {
    /// Counts of cells of a lattice.
    pub fn cell_counts(size: [usize; 3]) -> [usize; 3] {
        size.map(|count| count.div_ceil(CELL))
    }

    /// Bytes that so many cells of a lattice take.
    pub fn bytes(size: [usize; 3], wanted: usize) -> u64 {
        let cells = Self::cell_counts(size).map(|count| count as u64);
        cells.iter().product::<u64>() * 4 + wanted as u64 * (CELL_SAMPLES * size_of::<f32>()) as u64
    }

    /// Room for the cells that are `wanted`, `[x][y][z]`; `live` is the mask of live traces.
    pub fn new(size: [usize; 3], wanted: &[bool], live: Option<Vec<bool>>) -> Self {
        let mut count = 0;
        let mut slot = |wanted: &bool| {
            count += u32::from(*wanted);
            if *wanted { count - 1 } else { NONE }
        };
        let slots: Vec<u32> = wanted.iter().map(&mut slot).collect();
        let samples = vec![f32::NAN; count as usize * CELL_SAMPLES];
        Self { size, cells: Self::cell_counts(size), slots, samples, live, missed: AtomicBool::new(false) }
    }

    /// Takes over the samples of a box that begins at `start`, where there is room for them.
    pub fn fill(&mut self, start: [usize; 3], part: &Volume<f32>) {
        let size = part.size();
        let first = start.map(|at| at / CELL);
        let end = [0, 1, 2].map(|axis| (start[axis] + size[axis]).div_ceil(CELL).min(self.cells[axis]));
        for (x, y, z) in (first[0]..end[0])
            .flat_map(|x| (first[1]..end[1]).map(move |y| (x, y)))
            .flat_map(|(x, y)| (first[2]..end[2]).map(move |z| (x, y, z)))
        {
            let slot = self.slots[(x * self.cells[1] + y) * self.cells[2] + z];
            if slot == NONE {
                continue;
            }
            let own = |axis: usize, cell: usize| {
                (cell * CELL).max(start[axis])..((cell + 1) * CELL).min(start[axis] + size[axis])
            };
            let deep = own(2, z);
            for i in own(0, x) {
                for j in own(1, y) {
                    let trace = &part.trace(i - start[0], j - start[1])[deep.start - start[2]..deep.end - start[2]];
                    let to = slot as usize * CELL_SAMPLES + (i % CELL * CELL + j % CELL) * CELL + deep.start % CELL;
                    self.samples[to..to + trace.len()].copy_from_slice(trace);
                }
            }
        }
    }

    /// `[inlines, crosslines, samples]`.
    pub fn size(&self) -> [usize; 3] {
        self.size
    }

    /// Whether the trace at (x, y) was recorded.
    pub fn is_live(&self, x: usize, y: usize) -> bool {
        self.live.as_ref().is_none_or(|mask| mask[x * self.size[1] + y])
    }

    /// The sample at (x, y, z); NaN, which is noted, where it is not there.
    pub fn at(&self, x: usize, y: usize, z: usize) -> f32 {
        let slot = self.slots[(x / CELL * self.cells[1] + y / CELL) * self.cells[2] + z / CELL];
        if slot == NONE {
            self.missed.store(true, Ordering::Relaxed);
            return f32::NAN;
        }
        self.samples[slot as usize * CELL_SAMPLES + (x % CELL * CELL + y % CELL) * CELL + z % CELL]
    }

    /// Whether a sample was asked for that is not there.
    pub fn has_missed(&self) -> bool {
        self.missed.load(Ordering::Relaxed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_that_cut_cells_fill_them_together() {
        let size = [11, 19, 21];
        let samples = (0..size.iter().product::<usize>()).map(|n| n as f32).collect();
        let whole = Volume::from_samples(size, samples).unwrap();
        let counts = SparseVolume::cell_counts(size);
        let wanted: Vec<bool> = (0..counts.iter().product()).map(|n: usize| n % 3 != 1).collect();
        let mut sparse = SparseVolume::new(size, &wanted, None);
        for (start, part) in [([0, 0, 0], [11, 5, 21]), ([0, 5, 0], [11, 14, 9]), ([0, 5, 9], [11, 14, 12])] {
            sparse.fill(start, &crate::source::BoxSource::read_box(&whole, start, part).unwrap());
        }
        assert!(!sparse.has_missed());
        for n in 0..whole.samples().len() {
            let [x, y, z] = [n / size[2] / size[1], n / size[2] % size[1], n % size[2]];
            let cell = (x / CELL * counts[1] + y / CELL) * counts[2] + z / CELL;
            let found = sparse.at(x, y, z);
            assert!(if wanted[cell] { found == whole.at(x, y, z) } else { found.is_nan() }, "{x} {y} {z}");
        }
        assert!(sparse.has_missed());
    }
}
