//! `conelab fit`.

use super::DeviceArgs;
use super::adapt::{self, ExperimentArgs};
use super::campaign_bar::bar;
use crate::campaign::fit::{self, Fitted, Found, Goal, LEAST_GAIN, Request};
use crate::campaign::runner::Progress;
use crate::campaign::settings::{Axis, axis};
use crate::experiment::Experiment;
use crate::files::FileError;
use crate::graph::param::Params;
use crate::lab::{Lab, LabError, Workspace};
use crate::measure::Frames;
use crate::measure::reference::ALL_BOUNCES;
use crate::metrics::{Metric, RELMSE};
use clap::Args;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Arguments of `fit`.
#[derive(Debug, Args)]
pub struct FitArgs {
    #[command(flatten)]
    experiment: ExperimentArgs,
    /// Find the least GPU time with at most this error.
    #[arg(
        long,
        value_name = "ERROR",
        required_unless_present = "max_ms",
        conflicts_with = "max_ms"
    )]
    max_error: Option<f64>,
    /// Find the least error within this GPU time, ms.
    #[arg(long, value_name = "MS")]
    max_ms: Option<f64>,
    /// Error metric.
    #[arg(long, default_value = RELMSE, value_parser = super::metric_of(Metric::ranking()))]
    metric: &'static Metric,
    /// Light component to compare.
    #[arg(long, default_value = "total")]
    part: String,
    /// Vary this parameter over these values, with similar values next to each other (repeatable).
    /// Default: the graph's own list.
    #[arg(long, value_name = "NAME=VALUE,VALUE")]
    vary: Vec<String>,
    /// Maximum number of settings.
    #[arg(long, default_value_t = 400)]
    evaluations: usize,
    /// Timed frames of each setting.
    #[arg(long, default_value_t = 9)]
    frames: usize,
    /// Warm-up frames before them (extended to 100 ms on GPUs).
    #[arg(long, default_value_t = 3)]
    warmup: usize,
    /// Samples per pixel of the reference, if the cached one has fewer.
    #[arg(long, default_value_t = 1024)]
    spp: u64,
    /// Bounces of the reference.
    #[arg(long, default_value_t = ALL_BOUNCES)]
    bounces: u32,
    /// Experiment file to write; captures/fit/NAME.ron when absent. A folder next to it stores all
    /// trials as points of a sweep, so that a cancelled search can be resumed.
    #[arg(short, long)]
    output: Option<PathBuf>,
    #[command(flatten)]
    device: DeviceArgs,
}

fn goal(args: &FitArgs) -> Result<Goal, LabError> {
    let goal = match (args.max_error, args.max_ms) {
        (Some(bound), _) => Goal::Error(bound),
        (None, Some(bound)) => Goal::Time(bound),
        (None, None) => return Err(LabError::Request("give --max-error or --max-ms".into())),
    };
    if !(goal.bound() > 0.0 && goal.bound().is_finite()) || args.evaluations == 0 {
        return Err(LabError::Request(
            "the bound and --evaluations must be above 0".into(),
        ));
    }
    Ok(goal)
}

fn output(args: &FitArgs, home: &Workspace, name: &str) -> Result<PathBuf, LabError> {
    match &args.output {
        Some(path) if path.extension().is_some_and(|e| e == "ron") => Ok(path.clone()),
        Some(path) => Err(LabError::Request(format!(
            "'{}': give it a name that ends in .ron",
            path.display()
        ))),
        None => Ok(home.captures.join("fit").join(format!("{name}.ron"))),
    }
}

/// Finds the cheapest setting within a bound.
pub fn run(args: &FitArgs) -> Result<(), LabError> {
    let experiment = args.experiment.read()?;
    adapt::check_frames(args.frames, args.warmup, 0.0)?;
    let goal = goal(args)?;
    let home = Workspace::find()?;
    let output = output(args, &home, &experiment.name)?;
    let given = args.vary.iter();
    let given = given.map(|text| axis("--vary", text, "NAME=VALUE,VALUE"));
    let given = given.collect::<Result<Vec<_>, _>>()?;
    let graph = home.load_of(&experiment).map_err(LabError::Input)?.graph;
    let axes = fit::axes(&graph, &given)?;
    let folder = output.with_extension("");
    let request = Request {
        experiment: &experiment,
        axes: &axes,
        goal,
        part: &args.part,
        metric: args.metric,
        evaluations: args.evaluations,
        least_gain: LEAST_GAIN,
        frames: Frames {
            warmup: args.warmup,
            count: args.frames,
        },
        bounces: args.bounces,
        samples: args.spp,
        folder: folder.clone(),
    };
    let mut bar = bar("settings ");
    let open = || Lab::open(home.clone(), args.device.options());
    let mut on_progress = |progress| match progress {
        // Warnings of a setting are in its line.
        Progress::Finished(what, _) => bar(Progress::Finished(what, Vec::new())),
        other => bar(other),
    };
    let Fitted {
        found,
        best,
        defaults,
    } = fit::run(&open, &super::open_scene, &request, &mut on_progress)?;
    let summary = summary(&found, args, goal, &axes);
    crate::experiment::write(&best, &defaults, &output, true)?;
    comment(&output, &summary, &best, &defaults)?;
    say!("{}", summary.join("\n"));
    say!("wrote {}", super::shown(&output).display());
    say!(
        "all trials: conelab report {}",
        super::shown(&folder).display()
    );
    match found.trial.bounded <= goal.bound() {
        true => Ok(()),
        false => Err(LabError::Request(
            "no setting that was tried is within the bound".into(),
        )),
    }
}

/// The printed result of a search.
fn summary(found: &Found, args: &FitArgs, goal: Goal, axes: &[Axis]) -> Vec<String> {
    let (ms, error) = goal.time_and_error(found.trial);
    let metric = args.metric.axis();
    let bound = match goal {
        Goal::Error(bound) => format!("{metric} at most {bound}"),
        Goal::Time(bound) => format!("at most {bound} ms"),
    };
    let grid = axes.iter().map(|a| a.1.len() as u64).product::<u64>();
    vec![
        format!(
            "{ms:.3} ms, {metric} {error:.4e} of the {} (wanted: {bound})",
            args.part
        ),
        format!(
            "{} of {grid} settings tried; {}",
            found.tried.len(),
            found.stop.text()
        ),
    ]
}

/// Puts lines of comment before an experiment that was just written.
fn comment(
    path: &Path,
    lines: &[String],
    best: &Experiment,
    defaults: &Params,
) -> Result<(), LabError> {
    let text = std::fs::read_to_string(path).map_err(|e| FileError::write(path, e))?;
    let mut out = String::new();
    for line in lines {
        let _ = writeln!(out, "// {line}");
    }
    // Comments of an earlier search about this file say nothing about this one.
    out.extend(
        text.lines()
            .skip_while(|l| l.starts_with("//"))
            .map(|l| format!("{l}\n")),
    );
    let same = Experiment::from_text(path, &out)
        .map_err(LabError::Input)?
        .params_over(defaults)?;
    if same.values != best.params_over(defaults)?.values {
        return Err(FileError::write(path, "it would not read back as it is").into());
    }
    Ok(crate::files::write_whole(path, out.as_bytes())?)
}
