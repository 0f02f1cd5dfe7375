//! Names that look like leftovers, and projects made by someone who means harm: nothing is deleted that is not the
//! project's own, and nothing of it that a state refers to.

use crate::program::{bytes, project, run_in, survey};
use std::fs;
use std::path::Path;

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
        for path in before.keys().filter(|path| !is_history_or_state(path)) {
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
        crate::program::copy(&root, &copied);
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
