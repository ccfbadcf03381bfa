//! Work on threads of its own, with results by key.

use super::engine::guard::guarded;
use crossbeam_channel::{Receiver, Sender, unbounded};
use std::sync::Arc;

/// Called from other threads when there is something new to show.
pub type Wake = Arc<dyn Fn() + Send + Sync>;

/// Jobs that run on threads. A panic in a job is its result.
pub struct Background<Key, Out> {
    running: usize,
    results: Channel<Finished<Key, Out>>,
}

type Channel<T> = (Sender<T>, Receiver<T>);

/// A key, and the output of its job or the message of its panic.
pub type Finished<Key, Out> = (Key, Result<Out, String>);

impl<Key, Out> Default for Background<Key, Out> {
    fn default() -> Background<Key, Out> {
        Background {
            running: 0,
            results: unbounded(),
        }
    }
}

impl<Key: Send + 'static, Out: Send + 'static> Background<Key, Out> {
    /// Starts a job; `wake` is called when its result is there.
    pub fn start(&mut self, key: Key, wake: &Wake, job: impl FnOnce() -> Out + Send + 'static) {
        self.running += 1;
        let (out, wake) = (self.results.0.clone(), wake.clone());
        std::thread::spawn(move || {
            // Fails only if the window has closed.
            let _ = out.send((key, guarded(job)));
            wake();
        });
    }

    /// Whether a job runs, or its result was not taken.
    pub fn is_working(&self) -> bool {
        self.running > 0
    }

    /// The next result, if one is there.
    pub fn take(&mut self) -> Option<Finished<Key, Out>> {
        let result = self.results.1.try_recv().ok()?;
        self.running -= 1;
        Some(result)
    }
}
