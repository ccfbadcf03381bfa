//! `conelab fit`.

use super::DeviceArgs;
use super::adapt::{self, ExperimentArgs};
use crate::campaign::fit::{self, Evaluator, Found, Goal, Limits, Step, Stop, Subject};
use crate::campaign::settings::{Axis, axis};
use crate::experiment::Experiment;
use crate::files::FileError;
use crate::lab::{Lab, LabError, Workspace, params_of};
use crate::measure::Frames;
use crate::measure::reference::{self, ALL_BOUNCES};
use crate::metrics::{Metric, RELMSE, within_noise};
use clap::Args;
use serde::Serialize;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Arguments of `fit`.
#[derive(Debug, Args)]
pub struct FitArgs {
    #[command(flatten)]
    experiment: ExperimentArgs,
    /// The least time with at most this error.
    #[arg(long, value_name = "ERROR", required_unless_present = "max_ms", conflicts_with = "max_ms")]
    max_error: Option<f64>,
    /// The least error in at most this GPU time, ms.
    #[arg(long, value_name = "MS")]
    max_ms: Option<f64>,
    /// How the error is measured.
    #[arg(long, default_value = RELMSE, value_parser = super::metric_of(Metric::ranking()))]
    metric: &'static Metric,
    /// Part of the light that is compared.
    #[arg(long, default_value = "total")]
    part: String,
    /// Vary this parameter over these values, neighbours alike; may be given many times. The graph's own list when
    /// absent.
    #[arg(long, value_name = "NAME=VALUE,VALUE")]
    vary: Vec<String>,
    /// Most settings to try.
    #[arg(long, default_value_t = 400)]
    evaluations: usize,
    /// Frames that are timed for each setting.
    #[arg(long, default_value_t = 9)]
    frames: usize,
    /// Frames before them; on a GPU more, until it has worked for 100 ms.
    #[arg(long, default_value_t = 3)]
    warmup: usize,
    /// Samples of every pixel of the reference, if more are needed than are there.
    #[arg(long, default_value_t = 1024)]
    spp: u64,
    /// Turns of the reference's paths.
    #[arg(long, default_value_t = ALL_BOUNCES)]
    bounces: u32,
    /// The experiment to write; captures/fit/NAME.ron when absent. What was tried goes beside it, as JSON.
    #[arg(short, long)]
    output: Option<PathBuf>,
    #[command(flatten)]
    device: DeviceArgs,
}

/// Gains below this part of a time or an error are taken for noise.
const LEAST_GAIN: f64 = 0.01;

/// Version of the JSON.
const SCHEMA: &str = "conelab-fit-1";

/// What the JSON holds.
#[derive(Serialize)]
struct Log {
    schema: &'static str,
    version: &'static str,
    device: String,
    scene: String,
    size: (u32, u32),
    goal: String,
    why_it_ended: &'static str,
    /// Settings of the whole grid.
    grid: u64,
    reference_samples: u64,
    noise: f64,
    axes: Vec<Axis>,
    /// Settings in the order in which they were tried: values by axis, ms, error.
    tried: Vec<Tried>,
    best: Tried,
}

#[derive(Serialize)]
struct Tried {
    set: Vec<String>,
    ms: Option<f64>,
    error: Option<f64>,
}

/// Finds the cheapest setting within a bound.
pub fn run(args: &FitArgs) -> Result<(), LabError> {
    let experiment = args.experiment.read()?;
    adapt::check_frames(args.frames, args.warmup, 0.0)?;
    let goal = match (args.max_error, args.max_ms) {
        (Some(bound), _) => Goal::Error(bound),
        (None, Some(bound)) => Goal::Time(bound),
        (None, None) => return Err(LabError::Request("give --max-error or --max-ms".into())),
    };
    if !(goal.bound() > 0.0 && goal.bound().is_finite()) || args.evaluations == 0 {
        return Err(LabError::Request("the bound and --evaluations must be above 0".into()));
    }
    let home = Workspace::find()?;
    let output = match &args.output {
        Some(path) if path.extension().is_some_and(|e| e == "ron") => path.clone(),
        Some(path) => return Err(LabError::Request(format!("'{}': give it a name that ends in .ron", path.display()))),
        None => home.root.join("captures/fit").join(format!("{}.ron", experiment.name)),
    };
    let loaded = home.load(&experiment.graph).map_err(LabError::Input)?;
    let given = args.vary.iter().map(|text| axis("--vary", text, "NAME=VALUE,VALUE")).collect::<Result<Vec<_>, _>>()?;
    let axes = fit::axes(&loaded.graph, &given)?;
    let scene = Arc::new(adapt::open_scene(&experiment)?);
    let lab = Lab::open(home, args.device.options())?;
    let wanted = reference::Goal::Samples(args.spp);
    let reference = super::reference::with_bar(&lab, &experiment, &scene, args.bounces, wanted)?;
    let noise = reference.parts.get(&args.part).map_or(0.0, |p| p.noise.relmse);
    if let Goal::Error(bound) = goal
        && args.metric.key == RELMSE
        && within_noise(bound, Some(noise))
    {
        eprintln!(
            "warning: an error of {bound} is below four times the reference's noise ({noise:.2e}) and cannot be told \
             from it: raise --spp"
        );
    }
    let start = fit::start(&axes, &params_of(&loaded.graph, &experiment)?);
    let sizes: Vec<usize> = axes.iter().map(|a| a.1.len()).collect();
    let subject = Subject {
        lab: &lab,
        loaded: &loaded,
        scene: scene.clone(),
        experiment: &experiment,
        axes: &axes,
        reference: &reference,
        part: &args.part,
        metric: args.metric,
        frames: Frames { warmup: args.warmup, count: args.frames },
        goal,
    };
    let mut evaluator = Evaluator::new(&subject)?;
    let bar = indicatif::ProgressBar::new_spinner();
    let limits = Limits { bound: goal.bound(), evaluations: args.evaluations, least_gain: LEAST_GAIN };
    let mut number = 0;
    let found = fit::search(&sizes, &start, limits, &mut |place| {
        let trial = evaluator.evaluate(place)?;
        number += 1;
        let what = match (trial, &evaluator.refused) {
            (Some(trial), _) => {
                let (ms, error) = goal.time_and_error(trial);
                format!("{ms:9.3} ms {error:11.4e}")
            }
            (None, why) => format!("cannot be run: {}", why.as_deref().unwrap_or("").lines().next().unwrap_or("")),
        };
        bar.suspend(|| say!("{number:4} {what}  {}", names(&axes, place)));
        bar.tick();
        Ok::<_, LabError>(trial)
    })?;
    bar.finish_and_clear();
    let found = found.ok_or_else(|| {
        let why = evaluator.refused.clone().unwrap_or_default();
        LabError::Request(format!("the setting to start from cannot be run: {why}"))
    })?;
    let best = fit::at(&experiment, &axes, &found.place);
    let summary = summary(&found, goal, args, &sizes);
    crate::experiment::write(&best, &loaded.graph.params, &output, true)?;
    comment(&output, &summary, &best, &loaded.graph.params)?;
    let log = log(&found, goal, &subject, &summary, &sizes, noise);
    let json = output.with_extension("json");
    super::write_json(&json, &log)?;
    say!("{}", summary.join("\n"));
    say!("wrote {}", super::shown(&output).display());
    let within = found.trial.bounded <= goal.bound();
    super::validated(&lab)?;
    if within { Ok(()) } else { Err(LabError::Request("no setting that was tried is within the bound".into())) }
}

fn names(axes: &[Axis], place: &[usize]) -> String {
    let list = axes.iter().zip(place).filter(|(axis, _)| axis.1.len() > 1);
    list.map(|((name, values), i)| format!("{name}={}", values[*i])).collect::<Vec<_>>().join(" ")
}

fn why(stop: Stop) -> &'static str {
    match stop {
        Stop::Local => {
            "no step of one parameter, no promising pair of steps, and nothing that all trials together promise is better"
        }
        Stop::Evaluations => "the evaluations are used up",
        Stop::Unreachable => "no step comes nearer to the bound",
    }
}

/// What the search has found, for people.
fn summary(found: &Found, goal: Goal, args: &FitArgs, sizes: &[usize]) -> Vec<String> {
    let (ms, error) = goal.time_and_error(found.trial);
    let metric = args.metric.axis();
    let bound = match goal {
        Goal::Error(bound) => format!("{metric} at most {bound}"),
        Goal::Time(bound) => format!("at most {bound} ms"),
    };
    let grid = sizes.iter().map(|n| *n as u64).product::<u64>();
    vec![
        format!("{ms:.3} ms, {metric} {error:.4e} of the {} (wanted: {bound})", args.part),
        format!("{} of {grid} settings tried; {}", found.tried.len(), why(found.stop)),
    ]
}

/// Puts lines of comment before an experiment that was just written.
fn comment(
    path: &Path,
    lines: &[String],
    best: &Experiment,
    defaults: &crate::graph::param::Params,
) -> Result<(), LabError> {
    let text = std::fs::read_to_string(path).map_err(|e| FileError::write(path, e))?;
    let mut out = String::new();
    for line in lines {
        let _ = writeln!(out, "// {line}");
    }
    // Comments of an earlier search about this file say nothing about this one.
    out.extend(text.lines().skip_while(|l| l.starts_with("//")).map(|l| format!("{l}\n")));
    let same = Experiment::from_text(path, &out).map_err(LabError::Input)?.params_over(defaults)?;
    if same.values != best.params_over(defaults)?.values {
        return Err(FileError::write(path, "it would not read back as it is").into());
    }
    Ok(crate::files::write_whole(path, out.as_bytes())?)
}

fn log(found: &Found, goal: Goal, subject: &Subject<'_>, summary: &[String], sizes: &[usize], noise: f64) -> Log {
    let tried = |step: &Step| {
        let both = step.trial.map(|t| goal.time_and_error(t));
        let set = subject.axes.iter().zip(&step.place).map(|(axis, i)| axis.1[*i].clone()).collect();
        Tried { set, ms: both.map(|b| b.0), error: both.map(|b| b.1) }
    };
    Log {
        schema: SCHEMA,
        version: env!("CARGO_PKG_VERSION"),
        device: subject.lab.gpu.info.name.clone(),
        scene: subject.scene.name.clone(),
        size: subject.experiment.size,
        goal: summary.first().cloned().unwrap_or_default(),
        why_it_ended: why(found.stop),
        grid: sizes.iter().map(|n| *n as u64).product(),
        reference_samples: subject.reference.samples,
        noise,
        axes: subject.axes.to_vec(),
        tried: found.tried.iter().map(tried).collect(),
        best: tried(&Step { place: found.place.clone(), trial: Some(found.trial) }),
    }
}
