//! A line of a horizon that was drawn by hand: a node for each trace that it crosses, on the reflection only when that is
//! asked for.

use crate::reassembly::VoxelSheet;
use crate::refine::reflection::summit;
use glam::{DVec3, Vec3};
use model::FaultNetwork;
use std::collections::BTreeMap;
use survey::{Quality, Volume};

/// Samples within which a node finds the extremum that it is laid on.
const SNAP: i32 = 6;

/// The nodes of a line through these places, voxels: one for each trace that it crosses inside a survey of this size, at
/// the line's depth there. Where it comes back to a trace the later place counts, as when a line is drawn over again.
///
/// ```
/// use glam::DVec3;
/// let nodes = interp::refine::nodes_along(&[DVec3::new(3.0, 1.2, 10.0), DVec3::new(3.0, 5.0, 14.0)], [8, 8, 40]);
/// assert_eq!(nodes.len(), 5);
/// assert!(nodes.iter().all(|node| node.x == 3.0 && node.y.fract() == 0.0));
/// assert_eq!(nodes[4].z, 14.0);
/// ```
pub fn nodes_along(places: &[DVec3], [nx, ny, nz]: [usize; 3]) -> Vec<Vec3> {
    let mut depths = BTreeMap::new();
    let mut put = |place: DVec3| {
        let at = place.truncate().round();
        let is_inside = |at: f64, count: usize| at >= 0.0 && at < count as f64;
        if is_inside(at.x, nx) && is_inside(at.y, ny) && place.z >= 0.0 && place.z <= nz as f64 - 1.0 {
            depths.insert((at.x as usize, at.y as usize), place.z);
        }
    };
    if let [only] = places {
        put(*only);
    }
    for pair in places.windows(2) {
        let [from, to] = [pair[0], pair[1]];
        put(from);
        put(to);
        let along = to - from;
        let axis = if along.x.abs() >= along.y.abs() { 0 } else { 1 };
        if along[axis].abs() < 1e-6 {
            continue;
        }
        let (low, high) = (from[axis].min(to[axis]).ceil() as i64, from[axis].max(to[axis]).floor() as i64);
        for crossed in low..=high {
            put(from + along * ((crossed as f64 - from[axis]) / along[axis]));
        }
    }
    depths.into_iter().map(|((x, y), z)| Vec3::new(x as f32, y as f32, z as f32)).collect()
}

/// Lays nodes of a line on the nearest extremum within a few samples. Whether that is a peak or a trough is the same for
/// the whole line: what the samples are on it, taken together. A node without one stays. `read` gives the samples of a box
/// of voxels by its first corner and its size.
///
/// # Errors
/// Those of `read`.
pub fn snap<E>(
    nodes: &mut [Vec3],
    samples: usize,
    mut read: impl FnMut([usize; 3], [usize; 3]) -> Result<Volume<f32>, E>,
) -> Result<(), E> {
    let mut traces = Vec::with_capacity(nodes.len());
    for node in nodes.iter() {
        let top = (node.z as i32 - SNAP - 1).max(0) as usize;
        let bottom = (node.z as usize + SNAP as usize + 2).min(samples.saturating_sub(1));
        let read = read([node.x as usize, node.y as usize, top], [1, 1, bottom + 1 - top])?;
        traces.push((top as f32, read.trace(0, 0).to_vec()));
    }
    let on_line = nodes.iter().zip(&traces).map(|(node, (top, trace))| {
        let value = trace.get((node.z - top).round() as usize).copied().unwrap_or(0.0);
        if value.is_finite() { f64::from(value) } else { 0.0 }
    });
    let sign = if on_line.sum::<f64>() < 0.0 { -1.0 } else { 1.0 };
    for (node, (top, trace)) in nodes.iter_mut().zip(&traces) {
        let extrema = trace.windows(3).enumerate().filter_map(|(k, around)| {
            let [before, at, after] = [around[0] * sign, around[1] * sign, around[2] * sign];
            (at > 0.0 && at >= before && at > after).then(|| top + 1.0 + k as f32 + summit([before, at, after]))
        });
        let off = |z: f32| (z - node.z).abs();
        if let Some(z) = extrema.filter(|z| off(*z) <= SNAP as f32).min_by(|a, b| off(*a).total_cmp(&off(*b))) {
            node.z = z;
        }
    }
    Ok(())
}

/// Puts nodes into the sheets of their fault blocks, in place of what was there; `crosslines` is that of the survey.
pub fn lay(sheets: &mut Vec<VoxelSheet>, nodes: &[Vec3], [inlines, crosslines]: [usize; 2], blocks: &FaultNetwork) {
    for node in nodes {
        let sheet = sheet_of(sheets, blocks.block_at(*node), inlines * crosslines);
        let n = node.x as usize * crosslines + node.y as usize;
        (sheet.z[n], sheet.quality[n]) = (node.z, Quality::Picked);
    }
}

/// The first sheet of a block, a new one where it has none; sheets stay in the order of their blocks.
pub(crate) fn sheet_of(sheets: &mut Vec<VoxelSheet>, block: u16, traces: usize) -> &mut VoxelSheet {
    let at = sheets.partition_point(|sheet| sheet.block < block);
    if sheets.get(at).is_none_or(|sheet| sheet.block != block) {
        sheets.insert(at, VoxelSheet::empty(block, traces));
    }
    &mut sheets[at]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::convert::Infallible;

    #[test]
    fn a_line_has_one_node_for_each_trace_it_crosses_and_the_later_one_counts() {
        let at = |y: f64, z: f64| DVec3::new(2.0, y, z);
        let nodes = nodes_along(&[at(0.0, 4.0), at(6.0, 10.0), at(5.0, 20.0)], [4, 7, 30]);
        let depths: Vec<f32> = nodes.iter().map(|node| node.z).collect();
        assert_eq!(depths, [4.0, 5.0, 6.0, 7.0, 8.0, 20.0, 10.0]);
        assert_eq!(nodes_along(&[at(-3.0, 4.0), at(2.0, 9.0)], [4, 7, 30]).len(), 3, "what is outside is left out");
        let oblique = nodes_along(&[DVec3::new(0.0, 0.0, 5.0), DVec3::new(3.0, 1.0, 5.0)], [4, 7, 30]);
        assert_eq!(oblique.len(), 4);
    }

    #[test]
    fn nodes_are_laid_on_the_extremum_of_the_lines_kind() {
        let event = |x: usize| 20.3 + 0.25 * x as f32;
        let read = |first: [usize; 3], size: [usize; 3]| -> Result<Volume<f32>, Infallible> {
            let mut part = Volume::filled(size, 0.0);
            for (k, sample) in part.trace_mut(0, 0).iter_mut().enumerate() {
                let off = ((first[2] + k) as f32 - event(first[0])) / 3.0;
                *sample = -(1.0 - 2.0 * off * off) * (-off * off).exp();
            }
            Ok(part)
        };
        let line = [DVec3::new(0.0, 1.0, 21.0), DVec3::new(15.0, 1.0, 24.0)];
        let mut nodes = nodes_along(&line, [16, 3, 60]);
        snap(&mut nodes, 60, read).unwrap();
        for (x, node) in nodes.iter().enumerate() {
            assert!((node.z - event(x)).abs() < 0.2, "{} is not {}", node.z, event(x));
        }
    }
}
