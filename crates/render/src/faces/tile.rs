//! A picture is drawn tile by tile: the pixels of one on the device, and how they come back.

use super::layout::WORKGROUP;
use crate::error::RenderError;
use crate::gpu::Gpu;
use image::RgbaImage;

/// Largest number of samples in one dispatch: a tenth of a second on the software driver.
const SAMPLES_PER_TILE: u32 = 1 << 17;

/// Side of a tile for a number of samples per pixel along each axis: a multiple of the side of a workgroup.
pub(super) fn tile_side(samples: u32) -> u32 {
    let pixels = SAMPLES_PER_TILE / (samples * samples);
    (pixels.isqrt() / WORKGROUP * WORKGROUP).clamp(4 * WORKGROUP, 1024)
}

/// The pixels of a tile on the device, and the buffer in which they are read back.
pub(super) struct TileTarget {
    pub pixels: wgpu::Buffer,
    readback: wgpu::Buffer,
}

impl TileTarget {
    /// Room for a square tile.
    pub(super) fn new(gpu: &Gpu, side: u32) -> Self {
        let buffer = |label, usage| {
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: u64::from(side) * u64::from(side) * 4,
                usage,
                mapped_at_creation: false,
            })
        };
        Self {
            pixels: buffer("pixels", wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC),
            readback: buffer("readback", wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST),
        }
    }

    /// Draws one tile and copies it into the image.
    pub(super) fn draw(
        &self,
        gpu: &Gpu,
        pipeline: &wgpu::ComputePipeline,
        groups: &[wgpu::BindGroup; 4],
        [x, y, width, height]: [u32; 4],
        image: &mut RgbaImage,
    ) -> Result<(), RenderError> {
        let bytes = u64::from(width) * u64::from(height) * 4;
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("faces") });
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_pipeline(pipeline);
            for (index, group) in (0u32..).zip(groups) {
                pass.set_bind_group(index, group, &[]);
            }
            pass.dispatch_workgroups(width.div_ceil(WORKGROUP), height.div_ceil(WORKGROUP), 1);
        }
        encoder.copy_buffer_to_buffer(&self.pixels, 0, &self.readback, 0, bytes);
        gpu.queue.submit([encoder.finish()]);
        let (sender, receiver) = std::sync::mpsc::channel();
        self.readback.map_async(wgpu::MapMode::Read, ..bytes, move |result| {
            // The receiver waits below. It is gone only if this function has already failed.
            let _ = sender.send(result);
        });
        gpu.wait()?;
        let lost = |reason: String| RenderError::DeviceLost { reason };
        receiver.recv().map_err(|e| lost(e.to_string()))?.map_err(|e| lost(e.to_string()))?;
        {
            let mapped = self.readback.get_mapped_range(..bytes).map_err(|e| lost(e.to_string()))?;
            let stride = image.width() as usize * 4;
            let row_bytes = width as usize * 4;
            let to: &mut [u8] = image;
            for (row, from) in mapped.chunks_exact(row_bytes).enumerate() {
                let start = (y as usize + row) * stride + x as usize * 4;
                to[start..start + row_bytes].copy_from_slice(from);
            }
        }
        self.readback.unmap();
        Ok(())
    }
}
