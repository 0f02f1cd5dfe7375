//! Fault polygons: closed outlines of the gap a fault leaves in a horizon, one after the other in a file of
//! points.
//!
//! The two long sides are where the fault cuts the horizon in its footwall and its hanging wall, so the
//! surface that the outline bounds is a strip of the fault itself. It is triangulated in map view (Delaunay
//! triangles with their middle inside the outline): exact for every fault that is not overhanging. Each
//! outline becomes a separate fault, because the file does not say which outlines belong together.

use super::raw::{RawPoint, RawShape, RawSurface};
use super::scatter;
use glam::DVec2;
use survey::mesh::TriangleMesh;

/// Makes a surface of each outline of a file of closed outlines; any other file stays as it is.
pub(super) fn split(surface: RawSurface) -> Vec<RawSurface> {
    let parts = match &surface.shape {
        RawShape::Points(points) => closed_parts(points),
        RawShape::Grid { .. } | RawShape::Mesh(_) => None,
    };
    let Some(parts) = parts else { return vec![surface] };
    let several = parts.len() > 1;
    let base = surface.name.clone();
    parts
        .into_iter()
        .enumerate()
        .map(|(n, mesh)| RawSurface {
            name: if several {
                Some(base.as_ref().map_or_else(|| format!("{}", n + 1), |name| format!("{name} {}", n + 1)))
            } else {
                base.clone()
            },
            shape: RawShape::Mesh(mesh),
            vertical: surface.vertical.clone(),
            horizontal: surface.horizontal.clone(),
            orientations: None,
            notes: surface
                .notes
                .iter()
                .cloned()
                .chain(["a closed outline, triangulated in map view: the strip of the fault between its two cut-offs"
                    .into()])
                .collect(),
            warnings: surface.warnings.clone(),
        })
        .collect()
}

/// The triangulated outlines, if all points are in parts and most parts end where they began.
fn closed_parts(points: &[RawPoint]) -> Option<Vec<TriangleMesh>> {
    let mut parts: Vec<Vec<(DVec2, f64)>> = Vec::new();
    let mut last = None;
    for point in points {
        let (stick, xy) = (point.stick?, point.xy?);
        if last != Some(stick) {
            parts.push(Vec::new());
            last = Some(stick);
        }
        if let Some(part) = parts.last_mut().filter(|_| point.z.is_finite()) {
            part.push((xy, point.z));
        }
    }
    let closed = |part: &&Vec<(DVec2, f64)>| {
        part.len() >= 4 && part.first().zip(part.last()).is_some_and(|(a, b)| a.0.distance(b.0) < 1e-2)
    };
    let outlines: Vec<&Vec<(DVec2, f64)>> = parts.iter().filter(closed).collect();
    if outlines.is_empty() || outlines.len() * 2 < parts.len() {
        return None;
    }
    let meshes: Vec<TriangleMesh> =
        outlines.into_iter().map(|o| triangulate(o)).filter(|m| !m.triangles.is_empty()).collect();
    (!meshes.is_empty()).then_some(meshes)
}

fn triangulate(outline: &[(DVec2, f64)]) -> TriangleMesh {
    let ring = &outline[..outline.len() - 1];
    let places: Vec<DVec2> = ring.iter().map(|p| p.0).collect();
    let triangles = scatter::delaunay(&places);
    let inside = |t: &[usize; 3]| contains(&places, (places[t[0]] + places[t[1]] + places[t[2]]) / 3.0);
    TriangleMesh {
        vertices: ring.iter().map(|(xy, z)| xy.extend(*z)).collect(),
        triangles: triangles.iter().filter(|t| inside(t)).map(|t| t.map(|v| v as u32)).collect(),
    }
}

/// Whether a point lies in a polygon: an odd number of sides cross the ray to its east.
fn contains(ring: &[DVec2], p: DVec2) -> bool {
    let mut inside = false;
    for (n, a) in ring.iter().enumerate() {
        let b = ring[(n + 1) % ring.len()];
        if (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) {
            inside = !inside;
        }
    }
    inside
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_outline_of_a_sloping_strip_has_its_area() {
        // A strip 100 m wide and 1000 m long that drops 80 m across, with a bend.
        let side = |offset: f64, drop: f64| {
            (0..=20).map(move |n| {
                let y = 50.0 * f64::from(n);
                (DVec2::new(offset + 30.0 * (y / 300.0).sin(), y), 1500.0 + drop)
            })
        };
        let mut ring: Vec<(DVec2, f64)> = side(0.0, 0.0).collect();
        ring.extend(side(100.0, 80.0).collect::<Vec<_>>().into_iter().rev());
        ring.push(ring[0]);
        let points: Vec<RawPoint> = ring
            .iter()
            .map(|(xy, z)| RawPoint { xy: Some(*xy), z: *z, stick: Some(3.0), ..RawPoint::default() })
            .collect();
        let [mesh] = &closed_parts(&points).unwrap()[..] else { panic!() };
        let area: f64 = (0..mesh.triangles.len())
            .map(|t| mesh.corners(t))
            .map(|[a, b, c]| 0.5 * (b - a).truncate().perp_dot((c - a).truncate()).abs())
            .sum();
        assert!((area - 100_000.0).abs() < 2_500.0, "{area}");
        // Sticks are open lines: no outlines.
        assert!(closed_parts(&points[..30]).is_none());
    }
}
