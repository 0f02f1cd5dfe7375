//! Times the stages of the parameterization on a folded, faulted model of N³ voxels: `time_param [N …]`;
//! default 64 and 128. `time_param --definitions [N …]` times the definitions of k beside the published one.
//!
//! Four layers between horizons with dips up to 35° and thickness ± 30 %, three fault blocks.

#[path = "../tests/closed_form/mod.rs"]
mod closed_form;

use closed_form::ClosedForm;
use glam::Vec3;
use param::{KDefinition, PackedVolume, ParamSettings, Parameterization};
use std::f64::consts::TAU;
use std::time::Instant;
use survey::Progress;

/// A model with two faults that dip about 60°, with throws of 4 and 6 % of the depth.
fn model(n: usize) -> ClosedForm {
    let side = n as f64;
    let depth = move |h: usize, block: u16, x: f64, y: f64| {
        let (u, v) = (x / side, y / side);
        let level = side * (0.27 + 0.22 * h as f64);
        let fold = 0.045 * side * (TAU * (1.5 * u + 0.4 * v)).sin();
        let swell = 0.03 * side * (TAU * (0.9 * u - 0.7 * v) + 1.3 * h as f64).cos();
        level + fold + swell + side * [0.0, 0.04, 0.1][usize::from(block)]
    };
    let block_at = move |p: Vec3| {
        let (x, z) = (p.x / n as f32, p.z / n as f32);
        u16::from(x > 0.3 + 0.3 * z) + u16::from(x > 0.9 - 0.4 * z + 0.1 * p.y / n as f32)
    };
    ClosedForm::faulted([n; 3], 3, 3, depth, block_at)
}

/// Processor seconds of this process so far, which other processes do not affect. Linux; 0 elsewhere.
fn processor_s() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let ticks = stat.rsplit(')').next().unwrap_or_default().split_whitespace().skip(11).take(2);
    ticks.filter_map(|ticks| ticks.parse::<f64>().ok()).sum::<f64>() / 100.0
}

/// Times every definition on the same model, horizons smoothed at an eighth of its side as a project does, in turns, and
/// takes the fastest of three.
fn definitions(n: usize) {
    use KDefinition::{DistanceRatio, Flow, Harmonic, ParallelToBottom, ParallelToTop, Proportional};
    let model = model(n);
    let all = [DistanceRatio, Flow, Harmonic, Proportional, ParallelToBottom, ParallelToTop];
    let mut fastest = [f64::INFINITY; 6];
    let mut bytes = [0.0; 6];
    for _ in 0..3 {
        for ((definition, fastest), bytes) in all.into_iter().zip(&mut fastest).zip(&mut bytes) {
            let settings =
                ParamSettings { definitions: vec![definition; 4], flow_wave_m: n as f64 / 8.0, ..Default::default() };
            let start = processor_s();
            let param = Parameterization::compute(&model, &settings, &Progress::silent()).unwrap();
            *fastest = fastest.min(processor_s() - start);
            *bytes = param.bytes() as f64 / (n * n * n) as f64;
        }
    }
    for ((definition, seconds), bytes) in all.into_iter().zip(fastest).zip(bytes) {
        let share = seconds / fastest[0];
        println!(
            "{n:4}³ {definition:?}: {seconds:.2} s of processor time, {share:.2} of the published, {bytes:.1} bytes a voxel"
        );
    }
}

fn main() {
    if std::env::args().nth(1).is_some_and(|option| option == "--definitions") {
        let sizes = std::env::args().skip(2).filter_map(|size| size.parse().ok());
        sizes.for_each(definitions);
        return;
    }
    let sizes: Vec<usize> = std::env::args().skip(1).filter_map(|size| size.parse().ok()).collect();
    for n in if sizes.is_empty() { vec![64, 128] } else { sizes } {
        let model = model(n);
        let voxels = (n * n * n) as f64;
        let report = |stage: &str, since: (Instant, f64)| {
            let (wall, processor) = (since.0.elapsed().as_secs_f64(), processor_s() - since.1);
            println!(
                "{n:4}³ {stage:16} {wall:8.2} s, {processor:8.2} s of processor time, {:8.0} ns a voxel",
                processor / voxels * 1e9
            );
        };
        let now = || (Instant::now(), processor_s());
        let start = now();
        let param = Parameterization::compute(&model, &ParamSettings::default(), &Progress::silent()).unwrap();
        report("compute", start);
        let share = param.cost.traces.as_secs_f64() / (param.cost.closest_points + param.cost.traces).as_secs_f64();
        println!("{n:4}³ {:.0} % of that for traces", 100.0 * share);
        let start = now();
        let volumes = param.voxel_volumes(&model, param.size, &Progress::silent()).unwrap();
        report("voxel volumes", start);
        let start = now();
        let packed = PackedVolume::from_voxels(&volumes, param.size, param.layers, param.blocks);
        report("packing", start);
        let nodes: usize = param.grids.iter().map(|grid| grid.offsets.len()).sum();
        let creases: u32 = param.grids.iter().flat_map(|grid| &grid.creases).map(|word| word.count_ones()).sum();
        println!(
            "{n:4}³ {:.2} nodes and {:.1} bytes a voxel; {:.2} % of the nodes at creases; {} packed",
            nodes as f64 / voxels,
            param.bytes() as f64 / voxels,
            100.0 * f64::from(creases) / nodes as f64,
            packed.values.len()
        );
    }
}
