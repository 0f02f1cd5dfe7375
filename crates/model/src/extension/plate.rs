//! The thin plate over the unknown nodes, solved from coarse to fine.
//!
//! Energy on a grid: Σ (δ²ₓh)² + 2(δₓδ_yh)² + (δ²_yh)² over every stencil that fits in the grid, so that its
//! border is free and planes cost nothing. Two rings of known nodes around the unknown ones carry the values
//! of the fits, which clamps the plate. Level l has every 2^l-th node.

use super::local_fit::LocalFits;

/// A grid whose longer side has no more nodes than this is solved directly. Larger is more exact far from
/// data and slower (fourth power).
const DIRECT_NODES: usize = 48;
/// On finer grids the plate is relaxed within this many cells of the data; farther off the coarser solution
/// is smooth enough.
const BAND_CELLS: usize = 10;
/// Relaxation sweeps on each finer grid, and their over-relaxation.
const SWEEPS: usize = 40;
const OVER_RELAXATION: f32 = 1.5;

/// One grid of the pyramid.
pub(super) struct PlateGrid {
    size: [usize; 2],
    fixed: Vec<bool>,
    h: Vec<f32>,
}

/// The clamped plate at every node (at known nodes inside the data: unspecified).
pub(super) fn solve(size: [usize; 2], known: &[bool], fits: &LocalFits) -> Vec<f32> {
    let mut coarsest = 0;
    while (size[0].max(size[1]) - 1).div_ceil(1 << coarsest) + 1 > DIRECT_NODES {
        coarsest += 1;
    }
    let nearest = nearest_known(size, known);
    let mut level = PlateGrid::new(size, coarsest, known, &nearest, fits);
    level.solve_directly();
    for l in (0..coarsest).rev() {
        let mut finer = PlateGrid::new(size, l, known, &nearest, fits);
        finer.start_from(&level);
        finer.relax();
        level = finer;
    }
    level.h
}

/// The index of the known node nearest to each node (exact for all practical purposes: vector propagation
/// over 8 neighbours, 4 sweeps).
fn nearest_known(size: [usize; 2], known: &[bool]) -> Vec<u32> {
    const NONE: u32 = u32::MAX;
    let mut nearest: Vec<u32> = known.iter().enumerate().map(|(n, &k)| if k { n as u32 } else { NONE }).collect();
    let [nx, ny] = size;
    let distance = |n: usize, m: u32| {
        let (dx, dy) = ((n / ny) as i64 - i64::from(m) / ny as i64, (n % ny) as i64 - i64::from(m) % ny as i64);
        dx * dx + dy * dy
    };
    let mut visit = |x: usize, y: usize, sx: i32, sy: i32| {
        let n = x * ny + y;
        for (dx, dy) in [(-sx, 0), (0, -sy), (-sx, -sy), (-sx, sy)] {
            let (i, j) = (x as i32 + dx, y as i32 + dy);
            if i >= 0 && j >= 0 && i < nx as i32 && j < ny as i32 {
                let m = nearest[i as usize * ny + j as usize];
                if m != NONE && (nearest[n] == NONE || distance(n, m) < distance(n, nearest[n])) {
                    nearest[n] = m;
                }
            }
        }
    };
    for _ in 0..2 {
        for (sx, sy) in [(1, 1), (-1, -1), (1, -1), (-1, 1)] {
            for a in 0..nx {
                let x = if sx > 0 { a } else { nx - 1 - a };
                for b in 0..ny {
                    let y = if sy > 0 { b } else { ny - 1 - b };
                    visit(x, y, sx, sy);
                }
            }
        }
    }
    nearest
}

impl PlateGrid {
    fn new(fine: [usize; 2], l: usize, known: &[bool], nearest: &[u32], fits: &LocalFits) -> Self {
        let size = fine.map(|n| (n - 1).div_ceil(1 << l) + 1);
        let fine_node = |n: usize| {
            let (x, y) = ((n / size[1]) << l, (n % size[1]) << l);
            (x < fine[0] && y < fine[1]).then(|| x * fine[1] + y)
        };
        let count = size[0] * size[1];
        let is_known: Vec<bool> = (0..count).map(|n| fine_node(n).is_some_and(|n| known[n])).collect();
        let mut fixed = is_known.clone();
        let mut h = vec![0.0; count];
        for n in 0..count {
            let Some(m) = fine_node(n) else { continue };
            if is_known[n] {
                if Self::near_unknown(size, &is_known, n, 2) {
                    h[n] = fits.at(m).z;
                }
            } else if l > 0 {
                // A coarse node up to one cell off the data takes the slope of the true rim, which lies
                // between coarse nodes.
                let rim = nearest[m] as usize;
                let (dx, dy) =
                    ((m / fine[1]) as f32 - (rim / fine[1]) as f32, (m % fine[1]) as f32 - (rim % fine[1]) as f32);
                if dx * dx + dy * dy < (1u32 << (2 * l)) as f32 {
                    h[n] = fits.at(rim).straight(dx, dy);
                    fixed[n] = true;
                }
            }
        }
        Self { size, fixed, h }
    }

    /// Calls `visit` for the nodes within `reach` (Chebyshev) of node `n`, itself left out.
    pub(super) fn neighbours(size: [usize; 2], n: usize, reach: usize, mut visit: impl FnMut(usize)) {
        let (x, y) = (n / size[1], n % size[1]);
        for i in x.saturating_sub(reach)..=(x + reach).min(size[0] - 1) {
            for j in y.saturating_sub(reach)..=(y + reach).min(size[1] - 1) {
                let m = i * size[1] + j;
                if m != n {
                    visit(m);
                }
            }
        }
    }

    /// Whether an unknown node lies within `reach` (Chebyshev) of node `n`.
    pub(super) fn near_unknown(size: [usize; 2], known: &[bool], n: usize, reach: usize) -> bool {
        let mut found = false;
        Self::neighbours(size, n, reach, |m| found |= !known[m]);
        found
    }

    /// Every second-difference term that node `n` takes part in: calls `visit(weight, nodes and coefficients
    /// of the term, own coefficient)`.
    fn terms(size: [usize; 2], n: usize, mut visit: impl FnMut(f32, &[(usize, f32)], f32)) {
        let [nx, ny] = size;
        let (x, y) = (n / ny, n % ny);
        for c in x.saturating_sub(1).max(1)..=(x + 1).min(nx.saturating_sub(2)) {
            let m = c * ny + y;
            let own = if c == x { -2.0 } else { 1.0 };
            visit(1.0, &[(m - ny, 1.0), (m, -2.0), (m + ny, 1.0)], own);
        }
        for c in y.saturating_sub(1).max(1)..=(y + 1).min(ny.saturating_sub(2)) {
            let m = x * ny + c;
            let own = if c == y { -2.0 } else { 1.0 };
            visit(1.0, &[(m - 1, 1.0), (m, -2.0), (m + 1, 1.0)], own);
        }
        for i in x.saturating_sub(1)..=x.min(nx.saturating_sub(2)) {
            for j in y.saturating_sub(1)..=y.min(ny.saturating_sub(2)) {
                let m = i * ny + j;
                let own = if (i == x) == (j == y) { 1.0 } else { -1.0 };
                visit(2.0, &[(m, 1.0), (m + 1, -1.0), (m + ny, -1.0), (m + ny + 1, 1.0)], own);
            }
        }
    }

    /// Solves for all unknown nodes by a banded Cholesky factorisation.
    fn solve_directly(&mut self) {
        let unknown: Vec<usize> = (0..self.h.len()).filter(|&n| !self.fixed[n]).collect();
        if unknown.is_empty() {
            return;
        }
        let mut place = vec![usize::MAX; self.h.len()];
        for (i, &n) in unknown.iter().enumerate() {
            place[n] = i;
        }
        let band = unknown
            .iter()
            .map(|&n| {
                let mut first = place[n];
                Self::terms(self.size, n, |_, nodes, _| {
                    for &(m, _) in nodes {
                        if !self.fixed[m] {
                            first = first.min(place[m]);
                        }
                    }
                });
                place[n] - first
            })
            .max()
            .unwrap_or(0);
        // Row i holds columns i − band ..= i of the lower triangle.
        let width = band + 1;
        let mut a = vec![0.0f64; unknown.len() * width];
        let mut b = vec![0.0f64; unknown.len()];
        for (i, &n) in unknown.iter().enumerate() {
            Self::terms(self.size, n, |weight, nodes, own| {
                for &(m, c) in nodes {
                    let entry = f64::from(weight * own * c);
                    if self.fixed[m] {
                        b[i] -= entry * f64::from(self.h[m]);
                    } else if place[m] <= i {
                        a[i * width + band + place[m] - i] += entry;
                    }
                }
            });
            // Without data enough to hold a plane the ridge chooses the flat one (the mean plane is taken off
            // before).
            a[i * width + band] += 1e-9;
        }
        for i in 0..unknown.len() {
            let first = i.saturating_sub(band);
            for j in first..=i {
                let from = first.max(j.saturating_sub(band));
                let (row_i, row_j) = (i * width + band - i, j * width + band - j);
                let value = a[row_i + j] - dot(&a[row_i + from..row_i + j], &a[row_j + from..row_j + j]);
                a[row_i + j] = if j == i { value.max(1e-12).sqrt() } else { value / a[row_j + j] };
            }
        }
        for i in 0..b.len() {
            let (first, row) = (i.saturating_sub(band), i * width + band - i);
            let dot: f64 = (first..i).map(|j| a[row + j] * b[j]).sum();
            b[i] = (b[i] - dot) / a[row + i];
        }
        for i in (0..b.len()).rev() {
            let (first, row) = (i.saturating_sub(band), i * width + band - i);
            b[i] /= a[row + i];
            for j in first..i {
                b[j] -= a[row + j] * b[i];
            }
        }
        for (i, &n) in unknown.iter().enumerate() {
            self.h[n] = b[i] as f32;
        }
    }

    /// Starts the unknown nodes with the cubic interpolation of a level of half the resolution.
    fn start_from(&mut self, coarse: &Self) {
        let [nx, ny] = self.size;
        let [_, cy] = coarse.size;
        // Along y on every coarse line first, then along x.
        let mut lines = vec![0.0f32; coarse.size[0] * ny];
        for i in 0..coarse.size[0] {
            for j in 0..ny {
                lines[i * ny + j] = halved(|k| coarse.h[i * cy + k], cy, j);
            }
        }
        for i in 0..nx {
            for j in 0..ny {
                let n = i * ny + j;
                if !self.fixed[n] {
                    self.h[n] = halved(|k| lines[k * ny + j], coarse.size[0], i);
                }
            }
        }
    }

    /// Relaxes the unknown nodes near data towards the plate.
    fn relax(&mut self) {
        let [nx, ny] = self.size;
        let mut ring: Vec<u8> = self.fixed.iter().map(|&f| u8::from(f)).collect();
        let mut front: Vec<usize> = (0..self.h.len()).filter(|&n| self.fixed[n]).collect();
        for _ in 0..BAND_CELLS {
            let mut next = Vec::new();
            for &n in &front {
                Self::neighbours(self.size, n, 1, |m| {
                    if ring[m] == 0 {
                        ring[m] = 2;
                        next.push(m);
                    }
                });
            }
            front = next;
        }
        let nodes: Vec<usize> = (0..self.h.len()).filter(|&n| ring[n] == 2).collect();
        for sweep in 0..SWEEPS {
            let mut relax = |n: usize| {
                let (x, y) = (n / ny, n % ny);
                let h = &mut self.h;
                if x >= 2 && y >= 2 && x + 2 < nx && y + 2 < ny {
                    let near = h[n - 1] + h[n + 1] + h[n - ny] + h[n + ny];
                    let diagonal = h[n - ny - 1] + h[n - ny + 1] + h[n + ny - 1] + h[n + ny + 1];
                    let far = h[n - 2] + h[n + 2] + h[n - 2 * ny] + h[n + 2 * ny];
                    let target = (8.0 * near - 2.0 * diagonal - far) / 20.0;
                    h[n] += OVER_RELAXATION * (target - h[n]);
                } else {
                    let (mut gradient, mut diagonal) = (0.0, 0.0);
                    Self::terms([nx, ny], n, |weight, nodes, own| {
                        let term: f32 = nodes.iter().map(|&(m, c)| c * h[m]).sum();
                        gradient += weight * own * term;
                        diagonal += weight * own * own;
                    });
                    if diagonal > 0.0 {
                        h[n] -= OVER_RELAXATION * gradient / diagonal;
                    }
                }
            };
            if sweep % 2 == 0 {
                nodes.iter().for_each(|&n| relax(n));
            } else {
                nodes.iter().rev().for_each(|&n| relax(n));
            }
        }
    }
}

/// Numbers that are multiplied side by side.
const LANES: usize = 8;

/// The dot product, in [`LANES`] sums of their own: one sum after the other would wait for each addition.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; LANES];
    let (a, b) = (a.chunks_exact(LANES), b.chunks_exact(LANES));
    let rest: f64 = a.remainder().iter().zip(b.remainder()).map(|(p, q)| p * q).sum();
    for (a, b) in a.zip(b) {
        for lane in 0..LANES {
            sums[lane] += a[lane] * b[lane];
        }
    }
    sums.iter().sum::<f64>() + rest
}

/// Value at fine index `j` of a line of `count` coarse values, by cubic interpolation; linear beyond the
/// ends.
fn halved(at: impl Fn(usize) -> f32, count: usize, j: usize) -> f32 {
    let k = j / 2;
    if j.is_multiple_of(2) {
        return at(k);
    }
    let (p, q) = (at(k), at(k + 1));
    let before = if k > 0 { at(k - 1) } else { 2.0 * p - q };
    let after = if k + 2 < count { at(k + 2) } else { 2.0 * q - p };
    (9.0 * (p + q) - before - after) / 16.0
}
