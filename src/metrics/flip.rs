//! FLIP: the difference that an observer sees when two pictures alternate on a display.
//!
//! Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild: *FLIP: A Difference Evaluator
//! for Alternating Images*, HPG 2020. Filters are separated as in NVIDIA's evaluator; means agree
//! with it within 0.001 (`tests/metrics.rs`). Reimplemented, because the evaluator's binding only
//! takes 8-bit pictures, and HDR-FLIP needs higher precision.

use super::colour::{from_ycxcz, hunt_lab, ycxcz};
use rayon::prelude::*;
use std::f64::consts::PI;

/// Pixels per degree of visual angle: a display of 3840 pixels on 0.7 m, seen from 0.7 m.
pub const PIXELS_PER_DEGREE: f64 = 3840.0 * PI / 180.0;

/// Exponent that compresses colour differences.
const COLOUR_EXPONENT: f32 = 0.7;
/// Fraction of the largest colour difference that is mapped to errors below [`COLOUR_KNEE_ERROR`].
const COLOUR_KNEE: f32 = 0.4;
/// Error at the knee.
const COLOUR_KNEE_ERROR: f32 = 0.95;
/// Exponent of the feature difference.
const FEATURE_EXPONENT: f32 = 0.5;
/// Width of the edge and point detectors, degrees.
const FEATURE_WIDTH: f64 = 0.082;

/// A picture as perceived by an observer.
struct Perceived {
    /// Filtered by the eye's contrast sensitivity, as L\*a\*b\* with the Hunt effect.
    colour: Vec<[f32; 3]>,
    /// Strength of edges and of points.
    features: Vec<[f32; 2]>,
}

/// A picture with one channel.
struct Plane {
    width: usize,
    values: Vec<f32>,
}

/// FLIP of every pixel, 0 to 1, for two pictures in linear RGB (0 to 1) with `width` pixels per
/// row.
pub fn flip(test: &[[f32; 3]], reference: &[[f32; 3]], width: usize) -> Vec<f32> {
    let (test, reference) = (perceive(test, width), perceive(reference, width));
    let extreme = colour_distance(hunt_lab([0.0, 1.0, 0.0]), hunt_lab([0.0, 0.0, 1.0]));
    let features = test.features.par_iter().zip(&reference.features);
    let pairs = test.colour.par_iter().zip(&reference.colour).zip(features);
    pairs
        .map(|((a, b), (fa, fb))| {
            let feature = (fa[0] - fb[0]).abs().max((fa[1] - fb[1]).abs());
            let feature = (std::f32::consts::FRAC_1_SQRT_2 * feature).powf(FEATURE_EXPONENT);
            colour_error(colour_distance(*a, *b), extreme).powf(1.0 - feature)
        })
        .collect()
}

/// HyAB distance (city block in lightness, Euclidean in chroma), compressed.
fn colour_distance(a: [f32; 3], b: [f32; 3]) -> f32 {
    let chroma = ((a[1] - b[1]).powi(2) + (a[2] - b[2]).powi(2)).sqrt();
    ((a[0] - b[0]).abs() + chroma).powf(COLOUR_EXPONENT)
}

/// Maps the compressed distance to an error by two line segments, so that large distances do not
/// use up the range.
fn colour_error(distance: f32, extreme: f32) -> f32 {
    let knee = COLOUR_KNEE * extreme;
    if distance < knee {
        return distance * COLOUR_KNEE_ERROR / knee;
    }
    COLOUR_KNEE_ERROR + (distance - knee) / (extreme - knee) * (1.0 - COLOUR_KNEE_ERROR)
}

fn perceive(rgb: &[[f32; 3]], width: usize) -> Perceived {
    let opponent: Vec<[f32; 3]> = rgb.par_iter().map(|c| ycxcz(*c)).collect();
    let channel = |i: usize| Plane {
        width,
        values: opponent.par_iter().map(|c| c[i]).collect(),
    };
    let luminance = channel(0);
    // Linear luminance in 0..1 for the detectors.
    let grey = Plane {
        width,
        values: luminance
            .values
            .par_iter()
            .map(|y| (y + 16.0) / 116.0)
            .collect(),
    };
    Perceived {
        colour: filtered_colour(&luminance, &channel(1), &channel(2)),
        features: features(&grey),
    }
}

/// Contrast sensitivity of the eye: one Gaussian for luminance and red-green, a sum of two for
/// blue-yellow.
fn filtered_colour(luminance: &Plane, red_green: &Plane, blue_yellow: &Plane) -> Vec<[f32; 3]> {
    const WIDEST: f64 = 0.04;
    let radius = (3.0 * (WIDEST / (2.0 * PI * PI)).sqrt() * PIXELS_PER_DEGREE).ceil() as i32;
    let gaussian = |scale: f64, b: f64| -> Vec<f64> {
        let at = |x: i32| f64::from(x) / PIXELS_PER_DEGREE;
        (-radius..=radius)
            .map(|x| scale * (-PI * PI * at(x) * at(x) / b).exp())
            .collect()
    };
    let normalised = |weights: &[f64], sum: f64| -> Vec<f32> {
        weights.iter().map(|w| (w / sum) as f32).collect()
    };
    let single = |plane: &Plane, b: f64| {
        let weights = gaussian(1.0, b);
        let weights = normalised(&weights, weights.iter().sum());
        plane.rows(&weights).columns(&weights)
    };
    let (y, cx) = (single(luminance, 0.0047), single(red_green, 0.0053));
    // a sqrt(pi / b) is split evenly between both directions; the two sums have a total weight of
    // 1.
    let part = |a: f64, b: f64| gaussian((a * (PI / b).sqrt()).sqrt(), b);
    let (wide, narrow) = (part(34.1, 0.04), part(13.5, 0.025));
    let sum = (wide.iter().sum::<f64>().powi(2) + narrow.iter().sum::<f64>().powi(2)).sqrt();
    let twice = |weights: &[f64]| {
        let weights = normalised(weights, sum);
        blue_yellow.rows(&weights).columns(&weights)
    };
    let (wide, narrow) = (twice(&wide), twice(&narrow));
    (0..y.values.len())
        .into_par_iter()
        .map(|i| {
            let rgb = from_ycxcz([y.values[i], cx.values[i], wide.values[i] + narrow.values[i]]);
            hunt_lab(rgb.map(|v| v.clamp(0.0, 1.0)))
        })
        .collect()
}

/// Strength of edges (first derivatives of a Gaussian) and points (second derivatives) at every
/// pixel.
fn features(grey: &Plane) -> Vec<[f32; 2]> {
    let deviation = 0.5 * FEATURE_WIDTH * PIXELS_PER_DEGREE;
    let radius = (3.0 * deviation).ceil() as i32;
    let weights = |f: &dyn Fn(f64) -> f64| -> Vec<f32> {
        let all: Vec<f64> = (-radius..=radius)
            .map(|x| f(f64::from(x)) * (-0.5 * (f64::from(x) / deviation).powi(2)).exp())
            .collect();
        // Positive weights sum to 1, and negative ones to -1.
        let positive: f64 = all.iter().filter(|w| **w > 0.0).sum();
        let negative: f64 = -all.iter().filter(|w| **w < 0.0).sum::<f64>();
        all.iter()
            .map(|w| {
                (w / if *w > 0.0 {
                    positive
                } else {
                    negative.max(f64::MIN_POSITIVE)
                }) as f32
            })
            .collect()
    };
    let smooth = weights(&|_| 1.0);
    let first = weights(&|x| -x);
    let second = weights(&|x| x * x / (deviation * deviation) - 1.0);
    let smoothed = grey.rows(&smooth);
    let edge = (grey.rows(&first).columns(&smooth), smoothed.columns(&first));
    let point = (
        grey.rows(&second).columns(&smooth),
        smoothed.columns(&second),
    );
    let length = |p: &(Plane, Plane), i: usize| p.0.values[i].hypot(p.1.values[i]);
    (0..grey.values.len())
        .into_par_iter()
        .map(|i| [length(&edge, i), length(&point, i)])
        .collect()
}

impl Plane {
    /// Convolves along rows; border pixels are replicated.
    fn rows(&self, weights: &[f32]) -> Plane {
        let radius = weights.len() / 2;
        let mut values = vec![0.0; self.values.len()];
        values
            .par_chunks_mut(self.width)
            .zip(self.values.par_chunks(self.width))
            .for_each(|(out, row)| {
                let (first, last) = (row[0], row[row.len() - 1]);
                let mut wide = vec![first; radius];
                wide.extend_from_slice(row);
                wide.resize(row.len() + 2 * radius, last);
                for (i, weight) in weights.iter().enumerate() {
                    for (o, v) in out.iter_mut().zip(&wide[i..]) {
                        *o += weight * v;
                    }
                }
            });
        Plane {
            width: self.width,
            values,
        }
    }

    /// Convolves along columns; border pixels are replicated.
    fn columns(&self, weights: &[f32]) -> Plane {
        let radius = weights.len() / 2;
        let height = self.values.len() / self.width;
        let mut values = vec![0.0; self.values.len()];
        values
            .par_chunks_mut(self.width)
            .enumerate()
            .for_each(|(y, out)| {
                for (i, weight) in weights.iter().enumerate() {
                    let from = (y + i).saturating_sub(radius).min(height - 1) * self.width;
                    for (o, v) in out.iter_mut().zip(&self.values[from..from + self.width]) {
                        *o += weight * v;
                    }
                }
            });
        Plane {
            width: self.width,
            values,
        }
    }
}
