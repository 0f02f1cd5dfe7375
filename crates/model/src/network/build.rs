//! From a triangle mesh to a fault surface: best-fit plane, exact rasterisation, continuation.

use super::outline::FaultPatch;
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

/// A fault surface together with the mesh it was made from, in the surface's frame.
pub(super) struct Built {
    pub surface: FaultSurface,
    pub patch: FaultPatch,
    /// Vertices in use, voxel space.
    pub vertices: Vec<DVec3>,
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
pub(super) fn drawn(geometry: &SurveyGeometry, fault: &Fault) -> Result<(Built, f64), ModelError> {
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
    let empty = || ModelError::EmptyFault { name: fault.name.clone() };
    let (origin, [u, v, n]) = best_fit_plane(&points, &triangles).ok_or_else(empty)?;
    let mut edges: Vec<f64> =
        triangles.iter().flat_map(|t| (0..3).map(|i| points[t[i]].distance(points[t[(i + 1) % 3]]))).collect();
    let half = edges.len() / 2;
    let edge_m = *edges.select_nth_unstable_by(half, f64::total_cmp).1;

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

    let w = rasterise(fault, geometry, &patch, &voxels, grid_origin, size, spacing_m)?;
    let extent = w.iter().map(|w| if w.is_nan() { -1.0 } else { 1.0 }).collect();
    let used: Vec<DVec3> = {
        let mut ids: Vec<usize> = triangles.iter().flatten().copied().collect();
        ids.sort_unstable();
        ids.dedup();
        ids.into_iter().map(|v| voxels[v]).collect()
    };
    let surface = FaultSurface {
        name: fault.name.clone(),
        frame_from_voxel: frame * metric,
        frame_offset: -(frame * origin),
        spacing_m,
        extent: HeightField { origin: grid_origin, size, z: extent },
        surface: HeightField { origin: grid_origin, size, z: w },
    };
    Ok((Built { surface, patch, vertices: used }, edge_m))
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
    let strike = DVec3::Z.cross(n);
    let u = if strike.length() > 1e-6 { strike.normalize() } else { DVec3::X };
    let v = n.cross(u).normalize();
    Some((origin, [u, v, n]))
}

/// Eigenvector of the smallest eigenvalue of a symmetric matrix (cyclic Jacobi).
fn smallest_eigenvector(m: DMat3) -> DVec3 {
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

/// w at the grid nodes that the mesh covers (exact on each triangle), NaN elsewhere.
fn rasterise(
    fault: &Fault,
    geometry: &SurveyGeometry,
    patch: &FaultPatch,
    voxels: &[DVec3],
    origin: [i32; 2],
    size: [usize; 2],
    spacing_m: f64,
) -> Result<Vec<f32>, ModelError> {
    let mut sum = vec![(0.0f64, 0u32); size[0] * size[1]];
    let mut folded: (usize, f64, usize) = (0, 0.0, 0);
    for (index, _) in patch.triangles().iter().enumerate() {
        patch.each_node(index, origin, size, |n, w| {
            let (total, count) = &mut sum[n];
            if *count > 0 {
                let apart = (w - *total / f64::from(*count)).abs();
                if apart > FOLD_CELLS * spacing_m {
                    folded.0 += 1;
                    if apart > folded.1 {
                        (folded.1, folded.2) = (apart, index);
                    }
                }
            }
            *total += w;
            *count += 1;
        });
    }
    let covered = sum.iter().filter(|s| s.1 > 0).count();
    if folded.0 > 4.max(covered / 200) {
        let place = patch.triangles()[folded.2].iter().map(|&v| voxels[v as usize]).sum::<DVec3>() / 3.0;
        return Err(ModelError::FoldedFault {
            name: fault.name.clone(),
            world: geometry.world_from_voxel(place).to_array(),
            offset_m: folded.1,
        });
    }
    Ok(sum.iter().map(|&(w, n)| if n > 0 { (w / f64::from(n)) as f32 } else { f32::NAN }).collect())
}
