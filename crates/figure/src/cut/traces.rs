//! Where horizons and faults of an interpretation meet a section.
//!
//! A sheet is a value at each trace: along an inline or crossline its line runs from trace to trace, on a
//! slice it is the contour of that depth, found on the two triangles of each cell. A mesh is cut triangle
//! by triangle. Across a hole a line has a bridge, straight from rim to rim. Space: (s, t) of the section,
//! one a sample.

use super::{SectionKind, place, stations};
use crate::interpretation::{SheetHole, TraceSheet};
use glam::{DVec2, DVec3};

/// A piece of a line on a section.
pub type Line = Vec<DVec2>;

/// Where a sheet meets a section at a voxel position; `[inlines, crosslines]` is its size.
pub(crate) fn of_sheet(sheet: &TraceSheet, [nx, ny]: [usize; 2], kind: SectionKind, at: f64) -> Vec<Line> {
    if kind != SectionKind::Slice {
        return runs(passed(kind, at, [nx, ny]).map(|n| f64::from(sheet.z[n])));
    }
    let z = |x: usize, y: usize| f64::from(sheet.z[x * ny + y]);
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
                let off = triangle.map(|corner| corner.z - at);
                lines.extend(cut(&triangle, off).map(|ends| ends.map(DVec3::truncate).to_vec()));
            }
        }
    }
    lines
}

/// Bridges across the holes of a sheet on an inline or crossline; a slice has none, for a hole has no depth.
pub(crate) fn bridges(
    sheet: &TraceSheet,
    holes: &[SheetHole],
    size: [usize; 2],
    kind: SectionKind,
    at: f64,
) -> Vec<Line> {
    if kind == SectionKind::Slice {
        return Vec::new();
    }
    gaps(passed(kind, at, size).map(|n| (f64::from(sheet.z[n]), is_hole(holes, sheet.block, n))))
}

/// Where a sheet meets a fence: the nearest trace's value at every trace's length along it.
pub fn along(sheet: &TraceSheet, size: [usize; 2], corners: &[DVec2]) -> Vec<Line> {
    runs(passed_by_fence(size, corners).map(|n| n.map_or(f64::NAN, |n| f64::from(sheet.z[n]))))
}

/// Bridges across the holes of a sheet on a fence.
pub(crate) fn bridges_along(sheet: &TraceSheet, holes: &[SheetHole], size: [usize; 2], corners: &[DVec2]) -> Vec<Line> {
    gaps(passed_by_fence(size, corners).map(|n| match n {
        Some(n) => (f64::from(sheet.z[n]), is_hole(holes, sheet.block, n)),
        None => (f64::NAN, false),
    }))
}

/// The traces that an inline or crossline passes.
fn passed(kind: SectionKind, at: f64, [nx, ny]: [usize; 2]) -> impl Iterator<Item = usize> {
    let is_inline = kind == SectionKind::Inline;
    let at = (at as usize).min(if is_inline { nx } else { ny } - 1);
    (0..if is_inline { ny } else { nx }).map(move |n| if is_inline { at * ny + n } else { n * ny + at })
}

/// The traces nearest to a fence at each trace's length along it; none outside the survey.
fn passed_by_fence([nx, ny]: [usize; 2], corners: &[DVec2]) -> impl Iterator<Item = Option<usize>> {
    let length = stations(corners).last().copied().unwrap_or(0.0);
    (0..=length.floor() as usize).map(move |s| {
        let at = place(corners, s as f64).round();
        let is_inside = at.x >= 0.0 && at.y >= 0.0 && at.x < nx as f64 && at.y < ny as f64;
        is_inside.then(|| at.x as usize * ny + at.y as usize)
    })
}

fn is_hole(holes: &[SheetHole], block: u16, trace: usize) -> bool {
    let mut own = holes.iter().filter(|hole| hole.block == block);
    own.any(|hole| hole.traces.binary_search(&(trace as u32)).is_ok())
}

/// Straight lines across runs without a value, where all of a run is hole.
fn gaps(values: impl Iterator<Item = (f64, bool)>) -> Vec<Line> {
    let mut lines = Vec::new();
    let (mut rim, mut is_whole) = (None, true);
    for (n, (z, is_hole)) in values.enumerate() {
        if !z.is_finite() {
            is_whole &= is_hole;
            continue;
        }
        let at = DVec2::new(n as f64, z);
        if let Some(rim) = rim.filter(|rim: &DVec2| is_whole && at.x - rim.x > 1.0) {
            lines.push(vec![rim, at]);
        }
        (rim, is_whole) = (Some(at), true);
    }
    lines
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
pub(crate) fn of_mesh(triangles: &[[DVec3; 3]], kind: SectionKind, at: f64) -> Vec<Line> {
    let axis = kind.axis();
    let cuts = triangles.iter().filter_map(|triangle| cut(triangle, triangle.map(|corner| corner[axis] - at)));
    cuts.map(|ends| ends.map(|p| kind.flat(p)).to_vec()).collect()
}

/// Where triangles meet a fence: leg by leg, each cut ending where its leg does.
pub(crate) fn mesh_along(triangles: &[[DVec3; 3]], corners: &[DVec2]) -> Vec<Line> {
    let mut lines = Vec::new();
    for (leg, station) in corners.windows(2).zip(stations(corners)) {
        let length = leg[0].distance(leg[1]);
        if length < 1e-6 {
            continue;
        }
        let along = (leg[1] - leg[0]) / length;
        let off = |corner: DVec3| along.perp_dot(corner.truncate() - leg[0]);
        for [a, b] in triangles.iter().filter_map(|triangle| cut(triangle, triangle.map(off))) {
            let [a, b] = [a, b].map(|end| DVec2::new(along.dot(end.truncate() - leg[0]), end.z));
            // The share of the cut that lies within the leg.
            let step = b.x - a.x;
            let [low, high] = [0.0, length].map(|end| if step.abs() < 1e-9 { end - a.x } else { (end - a.x) / step });
            let (from, to) = match step.abs() < 1e-9 {
                true if low <= 0.0 && high >= 0.0 => (0.0, 1.0),
                true => continue,
                false => (low.min(high).max(0.0), low.max(high).min(1.0)),
            };
            if from < to {
                lines.push([from, to].map(|share| a.lerp(b, share) + DVec2::X * station).to_vec());
            }
        }
    }
    lines
}

/// Where a triangle meets a plane, given its corners' distances from it. Corners on the plane count as
/// beyond it, so that neighbours share no piece.
fn cut(triangle: &[DVec3; 3], off: [f64; 3]) -> Option<[DVec3; 2]> {
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

    struct VoxelSheet {
        z: Vec<f32>,
        quality: Vec<Quality>,
    }

    impl VoxelSheet {
        fn sheet(&self) -> TraceSheet<'_> {
            TraceSheet { block: 0, z: &self.z, quality: &self.quality }
        }
    }

    /// z = 2 + x + 0.5 y on 5 × 4 traces, without the trace (2, 1).
    fn plane() -> VoxelSheet {
        let mut z: Vec<f32> = (0..20).map(|n| 2.0 + (n / 4) as f32 + 0.5 * (n % 4) as f32).collect();
        z[2 * 4 + 1] = f32::NAN;
        VoxelSheet { quality: vec![Quality::Tracked; 20], z }
    }

    #[test]
    fn a_plane_meets_sections_in_lines_with_its_hole() {
        let lines = of_sheet(&plane().sheet(), [5, 4], SectionKind::Inline, 2.0);
        assert_eq!(lines.len(), 2);
        assert_eq!(lines[1], [DVec2::new(2.0, 5.0), DVec2::new(3.0, 5.5)]);
        let whole = of_sheet(&plane().sheet(), [5, 4], SectionKind::Crossline, 3.0);
        assert_eq!((whole.len(), whole[0].len()), (1, 5));
    }

    #[test]
    fn on_a_slice_every_point_has_its_depth() {
        let lines = of_sheet(&plane().sheet(), [5, 4], SectionKind::Slice, 4.6);
        assert!(!lines.is_empty());
        for point in lines.iter().flatten() {
            assert!((2.0 + point.x + 0.5 * point.y - 4.6).abs() < 1e-6, "{point}");
        }
    }

    #[test]
    fn along_a_fence_the_plane_rises_leg_by_leg() {
        let corners = [[0.0, 0.0], [3.0, 0.0], [3.0, 2.0]].map(DVec2::from_array);
        let lines = along(&plane().sheet(), [5, 4], &corners);
        let z: Vec<f64> = lines.iter().flatten().map(|point| point.y).collect();
        assert_eq!(z, [2.0, 3.0, 4.0, 5.0, 5.5, 6.0]);
    }

    #[test]
    fn a_triangle_is_cut_where_it_passes_the_section() {
        let triangle = [DVec3::new(0.0, 0.0, 0.0), DVec3::new(4.0, 0.0, 8.0), DVec3::new(0.0, 4.0, 0.0)];
        let lines = of_mesh(&[triangle], SectionKind::Slice, 4.0);
        assert_eq!(lines, [[DVec2::new(2.0, 0.0), DVec2::new(2.0, 2.0)]]);
        assert!(of_mesh(&[triangle], SectionKind::Slice, 9.0).is_empty());
    }

    #[test]
    fn a_bridge_leads_across_a_hole_and_nowhere_else() {
        let mut sheet = plane();
        // The trace (4, 3) is missing at the outer boundary, which is not a hole.
        sheet.z[4 * 4 + 3] = f32::NAN;
        let sheet = sheet.sheet();
        let holes = [SheetHole { block: 0, traces: &[2 * 4 + 1] }];
        let bridge = |kind, at| bridges(&sheet, &holes, [5, 4], kind, at);
        assert_eq!(bridge(SectionKind::Inline, 2.0), [[DVec2::new(0.0, 4.0), DVec2::new(2.0, 5.0)]]);
        assert_eq!(bridge(SectionKind::Crossline, 1.0), [[DVec2::new(1.0, 3.5), DVec2::new(3.0, 5.5)]]);
        assert!(bridge(SectionKind::Inline, 4.0).is_empty() && bridge(SectionKind::Slice, 4.0).is_empty());
        let corners = [[0.0, 1.0], [4.0, 1.0]].map(DVec2::from_array);
        assert_eq!(bridges_along(&sheet, &holes, [5, 4], &corners), bridge(SectionKind::Crossline, 1.0));
    }

    #[test]
    fn a_fault_meets_each_leg_of_a_fence_within_it() {
        // The plane x = 2 between z = 0 and 8, and a fence that crosses it twice and once turns before it.
        let corner = [
            DVec3::new(2.0, -9.0, 0.0),
            DVec3::new(2.0, 9.0, 0.0),
            DVec3::new(2.0, 9.0, 8.0),
            DVec3::new(2.0, -9.0, 8.0),
        ];
        let triangles = [[corner[0], corner[1], corner[2]], [corner[0], corner[2], corner[3]]];
        let corners = [[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [0.0, 2.0], [1.0, 2.0]].map(DVec2::from_array);
        let lines = mesh_along(&triangles, &corners);
        let mut at: Vec<f64> = lines.iter().flatten().map(|point| point.x).collect();
        at.sort_by(f64::total_cmp);
        at.dedup();
        assert_eq!(at, [2.0, 8.0]);
        let height: f64 = lines.iter().map(|line| line[0].distance(line[1])).sum();
        assert!((height - 16.0).abs() < 1e-9);
    }
}
