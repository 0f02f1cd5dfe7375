//! Writes a horizon or fault of a project, or the values of volumes along a horizon, as a file for other programs.

use crate::document::{HorizonEntry, Origin};
use crate::error::{Noun, ProjectError};
use crate::exports::values;
use crate::folder::refuse_inside_project;
use crate::{Project, content};
use files::{ExportOptions, ExportReport, Format, SurfaceKind};
use std::path::Path;
use survey::{Horizon, Progress, Quality};

/// A horizon without what only continues it past faults and the sides of a block told by its history.
fn stated(mut horizon: Horizon, entry: &HorizonEntry) -> Horizon {
    let continued =
        horizon.sheets.iter_mut().filter(|_| matches!(entry.origin, Origin::History | Origin::Restored { .. }));
    for sheet in continued {
        for (depth, quality) in sheet.depth.iter_mut().zip(&mut sheet.quality) {
            if *quality == Quality::Extrapolated {
                (*depth, *quality) = (f32::NAN, Quality::Hole);
            }
        }
    }
    horizon
}

/// Writes the surface of this kind and name.
///
/// # Errors
/// There is none of that name, its data are damaged, the format cannot hold it, or the file lies inside a project or
/// cannot be written.
pub fn write(
    project: &Project,
    out: &Path,
    (kind, name): (SurfaceKind, &str),
    (format, options): (Format, &ExportOptions),
    progress: &Progress,
) -> Result<ExportReport, ProjectError> {
    refuse_inside_project(out)?;
    let (document, root) = (project.document(), project.root());
    let frame = document.frame()?;
    Ok(match kind {
        SurfaceKind::Horizon => {
            let entry = &document.horizons[document.position(Noun::Horizon, name)?];
            let horizon = stated(content::read_horizon(root, entry, progress)?, entry);
            files::write_horizon_as(out, &horizon, frame, format, options)?
        }
        SurfaceKind::Fault => {
            let entry = &document.faults[document.position(Noun::Fault, name)?];
            let fault = content::read_fault(root, entry)?;
            files::write_fault(out, &fault, frame, format)?;
            ExportReport { nodes: fault.mesh.vertices.len(), notes: Vec::new() }
        }
    })
}

/// Writes the values of volumes at the nodes of a horizon as CSV; with `window` above 0 also the mean, the root mean square
/// and the greatest magnitude over so many samples to both sides.
///
/// # Errors
/// There is no such horizon or volume, a volume has a lattice of its own, data are damaged, or the file lies inside a
/// project or cannot be written.
pub fn write_values(
    project: &Project,
    out: &Path,
    (name, volumes): (&str, &[String]),
    window: usize,
    progress: &Progress,
) -> Result<ExportReport, ProjectError> {
    refuse_inside_project(out)?;
    let (document, root) = (project.document(), project.root());
    let frame = document.frame()?;
    let entry = &document.horizons[document.position(Noun::Horizon, name)?];
    let horizon = stated(content::read_horizon(root, entry, progress)?, entry);
    let mut read = Vec::new();
    for volume in volumes {
        let entry = &document.volumes[document.position(Noun::Volume, volume)?];
        if entry.geometry.is_some() {
            return Err(ProjectError::OtherLattice { volume: volume.clone() });
        }
        read.push((volume.clone(), content::read_volume(root, entry, frame, progress)?));
    }
    let table = values::table(&horizon, frame, &read, window);
    store::replace_file(out, table.as_bytes())?;
    Ok(ExportReport { nodes: table.lines().count() - 1, notes: Vec::new() })
}
