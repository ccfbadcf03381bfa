//! Messages from other threads: the engine, the watch over files, comparisons, the inspector.

use crate::experiment::{CameraChoice, Experiment};
use crate::graph::run::Change;
use crate::lab::{Viewpoint, viewpoint_of};
use crate::scene::Scene;
use crate::workbench::desired::lights::headlight;
use crate::workbench::desired::request::LightState;
use crate::workbench::desired::save;
use crate::workbench::engine::Engine;
use crate::workbench::engine::report::{BuiltReport, PictureReport, Report};
use crate::workbench::picture::compare::MODES;
use crate::workbench::tabs::TABS;
use crate::workbench::{COMPARISON, NewPixels, Workbench, events};
use serde_json::json;
use std::sync::Arc;
use std::time::Duration;

/// How often a working engine is looked at.
const LOOK: Duration = Duration::from_secs(1);

impl Workbench {
    /// Takes in the messages of other threads. Returns how soon to poll again, if a message is
    /// about to come.
    pub fn poll_events(&mut self) -> Option<Duration> {
        while let Ok(report) = self.engine.reports.try_recv() {
            self.report(report);
        }
        while let Some((mode, map)) = self.comparison.work.take() {
            if let Ok(Some(map)) = map {
                self.show(NewPixels {
                    picture: COMPARISON,
                    size: map.size,
                    bytes: Some(map.bytes.clone()),
                    shared: None,
                });
                let (mean, max, differing) = (map.mean, map.max, map.differing);
                let name = MODES.iter().find(|m| m.0 == mode).map_or("", |m| m.1);
                self.event(
                    "compared",
                    json!({ "mode": name, "mean": mean, "max": max, "differing": differing }),
                );
                self.comparison.shown = Some((mode, map));
            }
        }
        if let Some(why) = self.engine.failure() {
            self.replace_engine(&why);
        }
        for tab in TABS {
            (tab.poll)(self);
        }
        let wait = match self.watch.take() {
            Ok(changed) => {
                self.files_changed(&changed);
                None
            }
            Err(wait) => wait,
        };
        // An idle engine needs no polling.
        if self.engine.works() {
            Some(wait.map_or(LOOK, |w| w.min(LOOK)))
        } else {
            wait
        }
    }

    /// Leaves an engine that is no longer there to itself, and starts another.
    fn replace_engine(&mut self, why: &str) {
        let failed = (self.sent.number, self.sent.request.clone());
        self.engine = Engine::replace(
            self.setup.home.clone(),
            self.setup.gpu.clone(),
            self.setup.wake.clone(),
            failed,
        );
        (self.scene.loading, self.device) = (None, None);
        let text = format!(
            "{why}. Another engine was started: change a shader or a value, or press Restart device"
        );
        self.event("engine replaced", json!({ "text": text }));
        self.messages.trouble = Some(text);
    }

    fn report(&mut self, report: Report) {
        // A picture that is no longer wanted.
        if matches!(&report, Report::Picture(p) if self.desired.sides[p.side].is_none()) {
            return;
        }
        for tab in TABS {
            (tab.report)(self, &report);
        }
        match report {
            Report::Device(device) => {
                self.event(
                    "device",
                    json!({ "name": device.name, "driver": device.driver }),
                );
                self.device = Some(device);
                self.messages.trouble = None;
            }
            Report::Built(built) => self.built(built),
            Report::Failed {
                side,
                diagnostics,
                revision,
            } => {
                let texts: Vec<String> = diagnostics.iter().map(ToString::to_string).collect();
                self.event(
                    "failed",
                    json!({ "side": side, "errors": texts, "revision": revision }),
                );
                self.sides[side].errors = diagnostics;
            }
            Report::Set { side } => {
                self.mended(side);
            }
            Report::Picture(picture) => self.picture_came(picture),
            Report::Pixels { side, frame, bytes } => self.pixels_came(side, frame, bytes),
            Report::Loading(what, part) => self.scene.loading = Some((what, part)),
            Report::Reads(files) => self.watch.scene(&files),
            Report::Loaded(scene) => self.loaded(scene),
            Report::LoadFailed(why) => self.load_failed(why),
            Report::Checks(side, failed) => self.sides[side].checks = failed,
            Report::Statistics(side, result) => self.event(
                "pipeline statistics",
                json!({ "side": side, "passes": result.map_or(0, |p| p.len()) }),
            ),
            Report::DeviceFailed(text) => {
                self.event("device failed", json!({ "text": text }));
                self.device = None;
                self.messages.trouble = Some(text);
            }
            Report::Trouble(text) => {
                self.event("trouble", json!({ "text": text }));
                self.messages.trouble = Some(text);
            }
            // For tabs alone.
            Report::Restarted | Report::Content(_) | Report::Captured(_) | Report::Error(_) => {}
        }
    }

    fn built(&mut self, built: BuiltReport) {
        let Change {
            kept,
            built: rebuilt,
            resized,
        } = built.change;
        let (side, ms) = (built.side, built.ms);
        self.messages.status = format!(
            "Rebuilt {rebuilt} of {} pipelines in {ms:.0} ms",
            kept + rebuilt
        );
        self.event(
            "built",
            json!({ "side": side, "kept": kept, "rebuilt": rebuilt, "resized": resized, "build_ms": ms,
                "revision": built.revision, "objects": built.objects }),
        );
        self.mended(side);
        self.sides[side].info = Some(built.info);
    }

    /// Takes in the pixels of a frame. A window that did not keep up has none of that frame.
    fn pixels_came(&mut self, side: usize, frame: u64, bytes: Arc<Vec<u8>>) {
        let picture = self.sides[side].picture.as_mut();
        let Some(picture) = picture.filter(|p| p.frame == frame) else {
            return;
        };
        picture.bytes = Some(bytes.clone());
        if picture.shared.is_none() {
            let size = picture.size;
            self.show(NewPixels {
                picture: side,
                size,
                bytes: Some(bytes),
                shared: None,
            });
        }
    }

    fn load_failed(&mut self, why: String) {
        self.scene.loading = None;
        self.event(
            "load failed",
            json!({ "why": why, "scene": self.desired.scene }),
        );
        self.scene.missing = self.scene.loaded.is_none();
        self.messages.trouble = Some(why);
        self.return_to_scene();
        self.send_request();
    }

    /// Has the host show these in place of those that wait for it.
    pub(super) fn show(&mut self, pixels: NewPixels) {
        // A frame without a picture keeps the last one.
        if pixels.bytes.is_some() || pixels.shared.is_some() {
            self.pixels.retain(|p| p.picture != pixels.picture);
            self.pixels.push(pixels);
        }
    }

    fn mended(&mut self, side: usize) {
        if !self.sides[side].errors.is_empty() {
            self.sides[side].errors.clear();
            self.event("mended", json!({ "side": side }));
        }
    }

    fn picture_came(&mut self, picture: PictureReport) {
        let number = picture.side;
        let (bytes, shared) = (picture.bytes.clone(), picture.shared.clone());
        self.show(NewPixels {
            picture: number,
            size: picture.size,
            bytes,
            shared,
        });
        if self.setup.events.is_some() {
            let since = self
                .reload
                .changed_at
                .map(|t| t.elapsed().as_secs_f64() * 1e3);
            let fields = json!({ "side": number, "preview": picture.preview, "frame": picture.frame,
                "request": picture.request, "size": picture.size, "time": picture.time, "gpu_ms": picture.times.gpu_ms,
                "skipped": picture.times.skipped.len(), "left": picture.left,
                "since_change_ms": since,
                "shared": picture.shared.is_some(),
                "fingerprint": picture.bytes.as_ref().map(|b| events::fingerprint(b)) });
            self.event("picture", fields);
        }
        self.sides[number].picture = Some(picture);
    }

    /// Adds a headlight to a scene without any light, as an unsaved change.
    fn light_unlit(&mut self, scene: &Scene) {
        let Some(camera) = self.desired.camera else {
            return;
        };
        if self.desired.lights.is_some() || !scene.is_unlit() {
            return;
        }
        if self.experiment.baseline.is_none() {
            self.saved_state();
        }
        let mut state = LightState::of(scene);
        state.lights.push(headlight(&camera, self.scene.diagonal));
        self.desired.lights = Some(state);
    }

    fn loaded(&mut self, scene: Arc<Scene>) {
        self.scene.loading = None;
        self.messages.trouble = None;
        self.scene.source = Some((self.desired.scene.clone(), self.desired.environment.clone()));
        (self.scene.before, self.scene.missing) = (None, false);
        let same = self
            .scene
            .loaded
            .as_ref()
            .is_some_and(|s| s.name == scene.name)
            && self.desired.camera.is_some();
        let returns = std::mem::take(&mut self.undo.returning);
        let is_opened = !returns && (!same || self.experiment.file.is_some());
        if is_opened {
            let fallback = Experiment {
                camera: CameraChoice::Named("default".into()),
                ..self.bare()
            };
            let experiment = self.experiment.file.take().unwrap_or(fallback);
            match save::lights(&experiment, &scene) {
                Ok(lights) => self.desired.lights = lights,
                Err(e) => self.messages.trouble = Some(e.to_string()),
            }
            match viewpoint_of(&experiment, &scene) {
                Ok(v) => self.desired.camera = Some(v.camera),
                Err(e) => {
                    self.messages.trouble = Some(e.to_string());
                    self.desired.camera = Some(Viewpoint::around(&scene).camera);
                }
            }
        }
        let (low, high) = scene.bounds();
        self.scene.diagonal = (high - low).length().max(1e-3);
        if is_opened {
            self.light_unlit(&scene);
        }
        let (name, triangles) = (scene.name.clone(), scene.triangle_count());
        let known = self.scene_warnings();
        self.scene.loaded = Some(scene);
        let warnings = self.scene_warnings();
        // Dismissed warnings stay away, for example when only the sky changes.
        let new = warnings.iter().any(|warning| !known.contains(warning));
        self.scene.warned = new || self.scene.warned && !warnings.is_empty();
        self.event(
            "loaded",
            json!({ "scene": name, "triangles": triangles, "warnings": warnings }),
        );
        self.send_request();
    }
}
