//! The scene that is desired, loaded on a thread of its own.

use super::Run;
use super::guard::guarded;
use super::report::Report;
use crate::lab::LabError;
use crate::scene::{Scene, SceneError};
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

impl Run<'_> {
    pub(super) fn load_scene(&mut self) {
        let key = (
            self.desired.scene.clone(),
            self.desired.environment.clone(),
            self.desired.scene_revision,
        );
        if key.0.is_empty() || self.scene_key.as_ref() == Some(&key) {
            return;
        }
        self.scene_key = Some(key.clone());
        if let Some(cancel) = self.loading.take() {
            cancel.store(true, Ordering::Relaxed);
        }
        let cancel = Arc::new(AtomicBool::new(false));
        self.loading = Some(cancel.clone());
        let (out, loaded) = (self.out.clone(), self.loaded.clone());
        out.send(Report::Loading(key.0.clone(), 0.0));
        std::thread::spawn(move || {
            let last = Mutex::new(Instant::now());
            let progress = |what: &str, part: f32| {
                if cancel.load(Ordering::Relaxed) {
                    return ControlFlow::Break(());
                }
                // The window need not hear of every texture.
                if let Ok(mut last) = last.lock()
                    && last.elapsed() > Duration::from_millis(30)
                {
                    *last = Instant::now();
                    out.send(Report::Loading(what.to_string(), part));
                }
                ControlFlow::Continue(())
            };
            let open = || {
                let (scene, mut files) = Scene::open_with_files(&key.0, &progress);
                if !key.1.is_empty() {
                    files.push(key.1.clone().into());
                }
                (
                    scene.and_then(|scene| scene.under(Path::new(&key.1))),
                    files,
                )
            };
            let (scene, files) = guarded(open).unwrap_or_else(|message| {
                (
                    Err(SceneError::Model {
                        path: key.0.clone().into(),
                        message,
                    }),
                    vec![key.0.clone().into()],
                )
            });
            // A load that was replaced by another has no receiver.
            if !cancel.load(Ordering::Relaxed) || matches!(scene, Err(SceneError::Cancelled)) {
                out.send(Report::Reads(files));
                let _ = loaded.send(scene.map(Arc::new));
            }
        });
    }

    pub(super) fn scene_came(
        &mut self,
        scene: Result<Arc<Scene>, SceneError>,
    ) -> Result<(), LabError> {
        match scene {
            Ok(scene) => {
                self.loading = None;
                self.loaded_key.clone_from(&self.scene_key);
                self.scene = Some(scene.clone());
                self.scene_number += 1;
                self.out.send(Report::Loaded(scene));
                for i in 0..2 {
                    self.reconcile(i)?;
                }
            }
            Err(SceneError::Cancelled) => {
                // Cancelled for another scene, the other is being loaded by now.
                if self
                    .loading
                    .as_ref()
                    .is_some_and(|c| c.load(Ordering::Relaxed))
                {
                    self.loading = None;
                    self.stay();
                    self.out
                        .send(Report::LoadFailed("loading was cancelled".into()));
                }
            }
            Err(e) => {
                self.loading = None;
                self.stay();
                self.out.send(Report::LoadFailed(e.to_string()));
            }
        }
        Ok(())
    }

    /// The scene before stays: the window will ask for it again, and it need not be loaded.
    fn stay(&mut self) {
        let name =
            |key: &Option<(String, String, u64)>| key.as_ref().map(|k| (k.0.clone(), k.1.clone()));
        if self.loaded_key.is_some() && name(&self.loaded_key) != name(&self.scene_key) {
            self.scene_key.clone_from(&self.loaded_key);
        }
    }
}
