//! `--memory` holds, whatever the size of the volume, and every other command takes what is stated for it at most:
//! resident pages of every kind count.

use crate::program::command;
use files::segy::WriteOptions;
use std::fs;
use std::path::Path;
use std::process::Stdio;
use std::time::Duration;
use survey::{Progress, SurveyGeometry, VerticalUnit, Volume};

/// What is asked for, and what a command may hold beyond it.
const MEMORY_MIB: f64 = 64.0;
const TOLERANCE: f64 = 1.15;

/// What the program takes on its own, with the facts of 65 536 traces; and a buffer for each thread.
const BASE_MIB: f64 = 18.0;
const THREAD_MIB: f64 = 1.25;

/// What the program takes when it does nothing, with object storage built in: most of it is the program file itself, of
/// which more or less is resident.
const PROGRAM_MIB: f64 = 20.0;

/// Runs the program; returns the greatest resident memory that the system has noted of it, MiB.
fn peak_mib(at: &Path, line: &str) -> f64 {
    let mut child = command()
        .current_dir(at)
        .args(line.split(' '))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the program runs");
    let status = format!("/proc/{}/status", child.id());
    let mut peak = 0.0_f64;
    loop {
        let text = fs::read_to_string(&status).unwrap_or_default();
        let noted = text.lines().find_map(|line| line.strip_prefix("VmHWM:")?.split_whitespace().next()?.parse().ok());
        peak = peak.max(noted.unwrap_or(0.0) / 1024.0);
        if let Some(ended) = child.try_wait().unwrap() {
            assert!(ended.success(), "{line}");
            return peak;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
}

/// Every stage of the work on one volume, in its order, with what it may hold beyond the program itself: MiB whatever
/// the size, and bytes for each voxel. Stated above what was measured at 256³, which `docs/reliability.md` tells.
const STAGES: [(&str, f64, f64); 23] = [
    ("synth s --size @x@x@ --seed 5 --snr 8", 160.0, 0.0),
    ("info s/survey.sgy", 15.0, 1.1),
    ("import s/survey.sgy p.petro --memory 64M", 74.0, 0.0),
    ("horizon add p.petro s/horizons/Alpha.csv --name Alpha", 17.0, 1.0),
    ("horizon add p.petro s/horizons/Bravo.csv --name Bravo", 17.0, 1.0),
    ("horizon add p.petro s/horizons/Charlie.csv --name Charlie", 17.0, 1.0),
    ("attribute p.petro --kind envelope --name strength --memory 64M", 74.0, 0.0),
    ("attribute p.petro --kind semblance --name likeness --memory 64M", 74.0, 0.0),
    ("attribute p.petro --kind dip --name dip --memory 64M", 74.0, 0.0),
    ("extract p.petro", 25.0, 31.5),
    ("export p.petro c.csv --candidates", 50.0, 5.0),
    ("fault propose p.petro", 15.0, 24.0),
    ("parameterize p.petro --size 64x64x64", 33.0, 10.3),
    ("render p.petro a.png --size 800x600 --samples 1 --device cpu", 40.0, 9.5),
    ("render p.petro b.png --size 800x600 --samples 1 --device cpu --blend 1", 70.0, 6.0),
    ("render p.petro c.png --size 800x600 --samples 1 --device cpu --technique occlusion", 40.0, 19.0),
    ("render p.petro d.png --inline 150 --size-cm 16x9", 40.0, 6.0),
    ("render p.petro e.png --map Alpha --size-cm 16x9", 40.0, 6.0),
    ("export p.petro top.csv --horizon Alpha --format csv", 15.0, 1.0),
    ("export p.petro out.sgy --volume seismic", 15.0, 1.7),
    ("undo p.petro", 15.0, 0.0),
    ("check p.petro", 60.0, 3.5),
    ("prune p.petro", 15.0, 0.0),
];

/// Side of the survey on which the stages are measured, if no other one is asked for.
const SIDE: usize = 64;
/// The variable that asks for another side: `make attack` measures 256³, which takes minutes.
const SIDE_VARIABLE: &str = "PETROGLYPH_MEMORY_SIDE";

/// Carries out every stage; none may hold more than is stated for it.
#[test]
fn every_stage_keeps_to_its_bound() {
    let side = std::env::var(SIDE_VARIABLE).map_or(SIDE, |side| side.parse().expect("a side is a number of samples"));
    let folder = tempfile::tempdir().unwrap();
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let base = PROGRAM_MIB + THREAD_MIB * threads as f64;
    let mib_per_byte = side.pow(3) as f64 / f64::from(1 << 20);
    let mut beyond = Vec::new();
    for (line, fixed, bytes) in STAGES {
        let line = line.replace('@', &side.to_string());
        let peak = peak_mib(folder.path(), &line);
        let bound = base + fixed + bytes * mib_per_byte;
        eprintln!("| `{line}` | {peak:.0} | {bound:.0} |");
        if peak > bound {
            beyond.push(format!("{line}: {peak:.1} MiB, at most {bound:.1}"));
        }
    }
    assert!(beyond.is_empty(), "{beyond:#?}");
}

#[test]
fn import_and_attributes_keep_to_the_memory_they_are_given() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let size = [256; 3];
    let samples = (0..size.iter().product::<usize>()).map(|n| (n * 7919 % 60_013) as f32 - 30_000.0).collect();
    let volume = Volume::from_samples(size, samples).unwrap();
    let geometry = SurveyGeometry::regular(size, 12.5, 4.0, VerticalUnit::Milliseconds);
    files::segy::write(&at.join("a.sgy"), &geometry, &volume, &WriteOptions::default(), &Progress::silent()).unwrap();
    drop(volume);
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let limit = MEMORY_MIB * TOLERANCE + BASE_MIB + THREAD_MIB * threads as f64;
    for line in ["import a.sgy p.petro --memory 64M", "attribute p.petro --kind envelope --name envelope --memory 64M"]
    {
        let peak = peak_mib(at, line);
        assert!(peak > MEMORY_MIB / 2.0 && peak < limit, "{line}: {peak:.1} MiB, at most {limit:.1}");
    }
}

/// A lattice that is finer than the survey: what its model takes is little beside the arrays, 256 MiB.
#[test]
fn sampling_i_j_k_keeps_to_the_memory_it_is_given() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    peak_mib(at, "synth s --size 48x48x48 --seed 5");
    peak_mib(at, "import s/survey.sgy p.petro");
    peak_mib(at, "horizon add p.petro s/horizons/Alpha.csv --name Alpha");
    let model = peak_mib(at, "parameterize p.petro --size 8x8x8");
    let peak = peak_mib(at, "parameterize p.petro --size 256x256x256 --memory 64M");
    assert!(peak > MEMORY_MIB / 2.0 && peak < model + MEMORY_MIB * TOLERANCE, "{peak:.1} MiB, the model {model:.1}");
}
