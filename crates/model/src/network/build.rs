//! From a triangle mesh to a fault surface: a plane, exact rasterisation over it, continuation.

use super::facing;
use super::outline::FaultPatch;
use super::smoothing::{self, Smooth};
use super::surface::FaultSurface;
use crate::extension::Extension;
use crate::report::ModelError;
use glam::{DMat3, DVec2, DVec3};
use survey::fault::Fault;
use survey::geometry::SurveyGeometry;
use survey::height_field::HeightField;

/// Most nodes of a fault's grid; beyond, the spacing grows. 2¹⁸ nodes are 1 MiB a grid, of which there are
/// two.
const MOST_NODES: f64 = 262_144.0;
/// Voxels around the volume that the grid covers; farther out the border cells continue linearly.
const MARGIN_VOXELS: f64 = 8.0;
/// Two sheets of one fault over one node of its plane must be so many cells apart to count as a fold.
const FOLD_CELLS: f64 = 1.0;

/// A triangle stands on a plane where the cosine between their normals is smaller.
const STANDING: f64 = 0.2;

/// A fault surface together with the mesh it was made from, in the surface's frame.
pub(super) struct Built {
    pub surface: FaultSurface,
    pub patch: FaultPatch,
    /// Vertices in use, voxel space.
    pub vertices: Vec<DVec3>,
    /// How far what was drawn lies off the surface where it folds and was smoothed, m: nine tenths of it lie nearer.
    pub off_m: Option<f64>,
}

/// Builds the surface of `fault`, continued over its whole grid; its extent is still that of its nodes.
pub(super) fn build(geometry: &SurveyGeometry, fault: &Fault) -> Result<Built, ModelError> {
    let (mut built, edge_m) = drawn(geometry, fault)?;
    let HeightField { size, z, .. } = &mut built.surface.surface;
    if z.iter().all(|w| w.is_nan()) {
        // Smaller than a cell, or beside the grid: its plane is all there is.
        z.fill(0.0);
    }
    let spacing_m = built.surface.spacing_m;
    let radius = (1.5 * edge_m / spacing_m).clamp(10.0, 40.0) as f32;
    let extension = Extension { radius, noise: 0.25 * spacing_m as f32, slope: [0.0; 2] };
    extension.extend(*size, z);
    Ok(built)
}

/// The surface of `fault` where it was drawn, NaN beyond, with an extent of one cell there and of none beyond; and the
/// usual length of an edge of its triangles, m.
///
/// It lies over its best-fit plane. Where it folds over that, or stands on it, it lies over the plane that sees most of it
/// from one side; where it folds over both, it is smoothed, if it is not far from a smooth surface ([`smoothing`]).
pub(super) fn drawn(geometry: &SurveyGeometry, fault: &Fault) -> Result<(Built, f64), ModelError> {
    let soup = Soup::of(geometry, fault);
    let empty = || ModelError::EmptyFault { name: fault.name.clone() };
    let (origin, axes) = best_fit_plane(&soup.points, &soup.triangles).ok_or_else(empty)?;
    let edge_m = soup.usual_edge_m();
    let best = OverPlane::of(geometry, &soup, origin, axes);
    if best.is_seen(&soup) && best.fold().is_none() {
        return Ok((best.built(fault, &soup, None), edge_m));
    }
    let facing = facing::direction(&soup).map(|n| OverPlane::of(geometry, &soup, origin, in_plane(n)));
    let planes: Vec<OverPlane> = facing.into_iter().chain([best]).filter(|over| over.is_seen(&soup)).collect();
    if let Some(over) = planes.iter().find(|over| over.fold().is_none()) {
        return Ok((over.built(fault, &soup, None), edge_m));
    }
    let smooth = planes.iter().map(|over| (over, smoothing::smoothed(over, &soup)));
    let nearest = smooth.min_by(|a, b| a.1.off_m.total_cmp(&b.1.off_m));
    match nearest {
        Some((over, smooth)) if smooth.off_m <= smoothing::tolerance_m(over, &soup) => {
            Ok((over.built(fault, &soup, Some(smooth)), edge_m))
        }
        _ => {
            let fold = planes.iter().find_map(OverPlane::fold).unwrap_or(Fold { triangle: 0, offset_m: soup.wide_m() });
            let corners = &soup.triangles[fold.triangle];
            let place = corners.iter().map(|&v| soup.voxels[v]).sum::<DVec3>() / 3.0;
            Err(ModelError::FoldedFault {
                name: fault.name.clone(),
                world: geometry.world_from_voxel(place).to_array(),
                offset_m: fold.offset_m,
            })
        }
    }
}

/// The triangles of a fault that have an area.
pub(super) struct Soup {
    /// Every vertex, voxels.
    pub voxels: Vec<DVec3>,
    /// Every vertex, metric.
    pub points: Vec<DVec3>,
    pub triangles: Vec<[usize; 3]>,
}

impl Soup {
    pub(super) fn of(geometry: &SurveyGeometry, fault: &Fault) -> Self {
        let metric = geometry.metric_from_voxel();
        let voxels: Vec<DVec3> = fault.mesh.vertices.iter().map(|&v| geometry.voxel_from_world(v)).collect();
        let points: Vec<DVec3> = voxels.iter().map(|&v| metric * v).collect();
        let triangles: Vec<[usize; 3]> = fault
            .mesh
            .triangles
            .iter()
            .map(|t| t.map(|v| v as usize))
            .filter(|t| t.iter().all(|&v| v < points.len() && points[v].is_finite()) && area(&points, t) > 1e-9)
            .collect();
        Self { voxels, points, triangles }
    }

    /// The same with some of the triangles.
    pub(super) fn only(&self, triangles: &[usize]) -> Self {
        Self {
            voxels: self.voxels.clone(),
            points: self.points.clone(),
            triangles: triangles.iter().map(|&t| self.triangles[t]).collect(),
        }
    }

    /// The area, m².
    pub(super) fn area(&self) -> f64 {
        self.triangles.iter().map(|t| area(&self.points, t)).sum()
    }

    /// Area times the normal of a triangle, m².
    pub(super) fn normal(&self, [a, b, c]: [usize; 3]) -> DVec3 {
        let [a, b, c] = [a, b, c].map(|v| self.points[v]);
        0.5 * (b - a).cross(c - a)
    }

    /// The longest side of the box around it, m.
    fn wide_m(&self) -> f64 {
        let used = || self.triangles.iter().flatten().map(|&v| self.points[v]);
        let bounds = used().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(lo, hi), p| (lo.min(p), hi.max(p)));
        (bounds.1 - bounds.0).max_element()
    }

    fn usual_edge_m(&self) -> f64 {
        let edge = |t: &[usize; 3], i: usize| self.points[t[i]].distance(self.points[t[(i + 1) % 3]]);
        let mut edges: Vec<f64> = self.triangles.iter().flat_map(|t| (0..3).map(move |i| edge(t, i))).collect();
        let half = edges.len() / 2;
        *edges.select_nth_unstable_by(half, f64::total_cmp).1
    }
}

/// Where a surface passes twice over one place of its plane by more than a cell.
pub(super) struct Fold {
    triangle: usize,
    offset_m: f64,
}

/// A fault's triangles over a plane, and how often and how high they pass over the nodes of a grid on it.
pub(super) struct OverPlane {
    metric: DMat3,
    origin: DVec3,
    frame: DMat3,
    pub spacing_m: f64,
    grid_origin: [i32; 2],
    pub size: [usize; 2],
    patch: FaultPatch,
    /// Sum of the heights at each node, m, and their count.
    pub sums: Vec<(f64, u32)>,
    folded: usize,
    worst: Fold,
}

impl OverPlane {
    fn of(geometry: &SurveyGeometry, soup: &Soup, origin: DVec3, [u, v, n]: [DVec3; 3]) -> Self {
        let metric = geometry.metric_from_voxel();
        let Soup { points, triangles, .. } = soup;
        // Bounds on the plane: the volume, and of the mesh what is not far off it.
        let to_plane = |p: DVec3| DVec2::new((p - origin).dot(u), (p - origin).dot(v));
        let bounds = |points: &mut dyn Iterator<Item = DVec2>| {
            points.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(lo, hi), q| (lo.min(q), hi.max(q)))
        };
        let last = geometry.size().map(|n| n as f64 - 1.0);
        let corners = (0..8).map(|c| {
            let along = |axis: usize| if c >> axis & 1 == 1 { last[axis] + MARGIN_VOXELS } else { -MARGIN_VOXELS };
            to_plane(metric * DVec3::new(along(0), along(1), along(2)))
        });
        let (lo, hi) = bounds(&mut corners.into_iter());
        let (mesh_lo, mesh_hi) = bounds(&mut triangles.iter().flatten().map(|&v| to_plane(points[v])));
        let slack = 0.25 * (hi - lo);
        let (near_lo, near_hi) = (mesh_lo.max(lo - slack), mesh_hi.min(hi + slack));
        let (lo, hi) = if near_lo.cmple(near_hi).all() {
            (lo.min(near_lo), hi.max(near_hi))
        } else {
            (lo.min(mesh_lo), hi.max(mesh_hi))
        };

        let voxel_m = metric.determinant().abs().cbrt();
        let spacing_m = voxel_m.max(((hi - lo).element_product() / MOST_NODES).sqrt());
        let first = (lo / spacing_m).floor();
        let size = ((hi / spacing_m).ceil() - first).as_uvec2() + 1;
        let size = [size.x.max(4) as usize, size.y.max(4) as usize];
        let grid_origin = [first.x as i32, first.y as i32];
        let frame = DMat3::from_cols(u / spacing_m, v / spacing_m, n).transpose();
        let patch = FaultPatch::new(
            points.iter().map(|&p| frame * (p - origin)).collect(),
            triangles.iter().map(|t| t.map(|v| v as u32)).collect(),
        );
        let mut over = Self {
            metric,
            origin,
            frame,
            spacing_m,
            grid_origin,
            size,
            patch,
            sums: vec![(0.0, 0); size[0] * size[1]],
            folded: 0,
            worst: Fold { triangle: 0, offset_m: 0.0 },
        };
        over.rasterise();
        over
    }

    /// Adds up the heights (exact on each triangle) at the grid nodes that the mesh covers.
    fn rasterise(&mut self) {
        let Self { patch, sums, folded, worst, .. } = self;
        for (index, _) in patch.triangles().iter().enumerate() {
            patch.each_node(index, self.grid_origin, self.size, |n, w| {
                let (total, count) = &mut sums[n];
                if *count > 0 {
                    let apart = (w - *total / f64::from(*count)).abs();
                    if apart > FOLD_CELLS * self.spacing_m {
                        *folded += 1;
                        if apart > worst.offset_m {
                            *worst = Fold { triangle: index, offset_m: apart };
                        }
                    }
                }
                *total += w;
                *count += 1;
            });
        }
    }

    /// Whether at least half of the surface does not stand on the plane: what does hardly covers it.
    fn is_seen(&self, soup: &Soup) -> bool {
        let across = self.frame.row(2);
        let normals = || soup.triangles.iter().map(|&t| soup.normal(t));
        let all: f64 = normals().map(DVec3::length).sum();
        let seen: f64 = normals().filter(|n| n.dot(across).abs() > STANDING * n.length()).map(DVec3::length).sum();
        seen >= 0.5 * all
    }

    /// Where it folds over the plane, if it does at more than a few nodes.
    fn fold(&self) -> Option<Fold> {
        let covered = self.sums.iter().filter(|s| s.1 > 0).count();
        let Fold { triangle, offset_m } = self.worst;
        (self.folded > 4.max(covered / 200)).then_some(Fold { triangle, offset_m })
    }

    /// The largest distance between two passes over one node, m.
    pub(super) fn offset_m(&self) -> f64 {
        self.worst.offset_m
    }

    /// Calls `visit(node, w)` for every pass of a triangle over a node.
    pub(super) fn each_pass(&self, mut visit: impl FnMut(usize, f64)) {
        for index in 0..self.patch.triangles().len() {
            self.patch.each_node(index, self.grid_origin, self.size, &mut visit);
        }
    }

    /// The surface: the mean of its passes, or what they were smoothed to.
    fn built(&self, fault: &Fault, soup: &Soup, smooth: Option<Smooth>) -> Built {
        let mean = |&(w, n): &(f64, u32)| if n > 0 { (w / f64::from(n)) as f32 } else { f32::NAN };
        let off_m = smooth.as_ref().map(|smooth| smooth.off_m);
        let w: Vec<f32> = smooth.map_or_else(|| self.sums.iter().map(mean).collect(), |smooth| smooth.w);
        let extent = w.iter().map(|w| if w.is_nan() { -1.0 } else { 1.0 }).collect();
        let used: Vec<DVec3> = {
            let mut ids: Vec<usize> = soup.triangles.iter().flatten().copied().collect();
            ids.sort_unstable();
            ids.dedup();
            ids.into_iter().map(|v| soup.voxels[v]).collect()
        };
        let (origin, size) = (self.grid_origin, self.size);
        let surface = FaultSurface {
            name: fault.name.clone(),
            frame_from_voxel: self.frame * self.metric,
            frame_offset: -(self.frame * self.origin),
            spacing_m: self.spacing_m,
            extent: HeightField { origin, size, z: extent },
            surface: HeightField { origin, size, z: w },
        };
        Built { surface, patch: self.patch.clone(), vertices: used, off_m }
    }
}

fn area(points: &[DVec3], t: &[usize; 3]) -> f64 {
    0.5 * (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]).length()
}

/// Centroid, and unit vectors (along strike, down dip, normal) of the area-weighted best-fit plane; `None`
/// without area.
fn best_fit_plane(points: &[DVec3], triangles: &[[usize; 3]]) -> Option<(DVec3, [DVec3; 3])> {
    let total: f64 = triangles.iter().map(|t| area(points, t)).sum();
    if !(total > 0.0 && total.is_finite()) {
        return None;
    }
    let centre = |t: &[usize; 3]| (points[t[0]] + points[t[1]] + points[t[2]]) / 3.0;
    let origin = triangles.iter().map(|t| area(points, t) * centre(t)).sum::<DVec3>() / total;
    // ∫ ppᵀ over a triangle = area/12 · (Σ vvᵀ + 9 ccᵀ).
    let outer = |p: DVec3| DMat3::from_cols(p * p.x, p * p.y, p * p.z);
    let mut moment = DMat3::ZERO;
    for t in triangles {
        let sum = t.iter().map(|&v| outer(points[v] - origin)).fold(DMat3::ZERO, |a, b| a + b);
        moment += (sum + outer(centre(t) - origin) * 9.0) * (area(points, t) / 12.0);
    }
    let mut n = smallest_eigenvector(moment);
    // One of the two normals, always the same: its largest component is positive.
    let largest = if n.x.abs() >= n.y.abs().max(n.z.abs()) {
        n.x
    } else if n.y.abs() >= n.z.abs() {
        n.y
    } else {
        n.z
    };
    n *= largest.signum();
    Some((origin, in_plane(n)))
}

/// Unit vectors along strike, down dip and along the normal of a plane.
fn in_plane(n: DVec3) -> [DVec3; 3] {
    let strike = DVec3::Z.cross(n);
    let u = if strike.length() > 1e-6 { strike.normalize() } else { DVec3::X };
    let v = n.cross(u).normalize();
    [u, v, n]
}

/// Eigenvector of the smallest eigenvalue of a symmetric matrix (cyclic Jacobi).
pub(super) fn smallest_eigenvector(m: DMat3) -> DVec3 {
    let mut a = m.to_cols_array_2d();
    let mut v = DMat3::IDENTITY.to_cols_array_2d();
    for _ in 0..30 {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if a[p][q].abs() < 1e-300 {
                continue;
            }
            let theta = 0.5 * (2.0 * a[p][q]).atan2(a[q][q] - a[p][p]);
            let (s, c) = theta.sin_cos();
            for row in &mut a {
                (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
            }
            for k in 0..3 {
                let (apk, aqk) = (a[p][k], a[q][k]);
                (a[p][k], a[q][k]) = (c * apk - s * aqk, s * apk + c * aqk);
                let (vpk, vqk) = (v[p][k], v[q][k]);
                (v[p][k], v[q][k]) = (c * vpk - s * vqk, s * vpk + c * vqk);
            }
        }
    }
    let least = (0..3).min_by(|&i, &j| a[i][i].total_cmp(&a[j][j])).unwrap_or(2);
    DVec3::from_array(v[least]).normalize()
}
