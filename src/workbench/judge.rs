//! The error of what is shown against its cached reference, on a thread of its own: the picture is rendered afresh, as a
//! sweep would, so that neither the picture's frames nor their times wait for it.

use super::report::Report;
use crate::capture::scene_hash;
use crate::experiment::{Experiment, placed_text};
use crate::lab::{Lab, LabError, Loaded, Seed, Session, camera_of, params_of};
use crate::metrics::{Compared, Kind, Linear, relmse};
use crate::reference::{GRAPH, Reference, find};
use crate::report::error_of;
use crate::scene::{Light, Scene};
use crate::sweep::{Subject, numbers};
use crossbeam_channel::Receiver;
use glam::Vec3;
use std::sync::Arc;

/// What is asked about a picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Question {
    /// Part of the light, as the graph names it.
    pub part: String,
    /// Field of [`crate::metrics::Scores`].
    pub metric: String,
    /// Bounces of the reference.
    pub bounces: u32,
    /// References gathered so far: the cached one may be another after each.
    pub gathered: u64,
}

/// A picture and what is asked about it.
pub struct Case {
    /// 0 is A, 1 is B.
    pub slot: usize,
    /// The request that it fulfils.
    pub request: u64,
    /// Revision of the files.
    pub revision: u64,
    /// What is asked.
    pub question: Question,
    /// The device.
    pub lab: Lab,
    /// The graph.
    pub loaded: Loaded,
    /// What the session that is shown lends.
    pub seed: Seed,
    /// Everything that decides the picture.
    pub experiment: Experiment,
    /// The scene with its own light.
    pub scene: Arc<Scene>,
    /// Lights and sky that differ from the scene's own.
    pub lights: Option<(Vec<Light>, Vec3)>,
    /// Frames until the picture has settled.
    pub frames: u32,
}

/// The answer.
#[derive(Clone, Debug)]
pub struct Judged {
    /// 0 is A, 1 is B.
    pub slot: usize,
    /// The request that was judged.
    pub request: u64,
    /// What was asked.
    pub question: Question,
    /// The answer, or why there is none.
    pub result: Result<Verdict, String>,
}

/// What is known of a picture.
#[derive(Clone, Debug)]
pub struct Verdict {
    /// What is looked at.
    pub subject: Subject,
    /// The error; absent without a reference.
    pub error: Option<Measured>,
}

/// A picture's distance from its reference.
#[derive(Clone, Copy, Debug)]
pub struct Measured {
    /// 0 is perfect; no number where the metric is not defined.
    pub error: f64,
    /// relMSE between the halves of the reference's samples.
    pub noise: f64,
    /// Samples a pixel of the reference.
    pub samples: u64,
}

/// What one case leaves to the next.
#[derive(Default)]
struct Memory {
    /// The graph of references, as of a revision of the files.
    traced: Option<(u64, Loaded)>,
    /// The scene's content, by the scene and its light.
    hash: Option<(Arc<Scene>, String, String)>,
    /// The reference, by everything that it depends on.
    reference: Option<(Arc<Scene>, String, Option<Arc<Reference>>)>,
}

/// Judges until the cases' sender is gone; of several that wait for a slot only the newest counts.
pub(super) fn run(cases: &Receiver<Case>, tell: &dyn Fn(Report)) {
    let mut memory = Memory::default();
    while let Ok(first) = cases.recv() {
        let mut newest = [None, None];
        for case in std::iter::once(first).chain(cases.try_iter()) {
            let slot = case.slot.min(1);
            newest[slot] = Some(case);
        }
        for case in newest.into_iter().flatten() {
            let (slot, request, question) = (case.slot, case.request, case.question.clone());
            let result = memory.judge(case).map_err(|e| e.to_string());
            tell(Report::Judged(Judged { slot, request, question, result }));
        }
    }
}

impl Memory {
    fn judge(&mut self, case: Case) -> Result<Verdict, LabError> {
        let subject = self.subject(&case)?;
        let Some(reference) = self.reference(&case)? else { return Ok(Verdict { subject, error: None }) };
        let Question { part, metric, .. } = case.question.clone();
        let wrong = |why: String| LabError::Request(format!("the part '{part}' cannot be compared: {why}"));
        let truth = reference.parts.get(&part).ok_or_else(|| wrong("the reference does not have it".into()))?;
        let light = light_of(case, &part)?;
        let error = if metric == "relmse" {
            relmse(&light, &truth.mean).map_err(|e| wrong(e.0))?
        } else {
            let compared = Compared::new(&light, &truth.mean, Kind::of_part(&part)).map_err(|e| wrong(e.0))?;
            let scores = compared.scores(None).ok_or_else(|| wrong("no pixel is a number in both pictures".into()))?;
            numbers(&scores).get(&metric).copied().unwrap_or(f64::NAN)
        };
        let error = Measured { error: error_of(&metric, error), noise: truth.noise, samples: reference.samples };
        Ok(Verdict { subject, error: Some(error) })
    }

    /// What is looked at, as sweeps write it down. The hash of a large scene takes a second: it is kept.
    fn subject(&mut self, case: &Case) -> Result<Subject, LabError> {
        let light = format!("{:?}", case.lights);
        let known = self.hash.as_ref().filter(|h| Arc::ptr_eq(&h.0, &case.scene) && h.1 == light);
        let sha256 = match known {
            Some(known) => known.2.clone(),
            None => {
                let hash = scene_hash(&*case.experiment.adapted(case.scene.clone())?);
                self.hash = Some((case.scene.clone(), light, hash.clone()));
                hash
            }
        };
        Ok(Subject {
            scene: case.scene.name.clone(),
            sha256,
            camera: placed_text(&camera_of(&case.experiment, &case.scene)?),
            size: case.experiment.size,
            time: format!("{:?}", case.experiment.time),
        })
    }

    /// The cached reference, read once for everything that it does not depend on.
    fn reference(&mut self, case: &Case) -> Result<Option<Arc<Reference>>, LabError> {
        let Case { experiment, scene, question, .. } = case;
        let home = &case.lab.home;
        if self.traced.as_ref().is_none_or(|t| t.0 != case.revision) {
            self.traced = Some((case.revision, home.load(GRAPH).map_err(LabError::Input)?));
        }
        let shared = self.traced.iter().flat_map(|t| &t.1.graph.params.list);
        let params = params_of(&case.loaded.graph, experiment)?;
        let shared: Vec<String> = shared
            .filter_map(|p| Some(format!("{} {:?}", p.name, params.values.get(params.index(&p.name)?)?)))
            .collect();
        let key = format!(
            "{:?} {:?} {:?} {:?} {} {} {} {}",
            case.lights,
            experiment.camera,
            experiment.size,
            experiment.time,
            question.bounces,
            question.gathered,
            case.revision,
            shared.join(" ")
        );
        if let Some(known) = self.reference.as_ref().filter(|r| Arc::ptr_eq(&r.0, scene) && r.1 == key) {
            return Ok(known.2.clone());
        }
        let lit = experiment.adapted(scene.clone())?;
        let found = find(home, experiment, &lit, question.bounces)?.map(Arc::new);
        self.reference = Some((scene.clone(), key, found.clone()));
        Ok(found)
    }
}

/// A part of the picture's light, from a fresh start.
fn light_of(case: Case, part: &str) -> Result<Linear, LabError> {
    let Case { lab, loaded, seed, experiment, scene, lights, frames, .. } = case;
    let missing = || LabError::Request(format!("the graph '{}' does not make the part '{part}'", loaded.graph.name));
    let named = crate::lab::parts_of(&loaded.graph).into_iter().find(|p| p.0 == part);
    let (_, texture) = named.ok_or_else(missing)?;
    let mut session: Session = lab.build(&experiment, &loaded, scene, vec![texture], Some(&seed))?;
    if let Some((lights, sky)) = lights
        && !session.set_lights(&lights, sky)
    {
        return Err(LabError::Request("the light changed more than a session can follow".into()));
    }
    for _ in 0..frames {
        session.frame(0.0)?;
    }
    session.finish()?;
    session.parts()?.remove(part).ok_or_else(missing)
}
