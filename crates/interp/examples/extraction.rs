//! Measures extraction quality on synthetic surveys for `docs/extraction.md`.
use interp::evaluate::{EvaluateSettings, TruthIndex, evaluate_with};
use interp::{GrowSettings, grow_surfaces};
use std::time::Instant;
use survey::Progress;
use survey::synth::{SynthSettings, Synthetic};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<f64> = std::env::args().skip(1).filter_map(|a| a.parse().ok()).collect();
    let side = arguments.first().copied().unwrap_or(128.0) as usize;
    let snr = arguments.get(1).copied().unwrap_or(3.0);
    let seed = arguments.get(2).copied().unwrap_or(1.0) as u64;
    let progress = Progress::silent();
    let settings = SynthSettings { size: [side; 3], seed, snr: Some(snr), ..SynthSettings::default() };
    let survey = Synthetic::generate(&settings, &progress)?;
    let index = TruthIndex::new(&survey.truth);
    let start = Instant::now();
    let surfaces = grow_surfaces(&survey.seismic, &GrowSettings::default(), &progress)?;
    let seconds = start.elapsed().as_secs_f64();
    let large = surfaces.surfaces.iter().filter(|s| s.triangles.len() >= 500).count();
    println!(
        "{side} snr {snr} seed {seed}: {seconds:.2} s, {} surfaces, {large} large, {} triangles",
        surfaces.surfaces.len(),
        surfaces.triangles.len()
    );
    print!("{}", evaluate_with(&surfaces, &survey.truth, &index, &EvaluateSettings::default()));
    Ok(())
}
