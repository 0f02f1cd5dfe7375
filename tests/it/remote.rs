//! A volume that stays in object storage, or goes there: linked, drawn, written, and the ways in which a storage fails.

use crate::program::{Run, bytes, command, run_in, words};
use std::fs;
use std::path::Path;
use std::sync::atomic::Ordering;
use tempfile::TempDir;
use testdata::s3::Server;

/// A project with a volume, and the same volume in a storage.
fn storage(size: &str) -> (TempDir, Server) {
    let folder = tempfile::tempdir().unwrap();
    run_in(folder.path(), &format!("synth s --size {size} --seed 3")).done();
    run_in(folder.path(), "import s/survey.sgy p.petro").done();
    let server = Server::start("surveys").unwrap();
    let volumes = folder.path().join("p.petro/volumes");
    let volume = fs::read_dir(&volumes).unwrap().flatten().next().unwrap().path();
    server.put_folder("north.zarr", &volume).unwrap();
    (folder, server)
}

/// Runs the program with a storage and a cache of its own.
fn run_with(at: &Path, server: &Server, line: &str) -> Run {
    let mut command = command();
    command
        .current_dir(at)
        .env("AWS_ENDPOINT_URL", server.endpoint())
        .env("AWS_REGION", "eu-north-1")
        .env("AWS_ACCESS_KEY_ID", "KEY-OF-TEST")
        .env("AWS_SECRET_ACCESS_KEY", "SECRET-OF-TEST")
        .env("PETROGLYPH_CACHE", at.join("cache"))
        .env("PETROGLYPH_CACHE_BYTES", "4000000")
        .env("PETROGLYPH_REMOTE_TIMEOUT", "5")
        .args(words(line));
    Run::of(&command.output().unwrap())
}

/// Both projects show about the same range of amplitudes, though few bricks of the linked volume were read.
fn assert_alike_clips(at: &Path) {
    let clip = |project: &str| -> f64 {
        let text = fs::read_to_string(at.join(project).join("project.toml")).unwrap();
        text.lines().find_map(|line| line.strip_prefix("clip = ")).unwrap().parse().unwrap()
    };
    let (near, far) = (clip("p.petro"), clip("r.petro"));
    assert!((far / near - 1.0).abs() < 0.15, "{far} of a linked volume, {near} of its copy");
}

/// All that is in a folder, as one text.
fn all_bytes(folder: &Path) -> Vec<u8> {
    bytes(folder).into_values().flatten().collect()
}

fn holds(content: &[u8], text: &str) -> bool {
    content.windows(text.len()).any(|part| part == text.as_bytes())
}

#[test]
fn a_linked_volume_is_drawn_like_its_copy_and_linking_reads_few_of_its_bricks() {
    let (folder, server) = storage("200x180x220");
    let at = folder.path();
    run_with(at, &server, "volume link r.petro s3://surveys/north.zarr").done();
    assert_alike_clips(at);
    let linked = server.counters.bytes.load(Ordering::Relaxed);
    assert!(linked < server.total_bytes() / 4, "linking read {linked} of {} bytes", server.total_bytes());
    let facts = run_with(at, &server, "volume list r.petro --json").done().stdout;
    assert!(facts.contains("s3://surveys/north.zarr"), "{facts}");
    for project in ["p", "r"] {
        run_with(at, &server, &format!("raw {project}.petro --map seismics --range -900,900")).done();
    }
    server.forget();
    run_with(at, &server, "render r.petro far.png --inline 210 --size-cm 8x5").done();
    let read = server.counters.bytes.load(Ordering::Relaxed);
    assert!(read > 0 && read < server.total_bytes(), "a section read {read} of {} bytes", server.total_bytes());
    run_in(at, "render p.petro near.png --inline 210 --size-cm 8x5").done();
    assert!(fs::read(at.join("far.png")).unwrap() == fs::read(at.join("near.png")).unwrap());
    // The cache stays below its limit, and nothing tells the credentials.
    assert!(all_bytes(&at.join("cache")).len() <= 4_000_000);
    for folder in ["r.petro", "cache"] {
        let content = all_bytes(&at.join(folder));
        assert!(!holds(&content, "SECRET-OF-TEST") && !holds(&content, "KEY-OF-TEST"), "{folder}");
    }
}

#[test]
fn a_storage_that_fails_is_tried_again_and_then_a_sentence() {
    let (folder, server) = storage("70x70x80");
    let at = folder.path();
    let link = "volume link r.petro s3://surveys/north.zarr";
    let nothing_left = |at: &Path| !at.join("r.petro").exists();
    for (line, words) in [
        ("volume link r.petro s3://others/north.zarr", ["no such bucket", "others"]),
        ("volume link r.petro s3://surveys/south.zarr", ["no such bucket or object", "south"]),
        ("volume link r.petro https://me:secret@example.org/north.zarr", ["environment", "credentials"]),
    ] {
        run_with(at, &server, line).failed(&words);
        assert!(nothing_left(at), "{line}");
    }
    server.counters.errors.store(1000, Ordering::Relaxed);
    run_with(at, &server, link).failed(&["tries failed", "try again later"]);
    server.counters.errors.store(2, Ordering::Relaxed);
    server.counters.drops.store(2, Ordering::Relaxed);
    run_with(at, &server, link).done();
    // A reply that is late is asked for again.
    server.counters.delay_ms.store(8000, Ordering::Relaxed);
    server.counters.delayed.store(1, Ordering::Relaxed);
    run_with(at, &server, "info r.petro").done();
    // A damaged brick is noticed, and so is a volume that was replaced.
    let draw = "render r.petro a.png --inline 130 --size-cm 8x5";
    server.change("north.zarr/0/c/0/0/0", |bytes| bytes[1000] ^= 1);
    run_with(at, &server, draw).failed(&["damaged", "checksum"]);
    server.change("north.zarr/0/zarr.json", |bytes| bytes.push(b'\n'));
    run_with(at, &server, draw).failed(&["has changed since it was linked"]);
    // Chunks of another kind cannot be linked.
    server.change("north.zarr/0/zarr.json", |bytes| {
        let text = String::from_utf8(bytes.clone()).unwrap().replace("\"crc32c\"", "\"other\"");
        *bytes = text.into_bytes();
    });
    run_with(at, &server, "volume link q.petro s3://surveys/north.zarr").failed(&["north.zarr", "not stored as"]);
    assert!(!at.join("q.petro").exists());
}

/// The same without credentials.
fn run_unsigned(at: &Path, server: &Server, line: &str) -> Run {
    let mut command = command();
    command.current_dir(at).env("AWS_ENDPOINT_URL", server.endpoint()).env("AWS_REGION", "eu-north-1");
    for name in ["AWS_ACCESS_KEY_ID", "AWS_SECRET_ACCESS_KEY", "AWS_SESSION_TOKEN"] {
        command.env_remove(name);
    }
    Run::of(&command.args(words(line)).output().unwrap())
}

/// A project with a volume of several files and an attribute of it, and a storage with an empty bucket.
fn project_and_bucket() -> (TempDir, Server) {
    let folder = tempfile::tempdir().unwrap();
    run_in(folder.path(), "synth s --size 140x70x150 --seed 3").done();
    run_in(folder.path(), "import s/survey.sgy p.petro").done();
    run_in(folder.path(), "attribute p.petro --kind envelope --name strength").done();
    (folder, Server::start("surveys").unwrap())
}

#[test]
fn a_volume_and_an_attribute_written_to_a_storage_are_drawn_from_there() {
    let (folder, server) = project_and_bucket();
    let at = folder.path();
    for volume in ["seismic", "strength"] {
        let done = run_with(at, &server, &format!("export p.petro s3://surveys/north/{volume}.zarr --volume {volume}"));
        assert!(done.done().stdout.contains("Zarr v3"));
    }
    // Object by object what the project holds.
    let found = fs::read_dir(at.join("p.petro/volumes")).unwrap().flatten();
    let local = found.map(|entry| entry.path()).find(|path| path.to_string_lossy().contains("strength")).unwrap();
    let files = bytes(&local);
    for (path, content) in &files {
        let key = path.strip_prefix(&local).unwrap().to_string_lossy().into_owned();
        assert!(server.object(&format!("north/strength.zarr/{key}")).as_ref() == Some(content), "{key}");
    }
    assert_eq!(server.keys().iter().filter(|key| key.starts_with("north/strength.zarr/")).count(), files.len());
    for (project, volume) in [("r.petro", "seismic"), ("r.petro", "strength")] {
        run_with(at, &server, &format!("volume link {project} s3://surveys/north/{volume}.zarr --name {volume}"))
            .done();
    }
    for project in ["p", "r"] {
        run_with(at, &server, &format!("raw {project}.petro --volume strength --map grey --range 0,900")).done();
        run_with(at, &server, &format!("render {project}.petro {project}.png --inline 110 --size-cm 8x5")).done();
    }
    assert!(fs::read(at.join("p.png")).unwrap() == fs::read(at.join("r.png")).unwrap());
    // By plain HTTP too.
    let plain = format!("{}/surveys/plain.zarr", server.endpoint());
    run_in(at, &format!("export p.petro {plain} --volume seismic")).done();
    assert!(server.object("plain.zarr/0/c/1/0/1") == server.object("north/seismic.zarr/0/c/1/0/1"));
    // What is linked is not copied through here, and what is there is not replaced.
    let again = "export r.petro s3://surveys/copy.zarr --volume seismic";
    run_with(at, &server, again).failed(&["lies in object storage itself", "s3://surveys/north/seismic.zarr"]);
    let twice = "export p.petro s3://surveys/north/seismic.zarr --volume strength";
    run_with(at, &server, twice).failed(&["there is something under this address"]);
}

#[test]
fn a_storage_that_does_not_take_a_volume_has_none_of_it() {
    let (folder, server) = project_and_bucket();
    let at = folder.path();
    let export = "export p.petro s3://surveys/north.zarr --volume seismic";
    // No such bucket, no credentials, credentials in the address, nobody there, what is no volume.
    run_with(at, &server, "export p.petro s3://others/north.zarr --volume seismic").failed(&[
        "others",
        "could not be written",
        "no such bucket",
    ]);
    server.counters.private.store(true, Ordering::Relaxed);
    run_unsigned(at, &server, export).failed(&["refuses it", "AWS_ACCESS_KEY_ID"]);
    run_with(at, &server, export).done();
    server.counters.private.store(false, Ordering::Relaxed);
    let keys = server.keys();
    keys.iter().for_each(|key| server.remove(key));
    run_in(at, "export p.petro https://me:secret@example.org/north.zarr --volume seismic").failed(&["environment"]);
    let misused = run_with(at, &server, "export p.petro s3://surveys/top.csv --candidates");
    assert_eq!(misused.code, 2, "{}", misused.stderr);
    // One that is full in the middle: what it took is removed, the header was not among it.
    server.counters.most_objects.store(keys.len() / 2, Ordering::Relaxed);
    run_with(at, &server, export).failed(&["could not be written", "5 tries failed", "try again later"]);
    assert_eq!(server.keys(), Vec::<String>::new());
    server.counters.most_objects.store(keys.len() - 1, Ordering::Relaxed);
    run_with(at, &server, export).failed(&["north.zarr/zarr.json", "5 tries failed"]);
    assert_eq!(server.keys(), Vec::<String>::new(), "not even when only the header is missing");
    server.counters.most_objects.store(0, Ordering::Relaxed);
    // Errors and lost replies that pass are tried again.
    server.counters.errors.store(3, Ordering::Relaxed);
    server.counters.drops.store(3, Ordering::Relaxed);
    run_with(at, &server, export).done();
    assert_eq!(server.keys(), keys);
    assert_eq!(server.counters.drops.load(Ordering::Relaxed), 0, "they happened");
    // A damaged volume does not get there.
    let shard = bytes(&at.join("p.petro/volumes")).into_keys().find(|path| path.ends_with("0/c/0/0/0")).unwrap();
    let mut content = fs::read(&shard).unwrap();
    content[1000] ^= 1;
    fs::write(&shard, content).unwrap();
    let before = server.keys();
    let of = if shard.to_string_lossy().contains("strength") { "strength" } else { "seismic" };
    run_with(at, &server, &format!("export p.petro s3://surveys/damaged.zarr --volume {of}")).failed(&["damaged"]);
    assert_eq!(server.keys(), before);
}
