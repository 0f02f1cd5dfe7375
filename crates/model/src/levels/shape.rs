//! A horizon given as triangles: checked, and as a level surface.

use super::distance::{DistanceSurface, NodeBox, signed_distance};
use super::rounding::round_off;
use super::tree::Tree;
use super::{LevelSurface, cut_lattice::MARGIN};
use crate::report::{ModelError, SurfaceProblem};
use glam::{DMat3, DVec3, Vec3};
use rayon::prelude::*;
use std::sync::Arc;
use survey::TriangleMesh;
use survey::geometry::SurveyGeometry;
use survey::progress::Progress;
use survey::topology::OrientedMesh;

/// Corners of a mesh closer than this are one, voxels.
const WELD: f64 = 1e-3;
/// A body's border may lie as far inside the volume's edge, voxels.
const AT_EDGE: f64 = 2.0;
/// Voxels between the nodes of a small body, and how many nodes it may have then.
const FINE_STEP: f32 = 0.5;
const FINE_NODES: usize = 3_000_000;

/// A mesh in metric space, oriented, of a survey.
pub(super) struct ShapeMesh<'a> {
    name: &'a str,
    geometry: &'a SurveyGeometry,
    metric: DMat3,
    /// Corners in m.
    mesh: OrientedMesh,
}

impl<'a> ShapeMesh<'a> {
    /// Checks that triangles are a surface: two-sided, without branches or crossings.
    ///
    /// # Errors
    /// [`ModelError::Surface`] with the place.
    pub(super) fn of(name: &'a str, mesh: &TriangleMesh, geometry: &'a SurveyGeometry) -> Result<Self, ModelError> {
        let metric = geometry.metric_from_voxel();
        let weld = WELD * (0..3).map(|axis| metric.col(axis).length()).fold(f64::INFINITY, f64::min);
        let vertices = mesh.vertices.iter().map(|&v| metric * geometry.voxel_from_world(v)).collect();
        let in_metric = TriangleMesh { vertices, triangles: mesh.triangles.clone() };
        let oriented = OrientedMesh::of(&in_metric, weld);
        let voxel = metric.inverse();
        let mesh = oriented.map_err(|error| {
            let place = error.place().map(|at| voxel * at);
            problem(name, geometry, SurfaceProblem::Topology(error), place)
        })?;
        let shape = Self { name, geometry, metric, mesh };
        match shape.crossing() {
            Some(at) => Err(problem(name, geometry, SurfaceProblem::Crossing, Some(voxel * at))),
            None => Ok(shape),
        }
    }

    /// Whether it encloses a body.
    pub(super) fn is_closed(&self) -> bool {
        self.mesh.is_closed()
    }

    /// Length of its border, m, where it may be a body with a hole: the border is less than half as long as that of a disc
    /// of the same area. Of a sheet, however it is folded, the border is longer.
    pub(super) fn hole_m(&self) -> Option<f64> {
        let at = |v: u32| self.mesh.mesh.vertices[v as usize];
        let border: f64 = self.mesh.border.iter().map(|&[a, b]| at(a).distance(at(b))).sum();
        let area: f64 =
            self.mesh.mesh.triangles.iter().map(|&[a, b, c]| 0.5 * (at(b) - at(a)).cross(at(c) - at(a)).length()).sum();
        (border > 0.0 && border < (std::f64::consts::PI * area).sqrt()).then_some(border)
    }

    /// The corners, voxels.
    pub(super) fn corners(&self) -> impl Iterator<Item = Vec3> + '_ {
        let voxel = self.metric.inverse();
        self.mesh.mesh.vertices.iter().map(move |&v| (voxel * v).as_vec3())
    }

    /// Checks that a body is closed inside the volume.
    ///
    /// # Errors
    /// Its border lies there.
    pub(super) fn check_body(&self) -> Result<(), ModelError> {
        let voxel = self.metric.inverse();
        let last = DVec3::from_array(self.geometry.size().map(|n| n as f64 - 1.0));
        let depth = |v: u32| {
            let p = voxel * self.mesh.mesh.vertices[v as usize];
            (p.min(last - p).min_element(), p)
        };
        let deepest = self.mesh.border.iter().flatten().map(|&v| depth(v)).max_by(|a, b| a.0.total_cmp(&b.0));
        match deepest {
            Some((inside, at)) if inside > AT_EDGE => {
                Err(problem(self.name, self.geometry, SurfaceProblem::OpenBody, Some(at)))
            }
            _ => Ok(()),
        }
    }

    /// The inside of a body.
    ///
    /// # Errors
    /// Its border lies inside the volume, or the user cancelled.
    pub(super) fn body(&self, progress: &Progress) -> Result<LevelSurface, ModelError> {
        self.check_body()?;
        self.level(&self.mesh, self.is_closed(), progress)
    }

    /// The side of a horizon, from the triangles that `counts` keeps by their middle (voxels); `None` without any.
    ///
    /// # Errors
    /// Its sides contradict each other, or the user cancelled.
    pub(super) fn horizon(
        &self,
        counts: impl Fn(Vec3) -> bool,
        progress: &Progress,
    ) -> Result<Option<LevelSurface>, ModelError> {
        let voxel = self.metric.inverse();
        let middle = |n: &usize| (voxel * (self.mesh.mesh.corners(*n).iter().sum::<DVec3>() / 3.0)).as_vec3();
        let kept: Vec<usize> = (0..self.mesh.mesh.triangles.len()).filter(|n| counts(middle(n))).collect();
        if kept.is_empty() {
            return Ok(None);
        }
        if kept.len() == self.mesh.mesh.triangles.len() {
            return self.layering(&self.mesh, progress).map(Some);
        }
        let triangles = kept.iter().map(|&n| self.mesh.mesh.triangles[n]).collect();
        let part = TriangleMesh { vertices: self.mesh.mesh.vertices.clone(), triangles };
        match OrientedMesh::of(&part, 0.01 * WELD) {
            Ok(part) => self.layering(&part, progress).map(Some),
            Err(_) => Ok(None),
        }
    }

    /// A level surface that layers follow far away from it.
    fn layering(&self, mesh: &OrientedMesh, progress: &Progress) -> Result<LevelSurface, ModelError> {
        let mut surface = self.level(mesh, false, progress)?;
        round_off(Arc::make_mut(&mut surface.field), self.metric, progress)?;
        Ok(surface)
    }

    /// The signed distance around a closed mesh, or in the whole volume.
    fn level(&self, mesh: &OrientedMesh, is_closed: bool, progress: &Progress) -> Result<LevelSurface, ModelError> {
        let last = Vec3::from_array(self.geometry.size().map(|n| n as f32 - 1.0));
        let (mut low, mut high) = (Vec3::splat(-MARGIN), last + MARGIN);
        if is_closed {
            let (least, most) =
                self.corners().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(l, h), p| (l.min(p), h.max(p)));
            low = low.max((least - 2.0).floor()).min(high - 1.0);
            high = high.min((most + 2.0).ceil()).max(low + 1.0);
        }
        let fine = NodeBox::covering(low, high, Vec3::splat(FINE_STEP));
        let nodes =
            if is_closed && fine.count() <= FINE_NODES { fine } else { NodeBox::covering(low, high, Vec3::ONE) };
        let (field, contradiction) = signed_distance(&DistanceSurface::of(mesh), nodes, self.metric, last, progress)?;
        if let Some(found) = contradiction {
            return Err(problem(self.name, self.geometry, SurfaceProblem::Contradiction, Some(found.at.as_dvec3())));
        }
        let own = mesh.mesh.vertices.len();
        Ok(LevelSurface { field: Arc::new(field), at: 0.0, scale_m: 1.0, own })
    }

    /// A place where two triangles that share no corner cross.
    fn crossing(&self) -> Option<DVec3> {
        let mesh = &self.mesh.mesh;
        let corners: Vec<[DVec3; 3]> = (0..mesh.triangles.len()).map(|n| mesh.corners(n)).collect();
        let tree = Tree::of(&corners);
        let of = |n: usize| {
            let [a, b, c] = corners[n];
            let mut found = None;
            tree.within(a.min(b).min(c), a.max(b).max(c), |m| {
                let apart = mesh.triangles[m].iter().all(|v| !mesh.triangles[n].contains(v));
                if m != n && apart && found.is_none() {
                    found = pierced(corners[n], corners[m]);
                }
            });
            found
        };
        (0..corners.len()).into_par_iter().find_map_first(of)
    }
}

/// Where an edge of `a` passes through `b`, not touching its border.
fn pierced(a: [DVec3; 3], b: [DVec3; 3]) -> Option<DVec3> {
    let [p, q, r] = b;
    let normal = (q - p).cross(r - p);
    (0..3).find_map(|n| {
        let (from, to) = (a[n], a[(n + 1) % 3]);
        let (before, after) = ((from - p).dot(normal), (to - p).dot(normal));
        if before * after >= 0.0 {
            return None;
        }
        let at = from.lerp(to, before / (before - after));
        let inside = [(p, q), (q, r), (r, p)]
            .iter()
            .all(|(s, t)| (*t - *s).cross(at - *s).dot(normal) > 1e-9 * normal.length_squared());
        inside.then_some(at)
    })
}

/// The error of a surface at a voxel place.
pub(super) fn problem(name: &str, geometry: &SurveyGeometry, problem: SurfaceProblem, at: Option<DVec3>) -> ModelError {
    let place = at.map(|p| {
        let lines = geometry.lines_from_voxel(p.truncate());
        [lines.x, lines.y, geometry.vertical.value_at(p.z)]
    });
    ModelError::Surface { name: name.to_owned(), problem, place, unit: geometry.vertical.unit.symbol() }
}
