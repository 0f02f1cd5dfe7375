//! Files that are cut off, changed or damaged while the program reads them: an error that names the file and the place, and nothing
//! wrong is stored or shown.

use crate::program::{Run, begin_in, bytes, project, run_in};
use files::segy::WriteOptions;
use std::fs::{self, File};
use std::os::unix::fs::FileExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;
use survey::{Progress, SurveyGeometry, VerticalUnit, Volume};

/// Large enough that an import or an attribute goes on for a while after it began.
const SIZE: [usize; 3] = [260, 260, 180];

/// How often something that has to happen in the middle is tried, since a run may be over before.
const TRIES: usize = 10;

/// Writes noise to `a.sgy`.
fn write_survey(at: &Path) -> PathBuf {
    let path = at.join("a.sgy");
    let samples = (0..SIZE.iter().product::<usize>()).map(|n| (n * 7919 % 60_013) as f32 - 30_000.0).collect();
    let volume = Volume::from_samples(SIZE, samples).unwrap();
    let geometry = SurveyGeometry::regular(SIZE, 12.5, 4.0, VerticalUnit::Milliseconds);
    files::segy::write(&path, &geometry, &volume, &WriteOptions::default(), &Progress::silent()).unwrap();
    path
}

/// Runs the program, stops it as soon as `has_begun`, and lets it go on after `meddle`; none when it was over before.
fn meddled(at: &Path, line: &str, has_begun: impl Fn() -> bool, meddle: impl FnOnce()) -> Option<Run> {
    let child = begin_in(at, line);
    let signal = |name: &str| {
        let sent = Command::new("kill").args([name, &child.id().to_string()]).stderr(Stdio::null()).status();
        assert!(sent.is_ok(), "`kill` is there");
    };
    let is_stopped = || {
        let status = fs::read_to_string(format!("/proc/{}/stat", child.id())).unwrap_or_default();
        // The state follows the name in brackets: T is stopped, Z is over.
        status.rsplit(") ").next().and_then(|state| state.chars().next())
    };
    while !has_begun() && is_stopped() != Some('Z') {
        std::thread::sleep(Duration::from_micros(100));
    }
    signal("-STOP");
    let is_running = loop {
        match is_stopped() {
            Some('T') => break true,
            Some('Z') | None => break false,
            _ => std::thread::sleep(Duration::from_micros(100)),
        }
    };
    if is_running {
        meddle();
    }
    signal("-CONT");
    let run = Run::of(&child.wait_with_output().expect("the program ends"));
    is_running.then_some(run)
}

/// Whether the import of a new project in a folder has begun to store samples.
fn is_importing(at: &Path) -> bool {
    let entries = fs::read_dir(at).into_iter().flatten().flatten();
    entries.into_iter().any(|entry| entry.path().join("importing/seismic.zarr/0").is_dir())
}

/// Imports `a.sgy` and meddles with it once the import has begun, until `is_told` of what the program says. Whatever it says, it has
/// failed, and nothing is stored.
fn import_fails(meddle: impl Fn(&Path), is_told: impl Fn(&str) -> bool) {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let path = write_survey(at);
    let whole = fs::read(&path).unwrap();
    let mut told = Vec::new();
    for _ in 0..TRIES {
        fs::write(&path, &whole).unwrap();
        let run = meddled(at, "import a.sgy p.petro --memory 1", || is_importing(at), || meddle(&path));
        let _ = fs::remove_file(&path);
        let Some(run) = run else {
            fs::remove_dir_all(at.join("p.petro")).unwrap();
            continue;
        };
        let run = run.failed(&["a.sgy"]);
        assert_eq!(fs::read_dir(at).unwrap().count(), 0, "something was stored: {}", run.stderr);
        if is_told(&run.stderr) {
            return;
        }
        told.push(run.stderr);
    }
    panic!("never in the middle: {told:?}");
}

#[test]
fn a_file_cut_off_during_import_is_an_error_with_the_trace() {
    let cut = |path: &Path| File::options().write(true).open(path).unwrap().set_len(1_000_000).unwrap();
    import_fails(cut, |told| {
        told.contains("cut off while it was read")
            && told.contains("trace ")
            && told.contains("1000000 now")
            && told.contains("hint: import it again when it is whole")
    });
}

#[test]
fn a_file_that_changes_during_import_is_not_stored() {
    let write_in_the_middle = |path: &Path| {
        let file = File::options().write(true).open(path).unwrap();
        file.write_all_at(&[1, 2, 3], file.metadata().unwrap().len() / 2).unwrap();
    };
    import_fails(write_in_the_middle, |told| told.contains("changed while it was read (its time of modification"));
    let append = |path: &Path| {
        let file = File::options().write(true).open(path).unwrap();
        file.write_all_at(&[0; 100], file.metadata().unwrap().len()).unwrap();
    };
    import_fails(append, |told| told.contains("changed while it was read (it had "));
}

#[test]
fn a_change_that_hides_its_time_is_noticed_by_the_bytes() {
    let rewrite = |path: &Path| {
        let file = File::options().write(true).open(path).unwrap();
        let modified = file.metadata().unwrap().modified().unwrap();
        let length = file.metadata().unwrap().len();
        file.write_all_at(&vec![0x41; 1 << 20], length / 2).unwrap();
        file.write_all_at(&[0x41; 1000], length - 1000).unwrap();
        file.set_modified(modified).unwrap();
    };
    import_fails(rewrite, |told| told.contains("changed while it was read (its bytes are others)"));
}

/// Turns a bit of a sample of the only brick of the volume of [`project`].
fn turn_a_bit(root: &Path, [x, y, z]: [u64; 3]) {
    let file = File::options().read(true).write(true).open(root.join("volumes/seismic.zarr/0/c/0/0/0")).unwrap();
    let mut byte = [0];
    // 48 × 40 × 56 floats.
    let at = ((x * 40 + y) * 56 + z) * 4;
    file.read_exact_at(&mut byte, at).unwrap();
    file.write_all_at(&[byte[0] ^ 1], at).unwrap();
}

#[test]
fn a_section_refuses_a_wrong_bit_and_names_the_brick() {
    let folder = project();
    let at = folder.path();
    let seismic =
        files::segy::scan(&at.join("s/survey.sgy"), &files::segy::SegyOptions::default(), &Progress::silent()).unwrap();
    let inline = |index: i32| seismic.inlines.first + index * seismic.inlines.step;
    let crossline = |index: i32| seismic.crosslines.first + index * seismic.crosslines.step;
    turn_a_bit(&at.join("p.petro"), [20, 11, 30]);
    let words = ["seismic.zarr", "c/0/0/0", "the brick [0, 0, 0]", "checksum", "import the data again"];
    let size = "--interpretation --size 200x150";
    run_in(at, &format!("render p.petro a.png {size} --inline {}", inline(20))).failed(&words);
    run_in(at, &format!("render p.petro a.png {size} --crossline {}", crossline(11))).failed(&words);
    assert!(!at.join("a.png").exists());
    run_in(at, "export p.petro out.sgy --volume seismic").failed(&words);
    run_in(at, "attribute p.petro --kind envelope --name envelope").failed(&words);
}

#[test]
fn a_shard_cut_off_is_an_error_for_every_reader() {
    let folder = project();
    let at = folder.path();
    let shard = at.join("p.petro/volumes/seismic.zarr/0/c/0/0/0");
    let whole = fs::read(&shard).unwrap();
    for length in [0, 1000, whole.len() / 2, whole.len() - 1] {
        fs::write(&shard, &whole[..length]).unwrap();
        for line in [
            "export p.petro out.sgy --volume seismic",
            "attribute p.petro --kind semblance --name semblance",
            "extract p.petro",
        ] {
            run_in(at, line).failed(&["seismic.zarr", "c/0/0/0", "import the data again"]);
        }
    }
}

#[test]
fn a_shard_cut_off_while_an_attribute_is_computed_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    write_survey(at);
    run_in(at, "import a.sgy p.petro").done();
    let root = at.join("p.petro");
    // Its first lines belong to what the first block is computed from, so that it is known by then.
    let shard = root.join("volumes/seismic.zarr/0/c/0/1/0");
    let whole = fs::read(&shard).unwrap();
    let before = bytes(&root.join("volumes"));
    let has_stored_a_block = || {
        let entries = fs::read_dir(root.join("unfinished/volumes")).into_iter().flatten().flatten();
        entries.into_iter().any(|entry| entry.path().join("0/c/0/0/0").is_file())
    };
    for _ in 0..TRIES {
        let cut = || File::options().write(true).open(&shard).unwrap().set_len(1000).unwrap();
        let line = "attribute p.petro --kind semblance --name semblance --memory 1";
        let run = meddled(at, line, has_stored_a_block, cut);
        fs::write(&shard, &whole).unwrap();
        if let Some(run) = run.filter(|run| run.code != 0) {
            run.failed(&["seismic.zarr", "c/0/1/0", "import the data again"]);
            assert!(bytes(&root.join("volumes")) == before, "something of it was kept");
            return;
        }
        run_in(at, "undo p.petro").done();
    }
    panic!("never in the middle");
}
