//! Rows of integers of which each differs little from the one before, in few bytes: most of what stages hand on is the
//! lattice of surfaces, and writing it as it is would take more time than to make it.
//!
//! Each number is stored as its difference from the same number of the row before (of the first row: from 0), with the
//! sign in the lowest bit, seven bits to a byte, low ones first; the highest bit of a byte tells that more follow. A run
//! of rows is coded alone, so that it can be read without those before it ([`Stretch`]).

use super::Bricks;
use crate::error::InterpError;
use bytemuck::{Pod, Zeroable};

/// A run of rows in a part of an array: its bytes, from and to, and its count of rows.
#[derive(Debug, Clone, Copy, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Stretch {
    bytes: [u64; 2],
    pub(crate) rows: u64,
}

/// Most bytes that a number takes.
const MOST: usize = 5;

/// Bits of a number in a byte.
const BITS: u32 = 7;

/// Tells that more bytes follow.
const MORE: u8 = 1 << BITS;

/// Rows that come one by one, coded as a run.
pub(crate) struct Coder<const N: usize> {
    before: [u32; N],
    rows: u64,
    code: Vec<u8>,
}

impl<const N: usize> Default for Coder<N> {
    fn default() -> Self {
        Self { before: [0; N], rows: 0, code: Vec::new() }
    }
}

impl<const N: usize> Coder<N> {
    pub(crate) fn push(&mut self, row: [u32; N]) {
        add_row(self.before, row, &mut self.code);
        self.before = row;
        self.rows += 1;
    }

    /// Adds the run to the end of `code`.
    pub(crate) fn append_to(self, code: &mut Vec<u8>) -> Stretch {
        let start = code.len() as u64;
        code.extend_from_slice(&self.code);
        Stretch { bytes: [start, code.len() as u64], rows: self.rows }
    }
}

/// Adds the code of rows to the end of `code`.
pub(crate) fn add<const N: usize>(rows: impl IntoIterator<Item = [u32; N]>, code: &mut Vec<u8>) -> Stretch {
    let start = code.len() as u64;
    let (mut before, mut count) = ([0u32; N], 0);
    let rows = rows.into_iter();
    code.reserve(rows.size_hint().0 * N * 3 / 2);
    for row in rows {
        add_row(before, row, code);
        (before, count) = (row, count + 1);
    }
    Stretch { bytes: [start, code.len() as u64], rows: count }
}

fn add_row<const N: usize>(before: [u32; N], row: [u32; N], code: &mut Vec<u8>) {
    let mut room = [[0u8; MOST]; N];
    let room = room.as_flattened_mut();
    let mut length = 0;
    for (number, before) in row.into_iter().zip(before) {
        let difference = number.wrapping_sub(before) as i32;
        let mut rest = (difference << 1 ^ difference >> 31) as u32;
        while rest >= u32::from(MORE) {
            room[length] = rest as u8 | MORE;
            rest >>= BITS;
            length += 1;
        }
        room[length] = rest as u8;
        length += 1;
    }
    code.extend_from_slice(&room[..length]);
}

/// Adds so many rows to the end of `rows`; `None` where the code is another's.
fn decode<const N: usize>(code: &[u8], count: usize, rows: &mut Vec<[u32; N]>) -> Option<()> {
    // A row is at least a byte for each number, so what is damaged asks for no more room than there are bytes.
    if count.checked_mul(N)? > code.len() {
        return None;
    }
    rows.reserve(count);
    let (mut before, mut rest) = ([0u32; N], code.iter());
    for _ in 0..count {
        for number in &mut before {
            let mut byte = *rest.next()?;
            let mut coded = u32::from(byte & !MORE);
            let mut shift = BITS;
            while byte & MORE != 0 {
                byte = *rest.next()?;
                coded |= u32::from(byte & !MORE).checked_shl(shift)?;
                shift += BITS;
            }
            *number = number.wrapping_add(coded >> 1 ^ (coded & 1).wrapping_neg());
        }
        rows.push(before);
    }
    rest.next().is_none().then_some(())
}

impl Bricks<'_> {
    /// Adds the rows of a stretch to the end of `rows`; `room` is for its code.
    pub(super) fn rows_of<const N: usize>(
        &self,
        array: &str,
        part: usize,
        stretch: &Stretch,
        room: &mut Vec<u8>,
        rows: &mut Vec<[u32; N]>,
    ) -> Result<(), InterpError> {
        let damaged = || InterpError::DamagedArray { array: array.to_owned() };
        let [start, end] = stretch.bytes;
        room.resize(end.checked_sub(start).ok_or_else(damaged)? as usize, 0);
        self.arrays.read(array, part, start, room).map_err(InterpError::Arrays)?;
        decode(room, stretch.rows as usize, rows).ok_or_else(damaged)
    }

    /// Writes a part that is one stretch.
    pub(super) fn write_rows<const N: usize>(
        &self,
        array: &str,
        part: usize,
        rows: impl IntoIterator<Item = [u32; N]>,
    ) -> Result<(), InterpError> {
        let mut code = Vec::new();
        add(rows, &mut code);
        self.write(array, part, &code)
    }

    /// A part that is one stretch of so many rows.
    pub(super) fn read_rows<const N: usize>(
        &self,
        array: &str,
        part: usize,
        count: usize,
    ) -> Result<Vec<[u32; N]>, InterpError> {
        let (code, mut rows) = (self.read::<u8>(array, part)?, Vec::new());
        decode(&code, count, &mut rows).ok_or_else(|| InterpError::DamagedArray { array: array.to_owned() })?;
        Ok(rows)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_come_back() {
        let mut code = vec![7; 3];
        let mut state = 9u32;
        let mut random = move |bits: u32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            state.checked_shr(32 - bits).unwrap_or(0)
        };
        let runs: Vec<Vec<[u32; 3]>> = (0..40usize)
            .map(|n| (0..n * n).map(|m| [random(m as u32 % 33), random(8), [0, u32::MAX, 1 << 31][m % 3]]).collect())
            .collect();
        let stretches: Vec<Stretch> = runs.iter().map(|run| add(run.iter().copied(), &mut code)).collect();
        for (stretch, run) in stretches.iter().zip(&runs) {
            let [start, end] = stretch.bytes.map(|at| at as usize);
            let mut found = vec![[1, 2, 3]];
            decode(&code[start..end], stretch.rows as usize, &mut found).unwrap();
            assert_eq!(found[1..], **run);
        }
    }

    #[test]
    fn rows_that_come_one_by_one_are_coded_alike() {
        let rows: Vec<[u32; 2]> = (0..200).map(|n| [n * n * n, 1 << (n % 32)]).collect();
        let [mut together, mut one_by_one] = [vec![1, 2], vec![1, 2]];
        let mut coder = Coder::default();
        rows.iter().for_each(|row| coder.push(*row));
        assert_eq!(add(rows, &mut together), coder.append_to(&mut one_by_one));
        assert_eq!(together, one_by_one);
    }

    #[test]
    fn neighbours_of_a_lattice_take_a_byte_each() {
        let mut code = Vec::new();
        let stretch = add((0..1000).map(|n| [5_000_000 + n, 7_000_000 + 60 * n, 3]), &mut code);
        assert_eq!((stretch.rows, code.len()), (1000, 3000 + 3 + 3));
    }

    #[test]
    fn what_is_no_code_is_told() {
        let mut code = Vec::new();
        add((0..50).map(|n| [n << 20, n]), &mut code);
        let told = |code: &[u8], count| decode::<2>(code, count, &mut Vec::new()).is_none();
        assert!(!told(&code, 50));
        assert!(told(&code, 49) && told(&code, 51) && told(&code, usize::MAX));
        assert!((0..code.len()).all(|length| told(&code[..length], 50)));
        assert!(told(&[0xff; 40], 2));
    }
}
