//! References of frames.

use super::motion::FrameState;
use super::plan::Job;
use crate::experiment::{CameraChoice, Experiment};
use crate::lab::{Lab, LabError};
use crate::measure::Warm;
use crate::measure::reference::{GRAPH, Gathered, Goal, Noise, Tracer};
use crate::metrics::Linear;
use crate::scene::Scene;
use std::collections::{BTreeMap, HashMap};
use std::ops::ControlFlow;
use std::sync::Arc;

/// Most bytes of references in memory: what is thrown away is read again.
const MAX_BYTES: usize = 512 << 20;

/// A part of a reference.
pub(super) struct ReferencePart {
    pub mean: Linear,
    /// Means of the even and of the odd samples.
    pub halves: [Linear; 2],
    /// What its own noise scores.
    pub noise: Noise,
}

/// A reference of one frame.
pub(super) struct FrameReference {
    pub parts: BTreeMap<String, ReferencePart>,
    pub samples: u64,
    bytes: usize,
}

/// Samples, bounces and seed of the references.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tracing {
    pub samples: u64,
    pub bounces: u32,
    pub seed: u32,
}

/// The references of one device.
pub(super) struct References {
    tracing: Tracing,
    tracer: Tracer,
    found: HashMap<String, Arc<FrameReference>>,
}

impl References {
    pub fn new(tracing: Tracing) -> References {
        References { tracing, tracer: Tracer::default(), found: HashMap::new() }
    }

    /// The reference of a frame state of a job, from memory, from the disk, or traced now.
    pub fn get(
        &mut self,
        lab: &Lab,
        warm: &mut Warm,
        job: &Job,
        state: &FrameState,
        on_progress: &mut dyn FnMut(Gathered),
    ) -> Result<Arc<FrameReference>, LabError> {
        let key = key(lab, warm, job, state)?;
        if let Some(found) = self.found.get(&key) {
            return Ok(found.clone());
        }
        let mut experiment: Experiment = job.experiment.clone();
        experiment.camera = CameraChoice::Placed(state.camera);
        experiment.time = state.time;
        if let Some((name, value)) = &state.setting {
            experiment.set(name, &value.to_string());
        }
        // One seed for all frames: what noise they have is much the same, and goes out of their differences.
        experiment.set("seed", &self.tracing.seed.to_string());
        let scene = match state.lights == job.scene.lights {
            true => job.scene.clone(),
            false => Arc::new(Scene { lights: state.lights.clone(), ..Scene::clone(&job.scene) }),
        };
        let goal = Goal::Samples(self.tracing.samples);
        let (reference, mut halves) =
            self.tracer.gather(lab, &experiment, &scene, self.tracing.bounces, goal, &mut |now| {
                on_progress(now);
                ControlFlow::Continue(())
            })?;
        let samples = reference.samples;
        let parts: BTreeMap<String, ReferencePart> = reference
            .parts
            .into_iter()
            .filter_map(|(name, part)| {
                let halves = halves.remove(&name)?;
                Some((name, ReferencePart { mean: part.mean, halves, noise: part.noise }))
            })
            .collect();
        let bytes = parts.values().map(|p| 3 * 12 * p.mean.rgb.len()).sum();
        let reference = Arc::new(FrameReference { parts, samples, bytes });
        if self.found.values().map(|t| t.bytes).sum::<usize>() + bytes > MAX_BYTES {
            self.found.clear();
        }
        self.found.insert(key, reference.clone());
        Ok(reference)
    }
}

/// What the reference of a frame state depends on: what is looked at, and the parameters that its graph shares with
/// that of references.
fn key(lab: &Lab, warm: &mut Warm, job: &Job, state: &FrameState) -> Result<String, LabError> {
    let shared = warm.graph(&lab.home, GRAPH)?.graph.params.clone();
    let own = &warm.graph(&lab.home, &job.experiment.graph)?.graph.params;
    let params = job.experiment.params_over(own)?;
    let values = params.list.iter().zip(&params.values).filter(|(p, _)| shared.index(&p.name).is_some());
    let values: Vec<String> = values.map(|(p, v)| format!("{}={v}", p.name)).collect();
    Ok(format!("{} {:?} {state:?} {}", job.scene_hash, job.experiment.size, values.join(" ")))
}
