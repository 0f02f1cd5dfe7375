//! What finishes the sheets of a horizon after its picks: what was drawn or tracked where there is no candidate, holes that
//! are filled, and smoothing.

use crate::content;
use crate::document::{Drawn, DrawnEntry};
use crate::error::ProjectError;
use crate::folder::Draft;
use glam::DVec3;
use interp::holes::{FillSettings, Filled, fill_holes};
use interp::reassembly::VoxelSheet;
use interp::refine::{SmoothSettings, fill_along, lay, nodes_along, snap, track};
use model::FaultNetwork;
use survey::{Progress, SurveyGeometry, Volume};

/// Adds everything that was drawn to sheets, first the lines, then, where there is nothing yet, what was tracked. Returns
/// the number of nodes that the last entry made.
pub(crate) fn add_drawn(
    draft: &Draft,
    sheets: &mut Vec<VoxelSheet>,
    blocks: &FaultNetwork,
    drawn: &[DrawnEntry],
) -> Result<usize, ProjectError> {
    let document = &draft.document;
    let geometry = document.frame()?;
    let size = geometry.size();
    let is_followed = |drawn: &DrawnEntry| !matches!(drawn.part, Drawn::Line { snap: false, .. });
    let volume = match drawn.iter().any(is_followed) {
        true => Some(content::open_recorded(draft.root(), document.amplitudes()?, geometry)?),
        false => None,
    };
    let read = |first, extent| -> Result<Volume<f32>, ProjectError> {
        Ok(volume.as_ref().ok_or(ProjectError::NoVolume)?.read_box_f32(0, first, extent)?)
    };
    let (lines, tracks): (Vec<_>, Vec<_>) =
        drawn.iter().enumerate().partition(|(_, drawn)| matches!(drawn.part, Drawn::Line { .. }));
    let mut last = 0;
    for (index, entry) in lines.into_iter().chain(tracks) {
        let made = match &entry.part {
            Drawn::Line { points, snap: is_snapped } => {
                let places: Vec<DVec3> = points.iter().map(|point| voxel(geometry, *point)).collect();
                let mut nodes = nodes_along(&places, size);
                if *is_snapped {
                    snap(&mut nodes, size[2], read)?;
                }
                lay(sheets, &nodes, [size[0], size[1]], blocks);
                nodes.len()
            }
            Drawn::Tracked { at, window } => track(sheets, voxel(geometry, *at).as_vec3(), size, blocks, window, read)?,
        };
        if index + 1 == drawn.len() {
            last = made;
        }
    }
    Ok(last)
}

/// Fills and smooths sheets; returns what was filled, and the largest change by smoothing in samples.
pub(crate) fn refine(
    draft: &Draft,
    sheets: &mut [VoxelSheet],
    blocks: &FaultNetwork,
    fill: Option<&FillSettings>,
    smooth: Option<&SmoothSettings>,
    progress: &Progress,
) -> Result<(Option<Filled>, Option<f32>), ProjectError> {
    let document = &draft.document;
    let size = document.frame()?.size();
    let plane = [size[0], size[1]];
    let filled = match fill {
        Some(settings) if settings.along_reflection => {
            let volume = content::open_recorded(draft.root(), document.amplitudes()?, document.frame()?)?;
            let read = |first, extent| -> Result<_, ProjectError> { Ok(volume.read_box_f32(0, first, extent)?) };
            Some(fill_along(sheets, size, blocks, settings, read, progress)?)
        }
        Some(settings) => Some(fill_holes(sheets, plane, blocks, settings, progress)?),
        None => None,
    };
    let smoothed =
        smooth.map(|settings| interp::refine::smooth(sheets, plane, blocks, settings, progress)).transpose()?;
    Ok((filled, smoothed))
}

/// The voxel position of a place.
fn voxel(geometry: &SurveyGeometry, place: [f64; 3]) -> DVec3 {
    geometry.voxel_from_lines(place[0], place[1]).extend(geometry.vertical.index_of(place[2]))
}
