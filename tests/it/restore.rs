//! Back in time: `restore` makes a project of what is left, says what it measured, and refuses what cannot be restored.

use crate::program::run_in;
use std::fs;
use std::path::Path;

/// A layer cake of limestone and shale on granite that was tilted by 5° and cut by a fault of 150 m.
fn write(at: &Path) {
    let text = "size = [4000, 3000, 1500]\n[[events]]\nkind = \"beds\"\n\
        beds = [ { rock = \"granite\", thickness = 900, name = \"Basement\" },\n\
        { rock = \"limestone\", thickness = 200, name = \"Lime\" },\n\
        { rock = \"shale\", thickness = 400, name = \"Shale\" } ]\n\
        [[events]]\nkind = \"tilt\"\ndip = 5\ndirection = 90\n\
        [[events]]\nkind = \"fault\"\nname = \"F1\"\nstrike = 10\nthrow = 150\n\
        [[events]]\nkind = \"erosion\"\ndepth = 150\n\
        [[events]]\nkind = \"dyke\"\nthickness = 60\nname = \"Dyke\"\nat = [900, 1500, 0]\n";
    fs::write(at.join("b.toml"), text).unwrap();
    run_in(at, "create b.petro --history b.toml").done();
}

/// Depths of a horizon's nodes.
fn depths(at: &Path, project: &str, horizon: &str) -> Vec<f64> {
    run_in(at, &format!("export {project} out.csv --horizon '{horizon}'")).done();
    let text = fs::read_to_string(at.join("out.csv")).unwrap();
    text.lines().skip(1).filter_map(|line| line.split(',').nth(4)?.parse().ok()).collect()
}

#[test]
fn a_tilted_and_faulted_block_becomes_a_layer_cake_again() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    write(at);
    let before = fs::read(at.join("b.petro/project.toml")).unwrap();
    let told = run_in(at, "restore b.petro lime.petro --to 'Top Lime' --depth 300 --json").done().json();
    assert!(fs::read(at.join("b.petro/project.toml")).unwrap() == before, "the project itself is as it was");
    assert_eq!(told["horizons"].to_string(), "[\"Top Lime\",\"Top Basement\"]");
    // 150 m of throw on a plane that dips by 60°.
    let fault = &told["faults"][0];
    let heave = 150.0 / 60f64.to_radians().tan();
    assert!((fault["heave_m"].as_f64().unwrap() / heave - 1.0).abs() < 0.1, "{fault}");
    assert!(fault["left_m"].as_f64().unwrap() < 1.0, "{fault}");
    let lime = told["balance"]["layers"].as_array().unwrap().iter().find(|layer| layer["layer"] == "Lime").unwrap();
    let change = lime["section_m2"]["percent"].as_f64().unwrap();
    assert!(change.abs() < 2.0, "{lime}");
    for (horizon, depth) in [("Top Lime", 300.0), ("Top Basement", 300.0 + 200.0 / 5f64.to_radians().cos())] {
        // The tilt kept thickness across beds, vertical shear keeps what it became along the vertical.
        let most = if horizon == "Top Lime" { 0.5 } else { 3.0 };
        let off = depths(at, "lime.petro", horizon).into_iter().map(|z| (z - depth).abs()).fold(0.0, f64::max);
        assert!(off < most, "{horizon}: {off} m");
    }
    let info = run_in(at, "info lime.petro").done().stdout;
    assert!(info.contains("b restored to Top Lime, level at 300 m. Kinematic: not balanced"), "{info}");
    run_in(at, "render lime.petro lime.svg --inline 40 --device cpu --dpi 60").done();
    assert!(fs::read_to_string(at.join("lime.svg")).unwrap().contains("not balanced"));
    run_in(at, "restore b.petro slope.petro --to 'Top Lime' --regional").done();
    run_in(at, "restore b.petro dips.petro --to 'Top Lime' --dip 5,90").done();
    let deeper = |project: &str| {
        let all = depths(at, project, "Top Lime");
        all.iter().copied().fold(f64::MIN, f64::max) - all.iter().copied().fold(f64::MAX, f64::min)
    };
    // Closing the heave makes the block narrower.
    let dipping = (4000.0 - heave) * 5f64.to_radians().tan();
    assert!((deeper("dips.petro") / dipping - 1.0).abs() < 0.02, "{}", deeper("dips.petro"));
    // A step of 150 m in the middle makes the plane that fits best steeper: by 1.5 of it over the length.
    let fitted = dipping + 1.5 * 150.0;
    assert!((deeper("slope.petro") / fitted - 1.0).abs() < 0.05, "{}", deeper("slope.petro"));
}

#[test]
fn what_cannot_be_restored_is_refused_and_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    write(at);
    for (arguments, told) in [
        ("--to Chalk", "Chalk"),
        ("--to Dyke", "no sheet"),
        ("--to 'Top Lime' --dip 80,90", "dip of 80"),
        ("--to 'Top Lime' --depth 90000", "far outside"),
    ] {
        run_in(at, &format!("restore b.petro out.petro {arguments}")).failed(&[told]);
        assert!(!at.join("out.petro").exists(), "{arguments}");
    }
    let both = run_in(at, "restore b.petro out.petro --to 'Top Lime' --regional --dip 2,90");
    assert_eq!(both.code, 2, "{}", both.stderr);
    let slope = run_in(at, "restore b.petro out.petro --to 'Top Lime' --dip east");
    assert_eq!(slope.code, 2, "{}", slope.stderr);
    run_in(at, "restore none.petro out.petro --to 'Top Lime'").failed(&["no project at none.petro"]);
    run_in(at, "create empty.petro").done();
    run_in(at, "restore empty.petro out.petro --to 'Top Lime'").failed(&["no horizons"]);
    // A project is never written over, nor restored into itself.
    run_in(at, "restore b.petro b.petro --to 'Top Lime'").failed(&["exists already"]);
}
