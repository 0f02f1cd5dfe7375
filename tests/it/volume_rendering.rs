//! Volume rendering: by `--technique`, in cut-outs, and what is refused.

use crate::program::{project, run_in, survey};
use image::RgbImage;
use std::path::Path;

const SMALL: &str = "--size 120x96 --samples 1 --device cpu";

fn picture(at: &Path, options: &str) -> RgbImage {
    run_in(at, &format!("render p.petro a.png {SMALL} {options}")).done();
    image::open(at.join("a.png")).unwrap().to_rgb8()
}

/// Pixels lighter than grey.
fn light(image: &RgbImage) -> usize {
    image.pixels().filter(|p| p.0[0] > 150).count()
}

#[test]
fn a_volume_alone_is_rendered_in_three_ways() {
    let folder = survey();
    let at = folder.path();
    run_in(at, "import s/survey.sgy p.petro").done();
    let pictures = ["occlusion", "phong", "volume"].map(|technique| picture(at, &format!("--technique {technique}")));
    for (n, image) in pictures.iter().enumerate() {
        assert!(light(image) > 300, "{n}: {} light pixels", light(image));
        assert!(image.pixels().all(|p| p.0[0].abs_diff(p.0[2]) < 24), "{n}: the function is white");
        assert!(pictures[..n].iter().all(|other| other != image), "{n}");
    }
    // Occlusion takes light away, nowhere gives it.
    let [occluded, _, unshaded] = &pictures;
    assert!(occluded.pixels().zip(unshaded.pixels()).all(|(a, b)| a.0[0] <= b.0[0].saturating_add(1)));
    // With less that is clear there is more to see.
    assert!(light(&picture(at, "--technique volume --clear-below -0.5")) > light(unshaded));
    run_in(at, "render p.petro a.png --technique volume --medium other").failed(&["other"]);
}

#[test]
fn a_cut_out_is_filled_with_a_volume_in_the_layers_that_have_an_opacity() {
    let folder = project();
    let at = folder.path();
    let view = "--cut nearest,0.6,0.6 --ground off";
    let empty = picture(at, view);
    let filled = picture(at, &format!("{view} --medium seismic --clear-below 0"));
    assert!(empty != filled);
    run_in(at, "layer set p.petro 'above Alpha' --opacity 0.01").done();
    let thin = picture(at, &format!("{view} --medium seismic --clear-below 0"));
    let differing = |a: &RgbImage, b: &RgbImage| a.pixels().zip(b.pixels()).filter(|(a, b)| a != b).count();
    assert!(differing(&empty, &thin) < differing(&empty, &filled), "only one layer is left standing");
    let shown = run_in(at, &format!("render p.petro a.png {SMALL} --technique occlusion --json")).done().json();
    assert!(shown["assumptions"].to_string().contains("volume rendering of"));
    let rock = picture(at, view);
    assert!(picture(at, &format!("{view} --show leaves")) != rock);
    assert!(picture(at, &format!("{view} --show distance")) != rock);
    let shown = picture(at, "--technique occlusion --horizon Alpha,#ff0000 --scope near");
    assert!(shown.pixels().filter(|p| p.0[0] > 90 && p.0[1] < 40).count() > 200, "the horizon is red");
    run_in(at, "render p.petro a.png --technique occlusion --horizon Omega").failed(&["Omega"]);
}

#[test]
fn surfaces_stripes_translucent_ground_and_coarse_volumes_are_drawn() {
    let folder = project();
    let at = folder.path();
    // A surface of k' by itself, and of a volume.
    let surface = picture(at, "--technique phong --isosurface k,2.5,#ff0000 --outlines off --ground off");
    assert!(surface.pixels().filter(|p| p.0[0] > 60 && p.0[1] < 50 && p.0[2] < 60).count() > 100, "a red surface");
    picture(at, "--technique occlusion --isosurface impedance,6000000,#00ff00,0.5");
    run_in(at, "render p.petro a.png --isosurface nothing,3").failed(&["nothing"]);
    assert_eq!(run_in(at, "render p.petro a.png --isosurface seismic").code, 2);
    // Stripes of two kinds of light.
    let [phong, occlusion, both] =
        ["phong", "occlusion", "interleaved"].map(|technique| picture(at, &format!("--technique {technique}")));
    for x in 0..both.width() {
        let whole = if x * 8 / both.width() % 2 == 0 { &phong } else { &occlusion };
        assert!((0..both.height()).all(|y| both.get_pixel(x, y) == whole.get_pixel(x, y)), "column {x}");
    }
    // Ground that lets light through, over white.
    let ground = |opacity: &str| picture(at, &format!("--ground on --ground-opacity {opacity}"));
    assert!(light(&ground("0.3")) > light(&ground("1")));
    assert_eq!(run_in(at, "render p.petro a.png --ground on --ground-opacity 2").code, 1);
    // A volume that does not fit, by every second sample.
    run_in(at, "synth t --size 72x24x48 --seed 3 --snr 9").done();
    run_in(at, "import t/survey.sgy q.petro").done();
    let whole = |options: &str| {
        let line = format!("render q.petro a.png {SMALL} --technique volume --clear-below -0.5 {options}");
        let run = run_in(at, &line).done();
        (run.stderr, image::open(at.join("a.png")).unwrap().to_rgb8())
    };
    let (fine, coarse) = (whole(""), whole("--volume-memory 100K"));
    assert!(!fine.0.contains("one sample in") && coarse.0.contains("one sample in 2"), "{} {}", fine.0, coarse.0);
    let apart = |(a, b): (&image::Rgb<u8>, &image::Rgb<u8>)| u32::from(a.0[0].abs_diff(b.0[0]));
    let mean = fine.1.pixels().zip(coarse.1.pixels()).map(apart).sum::<u32>() / (fine.1.width() * fine.1.height());
    assert!(fine.1 != coarse.1 && mean < 40, "{mean}");
}
