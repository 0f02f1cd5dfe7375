//! Sparse linear least squares by conjugate gradients on the normal equations (CGLS: M. R. Hestenes and E. Stiefel,
//! 1952, as in Å. Björck, "Numerical Methods for Least Squares Problems", 1996, 7.4), scaled by the diagonal.
//!
//! Sums are taken in fixed pieces, so that the result does not depend on the number of threads.

use rayon::prelude::*;
use survey::progress::{Cancelled, Progress};

/// Numbers in a piece of a sum.
const PIECE: usize = 4096;

/// Equations Σ coefficient · unknown = right, each already multiplied by its weight.
#[derive(Debug, Clone, Default)]
pub struct Equations {
    starts: Vec<usize>,
    terms: Vec<(u32, f32)>,
    right: Vec<f64>,
}

impl Equations {
    /// Adds an equation, multiplied by `weight`.
    pub fn add(&mut self, weight: f64, terms: impl IntoIterator<Item = (u32, f64)>, right: f64) {
        self.starts.push(self.terms.len());
        self.terms.extend(terms.into_iter().map(|(unknown, c)| (unknown, (c * weight) as f32)));
        self.right.push(right * weight);
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

    /// The unknowns that fit best, from a first guess, until the gradient is `tolerance` times that at 0, or after
    /// `most` steps. Memory: 16 bytes a term, 40 an unknown.
    ///
    /// # Errors
    /// The user cancelled.
    pub fn solve(
        &self,
        mut x: Vec<f64>,
        tolerance: f64,
        most: usize,
        progress: &Progress,
    ) -> Result<Vec<f64>, Cancelled> {
        let (starts, columns) = self.columns(x.len());
        let times = |x: &[f64]| -> Vec<f64> {
            let row = |n: usize| self.row(n).iter().map(|&(unknown, c)| f64::from(c) * x[unknown as usize]).sum();
            (0..self.right.len()).into_par_iter().with_min_len(PIECE).map(row).collect()
        };
        let back = |r: &[f64]| -> Vec<f64> {
            let column = |n: usize| &columns[starts[n]..starts[n + 1]];
            let sum = |n: usize| column(n).iter().map(|&(row, c)| f64::from(c) * r[row as usize]).sum();
            (0..starts.len() - 1).into_par_iter().with_min_len(PIECE).map(sum).collect()
        };
        let diagonal: Vec<f64> = (0..x.len())
            .map(|n| columns[starts[n]..starts[n + 1]].iter().map(|&(_, c)| f64::from(c * c)).sum::<f64>())
            .map(|sum| if sum > 0.0 { 1.0 / sum } else { 0.0 })
            .collect();
        let scaled = |z: &[f64]| -> Vec<f64> { z.iter().zip(&diagonal).map(|(z, d)| z * d).collect() };
        let product = times(&x);
        let mut r: Vec<f64> = self.right.iter().zip(&product).map(|(b, p)| b - p).collect();
        let mut z = back(&r);
        let mut p = scaled(&z);
        let mut gamma = dot(&z, &p);
        let at_zero = back(&self.right);
        let enough = tolerance * tolerance * dot(&at_zero, &scaled(&at_zero));
        for _ in 0..most {
            if gamma <= enough.max(f64::MIN_POSITIVE) {
                break;
            }
            progress.check()?;
            let q = times(&p);
            let alpha = gamma / dot(&q, &q).max(f64::MIN_POSITIVE);
            x.iter_mut().zip(&p).for_each(|(x, p)| *x += alpha * p);
            r.iter_mut().zip(&q).for_each(|(r, q)| *r -= alpha * q);
            z = back(&r);
            let s = scaled(&z);
            let next = dot(&z, &s);
            let beta = next / gamma;
            gamma = next;
            p.iter_mut().zip(&s).for_each(|(p, s)| *p = s + beta * *p);
        }
        Ok(x)
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    let piece = |(a, b): (&[f64], &[f64])| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    a.par_chunks(PIECE).zip(b.par_chunks(PIECE)).map(piece).collect::<Vec<f64>>().iter().sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_through_four_points() {
        // y = a + b·x through (0, 1), (1, 3), (2, 4), (3, 4): b = 1, a = 1.5.
        let mut equations = Equations::default();
        for (x, y) in [(0.0, 1.0), (1.0, 3.0), (2.0, 4.0), (3.0, 4.0)] {
            equations.add(1.0, [(0, 1.0), (1, x)], y);
        }
        let found = equations.solve(vec![0.0; 2], 1e-12, 50, &Progress::silent()).unwrap();
        assert!((found[0] - 1.5).abs() < 1e-6 && (found[1] - 1.0).abs() < 1e-6, "{found:?}");
        // A weight counts squared.
        let mut weighted = Equations::default();
        weighted.add(2.0, [(0, 1.0)], 1.0);
        weighted.add(1.0, [(0, 1.0)], 6.0);
        let found = weighted.solve(vec![9.0], 1e-12, 50, &Progress::silent()).unwrap();
        assert!((found[0] - 2.0).abs() < 1e-6, "{found:?}");
    }
}
