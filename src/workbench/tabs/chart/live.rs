//! The workbench's own dots: their times from the frames that are shown, their errors from the
//! error worker; and the reference that the errors need.

use super::gather::{Gather, Job};
use super::plot::Live;
use super::rows::short;
use crate::campaign::sweep::Subject;
use crate::results::stats::spread;
use crate::workbench::Workbench;
use crate::workbench::desired::save;
use crate::workbench::engine::Order;
use crate::workbench::engine::error_worker::{ErrorQuery, ErrorResult};
use crate::workbench::engine::report::PictureReport;
use egui::Ui;
use serde_json::json;
use std::time::{Duration, Instant};

/// Number of frames for times.
const KEPT: usize = 240;
/// Places that a dot has been at.
const TRAIL: usize = 16;
/// How long everything must stand still before its error is measured.
const QUIET: Duration = Duration::from_millis(150);
/// How long frames go on after an error was measured, to measure their time; at least two and at
/// most 32.
const MEASURED: Duration = Duration::from_millis(400);
/// Default samples of a reference, as in `conelab reference`.
const SAMPLES: u64 = 256;

/// Times, error and trail of side A or B.
#[derive(Default)]
pub(super) struct Side {
    /// GPU times of the frames of the last request, ms.
    pub(super) times: Vec<f64>,
    request: u64,
    /// The last query sent to the error worker, with the number of the render request.
    asked: Option<(u64, ErrorQuery)>,
    pub(super) error: Option<ErrorResult>,
    trail: Vec<(f64, f64)>,
}

/// The live part of the chart.
pub struct State {
    pub(super) sides: [Side; 2],
    /// Number of the request that was sent last, and when it was first seen.
    since: (u64, Instant),
    pub(super) gather: Option<Gather>,
    /// Number of gathered references.
    gathered: u64,
    /// Samples of every pixel of the next one.
    pub(super) samples: u64,
    /// The last result, for people.
    pub(super) said: String,
    /// Validation messages of devices that gathered.
    messages: Vec<String>,
}

impl Default for State {
    fn default() -> State {
        State {
            sides: Default::default(),
            since: (0, Instant::now()),
            gather: None,
            gathered: 0,
            samples: SAMPLES,
            said: String::new(),
            messages: Vec::new(),
        }
    }
}

impl State {
    /// Scene, camera, size and time of side A's picture, as last measured.
    pub fn subject(&self) -> Option<&Subject> {
        self.sides[0]
            .error
            .as_ref()?
            .result
            .as_ref()
            .ok()
            .map(|v| &v.subject)
    }

    /// Samples of the sweep's reference and of A's, if they are not the same.
    pub fn reference_differs(&self, swept: &[(u32, u64)]) -> Option<String> {
        let result = self.sides[0].error.as_ref()?;
        let now = result.result.as_ref().ok()?.error?.samples;
        let (_, there) = swept
            .iter()
            .find(|(bounces, _)| *bounces == result.query.bounces)?;
        (now != *there).then(|| format!("reference ({there} / {now} samples)"))
    }

    /// Whether an error or a reference is on its way.
    pub fn awaits(&self) -> bool {
        self.gather.is_some() || self.sides.iter().any(Side::is_asked)
    }

    /// Where a side is; nothing as long as its error or time is not known.
    pub fn dot(&self, side: usize, sent: u64) -> Option<Live> {
        let side = &self.sides[side];
        let (ms, error) = side.place()?;
        let fresh = side.error.as_ref().is_some_and(|j| j.request >= sent);
        Some(Live {
            ms,
            error,
            fresh,
            trail: side.trail.clone(),
        })
    }
}

impl Side {
    /// Whether the error worker has it in hand.
    pub(super) fn is_asked(&self) -> bool {
        self.asked.as_ref().is_some_and(|a| !self.answers(a))
    }

    fn answers(&self, asked: &(u64, ErrorQuery)) -> bool {
        self.error
            .as_ref()
            .is_some_and(|j| j.request >= asked.0 && j.query == asked.1)
    }

    fn place(&self) -> Option<(f64, f64)> {
        let error = self.error.as_ref()?.result.as_ref().ok()?.error?.error;
        let ms = spread(self.times.clone()).median;
        (ms > 0.0 && error.is_finite()).then_some((ms, error))
    }
}

impl super::Chart {
    /// Takes in the time of a frame.
    pub(super) fn note(&mut self, picture: &PictureReport) {
        let Some(side) = self
            .live
            .sides
            .get_mut(picture.side)
            .filter(|_| !picture.preview)
        else {
            return;
        };
        if side.request != picture.request {
            // The dot moves. Its trail marks positions with a valid error.
            if let Some(at) = side.place().filter(|at| side.trail.last() != Some(at)) {
                side.trail.push(at);
            }
            let surplus = side.trail.len().saturating_sub(TRAIL);
            side.trail.drain(..surplus);
            side.request = picture.request;
            side.times.clear();
        }
        if side.times.len() == KEPT {
            side.times.remove(0);
        }
        side.times.push(picture.times.gpu_ms);
    }

    /// Metric and error of a side's picture, if measured: `FLIP 0.0310`.
    pub fn known_error(&self, side: usize, sent: u64) -> Option<String> {
        let measured = self.live.sides[side]
            .error
            .as_ref()
            .filter(|e| e.request >= sent)?;
        let error = measured.result.as_ref().ok()?.error?.error;
        Some(format!("{} {}", measured.query.metric.title, short(error)))
    }

    /// The device was replaced, so requests are sent again.
    pub(super) fn restarted(&mut self) {
        self.live.sides.iter_mut().for_each(|s| s.asked = None);
    }

    /// Stops the gathering. Returns the validation messages of its device.
    pub fn close(self, patience: Duration) -> Vec<String> {
        let mut messages = self.live.messages;
        messages.extend(self.live.gather.into_iter().flat_map(|g| g.stop(patience)));
        messages
    }
}

impl Workbench {
    /// The error to request for A and B.
    fn query(&self) -> ErrorQuery {
        let chart = &self.tabs.chart;
        let data = chart.data().map(|d| &**d);
        let (part, bounces) = chart.choice.part_and_bounces(data);
        ErrorQuery {
            part,
            metric: chart.choice.metric,
            bounces,
            gathered: chart.live.gathered,
        }
    }

    /// Whether a side shows a picture without a requested error.
    fn needs_error(&self, side: usize, query: &ErrorQuery) -> bool {
        let shows = self.sides[side]
            .picture
            .as_ref()
            .is_some_and(|p| !p.preview && p.request >= self.sent.number);
        let asked = self.tabs.chart.live.sides[side].asked.as_ref();
        let known = asked.is_some_and(|a| a.0 >= self.sent.number && a.1 == *query);
        self.desired.sides[side].is_some() && shows && self.sides[side].errors.is_empty() && !known
    }

    /// Whether an error is about to be requested.
    pub(super) fn error_pending(&self) -> bool {
        let query = self.query();
        !self.desired.clock.playing && (0..2).any(|side| self.needs_error(side, &query))
    }

    /// Asks for the errors of pictures that have come to rest.
    pub(super) fn request_errors(&mut self, ui: &Ui) {
        if self.tabs.chart.live.since.0 != self.sent.number {
            self.tabs.chart.live.since = (self.sent.number, Instant::now());
        }
        if !self.dock.shows_tab::<super::Chart>() || !self.error_pending() {
            return;
        }
        let stood = self.tabs.chart.live.since.1.elapsed();
        if stood < QUIET {
            ui.ctx().request_repaint_after(QUIET - stood);
            return;
        }
        let query = self.query();
        for side in 0..2 {
            if self.needs_error(side, &query) {
                self.tabs.chart.live.sides[side].asked = Some((self.sent.number, query.clone()));
                self.engine.order(Order::MeasureError(side, query.clone()));
            }
        }
    }

    /// Takes in an answer of the error worker.
    pub(super) fn error_came(&mut self, result: ErrorResult) {
        let side = &mut self.tabs.chart.live.sides[result.side];
        let subject = |j: &ErrorResult| j.result.as_ref().ok().map(|v| v.subject.clone());
        let other =
            |old: &ErrorResult| old.query != result.query || subject(old) != subject(&result);
        if side.error.as_ref().is_some_and(other) {
            side.trail.clear();
        }
        let ms = spread(side.times.clone()).median;
        let measured = result.result.as_ref().ok();
        let event = json!({ "side": result.side, "request": result.request, "part": result.query.part,
            "metric": result.query.metric.key, "bounces": result.query.bounces, "gpu_ms": ms,
            "error": measured.and_then(|v| v.error).map(|e| e.error),
            "samples": measured.and_then(|v| v.error).map(|e| e.samples),
            "why": result.result.as_ref().err() });
        side.error = Some(result);
        // A single frame after a rest is slower than many: clocks are low. The error worker is not
        // slowed by those that follow.
        if !self.tabs.chart.live.awaits() {
            self.engine.order(Order::Frames(
                (MEASURED.as_secs_f64() * 1e3 / ms.max(0.1)).clamp(2.0, 32.0) as u32,
            ));
        }
        self.event("error", event);
    }

    /// Gathers the reference of A's picture.
    pub(super) fn start_gathering(&mut self) {
        let (side, picture) = (&self.desired.sides[0], &self.sides[0].picture);
        let (Some(side), Some(scene), Some(picture)) = (side, &self.scene.loaded, picture) else {
            return;
        };
        let (name, time) = (&self.experiment.name, picture.time);
        let experiment = save::still(&self.desired, side, name, time, scene);
        self.layout.fixed_size = Some(experiment.size);
        let (bounces, samples) = (self.query().bounces, self.tabs.chart.live.samples);
        let (home, gpu) = (self.setup.home.clone(), self.setup.gpu.clone());
        let job = Job {
            home,
            gpu,
            experiment,
            scene: scene.clone(),
            bounces,
            samples,
        };
        self.tabs.chart.live.said.clear();
        self.tabs.chart.live.gather = Some(Gather::start(job, self.setup.wake.clone()));
        self.event(
            "gathering",
            json!({ "bounces": bounces, "samples": samples }),
        );
    }

    /// Takes in how far the gathering is.
    pub(super) fn poll_gather(&mut self) {
        let live = &mut self.tabs.chart.live;
        let Some(gather) = &mut live.gather else {
            return;
        };
        let samples = |gather: &Gather| gather.state.map(|s| s.samples);
        let before = samples(gather);
        let result = gather.take();
        let now = samples(gather);
        if result.is_some()
            && let Some(gather) = live.gather.take()
        {
            live.messages.extend(gather.stop(Duration::from_secs(5)));
            live.gathered += 1;
        }
        if now != before {
            self.event("gathers", json!({ "samples": now }));
        }
        let Some(result) = result else { return };
        self.tabs.chart.live.said = match &result {
            Ok(samples) => format!("Reference rendered with {samples} samples per pixel"),
            Err(e) => format!("No reference: {e}"),
        };
        let why = result.as_ref().err().map(ToString::to_string);
        let fields = json!({ "samples": result.as_ref().ok(), "why": why });
        self.event("gathered", fields);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::{METRICS, Noise};
    use crate::workbench::engine::error_worker::{PictureError, ReferenceError};

    #[test]
    fn errors_against_another_reference_are_told() {
        let subject = Subject {
            scene: "cornell".into(),
            sha256: String::new(),
            camera: String::new(),
            size: (96, 72),
            time: String::new(),
        };
        let error = Some(ReferenceError {
            error: 0.1,
            noise: Noise {
                relmse: 0.0,
                flip: 0.0,
                structure: 0.0,
            },
            samples: 256,
        });
        let query = ErrorQuery {
            part: "total".into(),
            metric: &METRICS[0],
            bounces: 2,
            gathered: 0,
        };
        let mut state = State::default();
        assert_eq!(
            state.reference_differs(&[(2, 32)]),
            None,
            "nothing is measured yet"
        );
        let result = Ok(PictureError { subject, error });
        state.sides[0].error = Some(ErrorResult {
            side: 0,
            request: 1,
            query,
            result,
        });
        assert_eq!(
            state.reference_differs(&[(2, 32)]).as_deref(),
            Some("reference (32 / 256 samples)")
        );
        assert_eq!(state.reference_differs(&[(1, 32), (2, 256)]), None);
    }
}
