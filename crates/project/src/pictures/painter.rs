//! Draws pictures of a project, and writes PNG files with their printed size.

use crate::error::ProjectError;
use crate::folder;
use crate::pictures::load::{Loaded, Stage};
use image::RgbaImage;
use render::reference::CpuRenderer;
use render::{RenderError, Renderer, Scene};
use std::path::Path;
use std::time::Instant;
use survey::Progress;

/// The device that draws.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Device {
    /// The graphics adapter; the processor when there is none, or when the adapter is a driver that runs on
    /// the processor itself.
    #[default]
    Auto,
    /// The graphics adapter.
    Gpu,
    /// The processor.
    Cpu,
}

/// Prefixes of the names of drivers that run on the processor. Our own CPU renderer is faster than shaders run there
/// (0.6 of llvmpipe's processor time for the demonstration's pictures), and draws the same.
const SOFTWARE_DRIVERS: [&str; 2] = ["llvmpipe", "SwiftShader"];

/// Draws pictures one after the other; an adapter is looked for once.
pub struct Painter {
    renderer: Option<Renderer>,
    processor: CpuRenderer,
    device: Device,
}

impl Painter {
    /// Finds the device that draws; warns if [`Device::Auto`] falls back to the processor.
    ///
    /// # Errors
    /// [`Device::Gpu`] was asked for and there is no adapter.
    pub fn new(device: Device, progress: &Progress) -> Result<Self, RenderError> {
        let renderer = match device {
            Device::Cpu => None,
            Device::Gpu => Some(Renderer::headless()?),
            Device::Auto => match Renderer::headless() {
                Ok(renderer) => {
                    let is_software = SOFTWARE_DRIVERS.iter().any(|name| renderer.adapter_name().starts_with(name));
                    (!is_software).then_some(renderer)
                }
                Err(error) => {
                    progress.warn(format!("drawing on the processor, which is slower: {error}"));
                    None
                }
            },
        };
        Ok(Self { renderer, processor: CpuRenderer::default(), device })
    }

    /// Lets the processor keep what rays hit, in at most so many bytes, for pictures whose styles alone change.
    #[must_use]
    pub fn keeping_points(mut self, max_bytes: usize) -> Self {
        self.processor = CpuRenderer::keeping_points(max_bytes);
        self
    }

    /// The name of the device that draws.
    pub fn device(&self) -> &str {
        self.renderer.as_ref().map_or("processor", Renderer::adapter_name)
    }

    /// Whether the processor draws, which needs no more of a volume than the samples that it takes.
    pub(crate) fn is_processor(&self) -> bool {
        self.renderer.is_none()
    }

    /// Draws a scene, with raw data in the project's colours if the scene states none. If the adapter cannot draw a
    /// picture or is lost, the processor draws from then on, with a warning, unless the adapter was asked for.
    ///
    /// # Errors
    /// The scene shows nothing, or the device failed.
    pub fn draw(
        &mut self,
        scene: &Scene,
        loaded: &Loaded,
        progress: &Progress,
    ) -> Result<(RgbaImage, Stage), RenderError> {
        let start = Instant::now();
        let scene = &loaded.complete(scene);
        let volumes = loaded.named_volumes();
        let wells = loaded.well_paths();
        let inputs = loaded.inputs(&volumes, &wells);
        let drawn = self.renderer.as_mut().map(|renderer| renderer.render(scene, &inputs, progress));
        let mut image = match drawn {
            Some(Err(
                error @ (RenderError::OutOfMemory { .. }
                | RenderError::DeviceLost { .. }
                | RenderError::Unsuitable { .. }),
            )) if self.device == Device::Auto => {
                progress.warn(format!("drawing on the processor, which is slower: {error}"));
                self.renderer = None;
                self.processor.render(scene, &inputs, progress)?
            }
            Some(drawn) => drawn?,
            None => self.processor.render(scene, &inputs, progress)?,
        };
        if !scene.preset.is_colour() {
            image.pixels_mut().for_each(|pixel| pixel.0 = scene.preset.pixel(pixel.0));
        }
        Ok((image, Stage::new("picture", start.elapsed())))
    }

    /// Draws a scene as a page shows it that holds nothing else: with water over its ground, whose edges are as wide as
    /// `dpi` says.
    ///
    /// # Errors
    /// As [`Self::draw`].
    pub fn picture(
        &mut self,
        scene: &Scene,
        loaded: &Loaded,
        dpi: f64,
        progress: &Progress,
    ) -> Result<RgbaImage, RenderError> {
        let (image, _) = self.draw(scene, loaded, progress)?;
        let (volumes, wells) = (loaded.named_volumes(), loaded.well_paths());
        Ok(figure::draw::water::over(image, scene, &loaded.inputs(&volumes, &wells), dpi))
    }
}

/// Writes a PNG whose printed size follows from `dpi`, completely or not at all.
///
/// # Errors
/// The file lies inside a project or could not be written; an earlier file is then still there.
pub fn write_png(path: &Path, image: &RgbaImage, dpi: f64) -> Result<(), ProjectError> {
    folder::refuse_inside_project(path)?;
    Ok(store::replace_file(path, &page::png(image, dpi)?)?)
}
