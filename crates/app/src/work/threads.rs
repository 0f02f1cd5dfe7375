//! Threads of the window's workers. A panic in one is a bug in the program: it is reported, the order in which it
//! happened is lost, and the worker goes on with the next order.

use super::{Event, Outbox};
use crate::state::{Notice, Place};
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::thread::Builder;

/// How many times a worker is restarted; one that fails more often would fail at everything.
const RESTARTS: usize = 50;

/// How far threads give way that compute pictures, and those that work for minutes: nice values, of which one step is a
/// tenth of a processor's time.
pub(super) const SOON: i32 = 2;
pub(super) const LATER: i32 = 8;

/// Whether a thread can give way. Where it cannot, a processor is left to the window.
pub(super) const HAS_PRIORITIES: bool = cfg!(target_os = "linux");

/// Lets the window and the display's driver go first on this thread.
pub(super) fn give_way(nice: i32) {
    // On Linux a priority belongs to a thread; it may always be lowered.
    #[cfg(target_os = "linux")]
    let _ = rustix::process::setpriority_process(None, nice);
    #[cfg(not(target_os = "linux"))]
    let _ = nice;
}

/// Starts a thread for one job. A panic in it is reported, and so is a failure to start the thread.
pub(super) fn spawn(name: &'static str, outbox: &Outbox, job: impl FnOnce() + Send + 'static) {
    let theirs = outbox.clone();
    let started = Builder::new().name(name.to_owned()).spawn(move || {
        if let Err(panic) = catch_unwind(AssertUnwindSafe(job)) {
            theirs.send(Event::Told(stopped(name, panic.as_ref())));
        }
    });
    if let Err(error) = started {
        outbox.send(Event::Told(Notice {
            place: Place::Block,
            failed: true,
            text: format!("no thread could be started for {name}: {error}"),
            suspect: None,
            hint: Some("close other programs, then open the project again".to_owned()),
        }));
    }
}

/// Starts a thread for something that is requested again when it is missing, such as a listing or a swatch.
pub(super) fn spawn_quietly(name: &'static str, job: impl FnOnce() + Send + 'static) {
    // If the thread cannot be started the result stays missing, which the user sees.
    let _ = Builder::new().name(name.to_owned()).spawn(job);
}

/// Starts a thread that works until `job` returns. A panic is reported and the job is called again: what it had taken
/// from its inbox is lost, what is still waiting there is kept.
pub(super) fn keep_working(name: &'static str, outbox: &Outbox, mut job: impl FnMut() + Send + 'static) {
    let theirs = outbox.clone();
    spawn(name, outbox, move || {
        for _ in 0..RESTARTS {
            match catch_unwind(AssertUnwindSafe(&mut job)) {
                Ok(()) => return,
                Err(panic) => theirs.send(Event::Told(stopped(name, panic.as_ref()))),
            }
        }
    });
}

/// The message about a panic.
fn stopped(name: &str, panic: &(dyn Any + Send)) -> Notice {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    let text = text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_default();
    Notice {
        place: Place::Block,
        failed: true,
        text: format!("an error in the program interrupted {name}: {text}"),
        suspect: None,
        hint: Some("try again; the project was not changed. Please report what you did".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;
    use std::sync::mpsc::channel;
    use std::time::Duration;

    #[test]
    fn a_panic_is_told_and_the_next_order_is_carried_out() {
        let (sender, events) = channel();
        let outbox = Outbox { sender, wake: Arc::new(|| {}) };
        let (orders, inbox) = channel::<u32>();
        let (done, results) = channel();
        keep_working("numbers", &outbox, move || {
            while let Ok(order) = inbox.recv() {
                assert!(order != 1, "one is not wanted");
                done.send(order).unwrap();
            }
        });
        for order in [0, 1, 2] {
            orders.send(order).unwrap();
        }
        let wait = Duration::from_secs(20);
        assert_eq!([results.recv_timeout(wait).unwrap(), results.recv_timeout(wait).unwrap()], [0, 2]);
        let Ok(Event::Told(notice)) = events.recv_timeout(wait) else { panic!("nothing was told") };
        assert!(notice.failed && notice.text.contains("numbers") && notice.text.contains("one is not wanted"));
        drop(orders);
        assert!(results.recv_timeout(wait).is_err(), "it ends with its orders");
    }
}
