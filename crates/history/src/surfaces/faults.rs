//! Faults as triangles: laid out on their surfaces when they formed, then carried through all later events.
//!
//! A younger fault that crosses the block severs an older one: what lies on its two sides are two faults that end at it. A
//! fault ends upwards at what is younger than it: it is drawn where rock that is older than it lies on one of its sides at
//! least, so that beds which were laid on its scarp end at it, and beds above the scarp pass over it.

use crate::deformation::Deformation;
use crate::kinds::{Act, Fault as FaultAct};
use crate::place::{Place, Rock};
use crate::stage::{Known, Stage};
use glam::{DVec2, DVec3};
use std::collections::{BTreeSet, HashMap};
use survey::{Fault, TriangleMesh};

/// Cells along strike, and at most down the dip.
const ALONG: usize = 64;
const DOWN: usize = 96;
/// Cells from the middle to the tip line, and around.
const RINGS: usize = 20;
const AROUND: usize = 72;
/// Halvings of a triangle's edge for the place where a fault ends.
const HALVINGS: usize = 26;
/// How far beyond the block's sides a fault is drawn, as a share of its longer edge: beyond its tip it would divide nothing,
/// and sheets are continued that far by 0.12 of it in a model.
const BEYOND: f64 = 0.15;
/// So far above the ground a fault goes on, as a share of the block's height, so that its line on the ground is whole.
const ABOVE_GROUND: f64 = 0.004;
/// A piece of a fault whose area is a smaller share of the block's smallest face is left out.
const SLIVER: f64 = 2e-3;

/// A piece of a fault.
struct Piece {
    mesh: TriangleMesh,
    /// The act of the youngest fault that severed it from another piece.
    ends_at: Option<usize>,
}

/// All pieces of a fault, the largest first, and the names of the faults that severed them.
struct Drawn {
    name: String,
    pieces: Vec<(TriangleMesh, Option<String>)>,
}

impl Stage<'_> {
    /// All faults of the block up to their tips, in the order of their events. The pieces of a severed one are named after
    /// it and numbered.
    pub fn faults(&self) -> Vec<Fault> {
        let mut found: Vec<Drawn> = Vec::new();
        let mut dominoes = 0;
        for (n, act) in self.acts().iter().enumerate() {
            let drawn: Vec<(String, TriangleMesh)> = match act {
                Act::Fault(fault) => vec![(fault.name.clone().unwrap_or_default(), self.laid_out(fault))],
                Act::Dominoes(act) => {
                    let reach = self.history().size().length();
                    let planes = act.planes(reach).into_iter().map(|corners| grid([DOWN / 2, ALONG / 2], corners));
                    planes
                        .map(|mesh| {
                            dominoes += 1;
                            (format!("D{dominoes}"), mesh)
                        })
                        .collect()
                }
                _ => continue,
            };
            for (name, mesh) in drawn {
                let pieces = self.pieces(n, mesh);
                if !pieces.is_empty() {
                    // A growth fault slips in steps; the last one shows where it lies.
                    found.retain(|fault| fault.name != name);
                    found.push(Drawn { name, pieces });
                }
            }
        }
        numbered(&found)
    }

    /// What is left in the block of a fault that was made by act `made`, the largest piece first.
    fn pieces(&self, made: usize, mesh: TriangleMesh) -> Vec<(TriangleMesh, Option<String>)> {
        let size = self.history().size();
        let least = SLIVER * size.x.min(size.y) * size.z;
        let kept = |piece: Piece| {
            let mesh = kept_where(&self.within(piece.mesh), |p| self.is_broken(made, p));
            let by = piece.ends_at.and_then(|act| self.acts()[act].name().map(str::to_owned));
            (area(&mesh) > least).then_some((mesh, by))
        };
        let mut pieces: Vec<_> = self.carried(made, mesh).into_iter().filter_map(kept).collect();
        pieces.sort_by(|a, b| area(&b.0).total_cmp(&area(&a.0)));
        pieces
    }

    /// Whether rock older than a fault lies on one of its sides, at a place on it, or would if the ground lay a little
    /// higher.
    fn is_broken(&self, made: usize, p: DVec3) -> bool {
        let around = self.around(made, p);
        // What intrudes cuts the fault where it is drawn.
        let is_older = |rock: &Rock| rock.act < made || !matches!(self.acts()[rock.act], Act::Beds(_));
        if around.iter().any(|place| place.rock().is_some()) {
            return around.iter().filter_map(Place::rock).any(is_older);
        }
        let below = self.around(made, p + DVec3::Z * ABOVE_GROUND * self.history().size().z);
        below.iter().filter_map(Place::rock).any(is_older)
    }

    /// What lies on the sides of a fault at a place on it.
    fn around(&self, made: usize, p: DVec3) -> Vec<Place> {
        let mut sides = self.sides_after(made, p);
        let q = self.before(made, &sides, p);
        let around: BTreeSet<i8> = match &self.acts()[made] {
            Act::Dominoes(map) => {
                [DVec3::X, DVec3::Y, -DVec3::X, -DVec3::Y].into_iter().map(|step| map.side(q + 0.05 * step)).collect()
            }
            _ => BTreeSet::from([0, 1]),
        };
        let on = |side: i8| {
            sides.0[made] = side;
            self.place_among(p, &Known { sides, from: made })
        };
        around.into_iter().map(on).collect()
    }

    fn laid_out(&self, fault: &FaultAct) -> TriangleMesh {
        let (frame, reach) = (fault.frame(), 1.2 * self.history().size().length());
        let depth = |z: f64| z - frame.at.z;
        let trace = fault.trace([depth(-0.6 * reach), depth(0.6 * reach)], reach);
        if let Some(half) = fault.tip() {
            let down = (trace[1] - trace[0]).normalize();
            let place = |ring: usize, turn: usize| {
                let r = ring as f64 / RINGS as f64;
                let on = DVec2::from_angle(std::f64::consts::TAU * turn as f64 / AROUND as f64) * half * r;
                frame.place(DVec3::new(down.x * on.y, on.x, down.y * on.y))
            };
            return disc(place);
        }
        let place = |u: f64, v: f64| {
            let on = along(&trace, u);
            frame.place(DVec3::new(on.x, (2.0 * v - 1.0) * 0.6 * reach, on.y))
        };
        grid_of([DOWN, ALONG], place)
    }

    /// Carries a surface that was made by act `made` to the present.
    fn carried(&self, made: usize, mesh: TriangleMesh) -> Vec<Piece> {
        let mut pieces = vec![Piece { mesh, ends_at: None }];
        for (n, act) in self.acts().iter().enumerate().skip(made + 1) {
            let Some(map) = act.deformation() else { continue };
            let severs = matches!(act, Act::Fault(fault) if fault.tip().is_none());
            let mut after = Vec::new();
            for Piece { mut mesh, ends_at } in pieces {
                let off: Option<Vec<f64>> = mesh.vertices.iter().map(|p| map.offset(*p)).collect();
                let Some(off) = off.filter(|off| !off.is_empty()) else {
                    mesh.vertices.iter_mut().for_each(|p| *p = map.apply(*p, map.side_before(*p)));
                    after.push(Piece { mesh, ends_at });
                    continue;
                };
                let [foot, hanging] = mesh.parted(&off);
                let is_severed = severs && !foot.triangles.is_empty() && !hanging.triangles.is_empty();
                let (foot, hanging) = (moved(foot, map, 0), moved(hanging, map, 1));
                if is_severed {
                    after.extend([foot, hanging].map(|mesh| Piece { mesh, ends_at: Some(n) }));
                } else {
                    after.push(Piece { mesh: joined(foot, hanging), ends_at });
                }
            }
            pieces = after;
        }
        pieces
    }

    /// What lies in the block and around it, as far as a model continues its sheets.
    fn within(&self, mut mesh: TriangleMesh) -> TriangleMesh {
        let size = self.history().size();
        let rim = (BEYOND * size.x.max(size.y)) * DVec3::new(1.0, 1.0, 0.0) + DVec3::Z * 0.02 * size.z;
        for axis in 0..3 {
            let low: Vec<f64> = mesh.vertices.iter().map(|p| -rim[axis] - p[axis]).collect();
            [mesh, _] = mesh.parted(&low);
            let high: Vec<f64> = mesh.vertices.iter().map(|p| p[axis] - size[axis] - rim[axis]).collect();
            [mesh, _] = mesh.parted(&high);
        }
        mesh
    }
}

/// The faults of what was drawn: pieces have the fault's name and a number, and end at the nearest piece of the fault that
/// severed them.
fn numbered(found: &[Drawn]) -> Vec<Fault> {
    let taken: BTreeSet<&str> = found.iter().map(|fault| fault.name.as_str()).collect();
    let mut named: Vec<(&Drawn, Vec<String>)> = Vec::new();
    for fault in found {
        let free = (2..).map(|n| format!("{} {n}", fault.name)).filter(|name| !taken.contains(name.as_str()));
        let names = std::iter::once(fault.name.clone()).chain(free).take(fault.pieces.len()).collect();
        named.push((fault, names));
    }
    let nearest = |mesh: &TriangleMesh, by: &str| {
        let (fault, names) = named.iter().find(|(fault, _)| fault.name == by)?;
        let apart = |other: &TriangleMesh| {
            let some =
                |mesh: &TriangleMesh| mesh.vertices.iter().copied().step_by(1 + mesh.vertices.len() / 400).collect();
            let (own, other): (Vec<DVec3>, Vec<DVec3>) = (some(mesh), some(other));
            let to = |p: &DVec3| other.iter().map(|q| p.distance_squared(*q)).fold(f64::INFINITY, f64::min);
            own.iter().map(to).fold(f64::INFINITY, f64::min)
        };
        let of = fault.pieces.iter().zip(names).map(|((mesh, _), name)| (apart(mesh), name));
        of.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, name)| name.clone())
    };
    let mut faults = Vec::new();
    for (fault, names) in &named {
        for ((mesh, by), name) in fault.pieces.iter().zip(names) {
            let truncated_by = by.as_ref().filter(|by| **by != fault.name).and_then(|by| nearest(mesh, by));
            faults.push(Fault { truncated_by, ..Fault::new(name.clone(), mesh.clone()) });
        }
    }
    faults
}

/// The part of a surface in which something holds, with its rim where it ceases to.
fn kept_where(mesh: &TriangleMesh, holds: impl Fn(DVec3) -> bool) -> TriangleMesh {
    let holding: Vec<bool> = mesh.vertices.iter().map(|p| holds(*p)).collect();
    let mut kept = TriangleMesh::default();
    let mut known: HashMap<(u32, u32), u32> = HashMap::new();
    let mut vertex = |kept: &mut TriangleMesh, inside: u32, outside: u32| {
        *known.entry((inside, outside)).or_insert_with(|| {
            let [mut near, mut far] = [inside, outside].map(|n| mesh.vertices[n as usize]);
            for _ in 0..HALVINGS {
                let middle = near.midpoint(far);
                if holds(middle) { near = middle } else { far = middle }
            }
            kept.vertices.push(near);
            kept.vertices.len() as u32 - 1
        })
    };
    for corners in &mesh.triangles {
        let mut ring = Vec::with_capacity(4);
        for n in 0..3 {
            let (a, b) = (corners[n], corners[(n + 1) % 3]);
            if holding[a as usize] {
                ring.push(vertex(&mut kept, a, a));
            }
            match (holding[a as usize], holding[b as usize]) {
                (true, false) => ring.push(vertex(&mut kept, a, b)),
                (false, true) => ring.push(vertex(&mut kept, b, a)),
                _ => {}
            }
        }
        kept.triangles.extend((2..ring.len()).map(|n| [ring[0], ring[n - 1], ring[n]]));
    }
    kept
}

/// Area of a surface, m².
fn area(mesh: &TriangleMesh) -> f64 {
    let corners = (0..mesh.triangles.len()).map(|n| mesh.corners(n));
    corners.map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length()).sum()
}

fn moved(mut mesh: TriangleMesh, map: &dyn Deformation, side: i8) -> TriangleMesh {
    mesh.vertices.iter_mut().for_each(|p| *p = map.apply(*p, side));
    mesh
}

fn joined(mut one: TriangleMesh, other: TriangleMesh) -> TriangleMesh {
    let first = one.vertices.len() as u32;
    one.vertices.extend(other.vertices);
    one.triangles.extend(other.triangles.into_iter().map(|corners| corners.map(|n| n + first)));
    one
}

/// A place of a line by its share of the length.
fn along(line: &[DVec2], share: f64) -> DVec2 {
    let whole: f64 = line.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    let mut left = share * whole;
    for pair in line.windows(2) {
        let length = pair[0].distance(pair[1]);
        if left <= length {
            return pair[0].lerp(pair[1], left / length.max(1e-12));
        }
        left -= length;
    }
    line[line.len() - 1]
}

/// A grid between four corners.
fn grid(cells: [usize; 2], [a, b, c, d]: [DVec3; 4]) -> TriangleMesh {
    grid_of(cells, |u, v| a.lerp(b, u).lerp(d.lerp(c, u), v))
}

/// A grid of places by two shares.
fn grid_of([nu, nv]: [usize; 2], place: impl Fn(f64, f64) -> DVec3) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    for u in 0..=nu {
        mesh.vertices.extend((0..=nv).map(|v| place(u as f64 / nu as f64, v as f64 / nv as f64)));
    }
    for u in 0..nu as u32 {
        for v in 0..nv as u32 {
            let (a, b) = (u * (nv as u32 + 1) + v, (u + 1) * (nv as u32 + 1) + v);
            mesh.triangles.extend([[a, b, a + 1], [b, b + 1, a + 1]]);
        }
    }
    mesh
}

/// Rings around a middle.
fn disc(place: impl Fn(usize, usize) -> DVec3) -> TriangleMesh {
    let mut mesh = TriangleMesh { vertices: vec![place(0, 0)], triangles: Vec::new() };
    for ring in 1..=RINGS {
        mesh.vertices.extend((0..AROUND).map(|turn| place(ring, turn)));
    }
    let at = |ring: usize, turn: usize| 1 + ((ring - 1) * AROUND + turn % AROUND) as u32;
    for turn in 0..AROUND {
        mesh.triangles.push([0, at(1, turn), at(1, turn + 1)]);
        for ring in 1..RINGS {
            let [a, b, c, d] = [at(ring, turn), at(ring + 1, turn), at(ring + 1, turn + 1), at(ring, turn + 1)];
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    mesh
}
