//! Horizons where there is no candidate: lines drawn by hand and reflections tracked from one place, without an
//! extraction.

use crate::assembly::place_on;
use crate::program::run_in;
use serde_json::Value;
use std::path::Path;

fn nodes(answer: &Value) -> u64 {
    answer["result"]["nodes"].as_u64().unwrap()
}

/// Depths of an exported horizon by inline and crossline.
fn depths(at: &Path, name: &str) -> Vec<[f64; 3]> {
    run_in(at, &format!("export p.petro {name}.csv --horizon {name} --format csv")).done();
    let text = std::fs::read_to_string(at.join(format!("{name}.csv"))).unwrap();
    let header: Vec<&str> = text.lines().next().unwrap().split(',').map(str::trim).collect();
    let column = |wanted: &str| header.iter().position(|name| name.starts_with(wanted)).unwrap();
    let columns = [column("inline"), column("crossline"), column("depth")];
    let rows = text.lines().skip(1).map(|line| {
        let values: Vec<f64> = line.split(',').map(|value| value.trim().parse().unwrap_or(f64::NAN)).collect();
        columns.map(|column| values[column])
    });
    rows.collect()
}

#[test]
fn a_horizon_is_tracked_and_drawn_without_candidates() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    run_in(at, "synth s --size 72x64x80 --seed 3 --snr 12").done();
    run_in(at, "import s/survey.sgy p.petro").done();
    let place = place_on(at, "Bravo");
    let tracked = run_in(at, &format!("horizon track p.petro Top --at {place} --json")).done().json();
    assert!(nodes(&tracked) > 800, "{tracked}");
    let small = run_in(at, &format!("horizon track p.petro Small --at {place} --traces 3 --json")).done().json();
    assert!((2..=49).contains(&nodes(&small)), "{small}");

    // By hand: as drawn, or on the reflection.
    let [inline, crossline, z]: [f64; 3] =
        place.split(',').map(|number| number.parse().unwrap()).collect::<Vec<_>>().try_into().unwrap();
    let line =
        |off: f64| format!("--line {inline},{},{} {inline},{},{}", crossline - 8.0, z + off, crossline + 8.0, z + off);
    let drawn = run_in(at, &format!("horizon draw p.petro Hand {} --json", line(3.0))).done().json();
    assert!(nodes(&drawn) >= 5, "{drawn}");
    assert!(depths(at, "Hand").iter().all(|row| row[0] == inline && (row[2] - z - 3.0).abs() < 0.01));
    run_in(at, &format!("horizon draw p.petro Snapped {} --snap", line(3.0))).done();
    let on = depths(at, "Snapped");
    assert!(on.iter().any(|row| (row[2] - z - 3.0).abs() > 0.5), "{on:?}");

    // The log, undo, and taking a part out again.
    let more = run_in(at, &format!("horizon draw p.petro Small {} --json", line(0.0))).done().json();
    assert!(nodes(&more) > nodes(&small), "{more}");
    let text = run_in(at, "horizon show p.petro Small").done().stdout;
    assert!(text.contains("2 parts drawn or tracked") && text.contains("tracking from"), "{text}");
    run_in(at, "undo p.petro").done();
    let text = run_in(at, "horizon show p.petro Small").done().stdout;
    assert!(text.contains("1 part drawn or tracked") && !text.contains("line from"), "{text}");
    run_in(at, "redo p.petro").done();
    let id = more["pick"].as_u64().unwrap();
    run_in(at, &format!("horizon unpick p.petro {id}")).done();
    run_in(at, &format!("climb p.petro {}", small["pick"])).failed(&["drawn or tracked", "unpick"]);

    // Replaying, a fault, another extraction: what was drawn is made again.
    run_in(at, "horizon replay p.petro Small").done();
    let lines = |a: f64, b: f64| format!("{},{a},100 {},{b},500", inline + 6.0, inline + 6.0);
    let fault = format!("fault pick p.petro --name F --stick {} --stick {}", lines(501.0, 501.0), lines(560.0, 560.0));
    run_in(at, &fault).done();
    let cut = run_in(at, "horizon fill p.petro Top --json").done().json();
    assert!(nodes(&cut) < nodes(&tracked), "tracking ends at the fault: {cut}");
    run_in(at, "extract p.petro").done();
    let other = place_on(at, "Alpha");
    run_in(at, &format!("pick p.petro --at {other} --horizon Hand")).done();
    let text = run_in(at, "horizon show p.petro Hand").done().stdout;
    assert!(text.contains("1 pick, 1 part drawn or tracked"), "{text}");
    run_in(at, "check p.petro").done();
}

#[test]
fn what_cannot_be_drawn_or_tracked_says_why() {
    let folder = crate::program::survey();
    let at = folder.path();
    run_in(at, "import s/survey.sgy p.petro").done();
    run_in(at, "horizon draw p.petro A --line 110,520,300").failed(&["at least two points", "--line"]);
    run_in(at, "horizon draw p.petro A --line 90,520,300 110,520,300").failed(&["outside the survey"]);
    assert_eq!(run_in(at, "horizon draw p.petro A --line 110,520 110,530").code, 2);
    run_in(at, "horizon track p.petro A --at 110,520,99999").failed(&["outside the survey"]);
    run_in(at, "horizon track p.petro A --at 110,520,1").failed(&["no reflection goes on", "horizon draw"]);
    assert!(run_in(at, "horizon list p.petro").done().stdout.lines().all(|line| !line.starts_with("A")));
}
