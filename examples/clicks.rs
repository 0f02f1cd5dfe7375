//! How much of a horizon clicks by geologic time find, and how long they take, for docs/time.md:
//! `cargo run --example clicks PROJECT HORIZON [CLICKS [PLACES]]`.
//!
//! The project has geologic time and an interpretation of the horizon, which is only compared with. The first click is at
//! each of several places of it; every further click is in the middle of the largest part that is wrong. A node counts as
//! found within one sample. At the end the first two clicks are applied to the project as commands, as the window does, and
//! undone.

use interp::Extremum;
use interp::reassembly::from_horizon;
use model::FaultNetwork;
use project::Project;
use project::command::{Command, PickByTime, TimeLevel};
use project::content;
use project::interpretation::times::Times;
use std::collections::HashMap;
use std::error::Error;
use std::time::Instant;
use survey::Progress;
use survey::source::BoxSource;
use time::{Cut, Event, Seed, Support};

/// Distance within which a node is found, samples.
const FOUND: f32 = 1.0;

/// Distance from a fault within which beds are dragged and interpretations step down over several traces.
const BESIDE_FAULT: f32 = 5.0;

/// A node of the interpretation.
struct Known {
    trace: usize,
    z: f32,
    beside_fault: bool,
}

/// For each node the support and the distance, in samples, of the place of an event that lies closest on its trace.
fn nearest(event: &Event, nodes: &[Known], ny: usize) -> Vec<Option<(Support, f32)>> {
    let mut on_trace: HashMap<usize, Vec<(Support, f32)>> = HashMap::new();
    for node in &event.nodes {
        on_trace.entry(usize::from(node.x) * ny + usize::from(node.y)).or_default().push((node.support, node.z));
    }
    let closest = |node: &Known| {
        let own = on_trace.get(&node.trace)?.iter().map(|(support, z)| (*support, (z - node.z).abs()));
        own.min_by(|a, b| a.1.total_cmp(&b.1))
    };
    nodes.iter().map(closest).collect()
}

/// Counts of nodes: those that an event covers, and those of them that it goes through, by what holds it there.
#[derive(Default)]
struct Counts {
    covered: [usize; 4],
    found: [usize; 4],
    nodes: usize,
}

const SUPPORTS: [Support; 4] = [Support::Tracked, Support::Snapped, Support::Between, Support::Assumed];

impl Counts {
    fn add(&mut self, nearest: &[Option<(Support, f32)>], nodes: &[Known], beside_fault: bool) {
        let chosen: Vec<_> =
            nearest.iter().zip(nodes).filter(|(_, node)| node.beside_fault == beside_fault).map(|(at, _)| at).collect();
        self.nodes += chosen.len();
        for (support, distance) in chosen.into_iter().flatten() {
            let n = SUPPORTS.iter().position(|other| other == support).unwrap_or_default();
            self.covered[n] += 1;
            self.found[n] += usize::from(*distance <= FOUND);
        }
    }

    fn print(&self) {
        let percent = |part: usize, whole: usize| 100.0 * part as f64 / whole.max(1) as f64;
        let row = |name: &str, covered: usize, found: usize| {
            println!(
                "  {name}: {:.1} % of the nodes, {:.1} % of these found",
                percent(covered, self.nodes),
                percent(found, covered)
            );
        };
        for (n, support) in SUPPORTS.iter().enumerate() {
            row(&format!("{support:?}").to_lowercase(), self.covered[n], self.found[n]);
        }
        row("tracked and snapped", self.covered[..2].iter().sum(), self.found[..2].iter().sum());
        row("all", self.covered.iter().sum(), self.found.iter().sum());
    }
}

/// The middle of the largest part of the nodes that is wrong: the one farthest from its edge.
fn worst(nodes: &[Known], right: &[bool], [nx, ny]: [usize; 2]) -> Option<usize> {
    let mut depth = vec![0u32; nx * ny];
    let mut at = vec![usize::MAX; nx * ny];
    for (n, node) in nodes.iter().enumerate() {
        at[node.trace] = n;
        depth[node.trace] = u32::from(!right[n]);
    }
    let beside = |trace: usize| {
        let (x, y) = (trace / ny, trace % ny);
        [
            (x > 0).then(|| trace - ny),
            (x + 1 < nx).then(|| trace + ny),
            (y > 0).then(|| trace - 1),
            (y + 1 < ny).then(|| trace + 1),
        ]
    };
    let mut part = vec![0u32; nx * ny];
    let mut sizes = vec![0usize];
    for first in 0..nx * ny {
        if depth[first] == 0 || part[first] != 0 {
            continue;
        }
        let (label, mut open, mut size) = (sizes.len() as u32, vec![first], 0);
        part[first] = label;
        while let Some(trace) = open.pop() {
            size += 1;
            for other in beside(trace).into_iter().flatten().filter(|&other| depth[other] > 0) {
                if part[other] == 0 {
                    part[other] = label;
                    open.push(other);
                }
            }
        }
        sizes.push(size);
    }
    let largest = (1..sizes.len()).max_by_key(|&n| sizes[n])? as u32;
    // Grown inwards from the edge.
    for round in 1.. {
        let inner: Vec<usize> = (0..nx * ny)
            .filter(|&trace| part[trace] == largest && depth[trace] == round)
            .filter(|&trace| {
                beside(trace)
                    .into_iter()
                    .all(|other| other.is_some_and(|other| part[other] == largest && depth[other] >= round))
            })
            .collect();
        if inner.is_empty() {
            let deepest = (0..nx * ny).filter(|&trace| part[trace] == largest).max_by_key(|&trace| depth[trace])?;
            return Some(at[deepest]);
        }
        inner.into_iter().for_each(|trace| depth[trace] = round + 1);
    }
    None
}

fn main() -> Result<(), Box<dyn Error>> {
    let typed: Vec<String> = std::env::args().skip(1).collect();
    let [path, name, rest @ ..] = &typed[..] else { return Err("clicks PROJECT HORIZON [CLICKS [PLACES]]".into()) };
    let clicks: usize = rest.first().map_or(Ok(2), |text| text.parse())?;
    let places: usize = rest.get(1).map_or(Ok(15), |text| text.parse())?;
    let progress = Progress::silent();
    let mut project = Project::open(std::path::Path::new(path))?;
    let geometry = project.document().frame()?.clone();
    let [nx, ny, nz] = geometry.size();
    let entry = project.document().horizons.iter().find(|entry| entry.name == *name).ok_or("no such horizon")?;
    let horizon = content::read_horizon(project.root(), entry, &progress)?;
    let start = Instant::now();
    let times = Times::load(project.facts(), &progress)?;
    println!("read: {:.2} s", start.elapsed().as_secs_f64());
    let mut nodes = Vec::new();
    for sheet in from_horizon(&horizon, &geometry, &FaultNetwork::none()) {
        let inside = sheet.z.iter().enumerate().filter(|(_, z)| **z >= 0.0 && **z <= (nz - 1) as f32);
        nodes.extend(inside.map(|(trace, &z)| {
            let near = |cut: &Cut| cut.side([trace / ny, trace % ny], z).abs() <= BESIDE_FAULT;
            Known { trace, z, beside_fault: times.cuts.iter().any(near) }
        }));
    }
    nodes.sort_by_key(|node| node.trace);
    let near = |node: &&Known| {
        let place = [node.trace / ny, node.trace % ny];
        times.reflections.nearest(place, node.z, None, FOUND).is_some()
    };
    println!(
        "{} nodes, {:.1} % of them within a sample of a candidate",
        nodes.len(),
        100.0 * nodes.iter().filter(near).count() as f64 / nodes.len() as f64
    );
    let entry = project.document().volumes.first().ok_or("no volume")?;
    let volume = content::open_volume(project.root(), entry, &geometry)?;
    let volume = BoxSource::read_box(&volume, [0; 3], [nx, ny, nz]).map_err(|error| error.to_string())?;
    let on_peak = |node: &&Known| {
        let mut is_on_one = false;
        let trace = volume.trace(node.trace / ny, node.trace % ny);
        interp::extrema::extrema_of_trace(trace, Extremum::Peak, &mut |z, _| is_on_one |= (z - node.z).abs() <= FOUND);
        is_on_one
    };
    println!(
        "{:.1} % of them within a sample of any peak of their trace",
        100.0 * nodes.iter().filter(on_peak).count() as f64 / nodes.len() as f64
    );
    let seed = |node: &Known| Seed { trace: [node.trace / ny, node.trace % ny], z: node.z };
    let mut shares = vec![Vec::new(); clicks];
    let mut counts: Vec<[Counts; 2]> = (0..clicks).map(|_| Default::default()).collect();
    let mut slowest = 0.0f64;
    let mut first_two = Vec::new();
    for place in 0..places {
        let mut seeds = vec![seed(&nodes[(2 * place + 1) * nodes.len() / (2 * places)])];
        for (share, counts) in shares.iter_mut().zip(&mut counts) {
            let start = Instant::now();
            let Some(mut event) = times.reflections.event(&times.tau, &seeds, &times.cuts) else { break };
            event.examine(&times.reflections, &seeds, &times.cuts, &times.amplitudes);
            slowest = slowest.max(start.elapsed().as_secs_f64());
            let nearest = nearest(&event, &nodes, ny);
            counts.iter_mut().zip([false, true]).for_each(|(counts, beside)| counts.add(&nearest, &nodes, beside));
            let right: Vec<bool> = nearest.iter().map(|at| at.is_some_and(|(_, off)| off <= FOUND)).collect();
            share.push(right.iter().filter(|right| **right).count() as f64 / right.len() as f64);
            let Some(next) = worst(&nodes, &right, [nx, ny]) else { break };
            seeds.push(seed(&nodes[next]));
        }
        if place == places / 2 {
            first_two = seeds[..2.min(seeds.len())].to_vec();
        }
        let row: Vec<String> =
            shares.iter().filter_map(|all| all.get(place)).map(|s| format!("{:.1}", 100.0 * s)).collect();
        let at = seeds.iter().map(|seed| format!("{:?} {:.1}", seed.trace, seed.z)).collect::<Vec<_>>();
        println!("{} % from {}", row.join(", "), at.join("; "));
    }
    for (n, share) in shares.iter().enumerate().filter(|(_, share)| !share.is_empty()) {
        let least = share.iter().copied().fold(f64::INFINITY, f64::min);
        let mean = share.iter().sum::<f64>() / share.len() as f64;
        let mut sorted = share.clone();
        sorted.sort_by(f64::total_cmp);
        let median = sorted[sorted.len() / 2];
        let [mean, median, least] = [mean, median, least].map(|share| 100.0 * share);
        println!("{} clicks: mean {mean:.1} %, median {median:.1} %, least {least:.1} %", n + 1);
        for (counts, where_from) in counts[n].iter().zip(["farther than 5 traces from every fault", "beside faults"]) {
            println!(
                " {where_from}, {:.1} % of all nodes",
                100.0 * counts.nodes as f64 / (share.len() * nodes.len()) as f64
            );
            counts.print();
        }
    }
    println!("slowest event {slowest:.3} s");
    let mut applied = 0;
    for seed in first_two {
        let lines = geometry.lines_from_voxel(glam::DVec2::new(seed.trace[0] as f64, seed.trace[1] as f64));
        let at = [lines.x, lines.y, geometry.vertical.value_at(f64::from(seed.z))];
        let pick = PickByTime { level: TimeLevel::Through(at), horizon: "Clicked".to_owned() };
        let start = Instant::now();
        match project.apply(&Command::PickByTime(pick), &progress) {
            Ok(_) => {
                applied += 1;
                println!("click {applied} as a command: {:.2} s", start.elapsed().as_secs_f64());
            }
            Err(error) => println!("click refused: {error}"),
        }
    }
    (0..applied).try_for_each(|_| project.undo().map(|_| ()))?;
    Ok(())
}
