//! How far a fault was interpreted: the rim of its mesh on its best-fit plane, and the signed distance to it.
//!
//! Rim edges that end just before the volume's outer boundary, or before the fault this one is truncated by, are
//! extended straight to it (and beyond it, in the case of the outer boundary), because an interpreter's sticks seldom
//! end exactly there. How near is near depends on how densely the fault was picked towards that rim, and never on the
//! spacing along it. Holes inside the mesh count as interpreted.

use glam::{DVec2, DVec3};
use std::collections::BTreeMap;

/// Spacing of the points that stand for the rim, cells. The distance is too long by at most (spacing/2)² /
/// 2d.
const RIM_SPACING: f64 = 0.125;
/// Half the distance between the two probes that tell a rim from a seam between triangles, cells.
const PROBE: f64 = 0.02;

#[derive(Clone)]
/// Triangles in the frame of a fault surface: (u cells, v cells, w m).
pub(super) struct FaultPatch {
    points: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
}

/// Something a rim may end at: from a rim point and the spacing of the picks towards the rim there (cells), the
/// direction and the cells to go; `None` when it is too far or lies aside.
pub(super) type Reach<'a> = &'a dyn Fn(DVec3, f64) -> Course;

/// Direction and cells to go, if the target is near.
pub(super) type Course = Option<(DVec2, f64)>;

impl FaultPatch {
    pub(super) fn new(points: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Self {
        Self { points, triangles }
    }

    pub(super) fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    fn corners(&self, t: &[u32; 3]) -> [DVec3; 3] {
        t.map(|v| self.points[v as usize])
    }

    /// Calls `visit(node, w)` for the grid nodes that triangle `index` covers, its edges included.
    pub(super) fn each_node(
        &self,
        index: usize,
        origin: [i32; 2],
        size: [usize; 2],
        mut visit: impl FnMut(usize, f64),
    ) {
        let [a, b, c] = self.corners(&self.triangles[index]);
        let (p, q) = ((b - a).truncate(), (c - a).truncate());
        let area = p.perp_dot(q);
        if area.abs() < 1e-12 {
            return;
        }
        let (lo, hi) = (a.min(b).min(c), a.max(b).max(c));
        let range = |lo: f64, hi: f64, origin: i32, count: usize| {
            let first = (lo - 1e-9).ceil().max(f64::from(origin)) as i32;
            let last = (hi + 1e-9).floor().min(f64::from(origin) + count as f64 - 1.0);
            (first, last as i32)
        };
        let (u0, u1) = range(lo.x, hi.x, origin[0], size[0]);
        let (v0, v1) = range(lo.y, hi.y, origin[1], size[1]);
        for u in u0..=u1 {
            for v in v0..=v1 {
                let r = DVec2::new(f64::from(u), f64::from(v)) - a.truncate();
                let (s, t) = (r.perp_dot(q) / area, p.perp_dot(r) / area);
                if s >= -1e-9 && t >= -1e-9 && s + t <= 1.0 + 1e-9 {
                    let n = (u - origin[0]) as usize * size[1] + (v - origin[1]) as usize;
                    visit(n, a.z + s * (b.z - a.z) + t * (c.z - a.z));
                }
            }
        }
    }

    /// Edges with one triangle, and the vertex of that triangle opposite to each.
    fn rim(&self) -> Vec<([u32; 2], u32)> {
        let mut met: BTreeMap<[u32; 2], (u32, u32)> = BTreeMap::new();
        for t in &self.triangles {
            for i in 0..3 {
                let (a, b) = (t[i], t[(i + 1) % 3]);
                met.entry([a.min(b), a.max(b)]).or_insert((0, t[(i + 2) % 3])).0 += 1;
            }
        }
        met.into_iter().filter(|(_, (count, _))| *count == 1).map(|(edge, (_, opposite))| (edge, opposite)).collect()
    }

    /// Adds strips from the rim to what it reaches; `beyond` cells further than that.
    pub(super) fn reach(&mut self, reaches: &[(Reach, f64)]) {
        let pushed = |p: DVec3, spacing: f64, reach: &(Reach, f64)| {
            reach.0(p, spacing).map(|(direction, cells)| p + (direction * (cells + reach.1)).extend(0.0))
        };
        let mut quads: Vec<[DVec3; 4]> = Vec::new();
        // The spacing of the picks towards the rim at each of its points: the larger of its two edges.
        let mut ends: BTreeMap<u32, f64> = BTreeMap::new();
        for ([i, j], opposite) in self.rim() {
            let [a, b, c] = [i, j, opposite].map(|v| self.points[v as usize]);
            let along = b - a;
            let spacing = along.cross(c - a).length() / along.length().max(1e-9);
            for end in [i, j] {
                let widest = ends.entry(end).or_default();
                *widest = widest.max(spacing);
            }
            for reach in reaches {
                if let (Some(c), Some(d)) = (pushed(b, spacing, reach), pushed(a, spacing, reach)) {
                    quads.push([a, b, c, d]);
                }
            }
        }
        // A rim point near two outer boundaries fills the corner between its two strips.
        for (v, spacing) in ends {
            let p = self.points[v as usize];
            let to: Vec<DVec3> = reaches.iter().filter_map(|r| pushed(p, spacing, r)).collect();
            for i in 0..to.len() {
                for j in i + 1..to.len() {
                    quads.push([p, to[i], to[i] + to[j] - p, to[j]]);
                }
            }
        }
        for quad in quads {
            let first = self.points.len() as u32;
            self.points.extend(quad);
            self.triangles.push([first, first + 1, first + 2]);
            self.triangles.push([first, first + 2, first + 3]);
        }
    }

    /// Signed distance to the rim at the grid nodes, cells; positive inside.
    pub(super) fn signed_distance(&self, origin: [i32; 2], size: [usize; 2]) -> Vec<f32> {
        let mut covered = vec![false; size[0] * size[1]];
        for index in 0..self.triangles.len() {
            self.each_node(index, origin, size, |n, _| covered[n] = true);
        }
        let outside = flood(size, &covered);
        let bins = TriangleBins::new(self, origin, size);
        let mut rim: Vec<DVec2> = Vec::new();
        for ([a, b], _) in self.rim() {
            let (a, b) = (self.points[a as usize].truncate(), self.points[b as usize].truncate());
            let length = a.distance(b);
            if length < 1e-9 {
                continue;
            }
            let normal = (b - a).perp() / length;
            let count = (length / RIM_SPACING).ceil();
            for i in 0..=count as usize {
                let p = a.lerp(b, i as f64 / count);
                // Most points of a mesh lie inside it, which the nodes around them tell at once.
                if !touches(&outside, origin, size, p) {
                    continue;
                }
                let seam = bins.holds(self, p + normal * PROBE) && bins.holds(self, p - normal * PROBE);
                if !seam {
                    rim.push(p);
                }
            }
        }
        let far = (size[0] + size[1]) as f32;
        let distance = distances(origin, size, &rim, far);
        distance.iter().zip(&outside).map(|(&d, &out)| if out { -d } else { d }).collect()
    }
}

/// Uncovered nodes that are connected with the grid's border.
fn flood(size: [usize; 2], covered: &[bool]) -> Vec<bool> {
    let [nu, nv] = size;
    let mut outside = vec![false; covered.len()];
    let mut stack: Vec<usize> = (0..covered.len())
        .filter(|&n| {
            let (u, v) = (n / nv, n % nv);
            (u == 0 || v == 0 || u == nu - 1 || v == nv - 1) && !covered[n]
        })
        .collect();
    stack.iter().for_each(|&n| outside[n] = true);
    while let Some(n) = stack.pop() {
        let (u, v) = (n / nv, n % nv);
        let mut visit = |m: usize| {
            if !covered[m] && !outside[m] {
                outside[m] = true;
                stack.push(m);
            }
        };
        if u > 0 {
            visit(n - nv);
        }
        if u + 1 < nu {
            visit(n + nv);
        }
        if v > 0 {
            visit(n - 1);
        }
        if v + 1 < nv {
            visit(n + 1);
        }
    }
    outside
}

/// Whether a node within two cells of `p` lies outside, or the grid ends there.
fn touches(outside: &[bool], origin: [i32; 2], size: [usize; 2], p: DVec2) -> bool {
    let (u, v) = (p.x.floor() as i64 - i64::from(origin[0]), p.y.floor() as i64 - i64::from(origin[1]));
    (u - 1..=u + 2).any(|u| {
        (v - 1..=v + 2).any(|v| {
            u >= 0
                && v >= 0
                && (u as usize) < size[0]
                && (v as usize) < size[1]
                && outside[u as usize * size[1] + v as usize]
        })
    })
}

/// Triangles by the unit cells they touch.
struct TriangleBins {
    origin: [i32; 2],
    size: [usize; 2],
    cells: Vec<Vec<u32>>,
}

impl TriangleBins {
    fn new(patch: &FaultPatch, origin: [i32; 2], size: [usize; 2]) -> Self {
        let mut cells = vec![Vec::new(); size[0] * size[1]];
        for (index, t) in patch.triangles.iter().enumerate() {
            let [a, b, c] = patch.corners(t);
            let (lo, hi) = (a.min(b).min(c), a.max(b).max(c));
            let span = |lo: f64, hi: f64, origin: i32, n: usize| {
                let clamp = |x: f64| (x - f64::from(origin)).floor().clamp(0.0, n as f64 - 1.0) as usize;
                clamp(lo)..=clamp(hi)
            };
            for u in span(lo.x, hi.x, origin[0], size[0]) {
                for v in span(lo.y, hi.y, origin[1], size[1]) {
                    cells[u * size[1] + v].push(index as u32);
                }
            }
        }
        Self { origin, size, cells }
    }

    /// Whether some triangle holds `p`.
    fn holds(&self, patch: &FaultPatch, p: DVec2) -> bool {
        let clamp = |x: f64, origin: i32, n: usize| (x - f64::from(origin)).floor().clamp(0.0, n as f64 - 1.0) as usize;
        let cell = clamp(p.x, self.origin[0], self.size[0]) * self.size[1] + clamp(p.y, self.origin[1], self.size[1]);
        self.cells[cell].iter().any(|&t| {
            let [a, b, c] = patch.corners(&patch.triangles[t as usize]).map(DVec3::truncate);
            let side = |a: DVec2, b: DVec2| (b - a).perp_dot(p - a);
            let (s, t, r) = (side(a, b), side(b, c), side(c, a));
            (s >= 0.0 && t >= 0.0 && r >= 0.0) || (s <= 0.0 && t <= 0.0 && r <= 0.0)
        })
    }
}

/// Distance from each node to the nearest of `points`, cells, by passing the nearest point on from neighbour
/// to neighbour.
fn distances(origin: [i32; 2], size: [usize; 2], points: &[DVec2], far: f32) -> Vec<f32> {
    let [nu, nv] = size;
    let at = |n: usize| DVec2::new(f64::from(origin[0]) + (n / nv) as f64, f64::from(origin[1]) + (n % nv) as f64);
    let mut nearest: Vec<u32> = vec![u32::MAX; nu * nv];
    let better = |nearest: &mut Vec<u32>, n: usize, p: u32| {
        if p != u32::MAX
            && (nearest[n] == u32::MAX
                || at(n).distance_squared(points[p as usize]) < at(n).distance_squared(points[nearest[n] as usize]))
        {
            nearest[n] = p;
        }
    };
    for (i, p) in points.iter().enumerate() {
        let (u, v) = (p.x.floor() as i64 - i64::from(origin[0]), p.y.floor() as i64 - i64::from(origin[1]));
        // The four nodes around it; a rim off the grid goes to the nearest border nodes.
        for (du, dv) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let (u, v) = ((u + du).clamp(0, nu as i64 - 1) as usize, (v + dv).clamp(0, nv as i64 - 1) as usize);
            better(&mut nearest, u * nv + v, i as u32);
        }
    }
    for _ in 0..2 {
        for (su, sv) in [(1i64, 1i64), (-1, -1), (1, -1), (-1, 1)] {
            for a in 0..nu {
                let u = if su > 0 { a } else { nu - 1 - a };
                for b in 0..nv {
                    let v = if sv > 0 { b } else { nv - 1 - b };
                    for (du, dv) in [(-su, 0), (0, -sv), (-su, -sv), (-su, sv)] {
                        let (i, j) = (u as i64 + du, v as i64 + dv);
                        if i >= 0 && j >= 0 && (i as usize) < nu && (j as usize) < nv {
                            let p = nearest[i as usize * nv + j as usize];
                            better(&mut nearest, u * nv + v, p);
                        }
                    }
                }
            }
        }
    }
    nearest
        .iter()
        .enumerate()
        .map(|(n, &p)| if p == u32::MAX { far } else { (at(n).distance(points[p as usize]) as f32).min(far) })
        .collect()
}
