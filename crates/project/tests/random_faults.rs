//! Random sets of faults: whatever is drawn, a command takes it or refuses it, and every project that results is drawn.
//!
//! Each case is a small survey with two horizons of triangulated points and one drawn by lines, and 1 to 40 faults of random
//! sticks: dipping planes that die out, twisted ones, sticks in any order and direction, listric and lying ones, ones that
//! turn by up to three quarters of a circle, sticks that cross themselves, sticks without area. `PETROGLYPH_FAULT_CASES`
//! states how many cases are tried, `PETROGLYPH_FAULT_SEED` the first.

use project::command::{AddHorizon, Age, ComputeTime, DrawHorizon, Extract, ImportVolume, PickFault};
use project::document::Drawn;
use project::pictures::load::{Request, load};
use project::pictures::{Device, Painter, scene};
use project::{Command, Facts, Project, ProjectError};
use std::f64::consts::PI;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use survey::{Contact, Progress, SurveyGeometry, VerticalUnit, Volume};

const SIZE: [usize; 3] = [36, 32, 40];
const CASES: u64 = 8;
/// Faults of one case after another.
const COUNTS: [usize; 8] = [1, 2, 3, 5, 8, 13, 2, 4];
/// Every so many cases there are forty faults.
const FORTY_EVERY: u64 = 8;
/// Every so many cases there is a volume, of which time is computed.
const TIMED_EVERY: u64 = 4;

struct Random(u64);

impl Random {
    /// In [0, 1).
    fn share(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.share()
    }

    fn below(&mut self, count: usize) -> usize {
        (self.share() * count as f64) as usize
    }
}

fn geometry() -> SurveyGeometry {
    SurveyGeometry::regular(SIZE, 25.0, 10.0, VerticalUnit::Metres)
}

/// The sticks of a random fault: inline, crossline, depth.
fn sticks(random: &mut Random) -> Vec<Vec<[f64; 3]>> {
    let [nx, ny, nz] = SIZE.map(|n| n as f64 - 1.0);
    let kind = random.below(8);
    let (cx, cy) = (random.between(0.1, 0.9) * nx, random.between(0.1, 0.9) * ny);
    let (top, base) = (random.between(-0.1, 0.4) * nz, random.between(0.5, 1.1) * nz);
    let strike = random.between(0.0, PI);
    let half = random.between(0.1, 0.8) * nx;
    let lean = random.between(-0.8, 0.8);
    let turn = if kind == 5 { random.between(1.2, 4.7) } else { random.between(-0.3, 0.3) };
    let (count, nodes) = (2 + random.below(6), 2 + random.below(5));
    let mut made: Vec<Vec<[f64; 3]>> = Vec::new();
    for n in 0..count {
        let along = 2.0 * n as f64 / (count as f64 - 1.0) - 1.0;
        let bearing = strike + 0.5 * turn * along;
        // Along an arc whose tangent turns.
        let (mut x, mut y) = (cx, cy);
        for step in 0..20 {
            let at = strike + 0.5 * turn * along * (f64::from(step) + 0.5) / 20.0;
            x += half * along * at.cos() / 20.0;
            y += half * along * at.sin() / 20.0;
        }
        let lean = if kind == 1 { lean * along * 2.0 } else { lean };
        let stick = (0..nodes).map(|k| {
            let t = k as f64 / (nodes as f64 - 1.0);
            let z = match kind {
                4 => 0.5 * (top + base) + 2.0 * t,
                _ => top + (base - top) * t,
            };
            let away = match kind {
                3 => 1.6 * nz * t.powi(3) * lean.signum(),
                4 => nz * (t - 0.5),
                6 => 0.5 * nz * (random.share() - 0.5),
                7 => 0.0,
                _ => lean * (z - 0.5 * (top + base)),
            };
            let jitter = [random.share() - 0.5, random.share() - 0.5];
            let near = |at: f64, last: f64| at.clamp(-0.2 * last, 1.2 * last);
            let (x, y) = (x - away * bearing.sin() + jitter[0], y + away * bearing.cos() + jitter[1]);
            [near(x, nx) + 1.0, near(y, ny) + 1.0, 10.0 * z]
        });
        made.push(stick.collect());
    }
    if kind == 7 {
        // Without area: all on one line, or all the same.
        let first = made[0].clone();
        made.iter_mut().skip(usize::from(random.share() < 0.5)).for_each(|stick| stick.clone_from(&first));
    }
    if matches!(kind, 2 | 6) {
        for n in (1..made.len()).rev() {
            let other = random.below(n + 1);
            made.swap(n, other);
        }
        made.iter_mut().filter(|_| random.share() < 0.5).for_each(|stick| stick.reverse());
    }
    made
}

/// A CSV of a horizon's points: flat, with a hole.
fn horizon(folder: &Path, name: &str, level: f64) -> PathBuf {
    let mut text = "inline,crossline,depth\n".to_owned();
    for il in 1..=SIZE[0] {
        for xl in 1..=SIZE[1] {
            if !((10..14).contains(&il) && (8..15).contains(&xl)) {
                let z = level + 12.0 * (il as f64 / 7.0).sin() + 8.0 * (xl as f64 / 5.0).cos();
                let _ = writeln!(text, "{il},{xl},{z:.3}");
            }
        }
    }
    let path = folder.join(format!("{name}.csv"));
    fs::write(&path, text).unwrap();
    path
}

/// A survey with horizons, and in some cases with a volume and its candidates.
fn begun(folder: &Path, is_timed: bool) -> Project {
    let mut project = Project::create(&folder.join("p.petro"), Some(geometry())).unwrap().publish().unwrap();
    let quiet = Progress::silent();
    if is_timed {
        let wave = |n: usize| {
            let (x, z) = (n / SIZE[2] / SIZE[1], n % SIZE[2]);
            ((z as f32 + 0.1 * x as f32) * 0.8).sin()
        };
        let samples = (0..SIZE.iter().product::<usize>()).map(wave).collect();
        let stored = folder.join("volume.zarr");
        let info = store::VolumeInfo::of(geometry());
        store::write_volume(&stored, &Volume::from_samples(SIZE, samples).unwrap(), &info, &quiet).unwrap();
        let import = ImportVolume {
            path: stored,
            name: Some("seismic".to_owned()),
            polarity: Default::default(),
            options: Default::default(),
            origin: None,
            memory_bytes: None,
            moved: false,
        };
        project.apply(&Command::Import(import), &quiet).unwrap();
    }
    for (name, level) in [("Upper", 130.0), ("Lower", 260.0)] {
        let command = AddHorizon {
            path: horizon(folder, name, level),
            name: name.to_owned(),
            contact: Contact::Conformable,
            age: Age::ByDepth,
            options: Default::default(),
        };
        project.apply(&Command::AddHorizon(command), &quiet).unwrap();
    }
    for line in [2.0, 18.0, 33.0] {
        let points = vec![[line, 1.0, 190.0], [line, SIZE[1] as f64, 200.0]];
        let part = Drawn::Line { points, snap: false };
        let command = DrawHorizon { horizon: "Middle".to_owned(), colour: None, part };
        project.apply(&Command::DrawHorizon(command), &quiet).unwrap();
    }
    project
}

/// Everything in the project's folder but what is derived: path and content.
fn state(root: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut found = Vec::new();
    let mut folders = vec![root.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap().map(Result::unwrap) {
            let name = entry.file_name();
            match entry.file_type().unwrap().is_dir() {
                true if name != "derived" && name != "unfinished" => folders.push(entry.path()),
                true => {}
                false => found.push((entry.path(), fs::read(entry.path()).unwrap())),
            }
        }
    }
    found.retain(|(path, _)| !path.ends_with("lock"));
    found.sort();
    found
}

fn drawn(project: &Project) -> Result<(), ProjectError> {
    let (document, quiet) = (project.document(), Progress::silent());
    let mut view = scene::choose(document, None)?;
    (view.size_px, view.samples) = ([64, 48], 1);
    scene::prepare(document, &mut view, &quiet)?;
    let loaded = load(Facts::of(project.root(), document), &Request::new(&view), &quiet)?;
    Painter::new(Device::Cpu, &quiet)?.draw(&view, &loaded, &quiet)?;
    Ok(())
}

fn stated(name: &str, or: u64) -> u64 {
    std::env::var(name).ok().and_then(|text| text.parse().ok()).unwrap_or(or)
}

#[test]
fn every_set_of_faults_that_is_taken_is_drawn() {
    let (first, cases) = (stated("PETROGLYPH_FAULT_SEED", 0), stated("PETROGLYPH_FAULT_CASES", CASES));
    let (mut taken, mut refused, mut cut) = (0, 0, 0);
    for case in first..first + cases {
        let mut random = Random(case.wrapping_mul(0x9E37_79B9_7F4A_7C15) + 1);
        let folder = tempfile::tempdir().unwrap();
        let is_timed = case % TIMED_EVERY == TIMED_EVERY - 1;
        let mut project = begun(folder.path(), is_timed);
        let count = if case % FORTY_EVERY == FORTY_EVERY - 1 { 40 } else { COUNTS[case as usize % COUNTS.len()] };
        for n in 0..count {
            let command = Command::PickFault(PickFault { name: format!("F{n}"), sticks: sticks(&mut random) });
            let before = state(project.root());
            let faults = project.document().faults.len();
            match project.apply(&command, &Progress::silent()) {
                Ok(_) => {
                    taken += 1;
                    cut += project.document().faults.len() - faults - 1;
                }
                Err(error) => {
                    refused += 1;
                    let text = error.to_string();
                    assert!(text.contains(&format!("F{n}")) || text.contains("faults"), "case {case}, F{n}: {text}");
                    assert_eq!(state(project.root()), before, "case {case}, F{n}: {text}");
                }
            }
        }
        if let Err(error) = drawn(&project) {
            panic!("case {case} with {count} faults cannot be drawn: {error}");
        }
        if is_timed {
            let extract =
                Extract { volume: None, settings: Default::default(), memory_bytes: None, just_stored: false };
            project.apply(&Command::Extract(extract), &Progress::silent()).unwrap();
            let time = ComputeTime { name: "time".to_owned(), settings: Default::default(), memory_bytes: None };
            project
                .apply(&Command::Time(time), &Progress::silent())
                .unwrap_or_else(|error| panic!("case {case}: {error}"));
        }
        let found = project::check::check(project.root(), &Progress::silent()).unwrap();
        assert!(found.is_well(), "case {case}: {:?} {:?}", found.undrawable, found.damage);
    }
    println!("{taken} faults taken, {refused} refused, {cut} more by cutting");
    assert!(cases < CASES || taken > 5 * refused, "{taken} taken, {refused} refused");
}
