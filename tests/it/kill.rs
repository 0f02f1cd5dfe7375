//! Killed as by a power cut, at any moment: what was saved is there, and what was half-way is not.

use crate::program::{bytes, command, copy, run_in};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::sync::OnceLock;
use std::time::Duration;
use tempfile::TempDir;

/// A survey in `p.petro` that takes a while to extract, without candidates; made once.
fn imported() -> &'static Path {
    static FOLDER: OnceLock<TempDir> = OnceLock::new();
    FOLDER
        .get_or_init(|| {
            let folder = tempfile::tempdir().expect("a temporary folder");
            run_in(folder.path(), "synth s --size 96x96x96 --seed 5 --snr 12").done();
            run_in(folder.path(), "import s/survey.sgy p.petro").done();
            folder
        })
        .path()
}

fn project() -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    copy(imported(), folder.path());
    folder
}

/// Runs the program and kills it after so many milliseconds; answers whether it had ended by itself.
fn killed(at: &Path, line: &str, after_ms: u64) -> bool {
    let mut child =
        command().current_dir(at).args(line.split(' ')).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    std::thread::sleep(Duration::from_millis(after_ms));
    let ended = child.try_wait().unwrap().is_some();
    let _ = child.kill();
    child.wait().unwrap();
    ended
}

/// All that is saved of a project: everything but what can be computed again and locks.
fn saved(at: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let all = bytes(&at.join("p.petro"));
    let derived = at.join("p.petro/derived");
    all.into_iter().filter(|(path, _)| !path.starts_with(&derived)).collect()
}

fn info(at: &Path) -> Value {
    run_in(at, "info p.petro --json").done().json()
}

/// The step of the history that a project is at.
fn step(at: &Path) -> u64 {
    let text = std::fs::read_to_string(at.join("p.petro/project.toml")).unwrap();
    text.lines().find_map(|line| line.strip_prefix("step = ")).unwrap().parse().unwrap()
}

#[test]
fn a_killed_extraction_costs_nothing_but_itself() {
    let undisturbed = project();
    let expected = run_in(undisturbed.path(), "extract p.petro --json").done().json();
    assert!(expected["surfaces"].as_u64().unwrap() > 0);
    let folder = project();
    let at = folder.path();
    let (before, last) = (saved(at), step(at));
    let mut was_killed = 0;
    for after_ms in [5, 20, 60, 150, 300, 600] {
        let was_done = killed(at, "extract p.petro", after_ms);
        info(at);
        if was_done {
            break;
        }
        if step(at) != last {
            // Its last act is to save: killed between that and its end, it has done all.
            assert_eq!(step(at), last + 1);
            run_in(at, "check p.petro").done();
            break;
        }
        was_killed += 1;
        assert!(saved(at) == before, "the killed extraction changed the project after {after_ms} ms");
    }
    assert!(was_killed > 1, "it was always done before it could be killed");
    // The next one is whole, and so are former candidates while another is killed.
    let whole = run_in(at, "extract p.petro --json").done().json();
    assert_eq!((&whole["surfaces"], &whole["leaves"]), (&expected["surfaces"], &expected["leaves"]));
    let extracted = saved(at);
    for after_ms in [5, 60] {
        if killed(at, "extract p.petro --min-leaf-triangles 200", after_ms) {
            break;
        }
        assert!(saved(at) == extracted);
    }
    let again = run_in(at, "extract p.petro --json").done().json();
    assert_eq!(again["leaves"], whole["leaves"]);
    // What the killed ones had begun to write goes when the next one computes.
    run_in(at, "extract p.petro --min-leaf-triangles 300").done();
    assert!(!at.join("p.petro/derived/unfinished").exists());
    let known = ["candidates.zarr", "candidates-"];
    for entry in std::fs::read_dir(at.join("p.petro/derived")).unwrap().flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        let is_known = known.iter().any(|known| name.starts_with(known)) || name.ends_with(".bin");
        assert!(is_known, "{name} was left behind");
    }
}

#[test]
fn a_killed_save_leaves_the_state_before_or_after_it() {
    let folder = project();
    let at = folder.path();
    let velocity = |at: &Path| -> f64 {
        let text = std::fs::read_to_string(at.join("p.petro/project.toml")).unwrap();
        text.lines().find_map(|line| line.strip_prefix("velocity_m_s = ")).unwrap().parse().unwrap()
    };
    run_in(at, "velocity p.petro 2000").done();
    let mut expected = 2000.0;
    for n in 0..30u64 {
        let before = step(at);
        let wanted = 2100.0 + n as f64;
        killed(at, &format!("velocity p.petro {wanted}"), n);
        info(at);
        let now = step(at);
        assert!(now == before || now == before + 1, "step {before} became {now}");
        if now == before + 1 {
            expected = wanted;
        }
        assert_eq!(velocity(at), expected, "after {n} ms");
    }
    // The history is whole as well: back and forth.
    let last = step(at);
    run_in(at, "velocity p.petro 3000").done();
    run_in(at, "undo p.petro").done();
    assert_eq!((step(at), velocity(at)), (last, expected));
    run_in(at, "redo p.petro").done();
    assert_eq!(velocity(at), 3000.0);
}

#[test]
fn a_killed_pick_adds_a_whole_horizon_or_none() {
    let folder = project();
    let at = folder.path();
    run_in(at, "extract p.petro").done();
    // The first candidate there is.
    run_in(at, "export p.petro c.csv --candidates").done();
    let text = std::fs::read_to_string(at.join("c.csv")).unwrap();
    let place = text.lines().nth(1).unwrap().split(',').take(3).collect::<Vec<_>>().join(",");
    let (mut added, mut n) = (0, 0);
    for after_ms in [10, 40, 80, 120, 160, 220, 300, 450, 700, 1200] {
        n += 1;
        killed(at, &format!("pick p.petro --at {place} --horizon H{n} --highest-valid"), after_ms);
        let listed = run_in(at, "horizon list p.petro --json").done().json();
        let count = listed["horizons"].as_array().unwrap().len();
        assert!(count == added || count == added + 1, "{listed}");
        added = count;
        if count > 0 {
            let name = listed["horizons"][count - 1]["name"].as_str().unwrap();
            let shown = run_in(at, &format!("horizon show p.petro {name} --json")).done().json();
            assert!(shown.to_string().contains("picks"), "{shown}");
        }
    }
    run_in(at, &format!("pick p.petro --at {place} --horizon Last --highest-valid")).done();
}
