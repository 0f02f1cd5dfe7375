//! From edges to rings: pieces of one area cancel the edges they share, and the remaining edges are traced.

use super::clip::{Edge, Tag};
use glam::DVec2;
use std::collections::HashMap;
use std::hash::Hash;

/// The edges whose reverse does not belong to the same area, in the order given; `may` says which may be
/// cancelled at all.
pub(super) fn cancel_within<K: Hash + Eq + Copy>(
    edges: &[Edge],
    area: impl Fn(&Edge) -> K,
    may: impl Fn(&Edge) -> bool,
) -> Vec<Edge> {
    let mut waiting: HashMap<(u32, u32, K), Vec<usize>> = HashMap::new();
    let mut gone = vec![false; edges.len()];
    for (i, edge) in edges.iter().enumerate() {
        if edge.tag != Tag::Frame && may(edge) {
            let key = area(edge);
            let reverse = waiting.get_mut(&(edge.to, edge.from, key)).and_then(Vec::pop);
            if let Some(j) = reverse {
                gone[i] = true;
                gone[j] = true;
            } else {
                waiting.entry((edge.from, edge.to, key)).or_default().push(i);
            }
        }
    }
    edges.iter().zip(&gone).filter(|(_, g)| !**g).map(|(e, _)| *e).collect()
}

/// Traces edges into polygons: each outer ring with the holes inside it, by area and then first edge.
pub(super) fn polygons<A: Ord + Copy>(
    edges: &[Edge],
    positions: &[DVec2],
    area: impl Fn(&Edge) -> A,
) -> Vec<(A, Vec<Vec<DVec2>>)> {
    let mut sorted: Vec<(A, Edge)> = edges.iter().map(|e| (area(e), *e)).collect();
    sorted.sort_by_key(|(a, _)| *a);
    let mut out = Vec::new();
    for group in sorted.chunk_by(|x, y| x.0 == y.0) {
        let edges: Vec<Edge> = group.iter().map(|(_, e)| *e).collect();
        let rings = rings(&edges, positions);
        let (outer, holes): (Vec<_>, Vec<_>) = rings.into_iter().partition(|r| signed_area(r) > 0.0);
        let mut made: Vec<Vec<Vec<DVec2>>> = outer.into_iter().map(|r| vec![r]).collect();
        for hole in holes {
            // The smallest outer ring around it.
            let inside = inner_point(&hole);
            let around = (0..made.len())
                .filter(|&i| winding(&made[i][..1], inside) != 0)
                .min_by(|&i, &j| signed_area(&made[i][0]).total_cmp(&signed_area(&made[j][0])));
            if let Some(i) = around {
                made[i].push(hole);
            }
        }
        out.extend(made.into_iter().map(|rings| (group[0].0, rings)));
    }
    out
}

/// Walks the edges into closed rings with the area on the left.
fn rings(edges: &[Edge], positions: &[DVec2]) -> Vec<Vec<DVec2>> {
    let mut leaving: HashMap<u32, Vec<usize>> = HashMap::new();
    for (i, edge) in edges.iter().enumerate() {
        leaving.entry(edge.from).or_default().push(i);
    }
    let at = |v: u32| positions[v as usize];
    let mut used = vec![false; edges.len()];
    let mut out = Vec::new();
    for start in 0..edges.len() {
        if used[start] {
            continue;
        }
        let mut ring: Vec<usize> = Vec::new();
        let mut current = start;
        loop {
            used[current] = true;
            ring.push(current);
            let edge = edges[current];
            if edge.to == edges[start].from {
                break;
            }
            let back = at(edge.from) - at(edge.to);
            let free = leaving.get(&edge.to).into_iter().flatten().copied().filter(|&i| !used[i]);
            // Where several leave, the next one clockwise from where we came closes off this area.
            let next = free.min_by(|&i, &j| {
                let turn = |i: usize| clockwise(back, at(edges[i].to) - at(edges[i].from));
                turn(i).total_cmp(&turn(j)).then(i.cmp(&j))
            });
            match next {
                Some(i) => current = i,
                None => break,
            }
        }
        let points = corners(&ring, edges, positions);
        if points.len() >= 3 && signed_area(&points).abs() > 1e-14 {
            out.push(points);
        }
    }
    out
}

/// Angle from `a` clockwise to `b`, in (0, 2π].
fn clockwise(a: DVec2, b: DVec2) -> f64 {
    let angle = -a.angle_to(b);
    if angle <= 0.0 { angle + std::f64::consts::TAU } else { angle }
}

/// The ring's vertices, without the needless ones along the frame and without repeated places.
fn corners(ring: &[usize], edges: &[Edge], positions: &[DVec2]) -> Vec<DVec2> {
    let mut points = Vec::with_capacity(ring.len());
    for (i, &edge) in ring.iter().enumerate() {
        let before = edges[ring[(i + ring.len() - 1) % ring.len()]];
        let edge = edges[edge];
        let (a, b, c) = (positions[before.from as usize], positions[edge.from as usize], positions[edge.to as usize]);
        let straight = before.tag == Tag::Frame && edge.tag == Tag::Frame && {
            let (p, q) = (b - a, c - b);
            p.perp_dot(q).abs() <= 1e-9 * p.length() * q.length() && p.dot(q) > 0.0
        };
        if !straight && points.last() != Some(&b) {
            points.push(b);
        }
    }
    while points.len() > 1 && points.first() == points.last() {
        points.pop();
    }
    points
}

/// Area of a ring, positive when it turns from s to t.
pub(super) fn signed_area(ring: &[DVec2]) -> f64 {
    let origin = ring.first().copied().unwrap_or_default();
    (0..ring.len()).map(|i| 0.5 * (ring[i] - origin).perp_dot(ring[(i + 1) % ring.len()] - origin)).sum()
}

/// A point just inside the ring's turn, beside its longest edge.
fn inner_point(ring: &[DVec2]) -> DVec2 {
    let edge = |i: usize| ring[(i + 1) % ring.len()] - ring[i];
    let longest = (0..ring.len()).max_by(|&i, &j| edge(i).length().total_cmp(&edge(j).length())).unwrap_or(0);
    let side = signed_area(ring).signum();
    ring[longest] + 0.5 * edge(longest) + 1e-6 * side * edge(longest).perp()
}

/// How often the rings wind around `p`; 0 outside and in holes.
pub(super) fn winding(rings: &[Vec<DVec2>], p: DVec2) -> i32 {
    let mut turns = 0;
    for ring in rings {
        for i in 0..ring.len() {
            let (a, b) = (ring[i] - p, ring[(i + 1) % ring.len()] - p);
            if a.y <= 0.0 && b.y > 0.0 && a.perp_dot(b) > 0.0 {
                turns += 1;
            } else if a.y > 0.0 && b.y <= 0.0 && a.perp_dot(b) < 0.0 {
                turns -= 1;
            }
        }
    }
    turns
}
