//! Joins fault sticks to a triangulated surface.
//!
//! Sticks are ordered along strike. Of the order in the file, the order along the main axis of their middles, and the
//! chains of nearest neighbours from either end, the one with the shortest path through the middles is taken (that of
//! the file if it is as short). Each stick is turned to run like the one before. Between two neighbours the triangles
//! are those whose sides across have the smallest total length (dynamic programming over the two node counts), which
//! handles any difference in count, length and spacing. All lengths are metric.

use glam::DVec3;
use survey::mesh::TriangleMesh;

/// Above this product of node counts two sticks are joined by equal shares of their length instead.
const MAX_TABLE: usize = 4_000_000;

/// Joins sticks (world, vertical value; `metres` per vertical unit) of at least two nodes each.
pub(super) fn join(sticks: &[Vec<DVec3>], metres: f64) -> TriangleMesh {
    let metric = metric(sticks, metres);
    let order = order(&metric);
    let mut mesh = TriangleMesh::default();
    let mut before: Option<(u32, Vec<DVec3>)> = None;
    for n in order {
        let (mut world, mut line) = (sticks[n].clone(), metric[n].clone());
        if let Some((_, last)) = &before
            && direction(last).dot(direction(&line)) < 0.0
        {
            world.reverse();
            line.reverse();
        }
        let first = mesh.vertices.len() as u32;
        mesh.vertices.extend(&world);
        if let Some((start, last)) = &before {
            strip(last, &line, *start, first, &mut mesh.triangles);
        }
        before = Some((first, line));
    }
    mesh
}

/// Sticks in metres.
pub(super) fn metric(sticks: &[Vec<DVec3>], metres: f64) -> Vec<Vec<DVec3>> {
    sticks.iter().map(|s| s.iter().map(|p| *p * DVec3::new(1.0, 1.0, metres)).collect()).collect()
}

fn direction(stick: &[DVec3]) -> DVec3 {
    stick.last().zip(stick.first()).map_or(DVec3::ZERO, |(b, a)| *b - *a)
}

/// The order along strike.
pub(super) fn order(sticks: &[Vec<DVec3>]) -> Vec<usize> {
    let middles: Vec<DVec3> = sticks.iter().map(|s| s.iter().sum::<DVec3>() / s.len() as f64).collect();
    let length = |order: &[usize]| order.windows(2).map(|w| middles[w[0]].distance(middles[w[1]])).sum::<f64>();
    let file: Vec<usize> = (0..sticks.len()).collect();
    let axis = super::plane_fit::PrincipalFrame::of(&middles).axes[0];
    let mut along = file.clone();
    along.sort_by(|&a, &b| middles[a].dot(axis).total_cmp(&middles[b].dot(axis)).then(a.cmp(&b)));
    let mut best = file;
    let mut shortest = length(&best);
    for candidate in [chain(&middles, along.first()), chain(&middles, along.last()), along] {
        if length(&candidate) < 0.999 * shortest {
            shortest = length(&candidate);
            best = candidate;
        }
    }
    best
}

/// The chain that starts at `first` and always continues to the nearest stick not yet visited.
fn chain(middles: &[DVec3], first: Option<&usize>) -> Vec<usize> {
    let mut order: Vec<usize> = first.into_iter().copied().collect();
    let mut left: Vec<usize> = (0..middles.len()).filter(|n| !order.contains(n)).collect();
    while let Some(&last) = order.last() {
        let nearest = (0..left.len()).min_by(|&a, &b| {
            let far = |n: usize| middles[left[n]].distance_squared(middles[last]);
            far(a).total_cmp(&far(b)).then(left[a].cmp(&left[b]))
        });
        match nearest {
            Some(n) => order.push(left.swap_remove(n)),
            None => break,
        }
    }
    order
}

/// Triangles between lines a and b, whose vertices begin at `a0` and `b0`.
fn strip(a: &[DVec3], b: &[DVec3], a0: u32, b0: u32, triangles: &mut Vec<[u32; 3]>) {
    let (n, m) = (a.len(), b.len());
    let (mut i, mut j) = (n - 1, m - 1);
    let mut made = Vec::with_capacity(n + m - 2);
    let steps = if n * m <= MAX_TABLE { shortest_steps(a, b) } else { even_steps(a, b) };
    // The steps are recovered from the far end.
    for step_on_a in steps.into_iter().rev() {
        if step_on_a {
            made.push([a0 + i as u32 - 1, a0 + i as u32, b0 + j as u32]);
            i -= 1;
        } else {
            made.push([a0 + i as u32, b0 + j as u32, b0 + j as u32 - 1]);
            j -= 1;
        }
    }
    triangles.extend(made.into_iter().rev());
}

/// For each triangle from the near end, whether its base lies on a. The sum of |a_i b_j| over all rungs is minimal.
fn shortest_steps(a: &[DVec3], b: &[DVec3]) -> Vec<bool> {
    let (n, m) = (a.len(), b.len());
    let mut row = vec![0.0; m];
    let mut from_a = vec![false; n * m];
    for i in 0..n {
        for j in 0..m {
            let by_a = if i > 0 { row[j] } else { f64::INFINITY };
            let by_b = if j > 0 { row[j - 1] } else { f64::INFINITY };
            from_a[i * m + j] = by_a <= by_b;
            let before = if i + j == 0 { 0.0 } else { by_a.min(by_b) };
            row[j] = before + a[i].distance(b[j]);
        }
    }
    let (mut i, mut j) = (n - 1, m - 1);
    let mut steps = Vec::with_capacity(n + m - 2);
    while i + j > 0 {
        let on_a = j == 0 || (i > 0 && from_a[i * m + j]);
        steps.push(on_a);
        if on_a { i -= 1 } else { j -= 1 }
    }
    steps.reverse();
    steps
}

/// The same as [`shortest_steps`], by equal shares of the two lengths; linear in the node count.
fn even_steps(a: &[DVec3], b: &[DVec3]) -> Vec<bool> {
    let shares = |line: &[DVec3]| {
        let mut sum = 0.0;
        let mut share: Vec<f64> = line
            .windows(2)
            .map(|w| {
                sum += w[0].distance(w[1]);
                sum
            })
            .collect();
        share.iter_mut().for_each(|s| *s /= sum.max(f64::MIN_POSITIVE));
        share
    };
    let mut steps: Vec<(f64, bool)> = shares(a).into_iter().map(|s| (s, true)).collect();
    steps.extend(shares(b).into_iter().map(|s| (s, false)));
    steps.sort_by(|x, y| x.0.total_cmp(&y.0));
    steps.into_iter().map(|(_, on_a)| on_a).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sticks on the plane x = 0.5·z, at y = 100·k, with k + 3 nodes each.
    fn sticks() -> Vec<Vec<DVec3>> {
        (0..6usize)
            .map(|k| {
                let count = k + 3;
                (0..count)
                    .map(|n| {
                        let z = 1000.0 * n as f64 / (count as f64 - 1.0);
                        DVec3::new(0.5 * z, 100.0 * k as f64, z)
                    })
                    .collect()
            })
            .collect()
    }

    fn area(mesh: &TriangleMesh) -> f64 {
        (0..mesh.triangles.len()).map(|t| mesh.corners(t)).map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length()).sum()
    }

    #[test]
    fn a_plane_of_unequal_shuffled_and_reversed_sticks_is_covered_once() {
        let mut shuffled = sticks();
        shuffled.swap(0, 4);
        shuffled.swap(1, 3);
        shuffled[2].reverse();
        shuffled[5].reverse();
        for metres in [1.0, 1e-3] {
            let mesh = join(&shuffled, metres);
            // 500 m of strike times 1000·√1.25 of dip.
            assert!((area(&mesh) - 500.0 * 1000.0 * 1.25_f64.sqrt()).abs() < 1e-3, "{}", area(&mesh));
            let rungs: usize = (0..5).map(|k| (k + 3) + (k + 4) - 2).sum();
            assert_eq!(mesh.triangles.len(), rungs);
            let normal = DVec3::new(1.0, 0.0, -0.5).normalize();
            assert!(mesh.vertices.iter().all(|v| v.dot(normal).abs() < 1e-9));
        }
    }

    #[test]
    fn even_steps_join_as_many_triangles() {
        let s = sticks();
        for (a, b) in [(&s[0], &s[5]), (&s[3], &s[1])] {
            for steps in [shortest_steps(a, b), even_steps(a, b)] {
                assert_eq!(steps.iter().filter(|s| **s).count(), a.len() - 1);
                assert_eq!(steps.len(), a.len() + b.len() - 2);
            }
        }
    }
}
