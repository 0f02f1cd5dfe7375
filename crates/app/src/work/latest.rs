//! The result of the latest attempt: a newer attempt replaces it and cancels the one that is still under way.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use survey::Progress;

struct Looks<T> {
    /// Number of attempts begun.
    begun: u64,
    /// The latest result, with the number of its attempt.
    found: Option<(u64, T)>,
    /// Progress of the attempt under way.
    progress: Option<Progress>,
}

/// The latest result. Cheap to clone.
pub(crate) struct Latest<T> {
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

    /// Begins a new attempt, cancels the previous one, and returns the number under which the result is stored.
    pub(crate) fn begin(&self) -> u64 {
        let mut looks = self.lock();
        looks.progress.take().iter().for_each(Progress::cancel);
        looks.begun += 1;
        looks.begun
    }

    /// Registers the progress of an attempt, so that a newer one can cancel it.
    pub(crate) fn stop_by(&self, number: u64, progress: &Progress) {
        let mut looks = self.lock();
        if looks.begun == number {
            looks.progress = Some(progress.clone());
        } else {
            progress.cancel();
        }
    }

    /// Stores the result of an attempt, unless a newer one has begun.
    pub(crate) fn put(&self, number: u64, found: T) {
        let mut looks = self.lock();
        if looks.begun == number {
            looks.found = Some((number, found));
        }
    }

    /// Reads the latest result and the number of its attempt.
    pub(crate) fn with<R>(&self, look: impl FnOnce(Option<(u64, &T)>) -> R) -> R {
        look(self.lock().found.as_ref().map(|(number, found)| (*number, found)))
    }

    /// Whether the attempt begun last has a result.
    pub(crate) fn is_current(&self) -> bool {
        let looks = self.lock();
        looks.found.as_ref().is_some_and(|(number, _)| *number == looks.begun)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_late_result_of_an_older_attempt_is_ignored() {
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
