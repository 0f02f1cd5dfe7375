//! Writes a horizon or fault of a project as a file for other programs.

use crate::Project;
use crate::content;
use crate::error::{Noun, ProjectError};
use crate::folder::refuse_inside_project;
use formats::{ExportOptions, ExportReport, Format, SurfaceKind};
use std::path::Path;
use survey::Progress;

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
            let horizon = content::read_horizon(root, entry, progress)?;
            formats::write_horizon_as(out, &horizon, frame, format, options)?
        }
        SurfaceKind::Fault => {
            let entry = &document.faults[document.position(Noun::Fault, name)?];
            let fault = content::read_fault(root, entry)?;
            formats::write_fault(out, &fault, frame, format)?;
            ExportReport { nodes: fault.mesh.vertices.len(), notes: Vec::new() }
        }
    })
}
