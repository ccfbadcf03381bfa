//! Runs settings and measures both of their quantities.

use super::at;
use super::search::Trial;
use crate::campaign::settings::Axis;
use crate::experiment::Experiment;
use crate::lab::{Lab, LabError, Loaded, ReusableParts};
use crate::measure::reference::Reference;
use crate::measure::{Frames, Timed, timed};
use crate::metrics::{Compared, Linear, Metric};
use crate::results::stats::spread;
use crate::scene::Scene;
use crate::vulkan::VulkanError;
use std::sync::Arc;

/// What is made small and what is bounded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Goal {
    /// The least time with at most this error.
    Error(f64),
    /// The least error in at most this time, ms.
    Time(f64),
}

impl Goal {
    /// The bounded quantity's bound.
    pub fn bound(self) -> f64 {
        match self {
            Goal::Error(bound) | Goal::Time(bound) => bound,
        }
    }

    /// A setting's time (ms) and error.
    pub fn time_and_error(self, trial: Trial) -> (f64, f64) {
        match self {
            Goal::Error(_) => (trial.cost, trial.bounded),
            Goal::Time(_) => (trial.bounded, trial.cost),
        }
    }
}

/// What every setting of a search has in common.
pub struct Subject<'a> {
    /// The device.
    pub lab: &'a Lab,
    /// The experiment's graph.
    pub loaded: &'a Loaded,
    /// The scene, lit as the experiment says.
    pub scene: Arc<Scene>,
    /// The experiment.
    pub experiment: &'a Experiment,
    /// The varied parameters.
    pub axes: &'a [Axis],
    /// The reference.
    pub reference: &'a Reference,
    /// Part of the light that is compared.
    pub part: &'a str,
    /// How it is compared.
    pub metric: &'static Metric,
    /// How long a setting is timed.
    pub frames: Frames,
    /// The quantity that is minimised, and the bound of the other.
    pub goal: Goal,
}

/// Runs settings one after the other on what the one before has left.
pub struct Evaluator<'a> {
    subject: &'a Subject<'a>,
    texture: String,
    expected: &'a Linear,
    reuse: Option<ReusableParts>,
    /// Why the last setting could not be run.
    pub refused: Option<String>,
}

impl<'a> Evaluator<'a> {
    /// Checks that the part is there.
    ///
    /// # Errors
    /// No such part in the graph or in the reference.
    pub fn new(subject: &'a Subject<'a>) -> Result<Evaluator<'a>, LabError> {
        let parts = crate::lab::parts_of(&subject.loaded.graph);
        let texture = parts.iter().find(|p| p.name == subject.part).map(|p| p.texture.clone());
        match (texture, subject.reference.parts.get(subject.part)) {
            (Some(texture), Some(part)) => {
                Ok(Evaluator { subject, texture, expected: &part.mean, reuse: None, refused: None })
            }
            _ => {
                let all: Vec<&str> = parts.iter().map(|p| p.name.as_str()).collect();
                Err(LabError::Request(format!("no part '{}'; there are {}", subject.part, all.join(", "))))
            }
        }
    }

    /// Both quantities of a setting; nothing where the graph, the device or one of the graph's checks refuses it.
    ///
    /// # Errors
    /// The device was lost.
    pub fn evaluate(&mut self, place: &[usize]) -> Result<Option<Trial>, LabError> {
        self.refused = None;
        let experiment = at(self.subject.experiment, self.subject.axes, place);
        match self.measure(&experiment) {
            Ok(trial) => Ok(trial),
            Err(error @ LabError::Vulkan(VulkanError::Lost(_))) => Err(error),
            Err(error) => {
                self.refused = Some(error.to_string());
                Ok(None)
            }
        }
    }

    fn measure(&mut self, experiment: &Experiment) -> Result<Option<Trial>, LabError> {
        let s = self.subject;
        // The linear picture is made for the display anyway; other parts cost time to write, and get frames of their own.
        let together = s.loaded.graph.hdr.as_ref() == Some(&self.texture);
        let extra = if together { std::slice::from_ref(&self.texture) } else { &[] };
        let Timed { mut session, times, .. } =
            timed(s.lab, s.loaded, experiment, &s.scene, s.frames, extra, self.reuse.as_ref())?;
        let ms = spread(times.iter().map(|t| t.gpu_ms).collect()).median;
        if let Some(message) = session.failed_checks()?.into_iter().next() {
            self.refused = Some(message);
            return Ok(None);
        }
        self.reuse = Some(session.share());
        if !together {
            let reuse = self.reuse.as_ref();
            session = s.lab.build(experiment, s.loaded, s.scene.clone(), vec![self.texture.clone()], reuse)?;
            session.run(s.frames.warmup + s.frames.count)?;
        }
        let light = session.texels(&self.texture, 0, 0)?.linear();
        // Metrics leave pixels out that are no numbers; a setting that makes them must not look better for it.
        let finite = light.rgb.iter().flatten().all(|v| v.is_finite());
        let value = Compared::new(&light, self.expected)?.score(s.metric).ok().filter(|_| finite);
        let error = value.map_or(f64::NAN, |value| s.metric.distance(value));
        Ok(Some(match s.goal {
            Goal::Error(_) => Trial { cost: ms, bounded: error },
            Goal::Time(_) => Trial { cost: error, bounded: ms },
        }))
    }
}
