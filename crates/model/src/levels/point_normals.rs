//! A surface through points with normals: a body, an overturned limb, or one horizon whose points alone would not tell
//! which of its sides is which.
//!
//! A function f is looked for on a lattice around the points that is 0 at them, falls along their normals by one metre a
//! metre, and is otherwise as straight as can be:
//!
//! ```text
//! minimise  Σ |second differences of f|²  +  v² Σ f(p)²  +  g² Σ |∇f(p) + n(p)|²
//! ```
//!
//! as I. Macêdo, J. P. Gois and L. Velho fit points and normals together ("Hermite Radial Basis Functions Implicits",
//! Computer Graphics Forum 30(1), 2011), on a lattice as [`super::series`]. Its surface f = 0 is taken near the points, by
//! tetrahedra.

use super::cut_lattice::{CutLattice, MARGIN, resampled};
use super::distance::NodeBox;
use super::least_squares::Equations;
use super::problem;
use crate::FaultNetwork;
use crate::report::{ModelError, SurfaceProblem};
use glam::{DMat3, DVec3, Vec3};
use rayon::prelude::*;
use std::collections::HashMap;
use survey::geometry::SurveyGeometry;
use survey::progress::{Cancelled, Progress};
use survey::{LevelField, TriangleMesh};

/// Nodes of the finest lattice, and coarser ones before it, each of twice the spacing of the next.
const NODES: f64 = 60_000.0;
const COARSER: u32 = 2;
/// Smallest spacing of the nodes, voxels: a body may be smaller than a few of them.
const FINEST: f64 = 0.1;
/// How much a point and its normal count beside a second difference.
const POINT_WEIGHT: f64 = 25.0;
const NORMAL_WEIGHT: f64 = 8.0;
/// Steps of the solver on each lattice, and the share of the first gradient at which it stops.
const MOST_STEPS: usize = 400;
const TOLERANCE: f64 = 1e-5;
/// Points that count, at most.
const MOST_POINTS: usize = 20_000;
/// Fewer points are no surface.
const FEWEST_POINTS: usize = 8;
/// How far around the points their lattice reaches, as a share of their extent.
const AROUND: f32 = 0.2;
/// The surface is kept as far from the nearest point, in usual distances between neighbours.
const REACH: f64 = 4.0;
/// Share of the points whose normals may point to the other side.
const CONTRADICTING: f64 = 0.1;
/// Points whose normals are compared, at most, and with how many others.
const MOST_COMPARED: usize = 1500;
const NEIGHBOURS: usize = 6;
/// Nearest that a corner lies to a node, as a share of the edge, so that no triangle loses its area.
const OFF_NODE: f32 = 0.01;

/// A point and its normal in metric space, m; the normal has length 1.
#[derive(Debug, Clone, Copy)]
struct OrientedPoint {
    at: DVec3,
    normal: DVec3,
}

/// The triangles, in world coordinates, of the surface through `points` (world coordinates) whose `normals` point out of
/// the body or towards the younger side. A normal is perpendicular to the surface in the coordinates of the points; its
/// length does not count. About 60 000 unknowns are solved for, whatever the number of points.
///
/// # Errors
/// [`ModelError::Surface`]: too few points, or normals that point to both sides; or the user cancelled.
pub fn surface_through(
    name: &str,
    points: &[DVec3],
    normals: &[DVec3],
    geometry: &SurveyGeometry,
    progress: &Progress,
) -> Result<TriangleMesh, ModelError> {
    let metric = geometry.metric_from_voxel();
    let known = oriented(points, normals, geometry);
    if known.len() < FEWEST_POINTS {
        return Err(problem(name, geometry, SurfaceProblem::FewNormals(known.len()), None));
    }
    let turned = turned(&known);
    if turned.len() as f64 > CONTRADICTING * known.len() as f64 {
        let error = SurfaceProblem::TurnedNormals { turned: turned.len(), of: known.len() };
        return Err(problem(name, geometry, error, Some(metric.inverse() * turned[0].at)));
    }
    let spacing = usual_spacing(&known);
    let fit = OrientedFit { known: &known, metric, size: geometry.size() };
    let mut field: Option<LevelField> = None;
    for level in (0..=COARSER).rev() {
        field = Some(fit.solve(f64::from(1u32 << level), field.as_ref(), progress)?);
    }
    let Some(field) = field else { return Ok(TriangleMesh::default()) };
    let fine = resampled(&field, geometry.size(), 0.5 * field.step.min_element().max(2.0), |_| true);
    let near = Near::new(&known, REACH * spacing);
    Ok(triangles(&fine, |p| near.holds(metric * p.as_dvec3()), |p| geometry.world_from_voxel(p.as_dvec3())))
}

/// Points and normals in metric space, thinned to [`MOST_POINTS`]; what has no direction is left out.
fn oriented(points: &[DVec3], normals: &[DVec3], geometry: &SurveyGeometry) -> Vec<OrientedPoint> {
    let metric = geometry.metric_from_voxel();
    // A normal is a covector: it takes the transpose of the map from voxels to the world.
    let origin = geometry.world_from_voxel(DVec3::ZERO);
    let column = |axis: DVec3| geometry.world_from_voxel(axis) - origin;
    let world = DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z));
    let to_metric = metric.inverse().transpose() * world.transpose();
    let every = points.len().div_ceil(MOST_POINTS).max(1);
    let pairs = points.iter().zip(normals).step_by(every);
    let place = |(p, n): (&DVec3, &DVec3)| {
        let normal = (to_metric * *n).try_normalize()?;
        Some(OrientedPoint { at: metric * geometry.voxel_from_world(*p), normal })
    };
    pairs.filter_map(place).filter(|q| q.at.is_finite()).collect()
}

/// The points, of at most some hundred, whose normals point to the other side than those of most neighbours beside them.
/// What lies across, as on the other side of a thin body, is not compared.
fn turned(points: &[OrientedPoint]) -> Vec<&OrientedPoint> {
    let every = points.len().div_ceil(MOST_COMPARED).max(1);
    let some: Vec<&OrientedPoint> = points.iter().step_by(every).collect();
    let is_turned = |q: &&OrientedPoint| {
        let beside = |other: &&&OrientedPoint| {
            let apart = other.at - q.at;
            let length = apart.length();
            length > 0.0 && apart.dot(q.normal).abs() < 0.5 * length && apart.dot(other.normal).abs() < 0.5 * length
        };
        let mut others: Vec<(f64, bool)> = some
            .iter()
            .filter(beside)
            .map(|other| (other.at.distance(q.at), other.normal.dot(q.normal) < 0.0))
            .collect();
        others.sort_by(|a, b| a.0.total_cmp(&b.0));
        others.truncate(NEIGHBOURS);
        2 * others.iter().filter(|(_, opposes)| *opposes).count() > others.len()
    };
    some.par_iter().copied().filter(is_turned).collect()
}

/// The median distance of a point from its nearest neighbour, m, over at most some hundred points.
fn usual_spacing(points: &[OrientedPoint]) -> f64 {
    let some: Vec<usize> = (0..points.len()).step_by(points.len().div_ceil(400).max(1)).collect();
    let nearest = |&n: &usize| {
        let others = points.iter().enumerate().filter(|(m, _)| *m != n);
        others.map(|(_, q)| q.at.distance(points[n].at)).filter(|d| *d > 0.0).fold(f64::INFINITY, f64::min)
    };
    let mut distances: Vec<f64> = some.par_iter().map(nearest).filter(|d| d.is_finite()).collect();
    distances.sort_by(f64::total_cmp);
    distances.get(distances.len() / 2).copied().unwrap_or(1.0)
}

/// What is fitted.
struct OrientedFit<'a> {
    known: &'a [OrientedPoint],
    metric: DMat3,
    size: [usize; 3],
}

impl OrientedFit<'_> {
    /// f in m on a lattice whose spacing is `coarseness` times the finest.
    fn solve(
        &self,
        coarseness: f64,
        before: Option<&LevelField>,
        progress: &Progress,
    ) -> Result<LevelField, Cancelled> {
        let voxel = self.metric.inverse();
        let nodes = self.nodes(coarseness);
        let lattice = CutLattice::of(&FaultNetwork::none(), nodes, |_, _| true);
        // In node spacings, so that a slope weighs the same on every lattice.
        let spacing = (self.metric * nodes.step.as_dvec3()).abs().max_element();
        let mut equations = Equations::default();
        lattice.add_smoothness(1.0, &mut equations);
        let high = nodes.origin + Vec3::from_array(nodes.size.map(|n| (n - 1) as f32)) * nodes.step;
        for q in self.known {
            let p = (voxel * q.at).as_vec3();
            // Outside the volume nothing is drawn.
            if p.cmplt(nodes.origin).any() || p.cmpgt(high).any() {
                continue;
            }
            equations.add(POINT_WEIGHT, lattice.value(0, p), [0.0]);
            for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                let slope = lattice.slope_at(0, p, axis * spacing, voxel);
                equations.add(NORMAL_WEIGHT, slope, [-q.normal.dot(axis)]);
            }
        }
        let guess = lattice.guess(|_, p| [before.map_or(0.0, |before| f64::from(before.value(p)) / spacing)]);
        let mut values = equations.solve(guess, TOLERANCE, MOST_STEPS, progress)?;
        values.iter_mut().for_each(|value| value[0] *= spacing);
        Ok(lattice.spread(&values, 0).swap_remove(0))
    }

    /// The nodes around the points, as far as the volume reaches.
    fn nodes(&self, coarseness: f64) -> NodeBox {
        let voxel = self.metric.inverse();
        let of = self.known.iter().map(|q| (voxel * q.at).as_vec3());
        let (low, high) = of.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(l, h), p| (l.min(p), h.max(p)));
        let around = ((high - low) * AROUND).max(Vec3::splat(2.0 * MARGIN));
        let last = Vec3::from_array(self.size.map(|n| n as f32 - 1.0)) + MARGIN;
        let low = (low - around).clamp(Vec3::splat(-MARGIN), last - 1.0);
        let high = (high + around).min(last).max(low + 1.0);
        CutLattice::nodes_between(low, high, self.metric, NODES, coarseness, FINEST)
    }
}

/// Places near points, by cells of the size of the distance.
struct Near {
    cells: HashMap<[i32; 3], Vec<DVec3>>,
    distance: f64,
}

impl Near {
    fn new(points: &[OrientedPoint], distance: f64) -> Self {
        let mut near = Self { cells: HashMap::new(), distance };
        for q in points {
            near.cells.entry(near.cell(q.at)).or_default().push(q.at);
        }
        near
    }

    fn cell(&self, p: DVec3) -> [i32; 3] {
        (p / self.distance).floor().to_array().map(|n| n as i32)
    }

    fn holds(&self, p: DVec3) -> bool {
        let [x, y, z] = self.cell(p);
        let around = (0..27).map(|n| [x + n / 9 - 1, y + n / 3 % 3 - 1, z + n % 3 - 1]);
        around.filter_map(|cell| self.cells.get(&cell)).flatten().any(|q| q.distance(p) <= self.distance)
    }
}

/// The surface on which a field is 0, where `is_wanted` holds at the middle of its triangles, as triangles through `place`.
/// Each cell is six tetrahedra around its diagonal, so that neighbours meet without gaps.
fn triangles(field: &LevelField, is_wanted: impl Fn(Vec3) -> bool, place: impl Fn(Vec3) -> DVec3) -> TriangleMesh {
    /// Corners of a cell, 4·x + 2·y + z, between which a tetrahedron of the diagonal 0–7 lies.
    const BETWEEN: [[usize; 2]; 6] = [[4, 6], [4, 5], [2, 6], [2, 3], [1, 5], [1, 3]];
    let [nx, ny, nz] = field.size;
    let mut mesh = TriangleMesh::default();
    let mut corner_of: HashMap<[usize; 2], (u32, Vec3)> = HashMap::new();
    for cell in 0..nx * ny * nz {
        let [x, y, z] = [cell / (ny * nz), cell / nz % ny, cell % nz];
        if x + 1 == nx || y + 1 == ny || z + 1 == nz {
            continue;
        }
        let node = |corner: usize| cell + (corner >> 2) * ny * nz + (corner >> 1 & 1) * nz + (corner & 1);
        let inside = |corner: usize| field.values[node(corner)] >= 0.0;
        if (1..8).all(|corner| inside(corner) == inside(0)) {
            continue;
        }
        for [a, b] in BETWEEN {
            let corners = [0, a, b, 7];
            let (within, without): (Vec<usize>, Vec<usize>) = corners.into_iter().partition(|&corner| inside(corner));
            let mut cut = |from: usize, to: usize| {
                let edge = [node(from).min(node(to)), node(from).max(node(to))];
                *corner_of.entry(edge).or_insert_with(|| {
                    let [low, high] = edge.map(|node| field.values[node]);
                    let t = (low / (low - high)).clamp(OFF_NODE, 1.0 - OFF_NODE);
                    let p = field.place(edge[0]).lerp(field.place(edge[1]), t);
                    mesh.vertices.push(place(p));
                    (mesh.vertices.len() as u32 - 1, p)
                })
            };
            let found: Vec<[(u32, Vec3); 3]> = match (within[..].len(), without[..].len()) {
                (1, 3) => vec![[0, 1, 2].map(|n| cut(within[0], without[n]))],
                (3, 1) => vec![[0, 1, 2].map(|n| cut(without[0], within[n]))],
                (2, 2) => {
                    let [p, q] = [0, 1].map(|n| cut(within[0], without[n]));
                    let [r, s] = [1, 0].map(|n| cut(within[1], without[n]));
                    vec![[p, q, r], [p, r, s]]
                }
                _ => continue,
            };
            for triangle in found {
                if is_wanted((triangle[0].1 + triangle[1].1 + triangle[2].1) / 3.0) {
                    mesh.triangles.push(triangle.map(|(n, _)| n));
                }
            }
        }
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;
    use survey::VerticalUnit;
    use survey::topology::OrientedMesh;
    use synth::shapes::{RecumbentFold, world};

    fn geometry() -> SurveyGeometry {
        SurveyGeometry::regular([41, 33, 41], 25.0, 20.0, VerticalUnit::Metres)
    }

    /// Points spread evenly over a ball, in m, and their directions.
    fn ball(count: usize) -> Vec<(DVec3, DVec3)> {
        let direction = |n: usize| {
            let z = 1.0 - 2.0 * (n as f64 + 0.5) / count as f64;
            let turn = n as f64 * 2.399_963;
            DVec3::new(turn.cos() * (1.0 - z * z).sqrt(), turn.sin() * (1.0 - z * z).sqrt(), z)
        };
        let middle = DVec3::new(500.0, 400.0, 400.0);
        (0..count).map(direction).map(|n| (middle + 250.0 * n, n)).collect()
    }

    fn through(points: &[(DVec3, DVec3)]) -> Result<TriangleMesh, ModelError> {
        let geometry = geometry();
        let origin = world(&geometry, DVec3::ZERO);
        let (places, normals): (Vec<DVec3>, Vec<DVec3>) =
            points.iter().map(|&(p, n)| (world(&geometry, p), world(&geometry, n) - origin)).unzip();
        surface_through("ball", &places, &normals, &geometry, &Progress::silent())
    }

    #[test]
    fn sixty_points_of_a_ball_are_a_body_of_its_size() {
        let geometry = geometry();
        for (count, tolerance) in [(60, 0.02), (400, 0.01)] {
            let mesh = through(&ball(count)).unwrap();
            let metric = geometry.metric_from_voxel();
            let vertices: Vec<DVec3> = mesh.vertices.iter().map(|&v| metric * geometry.voxel_from_world(v)).collect();
            let middle = metric * geometry.voxel_from_world(world(&geometry, DVec3::new(500.0, 400.0, 400.0)));
            let off = vertices.iter().map(|v| (v.distance(middle) / 250.0 - 1.0).abs()).fold(0.0, f64::max);
            assert!(off < tolerance, "{count}: {off}");
            let solid = OrientedMesh::of(&TriangleMesh { vertices, triangles: mesh.triangles }, 1e-3).unwrap();
            let volume = solid.volume() / (4.0 / 3.0 * std::f64::consts::PI * 250f64.powi(3));
            assert!(solid.is_closed() && (volume - 1.0).abs() < 3.0 * tolerance, "{count}: {volume}");
        }
    }

    #[test]
    fn normals_that_point_to_both_sides_are_refused() {
        let mut points = ball(200);
        points.iter_mut().step_by(3).for_each(|(_, normal)| *normal = -*normal);
        let error = through(&points).map(|_| ()).unwrap_err().to_string();
        assert!(error.contains("normals") && error.contains("inline"), "{error}");
        assert!(through(&ball(6)).map(|_| ()).unwrap_err().to_string().contains("points"));
    }

    /// Inward normals are as good: what a closed surface encloses decides its sides.
    #[test]
    fn normals_that_all_point_inwards_make_the_same_body() {
        let turned: Vec<_> = ball(100).into_iter().map(|(p, n)| (p, -n)).collect();
        let (a, b) = (through(&ball(100)).unwrap(), through(&turned).unwrap());
        assert_eq!(a.triangles.len(), b.triangles.len());
    }

    #[test]
    fn an_overturned_limb_keeps_its_three_depths() {
        let geometry = geometry();
        let fold = RecumbentFold::fitting(&geometry);
        let mut points = Vec::new();
        for n in 0..300 {
            let (y, z) = ((n as f64 * 0.754_877).fract() * 800.0, (n as f64 * 0.569_840).fract() * 800.0);
            let p = DVec3::new(fold.x_of(50.0, z), y, z);
            if (0.0..1000.0).contains(&p.x) {
                points.push((p, -fold.gradient(p)));
            }
        }
        let mesh = through(&points).unwrap();
        let metric = geometry.metric_from_voxel();
        let origin = metric * geometry.voxel_from_world(world(&geometry, DVec3::ZERO));
        let far = mesh.vertices.iter().filter(|&&v| {
            let p = metric * geometry.voxel_from_world(v) - origin;
            let inside = p.cmpgt(DVec3::splat(40.0)).all() && p.cmplt(DVec3::new(960.0, 760.0, 760.0)).all();
            inside && ((fold.age(p) - 50.0) / fold.gradient(p).length()).abs() > 20.0
        });
        let (far, all) = (far.count(), mesh.vertices.len());
        assert!(all > 1000 && far * 50 < all, "{far} of {all}");
        let share = OrientedMesh::of(&mesh, 1e-3).unwrap().overturned_share();
        // The limb covers 88 m of 1176 m.
        assert!((share - 0.075).abs() < 0.02, "{share}");
    }
}
