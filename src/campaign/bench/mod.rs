//! Benchmarks: configurations measured in turn, round after round, so that what drifts (clocks, heat, other programs)
//! meets all of them alike, and each round compares like with like.

mod against;
mod charts;
mod record;
mod tables;

pub use against::{
    Compared, FLOOR_MS, Row, Verdict, against_text, compare, judge, percent, slower,
};
pub use charts::charts;
pub use record::{RECORD_SCHEMA, Record, Recorded, check_record, record_file};
pub use tables::{csv, text};

use crate::campaign::points::SweepPoint;
use crate::campaign::runner::{Progress, Runner};
use crate::graph::run::FrameTimes;
use crate::lab::{LabError, ReusableParts, Session};
use crate::measure::{Frames, Timed, timed};
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

/// The turns that a configuration has had.
#[derive(Default)]
struct Turns {
    /// What its last one has left.
    left: Option<ReusableParts>,
    /// Frames of every round.
    rounds: Vec<Vec<FrameTimes>>,
    /// Frames before those measured, in the round with the fewest.
    warmup: Option<usize>,
}

/// Measures every configuration `rounds` times in turn. Textures are made anew for each turn, as all of them together
/// might not fit; pipelines and scenes are kept.
///
/// # Errors
/// A graph that cannot be read. A configuration that fails is left out of the rounds that follow, with its error.
pub fn bench(
    runner: &mut Runner,
    names: Vec<String>,
    points: &[SweepPoint],
    rounds: usize,
    frames: Frames,
) -> Result<Bench, LabError> {
    runner.tell(Progress::Begins {
        todo: points.len() * rounds,
        before: 0,
    });
    let configuration = |p: &SweepPoint| Configuration {
        labels: p.labels.iter().cloned().collect(),
        size: p.experiment.size,
        experiment: p.experiment.name.clone(),
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
                let Runner { lab, warm, .. } = &mut *runner;
                let loaded = warm.graph(&lab.home, &point.experiment.graph)?;
                let reuse = turns.left.as_ref().or(last.as_ref());
                match timed(
                    lab,
                    loaded,
                    &point.experiment,
                    &point.scene,
                    frames,
                    &[],
                    reuse,
                ) {
                    Ok(Timed {
                        mut session,
                        times,
                        warmup,
                    }) => {
                        let warmup = turns.warmup.map_or(warmup, |least| least.min(warmup));
                        turns.warmup = Some(warmup);
                        turns.rounds.push(times);
                        if round + 1 == rounds {
                            let warnings = session.failed_checks()?;
                            let all = turns.rounds.concat();
                            let name = &point.experiment.name;
                            let stats = stats::collect(
                                &lab.gpu.info,
                                name,
                                &session,
                                &all,
                                warmup,
                                warnings,
                            );
                            configuration.times =
                                Some(times_of(&session, stats, &all, &turns.rounds));
                        }
                        // The next configuration's first turn starts from this one's pipelines and scene.
                        last = (round == 0).then(|| session.share());
                        turns.left = Some(session.share());
                    }
                    Err(error) => configuration.error = Some(error.to_string()),
                }
            }
            runner.tell(Progress::Finished(String::new(), Vec::new()));
        }
    }
    runner.tell(Progress::Ends);
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

/// What the frames of all rounds, and of each, say.
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
