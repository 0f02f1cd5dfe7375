//! Throws: a few typed points in each fault block keep them, labels state them, and a profile draws them along the fault.

use crate::program::run_in;
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// X of the fault, which dips by 60° to larger X, at a depth.
fn at_fault(z: f64) -> f64 {
    2500.0 + (z - 1000.0) / 60f64.to_radians().tan()
}

/// Depth of a horizon that dips along the strike of the fault, 150 m lower beyond it.
fn depth(base: f64, y: f64, is_beyond: bool) -> f64 {
    base + 0.03 * (y - 2000.0) + if is_beyond { 150.0 } else { 0.0 }
}

const FOOT: [[f64; 2]; 4] = [[400.0, 530.0], [1900.0, 710.0], [570.0, 3400.0], [1700.0, 3310.0]];
const HANGING: [[f64; 2]; 4] = [[3110.0, 600.0], [4500.0, 940.0], [3300.0, 3500.0], [4610.0, 3200.0]];
const LEVELS: [(&str, f64); 3] = [("A", 700.0), ("B", 1000.0), ("C", 1300.0)];
const CREATE: &str = "create p.petro --bounds 0,5000,0,4000,0,2000 --size 101x81x101 --z-unit m";

/// Files of a fault and of three horizons with these points before and beyond it.
fn typed(at: &Path, foot: &[[f64; 2]], hanging: &[[f64; 2]]) {
    let mut fault = String::from("x,y,z,stick\n");
    for stick in 0..5 {
        for z in [0.0, 1000.0, 2000.0] {
            writeln!(fault, "{:.2},{},{z},{stick}", at_fault(z), 1000 * stick).unwrap();
        }
    }
    fs::write(at.join("F1.csv"), fault).unwrap();
    for (name, base) in LEVELS {
        let mut text = String::from("x,y,z\n");
        for (places, is_beyond) in [(foot, false), (hanging, true)] {
            for [x, y] in places {
                writeln!(text, "{x},{y},{:.2}", depth(base, *y, is_beyond)).unwrap();
            }
        }
        fs::write(at.join(format!("{name}.csv")), text).unwrap();
    }
}

fn add_horizons(at: &Path) {
    for (name, _) in LEVELS {
        run_in(at, &format!("horizon add p.petro {name}.csv --name {name}")).done();
    }
}

/// The texts of an SVG.
fn texts(at: &Path, file: &str) -> Vec<String> {
    let svg = fs::read_to_string(at.join(file)).unwrap();
    let found = svg.split("<text").skip(1).filter_map(|rest| rest.split('>').nth(1));
    found.map(|text| text.trim_end_matches("</text").to_owned()).collect()
}

/// The largest error of a horizon's nodes, away from the fault by a tenth of a trace.
fn error(at: &Path, name: &str, base: f64) -> f64 {
    run_in(at, &format!("export p.petro {name}-out.csv --horizon {name} --format csv")).done();
    let text = fs::read_to_string(at.join(format!("{name}-out.csv"))).unwrap();
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').map(str::trim).collect();
    let column =
        |names: &[&str]| header.iter().position(|head| names.contains(head)).unwrap_or_else(|| panic!("{header:?}"));
    let (x, y, z) = (column(&["x"]), column(&["y"]), column(&["z", "depth_m", "depth"]));
    let (mut worst, mut count) = (0.0f64, 0);
    for line in lines {
        let values: Vec<f64> = line.split(',').map(|text| text.trim().parse().unwrap_or(f64::NAN)).collect();
        let off = values[x] - at_fault(values[z]);
        if off.abs() > 5.0 && values[z].is_finite() {
            worst = worst.max((values[z] - depth(base, values[y], off > 0.0)).abs());
            count += 1;
        }
    }
    assert!(count > 3000, "{count} nodes");
    worst
}

/// In whichever order fault and horizons come, four points a block give 150 m on every face and in the data.
#[test]
fn four_points_a_block_keep_the_throw() {
    for is_fault_first in [true, false] {
        let folder = tempfile::tempdir().unwrap();
        let at = folder.path();
        typed(at, &FOOT, &HANGING);
        run_in(at, CREATE).done();
        if is_fault_first {
            run_in(at, "fault add p.petro F1.csv --name F1").done();
            add_horizons(at);
        } else {
            add_horizons(at);
            let said = run_in(at, "fault add p.petro F1.csv --name F1").done().stdout;
            assert!(said.contains("horizon \"A\" was fitted again to its 8 points"), "{said}");
        }
        for (name, base) in LEVELS {
            let error = error(at, name, base);
            assert!(error < 1.0, "{name}: {error}");
        }
        // A face across the fault, one at an angle to it, and the block.
        for (file, shown) in [
            ("across.svg", "--crossline 41"),
            ("oblique.svg", "--fence 20,70 80,10"),
            ("block.svg", "--cut nearest,0.45,0.45"),
        ] {
            run_in(at, &format!("render p.petro {file} {shown} --section-blend 0 --annotate faults --size-cm 17x12"))
                .done();
            let (said, svg) = (texts(at, file), fs::read_to_string(at.join(file)).unwrap());
            let label = said.iter().find(|text| text.starts_with("F1,")).unwrap_or_else(|| panic!("{file}: {said:?}"));
            let stated: f64 = label.trim_start_matches("F1, ").split(' ').next().unwrap().parse().unwrap();
            assert!((stated - 150.0).abs() <= 1.0, "{file}: {label}");
            // Two arrows, each with its rim.
            let written = svg.split("inkscape:label=\"F1\"").last().unwrap();
            let arrows = written.split("<text").next().unwrap().matches("stroke-linejoin=\"round\"").count();
            assert!(arrows >= 4, "{file} has no half-arrows: {written}");
        }
        // Without the fault the points are joined as before.
        let removed = run_in(at, "fault remove p.petro F1").done().stdout;
        assert!(removed.contains("horizon \"A\" was fitted again to its"), "{removed}");
        run_in(at, "check p.petro").done();
        assert!(error(at, "A", 700.0) > 50.0);
    }
}

#[test]
fn one_point_in_a_block_is_enough_and_none_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    typed(at, &FOOT, &HANGING[1..2]);
    run_in(at, CREATE).done();
    run_in(at, "fault add p.petro F1.csv --name F1").done();
    add_horizons(at);
    run_in(at, "render p.petro one.svg --crossline 41 --section-blend 0 --annotate faults --size-cm 17x12").done();
    assert!(texts(at, "one.svg").iter().any(|text| text.starts_with("F1, 150 m")), "{:?}", texts(at, "one.svg"));

    // The middle block of two faults has no point.
    let second = fs::read_to_string(at.join("F1.csv")).unwrap();
    let moved: String = second.lines().enumerate().fold(String::new(), |mut text, (n, line)| {
        let mut values: Vec<String> = line.split(',').map(str::to_owned).collect();
        if n > 0 {
            values[0] = (values[0].parse::<f64>().unwrap() - 400.0).to_string();
        }
        writeln!(text, "{}", values.join(",")).unwrap();
        text
    });
    fs::write(at.join("F2.csv"), moved).unwrap();
    let said = run_in(at, "fault add p.petro F2.csv --name F2").done().stderr;
    assert!(said.contains("horizon \"A\": it has no point in the fault block around inline"), "{said}");
    run_in(at, "render p.petro none.png --crossline 41 --section-blend 0 --size-cm 9x6 --dpi 60").done();
}

#[test]
fn heave_and_profiles_are_drawn_on_request() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    typed(at, &FOOT, &HANGING);
    run_in(at, CREATE).done();
    run_in(at, "fault add p.petro F1.csv --name F1").done();
    add_horizons(at);
    let section = "--crossline 41 --section-blend 0 --size-cm 17x12";
    run_in(at, &format!("render p.petro heave.svg {section} --annotate faults --heave")).done();
    // 150 m over the tangent of 60°.
    assert!(texts(at, "heave.svg").contains(&"F1, 150 m, heave 87 m".to_owned()), "{:?}", texts(at, "heave.svg"));
    for file in ["t.png", "t.svg", "t.pdf", "t.tif"] {
        run_in(at, &format!("render p.petro {file} --throw F1 --heave --size-cm 15x12 --dpi 60")).done();
    }
    let said = texts(at, "t.svg");
    for text in [
        "F1",
        "normal, down to the east",
        "Throw (m)",
        "Heave (m)",
        "Distance along strike (m)",
        "A",
        "B",
        "C",
        "S",
        "N",
    ] {
        assert!(said.iter().any(|other| other == text), "no {text} in {said:?}");
    }
    // A profile is a part like any other, and follows a new name of its fault.
    fs::write(at.join("f.toml"), "[[parts]]\nthrow = { fault = \"F1\" }\n[[parts]]\nmap = { horizon = \"A\" }\n")
        .unwrap();
    run_in(at, "render p.petro f.png --figure f.toml").done();
    run_in(at, "render p.petro no.png --throw F7").failed(&["no fault named \"F7\"", "F1"]);
    run_in(at, "render p.petro no.png --throw F1 --size-cm 2x2").failed(&["no room"]);
}
