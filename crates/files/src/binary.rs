//! Numbers of binary files, in either byte order, one after the other and never beyond the end.

use super::FormatError;
use super::text::SourceFile;

/// The order of the bytes of a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Endian {
    Little,
    Big,
}

/// The type of a number in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Word {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

fn each<const N: usize>(bytes: &[u8], endian: Endian, of: fn([u8; N]) -> f64) -> Vec<f64> {
    let value = |word: &[u8; N]| {
        let mut word = *word;
        if endian == Endian::Big {
            word.reverse();
        }
        of(word)
    };
    bytes.as_chunks::<N>().0.iter().map(value).collect()
}

impl Word {
    /// Bytes of one.
    pub(crate) const fn bytes(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    /// The whole numbers in bytes. It takes 8 bytes for each.
    pub(crate) fn values(self, bytes: &[u8], endian: Endian) -> Vec<f64> {
        match self {
            Self::I8 => each(bytes, endian, |word| f64::from(i8::from_le_bytes(word))),
            Self::U8 => each(bytes, endian, |word| f64::from(u8::from_le_bytes(word))),
            Self::I16 => each(bytes, endian, |word| f64::from(i16::from_le_bytes(word))),
            Self::U16 => each(bytes, endian, |word| f64::from(u16::from_le_bytes(word))),
            Self::I32 => each(bytes, endian, |word| f64::from(i32::from_le_bytes(word))),
            Self::U32 => each(bytes, endian, |word| f64::from(u32::from_le_bytes(word))),
            Self::I64 => each(bytes, endian, |word| i64::from_le_bytes(word) as f64),
            Self::U64 => each(bytes, endian, |word| u64::from_le_bytes(word) as f64),
            Self::F32 => each(bytes, endian, |word| f64::from(f32::from_le_bytes(word))),
            Self::F64 => each(bytes, endian, f64::from_le_bytes),
        }
    }
}

/// The part of a file that is not read yet.
pub(super) struct BinaryCursor<'a> {
    source: &'a SourceFile,
    pub rest: &'a [u8],
    pub endian: Endian,
}

impl<'a> BinaryCursor<'a> {
    /// From a byte of the file on; nothing where that is beyond its end.
    pub(super) fn at(source: &'a SourceFile, byte: usize, endian: Endian) -> Self {
        Self { source, rest: source.bytes.get(byte..).unwrap_or_default(), endian }
    }

    /// The next bytes.
    pub(super) fn take(&mut self, bytes: usize) -> Result<&'a [u8], FormatError> {
        let (taken, rest) =
            self.rest.split_at_checked(bytes).ok_or_else(|| self.source.length("bytes", bytes, self.rest.len()))?;
        self.rest = rest;
        Ok(taken)
    }

    /// The next numbers of a type.
    pub(super) fn numbers<const N: usize>(&mut self, word: Word) -> Result<[f64; N], FormatError> {
        let mut numbers = [0.0; N];
        for number in &mut numbers {
            *number = self.number(word)?;
        }
        Ok(numbers)
    }

    /// The next number.
    pub(super) fn number(&mut self, word: Word) -> Result<f64, FormatError> {
        Ok(word.values(self.take(word.bytes())?, self.endian)[0])
    }

    /// The next number as a count of things; a negative one is none.
    pub(super) fn count(&mut self, word: Word) -> Result<usize, FormatError> {
        Ok(self.number(word)? as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_every_type_in_both_orders() {
        let source = SourceFile { path: "a".into(), bytes: vec![0xff, 0xfe, 0x41, 0x20, 0, 0, 7] };
        for (endian, wanted) in [(Endian::Big, [-2.0, 10.0]), (Endian::Little, [-257.0, 1.157_05e-41])] {
            let mut cursor = BinaryCursor::at(&source, 0, endian);
            let found = [cursor.number(Word::I16).unwrap(), cursor.number(Word::F32).unwrap()];
            assert!((found[0] - wanted[0]).abs() < 1e-9 && (found[1] / wanted[1] - 1.0).abs() < 1e-3, "{found:?}");
            assert!(cursor.number(Word::I16).is_err());
        }
        assert!(BinaryCursor::at(&source, 99, Endian::Big).rest.is_empty());
        assert_eq!(Word::U64.values(&[1, 0, 0, 0, 0, 0, 0, 0, 9], Endian::Little), [1.0]);
        assert_eq!(Word::F64.values(&1.5_f64.to_be_bytes(), Endian::Big), [1.5]);
    }
}
