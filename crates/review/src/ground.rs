//! The ground as a mesh: heights at the nodes of a lattice of about a voxel, cut by whatever is cut out of the block.
//!
//! The ground is one surface in each fault block, and the fault itself where it stands bare. Each place of the map belongs
//! to one such part; a triangle whose corners belong to several is cut where they meet, found by halving, and what lies
//! between two parts is a scarp: as steep as the fault, upright where one block overhangs the other. Sixteen cells of one
//! part that are as good as flat are one piece. Pieces know in which cut-outs they lie, so that one mesh serves for any
//! of them. Faces are clipped by the same heights ([`Ground::clip`]), so that they
//! meet the ground without a gap.

use crate::model::Mesh;
use crate::polygon::{Welder, fan, split};
use glam::{DVec2, DVec3, Vec3};
use model::StructuralModel;
use rayon::prelude::*;
use render::ground::Relief;
use render::visible::Ray;
use render::{Ground as GroundStyle, Scene};
use std::collections::BTreeMap;
use std::ops::Deref;
use survey::SurveyGeometry;
use survey::block::{Body, part_behind};

/// Cells along each side of a piece that is as good as flat.
const PIECE: usize = 4;
/// How far from the heights such a piece may be, samples.
const FLAT: f64 = 0.3;
/// Smallest drop between two parts at one place that is an overhang, samples.
const DROP: f64 = 0.02;
/// Steps in which the foot of a scarp is looked for under an overhang, voxels, and how many of them at most.
const UNDER: (f64, usize) = (0.25, 24);
/// Halvings with which the end of a part is found between two nodes.
const HALVINGS: usize = 12;
/// How far above a point of the ground the block is asked for, samples: over bare fault it is the other one.
const ABOVE: f32 = 0.02;
/// The part where rock reaches the top of the block.
const TOP: u32 = u32::MAX;
/// The part without ground in the box.
const NONE: u32 = u32::MAX - 1;

/// What lies at a place of the map.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Spot {
    /// Voxel z.
    z: f64,
    /// Its fault block, doubled; one more where the fault stands bare.
    part: u32,
}

/// A place of the map with what lies there.
type Node = (DVec2, Spot);

/// Heights of the ground over the roaming box.
pub(crate) struct Heights {
    relief: Relief,
    low: DVec3,
    high: DVec3,
    cells: [usize; 2],
    step: DVec2,
    /// What lies at each node, `[x][y]`; its z is below the box where there is no ground in it.
    spots: Vec<Spot>,
    /// Smallest and largest z.
    range: [f64; 2],
}

/// The ground of a model.
#[derive(Clone, Copy)]
pub(crate) struct Ground<'a> {
    model: &'a StructuralModel,
    heights: &'a Heights,
}

impl Deref for Ground<'_> {
    type Target = Heights;

    fn deref(&self) -> &Heights {
        self.heights
    }
}

/// Pieces of the ground, each with the fault whose plane it is, and the lines between its parts.
type Pieces = (Vec<(Option<usize>, Vec<DVec3>)>, Vec<[DVec3; 2]>);

/// The part of the ground in certain cut-outs.
pub(crate) struct GroundPart {
    /// Bit n stands for cut-out n: the part is there where none of them is.
    pub cuts: u32,
    /// The fault whose bare plane it is; `None` of the relief.
    pub fault: Option<usize>,
    /// Its triangles.
    pub mesh: Mesh,
    /// Lines of faults on the relief.
    pub lines: Vec<[DVec3; 2]>,
    /// Lines at which horizons and bodies come to the surface.
    pub contacts: Vec<[DVec3; 2]>,
}

/// A part of the ground while it is put together: triangles, lines of faults and of contacts.
#[derive(Default)]
struct Gathered {
    welder: Welder,
    lines: [Vec<[DVec3; 2]>; 2],
}

impl Heights {
    /// The heights of a scene, with at most so many cells along an axis.
    pub(crate) fn of(
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
        let empty = Self { relief, low, high, cells, step, spots: Vec::new(), range: [low.z, high.z] };
        let place = |n: usize| empty.place(n / (cells[1] + 1), n % (cells[1] + 1));
        let count = (cells[0] + 1) * (cells[1] + 1);
        let spots: Vec<Spot> = (0..count).into_par_iter().map(|n| empty.on(model).spot(place(n))).collect();
        let all = || spots.iter().map(|spot| spot.z);
        let range = [all().fold(f64::MAX, f64::min), all().fold(f64::MIN, f64::max)];
        Self { spots, range, ..empty }
    }

    /// The ground of the model that they were made of.
    pub(crate) fn on<'a>(&'a self, model: &'a StructuralModel) -> Ground<'a> {
        Ground { model, heights: self }
    }

    fn place(&self, x: usize, y: usize) -> DVec2 {
        self.low.truncate() + DVec2::new(x as f64, y as f64) * self.step
    }

    fn node(&self, x: usize, y: usize) -> Node {
        (self.place(x, y), self.spots[x * (self.cells[1] + 1) + y])
    }

    /// The triangles of a cell.
    fn triangles(&self, x: usize, y: usize) -> [[Node; 3]; 2] {
        let [a, b, c, d] = [self.node(x, y), self.node(x + 1, y), self.node(x + 1, y + 1), self.node(x, y + 1)];
        [[a, b, c], [a, c, d]]
    }
}

impl Ground<'_> {
    /// What lies at a place of the map.
    fn spot(&self, at: DVec2) -> Spot {
        let from = at.extend(self.low.z).as_vec3();
        if !self.relief.is_air(self.model, from) {
            return Spot { z: self.low.z, part: TOP };
        }
        let ray = Ray { origin: from, direction: Vec3::Z };
        match self.relief.march(self.model, &ray, 0.0, (self.high.z - self.low.z) as f32) {
            Some(hit) => {
                let above = self.model.block_at(hit.point - Vec3::Z * ABOVE);
                let is_bare = u32::from(above != hit.region.block);
                Spot { z: f64::from(hit.point.z), part: 2 * u32::from(hit.region.block) + is_bare }
            }
            None => Spot { z: self.high.z + 1.0, part: NONE },
        }
    }

    /// Voxel z of the ground.
    pub(crate) fn z_at(&self, at: DVec2) -> f64 {
        let place = (at - self.low.truncate()) / self.step;
        let cell = |axis: usize| (place[axis].max(0.0) as usize).min(self.cells[axis] - 1);
        let (x, y) = (cell(0), cell(1));
        let nodes = [self.node(x, y), self.node(x + 1, y), self.node(x + 1, y + 1), self.node(x, y + 1)];
        if nodes.iter().any(|(_, spot)| spot.part != nodes[0].1.part) {
            let inside = at.clamp(self.low.truncate(), self.high.truncate());
            return self.spot(inside).z;
        }
        let [a, b, c, d] = nodes.map(|(_, spot)| spot.z);
        let (u, v) = ((place.x - x as f64).clamp(0.0, 1.0), (place.y - y as f64).clamp(0.0, 1.0));
        if u >= v { a + (b - a) * u + (c - b) * v } else { a + (d - a) * v + (c - d) * u }
    }

    /// Whether a point is not above the ground.
    pub(crate) fn is_rock(&self, p: DVec3) -> bool {
        p.z >= self.range[1] || p.z + 1e-6 >= self.z_at(p.truncate())
    }

    /// Where the parts of two places end towards each other: the last point of the first part, the first of the second.
    fn ends(&self, a: Node, b: Node) -> [DVec3; 2] {
        // The same for both triangles at an edge.
        if (a.0.x, a.0.y) > (b.0.x, b.0.y) {
            let [first, last] = self.ends(b, a);
            return [last, first];
        }
        let end = |from: Node, to: Node| {
            let (mut inside, mut outside, mut z) = (0.0, 1.0, from.1.z);
            for _ in 0..HALVINGS {
                let middle = 0.5 * (inside + outside);
                let spot = self.spot(from.0.lerp(to.0, middle));
                if spot.part == from.1.part { (inside, z) = (middle, spot.z) } else { outside = middle }
            }
            (inside, z)
        };
        let ((first, z), (last, w)) = (end(a, b), end(b, a));
        // Of parts that alternate, only the outer ends are known.
        let (first, last) = if first + last > 1.0 { (0.5, 0.5) } else { (first, 1.0 - last) };
        [a.0.lerp(b.0, first).extend(z), a.0.lerp(b.0, last).extend(w)]
    }

    /// The edges of the scarp between two places: those of [`Self::ends`], the lower one moved under an overhang as far as
    /// its block goes.
    fn scarp(&self, [a, b]: [DVec3; 2]) -> [DVec3; 2] {
        let off = (b - a).truncate();
        let is_drop = (a.z - b.z).abs() > DROP && off.length() < 0.05 * self.step.min_element();
        if !is_drop || a.z.max(b.z) > self.high.z {
            return [a, b];
        }
        let lower = if a.z < b.z { b } else { a };
        let Some(fault) = self.fault_at((a + b) * 0.5) else { return [a, b] };
        // Straight to the fault, whichever way the edge runs, so that the feet of neighbours lie beside each other.
        let across = self.model.faults().surfaces()[fault].frame_from_voxel.row(2).truncate();
        let side = f64::from(self.model.faults().side(fault, lower.as_vec3()));
        let towards = -across.normalize_or_zero() * side.signum();
        let block_at = |far: f64| {
            let p = lower.truncate() + towards * far;
            self.model.block_at(p.extend(lower.z - DROP).as_vec3())
        };
        let own = block_at(0.0);
        let (step, most) = UNDER;
        let Some(beyond) = (1..=most).map(|n| n as f64 * step).find(|far| block_at(*far) != own) else {
            return [a, b];
        };
        let (mut inside, mut outside) = (beyond - step, beyond);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (inside + outside);
            if block_at(middle) == own { inside = middle } else { outside = middle }
        }
        let foot = lower + (towards * inside).extend(0.0);
        if a.z < b.z { [a, foot] } else { [foot, b] }
    }

    /// The pieces of a triangle, of one part each, and the scarps between them with their lines.
    fn cut(&self, corners: [Node; 3], (pieces, lines): &mut Pieces) {
        let point = |(at, spot): Node| at.extend(spot.z);
        let parts = corners.map(|(_, spot)| spot.part);
        let of = |part: u32, at: DVec3| if part < NONE && part % 2 == 1 { self.fault_at(at) } else { None };
        if parts[0] == parts[1] && parts[1] == parts[2] {
            let corners = corners.map(point);
            pieces.push((of(parts[0], corners[0]), corners.to_vec()));
            return;
        }
        if let Some(lone) = (0..3).find(|n| parts[(n + 1) % 3] == parts[(n + 2) % 3]) {
            let [a, b, c] = [0, 1, 2].map(|n| corners[(lone + n) % 3]);
            let [ends_b, ends_c] = [self.ends(a, b), self.ends(a, c)];
            let ([ab, ba], [ac, ca]) = (ends_b, ends_c);
            let ([up_b, foot_b], [up_c, foot_c]) = (self.scarp(ends_b), self.scarp(ends_c));
            let fault = self.fault_at((ab + ca) * 0.5);
            let [own, others] = [(a, ab), (b, ba)].map(|((_, spot), at)| of(spot.part, at));
            pieces.extend([(own, vec![point(a), ab, ac]), (own, vec![ab, up_b, up_c, ac])]);
            pieces.extend([(fault, vec![up_b, foot_b, foot_c]), (fault, vec![up_b, foot_c, up_c])]);
            pieces.push((others, vec![foot_b, ba, ca, foot_c]));
            pieces.extend([(others, vec![ba, point(b), point(c)]), (others, vec![ba, point(c), ca])]);
            lines.extend([[up_b, up_c], [foot_b, foot_c]]);
            return;
        }
        let mut middle = Vec::new();
        for n in 0..3 {
            let [before, own, next] = [2, 0, 1].map(|m| corners[(n + m) % 3]);
            let ([towards, beyond], [back, _]) = (self.ends(own, next), self.ends(own, before));
            pieces.push((of(own.1.part, towards), vec![point(own), towards, back]));
            lines.push([towards, back]);
            middle.extend([towards, beyond]);
        }
        let fault = self.fault_at(middle[0]);
        pieces.extend(fan(middle.len()).map(|triangle| (fault, triangle.map(|n| middle[n]).to_vec())));
    }

    /// The fault nearest to a point.
    fn fault_at(&self, p: DVec3) -> Option<usize> {
        let faults = self.model.faults();
        let off = |fault: &usize| faults.side(*fault, p.as_vec3()).abs();
        (0..faults.surfaces().len()).min_by(|f, g| off(f).total_cmp(&off(g)))
    }

    /// How bright the bare plane of a fault is beside level ground, seen from a direction in voxels.
    pub(crate) fn shade(&self, fault: usize, towards_camera: DVec3) -> f32 {
        let Some(surface) = self.model.faults().surfaces().get(fault) else { return 1.0 };
        let normal = surface.frame_from_voxel.row(2).as_vec3();
        self.relief.shade(if normal.dot(towards_camera.as_vec3()) < 0.0 { -normal } else { normal })
    }

    /// Whether [`PIECE`] by `PIECE` cells, or what of them there is, are as good as flat.
    fn is_flat(&self, [x, y]: [usize; 2]) -> bool {
        if x + PIECE > self.cells[0] || y + PIECE > self.cells[1] {
            return false;
        }
        let at = |u: usize, v: usize| self.node(x + u, y + v).1;
        let (first, middle) = (at(0, 0), at(PIECE / 2, PIECE / 2).z);
        let corners = [at(0, 0), at(PIECE, 0), at(PIECE, PIECE), at(0, PIECE)].map(|spot| spot.z);
        (0..=PIECE).all(|u| {
            (0..=PIECE).all(|v| {
                let spot = at(u, v);
                // Height of the four triangles around the middle.
                let half = PIECE as f64 / 2.0;
                let (s, t) = (u as f64 / half - 1.0, v as f64 / half - 1.0);
                let side = |from: f64, to: f64, along: f64, out: f64| {
                    middle * (1.0 - out) + (from + (to - from) * 0.5 * (along / out.max(1e-9) + 1.0)) * out
                };
                let [a, b, c, d] = corners;
                let flat = match s.abs() >= t.abs() {
                    true if s < 0.0 => side(a, d, t, -s),
                    true => side(b, c, t, s),
                    false if t < 0.0 => side(a, b, s, -t),
                    false => side(d, c, s, t),
                };
                spot.part == first.part && (spot.z - flat).abs() <= FLAT
            })
        })
    }

    /// A flat piece: triangles around its middle, with all nodes of those sides whose neighbour is not flat.
    fn piece(&self, [x, y]: [usize; 2], is_flat: impl Fn(isize, isize) -> bool, pieces: &mut Vec<Vec<DVec3>>) {
        let point = |u: usize, v: usize| {
            let (at, spot) = self.node(x + u, y + v);
            at.extend(spot.z)
        };
        let mut rim = Vec::new();
        let last = PIECE;
        // Beside which a side lies, where it begins, and where it runs.
        let beside = [(0, -1), (1, 0), (0, 1), (-1, 0)];
        let begins = [[0, 0], [last, 0], [last, last], [0, last]];
        let runs: [[isize; 2]; 4] = [[1, 0], [0, 1], [-1, 0], [0, -1]];
        for (((dx, dy), [u, v]), [du, dv]) in beside.into_iter().zip(begins).zip(runs) {
            let stride = if is_flat(dx, dy) { PIECE } else { 1 };
            rim.extend((0..PIECE).step_by(stride).map(|n| {
                let along = |from: usize, by: isize| from.saturating_add_signed(by * n as isize);
                point(along(u, du), along(v, dv))
            }));
        }
        let middle = point(PIECE / 2, PIECE / 2);
        pieces.extend((0..rim.len()).map(|n| vec![middle, rim[n], rim[(n + 1) % rim.len()]]));
    }

    /// The ground, by the cut-outs in which it lies, each of some bodies.
    pub(crate) fn parts(&self, cuts: &[Vec<Body>]) -> Vec<GroundPart> {
        let many = self.cells.map(|count| count.div_ceil(PIECE));
        let flat: Vec<bool> = (0..many[0] * many[1])
            .into_par_iter()
            .map(|n| self.is_flat([n / many[1] * PIECE, n % many[1] * PIECE]))
            .collect();
        let made = (0..many[0] * many[1]).into_par_iter().map(|n| {
            let (pieces, mut lines) = self.pieces([n / many[1], n % many[1]], many, &flat);
            let mut left = Vec::new();
            for (fault, piece) in pieces {
                let within = part_behind(&piece, |p| p.z - self.high.z);
                left.extend(by_cuts(within, cuts).into_iter().map(|(mask, piece)| (mask, fault, piece)));
            }
            lines.retain(|ends| self.is_fault(*ends));
            (left, lines, self.contacts([n / many[1], n % many[1]]))
        });
        let mut parts: BTreeMap<(u32, Option<usize>), Gathered> = BTreeMap::new();
        for (pieces, lines, contacts) in made.collect::<Vec<_>>() {
            for (mask, fault, piece) in pieces {
                parts.entry((mask, fault)).or_default().welder.add(&piece);
            }
            let lines = lines.into_iter().map(|ends| (0, ends));
            for (kind, ends) in lines.chain(contacts.into_iter().map(|ends| (1, ends))) {
                let middle = ((ends[0] + ends[1]) * 0.5).as_vec3();
                let holds = |bodies: &Vec<Body>| bodies.iter().any(|body| body.holds(middle));
                let mask = cuts.iter().enumerate().map(|(n, cut)| u32::from(holds(cut)) << n).sum();
                parts.entry((mask, None)).or_default().lines[kind].push(ends);
            }
        }
        let part = |((cuts, fault), gathered): (_, Gathered)| {
            let [lines, contacts] = gathered.lines;
            GroundPart { cuts, fault, mesh: gathered.welder.mesh, lines, contacts }
        };
        parts.into_iter().map(part).collect()
    }

    /// The lines at which older horizons come to the surface in a square of [`PIECE`] cells.
    fn contacts(&self, [i, j]: [usize; 2]) -> Vec<[DVec3; 2]> {
        let mut found = Vec::new();
        let cells = (0..PIECE * PIECE).map(|n| [i * PIECE + n / PIECE, j * PIECE + n % PIECE]);
        for [x, y] in cells.filter(|[x, y]| *x < self.cells[0] && *y < self.cells[1]) {
            for corners in self.triangles(x, y) {
                let part = corners[0].1.part;
                if part >= NONE || corners.iter().any(|(_, spot)| spot.part != part) {
                    continue;
                }
                let block = (part / 2) as u16;
                let surface = |at: DVec2| at.extend(self.model.horizon_z(0, block, at.x as f32, at.y as f32).into());
                let corners = corners.map(|(at, _)| surface(at));
                for horizon in 1..self.model.stratigraphy().horizons.len() {
                    let off = corners.map(|p| f64::from(self.model.offset(horizon, block, p.as_vec3())));
                    let ends: Vec<DVec3> = (0..3)
                        .filter_map(|n| {
                            let [a, b] = [off[n], off[(n + 1) % 3]];
                            let cut = (a >= 0.0) != (b >= 0.0);
                            cut.then(|| surface(corners[n].lerp(corners[(n + 1) % 3], a / (a - b)).truncate()))
                        })
                        .collect();
                    let [from, to] = ends[..] else { continue };
                    let middle = (from + to) * 0.5;
                    let is_inside = middle.z >= self.low.z && middle.z <= self.high.z;
                    if is_inside && self.model.crops_out_at(horizon, middle.as_vec3(), block) {
                        found.push([from, to]);
                    }
                }
            }
        }
        found
    }

    /// What there is in one of the squares of [`PIECE`] cells, of so `many` along each axis.
    fn pieces(&self, [i, j]: [usize; 2], many: [usize; 2], flat: &[bool]) -> Pieces {
        let mut all: Pieces = (Vec::new(), Vec::new());
        if flat[i * many[1] + j] {
            let beside = |di: isize, dj: isize| {
                let (i, j) = (i.checked_add_signed(di), j.checked_add_signed(dj));
                let inside = i.zip(j).filter(|(i, j)| *i < many[0] && *j < many[1]);
                inside.is_some_and(|(i, j)| flat[i * many[1] + j])
            };
            let mut pieces = Vec::new();
            self.piece([i * PIECE, j * PIECE], beside, &mut pieces);
            all.0.extend(pieces.into_iter().map(|piece| (None, piece)));
            return all;
        }
        for x in i * PIECE..((i + 1) * PIECE).min(self.cells[0]) {
            for y in j * PIECE..((j + 1) * PIECE).min(self.cells[1]) {
                self.triangles(x, y).into_iter().for_each(|triangle| self.cut(triangle, &mut all));
            }
        }
        all
    }

    /// Whether a line between two parts lies on a fault that is really there.
    fn is_fault(&self, [a, b]: [DVec3; 2]) -> bool {
        let middle = (a + b) * 0.5;
        let is_real = |fault: usize| self.model.faults().is_real(fault, middle.as_vec3());
        let inside = (middle + DVec3::Z * f64::from(ABOVE)).as_vec3();
        let is_pierced = self.model.is_pierced_at(inside, self.model.block_at(inside));
        let is_line = a.distance_squared(b) > 1e-12 && a.z.max(b.z) <= self.high.z && !is_pierced;
        is_line && self.fault_at(middle).is_some_and(is_real)
    }

    /// The pieces of a convex polygon on a plane with this normal that are rock, and the lines where the ground cuts it.
    pub(crate) fn clip(&self, polygon: &[DVec3], normal: DVec3) -> (Vec<Vec<DVec3>>, Vec<[DVec3; 2]>) {
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
        let inside = |at: DVec2| at.clamp(self.low.truncate(), self.high.truncate());
        let node = |s: f64| {
            let at = inside(foot + along * s);
            (at, self.spot(at))
        };
        let places = (from..=to).map(|n| (n as f64 * pitch).clamp(first, last));
        let nodes: Vec<(f64, Node)> = places.map(|s| (s, node(s))).collect();
        let (mut pieces, mut rims) = (Vec::new(), Vec::new());
        let mut strip = |[s0, s1]: [f64; 2], [g0, g1]: [f64; 2]| {
            if s1 - s0 < 1e-9 {
                return;
            }
            let ground = |p: DVec3| g0 + (g1 - g0) * (s_of(p) - s0) / (s1 - s0);
            let strip = part_behind(&part_behind(polygon, |p| s0 - s_of(p)), |p| s_of(p) - s1);
            let piece = part_behind(&strip, |p| ground(p) - p.z);
            if piece.len() < 3 {
                return;
            }
            for m in 0..piece.len() {
                let ends = [piece[m], piece[(m + 1) % piece.len()]];
                if ends.iter().all(|p| (p.z - ground(*p)).abs() < 1e-7) && (s_of(ends[1]) - s_of(ends[0])).abs() > 1e-9
                {
                    rims.push(ends);
                }
            }
            pieces.push(piece);
        };
        for pair in nodes.windows(2) {
            let [(s0, a), (s1, b)] = [pair[0], pair[1]];
            if a.1.part == b.1.part {
                strip([s0, s1], [a.1.z, b.1.z]);
            } else {
                let [end, begin] = self.ends(a, b);
                let [s, t] = [end, begin].map(|p| s_of(p).clamp(s0, s1));
                strip([s0, s], [a.1.z, end.z]);
                strip([s, t], [end.z, begin.z]);
                strip([t, s1], [begin.z, b.1.z]);
            }
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
                for triangle in self.triangles(x, y) {
                    let [a, b, c] = triangle.map(|(at, spot)| at.extend(spot.z));
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
}

/// The pieces of a convex polygon with the cut-outs in which each lies.
fn by_cuts(polygon: Vec<DVec3>, cuts: &[Vec<Body>]) -> Vec<(u32, Vec<DVec3>)> {
    let mut pieces = vec![(0, polygon)];
    for (n, bodies) in cuts.iter().enumerate() {
        let mut next = Vec::new();
        for (mask, piece) in pieces {
            let mut left = vec![piece];
            for body in bodies {
                let mut beyond = Vec::new();
                for piece in left {
                    let (outside, inside) = split(piece, body);
                    beyond.extend(outside);
                    next.extend(inside.map(|inside| (mask | 1 << n, inside)));
                }
                left = beyond;
            }
            next.extend(left.into_iter().map(|piece| (mask, piece)));
        }
        pieces = next;
    }
    pieces
}

/// The triangles of a fan, for what asks for a mesh of one polygon.
pub(crate) fn mesh_of(polygons: &[Vec<DVec3>]) -> Mesh {
    let mut welder = Welder::default();
    polygons.iter().filter(|polygon| fan(polygon.len()).next().is_some()).for_each(|polygon| welder.add(polygon));
    welder.mesh
}

#[cfg(test)]
mod tests {
    use super::*;
    use model::ModelSettings;
    use survey::{Progress, VerticalUnit};
    use synth::closed_form::ClosedForm;

    /// A bed that dips along x meets a level erosion surface in a line along y.
    #[test]
    fn a_bed_that_is_cut_off_has_a_line_on_the_ground() {
        let geometry = SurveyGeometry::regular([31, 21, 41], 10.0, 10.0, VerticalUnit::Metres);
        let closed = ClosedForm::unconformity(&geometry, 12.0, &[12.0], 20.0, 0.0);
        let (strata, settings, quiet) = (&closed.stratigraphy, ModelSettings::default(), Progress::silent());
        let model = StructuralModel::build(&geometry, strata, &closed.horizons, &[], &settings, &quiet).unwrap();
        let scene = Scene { ground: Some(GroundStyle::default()), ..Scene::default() };
        let heights = Heights::of((&GroundStyle::default(), &scene), &geometry, &model, 256);
        let parts = heights.on(&model).parts(&[]);
        let contacts: Vec<[DVec3; 2]> = parts.iter().flat_map(|part| part.contacts.clone()).collect();
        let length: f64 = contacts.iter().map(|[a, b]| a.distance(*b)).sum();
        assert!((length - 20.0).abs() < 0.5, "{length}");
        let first = contacts[0][0].x;
        assert!(contacts.iter().flatten().all(|p| (p.x - first).abs() < 0.1 && (p.z - 12.0).abs() < 0.1));
    }
}
