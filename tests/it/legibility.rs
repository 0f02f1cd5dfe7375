//! Neighbouring layers that look alike are said with what helps, and presets print without colours in every format.

use crate::program::{project, run_in, words};
use std::fs;
use std::path::Path;

const SMALL: &str = "--size 160x120 --samples 1 --device cpu --ground off";

/// The advice on stderr.
fn notes(at: &Path, options: &str) -> Vec<String> {
    let run = run_in(at, &format!("render p.petro a.png {SMALL} {options}")).done();
    run.stderr.lines().filter_map(|line| line.strip_prefix("note: ")).map(str::to_owned).collect()
}

#[test]
fn layers_that_look_alike_are_said_and_the_advice_helps() {
    let folder = project();
    let at = folder.path();
    for (layer, look) in [
        ("above Alpha", "limestone --colour #c08040"),
        ("Alpha - Bravo", "sand --colour #e8d8a0"),
        ("Bravo - Unconformity", "shale --colour #708870"),
        ("Unconformity - Charlie", "conglomerate --colour #f0e0d0"),
        ("Charlie - Delta", "dolostone --colour #8070a0"),
        ("below Delta", "salt --colour #f0d8d0"),
    ] {
        run_in(at, &format!("layer set p.petro '{layer}' --pattern {look}")).done();
    }
    assert_eq!(notes(at, ""), Vec::<String>::new());
    // Colours that differ for most readers, without a pattern that differs.
    run_in(at, "layer set p.petro 'Alpha - Bravo' --pattern sand --colour #ea713a").done();
    run_in(at, "layer set p.petro 'Bravo - Unconformity' --pattern sand --colour #40b62f").done();
    let told = notes(at, "");
    assert_eq!(told.len(), 1, "{told:?}");
    assert!(told[0].starts_with("Alpha - Bravo and Bravo - Unconformity are neighbours"), "{told:?}");
    assert!(told[0].contains("deuteranopia") && !told[0].contains("tritanopia"), "{told:?}");
    let json = run_in(at, &format!("render p.petro a.png {SMALL} --json")).done().json();
    assert_eq!(json["look_alikes"][0]["layers"][1], "Bravo - Unconformity");
    // The command in it is one that can be given.
    let state = at.join("p.petro/project.toml");
    let plain = fs::read_to_string(&state).unwrap();
    let entry = |file: &str| format!("[[figures]]\nfile = '{file}'\nsize = {{ px = [160, 120] }}\ndpi = 100\n");
    fs::write(&state, format!("{plain}\n{}{}", entry("a.png"), entry("b.png"))).unwrap();
    let all = run_in(at, "figures p.petro out --device cpu").done();
    assert_eq!(all.stderr.matches("note: ").count(), 1, "once for all figures: {}", all.stderr);
    assert!(all.stderr.contains("Alpha - Bravo and Bravo - Unconformity are neighbours"), "{}", all.stderr);
    fs::write(&state, plain).unwrap();
    let command = told[0].split("`petroglyph ").nth(1).unwrap().trim_end_matches("` tells them apart");
    assert_eq!(words(command)[..2], ["layer", "set"]);
    run_in(at, command).done();
    assert_eq!(notes(at, ""), Vec::<String>::new());
    // Raw data have no patterns to be told apart.
    for layer in ["Alpha - Bravo", "Bravo - Unconformity"] {
        run_in(at, &format!("layer set p.petro '{layer}' --pattern sand --colour #ea713a")).done();
    }
    assert_eq!((notes(at, "").len(), notes(at, "--blend 1").len()), (1, 0));
}

#[test]
fn presets_print_without_colours_in_every_format() {
    let folder = project();
    let at = folder.path();
    let page = "--size-cm 8x6 --dpi 60 --samples 1 --device cpu --annotate all";
    for preset in ["black-and-white", "greyscale"] {
        for (file, options) in [
            ("a.png", SMALL),
            ("b.png", page),
            ("c.tif", page),
            ("d.png", "--blend 0.5 --size 120x90 --samples 1 --device cpu"),
        ] {
            run_in(at, &format!("render p.petro {file} {options} --preset {preset}")).done();
            if file.ends_with("png") {
                let image = image::open(at.join(file)).unwrap().to_rgb8();
                assert!(image.pixels().all(|p| p.0[0] == p.0[1] && p.0[1] == p.0[2]), "{file} in {preset}");
            }
        }
        for file in ["a.svg", "a.pdf"] {
            run_in(at, &format!("render p.petro {file} {page} --preset {preset}")).done();
        }
        let svg = fs::read_to_string(at.join("a.svg")).unwrap();
        let mut colours: Vec<&str> = svg.match_indices("=\"#").map(|(at, _)| &svg[at + 3..at + 9]).collect();
        // References to images and clips begin alike.
        colours.retain(|text| text.chars().all(|c| c.is_ascii_hexdigit()));
        colours.sort_unstable();
        colours.dedup();
        assert!(colours.iter().all(|c| c[..2] == c[2..4] && c[2..4] == c[4..6]), "{colours:?}");
        if preset == "black-and-white" {
            assert_eq!(colours, ["000000", "ffffff"]);
        } else {
            assert!(colours.len() > 3, "{colours:?}");
        }
    }
    // In black and white a face is paper and ink; in greyscale it has the tones of the colours.
    let light = |preset: &str| {
        run_in(at, &format!("render p.petro a.png {SMALL} --preset {preset}")).done();
        let image = image::open(at.join("a.png")).unwrap().to_luma8();
        image.pixels().map(|p| f64::from(p.0[0])).sum::<f64>() / f64::from(image.width() * image.height())
    };
    let (white, grey) = (light("black-and-white"), light("greyscale"));
    assert!(white > grey + 8.0, "mean {white}, in greyscale {grey}");
    // A scene keeps it.
    run_in(at, "scene add p.petro grey --preset greyscale").done();
    assert!(run_in(at, "scene show p.petro grey").done().stdout.contains("preset = \"greyscale\""));
    assert_eq!(run_in(at, "render p.petro a.png --preset sepia").code, 2);
}
