//! Faults as triangles: laid out on their surfaces when they formed, then carried through all later events: moved, cut where
//! younger faults cut them, and cut off where erosion took them away.

use crate::deformation::Deformation;
use crate::kinds::{Act, Fault as FaultAct};
use crate::stage::Stage;
use glam::{DVec2, DVec3};
use survey::{Fault, TriangleMesh};

/// Cells along strike, and at most down the dip.
const ALONG: usize = 40;
const DOWN: usize = 60;
/// Cells from the middle to the tip line, and around.
const RINGS: usize = 14;
const AROUND: usize = 56;

impl Stage<'_> {
    /// All faults of the block up to their tips, in the order of their events.
    pub(super) fn faults(&self) -> Vec<Fault> {
        let mut found: Vec<Fault> = Vec::new();
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
                let mesh = self.carried(n, mesh);
                if mesh.triangles.is_empty() {
                    continue;
                }
                // A growth fault slips in steps; the last one shows where it lies.
                found.retain(|fault| fault.name != name);
                found.push(Fault::new(name, mesh));
            }
        }
        found
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

    /// Carries a surface that was made by act `made` to the present, and leaves what lies in the block.
    fn carried(&self, made: usize, mut mesh: TriangleMesh) -> TriangleMesh {
        for act in &self.acts()[made + 1..] {
            if let Act::Erosion(erosion) = act {
                let off: Vec<f64> = mesh.vertices.iter().map(|p| erosion.depth_at(p.truncate()) - p.z).collect();
                [mesh, _] = mesh.parted(&off);
            }
            let Some(map) = act.deformation() else { continue };
            if mesh.vertices.first().is_some_and(|p| map.offset(*p).is_some()) {
                let off: Vec<f64> = mesh.vertices.iter().map(|p| map.offset(*p).unwrap_or(0.0)).collect();
                let [foot, hanging] = mesh.parted(&off);
                mesh = joined(moved(foot, map, 0), moved(hanging, map, 1));
            } else {
                mesh.vertices.iter_mut().for_each(|p| *p = map.apply(*p, map.side_before(*p)));
            }
        }
        let (size, rim) = (self.history().size(), 0.02 * self.history().size());
        for axis in 0..3 {
            let low: Vec<f64> = mesh.vertices.iter().map(|p| -rim[axis] - p[axis]).collect();
            [mesh, _] = mesh.parted(&low);
            let high: Vec<f64> = mesh.vertices.iter().map(|p| p[axis] - size[axis] - rim[axis]).collect();
            [mesh, _] = mesh.parted(&high);
        }
        mesh
    }
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
