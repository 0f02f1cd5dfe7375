//! What was filled or extrapolated does not look like what was picked, and a figure says how much was.

use crate::program::run_in;
use image::RgbImage;
use std::fs;
use std::path::Path;

/// A project with a horizon on all traces and one on a sixth of them; with the four traces beside its border, which count
/// as picked, that is 11 of 41.
pub(crate) fn sparse(at: &Path) {
    run_in(at, "create p.petro --bounds 0,1000,0,1000,0,500 --size 41x41x51").done();
    for (name, z, last) in [("Whole", 120.0, 40), ("Sparse", 300.0, 6)] {
        let rows = (0..=last).flat_map(|x| (0..=40).map(move |y| (25 * x, 25 * y)));
        let text =
            rows.fold("x,y,z\n".to_owned(), |text, (x, y)| text + &format!("{x},{y},{}\n", z + 0.05 * f64::from(y)));
        fs::write(at.join("h.csv"), text).unwrap();
        run_in(at, &format!("horizon add p.petro h.csv --name {name} --z-unit m --z-positive down")).done();
    }
}

fn picture(at: &Path, outlines: &str) -> RgbImage {
    let line = format!("render p.petro {outlines}.png --outlines {outlines} --device cpu --samples 1 --size 500x400");
    let told = run_in(at, &line).done().stderr;
    assert!(told.contains("horizon Sparse was picked on or near 27 % of its traces"), "{told}");
    assert!(!told.contains("Whole"), "{told}");
    image::open(at.join(format!("{outlines}.png"))).unwrap().to_rgb8()
}

#[test]
fn a_figure_says_how_little_of_a_horizon_was_picked_and_can_dash_the_rest() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    sparse(at);
    let [whole, dashed, none] = ["on", "dashed", "off"].map(|outlines| picture(at, outlines));
    let light = |pixel: &image::Rgb<u8>| pixel.0.iter().map(|channel| i32::from(*channel)).sum::<i32>();
    let lighter = |one: &RgbImage, other: &RgbImage| {
        one.pixels().zip(other.pixels()).filter(|(one, other)| light(one) - light(other) > 40).count()
    };
    // Parts of the line are gone, none has come, and the edges and the other horizon are as they were.
    let (gone, come, drawn) = (lighter(&dashed, &whole), lighter(&whole, &dashed), lighter(&none, &dashed));
    assert!(gone > 80 && come == 0 && drawn > 500, "{gone}, {come}, {drawn}");
    // A map says how much of it is hatched, and a whole horizon's has no hatching.
    let map = |name: &str| {
        run_in(at, &format!("render p.petro map.svg --map {name} --size-cm 12x9")).done();
        fs::read_to_string(at.join("map.svg")).unwrap()
    };
    assert!(map("Sparse").contains("hatched: not picked (73 %)") && !map("Whole").contains("not picked"));
    let dotted = run_in(at, "render p.petro a.png --outlines dotted");
    assert!(dotted.code == 2 && dotted.stderr.contains("expected on, dashed or off"), "{}", dotted.stderr);
}
