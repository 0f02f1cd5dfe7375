//! Triangles sampled at the integer nodes they lie over.

use glam::{DVec2, DVec3};

/// Distance outside a triangle within which nodes still belong to it: coordinates in files are rounded, and the rim of
/// a mesh made from a grid lies exactly on nodes.
const RIM: f64 = 1e-3;

/// Calls `visit(u, v, z)` for every node of a grid of `count` that lies in the triangle's projection along z,
/// its rim included; z is interpolated linearly. Corners are in node units. Triangles that are vertical or
/// degenerate have no nodes.
///
/// # Cost
/// The nodes of the triangle's bounding box that lie in the grid.
pub(super) fn triangle(corners: [DVec3; 3], count: [usize; 2], visit: &mut dyn FnMut(usize, usize, f64)) {
    let [a, b, c] = corners;
    if !corners.iter().all(|p| p.is_finite()) {
        return;
    }
    let (ab, ac) = ((b - a).truncate(), (c - a).truncate());
    let area = ab.perp_dot(ac);
    if area.abs() <= 1e-12 * (ab.length_squared() + ac.length_squared()) || area == 0.0 {
        return;
    }
    let low = a.min(b).min(c);
    let high = a.max(b).max(c);
    let slack = RIM;
    let range = |low: f64, high: f64, count: usize| {
        let first = (low - slack).ceil().max(0.0);
        let last = (high + slack).floor().min(count as f64 - 1.0);
        // Both may be far outside; comparing as floats keeps the casts in range.
        if first > last { 0..0 } else { first as usize..last as usize + 1 }
    };
    // A weight falls by 1 over the height of its corner above the opposite side. In a sliver that height is small, so
    // the tolerance is limited.
    let share = |side: DVec2| (RIM * side.length() / area.abs()).min(0.05);
    let (slack_a, slack_b, slack_c) = (share(ac - ab), share(ac), share(ab));
    for u in range(low.x, high.x, count[0]) {
        for v in range(low.y, high.y, count[1]) {
            let p = DVec2::new(u as f64, v as f64) - a.truncate();
            let (wb, wc) = (p.perp_dot(ac) / area, ab.perp_dot(p) / area);
            if wb >= -slack_b && wc >= -slack_c && wb + wc <= 1.0 + slack_a {
                visit(u, v, a.z + wb * (b.z - a.z) + wc * (c.z - a.z));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_of_two_triangles_covers_its_nodes_on_the_plane() {
        let plane = |x: f64, y: f64| DVec3::new(x, y, 3.0 + 0.5 * x - 0.25 * y);
        let mut hits = [[0; 6]; 6];
        for corners in
            [[plane(0.5, 0.5), plane(4.5, 0.5), plane(4.5, 4.5)], [plane(0.5, 0.5), plane(0.5, 4.5), plane(4.5, 4.5)]]
        {
            triangle(corners, [6, 6], &mut |u, v, z| {
                hits[u][v] += 1;
                assert!((z - plane(u as f64, v as f64).z).abs() < 1e-9);
            });
        }
        for (u, row) in hits.iter().enumerate() {
            for (v, &n) in row.iter().enumerate() {
                let inside = (1..=4).contains(&u) && (1..=4).contains(&v);
                // The diagonal belongs to both triangles.
                assert_eq!(
                    n,
                    if !inside {
                        0
                    } else if u == v {
                        2
                    } else {
                        1
                    },
                    "{u}, {v}"
                );
            }
        }
    }

    #[test]
    fn degenerate_and_far_triangles_have_no_nodes() {
        let p = DVec3::new(1.0, 1.0, 0.0);
        let far = DVec3::splat(1e300);
        for corners in [[p, p, p], [p, p + DVec3::X, p + 2.0 * DVec3::X], [far, far + p, far - p], [p, p, DVec3::NAN]] {
            triangle(corners, [4, 4], &mut |_, _, _| panic!("no node"));
        }
    }
}
