//! Benchmarks: configurations are measured round by round. Drift of clocks, heat and other programs
//! affects all of them alike, and each round compares under equal conditions.

mod against;
mod charts;
mod record;
mod tables;

pub(crate) use against::{Compared, against_text, compare, percent, slower};
pub use against::{Verdict, judge};
pub use record::Record;
pub(crate) use record::{Recorded, check_record, record_file};
pub(crate) use tables::text;

use crate::campaign::points::SweepPoint;
use crate::campaign::record::{json, write_files};
use crate::campaign::runner::{Progress, Runner};
use crate::campaign::sweep::{Sweep, list};
use crate::graph::run::FrameTimes;
use crate::lab::{LabError, ReusableParts, Session};
use crate::measure::{Frames, Timed, timed};
use crate::results::stats::{self, DeviceStats, Spread, Stats, spread};
use indexmap::IndexMap;
use serde::Serialize;
use std::path::Path;

/// Version of the JSON file.
pub(crate) const SCHEMA: &str = "conelab-bench-1";

/// The measurements of a benchmark.
#[derive(Clone, Debug, Serialize)]
pub struct Bench {
    /// `conelab-bench-1`.
    pub schema: String,
    /// The device.
    pub device: DeviceStats,
    /// Number of rounds.
    pub rounds: usize,
    /// Frames of every round. Its warm-up has at least this number.
    pub frames: Frames,
    /// Names of the varied settings, in order.
    pub names: Vec<String>,
    /// The configurations, in order.
    pub configurations: Vec<Configuration>,
}

/// One of the configurations.
#[derive(Clone, Debug, Serialize)]
pub struct Configuration {
    /// Values by the names of the varied settings.
    pub labels: IndexMap<String, String>,
    /// Picture size, pixels.
    pub size: (u32, u32),
    /// Name of its experiment.
    pub experiment: String,
    /// Its experiment with all fields, as text; empty where it is that of a record.
    pub text: String,
    /// Times, `None` if it failed.
    pub times: Option<Times>,
    /// Why it failed.
    pub error: Option<String>,
}

/// Times over all rounds.
#[derive(Clone, Debug, Serialize)]
pub struct Times {
    /// Times of every pass, with settings and memory. The warm-up is the shortest of all rounds.
    pub stats: Stats,
    /// Times of every stage, ms: the sum over its passes, frame by frame.
    pub stages: IndexMap<String, Spread>,
    /// Median of the total in every round, ms.
    pub rounds: Vec<f64>,
    /// Median of every stage in every round, ms.
    pub stage_rounds: IndexMap<String, Vec<f64>>,
}

/// Warm-up on GPUs. Bounces of the graphs here gather more often until frame 77 after a change. A
/// software device would take minutes.
const GPU_WARMUP: usize = 128;
/// Warm-up on software devices.
const CPU_WARMUP: usize = 10;

/// Measures every point of a sweep in each of `rounds` rounds, after this warm-up or the device's
/// default. The points come with it. The texts of experiments are as if they were files of `folder`.
///
/// # Errors
/// Mistakes in points; a scene that is not on this machine.
pub fn of_sweep(
    runner: &mut Runner,
    sweep: &Sweep,
    rounds: usize,
    warmup: Option<usize>,
    folder: &Path,
) -> Result<(Bench, Vec<SweepPoint>), LabError> {
    let software = runner.lab.gpu.info.kind == "cpu";
    let default = if software { CPU_WARMUP } else { GPU_WARMUP };
    let frames = Frames {
        warmup: warmup.unwrap_or(default),
        ..sweep.frames
    };
    let (points, _) = list(runner, sweep, frames)?;
    if let Some(why) = points.iter().find_map(|p| p.absent.clone()) {
        return Err(LabError::Request(why));
    }
    let mut bench = bench(runner, sweep.names.clone(), &points, rounds, frames)?;
    for (configuration, point) in bench.configurations.iter_mut().zip(&points) {
        configuration.text = runner.resolved(&point.experiment, &point.scene, folder)?;
    }
    Ok((bench, points))
}

/// Writes `bench.json`, `bench.csv` and charts to a folder; the number of files.
///
/// # Errors
/// A folder that cannot be written to.
pub fn write(folder: &Path, bench: &Bench) -> Result<usize, LabError> {
    let mut files = vec![
        ("bench.json".to_string(), json(bench)?),
        ("bench.csv".into(), tables::csv(bench)?.into_bytes()),
    ];
    files.extend(
        charts::charts(bench)?
            .into_iter()
            .map(|(name, svg)| (format!("{name}.svg"), svg.into_bytes())),
    );
    write_files(folder, &files)?;
    Ok(files.len())
}

/// Rounds of a configuration so far.
#[derive(Default)]
struct Turns {
    /// Reusable parts of the last session.
    left: Option<ReusableParts>,
    /// Frames of every round.
    rounds: Vec<Vec<FrameTimes>>,
    /// Warm-up frames of the round with the fewest.
    warmup: Option<usize>,
}

/// Measures every configuration in each of `rounds` rounds. Textures are created again for each
/// measurement, because those of all configurations may not fit. Pipelines and scenes are reused.
pub(crate) fn bench(
    runner: &mut Runner,
    names: Vec<String>,
    points: &[SweepPoint],
    rounds: usize,
    frames: Frames,
) -> Result<Bench, LabError> {
    runner.tell(Progress::Begins {
        todo: points.len() * rounds,
        before: 0,
    })?;
    let configuration = |p: &SweepPoint| Configuration {
        labels: p.labels.iter().cloned().collect(),
        size: p.experiment.size,
        experiment: p.experiment.name.clone(),
        text: String::new(),
        times: None,
        error: None,
    };
    let mut configurations: Vec<Configuration> = points.iter().map(configuration).collect();
    let mut turns: Vec<Turns> = points.iter().map(|_| Turns::default()).collect();
    for round in 0..rounds {
        let mut last: Option<ReusableParts> = None;
        for ((point, configuration), turns) in
            points.iter().zip(&mut configurations).zip(&mut turns)
        {
            if configuration.error.is_none() {
                let of = (round == 0, round + 1 == rounds);
                measure(runner, frames, (point, configuration), turns, &mut last, of)?;
            }
            runner.tell(Progress::Finished(String::new(), Vec::new()))?;
        }
    }
    runner.tell(Progress::Ends)?;
    let device = DeviceStats::of(&runner.lab.gpu.info);
    Ok(Bench {
        schema: SCHEMA.into(),
        device,
        rounds,
        frames,
        names,
        configurations,
    })
}

/// Measures a configuration in one round, which is the first or the last one. `last` has reusable
/// parts of the configuration before.
fn measure(
    runner: &mut Runner,
    frames: Frames,
    (point, configuration): (&SweepPoint, &mut Configuration),
    turns: &mut Turns,
    last: &mut Option<ReusableParts>,
    (is_first, is_last): (bool, bool),
) -> Result<(), LabError> {
    let Runner { lab, warm, .. } = runner;
    let loaded = warm.graph(&lab.home, &point.experiment.graph)?;
    let reuse = turns.left.as_ref().or(last.as_ref());
    let (experiment, scene) = (&point.experiment, &point.scene);
    match timed(lab, loaded, experiment, scene, frames, &[], reuse) {
        Ok(Timed {
            mut session,
            times,
            warmup,
        }) => {
            let warmup = turns.warmup.map_or(warmup, |least| least.min(warmup));
            turns.warmup = Some(warmup);
            turns.rounds.push(times);
            if is_last {
                let warnings = session.failed_checks()?;
                let all = turns.rounds.concat();
                let (info, name) = (&lab.gpu.info, &experiment.name);
                let stats = stats::collect(info, name, &session, &all, warmup, warnings);
                configuration.times = Some(times_of(&session, stats, &all, &turns.rounds));
            }
            // The next configuration reuses pipelines and scene.
            *last = is_first.then(|| session.share());
            turns.left = Some(session.share());
        }
        Err(error) => configuration.error = Some(error.to_string()),
    }
    Ok(())
}

/// Statistics over all frames, and the median of each round.
fn times_of(
    session: &Session,
    stats: Stats,
    all: &[FrameTimes],
    rounds: &[Vec<FrameTimes>],
) -> Times {
    let mut stage_rounds: IndexMap<String, Vec<f64>> = IndexMap::new();
    for times in rounds {
        for (stage, spread) in stages(session, times) {
            stage_rounds.entry(stage).or_default().push(spread.median);
        }
    }
    let total = |times: &Vec<FrameTimes>| spread(times.iter().map(|t| t.gpu_ms).collect()).median;
    Times {
        stats,
        stages: stages(session, all),
        rounds: rounds.iter().map(total).collect(),
        stage_rounds,
    }
}

/// Times of the stages, in the order of the graph.
fn stages(session: &Session, times: &[FrameTimes]) -> IndexMap<String, Spread> {
    let mut all: IndexMap<String, Vec<f64>> = IndexMap::new();
    for (frame, time) in times.iter().enumerate() {
        for (number, ms) in &time.passes {
            let values = all
                .entry(session.graph.passes[*number].value.stage().to_string())
                .or_default();
            values.resize(frame + 1, 0.0);
            values[frame] += ms;
        }
    }
    all.into_iter()
        .map(|(stage, values)| (stage, spread(values)))
        .collect()
}
