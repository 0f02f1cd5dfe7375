//! The ground: the relief of the topmost horizon, found along a ray (P-illus 5).
//!
//! Everything in the topmost (open) layer is air. In the air a ray advances by a step that cannot cross a sheet: with
//! `gap` the vertical distance to the nearest sheet and s the steepest slope of the sheets,
//! `step = gap / (|d_z| + s·|d_xy|)`, never over a fault in one go and never shorter than [`SHORTEST_STEP`].
//! The first step that ends in rock is bisected. Crossing a fault into rock gives the fault scarp, whose normal is the
//! fault's.
//!
//! Departure: the paper marches a volume with empty-space skipping; the height fields themselves are exact and need none.
//!
//! Voxel space, f32; the shader `ground.wgsl` computes the same.

use crate::scene::{Ground, Scene};
use crate::visible::Ray;
use glam::{DVec3, Mat3, Vec3};
use rayon::prelude::*;
use survey::SurveyGeometry;
use survey::model::StructuralModel;

/// Shortest step through the air, voxels: ridges thinner than this can be missed.
pub const SHORTEST_STEP: f32 = 0.25;
/// Halvings of the last step: 0.25 voxel down to 2⁻⁸ voxel.
pub const BISECTIONS: u32 = 6;
/// Steps after which a ray is taken to miss.
pub const MAX_STEPS: u32 = 4096;
/// Steeper sheets than this are stepped over as if they had this slope.
const STEEPEST: f32 = 3.0;
/// Nodes from one that is asked for its height to the next.
const STRIDE: usize = 2;
/// How far the sheets may reach beyond the heights found at lattice nodes, voxels.
const HEIGHT_MARGIN: f32 = 1.0;

/// The relief in a roaming box.
#[derive(Debug, Clone, PartialEq)]
pub struct Relief {
    /// Heights between which the ground lies, voxel z.
    pub z_range: [f32; 2],
    /// Steepest slope of the sheets, voxels per voxel.
    pub steepest: f32,
    /// Longest voxel edge, m.
    pub longest_m: f32,
    /// Direction to the light in display space.
    pub light: Vec3,
    /// Strength of the hill shading.
    pub hill_shade: f32,
    /// Voxel covector → display covector.
    pub display_normal_from_voxel: Mat3,
}

/// What a place in the block is, and how far the next thing is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Layer, 0 = deepest; the topmost one is air.
    pub layer: u16,
    /// Fault block.
    pub block: u16,
    /// Vertical distance to the nearest sheet, voxels.
    pub gap: f32,
    /// The horizon of that sheet.
    pub horizon: usize,
    /// Offset from the nearest fault, m.
    pub fault_m: f32,
    /// That fault.
    pub fault: usize,
}

/// A point of the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroundHit {
    /// Distance along the ray, voxels.
    pub t: f32,
    /// Where, just inside the rock.
    pub point: Vec3,
    /// What is there.
    pub place: Place,
    /// Normal as a voxel covector, pointing into the air.
    pub normal: Vec3,
}

impl Relief {
    /// The relief of a model in a scene's box.
    pub fn new(ground: &Ground, scene: &Scene, geometry: &SurveyGeometry, model: &StructuralModel) -> Self {
        let view = scene.view(geometry);
        let roaming_box = scene.box_in(geometry);
        let (z_range, steepest) = heights(model, roaming_box.low().as_vec3(), roaming_box.high().as_vec3());
        let bearing = (scene.camera.azimuth_for(geometry, &roaming_box) + f64::from(ground.light_deg)).to_radians();
        let metric = geometry.metric_from_voxel();
        let longest = metric.x_axis.length().max(metric.y_axis.length()).max(metric.z_axis.length());
        Self {
            z_range,
            steepest,
            longest_m: longest as f32,
            light: DVec3::new(bearing.sin(), bearing.cos(), 1.0).normalize().as_vec3(),
            hill_shade: ground.hill_shade,
            display_normal_from_voxel: view.display_from_voxel().inverse().transpose().as_mat3(),
        }
    }

    /// The first ground between distances `from` (in the air) and `to` along a ray.
    pub fn march(&self, model: &StructuralModel, ray: &Ray, from: f32, to: f32) -> Option<GroundHit> {
        let air = air_layer(model);
        let (start, end) = self.clip(ray, from, to)?;
        let d = ray.direction;
        let fall = d.z.abs() + self.steepest * d.truncate().length();
        let mut last_air = from;
        let mut air_block = place(model, ray.at(from)).block;
        let mut t = start;
        for _ in 0..MAX_STEPS {
            let here = place(model, ray.at(t));
            if here.layer != air {
                return Some(self.refine(model, ray, (last_air, air_block), (t, here)));
            }
            if t >= end {
                return None;
            }
            (last_air, air_block) = (t, here.block);
            let to_fault = 0.8 * here.fault_m / self.longest_m;
            t = (t + (here.gap / fall).min(to_fault).max(SHORTEST_STEP)).min(end);
        }
        None
    }

    /// The part of a stretch in which the ground can be.
    fn clip(&self, ray: &Ray, from: f32, to: f32) -> Option<(f32, f32)> {
        let [low, high] = self.z_range;
        let (z, dz) = (ray.origin.z, ray.direction.z);
        if dz.abs() < 1e-6 {
            return (z >= low).then_some((from, to));
        }
        let (a, b) = ((low - z) / dz, (high - z) / dz);
        let (start, end) = (from.max(a.min(b)), to.min(a.max(b)));
        (start < end).then_some((start, end))
    }

    /// Bisects between air and rock.
    fn refine(
        &self,
        model: &StructuralModel,
        ray: &Ray,
        (mut air_t, mut air_block): (f32, u16),
        (mut t, mut inside): (f32, Place),
    ) -> GroundHit {
        let air = air_layer(model);
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (air_t + t);
            let here = place(model, ray.at(middle));
            if here.layer == air {
                (air_t, air_block) = (middle, here.block);
            } else {
                (t, inside) = (middle, here);
            }
        }
        let point = ray.at(t);
        let normal = if inside.block == air_block {
            let slope = model.sheet(inside.horizon, inside.block).sample(point.x, point.y).gradient;
            slope.extend(-1.0)
        } else {
            let normal = model.faults().surfaces()[inside.fault].frame_from_voxel.row(2).as_vec3();
            normal * -normal.dot(ray.direction).signum()
        };
        GroundHit { t, point, place: inside, normal }
    }

    /// The hill-shading factor of a slope: 1 where it is flat.
    pub fn shade(&self, normal: Vec3) -> f32 {
        let n = (self.display_normal_from_voxel * normal).normalize_or_zero();
        let lit = n.dot(self.light).max(0.0) / self.light.z;
        1.0 + self.hill_shade * (lit - 1.0).min(0.5)
    }
}

/// The layer that is air when the ground is shown.
pub fn air_layer(model: &StructuralModel) -> u16 {
    (model.layer_count() - 1) as u16
}

/// What is at a voxel position.
pub fn place(model: &StructuralModel, p: Vec3) -> Place {
    let faults = model.faults();
    let mut bits = 0u64;
    let (mut fault, mut fault_m) = (0, f32::MAX);
    for f in 0..faults.surfaces().len() {
        let side = faults.side(f, p);
        bits |= u64::from(side >= 0.0) << f;
        if side.abs() < fault_m {
            (fault, fault_m) = (f, side.abs());
        }
    }
    let block = faults.block_of(bits);
    let mut below = 0u64;
    let (mut horizon, mut gap) = (0, f32::MAX);
    for h in 0..model.stratigraphy().horizons.len() {
        let z = model.sheet(h, block).z_at(p.x, p.y);
        below |= u64::from(p.z >= z) << h;
        if (z - p.z).abs() < gap {
            (horizon, gap) = (h, (z - p.z).abs());
        }
    }
    Place { layer: model.rules().layer(below), block, gap, horizon, fault_m, fault }
}

/// Range of the ground's heights over the nodes of a box, and its steepest slope between nodes. Of each block only the part that it
/// owns counts: sheets extended beyond it may be steep.
fn heights(model: &StructuralModel, low: Vec3, high: Vec3) -> ([f32; 2], f32) {
    let nodes = |axis: usize| low[axis].floor() as i32..high[axis].ceil() as i32 + 1;
    let blocks = model.block_count() as u16;
    let column = |x: i32| {
        let (mut range, mut steepest) = ([f32::MAX, f32::MIN], 0.0f32);
        for block in 0..blocks {
            for y in nodes(1).step_by(STRIDE) {
                let ground = |x: i32, y: i32| model.horizon_z(0, block, x as f32, y as f32);
                let z = ground(x, y);
                if model.block_at(Vec3::new(x as f32, y as f32, z)) == block {
                    range = [range[0].min(z), range[1].max(z)];
                    steepest = steepest.max((ground(x + 1, y) - z).hypot(ground(x, y + 1) - z));
                }
            }
        }
        (range, steepest)
    };
    let (range, steepest) = nodes(0)
        .step_by(STRIDE)
        .collect::<Vec<_>>()
        .into_par_iter()
        .map(column)
        .reduce(|| ([f32::MAX, f32::MIN], 0.0), |(a, s), (b, t)| ([a[0].min(b[0]), a[1].max(b[1])], s.max(t)));
    let steepest = (steepest * 1.5).min(STEEPEST);
    // Between the nodes that were asked the ground can rise as the sheets do.
    let margin = HEIGHT_MARGIN + STRIDE as f32 * steepest;
    ([range[0] - margin, range[1] + margin], steepest)
}
