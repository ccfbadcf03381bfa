//! Progress and cancellation between the thread that loads a scene and the thread that waits for
//! it.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

use super::SceneError;

/// State shared by both threads.
#[derive(Debug)]
pub(super) struct Watch {
    stopped: AtomicBool,
    now: Mutex<(String, f32)>,
    files: Mutex<BTreeSet<PathBuf>>,
}

impl Watch {
    /// The initial state.
    pub fn new(what: &str) -> Watch {
        Watch {
            stopped: AtomicBool::new(false),
            now: Mutex::new((what.to_owned(), 0.0)),
            files: Mutex::default(),
        }
    }

    /// The current step and the completed fraction, 0 to 1.
    pub fn now(&self) -> (String, f32) {
        self.now
            .lock()
            .map_or_else(|e| e.into_inner().clone(), |now| now.clone())
    }

    /// Files read or looked up, sorted.
    pub fn files(&self) -> Vec<PathBuf> {
        self.files
            .lock()
            .map_or_else(|e| e.into_inner().clone(), |files| files.clone())
            .into_iter()
            .collect()
    }

    /// Cancels the loading.
    pub fn stop(&self) {
        self.stopped.store(true, Relaxed);
    }
}

/// A share of the work.
#[derive(Clone, Copy, Debug)]
pub(super) struct Progress<'a> {
    watch: &'a Watch,
    from: f32,
    size: f32,
}

impl<'a> Progress<'a> {
    /// All of the work.
    pub fn new(watch: &'a Watch) -> Progress<'a> {
        Progress {
            watch,
            from: 0.0,
            size: 1.0,
        }
    }

    /// One of `count` equal shares of this one.
    pub fn share(self, index: usize, count: usize) -> Progress<'a> {
        let size = self.size / count as f32;
        Progress {
            from: self.from + index as f32 * size,
            size,
            ..self
        }
    }

    /// Reports a step and its completed fraction, 0 to 1. Fails after a cancellation.
    pub fn step(self, what: &str, done: f32) -> Result<(), SceneError> {
        if let Ok(mut now) = self.watch.now.lock() {
            *now = (what.to_owned(), self.from + done * self.size);
        }
        if self.stopped() {
            Err(SceneError::Cancelled)
        } else {
            Ok(())
        }
    }

    /// Records a file that is read or looked up; the scene may change with it.
    pub fn reads(self, file: &Path) {
        if let Ok(mut files) = self.watch.files.lock() {
            files.insert(file.into());
        }
    }

    /// Whether loading was cancelled. Loops poll it and then end with any error;
    /// [`Scene::open`](super::Scene::open) reports the cancellation.
    pub fn stopped(self) -> bool {
        self.watch.stopped.load(Relaxed)
    }
}
