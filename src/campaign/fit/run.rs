//! A search as a sweep with points that are chosen one by one. It writes the records, pictures and
//! tables of a sweep, so it can be continued, and `conelab report` shows all trials.

use super::search::{Found, Limits, Trial, search};
use super::{at, start};
use crate::campaign::points::{OpenScene, SweepPoint};
use crate::campaign::record::first_line;
use crate::campaign::runner::{OnProgress, Open, Progress, Runner};
use crate::campaign::settings::Axis;
use crate::campaign::sweep::{
    Manifest, ManifestPoint, Measuring, PointRecord, points_in, write_table,
};
use crate::experiment::Experiment;
use crate::graph::Graph;
use crate::graph::param::Params;
use crate::lab::{LabError, parts_of};
use crate::measure::{Frames, Scored, reference};
use crate::metrics::Metric;
use crate::results::stats::DeviceStats;
use std::path::PathBuf;

/// Gains below this part of a time or an error are taken for noise.
pub const LEAST_GAIN: f64 = 0.01;

/// The bounded quantity. The other one is minimised.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Goal {
    /// Least time with at most this error.
    Error(f64),
    /// Least error in at most this time, ms.
    Time(f64),
}

impl Goal {
    /// Bound of the bounded quantity.
    pub fn bound(self) -> f64 {
        match self {
            Goal::Error(bound) | Goal::Time(bound) => bound,
        }
    }

    /// Time (ms) and error of a trial.
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
    /// Experiment before any change.
    pub experiment: &'a Experiment,
    /// Varied parameters with their values.
    pub axes: &'a [Axis],
    /// The bounded quantity with its bound.
    pub goal: Goal,
    /// Part of the light to score.
    pub part: &'a str,
    /// Metric of the scores.
    pub metric: &'static Metric,
    /// Largest number of evaluations.
    pub evaluations: usize,
    /// Relative gains below this are noise.
    pub least_gain: f64,
    /// Frames of each evaluation.
    pub frames: Frames,
    /// Bounces of the reference.
    pub bounces: u32,
    /// Least number of samples per pixel of the reference.
    pub samples: u64,
    /// Folder of the records. Settings in it are not measured again on the same device.
    pub folder: PathBuf,
}

impl Request<'_> {
    fn measuring(&self) -> Measuring<'_> {
        Measuring {
            frames: self.frames,
            bounces: std::slice::from_ref(&self.bounces),
            goal: Some(reference::Goal::Samples(self.samples)),
            scored: Scored::One(self.part, self.metric),
        }
    }

    fn limits(&self) -> Limits {
        Limits {
            bound: self.goal.bound(),
            evaluations: self.evaluations,
            least_gain: self.least_gain,
        }
    }
}

/// Result of a search.
pub struct Fitted {
    /// Best setting and all trials.
    pub found: Found,
    /// Experiment with the best setting.
    pub best: Experiment,
    /// Default parameters of the graph.
    pub defaults: Params,
}

/// Searches. Writes each point at once, and the list of points at the end.
pub fn run(
    open: &Open,
    open_scene: &OpenScene,
    request: &Request,
    on_progress: &mut OnProgress<'_>,
) -> Result<Fitted, LabError> {
    let mut runner = Runner::open(open, open_scene, on_progress)?;
    let (experiment, axes) = (request.experiment, request.axes);
    let Runner { lab, warm, .. } = &mut runner;
    let graph = warm.graph(&lab.home, &experiment.graph)?.graph.clone();
    let measuring = request.measuring();
    let first = start(axes, &experiment.params_over(&graph.params)?);
    let begin = point(&mut runner, request, &first)?;
    check(&mut runner, request, &measuring, &graph, &begin)?;
    let folder = points_in(&request.folder);
    folder.clean(&["points", "pictures", "errors", "references"]);
    let mut points: Vec<ManifestPoint> = Vec::new();
    let sizes: Vec<usize> = axes.iter().map(|a| a.1.len()).collect();
    let mut refused = String::new();
    runner.tell(Progress::Begins {
        todo: request.evaluations,
        before: 0,
    })?;
    let found = search(&sizes, &first, request.limits(), &mut |place| {
        let tried = point(&mut runner, request, place)?;
        // Times of other devices do not count.
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
        let (number, names) = (points.len(), names(axes, place));
        runner.tell(Progress::Tried(format!("{number:4} {what}  {names}")))?;
        Ok::<_, LabError>(trial)
    })?;
    runner.tell(Progress::Ends)?;
    write(request, points)?;
    LabError::of_messages(runner.lab.gpu.messages().len())?;
    let why = || format!("the setting to start from cannot be run: {refused}");
    let found = found.ok_or_else(|| LabError::Request(why()))?;
    let best = at(experiment, axes, &found.place);
    Ok(Fitted {
        found,
        best,
        defaults: graph.params.clone(),
    })
}

/// Checks that the reference has the part, and warns about noise above the bound.
fn check(
    runner: &mut Runner,
    request: &Request,
    measuring: &Measuring,
    graph: &Graph,
    begin: &SweepPoint,
) -> Result<(), LabError> {
    let part = request.part;
    let references = measuring.references(runner, begin)?;
    let known = references
        .first()
        .and_then(|(_, reference)| reference.parts.get(part));
    let parts = parts_of(graph);
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
        let message =
            format!("warning: an error of {bound} is within the reference's noise: raise --spp");
        runner.tell(Progress::Note(message))?;
    }
    Ok(())
}

/// Writes the list of points and the table.
fn write(request: &Request, points: Vec<ManifestPoint>) -> Result<(), LabError> {
    let varied = request.axes.iter().map(|a| a.0.clone()).collect();
    let text = request
        .axes
        .iter()
        .map(|(name, values)| format!("{name}={}\n", values.join(",")))
        .collect();
    let name = request.experiment.name.clone();
    Manifest::new(name, text, varied, request.frames, points).write(&request.folder)?;
    write_table(&request.folder)
}

/// The varied values, as text.
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

/// Whether a record has the score of the search. Records of a search by another metric lack it.
fn scored(record: &PointRecord, request: &Request) -> bool {
    record.done().is_none_or(|point| {
        point
            .scores
            .get(request.part)
            .is_some_and(|s| s.not_finite > 0 || s.get(request.metric.key).is_finite())
    })
}

/// Both quantities of a setting. If graph, device or a check of the graph rejects it, the reason.
fn quantities(record: &PointRecord, request: &Request) -> (Option<Trial>, Option<String>) {
    let Some(point) = record.done() else {
        return (None, record.error().map(String::from));
    };
    if let Some(warning) = point.stats.warnings.first() {
        return (None, Some(first_line(warning).to_string()));
    }
    let scores = point.scores.get(request.part);
    // Metrics skip pixels that are not finite. Settings with such pixels must not gain from that.
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
