//! Reviews and models: what is in their files, and what is refused. How a page behaves in a browser is driven by
//! `make check-review`.

use crate::program::{FAULTS, HORIZONS, project, run_in};
use serde_json::Value;
use std::fs;
use std::path::Path;

const SMALL: &str = "--density 120 --device cpu";

/// The data in a page.
fn data(page: &str) -> Value {
    let (_, rest) = page.split_once("id=\"model\">").unwrap();
    let (json, _) = rest.split_once("</script>").unwrap();
    assert!(!json.contains(['<', '>', '&', '\u{2028}']), "nothing in the data can end it");
    serde_json::from_str(json).unwrap()
}

/// The JSON and the bytes of a model.
fn model(path: &Path) -> (Value, Vec<u8>) {
    let file = fs::read(path).unwrap();
    let number = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap()) as usize;
    assert_eq!((&file[..4], number(4), number(8)), (&b"glTF"[..], 2, file.len()));
    let length = number(12);
    assert_eq!((&file[16..20], length % 4), (&b"JSON"[..], 0));
    let bytes = file[20 + length + 8..].to_vec();
    assert_eq!((&file[20 + length + 4..20 + length + 8], number(20 + length)), (&b"BIN\0"[..], bytes.len()));
    (serde_json::from_slice(&file[20..20 + length]).unwrap(), bytes)
}

#[test]
fn a_page_holds_the_block_its_scenes_and_its_notes() {
    let folder = project();
    let at = folder.path();
    run_in(at, "scene add p.petro corner --cut nearest,0.5,0.4 --blend 0.3").done();
    run_in(at, "scene add p.petro whole --ground off").done();
    run_in(at, "note add p.petro 'Reverse fault?' --at 120,520,200 --scene corner").done();
    let told = run_in(at, &format!("review p.petro a.html --sections 1 {SMALL} --json")).done().json();
    let text = fs::read_to_string(at.join("a.html")).unwrap();
    assert_eq!(told["bytes"].as_u64(), Some(text.len() as u64));
    assert!(text.len() < 5_000_000, "{}", text.len());
    for word in ["default-src 'none'", "script-src 'sha256-", "style-src 'sha256-", "img-src data: blob:"] {
        assert!(text.contains(word), "no {word}");
    }
    assert_eq!(text.matches("<img src=\"data:image/jpeg;base64,").count(), 2, "a picture for each scene");
    let data = data(&text);
    let names = |of: &str| {
        data[of].as_array().unwrap().iter().map(|one| one["name"].as_str().unwrap().to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(names("scenes"), ["corner", "whole"]);
    assert_eq!(names("horizons"), HORIZONS.map(|(name, _)| name));
    assert_eq!(names("faults"), FAULTS);
    assert_eq!(data["notes"][0]["text"], "Reverse fault?");
    assert_eq!((&data["notes"][0]["scene"], &data["warning"]), (&Value::from("corner"), &Value::Null));
    // Four sides, two walls and the ground or a flat top; without cut-outs four sides and that.
    let block = |block: &Value| &data["blocks"][block.as_u64().unwrap() as usize];
    let faces = |scene: usize, cuts: usize| {
        let scene = &data["scenes"][scene];
        let ground = scene["ground"].as_array().unwrap().iter().filter(|part| part["cuts"].as_u64() == Some(0));
        let relief = ground.flat_map(|part| block(&part["block"])["faces"].as_array().unwrap());
        let relief = relief.filter(|face| face["name"] == "ground").count();
        block(&scene["variants"][cuts])["faces"].as_array().unwrap().len() + relief
    };
    assert_eq!([faces(0, 1), faces(0, 0), faces(1, 1), faces(1, 0)], [7, 5, 7, 5]);
    assert_eq!(data["scenes"][0]["cuts"], serde_json::json!(["Cut-out"]));
    let grounds = |scene: usize| data["scenes"][scene]["ground"].as_array().unwrap().len();
    assert!(grounds(0) > 1 && grounds(1) == 0, "{} {}", grounds(0), grounds(1));
    assert_eq!(data["sections"].as_array().unwrap().len(), 3);
    // Pictures of faces that scenes share are there once.
    assert!(data["covers"].as_array().unwrap().iter().all(|cover| cover["illustrated"].is_string()));
    // The same again is the same page.
    run_in(at, &format!("review p.petro b.html --sections 1 {SMALL}")).done();
    assert!(fs::read(at.join("b.html")).unwrap() == text.into_bytes());
}

/// Cut-outs are switched one by one: a block for each set of them.
#[test]
fn each_cut_out_is_switched_by_itself() {
    let folder = project();
    let at = folder.path();
    run_in(at, "scene add p.petro two --cut min-min,0.3,0.3 --cut max-max,0.4,0.4 --ground off").done();
    run_in(at, &format!("review p.petro a.html --sections 0 {SMALL}")).done();
    let data = data(&fs::read_to_string(at.join("a.html")).unwrap());
    let scene = &data["scenes"][0];
    assert_eq!(scene["cuts"], serde_json::json!(["Cut-out 1", "Cut-out 2"]));
    let walls = |cuts: usize| {
        let block = &data["blocks"][scene["variants"][cuts].as_u64().unwrap() as usize];
        let faces = block["faces"].as_array().unwrap().iter();
        faces.filter(|face| face["name"].as_str().unwrap().starts_with("wall")).count()
    };
    assert_eq!([0, 1, 2, 3].map(walls), [0, 2, 2, 4]);
}

/// What was not picked is named in the legend and marked, and a block that nobody interpreted says so.
#[test]
fn a_page_says_what_was_not_picked_and_what_nobody_interpreted() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    crate::unpicked::sparse(at);
    run_in(at, &format!("review p.petro a.html --sections 0 {SMALL}")).done();
    let text = fs::read_to_string(at.join("a.html")).unwrap();
    assert!(text.contains("<p>Filled or extrapolated in part: Sparse: 27 % picked.</p>"));
    let sparse = data(&text);
    assert_eq!((&sparse["unpicked"], &sparse["warning"]), (&Value::from(true), &Value::Null));
    let told = |name: &str, key: &str| {
        let all = sparse["horizons"].as_array().unwrap();
        all.iter().find(|horizon| horizon["name"] == name).unwrap()[key].clone()
    };
    assert!(told("Whole", "unsure").is_null() && told("Sparse", "unsure").is_string());
    assert!(told("Sparse", "picked").as_f64().unwrap() < 0.3 && told("Whole", "picked") == 1.0);

    run_in(at, "synth s --size 48x48x64 --seed 1").done();
    run_in(at, "illustrate s/survey.sgy b.svg --layers 4 --device cpu --project u.petro").done();
    run_in(at, &format!("review u.petro u.html --sections 0 {SMALL}")).done();
    let text = fs::read_to_string(at.join("u.html")).unwrap();
    let warning = "Uninterpreted: layers by computed geologic time, not by rock";
    assert!(text.contains(&format!("<p class=\"warning\">{warning}</p>")));
    let data = data(&text);
    assert_eq!(data["warning"], warning);
    assert!(data["layers"].as_array().unwrap().iter().all(|layer| layer["rock"] == "" && layer["age"] == ""));
    run_in(at, &format!("export u.petro u.glb --model --triangles 20000 {SMALL}")).done();
    let (document, _) = model(&at.join("u.glb"));
    let root = document["nodes"].as_array().unwrap().last().unwrap();
    assert!(root["name"].as_str().unwrap().contains("uninterpreted") && root["extras"]["warning"] == warning);

    // One horizon that a person clicked makes it an interpretation, and its rocks are named.
    let lowest = data["layers"].as_array().unwrap().last().unwrap()["name"].as_str().unwrap().to_owned();
    run_in(at, &format!("layer set u.petro '{lowest}' --rock limestone")).done();
    run_in(at, "pick u.petro --at 110,510,100 --horizon Mine --by-time").done();
    run_in(at, &format!("review u.petro m.html --sections 0 {SMALL}")).done();
    let interpreted = self::data(&fs::read_to_string(at.join("m.html")).unwrap());
    assert!(interpreted["warning"].is_null());
    assert!(interpreted["layers"].as_array().unwrap().iter().any(|layer| layer["rock"] == "Limestone"));
    let origins = run_in(at, "info u.petro --json").done().json()["origins"].clone();
    let kind = |of: &str, name: &str| {
        let all = origins[of].as_array().unwrap();
        all.iter().find(|one| one["name"] == name).unwrap()["origin"]["kind"].clone()
    };
    assert_eq!((kind("horizons", "Mine"), kind("horizons", "Level 1")), ("by-time".into(), "level".into()));
    assert_eq!((kind("volumes", "time"), kind("volumes", "seismic")), ("geologic-time".into(), "imported".into()));
}

#[test]
fn hostile_names_stay_text() {
    let folder = project();
    let at = folder.path();
    run_in(at, "scene add p.petro '</script><script>alert(1)</script>'").done();
    run_in(at, "note add p.petro '<img src=x onerror=alert(1)>' --at 120,520,200").done();
    run_in(at, &format!("review p.petro a.html --sections 0 {SMALL}")).done();
    let text = fs::read_to_string(at.join("a.html")).unwrap();
    assert!(!text.contains("<img src=x") && !text.contains("<script>alert"));
    assert_eq!(text.matches("</script>").count(), 2);
    assert_eq!(data(&text)["scenes"][0]["name"], "</script><script>alert(1)</script>");
}

#[test]
fn a_model_is_a_whole_file_with_named_nodes() {
    let folder = project();
    let at = folder.path();
    let told = run_in(at, &format!("export p.petro a.glb --model --triangles 20000 {SMALL} --json")).done().json();
    let (document, bytes) = model(&at.join("a.glb"));
    let nodes: Vec<&str> =
        document["nodes"].as_array().unwrap().iter().map(|node| node["name"].as_str().unwrap()).collect();
    for name in ["Block", "Horizons", "Faults", "ground", HORIZONS[2].0, FAULTS[0]] {
        assert!(nodes.contains(&name), "no {name} in {nodes:?}");
    }
    let root = document["nodes"].as_array().unwrap().last().unwrap();
    let exaggeration = told["exaggeration"].as_f64().unwrap();
    assert_eq!(root["scale"], serde_json::json!([1.0, exaggeration, 1.0]));
    assert_eq!(root["extras"]["verticalExaggeration"].as_f64(), Some(exaggeration));
    assert!(root["name"].as_str().unwrap().contains("vertical exaggeration"));
    assert_eq!(document["buffers"][0]["byteLength"].as_u64(), Some(bytes.len() as u64));
    // Every number lies in the file, every index among the corners, and there are not more triangles than asked for.
    let mut triangles = 0;
    let number = |value: &Value| value.as_u64().unwrap() as usize;
    let view = |accessor: &Value| {
        let view = &document["bufferViews"][number(&accessor["bufferView"])];
        let from = number(&view["byteOffset"]);
        &bytes[from..from + number(&view["byteLength"])]
    };
    for mesh in document["meshes"].as_array().unwrap() {
        let part = &mesh["primitives"][0];
        let [corners, indices] =
            [&part["attributes"]["POSITION"], &part["indices"]].map(|n| &document["accessors"][number(n)]);
        assert_eq!(view(corners).len(), 12 * number(&corners["count"]));
        let used = view(indices).chunks_exact(4).map(|n| u32::from_le_bytes(n.try_into().unwrap()) as usize);
        assert!(used.max().unwrap() < number(&corners["count"]));
        triangles += number(&indices["count"]) / 3;
    }
    assert_eq!(told["triangles"].as_u64(), Some(triangles as u64));
    assert!(triangles <= 20_000 && told["deviation_m"].as_f64().unwrap() > 0.0);
    // The block of 47 × 39 bins of 25 m, X east and Z south.
    let sizes = document["accessors"].as_array().unwrap().iter().filter(|accessor| accessor["max"].is_array());
    let widest = |axis: usize| sizes.clone().map(|a| a["max"][axis].as_f64().unwrap()).fold(f64::MIN, f64::max);
    assert!(widest(0) > 400.0 && widest(0) < 800.0, "{}", widest(0));
}

#[test]
fn notes_are_numbered_and_undone() {
    let folder = project();
    let at = folder.path();
    run_in(at, "note add p.petro one --at 120,520,200").done();
    run_in(at, "note add p.petro two --at 121,520,200").done();
    run_in(at, "note remove p.petro 1").done();
    assert_eq!(run_in(at, "note list p.petro --json").done().json()["notes"][0]["text"], "two");
    run_in(at, "undo p.petro").done();
    assert_eq!(run_in(at, "note list p.petro --json").done().json()["notes"].as_array().unwrap().len(), 2);
    run_in(at, "note remove p.petro 3").failed(&["no note 3", "1 to 2"]);
    run_in(at, "note add p.petro x --at 9000,520,200").failed(&["outside the survey"]);
    run_in(at, "note add p.petro x --at 120,520,200 --scene nowhere").failed(&["nowhere"]);
    run_in(at, "note add p.petro ' ' --at 120,520,200").failed(&["empty"]);
}

#[test]
fn what_cannot_be_made_is_refused_and_leaves_nothing() {
    let folder = project();
    let at = folder.path();
    for usage in [
        "review p.petro a.pdf",
        "review p.petro a.html --density 5",
        "review p.petro a.html --size-limit 0",
        "export p.petro a.obj --model",
        "export p.petro a.glb --model --triangles 3",
        "export p.petro a.glb --scene corner --horizon Alpha",
        "note add p.petro x --at 1,2",
    ] {
        assert_eq!(run_in(at, usage).code, 2, "{usage}");
    }
    run_in(at, "review p.petro p.petro/a.html").failed(&["project"]);
    run_in(at, "review p.petro a.html --scene nowhere").failed(&["nowhere"]);
    run_in(at, &format!("review p.petro a.html --size-limit 0.5 {SMALL}")).failed(&["MB"]);
    run_in(at, "create empty.petro --bounds 0,100,0,100,0,100 --size 9x9x9").done();
    run_in(at, "review empty.petro a.html").failed(&["no layers"]);
    assert!(!at.join("a.html").exists());
    let left: Vec<_> = fs::read_dir(at).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert!(!left.iter().any(|name| name.to_string_lossy().contains("partial")), "{left:?}");
}
