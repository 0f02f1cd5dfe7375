//! Lines that are printed to be given to a shell: each of them runs as it stands, whatever the path and the names are.

use crate::program::{Run, STATE_HOME, copy, project, run_in};
use std::fs;
use std::path::Path;
use std::process::Command;

/// The project, in a folder with a blank.
const PROJECT: &str = "my surveys/p.petro";
/// Names that would be commands if they stood in a line as they are. They are no less allowed than others.
const LAYERS: [&str; 2] = ["Marl$(touch x)", "Clay; touch x"];
const HORIZON: &str = "Top & touch x \"b\"";

/// A folder with the project, in which two layers look alike.
fn folder() -> tempfile::TempDir {
    let folder = project();
    let at = folder.path();
    fs::create_dir(at.join("my surveys")).unwrap();
    fs::rename(at.join("p.petro"), at.join(PROJECT)).unwrap();
    let looks = [("Alpha - Bravo", "#ea713a"), ("Bravo - Unconformity", "#40b62f")];
    for ((layer, colour), name) in looks.into_iter().zip(LAYERS) {
        let look = format!("--name '{name}' --pattern sand --colour {colour}");
        run_in(at, &format!("layer set '{PROJECT}' '{layer}' {look}")).done();
    }
    run_in(at, &format!("horizon rename '{PROJECT}' Delta '{HORIZON}'")).done();
    folder
}

/// The lines on the project that a command prints between backticks. Other lines name a command, or say how it is called.
fn lines(at: &Path, command: &str) -> Vec<String> {
    let told = run_in(at, command);
    let all = format!("{}{}", told.stdout, told.stderr);
    let quoted = all.split('`').skip(1).step_by(2).filter(|line| line.starts_with("petroglyph "));
    quoted.filter(|line| line.contains("my surveys")).map(str::to_owned).collect()
}

/// Has a shell run each line in a copy of the folder.
fn run_all(at: &Path, lines: &[String]) {
    let program = Path::new(env!("CARGO_BIN_EXE_petroglyph")).parent().unwrap();
    let path = format!("{}:{}", program.display(), std::env::var("PATH").unwrap());
    for line in lines.iter().filter(|line| !line.ends_with(" NAME")) {
        let folder = tempfile::tempdir().unwrap();
        copy(at, folder.path());
        // A project from elsewhere that is not whole is changed only after a check of it.
        run_in(folder.path(), &format!("check '{PROJECT}'"));
        let mut shell = Command::new("sh");
        shell.args(["-c", line]).current_dir(folder.path()).env("PATH", &path).env("XDG_STATE_HOME", STATE_HOME);
        let run = Run::of(&shell.output().unwrap());
        assert!(!folder.path().join("x").exists(), "{line}");
        // A check of what cannot be repaired says that something is wrong.
        let is_check = line.starts_with("petroglyph check ") && run.stdout.contains("damaged");
        assert!(run.code == 0 || is_check, "{line}: {}{}", run.stdout, run.stderr);
    }
}

#[track_caller]
fn assert_all_are_there(lines: &[String], commands: &[&str]) {
    for command in commands {
        let is_of = |line: &String| line.starts_with(&format!("petroglyph {command} "));
        assert!(lines.iter().any(is_of), "no {command} among {lines:?}");
    }
}

#[test]
fn every_line_on_a_project_runs_as_it_is_printed_and_does_nothing_else() {
    let folder = folder();
    let (at, root) = (folder.path(), folder.path().join(PROJECT));
    let mut found =
        lines(at, &format!("render '{PROJECT}' a.png --size 160x120 --samples 1 --device cpu --ground off"));
    assert!(found.iter().any(|line| line.starts_with(&format!("petroglyph layer set '{PROJECT}' '"))), "{found:?}");
    for refused in ["time P", "redo P", "fault accept P 1 --name F", "horizon show P Gamma", "horizon unpick P 7"] {
        let printed = lines(at, &refused.replace(" P", &format!(" '{PROJECT}'")));
        assert_eq!(printed.len(), 1, "{refused}: {printed:?}");
        found.extend(printed);
    }
    // What is computed is damaged, then data and a step of the history.
    let check = format!("check '{PROJECT}'");
    for file in ["candidates-0123456789abcdef.zarr/zarr.json", "fault-proposals-0123456789abcdef.json"] {
        let file = root.join("derived").join(file);
        fs::create_dir_all(file.parent().unwrap()).unwrap();
        fs::write(file, "{}").unwrap();
    }
    found.extend(lines(at, &check));
    assert_all_are_there(&found, &["info", "extract", "fault propose", "check"]);
    run_all(at, &found);
    fs::remove_dir_all(root.join("volumes/impedance.zarr")).unwrap();
    fs::remove_dir_all(root.join("horizons/Delta.zarr")).unwrap();
    fs::write(root.join("history/0004.toml"), "= damaged").unwrap();
    let found = lines(at, &check);
    assert_all_are_there(&found, &["undo", "volume remove", "horizon remove", "check"]);
    let data: Vec<String> =
        found.into_iter().filter(|line| !line.contains(" extract ") && !line.contains(" propose ")).collect();
    run_all(at, &data);
}
