//! A block diagram without seismic: bounds, horizons from points, plain colours, a picture whose layers can be
//! measured.

use crate::program::run_in;
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// Points of a level horizon over 1000 m by 1000 m.
fn level(path: &Path, depth_m: f64) {
    let mut text = String::from("x,y,depth_m\n");
    for x in 0..=20 {
        for y in 0..=20 {
            writeln!(text, "{},{},{depth_m}", x * 50, y * 50).unwrap();
        }
    }
    fs::write(path, text).unwrap();
}

/// A cube of 1 km with four layers of known colours.
fn layered(at: &Path) {
    run_in(at, "create c.petro --bounds 0,1000,0,1000,0,1000 --size 21x21x41").done();
    // In no particular order: depth decides.
    for (name, depth_m) in [("B", 500.0), ("C", 800.0), ("A", 300.0)] {
        level(&at.join(format!("{name}.csv")), depth_m);
        run_in(at, &format!("horizon add c.petro {name}.csv --name {name}")).done();
    }
    for (layer, colour) in
        [("'above A'", "#ff0000"), ("'A - B'", "#00ff00"), ("'B - C'", "#0000ff"), ("'below C'", "#ffff00")]
    {
        run_in(at, &format!("layer set c.petro {layer} --pattern plain --colour {colour}")).done();
    }
}

#[test]
fn layers_have_their_colours_and_thicknesses_in_the_picture() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    layered(at);
    let names: Vec<String> = run_in(at, "layer list c.petro --json").done().json()["layers"]
        .as_array()
        .unwrap()
        .iter()
        .map(|layer| layer["name"].as_str().unwrap().to_owned())
        .collect();
    assert_eq!(names, ["above A", "A - B", "B - C", "below C"]);
    let view = "--size 200x200 --azimuth 0 --elevation 0 --exaggeration 1 --outlines off --ground off --samples 1 --device cpu";
    for lookup in ["exact", "packed"] {
        let cut = "--cut-box 1,2,1,2,0,50";
        run_in(at, &format!("render c.petro c.png {view} --lookup {lookup} {cut}")).done();
        let image = image::open(at.join("c.png")).unwrap().to_rgb8();
        let column: Vec<[u8; 3]> = (0..200).map(|y| image.get_pixel(100, y).0).collect();
        let mut runs: Vec<([u8; 3], usize)> = Vec::new();
        for colour in column {
            match runs.last_mut() {
                Some((last, count)) if *last == colour => *count += 1,
                _ => runs.push((colour, 1)),
            }
        }
        // Runs of one or two pixels may be mixtures at a boundary.
        runs.retain(|(_, count)| *count > 2);
        let colours: Vec<[u8; 3]> = runs.iter().map(|(colour, _)| *colour).collect();
        let white = [255; 3];
        assert_eq!(colours, [white, [255, 0, 0], [0, 255, 0], [0, 0, 255], [255, 255, 0], white], "{lookup}");
        let block: usize = runs[1..5].iter().map(|(_, count)| count).sum();
        for (found, share) in runs[1..5].iter().zip([0.3, 0.2, 0.3, 0.2]) {
            let error = found.1 as f64 - share * block as f64;
            assert!(error.abs() <= 2.5, "{lookup}: {runs:?}");
        }
    }
}

#[test]
fn a_project_renders_before_anything_is_assigned() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    run_in(at, "create c.petro --bounds 0,1000,0,1000,0,1000 --size 21x21x21").done();
    run_in(at, "render c.petro c.png --size 80x60").failed(&["nothing to draw"]);
    level(&at.join("A.csv"), 500.0);
    run_in(at, "horizon add c.petro A.csv --name A").done();
    let drawn =
        run_in(at, "render c.petro c.png --size 160x120 --samples 1 --device cpu --dpi 254 --json").done().json();
    assert_eq!(drawn["size_px"], serde_json::json!([160, 120]));
    assert!(drawn["assumptions"].to_string().contains("by default"), "{drawn}");
    let png = fs::read(at.join("c.png")).unwrap();
    let at_phys = png.windows(4).position(|window| window == b"pHYs").expect("a printed size");
    assert_eq!(png[at_phys + 4..at_phys + 8], 10_000u32.to_be_bytes());
    let image = image::open(at.join("c.png")).unwrap().to_rgb8();
    let colours: std::collections::HashSet<[u8; 3]> = image.pixels().map(|pixel| pixel.0).collect();
    assert!(colours.len() > 30, "a pattern has many tones, found {}", colours.len());
}

#[test]
fn names_styles_and_contacts_survive_what_happens_to_horizons() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    layered(at);
    run_in(at, "layer set c.petro 'A - B' --name Chalk").done();
    run_in(at, "horizon rename c.petro B Base").done();
    run_in(at, "horizon contact c.petro A erosional").done();
    level(&at.join("N.csv"), 400.0);
    run_in(at, "horizon add c.petro N.csv --name N").done();
    let layers = run_in(at, "layer list c.petro --json").done().json();
    let listed: Vec<(String, String)> = layers["layers"]
        .as_array()
        .unwrap()
        .iter()
        .map(|l| (l["name"].as_str().unwrap().into(), l["style"]["colour"].as_str().unwrap().into()))
        .collect();
    assert_eq!(listed[0], ("above A".into(), "#ff0000".into()));
    assert_eq!(listed[1].0, "A - N");
    assert_eq!(listed[2], ("Chalk".into(), "#00ff00".into()));
    assert_eq!(listed[3], ("Base - C".into(), "#0000ff".into()));
    let horizons = run_in(at, "horizon list c.petro --json").done().json();
    assert_eq!(horizons["horizons"][0]["contact"], "erosional");
}

/// A horizon by inline and crossline alone has its place where the survey's lines are stated.
#[test]
fn lines_that_are_stated_place_a_horizon_without_coordinates() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let rows = (0..=10).flat_map(|i| (0..=3).map(move |x| (1000 + i, 240 - 10 * x)));
    let text: String = rows.map(|(inline, crossline)| format!("{inline},{crossline},{}\n", inline - 500)).collect();
    fs::write(at.join("H.csv"), format!("inline,crossline,depth_m\n{text}")).unwrap();
    run_in(at, "create p.petro --bounds 0,100,0,300,0,1000 --size 11x4x41").done();
    run_in(at, "horizon add p.petro H.csv --name H").failed(&["the survey's are 1 to 11, 1 to 4"]);
    let lines = "--inlines 1000,1010 --crosslines 240,210,-10";
    let refused = run_in(at, &format!("create q.petro --bounds 0,100,0,300,0,1000 --size 12x4x41 {lines}"));
    assert!(refused.code == 2 && refused.stderr.contains("are 11 lines, and --size states 12"), "{}", refused.stderr);
    run_in(at, &format!("create q.petro --bounds 0,100,0,300,0,1000 {lines}")).done();
    run_in(at, "horizon add q.petro H.csv --name H").done();
    run_in(at, "export q.petro out.csv --horizon H --format csv").done();
    let out = fs::read_to_string(at.join("out.csv")).unwrap();
    let row = out.lines().find(|line| line.starts_with("1010,210,")).unwrap();
    assert!(row.starts_with("1010,210,100.0000,300.0000,510,"), "{row}");
}
