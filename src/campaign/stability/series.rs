//! Scores of a part of the light by frame.

use super::record::{FrameScore, PartResult};
use super::score::{FlickerSeries, change, settling, step};
use crate::measure::reference::ReferencePart;
use crate::metrics::colour::luminance;
use crate::metrics::{Compared, Linear, relmse, within_noise};

/// Available references at a frame.
#[derive(Clone, Copy)]
pub(super) enum Known<'a> {
    /// No reference; whether it may have changed since the frame before.
    Nothing { changed: bool },
    /// The reference now, and that of the frame before if it differs.
    Reference {
        now: &'a ReferencePart,
        before: Option<&'a ReferencePart>,
    },
}

/// Gathers the scores of a part.
pub(super) struct PartSeries {
    before: Option<Linear>,
    frames: Vec<FrameScore>,
    flicker: FlickerSeries,
    noise: FlickerSeries,
    /// Whether the reference's changes are known at all frames.
    known: bool,
    result: PartResult,
}

impl PartSeries {
    pub fn new() -> PartSeries {
        PartSeries {
            before: None,
            frames: Vec::new(),
            flicker: FlickerSeries::default(),
            noise: FlickerSeries::default(),
            known: true,
            result: PartResult::default(),
        }
    }

    /// Adds the next frame. `last` requests all scores against the reference. Returns E_t, or
    /// relMSE at the first frame.
    pub fn add(&mut self, x: Linear, known: Known, last: bool) -> Option<f64> {
        let reference = match known {
            Known::Reference { now, .. } => Some(now),
            Known::Nothing { .. } => None,
        };
        let mut frame = FrameScore {
            frame: self.frames.len(),
            mean: number(mean_luminance(&x)),
            reference_mean: reference.and_then(|t| number(mean_luminance(&t.mean))),
            relmse: reference
                .and_then(|t| relmse(&x, &t.mean).ok())
                .and_then(number),
            ..FrameScore::default()
        };
        if let Some(previous) = &self.before {
            let now = [previous, &x];
            match known {
                Known::Nothing { changed: true } => self.known = false,
                Known::Nothing { changed: false } | Known::Reference { before: None, .. } => {
                    frame.change = Some(change(now, None));
                    frame.noise = reference.map(|_| 0.0);
                }
                Known::Reference {
                    now: reference,
                    before: Some(before),
                } => {
                    frame.change = Some(change(now, Some([&before.mean, &reference.mean])));
                    frame.noise = before.halves.as_ref().zip(reference.halves.as_ref()).map(
                        |(before, now)| {
                            change([&before[0], &now[0]], Some([&before[1], &now[1]])).rms
                        },
                    );
                }
            }
        }
        if self.known {
            self.flicker.add(&x, reference.map(|t| &t.mean));
        }
        if let Some(t) = reference {
            if let Some([even, odd]) = &t.halves {
                self.noise.add(even, Some(odd));
            }
            if last {
                let compared = Compared::new(&x, &t.mean).ok();
                self.result.scores = compared.and_then(|c| c.scores(None));
                self.result.noise = number(t.noise.relmse);
                self.result.flip_noise = number(t.noise.flip);
                self.result.structure_noise = number(t.noise.structure);
            }
        }
        let bad = frame
            .change
            .map(|c| c.rms)
            .or(frame.relmse.filter(|_| self.before.is_none()));
        self.frames.push(frame);
        self.before = Some(x);
        bad
    }

    /// The frame before the next one.
    pub fn before(&self) -> Option<&Linear> {
        self.before.as_ref()
    }

    /// Scores of all frames. `event` is the first frame after a switch or a cut, `switched` tells
    /// them apart.
    pub fn finish(mut self, event: Option<usize>, switched: bool) -> PartResult {
        let changes: Vec<_> = self.frames.iter().filter_map(|f| f.change).collect();
        let root =
            |list: &[f64]| (list.iter().map(|v| v * v).sum::<f64>() / list.len() as f64).sqrt();
        if self.known && !changes.is_empty() {
            let rms: Vec<f64> = changes.iter().map(|c| c.rms).collect();
            self.result.e = Some(root(&rms));
            let noise: Vec<f64> = self.frames.iter().skip(1).filter_map(|f| f.noise).collect();
            self.result.e_noise = (noise.len() == rms.len()).then(|| root(&noise));
            self.result.pops = changes.iter().map(|c| c.p999).reduce(f64::max);
            self.result.jump = changes.iter().map(|c| c.jump).reduce(f64::max);
            self.result.flicker = Some(self.flicker.index());
            let noisy = self.result.e_noise.is_some() && self.frames.len() > 1;
            self.result.flicker_noise = noisy.then(|| self.noise.index().mean);
            self.result.told_apart = self
                .result
                .e
                .zip(self.result.e_noise)
                .map(|(e, n)| !within_noise(e, Some(n)));
        }
        if let Some(at) = event {
            let signal = |value: fn(&FrameScore) -> Option<f64>| -> Vec<f64> {
                self.frames
                    .iter()
                    .map(|f| value(f).unwrap_or(f64::NAN))
                    .collect()
            };
            // A cut changes the mean by itself, so it is no step response.
            self.result.step = if switched {
                step(&signal(|f| f.mean), at)
            } else {
                None
            };
            self.result.settling = settling(&signal(|f| f.relmse), at);
        }
        self.result.frames = self.frames;
        self.result
    }
}

fn number(v: f64) -> Option<f64> {
    v.is_finite().then_some(v)
}

fn mean_luminance(picture: &Linear) -> f64 {
    picture.rgb.iter().map(|c| luminance(*c)).sum::<f64>() / picture.rgb.len().max(1) as f64
}
