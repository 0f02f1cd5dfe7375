//! What the last look at something found: a newer look replaces it, and gives up what is still under way.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use survey::Progress;

struct Looks<T> {
    /// How many were begun.
    begun: u64,
    /// The number of the look that found something last, and what that was.
    found: Option<(u64, T)>,
    /// Of the look under way.
    progress: Option<Progress>,
}

/// What was found last. Cheap to clone.
pub struct Latest<T> {
    looks: Arc<Mutex<Looks<T>>>,
}

impl<T> Clone for Latest<T> {
    fn clone(&self) -> Self {
        Self { looks: self.looks.clone() }
    }
}

impl<T> Default for Latest<T> {
    fn default() -> Self {
        Self { looks: Arc::new(Mutex::new(Looks { begun: 0, found: None, progress: None })) }
    }
}

impl<T> Latest<T> {
    fn lock(&self) -> MutexGuard<'_, Looks<T>> {
        self.looks.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Begins another look; what is found is put in under its number.
    pub fn begin(&self) -> u64 {
        let mut looks = self.lock();
        looks.progress.take().iter().for_each(Progress::cancel);
        looks.begun += 1;
        looks.begun
    }

    /// Lets a newer look stop this one.
    pub fn stop_by(&self, number: u64, progress: &Progress) {
        let mut looks = self.lock();
        if looks.begun == number {
            looks.progress = Some(progress.clone());
        } else {
            progress.cancel();
        }
    }

    /// Puts in what was found, unless another look has begun.
    pub fn put(&self, number: u64, found: T) {
        let mut looks = self.lock();
        if looks.begun == number {
            looks.found = Some((number, found));
        }
    }

    /// Looks at what was found last, and by which look.
    pub fn with<R>(&self, look: impl FnOnce(Option<(u64, &T)>) -> R) -> R {
        look(self.lock().found.as_ref().map(|(number, found)| (*number, found)))
    }

    /// Whether the look begun last has found something.
    pub fn is_current(&self) -> bool {
        let looks = self.lock();
        looks.found.as_ref().is_some_and(|(number, _)| *number == looks.begun)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_late_answer_to_an_older_look_is_nothing() {
        let latest = Latest::default();
        let (first, progress) = (latest.begin(), Progress::silent());
        latest.stop_by(first, &progress);
        latest.put(first, "a");
        assert!(latest.is_current());
        let second = latest.begin();
        assert!(progress.check().is_err() && !latest.is_current());
        latest.put(second, "b");
        latest.put(first, "late");
        latest.with(|found| assert_eq!(found, Some((second, &"b"))));
    }
}
