//! The workbench's own dots: their times from the frames that are shown, their errors from the judge; and the reference
//! that the errors need.

use super::super::engine::Order;
use super::super::judge::{Judged, Question};
use super::super::report::PictureReport;
use super::super::{Tab, Workbench, keep};
use super::gather::{Gather, Job};
use super::plot::Live;
use crate::comparison::within_noise;
use crate::stats::spread;
use crate::sweep::Subject;
use egui::{Button, DragValue, ProgressBar, Ui};
use serde_json::json;
use std::time::{Duration, Instant};

/// Frames whose times count.
const KEPT: usize = 240;
/// Places that a dot has been at.
const TRAIL: usize = 16;
/// How long everything must stand still before it is judged.
const QUIET: Duration = Duration::from_millis(150);
/// Samples of a reference when nothing else is said, as `conelab reference`.
const SAMPLES: u64 = 256;

/// What is known of A or B.
#[derive(Default)]
struct Slot {
    /// GPU times of the frames of the last wish, ms.
    times: Vec<f64>,
    wish: u64,
    /// What the judge was asked last, about which wish.
    asked: Option<(u64, Question)>,
    judged: Option<Judged>,
    trail: Vec<(f64, f64)>,
}

/// The live part of the chart.
pub struct State {
    slots: [Slot; 2],
    /// The wish that was told last, and when it was first seen.
    since: (u64, Instant),
    gather: Option<Gather>,
    /// References gathered so far.
    gathered: u64,
    samples: u64,
    /// What came of the last one.
    said: String,
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
        let fresh = slot.judged.as_ref().is_some_and(|j| j.wish >= told);
        Some(Live { ms, error, fresh, trail: slot.trail.clone() })
    }
}

impl Slot {
    fn answers(&self, asked: &(u64, Question)) -> bool {
        self.judged.as_ref().is_some_and(|j| j.wish >= asked.0 && j.question == asked.1)
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
        if slot.wish != picture.wish {
            // The dot moves: what it leaves is where it was when its error was right.
            if let Some(at) = slot.place().filter(|at| slot.trail.last() != Some(at)) {
                slot.trail.push(at);
            }
            let surplus = slot.trail.len().saturating_sub(TRAIL);
            slot.trail.drain(..surplus);
            slot.wish = picture.wish;
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
        let shows = self.slots[slot].picture.as_ref().is_some_and(|p| !p.preview && p.wish >= self.told.number);
        let asked = self.chart.live.slots[slot].asked.as_ref();
        let known = asked.is_some_and(|a| a.0 >= self.told.number && a.1 == *question);
        self.wish.slots[slot].is_some() && shows && self.slots[slot].errors.is_empty() && !known
    }

    /// Whether the judge is about to be asked.
    pub(super) fn judge_is_due(&self) -> bool {
        let question = self.question();
        !self.wish.clock.playing && (0..2).any(|slot| self.is_due(slot, &question))
    }

    /// Asks the judge about what has come to rest.
    pub(in super::super) fn ask_judge(&mut self, ui: &Ui) {
        if self.chart.live.since.0 != self.told.number {
            self.chart.live.since = (self.told.number, Instant::now());
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
                self.chart.live.slots[slot].asked = Some((self.told.number, question.clone()));
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
        let event = json!({ "slot": judged.slot, "wish": judged.wish, "part": judged.question.part,
            "metric": judged.question.metric, "bounces": judged.question.bounces, "gpu_ms": ms,
            "error": verdict.and_then(|v| v.error).map(|e| e.error),
            "samples": verdict.and_then(|v| v.error).map(|e| e.samples),
            "why": judged.result.as_ref().err() });
        slot.judged = Some(judged);
        self.event("judged", event);
    }

    /// What is known of A and B, and what can be done about what is not.
    pub(super) fn live_rows(&mut self, ui: &mut Ui, title: &str, lives: &[Option<Live>; 2]) {
        let mut missing = false;
        for (slot, live) in lives.iter().enumerate().filter(|s| self.wish.slots[s.0].is_some()) {
            let state = &self.chart.live.slots[slot];
            let name = ["A", "B"][slot];
            match state.judged.as_ref().map(|j| (&j.question, &j.result)) {
                None if self.wish.clock.playing => drop(ui.weak(format!("{name}: judged when time stands still"))),
                None => drop(ui.weak(format!("{name}: not judged yet"))),
                Some((_, Err(why))) => drop(ui.weak(format!("{name}: {why}"))),
                Some((question, Ok(verdict))) => match (&verdict.error, live) {
                    (Some(error), Some(live)) => {
                        let old = if live.fresh { "" } else { " (of the picture before)" };
                        let noisy = question.metric == "relmse" && within_noise(error.error, Some(error.noise));
                        let noisy = if noisy { ", within the reference's noise" } else { "" };
                        ui.label(format!("{name}: {:.3} ms, {title} {:.4e}{noisy}{old}", live.ms, error.error))
                            .on_hover_text(format!(
                                "Median of {} frames since the last change; `keep rendering` measures on. Reference: \
                                 {}, {} samples a pixel; relMSE of its halves {:.2e}.",
                                state.times.len(),
                                bounces(question.bounces),
                                error.samples,
                                error.noise
                            ));
                    }
                    (Some(_), None) => drop(ui.weak(format!("{name}: the metric is not defined here"))),
                    (None, _) => {
                        missing = true;
                        let (w, h) = verdict.subject.size;
                        ui.label(format!(
                            "{name}: no reference of this picture ({}, {w}x{h}, {})",
                            verdict.subject.scene,
                            bounces(question.bounces)
                        ));
                    }
                },
            }
        }
        self.gather_row(ui, missing);
        self.size_row(ui);
    }

    fn gather_row(&mut self, ui: &mut Ui, missing: bool) {
        if let Some(gather) = &mut self.chart.live.gather {
            ui.horizontal(|ui| {
                let (done, of) = gather.state.map_or((0, 0), |g| (g.samples, g.goal));
                let part = if of == 0 { 0.0 } else { done as f32 / of as f32 };
                let text = if of == 0 { "opening a device".into() } else { format!("{done} of {of} samples") };
                ui.add(ProgressBar::new(part).desired_width(180.0).text(text));
                let cancel = Button::new(if gather.cancelled { "stopping" } else { "cancel" }).small();
                let about = "Stops after the block of samples in work; what was gathered is kept";
                if ui.add_enabled(!gather.cancelled, cancel).on_hover_text(about).clicked() {
                    gather.cancel();
                }
            });
            return;
        }
        if !self.chart.live.said.is_empty() {
            ui.weak(&self.chart.live.said);
        }
        let mut start = false;
        ui.horizontal(|ui| {
            let about = "Traces the reference of A's picture on a device of its own and keeps it. The picture keeps its \
                         present size from then on: a reference fits no other";
            let text = if missing { "gather" } else { "gather more" };
            start = ui.button(text).on_hover_text(about).clicked();
            let samples = DragValue::new(&mut self.chart.live.samples).range(32..=1 << 24).speed(32).suffix(" samples");
            ui.add(samples).on_hover_text("Of every pixel, in all; the error of the reference falls with their root");
        });
        if start {
            self.start_gathering();
        }
    }

    fn start_gathering(&mut self) {
        let (Some(slot), Some(scene), Some(picture)) = (&self.wish.slots[0], &self.scene, &self.slots[0].picture)
        else {
            return;
        };
        let experiment = keep::still(&self.wish, slot, &self.name, picture.time, scene);
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

    /// The size of the picture: that of the sweep, that of the panel, or as it is.
    fn size_row(&mut self, ui: &mut Ui) {
        let (w, h) = self.wish.size;
        let sweeps = self.chart.data().and_then(|d| d.keys.get(self.chart.choice.subject)).map(|k| k.0.size);
        ui.horizontal_wrapped(|ui| {
            ui.weak(match self.fixed_size {
                Some(_) => format!("picture: {w}x{h}"),
                None => format!("picture: {w}x{h}, as large as the panel; errors are of one size"),
            });
            if let Some(size) = sweeps.filter(|s| *s != (w, h))
                && ui.small_button(format!("{}x{} as the sweep", size.0, size.1)).clicked()
            {
                self.fixed_size = Some(size);
            }
            if self.fixed_size.is_some() && ui.small_button("as the panel").clicked() {
                self.fixed_size = None;
            }
        });
    }
}

fn bounces(number: u32) -> String {
    if number == 1 { "1 bounce".into() } else { format!("{number} bounces") }
}
