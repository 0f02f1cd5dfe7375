//! What geologic time obeys, and what is made of it: constraints, slabs, stacks, attributes, textures.

use crate::program::run_in;
use std::fs;
use std::path::Path;

/// A project with a small synthetic survey, its faults and its candidates; the files of its true horizons by name.
fn extracted(at: &Path, size: &str) -> serde_json::Value {
    let made = run_in(at, &format!("synth s --size {size} --seed 2 --snr 8 --json")).done().json();
    run_in(at, "import s/survey.sgy p.petro").done();
    for fault in made["faults"].as_array().unwrap() {
        let (file, name) = (fault["file"].as_str().unwrap(), fault["name"].as_str().unwrap());
        run_in(at, &format!("fault add p.petro '{file}' --name '{name}'")).done();
    }
    run_in(at, "extract p.petro").done();
    made["horizons"].clone()
}

fn add_horizon(at: &Path, horizons: &serde_json::Value, name: &str) {
    let horizon = horizons.as_array().unwrap().iter().find(|horizon| horizon["name"] == name).unwrap();
    run_in(at, &format!("horizon add p.petro {} --name {name}", horizon["file"].as_str().unwrap())).done();
}

/// A column of a CSV file.
fn column(at: &Path, file: &str, name: &str) -> Vec<f64> {
    let text = fs::read_to_string(at.join(file)).unwrap();
    let mut rows = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let header = rows.next().unwrap();
    let place = header.iter().position(|found| *found == name).unwrap_or_else(|| panic!("{name} in {header:?}"));
    rows.filter_map(|row| row[place].parse().ok()).collect()
}

#[test]
fn time_is_one_on_picked_horizons_and_jumps_at_unconformities() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let horizons = extracted(at, "72x60x80");
    let spread = |file: &str| {
        let mut times = column(at, file, "time");
        times.sort_by(f64::total_cmp);
        assert!(times.len() > 3000, "{}", times.len());
        times[times.len() * 95 / 100] - times[times.len() * 5 / 100]
    };
    run_in(at, "time p.petro").done();
    add_horizon(at, &horizons, "Bravo");
    run_in(at, "export p.petro before.csv --horizon Bravo --values time").done();
    let before = spread("before.csv");
    run_in(at, "volume remove p.petro time").done();
    add_horizon(at, &horizons, "Unconformity");
    run_in(at, "horizon contact p.petro Unconformity erosional").done();
    let told = run_in(at, "time p.petro --json").done().json();
    assert!(told["horizons"] == 2 && told["unconformities"] == 1, "{told}");
    run_in(at, "export p.petro after.csv --horizon Bravo --values time seismic --window 3").done();
    let after = spread("after.csv");
    assert!(before > 0.05 && after < 1e-3, "{before} before, {after} after");
    // Amplitudes along it, and over a window around it.
    let (values, rms) = (column(at, "after.csv", "seismic"), column(at, "after.csv", "seismic rms"));
    assert!(values.len() > 3000 && values.len() == rms.len() && rms.iter().all(|rms| *rms >= 0.0));
    let refused = run_in(at, "export p.petro x.csv --horizon Bravo --values nothing");
    refused.failed(&["nothing"]);
    // Where time runs fast, beds are missing.
    run_in(at, "attribute p.petro --kind hiatus --name missing").done();
    run_in(at, "export p.petro missing.csv --horizon Unconformity --values missing --window 2").done();
    run_in(at, "export p.petro complete.csv --horizon Bravo --values missing --window 2").done();
    let mean = |file: &str| {
        let all = column(at, file, "missing greatest");
        all.iter().sum::<f64>() / all.len() as f64
    };
    assert!(mean("missing.csv") > 1.25 * mean("complete.csv"), "{} {}", mean("missing.csv"), mean("complete.csv"));
}

#[test]
fn a_survey_that_does_not_fit_is_solved_in_slabs() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    extracted(at, "136x36x64");
    let whole = run_in(at, "time p.petro --json").done().json();
    let slabs = run_in(at, "time p.petro --name slabs --memory 1M --json").done().json();
    assert!(whole["slabs"] == 1 && slabs["slabs"] == 2, "{slabs}");
    let known = |told: &serde_json::Value| told["known"].as_f64().unwrap();
    assert!(known(&slabs) > known(&whole) - 0.05, "{slabs} {whole}");
    let refused = run_in(at, "time p.petro --name other --memory much");
    assert!(refused.code == 2 && refused.stderr.contains("--memory"), "{}", refused.stderr);
}

#[test]
fn stacks_lie_between_their_horizons_and_textures_follow_time() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let horizons = extracted(at, "56x48x72");
    for name in ["Alpha", "Bravo"] {
        add_horizon(at, &horizons, name);
    }
    let isochrons = "horizon stack p.petro Slice --count 3 --between Alpha Bravo";
    run_in(at, isochrons).failed(&["no geologic time", "petroglyph time"]);
    run_in(at, "time p.petro").done();
    let made = run_in(at, &format!("{isochrons} --json")).done().json();
    assert_eq!(made["horizons"].as_array().unwrap().len(), 3, "{made}");
    let list = run_in(at, "horizon list p.petro").done().stdout;
    let places: Vec<usize> = ["Alpha", "Slice 1", "Slice 2", "Slice 3", "Bravo"].map(|n| list.find(n).unwrap()).into();
    assert!(places.windows(2).all(|pair| pair[0] < pair[1]), "{list}");
    run_in(at, "undo p.petro").done();
    assert!(!run_in(at, "horizon list p.petro").done().stdout.contains("Slice"), "one step");
    run_in(at, "horizon stack p.petro Part --count 4 --between Alpha Bravo --spacing proportional").done();
    run_in(at, "export p.petro part.csv --horizon 'Part 2' --values seismic").done();
    assert!(column(at, "part.csv", "seismic").len() > 1000);
    run_in(at, "undo p.petro").done();
    run_in(at, "horizon stack p.petro Part --count 4 --between Bravo Alpha --spacing proportional")
        .failed(&["nothing lies below \"Bravo\"", "upper horizon first"]);
    run_in(at, "horizon stack p.petro Part --count 4 --spacing proportional").failed(&["--between"]);
    run_in(at, "horizon stack p.petro Part --count 1025").failed(&["from 1 to"]);
    // k by geologic time is drawn by every renderer that draws an imported one.
    let render = |name: &str| {
        run_in(at, &format!("render p.petro {name}.png --size 200x150 --samples 1 --device cpu")).done();
        run_in(at, &format!("render p.petro {name}.svg --size-cm 6x4 --device cpu")).done();
        [fs::read(at.join(format!("{name}.png"))).unwrap(), fs::read(at.join(format!("{name}.svg"))).unwrap()]
    };
    let computed = render("computed");
    assert!(run_in(at, "parameterize p.petro --by-time --size 8x8x8").done().stdout.contains("by geologic time"));
    let by_time = render("by-time");
    assert!(computed[0] != by_time[0] && computed[1] != by_time[1]);
    run_in(at, "parameterize p.petro --computed --size 8x8x8").done();
    assert_eq!(render("again"), computed);
}

#[test]
fn faults_that_reflections_and_horizons_tell_are_proposed_together_and_once() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let made = run_in(at, "synth s --size 96x80x96 --seed 1 --snr 8 --json").done().json();
    run_in(at, "import s/survey.sgy p.petro").done();
    run_in(at, "extract p.petro").done();
    // The proposals that are not minor: how many reflections alone tell, and how many a horizon.
    let proposed = || {
        let told = run_in(at, "fault propose p.petro --json").done().json();
        let all = told["proposals"].as_array().unwrap().clone();
        let is_large = |proposal: &&serde_json::Value| proposal["is_minor"] == false;
        let (reflections, horizons): (Vec<_>, Vec<_>) =
            all.iter().filter(is_large).partition(|proposal| proposal["horizons"].as_array().unwrap().is_empty());
        [reflections.len(), horizons.len()]
    };
    assert_eq!(proposed(), [3, 0], "the survey has three faults");
    add_horizon(at, &made["horizons"], "Alpha");
    assert_eq!(proposed(), [1, 2], "the one that dies out hardly offsets Alpha; the others are not proposed twice");
}
