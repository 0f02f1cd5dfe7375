//! Horizons of any shape: overturned limbs, closed bodies, scattered points of several horizons.
//!
//! Such a horizon is where a [`LevelField`] has one value. Larger values lie on its older side, or inside the body. It
//! comes from triangles as their signed distance ([`distance`]), from the points of a series of horizons as one
//! function for all of them ([`series`]). Sheets stay the fast path for whatever is a height field.

mod cut_lattice;
mod distance;
mod least_squares;
mod point_normals;
mod rounding;
mod series;
mod shape;
mod silhouette;
mod tree;

pub use cut_lattice::{CutLattice, resampled};
pub use distance::NodeBox;
pub use least_squares::Equations;
pub use point_normals::surface_through;

use super::network::FaultNetwork;
use super::report::{ModelError, ModelNote, SurfaceProblem};
use glam::{DVec3, Vec3};
use series::{Series, SeriesPoint};
use shape::{ShapeMesh, problem};
use std::sync::Arc;
use survey::geometry::SurveyGeometry;
use survey::horizon::Horizon;
use survey::progress::Progress;
use survey::stratigraphy::Contact;
use survey::{HeightField, LevelField, TriangleMesh};

/// Points of one horizon that count in a series, at most.
const MOST_POINTS: usize = 4000;
/// A point of a series farther from the surface than this is noted, voxels.
const FAR_OFF: f32 = 1.0;
/// Bodies may overlap by this much without a note, m as a share of the longest voxel edge.
const OVERLAP: f32 = 1.0;

/// The surface of a horizon in a fault block: where a field has one value.
#[derive(Debug, Clone)]
pub struct LevelSurface {
    /// The function. Horizons of one series share it.
    pub field: Arc<LevelField>,
    /// Its value on the surface.
    pub at: f32,
    /// Metres for a unit of the field, near the surface.
    pub scale_m: f32,
    /// Corners or points that it was made of, in this block.
    pub own: usize,
}

impl PartialEq for LevelSurface {
    fn eq(&self, other: &Self) -> bool {
        let same = Arc::ptr_eq(&self.field, &other.field) || self.field == other.field;
        same && self.at.to_bits() == other.at.to_bits() && self.scale_m.to_bits() == other.scale_m.to_bits()
    }
}

impl LevelSurface {
    /// About the distance in metres of a voxel position from the surface, positive on the older side or inside.
    #[inline]
    pub fn offset_m(&self, p: Vec3) -> f32 {
        (self.field.value(p) - self.at) * self.scale_m
    }

    /// [`LevelSurface::offset_m`] and its derivatives per voxel.
    #[inline]
    pub fn sample_m(&self, p: Vec3) -> (f32, Vec3) {
        let (value, slope) = self.field.sample(p);
        ((value - self.at) * self.scale_m, slope * self.scale_m)
    }

    /// Whether the surface may run through a box of voxel positions; true wherever it does.
    pub fn may_cross(&self, low: Vec3, high: Vec3) -> bool {
        let [smallest, largest] = self.field.range(low, high);
        smallest <= self.at && largest >= self.at
    }

    /// The topmost place of the surface over the nodes of a lattice, voxel z: where one comes from above onto its older
    /// side, `below` where one does not.
    pub(super) fn top(&self, origin: [i32; 2], size: [usize; 2], below: f32) -> HeightField {
        let (first, step) = (self.field.origin.z, self.field.step.z);
        HeightField::from_fn(origin, size, |x, y| {
            let inside = self.field.origin.cmple(Vec3::new(x as f32, y as f32, first)).all();
            let end = self.field.origin + Vec3::from_array(self.field.size.map(|n| (n - 1) as f32)) * self.field.step;
            let is_beside = !inside || x as f32 > end.x || y as f32 > end.y;
            let at = |n: usize| self.field.value(Vec3::new(x as f32, y as f32, first + n as f32 * step)) - self.at;
            if is_beside && at(0) < 0.0 && at(self.field.size[2] - 1) < 0.0 {
                return below;
            }
            let mut before = at(0);
            if before >= 0.0 {
                return first;
            }
            for n in 1..self.field.size[2] {
                let here = at(n);
                if here >= 0.0 {
                    return first + (n as f32 - here / (here - before)) * step;
                }
                before = here;
            }
            below
        })
    }
}

/// Whether a horizon has triangles that enclose a body.
pub fn is_closed(horizon: &Horizon, geometry: &SurveyGeometry) -> bool {
    let mesh = horizon.any_shape().filter(|mesh| !mesh.triangles.is_empty());
    mesh.is_some_and(|mesh| ShapeMesh::of(&horizon.name, mesh, geometry).is_ok_and(|shape| shape.is_closed()))
}

/// Length of the border of a horizon's triangles, m, where they may be meant as a body but leave a hole.
pub fn hole_m(horizon: &Horizon, geometry: &SurveyGeometry) -> Option<f64> {
    let mesh = horizon.any_shape().filter(|mesh| !mesh.triangles.is_empty())?;
    ShapeMesh::of(&horizon.name, mesh, geometry).ok()?.hole_m()
}

/// Checks that a horizon of any shape can be part of a model, as far as it alone tells: its triangles are one two-sided
/// surface that does not cross itself, and a body is closed or reaches the edge of the volume.
///
/// # Errors
/// [`ModelError::Surface`] with the place.
pub fn check_surface(horizon: &Horizon, contact: Contact, geometry: &SurveyGeometry) -> Result<(), ModelError> {
    let Some(mesh) = horizon.any_shape() else { return Ok(()) };
    let is_body = contact.is_intrusive();
    if mesh.triangles.is_empty() {
        return if is_body { Err(problem(&horizon.name, geometry, SurfaceProblem::PointBody, None)) } else { Ok(()) };
    }
    let shape = ShapeMesh::of(&horizon.name, mesh, geometry)?;
    if is_body { shape.check_body() } else { Ok(()) }
}

/// The level surfaces of a model, and what was decided.
pub(super) struct Levels {
    /// `[horizon][block]`; `None` for a height field.
    pub surfaces: Vec<Vec<Option<LevelSurface>>>,
    pub notes: Vec<ModelNote>,
}

/// What level surfaces are made of.
pub(super) struct LevelSources<'a> {
    pub geometry: &'a SurveyGeometry,
    /// Youngest first.
    pub horizons: &'a [&'a Horizon],
    pub contacts: &'a [Contact],
    pub faults: &'a FaultNetwork,
}

impl LevelSources<'_> {
    /// Makes the surfaces of all horizons that are no height fields, or belong to a series of scattered points.
    pub(crate) fn levels(&self, progress: &Progress) -> Result<Levels, ModelError> {
        let blocks = self.faults.block_count();
        let count = self.horizons.len();
        let mut levels = Levels { surfaces: vec![vec![None; blocks]; count], notes: Vec::new() };
        if self.horizons.iter().all(|h| h.any_shape().is_none()) {
            return Ok(levels);
        }
        progress.begin("surfaces", count as u64);
        let mut first = 0;
        while first < count {
            let end = self.end_of_series(first);
            let members: Vec<usize> = (first..end).filter(|&h| !self.contacts[h].is_intrusive()).collect();
            if members.iter().any(|&h| self.mesh(h).is_some_and(|mesh| mesh.triangles.is_empty())) {
                self.add_series(&members, &mut levels, progress)?;
            } else {
                for &h in &members {
                    self.add_mesh(h, &mut levels, progress)?;
                }
            }
            for h in (first..end).filter(|&h| self.contacts[h].is_intrusive()) {
                self.add_body(h, &mut levels, progress)?;
            }
            progress.step((end - first) as u64)?;
            first = end;
        }
        self.note_overlaps(&mut levels);
        Ok(levels)
    }

    fn mesh(&self, h: usize) -> Option<&TriangleMesh> {
        self.horizons[h].any_shape()
    }

    /// Where the series that begins with horizon `first` ends: after an unconformity, which belongs to what lies above.
    fn end_of_series(&self, first: usize) -> usize {
        let breaks = |h: &usize| matches!(self.contacts[*h], Contact::Erosional | Contact::Onlap);
        (first..self.horizons.len()).find(breaks).map_or(self.horizons.len(), |h| h + 1)
    }

    fn add_mesh(&self, h: usize, levels: &mut Levels, progress: &Progress) -> Result<(), ModelError> {
        let Some(mesh) = self.mesh(h) else { return Ok(()) };
        let shape = ShapeMesh::of(&self.horizons[h].name, mesh, self.geometry)?;
        let blocks = self.faults.block_count();
        for block in 0..blocks {
            let own = shape.horizon(|p| blocks == 1 || self.shares(block, p), progress)?;
            let surface = match own {
                Some(surface) => surface,
                None => {
                    let horizon = self.horizons[h].name.clone();
                    let by = super::report::InferredPlacement::OtherBlocks;
                    levels.notes.push(ModelNote::Placed { horizon, block: block as u16, by });
                    let Some(whole) = shape.horizon(|_| true, progress)? else { continue };
                    whole
                }
            };
            levels.surfaces[h][block] = Some(surface);
        }
        Ok(())
    }

    /// Whether a place lies in a block, or in one that is the same there, beyond the tips of the faults between them.
    fn shares(&self, block: usize, p: Vec3) -> bool {
        let signature = self.faults.signatures()[block];
        let other = self.faults.signatures()[usize::from(self.faults.block_at(p))];
        let between = (signature.bits ^ other.bits) & signature.care & other.care;
        (0..self.faults.surfaces().len()).all(|f| between >> f & 1 == 0 || !self.faults.is_real(f, p))
    }

    fn add_body(&self, h: usize, levels: &mut Levels, progress: &Progress) -> Result<(), ModelError> {
        let Some(mesh) = self.mesh(h) else { return Ok(()) };
        let name = &self.horizons[h].name;
        if mesh.triangles.is_empty() {
            return Err(problem(name, self.geometry, SurfaceProblem::PointBody, None));
        }
        let body = ShapeMesh::of(name, mesh, self.geometry)?.body(progress)?;
        levels.surfaces[h].fill(Some(body));
        Ok(())
    }

    fn add_series(&self, members: &[usize], levels: &mut Levels, progress: &Progress) -> Result<(), ModelError> {
        if let [alone] = *members {
            return Err(problem(&self.horizons[alone].name, self.geometry, SurfaceProblem::PointsAlone, None));
        }
        let last = Vec3::from_array(self.geometry.size().map(|n| n as f32 - 1.0));
        let mut points = Vec::new();
        for (horizon, &h) in members.iter().enumerate() {
            let all: Vec<Vec3> = match &self.horizons[h].surface {
                Some(mesh) => mesh.vertices.iter().map(|&v| self.geometry.voxel_from_world(v).as_vec3()).collect(),
                None => self.picked_nodes(h),
            };
            let near = |p: &Vec3| {
                p.cmpge(Vec3::splat(-cut_lattice::MARGIN)).all() && p.cmple(last + cut_lattice::MARGIN).all()
            };
            let inside: Vec<Vec3> = all.iter().copied().filter(near).collect();
            let name = self.horizons[h].name.clone();
            if inside.is_empty() {
                return Err(ModelError::EmptyHorizon { name, outside: all.len(), holes: 0 });
            }
            if inside.len() < all.len() {
                levels.notes.push(ModelNote::Outside { horizon: name, nodes: all.len() - inside.len() });
            }
            let every = inside.len().div_ceil(MOST_POINTS);
            let point = |&p: &Vec3| SeriesPoint { horizon, p, block: self.faults.block_at(p) };
            points.extend(inside.iter().step_by(every).map(point));
        }
        let series = Series {
            points: &points,
            horizons: members.len(),
            faults: self.faults,
            size: self.geometry.size(),
            metric: self.geometry.metric_from_voxel(),
        };
        let surfaces = series.surfaces(progress)?;
        let voxel_m = (0..3).map(|axis| series.metric.col(axis).length() as f32).fold(f32::INFINITY, f32::min);
        for ((horizon, &h), surfaces) in members.iter().enumerate().zip(surfaces) {
            let off = |q: &SeriesPoint| surfaces[usize::from(q.block)].offset_m(q.p).abs() / voxel_m;
            let own = points.iter().filter(|q| q.horizon == horizon);
            let (far, worst) = own.map(off).fold((0, 0.0f32), |(n, w), d| (n + usize::from(d > FAR_OFF), w.max(d)));
            if far > 0 {
                levels.notes.push(ModelNote::Misfit { horizon: self.horizons[h].name.clone(), points: far, worst });
            }
            levels.surfaces[h] = surfaces.into_iter().map(Some).collect();
        }
        Ok(())
    }

    /// The picked or tracked nodes of a horizon's sheets, voxels.
    fn picked_nodes(&self, h: usize) -> Vec<Vec3> {
        let sheets = self.horizons[h].sheets.iter();
        let nodes = sheets.flat_map(|sheet| {
            let nv = sheet.grid.count[1];
            let known = sheet
                .depth
                .iter()
                .zip(&sheet.quality)
                .enumerate()
                .filter(|(_, (depth, quality))| depth.is_finite() && quality.is_on_data());
            known.map(move |(n, (depth, _))| {
                let at = sheet.grid.world_at(glam::DVec2::new((n / nv) as f64, (n % nv) as f64));
                self.geometry.voxel_from_world(at.extend(f64::from(*depth))).as_vec3()
            })
        });
        nodes.collect()
    }

    /// Notes bodies that share room: there the younger one is drawn.
    fn note_overlaps(&self, levels: &mut Levels) {
        let bodies: Vec<usize> = (0..self.horizons.len())
            .filter(|&h| self.contacts[h].is_intrusive() && levels.surfaces[h].iter().any(Option::is_some))
            .collect();
        for (n, &younger) in bodies.iter().enumerate() {
            for &older in &bodies[n + 1..] {
                let (Some(a), Some(b)) = (&levels.surfaces[younger][0], &levels.surfaces[older][0]) else { continue };
                let note = overlap([younger, older].map(|h| self.horizons[h].name.as_str()), [a, b], self.geometry);
                levels.notes.extend(note);
            }
        }
    }
}

/// The note that two bodies share room, if they do.
fn overlap([younger, older]: [&str; 2], [a, b]: [&LevelSurface; 2], geometry: &SurveyGeometry) -> Option<ModelNote> {
    let metric = geometry.metric_from_voxel();
    let deep = OVERLAP * (0..3).map(|axis| metric.col(axis).length() as f32).fold(0.0, f32::max);
    let shared = |node: &usize| a.field.values[*node] > deep && b.offset_m(a.field.place(*node)) > deep;
    let at = (0..a.field.values.len()).find(shared)?;
    let lines = geometry.lines_from_voxel(a.field.place(at).as_dvec3().truncate()).to_array();
    Some(ModelNote::BodiesOverlap { younger: younger.to_owned(), older: older.to_owned(), lines })
}

/// The note that two bodies, the younger one first, share room, if they do. Horizons without triangles share none. Their
/// signed distances are computed where their extents meet.
///
/// # Errors
/// [`ModelError::Surface`]: one of them is no body; or the user cancelled.
pub fn bodies_overlap(
    [younger, older]: [&Horizon; 2],
    geometry: &SurveyGeometry,
    progress: &Progress,
) -> Result<Option<ModelNote>, ModelError> {
    let meshes = [younger, older].map(|body| body.any_shape().filter(|mesh| !mesh.triangles.is_empty()));
    let [Some(a), Some(b)] = meshes else { return Ok(None) };
    let bounds = |mesh: &TriangleMesh| {
        let corners = mesh.vertices.iter();
        corners.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), v| (low.min(*v), high.max(*v)))
    };
    let ((low, high), (other_low, other_high)) = (bounds(a), bounds(b));
    if low.cmpgt(other_high).any() || high.cmplt(other_low).any() {
        return Ok(None);
    }
    let level = |body: &Horizon, mesh| ShapeMesh::of(&body.name, mesh, geometry)?.body(progress);
    let (a, b) = (level(younger, a)?, level(older, b)?);
    Ok(overlap([younger.name.as_str(), older.name.as_str()], [&a, &b], geometry))
}
