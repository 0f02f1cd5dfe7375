//! Geologic time slab by slab: each is solved on its own, then joined to the one before it.

use super::ProjectError;
use crate::content;
use crate::derived::FaultBlocks;
use crate::document::{Document, VolumeEntry};
use crate::facts::Facts;
use crate::interpretation::candidates::Candidates;
use crate::interpretation::extraction;
use crate::interpretation::times::{Obeyed, found_cuts};
use ::time::{Cut, JoinedSlabs, Slabs, TimeSettings, geologic_time, surfaces_within};
use interp::{Extremum, InterpError, Surface, Surfaces, Vertex};
use std::borrow::Cow;
use std::collections::VecDeque;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;
use store::{StoredCandidates, StoredVolume, VolumeInfo};
use survey::sample::{SampleType, SamplesMut};
use survey::source::{Block, BlockSource, SourceError};
use survey::{Progress, Quantity, Volume};

/// What geologic time of a project is solved from.
pub struct TimeSlabs {
    /// The volume of amplitudes.
    pub from: VolumeEntry,
    pub(super) obeyed: Obeyed,
    /// Faults that were found where none is drawn; `None` where slabs look for their own.
    found: Option<Vec<Cut>>,
    volume: StoredVolume,
    candidates: SlabCandidates,
    settings: TimeSettings,
    slabs: Slabs,
}

/// Where the surfaces of a slab come from.
enum SlabCandidates {
    /// All of them are in memory, for a single slab.
    All(Arc<Candidates>),
    /// Those of a slab are read.
    Stored(StoredCandidates),
}

/// The parts of stored surfaces within a range of inlines, counted from its start, as [`surfaces_within`] makes them of all
/// surfaces: read some at a time.
fn read_surfaces_within(
    stored: &StoredCandidates,
    inlines: &Range<usize>,
    progress: &Progress,
) -> Result<Surfaces, ProjectError> {
    let [_, ny, nz] = stored.info().size;
    let rows = stored.read_surfaces(&progress.muted())?;
    let batches = store::surface_batches(&rows);
    let mut found = Surfaces { size: [inlines.len(), ny, nz], ..Surfaces::default() };
    progress.begin("reading surfaces", batches.len() as u64);
    for batch in batches {
        let part = surfaces_within(&surfaces_of(stored, &rows[batch.clone()], batch.start)?, inlines);
        let [vertices, triangles] = [found.vertices.len(), found.triangles.len()].map(|count| count as u32);
        found.vertices.extend(part.vertices);
        found.triangles.extend(part.triangles.into_iter().map(|corners| corners.map(|v| v + vertices)));
        let moved = |range: Range<u32>, by: u32| range.start + by..range.end + by;
        found.surfaces.extend(part.surfaces.into_iter().map(|surface| Surface {
            extremum: surface.extremum,
            vertices: moved(surface.vertices, vertices),
            triangles: moved(surface.triangles, triangles),
        }));
        progress.step(1)?;
    }
    Ok(found)
}

/// Stored surfaces that follow one another, numbered from 0.
fn surfaces_of(stored: &StoredCandidates, rows: &[[u32; 5]], index: usize) -> Result<Surfaces, ProjectError> {
    let bad = |n: usize, fact| InterpError::MalformedSurfaces { surface: index + n, fact };
    let mut made = Surfaces { size: stored.info().size, ..Surfaces::default() };
    let (Some([_, first_vertex, _, first, _]), Some([_, _, end_vertex, _, end])) = (rows.first(), rows.last()) else {
        return Ok(made);
    };
    let vertices = *first_vertex as usize..*end_vertex as usize;
    let places = stored.read_traces(vertices.clone())?.into_iter().zip(stored.read_depths(vertices)?);
    made.vertices = places.map(|([x, y], z)| Vertex { x, y, z }).collect();
    made.triangles = stored.read_triangles(*first as usize..*end as usize)?;
    made.triangles.as_flattened_mut().iter_mut().for_each(|corner| *corner = corner.wrapping_sub(*first_vertex));
    let (mut vertex, mut triangle) = (*first_vertex, *first);
    for (n, &[kind, from, to, start, stop]) in rows.iter().enumerate() {
        let follows = from == vertex && start == triangle && to >= from && stop >= start;
        let extremum = [Extremum::Peak, Extremum::Trough, Extremum::Zero].get(kind as usize).filter(|_| follows);
        let extremum = *extremum.ok_or_else(|| bad(n, "it does not follow the one before"))?;
        (vertex, triangle) = (to, stop);
        let surface = Surface {
            extremum,
            vertices: from - first_vertex..to - first_vertex,
            triangles: start - first..stop - first,
        };
        let own = made.triangles.get(surface.triangles.start as usize..surface.triangles.end as usize);
        let own = own.ok_or_else(|| bad(n, "it ends after the arrays do"))?.as_flattened();
        if own.iter().any(|corner| !surface.vertices.contains(corner)) {
            return Err(bad(n, "a triangle has a corner that is not its own").into());
        }
        made.surfaces.push(surface);
    }
    Ok(made)
}

impl TimeSlabs {
    /// Reads the present extraction and the interpretation; as few slabs as fit into so many bytes beside the candidates of
    /// one of them.
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
        let slabs = Slabs::within(document.frame()?.size(), memory_bytes);
        let candidates = if slabs.ranges().len() == 1 {
            SlabCandidates::All(Candidates::load(Facts::of(root, document), progress)?)
        } else {
            SlabCandidates::Stored(extraction::open(root, document)?)
        };
        let from = document.amplitudes()?.clone();
        let geometry = document.frame()?;
        let network = Facts::of(root, document).get(&FaultBlocks, progress)?;
        let obeyed = Obeyed::load(root, document, &network, progress)?;
        let volume = content::open_recorded(root, &from, geometry)?;
        let is_whole = slabs.ranges().len() == 1;
        let found = match obeyed.interpretation.cuts.is_empty() && is_whole {
            true => Some(found_cuts(Facts::of(root, document), progress)?),
            false => None,
        };
        Ok(Self { from, obeyed, found, volume, candidates, settings: settings.clone(), slabs })
    }

    /// The inlines of each slab; neighbouring ones have some in common.
    pub fn ranges(&self) -> &[Range<usize>] {
        self.slabs.ranges()
    }

    /// What the volume of geologic time says of itself.
    pub fn info(&self) -> VolumeInfo {
        VolumeInfo {
            quantity: Some(Quantity::GeologicTime),
            unit: Some("samples".to_owned()),
            source: Some(format!("{} of {}", Quantity::GeologicTime, self.from.name)),
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
        let surfaces = match &self.candidates {
            SlabCandidates::All(all) if *range == (0..nx) => Cow::Borrowed(&all.forest.surfaces),
            SlabCandidates::All(all) => Cow::Owned(surfaces_within(&all.forest.surfaces, range)),
            SlabCandidates::Stored(stored) => Cow::Owned(read_surfaces_within(stored, range, progress)?),
        };
        let mut told = self.obeyed.interpretation.within(range);
        let mut found = 0;
        if let Some(cuts) = &self.found {
            told.cuts.clone_from(cuts);
            found = cuts.len();
        } else if told.cuts.is_empty() && self.obeyed.interpretation.cuts.is_empty() {
            let geometry = &self.volume.info().geometry;
            let faults = faults::find(&part, geometry, progress)?;
            told.cuts = faults.iter().map(|fault| Cut::of_sheet(&fault.sheet, part.size())).collect();
            found = told.cuts.len();
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::extracted;
    use survey::{SurveyGeometry, VerticalUnit};

    #[test]
    fn surfaces_that_are_read_for_a_slab_are_those_cut_out_of_all() {
        let folder = tempfile::tempdir().unwrap();
        let quiet = Progress::silent();
        let size = [40, 20, 32];
        let geometry = SurveyGeometry::regular(size, 25.0, 4.0, VerticalUnit::Milliseconds);
        let wave = |n: usize| ((n % 32) as f32 * 0.7 + (n / 32 / 20) as f32 * 0.3).sin();
        let volume = Volume::from_samples(size, (0..size.iter().product()).map(wave).collect()).unwrap();
        let project = extracted(folder.path(), &geometry, &volume);
        let stored = extraction::open(project.root(), project.document()).unwrap();
        let all = Candidates::load(project.facts(), &quiet).unwrap();
        assert!(all.forest.surfaces.surfaces.len() > 4);
        for range in [0..40, 0..17, 9..33, 38..40] {
            let read = read_surfaces_within(&stored, &range, &quiet).unwrap();
            assert_eq!(read, surfaces_within(&all.forest.surfaces, &range), "{range:?}");
        }
    }
}
