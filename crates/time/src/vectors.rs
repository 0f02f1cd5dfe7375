//! Sums over whole volumes and steps along a direction, line by line: sums have one order on any number of threads.

use rayon::prelude::*;
use system::wide::{Wide, widest};

/// Sums that run side by side, so that none waits for another.
const LANES: usize = 8;

/// Σ a b, or Σ a b w; `line` numbers are summed by one thread.
pub(crate) fn dot(a: &[f32], b: &[f32], weights: Option<&[f32]>, line: usize) -> f64 {
    let own = |n: usize, len: usize| weights.map(|weights| &weights[n * line..n * line + len]);
    let lines = a.par_chunks(line).zip(b.par_chunks(line)).enumerate();
    let parts: Vec<f64> = lines.map(|(n, (a, b))| widest(Products { a, b, weights: own(n, a.len()) })).collect();
    parts.iter().sum()
}

/// Moves s by a step along the direction, and the residual by the same step along its image; returns Σ residual² inverse.
pub(crate) fn advance(
    step: f32,
    [s, residual]: [&mut [f32]; 2],
    [direction, image, inverse]: [&[f32]; 3],
    line: usize,
) -> f64 {
    let lines = s.par_chunks_mut(line).zip(residual.par_chunks_mut(line)).zip(direction.par_chunks(line));
    let lines = lines.zip(image.par_chunks(line)).zip(inverse.par_chunks(line));
    let parts: Vec<f64> = lines
        .map(|((((s, residual), direction), image), inverse)| {
            widest(LineAdvance { step, s, residual, direction, image });
            widest(Products { a: residual, b: residual, weights: Some(inverse) })
        })
        .collect();
    parts.iter().sum()
}

/// The next direction: residual · inverse + keep · direction.
pub(crate) fn turn(keep: f32, direction: &mut [f32], [residual, inverse]: [&[f32]; 2], line: usize) {
    let lines = direction.par_chunks_mut(line).zip(residual.par_chunks(line)).zip(inverse.par_chunks(line));
    lines.for_each(|((direction, residual), inverse)| widest(Turn { keep, direction, residual, inverse }));
}

/// Σ a b, or Σ a b w.
struct Products<'a> {
    a: &'a [f32],
    b: &'a [f32],
    weights: Option<&'a [f32]>,
}

impl Wide for Products<'_> {
    type Output = f64;

    #[inline(always)]
    fn run(self) -> f64 {
        let ((a, a_rest), (b, b_rest)) = (self.a.as_chunks::<LANES>(), self.b.as_chunks::<LANES>());
        let pairs = a.iter().zip(b);
        let rest = a_rest.iter().zip(b_rest);
        match self.weights.map(<[f32]>::as_chunks::<LANES>) {
            Some((weights, weights_rest)) => summed(
                pairs.zip(weights).map(|((a, b), w)| std::array::from_fn(|lane| a[lane] * (b[lane] * w[lane]))),
                rest.zip(weights_rest).map(|((a, b), w)| a * (b * w)),
            ),
            None => summed(pairs.map(|(a, b)| std::array::from_fn(|lane| a[lane] * b[lane])), rest.map(|(a, b)| a * b)),
        }
    }
}

/// The sum of all lanes and of what is left.
#[inline(always)]
fn summed(lanes: impl Iterator<Item = [f32; LANES]>, rest: impl Iterator<Item = f32>) -> f64 {
    let mut sums = [0.0f64; LANES];
    lanes.for_each(|lanes| sums.iter_mut().zip(lanes).for_each(|(sum, new)| *sum += f64::from(new)));
    sums.iter().sum::<f64>() + rest.map(f64::from).sum::<f64>()
}

/// One line of [`advance`].
struct LineAdvance<'a> {
    step: f32,
    s: &'a mut [f32],
    residual: &'a mut [f32],
    direction: &'a [f32],
    image: &'a [f32],
}

impl Wide for LineAdvance<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { step, s, residual, direction, image } = self;
        for (((s, r), p), a) in s.iter_mut().zip(residual).zip(direction).zip(image) {
            *s += step * p;
            *r -= step * a;
        }
    }
}

/// One line of [`turn`].
struct Turn<'a> {
    keep: f32,
    direction: &'a mut [f32],
    residual: &'a [f32],
    inverse: &'a [f32],
}

impl Wide for Turn<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        for ((p, r), d) in self.direction.iter_mut().zip(self.residual).zip(self.inverse) {
            *p = r * d + self.keep * *p;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_and_steps_are_those_of_single_numbers() {
        let numbers =
            |seed: usize| -> Vec<f32> { (0..1003).map(|n| ((n * 7919 + seed) % 1009) as f32 / 500.0 - 1.0).collect() };
        let [a, b, weights] = [1, 20, 300].map(numbers);
        let plain: f64 = a.iter().zip(&b).map(|(a, b)| f64::from(a * b)).sum();
        let weighed: f64 = a.iter().zip(&b).zip(&weights).map(|((a, b), w)| f64::from(a * (b * w))).sum();
        for line in [7, 100, 1003] {
            assert!((dot(&a, &b, None, line) - plain).abs() < 1e-9);
            assert!((dot(&a, &b, Some(&weights), line) - weighed).abs() < 1e-9);
            let (mut s, mut residual) = (numbers(4), numbers(50));
            let left = advance(0.5, [&mut s, &mut residual], [&a, &b, &weights], line);
            let meant = |seed: usize, n: usize, by: f32| numbers(seed)[n] + by;
            for n in [0, 6, 7, 99, 1002] {
                assert_eq!([s[n], residual[n]], [meant(4, n, 0.5 * a[n]), meant(50, n, -0.5 * b[n])]);
            }
            assert!((left - dot(&residual, &residual, Some(&weights), line)).abs() < 1e-9);
            let mut direction = a.clone();
            turn(0.25, &mut direction, [&b, &weights], line);
            for n in [0, 6, 7, 99, 1002] {
                assert_eq!(direction[n], b[n] * weights[n] + 0.25 * a[n]);
            }
        }
    }
}
