//! Cuts in any direction through the binary: fences through lines and wells, shafts, planes, scenes that hold them, and
//! what cannot be cut.

use crate::program::{project, run_in};
use image::RgbImage;
use std::fs;
use std::path::Path;

const VIEW: &str = "--size 160x120 --samples 1 --device cpu --ground off --background #ff00ff --outlines off";

fn picture(at: &Path, options: &str) -> RgbImage {
    run_in(at, &format!("render p.petro a.png {VIEW} {options}")).done();
    image::open(at.join("a.png")).unwrap().to_rgb8()
}

/// Pixels of the background.
fn empty(image: &RgbImage) -> usize {
    image.pixels().filter(|p| p.0 == [255, 0, 255]).count()
}

fn differing(a: &RgbImage, b: &RgbImage) -> usize {
    a.pixels().zip(b.pixels()).filter(|(a, b)| a != b).count()
}

#[test]
fn a_block_is_cut_along_fences_shafts_and_planes() {
    let folder = project();
    let at = folder.path();
    let whole = picture(at, "--cut-box 101,102,501,502,0,10");
    // North of a line from west to east, which the camera sees from the south.
    let view = "--azimuth 0 --elevation 35";
    let fence = picture(at, &format!("{view} --cut-fence 101,520 148,520"));
    let boxed = picture(at, &format!("{view} --cut-box 101,148,501,520,0,550"));
    assert!(differing(&fence, &boxed) < 40, "a straight fence is a box: {}", differing(&fence, &boxed));
    let other = picture(at, &format!("{view} --cut-fence 101,520 148,520 --cut-side left"));
    assert!(differing(&fence, &other) > 2000, "{}", differing(&fence, &other));
    let bent = "--cut-fence 101,512 120,525 148,515 --cut-depth 0,300";
    let [straight, smooth] = [bent.to_owned(), format!("{bent} --cut-smooth")].map(|cut| picture(at, &cut));
    assert!((50..4000).contains(&differing(&straight, &smooth)), "{}", differing(&straight, &smooth));
    let shaft = picture(at, "--cut-round 112,512,180");
    let plane = picture(at, "--cut-plane 125,520,275,200,40");
    assert!(empty(&plane) > empty(&whole) + 500, "{} {}", empty(&plane), empty(&whole));
    assert_eq!(empty(&shaft), empty(&whole), "a shaft lies within the block");
    assert!(differing(&shaft, &whole) > 200, "{}", differing(&shaft, &whole));
    // In paths as in pixels.
    run_in(at, "render p.petro a.svg --cut-plane 125,520,275,200,40 --cut-round 112,512,180").done();
    assert!(fs::read_to_string(at.join("a.svg")).unwrap().contains("<path"));
}

#[test]
fn a_scene_keeps_its_cuts_and_a_fence_leads_through_wells() {
    let folder = project();
    let at = folder.path();
    fs::write(at.join("w.csv"), "md_m,inc,azi\n0,0,0\n500,0,0\n").unwrap();
    for (name, x) in [("A-1", 430_300), ("B 2", 430_900)] {
        run_in(at, &format!("well add p.petro w.csv --name '{name}' --head {x},6780300 --kb 0")).done();
    }
    run_in(at, "scene add p.petro fence --cut-fence well:A-1 130,520 'well:B 2' --cut-round 140,510,100").done();
    let saved = fs::read_to_string(at.join("p.petro/project.toml")).unwrap();
    assert!(saved.contains("cut_shapes") && saved.contains("fence = [") && saved.contains("outline = ["), "{saved}");
    let scene = picture(at, "--scene fence");
    let typed = picture(at, "--cut-fence 113,513 130,520 137,513 --cut-round 140,510,100");
    // A head lies within rounding of its lines.
    assert!(differing(&scene, &typed) < 20, "{}", differing(&scene, &typed));
    run_in(at, "render p.petro a.png --cut-fence well:A-1 well:C").failed(&["no well `C`", "A-1, B 2"]);
    run_in(at, "render p.petro a.png --cut-fence 101,501 130,530 130,510 105,525").failed(&["crosses itself"]);
    run_in(at, "render p.petro a.png --cut-round 140,510,100 --cut-depth 200,200").failed(&["depths"]);
    // A cut beside the block is a mistake in a number, and is said to be one.
    run_in(at, "render p.petro a.png --cut-round 64,64,100").failed(&["--cut-round", "beside the block", "101 to 148"]);
    run_in(at, "render p.petro a.png --cut-plane 125,520,5000,200,40").failed(&["--cut-plane", "nothing of it"]);
}
