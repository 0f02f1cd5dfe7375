//! Sections along a line.

use super::Rocks;
use super::slice::source;
use figure::cut::FenceCut;
use glam::DVec2;
use project::pictures::load::Loaded;
use render::FaceData;

/// A request for a fence.
#[derive(Clone)]
pub struct FenceRequest {
    /// Its corners, voxel x and y; at least two.
    pub corners: Vec<DVec2>,
    /// The data that it is cut from.
    pub rocks: Rocks,
    /// What it shows.
    pub show: FaceData,
}

/// Cuts a fence from the loaded data.
pub(super) fn cut(loaded: &Loaded, request: &FenceRequest) -> FenceCut {
    let (volumes, wells) = (loaded.named_volumes(), loaded.well_paths());
    FenceCut::new(&source(loaded, &volumes, &wells), &request.corners, request.show)
}
