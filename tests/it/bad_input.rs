//! Input that cannot be used: a clear reason, exit code 1, and a project that is byte for byte what it was.

use crate::program::{bytes, project, run_in, survey};
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// Fails with these words, both for a project that is there and for one that is not, and leaves no trace.
#[track_caller]
fn refused(at: &Path, line: &str, words: &[&str]) {
    let before = bytes(at);
    run_in(at, line).failed(words);
    let after = bytes(at);
    let changed: Vec<_> = after.keys().filter(|path| before.get(*path) != after.get(*path)).collect();
    assert!(changed.is_empty() && before.len() == after.len(), "changed by {line}: {changed:?}");
}

/// Samples of a trace in the synthetic survey, and its inlines and crosslines.
const SIZE: [usize; 3] = [48, 40, 56];
const TRACE: usize = 240 + 4 * SIZE[2];
const HEADERS: usize = 3600;

/// The synthetic survey's file, changed.
fn variant(at: &Path, name: &str, change: impl FnOnce(Vec<u8>) -> Vec<u8>) {
    let original = fs::read(at.join("s/survey.sgy")).unwrap();
    assert_eq!(original.len(), HEADERS + TRACE * SIZE[0] * SIZE[1]);
    fs::write(at.join(name), change(original)).unwrap();
}

#[test]
fn volumes_that_are_none() {
    let folder = project();
    let at = folder.path();
    variant(at, "cut.sgy", |mut file| {
        file.truncate(HEADERS + TRACE * 700 + 100);
        file
    });
    fs::write(at.join("text.sgy"), "X Y Z\n1 2 3\n".repeat(500)).unwrap();
    fs::write(at.join("empty.sgy"), "").unwrap();
    variant(at, "zero.sgy", |mut file| {
        file[HEADERS..].chunks_mut(TRACE).for_each(|trace| trace[..240].fill(0));
        file
    });
    variant(at, "line.sgy", |mut file| {
        file.truncate(HEADERS + TRACE * SIZE[1]);
        file
    });
    variant(at, "gather.sgy", |file| {
        let mut gathers = file[..HEADERS].to_vec();
        for trace in file[HEADERS..].chunks(TRACE) {
            for offset in [100i32, 600, 1100, 1600] {
                let mut trace = trace.to_vec();
                trace[36..40].copy_from_slice(&offset.to_be_bytes());
                gathers.extend(trace);
            }
        }
        gathers
    });
    for (file, words) in [
        ("cut.sgy", "cut off"),
        ("text.sgy", "text file"),
        ("empty.sgy", "too few"),
        ("zero.sgy", "line numbers"),
        ("line.sgy", "2D line"),
        ("gather.sgy", "pre-stack"),
        ("missing.sgy", "missing.sgy"),
    ] {
        refused(at, &format!("import {file} p.petro --name other"), &[words]);
        refused(at, &format!("import {file} new.petro"), &[words]);
        if file != "missing.sgy" {
            refused(at, &format!("info {file}"), &[words]);
        }
    }
}

#[test]
fn volumes_of_another_survey() {
    let folder = project();
    let at = folder.path();
    let shifted = |file: &mut [u8], byte: usize, by: i32| {
        for trace in file[HEADERS..].chunks_mut(TRACE) {
            let field = &mut trace[byte - 1..byte + 3];
            let value = i32::from_be_bytes(field.try_into().unwrap());
            field.copy_from_slice(&(value + by).to_be_bytes());
        }
    };
    variant(at, "elsewhere.sgy", |mut file| {
        shifted(&mut file, 181, 900_000_000);
        file
    });
    refused(at, "import elsewhere.sgy p.petro --name other", &["no rock in common"]);
    refused(at, "import s/survey.sgy p.petro --name other --vertical-unit ms", &["ms", "the project's in m"]);
    refused(at, "import s/survey.sgy p.petro --name seismic", &["already has a volume named \"seismic\""]);
    refused(at, "import s/survey.sgy p.petro --name Impedance", &["already has a volume"]);
}

/// A CSV of the survey's traces with a depth.
fn table(at: &Path, name: &str, depth: impl Fn(usize, usize) -> f64) {
    let mut text = String::from("inline,crossline,z\n");
    let info = run_in(at, "info p.petro --json").done().json();
    let line = |axis: &str, index: usize| {
        info[axis]["first"].as_i64().unwrap() + index as i64 * info[axis]["step"].as_i64().unwrap()
    };
    for x in 0..SIZE[0] {
        for y in 0..SIZE[1] {
            writeln!(text, "{},{},{}", line("inlines", x), line("crosslines", y), depth(x, y)).unwrap();
        }
    }
    fs::write(at.join(name), text).unwrap();
}

#[test]
fn horizons_that_do_not_fit() {
    let folder = project();
    let at = folder.path();
    let info = run_in(at, "info p.petro --json").done().json();
    let bottom = info["first_sample"].as_f64().unwrap() + info["interval"].as_f64().unwrap() * (SIZE[2] as f64 - 1.0);
    table(at, "deep.csv", |_, _| bottom * 0.97);
    table(at, "up.csv", |_, _| -bottom * 0.97);
    table(at, "km.csv", |_, _| bottom * 0.97 / 1000.0);
    table(at, "mm.csv", |_, _| bottom * 970.0);
    table(at, "through.csv", |x, _| bottom * (0.05 + 0.9 * x as f64 / SIZE[0] as f64));
    fs::write(at.join("outside.csv"), "x,y,z\n9e6,9e6,100\n9.001e6,9e6,101\n9e6,9.001e6,102\n9.001e6,9.001e6,99\n")
        .unwrap();
    fs::write(at.join("empty.csv"), "inline,crossline,z\n").unwrap();
    fs::write(at.join("noise.dat"), [0u8, 159, 146, 150, 7, 200].repeat(300)).unwrap();

    refused(at, "horizon add p.petro outside.csv --name O", &["outside.csv"]);
    refused(at, "horizon add p.petro up.csv --name U", &["vertical range", "--z-positive up"]);
    refused(at, "horizon add p.petro mm.csv --name M", &["vertical range"]);
    refused(at, "horizon add p.petro empty.csv --name E", &["empty.csv"]);
    refused(at, "horizon add p.petro noise.dat --name N", &["noise.dat"]);
    refused(at, "horizon add p.petro through.csv --name T", &["runs below"]);
    refused(at, "horizon add p.petro deep.csv --name Alpha", &["already has a horizon named \"Alpha\""]);
    refused(at, "horizon add p.petro deep.csv --name alpha", &["already has a horizon"]);
    refused(at, "horizon add p.petro deep.csv --name D --above Alpha", &["runs below"]);
    refused(at, "horizon add p.petro deep.csv --name D --above Nowhere", &["no horizon named \"Nowhere\""]);
    refused(at, "horizon add p.petro missing.csv --name D", &["missing.csv"]);
    refused(at, "horizon rename p.petro Alpha Bravo", &["already has a horizon named \"Bravo\""]);
    refused(at, "horizon remove p.petro Nowhere", &["it has: Alpha, Bravo"]);
    // The same file is taken when it is put right.
    run_in(at, "horizon add p.petro up.csv --name U --z-positive up").done();
    run_in(at, "undo p.petro").done();
    run_in(at, "horizon add p.petro km.csv --name K --z-factor 1000").done();
}

#[test]
fn faults_styles_and_scenes_that_do_not_fit() {
    let folder = project();
    let at = folder.path();
    refused(at, "fault add p.petro 's/faults/Normal fault.ts' --name 'Normal fault'", &["already has a fault"]);
    refused(at, "fault add p.petro 's/faults/Normal fault.ts' --name F --truncated-by G", &["no fault named \"G\""]);
    refused(at, "fault truncate p.petro 'Normal fault' --by 'Normal fault'", &["in a circle"]);
    refused(at, "fault add p.petro s/survey.sgy --name F", &["survey.sgy"]);
    refused(at, "layer set p.petro Nowhere --pattern chalk", &["no layer named \"Nowhere\""]);
    refused(at, "layer set p.petro 'above Alpha' --pattern chalc", &["chalc"]);
    refused(at, "layer set p.petro 'above Alpha' --interval 0,0.6,chalk --interval 0.5,1,marl", &["above Alpha"]);
    refused(at, "layer set p.petro 'above Alpha' --rock cheese", &["cheese", "vocabulary"]);
    refused(at, "layer set p.petro 'above Alpha' --age Tuesday", &["Tuesday", "Campanian"]);
    refused(at, "layer set p.petro 'above Alpha' --opacity 2", &["opacity"]);
    refused(at, "scalar set p.petro nothing --interval 0,1,chalk", &["no volume named \"nothing\""]);
    refused(at, "scalar set p.petro impedance --interval 2,1,chalk", &["impedance"]);
    refused(at, "velocity p.petro -3", &["velocity"]);
    refused(at, "scene add p.petro s --exaggeration 0", &["exaggeration"]);
    refused(at, "scene remove p.petro s", &["no scene named \"s\""]);
    refused(at, "render p.petro a.png --scene s", &["no scene named \"s\""]);
    refused(at, "render p.petro a.png --scene s.toml", &["s.toml"]);
    refused(at, "render p.petro a.png --blend 2", &["blend"]);
    refused(at, "texture p.petro s/survey.sgy", &["survey.sgy"]);
    refused(at, "export p.petro a.irap --horizon Nowhere", &["no horizon named"]);
}

#[test]
fn pictures_that_there_are_none_of() {
    let folder = project();
    let at = folder.path();
    let sizes = run_in(at, "render p.petro a.png --size 0x0");
    assert!(sizes.code == 2 && sizes.stderr.contains("--size 0x0"), "{}", sizes.stderr);
    refused(at, "render p.petro a.png --size 40000x20", &["40000", "32768"]);
    // The box and cut-outs of no size, and a cut-out beside the box.
    refused(at, "render p.petro a.png --box 110,110,510,520,40,80", &["the roaming box is empty"]);
    refused(at, "render p.petro a.png --cut-box 110,120,510,510,40,80", &["cut-out 1 is empty"]);
    refused(at, "render p.petro a.png --cut-box 9000,9100,9000,9100,1,2", &["cut-out 1", "outside the roaming box"]);
    refused(at, "render p.petro a.png --technique volume --medium nothing", &["no volume named \"nothing\""]);
    // A texture that is in use and gone.
    image::RgbImage::from_pixel(16, 16, image::Rgb([200, 100, 50])).save(at.join("brick.png")).unwrap();
    run_in(at, "texture p.petro brick.png").done();
    run_in(at, "layer set p.petro 'above Alpha' --pattern brick").done();
    fs::remove_file(at.join("p.petro/textures/brick.png")).unwrap();
    // What was derived on the way is kept.
    run_in(at, "render p.petro a.png --size 60x40 --samples 1 --device cpu").failed(&["brick.png"]);
}

#[test]
fn volumes_with_holes_are_rendered_around_them() {
    let folder = survey();
    let at = folder.path();
    // Whole traces, and samples of the others: not numbers, or infinite.
    variant(at, "holes.sgy", |mut bytes| {
        for (n, trace) in bytes[HEADERS..].chunks_exact_mut(TRACE).enumerate() {
            for (z, sample) in trace[240..].chunks_exact_mut(4).enumerate() {
                if n % 17 == 0 || (n + z) % 41 == 0 {
                    let hole = if z % 2 == 0 { f32::NAN } else { f32::INFINITY };
                    sample.copy_from_slice(&hole.to_be_bytes());
                }
            }
        }
        bytes
    });
    run_in(at, "import holes.sgy h.petro").done();
    for technique in ["volume", "phong", "occlusion"] {
        let line = format!("render h.petro {technique}.png --technique {technique} --clear-below -1");
        run_in(at, &format!("{line} --size 90x72 --samples 1 --device cpu --background '#000000'")).done();
        let picture = image::open(at.join(format!("{technique}.png"))).unwrap().to_rgb8();
        let bright = picture.pixels().filter(|pixel| pixel.0[1] > 60).count();
        assert!(bright > 200 && bright < 90 * 72, "{technique}: {bright}");
    }
}

#[test]
fn what_is_no_project() {
    let folder = survey();
    let at = folder.path();
    refused(at, "info s", &["no project.toml"]);
    refused(at, "import s/survey.sgy s", &["no project.toml"]);
    refused(at, "horizon list s/survey.sgy", &["it is a file"]);
    refused(at, "create s --bounds 0,1,0,1,0,1", &["exists already"]);
    fs::create_dir(at.join("newer.petro")).unwrap();
    fs::write(at.join("newer.petro/project.toml"), "version = 9\nshape = \"unknown\"\n").unwrap();
    refused(at, "info newer.petro", &["newer Petroglyph"]);
    refused(at, "import s/survey.sgy newer.petro", &["newer Petroglyph"]);
    fs::write(at.join("newer.petro/project.toml"), "version = 1\nstep = 0\nhorisons = []\n").unwrap();
    refused(at, "info newer.petro", &["cannot be understood", "horisons"]);
}

/// The last line of a refusal helps: it names what to look at, or the command's own help.
#[test]
fn a_refusal_ends_with_a_hint_that_helps() {
    let folder = project();
    let at = folder.path();
    let polygon = |id: usize, x: f64| {
        format!("{x},0,500,east-{id}\n{x},500,500,east-{id}\n{},0,520,east-{id}\n{x},0,500,east-{id}\n", x + 50.0)
    };
    let rows: String = (1..=2).map(|id| polygon(id, 400.0 * id as f64)).collect();
    fs::write(at.join("polygons.csv"), format!("X,Y,Z,POLY_ID\n{rows}")).unwrap();
    for (line, hint) in [
        ("fault add p.petro polygons.csv --name F", "hint: choose one of them with --select NAME"),
        ("horizon add p.petro nowhere.irap --name N", "hint: check the path: there is no such file or folder"),
        ("--json horizon add p.petro p.petro --name N", "hint: `petroglyph horizon add --help` shows an example"),
        ("render p.petro a.gif", "hint: `petroglyph render --help` shows an example"),
        ("fault extent p.petro F1 reach", "hint: `petroglyph fault extent --help` shows an example"),
    ] {
        let told = run_in(at, line);
        assert!(told.code > 0 && told.stderr.contains(hint), "{line}: {}", told.stderr);
    }
}
