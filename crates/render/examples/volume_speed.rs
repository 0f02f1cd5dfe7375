//! Measures how long volumes take to draw: `cargo run -p render --example volume_speed -- [--side
//! N] [--size WxH] [--device cpu|gpu|both] [--only TEXT] [--keep FOLDER] [--dump FILE]`.
//!
//! Needs only a Vulkan driver (none with `--device cpu`). A closed-form volume of folded layers with noise is
//! drawn with one sample per voxel in an orthographic projection over a corner: unshaded, shaded by
//! gradients, and with occlusion at one slice per voxel. Each is drawn with a dense function (every sample is
//! visible, no ray ends early), a typical one (the white ramp) and a sparse one (the strongest values only),
//! the last also without empty-space skipping. Prints for each picture the best of three, after a first one
//! that compiles and uploads: wall-clock seconds, seconds of processor time of this process, and millions of
//! samples per second. `--only` draws the pictures whose name begins with TEXT, `--keep` saves them. `--dump`
//! writes the volume as raw 32-bit floats for `bench/peers.py --volume`, which draws the same picture with
//! VTK.

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

/// Folded layers with values between −1 and 1, plus uniform noise of ± 0.3.
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
    // The number of values is the product of the size.
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

/// Seconds of processor time of this process, as reported by Linux.
fn processor_seconds() -> f64 {
    let text = fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields: Vec<f64> =
        text.rsplit(')').next().unwrap_or_default().split_whitespace().filter_map(|field| field.parse().ok()).collect();
    // User and system time are fields 14 and 15 of the file, in hundredths of a second. The fields before and
    // including the process state are left out, so they are 11 and 12 here.
    fields.get(10..12).map_or(f64::NAN, |times| (times[0] + times[1]) / 100.0)
}

/// The shortest of three times, by the clock and of the processor.
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
    let inputs = Inputs { data_key: 1, ..Inputs::raw(&geometry, &volumes) };
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
