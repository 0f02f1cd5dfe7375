//! `--memory` holds, whatever the size of the volume: resident pages of every kind count.

use crate::program::command;
use segy::WriteOptions;
use std::fs;
use std::path::Path;
use std::process::Stdio;
use std::time::Duration;
use survey::{Progress, SurveyGeometry, VerticalUnit, Volume};

/// What is asked for, and what a command may hold beyond it.
const MEMORY_MIB: f64 = 64.0;
const TOLERANCE: f64 = 1.15;

/// What the program takes on its own, with the facts of 65 536 traces; and a buffer for each thread.
const BASE_MIB: f64 = 24.0;
const THREAD_MIB: f64 = 1.25;

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

#[test]
fn import_and_attributes_keep_to_the_memory_they_are_given() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let size = [256; 3];
    let samples = (0..size.iter().product::<usize>()).map(|n| (n * 7919 % 60_013) as f32 - 30_000.0).collect();
    let volume = Volume::from_samples(size, samples).unwrap();
    let geometry = SurveyGeometry::regular(size, 12.5, 4.0, VerticalUnit::Milliseconds);
    segy::write(&at.join("a.sgy"), &geometry, &volume, &WriteOptions::default(), &Progress::silent()).unwrap();
    drop(volume);
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let limit = MEMORY_MIB * TOLERANCE + BASE_MIB + THREAD_MIB * threads as f64;
    for line in ["import a.sgy p.petro --memory 64M", "attribute p.petro --kind envelope --name envelope --memory 64M"]
    {
        let peak = peak_mib(at, line);
        assert!(peak > MEMORY_MIB / 2.0 && peak < limit, "{line}: {peak:.1} MiB, at most {limit:.1}");
    }
}
