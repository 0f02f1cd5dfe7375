//! What an event must keep: throws, thicknesses, areas; how beds of several events meet; progress.

use crate::oracle::beds_text;
use glam::{DVec2, DVec3};
use history::{History, Place, Stage};

fn history(events: &str) -> History {
    History::from_toml(&(beds_text() + events)).unwrap_or_else(|error| panic!("{error}"))
}

/// Depth of the top of a bed in a column.
fn top(stage: &Stage<'_>, name: &str, map: DVec2) -> f64 {
    let is_bed = |place: &Place| place.rock().is_some_and(|rock| stage.history().units()[rock.unit].name == name);
    stage.column(map).into_iter().find(|stretch| is_bed(&stretch.place)).expect("the bed").depths[0]
}

#[test]
fn throws_are_as_stated() {
    for (dip, slip) in [(60.0f64, 200.0), (35.0, -250.0), (80.0, 400.0)] {
        let history = history(&format!("[[events]]\nkind = \"fault\"\nstrike = 0\ndip = {dip}\nslip = {slip}\n"));
        let stage = history.last_stage();
        let [foot, hanging] = [100.0, 3900.0].map(|x| top(&stage, "Lime", DVec2::new(x, 1500.0)));
        let throw = slip * dip.to_radians().sin();
        assert!(((hanging - foot) / throw - 1.0).abs() < 1e-6, "{dip} {slip}: {foot} {hanging}");
    }
    let stated = history("[[events]]\nkind = \"fault\"\nthrow = 150\nat = [2000, 1500, 0]\n");
    let stage = stated.last_stage();
    let [foot, hanging] = [100.0, 3900.0].map(|x| top(&stage, "Lime", DVec2::new(x, 1500.0)));
    assert!((hanging - foot - 150.0).abs() < 1e-3);
    // At the middle of a fault with a tip the throw is the whole one.
    let tipped = history(
        "[[events]]\nkind = \"fault\"\ndip = 89.9\nslip = 120\nextent = [2400, 1400]\nat = [2000, 1500, 400]\n",
    );
    let stage = tipped.last_stage();
    let [foot, hanging] = [1998.0, 2002.0].map(|x| top(&stage, "Lime", DVec2::new(x, 1500.0)));
    assert!(((hanging - foot) / 120.0 - 1.0).abs() < 5e-3, "{foot} {hanging}");
}

#[test]
fn parallel_folds_keep_the_thickness_of_beds() {
    for shape in ["sine", "chevron", "box", "monocline"] {
        let text = format!(
            "[[events]]\nkind = \"fold\"\nstyle = \"parallel\"\nshape = \"{shape}\"\nwavelength = 1800\namplitude = 90\n"
        );
        let history = history(&text);
        let stage = history.last_stage();
        for n in 0..60 {
            let x = 300.0 + 57.0 * f64::from(n);
            let on_top = DVec3::new(x, 1500.0, top(&stage, "Lime", DVec2::new(x, 1500.0)) + 1e-3);
            let rock = *stage.place(on_top).rock().unwrap();
            let down = -stage.gradient(&rock, on_top).row(2).normalize();
            // Along the normal of the top to the base.
            let (mut low, mut high) = (50.0, 400.0);
            for _ in 0..50 {
                let middle = 0.5 * (low + high);
                if stage.coordinates(&rock, on_top + down * middle).z > 0.0 { low = middle } else { high = middle }
            }
            assert!((low / 200.0 - 1.0).abs() < 1e-3, "{shape} at {x}: {low}");
        }
    }
}

#[test]
fn areas_in_section_are_kept_under_slip_and_parallel_folding() {
    let events = [
        "kind = \"fault\"\nslip = 300",
        "kind = \"fault\"\nshape = \"listric\"\nslip = 400\nat = [1000, 1500, 0]",
        "kind = \"fault\"\nshape = \"listric\"\nslip = 400\nat = [1000, 1500, 0]\nshear = 60",
        "kind = \"fault\"\nshape = \"ramp\"\nslip = -600\nat = [2000, 1500, 700]\nflats = [300, 1100]",
        "kind = \"dominoes\"\nrotation = 15\nspacing = 800",
        "kind = \"fold\"\nwavelength = 1500\namplitude = 500\naxial_dip = 40",
        "kind = \"fold\"\nstyle = \"parallel\"\nwavelength = 1800\namplitude = 90",
    ];
    for event in events {
        let history = history(&format!("[[events]]\n{event}\n"));
        let stage = history.last_stage();
        let mut areas = Vec::new();
        for n in 0..4000 {
            let p = DVec3::new(211.0 + f64::from(n % 80) * 45.0, 1500.0, 100.0 + f64::from(n / 80) * 9.0);
            let Place::Rock(rock) = stage.place(p) else { continue };
            let at = |dx: f64, dz: f64| stage.before(0, &rock.sides, p + DVec3::new(dx, 0.0, dz));
            let h = 1e-3;
            let (x, z) = ((at(h, 0.0) - at(-h, 0.0)) / (2.0 * h), (at(0.0, h) - at(0.0, -h)) / (2.0 * h));
            areas.push(x.x * z.z - x.z * z.x);
        }
        // A few of the small crosses lie over a bend.
        areas.sort_by(f64::total_cmp);
        let inner = &areas[areas.len() / 50..areas.len() * 49 / 50];
        let [low, high] = [inner[0], inner[inner.len() - 1]];
        assert!((low - 1.0).abs() < 5e-3 && (high - 1.0).abs() < 5e-3, "{event}: {low} {high}");
    }
}

#[test]
fn later_beds_onlap_what_was_left() {
    let history = history(
        "[[events]]\nkind = \"tilt\"\ndip = 10\ndirection = 90\n[[events]]\nkind = \"erosion\"\ndepth = 120\n\
         [[events]]\nkind = \"beds\"\nbeds = [{ rock = \"marl\", thickness = 60 }, { rock = \"chalk\", thickness = 60 }]\n",
    );
    let stage = history.last_stage();
    let names = |x: f64| -> Vec<String> {
        let column = stage.column(DVec2::new(x, 1500.0));
        column.iter().filter_map(|s| s.place.rock()).map(|rock| history.units()[rock.unit].name.clone()).collect()
    };
    // In the west the tilted beds reach the plane; in the east the ground lies deeper and marl fills it.
    assert_eq!(names(1900.0), ["Chalk", "Marl", "Sand", "Shale", "Lime", "Basement"]);
    let [west, east] = [1900.0, 3900.0].map(|x| {
        let column = stage.column(DVec2::new(x, 1500.0));
        column.iter().map(|stretch| stretch.depths).collect::<Vec<_>>()
    });
    assert!((west[0][1] - 60.0).abs() < 1e-4 && (west[1][1] - 120.0).abs() < 1e-4);
    let top = 1900.0 * 10f64.to_radians().tan();
    assert!((east[1][1] - top).abs() < 1e-3, "{east:?} {top}");
}

#[test]
fn a_history_goes_on_continuously() {
    let history = history("[[events]]\nkind = \"fault\"\nslip = 200\n[[events]]\nkind = \"erosion\"\ndepth = 150\n");
    let depth = |progress: f64| top(&history.stage(progress), "Lime", DVec2::new(3900.0, 1500.0));
    let whole = 200.0 * 60f64.to_radians().sin();
    assert!((depth(1.0) - 400.0).abs() < 1e-3 && (depth(1.5) - 400.0 - 0.5 * whole).abs() < 1e-3);
    assert!((depth(2.0) - 400.0 - whole).abs() < 1e-3 && (depth(3.0) - depth(2.0)).abs() < 1e-3);
    assert!(matches!(history.place(DVec3::new(2000.0, 1500.0, 700.0), 0.0), Place::Air));
    // Beds grow from the base up.
    assert!(matches!(history.place(DVec3::new(2000.0, 1500.0, 700.0), 0.3), Place::Air));
    assert!(matches!(history.place(DVec3::new(2000.0, 1500.0, 1300.0), 0.3), Place::Rock(_)));
}

#[test]
fn intrusions_cut_rock_and_not_air() {
    let history = history(
        "[[events]]\nkind = \"erosion\"\ndepth = 100\n[[events]]\nkind = \"dyke\"\nthickness = 40\nstrike = 0\n\
         [[events]]\nkind = \"pluton\"\nradius = 600\naureole = 150\nat = [800, 1500, 1500]\nroughness = 0\n",
    );
    let stage = history.last_stage();
    let name = |x: f64, z: f64| match stage.place(DVec3::new(x, 1500.0, z)) {
        Place::Rock(rock) => {
            let of = |unit: usize| history.units()[unit].name.clone();
            (of(rock.unit), rock.altered.map(of))
        }
        _ => ("air".to_owned(), None),
    };
    assert_eq!(name(2000.0, 300.0), ("Basalt".to_owned(), None));
    assert_eq!(name(2000.0, 50.0).0, "air");
    // The walls have moved apart by half of its thickness each.
    let rock = *stage.place(DVec3::new(2500.0, 1500.0, 300.0)).rock().unwrap();
    assert!((rock.ijk.x - 2480.0).abs() < 1e-9);
    assert_eq!(name(800.0, 1000.0), ("Granite".to_owned(), None));
    assert_eq!(name(800.0, 800.0), ("Basement".to_owned(), Some("Hornfels".to_owned())));
    assert_eq!(name(800.0, 700.0), ("Basement".to_owned(), None));
}
