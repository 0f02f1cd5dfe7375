//! Names that look like leftovers, and projects made by someone who means harm: nothing is deleted that is not the
//! project's own, and nothing of it that a state refers to.

use crate::program::{bytes, copy, forget_hash_of_tile, project, run_in, survey};
use std::fs;
use std::path::Path;
use store::StoredVolume;
use survey::Progress;

/// Names that once were taken for leftovers of a crash.
const ORDINARY: [&str; 4] = ["far.partial-stack", "BCU.partial-north", "Top.replaced-2024", "draft.new"];

#[test]
fn no_name_is_taken_for_a_leftover() {
    let folder = survey();
    let at = folder.path();
    run_in(at, "import s/survey.sgy p.petro --name far.partial-stack").done();
    for name in &ORDINARY[1..] {
        run_in(at, &format!("horizon add p.petro s/horizons/Alpha.csv --name {name}")).done();
    }
    fs::write(at.join("p.petro/notes.new"), "mine").unwrap();
    let before = bytes(&at.join("p.petro"));
    for change in
        ["velocity p.petro 2500", "velocity p.petro 2600", "undo p.petro", "velocity p.petro 2700", "prune p.petro"]
    {
        run_in(at, change).done();
    }
    let after = bytes(&at.join("p.petro"));
    for (path, content) in before.iter().filter(|(path, _)| !is_history_or_state(path)) {
        assert!(after.get(path) == Some(content), "{} is gone or another", path.display());
    }
    run_in(at, "render p.petro a.png --size 80x60 --samples 1 --device cpu --blend 1").done();
    run_in(at, "export p.petro out.csv --horizon Top.replaced-2024 --format csv").done();
}

fn is_history_or_state(path: &Path) -> bool {
    path.ends_with("project.toml") || path.parent().is_some_and(|folder| folder.ends_with("history"))
}

/// What is computed again where it is missing, and forgotten when newer states take its place.
fn is_computed(path: &Path) -> bool {
    path.parent().is_some_and(|folder| folder.ends_with("derived"))
}

/// Replaces the file of the first volume in a text of the state.
fn with_file(text: &str, file: &str) -> String {
    let marker = "file = \"volumes/";
    let from = text.find(marker).unwrap() + "file = \"".len();
    let to = from + text[from..].find('"').unwrap();
    format!("{}{file}{}", &text[..from], &text[to..])
}

#[test]
fn a_history_step_cannot_name_what_is_not_its_data() {
    for file in ["", "volumes", "volumes/.", "horizons", "history", ".", "project.toml", "volumes/../horizons"] {
        let folder = project();
        let at = folder.path();
        let root = at.join("p.petro");
        run_in(at, "velocity p.petro 2100").done();
        // The step is the last one, and is forgotten by the next command after an undo, or by pruning.
        let last = last_step(&root);
        let step = fs::read_to_string(&last).unwrap();
        run_in(at, "undo p.petro").done();
        fs::write(&last, with_file(&step, file)).unwrap();
        let before = bytes(&root);
        run_in(at, "velocity p.petro 2200").done();
        run_in(at, "prune p.petro").done();
        let after = bytes(&root);
        for path in before.keys().filter(|path| !is_history_or_state(path) && !is_computed(path)) {
            assert!(after.contains_key(path), "\"{file}\" cost {}", path.display());
        }
        assert!(root.join("project.toml").exists());
        // The state itself is refused with such a file.
        let state = fs::read_to_string(root.join("project.toml")).unwrap();
        fs::write(root.join("project.toml"), with_file(&state, file)).unwrap();
        run_in(at, "velocity p.petro 2300").failed(&["volumes/NAME"]);
    }
}

fn last_step(root: &Path) -> std::path::PathBuf {
    let mut steps: Vec<_> = fs::read_dir(root.join("history")).unwrap().map(|entry| entry.unwrap().path()).collect();
    steps.sort();
    steps.pop().unwrap()
}

#[test]
#[cfg(unix)]
fn a_link_in_a_project_leads_nobody_outside() {
    use std::os::unix::fs::symlink;
    let folder = project();
    let at = folder.path();
    let outside = at.join("outside");
    let texture = at.join("tile.png");
    image::RgbImage::from_pixel(2, 2, image::Rgb([1, 0, 0])).save(&texture).unwrap();
    for name in [
        "textures",
        "derived",
        "lock",
        "history",
        "volumes",
        "unfinished",
        "importing",
        "project.toml",
        "history/0000.toml",
    ] {
        let _ = fs::remove_dir_all(&outside);
        fs::create_dir_all(outside.join("precious.partial-1-0")).unwrap();
        fs::write(outside.join("precious.partial-1-0/data"), "mine").unwrap();
        fs::write(outside.join("a.new"), "mine").unwrap();
        let root = at.join("p.petro");
        let copied = at.join("copy.petro");
        let _ = fs::remove_dir_all(&copied);
        copy(&root, &copied);
        let link = copied.join(name);
        let target = if name == "lock" { at.join("nothing-yet") } else { outside.clone() };
        if name.ends_with(".toml") {
            // Moved outside and linked, so that it can be read all the same.
            fs::rename(&link, outside.join("moved.toml")).unwrap();
            symlink(outside.join("moved.toml"), &link).unwrap();
        } else if link.is_dir() {
            for entry in fs::read_dir(&link).unwrap().flatten() {
                fs::rename(entry.path(), outside.join(entry.file_name())).unwrap();
            }
            fs::remove_dir(&link).unwrap();
            symlink(&target, &link).unwrap();
        } else {
            let _ = fs::remove_file(&link);
            symlink(&target, &link).unwrap();
        }
        let before = bytes(&outside);
        for change in [
            "velocity copy.petro 2500",
            "texture copy.petro tile.png",
            "undo copy.petro",
            "prune copy.petro",
            "import s/survey.sgy copy.petro --name b",
        ] {
            run_in(at, change).failed(&["is a link"]);
        }
        // What only keeps its result beside the project does without.
        let _ = run_in(at, "render copy.petro a.png --size 80x60 --samples 1 --device cpu");
        assert!(bytes(&outside) == before, "{name} led outside");
        assert!(!at.join("nothing-yet").exists(), "{name} made a file outside");
    }
}

/// A horizon of the project in `at`, read and stored again with another depth at its first node.
fn change_a_depth(at: &Path, name: &str, depth: f32) {
    let path = at.join("p.petro").join(file_of(at, "horizons", name));
    let mut horizon = store::read_horizon(&path, &Progress::silent()).unwrap();
    horizon.sheets[0].depth[0] = depth;
    store::write_horizon(&path, &horizon, &Progress::silent()).unwrap();
}

/// The file of an object, as the state names it.
fn file_of(at: &Path, kind: &str, name: &str) -> String {
    let state = fs::read_to_string(at.join("p.petro/project.toml")).unwrap();
    let begin = format!("file = \"{kind}/{name}");
    let from = state.find(&begin).unwrap() + "file = \"".len();
    state[from..].split('"').next().unwrap().to_owned()
}

const RENDER: &str = "render p.petro a.png --size 80x60 --samples 1 --device cpu";

#[test]
fn data_changed_behind_the_project_are_not_drawn_even_from_what_was_computed() {
    let folder = project();
    let at = folder.path();
    run_in(at, RENDER).done();
    run_in(at, "fault propose p.petro").done();
    let changed = ["Alpha", "is not what the project recorded", "backup"];
    let original = fs::read(at.join("a.png")).unwrap();
    change_a_depth(at, "Alpha", 100.0);
    for line in [RENDER, "fault propose p.petro", "export p.petro out.csv --horizon Alpha --format csv"] {
        run_in(at, line).failed(&changed);
    }
    assert!(fs::read(at.join("a.png")).unwrap() == original, "the picture of before is still there");
    // What does not need the horizon works, and removing it mends the rest.
    run_in(at, "info p.petro").done();
    run_in(at, "horizon remove p.petro Alpha").done();
    run_in(at, RENDER).done();
}

#[test]
fn every_kind_of_data_is_compared_with_its_hash() {
    let folder = project();
    let at = folder.path();
    let root = at.join("p.petro");
    let silent = Progress::silent();
    image::RgbImage::from_pixel(2, 2, image::Rgb([1, 0, 0])).save(at.join("tile.png")).unwrap();
    run_in(at, "texture p.petro tile.png").done();
    run_in(at, "extract p.petro").done();
    run_in(at, RENDER).done();
    let fails = |line: &str, noun: &str, name: &str| {
        run_in(at, line).failed(&[&format!("recorded of {noun} \"{name}\""), "was recorded"]);
    };
    let with = |file: &str, change: &dyn Fn(&Path), check: &dyn Fn()| {
        let (path, aside) = (root.join(file), at.join("aside"));
        fs::create_dir_all(&aside).unwrap();
        if path.is_dir() {
            copy(&path, &aside);
        } else {
            fs::copy(&path, aside.join("file")).unwrap();
        }
        change(&path);
        check();
        if path.is_dir() {
            fs::remove_dir_all(&path).unwrap();
            fs::rename(&aside, &path).unwrap();
        } else {
            fs::rename(aside.join("file"), &path).unwrap();
        }
        run_in(at, RENDER).done();
    };

    let fault = file_of(at, "faults", "Normal");
    let move_a_vertex = |path: &Path| {
        let mut fault = store::read_fault(path).unwrap();
        fault.mesh.vertices[0].z += 1e-3;
        store::write_fault(path, &fault).unwrap();
    };
    with(&fault, &move_a_vertex, &|| {
        fails(RENDER, "fault", "Normal fault");
        fails("fault propose p.petro", "fault", "Normal fault");
    });

    let another_tile = |path: &Path| image::RgbImage::from_pixel(2, 2, image::Rgb([0, 1, 0])).save(path).unwrap();
    with(&file_of(at, "textures", "tile"), &another_tile, &|| fails(RENDER, "texture", "tile"));

    let volume = file_of(at, "volumes", "seismic");
    let another_volume = |path: &Path| {
        let stored = StoredVolume::open(path).unwrap();
        let (mut samples, info) = (stored.read_f32(0, &silent).unwrap(), stored.info().clone());
        samples.trace_mut(3, 4)[5] += 1.0;
        fs::remove_dir_all(path).unwrap();
        store::write_volume(path, &samples, &info, &silent).unwrap();
    };
    with(&volume, &another_volume, &|| {
        for line in [
            "extract p.petro",
            "render p.petro b.png --size 80x60 --samples 1 --device cpu --blend 1",
            "attribute p.petro --kind envelope --name e",
            "export p.petro b.sgy --volume seismic",
        ] {
            fails(line, "volume", "seismic");
        }
    });

    // A project from before the hashes of tiles were recorded.
    forget_hash_of_tile(&root);
    another_tile(&root.join(file_of(at, "textures", "tile")));
    run_in(at, RENDER).done();
}

#[test]
fn a_depth_beyond_any_survey_is_refused() {
    let folder = project();
    let at = folder.path();
    let path = at.join("p.petro").join(file_of(at, "horizons", "Alpha"));
    let mut horizon = store::read_horizon(&path, &Progress::silent()).unwrap();
    horizon.sheets[0].depth.fill(1e30);
    let refused = store::write_horizon(&path, &horizon, &Progress::silent()).unwrap_err().to_string();
    assert!(refused.contains("1e30") && refused.contains("beyond any survey"), "{refused}");
    // Written by someone else, as Zarr allows: the depths in one file without a checksum of its own.
    let array = path.join("0/depth");
    let meta = fs::read_to_string(array.join("zarr.json")).unwrap();
    let meta: serde_json::Value = serde_json::from_str(&meta).unwrap();
    let nodes = horizon.sheets[0].depth.len();
    fs::remove_dir_all(array.join("c")).unwrap();
    let mut plain = meta.clone();
    let shape = meta["shape"].clone();
    plain["chunk_grid"]["configuration"]["chunk_shape"] = shape;
    plain["codecs"] = serde_json::json!([{ "name": "bytes", "configuration": { "endian": "little" } }]);
    fs::write(array.join("zarr.json"), plain.to_string()).unwrap();
    fs::create_dir_all(array.join("c/0")).unwrap();
    fs::write(array.join("c/0/0"), 1e30f32.to_le_bytes().repeat(nodes)).unwrap();
    run_in(at, RENDER).failed(&["horizons/Alpha", "1e30", "beyond any survey"]);
}
