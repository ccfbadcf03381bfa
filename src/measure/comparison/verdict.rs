//! Which of two pictures is better, by metric.

use crate::metrics::{Metric, Noise, RELMSE, Scores, within_noise};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt;

/// The better of two pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Verdict {
    /// The first picture is better.
    A,
    /// The second picture is better.
    B,
    /// Both are equal.
    #[serde(rename = "equal")]
    Equal,
    /// Undecided: the difference is within the noise of the reference.
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

/// The better picture by metric. Differences are insignificant within four times the noise for
/// relMSE, and within the noise for FLIP and structure, because the noise adds that much to a perfect
/// picture. The noise of other metrics is unknown; they are undecided if both pictures' relMSE is
/// within the noise.
pub fn better(a: &Scores, b: &Scores, noise: Option<Noise>) -> BTreeMap<&'static str, Verdict> {
    let both = [a, b]
        .iter()
        .all(|s| within_noise(s.get(RELMSE), noise.map(|n| n.relmse)));
    let verdict = |metric: &'static Metric| {
        let [x, y] = [a, b].map(|s| metric.distance(s.get(metric.key)));
        let noisy = noise.is_some_and(|n| metric.within(x - y, n));
        let verdict = match x.partial_cmp(&y) {
            _ if both || (noisy && x != y) => Verdict::WithinNoise,
            Some(std::cmp::Ordering::Less) => Verdict::A,
            Some(std::cmp::Ordering::Greater) => Verdict::B,
            _ => Verdict::Equal,
        };
        (metric.key, verdict)
    };
    Metric::ranking().map(verdict).collect()
}
