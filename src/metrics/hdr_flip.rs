//! HDR-FLIP: FLIP of linear radiance over the range of useful exposures of the reference.
//!
//! Andersson, Nilsson, Shirley, Akenine-Möller: *Visualizing Errors in Rendered High Dynamic Range
//! Images*, Eurographics Short Papers 2021.

use super::colour::luminance;
use super::flip::flip;
use rayon::prelude::*;

/// The evaluator's filmic curve, (a c^2 + b c) / (d c^2 + e c + f): Narkowicz 2015 with an exposure
/// of 0.6.
const ACES: [f64; 5] = [
    0.6 * 0.6 * 2.51,
    0.6 * 0.03,
    0.6 * 0.6 * 2.43,
    0.6 * 0.59,
    0.14,
];

/// Displayed luminance of the brightest and the median pixel.
const TARGET: f64 = 0.85;

/// Evenly spaced exposures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exposures {
    /// Exposure at which the brightest pixel of the reference is shown at 0.85 (stops).
    pub start: f64,
    /// Exposure at which its median pixel is shown at 0.85 (stops).
    pub stop: f64,
    /// Number of exposures: one per stop and at least 2, or 1 without a range.
    pub count: u32,
}

/// The exposures for a reference. Medians are at least 1.2e-7; a black reference has exposure 0.
pub fn exposures(reference: &[[f32; 3]]) -> Exposures {
    let values: Vec<f64> = reference.iter().map(|c| luminance(*c)).collect();
    let brightest = values.iter().copied().fold(0.0, f64::max);
    if brightest <= 0.0 {
        return Exposures {
            start: 0.0,
            stop: 0.0,
            count: 1,
        };
    }
    let median = super::median(values);
    let (a, b, c) = (
        ACES[0] - TARGET * ACES[2],
        ACES[1] - TARGET * ACES[3],
        -TARGET * ACES[4],
    );
    let half = -0.5 * b / a;
    let shown = half + (half * half - c / a).sqrt();
    let start = (shown / brightest).log2();
    let stop = (shown / median.max(f64::from(f32::EPSILON)))
        .log2()
        .max(start);
    let count = if stop > start {
        (stop - start).ceil().max(2.0) as u32
    } else {
        1
    };
    Exposures { start, stop, count }
}

/// HDR-FLIP of every pixel, 0 to 1: the largest FLIP over the exposures. Costs one FLIP per
/// exposure.
pub fn hdr_flip(
    test: &[[f32; 3]],
    reference: &[[f32; 3]],
    width: usize,
    at: Exposures,
) -> Vec<f32> {
    let mut worst = vec![0.0f32; reference.len()];
    for i in 0..at.count {
        let stops =
            at.start + f64::from(i) * (at.stop - at.start) / f64::from((at.count - 1).max(1));
        let exposure = stops.exp2();
        let shown = |rgb: &[[f32; 3]]| -> Vec<[f32; 3]> {
            rgb.par_iter()
                .map(|c| c.map(|v| filmic(v, exposure)))
                .collect()
        };
        for (worst, error) in worst
            .iter_mut()
            .zip(flip(&shown(test), &shown(reference), width))
        {
            *worst = worst.max(error);
        }
    }
    worst
}

fn filmic(value: f32, exposure: f64) -> f32 {
    let c = f64::from(value) * exposure;
    let [a, b, d, e, f] = ACES;
    ((c * (a * c + b)) / (c * (d * c + e) + f)).clamp(0.0, 1.0) as f32
}
