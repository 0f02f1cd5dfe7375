//! A thread that works on the latest wishes: what is wished while it works replaces what was wished before.

use super::{Outbox, keep_working};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};

struct Slot<W> {
    wishes: W,
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

/// Where wishes are left; when it is dropped, the thread ends with the wish it works on.
pub(super) struct Wishes<W> {
    shared: Arc<Shared<W>>,
}

impl<W: Default + Send + 'static> Wishes<W> {
    /// Starts a thread of this name; `work` is called again after a panic, which is told.
    pub(super) fn start(name: &'static str, outbox: &Outbox, mut work: impl FnMut(&Wished<W>) + Send + 'static) -> Self {
        let slot = Mutex::new(Slot { wishes: W::default(), ended: false });
        let shared = Arc::new(Shared { slot, changed: Condvar::new() });
        let theirs = Wished { shared: shared.clone() };
        keep_working(name, outbox, move || work(&theirs));
        Self { shared }
    }
}

impl<W> Wishes<W> {
    /// Changes what is wished.
    pub(super) fn change(&self, change: impl FnOnce(&mut W)) {
        change(&mut self.shared.lock().wishes);
        self.shared.changed.notify_one();
    }
}

impl<W> Drop for Wishes<W> {
    fn drop(&mut self) {
        self.shared.lock().ended = true;
        self.shared.changed.notify_one();
    }
}

/// The wishes as the thread sees them.
pub(super) struct Wished<W> {
    shared: Arc<Shared<W>>,
}

impl<W> Wished<W> {
    /// Waits until `take` finds something to do; `None` when nothing more will be wished.
    pub(super) fn next<T>(&self, mut take: impl FnMut(&mut W) -> Option<T>) -> Option<T> {
        let mut slot = self.shared.lock();
        loop {
            if slot.ended {
                return None;
            }
            if let Some(found) = take(&mut slot.wishes) {
                return Some(found);
            }
            slot = self.shared.changed.wait(slot).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// Looks at what is wished now; `None` when nothing more will be.
    pub(super) fn look<T>(&self, look: impl FnOnce(&mut W) -> T) -> Option<T> {
        let mut slot = self.shared.lock();
        (!slot.ended).then(|| look(&mut slot.wishes))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::mpsc::channel;

    #[test]
    fn only_the_latest_wish_is_worked_on_and_the_thread_ends_with_its_owner() {
        let (begun, is_begun) = channel();
        let (go, may_go) = channel();
        let (done, is_done) = channel();
        let outbox = Outbox { sender: channel().0, wake: Arc::new(|| {}) };
        let wishes = Wishes::start("test", &outbox, move |wished: &Wished<Option<u32>>| {
            while let Some(wish) = wished.next(Option::take) {
                begun.send(wish).unwrap();
                may_go.recv().unwrap();
            }
            done.send(wished.look(|_| ())).unwrap();
        });
        wishes.change(|wish| *wish = Some(1));
        assert_eq!(is_begun.recv(), Ok(1));
        for n in 2..5 {
            wishes.change(|wish| *wish = Some(n));
        }
        go.send(()).unwrap();
        assert_eq!(is_begun.recv(), Ok(4));
        drop(wishes);
        go.send(()).unwrap();
        assert_eq!(is_done.recv(), Ok(None));
    }
}
