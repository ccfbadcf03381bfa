//! The error worker: the error of what is shown against its cached reference, on a thread of its own: the picture is
//! rendered afresh, as a sweep would, so that neither the picture's frames nor their times wait for it.

use super::guard::guarded;
use super::report::Report;
use super::request::LightState;
use crate::campaign::sweep::Subject;
use crate::experiment::{Experiment, placed_text};
use crate::lab::{Lab, LabError, Loaded, ReusableParts, Session, camera_of, params_of};
use crate::measure::reference::{GRAPH, Reference, find};
use crate::metrics::{Compared, Linear, Metric, Noise};
use crate::results::capture::scene_hash;
use crate::scene::Scene;
use crossbeam_channel::Receiver;
use std::sync::Arc;

/// The error that is asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct ErrorQuery {
    /// Part of the light, as the graph names it.
    pub part: String,
    /// Metric.
    pub metric: &'static Metric,
    /// Bounces of the reference.
    pub bounces: u32,
    /// References gathered so far: the cached one may be another after each.
    pub gathered: u64,
}

/// A picture whose error is asked for.
pub struct ErrorRequest {
    /// 0 is A, 1 is B.
    pub side: usize,
    /// Number of the render request that the picture answers.
    pub request: u64,
    /// Revision of the files.
    pub revision: u64,
    /// The error that is asked for.
    pub query: ErrorQuery,
    /// The device.
    pub lab: Lab,
    /// The graph.
    pub loaded: Loaded,
    /// Parts of the session that is shown.
    pub reuse: ReusableParts,
    /// Everything that decides the picture.
    pub experiment: Experiment,
    /// The scene with its own light.
    pub scene: Arc<Scene>,
    /// Light that differs from the scene's own.
    pub lights: Option<LightState>,
    /// Frames until the picture has settled.
    pub frames: usize,
}

/// Answer to an [`ErrorRequest`].
#[derive(Clone, Debug)]
pub struct ErrorResult {
    /// 0 is A, 1 is B.
    pub side: usize,
    /// Number of the render request whose picture was measured.
    pub request: u64,
    /// The error that was asked for.
    pub query: ErrorQuery,
    /// The answer, or why there is none.
    pub result: Result<PictureError, String>,
}

/// Subject and error of a picture.
#[derive(Clone, Debug)]
pub struct PictureError {
    /// Scene, camera, size and time of the picture.
    pub subject: Subject,
    /// The error; absent without a reference.
    pub error: Option<ReferenceError>,
}

/// A picture's distance from its reference.
#[derive(Clone, Copy, Debug)]
pub struct ReferenceError {
    /// 0 is perfect; no number where the metric is not defined.
    pub error: f64,
    /// Noise of the reference.
    pub noise: Noise,
    /// Samples a pixel of the reference.
    pub samples: u64,
}

/// Loaded things that the next request may need again.
#[derive(Default)]
struct Cache {
    /// The graph of references, as of a revision of the files.
    traced: Option<(u64, Loaded)>,
    /// The scene's content, by the scene and its light.
    hash: Option<(Arc<Scene>, String, String)>,
    /// The reference, by everything that it depends on.
    reference: Option<(Arc<Scene>, String, Option<Arc<Reference>>)>,
}

/// Measures errors until the requests' sender is gone; of several requests for a side only the newest counts.
pub(super) fn run(requests: &Receiver<ErrorRequest>, send: &dyn Fn(Report)) {
    let mut loaded = Cache::default();
    while let Ok(first) = requests.recv() {
        let mut newest = [None, None];
        for request in std::iter::once(first).chain(requests.try_iter()) {
            let side = request.side.min(1);
            newest[side] = Some(request);
        }
        for latest in newest.into_iter().flatten() {
            let (side, request, query) = (latest.side, latest.request, latest.query.clone());
            let result = guarded(|| loaded.evaluate(latest).map_err(|e| e.to_string())).flatten();
            send(Report::Error(ErrorResult { side, request, query, result }));
        }
    }
}

impl Cache {
    fn evaluate(&mut self, request: ErrorRequest) -> Result<PictureError, LabError> {
        let subject = self.subject(&request)?;
        let Some(reference) = self.reference(&request)? else { return Ok(PictureError { subject, error: None }) };
        let ErrorQuery { part, metric, .. } = request.query.clone();
        let wrong = |why: String| LabError::Request(format!("the part '{part}' cannot be compared: {why}"));
        let expected = reference.parts.get(&part).ok_or_else(|| wrong("the reference does not have it".into()))?;
        let light = light_of(request, &part)?;
        let compared = Compared::new(&light, &expected.mean).map_err(|e| wrong(e.0))?;
        let error = metric.distance(compared.score(metric).map_err(|e| wrong(e.0))?);
        let error = ReferenceError { error, noise: expected.noise, samples: reference.samples };
        Ok(PictureError { subject, error: Some(error) })
    }

    /// Scene, camera, size and time of the picture, as sweeps write them down. The hash of a large scene takes a
    /// second: it is kept.
    fn subject(&mut self, request: &ErrorRequest) -> Result<Subject, LabError> {
        let light = format!("{:?}", request.lights);
        let known = self.hash.as_ref().filter(|h| Arc::ptr_eq(&h.0, &request.scene) && h.1 == light);
        let sha256 = match known {
            Some(known) => known.2.clone(),
            None => {
                let hash = scene_hash(&*request.experiment.adapted(request.scene.clone())?);
                self.hash = Some((request.scene.clone(), light, hash.clone()));
                hash
            }
        };
        Ok(Subject {
            scene: request.scene.name.clone(),
            sha256,
            camera: placed_text(&camera_of(&request.experiment, &request.scene)?),
            size: request.experiment.size,
            time: format!("{:?}", request.experiment.time),
        })
    }

    /// The cached reference, read once for everything that it does not depend on.
    fn reference(&mut self, request: &ErrorRequest) -> Result<Option<Arc<Reference>>, LabError> {
        let ErrorRequest { experiment, scene, query, .. } = request;
        let home = &request.lab.home;
        if self.traced.as_ref().is_none_or(|t| t.0 != request.revision) {
            self.traced = Some((request.revision, home.load(GRAPH).map_err(LabError::Input)?));
        }
        let shared = self.traced.iter().flat_map(|t| &t.1.graph.params.list);
        let params = params_of(&request.loaded.graph, experiment)?;
        let shared: Vec<String> = shared
            .filter_map(|p| Some(format!("{} {:?}", p.name, params.values.get(params.index(&p.name)?)?)))
            .collect();
        let key = format!(
            "{:?} {:?} {:?} {:?} {} {} {} {}",
            request.lights,
            experiment.camera,
            experiment.size,
            experiment.time,
            query.bounces,
            query.gathered,
            request.revision,
            shared.join(" ")
        );
        if let Some(known) = self.reference.as_ref().filter(|r| Arc::ptr_eq(&r.0, scene) && r.1 == key) {
            return Ok(known.2.clone());
        }
        let lit = experiment.adapted(scene.clone())?;
        let found = find(home, experiment, &lit, query.bounces)?.map(Arc::new);
        self.reference = Some((scene.clone(), key, found.clone()));
        Ok(found)
    }
}

/// A part of the picture's light, from a fresh start.
fn light_of(request: ErrorRequest, part: &str) -> Result<Linear, LabError> {
    let ErrorRequest { lab, loaded, reuse, experiment, scene, lights, frames, .. } = request;
    let missing = || LabError::Request(format!("the graph '{}' does not make the part '{part}'", loaded.graph.name));
    let named = crate::lab::parts_of(&loaded.graph).into_iter().find(|p| p.name == part);
    let texture = named.ok_or_else(missing)?.texture;
    let mut session: Session = lab.build(&experiment, &loaded, scene, vec![texture], Some(&reuse))?;
    if lights.is_some_and(|lights| !lights.light(&mut session)) {
        return Err(LabError::Request("the light changed more than a session can follow".into()));
    }
    for _ in 0..frames {
        session.frame(0.0)?;
    }
    session.finish()?;
    session.parts()?.remove(part).ok_or_else(missing)
}
