//! Measures isochrons for `docs/time.md`: `cargo run -p time --example isochrons [SIDE] [SNR SEED]`.
//!
//! With a signal-to-noise ratio and a seed, that survey alone, with its faults drawn and found (`drawn` after it: only
//! drawn); `--dump FILE` then writes
//! its amplitudes for other programs (float32), and `--tau FILE` measures the τ that one of them wrote
//! (`bench/time_peers.py`). `large SNR SEED...` prints the rows of surveys of 256³ samples.
//!
//! An isochron from one trace of each horizon of synthetic surveys is compared with the truth on all traces.

use glam::DVec3;
use interp::{GrowSettings, Surfaces, grow_surfaces};
use model::FaultNetwork;
use std::error::Error;
use std::time::Instant;
use survey::{Progress, Volume};
use synth::{SynthSettings, Synthetic};
use time::{Cut, Event, Node, Reflections, Seed, TimeSettings, geologic_time};

/// Error that stands for no crossing, samples.
const NO_CROSSING: f64 = 99.0;
/// Traces from which isochrons start, as shares of the survey's sides.
const SHARES: [f64; 4] = [0.12, 0.37, 0.62, 0.88];

/// Explanations of the tables.
const NOTES: &str = "
## What falls short, and why

- Horizons inside a conformable series are right to a few tenths of a sample in all blocks. What fails are the
  unconformity and the bed below it (Charlie). Where the unconformity has no reflection of its own, its time lies on a
  steep ramp between the last bed above and the first below, and a small error of τ is a large one of depth. Beds that
  it leaves as islands have no patch from one to the next.
- Comparing the log of every tile of 8 × 8 traces with that of the survey did not help such islands here, and neither
  did cutting patches into tiles or where their vertices disagree: they are left out.
- Which faults are found on real surveys is told in `docs/faults.md`.
- Penobscot, Horizon B by clicks: see `docs/clicks.sh`.
- Where reflections are chaotic time is not known: of noise at most 1 % is, of Penobscot 96 %.
- Times were taken while the machine did other work.
";

/// Errors of isochrons in samples.
#[derive(Default, Clone)]
struct Errors {
    same: Vec<f64>,
    other: Vec<f64>,
    /// The same two for events.
    event: [Vec<f64>; 2],
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

/// The distance of the node of an event on a trace that is closest to `z`.
fn event_error(event: &Event, x: usize, y: usize, z: f64) -> f64 {
    let at = |node: &Node| (usize::from(node.x), usize::from(node.y));
    let from = event.nodes.partition_point(|node| at(node) < (x, y));
    let own = event.nodes[from..].iter().take_while(|node| at(node) == (x, y));
    own.map(|node| (f64::from(node.z) - z).abs()).fold(NO_CROSSING, f64::min)
}

fn value(trace: &[f32], z: f64) -> f32 {
    let low = (z as usize).min(trace.len() - 2);
    trace[low] + (z - low as f64) as f32 * (trace[low + 1] - trace[low])
}

/// Errors of the isochrons of each horizon.
fn measure(survey: &Synthetic, tau: &Volume<f32>, reflections: &Reflections, cuts: &[Cut]) -> Vec<Errors> {
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
                let seed = Seed { trace: [sx, sy], z: z as f32 };
                let Some(mut event) = reflections.event(tau, &[seed], cuts) else { continue };
                event.examine(reflections, &[seed], cuts, &survey.seismic);
                for &(x, y, block, z) in nodes.iter().step_by(7) {
                    errors.event[usize::from(block != home)].push(event_error(&event, x, y, z));
                    let error = error_at(tau.trace(x, y), time, z);
                    if block == home { errors.same.push(error) } else { errors.other.push(error) }
                }
            }
            errors
        })
        .collect()
}

/// Signal-to-noise ratios.
const RATIOS: [f64; 3] = [10.0, 3.0, 1.5];
/// Seeds that were used while the method was developed.
const SEEDS: [u64; 5] = [1, 2, 3, 4, 5];
/// Seeds that were not looked at.
const HELD_OUT: [u64; 2] = [8, 9];
/// Side of the large surveys.
const LARGE: usize = 256;

/// Distance of a found fault from a true one up to which they are the same, traces.
const SAME_FAULT: f32 = 3.0;

/// The share of a fault that found ones cover, and the part of the best of them that reaches beyond it, as a share too.
fn covered(truth: &Cut, found: &[Cut]) -> [f64; 2] {
    let there = truth.place.iter().filter(|place| place.is_finite()).count().max(1) as f64;
    let shares = found.iter().filter(|cut| cut.across == truth.across).map(|cut| {
        let near = |(a, b): &(&f32, &f32)| (**a - **b).abs() < SAME_FAULT;
        let both = truth.place.iter().zip(&cut.place).filter(near).count() as f64;
        let beyond = truth.place.iter().zip(&cut.place).filter(|(a, b)| a.is_nan() && b.is_finite()).count() as f64;
        [both / there, beyond / there]
    });
    shares.fold([0.0; 2], |best, next| if next[0] > best[0] { next } else { best })
}

/// Where the faults come from.
#[derive(Clone, Copy, PartialEq)]
enum Faults {
    Drawn,
    Found,
}

/// One survey.
struct Case {
    snr: f64,
    seed: u64,
    all: Errors,
    horizons: Vec<(String, Errors)>,
    not_monotone: f64,
    /// Share of the voxels at which time is known.
    known: f64,
    /// Of each true fault, the shares that were found, and found beyond it.
    coverage: Vec<[f64; 2]>,
    extraction_s: f64,
    time_s: f64,
    /// Processor time of geologic time, microseconds a voxel.
    processor_us: f64,
    /// Pairs of samples on a trace, not across a fault, of which the lower one is younger.
    decreasing: usize,
    /// Memory of geologic time at its peak beside what was there before, bytes a voxel.
    peak_bytes: f64,
}

/// Processor time that this program has used, s; 0 where the system does not tell.
fn processor_s() -> f64 {
    let text = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let ticks = text.rsplit(')').next().unwrap_or_default().split_whitespace().skip(11).take(2);
    ticks.filter_map(|field| field.parse::<f64>().ok()).sum::<f64>() / 100.0
}

/// A figure of this program's memory, bytes: `VmHWM` is the peak since [`forget_peak`], `VmRSS` what is in use. 0 where the
/// system does not tell.
fn memory_bytes(name: &str) -> f64 {
    let text = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = text.lines().find_map(|line| line.strip_prefix(name)?.strip_prefix(':'));
    let kib = line.and_then(|line| line.trim().strip_suffix(" kB")?.trim().parse::<f64>().ok());
    1024.0 * kib.unwrap_or(0.0)
}

/// Lets the peak of memory begin anew, where the system can.
fn forget_peak() {
    let _ = std::fs::write("/proc/self/clear_refs", "5");
}

/// Counts the pairs of samples on a trace, not across a fault, of which the lower one is younger.
fn decreasing(tau: &Volume<f32>, cuts: &[Cut]) -> usize {
    let [nx, ny, nz] = tau.size();
    let traces = (0..nx).flat_map(|x| (0..ny).map(move |y| [x, y]));
    let of_trace = |trace: [usize; 2]| {
        let own = tau.trace(trace[0], trace[1]);
        let cut = |z: usize| cuts.iter().any(|cut| cut.separates(trace, z as f32, trace, z as f32 + 1.0));
        (0..nz - 1).filter(|&z| own[z + 1] < own[z] && !cut(z)).count()
    };
    traces.map(of_trace).sum()
}

fn case(side: usize, snr: f64, seed: u64, faults: Faults) -> Result<Case, Box<dyn Error>> {
    let progress = Progress::silent();
    let settings = SynthSettings { size: [side; 3], seed, snr: Some(snr), ..SynthSettings::default() };
    let survey = Synthetic::generate(&settings, &progress)?;
    let start = Instant::now();
    let surfaces = grow_surfaces(&survey.seismic, &GrowSettings::default(), &progress)?;
    let extraction_s = start.elapsed().as_secs_f64();
    let network = FaultNetwork::build(&survey.geometry, &survey.faults, &progress)?;
    let mut cuts = Cut::of_network(&network, surfaces.size);
    let mut coverage = Vec::new();
    if faults == Faults::Found {
        let found = faults::find(&survey.seismic, &survey.geometry, &progress)?;
        let found: Vec<Cut> = found.iter().map(|fault| Cut::of_sheet(&fault.sheet, surfaces.size)).collect();
        coverage = cuts.iter().map(|truth| covered(truth, &found)).collect();
        cuts = found;
    }
    forget_peak();
    let before = memory_bytes("VmRSS");
    let (start, processor) = (Instant::now(), processor_s());
    let found =
        geologic_time(&survey.seismic, &surfaces, &cuts.as_slice().into(), &TimeSettings::default(), &progress)?;
    let time_s = start.elapsed().as_secs_f64();
    let processor_us = 1e6 * (processor_s() - processor) / (side * side * side) as f64;
    let peak_bytes = (memory_bytes("VmHWM") - before) / (side * side * side) as f64;
    let names = survey.truth.horizons.iter().map(|horizon| horizon.name.clone());
    let horizons: Vec<(String, Errors)> =
        names.zip(measure(&survey, &found.tau, &Reflections::new(&surfaces, &cuts), &cuts)).collect();
    let mut all = Errors::default();
    for (_, errors) in &horizons {
        all.same.extend(&errors.same);
        all.other.extend(&errors.other);
        all.event[0].extend(&errors.event[0]);
        all.event[1].extend(&errors.event[1]);
    }
    Ok(Case {
        snr,
        seed,
        all,
        horizons,
        not_monotone: found.not_monotone,
        known: found.known,
        coverage,
        extraction_s,
        time_s,
        processor_us,
        decreasing: decreasing(&found.tau, &cuts),
        peak_bytes,
    })
}

/// Headings of the last columns.
const MORE: &str = "not monotone before the last step, after it | known | extraction + time, s | processor, µs a voxel | \
                    peak, bytes a voxel";

/// Prints one row of a table.
fn row(case: &mut Case, note: &str) {
    let [same, other] = &mut case.all.event;
    println!(
        "| {} | {}{note} | {} | {} | {} | {} | {:.1} %, {} | {:.1} % | {:.1} + {:.1} | {:.1} | {:.0} |",
        case.snr,
        case.seed,
        figures(same),
        figures(other),
        figures(&mut case.all.same),
        figures(&mut case.all.other),
        case.not_monotone * 100.0,
        case.decreasing,
        case.known * 100.0,
        case.extraction_s,
        case.time_s,
        case.processor_us,
        case.peak_bytes
    );
}

/// Writes the amplitudes of a survey for other programs, or measures the levels of the τ that one of them wrote.
fn exchange(side: usize, snr: f64, seed: u64, option: &str, file: &str) -> Result<(), Box<dyn Error>> {
    let settings = SynthSettings { size: [side; 3], seed, snr: Some(snr), ..SynthSettings::default() };
    let survey = Synthetic::generate(&settings, &Progress::silent())?;
    if option == "--dump" {
        let bytes: Vec<u8> = survey.seismic.samples().iter().flat_map(|sample| sample.to_le_bytes()).collect();
        return Ok(std::fs::write(file, bytes)?);
    }
    let bytes = std::fs::read(file)?;
    let samples = bytes.chunks_exact(4).map(|four| f32::from_le_bytes([four[0], four[1], four[2], four[3]]));
    let tau = Volume::from_samples([side; 3], samples.collect())?;
    let nothing = Surfaces { size: [side; 3], ..Surfaces::default() };
    let mut all = Errors::default();
    for errors in measure(&survey, &tau, &Reflections::new(&nothing, &[]), &[]) {
        all.same.extend(errors.same);
        all.other.extend(errors.other);
    }
    println!("same block {}, other blocks {}", figures(&mut all.same), figures(&mut all.other));
    Ok(())
}

/// Prints the figures of one survey.
fn one(side: usize, snr: f64, seed: u64, only_drawn: bool) -> Result<(), Box<dyn Error>> {
    let both = [(Faults::Drawn, "drawn"), (Faults::Found, "found")];
    for (faults, note) in both.into_iter().take(if only_drawn { 1 } else { 2 }) {
        let mut case = case(side, snr, seed, faults)?;
        println!(
            "faults {note}: same block {}, other blocks {}; {:.1} % not monotone before the last step; {} after it; {:.1} % known; {:.1} + {:.1} s, {:.1} us a voxel, {:.0} bytes a voxel",
            figures(&mut case.all.same),
            figures(&mut case.all.other),
            case.not_monotone * 100.0,
            case.decreasing,
            case.known * 100.0,
            case.extraction_s,
            case.time_s,
            case.processor_us,
            case.peak_bytes
        );
        let coverage = case.coverage.iter().map(|[found, beyond]| format!("{found:.2} (+{beyond:.2})"));
        println!("  coverage: {}", coverage.collect::<Vec<_>>().join(", "));
        let [same, other] = &mut case.all.event;
        println!("  events: {}, {}", figures(same), figures(other));
        for (name, errors) in &mut case.horizons {
            let [same, other] = &mut errors.event;
            let events = [figures(same), figures(other)].join(", ");
            println!("  {name}: {}, {}; events {events}", figures(&mut errors.same), figures(&mut errors.other));
        }
    }
    Ok(())
}

/// Headings of the table of errors, and what separates them from its rows.
fn headings() {
    println!(
        "| SNR | seed | event, same block | event, other blocks | level, same block | level, other blocks | {MORE} |\n{}|",
        "|---".repeat(11)
    );
}

/// Prints the row of one survey of 256³ samples, and below it the bed that an unconformity cuts into islands.
fn large(snr: f64, seed: u64) -> Result<[Vec<f64>; 2], Box<dyn Error>> {
    let mut case = case(LARGE, snr, seed, Faults::Drawn)?;
    row(&mut case, if HELD_OUT.contains(&seed) { ", held out" } else { "" });
    let islands = case.horizons.into_iter().find(|(name, _)| name == ISLANDS);
    Ok(islands.map(|(_, errors)| errors.event).unwrap_or_default())
}

/// The bed that the unconformity cuts into islands.
const ISLANDS: &str = "Charlie";

/// Prints the rows of surveys of 256³ samples, and what became of the bed that is cut into islands.
fn all_large(cases: impl Iterator<Item = (f64, u64)>) -> Result<(), Box<dyn Error>> {
    headings();
    let mut islands = Vec::new();
    for (snr, seed) in cases {
        islands.push((snr, seed, large(snr, seed)?));
    }
    println!("\nThe bed below the unconformity, which cuts it into islands:\n");
    println!("| SNR | seed | event, same block | event, other blocks |\n|---|---|---|---|");
    for (snr, seed, [mut same, mut other]) in islands {
        println!("| {snr} | {seed} | {} | {} |", figures(&mut same), figures(&mut other));
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    if let [_, large, snr, seeds @ ..] = &std::env::args().collect::<Vec<_>>()[..]
        && large == "large"
    {
        let snr: f64 = snr.parse()?;
        let seeds: Vec<u64> = seeds.iter().map(|seed| seed.parse()).collect::<Result<_, _>>()?;
        return all_large(seeds.into_iter().map(|seed| (snr, seed)));
    }
    let side: usize = std::env::args().nth(1).map_or(Ok(128), |side| side.parse())?;
    if let [_, _, snr, seed, option, file] = &std::env::args().collect::<Vec<_>>()[..] {
        return exchange(side, snr.parse()?, seed.parse()?, option, file);
    }
    if let (Some(snr), Some(seed)) = (std::env::args().nth(2), std::env::args().nth(3)) {
        let only_drawn = std::env::args().nth(4).is_some_and(|word| word == "drawn");
        return one(side, snr.parse()?, seed.parse()?, only_drawn);
    }
    println!("# Geologic time\n");
    println!(
        "Written by `make time`, from synthetic surveys of {side}³ samples with their faults drawn. Errors in samples:\n\
         median / 95 % / share of the nodes within one sample. A pick starts at one trace of a horizon, where the horizon\n\
         truly is, and is compared with the truth on every seventh node of that horizon; up to sixteen starts a horizon. No\n\
         node counts as {NO_CROSSING}. Other blocks are those without the start. A level is τ alone; an event is what\n\
         `pick --by-time` makes of it, through the patches along it.\n"
    );
    headings();
    let seen = RATIOS.into_iter().flat_map(|snr| SEEDS.into_iter().map(move |seed| (snr, seed, "")));
    let held_out = RATIOS.into_iter().flat_map(|snr| HELD_OUT.into_iter().map(move |seed| (snr, seed, ", held out")));
    let mut cases = Vec::new();
    for (snr, seed, note) in seen.chain(held_out) {
        let mut case = case(side, snr, seed, Faults::Drawn)?;
        row(&mut case, note);
        cases.push(case);
    }
    println!("\n## By horizon\n\nEvents, SNR 3; same block, other blocks.\n");
    let names: Vec<&str> = cases[0].horizons.iter().map(|(name, _)| name.as_str()).collect();
    println!("| seed | {} |", names.join(" | "));
    println!("|---|{}", "---|".repeat(names.len()));
    for case in cases.iter_mut().filter(|case| case.snr == 3.0) {
        let of = |errors: &mut Errors| {
            let [same, other] = &mut errors.event;
            format!("{}, {}", figures(same), figures(other))
        };
        let columns: Vec<String> = case.horizons.iter_mut().map(|(_, errors)| of(errors)).collect();
        println!("| {} | {} |", case.seed, columns.join(" | "));
    }
    println!("\n## Faults found instead of drawn\n\nSNR 3. Coverage: the share of each true fault that was found.\n");
    println!("| seed | event, same block | event, other blocks | coverage |\n|---|---|---|---|");
    let seen = SEEDS.map(|seed| (seed, ""));
    for (seed, note) in seen.into_iter().chain(HELD_OUT.map(|seed| (seed, ", held out"))) {
        let mut case = case(side, 3.0, seed, Faults::Found)?;
        let [same, other] = &mut case.all.event;
        let coverage: Vec<String> = case.coverage.iter().map(|[found, _]| format!("{:.0} %", found * 100.0)).collect();
        println!("| {seed}{note} | {} | {} | {} |", figures(same), figures(other), coverage.join(", "));
    }
    println!("\n## At {LARGE}³\n\nFaults drawn.\n");
    let seeds = || SEEDS[..3].iter().copied().chain(HELD_OUT);
    all_large(RATIOS.into_iter().flat_map(|snr| seeds().map(move |seed| (snr, seed))))?;
    print!("{NOTES}");
    Ok(())
}
