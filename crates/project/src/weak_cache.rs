//! A weak cache, through which several independent callers share a value. The value made last is found again for as
//! long as someone holds it.

use std::sync::{Arc, Mutex, PoisonError, Weak};

/// A value and its key.
pub(crate) struct WeakCache<K, V>(Mutex<Option<(K, Weak<V>)>>);

impl<K: PartialEq, V> WeakCache<K, V> {
    /// An empty cache.
    pub(crate) const fn nothing() -> Self {
        Self(Mutex::new(None))
    }

    /// The value of `key` if someone holds it.
    pub(crate) fn get(&self, key: &K) -> Option<Arc<V>> {
        let last = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        last.as_ref().filter(|(of, _)| of == key).and_then(|(_, known)| known.upgrade())
    }

    /// The value of `key` if someone holds it, otherwise a new one. While it is being made nothing is locked: if two
    /// callers ask at once, both make it.
    pub(crate) fn get_or_make<E>(&self, key: K, make: impl FnOnce() -> Result<V, E>) -> Result<Arc<V>, E> {
        if let Some(known) = self.get(&key) {
            return Ok(known);
        }
        let made = Arc::new(make()?);
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Some((key, Arc::downgrade(&made)));
        Ok(made)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_is_made_again_when_it_is_another_or_nobody_holds_it() {
        let held = WeakCache::nothing();
        let made = std::cell::Cell::new(0);
        let get = |key: &'static str| {
            let make = || {
                made.set(made.get() + 1);
                Ok::<_, ()>(made.get())
            };
            held.get_or_make(key, make).unwrap()
        };
        let first = get("a");
        assert_eq!((*first, *get("a")), (1, 1));
        assert_eq!(*get("b"), 2);
        assert_eq!(*get("b"), 3, "nobody held it");
        assert!(held.get_or_make("c", || Err::<i32, _>("broken")).is_err());
    }
}
