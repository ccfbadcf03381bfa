//! The workbench's own dots: their times from the frames that are shown, their errors from the judge; and the reference
//! that the errors need.

use super::super::engine::Order;
use super::super::judge::{Judged, Question};
use super::super::report::PictureReport;
use super::super::{Tab, Workbench, keep};
use super::gather::{Gather, Job};
use super::plot::Live;
use crate::stats::spread;
use crate::sweep::Subject;
use egui::Ui;
use serde_json::json;
use std::time::{Duration, Instant};

/// Frames whose times count.
const KEPT: usize = 240;
/// Places that a dot has been at.
const TRAIL: usize = 16;
/// How long everything must stand still before it is judged.
const QUIET: Duration = Duration::from_millis(150);
/// How long frames go on after a picture was judged, to measure their time; at least two and at most 32.
const MEASURED: Duration = Duration::from_millis(400);
/// Samples of a reference when nothing else is said, as `conelab reference`.
const SAMPLES: u64 = 256;

/// What is known of A or B.
#[derive(Default)]
pub(super) struct Slot {
    /// GPU times of the frames of the last request, ms.
    pub(super) times: Vec<f64>,
    request: u64,
    /// What the judge was asked last, about which request.
    asked: Option<(u64, Question)>,
    pub(super) judged: Option<Judged>,
    trail: Vec<(f64, f64)>,
}

/// The live part of the chart.
pub struct State {
    pub(super) slots: [Slot; 2],
    /// The request that was told last, and when it was first seen.
    since: (u64, Instant),
    pub(super) gather: Option<Gather>,
    /// References gathered so far.
    gathered: u64,
    /// Samples of every pixel of the next one.
    pub(super) samples: u64,
    /// What came of the last one.
    pub(super) said: String,
    /// Validation messages of devices that gathered.
    messages: Vec<String>,
}

impl Default for State {
    fn default() -> State {
        State {
            slots: Default::default(),
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
    /// What slot A looks at, as last judged.
    pub fn subject(&self) -> Option<&Subject> {
        self.slots[0].judged.as_ref()?.result.as_ref().ok().map(|v| &v.subject)
    }

    /// Whether the judge has been asked and has not answered.
    pub fn awaits(&self) -> bool {
        self.slots.iter().any(|s| s.asked.as_ref().is_some_and(|a| !s.answers(a)))
    }

    /// Where a slot is; nothing as long as its error or time is not known.
    pub fn dot(&self, slot: usize, told: u64) -> Option<Live> {
        let slot = &self.slots[slot];
        let (ms, error) = slot.place()?;
        let fresh = slot.judged.as_ref().is_some_and(|j| j.request >= told);
        Some(Live { ms, error, fresh, trail: slot.trail.clone() })
    }
}

impl Slot {
    fn answers(&self, asked: &(u64, Question)) -> bool {
        self.judged.as_ref().is_some_and(|j| j.request >= asked.0 && j.question == asked.1)
    }

    fn place(&self) -> Option<(f64, f64)> {
        let error = self.judged.as_ref()?.result.as_ref().ok()?.error?.error;
        let ms = spread(self.times.clone()).median;
        (ms > 0.0 && error.is_finite()).then_some((ms, error))
    }
}

impl super::Chart {
    /// Takes in the time of a frame.
    pub fn note(&mut self, picture: &PictureReport) {
        let Some(slot) = self.live.slots.get_mut(picture.slot).filter(|_| !picture.preview) else { return };
        if slot.request != picture.request {
            // The dot moves: what it leaves is where it was when its error was right.
            if let Some(at) = slot.place().filter(|at| slot.trail.last() != Some(at)) {
                slot.trail.push(at);
            }
            let surplus = slot.trail.len().saturating_sub(TRAIL);
            slot.trail.drain(..surplus);
            slot.request = picture.request;
            slot.times.clear();
        }
        if slot.times.len() == KEPT {
            slot.times.remove(0);
        }
        slot.times.push(picture.gpu_ms);
    }

    /// The device is another one: what it was asked is asked again.
    pub fn restarted(&mut self) {
        self.live.slots.iter_mut().for_each(|s| s.asked = None);
    }

    /// Ends what is in work. Returns the validation messages of its device.
    pub fn close(self, patience: Duration) -> Vec<String> {
        let mut messages = self.live.messages;
        messages.extend(self.live.gather.into_iter().flat_map(|g| g.stop(patience)));
        messages
    }
}

impl Workbench {
    /// What is to be asked about A and B.
    fn question(&self) -> Question {
        let (part, bounces) = self.chart.choice.part_and_bounces(self.chart.data().map(|d| &**d));
        let metric = self.chart.choice.metric.to_string();
        Question { part, metric, bounces, gathered: self.chart.live.gathered }
    }

    /// Whether a slot shows something that the judge was not asked about.
    fn is_due(&self, slot: usize, question: &Question) -> bool {
        let shows = self.slots[slot].picture.as_ref().is_some_and(|p| !p.preview && p.request >= self.sent.number);
        let asked = self.chart.live.slots[slot].asked.as_ref();
        let known = asked.is_some_and(|a| a.0 >= self.sent.number && a.1 == *question);
        self.desired.slots[slot].is_some() && shows && self.slots[slot].errors.is_empty() && !known
    }

    /// Whether the judge is about to be asked.
    pub(super) fn judge_is_due(&self) -> bool {
        let question = self.question();
        !self.desired.clock.playing && (0..2).any(|slot| self.is_due(slot, &question))
    }

    /// Asks the judge about what has come to rest.
    pub(in super::super) fn ask_judge(&mut self, ui: &Ui) {
        if self.chart.live.since.0 != self.sent.number {
            self.chart.live.since = (self.sent.number, Instant::now());
        }
        if self.tab != Tab::Chart || !self.judge_is_due() {
            return;
        }
        let stood = self.chart.live.since.1.elapsed();
        if stood < QUIET {
            ui.ctx().request_repaint_after(QUIET - stood);
            return;
        }
        let question = self.question();
        for slot in 0..2 {
            if self.is_due(slot, &question) {
                self.chart.live.slots[slot].asked = Some((self.sent.number, question.clone()));
                self.engine.order(Order::Judge(slot, question.clone()));
            }
        }
    }

    /// The judge has answered.
    pub(in super::super) fn judged(&mut self, judged: Judged) {
        let slot = &mut self.chart.live.slots[judged.slot];
        let subject = |j: &Judged| j.result.as_ref().ok().map(|v| v.subject.clone());
        let other = |old: &Judged| old.question != judged.question || subject(old) != subject(&judged);
        if slot.judged.as_ref().is_some_and(other) {
            slot.trail.clear();
        }
        let ms = spread(slot.times.clone()).median;
        let verdict = judged.result.as_ref().ok();
        let event = json!({ "slot": judged.slot, "request": judged.request, "part": judged.question.part,
            "metric": judged.question.metric, "bounces": judged.question.bounces, "gpu_ms": ms,
            "error": verdict.and_then(|v| v.error).map(|e| e.error),
            "samples": verdict.and_then(|v| v.error).map(|e| e.samples),
            "why": judged.result.as_ref().err() });
        slot.judged = Some(judged);
        // A single frame after a rest is slower than many: clocks are low. The judge is not disturbed by those that follow.
        if !self.chart.live.awaits() {
            self.engine.order(Order::Frames((MEASURED.as_secs_f64() * 1e3 / ms.max(0.1)).clamp(2.0, 32.0) as u32));
        }
        self.event("judged", event);
    }

    /// Gathers the reference of what A shows.
    pub(super) fn start_gathering(&mut self) {
        let (Some(slot), Some(scene), Some(picture)) = (&self.desired.slots[0], &self.scene, &self.slots[0].picture)
        else {
            return;
        };
        let experiment = keep::still(&self.desired, slot, &self.name, picture.time, scene);
        self.fixed_size = Some(experiment.size);
        let (bounces, samples) = (self.question().bounces, self.chart.live.samples);
        let (home, gpu) = (self.home.clone(), self.gpu.clone());
        let job = Job { home, gpu, experiment, scene: scene.clone(), bounces, samples };
        self.chart.live.said.clear();
        self.chart.live.gather = Some(Gather::start(job, self.wake.clone()));
        self.event("gathering", json!({ "bounces": bounces, "samples": samples }));
    }

    /// Takes in how far the gathering is.
    pub(super) fn gather_news(&mut self) {
        let Some(result) = self.chart.live.gather.as_mut().and_then(Gather::take) else { return };
        let gather = self.chart.live.gather.take();
        self.chart.live.messages.extend(gather.into_iter().flat_map(|g| g.stop(Duration::from_secs(5))));
        self.chart.live.gathered += 1;
        self.chart.live.said = match &result {
            Ok(samples) => format!("gathered {samples} samples a pixel"),
            Err(e) => format!("not gathered: {e}"),
        };
        let (samples, why) = (result.as_ref().ok(), result.as_ref().err().map(ToString::to_string));
        self.event("gathered", json!({ "samples": samples, "why": why }));
    }
}
