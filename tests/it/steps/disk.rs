//! What a disk holds while a program runs: after a kill, and after a power cut.
//!
//! The program is stopped before each call that changes files, and the folder is looked at. That is what a kill leaves.
//! From it, and from the calls that flush, follows what a disk may hold if the power fails there. Files and folders have
//! identities that outlive their names, as on a disk. Content that was not flushed is missing, cut off, zeros or there.
//! What was made, deleted or renamed in a folder that was not flushed is done or not, each by itself: a rename is one
//! thing, as file systems with a journal promise, and nothing else is assumed of the order in which a disk writes.

use super::supervised::Call;
use super::tree::{Content, Tree};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::ffi::OsString;
use std::fs;
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A file or folder, whatever it is called at present.
type Id = u64;

/// The folder that a scenario lies in.
const ROOT: Id = 0;

#[derive(Debug, Clone, PartialEq)]
enum Node {
    File(Content),
    Folder(BTreeMap<OsString, Id>),
}

/// Files and folders by their identity.
type Image = BTreeMap<Id, Node>;

/// How much of what was not flushed a disk holds.
#[derive(Debug, Clone, Copy)]
pub(super) enum Kept {
    /// Nothing.
    Nothing,
    /// All names, and no content.
    Names,
    /// Each name and each content by chance.
    Some(u64),
}

/// What a disk holds, now and for certain, while the program runs.
pub(super) struct Disk {
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
    /// What lies in a folder, all of it flushed.
    pub(super) fn of(folder: &Path) -> Self {
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

    /// Before a call is made, or when the program has ended: what was being flushed is on the disk, and the folder is
    /// looked at. If the call flushes, that begins.
    pub(super) fn next(&mut self, call: Option<&Call>) {
        self.finish_flush();
        self.look();
        if let Some(path) = call.filter(|call| call.is_sync()).and_then(Call::path_of_handle) {
            self.begin_flush(&path);
        }
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
                _ => Node::File(Arc::new(content)),
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

    /// What a kill leaves now.
    pub(super) fn after_a_kill(&self) -> Tree {
        tree(&self.live)
    }

    /// What a disk may hold if the power fails now.
    pub(super) fn after_a_cut(&self, kept: Kept) -> Tree {
        let mut chance = Chance::new(kept);
        let nodes = self.live.iter().map(|(id, node)| {
            let left = match (self.flushed.get(id), node) {
                (Some(Node::Folder(old)), Node::Folder(new)) => Node::Folder(chance.entries(old, new)),
                (None, Node::Folder(new)) => Node::Folder(chance.entries(&BTreeMap::new(), new)),
                (Some(Node::File(old)), Node::File(new)) => Node::File(chance.content(old, new)),
                (_, Node::File(new)) => Node::File(chance.content(&Arc::default(), new)),
                (Some(Node::File(_)), Node::Folder(_)) => unreachable!("a file never becomes a folder"),
            };
            (*id, left)
        });
        let mut image: Image = nodes.collect();
        // What was deleted may still be there.
        for (id, node) in &self.flushed {
            image.entry(*id).or_insert_with(|| node.clone());
        }
        tree(&image)
    }
}

/// What can be reached from the top by its names: the rest of a disk is empty.
fn tree(image: &Image) -> Tree {
    let (mut found, mut open) = (Tree::default(), vec![(ROOT, PathBuf::new())]);
    while let Some((id, path)) = open.pop() {
        let Some(Node::Folder(entries)) = image.get(&id) else { continue };
        for (name, id) in entries {
            let path = path.join(name);
            match image.get(id) {
                Some(Node::File(content)) => found.insert(path, Some(content.clone())),
                Some(Node::Folder(_)) => {
                    found.insert(path.clone(), None);
                    open.push((*id, path));
                }
                None => {}
            }
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

    fn content(&mut self, old: &Content, new: &Content) -> Content {
        if old == new || !matches!(self.kept, Kept::Some(_)) {
            return old.clone();
        }
        match self.below(4) {
            0 => old.clone(),
            1 => new.clone(),
            2 => Arc::new(vec![0; new.len()]),
            _ => Arc::new(new[..self.below(new.len() + 1)].to_vec()),
        }
    }
}
