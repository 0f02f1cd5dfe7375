//! The ground: the relief of the topmost horizon, intersected by rays (P-illus 5).
//!
//! Everything in the topmost (open) layer is air. A coarse map stores, for cells of a few voxels, a height
//! above which there is only air, so a ray skips most of the block cell by cell. Below that height it
//! advances by a step that cannot cross a sheet: with `gap` the vertical distance to the nearest sheet and s
//! the steepest slope of the ground, `step = gap / (|d_z| + s·|d_xy|)`. Here s is the steepest slope in the cell of the
//! map and the cells around it, as long as the step stays in them. The distance to the nearest fault
//! limits a step, too, and no step is shorter than `SHORTEST_STEP`. The step that ends in rock is refined: by the
//! secant method if it crosses a single sheet of one block, and by bisection otherwise. Where the ray crosses
//! a fault into rock, it hits the fault scarp, whose normal is that of the fault.
//!
//! Rays that are neighbours in the picture share the way through the air: one march of their middle ray with room around it
//! for all of them.
//!
//! The march evaluates only horizons that form the ground somewhere in the box ([`Relief::horizons`]). Deeper
//! ones cannot form it, and those truncated by an erosion surface do not change what is air.
//!
//! Departure: the paper marches through a volume with empty-space skipping. We use the height fields
//! themselves, which are exact.
//!
//! Voxel space, f32. The shader `ground.wgsl` computes the same, but takes the steepest slope of the whole ground: its steps
//! are shorter, and lead to the same point.

use crate::scene::{Ground, Scene};
use crate::visible::Ray;
use glam::{DVec3, Mat3, Vec2, Vec3};
use model::{Below, Region, StructuralModel};
use rayon::prelude::*;
use std::collections::BTreeSet;
use survey::SurveyGeometry;

/// Shortest step near the ground, voxels. Ridges thinner than this can be missed.
pub(crate) const SHORTEST_STEP: f32 = 0.5;
/// Bisections of a last step to which the secant method does not apply: from half a voxel to 2⁻⁸ voxel.
pub(crate) const BISECTIONS: u32 = 7;
/// Largest number of steps; a ray that needs more misses the ground.
pub(crate) const MAX_STEPS: u32 = 4096;
/// Side of a cell of the coarse map, voxels.
pub const CELL: f32 = 4.0;
/// How far a ray that skips a cell enters the next one, voxels.
pub(crate) const INTO_CELL: f32 = 0.01;
/// Depth below the ground, or inside a surface of any shape, at which its layer is looked up, voxels: more than rounding.
pub(crate) const INTO_ROCK: f32 = 0.05;
/// Largest slope that step lengths take into account; steeper ground is treated as if it had this slope.
const STEEPEST: f32 = 3.0;
/// How much steeper than at its nodes the ground may be in a cell: a factor, and what is added.
const STEEPER: [f32; 2] = [1.5, 0.1];
/// Spacing of the nodes at which the height is evaluated, voxels.
const STRIDE: usize = 2;
/// How far the ground may reach beyond the heights found at nodes, voxels, in addition to what its slope
/// allows.
const HEIGHT_MARGIN: f32 = 1.0;

/// The relief in a roaming box.
#[derive(Debug, Clone, PartialEq)]
pub struct Relief {
    /// Range of the heights of the ground, voxel z.
    pub z_range: [f32; 2],
    /// Steepest slope of the ground, voxels per voxel, with a margin.
    pub steepest: f32,
    /// Horizons that form the ground somewhere in the box.
    pub horizons: Vec<usize>,
    /// Smallest x, y of the coarse map, voxels.
    pub map_low: Vec2,
    /// Cells of the map along x and y.
    pub map_cells: [usize; 2],
    /// Voxel z above which (smaller z) a cell contains only air, `[x][y]`.
    pub map_tops: Vec<f32>,
    /// Steepest slope of the ground in a cell and those around it, `[x][y]`.
    pub map_slopes: Vec<f32>,
    /// Longest voxel edge, m.
    pub longest_m: f32,
    /// Direction to the light in display space.
    pub light: Vec3,
    /// Strength of the hill shading.
    pub hill_shade: f32,
    /// Opacity.
    pub opacity: f32,
    /// Map from voxel covectors to display covectors.
    pub display_normal_from_voxel: Mat3,
}

/// The corners between which the ground of a scene lies.
pub(crate) fn corners(scene: &Scene, geometry: &SurveyGeometry) -> [Vec3; 2] {
    let roaming_box = scene.box_in(geometry);
    [roaming_box.low().as_vec3(), roaming_box.high().as_vec3()]
}

/// What the march needs to know about a point.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Probe {
    is_rock: bool,
    block: u16,
    /// Vertical distance to the nearest sheet of [`Relief::horizons`], voxels, and the horizon of that sheet; to a surface
    /// of any shape, the distance.
    gap: f32,
    horizon: usize,
    /// The horizons at or below which it lies.
    below: Below,
    /// Distance from the nearest fault, m, and that fault.
    fault_m: f32,
    fault: usize,
}

impl Probe {
    /// Whether between here and there lies only the horizon that is the nearest of both.
    fn crosses_only_the_nearest(&self, there: &Self) -> bool {
        let nearest = self.horizon == there.horizon && self.below.differs_only_at(there.horizon, &there.below);
        self.block == there.block && nearest
    }
}

/// A point of the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroundHit {
    /// Distance along the ray, voxels.
    pub t: f32,
    /// The hit point.
    pub point: Vec3,
    /// Its layer and block.
    pub region: Region,
    /// Normal as a voxel covector, pointing into the air.
    pub normal: Vec3,
}

impl Relief {
    /// The relief of a model in a scene's box.
    pub fn new(ground: &Ground, scene: &Scene, geometry: &SurveyGeometry, model: &StructuralModel) -> Self {
        let [low, high] = corners(scene, geometry);
        Self::over(&Heights::of(model, low, high), ground, scene, geometry)
    }

    /// The relief over heights of a scene's box.
    pub(crate) fn over(heights: &Heights, ground: &Ground, scene: &Scene, geometry: &SurveyGeometry) -> Self {
        let view = scene.view(geometry);
        let roaming_box = scene.box_in(geometry);
        let bearing = (scene.camera.azimuth_for(geometry, &roaming_box) + f64::from(ground.light_deg)).to_radians();
        let metric = geometry.metric_from_voxel();
        let longest = metric.x_axis.length().max(metric.y_axis.length()).max(metric.z_axis.length());
        Self {
            z_range: heights.z_range,
            steepest: heights.steepest,
            horizons: heights.horizons.clone(),
            map_low: roaming_box.low().as_vec3().truncate(),
            map_cells: heights.cells,
            map_tops: heights.tops.clone(),
            map_slopes: heights.slopes.clone(),
            longest_m: longest as f32,
            light: DVec3::new(bearing.sin(), bearing.cos(), 1.0).normalize().as_vec3(),
            hill_shade: ground.hill_shade,
            opacity: ground.opacity,
            display_normal_from_voxel: view.display_from_voxel().inverse().transpose().as_mat3(),
        }
    }

    /// Whether a point of the box is air.
    pub fn is_air(&self, model: &StructuralModel, p: Vec3) -> bool {
        // Below the deepest ground there is rock; a surface of any shape may overhang.
        if p.z > self.z_range[1] && !model.has_levels() {
            return false;
        }
        !self.probe(model, p).is_rock
    }

    /// A distance between two others up to which rays of a bundle are in air, if all are at the first. The bundle follows
    /// its middle ray: where a sheet of slope s is farther than R·(1 + s) from it, with R the radius of the bundle, no ray
    /// has met it.
    pub(crate) fn clear_until(&self, model: &StructuralModel, rays: &[Ray], [enter, exit]: [f32; 2]) -> f32 {
        if enter >= exit {
            return enter;
        }
        let middle = &rays[rays.len() / 2];
        let away = |ray: &Ray| [enter, exit].map(|t| ray.at(t).distance(middle.at(t)));
        let radius = rays.iter().flat_map(away).fold(0.0, f32::max);
        if radius > CELL {
            return enter;
        }
        let [down, along] = [middle.direction.z.abs(), middle.direction.truncate().length()];
        let has_levels = model.has_levels();
        // The slope of a cell holds for a cell's side around it.
        let farthest = (CELL - radius) / along.max(1e-6);
        let mut t = enter;
        for _ in 0..MAX_STEPS {
            t = self.skip(middle, t, exit, radius);
            if t >= exit {
                return exit;
            }
            let here = self.probe(model, middle.at(t));
            let slope = if has_levels { self.steepest } else { self.map_slopes[self.cell_at(middle.at(t))] };
            let nearing = (down + slope * along).max(if has_levels { 1.0 } else { 1e-6 });
            let to_ground = (here.gap - radius * (1.0 + slope)) / nearing;
            let to_fault = 0.8 * here.fault_m / self.longest_m - radius;
            let step = to_ground.min(to_fault).min(farthest);
            if here.is_rock || step < SHORTEST_STEP {
                return t;
            }
            t += step;
        }
        t
    }

    /// The first hit of the ground along a ray between distances `from` (in the air) and `to`.
    pub fn march(&self, model: &StructuralModel, ray: &Ray, from: f32, to: f32) -> Option<GroundHit> {
        let (start, end) = self.clip(ray, from, to)?;
        let [down, along] = [ray.direction.z.abs(), ray.direction.truncate().length()];
        let has_levels = model.has_levels();
        // The slope of a cell holds for a cell's side around it.
        let farthest = CELL / along.max(1e-6);
        let (mut air_t, mut air) = (from, None);
        let mut t = start;
        for _ in 0..MAX_STEPS {
            let skipped = self.skip(ray, t, end, 0.0);
            if skipped > t {
                (air_t, air) = ((skipped - 2.0 * INTO_CELL).max(air_t), None);
            }
            t = skipped;
            let here = self.probe(model, ray.at(t));
            if here.is_rock {
                return Some(self.refine(model, ray, (air_t, air), (t, here)));
            }
            if t >= end {
                return None;
            }
            (air_t, air) = (t, Some(here));
            let to_fault = 0.8 * here.fault_m / self.longest_m;
            let to_ground = if has_levels {
                // A surface of any shape may lie in any direction.
                here.gap / (down + self.steepest * along).max(1.0)
            } else {
                let slope = self.map_slopes[self.cell_at(ray.at(t))];
                (here.gap / (down + slope * along).max(1e-6)).min(farthest)
            };
            t = (t + to_ground.min(to_fault).max(SHORTEST_STEP)).min(end);
        }
        None
    }

    /// Number of the cell of the coarse map in which a point lies, or the nearest one.
    fn cell_at(&self, p: Vec3) -> usize {
        let last = Vec2::new(self.map_cells[0] as f32, self.map_cells[1] as f32) - 1.0;
        let cell = ((p.truncate() - self.map_low) / CELL).floor().clamp(Vec2::ZERO, last);
        cell.x as usize * self.map_cells[1] + cell.y as usize
    }

    /// The first distance at or after `t` at which the coarse map does not exclude rock within `radius` (at most [`CELL`]).
    fn skip(&self, ray: &Ray, mut t: f32, end: f32, radius: f32) -> f32 {
        let d = ray.direction;
        for _ in 0..MAX_STEPS {
            let p = ray.at(t);
            let place = (p.truncate() - self.map_low) / CELL;
            let last = Vec2::new(self.map_cells[0] as f32, self.map_cells[1] as f32) - 1.0;
            let cell = place.floor().clamp(Vec2::ZERO, last);
            let top = self.map_tops[cell.x as usize * self.map_cells[1] + cell.y as usize] - radius;
            if p.z >= top || t >= end {
                break;
            }
            let mut step = f32::MAX;
            for axis in 0..2 {
                if d[axis].abs() > 1e-6 {
                    let border = self.map_low[axis] + (cell[axis] + if d[axis] > 0.0 { 1.0 } else { 0.0 }) * CELL;
                    step = step.min(((border - p[axis]) / d[axis]).max(0.0) + INTO_CELL);
                }
            }
            if d.z > 1e-6 {
                step = step.min((top - p.z) / d.z + 1e-4);
            }
            t = (t + step).min(end);
        }
        t
    }

    /// The part of an interval of the ray in which the ground can be.
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

    /// Refines a step that leads from air into rock.
    fn refine(
        &self,
        model: &StructuralModel,
        ray: &Ray,
        (mut air_t, air): (f32, Option<Probe>),
        (mut t, mut inside): (f32, Probe),
    ) -> GroundHit {
        let mut air_block = air.map_or_else(|| self.probe(model, ray.at(air_t)).block, |air| air.block);
        match air {
            Some(air) if air.crosses_only_the_nearest(&inside) => {
                t = air_t + (t - air_t) * air.gap / (air.gap + inside.gap).max(1e-12);
            }
            _ => {
                for _ in 0..BISECTIONS {
                    let middle = 0.5 * (air_t + t);
                    let here = self.probe(model, ray.at(middle));
                    if here.is_rock {
                        (t, inside) = (middle, here);
                    } else {
                        (air_t, air_block) = (middle, here.block);
                    }
                }
            }
        }
        let point = ray.at(t);
        // Below the underside of a body there is air.
        let mut inwards = Vec3::Z;
        let normal = if air_block == inside.block {
            match model.level(inside.horizon, inside.block) {
                Some(level) => {
                    let slope = level.sample_m(point).1;
                    inwards = slope.normalize_or(Vec3::Z);
                    -slope
                }
                None => {
                    let slope = model.sheet(inside.horizon, inside.block).sample(point.x, point.y).gradient;
                    slope.extend(-1.0)
                }
            }
        } else {
            let normal = model.faults().surfaces()[inside.fault].frame_from_voxel.row(2).as_vec3();
            if normal.dot(ray.direction) > 0.0 { -normal } else { normal }
        };
        let mut layer = model.layer_at(point + inwards * INTO_ROCK, inside.block);
        if layer == air_layer(model) {
            layer = model.layer_at(ray.at(t + 2.0 * INTO_ROCK), inside.block);
        }
        GroundHit { t, point, region: Region { layer, block: inside.block }, normal }
    }

    /// What the march needs to know about a point.
    fn probe(&self, model: &StructuralModel, p: Vec3) -> Probe {
        let (block, fault, fault_m) = block_and_fault(model, p);
        let mut below = Below::default();
        let (mut horizon, mut gap) = (0, f32::MAX);
        for &h in &self.horizons {
            let offset = match model.level(h, block) {
                Some(level) => level.offset_m(p) / self.longest_m,
                None => p.z - model.sheet(h, block).z_at(p.x, p.y),
            };
            below = below.with(h, offset >= 0.0);
            if offset.abs() < gap {
                (horizon, gap) = (h, offset.abs());
            }
        }
        let is_rock = model.rules().layer(&below) != air_layer(model);
        Probe { is_rock, block, gap, horizon, below, fault_m, fault }
    }

    /// The hill-shading factor of a slope; 1 if it is flat.
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

/// Whether a voxel position is air when the ground is shown, according to all horizons.
pub fn is_air(model: &StructuralModel, p: Vec3) -> bool {
    model.region_at(p).layer == air_layer(model)
}

/// The block at a voxel position, the nearest fault, and the distance from it in metres.
fn block_and_fault(model: &StructuralModel, p: Vec3) -> (u16, usize, f32) {
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
    (faults.block_of(bits), fault, fault_m)
}

/// Heights of the ground in a box.
#[derive(Debug)]
pub(crate) struct Heights {
    z_range: [f32; 2],
    pub(crate) steepest: f32,
    pub(crate) horizons: Vec<usize>,
    cells: [usize; 2],
    tops: Vec<f32>,
    slopes: Vec<f32>,
}

/// Heights of the ground over a row of nodes along y.
struct HeightRow {
    /// Smallest and largest voxel z per node.
    ranges: Vec<[f32; 2]>,
    /// Steepest slope per node.
    slopes: Vec<f32>,
    /// The horizons that form the ground or nearly do.
    horizons: BTreeSet<usize>,
}

impl HeightRow {
    /// Evaluates the nodes at `x`. Only the part of a sheet that lies in its own block counts; sheets that
    /// are extended beyond it may be steep.
    fn of(model: &StructuralModel, x: f32, ys: &[f32]) -> Self {
        let ranges = vec![[f32::MAX, f32::MIN]; ys.len()];
        let mut row = Self { ranges, slopes: vec![0.0; ys.len()], horizons: BTreeSet::new() };
        for block in 0..model.block_count() as u16 {
            for ((&y, range), steepest) in ys.iter().zip(&mut row.ranges).zip(&mut row.slopes) {
                let ground = |x: f32, y: f32| model.horizon_z(0, block, x, y);
                let z = ground(x, y);
                if model.block_at(Vec3::new(x, y, z)) != block {
                    continue;
                }
                *range = [range[0].min(z), range[1].max(z)];
                // A body may stand out of the ground.
                for h in (0..model.stratigraphy().horizons.len()).filter(|&h| model.is_body(h)) {
                    let top = model.sheet(h, block).z_at(x, y);
                    row.horizons.extend((top <= z + HEIGHT_MARGIN).then_some(h));
                    range[0] = range[0].min(top);
                }
                let slope = (ground(x + 1.0, y) - z).hypot(ground(x, y + 1.0) - z);
                *steepest = steepest.max(slope);
                for h in 0..model.stratigraphy().horizons.len() {
                    let near = HEIGHT_MARGIN + STRIDE as f32 * slope;
                    row.horizons.extend(((model.sheet(h, block).z_at(x, y) - z).abs() <= near).then_some(h));
                }
            }
        }
        row
    }
}

impl Heights {
    pub(crate) fn of(model: &StructuralModel, low: Vec3, high: Vec3) -> Self {
        let nodes = |axis: usize| -> Vec<f32> {
            let count = ((high[axis] - low[axis]) / STRIDE as f32).ceil() as usize;
            (0..=count).map(|n| (low[axis] + (n * STRIDE) as f32).min(high[axis])).collect()
        };
        let (xs, ys) = (nodes(0), nodes(1));
        let rows: Vec<HeightRow> = xs.par_iter().map(|&x| HeightRow::of(model, x, &ys)).collect();
        let steepest = rows.iter().flat_map(|row| &row.slopes).copied().fold(0.0, f32::max);
        let steepest = (steepest * 1.5).min(STEEPEST);
        // Between the evaluated nodes the ground can rise as far as its slope allows.
        let margin = HEIGHT_MARGIN + STRIDE as f32 * steepest;
        let cells = [xs.len(), ys.len()].map(|nodes| ((nodes - 1) * STRIDE).div_ceil(CELL as usize).max(1));
        let mut own = vec![f32::MAX; cells[0] * cells[1]];
        let mut own_slopes = vec![0.0_f32; own.len()];
        let mut z_range = [f32::MAX, f32::MIN];
        for (x, row) in rows.iter().enumerate() {
            for (y, [top, base]) in row.ranges.iter().enumerate() {
                let cell = |node: usize, axis: usize| (node * STRIDE / CELL as usize).min(cells[axis] - 1);
                let cell = cell(x, 0) * cells[1] + cell(y, 1);
                own[cell] = own[cell].min(*top);
                own_slopes[cell] = own_slopes[cell].max(row.slopes[y]);
                z_range = [z_range[0].min(*top), z_range[1].max(*base)];
            }
        }
        let around = |x: usize, axis: usize| x.saturating_sub(1)..=(x + 1).min(cells[axis] - 1);
        let beside = |n: usize| {
            around(n / cells[1], 0).flat_map(move |x| around(n % cells[1], 1).map(move |y| x * cells[1] + y))
        };
        let tops = (0..own.len()).map(|n| beside(n).map(|cell| own[cell]).fold(f32::MAX, f32::min) - margin).collect();
        let [factor, more] = STEEPER;
        let slope = |n: usize| beside(n).map(|cell| own_slopes[cell]).fold(0.0, f32::max);
        let slopes = (0..own.len()).map(|n| (slope(n) * factor + more).min(STEEPEST)).collect();
        let found: BTreeSet<usize> = rows.iter().flat_map(|row| row.horizons.iter().copied()).collect();
        let mut horizons: Vec<usize> = found.into_iter().collect();
        if horizons.is_empty() && !model.stratigraphy().horizons.is_empty() {
            horizons.push(0);
        }
        Self { z_range: [z_range[0] - margin, z_range[1] + margin], steepest, horizons, cells, tops, slopes }
    }
}

#[cfg(test)]
mod tests;
