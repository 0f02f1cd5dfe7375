//! How much of interpreted horizons one click by geologic time finds on a real survey where no fault is drawn:
//! `cargo run --release -p time --example real SURVEY.sgy TRUTH [FAULT_EVIDENCE [--dump FILE]]`.
//!
//! The truth is a file as `docs/f3-chalk.txt` (horizon, what it follows, inline, first crossline, then the samples of every
//! second crossline), or an OpendTect horizon (x, y, inline, crossline, value). A click starts at each of fifteen places of
//! a horizon; a node counts as found within one sample. `--dump` writes what the click of the median found at each node.

use files::segy;
use interp::{GrowSettings, Surfaces, grow_surfaces};
use std::collections::BTreeMap;
use std::error::Error;
use std::path::Path;
use std::time::Instant;
use survey::{Progress, SurveyGeometry, Volume};
use time::{Cut, Event, Node, Reflections, Seed, Support, TimeSettings, geologic_time};

/// Distance within which a node is found, samples.
const FOUND: f32 = 1.0;
/// Clicks after the first.
const CLICKS: usize = 2;
/// Count of places at which clicks start.
const PLACES: usize = 15;
/// Crosslines between the samples of a line of a truth.
const STEP: usize = 2;

/// A node of an interpretation.
struct Known {
    trace: [usize; 2],
    z: f32,
}

/// The interpreted horizons of a file by name.
fn horizons(path: &Path, geometry: &SurveyGeometry) -> Result<BTreeMap<String, Vec<Known>>, Box<dyn Error>> {
    let [nx, ny, nz] = geometry.size();
    let mut all: BTreeMap<String, Vec<Known>> = BTreeMap::new();
    let mut add = |name: &str, lines: [f64; 2], z: f64| {
        let at = geometry.voxel_from_lines(lines[0], lines[1]).round();
        if at.x >= 0.0 && at.y >= 0.0 && at.x < nx as f64 && at.y < ny as f64 && z >= 0.0 && z <= (nz - 1) as f64 {
            let known = Known { trace: [at.x as usize, at.y as usize], z: z as f32 };
            all.entry(name.to_owned()).or_default().push(known);
        }
    };
    for line in std::fs::read_to_string(path)?.lines().filter(|line| !line.starts_with('#')) {
        let fields: Vec<&str> = line.split_whitespace().collect();
        match fields[..] {
            [_, _, inline, crossline, z] if fields[0].parse::<f64>().is_ok() => {
                let z: f64 = z.parse()?;
                add("horizon", [inline.parse()?, crossline.parse()?], geometry.vertical.index_of(z));
            }
            [name, _, inline, first, ref samples @ ..] => {
                let (inline, first): (f64, f64) = (inline.parse()?, first.parse()?);
                for (n, z) in samples.iter().enumerate().filter(|(_, z)| **z != "-") {
                    add(name, [inline, first + (STEP * n) as f64], z.parse()?);
                }
            }
            _ => return Err(format!("not understood: {line}").into()),
        }
    }
    Ok(all)
}

/// Distance of the node of an event on each trace that is closest to a known one, signed; infinite where there is none.
fn off(event: &Event, nodes: &[Known]) -> Vec<f32> {
    let key = |x: u16, y: u16| [usize::from(x), usize::from(y)];
    let nearest = |node: &Known| {
        let from = event.nodes.partition_point(|at| key(at.x, at.y) < node.trace);
        let own = event.nodes[from..].iter().take_while(|at| key(at.x, at.y) == node.trace);
        own.map(|at| at.z - node.z).min_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(f32::INFINITY)
    };
    nodes.iter().map(nearest).collect()
}

/// The wrong node that is farthest from every right one, in traces.
fn farthest_wrong(nodes: &[Known], right: &[bool]) -> Option<usize> {
    let (good, wrong): (Vec<usize>, Vec<usize>) = (0..nodes.len()).partition(|&n| right[n]);
    let apart = |a: usize, b: usize| (0..2).map(|axis| nodes[a].trace[axis].abs_diff(nodes[b].trace[axis])).max();
    let alone = |n: usize| good.iter().filter_map(|&m| apart(n, m)).min().unwrap_or(usize::MAX);
    wrong.into_iter().max_by_key(|&n| alone(n))
}

/// Difference of depth between neighbouring traces that counts as a jump, samples: about half a period.
const JUMP: f32 = 4.0;

/// How many pairs of neighbouring traces there are between which no fault lies, and between how many of them it jumps.
fn jumps(event: &Event, cuts: &[Cut], [nx, ny, _]: [usize; 3]) -> [f64; 2] {
    let mut depth = vec![f32::NAN; nx * ny];
    for node in event.nodes.iter().rev() {
        depth[usize::from(node.x) * ny + usize::from(node.y)] = node.z;
    }
    let mut count = [0.0; 2];
    for (x, y) in (0..nx).flat_map(|x| (0..ny).map(move |y| (x, y))) {
        for (i, j) in [(x + 1, y), (x, y + 1)].into_iter().filter(|(i, j)| *i < nx && *j < ny) {
            let [a, b] = [depth[x * ny + y], depth[i * ny + j]];
            let is_by_fault =
                |cut: &Cut| cut.separates([x, y], a, [i, j], b) || cut.side([x, y], a).abs() < BESIDE_FAULT;
            if a.is_finite() && b.is_finite() && !cuts.iter().any(is_by_fault) {
                count = [count[0] + f64::from(u8::from((a - b).abs() > JUMP)), count[1] + 1.0];
            }
        }
    }
    count
}

/// Traces beside a fault that are not looked at for jumps.
const BESIDE_FAULT: f32 = 1.5;

/// Prints what clicks find with some faults, of which clicks know some; returns what to dump.
fn measure(
    volume: &Volume<f32>,
    surfaces: &Surfaces,
    truth: &BTreeMap<String, Vec<Known>>,
    cuts: &[Cut],
    known: &[Cut],
    note: &str,
) -> Result<String, Box<dyn Error>> {
    let start = Instant::now();
    let found = geologic_time(volume, surfaces, &cuts.into(), &TimeSettings::default(), &Progress::silent())?;
    println!("{note}: {:.1} % known, {:.1} s", 100.0 * found.known, start.elapsed().as_secs_f64());
    let reflections = Reflections::new(surfaces, known);
    let mut dump = String::new();
    for (name, nodes) in truth {
        let mut shares: Vec<(f64, f64, Vec<f32>)> = Vec::new();
        // What two and three clicks find, and how much of what was right before each of them is right after it.
        let mut more = [(); CLICKS].map(|()| [Vec::new(), Vec::new()]);
        let mut all_kept = [[0.0; 2]; CLICKS];
        // Jumps before and after the event was examined, of nodes that are only assumed how many are right, and questions.
        let (mut jumped, mut assumed, mut asked) = ([[0.0; 2]; 2], [0.0; 2], 0);
        for place in 0..PLACES {
            let node = &nodes[(2 * place + 1) * nodes.len() / (2 * PLACES)];
            let seed = Seed { trace: node.trace, z: node.z };
            let Some(mut event) = reflections.event(&found.tau, &[seed], known) else {
                shares.push((0.0, 0.0, vec![f32::INFINITY; nodes.len()]));
                continue;
            };
            let jumps_before = jumps(&event, known, volume.size());
            asked += event.examine(&reflections, &[seed], known, volume).len();
            for (sum, count) in jumped.iter_mut().zip([jumps_before, jumps(&event, known, volume.size())]) {
                *sum = [sum[0] + count[0], sum[1] + count[1]];
            }
            let off = off(&event, nodes);
            let share = |is: &dyn Fn(f32) -> bool| off.iter().filter(|off| is(**off)).count() as f64 / off.len() as f64;
            let doubtful: Vec<&Node> = event.nodes.iter().filter(|at| at.support == Support::Assumed).collect();
            for (node, off) in nodes.iter().zip(&off) {
                let is_here =
                    |at: &&Node| [at.x, at.y].map(usize::from) == node.trace && (at.z - node.z - off).abs() < 1e-3;
                if doubtful.iter().any(is_here) {
                    assumed = [assumed[0] + f64::from(u8::from(off.abs() <= FOUND)), assumed[1] + 1.0];
                }
            }
            let mut before: Vec<bool> = off.iter().map(|off| off.abs() <= FOUND).collect();
            shares.push((share(&|off| off.abs() <= FOUND), share(&|off| off.is_finite()), off));
            let mut seeds = vec![seed];
            for ([found_by, kept], all_kept) in more.iter_mut().zip(&mut all_kept) {
                let Some(node) = farthest_wrong(nodes, &before) else { break };
                seeds.push(Seed { trace: nodes[node].trace, z: nodes[node].z });
                let Some(mut event) = reflections.event(&found.tau, &seeds, known) else { break };
                event.examine(&reflections, &seeds, known, volume);
                let after: Vec<bool> = self::off(&event, nodes).iter().map(|off| off.abs() <= FOUND).collect();
                let count = |is: &dyn Fn(usize) -> bool| (0..nodes.len()).filter(|&n| is(n)).count() as f64;
                found_by.push(count(&|n| after[n]) / nodes.len() as f64);
                let [stays, was] = [count(&|n| before[n] && after[n]), count(&|n| before[n])];
                kept.push(stays / was.max(1.0));
                *all_kept = [all_kept[0] + stays, all_kept[1] + was];
                before = after;
            }
        }
        let each: Vec<String> = shares.iter().map(|(share, _, _)| format!("{:.0}", 100.0 * share)).collect();
        let mean = 100.0 * shares.iter().map(|(share, _, _)| share).sum::<f64>() / PLACES as f64;
        shares.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (share, covered, off) = &shares[PLACES / 2];
        println!(
            "  {name}: median {:.1} %, mean {mean:.1} %; the median covers {:.1} % and is wrong at {:.1} %; places {}",
            100.0 * share,
            100.0 * covered,
            100.0 * (covered - share),
            each.join(" ")
        );
        let [before, after] = jumped.map(|[jumps, pairs]| 1e4 * jumps / f64::max(pairs, 1.0));
        println!(
            "    jumps of more than {JUMP} samples: {before:.1}, then {after:.1} of 10000 pairs; {asked} questions; {:.1} % of \
             what is assumed is right ({} nodes)",
            100.0 * assumed[0] / f64::max(assumed[1], 1.0),
            assumed[1]
        );
        for (n, of_clicks) in more.iter_mut().enumerate().filter(|(_, [found_by, _])| !found_by.is_empty()) {
            let [share, kept] = [0, 1].map(|which| {
                of_clicks[which].sort_by(f64::total_cmp);
                let all = &of_clicks[which];
                let mean = all.iter().sum::<f64>() / all.len().max(1) as f64;
                [all.get(all.len() / 2).copied().unwrap_or(f64::NAN), mean].map(|share| 100.0 * share)
            });
            println!(
                "    {} clicks: median {:.1} %, mean {:.1} %; of what was right before the last, {:.1} % stays (mean of the places {:.1} %, least {:.1} %)",
                n + 2,
                share[0],
                share[1],
                100.0 * all_kept[n][0] / f64::max(all_kept[n][1], 1.0),
                kept[1],
                100.0 * of_clicks[1].first().copied().unwrap_or(f64::NAN)
            );
        }
        for (node, off) in nodes.iter().zip(off) {
            dump += &format!("{name} {} {} {} {off}\n", node.trace[0], node.trace[1], node.z);
        }
    }
    Ok(dump)
}

fn main() -> Result<(), Box<dyn Error>> {
    let typed: Vec<String> = std::env::args().skip(1).collect();
    let [survey, truth, rest @ ..] = &typed[..] else { return Err("real SURVEY.sgy TRUTH [FAULT_EVIDENCE]".into()) };
    let quiet = Progress::silent();
    let file = segy::read(Path::new(survey), &Default::default(), &quiet)?;
    let truth = horizons(Path::new(truth), &file.geometry)?;
    let usual = GrowSettings::default();
    let fault_evidence = rest.first().map_or(Ok(usual.fault_evidence), |text| text.parse())?;
    let surfaces = grow_surfaces(&file.volume, &GrowSettings { fault_evidence, ..usual }, &quiet)?;
    let start = Instant::now();
    let found = faults::find(&file.volume, &file.geometry, &quiet)?;
    let cut = |fault: &faults::FaultSurface| Cut::of_sheet(&fault.sheet, file.volume.size());
    let cuts: Vec<Cut> = found.iter().filter(|fault| fault.is_accepted()).map(cut).collect();
    let possible: Vec<Cut> = found.iter().map(cut).collect();
    let seconds = start.elapsed().as_secs_f64();
    println!("{} faults found and {} that may be ones, {seconds:.1} s", cuts.len(), possible.len() - cuts.len());
    measure(&file.volume, &surfaces, &truth, &[], &[], "no faults")?;
    measure(&file.volume, &surfaces, &truth, &cuts, &[], "found faults, unknown to clicks")?;
    measure(&file.volume, &surfaces, &truth, &possible, &possible, "found faults and those that may be ones")?;
    let dump = measure(&file.volume, &surfaces, &truth, &cuts, &cuts, "found faults")?;
    if let [.., option, path] = rest
        && option == "--dump"
    {
        std::fs::write(path, dump)?;
    }
    Ok(())
}
