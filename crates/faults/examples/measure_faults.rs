//! Measures found faults against the truth of synthetic surveys, or lists those of a SEG-Y file.

use faults::{FaultSurface, find};
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

/// A fault of a network: an ellipse on a plane with the greatest throw in its middle.
struct Drawn {
    middle: [f64; 3],
    angle: f64,
    run: f64,
    throw: f64,
    half: [f64; 2],
    splays_from: Option<usize>,
}

impl Drawn {
    /// Along strike, and across it from the plane.
    fn place(&self, p: [f64; 3]) -> [f64; 2] {
        let (dx, dy) = (p[0] - self.middle[0], p[1] - self.middle[1]);
        let (c, s) = (self.angle.cos(), self.angle.sin());
        [dx * c + dy * s, -dx * s + dy * c - self.run * (p[2] - self.middle[2])]
    }

    /// Throw next to it, samples.
    fn throw(&self, u: f64, z: f64) -> f64 {
        let r = (u / self.half[0]).powi(2) + ((z - self.middle[2]) / self.half[1]).powi(2);
        if r < 1.0 { self.throw * (1.0 - r).sqrt() } else { 0.0 }
    }
}

struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((self.0 >> 33) as f64) / f64::from(1u32 << 31)
    }
    fn between(&mut self, a: f64, b: f64) -> f64 {
        a + (b - a) * self.next()
    }
}

/// A place before fault `k` moved it.
fn undone(faults: &[Drawn], k: usize, mut p: [f64; 3]) -> [f64; 3] {
    let fault = &faults[k];
    let [u, off] = fault.place(p);
    let behind = fault.splays_from.is_some_and(|m| faults[m].place(p)[1] * faults[m].run < 0.0);
    if off * fault.run > 0.0 && !behind {
        p[2] -= fault.throw(u, p[2]) * fault.run.signum() * (-(off / 45.0).powi(2)).exp();
    }
    p
}

/// A network of faults that cross, splay and die out, on gently folded beds 12 samples apart.
fn network(size: usize, seed: u64, snr: f64) -> (Volume<f32>, Vec<Drawn>) {
    let mut random = Random(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ 0x1234_5678);
    (0..10).for_each(|_| _ = random.next());
    let n = size as f64;
    let main = random.between(0.0, std::f64::consts::PI);
    let mut faults: Vec<Drawn> = Vec::new();
    for k in 0..5 {
        let angle = main + random.between(-0.25, 0.25) + if k == 4 { 1.2 } else { 0.0 };
        let sign = if random.next() < 0.5 { -1.0 } else { 1.0 };
        faults.push(Drawn {
            middle: [random.between(0.2, 0.8) * n, random.between(0.2, 0.8) * n, random.between(0.35, 0.65) * n],
            angle,
            run: sign * random.between(0.15, 0.38),
            throw: sign * [5.0, 7.0, 10.0, 14.0, 8.0][k],
            half: [random.between(0.35, 0.9) * n, random.between(0.4, 0.9) * n],
            splays_from: None,
        });
    }
    let (m, run) = (faults[3].middle, faults[3].run);
    faults.push(Drawn {
        middle: [m[0] + 6.0 * run.signum(), m[1], m[2]],
        angle: faults[3].angle + 0.5,
        run,
        throw: 7.0 * run.signum(),
        half: [0.4 * n, 0.5 * n],
        splays_from: Some(3),
    });
    let mut reflectors = Vec::new();
    let mut z = -60.0;
    while z < n + 60.0 {
        z += random.between(8.0, 16.0);
        reflectors.push((z, random.between(0.4, 1.0) * if reflectors.len() % 2 == 0 { 1.0 } else { -1.0 }));
    }
    let [a, b, c] = [random.between(4.0, 8.0), random.between(0.0, 6.0), random.between(-0.25, 0.25)];
    let ricker = |t: f64| {
        let q = (std::f64::consts::PI * t / 8.0).powi(2);
        (1.0 - 2.0 * q) * (-q).exp()
    };
    let mut volume = Volume::filled([size; 3], 0.0f32);
    let mut energy = 0.0;
    for x in 0..size {
        for y in 0..size {
            let values: Vec<f32> = (0..size)
                .map(|z| {
                    let mut p = [x as f64, y as f64, z as f64];
                    for k in (0..faults.len()).rev() {
                        p = undone(&faults, k, p);
                    }
                    let t = p[2] - a * (std::f64::consts::TAU * p[0] / n / 1.3 + b).sin() - c * p[1];
                    reflectors.iter().filter(|(z, _)| (z - t).abs() < 12.0).map(|(z, r)| r * ricker(z - t)).sum::<f64>()
                        as f32
                })
                .collect();
            energy += values.iter().map(|v| f64::from(v * v)).sum::<f64>();
            volume.trace_mut(x, y).copy_from_slice(&values);
        }
    }
    let level = (energy / n.powi(3)).sqrt() / snr;
    // White noise through the wavelet, smoothed over a trace and its neighbours as the noise of surveys is.
    let kernel: Vec<f64> = (-12..=12).map(|k| ricker(f64::from(k))).collect();
    let norm = kernel.iter().map(|k| k * k).sum::<f64>().sqrt();
    for x in 0..size {
        for y in 0..size {
            let white: Vec<f64> =
                (0..size + 24).map(|_| (0..4).map(|_| random.between(-1.0, 1.0)).sum::<f64>() * 0.866).collect();
            for (z, value) in volume.trace_mut(x, y).iter_mut().enumerate() {
                let filtered: f64 = kernel.iter().zip(&white[z..]).map(|(k, w)| k * w).sum();
                *value += (level * filtered / norm) as f32;
            }
        }
    }
    (volume, faults)
}

fn measure_network(size: usize, seed: u64, snr: f64, verbose: bool) {
    let (volume, faults) = network(size, seed, snr);
    let geometry = SurveyGeometry::regular([size; 3], 25.0, 10.0, survey::VerticalUnit::Metres);
    let found = find(&volume, &geometry, &Progress::silent()).unwrap();
    if verbose {
        list(&found);
    }
    let found: Vec<&FaultSurface> = found.iter().filter(|f| f.is_accepted()).collect();
    let is_there = |k: usize, mut p: [f64; 3], least: f64, within: f64| {
        // Younger faults have moved it.
        for younger in (k + 1..faults.len()).rev() {
            p = undone(&faults, younger, p);
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
                    hit += usize::from(found.iter().any(|f| {
                        let [u, h] = f.sheet.frame.place(q);
                        f.sheet.is_there(u, q[2]) && (f.sheet.height_at(u, q[2]) - h).abs() <= 2.0
                    }));
                }
            }
        }
        line += &format!(" {:.2}({own})", hit as f64 / (own.max(1)) as f64);
        all += own;
        hits += hit;
    }
    let (mut area, mut right, mut wrong) = (0, 0, 0);
    for f in &found {
        let cells: Vec<usize> = (0..f.sheet.there.len()).filter(|&k| f.sheet.there[k]).collect();
        let own = cells
            .iter()
            .filter(|&&c| (0..faults.len()).any(|k| is_there(k, f.sheet.voxel(c).map(f64::from), 0.01, 2.0)))
            .count();
        area += cells.len();
        right += own;
        wrong += usize::from(2 * own < cells.len());
    }
    println!(
        "network {seed} snr {snr}: found {:.3} true {:.3} surfaces {} false {wrong}; by fault{line}",
        hits as f64 / all as f64,
        right as f64 / area.max(1) as f64,
        found.len()
    );
}

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    if args[0] == "network" {
        measure_network(args[1].parse().unwrap(), args[2].parse().unwrap(), args[3].parse().unwrap(), args.len() > 4);
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
        let found = find(&made.seismic, &made.geometry, &Progress::silent()).unwrap();
        if args.last().is_some_and(|a| a == "-v") {
            list(&found);
        }
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
                    hit += usize::from(found.iter().filter(|f| f.is_accepted()).any(|f| {
                        let [u, h] = f.sheet.frame.place(p);
                        f.sheet.is_there(u, p[2]) && (f.sheet.height_at(u, p[2]) - h).abs() <= 2.0
                    }));
                }
            }
            line += &format!(" {:.3}", hit as f64 / all as f64);
        }
        let (mut area, mut right) = (0, 0);
        let mut wrong = 0;
        for f in found.iter().filter(|f| f.is_accepted()) {
            let (mut own, mut own_right) = (0, 0);
            for k in (0..f.sheet.there.len()).filter(|&k| f.sheet.there[k]) {
                let [x, y, z] = f.sheet.voxel(k).map(f64::from);
                own += 1;
                own_right += usize::from(made.truth.faults.iter().any(|fault| {
                    fault.is_real(y * step.y) && (fault.surface_u(y * step.y, z * step.z) / step.x - x).abs() <= 2.0
                }));
            }
            area += own;
            right += own_right;
            wrong += usize::from(2 * own_right < own);
        }
        println!(
            "seed {seed} snr {snr}{}: found{line}, true {:.3}, false surfaces {wrong}, accepted {} of {}",
            if salt { " salt" } else { "" },
            right as f64 / area.max(1) as f64,
            found.iter().filter(|f| f.is_accepted()).count(),
            found.len()
        );
        return;
    }
    let (geometry, volume) = read(Path::new(&args[0]));
    let found = find(&volume, &geometry, &Progress::silent()).unwrap();
    list(&found);
    if let Some(out) = args.get(1) {
        let mut text = String::new();
        for (n, f) in found.iter().enumerate() {
            for k in (0..f.sheet.there.len()).filter(|&k| f.sheet.there[k]) {
                let [x, y, z] = f.sheet.voxel(k);
                text += &format!(
                    "{n},{},{x:.2},{y:.2},{z},{}\n",
                    i32::from(f.is_accepted()),
                    f.offsets.cells[k].map_or(f32::NAN, |cell| cell.throw)
                );
            }
        }
        std::fs::write(out, text).unwrap();
    }
}

fn read(path: &Path) -> (SurveyGeometry, Volume<f32>) {
    let file = files::segy::read(path, &Default::default(), &Progress::silent()).unwrap();
    (file.geometry, file.volume)
}
