//! Looks at folders every second, where the system sends no events.
//!
//! The watcher of `notify` 8.2 for this compares whole seconds, and only for a later date: it
//! misses a second save within a second and a file that comes back with an older date.

use notify::{Event, EventKind, RecursiveMode};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use std::time::{Duration, SystemTime};
use walkdir::WalkDir;

/// Time between two looks.
const EVERY: Duration = Duration::from_secs(1);

/// The date of the last change and the length in bytes: a file with another of either has changed.
type Stamp = (Option<SystemTime>, u64);
type Folders = BTreeMap<PathBuf, (RecursiveMode, BTreeMap<PathBuf, Stamp>)>;

/// Folders, and the files in them at the last look. Dropping it ends the thread.
#[derive(Default)]
pub(super) struct Poll(Arc<Mutex<Folders>>);

impl Poll {
    /// Looks from now on, in a thread of its own; `changed` gets an event for every file that
    /// changed.
    pub(super) fn start(
        mut changed: impl FnMut(notify::Result<Event>) + Send + 'static,
    ) -> std::io::Result<Poll> {
        let poll = Poll::default();
        let weak = Arc::downgrade(&poll.0);
        let look = move || {
            while let Some(files) = look(&weak) {
                for file in files {
                    changed(Ok(Event::new(EventKind::Any).add_path(file)));
                }
                std::thread::sleep(EVERY);
            }
        };
        std::thread::Builder::new()
            .name("poll".into())
            .spawn(look)?;
        Ok(poll)
    }

    pub(super) fn watch(&self, folder: &Path, mode: RecursiveMode) {
        let now = stamps(folder, mode);
        lock(&self.0).insert(folder.into(), (mode, now));
    }

    pub(super) fn unwatch(&self, folder: &Path) {
        lock(&self.0).remove(folder);
    }
}

/// The files that changed since the last look; none once the list of folders is gone.
fn look(folders: &Weak<Mutex<Folders>>) -> Option<Vec<PathBuf>> {
    // The lock is not held while a slow file system answers: the window waits for it in `watch`.
    let list: Vec<_> = lock(&*folders.upgrade()?)
        .iter()
        .map(|(folder, f)| (folder.clone(), f.0))
        .collect();
    let mut changed = Vec::new();
    for (folder, mode) in list {
        let now = stamps(&folder, mode);
        let folders = folders.upgrade()?;
        let mut folders = lock(&folders);
        let Some((_, before)) = folders.get_mut(&folder) else {
            continue;
        };
        changed.extend(
            before
                .keys()
                .filter(|file| !now.contains_key(*file))
                .cloned(),
        );
        changed.extend(
            now.iter()
                .filter(|(file, stamp)| before.get(*file) != Some(*stamp))
                .map(|n| n.0.clone()),
        );
        *before = now;
    }
    Some(changed)
}

fn stamps(folder: &Path, mode: RecursiveMode) -> BTreeMap<PathBuf, Stamp> {
    let depth = if mode == RecursiveMode::Recursive {
        usize::MAX
    } else {
        1
    };
    let files = WalkDir::new(folder)
        .max_depth(depth)
        .follow_links(true)
        .into_iter()
        .flatten();
    files
        .filter(|entry| entry.file_type().is_file())
        .filter_map(|entry| Some((entry.metadata().ok()?, entry.into_path())))
        .map(|(data, path)| (path, (data.modified().ok(), data.len())))
        .collect()
}

/// No thread leaves a list half changed, so one that panicked does no harm.
fn lock(folders: &Mutex<Folders>) -> MutexGuard<'_, Folders> {
    folders.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_change_is_seen_whatever_its_date() {
        let home = tempfile::tempdir().unwrap();
        let file = home.path().join("a.obj");
        let at = |file: &Path, date: SystemTime| {
            std::fs::File::options()
                .write(true)
                .open(file)
                .unwrap()
                .set_modified(date)
                .unwrap();
        };
        let second = SystemTime::UNIX_EPOCH + Duration::from_secs(1_700_000_000);
        std::fs::write(&file, "1").unwrap();
        at(&file, second);

        let poll = Poll::default();
        poll.watch(home.path(), RecursiveMode::NonRecursive);
        let weak = Arc::downgrade(&poll.0);
        let changed = || -> Vec<String> {
            let names = look(&weak).unwrap().into_iter();
            names
                .map(|path| {
                    path.strip_prefix(home.path())
                        .unwrap()
                        .to_string_lossy()
                        .into_owned()
                })
                .collect()
        };
        assert_eq!(changed(), [""; 0]);
        at(&file, second + Duration::from_millis(400));
        assert_eq!(changed(), ["a.obj"], "again within a second");
        at(&file, second - Duration::from_hours(1));
        assert_eq!(changed(), ["a.obj"], "an older file came back");
        std::fs::write(&file, "12").unwrap();
        at(&file, second - Duration::from_hours(1));
        assert_eq!(changed(), ["a.obj"], "another length, the same date");
        std::fs::remove_file(&file).unwrap();
        assert_eq!(changed(), ["a.obj"], "removed");
        std::fs::write(&file, "12").unwrap();
        assert_eq!(changed(), ["a.obj"], "made");

        let below = home.path().join("below/b.png");
        std::fs::create_dir(home.path().join("below")).unwrap();
        std::fs::write(&below, "1").unwrap();
        assert_eq!(changed(), [""; 0], "not a folder's own file");
        poll.watch(home.path(), RecursiveMode::Recursive);
        std::fs::write(&below, "12").unwrap();
        assert_eq!(changed(), ["below/b.png"]);
        poll.unwatch(home.path());
        assert_eq!(changed(), [""; 0]);
        drop(poll);
        assert_eq!(look(&weak), None);
    }
}
