//! Opening: experiments, scenes, and files that were edited or dropped on the window.

use crate::experiment::Experiment;
use crate::lab::viewpoint_of;
use crate::workbench::desired::request::{LightState, SideRequest};
use crate::workbench::desired::save;
use crate::workbench::{Workbench, watch};
use serde_json::json;
use std::path::Path;
use std::time::Instant;

/// Files that are remembered.
const RECENT: usize = 12;

/// What of the state an experiment's file keeps, but for the camera.
#[derive(Default, PartialEq)]
pub(super) struct Edited {
    /// Parameters of A, without the probe and the slice.
    pub(super) side: SideRequest,
    scene: String,
    environment: String,
    lights: Option<LightState>,
}

impl Workbench {
    pub(super) fn files_changed(&mut self, changed: &watch::Changed) {
        if changed.method {
            self.desired.revision += 1;
            self.reload.changed_at = Some(Instant::now());
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
            .is_none_or(|s| s.to_string_lossy() != self.experiment.name.as_str())
        {
            return;
        }
        let own = self
            .experiment
            .written
            .take()
            .is_some_and(|w| w.file_name() == path.file_name());
        match Experiment::read(path) {
            Ok(_) if own => {}
            Ok(experiment) => {
                self.sides[0].errors.clear();
                let graph = self.sides[0].info.as_ref().map(|i| &*i.graph);
                let shown = self.desired.sides[0].clone().unwrap_or_default();
                if sorted(SideRequest::of(&experiment))
                    != sorted(save::without_cursors(&shown, graph))
                    || experiment.scene != self.desired.scene
                    || picture_of(&experiment) != self.desired.environment
                {
                    self.open(&experiment);
                    self.messages.status = format!("read {} again", path.display());
                }
            }
            Err(errors) => self.sides[0].errors = errors,
        }
    }

    /// Shows an experiment in side A.
    pub(super) fn open(&mut self, experiment: &Experiment) {
        let before = self.missing_scene().is_none().then(|| self.state());
        self.undo.history.opens();
        self.experiment.name.clone_from(&experiment.name);
        self.experiment.baseline = None;
        self.desired.sides[0] = Some(SideRequest::of(experiment));
        if self.desired.scene == experiment.scene
            && self.desired.environment == picture_of(experiment)
        {
            if let Some(scene) = &self.scene.loaded {
                self.desired.camera = viewpoint_of(experiment, scene).ok().map(|v| v.camera);
                self.desired.lights = save::lights(experiment, scene).unwrap_or_default();
            }
        } else {
            self.open_scene(&experiment.scene);
            self.scene.before = before.or(self.scene.before.take());
            self.desired.environment = picture_of(experiment);
        }
        self.experiment.file = Some(experiment.clone());
        self.desired.clock.at = experiment.time;
        self.desired.clock.jumps += 1;
    }

    /// The requested scene, if it is not the loaded one, with a note that it is missing.
    pub(super) fn missing_scene(&self) -> Option<String> {
        let asked = (&self.desired.scene, &self.desired.environment);
        match &self.scene.source {
            Some(loaded) if asked == (&loaded.0, &loaded.1) => None,
            _ if self.scene.missing => Some(format!(
                "scene '{}' could not be loaded; choose another one",
                asked.0
            )),
            _ => Some(format!("scene '{}' is still being loaded", asked.0)),
        }
    }

    /// The length of [`Workbench::scene_warnings`], without their texts: every frame of the window
    /// shows it.
    pub(super) fn scene_warning_count(&self) -> usize {
        self.scene.loaded.as_ref().map_or(0, |s| {
            s.warnings.len() + usize::from(s.triangle_count() == 0)
        })
    }

    /// Warnings about the loaded scene.
    pub(super) fn scene_warnings(&self) -> Vec<String> {
        let Some(scene) = &self.scene.loaded else {
            return Vec::new();
        };
        let empty = (scene.triangle_count() == 0)
            .then(|| format!("scene '{}' has no triangles", scene.name));
        scene.warnings.iter().cloned().chain(empty).collect()
    }

    pub(super) fn open_scene(&mut self, spec: &str) {
        self.scene.missing = false;
        if self.missing_scene().is_none() {
            self.scene.before = Some(self.state());
        }
        self.desired.scene = spec.to_string();
        self.desired.environment.clear();
        self.desired.lights = None;
        self.undo.returning = false;
    }

    /// A file was dropped on the window.
    pub fn dropped(&mut self, path: &Path) {
        let spec = path.to_string_lossy().into_owned();
        self.opened_file(path);
        let is_ron = crate::files::ending(path) == "ron";
        match Experiment::read(path) {
            Ok(experiment) if is_ron => {
                self.watch.experiment(path);
                self.session.file = path.to_path_buf();
                self.open(&experiment);
            }
            _ => {
                self.experiment.file = None;
                self.open_scene(&spec);
            }
        }
        self.send_request();
    }

    /// Puts a file at the head of the recent ones.
    pub(super) fn opened_file(&mut self, path: &Path) {
        let recent = &mut self.experiment.recent;
        recent.retain(|other| other != path);
        recent.insert(0, path.to_path_buf());
        recent.truncate(RECENT);
    }

    /// What saving the experiment would keep. The camera is left out: looking around is no edit.
    fn edited(&self) -> Edited {
        let graph = self.sides[0].info.as_ref().map(|i| &*i.graph);
        let side = self.desired.sides[0].clone().unwrap_or_default();
        Edited {
            side: sorted(save::without_cursors(&side, graph)),
            scene: self.desired.scene.clone(),
            environment: self.desired.environment.clone(),
            lights: self.desired.lights.clone(),
        }
    }

    /// Remembers the experiment as it was opened, once its scene is there, and compares with it.
    pub(super) fn note_baseline(&mut self) {
        let is_there = self.missing_scene().is_none() && self.experiment.file.is_none();
        if self.experiment.baseline.is_none() && is_there && self.sides[0].info.is_some() {
            self.saved_state();
        }
        let baseline = self.experiment.baseline.as_ref();
        self.experiment.modified = baseline.is_some_and(|saved| *saved != self.edited());
    }

    /// Takes the present state for the saved one.
    pub(super) fn saved_state(&mut self) {
        self.experiment.baseline = Some(self.edited());
        self.experiment.modified = false;
    }

    /// The present experiment, as side A shows it.
    pub(super) fn bare(&self) -> Experiment {
        let side = self.desired.sides[0].clone().unwrap_or_default();
        Experiment {
            name: self.experiment.name.clone(),
            ..self.desired.experiment(&side)
        }
    }
}

/// A side with its parameters in order, so that saved files do not depend on the order of edits.
fn sorted(mut side: SideRequest) -> SideRequest {
    side.params.sort_by(|a, b| a.0.cmp(&b.0));
    side.off.sort();
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
