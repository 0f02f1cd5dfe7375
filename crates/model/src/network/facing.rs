//! The direction from which a fault's triangles are seen from one side.
//!
//! Triangles that share an edge are turned to face the same way; those of parts without a common edge as the largest part
//! does. The direction is the mean of their normals n weighted by area, and those that it sees from behind or along
//! themselves get more and more weight:
//!
//! ```text
//! w ← w · exp(−c · d), d ∝ Σ w n
//! ```
//!
//! with c the cosine between d and the triangle's normal. If any direction sees all from one side, one of these does
//! (the perceptron's theorem); of all that were tried the one that sees the largest area from in front is taken.
//! In a thin fault that winds along strike the best-fit plane is level, and what winds folds over it; over the plane of
//! this direction it does not.

use super::build::Soup;
use glam::DVec3;
use std::collections::BTreeMap;

/// Directions that are tried.
const ROUNDS: usize = 40;
/// How fast weights change.
const RATE: f64 = 0.5;
/// A triangle is seen well where the cosine between its normal and the direction is larger.
const IN_FRONT: f64 = 0.1;

/// The direction that sees the largest area from in front, a unit vector; `None` where all cancels out.
pub(super) fn direction(soup: &Soup) -> Option<DVec3> {
    let normals = oriented(soup);
    let areas: Vec<f64> = normals.iter().map(|n| n.length()).collect();
    let units: Vec<DVec3> = normals.iter().map(|n| n.normalize_or_zero()).collect();
    let mut weights = areas.clone();
    let mut best: Option<(f64, DVec3)> = None;
    for _ in 0..ROUNDS {
        let sum: DVec3 = units.iter().zip(&weights).map(|(n, w)| *n * *w).sum();
        let d = sum.try_normalize()?;
        let seen: f64 = units.iter().zip(&areas).filter(|(n, _)| n.dot(d) > IN_FRONT).map(|(_, area)| area).sum();
        if best.is_none_or(|(most, _)| seen > most * (1.0 + 1e-9)) {
            best = Some((seen, d));
        }
        units.iter().zip(&mut weights).for_each(|(n, w)| *w *= (-RATE * n.dot(d)).exp());
        let most = weights.iter().copied().fold(0.0, f64::max);
        weights.iter_mut().for_each(|w| *w /= most);
    }
    best.map(|(_, d)| d)
}

/// The triangles on the other side of each edge of each triangle.
pub(super) fn neighbours(soup: &Soup) -> Vec<Vec<usize>> {
    let mut beside = vec![Vec::new(); soup.triangles.len()];
    for [a, b] in shared_edges(soup) {
        beside[a].push(b);
        beside[b].push(a);
    }
    beside
}

/// Pairs of triangles with an edge that no third has. Vertices at one place are the same.
fn shared_edges(soup: &Soup) -> Vec<[usize; 2]> {
    let same = welded(soup);
    let mut met: BTreeMap<[usize; 2], Vec<usize>> = BTreeMap::new();
    for (n, t) in soup.triangles.iter().enumerate() {
        for i in 0..3 {
            let (a, b) = (same[t[i]], same[t[(i + 1) % 3]]);
            met.entry([a.min(b), a.max(b)]).or_default().push(n);
        }
    }
    met.into_values().filter_map(|of| <[usize; 2]>::try_from(of).ok()).collect()
}

/// For each vertex the first one at its place.
pub(super) fn welded(soup: &Soup) -> Vec<usize> {
    let mut first: BTreeMap<[u64; 3], usize> = BTreeMap::new();
    let place = |p: &DVec3| p.to_array().map(|c| (c + 0.0).to_bits());
    soup.points.iter().enumerate().map(|(n, p)| *first.entry(place(p)).or_insert(n)).collect()
}

/// Area times the normal of each triangle, m², turned to face the same way.
pub(super) fn oriented(soup: &Soup) -> Vec<DVec3> {
    let mut normals: Vec<DVec3> = soup.triangles.iter().map(|&t| soup.normal(t)).collect();
    let same = welded(soup);
    let runs = |t: usize, from: usize, to: usize| {
        let t = soup.triangles[t].map(|v| same[v]);
        (0..3).any(|i| t[i] == from && t[(i + 1) % 3] == to)
    };
    let is_turned = |a: usize, b: usize| {
        let t = soup.triangles[a].map(|v| same[v]);
        // Two that face the same way run along their edge in opposite directions.
        (0..3).any(|i| runs(b, t[i], t[(i + 1) % 3]))
    };
    let mut flipped = vec![false; normals.len()];
    let beside = neighbours(soup);
    let parts = connected(&beside, |_, _| true, |a, b| flipped[b] = flipped[a] != is_turned(a, b));
    normals.iter_mut().zip(&flipped).filter(|(_, flipped)| **flipped).for_each(|(n, _)| *n = -*n);
    let mean = |part: &[usize], normals: &[DVec3]| part.iter().map(|&t| normals[t]).sum::<DVec3>();
    let largest = parts.iter().map(|part| mean(part, &normals)).max_by(|a, b| a.length().total_cmp(&b.length()));
    let Some(mut front) = largest else { return normals };
    // One of the two sides, always the same.
    if [front.z, front.y, front.x].into_iter().find(|c| c.abs() > 1e-9 * front.length()).is_some_and(|c| c < 0.0) {
        front = -front;
    }
    for part in &parts {
        if mean(part, &normals).dot(front) < 0.0 {
            part.iter().for_each(|&t| normals[t] = -normals[t]);
        }
    }
    normals
}

/// The connected parts of triangles with these neighbours, where `joins` says so; `reached(a, b)` is called when b is
/// reached from a.
pub(super) fn connected(
    beside: &[Vec<usize>],
    joins: impl Fn(usize, usize) -> bool,
    mut reached: impl FnMut(usize, usize),
) -> Vec<Vec<usize>> {
    let mut is_done = vec![false; beside.len()];
    let mut parts: Vec<Vec<usize>> = Vec::new();
    for start in 0..beside.len() {
        if is_done[start] {
            continue;
        }
        is_done[start] = true;
        let mut part = vec![start];
        let mut next = 0;
        while next < part.len() {
            let a = part[next];
            next += 1;
            for &b in beside[a].iter().filter(|&&b| joins(a, b)) {
                if !is_done[b] {
                    is_done[b] = true;
                    reached(a, b);
                    part.push(b);
                }
            }
        }
        parts.push(part);
    }
    parts
}
