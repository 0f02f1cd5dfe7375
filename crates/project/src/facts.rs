//! What follows from a state of a project, asked for in one way: fault blocks, candidates, geologic time, the model,
//! samples.
//!
//! A [`Query`] is one question, and its key is a hash of everything that the answer depends on. [`Facts::get`] looks for
//! the answer in memory, and otherwise asks the query, which may have it beside the project.
//!
//! In memory an answer is found for as long as anyone holds it. Beyond that, the answers used last are kept within one
//! budget ([`keep_within`]): the window has one, and a program that carries out one command has none, so that nothing
//! takes memory for longer than it is needed.
//!
//! `comemo` and `salsa` find out what a result depends on by watching what it reads. Here that is known already: data
//! have recorded hashes. What is needed instead, they lack: a budget in bytes, answers that are dropped when nobody holds
//! them, failures that are asked again, and a stage on disk.

use crate::document::Document;
use crate::error::ProjectError;
use std::any::Any;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use survey::Progress;

/// A state of a project, which is asked for what follows from it.
#[derive(Debug, Clone, Copy)]
pub struct Facts<'a> {
    /// The project's folder.
    pub root: &'a Path,
    /// Its state.
    pub document: &'a Document,
}

/// A question to a state of a project.
pub trait Query {
    /// What is asked for, in words; no other query has the same.
    const WHAT: &'static str;
    /// The answer.
    type Answer: Send + Sync + 'static;

    /// A hash of everything that the answer depends on.
    ///
    /// # Errors
    /// The state does not have what the question is about.
    fn key(&self, facts: Facts<'_>) -> Result<String, ProjectError>;

    /// The answer: the one that is stored beside the project, if there is an intact one, or else computed, and then stored.
    /// What it is computed from is read in either case: reading compares data with the hashes that were recorded, by which a
    /// stored answer is found, and it must not stand for data that were changed since.
    ///
    /// # Errors
    /// Data are damaged, it cannot be computed, does not fit into memory, or the user cancelled.
    fn compute(&self, facts: Facts<'_>, progress: &Progress) -> Result<Self::Answer, ProjectError>;

    /// The memory that an answer takes, bytes.
    fn bytes(answer: &Self::Answer) -> usize;
}

impl<'a> Facts<'a> {
    /// Of the state `document` of the project in `root`.
    pub fn of(root: &'a Path, document: &'a Document) -> Self {
        Self { root, document }
    }

    /// The answer to a question. While it is being computed nothing is locked: if two threads ask at once, both compute.
    ///
    /// # Errors
    /// Those of the query.
    pub fn get<Q: Query>(self, query: &Q, progress: &Progress) -> Result<Arc<Q::Answer>, ProjectError> {
        let key = query.key(self)?;
        let place = self.place::<Q>(&key);
        if let Some(known) = table().find(&place) {
            return Ok(known);
        }
        let answer = query.compute(self, progress)?;
        let (bytes, answer) = (Q::bytes(&answer), Arc::new(answer));
        let displaced = table().put(place, &answer, bytes);
        // Freeing it may take a while, during which the table is not locked.
        drop(displaced);
        Ok(answer)
    }

    /// The answer to a question, if it is in memory.
    ///
    /// # Errors
    /// Those of the query's key.
    pub fn held<Q: Query>(self, query: &Q) -> Result<Option<Arc<Q::Answer>>, ProjectError> {
        let place = self.place::<Q>(&query.key(self)?);
        Ok(table().find(&place))
    }

    fn place<Q: Query>(self, key: &str) -> Place {
        (Q::WHAT, self.root.to_owned(), key.to_owned())
    }
}

/// Keeps answers that nobody holds any more, those used last, up to so many bytes in all.
pub fn keep_within(bytes: usize) {
    let displaced = table().set_budget(bytes);
    drop(displaced);
}

/// Drops all answers that nobody holds.
pub fn drop_kept() {
    let mut table = table();
    let budget = table.budget;
    let displaced = table.set_budget(0);
    table.budget = budget;
    drop(table);
    drop(displaced);
}

/// Of which query, project and key an answer is. Two projects may state the same hashes, and only the data of one of them
/// were read.
type Place = (&'static str, PathBuf, String);

type Answer = Arc<dyn Any + Send + Sync>;

struct Entry {
    answer: Weak<dyn Any + Send + Sync>,
    /// The answer, while it is kept whether anyone else holds it or not.
    kept: Option<Answer>,
    bytes: usize,
    /// When it was asked for last, in questions.
    used: u64,
}

/// The answers in memory.
struct Table {
    entries: BTreeMap<Place, Entry>,
    budget: usize,
    asked: u64,
}

static TABLE: Mutex<Table> = Mutex::new(Table::new());

fn table() -> MutexGuard<'static, Table> {
    TABLE.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Table {
    const fn new() -> Self {
        Self { entries: BTreeMap::new(), budget: 0, asked: 0 }
    }

    fn find<T: Send + Sync + 'static>(&mut self, place: &Place) -> Option<Arc<T>> {
        self.asked += 1;
        let entry = self.entries.get_mut(place)?;
        entry.used = self.asked;
        entry.answer.upgrade()?.downcast().ok()
    }

    /// Adds an answer; returns what no longer has room, to be dropped without the lock.
    fn put<T: Send + Sync + 'static>(&mut self, place: Place, answer: &Arc<T>, bytes: usize) -> Vec<Answer> {
        self.entries.retain(|_, entry| entry.kept.is_some() || entry.answer.strong_count() > 0);
        let answer: Answer = answer.clone();
        let kept = (bytes <= self.budget).then(|| answer.clone());
        let entry = Entry { answer: Arc::downgrade(&answer), kept, bytes, used: self.asked };
        let replaced = self.entries.insert(place, entry).and_then(|entry| entry.kept);
        self.evicted().into_iter().chain(replaced).collect()
    }

    fn set_budget(&mut self, bytes: usize) -> Vec<Answer> {
        self.budget = bytes;
        self.evicted()
    }

    /// Stops keeping the answers that were not used for longest, until the rest has room.
    fn evicted(&mut self) -> Vec<Answer> {
        let mut kept: Vec<&mut Entry> = self.entries.values_mut().filter(|entry| entry.kept.is_some()).collect();
        let mut bytes: usize = kept.iter().map(|entry| entry.bytes).sum();
        kept.sort_by_key(|entry| entry.used);
        let mut evicted = Vec::new();
        for entry in kept {
            if bytes <= self.budget {
                break;
            }
            bytes -= entry.bytes;
            evicted.extend(entry.kept.take());
        }
        evicted
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};

    /// So many zeros; the second field counts how often they were made.
    struct Zeros(usize, Arc<AtomicUsize>);

    impl Query for Zeros {
        const WHAT: &'static str = "zeros";
        type Answer = Vec<u8>;

        fn key(&self, _: Facts<'_>) -> Result<String, ProjectError> {
            Ok(self.0.to_string())
        }

        fn compute(&self, _: Facts<'_>, progress: &Progress) -> Result<Vec<u8>, ProjectError> {
            progress.check()?;
            self.1.fetch_add(1, Ordering::Relaxed);
            Ok(vec![0; self.0])
        }

        fn bytes(answer: &Vec<u8>) -> usize {
            answer.len()
        }
    }

    #[test]
    fn an_answer_is_computed_again_when_nobody_holds_it() {
        let (document, made) = (Document::empty(None), Arc::new(AtomicUsize::new(0)));
        let facts = Facts::of(Path::new("a"), &document);
        let get = |count: usize| facts.get(&Zeros(count, made.clone()), &Progress::silent()).unwrap();
        let first = get(1);
        assert!(Arc::ptr_eq(&first, &get(1)));
        drop(get(2));
        drop(get(2));
        assert_eq!(made.load(Ordering::Relaxed), 3, "nobody held the second");
        assert!(Arc::ptr_eq(&first, &get(1)), "other questions displace nothing that is held");
        // Another project may state the same hash.
        let other = Facts::of(Path::new("b"), &document).get(&Zeros(1, made.clone()), &Progress::silent()).unwrap();
        assert!(!Arc::ptr_eq(&first, &other));
        // A failure is no answer.
        let cancelled = Progress::silent();
        cancelled.cancel();
        assert!(facts.get(&Zeros(3, made.clone()), &cancelled).is_err());
        assert!(facts.held(&Zeros(3, made.clone())).unwrap().is_none());
        assert_eq!(get(3).len(), 3);
    }

    #[test]
    fn a_budget_keeps_what_was_used_last() {
        let mut table = Table::new();
        let place = |name: &str| ("numbers", PathBuf::new(), name.to_owned());
        drop(table.set_budget(10));
        let put = |table: &mut Table, name: &str, bytes: usize| table.put(place(name), &Arc::new(bytes), bytes).len();
        assert_eq!([put(&mut table, "a", 4), put(&mut table, "b", 4)], [0, 0]);
        assert_eq!(table.find::<usize>(&place("a")).as_deref(), Some(&4));
        assert_eq!(put(&mut table, "c", 4), 1, "there is room for two");
        assert_eq!(table.find::<usize>(&place("b")), None);
        // What is larger than the budget displaces nothing, and is found while it is held.
        let large = Arc::new(11usize);
        assert!(table.put(place("d"), &large, 11).is_empty());
        assert!(table.find::<usize>(&place("d")).is_some_and(|found| Arc::ptr_eq(&found, &large)));
        drop(large);
        assert_eq!(table.find::<usize>(&place("d")), None);
        assert_eq!(table.set_budget(0).len(), 2);
        assert_eq!(table.find::<usize>(&place("a")), None);
    }
}
