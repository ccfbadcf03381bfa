//! Gathers samples until a goal is reached and saves them on the way.

use super::goal::{Goal, is_checkpoint};
use super::store::{self, Sums};
use super::{Reference, key};
use crate::experiment::Experiment;
use crate::graph::LightPart;
use crate::graph::run::Execution;
use crate::lab::{Lab, LabError, Loaded, ReusableParts, Session};
use crate::scene::Scene;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Progress towards the goal.
#[derive(Clone, Copy, Debug)]
pub struct Gathered {
    /// Samples per pixel gathered.
    pub samples: u64,
    /// Estimated samples at the goal.
    pub goal: u64,
    /// Error of the total against the converged reference, estimated at the last checkpoint: by the
    /// metric of the bound, otherwise relMSE.
    pub noise: Option<f64>,
}

/// Interval between saves.
const KEEP_EVERY: Duration = Duration::from_secs(30);

/// Gathers the reference of an experiment and resumes an earlier run. `scene` has the experiment's
/// lighting. Equal sample counts give equal bits on a device, regardless of interruptions.
/// `progress` may stop the run; whole blocks of samples are still saved.
///
/// # Errors
/// An invalid experiment; a stop in the first block; a read-only folder; samples that are not
/// finite.
pub fn gather(
    lab: &Lab,
    experiment: &Experiment,
    scene: &Arc<Scene>,
    bounces: u32,
    goal: Goal,
    progress: &mut dyn FnMut(Gathered) -> ControlFlow<()>,
) -> Result<Reference, LabError> {
    Tracer::default()
        .sums(lab, experiment, scene, bounces, goal, progress)?
        .reference(false)
}

/// Gathers references in sequence and reuses the compiled graph, its pipelines, and the uploaded
/// scene. The bits are those of [`gather`].
#[derive(Default)]
pub struct Tracer {
    loaded: Option<Loaded>,
    shared: Option<ReusableParts>,
}

/// Gathered sums.
struct Traced {
    sums: Sums,
    folder: PathBuf,
    loaded: Loaded,
}

impl Traced {
    fn reference(&self, halves: bool) -> Result<Reference, LabError> {
        self.sums
            .reference(&self.loaded.graph, &self.folder, halves)
    }
}

impl Tracer {
    /// [`gather`] with the means of both sample halves.
    pub fn gather(
        &mut self,
        lab: &Lab,
        experiment: &Experiment,
        scene: &Arc<Scene>,
        bounces: u32,
        goal: Goal,
        progress: &mut dyn FnMut(Gathered) -> ControlFlow<()>,
    ) -> Result<Reference, LabError> {
        self.sums(lab, experiment, scene, bounces, goal, progress)?
            .reference(true)
    }

    /// The graph of references, loaded once.
    fn graph(&mut self, lab: &Lab) -> Result<Loaded, LabError> {
        let loaded = match &self.loaded {
            Some(loaded) => loaded.clone(),
            None => lab.home.load(key::GRAPH).map_err(LabError::Input)?,
        };
        self.loaded = Some(loaded.clone());
        Ok(loaded)
    }

    fn sums(
        &mut self,
        lab: &Lab,
        experiment: &Experiment,
        scene: &Arc<Scene>,
        bounces: u32,
        goal: Goal,
        progress: &mut dyn FnMut(Gathered) -> ControlFlow<()>,
    ) -> Result<Traced, LabError> {
        let loaded = self.graph(lab)?;
        let mut traced = key::traced_by(&loaded, experiment, bounces)?;
        let folder = lab.home.captures.join("reference");
        let folder = folder.join(key::key(&traced, &loaded, scene)?);
        let graph = &loaded.graph;
        let sums = store::read(&folder, traced.size, graph)?;
        let mut sums = sums.unwrap_or_else(|| Sums::new(traced.size, &graph.parts));
        let mut now = state(&sums, goal, None)?;
        if now.samples >= now.goal {
            return Ok(Traced {
                sums,
                folder,
                loaded,
            });
        }
        let per_frame = samples_per_frame(lab.gpu.info.kind, traced.size);
        traced.set("samples", &per_frame.to_string());
        let wanted = graph.parts.iter().map(|p| store::sum_texture(&p.name));
        let (wanted, reuse) = (wanted.collect(), self.shared.as_ref());
        let mut session = lab.build(&traced, &loaded, scene.clone(), wanted, reuse)?;
        // Passes that do not read the sample's index run once.
        session.set_execution(Execution::Incremental);
        let (mut kept, mut all_kept) = (Instant::now(), true);
        while now.samples < now.goal {
            frame(lab, &mut session, &mut sums, per_frame)?;
            now = state(&sums, goal, Some(now))?;
            let stop = progress(now).is_break();
            // Whole blocks only, so that the sums do not depend on interruptions.
            let whole = sums.samples.is_multiple_of(store::BLOCK);
            if whole && (stop || now.samples >= now.goal || kept.elapsed() > KEEP_EVERY) {
                store::write(&folder, &sums, &traced, &lab.gpu.info)?;
                (kept, all_kept) = (Instant::now(), true);
            } else if whole {
                all_kept = false;
            }
            if stop && whole {
                break;
            }
            // If a block takes long, all earlier ones have been saved.
            if stop && all_kept {
                let before = store::read(&folder, traced.size, graph)?;
                let why = format!(
                    "cancelled before the first {} samples; nothing was saved",
                    store::BLOCK
                );
                sums = before.ok_or(LabError::Request(why))?;
                break;
            }
        }
        self.shared = Some(session.share());
        Ok(Traced {
            sums,
            folder,
            loaded,
        })
    }
}

/// Progress of the sums towards a goal. Noise between checkpoints is that of `before`.
fn state(sums: &Sums, goal: Goal, before: Option<Gathered>) -> Result<Gathered, LabError> {
    // Samples of an earlier run may end between checkpoints.
    let noise = match (before, goal) {
        (Some(before), _) if !is_checkpoint(sums.samples) => before.noise,
        _ if sums.samples == 0 => None,
        // For display only: FLIP and structure would take longer than the samples of a fast device.
        (_, Goal::Samples(_)) => Some(sums.relmse("total")? / 4.0),
        (_, Goal::Noise(bound)) => bound.metric.of_noise(sums.noise()?),
    };
    Ok(Gathered {
        samples: sums.samples,
        goal: goal.samples(sums.samples, noise),
        noise,
    })
}

/// Samples per pixel and submission: a divisor of the block, few on CPUs, where a frame would take
/// minutes. Depends on nothing that changes between runs.
fn samples_per_frame(kind: &str, (width, height): (u32, u32)) -> u64 {
    let pixels = u64::from(width) * u64::from(height);
    let budget: u64 = if kind == "cpu" { 1 << 19 } else { 1 << 26 };
    let most = (budget / pixels.max(1)).clamp(1, store::BLOCK);
    1 << most.ilog2()
}

fn frame(lab: &Lab, session: &mut Session, sums: &mut Sums, samples: u64) -> Result<(), LabError> {
    let mut params = session.params.clone();
    params
        .set("first_sample", &sums.samples.to_string())
        .map_err(LabError::Request)?;
    if !session.set_params(lab, &params)? {
        return Err(LabError::Request(
            "'first_sample' of the reference graph must not change the plan".into(),
        ));
    }
    session.run(1)?;
    if let Some(message) = session.failed_checks()?.into_iter().next() {
        return Err(LabError::Request(message));
    }
    for LightPart { name, .. } in session.graph.parts.clone() {
        for half in 0..2 {
            let texels = session.texels(&store::sum_texture(&name), 0, half)?;
            sums.add(&name, half as usize, &texels.floats());
        }
    }
    sums.samples += samples;
    Ok(())
}
