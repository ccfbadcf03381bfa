//! Definitions of the scores; docs/stability.md has their sources.

use crate::metrics::colour::{display, luminance};
use crate::metrics::{Linear, percentile};
use serde::{Deserialize, Serialize};

/// Largest deviation that counts as the final value after a step, relative to the step.
const SETTLED: f64 = 0.05;
/// Largest change between the last two frames that counts as converged, relative to the step.
const AT_REST: f64 = 0.01;

/// Change from one frame to the next, against the change of the reference.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Change {
    /// E_t: root of mean ((x_t - x_{t-1}) - (r_t - r_{t-1}))^2 over pixels and channels, of linear
    /// radiance.
    pub rms: f64,
    /// 99.9th percentile over pixels of the same difference: the largest channel of each pixel,
    /// absolute.
    pub p999: f64,
    /// Largest value over pixels and channels of the same difference after [`display`], in 1/255.
    pub jump: f64,
}

/// The change between two frames `x`, minus that of their references `r`. `None` means equal
/// references. Pixels that are not finite in any of them are skipped.
pub fn change(x: [&Linear; 2], r: Option<[&Linear; 2]>) -> Change {
    let [before, now] = x;
    let (mut sum, mut count, mut jump) = (0.0, 0usize, 0.0f64);
    let mut errors = Vec::with_capacity(now.rgb.len());
    for i in 0..now.rgb.len().min(before.rgb.len()) {
        let (b, n) = (before.rgb[i], now.rgb[i]);
        let (rb, rn) = r.map_or(([0.0; 3], [0.0; 3]), |r| (r[0].rgb[i], r[1].rgb[i]));
        if ![b, n, rb, rn].iter().flatten().all(|v| v.is_finite()) {
            continue;
        }
        let mut most = 0.0f64;
        for c in 0..3 {
            let wide = |v: f32| f64::from(v);
            let e = (wide(n[c]) - wide(b[c])) - (wide(rn[c]) - wide(rb[c]));
            sum += e * e;
            most = most.max(e.abs());
            let show = |v: f32| display(x[0].kind, v);
            jump = jump.max(((show(n[c]) - show(b[c])) - (show(rn[c]) - show(rb[c]))).abs());
        }
        errors.push(most);
        count += 3;
    }
    Change {
        rms: (sum / count.max(1) as f64).sqrt(),
        p999: percentile(&mut errors, 0.999),
        jump: jump * 255.0,
    }
}

/// Flicker index over the frames of a sequence (IES Lighting Handbook): area above the mean over
/// the whole area.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Flicker {
    /// Mean over pixels, 0 to 1.
    pub mean: f64,
    /// 99th percentile over pixels.
    pub p99: f64,
}

/// The flicker index of every pixel's luminance without the reference's own change: of y_t = x_t -
/// (r_t - r_0), with the area of x. `differences` has (x_t - x_0) - (r_t - r_0) of every pixel by
/// frame, `areas` the sums of x over the frames. For a constant reference, y is x and the index is
/// the usual one.
pub fn flicker(differences: &[Vec<f32>], areas: &[f64]) -> Flicker {
    let frames = differences.len() as f64;
    let index = |(i, area): (usize, &f64)| {
        let values = || {
            differences
                .iter()
                .map(|f| f.get(i).map_or(0.0, |v| f64::from(*v)))
        };
        let mean = values().sum::<f64>() / frames;
        let above: f64 = values().map(|v| (v - mean).max(0.0)).sum();
        match above > 0.0 {
            true if *area > 0.0 => (above / area).min(1.0),
            true => 1.0,
            false => 0.0,
        }
    };
    let mut list: Vec<f64> = areas.iter().enumerate().map(index).collect();
    let mean = list.iter().sum::<f64>() / list.len().max(1) as f64;
    Flicker {
        mean,
        p99: percentile(&mut list, 0.99),
    }
}

/// Input of [`flicker`], frame by frame.
#[derive(Clone, Debug, Default)]
pub(super) struct FlickerSeries {
    first: Vec<(f64, f64)>,
    differences: Vec<Vec<f32>>,
    areas: Vec<f64>,
}

impl FlickerSeries {
    /// Adds a frame. Without a reference, the reference is constant.
    pub fn add(&mut self, x: &Linear, r: Option<&Linear>) {
        let finite = |v: f64| if v.is_finite() { v } else { 0.0 };
        let pair = |i: usize| {
            let reference = r.map_or(0.0, |r| finite(luminance(r.rgb[i])));
            (finite(luminance(x.rgb[i])), reference)
        };
        let now: Vec<(f64, f64)> = (0..x.rgb.len()).map(pair).collect();
        if self.first.is_empty() {
            self.first.clone_from(&now);
            self.areas = vec![0.0; now.len()];
        }
        self.areas
            .iter_mut()
            .zip(&now)
            .for_each(|(area, n)| *area += n.0.max(0.0));
        let difference = |(n, f): (&(f64, f64), &(f64, f64))| ((n.0 - f.0) - (n.1 - f.1)) as f32;
        self.differences
            .push(now.iter().zip(&self.first).map(difference).collect());
    }

    pub fn index(&self) -> Flicker {
        flicker(&self.differences, &self.areas)
    }
}

/// Response to a step change.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Step {
    /// Frames until the signal stays within 5 % of the step around its final value. The first
    /// changed frame counts, so 1 is immediate. `None` if it still moved at the end.
    pub frames: Option<usize>,
    /// Overshoot beyond the final value, relative to the step.
    pub overshoot: f64,
}

/// The step response of a signal; its first changed frame is `at`. The final value is that of the
/// last frame. `None` without a frame before and two after it, or if there is no step.
pub fn step(signal: &[f64], at: usize) -> Option<Step> {
    let before = *signal.get(at.checked_sub(1)?)?;
    let after = signal.get(at..).filter(|a| a.len() >= 2)?;
    let last = *after.last()?;
    let size = last - before;
    if size == 0.0 || !size.is_finite() {
        return None;
    }
    let off = |v: f64| (v - last) / size;
    let late = after.iter().rposition(|v| off(*v).abs() > SETTLED);
    let at_rest = off(after[after.len() - 2]).abs() <= AT_REST;
    let overshoot = after.iter().map(|v| off(*v)).fold(0.0, f64::max);
    Some(Step {
        frames: at_rest.then(|| late.map_or(1, |l| l + 2)),
        overshoot,
    })
}

/// Frames until an error stays within 5 % of its last value. The frame of the event counts, so 1 is
/// immediate. `None` without two frames after it, if an error is unknown, or if it still moved by
/// more than 1 % at the end.
pub fn settling(errors: &[f64], at: usize) -> Option<usize> {
    let after = errors
        .get(at..)
        .filter(|a| a.len() >= 2 && a.iter().all(|e| e.is_finite()))?;
    let last = *after.last()?;
    let within = |e: f64, part: f64| (e - last).abs() <= part * last;
    let late = after.iter().rposition(|e| !within(*e, SETTLED));
    within(after[after.len() - 2], AT_REST).then(|| late.map_or(1, |l| l + 2))
}
