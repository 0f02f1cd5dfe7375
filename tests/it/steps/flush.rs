//! Flushing that fails: reported with the path, but where a file system cannot flush folders at all.

use super::commands::Start;
use super::supervised::{self, Verdict};
use super::{folder_with, program};
use std::path::PathBuf;

/// The flushes of a command: the number of the call, and what is flushed.
fn flushes(start: Start, line: &str) -> Option<Vec<(usize, PathBuf, bool)>> {
    let folder = folder_with(start.folder());
    let mut found = Vec::new();
    supervised::run(program(folder.path(), line), |number, call| {
        if call.is_sync()
            && let Some(path) = call.path_of_handle()
        {
            found.push((number, path.strip_prefix(folder.path()).map_or(PathBuf::new(), PathBuf::from), path.is_dir()));
        }
        Verdict::Go
    })?;
    Some(found)
}

#[test]
fn a_flush_that_fails_is_reported_and_one_that_is_impossible_for_folders_is_not() {
    for (start, line) in [
        (Start::Imported, "velocity p.petro 2500"),
        (Start::Imported, "undo p.petro"),
        (Start::Imported, "horizon add p.petro top.csv --name Another"),
        (Start::Imported, "export p.petro top.csv.irap --horizon Top --format irap"),
        (Start::Imported, "export p.petro out.sgy --volume seismic"),
        (Start::Imported, "render p.petro a.png --inline 4 --size-cm 3x2"),
        (Start::Files, "create p.petro --bounds 0,1000,0,1000,0,1000 --size 9x9x9"),
    ] {
        let Some(flushes) = flushes(start, line) else { return };
        assert!(flushes.iter().any(|flush| flush.2) && flushes.iter().any(|flush| !flush.2), "`{line}`: {flushes:?}");
        for (step, path, is_folder) in flushes {
            let with = |error: i32| {
                let folder = folder_with(start.folder());
                let fail = |number, _: &_| if number == step { Verdict::Fail(error) } else { Verdict::Go };
                supervised::run(program(folder.path(), line), fail).expect("it was possible before")
            };
            let what = format!("`{line}`, {} at step {step}", path.display());
            let failed = with(libc::EIO);
            // What is computed again where it is missing is used all the same, and what failed is said.
            let is_derived = path.starts_with("p.petro/derived");
            assert_eq!(failed.code, i32::from(!is_derived), "{what}: {}", failed.stdout);
            let told = if is_derived { "could not be stored" } else { "os error 5" };
            assert!(failed.stderr.contains(told), "{what}: {}", failed.stderr);
            // A part of what is written beside its target has the number of a process in its path.
            let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
            let is_beside = [".part", ".new"].iter().any(|made| path.to_string_lossy().contains(made));
            let is_named = is_beside || is_derived || failed.stderr.contains(&name);
            assert!(is_named, "{what}: no \"{name}\" in {}", failed.stderr);
            for impossible in [libc::EINVAL, libc::EOPNOTSUPP] {
                let run = with(impossible);
                assert_eq!(run.code, i32::from(!is_folder && !is_derived), "{what}: {}", run.stderr);
            }
        }
    }
}
