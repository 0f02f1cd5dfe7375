//! A power cut, at every step: of what a command has written, a disk has for certain only what was flushed.
//!
//! The program is stopped before each call that changes files, and the folder is looked at. From that, and from the
//! calls that flush, follows what a disk may hold if the power fails there. Files and folders have identities that
//! outlive their names, as on a disk. Content that was not flushed is missing, cut off, zeros or there. What was made,
//! deleted or renamed in a folder that was not flushed is done or not, each by itself: a rename is one thing, as file
//! systems with a journal promise, and nothing else is assumed of the order in which a disk writes. Each such folder is
//! then opened by the program.

use super::supervised::{self, Verdict};
use super::{Undisturbed, commands, difference, empty_folder, files, folder_with, program, run_once};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::ffi::OsString;
use std::fs;
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// A file or folder, whatever it is called at present.
type Id = u64;

/// The folder that a scenario lies in.
const ROOT: Id = 0;

#[derive(Debug, Clone, PartialEq)]
enum Node {
    File(Rc<Vec<u8>>),
    Folder(BTreeMap<OsString, Id>),
}

/// Files and folders by their identity.
type Image = BTreeMap<Id, Node>;

/// How much of what was not flushed a disk holds.
#[derive(Debug, Clone, Copy)]
enum Kept {
    /// Nothing.
    Nothing,
    /// All names, and no content.
    Names,
    /// Each name and each content by chance.
    Some(u64),
}

/// What a disk holds for certain, while the program runs.
struct Disk {
    folder: PathBuf,
    /// The identity of each inode that is there now: a system gives the number of a deleted one to another.
    ids: HashMap<u64, Id>,
    next: Id,
    live: Image,
    flushed: Image,
    /// What is being flushed.
    flushing: Option<Id>,
}

impl Disk {
    fn of(folder: &Path) -> Self {
        let mut disk = Self {
            folder: folder.canonicalize().unwrap(),
            ids: HashMap::new(),
            next: ROOT,
            live: Image::new(),
            flushed: Image::new(),
            flushing: None,
        };
        disk.look();
        disk.flushed = disk.live.clone();
        disk
    }

    /// Looks at the folder again.
    fn look(&mut self) {
        let mut seen = HashMap::new();
        let mut image = Image::new();
        let folder = self.folder.clone();
        self.add(&folder, &mut seen, &mut image);
        (self.ids, self.live) = (seen, image);
    }

    fn add(&mut self, path: &Path, seen: &mut HashMap<u64, Id>, image: &mut Image) -> Id {
        let facts = fs::symlink_metadata(path).unwrap();
        let id = self.ids.get(&facts.ino()).copied().unwrap_or_else(|| {
            self.next += 1;
            self.next - 1
        });
        seen.insert(facts.ino(), id);
        let node = if facts.is_dir() {
            let mut entries: Vec<_> = fs::read_dir(path).unwrap().map(|entry| entry.unwrap().file_name()).collect();
            entries.sort();
            let with_id = |name: OsString| (name.clone(), self.add(&path.join(name), seen, image));
            Node::Folder(entries.into_iter().map(with_id).collect())
        } else {
            let content = fs::read(path).unwrap();
            match self.live.get(&id) {
                Some(Node::File(known)) if **known == content => Node::File(known.clone()),
                _ => Node::File(Rc::new(content)),
            }
        };
        image.insert(id, node);
        id
    }

    /// What was being flushed is on the disk now, as it was when that began.
    fn finish_flush(&mut self) {
        if let Some(id) = self.flushing.take()
            && let Some(node) = self.live.get(&id)
        {
            self.flushed.insert(id, node.clone());
        }
    }

    /// A flush of this file or folder begins.
    fn begin_flush(&mut self, path: &Path) {
        let Ok(below) = path.strip_prefix(&self.folder) else { return };
        let mut id = ROOT;
        for part in below {
            let Some(Node::Folder(entries)) = self.live.get(&id) else { return };
            let Some(next) = entries.get(part) else { return };
            id = *next;
        }
        self.flushing = Some(id);
    }

    /// What a disk may hold now.
    fn after_a_cut(&self, kept: Kept) -> Image {
        let mut chance = Chance::new(kept);
        let nodes = self.live.iter().map(|(id, node)| {
            let left = match (self.flushed.get(id), node) {
                (Some(Node::Folder(old)), Node::Folder(new)) => Node::Folder(chance.entries(old, new)),
                (None, Node::Folder(new)) => Node::Folder(chance.entries(&BTreeMap::new(), new)),
                (Some(Node::File(old)), Node::File(new)) => Node::File(chance.content(old, new)),
                (_, Node::File(new)) => Node::File(chance.content(&Rc::default(), new)),
                (Some(Node::File(_)), Node::Folder(_)) => unreachable!("a file never becomes a folder"),
            };
            (*id, left)
        });
        let mut image: Image = nodes.collect();
        // What was deleted may still be there.
        for (id, node) in &self.flushed {
            image.entry(*id).or_insert_with(|| node.clone());
        }
        reachable(&image)
    }
}

/// What can be reached from the top: the rest of a disk is empty.
fn reachable(image: &Image) -> Image {
    let (mut found, mut open) = (Image::new(), vec![ROOT]);
    while let Some(id) = open.pop() {
        if let Some(node) = image.get(&id).filter(|_| !found.contains_key(&id)) {
            if let Node::Folder(entries) = node {
                open.extend(entries.values());
            }
            found.insert(id, node.clone());
        }
    }
    found
}

/// Decides what is left.
struct Chance {
    kept: Kept,
    state: u64,
}

impl Chance {
    fn new(kept: Kept) -> Self {
        let seed = if let Kept::Some(seed) = kept { seed } else { 0 };
        Self { kept, state: seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0xd1b5_4a32_d192_ed03 }
    }

    /// A number below `count`.
    fn below(&mut self, count: usize) -> usize {
        self.state = self.state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.state >> 33) as usize % count
    }

    fn entries(&mut self, old: &BTreeMap<OsString, Id>, new: &BTreeMap<OsString, Id>) -> BTreeMap<OsString, Id> {
        let names: BTreeSet<&OsString> = old.keys().chain(new.keys()).collect();
        let chosen = names.into_iter().filter_map(|name| {
            // What was renamed decides for its old place as for its new one.
            let moved = *new.get(name).or(old.get(name))?;
            Some((name.clone(), *(if self.is_done(moved) { new } else { old }).get(name)?))
        });
        chosen.collect()
    }

    /// Whether what was done last to the names of a file or folder is on the disk.
    fn is_done(&self, id: Id) -> bool {
        match self.kept {
            Kept::Nothing => false,
            Kept::Names => true,
            Kept::Some(seed) => Self::new(Kept::Some(seed.wrapping_mul(1_000_003).wrapping_add(id))).below(2) == 0,
        }
    }

    fn content(&mut self, old: &Rc<Vec<u8>>, new: &Rc<Vec<u8>>) -> Rc<Vec<u8>> {
        if old == new || !matches!(self.kept, Kept::Some(_)) {
            return old.clone();
        }
        match self.below(4) {
            0 => old.clone(),
            1 => new.clone(),
            2 => Rc::new(vec![0; new.len()]),
            _ => Rc::new(new[..self.below(new.len() + 1)].to_vec()),
        }
    }
}

/// Writes an image to a folder.
fn write(image: &Image, id: Id, at: &Path) {
    match image.get(&id) {
        Some(Node::Folder(entries)) => {
            fs::create_dir_all(at).unwrap();
            entries.iter().for_each(|(name, id)| write(image, *id, &at.join(name)));
        }
        Some(Node::File(content)) => fs::write(at, content.as_slice()).unwrap(),
        None => {}
    }
}

/// One image in so many is gone on with: the command is given again.
const AGAIN: usize = 5;

impl Undisturbed {
    /// Cuts the power before each step, and after the command has ended; returns how many folders were opened.
    fn cut(&self) -> usize {
        let folder = folder_with(self.start.path());
        let mut disk = Disk::of(folder.path());
        let mut seen = Vec::new();
        let run = supervised::run(program(folder.path(), self.scenario.line), |number, call| {
            disk.finish_flush();
            disk.look();
            self.open_after_cuts(&disk, number, &mut seen, false);
            if call.is_sync()
                && let Some(path) = call.path_of_handle()
            {
                disk.begin_flush(&path);
            }
            Verdict::Go
        });
        assert_eq!(run.expect("it was possible before").code, 0);
        disk.finish_flush();
        disk.look();
        self.open_after_cuts(&disk, self.calls.len(), &mut seen, true);
        seen.len()
    }

    /// Opens what the disk may hold now; after the command has said that it succeeded, only its result is right.
    fn open_after_cuts(&self, disk: &Disk, step: usize, seen: &mut Vec<Image>, has_succeeded: bool) {
        for kept in [Kept::Nothing, Kept::Names, Kept::Some(step as u64)] {
            let image = disk.after_a_cut(kept);
            if seen.contains(&image) && !has_succeeded {
                continue;
            }
            let name = self.calls.get(step).copied().unwrap_or("the end");
            let what = format!("`{}`, power cut before step {step} ({name}), {kept:?} kept", self.scenario.line);
            let folder = empty_folder();
            write(&image, ROOT, folder.path());
            self.open(folder.path(), has_succeeded, &what);
            if !has_succeeded && (step + seen.len()).is_multiple_of(AGAIN) {
                self.go_on(folder.path(), &what);
            }
            seen.push(image);
        }
    }

    fn open(&self, at: &Path, has_succeeded: bool, what: &str) {
        let is_done = self.settled(&at.join(self.scenario.project), what);
        assert!(is_done || !has_succeeded, "{what}: what the command had done is lost");
        // What was written elsewhere is whole or not there under its name.
        let outside = |path: &PathBuf| !path.starts_with(self.scenario.project) && !is_unfinished(path);
        let found = files(at);
        for (path, content) in found.iter().filter(|(path, _)| outside(path)) {
            assert!(self.all.get(path) == Some(content), "{what}: {} is not whole", path.display());
        }
        if has_succeeded {
            let lost: Vec<_> = self.all.keys().filter(|path| outside(path) && !found.contains_key(*path)).collect();
            assert!(lost.is_empty(), "{what}: {lost:?} is lost");
        }
    }

    /// The command is given again, and its result is as if nothing had happened.
    fn go_on(&self, at: &Path, what: &str) {
        let project = self.scenario.project;
        let state = |all: &BTreeMap<PathBuf, Vec<u8>>| all.get(&Path::new(project).join("project.toml")).cloned();
        let present = state(&files(at));
        if present == state(&self.all) && self.before != self.after {
            return;
        }
        let again = run_once(at, self.scenario.line);
        assert_eq!(again.code, 0, "{what}, then again: {}{}", again.stdout, again.stderr);
        let found: BTreeMap<_, _> = files(at).into_iter().filter(|(path, _)| !is_unfinished(path)).collect();
        assert!(found == self.all, "{what}, then again: other bytes: {:?}", difference(&found, &self.all));
    }
}

/// A file that is renamed to its target when it is whole: `NAME.PROCESS.part`, or hidden.
fn is_unfinished(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == "part")
        || path.components().any(|part| part.as_os_str().to_string_lossy().starts_with('.'))
}

fn cut_all(scenarios: &[commands::Scenario]) {
    // A repair that is cut off may set the same damaged step aside twice: both are what it was.
    for scenario in scenarios.iter().filter(|scenario| !scenario.line.contains("--repair")) {
        let Some(undisturbed) = Undisturbed::of(*scenario) else { return };
        let began = std::time::Instant::now();
        let count = undisturbed.cut();
        let steps = undisturbed.calls.len();
        eprintln!("{steps:4} steps, {count:5} power cuts, {:6.1?}: {}", began.elapsed(), scenario.line);
    }
}

#[test]
fn a_power_cut_while_files_and_projects_are_made_loses_nothing() {
    cut_all(&commands::MAKING);
}

#[test]
fn a_power_cut_while_an_interpretation_is_changed_loses_nothing() {
    cut_all(&commands::INTERPRETING);
    cut_all(&commands::LOOKING);
}

#[test]
fn a_power_cut_while_something_is_picked_or_proposed_loses_nothing() {
    cut_all(&commands::PICKING);
}

#[test]
fn a_power_cut_while_something_is_computed_or_mended_loses_nothing() {
    cut_all(&commands::COMPUTING);
    cut_all(&commands::MENDING);
}
