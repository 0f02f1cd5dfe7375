//! How long volumes take to draw: `cargo run -p petroglyph-render --example volume_speed -- [--side N] [--size WxH] [--device cpu|gpu|both] [--only TEXT]
//! [--keep FOLDER] [--dump FILE]`.
//!
//! Needs nothing but a Vulkan driver (none with `--device cpu`). A closed-form volume of bent layers with noise is drawn with one sample a voxel in a parallel
//! projection over a corner: unshaded, by gradients, and with carried occlusion at one slice a voxel; each with a dense function (every sample
//! shows a little, no ray ends early), a typical one (the white ramp) and a sparse one (the strongest values only), the sparse one also without
//! skipping. Printed per picture, the best of three after a first that compiles and uploads: seconds by the clock, seconds of processor time of this
//! process, millions of samples a second. `--only` draws the pictures whose name begins so, `--keep` saves them. `--dump` writes the volume as raw 32-bit floats for `bench/peers.py --volume`, which draws the same
//! picture with VTK.

use image::RgbaImage;
use render::media::{EmptySpace, LayerOpacity, MediumColour, white_ramp};
use render::reference::CpuRenderer;
use render::{
    Background, Camera, Faces, Inputs, Media, Medium, NamedVolume, Occlusion, Outlines, Phong, Renderer, Scene, Shading,
};
use std::error::Error;
use std::fs;
use std::time::Instant;
use survey::{Progress, SurveyGeometry, VerticalUnit, Volume};
use ttf::{Colour, RgbaFunction, RgbaStop};

/// What was typed.
struct Options {
    side: usize,
    size_px: [u32; 2],
    device: String,
    dump: Option<String>,
    keep: Option<String>,
    only: String,
}

fn options() -> Result<Options, Box<dyn Error>> {
    let mut options =
        Options { side: 256, size_px: [800, 800], device: "both".into(), dump: None, keep: None, only: String::new() };
    let mut arguments = std::env::args().skip(1);
    while let Some(name) = arguments.next() {
        let value = arguments.next().ok_or_else(|| format!("{name} needs a value"))?;
        match name.as_str() {
            "--side" => options.side = value.parse()?,
            "--size" => {
                let (width, height) = value.split_once('x').ok_or("--size is WxH")?;
                options.size_px = [width.parse()?, height.parse()?];
            }
            "--device" => options.device = value,
            "--dump" => options.dump = Some(value),
            "--keep" => options.keep = Some(value),
            "--only" => options.only = value,
            other => return Err(format!("{other}: expected --side, --size, --device, --dump, --keep or --only").into()),
        }
    }
    Ok(options)
}

/// Bent layers between −1 and 1 and noise of 0.3 to either side, the same everywhere.
fn volume(side: usize) -> Volume<f32> {
    let scale = 256.0 / side as f32;
    let values = (0..side * side * side).map(|n| {
        let (x, y, z) =
            ((n / (side * side)) as f32 * scale, (n / side % side) as f32 * scale, (n % side) as f32 * scale);
        let bend = 9.0 * (x * 0.021).sin() + 7.0 * (y * 0.027).cos();
        let mut hash = n as u32;
        hash = (hash ^ hash >> 16).wrapping_mul(0x045d_9f3b);
        hash = (hash ^ hash >> 16).wrapping_mul(0x045d_9f3b);
        let noise = ((hash ^ hash >> 16) & 0xffff) as f32 / 65_535.0 - 0.5;
        ((z + bend) * 0.35).sin() * (0.6 + 0.4 * (x * 0.05 + y * 0.04).sin()) + 0.6 * noise
    });
    // The count is the size's product.
    Volume::from_samples([side; 3], values.collect()).unwrap_or_else(|_| Volume::filled([side; 3], 0.0))
}

/// Functions by name.
fn functions() -> Vec<(&'static str, RgbaFunction)> {
    let stop = |at: f32, opacity: f32| RgbaStop { at, colour: Colour::WHITE, opacity };
    let dense = RgbaFunction { domain: [-1.3, 1.3], stops: vec![stop(0.0, 0.002), stop(1.0, 0.02)] };
    vec![("dense", dense), ("typical", white_ramp(1.3, 0.1)), ("sparse", white_ramp(1.3, 0.8))]
}

/// Pictures by name.
fn scenes(size_px: [u32; 2]) -> Vec<(String, Scene)> {
    let mut scenes = Vec::new();
    let shadings = [
        ("unshaded", Shading::Unshaded),
        ("phong", Shading::Phong(Phong::default())),
        ("occlusion", Shading::Occlusion(Occlusion { max_cells: 512, ..Occlusion::default() })),
    ];
    for (shaded, shading) in shadings {
        for (shows, function) in functions() {
            let mut media = Media {
                faces: Faces::None,
                shading,
                samples_per_voxel: 1.0,
                surroundings: vec![Medium {
                    volume: "v".into(),
                    function: function.clone(),
                    layers: LayerOpacity::Ignored,
                    colour: MediumColour::Function,
                }],
                ..Media::default()
            };
            let camera = Camera { azimuth_deg: Some(35.0), elevation_deg: 28.0, ..Camera::default() };
            let scene = |media: Media| Scene {
                size_px,
                samples: 1,
                camera,
                outlines: Outlines::none(),
                background: Background::Colour(Colour::BLACK),
                media,
                ..Scene::default()
            };
            scenes.push((format!("{shaded} {shows}"), scene(media.clone())));
            if shows == "sparse" {
                media.empty_space = EmptySpace::Sampled;
                scenes.push((format!("{shaded} {shows}, not skipping"), scene(media)));
            }
        }
    }
    scenes
}

/// Seconds of processor time of this process, as Linux tells them.
fn processor_seconds() -> f64 {
    let text = fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields: Vec<f64> =
        text.rsplit(')').next().unwrap_or_default().split_whitespace().filter_map(|field| field.parse().ok()).collect();
    // The state is no number: user and system time, the 14th and 15th of all, are the 11th and 12th here. In hundredths of a second.
    fields.get(10..12).map_or(f64::NAN, |times| (times[0] + times[1]) / 100.0)
}

/// The least of three, by the clock and of the processor.
fn time(
    mut draw: impl FnMut() -> Result<RgbaImage, render::RenderError>,
) -> Result<(f64, f64, RgbaImage), Box<dyn Error>> {
    let mut image = draw()?;
    let (mut wall, mut processor) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..3 {
        let (began, spent) = (Instant::now(), processor_seconds());
        image = draw()?;
        wall = wall.min(began.elapsed().as_secs_f64());
        processor = processor.min(processor_seconds() - spent);
    }
    Ok((wall, processor, image))
}

fn main() -> Result<(), Box<dyn Error>> {
    let options = options()?;
    let volume = volume(options.side);
    if let Some(path) = &options.dump {
        let bytes: Vec<u8> = volume.samples().iter().flat_map(|value| value.to_le_bytes()).collect();
        fs::write(path, bytes)?;
        return Ok(());
    }
    let geometry = SurveyGeometry::regular([options.side; 3], 1.0, 1.0, VerticalUnit::Metres);
    let volumes = [NamedVolume::whole("v", &volume)];
    let inputs = Inputs { version: 1, ..Inputs::raw(&geometry, &volumes) };
    let quiet = Progress::silent();
    let mut processor = CpuRenderer::default();
    let mut adapter = if options.device == "cpu" { None } else { Some(Renderer::headless()?) };
    let [width, height] = options.size_px;
    println!("{0}³ voxels, {width} x {height} pixels, one sample a voxel, 32-bit floats", options.side);
    for (name, scene) in scenes(options.size_px).into_iter().filter(|(name, _)| name.starts_with(&options.only)) {
        let report = |device: &str, (wall, spent, image): (f64, f64, RgbaImage)| -> Result<(), Box<dyn Error>> {
            println!("{name:<34} {device:<24} {wall:8.3} s  {spent:7.2} s of processor");
            if let Some(folder) = &options.keep {
                image.save(format!("{folder}/{name} {}.png", device.split(' ').next().unwrap_or_default()))?;
            }
            Ok(())
        };
        if options.device != "gpu" {
            report("processor", time(|| processor.render(&scene, &inputs, &quiet))?)?;
        }
        if let Some(adapter) = &mut adapter {
            let device = adapter.adapter_name().to_owned();
            report(&device, time(|| adapter.render(&scene, &inputs, &quiet))?)?;
        }
    }
    Ok(())
}
