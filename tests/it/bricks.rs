//! Extraction in stated memory: the bytes of one piece, a kill in the middle, and memory that is too little.

use crate::program::{bytes, command, run_in};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::time::Duration;
use tempfile::TempDir;

/// Memory for which this survey is cut into several bricks: in one piece it takes 88 MiB.
const EXTRACT: &str = "extract p.petro --min-leaf-triangles 100 --memory 48M";

/// A project with a volume that was not extracted from.
fn imported() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    run_in(folder.path(), "synth s --size 160x150x124 --seed 3 --snr 3").done();
    run_in(folder.path(), "import s/survey.sgy p.petro").done();
    folder
}

fn candidates(at: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let root = at.join("p.petro/derived/candidates.zarr");
    bytes(&root).into_iter().map(|(path, content)| (path.strip_prefix(&root).unwrap().to_owned(), content)).collect()
}

/// What a stopped extraction left.
fn left(at: &Path) -> Vec<String> {
    let names = fs::read_dir(at.join("p.petro/derived/unfinished")).into_iter().flatten().flatten();
    names
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .filter(|name| !name.ends_with(".lock"))
        .collect()
}

#[test]
fn stated_memory_gives_the_bytes_of_one_piece_and_a_kill_costs_little() {
    let (once, again) = (imported(), tempfile::tempdir().unwrap());
    crate::program::copy(once.path(), again.path());
    let at = once.path();
    let whole = run_in(at, "extract p.petro --min-leaf-triangles 100 --memory 4G --json").done().json();
    let wanted = candidates(at);
    assert!(wanted.len() > 10 && whole["leaves"].as_u64().unwrap() > 20);
    let at = again.path();
    // Killed later and later, it goes on where it was; at last it is done.
    let mut went_on = 0;
    for after_ms in [400, 900, 1500, 2500, 4000, 60_000, 120_000] {
        let mut child = command()
            .current_dir(at)
            .args(EXTRACT.split(' '))
            .stdout(Stdio::null())
            .stderr(fs::File::create(at.join("said.txt")).unwrap())
            .spawn()
            .unwrap();
        let mut waited = 0;
        let mut ended = None;
        while waited < after_ms && ended.is_none() {
            std::thread::sleep(Duration::from_millis(20));
            waited += 20;
            ended = child.try_wait().unwrap();
        }
        if ended.is_none() {
            child.kill().unwrap();
        }
        child.wait().unwrap();
        went_on += usize::from(
            fs::read_to_string(at.join("said.txt")).unwrap().contains("continued an interrupted extraction"),
        );
        if let Some(ended) = ended {
            assert!(ended.success());
            break;
        }
        assert!(!at.join("p.petro/derived/candidates.zarr").exists(), "nothing half-written");
        assert!(left(at).iter().all(|name| name.starts_with("bricks-")), "{:?}", left(at));
    }
    assert!(went_on > 0, "it was never killed in the middle");
    let found = candidates(at);
    assert_eq!(found.keys().collect::<Vec<_>>(), wanted.keys().collect::<Vec<_>>());
    for (path, content) in &wanted {
        assert!(found[path] == *content, "{} differs", path.display());
    }
    assert_eq!(left(at), Vec::<String>::new());
    // Killed between storing its result and cleaning up, it leaves a folder that the next one takes away.
    let key = run_in(at, &format!("{EXTRACT} --json")).done().json()["key"].as_str().unwrap().to_owned();
    fs::create_dir_all(at.join(format!("p.petro/derived/unfinished/bricks-{key}-64x64-9/arrays"))).unwrap();
    run_in(at, EXTRACT).done();
    assert_eq!(left(at), Vec::<String>::new());
}

#[test]
fn memory_that_is_too_little_and_damaged_samples_are_sentences() {
    let folder = imported();
    let at = folder.path();
    run_in(at, "extract p.petro --memory 25M").failed(&["too few", "state at least"]);
    run_in(at, "extract p.petro --memory 48M --method paper").failed(&["published method", "one piece"]);
    let shard = first_shard(&at.join("p.petro/volumes"));
    let mut content = fs::read(&shard).unwrap();
    content[100] ^= 1;
    fs::write(&shard, content).unwrap();
    run_in(at, EXTRACT).failed(&["damaged"]);
    assert_eq!(left(at), Vec::<String>::new());
    assert!(!at.join("p.petro/derived/candidates.zarr").exists());
}

/// The first file of samples below a folder.
fn first_shard(volumes: &Path) -> PathBuf {
    bytes(volumes).into_keys().find(|path| path.ends_with("0/c/0/0/0")).unwrap()
}
