//! The structs that Rust and the shader share, field by field in the order and with the names of the shader.
//!
//! A test reads the WGSL with naga and compares every offset.

use crate::face_map::FaceMap;
use crate::resolved_scene::ResolvedScene;
use bytemuck::{Pod, Zeroable};
use glam::{DVec2, DVec3, Vec3};
use survey::block::{MAX_BODIES, MAX_PLANES};
use ttf::tables::NONE;

/// Side of a workgroup, pixels or cells.
pub(super) const WORKGROUP: u32 = 8;

/// Parameters of a picture and a tile.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(super) struct FaceParams {
    pub origin: [f32; 4],
    pub origin_dx: [f32; 4],
    pub origin_dy: [f32; 4],
    pub direction: [f32; 4],
    pub direction_dx: [f32; 4],
    pub direction_dy: [f32; 4],
    pub box_low: [f32; 4],
    pub box_high: [f32; 4],
    pub background: [f32; 4],
    pub voxel_m: [f32; 4],
    pub light: [f32; 4],
    pub display_normal_x: [f32; 4],
    pub display_normal_y: [f32; 4],
    pub display_normal_z: [f32; 4],
    pub relief: [f32; 4],
    pub reference_px: [f32; 2],
    pub samples: u32,
    pub cut_count: u32,
    pub map_low: [f32; 2],
    pub map_cells: [u32; 2],
    pub ground_horizons: u32,
    pub ground_opacity: f32,
    pub padding: [u32; 2],
    pub tile: [u32; 4],
    pub bodies: [[u32; 4]; BODIES],
    pub planes: [PlaneInfo; PLANES],
}

/// Largest number of bodies: the roaming box, and what is cut out.
pub(super) const BODIES: usize = 1 + MAX_BODIES;
/// Largest number of planes.
pub(super) const PLANES: usize = 6 + MAX_PLANES;

/// A plane of the block or of what is cut out.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable, Default)]
pub(super) struct PlaneInfo {
    pub normal: [f32; 4],
    pub metric_normal: [f32; 4],
    pub along: [f32; 2],
    pub shift: f32,
    pub axis: u32,
    pub metre_p: [f32; 4],
    pub metre_q: [f32; 4],
}

/// A height field in the pool. A horizon that is none has a level field there as well, and this is its topmost part.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(super) struct SheetInfo {
    pub origin: [i32; 2],
    pub size: [u32; 2],
    pub offset: u32,
    pub level: u32,
    pub at: f32,
    pub scale_m: f32,
}

/// A fault surface: the rows of its frame relative to the centre of the model, and its height field.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(super) struct FaultInfo {
    pub u: [f32; 4],
    pub v: [f32; 4],
    pub w: [f32; 4],
    pub surface: SheetInfo,
}

/// Counts and scales of the model.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(super) struct ModelInfo {
    pub centre: [f32; 4],
    pub horizons: u32,
    pub blocks: u32,
    pub faults: u32,
    pub layers: u32,
    pub unit_from_voxel: [f32; 2],
    pub padding: [f32; 2],
}

/// A region's stratigraphic grid.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(super) struct GridInfo {
    pub origin: [i32; 2],
    pub size: [u32; 2],
    pub levels: u32,
    pub first_column: u32,
    pub bottom_sheet: u32,
    pub top_sheet: u32,
    pub bottom_shift: f32,
    pub top_shift: f32,
    pub is_calm: u32,
    pub unfolded_i: u32,
    pub unfolded_j: u32,
    pub log_weight: u32,
    pub thickness_m: f32,
    pub padding: u32,
}

/// Size, scale and value ranges of the packed volume.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable, Default)]
pub(super) struct PackedInfo {
    pub scale: [f32; 4],
    pub size: [u32; 4],
    pub i_range: [f32; 2],
    pub j_range: [f32; 2],
    pub layers: u32,
    pub blocks: u32,
    pub padding: [u32; 2],
}

/// The bodies of the block, each as its first plane and their count, and their planes.
fn bodies(resolved: &ResolvedScene) -> ([[u32; 4]; BODIES], [PlaneInfo; PLANES]) {
    let (mut bodies, mut planes) = ([[0; 4]; BODIES], [PlaneInfo::default(); PLANES]);
    let mut next = 0;
    let all = std::iter::once(&resolved.solid.block).chain(&resolved.solid.cut_outs);
    for (to, body) in bodies.iter_mut().zip(all) {
        *to = [next as u32, body.planes.len() as u32, 0, 0];
        for (to, plane) in planes[next..].iter_mut().zip(&body.planes) {
            let FaceMap { frame, metre_steps, .. } = resolved.face_map(plane);
            let [metre_p, metre_q] = metre_steps.map(|step| step.extend(0.0).to_array());
            *to = PlaneInfo {
                normal: plane.normal.extend(plane.offset).to_array(),
                metric_normal: Vec3::from_array(frame.normal).extend(resolved.tone(plane)).to_array(),
                along: frame.along,
                shift: frame.shift,
                axis: plane.axis.map_or(NONE, |axis| axis as u32),
                metre_p,
                metre_q,
            };
        }
        next += body.planes.len();
    }
    (bodies, planes)
}

/// The horizons and the coarse map of the ground, as 32-bit words for the shader.
pub(super) fn relief_map(resolved: &ResolvedScene) -> Vec<u32> {
    let Some(relief) = &resolved.relief else { return Vec::new() };
    let horizons = relief.horizons.iter().map(|&h| h as u32);
    horizons.chain(relief.map_tops.iter().map(|top| top.to_bits())).collect()
}

impl FaceParams {
    /// The parameters of a picture, without its tile.
    pub(super) fn of(resolved: &ResolvedScene) -> Self {
        let [width, height] = resolved.scene.size_px;
        let reference = DVec2::new(f64::from(width), f64::from(height)) * 0.5;
        let ray = resolved.view.ray(reference);
        let four = |v: DVec3| v.as_vec3().extend(0.0).to_array();
        let plain = |v: Vec3| v.extend(0.0).to_array();
        let (bodies, planes) = bodies(resolved);
        let mut params = Self {
            origin: four(ray.origin),
            origin_dx: four(ray.origin_step[0]),
            origin_dy: four(ray.origin_step[1]),
            direction: four(ray.direction),
            direction_dx: four(ray.direction_step[0]),
            direction_dy: four(ray.direction_step[1]),
            box_low: plain(resolved.solid.roaming_box[0]),
            box_high: plain(resolved.solid.roaming_box[1]),
            background: resolved.background,
            voxel_m: plain(resolved.voxel_m),
            reference_px: reference.as_vec2().to_array(),
            samples: resolved.scene.samples,
            cut_count: resolved.solid.cut_outs.len() as u32,
            map_cells: [1; 2],
            ground_opacity: 1.0,
            bodies,
            planes,
            ..Self::zeroed()
        };
        if let Some(relief) = &resolved.relief {
            params.light = relief.light.extend(relief.hill_shade).to_array();
            params.display_normal_x = plain(relief.display_normal_from_voxel.x_axis);
            params.display_normal_y = plain(relief.display_normal_from_voxel.y_axis);
            params.display_normal_z = plain(relief.display_normal_from_voxel.z_axis);
            params.map_low = relief.map_low.to_array();
            params.map_cells = relief.map_cells.map(|n| n as u32);
            params.ground_horizons = relief.horizons.len() as u32;
            params.ground_opacity = relief.opacity;
            params.relief = [relief.z_range[0], relief.z_range[1], relief.steepest, relief.longest_m];
        }
        params
    }
}
