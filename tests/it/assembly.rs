//! From a raw volume to horizons by picks: candidates, picking, climbing, taking back, holes, faults.

use crate::program::{bytes, run_in, survey};
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::OnceLock;
use tempfile::TempDir;

/// A clean synthetic survey `s`, imported into `p.petro` with its candidates; made once.
fn extracted() -> &'static Path {
    static FOLDER: OnceLock<TempDir> = OnceLock::new();
    let folder = FOLDER.get_or_init(|| {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let at = folder.path();
        run_in(at, "synth s --size 72x64x80 --seed 3 --snr 12").done();
        run_in(at, "import s/survey.sgy p.petro").done();
        run_in(at, "extract p.petro").done();
        folder
    });
    folder.path()
}

fn project() -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    crate::program::copy(extracted(), folder.path());
    folder
}

/// A place on a true horizon, as typed: the middle node of the largest sheet in its file.
pub(crate) fn place_on(at: &Path, name: &str) -> String {
    let text = std::fs::read_to_string(at.join(format!("s/horizons/{name}.csv"))).unwrap();
    let header: Vec<&str> = text.lines().next().unwrap().split(',').map(str::trim).collect();
    let column = |wanted: &str| header.iter().position(|name| *name == wanted).unwrap();
    let columns = [column("inline"), column("crossline"), column("depth_m")];
    let rows: Vec<Vec<f64>> = text
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(|value| value.trim().parse().unwrap_or(f64::NAN)).collect())
        .collect();
    // The node nearest to the middle of the survey, between the faults.
    let off = |row: &Vec<f64>| (row[columns[0]] - 125.0).powi(2) + (row[columns[1]] - 532.0).powi(2);
    let row = rows.iter().min_by(|a, b| off(a).total_cmp(&off(b))).unwrap();
    columns.map(|column| row[column].to_string()).join(",")
}

fn pick(at: &Path, rest: &str) -> Value {
    run_in(at, &format!("pick p.petro {rest} --json")).done().json()
}

#[test]
fn damaged_candidates_are_told_with_the_picks_on_them_and_are_extracted_again() {
    let folder = project();
    let at = folder.path();
    pick(at, &format!("--at {} --horizon Top", place_on(at, "Bravo")));
    let check = || run_in(at, "check p.petro --json");
    assert_eq!(check().done().json()["derived_files"].as_u64(), Some(1));
    let file = at.join("p.petro/derived/candidates.zarr/leaf/c/0/0/0");
    let good = std::fs::read(&file).unwrap();
    std::fs::write(&file, &good[..good.len() / 2]).unwrap();
    let found = check();
    assert_eq!(found.code, 1, "{}", found.stdout);
    let damage = &found.json()["damage"][0];
    assert_eq!(damage["file"], "derived/candidates.zarr");
    assert_eq!(damage["dependants"][0], "the picks of horizon \"Top\"");
    let told = run_in(at, "check p.petro --repair").done().stdout;
    assert!(told.contains("removed derived/candidates.zarr"), "{told}");
    let notes = check().done().json()["notes"].to_string();
    assert!(notes.contains("extract them again"), "{notes}");
    run_in(at, "extract p.petro").done();
    assert_eq!(std::fs::read(at.join("p.petro/derived").join(candidates(at)).join("leaf/c/0/0/0")).unwrap(), good);
    run_in(at, "climb p.petro 1").done();
    check().done();
}

/// The name of the only candidates in `derived/`.
fn candidates(at: &Path) -> String {
    let names = std::fs::read_dir(at.join("p.petro/derived")).unwrap();
    let mut names = names.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    names.find(|name| name.starts_with("candidates")).unwrap()
}

#[test]
fn picks_make_a_horizon_that_parameterizes_and_exports() {
    let folder = project();
    let at = folder.path();
    let place = place_on(at, "Bravo");
    let first = pick(at, &format!("--at {place} --horizon Top --colour #336699"));
    assert_eq!((first["pick"].as_u64(), first["up"].as_u64()), (Some(1), Some(0)));
    let nodes = |answer: &Value| answer["result"]["nodes"].as_u64().unwrap();
    let triangles = |answer: &Value| answer["triangles"].as_u64().unwrap();

    // Up and down again, also later; undo and redo between.
    let higher = run_in(at, "climb p.petro 1 --highest-valid --json").done().json();
    assert!(triangles(&higher) >= triangles(&first) && nodes(&higher) >= nodes(&first), "{higher}");
    let levels = higher["levels"].as_u64().unwrap();
    run_in(at, "undo p.petro").done();
    let shown = || run_in(at, "horizon show p.petro Top --json").done().json();
    assert_eq!(shown()["horizon"]["assembly"]["picks"][0]["up"], 0);
    assert_eq!(shown()["horizon"]["assembly"]["colour"], "#336699");
    run_in(at, "redo p.petro").done();
    assert_eq!(shown()["horizon"]["assembly"]["picks"][0]["up"], higher["up"]);
    run_in(at, &format!("climb p.petro 1 --levels {}", levels + 1)).failed(&["levels above it"]);
    let up = higher["up"].as_u64().unwrap();
    run_in(at, &format!("descend p.petro 1 --levels {}", up + 1)).failed(&["cannot descend"]);
    run_in(at, "climb p.petro 9").failed(&["no pick 9", "[1]"]);

    // What is there already, what is not, and taking out again.
    run_in(at, &format!("pick p.petro --at {place} --horizon Top")).failed(&["already"]);
    let other = place_on(at, "Alpha");
    run_in(at, &format!("pick p.petro --at {other} --horizon Top --remove")).failed(&["contains nothing of"]);
    if up > 0 {
        let less = pick(at, &format!("--at {place} --horizon Top --remove"));
        assert!(nodes(&less) < nodes(&higher), "{less}");
        run_in(at, "undo p.petro").done();
    } else {
        run_in(at, &format!("pick p.petro --at {place} --horizon Top --remove")).failed(&["nothing would be left of"]);
    }

    // A second horizon comes into its place by depth; the same node in both is a conflict.
    pick(at, &format!("--at {other} --horizon Cover --highest-valid"));
    let info = run_in(at, "info p.petro --json").done().json();
    assert_eq!(info["horizons"], serde_json::json!(["Cover", "Top"]));
    let twice = pick(at, &format!("--at {place} --horizon Cover"));
    assert_eq!(twice["result"]["conflicts"][0]["conflict"], "shared-leaves", "{twice}");
    run_in(at, "undo p.petro").done();

    // Straight on: no file between.
    let filled = run_in(at, "horizon fill p.petro Top --json").done().json();
    assert_eq!(filled["result"]["holes"]["count"].as_u64(), Some(0), "{filled}");
    run_in(at, "horizon fill p.petro Cover").done();
    let text = run_in(at, "horizon show p.petro Top").done().stdout;
    assert!(text.contains("assembled by 1 pick") && text.contains("#336699"), "{text}");
    // It stays smoothed until that is taken back; holes can be filled along the reflection instead.
    let smoothed = run_in(at, "horizon smooth p.petro Top --radius 2 --passes 2 --json").done().json();
    assert!(smoothed["result"]["smoothed"].as_f64().is_some_and(|most| most > 0.05), "{smoothed}");
    assert_eq!(shown()["horizon"]["assembly"]["smooth"]["radius"], 2);
    run_in(at, "horizon smooth p.petro Top --radius 0").done();
    assert!(shown()["horizon"]["assembly"]["smooth"].is_null());
    assert_eq!(run_in(at, "horizon smooth p.petro Top --radius 51").code, 2);
    let along = run_in(at, "horizon fill p.petro Top --along-reflection --json").done().json();
    let count = |key: &str| along["result"]["filled"][key].as_u64().unwrap();
    assert!(count("along") > 0 && count("along") <= count("nodes"), "{along}");
    assert_eq!(along["result"]["holes"]["count"].as_u64(), Some(0), "{along}");
    run_in(at, "parameterize p.petro --size 24x24x24").done();
    run_in(at, "export p.petro top.csv --horizon Top").done();
    run_in(at, "render p.petro top.png --size 200x150").done();
    let exported = std::fs::read_to_string(at.join("top.csv")).unwrap();
    assert!(exported.lines().count() > 500);
}

#[test]
fn picks_of_another_extraction_are_noticed_and_made_again() {
    let folder = project();
    let at = folder.path();
    let place = place_on(at, "Bravo");
    pick(at, &format!("--at {place} --horizon Top --highest-valid"));
    let other = place_on(at, "Alpha");
    run_in(at, "extract p.petro --max-distance 6").done();
    run_in(at, &format!("pick p.petro --at {other} --horizon Top")).failed(&["extraction has changed", "[1]"]);
    run_in(at, "climb p.petro 1").failed(&["extraction has changed"]);
    // The surfaces are the same; the picks still mean what they meant.
    let again = run_in(at, "horizon replay p.petro --json").done().json();
    assert_eq!(again["picks"][0]["fit"], "same", "{again}");
    run_in(at, &format!("pick p.petro --at {other} --horizon Cover")).done();
    // Zero crossings are elsewhere: nothing fits, nothing is changed.
    run_in(at, "extract p.petro --extrema zero").done();
    let before = bytes(&at.join("p.petro/horizons"));
    // To leave out what does not fit would leave nothing, so the advice is another.
    for replay in ["horizon replay p.petro Top", "horizon replay p.petro --drop-unfit"] {
        run_in(at, replay).failed(&["no pick of horizon", "petroglyph horizon remove"]);
    }
    assert!(before == bytes(&at.join("p.petro/horizons")));
    // What is advised helps.
    run_in(at, "horizon remove p.petro Top").done();
    run_in(at, "extract p.petro").done();
    pick(at, &format!("--at {place} --horizon Top"));
}

#[test]
fn picks_that_cannot_be_made_say_why() {
    let folder = survey();
    let at = folder.path();
    run_in(at, "import s/survey.sgy q.petro").done();
    run_in(at, "pick q.petro --at 110,520,300 --horizon A").failed(&["candidates"]);
    let folder = project();
    let at = folder.path();
    run_in(at, "pick p.petro --at 90,520,300 --horizon A").failed(&["outside the survey", "101 to 172"]);
    run_in(at, "pick p.petro --at 110,520,99999 --horizon A").failed(&["outside the survey"]);
    run_in(at, "evaluate p.petro nowhere").failed(&["truth"]);
    let place = place_on(at, "Bravo");
    run_in(at, &format!("pick p.petro --at {place} --horizon A --up 1000")).failed(&["levels above it"]);
    run_in(at, "horizon add p.petro s/horizons/Alpha.csv --name Alpha").done();
    run_in(at, &format!("pick p.petro --at {place} --horizon Alpha")).failed(&["was imported"]);
    for usage in ["pick p.petro --at 1,2 --horizon A", "pick p.petro --at 1,2,3 --horizon A --up 1 --highest-valid"] {
        assert_eq!(run_in(at, usage).code, 2, "{usage}");
    }
}

#[test]
fn faults_are_drawn_by_sticks_and_proposed_ones_accepted() {
    let folder = project();
    let at = folder.path();
    let drawn = run_in(at, "fault pick p.petro --name F --stick 140,505,100 150,505,700").done().stdout;
    assert!(drawn.contains("one stick"), "{drawn}");
    let drawn = run_in(at, "fault pick p.petro --name F --stick 142,560,100 152,560,700").done().stdout;
    assert!(drawn.contains("2 sticks"), "{drawn}");
    run_in(at, "fault pick p.petro --name F --stick 141,530,100 151,530,700 --stick 143,562,100 153,562,700").done();
    let faults = run_in(at, "fault list p.petro --json").done().json();
    assert_eq!(faults["faults"].as_array().unwrap().len(), 1);
    run_in(at, "fault remove p.petro F").done();
    run_in(at, "fault pick p.petro --name F --stick 140,505,100").failed(&["at least two"]);
    run_in(at, "fault accept p.petro 1 --name F").failed(&["no faults have been proposed"]);
    // Faults are found in the volume without horizons; horizons are named with those that offset them.
    assert!(run_in(at, "fault propose p.petro").done().stdout.contains("match after the throw"));
    run_in(at, "horizon add p.petro s/horizons/Alpha.csv --name Alpha").done();
    run_in(at, "horizon add p.petro s/horizons/Bravo.csv --name Bravo").done();
    let proposed = run_in(at, "fault propose p.petro --json").done().json();
    let found = proposed["proposals"].as_array().unwrap();
    let by_both = found.iter().find(|fault| fault["horizons"].as_array().unwrap().len() == 2);
    let id = &by_both.unwrap_or_else(|| panic!("both horizons tell one fault: {proposed}"))["id"];
    run_in(at, "fault accept p.petro 99 --name F").failed(&["no proposal 99"]);
    run_in(at, &format!("fault accept p.petro {id} --name F")).done();
    let model = run_in(at, "parameterize p.petro --size 16x16x16 --json").done().json();
    assert!(model["blocks"].as_u64() > Some(1), "{model}");
}

/// Two horizons are picked first; a fault that is drawn or accepted afterwards makes both anew, in one command.
#[test]
fn faults_come_after_picks() {
    let folder = project();
    let at = folder.path();
    for name in ["Alpha", "Bravo"] {
        let place = place_on(at, name);
        run_in(at, &format!("pick p.petro --at {place} --horizon {name} --highest-valid")).done();
    }
    let sticks = "--stick 140,505,100 150,505,700 --stick 142,560,100 152,560,700";
    let told = run_in(at, &format!("fault pick p.petro --name Drawn {sticks}")).done().stdout;
    for name in ["Alpha", "Bravo"] {
        assert!(told.contains(&format!("horizon \"{name}\" was assembled again: ")), "{told}");
    }
    let blocks = |path: &str| {
        run_in(at, &format!("parameterize {path} --size 16x16x16 --json")).done().json()["blocks"].as_u64()
    };
    assert!(blocks("p.petro") > Some(1));
    for name in ["Alpha", "Bravo"] {
        let shown = run_in(at, &format!("horizon show p.petro {name} --json")).done().json();
        assert!(shown["sheets"].as_array().unwrap().len() > 1, "{shown}");
    }
    run_in(at, "undo p.petro").done();
    assert_eq!(blocks("p.petro"), Some(1));
}

#[test]
fn an_extraction_is_measured_against_the_truth() {
    let folder = project();
    let at = folder.path();
    let found = run_in(at, "evaluate p.petro s --json").done().json();
    let horizons = found["horizons"].as_array().unwrap();
    assert_eq!(horizons.len(), 5);
    for horizon in horizons {
        for figure in ["coverage", "precision", "purity"] {
            let value = horizon[figure].as_f64().unwrap();
            assert!((0.0..=1.0).contains(&value), "{horizon}");
        }
        assert!(horizon["picks"]["oracle"]["picks"].is_u64() && horizon["picks"]["replay"]["picks"].is_u64());
    }
    assert!(horizons[0]["coverage"].as_f64() > Some(0.8), "{found}");
    let table = run_in(at, "evaluate p.petro s").done().stdout;
    assert!(table.contains("Unconformity") && table.contains("oracle"), "{table}");
}

#[test]
fn pictures_show_the_extraction_and_the_nodes_picked() {
    let folder = project();
    let at = folder.path();
    let picture = |options: &str| {
        run_in(at, &format!("render p.petro a.png --size 160x120 --samples 1 --device cpu {options}")).done();
        image::open(at.join("a.png")).unwrap().to_rgb8()
    };
    // Levels of the trees: fewer and fewer colours, the same places.
    let colours = |options: &str| {
        let all: BTreeSet<[u8; 3]> = picture(options).pixels().map(|pixel| pixel.0.map(|c| c / 16)).collect();
        all.len()
    };
    let [leaves, nodes, surfaces] = ["0", "2", "40"].map(|level| colours(&format!("--level {level} --outlines off")));
    assert!(leaves >= nodes && nodes > surfaces, "{leaves} {nodes} {surfaces}");
    assert!(picture("--show distance") != picture("--show leaves"));

    // A horizon shows what was picked, and more of it after a climb.
    let place = place_on(at, "Bravo");
    pick(at, &format!("--at {place} --horizon Top --colour #ff0000"));
    let view = "--technique occlusion --horizon Top --scope near --clear-below 0.9 --elevation 60";
    let red = |image: &image::RgbImage| image.pixels().filter(|p| p.0[0] > 90 && p.0[1] < 60 && p.0[2] < 60).count();
    let first = red(&picture(view));
    assert!(first > 20, "{first}");
    let climbed = run_in(at, "climb p.petro 1 --highest-valid --json").done().json();
    let wider = red(&picture(view));
    if climbed["levels"].as_u64() > Some(0) {
        assert!(wider > first, "{wider} {first}");
    }
    let by_leaf = picture(&format!("{view} --show leaves"));
    assert!(red(&by_leaf) < wider, "leaves are told apart by colour");

    // Picks of another extraction give way to the horizon's sheets.
    run_in(at, "extract p.petro --max-distance 6").done();
    assert!(red(&picture(view)) > 20);
    std::fs::remove_dir_all(at.join("p.petro/derived/candidates.zarr")).unwrap();
    assert!(red(&picture(view)) > 20);
    let warned = run_in(at, "render p.petro a.png --size 80x60 --samples 1 --show leaves").done();
    assert!(warned.stderr.contains("no horizon candidates"), "{}", warned.stderr);
    run_in(at, "render p.petro a.png --show leaves --level 2").failed(&["no horizon candidates", "petroglyph extract"]);
    run_in(at, "horizon remove p.petro Top").done();
    run_in(at, "render p.petro a.png --show distance").failed(&["no horizon candidates", "petroglyph extract"]);
}
