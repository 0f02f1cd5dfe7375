//! Objects and their cache against a storage on loopback that fails on demand.

use super::cache::{BLOCK, CachedObjects};
use super::remote::Remote;
use std::sync::atomic::Ordering;
use testdata::s3::Server;

fn content(bytes: usize) -> Vec<u8> {
    (0..bytes).map(|n| (n * 31 % 251) as u8).collect()
}

/// A storage with one object, and its objects by plain HTTP.
fn storage(bytes: usize) -> (Server, Remote) {
    let server = Server::start("surveys").unwrap();
    server.put("north/0/c/0/0/0", content(bytes));
    let remote = Remote::open(&format!("{}/surveys/north", server.endpoint())).unwrap();
    (server, remote)
}

#[test]
fn objects_are_read_as_a_whole_and_in_part() {
    let (_server, remote) = storage(1000);
    assert_eq!(remote.get("0/c/0/0/0").unwrap(), content(1000));
    assert_eq!(remote.get_range("0/c/0/0/0", &(10..500)).unwrap(), &content(1000)[10..500]);
    assert_eq!(remote.length("0/c/0/0/0").unwrap(), 1000);
    let missing = remote.get("1/zarr.json").unwrap_err().to_string();
    assert!(missing.contains("north/1/zarr.json") && missing.contains("no such bucket or object"), "{missing}");
}

#[test]
fn what_may_pass_is_tried_again_and_what_does_not_is_said() {
    let (server, remote) = storage(100_000);
    for faults in [&server.counters.errors, &server.counters.drops] {
        faults.store(3, Ordering::Relaxed);
        assert_eq!(remote.get("0/c/0/0/0").unwrap(), content(100_000));
        assert_eq!(faults.load(Ordering::Relaxed), 0, "all of them happened");
        faults.store(1000, Ordering::Relaxed);
        let error = remote.get("0/c/0/0/0").unwrap_err().to_string();
        assert!(error.contains("5 tries failed") && error.contains("0/c/0/0/0"), "{error}");
        faults.store(0, Ordering::Relaxed);
    }
    let gone = Remote::open(&format!("{}/others/north", server.endpoint())).unwrap();
    assert!(gone.get("zarr.json").unwrap_err().to_string().contains("no such bucket"));
    let endpoint = server.endpoint();
    drop(server);
    let silent = Remote::open(&format!("{endpoint}/surveys/north")).unwrap();
    assert!(silent.get("zarr.json").unwrap_err().to_string().contains("tries failed"));
}

#[test]
fn credentials_in_an_address_are_refused_and_not_repeated() {
    let error = Remote::open("https://someone:secret@example.com/a").unwrap_err().to_string();
    assert!(error.contains("environment") && !error.contains("secret"), "{error}");
}

#[test]
fn a_block_is_read_once_and_the_cache_stays_below_its_limit() {
    let blocks = 12;
    let (server, remote) = storage(blocks * BLOCK as usize - 100);
    let folder = tempfile::tempdir().unwrap();
    let limit = 6 * BLOCK;
    let cached = CachedObjects::new_in(folder.path(), limit, remote, &[1]).unwrap();
    let read = |offset: u64, length: usize| {
        let mut out = vec![0; length];
        cached.read("0/c/0/0/0", offset, &mut out).unwrap();
        assert_eq!(out, &content(blocks * BLOCK as usize)[offset as usize..offset as usize + length]);
    };
    server.forget();
    read(10, 1000);
    read(5000, 1000);
    assert_eq!(server.counters.gets.load(Ordering::Relaxed), 1);
    read(BLOCK - 10, 20);
    assert_eq!(server.counters.gets.load(Ordering::Relaxed), 2);
    (0..blocks as u64).for_each(|block| read(block * BLOCK + 7, 50));
    let kept = |folder: &std::path::Path| -> u64 {
        let volumes = std::fs::read_dir(folder.join("blocks")).unwrap().flatten();
        volumes
            .flat_map(|volume| std::fs::read_dir(volume.path()).unwrap().flatten())
            .map(|e| e.metadata().unwrap().len())
            .sum()
    };
    assert!(kept(folder.path()) <= limit, "{}", kept(folder.path()));
    let before = server.counters.gets.load(Ordering::Relaxed);
    read((blocks as u64 - 1) * BLOCK, 10);
    assert_eq!(server.counters.gets.load(Ordering::Relaxed), before, "the last one is still there");
    let mut out = [0; 200];
    assert!(cached.read("0/c/0/0/0", blocks as u64 * BLOCK - 200, &mut out).is_err(), "beyond its end");
}
