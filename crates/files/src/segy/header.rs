//! Fields of the binary and trace headers. Positions are the standard's: 1-based bytes of the file or trace
//! header.

use super::bytes::{BYTES_TOGETHER, Bytes};
use super::error::SegyProblem;
use super::number_type::NumberType;
use super::sample::{ByteOrder, f32_from_ibm};
use std::ops::Range;

/// Bytes of the textual and binary file headers together.
pub(super) const FILE_HEADER_BYTES: usize = 3600;
/// Bytes of one trace header.
pub(super) const TRACE_HEADER_BYTES: usize = 240;
/// `0x01020304` at byte 3297 (revision 2) states the byte order.
pub(super) const ORDER_CONSTANT: u32 = 0x0102_0304;

/// Trace header positions.
pub(super) mod at {
    /// Trace number in the line.
    pub(crate) const TRACE_IN_LINE: u16 = 1;
    /// Trace number in the file.
    pub(crate) const TRACE_IN_FILE: u16 = 5;
    /// Original field record number.
    pub(crate) const FIELD_RECORD: u16 = 9;
    /// Trace number in the field record.
    pub(crate) const TRACE_IN_RECORD: u16 = 13;
    /// CDP ensemble number.
    pub(crate) const CDP: u16 = 21;
    /// Trace number in the ensemble.
    pub(crate) const TRACE_IN_CDP: u16 = 25;
    /// Trace identification code, i16; 1 live, 2 dead.
    pub(crate) const TRACE_ID: u16 = 29;
    /// Data use, i16; 1 production.
    pub(crate) const DATA_USE: u16 = 35;
    /// Source to receiver distance.
    pub(crate) const OFFSET: u16 = 37;
    /// Coordinate scalar, i16.
    pub(crate) const COORDINATE_SCALAR: u16 = 71;
    /// Coordinate unit, i16.
    pub(crate) const COORDINATE_UNIT: u16 = 89;
    /// Lag time A, i16.
    pub(crate) const LAG_A: u16 = 105;
    /// Delay recording time, i16.
    pub(crate) const DELAY: u16 = 109;
    /// Samples in this trace, u16.
    pub(crate) const SAMPLES: u16 = 115;
    /// Sample interval of this trace, u16.
    pub(crate) const INTERVAL: u16 = 117;
    /// Trace weighting factor, i16.
    pub(crate) const WEIGHT: u16 = 169;
    /// Extended CDP X and Y in the first trace header extension of revision 2: IEEE floats of 8 bytes.
    pub(crate) const EXTENDED_CDP: [u16; 2] = [401, 409];
    /// CDP X.
    pub(crate) const CDP_X: u16 = 181;
    /// CDP Y.
    pub(crate) const CDP_Y: u16 = 185;
    /// Inline number.
    pub(crate) const INLINE: u16 = 189;
    /// Crossline number.
    pub(crate) const CROSSLINE: u16 = 193;
    /// Time scalar, i16, for the times at 95 to 114.
    pub(crate) const TIME_SCALAR: u16 = 215;
}

/// The fields of the binary file header that reading needs.
#[derive(Debug, Clone, Copy)]
pub(super) struct BinaryHeader {
    pub interval: u16,
    pub samples: u16,
    pub format: u16,
    pub measurement: u16,
    pub polarity: u16,
    pub extended_samples: u32,
    pub extended_interval: f64,
    pub order_constant: u32,
    /// Major and minor; (0, 0) for every value that no revision has.
    pub revision: (u8, u8),
    pub extended_headers: i16,
    pub extra_trace_headers: i16,
    pub trace_count: u64,
    pub first_trace: u64,
    pub trailers: i32,
}

impl BinaryHeader {
    /// Reads from the first 3600 bytes of a file.
    pub(super) fn parse(file: &[u8], order: ByteOrder) -> Self {
        let u16_at = |byte: usize| u16::from_be_bytes(order.get(file, byte - 1));
        let u64_at = |byte: usize| u64::from_be_bytes(order.get(file, byte - 1));
        Self {
            interval: u16_at(3217),
            samples: u16_at(3221),
            format: u16_at(3225),
            measurement: u16_at(3255),
            polarity: u16_at(3257),
            extended_samples: u32::from_be_bytes(order.get(file, 3268)),
            extended_interval: f64::from_be_bytes(order.get(file, 3272)),
            order_constant: u32::from_be_bytes(order.get(file, 3296)),
            revision: revision(u16_at(3501), [file[3500], file[3501]]),
            extended_headers: u16_at(3505).cast_signed(),
            extra_trace_headers: u16_at(3507).cast_signed(),
            trace_count: u64_at(3513),
            first_trace: u64_at(3521),
            trailers: i32::from_be_bytes(order.get(file, 3528)),
        }
    }

    /// Whether the fields that revision 2 added mean something.
    pub(super) fn has_revision_2(&self) -> bool {
        self.revision.0 >= 2
    }
}

/// Revision 1 stores one 16-bit number (0x0100), revision 2 two bytes (2, minor) whatever the byte order.
fn revision(word: u16, stored: [u8; 2]) -> (u8, u8) {
    match (word.to_be_bytes(), stored) {
        ([major @ 1..=2, minor], _) => (major, minor),
        (_, [2, minor @ 0..=1]) => (2, minor),
        _ => (0, 0),
    }
}

/// The traces of a file.
#[derive(Debug, Clone, Copy)]
pub(super) struct Traces<'a> {
    pub bytes: &'a Bytes,
    /// Byte at which the first one begins.
    pub start: u64,
    pub count: usize,
    pub order: ByteOrder,
    /// Bytes of a trace, headers included.
    pub stride: usize,
    /// Bytes of its headers: 240, or a multiple with trace header extensions.
    pub header_bytes: usize,
}

/// Traces up to this length are read whole for their headers. A call for each header costs as much time as
/// copying so many bytes.
const READ_WHOLE: usize = 4096;

impl<'a> Traces<'a> {
    /// Traces that are read at once, at least one.
    pub(super) fn together(&self) -> usize {
        (BYTES_TOGETHER / self.stride).max(1)
    }

    /// The bytes of consecutive traces.
    pub(super) fn run<'b>(&self, traces: Range<usize>, room: &'b mut Vec<u8>) -> Result<&'b [u8], SegyProblem>
    where
        'a: 'b,
    {
        let byte = |trace: usize| self.start + trace as u64 * self.stride as u64;
        self.bytes.read(byte(traces.start)..byte(traces.end), room, Some(traces.start))
    }

    /// The headers of consecutive traces side by side in `out`, extensions included.
    pub(super) fn headers(
        &self,
        traces: Range<usize>,
        out: &mut Vec<u8>,
        room: &mut Vec<u8>,
    ) -> Result<(), SegyProblem> {
        out.clear();
        if self.stride > READ_WHOLE {
            out.resize(traces.len() * self.header_bytes, 0);
            for (trace, header) in traces.zip(out.chunks_exact_mut(self.header_bytes)) {
                self.bytes.copy(self.start + trace as u64 * self.stride as u64, header, Some(trace))?;
            }
            return Ok(());
        }
        for first in traces.clone().step_by(self.together()) {
            let run = first..(first + self.together()).min(traces.end);
            let bytes = self.run(run, room)?;
            bytes.chunks_exact(self.stride).for_each(|trace| out.extend_from_slice(&trace[..self.header_bytes]));
        }
        Ok(())
    }
}

/// What a field holds in place of a line number that is no integer.
pub(super) const NO_INTEGER: i32 = i32::MIN;

/// A float that counts lines, as the integer it is.
pub(super) fn integer(value: f64) -> i32 {
    let is_integer = (value - value.round()).abs() < 1e-3 && value.abs() < f64::from(i32::MAX);
    if is_integer { value.round() as i32 } else { NO_INTEGER }
}

/// A number in a trace header.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Field {
    /// 4 bytes, signed.
    I32(u16),
    /// 2 bytes, signed.
    I16(u16),
    /// 2 bytes, unsigned.
    U16(u16),
    /// An IEEE float of 8 bytes that holds an integer.
    F64(u16),
}

impl Field {
    /// Its value in a trace header, which must reach that far.
    pub(super) fn get(self, header: &[u8], order: ByteOrder) -> i32 {
        match self {
            Self::I32(byte) => i32::from_be_bytes(order.get(header, usize::from(byte) - 1)),
            Self::I16(byte) => i32::from(i16::from_be_bytes(order.get(header, usize::from(byte) - 1))),
            Self::U16(byte) => i32::from(u16::from_be_bytes(order.get(header, usize::from(byte) - 1))),
            Self::F64(byte) => integer(f64::from_be_bytes(order.get(header, usize::from(byte) - 1))),
        }
    }

    /// [`Field::get`] of trace headers that lie side by side, each of `header_bytes`.
    pub(super) fn get_all(self, headers: &[u8], header_bytes: usize, order: ByteOrder) -> Vec<i32> {
        /// The loop over headers for one type of number.
        fn each<const N: usize>(
            headers: std::slice::ChunksExact<'_, u8>,
            byte: u16,
            order: ByteOrder,
            convert: impl Fn([u8; N]) -> i32,
        ) -> Vec<i32> {
            let offset = usize::from(byte) - 1;
            match order {
                ByteOrder::Big => headers.map(|header| convert(ByteOrder::Big.get(header, offset))).collect(),
                ByteOrder::Little => headers.map(|header| convert(ByteOrder::Little.get(header, offset))).collect(),
            }
        }
        let headers = headers.chunks_exact(header_bytes);
        match self {
            Self::I32(byte) => each(headers, byte, order, i32::from_be_bytes),
            Self::I16(byte) => each(headers, byte, order, |bytes| i32::from(i16::from_be_bytes(bytes))),
            Self::U16(byte) => each(headers, byte, order, |bytes| i32::from(u16::from_be_bytes(bytes))),
            Self::F64(byte) => each(headers, byte, order, |bytes| integer(f64::from_be_bytes(bytes))),
        }
    }
}

/// The number that starts where a 4-byte field starts, from that field: every type but [`NumberType::F64`].
pub(super) fn reinterpret(field: i32, number_type: NumberType, order: ByteOrder) -> i32 {
    let bits = field.cast_unsigned();
    let half = match order {
        ByteOrder::Big => (bits >> 16) as u16,
        ByteOrder::Little => bits as u16,
    };
    match number_type {
        NumberType::I32 | NumberType::F64 => field,
        NumberType::I16 => i32::from(half.cast_signed()),
        NumberType::U16 => i32::from(half),
        NumberType::F32 => integer(f64::from(f32::from_bits(bits))),
        NumberType::Ibm32 => integer(f64::from(f32_from_ibm(bits))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_of_any_type_is_found_in_the_four_bytes_where_it_starts() {
        for order in [ByteOrder::Big, ByteOrder::Little] {
            let field = |bytes: [u8; 4]| {
                let mut stored = [0; 4];
                order.put(&mut stored, 0, bytes);
                Field::I32(1).get(&stored, order)
            };
            let halves = |first: u16| {
                let mut stored = [0; 4];
                order.put(&mut stored, 0, first.to_be_bytes());
                order.put(&mut stored, 2, 777_u16.to_be_bytes());
                Field::I32(1).get(&stored, order)
            };
            assert_eq!(reinterpret(halves(40_000), NumberType::U16, order), 40_000);
            assert_eq!(reinterpret(halves(40_000), NumberType::I16, order), 40_000 - 65_536);
            assert_eq!(reinterpret(field(1207.0_f32.to_be_bytes()), NumberType::F32, order), 1207);
            assert_eq!(reinterpret(field(1207.5_f32.to_be_bytes()), NumberType::F32, order), NO_INTEGER);
            assert_eq!(reinterpret(field(0x4264_0000_u32.to_be_bytes()), NumberType::Ibm32, order), 100);
            let mut stored = [0; 8];
            order.put(&mut stored, 0, (-12.0_f64).to_be_bytes());
            assert_eq!(Field::F64(1).get(&stored, order), -12);
        }
        assert_eq!(integer(f64::NAN), NO_INTEGER);
        assert_eq!(integer(1e300), NO_INTEGER);
    }

    #[test]
    fn revisions_in_both_conventions() {
        assert_eq!(revision(0x0100, [1, 0]), (1, 0));
        assert_eq!(revision(0x0201, [2, 1]), (2, 1));
        assert_eq!(revision(0x0002, [2, 0]), (2, 0), "revision 2, little-endian, stores bytes");
        assert_eq!(revision(0x0001, [0, 1]), (0, 0));
        assert_eq!(revision(0x3030, [0x30, 0x30]), (0, 0));
    }
}
