//! Builds sessions in the background, on a thread of its own: read, compile, check, plan, make
//! pipelines. Nothing waits for it.

use super::guard::guarded;
use crate::experiment::Experiment;
use crate::lab::{Lab, LabError, Loaded, ReusableParts, Session};
use crate::scene::Scene;
use crate::workbench::desired::request::SideRequest;
use crossbeam_channel::{Receiver, Sender};
use std::sync::Arc;
use std::time::Instant;

/// The inputs of a session; equal keys give the same session.
#[derive(Clone, PartialEq)]
pub struct Key {
    /// Graph and parameters.
    pub side: SideRequest,
    /// Picture size.
    pub size: (u32, u32),
    /// Revision of the files.
    pub revision: u64,
    /// Which scene was loaded.
    pub scene: u64,
    /// Numbers of lights and shadow maps.
    pub lights: [u32; 4],
    /// A further resource to read back.
    pub wanted: Vec<String>,
}

/// Something to build.
pub struct Job {
    /// 0 is A, 1 is B.
    pub side: usize,
    /// Key of the session in work.
    pub key: Key,
    /// The experiment of the key.
    pub experiment: Experiment,
    /// The scene.
    pub scene: Arc<Scene>,
    /// Parts of the session in use.
    pub reuse: Option<ReusableParts>,
    /// The graph, if its files did not change since it was loaded.
    pub loaded: Option<Loaded>,
    /// Whether this is only the preview.
    pub preview: bool,
    /// The device.
    pub lab: Lab,
}

/// The result of a build.
pub struct Done {
    /// 0 is A, 1 is B.
    pub side: usize,
    /// Key of the new session.
    pub key: Key,
    /// Whether this is only the preview.
    pub preview: bool,
    /// When the build began.
    pub start: Instant,
    /// The session and its graph.
    pub result: Result<(Box<Session>, Loaded), LabError>,
}

/// Builds until the jobs' sender is gone.
pub fn run(jobs: &Receiver<Job>, done: &Sender<Done>) {
    for job in jobs {
        let start = Instant::now();
        let (side, key, preview) = (job.side, job.key.clone(), job.preview);
        let result = guarded(|| build(job)).unwrap_or_else(|why| Err(LabError::Request(why)));
        if done
            .send(Done {
                side,
                key,
                preview,
                start,
                result,
            })
            .is_err()
        {
            return;
        }
    }
}

fn build(job: Job) -> Result<(Box<Session>, Loaded), LabError> {
    // Other passes are compiled when they first run.
    let home = &job.lab.home;
    let loaded = match &job.loaded {
        Some(loaded) => home.complete(loaded, &job.experiment, &job.scene, &job.lab.gpu.info),
        None => home.load_for(&job.experiment, &job.scene, &job.lab.gpu.info),
    };
    let loaded = loaded.map_err(LabError::Input)?;
    let graph = &loaded.graph;
    let output = graph.output.clone().ok_or_else(|| {
        LabError::Request(format!(
            "graph '{}' has no `output`: there is nothing to show",
            graph.name
        ))
    })?;
    let has = |name: &String| graph.resource(name).is_some();
    let mut wanted = vec![output.clone()];
    wanted.extend(job.key.wanted.iter().filter(|n| has(n)).cloned());
    let mut session = job.lab.build(
        &job.experiment,
        &loaded,
        job.scene,
        wanted,
        job.reuse.as_ref(),
    )?;
    session.show(&output);
    Ok((Box::new(session), loaded))
}
