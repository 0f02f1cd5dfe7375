//! Writes the horizon candidates of a project as points for other programs.

use project::Project;
use project::error::ProjectError;
use project::folder::refuse_inside_project;
use project::interpretation::extraction;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;
use store::Replacement;
use survey::Progress;

/// Writes all candidates as points: inline, crossline, z in the vertical unit, leaf and surface, both numbered from 1.
/// A point on the border of several leaves is written once, with the smallest of their numbers. Returns the number of
/// points.
///
/// # Errors
/// There are no candidates, data are damaged, the file lies inside a project or cannot be written, or the user cancelled.
pub fn write(project: &Project, out: &Path, progress: &Progress) -> Result<usize, ProjectError> {
    refuse_inside_project(out)?;
    let document = project.document();
    let forest = extraction::forest(&extraction::open(project.root(), document)?, progress)?;
    let frame = document.frame()?;
    let mut leaf_of = vec![0u32; forest.surfaces.vertices.len()];
    for (n, &node) in forest.leaves.iter().enumerate() {
        let range = &forest.nodes[node as usize].triangles;
        for &vertex in forest.surfaces.triangles[range.start as usize..range.end as usize].as_flattened() {
            let leaf = &mut leaf_of[vertex as usize];
            if *leaf == 0 {
                *leaf = n as u32 + 1;
            }
        }
    }
    let fail = |source| ProjectError::io("written", out, source);
    let replacement = Replacement::of(out)?;
    let mut file = BufWriter::new(File::create(replacement.path()).map_err(fail)?);
    writeln!(file, "inline,crossline,z,leaf,surface").map_err(fail)?;
    progress.begin("writing candidates", forest.surfaces.surfaces.len() as u64);
    let mut count = 0;
    for (surface, part) in forest.surfaces.surfaces.iter().enumerate() {
        let own = part.vertices.start as usize..part.vertices.end as usize;
        for (vertex, &leaf) in forest.surfaces.vertices[own.clone()].iter().zip(&leaf_of[own]) {
            if leaf != 0 {
                let inline = frame.inlines.number_at(vertex.x.into());
                let crossline = frame.crosslines.number_at(vertex.y.into());
                let z = frame.vertical.value_at(vertex.z.into());
                writeln!(file, "{inline},{crossline},{z:.3},{leaf},{}", surface + 1).map_err(fail)?;
                count += 1;
            }
        }
        progress.step(1)?;
    }
    file.into_inner().map_err(std::io::IntoInnerError::into_error).and_then(|file| file.sync_all()).map_err(fail)?;
    replacement.commit()?;
    Ok(count)
}
