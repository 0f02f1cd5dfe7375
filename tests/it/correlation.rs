//! Wells side by side: in every format, level where asked for, in batches, and what is refused.

use crate::program::{project, run_in};
use std::fs;
use std::path::Path;

/// Three wells: two with tops and a curve, one without either.
fn drilled() -> tempfile::TempDir {
    let folder = project();
    let at = folder.path();
    let tops = "surface,md_m,well\nALPHA,130,W1\nBravo,190,W1\nTuff & <ash>,220,W1\nCharlie,330,W1\n\
        alpha,150,W2\nUnconformity,240,W2\nDelta,420,W2\n";
    fs::write(at.join("tops.csv"), tops).unwrap();
    let rows: String = (0..=40).map(|n| format!("{} {}\n", 20 + 10 * n, 30 + n % 7)).collect();
    let las = format!(
        "~V\n VERS. 2.0 :\n WRAP. NO :\n~W\n STRT.M 20 :\n STOP.M 420 :\n STEP.M 10 :\n NULL. -999.25 :\n WELL. W1 :\
         \n~C\n DEPT.M : depth\n GR.GAPI : gamma\n~A\n{rows}"
    );
    fs::write(at.join("W1.las"), las).unwrap();
    fs::write(at.join("path.csv"), "md_m,inc,azi\n0,0,0\n500,0,0\n").unwrap();
    for (name, place, more) in [
        ("W1", "430200,6780200", "--tops tops.csv --las W1.las"),
        ("W2", "430600,6780500", "--tops tops.csv"),
        ("W3", "430900,6780800", ""),
    ] {
        run_in(at, &format!("well add p.petro path.csv --name {name} --head {place} --kb 0 {more}")).done();
    }
    folder
}

/// The texts of an SVG in the order of the file.
fn texts(at: &Path, file: &str) -> Vec<String> {
    let svg = fs::read_to_string(at.join(file)).unwrap();
    let found = svg.split("<text").skip(1).filter_map(|rest| rest.split('>').nth(1));
    found.map(|text| text.trim_end_matches("</text").to_owned()).collect()
}

#[test]
fn wells_stand_side_by_side_in_every_format_and_their_tops_are_joined() {
    let folder = drilled();
    let at = folder.path();
    let options = "--correlation --size-cm 22x15 --dpi 60 --legend --scale-bar --title Wells";
    for file in ["a.png", "a.tif", "a.svg", "a.pdf"] {
        run_in(at, &format!("render p.petro {file} {options}")).done();
    }
    let said = texts(at, "a.svg");
    // Horizons have their own names, other surfaces those of the file; the scale is that of the curve.
    for text in ["W1", "W2", "W3", "Alpha", "Tuff &amp; &lt;ash&gt;", "GR (GAPI)", "30", "36", "Wells", "Depth (m)"] {
        assert!(said.iter().any(|other| other == text), "no {text} in {said:?}");
    }
    assert!(said.iter().any(|text| text.contains("dashed: from the model")), "{said:?}");
    let svg = fs::read_to_string(at.join("a.svg")).unwrap();
    // Lines between wells with tops are solid, those to the well without are dashed.
    let alpha = svg.split("inkscape:label=\"Alpha\"").nth(1).unwrap().split("</g>").next().unwrap();
    assert_eq!(alpha.matches("<path").count(), 2, "{alpha}");
    assert_eq!(alpha.matches("stroke-dasharray").count(), 1, "{alpha}");
    // Only wells and their order count: fewer wells, the other way round.
    run_in(at, "render p.petro b.svg --correlation W2 W1 --log none --size-cm 16x11 --dpi 60").done();
    let said = texts(at, "b.svg");
    let place = |name: &str| said.iter().position(|text| text == name);
    assert!(place("W2") < place("W1") && place("W3").is_none() && place("GR").is_none(), "{said:?}");
}

#[test]
fn a_datum_is_level_and_the_axis_counts_from_it() {
    let folder = drilled();
    let at = folder.path();
    let level = "--datum alpha --well-range -100,300 --size-cm 16x11 --dpi 60";
    run_in(at, &format!("render p.petro a.svg --correlation {level}")).done();
    let said = texts(at, "a.svg");
    assert!(said.iter().any(|text| text == "Depth below Alpha (m)"), "{said:?}");
    assert!(said.iter().any(|text| text == "-100") && !said.iter().any(|text| text == "400"), "{said:?}");
    let svg = fs::read_to_string(at.join("a.svg")).unwrap();
    let alpha = svg.split("inkscape:label=\"Alpha\"").nth(1).unwrap().split("</g>").next().unwrap();
    let lines: Vec<&str> = alpha.split(" d=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
    assert!(lines.iter().all(|line| line.contains('h') && !line.contains(['l', 'v'])), "{lines:?}");
    assert_eq!(lines.len(), 2);
}

#[test]
fn a_batch_makes_the_same_panel_and_what_is_not_there_is_said() {
    let folder = drilled();
    let at = folder.path();
    let state = at.join("p.petro/project.toml");
    let plain = fs::read_to_string(&state).unwrap();
    let entry = "[[figures]]\nfile = 'wells.svg'\nsize = { cm = [16.0, 11.0] }\ndpi = 60\nlegend = true\n\
        [[figures.parts]]\ncorrelation = { wells = ['W1', 'W3'], datum = 'Alpha' }\n";
    fs::write(&state, format!("{plain}\n{entry}")).unwrap();
    run_in(at, "figures p.petro out --device cpu").done();
    let size = "--size-cm 16x11 --dpi 60";
    run_in(at, &format!("render p.petro wells.svg --correlation W1 W3 --datum Alpha --legend {size}")).done();
    assert!(fs::read(at.join("wells.svg")).unwrap() == fs::read(at.join("out/wells.svg")).unwrap());
    let refused = |options: &str, words: &[&str]| {
        run_in(at, &format!("render p.petro x.png --correlation {options} {size}")).failed(words);
        assert!(!at.join("x.png").exists());
    };
    refused("W9", &["no well named \"W9\"", "W1, W2, W3"]);
    refused("--datum Bravo", &["well \"W2\" does not meet Bravo", "alpha, Unconformity, Delta"]);
    refused("--log RHOB", &["no well has a curve named \"RHOB\"", "there are GR"]);
    refused("--well-range 300,100", &["not from 300 to 100"]);
    run_in(at, "render p.petro x.png --correlation --size-cm 2x2").failed(&["no room"]);
    assert_eq!(run_in(at, "render p.petro x.png --datum Alpha").code, 2);
    for well in ["W1", "W2", "W3"] {
        run_in(at, &format!("well remove p.petro {well}")).done();
    }
    refused("", &["the project has none", "well add"]);
}
