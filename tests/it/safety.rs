//! What may go wrong around the program: read-only folders, a full disk, two writers, an interruption.

use crate::program::{Run, begin_in, bytes, project, run_in, survey};
use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

/// A small file system in memory, mounted where asked; unmounted when dropped.
struct Mounted<'a>(&'a Path);

impl<'a> Mounted<'a> {
    /// `None` where mounting is not permitted, said loudly.
    fn small(at: &'a Path, kilobytes: usize) -> Option<Self> {
        fs::create_dir_all(at).unwrap();
        let mounted = Command::new("mount")
            .args(["-t", "tmpfs", "-o", &format!("size={kilobytes}k"), "tmpfs"])
            .arg(at)
            .stderr(Stdio::null())
            .status()
            .is_ok_and(|status| status.success());
        if !mounted {
            eprintln!("skipped: mounting a tmpfs is not permitted here, so full and read-only disks are not tested");
        }
        mounted.then_some(Self(at))
    }

    fn make_read_only(&self) {
        let done = Command::new("mount").args(["-o", "remount,ro"]).arg(self.0).status().unwrap();
        assert!(done.success());
    }
}

impl Drop for Mounted<'_> {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg("-l").arg(self.0).status();
    }
}

#[test]
fn a_full_disk_costs_nothing() {
    let folder = project();
    let at = folder.path();
    let disk = at.join("disk");
    let used: usize = bytes(&at.join("p.petro")).values().map(|content| content.len().next_multiple_of(4096)).sum();
    let Some(_mounted) = Mounted::small(&disk, used / 1024 + 400) else { return };
    crate::program::copy(&at.join("p.petro"), &make(&disk.join("p.petro")));
    // Leave room for a few small files, not for another volume.
    let before = bytes(&disk);
    run_in(at, "import s/survey.sgy disk/p.petro --name again").failed(&["disk is full"]);
    assert!(bytes(&disk) == before, "the full disk changed the project");
    run_in(at, "import s/survey.sgy disk/new.petro").failed(&["disk is full"]);
    assert!(bytes(&disk) == before, "a project was left half-written");
    run_in(at, "render disk/p.petro disk/a.png --size 2400x2400 --samples 1 --device cpu --blend 1")
        .failed(&["disk is full"]);
    assert!(!disk.join("a.png").exists());
    // What fits still goes.
    run_in(at, "velocity disk/p.petro 2500").done();
    run_in(at, "undo disk/p.petro").done();
}

/// What the block is shared as: long enough under way to be interrupted, and larger than the small disk.
const SHARED: [(&str, &str); 2] =
    [("review p.petro OUT --sections 1 --device cpu", "a.html"), ("export p.petro OUT --model --device cpu", "a.glb")];

#[test]
fn a_full_disk_leaves_no_half_review() {
    let folder = project();
    let at = folder.path();
    let disk = at.join("disk");
    let Some(_mounted) = Mounted::small(&disk, 64) else { return };
    for (line, name) in SHARED {
        fs::write(disk.join(name), "the one before").unwrap();
        let line = line.replace("OUT", &format!("disk/{name} --density 120"));
        run_in(at, &line).failed(&["disk is full"]);
        // What was there is as it was, with nothing beside it.
        assert_eq!(bytes(&disk).into_values().collect::<Vec<_>>(), [b"the one before".to_vec()], "{name}");
        fs::remove_file(disk.join(name)).unwrap();
    }
}

#[test]
#[cfg(unix)]
fn an_interrupted_review_leaves_nothing() {
    let folder = project();
    let at = folder.path();
    for (line, name) in SHARED {
        let mut child = begin_in(at, &line.replace("OUT", &format!("{name} --density 4096")));
        std::thread::sleep(Duration::from_millis(900));
        assert!(child.try_wait().unwrap().is_none(), "{name} was finished before it could be interrupted");
        let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
        assert!(sent.success());
        let run = Run::of(&child.wait_with_output().unwrap());
        assert_eq!(run.code, 1, "{}{}", run.stdout, run.stderr);
        assert!(run.stderr.contains("cancelled"), "{}", run.stderr);
        let left: Vec<_> = fs::read_dir(at).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        assert!(!left.iter().any(|left| left.to_string_lossy().contains(name)), "{left:?}");
    }
}

fn make(folder: &Path) -> std::path::PathBuf {
    fs::create_dir_all(folder).unwrap();
    folder.to_owned()
}

#[test]
fn a_read_only_project_can_be_looked_at_but_not_changed() {
    let folder = project();
    let at = folder.path();
    let disk = at.join("disk");
    let Some(mounted) = Mounted::small(&disk, 16 * 1024) else { return };
    crate::program::copy(&at.join("p.petro"), &make(&disk.join("p.petro")));
    mounted.make_read_only();
    let before = bytes(&disk);
    for change in [
        "import s/survey.sgy disk/p.petro --name again",
        "import s/survey.sgy disk/new.petro",
        "velocity disk/p.petro 2500",
        "horizon remove disk/p.petro Alpha",
        "undo disk/p.petro",
        "render disk/p.petro disk/a.png --size 80x60 --samples 1 --device cpu",
    ] {
        run_in(at, change).failed(&["read-only"]);
    }
    run_in(at, "info disk/p.petro").done();
    run_in(at, "check disk/p.petro").done();
    run_in(at, "check disk/p.petro --repair").failed(&["read-only"]);
    run_in(at, "render disk/p.petro a.png --size 80x60 --samples 1 --device cpu").done();
    assert!(bytes(&disk) == before);
}

#[test]
fn a_second_writer_is_told_and_readers_are_not_disturbed() {
    let folder = project();
    let at = folder.path();
    let lock = File::options().create(true).truncate(false).write(true).open(at.join("p.petro/lock")).unwrap();
    lock.lock().unwrap();
    let before = bytes(&at.join("p.petro"));
    run_in(at, "velocity p.petro 2500").failed(&["another Petroglyph process"]);
    run_in(at, "undo p.petro").failed(&["another Petroglyph process"]);
    run_in(at, "info p.petro").done();
    assert!(bytes(&at.join("p.petro")) == before);
    lock.unlock().unwrap();
    run_in(at, "velocity p.petro 2500").done();
}

#[test]
#[cfg(unix)]
fn an_interruption_is_obeyed_and_leaves_no_survey() {
    let folder = survey();
    let at = folder.path();
    let before = bytes(at);
    // Large enough to be in the middle of something a moment later.
    let mut child = begin_in(at, "synth big --size 320x320x320");
    std::thread::sleep(Duration::from_millis(700));
    let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(sent.success());
    if let Some(status) = child.try_wait().unwrap() {
        assert!(!status.success(), "it was finished before it could be interrupted");
    }
    let run = Run::of(&child.wait_with_output().unwrap());
    assert_eq!(run.code, 1, "{}{}", run.stdout, run.stderr);
    assert!(run.stderr.contains("cancelled"), "{}", run.stderr);
    // Nothing under the name that a survey would have had, and nothing begun beside it.
    assert!(bytes(at) == before);
}
