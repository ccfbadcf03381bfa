//! Rows under the chart: results of A and B, a missing reference, the size of the reference.

use super::plot::{LIVE, Live};
use crate::workbench::Workbench;
use crate::workbench::engine::error_worker::ErrorResult;
use crate::workbench::panel::control::spin;
use egui::{Button, DragValue, ProgressBar, Ui};
use std::time::Duration;

impl Workbench {
    /// Results of A and B, and actions for missing ones.
    pub(super) fn live_rows(&mut self, ui: &mut Ui, title: &str, lives: &[Option<Live>; 2]) {
        let mut missing = false;
        for (side, live) in lives.iter().enumerate() {
            if self.desired.sides[side].is_some() {
                missing |= self.live_row(ui, title, side, live.as_ref());
            }
        }
        self.gather_row(ui, missing);
        self.size_row(ui);
    }

    /// The result of a side. Returns whether its reference is missing.
    fn live_row(&self, ui: &mut Ui, title: &str, side: usize, live: Option<&Live>) -> bool {
        let state = &self.tabs.chart.live.sides[side];
        let name = ["A", "B"][side];
        let Some(ErrorResult { query, result, .. }) = &state.error else {
            let when = match () {
                () if self.desired.clock.playing => "error updates when the time is paused",
                () if state.is_asked() => "computing the error",
                () => "error updates when the picture stops changing",
            };
            ui.weak(format!("{name}: {when}"));
            return false;
        };
        let measured = match result {
            Ok(measured) => measured,
            Err(why) => {
                ui.weak(format!("{name}: {why}"));
                return false;
            }
        };
        let bounces = bounces(query.bounces);
        let Some(error) = &measured.error else {
            let (w, h) = measured.subject.size;
            ui.label(format!(
                "{name}: no reference for this picture ({}, {w}x{h}, {bounces})",
                measured.subject.scene,
            ));
            return true;
        };
        let Some(live) = live else {
            ui.weak(format!("{name}: this metric is undefined for the picture"));
            return false;
        };
        let noisy = match query.metric.within(error.error, error.noise) {
            true => " (below the reference's noise floor)",
            false => "",
        };
        let old = if live.fresh {
            ""
        } else {
            " (previous picture)"
        };
        let (ms, value) = (live.ms, error.error);
        let text = format!("{name}: {ms:.3} ms, {title} {}{noisy}{old}", short(value));
        ui.colored_label(LIVE[side], text).on_hover_text(format!(
            "Median of {} frames since the last change. Continuous rendering adds more. Reference: \
             {bounces}, {} samples per pixel; relMSE between its halves {:.2e}.",
            state.times.len(),
            error.samples,
            error.noise.relmse
        ));
        false
    }

    fn gather_row(&mut self, ui: &mut Ui, missing: bool) {
        if let Some(gather) = &mut self.tabs.chart.live.gather {
            ui.horizontal(|ui| {
                let (done, of) = gather.state.map_or((0, 0), |g| (g.samples, g.goal));
                let part = if of == 0 {
                    0.0
                } else {
                    done as f32 / of as f32
                };
                let text = if of == 0 {
                    "opening a device".into()
                } else {
                    format!("{done} of {of} samples")
                };
                let left = gather
                    .left()
                    .map_or(String::new(), |left| format!(", {}", minutes(left)));
                ui.add(
                    ProgressBar::new(part)
                        .desired_width(230.0)
                        .text(format!("{text}{left}")),
                );
                let cancel = Button::new(if gather.cancelled {
                    "stopping"
                } else {
                    "cancel"
                })
                .small();
                let about = "Stops. Finished blocks of 32 samples are saved";
                if ui
                    .add_enabled(!gather.cancelled, cancel)
                    .on_hover_text(about)
                    .clicked()
                {
                    gather.cancel();
                }
            });
            return;
        }
        if !self.tabs.chart.live.said.is_empty() {
            ui.weak(&self.tabs.chart.live.said);
        }
        let mut start = false;
        ui.horizontal(|ui| {
            let about = "Path-traces A's picture to this number of samples per pixel, as the reference for errors. \
                         It takes minutes on a GPU, much longer on a CPU, runs in the background and is saved. The \
                         picture keeps its size afterwards, because a reference has one size";
            let text = if missing { "Render reference" } else { "Refine reference" };
            start = ui.button(text).on_hover_text(about).clicked();
            let samples = DragValue::new(&mut self.tabs.chart.live.samples).range(32..=1 << 24).speed(32).suffix(" samples");
            spin(ui, samples, "samples of the reference")
                .on_hover_text("Samples per pixel. The reference's error falls with their square root");
        });
        if start {
            self.start_gathering();
        }
    }

    /// The size of the picture, and buttons for the sweep's size and the viewport's.
    fn size_row(&mut self, ui: &mut Ui) {
        let (w, h) = self.desired.size;
        let sweeps = self
            .tabs
            .chart
            .data()
            .and_then(|d| d.keys.get(self.tabs.chart.choice.subject))
            .map(|k| k.0.size);
        ui.horizontal_wrapped(|ui| {
            ui.weak(match self.layout.fixed_size {
                Some(_) => format!("picture: {w}x{h}"),
                None => {
                    format!("picture: {w}x{h}, fits the viewport; errors compare only at one size")
                }
            });
            if let Some(size) = sweeps.filter(|s| *s != (w, h))
                && ui
                    .small_button(format!("Use the sweep's {}x{}", size.0, size.1))
                    .clicked()
            {
                self.layout.fixed_size = Some(size);
            }
            if self.layout.fixed_size.is_some() && ui.small_button("Fit to viewport").clicked() {
                self.layout.fixed_size = None;
            }
        });
    }
}

/// The remaining time.
fn minutes(time: Duration) -> String {
    match time.as_secs() {
        s @ 0..90 => format!("{s} s left"),
        s => format!("{} min left", s.div_ceil(60)),
    }
}

/// An error in at most four digits after the point.
pub(super) fn short(value: f64) -> String {
    match value {
        v if v >= 5e-4 => format!("{v:.4}"),
        v => format!("{v:.2e}"),
    }
}

fn bounces(number: u32) -> String {
    if number == 1 {
        "1 bounce".into()
    } else {
        format!("{number} bounces")
    }
}
