//! Geologic time slab by slab, as a source of blocks for the store.

use super::ProjectError;
use ::time::{
    Interpretation, JoinedSlabs, Slabs, TimeError, TimeSettings, find_faults, geologic_time, surfaces_within,
};
use interp::Surfaces;
use std::borrow::Cow;
use std::collections::VecDeque;
use store::StoredVolume;
use survey::Progress;
use survey::sample::{SampleType, SamplesMut};
use survey::source::{Block, BlockSource, SourceError};

/// τ of a stored volume, computed a slab at a time as blocks are asked for, from the first inline to the last.
pub(super) struct SlabTimes<'a> {
    pub(super) volume: &'a StoredVolume,
    pub(super) surfaces: &'a Surfaces,
    pub(super) interpretation: &'a Interpretation,
    pub(super) settings: &'a TimeSettings,
    pub(super) slabs: Slabs,
    pub(super) joined: JoinedSlabs,
    /// Number of slabs that were solved.
    pub(super) solved: usize,
    /// Lines that were solved and may still be asked for, and the first of them.
    pub(super) lines: VecDeque<Vec<f32>>,
    pub(super) first: usize,
    /// Voxels at which τ is known, and faults that were found where none is drawn.
    pub(super) known: usize,
    pub(super) found: usize,
}

impl<'a> SlabTimes<'a> {
    /// Nothing is computed yet.
    pub(super) fn new(
        volume: &'a StoredVolume,
        surfaces: &'a Surfaces,
        interpretation: &'a Interpretation,
        settings: &'a TimeSettings,
        slabs: Slabs,
    ) -> Self {
        let joined = JoinedSlabs::default();
        let lines = VecDeque::new();
        Self {
            volume,
            surfaces,
            interpretation,
            settings,
            slabs,
            joined,
            solved: 0,
            lines,
            first: 0,
            known: 0,
            found: 0,
        }
    }

    /// Solves the next slab.
    fn advance(&mut self, progress: &Progress) -> Result<(), SourceError> {
        let range = self.slabs.ranges()[self.solved].clone();
        let [_, ny, nz] = self.volume.size(0);
        let part = self.volume.read_box_f32(0, [range.start, 0, 0], [range.len(), ny, nz])?;
        let surfaces = surfaces_within(self.surfaces, &range);
        let mut told = self.interpretation.within(&range);
        if self.interpretation.cuts.is_empty() {
            let found =
                find_faults(&part, &surfaces, self.settings.fewest_vertices, progress).map_err(TimeError::from)?;
            self.found += found.len();
            told.cuts = found.into_iter().map(|fault| fault.cut).collect();
        }
        let tau = geologic_time(&part, &surfaces, &told, self.settings, progress)?.tau;
        self.solved += 1;
        let done = self.joined.add(&tau, self.solved == self.slabs.ranges().len());
        self.known += done.iter().filter(|time| time.is_finite()).count();
        self.lines.extend(done.chunks_exact(ny * nz).map(<[f32]>::to_vec));
        Ok(())
    }
}

impl BlockSource for SlabTimes<'_> {
    fn size(&self) -> [usize; 3] {
        self.volume.size(0)
    }

    fn live(&self) -> Option<Cow<'_, [bool]>> {
        Some(Cow::Borrowed(self.volume.live()))
    }

    fn sample_type(&self) -> SampleType {
        SampleType::Float32
    }

    fn read_block(&mut self, block: &Block, out: SamplesMut<'_>, progress: &Progress) -> Result<(), SourceError> {
        let SamplesMut::Float32(out) = out else { return Err("geologic time is of floats".into()) };
        while self.first < block.inlines.start && !self.lines.is_empty() {
            self.lines.pop_front();
            self.first += 1;
        }
        while self.first + self.lines.len() < block.inlines.end {
            self.advance(progress)?;
        }
        let nz = self.volume.size(0)[2];
        let own = block.crosslines.start * nz..block.crosslines.end * nz;
        for (n, out) in out.chunks_exact_mut(own.len()).enumerate() {
            out.copy_from_slice(&self.lines[block.inlines.start + n - self.first][own.clone()]);
        }
        Ok(())
    }
}

/// The error that a computation put into the writer of its blocks.
pub(super) fn explain(error: store::StoreError) -> ProjectError {
    let store::StoreError::Source { path, source } = error else { return error.into() };
    match source.downcast::<TimeError>() {
        Ok(own) => (*own).into(),
        Err(source) => match source.downcast::<store::StoreError>() {
            Ok(store) => (*store).into(),
            Err(source) => store::StoreError::Source { path, source }.into(),
        },
    }
}
