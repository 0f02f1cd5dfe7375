//! Where horizons and faults of an interpretation meet a section.
//!
//! A sheet is a value at each trace: along an inline or crossline its line runs from trace to trace, on a slice it is the contour of that depth,
//! found cell by cell as everywhere on the two triangles of a cell. A mesh is cut triangle by triangle. Space: (s, t) of the section, one a sample.

use crate::app::state::SliceKind;
use crate::app::work::fence::{place, stations};
use glam::{DVec2, DVec3};
use interp::reassembly::VoxelSheet;

/// A piece of a line on a section.
pub type Line = Vec<DVec2>;

/// Where a sheet meets a section at a voxel position; `[inlines, crosslines]` is its size.
pub fn of_sheet(sheet: &VoxelSheet, [nx, ny]: [usize; 2], kind: SliceKind, at: f64) -> Vec<Line> {
    let z = |x: usize, y: usize| f64::from(sheet.z[x * ny + y]);
    match kind {
        SliceKind::Inline => runs((0..ny).map(|y| z((at as usize).min(nx - 1), y))),
        SliceKind::Crossline => runs((0..nx).map(|x| z(x, (at as usize).min(ny - 1)))),
        SliceKind::Slice => {
            let mut lines = Vec::new();
            for x in 0..nx.saturating_sub(1) {
                for y in 0..ny.saturating_sub(1) {
                    let corner = |dx: usize, dy: usize| DVec3::new((x + dx) as f64, (y + dy) as f64, z(x + dx, y + dy));
                    let (a, b, c, d) = (corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1));
                    // Most cells lie above or below.
                    let above = [a, b, c, d].iter().filter(|p| p.z < at).count();
                    if above == 0 || above == 4 {
                        continue;
                    }
                    for triangle in [[a, b, c], [a, c, d]] {
                        lines.extend(cut(&triangle, 2, at).map(|ends| ends.map(DVec3::truncate).to_vec()));
                    }
                }
            }
            lines
        }
    }
}

/// Where a sheet meets a fence: the nearest trace's value at every trace's length along it.
pub fn along(sheet: &VoxelSheet, [nx, ny]: [usize; 2], corners: &[DVec2]) -> Vec<Line> {
    let length = stations(corners).last().copied().unwrap_or(0.0);
    runs((0..=length.floor() as usize).map(|s| {
        let at = place(corners, s as f64).round();
        let is_inside = at.x >= 0.0 && at.y >= 0.0 && at.x < nx as f64 && at.y < ny as f64;
        if is_inside { f64::from(sheet.z[at.x as usize * ny + at.y as usize]) } else { f64::NAN }
    }))
}

/// Runs of consecutive values; a single one is a short dash, so that it is seen.
fn runs(values: impl Iterator<Item = f64>) -> Vec<Line> {
    let mut lines: Vec<Line> = Vec::new();
    let mut open = false;
    for (n, z) in values.enumerate() {
        if z.is_finite() {
            let at = DVec2::new(n as f64, z);
            match lines.last_mut().filter(|_| open) {
                Some(line) => line.push(at),
                None => lines.push(vec![at]),
            }
        }
        open = z.is_finite();
    }
    for line in lines.iter_mut().filter(|line| line.len() == 1) {
        let at = line[0];
        *line = vec![at - DVec2::new(0.3, 0.0), at + DVec2::new(0.3, 0.0)];
    }
    lines
}

/// Where triangles meet a section.
pub fn of_mesh(triangles: &[[DVec3; 3]], kind: SliceKind, at: f64) -> Vec<Line> {
    let axis = kind.axis();
    let flat = |p: DVec3| match kind {
        SliceKind::Inline => DVec2::new(p.y, p.z),
        SliceKind::Crossline => DVec2::new(p.x, p.z),
        SliceKind::Slice => DVec2::new(p.x, p.y),
    };
    triangles.iter().filter_map(|triangle| cut(triangle, axis, at)).map(|ends| ends.map(flat).to_vec()).collect()
}

/// Where a triangle meets the plane on which a coordinate has a value. Corners on the plane count as beyond it, so that neighbours share no piece.
fn cut(triangle: &[DVec3; 3], axis: usize, at: f64) -> Option<[DVec3; 2]> {
    let off = triangle.map(|corner| corner[axis] - at);
    if off.iter().any(|off| !off.is_finite()) {
        return None;
    }
    let mut ends = Vec::with_capacity(2);
    for (a, b) in [(0, 1), (1, 2), (2, 0)] {
        if (off[a] < 0.0) != (off[b] < 0.0) {
            ends.push(triangle[a] + (triangle[b] - triangle[a]) * (off[a] / (off[a] - off[b])));
        }
    }
    ends.try_into().ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use survey::Quality;

    /// z = 2 + x + 0.5 y on 5 × 4 traces, without the trace (2, 1).
    fn plane() -> VoxelSheet {
        let mut z: Vec<f32> = (0..20).map(|n| 2.0 + (n / 4) as f32 + 0.5 * (n % 4) as f32).collect();
        z[2 * 4 + 1] = f32::NAN;
        VoxelSheet { block: 0, quality: vec![Quality::Tracked; 20], z }
    }

    #[test]
    fn a_plane_meets_sections_in_lines_with_its_hole() {
        let lines = of_sheet(&plane(), [5, 4], SliceKind::Inline, 2.0);
        assert_eq!(lines.len(), 2);
        assert_eq!(lines[1], [DVec2::new(2.0, 5.0), DVec2::new(3.0, 5.5)]);
        let whole = of_sheet(&plane(), [5, 4], SliceKind::Crossline, 3.0);
        assert_eq!((whole.len(), whole[0].len()), (1, 5));
    }

    #[test]
    fn on_a_slice_every_point_has_its_depth() {
        let lines = of_sheet(&plane(), [5, 4], SliceKind::Slice, 4.6);
        assert!(!lines.is_empty());
        for point in lines.iter().flatten() {
            assert!((2.0 + point.x + 0.5 * point.y - 4.6).abs() < 1e-6, "{point}");
        }
    }

    #[test]
    fn along_a_fence_the_plane_rises_leg_by_leg() {
        let corners = [[0.0, 0.0], [3.0, 0.0], [3.0, 2.0]].map(DVec2::from_array);
        let lines = along(&plane(), [5, 4], &corners);
        let z: Vec<f64> = lines.iter().flatten().map(|point| point.y).collect();
        assert_eq!(z, [2.0, 3.0, 4.0, 5.0, 5.5, 6.0]);
    }

    #[test]
    fn a_triangle_is_cut_where_it_passes_the_section() {
        let triangle = [DVec3::new(0.0, 0.0, 0.0), DVec3::new(4.0, 0.0, 8.0), DVec3::new(0.0, 4.0, 0.0)];
        let lines = of_mesh(&[triangle], SliceKind::Slice, 4.0);
        assert_eq!(lines, [[DVec2::new(2.0, 0.0), DVec2::new(2.0, 2.0)]]);
        assert!(of_mesh(&[triangle], SliceKind::Slice, 9.0).is_empty());
    }
}
