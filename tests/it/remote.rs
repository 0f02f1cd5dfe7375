//! A volume that stays in object storage: linked, drawn, and the ways in which a storage fails.

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
    let linked = server.counters.bytes.load(Ordering::Relaxed);
    assert!(linked < server.total_bytes() / 4, "linking read {linked} of {} bytes", server.total_bytes());
    let facts = run_with(at, &server, "volume list r.petro --json").done().stdout;
    assert!(facts.contains("s3://surveys/north.zarr"), "{facts}");
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
