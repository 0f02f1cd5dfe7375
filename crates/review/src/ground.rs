//! The ground as a mesh: heights at the nodes of a lattice of about a voxel, cut by whatever is cut out of the block.
//!
//! Faces are clipped by the same triangles ([`Ground::clip`]), so that they meet the ground without a gap.

use crate::model::Mesh;
use crate::polygon::{Welder, fan, outside};
use glam::{DVec2, DVec3, Vec3};
use model::StructuralModel;
use rayon::prelude::*;
use render::ground::Relief;
use render::visible::{Ray, Solid};
use render::{Ground as GroundStyle, Scene};
use survey::SurveyGeometry;
use survey::block::part_behind;

/// Heights of the ground over the roaming box.
pub(crate) struct Ground {
    low: DVec3,
    high: DVec3,
    cells: [usize; 2],
    step: DVec2,
    /// Voxel z of each node, `[x][y]`; below the box where there is no ground in it.
    z: Vec<f64>,
    /// Smallest and largest z.
    range: [f64; 2],
}

impl Ground {
    /// The ground of a scene, with at most so many cells along an axis.
    pub fn of(
        (style, scene): (&GroundStyle, &Scene),
        geometry: &SurveyGeometry,
        model: &StructuralModel,
        most: usize,
    ) -> Self {
        let block = scene.box_in(geometry);
        let (low, high) = (block.low(), block.high());
        let extent = (high - low).truncate();
        let cells = [extent.x, extent.y].map(|length| length.ceil().clamp(1.0, most.max(1) as f64) as usize);
        let step = extent / DVec2::new(cells[0] as f64, cells[1] as f64);
        let relief = Relief::new(style, scene, geometry, model);
        let height = |n: usize| {
            let node = DVec2::new((n / (cells[1] + 1)) as f64, (n % (cells[1] + 1)) as f64);
            let from = (low.truncate() + node * step).extend(low.z).as_vec3();
            if !relief.is_air(model, from) {
                return low.z;
            }
            let ray = Ray { origin: from, direction: Vec3::Z };
            let hit = relief.march(model, &ray, 0.0, (high.z - low.z) as f32);
            hit.map_or(high.z + 1.0, |hit| f64::from(hit.point.z))
        };
        let z: Vec<f64> = (0..(cells[0] + 1) * (cells[1] + 1)).into_par_iter().map(height).collect();
        let range = [z.iter().copied().fold(f64::MAX, f64::min), z.iter().copied().fold(f64::MIN, f64::max)];
        Self { low, high, cells, step, z, range }
    }

    fn node(&self, x: usize, y: usize) -> DVec3 {
        let xy = self.low.truncate() + DVec2::new(x as f64, y as f64) * self.step;
        xy.extend(self.z[x * (self.cells[1] + 1) + y])
    }

    /// The triangles of a cell.
    fn triangles(&self, x: usize, y: usize) -> [[DVec3; 3]; 2] {
        let [a, b, c, d] = [self.node(x, y), self.node(x + 1, y), self.node(x + 1, y + 1), self.node(x, y + 1)];
        [[a, b, c], [a, c, d]]
    }

    /// Voxel z of the ground.
    pub fn z_at(&self, at: DVec2) -> f64 {
        let place = (at - self.low.truncate()) / self.step;
        let cell = |axis: usize| (place[axis].max(0.0) as usize).min(self.cells[axis] - 1);
        let (x, y) = (cell(0), cell(1));
        let (u, v) = ((place.x - x as f64).clamp(0.0, 1.0), (place.y - y as f64).clamp(0.0, 1.0));
        let [a, b, c, d] = [self.node(x, y).z, self.node(x + 1, y).z, self.node(x + 1, y + 1).z, self.node(x, y + 1).z];
        if u >= v { a + (b - a) * u + (c - b) * v } else { a + (d - a) * v + (c - d) * u }
    }

    /// Whether a point is not above the ground.
    pub fn is_rock(&self, p: DVec3) -> bool {
        p.z >= self.range[1] || p.z + 1e-6 >= self.z_at(p.truncate())
    }

    /// The ground outside of what is cut out.
    pub fn mesh(&self, solid: &Solid) -> Mesh {
        let mut welder = Welder::default();
        for x in 0..self.cells[0] {
            for y in 0..self.cells[1] {
                for triangle in self.triangles(x, y) {
                    let mut pieces = vec![part_behind(&triangle, |p| p.z - self.high.z)];
                    for body in &solid.cut_outs {
                        pieces = pieces.into_iter().flat_map(|piece| outside(piece, body)).collect();
                    }
                    pieces.iter().for_each(|piece| welder.add(piece));
                }
            }
        }
        welder.mesh
    }

    /// The pieces of a convex polygon on a plane with this normal that are rock, and the lines where the ground cuts it.
    pub fn clip(&self, polygon: &[DVec3], normal: DVec3) -> (Vec<Vec<DVec3>>, Vec<[DVec3; 2]>) {
        if polygon.iter().all(|p| p.z >= self.range[1]) {
            return (vec![polygon.to_vec()], Vec::new());
        }
        if polygon.iter().all(|p| p.z < self.range[0]) {
            return (Vec::new(), Vec::new());
        }
        if normal.z.abs() < 1e-9 { self.clip_upright(polygon, normal) } else { self.clip_oblique(polygon) }
    }

    /// The same of an upright plane: strips of half a cell, in which the ground is a line.
    fn clip_upright(&self, polygon: &[DVec3], normal: DVec3) -> (Vec<Vec<DVec3>>, Vec<[DVec3; 2]>) {
        let along = DVec2::new(-normal.y, normal.x).normalize();
        let s_of = |p: DVec3| along.dot(p.truncate());
        let foot = polygon[0].truncate() - along * s_of(polygon[0]);
        let places = polygon.iter().map(|p| s_of(*p));
        let (first, last) = places.fold((f64::MAX, f64::MIN), |(low, high), s| (low.min(s), high.max(s)));
        let pitch = 0.5 * self.step.min_element();
        let from = (first / pitch).floor() as i64;
        let to = (last / pitch).ceil() as i64;
        let (mut pieces, mut rims) = (Vec::new(), Vec::new());
        for n in from..to {
            let (s0, s1) = ((n as f64 * pitch).max(first), ((n + 1) as f64 * pitch).min(last));
            if s1 - s0 < 1e-9 {
                continue;
            }
            let g = [s0, s1].map(|s| self.z_at(foot + along * s));
            let ground = |p: DVec3| g[0] + (g[1] - g[0]) * (s_of(p) - s0) / (s1 - s0);
            let strip = part_behind(&part_behind(polygon, |p| s0 - s_of(p)), |p| s_of(p) - s1);
            let piece = part_behind(&strip, |p| ground(p) - p.z);
            if piece.len() < 3 {
                continue;
            }
            for m in 0..piece.len() {
                let ends = [piece[m], piece[(m + 1) % piece.len()]];
                if ends.iter().all(|p| (p.z - ground(*p)).abs() < 1e-7) && (s_of(ends[1]) - s_of(ends[0])).abs() > 1e-9
                {
                    rims.push(ends);
                }
            }
            pieces.push(piece);
        }
        (pieces, rims)
    }

    /// The same of any other plane: its parts over each triangle of the ground.
    fn clip_oblique(&self, polygon: &[DVec3]) -> (Vec<Vec<DVec3>>, Vec<[DVec3; 2]>) {
        let start = (DVec3::MAX, DVec3::MIN);
        let (low, high) = polygon.iter().fold(start, |(low, high), p| (low.min(*p), high.max(*p)));
        let cell = |p: DVec3, axis: usize| ((p[axis] - self.low[axis]) / self.step[axis]).max(0.0) as usize;
        let (mut pieces, mut rims) = (Vec::new(), Vec::new());
        for x in cell(low, 0)..=cell(high, 0).min(self.cells[0] - 1) {
            for y in cell(low, 1)..=cell(high, 1).min(self.cells[1] - 1) {
                for [a, b, c] in self.triangles(x, y) {
                    let mut part = polygon.to_vec();
                    for (p, q) in [(a, b), (b, c), (c, a)] {
                        let (from, edge) = (p.truncate(), (q - p).truncate());
                        part = part_behind(&part, |r| -edge.perp_dot(r.truncate() - from));
                    }
                    let normal = (b - a).cross(c - a);
                    let ground = |p: DVec3| a.z - normal.truncate().dot((p - a).truncate()) / normal.z;
                    let piece = part_behind(&part, |p| ground(p) - p.z);
                    if piece.len() < 3 {
                        continue;
                    }
                    for m in 0..piece.len() {
                        let ends = [piece[m], piece[(m + 1) % piece.len()]];
                        if ends.iter().all(|p| (p.z - ground(*p)).abs() < 1e-7) {
                            rims.push(ends);
                        }
                    }
                    pieces.push(piece);
                }
            }
        }
        (pieces, rims)
    }

    /// A point over the highest ground within a step: where the upper edge of a scarp is seen from both sides.
    fn upper(&self, p: DVec3) -> DVec3 {
        let around = (0..9).map(|n| DVec2::new(f64::from(n % 3 - 1), f64::from(n / 3 - 1)) * self.step);
        let xy = p.truncate();
        let inside = |at: DVec2| at.clamp(self.low.truncate(), self.high.truncate());
        xy.extend(around.map(|off| self.z_at(inside(xy + off))).fold(p.z, f64::min))
    }

    /// The lines in which faults cut the ground outside of what is cut out.
    pub fn fault_traces(&self, mesh: &Mesh, model: &StructuralModel) -> Vec<[DVec3; 2]> {
        let faults = model.faults();
        let traces = mesh.triangles.par_iter().flat_map_iter(|triangle| {
            let corners = triangle.map(|n| self.upper(mesh.points[n as usize]));
            (0..faults.surfaces().len()).filter_map(move |fault| {
                let side = corners.map(|p| f64::from(faults.side(fault, p.as_vec3())));
                let cut = |n: usize, m: usize| {
                    let crosses = (side[n] >= 0.0) != (side[m] >= 0.0);
                    crosses.then(|| corners[n].lerp(corners[m], side[n] / (side[n] - side[m])))
                };
                let cuts: Vec<DVec3> = [cut(0, 1), cut(1, 2), cut(2, 0)].into_iter().flatten().collect();
                let ends: [DVec3; 2] = cuts.try_into().ok()?;
                let middle = (ends[0] + ends[1]) * 0.5;
                faults.is_real(fault, middle.as_vec3()).then_some(ends)
            })
        });
        traces.collect()
    }
}

/// The triangles of a fan, for what asks for a mesh of one polygon.
pub(crate) fn mesh_of(polygons: &[Vec<DVec3>]) -> Mesh {
    let mut welder = Welder::default();
    polygons.iter().filter(|polygon| fan(polygon.len()).next().is_some()).for_each(|polygon| welder.add(polygon));
    welder.mesh
}
