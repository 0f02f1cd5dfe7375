//! Blocks of a SEG-Y file, for volumes that are larger than memory. Traces are read in file order, whatever
//! the order of the lattice.

use super::error::{SegyError, SegyProblem};
use super::file::SegyFile;
use super::sample::SampleFormat;
use rayon::prelude::*;
use std::borrow::Cow;
use survey::progress::{Cancelled, Progress};
use survey::sample::{Sample, SampleType, SamplesMut};
use survey::source::{Block, BlockSource, LineOrder, SourceError};

/// Count of consecutive traces that a thread reads.
const TRACES_TOGETHER: usize = 128;

impl SegyFile {
    /// The smallest type that holds the samples exactly: integers of one and two bytes as they are, all
    /// others (IBM and IEEE floats, wider integers as far as float32 holds them, weighted traces) as floats.
    pub fn sample_type(&self) -> SampleType {
        match self.info().sample_format {
            _ if self.is_weighted() => SampleType::Float32,
            SampleFormat::Int8 => SampleType::Int8,
            SampleFormat::Uint8 => SampleType::Uint8,
            SampleFormat::Int16 => SampleType::Int16,
            SampleFormat::Uint16 => SampleType::Uint16,
            _ => SampleType::Float32,
        }
    }

    /// The file's samples, block by block, in their [`SegyFile::sample_type`].
    pub fn blocks(&self) -> SegyBlocks<'_> {
        SegyBlocks { file: self, non_finite: 0 }
    }

    /// Reads the samples of a block, `[inline][crossline][sample]`, 0 where there is no trace, by `read` of
    /// one trace; returns how many of them were NaN or infinite and became 0. Memory: 40 bytes per trace.
    fn read_traces<T: Sample>(
        &self,
        block: &Block,
        out: &mut [T],
        progress: &Progress,
        read: impl Fn([usize; 2], &mut [T], &mut [f32]) -> usize + Sync,
    ) -> Result<u64, SegyError> {
        let [_, _, samples] = self.size();
        let places = block.inlines.clone().flat_map(|x| block.crosslines.clone().map(move |y| [x, y]));
        let mut traces: Vec<(usize, [usize; 2], &mut [T])> = out
            .chunks_mut(samples)
            .zip(places)
            .filter_map(|(out, [x, y])| match self.trace_at(x, y) {
                Some(trace) => Some((trace, [x, y], out)),
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
                    Ok(traces.iter_mut().map(|(_, place, out)| read(*place, out, floats) as u64).sum())
                },
            )
            .collect::<Result<Vec<u64>, Cancelled>>();
        let non_finite = read.map_err(|cancelled| SegyProblem::from(cancelled).in_file(&self.path))?;
        Ok(non_finite.into_iter().sum())
    }

    /// Reads a block by way of floats.
    fn read_converted<T: Sample>(&self, block: &Block, out: &mut [T], progress: &Progress) -> Result<u64, SegyError> {
        self.read_traces(block, out, progress, |[x, y], out, floats| {
            let non_finite = self.read_trace(x, y, floats);
            out.iter_mut().zip(&*floats).for_each(|(out, &value)| *out = T::from_f32(value));
            non_finite
        })
    }
}

/// The samples of a file, block by block.
#[derive(Debug)]
pub struct SegyBlocks<'a> {
    file: &'a SegyFile,
    non_finite: u64,
}

impl SegyBlocks<'_> {
    /// Samples of the blocks read so far that were no numbers and became 0.
    pub fn non_finite(&self) -> u64 {
        self.non_finite
    }
}

impl BlockSource for SegyBlocks<'_> {
    fn size(&self) -> [usize; 3] {
        self.file.size()
    }

    fn live(&self) -> Option<Cow<'_, [bool]>> {
        self.file.live().map(Cow::Owned)
    }

    fn order(&self) -> LineOrder {
        if self.file.info().sorted_by == "crossline" { LineOrder::Crosslines } else { LineOrder::Inlines }
    }

    fn sample_type(&self) -> SampleType {
        self.file.sample_type()
    }

    fn read_block(&mut self, block: &Block, out: SamplesMut<'_>, progress: &Progress) -> Result<(), SourceError> {
        let file = self.file;
        self.non_finite += match out {
            SamplesMut::Int8(out) => file.read_converted(block, out, progress),
            SamplesMut::Uint8(out) => file.read_converted(block, out, progress),
            SamplesMut::Int16(out) => file.read_converted(block, out, progress),
            SamplesMut::Uint16(out) => file.read_converted(block, out, progress),
            SamplesMut::Int32(out) => file.read_converted(block, out, progress),
            SamplesMut::Uint32(out) => file.read_converted(block, out, progress),
            SamplesMut::Float32(out) => {
                file.read_traces(block, out, progress, |[x, y], out, _| file.read_trace(x, y, out))
            }
        }?;
        file.release();
        Ok(())
    }
}
