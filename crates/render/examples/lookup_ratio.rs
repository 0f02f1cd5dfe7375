//! Times three textured faces with the exact lookup and with the paper's packed, extrapolated one on the same driver:
//! `cargo run -p petroglyph-render --example lookup_ratio -- [SIZE] [REPEATS]`.
//!
//! Prints the median time of each and their ratio, which may be at most 3.

use glam::DVec3;
use param::{PackedVolume, ParamSettings, Parameterization};
use render::{Inputs, Lookup, Outlines, Renderer, Scene, VoxelBox};
use std::error::Error;
use std::time::Instant;
use survey::Progress;
use survey::model::{ModelSettings, StructuralModel};
use survey::synth::{SynthSettings, Synthetic};
use ttf::{BlockExtent, LayerExtent, TextureLibrary, TransferFunctions, TtfTables};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let side: usize = arguments.next().map_or(Ok(128), |n| n.parse())?;
    let repeats: usize = arguments.next().map_or(Ok(5), |n| n.parse())?;
    let quiet = Progress::silent();
    let settings = SynthSettings { size: [side; 3], ..SynthSettings::default() };
    let synthetic = Synthetic::generate(&settings, &quiet)?;
    let (geometry, stratigraphy) = (&synthetic.geometry, &synthetic.stratigraphy);
    let settings = ModelSettings::default();
    let model =
        StructuralModel::build(geometry, stratigraphy, &synthetic.horizons, &synthetic.faults, &settings, &quiet)?;
    let param = Parameterization::compute(&model, &ParamSettings::default(), &quiet)?;
    let voxels = param.voxel_volumes(&model, model.size(), &quiet)?;
    let packed = PackedVolume::from_voxels(&voxels, model.size(), model.layer_count(), model.block_count());
    let extent = geometry.metric_from_voxel() * DVec3::from_array(VoxelBox::of_size(geometry.size()).max);
    let names = stratigraphy.layer_names_bottom_up();
    let thickness_m = extent.z as f32 / names.len() as f32;
    let block = BlockExtent {
        extent_i_m: extent.x as f32,
        extent_j_m: extent.y as f32,
        layers: names.into_iter().map(|name| LayerExtent { name, thickness_m }).collect(),
        metres_per_mm: extent.x as f32 / 120.0,
    };
    let tables = TtfTables::compile(&TransferFunctions::default(), &block, &TextureLibrary::builtin()?)?;
    let inputs = Inputs {
        geometry,
        model: Some(&model),
        param: Some(&param),
        packed: Some(&packed),
        tables: Some(&tables),
        volumes: &[],
        candidates: None,
        wells: &[],
        version: 1,
    };
    let mut renderer = Renderer::headless()?;
    let scene = Scene { size_px: [800, 800], samples: 1, outlines: Outlines::none(), ..Scene::default() };
    println!("{} voxels a side, {} blocks, on {}", side, model.block_count(), renderer.adapter_name());
    let mut medians = Vec::new();
    for lookup in [Lookup::Exact, Lookup::Packed] {
        let scene = Scene { lookup, ..scene.clone() };
        // The first uploads and compiles.
        renderer.render(&scene, &inputs, &quiet)?;
        let mut seconds = Vec::new();
        for _ in 0..repeats {
            let started = Instant::now();
            renderer.render(&scene, &inputs, &quiet)?;
            seconds.push(started.elapsed().as_secs_f64());
        }
        seconds.sort_by(f64::total_cmp);
        println!("{lookup:?}: {:.3} s", seconds[repeats / 2]);
        medians.push(seconds[repeats / 2]);
    }
    println!("ratio {:.2} (at most 3)", medians[0] / medians[1]);
    Ok(())
}
