//! The graphics device, opened without a window, and its errors as [`RenderError`].
//!
//! The device is opened with the limits of the adapter, because the software driver and real cards differ by
//! more than a factor of ten in what they can bind.

use crate::error::RenderError;
use std::sync::{Arc, Mutex};

/// A device and its queue.
pub(crate) struct Gpu {
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    pub adapter_name: String,
    /// Number of floats that one storage buffer can hold and bind.
    pub buffer_floats: usize,
    /// Whether textures of 32-bit floats can be filtered.
    pub filters_floats: bool,
    lost: Arc<Mutex<Option<String>>>,
}

/// Number of storage buffers that the largest shader binds.
const STORAGE_BUFFERS: u32 = 16;

impl Gpu {
    /// Opens the fastest adapter. The environment variables of wgpu (`WGPU_ADAPTER_NAME`, …) choose another.
    pub(crate) fn headless() -> Result<Self, RenderError> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
        let options = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            ..wgpu::RequestAdapterOptions::default()
        };
        let adapter = pollster::block_on(instance.request_adapter(&options))
            .map_err(|error| RenderError::NoAdapter { reason: error.to_string() })?;
        let adapter_name = adapter.get_info().name;
        let limits = adapter.limits();
        let unsuitable = |reason: String| RenderError::Unsuitable { adapter: adapter_name.clone(), reason };
        if limits.max_storage_buffers_per_shader_stage < STORAGE_BUFFERS {
            let found = limits.max_storage_buffers_per_shader_stage;
            return Err(unsuitable(format!("it binds {found} storage buffers, but {STORAGE_BUFFERS} are needed")));
        }
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("petroglyph"),
            required_limits: limits,
            required_features: adapter.features() & wgpu::Features::FLOAT32_FILTERABLE,
            ..wgpu::DeviceDescriptor::default()
        }))
        .map_err(|error| unsuitable(error.to_string()))?;
        // The count of floats is a multiple of four, since buffers are sized in units of 16 bytes, and fits
        // into the 32 bits with which a shader counts.
        let limits = device.limits();
        let bytes = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
        let buffer_floats = (bytes / 16 * 4).min(u64::from(u32::MAX)) as usize;
        let filters_floats = device.features().contains(wgpu::Features::FLOAT32_FILTERABLE);
        let lost = Arc::new(Mutex::new(None));
        let report = Arc::clone(&lost);
        device.set_device_lost_callback(move |_, reason| {
            if let Ok(mut lost) = report.lock() {
                *lost = Some(reason);
            }
        });
        Ok(Self { device, queue, adapter_name, buffer_floats, filters_floats, lost })
    }

    /// Runs commands and converts the errors that the graphics library reports about them.
    pub(crate) fn guarded<T>(&self, commands: impl FnOnce() -> Result<T, RenderError>) -> Result<T, RenderError> {
        let memory = self.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let validation = self.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let internal = self.device.push_error_scope(wgpu::ErrorFilter::Internal);
        let result = commands();
        let errors = [internal, validation, memory].map(|scope| pollster::block_on(scope.pop()));
        if result.is_err() || errors.iter().any(Option::is_some) {
            // The callback reports a lost device only when the device is polled.
            let _ = self.device.poll(wgpu::PollType::Poll);
        }
        if let Some(reason) = self.lost_reason() {
            return Err(RenderError::DeviceLost { reason });
        }
        if let Some(error) = errors.into_iter().flatten().next() {
            let reason = error.to_string();
            return Err(match error {
                wgpu::Error::OutOfMemory { .. } => RenderError::OutOfMemory { reason },
                _ => RenderError::Device { reason },
            });
        }
        result
    }

    fn lost_reason(&self) -> Option<String> {
        self.lost.lock().ok().and_then(|lost| lost.clone())
    }

    /// A 3D texture that shaders can read.
    pub(crate) fn texture(
        &self,
        label: &str,
        size: wgpu::Extent3d,
        format: wgpu::TextureFormat,
        usage: wgpu::TextureUsages,
    ) -> wgpu::Texture {
        self.device.create_texture(&wgpu::TextureDescriptor {
            label: Some(label),
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D3,
            format,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | usage,
            view_formats: &[],
        })
    }

    /// A texture to be filled with a volume: texel (x, y, z) is sample (z, y, x). `subject`: what has too many samples, for
    /// the error.
    pub(crate) fn volume_texture(
        &self,
        label: &str,
        [nx, ny, nz]: [usize; 3],
        format: wgpu::TextureFormat,
        subject: &str,
    ) -> Result<wgpu::Texture, RenderError> {
        let limit = self.device.limits().max_texture_dimension_3d as usize;
        if [nx, ny, nz].into_iter().any(|n| n > limit) {
            let reason = format!("{subject} {nx} x {ny} x {nz} samples, but its limit is {limit} along each axis");
            return Err(RenderError::Unsuitable { adapter: self.adapter_name.clone(), reason });
        }
        let size = wgpu::Extent3d { width: nz as u32, height: ny as u32, depth_or_array_layers: nx as u32 };
        Ok(self.texture(label, size, format, wgpu::TextureUsages::COPY_DST))
    }

    /// Writes the texels of the plane at depth `plane` of a 3D texture, row by row.
    pub(crate) fn write_plane(&self, texture: &wgpu::Texture, plane: u32, bytes: &[u8]) {
        let size = wgpu::Extent3d { depth_or_array_layers: 1, ..texture.size() };
        let texel_bytes =
            texture.format().block_copy_size(None).expect("an uncompressed colour format has one texel size");
        self.queue.write_texture(
            wgpu::TexelCopyTextureInfo {
                texture,
                mip_level: 0,
                origin: wgpu::Origin3d { x: 0, y: 0, z: plane },
                aspect: wgpu::TextureAspect::All,
            },
            bytes,
            wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(size.width * texel_bytes),
                rows_per_image: Some(size.height),
            },
            size,
        );
    }

    /// A storage buffer with these bytes. It is never empty, since an empty buffer cannot be bound.
    pub(crate) fn storage(&self, label: &str, bytes: &[u8]) -> wgpu::Buffer {
        self.filled(label, bytes, wgpu::BufferUsages::STORAGE)
    }

    /// A uniform buffer with these bytes.
    pub(crate) fn uniform(&self, label: &str, bytes: &[u8]) -> wgpu::Buffer {
        self.filled(label, bytes, wgpu::BufferUsages::UNIFORM)
    }

    fn filled(&self, label: &str, bytes: &[u8], usage: wgpu::BufferUsages) -> wgpu::Buffer {
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size: (bytes.len() as u64).next_multiple_of(16).max(256),
            usage: usage | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        if !bytes.is_empty() {
            self.queue.write_buffer(&buffer, 0, bytes);
        }
        buffer
    }

    /// Waits until all submitted work is done.
    pub(crate) fn wait(&self) -> Result<(), RenderError> {
        match self.device.poll(wgpu::PollType::wait_indefinitely()) {
            Ok(_) => Ok(()),
            Err(error) => {
                Err(RenderError::DeviceLost { reason: self.lost_reason().unwrap_or_else(|| error.to_string()) })
            }
        }
    }
}
