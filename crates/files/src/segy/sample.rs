//! Sample formats: what the codes at byte 3225 mean, decoded to and encoded from `f32`.
//!
//! IBM float: `(-1)^s · 16^(e-64) · f/2^24`, s 1 bit, e 7 bits, f 24 bits, which fit those of `f32`: only
//! values below its normal range are rounded. Integers of more than 24 bits and `f64` are rounded to `f32`.

use serde::{Deserialize, Serialize};

use super::error::SegyProblem;

/// Order of the bytes of a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ByteOrder {
    /// Most significant byte first, the standard's order.
    Big,
    /// Least significant byte first.
    Little,
}

impl ByteOrder {
    /// `big-endian` or `little-endian`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Big => "big-endian",
            Self::Little => "little-endian",
        }
    }

    /// `N` bytes at `offset`, most significant first.
    #[inline]
    pub(super) fn get<const N: usize>(self, bytes: &[u8], offset: usize) -> [u8; N] {
        let mut value = [0; N];
        value.copy_from_slice(&bytes[offset..offset + N]);
        if self == Self::Little {
            value.reverse();
        }
        value
    }

    /// Stores `value`, most significant first, at `offset`.
    pub(super) fn put<const N: usize>(self, bytes: &mut [u8], offset: usize, mut value: [u8; N]) {
        if self == Self::Little {
            value.reverse();
        }
        bytes[offset..offset + N].copy_from_slice(&value);
    }
}

/// A sample format that can be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SampleFormat {
    /// IBM hexadecimal float, 4 bytes (code 1).
    Ibm32,
    /// Two's complement integer, 4 bytes (code 2).
    Int32,
    /// Two's complement integer, 2 bytes (code 3).
    Int16,
    /// IEEE float, 4 bytes (code 5).
    Ieee32,
    /// IEEE float, 8 bytes (code 6).
    Ieee64,
    /// Two's complement integer, 3 bytes (code 7).
    Int24,
    /// Two's complement integer, 1 byte (code 8).
    Int8,
    /// Two's complement integer, 8 bytes (code 9).
    Int64,
    /// Unsigned integer, 4 bytes (code 10).
    Uint32,
    /// Unsigned integer, 2 bytes (code 11).
    Uint16,
    /// Unsigned integer, 8 bytes (code 12).
    Uint64,
    /// Unsigned integer, 3 bytes (code 15).
    Uint24,
    /// Unsigned integer, 1 byte (code 16).
    Uint8,
}

const FORMATS: [(u16, usize, SampleFormat, &str); 13] = [
    (1, 4, SampleFormat::Ibm32, "ibm32"),
    (2, 4, SampleFormat::Int32, "int32"),
    (3, 2, SampleFormat::Int16, "int16"),
    (5, 4, SampleFormat::Ieee32, "ieee32"),
    (6, 8, SampleFormat::Ieee64, "ieee64"),
    (7, 3, SampleFormat::Int24, "int24"),
    (8, 1, SampleFormat::Int8, "int8"),
    (9, 8, SampleFormat::Int64, "int64"),
    (10, 4, SampleFormat::Uint32, "uint32"),
    (11, 2, SampleFormat::Uint16, "uint16"),
    (12, 8, SampleFormat::Uint64, "uint64"),
    (15, 3, SampleFormat::Uint24, "uint24"),
    (16, 1, SampleFormat::Uint8, "uint8"),
];

impl SampleFormat {
    /// The sample format for a code at byte 3225.
    ///
    /// # Errors
    /// [`SegyProblem::UnsupportedFormat`] for a code of the standard that is not supported here. A code that
    /// is not in the standard gives `Ok(None)`.
    pub fn from_code(code: u16) -> Result<Option<Self>, SegyProblem> {
        match code {
            4 => Err(SegyProblem::UnsupportedFormat { code, name: "fixed point with gain, obsolete" }),
            13 | 14 => Err(SegyProblem::UnsupportedFormat { code, name: "reserved by the standard" }),
            _ => Ok(FORMATS.iter().find(|row| row.0 == code).map(|row| row.2)),
        }
    }

    /// Every format that can be read.
    pub fn all() -> impl Iterator<Item = Self> {
        FORMATS.iter().map(|row| row.2)
    }

    fn row(self) -> &'static (u16, usize, Self, &'static str) {
        FORMATS.iter().find(|row| row.2 == self).unwrap_or(&FORMATS[0])
    }

    /// The code at byte 3225.
    pub fn code(self) -> u16 {
        self.row().0
    }

    /// Bytes per sample.
    pub fn bytes(self) -> usize {
        self.row().1
    }

    /// Its short name, as in `--json`.
    pub fn name(self) -> &'static str {
        self.row().3
    }

    /// Decodes `bytes` into `out`; as many samples as both hold.
    pub fn decode(self, order: ByteOrder, bytes: &[u8], out: &mut [f32]) {
        match self {
            Self::Ibm32 => each(order, bytes, out, |b| f32_from_ibm(u32::from_be_bytes(b))),
            Self::Int32 => each(order, bytes, out, |b| i32::from_be_bytes(b) as f32),
            Self::Int16 => each(order, bytes, out, |b| f32::from(i16::from_be_bytes(b))),
            Self::Ieee32 => each(order, bytes, out, f32::from_be_bytes),
            Self::Ieee64 => each(order, bytes, out, |b| f64::from_be_bytes(b) as f32),
            Self::Int24 => each(order, bytes, out, |[a, b, c]| (i32::from_be_bytes([a, b, c, 0]) >> 8) as f32),
            Self::Int8 => each(order, bytes, out, |[a]| f32::from(a.cast_signed())),
            Self::Int64 => each(order, bytes, out, |b| i64::from_be_bytes(b) as f32),
            Self::Uint32 => each(order, bytes, out, |b| u32::from_be_bytes(b) as f32),
            Self::Uint16 => each(order, bytes, out, |b| f32::from(u16::from_be_bytes(b))),
            Self::Uint64 => each(order, bytes, out, |b| u64::from_be_bytes(b) as f32),
            Self::Uint24 => each(order, bytes, out, |[a, b, c]| u32::from_be_bytes([0, a, b, c]) as f32),
            Self::Uint8 => each(order, bytes, out, |[a]| f32::from(a)),
        }
    }
}

fn each<const N: usize>(order: ByteOrder, bytes: &[u8], out: &mut [f32], convert: impl Fn([u8; N]) -> f32) {
    let (chunks, _) = bytes.as_chunks::<N>();
    match order {
        ByteOrder::Big => chunks.iter().zip(out).for_each(|(chunk, value)| *value = convert(*chunk)),
        ByteOrder::Little => chunks.iter().zip(out).for_each(|(chunk, value)| {
            let mut chunk = *chunk;
            chunk.reverse();
            *value = convert(chunk);
        }),
    }
}

/// The value of an IBM float; infinite where it exceeds the range of `f32`.
///
/// In `f32` alone and without a branch, so that it becomes vector instructions: f · 2^(2e−140) · 2^(2e−140).
/// f has 24 bits and is exact; the first product is exact or beyond the range for good; the second one rounds
/// once. Below e = 7 every value is 0 in `f32`.
///
/// ```
/// assert_eq!(files::segy::f32_from_ibm(0xC276_A000), -118.625);
/// ```
#[inline]
pub fn f32_from_ibm(bits: u32) -> f32 {
    let fraction = (bits & 0x00ff_ffff).cast_signed() as f32;
    let exponent = ((bits >> 24) & 0x7f).cast_signed().max(7);
    // The biased exponent of 2^(2e−140).
    let scale = f32::from_bits((2 * exponent - 13).cast_unsigned() << 23);
    let magnitude = fraction * scale * scale;
    f32::from_bits(magnitude.to_bits() | bits & 0x8000_0000)
}

/// The nearest IBM float: exact to 21 bits at least, since its leading hexadecimal digit may begin with three
/// zeros. NaN becomes 0, and infinity becomes the largest value.
///
/// ```
/// assert_eq!(files::segy::ibm_from_f32(-118.625), 0xC276_A000);
/// assert_eq!(files::segy::ibm_from_f32(f32::NAN), 0);
/// ```
pub fn ibm_from_f32(value: f32) -> u32 {
    if value == 0.0 || value.is_nan() {
        return 0;
    }
    let sign = if value < 0.0 { 1_u32 << 31 } else { 0 };
    let magnitude = f64::from(value.abs().min(f32::MAX));
    let exponent_2 = ((magnitude.to_bits() >> 52) & 0x7ff) as i32 - 1022;
    // The smallest e with magnitude < 16^(e-64); magnitude < 2^exponent_2.
    let mut exponent = exponent_2.div_euclid(4) + i32::from(exponent_2.rem_euclid(4) != 0) + 64;
    let scale = f64::from_bits(((1023 + 24 - 4 * (exponent - 64)) as u64) << 52);
    let mut fraction = (magnitude * scale).round_ties_even() as u32;
    if fraction == 1 << 24 {
        fraction >>= 4;
        exponent += 1;
    }
    sign | (exponent as u32) << 24 | fraction
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ibm_vectors() {
        for (bits, value) in [(0x4110_0000, 1.0), (0x4264_0000, 100.0), (0xC276_A000, -118.625), (0, 0.0)] {
            assert_eq!(f32_from_ibm(bits), value);
            assert_eq!(ibm_from_f32(value), bits);
        }
    }

    #[test]
    fn ibm_is_what_double_precision_makes_of_it() {
        // Every exponent, fractions at and between the powers of two.
        for exponent in 0..=127_u32 {
            for bit in 0..24 {
                for low in [0, 1, 0x5555, 0x00ab_cdef & ((1 << bit) - 1)] {
                    let fraction = (1 << bit | low) & 0x00ff_ffff;
                    let exact = f64::from(fraction) * 2.0_f64.powi(4 * exponent as i32 - 280);
                    let bits = exponent << 24 | fraction;
                    assert_eq!(f32_from_ibm(bits), exact as f32, "{bits:#x}");
                    assert_eq!(f32_from_ibm(bits | 1 << 31), -exact as f32, "{bits:#x}");
                }
            }
        }
    }

    #[test]
    fn ibm_extremes() {
        assert_eq!(f32_from_ibm(0x7fff_ffff), f32::INFINITY);
        assert_eq!(f32_from_ibm(0xffff_ffff), f32::NEG_INFINITY);
        assert_eq!(f32_from_ibm(0x0010_0000), 0.0);
        assert_eq!(f32_from_ibm(0x4000_0001), 2.0_f32.powi(-24));
        assert_eq!(ibm_from_f32(f32::NAN), 0);
        assert_eq!(f32_from_ibm(ibm_from_f32(f32::INFINITY)), f32::MAX);
        assert_eq!(f32_from_ibm(ibm_from_f32(f32::MIN_POSITIVE)), f32::MIN_POSITIVE);
        assert_eq!(f32_from_ibm(ibm_from_f32(1e-40)), 1e-40);
    }

    #[test]
    fn ibm_round_trip_is_exact_both_ways_where_the_bits_suffice() {
        let mut state = 1_u32;
        for _ in 0..100_000 {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            // Normalised IBM numbers in the range of f32 come back bit by bit.
            let bits = (state & 0x80ff_ffff) | 0x0010_0000 | (0x2a + (state >> 8) % 0x30) << 24;
            assert_eq!(ibm_from_f32(f32_from_ibm(bits)), bits, "{bits:08x}");
            let value = f32::from_bits(state);
            if value.is_normal() {
                let back = f32_from_ibm(ibm_from_f32(value));
                assert!((back - value).abs() <= value.abs() * 2.0_f32.powi(-21), "{value} {back}");
            }
        }
    }

    #[test]
    fn every_format_in_both_orders() {
        let cases: [(SampleFormat, &[u8], f32); 13] = [
            (SampleFormat::Ibm32, &[0xc2, 0x76, 0xa0, 0], -118.625),
            (SampleFormat::Int32, &[0xff, 0xff, 0xff, 0xfe], -2.0),
            (SampleFormat::Int16, &[0x80, 0], -32768.0),
            (SampleFormat::Ieee32, &[0xc0, 0x20, 0, 0], -2.5),
            (SampleFormat::Ieee64, &[0xc0, 0x04, 0, 0, 0, 0, 0, 0], -2.5),
            (SampleFormat::Int24, &[0xff, 0xff, 0], -256.0),
            (SampleFormat::Int8, &[0x80], -128.0),
            (SampleFormat::Int64, &[0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xfe], -2.0),
            (SampleFormat::Uint32, &[0x80, 0, 0, 0], 2_147_483_648.0),
            (SampleFormat::Uint16, &[0x80, 1], 32769.0),
            (SampleFormat::Uint64, &[0x80, 0, 0, 0, 0, 0, 0, 0], 9_223_372_036_854_775_808.0),
            (SampleFormat::Uint24, &[0x80, 0, 1], 8_388_609.0),
            (SampleFormat::Uint8, &[0x80], 128.0),
        ];
        for (format, bytes, expected) in cases {
            assert_eq!(bytes.len(), format.bytes());
            assert_eq!(SampleFormat::from_code(format.code()).unwrap(), Some(format));
            let mut out = [0.0];
            format.decode(ByteOrder::Big, bytes, &mut out);
            assert_eq!(out[0], expected, "{}", format.name());
            let reversed: Vec<u8> = bytes.iter().rev().copied().collect();
            format.decode(ByteOrder::Little, &reversed, &mut out);
            assert_eq!(out[0], expected, "{}", format.name());
        }
    }

    #[test]
    fn other_codes_are_refused_by_name() {
        let sentence = SampleFormat::from_code(4).unwrap_err().to_string();
        assert!(sentence.contains("code 4") && sentence.contains("gain"), "{sentence}");
        assert!(SampleFormat::from_code(17).unwrap().is_none());
        assert!(SampleFormat::from_code(0).unwrap().is_none());
    }
}
