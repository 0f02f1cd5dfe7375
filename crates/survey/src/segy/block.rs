//! Parts of a SEG-Y file, for volumes that are larger than memory: traces are read in the order in which they lie in the file, whatever
//! order the lattice has.

use super::error::{SegyError, SegyProblem};
use super::file::SegyFile;
use super::sample::SampleFormat;
use crate::progress::Progress;
use crate::store::{Block, Ingested, LineOrder, StoreError, StoredSample, VolumeInfo, WriteSettings, resume_volume};
use rayon::prelude::*;
use std::ops::Range;
use std::path::Path;

/// A file in the store.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StoredFile {
    /// What was written.
    pub ingested: Ingested,
    /// Samples that were no numbers and became 0.
    pub non_finite: u64,
}

/// Traces that a thread reads one after the other.
const TRACES_TOGETHER: usize = 128;

/// The smallest type that holds a file's samples exactly, of those the store keeps as they are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ExactType {
    /// Integers of one byte.
    Int8,
    /// Integers of one byte, unsigned.
    Uint8,
    /// Integers of two bytes.
    Int16,
    /// Integers of two bytes, unsigned.
    Uint16,
    /// All others: IBM and IEEE floats, and wider integers as far as float32 holds them.
    Float32,
}

impl SegyFile {
    /// The type to store the samples in. Weighted traces are floats.
    pub fn exact_type(&self) -> ExactType {
        match self.info().sample_format {
            _ if self.is_weighted() => ExactType::Float32,
            SampleFormat::Int8 => ExactType::Int8,
            SampleFormat::Uint8 => ExactType::Uint8,
            SampleFormat::Int16 => ExactType::Int16,
            SampleFormat::Uint16 => ExactType::Uint16,
            _ => ExactType::Float32,
        }
    }

    /// Writes the file's samples to the store at `path`, in their [`SegyFile::exact_type`], in at most `memory_bytes` (where a column of shards
    /// needs no more), and goes on where an earlier call with the same `fingerprint` was interrupted (see [`resume_volume`]).
    ///
    /// # Errors
    /// [`StoreError`]; a cancel comes as [`StoreError::Source`] with the [`SegyError`] or as [`StoreError::Cancelled`].
    pub fn store(
        &self,
        path: &Path,
        fingerprint: &str,
        info: &VolumeInfo,
        memory_bytes: u64,
        progress: &Progress,
    ) -> Result<StoredFile, StoreError> {
        // The type is chosen here, so that what is made for it is compiled with this crate's optimisations whoever calls.
        let store = match self.exact_type() {
            ExactType::Int8 => Self::store_as::<i8>,
            ExactType::Uint8 => Self::store_as::<u8>,
            ExactType::Int16 => Self::store_as::<i16>,
            ExactType::Uint16 => Self::store_as::<u16>,
            ExactType::Float32 => Self::store_as::<f32>,
        };
        store(self, path, fingerprint, info, memory_bytes, progress)
    }

    fn store_as<T: StoredSample>(
        &self,
        path: &Path,
        fingerprint: &str,
        info: &VolumeInfo,
        memory_bytes: u64,
        progress: &Progress,
    ) -> Result<StoredFile, StoreError> {
        let order = if self.info().sorted_by == "crossline" { LineOrder::Crosslines } else { LineOrder::Inlines };
        let settings = WriteSettings { memory_bytes, order };
        let mut non_finite = 0;
        let supply = |block: &Block, room: Vec<T>| {
            let (samples, bad) = self.read_block(block.inlines.clone(), block.crosslines.clone(), room, progress)?;
            self.release();
            non_finite += bad;
            Ok(samples.into())
        };
        let live = self.live();
        let ingested =
            resume_volume(path, fingerprint, self.size(), live.as_deref(), info, &settings, supply, progress)?;
        Ok(StoredFile { ingested, non_finite })
    }

    /// The samples of a range of inlines and crosslines, `[inline][crossline][sample]`, 0 where there is no trace; and how many
    /// of them were no numbers and became 0. `room` is memory to use. Memory: the block, and 40 bytes a trace.
    ///
    /// # Errors
    /// [`SegyProblem::Cancelled`].
    pub fn read_block<T: StoredSample>(
        &self,
        inlines: Range<usize>,
        crosslines: Range<usize>,
        room: Vec<T>,
        progress: &Progress,
    ) -> Result<(Vec<T>, u64), SegyError> {
        let [_, _, samples] = self.size();
        let mut block = room;
        block.resize(inlines.len() * crosslines.len() * samples, T::from_f32(0.0));
        let places = inlines.flat_map(|x| crosslines.clone().map(move |y| (x, y)));
        let mut traces: Vec<(usize, (usize, usize), &mut [T])> = block
            .chunks_mut(samples)
            .zip(places)
            .filter_map(|(out, (x, y))| match self.trace_at(x, y) {
                Some(trace) => Some((trace, (x, y), out)),
                None => {
                    out.fill(T::from_f32(0.0));
                    None
                }
            })
            .collect();
        traces.sort_unstable_by_key(|(trace, ..)| *trace);
        let read = traces
            .par_chunks_mut(TRACES_TOGETHER)
            .map_init(
                || vec![0.0f32; samples],
                |floats, traces| {
                    progress.check()?;
                    let mut non_finite = 0;
                    for (_, (x, y), out) in traces {
                        if T::TYPE == f32::TYPE
                            && let Ok(out) = bytemuck::try_cast_slice_mut::<T, f32>(out)
                        {
                            non_finite += self.read_trace(*x, *y, out) as u64;
                            continue;
                        }
                        non_finite += self.read_trace(*x, *y, floats) as u64;
                        out.iter_mut().zip(&*floats).for_each(|(out, &value)| *out = T::from_f32(value));
                    }
                    Ok(non_finite)
                },
            )
            .collect::<Result<Vec<u64>, crate::progress::Cancelled>>();
        let non_finite = read.map_err(|cancelled| SegyProblem::from(cancelled).in_file(&self.path))?;
        Ok((block, non_finite.into_iter().sum()))
    }
}
