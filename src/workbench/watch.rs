//! Watches files. Folders are watched, not files: editors save by writing a new file and renaming it.

use crossbeam_channel::{Receiver, unbounded};
use notify::{Event, EventKind, RecursiveMode, Watcher};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Which files changed, by what they are for.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Changed {
    /// Graphs or shaders.
    pub method: bool,
    /// The open scene's files.
    pub scene: bool,
    /// Experiments that changed.
    pub experiments: Vec<PathBuf>,
}

/// Watches the folders of the method, of experiments and of the open scene.
pub struct Watch {
    watcher: Option<notify::RecommendedWatcher>,
    events: Receiver<(Instant, PathBuf)>,
    method: [PathBuf; 2],
    configs: PathBuf,
    scene: Option<PathBuf>,
    waiting: Vec<(Instant, PathBuf)>,
    /// Why nothing is watched, if so.
    pub trouble: Option<String>,
}

/// An editor's save is several events: what follows within this time is one change.
const QUIET: Duration = Duration::from_millis(8);

impl Watch {
    /// Starts watching; `wake` is called when something changed.
    pub fn new(root: &Path, wake: Arc<dyn Fn() + Send + Sync>) -> Watch {
        let (send, events) = unbounded();
        let handler = move |event: notify::Result<Event>| {
            let Ok(event) = event else { return };
            if matches!(event.kind, EventKind::Access(_)) {
                return;
            }
            let now = Instant::now();
            let mut any = false;
            for path in event.paths.into_iter().filter(|p| is_source(p)) {
                any |= send.send((now, path)).is_ok();
            }
            if any {
                wake();
            }
        };
        let absolute = |name: &str| {
            let path = root.join(name);
            path.canonicalize().unwrap_or(path)
        };
        let mut watch = Watch {
            watcher: None,
            events,
            method: [absolute("passes"), absolute("shaders")],
            configs: absolute("configs"),
            scene: None,
            waiting: Vec::new(),
            trouble: None,
        };
        match notify::recommended_watcher(handler) {
            Ok(mut watcher) => {
                for folder in watch.method.iter().chain([&watch.configs]).filter(|f| f.is_dir()) {
                    if let Err(e) = watcher.watch(folder, RecursiveMode::Recursive) {
                        watch.trouble = Some(format!("changes in {} go unseen: {e}", folder.display()));
                    }
                }
                watch.watcher = Some(watcher);
            }
            Err(e) => watch.trouble = Some(format!("changes of files go unseen: {e}")),
        }
        watch
    }

    /// Watches the folder of a scene's file too; a built-in scene has none.
    pub fn scene(&mut self, spec: &str) {
        let path = Path::new(spec);
        let folder = path.is_file().then(|| path.parent()).flatten().and_then(|p| p.canonicalize().ok());
        if folder == self.scene {
            return;
        }
        if let Some(watcher) = &mut self.watcher {
            if let Some(old) = self.scene.take().filter(|f| !f.starts_with(&self.configs)) {
                let _ = watcher.unwatch(&old);
            }
            if let Some(new) = folder.as_ref().filter(|f| !f.starts_with(&self.configs))
                && let Err(e) = watcher.watch(new, RecursiveMode::NonRecursive)
            {
                self.trouble = Some(format!("changes in {} go unseen: {e}", new.display()));
            }
        }
        self.scene = folder;
    }

    /// What changed, once it has been quiet for a moment; else how long to wait before asking again.
    pub fn take(&mut self) -> Result<Changed, Option<Duration>> {
        self.waiting.extend(self.events.try_iter());
        let Some(last) = self.waiting.iter().map(|w| w.0).max() else { return Err(None) };
        if let Some(wait) = QUIET.checked_sub(last.elapsed()) {
            return Err(Some(wait));
        }
        let mut changed = Changed::default();
        for (_, path) in self.waiting.drain(..) {
            if self.method.iter().any(|m| path.starts_with(m)) {
                changed.method = true;
            } else if path.starts_with(&self.configs)
                && path.parent() == Some(&self.configs)
                && !changed.experiments.contains(&path)
            {
                changed.experiments.push(path.clone());
            }
            if self.scene.as_ref().is_some_and(|s| path.starts_with(s)) && is_of_a_scene(&path) {
                changed.scene = true;
            }
        }
        Ok(changed)
    }
}

/// Scene files, models and what they refer to: other programs, and this one, may write beside them.
fn is_of_a_scene(path: &Path) -> bool {
    const ENDINGS: [&str; 14] =
        ["ron", "obj", "mtl", "gltf", "glb", "bin", "png", "jpg", "jpeg", "tga", "bmp", "dds", "hdr", "exr"];
    ENDINGS.contains(&crate::files::ending(path).as_str())
}

/// Not an editor's own file: hidden, or a backup, or a swap.
fn is_source(path: &Path) -> bool {
    let name = path.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
    !(name.is_empty()
        || name.starts_with('.')
        || name.ends_with('~')
        || name.ends_with(".swp")
        || name.ends_with(".tmp")
        || name.bytes().all(|b| b.is_ascii_digit()))
}
