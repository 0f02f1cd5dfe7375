//! Sections along a line, to be cut for the latest request.

use super::Rocks;
use super::slice::source;
use figure::cut::FenceCut;
use glam::DVec2;
use project::picture::load::Loaded;
use render::FaceData;

/// A fence that is asked for.
#[derive(Clone)]
pub struct FenceRequest {
    /// Its corners, voxel x and y; two at least.
    pub corners: Vec<DVec2>,
    /// What it is cut from.
    pub rocks: Rocks,
    /// What it shows.
    pub show: FaceData,
}

/// Cuts what is loaded.
pub(super) fn cut(loaded: &Loaded, request: &FenceRequest) -> FenceCut {
    let (volumes, wells) = (loaded.named_volumes(), loaded.well_paths());
    FenceCut::new(&source(loaded, &volumes, &wells), &request.corners, request.show)
}
