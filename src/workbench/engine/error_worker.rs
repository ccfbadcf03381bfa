//! The error worker: the error of what is shown against its cached reference, on a thread of its
//! own: the picture is rendered afresh, as a sweep would, so that neither the picture's frames nor
//! their times wait for it.

use super::guard::guarded;
use super::report::Report;
use crate::campaign::sweep::Subject;
use crate::experiment::Experiment;
use crate::lab::{Lab, LabError, Loaded, ReusableParts, Session};
use crate::measure::reference::Reference;
use crate::measure::{Wanted, Warm};
use crate::metrics::{Compared, Linear, Metric, Noise};
use crate::results::capture::scene_hash;
use crate::scene::Scene;
use crate::workbench::desired::request::LightState;
use crossbeam_channel::Receiver;
use std::ops::ControlFlow;
use std::sync::Arc;

/// The requested error.
#[derive(Clone, Debug, PartialEq)]
pub struct ErrorQuery {
    /// Part of the light, as the graph names it.
    pub part: String,
    /// Metric.
    pub metric: &'static Metric,
    /// Bounces of the reference.
    pub bounces: u32,
    /// Number of gathered references. Each may replace the cached one.
    pub gathered: u64,
}

/// A picture for which an error is requested.
pub struct ErrorRequest {
    /// 0 is A, 1 is B.
    pub side: usize,
    /// Number of the render request that the picture answers.
    pub request: u64,
    /// Revision of the files.
    pub revision: u64,
    /// The requested error.
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
    /// The scene of the picture's session, with as many lights.
    pub lit: Arc<Scene>,
    /// Light that differs from the scene's own.
    pub lights: Option<LightState>,
    /// Frames until the picture has converged.
    pub frames: usize,
}

/// Answer to an [`ErrorRequest`].
#[derive(Clone, Debug)]
pub struct ErrorResult {
    /// 0 is A, 1 is B.
    pub side: usize,
    /// Number of the render request of the measured picture.
    pub request: u64,
    /// The requested error.
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
    /// References and graphs, as of a revision of the files and a number of gathered references.
    warm: Warm,
    as_of: (u64, u64),
    /// The scene's content, by the scene and its light.
    hash: Option<(Arc<Scene>, String, String)>,
}

/// Measures errors until the requests' sender is gone; of several requests for a side only the
/// newest counts.
pub(crate) fn run(requests: &Receiver<ErrorRequest>, send: &dyn Fn(Report)) {
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
            send(Report::Error(ErrorResult {
                side,
                request,
                query,
                result,
            }));
        }
    }
}

impl Cache {
    fn evaluate(&mut self, request: ErrorRequest) -> Result<PictureError, LabError> {
        let subject = self.subject(&request)?;
        let Some(reference) = self.reference(&request, &subject)? else {
            return Ok(PictureError {
                subject,
                error: None,
            });
        };
        let ErrorQuery { part, metric, .. } = request.query.clone();
        let wrong =
            |why: String| LabError::Request(format!("the part '{part}' cannot be compared: {why}"));
        let expected = reference
            .parts
            .get(&part)
            .ok_or_else(|| wrong("the reference does not have it".into()))?;
        let light = light_of(request, &part)?;
        let compared = Compared::new(&light, &expected.mean).map_err(|e| wrong(e.0))?;
        let error = metric.distance(compared.score(metric).map_err(|e| wrong(e.0))?);
        let error = ReferenceError {
            error,
            noise: expected.noise,
            samples: reference.samples,
        };
        Ok(PictureError {
            subject,
            error: Some(error),
        })
    }

    /// Scene, camera, size and time of the picture, as sweeps write them down. The hash of a large
    /// scene takes a second: it is kept.
    fn subject(&mut self, request: &ErrorRequest) -> Result<Subject, LabError> {
        let light = format!("{:?}", request.lights);
        let known = self
            .hash
            .as_ref()
            .filter(|h| Arc::ptr_eq(&h.0, &request.scene) && h.1 == light);
        let sha256 = match known {
            Some(known) => known.2.clone(),
            None => {
                let hash = scene_hash(&*request.experiment.adapted(request.scene.clone())?);
                self.hash = Some((request.scene.clone(), light, hash.clone()));
                hash
            }
        };
        Subject::of(&request.experiment, &request.scene, sha256)
    }

    /// The cached reference, read once for everything that it does not depend on.
    fn reference(
        &mut self,
        request: &ErrorRequest,
        subject: &Subject,
    ) -> Result<Option<Arc<Reference>>, LabError> {
        let ErrorRequest {
            lab,
            loaded,
            experiment,
            scene,
            query,
            ..
        } = request;
        if self.as_of != (request.revision, query.gathered) {
            (self.warm, self.as_of) = (Warm::default(), (request.revision, query.gathered));
        }
        self.warm.keep(&experiment.graph, loaded);
        let lit = experiment.adapted(scene.clone())?;
        let wanted = Wanted {
            bounces: query.bounces,
            goal: None,
            seed: None,
        };
        self.warm.reference(
            lab,
            (experiment, &lit),
            &format!("{subject:?}"),
            wanted,
            &mut |_| ControlFlow::Continue(()),
        )
    }
}

/// A part of the picture's light, from a fresh start.
fn light_of(request: ErrorRequest, part: &str) -> Result<Linear, LabError> {
    let ErrorRequest {
        lab,
        loaded,
        reuse,
        experiment,
        lit,
        lights,
        frames,
        ..
    } = request;
    let missing = || {
        LabError::Request(format!(
            "the graph '{}' does not make the part '{part}'",
            loaded.graph.name
        ))
    };
    let named = crate::lab::parts_of(&loaded.graph)
        .into_iter()
        .find(|p| p.name == part);
    let texture = named.ok_or_else(missing)?.texture;
    let mut session: Session = lab.build(&experiment, &loaded, lit, vec![texture], Some(&reuse))?;
    if lights.is_some_and(|lights| !lights.light(&mut session)) {
        return Err(LabError::Request(
            "the lights changed too much to update the session".into(),
        ));
    }
    session.run(frames)?;
    session.parts()?.remove(part).ok_or_else(missing)
}
