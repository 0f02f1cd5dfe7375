//! The media on the GPU: parameters, words and textures of `media.wgsl`.
//!
//! Everything of variable length (tables, opacities, bricks, styles) lies in the buffer of 32-bit words that
//! also holds the map of the ground, since some adapters have few storage bindings.

use crate::camera::View;
use crate::error::RenderError;
use crate::gpu::Gpu;
use crate::inputs::CandidateVolume;
use crate::leaves::FaceData;
use crate::media::bricks::LayerAppearance;
use crate::media::field::MediaField;
use crate::media::light_grid::{LightGrid, cells_from_voxel};
use crate::media::medium::{FieldMedium, Zone};
use crate::media::table::{ENTRIES, FunctionTable};
use crate::media::{Faces, MAX_MEDIA, Scope, Shading};
use crate::resolved_scene::ResolvedScene;
use bytemuck::{Pod, Zeroable};
use glam::{DVec2, DVec3, Mat3, Vec3};
use ttf::tables::NONE;

/// A medium, in the layout of the shader.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable, Default)]
pub(super) struct MediumInfo {
    pub low: f32,
    pub scale: f32,
    pub slot: u32,
    pub table: u32,
    pub layers: u32,
    pub zone: u32,
    pub coloured: u32,
    pub shades: u32,
}

/// The media of a scene, in the layout of the shader.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(super) struct MediaParams {
    pub display_x: [f32; 4],
    pub display_y: [f32; 4],
    pub display_z: [f32; 4],
    pub covector_x: [f32; 4],
    pub covector_y: [f32; 4],
    pub covector_z: [f32; 4],
    pub light: [f32; 4],
    pub phong: [f32; 4],
    pub cells_x: [f32; 4],
    pub cells_y: [f32; 4],
    pub cells_z: [f32; 4],
    pub cells_shift: [f32; 4],
    pub cells_low: [f32; 4],
    pub back: [f32; 4],
    pub right: [f32; 4],
    pub up: [f32; 4],
    pub forward: [f32; 4],
    pub grid: [f32; 4],
    pub cells: [u32; 4],
    pub bricks: [u32; 4],
    pub scales: [f32; 4],
    pub candidates: [u32; 4],
    pub leaves: [u32; 4],
    pub slice_units: f32,
    pub groups: u32,
    pub wells: u32,
    pub capsules: u32,
    pub media: [MediumInfo; MAX_MEDIA],
}

/// Number of words in the record of a part of a layer.
const SHADE_WORDS: u32 = 5;
/// Number of words in the record of a horizon.
pub(super) const HORIZON_WORDS: usize = 12;

/// The constants of a pipeline that depend on media: their names in the shader, and their values.
pub(super) fn constants(resolved: &ResolvedScene) -> [(&'static str, u32); 9] {
    let faces_shown = match resolved.scene.media.faces {
        Faces::All => 0,
        Faces::CutOuts => 1,
        Faces::None => 2,
    };
    let face_data = match (resolved.scene.face_data, resolved.candidates.is_some()) {
        (FaceData::Leaves, true) => 1,
        (FaceData::Distance, true) => 2,
        _ => 0,
    };
    let field = resolved.field.as_ref();
    let shading = field.map_or(0, |field| match field.shading {
        Shading::Unshaded => 0,
        // The two shadings are drawn as separate scenes.
        Shading::Phong(_) | Shading::Interleaved(_) => 1,
        Shading::Occlusion(_) => 2,
    });
    [
        ("face_data", face_data),
        ("faces_shown", faces_shown),
        ("with_wells", u32::from(resolved.tubes.is_some())),
        ("with_media", u32::from(field.is_some())),
        ("shading", shading),
        ("isosurfaces", field.map_or(0, |field| field.isosurfaces.len() as u32)),
        ("media_count", field.map_or(0, |field| field.media.len() as u32)),
        ("with_leaves", u32::from(field.is_some_and(|field| field.horizons.is_some()))),
        ("with_layers", u32::from(field.is_some_and(|field| field.media.iter().any(|m| m.layers.is_some())))),
    ]
}

/// The horizon candidates that a picture shows.
pub(super) fn candidates_of<'f, 'a>(resolved: &'f ResolvedScene<'a>) -> Option<&'f CandidateVolume<'a>> {
    let of_field = resolved.field.as_ref().and_then(|field| field.horizons.as_ref()).map(|h| &h.candidates);
    resolved.candidates.as_ref().or(of_field)
}

/// The grid in which light is propagated, if the scene has occlusion.
pub(super) fn light_grid(resolved: &ResolvedScene) -> Option<LightGrid> {
    let field = resolved.field.as_ref()?;
    let Shading::Occlusion(occlusion) = field.shading else { return None };
    Some(LightGrid::new(&occlusion, &resolved.view, &resolved.roaming_box, f64::from(field.unit_m)))
}

/// Appends the media to the words, and returns parameters with their positions.
pub(super) fn media_params(resolved: &ResolvedScene, grid: Option<&LightGrid>, words: &mut Vec<u32>) -> MediaParams {
    let mut params = MediaParams::zeroed();
    let plain = |v: Vec3| v.extend(0.0).to_array();
    let columns = |m: Mat3| [plain(m.x_axis), plain(m.y_axis), plain(m.z_axis)];
    [params.display_x, params.display_y, params.display_z] = columns(resolved.view.display_from_voxel().as_mat3());
    params.scales[3] = 1.0;
    params.leaves[3] = NONE;
    if let Some(candidates) = candidates_of(resolved) {
        let [x, y, z] = candidates.size.map(|n| n as u32);
        params.candidates = [x, y, z, 0];
        params.scales[3] = candidates.voxels_per_step;
        if let Some(groups) = candidates.groups {
            params.leaves[3] = words.len() as u32;
            params.groups = groups.len() as u32;
            words.extend_from_slice(groups);
        }
    }
    if let Some(tubes) = &resolved.tubes {
        params.wells = words.len() as u32;
        params.capsules = tubes.capsules.len() as u32;
        for capsule in &tubes.capsules {
            let [a, b] = capsule.ends;
            let [red, green, blue] = capsule.colour;
            add(words, &[a.x, a.y, a.z, capsule.radius, b.x, b.y, b.z, red, green, blue]);
        }
    }
    let Some(field) = &resolved.field else { return params };
    [params.covector_x, params.covector_y, params.covector_z] = columns(field.display_normal_from_voxel);
    params.light = field.light.extend(1.0).to_array();
    if let Shading::Phong(phong) = field.shading {
        params.light[3] = phong.shininess;
        params.phong = [phong.ambient, phong.diffuse, phong.specular, 0.0];
    }
    if let Some(grid) = grid {
        set_light(&mut params, &resolved.view, grid);
    }
    params.scales = [field.samples_per_unit, field.unit_m, field.reach, params.scales[3]];
    for (info, medium) in params.media.iter_mut().zip(&field.media) {
        let table = add_table(words, &medium.table);
        let layers = medium.layers.as_ref().map_or(NONE, |appearance| add(words, appearance.entries.as_flattened()));
        let shades = medium.layers.as_ref().map_or(NONE, |appearance| add_shades(words, appearance));
        *info = MediumInfo {
            low: medium.table.low,
            scale: medium.table.scale,
            slot: slot(resolved, medium),
            table,
            layers,
            zone: u32::from(medium.zone == Zone::CutOut),
            coloured: u32::from(medium.layers.as_ref().is_some_and(|appearance| appearance.colours)),
            shades,
        };
    }
    let [x, y, z] = field.bricks.size.map(|n| n as u32);
    params.bricks = [x, y, z, words.len() as u32];
    words.extend_from_slice(&field.bricks.words);
    add_horizons(resolved, field, words, &mut params);
    params.cells[3] = words.len() as u32;
    for surface in &field.isosurfaces {
        let slot = surface.medium.as_ref().map_or(NONE, |medium| slot(resolved, medium));
        let [r, g, b] = surface.colour.to_array();
        add(words, &[r, g, b, surface.extinction, surface.thickness, surface.value]);
        words.extend([slot, 0]);
    }
    params
}

fn set_light(params: &mut MediaParams, view: &View, grid: &LightGrid) {
    let plain = |v: DVec3| v.as_vec3().extend(0.0).to_array();
    let (linear, shift) = cells_from_voxel(view, grid);
    let columns = [linear.x_axis, linear.y_axis, linear.z_axis].map(|c| c.extend(0.0).to_array());
    [params.cells_x, params.cells_y, params.cells_z] = columns;
    params.cells_shift = shift.extend(if grid.perspective { 1.0 } else { 0.0 }).to_array();
    let low = grid.low / grid.cell + 0.5;
    params.cells_low = [low.x as f32, low.y as f32, grid.near as f32, grid.slice as f32];
    let (back, forward) = view.depth_ray(DVec2::ZERO);
    let step = |flat: DVec2| {
        let (origin, direction) = view.depth_ray(flat);
        (origin - back) + (direction - forward)
    };
    params.back = plain(back);
    params.forward = plain(forward);
    params.right = plain(step(DVec2::X));
    params.up = plain(step(DVec2::Y));
    params.grid = [grid.low.x as f32, grid.low.y as f32, grid.cell as f32, grid.strength];
    params.cells = [grid.size[0] as u32, grid.size[1] as u32, grid.size[2] as u32, 0];
    params.slice_units = grid.slice_units;
}

fn slot(resolved: &ResolvedScene, medium: &FieldMedium) -> u32 {
    let position = resolved.tables.volumes.iter().position(|name| name == medium.volume.name);
    position.expect("the volumes of all media have a slot") as u32
}

fn add(words: &mut Vec<u32>, values: &[f32]) -> u32 {
    let first = words.len() as u32;
    words.extend(values.iter().map(|value| value.to_bits()));
    first
}

fn add_table(words: &mut Vec<u32>, table: &FunctionTable) -> u32 {
    debug_assert_eq!(table.entries.len(), ENTRIES);
    add(words, table.entries.as_flattened())
}

/// First word and number of the shades of each layer, and the shades; [`NONE`] if no layer is divided.
fn add_shades(words: &mut Vec<u32>, appearance: &LayerAppearance) -> u32 {
    if appearance.shades.iter().all(Vec::is_empty) {
        return NONE;
    }
    let first = words.len() as u32;
    let mut at = first + 2 * appearance.shades.len() as u32;
    for shades in &appearance.shades {
        words.extend([at, shades.len() as u32]);
        at += SHADE_WORDS * shades.len() as u32;
    }
    for shade in appearance.shades.iter().flatten() {
        let ([low, high], [r, g, b]) = (shade.k, shade.colour);
        add(words, &[low, high, r, g, b]);
    }
    first
}

fn add_horizons(resolved: &ResolvedScene, field: &MediaField, words: &mut Vec<u32>, params: &mut MediaParams) {
    let scope = match field.scope {
        Scope::Everywhere => 0,
        Scope::NearHorizons => 1,
        Scope::AwayFromHorizons => 2,
    };
    params.leaves[2] = scope;
    let Some(horizons) = &field.horizons else { return };
    params.candidates[3] = horizons.styles.len() as u32;
    params.leaves[0] = words.len() as u32;
    words.extend(horizons.styles.iter().map(|style| u32::from(*style)));
    let paints: Vec<Option<u32>> =
        horizons.horizons.iter().map(|h| h.paint.as_ref().map(|paint| add_table(words, &paint.table))).collect();
    params.leaves[1] = words.len() as u32;
    for (horizon, paint) in horizons.horizons.iter().zip(paints) {
        let mut record = [0u32; HORIZON_WORDS];
        let numbers = [
            horizon.colour.x,
            horizon.colour.y,
            horizon.colour.z,
            horizon.extinction,
            horizon.thickness,
            horizon.emission,
        ];
        for (to, number) in record.iter_mut().zip(numbers) {
            *to = number.to_bits();
        }
        record[6] = NONE;
        record[10] = u32::from(horizon.by_leaf);
        if let (Some(medium), Some(table)) = (&horizon.paint, paint) {
            record[6] = slot(resolved, medium);
            record[7] = table;
            record[8] = medium.table.low.to_bits();
            record[9] = medium.table.scale.to_bits();
        }
        words.extend(record);
    }
}

/// Distances and leaves of candidates on the GPU.
pub(super) struct CandidateTextures {
    pub distances: wgpu::Texture,
    pub leaves: wgpu::Texture,
}

impl CandidateTextures {
    /// Uploads candidates. `None` creates textures of one texel, which are bound if nothing is read.
    pub(super) fn new(gpu: &Gpu, candidates: Option<&CandidateVolume>) -> Result<Self, RenderError> {
        let size = candidates.map_or([1; 3], |c| c.size);
        let texture = |label, format| gpu.volume_texture(label, size, format, "the candidates have");
        let distances = texture("distances", wgpu::TextureFormat::R8Unorm)?;
        let leaves = texture("leaves", wgpu::TextureFormat::R32Uint)?;
        if let Some(candidates) = candidates {
            let plane = size[1] * size[2];
            for x in 0..size[0] {
                let range = x * plane..(x + 1) * plane;
                gpu.write_plane(&distances, x as u32, &candidates.distance[range.clone()]);
                gpu.write_plane(&leaves, x as u32, bytemuck::cast_slice(&candidates.leaf[range]));
            }
        }
        Ok(Self { distances, leaves })
    }
}

/// The sampler of all volumes that the hardware interpolates.
pub(super) fn filtering(gpu: &Gpu) -> wgpu::Sampler {
    gpu.device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("filtering"),
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        ..wgpu::SamplerDescriptor::default()
    })
}
