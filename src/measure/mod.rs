//! Measurement of one experiment: pass times, memory, failed checks, and errors against a
//! reference.

pub mod comparison;
pub mod oracle;
mod pictures;
pub mod reference;
mod warm;
mod warm_up;

pub(crate) use warm::Wanted;
pub use warm::Warm;
pub use warm_up::WarmUp;

use crate::experiment::Experiment;
use crate::graph::run::FrameTimes;
use crate::lab::{Lab, LabError, Loaded, ReusableParts, Session, parts_of};
use crate::measure::reference::{Reference, ReferencePart};
use crate::metrics::{Compared, Linear, Metric, Noise, Scores};
use crate::results::stats::{self, Stats};
use crate::scene::Scene;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Numbers of warm-up and measured frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Frames {
    /// Minimum number of warm-up frames ([`WarmUp`]): they fill caches and raise clocks. More run
    /// if the picture has not converged by the last measured frame.
    pub warmup: usize,
    /// Measured frames, at least 1.
    pub count: usize,
}

/// Scores to compute.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scored<'a> {
    /// All components by all metrics.
    All,
    /// One component by one metric; FLIP of all components takes longer than many frames.
    One(&'a str, &'static Metric),
}

impl Scored<'_> {
    fn has(self, part: &str) -> bool {
        matches!(self, Scored::All) || matches!(self, Scored::One(one, _) if one == part)
    }
}

/// Costs and scores of one experiment.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// Times, memory, settings, device, failed checks.
    pub stats: Stats,
    /// Errors of each light component; empty without a reference.
    pub scores: BTreeMap<String, Scores>,
    /// relMSE between the two halves of the reference's samples, by component; smaller scores are
    /// not significant.
    pub noise: BTreeMap<String, f64>,
    /// FLIP caused by the reference's noise alone, by component.
    #[serde(default)]
    pub flip_noise: BTreeMap<String, f64>,
    /// Structure error caused by the reference's noise alone, by component (natural log units).
    #[serde(default)]
    pub structure_noise: BTreeMap<String, f64>,
    /// Samples per pixel of each reference, by its number of bounces.
    pub references: BTreeMap<u32, u64>,
}

impl Point {
    /// Noise of a component's reference; NaN if unknown.
    pub(crate) fn noise_of(&self, part: &str) -> Noise {
        let of = |list: &BTreeMap<String, f64>| list.get(part).copied().unwrap_or(f64::NAN);
        Noise {
            relmse: of(&self.noise),
            flip: of(&self.flip_noise),
            structure: of(&self.structure_noise),
        }
    }

    /// Adds the scores of a component and the noise of its reference.
    fn add(
        &mut self,
        name: String,
        light: &Linear,
        expected: &ReferencePart,
        scored: Scored,
    ) -> Result<(), String> {
        let compared = Compared::new(light, &expected.mean).map_err(|e| e.0)?;
        let scores = match scored {
            Scored::All => compared.scores(None),
            Scored::One(_, metric) => compared.scores_by(metric),
        };
        let scores = scores.ok_or("no pixel is a number in both pictures")?;
        self.scores.insert(name.clone(), scores);
        // The noise of black references is undefined, and JSON has no NaN.
        if expected.noise.structure.is_finite() {
            self.structure_noise
                .insert(name.clone(), expected.noise.structure);
        }
        self.flip_noise.insert(name.clone(), expected.noise.flip);
        self.noise.insert(name, expected.noise.relmse);
        Ok(())
    }
}

/// A point with JPEG thumbnails.
pub struct Measured {
    /// Costs and scores.
    pub point: Point,
    /// The displayed picture, if the graph has an `output`.
    pub picture: Option<Vec<u8>>,
    /// Error map against the reference, if there is one.
    pub error_map: Option<Vec<u8>>,
    /// The first reference, displayed with the default tone map.
    pub reference: Option<Vec<u8>>,
}

impl Measured {
    /// Adds the scores against the references.
    fn score(
        &mut self,
        parts: &BTreeMap<String, Linear>,
        references: &[(u32, Arc<Reference>)],
        scored: Scored,
    ) -> Result<(), LabError> {
        for (number, (bounces, reference)) in references.iter().enumerate() {
            for (part, light) in parts {
                if number > 0 && part != "total" {
                    continue;
                }
                let Some(expected) = reference.parts.get(part) else {
                    continue;
                };
                let name = match number {
                    0 => part.clone(),
                    _ => format!("{part}, {bounces} bounces"),
                };
                self.point
                    .add(name, light, expected, scored)
                    .map_err(|why| {
                        LabError::Request(format!("the part '{part}' cannot be compared: {why}"))
                    })?;
                if number == 0 && part == "total" {
                    self.error_map = Some(pictures::error_map(light, &expected.mean)?);
                    self.reference = Some(pictures::displayed(&expected.mean)?);
                }
            }
            self.point.references.insert(*bounces, reference.samples);
        }
        Ok(())
    }
}

/// Measures an experiment on its scene (with the experiment's lighting, see
/// [`Experiment::adapted`]). Timed frames execute every pass that the picture needs, and nothing
/// else. Scored components come from separate frames, because writing them costs time. The linear
/// picture alone is an exception, because the display needs it anyway.
///
/// The components are scored against the first reference, and the total against the others too:
/// (bounces, reference).
///
/// # Errors
/// An invalid experiment; a lost device; a reference of another size.
pub fn measure(
    lab: &Lab,
    warm: &mut Warm,
    experiment: &Experiment,
    scene: &Arc<Scene>,
    frames: Frames,
    references: &[(u32, Arc<Reference>)],
    scored: Scored,
) -> Result<Measured, LabError> {
    let loaded = warm.graph(&lab.home, &experiment.graph)?.clone();
    let parts = parts_of(&loaded.graph).into_iter();
    let parts = parts.filter(|p| scored.has(&p.name));
    let wanted: Vec<String> = parts.map(|p| p.texture).collect();
    let hdr = loaded.graph.hdr.as_ref();
    let together = !references.is_empty() && wanted.iter().all(|texture| hdr == Some(texture));
    let extra = if together { &wanted[..] } else { &[] };
    let reuse = warm.timed.as_ref();
    let Timed {
        mut session,
        times,
        warmup,
    } = timed(lab, &loaded, experiment, scene, frames, extra, reuse)?;
    let warnings = session.failed_checks()?;
    let (info, name) = (&lab.gpu.info, &experiment.name);
    let stats = stats::collect(info, name, &session, &times, warmup, warnings);
    let picture = match &loaded.graph.output {
        Some(name) => Some(pictures::thumbnail(&session.texels(name, 0, 0)?)?),
        None => None,
    };
    warm.timed = Some(session.share());
    let parts = match references {
        [] => BTreeMap::new(),
        _ if together => session.parts()?,
        _ => {
            drop(session);
            parts_alone(lab, warm, experiment, &loaded, scene, frames, wanted)?
        }
    };
    let mut measured = Measured {
        point: Point {
            stats,
            scores: BTreeMap::new(),
            noise: BTreeMap::new(),
            flip_noise: BTreeMap::new(),
            structure_noise: BTreeMap::new(),
            references: BTreeMap::new(),
        },
        picture,
        error_map: None,
        reference: None,
    };
    measured.score(&parts, references, scored)?;
    Ok(measured)
}

/// An experiment that has run.
pub struct Timed {
    /// The session after its last frame.
    pub session: Session,
    /// Times of the measured frames.
    pub times: Vec<FrameTimes>,
    /// Warm-up frames.
    pub warmup: usize,
}

/// Runs an experiment and keeps the times of its last frames. Computes only the picture and the
/// textures `extra`.
pub fn timed(
    lab: &Lab,
    loaded: &Loaded,
    experiment: &Experiment,
    scene: &Arc<Scene>,
    frames: Frames,
    extra: &[String],
    reuse: Option<&ReusableParts>,
) -> Result<Timed, LabError> {
    let graph = &loaded.graph;
    let shown = graph.output.clone().or_else(|| graph.hdr.clone());
    let wanted = shown.into_iter().chain(extra.iter().cloned()).collect();
    let mut session = lab.build(experiment, loaded, scene.clone(), wanted, reuse)?;
    let least = session.converging_frames().saturating_sub(frames.count);
    let execution = session.execution();
    session.begin_warm_up(&lab.gpu.info);
    let warmup = WarmUp::of(&lab.gpu.info, frames.warmup.max(least))
        .run(&mut || Ok::<_, LabError>(session.frame(0.0)?.map_or(0.0, |times| times.gpu_ms)))?;
    session.set_execution(execution);
    let mut times = Vec::new();
    for _ in 0..frames.count {
        times.extend(session.frame(0.0)?);
    }
    times.extend(session.finish()?);
    // Frames are in flight, so the first times belong to the warm-up.
    let times = times.split_off(times.len().saturating_sub(frames.count));
    Ok(Timed {
        session,
        times,
        warmup,
    })
}

/// Light components of an experiment by graph name, from frames that compute nothing else.
fn parts_alone(
    lab: &Lab,
    warm: &mut Warm,
    experiment: &Experiment,
    loaded: &Loaded,
    scene: &Arc<Scene>,
    frames: Frames,
    wanted: Vec<String>,
) -> Result<BTreeMap<String, Linear>, LabError> {
    // Reuses the uploaded scene of the timed session, because a second upload would double the
    // memory.
    let reuse = warm
        .scored
        .as_ref()
        .filter(|s| Arc::ptr_eq(&s.0, scene))
        .map(|s| &s.1)
        .or(warm.timed.as_ref());
    let mut session = lab.build(experiment, loaded, scene.clone(), wanted, reuse)?;
    session.run(
        session
            .converging_frames()
            .max(frames.warmup + frames.count),
    )?;
    let out = session.parts()?;
    warm.scored = Some((scene.clone(), session.share()));
    Ok(out)
}
