//! Campaigns: sweeps, benchmarks, searches, suites of stability. Each runs on the lab's device; a lost device is opened
//! again, and finished points are in their folder.

use crate::errors::{exception, raised};
use crate::experiment::{Experiment, settled};
use crate::lab::{Lab, open_scene};
use crate::progress::Reporter;
use conelab::campaign::bench::{of_sweep, write};
use conelab::campaign::fit;
use conelab::campaign::runner::{Counts, OnProgress, Runner};
use conelab::campaign::stability::{self, Suite};
use conelab::campaign::sweep::{self, Shard, Sweep};
use conelab::diagnostics::SETTINGS;
use conelab::experiment::Experiment as Setup;
use conelab::lab::{Lab as Opened, LabError};
use conelab::measure::Frames;
use conelab::measure::reference::{ALL_BOUNCES, Goal};
use conelab::metrics::Metric;
use pyo3::Bound;
use pyo3::prelude::{FromPyObject, Py, PyAny, PyRef, PyResult, Python, pyfunction};
use std::cell::Cell;
use std::path::{Path, PathBuf};

/// An experiment: open, or its file.
#[derive(FromPyObject)]
pub enum Which<'py> {
    Open(PyRef<'py, Experiment>),
    File(PathBuf),
}

/// Settings as RON.
type Settings = Vec<(String, String)>;
/// Varied settings with their values as RON.
type Axes = Vec<(String, Vec<String>)>;

fn setups(which: Vec<Which<'_>>, settings: &Settings) -> PyResult<Vec<Setup>> {
    let read = |which| {
        let setup = match which {
            Which::Open(open) => open.setup()?,
            Which::File(file) => {
                Setup::read(&file).map_err(|list| exception(LabError::Input(list)))?
            }
        };
        settled(&setup, settings, Path::new(".")).map_err(exception)
    };
    which.into_iter().map(read).collect()
}

/// What a campaign opens devices with.
type Open<'a> = &'a dyn Fn() -> Result<Opened, LabError>;

/// Runs a campaign on the lab's device, without the GIL.
fn run<T: Send>(
    py: Python<'_>,
    lab: &Lab,
    progress: Option<Bound<'_, PyAny>>,
    work: impl FnOnce(Open, &mut OnProgress<'_>) -> Result<T, LabError> + Send,
) -> PyResult<T> {
    let first = lab.opened()?;
    let (home, options) = lab.options()?;
    let mut reporter = Reporter::new(progress);
    let gpu = first.clone();
    let (result, again) = py.detach(|| {
        let first = Cell::new(Some(first));
        let opened = Cell::new(0);
        let open = || {
            opened.set(opened.get() + 1);
            first
                .take()
                .map_or_else(|| Opened::open(home.clone(), options.clone()), Ok)
        };
        let result = work(&open, &mut |step| reporter.step(step));
        (result, opened.get() > 1)
    });
    if again {
        lab.lost()?;
    }
    let result = lab.done(&gpu, result);
    reporter.end(result)
}

fn frames(count: Option<usize>, warmup: Option<usize>, before: Frames) -> PyResult<Frames> {
    let frames = Frames {
        warmup: warmup.unwrap_or(before.warmup),
        count: count.unwrap_or(before.count),
    };
    match frames.count {
        0 => Err(raised("RequestError", "frames must be 1 or more")),
        _ => Ok(frames),
    }
}

/// Measures the points of a sweep: of its file, or of experiments with axes. Numbers of points that are done and failed.
#[pyfunction]
#[pyo3(signature = (lab, file, experiments, settings, axes, frames_, warmup, reference, folder, again, progress))]
#[expect(clippy::too_many_arguments, reason = "the options of a sweep")]
pub fn run_sweep(
    py: Python<'_>,
    lab: Py<Lab>,
    file: Option<PathBuf>,
    experiments: Vec<Which<'_>>,
    settings: Settings,
    axes: Axes,
    frames_: Option<usize>,
    warmup: Option<usize>,
    reference: Option<&str>,
    folder: PathBuf,
    again: bool,
    progress: Option<Bound<'_, PyAny>>,
) -> PyResult<(usize, usize)> {
    let sweep = match file {
        Some(file) => Sweep::read(&file).map_err(LabError::Input),
        None => Sweep::of(
            setups(experiments, &settings)?,
            &axes,
            sweep::DEFAULT_FRAMES,
            SETTINGS,
        ),
    };
    let sweep = sweep.map_err(exception)?;
    let goal = reference.map(str::parse::<Goal>).transpose();
    let options = sweep::Options {
        folder,
        shard: Shard::ALL,
        frames: frames(frames_, warmup, sweep.frames)?,
        again,
        goal: goal.map_err(|why| raised("RequestError", format!("reference: {why}")))?,
    };
    let Counts { done, failed } = run(py, lab.get(), progress, |open, on_progress| {
        sweep::run(open, &open_scene, &sweep, &options, on_progress)
    })?;
    Ok((done, failed))
}

/// Times experiments with axes round by round; writes `bench.json`, `bench.csv` and charts to a folder.
#[pyfunction]
#[pyo3(signature = (lab, experiments, settings, axes, rounds, frames_, warmup, folder, progress))]
#[expect(clippy::too_many_arguments, reason = "the options of a benchmark")]
pub fn run_bench(
    py: Python<'_>,
    lab: Py<Lab>,
    experiments: Vec<Which<'_>>,
    settings: Settings,
    axes: Axes,
    rounds: usize,
    frames_: usize,
    warmup: Option<usize>,
    folder: PathBuf,
    progress: Option<Bound<'_, PyAny>>,
) -> PyResult<()> {
    if rounds == 0 || frames_ == 0 {
        return Err(raised(
            "RequestError",
            "rounds and frames must be 1 or more",
        ));
    }
    let before = Frames {
        warmup: warmup.unwrap_or(0),
        count: frames_,
    };
    let sweep =
        Sweep::of(setups(experiments, &settings)?, &axes, before, SETTINGS).map_err(exception)?;
    run(py, lab.get(), progress, |open, on_progress| {
        let mut runner = Runner::open(open, &open_scene, on_progress)?;
        let bench = of_sweep(&mut runner, &sweep, rounds, warmup, &folder)?.0;
        write(&folder, &bench).map(drop)
    })
}

/// Searches the cheapest setting within a bound. Writes the experiment found to `output`, and all trials to the folder of
/// that name. Time (ms), error, number of trials, why it stopped, and whether the bound is met.
#[pyfunction]
#[pyo3(signature = (lab, experiment, settings, axes, max_error, max_ms, part, metric, evaluations, frames_, warmup, bounces, spp, output, progress))]
#[expect(clippy::too_many_arguments, reason = "the options of a search")]
pub fn run_fit(
    py: Python<'_>,
    lab: Py<Lab>,
    experiment: Which<'_>,
    settings: Settings,
    axes: Axes,
    max_error: Option<f64>,
    max_ms: Option<f64>,
    part: &str,
    metric: &str,
    evaluations: usize,
    frames_: usize,
    warmup: usize,
    bounces: Option<u32>,
    spp: u64,
    output: PathBuf,
    progress: Option<Bound<'_, PyAny>>,
) -> PyResult<(f64, f64, usize, &'static str, bool)> {
    let metric = Metric::of(metric)
        .ok_or_else(|| raised("RequestError", format!("no metric '{metric}'")))?;
    let goal = match (max_error, max_ms) {
        (Some(bound), None) => fit::Goal::Error(bound),
        (None, Some(bound)) => fit::Goal::Time(bound),
        _ => return Err(raised("RequestError", "give max_error or max_ms")),
    };
    if !(goal.bound() > 0.0 && goal.bound().is_finite()) || evaluations == 0 || frames_ == 0 {
        return Err(raised(
            "RequestError",
            "the bound, evaluations and frames must be above 0",
        ));
    }
    let setup = setups(vec![experiment], &settings)?.remove(0);
    let opened = lab.get().opened()?;
    let graph = opened
        .home
        .load_of(&setup)
        .map_err(|list| exception(LabError::Input(list)))?
        .graph;
    let axes = fit::axes(&graph, &axes).map_err(exception)?;
    let request = fit::Request {
        experiment: &setup,
        axes: &axes,
        goal,
        part,
        metric,
        evaluations,
        least_gain: fit::LEAST_GAIN,
        frames: Frames {
            warmup,
            count: frames_,
        },
        bounces: bounces.unwrap_or(ALL_BOUNCES),
        samples: spp,
        folder: output.with_extension(""),
    };
    let fitted = run(py, lab.get(), progress, |open, on_progress| {
        let fitted = fit::run(open, &open_scene, &request, on_progress)?;
        conelab::experiment::write(&fitted.best, &fitted.defaults, &output, true)?;
        Ok(fitted)
    })?;
    let found = &fitted.found;
    let (ms, error) = goal.time_and_error(found.trial);
    let within = found.trial.bounded <= goal.bound();
    Ok((ms, error, found.tried.len(), found.stop.text(), within))
}

/// Runs a suite of stability into a folder. Numbers of methods in cases that are done and failed.
#[pyfunction]
#[pyo3(signature = (lab, file, settings, size, frames_, spp, references, only, methods, folder, progress))]
#[expect(clippy::too_many_arguments, reason = "the options of a suite")]
pub fn run_stability(
    py: Python<'_>,
    lab: Py<Lab>,
    file: PathBuf,
    settings: Vec<String>,
    size: Option<(u32, u32)>,
    frames_: Option<usize>,
    spp: Option<u64>,
    references: bool,
    only: Vec<String>,
    methods: Vec<String>,
    folder: PathBuf,
    progress: Option<Bound<'_, PyAny>>,
) -> PyResult<(usize, usize)> {
    let suite = Suite::read(&file).map_err(LabError::Input);
    let mut suite = suite.map_err(exception)?;
    if !methods.is_empty() {
        suite
            .keep(&methods)
            .map_err(|why| raised("RequestError", why))?;
    }
    let options = stability::Options {
        folder,
        size,
        set: settings,
        frames: frames_,
        samples: spp,
        reference: references,
        only,
    };
    let counts = run(py, lab.get(), progress, |open, on_progress| {
        Ok(stability::run(open, &open_scene, &suite, &options, on_progress)?.0)
    })?;
    Ok((counts.done, counts.failed))
}
