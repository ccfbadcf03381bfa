//! Which option of a choice is fastest on a device. It is measured once, where a choice is `auto`,
//! and kept in the cache folder for the device, its driver and its features.

use super::{Lab, LabError, Loaded, Session};
use crate::experiment::Experiment;
use crate::files::{read_input, write_whole};
use crate::graph::Graph;
use crate::graph::expr::Var;
use crate::graph::param::{Param, Params, Value, fastest_key};
use crate::graph::run::FrameTimes;
use crate::metrics::percentile;
use crate::scene::Scene;
use crate::vulkan::DeviceInfo;
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Milliseconds on the GPU by option, by choice. A choice that could not be measured has none.
pub type Measured = BTreeMap<String, BTreeMap<String, f64>>;

/// Measurements of each device, by [`DeviceInfo::key`].
static KNOWN: Mutex<BTreeMap<String, Measured>> = Mutex::new(BTreeMap::new());

/// Frames before those that count, and the frames that count; fewer, but one or more, on devices
/// that do not draw them in this time.
const WARMUP: usize = 8;
const FRAMES: usize = 16;
const PATIENCE: Duration = Duration::from_millis(250);

/// The scene and the size that are measured.
const SCENE: &str = "atrium";
const SIZE: &str = "(1920, 1080)";

/// Measurements of a device that this run of the program knows.
fn measured(device: &DeviceInfo) -> Measured {
    let known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    known.get(&device.key()).cloned().unwrap_or_default()
}

/// The same, with those that earlier runs left in the cache folder.
pub fn recalled(device: &DeviceInfo, cache: Option<&Path>) -> Measured {
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    let read = || {
        cache
            .and_then(|folder| read(&file(folder, device)))
            .unwrap_or_default()
    };
    known.entry(device.key()).or_insert_with(read).clone()
}

/// The option with the shortest time.
pub fn fastest(times: &BTreeMap<String, f64>) -> Option<&str> {
    let least = times.iter().min_by(|a, b| a.1.total_cmp(b.1));
    least.map(|(option, _)| option.as_str())
}

/// Variables of expressions that say which options are fastest on a device.
pub(super) fn variables(device: &DeviceInfo) -> impl Iterator<Item = (String, Var)> {
    measured(device).into_iter().filter_map(|(choice, times)| {
        Some((fastest_key(&choice, fastest(&times)?), Var::Bool(true)))
    })
}

fn file(cache: &Path, device: &DeviceInfo) -> PathBuf {
    let version = env!("CARGO_PKG_VERSION");
    cache.join(format!("fastest-{version}-{}.json", device.key()))
}

/// Nothing for a file that does not hold times.
fn read(path: &Path) -> Option<Measured> {
    let read: Measured = serde_json::from_slice(&read_input(path, 1 << 20).ok()?).ok()?;
    let is_time = |ms: &f64| ms.is_finite() && *ms >= 0.0;
    let all = read.values().flat_map(BTreeMap::values).all(is_time);
    all.then_some(read)
}

impl Lab {
    /// Measures the choices of a graph, if one that is `auto` was not measured on this device.
    /// Software devices are measured on request only: there frames take seconds.
    pub(super) fn find_fastest(&self, experiment: &Experiment, loaded: &Loaded, params: &Params) {
        let info = &self.gpu.info;
        let known = recalled(info, self.home.cache.as_deref());
        let is_open = |(param, value): (&Param, &Value)| {
            param.is_auto(value) && !known.contains_key(&param.name)
        };
        let is_needed = params.list.iter().zip(&params.values).any(is_open);
        if !is_needed || info.kind == "cpu" || info.timestamp_ns == 0.0 {
            return;
        }
        let found =
            opened().and_then(|scene| self.measure_fastest(&experiment.graph, loaded, &scene));
        match found {
            Ok(found) => self.keep(found),
            // Options for unmeasured devices, in this run.
            Err(_) => {
                let none = |choice: &Param| (choice.name.clone(), BTreeMap::new());
                let mut all = known;
                all.extend(choices(&params.list).into_iter().map(none));
                know(info, all);
            }
        }
    }

    /// Measures the choices of a graph, whether they are known or not, and keeps the times.
    ///
    /// # Errors
    /// The graph cannot be run in the scene of the measurement with any option.
    pub fn measure(&self, graph: &str) -> Result<Measured, LabError> {
        let (experiment, scene) = (subject(graph)?, opened()?);
        let loaded = self.home.load_for(&experiment, &scene, &self.gpu.info);
        let loaded = loaded.map_err(LabError::Input)?;
        let found = self.measure_fastest(graph, &loaded, &scene)?;
        self.keep(found.clone());
        Ok(found)
    }

    /// Adds measurements to the known ones. A cache folder that cannot be written costs a
    /// measurement in each run of the program, and nothing else.
    fn keep(&self, new: Measured) {
        let (info, cache) = (&self.gpu.info, self.home.cache.as_deref());
        let mut all = recalled(info, cache);
        all.extend(new);
        if let (Some(cache), Ok(bytes)) = (cache, serde_json::to_vec_pretty(&all)) {
            drop(write_whole(&file(cache, info), &bytes));
        }
        know(info, all);
    }

    /// Runs all choices with their first options, then all with their second ones, and so on:
    /// stages do not depend on one another's rasteriser.
    fn measure_fastest(
        &self,
        graph: &str,
        loaded: &Loaded,
        scene: &Arc<Scene>,
    ) -> Result<Measured, LabError> {
        let choices = choices(&loaded.graph.params.list);
        let ranks = choices
            .iter()
            .filter_map(|c| Some(c.fastest.as_ref()?.of.len()));
        let (mut found, mut failed, mut reuse) = (Measured::new(), None, None);
        for rank in 0..ranks.max().unwrap_or(0) {
            let mut experiment = subject(graph)?;
            let option = |c: &Param| c.fastest.as_ref()?.of.get(rank).cloned();
            let set: Vec<(&Param, String)> = choices
                .iter()
                .filter_map(|c| Some((*c, option(c)?)))
                .collect();
            for (choice, option) in &set {
                experiment.set(&choice.name, &format!("{option:?}"));
            }
            let wanted = loaded.graph.output.iter().cloned().collect();
            let session = self.build(&experiment, loaded, scene.clone(), wanted, reuse.as_ref());
            let mut session = match session {
                Ok(session) => session,
                // The device lacks a feature of an option.
                Err(error) => {
                    failed = Some(error);
                    continue;
                }
            };
            drop(timed(&mut session, WARMUP)?);
            let frames = timed(&mut session, FRAMES)?;
            for (choice, option) in set {
                let times = found.entry(choice.name.clone()).or_default();
                times.insert(option, time_of(choice, &loaded.graph, &frames));
            }
            reuse = Some(session.reusable_parts());
        }
        match failed {
            Some(error) if found.is_empty() => Err(error),
            _ => Ok(found),
        }
    }
}

/// Remembers this for the rest of the run.
fn know(device: &DeviceInfo, all: Measured) {
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    known.insert(device.key(), all);
}

/// Median over frames of the time of a choice's stages, ms.
fn time_of(choice: &Param, graph: &Graph, frames: &[FrameTimes]) -> f64 {
    let counts = |pass: usize| {
        let stage = graph.passes.get(pass).map(|p| p.value.stage());
        let mut stages = choice.fastest.iter().flat_map(|f| &f.stages);
        stages.any(|s| stage == Some(s))
    };
    let sum = |frame: &FrameTimes| {
        let passes = frame.passes.iter().filter(|p| counts(p.0));
        passes.map(|p| p.1).sum::<f64>()
    };
    percentile(&mut frames.iter().map(sum).collect::<Vec<f64>>(), 0.5)
}

fn opened() -> Result<Arc<Scene>, LabError> {
    Ok(Arc::new(Scene::open(SCENE, &|_, _| {
        ControlFlow::Continue(())
    })?))
}

fn subject(graph: &str) -> Result<Experiment, LabError> {
    let text = format!("(graph: {graph:?}, scene: {SCENE:?}, size: {SIZE})");
    Experiment::from_text("the measurement".as_ref(), &text).map_err(LabError::Input)
}

/// The times of frames: of `most`, or fewer on a slow device.
fn timed(session: &mut Session, most: usize) -> Result<Vec<FrameTimes>, LabError> {
    let (begun, mut frames) = (Instant::now(), Vec::new());
    for _ in 0..most {
        frames.extend(session.frame(0.0)?);
        if begun.elapsed() > PATIENCE {
            break;
        }
    }
    frames.extend(session.finish()?);
    Ok(frames)
}

fn choices(list: &[Param]) -> Vec<&Param> {
    list.iter().filter(|p| p.fastest.is_some()).collect()
}
