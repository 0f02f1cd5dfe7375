//! Names are for people: a rename changes a name and nothing else. The project was written by version 0.1.0, which
//! referred to everything by name.

use crate::program::run_in;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// Folders of a project that git does not keep while they are empty.
const FOLDERS: [&str; 4] = ["volumes", "wells", "textures", "parameterizations"];

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap().map(Result::unwrap) {
        let to = to.join(entry.file_name());
        match entry.path() {
            path if path.is_dir() => copy(&path, &to),
            path => drop(fs::copy(path, to).unwrap()),
        }
    }
}

/// A project of version 1: two horizons, one that was drawn, a fault whose label a scene hides, two figures.
fn old() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let fixture = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/v1/named.petro");
    copy(&fixture, &folder.path().join("p.petro"));
    FOLDERS.iter().for_each(|name| fs::create_dir_all(folder.path().join("p.petro").join(name)).unwrap());
    folder
}

/// Every file but the state, its history and the lock, with its bytes.
fn data(root: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut folders = vec![root.to_owned()];
    while let Some(folder) = folders.pop() {
        for path in fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()) {
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            match path.is_dir() {
                true if name != "history" => folders.push(path),
                false if name != "project.toml" && name != "lock" => {
                    found.insert(path.clone(), fs::read(path).unwrap());
                }
                _ => {}
            }
        }
    }
    found
}

fn figures(at: &Path, out: &str) -> [String; 2] {
    run_in(at, &format!("figures p.petro {out} --device cpu")).done();
    ["maps.svg", "block.svg"].map(|file| fs::read_to_string(at.join(out).join(file)).unwrap())
}

#[test]
fn figures_scenes_and_styles_follow_what_is_renamed_and_nothing_is_computed_anew() {
    let folder = old();
    let at = folder.path();
    let [maps, block] = figures(at, "before");
    assert!(maps.contains("Depth of Alpha (m)") && maps.contains("Gamma") && !block.contains(">Gamma"));
    let before = data(&at.join("p.petro"));
    run_in(at, "horizon rename p.petro Alpha Omega").done();
    run_in(at, "fault rename p.petro Gamma Delta").done();
    run_in(at, "scene rename p.petro View Page").done();
    let [maps, block] = figures(at, "after");
    assert!(maps.contains("Depth of Omega (m)") && maps.contains("Delta"), "{maps}");
    assert!(!block.contains(">Delta"), "a hidden label is back");
    assert!(run_in(at, "layer list p.petro").done().stdout.contains("above Omega"));
    for (path, bytes) in &data(&at.join("p.petro")) {
        assert!(before.get(path) == Some(bytes), "{} was made anew", path.display());
    }
    let state = fs::read_to_string(at.join("p.petro/project.toml")).unwrap();
    assert!(["Alpha\"", "Gamma\"", "View\""].iter().all(|name| !state.contains(name)), "{state}");
    assert_eq!(["Omega", "Delta", "Page"].map(|name| state.matches(name).count()), [1; 3], "{state}");
    run_in(at, "check p.petro").done();
    (0..3).for_each(|_| drop(run_in(at, "undo p.petro").done()));
    assert_eq!(figures(at, "undone")[1], fs::read_to_string(at.join("before/block.svg")).unwrap());
}

#[test]
fn what_showed_a_removed_thing_goes_with_it_and_is_said() {
    let folder = old();
    let at = folder.path();
    let told = run_in(at, "horizon remove p.petro Alpha").done();
    assert!(
        told.stdout.contains("figure \"maps.svg\"") && told.stdout.contains("layer \"above Alpha\""),
        "{}",
        told.stdout
    );
    assert!(run_in(at, "figures p.petro out --device cpu").done().stdout.contains("block.svg"));
    run_in(at, "undo p.petro").done();
    let told = run_in(at, "scene remove p.petro View").done();
    assert!(told.stdout.contains("note 1") && told.stdout.contains("figure \"block.svg\""), "{}", told.stdout);
}

#[test]
fn a_reference_to_nothing_is_told_by_a_check() {
    let folder = old();
    let at = folder.path();
    let state = at.join("p.petro/project.toml");
    let text = fs::read_to_string(&state).unwrap();
    fs::write(&state, text.replace("\nhorizon = \"Alpha\"", "\nhorizon = \"Alfa\"")).unwrap();
    let told = run_in(at, "check p.petro").done().stdout;
    assert!(told.contains("figure \"maps.svg\": there is no horizon \"Alfa\""), "{told}");
}
