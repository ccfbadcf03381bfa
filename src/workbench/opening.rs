//! What is opened: experiments, scenes, files that were edited or dropped on the window.

use crate::experiment::Experiment;
use crate::lab::viewpoint_of;
use crate::workbench::desired::request::SideRequest;
use crate::workbench::desired::save;
use crate::workbench::{Workbench, watch};
use serde_json::json;
use std::path::Path;
use std::time::Instant;

impl Workbench {
    pub(super) fn files_changed(&mut self, changed: &watch::Changed) {
        if changed.method {
            self.desired.revision += 1;
            self.changed_at = Some(Instant::now());
            self.event("changed", json!({ "revision": self.desired.revision }));
        }
        if changed.scene {
            self.desired.scene_revision += 1;
        }
        for path in &changed.experiments {
            self.experiment_changed(path);
        }
        self.send_request();
    }

    /// The open experiment's file was edited: its values take the place of those here.
    fn experiment_changed(&mut self, path: &Path) {
        if path
            .file_stem()
            .is_none_or(|s| s.to_string_lossy() != self.name.as_str())
        {
            return;
        }
        let own = self
            .written
            .take()
            .is_some_and(|w| w.file_name() == path.file_name());
        match Experiment::read(path) {
            Ok(_) if own => {}
            Ok(experiment) => {
                self.sides[0].errors.clear();
                let pointer = self.sides[0]
                    .info
                    .as_ref()
                    .and_then(|i| i.graph.pointer.as_deref());
                let shown = self.desired.sides[0].clone().unwrap_or_default();
                if sorted(side_of(&experiment)) != sorted(save::without_pointer(&shown, pointer))
                    || experiment.scene != self.desired.scene
                    || picture_of(&experiment) != self.desired.environment
                {
                    self.open(&experiment);
                    self.status = format!("read {} again", path.display());
                }
            }
            Err(errors) => self.sides[0].errors = errors,
        }
    }

    /// Shows an experiment in side A.
    pub(super) fn open(&mut self, experiment: &Experiment) {
        let before = self.missing_scene().is_none().then(|| self.state());
        self.history.opens();
        self.name.clone_from(&experiment.name);
        self.desired.sides[0] = Some(side_of(experiment));
        if self.desired.scene == experiment.scene
            && self.desired.environment == picture_of(experiment)
        {
            if let Some(scene) = &self.scene {
                self.desired.camera = viewpoint_of(experiment, scene).ok().map(|v| v.camera);
                self.desired.lights = save::lights(experiment, scene).unwrap_or_default();
            }
        } else {
            self.open_scene(&experiment.scene);
            self.before_loading = before.or(self.before_loading.take());
            self.desired.environment = picture_of(experiment);
            self.view.picture.clone_from(&self.desired.environment);
        }
        self.experiment = Some(experiment.clone());
        self.desired.clock.at = experiment.time;
        self.desired.clock.jumps += 1;
    }

    /// The scene that is asked for, if it is another than the loaded one, with the words that it is not there.
    pub(super) fn missing_scene(&self) -> Option<String> {
        let asked = (&self.desired.scene, &self.desired.environment);
        match &self.loaded_scene {
            Some(loaded) if asked == (&loaded.0, &loaded.1) => None,
            _ if self.no_scene => Some(format!(
                "scene '{}' could not be loaded; choose another one",
                asked.0
            )),
            _ => Some(format!("scene '{}' is still being loaded", asked.0)),
        }
    }

    /// The length of [`Workbench::scene_warnings`], without their texts: every frame of the window shows it.
    pub(super) fn scene_warning_count(&self) -> usize {
        self.scene.as_ref().map_or(0, |s| {
            s.warnings.len() + usize::from(s.triangle_count() == 0)
        })
    }

    /// What is to be known about the loaded scene.
    pub(super) fn scene_warnings(&self) -> Vec<String> {
        let Some(scene) = &self.scene else {
            return Vec::new();
        };
        let empty = (scene.triangle_count() == 0)
            .then(|| format!("scene '{}' has no triangles", scene.name));
        scene.warnings.iter().cloned().chain(empty).collect()
    }

    pub(super) fn open_scene(&mut self, spec: &str) {
        self.no_scene = false;
        if self.missing_scene().is_none() {
            self.before_loading = Some(self.state());
        }
        self.desired.scene = spec.to_string();
        self.desired.environment.clear();
        self.view.picture.clear();
        self.desired.lights = None;
        self.returning = false;
    }

    /// A file was dropped on the window.
    pub fn dropped(&mut self, path: &Path) {
        let spec = path.to_string_lossy().into_owned();
        let is_ron = crate::files::ending(path) == "ron";
        match Experiment::read(path) {
            Ok(experiment) if is_ron => {
                self.watch.experiment(path);
                self.open(&experiment);
            }
            _ => {
                self.experiment = None;
                self.open_scene(&spec);
            }
        }
        self.send_request();
    }

    /// The present experiment, as side A shows it.
    pub(super) fn bare(&self) -> Experiment {
        let side = self.desired.sides[0].clone().unwrap_or_default();
        Experiment {
            name: self.name.clone(),
            ..self.desired.experiment(&side)
        }
    }
}

/// A side with its parameters in order: what a file says does not depend on theirs.
fn sorted(mut side: SideRequest) -> SideRequest {
    side.params.sort();
    side
}

/// The file of the picture that an experiment gives the sky.
pub(super) fn picture_of(experiment: &Experiment) -> String {
    experiment
        .environment
        .as_ref()
        .and_then(|e| e.value.file.clone())
        .unwrap_or_default()
}

/// A side that shows an experiment.
pub(super) fn side_of(experiment: &Experiment) -> SideRequest {
    SideRequest {
        graph: experiment.graph.clone(),
        params: experiment
            .params
            .iter()
            .map(|(name, value)| (name.value.clone(), value.clone()))
            .collect(),
    }
}
