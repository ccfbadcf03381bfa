//! Frames of a method in a case, each with its reference.

use super::motion::{FrameState, Motion};
use super::pictures::Panels;
use super::plan::Job;
use super::record::{Measured, Worst, picture};
use super::score::median;
use super::series::{Known, PartSeries};
use crate::campaign::record::File;
use crate::campaign::runner::Runner;
use crate::experiment::CameraChoice;
use crate::graph::param::Value;
use crate::lab::{Lab, LabError, Session, parts_of};
use crate::measure::Wanted;
use crate::measure::oracle::{self, Surfaces};
use crate::measure::reference::Reference;
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

/// Runs a job and scores each part of its light by frame. The worst frame of the part `pictures`
/// becomes a picture.
pub(super) fn measure(
    runner: &mut Runner,
    job: &Job,
    tracing: Option<Tracing>,
    pictures: &str,
) -> Result<(Measured, Vec<File>), LabError> {
    let loaded = runner
        .warm
        .graph(&runner.lab.home, &job.experiment.graph)?
        .clone();
    let motion = &job.case.motion;
    let mut wanted: Vec<String> = parts_of(&loaded.graph)
        .into_iter()
        .map(|p| p.texture)
        .collect();
    if job.case.voxels && oracle::makes_voxels(&loaded.graph) || motion.in_voxels() {
        wanted.extend(oracle::wanted(&loaded.graph)?);
    }
    let reuse = runner.warm.sessions.get(&job.method);
    let mut session =
        runner
            .lab
            .build(&job.experiment, &loaded, job.scene.clone(), wanted, reuse)?;
    let cell = cell_of(&mut session, job)?;
    let (mut times, mut warnings) = (Vec::new(), Vec::new());
    let mut series: BTreeMap<String, PartSeries> = BTreeMap::new();
    let mut worst: Option<Bad> = None;
    let mut samples = 0;
    let mut lights = job.scene.lights.clone();
    let mut before: Option<(FrameState, Option<Arc<Reference>>)> = None;
    let warmup = i64::try_from(job.case.warmup).unwrap_or(0);
    let frames = i64::try_from(job.frames).unwrap_or(1);
    for number in -warmup..frames {
        let state = place(&runner.lab, &mut session, job, number, cell, &mut lights)?;
        times.extend(session.frame(motion.delta())?);
        let Ok(frame) = usize::try_from(number) else {
            continue;
        };
        times.extend(session.finish()?);
        for message in session.failed_checks()? {
            if !warnings.contains(&message) {
                warnings.push(message);
            }
        }
        let changed = before.as_ref().is_none_or(|b| b.0 != state);
        let reference = match (&before, tracing) {
            (_, None) => None,
            (Some((_, Some(reference))), _) if !changed => Some(reference.clone()),
            (_, Some(tracing)) => reference_of(runner, job, &state, tracing)?,
        };
        if let Some(reference) = &reference {
            if frame > 0 && reference.samples != samples {
                let unequal = "references have different numbers of samples, some were kept with more: noise is larger";
                if !warnings.iter().any(|w| w == unequal) {
                    warnings.push(unequal.into());
                }
            }
            samples = reference.samples;
        }
        let earlier = before.as_ref().and_then(|b| b.1.as_ref());
        for (part, x) in session.parts()? {
            let lost = x
                .rgb
                .iter()
                .filter(|c| !c.iter().all(|v| v.is_finite()))
                .count();
            let note = format!("pixels of '{part}' are no number and left out of its scores");
            if lost > 0 && !warnings.iter().any(|w| w.ends_with(&note)) {
                warnings.push(format!("frame {frame}, perhaps others too: {lost} {note}"));
            }
            let known = known(&part, reference.as_deref(), earlier.map(|t| &**t), changed);
            let own = series.entry(part.clone()).or_insert_with(PartSeries::new);
            let shown = (part == pictures).then(|| Panels::new(own.before(), &x, known));
            let bad = own.add(x, known, number + 1 == frames);
            if let (Some(panels), Some(bad)) = (shown, bad.or((frame == 0).then_some(0.0)))
                && worst.as_ref().is_none_or(|w| bad > w.bad || w.frame == 0)
            {
                worst = Some(Bad { frame, bad, panels });
            }
        }
        before = Some((state, reference));
    }
    let times: Vec<f64> = times
        .iter()
        .skip(job.case.warmup)
        .map(|t| t.gpu_ms)
        .collect();
    let last = before.map_or(job.start.time, |b| b.0.time);
    let voxels = voxels(&mut session, job, last, &mut warnings)?;
    runner
        .warm
        .sessions
        .insert(job.method.clone(), session.share());
    let (event, switched) = (motion.event(), matches!(motion, Motion::Switch { .. }));
    let memory_bytes = session
        .program
        .memory(&session.graph)
        .iter()
        .map(|m| m.1)
        .sum();
    let parts = series
        .into_iter()
        .map(|(name, s)| (name, s.finish(event, switched)))
        .collect();
    let shown = worst
        .as_ref()
        .map(|w| Ok::<_, LabError>((picture(&job.id), w.panels.png()?)))
        .transpose()?;
    let worst = worst.map(|w| Worst {
        part: pictures.into(),
        frame: w.frame,
        full: w.panels.full(),
        panels: w.panels.names(),
    });
    let frame_ms = median(times);
    let files = shown.into_iter().collect();
    Ok((
        Measured {
            frame_ms,
            memory_bytes,
            samples,
            event,
            parts,
            voxels,
            worst,
            warnings,
        },
        files,
    ))
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
        samples: Some(samples),
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
