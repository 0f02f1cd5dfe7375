//! Measures found faults against the truth of synthetic surveys, or lists those of a SEG-Y file.

mod network;
mod peers;
mod sticks;

use faults::{FaultSurface, find, find_with_cuts};
use network::{Drawn, network, undone};
use std::path::Path;
use survey::{Progress, SurveyGeometry, Volume};
use synth::{SynthSettings, Synthetic};

fn list(found: &[FaultSurface]) {
    for (n, fault) in found.iter().enumerate() {
        let o = &fault.offsets;
        let count = fault.sheet.there.iter().filter(|t| **t).count();
        let mut middle = [0.0f32; 3];
        let (mut low, mut high) = ([f32::MAX; 3], [f32::MIN; 3]);
        for k in (0..fault.sheet.there.len()).filter(|&k| fault.sheet.there[k]) {
            let v = fault.sheet.voxel(k);
            for a in 0..3 {
                middle[a] += v[a] / count as f32;
                low[a] = low[a].min(v[a]);
                high[a] = high[a].max(v[a]);
            }
        }
        println!(
            "{n:3} {} {:.3} area {:6.0} gain {:.2} match {:.2} far {:.2} sign {:.2} beside {:.2} {:.2} contrast {:.2} throw {:5.1} const {:.2}  x {:.0}-{:.0} y {:.0}-{:.0} z {:.0}-{:.0} along {:.2},{:.2}",
            if fault.is_accepted() {
                "ACC"
            } else if fault.is_possible() {
                "pos"
            } else {
                " - "
            },
            fault.evidence,
            fault.sheet.area(),
            o.mean_gain,
            o.matched,
            o.far,
            o.one_sign,
            o.beside[0],
            o.beside[1],
            o.contrast,
            o.median,
            o.constant,
            low[0],
            high[0],
            low[1],
            high[1],
            low[2],
            high[2],
            fault.sheet.frame.along[0],
            fault.sheet.frame.along[1],
        );
    }
}

/// What a method proposes as faults.
pub struct Found<'a> {
    /// Whether a place lies within two traces of it.
    is_near: Box<dyn Fn([f32; 3]) -> bool + 'a>,
    /// The places of each surface.
    surfaces: Vec<Vec<[f32; 3]>>,
}

/// What is to be measured: `peers` compares other methods too, `-v` lists all surfaces.
fn methods<'a>(volume: &Volume<f32>, geometry: &SurveyGeometry, option: &str) -> Vec<(String, Found<'a>)> {
    let start = std::time::Instant::now();
    let mut found = find(volume, geometry, &Progress::silent()).unwrap();
    let seconds = start.elapsed().as_secs_f64();
    if option == "-v" {
        list(&found);
        println!("cuts without a throw:");
        list(&find_with_cuts(volume, geometry, &Progress::silent()).unwrap()[1]);
    }
    found.retain(FaultSurface::is_accepted);
    let cells = |f: &FaultSurface| {
        (0..f.sheet.there.len()).filter(|&k| f.sheet.there[k]).map(|k| f.sheet.voxel(k)).collect::<Vec<_>>()
    };
    let surfaces = found.iter().map(cells).collect();
    let is_on = |fault: &FaultSurface, p: [f32; 3]| {
        let [u, h] = fault.sheet.frame.place(p);
        fault.sheet.is_there(u, p[2]) && (fault.sheet.height_at(u, p[2]) - h).abs() <= 2.0
    };
    let own = Found { is_near: Box::new(move |p| found.iter().any(|fault| is_on(fault, p))), surfaces };
    let mut all = vec![(format!("petroglyph ({seconds:.1} s)"), own)];
    if option == "peers" {
        all.extend(peers::peers(volume, geometry));
    }
    all
}

fn measure_network(size: usize, seed: u64, snr: f64, option: &str) {
    let (volume, faults) = network(size, seed, snr);
    let geometry = SurveyGeometry::regular([size; 3], 25.0, 10.0, survey::VerticalUnit::Metres);
    for (method, found) in methods(&volume, &geometry, option) {
        let figures = of_network(&faults, size, &found);
        println!("network {seed} snr {snr}, {method}: {figures}");
    }
}

/// Compares with a network.
fn of_network(faults: &[Drawn], size: usize, found: &Found) -> String {
    let is_there = |k: usize, mut p: [f64; 3], least: f64, within: f64| {
        // Younger faults have moved it.
        for younger in (k + 1..faults.len()).rev() {
            p = undone(faults, younger, p);
        }
        let fault = &faults[k];
        let [u, off] = fault.place(p);
        let behind = fault.splays_from.is_some_and(|m| faults[m].place(p)[1] * faults[m].run < 0.0);
        off.abs() <= within && fault.throw(u, p[2]).abs() >= least && !behind
    };
    let (mut line, mut all, mut hits) = (String::new(), 0, 0);
    for k in 0..faults.len() {
        let (mut own, mut hit) = (0, 0);
        for x in 3..size - 3 {
            for y in 3..size - 3 {
                for z in (0..size).step_by(4) {
                    let p = [x as f64, y as f64, z as f64];
                    if !is_there(k, p, 4.0, 0.5) {
                        continue;
                    }
                    own += 1;
                    let q = p.map(|v| v as f32);
                    hit += usize::from((found.is_near)(q));
                }
            }
        }
        line += &format!(" {:.2}({own})", hit as f64 / (own.max(1)) as f64);
        all += own;
        hits += hit;
    }
    let (mut area, mut right, mut wrong) = (0, 0, 0);
    for cells in &found.surfaces {
        let is_right = |at: &&[f32; 3]| (0..faults.len()).any(|k| is_there(k, at.map(f64::from), 0.01, 2.0));
        let own = cells.iter().filter(is_right).count();
        area += cells.len();
        right += own;
        wrong += usize::from(2 * own < cells.len());
    }
    format!(
        "found {:.3} true {:.3} surfaces {} false {wrong}; by fault{line}",
        hits as f64 / all as f64,
        right as f64 / area.max(1) as f64,
        found.surfaces.len()
    )
}

/// Compares with the faults of a synthetic survey: the share of each that was found.
fn of_synthetic(made: &Synthetic, size: usize, found: &Found) -> String {
    let step = made.truth.step_m;
    let mut line = String::new();
    for fault in &made.truth.faults {
        let (mut all, mut hit) = (0, 0);
        for y in (0..size).step_by(2) {
            for z in (0..size).step_by(3) {
                let v = y as f64 * step.y;
                let x = fault.surface_u(v, z as f64 * step.z) / step.x;
                if !fault.is_real(v) || x < 0.0 || x > (size - 1) as f64 {
                    continue;
                }
                if fault.throw_at(glam::DVec2::new(x * step.x, v)).abs() < 4.0 * step.z {
                    continue;
                }
                if made.truth.salt.is_some_and(|salt| salt.holds(glam::DVec3::new(x, y as f64, z as f64) * step)) {
                    continue;
                }
                all += 1;
                let p = [x as f32, y as f32, z as f32];
                hit += usize::from((found.is_near)(p));
            }
        }
        line += &format!(" {:.3}", hit as f64 / all as f64);
    }
    let (mut area, mut right) = (0, 0);
    let mut wrong = 0;
    for cells in &found.surfaces {
        let is_right = |at: &&[f32; 3]| {
            let [x, y, z] = at.map(f64::from);
            made.truth.faults.iter().any(|fault| {
                fault.is_real(y * step.y) && (fault.surface_u(y * step.y, z * step.z) / step.x - x).abs() <= 2.0
            })
        };
        let (own, own_right) = (cells.len(), cells.iter().filter(is_right).count());
        area += own;
        right += own_right;
        wrong += usize::from(2 * own_right < own);
    }
    format!(
        "found{line}, true {:.3}, false surfaces {wrong} of {}",
        right as f64 / area.max(1) as f64,
        found.surfaces.len()
    )
}

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    if args[0] == "network" {
        let option = args.get(4).map_or("", String::as_str);
        measure_network(args[1].parse().unwrap(), args[2].parse().unwrap(), args[3].parse().unwrap(), option);
        return;
    }
    if args[0] == "synth" {
        let size: usize = args[1].parse().unwrap();
        let seed: u64 = args[2].parse().unwrap();
        let snr: f64 = args[3].parse().unwrap();
        let salt = args.get(4).is_some_and(|a| a == "salt");
        let settings = SynthSettings { size: [size; 3], seed, snr: Some(snr), salt, ..SynthSettings::default() };
        let mut made = Synthetic::generate(&settings, &Progress::silent()).unwrap();
        if args.iter().any(|a| a == "plain") {
            let mut design = synth::SynthDesign::new(&settings).unwrap();
            design.truth.faults.clear();
            let samples = design.seismic(&Progress::silent()).unwrap().lines(0..size);
            made.seismic = Volume::from_samples([size; 3], samples).unwrap();
            made.truth.faults.clear();
        }
        let option = args.last().map_or("", String::as_str);
        for (method, found) in methods(&made.seismic, &made.geometry, option) {
            let figures = of_synthetic(&made, size, &found);
            println!("seed {seed} snr {snr}{}, {method}: {figures}", if salt { " salt" } else { "" });
        }
        return;
    }
    let (geometry, volume) = read(Path::new(&args[0]));
    let start = std::time::Instant::now();
    let [found, cuts] = find_with_cuts(&volume, &geometry, &Progress::silent()).unwrap();
    println!("{:.1} s", start.elapsed().as_secs_f64());
    list(&found);
    println!("cuts without a throw:");
    list(&cuts);
    if let Some(sticks) = args.get(1) {
        sticks::measure(&std::fs::read_to_string(sticks).unwrap(), &geometry, &found);
    }
}

fn read(path: &Path) -> (SurveyGeometry, Volume<f32>) {
    let file = files::segy::read(path, &Default::default(), &Progress::silent()).unwrap();
    (file.geometry, file.volume)
}
