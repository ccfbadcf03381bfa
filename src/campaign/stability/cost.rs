//! Costs of methods: GPU time and memory of frames that compute only the picture. Methods are timed
//! in several rounds, so that drifting clocks affect all of them alike.
//!
//! Methods that have to match the first one's time are timed at values of a parameter. The values
//! must be in the order of their costs. Bisection finds the two that enclose the first method's
//! time, and the nearer one is chosen.

use super::case::Method;
use super::chart_spec::CostChart;
use super::file::Suite;
use super::plan::{Job, Options, plan};
use super::record::{Candidate, Cost};
use super::sequence::{cell_of, place};
use crate::campaign::record::{first_line, json, read_json, write_file};
use crate::campaign::runner::{Progress, Runner};
use crate::lab::LabError;
use crate::measure::{WarmUp, oracle};
use crate::metrics::median;
use crate::vulkan::VulkanError;
use serde::{Deserialize, Serialize};
use std::path::Path;

const ROUNDS: usize = 3;
/// Least number of warm-up frames in each round.
const WARMUP: usize = 4;
/// Timed frames in each round.
const FRAMES: i64 = 12;
/// Version of `cost.json`.
const SCHEMA: &str = "conelab-stability-cost-1";
/// Largest `cost.json` that is read, bytes.
const MAX_FILE: u64 = 16 << 20;

/// `cost.json`.
#[derive(Serialize, Deserialize)]
struct Kept {
    schema: String,
    costs: Vec<Cost>,
}

/// Costs of all charted methods. Entries of the folder's `cost.json` are reused, so that a
/// continued suite keeps its choice.
pub(super) fn costs(
    runner: &mut Runner,
    suite: &Suite,
    chart: &CostChart,
    options: &Options,
) -> Result<Vec<Cost>, LabError> {
    let charted = |m: &&Method| chart.groups.0.iter().any(|g| g.1.value.contains(&m.name));
    let (first, others) = suite.methods.split_at(suite.methods.len().min(1));
    let names: Vec<&Method> = first.iter().chain(others.iter().filter(charted)).collect();
    let jobs = candidate_jobs(runner, suite, chart, &names, options)?;
    let first = jobs
        .first()
        .ok_or_else(|| LabError::Request("a chart needs a method and a case".into()))?;
    let path = options.folder.join("cost.json");
    let kept = read(&path);
    let mut costs: Vec<Cost> = Vec::new();
    let mut todo: Vec<Open> = Vec::new();
    for method in &names {
        let own = jobs.iter().filter(|j| j.method == method.name);
        let cost = untimed(chart, method, own.clone(), first);
        match kept.iter().find(|k| same(k, &cost)) {
            Some(kept) => costs.push(kept.clone()),
            None => {
                todo.extend(own.enumerate().map(|(i, job)| (costs.len(), i, job)));
                costs.push(cost);
            }
        }
    }
    if todo.is_empty() {
        return Ok(costs);
    }
    let of = ROUNDS * todo.len();
    let todo = between(&todo, &mut |job| {
        told(runner, job, 0, of)?;
        Ok((time(runner, job), time(runner, first)?.0))
    })?;
    time_all(runner, first, &todo, &mut costs)?;
    for cost in costs.iter_mut().filter(|c| c.chosen.is_none()) {
        choose(cost)?;
    }
    runner.warm.sessions.clear();
    write_file(
        &path,
        &json(&Kept {
            schema: SCHEMA.into(),
            costs: costs.clone(),
        })?,
    )?;
    // Reads the file back, so that numbers are those of the next run.
    Ok(Some(read(&path))
        .filter(|k| k.len() == costs.len())
        .unwrap_or(costs))
}

/// The jobs of all candidates in one case, in order.
fn candidate_jobs(
    runner: &mut Runner,
    suite: &Suite,
    chart: &CostChart,
    methods: &[&Method],
    options: &Options,
) -> Result<Vec<Job>, LabError> {
    // Its plan checks every value and computes every identifier.
    let timed = Suite {
        methods: methods.iter().flat_map(|m| chart.variants(m)).collect(),
        cases: suite
            .cases
            .iter()
            .find(|c| chart.motions.first() == Some(&c.name))
            .cloned()
            .into_iter()
            .collect(),
        ..suite.clone()
    };
    let options = Options {
        only: Vec::new(),
        ..options.clone()
    };
    plan(runner, &timed, &options)
}

/// The cost of a method before it is timed.
fn untimed<'j>(
    chart: &CostChart,
    method: &Method,
    jobs: impl Iterator<Item = &'j Job>,
    first: &Job,
) -> Cost {
    let settings = chart.varied(&method.name);
    let texts = settings
        .iter()
        .map(|s| s.text.clone())
        .chain(settings.is_empty().then(String::new));
    Cost {
        method: method.name.clone(),
        parameter: settings
            .first()
            .map_or(String::new(), |s| s.name.value.clone()),
        first: first.work.clone(),
        candidates: jobs
            .zip(texts)
            .map(|(j, value)| Candidate {
                value,
                work: j.work.clone(),
                ..Candidate::default()
            })
            .collect(),
        chosen: None,
    }
}

/// Times open candidates in all rounds.
fn time_all(
    runner: &mut Runner,
    first: &Job,
    todo: &[Open],
    costs: &mut [Cost],
) -> Result<(), LabError> {
    let of = ROUNDS * todo.len();
    for round in 0..ROUNDS {
        // The first method is timed again before each method, so that both times are close
        // together.
        let mut before = None;
        let mut first_cost = (0.0, 0);
        for (i, (cost, candidate, job)) in todo.iter().enumerate() {
            if before != Some(*cost) {
                before = Some(*cost);
                first_cost = time(runner, first)?;
            }
            let candidate = &mut costs[*cost].candidates[*candidate];
            if candidate.failed.is_some() {
                continue;
            }
            told(runner, job, round * todo.len() + i, of)?;
            let cost = if job.work == first.work {
                Ok(first_cost)
            } else {
                time(runner, job)
            };
            match cost {
                Ok((ms, bytes)) => {
                    candidate.ms.push(ms);
                    candidate.first_ms.push(first_cost.0);
                    candidate.memory_bytes = bytes;
                }
                Err(lost @ LabError::Vulkan(VulkanError::Lost(_))) => return Err(lost),
                Err(error) => {
                    candidate.failed = Some(first_line(&error.to_string()).to_string());
                    candidate.ms.clear();
                    candidate.first_ms.clear();
                }
            }
        }
    }
    Ok(())
}

/// A candidate without a time: index of its method, index among the candidates of the method, and
/// its job.
type Open<'j> = (usize, usize, &'j Job);

/// Median of a job's frames, ms, and the bytes of its resources.
type Timed = Result<(f64, u64), LabError>;

/// Median and bytes of a candidate, then the first method's time, ms.
type CandidateTime = Result<(Timed, f64), LabError>;

/// The two neighbouring candidates of each method that enclose the first method's time; all if
/// there are at most two. `times` returns the time of a candidate, then that of the first method. A
/// candidate that fails counts as too slow.
fn between<'j>(
    todo: &[Open<'j>],
    times: &mut dyn FnMut(&Job) -> CandidateTime,
) -> Result<Vec<Open<'j>>, LabError> {
    let mut left = Vec::new();
    for own in todo.chunk_by(|a, b| a.0 == b.0) {
        let (mut low, mut high) = (0, own.len() - 1);
        while high - low > 1 {
            let middle = (low + high) / 2;
            match times(own[middle].2)? {
                (Err(lost @ LabError::Vulkan(VulkanError::Lost(_))), _) => return Err(lost),
                (Ok((ms, _)), first) if ms < first => low = middle,
                _ => high = middle,
            }
        }
        left.extend(&own[low..=high]);
    }
    Ok(left)
}

/// Whether a stored cost has the same candidates.
fn same(kept: &Cost, wanted: &Cost) -> bool {
    let list = |c: &Cost| {
        c.candidates
            .iter()
            .map(|c| (c.value.clone(), c.work.clone()))
            .collect::<Vec<_>>()
    };
    let head = |c: &Cost| (c.method.clone(), c.parameter.clone(), c.first.clone());
    kept.taken().is_some_and(|c| c.ratio().is_some())
        && head(kept) == head(wanted)
        && list(kept) == list(wanted)
}

fn told(runner: &mut Runner, job: &Job, done: usize, of: usize) -> Result<(), LabError> {
    runner.tell(Progress::Runs(format!(
        "timing {}, {done} of {of}",
        job.method
    )))
}

/// Stored costs. The folder is not trusted, so invalid files are ignored.
fn read(path: &Path) -> Vec<Cost> {
    let kept = read_json::<Kept>(path, MAX_FILE)
        .ok()
        .filter(|k| k.schema == SCHEMA);
    kept.map_or(Vec::new(), |k| k.costs)
}

/// Chooses the candidate with the time nearest to the first method's. A method without a parameter
/// may fail.
fn choose(cost: &mut Cost) -> Result<(), LabError> {
    let far = |c: &Candidate| c.ratio().map(|r| r.ln().abs());
    let timed = cost
        .candidates
        .iter()
        .enumerate()
        .filter_map(|(i, c)| Some((i, far(c)?)));
    cost.chosen = timed.min_by(|a, b| a.1.total_cmp(&b.1)).map(|c| c.0);
    if cost.chosen.is_some() || cost.parameter.is_empty() {
        return Ok(());
    }
    let mut failed = cost.candidates.iter().filter_map(|c| c.failed.as_deref());
    let why = failed.next().unwrap_or("it takes no time at all");
    Err(LabError::Request(format!(
        "'{}' could be timed at no {}: {why}",
        cost.method, cost.parameter
    )))
}

/// The suite with the chosen values.
pub(super) fn chosen(suite: &Suite, chart: &CostChart, costs: &[Cost]) -> Suite {
    let mut suite = suite.clone();
    for method in &mut suite.methods {
        let cost = costs.iter().find(|c| c.method == method.name);
        method
            .set
            .extend(cost.and_then(|c| chart.varied(&method.name).into_iter().nth(c.chosen?)));
    }
    suite
}

/// Times a job in a new session, so that only one is in memory.
fn time(runner: &mut Runner, job: &Job) -> Timed {
    let Runner { lab, warm, .. } = runner;
    let loaded = warm.graph(&lab.home, &job.experiment.graph)?.clone();
    let mut wanted: Vec<String> = loaded
        .graph
        .output
        .iter()
        .chain(&loaded.graph.hdr)
        .take(1)
        .cloned()
        .collect();
    if job.case.motion.in_voxels() {
        wanted.extend(oracle::wanted(&loaded.graph)?);
    }
    let mut session = lab.build(
        &job.experiment,
        &loaded,
        job.scene.clone(),
        wanted,
        warm.sessions.get(&job.method),
    )?;
    let cell = cell_of(&mut session, job)?;
    let mut lights = job.scene.lights.clone();
    // Sessions are built between frames, and an idle GPU falls to a low clock, so a warm-up
    // follows.
    place(lab, &mut session, job, -1, cell, &mut lights)?;
    let warm_up = WarmUp::of(&lab.gpu.info, WARMUP);
    warm_up.run(&mut || Ok::<_, LabError>(session.frame(0.0)?.map_or(0.0, |t| t.gpu_ms)))?;
    let mut times = Vec::new();
    for number in 0..FRAMES {
        place(lab, &mut session, job, number, cell, &mut lights)?;
        times.extend(session.frame(job.case.motion.delta())?);
    }
    times.extend(session.finish()?);
    let frames = times.split_off(times.len().saturating_sub(FRAMES as usize));
    let sums = frames
        .iter()
        .map(|t| t.passes.iter().map(|p| p.1).sum())
        .collect();
    let bytes = session
        .program
        .memory(&session.graph)
        .iter()
        .map(|m| m.1)
        .sum();
    warm.sessions.insert(job.method.clone(), session.share());
    Ok((median(sums), bytes))
}
