//! The whole way: survey, interpretation, styles, parameterization, picture; and back by undo.

use crate::program::{HORIZONS, bytes, project, run_in, survey};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use store::{StoredParameterization, write_parameterization};
use survey::Progress;

fn names(list: &Value) -> Vec<&str> {
    list.as_array().unwrap().iter().map(|name| name.as_str().unwrap()).collect()
}

#[test]
fn info_of_a_volume_has_what_is_promised() {
    let folder = survey();
    let info = run_in(folder.path(), "info s/survey.sgy --json").done().json();
    for axis in ["inlines", "crosslines"] {
        for field in ["first", "last", "step", "count"] {
            assert!(info[axis][field].is_i64(), "{axis}.{field}: {info}");
        }
    }
    for field in ["samples", "interval", "traces", "missing_traces", "bytes"] {
        assert!(info[field].is_number(), "{field}: {info}");
    }
    for field in ["vertical_unit", "sample_format"] {
        assert!(info[field].is_string(), "{field}: {info}");
    }
    for field in ["origin", "inline_vector", "crossline_vector"] {
        assert_eq!(info["geometry"][field].as_array().unwrap().len(), 2, "{field}: {info}");
    }
    assert_eq!((info["inlines"]["count"].as_u64(), info["samples"].as_u64()), (Some(48), Some(56)));
    assert_eq!(info["vertical_unit"], "m");
}

#[test]
fn a_project_knows_what_it_holds() {
    let folder = project();
    let info = run_in(folder.path(), "info p.petro --json").done().json();
    assert_eq!(names(&info["volumes"]), ["seismic", "impedance"]);
    assert_eq!(names(&info["horizons"]), HORIZONS.map(|(name, _)| name));
    assert_eq!(names(&info["faults"]).len(), 3);
    assert_eq!(names(&info["layers"]).len(), 6);
    assert_eq!(info["inlines"]["count"], 48);
    assert_eq!(info["history"].as_array().unwrap().len(), 11);
    let text = run_in(folder.path(), "info p.petro").done().stdout;
    assert!(text.contains("Unconformity") && text.contains("last change"), "{text}");
    let volumes = run_in(folder.path(), "volume list p.petro --json").done().json();
    assert!(volumes["volumes"][1]["geometry"].is_object(), "the attribute has a lattice of its own: {volumes}");
    assert_eq!(volumes["volumes"][0]["polarity"], "normal");
    // Two depths at one trace across the reverse fault survive the way through the file.
    let charlie = run_in(folder.path(), "horizon show p.petro Charlie --json").done().json();
    assert!(charlie["sheets"].as_array().unwrap().len() > 1, "{charlie}");
}

/// The text of `project.toml`.
fn state(at: &Path) -> String {
    fs::read_to_string(at.join("p.petro/project.toml")).unwrap()
}

#[test]
fn undo_and_redo_restore_the_project_and_its_data() {
    let folder = project();
    let at = folder.path();
    let data = |name: &str| run_in(at, &format!("horizon show p.petro {name} --json")).done().stdout;
    let bravo = data("Bravo");
    let mut states = vec![state(at)];
    for change in [
        "horizon remove p.petro Bravo",
        "horizon add p.petro s/horizons/Bravo.csv --name Bravo",
        "layer set p.petro 'above Alpha' --name Cover --pattern shale --frequency 20,2",
        "layer set p.petro Cover --rock 'oolitic limestone' --age Campanian",
        "horizon rename p.petro Bravo B",
        "volume remove p.petro impedance",
        "fault remove p.petro 'Dying fault'",
        "scalar set p.petro seismic --interval 1,inf,sand,0.5",
        "raw p.petro --map grey",
        "scene add p.petro front --azimuth 10 --cut nearest",
        "velocity p.petro 2500",
        "volume rename p.petro seismic Stack",
        "scene rename p.petro front Front",
    ] {
        run_in(at, change).done();
        states.push(state(at));
    }
    for before in states.iter().rev().skip(1) {
        run_in(at, "undo p.petro").done();
        assert_eq!(&state(at), before);
    }
    assert_eq!(data("Bravo"), bravo);
    for after in &states[1..] {
        run_in(at, "redo p.petro").done();
        assert_eq!(&state(at), after);
    }
    run_in(at, "redo p.petro").failed(&["nothing to redo"]);
    // Forgetting the history frees what only it referred to, and nothing else.
    let folders = || fs::read_dir(at.join("p.petro/horizons")).unwrap().count();
    assert_eq!(folders(), 6, "the removed generation of Bravo is kept for undo");
    run_in(at, "prune p.petro").done();
    assert_eq!(folders(), 5);
    run_in(at, "undo p.petro").failed(&["nothing to undo"]);
    assert_eq!(&state(at), states.last().unwrap());
    run_in(at, "horizon show p.petro B").done();
}

/// What shows a volume shows it under its new name.
#[test]
fn a_volume_is_renamed_wherever_it_is_shown() {
    let folder = project();
    let at = folder.path();
    for line in ["scalar set p.petro impedance --interval 1,inf,sand,0.5", "raw p.petro --volume impedance"] {
        run_in(at, line).done();
    }
    run_in(at, "volume rename p.petro impedance seismic").failed(&["seismic"]);
    run_in(at, "volume rename p.petro nothing Z").failed(&["it has: seismic, impedance"]);
    run_in(at, "volume rename p.petro impedance Z").done();
    let text = fs::read_to_string(at.join("p.petro/project.toml")).unwrap();
    let state: toml::Value = toml::from_str(&text).unwrap();
    let named = |value: &toml::Value| value.to_string().matches("\"Z\"").count();
    // Its name stands in one place; what shows it refers to its id.
    assert_eq!((named(&state["volumes"]), named(&state["style"])), (1, 0), "{text}");
    assert_eq!(state["style"]["raw"]["volume"], state["volumes"][1]["id"], "{text}");
    run_in(at, "render p.petro a.png --size 60x40 --samples 1 --blend 0.5").done();
    run_in(at, "export p.petro z.sgy --volume Z").done();
}

#[test]
fn a_fault_is_written_and_read_back_as_the_same_triangles() {
    let folder = project();
    let at = folder.path();
    let told = run_in(at, "export p.petro dying.ts --fault 'Dying fault' --json").done().json();
    assert_eq!(told["fault"], "Dying fault", "{told}");
    run_in(at, "fault add p.petro dying.ts --name again").done();
    let state: toml::Value = toml::from_str(&fs::read_to_string(at.join("p.petro/project.toml")).unwrap()).unwrap();
    let hash = |name: &str| {
        let faults = state["faults"].as_array().unwrap();
        faults.iter().find(|fault| fault["name"].as_str() == Some(name)).unwrap()["hash"].clone()
    };
    assert_eq!(hash("again"), hash("Dying fault"));
    run_in(at, "export p.petro x.ts --fault Other").failed(&["Other"]);
    run_in(at, "export p.petro x.irap --fault 'Dying fault'").failed(&["cannot be written", "tsurf"]);
    assert!(!at.join("x.ts").exists() && !at.join("x.irap").exists());
}

#[test]
fn parameterizing_is_done_once_and_again_when_something_changed() {
    let folder = project();
    let at = folder.path();
    let go = || run_in(at, "parameterize p.petro --size 24x20x28 --json").done().json();
    let first = go();
    assert_eq!((first["layers"].as_u64(), first["computed"].as_bool()), (Some(6), Some(true)));
    assert!(first["blocks"].as_u64().unwrap() >= 4, "{first}");
    let zarr = at.join("p.petro/derived/parameterization.zarr");
    for array in ["i", "j", "k", "layer", "block"] {
        assert!(zarr.join(array).join("zarr.json").exists(), "{array}");
    }
    let second = go();
    assert_eq!(second["computed"], false);
    assert!(!second["stages"].to_string().contains("parameterization"), "{second}");
    assert_eq!(second["key"], first["key"]);
    // A name changes nothing that is computed, a removed fault does, and undo finds the former result again.
    run_in(at, "horizon rename p.petro Alpha A").done();
    assert_eq!(go()["computed"], false);
    run_in(at, "fault remove p.petro 'Dying fault'").done();
    let fewer = go();
    assert_eq!(fewer["computed"], true);
    assert_ne!(fewer["key"], first["key"]);
    run_in(at, "undo p.petro").done();
    let back = go();
    assert!(!back["stages"].to_string().contains("parameterization"), "{back}");
    // Everything derived may be deleted.
    fs::remove_dir_all(at.join("p.petro/derived")).unwrap();
    assert_eq!(go()["computed"], true);
}

/// All files of a folder, by their paths in it.
fn within(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let files = bytes(folder).into_iter();
    files.map(|(path, content)| (path.strip_prefix(folder).unwrap().to_owned(), content)).collect()
}

#[test]
fn i_j_k_are_the_same_bytes_in_any_stated_memory() {
    let folder = project();
    let at = folder.path();
    let zarr = at.join("p.petro/derived/parameterization.zarr");
    let sampled = |options: &str| {
        let _ = fs::remove_dir_all(&zarr);
        run_in(at, &format!("parameterize p.petro --size 150x131x257 {options}")).done();
        within(&zarr)
    };
    let whole = sampled("");
    assert_eq!(whole.keys().filter(|file| file.starts_with("k/c")).count(), 2 * 2 * 3);
    assert!(sampled("--memory 64M") == whole);
    assert!(sampled("--memory 1G") == whole);
    // And they are those that are written in one piece.
    let stored = StoredParameterization::open(&zarr).unwrap();
    let volumes = stored.read(&Progress::silent()).unwrap();
    write_parameterization(&at.join("whole.zarr"), &volumes, stored.key(), &Progress::silent()).unwrap();
    assert!(within(&at.join("whole.zarr")) == whole);
    // Less than a file takes is refused, before anything changes.
    let before = state(at);
    run_in(at, "parameterize p.petro --size 150x131x257 --memory 63M --computed").failed(&["64M", "too few"]);
    assert_eq!(state(at), before);
    assert!(within(&zarr) == whole);
}

#[test]
fn pictures_are_illustrative_raw_and_between() {
    let folder = project();
    let at = folder.path();
    let view = "--size 240x180 --samples 1 --outlines off --device cpu --cut nearest,0.5,0.5";
    let draw = |options: &str| {
        run_in(at, &format!("render p.petro a.png {view} {options}")).done();
        image::open(at.join("a.png")).unwrap().to_rgb8()
    };
    let before = state(at);
    let (rock, raw, half) = (draw("--blend 0"), draw("--blend 1"), draw("--blend 0.5"));
    assert!(rock != raw);
    // Half-way is the mean of both, on encoded values, wherever both show the block.
    let mut worst = 0;
    for ((r, s), h) in rock.pixels().zip(raw.pixels()).zip(half.pixels()) {
        for channel in 0..3 {
            let mean = (i32::from(r.0[channel]) + i32::from(s.0[channel])) / 2;
            worst = worst.max((mean - i32::from(h.0[channel])).abs());
        }
    }
    assert!(worst <= 2, "half-way differs by {worst}");
    assert_eq!(state(at), before, "drawing changes no project");
    // A scalar function shows where its values lie.
    run_in(at, "scalar set p.petro impedance --interval -inf,inf,coal,1").done();
    assert!(draw("--blend 0") != rock);
}

#[test]
fn a_volume_alone_is_drawn_as_raw_faces() {
    let folder = survey();
    let at = folder.path();
    run_in(at, "import s/survey.sgy p.petro").done();
    let draw = |name: &str| {
        run_in(at, &format!("render p.petro {name}.png --size 160x120 --samples 1 --device cpu")).done();
        image::open(at.join(format!("{name}.png"))).unwrap().to_rgb8()
    };
    let colourful = draw("colour");
    run_in(at, "raw p.petro --map grey").done();
    let grey = draw("grey");
    let spread = |image: &image::RgbImage| image.pixels().filter(|p| p.0[0].abs_diff(p.0[2]) > 40).count();
    assert!(spread(&colourful) > 500, "seismic colours have reds and blues");
    assert_eq!(spread(&grey), 0);
}

#[test]
fn scenes_are_kept_shown_and_drawn() {
    let folder = project();
    let at = folder.path();
    run_in(at, "scene add p.petro front --size 120x90 --samples 1 --azimuth 20 --exaggeration 2").done();
    let shown = run_in(at, "scene show p.petro front").done().stdout;
    assert!(shown.contains("exaggeration = 2.0"), "{shown}");
    fs::write(at.join("front.toml"), &shown).unwrap();
    for scene in ["front", "front.toml"] {
        run_in(at, &format!("render p.petro {scene}.png --scene {scene} --device cpu")).done();
    }
    assert!(fs::read(at.join("front.png")).unwrap() == fs::read(at.join("front.toml.png")).unwrap());
    run_in(at, "scene add p.petro copy --from front.toml --azimuth 40").done();
    assert_eq!(names(&run_in(at, "scene list p.petro --json").done().json()["scenes"]), ["front", "copy"]);
    // What names it follows.
    run_in(at, "note add p.petro Here --at 110,510,100 --scene copy").done();
    run_in(at, "scene rename p.petro copy front").failed(&["front"]);
    run_in(at, "scene rename p.petro nothing x").failed(&["it has: front, copy"]);
    run_in(at, "scene rename p.petro copy 'Seen from afar'").done();
    let state: toml::Value = toml::from_str(&fs::read_to_string(at.join("p.petro/project.toml")).unwrap()).unwrap();
    assert_eq!(state["notes"][0]["scene"], state["scenes"][1]["id"]);
    run_in(at, "render p.petro afar.png --scene 'Seen from afar' --size 60x40 --samples 1").done();
    run_in(at, "scene remove p.petro front").done();
    run_in(at, "scene show p.petro front").failed(&["no scene named"]);
}

#[test]
fn an_exported_horizon_comes_back() {
    let folder = project();
    let at = folder.path();
    run_in(at, "export p.petro out.csv --horizon Alpha").done();
    run_in(at, "horizon remove p.petro Alpha").done();
    run_in(at, "horizon add p.petro out.csv --name Alpha").done();
    let sheets = run_in(at, "horizon show p.petro Alpha --json").done().json()["sheets"].clone();
    run_in(at, "undo p.petro").done();
    run_in(at, "undo p.petro").done();
    assert_eq!(run_in(at, "horizon show p.petro Alpha --json").done().json()["sheets"], sheets);
}

#[test]
fn tiles_of_ones_own() {
    let folder = project();
    let at = folder.path();
    let tile = image::RgbImage::from_fn(8, 8, |x, _| image::Rgb(if x < 4 { [200, 30, 30] } else { [250, 250, 250] }));
    tile.save(at.join("stripes.png")).unwrap();
    run_in(at, "texture p.petro stripes.png --width-mm 6").done();
    run_in(at, "layer set p.petro 'above Alpha' --pattern stripes").done();
    fs::remove_file(at.join("stripes.png")).unwrap();
    run_in(at, "render p.petro a.png --size 120x90 --samples 1 --ground off --device cpu").done();
    let red = image::open(at.join("a.png")).unwrap().to_rgb8();
    let red = red.pixels().filter(|p| p.0[0] > 150 && p.0[1] < 90 && p.0[2] < 90).count();
    assert!(red > 20, "{red} red pixels");
    let before = bytes(&at.join("p.petro/textures"));
    assert_eq!(before.len(), 1);
}

#[test]
fn a_layer_gets_the_pattern_of_its_rock_and_the_colour_of_its_age() {
    let folder = project();
    let at = folder.path();
    let listed = |options: &str| {
        run_in(at, &format!("layer set p.petro 'above Alpha' {options}")).done();
        run_in(at, "layer list p.petro").done().stdout
    };
    assert!(listed("--rock 'oolitic limestone'").contains("limestone-oolitic"));
    // A monzogranite has no pattern of its own; a granite has.
    assert!(listed("--rock monzogranite --age 'Late Cretaceous'").contains("granite"));
    let project = fs::read_to_string(at.join("p.petro/project.toml")).unwrap();
    assert!(project.contains("#a6d84a"), "the colour of the Upper Cretaceous");
}
