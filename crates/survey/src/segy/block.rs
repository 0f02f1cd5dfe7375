//! Parts of a SEG-Y file, for volumes that are larger than memory: traces are read in the order in which they lie in the file, whatever
//! order the lattice has.

use super::error::{SegyError, SegyProblem};
use super::file::SegyFile;
use super::sample::SampleFormat;
use crate::progress::Progress;
use crate::store::StoredSample;
use rayon::prelude::*;
use std::ops::Range;

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

    /// The samples of a range of inlines and crosslines, `[inline][crossline][sample]`, 0 where there is no trace; and how many
    /// of them were no numbers and became 0. Memory: the block, and 24 bytes a trace.
    ///
    /// # Errors
    /// [`SegyProblem::Cancelled`].
    pub fn read_block<T: StoredSample>(
        &self,
        inlines: Range<usize>,
        crosslines: Range<usize>,
        progress: &Progress,
    ) -> Result<(Vec<T>, u64), SegyError> {
        let [_, _, samples] = self.size();
        let mut block = vec![T::from_f32(0.0); inlines.len() * crosslines.len() * samples];
        let places = inlines.flat_map(|x| crosslines.clone().map(move |y| (x, y)));
        let mut traces: Vec<(usize, (usize, usize), &mut [T])> = block
            .chunks_mut(samples)
            .zip(places)
            .filter_map(|(out, (x, y))| Some((self.trace_at(x, y)?, (x, y), out)))
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
