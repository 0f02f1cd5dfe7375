//! A latest-value worker: a thread that works on the latest value it was given. A value that arrives while it works
//! replaces any that is still waiting; nothing is queued.

use super::{Outbox, keep_working};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};

struct Slot<W> {
    values: W,
    ended: bool,
}

struct Shared<W> {
    slot: Mutex<Slot<W>>,
    changed: Condvar,
}

impl<W> Shared<W> {
    fn lock(&self) -> MutexGuard<'_, Slot<W>> {
        self.slot.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The sender's end. When it is dropped, the thread ends after the value that it works on.
pub(super) struct LatestValueWorker<W> {
    shared: Arc<Shared<W>>,
}

impl<W: Default + Send + 'static> LatestValueWorker<W> {
    /// Starts a thread of this name; after a panic, which is reported, `work` is called again.
    pub(super) fn start(name: &'static str, outbox: &Outbox, mut work: impl FnMut(&Inbox<W>) + Send + 'static) -> Self {
        let slot = Mutex::new(Slot { values: W::default(), ended: false });
        let shared = Arc::new(Shared { slot, changed: Condvar::new() });
        let theirs = Inbox { shared: shared.clone() };
        keep_working(name, outbox, move || work(&theirs));
        Self { shared }
    }
}

impl<W> LatestValueWorker<W> {
    /// Changes the waiting value.
    pub(super) fn change(&self, change: impl FnOnce(&mut W)) {
        change(&mut self.shared.lock().values);
        self.shared.changed.notify_one();
    }
}

impl<W> Drop for LatestValueWorker<W> {
    fn drop(&mut self) {
        self.shared.lock().ended = true;
        self.shared.changed.notify_one();
    }
}

/// The thread's end.
pub(super) struct Inbox<W> {
    shared: Arc<Shared<W>>,
}

impl<W> Inbox<W> {
    /// Waits until `take` returns something to do; `None` when the sender is gone.
    pub(super) fn next<T>(&self, mut take: impl FnMut(&mut W) -> Option<T>) -> Option<T> {
        let mut slot = self.shared.lock();
        loop {
            if slot.ended {
                return None;
            }
            if let Some(found) = take(&mut slot.values) {
                return Some(found);
            }
            slot = self.shared.changed.wait(slot).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// Reads the waiting value now; `None` when the sender is gone.
    pub(super) fn look<T>(&self, look: impl FnOnce(&mut W) -> T) -> Option<T> {
        let mut slot = self.shared.lock();
        (!slot.ended).then(|| look(&mut slot.values))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::mpsc::channel;

    #[test]
    fn only_the_latest_value_is_worked_on_and_the_thread_ends_with_its_owner() {
        let (begun, is_begun) = channel();
        let (go, may_go) = channel();
        let (done, is_done) = channel();
        let outbox = Outbox { sender: channel().0, wake: Arc::new(|| {}) };
        let worker = LatestValueWorker::start("test", &outbox, move |inbox: &Inbox<Option<u32>>| {
            while let Some(request) = inbox.next(Option::take) {
                begun.send(request).unwrap();
                may_go.recv().unwrap();
            }
            done.send(inbox.look(|_| ())).unwrap();
        });
        worker.change(|request| *request = Some(1));
        assert_eq!(is_begun.recv(), Ok(1));
        for n in 2..5 {
            worker.change(|request| *request = Some(n));
        }
        go.send(()).unwrap();
        assert_eq!(is_begun.recv(), Ok(4));
        drop(worker);
        go.send(()).unwrap();
        assert_eq!(is_done.recv(), Ok(None));
    }
}
