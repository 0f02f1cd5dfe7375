//! Horizon candidates through the program.

use crate::program::{Run, bytes, command, project, run_in};
use std::fs;
use std::path::Path;

#[test]
fn candidates_are_extracted_once_and_exported_as_points() {
    let folder = project();
    let at = folder.path();
    run_in(at, "export p.petro c.csv --candidates").failed(&["no horizon candidates yet", "petroglyph extract"]);
    let found = run_in(at, "extract p.petro --json").done().json();
    for field in ["surfaces", "leaves", "triangles"] {
        assert!(found[field].as_u64().unwrap() > 0, "{field}: {found}");
    }
    for stage in ["growing", "trees", "distances", "storing", "total"] {
        assert!(found["seconds"][stage].is_number(), "{stage}: {found}");
    }
    assert_eq!((found["computed"].as_bool(), found["volume"].as_str()), (Some(true), Some("seismic")));
    let before = bytes(&at.join("p.petro/derived/candidates.zarr"));
    let again = run_in(at, "extract p.petro").done();
    assert!(again.stdout.contains("nothing has changed"), "{}", again.stdout);
    assert_eq!(bytes(&at.join("p.petro/derived/candidates.zarr")), before);
    let other = run_in(at, "extract p.petro --extrema peak --min-leaf-triangles 100 --json").done().json();
    assert_eq!(other["computed"], true);
    assert!(other["surfaces"].as_u64() < found["surfaces"].as_u64() && other["key"] != found["key"]);
    let points = run_in(at, "export p.petro c.csv --candidates --json").done().json();
    let text = fs::read_to_string(at.join("c.csv")).unwrap();
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("inline,crossline,z,leaf,surface"));
    let rows: Vec<Vec<f64>> = lines.map(|line| line.split(',').map(|n| n.parse().unwrap()).collect()).collect();
    assert_eq!(rows.len() as u64, points["points"].as_u64().unwrap());
    let (leaves, surfaces) = (other["leaves"].as_f64().unwrap(), other["surfaces"].as_f64().unwrap());
    assert!(rows.iter().all(|row| (1.0..=leaves).contains(&row[3]) && (1.0..=surfaces).contains(&row[4])));
}

#[test]
fn damaged_candidates_are_extracted_again() {
    let folder = project();
    let at = folder.path();
    run_in(at, "extract p.petro").done();
    let root = at.join("p.petro/derived/candidates.zarr");
    let before = bytes(&root);
    for array in ["forest", "distance"] {
        let inside = |path: &Path| path.strip_prefix(&root).is_ok_and(|path| path.starts_with(array));
        let (path, content) = before
            .iter()
            .filter(|(path, _)| inside(path) && !path.ends_with("zarr.json"))
            .max_by_key(|(_, content)| content.len())
            .unwrap();
        let mut damaged = content.clone();
        // In the middle of the first chunk, which no index covers.
        damaged[8] ^= 1;
        fs::write(path, damaged).unwrap();
        let again = run_in(at, "extract p.petro").done();
        assert!(again.stderr.contains("damaged and are extracted again"), "{array}: {}", again.stderr);
        assert!(!again.stdout.contains("nothing has changed"), "{array}: {}", again.stdout);
        assert!(bytes(&root) == before, "{array}");
        let quiet = run_in(at, "extract p.petro").done();
        assert!(quiet.stdout.contains("nothing has changed") && !quiet.stderr.contains("damaged"), "{array}");
    }
}

#[test]
fn the_same_extraction_twice_gives_the_same_bytes() {
    let extracted = |threads: &str| {
        let folder = project();
        let root = folder.path().join("p.petro/derived/candidates.zarr");
        let run = command()
            .current_dir(folder.path())
            .env("RAYON_NUM_THREADS", threads)
            .args(["extract", "p.petro", "--json"])
            .output();
        let told = Run::of(&run.unwrap()).done().json();
        assert!(told["seconds"]["total"].as_f64().unwrap() > 0.0, "the command tells its times: {told}");
        let again = run_in(folder.path(), "extract p.petro --json").done().json();
        assert!(again["computed"] == false && again["seconds"].is_null(), "{again}");
        let files = bytes(&root).into_iter();
        files.map(|(path, content)| (path.strip_prefix(&root).unwrap().to_owned(), content)).collect::<Vec<_>>()
    };
    let (once, twice) = (extracted("1"), extracted("2"));
    assert!(once.iter().any(|(path, _)| path == Path::new("zarr.json")));
    for ((path, content), (other, again)) in once.iter().zip(&twice) {
        assert!(path == other && content == again, "{} differs", path.display());
    }
    assert_eq!(once.len(), twice.len());
}

#[test]
fn what_cannot_be_extracted_is_a_sentence() {
    let folder = project();
    let at = folder.path();
    run_in(at, "extract p.petro --volume impedance").failed(&["impedance", "another lattice"]);
    run_in(at, "extract p.petro --volume nothing").failed(&["nothing"]);
    run_in(at, "extract p.petro --max-distance 1000").failed(&["max_distance", "64"]);
    run_in(at, "extract p.petro --fault-evidence=-1").failed(&["-1", "inf"]);
    run_in(at, "extract p.petro --min-leaf-triangles 0").failed(&["min_leaf_triangles"]);
    assert_eq!(run_in(at, "extract p.petro --extrema ridge").code, 2);
    assert_eq!(run_in(at, "export p.petro c.csv").code, 2);
    let nothing = run_in(at, "extract p.petro --min-front-width 47").done();
    assert!(nothing.stdout.contains("no surface at least 47 traces wide"), "{}", nothing.stdout);
    run_in(at, "create q.petro --bounds 0,100,0,100,0,100 --size 5x5x5").done();
    run_in(at, "extract q.petro").failed(&["no volume on its own lattice"]);
}

#[test]
fn an_extraction_is_undone_and_its_picks_come_back() {
    let folder = project();
    let at = folder.path();
    let key = |at: &Path| -> String {
        let text = fs::read_to_string(at.join("p.petro/project.toml")).unwrap();
        let from = text.find("[extraction]").map(|at| text[at..].find("key = \"").unwrap() + at + 7);
        from.map_or_else(String::new, |from| text[from..from + 32].to_owned())
    };
    let present = |at: &Path| at.join("p.petro/derived/candidates.zarr").exists();
    run_in(at, "extract p.petro --min-leaf-triangles 60").done();
    let first = key(at);
    let points = |at: &Path| {
        run_in(at, "export p.petro points.csv --candidates").done();
        fs::read_to_string(at.join("points.csv")).unwrap()
    };
    let before = points(at);
    let place: Vec<String> =
        before.lines().nth(before.lines().count() / 2).unwrap().split(',').map(str::to_owned).collect();
    let pick = format!("pick p.petro --at {},{},{} --horizon Picked", place[0], place[1], place[2]);
    run_in(at, &pick).done();
    // Extracting again as it was is no step.
    let steps = run_in(at, "info p.petro --json").done().json()["history"].as_array().unwrap().len();
    run_in(at, "extract p.petro --min-leaf-triangles 60").done();
    assert_eq!(run_in(at, "info p.petro --json").done().json()["history"].as_array().unwrap().len(), steps);
    // Another extraction outdates the picks; undo brings back theirs.
    run_in(at, "extract p.petro --min-leaf-triangles 200").done();
    assert_ne!(key(at), first);
    assert_ne!(points(at), before);
    run_in(at, "climb p.petro 1").failed(&["the extraction has changed"]);
    run_in(at, "undo p.petro").done();
    assert_eq!(key(at), first);
    assert_eq!(points(at), before);
    run_in(at, "horizon replay p.petro").done();
    // Back before the first there is none; forward again nothing is computed anew.
    for _ in 0..3 {
        run_in(at, "undo p.petro").done();
    }
    assert!(key(at).is_empty() && !present(at));
    run_in(at, "export p.petro points.csv --candidates").failed(&["no horizon candidates"]);
    run_in(at, "redo p.petro").done();
    assert_eq!(points(at), before);
    let again = run_in(at, "extract p.petro --min-leaf-triangles 200 --json").done().json();
    assert_eq!(again["computed"], true, "the undone extraction was forgotten with its step");
    run_in(at, "prune p.petro").done();
    let left = fs::read_dir(at.join("p.petro/derived")).unwrap().flatten();
    let extractions = left.filter(|entry| entry.file_name().to_string_lossy().starts_with("candidates")).count();
    assert_eq!(extractions, 1, "what no state names is gone");
}
