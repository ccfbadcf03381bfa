//! State that is reused from one measurement to the next.

use super::reference::{GRAPH, Gathered, Goal, Reference, Tracer, find, gather};
use crate::experiment::Experiment;
use crate::lab::{Lab, LabError, Loaded, ReusableParts, Workspace};
use crate::scene::Scene;
use std::collections::HashMap;
use std::ops::ControlFlow;
use std::sync::Arc;

/// Memory limit of cached references (bytes): eight of 1920x1080. Evicted ones are read again.
const MAX_REFERENCES: usize = 1 << 30;

/// State that is reused from one measurement to the next: compiled graphs, references, pipelines,
/// the uploaded scene. Texture contents are not reused, so results do not depend on earlier points.
#[derive(Default)]
pub struct Warm {
    loaded: HashMap<String, Loaded>,
    references: HashMap<String, Option<Arc<Reference>>>,
    tracer: Tracer,
    pub(super) timed: Option<ReusableParts>,
    pub(super) scored: Option<(Arc<Scene>, ReusableParts)>,
    /// Reusable parts of the last session, by session name.
    pub sessions: HashMap<String, ReusableParts>,
}

#[derive(Clone, Copy, Debug)]
pub struct Wanted {
    pub bounces: u32,
    /// Goal of gathering; `None` uses only references on disk.
    pub goal: Option<Goal>,
    /// Seed of a frame in a sequence. All frames share it, so that their noise cancels in
    /// differences. The reference then has the means of both sample halves, and reuses the tracer
    /// of the previous frame.
    pub seed: Option<u32>,
}

impl Warm {
    /// A graph, compiled once.
    pub fn graph(&mut self, home: &Workspace, name: &str) -> Result<&Loaded, LabError> {
        if !self.loaded.contains_key(name) {
            let loaded = home.load(name).map_err(LabError::Input)?;
            self.loaded.insert(name.to_string(), loaded);
        }
        self.loaded
            .get(name)
            .ok_or_else(|| LabError::Request(format!("graph '{name}' is gone")))
    }

    /// Adds a graph that was compiled elsewhere.
    pub fn keep(&mut self, name: &str, graph: &Loaded) {
        self.loaded.insert(name.to_string(), graph.clone());
    }

    /// Checks an experiment's graph and parameters without opening its scene.
    pub fn check(&mut self, home: &Workspace, experiment: &Experiment) -> Result<(), LabError> {
        experiment.params_over(&self.graph(home, &experiment.graph)?.graph.params)?;
        Ok(())
    }

    /// The reference of an experiment: from memory, from disk, or gathered now; `None` if it does
    /// not exist and must not be gathered. `subject` identifies the scene, light, camera, size and
    /// time.
    ///
    /// # Errors
    /// As [`gather`]; `on_progress` stops it.
    pub fn reference(
        &mut self,
        lab: &Lab,
        (experiment, scene): (&Experiment, &Arc<Scene>),
        subject: &str,
        wanted: Wanted,
        on_progress: &mut dyn FnMut(Gathered) -> ControlFlow<()>,
    ) -> Result<Option<Arc<Reference>>, LabError> {
        // Only parameters that the reference graph shares affect the reference.
        let shared = self.graph(&lab.home, GRAPH)?.graph.params.clone();
        let params =
            experiment.params_over(&self.graph(&lab.home, &experiment.graph)?.graph.params)?;
        let values = params
            .list
            .iter()
            .zip(&params.values)
            .filter(|(p, _)| shared.index(&p.name).is_some());
        let values: Vec<String> = values.map(|(p, v)| format!("{}={v}", p.name)).collect();
        let key = format!("{subject} {wanted:?} {}", values.join(" "));
        if let Some(found) = self.references.get(&key) {
            return Ok(found.clone());
        }
        let bounces = wanted.bounces;
        let mut stopped = false;
        let mut go_on = |now| {
            let flow = on_progress(now);
            stopped |= flow.is_break();
            flow
        };
        let reference = match (wanted.goal, wanted.seed) {
            (None, _) => find(&lab.home, experiment, scene, bounces)?,
            (Some(goal), None) => Some(gather(lab, experiment, scene, bounces, goal, &mut go_on)?),
            (Some(goal), Some(seed)) => {
                let mut seeded = experiment.clone();
                seeded.set("seed", &seed.to_string());
                Some(
                    self.tracer
                        .gather(lab, &seeded, scene, bounces, goal, &mut go_on)?,
                )
            }
        };
        if stopped {
            return Err(LabError::Stopped);
        }
        let reference = reference.map(Arc::new);
        let all = self.references.values().flatten().chain(&reference);
        if all.map(|r| r.bytes()).sum::<usize>() > MAX_REFERENCES {
            self.references.clear();
        }
        self.references.insert(key, reference.clone());
        Ok(reference)
    }

    /// Drops all state on a lost device.
    pub(crate) fn leave_device(&mut self) {
        let (loaded, references) = (
            std::mem::take(&mut self.loaded),
            std::mem::take(&mut self.references),
        );
        *self = Warm {
            loaded,
            references,
            ..Warm::default()
        };
    }
}
