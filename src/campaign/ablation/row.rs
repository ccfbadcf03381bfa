//! Effect of each parameter's plain value over the scenes, with a verdict.

use super::Change;
use crate::campaign::record::{Outcome, first_line};
use crate::campaign::sweep::{NOTHING, SCENE, SET, collect};
use crate::lab::LabError;
use crate::measure::Point;
use crate::metrics::{Best, Metric};
use std::collections::HashMap;
use std::fmt;
use std::path::PathBuf;

/// Smaller relative changes do not count, even without noise.
const LEAST: f64 = 0.01;

/// Relative growth of a quantity with the plain value, so that all scenes count alike. The energy
/// error is relative already and may be near 0, so its growth is a difference.
#[derive(Clone, Debug, PartialEq)]
pub struct Delta {
    /// Mean over the scenes in the unchanged experiment, in the unit of the quantity.
    pub unchanged: f64,
    /// Mean growth over the scenes.
    pub change: f64,
    /// Means up to this are no change.
    pub noise: f64,
    /// The largest growth in a scene, or the least fall.
    pub worst: f64,
    /// Growth in that scene up to this is none.
    pub worst_noise: f64,
    pub worst_scene: String,
}

/// How an error changes.
#[derive(Clone, Debug, PartialEq)]
pub struct ErrorChange {
    /// Part of the light.
    pub part: String,
    /// Metric; of the energy ratio the error is its absolute logarithm.
    pub metric: &'static Metric,
    pub delta: Delta,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    pub change: Change,
    /// GPU time of a frame, ms. `None` on a device without timestamps.
    pub ms: Option<Delta>,
    /// Device memory of the graph, bytes. `None` if no scene has it.
    pub bytes: Option<Delta>,
    /// Errors by part and metric, without those that are not finite.
    pub errors: Vec<ErrorChange>,
    pub verdict: Verdict,
    /// Scenes without a result, with the reason.
    pub failed: Vec<(String, String)>,
}

/// Verdict on the experiment's value against the plain value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Errors grow without it, and it costs time or memory.
    Pays,
    /// Errors grow without it, and it costs nothing.
    Free,
    /// It costs time or memory, and reduces no error.
    DoesNotPay,
    /// Some errors grow without it and others fall.
    Mixed,
    NoEffect,
    /// It costs less than the plain value, and increases no error.
    Cheaper,
    /// The plain value costs more and has smaller errors.
    PlainPays,
    Failed,
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.pad(match self {
            Verdict::Pays => "pays",
            Verdict::Free => "free",
            Verdict::DoesNotPay => "does not pay",
            Verdict::Mixed => "mixed",
            Verdict::NoEffect => "no effect",
            Verdict::Cheaper => "cheaper",
            Verdict::PlainPays => "plain pays",
            Verdict::Failed => "failed",
        })
    }
}

/// A quantity in a scene.
#[derive(Clone, Copy)]
struct Sample {
    unchanged: f64,
    growth: f64,
    noise: f64,
}

impl Sample {
    /// Relative change of a quantity. Changes up to `noise`, in its unit, count as 0.
    fn relative(unchanged: f64, changed: f64, noise: f64) -> Sample {
        Sample {
            unchanged,
            growth: changed / unchanged - 1.0,
            noise: LEAST.max(noise / unchanged),
        }
    }
}

impl Delta {
    /// Means over scenes; nothing without one that has numbers.
    fn over(samples: &[(&String, Sample)]) -> Option<Delta> {
        let finite: Vec<_> = samples.iter().filter(|s| s.1.growth.is_finite()).collect();
        let (scene, worst) = finite
            .iter()
            .max_by(|a, b| a.1.growth.total_cmp(&b.1.growth))?;
        let mean = |of: fn(&Sample) -> f64| {
            finite.iter().map(|s| of(&s.1)).sum::<f64>() / finite.len() as f64
        };
        // Noise is independent between scenes, so squares add up. Negligible changes are not noise.
        let independent = (mean(|s| s.noise * s.noise) / finite.len() as f64).sqrt();
        Some(Delta {
            unchanged: mean(|s| s.unchanged),
            change: mean(|s| s.growth),
            noise: independent.max(LEAST),
            worst: worst.growth,
            worst_noise: worst.noise,
            worst_scene: (*scene).clone(),
        })
    }

    /// 1 where it grows by more than noise, -1 where it falls, or 0.
    pub fn sign(&self) -> i8 {
        i8::from(self.change > self.noise) - i8::from(self.change < -self.noise)
    }
}

/// Points by scene and setting.
type Points = HashMap<(String, String), Result<Point, String>>;

/// A row for each change, with errors of these parts of the light. `folders`: the sweep of all
/// changes, then those that repeat the unchanged experiment.
pub fn rows(
    folders: &[PathBuf],
    scenes: &[String],
    changes: &[Change],
    parts: &[String],
) -> Result<Vec<Row>, LabError> {
    let runs: Vec<Points> = folders.iter().map(read).collect::<Result<_, LabError>>()?;
    let unchanged: Vec<(&String, Vec<&Point>)> = scenes
        .iter()
        .map(|scene| {
            let key = (scene.clone(), NOTHING.to_string());
            (
                scene,
                runs.iter()
                    .filter_map(|run| run.get(&key)?.as_ref().ok())
                    .collect(),
            )
        })
        .collect();
    let first = runs.first();
    Ok(changes
        .iter()
        .map(|change| row(change, &unchanged, first, parts))
        .collect())
}

fn read(folder: &PathBuf) -> Result<Points, LabError> {
    let mut points = Points::new();
    for (planned, record) in collect(std::slice::from_ref(folder))?.points {
        let result = match record.map(|r| r.outcome) {
            Some(Outcome::Done(point)) => Ok(*point),
            Some(Outcome::Failed(why)) => Err(why),
            None => Err("not measured".into()),
        };
        let label = |name: &str| planned.labels.get(name).cloned().unwrap_or_default();
        points.insert((label(SCENE), label(SET)), result);
    }
    Ok(points)
}

fn row(
    change: &Change,
    unchanged: &[(&String, Vec<&Point>)],
    run: Option<&Points>,
    parts: &[String],
) -> Row {
    let (mut measured, mut failed) = (Vec::new(), Vec::new());
    for (scene, before) in unchanged {
        let key = ((*scene).clone(), change.setting());
        let why = match (before.first(), run.and_then(|r| r.get(&key))) {
            (Some(_), Some(Ok(after))) => {
                measured.push((*scene, before.as_slice(), after));
                continue;
            }
            (None, _) => "the experiment as it is failed".into(),
            (_, Some(Err(why))) => first_line(why).to_string(),
            (_, None) => "not measured".into(),
        };
        failed.push(((*scene).clone(), why));
    }
    let over = |of: &dyn Fn(&[&Point], &Point) -> Option<Sample>| {
        let samples: Vec<(&String, Sample)> = measured
            .iter()
            .filter_map(|(scene, before, after)| Some((*scene, of(before, after)?)))
            .collect();
        Delta::over(&samples)
    };
    let mut errors = Vec::new();
    for part in parts {
        for metric in Metric::few() {
            let delta = over(&|before, after| error(before.first()?, after, part, metric));
            errors.extend(delta.map(|delta| ErrorChange {
                part: part.clone(),
                metric,
                delta,
            }));
        }
    }
    let ms = over(&|before, after| Some(time(before, after)));
    let bytes = over(&|before, after| Some(memory(before.first()?, after)));
    let signs: Vec<i8> = errors.iter().map(|e| e.delta.sign()).collect();
    let sign = |cost: &Option<Delta>| cost.as_ref().map_or(0, Delta::sign);
    let verdict = if measured.is_empty() {
        Verdict::Failed
    } else {
        verdict(&signs, sign(&ms), sign(&bytes))
    };
    Row {
        change: change.clone(),
        ms,
        bytes,
        errors,
        verdict,
        failed,
    }
}

fn error(before: &Point, after: &Point, part: &str, metric: &Metric) -> Option<Sample> {
    let value = |p: &Point| {
        Some(metric.distance(p.scores.get(part)?.get(metric.key))).filter(|v| !v.is_nan())
    };
    let (unchanged, changed) = (value(before)?, value(after)?);
    // Noise of the reference gives a perfect picture this error. Both numbers contain it, so a
    // change is known far better.
    let known = metric.of_noise(before.noise_of(part)).unwrap_or(0.0);
    Some(match metric.best {
        Best::One => Sample {
            unchanged,
            growth: changed - unchanged,
            noise: LEAST,
        },
        _ => Sample::relative(unchanged, changed, known),
    })
}

/// Compares with the mean of the unchanged runs. Their spread is the noise.
fn time(before: &[&Point], after: &Point) -> Sample {
    let ms = |p: &Point| p.stats.total_gpu_ms.median;
    let runs = || before.iter().map(|p| ms(p));
    let mean = runs().sum::<f64>() / before.len() as f64;
    let spread = runs().fold(f64::MIN, f64::max) - runs().fold(f64::MAX, f64::min);
    Sample::relative(mean, ms(after), spread)
}

fn memory(before: &Point, after: &Point) -> Sample {
    let bytes = |p: &Point| p.stats.total_bytes as f64;
    Sample::relative(bytes(before), bytes(after), 0.0)
}

/// From the signs of what grows with the plain value.
fn verdict(errors: &[i8], ms: i8, bytes: i8) -> Verdict {
    // Memory counts where time says nothing.
    let cost = if ms == 0 { bytes } else { ms };
    match (errors.contains(&1), errors.contains(&-1), cost) {
        (true, true, _) => Verdict::Mixed,
        (true, false, -1) => Verdict::Pays,
        (true, false, _) => Verdict::Free,
        (false, _, -1) | (false, true, 0) => Verdict::DoesNotPay,
        (false, false, 0) => Verdict::NoEffect,
        (false, false, _) => Verdict::Cheaper,
        (false, true, _) => Verdict::PlainPays,
    }
}

#[cfg(test)]
mod tests {
    use super::{Delta, Sample, Verdict, verdict};

    #[test]
    fn verdicts_follow_from_what_grows_and_what_falls() {
        for (errors, ms, bytes, expected) in [
            (&[0, 1][..], -1, 0, Verdict::Pays),
            (&[1], 0, -1, Verdict::Pays),
            (&[1], 0, 0, Verdict::Free),
            (&[1], 1, -1, Verdict::Free),
            (&[0, 0], -1, 1, Verdict::DoesNotPay),
            (&[0, -1], -1, 0, Verdict::DoesNotPay),
            (&[-1], 0, 0, Verdict::DoesNotPay),
            (&[1, -1], -1, 0, Verdict::Mixed),
            (&[0], 0, 0, Verdict::NoEffect),
            (&[0], 1, 0, Verdict::Cheaper),
            (&[-1], 1, 0, Verdict::PlainPays),
            (&[], -1, 0, Verdict::DoesNotPay),
        ] {
            assert_eq!(
                verdict(errors, ms, bytes),
                expected,
                "{errors:?} {ms} {bytes}"
            );
        }
    }

    #[test]
    fn scenes_count_alike_and_their_noise_is_independent() {
        let names = ["dim", "bright", "black"].map(String::from);
        let dim = Sample::relative(0.01, 0.012, 0.0005);
        let bright = Sample::relative(10.0, 9.0, 0.0);
        let black = Sample::relative(0.0, 0.0, 0.0);
        let over = |list: &[Sample]| {
            Delta::over(&names.iter().zip(list.iter().copied()).collect::<Vec<_>>())
        };
        let d = over(&[dim, bright, black]).unwrap();
        let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-9, "{a} is not {b}");
        near(d.change, (0.2 - 0.1) / 2.0);
        near(d.noise, 0.05f64.hypot(0.01) / 2.0);
        assert_eq!((d.worst_scene.as_str(), d.sign()), ("dim", 1));
        near(d.worst, 0.2);
        near(d.worst_noise, 0.05);
        assert_eq!(over(&[bright]).unwrap().sign(), -1);
        // A hundredth is no change, however quiet.
        assert_eq!(
            over(&[Sample::relative(1.0, 1.009, 0.0)]).unwrap().sign(),
            0
        );
        assert_eq!(over(&[]), None);
    }
}
