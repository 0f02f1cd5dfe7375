//! Sticks from a triangulated fault: its intersection lines with vertical planes across its strike.

use glam::{DVec2, DVec3};
use std::collections::HashMap;
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

/// The horizontal direction in which the vertices extend furthest.
fn strike(mesh: &TriangleMesh) -> Option<DVec2> {
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
}
