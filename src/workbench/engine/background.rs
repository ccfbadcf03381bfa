//! Work on the shown picture in the background, while frames go on: its error, a capture.

use super::Run;
use super::error_worker::{ErrorQuery, ErrorRequest, ErrorResult};
use super::guard::guarded;
use super::report::Report;
use crate::results::timers::Rows;
use crate::workbench::desired::save;

impl Run<'_> {
    /// Sends a side's picture to the error worker. A missing picture is requested again.
    pub(super) fn measure_error(&mut self, number: usize, query: ErrorQuery) {
        let (Some(desired), Some(scene)) = (&self.desired.sides[number], &self.scene) else {
            return;
        };
        let side = &self.sides[number];
        let shown = side
            .session
            .as_ref()
            .filter(|_| side.key.as_ref() == Some(&self.key(desired, number)));
        let (Some(session), Some(loaded)) = (shown, &side.loaded) else {
            let result = Err("the requested picture is not shown".into());
            self.out.send(Report::Error(ErrorResult {
                side: number,
                request: self.number,
                query,
                result,
            }));
            return;
        };
        let request = ErrorRequest {
            side: number,
            request: side.answered,
            revision: self.desired.revision,
            query,
            lab: self.lab.clone(),
            loaded: loaded.clone(),
            reuse: session.share(),
            experiment: save::still(&self.desired, desired, "error", self.clock.now, scene),
            scene: scene.clone(),
            lit: session.scene.clone(),
            lights: self.desired.lights.clone(),
            frames: session.converging_frames(),
        };
        let _ = self.error_requests.send(request);
    }

    /// Captures on a thread of its own, from a fresh start, so that a replay can give the same
    /// bits.
    pub(super) fn capture(
        &mut self,
        number: usize,
        name: String,
        resources: Vec<String>,
        timers: Rows,
    ) {
        let (Some(desired), Some(scene)) = (self.desired.sides[number].clone(), self.scene.clone())
        else {
            let why = "there is no picture yet".to_string();
            return self.out.send(Report::Captured(Err(why)));
        };
        let graph = self.sides[number].loaded.as_ref().map(|l| &*l.graph);
        let desired = save::without_cursors(&desired, graph);
        let experiment =
            save::experiment(&self.desired, &desired, &name, self.clock.now, Some(&scene));
        let (lab, out) = (self.lab.clone(), self.out.clone());
        let folder = lab.home.captures.clone();
        std::thread::spawn(move || {
            let take = || {
                save::take(&lab, &experiment, scene, &folder, resources, timers)
                    .map_err(|e| e.to_string())
            };
            out.send(Report::Captured(guarded(take).flatten()));
        });
    }
}
