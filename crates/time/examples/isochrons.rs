//! Measures isochrons for `docs/time.md`: `cargo run -p petroglyph-time --example isochrons [SIDE]`.
//!
//! An isochron from one trace of each horizon of synthetic surveys is compared with the truth on all traces.

use glam::DVec3;
use interp::{GrowSettings, grow_surfaces};
use model::FaultNetwork;
use std::error::Error;
use std::time::Instant;
use survey::{Progress, Volume};
use synth::{SynthSettings, Synthetic};
use time::{Cut, TimeSettings, geologic_time};

/// Error that stands for no crossing, samples.
const NO_CROSSING: f64 = 99.0;
/// Traces from which isochrons start, as shares of the survey's sides.
const SHARES: [f64; 4] = [0.12, 0.37, 0.62, 0.88];

/// Errors of isochrons in samples.
#[derive(Default, Clone)]
struct Errors {
    same: Vec<f64>,
    other: Vec<f64>,
}

/// Median / 95 % / share within one sample.
fn figures(errors: &mut [f64]) -> String {
    if errors.is_empty() {
        return "–".to_owned();
    }
    errors.sort_by(f64::total_cmp);
    let at = |share: f64| errors[((errors.len() - 1) as f64 * share) as usize];
    let within = errors.iter().filter(|&&e| e <= 1.0).count() as f64 / errors.len() as f64;
    format!("{:.2} / {:.1} / {:.1} %", at(0.5), at(0.95), within * 100.0)
}

/// The crossing of `time` on a trace that is closest to `z`.
fn error_at(trace: &[f32], time: f32, z: f64) -> f64 {
    let mut least = NO_CROSSING;
    for (n, pair) in trace.windows(2).enumerate() {
        if pair[0] <= time && pair[1] > time {
            let at = n as f64 + f64::from((time - pair[0]) / (pair[1] - pair[0]));
            least = least.min((at - z).abs());
        }
    }
    least
}

fn value(trace: &[f32], z: f64) -> f32 {
    let low = (z as usize).min(trace.len() - 2);
    trace[low] + (z - low as f64) as f32 * (trace[low + 1] - trace[low])
}

/// Errors of the isochrons of each horizon.
fn measure(survey: &Synthetic, tau: &Volume<f32>) -> Vec<Errors> {
    let truth = &survey.truth;
    let [nx, ny, _] = truth.size;
    let blocks = truth.block_count() as u16;
    (0..truth.horizons.len())
        .map(|h| {
            let mut errors = Errors::default();
            let mut nodes = Vec::new();
            for (x, y) in (0..nx).flat_map(|x| (0..ny).map(move |y| (x, y))) {
                for block in (0..blocks).filter(|&block| truth.exists(h, block, x as f64, y as f64)) {
                    nodes.push((x, y, block, truth.sheet_z(h, block, x as f64, y as f64)));
                }
            }
            for (sx, sy) in SHARES.iter().flat_map(|a| SHARES.iter().map(move |b| (a, b))) {
                let (sx, sy) = ((sx * nx as f64) as usize, (sy * ny as f64) as usize);
                let Some(&(_, _, home, z)) = nodes.iter().find(|&&(x, y, ..)| (x, y) == (sx, sy)) else { continue };
                let p = DVec3::new(sx as f64, sy as f64, z);
                let step = truth.step_m.x;
                if (0..truth.faults.len()).any(|f| truth.fault_side_m(f, p).abs() < 3.0 * step) {
                    continue;
                }
                let time = value(tau.trace(sx, sy), z);
                if !time.is_finite() {
                    continue;
                }
                for &(x, y, block, z) in nodes.iter().step_by(7) {
                    let error = error_at(tau.trace(x, y), time, z);
                    if block == home { errors.same.push(error) } else { errors.other.push(error) }
                }
            }
            errors
        })
        .collect()
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let side: usize = arguments.next().map_or(Ok(128), |side| side.parse())?;
    let seeds: Vec<u64> = arguments.next().map_or(Ok(vec![1]), |text| text.split(',').map(str::parse).collect())?;
    let ratios: Vec<f64> = arguments.next().map_or(Ok(vec![3.0]), |text| text.split(',').map(str::parse).collect())?;
    let progress = Progress::silent();
    for snr in ratios {
        for &seed in &seeds {
            let settings = SynthSettings { size: [side; 3], seed, snr: Some(snr), ..SynthSettings::default() };
            let survey = Synthetic::generate(&settings, &progress)?;
            let start = Instant::now();
            let surfaces = grow_surfaces(&survey.seismic, &GrowSettings::default(), &progress)?;
            let extraction = start.elapsed().as_secs_f64();
            let network = FaultNetwork::build(&survey.geometry, &survey.faults, &progress)?;
            let cuts = Cut::of_network(&network, surfaces.size);
            if std::env::var("TRACE").is_ok() {
                for f in 0..3 {
                    let (l, n) = (survey.truth.size[1] as f64 - 1.0, side as f64);
                    let t = [(0.0, 0.2), (0.0, 0.8), (l / 2.0, 0.5), (l, 0.2), (l, 0.8)].map(|(y, d)| {
                        let u = survey.truth.faults[f].surface_u(y * survey.truth.step_m.y, d * n * survey.truth.step_m.z) / survey.truth.step_m.x;
                        survey.truth.throw_m(f, u, y) / survey.truth.step_m.z
                    });
                    eprintln!("true {f}: {t:.1?}");
                }
            }
            let start = Instant::now();
            let time = geologic_time(&survey.seismic, &surfaces, &cuts, &TimeSettings::default(), &progress)?;
            let seconds = start.elapsed().as_secs_f64();
            let per_horizon = measure(&survey, &time.tau);
            let mut all = Errors::default();
            for errors in &per_horizon {
                all.same.extend(&errors.same);
                all.other.extend(&errors.other);
            }
            println!(
                "| {snr} | {seed} | {} | {} | {:.2} % | {} | {extraction:.1} + {seconds:.1} s",
                figures(&mut all.same),
                figures(&mut all.other),
                time.not_monotone * 100.0,
                time.steps
            );
            for (horizon, mut errors) in survey.truth.horizons.iter().zip(per_horizon) {
                println!("    {:14} {} | {}", horizon.name, figures(&mut errors.same), figures(&mut errors.other));
            }
        }
    }
    Ok(())
}
