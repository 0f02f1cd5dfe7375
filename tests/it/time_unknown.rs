//! Volumes that tell little or nothing of geologic time: a defined result that says where it is not known.

use crate::program::run_in;
use std::fs;
use std::path::Path;
use survey::{Progress, SurveyGeometry, VerticalUnit, Volume};

/// Imports a volume of made-up amplitudes.
fn import(at: &Path, size: [usize; 3], amplitude: impl Fn(usize, usize, usize) -> f32) {
    write(at, size, amplitude);
    run_in(at, "import a.sgy p.petro").done();
}

/// Writes a volume of made-up amplitudes.
fn write(at: &Path, size: [usize; 3], amplitude: impl Fn(usize, usize, usize) -> f32) {
    let [nx, ny, nz] = size;
    let samples = (0..nx * ny * nz).map(|n| amplitude(n / (ny * nz), n / nz % ny, n % nz)).collect();
    let volume = Volume::from_samples(size, samples).unwrap();
    let geometry = SurveyGeometry::regular(size, 25.0, 4.0, VerticalUnit::Milliseconds);
    let options = files::segy::WriteOptions::default();
    files::segy::write(&at.join("a.sgy"), &geometry, &volume, &options, &Progress::silent()).unwrap();
}

/// A number that looks like noise.
fn noise(x: usize, y: usize, z: usize) -> f32 {
    let mut state = (x as u32 * 7919) ^ (y as u32 * 104_729) ^ (z as u32 * 1_299_709) ^ 0x9E37_79B9;
    for _ in 0..3 {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
    }
    (state >> 8) as f32 / (1 << 23) as f32 - 1.0
}

fn bed(z: f32) -> f32 {
    (z * 0.7).sin() + 0.7 * (z * 0.43 + 1.0).sin()
}

/// Candidates and time of what was imported: the share that is known.
fn known(at: &Path) -> f64 {
    run_in(at, "extract p.petro").done();
    run_in(at, "time p.petro --json").done().json()["known"].as_f64().unwrap()
}

/// The exported samples of geologic time that are numbers, as a share of those on a part of the inlines.
fn known_on(at: &Path, size: [usize; 3], inlines: std::ops::Range<usize>) -> f64 {
    run_in(at, "export p.petro time.sgy --volume time --format-code 5").done();
    let bytes = fs::read(at.join("time.sgy")).unwrap();
    let [_, ny, nz] = size;
    let trace = 240 + 4 * nz;
    let mut count = 0;
    for n in inlines.clone().flat_map(|x| (0..ny).map(move |y| x * ny + y)) {
        let own = &bytes[3600 + n * trace + 240..3600 + (n + 1) * trace];
        let samples = own.chunks_exact(4).map(|b| f32::from_be_bytes([b[0], b[1], b[2], b[3]]));
        count += samples.filter(|time| time.is_finite() && *time != 0.0).count();
    }
    count as f64 / (inlines.len() * ny * nz) as f64
}

#[test]
fn one_trace_and_a_constant_volume_have_no_time_anywhere() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), [1, 1, 64], |_, _, z| bed(z as f32));
    run_in(folder.path(), "import a.sgy p.petro").failed(&["a single trace"]);
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), [1, 24, 64], |_, _, z| bed(z as f32));
    run_in(folder.path(), "import a.sgy p.petro").failed(&["a 2D line"]);
    for (size, constant) in [([2, 2, 64], false), ([2, 24, 64], false), ([24, 20, 48], true)] {
        let folder = tempfile::tempdir().unwrap();
        let at = folder.path();
        import(at, size, |_, _, z| if constant { 7.0 } else { bed(z as f32) });
        let extracted = run_in(at, "extract p.petro");
        if extracted.code != 0 {
            // Nothing can be extracted from it, which is said.
            extracted.failed(&[]);
            run_in(at, "time p.petro").failed(&["no horizon candidates"]);
            continue;
        }
        let told = run_in(at, "time p.petro").done().stdout;
        assert!(told.contains("known at 0.0 %") && told.contains("no candidates"), "{size:?}: {told}");
        let middle = format!("{},{},{}", 1 + size[0] / 2, 1 + size[1] / 2, 100);
        let refused = run_in(at, &format!("pick p.petro --at {middle} --horizon H --by-time"));
        assert!(refused.code == 1 && !refused.stderr.contains("panicked"), "{}", refused.stderr);
        run_in(at, "horizon stack p.petro S --count 2").failed(&["known nowhere"]);
        run_in(at, "attribute p.petro --kind flattened --name flat").done();
        run_in(at, "attribute p.petro --kind hiatus --name missing").done();
        let none = run_in(at, "illustrate a.sgy b.png --device cpu");
        none.failed(&["no level of geologic time"]);
    }
}

#[test]
fn chaos_has_time_only_beside_what_continues_and_never_out_of_order() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let size = [40, 32, 64];
    // Half of it has beds.
    import(at, size, |x, y, z| if x < 20 { bed(z as f32) } else { noise(x, y, z) });
    known(at);
    let [beds, rest] = [known_on(at, size, 2..18), known_on(at, size, 24..38)];
    assert!(beds > 0.9 && rest < 0.95 * beds, "{beds} of the beds, {rest} of the chaos");
}

#[test]
fn a_side_of_a_fault_without_any_event_stays_unknown() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let size = [40, 32, 64];
    import(at, size, |x, _, z| if x < 20 { bed(z as f32) } else { 0.0 });
    // Inlines and crosslines are numbered from 1.
    run_in(at, "fault pick p.petro --name F --stick 20.5,1,0 20.5,1,252 --stick 20.5,32,0 20.5,32,252").done();
    let share = known(at);
    assert!((0.3..0.6).contains(&share), "{share}");
    let [known_side, silent] = [known_on(at, size, 2..18), known_on(at, size, 23..40)];
    assert!(known_side > 0.9 && silent == 0.0, "{known_side} {silent}");
    let picked = run_in(at, "pick p.petro --at 10,16,120 --horizon H --by-time --json").done().json();
    assert!((0.4..0.56).contains(&picked["coverage"].as_f64().unwrap()), "nothing is invented beyond it: {picked}");
    run_in(at, "pick p.petro --at 30,16,120 --horizon None --by-time").failed(&["not known at inline 30"]);
}
