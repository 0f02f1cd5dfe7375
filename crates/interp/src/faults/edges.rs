//! The rims of a horizon's pieces.
//!
//! A piece is a set of nodes connected along the lattice without a jump. A rim node has a neighbouring trace
//! in the survey that its piece lacks, and is not on the edge of a small hole. The direction out of the piece
//! points away from the mean of the piece's nodes around the rim node; the plane of the rim is fitted to
//! these nodes.

use crate::reassembly::VoxelSheet;
use glam::Vec2;

/// Largest depth difference of neighbouring nodes of one piece, samples.
pub(super) const JUMP: f32 = 5.0;
/// Radius of the neighbourhood to which the plane of a rim is fitted, traces. A larger one is steadier, a
/// smaller one follows folds.
const RADIUS: usize = 6;
/// Gaps with fewer traces are holes; their edges are no rims.
const SMALL_GAP: usize = 60;
/// Fewest nodes of a neighbourhood.
const FEWEST: usize = 12;

/// A node on the rim of a piece.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rim {
    /// Inline and crossline index.
    pub at: [usize; 2],
    /// Horizontal unit vector out of the piece.
    pub out: Vec2,
    /// Sample index of the plane at the node, and its slope, samples per trace.
    pub z: f32,
    pub slope: Vec2,
}

impl Rim {
    /// Position of the node, traces.
    pub(super) fn place(&self) -> Vec2 {
        Vec2::new(self.at[0] as f32, self.at[1] as f32)
    }

    /// Sample index of the plane at a position.
    pub(super) fn z_at(&self, place: Vec2) -> f32 {
        self.z + self.slope.dot(place - self.place())
    }
}

/// The rims of all pieces of a horizon.
pub(super) struct HorizonRims {
    pub size: [usize; 2],
    pub rims: Vec<Rim>,
}

impl HorizonRims {
    /// Finds the rims on each sheet.
    pub(super) fn of(sheets: &[VoxelSheet], size: [usize; 2]) -> Self {
        let rims = sheets.iter().flat_map(|sheet| rims_of(&sheet.z, size)).collect();
        Self { size, rims }
    }
}

fn neighbours(n: usize, [nx, ny]: [usize; 2]) -> impl Iterator<Item = usize> {
    let (x, y) = (n / ny, n % ny);
    [(x > 0).then(|| n - ny), (x + 1 < nx).then(|| n + ny), (y > 0).then(|| n - 1), (y + 1 < ny).then(|| n + 1)]
        .into_iter()
        .flatten()
}

/// Numbers the connected sets of nodes; `joined` returns whether neighbours belong together. Also returns the
/// size of each set.
fn components(size: [usize; 2], joined: impl Fn(usize, usize) -> bool) -> (Vec<u32>, Vec<usize>) {
    let mut label = vec![u32::MAX; size[0] * size[1]];
    let mut sizes = Vec::new();
    let mut stack = Vec::new();
    for start in 0..label.len() {
        if label[start] != u32::MAX || !joined(start, start) {
            continue;
        }
        let number = sizes.len() as u32;
        let mut count = 0;
        label[start] = number;
        stack.push(start);
        while let Some(n) = stack.pop() {
            count += 1;
            for m in neighbours(n, size) {
                if label[m] == u32::MAX && joined(n, m) {
                    label[m] = number;
                    stack.push(m);
                }
            }
        }
        sizes.push(count);
    }
    (label, sizes)
}

/// Numbers the pieces of a sheet; also returns the size of each.
pub(super) fn pieces_of(z: &[f32], size: [usize; 2]) -> (Vec<u32>, Vec<usize>) {
    // Comparisons with NaN are false.
    components(size, |a, b| (z[a] - z[b]).abs() <= JUMP)
}

fn rims_of(z: &[f32], size: [usize; 2]) -> Vec<Rim> {
    let (piece, pieces) = pieces_of(z, size);
    let (gap, gaps) = components(size, |a, b| z[a].is_nan() && z[b].is_nan());
    let is_open = |n: usize, m: usize| {
        if z[m].is_nan() { gaps[gap[m] as usize] >= SMALL_GAP } else { piece[m] != piece[n] }
    };
    let on_rim = |n: &usize| {
        z[*n].is_finite() && pieces[piece[*n] as usize] >= FEWEST && neighbours(*n, size).any(|m| is_open(*n, m))
    };
    (0..z.len()).filter(on_rim).filter_map(|n| rim(n, z, &piece, size)).collect()
}

/// Fits the plane around node `n`; `None` where the nodes around do not determine a plane or a direction.
fn rim(n: usize, z: &[f32], piece: &[u32], [nx, ny]: [usize; 2]) -> Option<Rim> {
    let (x, y) = (n / ny, n % ny);
    let (mut count, mut mean) = (0.0f64, [0.0f64; 3]);
    let mut nodes = Vec::new();
    for i in x.saturating_sub(RADIUS)..=(x + RADIUS).min(nx - 1) {
        for j in y.saturating_sub(RADIUS)..=(y + RADIUS).min(ny - 1) {
            let m = i * ny + j;
            if piece[m] == piece[n] && i.abs_diff(x).pow(2) + j.abs_diff(y).pow(2) <= RADIUS * RADIUS {
                let p = [i as f64 - x as f64, j as f64 - y as f64, f64::from(z[m])];
                (0..3).for_each(|axis| mean[axis] += p[axis]);
                count += 1.0;
                nodes.push(p);
            }
        }
    }
    if nodes.len() < FEWEST {
        return None;
    }
    mean.iter_mut().for_each(|m| *m /= count);
    let mut c = [0.0f64; 5];
    for p in &nodes {
        let [dx, dy, dz] = [0, 1, 2].map(|axis| p[axis] - mean[axis]);
        for (sum, term) in c.iter_mut().zip([dx * dx, dx * dy, dy * dy, dx * dz, dy * dz]) {
            *sum += term;
        }
    }
    let determinant = c[0] * c[2] - c[1] * c[1];
    if determinant < 0.05 * c[0] * c[2] {
        return None;
    }
    let slope = [(c[3] * c[2] - c[4] * c[1]) / determinant, (c[4] * c[0] - c[3] * c[1]) / determinant];
    let out = Vec2::new(-mean[0] as f32, -mean[1] as f32);
    // A rim node lies far from the mean of the nodes around it. A node near the mean sits in a notch and has
    // no direction out.
    (out.length() > 0.15 * RADIUS as f32).then(|| Rim {
        at: [x, y],
        out: out.normalize(),
        z: (mean[2] - slope[0] * mean[0] - slope[1] * mean[1]) as f32,
        slope: Vec2::new(slope[0] as f32, slope[1] as f32),
    })
}
