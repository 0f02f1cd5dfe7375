//! Animations: what is written, and what is refused.

use crate::program::{project, run_in};
use std::fs;
use std::path::Path;

const SMALL: &str = "--size 80x60 --samples 1 --device cpu";

/// The numbered frames that a motion gives.
fn frames(at: &Path, options: &str) -> Vec<image::RgbaImage> {
    let folder = at.join("frames");
    if folder.exists() {
        fs::remove_dir_all(&folder).unwrap();
    }
    run_in(at, &format!("animate p.petro frames {options} {SMALL}")).done();
    let mut files: Vec<_> = fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    assert_eq!(files[0].file_name().unwrap(), "0001.png");
    files.iter().map(|file| image::open(file).unwrap().to_rgba8()).collect()
}

#[test]
fn every_motion_moves_and_begins_with_the_scene() {
    let folder = project();
    let at = folder.path();
    run_in(at, "scene add p.petro from --azimuth 20 --cut nearest,0.3,0.3").done();
    run_in(at, "scene add p.petro to --azimuth 120 --zoom 1.5 --cut nearest,0.6,0.6 --blend 1").done();
    let still = |options: &str| {
        run_in(at, &format!("render p.petro still.png {options} {SMALL}")).done();
        image::open(at.join("still.png")).unwrap().to_rgba8()
    };
    for motion in ["turntable", "blend", "section", "section --along slice"] {
        let made = frames(at, &format!("--motion {motion} --frames 4 --scene from"));
        assert_eq!(made.len(), 4);
        assert!(made[0] != made[1] && made[1] != made[2], "{motion}");
        // There and back again, but for a turn.
        assert_eq!(made[1] == made[3], motion != "turntable", "{motion}");
    }
    let made = frames(at, "--frames 3 --scene from --to to --once");
    assert!(made[0] == still("--scene from") && made[2] == still("--scene to"));
    let made = frames(at, "--motion blend --frames 2 --scene from --once --rate 3");
    assert!(made[0] == still("--scene from") && made[1] == still("--scene from --blend 1"));
}

#[test]
fn animated_files_hold_the_frames() {
    let folder = project();
    let at = folder.path();
    let made = frames(at, "--frames 3");
    let told = run_in(at, &format!("animate p.petro turn.png --frames 3 --rate 10 {SMALL} --json")).done().json();
    assert_eq!((told["frames"].as_u64(), told["size_px"][1].as_u64()), (Some(3), Some(60)));
    assert_eq!(told["bytes"].as_u64(), Some(fs::metadata(at.join("turn.png")).unwrap().len()));
    // A reader of still pictures sees the first frame.
    assert!(image::open(at.join("turn.png")).unwrap().to_rgba8() == made[0]);
    run_in(at, &format!("animate p.petro turn.gif --frames 3 --rate 10 {SMALL}")).done();
    let gif = fs::read(at.join("turn.gif")).unwrap();
    assert_eq!((&gif[..6], gif[6..10].to_vec()), (&b"GIF89a"[..], vec![80, 0, 60, 0]));
    assert_eq!(gif.last(), Some(&0x3b));
    // The same again is the same file.
    run_in(at, &format!("animate p.petro again.gif --frames 3 --rate 10 {SMALL}")).done();
    assert!(fs::read(at.join("again.gif")).unwrap() == gif);
}

#[test]
fn what_cannot_be_made_is_said_and_leaves_nothing() {
    let folder = project();
    let at = folder.path();
    let usage = |line: &str, words: &str| {
        let run = run_in(at, &format!("animate p.petro {line}"));
        assert_eq!(run.code, 2, "{line}: {}", run.stderr);
        assert!(run.stderr.contains(words), "{line}: {}", run.stderr);
    };
    usage("a.webp", "numbered frames");
    usage("a.mp4", "ffmpeg");
    usage("a.gif --frames 1", "2 to 2000");
    usage("a.gif --frames 9999", "2 to 2000");
    usage("a.gif --rate 0", "frames a second");
    usage("a.gif --turn 0", "--turn");
    usage("a.gif --motion spin", "turntable, blend, section, history or scenes");
    usage("a.gif --motion scenes", "--to");
    usage("a.gif --motion blend --to x", "--to");
    usage("a.gif --motion section --along depth", "inline, crossline or slice");
    run_in(at, "animate p.petro a.gif --size 5000x100").failed(&["too large for an animation", "4096"]);
    run_in(at, "animate p.petro a.gif --to nowhere").failed(&["nowhere"]);
    run_in(at, "animate p.petro p.petro/a.gif --frames 2").failed(&["project"]);
    fs::create_dir(at.join("full")).unwrap();
    fs::write(at.join("full/mine.txt"), "mine").unwrap();
    run_in(at, "animate p.petro full --frames 2").failed(&["not empty"]);
    assert_eq!(fs::read_to_string(at.join("full/mine.txt")).unwrap(), "mine");
    assert!(!at.join("a.gif").exists());
    run_in(at, "create q.petro --bounds 0,900,0,900,0,900 --size 9x9x9").done();
    run_in(at, "animate q.petro a.gif").failed(&["nothing to draw"]);
}
