//! Writes the horizon candidates of a project as points for other programs.

use crate::Project;
use crate::error::ProjectError;
use crate::folder::refuse_inside_project;
use crate::interpretation::extraction;
use interp::Forest;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;
use store::{Replacement, surface_batches};
use survey::Progress;
use system::file::FileAction;

/// Writes all candidates as points: inline, crossline, z in the vertical unit, leaf and surface, both numbered from 1.
/// A point on the border of several leaves is written once, with the smallest of their numbers. Returns the number of
/// points.
///
/// # Errors
/// There are no candidates, data are damaged, the file lies inside a project or cannot be written, or the user cancelled.
pub fn write(project: &Project, out: &Path, progress: &Progress) -> Result<usize, ProjectError> {
    refuse_inside_project(out)?;
    let document = project.document();
    let stored = extraction::open(project.root(), document)?;
    extraction::check_forest(&stored, progress)?;
    let trees = Forest::of_nodes(stored.read_nodes(progress)?)?;
    let surfaces = stored.read_surfaces(progress)?;
    let frame = document.frame()?;
    let fail = |source| ProjectError::io(FileAction::Written, out, source);
    let replacement = Replacement::of(out)?;
    let mut file = BufWriter::new(File::create(replacement.path()).map_err(fail)?);
    writeln!(file, "inline,crossline,z,leaf,surface").map_err(fail)?;
    progress.begin("writing candidates", surfaces.len() as u64);
    let (mut count, mut leaf) = (0, 0);
    for together in surface_batches(&surfaces) {
        let [first, end] = [surfaces[together.start], surfaces[together.end - 1]];
        let (vertices, triangles) = (first[1]..end[2], first[3]..end[4]);
        let rows = vertices.start as usize..vertices.end as usize;
        let (traces, depths) = (stored.read_traces(rows.clone())?, stored.read_depths(rows)?);
        let corners = stored.read_triangles(triangles.start as usize..triangles.end as usize)?;
        let mut leaf_of = vec![0u32; depths.len()];
        // Leaves are in the order of their triangles.
        while let Some(own) = trees.leaves.get(leaf).map(|&node| trees.nodes[node as usize].triangles.clone())
            && own.end <= triangles.end
        {
            leaf += 1;
            let own = [own.start, own.end].map(|at| at.wrapping_sub(triangles.start) as usize);
            let own = corners.get(own[0]..own[1]);
            for &vertex in own.unwrap_or_default().as_flattened() {
                if let Some(leaf_of) = leaf_of.get_mut(vertex.wrapping_sub(vertices.start) as usize)
                    && *leaf_of == 0
                {
                    *leaf_of = leaf as u32;
                }
            }
        }
        for (n, [_, start, stop, ..]) in together.clone().zip(&surfaces[together.clone()]) {
            let own = (start - vertices.start) as usize..(stop - vertices.start) as usize;
            for ((&[x, y], &z), &leaf) in traces[own.clone()].iter().zip(&depths[own.clone()]).zip(&leaf_of[own]) {
                if leaf != 0 {
                    let (inline, crossline) = (frame.inlines.number_at(x.into()), frame.crosslines.number_at(y.into()));
                    let z = frame.vertical.value_at(z.into());
                    writeln!(file, "{inline},{crossline},{z:.3},{leaf},{}", n + 1).map_err(fail)?;
                    count += 1;
                }
            }
            progress.step(1)?;
        }
    }
    file.into_inner().map_err(std::io::IntoInnerError::into_error).and_then(|file| file.sync_all()).map_err(fail)?;
    replacement.commit()?;
    Ok(count)
}
