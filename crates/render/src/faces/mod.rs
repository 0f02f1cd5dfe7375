//! The GPU renderer, without a window: draws faces, cut-outs, the ground, media and wells.
//!
//! There is one compute shader, assembled from the file of the pass and the files that it uses; each names
//! its CPU twin. A picture is drawn in tiles, so that no dispatch runs long enough for the watchdog of a
//! driver, cancelling is quick, and an image may exceed the limits of the device. Uploaded data are kept
//! while [`Inputs::data_key`] stays the same. Of the parameterization only the visible part is uploaded.
//!
//! A compute shader instead of a fragment shader: on data-centre cards it was found to be far faster, and on
//! the software driver there is no difference.

mod grids;
mod layout;
mod light;
mod media;
mod model;
#[cfg(test)]
mod tests;
mod textures;
mod tile;
mod volumes;

use crate::cache::Kept;
use crate::error::RenderError;
use crate::gpu::Gpu;
use crate::inputs::Inputs;
use crate::media::stripes::{halves, interleave};
use crate::outline::draw::draw as draw_outlines;
use crate::resolved_scene::{Flat, MAX_VOLUMES, ResolvedScene};
use crate::scene::{Lookup, Scene};
use ::model::StructuralModel;
use grids::{GridBuffers, VisibleParts};
use image::RgbaImage;
use layout::FaceParams;
use light::LightBuffers;
use media::CandidateTextures;
use model::{ModelBuffers, POOL_BUFFERS, PackedTexture, floats_of_any_shape};
use std::collections::HashMap;
use survey::Progress;
use textures::TextureBuffers;
use tile::{TileTarget, tile_side};
use ttf::tables::NONE;
use volumes::{VolumePlacement, upload_volume};

/// The shader: the file of the pass first, so that line numbers in its errors are right, then the others.
pub(crate) const SHADER: &str = concat!(
    include_str!("faces.wgsl"),
    include_str!("visible.wgsl"),
    include_str!("ground.wgsl"),
    include_str!("levels.wgsl"),
    include_str!("model.wgsl"),
    include_str!("flat.wgsl"),
    include_str!("packed.wgsl"),
    include_str!("shade.wgsl"),
    include_str!("texture.wgsl"),
    include_str!("volume.wgsl"),
    include_str!("media.wgsl"),
    include_str!("march.wgsl"),
    include_str!("light.wgsl"),
    include_str!("leaves.wgsl"),
    include_str!("wells.wgsl"),
);

/// The shader with the volume interpolation that a device supports.
pub(crate) fn shader(filters_floats: bool) -> String {
    let filter = if filters_floats { include_str!("filtered.wgsl") } else { include_str!("by_hand.wgsl") };
    [SHADER, filter].concat()
}

/// Draws scenes on the GPU. Keeps what it has uploaded.
pub struct Renderer {
    gpu: Gpu,
    module: wgpu::ShaderModule,
    layouts: [wgpu::BindGroupLayout; 4],
    pipeline_layout: wgpu::PipelineLayout,
    pipelines: [HashMap<Variant, wgpu::ComputePipeline>; 2],
    data_key: Option<u64>,
    model: Option<ModelBuffers>,
    grids: Option<GridBuffers>,
    packed: Option<PackedTexture>,
    no_packed: PackedTexture,
    textures: Option<TextureBuffers>,
    volumes: HashMap<String, wgpu::Texture>,
    no_volume: wgpu::Texture,
    kept: Kept,
    light_layout: wgpu::BindGroupLayout,
    light_pipeline_layout: wgpu::PipelineLayout,
    light: Option<LightBuffers>,
    no_light: wgpu::Texture,
    candidates: Option<CandidateTextures>,
    no_candidates: CandidateTextures,
    filtering: wgpu::Sampler,
}

/// The constants of a pipeline: their names in the shader, and their values.
type Variant = Vec<(&'static str, u32)>;

/// The entry points of the shader.
#[derive(Debug, Clone, Copy)]
enum EntryPoint {
    Draw,
    Carry,
}

impl Renderer {
    /// Opens a device and compiles the shader.
    ///
    /// # Errors
    /// [`RenderError::NoAdapter`] without a Vulkan driver; [`RenderError::Unsuitable`] if its limits are too
    /// low.
    pub fn headless() -> Result<Self, RenderError> {
        let gpu = Gpu::headless()?;
        let make = gpu.guarded(|| Self::with(&gpu))?;
        Ok(make(gpu))
    }

    /// Creates what is the same for all pictures.
    fn with(gpu: &Gpu) -> Result<impl FnOnce(Gpu) -> Self + use<>, RenderError> {
        let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("faces"),
            source: wgpu::ShaderSource::Wgsl(shader(gpu.filters_floats).into()),
        });
        let layouts = bind_group_layouts(gpu);
        let pipeline_layout = |label, layouts: &[Option<&wgpu::BindGroupLayout>]| {
            gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(label),
                bind_group_layouts: layouts,
                immediate_size: 0,
            })
        };
        let light_layout = light::layout(gpu);
        let of_light = [&light_layout, &layouts[1], &layouts[2], &layouts[3]].map(Some);
        let light_pipeline_layout = pipeline_layout("light", &of_light);
        let pipeline_layout = pipeline_layout("faces", &layouts.each_ref().map(Some));
        let no_packed = PackedTexture::new(gpu, None)?;
        let one = wgpu::Extent3d { width: 1, height: 1, depth_or_array_layers: 1 };
        let empty = |label, format, usage| gpu.texture(label, one, format, usage);
        let no_volume = empty("no volume", wgpu::TextureFormat::R32Float, wgpu::TextureUsages::COPY_DST);
        let no_light = empty("no light", light::FORMAT, wgpu::TextureUsages::empty());
        let no_candidates = CandidateTextures::new(gpu, None)?;
        let filtering = media::filtering(gpu);
        Ok(move |gpu| Self {
            gpu,
            module,
            layouts,
            pipeline_layout,
            pipelines: Default::default(),
            data_key: None,
            model: None,
            grids: None,
            packed: None,
            no_packed,
            textures: None,
            volumes: HashMap::new(),
            no_volume,
            kept: Kept::default(),
            light_layout,
            light_pipeline_layout,
            light: None,
            no_light,
            candidates: None,
            no_candidates,
            filtering,
        })
    }

    /// Name of the graphics adapter.
    pub fn adapter_name(&self) -> &str {
        &self.gpu.adapter_name
    }

    /// Loses the device, as if its driver were restarted, so that recovery can be tested.
    pub fn lose_device(&self) {
        self.gpu.device.destroy();
    }

    /// Draws the scene. If the device is lost, it is opened again, once, and all data are uploaded again.
    ///
    /// # Errors
    /// A scene that cannot be drawn, missing inputs, cancellation, or an error of the device.
    pub fn render(&mut self, scene: &Scene, inputs: &Inputs, progress: &Progress) -> Result<RgbaImage, RenderError> {
        // A measurement has one implementation, on the processor, which also draws what does not fit the device.
        if scene.face_data == crate::FaceData::Distortion || !self.holds_surfaces(scene, inputs) {
            return crate::reference::render(scene, inputs, progress);
        }
        match self.render_once(scene, inputs, progress) {
            Err(RenderError::DeviceLost { .. }) => {
                *self = Self::headless()?;
                self.render_once(scene, inputs, progress)
            }
            drawn => drawn,
        }
    }

    /// Whether horizons of any shape fit the device. Sheets that do not are an error of their own.
    fn holds_surfaces(&self, scene: &Scene, inputs: &Inputs) -> bool {
        let Some(model) = inputs.model.filter(|model| model.has_levels()) else { return true };
        let param = inputs.param.filter(|_| scene.lookup == Lookup::Exact);
        // A third is left to sheets.
        floats_of_any_shape(model, param) / 2 < self.gpu.buffer_floats / 3 * POOL_BUFFERS
    }

    fn render_once(&mut self, scene: &Scene, inputs: &Inputs, progress: &Progress) -> Result<RgbaImage, RenderError> {
        if let Some(([first, second], stripes)) = halves(scene) {
            let first = self.render(&first, inputs, progress)?;
            return Ok(interleave(first, &self.render(&second, inputs, progress)?, stripes));
        }
        let resolved = ResolvedScene::new(scene, inputs, &mut self.kept)?;
        self.upload(&resolved, inputs)?;
        let mut image = self.draw(&resolved, progress)?;
        draw_outlines(&resolved, &mut image);
        Ok(image)
    }

    /// Uploads what the device does not hold yet.
    fn upload(&mut self, resolved: &ResolvedScene, inputs: &Inputs) -> Result<(), RenderError> {
        if inputs.data_key == 0 || self.data_key != Some(inputs.data_key) {
            self.model = None;
            self.grids = None;
            self.packed = None;
            self.candidates = None;
            self.volumes.clear();
            self.data_key = Some(inputs.data_key);
        }
        self.upload_interpretation(resolved)?;
        let gpu = &self.gpu;
        if !self.textures.as_ref().is_some_and(|held| held.hold(&resolved.tables.textures)) {
            self.textures = Some(gpu.guarded(|| Ok(TextureBuffers::new(gpu, &resolved.tables.textures)))?);
        }
        if let (Some(candidates), None) = (media::candidates_of(resolved), &self.candidates) {
            self.candidates = Some(gpu.guarded(|| CandidateTextures::new(gpu, Some(candidates)))?);
        }
        for volume in resolved.volumes.iter().flatten() {
            if !self.volumes.contains_key(volume.name) {
                let texture = gpu.guarded(|| upload_volume(gpu, volume))?;
                self.volumes.insert(volume.name.to_owned(), texture);
            }
        }
        Ok(())
    }

    /// Uploads the model, and the grids or the packed volume, as the scene needs them.
    fn upload_interpretation(&mut self, resolved: &ResolvedScene) -> Result<(), RenderError> {
        let gpu = &self.gpu;
        let flat = resolved.interpretation.filter(|_| resolved.illustrated).map(|interpretation| interpretation.flat);
        if let Some(interpretation) = resolved.interpretation {
            let param = if let Some(Flat::Exact(param)) = flat { Some(param) } else { None };
            if self.model.as_ref().is_none_or(|held| param.is_some() && !held.with_flat) {
                self.model = Some(gpu.guarded(|| ModelBuffers::new(gpu, interpretation.model, param))?);
            }
        }
        if let (Some(interpretation), Some(Flat::Exact(param))) = (resolved.interpretation, flat) {
            let seen = VisibleParts::of(resolved);
            if !self.grids.as_ref().is_some_and(|grids| grids.seen == seen) {
                self.grids = None;
                let unfolded = self.model.as_ref().map_or(&[][..], |held| &held.unfolded);
                let model = interpretation.model;
                self.grids = Some(gpu.guarded(|| GridBuffers::new(gpu, model, param, unfolded, seen))?);
            }
        }
        if let Some(Flat::Packed(packed)) = flat
            && self.packed.is_none()
        {
            self.packed = Some(gpu.guarded(|| PackedTexture::new(gpu, Some(packed)))?);
        }
        Ok(())
    }

    fn variant(&self, resolved: &ResolvedScene) -> Variant {
        let lookup = match resolved.interpretation.filter(|_| resolved.illustrated).map(|found| found.flat) {
            None => 0,
            Some(Flat::Exact(_)) => 1,
            Some(Flat::Packed(_)) => 2,
        };
        let with_ground = resolved.relief.as_ref().map_or(0, |relief| if relief.opacity < 1.0 { 2 } else { 1 });
        let model = resolved.interpretation.map(|found| found.model);
        let has = |what: fn(&StructuralModel) -> bool| u32::from(model.is_some_and(what));
        let mut variant = vec![
            ("lookup", lookup),
            ("with_ground", with_ground),
            ("with_raw", u32::from(resolved.tables.globals.raw_volume != NONE)),
            ("with_scalars", u32::from(resolved.illustrated && !resolved.tables.scalars.is_empty())),
            ("volume_count", resolved.volumes.len() as u32),
            ("has_faults", has(|model| !model.faults().surfaces().is_empty())),
            ("has_horizons", has(|model| !model.stratigraphy().horizons.is_empty())),
            ("has_levels", has(StructuralModel::has_levels)),
            ("pool_chunk", self.model.as_ref().map_or(1, |m| m.pool_chunk)),
            ("pool_chunks", self.model.as_ref().map_or(1, |m| m.pool_chunks() as u32)),
        ];
        variant.extend(media::constants(resolved));
        variant
    }

    fn draw(&mut self, resolved: &ResolvedScene, progress: &Progress) -> Result<RgbaImage, RenderError> {
        let variant = self.variant(resolved);
        let grid = media::light_grid(resolved);
        self.make_pipeline(&variant, EntryPoint::Draw)?;
        if let Some(grid) = &grid {
            self.make_pipeline(&variant, EntryPoint::Carry)?;
            if !self.light.as_ref().is_some_and(|held| held.fits(grid.size)) {
                self.light = None;
                self.light = Some(self.gpu.guarded(|| LightBuffers::new(&self.gpu, grid.size))?);
            }
        }
        let pipeline = &self.pipelines[EntryPoint::Draw as usize][&variant];
        let [width, height] = resolved.scene.size_px;
        let side = tile_side(resolved.scene.samples);
        let mut image = RgbaImage::new(width, height);
        let tiles: Vec<[u32; 4]> = (0..height.div_ceil(side))
            .flat_map(|row| (0..width.div_ceil(side)).map(move |column| [column * side, row * side]))
            .map(|[x, y]| [x, y, side.min(width - x), side.min(height - y)])
            .collect();
        self.gpu.guarded(|| {
            let target = TileTarget::new(&self.gpu, side);
            let mut params = FaceParams::of(resolved);
            let params_buffer = self.gpu.uniform("params", bytemuck::bytes_of(&params));
            let mut words = layout::relief_map(resolved);
            let media = media::media_params(resolved, grid.as_ref(), &mut words);
            let media = self.gpu.uniform("media", bytemuck::bytes_of(&media));
            let words = self.gpu.storage("words", bytemuck::cast_slice(&words));
            let buffers = [&params_buffer, &target.pixels, &words, &media];
            if let (Some(grid), Some(light)) = (&grid, &self.light) {
                let groups = self.bind_groups(resolved, buffers, &self.no_light);
                let pipeline = &self.pipelines[EntryPoint::Carry as usize][&variant];
                let own = (&self.light_layout, &params_buffer, &words);
                light.carry(&self.gpu, pipeline, own, &groups[1..], grid, progress)?;
            }
            let carried = self.light.as_ref().filter(|_| grid.is_some()).map_or(&self.no_light, |light| &light.volume);
            let groups = self.bind_groups(resolved, buffers, carried);
            progress.begin("render", tiles.len() as u64);
            for tile in tiles {
                params.tile = tile;
                self.gpu.queue.write_buffer(&params_buffer, 0, bytemuck::bytes_of(&params));
                target.draw(&self.gpu, pipeline, &groups, tile, &mut image)?;
                progress.step(1)?;
            }
            Ok(())
        })?;
        Ok(image)
    }

    fn make_pipeline(&mut self, variant: &Variant, pass: EntryPoint) -> Result<(), RenderError> {
        if !self.pipelines[pass as usize].contains_key(variant) {
            let pipeline = self.gpu.guarded(|| Ok(on_a_large_stack(|| self.pipeline(variant, pass))))?;
            self.pipelines[pass as usize].insert(variant.clone(), pipeline);
        }
        Ok(())
    }

    fn pipeline(&self, variant: &Variant, pass: EntryPoint) -> wgpu::ComputePipeline {
        let constants: Vec<_> = variant.iter().map(|&(name, value)| (name, f64::from(value))).collect();
        let (label, layout) = match pass {
            EntryPoint::Draw => ("draw", &self.pipeline_layout),
            EntryPoint::Carry => ("carry", &self.light_pipeline_layout),
        };
        self.gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(label),
            layout: Some(layout),
            module: &self.module,
            entry_point: Some(label),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: &constants,
                ..wgpu::PipelineCompilationOptions::default()
            },
            cache: None,
        })
    }

    /// The bind groups of a picture. `buffers`: parameters, pixels, words, media.
    fn bind_groups(
        &self,
        resolved: &ResolvedScene,
        buffers: [&wgpu::Buffer; 4],
        light: &wgpu::Texture,
    ) -> [wgpu::BindGroup; 4] {
        let [params, pixels, words, media] = buffers;
        let gpu = &self.gpu;
        let tables = &resolved.tables;
        let storage = |label: &str, bytes: &[u8]| gpu.storage(label, bytes);
        let globals = gpu.uniform("ttf", bytemuck::bytes_of(&tables.globals));
        let layers = storage("layers", bytemuck::cast_slice(&tables.layers));
        let intervals = storage("intervals", bytemuck::cast_slice(&tables.intervals));
        let mut entries = tables.scalars.clone();
        for entry in &mut entries {
            // WGSL does not guarantee infinities.
            entry.range = entry.range.map(|end| end.clamp(f32::MIN, f32::MAX));
        }
        let scalars = storage("scalar entries", bytemuck::cast_slice(&entries));
        let stops = storage("stops", bytemuck::cast_slice(&tables.stops));
        let no_buffer = storage("none", &[]);
        let no_info = gpu.uniform("no model", &[]);
        let none = || no_buffer.as_entire_binding();
        let (infos, texels) = match &self.textures {
            Some(textures) => (textures.infos.as_entire_binding(), textures.texels.as_entire_binding()),
            None => (none(), none()),
        };
        let mut volume_infos = [VolumePlacement::default(); MAX_VOLUMES];
        let views: Vec<wgpu::TextureView> = (0..MAX_VOLUMES)
            .map(|slot| {
                let volume = resolved.volumes.get(slot).copied().flatten();
                let texture = volume.and_then(|v| self.volumes.get(v.name)).unwrap_or(&self.no_volume);
                if let Some(volume) = volume {
                    volume_infos[slot] = VolumePlacement::of(&volume);
                }
                texture.create_view(&wgpu::TextureViewDescriptor::default())
            })
            .collect();
        let volume_infos = gpu.uniform("volumes", bytemuck::cast_slice(&volume_infos));
        let mut volumes = vec![volume_infos.as_entire_binding()];
        volumes.extend(views.iter().map(wgpu::BindingResource::TextureView));
        let candidates = self.candidates.as_ref().unwrap_or(&self.no_candidates);
        let others = [&candidates.distances, &candidates.leaves, light];
        let others = others.map(|texture| texture.create_view(&wgpu::TextureViewDescriptor::default()));
        volumes.extend([media.as_entire_binding(), wgpu::BindingResource::Sampler(&self.filtering)]);
        volumes.extend(others.iter().map(wgpu::BindingResource::TextureView));
        let packed = self.packed.as_ref().unwrap_or(&self.no_packed);
        let packed_view = packed.texture.create_view(&wgpu::TextureViewDescriptor::default());
        let mut model = match &self.model {
            Some(m) => [&m.info, &m.sheets, &m.faults, &m.rules].map(wgpu::Buffer::as_entire_binding).to_vec(),
            None => vec![no_info.as_entire_binding(), none(), none(), none()],
        };
        let pool: &[wgpu::Buffer] = self.model.as_ref().map_or(&[], |m| &m.pool);
        model.extend((0..POOL_BUFFERS).map(|n| pool.get(n).map_or_else(none, wgpu::Buffer::as_entire_binding)));
        model.extend([packed.info.as_entire_binding(), wgpu::BindingResource::TextureView(&packed_view)]);
        model.extend(match &self.grids {
            Some(grids) => [&grids.infos, &grids.columns, &grids.offsets].map(wgpu::Buffer::as_entire_binding),
            None => [none(), none(), none()],
        });
        let group = |index: usize, resources: Vec<wgpu::BindingResource>| {
            let entries: Vec<_> =
                (0u32..).zip(resources).map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource }).collect();
            gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("faces"),
                layout: &self.layouts[index],
                entries: &entries,
            })
        };
        let tables = [&globals, &layers, &intervals, &scalars, &stops].map(wgpu::Buffer::as_entire_binding);
        [
            group(0, [params, pixels, words].map(wgpu::Buffer::as_entire_binding).to_vec()),
            group(1, [infos, texels].into_iter().chain(tables).collect()),
            group(2, volumes),
            group(3, model),
        ]
    }
}

/// Stack for compiling shaders, bytes. The compiler of the software driver recurses deeply, and the threads
/// of tests and pools have small stacks.
const COMPILER_STACK: usize = 64 << 20;

/// Runs work on a thread with a large stack, or on this thread if none can be started.
fn on_a_large_stack<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    let (sender, receiver) = std::sync::mpsc::channel();
    let mut work = Some(work);
    std::thread::scope(|scope| {
        let taken = &mut work;
        let builder = std::thread::Builder::new().stack_size(COMPILER_STACK);
        let spawned = builder.spawn_scoped(scope, move || {
            if let Some(work) = taken.take() {
                // The receiver lives until the scope has ended.
                let _ = sender.send(work());
            }
        });
        drop(spawned);
    });
    match (receiver.try_recv(), work) {
        (Ok(made), _) => made,
        (Err(_), Some(work)) => work(),
        (Err(_), None) => unreachable!("a thread that took the work sends its result or its panic"),
    }
}

/// The layouts of the four bind groups: picture, textures and tables, volumes, model.
fn bind_group_layouts(gpu: &Gpu) -> [wgpu::BindGroupLayout; 4] {
    let buffer = |ty| wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
    let uniform = buffer(wgpu::BufferBindingType::Uniform);
    let read = buffer(wgpu::BufferBindingType::Storage { read_only: true });
    let write = buffer(wgpu::BufferBindingType::Storage { read_only: false });
    let volume = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: false },
        view_dimension: wgpu::TextureViewDimension::D3,
        multisampled: false,
    };
    let layout = |types: &[wgpu::BindingType]| {
        let entries: Vec<_> = (0u32..)
            .zip(types)
            .map(|(binding, &ty)| wgpu::BindGroupLayoutEntry {
                binding,
                visibility: wgpu::ShaderStages::COMPUTE,
                ty,
                count: None,
            })
            .collect();
        gpu.device
            .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("faces"), entries: &entries })
    };
    let texture = |sample_type| wgpu::BindingType::Texture {
        sample_type,
        view_dimension: wgpu::TextureViewDimension::D3,
        multisampled: false,
    };
    let filtered = texture(wgpu::TextureSampleType::Float { filterable: true });
    let mut volumes = vec![uniform];
    volumes.extend([texture(wgpu::TextureSampleType::Float { filterable: gpu.filters_floats }); MAX_VOLUMES]);
    volumes.extend([uniform, wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering)]);
    volumes.extend([filtered, texture(wgpu::TextureSampleType::Uint), filtered]);
    let mut model = vec![uniform, read, read, read];
    model.extend([read; POOL_BUFFERS]);
    model.extend([uniform, volume, read, read, read]);
    [
        layout(&[uniform, write, read]),
        layout(&[read, read, uniform, read, read, read, read]),
        layout(&volumes),
        layout(&model),
    ]
}
