//! A search as a sweep whose points are chosen one after another: records, pictures and tables are those of a sweep, so
//! that a search goes on where it was stopped and `conelab report` shows what it tried.

use super::search::{Found, Limits, Trial, search};
use super::{at, start};
use crate::campaign::points::{OpenScene, SweepPoint};
use crate::campaign::record::first_line;
use crate::campaign::runner::{Open, Progress, Runner};
use crate::campaign::settings::Axis;
use crate::campaign::sweep::{
    Manifest, ManifestPoint, Measuring, PointRecord, points_in, write_table,
};
use crate::experiment::Experiment;
use crate::graph::param::Params;
use crate::lab::{LabError, parts_of};
use crate::measure::{Frames, Scored};
use crate::metrics::Metric;
use crate::results::stats::DeviceStats;
use std::path::PathBuf;

/// What is made small and what is bounded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Goal {
    /// The least time with at most this error.
    Error(f64),
    /// The least error in at most this time, ms.
    Time(f64),
}

impl Goal {
    /// The bounded quantity's bound.
    pub fn bound(self) -> f64 {
        match self {
            Goal::Error(bound) | Goal::Time(bound) => bound,
        }
    }

    /// A setting's time (ms) and error.
    pub fn time_and_error(self, trial: Trial) -> (f64, f64) {
        match self {
            Goal::Error(_) => (trial.cost, trial.bounded),
            Goal::Time(_) => (trial.bounded, trial.cost),
        }
    }

    fn trial(self, ms: f64, error: f64) -> Trial {
        match self {
            Goal::Error(_) => Trial {
                cost: ms,
                bounded: error,
            },
            Goal::Time(_) => Trial {
                cost: error,
                bounded: ms,
            },
        }
    }
}

/// A search.
pub struct Request<'a> {
    /// The experiment that is varied.
    pub experiment: &'a Experiment,
    /// What is varied.
    pub axes: &'a [Axis],
    /// The quantity that is made small, and the bound of the other.
    pub goal: Goal,
    /// Part of the light that is compared.
    pub part: &'a str,
    /// How it is compared.
    pub metric: &'static Metric,
    /// Most settings to try.
    pub evaluations: usize,
    /// Gains below this part of a quantity are noise.
    pub least_gain: f64,
    /// How long a setting is timed.
    pub frames: Frames,
    /// Bounces of the reference.
    pub bounces: u32,
    /// Samples of every pixel that the reference has at least.
    pub samples: u64,
    /// Where everything is kept; what was tried there on the same device is not measured again.
    pub folder: PathBuf,
}

/// What a search has found.
pub struct Fitted {
    /// The best setting, and everything that was tried.
    pub found: Found,
    /// The best setting.
    pub best: Experiment,
    /// The graph's parameters at their defaults.
    pub defaults: Params,
}

/// Searches. The folder's list of points is written when the search ends, the points themselves one by one.
///
/// # Errors
/// What is wrong with experiment, scene or reference; a start that cannot be run; a folder that cannot be written to; no
/// device.
pub fn run(
    open: &Open,
    open_scene: &OpenScene,
    request: &Request,
    on_progress: &mut dyn FnMut(Progress),
) -> Result<Fitted, LabError> {
    let mut runner = Runner::open(open, open_scene, on_progress)?;
    let Request {
        experiment,
        axes,
        part,
        ..
    } = *request;
    let graph = runner
        .warm
        .graph(&runner.lab.home, &experiment.graph)?
        .graph
        .clone();
    let measuring = Measuring {
        frames: request.frames,
        bounces: &[request.bounces],
        samples: Some(request.samples),
        scored: Scored::One(part, request.metric),
    };
    let first = start(axes, &experiment.params_over(&graph.params)?);
    let begin = point(&mut runner, request, &first)?;
    let references = measuring.references(&mut runner, &begin)?;
    let known = references
        .first()
        .and_then(|(_, reference)| reference.parts.get(part));
    let parts = parts_of(&graph);
    let Some(known) = known.filter(|_| parts.iter().any(|p| p.name == part)) else {
        let all: Vec<&str> = parts.iter().map(|p| p.name.as_str()).collect();
        return Err(LabError::Request(format!(
            "no part '{part}'; there are {}",
            all.join(", ")
        )));
    };
    if let Goal::Error(bound) = request.goal
        && request.metric.within(bound, known.noise)
    {
        let message = format!(
            "warning: an error of {bound} is not told from the reference's noise: raise --spp"
        );
        runner.tell(Progress::Note(message));
    }
    let folder = points_in(&request.folder);
    folder.clean(&["points", "pictures", "errors", "references"]);
    let mut points: Vec<ManifestPoint> = Vec::new();
    let sizes: Vec<usize> = axes.iter().map(|a| a.1.len()).collect();
    let limits = Limits {
        bound: request.goal.bound(),
        evaluations: request.evaluations,
        least_gain: request.least_gain,
    };
    let mut refused = String::new();
    runner.tell(Progress::Begins {
        todo: request.evaluations,
        before: 0,
    });
    let found = search(&sizes, &first, limits, &mut |place| {
        let tried = point(&mut runner, request, place)?;
        // Times of another device say nothing here.
        let mut kept = |runner: &mut Runner, point: &SweepPoint| {
            let here = DeviceStats::of(&runner.lab.gpu.info);
            let record = measuring.kept(runner, &folder, point)?;
            Ok(record.filter(|r| r.device == here && scored(r, request)))
        };
        let mut measured =
            |runner: &mut Runner, point: &SweepPoint| measuring.measured(runner, point);
        let record = runner.one(&folder, &tried, &mut kept, &mut measured)?;
        points.push(ManifestPoint::of(&tried));
        let (trial, why) = quantities(&record, request);
        refused = why.unwrap_or_default();
        let what = match trial.map(|t| request.goal.time_and_error(t)) {
            Some((ms, error)) => format!("{ms:9.3} ms {error:11.4e}"),
            None => format!("cannot be run: {refused}"),
        };
        runner.tell(Progress::Tried(format!(
            "{:4} {what}  {}",
            points.len(),
            names(axes, place)
        )));
        Ok::<_, LabError>(trial)
    })?;
    runner.tell(Progress::Ends);
    let varied = axes.iter().map(|a| a.0.clone()).collect();
    let text = axes
        .iter()
        .map(|(name, values)| format!("{name}={}\n", values.join(",")))
        .collect();
    Manifest::new(
        experiment.name.clone(),
        text,
        varied,
        request.frames,
        points,
    )
    .write(&request.folder)?;
    write_table(&request.folder)?;
    LabError::of_messages(runner.lab.gpu.messages().len())?;
    let found = found.ok_or_else(|| {
        LabError::Request(format!(
            "the setting to start from cannot be run: {refused}"
        ))
    })?;
    let best = at(experiment, axes, &found.place);
    Ok(Fitted {
        found,
        best,
        defaults: graph.params.clone(),
    })
}

/// The values of a place, where there is more than one.
fn names(axes: &[Axis], place: &[usize]) -> String {
    let list = axes.iter().zip(place).filter(|(axis, _)| axis.1.len() > 1);
    list.map(|((name, values), i)| format!("{name}={}", values[*i]))
        .collect::<Vec<_>>()
        .join(" ")
}

fn point(runner: &mut Runner, request: &Request, place: &[usize]) -> Result<SweepPoint, LabError> {
    let labels = request
        .axes
        .iter()
        .zip(place)
        .map(|((name, values), i)| (name.clone(), values[*i].clone()))
        .collect();
    runner.point(
        at(request.experiment, request.axes, place),
        labels,
        request.frames,
    )
}

/// Whether a record has the score that is searched by; those of an earlier search by another metric have not.
fn scored(record: &PointRecord, request: &Request) -> bool {
    record.done().is_none_or(|point| {
        point
            .scores
            .get(request.part)
            .is_some_and(|s| s.not_finite > 0 || s.get(request.metric.key).is_finite())
    })
}

/// Both quantities of a setting; nothing, and why, where graph, device or one of the graph's checks refuses it.
fn quantities(record: &PointRecord, request: &Request) -> (Option<Trial>, Option<String>) {
    let Some(point) = record.done() else {
        return (None, record.error().map(String::from));
    };
    if let Some(warning) = point.stats.warnings.first() {
        return (None, Some(first_line(warning).to_string()));
    }
    let scores = point.scores.get(request.part);
    // Metrics leave pixels out that are no numbers; a setting that makes them must not look better for it.
    let value = scores
        .filter(|s| s.not_finite == 0)
        .map_or(f64::NAN, |s| s.get(request.metric.key));
    if !value.is_finite() {
        return (None, Some("pixels that are no numbers".into()));
    }
    (
        Some(request.goal.trial(
            point.stats.total_gpu_ms.median,
            request.metric.distance(value),
        )),
        None,
    )
}
