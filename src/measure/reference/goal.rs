//! When a reference has enough samples.

use super::store::BLOCK;
use crate::metrics::{METRICS, Metric};
use std::str::FromStr;

/// Stopping criterion of a reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Goal {
    /// Samples per pixel, rounded up to a multiple of 32.
    Samples(u64),
    /// Until the noise is low enough.
    Noise(NoiseBound),
}

/// A bound on the error of the total against the converged reference, estimated from the halves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoiseBound {
    /// A metric with a known noise.
    pub metric: &'static Metric,
    /// The largest accepted error.
    pub error: f64,
    /// Samples per pixel at which gathering ends in any case.
    pub most: u64,
}

/// Default of [`NoiseBound::most`], because a bound may be unreachable.
pub const MOST_SAMPLES: u64 = 1 << 20;

impl FromStr for NoiseBound {
    type Err = String;

    /// Reads `METRIC=ERROR`, for example `flip=0.01`.
    fn from_str(text: &str) -> Result<NoiseBound, String> {
        let known = || METRICS.iter().filter(|m| m.noise.is_some());
        let keys: Vec<&str> = known().map(|m| m.key).collect();
        let wrong = || {
            format!(
                "expected METRIC=ERROR with an error above 0, for example flip=0.01; metrics: {}",
                keys.join(", ")
            )
        };
        let (key, error) = text.split_once('=').ok_or_else(wrong)?;
        let error: f64 = error.parse().map_err(|_| wrong())?;
        match known().find(|m| m.key == key) {
            Some(metric) if error > 0.0 && error.is_finite() => Ok(NoiseBound {
                metric,
                error,
                most: MOST_SAMPLES,
            }),
            _ => Err(wrong()),
        }
    }
}

impl FromStr for Goal {
    type Err = String;

    /// Reads a number of samples or a bound on the noise.
    fn from_str(text: &str) -> Result<Goal, String> {
        match text.parse() {
            Ok(samples) => Ok(Goal::Samples(samples)),
            Err(_) => text.parse().map(Goal::Noise),
        }
    }
}

impl Goal {
    /// Samples per pixel where nothing is asked for.
    pub const DEFAULT_SAMPLES: u64 = 256;

    /// Estimated samples at the goal, in whole blocks; at most `samples` if the goal is reached.
    /// `noise` is the last known value of the bound's metric.
    pub(super) fn samples(self, samples: u64, noise: Option<f64>) -> u64 {
        let whole = |n: u64| n.max(1).next_multiple_of(BLOCK);
        let bound = match self {
            Goal::Samples(n) => return whole(n),
            Goal::Noise(bound) => bound,
        };
        let factor = match noise {
            Some(noise) if noise <= bound.error && samples.is_multiple_of(BLOCK) => return samples,
            Some(noise) => {
                let order = bound.metric.noise.as_ref().map_or(1.0, |of| of.order);
                (noise / bound.error).powf(1.0 / order).clamp(1.0, 1e6)
            }
            None => 2.0,
        };
        let estimate = (samples as f64 * factor) as u64;
        whole(estimate.max(samples + 1)).min(whole(bound.most))
    }
}

/// Whether the noise is computed at this number of samples: whole blocks, in steps of 1/16 to 1/8 of
/// the samples. Runs of equal bounds therefore end at equal numbers of samples, whatever the speed
/// of the device.
pub(super) fn is_checkpoint(samples: u64) -> bool {
    let step = match samples / (8 * BLOCK) {
        0 => BLOCK,
        n => BLOCK << n.ilog2(),
    };
    samples > 0 && samples.is_multiple_of(step)
}

#[cfg(test)]
mod tests {
    use super::{BLOCK, Goal, NoiseBound, is_checkpoint};

    #[test]
    fn noise_is_checked_in_steps_of_a_sixteenth_to_an_eighth() {
        let checked: Vec<u64> = (1..=40 * BLOCK).filter(|n| is_checkpoint(*n)).collect();
        let blocks: Vec<u64> = checked.iter().map(|n| n / BLOCK).collect();
        let expected: Vec<u64> = (1..=16)
            .chain((18..=32).step_by(2))
            .chain([36, 40])
            .collect();
        assert_eq!(blocks, expected);
    }

    #[test]
    fn a_bound_is_reached_only_at_known_noise_or_the_most_samples() {
        let mut bound: NoiseBound = "relmse=0.01".parse().unwrap();
        bound.most = 100;
        let goal = Goal::Noise(bound);
        assert_eq!(goal.samples(64, Some(0.01)), 64);
        assert_eq!(goal.samples(32, Some(0.02)), 64);
        assert_eq!(goal.samples(32, None), 64);
        assert_eq!(goal.samples(32, Some(1.0)), 128);
        assert_eq!(goal.samples(128, Some(1.0)), 128);
    }

    #[test]
    fn goals_are_numbers_or_bounds_of_metrics_with_known_noise() {
        assert_eq!("512".parse(), Ok(Goal::Samples(512)));
        let Ok(Goal::Noise(bound)) = "flip=0.01".parse() else {
            panic!("no bound")
        };
        assert_eq!((bound.metric.key, bound.error), ("flip", 0.01));
        for wrong in [
            "",
            "flip",
            "flip=0",
            "flip=-1",
            "flip=nan",
            "energy_ratio=1",
            "x=1",
        ] {
            let message = wrong.parse::<Goal>().unwrap_err();
            assert!(message.contains("relmse, flip, structure"), "{message}");
        }
    }
}
