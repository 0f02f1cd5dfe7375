//! Wells from files to the project and back, and what `info` says of files before they are imported.

use crate::program::{bytes, run_in};
use std::fs;
use std::path::Path;

/// A cube of 1 km with a level horizon at 500 m.
fn cube(at: &Path, unit: &str) {
    run_in(at, &format!("create c.petro --bounds 0,1000,0,1000,0,1000 --size 41x41x101 --z-unit {unit}")).done();
    let mut text = String::from("x,y,z\n");
    for x in 0..=20 {
        for y in 0..=20 {
            text += &format!("{},{},500\n", x * 50, y * 50);
        }
    }
    fs::write(at.join("top.csv"), text).unwrap();
    run_in(at, "horizon add c.petro top.csv --name 'Top Chalk'").done();
}

/// A vertical well to 900 m with two tops and a log.
fn files(at: &Path) {
    fs::write(at.join("A.csv"), "md_m,inc,azi\n0,0,0\n925,0,0\n").unwrap();
    fs::write(at.join("tops.csv"), "surface,md_m,well\nTop chalk,535,A 1\nBase,800,A 1\nTop chalk,1,B 2\n").unwrap();
    let rows: String = (0..=80).map(|n| format!("{} {} -999.25\n", 100 + 10 * n, 30 + n)).collect();
    let las = format!(
        "~V\n VERS. 2.0 :\n WRAP. NO :\n~W\n STRT.M 100 :\n STOP.M 900 :\n STEP.M 10 :\n NULL. -999.25 :\
         \n WELL. A-1 :\n~C\n DEPT.M : depth\n GR.GAPI : gamma\n X.M : nothing\n~A\n{rows}"
    );
    fs::write(at.join("A.las"), las).unwrap();
}

#[test]
fn a_well_that_was_moved_by_hand_is_told_by_its_hash() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    cube(at, "m");
    files(at);
    run_in(at, "well add c.petro A.csv --name A-1 --head 300,400 --kb 25 --tops tops.csv --las A.las").done();
    run_in(at, "check c.petro").done();
    let file = at.join("c.petro/wells/A-1.json");
    let text = fs::read_to_string(&file).unwrap();
    assert!(text.contains("400.0"), "{text}");
    fs::write(&file, text.replacen("400.0", "401.0", 1)).unwrap();
    let run = run_in(at, "check c.petro");
    assert_eq!(run.code, 1, "{}", run.stdout);
    assert!(run.stdout.contains("well \"A-1\"") && run.stdout.contains("import A.csv again"), "{}", run.stdout);
}

#[test]
fn a_well_is_placed_against_the_survey_and_its_horizons() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    cube(at, "m");
    files(at);
    let before = bytes(at);
    run_in(at, "well add c.petro A.csv --name A-1").failed(&["--head"]);
    run_in(at, "well add c.petro none.csv --name A-1 --head 1,2").failed(&["none.csv"]);
    assert_eq!(bytes(at), before, "a failure leaves nothing");
    let add = "well add c.petro A.csv --name A-1 --head 300,400 --kb 25 --tops tops.csv --las A.las";
    let added = run_in(at, &format!("{add} --json")).done().json();
    assert_eq!(added["effect"], "well-added");
    assert_eq!(added["total_depth"]["position"], serde_json::json!([300.0, 400.0, 900.0]));
    assert_eq!(added["total_depth"]["lines"], serde_json::json!([13.0, 17.0]));
    assert_eq!(added["total_depth"]["inside"], true);
    let top = &added["tops"][0];
    assert!((top["below_horizon"].as_f64().unwrap() - 10.0).abs() < 1e-3, "{top}");
    assert!(added["tops"][1]["below_horizon"].is_null());
    assert_eq!(added["tops"].as_array().unwrap().len(), 2, "the other well's top is left out");
    assert_eq!(added["curves"][0]["range"], serde_json::json!([30.0, 110.0]));
    run_in(at, add).failed(&["already has a well"]);
    let shown = run_in(at, "well show c.petro A-1").done().stdout;
    assert!(shown.contains("10.0 m below the horizon") && shown.contains("GR GAPI"), "{shown}");
    let info = run_in(at, "info c.petro --json").done().json();
    assert_eq!(info["wells"], serde_json::json!(["A-1"]));
    run_in(at, "well rename c.petro A-1 '16/1-9'").done();
    assert!(run_in(at, "well list c.petro").done().stdout.contains("16/1-9: 2 stations"));
    run_in(at, "well show c.petro A-1").failed(&["16/1-9"]);
    run_in(at, "well colour c.petro nothing '#00c81e'").failed(&["16/1-9"]);
    run_in(at, "well colour c.petro 16/1-9 '#00c81e'").done();
    let green = |scene: &str| {
        run_in(
            at,
            &format!("render c.petro w.png --inline 13 --section-blend 0 --annotate wells --size 600x400 {scene}"),
        )
        .done();
        let picture = image::open(at.join("w.png")).unwrap().to_rgb8();
        picture.pixels().filter(|pixel| u16::from(pixel.0[1]) > 2 * u16::from(pixel.0[0].max(pixel.0[2]))).count()
    };
    assert!(green("") > 200, "its path has its colour on a section");
    assert_eq!(green("--preset greyscale"), 0);
    run_in(at, "undo c.petro").done();
    run_in(at, "well remove c.petro 16/1-9").done();
    assert!(run_in(at, "well list c.petro").done().stdout.contains("no wells"));
    run_in(at, "undo c.petro").done();
    run_in(at, "undo c.petro").done();
    run_in(at, "well show c.petro A-1").done();
    run_in(at, "undo c.petro").done();
    run_in(at, "redo c.petro").done();
    run_in(at, "well show c.petro A-1").done();
}

#[test]
fn a_well_in_a_time_survey_says_how_depths_became_times() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    cube(at, "ms");
    files(at);
    fs::write(at.join("c.csv"), "tvdss_m,twt_ms\n0,0\n1000,800\n").unwrap();
    let add = "well add c.petro A.csv --head 300,400 --kb 25 --tops tops.csv";
    let plain = run_in(at, &format!("{add} --name A-1")).done().stdout;
    assert!(plain.contains("constant 2000 m/s") && plain.contains("10.0 ms below the horizon"), "{plain}");
    let shot = run_in(at, &format!("{add} --name 'A 1' --checkshot c.csv")).done().stdout;
    // 510 m are 408 ms.
    assert!(shot.contains("checkshots") && shot.contains("92.0 ms above the horizon"), "{shot}");
}

#[test]
fn info_describes_interpretation_and_well_files() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    cube(at, "m");
    files(at);
    let info = run_in(at, "info top.csv --json").done().json();
    assert_eq!(info["format"]["value"], "csv");
    assert_eq!(info["surfaces"][0]["values"], 441);
    assert_eq!(info["surfaces"][0]["x"], serde_json::json!([0.0, 1000.0]));
    let text = run_in(at, "info top.csv").done().stdout;
    assert!(text.contains("histogram") && text.contains("map, north up") && text.contains("--z-unit"), "{text}");
    for (file, word) in [("A.csv", "deviation"), ("tops.csv", "tops"), ("A.las", "las")] {
        let info = run_in(at, &format!("info {file} --json")).done().json();
        assert_eq!(info["kind"], word, "{info}");
    }
    assert!(run_in(at, "info A.las").done().stdout.contains("GR (GAPI): 81 values, 30 to 110; gamma"));
    fs::write(at.join("noise.txt"), "hello\n").unwrap();
    run_in(at, "info noise.txt").failed(&["not recognised"]);
    fs::write(at.join("array.npy"), b"\x93NUMPY\x01\x00v\x00{'descr': '<i2'}").unwrap();
    run_in(at, "info array.npy").failed(&["NumPy"]);
}

#[test]
fn horizons_are_written_in_every_format_and_read_back() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    cube(at, "m");
    for format in ["csv", "irap", "zmap", "cps3", "tsurf", "opendtect"] {
        let done =
            run_in(at, &format!("export c.petro out.{format} --horizon 'Top Chalk' --format {format} --json")).done();
        assert_eq!(done.json()["nodes"], 441, "{format}");
        run_in(at, "create d.petro --bounds 0,1000,0,1000,0,1000 --size 41x41x101").done();
        run_in(at, &format!("horizon add d.petro out.{format} --name A")).done();
        let shown = run_in(at, "horizon show d.petro A --json").done().json();
        assert_eq!(shown["sheets"][0]["range"], serde_json::json!([500.0, 500.0]), "{format}");
        fs::remove_dir_all(at.join("d.petro")).unwrap();
    }
    run_in(at, "export c.petro out.pmd --horizon 'Top Chalk'").failed(&[
        "cannot be written",
        "formats that can",
        "zmap",
    ]);
}
