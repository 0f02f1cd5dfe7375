//! Small models with exact answers, for testing whatever is computed from an interpretation.
//!
//! Horizons are planes, concentric cylinders or folded beds, optionally cut by an erosion surface and by one
//! planar fault whose hanging wall is moved straight down. Where a layer's two horizons are parallel, the
//! paper's f_z = d_bottom/(d_bottom + d_top) (P-illus 3.1) and the crossing of its isocurve with the middle
//! surface are known:
//!
//! - parallel planes: k is the fraction of the distance; the isocurve is the common normal;
//! - concentric cylinders with radii r_bottom < r_top: `k = (r − r_bottom)/(r_top − r_bottom)`; the isocurve
//!   is the radius.
//!
//! Positions are voxels; geometry in metric space (X and Y offset from the survey's origin, depth), m. Fold
//! axes and the fault's strike follow the lattice as documented at each constructor.

use super::fold::{FoldedBeds, Undulation, Wave};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;
use survey::fault::Fault;
use survey::geometry::SurveyGeometry;
use survey::horizon::{Horizon, NodeGrid, Quality, Sheet};
use survey::mesh::TriangleMesh;
use survey::stratigraphy::{Contact, StratigraphicHorizon, Stratigraphy};

/// Nodes of a fault mesh along strike and down dip.
const FAULT_NODES: [usize; 2] = [17, 17];

/// One horizon before faulting, in metric space.
#[derive(Debug, Clone, PartialEq)]
enum UnfaultedHorizon {
    /// depth = at_origin + slope · (u, v).
    Plane { at_origin: f64, slope: DVec2 },
    /// The upper half of a cylinder: depth = axis.depth − √(radius² − across²), across = (u, v) · direction −
    /// axis.
    Cylinder { direction: DVec2, axis: f64, axis_depth: f64, radius: f64 },
    /// A bed of a fold.
    Bed { beds: FoldedBeds, strat_m: f64 },
}

impl UnfaultedHorizon {
    /// Depth at (u, v), m; NaN beside a cylinder.
    fn depth_m(&self, place: DVec2) -> f64 {
        match self {
            Self::Plane { at_origin, slope } => at_origin + slope.dot(place),
            Self::Cylinder { direction, axis, axis_depth, radius } => {
                let across = direction.dot(place) - axis;
                axis_depth - (radius * radius - across * across).sqrt()
            }
            Self::Bed { beds, strat_m } => beds.depth_m(*strat_m, place),
        }
    }
}

/// A planar fault x = middle + run·(z − middle), striking along the crosslines' direction y; voxels.
#[derive(Debug, Clone, Copy, PartialEq)]
struct PlanarFault {
    middle: DVec2,
    run: f64,
    throw: f64,
}

impl PlanarFault {
    /// x of the surface at z.
    fn x_at(&self, z: f64) -> f64 {
        self.middle.x + self.run * (z - self.middle.y)
    }
}

/// An exact position in flat space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ExactPoint {
    /// x/(Nx − 1) of the isocurve's crossing with the middle surface.
    pub i: f64,
    /// y/(Ny − 1) of the same.
    pub j: f64,
    /// 0 on the layer's bottom horizon, 1 on its top.
    pub k: f64,
    /// The layer, 0 = deepest.
    pub layer: u16,
    /// The fault block: 1 in the hanging wall, else 0.
    pub block: u16,
}

/// A small interpretation whose layers, blocks and coordinates are known exactly.
///
/// # Examples
/// Planes that dip by 45 degrees towards world +X deepen by one bin width, 25 m or 2.5 samples, per inline:
/// ```
/// use glam::DVec3;
/// use survey::geometry::{SurveyGeometry, VerticalUnit};
/// use synth::closed_form::ClosedForm;
///
/// let geometry = SurveyGeometry::regular([11, 21, 61], 25.0, 10.0, VerticalUnit::Metres);
/// let form = ClosedForm::dipping(&geometry, &[20.0, 40.0], 45.0, 0.0);
/// assert!((form.sheet_z(0, 0, 5.0, 10.0) - 20.0).abs() < 1e-9);
/// assert!((form.sheet_z(0, 0, 6.0, 10.0) - 22.5).abs() < 1e-9);
/// // Half-way between the horizons k is 1/2.
/// let middle = DVec3::new(5.0, 10.0, 30.0);
/// assert_eq!(form.layer_at(middle), 1);
/// assert!(form.exact_at(middle).is_some_and(|exact| (exact.k - 0.5).abs() < 1e-9));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct ClosedForm {
    /// The lattice.
    pub geometry: SurveyGeometry,
    /// Horizons "H1" (youngest), "H2", … and their contacts.
    pub stratigraphy: Stratigraphy,
    /// The horizons on the survey's lattice: one sheet without a fault, else one for each block. Nodes where
    /// a horizon does not exist are holes.
    pub horizons: Vec<Horizon>,
    /// Empty, or the planar fault "F", which reaches from one side face of the volume to the other.
    pub faults: Vec<Fault>,
    surfaces: Vec<UnfaultedHorizon>,
    erosional: Option<usize>,
    fault: Option<PlanarFault>,
}

impl ClosedForm {
    /// Horizontal planes at the given samples, youngest first.
    pub fn flat(geometry: &SurveyGeometry, samples: &[f64]) -> Self {
        Self::dipping(geometry, samples, 0.0, 0.0)
    }

    /// Parallel planes that lie at the given samples in the middle of the survey and dip by `dip_deg` towards
    /// `direction_deg`, measured from world +X to +Y.
    pub fn dipping(geometry: &SurveyGeometry, samples: &[f64], dip_deg: f64, direction_deg: f64) -> Self {
        let slope = DVec2::from_angle(direction_deg.to_radians()) * dip_deg.to_radians().tan();
        let plane = |sample: &f64| UnfaultedHorizon::Plane {
            at_origin: sample * geometry.sample_m() - slope.dot(middle(geometry)),
            slope,
        };
        Self::of(geometry, samples.iter().map(plane).collect(), None)
    }

    /// Concentric cylinders along crosslines' direction y, their crests over the survey's middle at the given
    /// samples, youngest first; the deepest dips `dip_deg` at the first and last inline.
    pub fn dome(geometry: &SurveyGeometry, samples: &[f64], dip_deg: f64) -> Self {
        // The horizontal direction across the axis: normal to the crossline vector.
        let direction = geometry.crossline_vector.normalize().perp();
        let half_width = 0.5 * (geometry.inlines.count as f64 - 1.0) * geometry.inline_vector.dot(direction).abs();
        let deepest = samples.iter().copied().fold(0.0, f64::max) * geometry.sample_m();
        let axis_depth = deepest + half_width / dip_deg.to_radians().sin();
        let cylinder = |sample: &f64| UnfaultedHorizon::Cylinder {
            direction,
            axis: direction.dot(middle(geometry)),
            axis_depth,
            radius: axis_depth - sample * geometry.sample_m(),
        };
        Self::of(geometry, samples.iter().map(cylinder).collect(), None)
    }

    /// Folded beds at the given mean samples: two waves across each other, of which the first dips up to
    /// `dip_deg`, and beds that are thinner and thicker by the fraction `thickening`. Has no exact k.
    pub fn folded(geometry: &SurveyGeometry, samples: &[f64], dip_deg: f64, thickening: f64) -> Self {
        let width = geometry.inline_vector.length() * (geometry.inlines.count as f64 - 1.0);
        let wave = |wavelength: f64, angle: f64, phase: f64, amplitude: &dyn Fn(f64) -> f64| {
            let number = TAU / (wavelength * width);
            Wave { amplitude: amplitude(number), wave_vector: DVec2::from_angle(angle) * number, phase }
        };
        let slope = dip_deg.to_radians().tan();
        let mean = samples.iter().sum::<f64>() / samples.len().max(1) as f64;
        let beds = FoldedBeds {
            pivot_m: mean * geometry.sample_m(),
            relief: Undulation {
                waves: vec![wave(0.8, 0.2, 0.4, &|n| slope / n), wave(1.1, 1.5, 1.0, &|n| 0.2 * slope / n)],
            },
            thickening: Undulation { waves: vec![wave(0.9, 0.9, 2.0, &|_| thickening)] },
        };
        let bed = |sample: &f64| UnfaultedHorizon::Bed { beds: beds.clone(), strat_m: sample * geometry.sample_m() };
        Self::of(geometry, samples.iter().map(bed).collect(), None)
    }

    /// Planes that dip as in [`ClosedForm::dipping`] under a horizontal erosion surface at `base_sample`,
    /// "H1", which cuts them off.
    pub fn unconformity(
        geometry: &SurveyGeometry,
        base_sample: f64,
        samples: &[f64],
        dip_deg: f64,
        direction_deg: f64,
    ) -> Self {
        let mut surfaces =
            vec![UnfaultedHorizon::Plane { at_origin: base_sample * geometry.sample_m(), slope: DVec2::ZERO }];
        surfaces.extend(Self::dipping(geometry, samples, dip_deg, direction_deg).surfaces);
        Self::of(geometry, surfaces, Some(0))
    }

    /// The same model with a planar fault through the survey's middle, striking along y and dipping `dip_deg`
    /// towards +x (of a survey with perpendicular lines); its hanging wall is moved down by `throw` samples,
    /// up when negative.
    pub fn with_fault(&self, dip_deg: f64, throw: f64) -> Self {
        let size = self.geometry.size();
        let run = self.geometry.sample_m() / dip_deg.to_radians().tan() / self.geometry.inline_vector.length();
        let fault =
            PlanarFault { middle: DVec2::new(0.5 * (size[0] as f64 - 1.0), 0.5 * (size[2] as f64 - 1.0)), run, throw };
        let mut model = Self { fault: Some(fault), faults: vec![interpreted(&self.geometry, &fault)], ..self.clone() };
        model.horizons = (0..model.surfaces.len()).map(|h| model.horizon(h)).collect();
        model
    }

    /// Puts the parts together.
    fn of(geometry: &SurveyGeometry, surfaces: Vec<UnfaultedHorizon>, erosional: Option<usize>) -> Self {
        let contact = |h| if erosional == Some(h) { Contact::Erosional } else { Contact::Conformable };
        let named = |h| StratigraphicHorizon { name: format!("H{}", h + 1), contact: contact(h) };
        let stratigraphy = Stratigraphy { horizons: (0..surfaces.len()).map(named).collect(), layer_names: Vec::new() };
        let mut model = Self {
            geometry: geometry.clone(),
            stratigraphy,
            horizons: Vec::new(),
            faults: Vec::new(),
            surfaces,
            erosional,
            fault: None,
        };
        model.horizons = (0..model.surfaces.len()).map(|h| model.horizon(h)).collect();
        model
    }

    /// Metric (u, v) of voxel (x, y).
    fn place(&self, x: f64, y: f64) -> DVec2 {
        self.geometry.inline_vector * x + self.geometry.crossline_vector * y
    }

    /// The block at voxel `p`: 1 in the hanging wall of the fault, else 0.
    pub fn block_at(&self, p: DVec3) -> u16 {
        u16::from(self.fault.is_some_and(|fault| p.x > fault.x_at(p.z)))
    }

    /// Samples by which a block is moved down.
    fn displacement(&self, block: u16) -> f64 {
        self.fault.filter(|_| block == 1).map_or(0.0, |fault| fault.throw)
    }

    /// Voxel z of a horizon before erosion, in one block continued everywhere.
    pub fn sheet_z(&self, horizon: usize, block: u16, x: f64, y: f64) -> f64 {
        self.surfaces[horizon].depth_m(self.place(x, y)) / self.geometry.sample_m() + self.displacement(block)
    }

    /// Voxel z of a horizon with the contact rule applied.
    pub fn horizon_z(&self, horizon: usize, block: u16, x: f64, y: f64) -> f64 {
        let sheet = self.sheet_z(horizon, block, x, y);
        match self.erosional {
            Some(base) if base < horizon => sheet.max(self.sheet_z(base, block, x, y)),
            _ => sheet,
        }
    }

    /// The layer at voxel `p`, 0 = deepest.
    pub fn layer_at(&self, p: DVec3) -> u16 {
        let block = self.block_at(p);
        let above = (0..self.surfaces.len()).filter(|&h| self.horizon_z(h, block, p.x, p.y) <= p.z).count();
        (self.surfaces.len() - above) as u16
    }

    /// i, j, k at voxel `p`, where the layer's two horizons are parallel; `None` in open layers and between
    /// other surfaces. An eroded layer is measured between its horizons as they were before erosion.
    pub fn exact_at(&self, p: DVec3) -> Option<ExactPoint> {
        let (block, layer) = (self.block_at(p), self.layer_at(p));
        let top = &self.surfaces[self.stratigraphy.top_of(layer.into())?];
        let bottom = &self.surfaces[self.stratigraphy.bottom_of(layer.into())?];
        let before_fault = DVec3::new(p.x, p.y, p.z - self.displacement(block));
        let metric = self.place(p.x, p.y).extend(before_fault.z * self.geometry.sample_m());
        let (k, crossing) = parallel_k(top, bottom, metric)?;
        let mut voxel = self.geometry.metric_from_voxel().inverse() * crossing;
        voxel.z += self.displacement(block);
        let [nx, ny, _] = self.geometry.size();
        Some(ExactPoint { i: voxel.x / (nx - 1) as f64, j: voxel.y / (ny - 1) as f64, k, layer, block })
    }

    /// The sheets of a horizon.
    fn horizon(&self, horizon: usize) -> Horizon {
        let grid = NodeGrid::of_survey(&self.geometry);
        let last = self.geometry.vertical.count as f64 - 1.0;
        let blocks = 1 + u16::from(self.fault.is_some());
        let sheet = |block: u16| {
            let depth = (0..grid.count[0] * grid.count[1]).map(|node| {
                let (x, y) = ((node / grid.count[1]) as f64, (node % grid.count[1]) as f64);
                let z = self.sheet_z(horizon, block, x, y);
                let whole = self.horizon_z(horizon, block, x, y) == z && (0.0..=last).contains(&z);
                let here = whole && self.block_at(DVec3::new(x, y, z)) == block;
                if here { self.geometry.vertical.value_at(z) as f32 } else { f32::NAN }
            });
            Sheet::new(grid, depth.collect(), Quality::Picked)
        };
        Horizon::new(format!("H{}", horizon + 1), (0..blocks).map(sheet).collect())
    }
}

/// Metric (u, v) of the survey's middle.
fn middle(geometry: &SurveyGeometry) -> DVec2 {
    let [nx, ny, _] = geometry.size();
    0.5 * (geometry.inline_vector * (nx as f64 - 1.0) + geometry.crossline_vector * (ny as f64 - 1.0))
}

/// k between two parallel surfaces and where the isocurve through `p` crosses the middle surface; metric.
fn parallel_k(top: &UnfaultedHorizon, bottom: &UnfaultedHorizon, p: DVec3) -> Option<(f64, DVec3)> {
    match (top, bottom) {
        (UnfaultedHorizon::Plane { slope, .. }, UnfaultedHorizon::Plane { slope: other, .. }) if slope == other => {
            let (top_m, bottom_m) = (top.depth_m(p.truncate()), bottom.depth_m(p.truncate()));
            let k = (bottom_m - p.z) / (bottom_m - top_m);
            // Down the common normal (−slope, 1)/|…|, a vertical gap g is the distance g/|…|.
            let normal = (-*slope).extend(1.0);
            let gap = 0.5 * (top_m + bottom_m) - p.z;
            Some((k, p + normal * gap / normal.length_squared()))
        }
        (
            UnfaultedHorizon::Cylinder { direction, axis, axis_depth, radius: outer },
            UnfaultedHorizon::Cylinder { axis_depth: other, radius: inner, .. },
        ) if axis_depth == other => {
            let across = direction.dot(p.truncate()) - axis;
            let radius = across.hypot(axis_depth - p.z);
            let stretch = 0.5 * (inner + outer) / radius;
            let crossing = p.truncate() + direction * (across * (stretch - 1.0));
            let k = (radius - inner) / (outer - inner);
            Some((k, crossing.extend(axis_depth - (axis_depth - p.z) * stretch)))
        }
        _ => None,
    }
}

/// The fault's mesh inside the volume: a grid over y and z.
fn interpreted(geometry: &SurveyGeometry, fault: &PlanarFault) -> Fault {
    let [nx, ny, nz] = geometry.size().map(|n| n as f64 - 1.0);
    // Depths at which the plane is between the first and the last inline.
    let z_at = |x: f64| fault.middle.y + (x - fault.middle.x) / fault.run;
    let (first, last) = if fault.run.abs() < 1e-9 { (0.0, nz) } else { (z_at(0.0).max(0.0), z_at(nx).min(nz)) };
    let mut mesh = TriangleMesh::default();
    let [along, down] = FAULT_NODES;
    for a in 0..along {
        for b in 0..down {
            let z = first + (last - first) * b as f64 / (down - 1) as f64;
            let voxel = DVec3::new(fault.x_at(z), ny * a as f64 / (along - 1) as f64, z);
            mesh.vertices.push(geometry.world_from_voxel(voxel));
        }
    }
    for a in 0..along as u32 - 1 {
        for b in 0..down as u32 - 1 {
            let corner = a * down as u32 + b;
            let next = corner + down as u32;
            mesh.triangles.extend([[corner, next, corner + 1], [corner + 1, next, next + 1]]);
        }
    }
    Fault::new("F", mesh)
}

#[cfg(test)]
mod tests {
    use super::*;
    use survey::geometry::VerticalUnit;

    fn geometry() -> SurveyGeometry {
        SurveyGeometry::regular([41, 31, 61], 25.0, 10.0, VerticalUnit::Metres)
    }

    /// Centre line, horizons and slope checks that hold for any model with an exact k.
    fn check(model: &ClosedForm) {
        let step = model.geometry.metric_from_voxel();
        let mut seen = 0;
        for n in 0..31 * 41 * 61 {
            let p = DVec3::new((n / (31 * 61)) as f64, (n / 61 % 31) as f64, (n % 61) as f64);
            let Some(at) = model.exact_at(p) else { continue };
            assert!((0.0..=1.0).contains(&at.k), "{p}: {at:?}");
            seen += 1;
            // The isocurve is straight from p to the middle: there k is 1/2 and i, j are the same.
            let xy = DVec2::new(at.i * 40.0, at.j * 30.0);
            let top = model.stratigraphy.top_of(at.layer.into()).unwrap();
            let (above, below) =
                (model.sheet_z(top, at.block, xy.x, xy.y), model.sheet_z(top + 1, at.block, xy.x, xy.y));
            let surfaces = (&model.surfaces[top], &model.surfaces[top + 1]);
            let moved = model.displacement(at.block);
            let metric = |z: f64| step * xy.extend(z - moved);
            let (mut low, mut high) = (below, above);
            for _ in 0..60 {
                let z = 0.5 * (low + high);
                let k = parallel_k(surfaces.0, surfaces.1, metric(z)).unwrap().0;
                if k < 0.5 { low = z } else { high = z }
            }
            let (k, crossing) = parallel_k(surfaces.0, surfaces.1, metric(low)).unwrap();
            assert!((k - 0.5).abs() < 1e-9 && (crossing - metric(low)).length() < 1e-6);
        }
        assert!(seen > 1000);
    }

    #[test]
    fn planes_and_cylinders_know_their_middle() {
        let samples = [15.0, 28.0, 45.0];
        for model in [
            ClosedForm::flat(&geometry(), &samples),
            ClosedForm::dipping(&geometry(), &samples, 35.0, 20.0),
            ClosedForm::dome(&geometry(), &samples, 35.0),
        ] {
            check(&model);
            check(&model.with_fault(60.0, 6.0));
            check(&model.with_fault(50.0, -5.0));
        }
    }

    #[test]
    fn flat_layers_are_linear() {
        let model = ClosedForm::flat(&geometry(), &[10.0, 30.0, 40.0]);
        let at = model.exact_at(DVec3::new(10.0, 15.0, 25.0)).unwrap();
        assert!((at.k - 0.25).abs() < 1e-12 && (at.i - 0.25).abs() < 1e-12 && (at.j - 0.5).abs() < 1e-12);
        assert_eq!((at.layer, at.block), (2, 0));
        assert_eq!(model.exact_at(DVec3::new(1.0, 1.0, 50.0)), None, "the open layer below");
    }

    #[test]
    fn distances_to_dipping_planes_and_the_dome_agree_with_dense_sampling() {
        for model in [
            ClosedForm::dipping(&geometry(), &[20.0, 40.0], 35.0, 0.0),
            ClosedForm::dome(&geometry(), &[20.0, 40.0], 35.0),
        ] {
            let step = model.geometry.metric_from_voxel();
            let p = DVec3::new(24.0, 15.0, 30.0);
            let distance = |horizon: usize| {
                let place = |n: i32| p.x + f64::from(n) * 0.001;
                (-8000..8000)
                    .map(|n| DVec3::new(place(n), p.y, model.sheet_z(horizon, 0, place(n), p.y)))
                    .map(|q| (step * (q - p)).length())
                    .fold(f64::INFINITY, f64::min)
            };
            let (top, bottom) = (distance(0), distance(1));
            let k = model.exact_at(p).unwrap().k;
            assert!((k - bottom / (bottom + top)).abs() < 1e-5, "{k}");
        }
    }

    #[test]
    fn a_fault_splits_sheets_and_its_mesh_is_on_its_plane() {
        let flat = ClosedForm::flat(&geometry(), &[30.0]);
        let normal = flat.with_fault(60.0, 6.0);
        assert_eq!(normal.horizons[0].sheets.len(), 2);
        let holes = |m: &ClosedForm| {
            let [a, b] = [0, 1].map(|s| &m.horizons[0].sheets[s].depth);
            let count = |want: usize| {
                a.iter().zip(b).filter(|(a, b)| usize::from(a.is_finite()) + usize::from(b.is_finite()) == want).count()
            };
            (count(0), count(2))
        };
        // Heave of a normal fault: 60 m of throw at 60° is 1.4 bins wide; the reverse fault overlaps by 60 m
        // at 45°.
        let (gap, double) = holes(&normal);
        assert!(gap >= 31 && double == 0);
        let (gap, double) = holes(&flat.with_fault(45.0, -6.0));
        assert!(gap == 0 && double >= 2 * 31);
        for &vertex in &normal.faults[0].mesh.vertices {
            let voxel = normal.geometry.voxel_from_world(vertex);
            assert!((voxel.x - normal.fault.unwrap().x_at(voxel.z)).abs() < 1e-9);
        }
    }

    #[test]
    fn an_erosion_surface_cuts_what_rises_above_it() {
        let model = ClosedForm::unconformity(&geometry(), 20.0, &[25.0, 40.0], 30.0, 0.0);
        assert_eq!(model.stratigraphy.horizons[0].contact, Contact::Erosional);
        assert!(model.horizons[1].sheets[0].node_count() < 41 * 31);
        assert_eq!(model.horizon_z(1, 0, 0.0, 0.0), 20.0);
        assert_eq!(model.layer_at(DVec3::new(10.0, 0.0, 21.0)), 1, "the layer above H2 is gone there");
    }

    #[test]
    fn folds_reach_their_dip_and_thickness() {
        let model = ClosedForm::folded(&geometry(), &[20.0, 32.0, 44.0], 32.0, 0.3);
        let (mut steepest, mut thickness) = (0.0f64, [f64::INFINITY, 0.0f64]);
        for x in 0..400 {
            for y in 0..30 {
                let at = |h, x: f64| model.sheet_z(h, 0, x, f64::from(y)) * 10.0;
                let x = f64::from(x) * 0.1;
                steepest = steepest.max((at(0, x + 0.01) - at(0, x)) / 0.25);
                let t = (at(1, x) - at(0, x)) / 120.0;
                thickness = [thickness[0].min(t), thickness[1].max(t)];
            }
        }
        assert!(steepest.atan().to_degrees() > 30.0, "{steepest}");
        assert!(thickness[0] < 0.75 && thickness[0] > 0.69 && thickness[1] > 1.25 && thickness[1] < 1.31);
    }
}
