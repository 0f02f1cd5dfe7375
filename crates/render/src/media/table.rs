//! RGBA functions of media as tables: linear colour and extinction at evenly spaced values.
//!
//! A lookup takes the nearest of `ENTRIES` entries, so that it is a single load on the GPU. The error in
//! the value is at most 1/4096 of the domain.

use super::samples::whole;
use ttf::{RgbaFunction, linear_from_srgb};

/// Number of entries.
pub(crate) const ENTRIES: usize = 2048;
/// Extinction of an opaque value: a ten-thousandth of a unit transmits less than half.
pub(crate) const OPAQUE: f32 = 1.0e4;

/// −ln(1 − α₀), limited to `OPAQUE`.
///
/// ```
/// use render::media::table::{absorbed, extinction};
/// assert!((extinction(0.5) - std::f32::consts::LN_2).abs() < 1e-6);
/// assert!((absorbed(extinction(0.3)) - 0.3).abs() < 1e-5);
/// ```
pub fn extinction(opacity: f32) -> f32 {
    if opacity >= 0.9999 { OPAQUE } else { -(-opacity.max(0.0)).ln_1p() }
}

/// A tabulated function.
#[derive(Debug, Clone, PartialEq)]
pub struct FunctionTable {
    /// Linear red, green, blue, and extinction.
    pub entries: Vec<[f32; 4]>,
    /// The extinctions alone. Most samples need nothing else, and they fit into the cache.
    pub extinctions: Vec<f32>,
    /// The opacity of one unit of length.
    pub opacities: Vec<f32>,
    /// The colour of all entries, if they have the same.
    pub uniform: Option<[f32; 3]>,
    /// Value of the first entry.
    pub low: f32,
    /// Entries per unit of value.
    pub scale: f32,
    /// Number of entries with extinction before each index.
    visible_before: Vec<u32>,
}

impl FunctionTable {
    /// Tabulates a function, which must be valid.
    pub fn new(function: &RgbaFunction) -> Self {
        let entries: Vec<[f32; 4]> = function
            .bake(ENTRIES)
            .into_iter()
            .map(|[r, g, b, opacity]| {
                [linear_from_srgb(r), linear_from_srgb(g), linear_from_srgb(b), extinction(opacity)]
            })
            .collect();
        let mut count = 0;
        let mut visible_before = vec![0];
        for entry in &entries {
            count += u32::from(entry[3] > 0.0);
            visible_before.push(count);
        }
        let [low, high] = function.domain;
        let extinctions: Vec<f32> = entries.iter().map(|entry| entry[3]).collect();
        let opacities = extinctions.iter().map(|&kappa| absorbed(kappa)).collect();
        let first = [entries[0][0], entries[0][1], entries[0][2]];
        let uniform = entries.iter().all(|entry| entry[..3] == first).then_some(first);
        Self {
            entries,
            extinctions,
            opacities,
            uniform,
            low,
            scale: (ENTRIES - 1) as f32 / (high - low),
            visible_before,
        }
    }

    /// The index of the entry of a value; the value must not be missing.
    #[inline(always)]
    pub fn index(&self, value: f32) -> usize {
        ((value - self.low) * self.scale + 0.5).clamp(0.0, (ENTRIES - 1) as f32) as i32 as usize
    }

    /// The indices of the entries of many values; meaningless for missing values.
    #[inline(always)]
    pub(crate) fn entries_of(&self, values: &[f32], entries: &mut [u32]) {
        const LAST: f32 = (ENTRIES - 1) as f32;
        for (entry, value) in entries.iter_mut().zip(values) {
            let place = (value - self.low) * self.scale + 0.5;
            let place = if place > 0.0 { place } else { 0.0 };
            *entry = whole(if place < LAST { place } else { LAST }).1;
        }
    }

    /// Whether any value between two values is visible.
    pub fn shows(&self, low: f32, high: f32) -> bool {
        low <= high && self.visible_before[self.index(high) + 1] > self.visible_before[self.index(low)]
    }
}

/// The fraction that is absorbed over an optical depth x ≥ 0: 1 − e^(−x), to about 10⁻⁶, faster than the
/// library function.
#[inline(always)]
pub fn absorbed(x: f32) -> f32 {
    // e^(−x) = 2^(−n) · 2^(−f), where the second factor is a series around ½.
    let y = (x * std::f32::consts::LOG2_E).min(126.0);
    let n = y as i32;
    let f = (y - n as f32 - 0.5) * -std::f32::consts::LN_2;
    let series =
        1.0 + f * (1.0 + f * (0.5 + f * (1.0 / 6.0 + f * (1.0 / 24.0 + f * (1.0 / 120.0 + f * (1.0 / 720.0))))));
    let power = f32::from_bits(((127 - n) as u32) << 23);
    1.0 - power * std::f32::consts::FRAC_1_SQRT_2 * series
}

#[cfg(test)]
mod tests {
    use super::*;
    use ttf::{Colour, RgbaStop};

    #[test]
    fn absorption_is_one_minus_the_exponential() {
        for n in 0..2000 {
            let x = (n as f32 * 0.01).powi(2) * 0.3;
            assert!((absorbed(x) - (1.0 - (-x).exp())).abs() < 2e-6, "{x}");
        }
        assert!((absorbed(1e9) - 1.0).abs() < 1e-6 && absorbed(0.0).abs() < 1e-6);
    }

    #[test]
    fn entries_are_linear_colour_and_extinction() {
        let stop = |at: f32, opacity: f32| RgbaStop { at, colour: Colour::new(188, 255, 0), opacity };
        let table = FunctionTable::new(&RgbaFunction {
            domain: [0.0, 2.0],
            stops: vec![stop(0.0, 0.0), stop(0.5, 0.0), stop(1.0, 1.0)],
        });
        let half = table.entries[table.index(1.5)];
        assert!((half[0] - 0.5).abs() < 0.01 && half[1] == 1.0 && half[2] == 0.0);
        assert!((half[3] - std::f32::consts::LN_2).abs() < 1e-3);
        assert_eq!(table.entries[table.index(99.0)][3], OPAQUE);
        assert!(!table.shows(0.0, 0.99) && table.shows(0.0, 1.01) && !table.shows(1.0, 0.0));
    }
}
