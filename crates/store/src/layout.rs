//! The division of arrays into chunks and files.

use super::sample::StoredSample;

/// Edge of a chunk of a volume, voxels.
pub const BRICK: usize = 64;

/// Chunks along each edge of a volume's shard: 2³ bricks of float32 are 8 MiB before compression.
const BRICKS_IN_SHARD: usize = 2;

/// Edge of a chunk of a map, nodes.
const MAP_CHUNK: usize = 256;

/// The division of an array into chunks and shards.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ArrayLayout {
    /// Elements along each axis.
    pub shape: Vec<usize>,
    /// Elements of a chunk along each axis.
    pub chunk: Vec<usize>,
    /// Elements of a shard along each axis, multiples of the chunk's; `None`: every chunk is a file.
    pub shard: Option<Vec<usize>>,
    /// Names of the axes.
    pub axes: Vec<String>,
}

impl ArrayLayout {
    /// A volume, `[inline][crossline][sample]`, in bricks of 64³ (less where the volume is smaller).
    pub fn volume(size: [usize; 3]) -> Self {
        let chunk: Vec<usize> = size.iter().map(|&n| n.clamp(1, BRICK)).collect();
        let shard = size.iter().map(|&n| if n > BRICK { BRICK * BRICKS_IN_SHARD } else { n.max(1) }).collect();
        Self { shape: size.into(), chunk, shard: Some(shard), axes: named(&["inline", "crossline", "sample"]) }
    }

    /// A level of a volume's pyramid. Its axes have names of their own, `inline_2` for every second inline and so on, so
    /// that programs that give an axis one length by its name open the group as a whole.
    pub fn level(size: [usize; 3], level: usize) -> Self {
        let layout = Self::volume(size);
        if level == 0 {
            return layout;
        }
        let axes = layout.axes.iter().map(|axis| format!("{axis}_{}", 1u64 << level)).collect();
        Self { axes, ..layout }
    }

    /// A map, `[u][v]`.
    pub fn map(size: [usize; 2], axes: [&str; 2]) -> Self {
        let chunk = size.iter().map(|&n| n.clamp(1, MAP_CHUNK)).collect();
        Self { shape: size.into(), chunk, shard: None, axes: named(&axes) }
    }

    /// A small array that is one chunk.
    pub fn whole(shape: &[usize], axes: &[&str]) -> Self {
        let chunk = shape.iter().map(|&n| n.max(1)).collect();
        Self { shape: shape.into(), chunk, shard: None, axes: named(axes) }
    }

    /// Elements of a file along each axis.
    pub fn file_shape(&self) -> &[usize] {
        self.shard.as_ref().unwrap_or(&self.chunk)
    }

    /// Files along each axis.
    pub fn file_counts(&self) -> Vec<usize> {
        self.shape.iter().zip(self.file_shape()).map(|(&n, &edge)| n.div_ceil(edge)).collect()
    }
}

fn named(axes: &[&str]) -> Vec<String> {
    axes.iter().map(|&axis| axis.to_owned()).collect()
}

/// Copies the box at `start` out of row-major `values` of `shape`, padded to `size` beyond the end.
pub(super) fn gather<T: StoredSample>(values: &[T], shape: &[usize], start: &[usize], size: &[usize]) -> Vec<T> {
    let mut out = Vec::with_capacity(size.iter().product());
    gather_axis(values, shape, start, size, &mut out);
    out
}

/// One axis of [`gather`].
fn gather_axis<T: StoredSample>(values: &[T], shape: &[usize], start: &[usize], size: &[usize], out: &mut Vec<T>) {
    let there = shape[0].saturating_sub(start[0]).min(size[0]);
    if shape.len() == 1 {
        out.extend_from_slice(&values[start[0]..start[0] + there]);
    } else {
        let stride: usize = shape[1..].iter().product();
        for n in start[0]..start[0] + there {
            gather_axis(&values[n * stride..(n + 1) * stride], &shape[1..], &start[1..], &size[1..], out);
        }
    }
    let missing = (size[0] - there) * size[1..].iter().product::<usize>();
    out.resize(out.len() + missing, T::FILL);
}

/// Index along each axis of entry `n` of a row-major grid.
pub(super) fn grid_index(mut n: usize, counts: &[usize]) -> Vec<usize> {
    let mut index = vec![0; counts.len()];
    for axis in (0..counts.len()).rev() {
        index[axis] = n % counts[axis];
        n /= counts[axis];
    }
    index
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_that_reaches_beyond_the_end_is_filled_up() {
        let values: Vec<u8> = (1..=12).collect();
        assert_eq!(gather(&values, &[3, 4], &[1, 2], &[1, 2]), [7, 8]);
        assert_eq!(gather(&values, &[3, 4], &[2, 2], &[2, 3]), [11, 12, 0, 0, 0, 0]);
    }

    #[test]
    fn volumes_are_cut_into_bricks_and_small_ones_into_one() {
        let layout = ArrayLayout::volume([200, 40, 64]);
        assert_eq!(layout.chunk, [64, 40, 64]);
        assert_eq!(layout.shard, Some(vec![128, 40, 64]));
        assert_eq!(layout.file_counts(), [2, 1, 1]);
    }
}
