//! A horizon as a drawing hand would follow it: without what is smaller than the pattern.
//!
//! With the Gaussian G, the filter is
//!
//! ```text
//! h ↦ (1 − (1 − G)⁴) h
//! ```
//!
//! A wave of length λ keeps the share 1 − (1 − g)⁴ of its height, with g = exp(−2π²σ²/λ²). Short waves vanish. Waves
//! much longer than σ are kept to the fourth order, where the Gaussian alone would lower every fold: a fold four times
//! as long as the waves that are halved keeps all but a thousandth.
//!
//! Sheets are continued past the border by point reflection, which keeps planes. Every fault block has sheets of its
//! own, so nothing is smoothed across a fault.

use rayon::prelude::*;
use survey::HeightField;

/// Length of the waves that are halved, in units of σ: where 1 − (1 − g)⁴ = ½.
const HALVED: f64 = 3.27;
/// Reach of the Gaussian, in units of σ.
const REACH: f64 = 3.5;
/// How often 1 − G is applied.
const ORDER: usize = 4;

/// The sheet without waves shorter than `wave` voxels along x and y; those lengths are halved. A length below two voxels
/// changes nothing along its axis.
pub(crate) fn calm(field: &HeightField, wave: [f64; 2]) -> HeightField {
    let kernels = wave.map(|wave| gaussian(wave / HALVED));
    if kernels.iter().all(|kernel| kernel.len() == 1) {
        return field.clone();
    }
    // What (1 − G)ⁿ leaves of the sheet.
    let mut rest = field.z.clone();
    for _ in 0..ORDER {
        let low = blur(&rest, field.size, &kernels);
        rest.iter_mut().zip(low).for_each(|(rest, low)| *rest -= low);
    }
    let z = field.z.iter().zip(rest).map(|(z, rest)| z - rest).collect();
    HeightField { z, ..field.clone() }
}

/// The mean around each node: a Gaussian by which waves of `wave` voxels keep a sixth of their height.
pub(crate) fn mean_around(field: &HeightField, wave: [f64; 2]) -> HeightField {
    let kernels = wave.map(|wave| gaussian(wave / HALVED));
    HeightField { z: blur(&field.z, field.size, &kernels), ..field.clone() }
}

/// Weights of a Gaussian at 0, 1, 2 … voxels; they add up to 1 over both sides.
fn gaussian(sigma: f64) -> Vec<f32> {
    if sigma * HALVED < 2.0 {
        return vec![1.0];
    }
    let weight = |n: usize| (-0.5 * (n as f64 / sigma).powi(2)).exp();
    let count = (REACH * sigma).ceil() as usize + 1;
    let sum = 2.0 * (1..count).map(weight).sum::<f64>() + 1.0;
    (0..count).map(|n| (weight(n) / sum) as f32).collect()
}

/// A separable convolution along both axes, `[x][y]`.
fn blur(values: &[f32], [nx, ny]: [usize; 2], [along_x, along_y]: &[Vec<f32>; 2]) -> Vec<f32> {
    let mut rows = vec![0.0; values.len()];
    rows.par_chunks_mut(ny).zip(values.par_chunks(ny)).for_each(|(out, row)| blur_line(out, row, along_y));
    let turned = transposed(&rows, nx, ny);
    let mut columns = vec![0.0; values.len()];
    columns.par_chunks_mut(nx).zip(turned.par_chunks(nx)).for_each(|(out, row)| blur_line(out, row, along_x));
    transposed(&columns, ny, nx)
}

fn transposed(values: &[f32], nx: usize, ny: usize) -> Vec<f32> {
    (0..values.len()).map(|n| values[n % nx * ny + n / nx]).collect()
}

fn blur_line(out: &mut [f32], line: &[f32], kernel: &[f32]) {
    let reach = (kernel.len() - 1).min(line.len() - 1);
    let last = line.len() - 1;
    // Point reflection at both ends: 2·end − mirrored.
    let before = (1..=reach).rev().map(|n| 2.0 * line[0] - line[n]);
    let after = (1..=reach).map(|n| 2.0 * line[last] - line[last - n]);
    let padded: Vec<f32> = before.chain(line.iter().copied()).chain(after).collect();
    // Differences from the centre keep the precision of small waves on deep sheets.
    for (n, out) in out.iter_mut().enumerate() {
        let centre = padded[n + reach];
        let pairs =
            (1..=reach).map(|m| kernel[m] * ((padded[n + reach - m] - centre) + (padded[n + reach + m] - centre)));
        *out = centre + pairs.sum::<f32>();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn a_plane_stays_to_its_border() {
        let plane = HeightField::from_fn([-5, 3], [60, 40], |x, y| 700.0 + 0.3 * x as f32 - 0.7 * y as f32);
        let found = calm(&plane, [20.0, 12.0]);
        assert_eq!((found.origin, found.size), (plane.origin, plane.size));
        assert!(found.z.iter().zip(&plane.z).all(|(a, b)| (a - b).abs() < 1e-3));
    }

    #[test]
    fn waves_keep_the_share_of_the_formula() {
        let (wave, amplitude) = (12.0, 6.0);
        for length in [4.0, 8.0, 12.0, 24.0, 48.0] {
            let field =
                HeightField::from_fn([0, 0], [240, 8], |x, _| (amplitude * (TAU * f64::from(x) / length).sin()) as f32);
            let found = calm(&field, [wave, wave]);
            let g = (-0.5 * (TAU * wave / HALVED / length).powi(2)).exp();
            let share = 1.0 - (1.0 - g).powi(4);
            for x in 80..160 {
                let expected = share as f32 * field.node(x, 4);
                assert!((found.node(x, 4) - expected).abs() < 0.03, "{length}: {} for {expected}", found.node(x, 4));
            }
            if length == wave {
                assert!((share - 0.5).abs() < 0.01, "{share}");
            }
            if length == 4.0 * wave {
                assert!(share > 0.999, "{share}");
            }
        }
    }

    #[test]
    fn no_wave_length_is_the_sheet_itself() {
        let rough = HeightField::from_fn([0, 0], [9, 7], |x, y| ((x * 31 + y * 17) % 5) as f32);
        assert_eq!(calm(&rough, [0.0, 1.0]), rough);
    }
}
