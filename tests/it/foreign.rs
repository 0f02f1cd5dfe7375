//! Projects from elsewhere: looked through before they are changed, read without following links, listed without
//! believing line ends.

use crate::program::{Run, bytes, command, project, run_in, words};
use std::fs;
use std::path::Path;

/// Runs the program as a user who remembers projects in the folder `state`.
fn as_user(state: &Path, at: &Path, line: &str) -> Run {
    let output = command().current_dir(at).args(words(line)).env("XDG_STATE_HOME", state).output();
    Run::of(&output.expect("the program runs"))
}

#[test]
fn a_project_from_elsewhere_that_is_not_whole_is_not_changed_before_it_was_checked() {
    let (folder, state) = (project(), tempfile::tempdir().unwrap());
    let (at, user) = (folder.path(), state.path());
    let root = at.join("p.petro");
    fs::rename(root.join("horizons/Delta.zarr"), at.join("Delta.zarr")).unwrap();
    fs::remove_file(root.join("faults/Normal_fault.json")).unwrap();
    let before = bytes(&root);
    for line in ["velocity p.petro 2500", "undo p.petro", "prune p.petro", "horizon remove p.petro Alpha"] {
        let told = ["comes from elsewhere", "2 of its files or folders", "it is missing", "petroglyph check"];
        as_user(user, at, line).failed(&told);
    }
    assert!(bytes(&root) == before);
    // It can be looked at, and whoever was told what is wrong may go on.
    as_user(user, at, "info p.petro").done();
    let told = as_user(user, at, "check p.petro");
    assert!(told.code == 1 && told.stdout.contains("2 files or folders are damaged"), "{}", told.stdout);
    assert!(bytes(&root) == before);
    as_user(user, at, "velocity p.petro 2500").done();
    // Another user was not told.
    let other = tempfile::tempdir().unwrap();
    as_user(other.path(), at, "velocity p.petro 2600").failed(&["comes from elsewhere"]);
    // Another project in the same place is another project.
    fs::create_dir(at.join("new")).unwrap();
    crate::program::copy(&root, &at.join("new"));
    fs::remove_dir_all(&root).unwrap();
    fs::rename(at.join("new"), &root).unwrap();
    as_user(user, at, "velocity p.petro 2700").failed(&["comes from elsewhere"]);
}

#[test]
fn a_whole_project_from_elsewhere_and_one_of_ones_own_are_changed_without_a_word() {
    let (folder, state) = (project(), tempfile::tempdir().unwrap());
    let (at, user) = (folder.path(), state.path());
    as_user(user, at, "velocity p.petro 2500").done();
    // Known now: what goes missing later is told by what needs it, and a removal mends it.
    fs::remove_dir_all(at.join("p.petro/horizons/Delta.zarr")).unwrap();
    as_user(user, at, "horizon remove p.petro Delta").done();
    as_user(user, at, "import s/survey.sgy own.petro").done();
    fs::remove_dir_all(at.join("own.petro/volumes/seismic.zarr")).unwrap();
    as_user(user, at, "velocity own.petro 2500").done();
    // A history of which a step is damaged is no reason to refuse.
    let other = tempfile::tempdir().unwrap();
    fs::write(at.join("p.petro/history/0003.toml"), "= damaged").unwrap();
    as_user(other.path(), at, "velocity p.petro 2600").done();
}

#[test]
#[cfg(unix)]
fn nothing_is_read_through_a_link() {
    let folder = project();
    let at = folder.path();
    let root = at.join("p.petro");
    fs::rename(root.join("horizons/Alpha.zarr"), at.join("Alpha.zarr")).unwrap();
    std::os::unix::fs::symlink(at.join("Alpha.zarr"), root.join("horizons/Alpha.zarr")).unwrap();
    for line in [
        "info p.petro",
        "horizon show p.petro Alpha",
        "render p.petro a.png --size 80x60 --samples 1 --device cpu",
        "export p.petro out.csv --horizon Alpha --format csv",
        "scene list p.petro",
    ] {
        run_in(at, line).failed(&["is a link"]);
    }
    assert!(!at.join("a.png").exists() && !at.join("out.csv").exists());
}

#[test]
fn a_line_end_in_a_name_makes_no_line_of_its_own() {
    let folder = project();
    let at = folder.path();
    let state = at.join("p.petro/project.toml");
    let text = fs::read_to_string(&state).unwrap();
    fs::write(&state, text.replace("name = \"Alpha\"", "name = \"Alpha\\nnothing is damaged\"")).unwrap();
    for line in ["horizon list p.petro", "info p.petro", "check p.petro", "layer list p.petro"] {
        let told = run_in(at, line).stdout;
        assert!(told.contains("Alpha\\nnothing is damaged") || line.starts_with("check"), "{line}: {told}");
        let forged = told.lines().filter(|line| line.starts_with("nothing is damaged")).count();
        assert!(forged <= usize::from(line.starts_with("check")), "{line}: {told}");
    }
}
