//! Sticks from a triangulated fault: its intersection lines with vertical planes across its strike, or with sections.

use glam::{DVec2, DVec3};
use std::collections::HashMap;
use survey::geometry::SurveyGeometry;
use survey::mesh::TriangleMesh;

/// Largest number of sticks.
const MAX_STICKS: usize = 60;

/// Cuts a mesh (world X, Y in m, vertical value; `metres` per vertical unit) into sticks, top first, ordered
/// along strike.
///
/// The planes are about as far apart as the mesh's edges are long, the outermost a hundredth of that within
/// its ends. Where the mesh has two parts on a plane, the stick is the longer one.
pub(super) fn cut(mesh: &TriangleMesh, metres: f64) -> Vec<Vec<DVec3>> {
    let Some(strike) = strike(mesh) else { return Vec::new() };
    let along: Vec<f64> = mesh.vertices.iter().map(|v| v.truncate().dot(strike)).collect();
    let used = || mesh.triangles.iter().flatten().map(|&v| along[v as usize]);
    let (low, high) = used().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), a| (l.min(a), h.max(a)));
    let mut edges: Vec<f64> = mesh
        .triangles
        .iter()
        .flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)])
        .map(|(a, b)| (along[a as usize] - along[b as usize]).abs())
        .filter(|d| *d > 1e-6 * (high - low))
        .collect();
    if edges.is_empty() {
        return Vec::new();
    }
    edges.sort_by(f64::total_cmp);
    let count = ((high - low) / edges[edges.len() / 2]).ceil().clamp(2.0, MAX_STICKS as f64 - 1.0) as usize + 1;
    let inset = 0.01 * (high - low) / count as f64;
    (0..count)
        .map(|n| low + inset + (high - low - 2.0 * inset) * n as f64 / (count as f64 - 1.0))
        .map(|at| slice(mesh, &along, at, metres))
        .filter(|stick| stick.len() >= 2)
        .collect()
}

/// Largest number of sticks on sections: so many can be dragged.
const MOST_ON_SECTIONS: usize = 24;
/// Distance from a mesh of a line through fewer points, shares of the smaller distance of two traces.
const OFF: f64 = 0.2;

/// The first and the last voxel index along an axis that a mesh (world, vertical value) reaches.
pub fn extent_along(mesh: &TriangleMesh, geometry: &SurveyGeometry, axis: usize) -> [f64; 2] {
    let used = mesh.triangles.iter().flatten().map(|&v| geometry.voxel_from_world(mesh.vertices[v as usize])[axis]);
    used.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], at| [low.min(at), high.max(at)])
}

/// The sections that a mesh crosses: 0 where it runs across inlines, 1 where across crosslines.
pub fn axis_along(mesh: &TriangleMesh, geometry: &SurveyGeometry) -> usize {
    let reach = |axis: usize, spacing: f64| {
        let [low, high] = extent_along(mesh, geometry, axis);
        (high - low) * spacing
    };
    usize::from(reach(1, geometry.crossline_vector.length()) > reach(0, geometry.inline_vector.length()))
}

/// The voxel indices along an axis at which [`sticks_on_sections`] shows the whole of a mesh: whole lines, two dozen at
/// most, and the ends of the mesh.
pub fn planes_along(mesh: &TriangleMesh, geometry: &SurveyGeometry, axis: usize) -> Vec<f64> {
    let [low, high] = extent_along(mesh, geometry, axis);
    let inset = 0.001 * (high - low);
    let step = ((high - low) / (MOST_ON_SECTIONS - 2) as f64).ceil().max(1.0);
    let inner = (0..).map(|n| (low / step).ceil() * step + f64::from(n) * step).take_while(|at| *at < high);
    let inner = inner.filter(|at| (at - low).min(high - at) > 0.5 * step);
    std::iter::once(low + inset).chain(inner).chain(std::iter::once(high - inset)).collect()
}

/// The sticks (world, vertical value) in which inlines (axis 0) or crosslines (axis 1) at these voxel indices cut a mesh,
/// top first, of no more points than their bends need; an empty one where there is nothing to cut.
/// [`crate::fault_of_sticks`] makes nearly the same surface of those at [`planes_along`].
pub fn sticks_on_sections(
    mesh: &TriangleMesh,
    geometry: &SurveyGeometry,
    axis: usize,
    planes: &[f64],
) -> Vec<Vec<DVec3>> {
    let along: Vec<f64> = mesh.vertices.iter().map(|v| geometry.voxel_from_world(*v)[axis]).collect();
    let metres = geometry.metres_per_vertical_unit();
    let off = OFF * geometry.inline_vector.length().min(geometry.crossline_vector.length());
    let stick = |at: &f64| {
        let whole = slice(mesh, &along, *at, metres);
        if whole.len() < 2 { Vec::new() } else { bends(&whole, metres, off) }
    };
    planes.iter().map(stick).collect()
}

/// The points between which a line is straight but for `off` m (Douglas and Peucker's way).
fn bends(line: &[DVec3], metres: f64, off: f64) -> Vec<DVec3> {
    let metric = |p: DVec3| p * DVec3::new(1.0, 1.0, metres);
    let (Some(&first), Some(&last)) = (line.first(), line.last()) else { return Vec::new() };
    let along = (metric(last) - metric(first)).normalize_or_zero();
    let beside = |p: DVec3| (metric(p) - metric(first)).reject_from_normalized(along).length();
    let farthest = (1..line.len().saturating_sub(1)).max_by(|&a, &b| beside(line[a]).total_cmp(&beside(line[b])));
    match farthest.filter(|&n| along != DVec3::ZERO && beside(line[n]) > off) {
        Some(n) => {
            let mut kept = bends(&line[..=n], metres, off);
            kept.extend(bends(&line[n..], metres, off).into_iter().skip(1));
            kept
        }
        None => vec![first, last],
    }
}

/// The line (world, vertical value) in which a mesh is cut where `off`, a value for each vertex, changes its sign; the
/// longest of several, top first.
pub fn stick_along_cut(mesh: &TriangleMesh, geometry: &SurveyGeometry, off: &[f64]) -> Vec<DVec3> {
    slice(mesh, off, 0.0, geometry.metres_per_vertical_unit())
}

/// The horizontal direction in which the vertices of a mesh (world) extend furthest; `None` where they lie over one point.
pub fn strike(mesh: &TriangleMesh) -> Option<DVec2> {
    let count = mesh.vertices.len().max(1) as f64;
    let mean = mesh.vertices.iter().map(|v| v.truncate()).sum::<DVec2>() / count;
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for d in mesh.vertices.iter().map(|v| v.truncate() - mean) {
        xx += d.x * d.x;
        xy += d.x * d.y;
        yy += d.y * d.y;
    }
    (xx + yy > 0.0).then(|| DVec2::from_angle(0.5 * (2.0 * xy).atan2(xx - yy)))
}

/// The longest line in which the plane `along = at` cuts the mesh, top first.
fn slice(mesh: &TriangleMesh, along: &[f64], at: f64, metres: f64) -> Vec<DVec3> {
    // A vertex exactly on the plane counts as above it, so every cut triangle has two cut edges.
    let above = |v: u32| along[v as usize] >= at;
    let mut links: HashMap<(u32, u32), Vec<(u32, u32)>> = HashMap::new();
    for &[a, b, c] in &mesh.triangles {
        let cut: Vec<_> = [(a, b), (b, c), (c, a)]
            .into_iter()
            .filter(|&(a, b)| above(a) != above(b))
            .map(|(a, b)| (a.min(b), a.max(b)))
            .collect();
        if let [e, f] = *cut {
            links.entry(e).or_default().push(f);
            links.entry(f).or_default().push(e);
        }
    }
    let position = |&(a, b): &(u32, u32)| {
        let (pa, pb) = (mesh.vertices[a as usize], mesh.vertices[b as usize]);
        let (sa, sb) = (along[a as usize], along[b as usize]);
        pa.lerp(pb, (at - sa) / (sb - sa))
    };
    let length =
        |line: &[DVec3]| line.windows(2).map(|w| ((w[1] - w[0]) * DVec3::new(1.0, 1.0, metres)).length()).sum::<f64>();
    let mut edges: Vec<_> = links.keys().copied().collect();
    // Ends of lines first, so that walks begin there; then by number, for the same result every time.
    edges.sort_by_key(|e| (links[e].len() != 1, *e));
    let mut visited = std::collections::HashSet::new();
    let mut best: Vec<DVec3> = Vec::new();
    for start in edges {
        let mut line = Vec::new();
        let mut next = Some(start);
        while let Some(edge) = next.filter(|e| visited.insert(*e)) {
            line.push(position(&edge));
            next = links[&edge].iter().copied().find(|e| !visited.contains(e));
        }
        if length(&line) > length(&best) {
            best = line;
        }
    }
    best.dedup_by(|a, b| a.distance(*b) < 1e-6);
    if best.first().zip(best.last()).is_some_and(|(a, b)| a.z > b.z) {
        best.reverse();
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sticks_of_a_plane_lie_on_it_and_span_it() {
        let plane = |s: f64, t: f64| DVec3::new(100.0 + 500.0 * s + 40.0 * t, 300.0 * s - 66.0 * t, 50.0 + 200.0 * t);
        let mut mesh = TriangleMesh::default();
        for i in 0..6 {
            for j in 0..4 {
                mesh.vertices.push(plane(f64::from(i) / 5.0, f64::from(j) / 3.0));
            }
        }
        for i in 0..5u32 {
            for j in 0..3u32 {
                let a = i * 4 + j;
                mesh.triangles.extend([[a, a + 4, a + 5], [a, a + 5, a + 1]]);
            }
        }
        let sticks = cut(&mesh, 1.0);
        assert!(sticks.len() >= 5, "{}", sticks.len());
        let normal = (plane(1.0, 0.0) - plane(0.0, 0.0)).cross(plane(0.0, 1.0) - plane(0.0, 0.0)).normalize();
        for p in sticks.iter().flatten() {
            assert!((*p - plane(0.0, 0.0)).dot(normal).abs() < 1e-6);
        }
        let middle = &sticks[sticks.len() / 2];
        assert!(middle[0].z < 51.0 && middle.last().unwrap().z > 249.0);
    }

    /// A bent surface, cut on crosslines: every stick lies on a whole line or at an end, and the surface of the sticks lies
    /// on the mesh.
    #[test]
    fn sticks_on_sections_make_the_surface_again() {
        let geometry = SurveyGeometry::regular([60, 80, 100], 25.0, 4.0, survey::VerticalUnit::Metres);
        let place =
            |y: f64, z: f64| geometry.world_from_voxel(DVec3::new(20.0 + 0.2 * z + 0.004 * (y - 30.0).powi(2), y, z));
        let mut mesh = TriangleMesh::default();
        let (rows, columns) = (61_u32, 31_u32);
        for i in 0..rows {
            for j in 0..columns {
                mesh.vertices.push(place(4.3 + f64::from(i), 10.0 + 2.0 * f64::from(j)));
            }
        }
        for (i, j) in (0..rows - 1).flat_map(|i| (0..columns - 1).map(move |j| (i, j))) {
            let a = i * columns + j;
            mesh.triangles.extend([[a, a + columns, a + columns + 1], [a, a + columns + 1, a + 1]]);
        }
        assert_eq!(axis_along(&mesh, &geometry), 1);
        let sticks = sticks_on_sections(&mesh, &geometry, 1, &planes_along(&mesh, &geometry, 1));
        assert!((20..=MOST_ON_SECTIONS).contains(&sticks.len()), "{}", sticks.len());
        for stick in &sticks[1..sticks.len() - 1] {
            let line = geometry.voxel_from_world(stick[0]).y;
            assert!((line - line.round()).abs() < 1e-6 && stick.len() == 2, "{line}, {}", stick.len());
        }
        let again = crate::fault_of_sticks("F", &sticks, &geometry).unwrap().mesh;
        let [before, after] = [&mesh, &again].map(|mesh| extent_along(mesh, &geometry, 1));
        assert!((before[0] - after[0]).abs() < 0.1 && (before[1] - after[1]).abs() < 0.1, "{before:?} {after:?}");
        for vertex in &again.vertices {
            let v = geometry.voxel_from_world(*vertex);
            assert!((v - geometry.voxel_from_world(place(v.y, v.z))).length() < 0.3, "{v}");
        }
        // Cut across: the line of the cut belongs to both parts.
        let off: Vec<f64> = mesh.vertices.iter().map(|v| geometry.voxel_from_world(*v).y - 30.5).collect();
        let line = stick_along_cut(&mesh, &geometry, &off);
        assert!(line.iter().all(|p| (geometry.voxel_from_world(*p).y - 30.5).abs() < 1e-9));
        let [near, far] = mesh.parted(&off).map(|part| extent_along(&part, &geometry, 1));
        assert!((near[1] - 30.5).abs() < 1e-9 && (far[0] - 30.5).abs() < 1e-9, "{near:?} {far:?}");
    }
}
