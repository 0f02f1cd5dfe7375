//! Sums over a sliding window of samples.
//!
//! A window of n samples is the sum of windows whose lengths are the powers of two in n, each the sum of two
//! windows of half its length: log₂ n additions a sample, all of them between arrays, which the compiler
//! turns into vector instructions. Unlike a running sum it forgets: strong samples leave no rounding error
//! behind in the quiet ones below them.

/// Work space of [`WindowSum::sum_into`], kept between calls.
#[derive(Debug, Default)]
pub(super) struct WindowSum {
    present: Vec<f32>,
    doubled: Vec<f32>,
}

impl WindowSum {
    /// `out[z] = Σ values[z .. z + width]`; `values` has `out.len() + width − 1` entries.
    pub(super) fn sum_into(&mut self, values: &[f32], width: usize, out: &mut [f32]) {
        debug_assert_eq!(values.len() + 1, out.len() + width);
        out.fill(0.0);
        self.present.clear();
        self.present.extend_from_slice(values);
        let (mut left, mut length, mut offset) = (width, 1, 0);
        while left > 0 {
            if left & 1 == 1 {
                out.iter_mut().zip(&self.present[offset..]).for_each(|(sum, value)| *sum += value);
                offset += length;
            }
            left >>= 1;
            if left > 0 {
                let (low, high) = (&self.present[..], &self.present[length..]);
                self.doubled.clear();
                self.doubled.extend(low.iter().zip(high).map(|(a, b)| a + b));
                std::mem::swap(&mut self.present, &mut self.doubled);
                length *= 2;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_width_agrees_with_plain_addition() {
        let values: Vec<f32> = (0..40).map(|n| ((n * 37) % 11) as f32).collect();
        for width in 1..=32 {
            let mut out = vec![0.0; values.len() + 1 - width];
            WindowSum::default().sum_into(&values, width, &mut out);
            let plain: Vec<f32> = values.windows(width).map(|window| window.iter().sum()).collect();
            assert_eq!(out, plain, "width {width}");
        }
    }
}
