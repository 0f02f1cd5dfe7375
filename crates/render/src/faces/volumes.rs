//! Scalar volumes as 3D textures (P-illus 5.1).
//!
//! Texels are 32-bit floats and are read one by one: this is the fastest format on the software driver, and
//! interpolation in the shader agrees with the CPU, where hardware interpolation has weights of 8 bits.

use crate::error::RenderError;
use crate::gpu::Gpu;
use crate::inputs::NamedVolume;
use bytemuck::{Pod, Zeroable};

/// Value of NaN and of dead traces on the GPU.
const NO_DATA: f32 = -3.0e38;

/// The position and size of a volume, in the layout of the shader.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable, Default)]
pub(super) struct VolumePlacement {
    /// Sample index = voxel position · scale + offset; w unused.
    pub scale: [f32; 4],
    /// See `scale`.
    pub offset: [f32; 4],
    /// Counts along x, y, z; w unused.
    pub size: [u32; 4],
}

impl VolumePlacement {
    /// The position of this volume.
    pub(super) fn of(volume: &NamedVolume) -> Self {
        let (scale, offset) = volume.index_from_voxel();
        let [x, y, z] = volume.volume.size().map(|n| n as u32);
        Self { scale: scale.extend(0.0).to_array(), offset: offset.extend(0.0).to_array(), size: [x, y, z, 0] }
    }
}

/// Uploads a volume: texel (x, y, z) is sample (z, y, x). Needs memory for one plane beside the texture.
pub(super) fn upload_volume(gpu: &Gpu, volume: &NamedVolume) -> Result<wgpu::Texture, RenderError> {
    let Some(samples) = volume.volume.whole() else {
        let reason = format!("only the part of the volume `{}` that faces need was read", volume.name);
        return Err(RenderError::Unsuitable { adapter: gpu.adapter_name.clone(), reason });
    };
    let [nx, ny, nz] = samples.size();
    let subject = format!("the volume `{}` has", volume.name);
    let texture = gpu.volume_texture(volume.name, [nx, ny, nz], wgpu::TextureFormat::R32Float, &subject)?;
    let mut plane = vec![0.0f32; ny * nz];
    for x in 0..nx {
        for y in 0..ny {
            let trace = &mut plane[y * nz..(y + 1) * nz];
            if samples.is_live(x, y) {
                for (to, from) in trace.iter_mut().zip(samples.trace(x, y)) {
                    *to = if from.is_finite() { *from } else { NO_DATA };
                }
            } else {
                trace.fill(NO_DATA);
            }
        }
        gpu.write_plane(&texture, x as u32, bytemuck::cast_slice(&plane));
    }
    Ok(texture)
}
