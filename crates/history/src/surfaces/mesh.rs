//! Surfaces as triangles: cubes of a lattice in six tetrahedra each, cut where what is asked changes along their edges.
//!
//! Vertices lie on edges of the lattice, found by bisection to a millimetre; neighbouring tetrahedra share them, so that the
//! outline of a body is closed. Corners of a surface are cut off within a cell.

use crate::kinds::Act;
use crate::place::{Rock, Sides};
use crate::stage::Stage;
use glam::DVec3;
use rayon::prelude::*;
use std::collections::HashMap;
use survey::TriangleMesh;

/// Cells along the block's longest edge.
const CELLS: f64 = 72.0;

/// The corners of a cube in six tetrahedra around the diagonal from corner 0 to corner 7 (bits x = 4, y = 2, z = 1).
const TETRAHEDRA: [[usize; 4]; 6] =
    [[0, 4, 6, 7], [0, 6, 2, 7], [0, 2, 3, 7], [0, 3, 1, 7], [0, 1, 5, 7], [0, 5, 4, 7]];

/// A lattice of points around the block.
struct Lattice {
    origin: DVec3,
    step: DVec3,
    count: [usize; 3],
}

impl Lattice {
    /// `beyond` cells past the block on each side.
    fn new(size: DVec3, beyond: usize) -> Self {
        let cells = (CELLS * size / size.max_element()).round().max(DVec3::splat(12.0));
        let step = size / cells;
        // Off round numbers, on which surfaces lie: each would meet several edges in one place.
        let shift = DVec3::new(0.137, 0.211, 0.173) * step;
        let count = cells.to_array().map(|cells| cells as usize + 2 + 2 * beyond);
        Self { origin: -step * beyond as f64 - shift, step, count }
    }

    fn place(&self, n: usize) -> DVec3 {
        let [_, ny, nz] = self.count;
        self.origin + DVec3::new((n / (ny * nz)) as f64, (n / nz % ny) as f64, (n % nz) as f64) * self.step
    }

    fn corners(&self, n: usize) -> [usize; 8] {
        let [_, ny, nz] = self.count;
        std::array::from_fn(|corner| n + (corner >> 2) * ny * nz + (corner >> 1 & 1) * nz + (corner & 1))
    }

    /// The surface between places of one kind and those of another; `None` belongs to neither, and no triangle touches it.
    fn cut(&self, is_in: impl Fn(DVec3) -> Option<bool> + Sync) -> TriangleMesh {
        let total: usize = self.count.iter().product();
        let values: Vec<Option<bool>> = (0..total).into_par_iter().map(|n| is_in(self.place(n))).collect();
        let [nx, ny, nz] = self.count;
        let mut mesh = TriangleMesh::default();
        let mut known: HashMap<(usize, usize), u32> = HashMap::new();
        let mut vertex = |mesh: &mut TriangleMesh, a: usize, b: usize| {
            *known.entry((a.min(b), a.max(b))).or_insert_with(|| {
                let (mut inside, mut outside) = (self.place(a), self.place(b));
                while inside.distance(outside) > 1e-3 {
                    let middle = 0.5 * (inside + outside);
                    if is_in(middle) == Some(true) { inside = middle } else { outside = middle }
                }
                mesh.vertices.push(inside);
                mesh.vertices.len() as u32 - 1
            })
        };
        for cell in 0..total {
            let [x, y, z] = [cell / (ny * nz), cell / nz % ny, cell % nz];
            if x + 1 == nx || y + 1 == ny || z + 1 == nz {
                continue;
            }
            let corners = self.corners(cell);
            let first = values[corners[0]];
            if corners.iter().all(|corner| values[*corner] == first) {
                continue;
            }
            for tetrahedron in TETRAHEDRA {
                let points = tetrahedron.map(|corner| corners[corner]);
                if points.iter().any(|point| values[*point].is_none()) {
                    continue;
                }
                let (inside, outside): (Vec<usize>, Vec<usize>) =
                    points.iter().partition(|point| values[**point] == Some(true));
                let ring: Vec<(usize, usize)> = match (&inside[..], &outside[..]) {
                    ([a], [b, c, d]) => vec![(*a, *b), (*a, *c), (*a, *d)],
                    ([a, b, c], [d]) => vec![(*a, *d), (*b, *d), (*c, *d)],
                    ([a, b], [c, d]) => vec![(*a, *c), (*a, *d), (*b, *d), (*b, *c)],
                    _ => continue,
                };
                let ring: Vec<u32> = ring.into_iter().map(|(a, b)| vertex(&mut mesh, a, b)).collect();
                // Outwards: from the inside to the outside.
                let out = self.place(outside[0]) - self.place(inside[0]);
                let at = |n: u32| mesh.vertices[n as usize];
                let is_turned = (at(ring[1]) - at(ring[0])).cross(at(ring[2]) - at(ring[0])).dot(out) < 0.0;
                for n in 2..ring.len() {
                    let [b, c] = if is_turned { [ring[n], ring[n - 1]] } else { [ring[n - 1], ring[n]] };
                    mesh.triangles.push([ring[0], b, c]);
                }
            }
        }
        mesh
    }
}

impl Stage<'_> {
    fn is_of(&self, p: DVec3, unit: usize) -> bool {
        self.place(p).rock().is_some_and(|rock| rock.unit == unit)
    }

    /// Whether a body is anywhere in the block.
    pub(super) fn has_body(&self, unit: usize) -> bool {
        let lattice = Lattice::new(self.history().size(), 0);
        (0..lattice.count.iter().product::<usize>()).into_par_iter().any(|n| self.is_of(lattice.place(n), unit))
    }

    /// Whether rock became that of a unit around a body, by its heat.
    pub(super) fn is_baked(&self, unit: usize) -> bool {
        let act = self.history().units()[unit].act;
        let lattice = Lattice::new(self.history().size(), 0);
        let is_baked = |p: DVec3| self.place(p).rock().is_some_and(|rock| rock.altered == Some(unit));
        matches!(self.acts()[act], Act::Body(_))
            && (0..lattice.count.iter().product::<usize>()).into_par_iter().any(|n| is_baked(lattice.place(n)))
    }

    /// The closed outline of a body and of what it baked.
    pub(super) fn baked_mesh(&self, unit: usize) -> TriangleMesh {
        let act = self.history().units()[unit].act;
        self.outline(|p| {
            let place = self.place(p);
            place.rock().is_some_and(|rock| rock.altered == Some(unit) || rock.act == act)
        })
    }

    /// The closed outline of a body, just outside of the block's faces where it goes on there.
    pub(super) fn body_mesh(&self, unit: usize) -> TriangleMesh {
        if let Some(laid) = self.laid_outline(self.history().units()[unit].act) {
            return laid;
        }
        self.outline(|p| self.is_of(p, unit))
    }

    /// The closed outline of what is in the block, just outside of its faces.
    fn outline(&self, is_in: impl Fn(DVec3) -> bool + Sync) -> TriangleMesh {
        let (lattice, size) = (Lattice::new(self.history().size(), 1), self.history().size());
        let rim = 0.4 * lattice.step;
        lattice.cut(|p| {
            let is_near = p.cmpge(-rim).all() && p.cmple(size + rim).all();
            Some(is_near && is_in(p.clamp(DVec3::ZERO, size)))
        })
    }

    /// The top of a bed that has several depths at one place: where it is older below, within each fault block. It goes on
    /// a cell beyond what is left of it.
    pub(super) fn top_mesh(&self, unit: usize) -> TriangleMesh {
        let of = &self.history().units()[unit];
        let (act, Some(bed), Act::Beds(beds)) = (of.act, of.bed, &self.acts()[of.act]) else {
            return TriangleMesh::default();
        };
        let lattice = Lattice::new(self.history().size(), 0);
        let mut whole = TriangleMesh::default();
        for sides in self.blocks(&lattice, act) {
            let rock = Rock { unit, altered: None, act, ijk: DVec3::ZERO, sides };
            let part = lattice.cut(|p| {
                if self.sides_after(act, p) != sides {
                    return None;
                }
                let q = self.before(act, &rock.sides, p);
                Some(q.z > beds.top_of(bed, q.truncate()))
            });
            let first = whole.vertices.len() as u32;
            whole.vertices.extend(part.vertices);
            whole.triangles.extend(part.triangles.into_iter().map(|corners| corners.map(|n| n + first)));
        }
        whole
    }

    /// The sides of a place for rock of an act.
    pub(super) fn sides_after(&self, act: usize, p: DVec3) -> Sides {
        self.sides_since(act + 1, p)
    }

    /// The sides of a place, of act `first` and all later ones.
    pub(super) fn sides_since(&self, first: usize, p: DVec3) -> Sides {
        let mut sides = Sides::default();
        let mut q = p;
        for (n, act) in self.acts().iter().enumerate().skip(first).rev() {
            if let Some(map) = act.deformation() {
                sides.0[n] = map.side(q);
                q = map.undo(q, sides.0[n]);
            }
        }
        sides
    }

    /// All blocks of rock of an act.
    fn blocks(&self, lattice: &Lattice, act: usize) -> Vec<Sides> {
        let total = lattice.count.iter().product::<usize>();
        let found = (0..total).into_par_iter().step_by(5).map(|n| self.sides_after(act, lattice.place(n)));
        let mut found: Vec<Sides> = found.collect();
        found.sort_unstable();
        found.dedup();
        found
    }
}
