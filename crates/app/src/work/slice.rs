//! Sections along the lattice, cut on a thread for the latest wish of each kind.

use super::fence::{self, FenceWish};
use super::wishes::{Wished, Wishes};
use super::{Event, Outbox, Rocks};
use crate::state::SectionKind;
use figure::cut::{SectionCut, Source};
use project::picture::load::Loaded;
use render::{DrawnWell, FaceData, NamedVolume};
use std::collections::HashMap;
use std::sync::PoisonError;

/// A section to be seen.
#[derive(Clone)]
pub struct SliceWish {
    /// Along what.
    pub kind: SectionKind,
    /// Where, voxel.
    pub at: f64,
    /// What it is cut from.
    pub rocks: Rocks,
    /// What it shows; amplitudes where there are no candidates in memory.
    pub show: FaceData,
}

/// What is to be cut: the latest of each kind.
#[derive(Default)]
struct Wanted {
    slices: HashMap<SectionKind, SliceWish>,
    fence: Option<FenceWish>,
}

/// What is cut next.
enum Next {
    Slice(SliceWish),
    Fence(FenceWish),
}

impl Wanted {
    fn take(&mut self) -> Option<Next> {
        let slice = SectionKind::ALL.into_iter().find_map(|kind| self.slices.remove(&kind));
        slice.map(Next::Slice).or_else(|| self.fence.take().map(Next::Fence))
    }
}

/// The thread that cuts, and the wishes it works on next.
pub struct Slices {
    wishes: Wishes<Wanted>,
}

impl Slices {
    /// Starts the thread.
    pub fn start(outbox: Outbox) -> Self {
        Self {
            wishes: Wishes::start("sections", move |wished: &Wished<Wanted>| {
                while let Some(next) = wished.next(Wanted::take) {
                    outbox.send(match next {
                        Next::Slice(wish) => {
                            let loaded = wish.rocks.read().unwrap_or_else(PoisonError::into_inner);
                            Event::Sliced(cut(&loaded, &wish))
                        }
                        Next::Fence(wish) => {
                            let loaded = wish.rocks.read().unwrap_or_else(PoisonError::into_inner);
                            Event::Fenced(fence::cut(&loaded, &wish))
                        }
                    });
                }
            }),
        }
    }

    /// Cuts this next, instead of what was wished of its kind before.
    pub fn cut(&self, wish: SliceWish) {
        self.wishes.change(|wanted| drop(wanted.slices.insert(wish.kind, wish)));
    }

    /// Cuts this fence next, instead of another.
    pub fn cut_fence(&self, wish: FenceWish) {
        self.wishes.change(|wanted| wanted.fence = Some(wish));
    }
}

/// What sections are cut from.
pub(super) fn source<'a>(loaded: &'a Loaded, volumes: &'a [NamedVolume<'a>], wells: &'a [DrawnWell<'a>]) -> Source<'a> {
    Source { data: loaded.inputs(volumes, wells), raw: loaded.raw.as_ref() }
}

/// Cuts what is loaded.
fn cut(loaded: &Loaded, wish: &SliceWish) -> SectionCut {
    let (volumes, wells) = (loaded.named_volumes(), loaded.well_paths());
    SectionCut::new(&source(loaded, &volumes, &wells), wish.kind, wish.at, wish.show)
}
