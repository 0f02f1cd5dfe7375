//! A block from its geological history: what `create --history` writes, what `info` lists, what is refused.

use crate::program::run_in;
use std::fs;
use std::path::Path;

/// The example of docs/history.md with a fault and an erosion, and a rock of this name.
fn write(at: &Path, rock: &str) {
    let text = format!(
        "title = \"Horst\"\nsize = [4000, 3000, 1500]\n[[events]]\nkind = \"beds\"\n\
         beds = [ {{ rock = \"granite\", thickness = 900, name = \"Basement\" }},\n\
         {{ rock = \"{rock}\", thickness = 200, name = \"Lime\" }},\n\
         {{ rock = \"shale\", thickness = 400, name = \"Shale\" }} ]\n\
         [[events]]\nkind = \"fault\"\nname = \"F1\"\nat = [2000, 1500, 0]\nstrike = 10\nslip = 200\n\
         [[events]]\nkind = \"erosion\"\ndepth = 100\n"
    );
    fs::write(at.join("horst.toml"), text).unwrap();
}

#[test]
fn a_history_becomes_an_ordinary_project() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    write(at, "limestone");
    run_in(at, "create horst.petro --history horst.toml").done();
    let info = run_in(at, "info horst.petro --json").done().json();
    let names = |key: &str| -> Vec<&str> {
        let list = info[key].as_array().unwrap_or_else(|| panic!("no {key}: {info}"));
        list.iter().filter_map(|name| name.as_str()).collect()
    };
    assert!(names("horizons").contains(&"Top Lime"), "{info}");
    assert_eq!(names("faults"), ["F1"]);
    assert!(info["geological_history"].as_str().unwrap().contains("kind = \"fault\""));
    // The top of the limestone lies at 400 m, and deeper by the throw in the hanging wall.
    run_in(at, "export horst.petro lime.csv --horizon 'Top Lime'").done();
    let text = fs::read_to_string(at.join("lime.csv")).unwrap();
    // inline, crossline, x, y, depth in m.
    let depths = text.lines().skip(1).filter_map(|line| line.split(',').nth(4)?.parse::<f64>().ok());
    let deepest = depths.fold(f64::NEG_INFINITY, f64::max);
    let throw = 200.0 * 60f64.to_radians().sin();
    assert!(((deepest - 400.0) / throw - 1.0).abs() < 5e-3, "{deepest}");
    run_in(at, "render horst.petro horst.png --size 160x120 --device cpu").done();
    assert!(at.join("horst.png").is_file());
}

#[test]
fn what_is_wrong_is_told_with_its_line_and_nothing_is_left() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    write(at, "limestne");
    run_in(at, "create horst.petro --history horst.toml").failed(&["horst.toml", "line 6", "limestone"]);
    assert!(!at.join("horst.petro").exists());
}
