//! Which of two pictures is better, by metric.

use crate::measure::reference::Noise;
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
pub const NOISE_FACTOR: f64 = 4.0;

/// How far a picture is from the reference by one metric; 0 is best.
type Distance = fn(&Scores) -> f64;

/// The metrics that can say which of two pictures is better. A ratio is as far from 1 as its inverse. `over_occlusion` is
/// not among them: it is the mean over other pixels for each picture.
const METRICS: [(&str, Distance); 9] = [
    ("relmse", |s| s.relmse),
    ("rmse", |s| s.rmse),
    ("energy_ratio", |s| s.energy_ratio.ln().abs()),
    ("smape", |s| s.smape),
    ("flip", |s| s.flip),
    ("hdr_flip", |s| s.hdr_flip),
    ("structure", |s| s.structure),
    ("leak", |s| s.leak),
    ("over_occluded", |s| s.over_occluded),
];

/// Whether a relMSE, or a difference of two, is below four times the noise.
pub fn within_noise(relmse: f64, noise: Option<f64>) -> bool {
    noise.is_some_and(|n| relmse.abs() < NOISE_FACTOR * n)
}

/// The better of two, by metric. relMSE is not told within four times its noise, structure within once, which is all that
/// the noise adds to a perfect picture. The noise of other metrics is not known; none is told where both pictures' relMSE
/// is within it.
pub fn better(a: &Scores, b: &Scores, noise: Option<Noise>) -> BTreeMap<&'static str, Verdict> {
    let relmse = noise.map(|n| n.relmse);
    let both = within_noise(a.relmse, relmse) && within_noise(b.relmse, relmse);
    let verdict = |(name, distance): &(&'static str, Distance)| {
        let (x, y) = (distance(a), distance(b));
        let noisy = match *name {
            "relmse" => within_noise(x - y, relmse),
            "structure" => noise.is_some_and(|n| (x - y).abs() < n.structure),
            _ => false,
        };
        let verdict = match x.partial_cmp(&y) {
            _ if both || (noisy && x != y) => Verdict::WithinNoise,
            Some(std::cmp::Ordering::Less) => Verdict::A,
            Some(std::cmp::Ordering::Greater) => Verdict::B,
            _ => Verdict::Equal,
        };
        (*name, verdict)
    };
    METRICS.iter().map(verdict).collect()
}
