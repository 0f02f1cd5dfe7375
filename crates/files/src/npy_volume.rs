//! A volume in a NumPy array of three axes, `[inline][crossline][sample]`, in C or Fortran order, which has no places:
//! those of the lattice that it is imported into.
//!
//! It is read in parts, for which it takes 16 bytes for each sample of an inline, or of a slice in Fortran order.
//! Integers of up to two bytes stay what they are, other numbers become floats of four bytes. NaN and infinity are no
//! data, and counted; a trace of nothing else is not live.

use super::FormatError;
use super::binary::Word;
use super::npy::{ArrayHeader, LONGEST_HEADER, SIGNATURE};
use std::borrow::Cow;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use survey::Progress;
use survey::sample::{Sample, SampleType, SamplesMut};
use survey::source::{Block, BlockSource, LineOrder, SourceError};

/// Numbers that are looked at together where all are.
const TOGETHER: usize = 1 << 18;

/// An open array.
pub struct NpyVolume {
    path: PathBuf,
    file: File,
    header: ArrayHeader,
    size: [usize; 3],
    live: Option<Vec<bool>>,
    non_finite: u64,
}

impl NpyVolume {
    /// Whether a file begins as an array.
    pub fn is_one(path: &Path) -> bool {
        let mut start = [0; SIGNATURE.len()];
        let found = system::file::ordinary(path).and_then(|_| File::open(path)?.read_exact(&mut start));
        found.is_ok() && start == SIGNATURE
    }

    /// Opens an array.
    ///
    /// # Errors
    /// [`FormatError`] when it cannot be read, is cut off, or has other than three axes.
    pub fn open(path: &Path) -> Result<Self, FormatError> {
        let io = |source| FormatError::Io { action: "read", file: path.to_owned(), source };
        let length = system::file::ordinary(path).map_err(io)?.len();
        let mut file = File::open(path).map_err(io)?;
        let mut start = Vec::new();
        (&mut file).take(LONGEST_HEADER as u64 + 12).read_to_end(&mut start).map_err(io)?;
        let header = ArrayHeader::parse(path, &start)?;
        let sides = if header.shape.len() == 3 { header.shape.clone() } else { header.sides() };
        let bad = |why: String| FormatError::BadGrid { file: path.to_owned(), why };
        let size: [usize; 3] = sides[..].try_into().map_err(|_| {
            bad(format!("its shape is {:?}: a volume has three axes, inlines, crosslines and samples", header.shape))
        })?;
        let expected = header.bytes().filter(|bytes| *bytes > 0).ok_or_else(|| bad(format!("a shape of {size:?}")))?;
        let found = length.saturating_sub(header.data_at as u64) as usize;
        if found != expected {
            return Err(FormatError::Length { file: path.to_owned(), what: "bytes of numbers", expected, found });
        }
        Ok(Self { path: path.to_owned(), file, header, size, live: None, non_finite: 0 })
    }

    /// Checks that it has a value for each sample of a lattice.
    ///
    /// # Errors
    /// [`FormatError::OtherLattice`].
    pub fn check_lattice(&self, lattice: Option<[usize; 3]>) -> Result<(), FormatError> {
        if lattice == Some(self.size) {
            return Ok(());
        }
        Err(FormatError::OtherLattice { file: self.path.clone(), found: self.size, lattice })
    }

    /// Type and order of its numbers, for a record.
    pub fn reading(&self) -> String {
        let order = if self.header.is_fortran { "Fortran" } else { "C" };
        format!("NumPy array of {:?}, {:?}, in {order} order", self.header.word, self.header.endian)
    }

    /// Numbers that were NaN or infinite so far.
    pub fn non_finite(&self) -> u64 {
        self.non_finite
    }

    fn is_float(&self) -> bool {
        matches!(self.header.word, Word::F32 | Word::F64)
    }

    /// Finds the traces without any number, which are not live. It reads the whole array.
    ///
    /// # Errors
    /// An error of reading, or [`Cancelled`](survey::Cancelled).
    pub fn find_dead(&mut self, progress: &Progress) -> Result<(), SourceError> {
        let [inlines, crosslines, samples] = self.size;
        if !self.is_float() {
            return Ok(());
        }
        let all = inlines * crosslines * samples;
        let mut live = vec![false; inlines * crosslines];
        for first in (0..all).step_by(TOGETHER) {
            progress.check()?;
            let values = self.numbers(first, TOGETHER.min(all - first))?;
            for (n, _) in values.iter().enumerate().filter(|(_, value)| value.is_finite()) {
                let n = first + n;
                let trace = match self.header.is_fortran {
                    true => n % inlines * crosslines + n / inlines % crosslines,
                    false => n / samples,
                };
                live[trace] = true;
            }
        }
        self.live = live.contains(&false).then_some(live);
        Ok(())
    }

    /// Numbers in the order of the file.
    fn numbers(&mut self, first: usize, count: usize) -> Result<Vec<f64>, SourceError> {
        let width = self.header.word.bytes();
        self.file.seek(SeekFrom::Start((self.header.data_at + first * width) as u64))?;
        let mut bytes = vec![0; count * width];
        self.file.read_exact(&mut bytes)?;
        Ok(self.header.word.values(&bytes, self.header.endian))
    }

    fn sample<T: Sample>(&mut self, value: f64) -> T {
        if value.is_finite() {
            return T::from_f32(value as f32);
        }
        self.non_finite += 1;
        T::from_f32(f32::NAN)
    }

    /// Traces that are not live hold zeros, which take no room where they are stored.
    fn empty_dead<T: Sample>(&self, block: &Block, out: &mut [T]) {
        let (Some(live), [_, crosslines, samples]) = (&self.live, self.size) else { return };
        let traces = block.inlines.clone().flat_map(|x| block.crosslines.clone().map(move |y| x * crosslines + y));
        for (_, trace) in traces.zip(out.chunks_exact_mut(samples)).filter(|(at, _)| !live[*at]) {
            trace.fill(T::from_f32(0.0));
        }
    }

    fn fill<T: Sample>(&mut self, block: &Block, out: &mut [T], progress: &Progress) -> Result<(), SourceError> {
        let [inlines, crosslines, samples] = self.size;
        let (x, y) = (block.inlines.clone(), block.crosslines.clone());
        if !self.header.is_fortran {
            let line = y.len() * samples;
            for (inline, out) in x.zip(out.chunks_exact_mut(line)) {
                progress.check()?;
                let values = self.numbers((inline * crosslines + y.start) * samples, line)?;
                out.iter_mut().zip(values).for_each(|(slot, value)| *slot = self.sample(value));
            }
            return Ok(());
        }
        // A slice of one sample holds one inline after the other for each crossline.
        let span = (y.len() - 1) * inlines + x.len();
        for sample in 0..samples {
            progress.check()?;
            let values = self.numbers((sample * crosslines + y.start) * inlines + x.start, span)?;
            for (n, slot) in out[sample..].iter_mut().step_by(samples).enumerate() {
                *slot = self.sample(values[n % y.len() * inlines + n / y.len()]);
            }
        }
        Ok(())
    }
}

impl BlockSource for NpyVolume {
    fn size(&self) -> [usize; 3] {
        self.size
    }

    fn live(&self) -> Option<Cow<'_, [bool]>> {
        self.live.as_deref().map(Cow::Borrowed)
    }

    fn order(&self) -> LineOrder {
        if self.header.is_fortran { LineOrder::Crosslines } else { LineOrder::Inlines }
    }

    fn sample_type(&self) -> SampleType {
        match self.header.word {
            Word::I8 => SampleType::Int8,
            Word::U8 => SampleType::Uint8,
            Word::I16 => SampleType::Int16,
            Word::U16 => SampleType::Uint16,
            _ => SampleType::Float32,
        }
    }

    fn read_block(&mut self, block: &Block, out: SamplesMut<'_>, progress: &Progress) -> Result<(), SourceError> {
        survey::of_any_type!(out, |samples| {
            self.fill(block, samples, progress)?;
            self.empty_dead(block, samples);
            Ok(())
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: [usize; 3] = [4, 3, 5];

    /// The value of a sample tells its place.
    fn value(x: usize, y: usize, k: usize) -> f64 {
        (100 * x + 10 * y + k) as f64
    }

    fn array(kind: &str, is_fortran: bool, encode: &dyn Fn(f64) -> Vec<u8>) -> Vec<u8> {
        let [nx, ny, nz] = SIZE;
        let word = if is_fortran { "True" } else { "False" };
        let head = format!("{{'descr': '{kind}', 'fortran_order': {word}, 'shape': ({nx}, {ny}, {nz}), }}\n");
        let place = |n: usize| match is_fortran {
            true => value(n % nx, n / nx % ny, n / nx / ny),
            false => value(n / nz / ny, n / nz % ny, n % nz),
        };
        let data = (0..nx * ny * nz).flat_map(|n| encode(place(n)));
        [b"\x93NUMPY\x01\0", &(head.len() as u16).to_le_bytes()[..], head.as_bytes()]
            .concat()
            .into_iter()
            .chain(data)
            .collect()
    }

    fn opened(content: &[u8]) -> (tempfile::TempDir, Result<NpyVolume, FormatError>) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.npy");
        std::fs::write(&path, content).unwrap();
        assert!(NpyVolume::is_one(&path));
        let volume = NpyVolume::open(&path);
        (folder, volume)
    }

    fn read(volume: &mut NpyVolume, block: &Block) -> Vec<f64> {
        let count = block.inlines.len() * block.crosslines.len() * SIZE[2];
        let quiet = Progress::silent();
        if volume.sample_type() == SampleType::Int16 {
            let mut out = vec![0_i16; count];
            volume.read_block(block, SamplesMut::Int16(&mut out), &quiet).unwrap();
            return out.into_iter().map(f64::from).collect();
        }
        let mut out = vec![0_f32; count];
        volume.read_block(block, SamplesMut::Float32(&mut out), &quiet).unwrap();
        out.into_iter().map(f64::from).collect()
    }

    #[test]
    fn blocks_of_both_orders_and_many_types_have_each_sample_at_its_place() {
        type Encode<'a> = &'a dyn Fn(f64) -> Vec<u8>;
        let kinds: [(&str, Encode<'_>); 5] = [
            ("<f4", &|v| (v as f32).to_le_bytes().to_vec()),
            (">f8", &|v| v.to_be_bytes().to_vec()),
            ("<i2", &|v| (v as i16).to_le_bytes().to_vec()),
            (">i4", &|v| (v as i32).to_be_bytes().to_vec()),
            ("<u8", &|v| (v as u64).to_le_bytes().to_vec()),
        ];
        for (kind, encode) in kinds {
            for is_fortran in [false, true] {
                let (_folder, volume) = opened(&array(kind, is_fortran, encode));
                let mut volume = volume.unwrap();
                assert!(volume.check_lattice(Some(SIZE)).is_ok());
                for block in [Block { inlines: 0..4, crosslines: 0..3 }, Block { inlines: 1..3, crosslines: 1..2 }] {
                    let places = block.inlines.clone().flat_map(|x| block.crosslines.clone().map(move |y| (x, y)));
                    let wanted: Vec<f64> = places.flat_map(|(x, y)| (0..5).map(move |k| value(x, y, k))).collect();
                    assert_eq!(read(&mut volume, &block), wanted, "{kind} {is_fortran} {block:?}");
                }
            }
        }
    }

    #[test]
    fn traces_without_numbers_are_not_live_and_other_holes_are_counted() {
        for is_fortran in [false, true] {
            let holed = |v: f64| if (110.0..120.0).contains(&v) || v == 203.0 { f64::NAN } else { v };
            let (_folder, volume) = opened(&array("<f8", is_fortran, &|v| holed(v).to_le_bytes().to_vec()));
            let mut volume = volume.unwrap();
            volume.find_dead(&Progress::silent()).unwrap();
            let live = volume.live().unwrap().into_owned();
            assert_eq!((live.iter().filter(|live| !**live).count(), live[4]), (1, false));
            let samples = read(&mut volume, &Block { inlines: 0..4, crosslines: 0..3 });
            assert!(samples[2 * 15 + 3].is_nan() && samples[20..25] == [0.0; 5], "{samples:?}");
            assert_eq!((volume.non_finite(), samples[2 * 15 + 4]), (6, 204.0));
        }
    }

    #[test]
    fn arrays_that_are_no_volume_of_the_lattice_are_refused() {
        let whole = array("<f4", false, &|v| (v as f32).to_le_bytes().to_vec());
        for cut in 8..whole.len() {
            assert!(opened(&whole[..cut]).1.is_err(), "{cut}");
        }
        let flat = String::from_utf8_lossy(&whole[..10]).into_owned();
        assert!(flat.contains("NUMPY"));
        let (_folder, volume) = opened(&whole);
        let volume = volume.unwrap();
        for (lattice, words) in [(None, "no lattice"), (Some([3, 4, 5]), "4 x 3 x 5")] {
            let error = volume.check_lattice(lattice).unwrap_err().to_string();
            assert!(error.contains(words), "{error}");
        }
    }
}
