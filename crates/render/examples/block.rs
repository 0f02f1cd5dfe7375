//! Draws a block of the synthetic survey: `cargo run -p render --example block -- OUT_DIR [SIZE]
//! [PICTURE]`.
//!
//! Writes illustrative, raw and half-blended pictures, a corner cut, a stair and the ground as relief, each
//! by the CPU reference and by the GPU. Prints their times and differences.

#[expect(dead_code, reason = "tests use the rest")]
#[path = "../tests/pictures/compare.rs"]
mod compare;

use compare::compare;
use glam::DVec3;
use model::{ModelSettings, StructuralModel};
use param::{PackedVolume, ParamSettings, Parameterization};
use render::{Corner, Ground, Inputs, Lookup, NamedVolume, Renderer, Samples, Scene, VoxelBox};
use std::error::Error;
use std::path::Path;
use std::time::Instant;
use survey::Progress;
use synth::{SynthSettings, Synthetic};
use ttf::{
    BlockExtent, ColourMap, LayerExtent, RawColour, RgbaFunction, TextureLibrary, TransferFunctions, TtfTables,
    symmetric_clip,
};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let out = arguments.next().unwrap_or_else(|| "out/block".to_owned());
    let side: usize = arguments.next().map_or(Ok(96), |n| n.parse())?;
    let only = arguments.next();
    std::fs::create_dir_all(&out)?;
    let progress = Progress::silent();
    let settings = SynthSettings { size: [side, side, side], ..SynthSettings::default() };
    let synthetic = Synthetic::generate(&settings, &progress)?;
    let geometry = &synthetic.geometry;
    let model = StructuralModel::build(
        geometry,
        &synthetic.stratigraphy,
        &synthetic.horizons,
        &synthetic.faults,
        &ModelSettings::default(),
        &progress,
    )?;
    let started = Instant::now();
    let param = Parameterization::compute(&model, &ParamSettings::default(), &progress)?;
    println!("parameterized in {:.1?}, {} MB", started.elapsed(), param.bytes() >> 20);
    let voxels = param.voxel_volumes(&model, model.size(), &progress)?;
    let packed = PackedVolume::from_voxels(&voxels, model.size(), model.layer_count(), model.block_count());

    let clip = symmetric_clip(synthetic.seismic.samples(), 0.99).unwrap_or(1.0);
    let raw = RawColour::new("seismic", RgbaFunction::centred(ColourMap::Grey, clip));
    let functions = TransferFunctions { raw: Some(raw), ..TransferFunctions::default() };
    let library = TextureLibrary::builtin()?;
    let extent = geometry.metric_from_voxel() * DVec3::from_array(VoxelBox::of_size(geometry.size()).max);
    let names = synthetic.stratigraphy.layer_names_bottom_up();
    let layers =
        names.iter().map(|name| LayerExtent { name: name.clone(), thickness_m: extent.z as f32 / names.len() as f32 });
    let block = BlockExtent {
        extent_i_m: extent.x as f32,
        extent_j_m: extent.y as f32,
        layers: layers.collect(),
        metres_per_mm: extent.x as f32 / 120.0,
    };
    let tables = TtfTables::compile(&functions, &block, &library)?;
    let covers = VoxelBox {
        min: synthetic.attribute.origin.to_array(),
        max: (synthetic.attribute.origin + synthetic.attribute.extent).to_array(),
    };
    let volumes = [
        NamedVolume::whole("seismic", &synthetic.seismic),
        NamedVolume { name: "impedance", volume: Samples::Whole(&synthetic.attribute.volume), covers },
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
    let whole = VoxelBox::of_size(geometry.size());
    let base = Scene { size_px: [800, 640], samples: 2, exaggeration: 1.5, ..Scene::default() };
    let nearest = base.view(geometry).nearest_corner(&whole);
    let mut renderer = Renderer::headless()?;
    println!("on {}", renderer.adapter_name());
    for (name, scene) in scenes(&base, &whole, nearest) {
        if only.as_ref().is_some_and(|only| only != name) {
            continue;
        }
        let picture = |kind: &str| Path::new(&out).join(format!("{name}{kind}.png"));
        let started = Instant::now();
        let reference = render::reference::render(&scene, &inputs, &progress)?;
        let cpu = started.elapsed();
        reference.save(picture("-cpu"))?;
        renderer.render(&scene, &inputs, &progress)?;
        let started = Instant::now();
        let image = renderer.render(&scene, &inputs, &progress)?;
        println!("{name}: CPU {cpu:.2?}, GPU {:.2?}, {:?}", started.elapsed(), compare(&reference, &image));
        image.save(picture(""))?;
    }
    Ok(())
}

/// The scenes by name.
fn scenes(base: &Scene, whole: &VoxelBox, nearest: Corner) -> Vec<(&'static str, Scene)> {
    let cut = vec![whole.corner_cut(nearest, [0.45, 0.45])];
    vec![
        ("illustrative", base.clone()),
        ("half", Scene { blend: 0.5, ..base.clone() }),
        ("raw", Scene { blend: 1.0, ..base.clone() }),
        ("corner", Scene { cut_outs: cut.clone(), ..base.clone() }),
        ("packed", Scene { cut_outs: cut.clone(), lookup: Lookup::Packed, ..base.clone() }),
        ("stair", Scene { cut_outs: whole.stair(nearest, [0.6, 0.6], 0.8, 3), ..base.clone() }),
        ("ground", Scene { cut_outs: cut, ground: Some(Ground::default()), ..base.clone() }),
    ]
}
