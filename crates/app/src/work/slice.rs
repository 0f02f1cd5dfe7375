//! Sections along the lattice, cut for the latest request of each kind.

use super::fence::{self, FenceRequest};
use super::latest_value::{Inbox, LatestValueWorker};
use super::{Event, Outbox, Rocks};
use crate::state::SectionKind;
use figure::cut::{SectionCut, SectionSource};
use pictures::load::Loaded;
use render::{DrawnWell, FaceData, NamedVolume};
use std::collections::HashMap;
use std::sync::PoisonError;

/// A request for a section.
#[derive(Clone)]
pub struct SliceRequest {
    /// Its kind.
    pub kind: SectionKind,
    /// Its position, voxel.
    pub at: f64,
    /// The data that it is cut from.
    pub rocks: Rocks,
    /// The number of these data.
    pub version: u64,
    /// What it shows; amplitudes where no candidates are in memory.
    pub show: FaceData,
}

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
                            let loaded = request.rocks.read().unwrap_or_else(PoisonError::into_inner);
                            Event::Sliced {
                                cut: cut(&loaded, &request),
                                of: (request.at, request.version, request.show),
                            }
                        }
                        Next::Fence(request) => {
                            let loaded = request.rocks.read().unwrap_or_else(PoisonError::into_inner);
                            Event::Fenced(fence::cut(&loaded, &request))
                        }
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
