//! What one measurement leaves to the next.

use super::reference::{GRAPH, Gathered, Goal, Reference, Tracer, find, gather};
use crate::experiment::Experiment;
use crate::lab::{Lab, LabError, Loaded, ReusableParts, Workspace};
use crate::scene::Scene;
use std::collections::HashMap;
use std::ops::ControlFlow;
use std::sync::Arc;

/// Most bytes of references in memory: eight of 1920x1080. What is thrown away is read again.
const MAX_REFERENCES: usize = 1 << 30;

/// What one measurement leaves to the next: compiled graphs, references, pipelines, the scene on the device. No content
/// of textures: a point's result does not depend on the points before it.
#[derive(Default)]
pub struct Warm {
    loaded: HashMap<String, Loaded>,
    references: HashMap<String, Option<Arc<Reference>>>,
    tracer: Tracer,
    pub(super) timed: Option<ReusableParts>,
    pub(super) scored: Option<(Arc<Scene>, ReusableParts)>,
    /// What the last session of a name has left, for the next of that name.
    pub sessions: HashMap<String, ReusableParts>,
}

#[derive(Clone, Copy, Debug)]
pub struct Wanted {
    pub bounces: u32,
    /// Samples a pixel that are gathered; what is on the disk is used as it is when absent.
    pub samples: Option<u64>,
    /// Of a frame in a sequence: its seed, the same for all, so that what noise frames have goes out of their differences.
    /// It has the means of both halves of the samples, and is gathered on what the one before it left.
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

    /// Takes a graph that was compiled elsewhere.
    pub fn keep(&mut self, name: &str, graph: &Loaded) {
        self.loaded.insert(name.to_string(), graph.clone());
    }

    /// Checks an experiment's graph and parameters; its scene is not opened.
    pub fn check(&mut self, home: &Workspace, experiment: &Experiment) -> Result<(), LabError> {
        experiment.params_over(&self.graph(home, &experiment.graph)?.graph.params)?;
        Ok(())
    }

    /// The reference of an experiment: from memory, from the disk, or gathered now; nothing where there is none and none
    /// is to be gathered. `subject` names what is looked at: scene, light, camera, size, time.
    ///
    /// # Errors
    /// Everything that can be wrong with the experiment; a file that cannot be read or written.
    pub fn reference(
        &mut self,
        lab: &Lab,
        (experiment, scene): (&Experiment, &Arc<Scene>),
        subject: &str,
        wanted: Wanted,
        on_progress: &mut dyn FnMut(Gathered),
    ) -> Result<Option<Arc<Reference>>, LabError> {
        // Of the parameters it depends on those that its graph has too.
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
        let mut go_on = |now| {
            on_progress(now);
            ControlFlow::Continue(())
        };
        let reference = match (wanted.samples.map(Goal::Samples), wanted.seed) {
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
        let reference = reference.map(Arc::new);
        let all = self.references.values().flatten().chain(&reference);
        if all.map(|r| r.bytes()).sum::<usize>() > MAX_REFERENCES {
            self.references.clear();
        }
        self.references.insert(key, reference.clone());
        Ok(reference)
    }

    /// Lets go of everything on a device that was lost.
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
