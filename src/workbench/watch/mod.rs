//! Watches files. It watches folders, because editors save by writing a new file and renaming it.

mod events;
mod mounts;
mod places;
mod poll;

use crate::workbench::background::Wake;
use crossbeam_channel::{Receiver, unbounded};
use events::{Seen, handler};
use notify::{RecommendedWatcher, RecursiveMode, Watcher};
use places::{absolute, links_below, places};
use poll::Poll;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Files that changed, by their use.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Changed {
    /// Graphs or shaders.
    pub method: bool,
    /// The open scene's files.
    pub scene: bool,
    /// Experiments that changed.
    pub experiments: Vec<PathBuf>,
}

impl Changed {
    /// All but experiments: a reload by hand.
    pub fn all() -> Changed {
        Changed {
            method: true,
            scene: true,
            experiments: Vec::new(),
        }
    }
}

/// Watches the folders of the method and of experiments, and the files of the open scene.
pub struct Watch {
    notified: Option<RecommendedWatcher>,
    polled: Option<Poll>,
    /// Makes another handler of events, for the watcher that polls.
    send: crossbeam_channel::Sender<(Instant, Seen)>,
    wake: Wake,
    events: Receiver<(Instant, Seen)>,
    method: [PathBuf; 2],
    configs: PathBuf,
    /// Files outside of the method's folders to which links inside lead.
    linked: BTreeSet<PathBuf>,
    /// Files of the open scene, and the targets of those that are links.
    scene: BTreeSet<PathBuf>,
    /// The experiment that is open, where it is not in `configs`.
    experiment: BTreeSet<PathBuf>,
    /// Watched folders, and whether each is polled.
    folders: BTreeMap<PathBuf, bool>,
    waiting: Vec<(Instant, Seen)>,
    always_poll: bool,
    /// Why changes are not seen, if so.
    pub trouble: Option<String>,
}

/// An editor's save is several events: all within this time are one change.
const QUIET: Duration = Duration::from_millis(8);

impl Watch {
    /// Starts watching; `wake` is called when something changed. `CONELAB_WATCH=poll` polls
    /// everything.
    pub fn new(root: &Path, wake: Wake) -> Watch {
        let (send, events) = unbounded();
        let under_root = |name: &str| {
            let path = root.join(name);
            path.canonicalize().unwrap_or(path)
        };
        let always_poll = std::env::var("CONELAB_WATCH").is_ok_and(|v| v == "poll");
        let notified = notify::recommended_watcher(handler(send.clone(), wake.clone()));
        let mut watch = Watch {
            trouble: notified
                .as_ref()
                .err()
                .map(|e| format!("files are checked for changes every second: {e}")),
            notified: notified.ok(),
            polled: None,
            send,
            wake,
            events,
            method: [under_root("passes"), under_root("shaders")],
            configs: under_root("configs"),
            linked: BTreeSet::new(),
            scene: BTreeSet::new(),
            experiment: BTreeSet::new(),
            folders: BTreeMap::new(),
            waiting: Vec::new(),
            always_poll,
        };
        let roots: Vec<PathBuf> = watch
            .method
            .iter()
            .chain([&watch.configs])
            .filter(|f| f.is_dir())
            .cloned()
            .collect();
        for folder in roots {
            watch.add(&folder, RecursiveMode::Recursive);
        }
        watch.follow_links();
        watch
    }

    /// Watches these files in place of those of the scene before. A file that does not exist yet is
    /// seen when it comes.
    pub fn scene(&mut self, files: &[PathBuf]) {
        self.scene = files.iter().flat_map(|f| places(f)).collect();
        self.update();
    }

    /// Watches the file of the open experiment, wherever it is.
    pub fn experiment(&mut self, file: &Path) {
        let path = absolute(file);
        self.experiment = if path.starts_with(&self.configs) {
            BTreeSet::new()
        } else {
            places(&path)
        };
        self.update();
    }

    /// The files behind links in the method's folders.
    fn follow_links(&mut self) {
        self.linked = self
            .method
            .iter()
            .flat_map(|folder| links_below(folder))
            .flat_map(|link| places(&link))
            .collect();
        self.update();
    }

    /// Watches the folders of all single files, and no others.
    fn update(&mut self) {
        let roots = [&self.method[0], &self.method[1], &self.configs];
        let files = self
            .linked
            .iter()
            .chain(&self.scene)
            .chain(&self.experiment);
        let wanted: BTreeSet<PathBuf> = files
            .filter_map(|f| f.parent())
            .filter(|f| f.is_dir() && !roots.iter().any(|r| f.starts_with(r)))
            .map(Path::to_path_buf)
            .collect();
        let old = |f: &&PathBuf| !wanted.contains(*f) && !roots.contains(f);
        let gone: Vec<PathBuf> = self.folders.keys().filter(old).cloned().collect();
        for folder in gone {
            // A folder that was deleted is not watched any more, which is no fault.
            match self.folders.remove(&folder) {
                Some(true) => drop(self.polled.as_ref().map(|w| w.unwatch(&folder))),
                _ => drop(self.notified.as_mut().map(|w| w.unwatch(&folder))),
            }
        }
        for folder in wanted {
            if !self.folders.contains_key(&folder) {
                self.add(&folder, RecursiveMode::NonRecursive);
            }
        }
    }

    fn add(&mut self, folder: &Path, mode: RecursiveMode) {
        let silent = self.always_poll || mounts::is_silent(folder);
        if let Some(watcher) = self.notified.as_mut().filter(|_| !silent) {
            match watcher.watch(folder, mode) {
                Ok(()) => {
                    self.folders.insert(folder.into(), false);
                    return;
                }
                // For example: no more watches are left (fs.inotify.max_user_watches).
                Err(e) => {
                    self.trouble = Some(format!(
                        "{} is checked for changes every second: {e}",
                        folder.display()
                    ));
                }
            }
        }
        if self.polled.is_none() {
            match Poll::start(handler(self.send.clone(), self.wake.clone())) {
                Ok(poll) => self.polled = Some(poll),
                Err(e) => {
                    self.trouble = Some(format!(
                        "changes in {} are not noticed: {e}; F5 reloads",
                        folder.display()
                    ))
                }
            }
        }
        if let Some(poll) = &self.polled {
            poll.watch(folder, mode);
            self.folders.insert(folder.into(), true);
        }
    }

    /// The changes, once nothing followed for a moment; else the time until the next look.
    pub fn take(&mut self) -> Result<Changed, Option<Duration>> {
        self.waiting.extend(self.events.try_iter());
        let Some(last) = self.waiting.iter().map(|w| w.0).max() else {
            return Err(None);
        };
        if let Some(wait) = QUIET.checked_sub(last.elapsed()) {
            return Err(Some(wait));
        }
        let mut changed = Changed::default();
        for (_, seen) in std::mem::take(&mut self.waiting) {
            match seen {
                // The system's queue was full: anything may have changed.
                Seen::Lost => {
                    changed = Changed {
                        experiments: changed.experiments,
                        ..Changed::all()
                    }
                }
                Seen::Path(path) => self.sort(path, &mut changed),
            }
        }
        if changed.method {
            self.follow_links();
        }
        Ok(changed)
    }

    fn sort(&self, path: PathBuf, changed: &mut Changed) {
        changed.method |=
            self.method.iter().any(|m| path.starts_with(m)) || self.linked.contains(&path);
        changed.scene |= self.scene.contains(&path);
        let is_experiment = path.parent() == Some(&self.configs) || self.experiment.contains(&path);
        if is_experiment && !changed.experiments.contains(&path) {
            changed.experiments.push(path);
        }
    }

    /// Folders that are watched.
    pub fn folder_count(&self) -> usize {
        self.folders.len()
    }

    /// A list of all that is watched, a folder a line.
    pub fn summary(&self) -> String {
        let files = self.scene.len();
        let mut lines = vec![format!(
            "{files} files of the scene, and graphs, shaders and experiments, in:"
        )];
        let line = |(folder, polled): (&PathBuf, &bool)| {
            format!(
                "{}{}",
                folder.display(),
                if *polled { " (every second)" } else { "" }
            )
        };
        lines.extend(self.folders.iter().map(line));
        lines.push("F5 reads all of them again.".into());
        lines.join("\n")
    }
}
