//! Outlines of dykes and sheets: they are thinner than cells of a lattice, so that their walls are laid out as they formed
//! and carried through later events.

use crate::kinds::Act;
use crate::stage::Stage;
use glam::{DVec2, DVec3};
use survey::TriangleMesh;

/// Cells along each side of a slab.
const CELLS: usize = 36;
/// Cells from the middle of a lens to its rim, and around.
const RINGS: usize = 20;
const AROUND: usize = 64;

impl Stage<'_> {
    /// Whether an act brings a dyke or a sheet that no later fault divides.
    pub(super) fn is_laid_out(&self, act: usize) -> bool {
        let divides = |later: &Act| {
            let is_fault = later.deformation().is_some_and(|map| map.offset(DVec3::ZERO).is_some());
            is_fault || matches!(later, Act::Dominoes(_))
        };
        matches!(self.acts()[act], Act::Dyke(_) | Act::Sheet(_)) && !self.acts()[act + 1..].iter().any(divides)
    }

    /// The closed outline of a dyke or a sheet, uncut by the ground, unless a later fault divides it.
    pub(super) fn laid_outline(&self, act: usize) -> Option<TriangleMesh> {
        if !self.is_laid_out(act) {
            return None;
        }
        let reach = 0.75 * self.history().size().length();
        let square = |u: f64, v: f64| (2.0 * DVec2::new(u, v) - 1.0) * reach;
        let mut mesh = match &self.acts()[act] {
            Act::Dyke(dyke) => {
                let (count, half) = dyke.outlines();
                (0..count).fold(TriangleMesh::default(), |mut all, n| {
                    let one = match half {
                        Some(half) => lens(|on, sign| dyke.wall(n, on * half, sign)),
                        None => slab(|u, v, sign| dyke.wall(n, square(u, v), sign)),
                    };
                    let first = all.vertices.len() as u32;
                    all.vertices.extend(one.vertices);
                    all.triangles.extend(one.triangles.into_iter().map(|corners| corners.map(|n| n + first)));
                    all
                })
            }
            Act::Sheet(sheet) => match sheet.radius() {
                Some(radius) => lens(|on, sign| sheet.wall(on * radius, 0.5 + 0.5 * sign)),
                None => slab(|u, v, sign| sheet.wall(square(u, v), 0.5 + 0.5 * sign)),
            },
            _ => return None,
        };
        for later in &self.acts()[act + 1..] {
            let Some(map) = later.deformation() else { continue };
            mesh.vertices.iter_mut().for_each(|p| *p = map.apply(*p, 0));
        }
        Some(outward(mesh))
    }
}

/// Turns triangles so that they face out of what they enclose.
fn outward(mut mesh: TriangleMesh) -> TriangleMesh {
    let volume: f64 = (0..mesh.triangles.len()).map(|n| mesh.corners(n)).map(|[a, b, c]| a.dot(b.cross(c))).sum();
    if volume < 0.0 {
        mesh.triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
    }
    mesh
}

/// Two walls over a square, and the rim between them.
fn slab(wall: impl Fn(f64, f64, f64) -> DVec3) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    let side = CELLS as u32 + 1;
    for sign in [-1.0, 1.0] {
        let share = |n: usize| n as f64 / CELLS as f64;
        mesh.vertices.extend(
            (0..=CELLS).flat_map(|u| (0..=CELLS).map(move |v| (u, v))).map(|(u, v)| wall(share(u), share(v), sign)),
        );
    }
    let (cells, far) = (CELLS as u32, side * side);
    for n in 0..cells * cells {
        let a = n / cells * side + n % cells;
        let [b, c, d] = [a + side, a + side + 1, a + 1];
        mesh.triangles.extend([[a, b, c], [a, c, d], [a + far, c + far, b + far], [a + far, d + far, c + far]]);
    }
    let along = |corner: u32, step: u32| (0..cells).map(move |n| (corner + n * step, corner + (n + 1) * step));
    // Around the rim as the near wall's edges are passed.
    let rim = along(0, side).chain(along(cells * side, 1));
    let back = along(0, 1).map(|(a, b)| (b, a)).chain(along(cells, side).map(|(a, b)| (b, a)));
    for (a, b) in rim.chain(back) {
        mesh.triangles.extend([[b, a, a + far], [b, a + far, b + far]]);
    }
    mesh
}

/// Two walls over the unit disc that meet in its rim.
fn lens(wall: impl Fn(DVec2, f64) -> DVec3) -> TriangleMesh {
    let on = |ring: usize, turn: usize| {
        let r = ring as f64 / RINGS as f64;
        // Rings crowd at the rim, where a sheet thins.
        DVec2::from_angle(std::f64::consts::TAU * turn as f64 / AROUND as f64) * (1.0 - (1.0 - r) * (1.0 - r))
    };
    let mut mesh =
        TriangleMesh { vertices: (0..AROUND).map(|turn| wall(on(RINGS, turn), 1.0)).collect(), triangles: Vec::new() };
    for sign in [-1.0, 1.0] {
        let middle = mesh.vertices.len() as u32;
        mesh.vertices.push(wall(DVec2::ZERO, sign));
        for ring in 1..RINGS {
            mesh.vertices.extend((0..AROUND).map(|turn| wall(on(ring, turn), sign)));
        }
        let at = |ring: usize, turn: usize| match ring {
            RINGS => (turn % AROUND) as u32,
            _ => middle + 1 + ((ring - 1) * AROUND + turn % AROUND) as u32,
        };
        let first = mesh.triangles.len();
        for turn in 0..AROUND {
            mesh.triangles.push([middle, at(1, turn), at(1, turn + 1)]);
            for ring in 1..RINGS {
                let [a, b, c, d] = [at(ring, turn), at(ring + 1, turn), at(ring + 1, turn + 1), at(ring, turn + 1)];
                mesh.triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
        if sign < 0.0 {
            mesh.triangles[first..].iter_mut().for_each(|corners| corners.swap(1, 2));
        }
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    #[test]
    fn outlines_are_closed_and_face_outwards() {
        let slab = slab(|u, v, sign| DVec3::new(u, v, 0.1 * sign));
        let lens = lens(|on, sign| on.extend(0.5 * sign * (1.0 - on.length_squared()).max(0.0).sqrt()));
        for (mesh, volume) in [(outward(slab), 0.2), (outward(lens), 2.0 / 3.0 * std::f64::consts::PI)] {
            let mut edges: BTreeMap<(u32, u32), i32> = BTreeMap::new();
            for &[a, b, c] in &mesh.triangles {
                for (from, to) in [(a, b), (b, c), (c, a)] {
                    *edges.entry((from.min(to), from.max(to))).or_default() += if from < to { 1 } else { -1 };
                }
            }
            assert!(edges.values().all(|count| *count == 0), "an edge without its other side");
            let corners = (0..mesh.triangles.len()).map(|n| mesh.corners(n));
            let found: f64 = corners.map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum();
            assert!((found / volume - 1.0).abs() < 0.02, "{found} {volume}");
        }
    }
}
