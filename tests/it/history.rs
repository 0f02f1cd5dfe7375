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

#[test]
fn a_history_is_drawn_stage_by_stage_on_one_page() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    write(at, "limestone");
    run_in(at, "create horst.petro --history horst.toml").done();
    // Rocks have the look that they have in the finished block.
    run_in(at, "layer set horst.petro Lime --colour '#12ab34' --pattern plain").done();
    let small = "--size-cm 12x12 --dpi 50 --device cpu";
    let told = run_in(at, &format!("history horst.petro all.svg {small} --json")).done().json();
    assert_eq!(told["stages"].to_string(), "[1.0,2.0,3.0]");
    let captions = ["Deposition of Lime, Shale on Basement", "Normal fault F1, throw 173 m", "Erosion to 100 m"];
    let page = fs::read_to_string(at.join("all.svg")).unwrap();
    for (n, caption) in captions.iter().enumerate() {
        assert_eq!(told["captions"][n].as_str(), Some(*caption));
        assert!(page.contains(&format!("id=\"panel-{}\"", char::from(b'a' + n as u8))), "panel {n}");
    }
    assert!(page.matches("#12ab34").count() >= 4, "three panels and the legend");
    let told = run_in(at, &format!("history horst.petro half.png --stages 1.5 --title '' {small}")).done();
    assert!(told.stdout.contains("a  Normal fault F1, throw 173 m (50 % of it)"), "{}", told.stdout);
    run_in(at, "history horst.petro x.png --stages 1,4").failed(&["no stage 4", "3 events"]);
    run_in(at, "history horst.petro x.png --stages 0").failed(&["no stage 0"]);
    let twice = run_in(at, "history horst.petro x.png --stages 2,1,2");
    assert!(twice.code == 2 && twice.stderr.contains("2 is named twice"), "{}", twice.stderr);
    run_in(at, "create empty.petro").done();
    run_in(at, "history empty.petro x.png")
        .failed(&["not made from a geological history", "create BLOCK.petro --history"]);
    assert!(!at.join("x.png").exists());
}

#[test]
fn an_animation_goes_through_a_history_and_holds_at_its_end() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    write(at, "limestone");
    run_in(at, "create horst.petro --history horst.toml").done();
    let small = "--size 80x60 --samples 1 --device cpu";
    run_in(at, &format!("animate horst.petro frames --motion history --frames 5 --rate 1 {small}")).done();
    let frame = |n: usize| image::open(at.join(format!("frames/{n:04}.png"))).unwrap().to_rgba8();
    assert!((1..4).all(|n| frame(n) != frame(n + 1)) && frame(4) == frame(5));
    run_in(at, &format!("render horst.petro still.png {small}")).done();
    assert!(frame(5) == image::open(at.join("still.png")).unwrap().to_rgba8());
}
