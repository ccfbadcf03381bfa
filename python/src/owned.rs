//! Values that one thread uses.

use crate::errors::raised;
use pyo3::PyResult;
use std::sync::{Mutex, MutexGuard, PoisonError, TryLockError};
use std::thread::ThreadId;

/// A value for the thread that made it. Python may drop it on any thread.
pub struct Owned<T> {
    what: &'static str,
    thread: ThreadId,
    value: Mutex<T>,
}

impl<T> Owned<T> {
    /// Owned by the calling thread. `what` names the value in messages.
    pub fn new(what: &'static str, value: T) -> Owned<T> {
        Owned {
            what,
            thread: std::thread::current().id(),
            value: Mutex::new(value),
        }
    }

    /// The value, for the length of a call.
    ///
    /// # Errors
    /// Another thread calls; a callback of a call that still runs.
    pub fn lock(&self) -> PyResult<MutexGuard<'_, T>> {
        let what = self.what;
        if std::thread::current().id() != self.thread {
            return Err(raised(
                "ThreadError",
                format!(
                    "this {what} belongs to the thread that made it: make one in this thread, with its own Lab"
                ),
            ));
        }
        match self.value.try_lock() {
            Ok(value) => Ok(value),
            // A panic left it. Whatever it holds is made anew or is an error of its own.
            Err(TryLockError::Poisoned(left)) => Ok(PoisonError::into_inner(left)),
            Err(TryLockError::WouldBlock) => Err(raised(
                "ThreadError",
                format!("this {what} is in use: a progress callback must not call it"),
            )),
        }
    }
}
