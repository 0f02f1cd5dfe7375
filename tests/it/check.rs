//! `petroglyph check`: what is damaged is found and named, nothing is written without `--repair`, and a repair costs
//! nothing that a state needs.

use crate::program::{Run, begin_in, bytes, project, run_in};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

/// Checks `p.petro` and makes sure that the check has written nothing, not even a lock.
#[track_caller]
fn check(at: &Path) -> Run {
    let root = at.join("p.petro");
    let listing = || (bytes(&root), root.join("lock").exists(), entries(&root));
    let before = listing();
    let run = run_in(at, "check p.petro --json");
    assert!(listing() == before, "the check has changed the project");
    assert!(!run.stderr.contains("panicked"), "{}", run.stderr);
    run
}

/// Every folder below a folder: an empty one is no file.
fn entries(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).filter(|entry| entry.is_dir()) {
        found.extend(entries(&entry));
        found.push(entry);
    }
    found.sort();
    found
}

/// The one damage that a check finds.
#[track_caller]
fn only_damage(at: &Path) -> Value {
    let run = check(at);
    assert_eq!(run.code, 1, "{}{}", run.stdout, run.stderr);
    let damage = run.json()["damage"].as_array().unwrap().clone();
    assert_eq!(damage.len(), 1, "{}", run.stdout);
    damage[0].clone()
}

#[track_caller]
fn is_well(at: &Path) -> Value {
    let run = check(at);
    assert_eq!(run.code, 0, "{}{}", run.stdout, run.stderr);
    assert_eq!(run.json()["ok"], true);
    run.json()
}

fn flip(path: &Path, at: usize) {
    let mut content = fs::read(path).unwrap();
    content[at] ^= 0x10;
    fs::write(path, content).unwrap();
}

fn texts(value: &Value) -> Vec<&str> {
    value.as_array().unwrap().iter().map(|text| text.as_str().unwrap()).collect()
}

fn do_of(damage: &Value) -> Vec<&str> {
    damage["cures"].as_array().unwrap().iter().map(|cure| cure["do"].as_str().unwrap()).collect()
}

#[test]
fn a_healthy_project_is_well_and_nothing_is_left_over() {
    let folder = project();
    let at = folder.path();
    run_in(at, "render p.petro a.png --size 80x60 --samples 1 --device cpu").done();
    run_in(at, "parameterize p.petro --size 20x20x20").done();
    let found = is_well(at);
    assert_eq!(found["data_files"], 10);
    assert!(found["derived_files"].as_u64().unwrap() >= 2, "{found}");
    assert_eq!(found["leftovers"], Value::Array(Vec::new()));
    assert_eq!(found["steps"].as_array().unwrap().len(), 11);
    let told = run_in(at, "check p.petro").done().stdout;
    assert!(told.contains("nothing is damaged") && told.contains("10 data files"), "{told}");
    // A repair of what is well changes nothing.
    let before = bytes(&at.join("p.petro"));
    run_in(at, "check p.petro --repair").done();
    assert!(bytes(&at.join("p.petro")) == before);
}

#[test]
fn a_flipped_byte_in_a_volume_is_named_with_all_that_shows_it() {
    let folder = project();
    let at = folder.path();
    run_in(at, "scene add p.petro 'as recorded' --blend 1").done();
    flip(&at.join("p.petro/volumes/seismic.zarr/0/c/0/0/0"), 3000);
    let damage = only_damage(at);
    assert_eq!(damage["file"], "volumes/seismic.zarr");
    assert!(damage["reason"].as_str().unwrap().contains("the checksum of the brick [0, 0, 0]"), "{damage}");
    assert_eq!(texts(&damage["dependants"]), ["every picture of raw data", "scene \"as recorded\""]);
    assert_eq!(damage["steps"][0], 1);
    assert_eq!(do_of(&damage), ["undo", "import"]);
    assert_eq!(damage["cures"][0]["step"], 0);
    assert_eq!(damage["cures"][1]["path"], "s/survey.sgy");
    // No repair deletes what a state needs.
    let before = bytes(&at.join("p.petro"));
    let told = run_in(at, "check p.petro --repair");
    assert_eq!(told.code, 1, "{}", told.stdout);
    assert!(told.stdout.contains("import s/survey.sgy again"), "{}", told.stdout);
    assert!(bytes(&at.join("p.petro")) == before);
}

#[test]
fn a_damaged_or_missing_horizon_is_named_with_its_layers_and_undo_leads_back() {
    let folder = project();
    let at = folder.path();
    let horizon = at.join("p.petro/horizons/Delta.zarr");
    let depth = horizon.join("0/depth/c/0/0");
    let good = fs::read(&depth).unwrap();
    flip(&depth, good.len() / 2);
    let damage = only_damage(at);
    assert_eq!((&damage["file"], &damage["what"]), (&"horizons/Delta.zarr".into(), &"horizon \"Delta\"".into()));
    assert_eq!(texts(&damage["dependants"]).len(), 2, "{damage}");
    fs::write(&depth, good).unwrap();
    is_well(at);
    fs::remove_dir_all(&horizon).unwrap();
    let damage = only_damage(at);
    assert_eq!(damage["reason"], "it is missing");
    assert_eq!(damage["cures"][1]["path"], "s/horizons/Delta.csv");
    // Both ways back are what they are said to be.
    let (step, times) = (damage["cures"][0]["step"].as_u64().unwrap(), damage["cures"][0]["times"].as_u64().unwrap());
    assert_eq!(step, 6);
    run_in(at, "horizon remove p.petro Delta").done();
    run_in(at, "horizon add p.petro s/horizons/Delta.csv --name Delta").done();
    let now = check(at).json();
    assert!(now["damage"].as_array().unwrap().iter().all(|damage| damage["is_present"] == false), "{now}");
    for _ in 0..times + 2 {
        run_in(at, "undo p.petro").done();
    }
    assert_eq!(check(at).json()["step"], step);
    run_in(at, "prune p.petro").done();
    is_well(at);
}

#[test]
fn a_horizon_whose_depths_were_replaced_is_found_by_its_hash() {
    let folder = project();
    let at = folder.path();
    let root = at.join("p.petro/horizons");
    fs::remove_dir_all(root.join("Alpha.zarr")).unwrap();
    fs::create_dir(root.join("Alpha.zarr")).unwrap();
    crate::program::copy(&root.join("Bravo.zarr"), &root.join("Alpha.zarr"));
    let damage = only_damage(at);
    assert!(damage["reason"].as_str().unwrap().contains("was recorded"), "{damage}");
}

#[test]
fn a_damaged_fault_and_a_tile_that_cannot_be_drawn_are_found() {
    let folder = project();
    let at = folder.path();
    image::RgbImage::from_pixel(2, 2, image::Rgb([1, 0, 0])).save(at.join("tile.png")).unwrap();
    run_in(at, "texture p.petro tile.png").done();
    run_in(at, "layer set p.petro 'above Alpha' --pattern tile").done();
    is_well(at);
    let fault = at.join("p.petro/faults/Normal_fault.json");
    let text = fs::read_to_string(&fault).unwrap();
    fs::write(&fault, text.replacen("[1, ", "[2, ", 1).replacen("[0, ", "[3, ", 1)).unwrap();
    assert_eq!(only_damage(at)["what"], "fault \"Normal fault\"");
    fs::write(&fault, text).unwrap();
    fs::write(at.join("p.petro/textures/tile.png"), "no picture").unwrap();
    let damage = only_damage(at);
    assert_eq!(damage["what"], "texture \"tile\"");
    assert_eq!(texts(&damage["dependants"]), ["layer \"above Alpha\""]);
}

#[test]
fn a_damaged_step_is_set_aside_and_undo_still_works() {
    for (number, undone) in [(4, 6), (10, 10)] {
        let folder = project();
        let at = folder.path();
        let file = format!("history/{number:04}.toml");
        let step = at.join("p.petro").join(&file);
        let content = fs::read(&step).unwrap();
        let mut bad = content.clone();
        bad[0] = 0xff;
        fs::write(&step, &bad).unwrap();
        let damage = only_damage(at);
        assert_eq!((&damage["file"], &damage["part"]), (&file.clone().into(), &"step".into()));
        let before = bytes(&at.join("p.petro"));
        let told = run_in(at, "check p.petro --repair").done();
        assert!(told.stdout.contains(&format!("moved {file} to damaged/{number:04}.toml")), "{}", told.stdout);
        let after = bytes(&at.join("p.petro"));
        assert_eq!(after[&at.join(format!("p.petro/damaged/{number:04}.toml"))], bad);
        assert!(before.keys().filter(|path| **path != step).all(|path| after.get(path) == before.get(path)));
        is_well(at);
        for _ in 0..undone - usize::from(number == 4) {
            run_in(at, "undo p.petro").done();
        }
        run_in(at, "undo p.petro").failed(&["nothing to undo"]);
        run_in(at, "redo p.petro").done();
        run_in(at, "velocity p.petro 2500").done();
        run_in(at, "undo p.petro").done();
        is_well(at);
    }
}

#[test]
fn a_missing_history_is_made_again_and_the_next_command_can_be_undone() {
    let folder = project();
    let at = folder.path();
    fs::remove_dir_all(at.join("p.petro/history")).unwrap();
    assert_eq!(only_damage(at)["file"], "history");
    run_in(at, "check p.petro --repair").done();
    is_well(at);
    run_in(at, "velocity p.petro 2500").done();
    run_in(at, "undo p.petro").done();
    is_well(at);
}

#[test]
fn a_command_that_was_killed_after_its_state_was_saved_gets_its_step() {
    let folder = project();
    let at = folder.path();
    let root = at.join("p.petro");
    run_in(at, "velocity p.petro 2500").done();
    let good = bytes(&root);
    fs::create_dir_all(root.join("unfinished/history")).unwrap();
    fs::rename(root.join("history/0011.toml"), root.join("unfinished/history/0011.toml")).unwrap();
    let found = is_well(at);
    assert_eq!(found["leftovers"][0]["file"], "unfinished");
    assert!(texts(&found["notes"])[0].contains("step 11, is not in the history"), "{found}");
    run_in(at, "check p.petro --repair").done();
    assert!(bytes(&root) == good);
    run_in(at, "undo p.petro").done();
    is_well(at);
}

#[test]
fn orphans_and_leftovers_are_no_damage_and_go_with_a_repair() {
    let folder = project();
    let at = folder.path();
    let root = at.join("p.petro");
    let good = bytes(&root);
    let left = [
        "unfinished/volumes/x.zarr/0",
        "importing/a.zarr/c",
        "derived/unfinished/7-0/a",
        "derived/candidates-0123456789abcdef.zarr/zarr.json",
        "derived/fault-proposals-0123456789abcdef.json",
        "volumes/far.partial-stack.zarr/zarr.json",
        "horizons/.Alpha.zarr.partial-1-0/x",
        "wells/W1.json",
    ];
    for file in left {
        fs::create_dir_all(root.join(file).parent().unwrap()).unwrap();
        fs::write(root.join(file), "{}").unwrap();
    }
    fs::write(root.join("notes.txt"), "mine").unwrap();
    // What is derived is verified whether it is needed or not.
    let run = check(at);
    let found = run.json();
    let named: Vec<&str> =
        found["leftovers"].as_array().unwrap().iter().map(|left| left["file"].as_str().unwrap()).collect();
    for file in left {
        assert!(named.iter().any(|name| file.starts_with(name)), "{file} is not among {named:?}");
    }
    assert_eq!(named.len(), left.len(), "{named:?}");
    for damage in found["damage"].as_array().unwrap() {
        assert_eq!(damage["part"], "derived", "{damage}");
    }
    run_in(at, "check p.petro --repair").done();
    let mut expected = good;
    expected.insert(root.join("notes.txt"), b"mine".to_vec());
    let after = bytes(&root);
    assert!(after == expected, "{:?}", after.keys().filter(|path| !expected.contains_key(*path)).collect::<Vec<_>>());
    assert_eq!(is_well(at)["leftovers"], Value::Array(Vec::new()));
}

#[test]
fn data_that_a_damaged_step_may_need_are_kept() {
    let folder = project();
    let at = folder.path();
    let root = at.join("p.petro");
    run_in(at, "import s/survey.sgy p.petro --name second").done();
    run_in(at, "undo p.petro").done();
    let step = root.join("history/0011.toml");
    let text = fs::read_to_string(&step).unwrap();
    assert!(text.contains("volumes/second.zarr"));
    fs::write(&step, format!("= damaged\n{text}")).unwrap();
    for _ in 0..2 {
        let told = run_in(at, "check p.petro --repair").done();
        assert!(told.stdout.contains("volumes/second.zarr"), "{}", told.stdout);
        assert!(root.join("volumes/second.zarr/zarr.json").exists());
    }
    fs::remove_dir_all(root.join("damaged")).unwrap();
    run_in(at, "check p.petro --repair").done();
    assert!(!root.join("volumes/second.zarr").exists());
    is_well(at);
}

#[test]
fn damaged_derived_data_are_removed_and_computed_again() {
    let folder = project();
    let at = folder.path();
    let root = at.join("p.petro");
    run_in(at, "parameterize p.petro --size 20x20x20").done();
    let names = || -> Vec<String> {
        let entries = fs::read_dir(root.join("derived")).unwrap();
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
    };
    let grids = names().into_iter().find(|name| name.starts_with("grids-")).unwrap();
    let length = fs::metadata(root.join("derived").join(&grids)).unwrap().len() as usize;
    flip(&root.join("derived").join(&grids), length / 2);
    assert_eq!(only_damage(at)["file"], format!("derived/{grids}"));
    run_in(at, "check p.petro --repair").done();
    assert!(!names().contains(&grids));
    is_well(at);
    run_in(at, "parameterize p.petro --size 20x20x20").done();
    assert!(names().contains(&grids));
    flip(&root.join("derived/parameterization.zarr/k/c/0/0/0"), 300);
    assert_eq!(only_damage(at)["file"], "derived/parameterization.zarr");
    run_in(at, "check p.petro --repair").done();
    is_well(at);
}

#[test]
fn a_damaged_state_is_restored_from_the_history_and_kept_beside() {
    let folder = project();
    let at = folder.path();
    let state = at.join("p.petro/project.toml");
    let good = fs::read(&state).unwrap();
    for bad in [Some(&b"\xff\xfe nonsense"[..]), Some(&good[..good.len() / 3]), Some(b""), None] {
        match bad {
            Some(bad) => fs::write(&state, bad).unwrap(),
            None => fs::remove_file(&state).unwrap(),
        }
        run_in(at, "info p.petro").failed(&[]);
        let damage = only_damage(at);
        assert_eq!(damage["part"], "state");
        assert_eq!(damage["cures"][0], serde_json::json!({ "do": "restore", "step": 10 }));
        let told = run_in(at, "check p.petro --repair").done();
        assert!(told.stdout.contains("restored project.toml from step 10"), "{}", told.stdout);
        assert_eq!(fs::read(&state).unwrap(), good);
        is_well(at);
    }
    assert_eq!(fs::read(at.join("p.petro/project.toml.damaged")).unwrap(), b"\xff\xfe nonsense");
    assert_eq!(fs::read(at.join("p.petro/project.toml.damaged-2")).unwrap(), &good[..good.len() / 3]);
    run_in(at, "undo p.petro").done();
    run_in(at, "redo p.petro").done();
    is_well(at);
}

#[test]
fn a_damaged_state_that_still_says_its_step_goes_back_there() {
    let folder = project();
    let at = folder.path();
    run_in(at, "undo p.petro").done();
    let state = at.join("p.petro/project.toml");
    let good = fs::read_to_string(&state).unwrap();
    fs::write(&state, format!("{good}\n= damaged")).unwrap();
    run_in(at, "check p.petro --repair").done();
    assert_eq!(fs::read_to_string(&state).unwrap(), good);
    run_in(at, "redo p.petro").done();
}

#[test]
fn a_repair_waits_its_turn_and_a_check_does_not() {
    let folder = project();
    let at = folder.path();
    let lock = fs::File::options().create(true).truncate(false).write(true).open(at.join("p.petro/lock")).unwrap();
    lock.lock().unwrap();
    is_well(at);
    run_in(at, "check p.petro --repair --wait 0").failed(&["another Petroglyph process"]);
    lock.unlock().unwrap();
    run_in(at, "check p.petro --repair --wait 0").done();
}

#[test]
fn what_is_no_project_or_newer_is_an_error() {
    let folder = project();
    let at = folder.path();
    run_in(at, "check s").failed(&["neither a project.toml nor a history"]);
    run_in(at, "check nothing").failed(&["there is no project"]);
    run_in(at, "check s --repair").failed(&["neither a project.toml nor a history"]);
    assert!(!at.join("s/lock").exists());
    let state = at.join("p.petro/project.toml");
    let text = fs::read_to_string(&state).unwrap();
    fs::write(&state, text.replacen("version = 2", "version = 99", 1)).unwrap();
    let before = bytes(&at.join("p.petro"));
    run_in(at, "check p.petro --repair").failed(&["99"]);
    assert!(bytes(&at.join("p.petro")) == before);
}

#[test]
fn a_step_of_a_newer_version_is_no_damage_and_stays_where_it_is() {
    let folder = project();
    let at = folder.path();
    let root = at.join("p.petro");
    let newer = root.join("history/0004.toml");
    let text = fs::read_to_string(&newer).unwrap();
    fs::write(&newer, text.replacen("version = 2", "version = 99", 1)).unwrap();
    let found = is_well(at);
    let notes = texts(&found["notes"]);
    assert!(notes.iter().any(|note| note.contains("newer Petroglyph") && note.contains("99")), "{notes:?}");
    // What else is damaged is found, and a repair keeps the step with all that it may name.
    flip(&root.join("volumes/seismic.zarr/0/c/0/0/0"), 3000);
    assert_eq!(only_damage(at)["file"], "volumes/seismic.zarr");
    let before = bytes(&root);
    run_in(at, "check p.petro --repair");
    assert!(bytes(&root) == before);
}

/// Waits until a program has said that it handles an interruption.
#[cfg(target_os = "linux")]
fn handles_interruptions(process: u32) -> bool {
    const INTERRUPTION: u64 = 1 << 1;
    loop {
        let Ok(status) = fs::read_to_string(format!("/proc/{process}/status")) else { return false };
        let caught = status.lines().find_map(|line| u64::from_str_radix(line.strip_prefix("SigCgt:")?.trim(), 16).ok());
        match caught {
            Some(caught) if caught & INTERRUPTION != 0 => return true,
            // It has ended.
            _ if status.contains("State:\tZ") => return false,
            _ => std::thread::yield_now(),
        }
    }
}

#[test]
#[cfg(target_os = "linux")]
fn an_interruption_stops_a_check_and_changes_nothing() {
    use std::process::Command;
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    run_in(at, "synth s --size 128x128x160 --seed 3").done();
    run_in(at, "import s/survey.sgy p.petro").done();
    for line in ["check p.petro", "check p.petro --repair"] {
        let before = bytes(&at.join("p.petro"));
        // It may have ended before the signal reaches it; that it always has cannot be.
        let was_stopped = (0..40).any(|_| {
            let child = begin_in(at, line);
            if handles_interruptions(child.id()) {
                assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
            }
            let run = Run::of(&child.wait_with_output().unwrap());
            assert!(bytes(&at.join("p.petro")) == before, "{line}");
            match run.code {
                0 => false,
                code => {
                    assert!(code == 1 && run.stderr.contains("cancelled"), "{line}: {}{}", run.stdout, run.stderr);
                    true
                }
            }
        });
        assert!(was_stopped, "{line} was never stopped");
    }
}

#[test]
#[cfg(unix)]
fn links_are_damage_that_nobody_follows() {
    use std::os::unix::fs::symlink;
    let folder = project();
    let at = folder.path();
    let root = at.join("p.petro");
    fs::rename(root.join("horizons/Alpha.zarr"), at.join("outside.zarr")).unwrap();
    symlink(at.join("outside.zarr"), root.join("horizons/Alpha.zarr")).unwrap();
    let damage = only_damage(at);
    assert_eq!(damage["reason"], "horizons/Alpha.zarr is a link");
    run_in(at, "check p.petro --repair").failed(&["is a link"]);
    fs::remove_file(root.join("horizons/Alpha.zarr")).unwrap();
    fs::rename(at.join("outside.zarr"), root.join("horizons/Alpha.zarr")).unwrap();
    fs::create_dir(at.join("elsewhere")).unwrap();
    symlink(at.join("elsewhere"), root.join("importing")).unwrap();
    assert_eq!(only_damage(at)["file"], "importing");
}
