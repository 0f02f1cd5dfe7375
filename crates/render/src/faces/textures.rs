//! Pattern tiles with their mip levels in one storage buffer.
//!
//! A buffer instead of a texture array, so that tiles of different sizes (users add their own) can be
//! adjacent, and because the anisotropic filter of `ttf::Texture` is computed in the shader anyway.

use crate::gpu::Gpu;
use bytemuck::{Pod, Zeroable};
use std::sync::Arc;
use ttf::Texture;

/// The position of a tile in the texel buffer, in the layout of the shader.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(super) struct TextureInfo {
    /// Mean of all texels, premultiplied.
    pub mean: [f32; 4],
    /// First texel of level 0.
    pub offset: u32,
    /// Texels per side at level 0.
    pub side: u32,
    /// Count of mip levels.
    pub levels: u32,
    /// Zero.
    pub padding: u32,
}

/// Tiles on the GPU.
pub(super) struct TextureBuffers {
    pub infos: wgpu::Buffer,
    pub texels: wgpu::Buffer,
    uploaded: Vec<Arc<Texture>>,
}

impl TextureBuffers {
    /// Uploads the tiles.
    pub(super) fn new(gpu: &Gpu, textures: &[Arc<Texture>]) -> Self {
        let mut infos = Vec::new();
        let mut texels: Vec<u8> = Vec::new();
        for texture in textures {
            infos.push(TextureInfo {
                mean: texture.mean(),
                offset: (texels.len() / 4) as u32,
                side: texture.side_px(),
                levels: texture.levels().len() as u32,
                padding: 0,
            });
            for level in texture.levels() {
                texels.extend_from_slice(bytemuck::cast_slice(level));
            }
        }
        Self {
            infos: gpu.storage("texture infos", bytemuck::cast_slice(&infos)),
            texels: gpu.storage("texels", &texels),
            uploaded: textures.to_vec(),
        }
    }

    /// Whether exactly these tiles have been uploaded.
    pub(super) fn hold(&self, textures: &[Arc<Texture>]) -> bool {
        self.uploaded.len() == textures.len() && self.uploaded.iter().zip(textures).all(|(a, b)| Arc::ptr_eq(a, b))
    }
}
