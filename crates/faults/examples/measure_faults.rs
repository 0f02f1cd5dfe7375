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
            "{n:3} {} {:.3} area {:6.0} gain {:.2} match {:.2} sign {:.2} beside {:.2} {:.2} contrast {:.2} throw {:5.1} const {:.2}  x {:.0}-{:.0} y {:.0}-{:.0} z {:.0}-{:.0} along {:.2},{:.2}",
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

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
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
