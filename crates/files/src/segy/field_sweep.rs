//! The search over all trace header fields, for files whose line numbers or coordinates are at no usual place.
//!
//! Two fields are line numbers where they make a full lattice in which X and Y are affine, and X and Y are two
//! neighbouring fields that are affine in a lattice of lines, with perpendicular bins of a plausible size. Fields that
//! hold counters, line numbers once more, or anything else fail one of these tests. First the 4-byte fields are read, as
//! integers and floats, then 2-byte fields and 4-byte integers between two fields of the standard.

use super::columns::Columns;
use super::coordinates::is_coordinate;
use super::header::{Field, NO_INTEGER};
use super::number_type::NumberType;

/// No survey has larger line numbers. The bits of floats, read as integers, are larger.
pub(super) const MAX_LINE_NUMBER: u32 = 100_000_000;
/// So many fields are tried at most.
const MOST_FIELDS: usize = 16;
/// The last byte at which a 4-byte field of a 240-byte header begins.
const LAST: u16 = 237;

/// Fields that are read at once.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Sweep {
    /// Every 4-byte field of the standard's grid.
    FourBytes,
    /// Every 2-byte field, and 4-byte integers beside the grid.
    TwoBytes,
}

impl Sweep {
    /// The sweep after another, or the first.
    pub(super) fn after(done: Option<Self>) -> Option<Self> {
        match done {
            None => Some(Self::FourBytes),
            Some(Self::FourBytes) => Some(Self::TwoBytes),
            Some(Self::TwoBytes) => None,
        }
    }

    /// Types of number that its fields may hold, the usual ones first.
    pub(super) fn types(self) -> &'static [NumberType] {
        match self {
            Self::FourBytes => &[NumberType::I32, NumberType::F32, NumberType::Ibm32],
            Self::TwoBytes => &[NumberType::I32, NumberType::I16],
        }
    }

    /// First bytes of its fields of a type.
    fn bytes(self, number_type: NumberType) -> impl Iterator<Item = u16> {
        match (self, number_type) {
            (Self::FourBytes, _) => (1..=LAST).step_by(4),
            (Self::TwoBytes, NumberType::I16) => (1..=LAST + 2).step_by(2),
            (Self::TwoBytes, _) => (3..=LAST - 2).step_by(4),
        }
    }

    /// These fields and those of the sweep.
    pub(super) fn with_fields(self, mut fields: Vec<Field>) -> Vec<Field> {
        for number_type in self.types() {
            let field = |byte: u16| if *number_type == NumberType::I16 { Field::I16(byte) } else { Field::I32(byte) };
            let more: Vec<Field> =
                self.bytes(*number_type).map(field).filter(|field| !fields.contains(field)).collect();
            fields.extend(more);
        }
        fields
    }

    /// Fields that vary, hold numbers that lines may have, and are not known to hold coordinates: those with the smallest
    /// spans, since lines have few numbers.
    pub(super) fn line_fields(self, columns: &Columns, number_type: NumberType) -> Vec<u16> {
        let mut spans: Vec<(i64, u16)> = self
            .bytes(number_type)
            .filter(|byte| !(is_coordinate(*byte) || *byte > 2 && is_coordinate(*byte - 2)))
            .filter_map(|byte| {
                let column = columns.numbers(byte, number_type);
                let [low, high] = column.range;
                let is_small = [low, high].iter().all(|number| number.unsigned_abs() <= MAX_LINE_NUMBER);
                // A 2-byte number before something that never varies.
                let is_short = || number_type == NumberType::I32 && column.iter().all(|n| (n ^ low) & 0xffff == 0);
                (low != NO_INTEGER && is_small && low != high && !is_short())
                    .then_some((i64::from(high) - i64::from(low), byte))
            })
            .collect();
        spans.sort_unstable();
        spans.truncate(MOST_FIELDS);
        let mut bytes: Vec<u16> = spans.into_iter().map(|(_, byte)| byte).collect();
        bytes.sort_unstable();
        bytes
    }
}

/// Neighbouring 4-byte fields that both vary, where all were read: X and Y may be any of them.
pub(super) fn coordinate_pairs(columns: &Columns) -> Vec<[u16; 2]> {
    if !columns.has_all_of(Sweep::FourBytes) {
        return Vec::new();
    }
    let varies = |byte: u16| columns.get(Field::I32(byte)).constant().is_none();
    (1..=LAST - 4).step_by(4).filter(|&byte| varies(byte) && varies(byte + 4)).map(|byte| [byte, byte + 4]).collect()
}
