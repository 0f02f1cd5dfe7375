//! What cannot be read now is told apart from damage, and nothing is removed for it.
//!
//! Permissions and handles are those of a process, so the test program starts itself: with few handles, and as a user to
//! whom the files do not belong.

use super::*;
use crate::Project;
use crate::fixture::extracted;
use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::fs;
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::PermissionsExt;
use std::path::PathBuf;
use std::process::Command;
use survey::{SurveyGeometry, VerticalUnit, Volume};

/// The project that the started program checks, and repairs if that is asked for.
const ROOT: &str = "PETROGLYPH_TEST_CHECKED";
const REPAIR: &str = "PETROGLYPH_TEST_REPAIR";

fn begun(folder: &Path) -> PathBuf {
    let geometry = SurveyGeometry::regular([24, 20, 60], 25.0, 4.0, VerticalUnit::Milliseconds);
    let wave = |n: usize| ((n % 60) as f32 * 0.7).sin() * 1000.0;
    let volume = Volume::from_samples(geometry.size(), (0..24 * 20 * 60).map(wave).collect()).unwrap();
    extracted(folder, &geometry, &volume).root().to_owned()
}

/// Every file of a project but locks.
fn content(root: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut folders = vec![root.to_owned()];
    while let Some(folder) = folders.pop() {
        for path in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            match path.is_dir() {
                true => folders.push(path),
                false if path.ends_with("lock") => {}
                false => drop(found.insert(path.strip_prefix(root).unwrap().to_owned(), fs::read(&path).unwrap())),
            }
        }
    }
    found
}

/// Starts this test program through a shell line that ends in `exec`, to look at a project; returns what it found.
fn looked_at(line: &str, root: &Path, repair: &str) -> (bool, Option<(usize, usize)>) {
    let own = root.with_file_name("tests");
    if !own.exists() {
        let program = std::env::current_exe().unwrap();
        fs::hard_link(&program, &own).or_else(|_| fs::copy(&program, &own).map(drop)).unwrap();
    }
    let said = Command::new("sh")
        .args(["-c", &format!("{line} \"$0\" --exact check::tests::looks --ignored --nocapture --test-threads 1")])
        .arg(&own)
        .env(ROOT, root)
        .env(REPAIR, repair)
        .env("RAYON_NUM_THREADS", "4")
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&said.stdout).into_owned();
    let numbers = text.lines().find_map(|line| {
        let (damaged, unread) = line.split_once("found: ")?.1.split_once(' ')?;
        Some((damaged.parse().ok()?, unread.trim().parse().ok()?))
    });
    assert!(!text.contains("panicked"), "{text}");
    (text.contains("found: ") || text.contains("refused: "), numbers)
}

#[test]
#[ignore = "the other tests start it"]
fn looks() {
    let Some(root) = std::env::var_os(ROOT) else { return };
    let quiet = Progress::silent();
    let found = match std::env::var_os(REPAIR).is_some_and(|said| said == "repair") {
        true => repair(Path::new(&root), std::time::Duration::ZERO, &quiet),
        false => check(Path::new(&root), &quiet),
    };
    match found {
        Ok(report) => println!("\nfound: {} {}", report.damage.len(), report.unread.len()),
        Err(error) => println!("\nrefused: {error}"),
    }
}

#[test]
fn without_handles_nothing_is_damaged() {
    let folder = tempfile::tempdir().unwrap();
    let root = begun(folder.path());
    let before = content(&root);
    let mut unread = 0;
    for handles in [9, 10, 11, 12, 14, 17, 64] {
        for how in ["check", "repair"] {
            let (has_answered, found) = looked_at(&format!("ulimit -n {handles}; exec"), &root, how);
            if let Some((damaged, not_read)) = found {
                assert_eq!(damaged, 0, "{handles} handles, {how}");
                unread += not_read;
            }
            assert!(has_answered || handles < 12, "{handles} handles, {how}");
            assert!(content(&root) == before, "{handles} handles, {how}");
        }
    }
    println!("{unread} files could not be read");
    assert_eq!(looked_at("exec", &root, "check").1, Some((0, 0)));
}

#[test]
fn without_a_permission_nothing_is_damaged() {
    let folder = tempfile::tempdir().unwrap();
    let root = begun(folder.path());
    let open = |path: &Path, mode: u32| fs::set_permissions(path, fs::Permissions::from_mode(mode)).unwrap();
    open(folder.path(), 0o755);
    let is_root = looked_at("test $(id -u) = 0 && exec", &root, "check").0;
    let line = if is_root { "exec setpriv --reuid=65534 --regid=65534 --clear-groups" } else { "exec" };
    if !looked_at(line, &root, "check").0 {
        eprintln!("skipped: another user cannot be become here");
        return;
    }
    let volume = fs::read_dir(root.join("volumes")).unwrap().next().unwrap().unwrap().path();
    let shard = volume.join("0/c/0/0/0");
    let before = content(&root);
    for path in [&shard, &volume, &root.join("project.toml"), &root.join("history"), &root.join("history/0002.toml")]
        .into_iter()
        .chain([&root.join("derived"), &root.join("derived/candidates.zarr"), &root.join("volumes")])
    {
        let mode = fs::metadata(path).unwrap().permissions().mode();
        open(path, 0);
        let (_, found) = looked_at(line, &root, "check");
        let (damaged, unread) = found.unwrap_or_else(|| panic!("{} stops a check", path.display()));
        assert!(damaged == 0 && unread > 0, "{}: {damaged} damaged, {unread} not read", path.display());
        looked_at(line, &root, "repair");
        open(path, mode);
        assert!(content(&root) == before, "{}", path.display());
        assert_eq!(looked_at(line, &root, "check").1, Some((0, 0)), "{}", path.display());
    }
    // What is damaged is damaged all the same.
    let mut bytes = fs::read(&shard).unwrap();
    bytes[40] ^= 4;
    fs::write(&shard, bytes).unwrap();
    assert_eq!(looked_at(line, &root, "check").1, Some((1, 0)));
}

#[test]
fn in_a_folder_whose_name_is_no_text_nothing_is_damaged() {
    let folder = tempfile::tempdir().unwrap();
    let root = begun(folder.path());
    let unnamed = folder.path().join(OsStr::from_bytes(b"north\xff.petro"));
    fs::rename(&root, &unnamed).unwrap();
    let before = content(&unnamed);
    let quiet = Progress::silent();
    let found = check(&unnamed, &quiet).unwrap();
    assert!(found.damage.is_empty() && !found.is_well(), "{found:?}");
    assert!(found.unread.iter().any(|unread| unread.reason.contains("UTF-8")), "{found:?}");
    let found = repair(&unnamed, std::time::Duration::ZERO, &quiet).unwrap();
    assert!(found.damage.is_empty() && found.repairs.is_empty(), "{found:?}");
    assert!(content(&unnamed) == before);
    fs::rename(&unnamed, &root).unwrap();
    assert!(check(&root, &quiet).unwrap().is_well());
    assert!(Project::open(&root).is_ok());
}
