//! Geologic time slab by slab: each is solved on its own, then joined to the one before it.

use super::ProjectError;
use crate::content;
use crate::document::{Document, VolumeEntry};
use crate::interpretation::assembly;
use crate::interpretation::candidates::{Candidates, amplitudes};
use crate::interpretation::times::{Obeyed, QUANTITY};
use ::time::{JoinedSlabs, Slabs, TimeSettings, find_faults, geologic_time, surfaces_within};
use std::borrow::Cow;
use std::collections::VecDeque;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;
use store::{StoredVolume, VolumeInfo};
use survey::sample::{SampleType, SamplesMut};
use survey::source::{Block, BlockSource, SourceError};
use survey::{Progress, Volume};

/// What geologic time of a project is solved from.
pub struct TimeSlabs {
    /// The volume of amplitudes.
    pub from: VolumeEntry,
    pub(super) obeyed: Obeyed,
    volume: StoredVolume,
    candidates: Arc<Candidates>,
    settings: TimeSettings,
    slabs: Slabs,
}

impl TimeSlabs {
    /// Reads the present extraction and the interpretation; as few slabs as fit into so many bytes beside the candidates.
    ///
    /// # Errors
    /// There are no candidates, data are damaged, or the user cancelled.
    pub fn open(
        root: &Path,
        document: &Document,
        settings: &TimeSettings,
        memory_bytes: u64,
        progress: &Progress,
    ) -> Result<Self, ProjectError> {
        let candidates = Candidates::load(root, document, progress)?;
        let from = amplitudes(document)?.clone();
        let geometry = document.frame()?;
        let network = assembly::blocks(root, document, progress)?;
        let obeyed = Obeyed::load(root, document, &network, progress)?;
        let volume = content::open_recorded(root, &from, geometry)?;
        let slabs = Slabs::within(geometry.size(), memory_bytes);
        Ok(Self { from, obeyed, volume, candidates, settings: settings.clone(), slabs })
    }

    /// The inlines of each slab; neighbouring ones have some in common.
    pub fn ranges(&self) -> &[Range<usize>] {
        self.slabs.ranges()
    }

    /// What the volume of geologic time says of itself.
    pub fn info(&self) -> VolumeInfo {
        VolumeInfo {
            quantity: Some(QUANTITY.to_owned()),
            unit: Some("samples".to_owned()),
            source: Some(format!("{QUANTITY} of {}", self.from.name)),
            ..VolumeInfo::of(self.volume.info().geometry.clone())
        }
    }

    /// τ of a slab by its own clock, and the number of faults that were found where none is drawn.
    ///
    /// # Errors
    /// Data are damaged, or the user cancelled.
    pub fn solve(&self, slab: usize, progress: &Progress) -> Result<(Volume<f32>, usize), ProjectError> {
        let (range, [nx, ny, nz]) = (&self.ranges()[slab], self.volume.size(0));
        let part = self.volume.read_box_f32(0, [range.start, 0, 0], [range.len(), ny, nz])?;
        let all = &self.candidates.forest.surfaces;
        let surfaces = if *range == (0..nx) { Cow::Borrowed(all) } else { Cow::Owned(surfaces_within(all, range)) };
        let mut told = self.obeyed.interpretation.within(range);
        let mut found = 0;
        if told.cuts.is_empty() && self.obeyed.interpretation.cuts.is_empty() {
            let faults = find_faults(&part, &surfaces, self.settings.fewest_vertices, progress)?;
            found = faults.len();
            told.cuts = faults.into_iter().map(|fault| fault.cut).collect();
        }
        Ok((geologic_time(&part, &surfaces, &told, &self.settings, progress)?.tau, found))
    }
}

/// τ, computed a slab at a time as blocks are asked for, from the first inline to the last.
pub(super) struct SlabTimes<'a> {
    slabs: &'a TimeSlabs,
    joined: JoinedSlabs,
    /// Number of slabs that were solved.
    solved: usize,
    /// Lines that were solved and may still be asked for, and the first of them.
    lines: VecDeque<Vec<f32>>,
    first: usize,
    /// Voxels at which τ is known, and faults that were found where none is drawn.
    pub(super) known: usize,
    pub(super) found: usize,
}

impl<'a> SlabTimes<'a> {
    /// Nothing is computed yet.
    pub(super) fn new(slabs: &'a TimeSlabs) -> Self {
        let (joined, lines) = (JoinedSlabs::default(), VecDeque::new());
        Self { slabs, joined, solved: 0, lines, first: 0, known: 0, found: 0 }
    }

    /// Solves the next slab.
    fn advance(&mut self, progress: &Progress) -> Result<(), ProjectError> {
        let [_, ny, nz] = self.slabs.volume.size(0);
        let (tau, found) = self.slabs.solve(self.solved, progress)?;
        self.solved += 1;
        self.found += found;
        let done = self.joined.add(&tau, self.solved == self.slabs.ranges().len());
        self.known += done.iter().filter(|time| time.is_finite()).count();
        self.lines.extend(done.chunks_exact(ny * nz).map(<[f32]>::to_vec));
        Ok(())
    }
}

impl BlockSource for SlabTimes<'_> {
    fn size(&self) -> [usize; 3] {
        self.slabs.volume.size(0)
    }

    fn live(&self) -> Option<Cow<'_, [bool]>> {
        // As in one piece: on a dead trace τ is not known.
        None
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
        let nz = self.slabs.volume.size(0)[2];
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
    match source.downcast::<ProjectError>() {
        Ok(own) => *own,
        Err(source) => store::StoreError::Source { path, source }.into(),
    }
}
