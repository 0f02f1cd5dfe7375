//! Blocks of a SEG-Y file, for volumes that are larger than memory. Traces are read in file order, whatever
//! the order of the lattice.

use super::error::{SegyError, SegyProblem};
use super::file::SegyFile;
use super::sample::SampleFormat;
use rayon::prelude::*;
use std::borrow::Cow;
use survey::progress::Progress;
use survey::sample::{Sample, SampleType, SamplesMut};
use survey::source::{Block, BlockSource, LineOrder, SourceError};

/// Count of consecutive traces that a thread reads.
const TRACES_TOGETHER: usize = 128;

impl SegyFile {
    /// The smallest type that holds the samples exactly: integers of one and two bytes as they are, all
    /// others (IBM and IEEE floats, wider integers as far as float32 holds them, weighted traces) as floats. Where an
    /// amplitude stands for no data, floats, too: NaN is none.
    pub fn sample_type(&self) -> SampleType {
        match self.info().sample_format {
            _ if self.is_weighted() || self.has_null() => SampleType::Float32,
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

    /// Reads the samples of a block, `[inline][crossline][sample]`, 0 where there is no trace, by `decode` of
    /// one trace; returns how many of them were NaN or infinite. Memory: 32 bytes per trace, and
    /// 256 KiB or a trace per thread.
    fn read_traces<T: Sample>(
        &self,
        block: &Block,
        out: &mut [T],
        progress: &Progress,
        decode: impl Fn(usize, &[u8], &mut [T], &mut [f32]) -> usize + Sync,
    ) -> Result<u64, SegyError> {
        let [_, _, samples] = self.size();
        let places = block.inlines.clone().flat_map(|x| block.crosslines.clone().map(move |y| [x, y]));
        let mut traces: Vec<(usize, &mut [T])> = Vec::with_capacity(block.inlines.len() * block.crosslines.len());
        for (out, [x, y]) in out.chunks_mut(samples).zip(places) {
            match self.trace_at(x, y) {
                Some(trace) => traces.push((trace, out)),
                None => out.fill(T::from_f32(0.0)),
            }
        }
        traces.sort_unstable_by_key(|(trace, _)| *trace);
        let read = traces
            .par_chunks_mut(TRACES_TOGETHER)
            .map_init(
                || (Vec::new(), vec![0.0f32; samples]),
                |(room, floats), traces| {
                    progress.check().map_err(|cancelled| SegyProblem::from(cancelled).in_file(&self.path))?;
                    let mut non_finite = 0;
                    self.read_in_order(traces, room, |trace, bytes, out| {
                        non_finite += decode(trace, bytes, out, floats) as u64;
                    })?;
                    Ok(non_finite)
                },
            )
            .collect::<Result<Vec<u64>, SegyError>>()?;
        Ok(read.into_iter().sum())
    }

    /// Reads a block by way of floats.
    fn read_converted<T: Sample>(&self, block: &Block, out: &mut [T], progress: &Progress) -> Result<u64, SegyError> {
        self.read_traces(block, out, progress, |trace, bytes, out, floats| {
            let non_finite = self.decode(trace, bytes, floats);
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
    /// Samples of the blocks read so far that were no numbers: no data.
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
                file.read_traces(block, out, progress, |trace, bytes, out, _| file.decode(trace, bytes, out))
            }
        }?;
        Ok(())
    }
}
