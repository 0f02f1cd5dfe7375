//! Measures how long the scene of P-illus 5 takes: `cargo run -p render --example
//! illustration_speed -- [--side N] [--size WxH] [--device cpu|gpu|both] [--repeats N]`.
//!
//! Needs only a Vulkan driver (none with `--device cpu`). The scene is a folded, faulted synthetic survey
//! whose parameterization has N³ voxels (128, as in the paper), with a reflectance volume of 240 × 271 × 500
//! samples over all of it and an attribute of 96 × 96 × 500 over its middle. Boundaries are exact, and the
//! blend is half illustrated and half raw. The attribute fills the cut-out, with a dense function (every
//! sample is visible, no ray ends early), a typical and a sparse one; one picture is without it. The last
//! picture shows the same faces by the published packed and extrapolated lookup. The exact lookup may take
//! three times as long.
//!
//! Prints the median of the repeats, after a first picture that compiles and uploads, and pictures per
//! second.

use glam::DVec3;
use image::RgbaImage;
use model::{ModelSettings, StructuralModel};
use param::{PackedVolume, ParamSettings, Parameterization};
use render::media::{LayerOpacity, MediumColour};
use render::reference::CpuRenderer;
use render::{Inputs, Lookup, Media, Medium, NamedVolume, Renderer, Samples, Scene, VoxelBox};
use std::error::Error;
use std::time::Instant;
use survey::{Progress, Volume};
use synth::{SynthSettings, Synthetic};
use ttf::{
    BlockExtent, Colour, LayerExtent, RawColour, RgbaFunction, RgbaStop, TextureLibrary, TransferFunctions, TtfTables,
};

/// Samples of the paper's volumes.
const REFLECTANCE: [usize; 3] = [240, 271, 500];
const ATTRIBUTE: [usize; 3] = [96, 96, 500];

/// What was typed.
struct Options {
    side: usize,
    size_px: [u32; 2],
    device: String,
    repeats: usize,
}

fn options() -> Result<Options, Box<dyn Error>> {
    let mut options = Options { side: 128, size_px: [800, 800], device: "both".into(), repeats: 5 };
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
            "--repeats" => options.repeats = value.parse::<usize>()?.max(1),
            other => return Err(format!("{other}: expected --side, --size, --device or --repeats").into()),
        }
    }
    Ok(options)
}

/// Folded layers with values between −1 and 1, with a period of twenty samples.
fn bent(size: [usize; 3]) -> Result<Volume<f32>, Box<dyn Error>> {
    let [nx, ny, nz] = size;
    let samples = (0..nx * ny * nz).map(|n| {
        let (x, y, z) = ((n / (ny * nz)) as f32, (n / nz % ny) as f32, (n % nz) as f32);
        ((z + 12.0 * (x * 0.03).sin() + 9.0 * (y * 0.025).cos()) * 0.314).sin()
            * (0.7 + 0.3 * (x * 0.05 + y * 0.04).sin())
    });
    Ok(Volume::from_samples(size, samples.collect())?)
}

/// White, with one opacity at the low end of the values and another at the high end; transparent up to a
/// fraction of them.
fn white(low: f32, high: f32, clear: f32) -> RgbaFunction {
    let stop = |at: f32, opacity: f32| RgbaStop { at, colour: Colour::WHITE, opacity };
    let mut stops = vec![stop(0.0, low)];
    if clear > 0.0 {
        stops.push(stop(clear, low));
    }
    stops.push(stop(1.0, high));
    RgbaFunction { domain: [-1.0, 1.0], stops }
}

/// Pictures by name.
fn scenes(size_px: [u32; 2], whole: VoxelBox) -> Vec<(String, Scene)> {
    let half = whole.max.map(|m| 0.5 * m);
    let cut = VoxelBox { min: [half[0], 0.0, 0.0], max: [whole.max[0], half[1], whole.max[2]] };
    let scene = |functions: Option<RgbaFunction>, lookup: Lookup| {
        let medium = |function| Medium {
            volume: "attribute".into(),
            function,
            layers: LayerOpacity::Ignored,
            colour: MediumColour::Function,
        };
        let media = Media { cut_outs: functions.into_iter().map(medium).collect(), ..Media::default() };
        Scene { size_px, samples: 1, blend: 0.5, lookup, cut_outs: vec![cut], media, ..Scene::default() }
    };
    let mut scenes = vec![("faces alone".to_owned(), scene(None, Lookup::Exact))];
    for (name, function) in
        [("dense", white(0.002, 0.02, 0.0)), ("typical", white(0.0, 1.0, 0.55)), ("sparse", white(0.0, 1.0, 0.95))]
    {
        scenes.push((format!("{name} in the cut-out"), scene(Some(function), Lookup::Exact)));
    }
    scenes.push(("faces alone, packed lookup".to_owned(), scene(None, Lookup::Packed)));
    scenes
}

/// Median time in seconds of `repeats` pictures, after a first one.
fn median(
    repeats: usize,
    mut draw: impl FnMut() -> Result<RgbaImage, render::RenderError>,
) -> Result<f64, Box<dyn Error>> {
    draw()?;
    let mut seconds = Vec::new();
    for _ in 0..repeats {
        let began = Instant::now();
        draw()?;
        seconds.push(began.elapsed().as_secs_f64());
    }
    seconds.sort_by(f64::total_cmp);
    Ok(seconds[repeats / 2])
}

fn main() -> Result<(), Box<dyn Error>> {
    let options = options()?;
    let quiet = Progress::silent();
    let settings = SynthSettings { size: [options.side; 3], ..SynthSettings::default() };
    let synthetic = Synthetic::generate(&settings, &quiet)?;
    let (geometry, stratigraphy) = (&synthetic.geometry, &synthetic.stratigraphy);
    let settings = ModelSettings::default();
    let model =
        StructuralModel::build(geometry, stratigraphy, &synthetic.horizons, &synthetic.faults, &settings, &quiet)?;
    let param = Parameterization::compute(&model, &ParamSettings::default(), &quiet)?;
    let voxels = param.voxel_volumes(&model, model.size(), &quiet)?;
    let packed = PackedVolume::from_voxels(&voxels, model.size(), model.layer_count(), model.block_count());
    let whole = VoxelBox::of_size(geometry.size());
    let extent = geometry.metric_from_voxel() * DVec3::from_array(whole.max);
    let names = stratigraphy.layer_names_bottom_up();
    let thickness_m = extent.z as f32 / names.len() as f32;
    let block = BlockExtent {
        extent_i_m: extent.x as f32,
        extent_j_m: extent.y as f32,
        layers: names.into_iter().map(|name| LayerExtent { name, thickness_m }).collect(),
        metres_per_mm: extent.x as f32 / 120.0,
    };
    let raw = RawColour { volume: "reflectance".into(), no_data: None, function: white(1.0, 1.0, 0.0) };
    let functions = TransferFunctions { raw: Some(raw), ..TransferFunctions::default() };
    let tables = TtfTables::compile(&functions, &block, &TextureLibrary::builtin()?)?;
    let (reflectance, attribute) = (bent(REFLECTANCE)?, bent(ATTRIBUTE)?);
    let share = |share: f64| whole.max.map(|m| share * m);
    let volumes = [
        NamedVolume { name: "reflectance", volume: Samples::Whole(&reflectance), covers: whole },
        NamedVolume {
            name: "attribute",
            volume: Samples::Whole(&attribute),
            covers: VoxelBox { min: share(0.25), max: share(0.9) },
        },
    ];
    let inputs = Inputs {
        geometry,
        model: Some(&model),
        param: Some(&param),
        packed: Some(&packed),
        tables: Some(&tables),
        volumes: &volumes,
        candidates: None,
        wells: &[],
        data_key: 1,
    };
    let mut processor = CpuRenderer::default();
    let mut adapter = if options.device == "cpu" { None } else { Some(Renderer::headless()?) };
    let [width, height] = options.size_px;
    println!("{}³ voxels, {} blocks, {width} x {height} pixels", options.side, model.block_count());
    for (name, scene) in scenes(options.size_px, whole) {
        let report = |device: &str, seconds: f64| {
            println!("{name:<28} {device:<26} {seconds:8.4} s  {:7.1} a second", 1.0 / seconds);
        };
        if options.device != "gpu" {
            report("processor", median(options.repeats, || processor.render(&scene, &inputs, &quiet))?);
        }
        if let Some(adapter) = &mut adapter {
            let device = adapter.adapter_name().to_owned();
            report(&device, median(options.repeats, || adapter.render(&scene, &inputs, &quiet))?);
        }
    }
    Ok(())
}
