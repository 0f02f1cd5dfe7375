//! The interpretation on the GPU: sheets, fault surfaces, blocks and contact rules, and the packed volume.
//!
//! All heights and level fields lie in a *pool* of floats, which is split over two storage buffers if bindings are small
//! (128 MiB on the software driver). Memory: the same as on the CPU.

use super::layout::{FaultInfo, ModelInfo, PackedInfo, SheetInfo};
use crate::error::RenderError;
use crate::gpu::Gpu;
use glam::{DVec3, Vec3};
use model::{FaultSurface, StructuralModel};
use param::{PackedVolume, Parameterization, Unfolding};
use std::sync::Arc;
use survey::stratigraphy::Contact;
use survey::{HeightField, LevelField};
use ttf::tables::NONE;

/// Largest number of horizons: shaders hold the sides of a place in two words. Models of more are drawn by the
/// processor.
const MOST_HORIZONS: usize = 64;

/// Number of buffers over which the pool may be split.
pub(super) const POOL_BUFFERS: usize = 2;

/// A model on the GPU.
pub(super) struct ModelBuffers {
    pub info: wgpu::Buffer,
    pub sheets: wgpu::Buffer,
    pub faults: wgpu::Buffer,
    pub rules: wgpu::Buffer,
    pub pool: Vec<wgpu::Buffer>,
    /// Number of floats in each buffer of the pool.
    pub pool_chunk: u32,
    /// Where the pool holds the (i, j) and ln w of the parameterization's unfolded layers, in the order of
    /// [`Parameterization::unfoldings`].
    pub unfolded: Vec<[u32; 3]>,
    /// Whether what a parameterization adds is among it.
    pub with_flat: bool,
}

/// Collects floats; addresses have 32 bits.
#[derive(Default)]
struct Pool {
    floats: Vec<f32>,
    /// The level fields that it holds, each once, and where.
    fields: Vec<(Arc<LevelField>, u32)>,
}

impl Pool {
    fn add(&mut self, floats: &[f32]) -> u32 {
        let offset = self.floats.len() as u32;
        self.floats.extend_from_slice(floats);
        offset
    }

    /// Adds a height field, padded so that it can be evaluated between `low` and `high` (its own x, y)
    /// without leaving its grid.
    fn sheet(&mut self, field: &HeightField, low: [f32; 2], high: [f32; 2]) -> SheetInfo {
        // The patch around a position reaches one node back and two ahead.
        let first = [0, 1].map(|n| field.origin[n].min(low[n].floor() as i32 - 1));
        let last = [0, 1].map(|n| (field.origin[n] + field.size[n] as i32 - 1).max(high[n].floor() as i32 + 2));
        let size = [0, 1].map(|n| (last[n] - first[n] + 1) as usize);
        let offset = if size == field.size {
            self.add(&field.z)
        } else {
            self.add(&HeightField::from_fn(first, size, |x, y| field.node(x, y)).z)
        };
        SheetInfo { origin: first, size: size.map(|n| n as u32), offset, level: NONE, at: 0.0, scale_m: 1.0 }
    }

    /// Adds a level field: origin, step and size along x, y, z (the size as bits of whole numbers), then its values.
    fn field(&mut self, field: &LevelField) -> u32 {
        let size = field.size.map(|n| f32::from_bits(n as u32));
        let offset = self.add(&[field.origin.to_array(), field.step.to_array(), size].concat());
        self.add(&field.values);
        offset
    }

    /// The surface of a horizon in a block.
    fn horizon(&mut self, model: &StructuralModel, horizon: usize, block: u16, last: [f32; 2]) -> SheetInfo {
        let sheet = self.sheet(model.sheet(horizon, block), [0.0; 2], last);
        let Some(surface) = model.level(horizon, block) else { return sheet };
        let known = self.fields.iter().find(|(field, _)| Arc::ptr_eq(field, &surface.field));
        let level = known.map(|(_, offset)| *offset).unwrap_or_else(|| {
            let offset = self.field(&surface.field);
            self.fields.push((Arc::clone(&surface.field), offset));
            offset
        });
        SheetInfo { level, at: surface.at, scale_m: surface.scale_m, ..sheet }
    }
}

/// Floats that the level fields of a model and the unfolded layers of its parameterization take in the pool.
pub(super) fn floats_of_any_shape(model: &StructuralModel, param: Option<&Parameterization>) -> usize {
    let mut fields: Vec<*const LevelField> = Vec::new();
    let mut floats = 0;
    for horizon in 0..model.stratigraphy().horizons.len() {
        for block in 0..model.block_count() as u16 {
            if let Some(surface) = model.level(horizon, block)
                && !fields.contains(&Arc::as_ptr(&surface.field))
            {
                fields.push(Arc::as_ptr(&surface.field));
                floats += surface.field.values.len();
            }
        }
    }
    let unfolded = param.map_or_else(Vec::new, Parameterization::unfoldings);
    floats + unfolded.iter().flat_map(|own| own.fields()).map(|field| field.values.len()).sum::<usize>()
}

impl ModelBuffers {
    /// Uploads a model, and what its parameterization adds to it: calm sheets and unfolded layers.
    pub(super) fn new(
        gpu: &Gpu,
        model: &StructuralModel,
        param: Option<&Parameterization>,
    ) -> Result<Self, RenderError> {
        let mut pool = Pool::default();
        let horizons = model.stratigraphy().horizons.len();
        if horizons > MOST_HORIZONS {
            return Err(RenderError::Unsuitable {
                adapter: gpu.adapter_name.clone(),
                reason: format!("its shaders tell at most {MOST_HORIZONS} horizons apart, and there are {horizons}"),
            });
        }
        let blocks = model.block_count();
        let size = model.size();
        let last = size.map(|n| n.saturating_sub(1) as f32);
        let mut sheets = Vec::new();
        for horizon in 0..horizons {
            for block in 0..blocks {
                sheets.push(pool.horizon(model, horizon, block as u16, [last[0], last[1]]));
            }
        }
        let calm = param.map_or_else(Vec::new, Parameterization::calm_sheets);
        sheets.extend(calm.iter().map(|sheet| pool.sheet(sheet, [0.0; 2], [last[0], last[1]])));
        let unfoldings = param.map_or_else(Vec::new, Parameterization::unfoldings);
        let fields = |own: &Unfolding| {
            let mut own = own.fields();
            [(); 3].map(|()| own.next().map_or(NONE, |field| pool.field(field)))
        };
        let unfolded = unfoldings.iter().map(fields).collect();
        let centre = Vec3::from_array(size.map(|n| 0.5 * n as f32)).as_dvec3();
        let surfaces = model.faults().surfaces();
        let faults: Vec<FaultInfo> = surfaces
            .iter()
            .map(|fault| {
                let [low, high] = frame_range(fault, last);
                fault_info(fault, centre, pool.sheet(&fault.surface, low, high))
            })
            .collect();
        let info = ModelInfo {
            centre: centre.as_vec3().extend(0.0).to_array(),
            horizons: horizons as u32,
            blocks: blocks as u32,
            faults: faults.len() as u32,
            layers: model.layer_count() as u32,
            unit_from_voxel: [0, 1].map(|axis: usize| 1.0 / size[axis].saturating_sub(1).max(1) as f32),
            padding: [0.0; 2],
        };
        let (buffers, pool_chunk) = split_pool(gpu, &pool.floats)?;
        Ok(Self {
            info: gpu.uniform("model", bytemuck::bytes_of(&info)),
            sheets: gpu.storage("sheets", bytemuck::cast_slice(&sheets)),
            faults: gpu.storage("faults", bytemuck::cast_slice(&faults)),
            rules: gpu.storage("rules", bytemuck::cast_slice(&rules(model))),
            pool: buffers,
            pool_chunk,
            unfolded,
            with_flat: param.is_some(),
        })
    }

    /// Number of buffers of the pool that hold data.
    pub(super) fn pool_chunks(&self) -> usize {
        self.pool.len()
    }
}

/// Smallest and largest (u, v) of a fault's frame in the volume.
fn frame_range(fault: &FaultSurface, last: [f32; 3]) -> [[f32; 2]; 2] {
    let corners = (0..8).map(|n| {
        let pick = |axis: usize| if n >> axis & 1 == 0 { 0.0 } else { f64::from(last[axis]) };
        fault.frame(DVec3::new(pick(0), pick(1), pick(2)))
    });
    let (low, high) =
        corners.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), corner| (low.min(corner), high.max(corner)));
    [[low.x as f32, low.y as f32], [high.x as f32, high.y as f32]]
}

/// The rows of the frame of a fault, with constants for positions relative to `centre`, where single
/// precision is most accurate.
fn fault_info(fault: &FaultSurface, centre: DVec3, surface: SheetInfo) -> FaultInfo {
    let at_centre = fault.frame_from_voxel * centre + fault.frame_offset;
    let row = |n: usize| fault.frame_from_voxel.row(n).extend(at_centre[n]).as_vec4().to_array();
    FaultInfo { u: row(0), v: row(1), w: row(2), surface }
}

/// Block signatures, then the horizons' contacts.
fn rules(model: &StructuralModel) -> Vec<[u32; 4]> {
    let halves = |bits: u64| [bits as u32, (bits >> 32) as u32];
    let signatures = model.faults().signatures().iter().map(|s| {
        let ([a, b], [c, d]) = (halves(s.bits), halves(s.care));
        [a, b, c, d]
    });
    let contacts = model.rules().contacts().iter().map(|contact| {
        let code = match contact {
            Contact::Conformable => 0,
            Contact::Erosional => 1,
            Contact::Onlap => 2,
            Contact::Intrusive => 3,
            Contact::Truncated => 4,
        };
        [code, 0, 0, 0]
    });
    signatures.chain(contacts).collect()
}

fn split_pool(gpu: &Gpu, floats: &[f32]) -> Result<(Vec<wgpu::Buffer>, u32), RenderError> {
    let chunk = gpu.buffer_floats;
    if floats.len() > chunk.saturating_mul(POOL_BUFFERS) || floats.len() > u32::MAX as usize {
        return Err(RenderError::OutOfMemory {
            reason: format!("the interpretation needs {} MiB", (floats.len() * 4) >> 20),
        });
    }
    let buffers: Vec<_> = floats.chunks(chunk).map(|part| gpu.storage("pool", bytemuck::cast_slice(part))).collect();
    let buffers = if buffers.is_empty() { vec![gpu.storage("pool", &[])] } else { buffers };
    Ok((buffers, chunk as u32))
}

/// The packed volume on the GPU.
pub(super) struct PackedTexture {
    pub info: wgpu::Buffer,
    pub texture: wgpu::Texture,
}

impl PackedTexture {
    /// Uploads a packed volume: texel (x, y, z) is sample (z, y, x). `None` creates one texel, which is bound
    /// if nothing is read.
    pub(super) fn new(gpu: &Gpu, packed: Option<&PackedVolume>) -> Result<Self, RenderError> {
        let size = packed.map_or([1; 3], |p| p.size);
        let format = wgpu::TextureFormat::Rgba32Float;
        let texture = gpu.volume_texture("packed volume", size, format, "the packed volume has")?;
        let mut info = PackedInfo { size: [1, 1, 1, 0], layers: 1, blocks: 1, ..PackedInfo::default() };
        if let Some(packed) = packed {
            info = packed_info(packed);
            for (x, plane) in packed.values.chunks(size[1] * size[2]).enumerate() {
                let texels: Vec<[f32; 4]> = plane.iter().map(|&[i, j, k]| [i, j, k, 0.0]).collect();
                gpu.write_plane(&texture, x as u32, bytemuck::cast_slice(&texels));
            }
        }
        Ok(Self { info: gpu.uniform("packed", bytemuck::bytes_of(&info)), texture })
    }
}

fn packed_info(packed: &PackedVolume) -> PackedInfo {
    let [x, y, z] = packed.size.map(|n| n as u32);
    let scale = |axis: usize| (packed.size[axis] - 1) as f32 / packed.voxels[axis].saturating_sub(1).max(1) as f32;
    PackedInfo {
        scale: [scale(0), scale(1), scale(2), 0.0],
        size: [x, y, z, 0],
        i_range: packed.i_range,
        j_range: packed.j_range,
        layers: packed.layers as u32,
        blocks: packed.blocks as u32,
        padding: [0; 2],
    }
}
