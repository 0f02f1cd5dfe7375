//! Sections along the lattice, cut for the latest request of each kind.

use super::fence::{self, FenceRequest};
use super::latest_value::{Inbox, LatestValueWorker};
use super::{Event, Outbox, Rocks};
use crate::state::{Notice, Place, SectionKind, SectionVolumes};
use figure::cut::{SectionCut, SectionSource};
use image::Rgba;
use project::document::Document;
use project::pictures::load::Loaded;
use project::{ProjectError, content, styles};
use render::{DrawnWell, FaceData, NamedVolume};
use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;

/// A request for a section.
#[derive(Clone)]
pub struct SliceRequest {
    /// Its kind.
    pub kind: SectionKind,
    /// Its position, voxel.
    pub at: f64,
    /// The data that it is cut from.
    pub rocks: Rocks,
    /// What it shows; amplitudes where no candidates are in memory.
    pub show: FaceData,
    /// The volumes in it.
    pub volumes: SectionVolumes,
    /// The project that a second volume is read from.
    pub project: (PathBuf, Arc<Document>),
}

/// What a section shows: its position, the key of its data, what of the candidates, which volumes.
pub(crate) type CutOf = (f64, u64, FaceData, SectionVolumes);

/// The latest request of each kind.
#[derive(Default)]
struct Wanted {
    slices: HashMap<SectionKind, SliceRequest>,
    fence: Option<FenceRequest>,
}

/// The next request.
enum Next {
    Slice(SliceRequest),
    Fence(FenceRequest),
}

impl Wanted {
    fn take(&mut self) -> Option<Next> {
        let slice = SectionKind::ALL.into_iter().find_map(|kind| self.slices.remove(&kind));
        slice.map(Next::Slice).or_else(|| self.fence.take().map(Next::Fence))
    }
}

/// A latest-value worker that cuts sections.
pub struct Slices {
    worker: LatestValueWorker<Wanted>,
}

impl Slices {
    /// Starts the worker.
    pub fn start(outbox: Outbox) -> Self {
        let told = outbox.clone();
        Self {
            worker: LatestValueWorker::start("sections", &told, move |inbox: &Inbox<Wanted>| {
                while let Some(next) = inbox.next(Wanted::take) {
                    outbox.send(match next {
                        Next::Slice(request) => {
                            let mut cut = cut(&request.rocks, &request);
                            if let Err(error) = blend(&mut cut, &request) {
                                outbox.send(Event::Told(Notice::failure(Place::Block, &error)));
                            }
                            Event::Sliced { cut, of: (request.at, request.rocks.key, request.show, request.volumes) }
                        }
                        Next::Fence(request) => Event::Fenced(fence::cut(&request.rocks, &request)),
                    });
                }
            }),
        }
    }

    /// Cuts this next, instead of an earlier request of its kind.
    pub fn cut(&self, request: SliceRequest) {
        self.worker.change(|wanted| drop(wanted.slices.insert(request.kind, request)));
    }

    /// Cuts this fence next, instead of another.
    pub fn cut_fence(&self, request: FenceRequest) {
        self.worker.change(|wanted| wanted.fence = Some(request));
    }
}

/// The data that sections are cut from.
pub(super) fn source<'a>(
    loaded: &'a Loaded,
    volumes: &'a [NamedVolume<'a>],
    wells: &'a [DrawnWell<'a>],
) -> SectionSource<'a> {
    SectionSource { data: loaded.inputs(volumes, wells), raw: loaded.raw.as_ref() }
}

/// Cuts a section from the loaded data.
fn cut(loaded: &Loaded, request: &SliceRequest) -> SectionCut {
    let (volumes, wells) = (loaded.named_volumes(), loaded.well_paths());
    SectionCut::new(&source(loaded, &volumes, &wells), request.kind, request.at, request.show)
}

/// Lays the second volume over a section, or takes the raw data away, as the request says.
fn blend(cut: &mut SectionCut, request: &SliceRequest) -> Result<(), ProjectError> {
    let SectionVolumes { without_raw, over } = &request.volumes;
    if *without_raw && request.show == FaceData::Rock {
        cut.image.pixels_mut().for_each(|pixel| *pixel = Rgba([255; 4]));
    }
    let Some(over) = over else { return Ok(()) };
    let (root, document) = &request.project;
    let Some(entry) = document.volumes.iter().find(|entry| entry.name == over.volume) else { return Ok(()) };
    let colours = styles::raw_colour(document, Some(&over.volume), over.map, None)?.function;
    let stored = content::open_recorded(root, entry, document.frame()?)?;
    let (axis, [s, t]) = (cut.kind.axis(), cut.kind.axes());
    let size = document.frame()?.size();
    let (mut first, mut extent) = ([0; 3], size);
    first[axis] = (cut.at.round().max(0.0) as usize).min(size[axis].saturating_sub(1));
    extent[axis] = 1;
    let samples = stored.read_box_f32(0, first, extent)?;
    for (x, y, pixel) in cut.image.enumerate_pixels_mut() {
        let mut at = [0; 3];
        (at[s], at[t]) = (x as usize, y as usize);
        let value = samples.trace(at[0], at[1])[at[2]];
        if value.is_finite() {
            let [red, green, blue, alpha] = colours.evaluate(value);
            let cover = alpha * over.opacity;
            for (channel, new) in pixel.0.iter_mut().zip([red, green, blue]) {
                *channel = (f32::from(*channel) * (1.0 - cover) + 255.0 * new * cover + 0.5) as u8;
            }
        }
    }
    Ok(())
}
