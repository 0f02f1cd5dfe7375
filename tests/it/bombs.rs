//! Files and projects that state more than any machine has, name what never ends, or write where they should not: each is refused with a
//! sentence, in an address space that the harm they meant would not fit into.
#![cfg(target_os = "linux")]

use crate::program::{Run, STATE_HOME, bytes, command, forget_hash_of_tile, project, run_in};
use std::fs;
use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Stdio};

/// Address space that a run may take, KiB: threads and the program's own code need a part of it.
const LIMIT_KB: u64 = 2_500_000;

/// Runs the program with words separated by blanks under [`LIMIT_KB`]; one that hangs is ended and fails.
fn limited(folder: &Path, line: &str) -> Run {
    let program = env!("CARGO_BIN_EXE_petroglyph");
    let script = format!("ulimit -v {LIMIT_KB}; exec timeout 120 {program} {line}");
    let mut shell = Command::new("sh");
    let output =
        shell.current_dir(folder).args(["-c", &script]).env("XDG_STATE_HOME", STATE_HOME).stdin(Stdio::null()).output();
    Run::of(&output.expect("a shell runs"))
}

fn fifo(path: &Path) {
    assert!(Command::new("mkfifo").arg(path).status().expect("mkfifo runs").success());
}

/// Replaces a text in a file; it must be there.
fn edit(path: &Path, from: &str, to: &str) {
    let text = fs::read_to_string(path).expect("a text");
    assert!(text.contains(from), "{} has no {from}", path.display());
    fs::write(path, text.replacen(from, to, 1)).expect("a file");
}

const HEAD: &str =
    r#"<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" viewBox="0 0 10 10">"#;

/// Drawings that read files or multiply work, each with a word of the refusal.
fn bad_tiles() -> Vec<(&'static str, String, &'static str)> {
    let mut doubling = String::from(r#"<g id="a0"><rect width="1" height="1"/></g>"#);
    for level in 1..30 {
        let below = format!("<use xlink:href=\"#a{}\"/>", level - 1);
        doubling += &format!("<g id=\"a{level}\">{below}{below}</g>");
    }
    let entities: String =
        (1..9).map(|n| format!("<!ENTITY e{n} \"{}\">", format!("&e{};", n - 1).repeat(10))).collect();
    let tile = |inside: &str| format!("{HEAD}{inside}</svg>");
    vec![
        ("zero", tile(r#"<image href="/dev/zero" width="9" height="9"/>"#), "`image`"),
        ("pipe", tile(r#"<image xlink:href="pipe" width="9" height="9"/>"#), "`image`"),
        ("linked", tile(r#"<image href="other.svg" width="9" height="9"/>"#), "`image`"),
        ("filter", tile(r#"<filter id="f"><feImage href="other.svg"/></filter>"#), "`filter`"),
        ("blur", tile(r#"<rect width="9" height="9" style="filter:blur(99999px)"/>"#), "filter"),
        ("doubling", tile(&doubling), "elements"),
        ("deep", tile(&format!("{}{}", "<g>".repeat(200_000), "</g>".repeat(200_000))), "deeper"),
        ("entities", format!("<!DOCTYPE svg [<!ENTITY e0 \"x\">{entities}]>{}", tile("&e8;")), "entities"),
        ("dashes", tile(r#"<path d="M0 0H1e9" stroke="red" stroke-dasharray="1e-3"/>"#), "dashes"),
        ("far", tile(r#"<path d="M-1e5 -1e5 L 1e5 1e5 L 1e5 0 Z"/>"#), "beyond the tile"),
        ("farther", tile(r#"<path d="M-1e38 -1e38 L 1e38 1e38 L 1e38 0 Z"/>"#), "beyond the tile"),
        ("pattern", tile(r#"<pattern id="p" width="1e9" height="1e9"><rect/></pattern>"#), "`pattern`"),
    ]
}

#[test]
fn a_tile_opens_no_file_and_has_a_bound() {
    let folder = project();
    let at = folder.path();
    fifo(&at.join("pipe"));
    fs::write(at.join("other.svg"), format!("{HEAD}<rect width=\"9\" height=\"9\"/></svg>")).unwrap();
    let before = bytes(&at.join("p.petro"));
    for (name, svg, word) in bad_tiles() {
        let file = at.join(format!("{name}.svg"));
        fs::write(&file, svg).unwrap();
        limited(at, &format!("texture p.petro {name}.svg")).failed(&[word]);
    }
    for name in ["device.png", "device.svg"] {
        fifo(&at.join(name));
        limited(at, &format!("texture p.petro {name}")).failed(&["not an ordinary file"]);
    }
    // An image of 50 000 x 50 000 pixels in a few hundred bytes.
    let mut png = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\xc3\x50\0\0\xc3\x50\x08\x06\0\0\0".to_vec();
    png.extend(crc32(&png[12..]).to_be_bytes());
    fs::write(at.join("huge.png"), png).unwrap();
    limited(at, "texture p.petro huge.png").failed(&["huge.png"]);
    assert!(bytes(&at.join("p.petro")) == before);
    limited(at, "texture p.petro other.svg").done();
}

fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0u32, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| (crc >> 1) ^ (0xEDB8_8320 & 0u32.wrapping_sub(crc & 1)))
    })
}

#[test]
fn a_tile_in_a_project_from_someone_else_is_refused_too() {
    let folder = project();
    let at = folder.path();
    fs::write(at.join("mine.svg"), format!("{HEAD}<rect width=\"9\" height=\"9\"/></svg>")).unwrap();
    run_in(at, "texture p.petro mine.svg").done();
    forget_hash_of_tile(&at.join("p.petro"));
    let tile = fs::read_dir(at.join("p.petro/textures")).unwrap().next().unwrap().unwrap().path();
    for (_, svg, word) in bad_tiles() {
        fs::write(&tile, svg).unwrap();
        limited(at, "layer list p.petro").failed(&[word]);
    }
    fs::remove_file(&tile).unwrap();
    fifo(&tile);
    limited(at, "layer list p.petro").failed(&["not an ordinary file"]);
    limited(at, "patterns out.png --project p.petro").failed(&["not an ordinary file"]);
}

#[test]
fn what_never_ends_is_not_read() {
    let folder = project();
    let at = folder.path();
    fifo(&at.join("pipe"));
    for name in ["/dev/zero", "pipe"] {
        for line in [
            "horizon add p.petro @ --name Z",
            "horizon add p.petro @ --name Z --format csv",
            "fault add p.petro @ --name Z",
            "well add p.petro @ --name Z",
            "import @ p.petro --name Z",
            "info @",
            "scene add p.petro Z --from @",
            "render p.petro a.png --scene @",
            "evaluate p.petro @",
        ] {
            limited(at, &line.replace('@', name)).failed(&[]);
        }
    }
    for file in ["project.toml", "horizons/Alpha.zarr/zarr.json", "faults/Normal fault.json"] {
        let copy = at.join("copy.petro");
        let _ = fs::remove_dir_all(&copy);
        fs::create_dir(&copy).unwrap();
        crate::program::copy(&at.join("p.petro"), &copy);
        let kind = file.split('/').next().unwrap();
        let victim = match file.strip_prefix("faults/") {
            Some(_) => fs::read_dir(copy.join(kind)).unwrap().next().unwrap().unwrap().path(),
            None if kind == "horizons" => {
                fs::read_dir(copy.join(kind)).unwrap().next().unwrap().unwrap().path().join("zarr.json")
            }
            None => copy.join(file),
        };
        fs::remove_file(&victim).unwrap();
        fifo(&victim);
        limited(at, "render copy.petro a.png --size 60x40 --samples 1 --device cpu").failed(&["ordinary file"]);
    }
}

/// A sparse file takes no place and says that it is huge.
#[test]
fn a_file_beyond_the_stated_size_is_not_read() {
    let folder = project();
    let at = folder.path();
    for (name, line) in [
        ("huge.csv", "horizon add p.petro huge.csv --name Z"),
        ("huge.las", "well add p.petro huge.las --name Z"),
        ("huge.toml", "render p.petro a.png --scene huge.toml"),
        ("huge.svg", "texture p.petro huge.svg"),
    ] {
        fs::File::create(at.join(name)).unwrap().set_len(20 << 30).unwrap();
        limited(at, line).failed(&["more than the"]);
    }
    fs::File::options().write(true).open(at.join("p.petro/project.toml")).unwrap().set_len(20 << 30).unwrap();
    limited(at, "info p.petro").failed(&["more than the"]);
}

#[test]
fn counts_on_the_command_line_are_checked_before_they_are_multiplied() {
    let folder = project();
    let at = folder.path();
    for (line, word) in [
        ("create n.petro --bounds 0,9,0,9,0,9 --size 100000x100000x100000", "more than a survey may have"),
        ("create n.petro --bounds 0,9,0,9,0,9 --size 4294967296x4294967296x4294967296", "more than a survey may have"),
        ("create n.petro --bounds 0,9,0,9,0,1e300", "beyond what a survey may have"),
    ] {
        let refused = limited(at, line);
        assert!(refused.code == 2 && refused.stderr.contains(word), "{}", refused.stderr);
        assert!(!at.join("n.petro").exists());
    }
    limited(at, "synth n --size 100000x100000x100000").failed(&["more than a survey may have"]);
    limited(at, "synth n --size 10000x10000x10000").failed(&["the disk has room for"]);
    limited(at, "parameterize p.petro --size 100000x100000x100000").failed(&["more than a survey may have"]);
    limited(at, "render p.petro a.png --size 32768x32768 --samples 1 --device cpu").failed(&["of memory"]);
}

#[test]
fn a_survey_too_large_for_memory_takes_no_horizon() {
    let folder = project();
    let at = folder.path();
    run_in(at, "create n.petro --bounds 0,5000,0,4000,0,2000 --size 40000x40000x100").done();
    fs::write(at.join("h.csv"), "x,y,z\n0,0,100\n100,0,110\n0,100,120\n100,100,130\n").unwrap();
    limited(at, "horizon add n.petro h.csv --name H --format csv").failed(&["of memory"]);
}

#[test]
fn a_soup_of_triangles_is_no_horizon() {
    let folder = project();
    let at = folder.path();
    run_in(at, "create n.petro --bounds 0,5000,0,4000,0,2000 --size 101x81x51").done();
    let mut file = fs::File::create(at.join("soup.ts")).unwrap();
    writeln!(file, "GOCAD TSurf 1\nHEADER {{\nname:soup\n}}\nTFACE").unwrap();
    let mut state = 7u64;
    let mut random = |below: u64| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) % below
    };
    for id in 1..=2000 {
        writeln!(file, "VRTX {id} {} {} {}", random(5000), random(4000), random(2000)).unwrap();
    }
    for _ in 0..200_000 {
        writeln!(file, "TRGL {} {} {}", random(2000) + 1, random(2000) + 1, random(2000) + 1).unwrap();
    }
    limited(at, "horizon add n.petro soup.ts --name Soup").failed(&["depths at one place"]);
}

/// Grids, meshes, tables and wells of other programs whose heads promise what their bytes do not hold, each with a word of
/// the refusal.
fn false_promises() -> Vec<(&'static str, Vec<u8>, &'static str)> {
    let floats = |values: &[f32]| values.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>();
    let words = |values: &[u32]| values.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>();
    let big = |values: &[u32]| values.iter().flat_map(|v| v.to_be_bytes()).collect::<Vec<u8>>();
    let npy =
        |head: &str| [b"\x93NUMPY\x01\0", &(head.len() as u16).to_le_bytes()[..], head.as_bytes(), &[0; 64]].concat();
    let surfer = [b"DSBB".to_vec(), vec![0xff, 0x7f, 0xff, 0x7f], vec![0; 48], floats(&[1.0; 9])].concat();
    let stl = [vec![b' '; 80], words(&[u32::MAX]), vec![0; 50]].concat();
    // A TIFF of 2^31 by 2^31 floats in one strip of 24 bytes.
    let entry = |tag: u16, kind: u16, value: u32| {
        [&tag.to_le_bytes()[..], &kind.to_le_bytes(), &1u32.to_le_bytes(), &value.to_le_bytes()].concat()
    };
    let huge = 1 << 31;
    let entries = [
        (256, 4, huge),
        (257, 4, huge),
        (258, 3, 32),
        (259, 3, 1),
        (262, 3, 1),
        (273, 4, 8),
        (278, 4, huge),
        (279, 4, 24),
        (339, 3, 3),
    ];
    let tiff: Vec<u8> = [b"II*\0".to_vec(), words(&[32]), vec![0; 24], (entries.len() as u16).to_le_bytes().to_vec()]
        .into_iter()
        .chain(entries.map(|(tag, kind, value)| entry(tag, kind, value)))
        .chain([vec![0; 4]])
        .flatten()
        .collect();
    // NetCDF: dimensions of 2^31 - 1, and one variable over both.
    let dimension = |name: u8| [big(&[1]), vec![name, 0, 0, 0], big(&[i32::MAX as u32])].concat();
    let netcdf = [
        [b"CDF\x01".to_vec(), big(&[0, 10, 2]), dimension(b'y'), dimension(b'x'), big(&[0, 0, 11, 1])].concat(),
        [big(&[1]), vec![b'z', 0, 0, 0], big(&[2, 0, 1, 0, 0, 6, 16, 96]), vec![0; 64]].concat(),
    ]
    .concat();
    let mut shapefile = [big(&[9994, 0, 0, 0, 0, 0, 1 << 30]), words(&[1000, 3]), vec![0; 64]].concat();
    shapefile.extend([big(&[1, 1 << 29]), words(&[3]), vec![0; 32], words(&[1 << 30, 1 << 30]), vec![0; 64]].concat());
    // A database whose one table is a page that is its own child.
    let mut database = b"SQLite format 3\0".to_vec();
    database.extend([2, 0, 1, 1, 0, 64, 32, 32]);
    database.resize(68, 0);
    database.extend(b"GPKG");
    database.resize(100, 0);
    database.extend([5, 0, 0, 0, 1, 1, 244, 0, 0, 0, 0, 1, 1, 244]);
    database.resize(500, 0);
    database.extend([0, 0, 0, 1, 1]);
    database.resize(512, 0);
    let text = |text: &str| text.as_bytes().to_vec();
    vec![
        (
            "esri.asc",
            text("ncols 2000000000\nnrows 2000000000\nxllcorner 0\nyllcorner 0\ncellsize 25\n1 2 3\n"),
            "2000000000 columns",
        ),
        ("surfer.grd", text("DSAA\n2000000000 2000000000\n0 100\n0 100\n1 2\n1 2 1 2\n"), "2000000000 columns"),
        ("surfer6.grd", surfer, "header is unusable"),
        ("geosoft.gxf", text("#POINTS\n60000\n#ROWS\n60000\n#GTYPE\n8\n#GRID\n%%%%%%%%\n"), "bytes"),
        (
            "array.npy",
            npy("{'descr': '<f8', 'fortran_order': False, 'shape': (2000000000, 2000000000), }\n"),
            "a shape of",
        ),
        (
            "head.npy",
            npy("{'descr': '<f8', 'fortran_order': False, 'shape': (99999999999999999999999, 2), }\n"),
            "NumPy",
        ),
        ("mesh.stl", stl, "4294967295"),
        ("mesh.obj", text("v 0 0 1\nv 1 0 1\nv 0 1 1\nf 1 2 99999999999\n"), "99999999999"),
        ("raster.tif", tiff, "raster.tif"),
        ("grid.nc", netcdf, "grid.nc"),
        ("lines.shp", shapefile, "lines.shp"),
        ("map.gpkg", database, "map.gpkg"),
        (
            "deep.geojson",
            text(&format!("{{\"type\":\"FeatureCollection\",\"features\":{}", "[".repeat(400_000))),
            "deep.geojson",
        ),
    ]
}

#[test]
fn a_grid_or_mesh_of_another_program_is_believed_only_where_its_bytes_are() {
    let folder = project();
    let at = folder.path();
    let before = bytes(&at.join("p.petro"));
    let mut missed = Vec::new();
    for (name, content, words) in false_promises() {
        fs::write(at.join(name), content).unwrap();
        let told = limited(at, &format!("horizon add p.petro {name} --name Z"));
        assert!(told.code == 1, "{name}: {}", told.stderr);
        missed.extend((!told.stderr.contains(words)).then(|| format!("{name}: no {words:?} in {}", told.stderr)));
        limited(at, &format!("fault add p.petro {name} --name Z")).failed(&["error: "]);
        limited(at, &format!("info {name}"));
    }
    assert!(missed.is_empty(), "{missed:#?}");
    assert!(bytes(&at.join("p.petro")) == before);
    let las = "~Version\nVERS. 3.0 :\nWRAP. NO :\n~Well\nSTRT.M 0 :\nSTOP.M 1e300 :\nSTEP.M 1e-300 :\nNULL. -999.25 :\n\
               ~Curve\nDEPT.M :\nGR.API {F9999999999} :\n~Ascii\n0 1\n";
    fs::write(at.join("well.las"), las).unwrap();
    limited(at, "well add p.petro well.las --name W").failed(&["error: "]);
}

#[test]
fn a_shape_is_believed_only_where_its_files_are() {
    let folder = project();
    let at = folder.path();
    let root = at.join("p.petro");
    run_in(at, "extract p.petro").done();
    let data = |kind: &str, name: &str| {
        let mut entries = fs::read_dir(root.join(kind)).unwrap().map(|entry| entry.unwrap());
        entries.find(|entry| entry.file_name().to_string_lossy().starts_with(name)).unwrap().path()
    };
    let (volume, horizon) = (data("volumes", "seismic"), data("horizons", "Alpha"));
    let candidates = root.join("derived/candidates.zarr");
    let render = "render p.petro a.png --size 60x40 --samples 1 --device cpu --blend 1";
    for (array, line) in [
        (volume.join("0"), render),
        (volume.join("live"), render),
        (horizon.join("0/depth"), render),
        (horizon.join("0/quality"), render),
        (candidates.join("forest/nodes"), "export p.petro out.csv --candidates"),
        (candidates.join("forest/triangles"), "export p.petro out.csv --candidates"),
        (candidates.join("leaf"), "render p.petro a.png --size 60x40 --show leaves --device cpu --samples 1"),
    ] {
        let metadata = array.join("zarr.json");
        let whole = fs::read_to_string(&metadata).unwrap();
        for first in ["1000000000000", "18446744073709551615"] {
            let mut value: serde_json::Value = serde_json::from_str(&whole).unwrap();
            value["shape"][0] = serde_json::from_str(first).unwrap();
            fs::write(&metadata, value.to_string()).unwrap();
            limited(at, line).failed(&[]);
            // A chunk as large as the shape: one file then seems enough.
            value["chunk_grid"]["configuration"]["chunk_shape"][0] = serde_json::from_str(first).unwrap();
            fs::write(&metadata, value.to_string()).unwrap();
            limited(at, line).failed(&[]);
        }
        fs::write(&metadata, whole).unwrap();
        limited(at, line).done();
    }
}

#[test]
fn the_state_of_a_project_is_checked_against_its_data_and_against_reason() {
    let folder = project();
    let at = folder.path();
    let state = at.join("p.petro/project.toml");
    let whole = fs::read_to_string(&state).unwrap();
    let render = "render p.petro a.png --size 60x40 --samples 1 --device cpu --blend 1";
    let history = bytes(&at.join("p.petro/history"));
    for (from, to, line) in [
        ("count = 48", "count = 480000", render),
        ("count = 48", "count = 200000", render),
        ("count = 48", "count = 18446744073709551615", "info p.petro"),
        ("count = 48", "count = 49", render),
        ("interval = ", "interval = 1e300\nunused = ", "info p.petro"),
    ] {
        fs::write(&state, &whole).unwrap();
        edit(&state, from, to);
        if to.starts_with("interval") {
            let text = fs::read_to_string(&state).unwrap();
            let lines = text.lines().filter(|line| !line.starts_with("unused"));
            fs::write(&state, lines.map(|line| format!("{line}\n")).collect::<String>()).unwrap();
        }
        limited(at, line).failed(&[]);
    }
    let step = whole.lines().find(|line| line.starts_with("step = ")).unwrap();
    for last in ["4294967295", "4294967294", "1000000001"] {
        fs::write(&state, whole.replacen(step, &format!("step = {last}"), 1)).unwrap();
        limited(at, "velocity p.petro 2600").failed(&["beyond the last"]);
    }
    assert!(bytes(&at.join("p.petro/history")) == history);
    fs::write(&state, whole).unwrap();
    limited(at, "velocity p.petro 2600").done();
}

#[test]
fn nothing_is_exported_into_a_project() {
    let folder = project();
    let at = folder.path();
    run_in(at, "extract p.petro").done();
    fs::create_dir(at.join("deep")).unwrap();
    std::os::unix::fs::symlink(at.join("p.petro"), at.join("deep/link")).unwrap();
    std::os::unix::fs::symlink(at.join("p.petro/project.toml"), at.join("state.csv")).unwrap();
    let before = bytes(&at.join("p.petro"));
    for line in [
        "export p.petro p.petro/project.toml --candidates",
        "export p.petro p.petro/project.toml --horizon Alpha --format csv",
        "export p.petro p.petro/new.sgy --volume seismic",
        "export p.petro deep/link/derived/x.csv --candidates",
        "export p.petro state.csv --candidates",
        "render p.petro p.petro/a.png --size 60x40 --samples 1 --device cpu",
        "render p.petro p.petro/a.png --size-cm 4x3 --inline 20",
        "patterns p.petro/textures/a.png",
        "synth p.petro/derived/s",
        "demo --out p.petro/demo",
        "create p.petro/history/inner.petro",
    ] {
        run_in(at, line).failed(&["inside the project"]);
    }
    assert!(bytes(&at.join("p.petro")) == before);
}

#[test]
fn escapes_in_names_reach_no_terminal() {
    let folder = project();
    let at = folder.path();
    let state = at.join("p.petro/project.toml");
    let text = fs::read_to_string(&state).unwrap();
    let hostile = "\\u001B]0;owned\\u0007\\u009B31m\\u202Eend";
    fs::write(&state, text.replace("\"Alpha\"", &format!("\"{hostile}\""))).unwrap();
    let raw = |text: &str| text.chars().any(|c| (c.is_control() && c != '\n' && c != '\t') || c == '\u{202e}');
    for line in [
        "info p.petro",
        "horizon list p.petro",
        "layer list p.petro",
        "--json horizon list p.petro",
        "horizon show p.petro nothing",
        "--json horizon show p.petro nothing",
        "export p.petro out.csv --horizon nothing --format csv",
    ] {
        let run = run_in(at, line);
        assert!(!raw(&run.stdout) && !raw(&run.stderr), "{line}: {:?} {:?}", run.stdout, run.stderr);
    }
    assert!(run_in(at, "horizon list p.petro").stdout.contains("\\u{1b}]0;owned"));
    // A header of a SEG-Y file.
    let mut segy = fs::read(at.join("s/survey.sgy")).unwrap();
    // In EBCDIC 0x27 is the escape.
    segy[..8].copy_from_slice(&[0xC3, 0x40, 0xF1, 0x27, 0xAD, 0xF2, 0xD1, 0x2F]);
    fs::write(at.join("escape.sgy"), segy).unwrap();
    let run = run_in(at, "info escape.sgy").done();
    assert!(!raw(&run.stdout), "{:?}", run.stdout);
}

#[test]
fn an_answer_that_cannot_be_written_is_a_failure() {
    let folder = project();
    let at = folder.path();
    for line in ["info p.petro", "--json horizon list p.petro", "--help", "--version"] {
        let full = fs::File::options().write(true).open("/dev/full").unwrap();
        let run = command().current_dir(at).args(line.split(' ')).stdout(full).output().unwrap();
        assert_eq!(run.status.code(), Some(1), "{line}");
        assert!(String::from_utf8_lossy(&run.stderr).contains("could not be written"), "{line}");
        // Nothing can be said, and nothing may panic.
        let full = || fs::File::options().write(true).open("/dev/full").unwrap();
        let run = command().current_dir(at).args(line.split(' ')).stdout(full()).stderr(full()).output().unwrap();
        assert_eq!(run.status.code(), Some(1), "{line}");
        // A reader that has gone away.
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let run = command().current_dir(at).args(line.split(' ')).stdout(writer).output().unwrap();
        assert!(run.status.success() && run.stderr.is_empty(), "{line}: {}", String::from_utf8_lossy(&run.stderr));
    }
}

#[test]
fn writers_wait_for_one_another_for_a_stated_time() {
    let folder = project();
    let at = folder.path();
    let lock = fs::File::options().write(true).read(true).open(at.join("p.petro/lock")).unwrap();
    lock.try_lock().unwrap();
    (&lock).write_all(b"process 77 (petroglyph attribute)").unwrap();
    for line in [
        "velocity p.petro 2100",
        "undo p.petro",
        "redo p.petro",
        "prune p.petro",
        "import s/survey.sgy p.petro --name b",
    ] {
        run_in(at, &format!("{line} --wait 0")).failed(&["process 77 (petroglyph attribute)"]);
        run_in(at, &format!("{line} --wait 0.2")).failed(&["process 77 (petroglyph attribute)"]);
    }
    let waiting = command().current_dir(at).args(["velocity", "p.petro", "2200", "--wait", "100"]).spawn().unwrap();
    // Many at once, which all come in turn once the lock is free.
    let more: Vec<_> = (0..6)
        .map(|n| {
            command().current_dir(at).args(["velocity", "p.petro", &(2300 + n).to_string(), "--wait", "100"]).spawn()
        })
        .collect();
    drop(lock);
    for child in more.into_iter().map(Result::unwrap).chain([waiting]) {
        assert!(child.wait_with_output().unwrap().status.success());
    }
    for wrong in ["-1", "nan", "many"] {
        assert_eq!(run_in(at, &format!("velocity p.petro 2100 --wait={wrong}")).code, 2, "{wrong}");
    }
    assert!(run_in(at, "velocity --help").stdout.contains("--wait <SECONDS>"));
}
