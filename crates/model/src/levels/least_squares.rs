//! Sparse linear least squares by conjugate gradients on the normal equations (M. R. Hestenes and E. Stiefel, 1952, as
//! in Å. Björck, "Numerical Methods for Least Squares Problems", 1996, 7.4), scaled by the diagonal. Several right sides
//! share the work on the matrix, which is what takes the time.
//!
//! Sums are taken in fixed pieces, so that the result does not depend on the number of threads.

use rayon::prelude::*;
use survey::progress::{Cancelled, Progress};

/// Numbers in a piece of a sum.
const PIECE: usize = 4096;

/// Equations Σ coefficient · unknown = right, each already multiplied by its weight, for `N` right sides at once.
#[derive(Debug, Clone)]
pub struct Equations<const N: usize> {
    starts: Vec<usize>,
    terms: Vec<(u32, f32)>,
    right: Vec<[f64; N]>,
}

impl<const N: usize> Default for Equations<N> {
    fn default() -> Self {
        Self { starts: Vec::new(), terms: Vec::new(), right: Vec::new() }
    }
}

/// A symmetric matrix, row by row.
struct Normal {
    starts: Vec<usize>,
    entries: Vec<(u32, f64)>,
}

impl<const N: usize> Equations<N> {
    /// Adds an equation, multiplied by `weight`.
    pub fn add(&mut self, weight: f64, terms: impl IntoIterator<Item = (u32, f64)>, right: [f64; N]) {
        self.starts.push(self.terms.len());
        self.terms.extend(terms.into_iter().map(|(unknown, c)| (unknown, (c * weight) as f32)));
        self.right.push(right.map(|right| right * weight));
    }

    fn row(&self, n: usize) -> &[(u32, f32)] {
        &self.terms[self.starts[n]..self.starts.get(n + 1).copied().unwrap_or(self.terms.len())]
    }

    /// The equations of each unknown.
    fn columns(&self, unknowns: usize) -> (Vec<usize>, Vec<(u32, f32)>) {
        let mut starts = vec![0usize; unknowns + 1];
        self.terms.iter().for_each(|&(unknown, _)| starts[unknown as usize + 1] += 1);
        (0..unknowns).for_each(|n| starts[n + 1] += starts[n]);
        let mut next = starts.clone();
        let mut columns = vec![(0u32, 0.0f32); self.terms.len()];
        for row in 0..self.right.len() {
            for &(unknown, c) in self.row(row) {
                columns[next[unknown as usize]] = (row as u32, c);
                next[unknown as usize] += 1;
            }
        }
        (starts, columns)
    }

    /// The normal equations: their matrix and right sides.
    fn normal(&self, unknowns: usize) -> (Normal, Vec<[f64; N]>) {
        let (starts, columns) = self.columns(unknowns);
        let column = |n: usize| &columns[starts[n]..starts[n + 1]];
        let row = |n: usize| {
            let of = |&(row, c): &(u32, f32)| {
                self.row(row as usize).iter().map(move |&(m, d)| (m, f64::from(c) * f64::from(d)))
            };
            let mut entries: Vec<(u32, f64)> = column(n).iter().flat_map(of).collect();
            entries.sort_by_key(|entry| entry.0);
            entries.dedup_by(|next, kept| {
                let is_same = next.0 == kept.0;
                kept.1 += if is_same { next.1 } else { 0.0 };
                is_same
            });
            entries
        };
        let rows: Vec<Vec<(u32, f64)>> = (0..unknowns).into_par_iter().map(row).collect();
        let right = |n: usize| {
            let of = |sum: [f64; N], &(row, c): &(u32, f32)| {
                let right = &self.right[row as usize];
                std::array::from_fn(|k| sum[k] + f64::from(c) * right[k])
            };
            column(n).iter().fold([0.0; N], of)
        };
        let right = (0..unknowns).into_par_iter().map(right).collect();
        let mut matrix = Normal { starts: vec![0], entries: Vec::with_capacity(rows.iter().map(Vec::len).sum()) };
        for row in rows {
            matrix.entries.extend(row);
            matrix.starts.push(matrix.entries.len());
        }
        (matrix, right)
    }

    /// The unknowns that fit best, from a first guess, until the gradient is `tolerance` times that at 0, or after
    /// `most` steps. Memory: 16 bytes a term, 16 an entry of the normal equations.
    ///
    /// # Errors
    /// The user cancelled.
    pub fn solve(
        &self,
        mut x: Vec<[f64; N]>,
        tolerance: f64,
        most: usize,
        progress: &Progress,
    ) -> Result<Vec<[f64; N]>, Cancelled> {
        let (matrix, right) = self.normal(x.len());
        let scale: Vec<f64> = (0..x.len()).map(|n| matrix.inverse_diagonal(n)).collect();
        let scaled =
            |z: &[[f64; N]]| -> Vec<[f64; N]> { z.iter().zip(&scale).map(|(z, scale)| z.map(|z| z * scale)).collect() };
        let mut z: Vec<[f64; N]> = matrix.times(&x);
        z.iter_mut().zip(&right).for_each(|(z, right)| *z = std::array::from_fn(|k| right[k] - z[k]));
        let mut p = scaled(&z);
        let mut gamma = dot(&z, &p);
        let enough = dot(&right, &scaled(&right)).map(|sum| (tolerance * tolerance * sum).max(f64::MIN_POSITIVE));
        for _ in 0..most {
            // A right side that is solved takes no more steps.
            let open: [bool; N] = std::array::from_fn(|k| gamma[k] > enough[k]);
            if !open.contains(&true) {
                break;
            }
            progress.check()?;
            let q = matrix.times(&p);
            let curve = dot(&p, &q);
            let alpha: [f64; N] =
                std::array::from_fn(|k| if open[k] { gamma[k] / curve[k].max(f64::MIN_POSITIVE) } else { 0.0 });
            x.iter_mut().zip(&p).for_each(|(x, p)| (0..N).for_each(|k| x[k] += alpha[k] * p[k]));
            z.iter_mut().zip(&q).for_each(|(z, q)| (0..N).for_each(|k| z[k] -= alpha[k] * q[k]));
            let s = scaled(&z);
            let next = dot(&z, &s);
            let beta: [f64; N] = std::array::from_fn(|k| if open[k] { next[k] / gamma[k] } else { 0.0 });
            gamma = next;
            p.iter_mut().zip(&s).for_each(|(p, s)| *p = std::array::from_fn(|k| s[k] + beta[k] * p[k]));
        }
        Ok(x)
    }
}

impl Normal {
    fn row(&self, n: usize) -> &[(u32, f64)] {
        &self.entries[self.starts[n]..self.starts[n + 1]]
    }

    /// 1 / the entry on the diagonal, 0 where no equation has this unknown.
    fn inverse_diagonal(&self, n: usize) -> f64 {
        let own = self.row(n).iter().find(|entry| entry.0 as usize == n).map_or(0.0, |entry| entry.1);
        if own > 0.0 { 1.0 / own } else { 0.0 }
    }

    fn times<const N: usize>(&self, x: &[[f64; N]]) -> Vec<[f64; N]> {
        let row = |n: usize| {
            self.row(n).iter().fold([0.0; N], |sum, &(m, c)| {
                let x = &x[m as usize];
                std::array::from_fn(|k| sum[k] + c * x[k])
            })
        };
        (0..x.len()).into_par_iter().with_min_len(PIECE).map(row).collect()
    }
}

fn dot<const N: usize>(a: &[[f64; N]], b: &[[f64; N]]) -> [f64; N] {
    let sum = |sum: [f64; N], (a, b): (&[f64; N], &[f64; N])| std::array::from_fn(|k| sum[k] + a[k] * b[k]);
    let piece = |(a, b): (&[[f64; N]], &[[f64; N]])| a.iter().zip(b).fold([0.0; N], sum);
    let pieces: Vec<[f64; N]> = a.par_chunks(PIECE).zip(b.par_chunks(PIECE)).map(piece).collect();
    pieces.iter().fold([0.0; N], |sum, piece| std::array::from_fn(|k| sum[k] + piece[k]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_through_four_points() {
        // y = a + b·x through (0, 1), (1, 3), (2, 4), (3, 4): b = 1, a = 1.5.
        let mut equations = Equations::default();
        for (x, y) in [(0.0, 1.0), (1.0, 3.0), (2.0, 4.0), (3.0, 4.0)] {
            equations.add(1.0, [(0, 1.0), (1, x)], [y, 2.0 * y - x]);
        }
        let found = equations.solve(vec![[0.0; 2]; 2], 1e-12, 50, &Progress::silent()).unwrap();
        // The second right side is twice the first less x: b = 1, a = 3.
        let expected = [[1.5, 3.0], [1.0, 1.0]];
        assert!(
            found.as_flattened().iter().zip(expected.as_flattened()).all(|(a, b)| (a - b).abs() < 1e-6),
            "{found:?}"
        );
        // A weight counts squared.
        let mut weighted = Equations::default();
        weighted.add(2.0, [(0, 1.0)], [1.0]);
        weighted.add(1.0, [(0, 1.0)], [6.0]);
        let found = weighted.solve(vec![[9.0]], 1e-12, 50, &Progress::silent()).unwrap();
        assert!((found[0][0] - 2.0).abs() < 1e-6, "{found:?}");
    }
}
