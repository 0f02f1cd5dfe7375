//! Lines that are printed to be given to a shell: each of them runs as it stands, whatever the path and the names are.

use crate::program::{Run, STATE_HOME, copy, project, run_in};
use std::fs;
use std::path::Path;
use std::process::Command;

/// The project, in a folder with a blank.
const PROJECT: &str = "my surveys/p.petro";
/// Names that would be commands if they stood in a line as they are. They are no less allowed than others.
const LAYER: &str = "Marl$(touch x)";
const HORIZON: &str = "Top; touch x & \"b\"";

fn folder() -> tempfile::TempDir {
    let folder = project();
    let at = folder.path();
    fs::create_dir(at.join("my surveys")).unwrap();
    fs::rename(at.join("p.petro"), at.join(PROJECT)).unwrap();
    run_in(at, &format!("layer set '{PROJECT}' 'Alpha - Bravo' --name '{LAYER}' --pattern sand --colour #ea713a"))
        .done();
    let second = format!("layer set '{PROJECT}' 'Bravo - Unconformity' --pattern sand --colour #40b62f");
    run_in(at, &second).done();
    run_in(at, &format!("horizon rename '{PROJECT}' Delta '{HORIZON}'")).done();
    folder
}

/// The lines on the project in an answer: what stands between backticks. Others name a command, or say how it is called.
fn lines(told: &Run) -> Vec<String> {
    let all = format!("{}{}", told.stdout, told.stderr);
    let quoted = all.split('`').skip(1).step_by(2).filter(|line| line.starts_with("petroglyph "));
    quoted.filter(|line| line.contains("my surveys")).map(str::to_owned).collect()
}

/// Has a shell run a line in a copy of the folder.
fn given(at: &Path, line: &str) -> Run {
    let folder = tempfile::tempdir().unwrap();
    copy(at, folder.path());
    let program = Path::new(env!("CARGO_BIN_EXE_petroglyph")).parent().unwrap();
    let path = format!("{}:{}", program.display(), std::env::var("PATH").unwrap());
    let mut shell = Command::new("sh");
    shell.args(["-c", line]).current_dir(folder.path()).env("PATH", path).env("XDG_STATE_HOME", STATE_HOME);
    let run = Run::of(&shell.output().unwrap());
    assert!(!folder.path().join("x").exists(), "{line}");
    run
}

#[cfg(unix)]
#[test]
fn every_line_on_a_project_runs_as_it_is_printed_and_does_nothing_else() {
    let folder = folder();
    let at = folder.path();
    let of = |line: &str| lines(&run_in(at, line));
    let render = format!("render '{PROJECT}' a.png --size 160x120 --samples 1 --device cpu --ground off");
    let mut found = of(&render);
    assert!(found.iter().any(|line| line.contains(&format!("layer set '{PROJECT}' '{LAYER}'"))), "{found:?}");
    for refused in ["time P", "redo P", "fault accept P 1 --name F", "horizon show P Gamma", "horizon unpick P 7"] {
        let printed = of(&refused.replace(" P", &format!(" '{PROJECT}'")));
        assert_eq!(printed.len(), 1, "{refused}: {printed:?}");
        found.extend(printed);
    }
    // All that a check says what to do about.
    let root = at.join(PROJECT);
    fs::remove_dir_all(root.join("volumes/impedance.zarr")).unwrap();
    fs::remove_dir_all(root.join("horizons/Delta.zarr")).unwrap();
    for file in ["candidates-0123456789abcdef.zarr/zarr.json", "fault-proposals-0123456789abcdef.json"] {
        let file = root.join("derived").join(file);
        fs::create_dir_all(file.parent().unwrap()).unwrap();
        fs::write(file, "{}").unwrap();
    }
    fs::write(root.join("history/0004.toml"), "= damaged").unwrap();
    let checked = of(&format!("check '{PROJECT}'"));
    for command in ["extract", "fault propose", "undo", "volume remove", "horizon remove", "check"] {
        let is_of = |line: &String| line.starts_with(&format!("petroglyph {command} "));
        assert!(checked.iter().any(is_of), "no {command} among {checked:?}");
    }
    found.extend(checked);
    for line in found.iter().filter(|line| !line.ends_with(" NAME")) {
        let run = given(at, line);
        // A check says of what cannot be repaired that something is wrong.
        let is_check = line.starts_with("petroglyph check ") && run.stdout.contains("damaged");
        assert!(run.code == 0 || is_check, "{line}: {}{}", run.stdout, run.stderr);
    }
}
