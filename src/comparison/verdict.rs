//! Which of two pictures is better, by metric.

use crate::metrics::Scores;
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt;

/// The better of two pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Verdict {
    /// The first.
    A,
    /// The second.
    B,
    /// Neither.
    #[serde(rename = "equal")]
    Equal,
    /// Not to be told: the reference's noise is as large as the difference.
    #[serde(rename = "within noise")]
    WithinNoise,
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.pad(match self {
            Verdict::A => "A",
            Verdict::B => "B",
            Verdict::Equal => "equal",
            Verdict::WithinNoise => "noise",
        })
    }
}

/// What is no difference, in multiples of the reference's noise.
const NOISE_FACTOR: f64 = 4.0;

/// How far a picture is from the reference by one metric; 0 is best.
type Distance = fn(&Scores) -> f64;

/// The metrics that can say which of two pictures is better. A ratio is as far from 1 as its inverse. `over_occlusion` is
/// not among them: it is the mean over other pixels for each picture.
const METRICS: [(&str, Distance); 8] = [
    ("relmse", |s| s.relmse),
    ("rmse", |s| s.rmse),
    ("energy_ratio", |s| s.energy_ratio.ln().abs()),
    ("smape", |s| s.smape),
    ("flip", |s| s.flip),
    ("hdr_flip", |s| s.hdr_flip),
    ("leak", |s| s.leak),
    ("over_occluded", |s| s.over_occluded),
];

/// Whether a relMSE, or a difference of two, is below four times the noise.
pub fn within_noise(relmse: f64, noise: Option<f64>) -> bool {
    noise.is_some_and(|n| relmse.abs() < NOISE_FACTOR * n)
}

/// The better of two, by metric. relMSE: not told within four times the noise. The noise of other metrics is not known;
/// they are not told where both pictures' relMSE is within it.
pub fn better(a: &Scores, b: &Scores, noise: Option<f64>) -> BTreeMap<&'static str, Verdict> {
    let both = within_noise(a.relmse, noise) && within_noise(b.relmse, noise);
    let verdict = |(name, distance): &(&'static str, Distance)| {
        let (x, y) = (distance(a), distance(b));
        let verdict = match x.partial_cmp(&y) {
            _ if both || (*name == "relmse" && x != y && within_noise(x - y, noise)) => Verdict::WithinNoise,
            Some(std::cmp::Ordering::Less) => Verdict::A,
            Some(std::cmp::Ordering::Greater) => Verdict::B,
            _ => Verdict::Equal,
        };
        (*name, verdict)
    };
    METRICS.iter().map(verdict).collect()
}
