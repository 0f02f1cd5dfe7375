//! Geologic time: computed, kept as a volume, and horizons picked by it; a survey illustrated without interpretation.

use crate::program::run_in;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// Depths of a horizon by line numbers, of which there may be several.
fn depths(at: &Path, horizon: &str) -> BTreeMap<(i64, i64), Vec<f64>> {
    let line = format!("export p.petro {horizon}.csv --horizon {horizon} --format csv");
    run_in(at, &line).done();
    let text = fs::read_to_string(at.join(format!("{horizon}.csv"))).unwrap();
    let mut rows = text.lines().filter(|line| !line.starts_with('#'));
    let header: Vec<&str> = rows.next().unwrap().split(',').collect();
    let column = |name: &str| header.iter().position(|found| *found == name).unwrap();
    let (inline, crossline, z) = (column("inline"), column("crossline"), column("depth_m"));
    let mut found: BTreeMap<(i64, i64), Vec<f64>> = BTreeMap::new();
    for row in rows {
        let cells: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN)).collect();
        found.entry((cells[inline] as i64, cells[crossline] as i64)).or_default().push(cells[z]);
    }
    found
}

#[test]
fn one_pick_by_time_is_a_horizon_in_all_blocks_with_its_quality() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let made = run_in(at, "synth s --size 96x72x96 --seed 2 --snr 8 --json").done().json();
    run_in(at, "import s/survey.sgy p.petro").done();
    for fault in made["faults"].as_array().unwrap() {
        let (file, name) = (fault["file"].as_str().unwrap(), fault["name"].as_str().unwrap());
        run_in(at, &format!("fault add p.petro '{file}' --name '{name}'")).done();
    }
    run_in(at, "time p.petro").failed(&["no horizon candidates"]);
    run_in(at, "extract p.petro").done();
    run_in(at, "pick p.petro --at 150,540,400 --horizon Early --by-time")
        .failed(&["no geologic time", "petroglyph time"]);
    let flat = "attribute p.petro --kind flattened --name flat";
    run_in(at, flat).failed(&["no geologic time", "petroglyph time"]);
    let told = run_in(at, "time p.petro --json").done().json();
    assert!(told["known"].as_f64().unwrap() > 0.9 && told["faults"] == 3, "{told}");
    // Any volume on the lattice can be laid flat.
    run_in(at, &format!("{flat}-time --volume time")).done();
    run_in(at, flat).done();
    for name in ["flat", "flat-time"] {
        run_in(at, &format!("export p.petro {name}.sgy --volume {name}")).done();
        assert!(fs::metadata(at.join(format!("{name}.sgy"))).unwrap().len() > 100_000);
        run_in(at, "undo p.petro").done();
    }
    assert!(run_in(at, "volume list p.petro").done().stdout.contains("time"));
    // The truth of Bravo, and one place on it in the first block.
    let truth = made["horizons"].as_array().unwrap().iter().find(|h| h["name"] == "Bravo").unwrap();
    run_in(at, &format!("horizon add p.petro {} --name Truth", truth["file"].as_str().unwrap())).done();
    let truth = depths(at, "Truth");
    let (&(inline, crossline), z) = truth.iter().find(|((i, c), _)| *i >= 108 && *c >= 530).unwrap();
    let line = format!("pick p.petro --at {inline},{crossline},{} --horizon Bravo --by-time --json", z[0]);
    run_in(at, "horizon remove p.petro Truth").done();
    let picked = run_in(at, &line).done().json();
    assert!(picked["coverage"].as_f64().unwrap() > 0.9, "{picked}");
    assert!(
        picked["sheets"].as_u64().unwrap() >= 3 && picked["tracked"].as_u64() > picked["between"].as_u64(),
        "{picked}"
    );
    // Samples are 10 m apart.
    let found = depths(at, "Bravo");
    let near = |place: &(i64, i64), z: f64| {
        found.get(place).is_some_and(|found| found.iter().any(|depth| (depth - z).abs() <= 10.0))
    };
    let nodes: Vec<bool> = truth.iter().flat_map(|(place, z)| z.iter().map(move |z| near(place, *z))).collect();
    let share = nodes.iter().filter(|near| **near).count() as f64 / nodes.len() as f64;
    assert!(share > 0.9, "{share} of the nodes within a sample");
    assert!(picked["snapped"].as_u64().is_some() && picked["seeds"] == 1, "{picked}");
    // A second place corrects the horizon; one that is no horizon by time cannot be corrected.
    let (&(inline, crossline), z) = truth.iter().rfind(|((i, c), _)| *i <= 180 && *c <= 560).unwrap();
    let line = format!("pick p.petro --at {inline},{crossline},{} --horizon Bravo --by-time", z[0]);
    assert!(run_in(at, &line).done().stdout.contains("through 2 places"));
    assert!(fs::read_to_string(at.join("p.petro/project.toml")).unwrap().contains("seeds"));
    run_in(at, "undo p.petro").done();
    run_in(at, "pick p.petro --at 1,1,1 --horizon Out --by-time").failed(&["outside the survey"]);
    run_in(at, "undo p.petro").done();
    assert!(!run_in(at, "horizon list p.petro").done().stdout.contains("Bravo"));
}

#[test]
fn faults_are_proposed_before_there_is_a_horizon() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    run_in(at, "synth s --size 96x72x96 --seed 2 --snr 8").done();
    run_in(at, "import s/survey.sgy p.petro").done();
    let told = run_in(at, "fault propose p.petro --json").done().json();
    let proposals = told["proposals"].as_array().unwrap();
    let sure = proposals.iter().filter(|p| p["is_minor"] == false).count();
    assert_eq!(sure, 3, "three faults: {told}");
    assert!(proposals.iter().all(|p| p["horizons"].as_array().unwrap().is_empty()));
    assert!(proposals.iter().all(|p| p["evidence"].as_f64() > Some(0.0) && p["area_m2"].as_f64() > Some(0.0)));
    assert!(run_in(at, "fault propose p.petro").done().stdout.contains("its two sides match after the throw"));
    run_in(at, "extract p.petro").done();
    run_in(at, "fault accept p.petro 1 --name West").done();
    assert!(run_in(at, "fault list p.petro").done().stdout.contains("West"));
    // The drawn ones cut geologic time, and what is accepted is not proposed again.
    assert_eq!(run_in(at, "time p.petro --json").done().json()["faults"], 1);
    let again = run_in(at, "fault propose p.petro --json").done().json();
    assert_eq!(again["proposals"].as_array().unwrap().len(), proposals.len() - 1, "{again}");
}

#[test]
fn a_survey_is_illustrated_without_interpretation() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    run_in(at, "synth s --size 48x48x64 --seed 1").done();
    let done = run_in(at, "illustrate s/survey.sgy block.svg --layers 4 --device cpu --json").done().json();
    let layers = done["layers"].as_array().unwrap().len();
    assert!((2..=4).contains(&layers), "{done}");
    let svg = fs::read_to_string(at.join("block.svg")).unwrap();
    assert!(svg.contains("ninterpreted"), "the page says so");
    assert!(run_in(at, "horizon list block.petro").done().stdout.contains("Level 1"));
    run_in(at, "illustrate s/survey.sgy block.png").failed(&["block.petro"]);
    let refused = run_in(at, "illustrate s/survey.sgy other.png --layers 1");
    assert!(refused.code == 2 && refused.stderr.contains("at least 2"), "{}", refused.stderr);
}
