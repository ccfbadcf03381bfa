//! Benchmarks: configurations measured in turn, round after round, so that what drifts (clocks, heat, other programs)
//! meets all of them alike, and each round compares like with like.

mod against;
mod charts;
mod record;
mod tables;

pub use against::{Compared, FLOOR_MS, Row, Verdict, against_text, compare, judge, percent, slower};
pub use charts::charts;
pub use record::{RECORD_SCHEMA, Record, Recorded, check_record, record_file};
pub use tables::{csv, text};

use crate::campaign::points::SweepPoint;
use crate::graph::run::FrameTimes;
use crate::lab::{Lab, LabError, ReusableParts, Session};
use crate::measure::{Frames, Timed, Warm, timed};
use crate::results::stats::{self, DeviceStats, Spread, Stats, spread};
use indexmap::IndexMap;
use serde::Serialize;

/// Version of the JSON file.
pub const SCHEMA: &str = "conelab-bench-1";

/// The measurements of a benchmark.
#[derive(Clone, Debug, Serialize)]
pub struct Bench {
    /// [`SCHEMA`].
    pub schema: String,
    /// The device.
    pub device: DeviceStats,
    /// How often every configuration had its turn.
    pub rounds: usize,
    /// Frames of every turn; those of its warm-up at least.
    pub frames: Frames,
    /// Names of what differs, in order.
    pub names: Vec<String>,
    /// In order.
    pub configurations: Vec<Configuration>,
}

/// One of the configurations.
#[derive(Clone, Debug, Serialize)]
pub struct Configuration {
    /// Its values, by the names of what differs.
    pub labels: IndexMap<String, String>,
    /// Its picture, pixels.
    pub size: (u32, u32),
    /// Name of its experiment.
    pub experiment: String,
    /// Its times; absent where it failed.
    pub times: Option<Times>,
    /// Why it failed.
    pub error: Option<String>,
}

/// Times over all rounds.
#[derive(Clone, Debug, Serialize)]
pub struct Times {
    /// Times of every pass, with settings and memory; the warm-up is that of the round with the shortest.
    pub stats: Stats,
    /// Times of every stage (passes that the graph counts together, added up frame by frame), ms.
    pub stages: IndexMap<String, Spread>,
    /// Median of the total in every round, ms: pairs with those of other configurations.
    pub rounds: Vec<f64>,
    /// Median of every stage in every round, ms.
    pub stage_rounds: IndexMap<String, Vec<f64>>,
}

/// What a configuration has gathered so far.
#[derive(Default)]
struct Gathered {
    reuse: Option<ReusableParts>,
    /// Frames of every round.
    rounds: Vec<Vec<FrameTimes>>,
    /// Frames before those measured, in the round with the fewest.
    warmup: Option<usize>,
    result: Option<Result<Times, String>>,
}

/// Measures every configuration `rounds` times in turn. `tick` is called after every turn. Textures are made anew for
/// each turn, as all of them together might not fit; pipelines and scenes are kept.
///
/// # Errors
/// A graph that cannot be read. A configuration that fails is left out of the rounds that follow, with its error.
pub fn bench(
    lab: &Lab,
    warm: &mut Warm,
    names: Vec<String>,
    points: &[SweepPoint],
    rounds: usize,
    frames: Frames,
    tick: &dyn Fn(),
) -> Result<Bench, LabError> {
    let mut all: Vec<Gathered> = points.iter().map(|_| Gathered::default()).collect();
    for round in 0..rounds {
        let mut last: Option<ReusableParts> = None;
        for (point, gathered) in points.iter().zip(&mut all) {
            let failed_before = matches!(gathered.result, Some(Err(_)));
            if !failed_before {
                let loaded = warm.graph(&lab.home, &point.experiment.graph)?;
                let reuse = gathered.reuse.as_ref().or(last.as_ref());
                match timed(lab, loaded, &point.experiment, &point.scene, frames, &[], reuse) {
                    Ok(Timed { mut session, times, warmup }) => {
                        gathered.warmup = gathered.warmup.map_or(Some(warmup), |least| Some(least.min(warmup)));
                        gathered.rounds.push(times);
                        if round + 1 == rounds {
                            let warnings = session.failed_checks()?;
                            let all = gathered.rounds.concat();
                            let name = &point.experiment.name;
                            let warmup = gathered.warmup.unwrap_or(warmup);
                            let stats = stats::collect(&lab.gpu.info, name, &session, &all, warmup, warnings);
                            gathered.result = Some(Ok(times_of(&session, stats, &all, &gathered.rounds)));
                        }
                        // The next configuration's first turn starts from this one's pipelines and scene.
                        last = (round == 0).then(|| session.share());
                        gathered.reuse = Some(session.share());
                    }
                    Err(error) => gathered.result = Some(Err(error.to_string())),
                }
            }
            tick();
        }
    }
    let configurations = points.iter().zip(all).map(|(point, gathered)| {
        let (times, error) = match gathered.result {
            Some(Ok(times)) => (Some(times), None),
            Some(Err(error)) => (None, Some(error)),
            None => (None, None),
        };
        let experiment = &point.experiment;
        let labels = point.labels.iter().cloned().collect();
        Configuration { labels, size: experiment.size, experiment: experiment.name.clone(), times, error }
    });
    Ok(Bench {
        schema: SCHEMA.into(),
        device: DeviceStats::of(&lab.gpu.info),
        rounds,
        frames,
        names,
        configurations: configurations.collect(),
    })
}

/// What the frames of all rounds, and of each, say.
fn times_of(session: &Session, stats: Stats, all: &[FrameTimes], rounds: &[Vec<FrameTimes>]) -> Times {
    let mut stage_rounds: IndexMap<String, Vec<f64>> = IndexMap::new();
    for times in rounds {
        for (stage, spread) in stages(session, times) {
            stage_rounds.entry(stage).or_default().push(spread.median);
        }
    }
    let total = |times: &Vec<FrameTimes>| spread(times.iter().map(|t| t.gpu_ms).collect()).median;
    Times { stats, stages: stages(session, all), rounds: rounds.iter().map(total).collect(), stage_rounds }
}

/// Times of the stages, in the order of the graph.
fn stages(session: &Session, times: &[FrameTimes]) -> IndexMap<String, Spread> {
    let mut all: IndexMap<String, Vec<f64>> = IndexMap::new();
    for (frame, time) in times.iter().enumerate() {
        for (number, ms) in &time.passes {
            let values = all.entry(session.graph.passes[*number].value.stage().to_string()).or_default();
            values.resize(frame + 1, 0.0);
            values[frame] += ms;
        }
    }
    all.into_iter().map(|(stage, values)| (stage, spread(values))).collect()
}
