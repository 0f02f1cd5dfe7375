//! The pass that propagates occlusion and emission from slice to slice: one dispatch per slice. Its result is
//! the light volume.

use super::layout::WORKGROUP;
use crate::error::RenderError;
use crate::gpu::Gpu;
use crate::media::light_grid::LightGrid;
use bytemuck::{Pod, Zeroable};
use survey::Progress;

/// A slice, in the layout of the shader.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(super) struct Slice {
    pub index: u32,
    pub side: f32,
    pub padding: [u32; 2],
}

/// Number of slices in one submission: a fraction of a second on the software driver.
const SLICES_AT_ONCE: usize = 64;

/// Format of the light volume: half floats with a relative error of 1/2000, which every device can write.
pub(super) const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// Buffers of the pass. They are kept while the size of the grid stays the same.
pub(super) struct LightBuffers {
    size: [usize; 3],
    /// The light volume.
    pub volume: wgpu::Texture,
    carried: wgpu::Buffer,
    slices: wgpu::Buffer,
    stride: u64,
}

impl LightBuffers {
    /// Allocates buffers for a grid.
    pub(super) fn new(gpu: &Gpu, size: [usize; 3]) -> Result<Self, RenderError> {
        let [nu, nv, slices] = size;
        let limits = gpu.device.limits();
        if [nu, nv, slices + 1].into_iter().any(|n| n > limits.max_texture_dimension_3d as usize) {
            return Err(RenderError::OutOfMemory {
                reason: format!("a light volume of {nu} x {nv} x {slices} cells exceeds the texture size"),
            });
        }
        let extent = wgpu::Extent3d { width: nu as u32, height: nv as u32, depth_or_array_layers: slices as u32 + 1 };
        let stride = u64::from(limits.min_uniform_buffer_offset_alignment).max(size_of::<Slice>() as u64);
        let buffer = |label, size, usage| {
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage,
                mapped_at_creation: false,
            })
        };
        Ok(Self {
            size,
            volume: gpu.texture("light", extent, FORMAT, wgpu::TextureUsages::STORAGE_BINDING),
            carried: buffer("carried light", (nu * nv * 32) as u64, wgpu::BufferUsages::STORAGE),
            slices: buffer(
                "slices",
                stride * (slices as u64 + 1),
                wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            ),
            stride,
        })
    }

    /// Whether the buffers have this size.
    pub(super) fn fits(&self, size: [usize; 3]) -> bool {
        self.size == size
    }

    /// Propagates the light front to back. `groups` are the bind groups of the picture from the second on.
    pub(super) fn carry(
        &self,
        gpu: &Gpu,
        pipeline: &wgpu::ComputePipeline,
        (layout, params, words): (&wgpu::BindGroupLayout, &wgpu::Buffer, &wgpu::Buffer),
        groups: &[wgpu::BindGroup],
        grid: &LightGrid,
        progress: &Progress,
    ) -> Result<(), RenderError> {
        let [nu, nv, slices] = self.size;
        let mut bytes = vec![0u8; (self.stride * (slices as u64 + 1)) as usize];
        for index in 0..=slices {
            let slice = Slice { index: index as u32, side: grid.side_weight(index), padding: [0; 2] };
            let start = index * self.stride as usize;
            bytes[start..start + size_of::<Slice>()].copy_from_slice(bytemuck::bytes_of(&slice));
        }
        gpu.queue.write_buffer(&self.slices, 0, &bytes);
        let view = self.volume.create_view(&wgpu::TextureViewDescriptor::default());
        let slice_binding = wgpu::BufferBinding {
            buffer: &self.slices,
            offset: 0,
            size: std::num::NonZeroU64::new(size_of::<Slice>() as u64),
        };
        let resources = [
            (0, params.as_entire_binding()),
            (2, words.as_entire_binding()),
            (3, wgpu::BindingResource::Buffer(slice_binding)),
            (4, self.carried.as_entire_binding()),
            (5, wgpu::BindingResource::TextureView(&view)),
        ];
        let entries = resources.map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource });
        let own = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("light"),
            layout,
            entries: &entries,
        });
        progress.begin("light", slices as u64 + 1);
        let all: Vec<usize> = (0..=slices).collect();
        for some in all.chunks(SLICES_AT_ONCE) {
            let mut encoder =
                gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("light") });
            {
                let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
                pass.set_pipeline(pipeline);
                for (index, group) in (1u32..).zip(groups) {
                    pass.set_bind_group(index, group, &[]);
                }
                for index in some {
                    pass.set_bind_group(0, &own, &[(*index as u64 * self.stride) as u32]);
                    pass.dispatch_workgroups((nu as u32).div_ceil(WORKGROUP), (nv as u32).div_ceil(WORKGROUP), 1);
                }
            }
            gpu.queue.submit([encoder.finish()]);
            progress.step(some.len() as u64)?;
        }
        Ok(())
    }
}

/// Layout of the first bind group of the pass.
pub(super) fn layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let entry =
        |binding, ty| wgpu::BindGroupLayoutEntry { binding, visibility: wgpu::ShaderStages::COMPUTE, ty, count: None };
    let buffer = |ty, has_dynamic_offset| wgpu::BindingType::Buffer { ty, has_dynamic_offset, min_binding_size: None };
    let storage = |read_only| wgpu::BufferBindingType::Storage { read_only };
    let written = wgpu::BindingType::StorageTexture {
        access: wgpu::StorageTextureAccess::WriteOnly,
        format: FORMAT,
        view_dimension: wgpu::TextureViewDimension::D3,
    };
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("light"),
        entries: &[
            entry(0, buffer(wgpu::BufferBindingType::Uniform, false)),
            entry(2, buffer(storage(true), false)),
            entry(3, buffer(wgpu::BufferBindingType::Uniform, true)),
            entry(4, buffer(storage(false), false)),
            entry(5, written),
        ],
    })
}
