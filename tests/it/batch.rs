//! All figures of a project at once: the pages that `render` makes, the same bytes each time, and nothing half-done.

use crate::program::{project, run_in};
use std::fs;
use std::path::Path;

/// Adds lines to the state of the project, as its owner does.
fn list(at: &Path, lines: &str) {
    let state = at.join("p.petro/project.toml");
    let text = fs::read_to_string(&state).unwrap();
    fs::write(&state, format!("{text}\n{lines}")).unwrap();
}

/// A block of a scene, and a section.
const TWO: &str = "[[figures]]\nfile = 'block.png'\nscene = 'front'\nsize = { cm = [9.0, 7.0] }\ndpi = 60\nlegend = true\n\
    \n# The type section\n[[figures]]\nfile = 'section.svg'\nsize = { cm = [9.0, 7.0] }\nscale_bar = true\ntitle = 'North'\n\
    [[figures.parts]]\nsection = { kind = 'inline', at = 120.0 }\n";

#[test]
fn one_command_makes_the_pages_that_render_makes_and_the_same_bytes_again() {
    let folder = project();
    let at = folder.path();
    run_in(at, "scene add p.petro back --blend 1").done();
    run_in(at, "scene add p.petro front --azimuth 70 --blend 0").done();
    list(at, TWO);
    // A command that writes the state again keeps the list and what is written beside it.
    run_in(at, "velocity p.petro 2500").done();
    let kept = fs::read_to_string(at.join("p.petro/project.toml")).unwrap();
    assert!(kept.contains("# The type section\n[[figures]]\nfile = \"section.svg\""), "{kept}");
    let told = run_in(at, "figures p.petro out --device cpu --json").done().json();
    assert_eq!(told["figures"][0]["size_px"][0].as_u64(), Some(213), "{told}");
    assert_eq!(told["figures"].as_array().map(Vec::len), Some(2));
    let first = ["block.png", "section.svg"].map(|file| fs::read(at.join("out").join(file)).unwrap());
    run_in(at, "render p.petro block.png --scene front --size-cm 9x7 --dpi 60 --legend --device cpu").done();
    run_in(at, "render p.petro section.svg --inline 120 --size-cm 9x7 --scale-bar --title North").done();
    for (file, made) in ["block.png", "section.svg"].iter().zip(&first) {
        assert!(fs::read(at.join(file)).unwrap() == *made, "{file} is not what render makes");
    }
    // Again, over the first ones; what else lies in the folder stays.
    fs::write(at.join("out/notes.txt"), "mine").unwrap();
    fs::write(at.join("out/block.png"), "old").unwrap();
    run_in(at, "figures p.petro out --device cpu").done();
    for (file, made) in ["block.png", "section.svg"].iter().zip(&first) {
        assert!(fs::read(at.join("out").join(file)).unwrap() == *made, "{file} has other bytes");
    }
    assert_eq!(fs::read_dir(at.join("out")).unwrap().count(), 3);
}

#[test]
fn what_cannot_be_made_is_said_and_nothing_is_half_done() {
    let folder = project();
    let at = folder.path();
    let state = at.join("p.petro/project.toml");
    run_in(at, "figures p.petro out").failed(&["lists no figures", "[[figures]]"]);
    let good = "[[figures]]\nfile = 'a.png'\nsize = { cm = [6.0, 5.0] }\ndpi = 60\n\
        [[figures.parts]]\nsection = { kind = 'inline', at = 120.0 }\n";
    let plain = fs::read_to_string(&state).unwrap();
    let refused = |bad: &str, words: &[&str]| {
        fs::write(&state, format!("{plain}\n{good}[[figures]]\n{bad}\n")).unwrap();
        run_in(at, "figures p.petro out --device cpu").failed(words);
        assert!(!at.join("out").exists(), "{bad}");
    };
    refused("file = 'b.png'\nscene = 'nowhere'", &["\"b.png\"", "no scene named \"nowhere\""]);
    refused("file = 'A.png'", &["\"A.png\"", "another figure has this file"]);
    for file in ["../b.png", "sub/b.png", "/b.png", "..", "", "sub\\b.png"] {
        refused(&format!("file = '{file}'"), &["without a folder"]);
    }
    refused("file = 'b.gif'", &["\"b.gif\"", ".svg or .pdf"]);
    refused("file = 'b.png'\nlegends = true", &["legends"]);
    let sceneless = "file = 'b.png'\nscene = 'front'\n[[figures.parts]]\nsection = { kind = 'inline', at = 120.0 }";
    refused(sceneless, &["\"b.png\"", "names a scene, but none of its parts is a block"]);
    // Found only when the second is made: the first does not stay alone.
    let outside = "file = 'b.png'\n[[figures.parts]]\nsection = { kind = 'inline', at = 4711.0 }";
    refused(outside, &["\"b.png\"", "inline 4711", "outside the survey"]);
    // In a folder that was there, the former file stays as it was.
    fs::create_dir(at.join("out")).unwrap();
    fs::write(at.join("out/a.png"), "former").unwrap();
    run_in(at, "figures p.petro out --device cpu").failed(&["inline 4711"]);
    assert_eq!(fs::read_to_string(at.join("out/a.png")).unwrap(), "former");
    assert_eq!(fs::read_dir(at.join("out")).unwrap().count(), 1);
    // Never into a project.
    fs::write(&state, format!("{plain}\n{good}")).unwrap();
    run_in(at, "figures p.petro p.petro/out").failed(&["inside the project"]);
}
