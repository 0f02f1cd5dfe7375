//! Volumes into the store and out of it: bounded memory, every trace order, interruptions, SEG-Y again, attributes.

use crate::program::{Run, bytes, command, project, run_in};
use files::segy::{SegyOptions, WriteFormat, WriteOptions};
use std::fs;
use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, Instant};
use store::StoredVolume;
use survey::{Progress, SurveyGeometry, VerticalUnit, Volume};

/// Whole numbers below 2¹⁵ that no two neighbours share.
fn volume(size: [usize; 3]) -> Volume<f32> {
    let count: usize = size.iter().product();
    let samples = (0..count).map(|n| ((n * 7919) % 60_013) as f32 - 30_000.0).collect();
    Volume::from_samples(size, samples).unwrap()
}

/// A SEG-Y file with every eleventh trace missing.
fn write(path: &Path, size: [usize; 3], format: WriteFormat) -> Volume<f32> {
    let geometry = SurveyGeometry::regular(size, 12.5, 4.0, VerticalUnit::Milliseconds);
    let mut volume = volume(size);
    volume.set_live(Some((0..size[0] * size[1]).map(|n| n % 11 != 4).collect())).unwrap();
    let options = WriteOptions { format, ..WriteOptions::default() };
    files::segy::write(path, &geometry, &volume, &options, &Progress::silent()).unwrap();
    volume
}

fn same_live_samples(a: &Volume<f32>, b: &Volume<f32>) {
    assert_eq!((a.size(), a.live()), (b.size(), b.live()));
    let [nx, ny, _] = a.size();
    for (x, y) in (0..nx).flat_map(|x| (0..ny).map(move |y| (x, y))).filter(|&(x, y)| a.is_live(x, y)) {
        assert!(a.trace(x, y) == b.trace(x, y), "trace {x} {y}");
    }
}

#[test]
fn integers_stay_integers_in_the_store_and_come_back_exactly() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let original = write(&at.join("a.sgy"), [21, 33, 40], WriteFormat::Int16);
    let run = run_in(at, "import a.sgy p.petro --json").done();
    assert_eq!(run.json()["sample_type"], "int16");
    let stored = StoredVolume::open(&at.join("p.petro/volumes/seismic.zarr")).unwrap();
    assert_eq!(stored.type_name(), "int16");
    same_live_samples(&stored.read_f32(0, &Progress::silent()).unwrap(), &original);

    let first = files::segy::read(&at.join("a.sgy"), &SegyOptions::default(), &Progress::silent()).unwrap();
    for (line, code) in [("", 3), ("--format-code 3", 3), ("--format-code 5", 5), ("--format-code 1", 1)] {
        let run = run_in(at, &format!("export p.petro b.sgy --volume seismic {line} --json")).done();
        assert_eq!(run.json()["format_code"], code);
        let again = files::segy::read(&at.join("b.sgy"), &SegyOptions::default(), &Progress::silent()).unwrap();
        assert_eq!(again.info.format_code, code);
        assert_eq!(again.geometry, first.geometry);
        same_live_samples(&again.volume, &original);
        assert!(again.info.text.join("\n").contains("ORIGIN: VOLUME SEISMIC OF P.PETRO, FROM A.SGY"));
    }
    let run = run_in(at, "export p.petro c.sgy --volume seismic --format-code 8 --json").done();
    assert!(run.json()["clipped"].as_u64().unwrap() > 0);
    run_in(at, "export p.petro c.sgy --volume nothing").failed(&["nothing"]);
    for wrong in ["--volume seismic --format-code 4", "--volume seismic --horizon x", ""] {
        assert_eq!(run_in(at, &format!("export p.petro c.sgy {wrong}")).code, 2, "{wrong}");
    }
}

#[test]
fn two_trace_orders_and_three_memories_make_the_same_volume() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let size = [131, 140, 30];
    write(&at.join("a.sgy"), size, WriteFormat::Ieee32);
    let file = fs::read(at.join("a.sgy")).unwrap();
    let (head, traces) = file.split_at(3600);
    let mut traces: Vec<&[u8]> = traces.chunks(240 + size[2] * 4).collect();
    let lines = |trace: &[u8]| {
        let number = |at: usize| i32::from_be_bytes(trace[at..at + 4].try_into().unwrap());
        (number(192), number(188))
    };
    traces.sort_by_key(|trace| lines(trace));
    fs::write(at.join("b.sgy"), [head.to_vec(), traces.concat()].concat()).unwrap();

    run_in(at, "import a.sgy a.petro").done();
    run_in(at, "import a.sgy c.petro --memory 64K").done();
    run_in(at, "import b.sgy b.petro --memory 1M").done();
    let data = |name: &str| {
        let root = at.join(name).join("volumes/seismic.zarr");
        let stored = bytes(&root).into_iter();
        let stored = stored.map(|(path, content)| (path.strip_prefix(&root).unwrap().to_owned(), content));
        // The group's metadata name the file.
        stored.filter(|(path, _)| path != Path::new("zarr.json")).collect::<Vec<_>>()
    };
    assert!(data("a.petro") == data("c.petro"));
    assert!(data("a.petro") == data("b.petro"));
    assert_eq!(run_in(at, "import a.sgy d.petro --memory lots").code, 2);
}

#[test]
fn a_killed_import_shows_nothing_and_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    write(&at.join("a.sgy"), [300, 260, 260], WriteFormat::Ieee32);
    run_in(at, "import a.sgy whole.petro").done();
    let start = || {
        let mut child = command()
            .current_dir(at)
            .args(["import", "a.sgy", "p.petro", "--memory", "1K"])
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        // The second column of shards is begun: the first is there to go on with.
        let shard = at.join(".p.petro.new/importing/seismic.zarr/0/c/0/1/0");
        let begun = Instant::now();
        while !shard.exists() && child.try_wait().unwrap().is_none() && begun.elapsed() < Duration::from_secs(60) {
            std::thread::sleep(Duration::from_millis(1));
        }
        child
    };
    let mut child = start();
    child.kill().unwrap();
    let ended = child.wait().unwrap();
    assert!(!ended.success(), "it was done before it could be killed");
    assert!(!at.join("p.petro").exists());
    let run = run_in(at, "import a.sgy p.petro --memory 1M --json").done();
    assert!(run.json()["kept_files"].as_u64().unwrap() > 0, "{}", run.stdout);
    let volumes = |name: &str| bytes(&at.join(name).join("volumes")).into_values().collect::<Vec<_>>();
    assert!(volumes("p.petro") == volumes("whole.petro"));
    assert!(!at.join("p.petro/importing").exists());

    // Another source of the same name starts anew, and says so.
    fs::remove_dir_all(at.join("p.petro")).unwrap();
    let mut child = start();
    child.kill().unwrap();
    child.wait().unwrap();
    write(&at.join("a.sgy"), [300, 260, 261], WriteFormat::Ieee32);
    let run = run_in(at, "import a.sgy p.petro --json").done();
    assert_eq!(run.json()["kept_files"], 0);
    assert!(run.stderr.contains("starting anew"), "{}", run.stderr);
}

#[test]
fn attributes_are_volumes_like_any_other() {
    let folder = project();
    let at = folder.path();
    let read = |name: &str| StoredVolume::open(&at.join(format!("p.petro/volumes/{name}.zarr"))).unwrap();
    run_in(at, "attribute p.petro --kind semblance --name faults --memory 1M").done();
    let faults = read("faults").read_f32(0, &Progress::silent()).unwrap();
    assert!(faults.samples().iter().all(|value| (0.0..=1.0).contains(value)));
    run_in(at, "attribute p.petro --kind envelope --name strength --volume seismic").done();
    let (seismic, strength) = (read("seismic"), read("strength"));
    let [seismic, strength] = [seismic, strength].map(|v| v.read_f32(0, &Progress::silent()).unwrap());
    let is_above = seismic.samples().iter().zip(strength.samples()).filter(|(s, e)| s.abs() <= *e + 1e-3).count();
    assert_eq!(is_above, seismic.samples().len(), "a sample exceeds its envelope");
    let run = run_in(at, "attribute p.petro --kind dip --name dip --json").done();
    assert_eq!(run.json()["volumes"].as_array().unwrap().len(), 3);
    let listed = run_in(at, "volume list p.petro").done().stdout;
    for name in ["faults", "strength", "dip", "dip-inline", "dip-crossline"] {
        assert!(listed.contains(name), "{listed}");
    }
    run_in(at, "undo p.petro").done();
    assert!(!run_in(at, "volume list p.petro").done().stdout.contains("dip-inline"));
    run_in(at, "redo p.petro").done();

    let before = bytes(&at.join("p.petro"));
    run_in(at, "attribute p.petro --kind dip --name faults").failed(&["faults"]);
    run_in(at, "attribute p.petro --kind dip --name d --volume none").failed(&["none"]);
    run_in(at, "attribute p.petro --kind dip --name d --max-dip 99").failed(&["99", "32"]);
    assert_eq!(run_in(at, "attribute p.petro --kind colour --name d").code, 2);
    assert!(bytes(&at.join("p.petro")) == before);
    run_in(at, "create q.petro --bounds 0,100,0,100,0,100 --size 4x4x4").done();
    let none: Run = run_in(at, "attribute q.petro --kind envelope --name e");
    none.failed(&["no volume"]);
}
