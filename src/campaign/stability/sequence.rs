//! Frames of a method in a case, each with its reference.

use super::motion::{FrameState, Motion};
use super::pictures::Panels;
use super::plan::Job;
use super::record::{Measured, Worst, picture};
use super::series::{Known, PartSeries};
use crate::campaign::record::File;
use crate::campaign::runner::Runner;
use crate::experiment::CameraChoice;
use crate::graph::param::Value;
use crate::lab::{Lab, LabError, Session, parts_of};
use crate::measure::Wanted;
use crate::measure::oracle::{self, Surfaces};
use crate::measure::reference::{Goal, Reference};
use crate::metrics::median;
use crate::scene::{Light, Scene};
use glam::DVec3;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Samples, bounces and seed of the references.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tracing {
    pub samples: u64,
    pub bounces: u32,
    pub seed: u32,
}

/// A candidate for the worst frame.
struct Bad {
    frame: usize,
    bad: f64,
    panels: Panels,
}

/// The scores of the frames so far.
#[derive(Default)]
struct Scores {
    /// Keys are parts of the light.
    series: BTreeMap<String, PartSeries>,
    worst: Option<Bad>,
    warnings: Vec<String>,
    /// Samples per pixel of the last reference.
    samples: u64,
}

/// Runs a job and scores each part of its light by frame. The worst frame of the part `pictures`
/// becomes a picture.
pub(super) fn measure(
    runner: &mut Runner,
    job: &Job,
    tracing: Option<Tracing>,
    pictures: &str,
) -> Result<(Measured, Vec<File>), LabError> {
    let mut session = session_of(runner, job)?;
    let motion = &job.case.motion;
    let cell = cell_of(&mut session, job)?;
    let (mut times, mut scores) = (Vec::new(), Scores::default());
    let mut lights = job.scene.lights.clone();
    let mut before: Option<(FrameState, Option<Arc<Reference>>)> = None;
    let warmup = i64::try_from(job.case.warmup).unwrap_or(0);
    let frames = i64::try_from(job.frames).unwrap_or(1);
    let execution = session.execution();
    session.begin_warm_up(&runner.lab.gpu.info);
    for number in -warmup..frames {
        if number == 0 {
            session.set_execution(execution);
        }
        let state = place(&runner.lab, &mut session, job, number, cell, &mut lights)?;
        times.extend(session.frame(motion.delta())?);
        let Ok(frame) = usize::try_from(number) else {
            continue;
        };
        times.extend(session.finish()?);
        for message in session.failed_checks()? {
            scores.warn(message);
        }
        let changed = before.as_ref().is_none_or(|b| b.0 != state);
        let reference = match (&before, tracing) {
            (_, None) => None,
            (Some((_, Some(reference))), _) if !changed => Some(reference.clone()),
            (_, Some(tracing)) => reference_of(runner, job, &state, tracing)?,
        };
        scores.note(reference.as_deref(), frame);
        let earlier = before.as_ref().and_then(|b| b.1.as_ref());
        let is_last = number + 1 == frames;
        scores.add(&mut session, pictures, (frame, is_last), |part| {
            known(part, reference.as_deref(), earlier.map(|t| &**t), changed)
        })?;
        before = Some((state, reference));
    }
    let timed = times.iter().skip(job.case.warmup);
    let frame_ms = median(timed.map(|t| t.gpu_ms).collect());
    let last = before.map_or(job.start.time, |b| b.0.time);
    let voxels = voxels(&mut session, job, last, &mut scores.warnings)?;
    let sessions = &mut runner.warm.sessions;
    sessions.insert(job.method.clone(), session.share());
    let memory = session.program.memory(&session.graph);
    let (measured, files) = scores.finish(job, pictures)?;
    let measured = Measured {
        frame_ms,
        memory_bytes: memory.iter().map(|m| m.1).sum(),
        voxels,
        ..measured
    };
    Ok((measured, files))
}

impl Scores {
    /// Adds a warning, once.
    fn warn(&mut self, message: String) {
        if !self.warnings.contains(&message) {
            self.warnings.push(message);
        }
    }

    /// Takes the samples of a frame's reference.
    fn note(&mut self, reference: Option<&Reference>, frame: usize) {
        let Some(reference) = reference else { return };
        if frame > 0 && reference.samples != self.samples {
            let unequal = "references have different numbers of samples, some were kept with more: noise is larger";
            self.warn(unequal.into());
        }
        self.samples = reference.samples;
    }

    /// The measurement without times, memory and voxels, and its picture.
    fn finish(self, job: &Job, pictures: &str) -> Result<(Measured, Vec<File>), LabError> {
        let motion = &job.case.motion;
        let (event, switched) = (motion.event(), matches!(motion, Motion::Switch { .. }));
        let finish = |(name, s): (String, PartSeries)| (name, s.finish(event, switched));
        let mut files = Vec::new();
        if let Some(worst) = &self.worst {
            files.push((picture(&job.id), worst.panels.png()?));
        }
        let worst = self.worst.map(|w| Worst {
            part: pictures.into(),
            frame: w.frame,
            full: w.panels.full(),
            panels: w.panels.names(),
        });
        let measured = Measured {
            samples: self.samples,
            event,
            parts: self.series.into_iter().map(finish).collect(),
            worst,
            warnings: self.warnings,
            ..Measured::default()
        };
        Ok((measured, files))
    }

    /// Scores the parts of the session's last frame.
    fn add<'r>(
        &mut self,
        session: &mut Session,
        pictures: &str,
        (frame, is_last): (usize, bool),
        known: impl Fn(&str) -> Known<'r>,
    ) -> Result<(), LabError> {
        for (part, x) in session.parts()? {
            let finite = |c: &&[f32; 3]| c.iter().all(|v| v.is_finite());
            let lost = x.rgb.len() - x.rgb.iter().filter(finite).count();
            let note = format!("pixels of '{part}' are no number and left out of its scores");
            if lost > 0 && !self.warnings.iter().any(|w| w.ends_with(&note)) {
                self.warnings
                    .push(format!("frame {frame}, perhaps others too: {lost} {note}"));
            }
            let known = known(&part);
            let own = self
                .series
                .entry(part.clone())
                .or_insert_with(PartSeries::new);
            let shown = (part == pictures).then(|| Panels::new(own.before(), &x, known));
            let bad = own.add(x, known, is_last);
            if let (Some(panels), Some(bad)) = (shown, bad.or((frame == 0).then_some(0.0)))
                && self
                    .worst
                    .as_ref()
                    .is_none_or(|w| bad > w.bad || w.frame == 0)
            {
                self.worst = Some(Bad { frame, bad, panels });
            }
        }
        Ok(())
    }
}

/// A session with readable parts of the light, and voxels if a score needs them.
fn session_of(runner: &mut Runner, job: &Job) -> Result<Session, LabError> {
    let Runner { lab, warm, .. } = runner;
    let loaded = warm.graph(&lab.home, &job.experiment.graph)?.clone();
    let parts = parts_of(&loaded.graph).into_iter();
    let mut wanted: Vec<String> = parts.map(|p| p.texture).collect();
    if job.case.voxels && oracle::makes_voxels(&loaded.graph) || job.case.motion.in_voxels() {
        wanted.extend(oracle::wanted(&loaded.graph)?);
    }
    let (scene, reuse) = (job.scene.clone(), warm.sessions.get(&job.method));
    lab.build(&job.experiment, &loaded, scene, wanted, reuse)
}

/// Sets a parameter for the next frame.
fn set(lab: &Lab, session: &mut Session, name: &str, value: Value) -> Result<(), LabError> {
    let mut params = session.params.clone();
    if let Some(index) = params.index(name) {
        params.values[index] = value;
    }
    match session.set_params(lab, &params)? {
        true => Ok(()),
        false => Err(LabError::Request(format!(
            "'{name}' decides about passes or sizes of textures: only what shaders read can move"
        ))),
    }
}

/// The reference of a frame.
fn reference_of(
    runner: &mut Runner,
    job: &Job,
    state: &FrameState,
    tracing: Tracing,
) -> Result<Option<Arc<Reference>>, LabError> {
    let mut experiment = job.experiment.clone();
    experiment.camera = CameraChoice::Placed(state.camera);
    experiment.time = state.time;
    if let Some((name, value)) = &state.setting {
        experiment.set(name, &value.to_string());
    }
    let scene = match state.lights == job.scene.lights {
        true => job.scene.clone(),
        false => Arc::new(Scene {
            lights: state.lights.clone(),
            ..Scene::clone(&job.scene)
        }),
    };
    let Tracing {
        samples,
        bounces,
        seed,
    } = tracing;
    let wanted = Wanted {
        bounces,
        goal: Some(Goal::Samples(samples)),
        seed: Some(seed),
    };
    let subject = format!("{} {:?} {state:?}", job.scene_hash, experiment.size);
    runner.reference(&experiment, &scene, &subject, wanted)
}

/// The references of a part; `earlier` is that of the frame before.
fn known<'a>(
    part: &str,
    reference: Option<&'a Reference>,
    earlier: Option<&'a Reference>,
    changed: bool,
) -> Known<'a> {
    let of = |t: Option<&'a Reference>| t.and_then(|t| t.parts.get(part));
    match (of(reference), of(earlier)) {
        (Some(now), before) => Known::Reference {
            now,
            before: before.filter(|_| changed),
        },
        (None, _) => Known::Nothing { changed },
    }
}

/// Smallest edge of the method's cell at the camera, m, if the motion needs it.
pub(super) fn cell_of(session: &mut Session, job: &Job) -> Result<f32, LabError> {
    if !job.case.motion.in_voxels() {
        return Ok(0.0);
    }
    session.place_camera(&job.start.camera);
    session.run(1)?;
    let (x, y, z) = job.start.camera.eye;
    let edges = oracle::grid(session)?.edges_at(DVec3::new(x.into(), y.into(), z.into()));
    Ok(edges.min_element() as f32)
}

/// Prepares frame `number` of a job as the session's next one. `lights` are the session's current
/// ones.
pub(super) fn place(
    lab: &Lab,
    session: &mut Session,
    job: &Job,
    number: i64,
    cell: f32,
    lights: &mut Vec<Light>,
) -> Result<FrameState, LabError> {
    let state = job.frame_state(number, cell);
    if let Some(track) = &job.track {
        set(lab, session, &track.name, track.at(number))?;
    }
    session.place_camera(&state.camera);
    session.set_time(state.time);
    if state.lights != *lights {
        if !session.set_lights(&state.lights, job.scene.sky) {
            return Err(LabError::Request(
                "a light that moves must keep its kind and its shadow".into(),
            ));
        }
        lights.clone_from(&state.lights);
    }
    Ok(state)
}

/// Compares the last frame's voxels with exact ones, if the case has that and the method makes
/// voxels.
fn voxels(
    session: &mut Session,
    job: &Job,
    time: f64,
    warnings: &mut Vec<String>,
) -> Result<Option<oracle::Score>, LabError> {
    if !job.case.voxels || !oracle::makes_voxels(&session.graph) {
        return Ok(None);
    }
    match oracle::read(session) {
        Ok((grid, voxels)) => {
            let triangles = oracle::triangles_of(&job.scene, time);
            let cells = oracle::exact(&triangles, &Surfaces::new(&job.scene), &grid);
            Ok(Some(oracle::compare(&grid, &cells, &voxels).score))
        }
        Err(LabError::Request(why)) => {
            warnings.push(format!("voxels not compared: {why}"));
            Ok(None)
        }
        Err(other) => Err(other),
    }
}
